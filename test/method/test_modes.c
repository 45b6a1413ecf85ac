/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zero-energy modes (theory D2, D3; table H D-2, D-3): of NOSB on a periodic lattice, and of K on free bodies for every
 * combination of approximation, integration and stabilisation. Rigid motions are 3 in two dimensions, 6 in three. */
#include "spectrum.h"

/* ---- periodic lattice --------------------------------------------------------------------------------------------------
 * n x n nodes of spacing h among their eight images; rows of the middle copy, whose columns map back onto the n x n nodes. */
typedef struct { size_t n; pg_cloud images; int *home; pg_rows rows; } periodic;

static periodic wrap (size_t n, double h, double horizon)
{
    periodic p = { .n = n };
    size_t side = 3 * n, at = 0;
    p.images = (pg_cloud) { .dim = 2, .n = side * side, .h = h, .step = { h, h, h }, .thickness = 1 };
    p.images.x = pg_calloc (2 * side * side, sizeof (double));
    p.images.volume = pg_calloc (side * side, sizeof (double));
    p.home = pg_calloc (side * side, sizeof *p.home);
    double *x = pg_calloc (2 * n * n, sizeof *x), *weight = pg_calloc (n * n, sizeof *weight);
    int *own = pg_calloc (n * n, sizeof *own);
    for (size_t b = 0; b < side; b++)
        for (size_t a = 0; a < side; a++) {
            size_t i = b * side + a;
            p.images.x[2*i] = h * (double) a, p.images.x[2*i + 1] = h * (double) b;
            p.images.volume[i] = h * h;
            p.home[i] = (int) (b % n * n + a % n);
            if (a / n != 1 || b / n != 1) continue;
            x[2*at] = p.images.x[2*i], x[2*at + 1] = p.images.x[2*i + 1];
            weight[at] = h * h, own[at++] = (int) i;
        }
    pg_approx approx = { pg_approx_find ("nosb"), pg_kernel_find ("constant"), 1, PG_RADIAL, 1, horizon };
    check_ok (pg_rows_create (&p.rows, &approx, &p.images, at, x, weight, own, NULL));
    check_ok (approx.type->evaluate (&approx, &p.images, &p.rows, NULL, at, NULL, 1));
    assert_int_equal (pg_rows_count (&p.rows, PG_GRADE_FULL), n * n);
    pg_free (x), pg_free (weight), pg_free (own);
    return p;
}

static void unwrap (periodic *p)
{
    pg_rows_clear (&p->rows);
    pg_free (p->images.x), pg_free (p->images.volume), pg_free (p->home);
}

/* block (2 x 2) = B_a' D B_b, plane stress */
static void elastic_block (const double *D, const double *qa, const double *qb, double *block)
{
    double Ba[3][2] = { { qa[0], 0 }, { 0, qa[1] }, { qa[1], qa[0] } }, Bb[3][2] = { { qb[0], 0 }, { 0, qb[1] }, { qb[1], qb[0] } };
    for (int r = 0; r < 2; r++)
        for (int c = 0; c < 2; c++)
            for (int v = 0; v < 3; v++)
                for (int w = 0; w < 3; w++) block[r*2 + c] += Ba[v][r] * D[v*3 + w] * Bb[w][c];
}

/* Eigenvalues per volume of the periodic lattice, E = 1, nu = 0.3, plane stress; Gs = 0: not stabilised. */
static void periodic_spectrum (size_t n, double h, double horizon, double Gs, double *lambda)
{
    periodic p = wrap (n, h, horizon);
    size_t ndof = 2 * n * n;
    double D[9], V = h * h, mu = 1 / 2.6, *K = pg_calloc (ndof * ndof, sizeof *K), block[4 * 64];
    pg_elastic_tangent (PG_PLANE_STRESS, 1, 0.3, D);
    for (size_t q = 0; q < n * n; q++) {
        size_t first = p.rows.family.start[q], m = p.rows.family.start[q + 1] - first;
        assert_true (m <= 64);
        for (size_t a = 0; a < m; a++) {
            memset (block, 0, sizeof block);
            for (size_t b = 0; b < m; b++) {
                elastic_block (D, p.rows.dN + 2 * (first + a), p.rows.dN + 2 * (first + b), block + 4*b);
                for (int k = 0; k < 4; k++) block[4*b + (size_t) k] *= V;
            }
            if (Gs > 0) pg_silling_add (&p.rows, &p.images, q, a, m, Gs * mu, V, block);
            size_t i = (size_t) p.home[p.rows.family.node[first + a]];
            for (size_t b = 0; b < m; b++) {
                size_t j = (size_t) p.home[p.rows.family.node[first + b]];
                for (size_t k = 0; k < 4; k++) K[(2*i + k / 2) * ndof + 2*j + k % 2] += block[4*b + k] / V;
            }
        }
    }
    eigenvalues (ndof, K, lambda);
    pg_free (K);
    unwrap (&p);
}

static void periodic_nosb_has_eight_zero_modes (void **state)
{
    (void) state;
    double lambda[128];
    periodic_spectrum (8, 1, 3.015, 0, lambda);
    assert_int_equal (count_zero (128, lambda, 1e-12), 8);
    assert_true (lambda[8] > 1e-6 * lambda[127]);
}

