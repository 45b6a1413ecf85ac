/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar bonds with an energy of the dilatation beside them: any Poisson's ratio. Balance, symmetry, no
 * negative energy, exact dilatation, the same bits where nothing is left for it, what a cut takes, time
 * steps, threads, failures of memory, refusals. */
#include "bond.h"
#include "mechanics/bonds/micropolar.h"
#include "scene_runs/run.h"
#include "method/spectrum.h"
#include <stdlib.h>

#define GMPD(more) "method: {force: gmpd, volumetric: on" more "}\n"
#define TWO \
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1, 0.7]}}}]\nspacing: " \
    "0.1\nlattice: cells\n" \
    "materials: {soft: {youngs_modulus: 10, poissons_ratio: 0.4, density: 3}, hard: {youngs_modulus: 30, " \
    "poissons_ratio: 0.15, density: 5}}\n" \
    "blocks: [{material: soft, where: x < 0.5}, {material: hard, where: x >= 0.5}]\n"
static const char *const bodies[] = {
    BODY2_OF ("0.45") GMPD (""),
    BODY3_OF ("0.4") GMPD (", beam: timoshenko, shear_parameter: 0.5"),
    TWO GMPD (""),
    BODY3_OF ("0.45") "perturb: {amount: 0.2}\n" GMPD (", bond_poisson: 0"),
    BODY2_OF ("0.4") "perturb: {amount: 0.3}\n" GMPD (", horizon: 4.2 spacing, surface_correction: volume"),
    BODY2_OF ("0.4") "lattice: cells\ncracks: [{from: [0.5, -0.1], to: [0.5, 0.4]}]\n" GMPD (
        ", weighted_volume: live"),
    BODY2_OF ("0.4") "lattice: cells\ncracks: [{from: [0.5, -0.1], to: [0.5, 0.4]}]\n" GMPD (
        ", horizon: 4.2 spacing, surface_correction: product"),
    BODY3_OF ("0.4") GMPD (", bond_poisson: 0.25")
};
enum { BODIES = sizeof bodies / sizeof *bodies };

/* ---- forces -------------------------------------------------------------------------------------------- */
/* Forces of any state, bonds broken, add up to nothing, and so do moments; a rigid turn makes none. */
static void test_balance (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        pg_changes c = kill_some (&b, 4);
        double *d = random_vector (b.ndof, 5), *f = pg_calloc (b.ndof, sizeof *f), sum[3] = { 0 },
               moment[3] = { 0 }, size = 0, h = b.problem->cloud.h, H[9] = { 0 };
        check_ok (b.force->balance (b.self, 0, d, f, NULL));
        for (size_t i = 0; i < b.n; i++) {
            const double *x = b.problem->cloud.x + i * b.dim, *own = f + i * b.stride;
            for (size_t a = 0; a < b.dim; a++) sum[a] += own[a], size += fabs (own[a]);
            if (b.dim == 2) moment[2] += x[0] * own[1] - x[1] * own[0] + own[2] * h;
            for (size_t a = 0; b.dim == 3 && a < 3; a++)
                moment[a] += x[(a + 1) % 3] * own[(a + 2) % 3] - x[(a + 2) % 3] * own[(a + 1) % 3]
                             + own[3 + a] * h;
        }
        for (size_t a = 0; a < 3; a++)
            check_scaled (sum[a], 0, 1e-13, size), check_scaled (moment[a], 0, 1e-13, size);
        H[1] = 1, H[b.dim] = -1;
        double *turn = linear_field (&b, H), largest = 0;
        check_ok (b.force->balance (b.self, 0, turn, f, NULL));
        for (size_t i = 0; i < b.ndof; i++) largest = fmax (largest, fabs (f[i]));
        check_scaled (largest, 0, 1e-13, size / (double) b.n);
        pg_free (d), pg_free (f), pg_free (c.bond), pg_free (turn);
        unbonded (&b);
    }
}

