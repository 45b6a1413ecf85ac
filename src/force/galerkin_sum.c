/* SPDX-License-Identifier: GPL-3.0-or-later
 * The two loops over evaluation points that everything costs: displacement and strain from nodal values, and
 * nodal forces from stress, f_J = sum_p w_p B_pJ' sigma_p. Together they are K x without a matrix: 24 bytes a
 * bond instead of 9 numbers a node pair. Forces are summed in a fixed number of slices of the points, each
 * over its own range of nodes, and the slices in their order: the answer does not depend on the number of
 * threads. Points that are like others, most of those of a lattice, are summed many at a time
 * (galerkin_runs.c), unless the scene wants the plain way. */
#include "galerkin.h"
#include <stdio.h>
#include <string.h>

enum { SLICES = 16 };

#define INLINE static inline __attribute__ ((always_inline))

/* Nodes from .. to - 1. */
typedef struct { size_t from, to; } interval;

struct galerkin_slices {
    size_t  first[SLICES + 1];                         /* points of a slice */
    size_t  low[SLICES], high[SLICES];                 /* range of the nodes they see */
    interval *seen[SLICES]; size_t nseen[SLICES];      /* these nodes themselves, without wide gaps */
    double *sum[SLICES];                               /* per node of the range, 4 numbers or dim */
    double *x;                                         /* nodal values, 4 numbers a node or dim */
    /* Points that are alike in each slice; what they add up to, and nodal values, an array for each
     * component. has_runs: not in one dimension, and not where the plain way is wanted. */
    int     has_runs;
    galerkin_run_list runs[SLICES];
    double *part[SLICES][3], *component[3];
    int     quiet[SLICES];                             /* of the sum at hand: no block is active */
    /* Bonds of points that were alike, summed over the products so far. */
    double  alike;
};

/* Numbers of a node in sums and widened values: four are one vector load. */
static size_t stride_of (const galerkin *g) { return g->dim == 3 || g->kept ? 4 : (size_t) g->dim; }

/* Nodes that no point of a slice sees are passed by where so many follow each other. */
enum { GAP = 16 };

/* A slice of a flat or a slender body sees parts of many layers of nodes, and not what lies between them.
 * mark: zeros before and after (n). */
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

/* Sixteen slices of the points whatever the number of threads, each with room for the nodes that its
 * points see. Points are numbered along the lattice, so that these ranges overlap little. */
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

/* Slices with changed rows look for their runs anew when they are next asked for a product. */
void galerkin_slices_stale (galerkin *g, size_t count, const size_t *list)
{
    galerkin_slices *s = g->slices;
    for (size_t k = 0; k < SLICES && s && !list; k++) galerkin_runs_forget (&s->runs[k]);
    for (size_t i = 0, k = 0; i < count && list; i++) {
        while (list[i] >= s->first[k + 1]) k++;
        while (list[i] < s->first[k]) k--;
        galerkin_runs_change (&s->runs[k], list[i]);
    }
}

/* Also where there are none. */
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
/* u (optional) and strain of a point in 3D, x having 4 numbers a node */
INLINE void strain_solid (const pg_rows *r, size_t p, const double *x, double *u, double *e)
{
    four h0 = { 0 }, h1 = { 0 }, h2 = { 0 }, s = { 0 };
    const int *node = r->family.node;
    size_t offset = pg_rows_offset (r, p);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        four d = *(const four *) (x + 4 * (size_t) node[k]);
        const double *q = r->dN + 3 * (k + offset);
        h0 += q[0] * d, h1 += q[1] * d, h2 += q[2] * d;
        if (u) s += r->N[k + offset] * d;
    }
    e[0] = h0[0], e[1] = h1[1], e[2] = h2[2], e[3] = h1[0] + h0[1], e[4] = h2[1] + h1[2],
    e[5] = h2[0] + h0[2];
    for (int c = 0; u && c < 3; c++) u[c] = s[c];
}

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

/* The same in one and two dimensions: e is (xx) or (xx, yy, 2 xy). */
INLINE void strain_flat (int dim, const pg_rows *r, size_t p, const double *x, double *u, double *e)
{
    size_t offset = pg_rows_offset (r, p);
    double u0 = 0, u1 = 0, e0 = 0, e1 = 0, e2 = 0;
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        if (dim == 1) {
            double d = x[r->family.node[k]];
            u0 += r->N[k + offset] * d, e0 += r->dN[k + offset] * d;
        } else {
            const double *d = x + 2 * (size_t) r->family.node[k], *q = r->dN + 2 * (k + offset);
            u0 += r->N[k + offset] * d[0], u1 += r->N[k + offset] * d[1];
            e0 += q[0] * d[0], e1 += q[1] * d[1], e2 += q[1] * d[0] + q[0] * d[1];
        }
    }
    e[0] = e0;
    if (dim == 2) e[1] = e1, e[2] = e2;
    if (u) u[0] = u0;
    if (u && dim == 2) u[1] = u1;
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

