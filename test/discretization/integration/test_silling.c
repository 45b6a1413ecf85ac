/* SPDX-License-Identifier: GPL-3.0-or-later
 * Silling's stabilisation: the blocks against the energy written out, its sign, and the motions that must not
 * feel it. */
#include "check.h"
#include "perigal/integration.h"

static uint64_t seed = 88172645463325252u;
static double random_number (void)
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

/* A perturbed lattice of side^dim nodes with nosb rows at the nodes; a tenth of the bonds is dead. */
typedef struct { pg_cloud cloud; pg_rows rows; } body;

static body make (int dim, int side)
{
    size_t n = 1, d = (size_t) dim;
    for (int k = 0; k < dim; k++) n *= (size_t) side;
    body b = { { .dim = dim, .n = n, .h = 0.1, .step = { 0.1, 0.1, 0.1 }, .thickness = 1 }, { 0 } };
    b.cloud.x = pg_calloc (n * d, sizeof (double)), b.cloud.volume = pg_calloc (n, sizeof (double));
    int *own = pg_calloc (n, sizeof *own);
    for (size_t i = 0; i < n; i++) {
        size_t rest = i;
        for (size_t k = 0; k < d; k++, rest /= (size_t) side)
            b.cloud.x[i * d + k] = 0.1 * ((double) (rest % (size_t) side) + 0.2 * random_number ());
        b.cloud.volume[i] = pow (0.1, dim) * (1 + 0.3 * random_number ());
        own[i] = (int) i;
    }
    pg_approx nosb = { pg_approx_find ("nosb"), pg_kernel_find ("quadratic"), 1, PG_RADIAL, 1, 0.25, 0, 0,
                       0, 0 };
    check_ok (pg_rows_create (&b.rows, &nosb, &b.cloud, n, b.cloud.x, b.cloud.volume, own, NULL));
    size_t nnz = b.rows.family.start[n];
    unsigned char *alive = pg_calloc (nnz, 1);
    for (size_t e = 0; e < nnz; e++) alive[e] = random_number () < 0.8;
    check_ok (nosb.type->evaluate (&nosb, &b.cloud, &b.rows, alive, n, NULL, 1));
    pg_free (own), pg_free (alive);
    return b;
}

static void unmake (body *b)
{
    pg_rows_clear (&b->rows);
    pg_free (b->cloud.x), pg_free (b->cloud.volume);
}

/* S (m x m) of point p; every block must be S_ab times the identity. */
static void gather (const body *b, size_t p, double modulus, double volume, double *S)
{
    size_t m = b->rows.family.start[p + 1] - b->rows.family.start[p], d = (size_t) b->rows.dim;
    double *blocks = pg_calloc (m * d * d, sizeof *blocks);
    for (size_t a = 0; a < m; a++) {
        for (size_t k = 0; k < m * d * d; k++) blocks[k] = 100;                     /* it adds */
        pg_silling_add (&b->rows, &b->cloud, p, a, m, modulus, volume, blocks);
        for (size_t j = 0; j < m; j++) {
            S[a * m + j] = blocks[j * d * d] - 100;
            for (size_t r = 0; r < d; r++)
                for (size_t c = 0; c < d; c++) {
                    if (r == c) assert_true (blocks[j*d*d + r*d + c] == blocks[j*d*d]);
                    else assert_true (blocks[j*d*d + r*d + c] == 100);
                }
        }
    }
    pg_free (blocks);
}

/* 1/2 c sum_j w_j |eta_j - H xi_j|^2, H = sum_j eta_j x g_j, c = V modulus d (d + 2) / sum_j w_j |xi_j|^2 */
static double energy_of (const body *b, size_t p, double modulus, double volume, const double *u,
                         double *scale)
{
    const pg_rows *r = &b->rows;
    size_t d = (size_t) r->dim, own = (size_t) r->own[p];
    double H[9] = { 0 }, q = 0, sum = 0;
    *scale = 0;
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
        for (size_t k = 0; k < d; k++)
            for (size_t l = 0; l < d; l++)
                H[3 * k + l] += (u[(size_t) r->family.node[e] * d + k] - u[own * d + k]) * r->dN[e * d + l];
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
        size_t j = (size_t) r->family.node[e];
        for (size_t k = 0; k < d; k++) {
            double z = u[j*d + k] - u[own*d + k], xi = b->cloud.x[j*d + k] - b->cloud.x[own*d + k];
            q += r->w[e] * xi * xi;
            *scale += r->w[e] * z * z;
            for (size_t l = 0; l < d; l++) z -= H[3*k + l] * (b->cloud.x[j*d + l] - b->cloud.x[own*d + l]);
            sum += r->w[e] * z * z;
        }
    }
    double c = volume * modulus * (double) (d * (d + 2)) / q;
    *scale *= 0.5 * c;
    return 0.5 * c * sum;
}

