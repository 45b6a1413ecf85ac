/* SPDX-License-Identifier: GPL-3.0-or-later
 * The isoparametric map x (xi) = sum N_i (xi) x_i: its size factor and normal, and its inverse by Newton's
 * method. */
#include "element.h"
#include <math.h>

/* Position and J[axis][reference axis] = dx / dxi from the values N of the shape functions and their
 * derivatives dN. */
static inline __attribute__ ((always_inline)) void combine_those (int nodes, int dim, int d, const double *x,
                                                                  const double *N, const double *dN,
                                                                  double place[3], double J[3][3])
{
    for (int a = 0; a < dim; a++) {
        place[a] = 0;
        for (int r = 0; r < 3; r++) J[a][r] = 0;
    }
    for (int i = 0; i < nodes; i++)
        for (int a = 0; a < dim; a++) {
            place[a] += N[i] * x[i * dim + a];
            for (int r = 0; r < d; r++) J[a][r] += dN[i * d + r] * x[i * dim + a];
        }
}

/* Calls combine_those with constant loop bounds for the usual dimensions. */
static void combine (pg_element kind, int dim, const double *x, const double *N, const double *dN,
                     double place[3], double J[3][3])
{
    int d = pg_element_types[kind].dim, nodes = pg_element_types[kind].nodes;
    if (dim == 2 && d == 2) combine_those (nodes, 2, 2, x, N, dN, place, J);
    else if (dim == 3 && d == 3) combine_those (nodes, 3, 3, x, N, dN, place, J);
    else if (dim == 3 && d == 2) combine_those (nodes, 3, 2, x, N, dN, place, J);
    else combine_those (nodes, dim, d, x, N, dN, place, J);
}

/* Position and J = dx / dxi of an element at the reference coordinates xi. */
static void place_and_slope (pg_element kind, int dim, const double *x, const double *xi, double place[3],
                             double J[3][3])
{
    double N[PG_ELEMENT_NODES], dN[3 * PG_ELEMENT_NODES];
    pg_element_shape (kind, xi, N, dN);
    combine (kind, dim, x, N, dN, place, J);
}

/* Size factor of the map: length, area or volume of the image of the unit cube of dimension d; n: normal, not
 * of unit length. */
