/* SPDX-License-Identifier: GPL-3.0-or-later
 * penny.h: the exact field of a penny-shaped crack in an infinite body, loaded on its faces, by harmonic
 * functions with a complex shift (derived here; K as Tada, Paris and Irwin have them).
 *
 * With z1 = z + i a, R1 = sqrt (r^2 + z1^2), L = ln (R1 + z1), F2 = z1 L - R1 and F3 = ((z1^2 - r^2 / 2) L -
 * 3/2 z1 R1) / 2, dF3/dz = F2, dF2/dz = L, the functions phi = Im F3 - a Re F2 and psi = dphi/dz = z Im L -
 * Im R1 are harmonic, and on z = 0 psi = - sqrt (a^2 - r^2) within the disc, 0 beyond it. Then
 *
 *   pressure p on the faces: 2 mu u = 2 p / pi [(1 - 2 nu) grad' phi - 2 (1 - nu) psi e_z + z grad psi]
 *   shear t on them along x: 2 mu u = 4 t / (pi (2 - nu)) [- 2 (1 - nu) psi e_x - (1 - 2 nu) phi,x e_z
 *                                     + z grad (phi,x)]
 *
 * are in equilibrium and have the tractions -p, -tau on z = 0 within the disc. K_I = 2 p sqrt (a / pi), K_II
 * = 4 tau cos (f) sqrt (a / pi) / (2 - nu), K_III = 4 (1 - nu) tau sin (f) sqrt (a / pi) / (2 - nu), f the
 * angle from x, for the tangent e x z. */
#ifndef PERIGAL_TEST_PENNY_H
#define PERIGAL_TEST_PENNY_H
#include <complex.h>
#include <math.h>
#include <string.h>

typedef struct { double a, mu, nu, p, tau; } penny;

/* phi,x, phi,y and psi at (x, y, z), z >= 0. */
static inline void penny_potentials (double a, const double *X, double *phi_x, double *phi_y, double *psi)
{
    double x = X[0], y = X[1], z = X[2];
    double complex z1 = z + I * a, R = csqrt (x * x + y * y + z1 * z1);
    if (cimag (R) < 0) R = -R;
    double complex L = clog (R + z1), sum = R + z1,
                   f = -L / 2 + (z1 * z1 - (x * x + y * y) / 2) / (2 * R * sum) - 0.75 * z1 / R;
    double g = cimag (f) + a * creal (1 / sum); /* f = F3,x / x, and F2,x = - x / (R1 + z1) */
    *phi_x = x * g, *phi_y = y * g, *psi = z * cimag (L) - cimag (R);
}

/* Displacement at X (from the centre, axis 3 along the normal); gradients of potentials by differences. */
static inline void penny_displacement (const penny *c, const double *X, double *u)
{
    const double pi = 3.14159265358979323846;
    double side = X[2] < 0 ? -1 : 1, x[3] = { X[0], X[1], fabs (X[2]) }, e = 1e-5 * c->a, z = x[2];
    double p = c->p / (pi * c->mu), t = 2 * c->tau / (pi * (2 - c->nu) * c->mu), f[3], d[3][3];
    penny_potentials (c->a, x, &f[0], &f[1], &f[2]);
    for (int k = 0; k < 3; k++) {
        double y[3] = { x[0], x[1], x[2] }, high[3], low[3];
        y[k] = x[k] + e, penny_potentials (c->a, y, &high[0], &high[1], &high[2]);
        y[k] = x[k] - e, penny_potentials (c->a, y, &low[0], &low[1], &low[2]);
        for (int i = 0; i < 3; i++) d[i][k] = (high[i] - low[i]) / (2 * e);
    }
    /* symmetric about the plane of the crack, then antisymmetric */
    u[0] = p * ((1 - 2 * c->nu) * f[0] + z * d[2][0]) + side * t * (-2 * (1 - c->nu) * f[2] + z * d[0][0]);
    u[1] = p * ((1 - 2 * c->nu) * f[1] + z * d[2][1]) + side * t * z * d[0][1];
    u[2] = side * p * (-2 * (1 - c->nu) * f[2] + z * d[2][2]) + t * (-(1 - 2 * c->nu) * f[0] + z * d[0][2]);
}

/* Its gradient G[3 i + k] = du_i/dx_k. */
static inline void penny_gradient (const penny *c, const double *X, double *G)
{
    double e = 2e-5 * c->a, high[3], low[3];
    for (int k = 0; k < 3; k++) {
        double y[3] = { X[0], X[1], X[2] };
        y[k] = X[k] + e, penny_displacement (c, y, high);
        y[k] = X[k] - e, penny_displacement (c, y, low);
        for (int i = 0; i < 3; i++) G[3*i + k] = (high[i] - low[i]) / (2 * e);
    }
}

/* The same of the crack with free faces under the stress p along its normal and tau far away. */
static inline void penny_free_gradient (const penny *c, const double *X, double *G)
{
    double strain = c->p / (2 * c->mu * (1 + c->nu));
    penny_gradient (c, X, G);
    G[0] -= c->nu * strain, G[4] -= c->nu * strain, G[8] += strain, G[2] += c->tau / c->mu;
}

/* K_I, K_II, K_III at the angle f from axis 1, Pa m^(1/2). */
static inline void penny_intensities (const penny *c, double f, double *K)
{
    double root = sqrt (c->a / 3.14159265358979323846), t = 4 * c->tau / (2 - c->nu) * root;
    K[0] = 2 * c->p * root, K[1] = t * cos (f), K[2] = (1 - c->nu) * t * sin (f);
}
#endif
