/* SPDX-License-Identifier: GPL-3.0-or-later
 * Least distance of a platen from the surface of the body. Sampling points of the surface are a fraction of a
 * spacing apart; to find the point of first contact between them, distances around the nearest one are fitted
 * by a parabola (3D: paraboloid), whose minimum is taken. */
#include "perigal/contact.h"
#include <math.h>
#include <string.h>

/* In spacings: radius of the points fitted around the nearest one; range in which the minimum is searched. */
static const double FITTED = 1.25, BESIDE = 0.5;
enum { MOST = 6, STEPS = 20 };

/* Terms of the fit: 1, s, s^2 and in 3D t, s t, t^2; s, t in spacings. Returns their number. */
static size_t terms (size_t dim, double s, double t, double *out)
{
    out[0] = 1, out[1] = s, out[2] = s * s;
    if (dim == 2) return 3;
    out[3] = t, out[4] = s * t, out[5] = t * t;
    return MOST;
}

/* Computes unit directions e normal to n: one in 2D, two in 3D. */
static void across (size_t dim, const double *n, double e[2][3])
{
    size_t least = 0;
    double along, size = 0;
    memset (e, 0, 2 * sizeof *e);
    if (dim == 2) {
        e[0][0] = -n[1], e[0][1] = n[0];
        return;
    }
    for (size_t k = 1; k < 3; k++) if (fabs (n[k]) < fabs (n[least])) least = k;
    along = n[least];
    for (size_t k = 0; k < 3; k++) e[0][k] = (k == least) - along * n[k], size += e[0][k] * e[0][k];
    for (size_t k = 0; k < 3; k++) e[0][k] /= sqrt (size);
    for (size_t k = 0; k < 3; k++)
        e[1][k] = n[(k + 1) % 3] * e[0][(k + 2) % 3] - n[(k + 2) % 3] * e[0][(k + 1) % 3];
}

/* Fits the distances around point `nearest`: coefficients a, in spacings; returns their number, 0: too few
 * points. */
static size_t fit (const pg_contact_pieces *pieces, const pg_platen *platen, size_t nearest, double h,
                   double *a)
{
    size_t dim = pieces->dim, n = dim == 2 ? 3 : MOST, count = 0;
    const double *x0 = pieces->x + nearest * dim;
    double A[MOST * MOST] = { 0 }, term[MOST], normal[3] = { 0 }, e[2][3], other[3];
    pg_platen_distance (platen, (int) dim, x0, normal);
    across (dim, normal, e);
    memset (a, 0, n * sizeof *a);
    for (size_t q = 0; q < pieces->npoint; q++) {
        const double *x = pieces->x + q * dim;
        double at[2] = { 0 }, square = 0;
        for (size_t k = 0; k < dim; k++) {
            double to = (x[k] - x0[k]) / h;
            square += to * to, at[0] += to * e[0][k], at[1] += to * e[1][k];
        }
        if (square > FITTED * FITTED) continue;
        double distance = pg_platen_distance (platen, (int) dim, x, other) / h;
        if (!isfinite (distance)) continue;
        terms (dim, at[0], at[1], term), count++;
        for (size_t i = 0; i < n; i++) {
            a[i] += term[i] * distance;
            for (size_t j = 0; j < n; j++) A[i * n + j] += term[i] * term[j];
        }
    }
    if (count < n || pg_dense_cholesky ((int) n, A, 1e-9)) return 0;
    pg_dense_solve ((int) n, A, a);
    return n;
}

double pg_platen_touches (const pg_contact_pieces *pieces, const pg_platen *platen, double h)
{
    size_t dim = pieces->dim, nearest = 0;
    double least = INFINITY, normal[3], a[MOST], term[MOST], found;
    for (size_t q = 0; q < pieces->npoint; q++) {
        double distance = pg_platen_distance (platen, (int) dim, pieces->x + q * dim, normal);
        if (distance < least) least = distance, nearest = q;
    }
    size_t n = isfinite (least) ? fit (pieces, platen, nearest, h, a) : 0;
    found = least / h;
    for (int i = -STEPS; i <= STEPS && n; i++)
        for (int j = dim == 3 ? -STEPS : 0; j <= (dim == 3 ? STEPS : 0); j++) {
            double sum = 0;
            terms (dim, BESIDE * i / STEPS, BESIDE * j / STEPS, term);
            for (size_t k = 0; k < n; k++) sum += a[k] * term[k];
            found = fmin (found, sum);
        }
    return fmax (fmin (least, 0), found * h);          /* no overlap unless a sampling point overlaps */
}
