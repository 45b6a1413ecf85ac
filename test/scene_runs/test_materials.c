/* SPDX-License-Identifier: GPL-3.0-or-later
 * Two materials. Layers in a row (a strain that jumps) and side by side (a stress that jumps) against closed
 * forms; which material breaks.
 *
 * In a row, sides held: stress d / (L1/M1 + L2/M2), u piecewise linear. Side by side, sides free and equal
 * Poisson's ratios: force d/L (M1 A1 + M2 A2), u linear. M is Young's modulus where the sides are free, else
 * that of the held layer (plane stress E/(1-nu^2); plane strain and 3D E (1-nu)/((1+nu)(1-2 nu)); plane
 * strain with free sides E/(1-nu^2)). Shape functions are smooth, so a jump of strain is smeared over a
 * horizon: displacement and force are of order one in the spacing. */
#include "run.h"

typedef struct {
    const char *name, *method, *plane;                 /* plane: dimension 2 */
    int    dim, in_a_row, n[3];                        /* cells along the length, of 1 m */
    double width, perturb, limit, order;  /* m; limit of the finest error of u; order of u to reach */
} layers;

static const double E[2] = { 10e9, 20e9 }, nu[2] = { 0.2, 0.3 }, pull = 1e-3;
#define GAUSS "approximation: rkpm, integration: gauss, kernel: cubic_spline, horizon: 2 spacing"
#define GAUSS_3 GAUSS ", gauss_points: 3"
/* nodal: the interface lies midway between nodes (an odd number of cells), where their volumes meet */
#define NODAL \
    "approximation: rkpm, integration: nodal, kernel: cubic_spline, horizon: 2 spacing, essential: " \
    "transformation"

static double poisson (const layers *c, int m) { return c->in_a_row ? nu[m] : nu[0]; }

static double modulus (const layers *c, int m)
{
    double v = poisson (c, m), plane = E[m] / (1 - v * v), held = E[m] * (1 - v) / ((1 + v) * (1 - 2 * v));
    int strain = c->dim == 2 && strcmp (c->plane, "strain") == 0;
    if (!c->in_a_row) return strain ? plane : E[m];
    return c->dim == 1 ? E[m] : c->dim == 3 || strain ? held : plane;
}

static run layered_run (const layers *c, int n)
{
    static const char *const side[] = { "bottom", "top", "back", "front" };
    char box[120] = "low: [0], high: [1]", held[400] = "";
    if (c->dim == 2) snprintf (box, sizeof box, "low: [0, 0], high: [1, %g]", c->width);
    if (c->dim == 3) snprintf (box, sizeof box, "low: [0, 0, 0], high: [1, %g, %g]", c->width, c->width);
    for (int k = 0, at = 0; k < 2 * (c->dim - 1); k++)
        if (c->in_a_row || k % 2 == 0)
            at += snprintf (held + at, sizeof held - (size_t) at, ", {set: %s, displacement: {%c: 0}}",
                            side[k], "yz"[k / 2]);
    return scene_of (
        1,
        "dimension: %d\n%s%s\nbody: [{add: {box: {%s}}}]\nspacing: %.17g\nperturb: {amount: %g}\n"
        "materials: {soft: {youngs_modulus: %g, poissons_ratio: %g}, stiff: {youngs_modulus: %g, "
        "poissons_ratio: %g}}\n"
        "blocks: [{material: soft, where: x > -1}, {material: stiff, where: '%c > %g'}]\nmethod: {%s}\n"
        "boundary: [{set: left, displacement: {x: 0}}, {set: right, displacement: {x: %g}}%s]\n"
        "solver: {steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n",
        c->dim, c->dim == 2 ? "plane: " : "", c->dim == 2 ? c->plane : "", box, 1.0 / n, c->perturb, E[0],
        poisson (c, 0), E[1], poisson (c, 1), c->in_a_row ? 'x' : 'y', c->in_a_row ? 0.5 : 0.5 * c->width,
        c->method, pull, held);
}

