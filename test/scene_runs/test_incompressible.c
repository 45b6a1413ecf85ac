/* SPDX-License-Identifier: GPL-3.0-or-later
 * Poisson's ratio near 1/2: with the dilatation of patches nothing locks and pressures do not oscillate; what
 * was exact stays exact. */
#include "run.h"

/* ---- thick cylinder, plane strain (Lame): radii 1 and 2, pressure 1 within, E 1 ------------------------ */
typedef struct { const char *integration, *basis, *essential; double horizon, spacing; } row;

static run cylinder (const row *c, double nu, const char *dilatation, const char *approximation)
{
    return scene_of (
        1,
        "dimension: 2\nplane: strain\nthickness: 1 m\nbody:\n"
        "  - {name: outside, add: {disk: {center: [0, 0], radius: 2}}}\n  - {name: bore, subtract: {disk: "
        "{center: [0, 0], radius: 1}}}\n"
        "  - {name: axis_y, subtract: {box: {low: [-3, -3], high: [0, 3]}}}\n  - {name: axis_x, subtract: "
        "{box: {low: [-3, -3], high: [3, 0]}}}\n"
        "spacing: %g\nmaterials: {ring: {youngs_modulus: 1, poissons_ratio: %.10g}}\n"
        "sets: {bore: {boundary: bore}, axis_y: {boundary: axis_y}, axis_x: {boundary: axis_x}}\n"
        "method: {approximation: %s, integration: %s, basis: %s, essential: %s, horizon: %g spacing, "
        "dilatation: %s}\n"
        "boundary: [{set: bore, pressure: 1 Pa}, {set: axis_y, displacement: {x: 0}}, {set: axis_x, "
        "displacement: {y: 0}}]\n"
        "solver: {kind: static}\n",
        c->spacing, nu, approximation, c->integration, c->basis, c->essential, c->horizon, dilatation);
}

/* L2 over L2; pressure: largest at a node over the largest stress, 5/3 */
typedef struct { double u, stress, pressure; } errors;

static errors lame_errors (const run *r, double nu)
{
    size_t dim = (size_t) r->problem->dim;
    int nv;
    double *u = field_of (r, NULL, "displacement", NULL), *s = field_of (r, NULL, "stress", &nv), du = 0,
           uu = 0, ds = 0, ss = 0;
    errors e = { 0, 0, 0 };
    for (size_t i = 0; i < r->problem->cloud.n; i++) {
        const double *x = r->problem->cloud.x + i * dim, *t = s + i * (size_t) nv;
        double V = r->problem->cloud.volume[i], r2 = x[0] * x[0] + x[1] * x[1],
               c2 = (x[0] * x[0] - x[1] * x[1]) / r2, s2 = 2 * x[0] * x[1] / r2;
        double scale = (1 + nu) / 3 * ((1 - 2 * nu) + 4 / r2), xx = 1. / 3 - 4 / (3 * r2) * c2,
               yy = 1. / 3 + 4 / (3 * r2) * c2, xy = -4 / (3 * r2) * s2;
        double ux = u[i * dim] - scale * x[0], uy = u[i * dim + 1] - scale * x[1], shear = t[dim] - xy;
        du += V * (ux * ux + uy * uy), uu += V * scale * scale * r2;
        ds += V * ((t[0] - xx) * (t[0] - xx) + (t[1] - yy) * (t[1] - yy) + 2 * shear * shear);
        ss += V * (xx * xx + yy * yy + 2 * xy * xy);
        e.pressure = fmax (e.pressure, fabs (t[0] + t[1] - 2. / 3) / 2 / (5. / 3));
    }
    e.u = sqrt (du / uu), e.stress = sqrt (ds / ss);
    pg_free (u), pg_free (s);
    return e;
}

static errors solved (const row *c, double nu, const char *dilatation, const char *approximation)
{
    run r = cylinder (c, nu, dilatation, approximation);
    to_the_end (&r);
    errors e = lame_errors (&r, nu);
    print_message (
        "  %-4s %-10s %-9s %-8s nu %-8g %-9s displacement %.2e, stress %.2e, pressure at a node %.2e\n",
        approximation, c->integration, c->basis, c->essential, nu, dilatation, e.u, e.stress, e.pressure);
    clear (&r);
    return e;
}

