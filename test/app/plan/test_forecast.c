/* SPDX-License-Identifier: GPL-3.0-or-later
 * The forecast against the bodies it foretells: counts, factor, memory, what fits, and what is refused. */
#include "check.h"
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>
#include "mechanics/model/scenes.h"
#include "perigal/linalg.h"
#include "perigal/plan.h"

#define ROCK "materials: {rock: {youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}}\n"
#define CUBE "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n" ROCK
#define ROUND \
    "dimension: 2\nbody: [{add: {disk: {center: [0, 0], diameter: 1}}}, {subtract: {disk: {center: [0.1, " \
    "0], diameter: 0.2}}}]\n" ROCK
#define PUCK "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], diameter: 1, length: 0.1}}}]\n" ROCK
#define DISK \
    "dimension: 2\nbody: [{add: {disk: {center: [0, 0], diameter: 1}}}]\n" ROCK "cells: staircase\n"
#define RING ROUND "cells: staircase\n"
#define SLAB PUCK "cells: staircase\n"
#define HELD "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n"

static pg_forecast forecast (const char *text)
{
    pg_forecast f;
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    check_ok (pg_forecast_scene (&f, scene, pg_force_methods ()));
    pg_scene_free (&scene);
    return f;
}

/* ---- counts -------------------------------------------------------------------------------------------- */
static void counts_as_built (const char *text)
{
    pg_forecast f = forecast (text);
    built b = build (text);
    const pg_problem *p = b.problem;
    assert_true (f.is.counted);
    assert_true (f.count.points == (double) p->cloud.n);
    assert_true (f.count.cells == (double) p->cells.n);
    assert_true (f.count.evaluation == (double) p->bonds.rows[PG_POINTS].n);
    assert_true (f.count.bonds[PG_NODES] == (double) p->bonds.first[1]);
    assert_true (f.count.bonds[PG_POINTS] == (double) (p->bonds.first[2] - p->bonds.first[1]));
    const pg_family *bulk = &p->bonds.rows[f.is.nodal ? PG_NODES : PG_POINTS].family;
    pg_sparse G;
    check_ok (p->sums ? pg_assembly_graph_pairwise (&G, bulk)
                      : pg_assembly_graph (&G, p->cloud.n, 1, &bulk));
    assert_true (f.count.pairs == (double) G.start[G.ncol]);
    pg_sparse_clear (&G);
    unbuild (&b);
}

static void test_bar (void **state)
{
    (void) state;
    counts_as_built ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.02\n" ROCK);
}
static void test_plane (void **state)    { (void) state; counts_as_built (DISK "spacing: 0.05\n"); }
/* Rows of what a node is coupled to are longer than a machine word. */
static void test_far (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.125\nmethod: {horizon: 17 spacing}\n");
    counts_as_built (DISK "spacing: 0.125\nmethod: {horizon: 16.3 spacing, integration: nodal}\n");
}
static void test_solid (void **state)    { (void) state; counts_as_built (SLAB "spacing: 0.06\n"); }
static void test_nodal (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.03\nmethod: {integration: nodal, approximation: nosb}\n");
}
static void test_centres (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.04\nlattice: cells\n");
}
static void test_tensor (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.05\nmethod: {support: tensor}\n");
}
static void test_closed (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.05\nmethod: {kernel: constant, approximation: pddo}\n");
}
static void test_bond (void **state)
{
    (void) state;
    static const char *const more[] = { "", ", partial_volume: none", ", partial_volume: linear",
                                        ", horizon: 4.3 spacing, kernel: quadratic" };
    char text[500];
    for (int k = 0; k < 4; k++) {
        snprintf (text, sizeof text, DISK "spacing: 0.05\nmethod: {force: bond%s}\n", more[k]),
            counts_as_built (text);
        snprintf (text, sizeof text, SLAB "spacing: 0.06\nlattice: cells\nmethod: {force: bond%s}\n",
                  more[k]),
            counts_as_built (text);
    }
}
static void test_metres (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.05\nmethod: {horizon: 0.12 m}\n");
}
static void test_quadratic (void **state)
{
    (void) state;
    counts_as_built (DISK "spacing: 0.06\nmethod: {basis: quadratic, horizon: 3 spacing}\n");
}
static void test_oblong (void **state)
{
    (void) state;
    counts_as_built ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 0.33]}}}]\nspacing: "
                     "0.06\nlattice_offset: [0.3, -0.2]\ncells: staircase\n" ROCK);
}

