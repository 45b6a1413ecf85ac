/* SPDX-License-Identifier: GPL-3.0-or-later
 * No memory on the whole way from a scene file to a result folder, in 3D, static and Newmark: each allocation fails once (the short test:
 * each of the first, then some of the rest). Nothing crashes, nothing is lost, and the status says so. */
#include "report/folder.h"

#define BLOCK "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4, 0.3, 0.2]}}}]\nspacing: 0.1\n" \
    "cracks: [{disc: {center: [0.2, 0.15, 0.1], normal: [0, 1, 0], radius: 0.1}}]\nsets: {topmost: {where: y > 0.15}}\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\n" \
    "output: {fields: [displacement, damage, stress], pictures: [], gauges: [{name: mouth, from: [0.2, 0.1, 0.1], to: [0.2, 0.2, 0.1]}],\n" \
    "  averages: [{name: axial, set: topmost, field: stress.yy}, {name: strain, set: topmost, field: strain.yy}]}\n"
#define METHOD "method: {gauss_points: 1, horizon: 1.5 spacing, essential: transformation}\n"

static const char static_scene[] = BLOCK METHOD "failure: {criterion: principal_stress, tensile_strength: 1 MPa}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 1 mm}}]\nsolver: {stepping: fixed, steps: 2, break: all}\n";
static const char newmark_scene[] = BLOCK METHOD "failure: {criterion: mohr_coulomb, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 40 deg}\n"
    "boundary: [{set: bottom, velocity: {x: 0, y: -20 m/s, z: 0}}, {set: top, velocity: {y: 20 m/s}}]\n"
    "solver: {kind: newmark, dt: 20 us, end: 80 us, rayleigh: {mass: 10 1/s}}\n";

static const char turning_scene[] = BLOCK "method: {force: gmpd, beam: timoshenko, horizon: 2 spacing}\nfailure: {criterion: beam_limits, fracture_energy: 1 J/m2}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: bottom, rotation: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 0.2 mm}}]\n"
    "solver: {stepping: fixed, steps: 2, break: all}\n";
static const char dilating_scene[] = BLOCK "method: {force: gmpd, volumetric: on, bond_poisson: 0.1, horizon: 2 spacing}\nfailure: {criterion: beam_limits, fracture_energy: 1 J/m2}\n"
    "boundary: [{set: bottom, velocity: {x: 0, y: -20 m/s, z: 0}}, {set: top, velocity: {y: 20 m/s}}, {set: top, moment: {z: 1 kN m}}]\n"
    "solver: {kind: verlet, end: 100 us}\n";

/* Loads, builds, makes up to three steps, writes them. */
static pg_status run_file (const char *path, const char *folder, long *broken)
{
    pg_status status = PG_OK;
    run r = { 0 };
    pg_result *result = NULL;
    PG_TRY (pg_scene_load (&r.scene, path));
    PG_TRY (pg_problem_build (&r.problem, r.scene, 1));
    PG_TRY (pg_solver_options_read (&r.options, r.problem, r.scene));
    PG_TRY (pg_solver_create (&r.solver, r.problem, &r.options));
    PG_TRY (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    PG_TRY (pg_result_open (&result, folder, r.scene, r.problem, r.solver));
    for (int k = 0; k < 3 && !pg_solver_done (r.solver, r.state); k++) {
        PG_TRY (pg_solver_step (r.solver, r.state, &r.step));
        PG_TRY (pg_result_step (result, r.state, &r.step));
    }
    PG_TRY (pg_result_finish (result, r.state, NULL, 0, 0));
    *broken = r.state->broken;
done:
    pg_result_free (&result);
    clear (&r);
    return status;
}

static void write_scene (const char *path, const char *text)
{
    FILE *file = fopen (path, "w");
    assert_non_null (file);
    fputs (text, file);
    assert_int_equal (fclose (file), 0);
}

static void sweep (const char *text)
{
    char folder[64], path[96];
    const char *size = getenv ("PERIGAL_TEST_SIZE");
    long broken = 0;
    make_folder (folder);
    snprintf (path, sizeof path, "%s/block.yaml", folder);
    write_scene (path, text);
    check_ok (run_file (path, folder, &broken));       /* fonts, units, BLAS: what lasts for the process */
    size_t used = pg_memory_used (), calls = pg_memory_calls (), unharmed = 0, tried = 0;
    check_ok (run_file (path, folder, &broken));
    calls = pg_memory_calls () - calls;
    assert_true (broken > 0 && calls > 300);
    assert_int_equal (pg_memory_used (), used);
    int whole = size && strcmp (size, "long") == 0;
    for (size_t k = 1; k <= calls; k += whole || k < 20 ? 1 : 1 + calls / 60, tried++) {
        pg_memory_fail_at (k);
        pg_status status = run_file (path, folder, &broken);
        pg_memory_fail_at (0);
        if ((status != PG_E_MEMORY && status != PG_OK) || pg_memory_used () != used)
            print_error ("allocation %zu of %zu: '%s', %zu bytes lost\n", k, calls, pg_last_error (), pg_memory_used () - used);
        assert_true (status == PG_E_MEMORY || status == PG_OK);
        assert_int_equal (pg_memory_used (), used);
        unharmed += status == PG_OK;                   /* the census of the report is worth no failure */
    }
    if (unharmed * 20 > tried + 20) print_error ("%zu of %zu failing allocations went unseen\n", unharmed, tried);
    assert_true (unharmed * 20 <= tried + 20);
    remove_folder (folder);
}

static void a_static_block_survives_every_failing_allocation (void **state) { (void) state; sweep (static_scene); }
static void a_newmark_block_survives_every_failing_allocation (void **state) { (void) state; sweep (newmark_scene); }
static void a_micropolar_block_survives_every_failing_allocation (void **state) { (void) state; sweep (turning_scene); }
static void a_marching_block_survives_every_failing_allocation (void **state) { (void) state; sweep (dilating_scene); }

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_static_block_survives_every_failing_allocation),
        cmocka_unit_test (a_newmark_block_survives_every_failing_allocation),
        cmocka_unit_test (a_micropolar_block_survives_every_failing_allocation),
        cmocka_unit_test (a_marching_block_survives_every_failing_allocation),
    };
    return cmocka_run_group_tests_name ("fuzz/allocation", tests, NULL, NULL);
}
