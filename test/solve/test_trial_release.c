/* SPDX-License-Identifier: GPL-3.0-or-later
 * The energy that a cut would release: by columns of the inverse it is that of the cut body solved anew, for
 * every support, load and force, for one load and for two, and the state, the caches and the factor are
 * afterwards what they were. */
#include "scene_runs/run.h"

/* the last case is nearly incompressible, so that pressures of patches carry part of the stress */
#define PLATE \
    "dimension: 2\nthickness: 0.2 m\nbody: [{add: {box: {low: [0, 0], high: [1 m, 0.6 " \
    "m]}}}]\nspacing: 0.05 m\n" \
    "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: %g}}\nplane: %s\n"
#define OF(c) (c) + 1 == CASES ? 0.49 : 0.25, (c) + 1 == CASES ? "strain" : "stress"

/* Live bonds across a line, those already listed left out. */
static void cut_line (const run *r, double *ends, unsigned char *listed, pg_changes *out)
{
    const pg_problem *p = r->problem;
    pg_crack line = { .kind = PG_CRACK_SEGMENT, .vertex = ends, .nvertex = 2 };
    pg_crack_orient (&line);
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            for (size_t e = p->bonds.rows[s].family.start[q]; e < p->bonds.rows[s].family.start[q + 1]; e++) {
                size_t bond = p->bonds.first[s] + e;
                int j = p->bonds.rows[s].family.node[e];
                const double *a = p->bonds.rows[s].x + 2*q, *b = p->cloud.x + 2 * (size_t) j;
                if (!r->state->alive[bond] || listed[bond] || j == p->bonds.rows[s].own[q]
                    || !pg_crack_cuts (&line, 2, a, b, 1e-12))
                    continue;
                listed[bond] = 1;
                out->bond = pg_resize (out->bond, out->n + 1, sizeof *out->bond);
                out->bond[out->n++] = bond;
            }
    assert_true (out->n > 0);
}

enum { STAGES = 4 };
typedef struct { pg_changes cut[STAGES]; unsigned char *listed; } stages;

static stages stages_of (const run *r)
{
    stages s = { { { 0 } }, pg_calloc (r->state->nbond, 1) };
    for (int k = 0; k < STAGES; k++)
        cut_line (r, (double[]){ 0.51, -1, 0.51, 0.07 + 0.05 * k }, s.listed, &s.cut[k]);
    return s;
}

static void forget (stages *s)
{
    for (int k = 0; k < STAGES; k++) pg_free (s->cut[k].bond);
    pg_free (s->listed);
}

static const char *const cases[] = {
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 3 MPa}}]\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 3 MPa, y: 1 MPa}}]\n"
    "method: {integration: consistent}\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: bottom, traction: {y: -1 MPa}}, {set: all, "
    "body_force: {x: 1 MN/m3}}]\nmethod: {basis: quadratic, horizon: 0.15 m}\n",
    /* the cut begins in the held side */
    "boundary: [{set: bottom, displacement: {x: 1 mm/m * x, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n"
    "method: {essential: penalty}\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n"
    "method: {essential: transformation}\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 3 MPa}}]\n"
    "method: {force: bond}\n",
    "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 1 mm}}]\n",
};
enum { CASES = sizeof cases / sizeof *cases, PENALTY = 5 };

static void columns_are_as_good_as_solving_anew (void **state)
{
    (void) state;
    for (int c = 0; c < CASES; c++) {
        run r = scene_of (1, PLATE "%s", OF (c), cases[c]);
        advance (&r);
        stages s = stages_of (&r);
        const double *d[1] = { r.state->d }, t[1] = { r.state->factor };
        double stored = pg_solver_report_now (r.solver)->energy.strain;
        double quick[3 * STAGES], anew[3 * STAGES], again[3 * STAGES];
        check_ok (pg_solver_release (r.solver, r.state, 1, d, t, STAGES, s.cut, 0, quick));
        check_ok (pg_solver_release (r.solver, r.state, 1, d, t, STAGES, s.cut, 1, anew));
        check_ok (pg_solver_release (r.solver, r.state, 1, d, t, STAGES, s.cut, 0, again));
        for (int k = 0; k < STAGES; k++) {
            assert_true (quick[3*k] > (k ? quick[3*k - 3] : 0));
            /* the second is a difference of energies, with rounding of theirs; penalties make that of the
             * columns larger, in proportion (measured at 1e4, 1e6 and 1e8 E / spacing) */
            double rounding = c == PENALTY ? 2e-10 : 2e-12;
            check_below (fabs (quick[3*k] - anew[3*k]), 1e-9 * anew[3*k] + rounding * stored);
            check_relative (again[3*k], quick[3*k], 1e-12);
        }
        forget (&s);
        clear (&r);
    }
}

/* What is tried leaves no trace: the next event is that of a run without trials. Where events are solved by
 * an earlier factor, which a trial replaces, but for the rounding of another base. */
