/* SPDX-License-Identifier: GPL-3.0-or-later
 * fold_kernel.h: loops of folded stencils over the blocks of block.h (private, included by block_kernel.h
 * once per instruction set). In 2D, where a bond (x, y) has the same constant a as its three mirror images
 * (-x, y), (x, -y), (-x, -y), the force on a point with all bonds intact is
 *
 *   f_x = sum_x [ P(x) at x to the right + Q(x) at x to the left ] - K_xx u_x,
 *   P, Q = sum_y a x^2 (u_x above + u_x below) +- sum_y a x y (u_y above - u_y below),
 *
 * and similarly for f_y: rows are folded onto the row of the point, then columns onto the point, which takes
 * a fourth of the products of a sum bond by bond. Sums are of u less that of a place nearby, so that a motion
 * of the body as a whole causes no rounding errors. */

/* Folds rows onto the row of some blocks, at LANES places from `place` on: sums and differences (apart) of
 * the rows j above and below, j from 1 on; j = 0: the row itself. ref: displacement that is subtracted, m. */
INLINE void fold_rows (const pg_block_job *job, size_t place, const int rows, const vec *ref, vec (*sum)[2],
                       vec (*apart)[2])
{
    UNROLL for (int d = 0; d < 2; d++) sum[0][d] = LOAD (job->u[d] + place) - ref[d];
    UNROLL for (int j = 1; j <= rows; j++) {
        const size_t step = (size_t) j * job->fold->pitch;
        UNROLL for (int d = 0; d < 2; d++) {
            const vec up = LOAD (job->u[d] + place + step), down = LOAD (job->u[d] + place - step);
            sum[j][d] = (up - ref[d]) + (down - ref[d]);
            apart[j][d] = up - down;
        }
    }
}

/* Sums the folded rows by column x of the stencil: P for points to the left, Q to the right (x, y
 * components), N. */
INLINE void fold_column (const pg_fold *fold, int x, const int rows, const vec (*sum)[2],
                         const vec (*apart)[2], vec *right, vec *left)
{
    const double *a = fold->pull + 3 * (size_t) x * PG_FOLD_ROWS;
    vec even[2] = { ALL (a[0]) * sum[0][0], { 0 } }, odd[2] = { { 0 }, { 0 } };
    UNROLL for (int j = 1; j <= rows; j++) {
        const vec xx = ALL (a[3 * j]), xy = ALL (a[3 * j + 1]), yy = ALL (a[3 * j + 2]);
        even[0] = vec_fuse (xx, sum[j][0], even[0]), even[1] = vec_fuse (yy, sum[j][1], even[1]);
        odd[0] = vec_fuse (xy, apart[j][1], odd[0]), odd[1] = vec_fuse (xy, apart[j][0], odd[1]);
    }
    UNROLL for (int d = 0; d < 2; d++) right[d] = even[d] + odd[d], left[d] = even[d] - odd[d];
}

enum { FOLD_WIDTH = PG_FOLD_BLOCKS * PG_BLOCK + 2 * PG_FOLD_HALO };
typedef double fold_line[FOLD_WIDTH];

/* Forces of `count` consecutive blocks of a row with all bonds intact, from block k on. The lines begin
 * PG_FOLD_HALO places before the first block; line[x][0, 1]: P, line[x][2, 3]: Q of column x, components x
 * and y. reach: columns and rows, a constant for the compiler, so that rows stay in registers; constants of
 * rows and columns beyond the stencil are 0. */
