/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft_rows.h: what is done to rows and columns between transforms, compiled for each instruction set
 * (private). */
#ifndef PERIGAL_SUMS_FFT_ROWS_H
#define PERIGAL_SUMS_FFT_ROWS_H
#include "block.h"
#include "fft.h"

typedef struct {                                       /* a row of sites */
    const double *u[3], *chi;                          /* at its first site, blocks full */
    const double *q[3], *D[6];
    double shift[3], from[3], by[3];  /* motion of site k that is taken off: shift + (from + by k) */
    size_t blocks;
    const int *block_at;                               /* -1: without points */
    const unsigned char *skip;                         /* blocks that are summed otherwise */
} fft_row;
struct fft_kernels {
    /* x = (u - motion) chi, n up to a multiple of 8 */
    void (*still) (size_t n, const double *u, double shift, double from, double by, const double *chi,
                   double *x);
    /* [dim - 1]: job->f = chi (q - D (u - motion)) */
    void (*force[3]) (const pg_block_job *job, const fft_row *row);
    /* Columns of `places` places: z = K z. sign[1]: of the kernel's mirror image */
    void (*product[3]) (size_t places, const double *const *K, const double (*sign)[6], double *const *z);
    /* Smallest and largest u[k + jump] - u[k] over the sites whose bits are set of a block in each of some
     * rows, `pitch` apart; infinite: none */
    void (*range) (const double *u, size_t pitch, size_t rows, ptrdiff_t jump, const uint32_t *sites,
                   double *low, double *high);
};
extern const fft_kernels pg_fft_scalar, pg_fft_avx2, pg_fft_avx512;
#endif
