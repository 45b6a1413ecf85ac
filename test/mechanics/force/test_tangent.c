/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Galerkin force and its matrix are one: -K d is the change of the residual for any d, supports included,
 * whole or broken; the strain energy's derivative is the force; partial updates equal fresh ones. */
#include "scene_runs/run.h"

static uint64_t seed = 88172645463325252u;
static double random_number (void)
{
    seed ^= seed << 13, seed ^= seed >> 7, seed ^= seed << 17;
    return (double) (seed >> 11) / 4503599627370496.0 - 1;
}

#define MATERIAL "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.2}}\n"
static const char *const bodies[] = {
    "dimension: 1\nbody: [{add: {box: {low: [0], high: [1 m]}}}]\nspacing: 0.1 m\nperturb: {amount: "
    "0.2}\n" MATERIAL
    "boundary: [{set: left, displacement: {x: 1 mm}}, {set: right, traction: {x: 1 MPa}}]\n",
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1 m, 0.7 m]}}}]\nspacing: 0.1 "
    "m\nperturb: {amount: 0.2}\n" MATERIAL "boundary: [{set: left, displacement: {x: 1 mm, y: 0}}, {set: "
                                           "right, displacement: {y: y}}, {set: top, pressure: 1 MPa}]\n",
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4 m, 0.4 m, 0.3 m]}}}]\nspacing: 0.1 "
    "m\nperturb: {amount: 0.2}\n" MATERIAL
    "boundary: [{set: left, displacement: {x: 1 mm, y: 0, z: 0}}, {set: back, displacement: {x: y}}, {set: "
    "all, body_force: {z: -25 kN/m3}}]\n",
};
static const struct { const char *method; int transformation;
} methods[] = {
    { "method: {approximation: rkpm, integration: gauss, essential: nitsche}\n", 0 },
    { "method: {approximation: rkpm, integration: gauss, essential: penalty}\n", 0 },
    { "method: {approximation: rkpm, integration: gauss, essential: transformation}\n", 1 },
    { "method: {approximation: rkpm, basis: quadratic, horizon: 3 spacing, integration: gauss, gauss_points: "
      "3}\n",
      0 },
    { "method: {approximation: rkpm, integration: consistent}\n", 0 },
    { "method: {approximation: rkpm, basis: quadratic, horizon: 2.6 spacing, integration: consistent}\n", 0 },
    { "method: {approximation: pddo, integration: nodal, horizon: 2.5 spacing}\n", 0 },
    { "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, kernel: constant}\n", 1 },
    { "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: penalty, "
      "stabilization: silling}\n",
      0 },
    { "method: {approximation: rkpm, integration: gauss, essential: nitsche, dilatation: projected}\n", 0 },
    { "method: {approximation: rkpm, basis: quadratic, horizon: 2.6 spacing, integration: consistent, "
      "dilatation: projected}\n",
      0 },
    { "method: {approximation: rkpm, integration: gauss, essential: transformation, dilatation: projected}\n",
      1 },
    { "method: {approximation: pddo, integration: nodal, horizon: 2.5 spacing, dilatation: projected}\n", 0 },
    { "method: {approximation: nosb, integration: nodal, horizon: 2.5 spacing, essential: penalty, "
      "stabilization: silling, dilatation: projected}\n",
      0 },
};
enum { BODIES = 3, METHODS = 14 };

static run body_of (int body, int method)
{
    return scene_of (1, "%s%s", bodies[body], methods[method].method);
}

static void kill_some (run *r, double share)
{
    for (size_t b = 0; b < r->state->nbond; b++)
        if (0.5 + 0.5 * random_number () < share) r->state->alive[b] = 0;
}

/* residual (d) - residual (0) = -K d */
static void compare (run *r)
{
    void *self;
    const pg_force_type *f = pg_solver_force (r->solver, &self);
    size_t n = r->state->ndof;
    double *d = pg_calloc (4 * n, sizeof *d), *at_zero = d + n, *at_d = d + 2 * n, *Kd = d + 3 * n, reference,
           top = 0;
    check_ok (f->balance (self, 0.7, d, at_zero, &reference));
    for (size_t i = 0; i < n; i++) d[i] = random_number ();
    check_ok (f->balance (self, 0.7, d, at_d, &reference));
    const pg_operator *op = f->operator_ (self);
    op->apply (op->context, d, Kd);
    for (size_t i = 0; i < n; i++) top = fmax (top, fabs (Kd[i]));
    assert_true (top > 0 && reference > 0);
    for (size_t i = 0; i < n; i++) check_scaled (at_zero[i] - at_d[i], Kd[i], 1e-11, top);
    check_ok (pg_force_assemble (f, self, NULL));         /* the matrix and the product without it are one */
    pg_sparse K = *pg_force_matrix (f, self);
    pg_sparse_multiply (&K, d, at_d);
    for (size_t i = 0; i < n; i++) check_scaled (at_d[i], Kd[i], 1e-12, top);
    op->diagonal (op->context, at_zero);
    pg_operator plain = pg_sparse_operator (&K);
    plain.diagonal (plain.context, at_d);
    top = 0;
    for (size_t i = 0; i < n; i++) top = fmax (top, fabs (at_d[i]));
    for (size_t i = 0; i < n; i++) check_scaled (at_zero[i], at_d[i], 1e-12, top);
    pg_free (d);
}

