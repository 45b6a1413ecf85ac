/* SPDX-License-Identifier: GPL-3.0-or-later
 * Closed cracks of bodies that bonds hold together: pairs by the bonds that crossed (rows without rigid
 * motions, unit jumps, balance); patch under pressure; the same equilibrium by linear systems, relaxation and
 * slow motion; slip against shape functions; friction, its work and its memory; motion keeps its momenta;
 * threads; what is refused. */
#include "scene_runs/run.h"
#include "perigal/contact.h"
#include "solve/tape.h"

/* A square of half width 3 m with a crack of half length 1 m, n spacings, inclined by `beta` to the load. */
typedef struct {
    double beta, perturb, nu;
    const char *plane, *method, *contact, *solver;
    int n, threads, whole;                             /* whole: 1: without the crack */
} plate;

static run plate_of (const plate *l)
{
    char text[4000];
    double b = l->beta * 3.14159265358979323846 / 180, h = 1.0 / l->n, x = sin (b), y = cos (b);
    snprintf (text, sizeof text,
              "dimension: 2\nplane: %s\nthickness: 1\nbody: [{add: {box: {low: [-3, -3], high: [3, 3]}}}]\n"
              "spacing: %.17g\nlattice: cells\nperturb: {amount: %g}\n"
              "%s{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
              "materials: {m: {youngs_modulus: 1000, poissons_ratio: %.17g, density: 1}}\nmethod: %s\n"
              "contact: %s\nsets: {a: {where: \"x < %.17g and y < %.17g\"}, b: {where: \"x > %.17g and y < "
              "%.17g\"}}\nboundary:\n  - {name: t, set: top, traction: {y: -1}}\n"
              "  - {name: d, set: bottom, traction: {y: 1}}\n"
              "  - {name: a, set: a, %sdisplacement: {x: 0, y: 0}}\n"
              "  - {name: b, set: b, %sdisplacement: {y: 0}}\nsolver: %s\noutput: {at: {levels: 1}}\n",
              l->plane, h, l->perturb, l->whole ? "# [" : "cracks: [",
              -x + 0.13 * h, -y + 0.21 * h, x + 0.13 * h, y + 0.21 * h, l->nu,
              l->method, l->contact, -3 + 1.01 * h, -3 + 1.01 * h, 3 - 1.01 * h, -3 + 1.01 * h,
              strstr (l->method, "galerkin") ? "essential: penalty, " : "",
              strstr (l->method, "galerkin") ? "essential: penalty, " : "", l->solver);
    return prepare (l->threads ? l->threads : 1, text);
}

static const char *const fixed = "{kind: static, stepping: fixed, steps: 2}";

/* Mean pressure and shear of the inner pieces, slip in the middle. */
typedef struct { double pressure, shear, slip; } faces;
static faces faces_of (const run *r)
{
    size_t n;
    const pg_contact_values *v = pg_solver_contact (r->solver, &n);
    faces out = { 0 };
    assert_true (n > 4);
    for (size_t k = 2; k + 2 < n; k++) {
        out.pressure += v[k].pressure / (double) (n - 4), out.shear += v[k].shear[0] / (double) (n - 4);
        assert_true (v[k].gap > -1e-15);
    }
    out.slip = v[n / 2].slip[0];
    return out;
}

/* Rigid motions have no gap and no slip, unit jumps are told as such, forces balance, on irregular points
 * too, in the plane and in space. */
