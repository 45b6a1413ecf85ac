/* SPDX-License-Identifier: GPL-3.0-or-later
 * block.h: forces of the intact bonds of a block, 32 consecutive sites of a lattice row, at once (private).
 * Fields are padded: arrays with a margin of zeros around the lattice, in which an entry is called a place.
 * One source, block_kernel.h, is compiled for each instruction set. Products are added with one rounding
 * (fused) where the machine can; roots and quotients are those of IEEE 754: sets that fuse give the same
 * bits. */
#ifndef PERIGAL_SUMS_BLOCK_H
#define PERIGAL_SUMS_BLOCK_H
#include "perigal/sums.h"
#include <stdint.h>

enum { PG_BLOCK = 32, PG_TERMS = 10 };                 /* sites of a block; doubles per bond */
/* Indices of the numbers of a bond (pg_block_job.term): pair forces; micropolar bonds; state-based. */
enum { PG_AT_XI, PG_AT_PULL = 3, PG_AT_LIMIT = 6, PG_AT_R2 = 7, PG_AT_R = 8, PG_AT_STORED = 9 };
/* micropolar bonds (beams) */
enum {
    PG_AT_KT = 3,
    PG_AT_KG = 4,
    PG_AT_KB = 5,
    PG_AT_BEAM_INVERSE = 6,
    PG_AT_STRETCH_SHARE = 7,
    PG_AT_SHEAR_SHARE = 8,
    PG_AT_BEND_SHARE = 9
};
enum { PG_AT_WV = 3, PG_AT_WVV = 4, PG_AT_INVERSE = 5 };               /* state-based */
/* Folded stencils (fold_kernel.h): sites that columns reach to either side, rows above and below with that of
 * the point, blocks summed together at most. */
enum { PG_FOLD_HALO = 8, PG_FOLD_ROWS = 9, PG_FOLD_BLOCKS = 4 };
typedef struct {
    int      reach;                                    /* largest offset of a bond in columns or rows */
    size_t   pitch;                                    /* padded places of a row of the lattice */
    double   own[2];                                   /* K_xx, K_yy of a point with all bonds, N/m */
    const double *pull;  /* a x^2, a x y, a y^2 of column x and row y, N/m (columns x PG_FOLD_ROWS x 3) */
    const double *slope;                               /* xi / r^2 of each bond, 1/m (x 2) */
    double  *low, *high;                               /* least, largest change of u of a block, m (x 2) */
} pg_fold;
typedef struct {
    size_t   base;                                     /* padded place of its first site */
    size_t   site;                                     /* number of its first site */
    uint32_t present;                                  /* bit k: site k has a point */
    int      first;  /* lowest number of its points if these are consecutive, else -1 */
} pg_block;
/* Work of the loops. `term` of pair forces, with a = c V^2 k beta / r^3 (N/m^3), V the volume of a lattice
 * cell: xi; linear stretch: pull = a xi (3), limit of xi.eta: s0 r^2, stored = a; finite stretch: pull[0] = a
 * r^2, limit of 2 xi.eta + eta.eta: s0 (2 + s0) r^2, r^2, r, stored = a r^2. */
typedef struct {
    int      dim;
    size_t   n;                                        /* bonds of the stencil */
    const ptrdiff_t *jump;                             /* padded places from a point to its neighbour (n) */
    const double    *term;                             /* numbers of each bond (n x PG_TERMS) */
    const pg_block  *block;
    const int       *point;                            /* point at each site, -1: none */
    const uint32_t  *alive;  /* bit k of word [block][bond]: that bond of site k is intact */
    const uint32_t  *may;  /* bit k of word [block][bond]: that bond of site k may break; NULL: all may */
    double         *u[3];                              /* padded displacement, m; 0 where there is no point */
    const double   *p;                                 /* padded weight of points; NULL: all 1 */
    double         *f;                                 /* forces on points, N (points x dim) */
    unsigned char  *hit;  /* set to 1: a bond of the block is over its limit (blocks) */
    double         *energy;  /* sum of a (xi.eta)^2 p_i p_j over directed bonds (blocks) */
    /* sum of a (xi.eta)^2 p_i p_j over the bonds of each point (n); NULL: not wanted */
    double         *energies;
    /* State-based (state.h): term = xi (3), w V, w V^2, 1 / r^2, limit (at PG_AT_LIMIT). Padded, 0 where
     * there is no point: factor A d / q^2, beta B / q, alpha A theta / q. */
    double         *factor, *beta, *alpha;
    /* Micropolar bonds (beam_kernel.h): term = xi (3), kt, (kn - kt) / r^2, kb, 1 / r^2, 1 / s0^2, 1 / (r
     * gamma0)^2, 1 / (length kappa0)^2. */
    double         *q[3];                              /* padded rotations times a length, m */
    double          lever;                             /* 1 / (2 length), 1/m */
    int             single;                            /* 1: any one limit breaks a bond; 0: all together */
    uint32_t       *over;                              /* laid out as alive: 1: the bond is at its limit */
    const pg_fold  *fold;                              /* NULL: not folded */
    double          volume;                            /* volume of a lattice cell, m^3 */
} pg_block_job;

/* A loop over the blocks first .. last - 1. */
typedef void (*pg_block_loop) (const pg_block_job *job, size_t first, size_t last);
enum { PG_CHECK_NONE, PG_CHECK_ALL, PG_CHECK_SOME };
typedef struct {
    /* Pair forces, [dim - 1][finite][check][weighted]: forces to job->f, sets job->hit; [dim -
     * 1][finite][weighted]: energies to job->energy. */
    pg_block_loop force[3][2][3][2];
    pg_block_loop energy[3][2][2];
    /* State-based, [dim - 2][check][weighted]: sums of w xi.eta V times factor to job->alpha (and job->hit);
     * [dim - 2][weighted]: forces to job->f; energies to job->energy, J. */
    pg_block_loop dilate[2][3][2], pull[2][2], store[2][2];
    pg_block_loop beam[2][2], beam_energy[2][2], beam_look[2], beam_over[2];  /* [dim - 2][weighted] */
    /* [reach - 1]: forces of `count` blocks of a row from block k on, all of whose bonds are intact, by u -
     * ref; largest stretch of bonds of block k. */
    void   (*fold[PG_FOLD_HALO]) (const pg_block_job *job, size_t k, size_t count, const double *ref);
    double (*most_stretch) (const pg_block_job *job, size_t k);
    void   (*spread_and_measure) (const pg_block_job *job, const double *u, size_t first, size_t last);
    int fused;                                         /* 1: a b + c is rounded once */
    /* copies u (points x dim, m) of blocks first .. last - 1 to job->u */
    void (*spread) (const pg_block_job *job, const double *u, size_t first, size_t last);
} pg_block_kernels;
/* Tables for the instruction sets; empty where the compiler lacks one. */
extern const pg_block_kernels pg_block_scalar, pg_block_avx2, pg_block_avx512;
#endif
