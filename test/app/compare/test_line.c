/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables of places with values: units, missing values, faults with their line. */
#include "check.h"
#include "perigal.h"
#include <stdlib.h>
#include <unistd.h>

static char path[64];
static void write_file (const char *text)
{
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    fputs (text, f);
    fclose (f);
}

static const double origin[3] = { 0, 0.25, 0 };
static void columns_and_units (void **state)
{
    (void) state;
    pg_line l;
    write_file (
        "# centre line\nx [mm], note ,u_y [mm],s_xx [MPa],stress_xy [kPa]\r\n1,a,2,3,4\n\n2,b,,nan,5\n");
    check_ok (pg_line_read (&l, path, 2, 1, 2, origin));
    assert_int_equal (l.n, 2);
    assert_int_equal (l.ncolumn, 3);
    assert_true (l.column[0] == 1 && l.column[1] == 3 && l.column[2] == 6);
    check_relative (l.x[0], 1e-3, 1e-15);
    assert_true (l.x[1] == 0.25 && l.x[3] == 0.25);
    check_relative (l.value[0], 4e-3, 1e-15);
    check_relative (l.value[1], 6e6, 1e-15);
    check_relative (l.value[2], 8e3, 1e-15);
    assert_true (isnan (l.value[3]) && isnan (l.value[4]));
    check_relative (l.value[5], 1e4, 1e-15);
    pg_line_clear (&l);
    write_file ("x (mm),u_x (um),s_xx (MPa)\n1,2,3\n");
    check_ok (pg_line_read (&l, path, 1, 1, 1, origin));
    assert_int_equal (l.ncolumn, 2);
    check_relative (l.x[0], 1e-3, 1e-15);
    check_relative (l.value[0], 2e-6, 1e-15);
    check_relative (l.value[1], 3e6, 1e-15);
    pg_line_clear (&l);
    write_file ("x,u_x,s_xx\n1,2,3\n");
    check_ok (pg_line_read (&l, path, 1, 1e-3, 1, origin));
    check_relative (l.x[0], 1e-3, 1e-15);
    check_relative (l.value[0], 2e-3, 1e-15);
    assert_true (l.value[1] == 3);
    pg_line_clear (&l);
}

static void faults (void **state)
{
    (void) state;
    static const struct { const char *text, *message;
    } wrong[] = { { "", "has no rows" },
                  { "x,u_x\n", "has no rows" },
                  { "a,b\n1,2\n", ":1: no column x, y" },
                  { "x,y\n1,2\n", ":1: no column of values" },
                  { "x [s],u_x\n1,2\n", ":1: column x: 's' does not fit: expected m" },
                  { "x [mm,u_x\n1,2\n", "does not close" },
                  { "x,u_x [MPa]\n1,2\n", "column u_x: 'MPa' does not fit: expected m" },
                  { "x,u_x,u_x\n1,2,3\n", "two columns u_x" },
                  { "x,u_x\n1,2\n1,2,3\n", ":3: 3 columns, the first row names 2" },
                  { "x,u_x\n1,two\n", ":2: 'two' in column 2" },
                  { "x,u_x\n,2\n", ":2: the place has no x" },
                  { "x,u_z\n1,2\n", "no column of values" } };
    pg_line l;
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        write_file (wrong[k].text);
        check_fails (pg_line_read (&l, path, 2, 1, 1, origin), PG_E_FILE);
        check_contains (pg_last_error (), wrong[k].message);
        assert_null (l.x);
    }
    check_fails (pg_line_read (&l, "/nowhere/a.csv", 2, 1, 1, origin), PG_E_FILE);
    FILE *f = fopen (path, "w");
    fwrite ("x,u_x\0\n", 1, 7, f);
    fclose (f);
    check_fails (pg_line_read (&l, path, 2, 1, 1, origin), PG_E_FILE);
    check_contains (pg_last_error (), "not a text file");
    write_file ("x,u_x\n1,2\n3,4\n");
    for (size_t k = 1; k < 20; k++) {
        pg_memory_fail_at (k);
        pg_status got = pg_line_read (&l, path, 2, 1, 1, origin);
        pg_memory_fail_at (0);
        if (got == PG_OK) break;
        check_fails (got, PG_E_MEMORY);
    }
    pg_line_clear (&l);
}

static pg_status linear (void *context, size_t n, const double *x, double *u, double *stress)
{
    (void) context, (void) stress;
    memset (u, 0, 3 * n * sizeof *u);
    for (size_t i = 0; i < n; i++) u[3*i] = x[2*i] > 3.5 ? NAN : x[2*i];
    return PG_OK;
}

static void norms_of_a_column (void **state)
{
    (void) state;
    pg_line l;
    pg_line_norms n;
    write_file ("x,u_x\n1,1\n2,2.5\n3,\n4,4\n0.001,0.002\n-1,-1.5\n");
    check_ok (pg_line_read (&l, path, 2, 1, 1, origin));
    pg_sampler s = { NULL, 2, 3, 0, linear, NULL };
    check_ok (pg_line_measure (&n, &l, &s));
    assert_int_equal (n.rows, 4);
    assert_int_equal (n.missed, 2);
    check_relative (n.maximum.difference, 0.5, 1e-14);
    check_relative (n.maximum.relative, 0.125, 1e-14);
    check_relative (n.maximum.place[0], 2, 1e-14);
    check_relative (n.maximum.place[1], 0.25, 1e-14);
    check_relative (n.pointwise, 1.0 / 3, 1e-14);                      /* 0.002 is too small to count */
    check_relative (n.place[0], -1, 1e-14);
    check_relative (n.l2.relative, sqrt ((0.25 + 0.25 + 1e-6) / (1 + 6.25 + 4e-6 + 2.25)), 1e-12);
    s.dim = 3;
    check_fails (pg_line_measure (&n, &l, &s), PG_E_USAGE);
    pg_line_clear (&l);
}

/* A table relative to the displacement at x = 3: u - 3 is exact, u is not. */
static void relative_to_a_datum (void **state)
{
    (void) state;
    pg_line l;
    pg_line_norms n;
    write_file ("x,u_x\n1,-2\n2,-1\n0.5,-2.5\n");
    check_ok (pg_line_read (&l, path, 2, 1, 1, origin));
    pg_sampler s = { NULL, 2, 3, 0, linear, NULL };
    check_ok (pg_line_measure (&n, &l, &s));
    check_relative (n.maximum.difference, 3, 1e-14);
    l.relative = 1, l.datum[0] = 3;
    check_ok (pg_line_measure (&n, &l, &s));
    check_absolute (n.maximum.difference, 0, 1e-14);
    assert_int_equal (n.rows, 3);
    l.datum[0] = 4;                                                    /* unknown there: so is the rest */
    check_ok (pg_line_measure (&n, &l, &s));
    assert_int_equal (n.missed, 3);
    pg_line_clear (&l);
}

static int make (void **state)
{
    (void) state;
    strcpy (path, "/tmp/perigal_test_XXXXXX");
    int f = mkstemp (path);
    return f < 0 ? -1 : close (f);
}
static int drop (void **state) { (void) state; return unlink (path); }

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (columns_and_units), cmocka_unit_test (faults),
                                        cmocka_unit_test (norms_of_a_column),
                                        cmocka_unit_test (relative_to_a_datum) };
    return cmocka_run_group_tests (tests, make, drop);
}
