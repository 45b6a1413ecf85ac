/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables: numbers and texts come back exactly, a row is on the disk when the call returns, failures name the
 * file. */
#include "check.h"
#include "sample.h"
#include <signal.h>
#include <sys/resource.h>

static const char *const columns[] = { "time [s]", "load, \"top\" [N]", "reaction [N]" };

static size_t slurp (const char *path, char *text, size_t size)
{
    FILE *file = fopen (path, "r");
    assert_non_null (file);
    size_t n = fread (text, 1, size - 1, file);
    text[n] = 0;
    fclose (file);
    return n;
}

static void numbers_come_back_exactly (void **state)
{
    (void) state;
    const double value[][3] = { { 0.1, 1.0 / 3, -2e-308 },
                                { 5e-324, 1.7976931348623157e308, -0.0 },
                                { 123456789.123456789, 1e22, 7 } };
    const char *path = file_at ("numbers.csv");
    char text[1000], *s = text;
    pg_table *t;
    check_ok (pg_table_create (&t, path, 3, columns));
    for (int r = 0; r < 3; r++) check_ok (pg_table_row (t, value[r]));
    pg_table_close (&t);
    assert_null (t);
    slurp (path, text, sizeof text);
    s = strchr (s, '\n') + 1;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            double back = strtod (s, &s);
            assert_memory_equal (&back, &value[r][c], sizeof back);
            assert_int_equal (*s++, c < 2 ? ',' : '\n');
        }
    assert_int_equal (*s, 0);
}

static void a_row_is_on_disk_at_once (void **state)
{
    (void) state;
    const char *path = file_at ("flushed.csv");
    char text[1000];
    pg_table *t;
    check_ok (pg_table_create (&t, path, 2, columns));
    check_ok (pg_table_row (t, (double[]) { 1, 2 }));
    slurp (path, text, sizeof text);
    check_contains (text, "\n1,2\n");
    pg_table_close (&t);
}

static void texts_are_quoted_where_they_must_be (void **state)
{
    (void) state;
    const char *path = file_at ("texts.csv");
    char text[1000];
    pg_table *t;
    check_ok (pg_table_create (&t, path, 3, columns));
    check_ok (pg_table_line (t, (const char *const[]) { "plain", "a,b", NULL }));
    check_ok (pg_table_line (t, (const char *const[]) { "say \"x\"", "two\nlines", "" }));
    pg_table_close (&t);
    slurp (path, text, sizeof text);
    assert_string_equal (text, "time [s],\"load, \"\"top\"\" [N]\",reaction [N]\nplain,\"a,b\",\n\"say "
                               "\"\"x\"\"\",\"two\nlines\",\n");
}

/* Rows that wait are in the file when they are written, or when there are many of them; with others, and in
 * the same order. */
static void rows_that_wait_are_those_written_at_once (void **state)
{
    (void) state;
    static char at_once[200000], later[200000];
    char cell[30];
    pg_table *t;
    for (int wait = 0; wait < 2; wait++) {
        const char *path = file_at (wait ? "waiting.csv" : "at_once.csv");
        size_t n;
        check_ok (pg_table_create (&t, path, 2, columns));
        for (int k = 0; k < 5000; k++) {
            snprintf (cell, sizeof cell, "row, \"%d\"", k);
            const char *const row[] = { cell, k % 2 ? NULL : "x" };
            check_ok (wait ? pg_table_line_later (t, row) : pg_table_line (t, row));
            if (wait && k == 0) assert_int_equal (pg_table_rows (t), 0);
        }
        if (wait) assert_true (pg_table_rows (t) > 0 && pg_table_rows (t) < 5000);
        check_ok (pg_table_row (t, (double[]) { 1, 2 }));
        assert_int_equal (pg_table_rows (t), 5001);
        if (wait) check_ok (pg_table_line_later (t, (const char *const[]) { "last", NULL }));
        else check_ok (pg_table_line (t, (const char *const[]) { "last", NULL }));
        check_ok (pg_table_write (t));
        check_ok (pg_table_write (t));                 /* nothing waits any more */
        assert_int_equal (pg_table_rows (t), 5002);
        n = slurp (path, wait ? later : at_once, sizeof later);
        if (wait) assert_memory_equal (later, at_once, n + 1);
        pg_table_close (&t);
    }
}

static void a_folder_that_is_missing_is_named (void **state)
{
    (void) state;
    pg_table *t;
    check_fails (pg_table_create (&t, file_at ("missing/a.csv"), 3, columns), PG_E_FILE);
    assert_null (t);
    check_contains (pg_last_error (), "missing/a.csv: No such file");
}

static void a_full_disk_is_reported (void **state)
{
    (void) state;
    pg_table *t;
    check_fails (pg_table_create (&t, "/dev/full", 3, columns), PG_E_FILE);
    check_contains (pg_last_error (), "/dev/full: No space left");
}

static void a_row_that_does_not_fit_is_reported (void **state)
{
    (void) state;
    struct rlimit old, tight = { 0 };
    pg_table *t;
    pg_status status = PG_OK;
    signal (SIGXFSZ, SIG_IGN);
    check_ok (pg_table_create (&t, file_at ("limited.csv"), 3, columns));
    getrlimit (RLIMIT_FSIZE, &old);
    tight.rlim_cur = 200, tight.rlim_max = old.rlim_max;
    setrlimit (RLIMIT_FSIZE, &tight);
    for (int k = 0; k < 20 && status == PG_OK; k++) status = pg_table_row (t, (double[]) { 0.1, 0.2, 0.3 });
    setrlimit (RLIMIT_FSIZE, &old);
    assert_int_equal (status, PG_E_FILE);
    check_contains (pg_last_error (), "limited.csv: File too large");
    long rows = pg_table_rows (t);
    char text[1000];
    size_t n = slurp (file_at ("limited.csv"), text, sizeof text), lines = 0;
    for (size_t k = 0; k < n; k++) lines += text[k] == '\n';
    assert_true (rows > 0 && (long) lines == rows + 1 && text[n - 1] == '\n');     /* whole rows only */
    check_ok (pg_table_row (t, (double[]) { 4, 5, 6 }));                           /* there is room again */
    slurp (file_at ("limited.csv"), text, sizeof text);
    check_contains (text, "0.29999999999999999\n4,5,6\n");
    pg_table_close (&t);
}

