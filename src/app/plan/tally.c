/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sizes of a body on its lattice without building it: cells, points and open faces exactly; bonds from
 * stencils (the sites within the horizon of a node or a Gauss point), exactly for small bodies, else on an
 * even sample; likewise the pairs of nodes that share an evaluation point. */
#include "forecast.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double most_visits = 1e7;                 /* sites: a few hundredths of a second */

/* Sites within the horizon as steps (x, y, z) from the node or the cell, and again as rows along x: (y, z) of
 * each row, and a bit for each of its sites in `words` 64-bit words, the first bit for the smallest step of
 * all stencils. */
typedef struct { size_t n; int (*step)[3]; size_t nrow; int (*row)[2]; uint64_t *bits; } stencil;

typedef struct {
    const pg_counting *how;
    const pg_lattice *l;
    int     size[3];                                   /* sites per axis */
    size_t  nsite, ncell;
    unsigned char *site;                               /* 1: a point stands there */
    stencil node, *gauss;  size_t ngauss;
    /* largest step between two nodes of a pair; 2 span + 1 */
    int     span[3], wide[3];
    size_t  words;                                     /* 64-bit words of a row of `mark` */
    uint64_t *mark;                                    /* marked sites in a box about a node, a bit each */
} counter;

static void stencil_clear (stencil *s) { pg_free (s->step), pg_free (s->row), pg_free (s->bits); }

/* Frees what a counter holds, also one that was filled in part only. */
static void counter_clear (counter *c)
{
    pg_free (c->site), pg_free (c->mark);
    stencil_clear (&c->node);
    for (size_t g = 0; c->gauss && g < c->ngauss; g++) stencil_clear (&c->gauss[g]);
    pg_free (c->gauss);
}

/* Is the lattice cell (a, b, c) part of the body? Beyond the lattice there is none. */
static int kept (const pg_lattice *l, int a, int b, int c)
{
    if (a < 0 || b < 0 || c < 0 || a >= l->count[0] || b >= l->count[1] || c >= l->count[2]) return 0;
    return l->in[((size_t) c * (size_t) l->count[1] + (size_t) b) * (size_t) l->count[0] + (size_t) a];
}

/* Number of a site, x fastest. */
static size_t site_at (const counter *c, int x, int y, int z)
{
    return ((size_t) z * (size_t) c->size[1] + (size_t) y) * (size_t) c->size[0] + (size_t) x;
}

/* 1: there is a point at site `at` plus `step`. */
static int is_point (const counter *c, const int *at, const int *step)
{
    int x = at[0] + step[0], y = at[1] + step[1], z = at[2] + step[2];
    if (x < 0 || y < 0 || z < 0 || x >= c->size[0] || y >= c->size[1] || z >= c->size[2]) return 0;
    return c->site[site_at (c, x, y, z)];
}

/* 1: the centre of open face f (-x +x -y +y -z +z) of a cell is not on the surface of the body, so that the
 * surface runs through a cell there. A plane crosses as many cells as there are such faces, whatever its
 * direction, so that counting these faces counts cut cells. */
static int off_surface (const counter *c, int x, int y, int z, int f)
{
    const pg_lattice *l = c->l;
    double at[3] = { x + 0.5, y + 0.5, z + 0.5 }, place[3] = { 0, 0, 0 }, away;
    at[f / 2] += f % 2 ? 0.5 : -0.5;
    for (int k = 0; k < l->dim; k++) place[k] = pg_lattice_at (l, k, at[k]);
    size_t shape = pg_body_nearest (c->how->body, place, &away);
    return !pg_shape_meshed (&c->how->body->shape[shape]) && away > 1e-6 * l->step[f / 2];
}

/* Counts the open faces of a cell, and those whose centre is not on the true surface. */
static void count_faces (const counter *c, pg_tally *t, int x, int y, int z)
{
    for (int f = 0; f < 2 * c->l->dim; f++) {
        int step = f % 2 ? 1 : -1;
        if (kept (c->l, x + (f / 2 == 0 ? step : 0), y + (f / 2 == 1 ? step : 0),
                  z + (f / 2 == 2 ? step : 0)))
            continue;
        t->open[f]++;
        t->crossed += c->how->body && off_surface (c, x, y, z, f);
    }
}

