/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gmsh files: samples of every kind of element and variant, both byte orders, groups, faults. Run from the
 * top folder. */
#include "check.h"
#include "io/mesh_files/format.h"
#include "geometry/mesh/measure.h"
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static pg_mesh sample (const char *name)
{
    char path[200];
    pg_mesh mesh;
    snprintf (path, sizeof path, "data/mesh/%s.msh", name);
    check_ok (pg_mesh_read (&mesh, path));
    return mesh;
}

static const pg_mesh_sides *sides (const pg_mesh *m, const char *name)
{
    for (size_t k = 0; k < m->nsides; k++) if (!strcmp (m->sides[k].name, name)) return &m->sides[k];
    fail_msg ("no side set %s", name);
    return NULL;
}

static const pg_mesh_nodes *nodes (const pg_mesh *m, const char *name)
{
    for (size_t k = 0; k < m->nnodes; k++) if (!strcmp (m->nodes[k].name, name)) return &m->nodes[k];
    fail_msg ("no node set %s", name);
    return NULL;
}

/* ---- samples ------------------------------------------------------------------------------------------- */
static void every_kind_is_read (void **state)
{
    (void) state;
    static const struct { const char *name; pg_element kind; double volume, area, off;
    } list[] = {
        { "disk_tri3", PG_TRI3, 0.84, 2.8, 0.03 },      { "disk_tri6_41", PG_TRI6, 0.84, 2.8, 3e-4 },
        { "disk_quad4", PG_QUAD4, 0.84, 2.8, 0.03 },    { "disk_quad8", PG_QUAD8, 0.84, 2.8, 3e-4 },
        { "disk_quad9", PG_QUAD9, 0.84, 2.8, 3e-4 },    { "box_hex8", PG_HEX8, 0, 0, 1e-14 },
        { "box_hex20_22", PG_HEX20, 0, 0, 1e-14 },      { "box_hex27", PG_HEX27, 0, 0, 1e-14 },
        { "cylinder_wedge6", PG_WEDGE6, 1.5, 5, 0.11 }, { "cylinder_wedge15", PG_WEDGE15, 1.5, 5, 2e-3 },
        { "ball_tet4", PG_TET4, 4.0 / 3, 4, 0.16 },     { "ball_tet10", PG_TET10, 4.0 / 3, 4, 0.02 }
    };
    for (size_t k = 0; k < sizeof list / sizeof *list; k++) {
        pg_mesh mesh = sample (list[k].name);
        double inside, area = surface_area (&mesh, &inside), volume = mesh_volume (&mesh);
        for (size_t e = 0; e < mesh.n; e++) assert_int_equal (mesh.kind[e], list[k].kind);
        check_relative (inside, volume, 1e-12);
        check_relative (volume, list[k].volume ? list[k].volume * pi : 2, list[k].off);
        check_relative (area, list[k].area ? list[k].area * pi : 10, list[k].off);
        pg_mesh_clear (&mesh);
    }
}

static void groups_of_the_disk (void **state)
{
    (void) state;
    static const char *const names[] = { "disk_tri3",    "disk_tri6_22",  "disk_tri6_22b",
                                         "disk_tri6_41", "disk_tri6_41b", "disk_quad9" };
    for (int k = 0; k < 6; k++) {
        pg_mesh mesh = sample (names[k]);
        double inside, off = k == 0 ? 0.03 : 5e-4;
        assert_int_equal (mesh.dim, 2);
        assert_int_equal (mesh.nblock, 2);
        assert_string_equal (mesh.blocks[0].name, "outside");
        assert_string_equal (mesh.blocks[1].name, "inside");
        assert_int_equal (mesh.blocks[1].id, 2);
        for (size_t e = 0; e < mesh.n; e++) {
            double x[18], r = 0;
            int corners = pg_element_types[mesh.kind[e]].corners;
            element_places (&mesh, e, corners, NULL, x);
            for (int i = 0; i < corners; i++) r += hypot (x[2 * i], x[2 * i + 1]) / corners;
            assert_int_equal (mesh.block[e], r < 0.7);
        }
        const pg_mesh_sides *rim = sides (&mesh, "rim"), *hole = sides (&mesh, "hole"),
                            *interface = sides (&mesh, "interface");
        check_relative (sides_area (&mesh, rim->n, rim->element, rim->side, &inside), 2 * pi, off);
        check_relative (inside, pi, 4 * off);
        check_relative (sides_area (&mesh, hole->n, hole->element, hole->side, &inside), 0.8 * pi, off);
        check_relative (inside, -0.16 * pi, 4 * off);        /* outward: towards the centre */
        check_relative (sides_area (&mesh, interface->n, interface->element, interface->side, &inside),
                        1.4 * pi, off);
        for (size_t s = 0; s < interface->n; s++)
            assert_true (s == 0 || interface->element[s] > interface->element[s - 1]);
        const pg_mesh_nodes *corner = nodes (&mesh, "corner"), *edge = nodes (&mesh, "hole");
        assert_int_equal (corner->n, 1);
        check_absolute (mesh.x[3 * corner->node[0]], 1, 1e-15);
        for (size_t i = 0; i < edge->n; i++)
            check_relative (hypot (mesh.x[3 * edge->node[i]], mesh.x[3 * edge->node[i] + 1]), 0.4, 1e-7);
        assert_int_equal (edge->n, hole->n * (k == 0 ? 1 : 2));
        pg_mesh_clear (&mesh);
    }
}

