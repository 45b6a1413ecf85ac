/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finite elements as preconditioner on meshes of tetrahedra, of first and second order: the answer is that of
 * the factor, with few iterations that do not grow with the size; rigid motions of the elements cost nothing;
 * no element spans a crack. */
#include "run.h"
#include "geometry/mesh/grid.h"
#include <math.h>
#include <unistd.h>

static char folder[64], path[128];

static int make_folder (void **state)
{
    (void) state;
    snprintf (folder, sizeof folder, "/tmp/perigal_tetrahedra_XXXXXX");
    if (!mkdtemp (folder)) return -1;
    snprintf (path, sizeof path, "%s/grid.msh", folder);
    return 0;
}

static int drop_folder (void **state)
{
    (void) state;
    unlink (path);
    return rmdir (folder);
}

static const char usual[] = "horizon: 1.5 spacing";

/* A box of tetrahedra, its inner nodes moved, held at one side and pulled and sheared at the other. */
static run box_of (pg_element kind, int n, double nu, const char *more, const char *method,
                   const char *solver)
{
    run r = { 0 };
    grid g = { kind, n, 0.06, 1, 1 };
    char text[4000], file[128];
    grid_file (&g, path);
    snprintf (file, sizeof file, "%s/scene.yaml", folder);
    snprintf (text, sizeof text,
              "dimension: 3\nmesh: {file: grid.msh}\n%s\n"
              "materials: {m: {youngs_modulus: 10 GPa, poissons_ratio: %g}}\nmethod: {%s}\n"
              "boundary:\n  - {set: clamp, displacement: {x: 0, y: 0, z: 0}}\n"
              "  - {set: tip, traction: {x: 1 MPa, y: 0.3 MPa}}\n"
              "solver: {stepping: fixed, steps: 1, %s}\noutput: {at: {levels: 1}}\n",
              more, nu, method, solver);
    check_ok (pg_scene_parse (&r.scene, text, file));
    build (&r, 1);
    return r;
}

static const char disc[] = "cracks: [{disc: {center: [0.5, 0.52, 0.5], normal: [0.3, 1, 0.2], radius: 0.3}}]",
                  through[] = "cracks: [{polygon: [[-1, 0.2, -1], [2, 0.2, -1], [2, 0.8, 2], [-1, 0.8, 2]]}]";

static double difference (const run *a, const run *b)
{
    double worst = 0, top = 0;
    for (size_t i = 0; i < a->state->ndof; i++)
        worst = fmax (worst, fabs (a->state->d[i] - b->state->d[i])), top = fmax (top, fabs (a->state->d[i]));
    return worst / top;
}

/* most: iterations allowed, about 1.3 times those measured. */
static const struct {
    pg_element kind;
    int n;
    double nu;
    const char *more, *method;
    size_t most;
} cases[] = {
    { PG_TET4, 8, 0.2, "", usual, 65 },
    { PG_TET10, 4, 0.2, "", usual, 70 },
    { PG_TET4, 6, 0.45, "", usual, 127 },
    { PG_TET10, 4, 0.45, "", usual, 127 },
    { PG_TET4, 8, 0.2, disc, usual, 60 },
    { PG_TET10, 4, 0.2, disc, usual, 63 },
    { PG_TET4, 6, 0.2, "", "horizon: 1.5 spacing, essential: penalty", 66 },
    { PG_TET10, 4, 0.2, "", "horizon: 1.5 spacing, essential: transformation", 65 },
    { PG_TET4, 6, 0.2, "", "horizon: 1.5 spacing, integration: consistent", 65 },
    { PG_TET4, 8, 0.2, "perturb: {amount: 0.15, seed: 1}", "horizon: 1.7 spacing", 68 },
};
enum { CASES = sizeof cases / sizeof *cases };

static run case_of (size_t k, const char *solver)
{
    return box_of (cases[k].kind, cases[k].n, cases[k].nu, cases[k].more, cases[k].method, solver);
}

