/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fracture energy and critical stretch: table of theory A1, and the work on all bonds that cross a plane
 * (A-1, A-2). */
#include "check.h"
#include "perigal/criterion.h"
#include "perigal/kernel.h"

static const double pi = 3.14159265358979323846;
static const char *const kernels[5] = { "constant", "quadratic", "conical", "linear_r", "inverse_r" };
static const pg_mode modes[4] = { PG_LINE, PG_PLANE_STRESS, PG_PLANE_STRAIN, PG_SOLID };

static pg_criterion_setting setting (int mode, const char *kernel, double horizon, double E)
{
    return (pg_criterion_setting){ .mode = modes[mode],
                                   .horizon = horizon,
                                   .modulus = E,
                                   .poisson = 0.25,
                                   .thickness = 0.7,
                                   .kernel = kernel };
}

static void stretch_is_that_of_the_table (void **state)
{
    (void) state;
    const double a[5][4] = { { 3, 4 * pi / 9, 5 * pi / 12, 5.0 / 6 },
                             { 15.0 / 4, 8 * pi / 15, pi / 2, 35.0 / 36 },
                             { 4, 5 * pi / 9, 25 * pi / 48, 1 },
                             { 8.0 / 3, 5 * pi / 12, 25 * pi / 64, 4.0 / 5 },
                             { 4, pi / 2, 15 * pi / 32, 8.0 / 9 } };
    for (int k = 0; k < 5; k++)
        for (int m = 0; m < 4; m++) {
            pg_criterion_setting s = setting (m, kernels[k], 0.3, 192e9);
            check_relative (pg_stretch_from_energy (&s, 110), sqrt (a[k][m] * 110 / (192e9 * 0.3)), 1e-12);
        }
}

static void energy_from_stretch_is_the_inverse (void **state)
{
    (void) state;
    for (size_t k = 0; pg_kernel_entry (k); k++)
        for (int m = 0; m < 4; m++) {
            pg_criterion_setting s = setting (m, pg_kernel_entry (k)->name, 1.7e-4, 3e9);
            check_relative (pg_energy_from_stretch (&s, pg_stretch_from_energy (&s, 452)), 452, 1e-13);
        }
}

static void plate_of_the_coupling_paper_dissipates_2160_joules (void **state)
{
    (void) state;
    pg_criterion_setting s = setting (3, "constant", 0.06, 30e9);
    check_relative (pg_energy_from_stretch (&s, 1e-3), 2160, 1e-12);
}

static void an_unknown_kernel_gives_nothing (void **state)
{
    (void) state;
    pg_criterion_setting s = setting (3, "nothing", 0.06, 30e9);
    check_absolute (pg_stretch_from_energy (&s, 1), 0, 0);
    check_absolute (pg_energy_from_stretch (&s, 1e-3), 0, 0);
}

/* Gauss, 5 points on each of `panels` panels of [low, high] */
typedef double (*integrand) (double x, const void *context);
static double integral (integrand f, const void *context, double low, double high, int panels)
{
    const double x[5] = { -.9061798459386640, -.5384693101056831, 0, .5384693101056831, .9061798459386640 };
    const double w[5] = { .2369268850561891, .4786286704993665, .5688888888888889, .4786286704993665,
                          .2369268850561891 };
    double sum = 0, h = (high - low) / panels;
    for (int k = 0; k < panels; k++)
        for (int g = 0; g < 5; g++) sum += h / 2 * w[g] * f (low + h * (k + (1 + x[g]) / 2), context);
    return sum;
}

typedef struct { const pg_kernel *kernel; double delta, r; int power, mode; } place;

static double weight (const pg_kernel *kernel, double q)
{
    double w;
    kernel->value (1, &q, &w, NULL);
    return w;
}

static double moment_at (double r, const void *context)
{
    const place *p = context;
    return weight (p->kernel, r / p->delta) * pow (r, p->power);
}

static double moment (const pg_kernel *kernel, double delta, int power)
{
    place p = { kernel, delta, 0, power, 0 };
    return integral (moment_at, &p, 0, delta, 16);
}

/* micromodulus for E = 1, t = A = 1: theory A1 */
static double micromodulus (int mode, const pg_kernel *kernel, double delta)
{
    const double factor[4] = { 1, 3 / pi, 16 / (5 * pi), 3 / pi };
    const int power[4] = { 1, 2, 2, 3 };
    return factor[mode] / moment (kernel, delta, power[mode]);
}

/* direction density on the angle from the normal, per unit r^(d-1) dr */
static double square (double a, const void *c) { (void) c; return pow (cos (a), 4); }
static double cone   (double a, const void *c) { (void) c; return pow (cos (a), 4) * sin (a); }

