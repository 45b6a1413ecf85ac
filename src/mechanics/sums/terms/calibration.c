/* SPDX-License-Identifier: GPL-3.0-or-later
 * Calibration to a lattice (method.calibrate; theory A2): the sums over the bonds of an infinite lattice
 * compared with the integrals of theory. The hydrostatic energy gives the factor of the micromodulus, the
 * energy of a straight cut that of the fracture energy; the tangent shows how isotropic the lattice is. */
#include "sums_private.h"
#include <math.h>
#include <string.h>

double pg_sums_whole (const pg_sum_rule *rule, int dim)
{
    static const double pi = 3.14159265358979323846264338327950288;
    double sphere = dim == 1 ? 2 : dim == 2 ? 2 * pi : 4 * pi;
    return sphere * pow (rule->horizon, dim + 1) * pg_kernel_moment (rule->kernel, dim);
}

double pg_stencil_calibration (const pg_stencil *s, const pg_sum_rule *rule)
{
    double sum = 0;
    for (size_t b = 0; b < s->n; b++) sum += s->weight[b] * s->r[b];
    return pg_sums_whole (rule, s->dim) / (sum * s->cell);
}

/* Tangent D = 1/2 sum c k beta r (n n^T) V, Pa, with n such that n . (xx yy zz xy yz zx) is the strain along
 * a bond. */
void pg_stencil_tangent (const pg_stencil *s, double c, double thickness, double *D)
{
    static const int axis[3][6][2] = { { { 0, 0 } },
                                       { { 0, 0 }, { 1, 1 }, { 0, 1 } },
                                       { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 2, 0 } } };
    int dim = s->dim, nv = pg_voigt_size (dim);
    memset (D, 0, (size_t) (nv * nv) * sizeof *D);
    for (size_t b = 0; b < s->n; b++) {
        const double *xi = s->xi + b * (size_t) dim;
        double n[6], scale = 0.5 * c * s->weight[b] * s->r[b] * s->cell * thickness;
        for (int v = 0; v < nv; v++)
            n[v] = xi[axis[dim - 1][v][0]] * xi[axis[dim - 1][v][1]] / (s->r[b] * s->r[b]);
        for (int v = 0; v < nv; v++)
            for (int w = 0; w < nv; w++) D[v * nv + w] += scale * n[v] * n[w];
    }
}

/* A bond of the stencil towards +axis crosses a cut of one cell's width xi_axis / step times. */
double pg_stencil_fracture_energy (const pg_stencil *s, double c, double thickness, double s0, int axis)
{
    double sum = 0;
    for (size_t b = 0; b < s->n; b++)
        if (s->offset[3 * b + (size_t) axis] > 0)
            sum += s->weight[b] * s->r[b] * s->xi[b * (size_t) s->dim + (size_t) axis];
    return 0.5 * c * s0 * s0 * sum * s->cell * thickness;
}
