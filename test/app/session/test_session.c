/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene advanced from outside: the same bits as a run by solver and state, also when its state went out
 * and came back; what is set and cut acts; what cannot be is refused and changes nothing. Points, shape
 * functions, constants and forces of bonds from arrays. */
#include "check.h"
#include "perigal/session.h"
#include <stdlib.h>
#include <unistd.h>

static char folder[] = "/tmp/perigal_session_XXXXXX", file[64];

/* A glass strip that is pulled apart and breaks; `solver`: that of the scene. */
static void write_scene (const char *solver)
{
    FILE *to = fopen (file, "w");
    fprintf (to,
             "dimension: 2\nplane: stress\nthickness: 1 mm\nbody:\n"
             "  - add: {box: {low: [0, 0], high: [30 mm, 12 mm]}}\nspacing: 1.5 mm\nlattice: cells\n"
             "cracks:\n  - {from: [0, 6 mm], to: [9.7 mm, 6 mm]}\n"
             "materials:\n  glass: {youngs_modulus: 70 GPa, poissons_ratio: 0.333, density: 2440 kg/m3}\n"
             "method: {force: bond, horizon: 3 spacing}\n"
             "failure: {criterion: stretch, fracture_energy: 4 J/m2}\n"
             "boundary:\n  - {name: low, set: bottom, displacement: {x: 0, y: 0}}\n"
             "  - {name: high, set: top, displacement: {y: 8 um}}\n"
             "solver: {%s}\noutput: {at: {rows: 10, levels: 2}}\n",
             solver);
    fclose (to);
}

static const char *const explicit_ = "kind: verlet, end: 8 us",
                  *const fixed = "kind: static, stepping: fixed, steps: 4";

static int start (void **state)
{
    (void) state;
    if (!mkdtemp (folder)) return 1;
    snprintf (file, sizeof file, "%s/scene.yaml", folder);
    return 0;
}
static int finish (void **state)
{
    (void) state;
    return remove (file) || rmdir (folder);
}

static void check_same (const pg_state *a, const pg_state *b)
{
    assert_true (a->ndof == b->ndof && a->nbond == b->nbond && a->step == b->step && a->broken == b->broken);
    assert_memory_equal (a->d, b->d, a->ndof * sizeof *a->d);
    assert_memory_equal (a->v, b->v, a->ndof * sizeof *a->v);
    assert_memory_equal (a->alive, b->alive, a->nbond);
    assert_true (a->work == b->work && a->time == b->time);
}

/* The plain way: scene, problem, solver, state. */
static void check_against_run (const char *solver)
{
    pg_scene *scene;
    pg_problem *problem;
    pg_solver *s = NULL;
    pg_state *state;
    pg_solver_options o;
    pg_step step;
    pg_session *session;
    const pg_step *shown;
    write_scene (solver);
    check_ok (pg_scene_load (&scene, file));
    check_ok (pg_problem_build (&problem, scene, 1));
    check_ok (pg_solver_options_read (&o, problem, scene));
    check_ok (pg_solver_create (&s, problem, &o));
    check_ok (pg_state_create (&state, problem, pg_solver_components (s)));
    check_ok (pg_session_open (&session, file, 0, NULL, 1));
    while (!pg_solver_done (s, state)) {
        check_ok (pg_solver_step (s, state, &step));
        assert_false (pg_session_done (session));
        check_ok (pg_session_step (session, &shown));
        assert_true (shown->number == step.number && shown->time == step.time);
        assert_memory_equal (shown->reaction, step.reaction, 6 * sizeof (double));
        check_same (pg_session_state (session), state);
    }
    assert_true (state->broken > 0);
    assert_true (pg_session_done (session));
    check_fails (pg_session_step (session, NULL), PG_E_USAGE);
    pg_session_close (&session);
    pg_state_free (&state), pg_solver_free (&s), pg_problem_free (&problem), pg_scene_free (&scene);
}

static void test_steps (void **state)
{
    (void) state;
    check_against_run (explicit_);
    check_against_run (fixed);
    check_against_run ("kind: static");
    check_against_run ("kind: newmark, dt: 0.5 us, end: 8 us");
}

