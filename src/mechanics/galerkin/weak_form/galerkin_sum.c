/* SPDX-License-Identifier: GPL-3.0-or-later
 * The two loops over evaluation points that take most of the time: displacement and strain from nodal
 * values, and nodal forces from stress, f_J = sum_p w_p B_pJ' sigma_p. Together they are K x without a
 * matrix: 24 bytes a bond instead of 9 numbers a node pair. Forces are summed in a fixed number of slices of
 * the points, each over its own range of nodes, and the slices in their order: the result does not depend on
 * the number of threads. Points with the same shape functions, most of those of a lattice, are summed many
 * at a time (galerkin_runs.c), except in runs without shortcuts (pg_problem.plain). */
#include "galerkin_slices.h"
#include <stdio.h>
#include <string.h>

/* Doubles per node in sums and widened values: four are one vector load. */
static size_t stride_of (const galerkin *g) { return g->dim == 3 || g->kept ? 4 : (size_t) g->dim; }

/* Nodes outside the families of a slice are skipped where at least so many are consecutive. */
enum { GAP = 16 };

/* Finds the intervals of nodes in the families of slice k: in flat or slender bodies parts of many layers of
 * nodes, with gaps between. mark: zeros before and after (n). */
static pg_status find_seen (const galerkin *g, galerkin_slices *s, size_t k, unsigned char *mark)
{
    pg_status status = PG_OK;
    const pg_family *f = &g->sums.family;
    size_t room = 0, *n = &s->nseen[k];
    for (size_t e = f->start[s->first[k]]; e < f->start[s->first[k + 1]]; e++) mark[f->node[e]] = 1;
    for (size_t i = s->low[k]; i < s->high[k]; i++) {
        if (!mark[i]) continue;
        mark[i] = 0;
        if (*n && i < s->seen[k][*n - 1].to + GAP) {
            s->seen[k][*n - 1].to = i + 1;
            continue;
        }
        PG_GROW (s->seen[k], room, *n + 1);
        s->seen[k][(*n)++] = (interval) { i, i + 1 };
    }
done:
    return status;
}

/* Creates sixteen slices of the points whatever the number of threads, each with room for the nodes in its
 * families. Points are numbered along the lattice, so that these ranges overlap little. */
pg_status galerkin_slices_create (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_family *f = &g->sums.family;
    galerkin_slices *s = NULL;
    size_t stride = stride_of (g);
    unsigned char *mark = NULL;
    PG_ALLOC (mark, g->n);
    PG_ALLOC (s, 1);
    g->slices = s;
    for (size_t k = 0; k <= SLICES; k++) s->first[k] = f->n * k / SLICES;
    for (size_t k = 0; k < SLICES; k++) {
        size_t low = g->n, high = 0;
        for (size_t e = f->start[s->first[k]]; e < f->start[s->first[k + 1]]; e++) {
            size_t j = (size_t) f->node[e];
            low = j < low ? j : low, high = j >= high ? j + 1 : high;
        }
        s->low[k] = low < high ? low : 0, s->high[k] = low < high ? high : 0;
        PG_ALLOC (s->sum[k], (s->high[k] - s->low[k]) * stride);
        PG_TRY (find_seen (g, s, k, mark));
    }
    PG_ALLOC (s->x, g->n * stride);
    s->has_runs = g->dim > 1 && !g->problem->plain;
    for (size_t k = 0; k < SLICES && s->has_runs; k++) {
        s->runs[k] = (galerkin_run_list) { .first = s->first[k], .last = s->first[k + 1], .stale = 1 };
        for (int c = 0; c < g->dim; c++) PG_ALLOC (s->part[k][c], s->high[k] - s->low[k] + GALERKIN_LANES);
    }
    for (int c = 0; c < g->dim && s->has_runs; c++) PG_ALLOC (s->component[c], g->n + GALERKIN_LANES);
done:
    pg_free (mark);
    return status;
}

/* Marks the slices of these points as stale (list NULL: all): they search their runs anew in the next
 * product. */
void galerkin_slices_stale (galerkin *g, size_t count, const size_t *list)
{
    galerkin_slices *s = g->slices;
    for (size_t k = 0; k < SLICES && s && !list; k++) s->runs[k].stale = 1;
    for (size_t i = 0, k = 0; i < count && list; i++) {
        while (list[i] >= s->first[k + 1]) k++;
        while (list[i] < s->first[k]) k--;
        s->runs[k].stale = 1;
    }
}

