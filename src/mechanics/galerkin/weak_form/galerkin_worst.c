/* SPDX-License-Identifier: GPL-3.0-or-later
 * The bonds with the largest utilisation, found without judging all: the utilisation of a bond is bounded by
 * those that its two ends would have alone, and these by bounds of the principal stresses that need no angle
 * (pg_principal_bounds). Only bonds that these bounds do not exclude are judged, with the same bits as if
 * all were judged. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

enum { BATCH = GALERKIN_BATCH };
static const double NEVER = -1e300;

/* ---- bounds of points ---------------------------------------------------------------------------------- */
/* Computation of bounds. loose: 1: s1 and s3 are bounds of the principal stresses, where all criteria grow
 * with s1 and -s3; 0: they are exact. */
typedef struct { galerkin *g; int set, loose; const struct envelope *all; } bounding;

/* For many criteria that are linear forms (planes) in (s1, s3): the least and the largest coefficients of
 * each of the n planes; n = 0: there are few criteria, or some are no planes. */
typedef struct envelope { int n; double low[2][2], high[2][2]; } envelope;

enum { FEW = 8 };

static envelope envelope_of (const pg_problem *p)
{
    envelope all = { 0 };
    for (size_t k = 0; p->at.nlimit > FEW && k < p->at.nlimit; k++) {
        const pg_criterion *c = &p->at.limit[k];
        double form[2][2];
        int n = c->type->planes ? c->type->planes (c, form) : 0;
        if (c->never) continue;
        if (n == 0 || (all.n && n != all.n)) return (envelope) { 0 };
        for (int f = 0; f < n; f++)
            for (int i = 0; i < 2; i++)
                all.low[f][i] = all.n ? fmin (all.low[f][i], form[f][i]) : form[f][i],
                all.high[f][i] = all.n ? fmax (all.high[f][i], form[f][i]) : form[f][i];
        all.n = n;
    }
    return all;
}

/* Upper bound of the utilisation by any of the criteria under these principal stresses (Pa). */
static double at_most (const envelope *all, double s1, double s3)
{
    double most = 0;
    for (int f = 0; f < all->n; f++)
        most = fmax (most, fmax (all->low[f][0] * s1, all->high[f][0] * s1)
                               + fmax (all->low[f][1] * s3, all->high[f][1] * s3));
    return most;
}

/* alone[p]: the utilisation if both ends of a bond had the stress of point p, by the criterion with the
 * largest one; -1e300 for points whose bonds never break. */
static void judge_alone (const bounding *c, size_t first, size_t last)
{
    const galerkin *g = c->g;
    const unsigned char *exempt = g->problem->bonds.exempt[c->set];
    double out[GALERKIN_BLOCK], *alone = g->bounds.alone[c->set];
    for (size_t p = first; p < last; p++) alone[p] = exempt[p] ? NEVER : 0;
    if (c->all->n) {
        for (size_t p = first; p < last; p++)
            if (!exempt[p]) alone[p] = at_most (c->all, g->measured.s1[c->set][p], g->measured.s3[c->set][p]);
        return;
    }
    for (size_t k = 0; k < g->problem->at.nlimit; k++) {
        const pg_criterion *law = &g->problem->at.limit[k];
        pg_bond_measures m = { .n = last - first, .dim = g->dim, .s1 = g->measured.s1[c->set] + first,
            .s2 = g->measured.s2[c->set] + first, .s3 = g->measured.s3[c->set] + first };
        law->type->utilisation (law, &m, out, NULL);
        for (size_t i = 0; i < m.n; i++)
            if (!exempt[first + i] && out[i] > alone[first + i]) alone[first + i] = out[i];
    }
}

/* Computes the bounds of blocks of points that have been measured since the last time. */
static void bound_blocks (void *context, size_t first, size_t last, int thread)
{
    const bounding *c = context;
    galerkin *g = c->g;
    size_t n = g->rows[c->set].n;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        size_t p = b * GALERKIN_BLOCK, end = p + GALERKIN_BLOCK < n ? p + GALERKIN_BLOCK : n;
        if (g->bounds.bounded[c->set][b]) continue;
        g->bounds.bounded[c->set][b] = 1;
        memset (g->bounds.exact[c->set] + p, !c->loose, end - p);
        if (c->loose)
            pg_principal_bounds (g->dim, end - p, g->measured.stress[c->set] + p * (size_t) g->nv,
                                 g->measured.zz[c->set] + p,
                                 g->measured.s1[c->set] + p, g->measured.s3[c->set] + p);
        else for (size_t i = p; i < end; i++) galerkin_principal (g, c->set, i);
        judge_alone (c, p, end);
    }
}

