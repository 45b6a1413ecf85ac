/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds: constants, one bond against the beam's 12 x 12 matrix, energies of a lattice, turned
 * bodies (theory G1 to G3; rows G-1 to G-6). */
#include "check.h"
#include "perigal/sums.h"
#include <stdlib.h>

static const double pi = 3.14159265358979323846264338327950288;
static const pg_mode modes[] = { PG_SOLID, PG_PLANE_STRESS, PG_PLANE_STRAIN };

static void test_constants (void **unused)
{
    (void) unused;
    const pg_kernel *one = pg_kernel_find ("constant");
    double N, t, d = 3.015;
    check_ok (pg_beam_moduli (&N, &t, PG_SOLID, one, d, 1, 0.2, 1));
    check_relative (N, 3.85213e-2, 1e-5);
    check_relative (t, 2.43172e-3, 1e-5);
    check_ok (pg_beam_moduli (&N, &t, PG_PLANE_STRESS, one, d, 1, 0.2, 0.5));
    check_relative (N, 6 / (pi * 0.5 * d * d * d * 0.8), 1e-12);
    check_relative (t, 0.4 / (6 * pi * 0.5 * d * 0.96), 1e-12);
    check_ok (pg_beam_moduli (&N, &t, PG_PLANE_STRAIN, one, d, 1, 0.2, 0.5));
    check_relative (N, 6 / (pi * 0.5 * d * d * d * 1.2 * 0.6), 1e-12);
    check_relative (t, 0.2 / (6 * pi * 0.5 * d * 1.2 * 0.6), 1e-12);
    for (int m = 0; m < 3; m++) {                      /* bonds that bear no shear are those of pair forces */
        double most = pg_beam_poisson (modes[m]);
        check_relative (most, pg_bond_poisson (modes[m]), 1e-15);
        check_ok (pg_beam_moduli (&N, &t, modes[m], one, d, 2, most, 0.7));
        check_relative (N, pg_bond_modulus (modes[m], one, d, 2, 0.7), 1e-12);
        assert_true (t == 0);
        check_fails (pg_beam_moduli (&N, &t, modes[m], one, d, 2, most + 1e-3, 0.7), PG_E_USAGE);
        check_contains (pg_last_error (), "at most");
        check_fails (pg_beam_moduli (&N, &t, modes[m], one, d, 2, -1, 0.7), PG_E_USAGE);
    }
    check_fails (pg_beam_moduli (&N, &t, PG_LINE, one, d, 2, 0, 1), PG_E_USAGE);
    check_fails (pg_beam_moduli (&N, &t, PG_PLANE_STRESS, pg_kernel_find ("inverse_r"), d, 2, 0.1, 1),
                 PG_E_USAGE);
    check_ok (pg_beam_moduli (&N, &t, PG_SOLID, pg_kernel_find ("inverse_r"), d, 2, 0.1, 1));
}

/* Energy of a uniform strain without rotation, by quadrature over the ball, is the material's. */
static void test_uniform_strain (void **unused)
{
    (void) unused;
    static const char *const kernels[] = { "constant", "quadratic", "conical", "linear_r" };
    static const double e[3][3] = { { 0.7, 0.3, -0.2 }, { 0.3, -0.4, 0.5 }, { -0.2, 0.5, 0.9 } };
    for (int m = 0; m < 3; m++)
        for (int q = 0; q < 4; q++) {
            const pg_kernel *kernel = pg_kernel_find (kernels[q]);
            enum { RINGS = 64, TURNS = 40 };
            double N, t, d = 1.3, E = 3, nu = 0.15, W = 0, trace = 0, square = 0,
                         thick = modes[m] == PG_SOLID ? 1 : 0.2;
            double lambda = modes[m] == PG_PLANE_STRESS ? E * nu / (1 - nu * nu)
                                                        : E * nu / ((1 + nu) * (1 - 2 * nu));
            int dim = modes[m] == PG_SOLID ? 3 : 2;
            check_ok (pg_beam_moduli (&N, &t, modes[m], kernel, d, E, nu, thick));
            for (int a = 0; a < dim; a++) {
                trace += e[a][a];
                for (int b = 0; b < dim; b++) square += e[a][b] * e[a][b];
            }
            double radial = d * d * d * d * pg_kernel_moment (kernel, 3),
                   across = d * d * pg_kernel_moment (kernel, 1);
            if (dim == 2)
                radial = d * d * d * pg_kernel_moment (kernel, 2), across = d * pg_kernel_moment (kernel, 0);
            for (int a = 0; a < (dim == 3 ? RINGS : 1); a++)
                for (int b = 0; b < TURNS; b++) {
                    double z = dim == 3 ? cos (pi * (a + 0.5) / RINGS) : 0, rest = sqrt (1 - z * z),
                           phi = 2 * pi * b / TURNS;
                    /* Fejer's rule in z: exact for polynomials */
                    double weight = 1, n[3] = { rest * cos (phi), rest * sin (phi), z }, v[3] = { 0 },
                           along = 0, all = 0;
                    for (int k = 1; dim == 3 && k <= RINGS / 2; k++)
                        weight -= 2 * cos (2 * k * pi * (a + 0.5) / RINGS) / (4.0 * k * k - 1);
                    weight *= dim == 3 ? 2.0 / RINGS * 2 * pi / TURNS : 2 * pi / TURNS;
                    for (int c = 0; c < dim; c++)
                        for (int k = 0; k < dim; k++) v[c] += e[c][k] * n[k];
                    for (int c = 0; c < dim; c++) along += v[c] * n[c], all += v[c] * v[c];
                    W += 0.25 * thick * weight
                         * (N * radial * along * along + 12 * t * across * (all - along * along));
                }
            check_relative (W, 0.5 * lambda * trace * trace + E / (2 * (1 + nu)) * square, 1e-9);
        }
}

