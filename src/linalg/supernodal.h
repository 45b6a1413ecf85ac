/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: solves with a supernodal factor for right-hand sides that are zero but for a few entries. */
#ifndef PG_SUPERNODAL_H
#define PG_SUPERNODAL_H
#include "suitesparse.h"
#include "perigal/linalg.h"

/* What is found once for a factor, and workspaces. Position: index of an unknown in the order of the
 * factor. */
typedef struct {
    long   *place;                                     /* position of each unknown (n) */
    long   *parent;                                    /* parent of each supernode; -1: none */
    long   *of;                                        /* supernode of each position (n) */
    unsigned char *reached;                            /* 1: the supernode has entries that are not zero */
    double *Y, *E;  size_t room_Y, room_E;
    size_t *interval, room_interval;                   /* positions of these: first, end (pairs) */
    double  half_flops;                                /* operations of all half solves */
} supernodal_solver;
pg_status supernodal_solve_few (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                                double *x);
/* pg_linear_type.half_few: y = L^-1 P b, in the order of the factor. */
pg_status supernodal_half_few  (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                                double *const *y, size_t *count, const size_t **first);
void      supernodal_clear     (supernodal_solver *s);
#endif
