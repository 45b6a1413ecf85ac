/* SPDX-License-Identifier: GPL-3.0-or-later
 * Neighbours of every point: on a lattice by the stencil, else by a search that is made symmetric; vectors,
 * weights and partial volumes of the bonds of a point. */
#include "sums_private.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Returns the index of an item in an ascending list, by bisection; n: it is not there. */
static size_t find (const int *list, size_t n, int item)
{
    size_t a = 0, b = n;
    while (a < b) {
        size_t m = (a + b) / 2;
        if (list[m] < item) a = m + 1;
        else b = m;
    }
    return a < n && list[a] == item ? a : n;
}

/* ---- on a lattice -------------------------------------------------------------------------------------- */
/* Returns the point at a site plus an offset (3 numbers of steps); -1: beyond the box of sites, or no point
 * there. */
int pg_sums_neighbour (const pg_sites *s, int site, const int *offset)
{
    int x = site % s->count[0] + offset[0], rest = site / s->count[0], y = rest % s->count[1] + offset[1],
        z = rest / s->count[1] + offset[2];
    if (x < 0 || x >= s->count[0] || y < 0 || y >= s->count[1] || z < 0 || z >= s->count[2]) return -1;
    return s->point[((size_t) z * (size_t) s->count[1] + (size_t) y) * (size_t) s->count[0] + (size_t) x];
}

typedef struct {
    const pg_sums *sums;
    int   packed;                                      /* 1: every site has a point */
    int   reach[3];                                    /* largest offsets of bonds, in steps */
    long *jump;                                        /* difference of site numbers of each bond */
    pg_family *out;
} walk;

/* Is every offset of the stencil from this site inside the box of sites? */
static int inside (const walk *w, int site)
{
    const pg_sites *s = &w->sums->sites;
    int at[3] = { site % s->count[0], site / s->count[0] % s->count[1], site / s->count[0] / s->count[1] },
        all = 1;
    for (int k = 0; k < 3; k++) all &= at[k] >= w->reach[k] && at[k] + w->reach[k] < s->count[k];
    return all;
}

/* Writes the neighbours of point i to node unless that is NULL; returns how many. Inside the box of sites a
 * neighbour is `jump` sites away; near its faces each offset is checked. If points are numbered as sites are,
 * the list ascends by itself. */
static size_t visit (const walk *w, size_t i, int *node)
{
    const pg_sites *s = &w->sums->sites;
    const pg_stencil *t = &w->sums->stencil;
    const int *from = s->point + s->site[i];
    size_t n = 0;
    int in = inside (w, s->site[i]);
    if (in && w->packed && !node) return t->n;
    for (size_t b = 0; b < t->n; b++) {
        int j = in ? from[w->jump[b]] : pg_sums_neighbour (s, s->site[i], t->offset + 3*b);
        if (j < 0) continue;
        if (node) node[n] = j;
        n++;
    }
    if (node && !w->sums->ordered) pg_sort (node, n, sizeof *node, pg_ascending_ints);
    return n;
}

/* Counts the neighbours of points first .. last - 1 into start[i + 1], from which the starts of lists
 * follow. */
static void count_points (void *context, size_t first, size_t last, int thread)
{
    const walk *w = context;
    (void) thread;
    for (size_t i = first; i < last; i++) w->out->start[i + 1] = visit (w, i, NULL);
}

/* Writes the lists of points first .. last - 1. Threads write to parts of node that do not overlap, so that
 * the result does not depend on their number. */
static void fill_points (void *context, size_t first, size_t last, int thread)
{
    const walk *w = context;
    (void) thread;
    for (size_t i = first; i < last; i++) visit (w, i, w->out->node + w->out->start[i]);
}

/* Finds the families on a lattice: counts first, then fills, both by threads. */
static pg_status by_stencil (pg_family *out, const pg_sums *sums)
{
    pg_status status = PG_OK;
    const pg_stencil *t = &sums->stencil;
    const int *count = sums->sites.count;
    size_t n = sums->cloud->n;
    walk w = { .sums = sums,
               .out = out,
               .packed = n == (size_t) count[0] * (size_t) count[1] * (size_t) count[2] };
    PG_ALLOC (w.jump, t->n);
    for (size_t b = 0; b < t->n; b++) {
        const int *o = t->offset + 3*b;
        w.jump[b] = o[0] + count[0] * ((long) o[1] + count[1] * (long) o[2]);
        for (int k = 0; k < 3; k++) if (o[k] > w.reach[k]) w.reach[k] = o[k];
    }
    PG_ALLOC (out->start, n + 1);
    out->n = n;
    pg_parallel (sums->rule.threads, n, count_points, &w);
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i];
    PG_ALLOC (out->node, out->start[n]);
    pg_parallel (sums->rule.threads, n, fill_points, &w);
