/* SPDX-License-Identifier: GPL-3.0-or-later
 * Input files of Abaqus and CalculiX: every element type, order of nodes and faces, sets, surfaces, include
 * files, faults. */
#include "check.h"
#include "geometry/mesh/measure.h"
#include "io/mesh_files/format.h"
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static pg_status parse (pg_mesh *m, const char *text)
{
    return mesh_parse (m, &(mesh_file){ "job.inp", text, strlen (text) });
}

static void wrong (const char *text, const char *why)
{
    pg_mesh m;
    size_t used = pg_memory_used ();
    check_fails (parse (&m, text), PG_E_FILE);
    check_contains (pg_last_error (), why);
    assert_int_equal (pg_memory_used (), used);
}

static const pg_mesh_nodes *nodes_of (const pg_mesh *m, const char *name)
{
    for (size_t k = 0; k < m->nnodes; k++) if (strcmp (m->nodes[k].name, name) == 0) return &m->nodes[k];
    print_error ("no node set '%s'\n", name);
    fail ();
    return NULL;
}

static const pg_mesh_sides *sides_of (const pg_mesh *m, const char *name)
{
    for (size_t k = 0; k < m->nsides; k++) if (strcmp (m->sides[k].name, name) == 0) return &m->sides[k];
    print_error ("no side set '%s'\n", name);
    fail ();
    return NULL;
}

/* Edges on which the middle nodes of an element lie, in the order of Abaqus (its manual, "Solid element
 * library"), corners from 1. */
typedef struct { const char *type; pg_element kind; int edge[12][2]; int face[6][4]; } sort;
static const sort sorts[] = {
    { "CPE3", PG_TRI3, { { 0 } }, { { 1, 2 }, { 2, 3 }, { 3, 1 } } },
    { "CPS4R", PG_QUAD4, { { 0 } }, { { 1, 2 }, { 2, 3 }, { 3, 4 }, { 4, 1 } } },
    { "cps6", PG_TRI6, { { 1, 2 }, { 2, 3 }, { 3, 1 } }, { { 1, 2 }, { 2, 3 }, { 3, 1 } } },
    { "CPE8RH",
      PG_QUAD8,
      { { 1, 2 }, { 2, 3 }, { 3, 4 }, { 4, 1 } },
      { { 1, 2 }, { 2, 3 }, { 3, 4 }, { 4, 1 } } },
    { "C3D4", PG_TET4, { { 0 } }, { { 1, 2, 3 }, { 1, 4, 2 }, { 2, 4, 3 }, { 3, 4, 1 } } },
    { "C3D10M",
      PG_TET10,
      { { 1, 2 }, { 2, 3 }, { 3, 1 }, { 1, 4 }, { 2, 4 }, { 3, 4 } },
      { { 1, 2, 3 }, { 1, 4, 2 }, { 2, 4, 3 }, { 3, 4, 1 } } },
    { "C3D8I",
      PG_HEX8,
      { { 0 } },
      { { 1, 2, 3, 4 }, { 5, 8, 7, 6 }, { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 8, 4 }, { 4, 8, 5, 1 } } },
    { "C3D20R",
      PG_HEX20,
      { { 1, 2 },
        { 2, 3 },
        { 3, 4 },
        { 4, 1 },
        { 5, 6 },
        { 6, 7 },
        { 7, 8 },
        { 8, 5 },
        { 1, 5 },
        { 2, 6 },
        { 3, 7 },
        { 4, 8 } },
      { { 1, 2, 3, 4 }, { 5, 8, 7, 6 }, { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 3, 7, 8, 4 }, { 4, 8, 5, 1 } } },
    { "C3D5",
      PG_PYRAMID5,
      { { 0 } },
      { { 1, 4, 3, 2 }, { 1, 2, 5 }, { 2, 3, 5 }, { 3, 4, 5 }, { 4, 1, 5 } } },
    { "C3D6",
      PG_WEDGE6,
      { { 0 } },
      { { 1, 2, 3 }, { 4, 6, 5 }, { 1, 4, 5, 2 }, { 2, 5, 6, 3 }, { 3, 6, 4, 1 } } },
    { "C3D15",
      PG_WEDGE15,
      { { 1, 2 }, { 2, 3 }, { 3, 1 }, { 4, 5 }, { 5, 6 }, { 6, 4 }, { 1, 4 }, { 2, 5 }, { 3, 6 } },
      { { 1, 2, 3 }, { 4, 6, 5 }, { 1, 4, 5, 2 }, { 2, 5, 6, 3 }, { 3, 6, 4, 1 } } },
};

