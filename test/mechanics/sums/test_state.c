/* SPDX-License-Identifier: GPL-3.0-or-later
 * State-based sums against the plain double loop of the definition: forces, energies, dilatations, breaking,
 * with holes, half volumes, dead bonds, several materials, scattered points; the same bits for any number of
 * threads; sets of instructions; rigid motions; momenta. */
#include "lattice_body.h"

typedef struct {
    body b;
    double *dilation, *deviation;
    pg_bond_loop_setting setting;
    unsigned char *counted;
} solid;

static void solid_create (solid *s, const body_wish *wish, double scatter, int mixed, int follow, double nu,
                          uint64_t seed)
{
    memset (s, 0, sizeof *s);
    body_create_as (&s->b, wish, scatter, mixed, seed);
    pg_sum_rule *rule = &s->b.sums->rule;
    size_t n = s->b.cloud.n;
    rule->state = 1, rule->follow = follow;
    s->dilation = pg_calloc (n, sizeof *s->dilation), s->deviation = pg_calloc (n, sizeof *s->deviation);
    for (size_t i = 0; i < n; i++) {
        int other = mixed
                    && s->b.cloud.x[i * (size_t) s->b.cloud.dim]
                           > 0.5 * (s->b.cloud.low[0] + s->b.cloud.high[0]);
        pg_state_moduli (rule->mode, other ? 200e9 : 72e9, other ? 0.1 : nu, &s->dilation[i],
                         &s->deviation[i]);
    }
    s->setting = (pg_bond_loop_setting){ .sums = s->b.sums,
                                         .family = &s->b.family,
                                         .dilation = s->dilation,
                                         .deviation = s->deviation,
                                         .threads = 1 };
}

static void solid_free (solid *s)
{
    pg_free (s->dilation), pg_free (s->deviation), pg_free (s->counted);
    body_free (&s->b);
}

/* The definition, bond by bond; f (n x dim), W (n), theta (n); returns the energy. */
static double plain (const solid *s, double *f, double *W, double *theta)
{
    const body *b = &s->b;
    size_t dim = (size_t) b->cloud.dim, n = b->cloud.n;
    double *xi = pg_calloc (512 * dim, sizeof *xi), *weight = pg_calloc (512, sizeof *weight),
           *q = pg_calloc (n, sizeof *q), sum = 0;
    memset (f, 0, n * dim * sizeof *f);
    for (int pass = 0; pass < 3; pass++)
        for (size_t i = 0; i < n; i++) {
            double square = 0;
            pg_sums_bonds (b->sums, &b->family, i, xi, weight, NULL);
            for (size_t e = b->family.start[i], k = 0; e < b->family.start[i + 1]; e++, k++) {
                size_t j = (size_t) b->family.node[e];
                double r2 = 0, dot = 0;
                for (size_t d = 0; d < dim; d++)
                    r2 += xi[k * dim + d] * xi[k * dim + d],
                        dot += xi[k * dim + d] * (b->u[j * dim + d] - b->u[i * dim + d]);
                double r = sqrt (r2), w = weight[k] / r, V = b->cloud.volume[j];
                if (pass == 0
                    && (b->sums->rule.follow ? b->alive[e] : !s->setting.counted || s->setting.counted[e]))
                    q[i] += w * r2 * V;
                if (!b->alive[e] || pass == 0) continue;
                if (pass == 1) {
                    theta[i] += (double) dim * w * dot * V;
                    continue;
                }
                square += w * (dot / r) * (dot / r) * V;
                double ti = q[i] > 0 ? s->dilation[i] * theta[i] * w * r / q[i]
                                           + s->deviation[i] * w * (dot / r) / q[i]
                                     : 0;
                double tj = q[j] > 0 ? s->dilation[j] * theta[j] * w * r / q[j]
                                           + s->deviation[j] * w * (dot / r) / q[j]
                                     : 0;
                for (size_t d = 0; d < dim; d++)
                    f[i * dim + d] += b->cloud.volume[i] * V * (ti + tj) * xi[k * dim + d] / r;
            }
            if (pass == 1) theta[i] = q[i] > 0 ? theta[i] / q[i] : 0;
            if (pass == 2)
                W[i] = q[i] > 0 ? 0.5
                                      * (s->dilation[i] / (double) dim * theta[i] * theta[i]
                                         + s->deviation[i] / q[i] * square)
                                : 0;
            if (pass == 2) sum += W[i] * b->cloud.volume[i];
        }
    pg_free (xi), pg_free (weight), pg_free (q);
    return sum;
}

