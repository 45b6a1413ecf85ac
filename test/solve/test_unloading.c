/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fixed load steps that come back to zero and go through it: where the load vanishes all forces do, and the
 * largest that the body has borne is the measure. A body that nothing holds is refused by every method, in
 * every stepping: rounding excuses nothing that moves on at each refinement. */
#include "scene_runs/run.h"
#include "tape.h"

static const char *const elastic[] = {
    "method: {essential: nitsche}\n",
    "method: {essential: transformation}\n",
    "method: {essential: penalty}\n",
    "method: {essential: nitsche}\nsolver.linear: pcg\n",
    "method: {approximation: pddo, integration: gauss}\n",
    "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n",
    "method: {integration: consistent}\n",
    "method: {force: lps, horizon: 3 spacing}\n",
    "method: {force: gmpd, horizon: 3 spacing}\n",
};
enum { ELASTIC = sizeof elastic / sizeof *elastic };
static const char *const bodies[] = {
    "dimension: 2\nthickness: 10 mm\nbody: [{add: {box: {low: [0, 0], high: [1 m, 0.6 m]}}}]\nspacing: 0.1 "
    "m\n",
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.8 m, 0.4 m, 0.4 m]}}}]\nspacing: 0.2 m\n",
};
static const char *const fixed[] = { "x: 0, y: 0", "x: 0, y: 0, z: 0" };

/* The load of each eighth of the run: up, back to nothing, through it to the other side and back again. */
static run there_and_back (int body, const char *method, const char *load)
{
    const char *linear = strstr (method, "solver.linear: ");
    char keys[160];
    snprintf (keys, sizeof keys, "%.*s", linear ? (int) (linear - method) : (int) strlen (method), method);
    return scene_of (
        1,
        "%smaterials: {m: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n%s"
        "boundary:\n - {set: left, displacement: {%s}}\n - {set: right, %s, table: [[0, 0], [0.25, 1], [0.5, "
        "0], [0.75, -1], [1, 0]]}\n"
        "solver: {stepping: fixed, steps: 8, linear: %s}\noutput: {at: {levels: 1}}\n",
        bodies[body], keys, fixed[body], load, linear ? "pcg" : "auto");
}

static void unloading_to_nothing_and_through_it_is_solved (void **state)
{
    (void) state;
    static const char *const ways[] = { "displacement: {x: 1 mm, y: 0.2 mm}",
                                        "traction: {x: 1 MPa, y: 0.3 MPa}" };
    for (int body = 0; body < 2; body++)
        for (int m = 0; m < ELASTIC; m++)
            for (int w = 0; w < 2; w++) {
                run r = there_and_back (body, elastic[m], ways[w]);
                double top = 0, pull[2] = { 0 };
                for (int step = 1; step <= 8; step++) {
                    advance (&r);
                    double u = largest_of (r.state->d, r.state->ndof);
                    if (step == 2) top = u, pull[0] = r.step.reaction[3], pull[1] = r.step.reaction[4];
                    else if (step % 4 == 0) {
                        check_below (u, 1e-9 * top);
                        check_below (fabs (r.step.reaction[3]), 1e-8 * fabs (pull[0]));
                    } else if (step == 6)
                        for (int k = 0; k < 2; k++)
                            check_scaled (r.step.reaction[3 + k], -pull[k], 1e-7, fabs (pull[0]));
                    check_below (r.step.residual, 1e-8);
                }
                assert_true (top > 0);
                const pg_statistics *report = pg_solver_report_now (r.solver);
                for (size_t k = 0; k < report->nwarning; k++)
                    assert_null (strstr (report->warning[k], "nothing loads the body"));
                clear (&r);
            }
}

/* ---- resuming ------------------------------------------------------------------------------------------ */
/* What the body has borne is in a checkpoint: unloading goes on after it, bit by bit. */
static void a_run_that_is_resumed_before_it_is_unloaded_remembers_its_load (void **state)
{
    (void) state;
    for (int m = 0; m < 3; m++) {
        run a = there_and_back (0, elastic[m], "displacement: {x: 1 mm, y: 0.2 mm}"),
            b = there_and_back (0, elastic[m], "displacement: {x: 1 mm, y: 0.2 mm}");
        tape t = { 0 };
        for (int step = 1; step <= 3; step++) advance (&a);
        keep (&a, &t, 0);
        keep (&b, &t, 1);
        assert_int_equal (t.at, t.n);
        while (!pg_solver_done (a.solver, a.state)) {
            advance (&a), advance (&b);
            assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
            assert_true (a.step.residual == b.step.residual);
        }
        pg_free (t.byte);
        clear (&a), clear (&b);
    }
}

