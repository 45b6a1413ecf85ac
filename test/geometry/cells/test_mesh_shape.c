/* SPDX-License-Identifier: GPL-3.0-or-later
 * A mesh as a shape that a lattice fills: signed distance, box, volume and surface; stairs under `cells: cut`
 * beside cut surfaces, closed; names of its parts; scenes that cannot be; broken memory. */
#include "meshed.h"

static const double pi = 3.14159265358979323846;
#define DISK(file, more) "dimension: 2\nbody:\n  - add: {mesh: {file: data/mesh/" file more "}}\n"
#define BALL(file) "dimension: 3\nbody:\n  - add: {mesh: {file: data/mesh/" file "}}\n"

/* ---- the shape ----------------------------------------------------------------------------------------- */
/* Radius 1, hole of radius 0.4; edges of 0.4: those of second order miss the circle by 2e-4. */
static void distances_are_those_of_the_surface (void **state)
{
    (void) state;
    meshed m = make (DISK ("disk_tri6_41b.msh", ""), 0.2, 0);
    for (int i = 0; i < 200; i++) {
        double angle = 0.0314 * i + 0.01, r = 0.3 + 0.004 * i, x[2] = {r * cos (angle), r * sin (angle)}, d;
        assert_int_equal (pg_body_nearest (&m.body, x, &d), 0);
        check_absolute (d, fmin (fabs (r - 0.4), fabs (r - 1)), 1e-3);
        if (d > 1e-3) assert_int_equal (pg_body_inside (&m.body, x, 0), r > 0.4 && r < 1);
        assert_true (pg_body_inside (&m.body, x, d + 1e-9) == 1);
        /* inside by more than a distance, of either sign */
        if (d > 1e-3 && r > 0.4 && r < 1) {
            assert_false (pg_body_inside (&m.body, x, -(d + 1e-9)));
            assert_true (pg_body_inside (&m.body, x, -(d - 1e-9)));
        }
    }
    for (int k = 0; k < 2; k++)
        check_absolute (m.body.low[k], -1, 1e-9), check_absolute (m.body.high[k], 1, 1e-9);
    drop (&m);
}

static void a_flat_box_is_exact (void **state)
{
    (void) state;
    meshed m = make ("dimension: 3\nbody: [{add: {mesh: {file: data/mesh/box_hex20_41b.msh, unit: mm}}}]\n",
                     0.25e-3, 1);
    double volume, surface, d;
    for (int k = 0; k < 3; k++) assert_true (m.body.high[k] - m.body.low[k] == (k ? 1e-3 : 2e-3));
    assert_int_equal (pg_body_measure (&m.body, &volume, &surface), 1);
    check_relative (volume, 2e-9, 1e-12), check_relative (surface, 10e-6, 1e-12),
        check_relative (volume_of (&m), 2e-9, 1e-12);
    double x[3] = {m.body.high[0] + 0.3e-3, m.body.high[1] + 0.4e-3, m.body.low[2] + 0.37e-3}, y[3];
    pg_body_nearest (&m.body, x, &d);
    check_relative (d, 0.5e-3, 1e-9);
    for (int k = 0; k < 3; k++) y[k] = m.body.low[k] + 0.21e-3;
    pg_body_nearest (&m.body, y, &d);
    check_relative (d, 0.21e-3, 1e-9);
    drop (&m);
}

/* ---- volume -------------------------------------------------------------------------------------------- */
/* The lattice misses the surface of the mesh by half a cell at random: well below h times the surface. */
static void volumes_converge (void **state)
{
    (void) state;
    static const struct { const char *text; double exact, spacing, fine;
    } c[] = { { DISK ("disk_tri3.msh", ""), 0, 0.1, 0.0125 },
              { DISK ("disk_quad9.msh", ""), 0.84 * pi, 0.1, 0.0125 },
              { BALL ("ball_tet10.msh"), 4 * pi / 3, 0.2, 0.04 },
              { DISK ("disk_tri6_22.msh", "") "  - subtract: {disk: {center: [0.7, 0], radius: 0.2}}\n",
                0.8 * pi, 0.1, 0.0125 } };
    for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
        double error[2], volume = c[i].exact, surface;
        for (int k = 0; k < 2; k++) {
            meshed m = make (c[i].text, k ? c[i].fine : c[i].spacing, 0);
            if (m.body.n == 1) assert_int_equal (pg_body_measure (&m.body, &volume, &surface), 1);
            if (c[i].exact > 0) check_relative (volume, c[i].exact, 0.01);
            error[k] = fabs (volume_of (&m) / volume - 1);
            drop (&m);
        }
        print_message ("mesh %zu: volume off by %.1e, %.1e\n", i, error[0], error[1]);
        check_below (error[0], 0.08);
        check_below (error[1], 0.006);
    }
}

