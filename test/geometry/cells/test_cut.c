/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells cut by the surface of the body: volumes, surfaces and moments against closed forms, order by order;
 * the divergence theorem; bodies that are moved, turned and scaled; volumes of the points; broken memory. */
#include "check.h"
#include "perigal/cells.h"

static const double pi = 3.14159265358979323846;
typedef struct { pg_scene *scene; pg_body body; pg_lattice lattice; pg_cells cells; } meshed;
typedef struct { double volume, surface, flux, close[3], first[3], second[3], least; size_t points; } sums;

static meshed mesh (const char *text, double spacing)
{
    meshed m = {0};
    check_ok (pg_scene_parse (&m.scene, text, "test.yaml"));
    check_ok (pg_body_read (&m.body, m.scene));
    check_ok (pg_lattice_fit (&m.lattice, &m.body, spacing, NULL));
    check_ok (pg_cells_cut (&m.cells, &m.body, &m.lattice, 1, 0, NULL));
    return m;
}

static void drop (meshed *m)
{
    pg_cells_clear (&m->cells);
    pg_lattice_clear (&m->lattice);
    pg_body_clear (&m->body);
    pg_scene_free (&m->scene);
}

/* ---- sums over the body at one order ------------------------------------------------------------------- */
static void add_inside (sums *s, int dim, const double *x, double w)
{
    s->volume += w, s->least = fmin (s->least, w), s->points++;
    for (int k = 0; k < dim; k++) s->first[k] += w * x[k], s->second[k] += w * x[k] * x[k];
}

static void add_outside (sums *s, int dim, const double *x, const double *n, double w)
{
    double size = 0;
    s->surface += w, s->least = fmin (s->least, w);
    for (int k = 0; k < dim; k++) s->flux += w * x[k] * n[k], s->close[k] += w * n[k], size += n[k] * n[k];
    check_absolute (size, 1, 1e-13);
}

/* Whole cells: x^2 averages to its value at the middle + h^2 / 12. */
static void add_whole (sums *s, const pg_lattice *l, const double *corner, double w)
{
    double x[3];
    for (int k = 0; k < l->dim; k++) x[k] = corner[k] + 0.5 * l->step[k];
    add_inside (s, l->dim, x, w);
    for (int k = 0; k < l->dim; k++) s->second[k] += w * l->step[k] * l->step[k] / 12;
}

static sums sum_of (const meshed *m, int order)
{
    sums s = {.least = INFINITY};
    const pg_cells *c = &m->cells;
    size_t dim = (size_t) c->dim;
    pg_cut_points p = {0};
    for (size_t i = 0; i < c->n; i++) {
        if (c->kind[i] != PG_CUT) add_whole (&s, &m->lattice, c->x + c->start[i] * dim, c->volume[i]);
        else {
            p.n = 0;
            check_ok (pg_cut_cell (&p, c, i, order));
            for (size_t k = 0; k < p.n; k++) add_inside (&s, c->dim, p.x + k * dim, p.weight[k]);
        }
    }
    for (size_t f = 0; f < c->nfacet; f++) {
        if (c->facet_kind[f] != PG_CUT)
            add_outside (&s, c->dim, c->facet_centre + f * dim, c->normal + f * dim, c->area[f]);
        else {
            p.n = 0;
            check_ok (pg_cut_facet (&p, c, f, order));
            for (size_t k = 0; k < p.n; k++)
                add_outside (&s, c->dim, p.x + k * dim, p.normal + k * dim, p.weight[k]);
        }
    }
    pg_cut_points_clear (&p);
    return s;
}

/* Volume and surface of the cells are exact; those of the rule fall at least as listed with orders 2, 4, 8;
 * x.n sums to dim V. */
static void converges (const char *name, const char *text, double spacing, double volume, double surface,
                       const double allowed[3])
{
    meshed m = mesh (text, spacing);
    double V = 0, S = 0;
    for (size_t c = 0; c < m.cells.n; c++) V += m.cells.volume[c];
    for (size_t f = 0; f < m.cells.nfacet; f++) S += m.cells.area[f];
    check_relative (V, volume, 1e-12);
    check_relative (S, surface, 1e-12);
    for (int i = 0; i < 3; i++) {
        sums s = sum_of (&m, 2 << i);
        double closed = (fabs (s.close[0]) + fabs (s.close[1]) + fabs (s.close[2])) / surface;
        print_message ("%-22s order %d: volume %.1e, surface %.1e, divergence %.1e, closed %.1e\n", name,
                       2 << i, fabs (s.volume / volume - 1), fabs (s.surface / surface - 1),
                       fabs (s.flux / (m.cells.dim * volume) - 1), closed);
        check_relative (s.volume, volume, allowed[i]);
        check_relative (s.surface, surface, allowed[i]);
        check_relative (s.flux, m.cells.dim * volume, allowed[i]);
        check_below (closed, allowed[i]);
        assert_true (s.least > 0);
    }
    drop (&m);
}

