/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sums over an infinite lattice against theory A2 (printed to five digits), and symmetries of the stencil in
 * all bits. */
#include "check.h"
#include "perigal/sums.h"

static const double pi = 3.14159265358979323846;

static pg_sum_rule rule_of (int dim, const char *kernel, double m, pg_partial partial)
{
    return (pg_sum_rule){ .mode = dim == 1   ? PG_LINE
                                  : dim == 2 ? PG_PLANE_STRESS
                                             : PG_SOLID,
                          .kernel = pg_kernel_find (kernel),
                          .horizon = m,
                          .partial = partial,
                          .calibrate = 1 };
}

static void build (pg_stencil *out, const pg_sum_rule *rule, int dim, double step)
{
    check_ok (pg_stencil_build (out, rule, dim, (double[]) {step, step, step}));
}

/* C11, C12, shear modulus over those of elasticity, without calibration */
static void stiffness (const pg_stencil *s, const pg_sum_rule *rule, double *C)
{
    double D[36], D0[36], c = pg_bond_modulus (rule->mode, rule->kernel, rule->horizon, 1, 0.25);
    int nv = pg_voigt_size (s->dim), shear = s->dim == 2 ? 2 : 3;
    pg_stencil_tangent (s, s->dim == 3 ? 0.25 * c : c, s->dim == 3 ? 4 : 0.25, D);
    /* 3D knows no thickness: c of 1, D linear in both */
    if (s->dim == 3) for (int k = 0; k < 36; k++) D[k] *= 4 * 0.25;
    pg_elastic_tangent (rule->mode, 1, pg_bond_poisson (rule->mode), D0);
    C[0] = D[0] / D0[0], C[1] = D[1] / D0[1], C[2] = D[shear * nv + shear] / D0[shear * nv + shear];
}

/* theory A2's rows took k at the centre of the cell, also where overlap now takes the mean */
static void weigh_by_centres (pg_stencil *s, const pg_sum_rule *rule)
{
    for (size_t b = 0; b < s->n; b++) {
        double q = s->r[b] / rule->horizon, w;
        rule->kernel->value (1, &q, &w, NULL);
        s->weight[b] = w * s->beta[b];
    }
}

typedef struct {
    int dim;
    const char *kernel;
    double m;
    pg_partial partial;
    double C11, C12, calibration, tolerance;
} row;

/* and all else that is printed; calibration 0: none printed. Printed overlap sums are good
 * to about 5e-5 (3D 1e-4). */
