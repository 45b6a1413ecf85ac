/* SPDX-License-Identifier: GPL-3.0-or-later
 * State-based sums (linear peridynamic solid) over lists of neighbours, for any cloud: every point sums its
 * own bonds in the order of the family, first for the dilatations (bonds over their limit die there), then
 * for the forces. Both ends compute the same products of a bond. theory B6. */
#include "state.h"
#include <math.h>
#include <string.h>

enum { MAX_THREADS = 64, FEW = 1 << 15 };
typedef struct {
    pg_bond_loop_setting setting;
    double *w;                                         /* k beta / r of each bond, 1/m (entries) */
    unsigned char *alive;                              /* (entries) */
    double *q, *factor, *beta, *alpha;                 /* (n) */
    pg_changes found[MAX_THREADS];
    pg_status  failed[MAX_THREADS];
} list;

static void list_free (void *self)
{
    list *s = self;
    if (!s) return;
    for (int t = 0; t < MAX_THREADS; t++) pg_free (s->found[t].bond);
    pg_free (s->w), pg_free (s->alive), pg_free (s->q), pg_free (s->factor), pg_free (s->beta),
        pg_free (s->alpha);
    pg_free (s);
}

static int threads_for (const list *s)
{
    const pg_family *f = s->setting.family;
    int t = s->setting.threads;
    return f->start[f->n] < FEW || t < 1 ? 1 : t < MAX_THREADS ? t : MAX_THREADS;
}

/* xi.eta and r^2 of a bond; of the other direction the same bits */
#define INLINE static inline __attribute__ ((always_inline))
INLINE double product (const double *x, const double *u, size_t dim, size_t i, size_t j, double *xi,
                       double *rr)
{
    double s = 0, r2 = 0;
    for (size_t k = 0; k < dim; k++) {
        double d = x[j * dim + k] - x[i * dim + k];
        s += d * (u[j * dim + k] - u[i * dim + k]), r2 += d * d;
        xi[k] = d;
    }
    *rr = r2;
    return s;
}

static double length2 (const double *x, size_t dim, size_t i, size_t j)
{
    double xi[3], rr;
    product (x, x, dim, i, j, xi, &rr);
    return rr;
}

/* ---- q ------------------------------------------------------------------------------------------------- */
static void weigh (list *s, size_t i, const unsigned char *counts)
{
    const pg_family *f = s->setting.family;
    const pg_cloud *c = s->setting.sums->cloud;
    double q = 0;
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
        if (!counts || counts[e])
            q += s->w[e] * length2 (c->x, (size_t) c->dim, i, (size_t) f->node[e]) * c->volume[f->node[e]];
    s->q[i] = q, s->factor[i] = state_factor (&s->setting, i, q), s->beta[i] = state_beta (&s->setting, i, q);
}

typedef struct { list *s; const unsigned char *counts; } weighing;

static void weigh_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const weighing *w = context;
    for (size_t i = first; i < last; i++) weigh (w->s, i, w->counts);
}

static void weigh_all (list *s, const unsigned char *counts)
{
    pg_parallel_heavy (threads_for (s), s->setting.family->n, weigh_points, &(weighing) { s, counts });
}

static size_t owner (const list *s, size_t entry)
{
    const size_t *start = s->setting.family->start;
    size_t low = 0, high = s->setting.family->n;
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (start[middle] <= entry) low = middle;
        else high = middle;
    }
    return low;
}

static void list_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    list *s = self;
    size_t entries = s->setting.family->start[s->setting.family->n];
    if (!changes && alive) memcpy (s->alive, alive, entries);
    else if (!changes) memset (s->alive, 1, entries);
    for (size_t c = 0; changes && c < changes->n; c++) s->alive[changes->bond[c]] = 0;
    if (!s->setting.sums->rule.follow) return;
    if (!changes) weigh_all (s, s->alive);
    for (size_t c = 0; changes && c < changes->n; c++) weigh (s, owner (s, changes->bond[c]), s->alive);
}

/* ---- life ---------------------------------------------------------------------------------------------- */
static void find_weights (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    list *s = context;
    const pg_family *f = s->setting.family;
    const pg_cloud *c = s->setting.sums->cloud;
    for (size_t i = first; i < last; i++) {
        pg_sums_bonds (s->setting.sums, f, i, NULL, s->w + f->start[i], NULL);
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            s->w[e] /= sqrt (length2 (c->x, (size_t) c->dim, i, (size_t) f->node[e]));
    }
}

static pg_status list_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    (void) set;
    list *s = NULL;
    PG_ALLOC (s, 1);
    *self = s;
    s->setting = *setting;
    size_t n = setting->sums->cloud->n, entries = setting->family->start[n];
    PG_ALLOC (s->w, entries);
    PG_ALLOC (s->alive, entries);
    PG_ALLOC (s->q, n);
    PG_ALLOC (s->factor, n);
    PG_ALLOC (s->beta, n);
    PG_ALLOC (s->alpha, n);
    memset (s->alive, 1, entries);
    pg_parallel_heavy (threads_for (s), n, find_weights, s);
    weigh_all (s, setting->sums->rule.follow ? NULL : setting->counted);
done:
    return status;
}

