/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft_convolution.h: bonds of a lattice summed by transforms (private; theory B1, B2). With chi the weight
 * of a point (its share of a cell over the root of how full its family is; 0 where there is no point or
 * where all its bonds are dead) and K_ab = c V^2 k beta / r^3 xi_a xi_b,
 *   f_a = chi (q_a - sum_b D_ab u_b), q_a = sum_b K_ab * (chi u_b), D_ab = K_ab * chi (*: cyclic convolution)
 * is the force on points all whose bonds (to points of weight) live. A block of 32 sites with a cut bond is
 *     summed bond by bond instead, by the loops
 * of the stencil. D is summed directly, and only about points that died. Nothing depends on what was cut
 *     when: only on what is.
 * Transforms round by the size of u, bonds by that of eta: the uniform strain (and rigid motion) that fits u
 *     best is taken off first. Inside it makes
 * no force; at points whose family is not whole T_abc e_bc, which is added. Its values at the sites are exact
 *     multiples of a power of 2. */
#ifndef PERIGAL_SUMS_FFT_CONVOLUTION_H
#define PERIGAL_SUMS_FFT_CONVOLUTION_H
#include "fft_rows.h"
#include "stencil_loop.h"

enum { FFT_TERMS = 16 };                               /* pairs and thirds in space */
typedef struct { int point, block; } fft_rim;
/* The motion that is taken off before a transform, m: shift + (base + slope . place of a site). */
typedef struct { double shift[3], base[3], slope[9]; } taken_motion;
/* What a sum in progress reads and gives: displacements, forces or energies. */
typedef struct {
    const double *u;
    double *f_out, *f_own, *W, *ones;
} running_sum;
typedef struct {
    stencil *s;  /* bits of bonds, displacements in padded places, loops over bonds */
    fft     f;
    int     dim, pairs, thirds;                        /* thirds: 1, 4, 10 */
    size_t  nx, rows, width, places;  /* sites of a row, rows, that of whole blocks, padded places */
    double *K;  /* of the stencil's bonds, N/m; K_ab xi_c, N (n x (pairs + thirds)) */
    double *chi;                                       /* (places) */
    double *D;                                         /* N/m (pairs x rows x width) */
    double  whole[FFT_MOST];                           /* D of a point with a whole family of weight 1 */
    unsigned char *cut;  /* block: a live point's bond to a live point is dead */
    unsigned char *seen, *seen_block;                  /* while bonds die (points, blocks) */
    int    *touched, *list;                            /* points, blocks */
    size_t  gone;                                      /* points all whose bonds are dead */
    taken_motion off;
    double *third;  /* sum K_ab xi_c chi, N: where open (points x thirds) */
    unsigned char *open;                               /* point: its family is not a whole one of weight 1 */
    fft_rim *rim;  size_t nrim;                        /* points marked by open, with their blocks */
    double *edge;                                      /* fft_bound.c */
    unsigned char *ragged, *risky;
    size_t  room_edges;
    running_sum sum;
    pg_bond_loop_counts count;
} transformer;

static inline size_t fft_row_base (const transformer *t, size_t row)  /* padded place of a row's first site */
{
    const stencil *s = t->s;
    size_t ny = (size_t) s->setting.sums->sites.count[1], y = row % ny, z = row / ny;
    return ((z + (size_t) s->reach[2]) * s->rows + y + (size_t) s->reach[1]) * s->pitch + (size_t) s->left;
}

/* a <= b <= c */
static inline int fft_third (int a, int b, int c) { return c * (c + 1) * (c + 2) / 6 + b * (b + 1) / 2 + a; }
/* a <= b */
static inline int fft_pair (int dim, int a, int b)
{
    return dim == 3 ? a * (5 - a) / 2 + b : dim == 2 ? a + b : 0;
}

/* Fits the motion that is to be taken off u: of uniform strain, or rigid; its values along a row of sites are
 * shift[d] + (from + k * by) at site k (fft_motion.c). */
void      pg_fft_fit_motion (transformer *t, const double *u, int strained);
void      pg_fft_motion_of (const transformer *t, size_t row, int d, double *from, double *by);
/* Blocks that may have a bond at its limit (fft_bound.c) and those with cut bonds: written to list,
 * ascending; how many. */
pg_status pg_fft_bound_create (transformer *t);
size_t    pg_fft_bound_suspects (transformer *t, double limit, int *list);
#endif
