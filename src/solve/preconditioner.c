/* SPDX-License-Identifier: GPL-3.0-or-later
 * K delta = R for forces that tell the rows of K, by conjugate gradients with the multilevel preconditioner,
 * over all unknowns with the prescribed ones blanked. Breaking leaves an old preconditioner valid: it is made
 * anew when the iterations that it has cost above those of its first solve would have paid for another (rent
 * or buy, counted in iterations, never by the clock). */
#include "solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RENEWAL = 20, MOST_ITERATIONS = 200 };  /* a new preconditioner costs about so many iterations */

/* T selects unknowns: one entry 1 in each column, no row twice. */
static pg_status find_fixed (pg_system *s, const pg_sparse *T, int *selects)
{
    pg_status status = PG_OK;
    *selects = 1;
    if (s->fixed) return PG_OK;
    PG_ALLOC (s->fixed, s->ndof);
    if (T) memset (s->fixed, 1, s->ndof);
    for (size_t j = 0; T && j < T->ncol && *selects; j++) {
        long p = T->start[j];
        *selects = T->start[j + 1] == p + 1 && T->value[p] == 1 && s->fixed[T->row[p]];
        if (*selects) s->fixed[T->row[p]] = 0;
    }
done:
    return status;
}

/* Static systems of forces that know the rows of K, with supports that prescribe single unknowns. */
pg_status system_can_precondition (pg_system *s, const dynamics *dyn, int *can)
{
    pg_status status = PG_OK;
    *can = 0;
    if (dyn || !s->force->couplings || !s->force->operator_
        || strcmp (s->options->preconditioner, "jacobi") == 0)
        return PG_OK;
    PG_TRY (find_fixed (s, s->force->basis ? s->force->basis (s->self) : NULL, can));
done:
    return status;
}

/* The number of unknowns of each level, for the report. */
static void tell (pg_system *s)
{
    pg_multilevel_info info;
    char *text = s->report->preconditioner;
    size_t workspace = sizeof s->report->preconditioner, at = 0;
    pg_multilevel_describe (s->multilevel, &info);
    at = (size_t) snprintf (text, workspace, "multilevel, %d levels of", info.levels);
    for (int k = 0; k < info.levels && k < 8 && at < workspace; k++)
        at += (size_t) snprintf (text + at, workspace - at, "%s%zu", k ? ", " : " ", info.unknowns[k]);
    if (at < workspace) snprintf (text + at, workspace - at, " unknowns");
}

/* Made from the rows of K of the bonds that live now; what it costs is counted as a factor would be. */
pg_status system_make_multilevel (pg_system *s)
{
    pg_status status = PG_OK;
    pg_multilevel_setting setting = { .dim = s->problem->dim,
                                      .block = s->components,
                                      .threads = s->problem->threads,
                                      .n = s->problem->cloud.n,
                                      .x = s->problem->cloud.x,
                                      .fixed = s->fixed,
                                      .A = s->force->operator_ (s->self) };
    double t0 = pg_seconds ();
    pg_multilevel_free (&s->multilevel);
    PG_TRY (s->force->couplings (s->self, &setting.rows));
    PG_TRY (pg_multilevel_create (&s->multilevel, &setting));
    s->report->preconditioners++;
    s->extra_cost = s->pace = 0;
    tell (s);
    PG_TRY (system_remember_alive (s));
done:
    s->report->seconds[PG_SECONDS_FACTOR] += pg_seconds () - t0;
    return status;
}

/* K x with prescribed unknowns left out: they stay zero. */
static void apply_free (void *context, const double *x, double *y)
{
    const pg_system *s = context;
    system_multiply (s, x, y);
    for (size_t i = 0; i < s->ndof; i++) if (s->fixed[i]) y[i] = 0;
}

/* Solves; keeps account of what an older preconditioner costs: pace is the gain of one iteration, as a
 * logarithm, when it was new. */
static pg_status iterate (pg_system *s, double tolerance, size_t *used)
{
    pg_operator op = { s->ndof, s, apply_free, NULL };
    pg_preconditioner P = pg_multilevel_preconditioner (s->multilevel);
    double t0 = pg_seconds (), *b = s->scratch, *x = s->full;
    for (size_t i = 0; i < s->ndof; i++) b[i] = s->fixed[i] ? 0 : s->residual[i], x[i] = 0;
    pg_status status = pg_conjugate_gradients_with (&op, &P, b, x, tolerance, MOST_ITERATIONS, used);
    double gain = -log (tolerance);
    if (s->pace == 0) s->pace = gain / (double) (*used + 1);
    else s->extra_cost += fmax (0, (double) (*used + 1) - gain / s->pace);
    s->report->cg_iterations += *used;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

/* An old preconditioner serves as long as it does not cost more iterations than a new one would; where it
 * fails a new one is made and tried once. */
pg_status system_iterate_multilevel (pg_system *s, double tolerance)
{
    pg_status status = PG_OK;
    size_t used = 0;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    system_remember_diagonal (s, NULL);
    if (!s->multilevel || s->extra_cost > RENEWAL) PG_TRY (system_make_multilevel (s));
    else s->spared += s->stale;
    strcpy (s->report->solver, "cg");
    pg_status now = iterate (s, tolerance, &used);
    /* made before the last break: once more */
    if ((now == PG_E_EQUILIBRIUM || now == PG_E_NOT_SPD) && s->stale) {
        PG_TRY (system_make_multilevel (s));
        now = iterate (s, tolerance, &used);
    }
    PG_TRY (now);
    s->stale = 0;
    for (size_t j = 0; j < s->nred; j++) s->delta[j] = s->full[T ? (size_t) T->row[j] : j];
done:
    return status;
}
