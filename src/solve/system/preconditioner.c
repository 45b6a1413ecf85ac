/* SPDX-License-Identifier: GPL-3.0-or-later
 * Preconditioners of several levels for conjugate gradients without a factor, in two forms: for forces that
 * offer the rows of K, over all unknowns with the prescribed ones blanked; for forces that use smooth
 * shape functions, by finite elements on their nodes, over the unknowns that constraints leave. Breaking
 * leaves an old preconditioner valid: it is made anew when the iterations that it has cost above those of
 * its first solve would have paid for another (rent or buy, counted in iterations, never by the clock). */
#include "solve/run/solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { RENEWAL = 20, MOST_ITERATIONS = 200 };  /* a new preconditioner costs about so many iterations */
/* Finite elements fit worse near Poisson's ratio 1/2 and on smooth kernels with a wide support. */
enum { MOST_BY_ELEMENTS = 300 };
/* On a coarse grid there are more iterations, each of them cheap. */
enum { MOST_ON_GRID = 1000 };

int system_has_preconditioner (const pg_system *s)
{
    const system_iterations *it = &s->iterative;
    return it->multilevel || it->elements || it->amg || it->whole_factor;
}

void system_forget_preconditioner (pg_system *s)
{
    pg_multilevel_free (&s->iterative.multilevel);
    pg_element_preconditioner_free (&s->iterative.elements);
    system_free_shared (s);
}

/* ---- unknowns that constraints leave ------------------------------------------------------------------- */
/* 1: T selects unknowns: one entry 1 in each column, no row twice. Marks the others in `fixed`. */
static int selects (pg_system *s, const pg_sparse *T)
{
    int yes = 1;
    if (T) memset (s->iterative.fixed, 1, s->ndof);
    for (size_t j = 0; T && j < T->ncol && yes; j++) {
        long p = T->start[j];
        yes = T->start[j + 1] == p + 1 && T->value[p] == 1 && s->iterative.fixed[T->row[p]];
        if (yes) s->iterative.fixed[T->row[p]] = 0;
    }
    return yes;
}

/* Finds the unknown that each reduced one is: the row of its column that no other column has, with the entry
 * 1. *found 0: a column has none, or several. */
static pg_status find_own_rows (pg_system *s, const pg_sparse *T, int *found)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    unsigned char *columns = NULL;
    *found = 1;
    if (!T || it->own_row) return PG_OK;
    PG_ALLOC (it->own_row, T->ncol);
    PG_ALLOC (columns, s->ndof);
    for (long p = 0; p < T->start[T->ncol]; p++) if (columns[T->row[p]] < 2) columns[T->row[p]]++;
    memset (it->fixed, 1, s->ndof);
    for (size_t j = 0; j < T->ncol && *found; j++) {
        int count = 0;
        for (long p = T->start[j]; p < T->start[j + 1]; p++)
            if (columns[T->row[p]] == 1 && T->value[p] == 1) it->own_row[j] = (int) T->row[p], count++;
        *found = count == 1;
        if (count == 1) it->fixed[it->own_row[j]] = 0;
    }
    if (!*found) pg_free (it->own_row), it->own_row = NULL;
done:
    pg_free (columns);
    return status;
}

/* 1: a static system of a force that offers the rows of K, a dynamic one too where ranks share them, or a
 * system of a force with finite elements. */
static int has_what_it_takes (const pg_system *s, const dynamics *dyn)
{
    const pg_force_type *f = s->force;
    if (!f->operator_ || strcmp (s->options->preconditioner, "jacobi") == 0) return 0;
    if (f->spares.elements ? s->options->plain : !f->spares.couplings || (dyn && !system_is_shared (s)))
        return 0;
    return !system_is_shared (s) || pg_shared_preconditioner_now ();
}

