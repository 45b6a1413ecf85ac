/* SPDX-License-Identifier: GPL-3.0-or-later
 * No memory on the whole way from a scene file to a result folder, in 3D and, for every entry of every
 * catalogue and every force with every solver, in 2D: each allocation fails once (the short test: each of the
 * first, then some of the rest). Nothing crashes, nothing is lost, and the status says so. A new entry of a
 * catalogue fails the last test until a scene here uses it. */
#include "app/results/folder.h"
#include <unistd.h>

#define BLOCK \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [0.4, 0.3, 0.2]}}}]\nspacing: 0.1\n" \
    "cracks: [{disc: {center: [0.2, 0.15, 0.1], normal: [0, 1, 0], radius: 0.1}}]\nsets: {topmost: {where: " \
    "y > 0.15}}\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2, density: 2000}}\n" \
    "output: {fields: [displacement, damage, stress], pictures: [], gauges: [{name: mouth, from: [0.2, " \
    "0.1, 0.1], to: [0.2, 0.2, 0.1]}],\n" \
    "  averages: [{name: axial, set: topmost, field: stress.yy}, {name: strain, set: topmost, field: " \
    "strain.yy}]}\n"
#define METHOD "method: {gauss_points: 1, horizon: 1.5 spacing, essential: transformation}\n"

static const char static_scene[] = BLOCK METHOD
    "failure: {criterion: principal_stress, tensile_strength: 1 MPa}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 1 "
    "mm}}]\nsolver: {stepping: fixed, steps: 2, break: all}\n";
static const char newmark_scene[] = BLOCK METHOD
    "failure: {criterion: mohr_coulomb, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 40 deg}\n"
    "boundary: [{set: bottom, velocity: {x: 0, y: -20 m/s, z: 0}}, {set: top, velocity: {y: 20 m/s}}]\n"
    "solver: {kind: newmark, dt: 20 us, end: 80 us, rayleigh: {mass: 10 1/s}}\n";

static const char turning_scene[] = BLOCK
    "method: {force: gmpd, beam: timoshenko, horizon: 2 spacing}\nfailure: {criterion: beam_limits, "
    "fracture_energy: 1 J/m2}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: bottom, rotation: {x: 0, y: 0, z: "
    "0}}, {set: top, displacement: {y: 0.2 mm}}]\n"
    "solver: {stepping: fixed, steps: 2, break: all}\n";
static const char dilating_scene[] = BLOCK
    "method: {force: gmpd, volumetric: on, bond_poisson: 0.1, horizon: 2 spacing}\nfailure: {criterion: "
    "beam_limits, fracture_energy: 1 J/m2}\n"
    "boundary: [{set: bottom, velocity: {x: 0, y: -20 m/s, z: 0}}, {set: top, velocity: {y: 20 m/s}}, {set: "
    "top, moment: {z: 1 kN m}}]\n"
    "solver: {kind: verlet, end: 100 us}\n";

static const char soft_scene[] = BLOCK
    "method: {gauss_points: 1, horizon: 1.5 spacing, essential: nitsche, dilatation: projected}\nfailure: "
    "{criterion: drucker_prager, tensile_strength: 1 MPa, cohesion: 5 MPa, friction_angle: 40 deg}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0, z: 0}}, {set: top, displacement: {y: 1 "
    "mm}}]\nsolver: {stepping: fixed, steps: 2, break: all}\n";

/* ---- which entries of the catalogues have been swept --------------------------------------------------- */
/* "kind:name|" for each entry that a run of this program used. */
static char used_entries[4096];

static int was_used (const char *kind, const char *name)
{
    char word[128];
    snprintf (word, sizeof word, "|%s:%s|", kind, name);
    return strstr (used_entries, word) != NULL;
}

static void note_used (const char *kind, const char *name)
{
    size_t n = strlen (used_entries);
    if (!was_used (kind, name)) snprintf (used_entries + n, sizeof used_entries - n, "|%s:%s|", kind, name);
}

static void note_run (const run *r)
{
    const pg_problem *p = r->problem;
    note_used ("force", p->method->name);
    note_used ("solver", r->options.kind);
    note_used ("linear", r->options.linear);
    note_used ("material", p->material[0].type->name);
    note_used ("writer", pg_scene_text (r->scene, "output.format"));
    if (p->criterion[0].type) note_used ("criterion", p->criterion[0].type->name);
    if (p->method->shape_functions) note_used ("approximation", p->form.approx.type->name);
    if (p->method->shape_functions) note_used ("integration", p->form.integration->name);
}

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
    note_run (&r);
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

