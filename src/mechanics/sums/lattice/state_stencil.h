/* SPDX-License-Identifier: GPL-3.0-or-later
 * state_stencil.h: state-based sums by a stencil with alive bits (private): for the loop by stencil, and for
 * the loop by transforms, which sums blocks with broken bonds by it. */
#ifndef PERIGAL_SUMS_STATE_STENCIL_H
#define PERIGAL_SUMS_STATE_STENCIL_H
#include "mechanics/sums/terms/state.h"
#include "stencil_loop.h"

typedef struct {
    stencil base;                                      /* first, as loops over blocks take a stencil */
    double *q;                                         /* weighted volumes sum w r^2 V, m^4 (n) */
    double *factor, *beta, *alpha;                     /* as in pg_block_job (places) */
} state;

/* Makes a loop in a struct of `bytes`, which begins with a `state`; freed by pg_state_loop_free, also after a
 * failure. */
pg_status pg_state_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                                size_t bytes);
void      pg_state_loop_free   (void *self);
void      pg_state_loop_update (void *self, const unsigned char *alive, const pg_changes *changes);
/* Returns the function to be called for blocks that lost bonds; NULL: none. */
stencil_lost pg_state_loop_lost (const stencil *s);
/* pg_bond_loop_energy, _energies, _dilatation, summed bond by bond. */
double    pg_state_loop_energy (void *self, const double *u);
pg_status pg_state_loop_energies (void *self, const double *u, double *W);
pg_status pg_state_loop_dilatation (void *self, const double *u, double *theta, double *q);
#endif