#define BOX2 "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}, "
static const double straight[3] = { 1e-13, 1e-13, 1e-13 }, gentle[3] = { 5e-6, 1e-10, 1e-12 },
                    curved[3] = { 1e-3, 2e-5, 5e-9 }, solid[3] = { 3e-4, 2e-6, 2e-10 };

static void disks_and_holes (void **state)
{
    (void) state;
    converges ("disk", "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}]", 0.1, pi, 2 * pi,
               gentle);
    converges ("disk in one cell", "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}]", 3, pi,
               2 * pi, gentle);
    converges ("hole tangent to lines", BOX2 "{subtract: {disk: {center: [0.5, 0.5], radius: 0.2}}}]", 0.1,
               1 - 0.04 * pi, 4 + 0.4 * pi, curved);
    converges ("hole within a cell", BOX2 "{subtract: {disk: {center: [0.53, 0.56], radius: 0.02}}}]", 0.1,
               1 - 4e-4 * pi, 4 + 0.04 * pi, curved);
    converges ("annulus",
               "dimension: 2\nbody: [{add: {disk: {center: [0.1, 0], radius: 1}}}, {subtract: {disk: "
               "{center: [0.3, 0.2], radius: 0.3}}}]",
               0.13, 0.91 * pi, 2.6 * pi, curved);
    converges ("thin ring",
               "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}, {subtract: {disk: {center: "
               "[0, 0], radius: 0.98}}}]",
               0.1, (1 - 0.98 * 0.98) * pi, 3.96 * pi, curved);
    converges ("two disks",
               "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}, {add: {disk: {center: [1, "
               "0], radius: 1}}}]",
               0.1, 2 * pi - 2 * pi / 3 + sqrt (3) / 2, 8 * pi / 3, gentle);
}

static void polygons (void **state)
{
    (void) state;
    double a = hypot (0.93, 0.18) + hypot (0.33, 0.71) + hypot (0.5, 0.11) + hypot (0.1, 0.78);
    converges ("oblique polygon",
               "dimension: 2\nbody: [{add: {polygon: {vertices: [[0.1, 0.02], [1.03, 0.2], [0.7, 0.91], "
               "[0.2, 0.8]]}}}]",
               0.1, 0.54935, a, straight);
    converges ("prism",
               "dimension: 3\nbody: [{add: {prism: {low: 0, high: 1, vertices: [[0.1, 0.02], [1.03, 0.2], "
               "[0.7, 0.91], [0.2, 0.8]]}}}]",
               0.2, 0.54935, a + 2 * 0.54935, straight);
    converges ("two slits in a cell",
               BOX2 "{subtract: {box: {low: [0.31, 0], high: [0.33, 0.5]}}}, {subtract: {box: {low: [0.35, "
                    "0], high: [0.36, 0.5]}}}]",
               0.1, 1 - 0.015, 6, straight);
    /* a quarter of the disk and the triangle share a cell with both surfaces */
    converges ("polygon and circle",
               "dimension: 2\nbody: [{add: {polygon: {vertices: [[0, 0], [1, 0], [0, 1]]}}}, {subtract: "
               "{disk: {center: [0, 0], radius: 0.35}}}]",
               0.13, 0.5 - pi * 0.35 * 0.35 / 4, sqrt (2) + 1.3 + pi * 0.35 / 2, curved);
}

static void cylinders_and_balls (void **state)
{
    (void) state;
    converges ("cylinder",
               "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], radius: 1, length: 1}}}]", 0.25, pi,
               4 * pi, solid);
    converges (
        "cylinder along x",
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [1, 0, 0], radius: 1, length: 1}}}]",
        0.25, pi, 4 * pi, solid);
    converges (
        "oblique cylinder",
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], axis: [1, 2, 3], radius: 1, length: 1}}}]",
        0.3, pi, 4 * pi, solid);
    converges ("ball", "dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 1}}}]", 0.25,
               4 * pi / 3, 4 * pi, solid);
    converges ("drilled ball",
               "dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 1}}}, {subtract: {cylinder: "
               "{center: [0, 0, -2], radius: 0.6, length: 4}}}]",
               0.25, 4 * pi / 3 * 0.512, 5.12 * pi, solid);
    converges ("drilled obliquely",
               "dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 1}}}, "
               "{subtract: {cylinder: {center: [-2, -4, -6], axis: [1, 2, 3], radius: 0.6, length: 20}}}]",
               0.3, 4 * pi / 3 * 0.512, 5.12 * pi, solid);
}

