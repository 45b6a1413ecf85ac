/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields as files of VTK: read back here, they have the numbers of result.e of the same run, faces of cracks
 * too; a run that is stopped and goes on, or meets a full disk, leaves the bytes of one that nobody
 * disturbed; nothing of an earlier run stays. */
#include "again.h"
#include <netcdf.h>
#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

/* The scene with another format; to be freed with pg_free. */
static char *with_format (const char *text, const char *format)
{
    const char *at = strstr (text, "output: {") + strlen ("output: {");
    char *out = pg_calloc (strlen (text) + 64, 1);
    sprintf (out, "%.*sformat: %s, %s", (int) (at - text), text, format, at);
    return out;
}

/* ---- a reader ------------------------------------------------------------------------------------------ */
/* A file of a moment: its text, and what stands behind the XML. */
typedef struct { char *text; const char *data; } grid;

static grid open_grid (const char *folder, const char *name)
{
    static const char mark[] = "<AppendedData encoding=\"raw\">\n_";
    grid g = { .text = slurp (inside (folder, name)) };
    g.data = strstr (g.text, mark);
    assert_non_null (g.data);
    g.data += strlen (mark);
    check_contains (g.text, "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\" "
                            "header_type=\"UInt64\">");
    return g;
}

/* The values of the array whose element follows this text; *bytes: how many. */
static const void *array_at (const grid *g, const char *text, size_t *bytes)
{
    const char *at = strstr (g->text, text), *offset = at ? strstr (at, "offset=\"") : NULL;
    if (!offset) print_error ("no '%s'\n", text);
    assert_non_null (offset);
    at = g->data + strtoul (offset + 8, NULL, 10);
    memcpy (bytes, at, 8);
    return at + 8;
}

/* n rows of numbers, the first m of which are those of the field, the others 0. */
static void same_numbers (const grid *g, const char *name, size_t n, size_t m, const double *value)
{
    char text[80];
    size_t bytes, wide;
    snprintf (text, sizeof text, name[0] ? "Name=\"%s\"" : "<Points>", name);
    const double *found = array_at (g, text, &bytes);
    wide = bytes / (8 * n);
    assert_int_equal (bytes, 8 * n * wide);
    assert_int_equal (wide, m == 2 || !name[0] ? 3 : m);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < wide; k++) {
            double a, b = k < m ? value[i * m + k] : 0;
            memcpy (&a, found + i * wide + k, sizeof a);
            if (a != b) print_error ("%s: row %zu, %zu: %g, not %g\n", name, i, k, a, b);
            assert_true (a == b);
        }
}

/* Cells of `each` points that follow one another, of that kind. */
static void cells_are (const grid *g, size_t n, size_t each, int kind)
{
    size_t bytes;
    int64_t number;
    const char *connected = array_at (g, "Name=\"connectivity\"", &bytes);
    assert_int_equal (bytes, 8 * n * each);
    for (size_t i = 0; i < n * each; i++) {
        memcpy (&number, connected + 8 * i, 8);
        assert_int_equal (number, i);
    }
    const char *ends = array_at (g, "Name=\"offsets\"", &bytes);
    assert_int_equal (bytes, 8 * n);
    for (size_t i = 0; i < n; i++) {
        memcpy (&number, ends + 8 * i, 8);
        assert_int_equal (number, each * (i + 1));
    }
    const char *kinds = array_at (g, "Name=\"types\"", &bytes);
    assert_int_equal (bytes, n);
    for (size_t i = 0; i < n; i++) assert_int_equal (kinds[i], kind);
    assert_string_equal (kinds + n, "\n</AppendedData>\n</VTKFile>\n");
}

/* ---- beside result.e ----------------------------------------------------------------------------------- */
/* Values of a variable of the open result.e at a step, of nodes from `first` on. */
static void nodes_of (int ncid, const char *name, size_t step, size_t first, size_t n, double *value)
{
    int var;
    assert_int_equal (nc_inq_varid (ncid, name, &var), NC_NOERR);
    assert_int_equal (nc_get_vara_double (ncid, var, (size_t[2]) { step, first }, (size_t[2]) { 1, n },
                                          value), NC_NOERR);
}