static double size_of (int d, int dim, double J[3][3], double n[3])
{
    n[0] = 1, n[1] = n[2] = 0;
    if (d == 0) return 1;
    if (d == 1) {
        double square = 0;
        for (int a = 0; a < dim; a++) square += J[a][0] * J[a][0];
        if (dim == 2) n[0] = J[1][0], n[1] = -J[0][0];
        return dim == 1 ? J[0][0] : sqrt (square);
    }
    if (d == 2 && dim == 2) return J[0][0] * J[1][1] - J[0][1] * J[1][0];
    n[0] = J[1][0] * J[2][1] - J[2][0] * J[1][1];
    n[1] = J[2][0] * J[0][1] - J[0][0] * J[2][1];
    n[2] = J[0][0] * J[1][1] - J[1][0] * J[0][1];
    if (d == 2) return sqrt (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    return n[0] * J[0][2] + n[1] * J[1][2] + n[2] * J[2][2];
}

/* Derivatives of the map are the columns of J; the normal is their cross product (3D), or the tangent
 * turned by a right angle (2D). */
double pg_element_map (pg_element kind, int dim, const double *x, const double *xi, double *place,
                       double *normal)
{
    double N[PG_ELEMENT_NODES], dN[3 * PG_ELEMENT_NODES];
    pg_element_shape (kind, xi, N, dN);
    return pg_element_map_by (kind, dim, x, N, dN, place, normal);
}

double pg_element_map_by (pg_element kind, int dim, const double *x, const double *N, const double *dN,
                          double *place, double *normal)
{
    int d = pg_element_types[kind].dim;
    double J[3][3], at[3] = { 0 }, n[3];
    combine (kind, dim, x, N, dN, at, J);
    double size = size_of (d, dim, J, n);
    for (int a = 0; place && a < dim; a++) place[a] = at[a];
    for (int a = 0; normal && a < dim; a++) normal[a] = d == dim - 1 && size > 0 ? n[a] / size : 0;
    return size;
}

/* ---- inverse of the map -------------------------------------------------------------------------------- */
/* step = J^-1 r (d x d) by Cramer's rule; 0 where J is singular. */
static int solve (int d, double J[3][3], const double r[3], double step[3])
{
    double n[3], det = size_of (d, d, J, n);
    if (d == 1 || !(fabs (det) > 0)) {
        step[0] = r[0] / det;
        return fabs (det) > 0;
    }
    if (d == 2) {
        step[0] = (r[0] * J[1][1] - r[1] * J[0][1]) / det;
        step[1] = (r[1] * J[0][0] - r[0] * J[1][0]) / det;
        return 1;
    }
    for (int k = 0; k < 3; k++) {                          /* Cramer */
        double C[3][3], unused[3];
        for (int a = 0; a < 3; a++) for (int b = 0; b < 3; b++) C[a][b] = b == k ? r[a] : J[a][b];
        step[k] = size_of (3, 3, C, unused) / det;
    }
    return 1;
}

/* The centroid for simplices, the origin for bars, quadrilaterals and hexahedra. */
void element_centre (pg_element kind, double *xi)
{
    int d = pg_element_types[kind].dim, corners = pg_element_types[kind].corners;
    double node[3];
    for (int a = 0; a < d; a++) xi[a] = 0;
    for (int i = 0; i < corners; i++) {
        pg_element_node (kind, i, node);
        for (int a = 0; a < d; a++) xi[a] += node[a] / corners;
    }
}

/* Linear simplices converge in one step. Steps of curved elements are limited to 2, so that the iteration
 * does not leave the region where the map is invertible. */
int pg_element_invert (pg_element kind, const double *x, const double *place, double *xi)
{
    enum { STEPS = 40 };
    int d = pg_element_types[kind].dim, linear = kind == PG_TRI3 || kind == PG_TET4 || kind == PG_BAR2;
    if (d == 0) return 1;
    element_centre (kind, xi);
    for (int k = 0; k < STEPS; k++) {
        double at[3], J[3][3], r[3], step[3], longest = 0, size = 1, all = 0;
        place_and_slope (kind, d, x, xi, at, J);
        for (int a = 0; a < d; a++) r[a] = place[a] - at[a];
        if (!solve (d, J, r, step)) return 0;
        for (int a = 0; a < d; a++)
            longest = fmax (longest, fabs (step[a])), size = fmax (size, fabs (xi[a])), all += fabs (step[a]);
        /* The sum is NaN if any step is; fmax would hide it. */
        if (!isfinite (all)) return 0;
        /* Long steps in curved elements are shortened to 2. */
        double short_of = linear || longest <= 2 ? 1 : 2 / longest;
        for (int a = 0; a < d; a++) xi[a] += short_of * step[a];
        /* A linear map is solved by the first step; the second one only confirms it. */
        if (longest <= 1e-12 * size || (linear && k > 0)) return 1;
    }
    return 0;
}

/* The largest violation of a bound of the reference element. */
double pg_element_outside (pg_element kind, const double *xi)
{
    if (kind == PG_PYRAMID5) return fmax (fmax (fabs (xi[0]), fabs (xi[1])) - (1 - xi[2]), -xi[2]);
    int d = pg_element_types[kind].dim, corners = pg_element_types[kind].corners,
        simplex = d > 1 && (corners == d + 1), wedge = corners == 6;
    /* The first axes belong to a simplex (xi >= 0, sum <= 1), the others run over [-1, 1]. */
    int triangle = simplex ? d : wedge ? 2 : 0;
    double out = d == 0 ? 0 : -1, sum = 0;
    for (int a = 0; a < triangle; a++) out = fmax (out, -xi[a]), sum += xi[a];
    if (triangle) out = fmax (out, sum - 1);
    for (int a = triangle; a < d; a++) out = fmax (out, fabs (xi[a]) - 1);
    return out;
}
