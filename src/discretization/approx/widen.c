/* SPDX-License-Identifier: GPL-3.0-or-later
 * Wider supports for positions with too few neighbours. In the corner of a cut cell, beside a crack, or
 * where points are sparse, a position may have so few neighbours, or neighbours so nearly on a line, that
 * its basis is lowered to a constant, or that N and dN are large multiples of what they are elsewhere. Only
 * values at evaluation points enter the weak form, so that N need not be continuous between them: each may
 * have a support of its own. */
#include "perigal/approx.h"
#include <math.h>
#include <string.h>

/* Radii of the supports that are tried, over the usual one; up to for_full a quadratic basis is sought before
 * a linear one is accepted. */
static const double factors[] = { 1.15, 1.3, 1.45, 1.6, 1.8, 2, 2.25, PG_WIDEST_SUPPORT };
static const double for_full = 1.6;
/* CHUNK: positions at a time, which bounds the memory. SAMPLE: positions that are sampled to judge the whole
 * body. complete: on a lattice a position is examined if it has fewer neighbours than this share of those in
 * a whole support. */
enum { CHUNK = 16384, SAMPLE = 256 };
static const double complete = 0.85;
/* If more than this share of the positions has a lowered basis, the horizon is too small for the basis
 * everywhere, and wider supports of single positions are no remedy. */
static const double usual = 0.1;
/* A position counts as surrounded by its neighbours if their mean lies within MIDST horizons of it. */
static const double MIDST = 0.1;
/* Quality of the basis at a position. */
enum { POOR, LOWERED, GOOD };

typedef struct {
    pg_approx a;
    const pg_rows *rows;
    const pg_cloud *cloud;
    pg_sight sees;
    void *context;
    int threads;
    /* Positions that are to be improved: their number n, their row numbers (place), and of the neighbours in
     * the best support so far where they begin in `node` (at) and how many they are (count). */
    size_t n, *place, *at, *count;
    /* 1: most sampled positions that are surrounded by irregular points have too poor a basis: the horizon is
     * too small. */
    int too_small;
    unsigned char *best;
    double *factor;
    int *node;  size_t used, cap;
} work;

/* A group of positions as rows of their own; place: their numbers in w->rows. sight: POOR, LOWERED or
 * GOOD. */
typedef struct { const work *w; const size_t *place; pg_rows rows; unsigned char *alive, *sight; } lot;

static void lot_clear (lot *l)
{
    pg_rows_clear (&l->rows);
    pg_free (l->alive), pg_free (l->sight);
}

static double spacing_at (const pg_cloud *c, const pg_rows *r, size_t i)
{
    double least = INFINITY, h = c->h;
    for (size_t e = r->family.start[i]; c->size && e < r->family.start[i + 1]; e++) {
        double away = 0;
        size_t j = (size_t) r->family.node[e], dim = (size_t) c->dim;
        for (size_t k = 0; k < dim; k++) away += pow (c->x[j * dim + k] - r->x[i * dim + k], 2);
        if (away < least) least = away, h = c->size[j] / pg_cloud_slender (c, j);
    }
    return h;
}

/* Quality of the basis at row i, by its grade and by the sums of |N| and |dN|. */
static int judge (const work *w, const pg_rows *r, size_t i)
{
    double value = 0, slope = 0, h = spacing_at (w->cloud, r, i);
    size_t dim = (size_t) r->dim;
    if (r->grade[i] > PG_GRADE_LOWERED) return POOR;
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++) {
        double square = 0;
        for (size_t k = 0; k < dim; k++) square += r->dN[e * dim + k] * r->dN[e * dim + k];
        value += fabs (r->N[e]), slope += sqrt (square);
    }
    int quadratic = w->a.order == 2 && r->grade[i] == PG_GRADE_FULL;
    if (!(value <= (quadratic ? 20 : 6) && slope * h <= (quadratic ? 60 : 25))) return POOR;
    return r->grade[i] == PG_GRADE_LOWERED ? LOWERED : GOOD;
}