static void same (const pg_mesh *a, const pg_mesh *b)
{
    assert_int_equal (a->dim, b->dim);
    assert_int_equal (a->nnode, b->nnode);
    assert_int_equal (a->n, b->n);
    assert_memory_equal (a->node_id, b->node_id, a->nnode * sizeof *a->node_id);
    for (size_t k = 0; k < 3 * a->nnode; k++) check_absolute (a->x[k], b->x[k], 2e-15);
    assert_memory_equal (a->kind, b->kind, a->n);
    assert_memory_equal (a->node, b->node, a->start[a->n] * sizeof *a->node);
    assert_memory_equal (a->block, b->block, a->n * sizeof *a->block);
    assert_int_equal (a->nblock, b->nblock);
    assert_int_equal (a->nnodes, b->nnodes);
    assert_int_equal (a->nsides, b->nsides);
    for (size_t k = 0; k < a->nblock; k++) assert_string_equal (a->blocks[k].name, b->blocks[k].name);
    for (size_t k = 0; k < a->nnodes; k++) {
        assert_string_equal (a->nodes[k].name, b->nodes[k].name);
        assert_int_equal (a->nodes[k].n, b->nodes[k].n);
        assert_memory_equal (a->nodes[k].node, b->nodes[k].node, a->nodes[k].n * sizeof (int));
    }
    for (size_t k = 0; k < a->nsides; k++) {
        assert_string_equal (a->sides[k].name, b->sides[k].name);
        assert_int_equal (a->sides[k].n, b->sides[k].n);
        assert_memory_equal (a->sides[k].element, b->sides[k].element, a->sides[k].n * sizeof (int));
        assert_memory_equal (a->sides[k].side, b->sides[k].side, a->sides[k].n * sizeof (int));
    }
}

static void variants_give_the_same_mesh (void **state)
{
    (void) state;
    static const char *const names[] = { "disk_tri6", "box_hex20", "disk_tri3_parametric" },
                             *const variant[] = { "22", "22b", "41", "41b" };
    for (int k = 0; k < 3; k++) {
        pg_mesh mesh[4];
        for (int v = 0; v < 4; v++) {
            char name[80];
            snprintf (name, sizeof name, "%s_%s", names[k], variant[v]);
            mesh[v] = sample (name);
            if (v > 0) same (&mesh[v], &mesh[0]);
        }
        for (int v = 0; v < 4; v++) pg_mesh_clear (&mesh[v]);
    }
}

/* ---- texts --------------------------------------------------------------------------------------------- */
static pg_status parse (pg_mesh *mesh, const char *text)
{
    return mesh_parse (mesh, &(mesh_file) { "part.msh", text, strlen (text) });
}

#define HEAD2 "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
#define NODES2 "$Nodes\n4\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1.5d0 0\n$EndNodes\n"
#define HEAD4 "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
#define NODES4 "$Nodes\n1 4 1 4\n2 1 0 4\n1\n2\n3\n4\n0 0 0\n1 0 0\n1 1 0\n0 1.5 0\n$EndNodes\n"

