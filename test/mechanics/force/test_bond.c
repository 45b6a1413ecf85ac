/* SPDX-License-Identifier: GPL-3.0-or-later
 * The force of bonds: matrix against sweep, symmetry, rigid motions, energy of uniform strain, dead bonds,
 * bounds, fields. */
#include "bond.h"

static const char perturbed[] = BODY2 "perturb: {amount: 0.2}\nmethod: {force: bond}\n";
static const char turned[] = BODY3_OF ("0.2") "perturb: {amount: 0.2}\nmethod: {force: gmpd}\n";
static const char *const bodies[] = {
    BODY2 "method: {force: bond}\n", BODY3 "method: {force: bond}\n", BODY1 "method: {force: bond}\n",
    perturbed,
    BODY2 "method: {force: bond, horizon: 4.2 spacing, kernel: quadratic, surface_correction: volume}\n",
    BODY2 "lattice: cells\nmethod: {force: bond, horizon: 4.2 spacing, partial_volume: linear}\n",
    BODY2_OF ("0.2") "method: {force: gmpd}\n",
    BODY3_OF ("0.1") "method: {force: gmpd, beam: timoshenko, shear_parameter: 0.5}\n", turned,
    BODY2_OF ("0") "lattice: cells\nmethod: {force: gmpd, horizon: 4.2 spacing, evaluation: list, "
                   "surface_correction: volume}\n",
    BODY2_OF ("0.25") "method: {force: gmpd, beam: chen, cm_ratio: 0.75, kernel: quadratic, "
                      "surface_correction: product}\n",
    /* one C_N and two shear stiffnesses: 1 / ((1 + nu)(1 - 2 nu)) is 1 at 0 and at -1/2 */
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [2.4, 0.9]}}}]\nspacing: "
    "0.1\nlattice: cells\nmethod: {force: gmpd}\n"
    "materials: {one: {youngs_modulus: 10, poissons_ratio: 0, density: 3}, other: {youngs_modulus: 10, "
    "poissons_ratio: -0.5, density: 3}}\n"
    "blocks: [{material: one, where: \"x < 1.2\"}, {material: other, where: \"x >= 1.2\"}]\n",
    BODY2 "method: {force: bond, stretch: finite}\n"
};
enum { BODIES = sizeof bodies / sizeof *bodies };

static void matrix_is_sweep (bonded *b, double tolerance)
{
    double *x = random_vector (b->ndof, 7), *y = pg_calloc (b->ndof, sizeof *y),
           *z = pg_calloc (b->ndof, sizeof *z), *d = pg_calloc (b->ndof, sizeof *d);
    const pg_operator *op = b->force->operator_ (b->self);
    check_ok (pg_force_assemble (b->force, b->self, NULL));
    const pg_sparse *K = pg_force_matrix (b->force, b->self);
    assert_int_equal (K->symmetric, 1);
    pg_sparse_multiply (K, x, y);
    op->apply (op->context, x, z);
    double size = size_of (b->ndof, y);
    for (size_t i = 0; i < b->ndof; i++) check_scaled (z[i], y[i], tolerance, size);
    op->diagonal (op->context, d);
    for (size_t i = 0; i < b->ndof; i++)
        check_scaled (d[i], K->value[K->start[i + 1] - 1], tolerance, size_of (b->ndof, d));
    double *sum = z;
    memset (y, 0, b->ndof * sizeof *y);
    for (size_t j = 0; j < b->ndof; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++) {
            y[j] += fabs (K->value[q]);
            if ((size_t) K->row[q] != j) y[K->row[q]] += fabs (K->value[q]);
        }
    check_ok (b->force->motion.row_sums (b->self, sum));
    for (size_t i = 0; i < b->ndof; i++) check_scaled (sum[i], y[i], 1e-12, size_of (b->ndof, y));
    pg_free (x), pg_free (y), pg_free (z), pg_free (d);
}

static void test_matrix (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        matrix_is_sweep (&b, 1e-13);
        pg_changes c = kill_some (&b, 5);
        assert_true (c.n > b.n);
        matrix_is_sweep (&b, 1e-13);
        pg_free (c.bond);
        unbonded (&b);
    }
}