static void segments (void **state)
{
    (void) state;
    meshed m = mesh ("dimension: 1\nbody: [{add: {box: {low: [0], high: [1]}}}, {subtract: {box: {low: "
                     "[0.234], high: [0.567]}}}]",
                     0.1);
    sums s = sum_of (&m, 1);
    check_relative (s.volume, 0.667, 1e-14);
    check_relative (s.flux, 0.667, 1e-14);
    assert_int_equal (m.cells.nfacet, 4);
    drop (&m);
}

/* First and second moments about the centre: pi R^4 / 4, 4 pi R^5 / 15. */
static void moments (void **state)
{
    (void) state;
    meshed d = mesh ("dimension: 2\nbody: [{add: {disk: {center: [0.3, -0.2], radius: 1}}}]", 0.17);
    meshed b = mesh ("dimension: 3\nbody: [{add: {sphere: {center: [0.3, -0.2, 0.1], radius: 1}}}]", 0.3);
    const double at[3] = {0.3, -0.2, 0.1};
    sums s = sum_of (&d, 8), t = sum_of (&b, 8);
    for (int k = 0; k < 2; k++) {
        check_relative (s.first[k], pi * at[k], 1e-11);
        check_relative (s.second[k], pi / 4 + pi * at[k] * at[k], 1e-11);
    }
    for (int k = 0; k < 3; k++) {
        check_relative (t.first[k], 4 * pi / 3 * at[k], 1e-9);
        check_relative (t.second[k], 4 * pi / 15 + 4 * pi / 3 * at[k] * at[k], 1e-9);
    }
    drop (&d), drop (&b);
}

/* ---- the same body elsewhere --------------------------------------------------------------------------- */
/* x -> scale * (+-x or +-y) + shift: the errors of a low order are the same numbers. */
static void moved_bodies_agree (void **state)
{
    static const int turn[4][2][2] = {
        { { 1, 0 }, { 0, 1 } }, { { -1, 0 }, { 0, 1 } }, { { 0, -1 }, { 1, 0 } }, { { 0, 1 }, { 1, 0 } }
    };
    double first[2] = {0};
    size_t cells = 0;
    (void) state;
    for (int k = 0; k < 8; k++) {
        const int (*T)[2] = turn[k % 4];
        double scale = k < 4 ? 1 : 1e-3, shift = k < 4 ? 0 : 0.7, c[2][2] = {{0.1, 0}, {0.3, 0.17}}, y[2][2];
        char text[300];
        for (int i = 0; i < 2; i++)
            for (int a = 0; a < 2; a++) y[i][a] = scale * (T[a][0] * c[i][0] + T[a][1] * c[i][1]) + shift;
        snprintf (text, sizeof text,
                  "dimension: 2\nbody: [{add: {disk: {center: [%.17g, %.17g], radius: %.17g}}}, {subtract: "
                  "{disk: {center: [%.17g, %.17g], radius: %.17g}}}]",
                  y[0][0], y[0][1], scale, y[1][0], y[1][1], 0.31 * scale);
        meshed m = mesh (text, 0.13 * scale);
        sums s = sum_of (&m, 2);
        if (k == 0) first[0] = s.volume, first[1] = s.surface, cells = m.cells.n;
        assert_int_equal (m.cells.n, cells);
        check_relative (s.volume / (scale * scale), first[0], 1e-10);
        check_relative (s.surface / scale, first[1], 1e-10);
        drop (&m);
    }
}

static void bodies_along_the_lattice_are_not_cut (void **state)
{
    (void) state;
    meshed m = mesh ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 1, 1]}}}, {subtract: {box: "
                     "{low: [0.5, 0.5, 0.5], high: [1, 1, 1]}}}]",
                     0.25);
    pg_cells plain;
    check_ok (pg_cells_from_lattice (&plain, &m.lattice, 1));
    assert_null (m.cells.cut);
    assert_int_equal (m.cells.n, plain.n);
    assert_int_equal (m.cells.nfacet, plain.nfacet);
    assert_memory_equal (m.cells.x, plain.x, 24 * plain.n * sizeof (double));
    assert_memory_equal (m.cells.area, plain.area, plain.nfacet * sizeof (double));
    pg_cells_clear (&plain);
    drop (&m);
}

