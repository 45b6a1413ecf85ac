/* SPDX-License-Identifier: GPL-3.0-or-later
 * Places around the tip of a crack that are sampled again and again: kept shape functions give what new ones
 * give, bit by bit, whatever field is asked for, and whatever breaks or grows near them or far away. */
#include "scene_runs/run.h"
#include <math.h>

enum { EACH = 400, NUMBERS = 18 * EACH };

static run plate (void)
{
    return scene_of (1, "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [3, 2]}}}]\nspacing: 0.1\n"
                        "cracks: [{from: [-0.1, 1.02], to: [0.8, 1.02]}]\n"
                        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\n"
                        "failure: {criterion: energy_release, fracture_energy: 10 J/m2}\n"
                        "boundary: [{set: left, displacement: {x: 0, y: 0}}]\nsolver: {kind: static}\n");
}

/* Rings about the tip, across the crack. */
static void places (const run *r, double *x)
{
    const double *tip = r->state->paths->tip[0].x;
    for (int i = 0; i < EACH; i++) {
        double radius = 0.05 + 0.3 * (i % 20) / 20, angle = 0.01 + i * 0.7853;
        x[2*i] = tip[0] + radius * cos (angle), x[2*i + 1] = tip[1] + radius * sin (angle);
    }
}

static void fill (const run *r, int kind, double *d)
{
    for (size_t i = 0; i < r->state->ndof; i++) d[i] = sin (1 + (kind + 1.3) * (double) i);
}

/* Displacement, stress and gradient. */
static void sample (const run *r, const double *d, const double *x, double *out)
{
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    check_ok (force->sample (self, r->state, d, EACH, x, out, out + 3 * EACH, out + 9 * EACH));
}

/* The same places as kept rows and as new ones have them; the second field comes by kept rows in any case. */
static void compare (run *r, const double *x, double *first)
{
    static double d[20000], kept[NUMBERS], anew[NUMBERS];
    assert_true (r->state->ndof <= 20000);
    for (int kind = 0; kind < 2; kind++) {
        fill (r, kind, d);
        sample (r, d, x, kept);
        r->problem->plain = 1;
        sample (r, d, x, anew);
        r->problem->plain = 0;
        assert_memory_equal (kept, anew, sizeof kept);
        if (kind == 0) memcpy (first, kept, sizeof kept);
    }
}

static void lose (run *r, pg_changes *changes)
{
    for (size_t k = 0; k < changes->n; k++) r->state->alive[changes->bond[k]] = 0;
    refresh (r, changes);
}

/* Some live bonds of the evaluation points within 0.15 m of a place. */
static void break_near (run *r, double at_x, double at_y)
{
    const pg_rows *rows = &r->problem->bonds.rows[PG_POINTS];
    pg_changes changes = { 0 };
    size_t bond[40];
    changes.bond = bond;
    for (size_t q = 0; q < rows->n && changes.n < 30; q++)
        for (size_t e = rows->family.start[q]; e < rows->family.start[q + 1] && changes.n < 30; e += 3) {
            size_t b = r->problem->bonds.first[PG_POINTS] + e;
            if (hypot (rows->x[2*q] - at_x, rows->x[2*q + 1] - at_y) < 0.15 && r->state->alive[b])
                bond[changes.n++] = b;
        }
    assert_true (changes.n > 10);
    lose (r, &changes);
}

static void kept_places_are_what_new_ones_are (void **state)
{
    (void) state;
    static double x[2 * EACH], one[NUMBERS], two[NUMBERS];
    run r = plate ();
    pg_changes changes = { 0 };
    double to[3] = { 0.9, 1.03, 0 };
    refresh (&r, NULL);
    places (&r, x);
    compare (&r, x, one);
    break_near (&r, 2.7, 0.3);
    compare (&r, x, two);
    assert_memory_equal (one, two, sizeof one);
    break_near (&r, 0.9, 1.2);
    compare (&r, x, two);
    assert_true (memcmp (one, two, sizeof one) != 0);
    check_ok (pg_crack_grow (r.state, r.problem, 0, to, 0, &changes));
    compare (&r, x, one);                              /* the crack alone, no bond has died yet */
    assert_true (memcmp (one, two, sizeof one) != 0);
    lose (&r, &changes);
    compare (&r, x, two);
    pg_free (changes.bond);
    clear (&r);
}

/* A run tells that it did so, and a plain one does not. */
static int told (const run *r)
{
    const pg_statistics *s = pg_solver_report_now (r->solver);
    int any = 0;
    for (size_t k = 0; k < s->nskipped; k++) any |= strstr (s->skipped[k].what, "around tips") != NULL;
    return any;
}

static void a_run_tells_of_it (void **state)
{
    (void) state;
    for (int plain = 0; plain < 2; plain++) {
        char text[40];
        snprintf (text, sizeof text, "solver.plain=%s", plain ? "true" : "false");
        const char *const set[] = { "solver={kind: newmark, dt: 0.1 us, end: 50 us}", text };
        run r = loaded ("data/glass_branching/facets.yaml", 2, set);
        for (int i = 0; i < 8; i++) advance (&r);
        assert_int_equal (told (&r), !plain);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (kept_places_are_what_new_ones_are),
        cmocka_unit_test (a_run_tells_of_it),
    };
    return cmocka_run_group_tests_name ("mechanics/force/sample_again", tests, NULL, NULL);
}
