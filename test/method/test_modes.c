/* SPDX-License-Identifier: GPL-3.0-or-later
 * Zero-energy modes (theory D2, D3; table H D-2, D-3): of NOSB on a periodic lattice, and of K on free bodies
 * for every combination of approximation, integration and stabilisation. Rigid motions are 3 in two
 * dimensions, 6 in three. */
#include "spectrum.h"

/* ---- periodic lattice
 * -------------------------------------------------------------------------------------------------- n^dim
 * nodes of spacing h among their images; rows of the middle copy, whose columns map back onto the n^dim
 * nodes. */
enum { MOST = 128, FAMILY = 64 };
typedef struct { int dim; size_t n, count; pg_cloud images; int *home; pg_rows rows; } periodic;

static size_t cube (size_t n, int dim) { return dim == 3 ? n * n * n : n * n; }

static periodic wrap (int dim, size_t n, double h, double horizon)
{
    periodic p = { .dim = dim, .n = n, .count = cube (n, dim) };
    size_t side = 3 * n, all = cube (side, dim), at = 0, d = (size_t) dim;
    p.images = (pg_cloud) { .dim = dim, .n = all, .h = h, .step = { h, h, h }, .thickness = 1 };
    p.images.x = pg_calloc (d * all, sizeof (double));
    p.images.volume = pg_calloc (all, sizeof (double));
    p.home = pg_calloc (all, sizeof *p.home);
    double *x = pg_calloc (d * p.count, sizeof *x);
    int *own = pg_calloc (p.count, sizeof *own);
    for (size_t i = 0; i < all; i++) {
        size_t rest = i, home = 0, middle = 1;
        for (size_t k = 0, stride = 1; k < d; k++, rest /= side, stride *= n) {
            p.images.x[d*i + k] = h * (double) (rest % side);
            home += rest % side % n * stride;
            middle &= rest % side / n == 1;
        }
        p.images.volume[i] = pow (h, dim);
        p.home[i] = (int) home;
        if (!middle) continue;
        memcpy (x + d * at, p.images.x + d * i, d * sizeof *x);
        own[at++] = (int) i;
    }
    pg_approx approx = {
        pg_approx_find ("nosb"), pg_kernel_find ("constant"), 1, PG_RADIAL, 1, horizon, 0, 0, 0, 0
    };
    check_ok (pg_rows_create (&p.rows, &approx, &p.images, at, x, NULL, own, NULL));
    check_ok (approx.type->evaluate (&approx, &p.images, &p.rows, NULL, at, NULL, 1));
    assert_int_equal (pg_rows_count (&p.rows, PG_GRADE_FULL), p.count);
    pg_free (x), pg_free (own);
    return p;
}

static void unwrap (periodic *p)
{
    pg_rows_clear (&p->rows);
    pg_free (p->images.x), pg_free (p->images.volume), pg_free (p->home);
}

/* block (dim x dim) += B_a' D B_b; isotropic: lambda q_a q_b' + mu (q_b q_a' + q_a.q_b I) */
static void elastic_block (int dim, double lambda, double mu, const double *qa, const double *qb,
                           double *block)
{
    double dot = 0;
    for (int k = 0; k < dim; k++) dot += qa[k] * qb[k];
    for (int r = 0; r < dim; r++)
        for (int c = 0; c < dim; c++)
            block[r * dim + c] += lambda * qa[r] * qb[c] + mu * (qb[r] * qa[c] + (r == c) * dot);
}

/* Eigenvalues per volume of the periodic lattice, E = 1, nu = 0.3, plane stress in 2D; Gs = 0: not
 * stabilised. */