/* Columns made again after breaks are those of a fresh assembly, bit by bit; dead bonds have no block. */
static void test_partial_assembly (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]), fresh = bonded_of (bodies[k]);
        check_ok (pg_force_assemble (b.force, b.self, NULL));
        unsigned long before = b.force->revision (b.self);
        pg_changes c = kill_some (&b, 5);
        assert_true (b.force->revision (b.self) != before);
        check_ok (pg_force_assemble (b.force, b.self, NULL));
        memcpy (fresh.state->alive, b.state->alive, b.state->nbond);
        check_ok (fresh.force->refresh (fresh.self, fresh.state, NULL));
        check_ok (pg_force_assemble (fresh.force, fresh.self, NULL));
        const pg_sparse *K = pg_force_matrix (b.force, b.self),
                        *F = pg_force_matrix (fresh.force, fresh.self);
        assert_int_equal (K->start[b.ndof], F->start[b.ndof]);
        assert_memory_equal (K->value, F->value, (size_t) K->start[b.ndof] * sizeof *K->value);
        const pg_family *f = &b.problem->bonds.rows[PG_NODES].family;
        for (size_t n = 0; n < c.n; n++) {
            int set;
            size_t i, j = (size_t) f->node[c.bond[n]];
            pg_problem_locate (b.problem, c.bond[n], &set, &i);
            if (j > i) continue;
            for (size_t a = 0; a < b.stride; a++)
                for (long q = K->start[i * b.stride + a]; q < K->start[i * b.stride + a + 1]; q++)
                    if ((size_t) K->row[q] / b.stride == j) assert_true (K->value[q] == 0);
        }
        double *d = random_vector (b.ndof, 3), *r = pg_calloc (b.ndof, sizeof *r),
               *s = pg_calloc (b.ndof, sizeof *s);
        check_ok (b.force->balance (b.self, 0, d, r, NULL));
        check_ok (fresh.force->balance (fresh.self, 0, d, s, NULL));
        assert_memory_equal (r, s, b.ndof * sizeof *r);
        pg_free (c.bond), pg_free (d), pg_free (r), pg_free (s);
        unbonded (&b), unbonded (&fresh);
    }
}

static void test_rigid (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        double H[9] = { 0 }, *r = pg_calloc (b.ndof, sizeof *r), *one = random_vector (b.ndof, 5), reference,
               strained;
        if (b.dim == 2) H[1] = 1e-6, H[2] = -1e-6;
        if (b.dim == 3) H[1] = 1e-6, H[3] = -1e-6, H[5] = 2e-6, H[7] = -2e-6;
        double *u = linear_field (&b, H);
        for (size_t i = 0; i < b.ndof; i++)
            u[i] += i % b.stride < b.dim ? 1e-3 * (double) (1 + i % b.stride) : 0, one[i] *= 1e-7;
        check_ok (b.force->balance (b.self, 0, one, r, &strained));
        check_ok (b.force->balance (b.self, 0, u, r, &reference));
        assert_true (strained > 0);
        /* finite: a rotation of 1e-6 is none of 1e-12 */
        check_below (reference, (strcmp (bodies[k], bodies[BODIES - 1]) ? 1e-9 : 1e-4) * strained);
        pg_free (r), pg_free (u), pg_free (one);
        unbonded (&b);
    }
}

/* Energy of hydrostatic strain around a point with a whole family: that of the material (theory A2), and the
 * virial its stress. */
static void test_hydrostatic (void **unused)
{
    (void) unused;
    static const char *const more[] = {
        "method: {force: bond}\n", "method: {force: bond, partial_volume: none}\n",
        "method: {force: bond, kernel: quadratic, partial_volume: linear}\n"
    };
    static const char *const where[] = {
        "dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nthickness: 0.2\n",
        "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nthickness: 0.2\n",
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n",
        "dimension: 1\ncross_section: 0.3\nbody: [{add: {box: {low: [0], high: [1]}}}]\n"
    };
    for (int w = 0; w < 4; w++)
        for (int k = 0; k < 3; k++) {
            char text[1000];
            snprintf (text, sizeof text,
                      "%sspacing: 0.1\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.2, density: "
                      "3}}\n%s",
                      where[w], more[k]);
            bonded b = bonded_of (text);
            double H[9] = { 0 }, place[3] = { 0.5, 0.5, 0.5 }, v[3], s[6],
                   *value = pg_calloc (6 * b.n, sizeof *value);
            for (size_t a = 0; a < b.dim; a++) H[a * b.dim + a] = 1e-3;
            double *u = linear_field (&b, H), exact[6];
            pg_stress_of_gradient (b.problem->material, b.problem->dim, H, exact);
            memcpy (b.state->d, u, b.ndof * sizeof *u);
            check_ok (b.force->sample (b.self, b.state, u, 1, place, v, s, NULL));
            /* cell means by quadrature */
            for (int c = 0; c < 6; c++) check_scaled (s[c], exact[c], 1e-6, 0.01);
            for (size_t c = 0; c < b.dim; c++) check_relative (v[c], 0.5e-3, 1e-12);
            int components;
            const char *unit;
            check_ok (b.force->field (b.self, b.state, u, "strain", &components, &unit, value));
            for (size_t i = 0; i < b.n; i++)
                for (int c = 0; c < components; c++)
                    check_scaled (value[i * (size_t) components + (size_t) c], c < b.problem->dim ? 1e-3 : 0,
                                  1e-11, 1e-3);
            pg_free (u), pg_free (value);
            unbonded (&b);
        }
}

