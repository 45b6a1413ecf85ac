/* SPDX-License-Identifier: GPL-3.0-or-later
 * Runs by forces straight between points: solvers agree, loads arrive in full, cracks grow by events and in
 * time, materials, scenes refused. */
#include "refused.h"
#include "run.h"

#define PLATE \
    "dimension: 2\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 20 mm]}}}]\nspacing: 1 " \
    "mm\n"
#define ROCK "materials: {rock: {youngs_modulus: 72 GPa, poissons_ratio: 0.3333, density: 2500 kg/m3}}\n"
#define CRACK "cracks: [{from: [-1 mm, 10.5 mm], to: [5.2 mm, 10.5 mm]}]\n"
#define PULL \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {name: pull, set: top, displacement: {y: 10 " \
    "um}}]\n"

static double difference (const run *a, const run *b)
{
    double worst = 0, top = 0;
    assert_int_equal (a->state->ndof, b->state->ndof);
    for (size_t i = 0; i < a->state->ndof; i++) {
        worst = fmax (worst, fabs (a->state->d[i] - b->state->d[i]));
        top = fmax (top, fabs (a->state->d[i]));
    }
    assert_true (top > 0);
    return worst / top;
}

static void solvers_agree (void **unused)
{
    (void) unused;
    static const char *const more[] = { "linear: cholmod", "linear: pcg", "linear: umfpack" };
    static const char *const bodies[] = {
        PLATE,
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [6 mm, 9 mm, 5 mm]}}}]\nspacing: 1 mm\n",
        ("dimension: 2\nplane: strain\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], high: [20 mm, 12 "
         "mm]}}}]\nspacing: 1 mm\nperturb: {amount: 0.2}\n")
    };
    for (int body = 0; body < 3; body++) {
        run r[3];
        for (int k = 0; k < 3; k++) {
            r[k] = scene_of (1,
                             "%s" ROCK "%smethod: {force: bond}\nboundary: [{set: bottom, displacement: {x: "
                                       "0, y: 0%s}}, {set: top, traction: {x: 1 MPa, y: 2 MPa}}]\n"
                             "solver: {%s, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                             bodies[body], body == 1 ? "" : CRACK, body == 1 ? ", z: 0" : "", more[k]);
            to_the_end (&r[k]);
            check_below (r[k].step.residual, 1e-8);
        }
        for (int k = 1; k < 3; k++) check_below (difference (&r[0], &r[k]), 1e-7);
        for (int k = 0; k < 3; k++) clear (&r[k]);
    }
}

/* Every kind of load reaches points in full: the supports answer with its sum. */
static void loads_arrive (void **unused)
{
    (void) unused;
    static const struct { const char *load, *lattice; double x, y;
    } cases[] = { { "set: top, traction: {x: 1 MPa, y: 2 MPa}", "nodes", 40, 80 },
                  { "set: top, traction: {x: 1 MPa, y: 2 MPa}", "cells", 40, 80 },
                  { "set: top, pressure: 3 MPa", "nodes", 0, -120 },
                  { "set: top, force: {x: 7 N}", "nodes", 7, 0 },
                  { "set: all, body_force: {y: -1e6}", "nodes", 0, -0.8 },
                  { "set: top, traction: {y: \"1 MPa * (1 + t)\"}, ramp: constant", "nodes", 0, 80 },
                  { "set: top, traction: {y: \"1 MPa * x / 10 mm\"}", "cells", 0, 40 } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        run r = scene_of (1,
                          PLATE "lattice: %s\n" ROCK
                                "method: {force: bond}\nsets: {low: {where: \"y < 0.6 mm\"}}\n"
                                "boundary: [{set: low, displacement: {x: 0, y: 0}}, {%s}]\nsolver: "
                                "{stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
                          cases[k].lattice, cases[k].load);
        to_the_end (&r);
        check_scaled (r.step.reaction[3], cases[k].x, 1e-9, 1);
        check_scaled (r.step.reaction[4], cases[k].y, 1e-9, 1);
        check_scaled (r.step.reaction[0], -cases[k].x, 1e-7, 1);
        check_scaled (r.step.reaction[1], -cases[k].y, 1e-7, 1);
        const pg_statistics *report = pg_solver_report (r.solver, r.state);
        if (!strstr (cases[k].load, "ramp"))
            check_relative (report->energy.external, report->energy.strain, 1e-7);
        clear (&r);
    }
}

/* Event by event: equilibrium, no bond over its limit, both directions of a bond together, energy given by
 * the loads is stored or consumed. */
