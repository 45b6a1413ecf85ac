/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a solver keeps for later: read back and written again it is the same, and what cannot be of this
 * problem is refused by name before it is used. */
#include "scene_runs/run.h"
#include <limits.h>

typedef struct { char name[64]; size_t n, size; unsigned char *value; } item;
/* wrong: of this name, value `at` is `to` */
typedef struct { item kept[300]; size_t n; const char *wrong; size_t at; long to; int reading; } memory;

static pg_status one (void *context, const char *name, size_t n, size_t size, void *value)
{
    memory *m = context;
    size_t k = 0;
    while (k < m->n && strcmp (m->kept[k].name, name) != 0) k++;
    if (!m->reading) {
        assert_true (k == m->n && k < 300);
        item *fresh = &m->kept[m->n++];
        *fresh = (item) { .n = n, .size = size, .value = pg_calloc (n + 1, size) };
        snprintf (fresh->name, sizeof fresh->name, "%s", name);
        if (n) memcpy (fresh->value, value, n * size);
        return PG_OK;
    }
    if (k == m->n || m->kept[k].n != n || m->kept[k].size != size)
        return pg_error (PG_E_FILE, PG_HERE, "no %zu values of %s", n, name);
    if (n) memcpy (value, m->kept[k].value, n * size);
    if (m->wrong && strcmp (m->wrong, name) == 0) {
        assert_true (m->at < n);
        if (size == 1) ((unsigned char *) value)[m->at] = (unsigned char) m->to;
        else ((long *) value)[m->at] = m->to;
    }
    return PG_OK;
}
static pg_status numbers (void *c, const char *name, size_t n, double *v)
{
    return one (c, name, n, sizeof *v, v);
}
static pg_status counts (void *c, const char *name, size_t n, long *v)
{
    return one (c, name, n, sizeof *v, v);
}
static pg_status bytes (void *c, const char *name, size_t n, void *v) { return one (c, name, n, 1, v); }

static pg_status walk (memory *m, run *r, int reading)
{
    pg_keeper k = { .context = m, .reading = reading, .numbers = numbers, .counts = counts, .bytes = bytes };
    m->reading = reading;
    return pg_solver_keep (r->solver, r->state, &k);
}

static void forget (memory *m) { for (size_t k = 0; k < m->n; k++) pg_free (m->kept[k].value); }

static const item *item_of (const memory *m, const char *name)
{
    size_t k = 0;
    while (k < m->n && strcmp (m->kept[k].name, name) != 0) k++;
    assert_true (k < m->n);
    return &m->kept[k];
}

static run plate (const char *solver)
{
    return scene_of (
        1,
        "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 10 "
        "mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 5 mm], to: [6 mm, 5 mm]}]\n"
        "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2500 kg/m3}}\nfailure: "
        "{criterion: principal_stress, tensile_strength: 30 MPa, exclude: [top]}\n"
        "boundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {y: 10 "
        "um}}\nsolver: {%s}\noutput: {at: {levels: 3}}\n",
        solver);
}

static const char *const solvers[] = { "stepping: event, max_events: 9", "stepping: fixed, steps: 8",
                                       "kind: newmark, dt: 1 us, end: 20 us", "kind: verlet, end: 20 us" };

/* To a step in which bonds broke. */
static run broken (const char *solver)
{
    run r = plate (solver);
    while (!r.step.nbroken) {
        assert_false (pg_solver_done (r.solver, r.state));
        advance (&r);
    }
    return r;
}

static void what_is_read_back_is_written_again (void **state)
{
    (void) state;
    for (int s = 0; s < 4; s++) {
        run a = broken (solvers[s]), b = plate (solvers[s]);
        memory first = { .n = 0 }, again = { .n = 0 };
        long died = 0;
        for (size_t i = 0; i < a.state->nbond; i++) died += b.state->alive[i] && !a.state->alive[i];
        assert_true (died == (long) a.step.nbroken && a.state->broken == died
                     && pg_solver_report_now (a.solver)->broken == died);
        check_ok (walk (&first, &a, 0));
        check_ok (walk (&first, &b, 1));
        check_ok (walk (&again, &b, 0));
        assert_int_equal (again.n, first.n);
        for (size_t k = 0; k < first.n; k++) {
            const item *x = &first.kept[k], *y = item_of (&again, x->name);
            assert_int_equal (y->n, x->n);
            size_t n = strcmp (x->name, "report.numbers") == 0 ? 10 : x->n;    /* behind them: seconds */
            if (memcmp (x->value, y->value, n * x->size) != 0) print_error ("%s: %s\n", solvers[s], x->name);
            assert_memory_equal (x->value, y->value, n * x->size);
        }
        assert_true (*(const long *) (const void *) item_of (&first, "solver.broken_count")->value
                     == (long) a.step.nbroken);
        forget (&first), forget (&again);
        clear (&a), clear (&b);
    }
}