/* *can 1: the system can be preconditioned by several levels, and its supports leave unknowns for it. */
pg_status system_can_precondition (pg_system *s, const dynamics *dyn, int *can)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    const pg_sparse *T = system_basis (s);
    *can = 0;
    if (!has_what_it_takes (s, dyn)) return PG_OK;
    if (it->fixed) {
        *can = it->precondition;
        return PG_OK;
    }
    PG_ALLOC (it->fixed, s->ndof);
    if (s->force->spares.elements || system_is_shared (s)) PG_TRY (find_own_rows (s, T, can));
    else *can = selects (s, T);
    if (system_is_shared (s)) *can = system_most (s, !*can) == 0;  /* possible on all ranks or on none */
    it->precondition = *can;
done:
    return status;
}

/* ---- made ---------------------------------------------------------------------------------------------- */
/* Writes the number of unknowns of each level into the report. */
static void tell (pg_system *s)
{
    system_iterations *it = &s->iterative;
    pg_multilevel_info info;
    char *text = s->report->linear.preconditioner;
    size_t workspace = sizeof s->report->linear.preconditioner, at = 0;
    if (it->elements && system_is_shared (s)) {
        pg_element_preconditioner_describe (it->elements, text, workspace);
        return;
    }
    pg_multilevel_describe (it->elements ? pg_element_preconditioner_levels (it->elements) : it->multilevel,
                            &info);
    const char *kind = "";
    if (it->elements)
        kind = pg_element_preconditioner_on_grid (it->elements) ? "finite elements on a coarse grid, "
                                                               : "finite elements, ";
    at = (size_t) snprintf (text, workspace, "%smultilevel, %d levels of", kind, info.levels);
    for (int k = 0; k < info.levels && k < 8 && at < workspace; k++)
        at += (size_t) snprintf (text + at, workspace - at, "%s%zu", k ? ", " : " ", info.unknowns[k]);
    if (at < workspace) snprintf (text + at, workspace - at, " unknowns");
}

/* Makes the multilevel preconditioner from the rows of K. */
static pg_status make_by_rows (pg_system *s)
{
    pg_status status = PG_OK;
    pg_multilevel_setting setting = { .dim = s->problem->dim,
                                      .block = s->components,
                                      .threads = s->problem->threads,
                                      .n = s->problem->cloud.n,
                                      .x = s->problem->cloud.x,
        .fixed = s->iterative.fixed,
                                      .A = s->force->operator_ (s->self) };
    PG_TRY (s->force->spares.couplings (s->self, &setting.rows));
    PG_TRY (pg_multilevel_create (&s->iterative.multilevel, &setting));
done:
    return status;
}

/* Adds the mass to the elements: k K + m M, on a coarse grid with the mass of nodes restricted to its
 * functions. */
static pg_status weigh_coarse (pg_system *s, pg_elements *e, double k, double m)
{
    pg_status status = PG_OK;
    size_t n = e->Q.n * (size_t) e->Q.block;
    double *mass = NULL;
    for (size_t i = 0; i < s->ndof; i++) e->diagonal[i] = k * e->diagonal[i] + (m != 0 ? m * s->mass[i] : 0);
    if (m == 0) return PG_OK;
    PG_ALLOC (mass, n);
    pg_hats_restrict (&e->hats, e->Q.block, s->mass, mass);
    for (size_t i = 0; i < n; i++) pg_block_add_diagonal (&e->Q, i, m * mass[i]);
done:
    pg_free (mass);
    return status;
}

/* Makes the preconditioner by finite elements. In dynamics their matrix is k K + m M with the lumped mass of
 * displacements: patterns of unknowns that hardly move the nodes have less of it than here, and no stiffness
 * either. */