static void stiffness_of_lattices_is_the_printed_one (void **state)
{
    (void) state;
    static const row rows[] = {
        { 2, "constant", 3, PG_PARTIAL_NONE, 1.05277, 1.00512, 0.96075, 1e-5 },
        { 2, "constant", 3, PG_PARTIAL_LINEAR, 1.03268, 0.98249, 0, 1e-5 },
        { 2, "constant", 3, PG_PARTIAL_OVERLAP, 1.02202, 0.98967, 0.98626, 5e-5 },
        { 2, "constant", 3.015, PG_PARTIAL_NONE, 1.03713, 0.99020, 0.97523, 1e-5 },
        { 2, "constant", 3.015, PG_PARTIAL_LINEAR, 1.03072, 0.97857, 0, 1e-5 },
        { 2, "constant", 3.015, PG_PARTIAL_OVERLAP, 1.02227, 0.98963, 0.98610, 5e-5 },
        { 2, "constant", 4, PG_PARTIAL_NONE, 0.97432, 0.92664, 1.03907, 1e-5 },
        { 2, "constant", 4, PG_PARTIAL_LINEAR, 1.01580, 1.00370, 0, 1e-5 },
        { 2, "constant", 4, PG_PARTIAL_OVERLAP, 1.01124, 0.99842, 0.99203, 5e-5 },
        { 2, "constant", 6, PG_PARTIAL_NONE, 0.99053, 1.02394, 1.00112, 1e-5 },
        { 2, "constant", 6, PG_PARTIAL_LINEAR, 1.00795, 0.99957, 0, 1e-5 },
        { 2, "constant", 6, PG_PARTIAL_OVERLAP, 1.00468, 1.00060, 0.99635, 5e-5 },
        { 2, "quadratic", 3, PG_PARTIAL_NONE, 0.95698, 0.95008, 1.04684, 1e-5 },
        { 2, "quadratic", 3, PG_PARTIAL_LINEAR, 0.94481, 0.91358, 0, 1e-5 },
        { 2, "quadratic", 3, PG_PARTIAL_OVERLAP, 0.94561, 0.91598, 1.06587, 5e-5 },
        { 2, "quadratic", 6, PG_PARTIAL_NONE, 0.99435, 0.99752, 1.00488, 1e-5 },
        { 2, "quadratic", 6, PG_PARTIAL_LINEAR, 0.98903, 0.98579, 0, 1e-5 },
        { 2, "quadratic", 6, PG_PARTIAL_OVERLAP, 0.98932, 0.98665, 1.01148, 5e-5 },
        { 3, "constant", 3, PG_PARTIAL_NONE, 1.05641, 1.21751, 0, 1e-5 },
        { 3, "constant", 3, PG_PARTIAL_LINEAR, 1.07031, 1.05004, 0, 1e-5 },
        { 3, "constant", 3, PG_PARTIAL_OVERLAP, 1.02243, 1.01099, 0, 1e-4 },
        { 3, "constant", 3.015, PG_PARTIAL_NONE, 1.03555, 1.19346, 0, 1e-5 },
        { 3, "constant", 3.015, PG_PARTIAL_OVERLAP, 1.02267, 1.01075, 0, 1e-4 },
        { 3, "constant", 4, PG_PARTIAL_NONE, 0.93428, 0.95657, 0, 1e-5 },
        { 3, "constant", 4, PG_PARTIAL_OVERLAP, 1.01168, 1.00806, 0, 1e-4 },
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const row *r = &rows[k];
        pg_sum_rule rule = rule_of (r->dim, r->kernel, r->m, r->partial);
        pg_stencil s;
        double C[3];
        build (&s, &rule, r->dim, 1);
        weigh_by_centres (&s, &rule);
        stiffness (&s, &rule, C);
        check_absolute (C[0], r->C11, r->tolerance);
        check_absolute (C[1], r->C12, r->tolerance);
        check_relative (C[2], C[1], 1e-12);                    /* Cauchy's relation */
        if (r->calibration > 0)
            check_absolute (pg_stencil_calibration (&s, &rule), r->calibration, r->tolerance);
        pg_stencil_clear (&s);
    }
}

/* The mean of a kernel over a cell in place of its value at the centre, at m = 3: stiffness nearer to
 * elasticity before calibration (broad kernels), less anisotropic after it (peaked ones). Numbers as first
 * computed here; the integrals themselves are checked below. */
static void means_of_kernels_that_vanish_are_nearer (void **state)
{
    (void) state;
    static const struct { int dim; const char *kernel; int broad; double C[4], centre[4]; } rows[] = {
        {2, "quadratic", 1, {1.02675, 0.96781, 1.01456, 0.95632}, {0.94561, 0.91598, 1.00790, 0.97631}},
        {2, "conical",   1, {1.03119, 0.95230, 1.01950, 0.94151}, {0.95731, 0.89891, 1.01549, 0.95354}},
        {2, "gaussian",  0, {1.06897, 0.83342, 1.05830, 0.82510}, {1.00798, 0.74808, 1.06890, 0.79330}},
        {3, "quadratic", 1, {1.03665, 1.00349, 1.01296, 0.98056}, {0.95715, 0.91973, 1.01589, 0.97617}},
        {3, "conical",   1, {1.04337, 0.99718, 1.01803, 0.97296}, {0.97059, 0.91715, 1.02252, 0.96622}},
        {3, "gaussian",  0, {1.11278, 0.92690, 1.07160, 0.89260}, {1.05844, 0.83822, 1.09078, 0.86383}},
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        pg_sum_rule rule = rule_of (rows[k].dim, rows[k].kernel, 3, PG_PARTIAL_OVERLAP);
        pg_stencil s;
        double C[2][3], c[2];
        build (&s, &rule, rows[k].dim, 1);
        for (int centre = 0; centre < 2; centre++) {
            if (centre) weigh_by_centres (&s, &rule);
            stiffness (&s, &rule, C[centre]);
            c[centre] = pg_stencil_calibration (&s, &rule);
            const double *printed = centre ? rows[k].centre : rows[k].C;
            for (int i = 0; i < 4; i++)
                check_absolute (i < 2 ? C[centre][i] : c[centre] * C[centre][i - 2], printed[i], 1e-5);
        }
        if (rows[k].broad) check_below (fabs (c[0] - 1), 0.5 * fabs (c[1] - 1));
        else check_below (c[0] * (C[0][0] - C[0][1]), 0.9 * c[1] * (C[1][0] - C[1][1]));
        pg_stencil_clear (&s);
    }
}

