/* SPDX-License-Identifier: GPL-3.0-or-later
 * (k K + m M) delta = R, d <- d + delta, until R is small: one linear solve with iterative refinement, the residual always taken
 * from the force, never from K. With elimination d = T q + g the matrix is T' (k K + m M) T and the residual T' R.
 * Unknowns that breaking has touched get 1e-11 of the mean diagonal (isolated nodes and loose fragments stay put); the refinement
 * takes its effect out again wherever the body can carry load. */
#include "solve.h"
#include <math.h>
#include <string.h>

enum { MOST_REFINEMENTS = 12 };
static const double goal = 1e-12;                      /* refinement stops here or where it no longer gains              */

void system_free (pg_system *s)
{
    if (s->factor) s->linear->free (&s->factor);
    if (s->force && s->self) s->force->free (&s->self);
    if (s->copy) pg_sparse_clear (&s->A);
    else pg_free (s->A.value);
    pg_free (s->copy), pg_free (s->diagonal0), pg_free (s->mass);
    pg_free (s->residual), pg_free (s->reduced), pg_free (s->delta), pg_free (s->full), pg_free (s->best), pg_free (s->scratch), pg_free (s->touched);
}

static const pg_sparse *matrix_of (const pg_system *s) { return s->force->matrix ? s->force->matrix (s->self) : NULL; }
static const pg_operator *operator_of (const pg_system *s) { return s->force->operator_ ? s->force->operator_ (s->self) : NULL; }

void system_multiply (const pg_system *s, const double *x, double *y)
{
    const pg_operator *op = operator_of (s);
    if (op) op->apply (op->context, x, y);
    else pg_sparse_multiply (matrix_of (s), x, y);
}

pg_status system_create (pg_system *s)
{
    pg_status status = PG_OK;
    pg_field field[8];
    PG_TRY (s->force->create (&s->self, s->problem));
    size_t nfield = s->force->fields (s->self, 8, field);
    for (size_t k = 0; k < nfield && k < 8; k++) s->components += field[k].components;
    s->ndof = s->problem->cloud.n * (size_t) s->components;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    s->nred = T ? T->ncol : s->ndof;
    s->stale = 1;
    if (!matrix_of (s) && !operator_of (s)) PG_FAIL (PG_E_USAGE, "the force %s offers neither a matrix nor an operator", s->force->name);
    if (!matrix_of (s)) PG_ALLOC (s->scratch, s->ndof);
    PG_ALLOC (s->mass, s->ndof);
    PG_ALLOC (s->residual, s->ndof);
    PG_ALLOC (s->reduced, s->ndof);
    PG_ALLOC (s->delta, s->ndof);
    PG_ALLOC (s->full, s->ndof);
    PG_ALLOC (s->best, s->ndof);
    PG_ALLOC (s->diagonal0, s->ndof);
    PG_ALLOC (s->touched, s->problem->cloud.n);
    if (s->force->mass) PG_TRY (s->force->mass (s->self, s->mass));
    const char *name = strcmp (s->options->linear, "auto") == 0 ? "cholmod" : s->options->linear;
    s->linear = pg_linear_find (name);
    if (!s->linear) PG_FAIL (PG_E_USAGE, "there is no linear solver %s", name);
done:
    return status;
}

/* Nodes of points that lack a bond: breaking changes their diagonal, but the first K is already without it. */
static void mark_touched (pg_system *s, const pg_state *state)
{
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &s->problem->rows[set].family;
        const unsigned char *alive = state->alive + s->problem->first_bond[set];
        for (size_t p = 0; p < f->n; p++) {
            if (!memchr (alive + f->start[p], 0, f->start[p + 1] - f->start[p])) continue;
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) s->touched[f->node[e]] = 1;
        }
    }
}

pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes)
{
    double t0 = pg_seconds ();
    pg_status status = s->force->refresh ? s->force->refresh (s->self, state, changes) : PG_OK;
    if (!changes) mark_touched (s, state);
    unsigned long now = s->force->revision ? s->force->revision (s->self) : s->revision + 1;
    if (now != s->revision) s->stale = 1;
    else s->kept++;
    s->revision = now;
    s->report->updates += changes != NULL;
    s->report->seconds[changes ? PG_SECONDS_UPDATE : PG_SECONDS_SHAPE] += pg_seconds () - t0;
    return status;
}

/* Mean of the first diagonal, and which unknowns are weak now. */
static void remember_diagonal (pg_system *s, const pg_sparse *K)
{
    double sum = 0;
    if (s->mean_diagonal > 0) return;
    for (size_t j = 0; j < s->ndof; j++) sum += s->diagonal0[j] = K->value[K->start[j + 1] - 1];
    s->mean_diagonal = sum / (double) s->ndof;
}