/* Cut cells are estimated: points of evaluation, their bonds and the pairs. */
static void test_cut (void **state)
{
    static const char *const text[] = { ROUND "spacing: 0.05\n", ROUND "spacing: 0.02\n",
                                        ROUND
                                        "spacing: 0.03\nmethod: {basis: quadratic, horizon: 3 spacing}\n",
                                        PUCK "spacing: 0.06\n", PUCK "spacing: 0.04\n" };
    (void) state;
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        pg_forecast f = forecast (text[i]);
        built b = build (text[i]);
        const pg_problem *p = b.problem;
        assert_false (f.is.counted);
        assert_true (f.count.points == (double) p->cloud.n);
        check_relative (f.count.cells, (double) p->cells.n, 0.05);
        check_relative (f.count.evaluation, (double) p->bonds.rows[PG_POINTS].n, 0.1);
        check_relative (f.count.bonds[PG_POINTS], (double) (p->bonds.first[2] - p->bonds.first[1]), 0.06);
        check_ok (pg_forecast_problem (&f, p));
        assert_true (f.is.counted && f.count.cells == (double) p->cells.n);
        unbuild (&b);
    }
}

static void test_a_sample_is_near_the_count (void **state)
{
    (void) state;
    const char *text = CUBE "spacing: 0.033\n";
    pg_forecast f = forecast (text);
    built b = build (text);
    assert_false (f.is.counted);
    assert_true (f.count.points == (double) b.problem->cloud.n);
    check_relative (f.count.bonds[PG_NODES], (double) b.problem->bonds.first[1], 0.01);
    check_relative (f.count.bonds[PG_POINTS],
                    (double) (b.problem->bonds.first[2] - b.problem->bonds.first[1]), 0.01);
    check_ok (pg_forecast_problem (&f, b.problem));
    assert_true (f.is.counted
                 && f.count.bonds[PG_POINTS]
                        == (double) (b.problem->bonds.first[2] - b.problem->bonds.first[1]));
    unbuild (&b);
}

/* A hole parts bonds, which a forecast of the scene counts: an estimate, from above. */
static void test_parted_bonds_are_estimated (void **state)
{
    (void) state;
    static const char *const text[] = { RING "spacing: 0.05\nmethod: {force: bond}\n",
                                        RING "spacing: 0.05\n" };
    for (size_t i = 0; i < sizeof text / sizeof *text; i++) {
        pg_forecast f = forecast (text[i]);
        built b = build (text[i]);
        double n = (double) b.problem->bonds.first[1];
        assert_false (f.is.counted);
        check_relative (f.count.bonds[PG_NODES], n, 0.2);
        assert_true (f.count.bonds[PG_NODES] > n - (double) i);
        check_ok (pg_forecast_problem (&f, b.problem));
        assert_true (f.is.counted && f.count.bonds[PG_NODES] == n);
        unbuild (&b);
    }
}

static void test_a_coarser_lattice_is_near_the_count (void **state)
{
    (void) state;
    pg_forecast f = forecast (RING "spacing: 0.0003\n");
    check_relative (f.count.points, 0.96 * 3.14159265 / 4 / (0.0003 * 0.0003), 0.01);
    check_relative (f.count.bonds[PG_NODES] / f.count.points, 9, 0.02);
    check_relative (f.horizon, 0.0006, 1e-3);
}

static void test_wide_horizons_need_no_stencil (void **state)
{
    (void) state;
    size_t before = pg_memory_peak ();
    pg_forecast f = forecast (CUBE "spacing: 0.05\nmethod: {horizon: 50 spacing}\n");
    assert_true (f.count.points == 9261 && f.count.bonds[PG_NODES] == f.count.points * f.count.points);
    check_below ((double) (pg_memory_peak () - before), 1e7);
}

/* ---- factor -------------------------------------------------------------------------------------------- */
static void factor_is_near (const char *text, double tolerance)
{
    pg_forecast f = forecast (text);
    pg_linear_info info;
    built b = build (text);
    const pg_family *bulk = &b.problem->bonds.rows[f.is.nodal ? PG_NODES : PG_POINTS].family;
    pg_sparse G;
    check_ok (pg_assembly_graph (&G, b.problem->cloud.n, 1, &bulk));
    check_ok (pg_linear_forecast (&G, f.dim, 0, &info));
    assert_false (f.is.analysed);
    check_relative (f.factor_entries, info.factor_entries, tolerance);
    check_relative (f.factor_flops, info.flops, 2 * tolerance);
    pg_sparse_clear (&G);
    unbuild (&b);
}

