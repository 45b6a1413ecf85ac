/* SPDX-License-Identifier: GPL-3.0-or-later
 * Convolutions with even kernels: forward transforms of rows (3D: and of the columns of their plane);
 * forward transforms of the columns along the last axis, product with the kernel, backward transforms; rows
 * backward. */
#include "fft_rows.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { BATCH = 2 * FFT_WIDE };                         /* doubles of a place in a batch of columns */
/* Returns the first address from x on that is a multiple of 64 bytes. */
static double *level (double *x) { return (double *) (((uintptr_t) x + 63) / 64 * 64); }
/* Number of the pair of axes a <= b: xx | xx xy yy | xx xy xz yy yz zz. */
static int pair_of (int dim, int a, int b) { return dim == 3 ? a * (5 - a) / 2 + b : dim == 2 ? a + b : 0; }

/* ---- columns ------------------------------------------------------------------------------------------- */
/* Copies n places of a batch of columns, `stride` doubles apart, to the workspace, and zeros for places n to
 * T - 1. */
static void gather (double *restrict workspace, const double *restrict from, size_t n, size_t stride,
                    size_t T)
{
    for (size_t k = 0; k < n; k++)
        memcpy (workspace + k * BATCH, from + k * stride, BATCH * sizeof *workspace);
    if (T > n) memset (workspace + n * BATCH, 0, (T - n) * BATCH * sizeof *workspace);
}

/* Copies the first n places of the workspace back to a batch of columns, `stride` doubles apart. */
static void scatter (double *restrict to, const double *restrict workspace, size_t n, size_t stride)
{
    for (size_t k = 0; k < n; k++) memcpy (to + k * stride, workspace + k * BATCH, BATCH * sizeof *workspace);
}

/* Transforms x in place; along an axis of one place there is no plan, and nothing to do. */
static void transform (fftw_plan plan, double *x)
{
    if (plan) fftw_execute_dft (plan, (fftw_complex *) x, (fftw_complex *) x);
}

/* Transforms the columns of a plane along the middle axis (3D only), in place. Forward only the n[1] filled
 * rows are read, backward only these are written. */
static void middle_columns (const fft *f, double *plane, int back, double *workspace)
{
    const fft_box *b = &f->box;
    if (b->T[1] == 1) return;
    size_t from = back ? b->T[1] : b->n[1], to = back ? b->n[1] : b->T[1], stride = 2 * b->C;
    for (size_t c = 0; c < b->C; c += FFT_WIDE) {
        gather (workspace, plane + 2*c, from, stride, b->T[1]);
        transform (b->middle[back], workspace);
        scatter (plane + 2*c, workspace, to, stride);
    }
}

/* At one place of FFT_WIDE columns: z_0 = sum over pairs a <= b of K_ab z_ab, pairs of two axes counted
 * twice. sign: of the kernel of each pair, which may be a mirror image. */
static inline void contract (int dim, const double *const *K, const double *sign, double *const *z, size_t at,
                             size_t k)
{
    double sum[BATCH] = { 0 };
    for (int a = 0; a < dim; a++)
        for (int b = a; b < dim; b++) {
            int p = pair_of (dim, a, b);
            double times = (a == b ? 1 : 2) * sign[p];
            for (size_t w = 0; w < FFT_WIDE; w++) {
                double s = times * K[p][k + w];
                sum[2*w] += s * z[p][at + 2*w], sum[2*w + 1] += s * z[p][at + 2*w + 1];
            }
        }
    memcpy (z[0] + at, sum, sizeof sum);
}

/* ---- passes -------------------------------------------------------------------------------------------- */
typedef struct { fft *f; const fft_job *job; } pass;

/* Returns the workspace of a thread. */
static double *room_of (const fft *f, int thread)
{
    return level (f->workspaces) + (size_t) thread * f->workspace;
}

/* Forward transforms of the planes first .. last - 1: rows are filled by the job and transformed real to
 * complex, then the columns within the plane. Places beyond the sites are zero: the padding that keeps bonds
 * from wrapping around. */
static void forward_slabs (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const fft_box *b = &p->f->box;
    double *x = room_of (p->f, thread);
    for (size_t l = first; l < last; l++)
        for (int a = 0; a < p->job->in; a++) {
            double *plane = p->f->field[a] + l * b->T[1] * b->C * 2;
            for (size_t m = 0; m < b->n[1]; m++) {
                /* FFTW's r2c keeps its input: zeros once per plane suffice */
                if (m == 0) memset (x + b->n[0], 0, (b->T[0] - b->n[0]) * sizeof *x);
                p->job->fill (p->job->context, l * b->n[1] + m, a, x);
                fftw_execute_dft_r2c (b->row[0], x, (fftw_complex *) (plane + m * b->C * 2));
            }
            middle_columns (p->f, plane, 0, x);
        }
}

