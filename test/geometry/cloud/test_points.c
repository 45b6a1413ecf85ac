/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points on the lattice: numbers, order, volumes, perturbation, faults. */
#include "parsed.h"

#define PLATE \
    "dimension: 2\nthickness: 10 mm\nbody:\n  - add: {box: {low: [0, 0], high: [2, 1]}}\n  - subtract: " \
    "{disk: {center: [1, 0.5], radius: 0.2}}\nspacing: 0.1\n"

static double total (const pg_cloud *c)  /* compensated: rounding of the sum itself must not show */
{
    double sum = 0, lost = 0;
    for (size_t i = 0; i < c->n; i++) {
        double add = c->volume[i] - lost, next = sum + add;
        lost = (next - sum) - add;
        sum = next;
    }
    return sum;
}

static size_t kept (const pg_lattice *l)
{
    size_t n = 0;
    for (size_t i = 0; i < (size_t) l->count[0] * (size_t) l->count[1] * (size_t) l->count[2]; i++)
        n += l->in[i];
    return n;
}

static void nodes_of_a_box_in_1d_2d_3d (void **state)
{
    (void) state;
    built a = build (
        "dimension: 1\ncross_section: 4 cm2\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1");
    built b = build (
        "dimension: 2\nthickness: 2 mm\nbody: [{add: {box: {low: [0, 0], high: [1, 2]}}}]\nspacing: 0.1");
    built c = build ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 2, 3]}}}]\nspacing: 0.5");
    assert_int_equal (a.cloud.n, 11);
    assert_int_equal (b.cloud.n, 11 * 21);
    assert_int_equal (c.cloud.n, 3 * 5 * 7);
    check_relative (total (&a.cloud), 4e-4, 1e-14);
    check_relative (total (&b.cloud), 4e-3, 1e-14);
    check_relative (total (&c.cloud), 6, 1e-14);
    check_relative (a.cloud.volume[0], 0.5 * a.cloud.volume[1], 1e-15);
    check_relative (b.cloud.volume[0], 0.25 * b.cloud.volume[12], 1e-15);
    check_relative (c.cloud.volume[0], 0.015625, 1e-15);
    check_relative (c.cloud.h, 0.5, 1e-15);
    check_relative (b.cloud.high[1], 2, 0);
    unbuild (&a), unbuild (&b), unbuild (&c);
}

static void centres_of_a_box_in_1d_2d_3d (void **state)
{
    (void) state;
    built a = build (
        "dimension: 1\nlattice: cells\nbody: [{add: {box: {low: [0], high: [1]}}}]\nspacing: 0.1");
    built b = build ("dimension: 2\nlattice: cells\nthickness: 2\nbody: [{add: {box: {low: [0, 0], high: [1, "
                     "2]}}}]\nspacing: 0.1");
    built c = build ("dimension: 3\nlattice: cells\nbody: [{add: {box: {low: [0, 0, 0], high: [1, 2, "
                     "3]}}}]\nspacing: 0.5");
    assert_int_equal (a.cloud.n, 10);
    assert_int_equal (b.cloud.n, 200);
    assert_int_equal (c.cloud.n, 48);
    check_relative (a.cloud.x[0], 0.05, 1e-14);
    check_relative (c.cloud.x[3 * 47 + 2], 2.75, 1e-14);
    for (size_t i = 0; i < b.cloud.n; i++) check_relative (b.cloud.volume[i], 0.02, 1e-14);
    check_relative (total (&c.cloud), 6, 1e-14);
    unbuild (&a), unbuild (&b), unbuild (&c);
}

static void points_run_along_x_then_y_then_z (void **state)
{
    (void) state;
    built b = build ("dimension: 3\nbody: [{add: {sphere: {center: [0, 0, 0], radius: 1}}}]\nspacing: 0.2");
    for (size_t i = 1; i < b.cloud.n; i++) {
        const double *p = b.cloud.x + 3 * (i - 1), *q = p + 3;
        assert_true (p[2] < q[2] || (p[2] == q[2] && (p[1] < q[1] || (p[1] == q[1] && p[0] < q[0]))));
    }
    unbuild (&b);
}