/* ---- one bond ------------------------------------------------------------------------------------------ */
static void beam_matrix (double r, double CN, double Ct, double CM, double *K)
{
    static const int plane[2][4] = { { 1, 5, 7, 11 }, { 2, 4, 8, 10 } };
    double a = 12 * Ct / (r * r * r), b = 6 * Ct / (r * r), c = 4 * CM / r, f = 2 * (3 * Ct - 2 * CM) / r;
    memset (K, 0, 144 * sizeof *K);
    K[0] = K[6 * 12 + 6] = CN / r, K[6] = K[6 * 12] = -CN / r;
    for (int p = 0; p < 2; p++) {
        double s = p ? -b : b,
               part[4][4] = { { a, s, -a, s }, { s, c, -s, f }, { -a, -s, a, -s }, { s, f, -s, c } };
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++) K[plane[p][i] * 12 + plane[p][j]] = part[i][j];
    }
}

static void frame_of (const double *xi, double T[3][3])
{
    double r = sqrt (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]), size = 0;
    int k = 0;
    for (int a = 0; a < 3; a++) T[0][a] = xi[a] / r;
    for (int a = 1; a < 3; a++) if (fabs (T[0][a]) < fabs (T[0][k])) k = a;
    T[1][k] = 0, T[1][(k + 1) % 3] = T[0][(k + 2) % 3], T[1][(k + 2) % 3] = -T[0][(k + 1) % 3];
    for (int a = 0; a < 3; a++) size += T[1][a] * T[1][a];
    for (int a = 0; a < 3; a++) T[1][a] /= sqrt (size);
    for (int a = 0; a < 3; a++)
        T[2][a] = T[0][(a + 1) % 3] * T[1][(a + 2) % 3] - T[0][(a + 2) % 3] * T[1][(a + 1) % 3];
}

