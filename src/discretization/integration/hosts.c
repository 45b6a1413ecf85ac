/* SPDX-License-Identifier: GPL-3.0-or-later
 * Hosts of small cells: a cut cell of almost no volume, whose derivatives the divergence identity would make
 * as large as its size is small, keeps its uncorrected derivatives, and another cell, its host, obeys the
 * identity of both (cell aggregation: Badia, Verdugo, Martin 2018, doi 10.1016/j.cma.2018.03.022). The host
 * is the cell beyond its largest inner face, or the host of that if it is small as well. A cell with several
 * such faces, as in the corner of a cell between two neighbours, has as many hosts, which share its
 * identity: none of them is chosen by rounding, or by its number. */
#include "consistent.h"
#include <math.h>
#include <string.h>

/* Share of the volume of a whole cell below which a cut cell is small. */
static const double SMALL = 0.1;
/* Volumes and areas that differ by less than this, relatively, count as equal; so do those that differ by
 * what rounding of coordinates can change. */
static const double EQUAL = 1e-9;
/* PASSES: how often hosts of small cells among small cells are sought. HOSTS: most hosts of a cell. */
enum { PASSES = 4, HOSTS = 16 };

/* The hosts of a small cell, and the share of it that each takes. */
typedef struct { int n, cell[HOSTS]; double share[HOSTS]; } lodging;

/* Lengths of the sides of a cell's box, m. */
static void sides_of (const pg_cells *c, size_t cell, double *side)
{
    for (int k = 0; k < c->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = c->start[cell]; i < c->start[cell + 1]; i++) {
            double x = c->x[i * (size_t) c->dim + (size_t) k];
            low = fmin (low, x), high = fmax (high, x);
        }
        side[k] = high - low;
    }
}

static double rounding_of (const pg_consistency *c)
{
    return pg_rounding (c->cloud->dim, c->cloud->low, c->cloud->high);
}

static int is_small (const pg_consistency *of, size_t cell)
{
    const pg_cells *c = of->cells;
    double side[3], whole = c->dim == 3 ? 1 : c->thickness, least = INFINITY;
    if (c->kind[cell] != PG_CUT || c->dim == 1) return 0;
    sides_of (c, cell, side);
    for (int k = 0; k < c->dim; k++) whole *= side[k], least = fmin (least, side[k]);
    return c->volume[cell] < ((1 - EQUAL) * SMALL - rounding_of (of) / least) * whole;
}

static double area_of (const pg_faces *f, size_t face)
{
    double sum = 0;
    for (size_t q = f->start[face]; q < f->start[face + 1]; q++) {
        double square = 0;
        for (int k = 0; k < f->dim; k++) square += pow (f->flux[q * (size_t) f->dim + (size_t) k], 2);
        sum += sqrt (square);
    }
    return sum;
}

static void add_host (lodging *l, int cell, double share)
{
    int k = 0;
    while (k < l->n && l->cell[k] != cell) k++;
    if (k == HOSTS) return;
    if (k == l->n) l->cell[l->n] = cell, l->share[l->n++] = 0;
    l->share[k] += share;
}

/* The cell on the other side of a face of `cell` if it is not small or has hosts already (before this pass);
 * -1: there is none. */
static int beyond (const pg_consistency *c, size_t face, size_t cell, const unsigned char *small,
                   const lodging *so_far)
{
    const pg_faces *f = &c->faces;
    int other = f->cell[2 * face] == (int) cell ? f->cell[2 * face + 1] : f->cell[2 * face];
    if (other < 0 || c->first[other] == c->first[other + 1]) return -1;
    return small[other] && so_far[other].n == 0 ? -1 : other;
}

/* The hosts of a small cell: the cell beyond its largest inner face, or the hosts of that cell; cells beyond
 * faces of equal size take equal shares. */
static lodging lodge (const pg_consistency *c, size_t cell, const unsigned char *small, const lodging *so_far)
{
    const pg_faces *f = &c->faces;
    lodging out = { 0 };
    double most = 0, sum = 0, side[3], breadth = c->cells->thickness;
    sides_of (c->cells, cell, side);
    if (f->dim == 3) breadth = fmax (fmax (side[0], side[1]), side[2]);
    for (size_t k = f->of[cell]; k < f->of[cell + 1]; k++)
        if (beyond (c, (size_t) f->face[k], cell, small, so_far) >= 0)
            most = fmax (most, area_of (f, (size_t) f->face[k]));
    double least = (1 - EQUAL) * most - rounding_of (c) * breadth;
    for (size_t k = f->of[cell]; most > 0 && k < f->of[cell + 1]; k++) {
        int other = beyond (c, (size_t) f->face[k], cell, small, so_far);
        if (other < 0 || area_of (f, (size_t) f->face[k]) < least) continue;
        if (!small[other]) add_host (&out, other, 1);
        for (int h = 0; small[other] && h < so_far[other].n; h++)
            add_host (&out, so_far[other].cell[h], so_far[other].share[h]);
    }
    for (int h = 0; h < out.n; h++) sum += out.share[h];
    for (int h = 0; h < out.n; h++) out.share[h] /= sum;
    return out;
}

