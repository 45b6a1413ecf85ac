/* SPDX-License-Identifier: GPL-3.0-or-later
 * The matrix T' (k K + m M) T of a linear system and its factor. Unknowns that breaking has touched get a
 * spring of WEAK_SPRING of the mean diagonal, so that isolated nodes and loose fragments stay put; the
 * refinement of solutions takes its effect out again wherever the body can carry load. */
#include "solve/run/body_parts.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Frees what was made for a factor: K gets its own diagonal back; copies, and K reduced by constraints, are
 * freed. */
void system_release_matrix (pg_system *s)
{
    system_factor *f = &s->direct;
    if (f->own_diagonal) {
        const pg_sparse *K = pg_force_matrix (s->force, s->self);
        for (size_t j = 0; j < s->ndof; j++) K->value[K->start[j + 1] - 1] = f->own_diagonal[j];
    }
    if (f->owned) pg_sparse_clear (&f->A);
    pg_free (f->own_diagonal), pg_free (f->copy);
    f->A = (pg_sparse) { 0 };
    f->own_diagonal = f->copy = NULL, f->owned = 0;
}

/* *value: the array for the values of the matrix: of static K those of K itself, whose diagonal is kept
 * meanwhile, else a copy. Linear solvers without a factor go on reading the matrix they were given. */
static pg_status take_values (pg_system *s, const pg_sparse *K, const dynamics *dyn, double **value)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    int copies = dyn || s->options->plain || !f->linear->factors;
    *value = K->value;
    if (copies) {
        PG_ALLOC (f->copy, (size_t) K->start[s->ndof]);
        *value = f->copy;
        goto done;
    }
    PG_ALLOC (f->own_diagonal, s->ndof);
    for (size_t j = 0; j < s->ndof; j++) f->own_diagonal[j] = K->value[K->start[j + 1] - 1];
done:
    return status;
}

/* value = k K + m M, with a spring on weak unknowns: those of touched nodes, those without stiffness from the
 * start, and those whose diagonal has changed. Unknowns with very little stiffness from the start get a share
 * of it, which refinement corrects. With mass only unknowns without mass are singular. */
static void combine (pg_system *s, const pg_sparse *K, const dynamics *dyn, double *value)
{
    system_factor *f = &s->direct;
    double k = dyn ? dyn->k : 1, m = dyn ? dyn->m : 0;
    for (long q = 0; value != K->value && q < K->start[s->ndof]; q++) value[q] = k * K->value[q];
    for (size_t j = 0; j < s->ndof; j++) {
        long q = K->start[j + 1] - 1;
        double now = K->value[q], first = f->diagonal0[j];
        int weak = f->touched[j / (size_t) s->components] || !(first > 1e-9 * f->mean_diagonal)
                   || fabs (now - first) > 1e-12 * first;
        int gone = !(now > 1e-12 * fmax (first, 1e-9 * f->mean_diagonal));
        if (m == 0 && weak && f->shift == 0 && gone)
            value[q] += first > 1e-9 * f->mean_diagonal ? first : f->mean_diagonal;
        else if (m == 0 && weak)
            value[q] += f->shift * (gone || first > 1e-9 * f->mean_diagonal ? f->mean_diagonal : now);
    }
    for (size_t j = 0; m == 0 && j < f->props.n; j++)
        value[K->start[f->props.unknown[j] + 1] - 1] += f->mean_diagonal;
    if (m != 0) system_add_mass_matrix (s, m, K, value);
    /* a point that is no evaluation point's neighbour has no consistent mass either */
    for (size_t j = 0; j < s->ndof && m != 0; j++) {
        long q = K->start[j + 1] - 1;
        if (!(fabs (value[q]) > 1e-11 * k * f->mean_diagonal)) value[q] += 1e-11 * k * f->mean_diagonal;
    }
}

/* Frees the matrix made for a factor; K too in statics where nothing breaks: one factor serves the whole
 * run. */
