/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checkpoints of processes among which the points of a body were divided, read together by the processes that
 * continue the run, be they more or fewer. Every checkpoint has the numbers of its points, which do not
 * depend on the division, which of them it owns, the box in which they lie, and their broken bonds. A process
 * opens the checkpoints whose box meets its own, and finds there each point that it holds, ghosts too, in the
 * part that owned it. */
#include "resume.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A bond is stored as two numbers: SETS times the number of its point plus the bond set; the number of its
 * node. */
enum { OF_BOND = 2, SETS = 4 };
_Static_assert ((int) PG_BOND_SETS <= (int) SETS, "a bond set has a number below SETS");

/* ---- writing ------------------------------------------------------------------------------------------- */
static int owned (const pg_problem *p, size_t i) { return pg_cloud_owns (&p->cloud, i); }

/* Bounding box of the points that this process owns (held 1: holds), m: low x, y, z, high x, y, z. */
static void box_of (const pg_problem *p, int held, double *box)
{
    size_t dim = (size_t) p->dim;
    for (int k = 0; k < 3; k++) box[k] = INFINITY, box[3 + k] = -INFINITY;
    for (size_t i = 0; i < p->cloud.n; i++)
        for (size_t k = 0; k < dim && (held || owned (p, i)); k++) {
            box[k] = fmin (box[k], p->cloud.x[i * dim + k]);
            box[3 + k] = fmax (box[3 + k], p->cloud.x[i * dim + k]);
        }
}

/* Checksum of the owned points, which adds up to the same total for any division: positions, numbers and
 * blocks. */
static uint64_t sum_of_points (const pg_problem *p, const int64_t *number)
{
    uint64_t sum = 0;
    const pg_cloud *c = &p->cloud;
    size_t dim = (size_t) c->dim;
    for (size_t i = 0; i < c->n; i++) {
        if (!owned (p, i)) continue;
        uint64_t hash = pg_fingerprint (PG_FINGERPRINT, c->x + i * dim, dim * sizeof *c->x);
        hash = pg_fingerprint (hash, &number[i], sizeof *number);
        sum += pg_fingerprint (hash, &c->block[i], sizeof *c->block);
    }
    return sum;
}

/* Lists the broken bonds of owned points, all bond sets one after the other. */
static pg_status list_dead (const pg_problem *p, const unsigned char *alive, size_t *n, long **dead)
{
    pg_status status = PG_OK;
    int64_t *node = NULL, *point = NULL;
    size_t room = 0;
    *n = 0;
    PG_TRY (pg_problem_numbers (p, PG_NODES, &node));
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &p->bonds.rows[set].family;
        const unsigned char *bit = alive + p->bonds.first[set];
        pg_free (point), point = NULL;
        PG_TRY (pg_problem_numbers (p, set, &point));
        for (size_t q = 0; q < f->n; q++) {
            if (!pg_problem_owns (p, set, q)) continue;
            for (size_t e = f->start[q]; e < f->start[q + 1]; e++) {
                if (bit[e]) continue;
                PG_GROW (*dead, room, OF_BOND * (*n + 1));
                (*dead)[OF_BOND * *n] = SETS * (long) point[q] + set;
                (*dead)[OF_BOND * (*n)++ + 1] = (long) node[f->node[e]];
            }
        }
    }
done:
    pg_free (node), pg_free (point);
    return status;
}

/* Writes the part of a checkpoint that other processes need; called twice per checkpoint. A body whose points
 * have no numbers independent of the division gets none. */
pg_status parts_keep (const pg_problem *p, const pg_state *at, const pg_keeper *k)
{
    pg_status status = PG_OK;
    int64_t *number = NULL;
    long *list = NULL, *dead = NULL, sum;
    unsigned char *own = NULL;
    double box[6];
    size_t n = p->cloud.n, ndead = 0;
    if (k->reading) return PG_OK;
    status = pg_problem_numbers (p, PG_NODES, &number);
    if (status == PG_OK) status = list_dead (p, at->alive, &ndead, &dead);
    if (status == PG_E_LIMIT) status = PG_OK, n = 0;       /* such a run continues only on equal processes */
    PG_TRY (status);
    if (n == 0) goto done;
    PG_ALLOC (list, n);
    PG_ALLOC (own, n);
    for (size_t i = 0; i < n; i++) list[i] = (long) number[i], own[i] = (unsigned char) owned (p, i);
    box_of (p, 0, box);
    sum = (long) sum_of_points (p, number);
    PG_TRY (k->numbers (k->context, "part.box", 6, box));
    PG_TRY (k->counts (k->context, "part.points", n, list));
    PG_TRY (k->bytes (k->context, "part.owned", n, own));
    PG_TRY (k->counts (k->context, "part.sum", 1, &sum));
    PG_TRY (k->counts (k->context, "part.dead", OF_BOND * ndead, dead));
done:
    pg_free (number), pg_free (list), pg_free (dead), pg_free (own);
    return status;
}

