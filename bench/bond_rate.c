/* SPDX-License-Identifier: GPL-3.0-or-later
 * Directed bonds summed per second, with the error of the forces against the plain double loop in the same row; a row per body, loop, kind of
 * sweep, and one and two threads. Arguments: names of bodies, by every loop and instruction set that can; none: three bodies by the best ones.
 * Least of several repetitions; of one thread its own time, which other programs on the machine do not lengthen.
 * Bonds carry bits whether any is broken or not; `cut`: a tenth of them is; `check`: stretches are compared with a limit that none reaches. */
#include "perigal/sums.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

/* scatter: points moved by up to this share of a step and numbered at random: no lattice, so that only a list sums its bonds */
typedef struct { const char *name; int dim, count[3]; double m, scatter; } shape;
static const shape shapes[] = {
    { "square_100", 2, { 100, 100, 1 }, 3.015, 0 }, { "square_400", 2, { 400, 400, 1 }, 3.015, 0 }, { "square_1000", 2, { 1000, 1000, 1 }, 3.015, 0 },
    { "square_400_m6", 2, { 400, 400, 1 }, 6.015, 0 }, { "cube_64", 3, { 64, 64, 64 }, 3.015, 0 },
    { "cloud_400", 2, { 400, 400, 1 }, 3.015, 0.3 }, { "cloud_1000", 2, { 1000, 1000, 1 }, 3.015, 0.3 }, { "cloud_cube_64", 3, { 64, 64, 64 }, 3.015, 0.3 },
};
typedef struct { const char *name; int finite, cut, check, weighted; } kind;
static const kind kinds[] = {
    { "linear", 0, 0, 0, 0 }, { "linear_check", 0, 0, 1, 0 }, { "linear_cut_check", 0, 1, 1, 0 }, { "linear_weighted_cut_check", 0, 1, 1, 1 },
    { "finite", 1, 0, 0, 0 }, { "finite_check", 1, 0, 1, 0 }, { "finite_cut_check", 1, 1, 1, 0 },
};
typedef struct {
    pg_cloud cloud;
    pg_sums *sums;
    pg_family family;
    double *modulus, *limit, *u, *f, *plain;
    unsigned char *alive;
} bench;

static double seconds (int threads)
{
    struct timespec t;
    clock_gettime (threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static unsigned chance (size_t i, size_t j)            /* the same for both directions */
{
    uint64_t a = i < j ? i : j, b = i < j ? j : i, x = (a * 0x9e3779b97f4a7c15u) ^ (b * 0xc2b2ae3d27d4eb4fu);
    x = (x ^ (x >> 29)) * 0xbf58476d1ce4e5b9u;
    return (unsigned) ((x >> 33) % 10);
}

static double draw (uint64_t *seed)                    /* in [0, 1) */
{
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return (double) (*seed >> 11) / 9007199254740992.0;
}

static void scatter_points (pg_cloud *c, double share)
{
    uint64_t seed = 1;
    size_t dim = (size_t) c->dim;
    for (size_t k = 0; k < c->n * dim; k++) c->x[k] += share * c->h * (2 * draw (&seed) - 1);
    for (size_t i = c->n; i > 1; i--) {
        size_t j = (size_t) (draw (&seed) * (double) i);
        for (size_t d = 0; d < dim; d++) {
            double x = c->x[(i - 1) * dim + d];
            c->x[(i - 1) * dim + d] = c->x[j*dim + d], c->x[j*dim + d] = x;
        }
    }
}

static void clear (bench *b)
{
    void *all[] = { b->cloud.x, b->cloud.volume, b->modulus, b->limit, b->u, b->f, b->plain, b->alive };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
    pg_family_clear (&b->family);
    pg_sums_free (&b->sums);
}

static pg_status build (bench *b, const shape *s, const kind *k, pg_evaluation evaluation)
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
    }
    if (s->scatter > 0) scatter_points (c, s->scatter);
    for (size_t i = 0; i < n; i++)
        for (size_t d = 0; d < dim; d++) {
            const double *x = c->x + i * dim;
            b->u[i*dim + d] = 1e-3 * h * sin ((0.05 * x[0] + 0.07 * x[1] + (dim == 3 ? 0.03 * x[2] : 0)) / h + (double) d);
        }
    pg_lattice lattice = { .dim = s->dim, .step = { h, h, h } };
    pg_sum_rule rule = { .mode = s->dim == 2 ? PG_PLANE_STRESS : PG_SOLID, .kernel = pg_kernel_find ("constant"), .horizon = s->m * h,
                         .partial = s->scatter > 0 ? PG_PARTIAL_LINEAR : PG_PARTIAL_OVERLAP, .surface = k->weighted ? PG_SURFACE_PRODUCT : PG_SURFACE_NONE, .calibrate = 1,
                         .finite = k->finite, .evaluation = evaluation };
    PG_TRY (pg_sums_create (&b->sums, &rule, c, s->scatter > 0 ? NULL : &lattice));
    PG_TRY (pg_sums_family (&b->family, b->sums));
    PG_ALLOC (b->alive, b->family.start[n]);
    for (size_t i = 0; i < n; i++) {
        b->modulus[i] = b->sums->calibration * pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 72e9, 1);
        b->limit[i] = 0.04;
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++)
            b->alive[e] = !(k->cut && chance (i, (size_t) b->family.node[e]) == 0);
    }
done:
    return status;
}

