/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: solves with a supernodal factor whose right-hand sides are zero but for a few places. */
#ifndef PG_SUPERNODAL_H
#define PG_SUPERNODAL_H
#include "suitesparse.h"
#include "perigal/linalg.h"

/* What is found once for a factor, and scratch. */
typedef struct {
    long   *place;                                     /* of each unknown in the order of the factor (n) */
    long   *parent;                                    /* of each supernode; -1: none */
    long   *of;                                        /* supernode of each place (n) */
    unsigned char *reached;                            /* of each supernode */
    double *Y, *E;  size_t room_Y, room_E;
    size_t *interval, room_interval;                   /* of places that were reached: first, end (pairs) */
    double  half_flops;                                /* operations of all half solves */
} supernodal_solver;
pg_status supernodal_solve_few (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                                double *x);
/* pg_linear_type.half_few: y = L^-1 P b, in the order of the factor. */
pg_status supernodal_half_few  (const cholmod_factor *L, supernodal_solver *s, size_t nrhs, const double *b,
                                double *const *y, size_t *count, const size_t **first);
void      supernodal_clear     (supernodal_solver *s);
#endif
