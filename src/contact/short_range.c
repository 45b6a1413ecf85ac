/* SPDX-License-Identifier: GPL-3.0-or-later
 * Short-range forces between points without an intact bond (perigal/contact.h).
 *
 * Each point sums the forces of its own pairs, so that threads write to separate memory; both directions of a
 * pair round alike: forces are equal and opposite to the last bit. A pair's spring of friction follows the
 * motion d past i across the line between them,
 *
 *     q <- (1 - e e') (q + dt (v_j - v_i)),   T = k_t q,   |T| <= mu F_n: else q is shortened to that.
 *
 * The work taken by the friction springs is summed as in leapfrog, 1/2 (T_n-1 + T_n) . (d_n - d_n-1); less
 * the energy that they store it is the work of friction. */
#include "near_pairs.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Sums over the pairs of a point. */
enum { SUM_ENERGY, SUM_HELD, SUM_TAKEN, SUM_OVERLAP, SUM_RATE, SUM_TOUCHING, SUMS };

pg_status pg_short_range_create (pg_short_range **out, const pg_problem *problem,
                                 const pg_contact_setting *setting, size_t stride)
{
    pg_status status = PG_OK;
    pg_short_range *c = NULL;
    *out = NULL;
    PG_ALLOC (c, 1);
    c->setting = *setting;
    PG_ALLOC (c->force, problem->cloud.n * stride);
    PG_TRY (near_create (&c->near, problem, setting, stride));
    *out = c;
    c = NULL;
done:
    pg_short_range_free (&c);
    return status;
}

void pg_short_range_free (pg_short_range **contact)
{
    pg_short_range *c = *contact;
    if (!c) return;
    near_free (&c->near);
    pg_free (c->sum), pg_free (c->start), pg_free (c->force), pg_free (c->held), pg_free (c->mark);
    pg_free (c);
    *contact = NULL;
}

/* Lattice faces in contact have one contact per point where points face each other, two (2D) or four (3D)
 * where they face gaps; a pair of two materials is at most twice as stiff as the softer one. */
