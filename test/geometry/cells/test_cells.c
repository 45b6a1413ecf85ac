/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells and boundary facets: corners shared bit for bit, closed surface, divergence theorem, orientation. */
#include "check.h"
#include "perigal/cells.h"

typedef struct { pg_scene *scene; pg_body body; pg_lattice lattice; pg_cells cells; } meshed;

static const char *const text[3] = {
    "dimension: 1\nbody: [{add: {box: {low: [-1], high: [1]}}}, {subtract: {box: {low: [0.2], high: "
    "[0.5]}}}]",
    "dimension: 2\nbody: [{add: {disk: {center: [0.3, -0.2], radius: 1}}}, {subtract: {disk: {center: [0.5, "
    "0], radius: 0.3}}}]",
    "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [1, 1, 1], radius: 1, length: 2}}}, "
    "{subtract: {sphere: {center: [0.5, 0.5, 0.5], radius: 0.4}}}]",
};

static meshed mesh (int dim, double thickness)
{
    meshed m = {0};
    check_ok (pg_scene_parse (&m.scene, text[dim - 1], "test.yaml"));
    check_ok (pg_body_read (&m.body, m.scene));
    check_ok (pg_lattice_fit (&m.lattice, &m.body, 0.1, NULL));
    check_ok (pg_cells_from_lattice (&m.cells, &m.lattice, thickness));
    return m;
}

static void drop (meshed *m)
{
    pg_cells_clear (&m->cells);
    pg_lattice_clear (&m->lattice);
    pg_body_clear (&m->body);
    pg_scene_free (&m->scene);
}

static void facet_middle (const pg_cells *c, size_t f, double *x)
{
    int dim = c->dim, n = (int) (c->facet_start[f + 1] - c->facet_start[f]);
    for (int k = 0; k < dim; k++) {
        x[k] = 0;
        for (int e = 0; e < n; e++) x[k] += c->facet_x[((int) c->facet_start[f] + e) * dim + k] / n;
    }
}

static void cells_are_the_kept_cells_of_the_lattice (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        meshed m = mesh (dim, 1);
        size_t n = 0,
               all = (size_t) m.lattice.count[0] * (size_t) m.lattice.count[1] * (size_t) m.lattice.count[2];
        for (size_t i = 0; i < all; i++) n += m.lattice.in[i];
        assert_int_equal (m.cells.n, n);
        assert_true (n < all);
        double volume = 1;
        for (int k = 0; k < dim; k++) volume *= m.lattice.step[k];
        for (size_t c = 0; c < n; c++) {
            assert_int_equal (m.cells.kind[c], dim == 1 ? PG_BAR2 : dim == 2 ? PG_QUAD4 : PG_HEX8);
            assert_int_equal (m.cells.start[c + 1] - m.cells.start[c], 1 << dim);
            assert_true (m.cells.volume[c] == volume && m.cells.block[c] == 0);
        }
        drop (&m);
    }
}

static void the_surface_is_closed (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        meshed m = mesh (dim, 0.25);
        double sum[3] = {0, 0, 0}, size = 0;
        for (size_t f = 0; f < m.cells.nfacet; f++) {
            size += m.cells.area[f];
            for (int k = 0; k < dim; k++)
                sum[k] += m.cells.normal[f * (size_t) dim + (size_t) k] * m.cells.area[f];
        }
        assert_true (size > 0);
        for (int k = 0; k < dim; k++) check_scaled (sum[k], 0, 1e-13, size);
        drop (&m);
    }
}

static void divergence_theorem_gives_the_volume (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        double thickness = dim == 3 ? 1 : 0.25, flux = 0, volume = thickness;
        meshed m = mesh (dim, thickness);
        for (int k = 0; k < dim; k++) volume *= m.lattice.step[k];
        volume *= (double) m.cells.n;
        for (size_t f = 0; f < m.cells.nfacet; f++) {
            double x[3];
            facet_middle (&m.cells, f, x);
            for (int k = 0; k < dim; k++)
                flux += x[k] * m.cells.normal[f * (size_t) dim + (size_t) k] * m.cells.area[f];
        }
        check_relative (flux, dim * volume, 1e-12);
        drop (&m);
    }
}

static void thickness_does_not_enter_in_3d (void **state)
{
    (void) state;
    meshed a = mesh (3, 1), b = mesh (3, 7);
    assert_memory_equal (a.cells.area, b.cells.area, a.cells.nfacet * sizeof (double));
    drop (&a), drop (&b);
}

/* A corner of one cell is a corner of its neighbour, equal in every bit: as many distinct positions as
 * vertices in use. */
static void shared_corners_are_equal_in_every_bit (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        meshed m = mesh (dim, 1);
        const pg_cells *c = &m.cells;
        size_t d = (size_t) dim, n = c->start[c->n];
        for (size_t i = 0; i < n; i++) {
            for (size_t k = 0; k < d; k++) {
                double v = rint ((c->x[i*d + k] - m.lattice.origin[k]) / m.lattice.step[k]);
                assert_true (c->x[i*d + k] == pg_lattice_at (&m.lattice, (int) k, v));
            }
        }
        drop (&m);
    }
}

