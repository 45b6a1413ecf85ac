/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lists of bonds, whatever the law: creation, updates of intact bonds, loops, bonds that broke in a loop. */
#include "list.h"
#include <string.h>

/* ---- building ------------------------------------------------------------------------------------------ */
enum { MOST_THREADS = 64 };

/* Writes the positions of points to the records: in lattice steps if the law asks for it and there is a
 * lattice, so that bonds are the same everywhere; else in m. */
static void place_records (bond_list *list)
{
    const pg_sums *sums = list->sums;
    const pg_sites *sites = &sums->sites;
    int dim = list->dim;
    list->whole = list->law.places != LIST_AS_THEY_ARE && sites->count[0] > 0 && sums->stencil.n > 0;
    for (int c = 1; c < dim && list->law.places == LIST_EQUAL_STEPS; c++)
        list->whole = list->whole && sites->step[c] == sites->step[0];
    for (size_t p = 0; p < list->n; p++) {
        double *x = list->record + p * (size_t) list->pitch;
        size_t i = (size_t) list->point[p];
        int site = list->whole ? sites->site[i] : 0;
        for (int c = 0; c < dim; c++) {
            x[c] = list->whole ? site % sites->count[c] : sums->cloud->x[i * (size_t) dim + (size_t) c];
            if (list->whole) site /= sites->count[c];
        }
    }
}

/* Frees a list of bonds, also one that was never completed. */
void pg_list_free (void *self)
{
    bond_list *list = self;
    if (!list) return;
    for (int k = 0; k < 2; k++) {
        bond_slots *s = &list->slots[k];
        for (int t = 0; t < LIST_TERMS; t++) pg_free (s->term[t]);
        pg_free (s->start), pg_free (s->near), pg_free (s->far), pg_free (s->alive), pg_free (s->lost);
        pg_free (s->limit_at), pg_free (s->limit_step);
    }
    pg_free (list->point), pg_free (list->rank), pg_free (list->before), pg_free (list->record);
    pg_free (list->limit), pg_free (list->sum), pg_free (list->broke);
    pg_free (list);
}

/* Returns the points of a chunk. Larger chunks share more bonds, smaller ones serve more threads and stay in
 * the second cache; offsets of the ends of shared bonds have 16 bits. */
static size_t chunk_size (const bond_list *list)
{
    size_t most = list->law.shared ? 8192 : 32768 / (size_t) list->pitch, c = list->n / 32;
    if (c < 256) c = 256;
    if (c > most) c = most;
    return (c + LIST_LANES - 1) / LIST_LANES * LIST_LANES;
}

/* Allocates the arrays whose size does not depend on the number of bonds. */
static pg_status allocate (bond_list *list)
{
    pg_status status = PG_OK;
    size_t sums = list->law.shared ? (size_t) list->pitch / 2 : (size_t) list->law.sums;
    PG_ALLOC (list->point, list->n);
    PG_ALLOC (list->rank, list->n);
    PG_ALLOC (list->before, list->n);
    PG_ALLOC (list->record, list->slices * LIST_LANES * (size_t) list->pitch);
    PG_ALLOC (list->sum, (size_t) list->threads * list->chunk * sums);
    PG_ALLOC (list->broke, list->chunks);
done:
    return status;
}

/* Makes a list for one law: order of the points, records, slots. bytes: size of the law's struct, which
 * begins with the list; prepare may set units before the numbers of bonds are computed. */