static void a_trial_leaves_no_trace (void **state)
{
    (void) state;
    for (int k = 0; k < 2 * CASES; k++) {
        int c = k / 2, plain = k % 2;
        const char *how = plain ? ", plain: on" : "";
        if (strstr (cases[c], "force")) continue;      /* breaks by other criteria */
        run a = scene_of (1, PLATE "%sfailure: {criterion: stretch, critical_stretch: 1e-4}\n"
                                   "solver: {stepping: event, max_events: 3%s}\n", OF (c), cases[c], how),
            b = scene_of (1, PLATE "%sfailure: {criterion: stretch, critical_stretch: 1e-4}\n"
                                   "solver: {stepping: event, max_events: 3%s}\n", OF (c), cases[c], how);
        while (!pg_solver_done (a.solver, a.state)) {
            advance (&a), advance (&b);
            stages s = stages_of (&a);
            const double *d[1] = { a.state->d }, t[1] = { a.state->factor };
            double release[3 * STAGES];
            check_ok (pg_solver_release (a.solver, a.state, 1, d, t, STAGES, s.cut, 0, release));
            forget (&s);
            assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
            check_below (largest_difference (a.state->d, b.state->d, a.state->ndof),
                         (plain ? 1e-12 : 1e-11) * largest_of (b.state->d, b.state->ndof));
        }
        assert_true (a.state->events > 0);
        clear (&a), clear (&b);
    }
}

/* A constant part and one that grows: the form of two displacements gives the energy at any load factor. */
static void two_loads_make_a_form (void **state)
{
    (void) state;
    static const char *const supports[] = { "nitsche", "transformation" };
    for (int w = 0; w < 2; w++) {
        const char *scene =
            PLATE "boundary: [{set: left, displacement: {x: 0, y: 0}}, {set: right, traction: {x: 3 MPa}}, "
                  "{set: top, pressure: 1 MPa, ramp: constant}]\nmethod: {essential: %s}\n"
                  "solver: {stepping: fixed, steps: 4}\n";
        run r = scene_of (1, scene, 0.25, "stress", supports[w]);
        double *d[2] = { NULL, NULL }, t[2] = { 0.25, 1 };
        advance (&r);
        d[0] = pg_calloc (r.state->ndof, sizeof *d[0]), d[1] = pg_calloc (r.state->ndof, sizeof *d[1]);
        memcpy (d[0], r.state->d, r.state->ndof * sizeof *d[0]);
        advance (&r), advance (&r);
        double *middle = pg_calloc (r.state->ndof, sizeof *middle);
        memcpy (middle, r.state->d, r.state->ndof * sizeof *middle);
        advance (&r);
        memcpy (d[1], r.state->d, r.state->ndof * sizeof *d[1]);
        stages s = stages_of (&r);
        double form[3 * STAGES], anew[3 * STAGES], one[3 * STAGES];
        const double *fields[2] = { d[0], d[1] }, *m[1] = { middle }, at[1] = { 0.75 };
        check_ok (pg_solver_release (r.solver, r.state, 2, fields, t, STAGES, s.cut, 0, form));
        check_ok (pg_solver_release (r.solver, r.state, 2, fields, t, STAGES, s.cut, 1, anew));
        check_ok (pg_solver_release (r.solver, r.state, 1, m, at, STAGES, s.cut, 0, one));
        for (int k = 0; k < STAGES; k++) {
            double w0 = 1.0 / 3, w1 = 2.0 / 3, *f = form + 3*k;
            for (int q = 0; q < 3; q++) check_scaled (f[q], anew[3*k + q], 1e-8, fabs (f[2]));
            check_relative (w0 * w0 * f[0] + 2 * w0 * w1 * f[1] + w1 * w1 * f[2], one[3*k], 1e-9);
        }
        forget (&s);
        pg_free (d[0]), pg_free (d[1]), pg_free (middle);
        clear (&r);
    }
}

/* A strip held at top and bottom, cut at mid height far from its ends: what each spacing of the cut sets
 * free is the energy stored in the strip ahead of it. */
static void a_strip_gives_what_it_stores (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nplane: stress\nthickness: 0.2 m\nspacing: 0.05 m\n"
                         "body: [{add: {box: {low: [0, 0], high: [3 m, 0.6 m]}}}]\n"
                         "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                         "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, "
                         "{set: top, displacement: {x: 0, y: 1 mm}}]\n");
    advance (&r);
    pg_changes cut[2] = { { 0 } };
    unsigned char *listed = pg_calloc (r.state->nbond, 1);
    for (int k = 0; k < 2; k++)
        cut_line (&r, (double[]){ -1, 0.31, k ? 1.75 : 1.25, 0.31 }, listed, &cut[k]);
    const double *d[1] = { r.state->d }, t[1] = { r.state->factor };
    double release[6];
    check_ok (pg_solver_release (r.solver, r.state, 1, d, t, 2, cut, 0, release));
    /* plane stress, no strain along the strip: E / (1 - nu^2) eps^2 / 2 */
    double stored = 0.5 * 10e9 / (1 - 0.0625) * (1e-3 / 0.6) * (1e-3 / 0.6) * 0.6 * 0.2 * 0.5
                    * r.state->factor * r.state->factor;
    check_relative (release[3] - release[0], stored, 2e-3);
    pg_free (listed), pg_free (cut[0].bond), pg_free (cut[1].bond);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (columns_are_as_good_as_solving_anew),
        cmocka_unit_test (a_trial_leaves_no_trace),
        cmocka_unit_test (two_loads_make_a_form),
        cmocka_unit_test (a_strip_gives_what_it_stores),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