/* Counts cells and open faces, and marks the sites that are points. */
static pg_status count_sites (counter *c, pg_tally *t)
{
    pg_status status = PG_OK;
    const pg_lattice *l = c->l;
    int far[3];
    for (int k = 0; k < 3; k++) far[k] = !c->how->centred && k < l->dim, c->size[k] = l->count[k] + far[k];
    c->nsite = (size_t) c->size[0] * (size_t) c->size[1] * (size_t) c->size[2];
    PG_ALLOC (c->site, c->nsite);
    for (int z = 0; z < l->count[2]; z++)
        for (int y = 0; y < l->count[1]; y++)
            for (int x = 0; x < l->count[0]; x++) {
                if (!kept (l, x, y, z)) continue;
                c->ncell++;
                count_faces (c, t, x, y, z);
                for (int k = 0; k < 8; k++)
                    c->site[site_at (c, x + (k & far[0]), y + (k >> 1 & far[1]), z + (k >> 2 & far[2]))] = 1;
            }
    t->cells = (double) c->ncell;
    for (size_t i = 0; i < c->nsite; i++) t->points += c->site[i];
done:
    return status;
}

/* ---- stencils ------------------------------------------------------------------------------------------ */
/* Sites within the horizon of `at` (lattice steps from site 0). */
static pg_status make_stencil (stencil *out, const counter *c, const double *at)
{
    pg_status status = PG_OK;
    const pg_approx *a = c->how->approx;
    double far = a->horizon * (a->kernel->closed ? 1 + 1e-9 : 1 - 1e-9);
    int reach[3] = { 0, 0, 0 };
    size_t cap = 0;
    for (int k = 0; k < c->l->dim; k++) reach[k] = (int) ceil (a->horizon / c->l->step[k]) + 1;
    for (int z = -reach[2]; z <= reach[2]; z++)
        for (int y = -reach[1]; y <= reach[1]; y++)
            for (int x = -reach[0]; x <= reach[0]; x++) {
                int step[3] = { x, y, z };
                double r = 0;
                for (int k = 0; k < c->l->dim; k++) {
                    double d = fabs ((step[k] - at[k]) * c->l->step[k]);
                    r = a->shape == PG_TENSOR ? fmax (r, d) : r + d * d;
                }
                if (a->shape != PG_TENSOR) r = sqrt (r);
                if (a->kernel->closed ? r > far : r >= far) continue;
                PG_GROW (out->step, cap, out->n + 1);
                memcpy (out->step[out->n++], step, sizeof step);
            }
done:
    return status;
}

/* Copies the bonds of peridynamic forces, which have been built already. */
static pg_status copy_stencil (stencil *out, const pg_stencil *from)
{
    pg_status status = PG_OK;
    PG_ALLOC (out->step, from->n);
    for (size_t b = 0; b < from->n; b++) memcpy (out->step[b], from->offset + 3 * b, sizeof out->step[b]);
    out->n = from->n;
done:
    return status;
}

/* Makes the stencils of a node and of every Gauss point of a cell: the sites within its horizon, equal in all
 * cells. */
static pg_status make_stencils (counter *c)
{
    pg_status status = PG_OK;
    double x[5], w[5], at[3] = { 0, 0, 0 };
    int order = c->how->order;
    if (c->how->bonds) PG_TRY (copy_stencil (&c->node, c->how->bonds));
    else PG_TRY (make_stencil (&c->node, c, at));
    c->ngauss = c->how->nodal ? 0 : 1;
    for (int k = 0; k < c->l->dim; k++) c->ngauss *= (size_t) order;
    PG_ALLOC (c->gauss, c->ngauss);
    pg_gauss_rule (order, x, w);
    for (size_t g = 0; g < c->ngauss; g++) {
        size_t rest = g;
        for (int k = 0; k < c->l->dim; k++, rest /= (size_t) order)
            at[k] = (1 + x[rest % (size_t) order]) / 2 - (c->how->centred ? 0.5 : 0);
        PG_TRY (make_stencil (&c->gauss[g], c, at));
    }
done:
    return status;
}

/* Number of points at the sites of stencil `s` about site `at`. */
static size_t seen (const counter *c, const int *at, const stencil *s)
{
    size_t n = 0;
    for (size_t k = 0; k < s->n; k++) n += (size_t) is_point (c, at, s->step[k]);
    return n;
}

/* ---- pairs --------------------------------------------------------------------------------------------- */
/* Marks, in the box of marks about a node, the sites of stencil `s` centred `from` steps away from the node,
 * row by row. */