/* Convolves batches of FFT_WIDE columns along the last axis, first .. last - 1: gathered into the workspace,
 * transformed, multiplied by the kernels, transformed back and written in place. A column with m beyond the
 * middle has the kernel of its mirror image, with a change of sign if it is odd. */
static void columns (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    fft *f = p->f;
    const fft_box *b = &f->box;
    const size_t plane = b->T[1] * b->C * 2, half = b->T[2] / 2 + 1;
    double *z[FFT_MOST], sign[2][6];
    const double *K[6];
    for (int a = 0; a < p->job->in; a++) z[a] = room_of (f, thread) + (size_t) a * b->T[2] * BATCH;
    for (size_t task = first; task < last; task++) {
        size_t m = task % b->T[1], c = task / b->T[1], mirror = b->T[1] - m;
        int turned = m > mirror;
        const double *kernel = f->kernel
                               + (c * (b->T[1] / 2 + 1) + (turned ? mirror : m)) * (size_t) f->pairs * half
                                     * FFT_WIDE;
        for (int i = 0; i < f->pairs; i++) K[i] = kernel + (size_t) i * half * FFT_WIDE;
        for (int i = 0; i < b->dim; i++)
            for (int j = i; j < b->dim; j++) {         /* odd along an axis that is i or j, not both */
                int k = pair_of (b->dim, i, j);
                sign[0][k] = turned && b->dim == 3 && (i == 1) != (j == 1) ? -1 : 1;
                sign[1][k] = i < j && j == b->dim - 1 ? -sign[0][k] : sign[0][k];
            }
        for (int a = 0; a < p->job->in; a++) {
            gather (z[a], f->field[a] + m * b->C * 2 + c * BATCH, b->n[2], plane, b->T[2]);
            transform (b->last[0], z[a]);
        }
        if (p->job->out == b->dim) f->kernels->product[b->dim - 1] (b->T[2], K, sign, z);
        else
            for (size_t l = 0; l < b->T[2]; l++)
                contract (b->dim, K, sign[l >= half], z, l * BATCH, (l >= half ? b->T[2] - l : l) * FFT_WIDE);
        for (int a = 0; a < p->job->out; a++) {
            transform (b->last[1], z[a]);
            scatter (f->field[a] + m * b->C * 2 + c * BATCH, z[a], b->n[2], plane);
        }
    }
}

/* Backward transforms of the planes first .. last - 1: columns within the planes, then rows; `take` gets all
 * fields of a row together, so that no result is stored. */
static void backward_slabs (void *context, size_t first, size_t last, int thread)
{
    const pass *p = context;
    const fft_box *b = &p->f->box;
    size_t length = (b->T[0] + 7) / 8 * 8;
    double *workspace = room_of (p->f, thread), *x[3];
    for (int a = 0; a < 3; a++) x[a] = workspace + (size_t) a * length;
    for (size_t l = first; l < last; l++) {
        for (int a = 0; a < p->job->out; a++)
            middle_columns (p->f, p->f->field[a] + l * b->T[1] * b->C * 2, 1, workspace);
        for (size_t m = 0; m < b->n[1]; m++) {
            for (int a = 0; a < p->job->out; a++)
                fftw_execute_dft_c2r (b->row[1],
                                      (fftw_complex *) (p->f->field[a] + (l * b->T[1] + m) * b->C * 2), x[a]);
            p->job->take (p->job->context, l * b->n[1] + m, x, workspace + 3 * length);
        }
    }
}

/* Runs three passes, each of independent tasks that one thread does as a whole: the same bits for any number
 * of threads. */
void pg_fft_convolve (fft *f, const fft_job *job)
{
    pass p = { f, job };
    pg_parallel_heavy (f->threads, f->box.n[2], forward_slabs, &p);
    pg_parallel_heavy (f->threads, f->box.C / FFT_WIDE * f->box.T[1], columns, &p);
    pg_parallel_heavy (f->threads, f->box.n[2], backward_slabs, &p);
    f->forward += job->in, f->back += job->out;
}

/* ---- creation ------------------------------------------------------------------------------------------ */
/* Transforms one kernel, by a plain transform of a whole box [T2][T1][T0]. A kernel is real and even along
 * every axis, or odd along the two axes of its pair, so that its transform is real and has the same symmetry:
 * a quarter of the box is kept, divided by the number of places. */