static const row rows[] = {
    { "gauss", "linear", "nitsche", 2, 0.1 },           { "gauss", "linear", "penalty", 2, 0.1 },
    { "gauss", "quadratic", "nitsche", 2.6, 0.1 },      { "gauss", "quadratic", "penalty", 2.6, 0.1 },
    { "consistent", "linear", "nitsche", 2, 0.1 },      { "consistent", "linear", "penalty", 2, 0.1 },
    { "consistent", "quadratic", "nitsche", 2.6, 0.1 }, { "consistent", "quadratic", "penalty", 2.6, 0.1 },
};

/* At the spacing where the displacement is within 0.1 % at Poisson's ratio 0.3. */
static void a_thick_cylinder_does_not_lock (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        errors usual = solved (&rows[k], 0.3, "auto", "rkpm");
        check_below (usual.u, 1e-3);
        for (double gap = 1e-2; gap > 5e-7; gap *= 1e-2) {
            errors e = solved (&rows[k], 0.5 - gap, "auto", "rkpm");
            check_below (e.u, 2e-3);
            check_below (e.stress, 0.03);
            check_below (e.pressure, 0.1);
        }
    }
}

/* Nodal integration, and derivatives that are no gradients, have errors of their own: those of Poisson's
 * ratio 0.3. */
static void other_methods_are_as_good_as_at_lower_ratios (void **state)
{
    (void) state;
    static const struct { const char *approximation; row row;
    } cases[] = { { "rkpm", { "nodal", "linear", "penalty", 2, 0.05 } },
                  { "rkpm", { "nodal", "quadratic", "nitsche", 2.6, 0.05 } },
                  { "pddo", { "nodal", "linear", "penalty", 2, 0.05 } },
                  { "nosb", { "nodal", "linear", "transformation", 2, 0.05 } },
                  { "pddo", { "gauss", "linear", "penalty", 2, 0.1 } } };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        errors usual = solved (&cases[k].row, 0.3, "auto", cases[k].approximation),
               e = solved (&cases[k].row, 0.4999, "auto", cases[k].approximation);
        check_below (e.u, 1.6 * usual.u);
        check_below (e.stress, 1.3 * usual.stress);
    }
}

static void without_patches_it_does (void **state)
{
    (void) state;
    errors e = solved (&rows[1], 0.4999, "pointwise", "rkpm");
    assert_true (e.u > 0.02 && e.stress > 1);
}

/* A slice of the same cylinder in 3D, held in its thickness. */
static void nor_does_a_slice_in_3d (void **state)
{
    (void) state;
    static const double nus[] = { 0.3, 0.4999 };
    for (int k = 0; k < 2; k++) {
        run r = scene_of (
            1,
            "dimension: 3\nbody:\n"
            "  - {name: outside, add: {cylinder: {center: [0, 0, 0], length: 0.3, radius: 2}}}\n"
            "  - {name: bore, subtract: {cylinder: {center: [0, 0, -1], length: 3, radius: 1}}}\n"
            "  - {name: axis_y, subtract: {box: {low: [-3, -3, -1], high: [0, 3, 1]}}}\n"
            "  - {name: axis_x, subtract: {box: {low: [-3, -3, -1], high: [3, 0, 1]}}}\n"
            "spacing: 0.15\nmaterials: {ring: {youngs_modulus: 1, poissons_ratio: %g}}\n"
            "sets: {bore: {boundary: bore}, axis_y: {boundary: axis_y}, axis_x: {boundary: axis_x}}\n"
            "boundary: [{set: bore, pressure: 1 Pa}, {set: axis_y, displacement: {x: 0}}, {set: axis_x, "
            "displacement: {y: 0}}, "
            "{set: back, displacement: {z: 0}}, {set: front, displacement: {z: 0}}]\nsolver: {kind: "
            "static}\n",
            nus[k]);
        to_the_end (&r);
        errors e = lame_errors (&r, nus[k]);
        print_message ("  slice in 3D, nu %g: displacement %.2e, stress %.2e, pressure at a node %.2e\n",
                       nus[k], e.u, e.stress, e.pressure);
        check_below (e.u, 0.01);
        check_below (e.stress, 0.05);
        clear (&r);
    }
}