/* The integral of k over the ball without the own cell, by midpoints of 400^2 squares (3D 80^3 cubes) a
 * cell */
static void means_are_integrals (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) {
        int fine = dim == 3 ? 60 : 400;
        pg_sum_rule rule = rule_of (dim, "quadratic", 2.2, PG_PARTIAL_OVERLAP);
        pg_stencil s;
        build (&s, &rule, dim, 1);
        for (size_t b = 0; b < s.n; b++) {
            const int *o = s.offset + 3*b;
            double sum = 0, inside = 0, h = 1.0 / fine;
            if (o[0] < o[1] || o[1] < o[2] || o[2] < 0) continue;          /* the others have the same bits */
            for (int z = 0; z < (dim > 2 ? fine : 1); z++)
                for (int y = 0; y < (dim > 1 ? fine : 1); y++)
                    for (int x = 0; x < fine; x++) {
                        double at[3] = { o[0] - 0.5 + (x + 0.5) * h, dim > 1 ? o[1] - 0.5 + (y + 0.5) * h : 0,
                                         dim > 2 ? o[2] - 0.5 + (z + 0.5) * h : 0 };
                        double q2 = (at[0] * at[0] + at[1] * at[1] + at[2] * at[2]) / (2.2 * 2.2);
                        if (q2 < 1) inside += pow (h, dim), sum += (1 - q2) * pow (h, dim);
                    }
            check_absolute (s.beta[b], inside, dim == 1 ? 2e-3 : 4e-4);
            check_absolute (s.weight[b], sum, 3e-5);
        }
        pg_stencil_clear (&s);
    }
}

/* cells and ball have the ball's measure in common */
static void overlaps_add_up_to_the_ball (void **state)
{
    (void) state;
    static const double m[] = {1, 1.5, 2.5, 3, 3.015, 3.7, 5, 6.5};
    for (int dim = 1; dim <= 3; dim++)
        for (int k = 0; k < 8; k++) {
            pg_sum_rule rule = rule_of (dim, "constant", m[k], PG_PARTIAL_OVERLAP);
            pg_stencil s;
            double sum = 1;
            build (&s, &rule, dim, 1);
            for (size_t b = 0; b < s.n; b++) sum += s.beta[b];
            check_relative (sum,
                            dim == 1   ? 2 * m[k]
                            : dim == 2 ? pi * m[k] * m[k]
                                       : 4 * pi / 3 * pow (m[k], 3),
                            dim == 3 ? 1e-10 : 1e-13);
            pg_stencil_clear (&s);
            /* of cells twice as long as wide */
            check_ok (pg_stencil_build (&s, &rule, dim, (double[]) {1, 0.5, 0.75}));
            sum = 1;
            for (size_t b = 0; b < s.n; b++) sum += s.beta[b];
            check_relative (sum * s.cell,
                            dim == 1   ? 2 * m[k]
                            : dim == 2 ? pi * m[k] * m[k]
                                       : 4 * pi / 3 * pow (m[k], 3),
                            dim == 3 ? 1e-10 : 1e-13);
            pg_stencil_clear (&s);
        }
}