static size_t periodic_spectrum (int dim, size_t n, double h, double horizon, double Gs, double *eigenvalue)
{
    periodic p = wrap (dim, n, h, horizon);
    size_t d = (size_t) dim, ndof = d * p.count, dd = d * d;
    double V = pow (h, dim), mu = 1 / 2.6, lambda = dim == 2 ? 0.3 / 0.91 : 0.3 / (1.3 * 0.4),
           block[9 * FAMILY];
    double *K = pg_calloc (ndof * ndof, sizeof *K);
    for (size_t q = 0; q < p.count; q++) {
        size_t first = p.rows.family.start[q], m = p.rows.family.start[q + 1] - first;
        assert_true (m <= FAMILY);
        for (size_t a = 0; a < m; a++) {
            memset (block, 0, sizeof block);
            for (size_t b = 0; b < m; b++)
                elastic_block (dim, V * lambda, V * mu, p.rows.dN + d * (first + a),
                               p.rows.dN + d * (first + b), block + dd * b);
            if (Gs > 0) pg_silling_add (&p.rows, &p.images, q, a, m, Gs * mu, V, block);
            size_t i = (size_t) p.home[p.rows.family.node[first + a]];
            for (size_t b = 0; b < m; b++) {
                size_t j = (size_t) p.home[p.rows.family.node[first + b]];
                for (size_t k = 0; k < dd; k++)
                    K[(d * i + k / d) * ndof + d * j + k % d] += block[dd * b + k] / V;
            }
        }
    }
    eigenvalues (ndof, K, eigenvalue);
    pg_free (K);
    unwrap (&p);
    return ndof;
}

/* ---- bond-associated correction (theory D3b), built here on the rows of the library: its own entry
 * `stabilization: bond_associated` is a later issue.
 * ----------------------------------------------------------------------- */
/* q (count x dim) of bond e from point i, H_ij = sum_l d_l (x) q_l: H_ij = Hbar + (eta - Hbar xi) (x) xi /
 * r^2, Hbar = (H_i + H_j) / 2; row number = node number, and an image has the H of its original. */
static void bond_slopes (const periodic *p, size_t i, size_t e, double *q)
{
    const pg_rows *r = &p->rows;
    size_t d = (size_t) p->dim, j = (size_t) p->home[r->family.node[e]], end[2] = { i, j };
    double xi[3], rr = 0;
    memset (q, 0, d * p->count * sizeof *q);
    for (int s = 0; s < 2; s++)
        for (size_t f = r->family.start[end[s]]; f < r->family.start[end[s] + 1]; f++)
            for (size_t k = 0; k < d; k++)
                q[d * (size_t) p->home[r->family.node[f]] + k] += r->dN[d * f + k] / 2;
    for (size_t k = 0; k < d; k++)
        xi[k] = p->images.x[d * (size_t) r->family.node[e] + k] - r->x[d * i + k], rr += xi[k] * xi[k];
    for (size_t l = 0; l < p->count; l++) {
        double rest = (double) (l == j) - (double) (l == i);
        for (size_t k = 0; k < d; k++) rest -= q[d*l + k] * xi[k];
        for (size_t k = 0; k < d; k++) q[d*l + k] += rest * xi[k] / rr;
    }
}

/* Eigenvalues per volume of W_i = sum_j (w_ij V_j / omega0_i) psi (sym H_ij), omega0_i = sum_j w_ij V_j; E =
 * 1, nu = 0.3, plane stress. */
static size_t bond_associated_spectrum (size_t n, double h, double horizon, double *eigenvalue)
{
    periodic p = wrap (2, n, h, horizon);
    size_t ndof = 2 * p.count;
    double *K = pg_calloc (ndof * ndof, sizeof *K), *q = pg_calloc (ndof, sizeof *q), block[4];
    for (size_t i = 0; i < p.count; i++) {
        size_t first = p.rows.family.start[i], last = p.rows.family.start[i + 1];
        double omega0 = 0;
        assert_int_equal (p.home[p.rows.own[i]], i);
        for (size_t e = first; e < last; e++)
            omega0 += p.rows.family.node[e] == p.rows.own[i] ? 0 : p.rows.w[e];
        for (size_t e = first; e < last; e++) {
            if (p.rows.family.node[e] == p.rows.own[i]) continue;
            double share = p.rows.w[e] / omega0;
            bond_slopes (&p, i, e, q);
            for (size_t a = 0; a < p.count; a++)
                for (size_t b = 0; b < p.count; b++) {
                    memset (block, 0, sizeof block);
                    elastic_block (2, share * 0.3 / 0.91, share / 2.6, q + 2*a, q + 2*b, block);
                    for (size_t k = 0; k < 4; k++) K[(2*a + k / 2) * ndof + 2*b + k % 2] += block[k];
                }
        }
    }
    eigenvalues (ndof, K, eigenvalue);
    pg_free (K), pg_free (q);
    unwrap (&p);
    return ndof;
}