static void silling_leaves_two_translations (void **state)
{
    (void) state;
    double lambda[128];
    for (double Gs = 0.05; Gs <= 1; Gs *= 2) {
        periodic_spectrum (8, 1, 3.015, Gs, lambda);
        assert_int_equal (count_zero (128, lambda, 1e-12), 2);
        assert_true (lambda[2] > 1e-3 * lambda[127]);
    }
}

/* Per volume, and eigenvalues of K / V have the unit E / h^2: 2 mm lattice as well. */
static void silling_smallest_eigenvalue (void **state)
{
    (void) state;
    double lambda[128];
    periodic_spectrum (8, 1, 3.015, 0.1, lambda);
    check_relative (lambda[2], 0.10860, 1e-4);
    periodic_spectrum (8, 2e-3, 3.015 * 2e-3, 0.1, lambda);
    check_relative (lambda[2] * 4e-6, 0.10860, 1e-4);
    periodic_spectrum (8, 1, 1.5, 0.1, lambda);
    check_relative (lambda[2], 0.206, 0.0005 / 0.206);
}

/* ---- free bodies ------------------------------------------------------------------------------------------------------- */
typedef struct { int dim; const char *what, *method; size_t zero; double next; } body;

/* Counts the zero modes of a free 6 x 6 or 4 x 4 x 4 lattice of nodes; next: the first eigenvalue that is not, over the largest. */
static void count_modes (body *b)
{
    char text[512];
    snprintf (text, sizeof text, "dimension: %d\nbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: 1 mm\n"
              "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\nmethod: {%s}\n", b->dim,
              b->dim == 2 ? "[0, 0]" : "[0, 0, 0]", b->dim == 2 ? "[15 mm, 15 mm]" : "[3 mm, 3 mm, 3 mm]", b->method);
    assembled a = assemble (text, "modes.yaml");
    assert_int_equal (a.ndof, b->dim == 2 ? 512 : 192);
    double *K = dense_stiffness (&a), *lambda = pg_calloc (a.ndof, sizeof *lambda);
    eigenvalues (a.ndof, K, lambda);
    b->zero = count_zero (a.ndof, lambda, 1e-10);
    b->next = lambda[b->zero] / lambda[a.ndof - 1];
    print_message ("# %dD %-34s %3zu zero modes, next eigenvalue %.3e of the largest\n", b->dim, b->what, b->zero, b->next);
    assert_true (lambda[0] >= -1e-12 * lambda[a.ndof - 1]);
    pg_free (K), pg_free (lambda);
    release (&a);
}

#define NOSB "approximation: nosb, integration: nodal, kernel: constant, horizon: 3.015 spacing, stabilization: "
#define NOSB_NEAR "approximation: nosb, integration: nodal, kernel: constant, horizon: 1.5 spacing, stabilization: "
#define RKPM "approximation: rkpm, kernel: cubic_spline, horizon: 2.0 spacing, integration: "

static void only_rigid_motions (int dim, const char *what, const char *method)
{
    body b = { dim, what, method, 0, 0 };
    count_modes (&b);
    assert_int_equal (b.zero, dim == 2 ? 3 : 6);
    assert_true (b.next > 1e-4);
}

static void rkpm_gauss_has_rigid_motions_only (void **state)
{
    (void) state;
    only_rigid_motions (2, "RKPM, 2 x 2 Gauss", RKPM "gauss");
    only_rigid_motions (3, "RKPM, 2 x 2 x 2 Gauss", RKPM "gauss");
}

static void stabilised_nosb_has_rigid_motions_only (void **state)
{
    (void) state;
    only_rigid_motions (2, "NOSB m = 3.015, Silling", NOSB "silling");
    only_rigid_motions (3, "NOSB m = 3.015, Silling", NOSB "silling");
    only_rigid_motions (2, "NOSB m = 1.5, Silling", NOSB_NEAR "silling");
    only_rigid_motions (3, "NOSB m = 1.5, Silling", NOSB_NEAR "silling");
}

static void nodal_integration_alone_is_weaker (void **state)
{
    (void) state;
    body table[] = { { 2, "NOSB m = 3.015, not stabilised", NOSB "none", 0, 0 }, { 2, "NOSB m = 1.5, not stabilised", NOSB_NEAR "none", 0, 0 },
                     { 2, "RKPM, nodal", RKPM "nodal", 0, 0 }, { 3, "NOSB m = 3.015, not stabilised", NOSB "none", 0, 0 },
                     { 3, "NOSB m = 1.5, not stabilised", NOSB_NEAR "none", 0, 0 }, { 3, "RKPM, nodal", RKPM "nodal", 0, 0 } };
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        count_modes (&table[k]);

    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (periodic_nosb_has_eight_zero_modes),
        cmocka_unit_test (silling_leaves_two_translations),
        cmocka_unit_test (silling_smallest_eigenvalue),
        cmocka_unit_test (rkpm_gauss_has_rigid_motions_only),
        cmocka_unit_test (stabilised_nosb_has_rigid_motions_only),
        cmocka_unit_test (nodal_integration_alone_is_weaker),
    };
    return cmocka_run_group_tests_name ("method/modes", tests, NULL, NULL);
}