static void rows_know_what_a_jump_is (void **state)
{
    (void) state;
    const plate plates[] = {
        { 30, 0.25, 1.0 / 3, "stress", "{force: bond}", "{kind: normal}", fixed, 6, 1, 0 },
        { 50, 0.2, 0.2, "strain", "{force: gmpd}", "{kind: normal}", fixed, 6, 1, 0 },
        { 45, 0, 0.3, "stress", "{force: lps}", "{kind: normal}", fixed, 6, 1, 0 },
    };
    for (size_t i = 0; i < sizeof plates / sizeof *plates; i++) {
        run r = plate_of (&plates[i]);
        pg_contact_pieces pieces;
        pg_sparse G;
        const pg_force_type *force = pg_force_of (r.problem);
        void *self;
        double soft[200], stiffer;
        check_ok (force->create (&self, r.problem));
        check_ok (force->refresh (self, r.state, NULL));
        check_ok (pg_contact_pieces_create (&pieces, r.problem, r.state));
        assert_true (pieces.n > 4 && pieces.n < 90);
        check_ok (pg_contact_layer (&G, soft, &stiffer, &pieces, force, self, r.state));
        size_t n = r.problem->cloud.n, stride = G.nrow / n;
        const double *x = r.problem->cloud.x;
        double *d = calloc (G.nrow, sizeof *d), *g = calloc (G.ncol, sizeof *g);
        for (int motion = 0; motion < 5; motion++) {
            for (size_t k = 0; k < n; k++) {
                const double *p = x + 2*k, *m = pieces.piece[0].normal;
                int left = m[0] * (p[0] - pieces.x[0]) + m[1] * (p[1] - pieces.x[1]) > 0;
                const double u[5][2] = { { 1, 0 }, { 0, 1 }, { -p[1], p[0] }, { left * m[0], left * m[1] },
                                         { left * m[1], -left * m[0] } };
                d[stride * k] = u[motion][0], d[stride * k + 1] = u[motion][1];
            }
            pg_sparse_multiply_transposed (&G, d, g);
            for (size_t k = 0; k < pieces.n; k++) {
                check_scaled (g[2*k], motion == 3, 1e-12, 1);
                check_scaled (g[2*k + 1], motion == 4, 1e-12, 1);
            }
        }
        for (size_t k = 0; k < 2 * pieces.n; k++) assert_true (soft[k] > 0);
        print_message ("layer up to %.3f times as stiff as its bonds\n", stiffer);
        assert_true (stiffer >= 1 && stiffer < 2);
        free (d), free (g);
        pg_contact_pieces_clear (&pieces), pg_sparse_clear (&G), force->free (&self);
        clear (&r);
    }
}

/* A crack across the load is pressed together: what is stored is about what a whole body stores. */
static void pressed_crack_is_no_crack (void **state)
{
    (void) state;
    double stored[2];
    for (int k = 0; k < 2; k++) {
        run r = plate_of (&(plate){ 90, 0, 1.0 / 3, "stress", "{force: bond}", k ? "{kind: normal}"
                                    : "{kind: none}", fixed, 8, 1, !k });
        to_the_end (&r);
        stored[k] = pg_solver_report_now (r.solver)->energy.strain;
        if (k) check_relative (faces_of (&r).pressure, 1, 0.02);
        clear (&r);
    }
    print_message ("pressed: energy %.5f of the whole body\n", stored[1] / stored[0]);
    check_relative (stored[1], stored[0], 5e-3);
}

/* Linear systems, by factor and by iterations, and two ways of relaxation come to one equilibrium, friction
 * and its work included; threads do not show. */
static void all_ways_lead_to_one_equilibrium (void **state)
{
    (void) state;
    static const char *const ways[] = {
        "{kind: static, stepping: fixed, steps: 2, linear: cholmod}",
        "{kind: static, stepping: fixed, steps: 2}",
        "{kind: static, stepping: event}", "{kind: adr, stages: 2, imbalance: 1e-10}",
        "{kind: relax, stages: 2, imbalance: 1e-10}"
    };
    static const char *const forces[] = { "{force: bond}", "{force: lps}", "{force: gmpd}", "{force: fcbm}" };
    for (size_t f = 0; f < 4; f++) {
        faces first = { 0 };
        double friction = 0;
        for (size_t w = 0; w < 5; w++) {
            if ((f == 1 && w < 1) || (f > 1 && w == 4)) continue;    /* lps has no matrix */
            run r = plate_of (&(plate){ 45, 0.1 * (f == 0), f == 2 ? 0.2 : 1.0 / 3, "stress", forces[f],
                                        "{kind: friction, coefficient: 0.3}", ways[w], 5, 1, 0 });
            to_the_end (&r);
            faces now = faces_of (&r);
            const pg_statistics *s = pg_solver_report_now (r.solver);
            check_relative (fabs (now.shear), 0.3 * now.pressure, 1e-7);
            check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-7,
                          s->energy.external);
            if (first.pressure == 0) first = now, friction = s->energy.friction;
            check_relative (now.pressure, first.pressure, 1e-6);
            check_relative (now.slip, first.slip, 1e-6);
            check_relative (s->energy.friction, friction, 1e-6);
            assert_true (friction > 0);
            clear (&r);
        }
    }
}

