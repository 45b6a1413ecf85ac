/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a solver takes from checkpoints of others (pg_solver_move), here from one that had all points: from
 * there on it comes to what the undisturbed run came to, whether that ended between two steps or in the
 * middle of one, which then begins again. */
#include "scene_runs/run.h"

typedef struct { char name[64]; size_t n, size; unsigned char *value; } item;
typedef struct { item kept[300]; size_t n; const run *from; } memory;

static item *find (memory *m, const char *name)
{
    for (size_t k = 0; k < m->n; k++) if (strcmp (m->kept[k].name, name) == 0) return &m->kept[k];
    return NULL;
}

static pg_status put (memory *m, const char *name, size_t n, size_t size, const void *value)
{
    assert_true (m->n < 300 && !find (m, name));
    item *one = &m->kept[m->n++];
    *one = (item) { .n = n, .size = size, .value = pg_calloc (n + 1, size) };
    snprintf (one->name, sizeof one->name, "%s", name);
    if (n) memcpy (one->value, value, n * size);
    return PG_OK;
}
static pg_status put_numbers (void *m, const char *name, size_t n, double *v)
{
    return put (m, name, n, 8, v);
}
static pg_status put_counts (void *m, const char *name, size_t n, long *v) { return put (m, name, n, 8, v); }
static pg_status put_bytes (void *m, const char *name, size_t n, void *v) { return put (m, name, n, 1, v); }

static pg_status get (memory *m, const char *name, size_t n, size_t size, void *value)
{
    const item *one = find (m, name);
    if (!one || one->n != n || one->size != size)
        return pg_error (PG_E_FILE, PG_HERE, "no %zu values of %s", n, name);
    if (n) memcpy (value, one->value, n * size);
    return PG_OK;
}
static pg_status get_numbers (void *m, const char *name, size_t n, double *v)
{
    return get (m, name, n, 8, v);
}
static pg_status get_counts (void *m, const char *name, size_t n, long *v) { return get (m, name, n, 8, v); }
static pg_status get_bytes (void *m, const char *name, size_t n, void *v) { return get (m, name, n, 1, v); }

static pg_status get_points (void *context, const char *name, size_t components, double *value)
{
    memory *m = context;
    return get (m, name, components * m->from->problem->cloud.n, 8, value);
}

static pg_status get_unknowns (void *context, const char *list, const char *name, size_t row,
                               size_t components, double *value)
{
    memory *m = context;
    const item *which = find (m, list), *values = find (m, name);
    int64_t *number;
    if (!which) return PG_OK;
    check_ok (pg_problem_numbers (m->from->problem, PG_NODES, &number));
    for (size_t k = 0; k < which->n; k++) {
        long unknown = ((const long *) (const void *) which->value)[k];
        size_t i = 0;
        while (number[i] != unknown / (long) components) assert_true (++i < m->from->problem->cloud.n);
        value[i * components + (size_t) (unknown % (long) components)]
            = ((const double *) (const void *) values->value)[row * which->n + k];
    }
    pg_free (number);
    return PG_OK;
}

static pg_status get_bonds (void *context, unsigned char *alive)
{
    const run *r = ((memory *) context)->from;
    const pg_state *at = pg_solver_accepted (r->solver, r->state);
    for (size_t i = 0; i < at->nbond; i++) if (!at->alive[i]) alive[i] = 0;
    return PG_OK;
}

/* What was kept of a run goes into another one. */
static pg_status move (run *to, run *from)
{
    memory m = { .from = from };
    const pg_keeper writer = { &m, 0, put_numbers, put_counts, put_bytes },
                    reader = { &m, 1, get_numbers, get_counts, get_bytes };
    const pg_moved moved = { .context = &m, .alike = &reader, .shares = get_numbers, .points = get_points,
                             .unknowns = get_unknowns, .bonds = get_bonds };
    check_ok (pg_solver_keep (from->solver, from->state, &writer));
    pg_status status = pg_solver_move (to->solver, to->state, &moved);
    for (size_t k = 0; k < m.n; k++) pg_free (m.kept[k].value);
    return status;
}

static const struct { const char *force, *solver, *failure, *load; int middle; } scenes[] = {
    { "force: bond, horizon: 3 spacing", "kind: verlet, dt: 10 ns, time_steps: 3600, rayleigh: {mass: 1000}",
      "fracture_energy: 4 J/m2", "displacement: {y: 8 um}", 1 },
    { "force: gmpd, horizon: 3 spacing", "kind: central, dt: 10 ns, time_steps: 3600",
      "fracture_energy: 4 J/m2", "traction: {y: 20 MPa}", 1 },
    { "force: lps, horizon: 3 spacing", "kind: adr, stages: 3, imbalance: 1e-10", "fracture_energy: 4 J/m2",
      "displacement: {y: 8 um}", 1 },
    { "force: bond, horizon: 3 spacing", "kind: adr, stages: 3600, hold: off", "fracture_energy: 4 J/m2",
      "displacement: {y: 8 um}", 1 },
    { "force: lps, horizon: 3 spacing", "kind: static, stepping: fixed, steps: 6", "fracture_energy: 4 J/m2",
      "displacement: {y: 8 um}", 1 },
    { "force: bond, horizon: 3 spacing", "kind: static, stepping: event, max_events: 12",
      "fracture_energy: 4 J/m2", "displacement: {y: 8 um}", 0 },
    { "force: galerkin", "kind: static, stepping: fixed, steps: 4, break: all",
      "criterion: principal_stress, tensile_strength: 30 MPa, exclude: [top]", "displacement: {y: 8 um}", 1 },
    { "force: galerkin", "kind: static, stepping: event, max_events: 9", "criterion: principal_stress, "
      "tensile_strength: 30 MPa, exclude: [top]", "displacement: {y: 8 um}", 0 },
    { "force: galerkin",
      "kind: newmark, dt: 1 us, end: 8 us, alpha: -0.1, rayleigh: {stiffness: 10 ns}, break: all",
      "criterion: principal_stress, tensile_strength: 30 MPa, exclude: [top]", "displacement: {y: 8 um}", 1 },
    { "force: bond, horizon: 3 spacing", "kind: newmark, dt: 0.5 us, end: 20 us", "fracture_energy: 4 J/m2",
      "traction: {y: 20 MPa}", 0 },
};
enum { SCENES = sizeof scenes / sizeof *scenes };

