/* SPDX-License-Identifier: GPL-3.0-or-later
 * list.h: bonds as a list, for any cloud (private). Points are renumbered into compact chunks. A bond inside
 * a chunk is stored once, at the end of lower rank, and its force goes to both ends; one between chunks is
 * stored at both ends. So a chunk's forces are summed by one thread, in one order, whatever the number of
 * threads. Eight points that follow each other are a slice: their k-th bonds lie side by side, a slot, padded
 * with dead ones. A record holds a point's place and displacement, {x, u} {x, y, u, v} {x, y, z, u, v, w, -,
 * -}: one load brings a neighbour. */
#ifndef PERIGAL_SUMS_LIST_H
#define PERIGAL_SUMS_LIST_H
#include "bond_loop.h"
#include <stdint.h>

enum { LIST_LANES = 8 };

typedef struct {                                       /* bonds of one sort, lane by lane */
    int       shared;                                  /* 1: inside a chunk, stored once */
    size_t   *start;                                   /* first slot of each slice (slices + 1) */
    uint16_t *near;  /* shared: the other end's record from the chunk's first, in doubles (8 a slot) */
    uint32_t *far;                                     /* else from the first record of all (8 a slot) */
    double   *a;  /* linear: c k beta g V V / r^3, F = a (xi.eta) xi; finite: r^2 times this (8 a slot) */
    unsigned char *alive, *lost;                       /* a bit per lane; lost: died in this sweep (slots) */
    size_t   *limit_at;                                /* of each slice: where its limits begin (slices) */
    unsigned char *limit_step;  /* 0: the same 8 limits for all its slots, 8: each has its own (slices) */
} bond_slots;

/* Sums the forces of a chunk's points (and of shared bonds' other ends) into sum (points x pitch / 2); with
 * check, bonds over their limit die first. Returns whether one did. [dim - 1][finite][check] */
typedef struct bond_list bond_list;
typedef int (*bond_list_kernel) (const bond_list *list, size_t chunk, double *sum);
extern const bond_list_kernel bond_list_scalar[3][2][2], bond_list_avx2[3][2][2], bond_list_avx512[3][2][2];

struct bond_list {
    const pg_sums   *sums;
    const pg_family *family;
    int     dim, finite, threads, pitch;  /* pitch: doubles a record; half of it a point's force */
    const bond_list_kernel *kernel;                    /* [check] */
    size_t  n, chunk, chunks, slices;                  /* points, points a chunk (a multiple of 8) */
    double  unit, scale;  /* m per unit of the records' places; factor of displacements */
    int    *point, *rank;                              /* new to old number, old to new (n) */
    /* of an old number: rank before points of a chunk were sorted; the lower end keeps a shared bond (n,
     * while built) */
    int   *before;
    double *record;                                    /* pitch per point, slices full */
    bond_slots slots[2];                               /* shared, others */
    /* eights: linear s0 unit, finite s0 (2 + s0); none: nothing breaks */
    double *limit; size_t limits, limit_cap;
    double *sum;                                       /* forces of a chunk, for each thread */
    double *energy;                                    /* of each chunk */
    unsigned char *broke;                              /* chunk: a bond died in this sweep */
};

pg_status bond_list_order  (bond_list *list);           /* point, rank, before */
pg_status bond_list_fill   (bond_list *list, const pg_bond_loop_setting *setting);     /* slots and limits */
/* New number of the other end of bond `at` (8 slot + lane) of a slice. */
static inline size_t bond_list_end (const bond_list *list, const bond_slots *slots, size_t slice, size_t at)
{
    if (!slots->shared) return slots->far[at] / (size_t) list->pitch;
    return slice * LIST_LANES / list->chunk * list->chunk + slots->near[at] / (size_t) list->pitch;
}

#endif