/* Fails the `first` allocations of a scene one by one, and about `rest` of the others. breaks: bonds must
 * break on the way. Where refused is given, the scene may be refused instead: 1 then, else 0. */
static void sweep_some (const char *text, size_t first, size_t rest, int breaks, int *refused)
{
    char folder[64], path[96];
    long broken = 0;
    make_folder (folder);
    snprintf (path, sizeof path, "%s/block.yaml", folder);
    write_scene (path, text);
    /* fonts, units, BLAS: what lasts for the process */
    pg_status plain = run_file (path, folder, &broken);
    if (refused && (*refused = plain == PG_E_SCENE)) {
        printf ("# refused: %s\n", pg_last_error ());
        remove_folder (folder);
        return;
    }
    check_ok (plain);
    size_t used = pg_memory_used (), calls = pg_memory_calls (), unharmed = 0, tried = 0;
    check_ok (run_file (path, folder, &broken));
    calls = pg_memory_calls () - calls;
    assert_true ((broken > 0 || !breaks) && calls > 300);
    assert_int_equal (pg_memory_used (), used);
    for (size_t k = 1; k <= calls; k += longer () || k < first ? 1 : 1 + calls / rest, tried++) {
        pg_memory_fail_at (k);
        pg_status status = run_file (path, folder, &broken);
        pg_memory_fail_at (0);
        if ((status != PG_E_MEMORY && status != PG_OK) || pg_memory_used () != used)
            print_error ("allocation %zu of %zu: '%s', %zu bytes lost\n", k, calls, pg_last_error (),
                         pg_memory_used () - used);
        assert_true (status == PG_E_MEMORY || status == PG_OK);
        assert_int_equal (pg_memory_used (), used);
        unharmed += status == PG_OK;                   /* pictures and the error of the stress, which warn */
    }
    if (unharmed * 20 > tried + 20)
        print_error ("%zu of %zu failing allocations went unseen\n", unharmed, tried);
    assert_true (unharmed * 20 <= tried + 20);
    remove_folder (folder);
}

static void sweep (const char *text, size_t first, size_t rest) { sweep_some (text, first, rest, 1, NULL); }

static void a_static_block_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (static_scene, 20, 30);
}
static void a_block_of_patches_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (soft_scene, 20, 30);
}
static void a_newmark_block_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (newmark_scene, 20, 30);
}
static void a_micropolar_block_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (turning_scene, 20, 30);
}
static void a_marching_block_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (dilating_scene, 20, 30);
}

/* ---- every force, integration and solver --------------------------------------------------------------- */
#define PLATE \
    "dimension: 2\nplane: stress\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [6 mm, 8 " \
    "mm]}}}]\nspacing: 1 mm\n%s\n" \
    "cracks: [{from: [-1 mm, 4 mm], to: [2 mm, 4 mm]}]\nmaterials: {glass: {youngs_modulus: 72 GPa, " \
    "poissons_ratio: %s, density: 2440 kg/m3}}\nmethod: {%s}\n" \
    "failure: {criterion: %s}\nsets: {up: {where: y > 6 mm}, down: {where: y < 2 mm}}\nboundary: [{set: " \
    "down, displacement: {x: 0, y: 0}}, {set: up, displacement: {%s}}]\n" \
    "solver: {%s}\noutput: {at: {levels: 3}, fields: [displacement, damage], pictures: []}\n"
#define STRETCH "stretch, critical_stretch: 1e-4"

