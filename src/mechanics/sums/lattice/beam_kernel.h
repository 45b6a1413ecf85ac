/* SPDX-License-Identifier: GPL-3.0-or-later
 * beam_kernel.h: loops over micropolar bonds of the blocks of block.h (private, included by block_kernel.h
 * once per instruction set; theory G2). Force f and moment m of an intact bond, with q = length theta and
 * lever = 1 / (2 length): w = eta - lever (q_i + q_j) x xi, f = kt w + g (xi.w) xi, m = lever xi x f + kb
 * (q_j - q_i)_perp. From the other end each term has the opposite sign or the same, bit by bit. */

#define BEAM_VECS(dim) ((dim) == 2 && LANES > 2 ? 2 : 1)
#define POSITIVE(v) ((vec) ((__typeof__ ((v) > (vec) { 0 })) (v) & ((v) > (vec) { 0 })))
#define LARGER(a, b) \
    ((vec) (((__typeof__ ((a) > (b))) (a) & ((a) > (b))) | ((__typeof__ ((a) > (b))) (b) & ~((a) > (b)))))

/* Motion of bond t (PG_TERMS numbers) at LANES points from place `at` of the padded arrays on; jump: places
 * to their neighbours. w = eta - lever (q_i + q_j) x xi, the relative displacement less that of a rigid
 * rotation of the bond with the mean rotation of its ends, m; turn = q_j - q_i, relative rotation of the ends
 * times the length, m. */
INLINE void beam_motion (const pg_block_job *job, size_t at, ptrdiff_t jump, int dim, const double *t, vec *w,
                         vec *turn)
{
    const int turns = dim == 2 ? 1 : 3;
    const vec lever = ALL (job->lever);
    vec sum[3];
    UNROLL for (int k = 0; k < turns; k++) {
        vec here = LOAD (job->q[k] + at), there = LOAD (job->q[k] + (ptrdiff_t) at + jump);
        sum[k] = lever * (here + there), turn[k] = there - here;
    }
    UNROLL for (int d = 0; d < dim; d++)
        w[d] = LOAD (job->u[d] + (ptrdiff_t) at + jump) - LOAD (job->u[d] + at);
    const vec x = ALL (t[PG_AT_XI]), y = ALL (t[PG_AT_XI + 1]), z = ALL (t[PG_AT_XI + 2]);
    if (dim == 2) {
        w[0] = vec_fuse (sum[0], y, w[0]);
        w[1] = vec_fuse (-sum[0], x, w[1]);
    } else {
        w[0] = vec_fuse (sum[2], y, vec_fuse (-sum[1], z, w[0]));
        w[1] = vec_fuse (sum[0], z, vec_fuse (-sum[2], x, w[1]));
        w[2] = vec_fuse (sum[1], x, vec_fuse (-sum[0], y, w[2]));
    }
}

/* Returns xi . v of n components, m^2. */
INLINE vec beam_along (int n, const double *t, const vec *v)
{
    vec sum = ALL (t[PG_AT_XI]) * v[0];
    UNROLL for (int d = 1; d < n; d++) sum = vec_fuse (ALL (t[PG_AT_XI + d]), v[d], sum);
    return sum;
}

/* Removes the component of `turn` along the bond: bonds have stiffness against bending, not against twist. */
INLINE void beam_across (const double *t, vec *turn)
{
    vec twist = beam_along (3, t, turn) * ALL (t[PG_AT_BEAM_INVERSE]);
    UNROLL for (int k = 0; k < 3; k++) turn[k] = vec_fuse (-twist, ALL (t[PG_AT_XI + k]), turn[k]);
}

/* Forces and moments on the points of one stride of block k, `stride` being its first site. The outer loop
 * runs over bonds, lanes are sites, so that the numbers of a bond are read once for the whole stride. out:
 * dim forces, then moments over the length, each PG_BLOCK numbers apart, N. weighted: sums are multiplied by
 * the weights p of both ends (shares of volumes, surface correction). */
