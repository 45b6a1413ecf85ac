/* SPDX-License-Identifier: GPL-3.0-or-later
 * Static equilibrium: reactions balance every kind of load, external work is strain energy, supports by three
 * methods and four linear solvers agree, and a support that is too soft for Cholesky still gives
 * equilibrium. */
#include "scene_runs/run.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 0.2 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 0.5 " \
    "m]}}}]\nspacing: 0.05 m\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
#define CUBE \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4 m, 0.3 m, 0.3 m]}}}]\nspacing: 0.1 m\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
#define BAR \
    "dimension: 1\ncross_section: 0.2 m2\nbody: [{add: {box: {low: [0], high: [1 m]}}}]\nspacing: 0.05 m\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0}}\n"
static const char *const ways[] = { "nitsche", "transformation", "penalty" };

/* ---- balance ------------------------------------------------------------------------------------------- */
/* Sum of the forces of loads first .. last - 1 along k. */
static double sum_of (const run *r, size_t first, size_t last, int k)
{
    double sum = 0;
    for (size_t l = first; l < last; l++) sum += r->step.reaction[3*l + (size_t) k];
    return sum;
}

static const struct { const char *body, *load; double total[3]; } loads[] = {
    { BAR, "set: right, traction: {x: 3 MPa}", { 0.6e6, 0, 0 } },
    { BAR, "set: all, body_force: {x: 2 kN/m3}", { 400, 0, 0 } },
    { PLATE, "set: right, traction: {x: 3 MPa, y: -1 MPa}", { 0.3e6, -0.1e6, 0 } },
    { PLATE, "set: right, traction: {y: 4 MPa/m2 * y^2}", { 0, 0.2 * 4e6 * 0.125 / 3, 0 } },
    { PLATE, "set: top, pressure: 2 MPa", { 0, -0.4e6, 0 } },
    { PLATE, "set: right, force: {x: 5 kN, y: 7 kN}", { 5e3, 7e3, 0 } },
    { PLATE, "set: all, body_force: {y: -25 kN/m3}", { 0, -2500, 0 } },
    { PLATE, "set: all, body_force: {x: 25 kN/m4 * x}", { 1250, 0, 0 } },
    { CUBE, "set: right, traction: {x: 1 MPa, y: 2 MPa, z: 3 MPa}", { 0.09e6, 0.18e6, 0.27e6 } },
    { CUBE, "set: front, pressure: 1 MPa", { 0, 0, 0 } },
    { CUBE, "set: top, force: {z: 1 kN}", { 0, 0, 1e3 } },
    { CUBE, "set: all, body_force: {z: -25 kN/m3}", { 0, 0, -900 } },
};
enum { LOADS = sizeof loads / sizeof *loads };

static void reactions_balance_every_load (void **state)
{
    (void) state;
    for (int i = 0; i < LOADS; i++)
        for (int w = 0; w < 3; w++) {
            int dim = loads[i].body[strlen ("dimension: ")] - '0';
            static const char *const fixed[] = { "", "x: 0", "x: 0, y: 0", "x: 0, y: 0, z: 0" };
            run r =
                scene_of (1, "%sboundary: [{%s}, {set: left, displacement: {%s}}]\nmethod: {essential: %s}\n",
                          loads[i].body, loads[i].load, fixed[dim], ways[w]);
            to_the_end (&r);
            double size = 0;
            for (int k = 0; k < dim; k++) size = fmax (size, fabs (r.step.reaction[k]));
            assert_true (size > 0);
            for (int k = 0; k < dim; k++) {
                if (i != 9) check_scaled (r.step.reaction[k], loads[i].total[k], 1e-12, size);
                check_scaled (sum_of (&r, 0, 2, k), 0, 1e-9, size);
            }
            check_below (pg_solver_report_now (r.solver)->residual_max, 1e-8);
            clear (&r);
        }
}

static void a_pressure_around_the_body_has_no_sum (void **state)
{
    (void) state;
    run r =
        scene_of (1, CUBE
                  "boundary: [{set: all, pressure: 1 MPa}, {set: left, displacement: {x: 0, y: 0, z: 0}}]\n");
    to_the_end (&r);
    for (int k = 0; k < 3; k++) {
        check_scaled (r.step.reaction[k], 0, 1e-10, 1e5);
        check_scaled (r.step.reaction[3 + k], 0, 1e-8, 1e5);
    }
    clear (&r);
}

static void two_supports_pull_against_each_other (void **state)
{
    (void) state;
    for (int w = 0; w < 3; w++) {
        run r = scene_of (1,
                          PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, "
                                "displacement: {x: 1 mm, y: 0.2 mm}}]\nmethod: {essential: %s}\n",
                          ways[w]);
        to_the_end (&r);
        for (int k = 0; k < 2; k++)
            check_scaled (r.step.reaction[k], -r.step.reaction[3 + k], 1e-9, fabs (r.step.reaction[3]));
        check_relative (r.step.reaction[3], 10e9 * 0.2 * 0.5 * 1e-3, 0.05);  /* E A u / L, and clamped ends */
        assert_true (r.step.reaction[4] > 0);
        clear (&r);
    }
}

