/* SPDX-License-Identifier: GPL-3.0-or-later
 * stencil_loop.h: points of a lattice in blocks with a bit per bond, and loops over them (private): shared
 * by the sums of bond-based theory (stencil_loop.c), by transforms, which leave blocks with cut bonds to
 * these loops (fft_convolution.c), and of state-based theory (state_stencil.c). */
#ifndef PERIGAL_SUMS_STENCIL_LOOP_H
#define PERIGAL_SUMS_STENCIL_LOOP_H
#include "block.h"
#include "mechanics/sums/terms/bond_loop.h"

enum { MAX_THREADS = 64, FEW = 1 << 15 };              /* FEW directed bonds are not worth a second thread */
typedef struct {
    pg_bond_loop_setting setting;
    const pg_block_kernels *kernels;
    pg_block_job job;                                  /* points into what follows */
    int        reach[3], left;                         /* halo in sites; padded places before a row */
    /* padded places of a row, rows of a plane, planes, blocks of a row */
    size_t     pitch, rows, planes, row_blocks;
    size_t     nblock, nbond;                          /* blocks with points; bonds of the family */
    pg_block  *block;
    int       *block_at;  /* of each block of each padded row, -1: without points */
    unsigned  *place;                                  /* padded place of each point */
    ptrdiff_t *jump;
    double    *term, *field, *p, *energy;
    uint32_t  *alive, *may;
    unsigned char *hit;
    struct folding *fold;                              /* folded_stencil.h; NULL: all bonds one by one */
    pg_changes found[MAX_THREADS];                     /* of each thread */
    pg_status  failed[MAX_THREADS];
} stencil;

/* NULL: a stencil can be laid over these points; else why not. */
const char *pg_stencil_loop_refusal (const pg_bond_loop_setting *setting);
/* Into workspace for `bytes`, of which the first are a stencil; all its bonds live. What it allocated is
 * freed by pg_stencil_loop_free, also after a failure. */
pg_status pg_stencil_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                          size_t bytes);
void      pg_stencil_loop_free   (void *self);
/* stencil_bits.c: all bits from the live bonds of the family (NULL: all live). exempt: points whose bonds
 * never break, NULL: none; then those of bonds that may break as well. PG_E_USAGE: a bond that the stencil
 * has not. */
pg_status pg_stencil_bits_renew  (stencil *s, const unsigned char *live, const unsigned char *exempt);
void      pg_stencil_loop_update (void *self, const unsigned char *alive, const pg_changes *changes);
void      pg_stencil_loop_bytes  (const void *self, double *per_bond, double *per_point);
int       pg_stencil_loop_threads (const stencil *s);
size_t    pg_stencil_loop_places (const stencil *s);           /* of the padded box */
/* block and bit of a padded place */
size_t    pg_stencil_loop_block  (const stencil *s, size_t place, unsigned *bit);
size_t    pg_stencil_loop_owner  (const stencil *s, size_t entry);  /* point of an entry of the family */
void      pg_stencil_loop_spread (stencil *s, const double *u);  /* u (n x dim) to job.u */
/* Bonds of a block at or over their limit at job.u die and are noted. */
pg_status pg_stencil_loop_kill   (stencil *s, size_t block, pg_changes *found);
/* Position in the family of bond b of the site at `place`, whose point is i. */
size_t    pg_stencil_loop_entry  (const stencil *s, int i, size_t place, size_t b);
/* The loop over all blocks; where it says `hit` the bonds over their limit die, `lost` (or NULL) is told, and
 * `again` does the block anew. Bonds that died are appended to broken. */
typedef void (*stencil_lost) (stencil *s, size_t block);
pg_status pg_stencil_loop_run (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                       pg_changes *broken);
/* ... over n blocks of a list. */
pg_status pg_stencil_loop_run_some (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                                    size_t n,
                            const int *list, pg_changes *broken);
/* Forces, and four times W_i V_i, of the points of n blocks of a list alone, at the displacements in
 * job.u. */
pg_status pg_stencil_loop_force_some    (stencil *s, size_t n, const int *list, double *f,
                                         pg_changes *broken);
void      pg_stencil_loop_energies_some (stencil *s, size_t n, const int *list, double *W);
/* What a loop stores over all blocks, in `energy` of each, added up; the points' shares in W unless that is
 * NULL. */
double    pg_stencil_loop_stored (stencil *s, pg_block_loop loop, double *W);
#endif