static void bend (double *x)
{
    double y = x[1];
    x[1] += 0.1 * x[0] * x[0];
    x[0] += 0.05 * y * x[2] + 0.1 * y * y;
}

static int edge_between (pg_element kind, int p, int q)
{
    for (int e = 0; e < pg_element_types[kind].edges; e++) {
        int end[2];
        pg_element_edge (kind, e, end);
        if ((end[0] == p && end[1] == q) || (end[0] == q && end[1] == p)) return e;
    }
    fail ();
    return -1;
}

/* Node of ours that is node k of Abaqus. */
static int ours (const sort *s, int k)
{
    int corners = pg_element_types[s->kind].corners;
    return k < corners
               ? k
               : corners + edge_between (s->kind, s->edge[k - corners][0] - 1, s->edge[k - corners][1] - 1);
}

static void write_job (FILE *f, const pg_mesh *m, const sort *s)
{
    int nodes = pg_element_types[s->kind].nodes;
    fprintf (f, "*Heading\nabc\n**\n*Node, nset=all\n");
    for (size_t i = 0; i < m->nnode; i++)
        fprintf (f, "%zu, %.17g, %.17g, %.17g\n", i + 10, m->x[3 * i], m->x[3 * i + 1], m->x[3 * i + 2]);
    fprintf (f, "*Element, type = %s,\n** in between\n elset=body\n", s->type);
    for (size_t e = 0; e < m->n; e++) {
        fprintf (f, "%zu", 7 + 2 * e);
        for (int k = 0; k < nodes; k++)
            fprintf (f, ",%s %d", k % 7 == 6 ? "\r\n" : "", m->node[m->start[e] + (size_t) ours (s, k)] + 10);
        fprintf (f, "\n");
    }
    for (int side = 0; side < pg_element_types[s->kind].faces; side++)
        fprintf (f, "*SURFACE, NAME=f%d\nbody, S%d\n", side, side + 1);
    fprintf (f, "*Step\n*cload\n11, 1, 5.\n*end step\n");
}

static void check_faces (const pg_mesh *m, const sort *s)
{
    for (int f = 0; f < pg_element_types[s->kind].faces; f++) {
        char name[16];
        snprintf (name, sizeof name, "f%d", f);
        const pg_mesh_sides *set = sides_of (m, name);
        assert_int_equal (set->n, m->n);
        int node[9], corners = pg_element_types[pg_element_face (s->kind, set->side[0], node)].corners,
                     found = 0;
        for (int k = 0; k < corners; k++) for (int j = 0; j < 4; j++) found += node[k] == s->face[f][j] - 1;
        if (found != corners) print_error ("%s: face %d\n", s->type, f + 1);
        assert_int_equal (found, corners);
        assert_int_equal (nodes_of (m, name)->n > 0, 1);
    }
}

static void every_type_is_read_back (void **state)
{
    (void) state;
    for (size_t k = 0; k < sizeof sorts / sizeof *sorts; k++) {
        const sort *s = &sorts[k];
        char *text = NULL;
        size_t size;
        FILE *f = open_memstream (&text, &size);
        pg_mesh a = block_mesh (s->kind, 2, bend), b;
        double inside_a, inside_b, area = surface_area (&a, &inside_a);
        write_job (f, &a, s);
        fclose (f);
        check_ok (parse (&b, text));
        assert_int_equal (b.n, a.n);
        assert_int_equal (b.dim, a.dim);
        assert_int_equal (b.nnode, a.nnode);
        assert_int_equal (b.element_id[1], 9);
        assert_string_equal (b.blocks[0].name, "body");
        assert_int_equal (memcmp (a.kind, b.kind, a.n), 0);
        check_relative (mesh_volume (&b), mesh_volume (&a), 1e-14);
        check_relative (surface_area (&b, &inside_b), area, 1e-14);
        for (size_t e = 0; e < a.n; e++)
            for (size_t j = a.start[e]; j < a.start[e + 1]; j++)
                for (size_t c = 0; c < 3; c++)
                    check_scaled (b.x[3 * (size_t) b.node[j] + c], a.x[3 * (size_t) a.node[j] + c], 1e-15, 1);
        assert_int_equal (nodes_of (&b, "all")->n, a.nnode);
        check_faces (&b, s);
        pg_mesh_clear (&a), pg_mesh_clear (&b);
        free (text);
    }
}

