/* SPDX-License-Identifier: GPL-3.0-or-later
 * Brazilian disk without crack: centre stresses 2P/(pi D t) and -6P/(pi D t) of two point loads P (measured
 * reaction). The platens are smooth and two facets wide, so that they shrink to points with the spacing; x =
 * 0 is held on the axis of symmetry, where it takes no force. Rough platens add a pair of opposite shear
 * forces that shifts both stresses by 1 to 2 % at the same width: no error. */
#include "run.h"

static const double pi = 3.14159265358979323846;

/* Relative errors of sigma_xx and sigma_yy at the centre; P > 0 the force of the upper platen */
static void centre_errors (const run *r, double *error, double *P)
{
    size_t centre = 0;
    const double *x = r->problem->cloud.x;
    double *stress = field_of (r, NULL, "stress", NULL), unit;
    for (size_t i = 1; i < r->problem->cloud.n; i++)
        if (hypot (x[2 * i], x[2 * i + 1]) < hypot (x[2 * centre], x[2 * centre + 1])) centre = i;
    check_below (hypot (x[2*centre], x[2*centre + 1]), 1e-9);
    *P = -r->step.reaction[1];
    unit = 2 * *P / (pi * 0.1 * 0.01);
    error[0] = stress[3*centre] / unit - 1;
    error[1] = stress[3*centre + 1] / (-3 * unit) - 1;
    check_below (fabs (stress[3*centre + 2]) / unit, 1e-9);
    pg_free (stress);
}

static void check_reactions (const run *r, double P)
{
    check_below (fabs (r->step.reaction[1] + r->step.reaction[4]) / P, 1e-9);
    for (int k = 0; k < 9; k += 3) check_below (fabs (r->step.reaction[k]) / P, 1e-9);
}

static run disk_of (double mm, const char *essential)
{
    return scene_of (
        1,
        "dimension: 2\nthickness: 10 mm\nbody: [{add: {disk: {center: [0, 0], diameter: 100 mm}}}]\nspacing: "
        "%g mm\n"
        "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
        "sets: {platens: {boundary: rim, where: 'abs(x) < %g mm'}, axis: {where: 'abs(x) < 0.001 mm'}}\n"
        "method: {approximation: rkpm, integration: gauss, essential: %s}\n"
        "boundary:\n  - {set: platens.top, displacement: {y: -20 um}}\n  - {set: platens.bottom, "
        "displacement: {y: 20 um}}\n"
        "  - {set: axis, displacement: {x: 0}}\nsolver: {stepping: fixed, steps: 1}\noutput: {at: {levels: "
        "1}}\n",
        mm, 1.01 * mm, essential);
}

static void convergence (const char *essential)
{
    double error[3][2], P[3];
    for (int k = 0; k < 3; k++) {
        run r = disk_of (5 / pow (2, k), essential);
        to_the_end (&r);
        centre_errors (&r, error[k], &P[k]);
        check_reactions (&r, P[k]);
        print_message ("%s, spacing %4.2f mm: P = %.1f N, across %+.3f %%, along %+.3f %%\n", essential,
                       5 / pow (2, k), P[k], 100 * error[k][0], 100 * error[k][1]);
        clear (&r);
    }
    for (int c = 0; c < 2; c++) {
        check_below (fabs (error[2][c]), 0.005);
        check_below (fabs (error[1][c]), 0.4 * fabs (error[0][c]));
        check_below (fabs (error[2][c]), 0.4 * fabs (error[1][c]));
    }
}

static void centre_stresses_converge_with_nitsche (void **state) { (void) state, convergence ("auto"); }
static void centre_stresses_converge_with_transformation (void **state)
{
    (void) state, convergence ("transformation");
}

static void the_shipped_scene_is_within_one_percent (void **state)
{
    (void) state;
    run r = { 0 };
    double error[2], P;
    check_ok (pg_scene_load (&r.scene, "data/disk_uncracked/scene.yaml"));
    check_ok (pg_problem_build (&r.problem, r.scene, 1));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    to_the_end (&r);
    centre_errors (&r, error, &P);
    check_reactions (&r, P);
    print_message ("data/disk_uncracked: across %+.3f %%, along %+.3f %%\n", 100 * error[0], 100 * error[1]);
    for (int c = 0; c < 2; c++) check_below (fabs (error[c]), 0.01);
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (centre_stresses_converge_with_nitsche),
        cmocka_unit_test (centre_stresses_converge_with_transformation),
        cmocka_unit_test (the_shipped_scene_is_within_one_percent),
    };
    return cmocka_run_group_tests_name ("scene_runs/uncracked_disk", tests, NULL, NULL);
}
