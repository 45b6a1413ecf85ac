/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts of the body that supports do not hold: what a crack has cut off, or a block that lies on platens. K
 * is singular along their rigid motions R. As many springs as there are motions, on unknowns of these parts,
 * make it regular without any force of their own: with f such that R' (F + G' f) = 0 a statically determinate
 * set of springs bears nothing, so that the solution of the sprung system is one of K, and all others differ
 * from it by R y. The amounts y are unknowns beside the forces of contact (Farhat and Roux 1991;
 * contact_free.c). */
#include "contact.h"
#include <math.h>
#include <string.h>

/* A body with more free motions is rubble, too large for a dense system. */
enum { MOST_MODES = 120 };

/* Adds the free motions of a part, and for each an unknown that identifies it: the largest entry of its
 * column after elimination of the others. */
static pg_status add_motions (const pg_system *s, const body_parts *parts, contact_loose *l, size_t number)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    const body_part *part = &parts->part[number];
    size_t dim = (size_t) p->dim, each = (size_t) s->components, ndof = p->cloud.n * each, first = l->n;
    size_t count = part->n;
    double *left = NULL;
    PG_ALLOC (left, count * ndof);
    PG_GROW (l->mode, l->cap_mode, (first + count) * ndof);
    PG_GROW (l->prop, l->cap_prop, first + count);
    PG_GROW (l->part, l->cap_part, first + count);
    PG_GROW (l->motion, l->cap_motion, first + count);
    memset (l->mode + first * ndof, 0, count * ndof * sizeof *left);
    for (size_t i = 0; i < p->cloud.n; i++) {
        if ((size_t) parts->of[i] != number) continue;
        for (size_t m = 0; m < count; m++) {
            double u[6];
            body_part_shift (s, part, p->cloud.x + i * dim, part->motion[m], u);
            memcpy (l->mode + (first + m) * ndof + i * each, u, each * sizeof *u);
        }
    }
    memcpy (left, l->mode + first * ndof, count * ndof * sizeof *left);
    for (size_t m = 0; m < count; m++) {
        size_t at = 0;
        for (size_t i = 1; i < ndof; i++)
            if (fabs (left[m * ndof + i]) > fabs (left[m * ndof + at]) * (1 + 1e-9)) at = i;
        l->prop[first + m] = at;
        for (size_t o = m + 1; o < count; o++) {
            double share = left[o * ndof + at] / left[m * ndof + at];
            for (size_t i = 0; i < ndof; i++) left[o * ndof + i] -= share * left[m * ndof + i];
        }
        l->part[first + m] = *part, l->motion[first + m] = m;
    }
    l->n += count;
done:
    pg_free (left);
    return status;
}

pg_status loose_refresh (contact_loose *l, const pg_system *s)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    body_parts parts = { 0 };
    l->n = 0;
    PG_TRY (body_parts_find (&parts, s));
    for (size_t r = 0; r < parts.n; r++) {
        if (parts.part[r].points <= (size_t) p->dim) continue;
        if (l->n + parts.part[r].n > MOST_MODES)
            PG_FAIL (PG_E_USAGE,
                     "more than %d rigid motions of parts of the body are held by contact alone, which is "
                     "too many for equilibria: prescribe displacements of these parts, or use a solver of "
                     "motion",
                     MOST_MODES);
        if (parts.part[r].n) PG_TRY (add_motions (s, &parts, l, r));
    }
    PG_GROW (l->amount, l->cap_amount, l->n);
    PG_GROW (l->target, l->cap_target, l->n);
    for (size_t j = 0; j < l->n; j++) l->amount[j] = l->target[j] = 0;
done:
    body_parts_clear (&parts);
    return status;
}

void loose_free (contact_loose *l)
{
    pg_free (l->mode), pg_free (l->prop), pg_free (l->part), pg_free (l->motion);
    pg_free (l->amount), pg_free (l->target);
    memset (l, 0, sizeof *l);
}

/* ---- springs ------------------------------------------------------------------------------------------- */
double loose_pull (const pg_system *s, const double *d)
{
    const contact_loose *l = &s->contact->loose;
    double most = 0;
    for (size_t j = 0; j < l->n; j++)
        most = fmax (most, s->direct.mean_diagonal * fabs (d[l->prop[j]] - l->target[j]));
    return most;
}

void loose_move (contact_loose *l, size_t ndof, size_t j, double by, double *d)
{
    const double *mode = l->mode + j * ndof;
    if (by == 0) return;
    l->amount[j] += by;
    for (size_t i = 0; i < ndof; i++) d[i] += by * mode[i];
    for (size_t k = 0; k < l->n; k++) l->target[k] += by * mode[l->prop[k]];
}
