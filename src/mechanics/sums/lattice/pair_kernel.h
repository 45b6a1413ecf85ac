/* SPDX-License-Identifier: GPL-3.0-or-later
 * pair_kernel.h: loops of pair forces along bonds over the blocks of block.h (private, included by
 * block_kernel.h once per instruction set; theory A, B1). For an intact bond with constant a = c V^2 k beta /
 * r^3:
 *   linear  force on the own end a (xi . eta) xi,       stored a (xi . eta)^2
 *   finite  with y = xi + eta and s = |y|^2 - r^2 = eta . (xi + y), which cancels nothing:
 *           force a r^2 s y / (|y| (|y| + r)),          stored a r^2 s^2 / (|y| + r)^2.
 * Bonds over their limit set a flag of their block; which bonds these are is found bond by bond afterwards.
 * */

/* Returns the measure that is compared with the limit, m^2: linear xi . eta; finite s = |y|^2 - r^2 with the
 * deformed bond y = xi + eta. s = eta . (xi + y) loses no digits, while |y|^2 - r^2 of a small stretch would
 * lose most. */
INLINE vec pair_measure (const vec *xi, const vec *eta, vec *y, int dim, int finite)
{
    vec s;
    if (finite) {
        UNROLL for (int d = 0; d < dim; d++) y[d] = xi[d] + eta[d];
        s = eta[0] * (xi[0] + y[0]);
        UNROLL for (int d = 1; d < dim; d++) s = vec_fuse (eta[d], xi[d] + y[d], s);
    } else {
        s = xi[0] * eta[0];
        UNROLL for (int d = 1; d < dim; d++) s = vec_fuse (xi[d], eta[d], s);
    }
    return s;
}

/* Multiplies the sums of a stride by the weights p of its points and stores them in `out`. */
INLINE void pair_store (vec (*sum)[8], const double *p, int vecs, int dim, int weighted, double *out)
{
    UNROLL for (int d = 0; d < dim; d++) {
        UNROLL for (int v = 0; v < vecs; v++) {
            if (weighted) sum[d][v] = sum[d][v] * LOAD (p + v * LANES);
            STORE (out + d * PG_BLOCK + v * LANES, sum[d][v]);
        }
    }
}

/* Forces of one stride of block k, `stride` being its first site: out[component * PG_BLOCK + site], N. The
 * outer loop runs over bonds, lanes are sites. The finite force a r^2 s y / (|y| (|y| + r)) takes one root
 * and one quotient per bond. */
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
            vec eta[3], y[3], s;
            UNROLL for (int d = 0; d < dim; d++) eta[d] = LOAD (u[d] + jump + v * LANES) - own[d][v];
            s = pair_measure (xi, eta, y, dim, finite);
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
    pair_store (sum, p, vecs, dim, weighted, out + stride);
}

/* Forces of the blocks first .. last - 1, strides without points left out; sets job->hit of blocks with a
 * bond over its limit. */
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

/* Sums twice the energy of each bond, J, from both ends, to job->energy: linear a (xi.eta)^2; finite a r^2
 * q^2 / (|y| + r)^2 with q = |y|^2 - r^2, which is a r^2 (|y| - r)^2 without cancellation. */
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

/* One function for each dimension, strain measure, check and weighting: all are constants for the compiler.
 * */
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