#define SQUARES "*NODE\n1,0,0\n2,1\n3,1,1\n4,0,1,\n5,2.,0.\n6,2.D0,1.\n"
#define TWO "*ELEMENT,TYPE=CPS4,ELSET=A\n1,1,2,3,4\n*ELEMENT,TYPE=CPS4,ELSET=B\n2,2,5,6,3\n"

static void sets_are_read (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (parse (&m, SQUARES TWO
                     "*NSET,NSET=low\n1,2,\n5\n*nset , nset=\"odd ones\", generate\n1,100000000,2\n"
                     "*ELSET,ELSET=both\nA,B\n*ELSET,ELSET=first,GENERATE\n1,1\n*NSET,NSET=mixed\nLow, "
                     "6\n*NSET,NSET=ofB,ELSET=b\n"
                     "*SURFACE,NAME=right,TYPE=ELEMENT\n2,S2\n*SURFACE,TYPE=NODE,NAME=spots\nlow, "
                     "1.\n6\n*SURFACE,NAME=rim\nboth,E1\na,S4\n"));
    assert_int_equal (m.nblock, 2);
    assert_string_equal (m.blocks[1].name, "B");
    assert_int_equal (m.block[1], 1);
    assert_int_equal (nodes_of (&m, "low")->n, 3);
    assert_int_equal (nodes_of (&m, "odd ones")->n, 3);
    assert_int_equal (nodes_of (&m, "both")->n, 6);
    assert_int_equal (nodes_of (&m, "first")->n, 4);
    assert_int_equal (nodes_of (&m, "mixed")->n, 4);
    assert_int_equal (nodes_of (&m, "ofB")->n, 4);
    assert_int_equal (nodes_of (&m, "spots")->n, 4);
    assert_int_equal (sides_of (&m, "right")->n, 1);
    assert_int_equal (sides_of (&m, "right")->element[0], 1);
    assert_int_equal (sides_of (&m, "right")->side[0], 1);
    assert_int_equal (sides_of (&m, "rim")->n, 3);
    pg_mesh_clear (&m);
}

static void sets_that_name_one_another_end (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (parse (&m, SQUARES TWO "*ELSET,ELSET=x\n1\n*ELSET,ELSET=y\nx,x,2\n*ELSET,ELSET=x\ny,y\n"));
    assert_int_equal (nodes_of (&m, "x")->n, 6);
    pg_mesh_clear (&m);
}

/* As Abaqus/CAE writes it: elements without a set, sections, an assembly of one instance. */
static void parts_and_sections_are_read (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (
        parse (&m, "*Part, name=P\n" SQUARES "*Element, type=CPS4R\n1,1,2,3,4\n2,2,5,6,3\n*Nset, "
                                             "nset=S\n1,2\n*Elset, elset=steel\n 2,\n*Elset, elset=S\n1\n"
                   "*Solid Section, elset=steel, material=M\n,\n*Solid Section, elset=S, material=N\n,\n*End "
                   "Part\n*Assembly, name=A\n*Instance, name=P-1, part=P\n0.,0.,0.\n*End Instance\n"
                   "*Nset, nset=top, instance=P-1\n 3, 4\n*Nset, nset=bottom\nP-1.1, P-1.5\n*Elset, "
                   "elset=_s_S1, internal, instance=P-1\n 1, 2\n"
                   "*Surface, type=ELEMENT, name=s\n_s_S1, S1\n*End Assembly\n"));
    assert_int_equal (m.nblock, 2);
    assert_string_equal (m.blocks[m.block[0]].name, "S");
    assert_string_equal (m.blocks[m.block[1]].name, "steel");
    assert_int_equal (nodes_of (&m, "S")->n, 2);
    assert_int_equal (nodes_of (&m, "bottom")->n, 2);
    assert_int_equal (sides_of (&m, "s")->n, 2);
    pg_mesh_clear (&m);
}

