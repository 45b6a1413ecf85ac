/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which points may have reached their limit of energy. sqrt (W_i) is a norm of the relative displacements of
 * a point's bonds (finite stretch: it changes by no more than one), so that since a displacement d0 at which
 * all energies were known
 *     sqrt (W_i (d)) <= sqrt (W_i (d0)) + sqrt (A_i) max_j |delta_j - delta_i|, delta = d - d0, A_i = 1/4
 *         sum_j kappa r^2 / V_i,
 * and bonds that died meanwhile only lower it. Points lie in square tiles wider than any bond: the box of
 *     delta over a tile and those around it
 * bounds the last factor. Points that this does not clear are looked at one by one; when these have cost as
 *     much as a loop, it tells all energies again.
 * What is decided does not depend on any of this. */
#include "pairwise.h"
#include <math.h>
#include <string.h>

static const double margin = 1e-6;                     /* of the limit: far more than rounding of any loop */
/* spacings of a tile; a point alone costs as much as so many in a loop */
enum { EDGE = 8, DEAR = 3, LANES = 8 };

typedef struct { size_t first, n; } run;               /* points one after the other */
struct pairwise_tiles {
    int     dim, count[3];
    size_t  n;                                         /* tiles */
    size_t *start;  run *run;                          /* runs of each, ascending (n + 1; of all) */
    double *box;                                       /* low, high of delta (n x 2 dim) */
    double *known;                                     /* largest sqrt (W / W_c) at d0 (n) */
    double *gain;                                      /* largest sqrt (A / W_c), 1/m (n) */
    double *reach;                                     /* gain times width of delta around (n) */
    double *near;                                      /* sqrt (W / W_c) of each point at d0 (points) */
    size_t *open;                                      /* points that may have reached theirs (n) */
    double *d0;                                        /* m (ndof) */
    int     fresh;                                     /* 1: known, near and d0 are there */
    size_t  spent;                                     /* points looked at one by one since then */
};

/* Frees *tiles, which may be NULL. */
void pairwise_tiles_free (pairwise_tiles **tiles)
{
    pairwise_tiles *t = *tiles;
    if (!t) return;
    pg_free (t->start), pg_free (t->run), pg_free (t->box), pg_free (t->known), pg_free (t->gain),
        pg_free (t->reach), pg_free (t->near);
    pg_free (t->open), pg_free (t->d0);
    pg_free (t);
    *tiles = NULL;
}

/* ---- building ------------------------------------------------------------------------------------------ */
/* The longest bond of the body, m: no tile is smaller, so that a point and its neighbours lie in a tile
 * and those around it. */
static double longest_bond (const bond_force *b)
{
    size_t dim = (size_t) b->dim;
    double top = 0;
    for (size_t i = 0; i < b->n; i++)
        for (size_t e = b->family->start[i]; e < b->family->start[i + 1]; e++) {
            const double *x = b->problem->cloud.x + i * dim,
                         *y = b->problem->cloud.x + (size_t) b->family->node[e] * dim;
            double rr = 0;
            for (size_t k = 0; k < dim; k++) rr += (y[k] - x[k]) * (y[k] - x[k]);
            top = fmax (top, rr);
        }
    return sqrt (top);
}

/* Number of the tile that holds point i. */
static size_t tile_of (const pairwise_tiles *t, const pg_cloud *cloud, double edge, size_t i)
{
    size_t at = 0;
    for (int k = t->dim; k-- > 0;) {
        int c = (int) ((cloud->x[i * (size_t) t->dim + (size_t) k] - cloud->low[k]) / edge);
        at = at * (size_t) t->count[k] + (size_t) (c < 0 ? 0 : c < t->count[k] ? c : t->count[k] - 1);
    }
    return at;
}

