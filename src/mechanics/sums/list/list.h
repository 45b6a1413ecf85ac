/* SPDX-License-Identifier: GPL-3.0-or-later
 * list.h: bonds as a list, for any cloud of points (private). This is a traversal: it knows which points are
 * bonded and brings both ends of eight bonds at a time into vectors, but not what a bond does. That is said
 * by a law (law_pair.h, law_state.h, law_beam.h); list_laws.h names the laws, list_kernel.h marries the two.
 *
 * Points are renumbered into compact chunks. Eight points that follow each other are a slice: their k-th
 * bonds lie side by side, a slot, padded with dead ones (the format known as SELL-8). Of a law whose bond
 * forces are equal and opposite a bond inside a chunk is stored once, at the end of lower rank, and its
 * force goes to both ends ("shared"). All other bonds are stored at both ends, in the order of the family,
 * so that every point adds up its own bonds in that order. A chunk's sums are the work of one thread, in one
 * order: the same bits for any number of threads.
 *
 * A record holds what a law reads of a point: its place, its unknowns (displacement, rotation), and what the
 * law adds. Its length, the pitch, is a power of two doubles, so that a record lies in as few cache lines as
 * it can. */
#ifndef PERIGAL_SUMS_LIST_H
#define PERIGAL_SUMS_LIST_H
#include "mechanics/sums/terms/bond_loop.h"
#include "list_laws.h"
#include <stdint.h>

enum { LIST_LANES = 8, LIST_TERMS = 3, LIST_CONSTANTS = 6 };

/* Bonds of one sort, lane by lane. */
typedef struct {
    int       shared;                                  /* 1: inside a chunk, stored once */
    size_t   *start;                                   /* first slot of each slice (slices + 1) */
    uint16_t *near;     /* shared: the other end's record from the chunk's first, in doubles (8 a slot) */
    uint32_t *far;                                     /* else from the first record of all (8 a slot) */
    double   *term[LIST_TERMS];                        /* what the law knows of each bond (8 a slot each) */
    unsigned char *alive, *lost;                       /* a bit per lane; lost: died in this loop (slots) */
    size_t   *limit_at;                                /* of each slice: where its limits begin (slices) */
    unsigned char *limit_step;     /* 0: the same 8 limits for all its slots, 8: each has its own (slices) */
} bond_slots;

typedef struct bond_list bond_list;
/* Sums a law over the bonds of a chunk's points into `sum`; with limits, bonds at or over theirs die first.
 * Returns whether one did. Of a shared law sum has pitch / 2 numbers a point, else 8 lanes of each number for
 * every slice: see pg_list_sum. */
typedef int (*list_kernel) (const bond_list *list, size_t chunk, double *sum);
typedef struct { list_kernel loop[LIST_LOOPS][3][2]; } list_kernels;   /* [dim - 1][check]; NULL: none */
extern const list_kernels pg_list_scalar, pg_list_avx2, pg_list_avx512;

/* What a law tells of itself when its list is built. Places in records: as they are, or in steps of the
 * lattice where there is one (with steps equal along all axes), so that its bonds are alike everywhere. */
typedef struct {
    int    shared;                                     /* forces on both ends are equal and opposite */
    int    pitch, unknowns, sums;                      /* doubles of a record, of a point; most sums of it */
    int    terms;                                      /* numbers of a bond */
    enum { LIST_AS_THEY_ARE, LIST_EQUAL_STEPS, LIST_STEPS } places;
    /* The numbers of the bond of points i and j as xi (m) and weight of pg_sums_bonds say. */
    void (*term) (const bond_list *list, size_t i, size_t j, const double *xi, double weight, double *out);
    /* What the law compares its measure of the bond with; asked for only where bonds may break. */
    double (*limit) (const bond_list *list, size_t i, size_t j);
} list_law;

struct bond_list {
    pg_bond_loop_setting setting;
    const pg_sums   *sums;
    const pg_family *family;
    const list_kernels *kernels;
    list_law law;
    int     dim, threads, pitch;
    size_t  n, chunk, chunks, slices;                  /* points, points a chunk (a multiple of 8) */
    int     whole;                                     /* records hold places in steps of the lattice */
    double  scale;                                     /* factor of the unknowns in records */
    double  constant[LIST_CONSTANTS];                  /* what the law knows of all bonds */
    int    *point, *rank;                              /* new to old number, old to new (n) */
    /* of an old number: rank before points of a chunk were sorted; the lower end keeps a shared bond
     * (n, while built) */
    int    *before;
    double *record;                                    /* pitch per point, slices full */
    bond_slots slots[2];                               /* shared, others */
    double *limit; size_t limits, limit_cap;           /* eights; none: nothing breaks */
    double *sum;                                       /* of a chunk, for each thread */
    unsigned char *broke;                              /* chunk: a bond died in this loop */
};

/* The list of setting's bonds, all alive, at the start of `bytes` bytes: what follows it is the caller's.
 * *self is set even after a failure: free it with pg_list_free in any case. `prepare` (or NULL) is called
 * when points are numbered and placed, before terms and limits are asked for. */
typedef void (*list_prepare) (bond_list *list);
pg_status pg_list_create (void **self, size_t bytes, const pg_bond_loop_setting *setting, pg_instructions set,
                          const list_law *law, list_prepare prepare);
void      pg_list_free   (void *self);
void      pg_list_bytes  (const void *self, double *per_bond, double *per_point);
void      pg_list_update (void *self, const unsigned char *alive, const pg_changes *changes);
void      pg_list_read   (bond_list *list, const double *u);           /* unknowns (n x m) into the records */
/* Runs a loop over all chunks and hands each chunk's sums to `take`: points first .. last - 1 of the new
 * order. */
typedef void (*list_take) (void *context, const bond_list *list, size_t first, size_t last,
                           const double *sum);
void      pg_list_run    (bond_list *list, int loop, int check, list_take take, void *context);
/* Appends the bonds that died in the last run to `broken`; without memory for it none did. */
pg_status pg_list_lost   (bond_list *list, pg_changes *broken);
pg_status pg_list_order  (bond_list *list);            /* point, rank, before */
pg_status pg_list_fill   (bond_list *list);            /* fills slots and limits of the bonds */
/* Entry of the family of the bond from point i to point j (old numbers). */
size_t    pg_list_entry  (const pg_family *family, size_t i, size_t j);
size_t    pg_list_owner  (const pg_family *family, size_t entry);      /* the point whose bond an entry is */

/* Of a law that is not shared: number c of `sums` numbers of the chunk's point k. */
static inline double pg_list_sum (const double *sum, int sums, size_t k, int c)
{
    return sum[(k / LIST_LANES * (size_t) sums + (size_t) c) * LIST_LANES + k % LIST_LANES];
}

/* New number of the other end of bond `at` (8 slot + lane) of a slice. */
static inline size_t pg_list_end (const bond_list *list, const bond_slots *slots, size_t slice, size_t at)
{
    if (!slots->shared) return slots->far[at] / (size_t) list->pitch;
    return slice * LIST_LANES / list->chunk * list->chunk + slots->near[at] / (size_t) list->pitch;
}

/* Of a law that is not shared: does bond k of point p (new number) of the family live? */
static inline int pg_list_alive (const bond_list *list, size_t p, size_t k)
{
    const bond_slots *slots = &list->slots[1];
    return slots->alive[slots->start[p / LIST_LANES] + k] >> p % LIST_LANES & 1;
}
#endif