/* Does the utilisation of all criteria grow with the largest and with minus the smallest principal stress? */
static int all_grow (const galerkin *g)
{
    int grow = 1;
    for (size_t k = 0; k < g->problem->at.nlimit && grow; k++) {
        const pg_criterion *law = &g->problem->at.limit[k];
        double form[2][2];
        int n = law->type->planes ? law->type->planes (law, form) : 0;
        grow = n > 0;
        for (int i = 0; i < n; i++) grow &= form[i][0] >= 0 && form[i][1] <= 0;
    }
    return grow;
}

/* Computes the bounds of all points of all sets by the stress at displacement d. */
static pg_status find_bounds (galerkin *g, const double *d)
{
    galerkin_bounds *b = &g->bounds;
    pg_status status = PG_OK;
    int loose = g->dim == 3 && all_grow (g);
    envelope all = envelope_of (g->problem);
    for (int set = 0; set < PG_BOND_SETS; set++) {
        size_t n = g->rows[set].n, blocks = (n + GALERKIN_BLOCK - 1) / GALERKIN_BLOCK;
        if (!b->alone[set]) PG_ALLOC (b->alone[set], n);
        if (!b->exact[set]) PG_ALLOC (b->exact[set], n);
        if (!b->bounded[set]) PG_ALLOC (b->bounded[set], blocks);
        if (n) galerkin_measure (g, set, d);
        bounding c = { g, set, loose, &all };
        pg_parallel (g->threads, blocks, bound_blocks, &c);
    }
done:
    return status;
}

/* ---- the worst bonds ----------------------------------------------------------------------------------- */
double galerkin_largest (const galerkin *g, double mine)
{
    if (pg_cloud_most (&g->problem->cloud, 1, &mine) != PG_OK) return NAN;
    return mine;
}

/* A search among bonds. Utilisation by stress is the largest of some linear functions of the mean (s1, s3) of
 * both ends, so that it is at most the mean of what the ends would have alone: only bonds are judged for
 * which this bound reaches `least`. */
typedef struct {
    galerkin_batch batch;                              /* its list collects bonds with at least `least` */
    double  top_node;                                  /* the largest `alone` of a node */
    double  least;
} search;

/* Computes the exact principal stresses of a point where only bounds are known. */
static void make_exact (galerkin *g, int set, size_t p)
{
    if (g->bounds.exact[set][p]) return;
    galerkin_principal (g, set, p);
    g->bounds.exact[set][p] = 1;
}

pg_status galerkin_judge_batch (galerkin_batch *b)
{
    pg_status status = PG_OK;
    size_t base = b->judge.g->problem->bonds.first[b->judge.set], to[BATCH];
    double *u = b->judge.utilisation;
    for (size_t k = 0; k < b->count; k++) to[k] = base + b->bond[k], u[to[k]] = 0;
    if (b->count) galerkin_judge (&b->judge, b->count, b->bond, b->point, to);
    for (size_t k = 0; k < b->count; k++) {
        b->top = fmax (b->top, u[to[k]]);
        if (!b->list || !(u[to[k]] >= b->from)) continue;
        PG_GROW (b->list->bond, b->list->cap, b->list->n + 1);
        b->list->bond[b->list->n++] = to[k];
    }
done:
    b->count = 0;
    return status;
}

/* Judges the collected bonds. Without a list `least` is raised to the largest utilisation so far. */
static pg_status judge_collected (search *s)
{
    pg_status status = PG_OK;
    galerkin_batch *b = &s->batch;
    galerkin *g = b->judge.g;
    const int *node = g->rows[b->judge.set].family.node;
    for (size_t k = 0; k < b->count; k++) {
        make_exact (g, b->judge.set, b->point[k]);
        make_exact (g, PG_NODES, (size_t) node[b->bond[k]]);
    }
    b->from = s->least;
    PG_TRY (galerkin_judge_batch (b));
    if (!b->list) s->least = b->top;
done:
    return status;
}

