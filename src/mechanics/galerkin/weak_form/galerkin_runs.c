/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs: evaluation points with the same shape functions, summed eight at a time.
 *
 * On a lattice most cells have the same shape functions as the next cell: at every evaluation point the same
 * derivatives, for nodes whose numbers are one higher. A run is a row of such cells. Its derivatives are
 * read from its first cell only, so that a product K x reads hardly more than x itself, and eight cells are
 * summed at once: as the nodes of cell k have the numbers of those of the first plus k, the values that
 * eight cells need lie side by side in memory, in one array for each component.
 *
 *   1. For every point q of eight cells: H = sum_j d_j dN_j', strain, stress times weight.
 *   2. For every node j in the families of a cell's points: f_j += sum_q s_q dN_qj, over all these points,
 *      with one addition to memory for all of them.
 *
 * The points of a cell are a group; with nodal integration, each point is one. Equal groups are found by
 * comparing their rows, number by number: bodies with holes, cracks, cut cells, broken bonds and several
 * materials need no special treatment, and points like no others are summed one by one. Derivatives may
 * differ by 1e-11 of the largest of their point, which rounding of positions causes. The runs are a function
 * of the rows alone, so that a run resumed from a checkpoint has the same ones; a slice of the points
 * searches them again where one of its rows has changed. */
#include "galerkin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* LEAST: fewest groups of a run: fewer are not worth the empty lanes. MOST: most points of a group. */
enum { LANES = GALERKIN_LANES, LEAST = 3, MOST = 27 };
static const double rounding = 1e-11;

#define INLINE static inline __attribute__ ((always_inline))
/* ---- groups with equal rows ---------------------------------------------------------------------------- */
/* The end of the group that begins with point p: the points of its cell, or p alone; 0: there are too many,
 * or the range first .. last - 1 does not contain them all. */
static size_t group_end (const pg_rows *r, size_t first, size_t last, size_t p)
{
    size_t end = p + 1;
    int cell = r->cell ? r->cell[p] : -1;
    if (cell < 0) return end;
    while (end < r->n && r->cell[end] == cell) end++;
    int cut = end > last || (p == first && p > 0 && r->cell[p - 1] == cell);
    return cut || end - p > MOST ? 0 : end;
}

/* Largest derivative of a shape function at point p, 1/m. */
static double steepest (const pg_rows *r, size_t p)
{
    double most = 0;
    size_t n = (r->family.start[p + 1] - r->family.start[p]) * (size_t) r->dim;
    const double *dN = r->dN + (r->family.start[p] + pg_rows_offset (r, p)) * (size_t) r->dim;
    for (size_t k = 0; k < n; k++) most = fmax (most, fabs (dN[k]));
    return most;
}

/* Has point p the derivatives of point q, up to rounding, for nodes whose numbers are `shift` higher? bound:
 * largest difference allowed; negative: not yet computed. */
static int alike (const galerkin *g, size_t q, size_t p, int shift, double *bound)
{
    const pg_rows *r = &g->sums;
    size_t a = r->family.start[q], b = r->family.start[p], m = r->family.start[q + 1] - a,
           dim = (size_t) r->dim, same = 0;
    if (r->family.start[p + 1] - b != m || galerkin_plain (g, g->bulk, q) != galerkin_plain (g, g->bulk, p))
        return 0;
    for (size_t k = 0; k < m; k++) same += r->family.node[b + k] == r->family.node[a + k] + shift;
    if (same < m) return 0;
    const double *s = r->dN + (a + pg_rows_offset (r, q)) * dim,
                 *t = r->dN + (b + pg_rows_offset (r, p)) * dim;
    if (s == t) return 1;
    if (*bound < 0) *bound = rounding * steepest (r, q);
    double most = *bound;
    same = 0;
    for (size_t k = 0; k < m * dim; k++) same += fabs (t[k] - s[k]) <= most;
    return same == m * dim;
}

/* Are the influences of the bonds, the own node and the grade equal, too? */
static int weighs_alike (const galerkin *g, size_t q, size_t p, int shift)
{
    const pg_rows *r = &g->sums;
    size_t a = r->family.start[q], b = r->family.start[p], m = r->family.start[q + 1] - a, same = 0;
    double most = 0;
    const double *v = r->w + a + pg_rows_offset (r, q), *w = r->w + b + pg_rows_offset (r, p);
    for (size_t k = 0; k < m; k++) most = fmax (most, v[k]);
    for (size_t k = 0; k < m; k++) same += fabs (w[k] - v[k]) <= rounding * most;
    return same == m && r->own[p] == r->own[q] + shift && r->grade[p] == r->grade[q];
}