/* Builds compressed rows from pairs (from, to), ordered by `from`, and within a row as they come. With
 * `value` (one a pair) *sorted has the values in the same order. */
static pg_status gather (pg_family *out, size_t n, size_t npair, const int *pair, const double *value,
                         double **sorted)
{
    pg_status status = PG_OK;
    size_t *next = NULL;
    out->n = n;
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (out->node, npair);
    if (value) PG_ALLOC (*sorted, npair);
    PG_ALLOC (next, n);
    for (size_t k = 0; k < npair; k++) out->start[pair[2*k] + 1]++;
    for (size_t i = 0; i < n; i++) out->start[i + 1] += out->start[i], next[i] = out->start[i];
    for (size_t k = 0; k < npair; k++) {
        if (value) (*sorted)[next[pair[2*k]]] = value[k];
        out->node[next[pair[2*k]]++] = pair[2*k + 1];
    }
done:
    pg_free (next);
    return status;
}

/* Turns each of `count` pairs (from, to) into (to, from). */
static void turn_pairs (int *pair, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        int t = pair[2*k];
        pair[2*k] = pair[2*k + 1], pair[2*k + 1] = t;
    }
}

/* Enters the hosts of each cell, and the guests (small cells) of each host. */
static pg_status enter (pg_consistency *c, const lodging *of)
{
    pg_status status = PG_OK;
    size_t n = c->cells->n, count = 0;
    int *pair = NULL;
    double *share = NULL;
    for (size_t cell = 0; cell < n; cell++) count += (size_t) of[cell].n;
    PG_ALLOC (pair, 2 * count);
    PG_ALLOC (share, count);
    count = 0;
    for (size_t cell = 0; cell < n; cell++)
        for (int h = 0; h < of[cell].n; h++, count++) {
            pair[2 * count] = of[cell].cell[h], pair[2 * count + 1] = (int) cell;
            share[count] = of[cell].share[h];
        }
    PG_TRY (gather (&c->guests, n, count, pair, share, &c->guest_share));
    turn_pairs (pair, count);
    PG_TRY (gather (&c->hosts, n, count, pair, NULL, NULL));
done:
    pg_free (pair), pg_free (share);
    return status;
}

static pg_status find_hosts (pg_consistency *c)
{
    pg_status status = PG_OK;
    size_t n = c->cells->n;
    unsigned char *small = NULL;
    lodging *now = NULL, *before = NULL;
    PG_ALLOC (small, n);
    PG_ALLOC (now, n);
    PG_ALLOC (before, n);
    for (size_t cell = 0; cell < n; cell++) small[cell] = (unsigned char) is_small (c, cell);
    for (int pass = 0; pass < PASSES; pass++) {
        memcpy (before, now, n * sizeof *before);
        for (size_t cell = 0; cell < n; cell++)
            if (small[cell] && before[cell].n == 0) now[cell] = lodge (c, cell, small, before);
    }
    PG_TRY (enter (c, now));
done:
    pg_free (small), pg_free (before), pg_free (now);
    return status;
}

/* Finds c->needs: the cells that must have all their bonds for the derivatives of a cell to be corrected:
 * itself, its neighbours, and those of its guests; and the inverse relation, c->opens. */
static pg_status find_needs (pg_consistency *c)
{
    pg_status status = PG_OK;
    const pg_faces *f = &c->faces;
    size_t n = c->cells->n, count = 0, cap = 0, *seen = NULL;
    int *pair = NULL;
    PG_ALLOC (seen, n);
    for (size_t cell = 0; cell < n; cell++)
        for (size_t g = c->guests.start[cell]; g <= c->guests.start[cell + 1]; g++) {
            size_t of = g < c->guests.start[cell + 1] ? (size_t) c->guests.node[g] : cell;
            for (size_t k = f->of[of]; k <= f->of[of + 1]; k++)
                for (int side = 0; side < 2; side++) {
                    int beside = k < f->of[of + 1] ? f->cell[2 * f->face[k] + side] : (int) of;
                    if (beside < 0 || seen[beside] == cell + 1) continue;
                    seen[beside] = cell + 1;
                    PG_GROW (pair, cap, 2 * (count + 1));
                    pair[2 * count] = (int) cell, pair[2 * count++ + 1] = beside;
                }
        }
    PG_TRY (gather (&c->needs, n, count, pair, NULL, NULL));
    turn_pairs (pair, count);
    PG_TRY (gather (&c->opens, n, count, pair, NULL, NULL));
done:
    pg_free (seen), pg_free (pair);
    return status;
}

pg_status consistent_hosts (pg_consistency *c)
{
    pg_status status = PG_OK;
    PG_TRY (find_hosts (c));
    PG_TRY (find_needs (c));
done:
    return status;
}
