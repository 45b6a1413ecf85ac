/* SPDX-License-Identifier: GPL-3.0-or-later
 * result.e: what is written comes back to the last bit, while the file is open and in the layout of Exodus; a
 * kill at any instant or a full disk costs nothing that was written before; a run that goes on appends where
 * it was told. */
#include "check.h"
#include "exodus_sample.h"
#include <netcdf.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

static void round_trip (int dim)
{
    sample s;
    const char *path = file_at ("round.e");
    begin (&s, dim);
    write_steps (&s, path, 3);
    for (int step = 0; step < 3; step++) {
        fill (&s, step);
        for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, step);
    }
    for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, -1);
    end (&s);
}
static void fields_come_back_exactly_in_1d (void **state) { (void) state; round_trip (1); }
static void fields_come_back_exactly_in_2d (void **state) { (void) state; round_trip (2); }
static void fields_come_back_exactly_in_3d (void **state) { (void) state; round_trip (3); }

static void points_come_back_exactly (void **state)
{
    (void) state;
    sample s;
    const char *path = file_at ("points.e");
    for (int dim = 1; dim <= 3; dim++) {
        pg_cloud c;
        size_t steps;
        double *time;
        begin (&s, dim);
        write_steps (&s, path, 2);
        check_ok (pg_exodus_points (path, &c, &steps, &time));
        assert_int_equal (c.dim, dim);
        assert_int_equal (c.n, s.cloud.n);
        assert_memory_equal (c.x, s.cloud.x, c.n * (size_t) dim * sizeof (double));
        assert_memory_equal (c.volume, s.cloud.volume, c.n * sizeof (double));
        assert_memory_equal (c.block, s.cloud.block, c.n * sizeof (int));
        assert_memory_equal (c.low, s.cloud.low, sizeof c.low);
        assert_memory_equal (c.high, s.cloud.high, sizeof c.high);
        assert_memory_equal (c.step, s.cloud.step, sizeof c.step);
        assert_true (c.h == s.cloud.h && c.thickness == s.cloud.thickness);
        assert_int_equal (steps, 2);
        assert_true (time[0] == 0 && time[1] == 0.1);
        pg_free (time);
        drop_cloud (&c);
        end (&s);
    }
}

static void points_come_back_before_the_first_step (void **state)
{
    (void) state;
    sample s;
    pg_cloud c;
    size_t steps, n;
    int m;
    double *value;
    const char *path = file_at ("empty.e");
    begin (&s, 2);
    write_steps (&s, path, 0);
    check_ok (pg_exodus_points (path, &c, &steps, NULL));
    assert_int_equal (steps, 0);
    assert_memory_equal (c.volume, s.cloud.volume, c.n * sizeof (double));
    check_fails (pg_exodus_read (path, "damage", -1, &n, &m, &value), PG_E_USAGE);
    assert_null (value);
    drop_cloud (&c);
    end (&s);
}

static void names_and_units_come_back (void **state)
{
    (void) state;
    sample s;
    char (*names)[32], unit[16];
    size_t n;
    const char *path = file_at ("names.e");
    begin (&s, 3);
    write_steps (&s, path, 1);
    check_ok (pg_exodus_fields (path, &names, &n));
    assert_int_equal (n, 4);
    assert_string_equal (names[0], "displacement");
    assert_string_equal (names[1], "stress");
    assert_string_equal (names[2], "damage");
    assert_string_equal (names[3], "volume");
    pg_free (names);
    check_ok (pg_exodus_unit (path, "stress", unit));
    assert_string_equal (unit, "Pa");
    check_ok (pg_exodus_unit (path, "damage", unit));
    assert_string_equal (unit, "");
    end (&s);
}

