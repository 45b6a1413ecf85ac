/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bodies from meshes: points, volumes, sets and blocks of every kind of element, patches, units, faults. */
#include "run.h"
#include "geometry/mesh/grid.h"
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
            for (size_t q = 0; q < p->bonds.rows[s].n; q++) {
                double x = p->bonds.rows[s].x[q * (size_t) t->dim];
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
        check_relative (p->form.approx.horizon, 2 * p->cloud.h, 1e-14);
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
    const pg_family *f = &p->bonds.rows[PG_NODES].family;
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
        f = &p->bonds.rows[PG_POINTS].family; /* each place sees the corners of its own element */
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

/* ---- elements of several kinds ------------------------------------------------------------------------- */
/* Three slabs of 2 x 2 cells along x: hexahedra; pyramids about the middles of the cells, with tetrahedra on
 * their last faces; tetrahedra. Planes at uneven distances, middles aside, the whole sheared. */
enum { MIXED_X = 3, MIXED_Y = 2, MIXED_ACROSS = 2 * MIXED_X + 1, MIXED_HIGH = 2 * MIXED_Y + 1 };

static long mixed_node (const int *cell, const int *corner)
{
    return 1 + 2*cell[0] + corner[0]
           + MIXED_ACROSS * (2*cell[1] + corner[1] + (long) MIXED_HIGH * (2*cell[2] + corner[2]));
}

static void mixed_element (FILE *f, long *n, pg_element kind, const int *cell, int corner[8][3])
{
    long node[PG_ELEMENT_NODES];
    for (int k = 0; k < pg_element_types[kind].corners; k++) node[k] = mixed_node (cell, corner[k]);
    ++*n;
    if (f) fprintf (f, "%ld %d 2 1 1", *n, gmsh_kind (kind)), grid_write (f, kind, node);
}

/* Elements of all cells; f NULL: only counts. */
static long mixed_elements (FILE *f)
{
    static const pg_element of_slab[MIXED_X] = { PG_HEX8, PG_PYRAMID5, PG_TET4 };
    long n = 0;
    int cell[3], corner[8][3], half[8][3];
    for (cell[2] = 0; cell[2] < MIXED_Y; cell[2]++)
        for (cell[1] = 0; cell[1] < MIXED_Y; cell[1]++)
            for (cell[0] = 0; cell[0] < MIXED_X; cell[0]++)
                for (int piece = 0; grid_pieces (of_slab[cell[0]], piece, corner); piece++) {
                    int last = cell[0] == 1;
                    for (int k = 0; k < 4; k++) last &= corner[k][0] == 2;
                    if (!last) {
                        mixed_element (f, &n, of_slab[cell[0]], cell, corner);
                        continue;
                    }
                    /* its base in two, from the lowest corner to the highest */
                    for (int part = 0; part < 2; part++) {
                        const int of[4] = { 0, 1 + part, 2 + part, 4 };
                        for (int k = 0; k < 4; k++) memcpy (half[k], corner[of[k]], sizeof *half);
                        mixed_element (f, &n, PG_TET4, cell, half);
                    }
                }
    return n;
}

static void mixed_file (void)
{
    static const double along[] = { 0, 0.13, 0.3, 0.49, 0.6, 0.8, 1 }, across[] = { 0, 0.17, 0.4, 0.65, 0.8 },
                        up[] = { 0, 0.21, 0.35, 0.5, 0.7 };
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fprintf (f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n%d\n", MIXED_ACROSS * MIXED_HIGH * MIXED_HIGH);
    for (int k = 0, n = 0; k < MIXED_HIGH; k++)
        for (int j = 0; j < MIXED_HIGH; j++)
            for (int i = 0; i < MIXED_ACROSS; i++)
                fprintf (f, "%d %.17g %.17g %.17g\n", ++n, along[i] + 0.2 * across[j],
                         across[j] - 0.1 * up[k], up[k]);
    fprintf (f, "$EndNodes\n$Elements\n%ld\n", mixed_elements (NULL));
    mixed_elements (f);
    fprintf (f, "$EndElements\n");
    fclose (f);
}

/* Translation, rotation and uniform strain prescribed on the surface: displacements and stresses inside. */
static void patches_on_mixed_elements (void **state)
{
    (void) state;
    static const struct { const char *name, *text; double shift[3], gradient[9]; } motion[] = {
        { "translation", "x: 1e-3, y: -2e-3, z: 5e-4", { 1e-3, -2e-3, 5e-4 }, { 0 } },
        { "rotation", "x: '1e-3*y + 5e-4*z', y: '-1e-3*x - 7e-4*z', z: '-5e-4*x + 7e-4*y'", { 0 },
          { 0, 1e-3, 5e-4, -1e-3, 0, -7e-4, -5e-4, 7e-4, 0 } },
        { "strain", "x: '1e-3*x + 3e-4*y', y: '-2e-4*y + 4e-4*z', z: '5e-4*z + 6e-4*x'", { 0 },
          { 1e-3, 3e-4, 0, 0, -2e-4, 4e-4, 6e-4, 0, 5e-4 } },
    };
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 2, 0 } };
    for (size_t m = 0; m < sizeof motion / sizeof *motion; m++) {
        run r = { 0 };
        grid g = { .kind = PG_HEX8 };
        char more[600];
        const double *G = motion[m].gradient, trace = G[0] + G[4] + G[8];
        int components;
        mixed_file ();
        snprintf (more, sizeof more,
                  "%smethod: {approximation: rkpm, integration: consistent}\nsets: {rim: {boundary: all}}\n"
                  "boundary: [{set: rim, displacement: {%s}}]\n" STATIC, rock, motion[m].text);
        check_ok (scene_text (&r.scene, &g, "", more));
        check_ok (pg_problem_build (&r.problem, r.scene, 1));
        check_ok (pg_solver_options_read (&r.options, r.problem, r.scene));
        check_ok (pg_solver_create (&r.solver, r.problem, &r.options));
        check_ok (pg_state_create (&r.state, r.problem, pg_solver_components (r.solver)));
        int count[PG_ELEMENTS] = { 0 };
        for (size_t e = 0; e < r.problem->part.mesh.n; e++) count[r.problem->part.mesh.kind[e]]++;
        assert_int_equal (count[PG_HEX8], 4);
        assert_int_equal (count[PG_PYRAMID5], 20);
        assert_int_equal (count[PG_TET4], 32);
        to_the_end (&r);
        size_t n = r.problem->cloud.n;
        double off = 0, most = 0, stress = 0, *u = field_of (&r, NULL, "displacement", NULL),
               *sigma = field_of (&r, NULL, "stress", &components);
        assert_int_equal (components, 6);
        for (size_t i = 0; i < n; i++) for (int a = 0; a < 3; a++) {
            const double *x = r.problem->cloud.x + 3*i;
            double exact = motion[m].shift[a] + G[3*a] * x[0] + G[3*a + 1] * x[1] + G[3*a + 2] * x[2];
            off = fmax (off, fabs (u[3*i + (size_t) a] - exact)), most = fmax (most, fabs (exact));
        }
        /* both constants of Lame are 4 GPa */
        for (size_t i = 0; i < n; i++) for (int c = 0; c < 6; c++) {
            int a = pair[c][0], b = pair[c][1];
            double exact = 4e9 * ((a == b ? trace : 0) + G[3*a + b] + G[3*b + a]);
            stress = fmax (stress, fabs (sigma[6*i + (size_t) c] - exact));
        }
        print_message ("hexahedra, pyramids and tetrahedra, %s: %.2g of u, %.2g of E u / length\n",
                       motion[m].name, off / most, stress / (10e9 * most));
        check_below (off / most, 1e-12);
        check_below (stress / (10e9 * most), 1e-11);
        pg_free (u), pg_free (sigma);
        clear (&r);
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
        cmocka_unit_test (patches_on_mixed_elements),
    };
    return cmocka_run_group_tests_name ("scene_runs/mesh", tests, make_folder, drop_folder);
}