/* ---- cut cells ----------------------------------------------------------------------------------------- */
typedef struct { double volume, close[3], flux; } sums;

static sums sum_of (const meshed *m)
{
    sums s = {0};
    const pg_cells *c = &m->cells;
    size_t dim = (size_t) c->dim;
    pg_cut_points p = {0};
    s.volume = volume_of (m);
    for (size_t f = 0; f < c->nfacet; f++) {
        p.n = 0;
        if (c->facet_kind[f] == PG_CUT) check_ok (pg_cut_facet (&p, c, f, c->dim == 2 ? 12 : 5));
        for (size_t k = 0; k < dim; k++) {
            if (c->facet_kind[f] != PG_CUT)
                s.close[k] += c->area[f] * c->normal[f * dim + k],
                    s.flux += c->area[f] * c->normal[f * dim + k] * c->facet_centre[f * dim + k];
            for (size_t q = 0; q < p.n; q++)
                s.close[k] += p.weight[q] * p.normal[q * dim + k],
                    s.flux += p.weight[q] * p.normal[q * dim + k] * p.x[q * dim + k];
        }
    }
    pg_cut_points_clear (&p);
    return s;
}

/* Whatever crosses whatever, the facets close the cells: sum n = 0, sum x.n = dim V. */
static void stairs_and_cuts_close (void **state)
{
    (void) state;
    static const struct { const char *text; double spacing;
    } c[] = {
        { DISK ("disk_tri6_41b.msh", ""), 0.083 },
        { DISK ("disk_tri6_41b.msh", "") "  - subtract: {disk: {center: [0.9, 0.3], radius: 0.25}}\n",
          0.083 },
        { DISK ("disk_quad4.msh", "") "  - add: {disk: {center: [0.37, 0.1], radius: 0.31}}\n  - subtract: "
                                      "{box: {low: [-2, -2], high: [0.13, 0.17]}}\n",
          0.071 },
        { "dimension: 2\nbody:\n  - add: {box: {low: [-1.5, -1.5], high: [1.5, 1.5]}}\n  - subtract: {mesh: "
          "{file: data/mesh/disk_quad8.msh}}\n"
          "  - subtract: {disk: {center: [0, 0.4], radius: 0.3}}\n",
          0.1 },
        { BALL (
              "ball_tet10.msh") "  - subtract: {cylinder: {center: [0, 0.3, -2], radius: 0.4, length: 4}}\n",
          0.27 },
        { DISK ("disk_tri6_22.msh", "") "  - add: {mesh: {file: data/mesh/disk_tri3.msh, unit: 0.7 m}}\n  - "
                                        "subtract: {disk: {center: [0, 0.4], radius: 0.3}}\n",
          0.09 },
    };
    for (size_t i = 0; i < sizeof c / sizeof *c; i++) {
        meshed m = make (c[i].text, (!longer () && i == 4 ? 1.4 : 1) * c[i].spacing, 1);
        sums s = sum_of (&m);
        print_message ("body %zu: %zu cells, volume %.6g, closed to %.1e, divergence %.1e\n", i, m.cells.n,
                       s.volume, fabs (s.close[0]) + fabs (s.close[1]) + fabs (s.close[2]),
                       fabs (s.flux / (m.cells.dim * s.volume) - 1));
        /* In space, five points on the curves where a cylinder meets the pieces. */
        double slack = m.cells.dim == 2 ? 1e-12 : 1e-6;
        check_below (fabs (s.close[0]) + fabs (s.close[1]) + fabs (s.close[2]), slack);
        check_relative (s.flux, m.cells.dim * s.volume, slack);
        drop (&m);
    }
}

