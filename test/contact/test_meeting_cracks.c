/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks that meet: pieces of contact end there, on both faces that are met, and are half as long beside it,
 * so that what lies between the cracks, and turns by itself, does not overlap. */
#include "scene_runs/run.h"

/* A plate under pressure with a crack at 45 degrees, and what else there is. */
static run plate (const char *others)
{
    return scene_of (1,
                     "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [-12, -12], high: [12, "
                     "12]}}}]\nspacing: 1\n"
                     "lattice: cells\nlattice_offset: [0.13, 0.29]\nmaterials: {m: {youngs_modulus: 100, "
                     "poissons_ratio: "
                     "0.25}}\ncracks: [{from: [-6, -6], to: [6, 6]}%s]\ncontact: {kind: normal}\n"
                     "boundary:\n  - {set: bottom, displacement: {y: 0}}\n  - {set: top, displacement: {y: "
                     "-0.1}}\n"
                     "  - {set: left, displacement: {x: 0}}\nsolver: {kind: static, stepping: fixed, steps: "
                     "1}\n", others);
}

/* The pieces whose points lie on both sides of a place along the line x = y; *least: the length of the
 * shortest piece there. */
static size_t across (const pg_contact_pieces *k, double at, double *shortest)
{
    size_t found = 0;
    *shortest = INFINITY;
    for (size_t i = 0; i < k->n; i++) {
        double low = INFINITY, high = -INFINITY;
        int on = 1;
        for (size_t q = k->first[i]; q < k->first[i + 1]; q++) {
            on &= fabs (k->x[2 * q] - k->x[2 * q + 1]) < 1e-9;
            low = fmin (low, k->x[2 * q]), high = fmax (high, k->x[2 * q]);
        }
        if (!on) continue;
        found += low < at - 0.2 && high > at + 0.2;
        if (fabs (low - at) < 0.2 || fabs (high - at) < 0.2) *shortest = fmin (*shortest, k->piece[i].length);
    }
    return found;
}

static void pieces_end_where_cracks_meet (void **state)
{
    (void) state;
    /* none; one that ends on it, from either side; one that crosses it */
    const char *others[4] = { "", ", {from: [9, -7], to: [0.8, 0.8]}", ", {from: [0.8, 0.8], to: [-6, 8]}",
                              ", {from: [9, -7], to: [-7.4, 8.6]}" };
    for (int c = 0; c < 4; c++) {
        run r = plate (others[c]);
        pg_contact_pieces k;
        double shortest, whole = 0;
        check_ok (pg_contact_pieces_create (&k, r.problem, r.state));
        size_t n = across (&k, 0.8, &shortest);
        for (size_t i = 0; i < k.n; i++)
            whole += fabs (k.piece[i].x[0] - k.piece[i].x[1]) < 1e-9 ? k.piece[i].length : 0;
        if (c == 0) assert_int_equal (n, 1);
        else {
            assert_int_equal (n, 0);
            assert_true (shortest > 0.4 && shortest < 1.3);
        }
        check_absolute (whole, sqrt (2) * 12, 2);
        pg_contact_pieces_clear (&k);
        clear (&r);
    }
}

/* The wedge between two cracks that meet turns; its corner does not go into the other face. */
static void corners_do_not_overlap (void **state)
{
    (void) state;
    run r = plate (", {from: [9, -7], to: [0.8, 0.8]}");
    advance (&r);
    const pg_statistics *s = pg_solver_report (r.solver, r.state);
    double most = 0;
    for (size_t i = 0; i < r.state->ndof; i++) most = fmax (most, fabs (r.state->d[i]));
    print_message ("overlap %.2e of the largest displacement\n", s->contact.overlap_max / most);
    check_below (s->contact.overlap_max, 0.03 * most);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (pieces_end_where_cracks_meet),
        cmocka_unit_test (corners_do_not_overlap),
    };
    return cmocka_run_group_tests_name ("contact/meeting_cracks", tests, NULL, NULL);
}