/* value = k K + m M + shift on weak unknowns */
static void combine (pg_system *s, const pg_sparse *K, const dynamics *dyn, double *value)
{
    double k = dyn ? dyn->k : 1, m = dyn ? dyn->m : 0;
    for (long q = 0; q < K->start[s->ndof]; q++) value[q] = k * K->value[q];
    for (size_t j = 0; j < s->ndof; j++) {
        long q = K->start[j + 1] - 1;
        double now = K->value[q], first = s->diagonal0[j];
        int weak = s->touched[j / (size_t) s->components] || !(first > 1e-9 * s->mean_diagonal) || fabs (now - first) > 1e-12 * first;
        value[q] += m * s->mass[j];
        if (m == 0 && weak) value[q] += s->shift * s->mean_diagonal;
    }
}

static pg_status build_matrix (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    const pg_sparse *K = s->force->matrix (s->self), *T = s->force->basis ? s->force->basis (s->self) : NULL;
    remember_diagonal (s, K);
    if (!T) {
        if (!s->A.value) {
            s->A = *K;
            s->A.value = NULL;
            PG_ALLOC (s->A.value, (size_t) K->start[s->ndof]);
        }
        combine (s, K, dyn, s->A.value);
    } else {
        pg_sparse full = *K;
        if (!s->copy) PG_ALLOC (s->copy, (size_t) K->start[s->ndof]);
        combine (s, K, dyn, s->copy);
        full.value = s->copy;
        pg_sparse_clear (&s->A);
        PG_TRY (pg_sparse_congruence (&s->A, &full, T));
    }
done:
    return status;
}

static pg_status analyse (pg_system *s)
{
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    int reduced = s->nred != s->ndof;
    pg_linear_options o = { reduced ? 1 : s->components, s->problem->dim, s->problem->threads, 0.01 * s->options->tolerance };
    PG_TRY (s->linear->analyse (&s->factor, &s->A, &o));
    pg_linear_info info;
    s->linear->info (s->factor, &info);
    s->report->factor_entries = info.factor_entries, s->report->factor_flops = info.flops;
    strncpy (s->report->ordering, info.ordering, sizeof s->report->ordering - 1);
    strncpy (s->report->solver, s->linear->name, sizeof s->report->solver - 1);
done:
    s->report->seconds[PG_SECONDS_ANALYSE] += pg_seconds () - t0;
    return status;
}

/* Factors; a matrix that is not positive definite gets a larger shift on its weak unknowns, then goes to UMFPACK (linear: auto). */
static pg_status factorize (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    int automatic = strcmp (s->options->linear, "auto") == 0;
    s->shift = 1e-11;
    for (;;) {
        double t0 = pg_seconds ();
        PG_TRY (build_matrix (s, dyn));
        s->report->seconds[PG_SECONDS_ASSEMBLE] += pg_seconds () - t0;
        if (!s->factor) PG_TRY (analyse (s));
        t0 = pg_seconds ();
        pg_status now = s->linear->factor (s->factor, &s->A);
        s->report->factorizations++;
        s->report->seconds[PG_SECONDS_FACTOR] += pg_seconds () - t0;
        if (now == PG_OK) break;
        if (now != PG_E_NOT_SPD) PG_TRY (now);
        if (s->shift < 1e-8) {
            s->shift *= 100;
            continue;
        }
        if (!automatic || s->umfpack) PG_FAIL (PG_E_NOT_SPD, "%s; with essential: nitsche raise method.nitsche_factor, or set solver.linear: umfpack",
                                               pg_last_error ());
        pg_report_warn (s->report, "K is not positive definite: UMFPACK instead of Cholesky from step %ld on (with essential: nitsche, a larger "
                        "method.nitsche_factor may help)", s->report->steps);
        s->linear->free (&s->factor);
        s->linear = pg_linear_find ("umfpack");
        s->umfpack = 1;
    }
    s->stale = 0;
done:
    return status;
}

/* ---- matrix-free ------------------------------------------------------------------------------------------------------- */
typedef struct { pg_system *s; const dynamics *dyn; const pg_sparse *T; } combined;

/* y = T' (k K + m M) T x */
static void apply_combined (void *context, const double *x, double *y)
{
    const combined *c = context;
    pg_system *s = c->s;
    double *z = c->T ? s->scratch : y;
    if (c->T) pg_sparse_multiply (c->T, x, s->full);
    const double *full = c->T ? s->full : x;
    system_multiply (s, full, z);
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] = c->dyn->k * z[i] + c->dyn->m * s->mass[i] * full[i];
    if (c->T) pg_sparse_multiply_transposed (c->T, z, y);
}

/* With T: of T' diag (k K + m M) T, which preconditions as well. */
static void diagonal_combined (void *context, double *d)
{
    const combined *c = context;
    pg_system *s = c->s;
    const pg_operator *op = operator_of (s);
    double *z = c->T ? s->scratch : d;
    op->diagonal (op->context, z);
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] = c->dyn->k * z[i] + c->dyn->m * s->mass[i];
    for (size_t j = 0; c->T && j < s->nred; j++) {
        d[j] = 0;
        for (long p = c->T->start[j]; p < c->T->start[j + 1]; p++) d[j] += c->T->value[p] * c->T->value[p] * z[c->T->row[p]];
    }
}

