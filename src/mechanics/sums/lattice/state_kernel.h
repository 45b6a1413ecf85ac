/* SPDX-License-Identifier: GPL-3.0-or-later
 * state_kernel.h: loops of state-based theory over the blocks of block.h (private, included by block_kernel.h
 * once per instruction set; theory B6). With e = xi.eta of an intact bond, w = k beta / r:
 *   dilate  alpha_i = factor_i sum_j w e V_j          (= A theta / q)
 *   pull    f_i     = V_i sum_j w V_j [alpha_i + alpha_j + (beta_i + beta_j) e / r^2] xi
 *   store   W_i     = 1/2 [factor_i (sum_j w e V_j)^2 + beta_i sum_j w e^2 / r^2 V_j] */

/* Computes alpha of the points of one stride of block k: sum over bonds of w V e, times the factor of each
 * point. check: bonds over their limit set `over` (PG_CHECK_SOME: only those that may break); weighted: V is
 * multiplied by the neighbour's share p. */
INLINE void dilate_stride (const pg_block_job *job, size_t k, int stride, int dim, int check, int weighted,
                           hits *over)
{
    const int vecs = VECS (dim);
    const pg_block *b = job->block + k;
    const size_t base = b->base + (size_t) stride;
    const double *u[3] = { job->u[0] + base, job->u[1] + base, job->u[2] + base },
                 *p = weighted ? job->p + base : NULL;
    const uint32_t *alive = job->alive + k * job->n,
                   *may = check == PG_CHECK_SOME ? job->may + k * job->n : NULL;
    vec own[3][8], sum[8];
    UNROLL for (int v = 0; v < vecs; v++) {
        UNROLL for (int d = 0; d < dim; d++) own[d][v] = LOAD (u[d] + v * LANES);
        sum[v] = (vec) { 0 };
    }
    for (size_t j = 0; j < job->n; j++) {
        const ptrdiff_t jump = job->jump[j];
        const double *t = job->term + j * PG_TERMS;
        const uint32_t live = alive[j] >> stride, free = check == PG_CHECK_SOME ? may[j] >> stride : 0;
        /* The numbers of a bond in all lanes; e of broken bonds is masked, so that they add nothing. */
        const vec limit = ALL (t[PG_AT_LIMIT]), wV = ALL (t[PG_AT_WV]);
        UNROLL for (int v = 0; v < vecs; v++) {
            vec s = ALL (t[PG_AT_XI]) * (LOAD (u[0] + jump + v * LANES) - own[0][v]);
            UNROLL for (int d = 1; d < dim; d++)
                s = vec_fuse (ALL (t[PG_AT_XI + d]), LOAD (u[d] + jump + v * LANES) - own[d][v], s);
            vec_keep (s, live >> (v * LANES));
            if (check == PG_CHECK_ALL) HITS_OVER (*over, s, limit);
            if (check == PG_CHECK_SOME) HITS_OVER_OF (*over, s, limit, free >> (v * LANES));
            if (weighted) s = s * LOAD (p + jump + v * LANES);
            sum[v] = vec_fuse (s, wV, sum[v]);
        }
    }
    UNROLL for (int v = 0; v < vecs; v++)
        STORE (job->alpha + base + v * LANES, sum[v] * LOAD (job->factor + base + v * LANES));
}

/* Forces of one stride, N: sum over bonds of w V V [alpha_i + alpha_j + (beta_i + beta_j) e / r^2] xi. In 3D
 * a stride of many vectors needs more registers than there are, and is done in two halves. */
INLINE void pull_stride (const pg_block_job *job, size_t k, int stride, int dim, int weighted, double *out)
{
    const int vecs = dim == 3 && VECS (dim) > 1 ? VECS (dim) / 2 : VECS (dim);
    const uint32_t *alive = job->alive + k * job->n;
    for (int half = 0; half < VECS (dim); half += vecs) {
        const int begin = stride + half * LANES;
        const size_t base = job->block[k].base + (size_t) begin;
        const double *u[3] = { job->u[0] + base, job->u[1] + base, job->u[2] + base },
                     *p = weighted ? job->p + base : NULL;
        const double *alpha = job->alpha + base, *beta = job->beta + base;
        vec own[3][8], a[8], c[8], sum[3][8];
        UNROLL for (int v = 0; v < vecs; v++) {
            UNROLL for (int d = 0; d < dim; d++) own[d][v] = LOAD (u[d] + v * LANES), sum[d][v] = (vec) { 0 };
            a[v] = LOAD (alpha + v * LANES), c[v] = LOAD (beta + v * LANES);
        }
        for (size_t j = 0; j < job->n; j++) {
            const ptrdiff_t jump = job->jump[j];
            const double *t = job->term + j * PG_TERMS;
            const uint32_t live = alive[j] >> begin;
            UNROLL for (int v = 0; v < vecs; v++) {
                vec s = ALL (t[PG_AT_XI]) * (LOAD (u[0] + jump + v * LANES) - own[0][v]);
                UNROLL for (int d = 1; d < dim; d++)
                    s = vec_fuse (ALL (t[PG_AT_XI + d]), LOAD (u[d] + jump + v * LANES) - own[d][v], s);
                s = vec_fuse (s * ALL (t[PG_AT_INVERSE]), c[v] + LOAD (beta + jump + v * LANES),
                              a[v] + LOAD (alpha + jump + v * LANES));
                vec_keep (s, live >> (v * LANES));
                s = s * ALL (t[PG_AT_WVV]);
                if (weighted) s = s * LOAD (p + jump + v * LANES);
                UNROLL for (int d = 0; d < dim; d++)
                    sum[d][v] = vec_fuse (s, ALL (t[PG_AT_XI + d]), sum[d][v]);
            }
        }
        UNROLL for (int d = 0; d < dim; d++) {
            UNROLL for (int v = 0; v < vecs; v++) {
                if (weighted) sum[d][v] = sum[d][v] * LOAD (p + v * LANES);
                STORE (out + d * PG_BLOCK + begin + v * LANES, sum[d][v]);
            }
        }
    }
}