/* A body cut in two: no force and no entry of K across, and the parts move freely. */
static void test_cut (void **unused)
{
    (void) unused;
    bonded b = bonded_of (BODY2 "method: {force: bond}\ncracks: [{from: [0.45, -0.1], to: [0.45, 0.8]}]\n");
    double *d = pg_calloc (b.ndof, sizeof *d), *r = pg_calloc (b.ndof, sizeof *r), reference;
    for (size_t i = 0; i < b.n; i++)
        d[2 * i] = b.problem->cloud.x[2 * i] < 0.45 ? 0 : 0.25,
              d[2 * i + 1] = b.problem->cloud.x[2 * i] < 0.45 ? 0 : -0.5;
    check_ok (b.force->balance (b.self, 0, d, r, &reference));
    assert_true (reference == 0);
    check_ok (pg_force_assemble (b.force, b.self, NULL));
    const pg_sparse *K = pg_force_matrix (b.force, b.self);
    size_t across = 0;
    for (size_t j = 0; j < b.ndof; j++)
        for (long q = K->start[j]; q < K->start[j + 1]; q++) {
            if ((b.problem->cloud.x[j / 2 * 2] < 0.45)
                == (b.problem->cloud.x[(size_t) K->row[q] / 2 * 2] < 0.45))
                continue;
            across++;
            assert_true (K->value[q] == 0);
        }
    assert_true (across > 0);
    pg_census left = { 0 };
    check_ok (b.force->census (b.self, &left));
    assert_int_equal (left.isolated, 0), assert_int_equal (left.fragments, 1);
    double *damage = pg_calloc (6 * b.n, sizeof *damage);
    int components;
    const char *unit;
    check_ok (b.force->field (b.self, b.state, d, "damage", &components, &unit, damage));
    for (size_t i = 0; i < b.n; i++)
        assert_int_equal (damage[i] > 0, fabs (b.problem->cloud.x[2 * i] - 0.45) < 0.3);
    for (size_t i = 0; i < b.n; i++)
        d[2 * i] = b.problem->cloud.x[2 * i] < 0.45 ? 0 : -0.03, d[2 * i + 1] = 0;
    check_relative (overlap_of (&b, d), 0.03, 1e-9);
    pg_free (d), pg_free (r), pg_free (damage);
    unbonded (&b);
}

/* What a support does to a body that is pulled: it pulls, the one above upwards. */
static void test_reactions (void **unused)
{
    (void) unused;
    static const char *const forces[] = { "bond", "lps", "gmpd" };
    for (int k = 0; k < 3; k++) {
        char text[1000];
        snprintf (text, sizeof text,
                  BODY2 "method: {force: %s}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: "
                        "top, displacement: {y: 7e-4}}]\n",
                  forces[k]);
        bonded b = bonded_of (text);
        double *d = pg_calloc (b.ndof, sizeof *d), area = 0.2, exact = 10 * 1e-3 * area;
        pg_work_balance out = { 0 };
        for (size_t i = 0; i < b.n; i++)
            d[i * b.stride] = -1e-3 / 3 * b.problem->cloud.x[2 * i],
                  d[i * b.stride + 1] = 1e-3 * b.problem->cloud.x[2 * i + 1];
        check_ok (b.force->work (b.self, 1, d, NULL, &out));
        /* the outermost row of those that bear it */
        assert_true (out.reaction[4] > 0.1 * exact && out.reaction[4] < exact);
        check_relative (out.reaction[1], -out.reaction[4], 1e-9);
        double work = 0;
        for (size_t i = 0; i < out.npair; i++) work += out.force[i] * out.displacement[i];
        check_relative (work, 7e-4 * out.reaction[4], 1e-9);
        pg_work_balance_clear (&out);
        pg_free (d);
        unbonded (&b);
    }
}

/* What all supports prescribe at once is what each does by itself, bit by bit: loads that are a pattern times
 * a factor of t, a ramp by a table, one that is no such product, and two loads that prescribe a component of
 * the same points each. */