static void crack_by_events (void **unused)
{
    (void) unused;
    static const char *const more[] = { "", ", evaluation: list", ", horizon: 4.3 spacing" };
    for (int k = 0; k < 3; k++) {
        run r = scene_of (1,
                          PLATE ROCK CRACK PULL
                          "method: {force: bond%s}\nfailure: {criterion: stretch, fracture_energy: 10 "
                          "J/m2}\nsolver: {stepping: event, max_events: 60}\n",
                          more[k]);
        const pg_family *f = &r.problem->bonds.rows[PG_NODES].family;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            check_below (r.step.residual, 1e-8);
            check_below (r.step.utilisation, 1 + 1e-4);
            assert_int_equal (r.step.nbroken % 2, 0);
        }
        assert_true (r.state->events >= 20);
        for (size_t i = 0; i < f->n; i++)
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
                for (size_t b = f->start[f->node[e]]; b < f->start[f->node[e] + 1]; b++)
                    if ((size_t) f->node[b] == i) assert_int_equal (r.state->alive[e], r.state->alive[b]);
        clear (&r);
    }
}

/* Refreshed step by step, the force is the one made new from the alive bits; what march breaks is what
 * utilisation finds. */
static void march_and_refresh (void **unused)
{
    (void) unused;
    static const char *const more[] = { "", ", evaluation: list", ", stretch: finite" };
    for (int k = 0; k < 3; k++) {
        run r = scene_of (
            1,
            PLATE ROCK CRACK PULL
            "method: {force: bond%s}\nfailure: {criterion: stretch, critical_stretch: 1e-3, exclude: [top]}\n"
            "solver: {kind: verlet, end: 1 us}\n",
            more[k]);
        const pg_force_type *force = pg_force_find ("bond");
        void *self = NULL, *fresh = NULL;
        size_t n = r.state->ndof, nbond = r.state->nbond, dead = 0;
        double *d = pg_calloc (n, sizeof *d), *a = pg_calloc (n, sizeof *a), *b = pg_calloc (n, sizeof *b),
               *use = pg_calloc (nbond, sizeof *use), reference;
        pg_changes broken = { 0 };
        check_ok (force->create (&self, r.problem));
        check_ok (force->create (&fresh, r.problem));
        check_ok (force->refresh (self, r.state, NULL));
        for (size_t i = 0; i < n; i++) d[i] = 1e-6 * sin (3.7 * (double) i);
        check_ok (force->judge (self, r.state, d, &(pg_judging){ .utilisation = use }));
        check_ok (force->motion.balance_and_break (self, 0.5e-6, d, a, &reference, &broken));
        for (size_t e = 0; e < nbond; e++) dead += use[e] >= 1;
        assert_true (dead > 20 && dead < nbond);
        assert_int_equal (broken.n, dead);
        for (size_t c = 0; c < broken.n; c++) {
            assert_true (use[broken.bond[c]] >= 1 && (c == 0 || broken.bond[c] > broken.bond[c - 1]));
            r.state->alive[broken.bond[c]] = 0;
        }
        check_ok (force->refresh (fresh, r.state, NULL));
        check_ok (force->balance (fresh, 0.5e-6, d, b, NULL));
        assert_memory_equal (a, b, n * sizeof *a);
        check_ok (force->balance (self, 0.5e-6, d, a, NULL));
        assert_memory_equal (a, b, n * sizeof *a);
        force->operator_ (self)->apply (force->operator_ (self)->context, d, a);
        force->operator_ (fresh)->apply (force->operator_ (fresh)->context, d, b);
        assert_memory_equal (a, b, n * sizeof *a);
        pg_free (d), pg_free (a), pg_free (b), pg_free (use), pg_free (broken.bond);
        force->free (&self), force->free (&fresh);
        clear (&r);
    }
}

static void crack_in_time (void **unused)
{
    (void) unused;
    run r = scene_of (1, PLATE ROCK CRACK "boundary: [{set: bottom, displacement: {y: 0}}, {set: top, "
                                          "traction: {y: 30 MPa}, ramp: constant}]\nmethod: {force: bond}\n"
                                          "failure: {criterion: stretch, fracture_energy: 10 J/m2}\nsolver: "
                                          "{kind: newmark, dt: 0.2 us, end: 8 us}\n");
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_below (r.step.residual, 1e-8);
    }
    const pg_statistics *report = pg_solver_report (r.solver, r.state);
    assert_true (report->broken > 100 && report->energy.dissipated > 0);
    clear (&r);
}

/* Two halves in series under one stress: strains as the moduli, far from ends and joint; the weaker half
 * alone breaks. */
