/* SPDX-License-Identifier: GPL-3.0-or-later
 * What Newmark's method spares changes no result: residuals carried by the iterations, one sweep for K d and
 * K v, first guesses from earlier steps, finite elements as preconditioner, factors that follow what breaks,
 * and bonds that are not judged because their ends rule them out, against the same run by plain sums. */
#include <math.h>
#include "scene_runs/run.h"

/* A plate with a crack, torn and sheared until bonds break; ends of the pulled side are exempt. */
static const char plate[] =
    "dimension: 2\nplane: %s\nthickness: 1 mm\n"
    "body: [{add: {box: {low: [0, 0], high: [20 mm, 10 mm]}}}]\n"
    "spacing: 1 mm\ncracks: [{from: [0, 5.2 mm], to: [6 mm, 5.2 mm]}]\n"
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2500 kg/m3}}\n"
    "failure: {criterion: %s, exclude: [top]}\n"
    "method: {integration: %s, essential: %s}\n"
    "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
    "  - {set: top, displacement: {y: 10 um, x: 2 um}}\n"
    "solver: {kind: newmark, dt: %s, end: %s, rayleigh: {stiffness: 0.05 us, mass: 100}, break: %s, "
    "tolerance: 1e-12, plain: %s}\noutput: {at: {levels: 3}}\n";

static const struct {
    const char *plane, *criterion, *integration, *essential, *dt, *end, *broken;
} runs[] = {
    { "stress", "principal_stress, tensile_strength: 100 MPa", "gauss", "transformation",
      "0.5 us", "20 us", "worst" },
    { "stress", "mohr_coulomb, tensile_strength: 30 MPa, cohesion: 40 MPa, friction_angle: 30 deg",
      "nodal", "nitsche", "0.5 us", "20 us", "fraction" },
    { "stress", "stretch, critical_stretch: 5e-4", "gauss", "penalty", "0.1 us", "4 us", "fraction" },
    { "strain", "principal_stress, tensile_strength: 90 MPa", "gauss, dilatation: projected", "nitsche",
      "0.5 us", "5 us", "worst" },
};

enum { RUNS = sizeof runs / sizeof *runs };

/* PERIGAL_TEST_SIZE=long: the first to its end, else until some bonds have broken one by one. */
static run start (int k, int plain)
{
    return scene_of (1, plate, runs[k].plane, runs[k].criterion, runs[k].integration, runs[k].essential,
                     runs[k].dt, k == 0 && !longer () ? "14 us" : runs[k].end, runs[k].broken,
                     plain ? "true" : "false");
}

static double size (const double *a, size_t n)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++) sum += a[i] * a[i];
    return sqrt (sum);
}

/* The worst bonds and the largest utilisation are those of a look at all bonds, bit by bit: under
 * displacements larger than those of the state that was accepted, so that bonds are over their limit. */
typedef struct { double *loud, *all, *few; char *kind, *same; } looks;

static void the_worst_bonds_are_found (const run *r, const looks *l)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    const pg_state *state = r->state;
    double top = 0, most = 0;
    pg_changes over = { 0 };
    size_t at = 0;
    for (size_t i = 0; i < state->ndof; i++) l->loud[i] = 1.5 * state->d[i];
    check_ok (force->judge (self, state, l->loud, &(pg_judging){ .utilisation = l->all, .kind = l->kind }));
    check_ok (force->judge (self, state, l->loud,
           &(pg_judging){ .utilisation = l->few, .kind = l->same, .over = &over, .from = 0.9, .top = &top }));
    for (size_t i = 0; i < state->nbond; i++) most = fmax (most, l->all[i]);
    assert_true (most == top);
    for (size_t i = 0; i < state->nbond && top > 1; i++) {
        if (!state->alive[i] || !(l->all[i] >= 0.9)) continue;
        assert_true (at < over.n && over.bond[at] == i && l->few[i] == l->all[i] && l->kind[i] == l->same[i]);
        at++;
    }
    assert_int_equal (at, over.n);
    pg_free (over.bond);
}

/* The same bonds in the same step and order, displacements and velocities to 1e-8. PERIGAL_TEST_SIZE=long:
 * with the other two supports and criteria, too. */
