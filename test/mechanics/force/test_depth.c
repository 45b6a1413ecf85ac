/* SPDX-License-Identifier: GPL-3.0-or-later
 * boundary.depth: tractions and pressure spread over the points below the surface: total force, rows, curved
 * surfaces, what is refused. */
#include "scene_runs/run.h"

#define SCENE SCENE_HELD ("bottom")
#define SCENE_HELD(set) \
    "dimension: 2\nthickness: 2 mm\nbody: [%s]\nspacing: 1 mm\nlattice: %s\nmaterials: {glass: " \
    "{youngs_modulus: 72 GPa, poissons_ratio: 0.3333}}\n" \
    "method: {force: bond}\nboundary:\n  - {name: hold, set: " set \
    ", displacement: {x: 0, y: 0}}\n  - {name: load, set: %s, %s}\n"
#define BOX "{add: {box: {low: [0, 0], high: [10 mm, 8 mm]}}}"

static double *loads (run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    double *P = pg_calloc (r->state->ndof, sizeof *P);
    check_ok (force->loads (self, 1, P));
    return P;
}

static double total (const double *P, size_t n, int k)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += P[2 * i + (size_t) k];
    return sum;
}

static void rows_share_a_traction_by_volume (void **state)
{
    (void) state;
    for (int nodes = 0; nodes < 2; nodes++) {
        run r = scene_of (1, SCENE, BOX, nodes ? "nodes" : "cells", "top",
                          "traction: {x: -3 MPa, y: 12 MPa}, depth: 3 spacing");
        const pg_cloud *c = &r.problem->cloud;
        /* nodes: half a row at the surface, whole ones 1, 2, 3 mm below */
        double *P = loads (&r), rows = nodes ? 3.5 : 3;
        check_relative (total (P, c->n, 1), 12e6 * 10e-3 * 2e-3, 1e-13);
        check_relative (total (P, c->n, 0), -3e6 * 10e-3 * 2e-3, 1e-13);
        for (size_t i = 0; i < c->n; i++) {
            double depth = 8e-3 - c->x[2*i + 1], volume = c->volume[i];
            /* b = t / depth */
            if (depth < 3e-3 + 1e-9) check_relative (P[2*i + 1], 12e6 * volume / (rows * 1e-3), 1e-12);
            else assert_true (P[2*i] == 0 && P[2*i + 1] == 0);
        }
        pg_free (P);
        clear (&r);
    }
}

static void a_depth_below_half_a_row_is_the_outermost (void **state)
{
    (void) state;
    run a = scene_of (1, SCENE, BOX, "cells", "top",
                      "traction: {y: 12 MPa * (1 + x / 10 mm)}, depth: 0.2 spacing");
    run b = scene_of (1, SCENE, BOX, "cells", "top", "traction: {y: 12 MPa * (1 + x / 10 mm)}");
    double *P = loads (&a), *Q = loads (&b);
    assert_memory_equal (P, Q, a.state->ndof * sizeof *P);
    pg_free (P), pg_free (Q);
    clear (&a), clear (&b);
}

/* Cut cells of a disk: pressure all around, no net force, none further in than the depth. */
static void pressure_on_a_curved_surface (void **state)
{
    (void) state;
    for (int nodes = 0; nodes < 2; nodes++) {
        run r = scene_of (1, SCENE_HELD ("rim.bottom"), "{add: {disk: {center: [0, 0], radius: 10 mm}}}",
                          nodes ? "nodes\nsets: {rim: {boundary: rim}}"
                                : "cells\nsets: {rim: {boundary: rim}}",
                          "rim", "pressure: 5 MPa, depth: 2 mm");
        const pg_cloud *c = &r.problem->cloud;
        double *P = loads (&r), size = 5e6 * 2e-2 * 2e-3, inwards = 0;
        assert_true (fabs (total (P, c->n, 0)) < 1e-10 * size && fabs (total (P, c->n, 1)) < 1e-10 * size);
        for (size_t i = 0; i < c->n; i++) {
            double x = c->x[2*i], y = c->x[2*i + 1], r0 = hypot (x, y);
            if (r0 < 10e-3 - 2e-3 - 1.5e-3) assert_true (P[2*i] == 0 && P[2*i + 1] == 0);
            if (r0 > 1e-9) inwards -= (P[2*i] * x + P[2*i + 1] * y) / r0;
        }
        check_relative (inwards, 5e6 * 2 * acos (-1) * 10e-3 * 2e-3, 0.02);
        pg_free (P);
        clear (&r);
    }
}

