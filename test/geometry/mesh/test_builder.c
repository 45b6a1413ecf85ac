/* SPDX-License-Identifier: GPL-3.0-or-later
 * A mesh from numbers: ids of any kind, blocks, sets, orientation, faults. */
#include "check.h"
#include "perigal/mesh.h"

static pg_mesh_builder *begin (size_t n, const long *id, const double (*x)[3])
{
    pg_mesh_builder *m = NULL;
    check_ok (pg_mesh_builder_create (&m, "part.msh"));
    for (size_t k = 0; k < n; k++) check_ok (pg_mesh_builder_node (m, id[k], x[k]));
    return m;
}

#define ELEMENT(m, id, kind, group, ...) \
    pg_mesh_builder_element ((m), (id), (kind), (long[]){ __VA_ARGS__ }, (group), 7)

/* Two unit squares side by side, the second one clockwise, and a node of no use. */
static const long id7[7] = { 10, 20, 30, 4000000000, -5, 60, 70 };
static const double x7[7][3] = { { 0, 0 }, { 1, 0 }, { 2, 0 }, { 0, 1 }, { 1, 1 }, { 2, 1 }, { 9, 9 } };

static pg_mesh_builder *two_squares (void)
{
    pg_mesh_builder *m = begin (7, id7, x7);
    check_ok (ELEMENT (m, 100, PG_QUAD4, 2, 10, 20, -5, 4000000000));
    check_ok (ELEMENT (m, 200, PG_QUAD4, 1, 20, -5, 60, 30));
    return m;
}

static pg_mesh finished (pg_mesh_builder *m)
{
    pg_mesh mesh;
    check_ok (pg_mesh_builder_finish (m, &mesh));
    pg_mesh_builder_free (&m);
    return mesh;
}

static void fault (pg_mesh_builder *m, pg_status code, const char *words)
{
    pg_mesh mesh;
    check_fails (pg_mesh_builder_finish (m, &mesh), code);
    check_contains (pg_last_error (), words);
    check_contains (pg_last_error (), "part.msh");
    assert_null (mesh.x);
    pg_mesh_builder_free (&m);
}

static void numbers_of_any_kind_become_places (void **state)
{
    (void) state;
    pg_mesh mesh = finished (two_squares ());
    assert_int_equal (mesh.dim, 2);
    assert_int_equal (mesh.nnode, 6);                      /* the seventh is dropped */
    assert_int_equal (mesh.n, 2);
    assert_int_equal (mesh.node_id[3], 4000000000);
    const int want[8] = { 0, 1, 4, 3, 1, 2, 5, 4 };        /* the second one turned */
    assert_memory_equal (mesh.node, want, sizeof want);
    assert_int_equal (mesh.element_id[1], 200);
    pg_mesh_clear (&mesh);
}

static void groups_become_blocks_in_ascending_order (void **state)
{
    (void) state;
    pg_mesh_builder *m = two_squares ();
    check_ok (pg_mesh_builder_group (m, 2, 2, "steel"));
    check_ok (pg_mesh_builder_group (m, 1, 1, "not of solids"));
    pg_mesh mesh = finished (m);
    assert_int_equal (mesh.nblock, 2);
    assert_string_equal (mesh.blocks[0].name, "1");
    assert_string_equal (mesh.blocks[1].name, "steel");
    assert_int_equal (mesh.block[0], 1);
    assert_int_equal (mesh.block[1], 0);
    assert_int_equal (mesh.blocks[1].id, 2);
    assert_int_equal (mesh.blocks[1].n, 1);
    pg_mesh_clear (&mesh);
}