static void shortcuts_change_no_result (void **state)
{
    (void) state;
    for (int k = 0; k < RUNS; k += longer () ? 1 : 2) {
        run a = start (k, 0), b = start (k, 1);
        size_t n = a.state->ndof, m = a.state->nbond, broken = 0;
        double d = 0, v = 0;
        looks l = { calloc (n, sizeof *l.loud), calloc (m, sizeof *l.all), calloc (m, sizeof *l.few),
                    calloc (m, 1), calloc (m, 1) };
        assert_true (l.loud && l.all && l.few && l.kind && l.same);
        while (!pg_solver_done (b.solver, b.state)) {
            advance (&a), advance (&b);
            the_worst_bonds_are_found (&a, &l);
            assert_int_equal (a.step.nbroken, b.step.nbroken);
            for (size_t i = 0; i < a.step.nbroken; i++) {
                assert_int_equal (a.step.broken[i].bond, b.step.broken[i].bond);
                assert_int_equal (a.step.broken[i].kind, b.step.broken[i].kind);
                check_relative (a.step.broken[i].utilisation, b.step.broken[i].utilisation, 1e-4);
            }
            check_scaled (a.step.utilisation, b.step.utilisation, 1e-8, 1);
            broken += a.step.nbroken;
            for (size_t i = 0; i < n; i++) {
                d = fmax (d, fabs (a.state->d[i] - b.state->d[i]));
                v = fmax (v, fabs (a.state->v[i] - b.state->v[i]));
            }
        }
        const pg_statistics *fast = pg_solver_report (a.solver, a.state),
                            *slow = pg_solver_report (b.solver, b.state);
        int told = 0;
        for (size_t i = 0; i < fast->nskipped; i++)
            told += strcmp (fast->skipped[i].what, "measures of the residual") == 0;
        print_message ("run %d: %zu bonds, d %.1e, v %.1e; iterations %zu, plain %zu\n", k, broken,
                       d / size (b.state->d, n), v / size (b.state->v, n),
                       (size_t) fast->linear.cg_iterations, (size_t) slow->linear.cg_iterations);
        assert_true (broken > 0 && told <= 1);
        assert_true (d <= 1e-8 * size (b.state->d, n) && v <= 1e-8 * size (b.state->v, n));
        check_relative (fast->energy.external, slow->energy.external, 1e-8);
        check_relative (fast->energy.strain, slow->energy.strain, 1e-8);
        free (l.loud), free (l.all), free (l.few), free (l.kind), free (l.same);
        clear (&a), clear (&b);
    }
}

/* In a smooth motion first guesses spare iterations. */
static void guesses_spare_iterations (void **state)
{
    (void) state;
    size_t used[2];
    for (int plain = 0; plain < 2; plain++) {
        run r = scene_of (1, plate, "stress", "principal_stress, tensile_strength: 1 GPa", "gauss",
                          "transformation",
                          "0.1 us", "6 us", "worst", plain ? "true" : "false");
        to_the_end (&r);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        used[plain] = (size_t) report->linear.cg_iterations;
        int told = 0;
        for (size_t i = 0; i < report->nskipped; i++)
            told += strcmp (report->skipped[i].what, "measures of the residual") == 0;
        assert_int_equal (told, !plain);
        clear (&r);
    }
    print_message ("iterations %zu, plain %zu\n", used[0], used[1]);
    assert_true (used[0] < 0.85 * (double) used[1]);
}

/* A plate of four layers of points (three: 0.1 m) in tension, with a crack through its left side; two
 * bonds or so break in a round. */
static run in_space (int plain, const char *spacing, const char *mass, const char *linear, const char *pull,
                     const char *end)
{
    return scene_of (1,
                     "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1 m, 2 m, 0.2 m]}}}]\n"
                     "spacing: %s m\ncracks:\n  - {polygon: [[-0.01 m, 0.86 m, -0.01 m], [0.23 m, 0.86 m, "
                     "-0.01 m], [0.23 m, 1.08 m, 0.21 m], [-0.01 m, 1.08 m, 0.21 m]]}\n"
                     "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n"
                     "failure: {criterion: stretch, critical_stretch: 1e-3}\n"
                     "method: {approximation: rkpm, integration: gauss, horizon: 2 spacing}\nboundary:\n"
                     "  - {set: bottom, displacement: {x: 0, y: 0, z: 0}}\n"
                     "  - {set: top, traction: {y: %s}}\n"
                     "solver: {kind: newmark, dt: 0.1 ms, end: %s ms, mass: %s, break: fraction, "
                     "break_fraction: 10 %%, tolerance: 1e-10, %s, "
                     "plain: %s}\noutput: {at: {levels: 1}}\n",
                     spacing, pull, end, mass, linear, plain ? "true" : "false");
}

/* Both to the end: the same bonds in the same rounds, displacements to 1e-8, utilisation to `digits`. How
 * many broke. */
static size_t side_by_side (run *a, run *b, double digits)
{
    size_t n = a->state->ndof, broken = 0;
    double d = 0;
    while (!pg_solver_done (b->solver, b->state)) {
        advance (a), advance (b);
        assert_int_equal (a->step.nbroken, b->step.nbroken);
        assert_int_equal (a->step.iterations, b->step.iterations);
        for (size_t i = 0; i < a->step.nbroken; i++) {
            assert_int_equal (a->step.broken[i].bond, b->step.broken[i].bond);
            check_relative (a->step.broken[i].utilisation, b->step.broken[i].utilisation, digits);
        }
        broken += a->step.nbroken;
        for (size_t i = 0; i < n; i++) d = fmax (d, fabs (a->state->d[i] - b->state->d[i]));
    }
    print_message ("%zu bonds, d %.1e\n", broken, d / size (b->state->d, n));
    assert_true (d <= 1e-8 * size (b->state->d, n));
    return broken;
}

