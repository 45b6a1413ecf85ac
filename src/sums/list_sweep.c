/* SPDX-License-Identifier: GPL-3.0-or-later
 * The loop over a list of bonds: fills the records, lets each chunk sum its forces, hands them out in the old
 * order. */
#include "list.h"
#include <math.h>
#include <string.h>

/* ---- building ------------------------------------------------------------------------------------------ */
enum { MOST_THREADS = 64 };

/* Places in lattice steps where there is one lattice with equal steps, so that bonds come out alike
 * everywhere; else as they are. */
static void place_records (bond_list *list)
{
    const pg_sums *sums = list->sums;
    const pg_sites *sites = &sums->sites;
    int dim = list->dim, whole = sites->count[0] > 0 && sums->stencil.n > 0;
    for (int c = 1; c < dim; c++) whole = whole && sites->step[c] == sites->step[0];
    list->unit = whole ? sites->step[0] : 1;
    list->scale = list->finite ? 1 / list->unit : 1;
    for (size_t p = 0; p < list->n; p++) {
        double *x = list->record + p * (size_t) list->pitch;
        size_t i = (size_t) list->point[p];
        int site = whole ? sites->site[i] : 0;
        for (int c = 0; c < dim; c++) {
            x[c] = whole ? site % sites->count[c] : sums->cloud->x[i * (size_t) dim + (size_t) c];
            if (whole) site /= sites->count[c];
        }
    }
}

static void list_free (void *self)
{
    bond_list *list = self;
    if (!list) return;
    for (int k = 0; k < 2; k++) {
        bond_slots *s = &list->slots[k];
        pg_free (s->start), pg_free (s->near), pg_free (s->far), pg_free (s->a), pg_free (s->alive),
            pg_free (s->lost);
        pg_free (s->limit_at), pg_free (s->limit_step);
    }
    pg_free (list->point), pg_free (list->rank), pg_free (list->before), pg_free (list->record),
        pg_free (list->limit);
    pg_free (list->sum), pg_free (list->energy), pg_free (list->broke);
    pg_free (list);
}

static size_t chunk_size (size_t n)
{
    /* 65536 / pitch fit; larger chunks share more bonds, smaller ones feed more threads */
    size_t most = 8192, c = n / 32;
    if (c < 256) c = 256;
    if (c > most) c = most;
    return (c + LIST_LANES - 1) / LIST_LANES * LIST_LANES;
}

static pg_status list_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set)
{
    static const bond_list_kernel (*const kernels[])[2][2] = { bond_list_scalar, bond_list_avx2,
                                                               bond_list_avx512 };
    pg_status status = PG_OK;
    bond_list *list = NULL;
    PG_ALLOC (list, 1);
    list->sums = setting->sums, list->family = setting->family, list->n = setting->family->n;
    list->dim = setting->sums->cloud->dim, list->finite = setting->sums->rule.finite != 0;
    list->kernel = kernels[set][list->dim - 1][list->finite];
    list->threads = setting->threads < 1              ? 1
                    : setting->threads > MOST_THREADS ? MOST_THREADS
                                                      : setting->threads;
    list->pitch = 1 << list->dim;
    list->chunk = chunk_size (list->n);
    list->chunks = (list->n + list->chunk - 1) / list->chunk,
    list->slices = (list->n + LIST_LANES - 1) / LIST_LANES;
    list->slots[0].shared = 1;
    if (list->n > UINT32_MAX / (unsigned) list->pitch)
        PG_FAIL (PG_E_LIMIT, "%zu points are too many for a list of bonds; try fewer", list->n);
    PG_ALLOC (list->point, list->n);
    PG_ALLOC (list->rank, list->n);
    PG_ALLOC (list->before, list->n);
    PG_ALLOC (list->record, list->slices * LIST_LANES * (size_t) list->pitch);
    PG_ALLOC (list->sum, (size_t) list->threads * list->chunk * (size_t) list->pitch / 2);
    PG_ALLOC (list->energy, list->chunks);
    PG_ALLOC (list->broke, list->chunks);
    PG_TRY (bond_list_order (list));
    place_records (list);
    PG_TRY (bond_list_fill (list, setting));
    pg_free (list->before), list->before = NULL;
    *self = list, list = NULL;
done:
    list_free (list);
    return status;
}

