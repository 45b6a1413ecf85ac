/* SPDX-License-Identifier: GPL-3.0-or-later
 * One evaluation of the forces by fast Fourier transforms against the stencil, on one thread: milliseconds, the share of the transforms with their
 * product in it, the difference of the forces; first the sizes of the aims, then over the horizon m (in spacings) to see where the two cross.
 * `whole`: nothing can break; `check`: a limit that none reaches is watched; `cut`: a crack through half of the body. Least of several repetitions
 * of the thread's own time. Arguments: aims, cross (none: both). */
#include "perigal/sums.h"
#include "sums/fft_rows.h"
#include "sums/sweep.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

typedef struct { const char *name; int dim, count[3]; double m; } shape;
static const shape aims[] = {
    { "square_400", 2, { 400, 400, 1 }, 3.015 }, { "square_1000", 2, { 1000, 1000, 1 }, 3.015 }, { "cube_128", 3, { 128, 128, 128 }, 2.015 },
};
static const double squares[] = { 2.015, 3.015, 4.015, 5.015, 6.015, 7.015, 8.015, 10.015, 12.015, 16.015, 20.015 }, cubes[] = { 2.015, 3.015, 4.015, 5.015, 6.015 };
typedef struct {
    pg_cloud cloud;
    pg_sums *sums;
    pg_family family;
    double *modulus, *limit, *u, *f, *plain;
    unsigned char *alive;
} bench;

static double seconds (void)
{
    struct timespec t;
    clock_gettime (CLOCK_THREAD_CPUTIME_ID, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static void clear (bench *b)
{
    void *all[] = { b->cloud.x, b->cloud.volume, b->modulus, b->limit, b->u, b->f, b->plain, b->alive };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
    pg_family_clear (&b->family);
    pg_sums_free (&b->sums);
}

static pg_status build (bench *b, const shape *s)
{
    pg_status status = PG_OK;
    pg_cloud *c = &b->cloud;
    size_t dim = (size_t) s->dim, n = (size_t) s->count[0] * (size_t) s->count[1] * (size_t) s->count[2];
    double h = 1e-3;
    memset (b, 0, sizeof *b);
    c->dim = s->dim, c->n = n, c->h = h, c->thickness = 1;
    PG_ALLOC (c->x, n * dim);
    PG_ALLOC (c->volume, n);
    PG_ALLOC (b->modulus, n);
    PG_ALLOC (b->limit, n);
    PG_ALLOC (b->u, n * dim);
    PG_ALLOC (b->f, n * dim);
    PG_ALLOC (b->plain, n * dim);
    for (size_t i = 0; i < n; i++) {
        size_t nx = (size_t) s->count[0], ny = (size_t) s->count[1], at[3] = { i % nx, i / nx % ny, i / nx / ny };
        c->volume[i] = pow (h, s->dim);
        for (size_t d = 0; d < dim; d++) c->x[i*dim + d] = ((double) at[d] + 0.5) * h, c->high[d] = h * s->count[d];
        for (size_t d = 0; d < dim; d++)
            b->u[i*dim + d] = 1e-3 * h * sin (0.05 * (double) at[0] + 0.07 * (double) at[1] + 0.03 * (double) at[2] + (double) d);
    }
    pg_lattice lattice = { .dim = s->dim, .step = { h, h, h } };
    pg_sum_rule rule = { .mode = s->dim == 2 ? PG_PLANE_STRESS : PG_SOLID, .kernel = pg_kernel_find ("constant"), .horizon = s->m * h,
                         .partial = PG_PARTIAL_OVERLAP, .calibrate = 1 };
    PG_TRY (pg_sums_create (&b->sums, &rule, c, &lattice));
    PG_TRY (pg_sums_family (&b->family, b->sums));
    PG_ALLOC (b->alive, b->family.start[n]);
    memset (b->alive, 1, b->family.start[n]);
    for (size_t i = 0; i < n; i++) {
        b->modulus[i] = b->sums->calibration * pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 72e9, 1);
        b->limit[i] = 0.04;
    }
done:
    return status;
}

/* Kills the bonds across the middle height as far as half way. */
static void cut (bench *b)
{
    size_t dim = (size_t) b->cloud.dim;
    double y = 0.5 * b->cloud.high[1], half = 0.5 * b->cloud.high[0];
    for (size_t i = 0; i < b->cloud.n; i++)
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++) {
            const double *p = b->cloud.x + i*dim, *q = b->cloud.x + (size_t) b->family.node[e] * dim;
            if ((p[1] < y) != (q[1] < y) && p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) < half) b->alive[e] = 0;
        }
}

typedef struct { double ms, off; char name[32]; pg_sweep_counts count; } result;

