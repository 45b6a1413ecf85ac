/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the event solver: its data. Files: event_solver.c (life, bases, updates, blocks of events),
 * event_touched.c (the dense system of the touched unknowns), event_columns.c (Green columns),
 * event_keep.c (checkpoints). Symbols as in event_solver.h. */
#ifndef PG_EVENT_SOLVER_DATA_H
#define PG_EVENT_SOLVER_DATA_H
#include "event_solver.h"

enum { CHUNK = 64 };                                   /* columns in a piece of G */

/* The state that events are changes of. */
typedef struct {
    int     made;
    long    factorizations;                            /* of the run when the base was made: its factor */
    double *u[EVENT_CASES];                            /* u_b (ndof) */
    double *constant[EVENT_CASES];                     /* residual of u = 0 at the base, N (ndof) */
    double *diagonal;  /* of the factored matrix at the base, N/m (ndof) */
    double  k;                                         /* that matrix is k K + m M; 1 at rest */
    double  shift;                                     /* that weak unknowns get in a factor, N/m */
    double  scale;                                     /* reference force at the base, N */
} event_base;

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
    double *x[EVENT_CASES], *p[EVENT_CASES];           /* forces, N */
    double *q[EVENT_CASES];  /* what a correction of the base leaves to be balanced, N: beside p */
    double *old[EVENT_CASES];                          /* x before the last update */
    double *u[EVENT_CASES];                            /* displacement of the touched unknowns, m */
    double *r;                                         /* scratch: cases x cap */
    double *pack, *product;  size_t room_pack, room_product;       /* scratch of gathered blocks */
    double  residual;                                  /* of the last update, over the scale of the base */
} touched_unknowns;

/* Columns of the inverse at the base. */
typedef struct {
    size_t *group, ngroup, room_group;  /* how many unknowns were taken in at a time */
    double **chunk; size_t nchunk, room_chunk;         /* G, in pieces of CHUNK columns (ndof x CHUNK) */
    int     halves;  /* 1: the columns are halves y, of which H is products; 0: Green columns */
    double **half; size_t room_half;                   /* scratch: where new halves go */
    double *rhs, *solved;  size_t room_rhs, room_solved;           /* (nred x new ones) */
    /* watched nodes; their rows of G (node by node, components x t), of which `filled` columns are there */
    int    *watched;  size_t nwatched, filled;
    double *rows;  size_t room_rows;
    double  seconds;  /* of halved columns, by stored rates */
} green_columns;

/* A block of events: x of event k at X[c][k], zero beyond tX[k]; number 0 is that before the first. */
typedef struct {
    int     count;
    double *X[EVENT_CASES][EVENT_MOST + 1];
    size_t  tX[EVENT_MOST + 1];
} event_block;

struct event_solver {
    pg_system *s;
    int     cases;
    double  time[EVENT_CASES];                         /* load factor of each case */
    size_t  ndof, nred;
    event_base       base;
    touched_unknowns touched;
    green_columns    columns;
    event_block      block;
    int     restored;  /* 1: read back, and nothing was made again yet */
    const char *why;
    double  rent;  /* dense algebra since the base, in seconds by stored rates */
};

/* ---- event_touched.c ----------------------------------------------------------------------------------- */
void      touched_free  (event_solver *e);
void      touched_clear (event_solver *e);             /* t = 0 */
pg_status touched_reserve (event_solver *e, size_t count);                      /* room for so many */
/* Takes in unknowns that are not yet touched: H and what depends on it grow. */
pg_status touched_grow  (event_solver *e, size_t count, const size_t *dof);
/* Green columns of the unknowns from `first` on, and their share of H. */
pg_status touched_green (event_solver *e, size_t first);
/* D += change. */
pg_status touched_change (event_solver *e, const pg_stiffness_change *change);
/* x += dx, u of all cases; 0: the system is singular or its residual stays. */
int       touched_solve (event_solver *e);
void      touched_undo  (event_solver *e);             /* x and u as before the last touched_solve */
/* q such that the solution at hand is balanced */
void      touched_balance (event_solver *e, int c);
/* y = (1 + D H)^-1 y */
int       touched_substitute (event_solver *e, double *y);
/* u of the touched unknowns from x */
void      touched_displacement (event_solver *e, int c);

/* ---- event_columns.c ----------------------------------------------------------------------------------- */
/* Green columns of the unknowns from `first` on. */
pg_status columns_make  (event_solver *e, size_t first);

/* Halves (half_few) in place of the Green columns of the unknowns from `first` on, and H from them. */
pg_status columns_halve (event_solver *e, size_t first);
/* r -= T' W y, reduced forces from forces on the touched unknowns */
void      columns_unload (const event_solver *e, const double *y, double *r);
void      columns_drop  (event_solver *e);             /* frees the columns */

/* Column i of G. */
static inline const double *green_column (const event_solver *e, size_t i)
{
    return e->columns.chunk[i / CHUNK] + (i % CHUNK) * e->ndof;
}
/* Takes the columns that came since the last call into the rows of the watched nodes. */
pg_status columns_watch (event_solver *e);
/* y = a y + G x */
void      columns_times (const event_solver *e, double a, const double *x, double *y);
void      columns_free  (event_solver *e);
#endif
