/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pieces of cracks in result.e: a block of elements BAR2 (in space TRI3) behind the points, as readers of
 * Exodus expect it; the points and their fields come back as before. */
#include "check.h"
#include "exodus_sample.h"
#include <netcdf.h>
#include <signal.h>
#include <sys/resource.h>

static double one_of (int ncid, const char *name, size_t i, size_t k)
{
    int var;
    double value = NAN;
    assert_int_equal (nc_inq_varid (ncid, name, &var), NC_NOERR);
    assert_int_equal (nc_get_var1_double (ncid, var, (size_t[2]) { i, k }, &value), NC_NOERR);
    return value;
}

static size_t size_of (int ncid, const char *name)
{
    int dim;
    size_t n = 0;
    assert_int_equal (nc_inq_dimid (ncid, name, &dim), NC_NOERR);
    assert_int_equal (nc_inq_dimlen (ncid, dim, &n), NC_NOERR);
    return n;
}

/* What ParaView's reader of Exodus goes by: sizes, a block of BAR2 or TRI3 with nodes of its own, nodal
 * values for all nodes, an element variable that the truth table gives to that block alone. */
static void check_lines (const sample *s, const char *path, size_t n, const pg_crack_face *line)
{
    int ncid, var;
    char type[8] = "", name[64];
    size_t points = s->cloud.n, dim = (size_t) s->cloud.dim;
    assert_int_equal (nc_open (path, NC_NOWRITE, &ncid), NC_NOERR);
    assert_int_equal (size_of (ncid, "num_nodes"), points + dim * n);
    assert_int_equal (size_of (ncid, "num_elem"), points + n);
    assert_int_equal (size_of (ncid, "num_el_blk"), 3);
    assert_int_equal (size_of (ncid, "num_el_in_blk3"), n);
    assert_int_equal (size_of (ncid, "num_nod_per_el3"), dim);
    assert_int_equal (size_of (ncid, "time_step"), 3);
    assert_int_equal (nc_inq_varid (ncid, "connect3", &var), NC_NOERR);
    assert_int_equal (nc_get_att_text (ncid, var, "elem_type", type), NC_NOERR);
    assert_memory_equal (type, dim == 3 ? "TRI3" : "BAR2", 4);
    assert_true (one_of (ncid, "eb_prop1", 2, 0) > one_of (ncid, "eb_prop1", 1, 0));
    for (size_t k = 0; k < 3; k++) assert_true (one_of (ncid, "elem_var_tab", k, 0) == (k == 2));
    for (size_t i = 0; i < dim * n; i++) {
        assert_true (one_of (ncid, "connect3", i / dim, i % dim) == (double) (points + i + 1));
        for (size_t a = 0; a < dim; a++) {
            snprintf (name, sizeof name, "coord%c", "xyz"[a]);
            assert_true (one_of (ncid, name, points + i, 0) == line[i / dim].x[i % dim][a]);
        }
        for (size_t step = 0; step < 3; step++) {
            for (int v = 1; v <= 3; v++) {
                snprintf (name, sizeof name, "vals_nod_var%d", v);
                assert_true (one_of (ncid, name, step, points + i)
                             == one_of (ncid, name, step, line[i / dim].point[i % dim]));
            }
            assert_true (one_of (ncid, "vals_elem_var1eb3", step, i / dim)
                         == (0.1 * (double) step >= line[i / dim].since));
        }
        assert_true (one_of (ncid, "point_volume", points + i, 0) == 0);
    }
    assert_int_equal (nc_close (ncid), NC_NOERR);
}

