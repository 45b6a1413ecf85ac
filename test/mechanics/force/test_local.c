/* SPDX-License-Identifier: GPL-3.0-or-later
 * What happens in a small part of a body is looked at there alone: products with values that are zero
 * elsewhere, measures where few nodes have moved, and the worst bonds, bounded without judging. All of it is
 * what a look at everything gives: products to rounding of the plain sum, the rest bit by bit. Long bodies,
 * of lattices and of irregular points, with broken bonds. */
#include "scene_runs/run.h"

static const char *const bodies[] = {
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [60, 6]}}}]\nspacing: 1\n",
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [40, 3, 3]}}}]\nspacing: 1\n",
    ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [40, 3, 3]}}}]\nspacing: 1\n"
     "perturb: {amount: 0.15}\n"),
};
static const char *const criteria[] = {
    "mohr_coulomb, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 40 deg",
    "principal_stress, tensile_strength: 1 MPa",
    "stretch, critical_stretch: 1e-4",
    "stretch, stretch: finite, critical_stretch: 1e-4, exclude: [left]",
    "stretch, critical_stretch: 1",
};
enum { CRITERIA = sizeof criteria / sizeof *criteria };
static const char *const methods[] = { "rkpm, integration: gauss", "rkpm, integration: consistent",
                                       "nosb, integration: nodal, stabilization: silling" };

static run body_of (int body, int criterion, int method, int plain)
{
    return scene_of (1, "%smaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                     "failure: {criterion: %s}\nmethod: {approximation: %s, horizon: 2 spacing}\n"
                     "boundary: [{set: left, displacement: {x: 0}}]\nsolver: {kind: static%s}\n",
                     bodies[body], criteria[criterion], methods[method], plain ? ", plain: true" : "");
}

/* Numbers that follow no pattern, between -1 and 1. */
static double some (size_t i) { return sin (12.9898 * (double) i + 78.233 * cos ((double) i)); }

/* Points of a short piece of the body. */
static int here (const run *r, size_t unknown, double from)
{
    size_t dim = (size_t) r->problem->dim;
    double x = r->problem->cloud.x[unknown / dim * dim];
    return x >= from && x <= from + 4;
}

static void a_local_product_is_that_of_the_plain_sum (void **state)
{
    (void) state;
    for (int b = 0; b < 3; b++)
        for (int m = 0; m < 3; m++) {
            run r = body_of (b, 0, m, 0), plain = body_of (b, 0, m, 1);
            void *self, *slow;
            const pg_force_type *f = pg_solver_force (r.solver, &self);
            pg_solver_force (plain.solver, &slow);
            size_t n = r.state->ndof;
            double *x = pg_calloc (3 * n, sizeof *x), *y = x + n, *z = x + 2 * n;
            for (size_t i = 0; i < r.state->nbond; i++)
                if (some (i) > 0.99) r.state->alive[i] = plain.state->alive[i] = 0;
            check_ok (f->refresh (self, r.state, NULL));
            check_ok (f->refresh (slow, plain.state, NULL));
            /* residuals by products make the table of what is seen */
            double reference;
            check_ok (f->spares.balance_lean (self, 0, x, y, &reference));
            for (double from = 0; from < 40; from += 7) {
                double top = 0;
                for (size_t i = 0; i < n; i++) x[i] = here (&r, i, from) ? some (i) : 0;
                f->operator_ (self)->apply (self, x, y);
                f->operator_ (slow)->apply (slow, x, z);
                for (size_t i = 0; i < n; i++) top = fmax (top, fabs (z[i]));
                assert_true (top > 0);
                for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-11, top);
            }
            /* one node alone, in every block of nodes: all that see it do, the last ones too */
            memset (x, 0, n * sizeof *x);
            for (size_t at = (size_t) (b + m); at < n; at += 11) {
                x[at] = 1;
                f->operator_ (self)->apply (self, x, y);
                f->operator_ (slow)->apply (slow, x, z);
                for (size_t i = 0; i < n; i++) check_scaled (y[i], z[i], 1e-11, fabs (z[at]));
                x[at] = 0;
            }
            pg_free (x);
            clear (&r), clear (&plain);
        }
}