static void what_is_not_known_is_skipped (void **state)
{
    (void) state;
    pg_mesh a, b;
    check_ok (parse (
        &a, "$Comments\nby hand\n$EndComments\n" HEAD2 "$Periodic\n$Nodes\n$EndPeriodic\n\r\n" NODES2
            "$Elements\r\n1\r\n\r\n 9 3 3 -5 0 7 1 2 3 4\r\n$EndElements\r\n$NodeData\n1\n$EndNodeData\n"));
    check_ok (parse (&b, HEAD4 "$PartitionedEntities\n1\n0\n0 0 0 0\n"
                         "$EndPartitionedEntities\n$Entities\n0 0 1 0\n1 "
                               "0 0 0 1 1 0 1 -5 0\n$EndEntities\n" NODES4
                               "$Elements\n1 1 9 9\n2 1 3 1\n9 1 2 3 4 \n$EndElements\n"));
    same (&a, &b);
    check_relative (mesh_volume (&a), 1.25, 1e-15);
    assert_int_equal (a.blocks[0].id, 5);
    pg_mesh_clear (&a), pg_mesh_clear (&b);
}

static void an_entity_of_two_groups (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (parse (&m, HEAD4
                     "$PhysicalNames\n3\n1 4 \"side \"\"a\"\n2 5 \"steel\"\n2 6 \"part\"\n$EndPhysicalNames\n"
                     "$Entities\n0 1 1 0\n3 0 0 0 1 1 0 2 4 8 0\n1 0 0 0 1 1 0 2 5 6 0\n$EndEntities\n" NODES4
                     "$Elements\n2 2 9 10\n2 1 3 1\n9 1 2 3 4 \n1 3 1 1\n10 2 1\n$EndElements\n"));
    assert_int_equal (m.n, 1);
    assert_string_equal (m.blocks[0].name, "steel");
    assert_int_equal (nodes (&m, "part")->n, 4);
    assert_int_equal (sides (&m, "side \"\"a")->n, 1);
    assert_int_equal (sides (&m, "8")->side[0], 0);
    pg_mesh_clear (&m);
}

static void put (char **at, const void *value, size_t size, int swap)
{
    for (size_t k = 0; k < size; k++) (*at)[swap ? size - 1 - k : k] = ((const char *) value)[k];
    *at += size;
}

static void both_byte_orders (void **state)
{
    (void) state;
    pg_mesh text, mesh;
    check_ok (parse (&text, HEAD2 NODES2 "$Elements\n1\n9 3 2 5 7 1 2 3 4\n$EndElements\n"));
    for (int swap = 0; swap < 2; swap++) {
        char file[1000], *at = file;
        const double x[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1.5, 0 } };
        at += sprintf (at, "$MeshFormat\n2.2 1 8\n");
        put (&at, &(int) { 1 }, 4, swap);
        at += sprintf (at, "\n$EndMeshFormat\n$Nodes\n4\n");
        for (int k = 0; k < 4; k++) {
            put (&at, &(int) { k + 1 }, 4, swap);
            for (int a = 0; a < 3; a++) put (&at, &x[k][a], 8, swap);
        }
        at += sprintf (at, "\n$EndNodes\n$Elements\n1\n");
        const int element[10] = { 3, 1, 2, 9, 5, 7, 1, 2, 3, 4 };
        for (int k = 0; k < 10; k++) put (&at, &element[k], 4, swap);
        at += sprintf (at, "\n$EndElements\n");
        check_ok (mesh_parse (&mesh, &(mesh_file) { "part.msh", file, (size_t) (at - file) }));
        same (&mesh, &text);
        pg_mesh_clear (&mesh);
    }
    pg_mesh_clear (&text);
}

/* ---- faults -------------------------------------------------------------------------------------------- */
static void fault (const char *text, const char *words)
{
    pg_mesh mesh;
    check_fails (parse (&mesh, text), PG_E_FILE);
    check_contains (pg_last_error (), words);
    check_contains (pg_last_error (), "part.msh");
}

static void faults_of_both (void **state)
{
    (void) state;
    fault ("", "is none of the mesh files that are known: Gmsh .msh 2.2, Gmsh .msh 4.1");
    fault ("x y z\n1 2 3\n", "is none of the mesh files");
    fault ("$MeshFormat\n4 0 8\n$EndMeshFormat\n", "version 4 of Gmsh's format is not known");
    fault ("$MeshFormat\n1 0 8\n$EndMeshFormat\n", "version 1 of");
    fault ("$MeshFormat\n2.2 0\n$EndMeshFormat\n",
           "line 2: $MeshFormat needs version, file type and data size");
    fault ("$MeshFormat\n2.2 0 4\n$EndMeshFormat\n", "line 2: the size of numbers is 4 bytes");
    fault ("$MeshFormat\n2.2 0 8\n$Nodes\n", "line 3: expected $EndMeshFormat, found '$Nodes'");
    fault ("$MeshFormat\n2.2 1 8\nabcd", "the number that tells the byte order is");
    fault ("$MeshFormat\n2.2 1 8\nabc", "1 records of 4 bytes do not fit into the 3 bytes");
    fault (HEAD2, "there are no nodes");
    fault (HEAD4 NODES4, "points without elements");
    fault (HEAD2 "$PhysicalNames\n1\n2 1 steel\n$EndPhysicalNames\n", "line 6: name 1 of 1 is not in quotes");
    fault (HEAD2 "$PhysicalNames\n1\n7 1 \"steel\"\n$EndPhysicalNames\n",
           "line 6: name 1 of 1 needs dimension (0 to 3)");
    fault (HEAD2 "$Odd\n1\n", "the file ends before $EndOdd");
}