static void let_all_go (pg_system *s, const dynamics *dyn)
{
    system_release_matrix (s);
    const pg_sparse *K;
    if (dyn || s->problem->criterion->type || s->options->plain || s->contact || !system_operator (s))
        return;
    s->direct.forgotten = s->force->matrix (s->self, PG_MATRIX_FREED, &K) == PG_OK && !K->value;
}

/* Assembles K, adds mass and springs, and eliminates constraints (T' K T). Without constraints the pattern is
 * that of K, which is borrowed. */
static pg_status build_matrix (pg_system *s, const dynamics *dyn)
{
    pg_status status = PG_OK;
    const pg_sparse *K, *T = system_basis (s);
    PG_TRY (pg_force_assemble (s->force, s->self, &K));
    pg_sparse full = *K;
    system_remember_diagonal (s, K);
    system_release_matrix (s);
    PG_TRY (take_values (s, K, dyn, &full.value));
    combine (s, K, dyn, full.value);
    if (!T) s->direct.A = full;
    else {
        pg_sparse reduced;
        PG_TRY (pg_sparse_congruence (&reduced, &full, T));
        let_all_go (s, dyn);
        s->direct.A = reduced, s->direct.owned = 1;
    }
done:
    return status;
}

/* For linear solvers that call back when they have read the matrix. */
typedef struct { pg_system *s; const dynamics *dyn; } matrix_owner;
static void taken (void *context)
{
    const matrix_owner *o = context;
    let_all_go (o->s, o->dyn);
}

/* Factors A, whose values are freed as soon as the linear solver has them, if it has a factor of its own. */
static pg_status make_factor (pg_system *s, const dynamics *dyn)
{
    system_factor *f = &s->direct;
    matrix_owner owner = { s, dyn };
    if (!f->linear->factors) return f->linear->factor (f->factor, &f->A);
    pg_status status = f->linear->factor_taking && !s->options->plain
                           ? f->linear->factor_taking (f->factor, &f->A, taken, &owner)
                           : f->linear->factor (f->factor, &f->A);
    system_release_matrix (s);
    return status;
}

/* Ordering and symbolic factor, once: breaking only removes entries. After elimination unknowns no longer
 * come in blocks of a node. */
static pg_status analyse (pg_system *s)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    double t0 = pg_seconds ();
    int reduced = s->nred != s->ndof;
    pg_linear_options o = { reduced ? 1 : s->components, s->problem->dim, s->problem->threads,
                            0.01 * s->options->tolerance, s->problem->criterion->type != NULL };
    PG_TRY (f->linear->analyse (&f->factor, &f->A, &o));
    pg_linear_info info;
    f->linear->info (f->factor, &info);
    s->report->linear.factor_entries = info.factor_entries, s->report->linear.factor_flops = info.flops;
    strncpy (s->report->linear.ordering, info.ordering, sizeof s->report->linear.ordering - 1);
    strncpy (s->report->linear.solver, f->linear->name, sizeof s->report->linear.solver - 1);
done:
    s->report->seconds[PG_SECONDS_ANALYSE] += pg_seconds () - t0;
    return status;
}

/* The smallest pivot of the last factorization over the largest: parts that nothing holds leave a pivot of
 * the size of rounding. */
static double pivots (const pg_system *s)
{
    pg_linear_info info;
    s->direct.linear->info (s->direct.factor, &info);
    return info.pivots;
}
static const double least_pivot = 1e-13;

/* Marks the nodes of parts that supports do not hold as touched. 1: there are such parts. */
static int touch_free_parts (pg_system *s)
{
    body_parts parts;
    int any = 0;
    if (body_parts_find (&parts, s) != PG_OK) return 0;
    for (size_t i = 0; i < s->problem->cloud.n && parts.n; i++)
        if (parts.part[parts.of[i]].n) s->direct.touched[i] = 1, any = 1;
    body_parts_clear (&parts);
    return any;
}

