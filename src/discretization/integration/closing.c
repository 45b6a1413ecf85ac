/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surface quadrature that closes: it satisfies the divergence theorem for 1 and x. With the divergence
 * identity of a cell constants have no gradient and linear fields theirs only if its quadrature obeys
 *
 *     sum_e q (e) F_e = sum_g w_g grad q (g),   q = 1, x, y, z,   F_e: weight times outward normal.
 *
 * Straight cells do, to rounding. On pieces of a curved surface the quadrature misses it by the error of its
 * order, r_k. Per cell and component k the fluxes of its boundary facets are therefore changed as little as
 * possible,
 *
 *     minimise  sum_e |dF_e|^2 / (s_e |F_e|),   subject to  sum_e q (e) dF_e,k = - r_k (q),
 *     dF_e,k = s_e |F_e| q (e)' c_k,             (sum_e s_e |F_e| q q') c_k = - r_k,
 *
 * with s = 1 on curved facets and FLAT on flat ones. Faces between cells keep their fluxes. */
#include "consistent.h"
#include "perigal/vector.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* FLAT: s of flat facets. ROUNDING: residual that counts as rounding, over the area of the cell's border.
 * LEFT_OUT: eigenvalues left out, over the largest; RAISE: factor on it while a flux would change by more
 * than the share MOST. NOTHING: area of a facet whose flux may change freely, over that of the border. TIMES:
 * repetitions. */
static const double FLAT = 1e-6, ROUNDING = 2e-15, LEFT_OUT = 1e-13, RAISE = 100, MOST = 0.25, NOTHING = 1e-6;
enum { TIMES = 5, SIZE = 4 };

typedef struct {
    pg_consistency *c;
    const pg_rows *points;
    size_t cell, dim;
    double centre[3], size, border, volume;
    /* What counts as rounding, over the border: more where coordinates are far from the origin. */
    double rounding;
    /* Matrix of the facets, sum s |F| q q', and the residuals r of the theorem by component, over the
     * border. */
    double A[SIZE * SIZE], r[3][SIZE];
} closing;

/* q: 1 and the coordinates of x relative to the centre, over the size of the cell. */
static void basis (const closing *l, const double *x, double *q)
{
    q[0] = 1;
    for (size_t k = 0; k < l->dim; k++) q[1 + k] = (x[k] - l->centre[k]) / l->size;
}

/* Do the normals at the points of a face differ? */
static int is_curved (const pg_faces *f, size_t face)
{
    size_t dim = (size_t) f->dim, first = f->start[face];
    for (size_t q = first + 1; q < f->start[face + 1]; q++) {
        double a = pg_size (dim, f->flux + first * dim), b = pg_size (dim, f->flux + q * dim);
        for (size_t k = 0; k < dim; k++)
            if (fabs (f->flux[q * dim + k] / b - f->flux[first * dim + k] / a) > 1e-13) return 1;
    }
    return 0;
}

static double weight_of (const pg_faces *f, size_t face) { return is_curved (f, face) ? 1 : FLAT; }

/* Computes centre, size, border and volume of the cell. */
static void find_middle (closing *l)
{
    const pg_consistency *c = l->c;
    memset (l->centre, 0, sizeof l->centre);
    l->volume = 0;
    for (size_t q = c->first[l->cell]; q < c->first[l->cell + 1]; q++) l->volume += l->points->weight[q];
    for (size_t q = c->first[l->cell]; q < c->first[l->cell + 1]; q++)
        for (size_t k = 0; k < l->dim; k++)
            l->centre[k] += l->points->weight[q] / l->volume * l->points->x[q * l->dim + k];
    double far = 0;
    l->size = l->border = 0;
    for (size_t k = 0; k < l->dim; k++) far = fmax (far, fabs (l->centre[k]));
    for (size_t e = c->faces.of[l->cell]; e < c->faces.of[l->cell + 1]; e++) {
        size_t face = (size_t) c->faces.face[e];
        for (size_t q = c->faces.start[face]; q < c->faces.start[face + 1]; q++) {
            l->border += pg_size (l->dim, c->faces.flux + q * l->dim);
            for (size_t k = 0; k < l->dim; k++)
                l->size = fmax (l->size, fabs (c->faces.x[q * l->dim + k] - l->centre[k]));
        }
    }
    l->rounding = ROUNDING + DBL_EPSILON * far / l->size;
}

/* Computes the residuals of the divergence theorem, r, and the matrix A. Returns the largest residual. */
static double miss (closing *l)
{
    const pg_consistency *c = l->c;
    const pg_faces *f = &c->faces;
    double most = 0, q[SIZE];
    memset (l->A, 0, sizeof l->A), memset (l->r, 0, sizeof l->r);
    size_t m = l->dim + 1;
    for (size_t e = f->of[l->cell]; e < f->of[l->cell + 1]; e++) {
        size_t face = (size_t) f->face[e];
        double sign = f->cell[2 * face] == (int) l->cell ? 1 : -1,
               s = f->cell[2 * face + 1] < 0 ? weight_of (f, face) : 0;
        for (size_t p = f->start[face]; p < f->start[face + 1]; p++) {
            const double *F = f->flux + p * l->dim;
            double share = s * pg_size (l->dim, F) / l->border;
            basis (l, f->x + p * l->dim, q);
            for (size_t a = 0; a < m; a++) {
                for (size_t b = 0; b < m; b++) l->A[a * m + b] += share * q[a] * q[b];
                for (size_t k = 0; k < l->dim; k++) l->r[k][a] += sign * q[a] * F[k] / l->border;
            }
        }
    }
    for (size_t k = 0; k < l->dim; k++) {
        l->r[k][1 + k] -= l->volume / l->size / l->border;
        for (size_t a = 0; a < m; a++) most = fmax (most, fabs (l->r[k][a]));
    }
    return most;
}