static void lines_become_side_sets_and_node_sets (void **state)
{
    (void) state;
    pg_mesh_builder *m = two_squares ();
    check_ok (ELEMENT (m, 1, PG_BAR2, 5, 30, 60));         /* right side of the turned square */
    check_ok (ELEMENT (m, 2, PG_BAR2, 5, 20, 10));
    check_ok (ELEMENT (m, 3, PG_BAR2, 6, 10, 60));         /* no face */
    check_ok (ELEMENT (m, 4, PG_POINT1, 9, 70));           /* a node that was dropped */
    check_ok (ELEMENT (m, 4, PG_POINT1, 8, -5));
    check_ok (ELEMENT (m, 5, PG_BAR2, 4, -5, 20));         /* between the two */
    check_ok (pg_mesh_builder_group (m, 1, 5, "rim"));
    check_ok (pg_mesh_builder_group (m, 0, 8, "rim"));
    pg_mesh mesh = finished (m);
    assert_int_equal (mesh.nsides, 2);
    assert_string_equal (mesh.sides[0].name, "4");
    assert_int_equal (mesh.sides[0].n, 1);
    assert_int_equal (mesh.sides[0].element[0], 0);
    assert_int_equal (mesh.sides[0].side[0], 1);
    assert_string_equal (mesh.sides[1].name, "rim");
    assert_int_equal (mesh.sides[1].n, 2);
    assert_int_equal (mesh.sides[1].element[0], 0);
    assert_int_equal (mesh.sides[1].side[0], 0);
    assert_int_equal (mesh.sides[1].element[1], 1);
    assert_int_equal (mesh.sides[1].side[1], 1);
    assert_int_equal (mesh.nnodes, 4);
    assert_string_equal (mesh.nodes[1].name, "rim");
    const int rim[5] = { 0, 1, 2, 4, 5 };
    assert_int_equal (mesh.nodes[1].n, 5);
    assert_memory_equal (mesh.nodes[1].node, rim, sizeof rim);
    assert_string_equal (mesh.nodes[2].name, "6");
    assert_int_equal (mesh.nodes[2].n, 2);
    assert_string_equal (mesh.nodes[3].name, "9");
    assert_int_equal (mesh.nodes[3].n, 0);
    pg_mesh_clear (&mesh);
}

static void sets_of_the_file_follow_turned_elements (void **state)
{
    (void) state;
    pg_mesh_builder *m = two_squares ();
    check_ok (pg_mesh_builder_nodeset (m, "corner", 3));
    check_ok (pg_mesh_builder_nodeset_add (m, 60));
    check_ok (pg_mesh_builder_nodeset_add (m, 10));
    check_ok (pg_mesh_builder_nodeset_add (m, 10));
    check_ok (pg_mesh_builder_sideset (m, "", 12));
    check_ok (pg_mesh_builder_sideset_add (m, 200, 2));           /* 60-30 as it was given */
    check_ok (pg_mesh_builder_sideset_add (m, 100, 3));
    check_ok (pg_mesh_builder_sideset (m, "empty", 13));
    pg_mesh mesh = finished (m);
    assert_int_equal (mesh.nsides, 2);
    assert_string_equal (mesh.sides[0].name, "12");
    assert_int_equal (mesh.sides[0].side[0], 3);
    assert_int_equal (mesh.sides[0].element[1], 1);
    assert_int_equal (mesh.sides[0].side[1], 1);           /* 2-5, the places of 30 and 60 */
    assert_int_equal (mesh.sides[1].n, 0);
    assert_int_equal (mesh.nodes[0].n, 2);
    assert_int_equal (mesh.nodes[0].node[1], 5);
    assert_int_equal (mesh.nodes[1].n, 4);
    pg_mesh_clear (&mesh);
}

static void an_element_in_two_groups_is_one_element (void **state)
{
    (void) state;
    pg_mesh_builder *m = two_squares ();
    check_ok (ELEMENT (m, 300, PG_QUAD4, 8, -5, 60, 30, 20));
    check_ok (pg_mesh_builder_group (m, 2, 8, "both"));
    pg_mesh mesh = finished (m);
    assert_int_equal (mesh.n, 2);
    assert_int_equal (mesh.nblock, 2);
    assert_int_equal (mesh.nnodes, 1);
    assert_int_equal (mesh.nodes[0].n, 4);
    assert_string_equal (mesh.nodes[0].name, "both");
    pg_mesh_clear (&mesh);
}