/* The worst bonds by bounds, and the same from a look at all bonds of a force made afresh. */
static void compare (const run *r, const double *d)
{
    void *kept, *fresh = NULL;
    const pg_force_type *f = pg_solver_force (r->solver, &kept);
    size_t nbond = r->state->nbond, at = 0;
    double *u = pg_calloc (nbond, sizeof *u), *few = pg_calloc (nbond, sizeof *few), top, most = 0;
    char *kind = pg_calloc (nbond, 1), *same = pg_calloc (nbond, 1);
    pg_changes over = { 0 };
    check_ok (f->judge (kept, r->state, d,
                 &(pg_judging){ .utilisation = few, .kind = same, .over = &over, .from = 0.9, .top = &top }));
    check_ok (f->create (&fresh, r->problem));
    check_ok (f->refresh (fresh, r->state, NULL));
    check_ok (f->judge (fresh, r->state, d, &(pg_judging){ .utilisation = u, .kind = kind }));
    for (size_t i = 0; i < nbond; i++) most = fmax (most, u[i]);
    assert_true (top == most);
    for (size_t i = 0; i < nbond && most > 1; i++) {
        if (!r->state->alive[i] || !(u[i] >= 0.9)) continue;
        assert_true (at < over.n && over.bond[at] == i);
        assert_true (few[i] == u[i] && same[i] == kind[i]);
        at++;
    }
    assert_int_equal (at, over.n);
    check_ok (f->judge (kept, r->state, d, &(pg_judging){ .utilisation = few, .kind = same }));
    assert_memory_equal (u, few, nbond * sizeof *u);
    f->free (&fresh);
    pg_free (u), pg_free (few), pg_free (kind), pg_free (same), pg_free (over.bond);
}

/* A group of bonds is judged at a displacement of its own. */
static void judge_a_group (const run *r, const double *d)
{
    void *self;
    const pg_force_type *f = pg_solver_force (r->solver, &self);
    size_t bonds[3] = { r->state->nbond / 7, r->state->nbond / 3, r->state->nbond / 2 };
    double u[3];
    int can;
    pg_bond_group group = { 0 };
    group.bond = pg_calloc (3, sizeof *group.bond), group.n = 3;
    memcpy (group.bond, bonds, sizeof bonds);
    check_ok (f->spares.gather (self, &group, &can));
    assert_true (can);
    check_ok (f->judge (self, r->state, d, &(pg_judging){ .group = &group, .utilisation = u }));
    pg_bond_group_clear (&group);
}

static void worst_bonds_are_found_where_few_nodes_have_moved (void **state)
{
    (void) state;
    for (int b = 0; b < 3; b++)
        for (int c = 0; c < CRITERIA; c++) {
            run r = body_of (b, c, c < 3 ? c : 0, 0);
            void *self;
            const pg_force_type *f = pg_solver_force (r.solver, &self);
            size_t n = r.state->ndof, dim = (size_t) r.problem->dim;
            double *d = pg_calloc (2 * n, sizeof *d), *other = d + n;
            check_ok (f->refresh (self, r.state, NULL));
            for (size_t i = 0; i < n; i++)
                d[i] = 1e-4 * ((i % dim == 1 ? 0.8 : -0.4) * r.problem->cloud.x[i] + 0.1 * some (i));
            compare (&r, d);
            for (int round = 0; round < 4; round++) {
                for (size_t i = 0; i < n; i++) {
                    if (here (&r, i, 9.0 * round)) d[i] += 5e-5 * some (i + 99);
                    other[i] = d[i] + 1e-4 * some (i + 7);
                }
                compare (&r, d);
                judge_a_group (&r, other);
                compare (&r, d);
                size_t dead[1] = { 11 + r.state->nbond / 5 * (size_t) round };
                while (!r.state->alive[dead[0]]) dead[0]++;
                r.state->alive[dead[0]] = 0;
                check_ok (f->refresh (self, r.state, &(pg_changes) { 1, 1, dead }));
                compare (&r, d);
            }
            pg_free (d);
            clear (&r);
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_local_product_is_that_of_the_plain_sum),
        cmocka_unit_test (worst_bonds_are_found_where_few_nodes_have_moved),
    };
    return cmocka_run_group_tests_name ("mechanics/force/local", tests, NULL, NULL);
}