/* ---- reading: which points where ----------------------------------------------------------------------- */
static int ascending (const void *a, const void *b)
{
    const parts_number *x = a, *y = b;
    return (x->number > y->number) - (x->number < y->number);
}

/* Sorts the points of a bond set by their number. */
static pg_status sort_numbers (const pg_problem *p, int set, size_t *n, parts_number **out)
{
    pg_status status = PG_OK;
    int64_t *number = NULL;
    *n = set == PG_NODES ? p->cloud.n : p->bonds.rows[set].n;
    PG_TRY (pg_problem_numbers (p, set, &number));
    PG_ALLOC (*out, *n);
    for (size_t i = 0; i < *n; i++) (*out)[i] = (parts_number) { number[i], i };
    pg_sort (*out, *n, sizeof **out, ascending);
done:
    pg_free (number);
    return status;
}

/* Index of the point of that number; SIZE_MAX: not held here. */
static size_t find_number (const parts_number *list, size_t n, int64_t number)
{
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (list[middle].number < number) low = middle + 1;
        else high = middle;
    }
    return low < n && list[low].number == number ? list[low].at : SIZE_MAX;
}

static pg_status open_part (parts_kept *w, int part)
{
    pg_status status = PG_OK;
    char path[4096];
    if (w->part[part]) return PG_OK;
    parts_path (path, sizeof path, w->folder, part, w->fresh[part]);
    PG_TRY (pg_checkpoint_open (&w->part[part], path));
done:
    return status;
}

/* Reads all integers that a part has under a name; the caller frees them with pg_free. */
static pg_status counts_of (const parts_kept *w, int part, const char *name, size_t *n, long **out)
{
    pg_status status = PG_OK;
    const pg_keeper *k = pg_checkpoint_keeper (w->part[part]);
    *n = pg_checkpoint_length (w->part[part], name);
    PG_ALLOC (*out, *n);
    PG_TRY (k->counts (k->context, name, *n, *out));
done:
    return status;
}

/* 1: the box of a part, widened by the reach of cells beyond points, meets the box of the points held
 * here. */
static int meets (const double *theirs, const double *mine, int dim, double h)
{
    for (int k = 0; k < dim; k++)
        if (theirs[k] - 2 * h > mine[3 + k] || theirs[3 + k] + 2 * h < mine[k]) return 0;
    return 1;
}

/* Finds the points that a part owned and that are held here. */
static pg_status find_points (parts_kept *w, int part)
{
    pg_status status = PG_OK;
    const pg_keeper *k = pg_checkpoint_keeper (w->part[part]);
    long *number = NULL;
    unsigned char *own = NULL;
    size_t n, among = 0;
    PG_TRY (counts_of (w, part, "part.points", &n, &number));
    PG_ALLOC (own, n);
    PG_TRY (k->bytes (k->context, "part.owned", n, own));
    for (size_t j = 0; j < n; j++) {
        if (!own[j]) continue;
        size_t i = find_number (w->number[PG_NODES], w->n[PG_NODES], number[j]);
        if (i != SIZE_MAX) w->file[i] = part, w->at[i] = j, w->among[i] = among;
        among++;
    }
    w->used[part] = 1;
done:
    pg_free (number), pg_free (own);
    return status;
}

/* Fails unless the checksum of all points of the parts equals that of all points owned now, all ranks
 * together. */