/* A disc in space under compression that is inclined to it: both ways to one equilibrium, the faces slide,
 * and bear about the pressure of the uniform stress. */
static void discs_close_in_space (void **state)
{
    (void) state;
    faces of[2];
    memset (of, 0, sizeof of);
    for (int w = 0; w < 2; w++) {
        run r = scene_of (1 + w,
            "dimension: 3\nbody: [{add: {box: {low: [-2, -2, -2], high: [2, 2, 2]}}}]\n"
            "spacing: 0.3333333333\nlattice: cells\n"
            "cracks: [{disc: {center: [0.03, 0.02, 0.01], normal: [1, 1, 0], radius: 1}}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25, density: 1}}\n"
            "method: {force: bond}\n"
            "contact: {kind: friction, coefficient: 0.3}\nboundary:\n  - {set: top, traction: {y: -1}}\n"
            "  - {set: bottom, displacement: {x: 0, y: 0, z: 0}}\nsolver: %s\noutput: {at: {levels: 1}}\n",
            w ? "{kind: adr, stages: 1, imbalance: 1e-9}" : "{kind: static, stepping: fixed, steps: 1}");
        to_the_end (&r);
        size_t n;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        double area = 0;
        for (size_t k = 0; k < n; k++) {
            double t = sqrt (v[k].shear[0] * v[k].shear[0] + v[k].shear[1] * v[k].shear[1]
                             + v[k].shear[2] * v[k].shear[2]);
            area += v[k].area, of[w].pressure += v[k].area * v[k].pressure;
            check_relative (t, 0.3 * v[k].pressure, 1e-6);
            of[w].slip = fmax (of[w].slip, sqrt (v[k].slip[0] * v[k].slip[0] + v[k].slip[1] * v[k].slip[1]));
        }
        of[w].pressure /= area;
        clear (&r);
    }
    print_message ("disc: pressure %.4f, slip %.5g\n", of[0].pressure / 0.5, of[0].slip);
    check_relative (of[0].pressure, 0.5, 0.15);
    check_relative (of[1].pressure, of[0].pressure, 1e-6);
    check_relative (of[1].slip, of[0].slip, 1e-6);
}

/* Pressure and slip of shape functions, the slip at the same effective length: bonds cut along a line act as
 * a crack that is longer by about half a horizon at either end. At 60 degrees and friction .6 it sticks. */
static void slips_as_with_shape_functions (void **state)
{
    (void) state;
    static const struct { double beta, mu; } row[] = { { 45, 0 }, { 60, 0.3 }, { 60, 0.6 }, { 30, 0 },
                                                       { 30, 0.3 }, { 45, 0.3 } };
    double free_slip = 0;
    int n = 10;
    for (size_t i = 0; i < (longer () ? sizeof row / sizeof *row : 3); i++) {
        faces of[2];
        char contact[64] = "{kind: normal}";
        double b = row[i].beta * 3.14159265358979323846 / 180;
        if (row[i].mu > 0) snprintf (contact, sizeof contact, "{kind: friction, coefficient: %g}", row[i].mu);
        for (int k = i == 2; k < 2; k++) {
            run r = plate_of (&(plate){ row[i].beta, 0, 1.0 / 3, "stress", k ? "{force: bond}"
                                        : "{force: galerkin}", contact, fixed, n, 1, 0 });
            to_the_end (&r);
            of[k] = faces_of (&r);
            clear (&r);
        }
        check_relative (of[1].pressure, pow (sin (b), 2), 0.03);
        if (i == 0) free_slip = of[1].slip;
        if (i == 2) {
            assert_true (fabs (of[1].slip) < 0.02 * fabs (free_slip));
            continue;
        }
        double ratio = of[1].slip / of[0].slip, same = ratio / (1 + 1.5 / n);
        print_message ("%g degrees, friction %g: pressure %.4f and %.4f of the uniform one, slip %.4f of "
                       "that of shape functions, %.4f at the same length\n", row[i].beta, row[i].mu,
                       of[0].pressure / pow (sin (b), 2), of[1].pressure / pow (sin (b), 2), ratio, same);
        check_relative (same, 1, 0.05);
    }
}

