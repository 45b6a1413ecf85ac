/* SPDX-License-Identifier: GPL-3.0-or-later
 * Volume and surface of disks, cylinders and balls of elements converge to the exact ones: h^2 with straight
 * edges, h^4 with curved ones. */
#include "check.h"
#include "measure.h"

static const double pi = 3.14159265358979323846;

/* Squares to circles, cubes to balls: smooth, sides onto the surface. */
static void to_disk (double *x)
{
    double u = x[0], v = x[1];
    x[0] = u * sqrt (1 - v * v / 2), x[1] = v * sqrt (1 - u * u / 2);
}

static void to_cylinder (double *x)
{
    to_disk (x);
    x[2] = 3 + 0.75 * x[2];
}

static void to_ball (double *x)
{
    double u = x[0] * x[0], v = x[1] * x[1], w = x[2] * x[2];
    x[0] *= sqrt (1 - v / 2 - w / 2 + v * w / 3), x[1] *= sqrt (1 - w / 2 - u / 2 + w * u / 3),
        x[2] *= sqrt (1 - u / 2 - v / 2 + u * v / 3);
}

/* Errors with n and 2 n cells across: their ratio is 2^rate. */
static void converges (pg_element kind, void (*map) (double *x), int n, double volume, double area)
{
    double off[2][2], inside;
    for (int k = 0; k < 2; k++) {
        pg_mesh mesh = block_mesh (kind, n << k, map);
        double v = mesh_volume (&mesh), a = surface_area (&mesh, &inside);
        check_relative (inside, v, 1e-12);
        off[k][0] = fabs (v / volume - 1), off[k][1] = fabs (a / area - 1);
        pg_mesh_clear (&mesh);
    }
    int order = pg_element_types[kind].order;
    for (int q = 0; q < 2; q++) {
        double rate = log2 (off[0][q] / off[1][q]);
        assert_true (rate > 2 * order - 0.4);
        assert_true (off[1][q] < (order == 1 ? 0.03 : 1e-3));
    }
}

static void disks (void **state)
{
    (void) state;
    for (pg_element kind = PG_TRI3; kind <= PG_QUAD9; kind++) converges (kind, to_disk, 6, pi, 2 * pi);
}

static void cylinders (void **state)
{
    (void) state;
    for (pg_element kind = PG_TET4; kind < PG_ELEMENTS; kind++)
        converges (kind, to_cylinder, 5, 1.5 * pi, 2 * pi + 3 * pi);
}

static void balls (void **state)
{
    (void) state;
    for (pg_element kind = PG_TET4; kind < PG_ELEMENTS; kind++)
        converges (kind, to_ball, 5, 4 * pi / 3, 4 * pi);
}

static void boxes_are_exact (void **state)
{
    (void) state;
    for (pg_element kind = PG_BAR2; kind < PG_ELEMENTS; kind++) {
        double inside;
        pg_mesh mesh = block_mesh (kind, 3, NULL);
        int dim = mesh.dim;
        check_relative (mesh_volume (&mesh), 1 << dim, 1e-13);
        if (dim > 1) check_relative (surface_area (&mesh, &inside), dim * (1 << dim), 1e-13);
        pg_mesh_clear (&mesh);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (boxes_are_exact),
        cmocka_unit_test (disks),
        cmocka_unit_test (cylinders),
        cmocka_unit_test (balls),
    };
    return cmocka_run_group_tests_name ("geometry/mesh/volume", tests, NULL, NULL);
}
