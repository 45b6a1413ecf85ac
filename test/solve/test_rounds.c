/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rounds of breaking within a step: how many there may be, what breaks in one of them, when the crack has
 * arrived, and what was dissipated. */
#include "scene_runs/run.h"

#define PLATE PLATE_OF ("30 MPa")
#define PLATE_OF(strength) \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 10 " \
    "mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 5 mm], to: [6 mm, 5 mm]}]\n" \
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2500 kg/m3}}\nmethod: " \
    "{integration: nodal}\n" \
    "failure: {criterion: principal_stress, tensile_strength: " strength \
    ", exclude: [bottom, top]}\nsets: {ahead: {where: 'x > 8 mm and x < 11 mm and abs(y - 5 mm) < 1.6 " \
    "mm'}}\n" \
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {y: 10 um}}\n"

static void rounds_have_an_end (void **state)
{
    (void) state;
    for (int most = 1; most <= 4; most += 3) {
        run r = scene_of (1,
                          PLATE
                          "solver: {stepping: fixed, steps: 1, break: worst, tie: 0, max_iterations: %d}\n",
                          most);
        char words[80];
        check_fails (pg_solver_step (r.solver, r.state, &r.step), PG_E_EQUILIBRIUM);
        snprintf (words, sizeof words, "bonds still break after %d rounds", most);
        check_contains (pg_last_error (), words);
        clear (&r);
    }
}

/* However large the share, what is below its limit lives on. */
static void a_share_of_the_worst_breaks_above_its_limit_alone (void **state)
{
    (void) state;
    static const char *const shares[] = { "5 %%", "50 %%", "95 %%" };
    for (int k = 0; k < 3; k++) {
        char text[1600];
        snprintf (text, sizeof text,
                  "%ssolver: {stepping: fixed, steps: 8, break: fraction, break_fraction: %.*s}\n", PLATE,
                  (int) strlen (shares[k]) - 1, shares[k]);
        run r = prepare (1, text);
        size_t broken = 0;
        for (int step = 0; step < 4; step++) {
            advance (&r);
            for (size_t i = 0; i < r.step.nbroken; i++) assert_true (r.step.broken[i].utilisation >= 1);
            broken += r.step.nbroken;
            check_below (r.step.utilisation, 1 + 1e-12);
        }
        assert_true (broken > 5);
        clear (&r);
    }
}

static double damage_ahead (const run *r)
{
    const pg_set *set = pg_sets_find (&r->problem->sets, "ahead");
    double *value = field_of (r, NULL, "damage", NULL), top = 0;
    for (size_t i = 0; i < set->npoint; i++) top = fmax (top, value[set->point[i]]);
    pg_free (value);
    return top;
}

/* The run ends with the first row in which a point of the set has the damage. */
static void a_run_ends_when_the_crack_arrives (void **state)
{
    (void) state;
    static const char *const ways[] = { "stepping: event", "stepping: fixed, steps: 40, max_iterations: 1000",
                                        "kind: newmark, dt: 0.5 us, end: 200 us, max_iterations: 1000",
                                        "kind: verlet, end: 200 us" };
    for (int w = 0; w < 4; w++) {
        run r = scene_of (1,
                          PLATE
                          "solver: {%s, stop: {set: ahead, damage: 0.3}}\noutput: {at: {levels: 400}}\n",
                          ways[w]);
        double before = 0;
        int told = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            check_below (before, 0.3 - 1e-12);
            advance (&r);
            before = damage_ahead (&r);
        }
        assert_true (before >= 0.3);
        const pg_statistics *report = pg_solver_report_now (r.solver);
        for (size_t k = 0; k < report->nwarning; k++)
            told |= strstr (report->warning[k], "the crack has arrived at ahead") != NULL;
        assert_true (told);
        clear (&r);
    }
}

/* What loads have done and is neither strain nor motion has been dissipated: nothing, as long as nothing
 * breaks. */
static void nothing_is_dissipated_where_nothing_breaks (void **state)
{
    (void) state;
    static const char *const ways[] = { "kind: newmark, dt: 0.1 us, end: 3 us", "stepping: fixed, steps: 50",
                                        "kind: verlet, dt: 0.02 us, end: 2 us" };
    for (int w = 0; w < 3; w++) {
        run r = scene_of (1, PLATE_OF ("1 TPa") "solver: {%s}\n", ways[w]);
        double most = 0, kinetic = 0;
        for (int step = 0; step < 10; step++) {
            advance (&r);
            assert_int_equal (r.step.nbroken, 0);
            most = fmax (most, fabs (r.step.dissipated));
            kinetic = fmax (kinetic, pg_solver_report_now (r.solver)->energy.kinetic);
        }
        double work = pg_solver_report_now (r.solver)->energy.external;
        print_message ("%s: dissipated %g of %g, in motion %g\n", ways[w], most, work, kinetic);
        assert_true (work > 0 && (w == 1 || kinetic > 0.1 * work));
        check_below (most, 1e-6 * work);
        clear (&r);
    }
}

/* Where nothing breaks before it, event stepping goes from level to level, and reactions with it. */
static void levels_come_before_events_beyond_them (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE_OF ("1 TPa") "solver: {stepping: event}\noutput: {at: {levels: 4}}\n");
    double first = 0;
    for (int level = 1; level <= 4; level++) {
        advance (&r);
        check_relative (r.state->factor, 0.25 * level, 1e-12);
        if (level == 1) first = r.step.reaction[4];
        check_relative (r.step.reaction[4], level * first, 1e-9);
    }
    assert_true (first > 0 && pg_solver_done (r.solver, r.state));
    clear (&r);
}

static void a_body_in_pieces_ends_the_run (void **state)
{
    (void) state;
    run r = scene_of (1, PLATE "solver: {stepping: event, stop: {stiffness: 20 %%}}\n");
    int told = 0, events = 0;
    while (!pg_solver_done (r.solver, r.state) && events++ < 400) advance (&r);
    const pg_statistics *report = pg_solver_report_now (r.solver);
    for (size_t k = 0; k < report->nwarning; k++)
        told |= strstr (report->warning[k], "the body has separated") != NULL;
    assert_true (told && events < 400);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (rounds_have_an_end),
                                        cmocka_unit_test (a_share_of_the_worst_breaks_above_its_limit_alone),
                                        cmocka_unit_test (a_run_ends_when_the_crack_arrives),
                                        cmocka_unit_test (nothing_is_dissipated_where_nothing_breaks),
                                        cmocka_unit_test (levels_come_before_events_beyond_them),
                                        cmocka_unit_test (a_body_in_pieces_ends_the_run) };
    return cmocka_run_group_tests_name ("solve/rounds", tests, NULL, NULL);
}
