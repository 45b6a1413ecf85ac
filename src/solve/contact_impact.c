/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact in time steps: pairs whose faces have met within a step, and the impulses that give back what they
 * lost by it (newmark_start.c newmark_rebound). */
#include "contact.h"
#include <math.h>

/* Gaps, over the largest that forces of the step have closed. */
static const double APART = 1e-9;

pg_status contact_impacts (const pg_system *s, const double *d, double *nodal, double *work)
{
    pg_status status = PG_OK;
    const struct system_contact *c = s->contact;
    size_t n = c->pieces.n, dim = c->pieces.dim;
    double *gap = NULL, *force = NULL, moved = 0;
    *work = 0;
    PG_ALLOC (gap, dim * n);
    PG_ALLOC (force, dim * n);
    pg_sparse_multiply_transposed (&c->G, d, gap);
    /* faces that stay together are apart by rounding */
    for (size_t i = 0; i < dim * n; i += dim) moved = fmax (moved, c->C[i * dim * n + i] * c->force[i]);
    for (size_t k = 0; k < n; k++) {
        double before = gap[dim * k] + c->initial[dim * k], f = c->force[dim * k] / c->weight;
        c->rebound[k] = before > APART * moved && f > 0 ? f : 0;
        if (c->rebound[k] == 0) continue;
        force[dim * k] = f, *work += f * before;
    }
    pg_sparse_multiply (&c->G, force, nodal);
done:
    pg_free (gap), pg_free (force);
    return status;
}

void contact_rebound (const pg_system *s, double times)
{
    for (size_t k = 0; k < s->contact->pieces.n; k++) s->contact->rebound[k] *= times;
}