/* A-7, and what candidates the other partial volumes have */
static void neighbours_are_counted (void **state)
{
    (void) state;
    static const struct { int dim; double m; pg_partial partial; const char *kernel; size_t n;
    } rows[] = {
        { 2, 3.015, PG_PARTIAL_NONE, "constant", 28 }, { 3, 3.015, PG_PARTIAL_NONE, "constant", 122 },
        { 2, 3, PG_PARTIAL_NONE, "constant", 28 },     { 3, 3, PG_PARTIAL_NONE, "constant", 122 },
        { 1, 3, PG_PARTIAL_NONE, "constant", 6 },      { 2, 3, PG_PARTIAL_NONE, "quadratic", 24 },
        { 2, 3, PG_PARTIAL_LINEAR, "constant", 36 },   { 2, 3, PG_PARTIAL_OVERLAP, "constant", 44 },
        { 1, 2.5, PG_PARTIAL_OVERLAP, "constant", 4 }, { 1, 2.5, PG_PARTIAL_LINEAR, "constant", 4 },
        { 1, 0.6, PG_PARTIAL_OVERLAP, "constant", 2 },
    };
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++)
        for (double unit = 1e-3; unit < 3; unit = unit < 0.5 ? 1 : 3) {  /* metres and millimetres */
            pg_sum_rule rule = rule_of (rows[k].dim, rows[k].kernel, rows[k].m * unit, rows[k].partial);
            pg_stencil s;
            build (&s, &rule, rows[k].dim, unit);
            assert_int_equal (s.n, rows[k].n);
            pg_stencil_clear (&s);
        }
}

/* A-9 and the row beside it; 3D as first computed here */
static void a_straight_cut_takes_the_printed_energy (void **state)
{
    (void) state;
    static const struct { int dim; double m, none, overlap;
    } rows[] = { { 2, 3, 1.02614, 1.02801 }, { 2, 3.015, 1.00587, 1.02829 }, { 2, 4, 0.92900, 1.01491 },
                 { 2, 6, 0.99598, 1.00619 }, { 2, 8, 0.95899, 1.00334 },     { 3, 3, 1.14773, 1.01600 },
                 { 3, 4, 0.91326, 1.00880 } };
    for (int k = 0; k < 7; k++)
        for (int p = 0; p < 2; p++) {
            int dim = rows[k].dim;
            pg_sum_rule rule = rule_of (dim, "constant", rows[k].m, p ? PG_PARTIAL_OVERLAP : PG_PARTIAL_NONE);
            double t = dim == 3 ? 1 : 0.3, c = 2.5, s0 = 0.1,
                   G0 = pg_bond_fracture_energy (rule.mode, rule.kernel, rule.horizon, t, c, s0);
            pg_stencil s;
            build (&s, &rule, dim, 1);
            for (int axis = 0; axis < dim; axis++)
                check_absolute (pg_stencil_fracture_energy (&s, c, t, s0, axis) / G0,
                                p ? rows[k].overlap : rows[k].none, 1e-5);
            pg_stencil_clear (&s);
        }
}

/* The cut counted bond by bond on a strip of an actual lattice of rectangular cells */
static void a_cut_is_the_sum_of_its_bonds (void **state)
{
    (void) state;
    const double step[3] = {0.5, 1, 0.75}, c = 3, t = 0.2, s0 = 0.05;
    for (int dim = 1; dim <= 3; dim++)
        for (int axis = 0; axis < dim; axis++) {
            pg_sum_rule rule = rule_of (dim, "constant", 2.3, PG_PARTIAL_LINEAR);
            pg_stencil s;
            double sum = 0, thickness = dim == 3 ? 1 : t;
            check_ok (pg_stencil_build (&s, &rule, dim, step));
            for (int layer = 0; layer > -10; layer--)  /* points at and below 0, the cut at 0.5 */
                for (size_t b = 0; b < s.n; b++)
                    if (layer + s.offset[3*b + (size_t) axis] > 0)
                        sum += 0.5 * c * s.weight[b] * s.r[b] * s0 * s0 * pow (s.cell * thickness, 2);
            sum /= s.cell * thickness / step[axis];  /* the area that one point stands for */
            check_relative (pg_stencil_fracture_energy (&s, c, thickness, s0, axis), sum, 1e-13);
            pg_stencil_clear (&s);
        }
}

static size_t at (const pg_stencil *s, int x, int y, int z)
{
    for (size_t b = 0; b < s->n; b++)
        if (s->offset[3 * b] == x && s->offset[3 * b + 1] == y && s->offset[3 * b + 2] == z) return b;
    fail_msg ("no bond (%d %d %d)", x, y, z);
    return 0;
}

