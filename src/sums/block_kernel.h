/* SPDX-License-Identifier: GPL-3.0-or-later
 * block_kernel.h: the loops of block.h in terms of vectors (private, no include guard: one file per
 * instruction set includes it after defining
 *   TARGET attribute of every function, LANES doubles of a vector, VECS(dim) vectors of a stride, NAME of the
 *       table,
 *   vec           typedef, and vec_root (vec), vec_fuse (a, b, c): a b + c, FUSED: 1 if rounded once,
 *   vec_least (a, b), vec_most (a, b): the smaller, the larger one,
 *   vec_keep (v, bits): 0 in lanes whose bit is not set,
 *   hits, HITS_OVER (hits, v, limit), HITS_OVER_OF (hits, v, limit, bits), HITS_ANY (hits): lanes with v >=
 *     limit (of those in bits),
 *   zip (out, a, b), unzip (in, &a, &b): pairs in memory from and to two vectors. */
#include "block.h"

#ifdef __clang__
#define UNROLL _Pragma ("unroll")
#else
#define UNROLL _Pragma ("GCC unroll 32")
#endif
#define INLINE static inline __attribute__ ((always_inline)) TARGET

typedef double vec_loose __attribute__ ((vector_size (8 * LANES), aligned (8), may_alias));
#define LOAD(p) (*(const vec_loose *) (p))
#define STORE(p, v) (*(vec_loose *) (p) = (v))
#define ALL(x) ((x) - (vec) { 0 })                     /* x in every lane (x - 0: keeps -0) */

/* Sums of one stride of a block, `stride` its first site: out[k * PG_BLOCK + site] */
INLINE void sum_stride (const pg_block_job *job, size_t k, int stride, int dim, int finite, int check,
                        int weighted, double *out, hits *over)
{
    const int vecs = VECS (dim);
    const pg_block *b = job->block + k;
    const double *u[3] = { job->u[0] + b->base + stride, job->u[1] + b->base + stride,
                           job->u[2] + b->base + stride };
    const double *p = weighted ? job->p + b->base + stride : NULL;
    const uint32_t *alive = job->alive + k * job->n,
                   *may = check == PG_CHECK_SOME ? job->may + k * job->n : NULL;
    vec own[3][8], sum[3][8];
    UNROLL for (int d = 0; d < dim; d++) {
        UNROLL for (int v = 0; v < vecs; v++) own[d][v] = LOAD (u[d] + v * LANES), sum[d][v] = (vec) { 0 };
    }
    for (size_t j = 0; j < job->n; j++) {
        const ptrdiff_t jump = job->jump[j];
        const double *t = job->term + j * PG_TERMS;
        const uint32_t live = alive[j] >> stride, free = check == PG_CHECK_SOME ? may[j] >> stride : 0;
        const vec limit = ALL (t[PG_AT_LIMIT]), r2 = ALL (t[PG_AT_R2]), r = ALL (t[PG_AT_R]);
        vec xi[3], pull[3];
        UNROLL for (int d = 0; d < dim; d++) xi[d] = ALL (t[PG_AT_XI + d]), pull[d] = ALL (t[PG_AT_PULL + d]);
        UNROLL for (int v = 0; v < vecs; v++) {
            vec eta[3], y[3], s = { 0 };
            UNROLL for (int d = 0; d < dim; d++) eta[d] = LOAD (u[d] + jump + v * LANES) - own[d][v];
            if (finite) {
                UNROLL for (int d = 0; d < dim; d++) y[d] = xi[d] + eta[d];
                s = eta[0] * (xi[0] + y[0]);
                UNROLL for (int d = 1; d < dim; d++) s = vec_fuse (eta[d], xi[d] + y[d], s);
            } else {
                s = xi[0] * eta[0];
                UNROLL for (int d = 1; d < dim; d++) s = vec_fuse (xi[d], eta[d], s);
            }
            vec_keep (s, live >> (v * LANES));
            if (check == PG_CHECK_ALL) HITS_OVER (*over, s, limit);
            if (check == PG_CHECK_SOME) HITS_OVER_OF (*over, s, limit, free >> (v * LANES));
            if (finite) {
                vec root = vec_root (s + r2);
                s = s * pull[0] / (root * (root + r));
            }
            if (weighted) s = s * LOAD (p + jump + v * LANES);
            UNROLL for (int d = 0; d < dim; d++) sum[d][v] = vec_fuse (s, finite ? y[d] : pull[d], sum[d][v]);
        }
    }
    UNROLL for (int d = 0; d < dim; d++) {
        UNROLL for (int v = 0; v < vecs; v++) {
            if (weighted) sum[d][v] = sum[d][v] * LOAD (p + v * LANES);
            STORE (out + d * PG_BLOCK + stride + v * LANES, sum[d][v]);
        }
    }
}