static void a_wrong_field_or_step_names_those_present (void **state)
{
    (void) state;
    sample s;
    size_t n;
    int m;
    double *value;
    const char *path = file_at ("wrong.e");
    begin (&s, 2);
    write_steps (&s, path, 2);
    check_fails (pg_exodus_read (path, "damge", -1, &n, &m, &value), PG_E_USAGE);
    check_contains (pg_last_error (), "did you mean 'damage'");
    check_contains (pg_last_error (), "displacement|stress|damage");
    check_fails (pg_exodus_read (path, "damage", 2, &n, &m, &value), PG_E_USAGE);
    check_contains (pg_last_error (), "0 to 1");
    end (&s);
}

static void name_row (int ncid, size_t k, char *name)
{
    int var;
    assert_int_equal (nc_inq_varid (ncid, "name_nod_var", &var), 0);
    assert_int_equal (nc_get_vara_text (ncid, var, (size_t[2]) { k, 0 }, (size_t[2]) { 1, 65 }, name), 0);
}

static size_t length_of (int ncid, const char *name)
{
    int dim;
    size_t n = 0;
    assert_int_equal (nc_inq_dimid (ncid, name, &dim), 0);
    nc_inq_dimlen (ncid, dim, &n);
    return n;
}

static void the_layout_is_that_of_exodus (void **state)
{
    (void) state;
    static const char *const expected[] = { "displacement_x", "displacement_y", "displacement_z", "stress_xx",
                                            "stress_yy",      "stress_zz",      "stress_xy",      "stress_yz",
                                            "stress_zx",      "damage",         "volume" };
    sample s;
    char name[66] = "", type[8] = "";
    int ncid, var, id[2], connect[64], kind;
    float version;
    const char *path = file_at ("layout.e");
    begin (&s, 3);
    write_steps (&s, path, 2);
    assert_int_equal (nc_open (path, NC_NOWRITE, &ncid), 0);
    assert_int_equal (length_of (ncid, "num_dim"), 3);
    assert_int_equal (length_of (ncid, "num_nodes"), 64);
    assert_int_equal (length_of (ncid, "num_elem"), 64);
    assert_int_equal (length_of (ncid, "num_el_blk"), 2);
    assert_int_equal (length_of (ncid, "time_step"), 2);
    assert_int_equal (length_of (ncid, "num_nod_var"), 11);
    assert_int_equal (length_of (ncid, "num_el_in_blk1") + length_of (ncid, "num_el_in_blk2"), 64);
    for (size_t k = 0; k < 11; k++) {
        name_row (ncid, k, name);
        assert_string_equal (name, expected[k]);
    }
    assert_int_equal (nc_get_att_float (ncid, NC_GLOBAL, "api_version", &version), 0);
    assert_int_equal (nc_inq_varid (ncid, "connect2", &var), 0);
    assert_int_equal (nc_get_att_text (ncid, var, "elem_type", type), 0);
    assert_string_equal (type, "SPHERE");
    nc_get_var_int (ncid, var, connect);
    assert_int_equal (connect[0], 2);                  /* point 1 is the first of block 4 */
    assert_int_equal (nc_inq_varid (ncid, "eb_prop1", &var), 0);
    nc_get_var_int (ncid, var, id);
    assert_true (id[0] == 1 && id[1] == 5);
    assert_int_equal (nc_inq_format (ncid, &kind), 0);
    assert_int_equal (kind, NC_FORMAT_64BIT_OFFSET);
    nc_close (ncid);
    end (&s);
}

/* A second program looks while the first still writes. */
static void an_open_file_is_readable_from_outside (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    char command[256];
    const char *path = file_at ("open.e");
    begin (&s, 2);
    check_ok (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL));
    for (int k = 0; k < 3; k++) {
        fill (&s, k);
        check_ok (pg_exodus_write (file, k, s.view));
        for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, k);
    }
    snprintf (command, sizeof command, "! command -v ncdump > /dev/null || ncdump -v time_whole %s "
              "| grep -q 'time_whole = 0, 1, 2'", path);
    assert_int_equal (system (command), 0);
    pg_exodus_close (&file);
    end (&s);
}