INLINE void fold_blocks (const pg_block_job *job, size_t k, size_t count, const double *ref, const int reach)
{
    const pg_fold *fold_ = job->fold;
    const size_t base = job->block[k].base, width = count * PG_BLOCK;
    const vec from[2] = { ALL (ref[0]), ALL (ref[1]) };
    fold_line line[PG_FOLD_HALO + 1][4] __attribute__ ((aligned (64)));
    double out[2 * PG_BLOCK] __attribute__ ((aligned (64)));
    for (size_t at = 0; at < width + 2 * PG_FOLD_HALO; at += LANES) {
        vec sum[PG_FOLD_ROWS][2], apart[PG_FOLD_ROWS][2], right[2], left[2];
        const double *own = fold_->pull;
        fold_rows (job, base + at - PG_FOLD_HALO, reach, from, sum, apart);
        right[1] = (vec) { 0 };                        /* column 0 has x = 0: only a y^2 is not 0 */
        UNROLL for (int j = 1; j <= reach; j++)
            right[1] = vec_fuse (ALL (own[3 * j + 2]), sum[j][1], right[1]);
        STORE (line[0][1] + at, right[1]);
        for (int x = 1; x <= reach; x++) {
            fold_column (fold_, x, reach, (const vec (*)[2]) sum, (const vec (*)[2]) apart, right, left);
            UNROLL for (int d = 0; d < 2; d++)
                STORE (line[x][d] + at, right[d]), STORE (line[x][2 + d] + at, left[d]);
        }
    }
    for (size_t b = 0; b < count; b++) {
        for (size_t v = 0; v < PG_BLOCK; v += LANES) {
            const size_t at = PG_FOLD_HALO + b * PG_BLOCK + v, place = base + b * PG_BLOCK + v;
            UNROLL for (int d = 0; d < 2; d++) {
                vec f = ALL (fold_->own[d]) * (from[d] - LOAD (job->u[d] + place));
                if (d == 1) f = f + LOAD (line[0][1] + at);
                UNROLL for (int x = 1; x <= reach; x++)
                    f = f + (LOAD (line[x][d] + at + x) + LOAD (line[x][2 + d] + at - x));
                STORE (out + (size_t) d * PG_BLOCK + v, f);
            }
        }
        gather (job, job->block + k + b, 2, out);
    }
}

#define FOLD(R) \
    static TARGET void fold_##R (const pg_block_job *job, size_t k, size_t count, const double *ref) \
    { \
        fold_blocks (job, k, count, ref, R); \
    }
FOLD (1) FOLD (2) FOLD (3) FOLD (4) FOLD (5) FOLD (6) FOLD (7) FOLD (8)

/* Returns the largest stretch, at least 0, of those bonds of block k that may break; all its bonds are
 * intact. */
static TARGET double most_stretch (const pg_block_job *job, size_t k)
{
    const size_t base = job->block[k].base;
    const uint32_t *may = job->may ? job->may + k * job->n : NULL;
    vec top = { 0 };
    for (size_t at = 0; at < PG_BLOCK; at += LANES) {
        const double *u = job->u[0] + base + at, *v = job->u[1] + base + at;
        const vec x = LOAD (u), y = LOAD (v);
        for (size_t j = 0; j < job->n; j++) {
            const double *slope = job->fold->slope + 2 * j;
            const ptrdiff_t jump = job->jump[j];
            vec s = ALL (slope[0]) * (LOAD (u + jump) - x);
            s = vec_fuse (ALL (slope[1]), LOAD (v + jump) - y, s);
            if (may) vec_keep (s, may[j] >> at);
            top = vec_most (s, top);
        }
    }
    return vec_highest (top);
}

/* Copies u to job->u as `spread` does, and measures the least and largest change of each component over each
 * block since the last call, m (fold->low, fold->high: blocks x 2). */
static TARGET void spread_and_measure (const pg_block_job *job, const double *u, size_t first, size_t last)
{
    for (size_t k = first; k < last; k++) {
        const pg_block *b = job->block + k;
        double low[2] = { INFINITY, INFINITY }, high[2] = { -INFINITY, -INFINITY };
        if (b->present == UINT32_MAX && b->first >= 0) {
            const double *from = u + (size_t) b->first * 2;
            vec least[2] = { ALL (INFINITY), ALL (INFINITY) }, most[2] = { ALL (-INFINITY), ALL (-INFINITY) };
            UNROLL for (int v = 0; v < PG_BLOCK; v += LANES) {
                vec now[2];
                unzip (from + 2 * v, &now[0], &now[1]);
                UNROLL for (int d = 0; d < 2; d++) {
                    double *to = job->u[d] + b->base + v;
                    const vec moved = now[d] - LOAD (to);
                    least[d] = vec_least (moved, least[d]), most[d] = vec_most (moved, most[d]);
                    STORE (to, now[d]);
                }
            }
            UNROLL for (int d = 0; d < 2; d++)
                low[d] = vec_lowest (least[d]), high[d] = vec_highest (most[d]);
        }
        else
            for (uint32_t left = b->present; left; left &= left - 1) {
                size_t l = (size_t) __builtin_ctz (left), i = (size_t) job->point[b->site + l] * 2;
                for (int d = 0; d < 2; d++) {
                    double *to = &job->u[d][b->base + l], moved = u[i + (size_t) d] - *to;
                    low[d] = moved < low[d] ? moved : low[d], high[d] = moved > high[d] ? moved : high[d];
                    *to = u[i + (size_t) d];
                }
            }
        for (int d = 0; d < 2; d++) job->fold->low[2 * k + (size_t) d] = low[d],
                                    job->fold->high[2 * k + (size_t) d] = high[d];
    }
}
