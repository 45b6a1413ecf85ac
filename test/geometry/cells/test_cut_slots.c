/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cells that slots cut: volumes and surfaces of bodies with cracks of a width, in closed form. */
#include "check.h"
#include "perigal/cells.h"

/* Volume of the cells and area of the facets of a body. */
static void sizes_of (const char *text, double spacing, double *volume, double *surface)
{
    pg_scene *scene = NULL;
    pg_body body;
    pg_lattice lattice;
    pg_cells cells = { 0 };
    check_ok (pg_scene_parse (&scene, text, "test.yaml"));
    check_ok (pg_body_read (&body, scene));
    check_ok (pg_lattice_fit (&lattice, &body, spacing, NULL));
    check_ok (pg_cells_cut (&cells, &body, &lattice, 1, 0, NULL));
    *volume = *surface = 0;
    for (size_t i = 0; i < cells.n; i++) *volume += cells.volume[i];
    for (size_t i = 0; i < cells.nfacet; i++) *surface += cells.area[i];
    pg_cells_clear (&cells);
    pg_lattice_clear (&lattice);
    pg_body_clear (&body);
    pg_scene_free (&scene);
}

static void a_slot_in_the_plane (void **state)
{
    (void) state;
    double volume, surface, length = hypot (6.2, 3.1);
    sizes_of (
        "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [20, 10]}}}]\ncracks: [{from: [7.1, 3.2], to: "
        "[13.3, 6.3], width: 0.6}]\n",
        0.5, &volume, &surface);
    check_relative (volume, 200 - 0.6 * length, 1e-12);
    check_relative (surface, 60 + 2 * length + 1.2, 1e-12);
}

static void a_plate_in_space (void **state)
{
    (void) state;
    double volume, surface, length = hypot (3.5, 1);
    sizes_of (
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [10, 10, 10]}}}]\ncracks: [{polygon: [[5.5, "
        "5.5, 4], [9, 5.5, 5], [9, 9, 5], [5.5, 9, 4]], width: 1.2}]\n",
        1, &volume, &surface);
    check_relative (volume, 1000 - length * 3.5 * 1.2, 1e-11);
    check_relative (surface, 600 + 2 * length * 3.5 + 2 * 1.2 * (length + 3.5), 1e-11);
}

/* The other way round, and one that leaves the body. */
static void a_plate_that_leaves_the_body (void **state)
{
    (void) state;
    double volume, surface;
    sizes_of (
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [4, 4, 4]}}}]\ncracks: [{polygon: [[-1, 1, "
        "2], [-1, 3, 2], [2.3, 3, 2], [2.3, 1, 2]], width: 0.7}]\n",
        0.5, &volume, &surface);
    check_relative (volume, 64 - 2.3 * 2 * 0.7, 1e-11);
    check_relative (surface, 96 - 2 * 0.7 + 2 * 2.3 * 2 + 2 * 2.3 * 0.7 + 2 * 0.7, 1e-11);
}

static void a_disc_in_space (void **state)
{
    (void) state;
    const double pi = acos (-1);
    double volume, surface;
    sizes_of (
        "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [10, 10, 10]}}}]\ncracks: [{disc: {center: "
        "[3, 3, 5], normal: [0.3, 0.2, 1], radius: 2}, width: 1.2}]\n",
        1, &volume, &surface);
    check_relative (volume, 1000 - pi * 4 * 1.2, 1e-9);
    check_relative (surface, 600 + 2 * pi * 4 + 2 * pi * 2 * 1.2, 1e-9);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (a_slot_in_the_plane),
        cmocka_unit_test (a_plate_in_space),
        cmocka_unit_test (a_plate_that_leaves_the_body),
        cmocka_unit_test (a_disc_in_space),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
