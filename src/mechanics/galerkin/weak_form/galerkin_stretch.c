/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds with the largest utilisation where a bond breaks by its elongation alone. First the largest
 * elongation of an intact bond in every block of points is found, without storing values of single bonds.
 * Then only in blocks that reach the overall largest one, or the limit wanted, bonds are judged, with the
 * same bits as if all were judged: elongation is computed here as the criterion does. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

enum { BATCH = GALERKIN_BATCH, PLACE = 8 };
/* NONE: elongation of blocks without intact bonds. hair: tolerance for rounding of a limit. */
static const double NONE = -INFINITY, hair = 1e-12;

/* A search in one set. node: position and displacement of every node, x y z 0 u v w 0, m; square: that of
 * pg_criterion_type.elongation. */
typedef struct {
    galerkin *g;
    const pg_state *state;
    int set;
    double square;
    const double *node;
} looking;

/* Writes position and displacement of a point to `to`, as in looking.node. */
static void put (size_t dim, const double *x, const double *u, double *to)
{
    for (size_t k = 0; k < dim; k++) to[k] = x[k], to[4 + k] = u[k];
}

static void put_nodes (void *context, size_t first, size_t last, int thread)
{
    galerkin *g = context;
    size_t dim = (size_t) g->dim;
    (void) thread;
    for (size_t i = first; i < last; i++)
        put (dim, g->problem->cloud.x + i * dim, g->measured.u[PG_NODES] + i * dim,
             g->bounds.place_now + PLACE * i);
}

#define INLINE static inline __attribute__ ((always_inline))
/* Elongation of a bond (1), with sums in the order of src/mechanics/criterion/stretch.c. */
INLINE double elongation (const double *from, const double *to, double square)
{
    four xi = *(const four *) to - *(const four *) from,
         eta = *(const four *) (to + 4) - *(const four *) (from + 4), rr = xi * xi, re = xi * eta;
    double length = rr[0] + rr[1] + rr[2], e = 2 * ((re[0] + re[1] + re[2]) / length);
    if (!(square > 0)) return e;
    four ee = eta * eta;
    return e + (ee[0] + ee[1] + ee[2]) / length;
}

/* Computes the largest elongation of the intact bonds of each block. */
PG_WIDE static void measure (const looking *w, size_t first, size_t last)
{
    const galerkin *g = w->g;
    const pg_rows *r = &g->rows[w->set];
    const unsigned char *alive = w->state->alive + g->problem->bonds.first[w->set],
                        *judged = g->bounds.judged[w->set];
    size_t dim = (size_t) g->dim;
    for (size_t b = first; b < last; b++) {
        size_t end = (b + 1) * GALERKIN_BLOCK < r->n ? (b + 1) * GALERKIN_BLOCK : r->n;
        double most = NONE;
        for (size_t p = b * GALERKIN_BLOCK; p < end; p++) {
            double own[PLACE] = { 0 };
            if (!pg_problem_owns (g->problem, w->set, p)) continue;
            put (dim, r->x + p * dim, g->measured.u[w->set] + p * dim, own);
            for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
                if (!alive[k] || !judged[k]) continue;
                double e = elongation (own, w->node + PLACE * (size_t) r->family.node[k], w->square);
                most = e > most ? e : most;
            }
        }
        g->bounds.longest[w->set][b] = most;
    }
}

static void measure_blocks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    measure (context, first, last);
}

/* Measures displacements of all points and finds the largest elongation in every block; *most: that of all on
 * this rank. */
static pg_status find_longest (galerkin *g, const pg_state *state, const double *d, double square,
                               double *most)
{
    pg_status status = PG_OK;
    PG_TRY (galerkin_find_judged (g));
    if (!g->bounds.place_now) PG_ALLOC (g->bounds.place_now, PLACE * g->n);
    for (int set = 0; set < PG_BOND_SETS; set++) {
        size_t blocks = (g->rows[set].n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
        if (!g->bounds.longest[set]) PG_ALLOC (g->bounds.longest[set], blocks);
        if (blocks) galerkin_measure (g, set, d);
    }
    pg_parallel (g->threads, g->n, put_nodes, g);
    *most = NONE;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        size_t blocks = (g->rows[set].n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
        looking w = { g, state, set, square, g->bounds.place_now };
        pg_parallel_heavy (g->threads, blocks, measure_blocks, &w);
        for (size_t b = 0; b < blocks; b++) *most = fmax (*most, g->bounds.longest[set][b]);
    }
done:
    return status;
}

/* ---- the bonds that are judged ------------------------------------------------------------------------- */
/* Search for bonds whose elongation (pg_criterion_type.elongation, with `square`) is `least` or more. */
typedef struct {
    galerkin_batch batch;
    double least, square;
} search;

static pg_status search_point (search *s, size_t p)
{
    pg_status status = PG_OK;
    galerkin_batch *b = &s->batch;
    const galerkin *g = b->judge.g;
    int set = b->judge.set;
    const pg_rows *r = &g->rows[set];
    const unsigned char *alive = b->judge.state->alive + g->problem->bonds.first[set],
                        *judged = g->bounds.judged[set];
    size_t dim = (size_t) g->dim;
    double own[PLACE] = { 0 };
    put (dim, r->x + p * dim, g->measured.u[set] + p * dim, own);
    for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
        if (!alive[k] || !judged[k]) continue;
        double e = elongation (own, g->bounds.place_now + PLACE * (size_t) r->family.node[k], s->square);
        if (!(e >= s->least)) continue;
        b->bond[b->count] = k, b->point[b->count++] = p;
        if (b->count == BATCH) PG_TRY (galerkin_judge_batch (b));
    }
done:
    return status;
}

/* Judges all bonds owned by this rank whose elongation is at least s->least, in ascending order. */
static pg_status search_all (search *s)
{
    pg_status status = PG_OK;
    galerkin *g = s->batch.judge.g;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        s->batch.judge.set = set;
        for (size_t p = 0; p < g->rows[set].n; p++)
            if (g->bounds.longest[set][p / GALERKIN_BLOCK] >= s->least
                && pg_problem_owns (g->problem, set, p))
                PG_TRY (search_point (s, p));
        PG_TRY (galerkin_judge_batch (&s->batch));
    }
done:
    return status;
}

pg_status galerkin_longest (galerkin *g, const pg_state *state, const double *d, double from,
                            double *utilisation, char *kind, double *top, pg_changes *over)
{
    pg_status status = PG_OK;
    const pg_criterion *c = g->problem->at.limit;
    search s = { .batch.judge = { g, state, 0, utilisation, NULL, kind } };
    double most = NONE, limit = c->type->elongation (c, from, &s.square);
    PG_TRY (find_longest (g, state, d, s.square, &most));
    s.least = most * (1 - hair);
    if (most > 0) PG_TRY (search_all (&s));
    *top = galerkin_largest (g, s.batch.top);
    if (!(*top > 1)) goto done;
    s.batch.list = over, s.batch.from = from, s.least = limit * (1 - hair);
    if (most >= s.least) PG_TRY (search_all (&s));
done:
    return status;
}
