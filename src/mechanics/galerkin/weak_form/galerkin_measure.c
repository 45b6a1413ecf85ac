/* SPDX-License-Identifier: GPL-3.0-or-later
 * Displacement, strain and stress of evaluation points, from nodal values. Where only some nodes have moved
 * since the last measure, only blocks of points with bonds to them are measured anew.
 *
 * Points of the bulk that have the same shape functions, most of those of a lattice, are measured eight at a
 * time (galerkin_runs.c), by the same operations in the same order as one by one: the results have the same
 * bits in both ways. */
#include "galerkin_slices.h"
#include <string.h>

typedef struct {
    galerkin *g;
    int       set;
    const pg_rows *rows;
    const double  *x;
    const size_t  *list;
    const unsigned char *active;                       /* blocks of points to be measured; NULL: all */
} measuring;

/* ---- one by one ---------------------------------------------------------------------------------------- */
PG_WIDE static void strain_points_solid (const measuring *m, size_t first, size_t last)
{
    galerkin *g = m->g;
    for (size_t i = first; i < last; i++) {
        size_t p = m->list ? m->list[i] : i;
        strain_solid (m->rows, p, m->x, g->measured.u[m->set] + 3 * p, g->measured.strain[m->set] + 6 * p);
    }
}

/* Computes displacement and strain at a range of points, or of entries of a list. In 3D in a loop of its own
 * that the compiler can vectorise. */
static void strain_points (const measuring *m, size_t first, size_t last)
{
    galerkin *g = m->g;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    if (dim == 3) strain_points_solid (m, first, last);
    for (size_t i = first; i < last && dim < 3; i++) {
        size_t p = m->list ? m->list[i] : i;
        double *e = g->measured.strain[m->set] + p * nv, *u = g->measured.u[m->set] + p * dim;
        if (dim == 2) strain_flat (2, m->rows, p, m->x, u, e);
        else strain_flat (1, m->rows, p, m->x, u, e);
    }
}

/* Computes the stress at a range of points, or of entries of a list, whose strain is known: for consecutive
 * points of one material in one call. */
static void stress_points (const measuring *m, size_t first, size_t last)
{
    galerkin *g = m->g;
    size_t nv = (size_t) g->nv, at = m->set;
    for (size_t i = first, end; i < last; i = end) {
        size_t p = m->list ? m->list[i] : i;
        double *e = g->measured.strain[at] + p * nv;
        end = i + 1;
        if (g->eigen.strain[at]) {
            galerkin_eigen_stress (g, m->set, p, e);
            continue;
        }
        const pg_material *law = galerkin_plain (g, m->set, p);
        while (!m->list && end < last && galerkin_plain (g, m->set, end) == law) end++;
        law->type->stress (law, end - i, e, g->measured.stress[at] + p * nv, g->measured.zz[at] + p);
    }
}

/* Marks the bounds derived from the stress of a block of points as out of date. */
static void forget_bounds (galerkin *g, int set, size_t block)
{
    if (g->bounds.bounded[set]) g->bounds.bounded[set][block] = 0;
}

static size_t blocks_of (const galerkin *g, int set)
{
    return (g->rows[set].n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
}

/* The rows of shape functions that belong to the points of a set. */
static const pg_rows *rows_of (const galerkin *g, int set)
{
    return set == g->bulk ? &g->sums : &g->rows[set];
}

static int is_active (const measuring *m, size_t block) { return !m->active || m->active[block]; }

static size_t block_end (const galerkin *g, int set, size_t block)
{
    size_t n = g->rows[set].n, end = (block + 1) * GALERKIN_BLOCK;
    return end < n ? end : n;
}

/* Computes stresses of active blocks whose strains are known. */
static void stress_blocks (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        if (!is_active (m, b)) continue;
        stress_points (m, b * GALERKIN_BLOCK, block_end (m->g, m->set, b));
        forget_bounds (m->g, m->set, b);
    }
}

/* Computes strains and stresses of the active ones of some blocks. */
static void measure_blocks (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    for (size_t b = first; b < last; b++) {
        if (is_active (m, b)) strain_points (m, b * GALERKIN_BLOCK, block_end (m->g, m->set, b));
        stress_blocks (context, b, b + 1, thread);
    }
}

/* ---- eight at a time ----------------------------------------------------------------------------------- */
/* Computes strains of those of a range of points that lie in active blocks. */
static void strain_range (const measuring *m, size_t first, size_t last)
{
    for (size_t from = first, end; from < last; from = end) {
        size_t block = from / GALERKIN_BLOCK;
        end = (block + 1) * GALERKIN_BLOCK < last ? (block + 1) * GALERKIN_BLOCK : last;
        if (is_active (m, block)) strain_points (m, from, end);
    }
}