/* ---- Timoshenko's cantilever, plane strain: 48 x 12, clamped by Nitsche's terms as the closed form is -- */
static void nor_does_a_cantilever (void **state)
{
    (void) state;
    static const double nus[] = { 0.3, 0.4999, 0.499999 };
    static const char *const integrations[] = { "gauss", "consistent" };
    for (int k = 0; k < 6; k++) {
        double nu = nus[k % 3], E = 3e7 / (1 - nu * nu), v = nu / (1 - nu), P = 1000, I = 144, du = 0, uu = 0,
               ds = 0, ss = 0;
        run r = scene_of (
            1,
            "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, -6], high: [48, 6]}}}]\nspacing: 1.5\n"
            "materials: {beam: {youngs_modulus: 3e7, poissons_ratio: %.17g}}\nmethod: {integration: %s, "
            "essential: nitsche}\n"
            "boundary: [{set: left, displacement: {x: '%.17g*y*(y^2 - 36 m^2)/(1 m^2)', y: '-%.17g*y^2/(1 "
            "m)'}},\n"
            "  {set: right, traction: {y: '-1000 Pa / 288 * (36 - y^2/(1 m^2))'}}]\nsolver: {kind: static}\n",
            nu, integrations[k / 3], P / (6 * E * I) * (2 + v), P / (6 * E * I) * 3 * v * 48);
        to_the_end (&r);
        double *u = field_of (&r, NULL, "displacement", NULL), *s = field_of (&r, NULL, "stress", NULL);
        for (size_t i = 0; i < r.problem->cloud.n; i++) {
            double x = r.problem->cloud.x[2 * i], y = r.problem->cloud.x[2 * i + 1],
                   V = r.problem->cloud.volume[i];
            double a = P * y / (6 * E * I) * ((288 - 3 * x) * x + (2 + v) * (y * y - 36));
            double b = -P / (6 * E * I)
                       * (3 * v * y * y * (48 - x) + (4 + 5 * v) * 36 * x + (144 - x) * x * x);
            double xx = P / I * (48 - x) * y, xy = -P / (2 * I) * (36 - y * y);
            du += V * ((u[2 * i] - a) * (u[2 * i] - a) + (u[2 * i + 1] - b) * (u[2 * i + 1] - b)),
                uu += V * (a * a + b * b);
            ds += V
                  * ((s[3 * i] - xx) * (s[3 * i] - xx) + s[3 * i + 1] * s[3 * i + 1]
                     + 2 * (s[3 * i + 2] - xy) * (s[3 * i + 2] - xy));
            ss += V * (xx * xx + 2 * xy * xy);
        }
        print_message ("  cantilever, %s, nu %g: displacement %.2e, stress %.2e\n", integrations[k / 3], nu,
                       sqrt (du / uu), sqrt (ds / ss));
        check_below (sqrt (du / uu), 1e-3);
        check_below (sqrt (ds / ss), 0.05);
        pg_free (u), pg_free (s);
        clear (&r);
    }
}

/* Patches of a graded mesh, which gather around roots: Kirsch's plate with CalculiX's elements as cells; its
 * largest stress is 3. */