/* Blocks in unknowns u and length theta, against T' K T with theta itself (G-2, G-3, G-6). */
static void test_beam (void **unused)
{
    (void) unused;
    double CN = 2, Ct = 1, ratios[] = { 0.75, 1, 0.5, 1.1 };
    static const double xis[][3] = { { 1.1, 0.9, 0 }, { 0.3, -0.5, 1.2 }, { 0, 0, -0.8 } };
    for (int q = 0; q < 4; q++)
        for (int x = 0; x < 3; x++) {
            const double *xi = xis[x];
            double K[144], L[144] = { 0 }, T[3][3], own[36], other[36], length = 0.37,
                           r = sqrt (xi[0] * xi[0] + xi[1] * xi[1] + xi[2] * xi[2]);
            double CM = ratios[q] * Ct, lambda[12];
            beam_matrix (r, CN, Ct, CM, K);
            pg_dense_eigen (12, K, lambda, NULL);
            int zero = 0;
            for (int k = 0; k < 12; k++) zero += fabs (lambda[k]) < 1e-12;
            if (q < 2) assert_int_equal (zero, q ? 7 : 9);
            if (q == 2 && x == 0)
                check_relative (r * r, 2.02, 1e-12), check_absolute (lambda[11], -1.4072, 1e-4);
            frame_of (xi, T);
            for (int i = 0; i < 12; i++)
                for (int j = 0; j < 12; j++)
                    for (int a = 0; a < 3; a++)
                        for (int b = 0; b < 3; b++)
                            L[i * 12 + j] += T[a][i % 3] * K[(i / 3 * 3 + a) * 12 + j / 3 * 3 + b]
                                             * T[b][j % 3];
            pg_beam beam = { 12 * Ct / (r * r * r), CN / r, (4 * CM - 3 * Ct) / r / (length * length) };
            pg_beam_blocks (3, xi, &beam, length, own, other);
            for (int i = 0; i < 6; i++)
                for (int j = 0; j < 6; j++) {
                    double unit = (i < 3 ? 1 : length) * (j < 3 ? 1 : length);
                    check_scaled (own[i * 6 + j] * unit, L[i * 12 + j], 1e-14, 10);
                    check_scaled (other[i * 6 + j] * unit, L[i * 12 + 6 + j], 1e-14, 10);
                }
            double turn[3] = { 0.3, -1.1, 0.7 }, di[6], dj[6] = { 0 }, gamma, kappa;  /* a rigid rotation */
            for (int a = 0; a < 3; a++) {
                di[a] = 0, di[3 + a] = dj[3 + a] = length * turn[a];
                dj[a] = turn[(a + 1) % 3] * xi[(a + 2) % 3] - turn[(a + 2) % 3] * xi[(a + 1) % 3];
            }
            for (int i = 0; i < 6; i++) {
                double f = 0;
                for (int j = 0; j < 6; j++) f += own[i * 6 + j] * di[j] + other[i * 6 + j] * dj[j];
                check_absolute (f, 0, 1e-13 * 40);
            }
            pg_beam_strain (3, xi, length, di, dj, &gamma, &kappa);
            check_absolute (gamma, 0, 1e-14), check_absolute (kappa, 0, 1e-14);
        }
}

/* Springs of one bond between unlike ends: of two moduli in a row each bears half the length, 2 a b / (a +
 * b); lengths across go with the mean of both spacings, twice. */
static void test_unlike_ends (void **unused)
{
    (void) unused;
    double x[4] = { 0, 0, 0.3, 0.4 }, volume[2] = { 0.02, 0.05 }, size[2] = { 0.1, 0.3 },
           modulus[2] = { 8, 24 }, shear[2] = { 3, 1 }, bending[2] = { 5, 0 };
    pg_cloud cloud = { .dim = 2, .n = 2, .h = 0.1, .thickness = 1, .x = x, .volume = volume };
    pg_sums sums = { .cloud = &cloud };
    pg_beam_law law = { .shear = shear, .bending = bending, .length = 0.7 };
    pg_bond_loop_setting s = { .sums = &sums, .modulus = modulus, .beams = &law };
    for (int graded = 0; graded < 2; graded++) {
        cloud.size = graded ? size : NULL;
        double all = 6 * 0.02 * 0.05 / 0.5, wide = all * (graded ? 4 : 1), xi[3] = { 0.3, 0.4, 0 };
        pg_beam b = pg_beam_between (&s, 0, 1, xi, 6);
        check_relative (b.along, 2 * 8 * 24 / 32.0 * all, 1e-14);
        check_relative (b.shear, 12 * (2 * 3 * 1 / 4.0) * wide / 0.25, 1e-14);
        assert_true (b.bending == 0);
        bending[1] = 5;
        b = pg_beam_between (&s, 1, 0, (double[3]) { -0.3, -0.4, 0 }, 6);
        check_relative (b.bending, 5 * wide / 0.49, 1e-14);
        bending[1] = 0;
    }
}

/* ---- lattices ------------------------------------------------------------------------------------------ */
typedef struct {
    pg_cloud cloud;
    pg_sums *sums;
    pg_family family;
    pg_bond_loop *sweep;
    double *modulus, *shear, *bending;
    pg_beam_law law;
    double *d, *f, *W;
    int m;
} field;