double pg_short_range_rate (const pg_short_range *c)
{
    const pg_problem *p = c->near.problem;
    int several = p->nmaterial > 1, contacts = p->dim == 1 ? 1 : p->dim == 2 ? 2 : 4;
    double most = 0;
    if (c->setting.impulses) return 0;
    for (size_t i = 0; i < p->cloud.n; i++) {
        int m = p->block[PG_NODES][i];
        double mass = p->material[m].density * p->cloud.volume[i];
        most = fmax (most, c->near.modulus[m] * c->near.local[i] / mass);
    }
    return 2 * contacts * (several ? 2 : 1) * c->setting.stiffness * most;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
typedef struct { pg_short_range *c; const double *d, *v; double dt, *f; } summing;

/* Adds the force of one pair on its first point to f (N), and its contributions to `sum`. */
static void one_pair (const summing *w, size_t q, double *f, double *sum)
{
    near_pairs *s = &w->c->near;
    near_pair *p = &s->pair[q];
    const double *x = s->problem->cloud.x;
    size_t dim = s->dim, i = (size_t) p->i, j = (size_t) p->j, a = i * s->stride, b = j * s->stride;
    double e[3] = { 0 }, move[3] = { 0 }, rr = 0, *slip = s->slips ? s->slip + 3 * q : NULL;
    for (size_t k = 0; k < dim; k++) {
        e[k] = (x[j * dim + k] - x[i * dim + k]) + (w->d[b + k] - w->d[a + k]);
        rr += e[k] * e[k];
    }
    double r = sqrt (rr);
    if (r >= p->full) p->reach = p->full;  /* after separation the usual contact distance applies */
    double overlap = p->reach - r, press = p->k * overlap, across = p->k * p->share;
    int touches = overlap > 0 && r > 0;
    for (size_t k = 0; slip && k < dim; k++) move[k] = w->dt > 0 ? w->dt * (w->v[b + k] - w->v[a + k]) : 0;
    /* first half of the work of the friction spring in this step, by its force at the beginning */
    for (size_t k = 0; slip && k < dim; k++) sum[SUM_TAKEN] += 0.25 * across * slip[k] * move[k];
    if (!touches) {
        if (slip) memset (slip, 0, 3 * sizeof *slip);
        return;
    }
    for (size_t k = 0; k < dim; k++) e[k] /= r, f[k] -= press * e[k];
    sum[SUM_ENERGY] += 0.25 * press * overlap;         /* half for each of the two points */
    sum[SUM_OVERLAP] = fmax (sum[SUM_OVERLAP], overlap);
    sum[SUM_RATE] += 2 * p->k, sum[SUM_TOUCHING] += 0.5;
    if (!slip) return;
    double along = 0, length = 0, limit = w->c->setting.coefficient * press, shorten = 1;
    for (size_t k = 0; k < dim; k++) slip[k] += move[k], along += slip[k] * e[k];
    for (size_t k = 0; k < dim; k++) slip[k] -= along * e[k], length += slip[k] * slip[k];
    length = sqrt (length);
    if (across * length > limit) shorten = limit / (across * length);
    for (size_t k = 0; k < dim; k++) {
        slip[k] *= shorten;
        f[k] += across * slip[k];
        sum[SUM_TAKEN] += 0.25 * across * slip[k] * move[k];
        sum[SUM_HELD] += 0.25 * across * slip[k] * slip[k];
    }
}

/* Sums the forces of the pairs of rows first .. last - 1. */
static void sum_rows (void *context, size_t first, size_t last, int thread)
{
    const summing *w = context;
    near_pairs *s = &w->c->near;
    const pg_problem *p = s->problem;
    (void) thread;
    for (size_t r = first; r < last; r++) {
        double f[3] = { 0 }, *sum = w->c->sum + r * SUMS;
        size_t i = (size_t) s->pair[s->row[r]].i;
        memset (sum, 0, SUMS * sizeof *sum);
        for (size_t q = s->row[r]; q < s->row[r + 1]; q++) one_pair (w, q, f, sum);
        if (!(sum[SUM_TOUCHING] > 0)) continue;
        memcpy (w->c->force + i * s->stride, f, s->dim * sizeof *f);
        sum[SUM_RATE] /= p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i];
        for (size_t k = 0; k < s->dim; k++) w->f[i * s->stride + k] += f[k];
    }
}

pg_status pg_short_range_add (pg_short_range *c, const pg_state *state, const pg_changes *broken, int changed,
                              const double *v, double dt, double way, double *f)
{
    pg_status status = PG_OK;
    double total[SUMS] = { 0 };
    for (size_t r = 0; r < c->near.nrow; r++)
        memset (c->force + (size_t) c->near.pair[c->near.row[r]].i * c->near.stride, 0,
                c->near.dim * sizeof *c->force);
    PG_TRY (near_update (&c->near, state, broken, changed, way));
    PG_GROW (c->sum, c->cap, c->near.nrow * SUMS);
    summing w = { c, state->d, v, dt, f };
    pg_parallel (c->near.problem->threads, c->near.nrow, sum_rows, &w);
    for (size_t r = 0; r < c->near.nrow; r++) {
        const double *sum = c->sum + r * SUMS;
        for (int k = 0; k < SUMS; k++)
            total[k] = k == SUM_OVERLAP || k == SUM_RATE ? fmax (total[k], sum[k]) : total[k] + sum[k];
    }
    c->taken += total[SUM_TAKEN];
    pg_short_range_report *now = &c->now;
    now->listed = c->near.n / 2, now->touching = (size_t) (total[SUM_TOUCHING] + 0.5);
    now->searches = c->near.searches, now->evaluations++, now->free += c->near.n == 0;
    now->energy = total[SUM_ENERGY] + total[SUM_HELD];
    now->friction = c->taken - total[SUM_HELD];
    now->overlap = total[SUM_OVERLAP];
    now->overlap_max = fmax (now->overlap_max, now->overlap), now->rate = fmax (now->rate, total[SUM_RATE]);
done:
    return status;
}

const double *pg_short_range_forces (const pg_short_range *c) { return c->force; }
const pg_short_range_report *pg_short_range_now (const pg_short_range *c) { return &c->now; }