/* Can a bond with the bounds `one` and `other` at its ends reach `least`, with a tolerance for rounding? */
static int may (const search *s, double one, double other)
{
    return 0.5 * (one + other) >= s->least * (1 - 1e-12);
}

/* Judges the intact bonds of a point that may reach `least`, in batches. */
static pg_status search_point (search *s, size_t p)
{
    pg_status status = PG_OK;
    galerkin_batch *b = &s->batch;
    const galerkin *g = b->judge.g;
    int set = b->judge.set;
    const pg_family *f = &g->rows[set].family;
    const unsigned char *alive = b->judge.state->alive + g->problem->bonds.first[set];
    for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
        double other = g->bounds.alone[PG_NODES][f->node[e]];
        if (!alive[e] || !may (s, g->bounds.alone[set][p], other)
            || pg_problem_no_bond (g->problem, set, p, e))
            continue;
        b->bond[b->count] = e, b->point[b->count++] = p;
        if (b->count == BATCH) PG_TRY (judge_collected (s));
    }
done:
    return status;
}

/* Judges all owned bonds of all sets that may reach `least`, in ascending order. */
static pg_status search_all (search *s)
{
    pg_status status = PG_OK;
    galerkin *g = s->batch.judge.g;
    for (s->batch.judge.set = 0; s->batch.judge.set < PG_BOND_SETS; s->batch.judge.set++) {
        const double *alone = g->bounds.alone[s->batch.judge.set];
        for (size_t p = 0; p < g->rows[s->batch.judge.set].n; p++)
            if (may (s, alone[p], s->top_node) && pg_problem_owns (g->problem, s->batch.judge.set, p))
                PG_TRY (search_point (s, p));
        PG_TRY (judge_collected (s));
    }
done:
    return status;
}

/* Finds a lower bound of the largest utilisation: that of the bonds of the point with the largest `alone` in
 * each set. */
static pg_status search_first (search *s)
{
    pg_status status = PG_OK;
    galerkin *g = s->batch.judge.g;
    for (s->batch.judge.set = 0; s->batch.judge.set < PG_BOND_SETS; s->batch.judge.set++) {
        const double *alone = g->bounds.alone[s->batch.judge.set];
        size_t n = g->rows[s->batch.judge.set].n, worst = n;
        for (size_t p = 0; p < n; p++)
            if (pg_problem_owns (g->problem, s->batch.judge.set, p)
                && (worst == n || alone[p] > alone[worst]))
                worst = p;
        if (worst < n) PG_TRY (search_point (s, worst));
        PG_TRY (judge_collected (s));
    }
done:
    return status;
}

/* *top: the largest utilisation of an intact bond. If it is above 1, `over` lists all bonds from `from` on,
 * ascending, with utilisation and kind at their positions in the two arrays (others are undefined). Same
 * numbers as galerkin_utilisation, for the few bonds that matter. */
pg_status galerkin_worst (galerkin *g, const pg_state *state, const double *d, double from,
                          double *utilisation, char *kind, double *top, pg_changes *over)
{
    pg_status status = PG_OK;
    search s = { .batch.judge = { g, state, 0, utilisation, NULL, kind }, .top_node = NEVER };
    int plain = g->problem->plain;
    over->n = 0;
    if (!plain && pg_problem_breaks_by_elongation (g->problem))
        return galerkin_longest (g, state, d, from, utilisation, kind, top, over);
    if (plain || g->problem->criterion->type->needs != PG_NEEDS_STRESS) {
        PG_TRY (galerkin_utilisation (g, state, d, utilisation, kind, NULL));
        return pg_worst_bonds (g->problem, state, utilisation, from, top, over);
    }
    PG_TRY (find_bounds (g, d));
    for (size_t i = 0; i < g->n; i++) s.top_node = fmax (s.top_node, g->bounds.alone[PG_NODES][i]);
    PG_TRY (search_first (&s));
    s.least = s.batch.top = galerkin_largest (g, s.batch.top);
    PG_TRY (search_all (&s));
    *top = galerkin_largest (g, s.batch.top);
    if (!(s.batch.top > 1)) goto done;
    s.batch.list = over, s.least = from;
    PG_TRY (search_all (&s));
done:
    return status;
}