static void the_matrix_is_the_derivative_of_the_force (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            run r = body_of (b, m);
            refresh (&r, NULL);
            compare (&r);
            clear (&r);
        }
}

static void also_when_bonds_are_broken (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            if (methods[m].transformation && b == 0) continue;  /* the slaves' matrix may become singular */
            run r = body_of (b, m);
            refresh (&r, NULL);
            kill_some (&r, 0.15);
            void *self;
            const pg_force_type *f = pg_solver_force (r.solver, &self);
            pg_status status = f->refresh (self, r.state, NULL);
            if (status != PG_OK) assert_true (methods[m].transformation && status == PG_E_SINGULAR);
            else compare (&r);
            clear (&r);
        }
}

/* Supports left out: dE/dd = internal force = -residual. */
static void the_force_is_the_derivative_of_the_energy (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 4; m < METHODS; m++) {
            const char *cut = strstr (bodies[b], "boundary");
            run r = scene_of (1, "%.*s%s", (int) (cut - bodies[b]), bodies[b], methods[m].method);
            refresh (&r, NULL);
            kill_some (&r, 0.1);
            refresh (&r, NULL);
            void *self;
            const pg_force_type *f = pg_solver_force (r.solver, &self);
            size_t n = r.state->ndof;
            pg_work_balance work_balance = { 0 };
            double *d = pg_calloc (3 * n, sizeof *d), *e = d + n, *residual = d + 2 * n, reference, power = 0,
                   E[2];
            for (size_t i = 0; i < n; i++) d[i] = random_number (), e[i] = random_number ();
            check_ok (f->balance (self, 1, d, residual, &reference));
            for (size_t i = 0; i < n; i++) power -= residual[i] * e[i];
            for (int side = 0; side < 2; side++) {     /* E is quadratic: the central difference is exact */
                for (size_t i = 0; i < n; i++) residual[i] = d[i] + (side ? 0.5 : -0.5) * e[i];
                check_ok (f->work (self, 1, residual, NULL, &work_balance));
                E[side] = work_balance.strain;
                assert_true (E[side] > 0);
            }
            check_scaled (E[1] - E[0], power, 1e-10, E[0] + E[1]);
            pg_work_balance_clear (&work_balance);
            pg_free (d);
            clear (&r);
        }
}

static void a_partial_update_equals_a_fresh_one (void **state)
{
    (void) state;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            if (methods[m].transformation && b == 0) continue;
            run part = body_of (b, m), whole = body_of (b, m);
            void *self, *other;
            const pg_force_type *f = pg_solver_force (part.solver, &self);
            pg_solver_force (whole.solver, &other);
            refresh (&part, NULL);
            /* some bonds anywhere; then a single one of each set */
            for (int round = 0; round < 6; round++) {
                size_t bond[64], n = 0, first = round < 3 ? 0 : part.problem->bonds.first[round - 3];
                size_t last = round < 3 ? part.state->nbond : part.problem->bonds.first[round - 2],
                       most = round < 3 ? 64 : 1;
                for (size_t i = first; i < last && n < most; i++)
                    if (part.state->alive[i] && 0.5 + 0.5 * random_number () < 0.001 * (double) (1 + round))
                        bond[n++] = i, part.state->alive[i] = 0;
                refresh (&part, &(pg_changes) { n, 64, bond });
            }
            check_ok (pg_state_copy (whole.state, part.state));
            refresh (&whole, NULL);
            check_ok (pg_force_assemble (f, self, NULL));
            check_ok (pg_force_assemble (f, other, NULL));
            const pg_sparse *A = pg_force_matrix (f, self), *B = pg_force_matrix (f, other);
            assert_memory_equal (A->value, B->value, (size_t) A->start[A->ncol] * sizeof *A->value);
            size_t n = part.state->ndof;
            double *d = pg_calloc (3 * n, sizeof *d), reference[2];
            for (size_t i = 0; i < n; i++) d[i] = random_number ();
            check_ok (f->balance (self, 1, d, d + n, &reference[0]));
            check_ok (f->balance (other, 1, d, d + 2 * n, &reference[1]));
            assert_memory_equal (d + n, d + 2 * n, n * sizeof *d);
            if (f->basis (self))
                assert_memory_equal (f->basis (self)->value, f->basis (other)->value,
                                     (size_t) f->basis (self)->start[f->basis (self)->ncol] * sizeof *d);
            pg_free (d);
            clear (&part), clear (&whole);
        }
}