/* A plate that nothing holds, squeezed by pulses: the faces close and slide, and forces and moments between
 * them cancel. What loads do is stored, in motion, or taken by friction. */
static void motion_keeps_its_momenta (void **state)
{
    (void) state;
    static const char *const kinds[] = { "verlet", "central" };
    double sums[2][3];
    for (int k = 0; k < 2; k++) {
        run r = scene_of (k + 1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
            "spacing: 0.2\nlattice: cells\ncracks: [{from: [-0.7, -0.81], to: [0.9, 0.71]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333, density: 1}}\n"
            "method: {force: bond}\ncontact: {kind: friction, coefficient: 0.2}\nboundary:\n"
            "  - {set: top, traction: {y: \"-100*sin(40*t)\"}}\n"
            "  - {set: bottom, traction: {y: \"100*sin(40*t)\"}}\n"
            "solver: {kind: %s, end: 0.4, dt: 1e-3}\noutput: {at: {levels: 1, rows: 20}}\n", kinds[k]);
        double before = 0, slipped = 0;
        while (!pg_solver_done (r.solver, r.state)) {
            advance (&r);
            const pg_statistics *s = pg_solver_report_now (r.solver);
            assert_true (s->energy.friction >= before * (1 - 1e-12));
            before = s->energy.friction;
            check_scaled (s->energy.external - s->energy.strain - s->energy.kinetic - s->energy.friction, 0,
                          2e-3, s->energy.external);
            slipped += s->contact.sliding > 0;
        }
        double p[2] = { 0, 0 }, L = 0, size = 0, moment = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            const double *x = r.problem->cloud.x + 2*i, *v = r.state->v + 2*i;
            p[0] += v[0], p[1] += v[1], L += x[0] * v[1] - x[1] * v[0];
            size += hypot (v[0], v[1]), moment += hypot (x[0], x[1]) * hypot (v[0], v[1]);
        }
        check_scaled (p[0], 0, 1e-12, size);
        check_scaled (p[1], 0, 1e-12, size);
        check_scaled (L, 0, 1e-12, moment);
        assert_true (slipped >= 3 && before > 0);
        const pg_statistics *s = pg_solver_report_now (r.solver);
        sums[k][0] = s->energy.strain, sums[k][1] = s->energy.friction, sums[k][2] = s->energy.external;
        clear (&r);
    }
    for (int i = 0; i < 3; i++) check_relative (sums[1][i], sums[0][i], 1e-9);
}

/* Read back in the middle, by one thread or two, a run goes on to the last bit: slips and the work of
 * friction go on from where they were. */