/* Puts springs on all unknowns, or those of parts that supports do not fully hold, once (returns 1): bonds of
 * a chain or a sheet, though none has negative energy, leave motions free, and rounding decides whether such
 * a matrix is positive definite. Whether loads that need no support balance, the residual tells. */
static int weaken_all (pg_system *s, const dynamics *dyn)
{
    system_factor *f = &s->direct;
    if (f->all_weak) return 0;
    if (s->problem->sums) memset (f->touched, 1, s->problem->cloud.n);
    else if (dyn || !touch_free_parts (s)) return 0;
    f->all_weak = 1, f->shift = WEAK_SPRING;
    return 1;
}

/* Factors the matrix. Where a factor serves many events the springs of weak unknowns would show in all of
 * them: they are left out as long as no part is loose, and uncoupled unknowns without stiffness get their old
 * one. A matrix that is not positive definite gets larger springs on its weak unknowns (1e-11, 1e-9, 1e-7 of
 * the mean diagonal), then on all where bonds (chains, sheets) or supports leave motions free; other Galerkin
 * forms get a solver for general matrices (linear: auto), as Nitsche terms with too small a factor make K
 * indefinite. */
pg_status system_factorize (pg_system *s, const dynamics *dyn)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    int automatic = strcmp (s->options->linear, "auto") == 0;
    int try = s->updates.serves && !f->loose && !dyn && !f->indefinite;
    f->shift = try ? 0 : WEAK_SPRING;
    for (;;) {
        double t0 = pg_seconds ();
        PG_TRY (build_matrix (s, dyn));
        s->report->seconds[PG_SECONDS_ASSEMBLE] += pg_seconds () - t0;
        if (!f->factor) PG_TRY (analyse (s));
        t0 = pg_seconds ();
        pg_status now = make_factor (s, dyn);
        s->report->linear.factorizations++;
        s->report->seconds[PG_SECONDS_FACTOR] += pg_seconds () - t0;
        if (now == PG_OK && !(f->shift == 0 && pivots (s) < least_pivot)) break;
        if (now != PG_E_NOT_SPD) PG_TRY (now);
        if (f->shift == 0) {
            f->shift = WEAK_SPRING, f->loose = 1;
            continue;
        }
        if (f->shift < 1e-8) {
            f->shift *= 100;
            continue;
        }
        if (weaken_all (s, dyn)) continue;
        if (s->problem->sums)
            PG_FAIL (
                PG_E_NOT_SPD,
                "%s; bonds leave parts of the body free to move: constrain them, or set solver.linear: %s",
                pg_last_error (), pg_linear_first (1, 0)->name);
        if (!automatic || f->indefinite)
            PG_FAIL (PG_E_NOT_SPD,
                     "%s; with essential: nitsche raise method.nitsche_factor, or set solver.linear: %s",
                     pg_last_error (), pg_linear_first (0, 1)->name);
        pg_statistics_warn (s->report,
                            "K is not positive definite: UMFPACK instead of Cholesky from step %ld on (with "
                            "essential: nitsche, a larger "
                            "method.nitsche_factor may help)",
                            s->report->steps);
        f->linear->free (&f->factor);
        f->linear = pg_linear_first (0, 1);
        f->indefinite = 1;
    }
    f->stale = 0;
    f->unshifted = f->shift < 1e-10;
    PG_TRY (system_remember_alive (s));
done:
    if (status != PG_OK) system_release_matrix (s);
    return status;
}

int system_can_factor (const pg_system *s) { return system_has_matrix (s) && s->direct.linear->factors; }

int system_factors (const pg_system *s)
{
    return s->choice.mode == SYSTEM_FACTOR || s->choice.mode == SYSTEM_KEPT_FACTOR;
}

int system_has_factor (const pg_system *s)
{
    return s->direct.factor && !s->direct.stale && s->direct.linear->factors
           && (system_factors (s) || s->choice.mode == SYSTEM_UNDECIDED);
}