/* Kills every bond of some points near the middle of each set. */
static void kill_near_the_middle (run *r, pg_changes *dead)
{
    const pg_problem *p = r->problem;
    dead->n = 0;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        size_t n = p->bonds.rows[s].n, last = n / 2 + 3 < n ? n / 2 + 3 : n;
        for (size_t e = p->bonds.rows[s].family.start[n / 2]; e < p->bonds.rows[s].family.start[last]; e++) {
            size_t bond = p->bonds.first[s] + e;
            if (e % 3 || !r->state->alive[bond]) continue;
            r->state->alive[bond] = 0;
            dead->bond[dead->n++] = bond;
        }
    }
}

/* K x by the change that the force tells, added to y. */
static void add_change (const pg_stiffness_change *c, size_t dim, const double *x, double *y)
{
    for (size_t i = 0; i < c->n * dim; i++)
        for (size_t j = 0; j < c->n * dim; j++)
            y[(size_t) c->node[i / dim] * dim + i % dim] +=
                c->K[i * c->width + j] * x[(size_t) c->node[j / dim] * dim + j % dim];
}

/* What a refresh tells to have changed of K is the difference of the products before and after; constant
 * forces that it does not call changed are those of before. */
static void the_change_of_K_is_told (void **state)
{
    (void) state;
    int told = 0;
    for (int b = 0; b < BODIES; b++)
        for (int m = 0; m < METHODS; m++) {
            if (methods[m].transformation && b == 0) continue;
            run r = body_of (b, m);
            refresh (&r, NULL);
            void *self;
            const pg_force_type *f = pg_solver_force (r.solver, &self);
            const pg_operator *op = f->operator_ (self);
            size_t n = r.state->ndof, dim = (size_t) r.problem->dim;
            double *x = pg_calloc (6 * n, sizeof *x), *before = x + n, *after = x + 2 * n, *zero = x + 3 * n,
                   *load0 = x + 4 * n, *load1 = x + 5 * n, reference, top = 0;
            pg_stiffness_change c;
            pg_changes dead = { .bond = pg_calloc (r.state->nbond, sizeof *dead.bond) };
            for (size_t i = 0; i < n; i++) x[i] = random_number ();
            check_ok (f->spares.change (self, &c));
            assert_int_equal (c.known, 0);             /* the record begins */
            check_ok (f->balance (self, 1, zero, load0, &reference));
            op->apply (op->context, x, before);
            kill_near_the_middle (&r, &dead);
            pg_status status = f->refresh (self, r.state, &dead);
            if (status == PG_OK) {
                check_ok (f->spares.change (self, &c));
                op->apply (op->context, x, after);
                for (size_t i = 0; i < n; i++) top = fmax (top, fabs (after[i]));
                assert_true (dead.n > 0);
                if (c.known) add_change (&c, dim, x, before);
                for (size_t i = 0; c.known && i < n; i++) check_scaled (before[i], after[i], 1e-11, top);
                told += c.known && c.n > 0;
                check_ok (f->balance (self, 1, zero, load1, &reference));
                for (size_t i = 0; !c.loads && i < n; i++)
                    check_scaled (load0[i], load1[i], 1e-12, reference);
                check_ok (f->spares.change (self, &c));
                assert_true (c.known && c.n == 0 && !c.loads && !c.basis);     /* nothing since */
            } else assert_true (methods[m].transformation && status == PG_E_SINGULAR);
            pg_free (x), pg_free (dead.bond);
            clear (&r);
        }
    assert_true (told > 30);
}

static void threads_change_no_bit (void **state)
{
    (void) state;
    for (int m = 0; m < 2 * METHODS; m++) {
        const char *body = bodies[1 + m % 2], *method = methods[m / 2].method;
        run one = scene_of (1, "%s%s", body, method), four = scene_of (4, "%s%s", body, method);
        to_the_end (&one), to_the_end (&four);
        assert_memory_equal (one.state->d, four.state->d, one.state->ndof * sizeof *one.state->d);
        clear (&one), clear (&four);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (the_matrix_is_the_derivative_of_the_force),
        cmocka_unit_test (also_when_bonds_are_broken),
        cmocka_unit_test (the_force_is_the_derivative_of_the_energy),
        cmocka_unit_test (a_partial_update_equals_a_fresh_one),
        cmocka_unit_test (the_change_of_K_is_told),
        cmocka_unit_test (threads_change_no_bit),
    };
    return cmocka_run_group_tests_name ("mechanics/force/tangent", tests, NULL, NULL);
}