static pg_status compare_points (parts_kept *w)
{
    pg_status status = PG_OK;
    const pg_problem *p = w->problem;
    int64_t *number = NULL;
    uint64_t before = 0, now = 0;
    double mine[2], *all = NULL;
    size_t n = 0;
    PG_TRY (pg_problem_numbers (p, PG_NODES, &number));
    now = sum_of_points (p, number);
    mine[0] = (double) (now >> 32), mine[1] = (double) (now & 0xffffffffu);
    if (p->cloud.subdomain) {
        PG_TRY (pg_ranks_share (2, mine, &n, &all));
        now = 0;
        for (size_t k = 0; k < n; k += 2) now += ((uint64_t) all[k] << 32) + (uint64_t) all[k + 1];
    }
    for (int k = 0; k < w->count; k++) {
        long sum;
        int was = w->part[k] != NULL;
        PG_TRY (open_part (w, k));
        const pg_keeper *keeper = pg_checkpoint_keeper (w->part[k]);
        PG_TRY (keeper->counts (keeper->context, "part.sum", 1, &sum));
        before += (uint64_t) sum;
        if (!was) pg_checkpoint_close (&w->part[k]);
    }
    if (now != before) PG_FAIL (PG_E_USAGE, "%s is of other points: run without --resume", w->folder);
done:
    pg_free (number), pg_free (all);
    return status;
}

pg_status parts_open (parts_kept *w, const pg_problem *p)
{
    pg_status status = PG_OK;
    double mine[6], box[6];
    w->problem = p;
    PG_ALLOC (w->part, (size_t) w->count);
    PG_ALLOC (w->used, (size_t) w->count);
    PG_ALLOC (w->file, p->cloud.n);
    PG_ALLOC (w->at, p->cloud.n);
    PG_ALLOC (w->among, p->cloud.n);
    for (int set = 0; set < PG_BOND_SETS; set++) PG_TRY (sort_numbers (p, set, &w->n[set], &w->number[set]));
    PG_TRY (compare_points (w));
    box_of (p, 1, mine);
    for (size_t i = 0; i < p->cloud.n; i++) w->file[i] = -1;
    for (int k = 0; k < w->count; k++) {
        PG_TRY (open_part (w, k));
        const pg_keeper *keeper = pg_checkpoint_keeper (w->part[k]);
        PG_TRY (keeper->numbers (keeper->context, "part.box", 6, box));
        if (meets (box, mine, p->dim, p->cloud.h)) PG_TRY (find_points (w, k));
        else if (k > 0) pg_checkpoint_close (&w->part[k]);
    }
    for (size_t i = 0; i < p->cloud.n; i++)
        if (w->file[i] < 0) PG_FAIL (PG_E_FILE, "%s: no checkpoint has point %zu", w->folder, i);
done:
    return status;
}

void parts_close (parts_kept *w)
{
    for (int k = 0; w->part && k < w->count; k++) pg_checkpoint_close (&w->part[k]);
    for (int set = 0; set < PG_BOND_SETS; set++) pg_free (w->number[set]);
    pg_free (w->part), pg_free (w->used), pg_free (w->file), pg_free (w->at), pg_free (w->among);
    pg_free (w->fresh);
}

/* ---- reading: values ----------------------------------------------------------------------------------- */
/* Sums values over the parts, each of which is read by one rank, or all by this process. */
static pg_status shares (void *context, const char *name, size_t n, double *value)
{
    pg_status status = PG_OK;
    parts_kept *w = context;
    double *one = NULL;
    int divided = pg_ranks_now () != NULL, step = divided ? pg_rank_count () : 1;
    PG_ALLOC (one, n);
    memset (value, 0, n * sizeof *value);
    for (int k = divided ? pg_rank () : 0; k < w->count; k += step) {
        PG_TRY (open_part (w, k));
        const pg_keeper *keeper = pg_checkpoint_keeper (w->part[k]);
        PG_TRY (keeper->numbers (keeper->context, name, n, one));
        for (size_t i = 0; i < n; i++) value[i] += one[i];
    }
    PG_TRY (pg_ranks_sum (n, value));
    if (divided && pg_rank ()) memset (value, 0, n * sizeof *value);
done:
    pg_free (one);
    return status;
}

static pg_status points (void *context, const char *name, size_t components, double *value)
{
    pg_status status = PG_OK;
    const parts_kept *w = context;
    size_t m = components;
    double *one = NULL;
    for (int k = 0; k < w->count; k++) {
        if (!w->used[k]) continue;
        const pg_keeper *keeper = pg_checkpoint_keeper (w->part[k]);
        size_t n = pg_checkpoint_length (w->part[k], "part.points");
        pg_free (one), one = NULL;
        PG_ALLOC (one, n * m);
        PG_TRY (keeper->numbers (keeper->context, name, n * m, one));
        for (size_t i = 0; i < w->problem->cloud.n; i++)
            if (w->file[i] == k) memcpy (value + i * m, one + w->at[i] * m, m * sizeof *value);
    }
done:
    pg_free (one);
    return status;
}