static void uniform_strain_stores_the_energy_of_hooke (void **state)
{
    (void) state;
    const double want[4] = { 0.5, .5625, .6, .6 };     /* W for e_xx = 1, E = 1 */
    for (int k = 0; k < 5; k++)
        for (int m = 0; m < 4; m++) {
            const pg_kernel *kernel = pg_kernel_find (kernels[k]);
            double delta = 0.3, c = micromodulus (m, kernel, delta), angle = 2;        /* s = cos^2 */
            if (m == 1 || m == 2) angle = integral (square, NULL, 0, 2 * pi, 16);
            if (m == 3) angle = 2 * pi * integral (cone, NULL, 0, pi, 16);
            int power = m == 0 ? 1 : m == 3 ? 3 : 2;
            check_relative (c / 4 * angle * moment (kernel, delta, power), want[m], 1e-9);
        }
}

/* Work on the bonds of length r that start at depth z = r (1 - u^2) and cross the plane, s0 = 1, c = 1; the
 * square takes the root of the angle at z = r away. */
static double over_plane (double u, const void *context)
{
    const place *p = context;
    double r = p->r, share = 1 - u * u, energy = weight (p->kernel, r / p->delta) * r / 2, rate = 2 * u * r;
    if (p->mode == 0) return energy * rate;
    if (p->mode == 3) return energy * 2 * pi * r * r * (1 - share) * rate;
    return energy * 2 * r * acos (share) * rate;
}

static double all_depths (double r, const void *context)
{
    place p = *(const place *) context;
    p.r = r;
    return integral (over_plane, &p, 0, 1, 16);
}

static void bonds_over_a_plane_at_the_critical_stretch_store_the_fracture_energy (void **state)
{
    (void) state;
    for (int k = 0; k < 5; k++)
        for (int m = 0; m < 4; m++) {
            place p = { pg_kernel_find (kernels[k]), 0.3, 0, 0, m };
            pg_criterion_setting s = setting (m, kernels[k], 0.3, 1);
            double s0 = pg_stretch_from_energy (&s, 1);
            double G = micromodulus (m, p.kernel, 0.3) * s0 * s0 * integral (all_depths, &p, 0, 0.3, 16);
            check_relative (G, 1, 1e-9);
        }
}

/* ---- state-based --------------------------------------------------------------------------------------- */
/* Of q = int k r dV the part that lies beyond a plane z away, by midpoints over the half ball; kernel
 * constant, horizon 1 */
static double part_beyond (int mode, double z)
{
    enum { N = 2000 };
    double sum = 0, whole = 0;
    for (int k = 0; k < N; k++) {
        double r = (k + 0.5) / N, all = mode == 0 ? 2 : mode == 3 ? 4 * pi * r * r : 2 * pi * r;
        double share = r <= z ? 0 : mode == 0 ? 0.5 : mode == 3 ? 0.5 * (1 - z / r) : acos (z / r) / pi;
        whole += r * all, sum += r * all * share;
    }
    return sum / whole;
}

/* Dilatation of a point beside a cut is d s0 I / q, its energy A theta^2 / (2 d); each stretched bond stores
 * by B: A goes with the square of the part, B with the part itself; both faces of the cut. */
static void energy_of_a_state_based_cut (void **state)
{
    (void) state;
    enum { N = 400 };
    for (int m = 0; m < 4; m++) {
        double d = m == 0 ? 1 : m == 3 ? 3 : 2, first = 0, second = 0;
        for (int k = 0; k < N; k++) {
            double share = part_beyond (m, (k + 0.5) / N);
            first += share / N, second += share * share / N;
        }
        /* of these sums of 2000 shells */
        check_relative (pg_state_cut_share (modes[m], "constant", 0, 1), first, 1e-3);
        check_relative (pg_state_cut_share (modes[m], "constant", 1, 0), d * second, 1e-3);
    }
    check_relative (pg_state_cut_share (PG_LINE, "constant", 1, 0), 2.0 / 15, 1e-10);
    check_relative (pg_state_cut_share (PG_LINE, "constant", 0, 1), 1.0 / 3, 1e-10);
    check_relative (pg_state_cut_share (PG_SOLID, "constant", 0, 1), 1.0 / 5, 1e-10);
    check_relative (pg_state_cut_share (PG_SOLID, "constant", 1, 0),
                    3 * (1.0 / 4 - 1.0 / 3 + 1.0 / 30 + 1.0 / 9 + 1.0 / 324), 1e-10);
    assert_true (pg_state_cut_share (PG_SOLID, "nothing", 1, 1) == 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (stretch_is_that_of_the_table),
        cmocka_unit_test (energy_from_stretch_is_the_inverse),
        cmocka_unit_test (plate_of_the_coupling_paper_dissipates_2160_joules),
        cmocka_unit_test (an_unknown_kernel_gives_nothing),
        cmocka_unit_test (uniform_strain_stores_the_energy_of_hooke),
        cmocka_unit_test (energy_of_a_state_based_cut),
        cmocka_unit_test (bonds_over_a_plane_at_the_critical_stretch_store_the_fracture_energy),
    };
    return cmocka_run_group_tests_name ("mechanics/criterion/energy", tests, NULL, NULL);
}