static void faults_of_2 (void **state)
{
    (void) state;
    fault (HEAD2 "$Nodes\n-4\n", "line 5: -4 nodes");
    fault (HEAD2 "$Nodes\n400000000000\n1 0 0 0\n", "the file ends before the last node");
    fault (HEAD2 "$Nodes\n1\n1 0 nan 0\n$EndNodes\n",
           "line 6: coordinate 2 of a node is missing or no finite number");
    fault (HEAD2 "$Nodes\n1\n1 0 1e999 0\n$EndNodes\n", "line 6: coordinate 2");
    fault (HEAD2 "$Nodes\n1\nx 0 0 0\n$EndNodes\n", "line 6: node 1 of 1 has no number");
    fault (HEAD2 "$Nodes\n1\n1 0 0 0\n2 0 0 0\n$EndNodes\n", "line 7: expected $EndNodes, found '2 0 0 0'");
    fault (HEAD2 "$Nodes\n2\n1 0 0 0\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 1 0 1 1\n$EndElements\n",
           "node 1 is there twice");
    fault (HEAD2 NODES2 "$Elements\n-1\n$EndElements\n", "-1 elements");
    fault (HEAD2 NODES2 "$Elements\n1\n9 19 2 0 0 1 2 3 4 1 2 3 4 1 2 3 4 1\n$EndElements\n",
           "line 13: element 9 is a pyramid of 13 nodes (type 19 of Gmsh)");
    fault (HEAD2 NODES2 "$Elements\n1\n9 92 2 0 0 1 2 3 4 1\n$EndElements\n",
           "element 9 is of a kind of its own (type 92 of Gmsh)");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3 2 0 0 1 2 3\n$EndElements\n",
           "line 13: element 9 (quad4): node 4 of 4 is missing");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3 -2 0 0 1 2 3\n$EndElements\n", "element 9 has -2 tags");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3 200 0 0 1 2 3\n$EndElements\n",
           "element 9: tag 6 of 200 is missing");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3\n$EndElements\n", "an element needs number, type");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3 2 0 0 1 2 3 5\n$EndElements\n",
           "part.msh, line 13: element 9 (quad4): node 5 is not in the file");
    fault (HEAD2 NODES2 "$Elements\n1\n9 3 2 0 0 1 2 3 99999999999999999999\n$EndElements\n",
           "node 4 of 4 is missing");
}

static void faults_of_4 (void **state)
{
    (void) state;
    fault (HEAD4 "$Entities\n0 0 1\n", "line 5: the numbers of entities: number 4 of 4 is missing");
    fault (HEAD4 "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 -1\n",
           "line 6: entity 1: the number of its groups is missing or negative");
    fault (HEAD4 "$Entities\n0 0 1 0\n1 0 0 0 1 1 0 2 3\n", "entity 1: group 2 of 2 is missing");
    fault (HEAD4 "$Entities\n1 0 0 0\n1 0 0\n", "entity 1: number 3 of its box is missing");
    fault (HEAD4 "$Nodes\n1 -4 1 4\n", "the number of nodes: 1 blocks with -4 members");
    fault (HEAD4 "$Nodes\n1 4 1 4\n2 1 0 5\n", "line 6: a block of nodes: 5 members where 4 are left");
    fault (HEAD4 "$Nodes\n1 4 1 4\n5 1 0 4\n", "an entity of dimension 5");
    fault (HEAD4 "$Nodes\n1 400000000 1 4\n2 1 0 400000000\n1\n",
           "the file ends before the last number of a node");
    fault (HEAD4 "$Nodes\n1 1 1 4\n2 1 0 1\n1\n0 0 inf\n$EndNodes\n", "line 8: coordinate 3");
    fault (HEAD4 "$Nodes\n1 2 1 4\n2 1 0 1\n1\n0 0 0\n$EndNodes\n", "1 nodes are missing");
    fault (HEAD4 NODES4 "$Elements\n1 1 9 9\n2 1 14 1\n9 1 2 3 4\n$EndElements\n",
           "element 9 is a pyramid of 14 nodes");
    fault (HEAD4 NODES4 "$Elements\n1 1 9 9\n2 1 3 1\n9 1 2 3\n$EndElements\n",
           "element 9 (quad4): node 4 of 4 is missing");
    fault (HEAD4 NODES4 "$Elements\n1 2 9 9\n2 1 3 1\n9 1 2 3 4\n$EndElements\n", "1 elements are missing");
}

