/* SPDX-License-Identifier: GPL-3.0-or-later
 * Facets in motion that take more or less than their fracture energy: the run says so when it happens, with
 * time, place and factor, and of the cut that sets free more than its facet takes. What it says is compared
 * with the energies of each step. */
#include "run.h"
#include <math.h>

/* The warning that has these words. */
static const char *warning_of (const run *r, const char *words)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    for (size_t k = 0; k < s->nwarning; k++) if (strstr (s->warning[k], words)) return s->warning[k];
    return NULL;
}

/* A number behind some words. */
static double behind (const char *text, const char *words)
{
    const char *at = strstr (text, words);
    assert_non_null (at);
    return strtod (at + strlen (words), NULL);
}

/* A square whose notch is torn open by a sudden load. */
#define TORN "dimension: 2\nplane: strain\nthickness: 10 mm\n" \
    "body: [{add: {box: {low: [0 mm, 0 mm], high: [100 mm, 100 mm]}}}]\nspacing: 5 mm\nlattice: cells\n" \
    "cracks: [{from: [0 mm, 50 mm], to: [40 mm, 50 mm]}]\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n" \
    "failure: {criterion: energy_release, fracture_energy: 20 J/m2}\nmethod: {integration: consistent}\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: %g mm}}]\n" \
    "solver: {kind: newmark, dt: 5e-6 s, time_steps: 40}\n"

static void energy_out_of_bounds_is_told_when_it_happens (void **state)
{
    (void) state;
    static const double pull[] = { 0.1, 0.0307 };      /* many facets; 9 of them, told at the end */
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1, TORN, pull[k]);
        double when = NAN, share = NAN, x[2] = { NAN, NAN };
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *s = pg_solver_report (r.solver, r.state);
            const pg_crack_paths *w = r.state->paths;
            double now = s->energy.dissipated / s->energy.fracture;
            int few = w->length < 0.05, last = pg_solver_done (r.solver, r.state);
            if (!isnan (when) || !(w->length > (few ? 0.02 : 0)) || (few && !last)) continue;
            if (now > (few ? 0.75 : 0.9) && now < (few ? 1.3 : 1.1)) continue;
            when = r.state->time, share = now;
            for (int i = 0; i < 2; i++) x[i] = w->cracks.crack[w->cracks.n - 1].vertex[2 + i];
        }
        const char *said = warning_of (&r, "the cracks have dissipated");
        assert_true (!isnan (when));
        assert_non_null (said);
        print_message ("%s\n", said);
        check_relative (behind (said, "at t = "), when, 1e-3);
        check_relative (behind (said, "dissipated "), share, 1e-2);
        check_relative (behind (said, "facet being at ("), x[0], 1e-3);
        check_relative (behind (strstr (said, "facet being at ("), ", "), x[1], 1e-3);
        clear (&r);
    }
}

/* Cracks that cross, and a plate that is hit: a facet that reaches the surface beside others sets a multiple
 * of its energy free at its cut. */
static void a_cut_that_sets_much_free_is_told (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: strain\nthickness: 10 mm\n"
        "body: [{add: {box: {low: [0 mm, 0 mm], high: [100.0 mm, 50.0 mm]}}}, "
        "{add: {box: {low: [20.0 mm, 50.0 mm], high: [80.0 mm, 100.0 mm]}}}]\n"
        "spacing: 6.25 mm\nlattice: cells\n"
        "cracks: [{from: [20.0 mm, 50.0 mm], to: [60.0 mm, 50.0 mm]}, {polyline: [[38.695837 mm, "
        "71.23119 mm], [40.910459 mm, 43.358097 mm], [73.993574 mm, 48.324801 mm], [51.272427 mm, "
        "10.14139 mm]]}, {from: [30.0 mm, 30.0 mm], to: [70.0 mm, 70.0 mm]}, "
        "{from: [30.0 mm, 70.0 mm], to: [70.0 mm, 30.0 mm]}]\n"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n"
        "failure: {criterion: energy_release, fracture_energy: 20 J/m2}\n"
        "method: {integration: consistent, horizon: 1.6 spacing, degenerate: projected, accept_inexact: on}\n"
        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: -0.3 mm}}]\n"
        "solver: {kind: newmark, dt: 6.25e-06 s, time_steps: 20}\n");
    double before = 0, top = 0, when = 0;
    while (!pg_solver_done (r.solver, r.state)) {
        double length = r.state->paths->length;
        advance (&r);
        const pg_statistics *s = pg_solver_report (r.solver, r.state);
        double lost = s->energy.dissipated - before;
        if (r.state->paths->length > length && fabs (lost) > top) top = fabs (lost), when = r.state->time;
        before = s->energy.dissipated;
    }
    const char *said = warning_of (&r, "as it is cut");
    assert_non_null (said);
    print_message ("%s; largest step %.3g J at %.4g s\n", said, top, when);
    assert_true (fabs (behind (said, "s sets ")) > 4);
    assert_true (behind (said, "at t = ") <= r.state->time);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (energy_out_of_bounds_is_told_when_it_happens),
                                        cmocka_unit_test (a_cut_that_sets_much_free_is_told) };
    return cmocka_run_group_tests_name ("scene_runs/motion_energy", tests, NULL, NULL);
}
