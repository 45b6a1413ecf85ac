/* SPDX-License-Identifier: GPL-3.0-or-later
 * Parts that nothing holds (test/defects: nothing_holds): whatever is asked to solve, a loaded one is
 * refused, its part of the body and its free direction named; loads that balance are borne, and what is not
 * loaded stays. */
#include "scene_runs/run.h"

#define SQUARE \
    "dimension: 2\nthickness: 1 cm\nbody: [{add: {box: {low: [0, 0], high: [10 mm, 10 mm]}}}]\nspacing: 1 " \
    "mm\n" \
    "lattice: cells\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: %s, density: 2500}}\n"
#define CUBE \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [6 mm, 6 mm, 6 mm]}}}]\nspacing: 1 mm\n" \
    "lattice: cells\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: %s, density: 2500}}\n"
#define CUT2 "cracks: [{from: [-1 mm, 6.2 mm], to: [11 mm, 6.2 mm]}]\n"
#define CUT3 \
    "cracks: [{polygon: [[-1 mm, -1 mm, 3.1 mm], [7 mm, -1 mm, 3.1 mm], [7 mm, 7 mm, 3.1 mm], [-1 mm, 7 " \
    "mm, " \
    "3.1 mm]]}]\n"
#define OFF "failure: {criterion: none}\noutput: {at: {levels: 1}}\n"
/* the upper part is free to move along x alone */
#define GUIDED2 \
    "boundary: [{name: lo, set: bottom, displacement: {x: 0, y: 0}}, {name: hi, set: top, displacement: " \
    "{y: 1 " \
    "um}}, {name: side, set: right, pressure: 3 MPa%s}]\n"
#define GUIDED3 \
    "boundary: [{name: lo, set: back, displacement: {x: 0, y: 0, z: 0}}, {name: hi, set: front, " \
    "displacement: " \
    "{y: 0, z: 1 um}}, {name: side, set: right, pressure: 3 MPa%s}]\n"
/* back at zero at the end of the run: no load is missed before the first step, and one of the steps meets it
 * */
#define PASSES ", table: [[0, 0], [0.5, 1], [1, 0]]"

static void refused (run *r, const char *part, const char *way)
{
    pg_status status = PG_OK;
    while (status == PG_OK && !pg_solver_done (r->solver, r->state))
        status = pg_solver_step (r->solver, r->state, &r->step);
    if (status == PG_OK) print_error ("a free part was solved for: %g m\n", largest_of (r->state->d,
                                                                                        r->state->ndof));
    assert_int_equal (status, PG_E_EQUILIBRIUM);
    check_contains (pg_last_error (), part);
    check_contains (pg_last_error (), way);
    check_contains (pg_last_error (), "side");
    clear (r);
}

static void every_linear_solver_refuses (void **state)
{
    (void) state;
    static const char *const linear[] = { "auto", "cholmod", "umfpack", "pcg" };
    for (size_t k = 0; k < sizeof linear / sizeof *linear; k++)
        for (int passing = 0; passing < 2; passing++) {
            const char *table = passing ? PASSES : "";
            run r = scene_of (1, SQUARE CUT2 OFF GUIDED2 "solver: {stepping: fixed, steps: 2, linear: "
                                                         "%s}\n", "0.2",
                              table, linear[k]);
            refused (&r, "a loose part of the body, 40 of its 100 points, around (0.005, 0.008) m",
                     "along x (");
            r = scene_of (1, CUBE CUT3 OFF GUIDED3 "solver: {stepping: fixed, steps: 2, linear: %s}\n",
                          "0.2", table,
                          linear[k]);
            refused (&r, "a loose part of the body, 108 of its 216 points, around (0.003, 0.003, 0.0045) m",
                     "along x (");
        }
}

static void every_way_of_stepping_refuses (void **state)
{
    (void) state;
    static const struct { const char *solver, *side, *nu; } ways[] = {
        { "method: {approximation: nosb}\nsolver: {stepping: event}\n", "", "0.2" },
        { "solver: {stepping: fixed}\n", "", "0.2" },
        { "solver: {kind: adr, stages: 2, max_iterations: 3000}\nmethod: {force: bond}\n", "", "0.3333" },
        { "solver: {kind: adr, stages: 2, max_iterations: 3000}\nmethod: {force: bond}\n", PASSES, "0.3333" },
        { "solver: {kind: relax, stages: 2, max_iterations: 3000}\nmethod: {force: lps}\n", PASSES, "0.2" },
        { "solver: {linear: pcg, stepping: fixed, steps: 2}\nmethod: {force: gmpd}\n", PASSES, "0.2" },
        { "solver: {linear: cholmod, stepping: fixed, steps: 2}\nmethod: {force: fcbm}\n", PASSES, "0.2" },
        { "stages: [{name: one, boundary: {hi: 1}}, {name: two, boundary: {side: 1}}]\nsolver: {stepping: "
          "fixed, "
          "steps: 1}\n", "", "0.2" },
        { "stages: [{name: one, boundary: {hi: 1}}, {name: two, boundary: {side: 1}}]\nsolver: {stepping: "
          "event}\n", "", "0.2" },
    };
    for (size_t k = 0; k < sizeof ways / sizeof *ways; k++) {
        run r = scene_of (1, SQUARE CUT2 OFF GUIDED2 "%s", ways[k].nu, ways[k].side, ways[k].solver);
        refused (&r, "a loose part of the body, 40 of its 100 points", "along x (");
    }
}