static void volumes_sum_to_the_kept_cells (void **state)
{
    (void) state;
    built n = build (PLATE), c = build (PLATE "lattice: cells\n");
    assert_true (kept (&n.lattice) < 200);
    check_relative (total (&n.cloud), (double) kept (&n.lattice) * 1e-4, 1e-14);
    check_relative (total (&c.cloud), (double) kept (&c.lattice) * 1e-4, 1e-14);
    assert_int_equal (c.cloud.n, kept (&c.lattice));
    unbuild (&n), unbuild (&c);
}

static void every_vertex_of_a_kept_cell_is_a_point_and_no_other (void **state)
{
    (void) state;
    built b = build (PLATE);
    size_t p = 0;
    for (int j = 0; j <= 10; j++)
        for (int i = 0; i <= 20; i++) {
            int around = 0;
            for (int k = 0; k < 4; k++) {
                int a = i - k % 2, c = j - k / 2;
                if (a >= 0 && a < 20 && c >= 0 && c < 10) around += b.lattice.in[20*c + a];
            }
            if (!around) continue;
            check_absolute (b.cloud.x[2*p], 0.1 * i, 1e-14);
            check_absolute (b.cloud.x[2*p + 1], 0.1 * j, 1e-14);
            check_relative (b.cloud.volume[p++], around * 2.5e-5, 1e-13);
        }
    assert_int_equal (p, b.cloud.n);
    unbuild (&b);
}

static void a_disk_keeps_its_symmetry (void **state)
{
    (void) state;
    built b = build (
        "dimension: 2\nbody: [{add: {disk: {center: [0, 0], diameter: 100 mm}}}]\nspacing: 2 mm");
    for (size_t i = 0, n = b.cloud.n; i < n; i++) {            /* half a turn reverses the order */
        assert_true (b.cloud.x[2 * i] == -b.cloud.x[2 * (n - 1 - i)]
                     && b.cloud.x[2 * i + 1] == -b.cloud.x[2 * (n - 1 - i) + 1]);
        assert_true (b.cloud.volume[i] == b.cloud.volume[n - 1 - i]);
    }
    int cells = 0;  /* centres at odd multiples of 1 mm within 50 mm */
    for (int j = -49; j < 50; j += 2) for (int i = -49; i < 50; i += 2) cells += i*i + j*j <= 2500;
    check_relative (total (&b.cloud), cells * 4e-6, 1e-14);
    unbuild (&b);
}

/* ---- perturbation -------------------------------------------------------------------------------------- */
static void only_points_amid_kept_cells_move (const char *lattice, int reach, int around)
{
    char text[600];
    snprintf (text, sizeof text, PLATE "lattice: %s\n", lattice);
    built rest = build (text);
    snprintf (text, sizeof text, PLATE "lattice: %s\nperturb: {amount: 0.2, seed: 4}\n", lattice);
    built b = build (text);
    int moved = 0;
    double most = 0;
    assert_int_equal (b.cloud.n, rest.cloud.n);
    for (size_t i = 0; i < b.cloud.n; i++) {
        const double *x = b.cloud.x + 2*i, *y = rest.cloud.x + 2*i;
        int n = 0;
        for (int c = 0; c < 10; c++) for (int a = 0; a < 20; a++)
                n += b.lattice.in[20 * c + a] && fabs (0.1 * a + 0.05 - y[0]) < 0.05 * reach + 0.01
                     && fabs (0.1 * c + 0.05 - y[1]) < 0.05 * reach + 0.01;
        assert_int_equal (x[0] != y[0] && x[1] != y[1], n == around);
        assert_int_equal (x[0] != y[0], x[1] != y[1]);
        moved += x[0] != y[0];
        for (int k = 0; k < 2; k++) most = fmax (most, fabs (x[k] - y[k]));
    }
    assert_true (moved > 50);
    assert_true (most > 0.018 && most <= 0.02 * (1 + 1e-12));
    check_relative (total (&b.cloud), total (&rest.cloud), 1e-14);
    unbuild (&b), unbuild (&rest);
}

static void only_inner_nodes_move (void **state)
{
    (void) state;
    only_points_amid_kept_cells_move ("nodes", 1, 4);
}
static void only_inner_centres_move (void **state)
{
    (void) state;
    only_points_amid_kept_cells_move ("cells", 2, 9);
}