/* ---- energy -------------------------------------------------------------------------------------------- */
static void external_work_is_strain_energy (void **state)
{
    (void) state;
    static const char *const steppings[] = { "stepping: event", "stepping: fixed, steps: 1",
                                             "stepping: fixed, steps: 7" };
    static const char *const cases[] = {
        "{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1 MPa, y: 1 MPa}}",
        "{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm, y: 2 mm}}",
        ("{set: left, displacement: {x: 0, y: 0}}, {set: top, pressure: 1 MPa}, {set: all, body_force: "
         "{x: 1 MN/m3}}, {set: right, force: {y: -1 MN}}"),
    };
    for (int c = 0; c < 3; c++)
        for (int w = 0; w < 3; w++)
            for (int s = 0; s < 3; s++) {
                run r = scene_of (1, PLATE "boundary: [%s]\nmethod: {essential: %s}\nsolver: {%s}\n",
                                  cases[c], ways[w], steppings[s]);
                while (!pg_solver_done (r.solver, r.state)) {
                    advance (&r);
                    const pg_statistics *report = pg_solver_report_now (r.solver);
                    assert_true (report->energy.external > 0);
                    check_relative (report->energy.strain, report->energy.external, 1e-8);
                    check_scaled (report->energy.dissipated, 0, 1e-8, report->energy.external);
                    check_scaled (r.step.dissipated, 0, 1e-8, report->energy.external);
                }
                check_relative (r.state->work, pg_solver_report_now (r.solver)->energy.external, 1e-15);
                clear (&r);
            }
}

static void events_and_fixed_steps_reach_the_same_place (void **state)
{
    (void) state;
    run a = scene_of (1, PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: "
                               "{x: 1 MPa, y: 1 MPa}}]\nsolver: {stepping: event}\n"),
        b = scene_of (1, PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: "
                               "{x: 1 MPa, y: 1 MPa}}]\nsolver: {stepping: fixed, steps: 3}\n");
    to_the_end (&a), to_the_end (&b);
    check_below (largest_difference (a.state->d, b.state->d, a.state->ndof),
                 1e-9 * largest_of (b.state->d, b.state->ndof));
    for (int k = 0; k < 6; k++) check_scaled (a.step.reaction[k], b.step.reaction[k], 1e-9, 1e5);
    /* one solve, refined, for all levels */
    check_below ((double) pg_solver_report_now (a.solver)->linear.solves, 13);
    clear (&a), clear (&b);
}

/* ---- choices that must not matter ---------------------------------------------------------------------- */
static double *displacement (const char *rest)
{
    run r = scene_of (
        1,
        PLATE
        "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n%s",
        rest);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL);
    clear (&r);
    return u;
}

static void three_ways_to_prescribe_agree (void **state)
{
    (void) state;
    double *u[3];
    for (int w = 0; w < 3; w++) {
        char rest[80];
        snprintf (rest, sizeof rest, "method: {essential: %s}\n", ways[w]);
        u[w] = displacement (rest);
    }
    /* both at the nodes: 1 / penalty */
    check_below (largest_difference (u[1], u[2], 21 * 11 * 2), 1e-6 * 1e-3);
    /* nodes against facets: 1 / 1000 */
    check_below (largest_difference (u[0], u[1], 21 * 11 * 2), 1e-3 * 1e-3);
    for (int w = 0; w < 3; w++) pg_free (u[w]);
}

static void linear_solvers_agree (void **state)
{
    (void) state;
    static const char *const solvers[] = { "auto", "cholmod", "umfpack", "pcg" };
    static const char *const methods[] = { "nitsche", "transformation" };
    for (int m = 0; m < 2; m++) {
        double *u[4];
        for (int s = 0; s < 4; s++) {
            char rest[120];
            snprintf (rest, sizeof rest, "method: {essential: %s}\nsolver: {linear: %s}\n", methods[m],
                      solvers[s]);
            u[s] = displacement (rest);
            check_below (largest_difference (u[0], u[s], 21 * 11 * 2), 1e-8 * 1e-3);
        }
        for (int s = 0; s < 4; s++) pg_free (u[s]);
    }
}

static void a_soft_nitsche_support_falls_back_on_umfpack (void **state)
{
    (void) state;
    run r =
        scene_of (1, PLATE
                  "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1 MPa}}]\n"
                  "method: {essential: nitsche, nitsche_factor: 0.05}\n");
    to_the_end (&r);
    const pg_statistics *report = pg_solver_report_now (r.solver);
    int told = 0;
    for (size_t k = 0; k < report->nwarning; k++)
        told |= strstr (report->warning[k], "not positive definite")
                && strstr (report->warning[k], "nitsche_factor");
    assert_true (told);
    assert_string_equal (report->linear.solver, "umfpack");
    check_below (report->residual_max, 1e-8);
    check_relative (r.step.reaction[0], -1e5, 1e-9);
    clear (&r);
    run c =
        scene_of (1, PLATE
                  "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 1 MPa}}]\n"
                  "method: {essential: nitsche, nitsche_factor: 0.05}\nsolver: {linear: cholmod}\n");
    check_fails (pg_solver_step (c.solver, c.state, &c.step), PG_E_NOT_SPD);
    check_contains (pg_last_error (), "nitsche_factor");
    clear (&c);
}

