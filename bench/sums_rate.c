/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over bonds: directed bonds per second, milliseconds, memory, and the error of the forces against a
 * plain loop over bonds in the same row; a row per force, body, kind of sum, loop and number of threads.
 *     sums_rate [FORCE...] [BODY...] [KIND...]
 * Forces: bond (loops over bonds), fcbm (transforms beside the stencil), lps (state-based), gmpd
 * (micropolar); none named: all. Bodies: those named, by every loop and instruction set that can sum them;
 * none: those that the table lists for the force, by the best instructions. Kinds: those named; none: all of
 * the force.
 *
 * A sum is repeated for a quarter of a second at least; the row has the least, the median and the largest
 * time of one. The least is what the machine can do, the others say how much else it had to do. Times of one
 * thread are its own, those of several are the clock's. The error is the largest difference from the plain
 * loop's forces over the largest force.
 *
 * Bonds carry bits whether any is broken or not; `cut`: a tenth of them is; `crack`: all across the middle as
 * far as half way; `check`: bonds are compared with limits that none reaches. `transforms`: these with their
 * product alone. A `cloud` is made of irregular points with random numbers, whose bonds only a list sums. */
#include "lattice.h"
#include "mechanics/sums/lattice/fft_rows.h"
#include "mechanics/sums/terms/bond_loop.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

/* ---- what is measured ---------------------------------------------------------------------------------- */
enum { BOND = 1, FCBM = 2, LPS = 4, GMPD = 8 };
typedef struct { const char *name; int bit, threads, loops; } force;  /* loops: bits of pg_evaluation */
#define BY(loop) (1 << PG_EVALUATE_##loop)
static const force forces[] = {
    { "bond", BOND, 2, BY (STENCIL) },
    { "fcbm", FCBM, 1, BY (STENCIL) | BY (FFT) },
    { "lps", LPS, 1, BY (STENCIL) | BY (LIST) | BY (FFT) },
    { "gmpd", GMPD, 2, BY (STENCIL) | BY (LIST) },
};
/* scatter: points moved by up to this share of a step and numbered at random: no lattice, so that only a list
 * sums its bonds */
typedef struct { const char *name; int dim, count; double m, scatter; int forces; } shape;
static const shape shapes[] = {
    { "square_400", 2, 400, 3.015, 0, BOND | FCBM | LPS | GMPD },
    { "square_400_m6", 2, 400, 6.015, 0, LPS },
    { "square_400_m10", 2, 400, 10.015, 0, LPS },
    { "cube_64_m2", 3, 64, 2.015, 0, LPS },
    { "cube_64", 3, 64, 3.015, 0, BOND | LPS },
    { "cube_64_m4", 3, 64, 4.015, 0, LPS },
    { "cube_64_m5", 3, 64, 5.015, 0, LPS },
    { "cloud_400", 2, 400, 3.015, 0.3, BOND | LPS | GMPD },
    { "cloud_cube_40", 3, 40, 3.015, 0.3, BOND | LPS | GMPD },
    { "square_100", 2, 100, 3.015, 0, 0 },
    { "square_1000", 2, 1000, 3.015, 0, FCBM },
    { "cube_128", 3, 128, 2.015, 0, FCBM },
    { "cube_40", 3, 40, 3.015, 0, GMPD },
    { "cloud_1000", 2, 1000, 3.015, 0.3, 0 },
    { "cloud_cube_64", 3, 64, 3.015, 0.3, 0 },
    /* over the horizon: where transforms are faster */
    { "square_256_m2", 2, 256, 2.015, 0, FCBM },
    { "square_256_m3", 2, 256, 3.015, 0, FCBM },
    { "square_256_m4", 2, 256, 4.015, 0, FCBM },
    { "square_256_m5", 2, 256, 5.015, 0, FCBM },
    { "square_256_m6", 2, 256, 6.015, 0, FCBM },
    { "square_256_m8", 2, 256, 8.015, 0, FCBM },
    { "square_256_m12", 2, 256, 12.015, 0, FCBM },
    { "square_256_m20", 2, 256, 20.015, 0, FCBM },
    { "cube_48_m2", 3, 48, 2.015, 0, FCBM },
    { "cube_48_m3", 3, 48, 3.015, 0, FCBM },
    { "cube_48_m4", 3, 48, 4.015, 0, FCBM },
    { "cube_48_m5", 3, 48, 5.015, 0, FCBM },
    { "cube_48_m6", 3, 48, 6.015, 0, FCBM },
};
enum { NONE, TENTH, CRACK };
typedef struct { const char *name; int forces, finite, cut, check, weighted; } kind;
static const kind kinds[] = {
    { "linear", BOND | FCBM | LPS | GMPD, 0, NONE, 0, 0 },
    { "check", BOND | FCBM | GMPD, 0, NONE, 1, 0 },
    { "cut_check", BOND | LPS | GMPD, 0, TENTH, 1, 0 },
    { "crack", FCBM, 0, CRACK, 0, 0 },
    { "weighted_cut_check", BOND | GMPD, 0, TENTH, 1, 1 },
    { "finite", BOND, 1, NONE, 0, 0 },
    { "finite_check", BOND, 1, NONE, 1, 0 },
    { "finite_cut_check", BOND, 1, TENTH, 1, 0 },
};
enum {
    FORCES = sizeof forces / sizeof *forces,
    SHAPES = sizeof shapes / sizeof *shapes,
    KINDS = sizeof kinds / sizeof *kinds
};
static const double E = 72e9, nu = 0.2, bend = 0.09, length = 1e-3;                      /* Pa, -, -, m */

