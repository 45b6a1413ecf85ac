/* SPDX-License-Identifier: GPL-3.0-or-later
 * Event stepping where growth goes on by itself: a held load is the limit of fixed load steps, bond by bond;
 * in motion reactions go on smoothly, energies add up, and the end is an equilibrium; both are resumed bit by
 * bit and can be stopped in the middle; what does not go together is refused. */
#include "refused.h"
#include "scene_runs/run.h"
#include "tape.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [12 mm, 15 " \
    "mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 7.5 mm], to: [4 mm, 7.5 mm]}]\n" \
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: %s, density: 2500 kg/m3}}\n%s" \
    "method: {%s}\nboundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n%s" \
    "  - {set: top, displacement: {y: 20 um}%s}\n"

/* Every criterion with a force of shape functions and one of bonds, as far as they go together. */
static const struct { const char *nu, *fails, *how;
} cases[] = {
    { "0.22", "criterion: principal_stress, tensile_strength: 30 MPa", "" },
    { "0.22", "criterion: mohr_coulomb, tensile_strength: 30 MPa, cohesion: 45 MPa, friction_angle: 35 deg",
      "integration: nodal" },
    { "0.22", "criterion: stretch, critical_stretch: 4e-4", "integration: consistent" },
    { "0.22", "criterion: stretch, critical_stretch: 4e-4, stretch: finite", "essential: transformation" },
    { "0.3333333333333333", "criterion: stretch, critical_stretch: 4e-4", "force: bond, horizon: 3 spacing" },
    { "0.22", "criterion: stretch, critical_stretch: 4e-4", "force: lps, horizon: 3 spacing" },
    { "0.22", "criterion: node_energy, fracture_energy: 20 J/m2", "force: lps, horizon: 3 spacing" },
    { "0.22", "criterion: beam_limits, fracture_energy: 20 J/m2", "force: gmpd, horizon: 3 spacing" },
    { "0.22", "criterion: beam_limits, modes: single, fracture_energy: 20 J/m2",
      "force: gmpd, horizon: 3 spacing" },
};
static const char *const loads[] = {
    "", "  - {set: right, traction: {x: 3 MPa, y: 1 MPa}, ramp: constant}\n"
};
enum { CASES = sizeof cases / sizeof *cases, MOST = 100, ENOUGH = 20, STEPS = 300 };

/* ramp: of the displacement of the top, ", ramp: ..." */
static run plate_with (int c, int load, const char *ramp, const char *solver)
{
    char failure[160];
    snprintf (failure, sizeof failure, "failure: {%s, exclude: [right, top, bottom]}\n", cases[c].fails);
    return scene_of (1, PLATE "solver: {%s}\noutput: {at: {levels: 1}}\n", cases[c].nu, failure,
                     cases[c].how, loads[load], ramp, solver);
}

static run plate (int c, int load, const char *solver) { return plate_with (c, load, "", solver); }

/* The first bonds that break, and at which load factor; before the step at hand there were `start`. */
typedef struct { size_t bond[MOST]; double factor[MOST]; size_t n, start, most; } sequence;
static void take (sequence *s, const pg_step *step)
{
    s->n = s->start;
    for (size_t k = 0; k < step->nbroken && s->n < s->most; k++)
        s->bond[s->n] = step->broken[k].bond, s->factor[s->n++] = step->broken[k].time;
}

static pg_status note (void *context, const pg_state *state, const pg_step *so_far)
{
    sequence *s = context;
    (void) state;
    take (s, so_far);
    return s->n < s->most ? PG_OK : pg_error (PG_E_USAGE, PG_HERE, "enough");
}

/* To the end, or until there are enough, also in the middle of a step: one in which the body comes apart
 * would be refused as a whole. */
static void follow (run *r, sequence *out, size_t most)
{
    *out = (sequence) { .most = most };
    pg_solver_watch (r->solver, note, out);
    while (!pg_solver_done (r->solver, r->state) && out->n < most) {
        double before = r->state->factor;
        out->start = out->n;
        if (pg_solver_step (r->solver, r->state, &r->step) != PG_OK) return;
        assert_true (r->state->factor >= before);      /* the load never falls */
        take (out, &r->step);
    }
}

/* PERIGAL_TEST_SIZE=long: every case with both loads; else they take turns. */
static int loads_apart (void)
{
    return longer () ? 1 : 2;
}
static int first_load (int c) { return loads_apart () == 1 ? 0 : c % 2; }

/* A held load breaks the bonds that fixed steps break, in their order, and within the step in which they do.
 * The steps are fine: all of them lie between the first and the last of these bonds. */