/* Frees the slices; NULL: nothing to do. */
void galerkin_slices_free (galerkin *g)
{
    galerkin_slices *s = g->slices;
    for (size_t k = 0; s && k < SLICES; k++) {
        pg_free (s->sum[k]), pg_free (s->seen[k]);
        for (int c = 0; c < 3; c++) pg_free (s->part[k][c]);
        galerkin_runs_clear (&s->runs[k]);
    }
    for (int c = 0; s && c < 3; c++) pg_free (s->component[c]);
    if (s) pg_free (s->x);
    pg_free (s);
    g->slices = NULL;
}

/* ---- one point ----------------------------------------------------------------------------------------- */
/* f (4 numbers a node, from node `low` on) += w B' sigma */
INLINE void force_solid (const pg_rows *r, size_t p, const double *s, double *f, size_t low)
{
    double w = r->weight[p];
    four s0 = { w * s[0], w * s[3], w * s[5], 0 }, s1 = { w * s[3], w * s[1], w * s[4], 0 },
         s2 = { w * s[5], w * s[4], w * s[2], 0 };
    const int *node = r->family.node;
    size_t offset = pg_rows_offset (r, p);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        four *to = (four *) (f + 4 * ((size_t) node[k] - low));
        const double *q = r->dN + 3 * (k + offset);
        *to += q[0] * s0 + q[1] * s1 + q[2] * s2;
    }
}

/* f (dim numbers a node, from node `low` on) += w B' sigma. */
INLINE void force_flat (int dim, const pg_rows *r, size_t p, const double *s, double *f, size_t low)
{
    double w = r->weight[p];
    size_t offset = pg_rows_offset (r, p);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        size_t j = (size_t) r->family.node[k] - low;
        if (dim == 1) f[j] += w * r->dN[k + offset] * s[0];
        else {
            const double *q = r->dN + 2 * (k + offset);
            f[2 * j] += w * (q[0] * s[0] + q[1] * s[2]), f[2 * j + 1] += w * (q[1] * s[1] + q[0] * s[2]);
        }
    }
}

/* ---- nodal values ------------------------------------------------------------------------------------ */
/* Copies nodal values to slices->x with four numbers a node. */
static const double *four_a_node (galerkin *g, const double *d)
{
    double *x = g->slices->x;
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->n; i++)
        for (size_t c = 0; c < dim; c++) x[4 * i + c] = d[dim * i + c];
    return x;
}

/* Nodal values in the layout that loops over points use: four numbers a node in 3D, else dim. */
const double *galerkin_widened (galerkin *g, const double *d) { return g->dim == 3 ? four_a_node (g, d) : d; }

/* Copies nodal values into an array for each component. */
void galerkin_split (galerkin *g, const double *x)
{
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->n; i++)
        for (size_t c = 0; c < dim; c++) g->slices->component[c][i] = x[i * dim + c];
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* A sum of forces. x: nodal values whose stresses are summed; NULL: stresses of the last measure. at: the
 * nodal values, four numbers a node, if there is a stabilisation. */
typedef struct {
    galerkin *g;
    const double *x, *at;
    double   *f;
    const unsigned char *active;                       /* blocks of points where x is not zero; NULL: all */
    int       single;                                  /* 1: points are summed one by one */
} summing;

/* s = D e in 3D; loops of constant length. */
INLINE void tangent (const double *D, const double *e, double *s)
{
    for (int v = 0; v < 6; v++) {
        s[v] = 0;
        for (int w = 0; w < 6; w++) s[v] += D[v * 6 + w] * e[w];
    }
}

/* Adds forces of some points in 3D: by the measured stresses, or (x given) by those of displacement x. */
PG_WIDE static void sum_solid (const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    galerkin *g = m->g;
    const pg_rows *r = &g->sums;
    double e[6], own[6];
    for (size_t p = first; p < last; p++) {
        const double *s = g->measured.stress[g->bulk] + 6 * p;
        if (m->x) {
            strain_solid (r, p, m->x, NULL, e);
            tangent (galerkin_plain (g, g->bulk, p)->D, e, own);
            s = own;
        }
        force_solid (r, p, s, sum, low);
    }
}

/* Adds to `sum` the internal forces of points in 1D or 2D: from the stresses stored at the points or, if x is
 * given, from the stresses of displacement x. dim is a compile-time constant at each call. */