static void list_bytes (const void *self, double *per_bond, double *per_point)
{
    const list *s = self;
    size_t dim = (size_t) s->setting.sums->cloud->dim;
    *per_bond = 2 * (sizeof (double) + sizeof (int) + 1);
    *per_point = sizeof (double) * (double) (5 * dim + 6);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
typedef struct { list *s; const double *u; double *out; int check; } sweep;

static int breaks (const list *s, size_t i, size_t j, double product_, double rr)
{
    const pg_bond_loop_setting *g = &s->setting;
    if (g->exempt && (g->exempt[i] || g->exempt[j])) return 0;
    return product_ >= fmin (g->limit[i], g->limit[j]) * rr;
}

static pg_status note (pg_changes *found, size_t entry)
{
    pg_status status = PG_OK;
    PG_GROW (found->bond, found->cap, found->n + 1);
    found->bond[found->n++] = entry;
done:
    return status;
}

INLINE void dilate (const sweep *w, size_t first, size_t last, int thread, const size_t dim)
{
    list *s = w->s;
    const pg_family *f = s->setting.family;
    const pg_cloud *c = s->setting.sums->cloud;
    double xi[3], rr;
    for (size_t i = first; i < last; i++) {
        double sum = 0;
        int lost = 0;
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (!s->alive[e]) continue;
            double p = product (c->x, w->u, dim, i, j, xi, &rr);
            if (w->check && breaks (s, i, j, p, rr)) {
                pg_status now = note (&s->found[thread], e);
                if (now != PG_OK) s->failed[thread] = now;
                s->alive[e] = 0, lost = 1;
                continue;
            }
            sum += s->w[e] * c->volume[j] * p;
        }
        if (lost && s->setting.sums->rule.follow) weigh (s, i, s->alive);
        s->alpha[i] = sum;
    }
}

static void dilate_points (void *context, size_t first, size_t last, int thread)
{
    const sweep *w = context;
    if (w->s->setting.sums->cloud->dim == 2) dilate (w, first, last, thread, 2);
    else dilate (w, first, last, thread, 3);
}

INLINE void pull (const sweep *w, size_t first, size_t last, const size_t dim)
{
    const list *s = w->s;
    const pg_family *f = s->setting.family;
    const pg_cloud *c = s->setting.sums->cloud;
    double xi[3], rr;
    for (size_t i = first; i < last; i++) {
        double own = s->factor[i] * s->alpha[i], sum[3] = { 0 };
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (!s->alive[e]) continue;
            double p = product (c->x, w->u, dim, i, j, xi, &rr);
            double t = s->w[e] * (c->volume[i] * c->volume[j])
                       * ((own + s->factor[j] * s->alpha[j]) + (s->beta[i] + s->beta[j]) * p / rr);
            for (size_t k = 0; k < dim; k++) sum[k] += t * xi[k];
        }
        for (size_t k = 0; k < dim; k++) w->out[i * dim + k] = sum[k];
    }
}

static void pull_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const sweep *w = context;
    if (w->s->setting.sums->cloud->dim == 2) pull (w, first, last, 2);
    else pull (w, first, last, 3);
}

static pg_status list_force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    list *s = self;
    sweep w = { s, u, f, broken && s->setting.limit };
    size_t n = s->setting.family->n;
    pg_parallel_heavy (threads_for (s), n, dilate_points, &w);
    if (w.check) PG_TRY (sweep_collect (broken, threads_for (s), s->found, s->failed));
    pg_parallel_heavy (threads_for (s), n, pull_points, &w);
done:
    return status;
}

static void store_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const sweep *w = context;
    const list *s = w->s;
    const pg_family *f = s->setting.family;
    const pg_cloud *c = s->setting.sums->cloud;
    double xi[3], rr;
    for (size_t i = first; i < last; i++) {
        double sum = 0, square = 0;
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            size_t j = (size_t) f->node[e];
            if (!s->alive[e]) continue;
            double p = product (c->x, w->u, (size_t) c->dim, i, j, xi, &rr),
                   part = s->w[e] * c->volume[j] * p;
            sum += part, square += part * p / rr;
        }
        w->out[i] = 0.5 * (s->factor[i] * sum * sum + s->beta[i] * square);
    }
}

static pg_status list_energies (void *self, const double *u, double *W)
{
    list *s = self;
    pg_parallel_heavy (threads_for (s), s->setting.family->n, store_points, &(sweep) { s, u, W, 0 });
    return PG_OK;
}

static double list_energy (void *self, const double *u)
{
    list *s = self;
    double sum = 0;
    list_energies (self, u, s->alpha);                 /* which every force makes anew */
    for (size_t i = 0; i < s->setting.family->n; i++) sum += s->alpha[i] * s->setting.sums->cloud->volume[i];
    return sum;
}

static pg_status list_dilatation (void *self, const double *u, double *theta, double *q)
{
    list *s = self;
    size_t n = s->setting.family->n;
    if (q) memcpy (q, s->q, n * sizeof *q);
    if (!theta) return PG_OK;
    pg_parallel_heavy (threads_for (s), n, dilate_points, &(sweep) { s, u, NULL, 0 });
    for (size_t i = 0; i < n; i++)
        theta[i] = s->q[i] > 0 ? s->setting.sums->cloud->dim / s->q[i] * s->alpha[i] : 0;
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_state_list = {
    .name = "list",
    .state = 1,
    .refusal = state_refusal,
    .create = list_create,
    .free = list_free,
    .bytes = list_bytes,
    .update = list_update,
    .force = list_force,
    .energy = list_energy,
    .energies = list_energies,
    .dilatation = list_dilatation,
};