static void a_held_load_is_the_limit_of_fixed_steps (void **state)
{
    (void) state;
    static sequence held, fixed;
    long unstable = 0;
    for (int c = 0; c < CASES; c++)
        for (int load = first_load (c); load < 2; load += loads_apart ()) {
            char steps[64], ramp[96];
            run a = plate (c, load, "stepping: event, on_instability: hold");
            follow (&a, &held, ENOUGH);
            const pg_statistics *report = pg_solver_report_now (a.solver);
            assert_int_equal (held.n, ENOUGH);
            assert_true ((report->unstable.count > 0) == (report->unstable.steps > 0));
            assert_int_equal (report->bonds_over_limit, 0);
            unstable += report->unstable.steps;
            double low = held.factor[0] * (1 - 1e-5), high = held.factor[ENOUGH - 1] * (1 + 1e-5);
            snprintf (steps, sizeof steps, "stepping: fixed, steps: %d", STEPS);
            snprintf (ramp, sizeof ramp, ", ramp: '%.17g + %.17g*t'", low, high - low);
            run b = plate_with (c, load, ramp, steps);
            follow (&b, &fixed, ENOUGH);
            assert_int_equal (fixed.n, ENOUGH);
            for (size_t k = 0; k < ENOUGH; k++) {
                double upper = low + (high - low) * fixed.factor[k];
                if (held.bond[k] != fixed.bond[k])
                    print_error ("case %d, load %d: %zu-th bond at %.9g, and before %.9g\n", c, load, k,
                                 held.factor[k], upper);
                assert_int_equal (held.bond[k], fixed.bond[k]);
                assert_true (held.factor[k] <= upper * (1 + 1e-9)
                             && held.factor[k] >= upper - (high - low) / STEPS - 1e-9 * upper);
            }
            clear (&a), clear (&b);
        }
    assert_true (unstable > 5 * CASES / loads_apart ());
}

/* The load falls where that is followed, with both kinds of loads, and at every event the worst bond is at
 * its limit: the way back went no farther than it had to. */
static void snap_back_is_followed_to_the_limit (void **state)
{
    (void) state;
    int falls = 0;
    for (int c = 0; c < CASES; c++)
        for (int load = first_load (c); load < 2; load += loads_apart ()) {
            run r = plate (c, load, "stepping: event, max_events: 25");
            int fell = 0;
            while (!pg_solver_done (r.solver, r.state)) {
                double before = r.state->factor;
                advance (&r);
                fell |= r.state->factor < before * (1 - 1e-6);
                if (r.step.nbroken && r.state->factor != before) check_relative (r.step.utilisation, 1, 1e-9);
            }
            if (load == 0) assert_true (fell);
            falls += fell;
            const pg_statistics *report = pg_solver_report_now (r.solver);
            assert_int_equal (report->unstable.count, 0);
            clear (&r);
        }
    assert_true (falls > (CASES + CASES / 2) / loads_apart ());
}

/* ---- motion -------------------------------------------------------------------------------------------- */
#define DYNAMIC "stepping: event, on_instability: dynamic"

/* The equilibrium that the force itself finds: what it lacks, over the reference force. */
static double unbalanced (run *r)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    double *residual = pg_calloc (r->state->ndof, sizeof *residual), reference = 0, sum = 0;
    check_ok (force->balance (self, r->state->factor, r->state->d, residual, &reference));
    const pg_sparse *T = force->basis ? force->basis (self) : NULL;
    double *free_part = pg_calloc (r->state->ndof, sizeof *free_part);
    if (T) pg_sparse_multiply_transposed (T, residual, free_part);
    size_t n = T ? T->ncol : r->state->ndof;
    for (size_t i = 0; i < n; i++) sum += T ? free_part[i] * free_part[i] : residual[i] * residual[i];
    pg_free (residual), pg_free (free_part);
    return sqrt (sum) / reference;
}

/* Until a motion has begun and come to rest again; sums what steps say that breaking took. near: distance of
 * the bonds that set it off from the supports, m. */
static void through_a_motion (run *r, double *broken, double *near)
{
    int moved = 0;
    *broken = 0;
    while (!pg_solver_done (r->solver, r->state)) {
        double kinetic = pg_solver_report_now (r->solver)->energy.kinetic;
        advance (r);
        *broken += r->step.dissipated;
        for (size_t k = 0; k < r->step.nbroken && !(r->step.motion > 0); k++) {
            double y = r->step.broken[k].place[1];
            *near = fmin (fmin (y, 15e-3 - y), k ? *near : 1);
        }
        if (r->step.motion > 0) moved = 1;
        const pg_statistics *now = pg_solver_report_now (r->solver);
        if (r->step.instability && !r->step.nbroken) assert_true (r->step.dissipated == 0);
        if (r->step.instability) assert_true (r->step.motion > 0);
        if (moved && kinetic > 0 && now->energy.kinetic == 0) return;
    }
    assert_true (moved);
}