static void mark_seen (counter *c, const int *from, const stencil *s)
{
    size_t shift = (size_t) (c->span[0] / 2 + from[0]), whole = shift / 64, part = shift % 64;
    for (size_t k = 0; k < s->nrow; k++) {
        size_t y = (size_t) (from[1] + s->row[k][0] + c->span[1]),
               z = (size_t) (from[2] + s->row[k][1] + c->span[2]);
        uint64_t *m = c->mark + (z * (size_t) c->wide[1] + y) * c->words + whole;
        const uint64_t *bits = s->bits + k * c->words;
        if (c->words == 1) {
            *m |= *bits << part;
            continue;
        }
        for (size_t w = 0; w + whole < c->words; w++) {
            m[w] |= bits[w] << part;
            if (part && w + whole + 1 < c->words) m[w + 1] |= bits[w] >> (64 - part);
        }
    }
}

/* Number of marked sites that are points. */
static size_t count_marks (const counter *c, const int *node)
{
    size_t n = 0, rows = (size_t) c->wide[1] * (size_t) c->wide[2];
    for (size_t k = 0; k < rows * c->words; k++)
        for (uint64_t word = c->mark[k]; word; word &= word - 1) {
            size_t row = k / c->words, x = 64 * (k % c->words) + (size_t) __builtin_ctzll (word);
            int step[3] = { (int) x - c->span[0], (int) (row % (size_t) c->wide[1]) - c->span[1],
                            (int) (row / (size_t) c->wide[1]) - c->span[2] };
            n += (size_t) is_point (c, node, step);
        }
    return n;
}

/* Nodes that share a point of evaluation with the node, itself included: entries of its row of K, in
 * nodes. */
static size_t coupled (counter *c, const int *node)
{
    if (c->how->bonds) return seen (c, node, &c->node) + 1;
    memset (c->mark, 0, c->words * (size_t) c->wide[1] * (size_t) c->wide[2] * sizeof *c->mark);
    for (size_t g = 0; g < c->ngauss; g++)
        for (size_t k = 0; k < c->gauss[g].n; k++) {
            const int *s = c->gauss[g].step[k], back[3] = { -s[0], -s[1], -s[2] };
            if (kept (c->l, node[0] - s[0], node[1] - s[1], node[2] - s[2]))
                mark_seen (c, back, &c->gauss[g]);
        }
    for (size_t k = 0; c->how->nodal && k < c->node.n; k++)
        if (is_point (c, node, c->node.step[k])) mark_seen (c, c->node.step[k], &c->node);
    return count_marks (c, node);
}

/* Makes the rows and bits of a stencil, whose steps are sorted row by row. */
static pg_status make_rows (const counter *c, stencil *s)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->row, s->n);
    PG_ALLOC (s->bits, s->n * c->words);
    for (size_t k = 0; k < s->n; k++) {
        const int *step = s->step[k];
        if (k == 0 || step[1] != s->step[k - 1][1] || step[2] != s->step[k - 1][2])
            s->row[s->nrow][0] = step[1], s->row[s->nrow][1] = step[2], s->nrow++;
        size_t bit = (size_t) (step[0] + c->span[0] / 2);
        s->bits[(s->nrow - 1) * c->words + bit / 64] |= (uint64_t) 1 << bit % 64;
    }
done:
    return status;
}

/* Allocates the box of marks, twice as far as any stencil reaches: two nodes in the stencil of one point are
 * at most so far apart. */
static pg_status make_marks (counter *c)
{
    pg_status status = PG_OK;
    for (size_t g = 0; g <= c->ngauss; g++) {
        const stencil *s = g < c->ngauss ? &c->gauss[g] : &c->node;
        for (size_t k = 0; k < s->n; k++)
            for (int i = 0; i < 3; i++)
                if (abs (s->step[k][i]) > c->span[i]) c->span[i] = abs (s->step[k][i]);
    }
    for (int i = 0; i < 3; i++) c->span[i] *= 2, c->wide[i] = 2 * c->span[i] + 1;
    c->words = ((size_t) c->wide[0] + 63) / 64;
    PG_ALLOC (c->mark, c->words * (size_t) c->wide[1] * (size_t) c->wide[2]);
    PG_TRY (make_rows (c, &c->node));
    for (size_t g = 0; g < c->ngauss; g++) PG_TRY (make_rows (c, &c->gauss[g]));
done:
    return status;
}

/* ---- the sample ---------------------------------------------------------------------------------------- */
/* 1: item i belongs to the sample: one of every `stride` items, at a position that changes from stride to
 * stride (a multiplicative hash), so that no row or column of the lattice is met more often than others. */
static int chosen (size_t i, size_t stride)
{
    return i % stride == (size_t) (i / stride * 2654435761u) % stride;
}