static run plate (int k)
{
    return scene_of (1,
                     "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: "
                     "[20 mm, 10 mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 5.5 mm], to: [6 mm, 5.5 mm]}]\n"
                     "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: %s, density: 2500 kg/m3}}\n"
                     "failure: {%s}\nmethod: {%s}\nboundary:\n  - {set: bottom, displacement: {x: 0, y: 0}}\n"
                     "  - {set: top, %s}\nsolver: {%s}\noutput: {at: {levels: 3%s}}\n",
                     strstr (scenes[k].force, "bond") ? "0.3333333333333333" : "0.22", scenes[k].failure,
                     scenes[k].force, scenes[k].load, scenes[k].solver,
                     strstr (scenes[k].solver, "3600") ? ", rows: 3" : "");
}

/* The same end, to what rounding and the tolerance of equilibria leave: displacements, energies, bonds. */
static void compare (const run *a, const run *b, const char *what, const char *how)
{
    const pg_statistics *x = pg_solver_report_now (a->solver), *y = pg_solver_report_now (b->solver);
    double size = largest_of (a->state->d, a->state->ndof), energy = fabs (x->energy.external) + 1e-30,
           apart = largest_difference (a->state->d, b->state->d, a->state->ndof) / size;
    int same = memcmp (a->state->alive, b->state->alive, a->state->nbond) == 0
               && a->state->step == b->state->step && a->state->iterations == b->state->iterations
               && a->state->events == b->state->events && a->state->broken == b->state->broken
               && x->broken == y->broken && x->steps == y->steps;
    double work = fabs (x->energy.external - y->energy.external) / energy,
           taken = fabs (x->energy.dissipated - y->energy.dissipated) / energy,
           rest = (fabs (x->energy.kinetic - y->energy.kinetic)
                   + fabs (x->energy.damping - y->energy.damping)) / energy;
    if (!same || !(apart < 1e-9) || !(work < 1e-9) || !(taken < 1e-9) || !(rest < 1e-9))
        fail_msg ("%s, %s: same bonds and counts %d; apart: displacement %.2g, work %.2g, dissipated %.2g, "
                  "motion %.2g", what, how, same, apart, work, taken, rest);
}

static void between_two_steps (void **state)
{
    (void) state;
    for (int k = 0; k < SCENES; k++) {
        run whole = plate (k), first = plate (k), then = plate (k);
        long broken = 0;
        while (!broken) advance (&first), broken = first.state->broken;
        assert_false (pg_solver_done (first.solver, first.state));
        check_ok (move (&then, &first));
        assert_true (then.state->step == first.state->step && then.state->broken == first.state->broken);
        to_the_end (&whole), to_the_end (&then);
        assert_true (whole.state->broken > broken);
        compare (&whole, &then, scenes[k].solver, "between two steps");
        clear (&whole), clear (&first), clear (&then);
    }
}

/* Ends the step in its middle, when bonds have broken. */
static pg_status stop (void *context, const pg_state *state, const pg_step *so_far)
{
    (void) state, (void) context;
    if (so_far->nbroken == 0) return PG_OK;
    return pg_error (PG_E_INTERRUPTED, PG_HERE, "in the middle");
}

static void in_the_middle_of_a_step (void **state)
{
    (void) state;
    for (int k = 0; k < SCENES; k++) {
        if (!scenes[k].middle) continue;
        run whole = plate (k), first = plate (k), then = plate (k);
        pg_solver_watch (first.solver, stop, NULL);
        pg_status status = PG_OK;
        while (status == PG_OK && !pg_solver_done (first.solver, first.state))
            status = pg_solver_step (first.solver, first.state, &first.step);
        if (status != PG_E_INTERRUPTED) fail_msg ("%s is not interrupted", scenes[k].solver);
        check_ok (move (&then, &first));
        to_the_end (&whole), to_the_end (&then);
        compare (&whole, &then, scenes[k].solver, "in the middle of a step");
        clear (&whole), clear (&first), clear (&then);
    }
}

static void what_cannot_move_is_refused (void **state)
{
    (void) state;
    const char *scene
        = "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 10 "
          "mm]}}}]\nspacing: 1 mm\ncracks: [{from: [0, 5.5 mm], to: [6 mm, 5.5 mm]}]\n"
          "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22}}\nfailure: "
          "{criterion: energy_release, fracture_energy: 4 J/m2}\nboundary:\n  - {set: bottom, "
          "displacement: {x: 0, y: 0}}\n  - {set: top, displacement: {y: 8 um}}\n";
    run a = prepare (1, scene), b = prepare (1, scene);
    advance (&a);
    check_fails (move (&b, &a), PG_E_USAGE);
    check_contains (pg_last_error (), "with cracks that grow by facets goes on only among as many processes");
    clear (&a), clear (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (between_two_steps),
        cmocka_unit_test (in_the_middle_of_a_step),
        cmocka_unit_test (what_cannot_move_is_refused),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
