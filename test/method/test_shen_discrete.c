/* SPDX-License-Identifier: GPL-3.0-or-later
 * Shen's beam (2016, section 4) as 501 x 51 points, edges included, each with a whole cell: deflection of the
 * middle and lowest frequency of theory H, C-1 to C-3, by factorisation of a stiffness built here from the
 * bonds. Supports: the bottom corner points, left in x and y, right in y; 1 kN on the middle point of the
 * top. */
#include "direct.h"

enum { KN = 1000 };
static const double E = 20e9, density = 2400, step = 2e-3;
static const char beam[] = "dimension: 2\nbody: [{add: {box: {low: [-1 mm, -1 mm], high: [1001 mm, 101 "
                           "mm]}}}]\nspacing: 2 mm\nlattice: cells\n"
                           "thickness: 1 m\n";

typedef struct { const char *kernel; int calibrate; double c, deflection, omega; } row;

static void check_beam (row r)
{
    direct b;
    direct_build (&b, beam, r.kernel, 3 * step, E, r.calibrate, PG_PARTIAL_NONE);
    assert_int_equal (b.n, 501 * 51);
    check_relative (b.c, r.c, 1e-5);
    size_t left = direct_point (&b, 0, 0), right = direct_point (&b, 1, 0), top = direct_point (&b, 0.5, 0.1),
           middle = direct_point (&b, 0.5, 0.05);
    b.held[2*left] = b.held[2*left + 1] = b.held[2*right + 1] = 1;
    direct_assemble (&b);
    void *factor = direct_factor (&b);
    double *P = pg_calloc (2 * b.n, sizeof *P), *u = pg_calloc (2 * b.n, sizeof *u);
    P[2*top + 1] = -KN;
    check_ok (pg_linear_find ("cholmod")->solve (factor, 1, P, u));
    double omega = direct_lowest (&b, factor, density, 6);
    print_message (
        "%s, calibrate %d: c = %.6e N/m6, deflection of the middle %.6e m, lowest frequency %.3f rad/s\n",
        r.kernel, r.calibrate, b.c, -u[2 * middle + 1], omega);
    check_relative (-u[2*middle + 1], r.deflection, 1e-4);
    if (r.omega > 0) check_relative (omega, r.omega, 1e-3);
    pg_linear_find ("cholmod")->free (&factor);
    pg_free (P), pg_free (u);
    direct_clear (&b);
}

/* C-1, C-3 */
static void constant (void **state)
{
    (void) state, check_beam ((row){ "constant", 0, 2.652582e17, 1.19904e-5, 802.85 });
}
/* C-2, C-3 */
static void quadratic (void **state)
{
    (void) state, check_beam ((row){ "quadratic", 1, 6.94209e17, 1.26269e-5, 783.16 });
}

/* The other two of theory C. */
static void remaining (void **state)
{
    (void) state;
    check_beam ((row) { "constant", 1, 2.652582e17 * 0.96075, 1.24802e-5, 0 });
    check_beam ((row) { "quadratic", 0, 6.94209e17 / 1.04684, 1.32184e-5, 0 });
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (constant), cmocka_unit_test (quadratic),
                                        cmocka_unit_test (remaining) };
    return cmocka_run_group_tests_name ("method/shen_discrete", tests, NULL, NULL);
}