/* ---- bonds of the family and bits of the list ---------------------------------------------------------- */
static size_t entry_of (const pg_family *family, size_t i, size_t j)
{
    size_t low = family->start[i], high = family->start[i + 1];
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if ((size_t) family->node[middle] <= j) low = middle;
        else high = middle;
    }
    return low;
}

/* Calls visit for each bond of a slot whose bit is set: i, j old numbers. */
typedef void (*visit_bond) (void *context, size_t i, size_t j, int both);

static void each_bond (const bond_list *list, const bond_slots *slots, size_t slice, size_t slot,
                       unsigned bits, visit_bond visit, void *context)
{
    for (int lane = 0; lane < LIST_LANES; lane++) {
        if (!(bits >> lane & 1)) continue;
        size_t q = bond_list_end (list, slots, slice, LIST_LANES * slot + (size_t) lane);
        visit (context, (size_t) list->point[slice * LIST_LANES + (size_t) lane], (size_t) list->point[q],
               slots->shared);
    }
}

typedef struct { bond_list *list; const unsigned char *alive; } updater;

static void read_bits (void *context, size_t first, size_t last, int thread)
{
    const updater *g = context;
    bond_list *list = g->list;
    (void) thread;
    for (size_t slice = first; slice < last; slice++)
        for (int k = 0; k < 2; k++)
            for (size_t slot = list->slots[k].start[slice]; slot < list->slots[k].start[slice + 1]; slot++) {
                bond_slots *slots = &list->slots[k];
                unsigned bits = 0;
                for (size_t lane = 0; lane < LIST_LANES; lane++) {
                    size_t p = slice * LIST_LANES + lane,
                           q = bond_list_end (list, slots, slice, LIST_LANES * slot + lane);
                    if (p == q) continue;              /* no bond here */
                    bits |= (unsigned) (g->alive[entry_of (list->family, (size_t) list->point[p],
                                                           (size_t) list->point[q])]
                                        != 0)
                            << lane;
                }
                slots->alive[slot] = (unsigned char) bits;
            }
}

/* Clears the bond from p to q where p keeps it. */
static void clear_bond (bond_list *list, bond_slots *slots, size_t p, size_t q)
{
    size_t slice = p / LIST_LANES, lane = p % LIST_LANES;
    for (size_t slot = slots->start[slice]; slot < slots->start[slice + 1]; slot++)
        if (bond_list_end (list, slots, slice, LIST_LANES * slot + lane) == q)
            slots->alive[slot] &= (unsigned char) ~(1u << lane);
}

/* The point whose bonds hold entry e. */
static size_t owner_of (const pg_family *family, size_t e)
{
    size_t low = 0, high = family->n;
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if (family->start[middle] <= e) low = middle;
        else high = middle;
    }
    return low;
}

static void clear_changed (bond_list *list, const pg_changes *changes)
{
    const pg_family *family = list->family;
    for (size_t k = 0; k < changes->n; k++) {
        size_t e = changes->bond[k], p = (size_t) list->rank[owner_of (family, e)],
               q = (size_t) list->rank[family->node[e]];
        if (p / list->chunk != q / list->chunk) clear_bond (list, &list->slots[1], p, q);
        else clear_bond (list, &list->slots[0], p, q), clear_bond (list, &list->slots[0], q, p);
    }
}

static void list_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    bond_list *list = self;
    if (changes) clear_changed (list, changes);
    else pg_parallel (list->threads, list->slices, read_bits, &(updater) { list, alive });
}

/* ---- forces -------------------------------------------------------------------------------------------- */
typedef struct { bond_list *list; const double *u; double *f; int check; } summer;

static void read_displacements (void *context, size_t first, size_t last, int thread)
{
    const summer *g = context;
    const bond_list *list = g->list;
    size_t dim = (size_t) list->dim;
    (void) thread;
    for (size_t p = first; p < last; p++) {
        double *to = list->record + p * (size_t) list->pitch + dim;
        const double *u = g->u + (size_t) list->point[p] * dim;
        for (size_t c = 0; c < dim; c++) to[c] = u[c] * list->scale;
    }
}