static void go (pg_session *s, int steps)
{
    for (int k = 0; k < steps; k++) check_ok (pg_session_step (s, NULL));
}

/* Out after some steps, on for some, back, and on again: nothing remembers the detour. */
static void check_restored (const char *solver, int before, int after)
{
    pg_session *a, *b;
    size_t bytes, again;
    void *block, *second;
    write_scene (solver);
    check_ok (pg_session_open (&a, file, 0, NULL, 1));
    check_ok (pg_session_open (&b, file, 0, NULL, 1));
    go (a, before);
    check_ok (pg_session_save (a, &bytes, &block));
    go (a, after);
    go (b, 1);
    check_ok (pg_session_restore (b, bytes, block));
    check_ok (pg_session_save (b, &again, &second));
    assert_int_equal (bytes, again);
    go (b, after);
    check_same (pg_session_state (a), pg_session_state (b));
    check_ok (pg_session_restore (a, bytes, block));   /* its own past */
    go (a, after);
    check_same (pg_session_state (a), pg_session_state (b));
    pg_free (block), pg_free (second);
    pg_session_close (&a), pg_session_close (&b);
}

static void test_state_in_and_out (void **state)
{
    (void) state;
    check_restored (explicit_, 5, 4);
    check_restored (fixed, 2, 2);
    check_restored ("kind: static", 2, 3);
    check_restored (explicit_, 0, 3);
    check_restored ("kind: newmark, dt: 0.5 us, end: 8 us", 4, 4);
}

static void test_refused_states (void **state)
{
    (void) state;
    pg_session *a, *b;
    size_t bytes;
    void *block;
    const char *const other[] = { "spacing=1.2 mm" };
    write_scene (explicit_);
    check_ok (pg_session_open (&a, file, 0, NULL, 1));
    check_ok (pg_session_open (&b, file, 1, other, 1));
    go (a, 2);
    check_ok (pg_session_save (a, &bytes, &block));
    check_fails (pg_session_restore (b, bytes, block), PG_E_USAGE);
    check_contains (pg_last_error (), "another scene");
    check_fails (pg_session_restore (a, bytes - 8, block), PG_E_FILE);
    check_fails (pg_session_restore (a, 7, block), PG_E_FILE);
    ((unsigned char *) block)[bytes / 2] ^= 1;
    check_fails (pg_session_restore (a, bytes, block), PG_E_FILE);
    check_contains (pg_last_error (), "damaged");
    ((char *) block)[3] = 'x';
    check_fails (pg_session_restore (a, bytes, block), PG_E_USAGE);
    assert_int_equal (pg_session_state (a)->step, 2);
    go (a, 1);
    pg_free (block);
    pg_session_close (&a), pg_session_close (&b);
}

/* Velocities at the start move the body; nothing else can be set, nor later. */
static void test_set (void **state)
{
    (void) state;
    pg_session *s;
    write_scene (explicit_);
    check_ok (pg_session_open (&s, file, 0, NULL, 1));
    const pg_state *at = pg_session_state (s);
    const pg_cloud *c = &pg_session_problem (s)->cloud;
    double *v = pg_calloc (at->ndof, sizeof *v);
    for (size_t i = 0; i < at->ndof; i++) v[i] = i % 2 ? 0 : 10 * c->x[i];
    check_ok (pg_session_set (s, "velocity", at->ndof, v));
    assert_memory_equal (at->v, v, at->ndof * sizeof *v);
    check_fails (pg_session_set (s, "velocity", at->ndof - 1, v), PG_E_USAGE);
    check_fails (pg_session_set (s, "speed", at->ndof, v), PG_E_USAGE);
    v[3] = NAN;
    check_fails (pg_session_set (s, "displacement", at->ndof, v), PG_E_USAGE);
    go (s, 1);
    assert_true (pg_solver_report_now (pg_session_solver (s))->energy.kinetic > 0);
    check_fails (pg_session_set (s, "velocity", at->ndof, v), PG_E_USAGE);
    check_contains (pg_last_error (), "before the first step");
    pg_session_close (&s);
    write_scene (fixed);
    check_ok (pg_session_open (&s, file, 0, NULL, 1));
    check_fails (pg_session_set (s, "displacement", pg_session_state (s)->ndof, v), PG_E_USAGE);
    pg_session_close (&s);
    pg_free (v);
}

