/* SPDX-License-Identifier: GPL-3.0-or-later
 * folded_stencil.h: forces of blocks whose bonds all live, by folding the stencil (fold_kernel.h), and a
 * bound by which their bonds need no look in most steps (private; folded_stencil.c). */
#ifndef PERIGAL_SUMS_FOLDED_STENCIL_H
#define PERIGAL_SUMS_FOLDED_STENCIL_H
#include "stencil_loop.h"

/* Of a stencil in the plane that is even in both axes, without weights of points, linear; else *out NULL. */
pg_status folding_create (struct folding **out, stencil *s);
void      folding_free   (struct folding **folding);
/* All bits are new: which blocks are whole is found again, and nothing is known of stretches. */
void      folding_renew  (stencil *s);
/* A bond of block k has died: it is not whole. */
void      folding_lose   (stencil *s, size_t k);
/* As pg_stencil_loop_spread, and the bound of what bonds have been stretched since they were looked at. */
void      folding_spread (stencil *s, const double *u);
/* Forces at the displacements in job.u of blocks first..last - 1, of which `loop` sums those that are not
 * whole; breaking: the bonds of whole ones are looked at where the bound does not exclude a break. */
pg_status folding_force  (stencil *s, double *f, int breaking, pg_changes *broken);
/* How many looks at a block were spared, and forces of blocks folded. */
void      folding_counts (const stencil *s, pg_bond_loop_counts *out);
#endif