pg_status pg_list_create (void **self, size_t bytes, const pg_bond_loop_setting *setting, pg_instructions set,
                          const list_law *law, list_prepare prepare)
{
    static const list_kernels *const kernels[] = { &pg_list_scalar, &pg_list_avx2, &pg_list_avx512 };
    pg_status status = PG_OK;
    int threads = setting->threads;
    bond_list *list = pg_calloc (1, bytes);
    *self = list;
    if (!list) PG_FAIL (PG_E_MEMORY, "%zu bytes for a list of bonds", bytes);
    list->setting = *setting, list->law = *law, list->kernels = kernels[set];
    list->sums = setting->sums, list->family = setting->family, list->n = setting->family->n;
    list->dim = setting->sums->cloud->dim, list->pitch = law->pitch, list->scale = 1;
    list->threads = threads < 1 ? 1 : threads > MOST_THREADS ? MOST_THREADS : threads;
    list->chunk = chunk_size (list);
    list->chunks = (list->n + list->chunk - 1) / list->chunk;
    list->slices = (list->n + LIST_LANES - 1) / LIST_LANES;
    list->slots[0].shared = 1;
    if (list->n > UINT32_MAX / (unsigned) list->pitch)
        PG_FAIL (PG_E_LIMIT, "%zu points are too many for a list of bonds; try fewer", list->n);
    PG_TRY (allocate (list));
    PG_TRY (pg_list_order (list));
    place_records (list);
    if (prepare) prepare (list);
    PG_TRY (pg_list_fill (list));
    pg_free (list->before), list->before = NULL;
done:
    return status;
}

/* ---- bonds of the family and bits of the list ---------------------------------------------------------- */
/* Returns the entry of the family of the bond from i to j, which must exist, by bisection, as neighbours
 * ascend. */
size_t pg_list_entry (const pg_family *family, size_t i, size_t j)
{
    size_t low = family->start[i], high = family->start[i + 1];
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if ((size_t) family->node[middle] <= j) low = middle;
        else high = middle;
    }
    return low;
}

/* Returns the point whose family has this entry, by bisection. */
size_t pg_list_owner (const pg_family *family, size_t entry)
{
    size_t low = 0, high = family->n;
    while (low + 1 < high) {
        size_t middle = low + (high - low) / 2;
        if (family->start[middle] <= entry) low = middle;
        else high = middle;
    }
    return low;
}

typedef struct { bond_list *list; const unsigned char *alive; } update;

/* Sets the alive bits of slices first .. last - 1 from the mask of the family; g->alive NULL: all bonds are
 * intact. */
static void read_bits (void *context, size_t first, size_t last, int thread)
{
    const update *g = context;
    bond_list *list = g->list;
    (void) thread;
    for (size_t slice = first; slice < last; slice++)
        for (int k = 0; k < 2; k++)
            for (size_t slot = list->slots[k].start[slice]; slot < list->slots[k].start[slice + 1]; slot++) {
                bond_slots *slots = &list->slots[k];
                unsigned bits = 0;
                for (size_t lane = 0; lane < LIST_LANES; lane++) {
                    size_t p = slice * LIST_LANES + lane;
                    size_t q = pg_list_end (list, slots, slice, LIST_LANES * slot + lane);
                    if (p == q) continue;              /* a lane without a bond */
                    size_t i = (size_t) list->point[p], j = (size_t) list->point[q];
                    bits |= (unsigned) (!g->alive || g->alive[pg_list_entry (list->family, i, j)]) << lane;
                }
                slots->alive[slot] = (unsigned char) bits;
            }
}

/* Clears the alive bit of the bond from p to q (new numbers) if it is stored at p. */
static void clear_bond (bond_list *list, bond_slots *slots, size_t p, size_t q)
{
    size_t slice = p / LIST_LANES, lane = p % LIST_LANES;
    for (size_t slot = slots->start[slice]; slot < slots->start[slice + 1]; slot++)
        if (pg_list_end (list, slots, slice, LIST_LANES * slot + lane) == q)
            slots->alive[slot] &= (unsigned char) ~(1u << lane);
}

/* Clears the alive bits of bonds that broke. A bond is in the families of both ends; in the list it is stored
 * at one of them if it is shared, else at both. */
