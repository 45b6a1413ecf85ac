/* SPDX-License-Identifier: GPL-3.0-or-later
 * block_kernel.h: the loops of block.h in terms of vectors (private, no include guard: one file per
 * instruction set includes it after defining
 *   TARGET attribute of every function, LANES doubles of a vector, VECS(dim) vectors of a stride, NAME of the
 *       table,
 *   vec           typedef, and vec_root (vec), vec_fuse (a, b, c): a b + c, FUSED: 1 if rounded once,
 *   vec_least (a, b), vec_most (a, b): the smaller, the larger one,
 *   vec_lowest (v), vec_highest (v): the smallest, the largest of its lanes, none of which is NAN,
 *   vec_keep (v, bits): 0 in lanes whose bit is not set,
 *   hits, HITS_OVER (hits, v, limit), HITS_OVER_OF (hits, v, limit, bits), HITS_ANY (hits): lanes with v >=
 *     limit (of those in bits),
 *   zip (out, a, b), unzip (in, &a, &b): pairs in memory from and to two vectors. */
#include "block.h"
#include <math.h>

#include "mechanics/sums/terms/inline.h"

typedef double vec_loose __attribute__ ((vector_size (8 * LANES), aligned (8), may_alias));
#define LOAD(p) (*(const vec_loose *) (p))
#define STORE(p, v) (*(vec_loose *) (p) = (v))
#define ALL(x) ((x) - (vec) { 0 })                     /* x in every lane (x - 0: keeps -0) */

/* Copies the sums of a block, component by component (PG_BLOCK apart), to job->f of its points (points x
 * dim). A block without gaps whose points have consecutive numbers is stored in one piece, others point by
 * point. */
INLINE void gather (const pg_block_job *job, const pg_block *b, int dim, const double *out)
{
    if (b->present == UINT32_MAX && b->first >= 0) {
        double *f = job->f + (size_t) b->first * (size_t) dim;
        if (dim == 2) {
            UNROLL for (int v = 0; v < PG_BLOCK; v += LANES)
                zip (f + 2 * v, LOAD (out + v), LOAD (out + PG_BLOCK + v));
        } else {
            for (int k = 0; k < PG_BLOCK; k++)
                for (int d = 0; d < dim; d++) f[k * dim + d] = out[d * PG_BLOCK + k];
        }
        return;
    }
    for (uint32_t left = b->present; left; left &= left - 1) {
        int k = __builtin_ctz (left);
        double *f = job->f + (size_t) job->point[b->site + (size_t) k] * (size_t) dim;
        for (int d = 0; d < dim; d++) f[d] = out[d * PG_BLOCK + k];
    }
}

/* Copies displacements u (points x dim) of blocks first .. last - 1 to the padded arrays job->u of the
 * components. Places without a point stay 0. */
static TARGET void spread (const pg_block_job *job, const double *u, size_t first, size_t last)
{
    const int dim = job->dim;
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        if (b->present == UINT32_MAX && b->first >= 0) {
            const double *from = u + (size_t) b->first * (size_t) dim;
            if (dim == 2) {
                UNROLL for (int v = 0; v < PG_BLOCK; v += LANES) {
                    vec x, y;
                    unzip (from + 2 * v, &x, &y);
                    STORE (job->u[0] + b->base + v, x);
                    STORE (job->u[1] + b->base + v, y);
                }
            } else {
                for (int d = 0; d < dim; d++)
                    for (int l = 0; l < PG_BLOCK; l++) job->u[d][b->base + (size_t) l] = from[l * dim + d];
            }
            continue;
        }
        for (uint32_t left = b->present; left; left &= left - 1) {
            size_t l = (size_t) __builtin_ctz (left), i = (size_t) job->point[b->site + l] * (size_t) dim;
            for (int d = 0; d < dim; d++) job->u[d][b->base + l] = u[i + (size_t) d];
        }
    }
}

#include "pair_kernel.h"
#include "state_kernel.h"
#include "beam_kernel.h"
#include "fold_kernel.h"

/* The tables of the functions made above, by dimension, strain measure, check and weighting. */
#define ROW(D, F) \
    { \
        { force_##D##F##00, force_##D##F##01 }, { force_##D##F##10, force_##D##F##11 }, \
        { \
            force_##D##F##20, force_##D##F##21 \
        } \
    }
#define SUM(D, F) { energy_##D##F##0, energy_##D##F##1 }

    const pg_block_kernels NAME = {
        .force = { { ROW (1, 0), ROW (1, 1) }, { ROW (2, 0), ROW (2, 1) }, { ROW (3, 0), ROW (3, 1) } },
        .energy = { { SUM (1, 0), SUM (1, 1) }, { SUM (2, 0), SUM (2, 1) }, { SUM (3, 0), SUM (3, 1) } },
        .dilate = { DILATES (2), DILATES (3) },
        .pull = { PULLS (2), PULLS (3) },
        .store = { STORES (2), STORES (3) },
        .beam = { { beam_force_20, beam_force_21 }, { beam_force_30, beam_force_31 } },
        .beam_look = { beam_look_2, beam_look_3 },
        .beam_energy = { { beam_energy_20, beam_energy_21 }, { beam_energy_30, beam_energy_31 } },
        .beam_over = { beam_over_2, beam_over_3 },
        .spread = spread,
        .fold = { fold_1, fold_2, fold_3, fold_4, fold_5, fold_6, fold_7, fold_8 },
        .most_stretch = most_stretch,
        .spread_and_measure = spread_and_measure,
        .fused = FUSED,
    };
