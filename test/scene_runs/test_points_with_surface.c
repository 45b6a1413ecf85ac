/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points from a file with shapes as their surface: cells of a regular grid, cut by the shapes, integrate
 * consistently over any cloud. Patch tests on points moved at random; what is refused. */
#include <unistd.h>
#include "run.h"

static const double slope[2][2] = { { 1e-3, 2e-4 }, { -3e-4, 5e-4 } };

/* Points of a square of 1 x 1, a tenth apart, moved by up to `amount` of that along each axis, as far as they
 * lie in the shape; `keep` decides. */
static void write_cloud (const char *path, double amount, int (*keep) (const double *x))
{
    unsigned long long seed = 12345;
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fprintf (f, "x,y,volume\n");
    for (int j = 0; j < 10; j++)
        for (int i = 0; i < 10; i++) {
            double x[2] = { (i + 0.5) / 10, (j + 0.5) / 10 };
            for (int k = 0; k < 2; k++) {
                seed = seed * 6364136223846793005ull + 1442695040888963407ull;
                x[k] += amount / 10 * (2 * (double) (seed >> 11) / 9007199254740992.0 - 1);
            }
            if (keep (x)) fprintf (f, "%.17g,%.17g,0.01\n", x[0], x[1]);
        }
    fclose (f);
}

static int in_square (const double *x) { (void) x; return 1; }
static int below_slant (const double *x) { return x[0] + 2 * x[1] < 2.28; }

/* u = slope x on the whole surface; the largest error at the points, relative. */
static double patch_error (const char *shape, int (*keep) (const double *x), const char *method,
                           const char *plane, double amount)
{
    char path[] = "/tmp/perigal_cloud_XXXXXX";
    int file = mkstemp (path), components;
    assert_true (file >= 0);
    close (file);
    write_cloud (path, amount, keep);
    run r = scene_of (1, "dimension: 2\nplane: %s\npoints: %s\nbody: [{add: {%s}}]\nspacing: 0.1\n"
                      "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
                      "method: {approximation: rkpm, essential: nitsche, %s}\n"
                      "boundary: [{set: all, displacement: {x: '%g*x + %g*y', y: '%g*x + %g*y'}}]\n"
                      "solver: {kind: static, steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n",
                      plane, path, shape, method, slope[0][0], slope[0][1], slope[1][0], slope[1][1]);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", &components), worst = 0, top = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++)
        for (size_t k = 0; k < 2; k++) {
            const double *x = r.problem->cloud.x + 2*i;
            double exact = slope[k][0] * x[0] + slope[k][1] * x[1];
            worst = fmax (worst, fabs (u[2*i + k] - exact)), top = fmax (top, fabs (exact));
        }
    pg_free (u);
    clear (&r);
    unlink (path);
    return worst / top;
}

static void patch_is_exact_on_clouds (void **unused)
{
    static const struct {
        const char *shape;
        int (*keep) (const double *x);
        const char *method, *plane;
    } cases[] = {
        { "box: {low: [0, 0], high: [1, 1]}", in_square, "integration: consistent, horizon: 2.5 spacing",
          "stress" },
        { "polygon: {vertices: [[0, 0], [1, 0], [1, 0.65], [0.3, 1], [0, 1]]}", below_slant,
          "integration: consistent, horizon: 3 spacing", "strain" },
    };
    (void) unused;
    for (size_t k = 0; k < 2; k++) {
        double error = patch_error (cases[k].shape, cases[k].keep, cases[k].method, cases[k].plane, 0.4),
               gauss = patch_error (cases[k].shape, cases[k].keep, "integration: gauss, horizon: 2.5 spacing",
                                    cases[k].plane, 0.4);
        print_message ("cloud %zu: %.1e, with Gauss points %.1e\n", k, error, gauss);
        check_below (error, 1e-11);
        assert_true (gauss > 1e-6);
    }
}

/* Points beyond the surface, and a mesh beside a body, are refused in words. */
static void what_does_not_fit_is_refused (void **unused)
{
    char path[] = "/tmp/perigal_cloud_XXXXXX", text[600];
    int file = mkstemp (path);
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    (void) unused;
    assert_true (file >= 0);
    close (file);
    write_cloud (path, 0, in_square);
    snprintf (text, sizeof text,
              "dimension: 2\npoints: %s\nbody: [{add: {box: {low: [0, 0], high: [1, 0.9]}}}]\n"
              "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n",
              path);
    check_ok (pg_scene_parse (&scene, text, "cloud.yaml"));
    check_fails (pg_problem_build (&problem, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), "10 of 100 points lie outside the body, the first of them number 91");
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    unlink (path);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (patch_is_exact_on_clouds),
                                        cmocka_unit_test (what_does_not_fit_is_refused) };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