/* Largest error of u_x over the pull, and error of the force */
static double error_of (const layers *c, int n, double *of_force)
{
    run r = layered_run (c, n);
    double M[2] = { modulus (c, 0), modulus (c, 1) }, area = pow (c->width, c->dim - 1), worst = 0;
    double stress = pull / (0.5 / M[0] + 0.5 / M[1]),
           force = area * (c->in_a_row ? stress : 0.5 * (M[0] + M[1]) * pull);
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL);
    for (size_t i = 0, dim = (size_t) c->dim; i < r.problem->cloud.n; i++) {
        double x = r.problem->cloud.x[i * dim], exact = !c->in_a_row ? pull * x
                                                        : x < 0.5    ? stress / M[0] * x
                                                                     : pull - stress / M[1] * (1 - x);
        worst = fmax (worst, fabs (u[i * dim] - exact) / pull);
    }
    *of_force = r.step.reaction[3] / force - 1;
    check_scaled (r.step.reaction[0], -r.step.reaction[3], 1e-7, force);
    pg_free (u);
    clear (&r);
    return worst;
}

static void check_layers (const layers *c)
{
    double u[3], force[3];
    for (int k = 0; k < 3; k++) u[k] = error_of (c, c->n[k], &force[k]);
    double order = log (u[0] / u[2]) / log ((double) c->n[2] / c->n[0]);
    print_message (
        "%s: n = %d, %d, %d: error of u %.1e %.1e %.1e (order %.2f), of the force %.1e %.1e %.1e\n", c->name,
        c->n[0], c->n[1], c->n[2], u[0], u[1], u[2], order, force[0], force[1], force[2]);
    check_below (u[2], c->limit);
    check_below (fabs (force[2]), c->limit);
    check_below (c->order, order);
}

static void a_bar_of_two_pieces (void **state)
{
    (void) state;
    check_layers (&(layers) { "bar", GAUSS, NULL, 1, 1, { 40, 80, 160 }, 1, 0, 1e-3, 0.8 });
    check_layers (&(layers) { "bar, nodal", NODAL, NULL, 1, 1, { 41, 81, 161 }, 1, 0, 1e-3, 0.8 });
}

static void layers_in_a_row_in_plane_stress (void **state)
{
    (void) state;
    check_layers (
        &(layers){ "row, plane stress", GAUSS, "stress", 2, 1, { 16, 32, 64 }, 0.25, 0, 1e-3, 0.8 });
}

static void layers_in_a_row_in_plane_strain (void **state)
{
    (void) state;
    check_layers (
        &(layers){ "row, plane strain", GAUSS, "strain", 2, 1, { 16, 32, 96 }, 0.125, 0, 1e-3, 0.8 });
}

static void layers_in_a_row_with_nodal_integration (void **state)
{
    (void) state;
    check_layers (&(layers) { "row, nodal", NODAL, "stress", 2, 1, { 17, 33, 129 }, 0.125, 0, 1e-3, 0.8 });
}

static void layers_in_a_row_in_3d (void **state)
{
    (void) state;
    check_layers (&(layers) { "row, 3D", GAUSS, NULL, 3, 1, { 16, 32, 96 }, 0.0625, 0, 1e-3, 0.8 });
}

static void layers_side_by_side (void **state)
{
    (void) state;
    check_layers (
        &(layers){ "side by side, plane stress", GAUSS, "stress", 2, 0, { 8, 16, 32 }, 0.5, 0, 1e-3, 0.8 });
    check_layers (
        &(layers){ "side by side, plane strain", GAUSS, "strain", 2, 0, { 8, 16, 32 }, 0.5, 0, 1e-3, 0.8 });
    check_layers (&(layers) { "side by side, 3D", GAUSS, NULL, 3, 0, { 8, 12, 20 }, 0.25, 0, 1e-3, 0.8 });
}

static void perturbed_points (void **state)
{
    (void) state;
    check_layers (
        &(layers){ "perturbed, row", GAUSS_3, "stress", 2, 1, { 16, 32, 64 }, 0.25, 0.15, 1e-3, 0.8 });
    check_layers (&(layers){
        "perturbed, side by side", GAUSS_3, "stress", 2, 0, { 16, 32, 64 }, 0.25, 0.15, 1e-3, 0.8 });
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_bar_of_two_pieces),
        cmocka_unit_test (layers_in_a_row_in_plane_stress),
        cmocka_unit_test (layers_in_a_row_in_plane_strain),
        cmocka_unit_test (layers_in_a_row_with_nodal_integration),
        cmocka_unit_test (layers_in_a_row_in_3d),
        cmocka_unit_test (layers_side_by_side),
        cmocka_unit_test (perturbed_points),
    };
    return cmocka_run_group_tests_name ("scene_runs/materials", tests, NULL, NULL);
}