/* Number of groups from point p on, up to point `last`, that equal the first one, which ends at `end`. */
static size_t count_alike (const galerkin *g, size_t p, size_t end, size_t last)
{
    double bound[MOST];
    size_t m = end - p, count = 1;
    for (size_t q = 0; q < m; q++) bound[q] = -1;
    for (size_t at = end; at + m <= last; at += m, count++) {
        if (group_end (&g->sums, p, last, at) != at + m) break;
        for (size_t q = 0; q < m; q++)
            if (!alike (g, p + q, at + q, (int) count, &bound[q])
                || (g->kept && !weighs_alike (g, p + q, at + q, (int) count)))
                return count;
    }
    return count;
}

/* ---- nodes of a run ------------------------------------------------------------------------------------ */
static int compare (const void *a, const void *b)
{
    const galerkin_entry *x = a, *y = b;
    if (x->place != y->place) return (x->place > y->place) - (x->place < y->place);
    if (x->node != y->node) return (x->node > y->node) - (x->node < y->node);
    return (x->point > y->point) - (x->point < y->point);  /* by point, not by memory address */
}

/* Lists the bonds of the first group ordered by their nodes. Nodes with consecutive numbers are put far apart
 * in the list: their eight values in memory overlap, and an addition would have to wait for the one
 * before. */
static pg_status list_entries (const galerkin *g, galerkin_run_list *l, galerkin_run *run)
{
    pg_status status = PG_OK;
    const pg_family *f = &g->sums.family;
    size_t first = f->start[run->point], n = f->start[run->point + run->points] - first;
    run->entry = l->nentry, run->entries = n;
    PG_GROW (l->entry, l->cap_entry, l->nentry + n);
    galerkin_entry *e = l->entry + run->entry;
    for (size_t q = 0; q < run->points; q++)
        for (size_t k = f->start[run->point + q]; k < f->start[run->point + q + 1]; k++)
            e[k - first] = (galerkin_entry) { 0, f->node[k], (int) q, k };
    pg_sort (e, n, sizeof *e, compare);
    for (size_t k = 1; k < n; k++)
        e[k].place = e[k].node == e[k - 1].node ? e[k - 1].place
                     : e[k].node == e[k - 1].node + 1 ? e[k - 1].place + 1 : 0;
    pg_sort (e, n, sizeof *e, compare);
    l->nentry += n;
done:
    return status;
}

/* Have N and dN of all groups the same bits? Rows that are moved in memory later keep their bits as long as
 * the run is not stale. */
static int has_one_row (const pg_rows *r, const galerkin_run *run)
{
    size_t last = run->point + run->points * run->count, dim = (size_t) r->dim;
    int same = 1;
    for (size_t p = run->point + run->points; p < last && same; p++) {
        size_t q = p - run->points, m = r->family.start[p + 1] - r->family.start[p],
               a = r->family.start[q] + pg_rows_offset (r, q), b = r->family.start[p] + pg_rows_offset (r, p);
        same = a == b || (memcmp (r->dN + a * dim, r->dN + b * dim, m * dim * sizeof *r->dN) == 0
                          && memcmp (r->N + a, r->N + b, m * sizeof *r->N) == 0);
    }
    return same;
}

static pg_status new_run (const galerkin *g, galerkin_run_list *l, galerkin_run run)
{
    pg_status status = PG_OK;
    PG_GROW (l->run, l->cap, l->n + 1);
    PG_TRY (list_entries (g, l, &run));
    run.same = has_one_row (&g->sums, &run);
    l->run[l->n++] = run, l->bonds += run.entries * run.count;
done:
    return status;
}

/* Finds the runs from left to right: the longest one that begins at a group, or the group stays alone. */
static pg_status find_runs (const galerkin *g, galerkin_run_list *l)
{
    pg_status status = PG_OK;
    for (size_t p = l->first, m, count; p < l->last; p += count < LEAST ? m : m * count) {
        size_t end = group_end (&g->sums, l->first, l->last, p);
        m = end ? end - p : 1, count = end ? count_alike (g, p, end, l->last) : 0;
        if (count >= LEAST)
            PG_TRY (new_run (g, l, (galerkin_run) { .point = p, .points = m, .count = count }));
    }
done:
    return status;
}

/* Finds the runs if the list is stale. Without memory there are none, and all points are summed one by
 * one. */