static void test_prescribed (void **unused)
{
    (void) unused;
    bonded b = bonded_of (
        BODY2 "method: {force: bond}\nboundary: [{set: bottom, displacement: {x: 1e-3 * y + 2e-3 * x}, ramp: "
              "t^2}, {set: bottom, displacement: {y: 3e-3}, table: [[0, 0], [0.5, 1], [1, 0.2]]}, {set: top, "
              "displacement: {x: 1e-3 * x * t, y: 1e-3 * sin (3 * t)}}]\n");
    const pg_problem *p = b.problem;
    double *d = pg_calloc (b.ndof, sizeof *d), *r = pg_calloc (b.ndof, sizeof *r);
    pg_work_balance out = { 0 };
    for (int step = 0; step <= 7; step++) {
        double t = step / 7.0;
        size_t pair = 0, prescribed = 0;
        for (size_t i = 0; i < b.ndof; i++) d[i] = NAN;
        b.force->impose (b.self, t, d);
        check_ok (b.force->work (b.self, t, r, NULL, &out));
        for (size_t i = 0; i < b.ndof; i++) {
            const double *x = p->cloud.x + i / 2 * 2;
            int load = x[1] < 1e-6 ? (int) (i % 2) : x[1] > 0.7 - 1e-6 ? 2 : -1;
            if (load < 0) {
                assert_true (isnan (d[i]));
                continue;
            }
            double one = pg_load_value (&p->boundary.load[load], (int) (i % 2), 2, x, t);
            assert_memory_equal (&d[i], &one, sizeof one);
            assert_memory_equal (&out.displacement[pair], &one, sizeof one);
            pair++, prescribed += one != 0;
        }
        assert_true (pair == 4 * 11 && (step == 0 || prescribed > 30));
    }
    pg_work_balance_clear (&out);
    pg_free (d), pg_free (r);
    unbonded (&b);
}

/* Constants of bonds that points with all their bonds share are those of each point by itself: the same
 * stress and damage with and without, bit by bit, also after bonds have broken. */
static void test_shared_constants (void **unused)
{
    (void) unused;
    static const char *const volumes[] = { "overlap", "none" };
    for (int k = 0; k < 2; k++) {
        char text[1000];
        double *value[2], *damage[2];
        for (int plain = 0; plain < 2; plain++) {
            snprintf (text, sizeof text,
                      BODY2 "lattice: cells\nmethod: {force: bond, horizon: 3.015 spacing, "
                            "partial_volume: %s}\n"
                            "solver: {plain: %s}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}]\n",
                      volumes[k], plain ? "yes" : "no");
            bonded b = bonded_of (text);
            double *d = random_vector (b.ndof, 5);
            const char *unit;
            int components;
            assert_int_equal (b.problem->plain, plain);
            for (size_t e = 0; e < b.state->nbond; e += 37) b.state->alive[e] = 0;
            check_ok (b.force->refresh (b.self, b.state, NULL));
            value[plain] = pg_calloc (3 * b.n, sizeof **value);
            damage[plain] = pg_calloc (b.n, sizeof **damage);
            check_ok (b.force->field (b.self, b.state, d, "stress", &components, &unit, value[plain]));
            check_ok (b.force->field (b.self, b.state, d, "damage", &components, &unit, damage[plain]));
            if (plain) {
                assert_memory_equal (value[0], value[1], 3 * b.n * sizeof **value);
                assert_memory_equal (damage[0], damage[1], b.n * sizeof **damage);
            }
            pg_free (d);
            unbonded (&b);
        }
        pg_free (value[0]), pg_free (value[1]), pg_free (damage[0]), pg_free (damage[1]);
    }
}

/* omega_max^2 is not above the bound, and Gershgorin's row sums are above it too. */
static void test_bound (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        double *x = random_vector (b.ndof, 11), *y = pg_calloc (b.ndof, sizeof *y),
               *m = pg_calloc (b.ndof, sizeof *m), omega, top = 0;
        const pg_operator *op = b.force->operator_ (b.self);
        check_ok (b.force->motion.bound (b.self, &omega));
        check_ok (b.force->mass (b.self, m, NULL));
        for (int it = 0; it < 400; it++) {
            op->apply (op->context, x, y);
            double size = 0;
            for (size_t i = 0; i < b.ndof; i++) y[i] /= m[i], size = fmax (size, fabs (y[i]));
            for (size_t i = 0; i < b.ndof; i++) x[i] = y[i] / size;
            top = size;
        }
        top = sqrt (top);
        check_below (top, omega * (1 + 1e-9));
        check_below (omega, 1.5 * top);                /* A4: 1.86412 / 1.57727 in a large body */
        pg_free (x), pg_free (y), pg_free (m);
        unbonded (&b);
    }
}