/* Sums of a block to f of its points */
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

INLINE void force_loop (const pg_block_job *job, size_t first, size_t last, int dim, int finite, int check,
                        int weighted)
{
    const int width = VECS (dim) * LANES;
    const uint32_t part = width < 32 ? (1u << (width & 31)) - 1 : UINT32_MAX;
    double out[3 * PG_BLOCK] __attribute__ ((aligned (64)));
    for (size_t k = first; k < last; k++) {
        hits over = { 0 };
        for (int stride = 0; stride < PG_BLOCK; stride += width)
            if (job->block[k].present >> stride & part)
                sum_stride (job, k, stride, dim, finite, check, weighted, out, &over);
        gather (job, job->block + k, dim, out);
        if (check && HITS_ANY (over)) job->hit[k] = 1;
    }
}

/* Linear: a (xi.eta)^2; finite: a r^2 q^2 / (|y| + r)^2 */
INLINE void energy_loop (const pg_block_job *job, size_t first, size_t last, int dim, int finite,
                         int weighted)
{
    double lane[LANES];
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        double whole = 0;
        for (int at = 0; at < PG_BLOCK; at += LANES) {
            vec sum = { 0 };
            for (size_t j = 0; j < job->n; j++) {
                const double *t = job->term + j * PG_TERMS;
                vec s = { 0 };
                UNROLL for (int d = 0; d < dim; d++) {
                    const double *u = job->u[d] + b->base + at;
                    vec eta = LOAD (u + job->jump[j]) - LOAD (u);
                    const vec xi = ALL (t[PG_AT_XI + d]);
                    s = vec_fuse (eta, finite ? xi + (xi + eta) : xi, s);
                }
                vec_keep (s, job->alive[k * job->n + j] >> at);
                if (finite) s = s / (vec_root (s + ALL (t[PG_AT_R2])) + ALL (t[PG_AT_R]));
                vec w = s * ALL (t[PG_AT_STORED]);
                if (weighted) w = w * LOAD (job->p + b->base + at + job->jump[j]);
                sum = vec_fuse (s, w, sum);
            }
            if (weighted) sum = sum * LOAD (job->p + b->base + at);
            STORE (lane, sum);
            for (int l = 0; l < LANES; l++) whole += lane[l];
            for (int l = 0; job->energies && l < LANES; l++)
                if (b->present >> (at + l) & 1)
                    job->energies[job->point[b->site + (size_t) (at + l)]] = lane[l];
        }
        job->energy[k] = whole;
    }
}

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

#include "state_kernel.h"
#include "beam_kernel.h"

#define FORCE(D, F, C, W) \
    static TARGET void force_##D##F##C##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        force_loop (job, first, last, D, F, C, W); \
    }
#define ENERGY(D, F, W) \
    static TARGET void energy_##D##F##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        energy_loop (job, first, last, D, F, W); \
    }
#define FORCES(D, F) \
    FORCE (D, F, 0, 0) \
    FORCE (D, F, 0, 1) FORCE (D, F, 1, 0) FORCE (D, F, 1, 1) FORCE (D, F, 2, 0) FORCE (D, F, 2, 1) \
        ENERGY (D, F, 0) ENERGY (D, F, 1)
FORCES (1, 0)
FORCES (1, 1) FORCES (2, 0) FORCES (2, 1) FORCES (3, 0) FORCES (3, 1)
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
        .fused = FUSED,
    };