void galerkin_runs_find (const galerkin *g, galerkin_run_list *l)
{
    if (!l->stale) return;
    l->stale = 0, l->n = l->nentry = l->bonds = 0;
    if (find_runs (g, l) != PG_OK) l->n = l->nentry = l->bonds = 0;
}

void galerkin_runs_clear (galerkin_run_list *l)
{
    pg_free (l->run), pg_free (l->entry);
    memset (l, 0, sizeof *l);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Strains e of eight cells at their point p: xx yy zz xy yz zx, engineering shears; u: displacements (NULL:
 * not wanted). Each lane has the same operations in the same order as a single point (galerkin_slices.h). */
INLINE void strain_solid (const galerkin_bundle *b, size_t p, eight *e, eight *u)
{
    const pg_rows *r = &b->g->sums;
    const int *node = r->family.node;
    const double *x = b->x[0] + b->lane, *y = b->x[1] + b->lane, *z = b->x[2] + b->lane;
    size_t offset = pg_rows_offset (r, p);
    eight xx = { 0 }, xy = { 0 }, xz = { 0 }, yx = { 0 }, yy = { 0 }, yz = { 0 }, zx = { 0 }, zy = { 0 },
          zz = { 0 }, ux = { 0 }, uy = { 0 }, uz = { 0 };
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        size_t j = (size_t) node[k];
        const double *q = r->dN + (k + offset) * 3;
        eight dx = *(const eight *) (x + j), dy = *(const eight *) (y + j), dz = *(const eight *) (z + j);
        xx += q[0] * dx, xy += q[1] * dx, xz += q[2] * dx;
        yx += q[0] * dy, yy += q[1] * dy, yz += q[2] * dy;
        zx += q[0] * dz, zy += q[1] * dz, zz += q[2] * dz;
        if (u) ux += r->N[k + offset] * dx, uy += r->N[k + offset] * dy, uz += r->N[k + offset] * dz;
    }
    e[0] = xx, e[1] = yy, e[2] = zz, e[3] = xy + yx, e[4] = yz + zy, e[5] = zx + xz;
    if (u) u[0] = ux, u[1] = uy, u[2] = uz;
}

/* Strains e of eight cells at their point p in 2D: xx yy xy, engineering shear; u: displacements (NULL: not
 * wanted). */
INLINE void strain_plane (const galerkin_bundle *b, size_t p, eight *e, eight *u)
{
    const pg_rows *r = &b->g->sums;
    const int *node = r->family.node;
    const double *x = b->x[0] + b->lane, *y = b->x[1] + b->lane;
    size_t offset = pg_rows_offset (r, p);
    eight xx = { 0 }, xy = { 0 }, yy = { 0 }, ux = { 0 }, uy = { 0 };
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        size_t j = (size_t) node[k];
        const double *q = r->dN + (k + offset) * 2;
        eight dx = *(const eight *) (x + j), dy = *(const eight *) (y + j);
        xx += q[0] * dx, yy += q[1] * dy, xy += q[1] * dx + q[0] * dy;
        if (u) ux += r->N[k + offset] * dx, uy += r->N[k + offset] * dy;
    }
    e[0] = xx, e[1] = yy, e[2] = xy;
    if (u) u[0] = ux, u[1] = uy;
}

/* s: stress times weight of point q of eight cells (nv, ordered as the strain). Lanes beyond the run have
 * weight 0. */
INLINE void stress_of (int dim, const galerkin_bundle *b, size_t q, eight *s)
{
    const pg_rows *r = &b->g->sums;
    size_t p = b->run->point + q, nv = dim == 3 ? 6 : 3;
    double w[LANES] = { 0 };
    const double *D = galerkin_plain (b->g, b->g->bulk, p)->D;
    eight e[6];
    if (dim == 3) strain_solid (b, p, e, NULL);
    else strain_plane (b, p, e, NULL);
    for (size_t k = 0; k < b->left; k++) w[k] = r->weight[p + (b->lane + k) * b->run->points];
    for (size_t v = 0; v < nv; v++, D += nv) {
        eight sum = D[0] * e[0] + D[1] * e[1] + D[2] * e[2];
        if (dim == 3) sum += D[3] * e[3] + D[4] * e[4] + D[5] * e[5];
        s[v] = *(const eight *) w * sum;
    }
}

