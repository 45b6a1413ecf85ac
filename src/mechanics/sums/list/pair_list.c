/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pair forces along bonds (bond-based theory), from a list: any points, any number of materials. The law is
 * in law_pair.h. */
#include "list.h"
#include <math.h>
#include <string.h>

typedef struct {
    bond_list list;                                    /* first, as the traversal takes a bond_list */
    int     finite;                                    /* 1: finite stretch */
    double  unit;                                      /* m per unit of positions in records */
    double *energy;                                    /* energy of each chunk */
} pair_list;

static const char *refusal (const pg_bond_loop_setting *setting) { (void) setting; return NULL; }

/* Frees a list of pair bonds, also one that was never completed; NULL is allowed. */
static void release (void *self)
{
    pair_list *s = self;
    if (s) pg_free (s->energy);
    pg_list_free (s);
}

/* ---- building ------------------------------------------------------------------------------------------ */
/* Returns the modulus of a bond: the harmonic mean of those of its ends, N/m^6. */
static double pair_modulus (const double *c, size_t i, size_t j)
{
    if (c[i] == c[j]) return c[i];
    return c[i] + c[j] > 0 ? 2 * (c[i] * c[j]) / (c[i] + c[j]) : 0;
}

/* Sets the unit of records: on a lattice of equal steps positions are whole numbers of steps, exact in every
 * bond, and `unit` is a step. Displacements of finite stretch are scaled to the same unit. */
static void prepare (bond_list *list)
{
    pair_list *s = (pair_list *) list;
    s->finite = list->sums->rule.finite != 0;
    s->unit = list->whole ? list->sums->sites.step[0] : 1;
    list->scale = s->finite ? 1 / s->unit : 1;
}

/* list_law.term: a of law_pair.h in units of the records: linear c k beta g V V / r^3, finite r^2 times
 * this. */
static void term (const bond_list *list, size_t i, size_t j, const double *xi, double weight, double *out)
{
    const pair_list *s = (const pair_list *) list;
    const double *V = list->sums->cloud->volume;
    double rr = 0;
    for (int c = 0; c < list->dim; c++) rr += xi[c] * xi[c];
    double pull = pair_modulus (list->setting.modulus, i, j) * weight * (V[i] * V[j]) / sqrt (rr);
    out[0] = s->finite ? pull * s->unit : pull / rr * (s->unit * s->unit);
}

/* list_law.limit: limit of law_pair.h over r^2, from the smaller critical stretch of both ends, in the unit
 * of records. */
static double limit (const bond_list *list, size_t i, size_t j)
{
    const pair_list *s = (const pair_list *) list;
    double s0 = fmin (list->setting.limit[i], list->setting.limit[j]);
    return s->finite ? s0 * (2 + s0) : s0 * s->unit;
}

/* Makes the list. Bonds within a chunk are shared: stored once, and summed for both ends. */
static pg_status create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    pg_status status = PG_OK;
    int dim = setting->sums->cloud->dim;
    const list_law law = { .shared = 1, .pitch = 1 << dim, .unknowns = dim, .sums = dim, .terms = 1,
                           .places = LIST_EQUAL_STEPS, .term = term, .limit = limit };
    PG_TRY (pg_list_create (self, sizeof (pair_list), setting, set, &law, prepare));
    pair_list *s = *self;
    PG_ALLOC (s->energy, s->list.chunks);
done:
    return status;
}

/* ---- forces -------------------------------------------------------------------------------------------- */
/* Copies the forces of a chunk, N, to f in the order of old numbers. `dim` is a constant in each call; sums
 * of three components are four numbers apart. */
static inline __attribute__ ((always_inline)) void copy_forces (double *f, const bond_list *list,
                                                                size_t first, size_t last,
                                                                const double *sum, const size_t dim)
{
    enum { AHEAD = 40 };                               /* prefetched, as old numbers are in no order */
    const size_t wide = dim == 3 ? 4 : dim;
    for (size_t p = first; p < last; p++, sum += wide) {
        if (p + AHEAD < last) __builtin_prefetch (f + (size_t) list->point[p + AHEAD] * dim, 1);
        for (size_t c = 0; c < dim; c++) f[(size_t) list->point[p] * dim + c] = sum[c];
    }
}

/* list_take: copies the forces of a chunk, by a loop for each dimension. */
static void take_forces (void *f, const bond_list *list, size_t first, size_t last, const double *sum)
{
    switch (list->dim) {
    case 1: copy_forces (f, list, first, last, sum, 1); break;
    case 2: copy_forces (f, list, first, last, sum, 2); break;
    default: copy_forces (f, list, first, last, sum, 3);
    }
}

/* Forces f of all points, N; unless broken is NULL, bonds over their limit are broken before they are
 * summed. */
