/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fewer quadrature points with the same moments. Where the pieces of a surface are many, so are the slices
 * between their edges, and a cell gets thousands of points, each of which would have a hundred nodes in its
 * support.
 *
 * The box of the points is divided into m^dim boxes. All points in one become one, at their centroid and with
 * their weight together: constants and linear functions keep their sums. The weights then change in the
 * smallest way, relative to each, that restores the sums of all polynomials of degree 3 (1, x, ..., z^3; 20
 * in 3D): w (1 + c.p), c from the moment matrix of the few points. m grows from 3 to 6 until the matrix can
 * be factored safely and all weights stay positive; moments of measures with many points can be carried by
 * positive weights on as many points as there are moments (Tchakaloff 1957), so that this hardly fails. */
#include "cut.h"
#include <math.h>
#include <string.h>

/* MOMENTS: number of polynomials up to degree 3 in 3D. FEW: cells with at most so many points keep them all.
 * FINEST: most boxes of the grid along an axis. */
enum { MOMENTS = 20, FEW = 40, FINEST = 6 };

/* Values of the polynomials of degree 3 at z; returns how many: 4, 10, 20. */
static int polynomials (int dim, const double *z, double *p)
{
    int n = 0;
    double x[3] = { z[0], dim > 1 ? z[1] : 0, dim > 2 ? z[2] : 0 };
    for (int c = 0; c <= (dim > 2 ? 3 : 0); c++)
        for (int b = 0; b + c <= (dim > 1 ? 3 : 0); b++) {
            double v = 1;
            for (int k = 0; k < c; k++) v *= x[2];
            for (int k = 0; k < b; k++) v *= x[1];
            for (int a = 0; a + b + c <= 3; a++, v *= x[0]) p[n++] = v;
        }
    return n;
}

/* The box of the points: its middle and its half edges. */
static void box_of (size_t n, const double *x, size_t dim, double *middle, double *half)
{
    for (size_t k = 0; k < dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < n; i++) low = fmin (low, x[i * dim + k]), high = fmax (high, x[i * dim + k]);
        middle[k] = 0.5 * (low + high), half[k] = high > low ? 0.5 * (high - low) : 1;
    }
}

/* Tries a grid of m boxes along each axis: writes the new points to `few` (room for m^dim). Returns 1 on
 * success. */
static int gather (pg_cut_points *few, const pg_cut_points *all, size_t first, size_t dim, int m,
                   const double *middle, const double *half)
{
    size_t boxes = 1, n = all->n - first, kept = 0;
    double p[MOMENTS], G[MOMENTS * MOMENTS] = { 0 }, c[MOMENTS] = { 0 }, z[3], total = 0;
    for (size_t k = 0; k < dim; k++) boxes *= (size_t) m;
    memset (few->weight, 0, boxes * sizeof *few->weight);
    memset (few->x, 0, boxes * dim * sizeof *few->x);
    int moments = 0;
    for (size_t i = 0; i < n; i++) {
        const double *x = all->x + (first + i) * dim;
        size_t at = 0;
        double w = all->weight[first + i];
        for (size_t k = dim; k-- > 0;) {
            z[k] = (x[k] - middle[k]) / half[k];
            at = at * (size_t) m + (size_t) fmin (m - 1, fmax (0, floor (0.5 * (z[k] + 1) * m)));
        }
        few->weight[at] += w, total += w;
        for (size_t k = 0; k < dim; k++) few->x[at * dim + k] += w * z[k];
        moments = polynomials ((int) dim, z, p);
        for (int a = 0; a < moments; a++) c[a] += w * p[a];
    }
    for (size_t b = 0; b < boxes; b++) {
        double w = few->weight[b];
        if (!(w > 1e-12 * total)) continue;
        for (size_t k = 0; k < dim; k++) z[k] = few->x[b * dim + k] / w;
        polynomials ((int) dim, z, p);
        for (int a = 0; a < moments; a++) {
            c[a] -= w * p[a];
            for (int e = 0; e <= a; e++) G[a * moments + e] += w / total * p[a] * p[e];
        }
        few->weight[kept] = w;
        memcpy (few->x + kept++ * dim, z, dim * sizeof *z);
    }
    for (int a = 0; a < moments; a++) c[a] /= total;
    if (kept <= (size_t) moments || pg_dense_cholesky (moments, G, 1e-7) != 0) return 0;
    pg_dense_solve (moments, G, c);
    for (size_t i = 0; i < kept; i++) {
        double factor = 1;
        polynomials ((int) dim, few->x + i * dim, p);
        for (int a = 0; a < moments; a++) factor += c[a] * p[a];
        if (!(factor > 0.05)) return 0;
        few->weight[i] *= factor;
        for (size_t k = 0; k < dim; k++) few->x[i * dim + k] = middle[k] + half[k] * few->x[i * dim + k];
    }
    few->n = kept;
    return 1;
}

pg_status cut_compress (pg_cut_points *all, size_t first, int dim)
{
    pg_status status = PG_OK;
    pg_cut_points few = { 0 };
    size_t n = all->n - first, d = (size_t) dim;
    double middle[3], half[3];
    if (n <= FEW) return PG_OK;
    box_of (n, all->x + first * d, d, middle, half);
    for (int m = 3; m <= FINEST; m++) {
        size_t boxes = (size_t) m * (size_t) (dim > 1 ? m : 1) * (size_t) (dim > 2 ? m : 1);
        if (boxes >= n) break;
        pg_cut_points_clear (&few);
        PG_ALLOC (few.x, boxes * d);
        PG_ALLOC (few.weight, boxes);
        if (!gather (&few, all, first, d, m, middle, half)) continue;
        memcpy (all->x + first * d, few.x, few.n * d * sizeof *few.x);
        memcpy (all->weight + first, few.weight, few.n * sizeof *few.weight);
        all->n = first + few.n;
        break;
    }
done:
    pg_cut_points_clear (&few);
    return status;
}