static void lines_come_behind_the_points (void **state)
{
    (void) state;
    for (int dim = 2; dim <= 3; dim++) {
        sample s;
        pg_exodus *file;
        pg_cloud back;
        const char *path = file_at ("lines.e");
        const pg_crack_face line[3] = {
            { { { 1, 2, 3 }, { 4, 5, 6 }, { 2, 2, 2 } }, { 0, 7, 5 }, 0 },
            { { { 4, 5, 6 }, { 7, 8, 9 } }, { 7, 3 }, 0.1 },
            { { { 0.1, 0.2, 0.3 }, { 1e-9, 0, -1 } }, { 48, 1 }, 0.15 },
        };
        begin (&s, dim);
        check_ok (pg_exodus_create (&file, path, &s.cloud, "a test", FIELDS, s.view, NULL));
        for (int k = 0; k < 2; k++) {
            fill (&s, k);
            check_ok (pg_exodus_write (file, 0.1 * k, s.view));
        }
        check_ok (pg_exodus_prepare_pieces (file, &s.cloud, "a test", 0, NULL));
        check_ok (pg_exodus_commit_pieces (path));       /* none: the file stays as it is */
        const pg_crack_face wrong = { .point = { 0, s.cloud.n } };
        check_fails (pg_exodus_prepare_pieces (file, &s.cloud, "a test", 1, &wrong), PG_E_USAGE);
        /* a copy that never takes the place of the file leaves it open for more steps */
        check_ok (pg_exodus_prepare_pieces (file, &s.cloud, "a test", 2, line));
        pg_exodus_drop_pieces (path);
        check_ok (pg_exodus_commit_pieces (path));
        fill (&s, 2);
        check_ok (pg_exodus_write (file, 0.2, s.view));
        check_ok (pg_exodus_prepare_pieces (file, &s.cloud, "a test", 3, line));
        pg_exodus_close (&file);
        check_ok (pg_exodus_commit_pieces (path));
        check_lines (&s, path, 3, line);
        for (int step = 0; step < 3; step++) {
            fill (&s, step);
            for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, step);
        }
        size_t steps;
        double *time;
        check_ok (pg_exodus_points (path, &back, &steps, &time));
        assert_int_equal (back.n, s.cloud.n);
        assert_int_equal (steps, 3);
        assert_memory_equal (back.x, s.cloud.x, back.n * (size_t) dim * sizeof (double));
        assert_memory_equal (back.volume, s.cloud.volume, back.n * sizeof (double));
        assert_memory_equal (back.block, s.cloud.block, back.n * sizeof (int));
        /* what a run would append to is another file */
        check_fails (pg_exodus_open (&file, path, &s.cloud, FIELDS, s.view, 1, 100000), PG_E_FILE);
        pg_free (time), drop_cloud (&back), end (&s);
    }
}

/* The disk is full while the lines are added: the file stays as it was. */
static void lines_on_a_full_disk_leave_the_file (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    struct rlimit old;
    const char *path = file_at ("full_lines.e");
    char fresh[200];
    begin (&s, 2);
    signal (SIGXFSZ, SIG_IGN);
    getrlimit (RLIMIT_FSIZE, &old);
    for (rlim_t limit = 500; limit < 8000; limit += 1500) {
        check_ok (pg_exodus_create (&file, path, &s.cloud, "a test", FIELDS, s.view, NULL));
        fill (&s, 0);
        check_ok (pg_exodus_write (file, 0, s.view));
        setrlimit (RLIMIT_FSIZE, &(struct rlimit) { limit, old.rlim_max });
        const pg_crack_face none = { .since = 0 };
        pg_status status = pg_exodus_prepare_pieces (file, &s.cloud, "a test", 1, &none);
        setrlimit (RLIMIT_FSIZE, &old);
        assert_int_equal (status, PG_E_FILE);
        check_field (&s, path, 0, 0);
        snprintf (fresh, sizeof fresh, "%s.new", path);
        assert_int_equal (access (fresh, F_OK), -1);
        pg_exodus_close (&file);
    }
    end (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (lines_come_behind_the_points),
        cmocka_unit_test (lines_on_a_full_disk_leave_the_file),
    };
    return cmocka_run_group_tests_name ("io/output/exodus_lines", tests, NULL, remove_folder);
}