/* Is the bond across the line x = 15 mm? */
static int crosses (const pg_problem *p, size_t point, int node)
{
    return (p->cloud.x[2 * point] < 15e-3) != (p->cloud.x[2 * (size_t) node] < 15e-3);
}

static size_t list_across (const pg_problem *p, size_t *list)
{
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    size_t n = 0;
    for (size_t i = 0; i < f->n; i++)
        for (size_t b = f->start[i]; b < f->start[i + 1]; b++)
            if ((int) i < f->node[b] && crosses (p, i, f->node[b])) list[n++] = b;
    return n;
}

/* Cut before the first step it is as if they had never been; cut later, forces of the same state are those of
 * a body without them. */
static void check_cut (const char *solver, int before)
{
    pg_session *s;
    write_scene (solver);
    check_ok (pg_session_open (&s, file, 0, NULL, 1));
    const pg_problem *p = pg_session_problem (s);
    const pg_state *at = pg_session_state (s);
    size_t *list = pg_calloc (at->nbond, sizeof *list), n = list_across (p, list), live = 0;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    go (s, before);
    check_ok (pg_session_cut (s, n, list));
    for (size_t i = 0; i < f->n; i++)
        for (size_t b = f->start[i]; b < f->start[i + 1]; b++)
            live += crosses (p, i, f->node[b]) && at->alive[b];
    assert_int_equal (live, 0);
    go (s, 1);
    /* the force agrees with one made from the bonds that live */
    void *self, *fresh;
    const pg_force_type *force = pg_solver_force (pg_session_solver (s), &self);
    double *r[2] = { pg_calloc (at->ndof, sizeof (double)), pg_calloc (at->ndof, sizeof (double)) }, size,
           most = 0;
    check_ok (force->create (&fresh, p));
    check_ok (force->refresh (fresh, at, NULL));
    check_ok (force->balance (self, at->time, at->d, r[0], &size));
    check_ok (force->balance (fresh, at->time, at->d, r[1], &size));
    for (size_t i = 0; i < at->ndof; i++) most = fmax (most, fabs (r[1][i]));
    for (size_t i = 0; i < at->ndof; i++) check_scaled (r[0][i], r[1][i], 1e-12, most);
    force->free (&fresh);
    pg_free (r[0]), pg_free (r[1]), pg_free (list);
    pg_session_close (&s);
}

static void test_cut (void **state)
{
    (void) state;
    pg_session *s;
    size_t far = SIZE_MAX, one = 0;
    check_cut (explicit_, 0);
    check_cut (explicit_, 3);
    check_cut (fixed, 0);
    check_cut (fixed, 1);
    check_cut ("kind: newmark, dt: 0.5 us, end: 8 us", 2);
    write_scene ("kind: static");
    check_ok (pg_session_open (&s, file, 0, NULL, 1));
    check_fails (pg_session_cut (s, 1, &far), PG_E_USAGE);
    check_ok (pg_session_cut (s, 1, &one));
    go (s, 1);
    check_fails (pg_session_cut (s, 1, &one), PG_E_USAGE);
    check_contains (pg_last_error (), "event stepping");
    pg_session_close (&s);
}