/* Solves A c_k = - r_k by the eigenvectors whose eigenvalues exceed `cut` times the largest. */
static void solve (const closing *l, const double *lambda, const double *V, double cut, double c[3][SIZE])
{
    size_t m = l->dim + 1;
    memset (c, 0, 3 * sizeof *c);
    for (size_t v = 0; v < m && lambda[v] > cut * lambda[0]; v++)
        for (size_t k = 0; k < l->dim; k++) {
            double along = 0;
            for (size_t a = 0; a < m; a++) along += V[a * m + v] * l->r[k][a];
            for (size_t a = 0; a < m; a++) c[k][a] -= V[a * m + v] * along / lambda[v];
        }
}

/* apply 1: adds the changes to the fluxes at all points of boundary facets of the cell. apply 0: returns 1 if
 * one of them would change by more than is allowed. */
static int change (closing *l, double c[3][SIZE], int apply)
{
    pg_faces *f = &l->c->faces;
    double q[SIZE], d[3];
    for (size_t e = f->of[l->cell]; e < f->of[l->cell + 1]; e++) {
        size_t face = (size_t) f->face[e];
        if (f->cell[2 * face + 1] >= 0) continue;
        double s = weight_of (f, face), whole = 0;
        for (size_t p = f->start[face]; p < f->start[face + 1]; p++)
            whole += pg_size (l->dim, f->flux + p * l->dim);
        if (apply) l->c->amended[face] = 1;
        for (size_t p = f->start[face]; p < f->start[face + 1]; p++) {
            double *F = f->flux + p * l->dim, size = pg_size (l->dim, F);
            basis (l, f->x + p * l->dim, q);
            for (size_t k = 0; k < l->dim; k++) {
                d[k] = 0;
                for (size_t a = 0; a <= l->dim; a++) d[k] += s * size * q[a] * c[k][a];
            }
            if (!apply && pg_size (l->dim, d) > MOST * size && whole > NOTHING * l->border) return 1;
            for (size_t k = 0; k < l->dim && apply; k++) F[k] += d[k];
        }
    }
    return 0;
}

/* Is the cell a box, or a simplex with straight edges? Their rules obey the theorem for products as well. */
static int is_even (const pg_cells *c, size_t cell)
{
    size_t dim = (size_t) c->dim;
    if (c->kind[cell] == PG_TRI3 || c->kind[cell] == PG_TET4) return 1;
    if (c->kind[cell] != PG_QUAD4 && c->kind[cell] != PG_HEX8) return 0;
    for (size_t k = 0; k < dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = c->start[cell]; i < c->start[cell + 1]; i++)
            low = fmin (low, c->x[i * dim + k]), high = fmax (high, c->x[i * dim + k]);
        for (size_t i = c->start[cell]; i < c->start[cell + 1]; i++) {
            double x = c->x[i * dim + k];
            if (fmin (x - low, high - x) > 1e-9 * (high - low)) return 0;
        }
    }
    return 1;
}

static void close_cell (closing *l)
{
    double lambda[SIZE], V[SIZE * SIZE], c[3][SIZE];
    find_middle (l);
    if (!(l->volume > 0) || !(l->border > 0) || !(l->size > 0)) return;
    for (int time = 0; time < TIMES; time++) {
        double by = miss (l), cut = LEFT_OUT;
        if (time == 0) l->c->uneven[l->cell] = by > l->rounding * 50 || !is_even (l->c->cells, l->cell);
        if (!(by > l->rounding * (time ? 1 : 50))) return;
        pg_dense_eigen ((int) l->dim + 1, l->A, lambda, V);
        if (!(lambda[0] > 0)) return;
        for (int k = 0; k < 6; k++, cut *= RAISE) {
            solve (l, lambda, V, cut, c);
            if (!change (l, c, 0)) break;
        }
        change (l, c, 1);
    }
}

pg_status consistent_close (pg_consistency *c, const pg_rows *points)
{
    pg_status status = PG_OK;
    PG_ALLOC (c->amended, c->faces.n);
    PG_ALLOC (c->uneven, c->cells->n);
    closing l = { .c = c, .points = points, .dim = (size_t) points->dim };
    for (l.cell = 0; l.cell < c->cells->n && l.dim > 1; l.cell++) close_cell (&l);
done:
    return status;
}

void pg_consistency_normals (const pg_consistency *c, const pg_rows *facets, double *normal)
{
    size_t dim = (size_t) facets->dim, last = SIZE_MAX, place = 0;
    for (size_t q = 0; c && q < facets->n; q++, place++) {
        size_t face = c->faces.n - c->cells->nfacet + (size_t) facets->cell[q];
        if (face != last) last = face, place = 0;
        if (!c->amended[face]) continue;
        const double *F = c->faces.flux + (c->faces.start[face] + place) * dim;
        for (size_t k = 0; k < dim; k++) normal[q * dim + k] = F[k] / facets->weight[q];
    }
}
