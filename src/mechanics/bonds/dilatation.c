/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces by the dilatations of points: weighted volumes, diagonal of K, bound of frequencies, stress (Silling
 * et al. 2007; theory B6). In 2D and 3D. */
#include "dilatation.h"
#include <math.h>
#include <string.h>

/* ---- constants ----------------------------------------------------------------------------------------- */
/* Sets `counted`: the bonds that no pre-crack cuts, as weighted volumes are those of the body at the start.
 * It stays NULL without pre-cracks: all bonds count then. */
static pg_status count_bonds (bond_force *b)
{
    pg_status status = PG_OK;
    pg_state *fresh = NULL;
    size_t all = b->family->start[b->n];
    if (b->problem->crack.given.n == 0) return PG_OK;
    PG_TRY (pg_state_create (&fresh, b->problem, b->dim));
    PG_ALLOC (b->dilatation->counted, all);
    memcpy (b->dilatation->counted, fresh->alive + b->problem->bonds.first[PG_NODES], all);
done:
    pg_state_free (&fresh);
    return status;
}

/* Makes b->dilatation: A and B of every point (Pa), which the theory fills in later, q and stiff. */
pg_status dilatation_create (bond_force *b)
{
    pg_status status = PG_OK;
    dilatation *w = NULL;
    PG_ALLOC (w, 1);
    b->dilatation = w;
    PG_ALLOC (w->A, b->n);
    PG_ALLOC (w->B, b->n);
    PG_ALLOC (w->q, b->n);
    PG_ALLOC (w->stiff, b->n);
    PG_TRY (count_bonds (b));
    b->setting.dilation = w->A, b->setting.deviation = w->B, b->setting.counted = w->counted;
done:
    return status;
}

/* Frees b->dilatation; NULL: nothing to do. */
void dilatation_free (bond_force *b)
{
    dilatation *w = b->dilatation;
    if (!w) return;
    dilatation_rows_free (b);
    pg_free (w->A), pg_free (w->B), pg_free (w->q), pg_free (w->stiff), pg_free (w->counted);
    pg_free (w);
    b->dilatation = NULL;
}

/* Computes the weighted volumes q of all points, and stiff = (B + d max (A, 0)) / q, with which a pair force
 * is at least as stiff as the dilatations: once for all, or after every break if weighted volumes follow the
 * intact bonds. */
pg_status dilatation_weigh (bond_force *b)
{
    pg_status status = PG_OK;
    dilatation *w = b->dilatation;
    if (!w || (w->weighed && (w->weighed == b->revision || !b->problem->sums->rule.follow))) return PG_OK;
    PG_TRY (pg_bond_loop_dilatation (b->loop, NULL, NULL, w->q));
    for (size_t i = 0; i < b->n; i++)
        w->stiff[i] = w->q[i] > 0 ? (w->B[i] + b->dim * fmax (w->A[i], 0)) / w->q[i] : 0;
    w->weighed = b->revision;
done:
    return status;
}

/* Marks the points whose energy density has reached its limit, by the loop over all bonds: dilatations
 * make every energy depend on neighbours, and there is no cheaper bound for them. */
pg_status dilatation_dying (bond_force *b, const double *d, size_t *dying)
{
    pg_status status = PG_OK;
    PG_TRY (pg_bond_loop_energies (b->loop, d, b->node.density));
    *dying = 0;
    for (size_t i = 0; i < b->n; i++) *dying += b->node.dying[i] = b->node.density[i] >= b->node.critical[i];
done:
    return status;
}

/* ---- one point ----------------------------------------------------------------------------------------- */
/* Weight k beta of a bond without the surface correction, which is for pair forces: weighted volumes allow
 * for incomplete families by themselves. */
double dilatation_weight (const bond_force *b, size_t i, const point_bonds *s, size_t e)
{
    const pg_sums *sums = b->problem->sums;
    const double *v = sums->family_volume;
    size_t j = (size_t) s->node[e];
    if (!v) return s->weight[e];
    return s->weight[e]
           * (sums->rule.surface == PG_SURFACE_VOLUME ? 0.5 * (v[i] + v[j]) : sqrt (v[i] * v[j]));
}

/* Adds kappa xi x xi to own and subtracts it from other, kappa = both k beta V V / r^3, N/m^3: a pair force
 * along the bond that replaces the dilatations, for preconditioners and bounds. both: sum of `stiff` of its
 * ends. */
