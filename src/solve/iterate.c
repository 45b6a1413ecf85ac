/* SPDX-License-Identifier: GPL-3.0-or-later
 * T' (k K + m M) T delta = T' R without a matrix, by conjugate gradients: preconditioned by the diagonal
 * (small time steps, where the mass dominates, and bodies whose factor would not fit), or by the factor of an
 * earlier K, which breaking has changed a little. */
#include "solve.h"
#include <string.h>

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
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] *= c->dyn->k;
    if (c->dyn) system_add_mass (s, c->dyn->m, full, z);
    if (c->T) pg_sparse_multiply_transposed (c->T, z, y);
}

/* With T: of T' diag (k K + m M) T, which preconditions as well. */
static void diagonal_combined (void *context, double *d)
{
    const combined *c = context;
    pg_system *s = c->s;
    const pg_operator *op = s->force->operator_ (s->self);
    double *z = c->T ? s->scratch : d;
    op->diagonal (op->context, z);
    for (size_t i = 0; c->dyn && i < s->ndof; i++) z[i] *= c->dyn->k;
    if (c->dyn) system_add_mass_diagonal (s, c->dyn->m, z);
    for (size_t j = 0; c->T && j < s->nred; j++) {
        d[j] = 0;
        for (long p = c->T->start[j]; p < c->T->start[j + 1]; p++)
            d[j] += c->T->value[p] * c->T->value[p] * z[c->T->row[p]];
    }
}

/* The factor of an earlier K as preconditioner: breaking changes K a little, so that a few iterations make
 * up for it. */
static pg_status by_factor_of_before (void *context, const double *r, double *z)
{
    pg_system *s = context;
    return s->linear->solve (s->factor, 1, r, z);
}

/* Conjugate gradients on the reduced unknowns, from zero; counts what they cost. */
pg_status system_iterate (pg_system *s, const dynamics *dyn, int by_factor, double tolerance, size_t limit,
                          size_t *used)
{
    combined c = { s, dyn, s->force->basis ? s->force->basis (s->self) : NULL };
    pg_operator op = { s->nred, &c, apply_combined, diagonal_combined };
    pg_preconditioner P = { s, by_factor_of_before, s->problem->threads };
    double t0 = pg_seconds ();
    system_remember_diagonal (s, NULL);
    memset (s->delta, 0, s->ndof * sizeof *s->delta);
    pg_status status = pg_conjugate_gradients_with (&op, by_factor ? &P : NULL, s->reduced, s->delta,
                                                    tolerance, limit, used);
    s->report->cg_iterations += *used;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    if (!by_factor) strcpy (s->report->solver, "cg");
    if (!by_factor && !s->multilevel) strcpy (s->report->preconditioner, "jacobi");
    return status;
}
