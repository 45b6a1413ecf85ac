/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact equilibria after breaks from the factor of an earlier stiffness: runs with and without them break the
 * same bonds in the same order, for every integration, way of prescribing, criterion and kind of load; blocks
 * of events and going back are what equilibria solved anew say. */
#include "scene_runs/run.h"
#include "solve/events/event_solver.h"

#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 16 " \
    "mm]}}}]\nspacing: 1 mm\nperturb: {amount: 0.1}\ncracks: [{from: [-1 mm, 8 mm], to: [6 mm, 8 mm]}]\n" \
    "materials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.22, density: 2500 kg/m3}}\n"
#define STRETCH "failure: {criterion: stretch, critical_stretch: 1e-3, exclude: [bottom, top]}\n"
#define STRESS "failure: {criterion: principal_stress, tensile_strength: 30 MPa, exclude: [bottom, top]}\n"
#define COULOMB \
    "failure: {criterion: mohr_coulomb, tensile_strength: 30 MPa, cohesion: 80 MPa, friction_angle: 35 " \
    "deg, exclude: [bottom, top]}\n"
#define PULLED "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 40 um}}]\n"
#define HEAVY \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 20 MPa}}, {set: all, " \
    "body_force: {y: -25 kN/m3, x: 2e5 kN/m3}}]\n"
#define BOTH \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 40 um}}, {set: " \
    "left, pressure: 3 MPa, ramp: constant}]\n"
static const char *const cases[] = {
    STRETCH PULLED "method: {integration: gauss}\n",
    STRETCH PULLED "method: {integration: gauss, essential: nitsche}\n",
    STRESS PULLED "method: {integration: gauss, essential: penalty}\n",
    COULOMB PULLED "method: {integration: consistent}\n",
    STRETCH PULLED "method: {integration: nodal, horizon: 2.5 spacing}\n",
    STRETCH PULLED "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing}\n",
    STRESS HEAVY "method: {integration: gauss}\n",
    STRETCH BOTH "method: {integration: gauss}\n",
    COULOMB BOTH "method: {integration: consistent, essential: penalty}\n",
};
enum { CASES = sizeof cases / sizeof *cases };

static run plate (int c, int plain)
{
    return scene_of (1, PLATE "%ssolver: {stepping: event, max_events: 60, plain: %s}\noutput: {at: {levels: "
                              "1}}\n",
                     cases[c], plain ? "true" : "false");
}

/* Loads that follow shape functions touch unknowns which no change of the stiffness does, after the system of
 * those before was factored; a factor that leaves much to correct uses it at once. */
static void loads_touch_more (void **state)
{
    (void) state;
    run r[2];
    for (int plain = 0; plain < 2; plain++) {
        r[plain] = scene_of (
            1, "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, "
               "0.8]}}}]\nspacing: 0.1\nperturb: {amount: 0.1}\nmaterials: {rock: {youngs_modulus: 1 GPa, "
               "poissons_ratio: 0.25}}\nmethod: {integration: gauss}\nfailure: {criterion: principal_stress, "
               "tensile_strength: 0.4 MPa}\nboundary: [{set: left, displacement: {x: 0}}, {set: bottom, "
               "displacement: {y: 0}}, {set: top, traction: {x: 494582.5324465672, y: -594494.7353081806}}]\n"
               "solver: {max_events: 12, linear: umfpack, plain: %s}\noutput: {at: {levels: 2}}\n",
            plain ? "true" : "false");
        to_the_end (&r[plain]);
    }
    assert_memory_equal (r[0].state->alive, r[1].state->alive, r[0].state->nbond);
    check_scaled (r[0].state->factor, r[1].state->factor, 1e-8, r[1].state->factor);
    check_below (largest_difference (r[0].state->d, r[1].state->d, r[0].state->ndof),
                 1e-8 * largest_of (r[1].state->d, r[1].state->ndof));
    for (int plain = 0; plain < 2; plain++) clear (&r[plain]);
}

/* Event by event: the same bonds, at the same load, the same displacement. */
static void the_same_bonds_break (void **state)
{
    (void) state;
    for (int c = 0; c < CASES; c++) {
        run a = plate (c, 0), b = plate (c, 1);
        while (!pg_solver_done (a.solver, a.state) && !pg_solver_done (b.solver, b.state)) {
            advance (&a), advance (&b);
            if (memcmp (a.state->alive, b.state->alive, a.state->nbond)) print_error ("case %d\n", c);
            assert_memory_equal (a.state->alive, b.state->alive, a.state->nbond);
            check_scaled (a.state->factor, b.state->factor, 1e-8, b.state->factor);
            check_below (largest_difference (a.state->d, b.state->d, a.state->ndof),
                         1e-8 * largest_of (b.state->d, b.state->ndof));
        }
        const pg_statistics *quick = pg_solver_report (a.solver, a.state),
                            *plain = pg_solver_report (b.solver, b.state);
        print_message ("case %d: %ld events, %ld factorizations for %ld\n", c, quick->events,
                       quick->linear.factorizations, plain->linear.factorizations);
        assert_true (quick->events > 5);
        assert_true (2 * quick->linear.factorizations <= plain->linear.factorizations);
        clear (&a), clear (&b);
    }
}