static void look (void *context, size_t first, size_t last, int thread)
{
    const lot *l = context;
    const pg_family *f = &l->rows.family;
    (void) thread;
    for (size_t i = first; i < last; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            l->alive[e] = l->w->sees (l->w->context, l->place[i], f->node[e]) != 0;
}

static void judge_those (void *context, size_t first, size_t last, int thread)
{
    const lot *l = context;
    (void) thread;
    for (size_t i = first; i < last; i++) l->sight[i] = (unsigned char) judge (l->w, &l->rows, i);
}

/* Evaluates the rows of a lot, whose families are known, and judges the basis of each. */
static pg_status measure (lot *l)
{
    pg_status status = PG_OK;
    const work *w = l->w;
    PG_TRY (pg_rows_values (&l->rows));
    PG_ALLOC (l->sight, l->rows.n);
    if (w->sees) {
        PG_ALLOC (l->alive, l->rows.family.start[l->rows.n]);
        pg_parallel (w->threads, l->rows.n, look, l);
    }
    PG_TRY (w->a.type->evaluate (&w->a, w->cloud, &l->rows, l->alive, l->rows.n, NULL, w->threads));
    pg_parallel (w->threads, l->rows.n, judge_those, l);
done:
    return status;
}

/* Functions of the quadratic basis, by dimension. */
static const int functions[] = { 3, 6, 10 };

/* Number of nodes that a whole support holds on a lattice, estimated by its volume. */
static double whole_support (const work *w)
{
    const pg_cloud *c = w->cloud;
    double r = w->a.horizon / c->h;
    if (c->dim == 2) return w->a.shape == PG_TENSOR ? 4 * r * r : M_PI * r * r;
    if (c->dim == 3) return w->a.shape == PG_TENSOR ? 8 * r * r * r : 4 * M_PI / 3 * r * r * r;
    return 2 * r;
}

/* Nodes of the lattice within the horizon of one of them, itself included. */
static int nodes_within (const work *w)
{
    const pg_cloud *c = w->cloud;
    int count = 0, most[3] = { 0 };
    for (int k = 0; k < c->dim; k++) most[k] = (int) (w->a.horizon / c->step[k]);
    for (int i = -most[0]; i <= most[0]; i++)
        for (int j = -most[1]; j <= most[1]; j++)
            for (int k = -most[2]; k <= most[2]; k++) {
                double z[3] = { i * c->step[0], j * c->step[1], k * c->step[2] };
                double away = hypot (hypot (z[0], z[1]), z[2]);
                count += w->a.shape == PG_TENSOR || away < w->a.horizon * (1 - 1e-9);
            }
    return count;
}

/* Could the basis at position i be poor? Always possible away from a lattice; on a lattice only where
 * neighbours are missing. */
static int suspect (const work *w, size_t i)
{
    const pg_cloud *c = w->cloud;
    const pg_family *f = &w->rows->family;
    size_t seen = f->start[i + 1] - f->start[i];
    if (!c->regular || c->size) return 1;
    for (size_t e = f->start[i]; w->sees && e < f->start[i + 1]; e++)
        seen -= !w->sees (w->context, i, f->node[e]);
    return (double) seen < complete * whole_support (w);
}

/* A node without any neighbour within its horizon: it is reported elsewhere and gets no wider support. */
static int is_apart (const work *w, size_t i)
{
    const pg_family *f = &w->rows->family;
    return w->rows->own[i] >= 0 && w->cloud->n > 1 && f->start[i + 1] - f->start[i] <= 1;
}

/* Copies the positions and families of a lot from the rows being worked on. */
static pg_status take (lot *l, size_t n)
{
    pg_status status = PG_OK;
    const pg_rows *r = l->w->rows;
    size_t dim = (size_t) r->dim, bonds = 0;
    l->rows = (pg_rows) { .dim = r->dim, .n = n };
    l->rows.family.n = n;
    PG_ALLOC (l->rows.x, n * dim);
    PG_ALLOC (l->rows.own, n);
    PG_ALLOC (l->rows.family.start, n + 1);
    for (size_t i = 0; i < n; i++) {
        size_t p = l->place[i];
        memcpy (l->rows.x + i * dim, r->x + p * dim, dim * sizeof *r->x);
        l->rows.own[i] = r->own[p];
        bonds += r->family.start[p + 1] - r->family.start[p];
        l->rows.family.start[i + 1] = bonds;
    }
    PG_ALLOC (l->rows.family.node, bonds);
    for (size_t i = 0; i < n; i++) {
        size_t p = l->place[i], from = r->family.start[p];
        memcpy (l->rows.family.node + l->rows.family.start[i], r->family.node + from,
                (r->family.start[p + 1] - from) * sizeof *r->family.node);
    }
done:
    return status;
}

/* On a lattice: is the basis lowered even at positions with whole supports? Examines a sample of the
 * positions that are not suspect, evenly spaced among the rows. */
static pg_status whole_are_lowered (const work *w, int *answer)
{
    pg_status status = PG_OK;
    size_t list[SAMPLE], n = 0, lowered = 0, step = w->rows->n / SAMPLE + 1;
    lot l = { .w = w, .place = list };
    for (size_t i = 0; i < w->rows->n && n < SAMPLE; i++)
        if (!suspect (w, i)) list[n++] = i, i += step - 1;
    *answer = 0;
    if (n == 0) return PG_OK;
    PG_TRY (take (&l, n));
    PG_TRY (measure (&l));
    for (size_t k = 0; k < n; k++) lowered += l.sight[k] == LOWERED;
    *answer = (double) lowered > usual * (double) n;
done:
    lot_clear (&l);
    return status;
}

/* Is position k of a lot surrounded by its neighbours (MIDST)? */
static int in_midst (const lot *l, size_t k)
{
    const pg_family *f = &l->rows.family;
    size_t dim = (size_t) l->rows.dim, count = f->start[k + 1] - f->start[k];
    double square = 0, reach = MIDST * l->w->a.horizon;
    for (size_t c = 0; c < dim; c++) {
        double sum = 0;
        for (size_t e = f->start[k]; e < f->start[k + 1]; e++)
            sum += l->w->cloud->x[(size_t) f->node[e] * dim + c] - l->rows.x[k * dim + c];
        square += sum * sum / (double) (count * count);
    }
    return count > 0 && square < reach * reach;
}

/* Shares of positions amid irregular points whose basis is less than GOOD, and POOR. The positions lie about
 * a Gauss point away from some of the nodes and do not depend on the rows at hand: all sets of rows of a
 * cloud must decide alike, as one position may be in two of them, as a point of a facet and of the face of
 * its cell. */
static pg_status look_amidst (const work *w, double *less, double *little)
{
    pg_status status = PG_OK;
    const pg_cloud *c = w->cloud;
    size_t dim = (size_t) c->dim, step = c->n / SAMPLE + 1, n = 0, inner = 0, lowered = 0, poor = 0;
    work alone = *w;
    lot l = { .w = &alone };
    double *x = NULL;
    pg_family_search *search = NULL;
    alone.sees = NULL;
    *less = *little = 0;
    PG_ALLOC (x, SAMPLE * dim);
    for (size_t i = 0; i < c->n; i += step, n++) {
        double h = c->size ? c->size[i] / pg_cloud_slender (c, i) : c->h;
        for (size_t k = 0; k < dim; k++) x[n * dim + k] = c->x[i * dim + k] + (n >> k & 1 ? 0.29 : -0.29) * h;
    }
    PG_TRY (pg_rows_search (&search, &w->a, c));
    PG_TRY (pg_rows_place (&l.rows, search, c, n, x, NULL, NULL, NULL, NULL, w->threads));
    PG_TRY (measure (&l));
    for (size_t k = 0; k < n; k++)
        if (in_midst (&l, k)) inner++, lowered += l.sight[k] != GOOD, poor += l.sight[k] == POOR;
    if (inner) *less = (double) lowered / (double) inner, *little = (double) poor / (double) inner;
done:
    lot_clear (&l);
    pg_family_search_free (&search);
    pg_free (x);
    return status;
}

/* Finds the positions whose basis is less than GOOD with their present supports. */
static pg_status find_poor (work *w)
{
    pg_status status = PG_OK;
    size_t *list = NULL, n = 0, looked = 0, lowered = 0, cap = 0, cap_best = 0;
    int everywhere = 0;
    lot l = { .w = w };
    PG_ALLOC (list, w->rows->n < CHUNK ? w->rows->n : CHUNK);
    for (size_t i = 0; i < w->rows->n; i++) {
        if (suspect (w, i) && !is_apart (w, i)) list[n++] = i;
        if (n == 0 || (n < CHUNK && i + 1 < w->rows->n)) continue;
        l.place = list;
        PG_TRY (take (&l, n));
        PG_TRY (measure (&l));
        for (size_t k = 0; k < n; k++) {
            if (l.sight[k] == GOOD) continue;
            PG_GROW (w->place, cap, w->n + 1);
            PG_GROW (w->best, cap_best, w->n + 1);
            lowered += l.sight[k] == LOWERED;
            w->place[w->n] = list[k], w->best[w->n++] = l.sight[k];
        }
        looked += n, n = 0;
        lot_clear (&l);
        l = (lot) { .w = w };
    }
    if (w->n > 0 && !w->cloud->regular) {
        double less, little;
        PG_TRY (look_amidst (w, &less, &little));
        everywhere = less > usual, w->too_small = little > usual;
    } else if (looked == w->rows->n)
        everywhere = w->a.order == 2 && nodes_within (w) < functions[w->cloud->dim - 1];
    else if (lowered) PG_TRY (whole_are_lowered (w, &everywhere));
    if (everywhere) {
        size_t kept = 0;
        for (size_t k = 0; k < w->n; k++)
            if (w->best[k] == POOR) w->place[kept] = w->place[k], w->best[kept++] = POOR;
        w->n = kept;
    }
done:
    lot_clear (&l);
    pg_free (list);
    return status;
}

/* Tries supports wider by `factor` at all positions whose best basis so far is not good enough. */
static pg_status attempt (work *w, double factor)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    size_t *list = NULL, *which = NULL, n = 0, dim = (size_t) w->rows->dim;
    double *x = NULL, *eye = NULL;
    int *own = NULL, worst = factor > for_full ? LOWERED : GOOD;
    lot l = { .w = w };
    PG_ALLOC (list, w->n);
    PG_ALLOC (which, w->n);
    PG_ALLOC (x, w->n * dim);
    PG_ALLOC (own, w->n);
    if (w->rows->eye) PG_ALLOC (eye, w->n * dim);
    for (size_t k = 0; k < w->n; k++) {
        if (w->best[k] >= worst) continue;
        memcpy (x + n * dim, w->rows->x + w->place[k] * dim, dim * sizeof *x);
        if (eye) memcpy (eye + n * dim, w->rows->eye + w->place[k] * dim, dim * sizeof *eye);
        own[n] = w->rows->own[w->place[k]];
        list[n] = w->place[k], which[n++] = k;
    }
    if (n == 0) goto done;
    l.place = list;
    PG_TRY (pg_family_search_create (&search, w->cloud, factor * w->a.horizon, w->a.shape,
                                     w->a.kernel->closed));
    PG_TRY (pg_rows_place (&l.rows, search, w->cloud, n, x, NULL, own, NULL, eye, w->threads));
    PG_ALLOC (l.rows.wide, n);
    for (size_t i = 0; i < n; i++) l.rows.wide[i] = factor;
    PG_TRY (measure (&l));
    for (size_t i = 0; i < n; i++) {
        size_t k = which[i], from = l.rows.family.start[i], bonds = l.rows.family.start[i + 1] - from;
        if (l.sight[i] <= w->best[k]) continue;
        PG_GROW (w->node, w->cap, w->used + bonds);
        memcpy (w->node + w->used, l.rows.family.node + from, bonds * sizeof *w->node);
        w->best[k] = l.sight[i], w->factor[k] = factor, w->at[k] = w->used, w->count[k] = bonds;
        w->used += bonds;
    }
done:
    lot_clear (&l);
    pg_family_search_free (&search);
    pg_free (list), pg_free (which), pg_free (x), pg_free (own), pg_free (eye);
    return status;
}