/* ---- measures ------------------------------------------------------------------------------------------ */
typedef struct {
    galerkin *g;
    int       set;
    const pg_rows *rows;
    const double  *x;
    const size_t  *list;
    const unsigned char *active;                       /* blocks of points; NULL: all */
} measuring;

PG_WIDE static void measure_solid (const measuring *m, size_t first, size_t last)
{
    galerkin *g = m->g;
    for (size_t i = first; i < last; i++) {
        size_t p = m->list ? m->list[i] : i;
        strain_solid (m->rows, p, m->x, g->u[m->set] + 3 * p, g->strain[m->set] + 6 * p);
    }
}

/* Displacement, strain and stress at a range of points, or of entries of a list. In space strains come
 * first, in a loop of their own that the compiler can widen. */
static void measure_points (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    galerkin *g = m->g;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    (void) thread;
    if (dim == 3) measure_solid (m, first, last);
    for (size_t i = first; i < last; i++) {
        size_t p = m->list ? m->list[i] : i;
        double *e = g->strain[m->set] + p * nv;
        if (dim == 2) strain_flat (2, m->rows, p, m->x, g->u[m->set] + p * dim, e);
        if (dim == 1) strain_flat (1, m->rows, p, m->x, g->u[m->set] + p * dim, e);
        if (g->eigen[m->set]) {
            galerkin_eigen_stress (g, m->set, p, e);
            continue;
        }
        const pg_material *mat = galerkin_plain (g, m->set, p);
        mat->type->stress (mat, 1, e, g->stress[m->set] + p * nv, g->zz[m->set] + p);
    }
}

/* Nodal values with four numbers a node. */
static const double *four_a_node (galerkin *g, const double *d)
{
    double *x = g->slices->x;
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->n; i++)
        for (size_t c = 0; c < dim; c++) x[4 * i + c] = d[dim * i + c];
    return x;
}

/* Nodal values as the loops over points take them. */
static const double *widened (galerkin *g, const double *d) { return g->dim == 3 ? four_a_node (g, d) : d; }

/* What is derived of the stress of a block of points is to be derived anew. */
static void forget_bounds (galerkin *g, int set, size_t block)
{
    if (g->bounded[set]) g->bounded[set][block] = 0;
}

