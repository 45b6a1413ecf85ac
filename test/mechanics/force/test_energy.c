/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points that die by their energy (theory B2, B3): energies and damage against plain double loops; who dies
 * in motion, with skipping and without, is told by the plain sum alone; dead points stay dead; exempt points,
 * materials, threads, lists and stencils, lack of memory. */
#include "bond.h"
#include <stdlib.h>

#define NODE(more) "failure: {criterion: node_energy, fracture_energy: 2e-5, wc_factor: 1" more "}\n"
#define LARGE \
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [5, 3]}}}, {subtract: {disk: " \
    "{center: [3, 2], diameter: 1}}}]\nspacing: 0.1\n" \
    "lattice: cells\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.25, density: 3}}\n"
static const char *const bodies[] = {
    BODY2 NODE ("") "lattice: cells\nmethod: {force: bond}\n",
    BODY2 NODE ("") "lattice: cells\nmethod: {force: bond, evaluation: list}\n",
    BODY2 NODE ("") "lattice: cells\nmethod: {force: bond, horizon: 4.2 spacing, surface_correction: "
                    "product, kernel: quadratic}\n",
    BODY2 NODE ("") "lattice: nodes\nmethod: {force: bond, partial_volume: none}\n",
    BODY2 NODE ("") "perturb: {amount: 0.2}\nmethod: {force: bond}\n",
    BODY2 NODE ("") "lattice: cells\nmethod: {force: bond, stretch: finite}\n",
    BODY2 "failure: {fracture_energy: 4e-5}\nlattice: cells\nmethod: {force: fcbm}\n",
    BODY3 NODE ("") "method: {force: bond}\n",
    BODY1 NODE ("") "method: {force: bond}\n",
    LARGE NODE ("") "method: {force: bond}\n",
    LARGE NODE (
        ", exclude: [grip]") "sets: {grip: {where: 'x <= 0.25'}}\nmethod: {force: bond, evaluation: list}\n",
    LARGE NODE ("") "method: {force: fcbm}\n",
};
enum { BODIES = sizeof bodies / sizeof *bodies };

static int finite (const bonded *b) { return b->problem->sums->rule.finite; }

/* W_i = 1/4 sum_j c k beta g r s^2 V_j over live bonds, J/m^3, term by term from the definition. */
static double plain_energy (const bonded *b, size_t i, const double *u)
{
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    size_t m = f->start[i + 1] - f->start[i], dim = b->dim;
    double *xi = pg_calloc (m * dim + 1, sizeof *xi), *weight = pg_calloc (m + 1, sizeof *weight), W = 0;
    double unit = p->sums->calibration
                  * pg_bond_modulus (p->mode, rule->kernel, rule->horizon, 1, p->cloud.thickness);
    pg_sums_bonds (p->sums, f, i, xi, weight, NULL);
    for (size_t e = 0; e < m; e++) {
        size_t j = (size_t) f->node[f->start[i] + e];
        if (!b->state->alive[f->start[i] + e]) continue;
        double a = unit * p->material[p->block[PG_NODES][i]].modulus,
               c = unit * p->material[p->block[PG_NODES][j]].modulus;
        double r = 0, y = 0, along = 0;
        for (size_t k = 0; k < dim; k++) {
            double eta = u[j * dim + k] - u[i * dim + k], x = xi[e * dim + k];
            r += x * x, y += (x + eta) * (x + eta), along += x * eta;
        }
        r = sqrt (r);
        double s = rule->finite ? (sqrt (y) - r) / r : along / (r * r);
        W += 0.25 * (a == c ? a : 2 * a * c / (a + c)) * weight[e] * r * s * s * p->cloud.volume[j];
    }
    pg_free (xi), pg_free (weight);
    return W;
}

static double critical (const bonded *b, size_t i)
{
    if (b->problem->bonds.exempt[PG_NODES][i]) return INFINITY;
    const pg_criterion *c = &b->problem->criterion[b->problem->block[PG_NODES][i]];
    return c->parameter[0] / pg_cloud_ratio (&b->problem->cloud, i);
}

