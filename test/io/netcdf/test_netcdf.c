/* SPDX-License-Identifier: GPL-3.0-or-later
 * netCDF files: every kind and type that the netCDF library writes is read with the same values; files that
 * are cut or changed get an answer; what is written here the library reads, and `ncdump` where it is
 * installed. */
#include "check.h"
#include "io/output/netcdf_write.h"
#include "perigal/netcdf.h"
#include <math.h>
#include <netcdf.h>
#include <stdlib.h>
#include <unistd.h>

#define NC(call) assert_int_equal (call, NC_NOERR)

static char path[] = "/tmp/perigal_netcdf_XXXXXX";
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

/* Kinds of files; the number of types that each knows. */
static const struct { int flags, types; } kind[] = {
    { 0, 6 }, { NC_64BIT_OFFSET, 6 }, { NC_64BIT_DATA, 11 }, { NC_NETCDF4, 11 } };
enum { KINDS = sizeof kind / sizeof *kind, ROWS = 3, COLUMNS = 5, STEPS = 2 };

/* Value k of a type: small ones of both signs where the type has signs. */
static double value_of (int type, size_t k)
{
    double v = (double) (k % 7) * 11 - (type >= NC_UBYTE && type != NC_INT64 ? 0 : 30);
    return type == NC_FLOAT || type == NC_DOUBLE ? v + 0.25 : v;
}

/* A file with a fixed variable and one of records of every numeric type, a text, and attributes. */
static void write_file (int flags, int types, int records)
{
    int nc, row, column, step, dims[3], var, text;
    char name[24];
    double all[STEPS * ROWS * COLUMNS];
    NC (nc_create (path, NC_CLOBBER | flags, &nc));
    NC (nc_def_dim (nc, "step", NC_UNLIMITED, &step));
    NC (nc_def_dim (nc, "row", ROWS, &row));
    NC (nc_def_dim (nc, "column", COLUMNS, &column));
    dims[0] = step, dims[1] = row, dims[2] = column;
    for (int t = 1; t <= types; t++) {
        if (t == NC_CHAR) continue;
        snprintf (name, sizeof name, "fixed%d", t);
        NC (nc_def_var (nc, name, t, 2, dims + 1, &var));
        snprintf (name, sizeof name, "record%d", t);
        if (records) NC (nc_def_var (nc, name, t, 3, dims, &var));
    }
    NC (nc_def_var (nc, "text", NC_CHAR, 2, dims + 1, &text));
    NC (nc_put_att_text (nc, text, "title", 7, "letters"));
    NC (nc_put_att_double (nc, NC_GLOBAL, "numbers", NC_DOUBLE, 3, (double[3]) { 1.5, -2, 1e300 }));
    NC (nc_put_att_int (nc, NC_GLOBAL, "count", NC_INT, 1, (int[1]) { -17 }));
    NC (nc_enddef (nc));
    for (int t = 1; t <= types; t++) {
        if (t == NC_CHAR) continue;
        for (size_t k = 0; k < STEPS * ROWS * COLUMNS; k++) all[k] = value_of (t, k);
        snprintf (name, sizeof name, "fixed%d", t);
        NC (nc_inq_varid (nc, name, &var));
        NC (nc_put_var_double (nc, var, all));
        snprintf (name, sizeof name, "record%d", t);
        if (!records) continue;
        NC (nc_inq_varid (nc, name, &var));
        NC (nc_put_vara_double (nc, var, (size_t[3]) { 0 }, (size_t[3]) { STEPS, ROWS, COLUMNS }, all));
    }
    NC (nc_put_var_text (nc, text, "abcdefghijklmno"));
    NC (nc_close (nc));
}

/* One variable, whole and a row at a time, as doubles and as whole numbers. */
static void check_variable (const pg_netcdf *f, const char *name, int type, size_t n)
{
    double all[STEPS * ROWS * COLUMNS];
    long whole[STEPS * ROWS * COLUMNS];
    pg_netcdf_variable about;
    int var = pg_netcdf_find (f, name);
    assert_true (var >= 0);
    pg_netcdf_about (f, var, &about);
    assert_string_equal (about.name, name);
    assert_int_equal (about.type, type);
    assert_int_equal (about.n, n);
    assert_int_equal (about.last, COLUMNS);
    check_ok (pg_netcdf_doubles (f, var, 0, n, all));
    check_ok (pg_netcdf_longs (f, var, 0, n, whole));
    for (size_t k = 0; k < n; k++) {
        assert_true (all[k] == value_of (type, k));
        assert_int_equal (whole[k], (long) value_of (type, k));
    }
    for (size_t k = 0; k < n; k += COLUMNS) {
        check_ok (pg_netcdf_doubles (f, var, k + 1, COLUMNS - 1, all));
        for (size_t i = 0; i + 1 < COLUMNS; i++) assert_true (all[i] == value_of (type, k + 1 + i));
    }
    assert_int_equal (pg_netcdf_doubles (f, var, 1, n, all), PG_E_FILE);
    check_contains (pg_last_error (), name);
}

