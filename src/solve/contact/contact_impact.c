/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact in time steps: pairs whose faces have met within a step, and the impulses that give back the energy
 * lost by it (newmark_start.c newmark_rebound).
 *
 * Cracks grow at the end of a step, when its forces have done their work, and their faces are then divided
 * into other pieces. Mean gaps that were zero are not zero over these, and faces that have just been parted
 * may overlap by the variation of the field between their points. To separate them at once would take an
 * impulse that adds energy; so a new piece closes where it is: its gap counts from its overlap, until the
 * faces have moved further apart, and its slip from the present slip. Nothing jumps, and no work is done. */
#include "contact.h"
#include <math.h>

/* Gaps above this share of the largest gap closed by forces of the step are open. */
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
    /* faces that stay together have gaps of the size of rounding */
    for (size_t i = 0; i < dim * n; i += dim)
        moved = fmax (moved, c->compliance.C[i * dim * n + i] * c->force[i]);
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

void contact_accelerate (const pg_system *s, double *a)
{
    const double *force = s->balance.pressed;
    for (size_t i = 0; force && i < s->ndof; i++) a[i] += force[i] / (s->contact->weight * s->mass[i]);
}

/* Makes the pieces of the present cracks, and their memory from the means of the displacement d of the state
 * over them. */
pg_status contact_renew (pg_system *s, const pg_state *state)
{
    pg_status status = PG_OK;
    struct system_contact *c = s->contact;
    if (!c || !c->is.waits) return PG_OK;
    PG_TRY (contact_refresh (s, state, NULL));
    contact_layout l = contact_layout_of (c->pieces.dim);
    pg_sparse_multiply_transposed (&c->G, state->d, c->gap);
    for (size_t k = 0; k < c->ncrack; k++) {
        size_t i = c->pieces.dim * k;
        double *v = c->now.value + k * l.values;
        contact_vector (&c->pieces, k, c->gap + i + 1, 1, v + l.accepted);
        v[l.overlap] = fmax (0, -c->gap[i]);
        s->report->contact.overlap = fmax (s->report->contact.overlap, v[l.overlap]);
        c->gap[i] += v[l.overlap];
    }
    contact_recall (c);
done:
    return status;
}
