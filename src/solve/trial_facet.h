/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: trial facets in the plane. A facet is tried on a copy of the state; what counts is the
 * potential energy that it would release at fixed loads. Files: trial_release.c (that energy, for bonds
 * that are given), trial_facet.c (facets at tips and across the body), initiation.c (new cracks by
 * strength and energy together). */
#ifndef PG_TRIAL_FACET_H
#define PG_TRIAL_FACET_H
#include "solve.h"

/* Displacements that are in equilibrium under the loads of load factor t each. One: everything is
 * proportional, u (lambda) = lambda d. Two: affine loads, u (lambda) = (1 - lambda) d_0 + lambda d_1. */
typedef struct { int n; const double *d[2]; double t[2]; } trial_fields;

/* A quadratic form of the weights w_a of the fields: sum_ab w_a w_b value (00, 01, 11), 01 counted twice,
 * J. */
typedef struct { double value[3]; } trial_form;
/* The same as c[0] + c[1] lambda + c[2] lambda^2. */
void trial_polynomial (const trial_fields *f, const trial_form *form, double *c);

/* ---- trial_release.c ----------------------------------------------------------------------------------- */
typedef struct trials {
    pg_system *system;
    pg_state  *state;                                  /* the copy on which facets are tried */
    double    *K;                                      /* values of K before */
    double    *residual[2], *load[2];                  /* of each field before, N (ndof) */
    double    *after, *zero, *whole;                   /* workspaces (ndof) */
    int        said;                                   /* a warning that was given */
    /* how often each way was taken, and columns of K^-1 that were solved for: for reports and tests */
    long       by_columns, by_solves, columns;
    int        never_columns;                          /* tests: 1: solve anew every time */
} trials;
pg_status trials_create (trials **out, pg_system *system);             /* the system is borrowed */
void      trials_free (trials **w);
/* The energy that stages of a cut release at fixed loads, J, as forms of the fields (n): stage k cuts the
 * bonds of the stages before it and those of cut[k], which live in `state` and are listed once. The state and
 * the caches of the force are afterwards what they were. */
pg_status trial_release (trials *w, const pg_state *state, const trial_fields *f, size_t n,
                         const pg_changes *cut, trial_form *release);

#endif