void dilatation_pull (const bond_force *b, size_t i, const point_bonds *s, size_t e, double both, double *own,
                      double *other)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    const double *V = b->problem->cloud.volume, *xi = s->xi + e * dim;
    double rr = 0;
    for (size_t k = 0; k < dim; k++) rr += xi[k] * xi[k];
    double kappa = both * dilatation_weight (b, i, s, e) * (V[i] * V[s->node[e]]) / (rr * sqrt (rr));
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++)
            own[a * m + c] += kappa * xi[a] * xi[c], other[a * m + c] -= kappa * xi[a] * xi[c];
}

/* Returns w = k beta / r of bond e, 1/m; rr: its squared length, m^2. */
static double weight_of (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *rr)
{
    size_t dim = (size_t) b->dim;
    *rr = 0;
    for (size_t k = 0; k < dim; k++) *rr += s->xi[e * dim + k] * s->xi[e * dim + k];
    return dilatation_weight (b, i, s, e) / sqrt (*rr);
}

/* Returns a / q; 0 if q is 0, as the point has no bond left. */
static double over (double a, double q) { return q > 0 ? a / q : 0; }

/* Second derivatives D of the energy by u_i (dim x dim, N/m): from the point's own dilatation A d / q^2 V g g
 * with g = sum w V xi, from the dilatations of its neighbours, and from the stretches, B / q at both ends. */
void dilatation_own (const bond_force *b, size_t i, const point_bonds *s, double *D)
{
    size_t dim = (size_t) b->dim;
    const double *V = b->problem->cloud.volume, *q = b->dilatation->q;
    double g[3] = { 0 }, rr;
    memset (D, 0, dim * dim * sizeof *D);
    for (size_t e = 0; e < s->m; e++) {
        if (!bond_force_lives (b, s->first + e)) continue;
        size_t j = (size_t) s->node[e];
        const double *xi = s->xi + e * dim;
        double w = weight_of (b, i, s, e, &rr),
               other = over (b->dilatation->A[j] * b->dim, q[j] * q[j]) * V[j] * (w * V[i]) * (w * V[i]);
        double both = V[i] * V[j] * w * (over (b->dilatation->B[i], q[i]) + over (b->dilatation->B[j],
                q[j])) / rr
                      + other;
        for (size_t a = 0; a < dim; a++) {
            g[a] += w * V[j] * xi[a];
            for (size_t c = 0; c < dim; c++) D[a * dim + c] += both * xi[a] * xi[c];
        }
    }
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++)
            D[a * dim + c] += V[i] * over (b->dilatation->A[i] * b->dim, q[i] * q[i]) * g[a] * g[c];
}

/* Upper bound of omega^2 rho at a point, for the stable time step. A q that follows the intact bonds shrinks
 * as bonds break, but is at least w r^2 V of the last intact one: the bound assumes that this is the nearest
 * neighbour. */
double dilatation_bound (const bond_force *b, size_t i, const point_bonds *s)
{
    const double *V = b->problem->cloud.volume;
    double nearest = INFINITY, sum = 0, rr, far = b->dim;
    for (size_t e = 0; e < s->m; e++) {
        size_t j = (size_t) s->node[e];
        weight_of (b, i, s, e, &rr);
        nearest = fmin (nearest, rr);
        sum += (b->dilatation->B[j] + far * fmax (b->dilatation->A[j], 0)) * V[j] / (V[i] * rr);
    }
    return 2 * (sum + (b->dilatation->B[i] + far * fmax (b->dilatation->A[i], 0)) / nearest);
}

/* Adds the stress of Silling and Lehoucq (2008) to T, Pa (dim x dim): for uniform strain its trace is d kappa
 * theta, whatever the family. */
void dilatation_virial (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                        const double *d,
                 double *T)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    const double *V = b->problem->cloud.volume;
    double sum = 0, rr, beta = over (b->dilatation->B[i], b->dilatation->q[i]), spread[9] = { 0 };
    for (size_t e = 0; e < s->m; e++) {
        if (alive && !alive[s->first + e]) continue;
        size_t j = (size_t) s->node[e];
        const double *xi = s->xi + e * dim;
        double w = weight_of (b, i, s, e, &rr) * V[j], along = 0;
        for (size_t a = 0; a < dim; a++) along += xi[a] * (d[j * m + a] - d[i * m + a]);
        sum += w * along;
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++)
                spread[a * dim + c] += w * xi[a] * xi[c],
                    T[a * dim + c] += beta * w * along / rr * xi[a] * xi[c];
    }
    double alpha = over (b->dilatation->A[i] * b->dim, b->dilatation->q[i] * b->dilatation->q[i]) * sum;
    for (size_t k = 0; k < dim * dim; k++) T[k] += alpha * spread[k];
}
