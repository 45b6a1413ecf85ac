/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds points that have reached their limit of energy, without summing all energies in every step. sqrt
 * (W_i) is a norm of the relative displacements of a point's bonds (finite stretch: it changes by no more
 * than such a norm). Since a displacement d0 at which all energies were computed
 *     sqrt (W_i (d)) <= sqrt (W_i (d0)) + sqrt (A_i) max_j |delta_j - delta_i|,
 *     delta = d - d0,  A_i = 1/4 sum_j kappa r^2 / V_i,
 * and bonds that broke meanwhile only lower it. Points lie in square tiles wider than any bond: the range of
 * delta over a tile and the tiles around it bounds the last factor. Points that the bound does not exclude
 * are computed one by one; when these have cost as much as a loop, all energies are computed again. The
 * result does not depend on the tiles. */
#include "pairwise.h"
#include <math.h>
#include <string.h>

static const double margin = 1e-6;                     /* relative, on limits: far above rounding of loops */
/* Edge of a tile in spacings; how many points in a loop cost as much as one by itself; lanes of box_run. */
enum { EDGE = 8, DEAR = 3, LANES = 8 };

typedef struct { size_t first, n; } run;               /* n points with consecutive numbers */
struct pairwise_tiles {
    int     dim, count[3];                             /* tiles along each axis */
    size_t  n;                                         /* number of tiles */
    size_t *start;  run *run;                          /* runs of each tile, ascending (n + 1; start[n]) */
    double *box;                                       /* least, largest delta of a tile, m (n x 2 dim) */
    double *known;                                     /* largest sqrt (W / W_c) of a tile at d0 (n) */
    double *gain;                                      /* largest sqrt (A / W_c) of a tile, 1/m (n) */
    double *reach;                                     /* gain times range of delta around a tile (n) */
    double *near;                                      /* sqrt (W / W_c) of each point at d0 (points) */
    size_t *open;                                      /* points of a tile that may be at their limit (n) */
    double *d0;                                        /* displacement at the last full loop, m (ndof) */
    int     fresh;                                     /* 1: known, near and d0 are valid */
    size_t  spent;                                     /* points computed one by one since d0 */
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
/* Returns the length of the longest bond of the body, m. No tile is smaller, so that the neighbours of a
 * point lie in its tile or in those around it. */
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
/* Sets *i to the next point of a tile; *where is { t->start[tile], 0 } at first. Returns 0 if there are no
 * more. */
static int next_point (const pairwise_tiles *t, size_t tile, place *where, size_t *i)
{
    while (where->run < t->start[tile + 1] && where->next == t->run[where->run].n)
        where->run++, where->next = 0;
    if (where->run == t->start[tile + 1]) return 0;
    *i = t->run[where->run].first + where->next++;
    return 1;
}

/* Computes `gain` of tiles first .. last - 1: largest sqrt (A / W_c) of their points, 1/m, by all bonds.
 * Bonds that break only lower it, so that it need not be updated. */
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

/* Lists the runs of every tile: points with consecutive numbers that lie in it. */
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

/* Makes tiles no smaller than the longest bond, and not many more than points (where bodies are scattered
 * most tiles are empty), and computes their gain. */
static pg_status create (bond_force *b)
{
    pg_status status = PG_OK;
    pairwise_tiles *t = NULL;
    const pg_cloud *cloud = &b->problem->cloud;
    double edge = fmax (EDGE * cloud->h, longest_bond (b) * (1 + 1e-9)),
           most = pow ((double) b->n, 1.0 / b->dim) + 1;
    PG_ALLOC (t, 1);
    t->dim = b->dim, t->n = 1;
    /* Not more than about b->n tiles, also for scattered bodies. */
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

/* ---- bounds -------------------------------------------------------------------------------------------- */
typedef struct { bond_force *b; const double *d; } looking;

/* Widens low and high by now - then over n numbers, lane by lane: lane l belongs to component l modulo dim,
 * as `lanes` numbers are a whole number of points. */
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

/* Computes the least and largest delta = d - d0 over each of the tiles first .. last - 1. */
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

/* Returns the diagonal of the range of delta over a tile and those around it, m: no bond that ends in the
 * tile has changed its relative displacement by more. */
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

/* May a point (or tile) with this sqrt (W / W_c) at d0 have reached its limit since? Then it is open. */
static int is_open (const pairwise_tiles *t, size_t tile, double at_d0)
{
    return !(at_d0 + t->reach[tile] < 1 - margin);
}

/* Counts the open points of each of the tiles first .. last - 1; none if the tile as a whole is not open. */
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

/* ---- energies ------------------------------------------------------------------------------------------ */
/* Has point i reached its limit of energy, by the plain sum over its own bonds? */
static int dies (const bond_force *b, size_t i, int thread, const double *d)
{
    return isfinite (b->node.critical[i]) && pairwise_energy_at (b, i, thread, d) >= b->node.critical[i];
}

/* Sets `dying` of the open points of tiles first .. last - 1, by their own bonds. */
static void look_at_open (void *context, size_t first, size_t last, int thread)
{
    const looking *w = context;
    const pairwise_tiles *t = pairwise_of (w->b)->tiles;
    size_t i;
    for (size_t k = first; k < last; k++)
        for (place p = { t->start[k], 0 }; t->open[k] && next_point (t, k, &p, &i);)
            w->b->node.dying[i] = is_open (t, k, t->near[i]) && dies (w->b, i, thread, w->d);
}

/* Sets known, near and `dying` of tiles first .. last - 1 from the energies of the loop (node.density). Those
 * near their limit are summed once more by their own bonds, as loops of different instruction sets round
 * differently. */
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

/* bond_theory.find_dying: computes open points one by one, or all energies if these are not known or if that
 * is cheaper. */
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
