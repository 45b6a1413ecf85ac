/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results of CalculiX: patch tests of every element that ccx computed, between nodes; steps, plane elements
 * made solid, faults. */
#include "check.h"
#include "geometry/mesh/measure.h"
#include "io/mesh_files/format.h"
#include <stdlib.h>

/* The displacement that data/mesh/ccx/make.py prescribes is A x. Text has six digits, binary results are
 * floats. */
static const double A[3][3] = { { 1e-3, 2e-4, 0 }, { -1e-4, -3e-4, 1e-4 }, { 5e-5, 0, 2e-4 } };
typedef struct { pg_mesh mesh; size_t n; pg_mesh_field *field; double time; } result;

static result open_result (const char *name, int step)
{
    char path[100];
    result r;
    snprintf (path, sizeof path, "data/mesh/ccx/%s.frd", name);
    check_ok (pg_mesh_result (&r.mesh, path, step, &r.n, &r.field, &r.time));
    return r;
}

static void close_result (result *r)
{
    pg_mesh_fields_clear (r->n, &r->field);
    pg_mesh_clear (&r->mesh);
}

static const pg_mesh_field *field_of (const result *r, const char *name)
{
    for (size_t k = 0; k < r->n; k++) if (strcmp (r->field[k].name, name) == 0) return &r->field[k];
    print_error ("no field '%s'\n", name);
    fail ();
    return NULL;
}

/* Displacement, its gradient and strain inside every element. The strains that ccx wrote at the nodes of
 * these constant fields are up to 5e-5 off (read in c3d20.frd; the displacements are not): seen between the
 * nodes 1.4e-4, allowed 2e-4. */
static void check_patch (const result *r, double factor, double tolerance)
{
    static const int row[6] = { 0, 1, 2, 0, 1, 2 }, column[6] = { 0, 1, 2, 1, 2, 0 };
    const pg_mesh *m = &r->mesh;
    const pg_mesh_field *u = field_of (r, "displacement"), *strain = field_of (r, "strain");
    size_t dim = (size_t) m->dim;
    assert_int_equal (u->components, m->dim);
    assert_int_equal (strain->components, 6);
    assert_int_equal (field_of (r, "stress")->components, 6);
    for (size_t e = 0; e < m->n; e++) {
        double x[81], xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], place[3], value[6], gradient[9];
        int n = pg_element_rule (m->kind[e], 2, xi, w);
        element_places (m, e, pg_element_types[m->kind[e]].nodes, NULL, x);
        for (int q = 0; q < n; q++) {
            const double *at = xi + (size_t) q * dim;
            pg_element_map (m->kind[e], m->dim, x, at, place, NULL);
            pg_mesh_value (m, u, e, at, value);
            assert_int_equal (pg_mesh_gradient (m, u, e, at, gradient), 1);
            for (size_t a = 0; a < dim; a++) {
                double expected = 0;
                for (size_t b = 0; b < dim; b++) {
                    expected += factor * A[a][b] * place[b];
                    check_scaled (gradient[a * dim + b], factor * A[a][b], 2 * tolerance, factor * 1e-3);
                }
                check_scaled (value[a], expected, tolerance, factor * 2e-3);
            }
            pg_mesh_value (m, strain, e, at, value);
            for (size_t k = 0; k < 6; k++)
                if ((size_t) row[k] < dim && (size_t) column[k] < dim)
                    check_scaled (value[k], factor * (A[row[k]][column[k]] + A[column[k]][row[k]]) / 2, 2e-4,
                                  factor * 1e-3);
        }
    }
}

static void every_solid_element_passes_the_patch_test (void **state)
{
    (void) state;
    static const struct { const char *name; pg_element kind; double tolerance;
    } sample[] = { { "c3d4", PG_TET4, 1e-5 },         { "c3d10", PG_TET10, 1e-5 },
                   { "c3d6", PG_WEDGE6, 1e-5 },       { "c3d15", PG_WEDGE15, 1e-5 },
                   { "c3d8", PG_HEX8, 1e-5 },         { "c3d20", PG_HEX20, 1e-5 },
                   { "c3d20_binary", PG_HEX20, 3e-7 } };
    for (size_t k = 0; k < sizeof sample / sizeof *sample; k++) {
        result r = open_result (sample[k].name, -1);
        assert_int_equal (r.mesh.kind[0], sample[k].kind);
        assert_string_equal (r.mesh.blocks[0].name, "STEEL");
        check_relative (mesh_volume (&r.mesh), 8, 1e-13);
        check_relative (r.time, 1, 1e-15);
        check_patch (&r, 1, sample[k].tolerance);
        close_result (&r);
    }
}