INLINE void sum_flat (int dim, const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    galerkin *g = m->g;
    const pg_rows *r = &g->sums;
    size_t nv = dim == 2 ? 3 : 1;
    double e[3], own[3];
    for (size_t p = first; p < last; p++) {
        const double *s = g->measured.stress[g->bulk] + nv * p, *D = galerkin_plain (g, g->bulk, p)->D;
        if (m->x) {
            strain_flat (dim, r, p, m->x, NULL, e);
            for (size_t v = 0; v < nv; v++) {
                own[v] = 0;
                for (size_t w = 0; w < nv; w++) own[v] += D[v * nv + w] * e[w];
            }
            s = own;
        }
        force_flat (dim, r, p, s, sum, low);
    }
}

PG_WIDE static void sum_plane (const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    sum_flat (2, m, first, last, sum, low);
}

static void sum_line (const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    sum_flat (1, m, first, last, sum, low);
}

/* Adds forces of points first .. last - 1 of slice k in active blocks, one by one. */
static void sum_points (const summing *m, size_t k, size_t first, size_t last)
{
    const galerkin *g = m->g;
    for (size_t from = first; m->active && from < last; ) {
        size_t block = from / GALERKIN_BLOCK, end = (block + 1) * GALERKIN_BLOCK;
        summing all = *m;
        all.active = NULL;
        if (end > last) end = last;
        if (m->active[block]) sum_points (&all, k, from, end);
        from = end;
    }
    if (m->active) return;
    const galerkin_slices *s = g->slices;
    if (g->kept)
        galerkin_silling_sum (g, first, last, m->x ? NULL : g->measured.stress[g->bulk], m->at, s->sum[k],
                              s->low[k]);
    else
        (g->dim == 3 ? sum_solid : g->dim == 2 ? sum_plane : sum_line) (m, first, last, s->sum[k],
                                                                         s->low[k]);
}

