/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which of many cracks does a bond meet? Only the cracks whose boxes the bond meets are tested; the answers
 * are the same as if every crack were tested in turn.
 *
 * The cracks are put in an order in which neighbours lie near each other, PG_CRACK_GROUP at a time in a
 * block, as many blocks in a larger one, and so on up to one block that holds all. Block b of level l holds
 * positions b s to (b + 1) s - 1 of the order, s = PG_CRACK_GROUP^(l + 1); the boxes of the levels follow
 * each other in `block`. */
#include "perigal/cloud.h"
#include "geometry/cloud/search/tree.h"
#include <math.h>
#include <string.h>

enum { LEVELS = 22 };                                  /* 8^22 cracks are more than there can be */

/* ---- boxes of cracks ----------------------------------------------------------------------------------- */
/* Box of a segment, lengthened by negative retreats, beyond its ends, m. */
static void box_of_segment (const pg_crack *c, double *low, double *high)
{
    const double *p = c->vertex, t[2] = { c->normal[1], -c->normal[0] };
    double over[2] = { c->retreat ? fmax (0, -c->retreat[0]) : 0, c->retreat ? fmax (0, -c->retreat[1]) : 0 };
    for (int k = 0; k < 2; k++) {
        double a = p[k] - over[0] * t[k], b = p[2 + k] + over[1] * t[k];
        low[k] = fmin (fmin (a, b), fmin (p[k], p[2 + k]));
        high[k] = fmax (fmax (a, b), fmax (p[k], p[2 + k]));
    }
}

/* Box of a disc: it extends radius * sqrt (1 - n_k^2) along axis k. */
static void box_of_disc (const pg_crack *c, double *low, double *high)
{
    for (int k = 0; k < 3; k++) {
        double reach = c->radius * sqrt (fmax (0, 1 - c->normal[k] * c->normal[k]));
        low[k] = c->centre[k] - reach, high[k] = c->centre[k] + reach;
    }
}

/* Box of a polygon in 3D, or an outline in 2D. */
static void box_of_polygon (const pg_crack *c, int dim, double *low, double *high)
{
    for (int k = 0; k < dim; k++) {
        low[k] = high[k] = c->vertex[k];
        for (size_t i = 1; i < c->nvertex; i++)
            low[k] = fmin (low[k], c->vertex[(size_t) dim * i + (size_t) k]),
            high[k] = fmax (high[k], c->vertex[(size_t) dim * i + (size_t) k]);
    }
}

/* The box is widened by a slack for rounding, of a disc in proportion to its size. */
void pg_crack_box (const pg_crack *c, int dim, double *box)
{
    double *low = box, *high = box + dim;
    if (c->kind == PG_CRACK_SEGMENT) box_of_segment (c, low, high);
    else if (c->kind == PG_CRACK_DISC) box_of_disc (c, low, high);
    else box_of_polygon (c, dim, low, high);
    for (int k = 0; k < dim; k++) {
        double slack = (c->sided ? c->width : 0) + 1e-12 * (fabs (low[k]) + fabs (high[k]) + c->radius);
        low[k] -= slack, high[k] += slack;
    }
}

/* Do two boxes (low and high corners) overlap? */
static int overlap (int dim, const double *a, const double *b)
{
    for (int k = 0; k < dim; k++) if (!(a[k] <= b[dim + k] && b[k] <= a[dim + k])) return 0;
    return 1;
}

/* ---- sorting the cracks -------------------------------------------------------------------------------- */
void pg_cracks_clear_index (pg_cracks *c)
{
    pg_free (c->box), pg_free (c->block), pg_free (c->order);
    c->box = c->block = NULL, c->order = NULL, c->room = 0;
}

/* Makes room for n cracks and for as many again, so that lists may grow. */
static pg_status reserve (pg_cracks *c, size_t n)
{
    pg_status status = PG_OK;
    size_t wide = 2 * (size_t) c->dim, most = 2*n;
    if (n <= c->room) return PG_OK;
    pg_cracks_clear_index (c);
    PG_ALLOC (c->box, wide * most);
    PG_ALLOC (c->block, wide * most);
    PG_ALLOC (c->order, most);
    c->room = most;
done:
    if (status != PG_OK) pg_cracks_clear_index (c);
    return status;
}

/* Fills c->order: the cracks in the order that a k-d tree gives the centres of their boxes. */
static pg_status sort (pg_cracks *c)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim;
    pg_tree tree = { 0 };
    double *centre = NULL;
    PG_ALLOC (centre, dim * c->n);
    for (size_t i = 0; i < c->n; i++)
        for (size_t k = 0; k < dim; k++)
            centre[dim * i + k] = 0.5 * c->box[2 * dim * i + k] + 0.5 * c->box[2 * dim * i + dim + k];
    PG_TRY (pg_tree_build (&tree, c->dim, c->n, centre));
    memcpy (c->order, tree.item, c->n * sizeof *c->order);
done:
    pg_tree_clear (&tree);
    pg_free (centre);
    return status;
}

/* The first block of each level in `block`; returns the number of levels. */
static int levels_of (const pg_cracks *c, size_t *start)
{
    size_t n = c->n;
    int level = 0;
    start[0] = 0;
    do {
        n = (n + PG_CRACK_GROUP - 1) / PG_CRACK_GROUP;
        start[level + 1] = start[level] + n;
        level++;
    } while (n > 1);
    return level;
}