static double energy_by_blocks (const body *b, size_t p, const double *S, const double *u)
{
    size_t first = b->rows.family.start[p], m = b->rows.family.start[p + 1] - first, d = (size_t) b->rows.dim;
    double sum = 0;
    for (size_t a = 0; a < m; a++)
        for (size_t j = 0; j < m; j++)
            for (size_t k = 0; k < d; k++)
                sum += 0.5 * S[a * m + j] * u[(size_t) b->rows.family.node[first + a] * d + k]
                       * u[(size_t) b->rows.family.node[first + j] * d + k];
    return sum;
}

typedef void (*judgement) (const body *b, size_t p, const double *S);
static void for_every_point (judgement judge)
{
    static const int side[4] = { 0, 12, 7, 5 };
    for (int dim = 1; dim <= 3; dim++) {
        body b = make (dim, side[dim]);
        size_t judged = 0;
        for (size_t p = 0; p < b.rows.n; p++) {
            size_t m = b.rows.family.start[p + 1] - b.rows.family.start[p];
            if (b.rows.grade[p] != PG_GRADE_FULL) continue;
            double *S = pg_calloc (m * m, sizeof *S);
            gather (&b, p, 2.5, 0.4, S);
            judge (&b, p, S);
            pg_free (S);
            judged++;
        }
        assert_true (2 * judged > b.rows.n);
        unmake (&b);
    }
}

static void compare_energies (const body *b, size_t p, const double *S)
{
    size_t ndof = b->cloud.n * (size_t) b->cloud.dim;
    double *u = pg_calloc (ndof, sizeof *u), scale;
    for (int trial = 0; trial < 3; trial++) {
        for (size_t i = 0; i < ndof; i++) u[i] = random_number ();
        double energy = energy_of (b, p, 2.5, 0.4, u, &scale);
        check_scaled (energy_by_blocks (b, p, S, u), energy, 1e-11, scale);
    }
    pg_free (u);
}

static void blocks_give_the_energy (void **state) { (void) state, for_every_point (compare_energies); }

static void check_symmetry (const body *b, size_t p, const double *S)
{
    size_t m = b->rows.family.start[p + 1] - b->rows.family.start[p];
    double top = 0, *lambda = pg_calloc (m, sizeof *lambda);
    for (size_t a = 0; a < m; a++) top = fmax (top, S[a*m + a]);
    assert_true (top > 0 || b->cloud.dim == 1);
    for (size_t a = 0; a < m; a++)
        for (size_t j = 0; j < a; j++) check_scaled (S[a*m + j], S[j*m + a], 1e-13, top);
    if (m <= 16) {
        pg_dense_eigen ((int) m, S, lambda, NULL);
        assert_true (lambda[m - 1] >= -1e-12 * top);
        if (b->cloud.dim > 1) assert_true (lambda[0] > 0.01 * top);
    }
    pg_free (lambda);
}

static void blocks_are_symmetric_and_not_negative (void **state)
{
    (void) state, for_every_point (check_symmetry);
}

static void check_linear (const body *b, size_t p, const double *S)
{
    size_t d = (size_t) b->cloud.dim, first = b->rows.family.start[p],
           m = b->rows.family.start[p + 1] - first;
    double top = 0, reach = 0;
    for (size_t a = 0; a < m; a++) top = fmax (top, S[a*m + a]);
    for (size_t mode = 0; mode <= d; mode++)           /* constant, x, y, z: the force S u vanishes */
        for (size_t a = 0; a < m; a++) {
            double force = 0;
            for (size_t j = 0; j < m; j++) {
                const double *x = b->cloud.x + (size_t) b->rows.family.node[first + j] * d;
                double u = mode == 0 ? 1 : x[mode - 1];
                force += S[a*m + j] * u, reach = fmax (reach, fabs (u));
            }
            check_scaled (force, 0, 1e-11, top * reach);
        }
}

static void linear_fields_feel_nothing (void **state) { (void) state, for_every_point (check_linear); }

static void a_subset_of_nodes_gets_the_same_blocks (void **state)
{
    (void) state;
    body b = make (2, 6);
    for (size_t p = 0; p < b.rows.n; p++) {
        size_t m = b.rows.family.start[p + 1] - b.rows.family.start[p];
        double all[64 * 4] = { 0 }, part[64 * 4] = { 0 };
        for (size_t a = 0; a < m; a++) {
            memset (all, 0, sizeof all), memset (part, 0, sizeof part);
            pg_silling_add (&b.rows, &b.cloud, p, a, m, 1, 1, all);
            pg_silling_add (&b.rows, &b.cloud, p, a, a + 1, 1, 1, part);
            assert_memory_equal (all, part, (a + 1) * 4 * sizeof *all);
            for (size_t k = (a + 1) * 4; k < 256; k++) assert_true (part[k] == 0);
        }
    }
    unmake (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (blocks_give_the_energy),
        cmocka_unit_test (blocks_are_symmetric_and_not_negative),
        cmocka_unit_test (linear_fields_feel_nothing),
        cmocka_unit_test (a_subset_of_nodes_gets_the_same_blocks),
    };
    return cmocka_run_group_tests_name ("discretization/integration/silling", tests, NULL, NULL);
}