static void sum_chunks (void *context, size_t first, size_t last, int thread)
{
    const summer *g = context;
    bond_list *list = g->list;
    size_t dim = (size_t) list->dim, wide = (size_t) list->pitch / 2;
    double *sum = list->sum + (size_t) thread * list->chunk * wide;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t start = chunk * list->chunk,
               end = list->n - start < list->chunk ? list->n : start + list->chunk;
        list->broke[chunk] = (unsigned char) list->kernel[g->check] (list, chunk, sum);
        for (size_t p = start; p < end; p++)
            for (size_t c = 0; c < dim; c++)
                g->f[(size_t) list->point[p] * dim + c] = sum[(p - start) * wide + c];
    }
}

typedef struct { const pg_family *family; size_t n; size_t *bond; } collector;

static void collect (void *context, size_t i, size_t j, int both)
{
    collector *g = context;
    if (g->bond) g->bond[g->n] = entry_of (g->family, i, j);
    g->n++;
    if (both && g->bond) g->bond[g->n] = entry_of (g->family, j, i);
    g->n += both != 0;
}

enum { COLLECT, FORGET, RESTORE };

static void walk_lost (bond_list *list, int what, collector *found)
{
    for (size_t chunk = 0; chunk < list->chunks; chunk++) {
        if (!list->broke[chunk]) continue;
        size_t first = chunk * list->chunk / LIST_LANES, last = (chunk + 1) * list->chunk / LIST_LANES;
        if (last > list->slices) last = list->slices;
        for (int k = 0; k < 2; k++) {
            bond_slots *slots = &list->slots[k];
            for (size_t slice = first; slice < last; slice++)
                for (size_t slot = slots->start[slice]; slot < slots->start[slice + 1]; slot++) {
                    if (!slots->lost[slot]) continue;
                    if (what == COLLECT)
                        each_bond (list, slots, slice, slot, slots->lost[slot], collect, found);
                    if (what == RESTORE) slots->alive[slot] |= slots->lost[slot];
                    if (what != COLLECT) slots->lost[slot] = 0;
                }
        }
    }
}

/* Tells the bonds that died; without memory for it none did. */
static pg_status report_lost (bond_list *list, pg_changes *broken)
{
    pg_status status = PG_OK;
    collector found = { .family = list->family };
    walk_lost (list, COLLECT, &found);
    if (found.n == 0) return PG_OK;
    PG_ALLOC (found.bond, found.n);
    found.n = 0;
    walk_lost (list, COLLECT, &found);
    PG_TRY (pg_changes_append (broken, found.n, found.bond));
done:
    walk_lost (list, status == PG_OK ? FORGET : RESTORE, NULL);
    pg_free (found.bond);
    return status;
}

static pg_status list_force (void *self, const double *u, double *f, pg_changes *broken)
{
    bond_list *list = self;
    summer g = { list, u, f, broken && list->limits > 0 };
    pg_parallel (list->threads, list->n, read_displacements, &g);
    pg_parallel_heavy (list->threads, list->chunks, sum_chunks, &g);
    return g.check ? report_lost (list, broken) : PG_OK;
}

/* ---- energy -------------------------------------------------------------------------------------------- */
/* Linear a (xi.eta)^2, finite a (|y| - r)^2, of one bond. */
static double bond_energy (const bond_list *list, const double *from, const double *to, double a)
{
    int dim = list->dim;
    double dot = 0, rr = 0, ee = 0;
    for (int c = 0; c < dim; c++) {
        double d = to[c] - from[c], e = to[dim + c] - from[dim + c];
        dot += d * e, rr += d * d, ee += e * e;
    }
    double q = 2 * dot + ee, longer = list->finite ? q / (sqrt (fmax (rr + q, 0)) + sqrt (rr)) : dot;
    return a * (longer * longer);
}

static void sum_energies (void *context, size_t first, size_t last, int thread)
{
    const summer *g = context;
    bond_list *list = g->list;
    size_t pitch = (size_t) list->pitch;
    (void) thread;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t from = chunk * list->chunk / LIST_LANES, to = (chunk + 1) * list->chunk / LIST_LANES;
        double sum[2] = { 0, 0 };
        if (to > list->slices) to = list->slices;
        for (int k = 0; k < 2; k++) {
            const bond_slots *s = &list->slots[k];
            for (size_t slice = from; slice < to; slice++)
                for (size_t at = LIST_LANES * s->start[slice]; at < LIST_LANES * s->start[slice + 1]; at++) {
                    if (!(s->alive[at / LIST_LANES] >> at % LIST_LANES & 1)) continue;
                    const double *own = list->record + (slice * LIST_LANES + at % LIST_LANES) * pitch;
                    sum[k] += bond_energy (list, own,
                                           list->record + bond_list_end (list, s, slice, at) * pitch,
                                           s->a[at]);
                }
        }
        list->energy[chunk] = 0.5 * sum[0] + 0.25 * sum[1];
    }
}

