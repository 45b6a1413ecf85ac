/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points of a file with spacings of their own: linear fields, patches, criteria, messages. */
#include "run.h"
#include <unistd.h>

static char folder[64];

static int make_folder (void **state)
{
    (void) state;
    snprintf (folder, sizeof folder, "/tmp/perigal_graded_XXXXXX");
    return mkdtemp (folder) ? 0 : -1;
}

static int drop_folder (void **state)
{
    char path[128];
    (void) state;
    snprintf (path, sizeof path, "%s/p.csv", folder);
    unlink (path);
    return rmdir (folder);
}

static double next (uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (*seed >> 8) / 8388608.0 - 1;
}

/* A unit square or cube; steps grow along x by a factor; equal: all spacings h. shrink: of the last point's
 * spacing. */
typedef struct { int dim, n, equal; double growth, move, unit, shrink; } cloud_of;

static void write_points (const cloud_of *c)
{
    char path[128];
    uint32_t seed = 5;
    double x[64], total = 0;
    snprintf (path, sizeof path, "%s/p.csv", folder);
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    for (int i = 0; i < c->n; i++) x[i] = total, total += i + 1 < c->n ? pow (c->growth, i) : 0;
    for (int i = 0; i < c->n; i++) x[i] /= total;
    fprintf (f, "x,%s%svolume,block,spacing\n", c->dim > 1 ? "y," : "", c->dim > 2 ? "z," : "");
    for (int r = 0; r < (c->dim == 3 ? c->n : 1); r++)
        for (int q = 0; q < (c->dim > 1 ? c->n : 1); q++)
            for (int p = 0; p < c->n; p++) {
                int at[3] = { p, q, r };
                double volume = 1, size = 0;
                for (int k = 0; k < c->dim; k++) {
                    int i = at[k], inside = i > 0 && i + 1 < c->n;
                    double low = i > 0 ? x[i] - x[i - 1] : 0, high = i + 1 < c->n ? x[i + 1] - x[i] : 0;
                    volume *= 0.5 * (low + high), size = fmax (size, fmax (low, high));
                    fprintf (f, "%.17g,",
                             c->unit * (x[i] + (inside ? c->move * fmin (low, high) * next (&seed) : 0)));
                }
                int last = p + 1 == c->n && (c->dim < 2 || q + 1 == c->n) && (c->dim < 3 || r + 1 == c->n);
                fprintf (f, "%.17g,0,%.17g\n", volume * pow (c->unit, c->dim),
                         c->unit * (c->equal ? 1.0 / c->n : size) * (last && c->shrink > 0 ? c->shrink : 1));
            }
    fclose (f);
}

static run scene_from (int dim, int threads, const char *method, const char *more)
{
    char text[4096], path[128];
    run r = { 0 };
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    snprintf (text, sizeof text,
              "dimension: %d\npoints: p.csv\nmaterials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: "
              "0.25, density: 2000}}\n"
              "method: {integration: nodal, %s}\n%s",
              dim, method, more);
    check_ok (pg_scene_parse (&r.scene, text, path));
    check_ok (pg_problem_build (&r.problem, r.scene, threads));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    return r;
}

static run scene_with (const cloud_of *c, int threads, const char *method, const char *more)
{
    write_points (c);
    return scene_from (c->dim, threads, method, more);
}

#define STATIC "solver: {steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n"
static const char *const methods[4] = { "approximation: rkpm, horizon: 2.6 spacing",
                                        "approximation: rkpm, basis: quadratic, horizon: 3.6 spacing",
                                        "approximation: pddo, horizon: 2.6 spacing",
                                        "approximation: nosb, horizon: 2.6 spacing" };
static const double slope[3] = { 1e-3, -2e-4, 5e-4 };

/* u_k = slope_k x_k of coefficients gives strain slope_k everywhere. */
static void linear_fields_are_exact (void **state)
{
    (void) state;
    for (int dim = 1; dim <= 3; dim++) for (int m = 0; m < 4; m++) {
        cloud_of c = { dim, dim == 3 ? 7 : 10, 0, 1.15, 0.1, 1, 0 };
        run r = scene_with (&c, 1, methods[m], STATIC "boundary: [{set: left, displacement: {x: 0}}]\n");
        size_t n = r.problem->cloud.n, d = (size_t) dim;
        double *u = pg_calloc (n * d, sizeof *u);
        int nv;
        for (size_t i = 0; i < n * d; i++) u[i] = slope[i % d] * r.problem->cloud.x[i];
        advance (&r);
        double *strain = field_of (&r, u, "strain", &nv), *out = field_of (&r, u, "displacement", NULL),
               worst = 0;
        for (size_t i = 0; i < n; i++) for (int v = 0; v < nv; v++)
                worst = fmax (worst,
                              fabs (strain[i * (size_t) nv + (size_t) v] - (v < dim ? slope[v] : 0)) / 1e-3);
        check_below (worst, 1e-11);
        check_below (largest_difference (out, u, n * d) / 1e-3, 1e-12);
        pg_free (u), pg_free (strain), pg_free (out);
        clear (&r);
    }
}

/* A quarter of an annulus, 0.1 to 1: rings whose steps follow the radius (10 to 1), points moved by a tenth
 * of them. */