/* Sums up one bundle of eight groups: stresses of all points, then forces node by node. */
INLINE void sum_bundle (int dim, const galerkin_bundle *b)
{
    const pg_rows *r = &b->g->sums;
    size_t nv = dim == 3 ? 6 : 3;
    const galerkin_entry *e = b->entry, *end = e + b->run->entries;
    eight stress[6 * MOST];
    const double *row[MOST];                          /* rows of the first group, where they are stored now */
    for (size_t q = 0; q < b->run->points; q++) {
        stress_of (dim, b, q, stress + nv * q);
        row[q] = r->dN + pg_rows_offset (r, b->run->point + q) * (size_t) dim;
    }
    while (e < end) {
        int node = e->node;
        size_t to = (size_t) node + b->lane - b->low;
        eight x = { 0 }, y = { 0 }, z = { 0 };
        for (; e < end && e->node == node; e++) {
            const eight *s = stress + nv * (size_t) e->point;
            const double *q = row[e->point] + e->bond * (size_t) dim;
            if (dim == 3) {
                x += q[0] * s[0] + q[1] * s[3] + q[2] * s[5];
                y += q[0] * s[3] + q[1] * s[1] + q[2] * s[4];
                z += q[0] * s[5] + q[1] * s[4] + q[2] * s[2];
            } else x += q[0] * s[0] + q[1] * s[2], y += q[0] * s[2] + q[1] * s[1];
        }
        *(eight *) (b->f[0] + to) += x, *(eight *) (b->f[1] + to) += y;
        if (dim == 3) *(eight *) (b->f[2] + to) += z;
    }
}

PG_WIDEST static void sum_solid (const galerkin_bundle *b) { sum_bundle (3, b); }
PG_WIDEST static void sum_plane (const galerkin_bundle *b) { sum_bundle (2, b); }

/* Is a point of the bundle's groups in an active block? */
static int is_active (const galerkin_bundle *b, const unsigned char *active)
{
    size_t first = b->run->point + b->lane * b->run->points, last = first + b->left * b->run->points - 1;
    int any = 0;
    for (size_t k = first / GALERKIN_BLOCK; k <= last / GALERKIN_BLOCK; k++) any |= active[k];
    return any;
}

void galerkin_run_sum (const galerkin *g, const galerkin_run_list *l, const galerkin_run *run,
                       const double *const x[3], double *const f[3], size_t low, const unsigned char *active)
{
    galerkin_bundle b = { g, run, l->entry + run->entry, x, f, low, 0, 0 };
    for (; b.lane < run->count; b.lane += LANES) {
        b.left = run->count - b.lane < LANES ? run->count - b.lane : LANES;
        if (active && !is_active (&b, active)) continue;
        if (g->kept) galerkin_silling_bundle (&b);
        else (g->dim == 3 ? sum_solid : sum_plane) (&b);
    }
}

/* Writes n numbers of each lane to the points of a bundle, from point p on, b->run->points apart. */
INLINE void scatter (const galerkin_bundle *b, size_t n, const eight *from, size_t p, double *to)
{
    for (size_t k = 0; k < b->left; k++, p += b->run->points)
        for (size_t i = 0; i < n; i++) to[p * n + i] = from[i][k];
}

/* Computes u and strain of the points of one bundle. */
INLINE void strain_bundle (int dim, const galerkin_bundle *b, double *u, double *strain)
{
    for (size_t q = b->run->point, p = q + b->lane * b->run->points; q < b->run->point + b->run->points;
         q++, p++) {
        eight e[6] = { { 0 } }, v[3] = { { 0 } };
        if (dim == 3) strain_solid (b, q, e, v);
        else strain_plane (b, q, e, v);
        scatter (b, dim == 3 ? 6 : 3, e, p, strain), scatter (b, (size_t) dim, v, p, u);
    }
}

PG_WIDEST static void strain_bundle_solid (const galerkin_bundle *b, double *u, double *strain)
{
    strain_bundle (3, b, u, strain);
}

PG_WIDEST static void strain_bundle_plane (const galerkin_bundle *b, double *u, double *strain)
{
    strain_bundle (2, b, u, strain);
}

void galerkin_run_strain (const galerkin *g, const galerkin_run *run, const double *const x[3],
                          const unsigned char *active, double *u, double *strain)
{
    galerkin_bundle b = { g, run, NULL, x, NULL, 0, 0, 0 };
    for (; b.lane < run->count; b.lane += LANES) {
        b.left = run->count - b.lane < LANES ? run->count - b.lane : LANES;
        if (active && !is_active (&b, active)) continue;
        (g->dim == 3 ? strain_bundle_solid : strain_bundle_plane) (&b, u, strain);
    }
}