static void test_law_of_a_disk (void **state)  { (void) state; factor_is_near (RING "spacing: 0.01\n", 0.2); }
static void test_law_of_a_cube (void **state)  { (void) state; factor_is_near (CUBE "spacing: 0.06\n", 0.2); }
static void test_law_of_a_slab (void **state)  { (void) state; factor_is_near (SLAB "spacing: 0.02\n", 0.2); }
static void test_law_of_wide_bonds (void **state)
{
    (void) state;
    factor_is_near (RING "spacing: 0.012\nmethod: {horizon: 3 spacing}\n", 0.2);
}

static pg_forecast analysed (const built *b, const char *text)
{
    pg_forecast f = forecast (text);
    const pg_family *seen[2] = { &b->problem->bonds.rows[PG_POINTS].family,
                                 &b->problem->bonds.rows[PG_FACETS].family };
    pg_sparse G;
    pg_linear_info info;
    check_ok (pg_forecast_problem (&f, b->problem));
    check_ok (pg_assembly_graph (&G, b->problem->cloud.n, 2, seen));
    check_ok (pg_linear_forecast (&G, b->problem->dim, b->problem->criterion->type != NULL, &info));
    pg_forecast_analysed (&f, (double) G.start[G.ncol], info.ordering, info.factor_entries, info.flops);
    pg_sparse_clear (&G);
    return f;
}

static void run_has_this_factor (const char *text)
{
    built b = build (text);
    pg_forecast f = analysed (&b, text);
    pg_solver_options o;
    pg_solver *solver = NULL;
    pg_state *s = NULL;
    pg_step step;
    check_ok (pg_solver_options_read (&o, b.problem, b.scene));
    check_ok (pg_solver_create (&solver, b.problem, &o));
    check_ok (pg_state_create (&s, b.problem, pg_solver_components (solver)));
    check_ok (pg_solver_step (solver, s, &step));
    assert_true (pg_solver_report_now (solver)->linear.factor_entries == f.factor_entries);
    assert_string_equal (pg_solver_report_now (solver)->linear.ordering, f.ordering);
    pg_state_free (&s), pg_solver_free (&solver);
    unbuild (&b);
}

static void test_analysis_is_that_of_a_run (void **state)
{
    (void) state;
    run_has_this_factor (PLATE HELD);
    run_has_this_factor (
        "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.02\n" ROCK HELD);
    run_has_this_factor (CUBE "spacing: 0.125\nboundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, "
                              "{set: top, displacement: {y: 1 mm}}]\nsolver: {linear: cholmod}\n");
}

/* ---- who solves ---------------------------------------------------------------------------------------- */
static void test_small_time_steps_factor_nothing (void **state)
{
    (void) state;
    pg_forecast small = forecast (DISK "spacing: 0.01\nsolver: {kind: newmark, dt: 2 us, end: 1 ms}\n");
    pg_forecast large = forecast (DISK "spacing: 0.01\nsolver: {kind: newmark, dt: 1 ms, end: 1 s}\n");
    assert_string_equal (pg_forecast_linear (&small), "cg");
    assert_string_equal (pg_forecast_linear (&large), "cholmod");
    assert_true (small.bytes[PG_BYTES_FACTOR] == 0 && small.bytes[PG_BYTES_MATRIX] == 0
                 && large.bytes[PG_BYTES_FACTOR] > 0);
    pg_forecast products = forecast (DISK "spacing: 0.01\nsolver: {linear: pcg}\n"),
                lu = forecast (DISK "spacing: 0.01\nsolver: {linear: umfpack}\n");
    assert_string_equal (pg_forecast_linear (&products), "cg");
    assert_string_equal (pg_forecast_linear (&lu), "umfpack");
}

/* The same stiffness is the same wave, whatever model says it. */
static void test_waves_of_any_material (void **state)
{
    (void) state;
    static const char *const material[2] = {
        "{youngs_modulus: 10 GPa, poissons_ratio: 0.25, density: 2500 kg/m3}",
        "{model: orthotropic, youngs_modulus_1: 10 GPa, youngs_modulus_2: 10 GPa, poissons_ratio_12: 0.25, "
        "shear_modulus_12: 4 GPa, density: 2500 kg/m3}"
    };
    for (int k = 0; k < 2; k++) {
        char text[900];
        snprintf (text, sizeof text,
                  "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\n"
                  "spacing: 0.02\nmaterials: {m: %s}\nsolver: {kind: newmark, dt: 40 us, end: 400 us}\n",
                  material[k]);
        pg_forecast f = forecast (text);
        assert_string_equal (pg_forecast_linear (&f), "cholmod");
    }
}

/* Large solids at rest are forecast as they are solved, by the same costs: without a factor; small ones, and
 * plain runs, with one. */
