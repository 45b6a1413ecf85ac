/* SPDX-License-Identifier: GPL-3.0-or-later
 * Critical stretch s0 and fracture energy G0 of bond-based theory: s0^2 = a G0 m_n / (E m_{n+1}) with the
 * kernel's moments m_n = int_0^horizon k(r) r^n dr (theory A1). n and a: bar 1, 2; plane stress 2, pi/3;
 * plane strain 2, 5 pi/16; solid 3, 2/3. */
#include "perigal/criterion.h"
#include "perigal/kernel.h"
#include <math.h>

/* ---- state-based --------------------------------------------------------------------------------------- */
enum { PANELS = 24 };
/* Gauss point k and its weight, of 3 on each of PANELS panels of [0, 1]. */
static double point_of (int k, double *weight)
{
    static const double place[3] = { -0.774596669241483377035853, 0, 0.774596669241483377035853 };
    *weight = (k % 3 == 1 ? 8.0 : 5.0) / 18 / PANELS;
    return (k / 3 + (1 + place[k % 3]) / 2) / PANELS;
}

/* Part of the weighted volume q that lies further than z along one axis (in horizons), over horizon^(d + 1);
 * the substitution r = z + (1 - z) t^2 makes the integrand smooth at r = z. */
static double beyond (const pg_kernel *kernel, pg_mode mode, double z)
{
    static const double pi = 3.14159265358979323846;
    double sum = 0;
    for (int k = 0; k < 3 * PANELS; k++) {
        double weight, t = point_of (k, &weight), r = z + (1 - z) * t * t, w;
        double part = mode == PG_SOLID ? 2 * pi * r * (r - z) : mode == PG_LINE ? 1 : 2 * r * acos (z / r);
        kernel->value (1, &r, &w, NULL);
        sum += w * r * part * 2 * (1 - z) * t * weight;
    }
    return sum;
}

/* Integrates over the distance z of a point from the cut by the Gauss points of point_of. */
double pg_state_cut_share (pg_mode mode, const char *name, double A, double B)
{
    const pg_kernel *kernel = pg_kernel_find (name);
    double sum = 0, d = mode == PG_SOLID ? 3 : mode == PG_LINE ? 1 : 2;
    if (!kernel) return 0;
    double whole = 2 * beyond (kernel, mode, 0);
    for (int k = 0; k < 3 * PANELS; k++) {
        double weight, z = point_of (k, &weight), share = beyond (kernel, mode, z) / whole;
        sum += (A * d * share * share + B * share) * weight;
    }
    return sum;
}

/* `toughness` corrects theory by the energy of a cut through the sums of a lattice. */
double pg_state_fracture_energy (const pg_criterion_setting *s, double s0)
{
    double A, B;
    pg_state_moduli (s->mode, s->modulus, s->poisson, &A, &B);
    return s->horizon * s0 * s0 * pg_state_cut_share (s->mode, s->kernel, A, B)
           * (s->toughness > 0 ? s->toughness : 1);
}

/* ---- bond-based ---------------------------------------------------------------------------------------- */
/* Returns s0^2 / G0, m^2/J. */
static double ratio (const pg_criterion_setting *s)
{
    static const double pi = 3.14159265358979323846;
    const double a[] = {
        [PG_LINE] = 2, [PG_PLANE_STRESS] = pi / 3, [PG_PLANE_STRAIN] = 5 * pi / 16, [PG_SOLID] = 2.0 / 3
    };
    static const int order[] = {
        [PG_LINE] = 1, [PG_PLANE_STRESS] = 2, [PG_PLANE_STRAIN] = 2, [PG_SOLID] = 3
    };
    const pg_kernel *kernel = pg_kernel_find (s->kernel);
    if (!kernel) return 0;
    if (s->state) return 1 / pg_state_fracture_energy (s, 1);
    int n = order[s->mode];
    double tough = s->toughness > 0 ? s->toughness : 1;  /* energy of a lattice over theory (theory A2) */
    return a[s->mode] * pg_kernel_moment (kernel, n)
           / (pg_kernel_moment (kernel, n + 1) * s->horizon * s->modulus * tough);
}

double pg_stretch_from_energy (const pg_criterion_setting *setting, double G0)
{
    return sqrt (ratio (setting) * G0);
}

double pg_energy_from_stretch (const pg_criterion_setting *setting, double s0)
{
    double r = ratio (setting);
    if (isnan (r)) return NAN;  /* no one Young's modulus: stiffness depends on the direction */
    return r > 0 ? s0 * s0 / r : 0;
}