/* Asked before and after a cut, or after it only: shape functions are those of the bonds that live. */
static void test_fields_after_cuts (void **state)
{
    (void) state;
    pg_session *s[2];
    const char *const set[] = { "method={approximation: rkpm, integration: nodal, horizon: 2.5 spacing}" };
    double *kept[2], *d = NULL, apart = 0;
    size_t n = 0;
    int components;
    const char *unit;
    const double *value;
    write_scene ("kind: newmark, dt: 0.5 us, end: 8 us");
    for (int k = 0; k < 2; k++) {
        check_ok (pg_session_open (&s[k], file, 1, set, 1));
        const pg_problem *p = pg_session_problem (s[k]);
        size_t nbond = pg_session_state (s[k])->nbond, *list = pg_calloc (nbond, sizeof *list),
               cut = list_across (p, list);
        n = pg_session_state (s[k])->ndof;
        if (!d) d = pg_calloc (n, sizeof *d);
        for (size_t i = 0; i < n; i++) d[i] = 1e-6 * sin (5 * (double) i);
        check_ok (pg_session_set (s[k], "displacement", n, d));
        if (k == 0) check_ok (pg_session_field (s[k], "displacement", &components, &unit, &value));
        if (k == 0) memcpy (d, value, n * sizeof *d);
        check_ok (pg_session_cut (s[k], cut, list));
        check_ok (pg_session_field (s[k], "displacement", &components, &unit, &value));
        kept[k] = pg_calloc (n, sizeof *value);
        memcpy (kept[k], value, n * sizeof *value);
        for (size_t i = 0; k == 0 && i < n; i++) apart = fmax (apart, fabs (d[i] - value[i]));
        pg_free (list);
    }
    assert_true (apart > 1e-8);
    assert_memory_equal (kept[0], kept[1], n * sizeof *d);
    for (int k = 0; k < 2; k++) pg_session_close (&s[k]), pg_free (kept[k]);
    pg_free (d);
}

/* Fields at any time, and what cannot be opened. */
static void test_fields (void **state)
{
    (void) state;
    pg_session *s;
    int components;
    const char *unit;
    const double *value;
    write_scene (explicit_);
    check_ok (pg_session_open (&s, file, 0, NULL, 1));
    check_ok (pg_session_field (s, "damage", &components, &unit, &value));
    size_t n = pg_session_problem (s)->cloud.n;
    double most = 0;
    for (size_t i = 0; i < n; i++) most = fmax (most, value[i]);
    assert_true (components == 1 && most > 0.2);       /* the crack, before the first step */
    go (s, 2);
    check_ok (pg_session_field (s, "stress", &components, &unit, &value));
    assert_true (components == 3 && !strcmp (unit, "Pa"));
    check_ok (pg_session_field (s, "velocity", &components, &unit, &value));
    assert_memory_equal (value, pg_session_state (s)->v, 2 * n * sizeof *value);
    check_fails (pg_session_field (s, "rotation", &components, &unit, &value), PG_E_USAGE);
    check_contains (pg_last_error (), "displacement|velocity|damage");
    pg_session_close (&s);
    check_fails (pg_session_open (&s, "nowhere.yaml", 0, NULL, 1), PG_E_FILE);
    check_fails (pg_session_open (&s, file, 0, NULL, 99), PG_E_USAGE);
    const char *const wrong[] = { "spacing=-1", "materials.glass.density=x" };
    check_fails (pg_session_open (&s, file, 2, wrong, 1), PG_E_SCENE);
    check_contains (pg_last_error (), "spacing");
    check_contains (pg_last_error (), "density");
    assert_null (s);
}

/* Which faces bear is no linear system. */
static void test_contact_has_no_equations (void **state)
{
    (void) state;
    static const char *const none[] = { "contact={kind: none}" },
                      *const normal[] = { "contact={kind: normal}" };
    pg_session *s = NULL;
    pg_equations e;
    check_ok (pg_session_open (&s, "data/slip_surface/scene.yaml", 1, normal, 1));
    assert_int_equal (pg_session_equations (&e, s, 1), PG_E_USAGE);
    assert_non_null (strstr (pg_last_error (), "contact={kind: none}"));
    pg_session_close (&s);
    check_ok (pg_session_open (&s, "data/slip_surface/scene.yaml", 1, none, 1));
    check_ok (pg_session_equations (&e, s, 1));
    assert_true (e.n > 0);
    pg_equations_clear (&e);
    pg_session_close (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_steps),
        cmocka_unit_test (test_state_in_and_out),
        cmocka_unit_test (test_refused_states),
        cmocka_unit_test (test_set),
        cmocka_unit_test (test_cut),
        cmocka_unit_test (test_fields),
        cmocka_unit_test (test_fields_after_cuts),
        cmocka_unit_test (test_contact_has_no_equations),
    };
    return cmocka_run_group_tests (tests, start, finish);
}
