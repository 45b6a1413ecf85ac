/* SPDX-License-Identifier: GPL-3.0-or-later
 * T' (k K + m M) T delta = T' R without a matrix, by conjugate gradients: preconditioned by the diagonal
 * (small time steps, where the mass dominates, and bodies whose factor would not fit), or by the factor of an
 * earlier K, which breaking has changed a little. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

/* image: (k K + m M) T x of the last product, all ndof rows of it */
typedef struct {
    pg_system *s;
    const dynamics *dyn;
    const pg_sparse *T;
    const double *image;
    double keep;  /* residual, N, at which an iterate is kept; 0: at none */
} combined;

/* y = T' (k K + m M) T x */
static void apply_combined (void *context, const double *x, double *y)
{
    combined *c = context;
    pg_system *s = c->s;
    double *z = c->T ? s->balance.scratch : y;
    c->image = z;
    const double *full = system_step (s, x);
    system_multiply (s, full, z);
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] *= c->dyn->k;
    if (c->dyn) system_add_mass (s, c->dyn->m, full, z);
    if (c->dyn) system_clear_ghosts (s, z);
    if (c->T) pg_sparse_multiply_transposed (c->T, z, y);
}

/* The diagonal that preconditions: of T' (k K + m M) T. Where the mass dominates, the diagonal of the first K
 * serves as well, and need not be summed over all bonds again after each break. */
static void diagonal_combined (void *context, double *d)
{
    const combined *c = context;
    pg_system *s = c->s;
    const pg_operator *op = s->force->operator_ (s->self);
    double *z = c->T ? s->balance.scratch : d;
    if (c->dyn && s->choice.mode == SYSTEM_DIAGONAL && !s->options->plain)
        memcpy (z, s->direct.diagonal0, s->ndof * sizeof *z);
    else op->diagonal (op->context, z);
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] *= c->dyn->k;
    if (c->dyn) system_add_mass_diagonal (s, c->dyn->m, z);
    for (size_t j = 0; c->T && j < s->nred; j++) {
        d[j] = 0;
        for (long p = c->T->start[j]; p < c->T->start[j + 1]; p++)
            d[j] += c->T->value[p] * c->T->value[p] * z[c->T->row[p]];
    }
}

/* Keeps the first iterate whose residual is below `keep`: how much later ones move tells its error. */
static void keep_earlier (combined *c)
{
    pg_system *s = c->s;
    if (s->iterative.rough.found) return;
    if (c->T) pg_sparse_multiply_transposed (c->T, s->balance.residual, s->balance.scratch);
    double size = system_norm (s, c->T ? s->balance.scratch : s->balance.residual, s->nred);
    if (size > c->keep) return;
    memcpy (s->iterative.rough.earlier, s->balance.delta, s->nred * sizeof *s->balance.delta);
    s->iterative.rough.found = size > c->keep / ROUGHER ? 1 : -1;  /* the last iterate does not count */
}

/* Updates the residual of all rows, of prescribed unknowns too, after an iteration; calls rough.look. */
static pg_status carry_residual (void *context, double alpha, double residual, int *stop)
{
    combined *c = context;
    pg_system *s = c->s;
    s->iterative.fell = residual;
    for (size_t i = 0; i < s->ndof; i++) s->balance.residual[i] -= alpha * c->image[i];
    if (c->keep > 0) keep_earlier (c);
    return s->iterative.rough.look ? s->iterative.rough.look (s->iterative.rough.looking, residual, stop)
           : PG_OK;
}

/* 1: a later round of breaking in a small time step, where the diagonal preconditions and a break affects
 * only as many nodes as a wave reaches in a few steps. */
static int is_local (const pg_system *s, const dynamics *dyn)
{
    return dyn && s->choice.mode == SYSTEM_DIAGONAL && !s->choice.begins && !s->options->plain
           && !s->problem->sums;
}

/* Solves by conjugate gradients on the reduced unknowns, from zero, and counts what they cost. In dynamics
 * `residual` becomes that of the new state, by the sums that the iterations make anyway. */
pg_status system_iterate (pg_system *s, const dynamics *dyn, const pg_preconditioner *P, double tolerance,
                          size_t limit, size_t *used)
{
    system_balance *b = &s->balance;
    system_iterations *it = &s->iterative;
    combined c = { s, dyn, system_basis (s), NULL, 0 };
    pg_operator op = { s->nred, &c, apply_combined, diagonal_combined };
    int carries = dyn && !s->options->plain;
    double t0 = pg_seconds ();
    system_remember_diagonal (s, NULL);
    memset (b->delta, 0, s->ndof * sizeof *b->delta);
    it->fell = tolerance, it->rough.nview = 0;
    if (carries && it->rough.goal > 0) c.keep = ROUGHER * it->rough.goal * b->unbalanced;
    pg_cg_watch watch = { carries ? carry_residual : NULL, &c, is_local (s, dyn),
                          system_is_shared (s), &it->cg_room };
    pg_status status = pg_conjugate_gradients_watched (&op, P, b->reduced, b->delta, tolerance, limit, used,
                                                       &watch);
    b->carried = carries && status == PG_OK;
    s->report->linear.cg_iterations += *used;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}
