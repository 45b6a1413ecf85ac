/* SPDX-License-Identifier: GPL-3.0-or-later
 * stencil_loop.h: points of a lattice in blocks (block.h) with a bit per bond, and loops over them (private):
 * shared by bond-based sums (stencil_loop.c), by transforms, which leave blocks with broken bonds to these
 * loops (fft_convolution.c), and by state-based sums (state_stencil.c). */
#ifndef PERIGAL_SUMS_STENCIL_LOOP_H
#define PERIGAL_SUMS_STENCIL_LOOP_H
#include "block.h"
#include "mechanics/sums/terms/bond_loop.h"

enum { MAX_THREADS = 64, FEW = 1 << 15 };              /* FEW: one thread for up to so many directed bonds */
typedef struct {
    pg_bond_loop_setting setting;
    const pg_block_kernels *kernels;
    pg_block_job job;                                  /* points into the arrays below */
    int        reach[3], left;                         /* largest offsets of bonds; padding before a row */
    /* places of a padded row, padded rows of a plane, padded planes, blocks of a row */
    size_t     pitch, rows, planes, row_blocks;
    size_t     nblock, nbond;                          /* blocks with points; bonds of the family */
    pg_block  *block;
    int       *block_at;  /* number of each block of each padded row; -1: it has no points */
    unsigned  *place;                                  /* padded place of each point */
    ptrdiff_t *jump;
    double    *term, *field, *p, *energy;
    uint32_t  *alive, *may;
    unsigned char *hit;
    struct folding *fold;                              /* folded_stencil.h; NULL: all bonds one by one */
    pg_changes found[MAX_THREADS];                     /* bonds that each thread has found to break */
    pg_status  failed[MAX_THREADS];
} stencil;

/* Returns why these bonds cannot be summed by a stencil; NULL: they can. */
const char *pg_stencil_loop_refusal (const pg_bond_loop_setting *setting);
/* Makes a stencil with all bonds intact, in a struct of `bytes` that begins with it; freed by
 * pg_stencil_loop_free, also after a failure. */
pg_status pg_stencil_loop_create (void **self, const pg_bond_loop_setting *setting, pg_instructions set,
                          size_t bytes);
void      pg_stencil_loop_free   (void *self);
/* Sets all alive bits from the mask `live` of the family (NULL: all intact), and `may`, the bits of bonds
 * that may break, from `exempt` (points whose bonds never break; NULL: none). PG_E_USAGE: a bond is not one
 * of the stencil. (stencil_bits.c) */
pg_status pg_stencil_bits_renew  (stencil *s, const unsigned char *live, const unsigned char *exempt);
void      pg_stencil_loop_update (void *self, const unsigned char *alive, const pg_changes *changes);
void      pg_stencil_loop_bytes  (const void *self, double *per_bond, double *per_point);
int       pg_stencil_loop_threads (const stencil *s);
size_t    pg_stencil_loop_places (const stencil *s);           /* places of the padded box */
/* Returns the block of a padded place, and the bit of its site. */
size_t    pg_stencil_loop_block  (const stencil *s, size_t place, unsigned *bit);
size_t    pg_stencil_loop_owner  (const stencil *s, size_t entry);  /* point of an entry of the family */
void      pg_stencil_loop_spread (stencil *s, const double *u);  /* copies u (n x dim, m) to job.u */
/* Breaks the bonds of a block that are at or over their limit at job.u, and appends them to found. */
pg_status pg_stencil_loop_kill   (stencil *s, size_t block, pg_changes *found);
/* Returns the entry of the family of bond b of point i, which is at `place`. */
size_t    pg_stencil_loop_entry  (const stencil *s, int i, size_t place, size_t b);
/* Runs `loop` over all blocks. In a block where it sets `hit`, bonds over their limit are broken, `lost` (or
 * NULL) is called, and `again` sums the block anew. Broken bonds are appended to `broken`. */
typedef void (*stencil_lost) (stencil *s, size_t block);
pg_status pg_stencil_loop_run (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                       pg_changes *broken);
/* pg_stencil_loop_run over n blocks of a list. */
pg_status pg_stencil_loop_run_some (stencil *s, pg_block_loop loop, pg_block_loop again, stencil_lost lost,
                                    size_t n,
                            const int *list, pg_changes *broken);
/* Forces f, N, or four times W_i V_i, J, of the points of n blocks of a list, at the displacements in
 * job.u. */
pg_status pg_stencil_loop_force_some    (stencil *s, size_t n, const int *list, double *f,
                                         pg_changes *broken);
void      pg_stencil_loop_energies_some (stencil *s, size_t n, const int *list, double *W);
/* Returns the sum of the energies that `loop` writes for all blocks (job.energy); W: those of points, or
 * NULL. */
double    pg_stencil_loop_stored (stencil *s, pg_block_loop loop, double *W);
#endif
