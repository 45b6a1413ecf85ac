/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds: moduli from the energy of uniform strain, calibration on a lattice or cloud, the energy
 * of a straight cut, and the stiffness of one bond (Chen 2022, corrected in theory G1, G2, G5). */
#include "beam.h"
#include "sums_private.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846264338327950288;

/* Poisson's ratio at which bonds need no shear stiffness: 1/3 in plane stress, 1/4 in plane strain and 3D
 * (theory A). Above it the shear stiffness of a beam would be negative. */
double pg_beam_poisson (pg_mode mode)
{
    return mode == PG_LINE ? 0 : mode == PG_PLANE_STRESS ? 1.0 / 3 : 0.25;
}

/* int_0^horizon k (r / horizon) r^n dr, m^(n + 1). */
static double moment (const pg_kernel *kernel, double horizon, int n)
{
    return pow (horizon, n + 1) * pg_kernel_moment (kernel, n);
}

/* int_0^horizon k r^(dim - 2) dr, m^(dim - 1): the integral for shear stiffnesses, which fall with 1 / r. In
 * 2D the integrand is k itself, which must be bounded at r = 0, as the value must not depend on the shortest
 * bonds. */
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

/* Axial modulus c_n and shear modulus c_t of bonds, whose stiffnesses are c_n k V V / r and 12 c_t k V V
 * / r^3. They follow from the energy of a body in uniform strain without rotation, which must be that of
 * E and nu: two equations, one from the dilatation and one from the shear (Chen 2022, with the
 * corrections of theory G1). The denominators vanish where the 2D or 3D bulk modulus becomes infinite. At nu
 * = pg_beam_poisson the shear modulus is set to exactly zero. */
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
    if (fabs (nu - pg_beam_poisson (mode)) <= 1e-9) *shear = 0;  /* a rounded 1/3 or 1/4 counts as exact */
done:
    return status;
}

/* Splits E and nu of a body into bonds with another Poisson's ratio and an energy of the dilatation: the
 * bonds have the shear modulus E / (2 (1 + nu)) of the body, from which their Young's modulus follows; the
 * dilatation has the difference in bulk modulus, Pa (theory G3). */
void pg_beam_split (double *bond_modulus, double *dilation, pg_mode mode, double E, double nu,
                    double bond_poisson)
{
    double bonds, same;
    *bond_modulus = E * ((1 + bond_poisson) / (1 + nu));
    pg_state_moduli (mode, E, nu, dilation, &same);
    pg_state_moduli (mode, *bond_modulus, bond_poisson, &bonds, &same);
    *dilation -= bonds;
}

/* ---- sums over the bonds of these points --------------------------------------------------------------- */
/* Sum of k beta V / r over the bonds of a point inside the body, m^(dim - 1) for unit thickness: the discrete
 * counterpart of shear_moment times the unit circle or sphere. Irregular points have no stencil, so that it
 * is the median over the points whose family is whole (at least 0.8 of the largest family volume), which is
 * robust. In graded clouds families are scaled to the spacing h of the cloud by `ratio`. */
static pg_status shear_of_cloud (double *out, const pg_sums *sums)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = sums->cloud;
    pg_family family = { 0 };
    double *volume = NULL, *sum = NULL;
    PG_TRY (pg_sums_family (&family, sums, NULL));
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
    }
    PG_TRY (pg_sums_median (out, cloud, volume, sum));
done:
    pg_free (volume), pg_free (sum);
    pg_family_clear (&family);
    return status;
}

/* Sums over the bonds that cross a straight cut, for the energy of a crack along the lattice, averaged over
 * the axes. A bond of the stencil towards +axis crosses a cut of one cell's width xi_axis / step times, each
 * time with the weight of a cell. along: sum of k beta r, for stretched bonds; across: of k beta / r, for
 * sheared ones. */
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

/* Measures the sums of this lattice or cloud: `calibration` scales the shear stiffness so that a uniform
 * shear has the exact energy; along and across are the integrals over a cut, or on a lattice with calibration
 * the sums over it, so that limits of these bonds follow from a fracture energy. */
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
/* Harmonic mean of a constant of two points, as of springs in series; 0 if it is 0 at one end. */
static double between (const double *c, size_t i, size_t j)
{
    double a = c[i], b = c[j];
    return a == b ? a : a + b > 0 ? 2 * a * b / (a + b) : 0;
}

/* Stiffnesses of one bond, N/m: along c_n k beta V V / r, shear 12 c_t k beta V V / r^3, bending over
 * length^2. In a graded cloud shear and bending scale with the square of the local spacing, hence the square
 * of `ratio`. */
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

/* Makes the matrix X with X q = q x xi, m. */
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

/* Blocks of the stiffness matrix of a bond for one of its ends, N/m: `own` for the unknowns of this end,
 * `other` for those of the other end, both m x m with m unknowns of a point (dim displacements, then
 * rotations times the length). For the other end `other` is transposed, bit by bit, so that K is symmetric to
 * the last digit. */
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

/* Shear gamma (1) and bending kappa (rad, relative rotation of the ends across the bond) of one bond; both
 * are >= 0. */
void pg_beam_strain (int dim, const double *xi, double length, const double *di, const double *dj,
                     double *shear, double *bending)
{
    double w[3], diff[3], s;
    beam_motion (dim, 0.5 / length, xi, di, dj, w, diff);
    beam_measures (dim, 1 / length, xi, 1 / beam_dot (dim, xi, xi), w, diff, &s, shear, bending);
    *shear = sqrt (*shear), *bending = sqrt (*bending);
}