static void perturbed_points_and_three_dimensions (void **state)
{
    (void) state;
    run r = scene_of (1, SCENE "perturb: {amount: 0.4, seed: 2}\n", BOX, "cells", "right",
                      "traction: {x: 4 MPa}, depth: 2.5 mm");
    double *P = loads (&r);
    check_relative (total (P, r.problem->cloud.n, 0), 4e6 * 8e-3 * 2e-3, 1e-13);
    pg_free (P);
    clear (&r);
    r = scene_of (1, "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [4, 5, 6]}}}]\nspacing: "
                     "1\nlattice: cells\nmaterials: {a: {youngs_modulus: 1e9, poissons_ratio: 0.25}}\n"
                     "method: {force: bond}\nboundary:\n  - {name: hold, set: back, displacement: {x: 0, y: "
                     "0, z: 0}}\n  - {name: load, set: front, traction: {z: 1000}, depth: 2}\n");
    P = loads (&r);
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        check_scaled (P[3 * i + 2], r.problem->cloud.x[3 * i + 2] > 4 ? 500 : 0, 1e-12, 500);
    pg_free (P);
    clear (&r);
}

static void must_refuse (const char *text, const char *part)
{
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_scene_free (&scene);
}

#define PLATE \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [10, 8]}}}]\nspacing: 1\nmaterials: {a: " \
    "{youngs_modulus: 1e9, poissons_ratio: 0.3333}}\n"
static void it_goes_with_tractions_of_direct_forces_only (void **state)
{
    (void) state;
    must_refuse (PLATE "method: {force: bond}\nboundary: [{set: bottom, displacement: {y: 0}, depth: 1}, "
                       "{set: top, traction: {y: 1}}]",
                 "is for a traction or a pressure");
    must_refuse (
        PLATE "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1}, depth: 1}]",
        "a depth is for force");
}

/* All of the height is allowed, whichever points the lattice has; more is refused with what is. */
static void it_ends_at_the_body (void **state)
{
    (void) state;
    for (int nodes = 0; nodes < 2; nodes++) {
        run r = scene_of (1, SCENE, BOX, nodes ? "nodes" : "cells", "top",
                          "traction: {y: 12 MPa}, depth: 8 mm");
        clear (&r);
    }
    must_refuse (
        PLATE "method: {force: bond}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: right, "
              "traction: {x: 1}, depth: 10.01}]",
        "boundary[1].depth = 10.01: reaches beyond the body, which is 10 m deep below right: at most that");
}

static void broken_memory_is_told (void **state)
{
    (void) state;
    run r = scene_of (1, SCENE, BOX, "cells", "top", "traction: {y: 12 MPa}, depth: 3 spacing");
    const pg_force_type *force = pg_solver_force (r.solver, NULL);
    int failed = 0, done = 0;
    for (size_t k = 1; k < 2000 && !done; k++) {
        void *self = NULL;
        pg_memory_fail_at (k);
        pg_status status = force->create (&self, r.problem);
        pg_memory_fail_at (0);
        if (status == PG_OK) done = 1;
        else {
            assert_int_equal (status, PG_E_MEMORY);
            failed++;
        }
        if (self) force->free (&self);
    }
    assert_true (done && failed > 10);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rows_share_a_traction_by_volume),
        cmocka_unit_test (a_depth_below_half_a_row_is_the_outermost),
        cmocka_unit_test (pressure_on_a_curved_surface),
        cmocka_unit_test (perturbed_points_and_three_dimensions),
        cmocka_unit_test (it_goes_with_tractions_of_direct_forces_only),
        cmocka_unit_test (it_ends_at_the_body),
        cmocka_unit_test (broken_memory_is_told),
    };
    return cmocka_run_group_tests_name ("mechanics/force/depth", tests, NULL, NULL);
}
