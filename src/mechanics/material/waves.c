/* SPDX-License-Identifier: GPL-3.0-or-later
 * Speeds of plane waves and of the surface wave (Rayleigh 1885). */
#include "perigal/material.h"
#include <math.h>

/* Rayleigh's equation in x = c / c_s, (2 - x^2)^2 = 4 sqrt ((1 - x^2) (1 - q x^2)) with q = (c_s / c_p)^2: a
 * wave that decays below a surface free of traction. x = 0 solves the equation without being a wave, so that
 * bisection begins just above it; left minus right side is negative below the root, positive above. */
double pg_rayleigh_speed (double pressure, double shear)
{
    double low = 1e-3, high = 1, q = shear * shear / (pressure * pressure);
    if (!(shear > 0 && pressure > shear)) return 0;
    for (int k = 0; k < 200; k++) {  /* x = c / c_s; `value` falls from 0 at x = 0, rises to 1 at x = 1 */
        double x = 0.5 * (low + high), x2 = x * x,
               value = (2 - x2) * (2 - x2) - 4 * sqrt ((1 - x2) * (1 - q * x2));
        if (x == low || x == high) break;
        *(value < 0 ? &low : &high) = x;
    }
    return 0.5 * (low + high) * shear;
}

/* ---- anisotropic: Christoffel's equation --------------------------------------------------------------- */
/* Widens the range [least, most], Pa, to the eigenvalues of Gamma_ik = C_ijkl n_j n_l along the unit vector
 * n: density times squared speed of the plane waves (Ting 1996, section 1.3). */
static void christoffel (const pg_material *m, const double *n, double *most, double *least)
{
    int dim = m->mode == PG_SOLID ? 3 : 2, nv = pg_voigt_size (dim);
    double G[9], value[3];
    for (int i = 0; i < dim; i++)
        for (int k = 0; k < dim; k++) {
            G[i * dim + k] = 0;
            for (int j = 0; j < dim; j++)
                for (int l = 0; l < dim; l++) {
                    int a = pg_voigt_at (dim, i, j), b = pg_voigt_at (dim, k, l);
                    G[i * dim + k] += m->D[a * nv + b] * n[j] * n[l];
                }
        }
    pg_dense_eigen (dim, G, value, NULL);
    *most = fmax (*most, value[0]), *least = fmin (*least, value[dim - 1]);
}

enum { DIRECTIONS = 2000 };                            /* speeds within about 0.1 % in three dimensions */

/* Speeds of the fastest and slowest plane wave over many directions: a spiral of equal areas over half the
 * sphere, or half the circle. Surface waves depend on the direction and are not computed. */
static pg_waves anisotropic_waves (const pg_material *m)
{
    /* pi, and the golden angle pi (3 - sqrt 5): successive points of the spiral, turned by it, spread
     * evenly. */
    static const double pi = 3.14159265358979323846, golden = 2.39996322972865332;
    double most = 0, least = INFINITY;
    for (int k = 0; k < DIRECTIONS; k++) {
        double angle = m->mode == PG_SOLID ? golden * k : pi * k / DIRECTIONS;
        double z = m->mode == PG_SOLID ? (k + 0.5) / DIRECTIONS : 0, across = sqrt (1 - z * z);
        christoffel (m, (const double[3]) { across * cos (angle), across * sin (angle), z }, &most, &least);
    }
    pg_waves w = { .lambda = NAN, .mu = NAN };
    if (m->density > 0) w.pressure = sqrt (most / m->density), w.shear = sqrt (fmax (0, least) / m->density);
    return w;
}

/* Speeds of waves. Isotropic: c_p = sqrt (D_11 / rho), in plane stress that of a plate, in 1D that of a bar;
 * c_s = sqrt (mu / rho). D is the stiffness in Voigt order: entry 21 = 6 * 3 + 3 in 3D and 8 = 3 * 2 + 2 in
 * 2D are the shear modulus, entry 1 is lambda (in plane stress that of the reduced stiffness). Without a
 * density speeds are 0. */
pg_waves pg_material_waves (const pg_material *m)
{
    pg_waves w = {0, 0, 0, 0, 0};
    if (m->type && !(m->type->can & PG_MATERIAL_ISOTROPIC)) return anisotropic_waves (m);
    if (m->mode != PG_LINE) w.lambda = m->D[1], w.mu = m->D[m->mode == PG_SOLID ? 21 : 8];
    if (m->density > 0) w.pressure = sqrt (m->D[0] / m->density), w.shear = sqrt (w.mu / m->density);
    w.rayleigh = pg_rayleigh_speed (w.pressure, w.shear);
    return w;
}