static void shifts_are_uniform_reproducible_and_differ_by_seed (void **state)
{
    (void) state;
    const char *text = "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
                       "0.01\nperturb: {amount: 0.45, seed: 1}";
    built a = build (text), b = build (text);
    built c = build ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: "
                     "0.01\nperturb: {amount: 0.45, seed: 2}");
    double sum = 0, square = 0, cross = 0, both = 0, n = 0;
    assert_memory_equal (a.cloud.x, b.cloud.x, a.cloud.n * 2 * sizeof (double));
    for (int j = 1; j < 100; j++) for (int i = 1; i < 100; i++) {
        size_t p = (size_t) (101*j + i);
        double u = (a.cloud.x[2 * p] - 0.01 * i) / 0.0045, v = (a.cloud.x[2 * p + 1] - 0.01 * j) / 0.0045,
               w = (c.cloud.x[2 * p] - 0.01 * i) / 0.0045;
        sum += u + v, square += u*u + v*v, cross += u*v, both += u*w, n += 2;
    }
    assert_true (fabs (sum / n) < 0.02);                       /* standard deviation 0.004 */
    check_relative (square / n, 1.0 / 3, 0.03);
    assert_true (fabs (cross / n) < 0.02 && fabs (both / n) < 0.02);
    unbuild (&a), unbuild (&b), unbuild (&c);
}

/* ---- faults -------------------------------------------------------------------------------------------- */
static void must_fault (const char *text, const char *part)
{
    pg_scene *scene = parsed (text);
    pg_body body;
    pg_lattice lattice;
    pg_cloud cloud;
    check_ok (pg_body_read (&body, scene));
    check_fails (pg_cloud_build (&cloud, &lattice, &body, scene), PG_E_SCENE);
    check_contains (pg_last_error (), part);
    pg_body_clear (&body);
    pg_scene_free (&scene);
}

static void a_body_without_cells_is_a_fault_that_counts_them (void **state)
{
    (void) state;
    must_fault ("dimension: 2\nbody:\n  - add: {box: {low: [0, 0], high: [1, 1]}}\n  - subtract: {disk: "
                "{center: [0.5, 0.5], radius: 0.2}}\nspacing: 1 m",
                "none of the 1 x 1 x 1 lattice cells");
}

static void a_missing_or_tiny_spacing_is_a_fault (void **state)
{
    (void) state;
    must_fault ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]", "spacing: is missing");
    must_fault ("dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [1, 1]}}}]\nspacing: 1 nm", "too fine");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    pg_scene *scene = parsed (PLATE);
    size_t before = pg_memory_used (), k = 0;
    pg_status status = PG_E_MEMORY;
    while (status != PG_OK) {
        pg_body body = {0};
        pg_lattice lattice = {0};
        pg_cloud cloud = {0};
        pg_memory_fail_at (++k);
        status = pg_body_read (&body, scene);
        if (status == PG_OK) status = pg_cloud_build (&cloud, &lattice, &body, scene);
        pg_memory_fail_at (0);
        if (status != PG_OK) assert_int_equal (status, PG_E_MEMORY);
        pg_cloud_clear (&cloud), pg_lattice_clear (&lattice), pg_body_clear (&body);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (k > 5);
    pg_scene_free (&scene);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (nodes_of_a_box_in_1d_2d_3d),
        cmocka_unit_test (centres_of_a_box_in_1d_2d_3d),
        cmocka_unit_test (points_run_along_x_then_y_then_z),
        cmocka_unit_test (volumes_sum_to_the_kept_cells),
        cmocka_unit_test (every_vertex_of_a_kept_cell_is_a_point_and_no_other),
        cmocka_unit_test (a_disk_keeps_its_symmetry),
        cmocka_unit_test (only_inner_nodes_move),
        cmocka_unit_test (only_inner_centres_move),
        cmocka_unit_test (shifts_are_uniform_reproducible_and_differ_by_seed),
        cmocka_unit_test (a_body_without_cells_is_a_fault_that_counts_them),
        cmocka_unit_test (a_missing_or_tiny_spacing_is_a_fault),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/cloud/points", tests, NULL, NULL);
}