/* Cholesky takes K at any Poisson's ratio, also where nothing is projected. */
static void nitsche_holds_up_to_a_poissons_ratio_of_one_half (void **state)
{
    (void) state;
    static const char *const methods[] = { "", "integration: nodal, ", "integration: consistent, ",
                                           "basis: quadratic, horizon: 3 spacing, " };
    static const double ratios[] = { 0.48, 0.49, 0.495, 0.4999 };
    for (int body = 0; body < 2; body++)
        for (int m = 0; m < 4; m++)
            for (int k = 0; k < 4; k++)
                for (int pointwise = 0; pointwise < 2; pointwise++) {
                    run r = scene_of (1,
                                      "%smaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: "
                                      "%g}}\nmethod: {%sdilatation: %s, essential: nitsche}\n"
                                      "boundary: [{set: left, displacement: {x: 0, y: 0%s}}, {set: right, "
                                      "traction: {y: 1 kPa}}]\nsolver: {linear: cholmod}\n",
                                      body ? "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1 m, "
                                             "0.5 m, 0.5 m]}}}]\nspacing: 0.25 m\n"
                                           : "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], "
                                             "high: [2 m, 1 m]}}}]\nspacing: 0.2 m\n",
                                      ratios[k], methods[m], pointwise ? "pointwise" : "auto",
                                      body ? ", z: 0" : "");
                    advance (&r);
                    assert_true (r.step.residual <= 1e-8);
                    clear (&r);
                }
}

static void a_body_that_nothing_holds_is_no_equilibrium (void **state)
{
    (void) state;
    run r =
        scene_of (1, PLATE
                  "boundary: [{set: right, traction: {x: 1 MPa}}]\nsolver: {stepping: fixed, steps: 2}\n");
    pg_status status = pg_solver_step (r.solver, r.state, &r.step);
    assert_true (status == PG_E_EQUILIBRIUM || status == PG_E_NOT_SPD || status == PG_E_SINGULAR);
    assert_true (largest_of (r.state->d, r.state->ndof) == 0);     /* the last accepted state */
    assert_int_equal (r.state->step, 0);
    clear (&r);
}

/* ---- places -------------------------------------------------------------------------------------------- */
static void gauges_see_linear_fields_exactly (void **state)
{
    (void) state;
    static const char *const methods[] = { "{approximation: rkpm}",
                                           "{approximation: nosb, integration: nodal, horizon: 2.5 spacing}",
                                           "{approximation: rkpm, basis: quadratic, horizon: 3 spacing}" };
    for (int m = 0; m < 3; m++) {
        run r = scene_of (1, PLATE "method: %s\n", methods[m]);
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        refresh (&r, NULL);
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            const double *x = r.problem->cloud.x + 2 * i;
            r.state->d[2*i] = 1 + 2 * x[0] - 3 * x[1], r.state->d[2*i + 1] = -4 + 5 * x[0] + x[1];
        }
        for (int k = 0; k < 50; k++) {
            double x[3] = { 0.01 + 0.0197 * k, 0.499 - 0.0098 * k, 0 }, u[3];
            check_ok (force->sample (self, r.state, r.state->d, 1, x, u, NULL, NULL));
            check_absolute (u[0], 1 + 2 * x[0] - 3 * x[1], 1e-12);
            check_absolute (u[1], -4 + 5 * x[0] + x[1], 1e-12);
            assert_true (u[2] == 0);
        }
        clear (&r);
    }
}

static void a_steady_run_allocates_nothing_more (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: "
                               "{x: 1 MPa}, ramp: t^2}]\nsolver: {stepping: fixed, steps: 10}\n");
    advance (&r), advance (&r);
    size_t used = pg_memory_used (), calls = pg_memory_calls ();
    to_the_end (&r);
    assert_int_equal (pg_memory_used (), used);
    assert_int_equal (pg_memory_calls (), calls);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (reactions_balance_every_load),
        cmocka_unit_test (a_pressure_around_the_body_has_no_sum),
        cmocka_unit_test (two_supports_pull_against_each_other),
        cmocka_unit_test (external_work_is_strain_energy),
        cmocka_unit_test (events_and_fixed_steps_reach_the_same_place),
        cmocka_unit_test (three_ways_to_prescribe_agree),
        cmocka_unit_test (linear_solvers_agree),
        cmocka_unit_test (a_soft_nitsche_support_falls_back_on_umfpack),
        cmocka_unit_test (nitsche_holds_up_to_a_poissons_ratio_of_one_half),
        cmocka_unit_test (a_body_that_nothing_holds_is_no_equilibrium),
        cmocka_unit_test (gauges_see_linear_fields_exactly),
        cmocka_unit_test (a_steady_run_allocates_nothing_more),
    };
    return cmocka_run_group_tests_name ("solve/static", tests, NULL, NULL);
}