static void faults_say_where (void **state)
{
    (void) state;
    pg_mesh_builder *m = begin (7, id7, x7);
    fault (m, PG_E_FILE, "points without elements");
    m = begin (0, id7, x7);
    fault (m, PG_E_FILE, "no nodes");
    m = two_squares ();
    check_ok (ELEMENT (m, 300, PG_TRI3, 0, 10, 20, 99));
    fault (m, PG_E_FILE, "part.msh, line 7: element 300 (tri3): node 99 is not in the file");
    m = two_squares ();
    check_ok (ELEMENT (m, 300, PG_TRI3, 0, 10, 20, 10));
    fault (m, PG_E_FILE, "element 300 (tri3): node 10 is named twice");
    m = two_squares ();
    check_ok (ELEMENT (m, 300, PG_TRI3, 0, 10, 20, 30));
    fault (m, PG_E_FILE, "element 300 (tri3): is flat: it has no area");
    m = two_squares ();
    check_ok (ELEMENT (m, 100, PG_TRI3, 0, 10, 20, 60));
    fault (m, PG_E_FILE, "element 100 is there twice");
    m = two_squares ();
    check_ok (pg_mesh_builder_node (m, 60, x7[2]));
    fault (m, PG_E_FILE, "node 60 is there twice");
    m = two_squares ();
    check_ok (pg_mesh_builder_sideset (m, "s", 1));
    check_ok (pg_mesh_builder_sideset_add (m, 200, 4));
    fault (m, PG_E_FILE, "side set 's': element 200 (quad4) has no side 5; its sides are 1 to 4");
    m = two_squares ();
    check_ok (pg_mesh_builder_sideset (m, "s", 1));
    check_ok (pg_mesh_builder_sideset_add (m, 1, 0));
    fault (m, PG_E_FILE, "element 1 is none of the solid elements");
    m = two_squares ();
    check_ok (pg_mesh_builder_nodeset (m, "s", 1));
    check_ok (pg_mesh_builder_nodeset_add (m, 1));
    fault (m, PG_E_FILE, "node set 's': node 1 is not in the file");
    m = two_squares ();
    check_ok (pg_mesh_builder_node (m, 1, (double[3]) { 1, 2, 3 }));
    check_ok (ELEMENT (m, 300, PG_TRI3, 0, 10, 20, 1));
    fault (m, PG_E_FILE, "z goes from 0 to 3");
}

static void numbers_that_are_none_are_refused (void **state)
{
    (void) state;
    pg_mesh_builder *m = begin (0, id7, x7);
    check_fails (pg_mesh_builder_node (m, 3, (double[3]) { 0, NAN, 0 }), PG_E_FILE);
    check_contains (pg_last_error (), "node 3: coordinate 2");
    check_fails (pg_mesh_builder_node (m, 3, (double[3]) { 0, 0, -INFINITY }), PG_E_FILE);
    check_fails (pg_mesh_builder_node (m, 3, (double[3]) { 1e101, 0, 0 }), PG_E_FILE);
    check_fails (pg_mesh_builder_nodeset_add (m, 3), PG_E_USAGE);
    check_fails (pg_mesh_builder_sideset_add (m, 3, 0), PG_E_USAGE);
    check_fails (pg_mesh_builder_element (m, 3, PG_ELEMENTS, (long[27]) { 0 }, 0, 0), PG_E_USAGE);
    pg_mesh_builder_free (&m);
    pg_mesh_builder_free (&m);
}

