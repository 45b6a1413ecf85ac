/* SPDX-License-Identifier: GPL-3.0-or-later
 * Contact by impulses of points without an intact bond (perigal/contact.h): in each time step the forces are
 * computed with which no pair ends it nearer than its contact distance.
 *
 * Leapfrog goes from x_n-1 over x_n to x_n+1; D- and D+ are the relative displacements of a pair in both
 * steps. The force F_n e of a pair, along its line at x_n, does the work F_n e . (D- + D+) / 2. Pairs that
 * would come too near get
 *
 *     F_n >= 0,   e . (D- + D+) >= 0,   F_n e . (D- + D+) = 0:
 *
 * Moreau's law of impact without loss, for the displacements of two steps. The distance at x_n+1 is that at
 * x_n-1, if that was large enough; contact conserves energy, and forces on the two points are opposite, along
 * their line. Friction holds the two together across the line, D+ = 0, with at most coefficient F_n. As pairs
 * share points, the pairs are swept until nothing changes, in fixed order by one thread. */
#include "near_pairs.h"
#include <math.h>
#include <string.h>

enum { SWEEPS = 400 };
static const double settled = 1e-9;  /* convergence: largest displacement by a sweep, spacings */

/* A pair with a contact force in this step. */
struct held_pair {
    size_t i, j;
    double y[3], e[3];                                 /* vector from i to j, m; its unit vector */
    double least;                                      /* least distance allowed at the end of the step, m */
    double lift;  /* by which the distance at x_n-1 was below `least`, m */
    double along, across;  /* relative displacement by a unit normal, shear force, m/N */
    double press, shear[3];                            /* normal and shear force on j, N */
    int    spread;                                     /* 1: all pairs of its points are listed */
};

/* ---- selection of pairs -------------------------------------------------------------------------------- */
static void way_of (const pg_short_range *c, const pg_point_ways *w, size_t i, size_t j, double *back,
                    double *ahead)
{
    size_t dim = c->near.dim, a = i * c->near.stride, b = j * c->near.stride;
    for (size_t k = 0; k < dim; k++) {
        back[k] = w->back[b + k] - w->back[a + k];
        ahead[k] = (w->ahead[b + k] + w->gain * w->inverse[b + k] * c->force[b + k])
                   - (w->ahead[a + k] + w->gain * w->inverse[a + k] * c->force[a + k]);
    }
}

/* Least distance of pair q at the end of the step, m: its contact distance; if it is already nearer (a bond
 * that broke under pressure), the lesser distance at x_n and x_n-1. y: vector between the points, m; *lift:
 * amount by which the distance at x_n-1 was smaller, m. */
static double least_of (const pg_short_range *c, const double *d, size_t q, const double *back, double *y,
                        double *lift)
{
    const near_pairs *s = &c->near;
    const near_pair *p = &s->pair[q];
    const double *x = s->problem->cloud.x;
    size_t i = (size_t) p->i, j = (size_t) p->j;
    double now = 0, before = 0;
    for (size_t k = 0; k < s->dim; k++) {
        y[k] = (x[j * s->dim + k] - x[i * s->dim + k]) + (d[j * s->stride + k] - d[i * s->stride + k]);
        now += y[k] * y[k], before += (y[k] - back[k]) * (y[k] - back[k]);
    }
    double least = now >= p->reach * p->reach ? p->reach : fmin (p->reach, sqrt (fmin (now, before)));
    *lift = fmax (0, least - sqrt (before));
    return least;
}

static int too_near (size_t dim, const double *y, const double *ahead, double least)
{
    double rr = 0;
    for (size_t k = 0; k < dim; k++) rr += (y[k] + ahead[k]) * (y[k] + ahead[k]);
    return rr < least * least;
}

typedef struct { pg_short_range *c; const double *d; const pg_point_ways *w; } looking;

/* Marks the pairs of some rows that would end the step too near each other without contact forces, and finds
 * the largest overlap of each row. */
