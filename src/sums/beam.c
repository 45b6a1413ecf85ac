/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds: moduli from the energy of uniform strain, calibration on the points at hand, the energy
 * of a straight cut, and the stiffness of one bond (Chen 2022, corrected in theory G1, G2, G5). */
#include "beam.h"
#include "sums_private.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846264338327950288;

double pg_beam_poisson (pg_mode mode)
{
    return mode == PG_LINE ? 0 : mode == PG_PLANE_STRESS ? 1.0 / 3 : 0.25;
}

static double moment (const pg_kernel *kernel, double horizon, int n)
{
    return pow (horizon, n + 1) * pg_kernel_moment (kernel, n);
}

/* Of the sum of shear stiffnesses: int k r^(dim - 2) dr */
static pg_status shear_moment (double *out, const pg_kernel *kernel, double horizon, int dim)
{
    pg_status status = PG_OK;
    double q = 1e-4, w;
    kernel->value (1, &q, &w, NULL);
    if (dim == 2 && w * q > 0.01)
        PG_FAIL (PG_E_USAGE, "kernel %s: the shear of short bonds has no bound in 2D; use constant",
                 kernel->name);
    *out = moment (kernel, horizon, dim - 2);
done:
    return status;
}

pg_status pg_beam_moduli (double *axial, double *shear, pg_mode mode, const pg_kernel *kernel, double horizon,
                          double E, double nu, double thickness)
{
    pg_status status = PG_OK;
    double across = 0;
    if (mode == PG_LINE) PG_FAIL (PG_E_USAGE, "bonds of a line bear no shear: use 2 or 3 dimensions");
    if (!(nu > -1) || !(nu <= pg_beam_poisson (mode) + 1e-9))
        PG_FAIL (PG_E_USAGE,
                 "Poisson's ratio %g of micropolar bonds must be at most %.6g: beyond, their shear stiffness "
                 "is negative and the body unstable",
                 nu, pg_beam_poisson (mode));
    PG_TRY (shear_moment (&across, kernel, horizon, mode == PG_SOLID ? 3 : 2));
    if (mode == PG_SOLID) {
        *axial = 3 * E / (2 * pi * moment (kernel, horizon, 3) * (1 - 2 * nu));
        *shear = E * (1 - 4 * nu) / (8 * pi * across * (1 + nu) * (1 - 2 * nu));
    } else if (mode == PG_PLANE_STRESS) {
        *axial = 2 * E / (pi * thickness * moment (kernel, horizon, 2) * (1 - nu));
        *shear = E * (1 - 3 * nu) / (6 * pi * thickness * across * (1 - nu * nu));
    } else {
        *axial = 2 * E / (pi * thickness * moment (kernel, horizon, 2) * (1 + nu) * (1 - 2 * nu));
        *shear = E * (1 - 4 * nu) / (6 * pi * thickness * across * (1 + nu) * (1 - 2 * nu));
    }
    if (fabs (nu - pg_beam_poisson (mode)) <= 1e-9) *shear = 0;  /* a third and a quarter are meant exactly */
done:
    return status;
}

void pg_beam_split (double *bond_modulus, double *dilation, pg_mode mode, double E, double nu,
                    double bond_poisson)
{
    double bonds, same;
    *bond_modulus = E * ((1 + bond_poisson) / (1 + nu));
    pg_state_moduli (mode, E, nu, dilation, &same);
    pg_state_moduli (mode, *bond_modulus, bond_poisson, &bonds, &same);
    *dilation -= bonds;
}

/* ---- points at hand ------------------------------------------------------------------------------------ */
static int ascending (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

/* sum of k beta V / r about a point whose family is whole, m^(dim - 1), by thickness; median */
static pg_status shear_of_cloud (double *out, const pg_sums *sums)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = sums->cloud;
    pg_family family = { 0 };
    double *volume = NULL, *sum = NULL, most = 0;
    size_t whole = 0;
    PG_TRY (pg_sums_family (&family, sums));
    PG_ALLOC (volume, cloud->n);
    PG_ALLOC (sum, cloud->n);
    for (size_t i = 0; i < cloud->n; i++) {
        for (size_t e = family.start[i]; e < family.start[i + 1]; e++) {
            size_t j = (size_t) family.node[e];
            sums_bond b = pg_sums_bond_between (&sums->rule, cloud, i, j);
            double ratio = 0.5 * (pg_cloud_ratio (cloud, i) + pg_cloud_ratio (cloud, j));
            volume[i] += b.beta * cloud->volume[j] / pow (pg_cloud_ratio (cloud, i), cloud->dim);
            sum[i] += ratio * ratio * b.weight / b.r * cloud->volume[j] / cloud->thickness;
        }
        most = fmax (most, volume[i]);
    }
    for (size_t i = 0; i < cloud->n; i++) if (volume[i] >= 0.8 * most) sum[whole++] = sum[i];
    qsort (sum, whole, sizeof *sum, ascending);
    *out = whole % 2 ? sum[whole / 2] : 0.5 * (sum[whole / 2 - 1] + sum[whole / 2]);
done:
    pg_free (volume), pg_free (sum);
    pg_family_clear (&family);
    return status;
}