static size_t blocks_of (const galerkin *g, int set)
{
    return (g->rows[set].n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
}

/* Points in those of some blocks that are active. */
static void measure_blocks (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    size_t n = m->g->rows[m->set].n;
    for (size_t b = first; b < last; b++) {
        size_t end = (b + 1) * GALERKIN_BLOCK < n ? (b + 1) * GALERKIN_BLOCK : n;
        const unsigned char *disturbed = m->g->disturbed[m->set];
        if (m->active && !m->active[b] && !(disturbed && disturbed[b])) continue;
        measure_points (context, b * GALERKIN_BLOCK, end, thread);
        forget_bounds (m->g, m->set, b);
    }
}

/* All points of a set, unless they were measured at the same displacement already: balances, fields and
 * criteria ask for the same one several times a step. Where only some nodes have moved since, the points that
 * see them. */
void galerkin_measure (galerkin *g, int set, const double *d)
{
    size_t bytes = g->n * (size_t) g->dim * sizeof *d;
    const unsigned char *active = NULL;
    int whole = g->fresh[set] && (!g->disturbed[set] || !memchr (g->disturbed[set], 1, blocks_of (g, set)));
    if (whole && memcmp (g->seen[set], d, bytes) == 0) return;
    if (g->fresh[set]) active = galerkin_active (g, set, d, g->seen[set]);
    memcpy (g->seen[set], d, bytes);
    measuring m = { g, set, set == g->bulk ? &g->sums : &g->rows[set], widened (g, d), NULL, active };
    pg_parallel (g->threads, blocks_of (g, set), measure_blocks, &m);
    if (g->disturbed[set]) memset (g->disturbed[set], 0, blocks_of (g, set));
    if (g->dilatation) galerkin_dilatation_measure (g, set, d);
    g->fresh[set] = 1;
}

/* Some points anew at the displacement measured last, after their shape functions have changed. */
void galerkin_measure_list (galerkin *g, int set, size_t count, const size_t *list)
{
    measuring m = { g, set, set == g->bulk ? &g->sums : &g->rows[set], widened (g, g->seen[set]), list,
                    NULL };
    measure_points (&m, 0, count, 0);
    for (size_t k = 0; k < count; k++) forget_bounds (g, set, list[k] / GALERKIN_BLOCK);
}

/* What was measured at these points belongs to another displacement than what was at all others. */
static void disturb (galerkin *g, int set, size_t count, const size_t *list)
{
    if (!g->disturbed[set]) g->disturbed[set] = pg_calloc (blocks_of (g, set), 1);
    if (!g->disturbed[set]) g->fresh[set] = 0;         /* without memory nothing is known any more */
    for (size_t k = 0; k < count && g->disturbed[set]; k++) g->disturbed[set][list[k] / GALERKIN_BLOCK] = 1;
}

/* Some points at a displacement that is known at some nodes only, all that these points see. */
void galerkin_measure_some (galerkin *g, int set, const double *d, size_t count, const size_t *list,
                            size_t nnode, const int *node)
{
    double *x = g->slices->x;
    for (size_t k = 0; g->dim == 3 && k < nnode; k++)
        for (size_t c = 0, i = (size_t) node[k]; c < 3; c++) x[4 * i + c] = d[3 * i + c];
    measuring m = { g, set, set == g->bulk ? &g->sums : &g->rows[set], g->dim == 3 ? x : d, list, NULL };
    disturb (g, set, count, list);
    measure_points (&m, 0, count, 0);
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* x: nodal values whose stresses are summed; NULL: stresses of the last measure. at: the nodal values, four
 * numbers a node, where there is a stabilisation. */
typedef struct {
    galerkin *g;
    const double *x, *at;
    double   *f;
    const unsigned char *active;                       /* blocks of points that x is not zero at; NULL: all */
    int       single;                                  /* 1: without runs */
} summing;

/* s = D e in space; a loop of constant length. */
INLINE void tangent (const double *D, const double *e, double *s)
{
    for (int v = 0; v < 6; v++) {
        s[v] = 0;
        for (int w = 0; w < 6; w++) s[v] += D[v * 6 + w] * e[w];
    }
}

/* Forces of some points in space: by the stresses at hand, or (x given) by those of displacement x. */
PG_WIDE static void sum_solid (const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    galerkin *g = m->g;
    const pg_rows *r = &g->sums;
    double e[6], own[6];
    for (size_t p = first; p < last; p++) {
        const double *s = g->stress[g->bulk] + 6 * p;
        if (m->x) {
            strain_solid (r, p, m->x, NULL, e);
            tangent (galerkin_plain (g, g->bulk, p)->D, e, own);
            s = own;
        }
        force_solid (r, p, s, sum, low);
    }
}

/* The same in one and two dimensions, `dim` being a number that the compiler knows. */
INLINE void sum_flat (int dim, const summing *m, size_t first, size_t last, double *sum, size_t low)
{
    galerkin *g = m->g;
    const pg_rows *r = &g->sums;
    size_t nv = dim == 2 ? 3 : 1;
    double e[3], own[3];
    for (size_t p = first; p < last; p++) {
        const double *s = g->stress[g->bulk] + nv * p, *D = galerkin_plain (g, g->bulk, p)->D;
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

/* Some points one by one. */
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
        galerkin_silling_sum (g, first, last, m->x ? NULL : g->stress[g->bulk], m->at, s->sum[k], s->low[k]);
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

/* The sums of a slice are zero at the nodes that its points see; runs: those of runs as well, whose lanes
 * beyond their end add zeros to whatever stands elsewhere. */
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

/* Whole slices, each by one thread: runs, and the points between them. */
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

/* f += the sums of a slice for the nodes from .. to - 1, in space; runs: it has runs as well. */
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

/* What a slice has for the nodes from .. to - 1. */
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

/* A range of nodes: what all slices have for them, slices in their order. */
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

/* Nodal values in an array for each component. */
static void split (galerkin *g, const double *x)
{
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->n; i++)
        for (size_t c = 0; c < dim; c++) g->slices->component[c][i] = x[i * dim + c];
}

/* x NULL: stresses as measured, at displacement d. active: blocks of points; NULL: all. */
static void sum_all (galerkin *g, const double *x, const double *d, double *f, const unsigned char *active)
{
    summing m = { g, x, NULL, f, active, 0 };
    if (g->kept) m.at = four_a_node (g, d);
    else if (x) m.x = widened (g, x);
    if (x && g->slices->has_runs) split (g, x);
    pg_parallel_heavy (g->threads, SLICES, sum_slices, &m);
    pg_parallel (g->threads, g->n, add_slices, &m);
    for (size_t k = 0; x && k < SLICES; k++) g->slices->alike += (double) g->slices->runs[k].bonds;
}

/* By stored rates: what a bond takes longer alone than as one of eight, s. No counts in the words: they would
 * begin anew with a run that is resumed. */
int galerkin_spared (const void *self, size_t k, char *what, char *why, double *seconds)
{
    const galerkin *g = self;
    const galerkin_slices *s = g->slices;
    if (g->place_now && k-- == 0) {
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

/* Point by point: in runs others would be summed with them. */
void galerkin_sum_list (galerkin *g, size_t count, const size_t *list, const double *x, double *f)
{
    galerkin_slices *s = g->slices;
    summing m = { g, widened (g, x), NULL, f, NULL, 1 };
    for (size_t k = 0, i = 0; k < SLICES; k++) {
        s->quiet[k] = i == count || list[i] >= s->first[k + 1];
        if (!s->quiet[k]) begin_sum (g, k, 0);
        for (; i < count && list[i] < s->first[k + 1]; i++) sum_points (&m, k, list[i], list[i] + 1);
    }
    add_slices (&m, 0, g->n, 0);
}
