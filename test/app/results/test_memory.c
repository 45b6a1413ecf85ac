/* SPDX-License-Identifier: GPL-3.0-or-later
 * No memory, anywhere: each allocation of whole runs with breaking bonds fails once (problem, solver, state,
 * steps), then each of the result folder. Nothing crashes, nothing is lost, the status says so, and a refused
 * step leaves the state as it was. */
#include "folder.h"
#include "io/picture/fonts.h"

#define BODY \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.6, 0.5]}}}]\nspacing: 0.1\n" \
    "cracks: [{from: [-0.1, 0.25], to: [0.18, 0.25]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2, density: 2000}}\n" \
    "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
#define PULL "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 2 mm}}]\n"
static const struct { const char *name, *text;
} scenes[] = {
    { "event", BODY PULL "solver: {stepping: event}\n" },
    { "fixed", BODY PULL
      "method: {essential: transformation}\nsolver: {stepping: fixed, steps: 3, stop: {set: right}}\n" },
    { "nosb", BODY PULL "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: "
                        "penalty}\nsolver: {stepping: fixed, steps: 3, break: all}\n" },
    { "newmark", BODY "boundary: [{set: bottom, velocity: {x: 0, y: -4 m/s}}, {set: top, velocity: {y: 4 "
                      "m/s}, table: [[0, 0], [1e-3, 1]]}]\n"
                      "method: {essential: transformation}\nsolver: {kind: newmark, dt: 0.5 ms, end: 5 ms, "
                      "rayleigh: {stiffness: 1 us}}\n" },
    { "pcg", BODY PULL "solver: {stepping: fixed, steps: 3, linear: pcg}\n" },
    { "volumetric", BODY PULL "method: {force: gmpd, volumetric: on, bond_poisson: 0.1}\nsolver: {stepping: "
                              "event}\noutput: {at: {levels: 3}}\n" },
    { "umfpack", BODY PULL "solver: {stepping: event, linear: umfpack}\n" },
};
enum { SCENES = sizeof scenes / sizeof *scenes, STEPS = 3 };