/* The plain loop, in the order of the family */
static pg_status plain_forces (bench *b)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->cloud.dim, most = 1;
    double *xi = NULL, *weight = NULL;
    for (size_t i = 0; i < b->cloud.n; i++) if (b->family.start[i + 1] - b->family.start[i] > most) most = b->family.start[i + 1] - b->family.start[i];
    PG_ALLOC (xi, most * dim);
    PG_ALLOC (weight, most);
    for (size_t i = 0; i < b->cloud.n; i++) {
        pg_sums_bonds (b->sums, &b->family, i, xi, weight, NULL);
        for (size_t e = b->family.start[i]; e < b->family.start[i + 1]; e++) {
            size_t j = (size_t) b->family.node[e], k = e - b->family.start[i];
            double r2 = 0, y2 = 0, dot = 0, q = 0, eta[3];
            if (!b->alive[e]) continue;
            for (size_t d = 0; d < dim; d++) {
                double x = xi[k*dim + d];
                eta[d] = b->u[j*dim + d] - b->u[i*dim + d];
                r2 += x * x, y2 += (x + eta[d]) * (x + eta[d]), dot += x * eta[d], q += eta[d] * (2 * x + eta[d]);
            }
            double r = sqrt (r2), l = sqrt (y2), c = b->modulus[i] * weight[k] * b->cloud.volume[i] * b->cloud.volume[j];
            for (size_t d = 0; d < dim; d++)
                b->plain[i*dim + d] += b->sums->rule.finite ? c * q / (r * (l + r)) * (xi[k*dim + d] + eta[d]) / l : c * dot / r2 * xi[k*dim + d] / r;
        }
    }
done:
    pg_free (xi);
    pg_free (weight);
    return status;
}

static double worst (const bench *b)
{
    double most = 0, off = 0;
    for (size_t i = 0; i < b->cloud.n * (size_t) b->cloud.dim; i++)
        most = fmax (most, fabs (b->plain[i])), off = fmax (off, fabs (b->f[i] - b->plain[i]));
    return off / most;
}

static pg_status time_row (bench *b, const shape *s, const kind *k, const char *set, int threads)
{
    pg_status status = PG_OK;
    pg_sweep *sweep = NULL;
    pg_changes broken = { 0 };
    pg_sweep_setting setting = { .sums = b->sums, .family = &b->family, .modulus = b->modulus, .limit = b->limit, .threads = threads, .instructions = set };
    double best = INFINITY, start = seconds (2), per_bond, per_point;
    status = pg_sweep_create (&sweep, &setting);
    if (status == PG_E_USAGE) return PG_OK;            /* not on this machine, or not by this loop                       */
    PG_TRY (status);
    pg_sweep_update (sweep, b->alive, NULL);
    double setup = seconds (2) - start;
    start = seconds (2);
    for (int repeat = 0; repeat < 5 || (repeat < 2000 && seconds (2) - start < 0.2); repeat++) {
        double t = seconds (threads);
        PG_TRY (pg_sweep_force (sweep, b->u, b->f, k->check ? &broken : NULL));
        best = fmin (best, seconds (threads) - t);
    }
    if (broken.n) PG_FAIL (PG_E_EQUILIBRIUM, "%zu bonds broke", broken.n);
    pg_sweep_bytes (sweep, &per_bond, &per_point);
    printf ("%s,%zu,%zu,%s,%s,%d,%.4f,%.4f,%.3g,%.4f,%.3f,%.1f\n", s->name, b->cloud.n, b->family.start[b->cloud.n], k->name, pg_sweep_name (sweep),
            threads, (double) b->family.start[b->cloud.n] / best * 1e-9, best * 1e3, worst (b), setup, per_bond, per_point);
    fflush (stdout);
done:
    pg_sweep_free (&sweep);
    pg_free (broken.bond);
    return status;
}

static pg_status time_body (const shape *s, const kind *k, pg_evaluation evaluation, int all)
{
    static const char *const sets[] = { "avx512", "avx2", "scalar" };
    pg_status status = PG_OK;
    bench b;
    PG_TRY (build (&b, s, k, evaluation));
    PG_TRY (plain_forces (&b));
    for (int set = 0; set < (all ? 3 : 1); set++)
        for (int threads = 1; threads <= 2; threads++) PG_TRY (time_row (&b, s, k, all ? sets[set] : NULL, threads));
done:
    clear (&b);
    return status;
}

int main (int argc, char **argv)
{
    static const char *const usual[] = { "square_400", "cube_64", "cloud_400" };
    printf ("body,points,directed_bonds,kind,loop,threads,Gbonds_per_s,ms,error,setup_s,bytes_per_bond,bytes_per_point\n");
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        int wanted = 0, all = argc > 1;
        for (int a = 1; a < argc; a++) wanted |= strcmp (argv[a], shapes[s].name) == 0;
        for (size_t u = 0; !all && u < sizeof usual / sizeof *usual; u++) wanted |= strcmp (usual[u], shapes[s].name) == 0;
        for (size_t k = 0; wanted && k < sizeof kinds / sizeof *kinds; k++)
            for (int e = shapes[s].scatter > 0; e < (all || shapes[s].scatter > 0 ? 2 : 1); e++) {
                if (time_body (&shapes[s], &kinds[k], e ? PG_EVALUATE_LIST : PG_EVALUATE_STENCIL, all) == PG_OK) continue;
                fprintf (stderr, "bond_rate: %s\n", pg_last_error ());
                return 1;
            }
    }
    return 0;
}