static double list_energy (void *self, const double *u)
{
    bond_list *list = self;
    summer g = { list, u, NULL, 0 };
    pg_parallel (list->threads, list->n, read_displacements, &g);
    pg_parallel_heavy (list->threads, list->chunks, sum_energies, &g);
    double sum = 0;
    for (size_t k = 0; k < list->chunks; k++) sum += list->energy[k];
    return list->finite ? sum * list->unit : sum;
}

typedef struct { bond_list *list; double *W; } portioner;

/* Each end's quarter of what its directed bonds store (a bond stored once is two of them), over the point's
 * volume */
static void share_energies (void *context, size_t first, size_t last, int thread)
{
    const portioner *g = context;
    const bond_list *list = g->list;
    size_t pitch = (size_t) list->pitch;
    double *sum = list->sum + (size_t) thread * list->chunk * (pitch / 2),
           unit = list->finite ? list->unit : 1;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t start = chunk * list->chunk,
               end = list->n - start < list->chunk ? list->n : start + list->chunk;
        size_t from = start / LIST_LANES, to = (end + LIST_LANES - 1) / LIST_LANES;
        memset (sum, 0, list->chunk * sizeof *sum);
        for (int k = 0; k < 2; k++) {
            const bond_slots *s = &list->slots[k];
            for (size_t slice = from; slice < to; slice++)
                for (size_t at = LIST_LANES * s->start[slice]; at < LIST_LANES * s->start[slice + 1]; at++) {
                    if (!(s->alive[at / LIST_LANES] >> at % LIST_LANES & 1)) continue;
                    size_t p = slice * LIST_LANES + at % LIST_LANES, q = bond_list_end (list, s, slice, at);
                    double e = bond_energy (list, list->record + p * pitch, list->record + q * pitch,
                                            s->a[at]);
                    sum[p - start] += e;
                    if (s->shared) sum[q - start] += e;
                }
        }
        for (size_t p = start; p < end; p++) {
            size_t i = (size_t) list->point[p];
            g->W[i] = sum[p - start] != 0 ? sum[p - start] * unit / (4 * list->sums->cloud->volume[i]) : 0;
        }
    }
}

static pg_status list_energies (void *self, const double *u, double *W)
{
    bond_list *list = self;
    summer g = { list, u, NULL, 0 };
    pg_parallel (list->threads, list->n, read_displacements, &g);
    pg_parallel_heavy (list->threads, list->chunks, share_energies, &(portioner) { list, W });
    return PG_OK;
}

/* ---- what it costs ------------------------------------------------------------------------------------- */
static void list_bytes (const void *self, double *per_bond, double *per_point)
{
    const bond_list *list = self;
    double bonds = (double) list->family->start[list->n], points = (double) list->n, bytes = 0;
    for (int k = 0; k < 2; k++) {
        double end = k == 0 ? sizeof (uint16_t) : sizeof (uint32_t);
        bytes += (double) list->slots[k].start[list->slices] * (LIST_LANES * (end + sizeof (double)) + 1);
    }
    *per_bond = bonds > 0 ? bytes / bonds : 0;
    /* u and f; new and old number twice; record written and read; share of the slices' starts and limits */
    *per_point = points > 0 ? 2.0 * list->dim * sizeof (double) + 2 * sizeof (int)
                                  + 1.5 * list->pitch * sizeof (double)
                                  + 2 * (2 * sizeof (size_t) + 1.0) / LIST_LANES
                            : 0;
}

static const char *list_refusal (const pg_bond_loop_setting *setting) { (void) setting; return NULL; }

const pg_bond_loop_kind pg_bond_loop_list = { .name = "list",
                                              .refusal = list_refusal,
                                              .create = list_create,
                                              .free = list_free,
                                              .bytes = list_bytes,
                                              .update = list_update,
                                              .force = list_force,
                                              .energy = list_energy,
                                              .energies = list_energies };