static double size_of (size_t n, const double *x)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum = fmax (sum, fabs (x[i]));
    return sum;
}

static void check_near (size_t n, const double *a, const double *b, double tolerance)
{
    double size = size_of (n, b);
    for (size_t i = 0; i < n; i++) check_scaled (a[i], b[i], tolerance, size);
}

static void compare (solid *s, pg_evaluation evaluation, const char *instructions)
{
    size_t n = s->b.cloud.n, ndof = n * (size_t) s->b.cloud.dim;
    double *f = pg_calloc (ndof, sizeof *f), *g = pg_calloc (ndof, sizeof *g), *W = pg_calloc (n, sizeof *W),
           *Y = pg_calloc (n, sizeof *Y);
    double *theta = pg_calloc (n, sizeof *theta), *tau = pg_calloc (n, sizeof *tau),
           E = plain (s, f, W, theta);
    pg_bond_loop *sweep;
    s->b.sums->rule.evaluation = evaluation, s->setting.instructions = instructions;
    check_ok (pg_bond_loop_create (&sweep, &s->setting));
    pg_bond_loop_update (sweep, s->b.alive, NULL);
    check_ok (pg_bond_loop_force (sweep, s->b.u, g, NULL));
    check_near (ndof, g, f, 1e-13);
    check_ok (pg_bond_loop_energies (sweep, s->b.u, Y));
    check_near (n, Y, W, 1e-13);
    check_scaled (pg_bond_loop_energy (sweep, s->b.u), E, 1e-13, E);
    check_ok (pg_bond_loop_dilatation (sweep, s->b.u, tau, NULL));
    check_near (n, tau, theta, 1e-13);
    pg_bond_loop_free (&sweep);
    pg_free (f), pg_free (g), pg_free (W), pg_free (Y), pg_free (theta), pg_free (tau);
}

static const body_wish wishes[] = {
    { .count = { 41, 23, 1 },
      .holes = 0.1,
      .shares = 1,
      .dim = 2,
      .m = 3.015,
      .partial = PG_PARTIAL_OVERLAP },
    { .count = { 70, 9, 1 }, .reversed = 1, .dim = 2, .m = 2, .partial = PG_PARTIAL_NONE },
    { .count = { 13, 13, 13 }, .holes = 0.1, .dim = 3, .m = 3.015, .partial = PG_PARTIAL_OVERLAP },
    { .count = { 9, 11, 5 }, .holes = 0.05, .shares = 1, .dim = 3, .m = 2.2, .partial = PG_PARTIAL_LINEAR },
};
enum { WISHES = sizeof wishes / sizeof *wishes };
static const char *const sets[] = { "scalar", "avx2", "avx512", NULL };

static int have (const char *set)
{
    solid s;
    pg_bond_loop *sweep = NULL;
    solid_create (&s, &wishes[1], 0, 0, 0, 0.3, 1);
    s.setting.instructions = set;
    int yes = pg_bond_loop_create (&sweep, &s.setting) == PG_OK;
    pg_bond_loop_free (&sweep);
    solid_free (&s);
    return yes;
}