/* Have earlier products K x found runs of points with the same shape functions, in any slice? */
static int knows_runs (const galerkin_slices *s)
{
    int some = 0;
    for (size_t k = 0; s->has_runs && k < SLICES; k++) some |= !s->runs[k].stale && s->runs[k].n > 0;
    return some;
}

/* Computes strains of whole slices, each by one thread: runs that products K x have found, and the points
 * between them. No runs are searched here: with a factored K there are no products, and a search costs more
 * than it saves. */
static void strain_slices (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    galerkin *g = m->g;
    galerkin_slices *s = g->slices;
    (void) thread;
    for (size_t k = first; k < last; k++) {
        size_t at = s->first[k];
        for (size_t i = 0; !s->runs[k].stale && i < s->runs[k].n; i++) {
            const galerkin_run *run = &s->runs[k].run[i];
            if (!run->same) continue;
            strain_range (m, at, run->point);
            galerkin_run_strain (g, run, (const double *const *) s->component, m->active,
                                 g->measured.u[m->set],
                                 g->measured.strain[m->set]);
            at = run->point + run->points * run->count;
        }
        strain_range (m, at, s->first[k + 1]);
    }
}

/* Blocks whose points are to be measured at displacement d: those with bonds to a node that has moved, and
 * those measured at another displacement since (disturbed). NULL: all. */
static const unsigned char *to_measure (galerkin *g, int set, const double *d)
{
    unsigned char *active = g->measured.fresh[set] ? galerkin_active (g, set, d, g->measured.seen[set])
                            : NULL;
    for (size_t b = 0; active && b < blocks_of (g, set); b++) active[b] |= g->measured.disturbed[set][b];
    return active;
}

/* Measures all points of a set, unless they were measured at the same displacement already: balances, fields
 * and criteria need the same one several times a step. */
void galerkin_measure (galerkin *g, int set, const double *d)
{
    size_t bytes = g->n * (size_t) g->dim * sizeof *d, blocks = blocks_of (g, set);
    int whole = g->measured.fresh[set] && !memchr (g->measured.disturbed[set], 1, blocks);
    if (whole && memcmp (g->measured.seen[set], d, bytes) == 0) return;
    const unsigned char *active = to_measure (g, set, d);
    memcpy (g->measured.seen[set], d, bytes);
    measuring m = { g, set, rows_of (g, set), galerkin_widened (g, d), NULL, active };
    if (set == g->bulk && knows_runs (g->slices)) {
        galerkin_split (g, d);
        pg_parallel_heavy (g->threads, SLICES, strain_slices, &m);
        pg_parallel (g->threads, blocks, stress_blocks, &m);
    } else pg_parallel (g->threads, blocks, measure_blocks, &m);
    memset (g->measured.disturbed[set], 0, blocks);
    if (g->dilatation) galerkin_dilatation_measure (g, set, d);
    g->measured.fresh[set] = 1;
}

/* Measures the listed points at the displacement of the last measure, after their shape functions have
 * changed. */
void galerkin_measure_list (galerkin *g, int set, size_t count, const size_t *list)
{
    measuring m = { g, set, rows_of (g, set), galerkin_widened (g, g->measured.seen[set]), list, NULL };
    strain_points (&m, 0, count), stress_points (&m, 0, count);
    for (size_t k = 0; k < count; k++) forget_bounds (g, set, list[k] / GALERKIN_BLOCK);
}

/* Marks blocks whose points were measured at another displacement than the rest. */
static void disturb (galerkin *g, int set, size_t count, const size_t *list)
{
    for (size_t k = 0; k < count; k++) g->measured.disturbed[set][list[k] / GALERKIN_BLOCK] = 1;
}

/* Measures the listed points at a displacement that is given at some nodes only, all those in their
 * families. */
void galerkin_measure_some (galerkin *g, int set, const double *d, size_t count, const size_t *list,
                            size_t nnode, const int *node)
{
    double *x = g->slices->x;
    for (size_t k = 0; g->dim == 3 && k < nnode; k++)
        for (size_t c = 0, i = (size_t) node[k]; c < 3; c++) x[4 * i + c] = d[3 * i + c];
    measuring m = { g, set, rows_of (g, set), g->dim == 3 ? x : d, list, NULL };
    disturb (g, set, count, list);
    strain_points (&m, 0, count), stress_points (&m, 0, count);
}
