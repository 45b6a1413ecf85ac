/* SPDX-License-Identifier: GPL-3.0-or-later
 * list.h: bonds as a list, for any cloud of points (private). This is a traversal: it has the pairs of points
 * and loads the data of both ends of eight bonds at a time into vectors. What a bond does is defined by a law
 * (law_pair.h, law_state.h, law_beam.h); list_laws.h names the laws, list_kernel.h combines the two.
 *
 * Points are renumbered (new numbers, also called ranks) so that a chunk of consecutive points is compact in
 * space. Eight consecutive points are a slice: their k-th bonds lie side by side, a slot, padded with broken
 * ones (the format known as SELL-8). If a law has equal and opposite forces, a bond inside a chunk is stored
 * once, at the end of lower rank, and its force goes to both ends ("shared"). All other bonds are stored at
 * both ends, in the order of the family, so that every point sums its own bonds in that order. A chunk is
 * summed by one thread, in one order: the same bits for any number of threads.
 *
 * A record has the numbers of a point that a law reads: its position, its unknowns (displacement, rotation),
 * and what the law adds. Its length, the pitch, is a power of two doubles, so that a record lies in few cache
 * lines. */
#ifndef PERIGAL_SUMS_LIST_H
#define PERIGAL_SUMS_LIST_H
#include "mechanics/sums/terms/bond_loop.h"
#include "list_laws.h"
#include <stdint.h>

enum { LIST_LANES = 8, LIST_TERMS = 3, LIST_CONSTANTS = 6 };

/* Bonds of one sort (shared or not), lane by lane. */
typedef struct {
    int       shared;                                  /* 1: bonds inside a chunk, stored once */
    size_t   *start;                                   /* first slot of each slice (slices + 1) */
    uint16_t *near;     /* shared: offset of the other end's record in its chunk, doubles (8 per slot) */
    uint32_t *far;      /* others: offset of the other end's record in all records, doubles (8 per slot) */
    double   *term[LIST_TERMS];                        /* numbers of each bond for the law (8 per slot) */
    unsigned char *alive, *lost;                       /* a bit per lane; lost: broken in this loop (slots) */
    size_t   *limit_at;                                /* where the limits of each slice begin (slices) */
    unsigned char *limit_step;   /* 0: the same 8 limits for all slots of a slice, 8: each its own (slices) */
} bond_slots;

typedef struct bond_list bond_list;
/* Sums a law over the bonds of a chunk's points into `sum`; with limits, bonds at or over these are broken
 * first. Returns whether one was. sum: of a shared law pitch / 2 numbers per point, else 8 lanes of each
 * number for every slice (pg_list_sum). */
typedef int (*list_kernel) (const bond_list *list, size_t chunk, double *sum);
typedef struct { list_kernel loop[LIST_LOOPS][3][2]; } list_kernels;   /* [dim - 1][check]; NULL: none */
extern const list_kernels pg_list_scalar, pg_list_avx2, pg_list_avx512;

/* Properties of a law by which its list is built. places: positions in records: in m (AS_THEY_ARE), or in
 * steps of the lattice if there is one (EQUAL_STEPS: only if steps are equal along all axes), so that bonds
 * are the same everywhere. */
typedef struct {
    int    shared;                                     /* 1: forces on both ends are equal and opposite */
    int    pitch, unknowns, sums;                    /* doubles of a record; unknowns, most sums of a point */
    int    terms;                                      /* numbers of a bond */
    enum { LIST_AS_THEY_ARE, LIST_EQUAL_STEPS, LIST_STEPS } places;
    /* Computes the numbers of the bond between points i and j from xi (m) and weight of pg_sums_bonds. */
    void (*term) (const bond_list *list, size_t i, size_t j, const double *xi, double weight, double *out);
    /* Returns the limit of the law's measure of the bond; called only if bonds may break. */
    double (*limit) (const bond_list *list, size_t i, size_t j);
} list_law;