/* Points that have all their bonds share a block, and those in a row an eigenvalue: the bound of every point
 * for itself, to the bit. */
static void test_shared_bound (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        double omega[2];
        for (int plain = 0; plain < 2; plain++) {
            bonded b = bonded_of (bodies[k]);
            b.problem->plain = plain;
            check_ok (b.force->motion.bound (b.self, &omega[plain]));
            unbonded (&b);
        }
        assert_true (omega[0] > 0 && omega[0] == omega[1]);
    }
}

/* The answer does not depend on threads. */
static void test_threads (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded a = bonded_with (bodies[k], 1, 0, NULL), b = bonded_with (bodies[k], 3, 0, NULL);
        double *d = random_vector (a.ndof, 3), *r = pg_calloc (6 * a.ndof, sizeof *r),
               *s = pg_calloc (6 * a.ndof, sizeof *s);
        static const char *const names[] = { "damage", "strain", "stress", "velocity" };
        check_ok (a.force->balance (a.self, 0, d, r, NULL));
        check_ok (b.force->balance (b.self, 0, d, s, NULL));
        assert_memory_equal (r, s, a.ndof * sizeof *r);
        for (int f = 0; f < 4; f++) {
            int components;
            const char *unit;
            check_ok (a.force->field (a.self, a.state, d, names[f], &components, &unit, r));
            check_ok (b.force->field (b.self, b.state, d, names[f], &components, &unit, s));
            assert_memory_equal (r, s, a.n * (size_t) components * sizeof *r);
        }
        check_ok (pg_force_assemble (a.force, a.self, NULL));
        check_ok (pg_force_assemble (b.force, b.self, NULL));
        const pg_sparse *A = pg_force_matrix (a.force, a.self), *B = pg_force_matrix (b.force, b.self);
        assert_memory_equal (A->value, B->value, (size_t) A->start[a.ndof] * sizeof *A->value);
        pg_free (d), pg_free (r), pg_free (s);
        unbonded (&a), unbonded (&b);
    }
}

/* Products with the stiffness follow what a march breaks, also where they have loops of their own (finite
 * stretch): those of a force made from the same alive bits. */
static void test_products_after_breaking (void **unused)
{
    (void) unused;
    static const char *const stretches[] = { "linear", "finite" };
    for (int k = 0; k < 2; k++) {
        char text[1000];
        snprintf (
            text, sizeof text,
            "%smethod: {force: bond, stretch: %s}\nfailure: {criterion: stretch, critical_stretch: 1e-3}\n",
            BODY2, stretches[k]);
        bonded a = bonded_of (text), b = bonded_of (text);
        double *d = random_vector (a.ndof, 3), *x = random_vector (a.ndof, 4),
               *y = pg_calloc (3 * a.ndof, sizeof *y), reference;
        pg_changes broken = { 0 };
        const pg_operator *A = a.force->operator_ (a.self), *B = b.force->operator_ (b.self);
        for (size_t i = 0; i < a.ndof; i++) d[i] *= 3e-4;
        A->apply (A->context, x, y);
        check_ok (a.force->motion.balance_and_break (a.self, 0, d, y, &reference, &broken));
        assert_true (broken.n > 10 && broken.n < a.state->nbond / 2);
        for (size_t n = 0; n < broken.n; n++) b.state->alive[broken.bond[n]] = 0;
        check_ok (b.force->refresh (b.self, b.state, NULL));
        A->apply (A->context, x, y), B->apply (B->context, x, y + a.ndof);
        for (size_t i = 0; i < a.ndof; i++) check_scaled (y[i], y[a.ndof + i], 1e-14, size_of (a.ndof, y));
        pg_free (d), pg_free (x), pg_free (y), pg_free (broken.bond);
        unbonded (&a), unbonded (&b);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (test_matrix),
                                        cmocka_unit_test (test_partial_assembly),
                                        cmocka_unit_test (test_rigid),
                                        cmocka_unit_test (test_hydrostatic),
                                        cmocka_unit_test (test_cut),
                                        cmocka_unit_test (test_reactions),
                                        cmocka_unit_test (test_prescribed),
                                        cmocka_unit_test (test_shared_constants),
                                        cmocka_unit_test (test_bound), cmocka_unit_test (test_shared_bound),
                                        cmocka_unit_test (test_threads),
                                        cmocka_unit_test (test_products_after_breaking) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
