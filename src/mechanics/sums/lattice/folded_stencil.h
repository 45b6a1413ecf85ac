/* SPDX-License-Identifier: GPL-3.0-or-later
 * folded_stencil.h: forces of blocks with all bonds intact, by folding the stencil (fold_kernel.h), and a
 * bound of stretches by which their bonds need not be checked in most steps (private; folded_stencil.c). Such
 * blocks are called whole. */
#ifndef PERIGAL_SUMS_FOLDED_STENCIL_H
#define PERIGAL_SUMS_FOLDED_STENCIL_H
#include "stencil_loop.h"

/* Makes *out for a 2D stencil that is even in both axes, without weights of points, linear; else *out is
 * NULL. */
pg_status folding_create (struct folding **out, stencil *s);
void      folding_free   (struct folding **folding);
/* Called after all alive bits have changed: finds the whole blocks again and forgets all stretches. */
void      folding_renew  (stencil *s);
/* Called when a bond of block k has broken: the block is no longer whole. */
void      folding_lose   (stencil *s, size_t k);
/* Does pg_stencil_loop_spread, and updates the bounds of how bonds have been stretched since they were
 * checked. */
void      folding_spread (stencil *s, const double *u);
/* Forces f at the displacements in job.u: whole blocks are folded, others summed bond by bond. breaking:
 * bonds over their limit break, and bonds of whole blocks are checked where the bound does not exclude it. */
pg_status folding_force  (stencil *s, double *f, int breaking, pg_changes *broken);
/* Counts checks of whole blocks, folded forces of blocks, and the time saved. */
void      folding_counts (const stencil *s, pg_bond_loop_counts *out);
#endif