/* A hinge: the body turns about the point that is held. */
static void a_free_rotation_is_named (void **state)
{
    (void) state;
    run r = scene_of (1, SQUARE OFF "sets: {pin: {where: \"x < 1 mm and y < 1 mm\"}}\nmethod: {force: bond}\n"
                         "boundary: [{set: pin, displacement: {x: 0, y: 0}}, {name: side, set: right, "
                         "traction: {y: "
                         "1 MPa}}]\n", "0.3333");
    refused (&r, "nothing holds the body", "about z through (0.0005, 0.0005) m");
}

/* A front cuts off a part that slides along its faces: an equilibrium that contact alone holds is looked for,
 * none is found, and the part is named (auto; the matrix loses its Cholesky factor on the way). */
static void what_contact_alone_holds_is_named (void **state)
{
    (void) state;
    pg_status status = PG_OK;
    run r = scene_of (1, "dimension: 3\nspacing: 0.2\n"
                         "body: [{add: {box: {low: [0, 0, 0], high: [1, 1, 0.6]}}}]\n"
                         "materials: {m: {youngs_modulus: 1e9, poissons_ratio: 0.25}}\n"
                         "cracks: [{polygon: [[-0.1, 0.43, -0.1], [0.45, 0.57, -0.1], [0.45, 0.57, 0.7],\n"
                         "  [-0.1, 0.43, 0.7]]}]\nmethod: {horizon: 2 spacing}\ncontact: {kind: normal}\n"
                         "failure: {criterion: energy_release, fracture_energy: 100}\n"
                         "boundary: [{name: foot, set: bottom, displacement: {x: 0, y: 0, z: 0}},\n"
                         "  {name: head, set: top, displacement: {y: -0.001}}]\n"
                         "solver: {stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n");
    while (status == PG_OK && !pg_solver_done (r.solver, r.state))
        status = pg_solver_step (r.solver, r.state, &r.step);
    assert_int_equal (status, PG_E_EQUILIBRIUM);
    check_contains (pg_last_error (), "contact alone holds a part of the body, 46 of its 144 points");
    check_contains (pg_last_error (), "free to move along x, along z and about y");
    clear (&r);
}

/* Both ends pulled: nothing is held, and nothing moves but by strain. Springs hold. */
static void loads_that_balance_are_borne (void **state)
{
    (void) state;
    static const char *const linear[] = { "auto", "cholmod", "pcg" };
    for (size_t k = 0; k < 3; k++) {
        run r = scene_of (1, SQUARE OFF "boundary: [{name: a, set: left, traction: {x: -1 MPa}}, {name: "
                                        "b, set: "
                             "right, traction: {x: 1 MPa}}]\nsolver: {stepping: fixed, steps: 1, linear: "
                             "%s}\n",
                          "0.2", linear[k]);
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        int told = 0;
        for (size_t w = 0; w < report->nwarning; w++)
            told |= strstr (report->warning[w], "is free to move along x, along y and about z: its loads "
                                                "balance")
                    != NULL;
        assert_true (told);
        double *u = field_of (&r, NULL, "displacement", NULL);
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            check_absolute (u[2 * i], 1e-4 * (r.problem->cloud.x[2 * i] - 5e-3), 5e-10);
            check_absolute (u[2 * i + 1], -2e-5 * (r.problem->cloud.x[2 * i + 1] - 5e-3), 5e-10);
        }
        pg_free (u);
        clear (&r);
    }
    run r = scene_of (1, SQUARE CUT2 OFF "method: {force: bond}\nboundary: [{set: bottom, displacement: "
                                         "{x: 0, y: 0}}, "
                         "{set: top, spring: {x: 1 MN/m, y: 1 MN/m}}, {name: side, set: right, pressure: "
                         "3 MPa}]\n"
                         "solver: {stepping: fixed, steps: 1}\n", "0.3333");
    to_the_end (&r);
    check_below (largest_of (r.state->d, r.state->ndof), 1e-3);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_linear_solver_refuses),
        cmocka_unit_test (every_way_of_stepping_refuses),
        cmocka_unit_test (a_free_rotation_is_named),
        cmocka_unit_test (what_contact_alone_holds_is_named),
        cmocka_unit_test (loads_that_balance_are_borne),
    };
    return cmocka_run_group_tests_name ("solve/free_parts", tests, NULL, NULL);
}