static void every_kind_and_type_is_read (void **state)
{
    (void) state;
    for (int k = 0; k < KINDS; k++) {
        pg_netcdf *f;
        char name[24], text[ROWS * COLUMNS + 1] = "";
        double numbers[3] = { 0 };
        write_file (kind[k].flags, kind[k].types, 1);
        check_ok (pg_netcdf_open (&f, path));
        assert_int_equal (pg_netcdf_length (f, "row"), ROWS);
        assert_int_equal (pg_netcdf_length (f, "step"), STEPS);
        assert_int_equal (pg_netcdf_length (f, "nothing"), 0);
        for (int t = 1; t <= kind[k].types; t++) {
            if (t == NC_CHAR) continue;
            snprintf (name, sizeof name, "fixed%d", t);
            check_variable (f, name, t, ROWS * COLUMNS);
            snprintf (name, sizeof name, "record%d", t);
            check_variable (f, name, t, STEPS * ROWS * COLUMNS);
        }
        int var = pg_netcdf_find (f, "text");
        check_ok (pg_netcdf_chars (f, var, 0, ROWS * COLUMNS, text));
        assert_string_equal (text, "abcdefghijklmno");
        assert_int_equal (pg_netcdf_doubles (f, var, 0, 1, numbers), PG_E_FILE);
        assert_int_equal (pg_netcdf_text (f, var, "title", text, 8), 1);
        assert_string_equal (text, "letters");
        assert_int_equal (pg_netcdf_text (f, var, "title", text, 7), 0);
        assert_int_equal (pg_netcdf_text (f, -1, "title", text, 8), 0);
        assert_int_equal (pg_netcdf_numbers (f, -1, "numbers", 2, numbers), 0);
        assert_int_equal (pg_netcdf_numbers (f, -1, "numbers", 3, numbers), 1);
        assert_true (numbers[0] == 1.5 && numbers[1] == -2 && numbers[2] == 1e300);
        assert_int_equal (pg_netcdf_numbers (f, -1, "count", 1, numbers), 1);
        assert_true (numbers[0] == -17);
        assert_int_equal (pg_netcdf_find (f, "nothing"), -1);
        pg_netcdf_close (&f);
        assert_null (f);
    }
}

/* The records of one variable of shorts alone lie side by side without padding. */
static void a_single_variable_of_records_is_not_padded (void **state)
{
    (void) state;
    int nc, step, var;
    long value[5];
    pg_netcdf *f;
    NC (nc_create (path, NC_CLOBBER, &nc));
    NC (nc_def_dim (nc, "step", NC_UNLIMITED, &step));
    NC (nc_def_var (nc, "alone", NC_SHORT, 1, &step, &var));
    NC (nc_enddef (nc));
    NC (nc_put_vara_int (nc, var, (size_t[1]) { 0 }, (size_t[1]) { 5 }, (int[5]) { 3, 1, 4, -1, 5 }));
    NC (nc_close (nc));
    check_ok (pg_netcdf_open (&f, path));
    check_ok (pg_netcdf_longs (f, 0, 0, 5, value));
    for (int k = 0; k < 5; k++) assert_int_equal (value[k], ((int[5]) { 3, 1, 4, -1, 5 })[k]);
    pg_netcdf_close (&f);
}

/* All values of a file, or the first fault. */
static pg_status read_all (const void *bytes, size_t size)
{
    pg_status status = PG_OK;
    pg_netcdf *f = NULL;
    double *value = NULL;
    PG_TRY (pg_netcdf_parse (&f, path, bytes, size));
    for (size_t k = 0; k < pg_netcdf_variables (f); k++) {
        pg_netcdf_variable about;
        pg_netcdf_about (f, (int) k, &about);
        if (about.type == PG_NC_CHAR) continue;
        PG_ALLOC (value, about.n);
        PG_TRY (pg_netcdf_doubles (f, (int) k, 0, about.n, value));
        pg_free (value), value = NULL;
    }
done:
    pg_free (value);
    pg_netcdf_close (&f);
    return status;
}

