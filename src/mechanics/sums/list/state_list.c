/* SPDX-License-Identifier: GPL-3.0-or-later
 * State-based bonds (linear peridynamic solid) from a list, for any cloud: a loop for the dilatations, in
 * which bonds over their limit are broken, then one for the forces. Every point sums its own bonds in the
 * order of the family. The laws are in law_state.h; theory B6. */
#include "list.h"
#include "mechanics/sums/terms/state.h"
#include "perigal/vector.h"
#include <math.h>
#include <string.h>

enum { DILATE, PULL, WEIGHT, TERMS };                  /* numbers of a bond: w V_j, w V_i V_j, w */
typedef struct {
    bond_list list;                                    /* first, as the traversal takes a bond_list */
    double *q, *W;                                     /* weighted volume, energy density, old numbers (n) */
    double *factor, *alpha;                            /* A d / q^2, sum w V p, by new number (n) */
} state_list;

/* Frees the loop, also one that was never completed. */
static void release (void *self)
{
    state_list *s = self;
    if (s) pg_free (s->q), pg_free (s->W), pg_free (s->factor), pg_free (s->alpha);
    pg_list_free (s);
}

/* Bond vector xi from the positions of the points, m; on a lattice it may differ from the stencil's by
 * rounding. */
static void between (const bond_list *list, size_t i, size_t j, double *xi)
{
    const double *x = list->sums->cloud->x;
    size_t dim = (size_t) list->dim;
    for (size_t c = 0; c < dim; c++) xi[c] = x[j * dim + c] - x[i * dim + c];
}

/* ---- q ------------------------------------------------------------------------------------------------- */
/* Writes A theta / q and beta to the record of point p (new number), for the loop for the forces. */
static void set_record (state_list *s, size_t p, double beta)
{
    double *of = s->list.record + p * (size_t) s->list.pitch + 2 * (size_t) s->list.dim;
    of[0] = s->factor[p] * s->alpha[p], of[1] = beta;
}

/* Computes q = sum w r^2 V_j of point i over the bonds marked in `counts` (entries of the family), or over
 * the intact bonds of the list if that is NULL, and from it factor and beta. */
static void weigh (state_list *s, size_t i, const unsigned char *counts)
{
    const bond_list *list = &s->list;
    const pg_family *f = list->family;
    size_t p = (size_t) list->rank[i], first = list->slots[1].start[p / LIST_LANES];
    const double *w = list->slots[1].term[WEIGHT] + first * LIST_LANES + p % LIST_LANES;
    double q = 0, xi[3];
    for (size_t k = 0; k < f->start[i + 1] - f->start[i]; k++) {
        size_t e = f->start[i] + k, j = (size_t) f->node[e];
        if (counts ? !counts[e] : !pg_list_alive (list, p, k)) continue;
        between (list, i, j, xi);
        q += w[k * LIST_LANES] * pg_dot (list->dim, xi, xi) * list->sums->cloud->volume[j];
    }
    s->q[i] = q, s->factor[p] = state_factor (&list->setting, i, q);
    set_record (s, p, state_beta (&list->setting, i, q));
}

typedef struct { state_list *s; const unsigned char *counts; } weighing;

/* `weigh` for points first .. last - 1. */
static void weigh_points (void *context, size_t first, size_t last, int thread)
{
    const weighing *w = context;
    (void) thread;
    for (size_t i = first; i < last; i++) weigh (w->s, i, w->counts);
}

/* `weigh` for all points: at the start, and after another state was read. */
static void weigh_all (state_list *s, const unsigned char *counts)
{
    pg_parallel_heavy (s->list.threads, s->list.n, weigh_points, &(weighing) { s, counts });
}

/* `weigh` for the points that lost n bonds, which ascend, so that each point is computed once. */
static void weigh_some (state_list *s, size_t n, const size_t *bond)
{
    size_t last = SIZE_MAX;
    for (size_t k = 0; k < n; k++) {
        size_t i = pg_list_owner (s->list.family, bond[k]);
        if (i != last) weigh (s, i, NULL);
        last = i;
    }
}

/* Updates the alive bits, and the weighted volumes if the rule says that these follow the intact bonds. */
static void update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    state_list *s = self;
    pg_list_update (self, alive, changes);
    if (!s->list.sums->rule.follow) return;
    if (changes) weigh_some (s, changes->n, changes->bond);
    else weigh_all (s, NULL);
}

/* ---- building ------------------------------------------------------------------------------------------ */
/* list_law.term: w V_j for the dilatation, w V_i V_j for the force, w for the weighted volume, w = k beta /
 * r. */
static void term (const bond_list *list, size_t i, size_t j, const double *unused, double weight, double *out)
{
    const double *V = list->sums->cloud->volume;
    double xi[3];
    (void) unused;
    between (list, i, j, xi);
    double w = weight / sqrt (pg_dot (list->dim, xi, xi));
    out[DILATE] = w * V[j], out[PULL] = w * (V[i] * V[j]), out[WEIGHT] = w;
}

/* list_law.limit: the smaller critical stretch of both ends. */
static double limit (const bond_list *list, size_t i, size_t j)
{
    return fmin (list->setting.limit[i], list->setting.limit[j]);
}