static pg_status force (void *self, const double *u, double *f, pg_changes *broken)
{
    pair_list *s = self;
    int check = broken && s->list.limits > 0;
    pg_list_read (&s->list, u);
    pg_list_run (&s->list, s->finite ? LIST_pair_finite : LIST_pair_linear, check, take_forces, f);
    return check ? pg_list_lost (&s->list, broken) : PG_OK;
}

/* ---- energy -------------------------------------------------------------------------------------------- */
/* Twice the energy of one bond between the records from and to: linear a (xi.eta)^2, finite a (|y| - r)^2. */
static double bond_energy (const pair_list *s, const double *from, const double *to, double a)
{
    int dim = s->list.dim;
    double dot = 0, rr = 0, ee = 0;
    for (int c = 0; c < dim; c++) {
        double d = to[c] - from[c], e = to[dim + c] - from[dim + c];
        dot += d * e, rr += d * d, ee += e * e;
    }
    double q = 2 * dot + ee, longer = s->finite ? q / (sqrt (fmax (rr + q, 0)) + sqrt (rr)) : dot;
    return a * (longer * longer);
}

typedef struct { pair_list *s; double *W; } storing;

/* Adds twice the energies of the bonds of a slice of one sort to `sum`, or, if share is not NULL, to the
 * share of each of their ends (points of the chunk, from `start` on). */
static void slice_energy (const pair_list *s, const bond_slots *slots, size_t slice, double *sum,
                          size_t start, double *share)
{
    const bond_list *list = &s->list;
    const size_t pitch = (size_t) list->pitch, end = LIST_LANES * slots->start[slice + 1];
    for (size_t at = LIST_LANES * slots->start[slice]; at < end; at++) {
        if (!(slots->alive[at / LIST_LANES] >> at % LIST_LANES & 1)) continue;
        size_t p = slice * LIST_LANES + at % LIST_LANES, q = pg_list_end (list, slots, slice, at);
        double e = bond_energy (s, list->record + p * pitch, list->record + q * pitch, slots->term[0][at]);
        if (!share) {
            *sum += e;
            continue;
        }
        share[p - start] += e;
        if (slots->shared) share[q - start] += e;
    }
}

/* Energies of the chunks first .. last - 1. bond_energy is twice the energy: a bond stored once counts by
 * half of it, one stored at both ends by a quarter at each. */
static void sum_energies (void *context, size_t first, size_t last, int thread)
{
    pair_list *s = context;
    const bond_list *list = &s->list;
    (void) thread;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t from = chunk * list->chunk / LIST_LANES, to = (chunk + 1) * list->chunk / LIST_LANES;
        double sum[2] = { 0, 0 };
        if (to > list->slices) to = list->slices;
        for (int k = 0; k < 2; k++)
            for (size_t slice = from; slice < to; slice++)
                slice_energy (s, &list->slots[k], slice, &sum[k], 0, NULL);
        s->energy[chunk] = 0.5 * sum[0] + 0.25 * sum[1];
    }
}

/* Energy of the body, J: chunks are added in their order, whichever thread summed them. */
static double energy (void *self, const double *u)
{
    pair_list *s = self;
    double sum = 0;
    pg_list_read (&s->list, u);
    pg_parallel_heavy (s->list.threads, s->list.chunks, sum_energies, s);
    for (size_t k = 0; k < s->list.chunks; k++) sum += s->energy[k];
    return s->finite ? sum * s->unit : sum;
}

/* Energy densities of the points of chunks first .. last - 1, J/m^3: a quarter of bond_energy of each bond,
 * over the volume of the point. */
static void share_energies (void *context, size_t first, size_t last, int thread)
{
    const storing *g = context;
    const bond_list *list = &g->s->list;
    double *share = list->sum + (size_t) thread * list->chunk * ((size_t) list->pitch / 2);
    double unit = g->s->finite ? g->s->unit : 1;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t start = chunk * list->chunk;
        size_t end = list->n - start < list->chunk ? list->n : start + list->chunk;
        memset (share, 0, list->chunk * sizeof *share);
        for (int k = 0; k < 2; k++)
            for (size_t slice = start / LIST_LANES; slice < (end + LIST_LANES - 1) / LIST_LANES; slice++)
                slice_energy (g->s, &list->slots[k], slice, NULL, start, share);
        for (size_t p = start; p < end; p++) {
            size_t i = (size_t) list->point[p];
            double e = share[p - start];
            g->W[i] = e != 0 ? e * unit / (4 * list->sums->cloud->volume[i]) : 0;
        }
    }
}

/* Energy density of the points, J/m^3. */
static pg_status energies (void *self, const double *u, double *W)
{
    pair_list *s = self;
    pg_list_read (&s->list, u);
    pg_parallel_heavy (s->list.threads, s->list.chunks, share_energies, &(storing) { s, W });
    return PG_OK;
}

const pg_bond_loop_kind pg_bond_loop_list = {
    .name = "list", .refusal = refusal, .create = create, .free = release, .bytes = pg_list_bytes,
    .update = pg_list_update, .force = force, .energy = energy, .energies = energies,
    .apart = 1,
};