static size_t write_rings (double unit, int equal)
{
    enum { AROUND = 13 };
    char path[128];
    uint32_t seed = 9;
    size_t n = 0;
    double step = acos (0) / (AROUND - 1), grow = exp (step);
    int rings = (int) lround (log (10) / step) + 1;
    grow = exp (log (10) / (rings - 1));
    snprintf (path, sizeof path, "%s/p.csv", folder);
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    for (int i = 0; i < rings; i++) for (int k = 0; k < AROUND; k++, n++) {
            double r = 0.1 * pow (grow, i), t = step * k, size = r * step, low = i ? r / grow : r,
                   high = i + 1 < rings ? r * grow : r;
            double area = 0.125 * ((high + r) * (high + r) - (low + r) * (low + r)) * step
                          * (k == 0 || k + 1 == AROUND ? 0.5 : 1);
            int inside = i > 0 && i + 1 < rings && k > 0 && k + 1 < AROUND;
            if (inside) r += 0.1 * size * next (&seed), t += 0.1 * step * next (&seed);
            fprintf (f, "%.17g %.17g %.17g 0 %.17g\n", unit * r * cos (t), unit * r * sin (t),
                     unit * unit * area, unit * (equal ? 0.06 : size));
    }
    fclose (f);
    return n;
}

/* Largest error of a linear field prescribed on the two arcs and the two straight sides. */
static double patch_error (double unit, int equal, const char *method, int threads, double *keep)
{
    char more[500];
    size_t n = 2 * write_rings (unit, equal);
    snprintf (more, sizeof more,
              STATIC
              "sets: {rim: {where: 'x^2 + y^2 > %.17g or x^2 + y^2 < %.17g or x < %.17g or y < %.17g'}}\n"
              "boundary: [{set: rim, displacement: {x: '1e-3*x', y: '-2e-4*y'}}]\n",
              0.9999 * unit * unit, 0.01001 * unit * unit, 1e-6 * unit, 1e-6 * unit);
    run r = scene_from (2, threads, method, more);
    assert_int_equal (2 * r.problem->cloud.n, n);
    double *exact = pg_calloc (n, sizeof *exact);
    for (size_t i = 0; i < n; i++) exact[i] = slope[i % 2] * r.problem->cloud.x[i];
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL),
           error = largest_difference (u, exact, n) / largest_of (exact, n);
    if (keep) memcpy (keep, u, n * sizeof *u);
    pg_free (exact), pg_free (u);
    clear (&r);
    return error;
}

static void patches_bear_spacings_of_ten_to_one (void **state)
{
    (void) state;
    const char *method = "approximation: rkpm, horizon: 2.2 spacing, essential: transformation";
    double u[2][1000] = { { 0 } }, error = patch_error (1, 0, method, 1, u[0]);
    print_message ("linear patch on perturbed points, nodal: %.3g (equal steps 0.0144)\n", error);
    check_below (error, 0.025);
    patch_error (1, 0, method, 3, u[1]);
    assert_memory_equal (u[0], u[1], sizeof u[0]);
    check_relative (patch_error (1e-6, 0, method, 1, NULL), error, 1e-6);
}

/* From a fracture energy every bond breaks at its own stretch ~ (support)^(-1/2). */
static void a_fracture_energy_follows_the_support (void **state)
{
    (void) state;
    const char *more = STATIC "failure: {criterion: stretch, fracture_energy: 100 J/m2}\nboundary: [{set: "
                              "left, displacement: {x: 0}}]\n";
    cloud_of c = { 1, 10, 0, 1.15, 0, 1, 0 };
    run r = scene_with (&c, 1, "approximation: rkpm, horizon: 2.2 spacing", more);
    const pg_problem *p = r.problem;
    const pg_criterion *law = p->criterion;
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    double *u = pg_calloc (p->cloud.n, sizeof *u), *used = pg_calloc (r.state->nbond, sizeof *used);
    for (size_t i = 0; i < p->cloud.n; i++) u[i] = 1e-3 * p->cloud.x[i];
    advance (&r);
    check_ok (force->judge (self, r.state, u, &(pg_judging){ .utilisation = used }));
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
    for (size_t i = 0; i < p->cloud.n; i++) for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        size_t j = (size_t) f->node[e];
        double reach = 0.5 * (p->cloud.size[i] + p->cloud.size[j]) / p->cloud.h;
        if (j != i) check_relative (used[e], 1e-3 / (law->parameter[0] / sqrt (reach)), 1e-9);
    }
    char text[300];
    pg_criterion_describe (law, text, sizeof text);
    check_contains (text, "at the mean spacing");
    pg_free (u), pg_free (used);
    clear (&r);
}

static void a_point_without_support_is_named (void **state)
{
    (void) state;
    cloud_of c = { 2, 6, 0, 1, 0, 1, 0 };
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    char path[128];
    write_points (&c);
    snprintf (path, sizeof path, "%s/p.csv", folder);
    FILE *f = fopen (path, "a");
    fprintf (f, "2.5,0.5,0.01,0,0.1\n");               /* far from all others */
    fclose (f);
    snprintf (path, sizeof path, "%s/scene.yaml", folder);
    check_ok (pg_scene_parse (
        &scene,
        "dimension: 2\npoints: p.csv\nmaterials: {rock: {youngs_modulus: 1, poissons_ratio: 0.2}}\n"
        "method: {approximation: rkpm, integration: nodal, horizon: 2 spacing}\n" STATIC,
        path));
    check_fails (pg_problem_build (&p, scene, 1), PG_E_SCENE);
    check_contains (pg_last_error (), "point 37 at (2.5, 0.5) m sees 1 points");
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (linear_fields_are_exact),
        cmocka_unit_test (patches_bear_spacings_of_ten_to_one),
        cmocka_unit_test (a_fracture_energy_follows_the_support),
        cmocka_unit_test (a_point_without_support_is_named),
    };
    return cmocka_run_group_tests_name ("scene_runs/graded", tests, make_folder, drop_folder);
}