/* Makes the list, with records of 8 numbers: position, displacement, alpha and beta. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    int dim = setting->sums->cloud->dim;
    const list_law law = { .pitch = 8, .unknowns = dim, .sums = dim, .terms = TERMS, .term = term,
                           .limit = limit };
    PG_TRY (pg_list_create (self, sizeof (state_list), setting, set, &law, NULL));
    state_list *s = *self;
    PG_ALLOC (s->q, s->list.n);
    PG_ALLOC (s->W, s->list.n);
    PG_ALLOC (s->factor, s->list.n);
    PG_ALLOC (s->alpha, s->list.n);
    weigh_all (s, setting->sums->rule.follow ? NULL : setting->counted);
done:
    return status;
}

/* Memory traffic of a sum, bytes: two loops, each of which reads ends, bits and one number of every bond, and
 * a record of every point. */
static void bytes (const void *self, double *per_bond, double *per_point)
{
    const state_list *s = self;
    const double slots = (double) s->list.slots[1].start[s->list.slices];
    const double bonds = (double) s->list.family->start[s->list.n];
    pg_list_bytes (self, per_bond, per_point);
    *per_bond = bonds > 0 ? 2 * slots * (LIST_LANES * (sizeof (uint32_t) + sizeof (double)) + 1) / bonds : 0;
    *per_point += 6 * sizeof (double);                 /* alpha, factor, twice; alpha, beta of records */
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* list_take: keeps the sums w V p of a chunk's points, and writes A theta / q to their records for the loop
 * for the forces. */
static void take_dilatations (void *context, const bond_list *list, size_t first, size_t last,
                              const double *sum)
{
    state_list *s = context;
    double *of = list->record + first * (size_t) list->pitch + 2 * (size_t) list->dim;
    for (size_t p = first; p < last; p++, of += list->pitch) {
        s->alpha[p] = pg_list_sum (sum, 1, p - first, 0);
        *of = s->factor[p] * s->alpha[p];
    }
}

typedef struct { state_list *s; double *out; } pass;

/* list_take: copies the forces of a chunk, N, to f in the order of old numbers. */
static void take_forces (void *f, const bond_list *list, size_t first, size_t last, const double *sum)
{
    int dim = list->dim;
    for (size_t p = first; p < last; p++) {
        double *to = (double *) f + (size_t) list->point[p] * (size_t) dim;
        for (int c = 0; c < dim; c++) to[c] = pg_list_sum (sum, dim, p - first, c);
    }
}

/* Forces f, N. Bonds over their limit are broken in the first loop, before dilatations are summed; if
 * weighted volumes follow the intact bonds, those of their ends are updated before the forces are summed. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    pg_status status = PG_OK;
    state_list *s = self;
    int check = broken && s->list.limits > 0;
    size_t before = broken ? broken->n : 0;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_state_dilate, check, take_dilatations, s);
    if (check) PG_TRY (pg_list_lost (&s->list, broken));
    if (check && s->list.sums->rule.follow) weigh_some (s, broken->n - before, broken->bond + before);
    pg_list_run (&s->list, LIST_state_pull, 0, take_forces, f);
done:
    return status;
}

/* list_take: energy density W_i = 1/2 [factor (sum w V p)^2 + beta sum w V p^2 / r^2], J/m^3. */
static void take_energies (void *context, const bond_list *list, size_t first, size_t last, const double *sum)
{
    const pass *g = context;
    for (size_t p = first; p < last; p++) {
        double beta = list->record[p * (size_t) list->pitch + 2 * (size_t) list->dim + 1];
        double all = pg_list_sum (sum, 2, p - first, 0), square = pg_list_sum (sum, 2, p - first, 1);
        g->out[list->point[p]] = 0.5 * (g->s->factor[p] * all * all + beta * square);
    }
}

/* Energy density of the points, J/m^3. */
static pg_status energies (void *self, const double *u, double *W)
{
    state_list *s = self;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_state_store, 0, take_energies, &(pass) { s, W });
    return PG_OK;
}

/* Energy of the body, J, summed in the order of points, so that it does not depend on threads. */
static double energy (void *self, const double *u)
{
    state_list *s = self;
    double sum = 0;
    energies (self, u, s->W);
    for (size_t i = 0; i < s->list.n; i++) sum += s->W[i] * s->list.sums->cloud->volume[i];
    return sum;
}

/* list_take: dilatation theta = d / q sum w V p. */
static void take_theta (void *context, const bond_list *list, size_t first, size_t last, const double *sum)
{
    const pass *g = context;
    for (size_t p = first; p < last; p++) {
        size_t i = (size_t) list->point[p];
        g->out[i] = g->s->q[i] > 0 ? list->dim / g->s->q[i] * pg_list_sum (sum, 1, p - first, 0) : 0;
    }
}

/* Dilatation theta (1) and weighted volume q of all points; either may be NULL. */
static pg_status dilatation (void *self, const double *u, double *theta, double *q)
{
    state_list *s = self;
    if (q) memcpy (q, s->q, s->list.n * sizeof *q);
    if (!theta) return PG_OK;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, LIST_state_dilate, 0, take_theta, &(pass) { s, theta });
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_state_list = {
    .name = "list", .state = 1, .refusal = pg_state_loop_refusal, .create = create, .free = release,
        .bytes = bytes,
    .update = update, .force = force, .energy = energy, .energies = energies, .dilatation = dilatation,
    .apart = 1,
};