/* Widens a box so that it holds another; first 1: sets it to the other. */
static void unite (int dim, double *box, const double *other, int first)
{
    for (int k = 0; k < dim; k++) {
        box[k] = first ? other[k] : fmin (box[k], other[k]);
        box[dim + k] = first ? other[dim + k] : fmax (box[dim + k], other[dim + k]);
    }
}

pg_status pg_cracks_index (pg_cracks *c)
{
    pg_status status = PG_OK;
    size_t start[LEVELS + 1], wide = 2 * (size_t) c->dim;
    if (c->n == 0) return PG_OK;
    PG_TRY (reserve (c, c->n));
    for (size_t k = 0; k < c->n; k++) pg_crack_box (&c->crack[k], c->dim, c->box + wide * k);
    PG_TRY (sort (c));
    int levels = levels_of (c, start);
    for (int l = 0; l < levels; l++) {
        size_t n = l ? start[l] - start[l - 1] : c->n;
        for (size_t k = 0; k < n; k++)
            unite (c->dim, c->block + wide * (start[l] + k / PG_CRACK_GROUP),
                   l ? c->block + wide * (start[l - 1] + k) : c->box + wide * c->order[k],
                   k % PG_CRACK_GROUP == 0);
    }
done:
    if (status != PG_OK) pg_cracks_clear_index (c);
    return status;
}

pg_status pg_cracks_copy_index (pg_cracks *to, const pg_cracks *from)
{
    pg_status status = PG_OK;
    size_t wide = 2 * (size_t) from->dim;
    if (!from->block) pg_cracks_clear_index (to);
    if (!from->block || from->n == 0) return PG_OK;
    PG_TRY (reserve (to, from->n));
    memcpy (to->box, from->box, wide * from->n * sizeof *to->box);
    memcpy (to->block, from->block, wide * from->n * sizeof *to->block);
    memcpy (to->order, from->order, from->n * sizeof *to->order);
done:
    return status;
}

/* ---- queries ------------------------------------------------------------------------------------------- */
/* A test of one crack against a bond x - y, or with y = x a point. NULL: only whether the boxes meet. */
typedef int (*question) (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance);
typedef struct {
    const pg_cracks *cracks;
    question ask;
    const double *x, *y;
    double tolerance, box[6];
    /* found: the first crack for which the test is true; n: none */
    size_t start[LEVELS + 1], found;
} inquiry;

static int meets (const inquiry *q, size_t crack)
{
    const pg_cracks *c = q->cracks;
    if (!overlap (c->dim, c->box + 2 * (size_t) c->dim * crack, q->box)) return 0;
    return !q->ask || q->ask (&c->crack[crack], c->dim, q->x, q->y, q->tolerance);
}

/* Searches block b of a level; only cracks before the one found so far are tested. */
static void look (inquiry *q, int level, size_t b)
{
    const pg_cracks *c = q->cracks;
    size_t n = level ? q->start[level] - q->start[level - 1] : c->n;
    if (!overlap (c->dim, c->block + 2 * (size_t) c->dim * (q->start[level] + b), q->box)) return;
    for (size_t k = b * PG_CRACK_GROUP; k < (b + 1) * PG_CRACK_GROUP && k < n; k++) {
        if (level) look (q, level - 1, k);
        else if (c->order[k] < q->found && meets (q, c->order[k])) q->found = c->order[k];
    }
}

/* Returns the first crack in the order of the input file for which `ask` is true, so that the answer does not
 * depend on the blocks. */
static const pg_crack *first_of (const pg_cracks *c, question ask, const double *x, const double *y,
                                 double tolerance)
{
    if (!c->block) {
        for (size_t k = 0; k < c->n; k++)
            if (ask (&c->crack[k], c->dim, x, y, tolerance)) return &c->crack[k];
        return NULL;
    }
    if (c->n == 0) return NULL;
    inquiry q = { .cracks = c, .ask = ask, .x = x, .y = y, .tolerance = tolerance, .found = c->n };
    /* the box is wider than the tolerance against rounding */
    for (int k = 0; k < c->dim; k++)
        q.box[k] = fmin (x[k], y[k]) - 2 * tolerance, q.box[c->dim + k] = fmax (x[k], y[k]) + 2 * tolerance;
    look (&q, levels_of (c, q.start) - 1, 0);
    return q.found < c->n ? &c->crack[q.found] : NULL;
}

static int touches (const pg_crack *crack, int dim, const double *x, const double *y, double tolerance)
{
    (void) y;
    return pg_crack_touches (crack, dim, x, tolerance);
}

const pg_crack *pg_cracks_cut (const pg_cracks *cracks, const double *x, const double *y,
                               double tolerance)
{
    return first_of (cracks, pg_crack_cuts, x, y, tolerance);
}

const pg_crack *pg_cracks_touch (const pg_cracks *cracks, const double *x, double tolerance)
{
    return first_of (cracks, touches, x, x, tolerance);
}

int pg_cracks_near (const pg_cracks *c, const double *low, const double *high)
{
    if (c->n == 0 || !c->block) return c->n > 0;
    inquiry q = { .cracks = c, .found = c->n };
    memcpy (q.box, low, (size_t) c->dim * sizeof *low);
    memcpy (q.box + c->dim, high, (size_t) c->dim * sizeof *high);
    look (&q, levels_of (c, q.start) - 1, 0);
    return q.found < c->n;
}
