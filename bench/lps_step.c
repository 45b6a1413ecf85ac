/* SPDX-License-Identifier: GPL-3.0-or-later
 * One evaluation of state-based forces on one thread: by the stencil, by lists, by fast Fourier transforms, beside those of bonds alone by the stencil; over
 * the horizon. Milliseconds of the thread's own time, least of several; difference to the stencil. Arguments: names of bodies (none: all). */
#include "perigal/sums.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

static const struct { const char *name; int dim, side; double m; } bodies[] = {
    { "square_400_3", 2, 400, 3.015 }, { "square_400_6", 2, 400, 6.015 }, { "square_400_10", 2, 400, 10.015 }, { "cube_64_2", 3, 64, 2.015 }, { "cube_64_3", 3, 64, 3.015 },
    { "cube_64_4", 3, 64, 4.015 }, { "cube_64_5", 3, 64, 5.015 },
};
typedef struct { pg_cloud cloud; pg_sums *sums; pg_family family; double *modulus, *dilation, *deviation, *u, *f, *plain; } bench;

static double seconds (void)
{
    struct timespec t;
    clock_gettime (CLOCK_THREAD_CPUTIME_ID, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static void clear (bench *b)
{
    void *all[] = { b->cloud.x, b->cloud.volume, b->modulus, b->dilation, b->deviation, b->u, b->f, b->plain };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
    pg_family_clear (&b->family);
    pg_sums_free (&b->sums);
    memset (b, 0, sizeof *b);
}

static pg_status build (bench *b, int dim_, size_t side, double m)
{
    pg_status status = PG_OK;
    pg_cloud *c = &b->cloud;
    size_t dim = (size_t) dim_, n = dim == 2 ? side * side : side * side * side;
    double h = 1e-3;
    memset (b, 0, sizeof *b);
    c->dim = dim_, c->n = n, c->h = h, c->thickness = 1;
    PG_ALLOC (c->x, n * dim);
    PG_ALLOC (c->volume, n);
    PG_ALLOC (b->modulus, n);
    PG_ALLOC (b->dilation, n);
    PG_ALLOC (b->deviation, n);
    PG_ALLOC (b->u, n * dim);
    PG_ALLOC (b->f, n * dim);
    PG_ALLOC (b->plain, n * dim);
    for (size_t i = 0; i < n; i++) {
        size_t at[3] = { i % side, i / side % side, i / side / side };
        c->volume[i] = pow (h, dim_);
        for (size_t d = 0; d < dim; d++) c->x[i*dim + d] = ((double) at[d] + 0.5) * h;
        for (size_t d = 0; d < dim; d++)
            b->u[i*dim + d] = 1e-3 * h * sin (0.05 * (double) at[0] + 0.07 * (double) at[1] + 0.03 * (double) at[2] + (double) d);
    }
    pg_lattice lattice = { .dim = dim_, .step = { h, h, h } };
    pg_sum_rule rule = { .mode = dim == 2 ? PG_PLANE_STRESS : PG_SOLID, .kernel = pg_kernel_find ("constant"), .horizon = m * h, .partial = PG_PARTIAL_OVERLAP,
                         .calibrate = 1 };
    PG_TRY (pg_sums_create (&b->sums, &rule, c, &lattice));
    PG_TRY (pg_sums_family (&b->family, b->sums));
    for (size_t i = 0; i < n; i++) {
        b->modulus[i] = b->sums->calibration * pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 72e9, 1);
        pg_state_moduli (rule.mode, 72e9, 0.2, &b->dilation[i], &b->deviation[i]);
    }
done:
    return status;
}

static pg_status time_sweep (bench *b, pg_evaluation evaluation, int state, double *ms, double *off)
{
    pg_status status = PG_OK;
    pg_sweep *sweep = NULL;
    pg_sweep_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus, .dilation = b->dilation, .deviation = b->deviation, .threads = 1 };
    b->sums->rule.evaluation = evaluation, b->sums->rule.state = state;
    PG_TRY (pg_sweep_create (&sweep, &setting));
    double start = seconds (), most = 0;
    *ms = INFINITY, *off = 0;
    for (int repeat = 0; repeat < 5 || (repeat < 1000 && seconds () - start < 0.3); repeat++) {
        double t = seconds ();
        PG_TRY (pg_sweep_force (sweep, b->u, b->f, NULL));
        *ms = fmin (*ms, 1e3 * (seconds () - t));
    }
    size_t ndof = b->cloud.n * (size_t) b->cloud.dim;
    if (evaluation == PG_EVALUATE_STENCIL) memcpy (b->plain, b->f, ndof * sizeof *b->f);
    for (size_t i = 0; i < ndof; i++) most = fmax (most, fabs (b->plain[i])), *off = fmax (*off, fabs (b->f[i] - b->plain[i]));
    *off /= most;
done:
    pg_sweep_free (&sweep);
    return status;
}

int main (int argc, char **argv)
{
    pg_status status = PG_OK;
    bench b = { .sums = NULL };
    printf ("body,points,bonds_a_point,bond_stencil_ms,stencil_ms,list_ms,fft_ms,list_off,fft_off\n");
    for (size_t k = 0; k < sizeof bodies / sizeof *bodies; k++) {
        double bond, stencil, list, fft, off[4];
        int wanted = argc == 1;
        for (int a = 1; a < argc; a++) wanted |= strcmp (argv[a], bodies[k].name) == 0;
        if (!wanted) continue;
        PG_TRY (build (&b, bodies[k].dim, (size_t) bodies[k].side, bodies[k].m));
        PG_TRY (time_sweep (&b, PG_EVALUATE_STENCIL, 0, &bond, &off[0]));
        PG_TRY (time_sweep (&b, PG_EVALUATE_STENCIL, 1, &stencil, &off[1]));
        PG_TRY (time_sweep (&b, PG_EVALUATE_LIST, 1, &list, &off[2]));
        PG_TRY (time_sweep (&b, PG_EVALUATE_FFT, 1, &fft, &off[3]));
        printf ("%s,%zu,%zu,%.3f,%.3f,%.3f,%.3f,%.2g,%.2g\n", bodies[k].name, b.cloud.n, b.sums->stencil.n, bond, stencil, list, fft, off[2], off[3]);
        fflush (stdout);
        clear (&b);
    }
done:
    if (status != PG_OK) fprintf (stderr, "lps_step: %s\n", pg_last_error ());
    clear (&b);
    return status != PG_OK;
}
