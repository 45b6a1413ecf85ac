/* SPDX-License-Identifier: GPL-3.0-or-later
 * How a lattice is divided among ranks: recursive bisection (Berger and Bokhari 1987) of its box by the
 * numbers of cells inside the body, so that bodies with holes, and round ones, give every rank about as
 * much. */
#include "perigal/ranks.h"
#include <math.h>
#include <string.h>

/* A box that is still to be cut, across `axis`, for the ranks first .. first + ranks - 1; `at`: index of its
 * first plane in the counts of cells. */
typedef struct { pg_box box; int first, ranks, axis; size_t at; } piece;

/* Length of the box along axis k; 0 if it has a single plane of cells there and cannot be cut. */
static double length (const pg_box *b, const double *steps, int k)
{
    int n = b->high[k] - b->low[k];
    return n > 1 ? n * steps[k] : 0;
}
static int longest (const pg_box *b, const double *steps)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (length (b, steps, k) > length (b, steps, axis) * (1 + 1e-9)) axis = k;
    return axis;
}

/* Counts the cells inside the body in every plane of the pieces to be cut, all pieces in one array: the
 * planes are dealt out to the ranks in turn, and the counts summed over the ranks. */
static pg_status count_planes (double **planes, piece *list, size_t n, const double *steps,
                               pg_plane_count count, const void *context)
{
    pg_status status = PG_OK;
    size_t all = 0;
    for (size_t i = 0; i < n; i++) {
        list[i].axis = longest (&list[i].box, steps), list[i].at = all;
        all += (size_t) (list[i].box.high[list[i].axis] - list[i].box.low[list[i].axis]);
    }
    PG_ALLOC (*planes, all);
    for (size_t i = 0; i < n; i++) {
        int axis = list[i].axis, low = list[i].box.low[axis];
        for (int p = low; p < list[i].box.high[axis] && list[i].ranks > 1; p++)
            if ((int) ((list[i].at + (size_t) (p - low)) % (size_t) pg_rank_count ()) == pg_rank ())
                (*planes)[list[i].at + (size_t) (p - low)] = count (context, &list[i].box, axis, p);
    }
    PG_TRY (pg_ranks_sum (all, *planes));
done:
    return status;
}

/* Returns the plane at which the piece is cut: its lower part, for half of the ranks, gets their share of the
 * cells, at least one plane and not all. */
static int cut_at (const piece *p, const double *planes)
{
    int low = p->box.low[p->axis], high = p->box.high[p->axis], best = low + 1;
    double total = 0, sum = 0, least = INFINITY;
    for (int k = low; k < high; k++) total += planes[p->at + (size_t) (k - low)];
    double goal = total * (p->ranks / 2) / p->ranks;
    for (int k = low + 1; k < high; k++) {
        sum += planes[p->at + (size_t) (k - 1 - low)];
        if (fabs (sum - goal) < least) least = fabs (sum - goal), best = k;
    }
    return best;
}

pg_status pg_boxes_divide (pg_box *out, const pg_box *whole, const double *steps, int size,
                           pg_plane_count count, const void *context)
{
    pg_status status = PG_OK;
    piece *list = NULL, *next = NULL;
    double *planes = NULL;
    size_t n = 1;
    int more = size > 1;
    PG_ALLOC (list, (size_t) size);
    PG_ALLOC (next, (size_t) size);
    list[0] = (piece) { .box = *whole, .ranks = size };
    for (; more; more = n < (size_t) size) {
        size_t made = 0;
        PG_TRY (count_planes (&planes, list, n, steps, count, context));
        for (size_t i = 0; i < n; i++) {
            piece low = list[i], high = list[i];
            int axis = list[i].axis;
            if (list[i].ranks == 1) {
                next[made++] = list[i];
                continue;
            }
            if (list[i].box.high[axis] - list[i].box.low[axis] < 2)
                PG_FAIL (PG_E_LIMIT, "the body is too small to be divided among %d ranks: take fewer", size);
            int at = cut_at (&list[i], planes);
            low.box.high[axis] = high.box.low[axis] = at;
            low.ranks = list[i].ranks / 2, high.ranks -= low.ranks, high.first += low.ranks;
            next[made++] = low, next[made++] = high;
        }
        piece *swap = list;
        list = next, next = swap, n = made;
        pg_free (planes), planes = NULL;
    }
    for (size_t i = 0; i < n; i++) out[list[i].first] = list[i].box;
done:
    pg_free (list), pg_free (next), pg_free (planes);
    return status;
}