/* Forces are minus the gradient of the energy; x.Ky = y.Kx; the diagonal is that of K; row sums bound it. */
static void check_operator (bonded *b)
{
    double *x = random_vector (b->ndof, 7), *y = random_vector (b->ndof, 8),
           *Kx = pg_calloc (b->ndof, sizeof *x), *Ky = pg_calloc (b->ndof, sizeof *x);
    double *D = pg_calloc (b->ndof, sizeof *D), *sum = pg_calloc (b->ndof, sizeof *sum), top = 0, up[2], W,
           *shifted = pg_calloc (b->ndof, sizeof *shifted);
    const pg_operator *K = b->force->operator_ (b->self);
    pg_work_balance work_balance = { 0 };
    K->apply (K->context, x, Kx), K->apply (K->context, y, Ky);
    check_scaled (product (b->ndof, x, Ky), product (b->ndof, y, Kx), 1e-13,
                  size_of (b->ndof, x) * size_of (b->ndof, Ky));
    check_ok (b->force->work (b->self, 0, x, NULL, &work_balance));
    W = work_balance.strain;
    check_relative (W, 0.5 * product (b->ndof, x, Kx), 1e-12);
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < b->ndof; i++) shifted[i] = x[i] + (k ? -1e-3 : 1e-3) * y[i];
        check_ok (b->force->work (b->self, 0, shifted, NULL, &work_balance));
        up[k] = work_balance.strain;
    }
    check_scaled ((up[0] - up[1]) / 2e-3, product (b->ndof, y, Kx), 1e-8, W);
    K->diagonal (K->context, D);
    for (size_t i = 0; i < b->ndof; i += 13) {
        memset (y, 0, b->ndof * sizeof *y);
        y[i] = 1;
        K->apply (K->context, y, Ky);
        check_scaled (D[i], Ky[i], 1e-11, 1e-6 * D[0]);
    }
    check_ok (b->force->motion.row_sums (b->self, sum));
    for (int it = 0; it < 200; it++) {
        K->apply (K->context, x, Kx);
        top = 0;
        for (size_t i = 0; i < b->ndof; i++)
            Kx[i] = sum[i] > 0 ? Kx[i] / sum[i] : 0, top = fmax (top, fabs (Kx[i]));
        for (size_t i = 0; i < b->ndof; i++) x[i] = Kx[i] / top;
    }
    check_below (top, 1 + 1e-9);
    pg_work_balance_clear (&work_balance);
    pg_free (x), pg_free (y), pg_free (Kx), pg_free (Ky), pg_free (D), pg_free (sum), pg_free (shifted);
}

static void test_operator (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        bonded b = bonded_of (bodies[k]);
        check_operator (&b);
        pg_changes c = kill_some (&b, 5);
        assert_true (c.n > b.n);
        check_operator (&b);
        assert_null (pg_force_matrix (b.force, b.self));
        pg_free (c.bond);
        unbonded (&b);
    }
}

/* Rows for preconditioners: symmetric, of no negative energy, and inside a body those of K for strains that
 * vary slowly. */
static double *dense_rows (bonded *b)
{
    size_t m = b->stride, n = b->ndof;
    pg_couplings c;
    check_ok (b->force->spares.couplings (b->self, &c));
    double *A = pg_calloc (n * n, sizeof *A), *value = pg_calloc (c.widest * m * m, sizeof *value);
    int *node = pg_calloc (c.widest, sizeof *node), *pattern = pg_calloc (c.widest, sizeof *node);
    for (size_t i = 0; i < b->n; i++) {
        size_t count = c.row (c.context, i, 0, node, value);
        assert_int_equal (c.row (c.context, i, 0, pattern, NULL), count);
        assert_memory_equal (pattern, node, count * sizeof *node);
        for (size_t e = 0; e < count; e++)
            for (size_t a = 0; a < m; a++)
                for (size_t k = 0; k < m; k++)
                    A[(i * m + a) * n + (size_t) node[e] * m + k] = value[(e * m + a) * m + k];
    }
    pg_free (value), pg_free (node), pg_free (pattern);
    return A;
}