static void a_killed_writer_leaves_its_steps (void **state)
{
    (void) state;
    sample s;
    size_t steps;
    pg_cloud c;
    const char *path = file_at ("killed.e");
    begin (&s, 2);
    pid_t child = fork ();
    if (child == 0) {
        pg_exodus *file;
        if (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL) != PG_OK) _exit (1);
        for (int k = 0; k < 4; k++) {
            fill (&s, k);
            if (pg_exodus_write (file, k, s.view) != PG_OK) _exit (1);
        }
        raise (SIGKILL);
    }
    int how;
    waitpid (child, &how, 0);
    assert_true (WIFSIGNALED (how));
    check_ok (pg_exodus_points (path, &c, &steps, NULL));
    assert_int_equal (steps, 4);
    fill (&s, 3);
    check_field (&s, path, 1, -1);
    drop_cloud (&c);
    end (&s);
}

/* A child writes steps whose values are all their number until it is killed; what counts then is whole. */
static void no_instant_to_be_killed_at_is_bad (void **state)
{
    (void) state;
    sample s;
    pg_cloud c;
    size_t steps, n;
    int m, told[2];
    double *time, *value;
    const char *path = file_at ("any_instant.e");
    begin (&s, 2);
    for (int round = 0; round < 25; round++) {
        long least = round % 5;
        assert_int_equal (pipe (told), 0);
        pid_t child = fork ();
        if (child == 0) {
            pg_exodus *file;
            if (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL) != PG_OK) _exit (1);
            for (int k = 0;; k++) {
                for (int v = 0; v < FIELDS; v++)
                    for (size_t i = 0; i < s.cloud.n * (size_t) s.view[v].components; i++) s.value[v][i] = k;
                if (pg_exodus_write (file, k, s.view) != PG_OK || (k < 5 && write (told[1], "", 1) != 1))
                    _exit (1);
            }
        }
        kill_after (child, told, least, 137000 * round);
        if (least == 0 && access (path, F_OK) != 0) continue;
        check_ok (pg_exodus_points (path, &c, &steps, &time));
        assert_true ((long) steps >= least);
        for (size_t k = 0; k < steps; k++) assert_true (time[k] == (double) k);
        for (int v = 0; v < FIELDS && steps > 0; v++) {
            check_ok (pg_exodus_read (path, s.view[v].name, -1, &n, &m, &value));
            for (size_t i = 0; i < n * (size_t) m; i++) assert_true (value[i] == (double) (steps - 1));
            pg_free (value);
        }
        pg_free (time);
        drop_cloud (&c);
        remove (path);
    }
    end (&s);
}

static size_t steps_of (const char *path)
{
    pg_cloud c;
    size_t steps;
    check_ok (pg_exodus_points (path, &c, &steps, NULL));
    drop_cloud (&c);
    return steps;
}

static void a_step_that_does_not_fit_costs_no_other (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    struct rlimit old, tight;
    long steps, bytes, first;
    const char *path = file_at ("full.e");
    begin (&s, 2);
    signal (SIGXFSZ, SIG_IGN);
    getrlimit (RLIMIT_FSIZE, &old);
    check_ok (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL));
    pg_exodus_size (file, &steps, &first);
    for (int k = 0; k < 2; k++) {
        fill (&s, k);
        check_ok (pg_exodus_write (file, k, s.view));
    }
    pg_exodus_size (file, &steps, &bytes);
    for (long room = 0; room < (bytes - first) / 2; room += 1 + (bytes - first) / 16) {
        tight = (struct rlimit) { (rlim_t) (bytes + room), old.rlim_max };
        setrlimit (RLIMIT_FSIZE, &tight);
        fill (&s, 2);
        pg_status status = pg_exodus_write (file, 2, s.view);
        setrlimit (RLIMIT_FSIZE, &old);
        assert_int_equal (status, PG_E_FILE);
        check_contains (pg_last_error (), "full.e: File too large");
        assert_int_equal (steps_of (path), 2);
        fill (&s, 1);
        for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, -1);
    }
    fill (&s, 2);
    check_ok (pg_exodus_write (file, 2, s.view));      /* there is room again */
    assert_int_equal (steps_of (path), 3);
    for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, 2);
    pg_exodus_close (&file);
    end (&s);
}