/* Rows of single points between cracks are mechanisms that hardly resist. Springs on weak unknowns, of which
 * refinement would leave a part, must move the load of no event, in plain runs either. */
static void mechanisms_do_not_move_the_load (void **state)
{
    (void) state;
    char cracks[1024] = "", *end = cracks;
    for (int k = -5; k <= 5; k++)
        end += sprintf (end, "%s{from: [-1.1, %.1f], to: [0.9, %.1f]}", k > -5 ? ", " : "", 0.1 * k, 0.1 * k);
    run r[2];
    for (int plain = 0; plain < 2; plain++)
        r[plain] = scene_of (
            1,
            "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-1, -1], high: [1, 1]}}}]\nspacing: 0.1\n"
            "lattice: cells\ncracks: [%s]\nmaterials: {m: {youngs_modulus: 72 GPa, poissons_ratio: 0.2}}\n"
            "failure: {criterion: stretch, critical_stretch: 2e-3, exclude: [top_grip, bottom_grip]}\n"
            "sets: {top_grip: {where: y >= 0.7}, bottom_grip: {where: y <= -0.7}}\n"
            "method: {horizon: 2 spacing, approximation: pddo, integration: gauss, accept_inexact: true}\n"
            "boundary: [{set: top_grip, displacement: {x: 0, y: 2 mm}}, {set: bottom_grip, displacement: {x: "
            "0, y: -2 mm}}]\nsolver: {stepping: event, max_events: 12, plain: %s}\n",
            cracks, plain ? "true" : "false");
    for (int event = 0; event < 12; event++) {
        advance (&r[0]), advance (&r[1]);
        assert_memory_equal (r[0].state->alive, r[1].state->alive, r[0].state->nbond);
        check_scaled (r[0].state->factor, r[1].state->factor, 1e-10, r[1].state->factor);
    }
    clear (&r[0]), clear (&r[1]);
}

/* ---- by itself ----------------------------------------------------------------------------------------- */
/* A body whose bonds break as this file has it, with a system of its own. */
typedef struct {
    run r;
    pg_system s;
    pg_statistics report;
    event_solver *e;
    double *u[2], *anew[2], *shown;
} bench;
static const double times[2] = { 0, 1 };

static void begin (bench *b, int c)
{
    memset (b, 0, sizeof *b);
    b->r = plate (c, 0);
    b->s.problem = b->r.problem, b->s.force = pg_force_of (b->r.problem), b->s.options = &b->r.options,
    b->s.report = &b->report;
    check_ok (system_create (&b->s));
    check_ok (system_refresh (&b->s, b->r.state, NULL));
    for (int k = 0; k < 2; k++) {
        b->u[k] = pg_calloc (b->s.ndof, sizeof (double)), b->anew[k] = pg_calloc (b->s.ndof, sizeof (double));
    }
    b->shown = pg_calloc (b->s.ndof, sizeof (double));
    double residual;
    check_ok (event_solver_create (&b->e, &b->s, 2, times));
    assert_non_null (b->e);
    check_ok (event_solver_base (b->e, b->u, &residual));
    assert_true (event_solver_has_base (b->e));
}

static void end (bench *b)
{
    event_solver_free (&b->e);
    system_free (&b->s);
    for (int k = 0; k < 2; k++) pg_free (b->u[k]), pg_free (b->anew[k]);
    pg_free (b->shown);
    clear (&b->r);
}

/* Bonds of the k-th event: some across the line ahead of the crack; alive or dead. */
static void cut (bench *b, int k, int alive)
{
    const pg_problem *p = b->r.problem;
    pg_changes changes = { .bond = pg_calloc (p->bonds.first[PG_BOND_SETS], sizeof *changes.bond) };
    for (int s = 0; s < PG_BOND_SETS; s++)
        for (size_t q = 0; q < p->bonds.rows[s].n; q++)
            for (size_t e = p->bonds.rows[s].family.start[q]; e < p->bonds.rows[s].family.start[q + 1]; e++) {
                const double *x = p->bonds.rows[s].x + 2*q,
                             *y = p->cloud.x + 2*(size_t) p->bonds.rows[s].family.node[e];
                size_t bond = p->bonds.first[s] + e;
                double at = 0.5 * (x[0] + y[0]) - (6e-3 + 0.3e-3 * k);
                if ((x[1] - 8e-3) * (y[1] - 8e-3) >= 0 || at < 0 || at >= 0.3e-3) continue;
                b->r.state->alive[bond] = (unsigned char) alive;
                changes.bond[changes.n++] = bond;
            }
    assert_true (changes.n > 0);
    check_ok (system_refresh (&b->s, b->r.state, &changes));
    pg_free (changes.bond);
}