static double bulge (const double *x, size_t dim, double wide, double t)
{
    double r = 0;
    for (size_t k = 0; k < dim; k++) r += (x[k] - 0.27 - 0.1 * (double) k) * (x[k] - 0.27 - 0.1 * (double) k);
    return wide * exp (-r / (0.02 * wide * wide)) * t;
}
/* A bulge that grows, somewhere, on a stretch of the whole and with a rigid motion that must not matter. */
static void displace (const bonded *b, double t, double rigid, double *u)
{
    for (size_t i = 0; i < b->n; i++)
        for (size_t k = 0; k < b->dim; k++) {
            const double *x = b->problem->cloud.x + i * b->dim;
            u[i * b->dim + k] = rigid * (1 + (double) k) + 2e-4 * t * x[k]
                                + 4e-4 * bulge (x, b->dim, b->n > 500 ? 4 : 1, t) * (k ? -1 : 1);
        }
}

/* ---- utilisation and fields ---------------------------------------------------------------------------- */
static void energies_are_plain_sums (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        pg_changes c = kill_some (&b, 5);
        double *u = random_vector (b.ndof, 17), *share = pg_calloc (b.state->nbond, sizeof *share),
               *factor = pg_calloc (b.state->nbond, sizeof *factor), top = 0;
        char *kind = pg_calloc (b.state->nbond, 1);
        const pg_family *f = &b.problem->bonds.rows[PG_NODES].family;
        for (size_t i = 0; i < b.ndof; i++) u[i] *= 1e-5;
        check_ok (b.force->judge (b.self, b.state, u,
                                  &(pg_judging){ .utilisation = share, .kind = kind, .factor = factor }));
        for (size_t i = 0; i < b.n; i++) top = fmax (top, sqrt (plain_energy (&b, i, u) / critical (&b, i)));
        for (size_t i = 0; i < b.n; i++)
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                size_t j = (size_t) f->node[e];
                double worse = fmax (plain_energy (&b, i, u) / critical (&b, i),
                                     plain_energy (&b, j, u) / critical (&b, j));
                if (!b.state->alive[e]) worse = 0;
                check_scaled (share[e], sqrt (worse), finite (&b) ? 1e-9 : 1e-13, top);
                assert_true (b.state->alive[e] ? factor[e] == 1 / share[e] : isinf (factor[e]));
                assert_true (!b.state->alive[e] || kind[e] == 'e');
            }
        pg_free (u), pg_free (share), pg_free (factor), pg_free (kind), pg_free (c.bond);
        unbonded (&b);
    }
}

/* d = 1 - lambda (w0 * (chi lambda)) / (w0 * chi) of points, some dead (B3): what is counted bond by bond, to
 * rounding. */
static void damage_is_that_of_points (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        const pg_family *f = &b.problem->bonds.rows[PG_NODES].family;
        unsigned char *lives = pg_calloc (b.n, 1);
        double *damage = pg_calloc (6 * b.n, sizeof *damage), *beta = pg_calloc (400, sizeof *beta),
               *d = pg_calloc (b.ndof, sizeof *d);
        int components;
        const char *unit;
        for (size_t i = 0; i < b.n; i++) lives[i] = i * 7 % 11 > 1;
        for (size_t i = 0; i < b.n; i++)
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
                b.state->alive[e] = lives[i] && lives[f->node[e]];
        check_ok (b.force->refresh (b.self, b.state, NULL));
        check_ok (b.force->field (b.self, b.state, d, "damage", &components, &unit, damage));
        for (size_t i = 0; i < b.n; i++) {
            double all = 0, left = 0;
            assert_true (f->start[i + 1] - f->start[i] <= 400);
            pg_sums_bonds (b.problem->sums, f, i, NULL, NULL, beta);
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                double share = beta[e - f->start[i]] * b.problem->cloud.volume[f->node[e]];
                all += share, left += lives[f->node[e]] ? share : 0;
            }
            check_absolute (damage[i], 1 - (lives[i] ? left / all : 0), 1e-13);
        }
        pg_free (lives), pg_free (damage), pg_free (beta), pg_free (d);
        unbonded (&b);
    }
}

/* ---- in motion ----------------------------------------------------------------------------------------- */
static void bury (bonded *b, const pg_changes *c)
{
    for (size_t k = 0; k < c->n; k++) b->state->alive[c->bond[k]] = 0;
}

static size_t live_bonds (const bonded *b)
{
    size_t n = 0;
    for (size_t e = 0; e < b->state->nbond; e++) n += b->state->alive[e];
    return n;
}