static pg_status make_kernel (fft *f, int pair, size_t n, const int *offset,
                              double (*value) (const void *, int, size_t), const void *context, double *box)
{
    pg_status status = PG_OK;
    const fft_box *b = &f->box;
    size_t half = b->T[2] / 2 + 1, middle = b->T[1] / 2 + 1, C = b->T[0] / 2 + 1, pitch = 2 * C,
           all = b->T[0] * b->T[1] * b->T[2];
    int T[3] = { (int) b->T[2], (int) b->T[1], (int) b->T[0] };
    memset (box, 0, pitch * b->T[1] * b->T[2] * sizeof *box);
    for (size_t e = 0; e < n; e++) {
        const int *o = offset + 3*e;
        size_t at[3];
        for (int k = 0; k < 3; k++) {
            int go = k == 0 ? o[0] : b->dim == 3 ? o[k] : k == 2 ? o[1] : 0;
            at[k] = (size_t) (go + T[2 - k]) % (size_t) T[2 - k];
        }
        box[(at[2] * b->T[1] + at[1]) * pitch + at[0]] = value (context, pair, e) / (double) all;
    }
    fftw_plan plan = pg_fft_plan_box (T, box);
    if (!plan) PG_FAIL (PG_E_MEMORY, "no memory for the transform of a kernel");
    fftw_execute (plan);
    pg_fft_plan_free (plan);
    for (size_t c = 0; c < C; c++)
        for (size_t m = 0; m < middle; m++)
            for (size_t l = 0; l < half; l++)
                f->kernel[((((c / FFT_WIDE) * middle + m) * (size_t) f->pairs + (size_t) pair) * half + l)
                              * FFT_WIDE
                          + c % FFT_WIDE] = box[(l * b->T[1] + m) * pitch + 2 * c];
done:
    return status;
}

/* Makes box, plans and transforms of all kernels for bonds `offset` (n x 3, lattice steps). Along each axis
 * the padded box is longer than the lattice by the reach of the bonds. */
pg_status pg_fft_create (fft *out, int dim, const size_t *sites, size_t n, const int *offset,
                      double (*value) (const void *context, int pair, size_t entry), const void *context,
                      const fft_kernels *kernels, int threads, int measure)
{
    pg_status status = PG_OK;
    fft *f = out;
    double *box = NULL;
    size_t reach[3] = { 0, 0, 0 };
    *f = (fft) { .kernels = kernels, .pairs = dim * (dim + 1) / 2, .threads = threads < 1 ? 1 : threads };
    for (size_t e = 0; e < n; e++)
        for (int k = 0; k < dim; k++)
            if (offset[3 * e + (size_t) k] > (int) reach[k]) reach[k] = (size_t) offset[3 * e + (size_t) k];
    PG_TRY (pg_fft_box_create (&f->box, dim, sites, reach, measure));
    const fft_box *b = &f->box;
    size_t row = (b->T[0] + 7) / 8 * 8, most = (size_t) f->pairs * b->T[2] * BATCH;
    if (most < 8 * row) most = 8 * row;
    if (most < b->T[1] * BATCH) most = b->T[1] * BATCH;
    f->workspace = (most + 7) / 8 * 8 + 64;
    PG_ALLOC (f->workspaces, (size_t) f->threads * f->workspace + 8);
    PG_ALLOC (f->kernel, b->C * (b->T[1] / 2 + 1) * (b->T[2] / 2 + 1) * (size_t) f->pairs);
    PG_ALLOC (box, (b->T[0] + 2) * b->T[1] * b->T[2]);
    for (int p = 0; p < f->pairs; p++) PG_TRY (make_kernel (f, p, n, offset, value, context, box));
    PG_TRY (pg_fft_fields (f, dim));
done:
    pg_free (box);
    return status;
}

/* Makes fields as parts of one block of memory, each aligned to 64 bytes; asking for more fields frees the
 * former ones, whose content is lost. */
pg_status pg_fft_fields (fft *f, int fields)
{
    pg_status status = PG_OK;
    size_t each = 2 * f->box.C * f->box.T[1] * f->box.n[2] + 8;
    double *block = NULL;
    if (f->field[fields - 1]) return PG_OK;
    PG_ALLOC (block, each * (size_t) fields + 8);
    pg_free (f->block);
    f->block = block;
    for (int a = 0; a < fields; a++) f->field[a] = level (block) + each / 8 * 8 * (size_t) a;
done:
    return status;
}

/* Frees all of f, which may be all zeros. */
void pg_fft_clear (fft *f)
{
    pg_fft_box_clear (&f->box);
    pg_free (f->workspaces), pg_free (f->kernel), pg_free (f->block);
    memset (f, 0, sizeof *f);
}