/* ---- memory -------------------------------------------------------------------------------------------- */
/* Saves the current slips, from the list or from `memory`. */
pg_status pg_short_range_save (pg_short_range *c)
{
    pg_status status = PG_OK;
    PG_TRY (near_collect (&c->near));
    PG_GROW (c->start, c->cap_start, c->near.nmemory);
    if (c->near.nmemory) memcpy (c->start, c->near.memory, c->near.nmemory * sizeof *c->start);
    c->nstart = c->near.nmemory, c->taken0 = c->taken, c->pending0 = c->pending;
done:
    return status;
}

/* Restores the saved slips; the list is searched anew, as bonds may be intact again. */
pg_status pg_short_range_return (pg_short_range *c)
{
    pg_status status = PG_OK;
    c->near.valid = 0, c->near.nmemory = 0;
    PG_GROW (c->near.memory, c->near.cap_memory, c->nstart);
    if (c->nstart) memcpy (c->near.memory, c->start, c->nstart * sizeof *c->start);
    c->near.nmemory = c->nstart, c->taken = c->taken0, c->pending = c->pending0;
done:
    return status;
}

static pg_status keep_slips (near_memory **memory, size_t *n, size_t *cap, const char *name, size_t npoint,
                             const pg_keeper *k)
{
    pg_status status = PG_OK;
    PG_KEEP_LENGTH (k, name, "count", *memory, *n, *cap, 1L << 40, "the number of pairs in contact");
    near_memory *m = *memory;
    PG_TRY (pg_keep_fields (k, name, "ends", "slips", *n, PG_ROWS (
        PG_EACH_IN (m, i, 0, npoint - 1, "a point in contact"),
        PG_EACH_IN (m, j, 0, npoint - 1, "a point in contact"), PG_EACH (m, slip), PG_EACH (m, reach))));
done:
    return status;
}

/* Writes or reads slips and energies; the list itself is searched anew. */
pg_status pg_short_range_keep (pg_short_range *c, const pg_keeper *k)
{
    pg_status status = PG_OK;
    size_t npoint = c->near.problem->cloud.n;
    if (!k->reading) PG_TRY (near_collect (&c->near));
    PG_TRY (keep_slips (&c->near.memory, &c->near.nmemory, &c->near.cap_memory, "contact.slips", npoint, k));
    PG_TRY (keep_slips (&c->start, &c->nstart, &c->cap_start, "contact.slips0", npoint, k));
    PG_TRY (pg_keep_fields (k, "contact", NULL, "numbers", 1, PG_ROWS (
        PG_KEPT (c->taken), PG_KEPT (c->taken0), PG_KEPT (c->now.energy), PG_KEPT (c->now.friction),
        PG_KEPT (c->now.overlap_max), PG_KEPT (c->now.rate), PG_KEPT (c->pending), PG_KEPT (c->pending0))));
    if (k->reading) c->near.valid = 0;
done:
    return status;
}

pg_status pg_short_range_pairs (const pg_short_range *c, const pg_state *state, size_t *n,
                                pg_contact_pair **pair)
{
    pg_status status = PG_OK;
    const near_pairs *s = &c->near;
    size_t cap = 0;
    *n = 0, *pair = NULL;
    for (size_t q = 0; q < s->n; q++) {
        const near_pair *p = &s->pair[q];
        double rr = 0;
        if (p->i > p->j) continue;
        for (size_t k = 0; k < s->dim; k++)
            rr += pow ((s->problem->cloud.x[(size_t) p->j * s->dim + k]
                        - s->problem->cloud.x[(size_t) p->i * s->dim + k])
                           + (state->d[(size_t) p->j * s->stride + k]
                              - state->d[(size_t) p->i * s->stride + k]), 2);
        if (!(sqrt (rr) < p->reach)) continue;
        PG_GROW (*pair, cap, *n + 1);
        (*pair)[(*n)++] = (pg_contact_pair) { p->i, p->j };
    }
done:
    if (status != PG_OK) pg_free (*pair), *pair = NULL, *n = 0;
    return status;
}
