/* SPDX-License-Identifier: GPL-3.0-or-later
 * Principal stresses sigma_1 >= sigma_2 >= sigma_3: closed forms, and Jacobi rotations where the closed form
 * of 3D loses digits (two values nearly equal). */
#include "perigal/material.h"
#include <math.h>

/* Sorts three numbers, largest first. */
static void sort3 (double *s)
{
    double t;
    if (s[0] < s[1]) t = s[0], s[0] = s[1], s[1] = t;
    if (s[1] < s[2]) t = s[1], s[1] = s[2], s[2] = t;
    if (s[0] < s[1]) t = s[0], s[0] = s[1], s[1] = t;
}

/* Principal stresses of a 2D stress (xx, yy, xy) by Mohr's circle, and the stress zz across the plane,
 * sorted. */
static void plane (const double *s, double zz, double *principal)
{
    double mean = (s[0] + s[1]) / 2, radius = hypot ((s[0] - s[1]) / 2, s[2]);
    principal[0] = mean + radius;
    principal[1] = mean - radius;
    principal[2] = zz;
    sort3 (principal);
}

/* Mean m of a 3D stress s (Voigt), and of its deviator s' = s - m: p^2 = s':s' / 6, and the determinant. */
static void invariants (const double *s, double *mean, double *p2, double *det)
{
    *mean = (s[0] + s[1] + s[2]) / 3;
    double a = s[0] - *mean, b = s[1] - *mean, c = s[2] - *mean, xy = s[3], yz = s[4], zx = s[5];
    *p2 = (a * a + b * b + c * c + 2 * (xy * xy + yz * yz + zx * zx)) / 6;
    *det = a * (b * c - yz * yz) - xy * (xy * c - yz * zx) + zx * (xy * yz - b * zx);
}

/* Principal stresses in 3D: the roots of the characteristic polynomial by the cosine of a third of an angle
 * (Smith 1961); nearly equal roots by Jacobi rotations, which keep their digits. */
static void solid (const double *s, double *principal)
{
    double mean, p2, det;
    invariants (s, &mean, &p2, &det);
    double p = sqrt (p2);
    double r = p > 0 ? det / p / p / p / 2 : 1;
    if (fabs (r) < 0.9999) {                           /* mean + 2 p cos (phi + 2 pi k / 3), cos 3 phi = r */
        double phi = acos (r) / 3, third = 2.0943951023931954923;
        principal[0] = mean + 2 * p * cos (phi);
        principal[2] = mean + 2 * p * cos (phi + third);
        principal[1] = mean + 2 * p * cos (phi - third);
        return;
    }
    const double M[9] = { s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2] };
    pg_dense_eigen (3, M, principal, NULL);
}

void pg_principal (int dim, size_t n, const double *stress, const double *zz, double *principal)
{
    size_t nv = (size_t) pg_voigt_size (dim);
    for (size_t i = 0; i < n; i++) {
        const double *s = stress + i * nv;
        double *out = principal + 3 * i;
        if (dim == 3) solid (s, out);
        else if (dim == 2) plane (s, zz ? zz[i] : 0, out);
        else plane ((const double[]) { s[0], 0, 0 }, zz ? zz[i] : 0, out);
    }
}

/* An upper bound of cos (acos (r) / 3) for r in [-1, 1] by c = sqrt ((1 + r) / 2), of which it is a smooth
 * function, cos (2/3 acos (c)): the polynomial of fourth degree through its values at the five Chebyshev
 * points of [0, 1], which is nowhere more than 1.07e-5 away. */
static double above_third (double r)
{
    double c = sqrt (0.5 * fmax (0, 1 + r));
    return 0.50002160849
           + c * (0.57681247954 + c * (-0.10649398677 + c * (0.03835290845 - 0.00868835207 * c)));
}

/* Bounds of the principal stresses in 3D, without trigonometric functions; `hair` is a margin for rounding.
 * */
static void bound_solid (const double *s, double *most, double *least)
{
    const double hair = 1e-12;
    double mean, p2, det;
    invariants (s, &mean, &p2, &det);
    double p = sqrt (p2);
    double r = fmax (-1, fmin (1, det / (2 * p2 * p)));
    double size = hair * (fabs (mean) + 2 * p);
    if (!(p2 > 1e-280)) r = 0, p = sqrt (3) * (p + 1e-140);
    *most = mean + 2 * p * above_third (r) + size;
    *least = mean - 2 * p * above_third (-r) - size;
}

void pg_principal_bounds (int dim, size_t n, const double *stress, const double *zz, double *most,
                          double *least)
{
    for (size_t i = 0; i < n; i++) {
        double principal[3];
        if (dim == 3) {
            bound_solid (stress + 6 * i, most + i, least + i);
            continue;
        }
        pg_principal (dim, 1, stress + i * (size_t) pg_voigt_size (dim), zz ? zz + i : NULL, principal);
        most[i] = principal[0], least[i] = principal[2];
    }
}