/* Stride of a sample that visits about most_visits sites, and at least 64 items in any case. */
static size_t stride_for (double items, double visits_each)
{
    return (size_t) fmax (1, fmin (ceil (items * visits_each / most_visits), floor (items / 64)));
}

/* Counts bonds of nodes, and pairs of nodes that share an evaluation point (each pair once, a node with
 * itself included), on an even sample where there are many. */
static void count_nodes (counter *c, pg_tally *t)
{
    double work = c->how->bonds  ? (double) c->node.n
                  : c->how->nodal ? (double) c->node.n * (double) c->node.nrow
                                  : 0,
           bonds = 0, pairs = 0;
    for (size_t g = 0; g < c->ngauss; g++) work += (double) c->gauss[g].n * (double) c->gauss[g].nrow;
    size_t stride = stride_for (t->points, (double) c->node.n), pair_stride = stride_for (t->points, work),
           i = 0, nbond = 0, npair = 0;
    int at[3];
    for (at[2] = 0; at[2] < c->size[2]; at[2]++)
        for (at[1] = 0; at[1] < c->size[1]; at[1]++)
            for (at[0] = 0; at[0] < c->size[0]; at[0]++) {
                if (!c->site[site_at (c, at[0], at[1], at[2])]) continue;
                if (chosen (i, stride)) bonds += (double) seen (c, at, &c->node), nbond++;
                if (chosen (i, pair_stride)) {
                    double n = (double) coupled (c, at);
                    pairs += n, npair++;
                    t->coupled = fmax (t->coupled, n);
                }
                i++;
            }
    t->sampled |= stride > 1 || pair_stride > 1;
    t->node_bonds = nbond ? bonds * (t->points / (double) nbond) : 0;
    t->pairs = npair ? 0.5 * (pairs * (t->points / (double) npair) + t->points) : 0;
}

/* Counts bonds of evaluation points, on an even sample where there are many. */
static void count_gauss (counter *c, pg_tally *t)
{
    double work = 0, bonds = 0;
    for (size_t g = 0; g < c->ngauss; g++) work += (double) c->gauss[g].n;
    size_t stride = stride_for (t->cells, work), i = 0, n = 0;
    int at[3];
    for (at[2] = 0; at[2] < c->l->count[2]; at[2]++)
        for (at[1] = 0; at[1] < c->l->count[1]; at[1]++)
            for (at[0] = 0; at[0] < c->l->count[0]; at[0]++) {
                if (!kept (c->l, at[0], at[1], at[2])) continue;
                if (!chosen (i++, stride)) continue;
                for (size_t g = 0; g < c->ngauss; g++) bonds += (double) seen (c, at, &c->gauss[g]);
                n++;
            }
    t->sampled |= stride > 1;
    t->evaluation = t->cells * (double) c->ngauss;
    t->point_bonds = n ? bonds * (t->cells / (double) n) : 0;
}

/* If the horizon is so large that stencils would be large, estimates the counts as inside an infinite body,
 * at most all points, and returns 1. Such a run is refused for its memory in any case. */
static int wide_open (const counter *c, pg_tally *t)
{
    const pg_approx *a = c->how->approx;
    double box = 1,
           ball = a->shape == PG_TENSOR ? 1
                  : c->l->dim == 3      ? 0.5236
                  : c->l->dim == 2      ? 0.7854
                                        : 1,
           points = 1;
    for (int k = 0; k < c->l->dim; k++) box *= 2 * a->horizon / c->l->step[k] + 3, points *= c->how->order;
    if (box < 2e5) return 0;
    double each = fmin (t->points, ball * box);
    t->evaluation = c->how->nodal ? 0 : points * t->cells;
    t->node_bonds = t->points * each, t->point_bonds = t->evaluation * each;
    t->coupled = fmin (t->points, ball * box * (c->how->bonds ? 1 : 1 << c->l->dim));
    t->pairs = 0.5 * t->points * (t->coupled + 1);
    t->sampled = 1;
    return 1;
}

/* Counts on the lattice `how->lattice`, which may be coarser than that of the scene. */
pg_status pg_tally_count (pg_tally *out, const pg_counting *how)
{
    pg_status status = PG_OK;
    counter c = { .how = how, .l = how->lattice };
    memset (out, 0, sizeof *out);
    PG_TRY (count_sites (&c, out));
    if (wide_open (&c, out)) goto done;
    PG_TRY (make_stencils (&c));
    PG_TRY (make_marks (&c));
    count_nodes (&c, out);
    count_gauss (&c, out);
done:
    counter_clear (&c);
    return status;
}
