/* SPDX-License-Identifier: GPL-3.0-or-later
 * A tip that runs by facets and branches: where it has the energy for two tips, to both sides alike, by every
 * solver in motion; not below half of the speed of Rayleigh waves, and not where the scene forbids it. */
#include "run.h"
#include "solve/tape.h"
#include <math.h>

/* The plate of data/glass_branching on a spacing of 1 mm. */
static run plate (const char *pull, const char *solver, const char *branching)
{
    char load[300], how[200];
    snprintf (load, sizeof load,
              "boundary=[{name: top, set: top, traction: {y: %s MPa}, ramp: constant}, {name: bottom, set: "
              "bottom, traction: {y: -%s MPa}, ramp: constant}]",
              pull, pull);
    snprintf (how, sizeof how, "solver={%s, end: 50 us, branching: %s}", solver, branching);
    const char *const set[] = { load, how, "spacing=1 mm", "output.at={levels: 1, rows: 1000}" };
    return loaded ("data/glass_branching/facets.yaml", 4, set);
}

/* Until the first branches have grown by two facets, or to that time. */
static void until_it_forks (run *r, double end)
{
    while (r->state->time < end && (r->state->paths->ntip < 3 || !(r->state->paths->tip[1].grown > 0)))
        advance (r);
}

/* To both sides alike, by 30 degrees. */
static void check_fork (const run *r)
{
    const pg_crack_paths *w = r->state->paths;
    assert_int_equal (w->ntip, 3);
    assert_false (w->tip[0].open);
    double fork = w->tip[0].x[0], *a = w->tip[1].x, *b = w->tip[2].x;
    print_message ("fork at %.4g mm, %.3g us\n", 1e3 * fork, 1e6 * r->state->time);
    assert_true (fork > 53e-3 && fork < 60e-3);
    check_absolute (w->tip[0].x[1], 0, 1e-9);
    check_absolute (a[0], b[0], 1e-9), check_absolute (a[1], -b[1], 1e-9);
    check_relative ((a[1] - b[1]) / (a[0] + b[0] - 2 * fork), tan (acos (-1) / 6), 1e-6);
}

/* The fork, and a run that is resumed while facets open and branches are not apart yet: it goes on bit by
 * bit. PERIGAL_TEST_SIZE=long: by Newmark's method as well. */
static void a_tip_with_the_energy_of_two_branches_alike (void **state)
{
    (void) state;
    static const char *const solver[] = { "kind: newmark, dt: 0.1 us", "kind: verlet" };
    for (int k = !longer (); k < 2; k++) {
        run a = plate ("12", solver[k], "on"), b = plate ("12", solver[k], "on");
        tape t = { 0 };
        int forked = 0;
        while (a.state->paths->ntip < 3 && a.state->time < 20e-6) advance (&a);
        keep (&a, &t, 0);
        keep (&b, &t, 1);
        assert_int_equal (t.at, t.n);
        for (int i = 0; i < 30; i++) {
            advance (&a), advance (&b);
            assert_int_equal (a.step.nbroken, b.step.nbroken);
            assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
            if (forked || !(a.state->paths->tip[1].grown > 0)) continue;
            forked = 1;
            check_fork (&a);
        }
        assert_true (forked);
        assert_true (a.step.dissipated == b.step.dissipated);
        pg_free (t.byte);
        clear (&a), clear (&b);
    }
}

/* Under 6 MPa the crack is slower; where branching is off it stays alone at any speed. PERIGAL_TEST_SIZE=
 * long. */
static void slower_tips_do_not (void **state)
{
    (void) state;
    if (!longer ()) return;
    run slow = plate ("6", "kind: newmark, dt: 0.1 us", "on"),
        single = plate ("12", "kind: newmark, dt: 0.1 us", "off");
    until_it_forks (&slow, 14e-6), until_it_forks (&single, 12e-6);
    assert_int_equal (slow.state->paths->ntip, 1);
    assert_int_equal (single.state->paths->ntip, 1);
    assert_true (single.state->paths->length > 5e-3);
    clear (&slow), clear (&single);
}

/* Time steps in which a wave passes a facet are too long. */
static void long_time_steps_are_told (void **state)
{
    (void) state;
    run r = plate ("12", "kind: newmark, dt: 0.4 us", "on");
    advance (&r);
    const pg_statistics *s = pg_solver_report_now (r.solver);
    int told = 0;
    for (size_t k = 0; k < s->nwarning; k++) told += strstr (s->warning[k], "a Rayleigh wave comes") != NULL;
    assert_int_equal (told, 1);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_tip_with_the_energy_of_two_branches_alike),
        cmocka_unit_test (slower_tips_do_not),
        cmocka_unit_test (long_time_steps_are_told),
    };
    return cmocka_run_group_tests_name ("scene_runs/branching", tests, NULL, NULL);
}