/* Against equilibria solved anew. */
static void check_solution (bench *b, double tolerance)
{
    double residual;
    for (int c = 0; c < 2; c++) {
        check_ok (event_solver_full (b->e, c, b->u[c]));
        memcpy (b->anew[c], b->u[c], b->s.ndof * sizeof (double));
        /* conjugate gradients, so that the factor of the base stays */
        int mode = b->s.choice.mode, stale = b->s.direct.stale;
        b->s.choice.mode = SYSTEM_NO_FACTOR;
        check_ok (system_solve (&b->s, times[c], b->anew[c], NULL, &residual));
        b->s.choice.mode = mode, b->s.direct.stale = stale;
        check_below (largest_difference (b->u[c], b->anew[c], b->s.ndof),
                     tolerance * largest_of (b->anew[c], b->s.ndof));
    }
}

static void blocks_and_going_back (void **state)
{
    (void) state;
    static const int some[] = { 0, 2, 6, 8 };
    for (int k = 0; k < 4; k++) {
        bench b;
        inverse_outcome outcome;
        int list[6] = { -1, 0, 1, 2, 3, 4 };
        begin (&b, some[k]);
        size_t n = b.s.ndof, nodes = b.r.problem->cloud.n;
        int *every = pg_calloc (nodes, sizeof *every);
        for (size_t i = 0; i < nodes; i++) every[i] = (int) i;
        double *kept[6], *block = pg_calloc (6 * n, sizeof *block);
        for (int m = 0; m < 6; m++) {
            if (m > 0) {
                cut (&b, m - 1, 0);
                check_ok (event_solver_update (b.e, &outcome));
                assert_true (outcome == INVERSE_TAKEN || outcome == INVERSE_DUE);
                assert_int_equal (b.e->count, m);
                check_below (b.e->residual, 1e-10);
            }
            check_solution (&b, 1e-6);
            kept[m] = pg_calloc (n, sizeof **kept);
            memcpy (kept[m], b.u[1], n * sizeof **kept);
            check_ok (event_solver_watch (b.e, nodes, every));
            check_ok (event_solver_watched (b.e, 1, b.shown));
            check_below (largest_difference (b.shown, b.u[1], n), 1e-12 * largest_of (b.u[1], n));
        }
        check_ok (event_solver_block (b.e, 1, 6, list, block));
        for (int m = 0; m < 6; m++)
            for (size_t i = 0; i < n; i++)
                check_scaled (block[i * 6 + (size_t) m], kept[m][i], 1e-12, largest_of (kept[m], n));
        /* back to event 1, and another way from there */
        for (int m = 4; m > 1; m--) cut (&b, m, 1);
        check_ok (event_solver_back (b.e, 1, &outcome));
        assert_int_equal (b.e->count, 2);
        check_ok (event_solver_full (b.e, 1, b.shown));
        check_below (largest_difference (b.shown, kept[2], n), 1e-12 * largest_of (kept[2], n));
        cut (&b, 5, 0);
        check_ok (event_solver_update (b.e, &outcome));
        check_solution (&b, 1e-6);
        double residual;
        check_ok (event_solver_settle (b.e, 1, 0, b.u[1], &residual));
        check_below (residual, 1e-8);
        check_ok (event_solver_settle (b.e, 1, 0, b.u[1], &residual));
        /* springs of a penalty are so stiff that the forces of rounding are large */
        check_below (residual, strstr (cases[some[k]], "penalty") ? 1e-8 : 1e-12);
        for (int m = 0; m < 6; m++) pg_free (kept[m]);
        pg_free (block), pg_free (every);
        end (&b);
    }
}

/* What a base has left unbalanced, here a displacement that was put in: settling takes it out of the
 * displacement that it hands out as well as out of the base, and says how large it was. */
static void settling_corrects_the_displacement (void **state)
{
    (void) state;
    bench b;
    inverse_outcome outcome;
    double before, after;
    begin (&b, 0);
    size_t n = b.s.ndof;
    cut (&b, 0, 0);
    check_ok (event_solver_update (b.e, &outcome));
    check_ok (event_solver_full (b.e, 1, b.anew[1]));
    double top = largest_of (b.anew[1], n);
    for (size_t i = n / 3; i < n / 3 + 4; i++) b.e->of[1].base[i] += 1e-5 * top;
    check_ok (event_solver_settle (b.e, 1, 1e-12, b.u[1], &before));
    assert_true (before > 1e-8);
    check_below (largest_difference (b.u[1], b.anew[1], n), 1e-9 * top);
    check_ok (event_solver_full (b.e, 1, b.shown));
    check_below (largest_difference (b.shown, b.u[1], n), 1e-12 * top);
    check_ok (event_solver_settle (b.e, 1, 1, b.u[1], &after));
    check_below (after, 1e-5 * before);
    end (&b);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (loads_touch_more),
        cmocka_unit_test (the_same_bonds_break),
        cmocka_unit_test (mechanisms_do_not_move_the_load),
        cmocka_unit_test (blocks_and_going_back),
        cmocka_unit_test (settling_corrects_the_displacement),
    };
    return cmocka_run_group_tests_name ("solve/event_solver", tests, NULL, NULL);
}