static void same_bits (const pg_stencil *s, size_t a, size_t b)
{
    assert_memory_equal (&s->r[a], &s->r[b], sizeof (double));
    assert_memory_equal (&s->beta[a], &s->beta[b], sizeof (double));
    assert_memory_equal (&s->weight[a], &s->weight[b], sizeof (double));
}

/* -offset, mirrored and, for equal steps, permuted; steps equal but for rounding are equal. Neighbours
 * ascend. */
static void mirrored_and_permuted_bonds_have_the_same_bits (void **state)
{
    (void) state;
    const double odd = 0.1 / 3, unequal[3] = { odd, 1.1 * odd, 0.7 * odd },
                 rounded[3] = { odd, odd * (1 + 2e-16), odd * (1 - 3e-16) };
    for (int dim = 1; dim <= 3; dim++)
        for (int p = 0; p < 3; p++)
            for (int k = 0; k < 4; k++) {
                pg_sum_rule rule = rule_of (dim, k % 2 ? "gaussian" : "inverse_r", 3.27 * odd,
                                            (pg_partial) p);
                pg_stencil s;
                check_ok (pg_stencil_build (&s, &rule, dim, k < 2 ? rounded : unequal));
                for (size_t b = 0; b < s.n; b++) {
                    int x = s.offset[3*b], y = s.offset[3*b + 1], z = s.offset[3*b + 2];
                    size_t opposite = s.n - 1 - b;
                    same_bits (&s, b, opposite);
                    assert_int_equal (s.offset[3*opposite], -x);
                    for (int d = 0; d < dim; d++)
                        assert_true (s.xi[b * (size_t) dim + (size_t) d]
                                     == -s.xi[opposite * (size_t) dim + (size_t) d]);
                    same_bits (&s, b, at (&s, -x, y, z));
                    if (k < 2 && dim == 2) same_bits (&s, b, at (&s, y, x, z));
                    if (k < 2 && dim == 3) same_bits (&s, b, at (&s, z, x, y));
                    if (b)
                        assert_true (10000 * (z - s.offset[3 * b - 1]) + 100 * (y - s.offset[3 * b - 2]) + x
                                         - s.offset[3 * b - 3]
                                     > 0);
                }
                pg_stencil_clear (&s);
            }
}

/* The same lattice in mm and in m; axes permuted */
static void numbers_do_not_depend_on_the_unit (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        pg_sum_rule big = rule_of (dim, "conical", 3.1, PG_PARTIAL_OVERLAP),
                    small = rule_of (dim, "conical", 3.1e-3, PG_PARTIAL_OVERLAP);
        pg_stencil a, b, c;
        check_ok (pg_stencil_build (&a, &big, dim, (double[]) {1, 0.8, 1.2}));
        check_ok (pg_stencil_build (&b, &small, dim, (double[]) {1e-3, 0.8e-3, 1.2e-3}));
        check_ok (pg_stencil_build (&c, &big, dim, (double[]) {0.8, 1, 1.2}));
        assert_int_equal (a.n, b.n);
        for (size_t i = 0; i < a.n; i++) {
            check_scaled (a.weight[i], b.weight[i], 1e-13, 1e-3);
            check_relative (a.r[i], 1e3 * b.r[i], 1e-14);
            size_t j = at (&c, a.offset[3*i + 1], a.offset[3*i], a.offset[3*i + 2]);
            check_scaled (a.weight[i], c.weight[j], 1e-9, 1e-3);
            check_relative (a.r[i], c.r[j], 1e-14);
        }
        check_relative (pg_stencil_calibration (&a, &big), pg_stencil_calibration (&b, &small), 1e-13);
        check_relative (pg_stencil_calibration (&a, &big), pg_stencil_calibration (&c, &big), 1e-10);
        pg_stencil_clear (&a), pg_stencil_clear (&b), pg_stencil_clear (&c);
    }
}