static void two_materials (void **unused)
{
    (void) unused;
    run r = scene_of (1, "dimension: 1\ncross_section: 1 mm2\nbody: [{add: {box: {low: [0], high: [100 "
                         "mm]}}}]\nspacing: 1 mm\nlattice: cells\n"
                         "materials: {soft: {youngs_modulus: 10 GPa, poissons_ratio: 0}, hard: "
                         "{youngs_modulus: 40 GPa, poissons_ratio: 0, failure: {critical_stretch: 1e-5}}}\n"
                         "blocks: [{material: soft, where: x < 50 mm}, {material: hard, where: x > 50 "
                         "mm}]\nmethod: {force: bond, partial_volume: none}\n"
                         "failure: {criterion: stretch, critical_stretch: 1}\nsets: {a: {where: x < 3 mm}, "
                         "b: {where: x > 97 mm}}\n"
                         "boundary: [{set: a, displacement: {x: 0}}, {name: pull, set: b, displacement: {x: "
                         "1 mm}}]\nsolver: {stepping: event, max_events: 2}\n");
    assert_string_equal (r.problem->material[0].name, "soft");
    advance (&r);
    double *e = field_of (&r, NULL, "strain", NULL);
    check_relative (e[25] / e[75], 4, 0.02);
    pg_free (e);
    while (!pg_solver_done (r.solver, r.state) && r.step.nbroken == 0) advance (&r);
    assert_true (r.step.nbroken > 0);
    for (size_t k = 0; k < r.step.nbroken; k++) assert_true (r.step.broken[k].place[0] > 0.048);
    clear (&r);
}

static void refusals (void **unused)
{
    (void) unused;
    check_refused (PLATE ROCK PULL
                   "method: {force: bond}\nfailure: {criterion: principal_stress, tensile_strength: 1 MPa}\n",
                   "use stretch, node_energy, energy_release, or force: galerkin");
    check_refused (PLATE ROCK PULL "method: {force: bond, stretch: finite}\n",
                   "this solver needs linear ones");
    check_refused (PLATE ROCK PULL "method: {force: bond, stretch: finite}\nfailure: {criterion: stretch, "
                                   "critical_stretch: 1e-3, stretch: linear}\n"
                                   "solver: {kind: verlet, end: 1 us}\n",
                   "method.stretch is finite");
    check_refused (PLATE "perturb: {amount: 0.1}\n" ROCK PULL
                   "method: {force: bond, partial_volume: overlap}\n",
                   "use linear or none");
    check_refused (PLATE "perturb: {amount: 0.1}\n" ROCK PULL "method: {force: bond, evaluation: stencil}\n",
                   "use list or auto");
    check_refused (PLATE ROCK PULL "method: {force: bond, evaluation: stencil, surface_correction: volume}\n",
                   "use list or auto");
}

/* A galerkin scene, one key set: what means nothing now is told, and the default kernel and horizon
 * change. */
static void galerkin_scene (void **unused)
{
    (void) unused;
    run r = scene_of (1, PLATE
                      "materials: {rock: {youngs_modulus: 72 GPa, poissons_ratio: 0.2}}\n"
                      "method: {force: bond, approximation: rkpm, integration: gauss, nitsche_factor: 10}\n"
                      "boundary: [{set: bottom, displacement: {x: 0, y: 0}, essential: penalty}, {set: top, "
                      "displacement: {y: 1 um}}]\nsolver: {stepping: fixed, steps: 1}\n");
    assert_string_equal (r.problem->form.approx.kernel->name, "constant");
    check_relative (r.problem->form.approx.horizon, 3.015e-3, 1e-12);
    assert_int_equal (r.problem->notes.n, 3);
    check_contains (r.problem->notes.text[0], "approximation, integration, nitsche_factor");
    check_contains (r.problem->notes.text[1], "boundary[0].essential");
    check_contains (r.problem->notes.text[2], "Poisson's ratio is 0.3333, not 0.2");
    to_the_end (&r);
    clear (&r);
}

/* A crack on a row of points, and one between two rows, of bodies 1, 2, 3 and 9 points high with a whole
 * horizon: points on it are loose and stay where they are; damage and displacement are mirrored. Nothing
 * holds a row of points across: the thinnest body is pulled along only. */