static void nor_does_a_plate_on_a_mesh (void **state)
{
    (void) state;
    static const char *const dilatations[] = { "method.dilatation=auto", "method.dilatation=pointwise" };
    double largest[2];
    for (int k = 0; k < 2; k++) {
        const char *set[] = { "plane=strain",
                              "materials.plate.poissons_ratio=0.4999",
                              "method.basis=linear",
                              "method.horizon=\"2 spacing\"",
                              "method.essential=penalty",
                              dilatations[k] };
        run r = loaded ("data/kirsch_mesh/scene.yaml", 6, set);
        to_the_end (&r);
        double *s = field_of (&r, NULL, "stress", NULL);
        largest[k] = largest_of (s, 3 * r.problem->cloud.n);
        print_message ("  plate on a mesh, %s: largest stress %.3g\n", dilatations[k], largest[k]);
        pg_free (s);
        clear (&r);
    }
    assert_true (largest[0] > 2.4 && largest[0] < 3.6 && largest[1] > 10);
}

/* ---- what was exact stays exact ------------------------------------------------------------------------ */
#define BLOCK \
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [-1, -0.5], high: [1.1, 0.6]}}}]\nspacing: " \
    "0.1\nperturb: {amount: 0.2}\n" SOFT
#define SOFT \
    "materials: {soft: {youngs_modulus: 1, poissons_ratio: 0.4999}}\nsolver: {kind: static}\nsets: {rim: " \
    "{where: 'x < -0.999 m or x > 1.099 m or y < -0.499 m or y > 0.599 m'}}\n"

/* Largest error of the displacement of a block whose rim is held at u, over the largest displacement */
static double held_error (const char *method, const char *ux, const char *uy,
                          void (*exact) (const double *x, double *u))
{
    run r = scene_of (
        1,
        BLOCK
        "%sboundary: [{set: left, displacement: {x: '%s', y: '%s'}}, {set: right, displacement: {x: '%s', y: "
        "'%s'}}, "
        "{set: top, displacement: {x: '%s', y: '%s'}}, {set: bottom, displacement: {x: '%s', y: '%s'}}]\n",
        method, ux, uy, ux, uy, ux, uy, ux, uy);
    assert_non_null (r.problem->form.patches);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL), off = 0, top = 0;
    for (size_t i = 0; i < r.problem->cloud.n; i++) {
        double v[2];
        exact (r.problem->cloud.x + 2 * i, v);
        for (size_t k = 0; k < 2; k++)
            off = fmax (off, fabs (u[2 * i + k] - v[k])), top = fmax (top, fabs (v[k]));
    }
    pg_free (u);
    clear (&r);
    return off / top;
}

static void stretched (const double *x, double *u)
{
    u[0] = 2e-3 * x[0] + 1e-3 * x[1], u[1] = -3e-3 * x[0] - 1e-3 * x[1];
}

static const double turn = 0.4999 / (1 - 0.4999);
static void bent (const double *x, double *u)
{
    u[0] = 0.01 * x[0] * x[1], u[1] = -0.005 * x[0] * x[0] - 0.005 * turn * x[1] * x[1];
}

static void linear_fields (void **state)
{
    (void) state;
    static const char *const methods[] = {
        "method: {integration: consistent, essential: nitsche}\n",
        "method: {integration: consistent, essential: nitsche, basis: quadratic, horizon: 2.6 spacing}\n"
    };
    for (int k = 0; k < 2; k++)
        check_below (held_error (methods[k], "2e-3*x + 1e-3*y", "-3e-3*x - 1e-3*y", stretched), 1e-9);
}

/* Pressure is linear in pure bending, and so is the dilatation of a patch. */
static void bending_with_the_quadratic_basis (void **state)
{
    (void) state;
    char uy[100];
    snprintf (uy, sizeof uy, "-0.005*x*x/(1 m) - %.17g*y*y/(1 m)", 0.005 * turn);
    check_below (
        held_error (
            "method: {integration: consistent, essential: nitsche, basis: quadratic, horizon: 2.6 spacing}\n",
            "0.01*x*y/(1 m)", uy, bent),
        1e-8);
}