/* Builds and makes three steps. *broken: bonds that died; *step: -1 while building. */
static pg_status make_run (const pg_scene *scene, long *broken, int *step)
{
    pg_status status = PG_OK;
    run r = { 0 };
    *step = -1;
    PG_TRY (pg_problem_build (&r.problem, scene, 1));
    PG_TRY (pg_solver_options_read (&r.options, r.problem, scene));
    PG_TRY (pg_solver_create (&r.solver, r.problem, &r.options));
    PG_TRY (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    for (*step = 0; *step < STEPS; ++*step) PG_TRY (pg_solver_step (r.solver, r.state, &r.step));
    *broken = r.state->broken;
done:
    if (status != PG_OK && r.state) assert_int_equal (r.state->step, *step);
    clear (&r);
    return status;
}

static void sweep (const char *name, const char *text, size_t dense, size_t most)
{
    pg_scene *scene = NULL;
    long broken = 0;
    int step;
    check_ok (pg_scene_parse (&scene, text, "sweep.yaml"));
    size_t calls = pg_memory_calls (), used = pg_memory_used ();
    pg_status status = make_run (scene, &broken, &step);
    if (status != PG_OK) print_error ("%s: %s\n", name, pg_last_error ());
    assert_int_equal (status, PG_OK);
    calls = pg_memory_calls () - calls;
    assert_int_equal (pg_memory_used (), used);
    assert_true (broken > 0 && calls > 100);
    size_t stride = calls > dense ? 1 + (calls - dense) / most : 1;
    for (size_t k = 1; k <= calls; k += k < dense ? 1 : stride) {
        pg_memory_fail_at (k);
        status = make_run (scene, &broken, &step);
        pg_memory_fail_at (0);
        if (status != PG_E_MEMORY || pg_memory_used () != used)
            print_error ("%s: allocation %zu of %zu (step %d): '%s', %zu bytes lost\n", name, k, calls, step,
                         pg_status_text (status), pg_memory_used () - used);
        assert_int_equal (status, PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    pg_scene_free (&scene);
}

static void every_allocation_of_a_run_may_fail (void **state)
{
    (void) state;
    /* long: every one; else the first 20, then about 5 of the rest */
    for (int i = 0; i < SCENES; i++)
        sweep (scenes[i].name, scenes[i].text, longer () ? 1000000 : 20, 5);
}

static void the_scene_too (void **state)
{
    (void) state;
    size_t used = pg_memory_used (), calls = pg_memory_calls ();
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, scenes[0].text, "sweep.yaml"));
    pg_scene_free (&scene);
    calls = pg_memory_calls () - calls;
    for (size_t k = 1; k <= calls; k++) {
        pg_memory_fail_at (k);
        pg_status status = pg_scene_parse (&scene, scenes[0].text, "sweep.yaml");
        pg_memory_fail_at (0);
        if (status != PG_E_MEMORY)
            print_error ("allocation %zu of %zu: '%s'\n", k, calls, pg_status_text (status));
        assert_int_equal (status, PG_E_MEMORY);
        assert_null (scene);
        assert_int_equal (pg_memory_used (), used);
    }
}

static size_t fail_at;

static pg_status write_result (const char *where, const run *r, int finish)
{
    pg_status status = PG_OK;
    pg_result *result = NULL;
    PG_TRY (pg_result_open (&result, where, r->scene, r->problem, r->solver));
    PG_TRY (pg_result_step (result, r->state, &r->step));
    PG_TRY (pg_result_step (result, r->state, &r->step));
    if (finish) PG_TRY (pg_result_finish (result, r->state, NULL, 0, 0));
done:
    pg_result_free (&result);
    return status;
}

/* What a run goes on without it tells in a warning. */
static int said (const run *r)
{
    const pg_statistics *report = pg_solver_report_now (r->solver);
    for (size_t k = 0; k < report->nwarning; k++) if (strstr (report->warning[k], "memory")) return 1;
    return 0;
}

static void every_allocation_of_a_result_may_fail (void **state)
{
    (void) state;
    char where[64];
    make_folder (where);
    run r = scene_of (1, "%soutput: {pictures: [damage]}\n", scenes[0].text);
    advance (&r), advance (&r);
    check_ok (write_result (where, &r, 1));
    size_t used = pg_memory_used (), start = pg_memory_calls (), reported = 0;
    check_ok (write_result (where, &r, 0));
    size_t opened = pg_memory_calls () - start;
    check_ok (write_result (where, &r, 1));
    /* pictures take their time */
    size_t calls = pg_memory_calls () - start - opened, stride = 1 + (calls - opened) / (longer () ? 25 : 6);
    assert_true (opened > 20 && calls > opened);
    for (size_t k = 1; k <= calls; k += k < opened ? 1 : stride) {
        run one = scene_of (1, "%soutput: {pictures: [damage]}\n", scenes[0].text);
        advance (&one), advance (&one);
        pg_memory_fail_at (k);
        pg_status status = write_result (where, &one, k > opened);
        pg_memory_fail_at (0);
        if ((status != PG_OK && status != PG_E_MEMORY) || (status == PG_OK && !said (&one)))
            print_error ("allocation %zu of %zu: %s, '%s'\n", k, calls, pg_status_text (status),
                         pg_last_error ());
        assert_true (status == PG_E_MEMORY || (status == PG_OK && k > opened && said (&one)));
        reported += status == PG_E_MEMORY;
        clear (&one);
        if (pg_memory_used () != used)
            print_error ("allocation %zu of %zu: %zu bytes lost\n", k, calls, pg_memory_used () - used);
        assert_int_equal (pg_memory_used (), used);
    }
    assert_true (reported > opened / 2);
    clear (&r);
    remove_folder (where);
}

/* Steps, a checkpoint, another life that goes on from it. */
static pg_status write_and_resume (const char *where, const char *text)
{
    pg_status status = PG_OK;
    pg_resumed from;
    run r = scene_of (1, "%s", text), again = { 0 };
    pg_result *result = NULL;
    advance (&r), advance (&r);
    again = scene_of (1, "%s", text);
    check_ok (pg_result_discard (where));              /* of the life before */
    pg_memory_fail_at (fail_at);
    PG_TRY (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    PG_TRY (pg_result_step (result, r.state, &r.step));
    PG_TRY (pg_result_checkpoint (result, r.state));
    pg_result_free (&result);
    PG_TRY (pg_result_resume (&result, where, again.scene, again.problem, again.solver, again.state, &from));
    PG_TRY (pg_solver_step (again.solver, again.state, &again.step));
    PG_TRY (pg_result_step (result, again.state, &again.step));
done:
    pg_memory_fail_at (0);
    pg_result_free (&result);
    clear (&r), clear (&again);
    return status;
}

/* PERIGAL_TEST_SIZE=long: each. */
static void every_allocation_of_a_checkpoint_and_its_resumption_may_fail (void **state)
{
    (void) state;
    char where[64], text[2048];
    make_folder (where);
    for (int i = 0; i < 4; i++) {
        if (i == 2) continue;
        snprintf (text, sizeof text, "%soutput: {pictures: []}\n", scenes[i].text);
        size_t used = pg_memory_used (), failed = 0;
        pg_status status = PG_E_MEMORY;
        for (fail_at = 1; status != PG_OK;
             fail_at += longer () ? 1 : 1 + fail_at / 5, failed++) {
            status = write_and_resume (where, text);
            if (status != PG_OK && status != PG_E_MEMORY)
                print_error ("%s: allocation %zu: '%s'\n", scenes[i].name, fail_at, pg_last_error ());
            assert_true (status == PG_OK || status == PG_E_MEMORY);
            if (pg_memory_used () != used)
                print_error ("%s: allocation %zu: %zu bytes lost\n", scenes[i].name, fail_at,
                             pg_memory_used () - used);
            assert_int_equal (pg_memory_used (), used);
        }
        assert_true (failed > (longer () ? 40 : 20));
    }
    remove_folder (where);
}

/* A step refused for memory can be made again, with the same outcome as if nothing had happened. */
static void a_step_refused_for_memory_can_be_repeated (void **state)
{
    (void) state;
    for (int i = 0; i < 4; i++) {
        if (i == 2) continue;
        run plain = scene_of (1, "%s", scenes[i].text), tried = scene_of (1, "%s", scenes[i].text);
        advance (&plain), advance (&tried);
        for (int k = 0; k < STEPS - 1; k++) {
            size_t refused = 0;
            for (size_t at = 1;; at += 1 + at / 2) {
                pg_memory_fail_at (at);
                pg_status status = pg_solver_step (tried.solver, tried.state, &tried.step);
                pg_memory_fail_at (0);
                if (status == PG_OK) break;
                assert_int_equal (status, PG_E_MEMORY);
                assert_int_equal (tried.state->step, k + 1);
                refused++;
            }
            advance (&plain);
            assert_true (refused > 0 || scenes[i].text == scenes[0].text);
            assert_int_equal (tried.state->broken, plain.state->broken);
            assert_memory_equal (tried.state->alive, plain.state->alive, plain.state->nbond);
            const pg_statistics *a = pg_solver_report_now (plain.solver),
                                *b = pg_solver_report_now (tried.solver);
            check_below (fabs (a->energy.external - b->energy.external), 1e-9 * fabs (a->energy.external));
            check_below (fabs (a->energy.dissipated - b->energy.dissipated),
                         1e-9 * fabs (a->energy.external));
            check_below (largest_difference (tried.state->d, plain.state->d, plain.state->ndof),
                         1e-9 * largest_of (plain.state->d, plain.state->ndof));
        }
        clear (&plain), clear (&tried);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_allocation_of_a_run_may_fail),
        cmocka_unit_test (the_scene_too),
        cmocka_unit_test (every_allocation_of_a_result_may_fail),
        cmocka_unit_test (every_allocation_of_a_checkpoint_and_its_resumption_may_fail),
        cmocka_unit_test (a_step_refused_for_memory_can_be_repeated),
    };
    return cmocka_run_group_tests_name ("app/results/memory", tests, NULL, NULL);
}