static void test_rows (void **unused)
{
    (void) unused;
    static const char *const more[] = {
        BODY2_OF ("0.45") "method: {force: lps, horizon: 4 spacing}\n",
        BODY2_OF ("0.45") "lattice: cells\nmethod: {force: lps, horizon: 2 spacing, weighted_volume: live}\n"
    };
    for (size_t k = 0; k < BODIES + 2; k++)
        for (int cut = 0; cut < 2; cut++) {
            bonded b = bonded_of (k < BODIES ? bodies[k] : more[k - BODIES]);
            pg_changes c = { 0 };
            if (b.ndof > 700) {                        /* too many for all eigenvalues */
                unbonded (&b);
                continue;
            }
            if (cut) c = kill_some (&b, 9);
            double *A = dense_rows (&b), *lambda = pg_calloc (b.ndof, sizeof *lambda), size = 0;
            for (size_t i = 0; i < b.ndof; i++) size = fmax (size, A[i * b.ndof + i]);
            for (size_t i = 0; i < b.ndof; i++)
                for (size_t j = 0; j < i; j++)
                    check_scaled (A[i * b.ndof + j], A[j * b.ndof + i], 1e-13, size);
            eigenvalues (b.ndof, A, lambda);
            check_below (-lambda[0], 1e-13 * lambda[b.ndof - 1]);
            pg_free (A), pg_free (lambda), pg_free (c.bond);
            unbonded (&b);
        }
    bonded b = bonded_of ("dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [21, "
                          "21]}}}]\nspacing: 1\nlattice: cells\n"
                          "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.45, density: 3}}\n" GMPD (
                              ", horizon: 3 spacing"));
    double *A = dense_rows (&b), *d = pg_calloc (b.ndof, sizeof *d), *f = pg_calloc (b.ndof, sizeof *f),
           sum = 0, M = 10 * 0.55 / (1.45 * 0.1);
    size_t middle = b.n / 2;
    for (size_t i = 0; i < b.n; i++) d[3 * i] = 0.5 * b.problem->cloud.x[2 * i] * b.problem->cloud.x[2 * i];
    check_ok (b.force->balance (b.self, 0, d, f, NULL));
    for (size_t j = 0; j < b.ndof; j++) sum -= A[3 * middle * b.ndof + j] * d[j];
    check_relative (f[3 * middle], M, 1e-3);               /* (lambda + 2 mu) d2u/dx2 */
    check_relative (sum, M, 1e-3);
    pg_free (A), pg_free (d), pg_free (f);
    unbonded (&b);
}

/* No negative energy, whole or with broken bonds; only rigid motions have none. */
static void test_positive (void **unused)
{
    (void) unused;
    static const char *const text[] = {
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [4, 4, 3]}}}]\nspacing: 1\nlattice: cells\n"
        "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.4, density: 3}}\n" GMPD (
            ", horizon: 3 spacing"),
        "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [9, 7]}}}]\nspacing: "
        "1\nlattice: cells\n"
        "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.45, density: 3}}\n" GMPD (
            ", horizon: 3 spacing, weighted_volume: live")
    };
    for (int k = 0; k < 2; k++) {
        bonded b = bonded_of (text[k]);
        const pg_operator *K = b.force->operator_ (b.self);
        double *A = pg_calloc (b.ndof * b.ndof, sizeof *A), *lambda = pg_calloc (b.ndof, sizeof *lambda),
               *unit = pg_calloc (b.ndof, sizeof *unit);
        for (int cut = 0; cut < 2; cut++) {
            pg_changes c = { 0 };
            if (cut) c = kill_some (&b, 3);
            for (size_t j = 0; j < b.ndof; j++) {
                unit[j] = 1;
                K->apply (K->context, unit, A + j * b.ndof);
                unit[j] = 0;
            }
            eigenvalues (b.ndof, A, lambda);
            assert_int_equal (count_zero (b.ndof, lambda, 1e-12), b.dim == 3 ? 6 : 3);
            check_below (-lambda[0], 1e-13 * lambda[b.ndof - 1]);
            print_message ("%s, %s: eigenvalues from %.3g to %.3g, the first after rigid motions %.4g\n",
                           k ? "plane strain, nu 0.45" : "solid, nu 0.4",
                           cut ? "a third of the bonds broken" : "whole", lambda[0], lambda[b.ndof - 1],
                           lambda[b.dim == 3 ? 6 : 3]);
            pg_free (c.bond);
        }
        pg_free (A), pg_free (lambda), pg_free (unit);
        unbonded (&b);
    }
}

/* ---- uniform strain ------------------------------------------------------------------------------------ */
static pg_bond_loop *sweep_of (const bonded *b, double **room)
{
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    double *c = *room = pg_calloc (5 * b->n, sizeof *c), E, nu, A;
    static pg_beam_law law;
    pg_beam_sums sums;
    pg_bond_loop *sweep;
    check_ok (pg_beam_measure (&sums, p->sums));
    for (size_t i = 0; i < b->n; i++) {
        micropolar_split (p, &p->material[0], &E, &nu, &A);
        check_ok (pg_beam_moduli (&c[i], &c[b->n + i], p->mode, rule->kernel, rule->horizon, E, nu,
                                  p->cloud.thickness));
        c[i] *= p->sums->calibration, c[b->n + i] *= sums.calibration;
        c[2 * b->n + i] = ((const micropolar_options *) p->options)->bending * c[b->n + i];
        c[3 * b->n + i] = A;
    }
    law = (pg_beam_law) { .shear = c + b->n, .bending = c + 2 * b->n, .length = p->cloud.h };
    pg_bond_loop_setting s = { .sums = p->sums,
                               .family = &p->bonds.rows[PG_NODES].family,
                               .modulus = c,
                               .dilation = c + 3 * b->n,
                               .deviation = c + 4 * b->n,
                               .beams = &law,
                               .threads = 1 };
    check_ok (pg_bond_loop_create (&sweep, &s));
    return sweep;
}