static void an_opened_file_goes_on_where_it_is_told (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    long steps = 0, bytes = 0;
    size_t n;
    double *time;
    pg_cloud c;
    const char *path = file_at ("goes_on.e");
    begin (&s, 3);
    check_ok (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL));
    for (int k = 0; k < 5; k++) {
        fill (&s, k);
        check_ok (pg_exodus_write (file, k, s.view));
        if (k == 2) pg_exodus_size (file, &steps, &bytes);
    }
    pg_exodus_close (&file);
    assert_int_equal (steps, 3);
    check_ok (pg_exodus_open (&file, path, &s.cloud, FIELDS, s.view, steps, bytes));
    assert_int_equal (steps_of (path), 3);
    fill (&s, 7);
    check_ok (pg_exodus_write (file, 7, s.view));
    pg_exodus_close (&file);
    check_ok (pg_exodus_points (path, &c, &n, &time));
    assert_int_equal (n, 4);
    assert_true (time[2] == 2 && time[3] == 7);
    for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, 3);
    fill (&s, 1);
    for (int v = 0; v < FIELDS; v++) check_field (&s, path, v, 1);
    pg_free (time);
    drop_cloud (&c);
    end (&s);
}

static void a_file_of_another_run_is_not_gone_on_with (void **state)
{
    (void) state;
    sample s, other;
    pg_exodus *file = NULL;
    long steps, bytes;
    const char *path = file_at ("another.e");
    begin (&s, 2), begin (&other, 3);
    check_ok (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL));
    fill (&s, 0);
    check_ok (pg_exodus_write (file, 0, s.view));
    pg_exodus_size (file, &steps, &bytes);
    pg_exodus_close (&file);
    check_fails (pg_exodus_open (&file, path, &other.cloud, FIELDS, other.view, steps, bytes), PG_E_FILE);
    check_fails (pg_exodus_open (&file, path, &s.cloud, FIELDS - 1, s.view, steps, bytes), PG_E_FILE);
    check_fails (pg_exodus_open (&file, path, &s.cloud, FIELDS, s.view, steps, bytes + 1), PG_E_FILE);
    check_contains (pg_last_error (), "another.e has");
    check_fails (pg_exodus_open (&file, file_at ("absent.e"), &s.cloud, FIELDS, s.view, steps, bytes),
                 PG_E_FILE);
    assert_null (file);
    assert_int_equal (steps_of (path), 1);
    end (&s), end (&other);
}

static void many_steps_append (void **state)
{
    (void) state;
    sample s;
    size_t steps;
    double *time;
    pg_cloud c;
    const char *path = file_at ("many.e");
    begin (&s, 2);
    write_steps (&s, path, 200);
    check_ok (pg_exodus_points (path, &c, &steps, &time));
    assert_int_equal (steps, 200);
    for (int k = 0; k < 200; k++) assert_true (time[k] == 0.1 * k);
    fill (&s, 137);
    check_field (&s, path, 0, 137);
    pg_free (time);
    drop_cloud (&c);
    end (&s);
}

static void nan_comes_back (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    const char *path = file_at ("nan.e");
    begin (&s, 2);
    fill (&s, 0);
    s.value[2][5] = NAN, s.value[2][6] = -INFINITY;
    check_ok (pg_exodus_create (&file, path, &s.cloud, NULL, FIELDS, s.view, NULL));
    check_ok (pg_exodus_write (file, 0, s.view));
    pg_exodus_close (&file);
    check_field (&s, path, 2, 0);
    end (&s);
}

static void a_path_that_cannot_be_written_is_named (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    const char *path = file_at ("missing/result.e");
    begin (&s, 2);
    check_fails (pg_exodus_create (&file, path, &s.cloud, "", FIELDS, s.view, NULL), PG_E_FILE);
    assert_null (file);
    check_contains (pg_last_error (), path);
    check_contains (pg_last_error (), "No such file");
    end (&s);
}