static void other_materials_have_the_same_bits (void **state)
{
    (void) state;
    for (int k = 0; k < 2; k++) {
        run usual = cylinder (&rows[2 * k], k ? 0.3 : 0.449, "auto", "rkpm"),
            plain = cylinder (&rows[2 * k], k ? 0.3 : 0.449, "pointwise", "rkpm");
        assert_null (usual.problem->form.patches);
        to_the_end (&usual), to_the_end (&plain);
        assert_memory_equal (usual.state->d, plain.state->d, plain.state->ndof * sizeof *plain.state->d);
        clear (&usual), clear (&plain);
    }
    run r = cylinder (&rows[0], 0.45, "auto", "rkpm");
    assert_non_null (r.problem->form.patches);
    clear (&r);
}

/* ---- symmetry and cracks ------------------------------------------------------------------------------- */
#define NOTCHED \
    "dimension: 2\nplane: strain\nbody: [{add: {polygon: {vertices: [[0, 0], [%g, 0], [%g, 1], [0, " \
    "1.3]]}}}]\nspacing: 0.1\n" \
    "materials: {soft: {youngs_modulus: 1, poissons_ratio: 0.4999}}\nmethod: {integration: %s}\ncracks: " \
    "[{from: [%g, 0], to: [%g, 0.52]}]\n" \
    "boundary: [{set: bottom, displacement: {x: 0, y: 0}}, {set: polygon.edge 3, traction: {y: 1e-3 " \
    "Pa}}]\nsolver: {kind: static}\n"

static void a_mirrored_body_has_the_mirrored_answer (void **state)
{
    (void) state;
    static const char *const integrations[] = { "gauss", "consistent", "nodal" };
    for (int k = 0; k < 3; k++) {
        run a = scene_of (1, NOTCHED, 1.1, 1.1, integrations[k], 0.53, 0.53),
            b = scene_of (1, NOTCHED, -1.1, -1.1, integrations[k], -0.53, -0.53);
        to_the_end (&a), to_the_end (&b);
        size_t n = a.problem->cloud.n, found = 0;
        assert_true (n == b.problem->cloud.n);
        double *u = field_of (&a, NULL, "displacement", NULL), *v = field_of (&b, NULL, "displacement", NULL),
               top = largest_of (u, 2 * n);
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                const double *x = a.problem->cloud.x + 2 * i, *y = b.problem->cloud.x + 2 * j;
                if (fabs (x[0] + y[0]) > 1e-6 || fabs (x[1] - y[1]) > 1e-6) continue;
                found++;
                check_scaled (v[2 * j], -u[2 * i], 1e-8, top);
                check_scaled (v[2 * j + 1], u[2 * i + 1], 1e-8, top);
            }
        assert_true (found == n);
        pg_free (u), pg_free (v);
        clear (&a), clear (&b);
    }
}

/* Patches lie across a crack through the whole body: stretching the upper half must not move the lower one by
 * a common pressure. */
static void a_crack_parts_the_patches_that_it_crosses (void **state)
{
    (void) state;
    static const char *const integrations[] = { "gauss", "consistent", "nodal" };
    for (int k = 0; k < 3; k++) {
        run r = scene_of (
            1,
            "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 0.1\n"
            "materials: {soft: {youngs_modulus: 1, poissons_ratio: 0.4999}}\nmethod: {integration: "
            "%s}\ncracks: [{from: [-0.1, 0.53], to: [1.1, 0.57]}]\n"
            "sets: {upper: {where: y > 0.58 m}}\nboundary: [{set: bottom, displacement: {x: 0, y: 0}}, "
            "{set: upper, displacement: {x: 1e-3*x, y: 2e-3*y}, essential: penalty}]\nsolver: {kind: "
            "static}\n",
            integrations[k]);
        to_the_end (&r);
        double *u = field_of (&r, NULL, "displacement", NULL), lower = 0;
        for (size_t i = 0; i < r.problem->cloud.n; i++)
            if (r.problem->cloud.x[2 * i + 1] < 0.52) lower = fmax (lower, hypot (u[2 * i], u[2 * i + 1]));
        print_message ("  %s: the lower half moves %.2e of the upper\n", integrations[k],
                       lower / largest_of (u, 2 * r.problem->cloud.n));
        check_below (lower, 1e-12 * largest_of (u, 2 * r.problem->cloud.n));
        pg_free (u);
        clear (&r);
    }
}