/* Straight faces are cut as they are; curved ones are known to the square of the spacing. */
static void a_mesh_alone_is_cut (void **state)
{
    (void) state;
    double volume, surface;
    meshed straight = make (DISK ("disk_tri3.msh", ""), 0.11, 1);
    assert_int_equal (pg_body_measure (&straight.body, &volume, &surface), 1);
    check_relative (volume_of (&straight), volume, 1e-13);
    assert_non_null (straight.cells.cut);
    drop (&straight);
    double e[2];
    for (int k = 0; k < 2; k++) {
        meshed m = make (DISK ("disk_quad9.msh", ""), 0.16 / (1 << k), 1);
        assert_int_equal (pg_body_measure (&m.body, &volume, &surface), 1);
        e[k] = fabs (volume_of (&m) / volume - 1);
        drop (&m);
    }
    print_message ("curved: area off by %.1e, %.1e\n", e[0], e[1]);
    check_below (e[0], 2e-3);
    check_below (e[1], e[0] / 3);
}

/* ---- sets ---------------------------------------------------------------------------------------------- */
static void parts_of_its_surface_have_names (void **state)
{
    (void) state;
    meshed m = make (DISK ("disk_tri6_41b.msh",
                           "") "  - subtract: {disk: {center: [0.7, 0], radius: 0.1}}\n    name: bolt\n"
                               "sets: {outer: {boundary: rim}, inner: {boundary: hole}, both: {boundary: "
                               "side}, small: {boundary: bolt}}\n",
                     0.05, 1);
    pg_sets sets;
    check_ok (pg_sets_build (&sets, m.scene, &m.body, &m.lattice, &m.cloud, &m.cells));
    const pg_set *outer = pg_sets_find (&sets, "outer"), *inner = pg_sets_find (&sets, "inner"),
                 *small = pg_sets_find (&sets, "small");
    assert_true (outer->nfacet > 100 && inner->nfacet > 40 && small->nfacet > 10);
    assert_int_equal (pg_sets_find (&sets, "both")->nfacet, outer->nfacet + inner->nfacet);
    assert_int_equal (m.cells.nfacet, outer->nfacet + inner->nfacet + small->nfacet);
    for (size_t k = 0; k < outer->nfacet; k++) {
        const double *x = m.cells.facet_centre + 2 * (size_t) outer->facet[k];
        check_absolute (hypot (x[0], x[1]), 1, 0.05);
    }
    pg_sets_clear (&sets);
    drop (&m);
}

/* ---- faults -------------------------------------------------------------------------------------------- */
static void must_fault (const char *text, const char *why)
{
    pg_scene *scene = NULL;
    pg_body body;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    check_fails (pg_body_read (&body, scene), PG_E_SCENE);
    check_contains (pg_last_error (), why);
    pg_scene_free (&scene);
}

static void scenes_that_cannot_be (void **state)
{
    (void) state;
    must_fault (DISK ("nowhere.msh", ""), "body[0].add.mesh.file");
    must_fault (DISK ("ball_tet4.msh", ""), "its elements are of dimension 3, and dimension is 2");
    must_fault (DISK ("disk_tri3.msh", ", unit: kg"), "body[0].add.mesh.unit");
    must_fault (DISK ("disk_tri3.msh", ", blocks: [nothing]"),
                "the mesh has no block of this name; there are outside|inside");
    must_fault ("dimension: 1\nbody: [{add: {mesh: {file: data/mesh/disk_tri3.msh}}}]\n",
                "a mesh needs dimension 2, this scene has 1");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    meshed m = make (DISK ("disk_tri3.msh", "") "  - subtract: {disk: {center: [0.9, 0], radius: 0.3}}\n",
                     0.5, 1);
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status == PG_E_MEMORY; k++) {
        pg_body body = {0};
        pg_cells c = {0};
        pg_memory_fail_at (k);
        status = pg_body_read (&body, m.scene);
        if (status == PG_OK) status = pg_cells_cut (&c, &body, &m.lattice, 1, 0, NULL);
        pg_memory_fail_at (0);
        pg_cells_clear (&c), pg_body_clear (&body);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 1000);
    }
    check_ok (status);
    assert_true (k > 60);
    drop (&m);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (distances_are_those_of_the_surface),
        cmocka_unit_test (a_flat_box_is_exact),
        cmocka_unit_test (volumes_converge),
        cmocka_unit_test (stairs_and_cuts_close),
        cmocka_unit_test (a_mesh_alone_is_cut),
        cmocka_unit_test (parts_of_its_surface_have_names),
        cmocka_unit_test (scenes_that_cannot_be),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cells/mesh_shape", tests, NULL, NULL);
}