/* Energy density of a uniform strain at the point in the middle over that of the material, and how far off
 * the stress there is. */
static double strained (bonded *b, const double *H, double *worst)
{
    static const int voigt[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } };
    double *u = linear_field (b, H), *room, *W = pg_calloc (b->n, sizeof *W), energy = 0, largest = 0, v[3],
           s[6], exact[6];
    const pg_cloud *cloud = &b->problem->cloud;
    pg_bond_loop *sweep = sweep_of (b, &room);
    size_t middle = 0;
    for (size_t i = 0; i < b->n; i++) {
        double far[2] = { 0 };
        for (int k = 0; k < 2; k++)
            for (size_t a = 0; a < b->dim; a++)
                far[k] = fmax (far[k], fabs (cloud->x[(k ? middle : i) * b->dim + a]
                                             - 0.5 * (cloud->low[a] + cloud->high[a])));
        if (far[0] < far[1] - 1e-9 * cloud->h) middle = i;
    }
    check_ok (pg_bond_loop_energies (sweep, u, W));
    check_ok (b->force->sample (b->self, b->state, u, 1, cloud->x + middle * b->dim, v, s, NULL));
    pg_stress_of_gradient (b->problem->material, (int) b->dim, H, exact);
    for (size_t a = 0; a < b->dim; a++)
        for (size_t c = 0; c < b->dim; c++) energy += 0.5 * exact[voigt[a][c]] * H[a * b->dim + c];
    *worst = 0;
    for (int c = 0; c < 6; c++) largest = fmax (largest, fabs (exact[c]));
    for (int c = 0; c < 6; c++) *worst = fmax (*worst, fabs (s[c] - exact[c]) / largest);
    double ratio = W[middle] / energy;
    pg_bond_loop_free (&sweep);
    pg_free (u), pg_free (room), pg_free (W);
    return ratio;
}

/* Dilatation is exact on a lattice, whatever the ratios, and so is the mean of the shears; how far these are
 * apart depends on the bonds' ratio alone, and is least where it is by itself (0.2; plane stress 0.25). */
static void test_uniform (void **unused)
{
    (void) unused;
    static const char *const plane[] = { "dimension: 2\nplane: stress\nthickness: 0.2\n",
                                         "dimension: 2\nplane: strain\nthickness: 0.2\n", "dimension: 3\n" };
    static const double apart_of[][3] = { { 0.0565, 0.01619, 0.00276 },
                                          { 0.0565, 0.00276, 0.02412 },
                                          { 0.03385, 0.00417, 0.01067 } };
    static const char *const nu[] = { "0.3", "0.4", "0.45" }, *const bonds[] = { "0", "0.2", "0.25" };
    for (int p = 0; p < 3; p++)
        for (int k = 0; k < 3; k++)
            for (int w = 0; w < 3; w++) {
                char text[700];
                double off, shear[9] = { 0 }, hydro[9] = { 0 }, pull[9] = { 0 }, turn[9] = { 0 };
                snprintf (text, sizeof text,
                          "%sbody: [{add: {box: {low: [%s], high: [%s]}}}]\nspacing: 0.1\nlattice: "
                          "cells\nmaterials: {rock: {youngs_modulus: 10, poissons_ratio: %s, density: 3}}\n"
                          "method: {force: gmpd, volumetric: on, bond_poisson: %s, horizon: 3.015 spacing}\n",
                          plane[p], p < 2 ? "0, 0" : "0, 0, 0", p < 2 ? "0.9, 0.7" : "0.7, 0.7, 0.7", nu[k],
                          bonds[w]);
                bonded b = bonded_of (text);
                for (size_t a = 0; a < b.dim; a++) hydro[a * b.dim + a] = 1e-3;
                shear[1] = shear[b.dim] = 1e-3, pull[0] = 1e-3, turn[0] = 1e-3, turn[b.dim + 1] = -1e-3;
                check_relative (strained (&b, hydro, &off), 1, 1e-12);
                check_below (off, 1e-12);
                double a = strained (&b, shear, &off), worst = off, c = strained (&b, turn, &off),
                       e = strained (&b, pull, &off);
                worst = fmax (worst, off);
                double mean = p < 2 ? 0.5 * (a + c) : 0.6 * a + 0.4 * c,
                       apart = fmax (fabs (a - 1), fabs (c - 1));
                check_relative (mean, 1, 1e-12);
                check_scaled (apart, apart_of[p][w], 2e-5, 1);
                check_below (fabs (e - 1), 0.55 * apart);
                check_below (worst, 1.01 * apart);
                unbonded (&b);
            }
}

