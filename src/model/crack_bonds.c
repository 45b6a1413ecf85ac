/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds that new pieces of cracks cut, facets in the plane and triangles in space. Only the new ones are
 * asked, through an index of their own (geometry/cloud/crack_index.c): first the box of all of them,
 * then for each
 * point the boxes near it, then its bonds. */
#include "model.h"
#include <math.h>
#include <stdlib.h>

/* How far apart the ends of a bond may be along an axis, m, where supports are no wider than usual. Partial
 * volumes reach half a cell further. */
static double reach_of (const pg_problem *p)
{
    double largest = 1, reach = 0;
    for (size_t i = 0; p->cloud.size && i < p->cloud.n; i++)
        largest = fmax (largest, pg_cloud_ratio (&p->cloud, i));
    for (int k = 0; k < p->dim; k++) reach = fmax (reach, p->approx.horizon * largest + p->cloud.step[k]);
    return reach;
}

/* Several tips or fronts may advance before the bonds die: those that two of them cut are listed once. */
static void sort_changes (pg_changes *cut)
{
    size_t n = 0;
    pg_sort (cut->bond, cut->n, sizeof *cut->bond, pg_ascending_sizes);
    for (size_t i = 0; i < cut->n; i++)
        if (n == 0 || cut->bond[i] != cut->bond[n - 1]) cut->bond[n++] = cut->bond[i];
    cut->n = n;
}

/* Adds the live bonds of point q of a set that the cracks cut. */
static pg_status cut_at (const pg_state *s, const pg_problem *p, const pg_cracks *cracks, int set, size_t q,
                         pg_changes *cut)
{
    pg_status status = PG_OK;
    const pg_rows *r = &p->rows[set];
    size_t dim = (size_t) p->dim;
    const double *x = r->x + dim * q;
    for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++) {
        size_t bond = p->first_bond[set] + e;
        int j = r->family.node[e];
        if (!s->alive[bond] || j == r->own[q]
            || !pg_cracks_cut (cracks, x, p->cloud.x + dim * (size_t) j, pg_cloud_same (&p->cloud)))
            continue;
        PG_GROW (cut->bond, cut->cap, cut->n + 1);
        cut->bond[cut->n++] = bond;
    }
done:
    return status;
}

pg_status pg_bonds_cut_by (const pg_state *s, const pg_problem *p, pg_crack *piece, size_t n, pg_changes *cut)
{
    pg_status status = PG_OK;
    pg_cracks fresh = { .dim = p->dim, .crack = piece, .n = n };
    size_t dim = (size_t) p->dim, before = cut->n;
    double low[3], high[3], reach = reach_of (p), all[6] = { INFINITY, INFINITY, INFINITY, -INFINITY,
                                                             -INFINITY, -INFINITY };
    if (n == 0) return PG_OK;
    PG_TRY (pg_cracks_index (&fresh));
    for (size_t c = 0; c < n; c++)
        for (size_t k = 0; k < dim; k++)
            all[k] = fmin (all[k], fresh.box[2 * dim * c + k]),
            all[3 + k] = fmax (all[3 + k], fresh.box[2 * dim * c + dim + k]);
    for (int set = 0; set < PG_BOND_SETS; set++)
        for (size_t q = 0; q < p->rows[set].n; q++) {
            const double *x = p->rows[set].x + dim * q;
            double far = p->rows[set].wide ? reach * p->rows[set].wide[q] : reach;
            int away = 0;
            for (size_t k = 0; k < dim; k++) low[k] = x[k] - far, high[k] = x[k] + far;
            for (size_t k = 0; k < dim && !away; k++) away = high[k] < all[k] || low[k] > all[3 + k];
            if (away) continue;
            if (pg_cracks_near (&fresh, low, high)) PG_TRY (cut_at (s, p, &fresh, set, q, cut));
        }
    if (before) sort_changes (cut);
done:
    pg_cracks_clear_index (&fresh);
    return status;
}