/* Calibrated: the hydrostatic energy is exact, also of rectangular cells */
static void calibration_makes_the_hydrostatic_energy_exact (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++)
        for (int p = 0; p < 3; p++) {
            pg_sum_rule rule = rule_of (dim, "quadratic", 3.4, (pg_partial) p);
            pg_stencil s;
            double D[36], D0[36], c = pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 2, 1), sum = 0,
                                  sum0 = 0;
            int nv = pg_voigt_size (dim);
            check_ok (pg_stencil_build (&s, &rule, dim, (double[]) {1, 0.9, 1.1}));
            pg_stencil_tangent (&s, c * pg_stencil_calibration (&s, &rule), 1, D);
            pg_elastic_tangent (rule.mode, 2, pg_bond_poisson (rule.mode), D0);
            for (int a = 0; a < dim; a++)
                for (int b = 0; b < dim; b++) sum += D[a * nv + b], sum0 += D0[a * nv + b];
            check_relative (sum, sum0, 1e-12);
            pg_stencil_clear (&s);
        }
}

/* largest omega^2 rho D^2 / E of plane waves, 61 x 61 wave numbers of the first zone; the time step's
 * limit is 2 / omega */
static void the_highest_frequency_is_the_printed_one (void **state)
{
    (void) state;
    static const struct { const char *kernel; double m, omega2, step;
    } rows[] = { { "constant", 3, 1.15110, 1.86412 },
                 { "quadratic", 3, 1.72002, 1.52498 },
                 { "constant", 3.015, 0, 1.87812 },
                 { "constant", 6, 0, 3.75131 } };
    for (int k = 0; k < 4; k++) {
        pg_sum_rule rule = rule_of (2, rows[k].kernel, rows[k].m, PG_PARTIAL_NONE);
        pg_stencil s;
        double c = pg_bond_modulus (rule.mode, rule.kernel, rule.horizon, 1, 1), most = 0;
        build (&s, &rule, 2, 1);
        for (int a = 0; a <= 60; a++)
            for (int b = 0; b <= 60; b++) {
                double M[3] = {0};
                for (size_t j = 0; j < s.n; j++) {
                    double x = s.xi[2 * j], y = s.xi[2 * j + 1],
                           f = c * s.weight[j] / pow (s.r[j], 3) * s.cell
                               * (1 - cos (pi * (a * x + b * y) / 60));
                    M[0] += f * x * x, M[1] += f * x * y, M[2] += f * y * y;
                }
                most = fmax (most,
                             0.5 * (M[0] + M[2]) + sqrt (0.25 * (M[0] - M[2]) * (M[0] - M[2]) + M[1] * M[1]));
            }
        if (rows[k].omega2 > 0) check_relative (most, rows[k].omega2, 1e-3);
        check_relative (2 / sqrt (most), rows[k].step, 1e-3);
        pg_stencil_clear (&s);
    }
}

static void wrong_rules_are_refused (void **state)
{
    (void) state;
    pg_sum_rule good = rule_of (2, "constant", 3, PG_PARTIAL_NONE), bad = good;
    pg_stencil s;
    const double step[3] = {1, 1, 1}, nought[3] = {1, 0, 1};
    check_fails (pg_stencil_build (&s, &good, 3, step), PG_E_USAGE);
    check_fails (pg_stencil_build (&s, &good, 2, nought), PG_E_USAGE);
    bad.horizon = 0;
    check_fails (pg_stencil_build (&s, &bad, 2, step), PG_E_USAGE);
    bad.horizon = NAN;
    check_fails (pg_stencil_build (&s, &bad, 2, step), PG_E_USAGE);
    bad.horizon = 0.9;
    check_fails (pg_stencil_build (&s, &bad, 2, step), PG_E_USAGE);
    check_contains (pg_last_error (), "no neighbour");
    bad.horizon = 1e9;
    check_fails (pg_stencil_build (&s, &bad, 2, step), PG_E_LIMIT);
    assert_null (s.offset);
    size_t held = pg_memory_used ();
    for (size_t k = 1; k <= 6; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_stencil_build (&s, &good, 2, step), PG_E_MEMORY);
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), held);
    }
}

/* The last bit of the spacing decides nothing: as many neighbours, of the same weights to rounding, at any
 * spacing. 250 of a cone in space at 3.015 spacings, by overlap: the six nearest among them. */