INLINE void beam_stride (const pg_block_job *job, size_t k, int stride, int dim, int weighted, double *out)
{
    const int vecs = BEAM_VECS (dim), turns = dim == 2 ? 1 : 3;
    const size_t base = job->block[k].base + (size_t) stride;
    const uint32_t *alive = job->alive + k * job->n;
    vec force[3][2], cross[3][2], bend[3][2];
    UNROLL for (int v = 0; v < vecs; v++) {
        UNROLL for (int d = 0; d < 3; d++) force[d][v] = cross[d][v] = bend[d][v] = (vec) { 0 };
    }
    for (size_t j = 0; j < job->n; j++) {
        const ptrdiff_t jump = job->jump[j];
        const double *t = job->term + j * PG_TERMS;
        const vec x = ALL (t[PG_AT_XI]), y = ALL (t[PG_AT_XI + 1]), z = ALL (t[PG_AT_XI + 2]);
        UNROLL for (int v = 0; v < vecs; v++) {
            const size_t at = base + (size_t) (v * LANES);
            /* Broken bonds get zero stiffness; lanes without a point have zeros and add nothing. */
            const uint32_t live = alive[j] >> (stride + v * LANES);
            vec w[3], turn[3], f[3], kt = ALL (t[PG_AT_KT]), kb = ALL (t[PG_AT_KB]), g = ALL (t[PG_AT_KG]);
            vec_keep (kt, live);
            vec_keep (kb, live);
            vec_keep (g, live);
            if (weighted) {
                vec p = LOAD (job->p + (ptrdiff_t) at + jump);
                kt = kt * p, kb = kb * p, g = g * p;
            }
            beam_motion (job, at, jump, dim, t, w, turn);
            g = g * beam_along (dim, t, w);
            UNROLL for (int d = 0; d < dim; d++) {
                f[d] = vec_fuse (g, ALL (t[PG_AT_XI + d]), kt * w[d]);
                force[d][v] = force[d][v] + f[d];
            }
            if (dim == 2) cross[0][v] = vec_fuse (x, f[1], vec_fuse (-y, f[0], cross[0][v]));
            else {
                beam_across (t, turn);
                cross[0][v] = vec_fuse (y, f[2], vec_fuse (-z, f[1], cross[0][v]));
                cross[1][v] = vec_fuse (z, f[0], vec_fuse (-x, f[2], cross[1][v]));
                cross[2][v] = vec_fuse (x, f[1], vec_fuse (-y, f[0], cross[2][v]));
            }
            UNROLL for (int c = 0; c < turns; c++) bend[c][v] = vec_fuse (kb, turn[c], bend[c][v]);
        }
    }
    UNROLL for (int v = 0; v < vecs; v++) {
        vec p = ALL (1.0);
        if (weighted) p = LOAD (job->p + base + v * LANES);
        UNROLL for (int d = 0; d < dim; d++) STORE (out + d * PG_BLOCK + stride + v * LANES, force[d][v] * p);
        UNROLL for (int c = 0; c < turns; c++)
            STORE (out + (dim + c) * PG_BLOCK + stride + v * LANES,
                   vec_fuse (ALL (job->lever), cross[c][v], bend[c][v]) * p);
    }
}

/* Forces and moments of the blocks first .. last - 1: strides without points are left out. */
INLINE void beam_force_loop (const pg_block_job *job, size_t first, size_t last, int dim, int weighted)
{
    const int width = BEAM_VECS (dim) * LANES, m = dim == 2 ? 3 : 6;
    const uint32_t part = (1u << width) - 1;
    double out[6 * PG_BLOCK] __attribute__ ((aligned (64)));
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        for (int stride = 0; stride < PG_BLOCK; stride += width)
            if (b->present >> stride & part) beam_stride (job, k, stride, dim, weighted, out);
        for (uint32_t left = b->present; left; left &= left - 1) {
            int l = __builtin_ctz (left);
            double *f = job->f + (size_t) job->point[b->site + (size_t) l] * (size_t) m;
            for (int c = 0; c < m; c++) f[c] = out[c * PG_BLOCK + l];
        }
    }
}

/* Squared utilisation of bond j at LANES points: the largest (job->single) or the sum (Chen 2022) of (s /
 * s0)^2 for a stretch s > 0, (gamma / gamma0)^2 and (kappa / kappa0)^2. A bond breaks where it reaches 1; 0
 * where the bond is broken or may not break (bits `live`). */
INLINE vec beam_share (const pg_block_job *job, size_t at, size_t j, int dim, uint32_t live)
{
    const double *t = job->term + j * PG_TERMS;
    vec w[3], turn[3], shear = { 0 }, bend;
    beam_motion (job, at, job->jump[j], dim, t, w, turn);
    vec s = beam_along (dim, t, w) * ALL (t[PG_AT_BEAM_INVERSE]);
    UNROLL for (int d = 0; d < dim; d++) {
        vec across = vec_fuse (-s, ALL (t[PG_AT_XI + d]), w[d]);
        shear = vec_fuse (across, across, shear);
    }
    bend = turn[0];
    if (dim == 3) {
        beam_across (t, turn);
        bend = turn[0] * turn[0];
        bend = vec_fuse (turn[1], turn[1], bend);
        bend = vec_fuse (turn[2], turn[2], bend);
    } else bend = bend * bend;
    s = POSITIVE (s);
    s = s * s * ALL (t[PG_AT_STRETCH_SHARE]), shear = shear * ALL (t[PG_AT_SHEAR_SHARE]),
    bend = bend * ALL (t[PG_AT_BEND_SHARE]);
    vec all = job->single ? LARGER (s, LARGER (shear, bend)) : s + shear + bend;
    vec_keep (all, live);
    return all;
}