static void look_at_rows (void *context, size_t first, size_t last, int thread)
{
    const looking *l = context;
    const near_pairs *s = &l->c->near;
    (void) thread;
    for (size_t r = first; r < last; r++) {
        double most = 0;
        for (size_t q = s->row[r]; q < s->row[r + 1]; q++) {
            double back[3], ahead[3], y[3], rr = 0, lift;
            l->c->mark[q] = 0;
            if (s->pair[q].i > s->pair[q].j) continue;
            way_of (l->c, l->w, (size_t) s->pair[q].i, (size_t) s->pair[q].j, back, ahead);
            double least = least_of (l->c, l->d, q, back, y, &lift);
            for (size_t k = 0; k < s->dim; k++) rr += y[k] * y[k];
            most = fmax (most, s->pair[q].reach - sqrt (rr));
            l->c->mark[q] = rr > 0 && too_near (s->dim, y, ahead, least);
        }
        l->c->sum[r] = most;
    }
}

/* Adds pair q (with i < j) to the list of pairs with contact forces. */
static pg_status take_pair (pg_short_range *c, const double *d, const pg_point_ways *w, size_t q)
{
    pg_status status = PG_OK;
    const near_pairs *s = &c->near;
    double back[3], ahead[3], rr = 0;
    PG_GROW (c->held, c->cap_held, c->nheld + 1);
    held_pair *h = &c->held[c->nheld];
    *h = (held_pair) { .i = (size_t) s->pair[q].i, .j = (size_t) s->pair[q].j };
    way_of (c, w, h->i, h->j, back, ahead);
    h->least = least_of (c, d, q, back, h->y, &h->lift);
    for (size_t k = 0; k < s->dim; k++) rr += h->y[k] * h->y[k];
    c->mark[q] = 2;
    if (!(rr > 0)) goto done;
    for (size_t k = 0; k < s->dim; k++) {
        double gives = w->gain * (w->inverse[h->i * s->stride + k] + w->inverse[h->j * s->stride + k]);
        h->e[k] = h->y[k] / sqrt (rr);
        h->along += h->e[k] * h->e[k] * gives, h->across = fmax (h->across, gives);
    }
    if (h->along > 0) c->nheld++;                      /* else both points are prescribed */
done:
    return status;
}

/* Row of point i in the list of pairs (bisection); SIZE_MAX: none. */
static size_t row_of (const near_pairs *s, size_t i)
{
    size_t low = 0, high = s->nrow;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((size_t) s->pair[s->row[middle]].i < i) low = middle + 1;
        else high = middle;
    }
    return low < s->nrow && (size_t) s->pair[s->row[low]].i == i ? low : SIZE_MAX;
}