static void what_cannot_be_is_refused (void **state)
{
    (void) state;
    run a = broken (solvers[0]);
    memory m = { .n = 0 };
    check_ok (walk (&m, &a, 0));
    long nbond = (long) a.problem->bonds.first[PG_BOND_SETS];
    const struct { const char *name; size_t at; long to; const char *words;
    } wrong[] = {
        { "state.counts", 0, -1, "state is -1, not from 0" },
        { "backup.counts", 3, -1, "backup is -1, not from 0" },
        { "state.alive", 3, 2, "state.alive is 2, not from 0 to 1" },
        { "solver.broken.bonds", 0, nbond, "a broken bond is" },
        { "solver.broken.bonds", 0, -1, "a broken bond is -1" },
        { "solver.broken.bonds", 1, PG_BOND_SETS, "the set of a broken bond is" },
        { "solver.broken.bonds", 1, -1, "the set of a broken bond is -1" },
        { "solver.broken.bonds", 2, 128, "the kind of a broken bond is 128" },
        { "solver.broken_count", 0, -1, "the number of broken bonds is -1" },
        { "solver.broken_count", 0, nbond + 1, "the number of broken bonds is" },
        { "work_balance.counts", 0, 1L << 20, "work_balance.counts is 1048576" },
        { "work_balance.counts", 1, 2, "work_balance.counts is 2" },
        { "solver.counts", 3, 5, "the next level is 5, not from 0 to 4" },
        { "event_stepping.counts", 0, 64, "the end of the run is 64" },
        { "solver.counts", 4, -1, "the round is -1" },
        { "report.counts", 0, -1, "a count of the report is -1" },
        { "report.counts", 17, 1000, "the number of skipped things is 1000" },
        { "report.counts", 18, 1000, "the number of warnings is 1000" },
        { "system.counts", 0, 99, "the way to solve is 99" },
        { "system.counts", 4, 2, "a kept factor is 2" },
        { "system.multilevel", 0, 2, "the multilevel preconditioner is 2" },
        { "system.ways", 0, 2, "whether elements stand in for a factor is 2" },
        { "system.ways", 1, -1, "solves in place of a factor is -1" },
        { "system.touched", 0, 3, "system.touched is 3" },
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        run b = plate (solvers[0]);
        m.wrong = wrong[k].name, m.at = wrong[k].at, m.to = wrong[k].to;
        check_fails (walk (&m, &b, 1), PG_E_FILE);
        check_contains (pg_last_error (), "the checkpoint is not of this run: ");
        check_contains (pg_last_error (), wrong[k].words);
        clear (&b);
    }
    forget (&m);
    clear (&a);
}

/* Corrections of earlier steps, from which first guesses are made, are kept as well: the other run goes on
 * bit by bit. PERIGAL_TEST_SIZE=long: to the end, else over three steps. */
static void a_motion_goes_on_bit_by_bit (void **state)
{
    (void) state;
    run a = plate (solvers[2]), b = plate (solvers[2]);
    memory m = { .n = 0 };
    for (int k = 0; k < 5; k++) advance (&a);
    check_ok (walk (&m, &a, 0));
    check_ok (walk (&m, &b, 1));
    assert_true (*(const long *) (const void *) item_of (&m, "system.guess")->value >= 3);
    long more = longer () ? LONG_MAX : 3;
    for (long k = 0; k < more && !pg_solver_done (a.solver, a.state); k++) {
        advance (&a), advance (&b);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
        assert_memory_equal (a.state->v, b.state->v, a.state->ndof * sizeof *a.state->v);
    }
    forget (&m);
    clear (&a), clear (&b);
}

/* So does one whose factor has followed what broke since it was made. */
static run block_with (const char *spacing, const char *linear, const char *pull)
{
    return scene_of (
        1,
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1 m, 2 m, 0.2 m]}}}]\nspacing: %s m\n"
        "cracks: [{polygon: [[-1 m, 0.97 m, -1 m], [0.23 m, 0.97 m, -1 m], [0.23 m, 0.97 m, 1 m], "
        "[-1 m, 0.97 m, 1 m]]}]\n"
        "materials: {rock: {youngs_modulus: 30 GPa, poissons_ratio: 0.2, density: 2500 kg/m3}}\n"
        "failure: {criterion: stretch, critical_stretch: 1e-3}\nmethod: {approximation: rkpm, horizon: 2 "
        "spacing}\nboundary:\n  - {set: bottom, displacement: {x: 0, y: 0, z: 0}}\n"
        "  - {set: top, traction: {y: %s}}\nsolver: {kind: newmark, dt: 0.1 ms, end: 3 ms, "
        "break: fraction, break_fraction: 10 %%, linear: %s}\noutput: {at: {levels: 1}}\n",
        spacing, pull, linear);
}
static run block (void) { return block_with ("0.08", "auto", "9 MPa"); }