/* Shape functions: single bonds feed energy into a body in motion, which shatters without damping. */
static const char *const motions[2][3] = {
    { "motion: {alpha: 0, rayleigh: {mass: 1e6 1/s, stiffness: 2e-7 s}}",
      "motion: {rayleigh: {mass: 1e7 1/s}}",
      "motion: {alpha: 0, rayleigh: {mass: 1e8 1/s}, mass: consistent, dt: 1 us}" },
    { "motion: {alpha: 0}", "motion: {alpha: -0.1}", "motion: {mass: lumped, dt: 0.2 us, quiet: 5 us}" },
};

static void a_motion_begins_and_ends_smoothly (void **state)
{
    (void) state;
    int rested = 0, far = 0;
    for (int c = 0; c < CASES; c++)
        for (int load = first_load (c); load < 2; load += loads_apart ()) {
            char solver[160];
            double broken, near = 1;
            snprintf (solver, sizeof solver, DYNAMIC ", %s", motions[c > 3][(c + load) % 3]);
            run r = plate (c, load, solver);
            through_a_motion (&r, &broken, &near);
            const pg_statistics *report = pg_solver_report_now (r.solver);
            int shattered = report->energy.dissipated < -report->energy.external;
            /* a bond at a support takes its force along */
            if (near > 4e-3 && !shattered) {
                if (!(report->unstable.jump < 1e-8)) print_error ("case %d, load %d\n", c, load);
                check_below (report->unstable.jump, 1e-8);
                far++;
            }
            assert_true (report->unstable.count == 1 && report->unstable.steps > 10);
            check_scaled (broken, report->energy.dissipated, 1e-4, report->energy.external);
            for (size_t i = 0; i < r.state->ndof && report->energy.kinetic == 0; i++)
                assert_true (r.state->v[i] == 0);
            if (report->energy.kinetic == 0) {
                check_below (unbalanced (&r), 1e-8);
                rested++;
            }
            clear (&r);
        }
    assert_true (rested > CASES / loads_apart () && far > CASES / loads_apart ());
}

/* Without damping nothing is lost between two breaks; the loads being held, nothing is gained. */
static void an_undamped_motion_keeps_its_energy (void **state)
{
    (void) state;
    run r = plate (0, 1, DYNAMIC ", motion: {alpha: 0, quiet: 40 us}");
    int looks = 0;
    while (!(r.step.motion > 0)) advance (&r);
    while (looks < 20) {
        const pg_statistics *now = pg_solver_report_now (r.solver);
        double before = now->energy.external - now->energy.strain - now->energy.kinetic;
        advance (&r);
        assert_true (r.step.motion > 0 && r.step.motion < 40e-6);
        if (r.step.nbroken) continue;
        check_scaled (now->energy.external - now->energy.strain - now->energy.kinetic, before, 1e-10,
                      now->energy.strain);
        assert_true (now->energy.kinetic > 0);
        looks++;
    }
    clear (&r);
}

/* Newmark's solver gives the reactions of the end of a step, with alpha too: a body that creeps under
 * supports at points that stand still shows those of its equilibrium. */