typedef struct {
    const force *force;
    const shape *shape;
    const kind *kind;
    lattice_body body;
    pg_beam_law law;
    double *value[7];  /* of each point: modulus, limit, A, B, C_t, B, far limits */
} bench;
enum { MODULUS, LIMIT, DILATION, DEVIATION, SHEAR, BENDING, FAR, VALUES };

static pg_bond_loop_setting setting_of (const bench *b)
{
    return (pg_bond_loop_setting){ .sums = b->body.sums,
                                   .family = &b->body.family,
                                   .modulus = b->value[MODULUS],
                                   .limit = b->value[LIMIT],
                                   .dilation = b->value[DILATION],
                                   .deviation = b->value[DEVIATION],
                                   .beams = b->force->bit == GMPD ? &b->law : NULL };
}

/* ---- bodies -------------------------------------------------------------------------------------------- */
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

static int cracked (const pg_cloud *c, size_t i, size_t j)
{
    const double *p = c->x + i * (size_t) c->dim, *q = c->x + j * (size_t) c->dim,
                 y = 0.5 * (c->high[1] - c->h), half = 0.5 * c->high[0];
    return (p[1] < y) != (q[1] < y) && p[0] + (y - p[1]) / (q[1] - p[1]) * (q[0] - p[0]) < half;
}

static void clear (bench *b)
{
    for (int k = 0; k < VALUES; k++) pg_free (b->value[k]);
    lattice_clear (&b->body);
}

static pg_status set_values (bench *b, const pg_sum_rule *rule)
{
    pg_status status = PG_OK;
    size_t n = b->body.cloud.n;
    double one[VALUES] = { 0 };
    const pg_sums *sums = b->body.sums;
    pg_beam_sums beams;
    one[MODULUS] = sums->calibration * pg_bond_modulus (rule->mode, rule->kernel, rule->horizon, E, 1);
    one[LIMIT] = 0.04, one[FAR] = 10;
    pg_state_moduli (rule->mode, E, nu, &one[DILATION], &one[DEVIATION]);
    if (b->force->bit == GMPD) {
        PG_TRY (pg_beam_measure (&beams, sums));
        PG_TRY (
            pg_beam_moduli (&one[MODULUS], &one[SHEAR], rule->mode, rule->kernel, rule->horizon, E, nu, 1));
        one[MODULUS] *= sums->calibration, one[SHEAR] *= beams.calibration, one[BENDING] = bend * one[SHEAR];
    }
    for (int k = 0; k < VALUES; k++) {
        PG_ALLOC (b->value[k], n);
        for (size_t i = 0; i < n; i++) b->value[k][i] = one[k];
    }
    b->law = (pg_beam_law){ .shear = b->value[SHEAR],
                            .bending = b->value[BENDING],
                            .length = length,
                            .shear_limit = b->value[FAR],
                            .bending_limit = b->value[FAR] };
done:
    return status;
}

