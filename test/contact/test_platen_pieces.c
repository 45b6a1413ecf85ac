/* SPDX-License-Identifier: GPL-3.0-or-later
 * The surface opposite a platen in pieces: along concave platens, with faces below others, and friction in
 * space whatever the directions along the platen are. */
#include "scene_runs/run.h"
#include "platens.h"
#include "perigal/contact.h"

#define STATIC "solver: {kind: static, stepping: fixed, steps: 1}\n"

/* A disk between jaws of one and a half times its radius: the middle of each piece lies on the platen where
 * its arc says, and all pieces are about two spacings long. */
static void arcs_of_a_concave_jaw (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 2\nthickness: 1\nbody: [{add: {disk: {center: [0, 0], radius: "
                      "1}}}]\nspacing: 0.1\n"
                         "lattice: cells\ncells: cut\nmaterials: {m: {youngs_modulus: 1000, "
                             "poissons_ratio: 0.25}}\n"
                         "platens: [{name: foot, friction: 0.2, shape: cylinder, concave: true, radius: "
                             "1.5, point: [0, "
                         "0.5]}, {name: head, friction: 0.2, shape: cylinder, concave: true, radius: "
                             "1.5, point: [0, "
                         "-0.5], force: {y: -20}}]\n" STATIC);
    for (size_t jaw = 0; jaw < 2; jaw++) {
        pg_contact_pieces w;
        double *gap, middle = jaw ? -0.5 : 0.5, away = 0;
        check_ok (pg_platen_pieces_create (&w, &gap, r.problem, jaw));
        assert_true (w.n > 6);
        for (size_t k = 0; k < w.n; k++) {
            const pg_contact_piece *p = &w.piece[k];
            double angle = atan2 (p->x[0], jaw ? p->x[1] - middle : middle - p->x[1]);
            away = fmax (away, fabs (angle));
            check_scaled (fabs (p->arc), 1.5 * fabs (angle), 0.02, 1);
            assert_true (fabs (angle) < 0.05 || p->arc * angle * w.piece[w.n - 1].arc * w.piece[w.n
                - 1].x[0] > 0);
            assert_true (p->length > 0.13 && p->length < 0.27);
            if (k) assert_true (w.piece[k].arc > w.piece[k - 1].arc);
        }
        assert_true (away > 0.3);
        pg_contact_pieces_clear (&w), pg_free (gap);
    }
    clear (&r);
}

/* The same of a ball in a bowl: no piece, nor one that small boxes have joined, reaches further than four
 * spacings from its middle. */
static void pieces_in_a_bowl (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: "
                      "1}}}]\nspacing: 0.25\n"
                         "lattice: cells\ncells: cut\nmaterials: {m: {youngs_modulus: 1000, "
                             "poissons_ratio: 0.25}}\n"
                         "platens: [{name: foot, friction: 0.2, shape: sphere, concave: true, radius: "
                             "1.5, point: [0, 0, "
                         "0.5]}, {name: head, friction: 0.2, point: [0, 0, 1], normal: [0, 0, -1], "
                             "force: {z: -20}}]\n" STATIC);
    pg_contact_pieces w;
    double *gap;
    check_ok (pg_platen_pieces_create (&w, &gap, r.problem, 0));
    assert_true (w.n > 6);
    for (size_t k = 0; k < w.n; k++)
        for (size_t i = w.first[k]; i < w.first[k + 1]; i++) {
            double away = 0;
            for (size_t c = 0; c < 3; c++) away = hypot (away, w.x[3*i + c] - w.piece[k].x[c]);
            check_below (away / 0.25, 4);
        }
    pg_contact_pieces_clear (&w), pg_free (gap);
    clear (&r);
}

/* The floor of a hole faces the platen above as the top of the body does, which hides it. */
static void the_floor_of_a_hole_has_no_pieces (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        run r = scene_of (1, "dimension: %d\n%sbody: [{add: {box: {low: [0, 0%s], high: [2, 1%s]}}}, "
                          "{subtract: {box: {low: "
                             "[0.5, %s], high: [1.5, %s]}}}]\nspacing: 0.125\nlattice: cells\n"
                             "materials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
                             "boundary: [{set: %s, displacement: {x: 0, y: 0%s}}]\n"
                             "platens: [{name: head, point: [1, %s], normal: [0, %s], displacement: {%s: "
                                 "-0.01}}]\n" STATIC,
                          dim, dim == 2 ? "thickness: 1\n" : "", dim == 2 ? "" : ", 0", dim == 2 ? "" : ", 1",
                          dim == 2 ? "0.25" : "0.25, 0.25", dim == 2 ? "0.625" : "0.75, 0.625", dim == 2 ?
                              "bottom" : "back",
                          dim == 2 ? "" : ", z: 0", dim == 2 ? "1" : "0.5, 1", dim == 2 ? "-1" : "0, -1",
                          dim == 2 ? "y" : "z");
        pg_contact_pieces w;
        double *gap, area = 0;
        size_t up = (size_t) dim - 1;
        check_ok (pg_platen_pieces_create (&w, &gap, r.problem, 0));
        for (size_t k = 0; k < w.n; k++) area += w.piece[k].area, check_scaled (w.piece[k].x[up], 1, 1e-9, 1);
        check_relative (area, 2, 1e-9);
        pg_contact_pieces_clear (&w), pg_free (gap);
        clear (&r);
    }
}

/* A rough ball is pressed into a block and dragged at an angle to all axes: every piece bears a shear in its
 * own plane, within the cone, against the way it slides. */
static void a_ball_is_dragged_off_the_axes (void **state)
{
    (void) state;
    run r = scene_of (1, "dimension: 3\nbody: [{add: {box: {low: [-1.25, -1.25, -1], high: [1.25, 1.25, "
                      "0]}}}]\nspacing: 0.25\n"
                         "lattice: cells\nmaterials: {m: {youngs_modulus: 1000, poissons_ratio: 0.25}}\n"
                         "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}]\n"
                         "platens: [{name: ball, shape: sphere, point: [0.05, 0.1, 1.3], radius: 1.3, "
                             "friction: 0.15, force: {z: "
                         "-60}, force_ramp: constant, displacement: {x: 0.02, y: 0.05}}]\n"
                         "solver: {kind: static, stepping: fixed, steps: 4}\noutput: {at: {levels: 1}}\n");
    to_the_end (&r);
    size_t n, slides = 0;
    const pg_contact_values *v = pg_solver_contact (r.solver, &n);
    double push[3] = { 0 }, oblique = 0;
    for (size_t k = 0; k < n; k++) {
        double across = 0, shear = 0, slip = 0, gone = 0;
        for (int c = 0; c < 3; c++) {
            across += v[k].shear[c] * v[k].normal[c], gone += v[k].slip[c] * v[k].normal[c];
            shear += v[k].shear[c] * v[k].shear[c], slip += v[k].slip[c] * v[k].slip[c];
            push[c] += v[k].area * (v[k].shear[c] + v[k].pressure * v[k].normal[c]);
        }
        shear = sqrt (shear), slip = sqrt (slip);
        if (!(v[k].pressure > 0)) continue;
        oblique = fmax (oblique, hypot (v[k].normal[0], v[k].normal[1]));
        check_scaled (across, 0, 1e-9, v[k].pressure), check_scaled (gone, 0, 1e-9, slip);
        assert_true (shear <= 0.15 * v[k].pressure * (1 + 1e-6));
        if (v[k].status != PG_CONTACT_SLIDING) continue;
        slides++;
        check_relative (shear, 0.15 * v[k].pressure, 1e-6);
    }
    const pg_platen_values *ball = platen_of (&r, 0);
    print_message ("pieces %zu sliding %zu, normals up to %.2f off the axis; force %g %g %g, pushed %g "
                   "%g %g\n", n, slides, oblique,
                   ball->force[0], ball->force[1], ball->force[2], push[0], push[1], push[2]);
    assert_true (slides > 1 && oblique > 0.2);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (arcs_of_a_concave_jaw),
                                        cmocka_unit_test (pieces_in_a_bowl),
                                        cmocka_unit_test (the_floor_of_a_hole_has_no_pieces),
                                        cmocka_unit_test (a_ball_is_dragged_off_the_axes) };
    return cmocka_run_group_tests_name ("contact/platen_pieces", tests, NULL, NULL);
}
