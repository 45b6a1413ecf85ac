/* SPDX-License-Identifier: GPL-3.0-or-later
 * Blocks that a crack has cut apart and only contact holds: a body cut in two and pressed, a block that
 * slides on an inclined cut, a wedge. Forces of sliding blocks follow from statics alone. */
#include "scene_runs/run.h"
#include "platens.h"

/* A column in two parts between platens, held by nothing else, bears what the uncut one bears, as well as its
 * integration beside the cut can. */
static void a_cut_column_is_pressed_like_the_whole_one (void **state)
{
    (void) state;
    double force[2], worst = 0;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
            "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 2]}}}]\n"
            "spacing: 0.1\nlattice: cells\n%smaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "contact: {kind: friction, coefficient: 0.5}\n"
            "platens:\n  - {name: base, point: [0.5, 0], normal: [0, 1], friction: 0.3}\n"
            "  - {name: head, point: [0.5, 2], normal: [0, -1], displacement: {y: -0.02}}\n"
            "solver: {kind: static, stepping: event}\noutput: {at: {levels: 1}}\n",
            k ? "cracks: [{from: [-0.2, 1], to: [1.2, 1]}]\n" : "");
        to_the_end (&r);
        size_t n;
        const pg_contact_values *v = pg_solver_contact (r.solver, &n);
        for (size_t i = 0; i < n; i++) if (!v[i].platen) worst = fmax (worst, fabs (v[i].pressure / 10 - 1));
        force[k] = platen_of (&r, 1)->force[1];
        check_scaled (platen_of (&r, 0)->force[1], -force[k], 1e-11, 10);
        clear (&r);
    }
    print_message ("column cut in two, Gauss integration: force %.5f of the uncut one, worst pressure %.4f "
                   "off\n", force[1] / force[0], worst);
    check_relative (force[1], force[0], 5e-3);
    assert_true (worst < 0.05);
}

/* Press upon a block on a cut at the angle b, friction tan (f), and push it aside: up the cut it takes the
 * force tan (b + f) times the press, and tan (b - f) holds it on its way down. */
static void a_block_slides_on_an_inclined_cut (void **state)
{
    (void) state;
    for (int k = 0; k < 4; k++) {
        const double friction = k & 1 ? 0.3 : 0, rise = 0.5, unit = k == 3 ? 1e-3 : 1;
        int up = k < 2;
        run r = scene_of (1,
            "dimension: 2\nplane: strain\nthickness: 1\n"
            "body: [{add: {box: {low: [0, 0], high: [%.17g, %.17g]}}}]\nspacing: %.17g\nlattice: cells\n"
            "cracks: [{from: [%.17g, %.17g], to: [%.17g, %.17g]}]\n"
            "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
            "contact: {kind: %s%s}\n"
            "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
            "platens:\n  - {name: head, point: [%.17g, %.17g], normal: [0, -1], force: {y: %.17g}}\n"
            "  - {name: side, point: [%.17g, %.17g], normal: [%d, 0], width: %.17g, "
            "displacement: {x: %.17g}}\n"
            "solver: {kind: static, stepping: fixed, steps: 1}\noutput: {at: {levels: 1}}\n",
            unit, 2 * unit, 0.1 * unit, -0.1 * unit, 0.75 * unit, 1.1 * unit, (0.75 + 1.2 * rise) * unit,
            friction > 0 ? "friction" : "normal", friction > 0 ? ", coefficient: 0.3" : "", 0.5 * unit,
            2 * unit, -2 * unit, 0.0, 1.65 * unit, 1, 0.5 * unit, (up ? 0.1 : -0.01) * unit);
        to_the_end (&r);
        double angle = atan (rise) + (up ? 1 : -1) * atan (friction), press = 2 * unit;
        print_message ("sliding block, friction %g, %s: force %.12f of statics\n", friction,
                       up ? "up" : "down", platen_of (&r, 1)->force[0] / (press * tan (angle)));
        check_relative (platen_of (&r, 0)->force[1], -press, 1e-10);
        check_relative (platen_of (&r, 1)->force[0], press * tan (angle), 1e-8);
        clear (&r);
    }
}

/* A wedge of half the angle a driven between two blocks that side platens hold: press over side force is
 * 2 tan (a + f); it is the same on points that lie irregularly, and the wedge stays in the middle. */
static void a_wedge_drives_blocks_apart (void **state)
{
    (void) state;
    run r = scene_of (1,
        "dimension: 2\nplane: stress\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [3, 1]}}}]\n"
        "spacing: 0.1\nlattice: cells\nperturb: {amount: 0.15}\n"
        "cracks: [{from: [0.975, 1.1], to: [1.275, -0.1]}, {from: [2.025, 1.1], to: [1.725, -0.1]}]\n"
        "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
        "contact: {kind: friction, coefficient: 0.2}\n"
        "platens:\n  - {name: left, point: [0, 0.5], normal: [1, 0]}\n"
        "  - {name: right, point: [3, 0.5], normal: [-1, 0]}\n"
        "  - {name: base_l, point: [0.5, 0], normal: [0, 1], width: 1}\n"
        "  - {name: base_r, point: [2.5, 0], normal: [0, 1], width: 1}\n"
        "  - {name: head, point: [1.5, 1], normal: [0, -1], width: 0.9, displacement: {y: -0.05}}\n"
        "solver: {kind: static, stepping: fixed, steps: 2}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    double press = -platen_of (&r, 4)->force[1], side = platen_of (&r, 0)->force[0],
           theory = 2 * tan (atan (0.25) + atan (0.2));
    print_message ("wedge: press over side force %.12f of statics\n", press / side / theory);
    check_relative (press / side, theory, 1e-8);
    check_relative (platen_of (&r, 1)->force[0], -side, 1e-9);
    check_relative (platen_of (&r, 2)->force[1] + platen_of (&r, 3)->force[1], press, 1e-9);
    const pg_statistics *s = pg_solver_report_now (r.solver);
    check_scaled (s->energy.external - s->energy.strain - s->energy.friction, 0, 1e-6, s->energy.external);
    assert_true (s->energy.friction > 0.1 * s->energy.external && s->contact.overlap < 1e-12);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_cut_column_is_pressed_like_the_whole_one),
        cmocka_unit_test (a_block_slides_on_an_inclined_cut),
        cmocka_unit_test (a_wedge_drives_blocks_apart),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