static pg_status build (bench *b, const force *f, const shape *s, const kind *k)
{
    pg_status status = PG_OK;
    double h = 1e-3;
    int count[3] = { s->count, s->count, s->count }, m = f->bit != GMPD ? s->dim : s->dim == 2 ? 3 : 6;
    *b = (bench) { .force = f, .shape = s, .kind = k };
    lattice_body *body = &b->body;
    PG_TRY (lattice_create (body, s->dim, count, h, m));
    if (s->scatter > 0) scatter_points (&body->cloud, s->scatter);
    pg_sum_rule rule = { .mode = s->dim == 2 ? PG_PLANE_STRESS : PG_SOLID,
                         .kernel = pg_kernel_find ("constant"),
                         .horizon = s->m * h,
                         .partial = s->scatter > 0 ? PG_PARTIAL_LINEAR : PG_PARTIAL_OVERLAP,
                         .surface = k->weighted ? PG_SURFACE_PRODUCT : PG_SURFACE_NONE,
                         .calibrate = 1,
                         .state = f->bit == LPS,
                         .beams = f->bit == GMPD,
                         .finite = k->finite,
                         .evaluations = 1e5 };
    PG_TRY (lattice_bond (body, &rule, s->scatter > 0));
    PG_TRY (set_values (b, &rule));
    for (size_t i = 0; i < body->cloud.n; i++) {
        const double *x = body->cloud.x + i * (size_t) s->dim;
        double phase = (0.05 * x[0] + 0.07 * x[1] + (s->dim == 3 ? 0.03 * x[2] : 0)) / h;
        for (int c = 0; c < m; c++)
            body->u[i * (size_t) m + (size_t) c] = (c < s->dim ? 1e-3 : 1e-4) * h * sin (phase + c);
        for (size_t e = body->family.start[i]; k->cut && e < body->family.start[i + 1]; e++) {
            size_t j = (size_t) body->family.node[e];
            body->alive[e] = !(k->cut == TENTH ? chance (i, j) == 0 : cracked (&body->cloud, i, j));
        }
    }
done:
    return status;
}

/* ---- plain loops, in the order of the family ----------------------------------------------------------- */
typedef struct { size_t j; double weight, r, eta[3], xi[3], volumes; } plain_bond;

static plain_bond plain_read (const bench *b, size_t i, size_t e, const double *xi, double weight)
{
    const lattice_body *body = &b->body;
    size_t dim = (size_t) body->cloud.dim, m = (size_t) body->m;
    plain_bond p = { .j = (size_t) body->family.node[e], .weight = weight };
    for (size_t d = 0; d < dim; d++)
        p.xi[d] = xi[d], p.eta[d] = body->u[p.j * m + d] - body->u[i * m + d], p.r += xi[d] * xi[d];
    p.r = sqrt (p.r), p.volumes = body->cloud.volume[i] * body->cloud.volume[p.j];
    return p;
}

static double along (const plain_bond *p)
{
    return p->xi[0] * p->eta[0] + p->xi[1] * p->eta[1] + p->xi[2] * p->eta[2];
}

static void plain_pull (bench *b, size_t i, const plain_bond *p, const double *unused)
{
    const pg_sum_rule *rule = &b->body.sums->rule;
    double c = b->value[MODULUS][i] * p->weight * p->volumes, y[3], l = 0,
           *f = b->body.plain + i * (size_t) b->body.m;
    (void) unused;
    for (int d = 0; d < 3; d++) y[d] = p->xi[d] + p->eta[d], l += y[d] * y[d];
    l = sqrt (l);
    double stretch = (2 * along (p) + p->eta[0] * p->eta[0] + p->eta[1] * p->eta[1] + p->eta[2] * p->eta[2])
                     / (p->r * (l + p->r));
    for (int d = 0; d < b->body.m; d++)
        f[d] += rule->finite ? c * stretch * y[d] / l : c * along (p) / (p->r * p->r) * p->xi[d] / p->r;
}