static pg_status time_sweep (result *out, bench *b, pg_evaluation evaluation, int check)
{
    pg_status status = PG_OK;
    pg_sweep *sweep = NULL;
    pg_changes broken = { 0 };
    pg_sweep_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus, .limit = b->limit, .threads = 1 };
    b->sums->rule.evaluation = evaluation, b->sums->rule.sweeps = 1e5;
    PG_TRY (pg_sweep_create (&sweep, &setting));
    pg_sweep_update (sweep, b->alive, NULL);
    double best = INFINITY, start = seconds (), most = 0, off = 0;
    for (int repeat = 0; repeat < 7 || (repeat < 1000 && seconds () - start < 0.3); repeat++) {
        double t = seconds ();
        PG_TRY (pg_sweep_force (sweep, b->u, b->f, check ? &broken : NULL));
        best = fmin (best, seconds () - t);
    }
    if (broken.n) PG_FAIL (PG_E_EQUILIBRIUM, "%zu bonds broke", broken.n);
    for (size_t i = 0; i < b->cloud.n * (size_t) b->cloud.dim; i++) most = fmax (most, fabs (b->plain[i])), off = fmax (off, fabs (b->f[i] - b->plain[i]));
    out->ms = 1e3 * best, out->off = off / most;
    snprintf (out->name, sizeof out->name, "%s", pg_sweep_name (sweep));
    pg_sweep_counted (sweep, &out->count);
done:
    pg_free (broken.bond);
    pg_sweep_free (&sweep);
    return status;
}

static void fill (void *context, size_t row, int field, double *x) { (void) row, (void) field; x[0] = *(double *) context; }
static void take (void *context, size_t row, double *const *x, double *spare) { (void) row, (void) spare; *(double *) context = x[0][0]; }
static double one (const void *context, int pair, size_t entry) { (void) context, (void) pair, (void) entry; return 1; }

static const fft_kernels *best_kernels (void)
{
    return pg_instructions_here (PG_AVX512) ? &pg_fft_avx512 : pg_instructions_here (PG_AVX2) ? &pg_fft_avx2 : &pg_fft_scalar;
}

/* Transforms of the box and their product with the kernels alone */
static pg_status time_transforms (double *ms, fft *f, const bench *b)
{
    pg_status status = PG_OK;
    const pg_sites *sites = &b->sums->sites;
    size_t n[3] = { (size_t) sites->count[0], (size_t) sites->count[1], (size_t) sites->count[2] };
    double x = 0;
    fft_job job = { b->cloud.dim, b->cloud.dim, fill, take, &x };
    PG_TRY (fft_create (f, b->cloud.dim, n, b->sums->stencil.n, b->sums->stencil.offset, one, NULL, best_kernels (), 1, 1));
    double start = seconds ();
    *ms = INFINITY;
    for (int repeat = 0; repeat < 7 || (repeat < 1000 && seconds () - start < 0.3); repeat++) {
        double t = seconds ();
        fft_convolve (f, &job);
        *ms = fmin (*ms, 1e3 * (seconds () - t));
    }
done:
    return status;
}

static pg_status rows_of (const shape *s, const char *group)
{
    static const char *const kinds[] = { "whole", "check", "cut" };
    pg_status status = PG_OK;
    bench b;
    fft f = { 0 };
    double alone = 0;
    PG_TRY (build (&b, s));
    PG_TRY (time_transforms (&alone, &f, &b));
    for (int k = 0; k < 3; k++) {
        result direct, fast;
        if (k == 2) cut (&b);
        memset (b.plain, 0, b.cloud.n * (size_t) s->dim * sizeof *b.plain);
        PG_TRY (time_sweep (&direct, &b, PG_EVALUATE_STENCIL, k == 1));
        memcpy (b.plain, b.f, b.cloud.n * (size_t) s->dim * sizeof *b.plain);
        PG_TRY (time_sweep (&fast, &b, PG_EVALUATE_FFT, k == 1));
        printf ("%s,%s,%zu,%.4g,%zu,%s,%s,%.4f,%s,%.4f,%.4f,%zux%zux%zu,%.1f,%.1f,%.3g,%.3g\n", group, s->name, b.cloud.n, s->m, b.sums->stencil.n, kinds[k],
                direct.name, direct.ms, fast.name, fast.ms, alone, f.box.T[0], f.box.T[1], f.box.T[2],
                (double) fast.count.forward / (double) fast.count.sums, (double) fast.count.back / (double) fast.count.sums,
                (double) fast.count.bonds / (double) fast.count.blocks, fast.off);
        fflush (stdout);
    }
done:
    fft_clear (&f);
    clear (&b);
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    int want_aims = argc < 2, want_cross = argc < 2;
    for (int a = 1; a < argc; a++) want_aims |= !strcmp (argv[a], "aims"), want_cross |= !strcmp (argv[a], "cross");
    printf ("group,body,points,m,bonds,kind,direct,direct_ms,fft,fft_ms,transforms_ms,places,forward,back,blocks_direct,difference\n");
    for (size_t k = 0; want_aims && k < sizeof aims / sizeof *aims; k++) PG_TRY (rows_of (&aims[k], "aims"));
    for (size_t k = 0; want_cross && k < sizeof squares / sizeof *squares; k++)
        PG_TRY (rows_of (&(shape) { "square_256", 2, { 256, 256, 1 }, squares[k] }, "cross"));
    for (size_t k = 0; want_cross && k < sizeof cubes / sizeof *cubes; k++)
        PG_TRY (rows_of (&(shape) { "cube_48", 3, { 48, 48, 48 }, cubes[k] }, "cross"));
done:
    if (status != PG_OK) fprintf (stderr, "fcbm_step: %s\n", pg_last_error ());
    return status != PG_OK;
}
