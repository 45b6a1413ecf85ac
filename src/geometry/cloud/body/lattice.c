/* SPDX-License-Identifier: GPL-3.0-or-later
 * Background lattice: round (L / spacing) equal cells along each axis of the bounding box, and whole cells
 * in the layers outside of it. A cell is kept when its centre lies in the body. A centre on the surface
 * counts as inside (to 1e-9 of a step), whichever side it is approached from, so that symmetric bodies have
 * symmetric lattices. */
#include "perigal/cloud.h"
#include <limits.h>
#include <math.h>
#include <string.h>

double pg_lattice_tolerance (const pg_lattice *l)
{
    double step = INFINITY;
    const double *origin = l->whole[0] ? l->whole_origin : l->origin,
                 *high = l->whole[0] ? l->whole_high : l->high;
    for (int k = 0; k < l->dim; k++) step = fmin (step, l->step[k]);
    return 1e-9 * step + pg_rounding (l->dim, origin, high);
}

/* Number of cells along axis k of the body without its layers, in [low, high] (m); *more: of those in the
 * layers on both sides. */
static double cells_along (const pg_body *body, int k, double spacing, double *low, double *high,
                           double *more)
{
    *low = body->low[k], *high = body->high[k], *more = 0;
    for (size_t i = 0; i < body->nlayer; i++)
        if (body->layer[i].side / 2 == k) *(body->layer[i].side % 2 ? high : low) = body->layer[i].face;
    double cells = fmax (1, floor ((*high - *low) / spacing + 0.5)),
           outside = *low - body->low[k] + (body->high[k] - *high);
    if (outside > 0) *more = fmax (0, floor (outside / ((*high - *low) / cells) + 0.5));
    return cells;
}

/* Sets counts, steps and corners; an offset shifts the lattice towards the low side and adds a cell. */
static pg_status fit_axes (pg_lattice *l, const pg_body *body, double spacing, const double *offset)
{
    pg_status status = PG_OK;
    double vertices = 1;
    for (int k = 0; k < 3; k++) l->count[k] = 1, l->step[k] = 1;
    for (int k = 0; k < l->dim; k++) {
        double low, high, more, cells = cells_along (body, k, spacing, &low, &high, &more);
        double shift = offset ? offset[k] - ceil (offset[k]) : 0;                  /* in (-1, 0] */
        vertices *= cells + more + 2;
        /* Counted as floating-point numbers, which cannot overflow. */
        if (!(vertices < INT_MAX))
            PG_FAIL (PG_E_LIMIT, "spacing %g m gives more than %d cells", spacing, INT_MAX);
        l->step[k]   = (high - low) / cells;
        l->count[k]  = (int) (cells + more) + (shift < 0);
        l->origin[k] = body->low[k] + shift * l->step[k];
        l->high[k]   = shift < 0 ? body->high[k] + (1 + shift) * l->step[k] : body->high[k];
    }
done:
    return status;
}

/* Finds which cells have their centre in the body. The tolerance follows from the steps, which must be known
 * before any centre is tested. */
static pg_status fill (pg_lattice *l, const pg_body *body)
{
    pg_status status = PG_OK;
    PG_ALLOC (l->in, (size_t) l->count[0] * (size_t) l->count[1] * (size_t) l->count[2]);
    double tolerance = pg_lattice_tolerance (l);
    unsigned char *in = l->in;
    for (int c = 0; c < l->count[2]; c++)
        for (int b = 0; b < l->count[1]; b++)
            for (int a = 0; a < l->count[0]; a++) {
                double i[3] = {a + 0.5, b + 0.5, c + 0.5}, x[3] = {0, 0, 0};
                for (int k = 0; k < l->dim; k++) x[k] = pg_lattice_at (l, k, i[k]);
                *in++ = (unsigned char) pg_body_inside (body, x, tolerance);
            }
done:
    return status;
}

/* Reduces the lattice to the cells `part`; corners are those of its cells in the whole lattice. */
static void take_part (pg_lattice *l, const pg_box *part)
{
    memcpy (l->whole, l->count, sizeof l->whole);
    memcpy (l->whole_origin, l->origin, sizeof l->origin);
    memcpy (l->whole_high, l->high, sizeof l->high);
    for (int k = 0; k < l->dim; k++) {
        double low = pg_lattice_at (l, k, part->low[k]), high = pg_lattice_at (l, k, part->high[k]);
        l->first[k] = part->low[k], l->count[k] = part->high[k] - part->low[k];
        l->origin[k] = low, l->high[k] = high;
    }
}

pg_status pg_lattice_fit_part (pg_lattice *out, const pg_body *body, double spacing, const double *offset,
                               const pg_box *part)
{
    pg_status status = PG_OK;
    memset (out, 0, sizeof *out);
    out->dim = body->dim;
    if (!(spacing > 0) || !isfinite (spacing)) PG_FAIL (PG_E_USAGE, "spacing %g m must be positive", spacing);
    for (int k = 0; k < body->dim; k++)
        if (!(body->high[k] > body->low[k]) || !isfinite (body->high[k] - body->low[k]))
            PG_FAIL (PG_E_USAGE, "the body has no size");
    PG_TRY (fit_axes (out, body, spacing, offset));
    if (!part) goto done;
    take_part (out, part);
    PG_TRY (fill (out, body));
done:
    if (status != PG_OK) pg_lattice_clear (out);
    return status;
}

pg_status pg_lattice_fit (pg_lattice *out, const pg_body *body, double spacing, const double *offset)
{
    pg_status status = PG_OK;
    PG_TRY (pg_lattice_fit_part (out, body, spacing, offset, NULL));
    PG_TRY (fill (out, body));
done:
    if (status != PG_OK) pg_lattice_clear (out);
    return status;
}

int pg_lattice_goes_on (const pg_lattice *l, const int *i)
{
    for (int k = 0; k < l->dim; k++)
        if (i[k] + l->first[k] < 0 || i[k] + l->first[k] >= l->whole[k]) return 0;
    return 1;
}

/* Computed from the nearer end of the lattice, so that mirror images have the same bits. */
double pg_lattice_at (const pg_lattice *l, int axis, double i)
{
    int part = l->whole[0] > 0;
    double n = part ? l->whole[axis] : l->count[axis], low = part ? l->whole_origin[axis] : l->origin[axis],
           high = part ? l->whole_high[axis] : l->high[axis];
    i += l->first[axis];
    if (2 * i == n) return 0.5 * (low + high);
    return 2 * i < n ? low + i * l->step[axis] : high - (n - i) * l->step[axis];
}

void pg_lattice_clear (pg_lattice *lattice)
{
    pg_free (lattice->in);
    memset (lattice, 0, sizeof *lattice);
}