static void every_spacing_has_the_same_bonds (void **state)
{
    (void) state;
    static const char *const kernels[] = { "conical", "constant", "quartic_spline" };
    unsigned seed = 12345;
    for (int dim = 1; dim <= 3; dim++)
        for (int p = 0; p < 3; p++)
            for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
                pg_sum_rule rule = rule_of (dim, kernels[k], 3.015, (pg_partial) p);
                pg_stencil one, s;
                build (&one, &rule, dim, 1);
                if (dim == 3 && k == 0 && p == PG_PARTIAL_OVERLAP) assert_int_equal (one.n, 250);
                for (int n = 0; n < 40; n++) {
                    seed = 1664525 * seed + 1013904223;
                    double h = pow (10, -6 + 9 * (seed / 4294967296.0));
                    rule.horizon = 3.015 * h;
                    build (&s, &rule, dim, h);
                    assert_int_equal (s.n, one.n);
                    for (size_t b = 0; b < s.n; b++) check_absolute (s.weight[b], one.weight[b], 1e-9);
                    pg_stencil_clear (&s);
                }
                pg_stencil_clear (&one);
            }
}

/* A kernel that is no number somewhere */
static void no_number (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i] > 0.4 && q[i] < 0.6 ? NAN : 1;
    for (size_t i = 0; dw && i < n; i++) dw[i] = 0;
}

static void infinite (size_t n, const double *q, double *w, double *dw)
{
    for (size_t i = 0; i < n; i++) w[i] = q[i] > 0.4 && q[i] < 0.6 ? INFINITY : 1;
    for (size_t i = 0; dw && i < n; i++) dw[i] = 0;
}

/* What is no number is refused, with the bond that has it: it is no bond that is missing. */
static void weights_that_are_no_numbers_are_refused (void **state)
{
    (void) state;
    const pg_kernel bad[] = { { "bad", "", 1, no_number }, { "bad", "", 1, infinite } };
    const double step[3] = { 1, 1, 1 };
    double x[] = { 0, 0, 1, 0, 2, 0.1, 3, 0.31415, 4, 0.0271 }, volume[] = { 1, 1, 1, 1, 1 };
    pg_cloud cloud = { .dim = 2, .n = 5, .x = x, .volume = volume, .h = 1, .step = { 1, 1, 1 },
                       .thickness = 1 };
    pg_sums *sums;
    for (int k = 0; k < 2; k++)
        for (int p = 0; p < 3; p++) {
            pg_sum_rule rule = rule_of (2, "constant", 2.015, (pg_partial) p);
            pg_stencil s;
            rule.kernel = &bad[k];
            check_fails (pg_stencil_build (&s, &rule, 2, step), PG_E_USAGE);
            check_contains (pg_last_error (), "the bond to the neighbour (1, 0, 0)");
            if (p == PG_PARTIAL_OVERLAP) continue;
            check_fails (pg_sums_create (&sums, &rule, &cloud, NULL), PG_E_USAGE);
            check_contains (pg_last_error (), "the bond of points 1 and 2");
        }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (stiffness_of_lattices_is_the_printed_one),
        cmocka_unit_test (means_of_kernels_that_vanish_are_nearer),
        cmocka_unit_test (means_are_integrals),
        cmocka_unit_test (overlaps_add_up_to_the_ball),
        cmocka_unit_test (neighbours_are_counted),
        cmocka_unit_test (a_straight_cut_takes_the_printed_energy),
        cmocka_unit_test (a_cut_is_the_sum_of_its_bonds),
        cmocka_unit_test (mirrored_and_permuted_bonds_have_the_same_bits),
        cmocka_unit_test (numbers_do_not_depend_on_the_unit),
        cmocka_unit_test (calibration_makes_the_hydrostatic_energy_exact),
        cmocka_unit_test (the_highest_frequency_is_the_printed_one),
        cmocka_unit_test (wrong_rules_are_refused),
        cmocka_unit_test (every_spacing_has_the_same_bonds),
        cmocka_unit_test (weights_that_are_no_numbers_are_refused),
    };
    return cmocka_run_group_tests_name ("stencil of a lattice", tests, NULL, NULL);
}
