/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integration constraint (Cui 2022 eq (20), theory E4, E5): int N_I,k dV = oint N_I n_k dS under the
 * quadrature used, in 2D and 3D, asked of the force itself. Under a uniform pressure on all of the surface
 * and the strain that belongs to it, its residual at node I is the pressure times the difference of the two
 * sides. `integration: consistent` obeys it to rounding on any points; RKPM with Gauss points up to its
 * quadrature error, which falls with their number; PDDO with Gauss points not at all; nodal integration in
 * the middle of a lattice only. */
#include "scene_runs/run.h"

#define PLANE \
    "dimension: 2\nplane: %s\nthickness: 3 mm\nbody: [{add: {box: {low: [0, 0], high: [16 mm, 12 " \
    "mm]}}}]\nspacing: 2 mm\n"
#define SOLID \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [10 mm, 8 mm, 6 mm]}}}]\nspacing: 2 mm\n"
#define SLANTED \
    "dimension: 2\nplane: %s\nthickness: 3 mm\nbody: [{add: {polygon: {vertices: [[0, 0], [17 mm, 1 mm], " \
    "[14 mm, 12 mm], [3 mm, 10 mm]]}}}]\nspacing: 2 mm\n"
#define NOTCHED \
    "dimension: 3\nbody:\n  - add: {box: {low: [0, 0, 0], high: [8 mm, 8 mm, 6 mm]}}\n  - subtract: {box: " \
    "{low: [-1 mm, 4.7 mm, 1.3 mm], high: [3.4 mm, 9 mm, 7 mm]}}\nspacing: 2 mm\n"
static const char *const bodies[] = { PLANE, SOLID, SLANTED, NOTCHED };
enum { FLAT, DEEP, CUT, CUT_DEEP };

typedef struct { int body; const char *plane, *method; double perturbed; } setting;

/* Largest residual over the pressure on the side of a cell. */
static double imbalance (const setting *s)
{
    char text[1500], body[300];
    snprintf (body, sizeof body, bodies[s->body], s->plane);
    snprintf (text, sizeof text,
              "%sperturb: {amount: %g, seed: 4}\nmaterials: {m: {youngs_modulus: 70 GPa, poissons_ratio: "
              "0.3}}\nmethod: {%s}\n"
              "boundary: [{set: all, pressure: 1 MPa}]\n",
              body, s->perturbed, s->method);
    run r = prepare (1, text);
    refresh (&r, NULL);
    const pg_problem *p = r.problem;
    const pg_material *m = p->material;
    size_t dim = (size_t) p->dim, n = p->cloud.n;
    double bulk = 0, most = 0, reference, *d = pg_calloc (n * dim, sizeof *d),
           *f = pg_calloc (n * dim, sizeof *f);
    for (size_t a = 0; a < dim; a++) bulk += m->D[a];  /* all normal strains alike: stress = bulk strain */
    for (size_t i = 0; i < n * dim; i++) d[i] = -1e6 / bulk * p->cloud.x[i];
    void *self;
    const pg_force_type *force = pg_solver_force (r.solver, &self);
    check_ok (force->balance (self, 1, d, f, &reference));
    for (size_t i = 0; i < n * dim; i++) most = fmax (most, fabs (f[i]));
    pg_free (d), pg_free (f);
    double side = dim == 3 ? 4e-6 : 6e-6;              /* m^2 */
    clear (&r);
    return most / (1e6 * side);
}

static void consistent_integration_obeys_it_to_rounding (void **state)
{
    (void) state;
    static const char *const approximation[] = { "rkpm", "pddo" }, *const basis[] = {
        "linear", "quadratic, horizon: 3.01 spacing"
    };
    for (int body = FLAT; body <= CUT_DEEP; body++)
        for (int k = 0; k < 8; k++) {
            char method[200];
            if ((body == DEEP || body == CUT_DEEP) && k & 2) continue; /* quadratic in 3D takes long */
            snprintf (method, sizeof method, "approximation: %s, integration: consistent, basis: %s",
                      approximation[k & 1], basis[k >> 1 & 1]);
            double off = imbalance (
                &(setting){ body, k & 4 ? "strain" : "stress", method, k & 4 ? 0.25 : 0 });
            if (!(off <= 1e-12)) print_error ("body %d, %s: %.3g\n", body, method, off);
            check_below (off, 1e-12);
        }
}

/* off[order - 1] */
static void with_points (int body, const char *approximation, double *off)
{
    for (int order = 1; order <= 5; order++) {
        char method[200];
        snprintf (method, sizeof method, "approximation: %s, integration: gauss, gauss_points: %d",
                  approximation, order);
        off[order - 1] = imbalance (&(setting) { body, "stress", method, 0.2 });
    }
    print_message ("%s in %dD: %.3g %.3g %.3g %.3g %.3g\n", approximation, body == DEEP ? 3 : 2, off[0],
                   off[1], off[2], off[3], off[4]);
}

static void rkpm_with_gauss_points_has_an_error_of_quadrature (void **state)
{
    (void) state;
    for (int body = FLAT; body <= DEEP; body++) {
        double off[5];
        with_points (body, "rkpm", off);
        assert_true (off[0] > 0.02 && off[1] > 1e-4);
        for (int k = 1; k < 4; k++) check_below (off[k], 0.5 * off[k - 1]);
        check_relative (off[4], off[3], 0.05);         /* the facets keep their two points: theirs is left */
        check_below (off[4], 0.015 * off[0]);
    }
}

static void pddo_with_gauss_points_does_not_obey_it (void **state)
{
    (void) state;
    for (int body = FLAT; body <= DEEP; body++) {
        double off[5];
        with_points (body, "pddo", off);
        for (int k = 1; k < 5; k++) assert_true (off[k] > 0.02);
        check_relative (off[4], off[3], 0.05);         /* what is left does not fall */
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (consistent_integration_obeys_it_to_rounding),
                                        cmocka_unit_test (rkpm_with_gauss_points_has_an_error_of_quadrature),
                                        cmocka_unit_test (pddo_with_gauss_points_does_not_obey_it) };
    return cmocka_run_group_tests_name ("method/compatibility", tests, NULL, NULL);
}