static void other_fields_than_announced_are_refused (void **state)
{
    (void) state;
    sample s;
    pg_exodus *file;
    begin (&s, 2);
    check_ok (pg_exodus_create (&file, file_at ("other.e"), &s.cloud, "", FIELDS, s.view, NULL));
    strcpy (s.view[1].name, "strain");
    check_fails (pg_exodus_write (file, 0, s.view), PG_E_USAGE);
    pg_exodus_close (&file);
    s.view[1] = s.view[0];
    check_fails (pg_exodus_create (&file, file_at ("twice.e"), &s.cloud, "", FIELDS, s.view, NULL),
                 PG_E_USAGE);
    end (&s);
}

static void what_is_no_result_is_refused (void **state)
{
    (void) state;
    pg_cloud c;
    size_t n;
    const char *path = file_at ("text.e");
    FILE *file = fopen (path, "w");
    fputs ("not a result\n", file);
    fclose (file);
    check_fails (pg_exodus_points (path, &c, &n, NULL), PG_E_FILE);
    check_contains (pg_last_error (), path);
    check_fails (pg_exodus_points (file_at ("absent.e"), &c, &n, NULL), PG_E_FILE);
    check_contains (pg_last_error (), "No such file");
}

static pg_status whole_life (sample *s, const char *path)
{
    pg_status status = PG_OK;
    pg_exodus *file = NULL;
    pg_cloud c = { 0 };
    size_t n;
    int m;
    double *value = NULL, *time = NULL;
    char (*names)[32] = NULL;
    long steps, bytes;
    PG_TRY (pg_exodus_create (&file, path, &s->cloud, "", FIELDS, s->view, NULL));
    PG_TRY (pg_exodus_write (file, 1, s->view));
    pg_exodus_size (file, &steps, &bytes);
    pg_exodus_close (&file);
    PG_TRY (pg_exodus_open (&file, path, &s->cloud, FIELDS, s->view, steps, bytes));
    PG_TRY (pg_exodus_write (file, 2, s->view));
    pg_exodus_close (&file);
    PG_TRY (pg_exodus_points (path, &c, &n, &time));
    PG_TRY (pg_exodus_read (path, "stress", -1, &n, &m, &value));
    PG_TRY (pg_exodus_fields (path, &names, &n));
done:
    pg_exodus_close (&file);
    drop_cloud (&c);
    pg_free (names);
    pg_free (value);
    pg_free (time);
    return status;
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    sample s;
    const char *path = file_at ("sweep.e");
    begin (&s, 3);
    fill (&s, 0);
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status != PG_OK && k < 1000; k++) {
        pg_memory_fail_at (k);
        status = whole_life (&s, path);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (status == PG_OK && k > 10);
    end (&s);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (fields_come_back_exactly_in_1d),
        cmocka_unit_test (fields_come_back_exactly_in_2d),
        cmocka_unit_test (fields_come_back_exactly_in_3d),
        cmocka_unit_test (points_come_back_exactly),
        cmocka_unit_test (points_come_back_before_the_first_step),
        cmocka_unit_test (names_and_units_come_back),
        cmocka_unit_test (a_wrong_field_or_step_names_those_present),
        cmocka_unit_test (the_layout_is_that_of_exodus),
        cmocka_unit_test (an_open_file_is_readable_from_outside),
        cmocka_unit_test (a_killed_writer_leaves_its_steps),
        cmocka_unit_test (no_instant_to_be_killed_at_is_bad),
        cmocka_unit_test (a_step_that_does_not_fit_costs_no_other),
        cmocka_unit_test (an_opened_file_goes_on_where_it_is_told),
        cmocka_unit_test (a_file_of_another_run_is_not_gone_on_with),
        cmocka_unit_test (many_steps_append),
        cmocka_unit_test (nan_comes_back),
        cmocka_unit_test (a_path_that_cannot_be_written_is_named),
        cmocka_unit_test (other_fields_than_announced_are_refused),
        cmocka_unit_test (what_is_no_result_is_refused),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/exodus", tests, NULL, remove_folder);
}