/* Every facet lies on the surface that it names; cells keep their lattice corners. */
static void facets_know_their_shape (void **state)
{
    (void) state;
    meshed m = mesh ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [2, 2]}}}, {subtract: {disk: "
                     "{center: [1, 1], radius: 0.55}}}]",
                     0.1);
    double hole = 0;
    for (size_t f = 0; f < m.cells.nfacet; f++) {
        const double *x = m.cells.facet_centre + 2 * f, *n = m.cells.normal + 2 * f;
        double r = hypot (x[0] - 1, x[1] - 1);
        if (pg_cut_shape (m.cells.cut, m.cells.facet_surface[f]) == 0) continue;
        hole += m.cells.area[f];
        check_absolute (r, 0.55, 0.01);                    /* the centroid of an arc */
        check_absolute (n[0] * (x[0] - 1) + n[1] * (x[1] - 1), -r, 1e-12);
    }
    check_relative (hole, 1.1 * pi, 1e-13);
    drop (&m);
}

/* Rays part facets exactly: arcs of 4 and 90 degrees of a rim and a bore, in 2D and 3D, whatever the
 * lattice. */
static void rays_part_facets (void **state)
{
    static const char *const text[2] = {
        "dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}, {subtract: {disk: {center: [0, 0], "
        "radius: 0.37}}}]",
        "dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], radius: 1, length: 1}}}, {subtract: "
        "{cylinder: {center: [0, 0, 0], radius: 0.37, length: 1}}}]"
    };
    const double from[2] = {88 * pi / 180, 0.3}, to[2] = {92 * pi / 180, 0.3 + pi / 2};
    pg_ray ray[4];
    (void) state;
    for (int i = 0; i < 4; i++)
        ray[i] = (pg_ray){ { 0, 0 },
                           { cos (i % 2 ? to[i / 2] : from[i / 2]), sin (i % 2 ? to[i / 2] : from[i / 2]) } };
    for (int k = 0; k < 2; k++)
        for (int range = 0; range < 2; range++) {
            meshed m = mesh (text[k], 0.13);
            double area[2] = {0, 0}, all = 0;
            pg_cells_clear (&m.cells);
            check_ok (pg_cells_cut (&m.cells, &m.body, &m.lattice, 1, 4, ray));
            for (size_t f = 0; f < m.cells.nfacet; f++) {
                const double *x = m.cells.facet_centre + (size_t) m.cells.dim * f;
                double angle = atan2 (x[1], x[0]);
                all += m.cells.area[f];
                if (pg_cut_is_end (m.cells.cut, m.cells.facet_surface[f]) || angle < from[range]
                    || angle > to[range])
                    continue;
                area[pg_cut_shape (m.cells.cut, m.cells.facet_surface[f])] += m.cells.area[f];
            }
            check_relative (area[0], to[range] - from[range], 1e-11);
            check_relative (area[1], 0.37 * (to[range] - from[range]), 1e-11);
            check_relative (all, 2 * pi * 1.37 + k * 2 * pi * (1 - 0.37 * 0.37), 1e-11);
            drop (&m);
        }
}

/* Two cylinders that share their mantle: places where surfaces meet are not isolated there, the search for
 * them is given up, and nothing is lost by it. */
static void surfaces_in_common_do_no_harm (void **state)
{
    char text[200];
    (void) state;
    meshed m = mesh ("dimension: 3\nbody: [{add: {cylinder: {center: [0, 0, 0], radius: 1, length: 1}}}, "
                     "{add: {cylinder: {center: [0, 0, 0.5], radius: 1, length: 1}}}]", 0.6);
    double volume = 0;
    for (size_t c = 0; c < m.cells.n; c++) volume += m.cells.volume[c];
    check_relative (volume, 1.5 * pi, 1e-12);
    assert_true (m.cells.given_up > 0);
    assert_true (m.cells.unsettled == 0);
    assert_false (pg_cells_doubt (&m.cells, text, sizeof text));
    drop (&m);
    m = mesh ("dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 1}}}]", 0.6);
    assert_int_equal (m.cells.given_up, 0);
    assert_true (m.cells.unsettled == 0);
    drop (&m);
}

static void cells_that_do_not_settle_are_told (void **state)
{
    const pg_cells c = { .unsettled = 1.1e-6, .given_up = 3 }, fine = { .unsettled = 9e-7, .given_up = 3 };
    char text[200];
    (void) state;
    assert_true (pg_cells_doubt (&c, text, sizeof text));
    check_contains (text, "known to 1.1e-06 of a whole cell only (3 searches for corners given up)");
    check_contains (text, "shapes that overlap");
    assert_false (pg_cells_doubt (&fine, text, sizeof text));
}