static void runs_go_on_bit_by_bit (void **state)
{
    (void) state;
    static const char *const ways[] = { "{kind: verlet, end: 0.4}", "{kind: central, end: 0.4}",
                                        "{kind: adr, stages: 20, hold: on}", "{kind: relax, stages: 20}",
                                        "{kind: static, stepping: fixed, steps: 20}" };
    for (size_t w = 0; w < sizeof ways / sizeof *ways; w++) {
        char text[2000];
        run r[2];
        tape t = { 0 };
        snprintf (text, sizeof text,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [-2, -2], high: [2, 2]}}}]\n"
            "spacing: 0.25\nlattice: cells\ncracks: [{from: [-0.7, -0.81], to: [0.9, 0.71]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.3333333333333333, density: 1}}\n"
            "method: {force: bond}\ncontact: {kind: friction, coefficient: 0.2, cohesion: 0.1}\nboundary:\n"
            "  - {set: top, traction: {y: \"-20*sin(%s*t)\"}}\n"
            "  - {set: bottom, displacement: {x: 0, y: 0}}\n"
            "solver: %s\noutput: {at: {levels: 1%s}}\n", w < 2 ? "15" : "5", ways[w],
            w < 2 ? ", rows: 20" : "");
        for (int k = 0; k < 2; k++) r[k] = prepare (k + 1, text);
        for (int k = 0; k < 9; k++) advance (&r[0]);
        assert_true (pg_solver_report_now (r[0].solver)->energy.friction > 0);
        keep (&r[0], &t, 0);
        keep (&r[1], &t, 1);
        while (!pg_solver_done (r[0].solver, r[0].state)) {
            advance_alike (&r[0], &r[1]);
            const pg_statistics *a = pg_solver_report_now (r[0].solver),
                                *b = pg_solver_report_now (r[1].solver);
            assert_true (a->energy.friction == b->energy.friction && a->energy.strain == b->energy.strain
                         && a->contact.sliding == b->contact.sliding);
        }
        assert_true (pg_solver_done (r[1].solver, r[1].state));
        pg_free (t.byte);
        clear (&r[0]), clear (&r[1]);
    }
}

/* The upper half of a block that is cut through rests on the lower one: the faces bear what presses it, and
 * nothing holds it but them; points with rotations of their own turn with it. */
static void parts_are_held_by_contact_alone (void **state)
{
    (void) state;
    static const char *const forces[] = { "bond", "gmpd" };
    for (int dim = 2; dim <= 3; dim++)
        for (size_t k = 0; k < 2; k++) {
            run r = scene_of (1, "dimension: %d\nbody: [{add: {box: {low: [0, 0%s], high: [1, 1%s]}}}]\n"
                                 "spacing: 0.2\ncracks: [{%s}]\n"
                                 "contact: {kind: friction, coefficient: 0.5}\n"
                                 "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.2}}\n"
                                 "method: {force: %s, accept_inexact: yes}\nboundary:\n"
                                 "  - {set: bottom, displacement: {x: 0, y: 0%s}}\n"
                                 "  - {set: top, traction: {x: 0.2, y: -1}}\n"
                                 "output: {at: {levels: 1}}\n", dim,
                              dim == 3 ? ", 0" : "", dim == 3 ? ", 1" : "",
                              dim == 2 ? "from: [-1, 0.5], to: [2, 0.5]"
                                       : "polygon: [[-1, 0.5, -1], [2, 0.5, -1], [2, 0.5, 2], [-1, 0.5, 2]]",
                              forces[k], dim == 3 ? ", z: 0" : "");
            size_t n;
            double pressed = 0, rubbed = 0;
            to_the_end (&r);
            const pg_contact_values *v = pg_solver_contact (r.solver, &n);
            for (size_t i = 0; i < n; i++)
                pressed += v[i].pressure * v[i].area, rubbed += v[i].shear[0] * v[i].area;
            check_relative (pressed, 1, 1e-7);
            check_relative (fabs (rubbed), 0.2, 1e-7);
            clear (&r);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (rows_know_what_a_jump_is),
        cmocka_unit_test (pressed_crack_is_no_crack),
        cmocka_unit_test (all_ways_lead_to_one_equilibrium),
        cmocka_unit_test (slips_as_with_shape_functions),
        cmocka_unit_test (motion_keeps_its_momenta),
        cmocka_unit_test (runs_go_on_bit_by_bit),
        cmocka_unit_test (discs_close_in_space),
        cmocka_unit_test (parts_are_held_by_contact_alone),
    };
    return cmocka_run_group_tests_name ("contact/bond_faces", tests, NULL, NULL);
}