struct bond_list {
    pg_bond_loop_setting setting;
    const pg_sums   *sums;
    const pg_family *family;
    const list_kernels *kernels;
    list_law law;
    int     dim, threads, pitch;
    size_t  n, chunk, chunks, slices;                  /* points; points of a chunk (a multiple of 8) */
    int     whole;                                     /* 1: positions in records are in lattice steps */
    double  scale;                                     /* factor of the unknowns in records */
    double  constant[LIST_CONSTANTS];                  /* numbers of the law that all bonds share */
    int    *point, *rank;                            /* old number of each new one, new of each old one (n) */
    /* While the list is built: rank of each point (old number) before the points of a chunk were sorted; the
     * end for which it is lower keeps a shared bond (n). */
    int    *before;
    double *record;                                    /* records (8 slices x pitch) */
    bond_slots slots[2];                               /* shared bonds, others */
    double *limit; size_t limits, limit_cap;           /* limits by eights; limits 0: nothing breaks */
    double *sum;                                       /* sums of a chunk, for each thread */
    unsigned char *broke;                              /* 1: a bond broke in this loop (chunks) */
};

/* Makes the list of setting's bonds, all intact, at the start of a struct of `bytes`, the rest of which is
 * the caller's. *self is set even after a failure: it is to be freed with pg_list_free in any case. `prepare`
 * (or NULL) is called when points are numbered and records have positions, before terms and limits are
 * computed. */
typedef void (*list_prepare) (bond_list *list);
pg_status pg_list_create (void **self, size_t bytes, const pg_bond_loop_setting *setting, pg_instructions set,
                          const list_law *law, list_prepare prepare);
void      pg_list_free   (void *self);
void      pg_list_bytes  (const void *self, double *per_bond, double *per_point);
void      pg_list_update (void *self, const unsigned char *alive, const pg_changes *changes);
void      pg_list_read   (bond_list *list, const double *u);      /* copies unknowns (n x m) to the records */
/* Runs a loop over all chunks and passes the sums of each chunk to `take`: points first .. last - 1 (new
 * numbers). */
typedef void (*list_take) (void *context, const bond_list *list, size_t first, size_t last,
                           const double *sum);
void      pg_list_run    (bond_list *list, int loop, int check, list_take take, void *context);
/* Appends the bonds that broke in the last run to `broken`; without memory for this none is broken. */
pg_status pg_list_lost   (bond_list *list, pg_changes *broken);
pg_status pg_list_order  (bond_list *list);            /* numbers the points: point, rank, before */
pg_status pg_list_fill   (bond_list *list);            /* fills slots and limits of the bonds */
/* Entry of the family of the bond from point i to point j (old numbers). */
size_t    pg_list_entry  (const pg_family *family, size_t i, size_t j);
size_t    pg_list_owner  (const pg_family *family, size_t entry);      /* the point whose bond an entry is */

/* For a law that is not shared: returns number c of the `sums` numbers of the chunk's point k. */
static inline double pg_list_sum (const double *sum, int sums, size_t k, int c)
{
    return sum[(k / LIST_LANES * (size_t) sums + (size_t) c) * LIST_LANES + k % LIST_LANES];
}

/* Returns the new number of the other end of bond `at` (8 slot + lane) of a slice. */
static inline size_t pg_list_end (const bond_list *list, const bond_slots *slots, size_t slice, size_t at)
{
    if (!slots->shared) return slots->far[at] / (size_t) list->pitch;
    return slice * LIST_LANES / list->chunk * list->chunk + slots->near[at] / (size_t) list->pitch;
}

/* For a law that is not shared: is bond k of point p (new number), in the order of its family, intact? */
static inline int pg_list_alive (const bond_list *list, size_t p, size_t k)
{
    const bond_slots *slots = &list->slots[1];
    return slots->alive[slots->start[p / LIST_LANES] + k] >> p % LIST_LANES & 1;
}
#endif