static void reactions_do_not_depend_on_alpha (void **state)
{
    (void) state;
    for (int c = 3; c < 5; c++) {
        run a = scene_of (1,
                          PLATE "solver: {kind: newmark, alpha: -0.3, dt: 1 ms, end: 40 ms, rayleigh: "
                                "{mass: 1e5 1/s}}\noutput: {at: {levels: 1}}\n",
                          cases[c].nu, "", cases[c].how, "", ", ramp: constant"),
            b = scene_of (1,
                          PLATE "solver: {stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                          cases[c].nu, "", cases[c].how, "", "");
        to_the_end (&a), to_the_end (&b);
        check_relative (a.step.reaction[4], b.step.reaction[4], 1e-6);
        check_relative (a.step.reaction[1], b.step.reaction[1], 1e-6);
        clear (&a), clear (&b);
    }
}

/* ---- resuming ------------------------------------------------------------------------------------------ */
/* From a checkpoint after so many steps both go on alike, through whatever phase comes.
 * PERIGAL_TEST_SIZE=long: over 60 steps, else 20. */
static void a_resumed_run_goes_on_bit_by_bit (void **state)
{
    (void) state;
    static const struct { const char *solver; int c, after;
    } runs[] = {
        { "stepping: event, on_instability: hold", 0, 6 },
        { DYNAMIC ", motion: {alpha: -0.1, quiet: 4 us}", 0, 3 },
        { DYNAMIC ", motion: {alpha: -0.1, quiet: 4 us}", 0, 9 },
        { DYNAMIC ", motion: {alpha: -0.1, quiet: 4 us}", 4, 40 },
        { DYNAMIC ", motion: {quiet: 1 us}", 3, 20 },
        { DYNAMIC ", motion: {quiet: 1 us}", 3, 30 },
    };
    for (size_t k = 0; k < sizeof runs / sizeof *runs; k++)
        for (int load = first_load ((int) k); load < 2; load += loads_apart ()) {
            run a = plate (runs[k].c, load, runs[k].solver), b = plate (runs[k].c, load, runs[k].solver);
            tape t = { 0 };
            for (int i = 0; i < runs[k].after; i++) advance (&a);
            keep (&a, &t, 0);
            keep (&b, &t, 1);
            assert_int_equal (t.at, t.n);
            for (int i = 0; i < (longer () ? 60 : 20) && !pg_solver_done (a.solver, a.state); i++) {
                advance (&a), advance (&b);
                assert_true (a.state->factor == b.state->factor && a.step.nbroken == b.step.nbroken
                             && a.step.dissipated == b.step.dissipated && a.step.motion == b.step.motion
                             && a.step.instability == b.step.instability);
                assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
                assert_memory_equal (a.state->v, b.state->v, a.state->ndof * sizeof *a.state->v);
                assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
            }
            pg_free (t.byte);
            clear (&a), clear (&b);
        }
}

/* Stops at every look between rounds of breaking. */
static pg_status stop (void *context, const pg_state *state, const pg_step *so_far)
{
    (void) state, (void) so_far;
    ++*(long *) context;
    return pg_error (PG_E_USAGE, PG_HERE, "stopped");
}

/* PERIGAL_TEST_SIZE=long: over 80 steps, else 25. */
static void a_time_step_that_is_stopped_goes_on (void **state)
{
    (void) state;
    static const char *const solver = DYNAMIC ", motion: {alpha: -0.1, quiet: 4 us}";
    run a = plate (0, 0, solver), b = plate (0, 0, solver);
    long stops = 0;
    pg_solver_watch (b.solver, stop, &stops);
    for (int i = 0; i < (longer () ? 80 : 25) && !pg_solver_done (a.solver, a.state); i++) {
        advance (&a);
        for (int tries = 0; pg_solver_step (b.solver, b.state, &b.step) != PG_OK; tries++)
            assert_true (tries < 9999);
        assert_true (a.step.nbroken == b.step.nbroken && a.step.motion == b.step.motion);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
    }
    assert_true (stops > 0);
    clear (&a), clear (&b);
}

/* ---- what is refused ----------------------------------------------------------------------------------- */
static void what_does_not_go_together_is_refused (void **state)
{
    (void) state;
    static const struct { const char *density, *solver, *message;
    } wrong[] = {
        { "", DYNAMIC, "dynamic needs the density of material glass: give materials.glass.density" },
        { ", density: 2500 kg/m3", "stepping: fixed, on_instability: hold", "goes with stepping: event" },
        { ", density: 2500 kg/m3", "stepping: event, motion: {dt: 1 us}", "solver.motion.dt" },
        { ", density: 2500 kg/m3", "stepping: event, on_instability: hold, motion: {quiet: 1 us}",
          "goes with on_instability: dynamic" },
        { ", density: 2500 kg/m3", "stepping: event, on_instability: wait",
          "must be one of follow, hold, dynamic" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        char text[1024];
        snprintf (text, sizeof text,
                  "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [8 mm, 4 mm]}}}]\nspacing: 1 mm\n"
                  "thickness: 1 mm\nmaterials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22%s}}\n"
                  "failure: {criterion: principal_stress, tensile_strength: 30 MPa}\nboundary:\n  - {set: "
                  "bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {y: 1 um}}\n"
                  "solver: {%s}\n",
                  wrong[k].density, wrong[k].solver);
        check_refused (text, wrong[k].message);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_held_load_is_the_limit_of_fixed_steps),
        cmocka_unit_test (snap_back_is_followed_to_the_limit),
        cmocka_unit_test (a_motion_begins_and_ends_smoothly),
        cmocka_unit_test (an_undamped_motion_keeps_its_energy),
        cmocka_unit_test (reactions_do_not_depend_on_alpha),
        cmocka_unit_test (a_resumed_run_goes_on_bit_by_bit),
        cmocka_unit_test (a_time_step_that_is_stopped_goes_on),
        cmocka_unit_test (what_does_not_go_together_is_refused),
    };
    return cmocka_run_group_tests_name ("solve/instability", tests, NULL, NULL);
}
