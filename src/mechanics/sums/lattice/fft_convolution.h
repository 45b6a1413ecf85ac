/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft_convolution.h: bonds of a lattice summed by transforms (private; theory B1, B2). With chi the weight of
 * a point (its share of a cell's volume over the root of its family's relative volume; 0 where there is no
 * point or all its bonds are broken) and K_ab = c V^2 k beta / r^3 xi_a xi_b,
 *   f_a = chi (q_a - sum_b D_ab u_b), q_a = sum_b K_ab * (chi u_b), D_ab = K_ab * chi (*: cyclic convolution)
 * is the force on points all of whose bonds (to points with chi > 0) are intact. A block of 32 sites with a
 * broken bond is summed bond by bond instead, by the loops of the stencil. D is summed directly, and again
 * only around points that lost all bonds. Results depend on which bonds are broken, not on when they broke.
 * Rounding errors of transforms have the size of u, those of bonds that of eta: the uniform strain and rigid
 * motion that fit u best are subtracted first. Where families are whole they give no force; elsewhere T_abc
 * e_bc, which is added. Their values at the sites are exact multiples of a power of 2. */
#ifndef PERIGAL_SUMS_FFT_CONVOLUTION_H
#define PERIGAL_SUMS_FFT_CONVOLUTION_H
#include "fft_rows.h"
#include "stencil_loop.h"

enum { FFT_TERMS = 16 };                               /* pairs (6) and thirds (10) of axes in 3D */
typedef struct { int point, block; } fft_rim;
/* The motion that is subtracted before a transform, m: shift + (base + slope . indices of a site). */
typedef struct { double shift[3], base[3], slope[9]; } taken_motion;
/* Arrays of a sum in progress: displacements that it reads, forces or energies that it makes. */
typedef struct {
    const double *u;
    double *f_out, *f_own, *W, *ones;
} running_sum;
typedef struct {
    stencil *s;  /* intact bonds, padded displacements, loops over bonds */
    fft     f;
    int     dim, pairs, thirds;                        /* pairs, triples of axes (thirds: 1, 4, 10) */
    size_t  nx, rows, width, places;  /* sites of a row; rows; sites of its blocks; padded places */
    double *K;  /* K_ab (N/m) and K_ab xi_c (N) of each bond of the stencil (n x (pairs + thirds)) */
    double *chi;                                       /* weights of points (places) */
    double *D;                                         /* D_ab at each site, N/m (pairs x rows x width) */
    double  whole[FFT_MOST];                           /* D of a point with a whole family of weight 1, N/m */
    unsigned char *cut;  /* 1: a bond in the block is broken between points that have bonds left */
    unsigned char *seen, *seen_block;                  /* marks while bonds break (points, blocks) */
    int    *touched, *list;                            /* lists of points, of blocks */
    size_t  gone;                                      /* number of points all of whose bonds are broken */
    taken_motion off;
    double *third;  /* sum K_ab xi_c chi, N, at points marked by open (points x thirds) */
    unsigned char *open;                               /* 1: a neighbour is missing or its weight is not 1 */
    fft_rim *rim;  size_t nrim;                        /* points marked by open, with their blocks */
    double *edge;                                      /* edge, ragged, risky: see fft_bound.c */
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

/* Index of the triple of axes a <= b <= c. */
static inline int fft_third (int a, int b, int c) { return c * (c + 1) * (c + 2) / 6 + b * (b + 1) / 2 + a; }
/* Index of the pair of axes a <= b. */
static inline int fft_pair (int dim, int a, int b)
{
    return dim == 3 ? a * (5 - a) / 2 + b : dim == 2 ? a + b : 0;
}

/* Fits the motion that is subtracted from u: of uniform strain (strained 1), or rigid. pg_fft_motion_of: at
 * site k of a row its component d is shift[d] + (from + k by), m (fft_motion.c). */
void      pg_fft_fit_motion (transformer *t, const double *u, int strained);
void      pg_fft_motion_of (const transformer *t, size_t row, int d, double *from, double *by);
/* Lists, ascending, the blocks that may have a bond at its limit (fft_bound.c) and those with broken bonds;
 * returns how many. */
pg_status pg_fft_bound_create (transformer *t);
size_t    pg_fft_bound_suspects (transformer *t, double limit, int *list);
#endif