/* ---- claims on the periodic lattice -------------------------------------------------------------------- */
static void periodic_nosb_has_eight_zero_modes (void **state)
{
    (void) state;
    double lambda[MOST];
    size_t n = periodic_spectrum (2, 8, 1, 3.015, 0, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 8);
    assert_true (lambda[8] > 1e-6 * lambda[n - 1]);
    /* (6 x 6 would meet the roots 1 + 2 cos k = 0 of this family: 16) */
    n = periodic_spectrum (2, 8, 1, 1.5, 0, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 8);
}

static void silling_leaves_two_translations (void **state)
{
    (void) state;
    double lambda[MOST];
    for (double Gs = 0.05; Gs <= 1; Gs *= 2) {
        size_t n = periodic_spectrum (2, 8, 1, 3.015, Gs, lambda);
        assert_int_equal (count_zero (n, lambda, 1e-12), 2);
        assert_true (lambda[2] > 1e-3 * lambda[n - 1]);
    }
}

static void in_space_there_are_24_and_three_are_left (void **state)
{
    (void) state;
    double lambda[3 * 64];
    size_t n = periodic_spectrum (3, 4, 1, 1.8, 0, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 24);
    n = periodic_spectrum (3, 4, 1, 1.8, 0.1, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 3);
    assert_true (lambda[3] > 1e-3 * lambda[n - 1]);
}

/* Theory D-3; eigenvalues of K / V have the unit E / h^2. */
static void silling_smallest_eigenvalue (void **state)
{
    (void) state;
    double lambda[MOST];
    periodic_spectrum (2, 8, 1, 3.015, 0.1, lambda);
    check_relative (lambda[2], 0.10860, 1e-4);
    periodic_spectrum (2, 8, 2e-3, 3.015 * 2e-3, 0.1, lambda);
    check_relative (lambda[2] * 4e-6, 0.10860, 1e-4);
    periodic_spectrum (2, 8, 1, 1.5, 0.1, lambda);
    check_relative (lambda[2], 0.206, 0.0005 / 0.206);
}

static void bond_associated_leaves_two_translations (void **state)
{
    (void) state;
    double lambda[MOST];
    size_t n = bond_associated_spectrum (8, 1, 3.015, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 2);
    assert_true (lambda[2] > 1e-2 * lambda[n - 1]);
    n = bond_associated_spectrum (8, 1, 1.5, lambda);
    assert_int_equal (count_zero (n, lambda, 1e-12), 2);
}

static void bond_associated_smallest_eigenvalue (void **state)
{
    (void) state;
    double lambda[MOST];
    bond_associated_spectrum (8, 1, 3.015, lambda);
    check_relative (lambda[2], 0.14390, 1e-4);
    bond_associated_spectrum (8, 2e-3, 3.015 * 2e-3, lambda);
    check_relative (lambda[2] * 4e-6, 0.14390, 1e-4);
}

/* ---- free bodies
 * ------------------------------------------------------------------------------------------------------- On
 * a free body the boundary stiffens what is a zero mode of the periodic lattice: such modes are soft, not
 * free. */
typedef struct { size_t n, zero; double *lambda; } spectrum;           /* per volume, in E / h^2 */

/* Nodes on a lattice of `cells` cells per axis; prints one line. */
static spectrum free_body (int dim, int cells, const char *what, const char *method)
{
    char text[512], high[64];
    snprintf (high, sizeof high, dim == 2 ? "[%d mm, %d mm]" : "[%d mm, %d mm, %d mm]", cells, cells, cells);
    snprintf (text, sizeof text,
              "dimension: %d\nbody: [{add: {box: {low: %s, high: %s}}}]\nspacing: 1 mm\n"
              "materials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.3}}\nmethod: {%s}\n",
              dim, dim == 2 ? "[0, 0]" : "[0, 0, 0]", high, method);
    assembled a = assemble (text, "modes.yaml");
    assert_int_equal (a.ndof, (size_t) dim * cube ((size_t) cells + 1, dim));
    double *K = dense_stiffness (&a), *V = a.problem->cloud.volume;
    spectrum s = { a.ndof, 0, pg_calloc (a.ndof, sizeof *s.lambda) };
    for (size_t i = 0; i < a.ndof; i++)
        for (size_t j = 0; j < a.ndof; j++)
            K[i * a.ndof + j] *= 1e-6 / (1e9 * sqrt (V[i / (size_t) dim] * V[j / (size_t) dim]));
    eigenvalues (a.ndof, K, s.lambda);
    s.zero = count_zero (s.n, s.lambda, 1e-10);
    print_message ("# %dD, %2d nodes a side, %-24s %zu zero modes, next eigenvalue %.3e, largest %.3e\n", dim,
                   cells + 1, what, s.zero, s.lambda[s.zero], s.lambda[s.n - 1]);
    assert_true (s.lambda[0] >= -1e-12 * s.lambda[s.n - 1]);
    pg_free (K);
    release (&a);
    return s;
}