static void faults_of_binary_files_name_the_byte (void **state)
{
    (void) state;
    static const char *const names[] = { "data/mesh/box_hex20_41b.msh", "data/mesh/disk_tri6_22b.msh" };
    for (int k = 0; k < 2; k++) {
        mesh_file file;
        char *bytes;
        pg_mesh mesh;
        check_ok (mesh_load (&file, &bytes, names[k]));
        for (size_t n = 0; n < file.size; n += 7) {
            pg_status status = mesh_parse (&mesh, &(mesh_file) { "part.msh", file.text, n });
            if (status == PG_OK) assert_true (n + 16 > file.size);
            else assert_int_equal (status, PG_E_FILE);
            if (n == 4200) check_contains (pg_last_error (), "part.msh, byte ");
            pg_mesh_clear (&mesh);
        }
        pg_free (bytes);
    }
}

static void files_that_are_none (void **state)
{
    (void) state;
    pg_mesh mesh;
    check_fails (pg_mesh_read (&mesh, "data/mesh/none.msh"), PG_E_FILE);
    check_contains (pg_last_error (), "data/mesh/none.msh: cannot be read");
    check_fails (pg_mesh_read (&mesh, "data/mesh"), PG_E_FILE);
    check_contains (pg_last_error (), "is not a file");
    check_fails (pg_mesh_read (&mesh, "data/mesh/disk.geo"), PG_E_FILE);
    check_contains (pg_last_error (), "perigal-mesh");
}

static void numbers_are_read_to_the_last_bit (void **state)
{
    (void) state;
    static const char *const good[] = { "1",
                                        "-0.5",
                                        "1e22",
                                        "123456789012345678",
                                        "0.1",
                                        "6.02214076e23",
                                        "4.9e-324",
                                        "1.7976931348623157e308",
                                        ".5",
                                        "3.",
                                        "+7e+2",
                                        "0.30000000000000004",
                                        "9007199254740993",
                                        "1e-23",
                                        "-1.5e-7",
                                        "00001.50" };
    for (size_t k = 0; k < sizeof good / sizeof *good; k++) {
        const char *at = good[k];
        double value;
        assert_int_equal (mesh_real (&at, at + strlen (at), &value), 1);
        assert_true (value == strtod (good[k], NULL));
        assert_int_equal (*at, 0);
    }
    static const char *const bad[] = { "",     "  ",  ".",  "-",     "e5",
                                       "nan",  "inf", "1e", "1e999", "1e99999999999999999999",
                                       "1e +5" };
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        const char *at = bad[k];
        double value;
        assert_int_equal (mesh_real (&at, at + strlen (at), &value), 0);
    }
}

static void every_allocation_may_fail (void **state)
{
    (void) state;
    size_t used = pg_memory_used ();
    for (size_t k = 1, more = 1; more; k += 1 + k / 20) {
        pg_mesh mesh;
        pg_memory_fail_at (k);
        pg_status status = pg_mesh_read (&mesh, "data/mesh/disk_tri6_41b.msh");
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        more = status != PG_OK;
        pg_mesh_clear (&mesh);
        assert_int_equal (pg_memory_used (), used);
        assert_true (k < 10000);
    }
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_kind_is_read),
        cmocka_unit_test (groups_of_the_disk),
        cmocka_unit_test (variants_give_the_same_mesh),
        cmocka_unit_test (what_is_not_known_is_skipped),
        cmocka_unit_test (an_entity_of_two_groups),
        cmocka_unit_test (both_byte_orders),
        cmocka_unit_test (faults_of_both),
        cmocka_unit_test (faults_of_2),
        cmocka_unit_test (faults_of_4),
        cmocka_unit_test (faults_of_binary_files_name_the_byte),
        cmocka_unit_test (files_that_are_none),
        cmocka_unit_test (numbers_are_read_to_the_last_bit),
        cmocka_unit_test (every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/mesh_files/gmsh", tests, NULL, NULL);
}
