/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables read back: names with their units, quoted cells, missing values, rows that are too short or too
 * long. */
#include "check.h"
#include "sample.h"
#include <math.h>

static const char *write_text (const char *name, const char *text)
{
    const char *path = file_at (name);
    FILE *file = fopen (path, "w");
    assert_non_null (file);
    fputs (text, file);
    fclose (file);
    return path;
}

static void what_a_table_wrote_is_read (void **state)
{
    (void) state;
    static const char *const columns[] = { "time [s]", "load, \"top\" [N]", "step [1]" };
    const double row[2][3] = { { 0.1, 1.0 / 3, 1 }, { 0.2, NAN, 2 } };
    const char *path = file_at ("written.csv");
    pg_table *table;
    pg_csv csv;
    check_ok (pg_table_create (&table, path, 3, columns));
    for (int r = 0; r < 2; r++) check_ok (pg_table_row (table, row[r]));
    pg_table_close (&table);
    check_ok (pg_csv_read (&csv, path));
    assert_int_equal (csv.ncolumn, 3);
    assert_int_equal (csv.nrow, 2);
    for (int c = 0; c < 3; c++) assert_string_equal (csv.name[c], columns[c]);
    for (int k = 0; k < 6; k++) {
        double wanted = row[k / 3][k % 3];
        assert_true (isnan (wanted) ? isnan (csv.value[k]) : csv.value[k] == wanted);
    }
    pg_csv_clear (&csv);
}

static void columns_are_found_with_and_without_their_unit (void **state)
{
    (void) state;
    pg_csv csv;
    check_ok (pg_csv_read (&csv, write_text ("names.csv", "force_x [N],force [N],mark\n1,2,3\n")));
    assert_int_equal (pg_csv_column (&csv, "force"), 1);
    assert_int_equal (pg_csv_column (&csv, "force_x [N]"), 0);
    assert_int_equal (pg_csv_column (&csv, "mark"), 2);
    assert_int_equal (pg_csv_column (&csv, "forc"), -1);
    assert_int_equal (pg_csv_name ("force_x [N]"), 7);
    pg_csv_clear (&csv);
}

static void rows_need_not_be_whole (void **state)
{
    (void) state;
    pg_csv csv;
    const char *text = "a,b\r\n1,2\r\n3\n\n4,word,9\n\"5\",\"6\n7\"\n8,9";
    check_ok (pg_csv_read (&csv, write_text ("rows.csv", text)));
    assert_int_equal (csv.nrow, 5);
    assert_true (csv.value[1] == 2);                   /* the carriage return is no part of the cell */
    assert_true (csv.value[2] == 3 && isnan (csv.value[3]));
    assert_true (csv.value[4] == 4 && isnan (csv.value[5]));
    assert_true (csv.value[6] == 5 && csv.value[7] == 6);      /* a line end within quotes ends no row */
    assert_true (csv.value[8] == 8 && csv.value[9] == 9);      /* the last line end may be missing */
    pg_csv_clear (&csv);
}

static void what_cannot_be_read_is_named (void **state)
{
    (void) state;
    pg_csv csv;
    check_fails (pg_csv_read (&csv, file_at ("none.csv")), PG_E_FILE);
    check_contains (pg_last_error (), "none.csv");
    check_fails (pg_csv_read (&csv, write_text ("empty.csv", "")), PG_E_FILE);
    check_contains (pg_last_error (), "empty");
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (what_a_table_wrote_is_read),
        cmocka_unit_test (columns_are_found_with_and_without_their_unit),
        cmocka_unit_test (rows_need_not_be_whole),
        cmocka_unit_test (what_cannot_be_read_is_named),
    };
    return cmocka_run_group_tests_name ("io/output/csv", tests, NULL, remove_folder);
}