done:
    pg_free (w.jump);
    return status;
}

/* ---- without a lattice --------------------------------------------------------------------------------- */
/* Returns the distance of two points, m. */
static double distance (const pg_cloud *cloud, size_t i, size_t j)
{
    double r2 = 0;
    for (size_t k = 0, dim = (size_t) cloud->dim; k < dim; k++) {
        double x = cloud->x[j*dim + k] - cloud->x[i*dim + k];
        r2 += x * x;
    }
    return sqrt (r2);
}

/* Length r (m), partial volume beta and weight k beta of the bond between two points; beta 0: there is no
 * bond. In a graded cloud the horizon is that of the mean of both local spacings (ratio: local spacing over
 * h), and the weight falls with ratio^(dim + 1), so that the sum over a whole family is always the same. */
sums_bond pg_sums_bond_between (const pg_sum_rule *rule, const pg_cloud *cloud, size_t i, size_t j)
{
    sums_bond b = {.r = distance (cloud, i, j)};
    double ratio = 0.5 * (pg_cloud_ratio (cloud, i) + pg_cloud_ratio (cloud, j)),
           horizon = rule->horizon * ratio;
    b.beta = pg_sums_partial (rule->partial, b.r, horizon, cloud->h * ratio);
    if (b.beta <= 0) return b;
    b.weight = b.beta * pg_sums_kernel (rule, b.r, horizon);
    if (ratio != 1) b.weight /= pow (ratio, cloud->dim + 1);
    if (b.weight <= 0) b.beta = 0;
    return b;
}

/* Adds all bonds (i, j) of `near` in both directions: in a graded cloud j may be in the list of i and i not
 * in that of j. node NULL: counts into next[i + 1]; else writes at next[i]. Points that coincide are an
 * error, as their bond has no direction. */
static pg_status spread (const pg_sums *sums, const pg_family *near, size_t *next, int *node)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < near->n; i++)
        for (size_t e = near->start[i]; e < near->start[i + 1]; e++) {
            size_t j = (size_t) near->node[e], first = near->start[j], m = near->start[j + 1] - first;
            if (i == j) continue;
            sums_bond b = pg_sums_bond_between (&sums->rule, sums->cloud, i, j);
            if (!(b.r > PG_NO_LENGTH * sums->cloud->h * pg_cloud_ratio (sums->cloud, i))) {
                double x[3] = { 0 };
                memcpy (x, sums->cloud->x + i * (size_t) sums->cloud->dim,
                        (size_t) sums->cloud->dim * sizeof *x);
                PG_FAIL (PG_E_USAGE,
                         "points %zu and %zu coincide, at (%.6g, %.6g, %.6g) m: a bond needs a length, so "
                         "remove one of them",
                         i < j ? i : j, i < j ? j : i, x[0], x[1], x[2]);
            }
            if (!isfinite (b.beta) || !isfinite (b.weight))
                PG_FAIL (PG_E_USAGE,
                         "the bond of points %zu and %zu, %.17g m long, has partial volume %g and weight %g "
                         "by kernel %s: choose another method.kernel or method.partial_volume",
                         i + 1, j + 1, b.r, b.beta, b.weight, sums->rule.kernel->name);
            if (b.beta <= 0) continue;
            int alone = sums->cloud->size && find (near->node + first, m, (int) i) == m;
            if (node) node[next[i]] = (int) j;
            next[i + (node ? 0 : 1)]++;
            if (!alone) continue;
            if (node) node[next[j]] = (int) i;
            next[j + (node ? 0 : 1)]++;
        }
done:
    return status;
}

/* Drops neighbours from which a slot, gap or corner separates a point, and counts them. */
static pg_status sift (pg_family *f, const pg_sums *sums, size_t *dropped)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = sums->cloud;
    int *own = NULL;
    if (!cloud->between) return PG_OK;
    PG_ALLOC (own, cloud->n);
    for (size_t i = 0; i < cloud->n; i++) own[i] = (int) i;
    PG_TRY (pg_between_sift (cloud->between, f, cloud->x, NULL, own, sums->rule.threads, dropped));
done:
    pg_free (own);
    return status;
}

/* Finds the families without a lattice: pairs of points in both directions. Partial volumes include cells
 * that the horizon only cuts, so that the search then goes half a spacing farther. */
