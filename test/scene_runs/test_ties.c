/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies whose surfaces pass points of the lattice, corners and middles of cells exactly: what is a tie in
 * the geometry - two axes that a normal follows equally, two neighbours of a small cell, of a part that a
 * crack cuts off or of a small patch, a point as near to two faces - is decided neither by rounding nor by
 * the numbers of axes and cells. Energy and forces at the support are those of the body in another unit,
 * place, mirrored, turned by 90 degrees. */
#include "run.h"

/* The place p of the body, in spacings, becomes length T p + shift, m. */
typedef struct { const char *name; double length, T[2][2], shift; } image;

#define AS_IT_IS { { 1, 0 }, { 0, 1 } }
static const image images[] = {
    { "as it is", 0.05, AS_IT_IS, 0 },
    { "in mm", 5e-5, AS_IT_IS, 0 },
    { "in inches", 0.00127, AS_IT_IS, 0 },
    { "nudged", 0.05, AS_IT_IS, 6e-14 },
    { "shifted", 0.05, AS_IT_IS, 0.6 },
    { "far away", 0.05, AS_IT_IS, 600 },
    { "a million metres away", 0.05, AS_IT_IS, 1e6 },
    { "mirrored in x", 0.05, { { -1, 0 }, { 0, 1 } }, 0 },
    { "mirrored in y", 0.05, { { 1, 0 }, { 0, -1 } }, 0 },
    { "turned", 0.05, { { 0, -1 }, { 1, 0 } }, 0 },
};
enum { IMAGES = sizeof images / sizeof *images };

/* A plate, and what is cut out of it: a disk of some radius about the first vertex, or a polygon; of two
 * vertices a crack. */
typedef struct { double width, height, ratio; } plate;
static const plate usual = { 8, 6, 0.25 };
typedef struct { const char *name; double radius; int n; double vertex[4][2]; } cut;
static const cut cuts[] = {
    { "a disk about a point", 2.3, 1, { { 4, 3 } } },
    { "a disk through points", 2, 1, { { 4, 3 } } },
    { "a disk about the middle of an edge", 1.5, 1, { { 4.5, 3 } } },
    { "a disk that touches the middles of edges", 1.5, 1, { { 4.5, 2.5 } } },
    { "a chamfer", 0, 3, { { 8.5, 3 }, { 8.5, 6.5 }, { 5, 6.5 } } },
    { "a diamond", 0, 4, { { 2, 3 }, { 4, 1 }, { 6, 3 }, { 4, 5 } } },
    { "a rectangle", 0, 4, { { 3.1, 2.1 }, { 4.9, 2.1 }, { 4.9, 3.9 }, { 3.1, 3.9 } } },
};
enum { CUTS = sizeof cuts / sizeof *cuts };
static const cut nothing = { "nothing", 0, 0, { { 0 } } },
                 slope = { "a crack at 45 degrees", 0, 2, { { 1.3, -1 }, { 6.8, 4.5 } } };

static void place (const image *v, const double *x, double *y)
{
    for (int i = 0; i < 2; i++) y[i] = v->length * (v->T[i][0] * x[0] + v->T[i][1] * x[1]) + v->shift;
}

static void shape_of (const cut *c, const image *v, char *text, size_t size)
{
    double y[2];
    static const char *const begin[] = { "", ", {subtract: {disk: {center: ", "]\ncracks: [{polyline: [",
                                         ", {subtract: {polygon: {vertices: [" },
                      *const end[] = { "]", "", "]}]", "]}}}]" };
    int kind = c->n > 3 ? 3 : c->n;
    size_t at = (size_t) snprintf (text, size, "%s", begin[kind]);
    for (int k = 0; k < c->n; k++) {
        place (v, c->vertex[k], y);
        at += (size_t) snprintf (text + at, size - at, "%s[%.17g, %.17g]", k ? ", " : "", y[0], y[1]);
    }
    if (c->n == 1) snprintf (text + at, size - at, ", radius: %.17g}}}]", c->radius * v->length);
    else snprintf (text + at, size - at, "%s", end[kind]);
}

/* The side of the image that the left one (sign -1) or the right one (1) becomes. */
static const char *side (const image *v, int sign)
{
    if (v->T[0][0] != 0) return sign * v->T[0][0] < 0 ? "left" : "right";
    return sign * v->T[1][0] < 0 ? "bottom" : "top";
}