typedef struct { size_t run, next; } place;
/* The next point of a tile, *i; where: { start of the tile, 0 } at first. 0: there are no more. */
static int next_point (const pairwise_tiles *t, size_t tile, place *where, size_t *i)
{
    while (where->run < t->start[tile + 1] && where->next == t->run[where->run].n)
        where->run++, where->next = 0;
    if (where->run == t->start[tile + 1]) return 0;
    *i = t->run[where->run].first + where->next++;
    return 1;
}

/* Largest sqrt (A / W_c) of the points of a tile, 1/m, with kappa of all their bonds: bonds that die only
 * make it smaller, and it need not follow them. */
static void find_gains (void *context, size_t first, size_t last, int thread)
{
    const bond_force *b = context;
    const pairwise_tiles *t = pairwise_of (b)->tiles;
    point_bonds s;
    double r;
    size_t i;
    for (size_t k = first; k < last; k++)
        for (place p = { t->start[k], 0 }; next_point (t, k, &p, &i);) {
            double sum = 0;
            point_bonds_at (b, i, thread, &s);
            for (size_t e = 0; e < s.m; e++) {
                double kappa = pairwise_kappa (b, i, &s, e, &r);
                sum += kappa * r * r;
            }
            t->gain[k] = fmax (t->gain[k],
                               sqrt (sum / (4 * b->problem->cloud.volume[i] * b->node.critical[i])));
        }
}

/* Runs of points of every tile: neighbours in number that lie in one tile. */
static pg_status fill (pairwise_tiles *t, const pg_cloud *cloud, double edge)
{
    pg_status status = PG_OK;
    size_t *next = NULL, last = t->n;
    PG_ALLOC (next, t->n + 1);
    for (size_t i = 0, tile; i < cloud->n; i++, last = tile)
        if ((tile = tile_of (t, cloud, edge, i)) != last) t->start[tile + 1]++;
    for (size_t k = 0; k < t->n; k++) t->start[k + 1] += t->start[k], next[k] = t->start[k];
    PG_ALLOC (t->run, t->start[t->n]);
    last = t->n;
    for (size_t i = 0, tile; i < cloud->n; i++, last = tile) {
        tile = tile_of (t, cloud, edge, i);
        if (tile != last) t->run[next[tile]++] = (run) { i, 0 };
        t->run[next[tile] - 1].n++;
    }
done:
    pg_free (next);
    return status;
}

/* Tiles no smaller than the longest bond, nor so many that empty ones outnumber points (scattered
 * bodies), and what displacements can add to the energies in each. */
static pg_status create (bond_force *b)
{
    pg_status status = PG_OK;
    pairwise_tiles *t = NULL;
    const pg_cloud *cloud = &b->problem->cloud;
    double edge = fmax (EDGE * cloud->h, longest_bond (b) * (1 + 1e-9)),
           most = pow ((double) b->n, 1.0 / b->dim) + 1;
    PG_ALLOC (t, 1);
    t->dim = b->dim, t->n = 1;
    /* scattered bodies */
    for (int k = 0; k < t->dim; k++) edge = fmax (edge, (cloud->high[k] - cloud->low[k]) / most);
    for (int k = 0; k < t->dim; k++) {
        t->count[k] = 1 + (int) ((cloud->high[k] - cloud->low[k]) / edge);
        t->n *= (size_t) t->count[k];
    }
    PG_ALLOC (t->start, t->n + 1);
    PG_ALLOC (t->box, t->n * 2 * (size_t) t->dim);
    PG_ALLOC (t->known, t->n);
    PG_ALLOC (t->gain, t->n);
    PG_ALLOC (t->reach, t->n);
    PG_ALLOC (t->open, t->n);
    PG_ALLOC (t->near, b->n);
    PG_ALLOC (t->d0, b->n * (size_t) t->dim);
    PG_TRY (fill (t, cloud, edge));
    ((pairwise *) b)->tiles = t, t = NULL;
    pg_parallel (b->threads, pairwise_of (b)->tiles->n, find_gains, b);
done:
    pairwise_tiles_free (&t);
    return status;
}