/* ---- where nothing is left for the dilatation ---------------------------------------------------------- */
/* The bonds' own ratio that of the material: forces, energies and limits are those without, bit by bit. */
static void test_nothing_left (void **unused)
{
    (void) unused;
    static const char *const methods[] = { "{force: gmpd}",
                                           "{force: gmpd, volumetric: on, bond_poisson: 0.15}",
                                           "{force: gmpd, volumetric: on}" };
    for (int dim = 2; dim <= 3; dim++) {
        bonded b[3];
        double *f[3], energy[3], bound[3];
        for (int k = 0; k < 3; k++) {
            char text[900];
            snprintf (text, sizeof text,
                      "%smethod: %s\nfailure: {criterion: beam_limits, fracture_energy: 1}\n",
                      dim == 2 ? BODY2_OF ("0.15") : BODY3_OF ("0.15"), methods[k]);
            b[k] = bonded_of (text);
            double *d = random_vector (b[k].ndof, 3);
            pg_changes c = kill_some (&b[k], 7);
            pg_work_balance work_balance = { 0 };
            f[k] = pg_calloc (b[k].ndof, sizeof **f);
            check_ok (b[k].force->balance (b[k].self, 0, d, f[k], NULL));
            check_ok (b[k].force->work (b[k].self, 0, d, NULL, &work_balance));
            check_ok (b[k].force->motion.bound (b[k].self, &bound[k]));
            energy[k] = work_balance.strain;
            assert_memory_equal (f[k], f[0], b[k].ndof * sizeof **f);
            assert_true (energy[k] == energy[0] && bound[k] == bound[0]);
            assert_memory_equal (b[k].problem->criterion->parameter, b[0].problem->criterion->parameter,
                                 4 * sizeof (double));
            pg_work_balance_clear (&work_balance), pg_free (d), pg_free (c.bond);
        }
        for (int k = 0; k < 3; k++) pg_free (f[k]), unbonded (&b[k]);
    }
}

/* ---- breaking ------------------------------------------------------------------------------------------ */
/* Energy per area that all bonds across a plane have at stretch s, those of a column of points on either
 * side, and the dilatation of these points. */
static double cut_energy (const bonded *b, int axis, double s)
{
    const pg_problem *p = b->problem;
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    const double *x = p->cloud.x, h = p->cloud.h;
    double E, nu, A, axial, shear, sum = 0, weight[400], *all = pg_calloc (400 * 3, sizeof *all),
                                   *q = pg_calloc (b->n, sizeof *q), *room;
    pg_bond_loop *sweep = sweep_of (b, &room);
    micropolar_split (p, &p->material[0], &E, &nu, &A);
    check_ok (pg_beam_moduli (&axial, &shear, p->mode, p->sums->rule.kernel, p->sums->rule.horizon, E, nu,
                              p->cloud.thickness));
    check_ok (pg_bond_loop_dilatation (sweep, NULL, NULL, q));
    for (size_t i = 0; i < b->n; i++) {
        int column = 1;
        double beyond = 0;
        for (size_t a = 0; a < b->dim; a++) {
            double middle = 0.5 * (p->cloud.low[a] + p->cloud.high[a]), far = x[i * b->dim + a] - middle;
            column &= (int) a == axis ? fabs (far) < p->sums->rule.horizon + h : fabs (far) < 0.3 * h;
        }
        if (!column) continue;
        pg_sums_bonds (p->sums, f, i, all, weight, NULL);
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
            const double *xi = all + (e - f->start[i]) * b->dim,
                         plane = 0.5 * (p->cloud.low[axis] + p->cloud.high[axis]) + 0.5 * h;
            double r = 0, V = p->cloud.volume[f->node[e]] * weight[e - f->start[i]];
            if ((x[i * b->dim + (size_t) axis] < plane)
                == (x[(size_t) f->node[e] * b->dim + (size_t) axis] < plane))
                continue;
            for (size_t a = 0; a < b->dim; a++) r += xi[a] * xi[a];
            r = sqrt (r);
            sum += 0.25 * p->sums->calibration * axial * r * s * s * V * p->cloud.volume[i];
            beyond += V * r * s;                       /* w xi.eta, w = k beta / r */
        }
        double theta = p->dim / q[i] * beyond;
        sum += 0.5 * A / p->dim * theta * theta * p->cloud.volume[i];
    }
    double area = p->cloud.volume[0] / h;
    pg_bond_loop_free (&sweep);
    pg_free (all), pg_free (q), pg_free (room);
    return sum / area;
}

