/* SPDX-License-Identifier: GPL-3.0-or-later
 * The choice between a factor and conjugate gradients by counted cost: a body in space that is solved once,
 * with many right-hand sides (contact), from event to event; where the points of a lattice stand. */
#include "check.h"
#include "perigal.h"

/* A cube of n^3 nodes with Gauss points, horizon 2 spacings. */
static pg_solve_counts cube (double n)
{
    return (pg_solve_counts) { .dim = 3, .components = 3, .order = 1, .reach = 2, .edge = { n, n, n },
                               .points = n * n * n, .evaluation = 8 * n * n * n, .bonds = 240 * n * n * n };
}

static void many_right_hand_sides_want_a_factor (void **unused)
{
    (void) unused;
    pg_solve_counts c = cube (24);
    assert_true (pg_solve_by_elements (&c, 1, 0, 0));
    assert_false (pg_solve_by_elements (&c, 1, 1, 0));     /* many events */
    assert_true (pg_solve_by_elements (&c, 1, 0, 0));
    c.columns = 300;                                       /* forces of 100 pieces of cracks */
    assert_false (pg_solve_by_elements (&c, 1, 0, 0));
    c = cube (40), c.columns = 300;                        /* but not of a size that no memory holds */
    assert_true (pg_solve_by_elements (&c, 1, 0, 0));
    c = cube (24), c.dim = 2, c.columns = 300;
    assert_false (pg_solve_by_elements (&c, 1, 0, 0));
}

/* Points at the centres of cells are known as such where the surface of the body cuts cells too. */
static void where_points_stand (void **unused)
{
    (void) unused;
    static const char *const body[] = { "box: {low: [0, 0, 0], high: [8, 8, 4]}",
                                        "cylinder: {center: [0, 0, 0], axis: [0, 0, 1], length: 4, "
                                        "diameter: 8.3}" };
    for (int b = 0; b < 2; b++)
        for (int centres = 0; centres < 2; centres++) {
            char text[512];
            snprintf (text, sizeof text,
                      "dimension: 3\nbody: [{add: {%s}}]\nspacing: 1\nlattice: %s\n"
                      "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.25}}\n", body[b],
                      centres ? "cells" : "nodes");
            pg_scene *scene = NULL;
            pg_problem *p = NULL;
            check_ok (pg_scene_parse (&scene, text, "test.yaml"));
            check_ok (pg_problem_build (&p, scene, 1));
            assert_int_equal (pg_solve_count (p).behind, centres);
            pg_problem_free (&p);
            pg_scene_free (&scene);
        }
}

/* Scattered nodes that are evaluated themselves take a coarse grid: cheaper than elements on all nodes, which
 * wide supports need. */
static void scattered_nodes (void **unused)
{
    (void) unused;
    pg_solve_counts c = cube (24), all;
    c.evaluation = c.points, c.bonds = 33 * c.points, all = c, c.scattered = 1;
    assert_true (pg_solve_on_grid (&c) && !pg_solve_on_grid (&all));
    assert_true (pg_solve_by_elements (&c, 1, 0, 0));
    assert_true (pg_solve_elements_cost (&c) < 2 * pg_solve_elements_cost (&all));
    c.reach = 2.6;
    assert_false (pg_solve_on_grid (&c));
    c.order = 2;
    assert_true (pg_solve_on_grid (&c));
    c.projected = 1;
    assert_false (pg_solve_on_grid (&c));
    static const char text[] = "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [4, 4, 4]}}}]\n"
                               "spacing: 1\nmaterials: {m: {youngs_modulus: 1, poissons_ratio: 0.25}}\n"
                               "method: {integration: %s}\n%s\n";
    static const struct { const char *integration, *more; int scattered; } way[] = {
        { "nodal", "", 0 }, { "nodal", "perturb: {amount: 0.2}", 1 }, { "gauss", "perturb: {amount: 0.2}", 0 }
    };
    for (int k = 0; k < 3; k++) {
        char scene_text[512];
        pg_scene *scene = NULL;
        pg_problem *p = NULL;
        snprintf (scene_text, sizeof scene_text, text, way[k].integration, way[k].more);
        check_ok (pg_scene_parse (&scene, scene_text, "test.yaml"));
        check_ok (pg_problem_build (&p, scene, 1));
        assert_int_equal (pg_solve_count (p).scattered, way[k].scattered);
        pg_problem_free (&p);
        pg_scene_free (&scene);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (many_right_hand_sides_want_a_factor),
                                        cmocka_unit_test (where_points_stand),
                                        cmocka_unit_test (scattered_nodes) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