static void test_solids_are_forecast_as_they_are_solved (void **state)
{
    (void) state;
    pg_forecast small = forecast (CUBE "spacing: 0.25\n"), large = forecast (CUBE "spacing: 0.04\n"),
                plain = forecast (CUBE "spacing: 0.04\nsolver: {plain: on}\n");
    assert_string_equal (pg_forecast_linear (&small), "cholmod");
    assert_string_equal (pg_forecast_linear (&large), "cg");
    assert_string_equal (pg_forecast_linear (&plain), "cholmod");
    assert_true (large.bytes[PG_BYTES_FACTOR] == 0 && large.bytes[PG_BYTES_MATRIX] == 0);
    check_below (5 * large.peak, plain.peak);
}

/* ---- refusals ------------------------------------------------------------------------------------------ */
static void test_what_fits_is_no_error (void **state)
{
    (void) state;
    pg_forecast f = forecast (DISK "spacing: 0.05\n");
    check_ok (pg_forecast_afford (&f, f.peak));
    check_ok (pg_forecast_afford (&f, INFINITY));
}

static void test_refusal_has_the_numbers (void **state)
{
    (void) state;
    pg_forecast f = forecast (CUBE "spacing: 0.04\nsolver: {linear: cholmod}\n");
    check_fails (pg_forecast_afford (&f, 0.9 * f.peak), PG_E_LIMIT);
    check_contains (pg_last_error (), " GB of memory, and ");
    check_contains (pg_last_error (), "points at spacing 0.04 m");
    check_contains (pg_last_error (), "factor ");
    check_contains (pg_last_error (), "a spacing of 0.04");
    check_contains (pg_last_error (), "method.integration: nodal needs about");
    check_contains (pg_last_error (), "solver.linear: pcg needs about");
    check_contains (pg_last_error (), "dimension: 2");
}

static void test_the_spacing_that_fits_fits (void **state)
{
    (void) state;
    pg_forecast f = forecast (CUBE "spacing: 0.02\nsolver: {linear: cholmod}\n");
    double fit = pg_forecast_fitting (&f, 1e9);
    char text[512];
    assert_true (fit > 0.02 && fit < 0.2);
    snprintf (text, sizeof text, CUBE "spacing: %.17g\nsolver: {linear: cholmod}\n", fit);
    pg_forecast g = forecast (text);
    check_below (g.peak, 1.1e9);
    check_below (0.6e9, g.peak);
    assert_true (isinf (pg_forecast_fitting (&f, 1e6)));
}

static void test_astronomic_sizes (void **state)
{
    (void) state;
    pg_forecast f = forecast (CUBE "spacing: 0.00011\n");
    check_relative (f.count.points, 1 / (0.00011 * 0.00011 * 0.00011), 0.05);
    assert_true (f.count.bonds[PG_POINTS] > 1e13 && isfinite (f.peak) && f.peak > 1e15);
    check_fails (pg_forecast_afford (&f, 1e13), PG_E_LIMIT);
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, CUBE "spacing: 1e-9\n", "test.yaml"));
    check_fails (pg_forecast_scene (&f, scene, pg_force_methods ()), PG_E_SCENE);
    pg_scene_free (&scene);
    check_refused (CUBE "spacing: 1e-6\n",
                   "too fine for this body: 1e+18 cells, and 2147483647 are possible");
}

static void test_faults_are_faults (void **state)
{
    (void) state;
    pg_forecast f;
    pg_scene *scene = NULL;
    check_ok (pg_scene_parse (&scene, DISK "spacing: 0.1\nmethod: {horizon: 0.01 m}\n", "test.yaml"));
    check_fails (pg_forecast_scene (&f, scene, pg_force_methods ()), PG_E_SCENE);
    pg_scene_free (&scene);
}

static void test_failing_allocations (void **state)
{
    (void) state;
    pg_scene *scene = NULL;
    pg_forecast f;
    check_ok (pg_scene_parse (&scene, SLAB "spacing: 0.1\n", "test.yaml"));
    size_t used = pg_memory_used ();
    for (size_t k = 1;; k++) {
        pg_memory_fail_at (k);
        pg_status status = pg_forecast_scene (&f, scene, pg_force_methods ());
        pg_memory_fail_at (0);
        assert_int_equal (pg_memory_used (), used);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
    }
    pg_scene_free (&scene);
}

/* ---- what is left -------------------------------------------------------------------------------------- */
static char root[64];