/* Bonds at s0 and the dilatation that they make take G0 together, and so by theory where points are not
 * calibrated. */
static void test_fracture_energy (void **unused)
{
    (void) unused;
    static const char *const body[] = {
        ("dimension: 2\nplane: stress\nbody: [{add: {box: {low: [0, 0], high: [1.7, 1.7]}}}]\nthickness: "
         "0.2\n"),
        "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1.7, 1.7]}}}]\n",
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.7, 1.7, 1.7]}}}]\n"
    };
    for (int w = 0; w < 3; w++)
        for (int k = 0; k < 3; k++) {
            char text[1000];
            snprintf (text, sizeof text,
                      "%sspacing: 0.1\nlattice: cells\nmaterials: {rock: {youngs_modulus: 10, "
                      "poissons_ratio: 0.4, density: 3}}\n"
                      "failure: {criterion: %s, fracture_energy: 0.7, calibration: theory}\n"
                      "method: {force: gmpd, volumetric: on, horizon: %s}\n",
                      body[w], k == 1 ? "stretch" : "beam_limits", k ? "3 spacing" : "3.015 spacing");
            bonded b = bonded_of (text);
            for (int axis = 0; axis < b.problem->dim; axis++)
                check_relative (cut_energy (&b, axis, b.problem->criterion->parameter[0]), 0.7, 0.01);
            unbonded (&b);
        }
}

/* What breaks in motion is what the search finds, by either loop; both parts know of it: the forces are those
 * of a force made anew. */
static void test_breaking (void **unused)
{
    (void) unused;
    for (int dim = 2; dim <= 3; dim++)
        for (int m = 0; m < 4; m++) {
            char text[1000];
            snprintf (text, sizeof text,
                      "%smethod: {force: gmpd, volumetric: on, evaluation: %s, weighted_volume: "
                      "%s}\nfailure: {criterion: beam_limits, fracture_energy: 1}\n",
                      dim == 2 ? BODY2_OF ("0.4") : BODY3_OF ("0.4"), m % 2 ? "list" : "stencil",
                      m / 2 ? "live" : "intact");
            bonded b = bonded_of (text), fresh = bonded_of (text);
            double *d = random_vector (b.ndof, 17), *f = pg_calloc (b.ndof, sizeof *f),
                   *g = pg_calloc (b.ndof, sizeof *g), *u = pg_calloc (b.state->nbond, sizeof *u), most = 0;
            pg_changes broken = { 0 };
            check_ok (b.force->judge (b.self, b.state, d, &(pg_judging){ .utilisation = u }));
            for (size_t e = 0; e < b.state->nbond; e++) most = fmax (most, u[e]);
            for (size_t i = 0; i < b.ndof; i++) d[i] *= 1.7 / most;
            check_ok (b.force->motion.balance_and_break (b.self, 0, d, f, NULL, &broken));
            size_t over = 0;
            for (size_t e = 0; e < b.state->nbond; e++) over += u[e] * 1.7 / most >= 1;
            assert_int_equal (broken.n, over);
            assert_true (over > 30 && over < b.state->nbond / 2);
            for (size_t k = 0; k < broken.n; k++)
                fresh.state->alive[broken.bond[k]] = b.state->alive[broken.bond[k]] = 0;
            check_ok (fresh.force->refresh (fresh.self, fresh.state, NULL));
            check_ok (fresh.force->balance (fresh.self, 0, d, g, NULL));
            assert_memory_equal (f, g, b.ndof * sizeof *f);
            pg_free (d), pg_free (f), pg_free (g), pg_free (u), pg_free (broken.bond);
            unbonded (&b), unbonded (&fresh);
        }
}

