/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gauss points: the rules, exactness in distorted quadrilaterals and hexahedra (moments from integrals over
 * their boundary by the divergence theorem), and the facets of a lattice body. */
#include "check.h"
#include "perigal/integration.h"
#include <gsl/gsl_integration.h>

enum { FINE = 10 };
static double gx[FINE], gw[FINE];                      /* a rule of another library */
static uint64_t seed = 88172645463325252u;

static double random_number (void)
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

static int fine_rule (void **state)
{
    (void) state;
    gsl_integration_glfixed_table *t = gsl_integration_glfixed_table_alloc (FINE);
    for (size_t i = 0; i < FINE; i++) gsl_integration_glfixed_point (-1, 1, i, &gx[i], &gw[i], t);
    gsl_integration_glfixed_table_free (t);
    return 0;
}

static void rules_are_those_of_gauss_and_legendre (void **state)
{
    (void) state;
    for (int order = 1; order <= 5; order++) {
        double x[5], w[5], X, W;
        gsl_integration_glfixed_table *t = gsl_integration_glfixed_table_alloc ((size_t) order);
        pg_gauss_rule (order, x, w);
        for (int i = 0; i < order; i++) {
            gsl_integration_glfixed_point (-1, 1, (size_t) i, &X, &W, t);
            check_absolute (x[i], X, 1e-15);
            check_absolute (w[i], W, 1e-15);
        }
        gsl_integration_glfixed_table_free (t);
    }
}

static void a_rule_is_exact_to_degree_2n_minus_1_and_no_further (void **state)
{
    (void) state;
    for (int order = 1; order <= 5; order++)
        for (int degree = 0; degree <= 2 * order; degree++) {
            double x[5], w[5], sum = 0, exact = degree % 2 ? 0 : 2.0 / (degree + 1);
            pg_gauss_rule (order, x, w);
            for (int i = 0; i < order; i++) sum += w[i] * pow (x[i], degree);
            if (degree < 2 * order) check_absolute (sum, exact, 1e-15);
            else assert_true (fabs (sum - exact) > 1e-4);
        }
}

static double monomial (const int *e, const double *x, int dim)
{
    double v = 1;
    for (int k = 0; k < dim; k++) v *= pow (x[k], e[k]);
    return v;
}

/* int x^a y^b over a quadrilateral = sum over edges of int x^(a+1)/(a+1) y^b dy */
static double quad_moment (const double *c, const int *e)
{
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        const double *p = c + 2 * k, *q = c + 2 * ((k + 1) % 4);
        for (int i = 0; i < FINE; i++) {
            double s = 0.5 * (1 + gx[i]), x = p[0] + s * (q[0] - p[0]), y = p[1] + s * (q[1] - p[1]);
            sum += 0.5 * gw[i] * pow (x, e[0] + 1) / (e[0] + 1) * pow (y, e[1]) * (q[1] - p[1]);
        }
    }
    return sum;
}

/* int x^a y^b z^c over a trilinear hexahedron = sum over its bilinear faces of int x^(a+1)/(a+1) y^b z^c
 * n_x */