/* ---- what may have happened ---------------------------------------------------------------------------- */
typedef struct { bond_force *b; const double *d; } looking;

/* Extremes of now - then over n numbers, lane by lane: lane l belongs to component l modulo dim, as LANES
 * and LANES - LANES % 3 are whole numbers of points. */
static void box_run (const double *now, const double *then, size_t n, size_t lanes, double *low, double *high)
{
    size_t j = 0;
    for (; j + lanes <= n; j += lanes)
        for (size_t l = 0; l < lanes; l++) {
            double delta = now[j + l] - then[j + l];
            low[l] = delta < low[l] ? delta : low[l], high[l] = delta > high[l] ? delta : high[l];
        }
    for (size_t l = 0; j + l < n; l++) {
        double delta = now[j + l] - then[j + l];
        low[l] = delta < low[l] ? delta : low[l], high[l] = delta > high[l] ? delta : high[l];
    }
}

/* Low and high of delta = d - d0 over each tile of a range. */
static void box_tiles (void *context, size_t first, size_t last, int thread)
{
    const looking *w = context;
    const pairwise_tiles *t = pairwise_of (w->b)->tiles;
    size_t dim = (size_t) t->dim;
    (void) thread;
    for (size_t k = first; k < last; k++) {
        double low[LANES], high[LANES], *box = t->box + k * 2 * dim;
        for (size_t l = 0; l < LANES; l++) low[l] = INFINITY, high[l] = -INFINITY;
        for (size_t q = t->start[k]; q < t->start[k + 1]; q++) {
            const double *now = w->d + t->run[q].first * dim, *then = t->d0 + t->run[q].first * dim;
            if (dim == 3) box_run (now, then, t->run[q].n * dim, LANES - LANES % 3, low, high);
            else box_run (now, then, t->run[q].n * dim, LANES, low, high);
        }
        for (size_t a = 0; a < dim; a++) {
            box[a] = INFINITY, box[dim + a] = -INFINITY;
            for (size_t l = a; l < LANES; l += dim)
                box[a] = fmin (box[a], low[l]), box[dim + a] = fmax (box[dim + a], high[l]);
        }
    }
}

/* Diagonal of the box of delta over a tile and those around it, m: no two points that share a bond have
 * moved against each other by more. */
static double width_around (const pairwise_tiles *t, size_t tile)
{
    double low[3] = { INFINITY, INFINITY, INFINITY }, high[3] = { -INFINITY, -INFINITY, -INFINITY },
           square = 0;
    int at[3] = { 0 }, from[3] = { 0 }, to[3] = { 0 };
    size_t rest = tile, dim = (size_t) t->dim;
    for (int k = 0; k < t->dim; k++) {
        at[k] = (int) (rest % (size_t) t->count[k]), rest /= (size_t) t->count[k];
        from[k] = at[k] > 0 ? at[k] - 1 : 0, to[k] = at[k] + 1 < t->count[k] ? at[k] + 1 : at[k];
    }
    for (int z = from[2]; z <= to[2]; z++)
        for (int y = from[1]; y <= to[1]; y++)
            for (int x = from[0]; x <= to[0]; x++) {
                size_t near = ((size_t) z * (size_t) (dim > 1 ? t->count[1] : 1) + (size_t) y)
                                  * (size_t) t->count[0]
                              + (size_t) x;
                const double *box = t->box + near * 2 * dim;
                for (size_t a = 0; a < dim && t->start[near + 1] > t->start[near]; a++) {
                    low[a] = fmin (low[a], box[a]), high[a] = fmax (high[a], box[dim + a]);
                }
            }
    for (size_t a = 0; a < dim; a++) square += (high[a] - low[a]) * (high[a] - low[a]);
    return sqrt (square);
}

/* A point is open when sqrt (W / W_c) at d0 and what may have come since reach 1. */
static int is_open (const pairwise_tiles *t, size_t tile, double at_d0)
{
    return !(at_d0 + t->reach[tile] < 1 - margin);
}