static void put (const char *path, const char *text)
{
    char whole[256];
    snprintf (whole, sizeof whole, "%s/%s", root, path);
    for (char *s = whole + strlen (root) + 1; (s = strchr (s, '/')); *s++ = '/') *s = 0, mkdir (whole, 0777);
    FILE *f = fopen (whole, "w");
    assert_non_null (f);
    fputs (text, f);
    assert_int_equal (fclose (f), 0);
}

static int make_root (void **state)
{
    (void) state;
    snprintf (root, sizeof root, "/tmp/perigal-left-XXXXXX");
    if (!mkdtemp (root)) return -1;
    put ("proc/meminfo",
         "MemTotal:       24000000 kB\nMemFree:         1000000 kB\nMemAvailable:   20000000 kB\n");
    return 0;
}

static int drop_root (void **state)
{
    (void) state;
    char line[128];
    snprintf (line, sizeof line, "rm -rf %s", root);
    return system (line);
}

static void test_machine (void **state)
{
    (void) state;
    put ("proc/self/cgroup", "");
    assert_true (pg_available_memory (root) == 20000000 * 1024.0);
}

static void test_no_limit_in_the_group (void **state)
{
    (void) state;
    put ("proc/self/cgroup", "0::/a/b\n");
    put ("sys/fs/cgroup/a/b/memory.max", "max\n");
    put ("sys/fs/cgroup/a/b/memory.current", "1000\n");
    assert_true (pg_available_memory (root) == 20000000 * 1024.0);
}

static void test_a_group_above_limits (void **state)
{
    (void) state;
    put ("proc/self/cgroup", "0::/a/b\n");
    put ("sys/fs/cgroup/a/memory.max", "5000000000\n");
    put ("sys/fs/cgroup/a/memory.current", "3000000000\n");
    put ("sys/fs/cgroup/a/memory.stat", "anon 1\ninactive_file 1000000000\nactive_file 7\n");
    assert_true (pg_available_memory (root) == 3e9);
}

static void test_first_version_groups (void **state)
{
    (void) state;
    put ("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/not/seen/here\n0::/\n");
    put ("sys/fs/cgroup/memory/memory.limit_in_bytes", "2000000000\n");
    put ("sys/fs/cgroup/memory/memory.usage_in_bytes", "500000000\n");
    assert_true (pg_available_memory (root) == 1.5e9);
}

static void test_this_machine (void **state)
{
    (void) state;
    double left = pg_available_memory ("");
    assert_true (left > 1e6 && !isnan (left));
    assert_true (isinf (pg_available_memory ("/nowhere")) || pg_available_memory ("/nowhere") > 0);
}

#define LEFT(test) cmocka_unit_test_setup_teardown (test, make_root, drop_root)
int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (test_bar),
        cmocka_unit_test (test_plane),
        cmocka_unit_test (test_far), cmocka_unit_test (test_solid),
        cmocka_unit_test (test_nodal),
        cmocka_unit_test (test_centres),
        cmocka_unit_test (test_tensor),
        cmocka_unit_test (test_closed),
        cmocka_unit_test (test_metres),
        cmocka_unit_test (test_quadratic),
        cmocka_unit_test (test_bond),
        cmocka_unit_test (test_oblong),
        cmocka_unit_test (test_cut),
        cmocka_unit_test (test_a_sample_is_near_the_count),
        cmocka_unit_test (test_parted_bonds_are_estimated),
        cmocka_unit_test (test_a_coarser_lattice_is_near_the_count),
        cmocka_unit_test (test_wide_horizons_need_no_stencil),
        cmocka_unit_test (test_law_of_a_disk),
        cmocka_unit_test (test_law_of_a_cube),
        cmocka_unit_test (test_law_of_a_slab),
        cmocka_unit_test (test_law_of_wide_bonds),
        cmocka_unit_test (test_analysis_is_that_of_a_run),
        cmocka_unit_test (test_small_time_steps_factor_nothing),
        cmocka_unit_test (test_waves_of_any_material),
        cmocka_unit_test (test_solids_are_forecast_as_they_are_solved),
        cmocka_unit_test (test_what_fits_is_no_error),
        cmocka_unit_test (test_refusal_has_the_numbers),
        cmocka_unit_test (test_the_spacing_that_fits_fits),
        cmocka_unit_test (test_astronomic_sizes),
        cmocka_unit_test (test_faults_are_faults),
        cmocka_unit_test (test_failing_allocations),
        LEFT (test_machine),
        LEFT (test_no_limit_in_the_group),
        LEFT (test_a_group_above_limits),
        LEFT (test_first_version_groups),
        cmocka_unit_test (test_this_machine),
    };
    return cmocka_run_group_tests_name ("mechanics/model/forecast", tests, NULL, NULL);
}
