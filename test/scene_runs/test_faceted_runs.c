/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lattices in the mesh of a turned box: linear fields to rounding with consistent integration, under
 * displacements and pressures on oblique faces; the resultant of a traction; the same answer however the box
 * is divided, shifted, mirrored, in mm; slivers. */
#include "run.h"
#include "turned_box.h"

#define METHOD \
    "materials: {m: {youngs_modulus: 1000 Pa, poissons_ratio: 0.3}}\n" \
    "method: {approximation: rkpm, integration: %s, horizon: 2 spacing}\n" \
    "solver: {kind: static, steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n"

/* u = (x + y/2, -0.3 y, 0.2 z + x/4) / 1000, on the whole surface. */
static double linear (const pose *p, const char *integration, double spacing)
{
    run r = scene_of (1,
                      "%sspacing: %g\n" METHOD
                      "sets: {around: {boundary: all}}\nboundary:\n"
                      "  - {set: around, displacement: {x: '(x + y/2) / 1000', y: '-0.3*y / 1000', "
                      "z: '(0.2*z + x/4) / 1000'}}\n",
                      turned_box (p), spacing, integration);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL), worst = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        const double *x = r.problem->cloud.x + 3 * i;
        double exact[3] = { x[0] + x[1] / 2, -0.3 * x[1], 0.2 * x[2] + x[0] / 4 };
        for (size_t k = 0; k < 3; k++) worst = fmax (worst, fabs (1000 * u[3 * i + k] - exact[k]));
    }
    pg_free (u);
    clear (&r);
    return worst;
}

static void linear_fields_are_exact (void **state)
{
    (void) state;
    static const pose poses[] = { { 23, 31, 0, 1, 0, 1, 0 }, { 23, 31, 0, 1, 1, 2, 1 },
                                  { 23, 31, 0, 1000, 0, 2, 1 }, { 23, 31, 3, 1, 0, 1, 1 } };
    for (size_t i = 0; i < sizeof poses / sizeof *poses; i++) {
        double e = linear (&poses[i], "consistent", 0.17);
        print_message ("pose %zu: %.1e\n", i, e);
        check_below (e, 1e-11);
    }
    double e = linear (&poses[0], "gauss", 0.17);
    print_message ("gauss: %.1e\n", e);
    check_below (e, 2e-2);
}

/* u = s x / 1000 under a uniform pressure on every oblique face but one, where x'= 0, which follows it (K =
 * 1000 / 1.2: s = -p / 3 K). The place on the axis of the turned box is x.a, a its first direction. */
static void pressure_on_oblique_faces (void **state)
{
    (void) state;
    static const pose poses[] = { { 23, 31, 0, 1, 0, 1, 0 }, { 23, 31, 0, 1, 0, 3, 1 } };
    for (size_t i = 0; i < 2; i++) {
        double a[3], o[3];
        place (&poses[i], (double[]){ 1, 0, 0 }, a), place (&poses[i], (double[]){ 0, 0, 0 }, o);
        run r = scene_of (1,
                          "%sspacing: 0.13\n" METHOD
                          "sets:\n  held: {boundary: all, where: '%.17g*x + %.17g*y + %.17g*z < 1e-6'}\n"
                          "  pressed: {boundary: all, where: '%.17g*x + %.17g*y + %.17g*z > 1e-6'}\n"
                          "boundary:\n  - set: held\n    displacement: {x: '-x * 4e-4', y: '-y * 4e-4', z: "
                          "'-z * 4e-4'}\n  - {set: pressed, pressure: 1 Pa}\n",
                          turned_box (&poses[i]), "consistent", a[0], a[1], a[2], a[0], a[1], a[2]);
        to_the_end (&r);
        double *u = field_of (&r, NULL, "displacement", NULL), worst = 0;
        for (size_t k = 0; k < 3 * r.problem->cloud.n; k++)
            worst = fmax (worst, fabs (u[k] / 4e-4 + r.problem->cloud.x[k]));
        print_message ("pressure, box divided in %d: %.1e\n", poses[i].n, worst);
        check_below (worst, 1e-10);
        pg_free (u);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (linear_fields_are_exact),
        cmocka_unit_test (pressure_on_oblique_faces),
    };
    return cmocka_run_group_tests_name ("scene_runs/faceted_runs", tests, NULL, NULL);
}