static void test_against_definition (void **unused)
{
    (void) unused;
    for (int k = 0; k < WISHES; k++)
        for (int follow = 0; follow < 2; follow++) {
            solid s;
            solid_create (&s, &wishes[k], 0, 0, follow, 0.4, 5 + (uint64_t) k);
            body_wound (&s.b, 0.1);
            if (!follow) {                             /* q of what lives now; then more dies */
                s.counted = pg_calloc (s.b.nbond, 1);
                memcpy (s.counted, s.b.alive, s.b.nbond);
                s.setting.counted = s.counted;
                body_wound (&s.b, 0.1);
            }
            compare (&s, PG_EVALUATE_LIST, NULL);
            for (int i = 0; i < 3; i++) if (have (sets[i])) compare (&s, PG_EVALUATE_STENCIL, sets[i]);
            compare (&s, PG_EVALUATE_FFT, NULL);
            solid_free (&s);
            if (k > 1) continue;
            body_wish scattered = wishes[k];
            if (follow) scattered.partial = PG_PARTIAL_LINEAR;
            /* materials; scattered points */
            solid_create (&s, &scattered, follow ? 0.2 : 0, 1, follow, 0.4, 50 + (uint64_t) k);
            body_wound (&s.b, 0.1);
            compare (&s, PG_EVALUATE_LIST, NULL);
            if (!follow) compare (&s, PG_EVALUATE_STENCIL, NULL), compare (&s, PG_EVALUATE_FFT, NULL);
            solid_free (&s);
        }
}

/* By transforms: whole bodies, and those of which a few blocks are cut; a rigid shift of 1 m costs nothing
 * where it is taken off. */
static void test_transforms (void **unused)
{
    (void) unused;
    for (int k = 0; k < WISHES; k++)
        for (int follow = 0; follow < 2; follow++)
            for (int cut = 0; cut < 2; cut++) {
                solid s;
                solid_create (&s, &wishes[k], 0, 0, follow, 0.45, 31 + (uint64_t) k);
                if (cut) body_wound (&s.b, 2.0 / (double) s.b.nbond);
                compare (&s, PG_EVALUATE_FFT, NULL);
                size_t ndof = s.b.cloud.n * (size_t) s.b.cloud.dim;
                double *f = pg_calloc (ndof, sizeof *f), *g = pg_calloc (ndof, sizeof *g);
                pg_bond_loop *sweep;
                check_ok (pg_bond_loop_create (&sweep, &s.setting));
                check_contains (pg_bond_loop_name (sweep), "fft");
                pg_bond_loop_update (sweep, s.b.alive, NULL);
                /* exact after a shift by 1 */
                for (size_t i = 0; i < ndof; i++) s.b.u[i] = ldexp (round (ldexp (s.b.u[i], 50)), -50);
                check_ok (pg_bond_loop_force (sweep, s.b.u, f, NULL));
                for (size_t i = 0; i < ndof; i++) s.b.u[i] += 1;
                check_ok (pg_bond_loop_force (sweep, s.b.u, g, NULL));
                /* displacements of 1e-6 m, 2^-50 m of rounding in their mean */
                check_near (ndof, g, f, 1e-8);
                pg_bond_loop_free (&sweep);
                pg_free (f), pg_free (g);
                solid_free (&s);
            }
}

/* A march of growing displacement: both loops lose the same bonds at the same time, their forces agree,
 * threads change no bit. */