/* A file that ends early is a fault wherever it ends, at the latest when its values are read. */
static void cut_and_changed_files_are_answered (void **state)
{
    (void) state;
    for (int k = 0; k < KINDS - 1; k++) {
        write_file (kind[k].flags, kind[k].types, 1);
        FILE *file = fopen (path, "rb");
        unsigned char *bytes = pg_calloc (1 << 16, 1);
        size_t n = fread (bytes, 1, 1 << 16, file), broken = 0;
        fclose (file);
        check_ok (read_all (bytes, n));
        /* the last record ends with up to three bytes of padding */
        for (size_t m = 0; m + 3 < n; m++) {
            unsigned char *cut = pg_calloc (m + 1, 1);
            memcpy (cut, bytes, m);
            assert_int_equal (read_all (cut, m), PG_E_FILE);
            pg_free (cut);
        }
        for (size_t m = 0; m < n; m++) {
            unsigned char was = bytes[m];
            for (int how = 0; how < 3; how++) {
                bytes[m] = how == 0 ? was ^ 1 : how == 1 ? 0x7f : 0xff;
                pg_status status = read_all (bytes, n);
                assert_true (status == PG_OK || status == PG_E_FILE);
                broken += status != PG_OK;
            }
            bytes[m] = was;
        }
        assert_true (broken > 500);
        pg_free (bytes);
    }
}

static void what_is_no_netcdf_is_refused (void **state)
{
    (void) state;
    pg_netcdf *f;
    assert_int_equal (pg_netcdf_parse (&f, "that.e", "no such format", 14), PG_E_FILE);
    check_contains (pg_last_error (), "that.e: is no netCDF file");
    assert_int_equal (pg_netcdf_parse (&f, "that.e", "\x89HDF\r\n\x1a\nrubbish", 15), PG_E_FILE);
    check_contains (pg_last_error (), "that.e");
    assert_int_equal (pg_netcdf_open (&f, "/tmp"), PG_E_FILE);
    assert_int_equal (pg_netcdf_open (&f, "/nowhere/at/all"), PG_E_FILE);
    check_contains (pg_last_error (), "No such file");
    assert_null (f);
}

/* ---- writing ------------------------------------------------------------------------------------------- */
enum { MANY = 300001 };                                /* more than the buffer of the writer holds */

static pg_status write_own (int version, const double *x, const int *k, const long *wide)
{
    pg_status status = PG_OK;
    netcdf_writer *w = NULL;
    PG_TRY (netcdf_create (&w, path, version));
    int many = netcdf_define_dimension (w, "many", MANY), three = netcdf_define_dimension (w, "three", 3);
    int step = netcdf_define_dimension (w, "step", 0);
    netcdf_define_text (w, -1, "title", "written here");
    netcdf_define_text (w, -1, "empty", "");
    netcdf_define_numbers (w, -1, "place", PG_NC_DOUBLE, 3, x);
    int text = netcdf_define_variable (w, "text", PG_NC_CHAR, 2, (int[2]) { three, three });
    int real = netcdf_define_variable (w, "real", PG_NC_DOUBLE, 1, &many);
    netcdf_define_text (w, real, "units", "m");
    int after = netcdf_define_variable (w, "time", PG_NC_DOUBLE, 1, &step);
    int whole = netcdf_define_variable (w, "whole", PG_NC_INT, 1, &three);
    int large = version == 5 ? netcdf_define_variable (w, "wide", PG_NC_INT64, 1, &three) : -1;
    int bytes = netcdf_define_variable (w, "bytes", PG_NC_BYTE, 1, &three);
    PG_TRY (netcdf_end_header (w));
    if (netcdf_put (w, after, 0, 1, x) != PG_E_USAGE || netcdf_put (w, whole, 1, 3, k) != PG_E_USAGE)
        PG_FAIL (PG_E_USAGE, "values outside of a variable were taken");
    /* not in the order of the file, and in pieces */
    PG_TRY (netcdf_put (w, real, 0, 1000, x));
    if (large >= 0) PG_TRY (netcdf_put (w, large, 0, 3, wide));
    PG_TRY (netcdf_put (w, real, 1000, MANY - 1000, x + 1000));
    PG_TRY (netcdf_put (w, whole, 0, 3, k));
    for (size_t r = 0; r < 3; r++) PG_TRY (netcdf_put (w, text, 3 * r, 3, &"abcdefghi"[3 * r]));
    PG_TRY (netcdf_put (w, bytes, 0, 3, "\x01\xff\x03"));
    PG_TRY (netcdf_finish (&w));
done:
    netcdf_abandon (&w);
    return status;
}

