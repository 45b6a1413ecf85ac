/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft_kernel.h: loops over rows and columns between transforms, with the vectors of block_kernel.h (private,
 * no include guard: included after it, once per instruction set, FFT_NAME being the name of the table). No
 * product is fused with a sum: all sets give the same bits. */
#include "fft_rows.h"
#include <math.h>

/* x[k] = (u[k] - shift - (from + by k)) chi[k] of a row of n places, n rounded up to a vector. The shift is
 * subtracted first and alone: where it is large, u - shift is exact, and the rest is small. */
static TARGET void still (size_t n, const double *u, double shift, double from, double by, const double *chi,
                          double *x)
{
    vec at, start = ALL (shift), first = ALL (from), slope = ALL (by);
    for (int l = 0; l < LANES; l++) at[l] = l;
    for (size_t k = 0; k < n; k += LANES, at = at + (double) LANES)
        STORE (x + k, ((LOAD (u + k) - start) - (first + slope * at)) * LOAD (chi + k));
}

/* f_a = chi (q_a - sum_b D_ab u_b) of the 32 sites from k on, with u less the subtracted motion. out:
 * component by component, PG_BLOCK apart, N. */
INLINE void block_force (const fft_row *r, size_t k, int dim, double *out)
{
    for (size_t v = 0; v < PG_BLOCK; v += LANES) {
        vec at, t[3];
        for (int l = 0; l < LANES; l++) at[l] = l;
        at = at + (double) (int) (k + v);
        UNROLL for (int d = 0; d < dim; d++)
            t[d] = (LOAD (r->u[d] + k + v) - ALL (r->shift[d])) - (ALL (r->from[d]) + ALL (r->by[d]) * at);
        UNROLL for (int a = 0; a < dim; a++) {
            vec sum = LOAD (r->q[a] + k + v);
            UNROLL for (int d = 0; d < dim; d++) {
                const int low = a < d ? a : d, high = a < d ? d : a,
                          pair = dim == 3 ? low * (5 - low) / 2 + high : low + high;
                sum = sum - LOAD (r->D[pair] + k + v) * t[d];
            }
            STORE (out + a * PG_BLOCK + (int) v, sum * LOAD (r->chi + k + v));
        }
    }
}

/* Forces of all blocks of a row that have points and no broken bond. */
INLINE void row_force (const pg_block_job *job, const fft_row *r, int dim)
{
    double out[3 * PG_BLOCK] __attribute__ ((aligned (64)));
    for (size_t j = 0; j < r->blocks; j++) {
        if (r->block_at[j] < 0 || r->skip[r->block_at[j]]) continue;
        block_force (r, j * PG_BLOCK, dim, out);
        gather (job, job->block + r->block_at[j], dim, out);
    }
}

static TARGET void row_force_1 (const pg_block_job *job, const fft_row *r) { row_force (job, r, 1); }
static TARGET void row_force_2 (const pg_block_job *job, const fft_row *r) { row_force (job, r, 2); }
static TARGET void row_force_3 (const pg_block_job *job, const fft_row *r) { row_force (job, r, 3); }

/* Loads the kernel of FFT_WIDE columns at one place, times `sign`, each value twice, for real and imaginary
 * part: kernels are real, fields are complex. */
INLINE void load_kernel (const double *K, double sign, vec *k)
{
    for (int v = 0; v < FFT_WIDE / LANES; v++) {
        double both[2 * LANES];
        vec one = LOAD (K + v * LANES) * ALL (sign);
        zip (both, one, one);
        k[2*v] = LOAD (both), k[2*v + 1] = LOAD (both + LANES);
    }
}

/* y_a = sum_b K_ab x_b at every place of FFT_WIDE columns. Kernels are even, so that only the first half
 * of the places is stored: place l beyond the middle takes the values of places - l, with the sign of the
 * pair's parity along this axis (sign[1]). */
INLINE void product (int dim, size_t places, const double *const *K, const double (*sign)[6],
                     double *const *z)
{
    enum { PARTS = 2 * FFT_WIDE / LANES };
    const int pairs = dim * (dim + 1) / 2;
    for (size_t l = 0; l < places; l++) {
        const int far = l >= places / 2 + 1;
        const size_t at = l * 2 * FFT_WIDE, from = (far ? places - l : l) * FFT_WIDE;
        vec k[6][PARTS];
        UNROLL for (int p = 0; p < pairs; p++) load_kernel (K[p] + from, sign[far][p], k[p]);
        UNROLL for (int v = 0; v < PARTS; v++) {
            vec x[3], y[3];
            UNROLL for (int d = 0; d < dim; d++) x[d] = LOAD (z[d] + at + v * LANES);
            UNROLL for (int a = 0; a < dim; a++) {
                UNROLL for (int d = 0; d < dim; d++) {
                    const int low = a < d ? a : d, high = a < d ? d : a,
                              pair = dim == 3 ? low * (5 - low) / 2 + high : low + high;
                    y[a] = d == 0 ? k[pair][v] * x[d] : y[a] + k[pair][v] * x[d];
                }
            }
            UNROLL for (int a = 0; a < dim; a++) STORE (z[a] + at + v * LANES, y[a]);
        }
    }
}

static TARGET void product_1 (size_t places, const double *const *K, const double (*sign)[6],
                              double *const *z)
{
    product (1, places, K, sign, z);
}
static TARGET void product_2 (size_t places, const double *const *K, const double (*sign)[6],
                              double *const *z)
{
    product (2, places, K, sign, z);
}
static TARGET void product_3 (size_t places, const double *const *K, const double (*sign)[6],
                              double *const *z)
{
    product (3, places, K, sign, z);
}

/* Smallest and largest change of u over `jump` places within some rows of a block; sites: which of the 32
 * sites of each row have a point at both ends. */
static TARGET void range (const double *u, size_t pitch, size_t rows, ptrdiff_t jump, const uint32_t *sites,
                          double *low, double *high)
{
    vec least = ALL (INFINITY), most = ALL (-INFINITY);
    for (size_t r = 0; r < rows; r++, u += pitch) {
        if (sites[r] == UINT32_MAX) {
            UNROLL for (int k = 0; k < PG_BLOCK; k += LANES) {
                vec d = LOAD (u + k + jump) - LOAD (u + k);
                least = vec_least (d, least), most = vec_most (d, most);
            }
            continue;
        }
        for (uint32_t left = sites[r]; left; left &= left - 1) {
            int k = __builtin_ctz (left);
            double d = u[k + jump] - u[k];
            if (d < least[0]) least[0] = d;
            if (d > most[0]) most[0] = d;
        }
    }
    *low = least[0], *high = most[0];
    for (int l = 1; l < LANES; l++) {
        if (least[l] < *low) *low = least[l];
        if (most[l] > *high) *high = most[l];
    }
}

const fft_kernels FFT_NAME = {
    still, { row_force_1, row_force_2, row_force_3 }, { product_1, product_2, product_3 }, range
};