static void volumes_of_points_sum_to_the_body (void **state)
{
    static const char *const lattice[] = {"nodes", "cells"};
    (void) state;
    for (int k = 0; k < 4; k++) {
        char text[300];
        pg_scene *scene;
        pg_body body;
        pg_lattice l;
        pg_cloud cloud;
        pg_cells cells;
        double sum = 0;
        int three = k > 1;
        snprintf (
            text, sizeof text,
            "dimension: %d\nlattice: %s\nspacing: %g\nbody: [{add: {%s: {center: [0, 0%s], radius: 1}}}]",
            2 + three, lattice[k % 2], three ? 0.3 : 0.11, three ? "sphere" : "disk", three ? ", 0" : "");
        check_ok (pg_scene_parse (&scene, text, "test.yaml"));
        check_ok (pg_body_read (&body, scene));
        check_ok (pg_cloud_build (&cloud, &l, &body, scene));
        check_ok (pg_cells_cut (&cells, &body, &l, cloud.thickness, 0, NULL));
        check_ok (pg_cells_share (&cloud, &cells, &l));
        for (size_t i = 0; i < cloud.n; i++) sum += cloud.volume[i], assert_true (cloud.volume[i] > 0);
        check_relative (sum, three ? 4 * pi / 3 : pi, 1e-12);
        pg_cells_clear (&cells), pg_cloud_clear (&cloud), pg_lattice_clear (&l), pg_body_clear (&body),
            pg_scene_free (&scene);
    }
}

/* A disk about a place of symmetry of its lattice: the point that mirrors another at x = y has its volume,
 * slivers between two points too. */
static void mirror_images_have_equal_volumes (void **state)
{
    (void) state;
    for (int n = 5; n <= 40; n++) {
        char text[200];
        pg_scene *scene;
        pg_body body;
        pg_lattice l;
        pg_cloud cloud;
        pg_cells cells;
        size_t pairs = 0;
        snprintf (text, sizeof text,
                  "dimension: 2\nlattice: cells\nspacing: %.17g\nbody: [{add: {disk: {center: [0, 0], "
                  "radius: 1}}}]",
                  2.0 / n);
        check_ok (pg_scene_parse (&scene, text, "test.yaml"));
        check_ok (pg_body_read (&body, scene));
        check_ok (pg_cloud_build (&cloud, &l, &body, scene));
        check_ok (pg_cells_cut (&cells, &body, &l, cloud.thickness, 0, NULL));
        check_ok (pg_cells_share (&cloud, &cells, &l));
        for (size_t i = 0; i < cloud.n; i++)
            for (size_t j = 0; j < cloud.n; j++)
                if (hypot (cloud.x[2 * i] - cloud.x[2 * j + 1], cloud.x[2 * i + 1] - cloud.x[2 * j]) < 1e-9)
                    pairs++, check_relative (cloud.volume[i], cloud.volume[j], 1e-9);
        assert_int_equal (pairs, cloud.n);
        pg_cells_clear (&cells), pg_cloud_clear (&cloud), pg_lattice_clear (&l), pg_body_clear (&body),
            pg_scene_free (&scene);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    meshed m = mesh ("dimension: 2\nbody: [{add: {disk: {center: [0, 0], radius: 1}}}, {subtract: {disk: "
                     "{center: [0.2, 0], radius: 0.3}}}]",
                     0.5);
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status == PG_E_MEMORY; k++) {
        pg_cells c;
        pg_memory_fail_at (k);
        status = pg_cells_cut (&c, &m.body, &m.lattice, 1, 0, NULL);
        pg_memory_fail_at (0);
        if (status == PG_OK) pg_cells_clear (&c);
        assert_int_equal (pg_memory_used (), before);
        assert_true (k < 500);
    }
    check_ok (status);
    assert_true (k > 30);
    drop (&m);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (disks_and_holes),
        cmocka_unit_test (polygons),
        cmocka_unit_test (cylinders_and_balls),
        cmocka_unit_test (segments),
        cmocka_unit_test (moments),
        cmocka_unit_test (moved_bodies_agree),
        cmocka_unit_test (bodies_along_the_lattice_are_not_cut),
        cmocka_unit_test (facets_know_their_shape),
        cmocka_unit_test (rays_part_facets),
        cmocka_unit_test (surfaces_in_common_do_no_harm),
        cmocka_unit_test (cells_that_do_not_settle_are_told),
        cmocka_unit_test (volumes_of_points_sum_to_the_body),
        cmocka_unit_test (mirror_images_have_equal_volumes),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cells/cut", tests, NULL, NULL);
}