static void steps_are_chosen (void **state)
{
    (void) state;
    pg_mesh m;
    pg_mesh_field *f;
    size_t n;
    for (int step = -1; step < 2; step++) {
        result r = open_result ("cps8_steps", step);
        check_relative (r.time, step == 0 ? 1 : 2, 1e-15);
        check_patch (&r, step == 0 ? 1 : 2, 1e-5);
        close_result (&r);
    }
    check_fails (pg_mesh_result (&m, "data/mesh/ccx/cps8_steps.frd", 2, &n, &f, NULL), PG_E_USAGE);
    check_contains (pg_last_error (), "has no step 2; its steps are 0 to 1");
    check_fails (pg_mesh_result (&m, "data/mesh/disk_tri3.msh", -1, &n, &f, NULL), PG_E_FILE);
    check_contains (pg_last_error (), "holds no fields of a kind that is known");
}

static void plane_elements_made_solid_become_plane (void **state)
{
    (void) state;
    static const char *const name[] = { "cps8_solid", "cps6_solid" };
    for (int k = 0; k < 2; k++) {
        result r = open_result (name[k], -1);
        assert_int_equal (r.mesh.dim, 3);
        check_ok (pg_mesh_flatten (&r.mesh, r.n, r.field));
        assert_int_equal (r.mesh.dim, 2);
        assert_int_equal (r.mesh.kind[0], k ? PG_TRI6 : PG_QUAD8);
        assert_int_equal (r.mesh.n, k ? 8 : 4);
        assert_int_equal (r.mesh.nnode, k ? 25 : 21);
        check_relative (mesh_volume (&r.mesh), 4, 1e-13);
        check_patch (&r, 1, 1e-5);
        close_result (&r);
    }
    result r = open_result ("c3d8", -1);
    check_fails (pg_mesh_flatten (&r.mesh, r.n, r.field), PG_E_USAGE);
    check_contains (pg_last_error (), "the mesh is not one element thick");
    assert_int_equal (r.mesh.dim, 3);
    close_result (&r);
}

static void sets_stay_when_a_mesh_becomes_plane (void **state)
{
    (void) state;
    static const char *const text =
        "*NODE\n1,0,0,-1\n2,1,0,-1\n3,1,1,-1\n4,0,1,-1\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n*ELEMENT,TYPE="
        "C3D8,ELSET=A\n1,1,2,3,4,5,6,7,8\n"
        "*NSET,NSET=upper\n5,6\n*NSET,NSET=corner\n3\n*SURFACE,NAME=left\nA,S6\n*SURFACE,NAME=flat\nA,S2\n";
    pg_mesh m;
    check_ok (mesh_parse (&m, &(mesh_file) { "plate.inp", text, strlen (text) }));
    check_ok (pg_mesh_flatten (&m, 0, NULL));
    assert_string_equal (m.blocks[0].name, "A");
    assert_int_equal (m.nsides, 1);
    assert_string_equal (m.sides[0].name, "left");
    int node[9];
    pg_element_face (m.kind[0], m.sides[0].side[0], node);
    for (int k = 0; k < 2; k++) check_scaled (m.x[3 * m.node[node[k]]], 0, 1e-15, 1);
    for (size_t k = 0; k < m.nnodes; k++) {
        if (strcmp (m.nodes[k].name, "upper") == 0) assert_int_equal (m.nodes[k].n, 2);
        if (strcmp (m.nodes[k].name, "corner") == 0) assert_int_equal (m.node_id[m.nodes[k].node[0]], 3);
    }
    pg_mesh_clear (&m);
}

static pg_status parse (result *r, const char *text, size_t n)
{
    return mesh_parse_result (&r->mesh, &(mesh_file) { "job.frd", text, n }, -1, &r->n, &r->field, &r->time);
}

#define COUNT(key, n, format) \
    "    " key "                  " \
    "           " n "                                     " format "\n"
#define SHORT_NODES \
    COUNT ("2C", "3", "0") \
    " -1    1 0.00000E+00 0.00000E+00 0.00000E+00\n -1    2 2.00000E+00 0.00000E+00 0.00000E+00\n" \
    " -1    3-1.00000E+00 1.00000E+00 0.00000E+00\n -3\n"
#define SHORT_ELEMENT COUNT ("3C", "1", "0") " -1    7    7    0    2\n -2    1    2    3\n -3\n"
#define HEAD(n) \
    "  100CL  101 2.500000000           " n \
    "                     0    1           0\n -4  TEMP        2    1\n -5  T           1    1    0    0\n" \
    " -5  ALL         1    1    0    0    1ALL\n"

static void short_columns_are_read (void **state)
{
    (void) state;
    static const char *const text = "    1C\n" SHORT_NODES SHORT_ELEMENT HEAD (
        "3") " -1    1-1.00000E+00\n -1    2 2.00000E+00\n -1    3 3.00000E-01\n -3\n 9999\n";
    result r;
    check_ok (parse (&r, text, strlen (text)));
    check_relative (mesh_volume (&r.mesh), 1, 1e-15);
    check_relative (r.time, 2.5, 1e-15);
    assert_int_equal (r.n, 1);
    assert_string_equal (r.field[0].name, "TEMP");
    assert_int_equal (r.field[0].components, 1);
    check_relative (r.field[0].value[0], -1, 1e-15);
    check_relative (r.field[0].value[2], 0.3, 1e-15);
    close_result (&r);
}