static void test_breaking (void **unused)
{
    (void) unused;
    for (int k = 0; k < WISHES; k += 2)
        for (int follow = 0; follow < 2; follow++) {
            solid s;
            solid_create (&s, &wishes[k], 0, 0, follow, 0.3, 9);
            size_t ndof = s.b.cloud.n * (size_t) s.b.cloud.dim, total = 0;
            double *f[6], *u = pg_calloc (ndof, sizeof *u);
            pg_bond_loop *sweep[6];
            pg_changes lost[6] = { { 0 } };
            for (size_t i = 0; i < s.b.cloud.n; i += 7) s.b.exempt[i] = 1;
            s.setting.limit = s.b.limit, s.setting.exempt = s.b.exempt;
            for (int w = 0; w < 6; w++) {
                f[w] = pg_calloc (ndof, sizeof *f[w]);
                s.b.sums->rule.evaluation = w < 2   ? PG_EVALUATE_STENCIL
                                            : w < 4 ? PG_EVALUATE_LIST
                                                    : PG_EVALUATE_FFT,
                s.setting.threads = w % 2 ? 3 : 1;
                check_ok (pg_bond_loop_create (&sweep[w], &s.setting));
            }
            for (int step = 0; step < 4; step++) {
                for (size_t i = 0; i < ndof; i++) u[i] = s.b.u[i] * (2 + step);
                for (int w = 0; w < 6; w++) {
                    lost[w].n = 0;
                    check_ok (pg_bond_loop_force (sweep[w], u, f[w], &lost[w]));
                }
                for (int w = 1; w < 6; w++) {
                    assert_int_equal (lost[w].n, lost[0].n);
                    if (lost[0].n)
                        assert_memory_equal (lost[w].bond, lost[0].bond, lost[0].n * sizeof *lost[0].bond);
                }
                assert_memory_equal (f[0], f[1], ndof * sizeof *u);
                assert_memory_equal (f[2], f[3], ndof * sizeof *u);
                assert_memory_equal (f[4], f[5], ndof * sizeof *u);
                check_near (ndof, f[2], f[0], 1e-13);
                check_near (ndof, f[4], f[0], 1e-13);
                for (size_t c = 0; c < lost[0].n; c++) s.b.alive[lost[0].bond[c]] = 0;
                total += lost[0].n;
                double *own = s.b.u;
                s.b.u = u;
                compare (&s, PG_EVALUATE_STENCIL, NULL);
                s.b.u = own;
            }
            assert_true (total > 100 && total < s.b.nbond / 2);
            for (int w = 0; w < 6; w++) pg_bond_loop_free (&sweep[w]), pg_free (f[w]), pg_free (lost[w].bond);
            pg_free (u);
            solid_free (&s);
        }
}

/* Rigid motions (small ones) make no force and no dilatation; forces and their moments sum to zero. */
static void test_motions (void **unused)
{
    (void) unused;
    for (int k = 0; k < WISHES; k++)
        for (int list = 0; list < 2; list++) {
            solid s;
            pg_bond_loop *sweep;
            body_wish wish = wishes[k];
            if (list) wish.partial = PG_PARTIAL_LINEAR;
            solid_create (&s, &wish, list ? 0.2 : 0, list, 1, 0.45, 77);
            body_wound (&s.b, 0.2);
            size_t n = s.b.cloud.n, dim = (size_t) s.b.cloud.dim;
            double *f = pg_calloc (n * dim, sizeof *f), *theta = pg_calloc (n, sizeof *theta), sum[6] = { 0 },
                   size = 0;
            check_ok (pg_bond_loop_create (&sweep, &s.setting));
            pg_bond_loop_update (sweep, s.b.alive, NULL);
            check_ok (pg_bond_loop_force (sweep, s.b.u, f, NULL));
            double strained = size_of (n * dim, f), largest = size_of (n * dim, s.b.u);
            for (size_t i = 0; i < n; i++) {
                const double *x = s.b.cloud.x + i*dim, *F = f + i*dim;
                for (size_t d = 0; d < dim; d++) sum[d] += F[d], size += fabs (F[d]);
                for (size_t d = 0, a = 1, c = dim - 1; d < (dim == 3 ? 3 : 1);
                     d++, a = (d + 1) % 3, c = (d + 2) % 3)
                    sum[3 + d] += dim == 2 ? x[0] * F[1] - x[1] * F[0] : x[a] * F[c] - x[c] * F[a];
            }
            for (int d = 0; d < 6; d++) check_scaled (sum[d], 0, 1e-13, size * (d < 3 ? 1 : 70 * cell_side));
            for (size_t i = 0; i < n; i++) {
                const double *x = s.b.cloud.x + i*dim;
                s.b.u[i * dim] = largest - x[1] / cell_side * largest,
                          s.b.u[i * dim + 1] = x[0] / cell_side * largest;
                if (dim == 3) s.b.u[i*dim + 2] = 0.5 * largest;
            }
            check_ok (pg_bond_loop_force (sweep, s.b.u, f, NULL));
            for (size_t i = 0; i < n * dim; i++) check_below (fabs (f[i]), 1e-12 * strained);
            check_ok (pg_bond_loop_dilatation (sweep, s.b.u, theta, NULL));
            for (size_t i = 0; i < n; i++) check_below (fabs (theta[i]), 1e-12 * largest / cell_side);
            pg_bond_loop_free (&sweep);
            pg_free (f), pg_free (theta);
            solid_free (&s);
        }
}