static pg_status make_by_elements (pg_system *s, double k, double m)
{
    pg_status status = PG_OK;
    pg_elements elements = { 0 };
    pg_element_setting setting = { .dim = s->problem->dim, .x = s->problem->cloud.x,
        .fixed = s->iterative.own_row ? s->iterative.fixed : NULL,
                                   .subdomain = s->problem->cloud.subdomain };
    PG_TRY (s->force->spares.elements (s->self, &elements));
    pg_block_matrix *Q = &elements.Q;
    size_t entries = Q->start[Q->n] * (size_t) (Q->block * Q->block);
    for (size_t q = 0; k != 1 && q < entries; q++) Q->value[q] = (float) (k * Q->value[q]);
    if (elements.hats.count) PG_TRY (weigh_coarse (s, &elements, k, m));
    else for (size_t i = 0; m != 0 && i < s->ndof; i++) pg_block_add_diagonal (Q, i, m * s->mass[i]);
    PG_TRY (pg_element_preconditioner_create (&s->iterative.elements, &elements, &setting));
done:
    pg_elements_clear (&elements);
    return status;
}

/* Makes a preconditioner for the present bonds; its cost is counted as that of a factor would be. */
pg_status system_make_preconditioner (pg_system *s, double k, double m)
{
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    int can, whole;
    system_forget_preconditioner (s);
    /* finds which unknowns constraints leave, also in a resumed run */
    PG_TRY (system_can_precondition (s, NULL, &can));
    s->iterative.made[0] = k, s->iterative.made[1] = m;
    PG_TRY (system_make_shared_factor (s, &whole));
    if (!whole)
        PG_TRY (s->force->spares.elements ? make_by_elements (s, k, m)
                : system_is_shared (s) ? system_make_shared (s, k, m) : make_by_rows (s));
    s->report->linear.preconditioners++;
    s->choice.extra_cost = s->iterative.pace = 0;
    if (!system_by_ranks (s)) tell (s);
    PG_TRY (system_remember_alive (s));
done:
    s->report->seconds[PG_SECONDS_FACTOR] += pg_seconds () - t0;
    return status;
}

/* ---- used ---------------------------------------------------------------------------------------------- */
/* Marks nodes that lack a bond, which get weak springs as in a factor: where bonds between points make K, a
 * point on a single bond has no stiffness across it, and rounding would move it by any amount. The residual,
 * which is without springs, corrects their effect on the solution. */
static pg_status hold_hanging (pg_system *s)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    if (!it->hanging) PG_ALLOC (it->hanging, s->problem->cloud.n);
    memset (it->hanging, 0, s->problem->cloud.n);
    if (s->direct.alive) system_mark_touched (s, s->direct.alive, it->hanging);
done:
    return status;
}

/* y += the springs at nodes that lack a bond, times x. */
static void add_hanging (const pg_system *s, const double *x, double *y)
{
    size_t c = (size_t) s->components;
    double spring = WEAK_SPRING * s->direct.mean_diagonal;
    for (size_t j = 0; j < s->ndof; j++) if (s->iterative.hanging[j / c]) y[j] += spring * x[j];
}

/* K x with prescribed unknowns left out, which stay zero, and springs at nodes that lack a bond. */
static void apply_free (void *context, const double *x, double *y)
{
    const pg_system *s = context;
    system_multiply (s, x, y);
    add_hanging (s, x, y);
    for (size_t i = 0; i < s->ndof; i++) if (s->iterative.fixed[i]) y[i] = 0;
}

