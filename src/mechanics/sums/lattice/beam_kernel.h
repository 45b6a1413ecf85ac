/* SPDX-License-Identifier: GPL-3.0-or-later
 * beam_kernel.h: loops over micropolar bonds of the blocks of block.h (private, included by block_kernel.h
 * once per instruction set; theory G2). Of a live bond, q = length theta, lever = 1 / (2 length): w = eta -
 * lever (q_i + q_j) x xi, f = kt w + g (xi.w) xi, m = lever xi x f + kb (q_j - q_i)_perp. What is seen from
 * the other end has the opposite sign or the same, bit by bit. */

#define BEAM_VECS(dim) ((dim) == 2 && LANES > 2 ? 2 : 1)
#define POSITIVE(v) ((vec) ((__typeof__ ((v) > (vec) { 0 })) (v) & ((v) > (vec) { 0 })))
#define LARGER(a, b) \
    ((vec) (((__typeof__ ((a) > (b))) (a) & ((a) > (b))) | ((__typeof__ ((a) > (b))) (b) & ~((a) > (b)))))

/* Motion of one bond at `at` places of both ends: w = eta - lever (q_i + q_j) x xi, the relative
 * displacement less what a rigid turn of the bond about its middle with the mean rotation of its ends
 * would give it, m; turn = q_j - q_i, by how much the ends turn against each other, times the length, m.
 * jump: padded places from the own end to the other one; t: the numbers of the bond (PG_TERMS). */
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

/* xi . v of n components, m^2: what of v lies along the bond, times its length. */
INLINE vec beam_along (int n, const double *t, const vec *v)
{
    vec sum = ALL (t[PG_AT_XI]) * v[0];
    UNROLL for (int d = 1; d < n; d++) sum = vec_fuse (ALL (t[PG_AT_XI + d]), v[d], sum);
    return sum;
}

/* Takes from `turn` what is along the bond: a bond has no stiffness against twist, only against bending. */
INLINE void beam_across (const double *t, vec *turn)
{
    vec twist = beam_along (3, t, turn) * ALL (t[PG_AT_BEAM_INVERSE]);
    UNROLL for (int k = 0; k < 3; k++) turn[k] = vec_fuse (-twist, ALL (t[PG_AT_XI + k]), turn[k]);
}

/* Forces and moments on the points of one stride of block k, `stride` being its first site. The loop runs
 * over bonds outside and over sites in the lanes inside, so that all numbers of a bond are read once for
 * the whole stride. out: dim forces, then the moments over the length, each PG_BLOCK sites apart, N.
 * weighted: every sum is times the weights p of both ends (partial volumes, surface correction). */
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
            /* Dead bonds lose their stiffness, not their motion: lanes without a point hold zeros and add
             * nothing. */
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

/* All blocks of a range: strides that have no point are left out, and their part of `out` is not read. */
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

/* How much of its limit a bond has used up, squared: (s / s0)^2 for a stretch s > 0, (gamma / gamma0)^2
 * and (kappa / kappa0)^2, the largest of the three (job->single) or their sum (Chen 2022). A bond breaks
 * where this reaches 1; 0 where it is dead or may not break. */
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

/* Sets job->hit for blocks in which a bond is at its limit. Few blocks are, so that this loop notes no
 * bonds: beam_over_loop is asked for these blocks alone. */
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

/* Which bonds of a block these are: one bit per site and bond in job->over, as in job->alive. */
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
 * g = (kn - kt) / r^2 as kt w.w + g (xi.w)^2 + kb turn.turn. Each bond is met from both ends, so that the
 * sum over all blocks is four times the energy of the body. job->energy: sum of a block, in the order of
 * its lanes; job->energies, where it is wanted: that of each point. */
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

/* One function for each dimension and for bonds with and without weights: the compiler sees both as
 * constants and leaves no question in the loops. */
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
