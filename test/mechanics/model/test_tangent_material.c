/* SPDX-License-Identifier: GPL-3.0-or-later
 * A material that only a tangent describes (orthotropic, added to the catalogue by this program): forces made
 * of bonds refuse it, the Galerkin force carries it; and keys that a model does not read are faults. */
#include "scenes.h"
#include <stdlib.h>

/* E along x as given, half of it along y; Poisson's ratio is none of its keys. */
static pg_status read (pg_material *m, const pg_scene *scene)
{
    double E = pg_scene_number (scene, "materials.%s.youngs_modulus", m->name);
    m->modulus = E;
    pg_elastic_tangent (m->mode, E, 0, m->D);
    m->D[pg_voigt_size (2) + 1] = 0.5 * E;
    return PG_OK;
}

static void stress (const pg_material *m, size_t n, const double *strain, double *out, double *zz)
{
    for (size_t i = 0; i < n; i++) {
        for (int a = 0; a < 3; a++) {
            out[3 * i + (size_t) a] = 0;
            for (int b = 0; b < 3; b++)
                out[3 * i + (size_t) a] += m->D[3 * a + b] * strain[3 * i + (size_t) b];
        }
        if (zz) zz[i] = 0;
    }
}

static void describe (const pg_material *m, char *text, size_t size)
{
    snprintf (text, size, "E %.6g Pa", m->modulus);
}

static const pg_key stiffness[] = {
    { .path = "materials.{}.stiffness",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .fallback = "",
      .doc = "Its only modulus." },
};
static const pg_key_table rigid_keys = { "test", stiffness, 1 };
static const pg_material_type grain = { .name = "grain",
                                        .summary = "two moduli",
                                        .keys = { &pg_keys_elastic },
                                        .read = read,
                                        .stress = stress,
                                        .describe = describe };
static const pg_material_type rigid = { .name = "one_modulus",
                                        .summary = "no Poisson's ratio",
                                        .keys = { &rigid_keys },
                                        .can = PG_MATERIAL_ISOTROPIC,
                                        .read = read,
                                        .stress = stress,
                                        .describe = describe };

#define BODY "dimension: 2\nthickness: 1\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\n"
#define GRAIN BODY "materials:\n  wood:\n    model: grain\n    youngs_modulus: 1 GPa\n    poissons_ratio: 0\n"

static void bonds_refuse_a_material_that_depends_on_the_direction (void **state)
{
    (void) state;
    static const char *const forces[] = { "bond", "fcbm", "lps", "gmpd" };
    for (size_t k = 0; k < sizeof forces / sizeof *forces; k++) {
        char text[800];
        snprintf (text, sizeof text, GRAIN "method: {force: %s}\n", forces[k]);
        check_refused (text, "test.yaml:7:5: materials.wood.model = grain: force: ");
        check_refused (text, "cannot carry a material that depends on the direction: use force: galerkin");
    }
}

static void the_galerkin_force_carries_it (void **state)
{
    (void) state;
    static const char *const along[2] = { "left, displacement: {x: 0}}, {name: c, set: bottom, displacement: "
                                          "{y: 0}}, {name: l, set: right, traction: {x: 1 MPa}}",
                                          "bottom, displacement: {y: 0}}, {name: c, set: left, displacement: "
                                          "{x: 0}}, {name: l, set: top, traction: {y: 1 MPa}}" };
    for (int axis = 0; axis < 2; axis++) {
        char text[1200];
        pg_solver *solver = NULL;
        pg_state *at = NULL;
        pg_solver_options o;
        pg_step step;
        double u[3], x[3] = { 1, 1, 0 };
        void *self;
        snprintf (text, sizeof text,
                  GRAIN "method: {integration: consistent}\nboundary: [{name: b, set: %s]\nsolver: {kind: "
                        "static}\noutput: {at: {levels: 1}}\n",
                  along[axis]);
        built b = build (text);
        check_ok (pg_solver_options_read (&o, b.problem, b.scene));
        check_ok (pg_solver_create (&solver, b.problem, &o));
        check_ok (pg_state_create (&at, b.problem, pg_solver_components (solver)));
        check_ok (pg_solver_step (solver, at, &step));
        const pg_force_type *force = pg_solver_force (solver, &self);
        check_ok (force->sample (self, at, at->d, 1, x, u, NULL, NULL));
        check_relative (u[axis], axis ? 2e-3 : 1e-3, 1e-9);
        pg_state_free (&at), pg_solver_free (&solver), unbuild (&b);
    }
}

static void a_key_that_the_model_does_not_read_is_a_fault (void **state)
{
    (void) state;
    check_refused (BODY "materials: {m: {model: one_modulus, stiffness: 1, poissons_ratio: 0.2}}\n",
                   "materials.m.poissons_ratio = 0.2: is no key of model: one_modulus, which reads "
                   "stiffness and density");
    check_refused (BODY "materials: {m: {youngs_modulus: 1, poissons_ratio: 0.2, youngs_modulus_y: 2}}\n",
                   "youngs_modulus_y");
    built b = build (
        BODY "materials: {m: {model: elastic, youngs_modulus: 1, poissons_ratio: 0.2, density: 3}}\n");
    unbuild (&b);
}

static void names_are_taken_once (void **state)
{
    (void) state;
    assert_ptr_equal (pg_material_find ("grain"), &grain);
    assert_string_equal (pg_material_names (), "elastic|orthotropic|grain|one_modulus");
    check_fails (pg_material_add (&grain), PG_E_USAGE);
    check_contains (pg_last_error (), "there is a material model grain already");
}

int main (void)
{
    if (pg_material_add (&grain) != PG_OK || pg_material_add (&rigid) != PG_OK) return EXIT_FAILURE;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (bonds_refuse_a_material_that_depends_on_the_direction),
        cmocka_unit_test (the_galerkin_force_carries_it),
        cmocka_unit_test (a_key_that_the_model_does_not_read_is_a_fault),
        cmocka_unit_test (names_are_taken_once),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