#define NOSB(m) \
    "approximation: nosb, integration: nodal, kernel: constant, horizon: " m " spacing, stabilization: "
#define RKPM "approximation: rkpm, kernel: cubic_spline, horizon: 2.0 spacing, integration: "

static void only_rigid_motions (int dim, const char *what, const char *method)
{
    spectrum s = free_body (dim, dim == 2 ? 5 : 3, what, method);
    assert_int_equal (s.zero, dim == 2 ? 3 : 6);
    assert_true (s.lambda[s.zero] > 1e-3 * s.lambda[s.n - 1]);
    pg_free (s.lambda);
}

static void rkpm_gauss_has_rigid_motions_only (void **state)
{
    (void) state;
    only_rigid_motions (2, "RKPM Gauss", RKPM "gauss");
    only_rigid_motions (3, "RKPM Gauss", RKPM "gauss");
}

static void stabilised_nosb_has_rigid_motions_only (void **state)
{
    (void) state;
    only_rigid_motions (2, "NOSB 3.015 Silling", NOSB ("3.015") "silling");
    only_rigid_motions (3, "NOSB 3.015 Silling", NOSB ("3.015") "silling");
    only_rigid_motions (2, "NOSB 1.5 Silling", NOSB ("1.5") "silling");
    only_rigid_motions (3, "NOSB 1.5 Silling", NOSB ("1.5") "silling");
}

/* Soft: an eigenvalue below half of the first elastic one of RKPM with Gauss points. */
static void nosb_alone_has_soft_modes_and_silling_removes_them (void **state)
{
    (void) state;
    static const struct { const char *what, *method; int soft;
    } row[] = { { "NOSB 3.015", NOSB ("3.015") "none", 1 },
                { "NOSB 1.5", NOSB ("1.5") "none", 1 },
                { "RKPM nodal", RKPM "nodal", -1 },
                { "NOSB 3.015 Silling", NOSB ("3.015") "silling", 0 },
                { "NOSB 1.5 Silling", NOSB ("1.5") "silling", 0 } };
    spectrum reference = free_body (2, 15, "RKPM Gauss", RKPM "gauss");
    for (size_t k = 0; k < sizeof row / sizeof *row; k++) {
        spectrum s = free_body (2, 15, row[k].what, row[k].method);
        size_t soft = 0;
        while (s.lambda[soft] < 0.5 * reference.lambda[3]) soft++;
        print_message ("#     %zu soft modes\n", soft - s.zero);
        assert_int_equal (s.zero, 3);
        if (row[k].soft >= 0) assert_int_equal (soft > s.zero, row[k].soft);
        pg_free (s.lambda);
    }
    pg_free (reference.lambda);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (periodic_nosb_has_eight_zero_modes),
        cmocka_unit_test (silling_leaves_two_translations),
        cmocka_unit_test (in_space_there_are_24_and_three_are_left),
        cmocka_unit_test (silling_smallest_eigenvalue),
        cmocka_unit_test (bond_associated_leaves_two_translations),
        cmocka_unit_test (bond_associated_smallest_eigenvalue),
        cmocka_unit_test (rkpm_gauss_has_rigid_motions_only),
        cmocka_unit_test (stabilised_nosb_has_rigid_motions_only),
        cmocka_unit_test (nosb_alone_has_soft_modes_and_silling_removes_them),
    };
    return cmocka_run_group_tests_name ("method/modes", tests, NULL, NULL);
}