static int told (const pg_statistics *r, const char *what)
{
    int count = 0;
    for (size_t i = 0; i < r->nskipped; i++) count += strstr (r->skipped[i].what, what) != NULL;
    return count;
}

/* ms; bonds break from 1.6 ms on. PERIGAL_TEST_SIZE=long: twice as many break. */
static const char *end_of_rounds (void) { return longer () ? "2.3" : "2"; }

/* A kept factor follows what breaks: the same bonds, and little more than one iteration a solve.
 * PERIGAL_TEST_SIZE=long: with lumped mass as well as consistent mass. */
static void a_factor_follows_what_breaks (void **state)
{
    (void) state;
    for (int k = !longer (); k < 2; k++) {
        const char *mass = k ? "consistent" : "lumped";
        run a = in_space (0, "0.08", mass, "preconditioner: jacobi", "9 MPa", end_of_rounds ()),
            b = in_space (1, "0.08", mass, "preconditioner: jacobi", "9 MPa", end_of_rounds ());
        size_t broken = side_by_side (&a, &b, 1e-8);
        const pg_statistics *fast = pg_solver_report (a.solver, a.state),
                            *slow = pg_solver_report (b.solver, b.state);
        print_message ("factors %ld of %ld, iterations %zu of %zu in %ld solves\n",
                       (long) fast->linear.factorizations, (long) slow->linear.factorizations,
                       (size_t) fast->linear.cg_iterations, (size_t) slow->linear.cg_iterations,
                       (long) fast->linear.solves);
        assert_true (broken > 20 && fast->linear.updates > 10 && !told (fast, "factors for"));
        assert_int_equal (fast->linear.factorizations, 1);
        assert_true ((double) fast->linear.cg_iterations < 2.2 * (double) fast->linear.solves
                     && fast->linear.cg_iterations < slow->linear.cg_iterations);
        clear (&a), clear (&b);
    }
}

/* Where much breaks finite elements stand in for the factor, which comes back. */
static void a_factor_and_elements_take_turns (void **state)
{
    (void) state;
    if (!longer ()) return;                            /* PERIGAL_TEST_SIZE=long */
    run a = in_space (0, "0.08", "lumped", "linear: auto", "9 MPa", end_of_rounds ()),
        b = in_space (1, "0.08", "lumped", "linear: auto", "9 MPa", end_of_rounds ());
    assert_true (side_by_side (&a, &b, 1e-8) > 20);
    const pg_statistics *fast = pg_solver_report (a.solver, a.state);
    print_message ("factors %ld, preconditioners %ld, iterations %zu in %ld solves\n",
                   (long) fast->linear.factorizations, (long) fast->linear.preconditioners,
                   (size_t) fast->linear.cg_iterations, (long) fast->linear.solves);
    assert_true (fast->linear.factorizations >= 2 && fast->linear.preconditioners >= 1
                 && told (fast, "factors for") == 1);
    const pg_statistics *slow = pg_solver_report (b.solver, b.state);
    assert_int_equal (told (slow, "factors for"), 0);
    clear (&a), clear (&b);
}

/* By iterations, rounds in the middle of a step are solved no further than it takes to know what breaks: the
 * same bonds in the same rounds, and at the end of each step the same fields. PERIGAL_TEST_SIZE=long. */
static void rough_rounds_break_the_same_bonds (void **state)
{
    (void) state;
    if (!longer ()) return;
    run a = in_space (0, "0.08", "lumped", "linear: pcg", "12 MPa", "2.3"),
        b = in_space (1, "0.08", "lumped", "linear: auto", "12 MPa", "2.3");
    size_t broken = side_by_side (&a, &b, 1e-4);
    const pg_statistics *fast = pg_solver_report (a.solver, a.state);
    print_message ("%ld rounds; iterations %zu in %ld solves\n", (long) fast->linear.updates,
                   (size_t) fast->linear.cg_iterations, (long) fast->linear.solves);
    for (size_t i = 0; i < fast->nskipped; i++) print_message ("%s\n", fast->skipped[i].what);
    assert_true (broken > 300 && told (fast, "exact equilibria") == 1);
    assert_int_equal (told (pg_solver_report (b.solver, b.state), "exact equilibria"), 0);
    clear (&a), clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (shortcuts_change_no_result),
                                        cmocka_unit_test (guesses_spare_iterations),
                                        cmocka_unit_test (a_factor_follows_what_breaks),
                                        cmocka_unit_test (a_factor_and_elements_take_turns),
                                        cmocka_unit_test (rough_rounds_break_the_same_bonds) };
    return cmocka_run_group_tests_name ("solve/newmark_shortcuts", tests, NULL, NULL);
}