static void lines_and_springs_beside_a_body (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (parse (&m, SQUARES "8,9,9,9\n" TWO "*ELEMENT,TYPE=T3D2,ELSET=edge\n11,1,2\n12,2,5\n*ELEMENT,"
                                                 "TYPE=SPRINGA,ELSET=s\n13,1,2\n*ELEMENT,TYPE=MASS\n14,8\n"));
    assert_int_equal (m.n, 2);
    assert_int_equal (m.nnode, 6);
    assert_int_equal (sides_of (&m, "edge")->n, 2);
    pg_mesh_clear (&m);
}

static void shells_in_a_plane_are_plane_elements (void **state)
{
    (void) state;
    pg_mesh m;
    check_ok (parse (&m, SQUARES "*ELEMENT,TYPE=S4R,ELSET=A\n1,1,2,3,4\n2,2,5,6,3\n*SURFACE,NAME=up\nA,"
                                 "SPOS\n*SURFACE,NAME=edge\n1,E4\n*SURFACE,NAME=same\n1,S6\n"));
    assert_int_equal (m.dim, 2);
    assert_int_equal (m.nsides, 2);
    assert_int_equal (sides_of (&m, "edge")->side[0], 3);
    assert_int_equal (sides_of (&m, "same")->side[0], 3);
    assert_int_equal (nodes_of (&m, "up")->n, 6);
    pg_mesh_clear (&m);
}

static void write_file (const char *path, const char *text)
{
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fputs (text, f);
    fclose (f);
}

static void files_are_included (void **state)
{
    (void) state;
    char folder[] = "/tmp/perigal_mesh_XXXXXX", main_path[64], nodes[64], sub[64];
    pg_mesh m;
    assert_non_null (mkdtemp (folder));
    snprintf (main_path, sizeof main_path, "%s/a.inp", folder);
    snprintf (sub, sizeof sub, "%s/sub", folder);
    snprintf (nodes, sizeof nodes, "%s/sub/n.inc", folder);
    assert_int_equal (mkdir (sub, 0700), 0);
    write_file (nodes, "1,0,0\n2,1,0\n3,0,1\n");
    write_file (main_path,
                "*NODE, INPUT=sub/n.inc\n4,1,1\n*ELEMENT,TYPE=C2D3\n1,1,2,3\n2,2,4,3\n*INCLUDE,INPUT = "
                "sub/none.inc\n");
    check_fails (pg_mesh_read (&m, main_path), PG_E_FILE);
    check_contains (pg_last_error (), "a.inp, line 6: the file it includes: ");
    check_contains (pg_last_error (), "sub/none.inc");
    write_file (main_path, "*NODE, INPUT=sub/n.inc\n4,1,1\n*ELEMENT,TYPE=C2D3\n1,1,2,3\n2,2,4,3\n");
    check_ok (pg_mesh_read (&m, main_path));
    check_relative (mesh_volume (&m), 1, 1e-15);
    pg_mesh_clear (&m);
    write_file (main_path, "*INCLUDE, INPUT=a.inp\n");
    check_fails (pg_mesh_read (&m, main_path), PG_E_FILE);
    check_contains (pg_last_error (), "include one another");
    write_file (main_path, "*INCLUDE, INPUT=/dev/zero\n");
    check_fails (pg_mesh_read (&m, main_path), PG_E_FILE);
    check_contains (pg_last_error (), "is not a file");
    unlink (nodes), unlink (main_path), rmdir (sub), rmdir (folder);
}