/* The faces of a moment: places, fields, and which exist, as the block of cracks of result.e has them. */
static void same_faces (int ncid, const char *folder, size_t step, size_t n, size_t dim, size_t m)
{
    char name[64];
    int id;
    size_t nodes, faces;
    assert_int_equal (nc_inq_dimid (ncid, "num_nodes", &id), NC_NOERR);
    assert_int_equal (nc_inq_dimlen (ncid, id, &nodes), NC_NOERR);
    nodes -= n, faces = nodes / dim;
    assert_true (faces > 4 && faces * dim == nodes);
    double *x = pg_calloc (nodes * dim, sizeof *x), *one = pg_calloc (nodes, sizeof *one),
           *u = pg_calloc (nodes * dim, sizeof *u);
    snprintf (name, sizeof name, "result.%04zu.cracks.vtu", step);
    grid g = open_grid (folder, name);
    for (size_t k = 0; k < dim; k++) {
        int var;
        snprintf (name, sizeof name, "coord%c", "xyz"[k]);
        assert_int_equal (nc_inq_varid (ncid, name, &var), NC_NOERR);
        assert_int_equal (nc_get_vara_double (ncid, var, &n, &nodes, one), NC_NOERR);
        for (size_t i = 0; i < nodes; i++) x[i * dim + k] = one[i];
        snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
        nodes_of (ncid, name, step, n, nodes, one);
        for (size_t i = 0; i < nodes; i++) u[i * dim + k] = one[i];
    }
    same_numbers (&g, "", nodes, dim, x);
    same_numbers (&g, "displacement", nodes, dim, u);
    snprintf (name, sizeof name, "vals_nod_var%zu", m);
    nodes_of (ncid, name, step, n, nodes, one);
    same_numbers (&g, "damage", nodes, 1, one);
    nodes_of (ncid, "vals_elem_var1eb2", step, 0, faces, u);
    for (size_t i = 0; i < nodes; i++) one[i] = u[i / dim];
    same_numbers (&g, "exists", nodes, 1, one);
    cells_are (&g, faces, dim, dim == 2 ? 3 : 5);
    pg_free (g.text), pg_free (x), pg_free (one), pg_free (u);
}

static void as_in_exodus (const char *text, int cracks)
{
    char exodus[64], vtk[64], name[64], line[200];
    char *other = with_format (text, "vtk"), *path;
    pg_cloud cloud;
    size_t steps, n, nfield;
    double *time, *value, *block;
    char (*field)[32];
    int ncid, components;
    make_folder (exodus), make_folder (vtk);
    assert_int_equal (stop_at (text, exodus, 0), 0);
    assert_int_equal (stop_at (other, vtk, 0), 0);
    path = pg_strdup (inside (exodus, "result.e"));
    check_ok (pg_exodus_points (path, &cloud, &steps, &time));
    check_ok (pg_exodus_fields (path, &field, &nfield));
    assert_int_equal (nc_open (path, NC_NOWRITE, &ncid), NC_NOERR);
    char *list = slurp (inside (vtk, "result.pvd"));
    assert_int_equal (count_lines (list), 5 + steps * (1 + (size_t) cracks));
    block = pg_calloc (cloud.n, sizeof *block);
    for (size_t i = 0; i < cloud.n; i++) block[i] = cloud.block[i];
    assert_true (steps > 1 && nfield >= 4);
    for (size_t k = 0; k < steps; k++) {
        snprintf (name, sizeof name, "result.%04zu.vtu", k);
        snprintf (line, sizeof line, "<DataSet timestep=\"%.17g\" part=\"0\" file=\"%s\"/>\n", time[k], name);
        check_contains (list, line);
        grid g = open_grid (vtk, name);
        snprintf (line, sizeof line, "format=\"ascii\">%.17g<", time[k]);
        check_contains (g.text, line);
        same_numbers (&g, "", cloud.n, (size_t) cloud.dim, cloud.x);
        for (size_t v = 0; v < nfield; v++) {
            check_ok (pg_exodus_read (path, field[v], (int) k, &n, &components, &value));
            same_numbers (&g, field[v], n, (size_t) components, value);
            pg_free (value);
        }
        same_numbers (&g, "block", cloud.n, 1, block);
        cells_are (&g, cloud.n, 1, 1);
        pg_free (g.text);
        snprintf (line, sizeof line, "part=\"1\" file=\"result.%04zu.cracks.vtu\"/>\n", k);
        assert_true ((strstr (list, line) != NULL) == cracks);
        if (cracks) same_faces (ncid, vtk, k, cloud.n, (size_t) cloud.dim, (size_t) cloud.dim + 1);
    }
    nc_close (ncid);
    pg_free (list), pg_free (time), pg_free (field), pg_free (block), pg_free (path), pg_free (other);
    pg_cloud_clear (&cloud);
    remove_folder (exodus), remove_folder (vtk);
}