typedef struct { const char *name, *lattice, *poisson, *method, *criterion, *solver; } plan;
static const char pulled[] = "x: 0, y: 20 um", moved[] = "x: 0, y: '20 um * t / (0.1 us)'";
static const plan plans[] = {
    { "lps, verlet", "lattice: cells", "0.2", "force: lps, horizon: 2.5 spacing", STRETCH,
      "kind: verlet, end: 1 us" },
    { "lps, central, live volumes of a list", "perturb: {amount: 0.2}", "0.2",
      "force: lps, horizon: 2.5 spacing, weighted_volume: live", STRETCH,
      "kind: central, end: 1 us, rayleigh: {mass: 10 1/s}" },
    { "lps, static without a matrix", "lattice: cells", "0.4", "force: lps, horizon: 2.5 spacing", STRETCH,
      "kind: static, linear: pcg, stepping: fixed, steps: 2, break: all" },
    { "lps by transforms, verlet", "lattice: cells", "0.2",
      "force: lps, horizon: 2.5 spacing, evaluation: fft", STRETCH, "kind: verlet, end: 1 us" },
    { "fcbm, relax", "lattice: cells", "0.333333333333333", "force: fcbm, horizon: 2.5 spacing",
      "node_energy, fracture_energy: 0.1 J/m2", "kind: relax" },
    { "fcbm, verlet", "lattice: cells", "0.333333333333333", "force: fcbm, horizon: 2.5 spacing",
      "node_energy, fracture_energy: 0.1 J/m2", "kind: verlet, end: 1 us" },
    { "bond, adr", "lattice: cells", "0.333333333333333", "force: bond, horizon: 2.5 spacing", STRETCH,
      "kind: adr" },
    { "bond, central, list, finite stretch", "perturb: {amount: 0.2}", "0.333333333333333",
      "force: bond, horizon: 2.5 spacing, surface_correction: volume, stretch: finite", STRETCH,
      "kind: central, end: 1 us" },
    { "bond, newmark", "lattice: cells", "0.333333333333333", "force: bond, horizon: 2.5 spacing", STRETCH,
      "kind: newmark, dt: 0.1 us, end: 1 us, break: all" },
    { "bond, event stepping", "lattice: cells", "0.333333333333333", "force: bond, horizon: 2.5 spacing",
      STRETCH, "kind: static, stepping: event, max_events: 3" },
    { "gmpd, newmark", "lattice: cells", "0.2", "force: gmpd, horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 0.1 J/m2", "kind: newmark, dt: 0.1 us, end: 1 us" },
    { "gmpd, relax, list", "perturb: {amount: 0.2}", "0.2", "force: gmpd, horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 0.1 J/m2", "kind: relax" },
    { "galerkin, consistent", "", "0.2", "approximation: rkpm, integration: consistent",
      "principal_stress, tensile_strength: 10 MPa", "kind: static, stepping: event, max_events: 3" },
    { "galerkin, pddo, consistent, newmark", "", "0.2", "approximation: pddo, integration: consistent",
      "principal_stress, tensile_strength: 10 MPa",
      "kind: newmark, dt: 0.1 us, end: 1 us, mass: consistent" },
    { "galerkin, nodal, umfpack", "", "0.2", "approximation: nosb, integration: nodal, essential: penalty",
      STRETCH, "kind: static, linear: umfpack, stepping: fixed, steps: 2, break: all" },
    { "galerkin, nodal, skyline", "", "0.2", "approximation: rkpm, integration: nodal, essential: nitsche",
      STRETCH, "kind: static, linear: skyline, stepping: fixed, steps: 2, break: all" },
    { "galerkin, pddo, nodal, verlet", "", "0.2",
      "approximation: pddo, integration: nodal, essential: nitsche", STRETCH, "kind: verlet, end: 1 us" },
    { "galerkin, quadratic, central", "", "0.2",
      "basis: quadratic, integration: gauss, horizon: 3.01 spacing, essential: nitsche", STRETCH,
      "kind: central, dt: 5 ns, end: 1 us" },
    { "galerkin, adr", "", "0.2", "integration: gauss, essential: nitsche", STRETCH, "kind: adr" },
};
static void every_method_survives_every_failing_allocation (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++) {
        char text[2000];
        const plan *p = &plans[k];
        int timed = strstr (p->solver, "end:") != NULL;
        snprintf (text, sizeof text, PLATE, p->lattice, p->poisson, p->method, p->criterion,
                  timed ? moved : pulled, p->solver);
        printf ("# %s\n", p->name);
        sweep (text, 1, 6);
    }
}