/* ---- time steps ---------------------------------------------------------------------------------------- */
/* The bound is one, whole and while bonds break, and not far from the largest frequency. */
static void test_bound (void **unused)
{
    (void) unused;
    for (size_t k = 0; k < BODIES; k++) {
        char text[800];
        snprintf (text, sizeof text, "%sfailure: {criterion: beam_limits, fracture_energy: 1}\n", bodies[k]);
        bonded b = bonded_of (text);
        double omega, first = largest_frequency (&b), top = first;
        check_ok (b.force->motion.bound (b.self, &omega));
        check_below (top, omega);
        for (size_t nth = 2; nth < 40; nth *= 2) {
            const pg_family *f = &b.problem->bonds.rows[PG_NODES].family;
            for (size_t i = 0; i < b.n; i++)
                for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
                    size_t j = (size_t) f->node[e], low = i < j ? i : j, high = i < j ? j : i;
                    if ((low * 7919 + high * 104729) / 3 % nth) b.state->alive[e] = 0;
                }
            check_ok (b.force->refresh (b.self, b.state, NULL));
            double now = largest_frequency (&b);
            check_below (now, omega);
            top = fmax (top, now);
        }
        print_message ("bound over largest frequency: %.3f whole, %.3f at the worst of broken\n",
                       omega / first, omega / top);
        check_below (omega, (b.problem->sums->rule.follow ? 12 : 2) * first);
        unbonded (&b);
    }
}

/* ---- solvers ------------------------------------------------------------------------------------------- */
/* A rim of two horizons that strains uniformly: so does what it encloses, by every static solver, and points
 * do not turn against it. */
static void test_patch (void **unused)
{
    (void) unused;
    static const char *const solver[] = {
        "{kind: static, tolerance: 1e-12}",
        "{kind: static, linear: pcg, preconditioner: jacobi, tolerance: 1e-12}",
        "{kind: relax, imbalance: 1e-10, stages: 1}"
    };
    for (int k = 0; k < 4; k++) {
        char text[1500];
        run r;
        if (k < 3)
            snprintf (text, sizeof text,
                      "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [2, "
                      "2]}}}]\nspacing: 0.1\nlattice: cells\n"
                      "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.45, density: 3}}\nmethod: "
                      "{force: gmpd, volumetric: on, horizon: 3 spacing}\n"
                      "sets: {rim: {where: \"x < 0.61 or x > 1.39 or y < 0.61 or y > 1.39\"}}\nboundary:\n  "
                      "- {set: rim, displacement: {x: \"2e-3 * x + 1e-3 * y\", y: \"5e-4 * x - 1e-3 * y\"}}\n"
                      "  - {set: rim, rotation: {z: -2.5e-4}}\nsolver: %s\n",
                      solver[k]);
        else
            snprintf (text, sizeof text,
                      "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.3, 1.3, 1.3]}}}]\nspacing: "
                      "0.1\nlattice: cells\n"
                      "materials: {rock: {youngs_modulus: 10, poissons_ratio: 0.4, density: 3}}\nmethod: "
                      "{force: gmpd, volumetric: on, horizon: 2 spacing}\n"
                      "sets: {rim: {where: \"x < 0.41 or x > 0.89 or y < 0.41 or y > 0.89 or z < 0.41 or z > "
                      "0.89\"}}\nboundary:\n"
                      "  - {set: rim, displacement: {x: \"2e-3 * x + 1e-3 * y\", y: \"5e-4 * x - 1e-3 * y\", "
                      "z: \"-3e-3 * z\"}}\n"
                      "  - {set: rim, rotation: {x: 0, y: 0, z: -2.5e-4}}\nsolver: %s\n",
                      solver[0]);
        r = prepare (1, text);
        to_the_end (&r);
        size_t dim = (size_t) r.problem->dim, m = dim == 2 ? 3 : 6;
        double size = 4e-3, tolerance = k == 2 ? 1e-7 : 1e-9;
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            const double *x = r.problem->cloud.x + i * dim, *d = r.state->d + i * m;
            check_scaled (d[0], 2e-3 * x[0] + 1e-3 * x[1], tolerance, size),
                check_scaled (d[1], 5e-4 * x[0] - 1e-3 * x[1], tolerance, size);
            check_scaled (d[m - 1], -2.5e-4 * r.problem->cloud.h, 10 * tolerance, size);
            if (dim == 3) check_scaled (d[2], -3e-3 * x[2], tolerance, size);
        }
        if (k == 0 || k == 3)
            check_below ((double) pg_solver_report_now (r.solver)->linear.cg_iterations, 30);
        clear (&r);
    }
}

/* Bodies that break at ratios beyond the bonds' own, event by event and in motion: to the end, the same bits
 * by any number of threads. */