/* ---- surface ------------------------------------------------------------------------------------------- */
/* n^3 hexes in the unit cube; a fan of n triangles around one node. */
static pg_mesh cube (long n)
{
    pg_mesh_builder *m = begin (0, id7, x7);
    for (long k = 0; k < (n + 1) * (n + 1) * (n + 1); k++)
        check_ok (pg_mesh_builder_node (m, k,
                                        (double[3]){ (double) (k % (n + 1)) / (double) n,
                                                     (double) (k / (n + 1) % (n + 1)) / (double) n,
                                                     (double) (k / (n + 1) / (n + 1)) / (double) n }));
    for (long e = 0; e < n * n * n; e++) {
        long d = n + 1, c = e % n + e / n % n * d + e / n / n * d * d;
        check_ok (ELEMENT (m, e, PG_HEX8, 0, c, c + 1, c + 1 + d, c + d, c + d * d, c + 1 + d * d,
                           c + 1 + d + d * d, c + d + d * d));
    }
    return finished (m);
}

static void the_surface_of_a_cube_is_its_six_sides (void **state)
{
    (void) state;
    pg_mesh mesh = cube (5);
    size_t n;
    int *element, *side;
    check_ok (pg_mesh_surface (&mesh, &n, &element, &side));
    assert_int_equal (n, 6 * 25);
    for (size_t k = 0; k < n; k++) {
        int node[9], same = 0;
        assert_int_equal (pg_element_face (PG_HEX8, side[k], node), PG_QUAD4);
        for (int a = 0; a < 3; a++) {
            double sum = 0;
            for (int c = 0; c < 4; c++) sum += mesh.x[3 * mesh.node[8 * element[k] + node[c]] + a];
            same += sum < 1e-12 || sum > 4 - 1e-12;
        }
        assert_int_equal (same, 1);
        if (k > 0)
            assert_true (element[k] > element[k - 1]
                         || (element[k] == element[k - 1] && side[k] > side[k - 1]));
    }
    pg_free (element), pg_free (side);
    pg_mesh_clear (&mesh);
}

static void a_fan_around_one_node_has_an_open_rim (void **state)
{
    (void) state;
    enum { N = 3000 };
    pg_mesh_builder *m = begin (1, id7, x7);
    for (long k = 0; k < N; k++)
        check_ok (pg_mesh_builder_node (m, 100 + k,
                                        (double[3]){ cos (2e-3 * (double) k), sin (2e-3 * (double) k), 0 }));
    for (long k = 0; k + 1 < N; k++) check_ok (ELEMENT (m, k, PG_TRI3, 0, 10, 100 + k, 101 + k));
    pg_mesh mesh = finished (m);
    size_t n;
    int *element, *side;
    check_ok (pg_mesh_surface (&mesh, &n, &element, &side));
    assert_int_equal (n, N - 1 + 2);
    pg_free (element), pg_free (side);
    pg_mesh_clear (&mesh);
}

static void every_allocation_may_fail (void **state)
{
    (void) state;
    size_t used = pg_memory_used ();
    for (size_t k = 1, more = 1; more; k++) {
        pg_mesh mesh;
        pg_mesh_builder *m = two_squares ();
        check_ok (ELEMENT (m, 1, PG_BAR2, 5, 30, 60));
        check_ok (pg_mesh_builder_nodeset (m, "corner", 3));
        check_ok (pg_mesh_builder_nodeset_add (m, 60));
        pg_memory_fail_at (k);
        pg_status status = pg_mesh_builder_finish (m, &mesh);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        more = status != PG_OK;
        pg_mesh_clear (&mesh);
        pg_mesh_builder_free (&m);
        assert_int_equal (pg_memory_used (), used);
        assert_true (k < 200);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (numbers_of_any_kind_become_places),
        cmocka_unit_test (groups_become_blocks_in_ascending_order),
        cmocka_unit_test (lines_become_side_sets_and_node_sets),
        cmocka_unit_test (sets_of_the_file_follow_turned_elements),
        cmocka_unit_test (an_element_in_two_groups_is_one_element),
        cmocka_unit_test (faults_say_where),
        cmocka_unit_test (numbers_that_are_none_are_refused),
        cmocka_unit_test (the_surface_of_a_cube_is_its_six_sides),
        cmocka_unit_test (a_fan_around_one_node_has_an_open_rim),
        cmocka_unit_test (every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("geometry/mesh/builder", tests, NULL, NULL);
}