/* PERIGAL_TEST_SIZE=long: all cases, else every other one. */
static void answers_are_those_of_the_factor (void **state)
{
    (void) state;
    for (size_t k = 0; k < CASES; k += longer () ? 1 : 2) {
        run a = case_of (k, "linear: pcg"), b = case_of (k, "linear: cholmod");
        to_the_end (&a), to_the_end (&b);
        const pg_statistics *by = pg_solver_report_now (a.solver), *factor = pg_solver_report_now (b.solver);
        assert_int_equal (strncmp (by->linear.preconditioner, "finite elements, multilevel, ", 29), 0);
        assert_int_equal (by->linear.factorizations, 0);
        assert_true (factor->linear.factorizations > 0 && factor->linear.preconditioner[0] == 0);
        if (by->linear.cg_iterations > cases[k].most * (size_t) by->linear.solves)
            fail_msg ("case %zu: %zu iterations in %ld solves", k, by->linear.cg_iterations,
                      by->linear.solves);
        double off = difference (&a, &b);
        if (!(off < 1e-6)) fail_msg ("case %zu: off by %g", k, off);
        clear (&a), clear (&b);
    }
}

static void iterations_do_not_grow_with_the_size (void **state)
{
    (void) state;
    static const struct { pg_element kind; int n[2]; } size[] = { { PG_TET4, { 6, 10 } },
                                                                  { PG_TET10, { 4, 6 } } };
    for (size_t k = 0; k < sizeof size / sizeof *size; k++) {
        size_t used[2];
        for (int i = 0; i < 2; i++) {
            run r = box_of (size[k].kind, size[k].n[i], 0.2, "", usual, "linear: pcg");
            to_the_end (&r);
            const pg_statistics *report = pg_solver_report_now (r.solver);
            used[i] = report->linear.cg_iterations / (size_t) report->linear.solves;
            clear (&r);
        }
        if ((double) used[1] > 1.25 * (double) used[0])
            fail_msg ("kind %zu: %zu iterations, then %zu", k, used[0], used[1]);
    }
}

static double dot (size_t n, const double *a, const double *b)
{
    double s = 0;
    for (size_t i = 0; i < n; i++) s += a[i] * b[i];
    return s;
}

/* The elements of a body as they are handed to the preconditioner; the force is freed. */
static pg_elements elements_of (const run *r)
{
    const pg_force_type *force = pg_force_of (r->problem);
    void *self = NULL;
    pg_elements elements;
    check_ok (force->create (&self, r->problem));
    check_ok (force->refresh (self, r->state, NULL));
    check_ok (force->spares.elements (self, &elements));
    force->free (&self);
    return elements;
}

static void the_preconditioner_is_symmetric_and_positive (void **state)
{
    (void) state;
    for (size_t k = 0; k < CASES; k++) {
        run r = case_of (k, "linear: pcg");
        pg_elements elements = elements_of (&r);
        pg_element_preconditioner *P = NULL;
        pg_element_setting setting = { .dim = 3, .x = r.problem->cloud.x };
        size_t n = r.state->ndof;
        double *a = pg_calloc (4 * n, sizeof *a), *b = a + n, *Pa = b + n, *Pb = Pa + n;
        check_ok (pg_element_preconditioner_create (&P, &elements, &setting));
        pg_preconditioner solve = pg_element_preconditioner_of (P);
        for (int turn = 0; turn < 3; turn++) {
            for (size_t i = 0; i < n; i++)
                a[i] = sin (1 + 7.3 * (double) i + turn), b[i] = cos (2.1 * (double) (i % 97) - turn);
            check_ok (solve.solve (solve.context, a, Pa));
            check_ok (solve.solve (solve.context, b, Pb));
            double aa = dot (n, a, Pa), bb = dot (n, b, Pb), ab = dot (n, a, Pb), ba = dot (n, b, Pa);
            assert_true (aa > 0 && bb > 0);
            if (!(fabs (ab - ba) < 1e-6 * sqrt (aa * bb))) fail_msg ("case %zu: %g, %g", k, ab, ba);
        }
        pg_element_preconditioner_free (&P);
        pg_free (a);
        clear (&r);
    }
}

/* Energy of the elements in a motion of the nodes. */
static double energy (const pg_elements *e, const double *u)
{
    pg_operator Q = pg_block_operator ((pg_block_matrix *) &e->Q);
    size_t n = e->Q.n * 3;
    double *f = pg_calloc (n, sizeof *f);
    Q.apply (Q.context, u, f);
    double s = dot (n, u, f);
    pg_free (f);
    return s;
}