/* Signed volume by corner order: 1D length, 2D shoelace, 3D triple product of the edges at corner 0. */
static void corners_follow_exodus_order (void **state)
{
    (void) state;
    meshed a = mesh (1, 1), b = mesh (2, 1), c = mesh (3, 1);
    for (size_t i = 0; i < a.cells.n; i++) assert_true (a.cells.x[2*i] < a.cells.x[2*i + 1]);
    for (size_t i = 0; i < b.cells.n; i++) {
        const double *x = b.cells.x + 8*i;
        double area = 0;
        for (int e = 0; e < 4; e++)
            area += 0.5 * (x[2 * e] * x[2 * ((e + 1) % 4) + 1] - x[2 * ((e + 1) % 4)] * x[2 * e + 1]);
        check_relative (area, b.lattice.step[0] * b.lattice.step[1], 1e-11);
    }
    for (size_t i = 0; i < c.cells.n; i++) {
        const double *x = c.cells.x + 24*i;
        for (int e = 0; e < 4; e++) {                          /* top over bottom */
            assert_true (x[3 * e] == x[3 * (e + 4)] && x[3 * e + 1] == x[3 * (e + 4) + 1]
                         && x[3 * e + 2] < x[3 * (e + 4) + 2]);
        }
        double p[3] = {x[3] - x[0], x[4] - x[1], 0}, q[3] = {x[9] - x[0], x[10] - x[1], 0};
        assert_true (p[0]*q[1] - p[1]*q[0] > 0 && x[6] == x[3] && x[7] == x[10]);
    }
    drop (&a), drop (&b), drop (&c);
}

static void facets_turn_counter_clockwise_seen_from_outside (void **state)
{
    (void) state;
    meshed b = mesh (2, 1), c = mesh (3, 1);
    for (size_t f = 0; f < b.cells.nfacet; f++) {              /* the body lies left of the edge */
        const double *x = b.cells.facet_x + 4*f, *n = b.cells.normal + 2*f;
        double t[2] = {x[2] - x[0], x[3] - x[1]}, l = hypot (t[0], t[1]);
        check_absolute (t[1] / l, n[0], 1e-14);
        check_absolute (-t[0] / l, n[1], 1e-14);
        check_relative (b.cells.area[f], l, 1e-12);
    }
    for (size_t f = 0; f < c.cells.nfacet; f++) {
        const double *x = c.cells.facet_x + 12*f, *n = c.cells.normal + 3*f;
        for (int k = 0; k < 3; k++) {
            int i = (k + 1) % 3, j = (k + 2) % 3;
            double cross = (x[3 + i] - x[i]) * (x[9 + j] - x[j]) - (x[3 + j] - x[j]) * (x[9 + i] - x[i]);
            check_absolute (cross / c.cells.area[f], n[k], 1e-11);
        }
    }
    drop (&b), drop (&c);
}

static void each_facet_lies_on_its_cell_and_points_out_of_it (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        meshed m = mesh (dim, 1);
        const pg_cells *c = &m.cells;
        size_t d = (size_t) dim;
        for (size_t f = 0; f < c->nfacet; f++) {
            double x[3], out = 0;
            size_t cell = (size_t) c->facet_cell[f];
            facet_middle (c, f, x);
            for (size_t k = 0; k < d; k++) {
                double middle = 0;
                for (size_t e = c->start[cell]; e < c->start[cell + 1]; e++)
                    middle += c->x[e * d + k] / (double) (1 << d);
                assert_true (c->facet_centre[f * d + k] == x[k]
                             || fabs (c->facet_centre[f * d + k] - x[k]) < 1e-15);
                out += (x[k] - middle) * c->normal[f*d + k] / (0.5 * m.lattice.step[k]);
            }
            check_relative (out, 1, 1e-12);
        }
        drop (&m);
    }
}

static void no_lattice_no_cells (void **state)
{
    (void) state;
    pg_lattice none = {0};
    pg_cells c;
    check_ok (pg_cells_from_lattice (&c, &none, 1));
    assert_int_equal (c.n, 0);
    assert_int_equal (c.nfacet, 0);
    pg_cells_clear (&c);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    meshed m = mesh (2, 1);
    size_t before = pg_memory_used ();
    for (size_t k = 1; k <= 13; k++) {
        pg_cells c;
        pg_memory_fail_at (k);
        check_fails (pg_cells_from_lattice (&c, &m.lattice, 1), PG_E_MEMORY);
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), before);
    }
    drop (&m);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (cells_are_the_kept_cells_of_the_lattice),
        cmocka_unit_test (the_surface_is_closed),
        cmocka_unit_test (divergence_theorem_gives_the_volume),
        cmocka_unit_test (thickness_does_not_enter_in_3d),
        cmocka_unit_test (shared_corners_are_equal_in_every_bit),
        cmocka_unit_test (corners_follow_exodus_order),
        cmocka_unit_test (facets_turn_counter_clockwise_seen_from_outside),
        cmocka_unit_test (each_facet_lies_on_its_cell_and_points_out_of_it),
        cmocka_unit_test (no_lattice_no_cells),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cells/cells", tests, NULL, NULL);
}
