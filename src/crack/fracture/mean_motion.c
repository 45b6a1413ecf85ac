/* SPDX-License-Identifier: GPL-3.0-or-later
 * A displacement field without the mean rigid motion of the nodes around a tip or front. A rigid motion does
 * not change stress, J or K; but numerically its rotation is multiplied by equilibrium errors of the stress,
 * and shape functions that do not reproduce linear fields strain under it. Determined by least squares over
 * the nodes: linear in the field, and exact for rigid motions. */
#include "mean_motion.h"
#include "held_points.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

/* Rotation (rad) with the moment L of displacements of the nodes, spin = J^-1 L, J the inertia (3 x 3, unit
 * masses). In 2D only the third component. Nodes on a line: no rotation about it. */
static void spin_of (int dim, const double *J, const double *L, double *spin)
{
    double lambda[3], V[9];
    if (dim == 2) {
        spin[2] = J[8] > 0 ? L[2] / J[8] : 0;
        return;
    }
    pg_dense_eigen (3, J, lambda, V);
    for (int l = 0; l < 3 && lambda[l] > 1e-9 * lambda[0]; l++) {
        double along = 0;
        for (int k = 0; k < 3; k++) along += V[3*k + l] * L[k];
        for (int k = 0; k < 3; k++) spin[k] += V[3*k + l] * along / lambda[l];
    }
}

static int inside (const double *x, size_t dim, const double *low, const double *high)
{
    for (size_t k = 0; k < dim; k++) if (!(x[k] >= low[k] && x[k] <= high[k])) return 0;
    return 1;
}

/* Finds mean position and displacement of the nodes in the box, and their rotation; returns the number of
 * nodes. */
static size_t find (mean_motion *m, const pg_problem *p, const pg_state *state, const double *d,
                    const double *low, const double *high)
{
    const pg_cloud *c = &p->cloud;
    size_t dim = (size_t) c->dim, stride = state->ndof / c->n, count = 0;
    double J[9] = { 0 }, L[3] = { 0 };
    for (size_t i = 0; i < c->n; i++) {
        if (!inside (c->x + i * dim, dim, low, high) || !point_is_held (p, state, i)) continue;
        count++;
        for (size_t k = 0; k < dim; k++) m->at[k] += c->x[i * dim + k], m->shift[k] += d[i * stride + k];
    }
    for (size_t k = 0; k < dim && count; k++) m->at[k] /= (double) count, m->shift[k] /= (double) count;
    for (size_t i = 0; i < c->n; i++) {
        double x[3] = { 0 }, u[3] = { 0 }, l[3], square = 0;
        if (!inside (c->x + i * dim, dim, low, high) || !point_is_held (p, state, i)) continue;
        for (size_t k = 0; k < dim; k++)
            x[k] = c->x[i * dim + k] - m->at[k], u[k] = d[i * stride + k] - m->shift[k],
            square += x[k] * x[k];
        pg_cross3 (x, u, l);
        for (size_t k = 0; k < 3; k++) {
            L[k] += l[k], J[4*k] += square;
            for (size_t b = 0; b < 3; b++) J[3*k + b] -= x[k] * x[b];
        }
    }
    spin_of (c->dim, J, L, m->spin);
    return count;
}

void mean_motion_at (const mean_motion *m, const double *x, int dim, double *u)
{
    double away[3] = { 0 }, turned[3];
    for (int k = 0; k < dim; k++) away[k] = x[k] - m->at[k];
    pg_cross3 (m->spin, away, turned);
    for (int k = 0; k < dim; k++) u[k] = m->shift[k] + turned[k];
}

/* Subtracts the mean rigid motion from a field; rotational unknowns are rotations times the spacing. */
pg_status mean_motion_take (mean_motion *out, const pg_problem *p, const pg_state *state, const double *d,
                            size_t nplace, const double *place, double reach)
{
    pg_status status = PG_OK;
    size_t n = p->cloud.n, dim = (size_t) p->dim, stride = state->ndof / n;
    /* nodes on the border of the box, as for a ring that ends at the surface, are included */
    double low[3], high[3], same = pg_cloud_same (&p->cloud);
    memset (out, 0, sizeof *out);
    for (size_t k = 0; k < dim; k++) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < nplace; i++)
            low[k] = fmin (low[k], place[i * dim + k] - reach - same),
            high[k] = fmax (high[k], place[i * dim + k] + reach + same);
    }
    PG_ALLOC (out->d, state->ndof);
    memcpy (out->d, d, state->ndof * sizeof *d);
    if (!find (out, p, state, d, low, high)) goto done;
    for (size_t i = 0; i < n; i++) {
        double u[3];
        mean_motion_at (out, p->cloud.x + i * dim, p->dim, u);
        for (size_t k = 0; k < dim; k++) out->d[i * stride + k] -= u[k];
        for (size_t k = dim; k < stride; k++)
            out->d[i * stride + k] -= p->cloud.h * out->spin[dim == 2 ? 2 : k - dim];
    }
done:
    return status;
}

void mean_motion_clear (mean_motion *m)
{
    pg_free (m->d);
    memset (m, 0, sizeof *m);
}