static void test_runs (void **unused)
{
    (void) unused;
    static const char *const solver[] = { "{kind: static, max_events: 40}",
                                          "{kind: static, stepping: fixed, steps: 4, break: all}",
                                          "{kind: verlet, end: 3}" };
    for (int dim = 2; dim <= 3; dim++)
        for (int k = 0; k < 3; k++) {
            if (!longer () && dim == 3 && k != 1) continue;            /* short: of a solid by fixed steps */
            run r[2];
            for (int threads = 1; threads <= 2; threads++) {
                char text[1500];
                const char *load = k == 2 ? "velocity" : "displacement", *amount = k == 2 ? "0.02" : "0.06";
                snprintf (
                    text, sizeof text,
                    "%smaterials: {rock: {youngs_modulus: 10, poissons_ratio: 0.4, density: 3}}\nmethod: "
                    "{force: gmpd, volumetric: on, horizon: 3 spacing}\n"
                    "spacing: 0.1\nlattice: cells\nsets: {l: {where: x < 0.3}, r: {where: x > %s}}\nfailure: "
                    "{criterion: beam_limits, fracture_energy: 3e-4, exclude: [l, r]}\n"
                    "boundary: [{set: l, %s: {x: 0, y: 0}}, {set: r, %s: {x: %s}}]\nsolver: %s\n",
                    dim == 2
                        ? "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [2.6, "
                          "1]}}}]\ncracks: [{from: [1.3, -0.1], to: [1.3, 0.3]}]\n"
                        : "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1.2, 0.6, 0.5]}}}]\n",
                    dim == 2 ? "2.3" : "0.9", load, load, amount, solver[k]);
                r[threads - 1] = prepare (threads, text);
                to_the_end (&r[threads - 1]);
            }
            const pg_statistics *report = pg_solver_report (r[0].solver, r[0].state);
            print_message ("%dD, %s: %zu bonds broken, residual %.2g\n", dim,
                           k == 0   ? "events"
                           : k == 1 ? "fixed steps"
                                    : "motion",
                           (size_t) r[0].state->broken, report->residual_max);
            assert_true (r[0].state->broken > 30);
            if (k < 2) check_below (report->residual_max, 1e-8);
            assert_memory_equal (r[0].state->d, r[1].state->d, r[0].state->ndof * sizeof (double));
            assert_memory_equal (r[0].state->alive, r[1].state->alive, r[0].state->nbond);
            clear (&r[0]), clear (&r[1]);
        }
}

/* ---- failures ------------------------------------------------------------------------------------------ */
/* Each allocation fails once: the force says so and leaves nothing behind. */
static void test_memory (void **unused)
{
    (void) unused;
    for (int k = 0; k < 2; k++) {
        char text[600];
        snprintf (text, sizeof text,
                  "%smethod: {force: gmpd, volumetric: on, evaluation: %s}\nfailure: {criterion: "
                  "beam_limits, fracture_energy: 1}\n",
                  BODY3_OF ("0.4"), k ? "list" : "stencil");
        assert_true (fail_each_allocation (text) > 40);
    }
}

static void test_refused (void **unused)
{
    (void) unused;
    check_problem_refused (BODY3_OF ("0.4") "method: {force: gmpd}\n", "0.25");
    check_problem_refused (BODY3_OF ("0.4") "method: {force: gmpd}\n", "volumetric: on");
    check_problem_refused (BODY2_OF ("0.4") "method: {force: gmpd}\n", "0.333333");
    check_problem_refused (BODY3_OF ("0.2") "method: {force: gmpd, bond_poisson: 0.1}\n", "volumetric: on");
    check_problem_refused (BODY3_OF ("0.4") GMPD (", bond_poisson: 0.3"), "0.25");
    check_problem_refused (BODY3_OF ("0.1") GMPD (", bond_poisson: 0.2"), "at most that");
    check_problem_refused (BODY3_OF ("0.4") GMPD (", evaluation: fft"), "by FFT");
    check_problem_refused (BODY3_OF ("0.4") GMPD (", stretch: finite"), "linear");
    check_problem_refused (BODY3_OF ("0.4") GMPD ("") "solver: {linear: cholmod}\n", "no matrix");
    check_problem_refused (BODY1 GMPD (""), "one dimension");
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (test_balance),
                                        cmocka_unit_test (test_operator),
                                        cmocka_unit_test (test_rows),
                                        cmocka_unit_test (test_positive),
                                        cmocka_unit_test (test_uniform),
                                        cmocka_unit_test (test_nothing_left),
                                        cmocka_unit_test (test_fracture_energy),
                                        cmocka_unit_test (test_breaking),
                                        cmocka_unit_test (test_bound),
                                        cmocka_unit_test (test_patch),
                                        cmocka_unit_test (test_runs),
                                        cmocka_unit_test (test_memory),
                                        cmocka_unit_test (test_refused) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