static void faults_name_their_line (void **state)
{
    (void) state;
    wrong ("*NODE\n1,0,0\n", "job.inp: no *ELEMENT");
    wrong ("*NODE\n1,0,0\nx\n", "job.inp, line 3: 'x' is no node");
    wrong ("*NODE\n1,0,0,1x\n", "line 2: coordinate 3 of node 1 is '1x'");
    wrong ("*NODE\n1,0,nan\n", "line 2: coordinate 2 of node 1 is 'nan'");
    wrong ("*NODE, SYSTEM=C\n1,0,0\n", "line 1: nodes with SYSTEM=C are not read");
    wrong (SQUARES "*ELEMENT,TYPE=CPX4\n",
           "line 8: elements of type 'CPX4' are not known (did you mean 'CPS4'?)");
    wrong (SQUARES "*ELEMENT,TYPE=CAX4\n", "elements of type 'CAX4' are not known");
    wrong (SQUARES "*ELEMENT\n", "*ELEMENT without TYPE=");
    wrong (SQUARES "*ELEMENT,TYPE=CPS4\n1,1,2,3\n*NSET\n", "line 9: element 1 has 3 of 4 nodes");
    wrong (SQUARES "*ELEMENT,TYPE=CPS4\n1,1,2,3\n", "line 9: element 1 has 3 of 4 nodes");
    wrong (SQUARES "*ELEMENT,TYPE=CPS4\n1,1,2,y,4\n", "line 9: 'y,4' is no number");
    wrong (SQUARES "*ELEMENT,TYPE=CPS4\n1,1,2,3,44\n", "job.inp, line 9: element 1");
    wrong (SQUARES TWO "*NSET\n1\n", "*NSET without NSET=NAME");
    wrong (SQUARES TWO "*NSET,NSET=q\n1,99\n", "line 13: node 99 of set 'q' is not there");
    wrong (SQUARES TWO "*NSET,NSET=q\nzz\n", "line 13: there is no node set 'zz' before this line");
    wrong (SQUARES TWO "*ELSET,ELSET=q,GENERATE\n2,1\n", "line 13: a set by GENERATE");
    wrong (SQUARES TWO "*ELSET,ELSET=q,GENERATE\n1,2,0\n", "line 13: a set by GENERATE");
    wrong (SQUARES TWO "*SURFACE,NAME=q\nA\n", "line 13: surface 'q' names no face of 'A'");
    wrong (SQUARES TWO "*SURFACE,NAME=q\n,S1\n", "line 13: surface 'q' names no element");
    wrong (SQUARES TWO "*SURFACE,NAME=q\nA,S1\n , \n", "line 14: surface 'q' names no element");
    wrong (SQUARES TWO "*SURFACE,NAME=q\nnone,S1\n", "line 13: there is no element set 'none'");
    wrong (SQUARES TWO "*SURFACE,NAME=q\n9,S1\n", "line 13: element 9 of set 'q' is not there");
    wrong (SQUARES "*NGEN\n", "line 8: *NGEN is not read");
    wrong ("*PART,NAME=A\n*PART,NAME=B\n", "line 2: a second *PART");
    wrong ("*INSTANCE,NAME=A\n*END INSTANCE\n*INSTANCE,NAME=B\n", "line 3: a second *INSTANCE");
    wrong ("*INSTANCE,NAME=A\n0.,1.,0.\n", "line 2: the instance is moved or turned");
    wrong ("*INCLUDE\n", "line 1: *INCLUDE without INPUT=FILE");
}

static void no_memory_is_a_fault_everywhere (void **state)
{
    (void) state;
    static const char *const text = SQUARES TWO
        "*NSET,NSET=low\n1,2\n*ELSET,ELSET=both\nA,B\n*SURFACE,NAME=right\n2,S2\n*SOLID SECTION,ELSET=both\n";
    pg_mesh m;
    size_t used = pg_memory_used (), before = pg_memory_calls ();
    check_ok (parse (&m, text));
    size_t calls = pg_memory_calls () - before;
    pg_mesh_clear (&m);
    for (size_t k = 1; k <= calls; k++) {
        pg_memory_fail_at (k);
        check_fails (parse (&m, text), PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    pg_memory_fail_at (0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_type_is_read_back),
        cmocka_unit_test (sets_are_read),
        cmocka_unit_test (sets_that_name_one_another_end),
        cmocka_unit_test (parts_and_sections_are_read),
        cmocka_unit_test (lines_and_springs_beside_a_body),
        cmocka_unit_test (shells_in_a_plane_are_plane_elements),
        cmocka_unit_test (files_are_included),
        cmocka_unit_test (faults_name_their_line),
        cmocka_unit_test (no_memory_is_a_fault_everywhere),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