/* Energy over length^2, and the force of the support over length, in the axes of the body itself. */
static void results_of (const plate *p, const cut *c, const image *v, const char *lattice, const char *method,
                        double *out)
{
    char shape[400];
    double a[2], b[2], pull[2];
    place (v, (double[2]) { 0, 0 }, a), place (v, (double[2]) { p->width, p->height }, b);
    for (int i = 0; i < 2; i++) pull[i] = 1e6 * v->T[i][0] + 3e5 * v->T[i][1];
    shape_of (c, v, shape, sizeof shape);
    run r = scene_of (
        1,
        "dimension: 2\nplane: strain\nbody: [{add: {box: {low: [%.17g, %.17g], high: [%.17g, %.17g]}}}%s\n"
        "spacing: %.17g\nlattice: %s\n"
        "materials: {rock: {youngs_modulus: 1e9, poissons_ratio: %.17g}}\nfailure: {criterion: none}\n"
        "method: {%s}\n"
        "boundary:\n  - {set: %s, displacement: {x: 0, y: 0}}\n"
        "  - {set: %s, traction: {x: %.17g, y: %.17g}}\nsolver: {stepping: fixed, steps: 1}\n",
        fmin (a[0], b[0]), fmin (a[1], b[1]), fmax (a[0], b[0]), fmax (a[1], b[1]), shape, v->length, lattice,
        p->ratio, method, side (v, -1), side (v, 1), pull[0], pull[1]);
    to_the_end (&r);
    out[0] = pg_solver_report (r.solver, r.state)->energy.strain / (v->length * v->length);
    for (int j = 0; j < 2; j++)
        out[1 + j] = (v->T[0][j] * r.step.reaction[0] + v->T[1][j] * r.step.reaction[1]) / v->length;
    clear (&r);
}

static void check_one (const plate *p, const cut *c, const char *lattice, const char *method)
{
    double first[3], other[3], worst = 0;
    results_of (p, c, &images[0], lattice, method, first);
    assert_true (first[0] > 0 && isfinite (first[0]));
    for (int v = 1; v < IMAGES; v++) {
        double shift = images[v].shift / images[v].length, allowed = 1e-9 + 1e-12 * shift;
        results_of (p, c, &images[v], lattice, method, other);
        for (int k = 0; k < 3; k++) {
            double off = fabs (other[k] - first[k]) / fabs (first[k ? 1 : 0]);
            if (!(off <= allowed)) print_message ("%s, %s: %d\n", c->name, images[v].name, k);
            check_below (off, allowed);
            worst = fmax (worst, off);
        }
    }
    print_message ("%s, %s, %s: %.1e\n", c->name, lattice, method, worst);
}

static void check_all (const char *lattice, const char *method)
{
    for (int c = 0; c < CUTS; c++) check_one (&usual, &cuts[c], lattice, method);
}

#define LINEAR "horizon: 2 spacing, kernel: gaussian, integration: "
static void points_and_gauss (void **unused) { (void) unused, check_all ("nodes", LINEAR "gauss"); }
static void points_and_consistent (void **unused) { (void) unused, check_all ("nodes", LINEAR "consistent"); }
static void centres_and_gauss (void **unused) { (void) unused, check_all ("cells", LINEAR "gauss"); }
static void centres_and_consistent (void **unused)
{
    (void) unused;
    check_all ("cells", LINEAR "consistent");
}

/* Quadrature points at nodes, where the kernel has a kink. */
static void a_kink_at_nodes (void **unused)
{
    (void) unused;
    check_all ("cells", "integration: gauss, basis: quadratic, horizon: 2.6 spacing, kernel: conical");
}

/* Two neighbours of what a crack cuts off a cell: no evaluation point lies there. */
static void parts_beside_a_crack (void **unused)
{
    (void) unused;
    check_one (&usual, &slope, "nodes", LINEAR "consistent");
}

/* Two neighbours of the patch at a corner: it is small, as three points an axis are too many for seven. */
static void patches_at_corners (void **unused)
{
    (void) unused;
    check_one (&(plate) { 6, 6, 0.4999 }, &nothing, "nodes", "integration: nodal, horizon: 2 spacing");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (points_and_gauss),
        cmocka_unit_test (points_and_consistent),
        cmocka_unit_test (centres_and_gauss),
        cmocka_unit_test (centres_and_consistent),
        cmocka_unit_test (a_kink_at_nodes),
        cmocka_unit_test (parts_beside_a_crack),
        cmocka_unit_test (patches_at_corners),
    };
    return cmocka_run_group_tests_name ("scene_runs/ties", tests, NULL, NULL);
}