static void a_factor_that_follows_goes_on_bit_by_bit (void **state)
{
    (void) state;
    run a = block (), b = block ();
    memory m = { .n = 0 };
    for (int k = 0; k < 4; ) advance (&a), k += a.step.nbroken > 0;
    check_ok (walk (&m, &a, 0));
    assert_true (*(const long *) (const void *) item_of (&m, "inverse.touched")->value > 0);
    check_ok (walk (&m, &b, 1));
    for (int k = 0; k < 3 && !pg_solver_done (a.solver, a.state); k += a.step.nbroken > 0) {
        advance (&a), advance (&b);
        assert_int_equal (a.step.nbroken, b.step.nbroken);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
    }
    forget (&m);
    clear (&a), clear (&b);
}

/* And one in which finite elements stand in for the factor; the way back is the same. */
static void elements_in_place_of_a_factor_go_on_bit_by_bit (void **state)
{
    (void) state;
    if (!longer ()) return;                            /* PERIGAL_TEST_SIZE=long */
    run a = block (), b = block ();
    memory m = { .n = 0 };
    long meanwhile = 0, factors = 0;
    while (!meanwhile) {
        forget (&m);
        m = (memory){ .n = 0 };
        assert_false (pg_solver_done (a.solver, a.state));
        advance (&a);
        check_ok (walk (&m, &a, 0));
        meanwhile = *(const long *) (const void *) item_of (&m, "system.ways")->value;
    }
    factors = pg_solver_report_now (a.solver)->linear.factorizations;
    check_ok (walk (&m, &b, 1));
    for (int k = 0; k < 6 && !pg_solver_done (a.solver, a.state); k++) {
        advance (&a), advance (&b);
        assert_int_equal (a.step.nbroken, b.step.nbroken);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
    }
    print_message ("factors %ld, then %ld\n", factors,
                   pg_solver_report_now (a.solver)->linear.factorizations);
    assert_int_equal (pg_solver_report_now (a.solver)->linear.factorizations,
                      pg_solver_report_now (b.solver)->linear.factorizations);
    forget (&m);
    clear (&a), clear (&b);
}

/* Writes what a run needs to go on in the middle of a step, after the fifth round of the first step that has
 * so many. */
typedef struct { memory m; run *r; } interrupted;
static pg_status in_the_middle (void *context, const pg_state *at, const pg_step *so_far)
{
    interrupted *i = context;
    (void) at;
    if (so_far->iterations == 5 && i->m.n == 0) check_ok (walk (&i->m, i->r, 0));
    return PG_OK;
}

/* Rounds that are solved no further than it takes to know what breaks: from the middle of them on, over
 * three steps. */
static void rough_rounds_go_on_bit_by_bit (void **state)
{
    (void) state;
    if (!longer ()) return;                            /* PERIGAL_TEST_SIZE=long */
    run a = block_with ("0.08", "pcg", "20 MPa"), b = block_with ("0.08", "pcg", "20 MPa");
    interrupted i = { .r = &a };
    pg_solver_watch (a.solver, in_the_middle, &i);
    while (i.m.n == 0) {
        assert_false (pg_solver_done (a.solver, a.state));
        advance (&a);
    }
    pg_solver_watch (a.solver, NULL, NULL);
    assert_true (*(const long *) (const void *) item_of (&i.m, "solver.broken_count")->value > 0);
    assert_true (((const long *) (const void *) item_of (&i.m, "system.ways")->value)[2] > 0);
    check_ok (walk (&i.m, &b, 1));
    advance (&b);
    for (int k = 0; k < 3; k++) {
        if (k > 0) advance (&a), advance (&b);
        assert_int_equal (a.step.nbroken, b.step.nbroken);
        assert_int_equal (a.step.iterations, b.step.iterations);
        assert_memory_equal (a.state->d, b.state->d, a.state->ndof * sizeof *a.state->d);
        if (pg_solver_done (a.solver, a.state)) break;
    }
    forget (&i.m);
    clear (&a), clear (&b);
}

static void texts_end_whatever_was_read (void **state)
{
    (void) state;
    run a = broken (solvers[0]), b = plate (solvers[0]);
    memory m = { .wrong = "report.solver",
                 .at = sizeof ((pg_statistics *) NULL)->linear.solver - 1,
                 .to = 'x' };
    check_ok (walk (&m, &a, 0));
    check_ok (walk (&m, &b, 1));
    assert_int_equal (pg_solver_report_now (b.solver)->linear.solver[m.at], 0);
    forget (&m);
    clear (&a), clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (what_is_read_back_is_written_again),
                                        cmocka_unit_test (what_cannot_be_is_refused),
                                        cmocka_unit_test (a_motion_goes_on_bit_by_bit),
                                        cmocka_unit_test (a_factor_that_follows_goes_on_bit_by_bit),
                                        cmocka_unit_test (elements_in_place_of_a_factor_go_on_bit_by_bit),
                                        cmocka_unit_test (rough_rounds_go_on_bit_by_bit),
                                        cmocka_unit_test (texts_end_whatever_was_read) };
    return cmocka_run_group_tests_name ("solve/kept", tests, NULL, NULL);
}