static pg_status solve_once (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    if (matrix_of (s)) {
        if (s->stale) PG_TRY (factorize (s, dyn));
        double t0 = pg_seconds ();
        pg_linear_info info;
        PG_TRY (s->linear->solve (s->factor, 1, s->reduced, s->delta));
        s->linear->info (s->factor, &info);
        s->report->cg_iterations = info.iterations;
        s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    } else {
        combined c = { s, dyn, s->force->basis ? s->force->basis (s->self) : NULL };
        pg_operator op = { s->nred, &c, apply_combined, diagonal_combined };
        size_t used = 0;
        double t0 = pg_seconds ();
        memset (s->delta, 0, s->ndof * sizeof *s->delta);
        PG_TRY (pg_conjugate_gradients (&op, s->reduced, s->delta, 1e-3 * s->options->tolerance, 20 * s->ndof + 1000, &used));
        s->report->cg_iterations += used;
        s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
        strcpy (s->report->solver, "cg");
    }
    s->report->solves++;
done:
    return status;
}

static double norm (const double *a, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * a[i];
    return sqrt (sum);
}

/* Where nothing resists (parts moved as rigid bodies) all forces are rounding, and their own size is no measure. This makes the
 * tolerance a backward error of 1e-14 there; with resistance it is far below the forces, and a loaded loose part, which the shift
 * holds at 1e-11 to 1e-9, stays far above it. */
static double force_of_rounding (const pg_system *s, const double *d)
{
    double sum = 0;
    if (!(s->mean_diagonal > 0)) return 0;
    for (size_t i = 0; i < s->ndof; i++) sum += s->diagonal0[i] * d[i] * s->diagonal0[i] * d[i];
    return 1e-14 / s->options->tolerance * sqrt (sum);
}

static pg_status measure_residual (pg_system *s, double t, const double *d, const dynamics *dyn, double *relative)
{
    pg_status status = PG_OK;
    double reference = 0, t0 = pg_seconds ();
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    PG_TRY (s->force->balance (s->self, t, d, s->residual, &reference));
    if (dyn) dyn->add (dyn->context, d, s->residual, &reference);
    if (T) pg_sparse_multiply_transposed (T, s->residual, s->reduced);
    else memcpy (s->reduced, s->residual, s->ndof * sizeof *s->reduced);
    if (T) reference = fmax (reference, norm (s->residual, s->ndof));
    reference = fmax (reference, force_of_rounding (s, d));
    double size = norm (s->reduced, s->nred);
    if (!isfinite (size)) PG_FAIL (PG_E_EQUILIBRIUM, "the out-of-balance force is not finite");
    *relative = reference > 0 ? size / reference : size > 0 ? 1 : 0;
done:
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* The unknown with the largest out-of-balance force; with elimination the reactions of the slaves are none. */
static size_t worst_unknown (const pg_system *s, const pg_sparse *T)
{
    size_t worst = 0;
    for (size_t i = 1; i < s->nred; i++) if (fabs (s->reduced[i]) > fabs (s->reduced[worst])) worst = i;
    if (!T) return worst;
    for (long q = T->start[worst]; q < T->start[worst + 1]; q++) if (T->value[q] == 1) return (size_t) T->row[q];
    return (size_t) T->row[T->start[worst]];
}

pg_status system_solve (pg_system *s, double t, double *d, const dynamics *dyn, double *residual)
{
    pg_status status = PG_OK;
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    double last = INFINITY, r = 0;
    if (s->force->impose && T) PG_TRY (s->force->impose (s->self, t, d));
    for (int k = 0; k <= MOST_REFINEMENTS; k++) {
        PG_TRY (measure_residual (s, t, d, dyn, &r));
        if (k > 1 && r > last) {                       /* the last refinement made it worse: take it back                */
            memcpy (d, s->best, s->ndof * sizeof *d);
            r = last;
            break;
        }
        if (r <= goal || k == MOST_REFINEMENTS || (k > 1 && r > 0.5 * last)) break;
        memcpy (s->best, d, s->ndof * sizeof *d);
        last = r;
        PG_TRY (solve_once (s, dyn));
        if (T) pg_sparse_multiply (T, s->delta, s->full);
        const double *step = T ? s->full : s->delta;
        for (size_t i = 0; i < s->ndof; i++) d[i] += step[i];
    }
    *residual = r;
    if (!(r <= s->options->tolerance)) {
        size_t worst = worst_unknown (s, T);
        PG_FAIL (PG_E_EQUILIBRIUM, "the residual stays at %.3g of the reference force (allowed %.3g), largest at point %zu (%g, %g, %g) m: "
                 "probably a loaded part has come loose; try prescribed displacements, newmark, or a coarser criterion",
                 r, s->options->tolerance, worst / (size_t) s->components,
                 s->problem->cloud.x[worst / (size_t) s->components * (size_t) s->problem->dim],
                 s->problem->dim > 1 ? s->problem->cloud.x[worst / (size_t) s->components * (size_t) s->problem->dim + 1] : 0,
                 s->problem->dim > 2 ? s->problem->cloud.x[worst / (size_t) s->components * (size_t) s->problem->dim + 2] : 0);
    }
done:
    return status;
}