static void field_create (field *b, int dim, int side, double scatter, double turned, pg_sum_rule rule,
                          double nu, double ratio, const char *instructions)
{
    unsigned seed = 7;
    memset (b, 0, sizeof *b);
    pg_cloud *c = &b->cloud;
    c->dim = dim, c->h = 1, c->thickness = dim == 2 ? 0.5 : 1, c->n = 1, b->m = dim == 2 ? 3 : 6;
    for (int k = 0; k < dim; k++) c->n *= (size_t) side, c->step[k] = 1;
    c->x = pg_calloc (c->n * (size_t) dim, sizeof *c->x), c->volume = pg_calloc (c->n, sizeof *c->volume);
    for (size_t i = 0; i < c->n; i++) {
        size_t rest = i;
        double *x = c->x + i * (size_t) dim;
        c->volume[i] = c->thickness;
        for (int k = 0; k < dim; k++, rest /= (size_t) side) {
            seed = seed * 1664525u + 1013904223u;
            x[k] = (double) (rest % (size_t) side) + scatter * ((seed >> 8) / 16777216.0 - 0.5);
        }
        double u = x[0], v = x[1];
        x[0] = cos (turned) * u - sin (turned) * v, x[1] = sin (turned) * u + cos (turned) * v;
    }
    check_ok (pg_sums_create (&b->sums, &rule, c, NULL));
    check_ok (pg_sums_family (&b->family, b->sums, NULL));
    pg_beam_sums sums;
    check_ok (pg_beam_measure (&sums, b->sums));
    double **of[] = { &b->modulus, &b->shear, &b->bending };
    for (int k = 0; k < 3; k++) *of[k] = pg_calloc (c->n, sizeof **of[k]);
    for (size_t i = 0; i < c->n; i++) {
        check_ok (pg_beam_moduli (&b->modulus[i], &b->shear[i], rule.mode, rule.kernel, rule.horizon, 1, nu,
                                  c->thickness));
        b->modulus[i] *= b->sums->calibration, b->shear[i] *= sums.calibration,
            b->bending[i] = ratio * b->shear[i];
    }
    b->law = (pg_beam_law) { .shear = b->shear, .bending = b->bending, .length = 0.7 };
    pg_bond_loop_setting s = { .sums = b->sums,
                               .family = &b->family,
                               .modulus = b->modulus,
                               .beams = &b->law,
                               .threads = 1,
                               .instructions = instructions };
    if (!instructions) check_ok (pg_bond_loop_create (&b->sweep, &s));
    else if (pg_bond_loop_create (&b->sweep, &s) != PG_OK)
        b->sweep = NULL, assert_string_not_equal (instructions, "scalar");
    b->d = pg_calloc (c->n * (size_t) b->m, sizeof *b->d),
    b->f = pg_calloc (c->n * (size_t) b->m, sizeof *b->f), b->W = pg_calloc (c->n, sizeof *b->W);
}

static void field_free (field *b)
{
    pg_bond_loop_free (&b->sweep), pg_family_clear (&b->family), pg_sums_free (&b->sums);
    void *all[] = { b->cloud.x, b->cloud.volume, b->modulus, b->shear, b->bending, b->d, b->f, b->W };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
}

static pg_sum_rule rule_of (pg_mode mode, pg_partial partial, int calibrate, pg_evaluation evaluation)
{
    return (pg_sum_rule){ .mode = mode,
                          .kernel = pg_kernel_find ("constant"),
                          .horizon = 3.015,
                          .partial = partial,
                          .calibrate = calibrate,
                          .beams = 1,
                          .evaluation = evaluation };
}

static double energy_at_centre (field *b, const double *e)
{
    int dim = b->cloud.dim;
    for (size_t i = 0; i < b->cloud.n; i++)
        for (int a = 0; a < dim; a++) {
            b->d[i * (size_t) b->m + (size_t) a] = 0;
            for (int k = 0; k < dim; k++)
                b->d[i * (size_t) b->m + (size_t) a] += e[a * dim + k]
                                                        * b->cloud.x[i * (size_t) dim + (size_t) k];
        }
    check_ok (pg_bond_loop_energies (b->sweep, b->d, b->W));
    return b->W[b->cloud.n / 2];
}

/* G-4 (nu = 0.2), G-5; with calibration hydrostatic strain is exact and shear about the horizon's sphere
 * comes near. */