/* Elimination puts no springs beside the elements: what turns or moves as a whole has no energy, what strains
 * has a third of that of the material, as tetrahedra are softened. */
static void only_strains_have_energy (void **state)
{
    (void) state;
    static const pg_element kind[] = { PG_TET4, PG_TET10 };
    for (size_t k = 0; k < 2; k++) {
        run r = box_of (kind[k], 4, 0.2, "", "horizon: 1.5 spacing, essential: transformation",
                         "linear: pcg");
        pg_elements elements = elements_of (&r);
        size_t n = r.problem->cloud.n;
        double *u = pg_calloc (3 * n, sizeof *u);
        const double *x = r.problem->cloud.x, E = 1e10, nu = 0.2;
        double shear = E / (1 + nu) / 2, stretch = E * (1 - nu) / (1 + nu) / (1 - 2 * nu);
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++) {
                memset (u, 0, 3 * n * sizeof *u);
                for (size_t p = 0; p < n; p++) {
                    u[3*p + i] += x[3*p + j];
                    if (i < j) u[3*p + j] -= x[3*p + i];
                    if (i > j) u[3*p + j] += x[3*p + i];
                }
                /* volume 1; turned by i < j, sheared by i > j, stretched by i = j */
                double whole = i == j ? stretch : 4 * shear, is = energy (&elements, u) / whole;
                if (i < j ? !(fabs (is) < 1e-6) : !(is > 0.25 && is < 0.4))
                    fail_msg ("kind %zu, %zu %zu: %g", k, i, j, is);
            }
        pg_free (u);
        pg_elements_clear (&elements);
        clear (&r);
    }
}

/* At a horizon of 1.85 mean edges points see as many others as those of a lattice at 2.4 spacings, and N has
 * smaller values than on a lattice at 1.85: it needs more terms. */
static void wide_supports_have_more_terms (void **state)
{
    (void) state;
    run mesh = box_of (PG_TET4, 8, 0.2, "", "horizon: 1.85 spacing", "linear: pcg"),
        lattice = scene_of (1, "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}]\n"
                               "spacing: 0.125\nmaterials: {m: {youngs_modulus: 10 GPa, poissons_ratio: "
                               "0.2}}\nmethod: {horizon: 1.85 spacing}\n"
                               "boundary: [{set: top, traction: {y: 1 MPa}}]\nsolver: {linear: pcg}\n"
                               "output: {at: {levels: 1}}\n");
    pg_elements many = elements_of (&mesh), few = elements_of (&lattice);
    assert_true (many.terms > few.terms && many.low < few.low);
    pg_elements_clear (&few), pg_elements_clear (&many);
    clear (&mesh), clear (&lattice);
}

static void no_element_spans_a_crack (void **state)
{
    (void) state;
    static const pg_element kind[] = { PG_TET4, PG_TET10 };
    for (size_t k = 0; k < 2; k++) {
        run r = box_of (kind[k], 4, 0.2, through, usual, "linear: pcg");
        pg_elements elements = elements_of (&r);
        const double *x = r.problem->cloud.x;
        size_t joined = 0, across = 0;
        /* height above the crack, whose plane rises from y = 0.2 at z = -1 to 0.8 at z = 2 */
        for (size_t i = 0; i < elements.Q.n; i++)
            for (size_t e = elements.Q.start[i]; e < elements.Q.start[i + 1]; e++) {
                size_t j = (size_t) elements.Q.node[e];
                double a = x[3*i + 1] - 0.4 - 0.2 * x[3*i + 2], b = x[3*j + 1] - 0.4 - 0.2 * x[3*j + 2];
                joined++, across += a * b < 0;
            }
        if (across) fail_msg ("kind %zu: %zu of %zu pairs across the crack", k, across, joined);
        assert_true (joined > 5 * elements.Q.n);
        pg_elements_clear (&elements);
        clear (&r);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (answers_are_those_of_the_factor),
        cmocka_unit_test (iterations_do_not_grow_with_the_size),
        cmocka_unit_test (the_preconditioner_is_symmetric_and_positive),
        cmocka_unit_test (only_strains_have_energy),
        cmocka_unit_test (wide_supports_have_more_terms),
        cmocka_unit_test (no_element_spans_a_crack),
    };
    return cmocka_run_group_tests_name ("scene_runs/tetrahedra", tests, make_folder, drop_folder);
}