/* What the library reads of such a file. */
static void check_by_library (int version, const double *x, const int *k, const long *wide)
{
    int nc, var, whole[3];
    long large[3];
    char text[16] = "";
    signed char bytes[3];
    size_t n;
    double *real = pg_calloc (MANY, sizeof *real);
    NC (nc_open (path, NC_NOWRITE, &nc));
    NC (nc_inq_varid (nc, "real", &var));
    NC (nc_get_var_double (nc, var, real));
    assert_memory_equal (real, x, MANY * sizeof *x);
    NC (nc_inq_varid (nc, "whole", &var));
    NC (nc_get_var_int (nc, var, whole));
    assert_memory_equal (whole, k, sizeof whole);
    NC (nc_inq_varid (nc, "text", &var));
    NC (nc_get_var_text (nc, var, text));
    assert_string_equal (text, "abcdefghi");
    NC (nc_inq_varid (nc, "bytes", &var));
    NC (nc_get_var_schar (nc, var, bytes));
    assert_true (bytes[0] == 1 && bytes[1] == -1 && bytes[2] == 3);
    if (version == 5) {
        NC (nc_inq_varid (nc, "wide", &var));
        NC (nc_get_var_long (nc, var, large));
        assert_memory_equal (large, wide, sizeof large);
    }
    NC (nc_inq_attlen (nc, NC_GLOBAL, "title", &n));
    assert_int_equal (n, 12);
    NC (nc_get_att_double (nc, NC_GLOBAL, "place", real));
    assert_memory_equal (real, x, 3 * sizeof *x);
    NC (nc_inq_dimid (nc, "step", &var));
    NC (nc_inq_dimlen (nc, var, &n));
    assert_int_equal (n, 0);
    NC (nc_close (nc));
    pg_free (real);
}

static void what_is_written_here_the_library_reads (void **state)
{
    (void) state;
    double *x = pg_calloc (MANY, sizeof *x);
    const int k[3] = { 1, -2, 2000000000 };
    const long wide[3] = { 1, -2, 9000000000000000000 };
    for (size_t i = 0; i < MANY; i++) x[i] = sqrt ((double) i) - 7;
    for (int version = 2; version <= 5; version += 3) {
        char line[200];
        check_ok (write_own (version, x, k, wide));
        check_by_library (version, x, k, wide);
        /* where ncdump is installed, it finds nothing to complain about either */
        snprintf (line, sizeof line,
                  "! command -v ncdump > /dev/null || ncdump -v whole,text %s "
                  "| grep -q 'whole = 1, -2, 2000000000'", path);
        assert_int_equal (system (line), 0);
    }
    pg_free (x);
}

static void definitions_that_make_no_sense_are_refused (void **state)
{
    (void) state;
    for (int fault = 0; fault < 5; fault++) {
        netcdf_writer *w;
        check_ok (netcdf_create (&w, path, 2));
        int a = netcdf_define_dimension (w, "a", 2);
        netcdf_define_variable (w, "v", PG_NC_INT, 1, &a);
        if (fault == 0) netcdf_define_variable (w, "v", PG_NC_INT, 1, &a);
        if (fault == 1) netcdf_define_dimension (w, "a", 3);
        if (fault == 2) netcdf_define_variable (w, "w", PG_NC_SHORT, 1, &a);
        if (fault == 3) netcdf_define_dimension (w, "", 3);
        if (fault == 4) netcdf_define_dimension (w, "long", (size_t) 1 << 32);
        /* what is defined behind a fault does no harm */
        netcdf_define_text (w, netcdf_define_variable (w, "after", PG_NC_INT, 1, &a), "units", "m");
        assert_int_equal (netcdf_end_header (w), fault == 4 ? PG_E_LIMIT : PG_E_USAGE);
        netcdf_abandon (&w);
        assert_null (w);
    }
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    double *x = pg_calloc (MANY, sizeof *x);
    const int whole[3] = { 1, 2, 3 };
    const long wide[3] = { 1, 2, 3 };
    size_t before = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status != PG_OK && k < 300; k++) {
        pg_memory_fail_at (k);
        status = write_own (5, x, whole, wide);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (status == PG_OK && k > 10);
    for (k = 1, status = PG_E_MEMORY; status != PG_OK && k < 300; k++) {
        pg_netcdf *f;
        pg_memory_fail_at (k);
        status = pg_netcdf_open (&f, path);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        pg_netcdf_close (&f);
        assert_int_equal (pg_memory_used (), before);
    }
    assert_true (status == PG_OK && k > 3);
    pg_free (x);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (every_kind_and_type_is_read),
        cmocka_unit_test (a_single_variable_of_records_is_not_padded),
        cmocka_unit_test (cut_and_changed_files_are_answered),
        cmocka_unit_test (what_is_no_netcdf_is_refused),
        cmocka_unit_test (what_is_written_here_the_library_reads),
        cmocka_unit_test (definitions_that_make_no_sense_are_refused),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests (tests, make_path, drop_path);
}
