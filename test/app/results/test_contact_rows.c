/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.csv: in which direction pieces slide, and which way what they bear acts, against the motions and
 * forces of platens in history.csv. */
#include "folder.h"

static char where[64], *history, *pieces;

static void play (const char *scene)
{
    run r = scene_of (1, "%s", scene);
    pg_result *result = NULL;
    make_folder (where);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    while (!pg_solver_done (r.solver, r.state)) {
        advance (&r);
        check_ok (pg_result_step (result, r.state, &r.step));
    }
    check_ok (pg_result_finish (result, r.state, NULL, 0, 0));
    history = slurp (inside (where, "history.csv")), pieces = slurp (inside (where, "contact.csv"));
    pg_result_free (&result);
    clear (&r);
}

static void tidy (void)
{
    pg_free (history), pg_free (pieces);
    remove_folder (where);
}

/* Sum over the pieces of platen `platen` at a step of a column times the area, and the least and largest
 * value. */
typedef struct { double sum, least, most; } column;
static column of_pieces (double step, int platen, const char *name, const char *area, double thickness)
{
    column out = { 0, INFINITY, -INFINITY };
    for (size_t row = 1; row < count_lines (pieces); row++) {
        if (number_at (pieces, row, "step [1]") != step || number_at (pieces, row, "platen_code [1]") !=
            platen) continue;
        double v = number_at (pieces, row, name);
        out.sum += v * number_at (pieces, row, area) * thickness;
        out.least = fmin (out.least, v), out.most = fmax (out.most, v);
    }
    assert_true (out.most >= out.least);
    return out;
}

#define HELD(low, high, more) \
    "body: [{add: {box: {low: " low ", high: " high "}}}]\nspacing: 0.25\nlattice: cells\n" \
    "method: {integration: consistent}\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n" \
    "solver: {kind: static, stepping: fixed, steps: 2}\n" \
    "output: {pictures: [], estimate: off, at: {levels: 2}}\n" more

/* The platen on top is pushed down and dragged towards +x: it pushes the body along, and the body stays
 * behind. */
static void shear_and_slip_in_the_plane (void **state)
{
    (void) state;
    play ("dimension: 2\nplane: stress\nthickness: 0.5\n" HELD ("[0, 0]", "[2, 1]",
          "boundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n"
          "platens: [{name: head, point: [1, 1], normal: [0, -1], friction: 0.2, force: {y: -10}, "
              "force_ramp: constant, "
          "displacement: {x: 0.1}}]\n"));
    double force = number_at (history, 2, "head.force_x [N]");
    column shear = of_pieces (2, 1, "shear [Pa]", "length [m]", 0.5), slip = of_pieces (2, 1, "slip [m]",
        "length [m]", 0.5),
           pressure = of_pieces (2, 1, "pressure [Pa]", "length [m]", 0.5);
    /* the direction along a platen is its normal (0, -1) turned clockwise: -x */
    check_relative (force, 2, 1e-6);
    check_relative (number_at (history, 2, "head.force_y [N]"), -10, 1e-9);
    check_relative (pressure.sum, 10, 1e-9);
    check_relative (-shear.sum, force, 1e-9);
    assert_true (slip.least > 0.08 && slip.most < 0.1);
    tidy ();
}

/* The same in space, along y and z: a block whose side the platen presses. */
static void shear_and_slip_in_space (void **state)
{
    (void) state;
    play ("dimension: 3\n" HELD ("[0, 0, 0]", "[0.5, 1, 1]",
          "boundary: [{set: left, displacement: {x: 0, y: 0, z: 0}}]\n"
          "platens: [{name: head, point: [0.5, 0.5, 0.5], normal: [-1, 0, 0], friction: 0.2, force: {x: "
              "-10}, force_ramp: "
          "constant, displacement: {y: 0.05, z: 0.1}}]\n"));
    static const char *const name[] = { "head.force_x [N]", "head.force_y [N]", "head.force_z [N]" };
    static const char *const shears[] = { "shear.x [Pa]", "shear.y [Pa]", "shear.z [Pa]" };
    double want[3] = { 0, 2 * 0.05 / hypot (0.05, 0.1), 2 * 0.1 / hypot (0.05, 0.1) };
    for (int k = 0; k < 3; k++) {
        column shear = of_pieces (2, 1, shears[k], "area [m2]", 1);
        check_scaled (shear.sum, want[k], 0.02, 2);
        if (k) check_relative (shear.sum, number_at (history, 2, name[k]), 1e-6);
    }
    column y = of_pieces (2, 1, "slip.y [m]", "area [m2]", 1), z = of_pieces (2, 1, "slip.z [m]", "area "
        "[m2]", 1),
           x = of_pieces (2, 1, "slip.x [m]", "area [m2]", 1);
    print_message ("slip y %g .. %g z %g .. %g\n", y.least, y.most, z.least, z.most);
    check_scaled (x.most - x.least, 0, 1e-12, 0.1);
    assert_true (y.most < -0.03 && y.least > -0.05 && z.most < -0.07 && z.least > -0.1);
    tidy ();
}

/* A closed crack from left to right, pressed, the upper part pulled towards +x: its left (upper) face goes
 * ahead, and the lower one holds it back; cut whole, so that friction is all that does. */
static void shear_and_slip_of_a_crack (void **state)
{
    (void) state;
    play ("dimension: 2\nplane: stress\nthickness: 0.5\ncracks: [{from: [-1, 0.5], to: [3, 0.5]}]\n"
          "contact: {kind: friction, coefficient: 0.2}\n" HELD ("[0, 0]", "[2, 1]",
          "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {name: head, set: top, displacement: "
              "{x: 0.1, y: -0.02}}]\n"));
    double force = number_at (history, 2, "head.force_x [N]"), press = number_at (history, 2,
        "head.force_y [N]");
    column shear = of_pieces (2, 0, "shear [Pa]", "length [m]", 0.5), slip = of_pieces (2, 0, "slip [m]",
        "length [m]", 0.5),
           pressure = of_pieces (2, 0, "pressure [Pa]", "length [m]", 0.5);
    assert_true (force > 0 && press < 0 && slip.least > 0.05);
    check_relative (pressure.sum, -press, 1e-6);
    check_relative (-shear.sum, force, 1e-6);
    tidy ();
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (shear_and_slip_in_the_plane),
                                        cmocka_unit_test (shear_and_slip_in_space),
                                        cmocka_unit_test (shear_and_slip_of_a_crack) };
    return cmocka_run_group_tests_name ("app/results/contact_rows", tests, NULL, NULL);
}
