/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gaps of crack faces beside another crack, a slot cut by a polygon, and a gap between parts of the body, a
 * row of nodes or less away: places that see too little get wider supports, never across what parts them. */
#include "scene_runs/run.h"
#include <math.h>

/* Places on the crack y = 0 between x = -3 and 3, spacing 1; the other barrier lies at y = `far` from x = a
 * to b at least (tips are drawn back among the points, and a way may cut the corner at the end of a gap). */
typedef struct { const char *name, *body, *cracks; double far, a, b; } beside;

static const beside cases[] = {
    { "crack", "", ", {from: [-3.2, 1.3], to: [3.2, 1.3]}", 1.3, -2.6, 2.6 },
    { "slot", "", ", {polygon: [[-3.2, 1.3], [3.2, 1.3], [3.2, 1.4], [-3.2, 1.4]]}", 1.3, -3.2, 3.2 },
    { "gap", ", {subtract: {box: {low: [-3.2, 1.3], high: [3.2, 1.4]}}}", "", 1.3, -2.6, 2.6 },
};

enum { PLACES = 24 };

/* Does the way from (x, y) to node j pass through the piece of the line y = at between a and b? */
static int passes (double x, double y, const double *to, double at, double a, double b)
{
    if ((y - at) * (to[1] - at) >= 0) return 0;
    double s = (at - y) / (to[1] - y), through = x + s * (to[0] - x);
    return through > a && through < b;
}

static void gaps_see_enough_and_never_across (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const beside *c = &cases[k];
        run r = scene_of (1,
                          "dimension: 2\nplane: strain\nthickness: 1\nbody: [{add: {box: {low: [-12, -10], "
                          "high: [12, 10]}}}%s]\nspacing: 1\nlattice: cells\nlattice_offset: [0.2, 0.3]\n"
                          "cracks: [{from: [-3, 0], to: [3, 0]}%s]\n"
                          "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.25}}\n"
                          "boundary: [{set: bottom, displacement: {x: 0, y: 0}},\n"
                          "  {set: top, displacement: {x: 0, y: 0.1}}]\n"
                          "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
                          c->body, c->cracks);
        double x[2 * PLACES], normal[2 * PLACES];
        void *self;
        pg_jump_rows rows;
        build (&r, 1);
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        for (int i = 0; i < PLACES; i++)
            x[2*i] = -2.4 + 0.2 * i, x[2*i + 1] = 0, normal[2*i] = 0, normal[2*i + 1] = 1;
        check_ok (force->surfaces.jump (self, r.state, PLACES, x, normal, 2.5, &rows));
        double worst = 0;
        size_t across = 0;
        for (size_t q = 0; q < PLACES; q++) {
            double jump = 0, one = 0;
            for (size_t e = rows.start[q]; e < rows.start[q + 1]; e++) {
                const double *to = r.problem->cloud.x + 2 * (size_t) rows.node[e];
                if (rows.value[e] == 0) continue;
                jump += rows.value[e] * (0.3 * to[0] - 0.7 * to[1] + 2), one += fabs (rows.value[e]);
                double side = to[1] > 0 ? 1e-3 : -1e-3;
                /* round the end of the crack a node is seen from the other side as well */
                across += passes (x[2*q], side, to, c->far, c->a, c->b)
                          && passes (x[2*q], -side, to, c->far, c->a, c->b);
            }
            worst = fmax (worst, fabs (jump));
        }
        print_message ("  %s: %zu of %d places see too little; a linear field jumps by %.1e, nodes seen "
                       "across: %zu\n", c->name, rows.poor, PLACES, worst, across);
        assert_int_equal (across, 0);
        assert_int_equal (rows.poor, 0);
        check_below (worst, 1e-12);
        pg_jump_rows_clear (&rows);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (gaps_see_enough_and_never_across) };
    return cmocka_run_group_tests_name ("mechanics/force/one_sided", tests, NULL, NULL);
}