static void clear_changed (bond_list *list, const pg_changes *changes)
{
    const pg_family *family = list->family;
    for (size_t k = 0; k < changes->n; k++) {
        size_t e = changes->bond[k], p = (size_t) list->rank[pg_list_owner (family, e)];
        size_t q = (size_t) list->rank[family->node[e]];
        if (!list->law.shared || p / list->chunk != q / list->chunk) clear_bond (list, &list->slots[1], p, q);
        else clear_bond (list, &list->slots[0], p, q), clear_bond (list, &list->slots[0], q, p);
    }
}

/* Updates the alive bits: changes NULL: all, from the mask `alive` of the family; else those of the bonds
 * that broke. */
void pg_list_update (void *self, const unsigned char *alive, const pg_changes *changes)
{
    bond_list *list = self;
    if (changes) clear_changed (list, changes);
    else pg_parallel (list->threads, list->slices, read_bits, &(update) { list, alive });
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
typedef struct { bond_list *list; const double *u; list_kernel kernel; list_take take; void *context; } run;

/* Copies the m unknowns of points first .. last - 1 (new numbers) to their records; as old numbers are in no
 * order, later ones are prefetched. */
static inline __attribute__ ((always_inline)) void copy_unknowns (const run *g, size_t first, size_t last,
                                                                  const size_t m)
{
    enum { AHEAD = 40 };
    const bond_list *list = g->list;
    const int *point = list->point;
    const double *u = g->u, scale = list->scale;
    double *to = list->record + first * (size_t) list->pitch + list->dim;
    for (size_t p = first; p < last; p++, to += list->pitch) {
        const double *from = u + (size_t) point[p] * m;
        if (p + AHEAD < last) __builtin_prefetch (u + (size_t) point[p + AHEAD] * m);
        for (size_t c = 0; c < m; c++) to[c] = from[c] * scale;
    }
}

/* Copies unknowns of points first .. last - 1; their number is a constant in each branch. */
static void read_points (void *context, size_t first, size_t last, int thread)
{
    const run *g = context;
    (void) thread;
    switch (g->list->law.unknowns) {
    case 1: copy_unknowns (g, first, last, 1); break;
    case 2: copy_unknowns (g, first, last, 2); break;
    case 3: copy_unknowns (g, first, last, 3); break;
    default: copy_unknowns (g, first, last, 6);
    }
}

/* Copies unknowns u (n x m, old numbers) to the records, in the order and unit of the list. */
void pg_list_read (bond_list *list, const double *u)
{
    pg_parallel (list->threads, list->n, read_points, &(run) { .list = list, .u = u });
}

/* Reads the records of points first .. last - 1 into the second cache in one go: bonds use them in an order
 * that no prefetcher predicts. Plain reads, as processors drop so many prefetch instructions. */
static void warm_records (const bond_list *list, size_t first, size_t last)
{
    enum { LINE = 8 };                                 /* doubles of a cache line */
    const size_t end = last * (size_t) list->pitch;
    double sum = 0;
    for (size_t k = first * (size_t) list->pitch; k < end; k += LINE) sum += list->record[k];
    volatile double unused = sum;                      /* so that the reads are not left out */
    (void) unused;
}

/* Sums the chunks first .. last - 1, each by one thread, so that the order of sums does not depend on
 * threads. */
static void run_chunks (void *context, size_t first, size_t last, int thread)
{
    const run *g = context;
    bond_list *list = g->list;
    size_t sums = list->law.shared ? (size_t) list->pitch / 2 : (size_t) list->law.sums;
    double *sum = list->sum + (size_t) thread * list->chunk * sums;
    for (size_t chunk = first; chunk < last; chunk++) {
        size_t start = chunk * list->chunk;
        size_t end = list->n - start < list->chunk ? list->n : start + list->chunk;
        warm_records (list, start, end);
        list->broke[chunk] = (unsigned char) g->kernel (list, chunk, sum);
        g->take (g->context, list, start, end, sum);
    }
}

/* Runs a loop of the law over all chunks; `take` gets the sums of each chunk's points while they are in the
 * cache. */
void pg_list_run (bond_list *list, int loop, int check, list_take take, void *context)
{
    run g = { .list = list, .kernel = list->kernels->loop[loop][list->dim - 1][check], .take = take,
              .context = context };
    pg_parallel_heavy (list->threads, list->chunks, run_chunks, &g);
}

/* ---- broken bonds -------------------------------------------------------------------------------------- */
typedef struct { const bond_list *list; size_t n; size_t *bond; } collector;

/* Lists the entries of the bonds of a slot that broke (bits `lost`), or counts them (g->bond NULL); a shared
 * bond in both directions. */
static void collect (collector *g, const bond_slots *slots, size_t slice, size_t slot)
{
    const bond_list *list = g->list;
    for (size_t lane = 0; lane < LIST_LANES; lane++) {
        if (!(slots->lost[slot] >> lane & 1)) continue;
        size_t q = pg_list_end (list, slots, slice, LIST_LANES * slot + lane);
        size_t i = (size_t) list->point[slice * LIST_LANES + lane], j = (size_t) list->point[q];
        if (g->bond) g->bond[g->n] = pg_list_entry (list->family, i, j);
        g->n++;
        if (slots->shared && g->bond) g->bond[g->n] = pg_list_entry (list->family, j, i);
        g->n += slots->shared != 0;
    }
}

enum { COLLECT, FORGET, RESTORE };

/* Collects, forgets, or makes intact again the broken bonds of a slice. */
static void walk_slots (bond_slots *slots, size_t slice, int what, collector *found)
{
    for (size_t slot = slots->start[slice]; slot < slots->start[slice + 1]; slot++) {
        if (!slots->lost[slot]) continue;
        if (what == COLLECT) collect (found, slots, slice, slot);
        if (what == RESTORE) slots->alive[slot] |= slots->lost[slot];
        if (what != COLLECT) slots->lost[slot] = 0;
    }
}

/* Collects, forgets, or makes intact again the bonds that broke in the last loop, in all chunks that lost
 * any. */
static void walk_lost (bond_list *list, int what, collector *found)
{
    for (size_t chunk = 0; chunk < list->chunks; chunk++) {
        if (!list->broke[chunk]) continue;
        size_t first = chunk * list->chunk / LIST_LANES, last = (chunk + 1) * list->chunk / LIST_LANES;
        if (last > list->slices) last = list->slices;
        for (int k = 0; k < 2; k++)
            for (size_t slice = first; slice < last; slice++)
                walk_slots (&list->slots[k], slice, what, found);
    }
}

/* Appends the bonds that broke in the last loop. They are counted first, so that memory is allocated once;
 * without memory they become intact again, as the caller does not know of them. */
pg_status pg_list_lost (bond_list *list, pg_changes *broken)
{
    pg_status status = PG_OK;
    collector found = { .list = list };
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

/* ---- memory traffic ------------------------------------------------------------------------------------ */
/* Memory traffic of one loop, bytes per bond and per point. Lanes without a bond cost as much as bonds do. */
void pg_list_bytes (const void *self, double *per_bond, double *per_point)
{
    const bond_list *list = self;
    double bonds = (double) list->family->start[list->n], points = (double) list->n, bytes = 0;
    for (int k = 0; k < 2; k++) {
        double end = k == 0 ? sizeof (uint16_t) : sizeof (uint32_t);
        double bond = end + list->law.terms * (double) sizeof (double);
        bytes += (double) list->slots[k].start[list->slices] * (LIST_LANES * bond + 1);
    }
    *per_bond = bonds > 0 ? bytes / bonds : 0;
    /* unknowns and forces; number of the point, twice; record written and read; share of the slices' starts
     * and limits */
    *per_point = points > 0 ? 2.0 * list->law.unknowns * sizeof (double) + 2 * sizeof (int)
                              + 1.5 * list->pitch * sizeof (double)
                              + 2 * (2 * sizeof (size_t) + 1.0) / LIST_LANES : 0;
}