/* With A = 0 and whole families everywhere the same (periodic is not there: inside) it is the bonds' own
 * force. */
static void test_bonds (void **unused)
{
    (void) unused;
    for (int k = 0; k < 2; k++) {
        body_wish wish = {
            .count = { 17, 17, k ? 17 : 1 }, .dim = k ? 3 : 2, .m = 3.015, .partial = PG_PARTIAL_OVERLAP
        };
        solid s;
        pg_bond_loop *state, *bonds;
        solid_create (&s, &wish, 0, 0, 0, k ? 0.25 : 1.0 / 3, 3);
        size_t n = s.b.cloud.n, dim = (size_t) s.b.cloud.dim;
        double *f = pg_calloc (n * dim, sizeof *f), *g = pg_calloc (n * dim, sizeof *g);
        check_ok (pg_bond_loop_create (&state, &s.setting));
        check_ok (pg_bond_loop_force (state, s.b.u, f, NULL));
        s.b.sums->rule.state = 0;
        pg_bond_loop_setting plain_setting = {
            .sums = s.b.sums, .family = &s.b.family, .modulus = s.b.modulus, .threads = 1
        };
        check_ok (pg_bond_loop_create (&bonds, &plain_setting));
        check_ok (pg_bond_loop_force (bonds, s.b.u, g, NULL));
        double size = size_of (n * dim, g);
        size_t inside = 0;
        for (size_t i = 0; i < n; i++) {
            int deep = 1;                              /* neighbours' families are whole as well */
            for (size_t d = 0; d < dim; d++)
                deep = deep && s.b.cloud.x[i * dim + d] > 6 * cell_side
                       && s.b.cloud.x[i * dim + d] < 11 * cell_side;
            for (size_t d = 0; deep && d < dim; d++) check_scaled (f[i*dim + d], g[i*dim + d], 1e-13, size);
            inside += (size_t) deep;
        }
        assert_true (inside >= 25);
        pg_bond_loop_free (&state), pg_bond_loop_free (&bonds);
        pg_free (f), pg_free (g);
        solid_free (&s);
    }
}

static void test_refusals (void **unused)
{
    (void) unused;
    body_wish line = { .count = { 20, 1, 1 }, .dim = 1, .m = 3, .partial = PG_PARTIAL_OVERLAP },
              product = wishes[0], finite = wishes[0];
    product.surface = PG_SURFACE_PRODUCT, finite.finite = 1;
    const body_wish *const bad[] = { &line, &product, &finite };
    for (int k = 0; k < 3; k++) {
        solid s;
        pg_bond_loop *sweep = NULL;
        solid_create (&s, bad[k], 0, 0, 0, 0.3, 1);
        assert_int_equal (pg_bond_loop_create (&sweep, &s.setting), PG_E_USAGE);
        solid_free (&s);
    }
    solid s;
    pg_bond_loop *sweep = NULL;
    for (int list = 0; list < 3; list++) {
        solid_create (&s, &wishes[3], 0, 0, 0, 0.3, 1);
        s.b.sums->rule.evaluation = list == 2 ? PG_EVALUATE_FFT
                                    : list    ? PG_EVALUATE_LIST
                                              : PG_EVALUATE_STENCIL;
        pg_status now = PG_E_MEMORY;
        for (size_t k = 1; now == PG_E_MEMORY; k++) {
            assert_true (k < 200);
            pg_memory_fail_at (k);
            now = pg_bond_loop_create (&sweep, &s.setting);
            if (now != PG_OK) assert_null (sweep);
        }
        pg_memory_fail_at (0);
        assert_int_equal (now, PG_OK);
        pg_bond_loop_free (&sweep);
        solid_free (&s);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_against_definition),
        cmocka_unit_test (test_transforms),
        cmocka_unit_test (test_breaking),
        cmocka_unit_test (test_motions),
        cmocka_unit_test (test_bonds),
        cmocka_unit_test (test_refusals),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