/* Adds all pairs of a point moved by a contact force, as any of them may come too near. */
static pg_status take_neighbours (pg_short_range *c, const double *d, const pg_point_ways *w, size_t i)
{
    pg_status status = PG_OK;
    const near_pairs *s = &c->near;
    size_t r = row_of (s, i);
    if (r == SIZE_MAX) return PG_OK;
    for (size_t q = s->row[r]; q < s->row[r + 1]; q++) {
        size_t at = q;
        if (s->pair[q].i > s->pair[q].j) {             /* pairs are marked in the row of the lower point */
            size_t other = row_of (s, (size_t) s->pair[q].j);
            at = s->row[other];
            while (s->pair[at].j != s->pair[q].i) at++;
        }
        if (c->mark[at] != 2) PG_TRY (take_pair (c, d, w, at));
    }
done:
    return status;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
static void push (pg_short_range *c, const held_pair *h, const double *f)
{
    for (size_t k = 0; k < c->near.dim; k++)
        c->force[h->j * c->near.stride + k] += f[k], c->force[h->i * c->near.stride + k] -= f[k];
}

/* Solves the forces of one pair with those of all others fixed; returns the displacement that the change
 * causes, m. */
static double hold (pg_short_range *c, const pg_point_ways *w, held_pair *h)
{
    size_t dim = c->near.dim;
    double back[3], ahead[3], f[3] = { 0 }, rate = -h->lift, moved, along = 0, size = 0, change = 0;
    way_of (c, w, h->i, h->j, back, ahead);
    if (!(h->press > 0) && !too_near (dim, h->y, ahead, h->least)) return 0;
    for (size_t k = 0; k < dim; k++) rate += h->e[k] * (back[k] + ahead[k]);
    double more = fmax (-h->press, -rate / h->along), limit;
    h->press += more, limit = c->setting.coefficient * h->press;
    for (size_t k = 0; k < dim; k++) f[k] = more * h->e[k];
    push (c, h, f);
    moved = fabs (more) * h->along;
    if (!c->near.slips) return moved;
    way_of (c, w, h->i, h->j, back, ahead);
    for (size_t k = 0; k < dim; k++) along += h->e[k] * ahead[k];
    for (size_t k = 0; k < dim; k++) {
        f[k] = h->shear[k] - (ahead[k] - along * h->e[k]) / h->across;
        size += f[k] * f[k];
    }
    double shorten = size > limit * limit ? limit / sqrt (size) : 1;
    for (size_t k = 0; k < dim; k++) {
        f[k] = shorten * f[k] - h->shear[k], h->shear[k] += f[k];
        change = fmax (change, fabs (f[k]));
    }
    push (c, h, f);
    return moved + change * h->across;
}

/* Records work: of friction in the half steps before and after; now->energy: kinetic energy that pairs have
 * taken and give back in the half step after. */
static void book (pg_short_range *c, const pg_point_ways *w)
{
    size_t dim = c->near.dim;
    pg_short_range_report *now = &c->now;
    c->taken += c->pending;
    c->pending = 0, now->energy = 0, now->touching = 0;
    for (size_t q = 0; q < c->nheld && !w->start; q++) {
        const held_pair *h = &c->held[q];
        double back[3], ahead[3];
        if (!(h->press > 0)) continue;
        way_of (c, w, h->i, h->j, back, ahead);
        now->touching++;
        for (size_t k = 0; k < dim; k++) {
            now->energy -= 0.5 * h->press * h->e[k] * back[k];
            c->taken -= 0.5 * h->shear[k] * back[k], c->pending -= 0.5 * h->shear[k] * ahead[k];
        }
    }
    now->friction = c->taken;
}

/* Sweeps over the pairs until nothing changes; pairs of points that are moved are added. */
static pg_status hold_all (pg_short_range *c, const double *d, const pg_point_ways *w)
{
    pg_status status = PG_OK;
    double small = settled * c->near.finest, moved = INFINITY;
    int sweep = 0;
    for (; sweep < SWEEPS && moved > small; sweep++) {
        moved = 0;
        for (size_t q = 0; q < c->nheld; q++) {
            size_t i = c->held[q].i, j = c->held[q].j;
            double by = hold (c, w, &c->held[q]);
            moved = fmax (moved, by);
            if (!(by > 0) || c->held[q].spread) continue;
            c->held[q].spread = 1;
            PG_TRY (take_neighbours (c, d, w, i));
            PG_TRY (take_neighbours (c, d, w, j));
        }
    }
    c->now.sweeps += sweep, c->now.unsettled += moved > small;
done:
    return status;
}

pg_status pg_short_range_hold (pg_short_range *c, const pg_state *state, const pg_changes *broken,
                               int changed,
                               const pg_point_ways *ways, double way, double *f)
{
    pg_status status = PG_OK;
    near_pairs *s = &c->near;
    pg_short_range_report *now = &c->now;
    for (size_t r = 0; r < s->nrow; r++)
        memset (c->force + (size_t) s->pair[s->row[r]].i * s->stride, 0, s->dim * sizeof *c->force);
    PG_TRY (near_update (s, state, broken, changed, way));
    PG_GROW (c->mark, c->cap_mark, s->n);
    PG_GROW (c->sum, c->cap, s->nrow);
    looking l = { c, state->d, ways };
    pg_parallel (s->problem->threads, s->nrow, look_at_rows, &l);
    c->nheld = 0, now->overlap = 0;
    for (size_t r = 0; r < s->nrow; r++) now->overlap = fmax (now->overlap, c->sum[r]);
    for (size_t q = 0; q < s->n; q++) if (c->mark[q] == 1) PG_TRY (take_pair (c, state->d, ways, q));
    if (c->nheld) PG_TRY (hold_all (c, state->d, ways));
    book (c, ways);
    for (size_t r = 0; r < s->nrow; r++) {
        size_t i = (size_t) s->pair[s->row[r]].i * s->stride;
        for (size_t k = 0; k < s->dim; k++) f[i + k] += c->force[i + k];
    }
    now->listed = s->n / 2, now->searches = s->searches, now->evaluations++, now->free += s->n == 0;
    now->overlap_max = fmax (now->overlap_max, now->overlap);
done:
    return status;
}
