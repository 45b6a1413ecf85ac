/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: equilibria of the patch test by a factor of K (patch_test_factor.c) in place of iterations. */
#ifndef PG_PATCH_TEST_FACTOR_H
#define PG_PATCH_TEST_FACTOR_H
#include "solve/run/solve.h"

typedef struct patch_factor patch_factor;
/* Factors the matrix of a force on the bare problem. *out NULL: iterations cost less, the force has no
 * matrix, or parts of the body are not connected. products: most iterations that one state may take; reused
 * 1: the run will use the matrix, which then costs nothing. PG_E_MEMORY. */
pg_status patch_factor_create (patch_factor **out, const pg_problem *bare, const pg_force_type *force,
                               void *self, size_t products, int reused);
/* Solves K x = b for forces b in balance (N, all unknowns), up to a rigid motion. b and x may not overlap. */
pg_status patch_factor_solve  (patch_factor *factor, const double *b, double *x);
void      patch_factor_free   (patch_factor **factor);
#endif
