/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft_rows.h: loops over rows and columns between transforms, compiled for each instruction set (private). */
#ifndef PERIGAL_SUMS_FFT_ROWS_H
#define PERIGAL_SUMS_FFT_ROWS_H
#include "block.h"
#include "fft.h"

typedef struct {                                       /* a row of sites */
    const double *u[3], *chi;                          /* padded, from its first site on, for whole blocks */
    const double *q[3], *D[6];
    double shift[3], from[3], by[3];  /* motion subtracted at site k, m: shift + (from + by k) */
    size_t blocks;                                     /* number of blocks of the row */
    const int *block_at;                               /* number of each block; -1: it has no points */
    const unsigned char *skip;                         /* 1: the block is summed bond by bond */
} fft_row;
struct fft_kernels {
    /* x = (u - subtracted motion) chi, n rounded up to a multiple of 8 */
    void (*still) (size_t n, const double *u, double shift, double from, double by, const double *chi,
                   double *x);
    /* [dim - 1]: job->f = chi (q - D (u - motion)) */
    void (*force[3]) (const pg_block_job *job, const fft_row *row);
    /* z = K z for FFT_WIDE columns of `places` places; sign[1]: sign of the kernel's mirror image, by pair */
    void (*product[3]) (size_t places, const double *const *K, const double (*sign)[6], double *const *z);
    /* Smallest and largest u[k + jump] - u[k] over the sites whose bits are set of a block in each of some
     * rows, `pitch` apart; infinite: none */
    void (*range) (const double *u, size_t pitch, size_t rows, ptrdiff_t jump, const uint32_t *sites,
                   double *low, double *high);
};
extern const fft_kernels pg_fft_scalar, pg_fft_avx2, pg_fft_avx512;
#endif