static void test_lattice (void **unused)
{
    (void) unused;
    static const double uniaxial[9] = { 1 }, hydro[9] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 },
                        shear[9] = { 0, 0.5, 0, 0.5 };
    double nu = 0.2, lambda = nu / ((1 + nu) * (1 - 2 * nu)), mu = 0.5 / (1 + nu);
    field b;
    for (int list = 0; list < 2; list++) {
        field_create (&b, 3, 7, 0, 0,
                      rule_of (PG_SOLID, PG_PARTIAL_NONE, 0, list ? PG_EVALUATE_LIST : PG_EVALUATE_STENCIL),
                      nu, 1, NULL);
        assert_string_equal (list ? "list" : "stencil",
                             strncmp (pg_bond_loop_name (b.sweep), "list", 4) ? "stencil" : "list");
        check_absolute (energy_at_centre (&b, uniaxial) / (0.5 * lambda + mu), 1.03055, 1e-5);
        check_absolute (energy_at_centre (&b, hydro) / (4.5 * lambda + 3 * mu), 1.09871, 1e-5);
        check_absolute (energy_at_centre (&b, shear) / (0.5 * mu), 1.15530, 1e-5);
        memset (b.d, 0, b.cloud.n * 6 * sizeof *b.d);
        for (size_t i = 0; i < b.cloud.n; i++) b.d[6 * i + 3] = b.law.length;  /* all points turn alike */
        check_ok (pg_bond_loop_force (b.sweep, b.d, b.f, NULL));
        check_absolute (-b.f[6 * (b.cloud.n / 2) + 3] * b.law.length, 0.5532, 1e-4);
        field_free (&b);
    }
    field_create (&b, 3, 9, 0, 0, rule_of (PG_SOLID, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_AUTO), nu, 1, NULL);
    check_relative (energy_at_centre (&b, hydro), 4.5 * lambda + 3 * mu, 1e-12);
    check_relative (energy_at_centre (&b, shear), 0.5 * mu, 0.02);
    check_relative (energy_at_centre (&b, uniaxial), 0.5 * lambda + mu, 0.02);
    field_free (&b);
    lambda = nu / (1 - nu * nu);
    static const double both[4] = { 1, 0, 0, 1 }, slide[4] = { 0, 0.5, 0.5, 0 };
    field_create (&b, 2, 9, 0, 0, rule_of (PG_PLANE_STRESS, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_AUTO), nu, 1,
                  NULL);
    check_relative (energy_at_centre (&b, both), 2 * lambda + 2 * mu, 1e-12);
    check_relative (energy_at_centre (&b, slide), 0.5 * mu, 0.03);
    field_free (&b);
}

/* G-4 beyond the limit, where moduli are refused: why. 12 C_t sum (y^2 + z^2) / (2 r^3) of the lattice */
static void test_unstable (void **unused)
{
    (void) unused;
    static const double nu[] = { 0.2, 0.3, 0.4 }, expected[] = { 0.5532, -0.7660, -4.2679 };
    double d = 3.015;
    for (int k = 0; k < 3; k++) {
        double Ct = (1 - 4 * nu[k]) / (4 * pi * d * d * (1 + nu[k]) * (1 - 2 * nu[k])), sum = 0;
        for (int x = -3; x <= 3; x++)
            for (int y = -3; y <= 3; y++)
                for (int z = -3; z <= 3; z++) {
                    double rr = x * x + y * y + z * z;
                    if (rr > 0 && rr <= d * d) sum += 6 * Ct * (y * y + z * z) / (rr * sqrt (rr));
                }
        check_absolute (sum, expected[k], 1e-4);
    }
}

static double any (unsigned *seed)
{
    return (double) ((*seed = *seed * 1664525u + 1013904223u) >> 8) / 8388608.0 - 1;
}