/* ---- every force with every solver --------------------------------------------------------------------- */
/* What each force needs, in a scene that breaks a little. */
static const plan forces[] = {
    { "galerkin", "", "0.2", "integration: gauss, essential: nitsche", STRETCH, NULL },
    { "bond", "lattice: cells", "0.333333333333333", "horizon: 2.5 spacing", STRETCH, NULL },
    { "fcbm", "lattice: cells", "0.333333333333333", "horizon: 2.5 spacing",
      "node_energy, fracture_energy: 0.1 J/m2", NULL },
    { "lps", "perturb: {amount: 0.2}", "0.2", "horizon: 2.5 spacing", STRETCH, NULL },
    { "gmpd", "perturb: {amount: 0.2}", "0.2", "horizon: 2.5 spacing",
      "beam_limits, fracture_energy: 0.1 J/m2", NULL },
};
/* What each solver needs; timed: loads grow with the time, not with a factor. */
static const struct { const char *name, *keys; int timed; } solvers[] = {
    { "static", "stepping: fixed, steps: 2, break: all", 0 },
    { "newmark", "dt: 0.1 us, end: 1 us, break: all", 1 },
    { "verlet", "end: 1 us", 1 },
    { "central", "end: 1 us", 1 },
    { "adr", "stages: 3", 0 },
    { "relax", "stages: 3", 0 },
};

/* Word k of "a|b|c"; 0: there are no more. */
static int word_of (const char *list, size_t k, char word[64])
{
    for (; k > 0 && *list; k--) list += strcspn (list, "|"), list += *list == '|';
    snprintf (word, 64, "%.*s", (int) strcspn (list, "|"), list);
    return *list != 0;
}

static const plan *force_named (const char *name)
{
    for (size_t k = 0; k < sizeof forces / sizeof *forces; k++)
        if (strcmp (forces[k].name, name) == 0) return &forces[k];
    print_error ("force %s has no scene here\n", name);
    fail ();
    return NULL;
}

static size_t solver_named (const char *name)
{
    for (size_t k = 0; k < sizeof solvers / sizeof *solvers; k++)
        if (strcmp (solvers[k].name, name) == 0) return k;
    print_error ("solver %s has no scene here\n", name);
    fail ();
    return 0;
}

static void every_force_survives_with_every_solver (void **state)
{
    (void) state;
    char force[64], solver[64], method[200], keys[200], text[2000];
    int refused, none = 0, all = 0;
    for (size_t i = 0; word_of (pg_force_names (), i, force); i++) {
        const plan *p = force_named (force);
        int swept = 0;
        for (size_t k = 0; word_of (pg_solver_names (), k, solver); k++) {
            size_t s = solver_named (solver);
            snprintf (method, sizeof method, "force: %s, %s", force, p->method);
            snprintf (keys, sizeof keys, "kind: %s, %s", solver, solvers[s].keys);
            snprintf (text, sizeof text, PLATE, p->lattice, p->poisson, method, p->criterion,
                      solvers[s].timed ? moved : pulled, keys);
            printf ("# %s, %s\n", force, solver);
            sweep_some (text, 1, 4, 0, &refused);
            swept += !refused, none += refused, all++;
        }
        assert_true (swept >= 3);
    }
    printf ("# %d of %d pairs are refused\n", none, all);
    assert_true (none * 3 <= all);
}

/* ---- what no scene above has used ---------------------------------------------------------------------- */
static const char wooden_scene[] =
    "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [6 mm, 8 mm]}}}]\nspacing: 1 mm\n"
    "cracks: [{from: [-1 mm, 4 mm], to: [2 mm, 4 mm]}]\nmaterials: {wood: {model: orthotropic, "
    "youngs_modulus_1: 12 GPa, youngs_modulus_2: 3 GPa, youngs_modulus_3: 2 GPa, poissons_ratio_12: 0.4, "
    "poissons_ratio_13: 0.3, poissons_ratio_23: 0.3, shear_modulus_12: 1.1 GPa, angle: 0.4}}\n"
    "method: {integration: gauss, essential: nitsche}\n"
    "failure: {criterion: stretch, critical_stretch: 1e-4}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 20 um}}]\n"
    "solver: {kind: static, linear: cholmod, stepping: fixed, steps: 2, break: all}\n"
    "output: {fields: [displacement, damage], pictures: []}\n";
static void an_orthotropic_plate_survives_every_failing_allocation (void **state)
{
    (void) state;
    sweep (wooden_scene, 1, 12);
}

/* Cracks in the plane that grow by facets: from one that is there, and from the edge of an intact plate. */
#define SHEET \
    "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [10 mm, 10 mm]}}}]\n" \
    "spacing: 1 mm\nmaterials: {glass: {youngs_modulus: 72 GPa, poissons_ratio: 0.2}}\n" \
    "method: {integration: gauss, essential: nitsche}\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {x: 0, y: 20 um}}]\n" \
    "solver: {kind: static, max_events: 3}\noutput: {fields: [displacement, damage], pictures: []}\n"