static pg_status by_search (pg_family *out, const pg_sums *sums, size_t *dropped)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = sums->cloud;
    pg_family near = {0};
    size_t *next = NULL, n = cloud->n;
    /* The reach at spacing h; pg_family_build scales it with the local spacing of a graded cloud. */
    double reach = sums->rule.horizon + (sums->rule.partial == PG_PARTIAL_NONE ? 0 : 0.5 * cloud->h);
    PG_TRY (pg_family_build (&near, cloud, n, cloud->x, reach, PG_RADIAL, 1));
    PG_TRY (sift (&near, sums, dropped));
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (next, n);
    out->n = n;
    PG_TRY (spread (sums, &near, out->start, NULL));
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i], next[i] = out->start[i];
    PG_ALLOC (out->node, out->start[n]);
    PG_TRY (spread (sums, &near, next, out->node));
    for (size_t i = 0; cloud->size && i < n; i++)
        pg_sort (out->node + out->start[i], out->start[i + 1] - out->start[i], sizeof *out->node,
                 pg_ascending_ints);
done:
    pg_free (next);
    pg_family_clear (&near);
    return status;
}

/* Finds the bonds of all points, the neighbours of each ascending; those across slots or gaps are dropped. */
pg_status pg_sums_family (pg_family *out, const pg_sums *sums, size_t *parted)
{
    pg_status status = PG_OK;
    size_t dropped = 0;
    memset (out, 0, sizeof *out);
    PG_TRY (sums->stencil.n ? by_stencil (out, sums) : by_search (out, sums, &dropped));
    if (sums->stencil.n) PG_TRY (sift (out, sums, &dropped));
    if (parted) *parted = dropped;
done:
    if (status != PG_OK) pg_family_clear (out);
    return status;
}

/* ---- the bonds of a point ------------------------------------------------------------------------------ */
/* Copies bond b of the stencil to entry e of the bonds of point i; j: its other end. */
static void take (const pg_sums *sums, size_t i, size_t j, size_t b, size_t e, double *xi, double *weight,
                  double *beta)
{
    const pg_stencil *t = &sums->stencil;
    size_t dim = (size_t) t->dim;
    for (size_t k = 0; xi && k < dim; k++) xi[e*dim + k] = t->xi[b*dim + k];
    if (weight) weight[e] = sums->family_volume ? t->weight[b] * pg_sums_surface (sums, i, j) : t->weight[b];
    if (beta) beta[e] = t->beta[b];
}

/* Copies the bonds of point i from the stencil. node: its n neighbours in the order of the family, which may
 * be fewer than those of the stencil: entries are searched by the number of the neighbour. If the family is
 * the whole stencil and there is no surface correction, whole arrays are copied. */
static void lattice_bonds (const pg_sums *sums, const int *node, size_t n, size_t i, double *xi,
                           double *weight, double *beta)
{
    const pg_stencil *t = &sums->stencil;
    size_t next = 0;
    int whole = sums->ordered && n == t->n;
    if (whole && !sums->family_volume) {
        if (xi) memcpy (xi, t->xi, n * (size_t) t->dim * sizeof *xi);
        if (weight) memcpy (weight, t->weight, n * sizeof *weight);
        if (beta) memcpy (beta, t->beta, n * sizeof *beta);
        return;
    }
    for (size_t b = 0; b < t->n; b++) {
        int j = whole ? node[b] : pg_sums_neighbour (&sums->sites, sums->sites.site[i], t->offset + 3*b);
        if (j < 0) continue;
        size_t e = whole ? b : sums->ordered && next < n && node[next] == j ? next : find (node, n, j);
        if (e == n) continue;
        take (sums, i, (size_t) j, b, e, xi, weight, beta);
        next = e + 1;
    }
}

/* Vectors xi (m, dim each), weights k beta (times the surface correction) and partial volumes of all bonds of
 * point i, in the order of its family; arrays that are NULL are left out. On a lattice the numbers come from
 * the stencil, so that equal bonds have equal bits. */
void pg_sums_bonds (const pg_sums *sums, const pg_family *family, size_t i, double *xi, double *weight,
                    double *beta)
{
    const pg_cloud *cloud = sums->cloud;
    size_t dim = (size_t) cloud->dim, first = family->start[i], n = family->start[i + 1] - first;
    const int *node = family->node + first;
    if (sums->stencil.n) {
        lattice_bonds (sums, node, n, i, xi, weight, beta);
        return;
    }
    for (size_t e = 0; e < n; e++) {
        size_t j = (size_t) node[e];
        sums_bond b = pg_sums_bond_between (&sums->rule, cloud, i, j);
        for (size_t k = 0; xi && k < dim; k++) xi[e*dim + k] = cloud->x[j*dim + k] - cloud->x[i*dim + k];
        if (weight) weight[e] = sums->family_volume ? b.weight * pg_sums_surface (sums, i, j) : b.weight;
        if (beta) beta[e] = b.beta;
    }
}