static void cracks_on_lattice_lines (void **unused)
{
    (void) unused;
    static const char *const solvers[] = { "{stepping: event, max_events: 12}", "{kind: relax, stages: 4}",
                                           "{kind: adr, stages: 40, hold: off}",
                                           "{kind: verlet, end: 8 us}" };
    static const int rows[] = { 1, 2, 3, 9 };
    for (size_t k = 0; k < sizeof rows / sizeof *rows * 4; k++) {
        int high = rows[k / 4], long_ = 15, on_row = high % 2;
        run r = scene_of (1,
                          "dimension: 2\nthickness: 2 mm\nbody: [{add: {box: {low: [0, %g mm], high: [15 mm, "
                          "%g mm]}}}]\nspacing: 1 mm\nlattice: cells\n" ROCK
                          "cracks: [{from: [6 mm, 0], to: [9.1 mm, 0]}]\nboundary: [{set: left, "
                          "displacement: {x: 0, y: 0}}, {set: right, displacement: {x: 40 um, y: 0}}]\n"
                          "method: {force: bond, horizon: 3 spacing, partial_volume: none}\nfailure: "
                          "{criterion: stretch, critical_stretch: 2e-3}\nsolver: %s\n",
                          -0.5 * high, 0.5 * high, solvers[k % 4]);
        const pg_cloud *c = &r.problem->cloud;
        const pg_family *f = &r.problem->bonds.rows[PG_NODES].family;
        assert_int_equal (c->n, (size_t) (long_ * high));
        while (!pg_solver_done (r.solver, r.state)) advance (&r);
        double most = 0;
        for (size_t i = 0; i < r.state->ndof; i++) {
            assert_true (isfinite (r.state->d[i]));
            most = fmax (most, fabs (r.state->d[i]));
        }
        assert_true (most > 0);
        for (size_t i = 0; i < c->n; i++) {
            /* mirrored at y = 0 */
            size_t j = (size_t) (high - 1) * (size_t) long_ - i + 2 * (i % (size_t) long_), mine = 0, its = 0;
            check_relative (c->x[2*i], c->x[2*j], 1e-12);
            check_scaled (c->x[2*i + 1], -c->x[2*j + 1], 1e-12, 1e-3);
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) mine += r.state->alive[e];
            for (size_t e = f->start[j]; e < f->start[j + 1]; e++) its += r.state->alive[e];
            assert_int_equal (mine, its);
            check_scaled (r.state->d[2*i], r.state->d[2*j], 1e-6, most);
            check_scaled (r.state->d[2*i + 1], -r.state->d[2*j + 1], 1e-6, most);
            if (on_row && fabs (c->x[2*i + 1]) < 1e-6 && c->x[2*i] > 6.1e-3 && c->x[2*i] < 9e-3) {
                assert_int_equal (mine, 0);
                check_scaled (r.state->d[2*i], 0, 1e-12, most);
            }
        }
        clear (&r);
    }
}

/* Wherever memory ends, a message and nothing left over. */
static void memory_ends (void **unused)
{
    (void) unused;
    pg_scene *scene = NULL;
    check_ok (
        pg_scene_parse (&scene,
                        "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [6 mm, 6 "
                        "mm]}}}]\nspacing: 1 mm\n" ROCK
                        "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, traction: {y: 1 "
                        "MPa}}]\nmethod: {force: bond}\nfailure: {criterion: stretch, critical_stretch: 1}\n",
                        "test.yaml"));
    pg_problem *problem = NULL;
    check_ok (pg_problem_build (&problem, scene, 1));
    const pg_force_type *force = pg_force_find ("bond");
    pg_state *state = NULL;
    check_ok (pg_state_create (&state, problem, 2));
    pg_status status = PG_E_MEMORY;
    size_t used = pg_memory_used (), k = 1;
    double place[2] = { 0.003, 0.003 }, u[3];
    for (; k < 1000 && status == PG_E_MEMORY; k++) {
        void *self = NULL;
        pg_memory_fail_at (k);
        status = force->create (&self, problem);
        if (status == PG_OK) status = force->refresh (self, state, NULL);
        if (status == PG_OK) status = pg_force_assemble (force, self, NULL);
        if (status == PG_OK) status = force->sample (self, state, state->d, 1, place, u, NULL, NULL);
        pg_memory_fail_at (0);
        if (self) force->free (&self);
        assert_int_equal (pg_memory_used (), used);
    }
    assert_int_equal (status, PG_OK);
    assert_true (k > 15);
    pg_problem *again = NULL;
    used = pg_memory_used ();
    for (status = PG_E_MEMORY, k = 1; k < 3000 && status == PG_E_MEMORY; k++) {
        pg_memory_fail_at (k);
        status = pg_problem_build (&again, scene, 1);
        pg_memory_fail_at (0);
        pg_problem_free (&again);
        assert_int_equal (pg_memory_used (), used);
    }
    assert_int_equal (status, PG_OK);
    pg_state_free (&state), pg_problem_free (&problem), pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (solvers_agree),
                                        cmocka_unit_test (loads_arrive),
                                        cmocka_unit_test (crack_by_events),
                                        cmocka_unit_test (march_and_refresh),
                                        cmocka_unit_test (crack_in_time),
                                        cmocka_unit_test (two_materials),
                                        cmocka_unit_test (refusals),
                                        cmocka_unit_test (galerkin_scene),
                                        cmocka_unit_test (cracks_on_lattice_lines),
                                        cmocka_unit_test (memory_ends) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