/* All loops give the same sums; the same at every call. */
static void test_loops (void **unused)
{
    (void) unused;
    static const char *const sets[] = { "scalar", "avx2", "avx512" };
    for (int dim = 2; dim <= 3; dim++) {
        field list, b;
        pg_mode mode = dim == 3 ? PG_SOLID : PG_PLANE_STRAIN;
        field_create (&list, dim, dim == 3 ? 9 : 37, 0, 0,
                      rule_of (mode, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_LIST), 0.1, 1.7, NULL);
        unsigned seed = 3;
        size_t nbond = list.family.start[list.cloud.n], ndof = list.cloud.n * (size_t) list.m;
        unsigned char *alive = pg_calloc (nbond, 1);
        for (size_t i = 0; i < ndof; i++) list.d[i] = any (&seed);
        for (size_t i = 0; i < list.cloud.n; i++)
            for (size_t e = list.family.start[i]; e < list.family.start[i + 1]; e++)
                alive[e] = (i * (size_t) list.family.node[e] + i + (size_t) list.family.node[e]) % 5 != 0;
        pg_bond_loop_update (list.sweep, alive, NULL);
        check_ok (pg_bond_loop_force (list.sweep, list.d, list.f, NULL));
        check_ok (pg_bond_loop_energies (list.sweep, list.d, list.W));
        double size = 0, E = pg_bond_loop_energy (list.sweep, list.d), work = 0;
        for (size_t i = 0; i < ndof; i++)
            size = fmax (size, fabs (list.f[i])), work -= 0.5 * list.f[i] * list.d[i];
        check_relative (E, work, 1e-12);               /* forces are those of the energy */
        for (int k = 0; k < 3; k++) {
            field_create (&b, dim, dim == 3 ? 9 : 37, 0, 0,
                          rule_of (mode, PG_PARTIAL_OVERLAP, 1, PG_EVALUATE_STENCIL), 0.1, 1.7, sets[k]);
            if (!b.sweep) {                            /* this machine lacks the instructions */
                field_free (&b);
                continue;
            }
            check_contains (pg_bond_loop_name (b.sweep), "stencil");
            pg_bond_loop_update (b.sweep, alive, NULL);
            check_ok (pg_bond_loop_force (b.sweep, list.d, b.f, NULL));
            for (size_t i = 0; i < ndof; i++) check_scaled (b.f[i], list.f[i], 1e-13, size);
            check_ok (pg_bond_loop_energies (b.sweep, list.d, b.W));
            for (size_t i = 0; i < b.cloud.n; i++) check_relative (b.W[i], list.W[i], 1e-12);
            check_relative (pg_bond_loop_energy (b.sweep, list.d), E, 1e-12);
            field_free (&b);
        }
        pg_free (alive);
        field_free (&list);
    }
}

/* A body that is turned with its displacements and rotations has the same energy and turned forces. */
static void test_turned (void **unused)
{
    (void) unused;
    double angle = 0.7, c = cos (angle), s = sin (angle);
    for (int dim = 2; dim <= 3; dim++) {
        field a, b;
        pg_sum_rule rule = rule_of (dim == 3 ? PG_SOLID : PG_PLANE_STRESS, PG_PARTIAL_LINEAR, 1,
                                    PG_EVALUATE_AUTO);
        field_create (&a, dim, dim == 3 ? 6 : 12, 0.4, 0, rule, 0.15, 1, NULL);
        field_create (&b, dim, dim == 3 ? 6 : 12, 0.4, angle, rule, 0.15, 1, NULL);
        unsigned seed = 9;
        double size = 0;
        for (size_t i = 0; i < a.cloud.n; i++) {
            double *u = a.d + i * (size_t) a.m, *v = b.d + i * (size_t) a.m;
            for (int k = 0; k < a.m; k++) v[k] = u[k] = any (&seed);
            v[0] = c * u[0] - s * u[1], v[1] = s * u[0] + c * u[1];
            if (dim == 3) v[3] = c * u[3] - s * u[4], v[4] = s * u[3] + c * u[4];
        }
        check_relative (pg_bond_loop_energy (a.sweep, a.d), pg_bond_loop_energy (b.sweep, b.d), 1e-11);
        check_ok (pg_bond_loop_force (a.sweep, a.d, a.f, NULL));
        check_ok (pg_bond_loop_force (b.sweep, b.d, b.f, NULL));
        for (size_t i = 0; i < a.cloud.n * (size_t) a.m; i++) size = fmax (size, fabs (a.f[i]));
        for (size_t i = 0; i < a.cloud.n; i++) {
            const double *u = a.f + i * (size_t) a.m, *v = b.f + i * (size_t) a.m;
            check_scaled (v[0], c * u[0] - s * u[1], 1e-11, size),
                check_scaled (v[1], s * u[0] + c * u[1], 1e-11, size);
            check_scaled (v[2], u[2], 1e-11, size);
            if (dim == 3)
                check_scaled (v[3], c * u[3] - s * u[4], 1e-11, size),
                    check_scaled (v[4], s * u[3] + c * u[4], 1e-11, size),
                    check_scaled (v[5], u[5], 1e-11, size);
        }
        field_free (&a), field_free (&b);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_constants), cmocka_unit_test (test_uniform_strain),
        cmocka_unit_test (test_beam),      cmocka_unit_test (test_unlike_ends),
        cmocka_unit_test (test_lattice),   cmocka_unit_test (test_unstable),
        cmocka_unit_test (test_loops),     cmocka_unit_test (test_turned)
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
