/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run that goes on from the checkpoint of a step makes the next steps bit for bit as the run that was never
 * interrupted: state and tables. Here are runs that keep more than bonds and displacements from step to step:
 * cracks that grow by facets past a kink, whose cells are integrated consistently, solved for with the factor
 * of an earlier matrix; faces that press on each other in motion while cracks grow. PERIGAL_TEST_SCENE=FILE
 * asks the same of any scene, every step. */
#include "again.h"

enum { AHEAD = 2, MOST_STEPS = 400 };

typedef struct { double *values; size_t ndof; unsigned char *alive; size_t nbond; } moment;

static moment moment_of (const pg_state *state)
{
    moment m = { .ndof = state->ndof, .nbond = state->nbond };
    m.values = pg_calloc (3 * m.ndof + 2, sizeof *m.values);
    m.alive = pg_calloc (m.nbond + 1, 1);
    m.values[3 * m.ndof] = state->time, m.values[3 * m.ndof + 1] = state->work;
    memcpy (m.values, state->d, m.ndof * sizeof *m.values);
    if (state->v) memcpy (m.values + m.ndof, state->v, m.ndof * sizeof *m.values);
    if (state->a) memcpy (m.values + 2 * m.ndof, state->a, m.ndof * sizeof *m.values);
    memcpy (m.alive, state->alive, m.nbond);
    return m;
}

static void moment_clear (moment *m) { pg_free (m->values), pg_free (m->alive); }

static int same_moment (const moment *a, const moment *b)
{
    return memcmp (a->values, b->values, (3 * a->ndof + 2) * sizeof *a->values) == 0
           && memcmp (a->alive, b->alive, a->nbond) == 0;
}

static void say_difference (const moment *a, const moment *b, long from, long step)
{
    size_t bonds = 0;
    for (size_t i = 0; i < a->nbond; i++) bonds += a->alive[i] != b->alive[i];
    print_message ("resumed after step %ld: step %ld differs, displacements by %.2g of %.3g, %zu bonds\n",
                   from, step, largest_difference (a->values, b->values, a->ndof),
                   largest_of (a->values, a->ndof), bonds);
}

static void copy_to (const char *from, const char *base, long k)
{
    char command[300];
    snprintf (command, sizeof command, "cp -r %s %s/%ld", from, base, k);
    assert_int_equal (system (command), 0);
}

static int same_tables (const char *a, const char *b, long k)
{
    static const char *const table[] = { "history.csv", "events.csv", "tips.csv", "fronts.csv",
                                         "contact.csv" };
    char command[400];
    int same = 1;
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        snprintf (command, sizeof command, "test ! -e %s/%ld/%s || cmp %s/%ld/%s %s/%s", a, k, table[i], a, k,
                  table[i], b, table[i]);
        same = same && system (command) == 0;
    }
    return same;
}

/* One step, and a checkpoint after it, which also empties the buffers of the tables. */
static int step_on (run *r, pg_result *result)
{
    if (pg_solver_done (r->solver, r->state)) return 0;
    check_ok (pg_solver_step (r->solver, r->state, &r->step));
    check_ok (pg_result_step (result, r->state, &r->step));
    check_ok (pg_result_checkpoint (result, r->state));
    return 1;
}

/* How many steps differ of those after step `from`: the first, if any. */
static long goes_on (const char *text, const char *base, long from, long last, const moment *whole)
{
    char where[128], command[300];
    run r;
    visit v;
    pg_resumed begun;
    long differ = 0;
    snprintf (where, sizeof where, "%s/again", base);
    snprintf (command, sizeof command, "cp -r %s/%ld %s", base, from, where);
    assert_int_equal (system (command), 0);
    check_ok (resume (text, where, &r, &v, &begun));
    assert_int_equal (begun.step, from);
    for (long k = from + 1; k <= last && k <= from + AHEAD && !differ && step_on (&r, v.result); k++) {
        moment now = moment_of (r.state);
        if (!same_moment (&now, &whole[k])) say_difference (&now, &whole[k], from, k), differ = 1;
        moment_clear (&now);
        differ |= !same_tables (base, where, k);
    }
    pg_result_free (&v.result);
    clear (&r);
    snprintf (command, sizeof command, "rm -r %s", where);
    assert_int_equal (system (command), 0);
    return differ;
}