/* ---- nothing holds the body ---------------------------------------------------------------------------- */
static const char *const methods[] = {
    "approximation: rkpm, integration: gauss",
    "approximation: rkpm, integration: nodal",
    "approximation: rkpm, integration: consistent",
    "approximation: rkpm, basis: quadratic, horizon: 3 spacing",
    "approximation: pddo, integration: gauss",
    "approximation: pddo, integration: nodal",
    "approximation: pddo, basis: quadratic, horizon: 3 spacing",
    "approximation: nosb, integration: gauss",
    "approximation: nosb, integration: nodal",
    "approximation: nosb, integration: consistent",
    "force: bond, horizon: 3 spacing",
    "force: fcbm, horizon: 3 spacing",
    "force: lps, horizon: 3 spacing",
    "force: gmpd, horizon: 3 spacing",
};
enum { METHODS = sizeof methods / sizeof *methods };
static const struct { const char *support, *load;
} loose[] = {
    { "", "x: 1 MPa" },
    { " - {set: left, displacement: {x: 0}}\n", "y: 1 MPa" },
    { " - {set: pin, displacement: {x: 0, y: 0}}\n", "y: 1 MPa" },
};

/* Held by nothing, along one axis, at one point: loads push it away, along the support, around it. */
static void a_load_on_a_body_that_may_move_or_turn_is_refused (void **state)
{
    (void) state;
    for (int body = 0; body < 2; body++)
        for (int m = 0; m < METHODS; m++)
            for (int s = 0; s < 3; s++)
                for (int event = 0; event < 2; event++) {
                    int bonds = strstr (methods[m], "force: bond") || strstr (methods[m], "fcbm");
                    run r =
                        scene_of (1,
                                  "%smaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: %.17g}}\nmethod: "
                                  "{%s}\nsets: {pin: {where: 'abs(x) < 1e-6 and abs(y) < 1e-6'}}\n"
                                  "boundary:\n%s - {set: right, traction: {%s}}\nsolver: {stepping: %s, "
                                  "steps: 2, tolerance: 1e-8}\noutput: {at: {levels: 1}}\n",
                                  bodies[body], bonds ? body ? 0.25 : 1.0 / 3 : 0.2, methods[m],
                                  loose[s].support, loose[s].load, event ? "event" : "fixed");
                    pg_status status = pg_solver_step (r.solver, r.state, &r.step);
                    if (status == PG_OK)
                        print_error ("%dD, %s, case %d, %s: u = %g\n", body + 2, methods[m], s,
                                     event ? "event" : "fixed", largest_of (r.state->d, r.state->ndof));
                    assert_true (status == PG_E_EQUILIBRIUM || status == PG_E_NOT_SPD
                                 || status == PG_E_SINGULAR);
                    assert_true (largest_of (r.state->d, r.state->ndof) == 0);
                    clear (&r);
                }
}

/* A run is told before its first step that a rotation is free. */
static void a_free_rotation_is_told (void **state)
{
    (void) state;
    static const struct { int dim; const char *supports; int turns;
    } held[] = {
        { 2, "{set: left, displacement: {x: 0}}, {set: pin, displacement: {y: 0}}", 0 },
        { 2, "{set: pin, displacement: {x: 0, y: 0}}", 1 },
        { 2, "{set: pin, displacement: {x: 0, y: 0}}, {set: far, displacement: {y: 0}}", 0 },
        { 2, "{set: pin, displacement: {x: 0, y: 0}}, {set: far, displacement: {x: 0}}", 1 },
        { 3, "{set: left, displacement: {x: 0, y: 0, z: 0}}", 0 },
        { 3, "{set: edge, displacement: {x: 0, y: 0, z: 0}}", 1 },
        { 3, "{set: left, displacement: {x: 0}}, {set: pin, displacement: {y: 0, z: 0}}", 1 },
        { 3,
          "{set: left, displacement: {x: 0}}, {set: bottom, displacement: {y: 0}}, {set: back, displacement: "
          "{z: 0}}",
          0 },
    };
    for (size_t k = 0; k < sizeof held / sizeof *held; k++) {
        run r =
            scene_of (1,
                      "%smaterials: {m: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nsets: {pin: {where: "
                      "'abs(x) < 1e-6 and abs(y) < 1e-6 and abs(z) < 1e-6'}, far: {where: 'x > 0.79 and "
                      "abs(y) < 1e-6 and abs(z) < 1e-6'}, edge: {where: 'abs(x) < 1e-6 and abs(y) < "
                      "1e-6'}}\nboundary: [%s, {set: right, traction: {x: 1 MPa}}]\n",
                      bodies[held[k].dim - 2], held[k].supports);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        int told = 0;
        for (size_t w = 0; w < report->nwarning; w++)
            told |= strstr (report->warning[w], "nothing keeps the body from turning") != NULL;
        if (told != held[k].turns) print_error ("%s\n", held[k].supports);
        assert_int_equal (told, held[k].turns);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (unloading_to_nothing_and_through_it_is_solved),
        cmocka_unit_test (a_run_that_is_resumed_before_it_is_unloaded_remembers_its_load),
        cmocka_unit_test (a_free_rotation_is_told),
        cmocka_unit_test (a_load_on_a_body_that_may_move_or_turn_is_refused),
    };
    return cmocka_run_group_tests_name ("solve/unloading", tests, NULL, NULL);
}