/* Square of the distance from position k to the mean of the neighbours in its new support, m^2. */
static double off_middle (const work *w, size_t k)
{
    size_t dim = (size_t) w->rows->dim, count = 0;
    double mean[3] = { 0 }, square = 0;
    for (size_t e = 0; e < w->count[k]; e++) {
        int node = w->node[w->at[k] + e];
        if (w->sees && !w->sees (w->context, w->place[k], node)) continue;
        count++;
        for (size_t c = 0; c < dim; c++)
            mean[c] += w->cloud->x[(size_t) node * dim + c] - w->rows->x[w->place[k] * dim + c];
    }
    for (size_t c = 0; c < dim && count; c++) mean[c] /= (double) count, square += mean[c] * mean[c];
    return square;
}

/* Number of positions that are surrounded by the neighbours in their new supports: they had too few because
 * the horizon is small, not because they are at the surface. */
static size_t inner_places (const work *w)
{
    size_t n = 0;
    for (size_t k = 0; k < w->n; k++) {
        double reach = MIDST * w->factor[k] * w->a.horizon;
        n += w->factor[k] > 0 && off_middle (w, k) < reach * reach;
    }
    return n;
}

/* Replaces the families of those rows for which a better support has been found. */
static pg_status replace (const work *w, pg_rows *rows)
{
    pg_status status = PG_OK;
    pg_family f = { .n = rows->n };
    size_t bonds = 0;
    PG_ALLOC (f.start, rows->n + 1);
    if (!rows->wide) {
        PG_ALLOC (rows->wide, rows->n);
        for (size_t i = 0; i < rows->n; i++) rows->wide[i] = 1;
    }
    for (size_t i = 0, k = 0; i < rows->n; i++) {
        int wider = k < w->n && w->place[k] == i && w->factor[k] > 0;
        bonds += wider ? w->count[k] : rows->family.start[i + 1] - rows->family.start[i];
        f.start[i + 1] = bonds;
        k += k < w->n && w->place[k] == i;
    }
    PG_ALLOC (f.node, bonds);
    for (size_t i = 0, k = 0; i < rows->n; i++) {
        int wider = k < w->n && w->place[k] == i && w->factor[k] > 0;
        memcpy (f.node + f.start[i], wider ? w->node + w->at[k] : rows->family.node + rows->family.start[i],
                (f.start[i + 1] - f.start[i]) * sizeof *f.node);
        if (wider) rows->wide[i] = w->factor[k];
        k += k < w->n && w->place[k] == i;
    }
    pg_family_clear (&rows->family);
    rows->family = f, f = (pg_family) { 0 };
done:
    pg_family_clear (&f);
    return status;
}