/* From step `first` on, every `stride`-th. */
static void from_steps_of (const char *text, long first, long stride)
{
    char base[64], where[80];
    moment *whole = pg_calloc (MOST_STEPS + 1, sizeof *whole);
    long last = 0, differ = 0;
    pg_result *result;
    make_folder (base);
    snprintf (where, sizeof where, "%s/whole", base);
    run r = prepare (1, text);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (last < MOST_STEPS && step_on (&r, result)) {
        whole[++last] = moment_of (r.state);
        copy_to (where, base, last);
    }
    pg_result_free (&result);
    clear (&r);
    assert_true (last > first);
    for (long k = first; k < last; k += stride) differ += goes_on (text, base, k, last, whole);
    for (long k = 1; k <= last; k++) moment_clear (&whole[k]);
    pg_free (whole);
    remove_folder (base);
    assert_int_equal (differ, 0);
}

/* The matrix follows from the cracks as well as from the bonds: a factor that was made before the last facet
 * is made again with the cracks of that moment. Only in bodies of this size it serves for several facets. */
static void with_the_factor_of_a_shorter_crack (void **state)
{
    (void) state;
    if (!longer ()) {
        print_message ("skipped: in full size only (PERIGAL_TEST_SIZE=long)\n");
        return;
    }
    from_steps_of (
        "dimension: 2\nplane: stress\nthickness: 10 mm\nbody: [{add: {disk: {center: [0, 0], diameter: 100 "
        "mm}}}]\nspacing: 1.25 mm\nlattice: cells\ncracks: [{from: [-3.9 mm, -14.5 mm], to: [3.9 mm, 14.5 "
        "mm]}]\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "failure: {fracture_energy: 20 J/m2}\nsets: {platens: {boundary: rim, angle: [[84 deg, 96 deg], [264 "
        "deg, 276 deg]]}}\nboundary: [{name: top, set: platens.top, displacement: {x: 0, y: -50 um}}, {name: "
        "bottom, set: platens.bottom, displacement: {x: 0, y: 50 um}}]\n"
        "solver: {kind: static, max_events: 6}\noutput: {at: {levels: 10}, pictures: []}\n", 10, 1);
}

/* Platens on a body that answers in proportion: between its levels nothing is solved, and their work goes
 * on. */
static void platens_between_levels (void **state)
{
    (void) state;
    from_steps_of (
        "dimension: 2\nplane: strain\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.6]}}}]\n"
        "spacing: 0.1\nlattice: cells\nmaterials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
        "platens: [{name: anvil, point: [0.5, 0], normal: [0, 1], friction: 0.2}, {name: ram, point: [0.5, "
        "0.6], normal: [0, -1], friction: 0.2, displacement: {y: -0.5 mm}}]\nboundary: [{name: soft, set: "
        "all, spring: {all: 100 kN/m}}]\noutput: {at: {levels: 3}, pictures: []}\n", 1, 1);
}

/* Tips that run, a held force behind them, and contact with friction, each with a memory of its own. */
static void closed_faces_in_motion (void **state)
{
    (void) state;
    from_steps_of (
        "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 1.2]}}}]\nspacing: 0.05\n"
        "cracks: [{from: [0.33, 0.41], to: [0.67, 0.76]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, "
        "poissons_ratio: 0.2, density: 2000}}\nfailure: {criterion: energy_release, fracture_energy: 4 "
        "J/m2}\ncontact: {kind: friction, coefficient: 0.2}\nboundary: [{name: foot, set: bottom, "
        "displacement: {x: 0, y: 0}}, {name: head, set: top, velocity: {y: -1 m/s}}]\n"
        "solver: {kind: newmark, dt: 50 us, time_steps: 24}\noutput: {pictures: []}\n", 8, 5);
}

static void scene_asked (void **state)
{
    (void) state;
    const char *path = getenv ("PERIGAL_TEST_SCENE");
    if (!path) {
        print_message ("skipped: no PERIGAL_TEST_SCENE\n");
        return;
    }
    char *text = slurp (path);
    from_steps_of (text, 1, 1);
    pg_free (text);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (with_the_factor_of_a_shorter_crack),
                                        cmocka_unit_test (platens_between_levels),
                                        cmocka_unit_test (closed_faces_in_motion),
                                        cmocka_unit_test (scene_asked) };
    return cmocka_run_group_tests_name ("app/results/every_step", tests, NULL, NULL);
}
