/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies from meshes: points, volumes, sets and blocks of every kind of element, patches, units, faults. */
#include "run.h"
#include "mesh/grid.h"
#include <unistd.h>

static char folder[64], path[128];

static int make_folder (void **state)
{
    (void) state;
    snprintf (folder, sizeof folder, "/tmp/perigal_mesh_XXXXXX");
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

#define rock "materials: {steel: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}}\n"
static const char *const both = "materials: {steel: {youngs_modulus: 10 GPa, poissons_ratio: 0.25}, foam: "
                                "{youngs_modulus: 1 GPa, poissons_ratio: 0.1}}\n";
#define STATIC "solver: {steps: 1, stepping: fixed}\noutput: {at: {levels: 1}}\n"

static pg_status scene_text (pg_scene **scene, const grid *g, const char *mesh, const char *more)
{
    char text[4000], file[128];
    snprintf (text, sizeof text, "dimension: %d\nmesh: {file: grid.msh%s}\n%s", pg_element_types[g->kind].dim,
              mesh, more);
    snprintf (file, sizeof file, "%s/scene.yaml", folder);
    return pg_scene_parse (scene, text, file);
}

static pg_problem *problem_of (const grid *g, const char *mesh, const char *more)
{
    pg_scene *scene;
    pg_problem *p;
    grid_file (g, path);
    check_ok (scene_text (&scene, g, mesh, more));
    check_ok (pg_problem_build (&p, scene, 1));
    pg_scene_free (&scene);
    return p;
}

static run run_of (const grid *g, int threads, const char *mesh, const char *more)
{
    run r = { 0 };
    grid_file (g, path);
    check_ok (scene_text (&r.scene, g, mesh, more));
    check_ok (pg_problem_build (&r.problem, r.scene, threads));
    check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
    check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
    check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
    return r;
}

static void faulty (const grid *g, const char *mesh, const char *more, const char *part)
{
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    grid_file (g, path);
    pg_status status = scene_text (&scene, g, mesh, more);
    if (status == PG_OK) status = pg_problem_build (&p, scene, 1);
    if (status != PG_E_SCENE) fail_msg ("no fault '%s'", part);
    check_contains (pg_last_error (), part);
    pg_scene_free (&scene);
}

static int side_of (int dim) { return dim == 3 ? 4 : dim == 2 ? 6 : 8; }

/* ---- geometry ------------------------------------------------------------------------------------------ */
static void volumes_areas_and_sets_of_every_element (void **state)
{
    (void) state;
    for (int kind = PG_BAR2; kind < PG_ELEMENTS; kind++) for (int corners = 0; corners < 2; corners++) {
        const pg_element_type *t = &pg_element_types[kind];
        grid g = { (pg_element) kind, side_of (t->dim), 0.05, 1000, 0 };
        pg_problem *p = problem_of (&g, corners ? ", unit: mm, points: corners" : ", unit: mm", both);
        double volume = 0, cells = 0, area = 0, sum[3] = { 0 };
        for (size_t i = 0; i < p->cloud.n; i++) {
            assert_true (p->cloud.volume[i] > 0 && p->cloud.size[i] > 0);
            volume += p->cloud.volume[i];
        }
        for (size_t c = 0; c < p->cells.n; c++) cells += p->cells.volume[c];
        for (size_t f = 0; f < p->cells.nfacet; f++) {
            area += p->cells.area[f];
            for (int k = 0; k < t->dim; k++)
                sum[k] += p->cells.area[f] * p->cells.normal[f * (size_t) t->dim + (size_t) k];
        }
        check_relative (volume, 1, 1e-12);
        check_relative (cells, 1, 1e-12);
        check_relative (area, 2 * t->dim, 1e-12);
        for (int k = 0; k < t->dim; k++) check_absolute (sum[k], 0, 1e-13);
        check_relative (p->cloud.high[0], 1, 1e-14);
        size_t along = (size_t) (t->order == 2 && !corners ? 2 * g.n + 1 : g.n + 1);
        const pg_set *clamp = pg_sets_find (&p->sets, "clamp"), *left = pg_sets_find (&p->sets, "left");
        assert_non_null (clamp);
        assert_non_null (pg_sets_find (&p->sets, t->dim > 1 ? "tip.top" : "tip.right"));
        assert_int_equal (clamp->nfacet, left->nfacet);
        assert_int_equal (clamp->npoint, left->npoint);
        assert_memory_equal (clamp->facet, left->facet, left->nfacet * sizeof *left->facet);
        if (t->dim == 1) assert_int_equal (p->cloud.n, along);
        for (int s = PG_NODES; s <= PG_POINTS; s++)
            for (size_t q = 0; q < p->rows[s].n; q++) {
                double x = p->rows[s].x[q * (size_t) t->dim];
                if (g.bend > 0 && fabs (x - 0.5) < 0.06) continue;
                assert_int_equal (p->block[s][q], x > 0.5);
            }
        pg_problem_free (&p);
    }
}

static void spacings_follow_the_edges (void **state)
{
    (void) state;
    for (int corners = 0; corners < 2; corners++) {
        grid g = { PG_QUAD8, 6, 0, 1, 1 };
        pg_problem *p = problem_of (&g, corners ? ", points: corners" : "", rock);
        for (size_t i = 0; i < p->cloud.n; i++)
            check_relative (p->cloud.size[i], corners ? 1.0 / 6 : 1.0 / 12, 1e-12);
        check_relative (p->approx.horizon, 2 * p->cloud.h, 1e-14);
        pg_problem_free (&p);
        p = problem_of (&g, ", support: equal", rock);
        assert_null (p->cloud.size);
        check_relative (p->cloud.h, 1.0 / 12, 1e-12);
        pg_problem_free (&p);
    }
}

/* Rectangles of 2 x 0.5 m, turned by 30 degrees: three times three of them in a file. */
static pg_problem *rectangles (const char *mesh, const char *more)
{
    pg_scene *scene = NULL;
    pg_problem *p = NULL;
    grid g = { PG_QUAD4, 3, 0, 1, 1 };
    FILE *to = fopen (path, "w");
    assert_non_null (to);
    fprintf (to, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n16\n");
    for (int i = 0; i < 16; i++)
        fprintf (to, "%d %.17g %.17g 0\n", i + 1, sqrt (0.75) * 2 * (i % 4) - 0.5 * 0.5 * (i / 4),
                 0.5 * 2 * (i % 4) + sqrt (0.75) * 0.5 * (i / 4));
    fprintf (to, "$EndNodes\n$Elements\n9\n");
    for (int e = 0; e < 9; e++) {
        int first = 1 + e % 3 + 4 * (e / 3);
        fprintf (to, "%d 3 2 1 1 %d %d %d %d\n", e + 1, first, first + 1, first + 5, first + 4);
    }
    fprintf (to, "$EndElements\n");
    fclose (to);
    check_ok (scene_text (&scene, &g, mesh, more));
    check_ok (pg_problem_build (&p, scene, 1));
    pg_scene_free (&scene);
    return p;
}

/* Supports are as long and as wide as the elements: along both edges each point sees its neighbours up to the
 * same number of edges, and none beyond. */
static void anisotropic_supports_follow_the_elements (void **state)
{
    (void) state;
    pg_problem *p = rectangles (", support: anisotropic", rock "method: {horizon: 2.5 spacing}\n");
    const double along[2] = { sqrt (0.75), 0.5 }, across[2] = { -0.5, sqrt (0.75) };
    assert_non_null (p->cloud.metric);
    check_relative (p->cloud.h, 2, 1e-12);
    for (size_t i = 0; i < p->cloud.n; i++) {
        check_relative (p->cloud.size[i], 2, 1e-12);
        check_relative (pg_cloud_length2 (&p->cloud, i, along), 1, 1e-12);
        check_relative (pg_cloud_length2 (&p->cloud, i, across), 16, 1e-12);
        check_relative (pg_cloud_slender (&p->cloud, i), sqrt (8.5), 1e-12);
    }
    const pg_family *f = &p->rows[PG_NODES].family;
    for (size_t i = 0; i < p->cloud.n; i++) {
        size_t sees = 0;
        for (int j = 0; j < 16; j++) {
            int a = abs (j % 4 - (int) i % 4), b = abs (j / 4 - (int) i / 4);
            sees += a * a + b * b < 6.25;
        }
        assert_int_equal (f->start[i + 1] - f->start[i], sees);
    }
    pg_problem_free (&p);
    for (int kind = PG_TRI3; kind < PG_ELEMENTS; kind++) {
        grid g = { (pg_element) kind, 4, 0.1, 1, 1 };
        p = problem_of (&g, ", support: anisotropic, points: corners", rock);
        f = &p->rows[PG_POINTS].family;                /* each place sees the corners of its own element */
        for (size_t q = 0; q < f->n; q++)
            assert_true (f->start[q + 1] - f->start[q] >= (size_t) pg_element_types[kind].corners);
        pg_problem_free (&p);
    }
    grid g = { PG_QUAD4, 4, 0, 1, 1 };
    faulty (&g, ", support: anisotropic", rock "method: {support: tensor}\n", "method.support: radial");
    faulty (&g, ", support: anisotropic", rock "method: {force: bond}\n", "anisotropic needs shape");
}

static void a_perturbed_mesh_keeps_its_cells_and_surface (void **state)
{
    (void) state;
    grid g = { PG_TRI3, 6, 0.05, 1, 1 };
    pg_problem *p = problem_of (&g, "", rock);
    char more[400];
    snprintf (more, sizeof more, "%sperturb: {amount: 0.2}\n", rock);
    pg_problem *q = problem_of (&g, "", more);
    size_t moved = 0;
    const pg_set *all = pg_sets_find (&p->sets, "left");
    for (size_t i = 0; i < p->cloud.n; i++) {
        double d = fmax (fabs (p->cloud.x[2 * i] - q->cloud.x[2 * i]),
                         fabs (p->cloud.x[2 * i + 1] - q->cloud.x[2 * i + 1]));
        int rim = p->cloud.x[2 * i] == 0 || p->cloud.x[2 * i] == 1 || p->cloud.x[2 * i + 1] == 0
                  || p->cloud.x[2 * i + 1] == 1;
        if (rim) assert_true (d == 0);
        else check_below (d, 0.2 * p->cloud.size[i]);
        moved += d > 0;
    }
    assert_int_equal (moved, 25);
    assert_true (all->npoint > 0);
    assert_memory_equal (p->cells.x, q->cells.x, p->cells.start[p->cells.n] * 2 * sizeof (double));
    pg_problem_free (&p), pg_problem_free (&q);
}

/* ---- blocks -------------------------------------------------------------------------------------------- */
/* A bar of two materials in series, pulled at its end: each half stretches by its own modulus. Smooth shape
 * functions round the kink off: an error of the order of the spacing, 1.2 % here. */
static void blocks_have_their_own_materials (void **state)
{
    (void) state;
    const char *const how[3] = {
        "", "blocks: [{block: steel, material: steel}, {block: 2, material: foam}]\n",
        "blocks: [{block: 1, material: steel}, {where: 'x > 0.5', material: foam}]\n"
    };
    for (int k = 0; k < 3; k++) {
        char more[1200];
        snprintf (more, sizeof more,
                  "%s%smethod: {approximation: rkpm, integration: consistent}\nboundary: [{set: clamp, "
                  "displacement: {x: 0}}, {set: tip, traction: {x: 1 MPa}}]\n" STATIC,
                  both, how[k]);
        grid g = { PG_BAR2, 32, 0, 1, 0 };
        run r = run_of (&g, 1, "", more);
        to_the_end (&r);
        double *u = field_of (&r, NULL, "displacement", NULL);
        const pg_set *tip = pg_sets_find (&r.problem->sets, "tip");
        print_message ("tip of two halves: %.6g, exact %.6g\n", u[tip->point[0]], 0.5e6 / 10e9 + 0.5e6 / 1e9);
        check_relative (u[tip->point[0]], 0.5e6 / 10e9 + 0.5e6 / 1e9, 0.015);
        pg_free (u);
        clear (&r);
    }
}

static void chosen_blocks_are_a_mesh_of_their_own (void **state)
{
    (void) state;
    for (int kind = PG_BAR2; kind < PG_ELEMENTS; kind += 4) {
        grid g = { (pg_element) kind, 4, 0, 1, 0 };
        pg_problem *p = problem_of (&g, ", blocks: [foam]",
                                    "materials: {foam: {youngs_modulus: 1, poissons_ratio: 0.2}}\n");
        double volume = 0;
        for (size_t i = 0; i < p->cloud.n; i++) volume += p->cloud.volume[i];
        check_relative (volume, 0.5, 1e-12);
        check_relative (p->cloud.low[0], 0.5, 1e-14);
        assert_int_equal (p->part.mesh.nblock, 1);
        assert_int_equal (pg_sets_find (&p->sets, "clamp")->npoint, 0);
        assert_int_equal (pg_sets_find (&p->sets, "tip")->nfacet, pg_sets_find (&p->sets, "right")->nfacet);
        pg_problem_free (&p);
    }
}

/* ---- faults -------------------------------------------------------------------------------------------- */
static void what_is_wrong_is_named (void **state)
{
    (void) state;
    grid g = { PG_TRI3, 4, 0, 1, 0 }, bent = { PG_QUAD9, 2, 0.6, 1, 1 }, square = { PG_QUAD4, 4, 0, 1, 1 };
    faulty (&g, ", blocks: [steel, cork]", both,
            "mesh.blocks[1] = cork: the mesh has no block of this name; there are steel|foam");
    faulty (&g, ", unit: kg", both, "mesh.unit = kg: is no unit of length");
    faulty (&g, "", rock "blocks: [{block: 7, material: steel}]\n",
            "blocks[0].block = 7: the mesh has no block of this name or number; there are steel|foam");
    faulty (&g, "", rock "blocks: [{block: steel, material: steel}]\n", "no entry claims");
    faulty (&g, "", rock "sets: {clamp: {where: 'x > 0'}}\n",
            "this set is always there or comes with the mesh");
    faulty (&bent, "", rock, "turns inside out: its Jacobian falls to");
    faulty (&square, "", rock "method: {horizon: 1 spacing}\n", "too few or too flat a set for a strain");
}

static void names_of_sets_are_cleaned (void **state)
{
    char out[57];
    (void) state;
    pg_set_name (out, "bolt hole.1");
    assert_string_equal (out, "bolt_hole_1");
    pg_set_name (out, "all");
    assert_string_equal (out, "mesh_all");
    pg_set_name (out, "a name of more than fifty-six letters, which is cut at its end");
    assert_int_equal (strlen (out), 56);
}

static void each_failed_allocation_is_reported (void **state)
{
    (void) state;
    grid g = { PG_TRI6, 2, 0, 1, 0 };
    pg_scene *scene;
    char more[600];
    grid_file (&g, path);
    snprintf (more, sizeof more, "%sperturb: {amount: 0.1}\n", rock);
    check_ok (scene_text (&scene, &g, ", blocks: [steel]", more));
    size_t before = pg_memory_used ();
    pg_status status = PG_E_MEMORY;
    for (size_t k = 1; status != PG_OK; k++) {
        pg_mesh_body body = { 0 };
        pg_cloud cloud = { 0 };
        pg_cells cells = { 0 };
        pg_memory_fail_at (k);
        status = pg_mesh_body_read (&body, scene);
        if (status == PG_OK) status = pg_mesh_body_cloud (&cloud, &body, scene);
        if (status == PG_OK) status = pg_cells_from_mesh (&cells, &body, 1);
        pg_memory_fail_at (0);
        if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
        pg_cells_clear (&cells), pg_cloud_clear (&cloud), pg_mesh_body_clear (&body);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 2000);
    }
    pg_scene_free (&scene);
}

/* ---- patches ------------------------------------------------------------------------------------------- */
static const double slope[3] = { 1e-3, -2e-4, 5e-4 };

/* Linear field on the whole surface by Nitsche; error at the nodes over the largest displacement. */
static double patch_error (const grid *g, int threads, const char *mesh, const char *method, double *keep)
{
    char more[1000];
    int dim = pg_element_types[g->kind].dim;
    snprintf (more, sizeof more,
              "%smethod: {approximation: rkpm, %s}\nsets: {rim: {boundary: all}}\nboundary: [{set: rim, "
              "displacement: {x: '1e-3*x'%s%s}}]\n" STATIC,
              rock, method, dim > 1 ? ", y: '-2e-4*y'" : "", dim > 2 ? ", z: '5e-4*z'" : "");
    run r = run_of (g, threads, mesh, more);
    size_t n = r.problem->cloud.n * (size_t) dim;
    double *exact = pg_calloc (n, sizeof *exact);
    for (size_t i = 0; i < n; i++) exact[i] = slope[i % (size_t) dim] * r.problem->cloud.x[i];
    to_the_end (&r);
    double *u = field_of (&r, NULL, "displacement", NULL),
           error = largest_difference (u, exact, n) / largest_of (exact, n);
    if (keep) memcpy (keep, u, n * sizeof *u);
    pg_free (exact), pg_free (u);
    clear (&r);
    return error;
}

static void patches_on_every_element (void **state)
{
    (void) state;
    for (int kind = PG_BAR2; kind < PG_ELEMENTS; kind++) {
        const pg_element_type *t = &pg_element_types[kind];
        grid g = { (pg_element) kind, side_of (t->dim), 0.03, 1, 1 };
        double e[4];
        int fine = t->order == 2 ? 2 : 0;             /* as the default        */
        if (t->dim == 3) g.n = 2;
        for (int k = 0; k < 4; k++) {
            char method[200];
            snprintf (method, sizeof method, "basis: %s, horizon: %s spacing, gauss_points: %d",
                      k < 2 ? "linear" : "quadratic", k < 2 ? "2" : "3.1",
                      (int) fmin (5, (k < 2 ? 2 : 3) + k % 2 + fine));
            e[k] = patch_error (&g, 1, "", method, NULL);
        }
        print_message ("%-8s linear, default points and 1 more: %.2g %.2g; quadratic: %.2g %.2g\n", t->name,
                       e[0], e[1], e[2], e[3]);
        for (int k = 0; k < 4; k++) check_below (e[k], 0.007);
    }
}

static void the_number_of_threads_changes_no_bit (void **state)
{
    (void) state;
    grid g = { PG_TRI6, 8, 0.03, 1, 1 };
    double u[2][600] = { { 0 } };
    for (int k = 0; k < 2; k++) patch_error (&g, k ? 3 : 1, ", unit: mm", "horizon: 2 spacing", u[k]);
    assert_true (u[0][100] != 0);
    assert_memory_equal (u[0], u[1], sizeof u[0]);
}

static void consistent_patches_on_every_element (void **state)
{
    (void) state;
    for (int kind = PG_BAR2; kind < PG_ELEMENTS; kind++) {
        const pg_element_type *t = &pg_element_types[kind];
        double e[4];
        for (int k = 0; k < 4; k++) {
            grid g = { (pg_element) kind, t->dim == 3 ? 2 : side_of (t->dim), k % 2 ? 0.03 : 0, 1, 1 };
            e[k] = patch_error (&g, 1, "",
                                k < 2 ? "integration: consistent"
                                      : "integration: consistent, basis: quadratic, horizon: 3.1 spacing",
                                NULL);
        }
        /* hex8, tet10 bent: 2e-7, 1e-8 */
        for (int k = 0; k < 4; k++) check_below (e[k], k == 1 ? 5e-7 : 1e-11);
        print_message ("%-8s consistent, straight and bent: linear %.2g %.2g, quadratic %.2g %.2g\n", t->name,
                       e[0], e[1], e[2], e[3]);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (volumes_areas_and_sets_of_every_element),
        cmocka_unit_test (spacings_follow_the_edges),
        cmocka_unit_test (anisotropic_supports_follow_the_elements),
        cmocka_unit_test (a_perturbed_mesh_keeps_its_cells_and_surface),
        cmocka_unit_test (blocks_have_their_own_materials),
        cmocka_unit_test (chosen_blocks_are_a_mesh_of_their_own),
        cmocka_unit_test (what_is_wrong_is_named),
        cmocka_unit_test (names_of_sets_are_cleaned),
        cmocka_unit_test (each_failed_allocation_is_reported),
        cmocka_unit_test (patches_on_every_element),
        cmocka_unit_test (the_number_of_threads_changes_no_bit),
        cmocka_unit_test (consistent_patches_on_every_element),
    };
    return cmocka_run_group_tests_name ("scene_runs/mesh", tests, make_folder, drop_folder);
}