/* Of each bond towards +axis as many cross a cut of one cell's width as it has sites along the axis. */
static void lattice_cuts (pg_beam_sums *out, const pg_stencil *s, double thickness)
{
    for (int axis = 0; axis < s->dim; axis++)
        for (size_t b = 0; b < s->n; b++) {
            double far = s->xi[b * (size_t) s->dim + (size_t) axis] * s->cell * thickness / s->dim;
            if (s->offset[3*b + (size_t) axis] <= 0) continue;
            out->along += s->weight[b] * s->r[b] * far;
            out->across += s->weight[b] / s->r[b] * far;
        }
}

pg_status pg_beam_measure (pg_beam_sums *out, const pg_sums *sums)
{
    pg_status status = PG_OK;
    const pg_sum_rule *rule = &sums->rule;
    const pg_stencil *s = &sums->stencil;
    int dim = sums->cloud->dim;
    double whole = 0, found = 0, thickness = sums->cloud->thickness;
    *out = (pg_beam_sums) { .calibration = 1 };
    if (dim < 2) PG_FAIL (PG_E_USAGE, "bonds of a line bear no shear: use 2 or 3 dimensions");
    if (rule->calibrate) {
        PG_TRY (shear_moment (&whole, rule->kernel, rule->horizon, dim));
        for (size_t b = 0; b < s->n; b++) found += s->weight[b] / s->r[b] * s->cell;
        if (s->n == 0) PG_TRY (shear_of_cloud (&found, sums));
        out->calibration = (dim == 3 ? 4 * pi : 2 * pi) * whole / found;
    }
    if (rule->calibrate && s->n) lattice_cuts (out, s, thickness);
    else {
        out->along = dim == 3 ? pi * moment (rule->kernel, rule->horizon, 4)
                              : 2 * thickness * moment (rule->kernel, rule->horizon, 3);
        out->across = dim == 3 ? pi * moment (rule->kernel, rule->horizon, 2)
                               : 2 * thickness * moment (rule->kernel, rule->horizon, 1);
    }
done:
    return status;
}

/* ---- one bond ------------------------------------------------------------------------------------------ */
static double between (const double *c, size_t i, size_t j)
{
    double a = c[i], b = c[j];
    return a == b ? a : a + b > 0 ? 2 * a * b / (a + b) : 0;
}

pg_beam pg_beam_between (const pg_bond_loop_setting *s, size_t i, size_t j, const double *xi, double weight)
{
    const pg_cloud *cloud = s->sums->cloud;
    double rr = beam_dot (cloud->dim, xi, xi), r = sqrt (rr),
           all = weight * (cloud->volume[i] * cloud->volume[j]) / r, ratio = 1;
    if (cloud->size) ratio = 0.5 * (pg_cloud_ratio (cloud, i) + pg_cloud_ratio (cloud, j));
    double wide = all * (ratio * ratio), length = s->beams->length;
    return (pg_beam) { 12 * between (s->beams->shear, i, j) * wide / rr, between (s->modulus, i, j) * all,
                       between (s->beams->bending, i, j) * wide / (length * length) };
}

/* X q = q x xi */
static void lever_matrix (int dim, const double *xi, double X[3][3])
{
    memset (X, 0, 9 * sizeof **X);
    if (dim == 2) X[0][0] = -xi[1], X[1][0] = xi[0];
    else {
        X[0][1] = xi[2], X[0][2] = -xi[1];
        X[1][0] = -xi[2], X[1][2] = xi[0];
        X[2][0] = xi[1], X[2][1] = -xi[0];
    }
}

void pg_beam_blocks (int dim, const double *xi, const pg_beam *b, double length, double *own, double *other)
{
    int m = beam_unknowns (dim), turns = m - dim;
    double X[3][3], rr = beam_dot (dim, xi, xi), s = 0.5 / length, g = (b->along - b->shear) / rr;
    lever_matrix (dim, xi, X);
    for (int a = 0; a < dim; a++) {
        for (int c = 0; c < dim; c++) {
            double A = g * xi[a] * xi[c] + (a == c ? b->shear : 0);
            own[a * m + c] = A, other[a * m + c] = -A;
        }
        for (int t = 0; t < turns; t++) {
            double C = b->shear * s * X[a][t];
            own[a * m + dim + t] = own[(dim + t) * m + a] = C;
            other[a * m + dim + t] = C, other[(dim + t) * m + a] = -C;
        }
    }
    for (int t = 0; t < turns; t++)
        for (int v = 0; v < turns; v++) {
            double P = dim == 2 ? 1 : (t == v) - xi[t] * xi[v] / rr, shear = b->shear * s * s * rr * P,
                   bend = b->bending * P;
            own[(dim + t) * m + dim + v] = shear + bend, other[(dim + t) * m + dim + v] = shear - bend;
        }
}

void pg_beam_strain (int dim, const double *xi, double length, const double *di, const double *dj,
                     double *shear, double *bending)
{
    double w[3], diff[3], s;
    beam_motion (dim, 0.5 / length, xi, di, dj, w, diff);
    beam_measures (dim, 1 / length, xi, 1 / beam_dot (dim, xi, xi), w, diff, &s, shear, bending);
    *shear = sqrt (*shear), *bending = sqrt (*bending);
}