/* A square whose small patches at the corners have two neighbours that are as near. */
#define SQUARE \
    "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [0, 0], high: [0.6, 0.6]}}}]\nspacing: 0.1\n" SOFT

/* Stress at any place: that of the points, for a field with a pressure a thousand times the shears. */
static void places_have_the_pressure_of_their_patches (void **state)
{
    (void) state;
    static const char *const scenes[] = {
        BLOCK "method: {integration: gauss}\n", BLOCK "method: {integration: nodal}\n",
        BLOCK "method: {integration: consistent, basis: quadratic, horizon: 2.6 spacing}\n",
        SQUARE "method: {integration: nodal}\n"
    };
    static const double at[2][8] = { { 0.013, -0.21, 0.77, 0.31, -0.95, 0.55, 1.05, -0.45 },
                                     { 0.013, 0.02, 0.57, 0.04, 0.31, 0.25, 0.59, 0.1 } };
    double mu = 1 / (2 * 1.4999), lambda = 0.4999 / (1.4999 * 2e-4), volume = 1e-3;
    for (int k = 0; k < 4; k++) {
        run r = scene_of (1, "%sboundary: [{set: left, displacement: {x: 0, y: 0}}]\n", scenes[k]);
        const pg_patches *patches = r.problem->form.patches;
        const double *places = at[k == 3];
        assert_int_equal (patches->share[patches->entry[0]] < 1, k == 3);
        void *self;
        const pg_force_type *force = pg_solver_force (r.solver, &self);
        double *d = pg_calloc (r.state->ndof, sizeof *d), u[12], stress[24];
        for (size_t i = 0; i < r.problem->cloud.n; i++) stretched (r.problem->cloud.x + 2 * i, d + 2 * i);
        refresh (&r, NULL);
        check_ok (force->sample (self, r.state, d, 4, places, u, stress, NULL));
        for (int q = 0; q < 4; q++) {
            check_relative (stress[6*q], lambda * volume + 2 * mu * 2e-3, 1e-9);
            check_relative (stress[6*q + 1], lambda * volume - 2 * mu * 1e-3, 1e-9);
            check_relative (stress[6*q + 2], lambda * volume, 1e-9);
            check_scaled (stress[6*q + 3], -mu * 2e-3, 1e-9, lambda * volume);
        }
        pg_free (d);
        clear (&r);
    }
}

static void what_has_no_remedy_is_warned_of (void **state)
{
    (void) state;
    run r = cylinder (&rows[1], 0.4999, "pointwise", "rkpm");
    assert_true (r.problem->notes.n == 1);
    check_contains (r.problem->notes.text[0], "warning: material ring: Poisson's ratio is near 1/2");
    clear (&r);
    r = cylinder (&rows[1], 0.4999, "auto", "rkpm");
    assert_true (r.problem->notes.n == 1);
    check_contains (r.problem->notes.text[0], "dilatation projected: linear in each of ");
    clear (&r);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_thick_cylinder_does_not_lock),
        cmocka_unit_test (other_methods_are_as_good_as_at_lower_ratios),
        cmocka_unit_test (without_patches_it_does),
        cmocka_unit_test (nor_does_a_slice_in_3d),
        cmocka_unit_test (nor_does_a_cantilever),
        cmocka_unit_test (nor_does_a_plate_on_a_mesh),
        cmocka_unit_test (linear_fields),
        cmocka_unit_test (bending_with_the_quadratic_basis),
        cmocka_unit_test (other_materials_have_the_same_bits),
        cmocka_unit_test (a_mirrored_body_has_the_mirrored_answer),
        cmocka_unit_test (a_crack_parts_the_patches_that_it_crosses),
        cmocka_unit_test (places_have_the_pressure_of_their_patches),
        cmocka_unit_test (what_has_no_remedy_is_warned_of),
    };
    return cmocka_run_group_tests_name ("scene_runs/incompressible", tests, NULL, NULL);
}