static void wrong (const char *text, const char *why)
{
    result r;
    size_t used = pg_memory_used ();
    check_fails (parse (&r, text, strlen (text)), PG_E_FILE);
    check_contains (pg_last_error (), why);
    assert_int_equal (pg_memory_used (), used);
}

static void faults_name_their_line (void **state)
{
    (void) state;
    wrong ("    1C\n", "job.frd");
    wrong ("    1C\n    2C\n", "job.frd, line 2: no number of nodes");
    wrong ("    1C\n" COUNT ("2C", "3", "7"), "line 2: the format of the nodes is none of 0");
    wrong ("    1C\n" COUNT ("2C", "3", "0") " -1    1 0.00000E+00 x\n",
           "line 3: node 1: coordinate 2 is no number");
    wrong ("    1C\n" COUNT ("2C", "3", "0") " -1    1 0.00000E+00 0.00000E+00 0.00000E+00\n -3\n",
           "line 4: 1 nodes, but the block says 3");
    wrong ("    1C\n" COUNT ("2C", "9", "3") "short", "line 2: the file ends within node 1 of 9");
    wrong ("    1C\n" SHORT_NODES COUNT ("3C", "1", "0") " -1    7   13    0    2\n",
           "line 8: element 7 is of kind 13");
    wrong ("    1C\n" SHORT_NODES COUNT ("3C", "1", "0") " -1    7    7    0    2\n -2    1    2\n",
           "line 9: element 7 has 2 of 3 nodes");
    wrong ("    1C\n" SHORT_NODES COUNT ("3C", "1", "0") " -1    7    7    0    2\n -2    1    2    9\n -3\n",
           "line 8: element 7");
    wrong ("    1C\n" SHORT_NODES COUNT ("3C", "9", "2") "short", "the file ends within element 1 of 9");
    wrong ("    1C\n" SHORT_NODES SHORT_ELEMENT, "job.frd holds a mesh and no results at nodes");
    wrong ("    1C\n" SHORT_NODES SHORT_ELEMENT HEAD ("3") " -1    1-1.00000E+00\n",
           "the file ends within TEMP");
    wrong ("    1C\n" SHORT_NODES SHORT_ELEMENT HEAD ("1") " -1    1-1.00000E+00\n -3\n",
           "TEMP is given at 1 of 3 nodes");
    wrong ("    1C\n" SHORT_NODES SHORT_ELEMENT HEAD ("1") " -1    1 nan\n -3\n",
           "TEMP at node 1: value 1 is no number");
}

/* Cut anywhere, a file is a fault or a smaller file, never more. */
static void cut_files_are_faults (void **state)
{
    (void) state;
    static const char *const name[] = { "data/mesh/ccx/cps8_solid.frd", "data/mesh/ccx/c3d4.frd" };
    for (int k = 0; k < 2; k++) {
        mesh_file file;
        char *bytes;
        size_t used = pg_memory_used ();
        check_ok (mesh_load (&file, &bytes, name[k]));
        for (size_t n = 0; n < file.size; n += 37) {
            char *copy = pg_calloc (n + 1, 1);
            result r;
            memcpy (copy, file.text, n);
            pg_status status = parse (&r, copy, n);
            if (status == PG_OK) close_result (&r);
            else assert_int_equal (status, PG_E_FILE);
            pg_free (copy);
        }
        pg_free (bytes);
        assert_int_equal (pg_memory_used (), used);
    }
}

static void no_memory_is_a_fault_everywhere (void **state)
{
    (void) state;
    static const char *const text = "    1C\n" SHORT_NODES SHORT_ELEMENT HEAD (
        "3") " -1    1-1.00000E+00\n -1    2 2.00000E+00\n -1    3 3.00000E-01\n -3\n";
    result r;
    size_t before = pg_memory_calls ();
    check_ok (parse (&r, text, strlen (text)));
    size_t calls = pg_memory_calls () - before;
    close_result (&r);
    size_t used = pg_memory_used ();
    for (size_t k = 1; k <= calls; k++) {
        pg_memory_fail_at (k);
        check_fails (parse (&r, text, strlen (text)), PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    pg_memory_fail_at (0);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_solid_element_passes_the_patch_test),
        cmocka_unit_test (steps_are_chosen),
        cmocka_unit_test (plane_elements_made_solid_become_plane),
        cmocka_unit_test (sets_stay_when_a_mesh_becomes_plane),
        cmocka_unit_test (short_columns_are_read),
        cmocka_unit_test (faults_name_their_line),
        cmocka_unit_test (cut_files_are_faults),
        cmocka_unit_test (no_memory_is_a_fault_everywhere),
    };
    return cmocka_run_group_tests (tests, NULL, NULL);
}