/* Sets job->hit for blocks with a bond at its limit. As these are few, bonds are not noted here, but by
 * beam_over_loop for these blocks only. */
INLINE void beam_look_loop (const pg_block_job *job, size_t first, size_t last, int dim)
{
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        const uint32_t *alive = job->alive + k * job->n, *may = job->may ? job->may + k * job->n : alive;
        hits over = { 0 };
        for (size_t j = 0; j < job->n; j++)
            for (int at = 0; at < PG_BLOCK && (alive[j] & may[j]) >> at; at += LANES)
                HITS_OVER (over, beam_share (job, b->base + (size_t) at, j, dim, (alive[j] & may[j]) >> at),
                           ALL (1.0));
        if (HITS_ANY (over)) job->hit[k] = 1;
    }
}

/* Notes which bonds of blocks first .. last - 1 are at their limit: a bit per site and bond in job->over, as
 * in job->alive. */
INLINE void beam_over_loop (const pg_block_job *job, size_t first, size_t last, int dim)
{
    double lane[LANES];
    for (size_t k = first; k < last; k++)
        for (size_t j = 0; j < job->n; j++) {
            uint32_t live = job->alive[k * job->n + j] & (job->may ? job->may[k * job->n + j] : UINT32_MAX),
                     bits = 0;
            for (int at = 0; at < PG_BLOCK && live >> at; at += LANES) {
                STORE (lane, beam_share (job, job->block[k].base + (size_t) at, j, dim, live >> at));
                for (int l = 0; l < LANES; l++) bits |= (uint32_t) (lane[l] >= 1) << (at + l);
            }
            job->over[k * job->n + j] = bits;
        }
}

/* Twice the energy of the bonds of every point, J: kn s^2 r^2 + kt gamma^2 r^2 + kb turn^2, written with
 * g = (kn - kt) / r^2 as kt w.w + g (xi.w)^2 + kb turn.turn. Each bond is summed from both ends, so that the
 * sum over all blocks is four times the energy of the body. job->energy: sum of a block, in the order of
 * its lanes; job->energies: that of each point, or NULL. */
INLINE void beam_energy_loop (const pg_block_job *job, size_t first, size_t last, int dim, int weighted)
{
    const int turns = dim == 2 ? 1 : 3;
    double lane[LANES];
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        double whole = 0;
        for (int stride = 0; stride < PG_BLOCK; stride += LANES) {
            const size_t at = b->base + (size_t) stride;
            vec sum = { 0 };
            for (size_t j = 0; j < job->n; j++) {
                const double *t = job->term + j * PG_TERMS;
                vec w[3], turn[3], e = { 0 }, bend = { 0 };
                beam_motion (job, at, job->jump[j], dim, t, w, turn);
                vec along = beam_along (dim, t, w);
                if (dim == 3) beam_across (t, turn);
                UNROLL for (int d = 0; d < dim; d++) e = vec_fuse (w[d], w[d], e);
                UNROLL for (int c = 0; c < turns; c++) bend = vec_fuse (turn[c], turn[c], bend);
                e = vec_fuse (ALL (t[PG_AT_KG]), along * along,
                              vec_fuse (ALL (t[PG_AT_KT]), e, ALL (t[PG_AT_KB]) * bend));
                vec_keep (e, job->alive[k * job->n + j] >> stride);
                if (weighted) e = e * LOAD (job->p + (ptrdiff_t) at + job->jump[j]);
                sum = sum + e;
            }
            if (weighted) sum = sum * LOAD (job->p + at);
            STORE (lane, sum);
            for (int l = 0; l < LANES; l++) {
                whole += lane[l];
                if (job->energies && b->present >> (stride + l) & 1)
                    job->energies[job->point[b->site + (size_t) (stride + l)]] = lane[l];
            }
        }
        job->energy[k] = whole;
    }
}

/* One function for each dimension, and for bonds with and without weights: both are constants for the
 * compiler, so that loops have no branches on them. */
#define BEAM(D, W) \
    static TARGET void beam_force_##D##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        beam_force_loop (job, first, last, D, W); \
    } \
    static TARGET void beam_energy_##D##W (const pg_block_job *job, size_t first, size_t last) \
    { \
        beam_energy_loop (job, first, last, D, W); \
    }
#define BEAMS(D) \
    BEAM (D, 0) \
    BEAM (D, 1) static TARGET void beam_look_##D (const pg_block_job *job, size_t first, size_t last) \
    { \
        beam_look_loop (job, first, last, D); \
    } \
    static TARGET void beam_over_##D (const pg_block_job *job, size_t first, size_t last) \
    { \
        beam_over_loop (job, first, last, D); \
    }
BEAMS (2) BEAMS (3)
