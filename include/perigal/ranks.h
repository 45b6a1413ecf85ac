/* SPDX-License-Identifier: GPL-3.0-or-later
 * ranks.h: a run that several processes share, each of them a rank (domain decomposition). Every rank holds
 * a subdomain of the body: the points that it owns, and around them ghosts, points of other ranks, as wide
 * a layer as the method sees. This folder says what a subdomain and its halo are and how a lattice is
 * divided; how messages travel is given from outside (pg_ranks_join: src/app/mpi does it by MPI), so that the
 * library knows of no such package. Alone, without ranks, every call here is one that does nothing. */
#ifndef PERIGAL_RANKS_H
#define PERIGAL_RANKS_H
#include "perigal/base.h"

PG_API_BEGIN

/* ---- messages ------------------------------------------------------------------------------------------ */
/* Which points change hands when ghosts are brought up to date: `send` to each neighbour, points that are
 * owned here, `receive` from it, ghosts here; both sides list them in the same order. */
typedef struct {
    size_t  n;                                         /* neighbours */
    int    *rank;                                      /* their ranks, ascending (n) */
    size_t *send_first, *receive_first;                /* where the lists of each begin (n + 1) */
    int    *send, *receive;                            /* numbers of points */
} pg_halo;
void pg_halo_clear (pg_halo *halo);

/* What the ranks of a run do together. All ranks make the same calls in the same order. A function that
 * fails returns a status with a message (pg_error), then the run cannot go on. */
typedef struct {
    int   rank, size;                                  /* of this process, from 0; how many there are */
    void *context;                                     /* passed to the functions */
    /* In place: the sum, or the largest, over all ranks of each of n numbers; the same bits on all ranks. */
    pg_status (*sum)  (void *context, size_t n, double *value);
    pg_status (*most) (void *context, size_t n, double *value);
    /* Ghosts take the values of their owners: value has `components` numbers a point. */
    pg_status (*exchange) (void *context, const pg_halo *halo, size_t components, double *value);
    /* The bytes of all ranks, in the order of the ranks, on rank 0: *all (pg_free), *bytes_all; elsewhere
     * NULL and 0. */
    pg_status (*collect)  (void *context, size_t bytes, const void *mine, size_t *bytes_all, void **all);
    /* The numbers of all ranks, in the order of the ranks, on every rank: *all (pg_free), *n_all. */
    pg_status (*share)    (void *context, size_t n, const double *mine, size_t *n_all, double **all);
    int   whole;                                       /* 1: this process alone stands for all of them */
} pg_ranks;
/* Ranks that this process plays alone, holding the whole body: what so many ranks would refuse is asked
 * without any of them. Sums and exchanges leave values as they are. */
void pg_ranks_stand_in (pg_ranks *out, int size);
/* From now on this process is one of these ranks; NULL: it is alone again. Borrowed. */
void pg_ranks_join (const pg_ranks *ranks);
/* What ranks share. divided 1 (as at the start): the body, each holding a subdomain. 0: every rank holds the
 * whole body and does the same steps with the same bits (lock-step), and only linear solvers that know of
 * each other share work; then the calls below, but for pg_ranks_ask and pg_ranks_agree, do nothing. */
void pg_ranks_divide (int divided);
/* The ranks that share the body; NULL: alone, or in lock-step. */
const pg_ranks *pg_ranks_now (void);
int  pg_rank (void);                                   /* 0 where it is alone */
int  pg_rank_count (void);                             /* 1 where it is alone */
/* Wall time that this process has spent in the calls below, waiting for other ranks included, s. */
double pg_ranks_seconds (void);
/* Sum and largest over all ranks of each of n numbers, in place; alone nothing changes. */
pg_status pg_ranks_sum  (size_t n, double *value);
pg_status pg_ranks_most (size_t n, double *value);
/* Collects on rank 0; alone a copy of `mine`. */
pg_status pg_ranks_collect (size_t bytes, const void *mine, size_t *bytes_all, void **all);
/* The numbers of all ranks on every rank; alone a copy. For few. */
pg_status pg_ranks_share (size_t n, const double *mine, size_t *n_all, double **all);
/* The largest over all ranks, also in lock-step: for what a clock or a signal decides. */
pg_status pg_ranks_ask  (size_t n, double *value);
/* What one rank has met all have met: the first failure (of the lowest rank) is returned on every rank, with
 * its message. */
pg_status pg_ranks_agree (pg_status status);

/* ---- subdomains ---------------------------------------------------------------------------------------- */
/* Sites or cells of a lattice: low .. high - 1 along each axis (0 .. 0 beyond its dimension). */
typedef struct { int low[3], high[3]; } pg_box;
/* What a rank holds of the points. */
typedef struct {
    size_t n, nowned;                                  /* points, and those of them that are owned */
    unsigned char *owned;                              /* per point; 0: a ghost (n) */
    /* Of each point, the number that it would have if all points of the body were one list (from 0, in the
     * order of the lattice); the same on all ranks that hold it (n). */
    int64_t *number;
    int64_t  total;                                    /* points of the body */
    pg_halo  halo;
    double   width;                                    /* of the layer of ghosts, m */
    /* On lattices: sites that are owned, and all that are held. */
    pg_box   own, held;
} pg_subdomain;
void pg_subdomain_free (pg_subdomain **subdomain);
/* 1: the point is owned, or there are no ranks (subdomain NULL). */
static inline int pg_owns (const pg_subdomain *s, size_t point) { return !s || s->owned[point]; }
/* Ghosts take the values of their owners; nothing alone. */
pg_status pg_subdomain_exchange (const pg_subdomain *subdomain, size_t components, double *value);
/* Values of ghosts become zero: sums over all points then count each point of the body once. */
void      pg_subdomain_clear_ghosts (const pg_subdomain *subdomain, size_t components, double *value);

/* Parts of the body that hang together. parent: sets of the n points that this rank holds (pg_disjoint),
 * joined by whatever joins an owned point to another one. label (n): the least number (pg_subdomain.number;
 * alone: index) of all points of the part, over all ranks; of ghosts that of their owner. With several
 * components, each point has so many members of sets; member k of a point has the number of the point times
 * the components, plus k, among them (parent, label: n x components). All ranks call. */
pg_status pg_subdomain_label (const pg_subdomain *subdomain, size_t n, size_t components, int *parent,
                              double *label);

/* Counts the sets `parent` of pg_subdomain_label over all ranks: out[0]: points joined to none, out[1]: parts
 * of several points; each is counted where the point is owned that it is labelled by. All ranks call. */
pg_status pg_subdomain_count (const pg_subdomain *subdomain, size_t n, int *parent, double *out /* (2) */);

/* How many cells that count (those in the body) plane `plane` along `axis` has within a box. */
typedef double (*pg_plane_count) (const void *context, const pg_box *box, int axis, int plane);
/* Recursive bisection of a box of cells into one box a rank: each box is cut across its longest axis (steps:
 * m) where the numbers of cells that count are nearest to the shares of the ranks on both sides. The planes
 * are counted by all ranks together. The same boxes on all ranks. PG_E_LIMIT: more ranks than planes to cut
 * at. */
pg_status pg_boxes_divide (pg_box *out /* (size) */, const pg_box *whole, const double *steps, int size,
                           pg_plane_count count, const void *context);
PG_API_END
#endif
