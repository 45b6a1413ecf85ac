/* SPDX-License-Identifier: GPL-3.0-or-later
 * ranks.h: a run that several processes share, each of them a rank (domain decomposition). Every rank holds a
 * subdomain of the body: the points that it owns, and around them a layer of ghosts, points of other ranks,
 * as wide as the method needs. This folder says what a subdomain and its halo are and how a lattice is
 * divided; the transport of messages is supplied by the calling program (pg_ranks_join; src/app/mpi uses
 * MPI), so that the library depends on no such package. In serial runs the calls here do nothing. */
#ifndef PERIGAL_RANKS_H
#define PERIGAL_RANKS_H
#include "perigal/base.h"

PG_API_BEGIN

/* ---- messages ------------------------------------------------------------------------------------------ */
/* Communication lists for updating ghosts: owned points to `send` to each neighbouring rank, and ghosts to
 * `receive` from it; both ranks list them in the same order. */
typedef struct {
    size_t  n;                                         /* number of neighbouring ranks */
    int    *rank;                                      /* their ranks, ascending (n) */
    size_t *send_first, *receive_first;                /* start of each neighbour's list (n + 1) */
    int    *send, *receive;                            /* point indices */
} pg_halo;
void pg_halo_clear (pg_halo *halo);

/* Collective operations of the ranks of a run. All ranks make the same calls in the same order. A function
 * that fails returns a status with a message (pg_error), then the run cannot go on. */
typedef struct {
    int   rank, size;                                  /* number of this process, from 0; number of ranks */
    void *context;                                     /* passed to the functions */
    /* In place: the sum, or the largest, over all ranks of each of n numbers; the same bits on all ranks. */
    pg_status (*sum)  (void *context, size_t n, double *value);
    pg_status (*most) (void *context, size_t n, double *value);
    /* Copies the values of owned points to their ghosts on other ranks: value has `components` numbers per
     * point. */
    pg_status (*exchange) (void *context, const pg_halo *halo, size_t components, double *value);
    /* Gathers the bytes of all ranks, in the order of the ranks, on rank 0: *all (pg_free), *bytes_all; on
     * other ranks NULL and 0. */
    pg_status (*collect)  (void *context, size_t bytes, const void *mine, size_t *bytes_all, void **all);
    /* Gathers the numbers of all ranks, in the order of the ranks, on every rank: *all (pg_free), *n_all. */
    pg_status (*share)    (void *context, size_t n, const double *mine, size_t *n_all, double **all);
    int   whole;                                       /* 1: this process alone simulates all ranks */
} pg_ranks;
/* Makes `size` ranks that this single process simulates with the whole body, to test what a run with so many
 * ranks would refuse. Sums and exchanges leave values unchanged. */
void pg_ranks_stand_in (pg_ranks *out, int size);
/* Makes this process one of these ranks (borrowed); NULL: back to a serial run. */
void pg_ranks_join (const pg_ranks *ranks);
/* Chooses how ranks work. divided 1 (initially): each stores a subdomain. 0 (lock-step): every rank stores
 * the whole body and does the same steps with the same bits, and only distributed linear solvers share work;
 * then the calls below, except pg_ranks_ask and pg_ranks_agree, do nothing. */
void pg_ranks_divide (int divided);
/* The ranks that divide the body; NULL: serial run, or lock-step. */
const pg_ranks *pg_ranks_now (void);
int  pg_rank (void);                                   /* 0 in a serial run */
int  pg_rank_count (void);                             /* 1 in a serial run */
/* Wall time that this process has spent in the calls below, waiting for other ranks included, s. */
double pg_ranks_seconds (void);
/* Sum and maximum over all ranks of each of n numbers, in place; serial runs: unchanged. */
pg_status pg_ranks_sum  (size_t n, double *value);
pg_status pg_ranks_most (size_t n, double *value);
/* Gathers bytes on rank 0 (pg_ranks.collect); serial runs: a copy of `mine`. */
pg_status pg_ranks_collect (size_t bytes, const void *mine, size_t *bytes_all, void **all);
/* Gathers the numbers of all ranks on every rank (pg_ranks.share); serial runs: a copy. For small n. */
pg_status pg_ranks_share (size_t n, const double *mine, size_t *n_all, double **all);
/* Maximum over all ranks of each of n numbers, also in lock-step: for decisions by a clock or a signal. */
pg_status pg_ranks_ask  (size_t n, double *value);
/* Makes a failure common to all ranks: the failure of the lowest rank that has one is returned on every rank,
 * with its message. */
pg_status pg_ranks_agree (pg_status status);

/* ---- subdomains ---------------------------------------------------------------------------------------- */
/* A box of sites or cells of a lattice, indices low .. high - 1 along each axis (0 .. 0 beyond its
 * dimension). */
typedef struct { int low[3], high[3]; } pg_box;
/* The points stored on a rank. */
typedef struct {
    size_t n, nowned;                                  /* numbers of points stored, of points owned */
    unsigned char *owned;                              /* 1: owned point, 0: ghost (n) */
    /* Global number of each point, in the list of all points of the body (from 0, in the order of the
     * lattice); equal on all ranks that store it (n). */
    int64_t *number;
    int64_t  total;                                    /* number of points of the body */
    pg_halo  halo;
    double   width;                                    /* width of the layer of ghosts, m */
    /* Lattices only: sites that this rank owns, and all that it stores. */
    pg_box   own, held;
} pg_subdomain;
void pg_subdomain_free (pg_subdomain **subdomain);
/* Returns 1: this rank owns the point (always in serial runs, s NULL). */
static inline int pg_owns (const pg_subdomain *s, size_t point) { return !s || s->owned[point]; }
/* Updates the values of ghosts from their owners; does nothing in serial runs. */
pg_status pg_subdomain_exchange (const pg_subdomain *subdomain, size_t components, double *value);
/* Sets the values of ghosts to zero, so that sums over all ranks count each point of the body once. */
void      pg_subdomain_clear_ghosts (const pg_subdomain *subdomain, size_t components, double *value);

/* Labels the connected parts of the body over all ranks. parent: disjoint sets of the n points stored on this
 * rank (pg_disjoint), joined through owned points. label (n): least global number (pg_subdomain.number;
 * serial: index) of the points of the part; for ghosts that of their owner. With several components each
 * point stands for so many members, member k having number point * components + k (parent, label: n x
 * components). All ranks call. */
pg_status pg_subdomain_label (const pg_subdomain *subdomain, size_t n, size_t components, int *parent,
                              double *label);

/* Counts the sets `parent` of pg_subdomain_label over all ranks: out[0]: points joined to none, out[1]: parts
 * of several points; a part is counted on the rank that owns the point of its label. All ranks call. */
pg_status pg_subdomain_count (const pg_subdomain *subdomain, size_t n, int *parent, double *out /* (2) */);

/* Number of cells in the body in plane `plane` normal to `axis`, within a box. */
typedef double (*pg_plane_count) (const void *context, const pg_box *box, int axis, int plane);
/* Recursive bisection of a box of cells into one box a rank: each box is cut across its longest axis (steps:
 * m) so that the numbers of cells in the body on both sides are as near as possible to the ranks' shares. All
 * ranks count planes together and get the same boxes. PG_E_LIMIT: more ranks than planes to cut at. */
pg_status pg_boxes_divide (pg_box *out /* (size) */, const pg_box *whole, const double *steps, int size,
                           pg_plane_count count, const void *context);
PG_API_END
#endif