/* Computes alpha of the blocks first .. last - 1, strides without points left out (part: the bits of one
 * stride); sets job->hit of blocks with a bond over its limit. */
INLINE void dilate_loop (const pg_block_job *job, size_t first, size_t last, int dim, int check, int weighted)
{
    const int width = VECS (dim) * LANES;
    const uint32_t part = width < 32 ? (1u << (width & 31)) - 1 : UINT32_MAX;
    for (size_t k = first; k < last; k++) {
        hits over = { 0 };
        for (int stride = 0; stride < PG_BLOCK; stride += width)
            if (job->block[k].present >> stride & part)
                dilate_stride (job, k, stride, dim, check, weighted, &over);
        if (check && HITS_ANY (over)) job->hit[k] = 1;
    }
}

/* Forces of the blocks first .. last - 1, N, to job->f; strides without points are left out. */
INLINE void pull_loop (const pg_block_job *job, size_t first, size_t last, int dim, int weighted)
{
    const int width = VECS (dim) * LANES;
    const uint32_t part = width < 32 ? (1u << (width & 31)) - 1 : UINT32_MAX;
    double out[3 * PG_BLOCK] __attribute__ ((aligned (64)));
    for (size_t k = first; k < last; k++) {
        for (int stride = 0; stride < PG_BLOCK; stride += width)
            if (job->block[k].present >> stride & part) pull_stride (job, k, stride, dim, weighted, out);
        gather (job, job->block + k, dim, out);
    }
}

/* Energy density of every point, J/m^3, to job->energies unless NULL, and energy of each block, J, to
 * job->energy. Lanes without a point have no intact bond and add zeros, so that only the output is masked. */
INLINE void store_loop (const pg_block_job *job, size_t first, size_t last, int dim, int weighted)
{
    double lane[LANES];
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        double whole = 0;
        for (int at = 0; at < PG_BLOCK; at += LANES) {
            const size_t base = b->base + (size_t) at;
            vec sum = { 0 }, square = { 0 };
            for (size_t j = 0; j < job->n; j++) {
                const ptrdiff_t jump = job->jump[j];
                const double *t = job->term + j * PG_TERMS;
                vec s = { 0 };
                UNROLL for (int d = 0; d < dim; d++)
                    s = vec_fuse (ALL (t[PG_AT_XI + d]),
                                  LOAD (job->u[d] + base + jump) - LOAD (job->u[d] + base), s);
                vec_keep (s, job->alive[k * job->n + j] >> at);
                vec w = s * ALL (t[PG_AT_WV]);
                if (weighted) w = w * LOAD (job->p + base + jump);
                sum = sum + w;
                square = vec_fuse (w, s * ALL (t[PG_AT_INVERSE]), square);
            }
            vec W = (sum * sum * LOAD (job->factor + base) + square * LOAD (job->beta + base)) * ALL (0.5);
            STORE (lane, W);
            for (int l = 0; job->energies && l < LANES; l++)
                if (b->present >> (at + l) & 1)
                    job->energies[job->point[b->site + (size_t) (at + l)]] = lane[l];
            W = W * ALL (job->volume);
            if (weighted) W = W * LOAD (job->p + base);
            STORE (lane, W);
            for (int l = 0; l < LANES; l++) whole += lane[l];
        }
        job->energy[k] = whole;
    }
}

/* One function for each dimension, check and weighting: all are constants for the compiler. */
#define DILATE(D, C, W) \
    static TARGET void dilate_##D##C##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        dilate_loop (job, first, last, D, C, W); \
    }
#define PULL(D, W) \
    static TARGET void pull_##D##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        pull_loop (job, first, last, D, W); \
    } \
    static TARGET void store_##D##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        store_loop (job, first, last, D, W); \
    }
#define STATES(D) \
    DILATE (D, 0, 0) \
    DILATE (D, 0, 1) DILATE (D, 1, 0) DILATE (D, 1, 1) DILATE (D, 2, 0) DILATE (D, 2, 1) PULL (D, 0) \
        PULL (D, 1)
STATES (2) STATES (3)
#define DILATES(D) \
    { \
        { dilate_##D##00, dilate_##D##01 }, { dilate_##D##10, dilate_##D##11 }, \
        { \
            dilate_##D##20, dilate_##D##21 \
        } \
    }
#define PULLS(D) { pull_##D##0, pull_##D##1 }
#define STORES(D) { store_##D##0, store_##D##1 }