static double hex_moment (const double *corner, const int *e)
{
    static const int face[6][4] = { { 0, 3, 2, 1 }, { 4, 5, 6, 7 }, { 0, 1, 5, 4 },
                                    { 2, 3, 7, 6 }, { 1, 2, 6, 5 }, { 0, 4, 7, 3 } };
    double sum = 0;
    for (int f = 0; f < 6; f++)
        for (int q = 0; q < FINE * FINE; q++) {
            double s = 0.5 * (1 + gx[q % FINE]), t = 0.5 * (1 + gx[q / FINE]), x[3], ds[3], dt[3];
            for (int k = 0; k < 3; k++) {
                double a = corner[3 * face[f][0] + k], b = corner[3 * face[f][1] + k],
                       c = corner[3 * face[f][2] + k], d = corner[3 * face[f][3] + k];
                x[k] = (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d;
                ds[k] = (1 - t) * (b - a) + t * (c - d), dt[k] = (1 - s) * (d - a) + s * (c - b);
            }
            double nx = ds[1] * dt[2] - ds[2] * dt[1];
            sum += 0.25 * gw[q % FINE] * gw[q / FINE] * pow (x[0], e[0] + 1) / (e[0] + 1) * pow (x[1], e[1])
                   * pow (x[2], e[2]) * nx;
        }
    return sum;
}

/* Sum of weight * monomial of the points in each of the cells. */
static double cell_moment (const pg_quadrature *q, int dim, int cell, const int *e)
{
    double sum = 0;
    for (size_t i = 0; i < q->n; i++)
        if (q->cell[i] == cell) sum += q->weight[i] * monomial (e, q->x + i * (size_t) dim, dim);
    return sum;
}

static void distorted_quadrilaterals_are_integrated_exactly (void **state)
{
    (void) state;
    static const double square[8] = { 0, 0, 1, 0, 1, 1, 0, 1 };
    double corner[5 * 8], thickness = 0.25;
    for (int i = 0; i < 40; i++) corner[i] = square[i % 8] + 0.3 * random_number ();
    unsigned char kind[5] = { PG_QUAD4, PG_QUAD4, PG_QUAD4, PG_QUAD4, PG_QUAD4 };
    size_t start[6] = { 0, 4, 8, 12, 16, 20 };
    pg_cells cells = { .dim = 2, .n = 5, .kind = kind, .start = start, .x = corner };
    for (int order = 1; order <= 5; order++) {
        pg_quadrature q;
        check_ok (pg_integration_find ("gauss")->points (&q, &cells, thickness, order));
        assert_int_equal (q.n, 5 * order * order);
        for (int cell = 0; cell < 5; cell++)
            for (int a = 0; a <= 2 * order - 2; a++)
                for (int b = 0; a + b <= 2 * order - 2; b++) {
                    int e[2] = { a, b };
                    check_absolute (cell_moment (&q, 2, cell, e),
                                    thickness * quad_moment (corner + 8 * cell, e), 1e-14);
                }
        pg_quadrature_clear (&q);
        assert_null (q.x);
    }
}

static void distorted_hexahedra_are_integrated_exactly (void **state)
{
    (void) state;
    static const double cube[24] = { 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1 };
    double corner[3 * 24];
    for (int i = 0; i < 72; i++) corner[i] = cube[i % 24] + 0.2 * random_number ();
    unsigned char kind[3] = { PG_HEX8, PG_HEX8, PG_HEX8 };
    size_t start[4] = { 0, 8, 16, 24 };
    pg_cells cells = { .dim = 3, .n = 3, .kind = kind, .start = start, .x = corner };
    for (int order = 2; order <= 5; order++) {
        pg_quadrature q;
        check_ok (pg_integration_find ("gauss")->points (&q, &cells, 0.25 /* not used in 3D */, order));
        assert_int_equal (q.n, 3 * order * order * order);
        for (int cell = 0; cell < 3; cell++)
            for (int a = 0; a <= 2 * order - 3; a++)
                for (int b = 0; a + b <= 2 * order - 3; b++)
                    for (int c = 0; a + b + c <= 2 * order - 3; c++) {
                        int e[3] = { a, b, c };
                        check_absolute (cell_moment (&q, 3, cell, e), hex_moment (corner + 24 * cell, e),
                                        1e-13);
                    }
        pg_quadrature_clear (&q);
    }
}

static void bars_are_integrated_exactly (void **state)
{
    (void) state;
    double corner[4] = { -0.3, 0.5, 0.5, 2.5 };
    unsigned char kind[2] = { PG_BAR2, PG_BAR2 };
    size_t start[3] = { 0, 2, 4 };
    pg_cells cells = { .dim = 1, .n = 2, .kind = kind, .start = start, .x = corner };
    for (int order = 1; order <= 5; order++) {
        pg_quadrature q;
        check_ok (pg_integration_find ("gauss")->points (&q, &cells, 3, order));
        for (int a = 0; a < 2 * order; a++)
            for (int cell = 0; cell < 2; cell++)
                check_relative (cell_moment (&q, 1, cell, &a),
                                3 * (pow (corner[2 * cell + 1], a + 1) - pow (corner[2 * cell], a + 1))
                                    / (a + 1),
                                1e-14);
        pg_quadrature_clear (&q);
    }
}

/* An L of cells in 2D, the same extruded in 3D, a bar in 1D. */
static pg_cells lattice_cells (int dim, double thickness, unsigned char *in)
{
    pg_lattice l = {
        .dim = dim, .count = { 3, dim > 1 ? 2 : 1, dim > 2 ? 2 : 1 }, .origin = { 0, 1, 2 },
        .high = { 0.6, 1.6, 2.2 }, .step = { 0.2, 0.3, 0.1 }, .in = in
    };
    pg_cells cells;
    for (int i = 0; i < 12; i++) in[i] = dim == 1 || i % 6 != 5;
    check_ok (pg_cells_from_lattice (&cells, &l, thickness));
    return cells;
}

static void facet_weights_sum_to_areas (void **state)
{
    (void) state;
    unsigned char in[12];
    for (int dim = 1; dim <= 3; dim++)
        for (int order = 1; order <= 4; order++) {
            double thickness = dim == 3 ? 1 : 0.7;
            pg_cells cells = lattice_cells (dim, thickness, in);
            pg_quadrature q;
            check_ok (pg_facet_points (&q, &cells, order));
            size_t per = dim == 1 ? 1 : dim == 2 ? (size_t) order : (size_t) (order * order);
            assert_int_equal (q.n, per * cells.nfacet);
            for (size_t f = 0; f < cells.nfacet; f++) {
                double sum = 0, low[3], high[3];
                int corners = (int) (cells.facet_start[f + 1] - cells.facet_start[f]);
                const double *corner = cells.facet_x + cells.facet_start[f] * (size_t) dim;
                for (int k = 0; k < dim; k++) {
                    low[k] = high[k] = corner[k];
                    for (int c = 1; c < corners; c++)
                        low[k] = fmin (low[k], corner[c * dim + k]),
                        high[k] = fmax (high[k], corner[c * dim + k]);
                }
                for (size_t i = 0; i < q.n; i++) {
                    if (q.cell[i] != (int) f) continue;
                    sum += q.weight[i];
                    assert_memory_equal (q.normal + i * (size_t) dim, cells.normal + f * (size_t) dim,
                                         (size_t) dim * sizeof (double));
                    assert_true (q.weight[i] > 0);
                    for (int k = 0; k < dim; k++)
                        assert_true (q.x[i * (size_t) dim + (size_t) k] > low[k] - 1e-12
                                     && q.x[i * (size_t) dim + (size_t) k] < high[k] + 1e-12);
                }
                check_relative (sum, cells.area[f], 1e-14);
            }
            pg_quadrature_clear (&q);
            pg_cells_clear (&cells);
        }
}

/* int x.n over the facets = dim * volume: places, normals and weights fit together */
static void facets_close_the_body (void **state)
{
    (void) state;
    unsigned char in[12];
    for (int dim = 1; dim <= 3; dim++) {
        double thickness = dim == 3 ? 1 : 0.7, flux = 0, volume = 0;
        pg_cells cells = lattice_cells (dim, thickness, in);
        pg_quadrature q, bulk;
        check_ok (pg_facet_points (&q, &cells, 2));
        check_ok (pg_integration_find ("gauss")->points (&bulk, &cells, thickness, 2));
        for (size_t i = 0; i < q.n; i++)
            for (int k = 0; k < dim; k++)
                flux += q.weight[i] * q.x[i * (size_t) dim + (size_t) k]
                        * q.normal[i * (size_t) dim + (size_t) k];
        for (size_t i = 0; i < bulk.n; i++) volume += bulk.weight[i];
        check_relative (flux, dim * volume, 1e-13);
        pg_quadrature_clear (&q), pg_quadrature_clear (&bulk);
        pg_cells_clear (&cells);
    }
}

static void nodal_integration_needs_no_points_of_its_own (void **state)
{
    (void) state;
    assert_true (pg_integration_find ("nodal")->at_nodes);
    assert_false (pg_integration_find ("gauss")->at_nodes);
    assert_null (pg_integration_find ("scni"));
    assert_string_equal (pg_integration_names (), "gauss|nodal|consistent");
}

/* Elements of several kinds in one mesh, in any order: each by the rule of its own kind. */
static void kinds_may_be_mixed (void **state)
{
    (void) state;
    static double x[] = { 0, 0, 1, 0, 1, 1, 0, 1, 1, 0, 2, 0, 1, 1, 2, 0, 2,
                          1, 1, 1, 0, 1, 2, 1, 2, 2, 0, 2, 2, 0, 3, 0, 2, 1 };
    static unsigned char kind[] = { PG_QUAD4, PG_TRI3, PG_TRI3, PG_QUAD4, PG_TRI3 };
    static size_t start[] = { 0, 4, 7, 10, 14, 17 };
    const double area[] = { 1, 0.5, 0.5, 2, 0.5 };
    pg_cells c = { .dim = 2, .n = 5, .kind = kind, .start = start, .x = x, .thickness = 0.3 };
    for (int order = 1; order <= 5; order++) {
        pg_quadrature q;
        double sum[5] = { 0 }, moment = 0;
        check_ok (pg_integration_find ("gauss")->points (&q, &c, 0.3, order));
        for (size_t k = 0; k < q.n; k++) sum[q.cell[k]] += q.weight[k], moment += q.weight[k] * q.x[2*k];
        for (int e = 0; e < 5; e++) check_relative (sum[e], 0.3 * area[e], 1e-14);
        check_relative (moment, 0.3 * (0.5 + 0.5 * 4 / 3 + 0.5 * 5 / 3 + 2 + 0.5 * 7 / 3), 1e-14);
        /* in parts: the same points, whatever element a part begins with */
        for (size_t first = 0, at = 0; first < 5; first += 2) {
            pg_quadrature part;
            size_t last = first + 2 < 5 ? first + 2 : 5;
            check_ok (pg_cell_points_of (&part, &c, 0.3, order, first, last));
            assert_true (at + part.n <= q.n);
            assert_memory_equal (part.x, q.x + 2 * at, 2 * part.n * sizeof *q.x);
            assert_memory_equal (part.weight, q.weight + at, part.n * sizeof *q.weight);
            assert_memory_equal (part.cell, q.cell + at, part.n * sizeof *q.cell);
            at += part.n, pg_quadrature_clear (&part);
            if (last == 5) assert_int_equal (at, q.n);
        }
        pg_quadrature_clear (&q);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rules_are_those_of_gauss_and_legendre),
        cmocka_unit_test (a_rule_is_exact_to_degree_2n_minus_1_and_no_further),
        cmocka_unit_test (distorted_quadrilaterals_are_integrated_exactly),
        cmocka_unit_test (distorted_hexahedra_are_integrated_exactly),
        cmocka_unit_test (bars_are_integrated_exactly),
        cmocka_unit_test (facet_weights_sum_to_areas),
        cmocka_unit_test (facets_close_the_body),
        cmocka_unit_test (kinds_may_be_mixed),
        cmocka_unit_test (nodal_integration_needs_no_points_of_its_own),
    };
    return cmocka_run_group_tests_name ("discretization/integration/gauss", tests, fine_rule, NULL);
}
