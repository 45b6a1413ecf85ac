/* SPDX-License-Identifier: GPL-3.0-or-later
 * fft.h: cyclic convolutions of fields on a padded box of sites (private; FFTW3). Entries of the padded box
 * are called places. A row is transformed real to complex; columns along the middle axis (3D) and the last
 * one in batches of FFT_WIDE, which are gathered into a buffer in the cache, so that rows of zeros are never
 * stored and the product with the kernels needs no pass of its own. Batches, and so bits, do not depend on
 * the number of threads. */
#ifndef PERIGAL_SUMS_FFT_H
#define PERIGAL_SUMS_FFT_H
#include "perigal/base.h"
#include <fftw3.h>

enum { FFT_WIDE = 8, FFT_MOST = 6 };                   /* columns side by side; fields at once */
typedef struct {
    int    dim;
    size_t n[3], T[3];  /* sites, places: along x, the middle axis (1 unless 3D), the last (1 in 1D) */
    size_t C;  /* complex places of a row: T[0] / 2 + 1, rounded up to FFT_WIDE */
    int    measured;                                   /* 1: plans were timed, now or in an earlier run */
    fftw_plan row[2], middle[2], last[2];              /* forward, back; NULL along an axis of one place */
} fft_box;

/* Makes plans for n sites along x, y, z (1 beyond dim) in at least n + reach places. measure: 1: plans are
 * timed, unless a file has them from before. */
pg_status pg_fft_box_create (fft_box *out, int dim, const size_t *n, const size_t *reach, int measure);
void      pg_fft_box_clear  (fft_box *box);
/* Returns the size 2^a 3^b 5^c 7^d >= least (even: an even one) that is transformed fastest. */
size_t    pg_fft_size       (size_t least, int even);
/* Plans one forward transform (back: backward) in place of a box [T0][T1][T2] with rows of T2 + 2; NULL: no
 * memory. */
fftw_plan pg_fft_plan_box   (const int *T, double *x);
fftw_plan pg_fft_plan_box_back (const int *T, double *x);
void      pg_fft_plan_free  (fftw_plan plan);

/* Loops compiled for an instruction set (fft_rows.h). */
typedef struct fft_kernels fft_kernels;
/* Convolutions with the real even kernels of all pairs of axes: xx | xx xy yy | xx xy xz yy yz zz. */
typedef struct {
    fft_box box;
    const fft_kernels *kernels;
    int     pairs, threads;
    /* Transforms of the kernels over the number of places: [columns / FFT_WIDE][T1/2 + 1][pair][T2/2 +
     * 1][FFT_WIDE]. */
    double *kernel;
    double *block, *field[FFT_MOST];                   /* memory of the fields; each complex [n2][T1][C] */
    double *workspaces;  size_t workspace;             /* memory of all threads; doubles of one */
    long    forward, back;                             /* transforms of the box so far */
} fft;

/* Transforms the kernels. value (context, pair, entry): kernel at `entry` of the list of n offsets (n x 3).
 * */
pg_status pg_fft_create (fft *out, int dim, const size_t *sites, size_t n, const int *offset,
                      double (*value) (const void *context, int pair, size_t entry), const void *context,
                      const fft_kernels *kernels, int threads, int measure);
void      pg_fft_clear  (fft *f);
pg_status pg_fft_fields (fft *f, int fields);             /* workspace for as many fields */

typedef struct {
    int in, out;                                       /* numbers of fields read and made */
    /* Writes the n[0] values of a row of a field that is read; places behind them are 0 and must stay 0. */
    void (*fill) (void *context, size_t row, int field, double *x);
    /* Takes a row of all fields that are made; spare: workspace of dim rows. */
    void (*take) (void *context, size_t row, double *const *x, double *spare);
    void *context;
} fft_job;
/* in = out = dim: out_a = sum_b K_ab * in_b. in = pairs, out = 1: sum over pairs (those of two axes twice) of
 * K_ab * in_ab. Rows count as n[1] n[2]. */
void pg_fft_convolve (fft *f, const fft_job *job);
#endif