static void plain_beam (bench *b, size_t i, const plain_bond *p, const double *unused)
{
    pg_bond_loop_setting s = setting_of (b);
    size_t m = (size_t) b->body.m;
    double own[36], other[36], *f = b->body.plain + i * m;
    pg_beam beam = pg_beam_between (&s, i, p->j, p->xi, p->weight);
    (void) unused;
    pg_beam_blocks (b->body.cloud.dim, p->xi, &beam, length, own, other);
    for (size_t a = 0; a < m; a++)
        for (size_t c = 0; c < m; c++)
            f[a] -= own[a * m + c] * b->body.u[i * m + c] + other[a * m + c] * b->body.u[p->j * m + c];
}

/* f = V_i V_j w [(A_i theta_i / q_i + A_j theta_j / q_j) + (B_i / q_i + B_j / q_j) xi.eta / r^2] xi; q counts
 * all bonds; state: q, theta */
static void plain_state (bench *b, size_t i, const plain_bond *p, const double *state)
{
    const double *A = b->value[DILATION], *B = b->value[DEVIATION], *q = state,
                 *theta = state + b->body.cloud.n;
    double w = p->weight / p->r, *f = b->body.plain + i * (size_t) b->body.m;
    double t = A[i] * theta[i] / q[i] + A[p->j] * theta[p->j] / q[p->j]
               + (B[i] / q[i] + B[p->j] / q[p->j]) * along (p) / (p->r * p->r);
    for (int d = 0; d < b->body.m; d++) f[d] += p->volumes * w * t * p->xi[d];
}

