/* SPDX-License-Identifier: GPL-3.0-or-later
 * In which order the quadrature of a cut cell takes the axes. The order must depend on the shape of the
 * surfaces alone: a body in another unit, moved, mirrored or turned by 90 degrees has the same points. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* steep: per axis the components of the surface normals at `centre`, each normal divided by its largest
 * component, summed over the surfaces in use. bent: the sums of |A_kk|, a measure of their curvature. */
static void find_steepness (const cut_slices *s, int surface, const double *centre, double *steep,
                            double *bent)
{
    for (int k = 0; k < 3; k++) steep[k] = bent[k] = 0;
    for (size_t i = 0; i < s->n; i++) {
        const cut_quadric *q = &s->level[0].q[i];
        double g[3], size = 0;
        if (s->mute[i] || (surface >= 0 && (size_t) surface != i)) continue;
        cut_gradient (q, centre, g);
        for (int k = 0; k < s->dim; k++) size = fmax (size, fabs (g[k])), bent[k] += fabs (q->A[k][k]);
        /* the gradient of a round surface is only rounding where the centre of the cell is its own centre */
        if (size < s->equal) continue;
        for (int k = 0; k < s->dim; k++) steep[k] += fabs (g[k]) / size;
    }
}

/* Does `order` sort the axes by ascending steepness of the surfaces, and equal ones by descending
 * curvature? */
static int rises (const cut_slices *s, const int *order, const double *steep, const double *bent)
{
    for (int k = 1; k < s->dim; k++) {
        int a = order[k - 1], b = order[k];
        double rise = steep[b] - steep[a];
        if (fabs (rise) <= s->equal) rise = bent[a] - bent[b];
        if (rise < -s->equal) return 0;
    }
    return 1;
}

int cut_axes (cut_slices *s, const struct pg_cut *cut, int surface, int fixed, int side, int order[6][3])
{
    static const int all[6][3] = { { 0, 1, 2 }, { 1, 0, 2 }, { 0, 2, 1 },
                                   { 2, 0, 1 }, { 1, 2, 0 }, { 2, 1, 0 } };
    int n = 0, dim = s->dim;
    double steep[3], bent[3], centre[3] = { 0, 0, 0 };
    s->square = 1;
    for (size_t i = 0; i < s->n; i++)
        s->square &= s->mute[i] || (cut->surface[s->number[i]].axis >= 0 && !s->facets[i]);
    if (fixed >= 0) centre[fixed] = side;
    find_steepness (s, surface, centre, steep, bent);
    if (fixed >= 0) steep[fixed] = -1;
    for (int p = 0; p < (dim == 3 ? 6 : dim); p++)
        if (rises (s, all[p], steep, bent) && !(n > 0 && s->square))
            memcpy (order[n++], all[p], sizeof *order);
    /* no order passed, because near ties form a cycle by rounding: take any */
    for (int p = 0; n == 0; p++)
        if (fixed < 0 || all[p][0] == fixed) memcpy (order[n++], all[p], sizeof *order);
    return n;
}

int cut_on_face (const cut_slices *s, size_t i, int axis, int side)
{
    double centre[3] = { 0, 0, 0 }, half[3] = { 0, 0, 0 };
    for (int k = 0; k < s->dim; k++) {
        if (k == axis) centre[k] = side;
        else half[k] = 1;
        if (s->low[3*i + (size_t) k] > centre[k] + half[k] + 1e-7
            || s->high[3*i + (size_t) k] < centre[k] - half[k] - 1e-7) return 0;
    }
    return cut_meets (&s->level[0].q[i], centre, half, 2 * s->snap);
}
