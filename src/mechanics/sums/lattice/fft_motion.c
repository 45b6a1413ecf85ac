/* SPDX-License-Identifier: GPL-3.0-or-later
 * The motion that is subtracted from displacements before they are transformed. Rounding errors of transforms
 * have the size of u, those of sums over bonds that of eta: the uniform strain (or rigid motion) that fits u
 * best, by least squares over a sample of the points, is subtracted, so that the rest and its rounding errors
 * are small. */
#include "fft_convolution.h"
#include <math.h>
#include <string.h>

/* Moments of a sample of points: their mean position and displacement (m), sum r r and sum v r (m^2) with
 * positions r and displacements v relative to these. */
typedef struct { double centre[3], shift[3], rr[9], vr[9]; } moments;

/* Computes the moments of a sample of at most 1024 points, spread by the golden ratio, so that they do not
 * lie on one line or row of the lattice; points without intact bonds are left out, as they may be anywhere.
 * */
static moments sample (const transformer *t, const double *u)
{
    enum { SAMPLES = 1024 };
    const pg_cloud *cloud = t->s->setting.sums->cloud;
    size_t dim = (size_t) t->dim, n = cloud->n, all = n < SAMPLES ? n : SAMPLES, count = 0, point[SAMPLES];
    moments m = { 0 };
    for (size_t k = 0; k < all; k++) {
        double golden = 0.6180339887498949 * (double) k;  /* spreads points along rows and across them */
        size_t i = all == n ? k : (size_t) ((golden - floor (golden)) * (double) n);
        if (t->chi[t->s->place[i]] == 0) continue;
        for (size_t d = 0; d < dim; d++) m.centre[d] += cloud->x[i*dim + d], m.shift[d] += u[i*dim + d];
        point[count++] = i;
    }
    for (size_t d = 0; count && d < dim; d++) m.centre[d] /= (double) count, m.shift[d] /= (double) count;
    for (size_t k = 0; k < count; k++)
        for (size_t d = 0; d < dim; d++)
            for (size_t c = 0; c < dim; c++) {
                double r = cloud->x[point[k]*dim + c] - m.centre[c];
                m.rr[3 * d + c] += (cloud->x[point[k] * dim + d] - m.centre[d]) * r,
                    m.vr[3 * d + c] += (u[point[k] * dim + d] - m.shift[d]) * r;
            }
    return m;
}

/* Gradient G of the rotation turn x r that fits best: J turn = sum r x v, J the tensor of inertia of the
 * sample. J is singular for points on a line: then G is 0. */
static void fit_turn (const moments *m, int dim, double *G)
{
    double J[9], turn[3], all = m->rr[0] + m->rr[4] + m->rr[8];
    memset (G, 0, 9 * sizeof *G);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        turn[a] = m->vr[3*c + b] - m->vr[3*b + c];
        for (int k = 0; k < 3; k++) J[3*a + k] = (a == k ? all : 0) - m->rr[3*a + k];
    }
    if (dim < 2 || !(all > 0)) return;
    if (dim == 2) turn[0] = turn[1] = 0, turn[2] /= all;
    else if (pg_dense_cholesky (3, J, 1e-9) != 0) return;
    else pg_dense_solve (3, J, turn);
    for (int a = 0; a < 3; a++) {
        int b = (a + 1) % 3, c = (a + 2) % 3;
        G[3*c + b] = turn[a], G[3*b + c] = -turn[a];
    }
}

/* The uniform gradient G that fits best: G sum r r = sum v r, row by row; if sum r r is singular, as points
 * lie in a line or plane, that of the rotation. */
static void fit_strain (const moments *m, int dim, double *G)
{
    double J[9];
    for (int a = 0; a < dim; a++) for (int b = 0; b < dim; b++) J[a*dim + b] = m->rr[3*a + b];
    if (pg_dense_cholesky (dim, J, 1e-9) != 0) {
        fit_turn (m, dim, G);
        return;
    }
    for (int d = 0; d < dim; d++) {
        double row[3] = { m->vr[3*d], m->vr[3*d + 1], m->vr[3*d + 2] };
        pg_dense_solve (dim, J, row);
        for (int k = 0; k < dim; k++) G[3*d + k] = row[k];
    }
}

/* Fits a motion shift + (base + slope . site) to u, which is subtracted before the transforms. Base and slope
 * are multiples of a unit so coarse that no sum of them is rounded at any site. strained: uniform strain,
 * with the whole shift in base; else a rigid motion. */
void pg_fft_fit_motion (transformer *t, const double *u, int strained)
{
    const pg_sums *sums = t->s->setting.sums;
    const pg_sites *sites = &sums->sites;
    moments m = sample (t, u);
    double G[9] = { 0 };
    int at[3], site = sites->site[0];
    (strained ? fit_strain : fit_turn) (&m, t->dim, G);
    for (int k = 0; k < 3; k++) at[k] = site % sites->count[k], site /= sites->count[k];
    memset (t->off.base, 0, sizeof t->off.base), memset (t->off.slope, 0, sizeof t->off.slope);
    for (int d = 0; d < t->dim; d++) {
        double base = strained ? m.shift[d] : 0, most = 0, slope[3] = { 0 };
        t->off.shift[d] = m.shift[d] - base;
        for (int k = 0; k < t->dim; k++) {
            base += G[3*d + k] * (sums->cloud->x[k] - at[k] * sites->step[k] - m.centre[k]);
            slope[k] = G[3*d + k] * sites->step[k], most += fabs (slope[k]) * sites->count[k];
        }
        most += fabs (base);
        if (!(most > 0) || !isfinite (most)) continue;
        double unit = ldexp (1, ilogb (most) - 51);
        t->off.base[d] = unit * nearbyint (base / unit);
        for (int k = 0; k < t->dim; k++) t->off.slope[3*d + k] = unit * nearbyint (slope[k] / unit);
    }
}

/* The motion along a row: shift + (from + k by) at its site k, m. Row = y + (rows along y) z. */
void pg_fft_motion_of (const transformer *t, size_t row, int d, double *from, double *by)
{
    size_t ny = (size_t) t->s->setting.sums->sites.count[1];
    *from = t->off.base[d] + t->off.slope[3 * d + 1] * (double) (row % ny)
            + t->off.slope[3 * d + 2] * (double) (row / ny);
    *by = t->off.slope[3*d];
}