#define SOLID \
    "dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [6, 3, 4]}}}]\nspacing: 1\n" \
    "cracks: [{polygon: [[-1, -1, 2.1], [3, -1, 2.1], [3, 6, 1.9], [-1, 6, 1.9]]}]\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nfailure: {criterion: " \
    "energy_release, fracture_energy: 400 J/m2}\n" \
    "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: " \
    "{x: 2 mm, z: 10 mm}}]\nsolver: {stepping: event, max_events: 2}\n" \
    "output: {pictures: [], at: {levels: 3, events: 1}}\n"
#define TWO_ROCKS \
    "dimension: 2\nbody: [{add: {box: {low: [0, 0], high: [0.6, 0.5]}}}]\nspacing: 0.1\nmaterials: {a: " \
    "{youngs_modulus: 1 GPa, poissons_ratio: 0.2}, b: {youngs_modulus: 2 GPa, poissons_ratio: 0.2}}\n" \
    "blocks: [{material: a, where: x == x}, {material: b, where: y > 0.2}]\n" PULL \
    "solver: {stepping: fixed, steps: 3}\noutput: {pictures: [], fields: [displacement, damage, stress, " \
    "nodal_force], at: {levels: 3}}\n"

#define CRACKED \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.9]}}}]\nspacing: 0.1\n" \
    "cracks: [{from: [-0.1, 0.46], to: [0.43, 0.43]}]\nmaterials: {rock: {youngs_modulus: 1 GPa, " \
    "poissons_ratio: 0.2}}\nfailure: {fracture_energy: 400 J/m2}\n" PULL \
    "solver: {stepping: event, max_events: 5}\noutput: {pictures: [], at: {levels: 4, events: 2}}\n"

static void numbers_are_those_of_exodus (void **state)
{
    (void) state;
    as_in_exodus (TWO_ROCKS, 0);
    as_in_exodus (CRACKED, 1);
    as_in_exodus (SOLID, 1);
}

/* ---- going on ------------------------------------------------------------------------------------------ */
static void go_on (const char *text, const char *where)
{
    run r;
    visit v;
    pg_resumed from;
    check_ok (resume (text, where, &r, &v, &from));
    assert_int_equal (go (&r, &v), 0);
    pg_result_free (&v.result);
    clear (&r);
}

/* Stages within steps, and cracks, which get their faces once. */
static void a_stopped_run_goes_on_to_the_same_bytes (void **state)
{
    (void) state;
    const char *const of[] = { scenes[1].text, CRACKED };
    for (size_t s = 0; s < 2; s++) {
        char *text = with_format (of[s], "vtk"), plain[64], where[64];
        long looks;
        make_folder (plain), make_folder (where);
        assert_int_equal (stop_after (text, plain, 0, &looks), 0);
        for (long k = 1; k < looks; k += 2 + looks / 2) {
            assert_int_equal (stop_at (text, where, k), 1);
            go_on (text, where);
            same_fields (plain, where);
        }
        pg_free (text);
        remove_folder (plain), remove_folder (where);
    }
}

/* What the checkpoint counts on must be there; a folder that is refused stays as it was. */
static void what_is_missing_is_named (void **state)
{
    (void) state;
    char *text = with_format (TWO_ROCKS, "vtk"), plain[64], where[64], command[300];
    const char *const lost[] = { "result.0000.vtu", "result.pvd" };
    make_folder (plain), make_folder (where);
    assert_int_equal (stop_at (text, plain, 0), 0);
    assert_int_equal (stop_at (text, where, -2), 1);
    for (int k = 0; k < 2; k++) {
        run r;
        visit v;
        pg_resumed from;
        snprintf (command, sizeof command, "mv %s/%s %s/aside", where, lost[k], where);
        assert_int_equal (system (command), 0);
        check_fails (resume (text, where, &r, &v, &from), PG_E_FILE);
        check_contains (pg_last_error (), "No such file or directory");
        check_contains (pg_last_error (), "/result.");
        clear (&r);
        snprintf (command, sizeof command, "mv %s/aside %s/%s", where, where, lost[k]);
        assert_int_equal (system (command), 0);
    }
    go_on (text, where);
    same_fields (plain, where);
    assert_int_equal (stop_at (text, where, -2), 1);
    assert_int_equal (truncate (inside (where, "result.pvd"), 200), 0);
    run r;
    visit v;
    pg_resumed from;
    check_fails (resume (text, where, &r, &v, &from), PG_E_FILE);
    check_contains (pg_last_error (), "/result.pvd has 200 bytes, ");
    clear (&r);
    pg_free (text);
    remove_folder (plain), remove_folder (where);
}

