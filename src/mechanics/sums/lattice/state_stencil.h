/* SPDX-License-Identifier: GPL-3.0-or-later
 * state_stencil.h: state-based sums over the bits of a stencil (private): for the loop by stencil and for
 * that by transforms, which sums with its loops where bonds are cut. */
#ifndef PERIGAL_SUMS_STATE_STENCIL_H
#define PERIGAL_SUMS_STATE_STENCIL_H
#include "mechanics/sums/terms/state.h"
#include "stencil_loop.h"

typedef struct {
    stencil base;                                      /* first: loops over blocks see it alone */
    double *q;                                         /* m^2 times volume (n) */
    double *factor, *beta, *alpha;                     /* padded */
} state;

/* Into workspace for `bytes`, of which the first are a state; freed by pg_state_loop_free, also after a
 * failure. */
pg_status pg_state_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                                size_t bytes);
void      pg_state_loop_free   (void *self);
void      pg_state_loop_update (void *self, const unsigned char *alive, const pg_changes *changes);
/* what a block that lost bonds needs; NULL: nothing */
stencil_lost pg_state_loop_lost (const stencil *s);
/* As pg_bond_loop_energy and so on, bond by bond. */
double    pg_state_loop_energy (void *self, const double *u);
pg_status pg_state_loop_energies (void *self, const double *u, double *W);
pg_status pg_state_loop_dilatation (void *self, const double *u, double *theta, double *q);
#endif