static const char cloud_scene[] =
    "dimension: 2\nbody: [{add: {box: {low: [-1.5, -1.5], high: [1.5, 1.5]}}},\n"
    "  {subtract: {alpha_shape: {mesh: {file: %s/data/mesh/disk_tri3.msh}, rim: 0.05}}},\n"
    "  {subtract: {disk: {center: [0, 0], radius: 0.5}}}]\nspacing: 0.25\n"
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n";
static const char growing_scene[] =
    SHEET "cracks: [{from: [-1 mm, 5.03 mm], to: [4.1 mm, 5.03 mm]}]\n"
          "failure: {criterion: energy_release, fracture_energy: 0.1 J/m2}\n";
static const char starting_scene[] =
    SHEET "failure: {criterion: energy_release, fracture_energy: 8 J/m2, tensile_strength: 5 MPa}\n";
/* Two glasses that come apart along the interface between them, driven by a pressure on the faces. */
static const char interface_scene[] =
    "dimension: 2\nthickness: 1 mm\nbody: [{add: {box: {low: [0, 0], high: [10 mm, 10 mm]}}}]\n"
    "spacing: 1 mm\nmaterials: {a: {youngs_modulus: 72 GPa, poissons_ratio: 0.2}, "
    "b: {youngs_modulus: 60 GPa, poissons_ratio: 0.2}}\n"
    "blocks: [{material: a, where: x == x}, {material: b, where: y > 5 mm}]\n"
    "method: {integration: gauss, essential: nitsche}\ncracks: [{from: [-1 mm, 5 mm], to: [4.1 mm, 5 mm]}]\n"
    "failure: {criterion: energy_release, fracture_energy: 8 J/m2, "
    "interfaces: [{between: [a, b], fracture_energy: 0.1 J/m2}]}\n"
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: top, displacement: {x: 0, y: 20 um}}, "
    "{set: cracks, pressure: 1 MPa}]\n"
    "solver: {kind: static, max_events: 3}\n"
    "output: {fields: [displacement, damage], format: vtk, pictures: []}\n";
static void growing_cracks_survive_every_failing_allocation (void **state)
{
    (void) state;
    sweep (interface_scene, 1, 10);
    sweep (growing_scene, 1, 10);
    sweep (starting_scene, 1, 10);
}

/* Nodes of a mesh as a shape, a ring, and what is within it; Qhull's own memory is not swept. */
static void a_cloud_survives_every_failing_allocation (void **state)
{
    (void) state;
    char here[2048], text[sizeof here + sizeof cloud_scene];
    assert_non_null (getcwd (here, sizeof here));
    snprintf (text, sizeof text, cloud_scene, here);
    sweep_some (text, 1, 30, 0, NULL);
}

static void no_entry_of_a_catalogue_was_left_out (void **state)
{
    (void) state;
    const struct { const char *kind, *names; } all[] = {
        { "force", pg_force_names () },       { "solver", pg_solver_names () },
        { "criterion", pg_criterion_names () }, { "approximation", pg_approx_names () },
        { "integration", pg_integration_names () }, { "linear", pg_linear_names () },
        { "material", pg_material_names () }, { "writer", pg_writer_names () },
    };
    char name[64];
    int missing = 0;
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        for (size_t i = 0; word_of (all[k].names, i, name); i++) {
            if (was_used (all[k].kind, name)) continue;
            print_error ("%s %s: no scene here uses it\n", all[k].kind, name);
            missing++;
        }
    assert_int_equal (missing, 0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_static_block_survives_every_failing_allocation),
        cmocka_unit_test (a_block_of_patches_survives_every_failing_allocation),
        cmocka_unit_test (a_newmark_block_survives_every_failing_allocation),
        cmocka_unit_test (a_micropolar_block_survives_every_failing_allocation),
        cmocka_unit_test (a_marching_block_survives_every_failing_allocation),
        cmocka_unit_test (every_method_survives_every_failing_allocation),
        cmocka_unit_test (every_force_survives_with_every_solver),
        cmocka_unit_test (an_orthotropic_plate_survives_every_failing_allocation),
        cmocka_unit_test (growing_cracks_survive_every_failing_allocation),
        cmocka_unit_test (a_cloud_survives_every_failing_allocation),
        cmocka_unit_test (no_entry_of_a_catalogue_was_left_out),
    };
    return cmocka_run_group_tests_name ("fuzz/allocation", tests, NULL, NULL);
}
