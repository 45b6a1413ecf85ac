/* SPDX-License-Identifier: GPL-3.0-or-later
 * J and K of a body that turns as a whole: a displacement field and the same with a rotation of one radian,
 * ten times its strains, on lattices that the surface cuts, by Gauss points, consistent cells and bonds, in
 * the plane and in space. */
#include "scene_runs/run.h"
#include <math.h>
#include "perigal/fracture.h"

/* d + w x (x - middle) + shift at the nodes: shape functions and bonds take linear fields for what they
 * are. */
static double *turned (const run *r, const double *w)
{
    size_t dim = (size_t) r->problem->dim, n = r->problem->cloud.n, stride = r->state->ndof / n;
    double *d = pg_calloc (r->state->ndof, sizeof *d);
    memcpy (d, r->state->d, r->state->ndof * sizeof *d);
    for (size_t i = 0; i < n; i++) {
        double x[3] = { 0 };
        for (size_t k = 0; k < dim; k++) x[k] = r->problem->cloud.x[i * dim + k];
        for (size_t k = 0; k < dim; k++)
            d[i * stride + k] += 0.3 + w[(k + 1) % 3] * x[(k + 2) % 3] - w[(k + 2) % 3] * x[(k + 1) % 3];
    }
    return d;
}

/* The largest change of J and K between two measurements of the same tips, over the largest of each. */
static double change (size_t n, const pg_tip_field *f, const pg_tip_field *g)
{
    double J = 0, K = 0, dJ = 0, dK = 0;
    for (size_t i = 0; i < n; i++) {
        assert_false (isnan (f[i].J[0][0]));
        J = fmax (J, fabs (f[i].J[0][0])), dJ = fmax (dJ, fabs (f[i].J[0][0] - g[i].J[0][0]));
        for (int k = 0; k < 3; k++)
            K = fmax (K, fabs (f[i].K_wide[k][0])),
            dK = fmax (dK, fabs (f[i].K_wide[k][0] - g[i].K_wide[k][0]));
    }
    return fmax (dJ / J, dK / K);
}

static void tips_do_not_see_a_turn (void **state)
{
    static const char *const method[] = { "integration: gauss", "integration: consistent", "force: bond",
                                          "force: lps" };
    static const char *const offset[] = { "0, 0", "0.37, 0.21", "0.11, 0.43" };
    (void) state;
    for (int k = 0; k < 4; k++)
        for (int o = 0; o < (k < 2 ? 3 : 1); o++) {
            run r = scene_of (1,
                              "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, -0.5], high: [1, "
                              "0.5]}}}]\nspacing: 0.05\nlattice: cells\nlattice_offset: [%s]\n"
                              "cracks: [{from: [-0.1, 0.01], to: [0.5, 0.02]}]\n"
                              "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.25}}\nmethod: {%s}\n"
                              "boundary: [{set: bottom, displacement: {x: 0, y: 0}},\n"
                              "  {set: top, displacement: {x: 0.05, y: 0.1}}]\n"
                              "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
                              offset[o], method[k]);
            const double w[3] = { 0, 0, 1 }, one = 1, *d;
            double *more;
            void *self;
            pg_tip_field before, after;
            to_the_end (&r);
            const pg_force_type *force = pg_solver_force (r.solver, &self);
            d = r.state->d, more = turned (&r, w);
            check_ok (pg_tip_measure (&before, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0));
            d = more;
            check_ok (pg_tip_measure (&after, r.problem, force, self, r.state, 0, 1, &d, &one, NULL, 0));
            print_message ("  %-24s offset %-10s J %.4g, K %.3g %.3g: change %.1e\n", method[k], offset[o],
                           before.J[0][0], before.K_wide[0][0], before.K_wide[1][0],
                           change (1, &before, &after));
            check_below (change (1, &before, &after), 1e-9);
            pg_free (more);
            clear (&r);
        }
}

static void fronts_do_not_see_a_turn (void **state)
{
    static const char *const method[] = { "gauss", "consistent" };
    (void) state;
    for (int k = 0; k < 2; k++) {
        run r = scene_of (1,
                          "dimension: 3\nbody: [{add: {box: {low: [-7, -7, -5], high: [7, 7, 5]}}}]\n"
                          "spacing: 1\nlattice: cells\nlattice_offset: [0.37, 0.21, 0.3]\n"
                          "cracks: [{disc: {center: [0, 0, 0], normal: [0, 0.2, 1], radius: 3.3}}]\n"
                          "materials: {m: {youngs_modulus: 7, poissons_ratio: 0.25}}\n"
                          "method: {integration: %s}\n"
                          "boundary: [{set: front, displacement: {x: 0, y: 0, z: 1}},\n"
                          "  {set: back, displacement: {x: 0, y: 0, z: 0}}]\n"
                          "solver: {kind: static}\noutput: {at: {levels: 1}}\n",
                          method[k]);
        const double w[3] = { 0.5, -0.7, 0.4 }, one = 1, *d;
        double *more;
        void *self;
        to_the_end (&r);
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        size_t n = r.problem->crack.front[0].n;
        pg_tip_field *before = pg_calloc (n, sizeof *before), *after = pg_calloc (n, sizeof *after);
        d = r.state->d, more = turned (&r, w);
        check_ok (pg_front_measure (before, r.problem, force, self, r.state, 0, 1, &d, &one, NULL));
        d = more;
        check_ok (pg_front_measure (after, r.problem, force, self, r.state, 0, 1, &d, &one, NULL));
        print_message ("  %s, front of %zu vertices: J %.4g, change %.1e\n", method[k], n, before[0].J[0][0],
                       change (n, before, after));
        check_below (change (n, before, after), 1e-9);
        pg_free (more), pg_free (before), pg_free (after);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (tips_do_not_see_a_turn),
                                        cmocka_unit_test (fronts_do_not_see_a_turn) };
    return cmocka_run_group_tests_name ("crack/fracture/turned_tips", tests, NULL, NULL);
}
