/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the inverse of the matrix of a linear system, updated as the matrix changes.
 *
 * At the *base* the matrix A (k K + m M, after elimination of supports) was factored. Since then K has
 * changed by W D W', where the columns of W select the t *touched* unknowns and D (t x t, symmetric) is
 * summed up from the changes that the force reports (pg_force_type.change), or that a caller has found. With
 * the Green columns G = A^-1 W (n x t) and H = W' G
 *
 *     (A + W D W')^-1 r = z - G (1 + D H)^-1 D W' z,    z = A^-1 r             (Woodbury's identity)
 *
 * and between touched unknowns the inverse is H (1 + D H)^-1. No sparse matrix is changed. A Green column is
 * computed when its unknown is touched for the first time, together with all others of that change.
 *
 * When t has grown so far that the dense algebra since the base has cost more than a new base would (counted,
 * by stored rates: rent or buy), one is due; the caller decides when. Nothing here depends on a clock, and
 * only BLAS uses threads. Files: inverse.c, inverse_touched.c (the dense system), inverse_columns.c (Green
 * columns). */
#ifndef PG_INVERSE_H
#define PG_INVERSE_H
#include "solve/run/solve.h"

/* What is kept of a Green column: all numbers, as displacements of the whole body are sums of columns; half
 * of its solve, from whose products H is made; or only its entries in H. */
typedef enum { INVERSE_COLUMNS, INVERSE_HALVES, INVERSE_BLOCK } inverse_keeps;

/* Outcome of taking the changes of a refresh into the inverse. */
typedef enum {
    INVERSE_SAME,                                      /* neither K nor forces changed */
    INVERSE_TAKEN,                                     /* the change is taken in */
    INVERSE_DUE,                                       /* it is taken in, and a new base would pay now */
    /* A new base is needed: the force cannot tell its change, elimination (T) changed, there are too many
     * touched unknowns, or the factor of the base is gone. */
    INVERSE_LOST
} inverse_outcome;

/* The matrix that was factored. */
typedef struct {
    int     made;
    long    factorizations;                            /* count of the run when the base was made */
    double *diagonal;                                  /* of the factored matrix, N/m (ndof) */
    double  k;                                         /* the matrix is k K + m M; 1 in statics */
    double  spring;                                    /* on all touched unknowns of the factor, N/m */
    double  bare;  /* spring on unknowns without any stiffness left, N/m; 0: their old one */
} inverse_base;

/* The dense system of the t touched unknowns: arrays of length cap, matrices by columns that are cap
 * apart. */
typedef struct {
    size_t  t, cap;
    size_t *dof;                                       /* their numbers among the full unknowns */
    int    *at;  /* index + 1 of each full unknown, 0: not touched (ndof) */
    double *D;                                         /* change of K on the touched unknowns, N/m */
    double *stay;  /* added to D on the diagonal of the system: springs where nothing else holds, N/m */
    double *H;                                         /* H = W' A^-1 W, m/N */
    double *M, *factor;                                /* M = 1 + (D + stay) H; its LU factors */
    int    *pivot, factored;
    double  pivots;                                    /* least pivot over the largest entry of M */
    double *pack, *product;  size_t room_pack, room_product;       /* workspace for gathered blocks */
} touched_unknowns;

enum { CHUNK = 64 };                                   /* columns in an allocated piece of G */
/* Columns of the inverse at the base. */
typedef struct {
    size_t *group, ngroup, room_group;                 /* numbers of unknowns taken in together */
    double **chunk; size_t nchunk, room_chunk;         /* G, in pieces of CHUNK columns (ndof x CHUNK) */
    double **half; size_t room_half;                   /* workspace: pointers to new halves */
    double *rhs, *solved;  size_t room_rhs, room_solved;  /* right-hand sides, solutions: nred x new */
    double  seconds;                                   /* spent on halved columns, by stored rates */
} green_columns;

typedef struct inverse {
    pg_system *s;
    inverse_keeps    keeps;
    inverse_base     base;
    touched_unknowns touched;
    green_columns    columns;
    int     loads;  /* 1: the last change that was taken in also changes constant forces */
    int     restored;                                  /* 1: read back, Green columns not made yet */
    double  rent;  /* dense algebra since the base, in seconds by stored rates */
} inverse;

/* ---- inverse.c ----------------------------------------------------------------------------------------- */
/* *out NULL: not available: no matrix or factor; or, unless a block is kept, solver.plain or a force that
 * does not report its changes. */
pg_status inverse_create (inverse **out, pg_system *s, inverse_keeps keeps);
void      inverse_free   (inverse **v);
/* Makes a new base: the factor at hand is that of the present k K + m M. spring: N/m, as
 * inverse_base.spring. */
pg_status inverse_renew  (inverse *v, double k, double m, double spring);
int       inverse_has_base (const inverse *v);
void      inverse_forget (inverse *v);                 /* gives up the base */
/* Takes in the changes that the force reports; called after system_refresh. */
pg_status inverse_take   (inverse *v, inverse_outcome *outcome);
/* Is there room for the columns of `count` more unknowns, and is the dense system small enough? */
int       inverse_has_room (const inverse *v, size_t count);
int       inverse_is_due (const inverse *v);
/* Seconds by stored rates since the base: columns, algebra, and a share of the next base, which costs
 * `renewal`. */
double    inverse_spent  (const inverse *v, double renewal);
/* x = (A + W D W')^-1 r of any reduced residual (nred): a solve with the factor of the base, corrected. */
pg_status inverse_solve  (inverse *v, const double *r, double *x);

/* ---- inverse_touched.c --------------------------------------------------------------------------------- */
void      touched_free   (inverse *v);
void      touched_clear  (inverse *v);                 /* forgets all touched unknowns: t = 0 */
pg_status touched_reserve (inverse *v, size_t count);  /* allocates for `count` more unknowns */
/* Adds unknowns that are not yet touched: H and what depends on it grow. */
pg_status inverse_grow   (inverse *v, size_t count, const size_t *dof);
/* D += a change of K, on unknowns that are touched by this if they were not before. */
pg_status inverse_change (inverse *v, const pg_stiffness_change *change);
/* Puts springs on all touched unknowns that have some stiffness left, N/m. */
void      inverse_hold   (inverse *v, double spring);
/* y = (1 + D H)^-1 y for n columns of t numbers; returns 0 where the system is singular. */
int       inverse_substitute (inverse *v, size_t n, double *y);
/* y += scale D u; inverse_add_H: y += H x (t numbers each). */
static inline void inverse_add_D (const inverse *v, double scale, const double *u, double *y)
{
    const touched_unknowns *w = &v->touched;
    pg_dense_multiply (0, w->t, 1, w->t, scale, w->D, w->cap, u, w->cap, 1, y, w->cap);
}
static inline void inverse_add_H (const inverse *v, const double *x, double *y)
{
    const touched_unknowns *w = &v->touched;
    pg_dense_multiply (0, w->t, 1, w->t, 1, w->H, w->cap, x, w->cap, 1, y, w->cap);
}

/* ---- inverse_columns.c --------------------------------------------------------------------------------- */
/* Makes the Green columns of the unknowns from `first` on, and their part of H, which is symmetric by
 * construction. */
pg_status columns_make   (inverse *v, size_t first);
/* r -= T' W y: reduced forces from forces y on the touched unknowns */
void      columns_unload (const inverse *v, const double *y, double *r);
/* y = a y + G x */
void      columns_times  (const inverse *v, double a, const double *x, double *y);
void      columns_drop   (inverse *v);                 /* frees the columns */
void      columns_free   (inverse *v);
/* Column i of G. */
static inline const double *green_column (const inverse *v, size_t i)
{
    return v->columns.chunk[i / CHUNK] + (i % CHUNK) * v->s->ndof;
}

/* ---- checkpoints (inverse.c) --------------------------------------------------------------------------- */
/* Checkpoint of the base, D and M: a run that is read back goes on bit by bit. After reading, and after the
 * force and the factor of the base (the bonds of that time) were made again, inverse_restore has to be called
 * before anything else. */
pg_status inverse_keep    (inverse *v, const pg_keeper *k);
pg_status inverse_restore (inverse *v);
#endif