/* The changes are exactly the live bonds of points at or over their limit, both directions, ascending. */
static size_t check_changes (const bonded *b, const double *u, const pg_changes *c)
{
    const pg_family *f = &b->problem->bonds.rows[PG_NODES].family;
    unsigned char *dies = pg_calloc (b->n, 1);
    size_t dying = 0, next = 0;
    for (size_t i = 0; i < b->n; i++) dying += dies[i] = plain_energy (b, i, u) >= critical (b, i);
    for (size_t i = 0; i < b->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            if (!b->state->alive[e] || !(dies[i] || dies[f->node[e]])) continue;
            assert_true (next < c->n);
            assert_int_equal (c->bond[next++], e);
        }
    assert_int_equal (next, c->n);
    pg_free (dies);
    return dying;
}

/* A history of displacements, up and down: every step against the plain sums and against a force made anew
 * from the bits. */
static void marching (const char *text, int threads, unsigned char **bits)
{
    bonded b = bonded_with (text, threads, 0, NULL);
    double *u = pg_calloc (b.ndof, sizeof *u), *r = pg_calloc (b.ndof, sizeof *r),
           *s = pg_calloc (b.ndof, sizeof *s);
    size_t died = 0, steps = 0;
    for (int step = 0; step < 120; step++) {
        pg_changes c = { 0 };
        double t = step < 40 ? 0.03 * step : step < 60 ? 1.2 - 0.06 * (step - 40) : 0.08 * (step - 60);
        displace (&b, t, 1e-3 * step, u);
        check_ok (b.force->motion.balance_and_break (b.self, 0, u, r, NULL, &c));
        size_t now = check_changes (&b, u, &c);
        died += now, steps += now > 0;
        /* less than there was already: nobody dies, nobody is born */
        if (step > 40 && step < 70) assert_int_equal (now, 0);
        bury (&b, &c);
        if (step % 10 == 0 || (now && steps % 4 == 1)) {
            bonded fresh = bonded_of (text);
            memcpy (fresh.state->alive, b.state->alive, b.state->nbond);
            check_ok (fresh.force->refresh (fresh.self, fresh.state, NULL));
            check_ok (fresh.force->balance (fresh.self, 0, u, s, NULL));
            assert_memory_equal (r, s, b.ndof * sizeof *r);
            unbonded (&fresh);
        }
        size_t left = c.n = 0;
        left = live_bonds (&b);
        /* the same again: nothing more */
        check_ok (b.force->motion.balance_and_break (b.self, 0, u, r, NULL, &c));
        assert_int_equal (c.n, 0);
        assert_int_equal (left, live_bonds (&b));
        pg_free (c.bond);
    }
    print_message ("%zu points of %zu died in %zu steps\n", died, b.n, steps);
    assert_true (died > (b.dim == 1 ? 1 : 3) && died < b.n && steps > 1);
    *bits = pg_calloc (b.state->nbond, 1);
    memcpy (*bits, b.state->alive, b.state->nbond);
    pg_free (u), pg_free (r), pg_free (s);
    unbonded (&b);
}

static void who_dies_in_motion (void **unused)
{
    (void) unused;
    unsigned char *bits[BODIES], *again;
    for (size_t k = 0; k < BODIES; k++) marching (bodies[k], 1, &bits[k]);
    bonded b = bonded_of (bodies[0]);
    assert_memory_equal (bits[0], bits[1], b.state->nbond);            /* stencil, list */
    assert_memory_equal (bits[0], bits[6], b.state->nbond);  /* transforms; half of twice the energy */
    unbonded (&b);
    b = bonded_of (bodies[9]);
    assert_memory_equal (bits[9], bits[11], b.state->nbond);
    marching (bodies[9], 3, &again);
    assert_memory_equal (bits[9], again, b.state->nbond);
    pg_free (again);
    unbonded (&b);
    for (size_t k = 0; k < BODIES; k++) pg_free (bits[k]);
}

/* ---- whose limit it is --------------------------------------------------------------------------------- */
/* Exempt points and those of a material that never breaks do not die, their bonds to points that do go with
 * these; each material has its own limit. */