/* Solves for all unknowns with the multilevel preconditioner; prescribed ones stay zero. */
static pg_status iterate_all (pg_system *s, double tolerance, size_t *used)
{
    pg_operator op = { s->ndof, s, apply_free, NULL };
    pg_preconditioner P = pg_multilevel_preconditioner (s->iterative.multilevel);
    const pg_sparse *T = system_basis (s);
    double t0 = pg_seconds (), *b = s->balance.scratch, *x = s->balance.full;
    for (size_t i = 0; i < s->ndof; i++) b[i] = s->iterative.fixed[i] ? 0 : s->balance.residual[i], x[i] = 0;
    pg_status status = hold_hanging (s);
    if (status == PG_OK)
        status = pg_conjugate_gradients_with (&op, &P, b, x, tolerance, MOST_ITERATIONS, used);
    for (size_t j = 0; j < s->nred; j++) s->balance.delta[j] = s->balance.full[T ? (size_t) T->row[j] : j];
    s->report->linear.cg_iterations += *used;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

/* Preconditioner by finite elements, which know all unknowns. With elimination, d = T q, the residual of q
 * is put at the unknowns that q selects, and the result taken from there; the elements are fixed at all
 * others. */
static pg_status by_elements (void *context, const double *r, double *z)
{
    pg_status status = PG_OK;
    pg_system *s = context;
    pg_preconditioner P = pg_element_preconditioner_of (s->iterative.elements);
    if (!s->iterative.own_row) {
        PG_TRY (P.solve (P.context, r, z));
        system_clear_rest (s, z);
        goto done;
    }
    memset (s->balance.full, 0, s->ndof * sizeof *s->balance.full);
    for (size_t j = 0; j < s->nred; j++) s->balance.full[s->iterative.own_row[j]] = r[j];
    PG_TRY (P.solve (P.context, s->balance.full, s->balance.scratch));
    system_clear_rest (s, s->balance.scratch);
    for (size_t j = 0; j < s->nred; j++) z[j] = s->balance.scratch[s->iterative.own_row[j]];
done:
    return status;
}

/* Preconditioner that ranks sharing the body have made together. */
static pg_status by_ranks (void *context, const double *r, double *z)
{
    return system_apply_shared (context, r, z);
}

/* Solves, and counts the iterations that an old preconditioner costs: pace is the gain of one iteration, as a
 * logarithm, when it was new. */
static pg_status iterate (pg_system *s, const dynamics *dyn, double tolerance, size_t *used)
{
    system_iterations *iterations = &s->iterative;
    int on_grid = iterations->elements && pg_element_preconditioner_on_grid (iterations->elements);
    size_t most = on_grid ? MOST_ON_GRID : MOST_BY_ELEMENTS;
    pg_preconditioner P = { s, system_by_ranks (s) ? by_ranks : by_elements, s->problem->threads };
    pg_status status = iterations->elements || system_by_ranks (s)
                           ? system_iterate (s, dyn, &P, tolerance, most, used)
                           : iterate_all (s, tolerance, used);
    /* less than `tolerance` was reached where the solve ended early */
    double gain = -log (fmax (iterations->fell, tolerance));
    if (iterations->pace == 0) iterations->pace = gain / (double) (*used + 1);
    else s->choice.extra_cost += fmax (0, (double) (*used + 1) - gain / iterations->pace);
    return status;
}

/* An old preconditioner serves as long as it does not cost more iterations than a new one would; where it
 * fails a new one is made and tried once. */
pg_status system_iterate_preconditioned (pg_system *s, const dynamics *dyn, double tolerance)
{
    system_iterations *it = &s->iterative;
    pg_status status = PG_OK;
    size_t used = 0;
    long made = s->report->linear.preconditioners;
    double k = dyn ? dyn->k : 1, m = dyn ? dyn->m : 0;
    system_remember_diagonal (s, NULL);
    int other = fabs (m * it->made[0] - it->made[1] * k) > 0.3 * fmax (m * it->made[0], it->made[1] * k);
    if (!system_has_preconditioner (s) || s->choice.extra_cost > RENEWAL || other)
        PG_TRY (system_make_preconditioner (s, k, m));
    else s->choice.spared += s->direct.stale;
    if (system_is_shared (s) && s->direct.stale) PG_TRY (system_find_bare (s, dyn));
    strcpy (s->report->linear.solver, "cg");
    pg_status now = iterate (s, dyn, tolerance, &used);
    /* it was made before the last break: try a new one */
    if ((now == PG_E_EQUILIBRIUM || now == PG_E_NOT_SPD) && s->report->linear.preconditioners == made) {
        PG_TRY (system_make_preconditioner (s, k, m));
        now = iterate (s, dyn, tolerance, &used);
    }
    PG_TRY (now);
    s->direct.stale = 0;
done:
    return status;
}
