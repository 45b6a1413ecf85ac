/* SPDX-License-Identifier: GPL-3.0-or-later
 * The motion that is taken off displacements before they are transformed. Transforms round by the size of u,
 * sums over bonds by that of the differences eta: without the uniform strain (or rigid motion) that fits u
 * best, found by least squares over a sample of the points, little is left of u, and little is rounded. */
#include "fft_convolution.h"
#include <math.h>
#include <string.h>

/* Moments of some points spread over the body: their mean place and displacement, sum r r and sum v r about
 * these */
typedef struct { double centre[3], shift[3], rr[9], vr[9]; } moments;

/* Moments of a sample of at most 1024 points, spread by the golden ratio, so that they lie on no line or row
 * of the lattice; those without live bonds are left out, as they may fly anywhere. */
static moments sample (const transformer *t, const double *u)
{
    enum { SAMPLES = 1024 };
    const pg_cloud *cloud = t->s->setting.sums->cloud;
    size_t dim = (size_t) t->dim, n = cloud->n, all = n < SAMPLES ? n : SAMPLES, count = 0, point[SAMPLES];
    moments m = { 0 };
    for (size_t k = 0; k < all; k++) {
        double golden = 0.6180339887498949 * (double) k;  /* as spread along rows as across them */
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

/* Gradient of the best rotation turn x r by least squares: J turn = sum r x v, J the tensor of inertia of
 * the sample. Singular for points on a line, which leaves no rotation. */
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

/* The best uniform gradient: G sum r r = sum v r, row by row; points in a line or plane, whose sum r r is
 * singular, have that of the rotation. */
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

/* Fits a motion shift + (base + slope . site) to u, to be taken off before the transforms. Base and slope are
 * multiples of a unit so coarse that no sum of them is rounded at any site. strained: u is a small remainder,
 * and all of the shift goes into base, so that u loses no digit. */
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

/* The motion along a row: shift + (from + k by) at its site k. Rows are numbered y first. */
void pg_fft_motion_of (const transformer *t, size_t row, int d, double *from, double *by)
{
    size_t ny = (size_t) t->s->setting.sums->sites.count[1];
    *from = t->off.base[d] + t->off.slope[3 * d + 1] * (double) (row % ny)
            + t->off.slope[3 * d + 2] * (double) (row / ny);
    *by = t->off.slope[3*d];
}