/* A moment for which there is no room is told by its path and not there; with room the run goes on to the
 * same files. */
static void a_full_disk_is_told (void **state)
{
    (void) state;
    char *text = with_format (TWO_ROCKS, "vtk"), plain[64], where[64];
    struct rlimit old, tight;
    make_folder (plain), make_folder (where);
    assert_int_equal (stop_at (text, plain, 0), 0);
    signal (SIGXFSZ, SIG_IGN);
    run r = prepare (1, text);
    visit v = { 0 };
    check_ok (pg_result_open (&v.result, where, r.scene, r.problem, r.solver));
    getrlimit (RLIMIT_FSIZE, &old);
    for (int k = 0; k < 2; k++) {
        tight = (struct rlimit) { k ? 4096 : RLIM_INFINITY, old.rlim_max };
        check_ok (pg_solver_step (r.solver, r.state, &r.step));
        setrlimit (RLIMIT_FSIZE, &tight);
        pg_status status = pg_result_step (v.result, r.state, &r.step);
        setrlimit (RLIMIT_FSIZE, &old);
        if (!k) check_ok (status);
        else check_fails (status, PG_E_FILE);
    }
    check_contains (pg_last_error (), "/result.0001.vtu: File too large");
    assert_int_equal (size_of (inside (where, "result.0001.vtu")), -1);
    assert_int_equal (size_of (inside (where, "result.0001.vtu.new")), -1);
    char *list = slurp (inside (where, "result.pvd"));
    assert_int_equal (count_lines (list), 6);
    pg_free (list);
    check_ok (pg_result_checkpoint (v.result, r.state));
    pg_result_free (&v.result);
    clear (&r);
    go_on (text, where);
    same_fields (plain, where);
    /* the list: a folder stands in its place */
    assert_int_equal (remove (inside (where, "result.pvd")) | mkdir (inside (where, "result.pvd"), 0777), 0);
    r = prepare (1, text);
    check_fails (pg_result_open (&v.result, where, r.scene, r.problem, r.solver), PG_E_FILE);
    check_contains (pg_last_error (), "/result.pvd: Is a directory");
    clear (&r);
    pg_free (text);
    remove_folder (plain), remove_folder (where);
}

/* Another format, and fewer moments than before. */
static void an_earlier_run_leaves_nothing (void **state)
{
    (void) state;
    char *vtk = with_format (scenes[1].text, "vtk"), *few = with_format (TWO_ROCKS, "vtk"), plain[64],
         where[64];
    make_folder (plain), make_folder (where);
    assert_int_equal (stop_at (few, plain, 0), 0);
    assert_int_equal (stop_at (TWO_ROCKS, where, 0), 0);
    assert_int_equal (stop_at (vtk, where, 0), 0);
    assert_int_equal (size_of (inside (where, "result.e")), -1);
    assert_true (size_of (inside (where, "result.0004.vtu")) > 0);
    fclose (fopen (inside (where, "result.0007.cracks.vtu"), "w"));
    fclose (fopen (inside (where, "resulting.0007.vtu"), "w"));
    assert_int_equal (stop_at (few, where, 0), 0);
    assert_int_equal (remove (inside (where, "resulting.0007.vtu")), 0);       /* not ours */
    same_fields (plain, where);
    assert_int_equal (stop_at (scenes[1].text, where, 0), 0);
    assert_true (size_of (inside (where, "result.e")) > 0);
    assert_int_equal (size_of (inside (where, "result.pvd")), -1);
    assert_int_equal (size_of (inside (where, "result.0000.vtu")), -1);
    pg_free (vtk), pg_free (few);
    remove_folder (plain), remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (numbers_are_those_of_exodus),
        cmocka_unit_test (a_stopped_run_goes_on_to_the_same_bytes),
        cmocka_unit_test (what_is_missing_is_named),
        cmocka_unit_test (a_full_disk_is_told),
        cmocka_unit_test (an_earlier_run_leaves_nothing),
    };
    return cmocka_run_group_tests_name ("app/results/vtk", tests, NULL, NULL);
}