pg_status pg_rows_widen (pg_rows *rows, const pg_approx *a, const pg_cloud *cloud, pg_sight sees,
                         void *context, int threads, pg_widened *out)
{
    pg_status status = PG_OK;
    work w = { .a = *a, .rows = rows, .cloud = cloud, .sees = sees, .context = context, .threads = threads };
    *out = (pg_widened) { .widest = 1 };
    w.a.extrapolates = w.a.projected = 0;
    if (rows->n == 0) return PG_OK;
    PG_TRY (find_poor (&w));
    if (w.n == 0) goto done;
    PG_ALLOC (w.at, w.n);
    PG_ALLOC (w.count, w.n);
    PG_ALLOC (w.factor, w.n);
    for (size_t k = 0; k < sizeof factors / sizeof *factors; k++) PG_TRY (attempt (&w, factors[k]));
    if (cloud->regular ? (double) inner_places (&w) > usual * (double) rows->n : w.too_small) goto done;
    PG_ALLOC (out->blind, w.n);
    for (size_t k = 0; k < w.n; k++) {
        out->widened += w.factor[k] > 0;
        out->widest = fmax (out->widest, w.factor[k]);
        if (w.best[k] == POOR) out->blind[out->nblind++] = w.place[k];
    }
    if (out->widened) PG_TRY (replace (&w, rows));
done:
    pg_free (w.place), pg_free (w.at), pg_free (w.count), pg_free (w.best), pg_free (w.factor),
        pg_free (w.node);
    return status;
}