/* Is no block of a slice active? */
static int is_quiet (const summing *m, size_t k)
{
    const galerkin_slices *s = m->g->slices;
    size_t block = s->first[k] / GALERKIN_BLOCK,
           end = (s->first[k + 1] + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
    return m->active && (end == block || !memchr (m->active + block, 1, end - block));
}

/* Sets the sums of a slice to zero at the nodes of its families; runs: those of runs as well (lanes beyond
 * the end of a run add zeros to values elsewhere). */
static void begin_sum (galerkin *g, size_t k, int runs)
{
    galerkin_slices *s = g->slices;
    size_t dim = runs ? (size_t) g->dim : 0, stride = stride_of (g), low = s->low[k];
    for (size_t i = 0; i < s->nseen[k]; i++) {
        size_t from = s->seen[k][i].from - low, n = s->seen[k][i].to - low - from;
        memset (s->sum[k] + from * stride, 0, n * stride * sizeof *s->sum[k]);
        for (size_t c = 0; c < dim; c++) memset (s->part[k][c] + from, 0, n * sizeof *s->part[k][c]);
    }
}

/* Sums up whole slices, each by one thread: runs, and the points between them. */
static void sum_slices (void *context, size_t first, size_t last, int thread)
{
    const summing *m = context;
    galerkin_slices *s = m->g->slices;
    (void) thread;
    for (size_t k = first; k < last; k++) {
        size_t at = s->first[k];
        s->quiet[k] = is_quiet (m, k);
        if (s->quiet[k]) continue;
        if (m->x && s->has_runs) galerkin_runs_find (m->g, &s->runs[k]);
        begin_sum (m->g, k, m->x && s->runs[k].n);
        for (size_t i = 0; m->x && i < s->runs[k].n; i++) {
            const galerkin_run *run = &s->runs[k].run[i];
            sum_points (m, k, at, run->point);
            galerkin_run_sum (m->g, &s->runs[k], run, (const double *const *) s->component, s->part[k],
                              s->low[k], m->active);
            at = run->point + run->points * run->count;
        }
        sum_points (m, k, at, s->first[k + 1]);
    }
}

/* f += the sums of slice k for the nodes from .. to - 1 in 3D; runs: 1: it has sums of runs as well. */
static void add_solid (const galerkin_slices *s, size_t k, int runs, size_t from, size_t to,
                       double *restrict f)
{
    size_t low = s->low[k];
    const double *restrict sum = s->sum[k], *restrict x = s->part[k][0], *restrict y = s->part[k][1],
                 *restrict z = s->part[k][2];
    for (size_t i = from; i < to; i++) {
        const double *own = sum + 4 * (i - low);
        f[3 * i] += own[0], f[3 * i + 1] += own[1], f[3 * i + 2] += own[2];
    }
    for (size_t i = from; i < to && runs; i++)
        f[3 * i] += x[i - low], f[3 * i + 1] += y[i - low], f[3 * i + 2] += z[i - low];
}

/* f += the sums of slice k for the nodes from .. to - 1. */
static void add_slice (const summing *m, size_t k, size_t from, size_t to)
{
    const galerkin_slices *s = m->g->slices;
    size_t dim = (size_t) m->g->dim, stride = stride_of (m->g), low = s->low[k];
    int runs = m->x && !m->single && s->runs[k].n;
    if (dim == 3) add_solid (s, k, runs, from, to, m->f);
    for (size_t i = from; i < to && dim < 3; i++)
        for (size_t c = 0; c < dim; c++) m->f[i * dim + c] += s->sum[k][(i - low) * stride + c];
    for (size_t i = from; i < to && dim < 3 && runs; i++)
        for (size_t c = 0; c < dim; c++) m->f[i * dim + c] += s->part[k][c][i - low];
}

/* Adds the sums of all slices for a range of nodes, slices in their order. */
static void add_slices (void *context, size_t first, size_t last, int thread)
{
    const summing *m = context;
    const galerkin_slices *s = m->g->slices;
    (void) thread;
    for (size_t k = 0; k < SLICES; k++)
        for (size_t i = 0; i < s->nseen[k] && !s->quiet[k]; i++) {
            const interval *seen = &s->seen[k][i];
            add_slice (m, k, first > seen->from ? first : seen->from, last < seen->to ? last : seen->to);
        }
}

/* f += forces of all points by stresses of x, or (NULL) as measured, at displacement d. active: blocks of
 * points; NULL: all. */
static void sum_all (galerkin *g, const double *x, const double *d, double *f, const unsigned char *active)
{
    summing m = { g, x, NULL, f, active, 0 };
    if (g->kept) m.at = four_a_node (g, d);
    else if (x) m.x = galerkin_widened (g, x);
    if (x && g->slices->has_runs) galerkin_split (g, x);
    pg_parallel_heavy (g->threads, SLICES, sum_slices, &m);
    pg_parallel (g->threads, g->n, add_slices, &m);
    for (size_t k = 0; x && k < SLICES; k++) g->slices->alike += (double) g->slices->runs[k].bonds;
}

/* Reports shortcut number k (pg_force_type.spared); seconds by stored rates: the time a bond takes alone less
 * that as one of eight. The texts hold no counts, which would begin anew in a resumed run. */
int galerkin_spared (const void *self, size_t k, char *what, char *why, double *seconds)
{
    const galerkin *g = self;
    const galerkin_slices *s = g->slices;
    if (g->bounds.place_now && k-- == 0) {
        snprintf (what, 96, "utilisation of most bonds");
        snprintf (why, 160, "a bond breaks by its elongation: only where the longest of a block reaches the "
                            "limit they are judged");
        *seconds = NAN;
        return 1;
    }
    if (k > 0 || !(s->alike > 0)) return 0;
    snprintf (what, 96, "shape functions point by point in products K x");
    snprintf (why, 160, "points of a lattice that see their nodes alike are summed eight at a time");
    *seconds = (g->dim == 3 ? 1.4e-9 : 3e-9) * s->alike;
    return 1;
}

void galerkin_sum_stress (galerkin *g, const double *d, double *f) { sum_all (g, NULL, d, f, NULL); }

void galerkin_sum_tangent (galerkin *g, const double *x, double *f)
{
    sum_all (g, x, x, f, galerkin_active (g, g->bulk, x, NULL));
}

/* Adds forces of the listed points one by one: a run would include others. */
void galerkin_sum_list (galerkin *g, size_t count, const size_t *list, const double *x, double *f)
{
    galerkin_slices *s = g->slices;
    summing m = { g, galerkin_widened (g, x), NULL, f, NULL, 1 };
    for (size_t k = 0, i = 0; k < SLICES; k++) {
        s->quiet[k] = i == count || list[i] >= s->first[k + 1];
        if (!s->quiet[k]) begin_sum (g, k, 0);
        for (; i < count && list[i] < s->first[k + 1]; i++) sum_points (&m, k, list[i], list[i] + 1);
    }
    add_slices (&m, 0, g->n, 0);
}