static pg_status unknowns (void *context, const char *list, const char *name, size_t row, size_t components,
                           double *value)
{
    pg_status status = PG_OK;
    const parts_kept *w = context;
    long *which = NULL;
    double *one = NULL;
    for (int k = 0; k < w->count; k++) {
        if (!w->used[k]) continue;
        const pg_keeper *keeper = pg_checkpoint_keeper (w->part[k]);
        size_t n, all = pg_checkpoint_length (w->part[k], name);
        pg_free (which), pg_free (one), which = NULL, one = NULL;
        PG_TRY (counts_of (w, k, list, &n, &which));
        PG_ALLOC (one, all);
        PG_TRY (keeper->numbers (keeper->context, name, all, one));
        if (n && (row + 1) * n > all) PG_FAIL (PG_E_FILE, "%s: a part lacks '%s'", w->folder, name);
        for (size_t j = 0; j < n; j++) {
            if (which[j] < 0) PG_FAIL (PG_E_FILE, "%s: unknown %ld in '%s'", w->folder, which[j], list);
            size_t i = find_number (w->number[PG_NODES], w->n[PG_NODES], which[j] / (long) components);
            if (i == SIZE_MAX || w->file[i] != k) continue;
            value[i * components + (size_t) (which[j] % (long) components)] = one[row * n + j];
        }
    }
done:
    pg_free (which), pg_free (one);
    return status;
}

/* Marks broken bonds in `alive`; bonds whose node or point is not held here are skipped. */
static pg_status bonds (void *context, unsigned char *alive)
{
    pg_status status = PG_OK;
    const parts_kept *w = context;
    const pg_problem *p = w->problem;
    long *dead = NULL;
    for (int k = 0; k < w->count; k++) {
        size_t n;
        if (!w->used[k]) continue;
        pg_free (dead), dead = NULL;
        PG_TRY (counts_of (w, k, "part.dead", &n, &dead));
        for (size_t j = 0; j + 1 < n; j += OF_BOND) {
            int set = (int) (dead[j] % SETS);
            if (dead[j] < 0 || set >= PG_BOND_SETS) PG_FAIL (PG_E_FILE, "%s: a bond of no set", w->folder);
            const pg_family *f = &p->bonds.rows[set].family;
            size_t point = find_number (w->number[set], w->n[set], dead[j] / SETS),
                   node = find_number (w->number[PG_NODES], w->n[PG_NODES], dead[j + 1]);
            if (point == SIZE_MAX || node == SIZE_MAX || point >= f->n) continue;
            for (size_t e = f->start[point]; e < f->start[point + 1]; e++)
                if ((size_t) f->node[e] == node) alive[p->bonds.first[set] + e] = 0;
        }
    }
done:
    pg_free (dead);
    return status;
}

pg_moved parts_moved (parts_kept *w)
{
    return (pg_moved) { .context = w, .alike = pg_checkpoint_keeper (w->part[0]), .shares = shares,
                        .points = points, .unknowns = unknowns, .bonds = bonds };
}

pg_status parts_field (const parts_kept *w, const pg_writer *writer, long moment, const char *name,
                       size_t components, double *value)
{
    pg_status status = PG_OK;
    double *one = NULL;
    for (int k = 0; k < w->count; k++) {
        size_t n, m = 0;
        int found;
        if (!w->used[k]) continue;
        pg_free (one), one = NULL;
        PG_TRY (writer->read (w->folder, w->divided ? w->count : 0, k, moment, name, &n, &found, &one));
        if ((size_t) found != components) PG_FAIL (PG_E_FILE, "%s: %s has other components", w->folder, name);
        for (size_t i = 0; i < w->problem->cloud.n; i++) {
            if (!owned (w->problem, i)) continue;
            if (w->file[i] == k && w->among[i] >= n)
                PG_FAIL (PG_E_FILE, "%s: %s has too few points", w->folder, name);
            if (w->file[i] == k)
                memcpy (value + m * components, one + w->among[i] * components, components * sizeof *one);
            m++;
        }
    }
done:
    pg_free (one);
    return status;
}