static void exempt_points_and_materials (void **unused)
{
    (void) unused;
    bonded b = bonded_of ("dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [3, "
                          "1]}}}]\nspacing: 0.1\nlattice: cells\n"
                          "materials:\n  rock: {youngs_modulus: 10, poissons_ratio: 0.3333333333, failure: "
                          "{fracture_energy: 2e-5}}\n"
                          "  clay: {youngs_modulus: 10, poissons_ratio: 0.3333333333, failure: {wc_factor: "
                          "0.25, fracture_energy: 2e-5}}\n"
                          "  iron: {youngs_modulus: 10, poissons_ratio: 0.3333333333, failure: {never: on}}\n"
                          "blocks: [{material: rock, where: x < 1}, {material: clay, where: x > 1 and x < "
                          "2}, {material: iron, where: x > 2}]\n"
                          "sets: {grip: {where: 'x <= 0.3'}}\nfailure: {criterion: node_energy, wc_factor: "
                          "0.5, exclude: [grip]}\nmethod: {force: bond}\n");
    static const double Wc[] = { 0.5 * 2e-5 / 0.3015, 0.25 * 2e-5 / 0.3015 };
    const pg_family *f = &b.problem->bonds.rows[PG_NODES].family;
    double *u = pg_calloc (b.ndof, sizeof *u), *r = pg_calloc (b.ndof, sizeof *r);
    char text[300];
    pg_criterion_describe (&b.problem->criterion[1], text, sizeof text);
    check_contains (
        text, "node energy >= 1.65837e-05 J/m3 (0.25 G0 / horizon, fracture energy G0 = 2e-05 J/m2 given)");
    pg_criterion_describe (&b.problem->criterion[2], text, sizeof text);
    check_contains (text, "never breaks");
    size_t killed[2] = { 0 }, spared = 0;
    for (int step = 1; step < 4; step++) {
        pg_changes c = { 0 };
        for (size_t i = 0; i < b.ndof; i++)
            u[i] = i % 2 ? 0 : (step == 1 ? 2.0e-3 : step == 2 ? 2.6e-3 : 4e-3) * b.problem->cloud.x[i];
        check_ok (b.force->motion.balance_and_break (b.self, 0, u, r, NULL, &c));
        for (size_t i = 0; i < b.n; i++) {
            double x = b.problem->cloud.x[2 * i], W = plain_energy (&b, i, u);
            int block = x < 1   ? 0
                        : x < 2 ? 1
                                : 2,
                mortal = x > 0.3 && block < 2, dies = mortal && W >= Wc[block];
            size_t gone = 0, live = 0, far = 0;
            for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                for (size_t k = 0; k < c.n; k++) gone += c.bond[k] == e;
                live += b.state->alive[e], far++;
            }
            if (dies && live) assert_int_equal (gone, live), killed[block]++;
            if (!mortal && W > Wc[0]) spared++, assert_true (far > 0);
        }
        bury (&b, &c);
        assert_true (step > 1 || (killed[0] == 0 && killed[1] > 10));              /* clay alone */
        pg_free (c.bond);
    }
    pg_census left = { 0 };
    check_ok (b.force->census (b.self, &left));
    assert_true (killed[0] > 10 && spared > 10 && left.isolated >= killed[0] + killed[1]);
    for (size_t i = 0; i < b.n; i++)                                   /* iron keeps its own */
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            if (b.problem->cloud.x[2 * i] > 2 && b.problem->cloud.x[2 * (size_t) f->node[e]] > 2)
                assert_int_equal (b.state->alive[e], 1);
    pg_free (u), pg_free (r);
    unbonded (&b);
}

/* Without memory nobody dies and nothing is told; the next try finds the same. */
static void lack_of_memory (void **unused)
{
    (void) unused;
    for (size_t k = 1;; k++) {
        bonded b = bonded_of (bodies[9]);
        double *u = pg_calloc (b.ndof, sizeof *u), *r = pg_calloc (b.ndof, sizeof *r);
        pg_changes c = { 0 };
        displace (&b, 3, 0, u);
        pg_memory_fail_at (k);
        pg_status status = b.force->motion.balance_and_break (b.self, 0, u, r, NULL, &c);
        pg_memory_fail_at (0);
        if (status != PG_OK) {
            assert_int_equal (status, PG_E_MEMORY), assert_int_equal (c.n, 0);
            check_ok (b.force->motion.balance_and_break (b.self, 0, u, r, NULL, &c));
        }
        size_t dying = check_changes (&b, u, &c);
        assert_true (dying > 5);
        pg_free (c.bond), pg_free (u), pg_free (r);
        unbonded (&b);
        if (status == PG_OK) {
            assert_true (k > 5);
            break;
        }
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (energies_are_plain_sums),
                                        cmocka_unit_test (damage_is_that_of_points),
                                        cmocka_unit_test (who_dies_in_motion),
                                        cmocka_unit_test (exempt_points_and_materials),
                                        cmocka_unit_test (lack_of_memory) };
    return cmocka_run_group_tests_name ("mechanics/force/energy", tests, NULL, NULL);
}