static pg_status plain_forces (bench *b)
{
    pg_status status = PG_OK;
    lattice_body *body = &b->body;
    size_t dim = (size_t) body->cloud.dim, most = 1, n = body->cloud.n;
    double *xi = NULL, *weight = NULL, *state = NULL;
    const size_t *start = body->family.start;
    for (size_t i = 0; i < n; i++) if (start[i + 1] - start[i] > most) most = start[i + 1] - start[i];
    PG_ALLOC (xi, most * dim);
    PG_ALLOC (weight, most);
    PG_ALLOC (state, 2 * n);
    for (size_t i = 0; b->force->bit == LPS && i < n; i++) {
        pg_sums_bonds (body->sums, &body->family, i, xi, weight, NULL);
        for (size_t e = start[i]; e < start[i + 1]; e++) {
            plain_bond p = plain_read (b, i, e, xi + (e - start[i]) * dim, weight[e - start[i]]);
            state[i] += p.weight * p.r * body->cloud.volume[p.j];
            if (body->alive[e])
                state[n + i] += (double) dim * p.weight / p.r * along (&p) * body->cloud.volume[p.j];
        }
        state[n + i] /= state[i];
    }
    for (size_t i = 0; i < n; i++) {
        pg_sums_bonds (body->sums, &body->family, i, xi, weight, NULL);
        for (size_t e = start[i]; e < start[i + 1]; e++) {
            plain_bond p = plain_read (b, i, e, xi + (e - start[i]) * dim, weight[e - start[i]]);
            if (body->alive[e])
                (b->force->bit == LPS    ? plain_state
                 : b->force->bit == GMPD ? plain_beam
                                         : plain_pull) (b, i, &p, state);
        }
    }
done:
    pg_free (xi);
    pg_free (weight);
    pg_free (state);
    return status;
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
static void print_start (const bench *b, const char *loop, int threads)
{
    printf ("%s,%s,%zu,%.4g,%zu,%s,%s,%d,", b->force->name, b->shape->name, b->body.cloud.n, b->shape->m,
            b->body.family.start[b->body.cloud.n], b->kind->name, loop, threads);
}

enum { MOST_REPEATS = 2000 };
typedef struct { int n; double time[MOST_REPEATS]; } repeats;          /* s */

static int ascending (const void *a, const void *b)
{
    double x = *(const double *) a, y = *(const double *) b;
    return (x > y) - (x < y);
}

/* Is it time for another one? Five at least, a quarter of a second of them all since `start`. */
static int again (const repeats *r, double start)
{
    return r->n < 5 || (r->n < MOST_REPEATS && lattice_seconds (2) - start < 0.25);
}

/* Least, median and largest, in milliseconds */
static void print_times (repeats *r)
{
    qsort (r->time, (size_t) r->n, sizeof *r->time, ascending);
    printf ("%.4f,%.4f,%.4f,", 1e3 * r->time[0], 1e3 * r->time[r->n / 2], 1e3 * r->time[r->n - 1]);
}

static pg_status time_row (bench *b, const char *set, int threads)
{
    pg_status status = PG_OK;
    pg_bond_loop *loop = NULL;
    pg_changes broken = { 0 };
    pg_bond_loop_setting setting = setting_of (b);
    lattice_body *body = &b->body;
    double start = lattice_seconds (2), per_bond, per_point;
    static repeats all;
    setting.threads = threads, setting.instructions = set;
    status = pg_bond_loop_create (&loop, &setting);
    if (status == PG_E_USAGE) return PG_OK;            /* not on this machine, or not by this loop */
    PG_TRY (status);
    /* the same loop by all */
    if (set && strcmp (set, "scalar") != 0 && !strstr (pg_bond_loop_name (loop), set)) goto done;
    pg_bond_loop_update (loop, body->alive, NULL);
    double setup = lattice_seconds (2) - start;
    start = lattice_seconds (2);
    for (all.n = 0; again (&all, start); all.n++) {
        double t = lattice_seconds (threads);
        PG_TRY (pg_bond_loop_force (loop, body->u, body->f, b->kind->check ? &broken : NULL));
        all.time[all.n] = lattice_seconds (threads) - t;
    }
    if (broken.n) PG_FAIL (PG_E_EQUILIBRIUM, "%zu bonds broke", broken.n);
    pg_bond_loop_counts count;
    pg_bond_loop_counted (loop, &count);
    pg_bond_loop_bytes (loop, &per_bond, &per_point);
    print_start (b, pg_bond_loop_name (loop), threads);
    double best = all.time[0];
    for (int k = 1; k < all.n; k++) best = fmin (best, all.time[k]);
    printf ("%.4f,", (double) body->family.start[body->cloud.n] / best * 1e-9);
    print_times (&all);
    printf ("%.3g,%.4f,%.3f,%.1f,", lattice_apart (body, body->f, body->plain), setup, per_bond, per_point);
    if (count.sums)
        printf ("%.1f,%.1f,%.3g\n", (double) count.forward / (double) count.sums,
                (double) count.back / (double) count.sums, (double) count.bonds / (double) count.blocks);
    else puts (",,");
    fflush (stdout);
done:
    pg_bond_loop_free (&loop);
    pg_free (broken.bond);
    return status;
}

static void fill (void *context, size_t row, int field, double *x)
{
    (void) row, (void) field;
    x[0] = *(double *) context;
}
static void take (void *context, size_t row, double *const *x, double *spare)
{
    (void) row, (void) spare;
    *(double *) context = x[0][0];
}
static double one (const void *context, int pair, size_t entry)
{
    (void) context, (void) pair, (void) entry;
    return 1;
}

static pg_status time_transforms (bench *b)
{
    pg_status status = PG_OK;
    const pg_sums *sums = b->body.sums;
    const int *count = sums->sites.count;
    size_t n[3] = { (size_t) count[0], (size_t) count[1], (size_t) count[2] };
    double x = 0, start;
    static repeats all;
    char name[60];
    fft f = { 0 };
    fft_job job = { b->body.cloud.dim, b->body.cloud.dim, fill, take, &x };
    const fft_kernels *kernels = pg_instructions_here (PG_AVX512) ? &pg_fft_avx512
                                 : pg_instructions_here (PG_AVX2) ? &pg_fft_avx2
                                                                  : &pg_fft_scalar;
    PG_TRY (pg_fft_create (&f, b->body.cloud.dim, n, sums->stencil.n, sums->stencil.offset, one, NULL,
                           kernels,
                        1, 1));
    start = lattice_seconds (2);
    for (all.n = 0; again (&all, start); all.n++) {
        double t = lattice_seconds (1);
        pg_fft_convolve (&f, &job);
        all.time[all.n] = lattice_seconds (1) - t;
    }
    snprintf (name, sizeof name, "transforms %zux%zux%zu", f.box.T[0], f.box.T[1], f.box.T[2]);
    print_start (b, name, 1);
    putchar (',');
    print_times (&all);
    printf (",,,,%d,%d,\n", b->body.cloud.dim, b->body.cloud.dim);
done:
    pg_fft_clear (&f);
    return status;
}

static pg_status time_body (const force *f, const shape *s, const kind *k, int all)
{
    static const char *const sets[] = { "avx512", "avx2", "scalar" };
    pg_status status = PG_OK;
    bench b;
    PG_TRY (build (&b, f, s, k));
    PG_TRY (plain_forces (&b));
    for (int loop = PG_EVALUATE_STENCIL; loop <= PG_EVALUATE_FFT; loop++) {
        int wanted = all ? f->bit != BOND || loop != PG_EVALUATE_FFT
                         : (s->scatter > 0 ? BY (LIST) : f->loops) >> loop & 1;
        b.body.sums->rule.evaluation = (pg_evaluation) loop;
        for (int set = 0; wanted && set < (all ? 3 : 1); set++)
            for (int threads = 1; threads <= (all ? 2 : f->threads); threads++)
                PG_TRY (time_row (&b, all ? sets[set] : NULL, threads));
    }
    if (f->bit == FCBM && k == kinds && s->scatter == 0) PG_TRY (time_transforms (&b));
done:
    clear (&b);
    return status;
}

static int named (const char *name, int argc, char **argv)
{
    for (int a = 1; a < argc; a++) if (strcmp (argv[a], name) == 0) return 1;
    return 0;
}

int main (int argc, char **argv)
{
    int some_forces = 0, some_shapes = 0, some_kinds = 0;
    for (size_t f = 0; f < FORCES; f++) some_forces += named (forces[f].name, argc, argv);
    for (size_t s = 0; s < SHAPES; s++) some_shapes += named (shapes[s].name, argc, argv);
    for (size_t k = 0; k < KINDS; k++) some_kinds += named (kinds[k].name, argc, argv);
    if (some_forces + some_shapes + some_kinds < argc - 1) {
        fprintf (stderr, "usage: sums_rate [bond|fcbm|lps|gmpd]... [BODY]... [KIND]...\n");
        return 64;
    }
    puts ("force,body,points,m,directed_bonds,kind,loop,threads,Gbonds_per_s,ms,ms_median,ms_most,error,"
          "setup_s,"
          "bytes_per_bond,bytes_per_point,forward,back,blocks_direct");
    for (size_t f = 0; f < FORCES; f++)
        for (size_t s = 0; s < SHAPES; s++)
            for (size_t k = 0; k < KINDS; k++) {
                int listed = some_shapes ? named (shapes[s].name, argc, argv)
                                         : shapes[s].forces & forces[f].bit;
                if (!listed || !(kinds[k].forces & forces[f].bit)
                    || (some_forces && !named (forces[f].name, argc, argv))
                    || (some_kinds && !named (kinds[k].name, argc, argv)))
                    continue;
                if (time_body (&forces[f], &shapes[s], &kinds[k], some_shapes) == PG_OK) continue;
                fprintf (stderr, "sums_rate: %s\n", pg_last_error ());
                return 1;
            }
    return 0;
}
