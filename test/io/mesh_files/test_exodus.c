/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exodus II: files written here through netCDF after its manual (SAND92-2137), every kind of element, sets,
 * numbers, results, faults. */
#include "check.h"
#include "geometry/mesh/measure.h"
#include "io/mesh_files/format.h"
#include "perigal/output.h"
#include <netcdf.h>
#include <stdlib.h>
#include <unistd.h>

#define NC(call) \
    do { \
        int rc_ = (call); \
        if (rc_ != NC_NOERR) print_error ("%s: %s\n", #call, nc_strerror (rc_)); \
        assert_int_equal (rc_, NC_NOERR); \
    } while (0)

/* Classic files are either defined or filled. */
#define DEFINE(call) do { nc_redef (nc); NC (call); } while (0)
#define PUT(call) do { nc_enddef (nc); NC (call); } while (0)

static char path[] = "/tmp/perigal_mesh_XXXXXX";

static int make_path (void **state)
{
    (void) state;
    int f = mkstemp (path);
    return f < 0 ? -1 : close (f);
}

static int drop_path (void **state)
{
    (void) state;
    return unlink (path);
}

static int dim_of (int nc, const char *name, size_t n)
{
    int d;
    DEFINE (nc_def_dim (nc, name, n, &d));
    return d;
}

static void put_ints (int nc, const char *name, int dim, const int *value)
{
    int var;
    DEFINE (nc_def_var (nc, name, NC_INT, 1, &dim, &var));
    PUT (nc_put_var_int (nc, var, value));
}

static void put_names (int nc, const char *name, size_t n, const char *const *text)
{
    int var, dims[2], width;
    char rows[32], label[64];
    size_t length;
    snprintf (label, sizeof label, "d_%s", name);
    dims[0] = dim_of (nc, label, n);
    if (nc_inq_dimid (nc, "len_name", &width) != NC_NOERR) width = dim_of (nc, "len_name", 33);
    dims[1] = width;
    NC (nc_inq_dimlen (nc, width, &length));
    DEFINE (nc_def_var (nc, name, NC_CHAR, 2, dims, &var));
    for (size_t k = 0; k < n; k++) {
        snprintf (rows, sizeof rows, "%s", text[k]);
        PUT (nc_put_vara_text (nc, var, (size_t[2]) { k, 0 }, (size_t[2]) { 1, strlen (rows) }, rows));
    }
}

typedef struct {
    const char *type;                                  /* NULL: the usual one */
    int  together;                                     /* `coord` of old files */
    int  maps, sets, results, short_of;                /* short_of: elements said, not there */
    int  bad_node, bad_side;
} options;

static void put_places (int nc, const pg_mesh *m, int nodes, const options *o)
{
    int var, dims[2] = { dim_of (nc, "num_dim", (size_t) m->dim), nodes };
    if (o->together) DEFINE (nc_def_var (nc, "coord", NC_DOUBLE, 2, dims, &var));
    for (int a = 0; a < m->dim; a++) {
        char name[8] = { 'c', 'o', 'o', 'r', 'd', "xyz"[a], 0 };
        if (!o->together) DEFINE (nc_def_var (nc, name, NC_DOUBLE, 1, &nodes, &var));
        for (size_t i = 0; i < m->nnode; i++)
            PUT (nc_put_var1_double (nc, var,
                                     o->together ? (size_t[2]){ (size_t) a, i } : (size_t[2]){ i, 0 },
                                     &m->x[3 * i + (size_t) a]));
    }
}

static void put_block (int nc, const pg_mesh *m, const options *o)
{
    const pg_element_type *type = &pg_element_types[m->kind[0]];
    const char *name = o->type ? o->type : type->name;
    int *node = pg_calloc (m->start[m->n], sizeof *node), var;
    int dims[2] = { dim_of (nc, "num_el_in_blk1", m->n),
                    dim_of (nc, "num_nod_per_el1", (size_t) type->nodes) };
    dim_of (nc, "num_el_blk", 1);
    for (size_t k = 0; k < m->start[m->n]; k++) node[k] = m->node[k] + 1;
    if (o->bad_node) node[0] = o->bad_node;
    DEFINE (nc_def_var (nc, "connect1", NC_INT, 2, dims, &var));
    DEFINE (nc_put_att_text (nc, var, "elem_type", strlen (name), name));
    PUT (nc_put_var_int (nc, var, node));
    put_names (nc, "eb_names", 1, (const char *[]) { "steel" });
    pg_free (node);
}

static void put_sets (int nc, const pg_mesh *m, const options *o)
{
    size_t n;
    int *element, *side, nodes[3] = { 1, 2, 3 };
    check_ok (pg_mesh_surface (m, &n, &element, &side));
    for (size_t k = 0; k < n; k++)
        element[k]++, side[k] += o->type && strcmp (o->type, "SHELL4") == 0 ? 3 : 1;
    if (o->bad_side) side[0] = o->bad_side;
    dim_of (nc, "num_side_sets", 1);
    int d = dim_of (nc, "num_side_ss1", n);
    put_ints (nc, "elem_ss1", d, element);
    put_ints (nc, "side_ss1", d, side);
    put_ints (nc, "ss_prop1", dim_of (nc, "d_ss", 1), (int[1]) { 77 });
    put_names (nc, "ss_names", 1, (const char *[]) { "boundary" });
    dim_of (nc, "num_node_sets", 2);
    put_ints (nc, "node_ns1", dim_of (nc, "num_nod_ns1", 3), nodes);
    put_ints (nc, "ns_prop1", dim_of (nc, "d_ns", 2), (int[2]) { 5, 6 });
    put_names (nc, "ns_names", 2, (const char *[]) { "three", "" });
    pg_free (element), pg_free (side);
}

static void put_maps (int nc, const pg_mesh *m, int nodes, int elements)
{
    int *id = pg_calloc (m->nnode + m->n, sizeof *id);
    for (size_t k = 0; k < m->nnode + m->n; k++) id[k] = 5000 - 3 * (int) k;
    put_ints (nc, "node_num_map", nodes, id);
    put_ints (nc, "elem_num_map", elements, id);
    pg_free (id);
}

/* Two steps; variable v at node i of step s: 1000 s + 100 v + i. */
static void put_results (int nc, const pg_mesh *m, int nodes)
{
    static const char *const name[] = { "temp", "disp_x", "disp_y", "sig_yy", "disp_z", "sig_xx", "sig_xy" };
    int var, time, dims[2];
    char text[32];
    DEFINE (nc_def_dim (nc, "time_step", NC_UNLIMITED, &dims[0]));
    dims[1] = nodes;
    dim_of (nc, "num_nod_var", 7);
    put_names (nc, "name_nod_var", 7, name);
    DEFINE (nc_def_var (nc, "time_whole", NC_DOUBLE, 1, dims, &time));
    for (size_t s = 0; s < 2; s++) PUT (nc_put_var1_double (nc, time, &s, &(double) { 0.5 * (double) s }));
    for (int v = 0; v < 7; v++) {
        snprintf (text, sizeof text, "vals_nod_var%d", v + 1);
        DEFINE (nc_def_var (nc, text, NC_DOUBLE, 2, dims, &var));
        for (size_t s = 0; s < 2; s++)
            for (size_t i = 0; i < m->nnode; i++)
                PUT (nc_put_var1_double (nc, var, (size_t[2]){ s, i },
                                         &(double){ 1000 * (double) s + 100 * v + (double) i }));
    }
}

static void write_exodus (const pg_mesh *m, int format, options o)
{
    int nc;
    NC (nc_create (path, NC_CLOBBER | format, &nc));
    int nodes = dim_of (nc, "num_nodes", m->nnode),
        elements = dim_of (nc, "num_elem", m->n + (size_t) o.short_of);
    put_places (nc, m, nodes, &o);
    put_block (nc, m, &o);
    if (o.sets) put_sets (nc, m, &o);
    if (o.maps) put_maps (nc, m, nodes, elements);
    if (o.results) put_results (nc, m, nodes);
    NC (nc_close (nc));
}

static void bend (double *x)
{
    double y = x[1];
    x[1] += 0.1 * x[0] * x[0];
    x[0] += 0.05 * y * x[2] + 0.1 * y * y;
}

static const pg_element solid[] = { PG_TRI3,  PG_TRI6,   PG_QUAD4,   PG_QUAD8, PG_QUAD9, PG_TET4,
                                    PG_TET10, PG_WEDGE6, PG_WEDGE15, PG_HEX8,  PG_HEX20, PG_HEX27,
                                    PG_PYRAMID5 };
static const int format[] = { 0, NC_64BIT_OFFSET, NC_64BIT_DATA, NC_NETCDF4 };

static void every_kind_is_read_back (void **state)
{
    (void) state;
    static const char *const other[PG_ELEMENTS] = { [PG_TRI3] = "TRIANGLE",
                                                    [PG_QUAD4] = "SHELL4",
                                                    [PG_TET10] = "TETRA10",
                                                    [PG_HEX8] = "HEX",
                                                    [PG_WEDGE6] = "WEDGE",
                                                    [PG_PYRAMID5] = "PYRAMID" };
    for (size_t k = 0; k < sizeof solid / sizeof *solid; k++)
        for (int f = 0; f < 4; f++) {
            pg_mesh a = block_mesh (solid[k], 2, bend), b;
            double in_a, in_b, area = surface_area (&a, &in_a);
            write_exodus (&a, format[f],
                          (options){ .type = f % 2 ? other[solid[k]] : NULL,
                                     .together = f == 1,
                                     .maps = f > 1,
                                     .sets = 1 });
            check_ok (pg_mesh_read (&b, path));
            assert_int_equal (b.dim, a.dim);
            assert_int_equal (b.n, a.n);
            assert_int_equal (b.nnode, a.nnode);
            assert_int_equal (b.kind[0], solid[k]);
            check_relative (mesh_volume (&b), mesh_volume (&a), 1e-14);
            assert_string_equal (b.blocks[0].name, "steel");
            assert_int_equal (b.nsides, 1);
            assert_string_equal (b.sides[0].name, "boundary");
            assert_int_equal (b.sides[0].id, 77);
            check_relative (sides_area (&b, b.sides[0].n, b.sides[0].element, b.sides[0].side, &in_b), area,
                            1e-14);
            check_relative (in_b, mesh_volume (&a), 1e-13);
            assert_string_equal (b.nodes[0].name, "three");
            assert_int_equal (b.nodes[0].n, 3);
            assert_int_equal (b.node_id[1], f > 1 ? 4997 : 2);
            assert_int_equal (b.element_id[1], f > 1 ? 4997 : 2);
            pg_mesh_clear (&a), pg_mesh_clear (&b);
        }
}

static void results_are_grouped_by_their_suffixes (void **state)
{
    (void) state;
    for (int plane = 0; plane < 2; plane++) {
        pg_mesh a = block_mesh (plane ? PG_TRI3 : PG_HEX8, 2, NULL), b;
        pg_mesh_field *f = NULL;
        size_t n;
        double time;
        write_exodus (&a, NC_64BIT_OFFSET, (options) { .maps = plane, .results = 1 });
        check_ok (pg_mesh_result (&b, path, -1, &n, &f, &time));
        assert_int_equal (n, 3);
        check_relative (time, 0.5, 1e-15);
        assert_string_equal (f[0].name, "temp");
        assert_string_equal (f[1].name, "disp");
        assert_string_equal (f[2].name, "sig");
        assert_int_equal (f[0].components, 1);
        assert_int_equal (f[1].components, b.dim);
        assert_int_equal (f[2].components, 6);
        for (size_t i = 0; i < b.nnode; i++) {
            check_relative (f[0].value[i], 1000 + (double) i, 1e-15);
            for (int c = 0; c < b.dim; c++)
                check_relative (f[1].value[i * (size_t) b.dim + (size_t) c],
                                1000 + (c < 2 ? 100 + 100 * c : 400) + (double) i, 1e-15);
            check_relative (f[2].value[6 * i + 1], 1300 + (double) i, 1e-15);
            check_relative (f[2].value[6 * i], 1500 + (double) i, 1e-15);
            check_relative (f[2].value[6 * i + 3], 1600 + (double) i, 1e-15);
            assert_true (f[2].value[6 * i + 2] == 0);
        }
        pg_mesh_fields_clear (n, &f), pg_mesh_clear (&b);
        check_ok (pg_mesh_result (&b, path, 0, &n, &f, NULL));
        check_relative (f[0].value[1], 1, 1e-15);
        pg_mesh_fields_clear (n, &f), pg_mesh_clear (&b);
        check_fails (pg_mesh_result (&b, path, 2, &n, &f, NULL), PG_E_USAGE);
        check_contains (pg_last_error (), "has no step 2; its steps are 0 to 1");
        pg_mesh_clear (&a);
    }
}

static void wrong (const pg_mesh *m, options o, const char *why)
{
    pg_mesh b;
    write_exodus (m, NC_64BIT_OFFSET, o);
    size_t used = pg_memory_used ();
    check_fails (pg_mesh_read (&b, path), PG_E_FILE);
    check_contains (pg_last_error (), path);
    check_contains (pg_last_error (), why);
    assert_int_equal (pg_memory_used (), used);
}

static void faults_say_what_is_wrong (void **state)
{
    (void) state;
    pg_mesh m = block_mesh (PG_QUAD4, 2, NULL), b;
    pg_mesh_field *f;
    size_t n;
    wrong (&m, (options){ .type = "PYRAMID" },
           "block 1 has elements 'PYRAMID' of 4 nodes; known are BAR, TRI");
    wrong (&m, (options) { .type = "TRI3" }, "elements 'TRI3' of 4 nodes");
    wrong (&m, (options) { .short_of = 3 }, "its blocks have 4 of the 7 elements of the file");
    wrong (&m, (options) { .bad_node = 999 }, "element 1");
    wrong (&m, (options) { .bad_node = -4, .maps = 1 }, "element 1");
    wrong (&m, (options) { .sets = 1, .bad_side = 9 }, "a side set has side 9 of element 1");
    wrong (&m, (options) { .sets = 1, .bad_side = 5 }, "has no side 5");
    write_exodus (&m, 0, (options) { .sets = 1 });
    check_fails (pg_mesh_result (&b, path, -1, &n, &f, NULL), PG_E_FILE);
    check_contains (pg_last_error (), "holds a mesh and no results at nodes");
    pg_mesh_clear (&m);
}

static void results_of_points_are_no_mesh (void **state)
{
    (void) state;
    double x[] = { 0, 0, 1, 0, 0, 1 }, volume[] = { 1, 1, 1 };
    pg_cloud cloud = { .dim = 2, .n = 3, .x = x, .volume = volume, .h = 1, .thickness = 1 };
    pg_exodus *e = NULL;
    pg_mesh m;
    check_ok (pg_exodus_create (&e, path, &cloud, "points", 0, NULL, NULL));
    pg_exodus_close (&e);
    check_fails (pg_mesh_read (&m, path), PG_E_FILE);
    check_contains (pg_last_error (), "points without elements");
}

static void cut_files_are_faults (void **state)
{
    (void) state;
    for (int f = 0; f < 4; f++) {
        pg_mesh a = block_mesh (PG_TRI3, 2, NULL), b;
        mesh_file file;
        char *bytes;
        write_exodus (&a, format[f], (options) { .sets = 1, .maps = 1 });
        check_ok (mesh_load (&file, &bytes, path));
        for (size_t n = 0; n < file.size; n += 41) {
            char *copy = pg_calloc (n + 1, 1);
            memcpy (copy, file.text, n);
            pg_status status = mesh_parse (&b, &(mesh_file) { path, copy, n });
            if (status == PG_OK) pg_mesh_clear (&b);
            else assert_int_equal (status, PG_E_FILE);
            pg_free (copy);
        }
        pg_free (bytes);
        pg_mesh_clear (&a);
    }
}

/* Any byte of the header changed: an answer, and no more memory than the file justifies. */
static void changed_headers_are_answered (void **state)
{
    (void) state;
    for (int f = 0; f < 3; f++) {
        pg_mesh a = block_mesh (PG_TRI3, 1, NULL), b;
        mesh_file file;
        char *bytes;
        write_exodus (&a, format[f], (options) { .sets = 1, .maps = 1 });
        check_ok (mesh_load (&file, &bytes, path));
        int broken = 0;
        for (size_t n = 0; n < file.size; n++) {
            char was = bytes[n];
            for (int k = 0; k < 3; k++) {
                bytes[n] = (char) (k == 0 ? was ^ 1 : k == 1 ? 0x7f : 0xff);
                pg_status status = mesh_parse (&b, &file);
                if (status == PG_OK) pg_mesh_clear (&b);
                else assert_int_equal (status, PG_E_FILE);
                if (status != PG_OK
                    && strstr (pg_last_error (), "the header of this netCDF file is broken near byte"))
                    broken++;
            }
            bytes[n] = was;
        }
        assert_true (broken > 500);
        pg_free (bytes);
        pg_mesh_clear (&a);
    }
}

static void no_memory_is_a_fault_everywhere (void **state)
{
    (void) state;
    pg_mesh a = block_mesh (PG_QUAD4, 1, NULL), b;
    pg_mesh_field *f;
    size_t n;
    write_exodus (&a, 0, (options) { .sets = 1, .maps = 1, .results = 1 });
    size_t before = pg_memory_calls ();
    check_ok (pg_mesh_result (&b, path, -1, &n, &f, NULL));
    size_t calls = pg_memory_calls () - before;
    pg_mesh_fields_clear (n, &f), pg_mesh_clear (&b);
    size_t used = pg_memory_used ();
    for (size_t k = 1; k <= calls; k++) {
        pg_memory_fail_at (k);
        check_fails (pg_mesh_result (&b, path, -1, &n, &f, NULL), PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    pg_memory_fail_at (0);
    pg_mesh_clear (&a);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_kind_is_read_back),
        cmocka_unit_test (results_are_grouped_by_their_suffixes),
        cmocka_unit_test (faults_say_what_is_wrong),
        cmocka_unit_test (results_of_points_are_no_mesh),
        cmocka_unit_test (cut_files_are_faults),
        cmocka_unit_test (changed_headers_are_answered),
        cmocka_unit_test (no_memory_is_a_fault_everywhere),
    };
    return cmocka_run_group_tests (tests, make_path, drop_path);
}
