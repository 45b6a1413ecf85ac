/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the inverse of the matrix of a linear system, as it is now.
 *
 * At the *base* the matrix A (k K + m M, after elimination of supports) was factored. Since then K has
 * changed by W D W', where the columns of W select the t *touched* unknowns and D (t x t, symmetric) is
 * summed up from what the force says it has changed (pg_force_type.change), or from what a caller has found.
 * With the Green columns G = A^-1 W (n x t) and H = W' G
 *
 *     (A + W D W')^-1 r = z - G (1 + D H)^-1 D W' z,    z = A^-1 r             (Woodbury's identity)
 *
 * and between touched unknowns the inverse is H (1 + D H)^-1. No sparse matrix is touched. A Green column is
 * computed when its unknown is touched for the first time, together with all others of that change.
 *
 * When t grows so far that the dense algebra since the base has cost more than a new base would (counted, by
 * stored rates: rent or buy), one is due; the caller decides when. Nothing here depends on a clock, and of
 * threads only BLAS knows. Files: inverse.c, inverse_touched.c (the dense
 * system), inverse_columns.c (Green columns). */
#ifndef PG_INVERSE_H
#define PG_INVERSE_H
#include "solve/run/solve.h"

/* Of each column all numbers, as displacements of the whole body are sums of columns; half of its solve, H
 * being products of these; or what it has in H. */
typedef enum { INVERSE_COLUMNS, INVERSE_HALVES, INVERSE_BLOCK } inverse_keeps;

/* What a refresh has done to the inverse. */
typedef enum {
    INVERSE_SAME,                                      /* neither K nor forces changed */
    INVERSE_TAKEN,                                     /* the change is taken in */
    INVERSE_DUE,                                       /* so it is, and a new base would pay now */
    /* A new base is needed: the force cannot tell its change, elimination (T) changed, there are too many
     * touched unknowns, or the factor of the base is gone. */
    INVERSE_LOST
} inverse_outcome;

/* The matrix that was factored. */
typedef struct {
    int     made;
    long    factorizations;                            /* of the run when the base was made: its factor */
    double *diagonal;                                  /* N/m (ndof) */
    double  k;                                         /* it is k K + m M; 1 at rest */
    double  spring;                                    /* on all touched unknowns, N/m */
    double  bare;  /* on those without any stiffness left, N/m; 0: what they had */
} inverse_base;

/* The dense system of t unknowns: arrays of cap, matrices column-major with columns cap apart. */
typedef struct {
    size_t  t, cap;
    size_t *dof;                                       /* their numbers among the full unknowns */
    int    *at;                                        /* place + 1 of each full unknown (ndof) */
    double *D;                                         /* change of K between them, N/m */
    double *stay;  /* beside D on the diagonal of the system: holds what nothing else holds, N/m */
    double *H;                                         /* W' A^-1 W, m/N */
    double *M, *factor;                                /* 1 + (D + stay) H; its LU factors */
    int    *pivot, factored;
    double  pivots;                                    /* least pivot over the largest entry of M */
    double *pack, *product;  size_t room_pack, room_product;       /* scratch of gathered blocks */
} touched_unknowns;

enum { CHUNK = 64 };                                   /* columns in a piece of G */
/* Columns of the inverse at the base. */
typedef struct {
    size_t *group, ngroup, room_group;                 /* how many unknowns were taken in at a time */
    double **chunk; size_t nchunk, room_chunk;         /* G, in pieces of CHUNK columns (ndof x CHUNK) */
    double **half; size_t room_half;                   /* scratch: where new halves go */
    double *rhs, *solved;  size_t room_rhs, room_solved;           /* nred x new ones */
    double  seconds;                                   /* of halved columns, by stored rates */
} green_columns;

typedef struct inverse {
    pg_system *s;
    inverse_keeps    keeps;
    inverse_base     base;
    touched_unknowns touched;
    green_columns    columns;
    int     loads;  /* the last change that was taken in is one of constant forces, too */
    int     restored;                                  /* read back, and nothing was made again yet */
    double  rent;  /* dense algebra since the base, in seconds by stored rates */
} inverse;

/* ---- inverse.c ----------------------------------------------------------------------------------------- */
/* *out NULL: not available (no matrix or factor; unless a block is kept: solver.plain, or a force that does
 * not tell its changes). */
pg_status inverse_create (inverse **out, pg_system *s, inverse_keeps keeps);
void      inverse_free   (inverse **v);
/* A new base: the factor at hand is that of k K + m M, as K is now. spring: N/m, as in the base. */
pg_status inverse_renew  (inverse *v, double k, double m, double spring);
int       inverse_has_base (const inverse *v);
void      inverse_forget (inverse *v);                 /* the base is of no use any more */
/* After system_refresh: takes in what the force says. */
pg_status inverse_take   (inverse *v, inverse_outcome *outcome);
/* Is there room for the columns of so many more unknowns, and for a dense system that can be afforded? */
int       inverse_has_room (const inverse *v, size_t count);
int       inverse_is_due (const inverse *v);
/* Columns and algebra since the base, and the share of the next one, which costs so much, s by stored rates.
 * */
double    inverse_spent  (const inverse *v, double renewal);
/* x = (A + W D W')^-1 r of any reduced residual (nred): a solve with the factor of the base, corrected. */
pg_status inverse_solve  (inverse *v, const double *r, double *x);

/* ---- inverse_touched.c --------------------------------------------------------------------------------- */
void      touched_free   (inverse *v);
void      touched_clear  (inverse *v);                 /* t = 0 */
pg_status touched_reserve (inverse *v, size_t count);  /* room for so many */
/* Takes in unknowns that are not yet touched: H and what depends on it grow. */
pg_status inverse_grow   (inverse *v, size_t count, const size_t *dof);
/* D += change. */
pg_status inverse_change (inverse *v, const pg_stiffness_change *change);
/* Springs on all touched unknowns that have some stiffness left, N/m. */
void      inverse_hold   (inverse *v, double spring);
/* y = (1 + D H)^-1 y, n columns of t numbers; 0: the system is singular. */
int       inverse_substitute (inverse *v, size_t n, double *y);
/* y += scale D u, y += H x of t numbers. */
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
/* Columns of the unknowns from `first` on, and their share of H, symmetric by construction. */
pg_status columns_make   (inverse *v, size_t first);
/* r -= T' W y, reduced forces from forces on the touched unknowns */
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
/* Base, D, M: a run that is read back goes on bit by bit. After reading, and after the force and the factor
 * of the base (system.base: the bonds that lived then) were made again, inverse_restore follows before
 * anything else is asked for. */
pg_status inverse_keep    (inverse *v, const pg_keeper *k);
pg_status inverse_restore (inverse *v);
#endif