/* Rows that wait reach the file together or not at all, and none of them counts. */
static void rows_that_wait_and_do_not_fit_are_dropped (void **state)
{
    (void) state;
    struct rlimit old, tight = { 0 };
    char text[1000];
    pg_table *t;
    const char *path = file_at ("dropped.csv");
    const char *const row[] = { "a", "b", "0123456789012345678901234567890123456789" };
    signal (SIGXFSZ, SIG_IGN);
    check_ok (pg_table_create (&t, path, 3, columns));
    check_ok (pg_table_row (t, (double[]) { 1, 2, 3 }));
    for (int k = 0; k < 6; k++) check_ok (pg_table_line_later (t, row));
    getrlimit (RLIMIT_FSIZE, &old);
    tight.rlim_cur = 200, tight.rlim_max = old.rlim_max;
    setrlimit (RLIMIT_FSIZE, &tight);
    pg_status status = pg_table_write (t);
    setrlimit (RLIMIT_FSIZE, &old);
    assert_int_equal (status, PG_E_FILE);
    assert_int_equal (pg_table_rows (t), 1);
    check_ok (pg_table_write (t));                     /* what failed does not come later */
    check_ok (pg_table_line (t, (const char *const[]) { "4", "5", "6" }));
    slurp (path, text, sizeof text);
    check_contains (text, "\n1,2,3\n4,5,6\n");
    pg_table_close (&t);
}

static void an_opened_table_goes_on_after_the_rows_kept (void **state)
{
    (void) state;
    const char *path = file_at ("goes_on.csv");
    static const char *const header[] = { "a", "two\nlines" }, *const others[] = { "a", "two lines" };
    char text[1000];
    pg_table *t;
    check_ok (pg_table_create (&t, path, 2, header));
    for (int k = 0; k < 4; k++)
        check_ok (pg_table_line (t, (const char *const[]){ k == 1 ? "x\ny" : "x", "\"" }));
    assert_int_equal (pg_table_rows (t), 4);
    pg_table_close (&t);
    FILE *file = fopen (path, "a");
    fputs ("x,half a ro", file);                       /* as a killed run may leave it */
    fclose (file);
    check_ok (pg_table_open (&t, path, 2, header, 2));
    assert_int_equal (pg_table_rows (t), 2);
    check_ok (pg_table_row (t, (double[]) { 1, 2 }));
    pg_table_close (&t);
    slurp (path, text, sizeof text);
    assert_string_equal (text, "a,\"two\nlines\"\nx,\"\"\"\"\n\"x\ny\",\"\"\"\"\n1,2\n");
    check_ok (pg_table_open (&t, path, 2, header, 0));
    pg_table_close (&t);
    slurp (path, text, sizeof text);
    assert_string_equal (text, "a,\"two\nlines\"\n");
    check_fails (pg_table_open (&t, path, 2, header, 1), PG_E_FILE);
    check_contains (pg_last_error (), "goes_on.csv has 0 rows of the 1");
    assert_null (t);
    check_fails (pg_table_open (&t, file_at ("absent.csv"), 2, header, 0), PG_E_FILE);
    /* other names, fewer and more columns: refused, the file as it was */
    check_fails (pg_table_open (&t, path, 2, others, 0), PG_E_FILE);
    check_contains (pg_last_error (), "the columns of");
    check_fails (pg_table_open (&t, path, 1, header, 0), PG_E_FILE);
    check_fails (pg_table_open (&t, path, 2, (const char *const[]) { "b", "two\nlines" }, 0), PG_E_FILE);
    check_fails (pg_table_open (&t, path, 3, (const char *const[]) { "a", "two\nlines", "c" }, 0), PG_E_FILE);
    assert_null (t);
    slurp (path, text, sizeof text);
    assert_string_equal (text, "a,\"two\nlines\"\n");
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    size_t before = pg_memory_used ();
    pg_table *t = NULL;
    pg_status status = PG_E_MEMORY;
    for (size_t k = 1; status != PG_OK && k < 10; k++) {
        pg_memory_fail_at (k);
        status = pg_table_create (&t, file_at ("sweep.csv"), 3, columns);
        pg_memory_fail_at (0);
        pg_table_close (&t);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_int_equal (status, PG_OK);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (numbers_come_back_exactly),
        cmocka_unit_test (a_row_is_on_disk_at_once),
        cmocka_unit_test (texts_are_quoted_where_they_must_be),
        cmocka_unit_test (rows_that_wait_are_those_written_at_once),
        cmocka_unit_test (rows_that_wait_and_do_not_fit_are_dropped),
        cmocka_unit_test (a_folder_that_is_missing_is_named),
        cmocka_unit_test (a_full_disk_is_reported),
        cmocka_unit_test (an_opened_table_goes_on_after_the_rows_kept),
        cmocka_unit_test (a_row_that_does_not_fit_is_reported),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/table", tests, NULL, remove_folder);
}