/* Which points of each tile may have reached their limit: none, unless the bound of the whole tile says
 * so. */
static void clear_tiles (void *context, size_t first, size_t last, int thread)
{
    const looking *w = context;
    pairwise_tiles *t = pairwise_of (w->b)->tiles;
    size_t i;
    (void) thread;
    for (size_t k = first; k < last; k++) {
        t->open[k] = 0;
        if (!(t->gain[k] > 0)) continue;
        t->reach[k] = t->gain[k] * width_around (t, k);
        if (!is_open (t, k, t->known[k])) continue;
        for (place p = { t->start[k], 0 }; next_point (t, k, &p, &i);)
            t->open[k] += is_open (t, k, t->near[i]);
    }
}

/* ---- looking ------------------------------------------------------------------------------------------- */
/* By the plain sum over its own bonds, whatever the tiles say. */
static int dies (const bond_force *b, size_t i, int thread, const double *d)
{
    return isfinite (b->node.critical[i]) && pairwise_energy_at (b, i, thread, d) >= b->node.critical[i];
}

/* Open points, by their own bonds. */
static void look_at_open (void *context, size_t first, size_t last, int thread)
{
    const looking *w = context;
    const pairwise_tiles *t = pairwise_of (w->b)->tiles;
    size_t i;
    for (size_t k = first; k < last; k++)
        for (place p = { t->start[k], 0 }; t->open[k] && next_point (t, k, &p, &i);)
            w->b->node.dying[i] = is_open (t, k, t->near[i]) && dies (w->b, i, thread, w->d);
}

/* All energies, from b->density: those near their limit are summed once more by their own bonds, since
 * loops of different instruction sets round differently and what breaks must not. */
static void look_at_all (void *context, size_t first, size_t last, int thread)
{
    const looking *w = context;
    const bond_force *b = w->b;
    pairwise_tiles *t = pairwise_of (b)->tiles;
    size_t i;
    for (size_t k = first; k < last; k++) {
        t->known[k] = 0;
        for (place p = { t->start[k], 0 }; next_point (t, k, &p, &i);) {
            t->near[i] = sqrt (fmax (0, b->node.density[i] / b->node.critical[i]));
            t->known[k] = fmax (t->known[k], t->near[i]);
            b->node.dying[i] = t->near[i] >= 1 - margin && dies (b, i, thread, w->d);
        }
    }
}

void pairwise_tiles_forget (bond_force *b) { if (pairwise_of (b)->tiles) pairwise_of (b)->tiles->fresh = 0; }

/* Only tiles that may have reached a limit since the last full look are opened. */
pg_status pairwise_tiles_look (bond_force *b, const double *d, size_t *dying)
{
    pg_status status = PG_OK;
    looking w = { b, d };
    size_t open = 0, i;
    *dying = 0;
    if (!pairwise_of (b)->tiles) PG_TRY (create (b));
    pairwise_tiles *t = pairwise_of (b)->tiles;
    if (t->fresh) {
        pg_parallel (b->threads, t->n, box_tiles, &w);
        pg_parallel (b->threads, t->n, clear_tiles, &w);
        for (size_t k = 0; k < t->n; k++) open += t->open[k];
        if (open == 0) goto done;
    }
    int all = !t->fresh || t->spent + open > b->n / DEAR;
    t->spent = all ? 0 : t->spent + open;
    if (all) {
        PG_TRY (pg_bond_loop_energies (b->loop, d, b->node.density));
        memcpy (t->d0, d, b->n * (size_t) t->dim * sizeof *d);
        t->fresh = 1;
    }
    pg_parallel_heavy (b->threads, t->n, all ? look_at_all : look_at_open, &w);
    for (size_t k = 0; k < t->n; k++)
        for (place p = { t->start[k], 0 }; (all || t->open[k]) && next_point (t, k, &p, &i);)
            *dying += b->node.dying[i];
done:
    return status;
}
