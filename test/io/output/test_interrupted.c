/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables whose writes are interrupted by signals, or take a part of what was asked for: write of this program
 * stands before that of the C library. */
#include "check.h"
#include "sample.h"
#include <errno.h>
#include <sys/syscall.h>
#include <unistd.h>

long syscall (long number, ...);                      /* the C library shows it to no strict program */

static int interrupts, most = 1 << 20;

ssize_t write (int file, const void *data, size_t bytes)
{
    if (interrupts > 0) {
        interrupts--, errno = EINTR;
        return -1;
    }
    return syscall (SYS_write, file, data, bytes < (size_t) most ? bytes : (size_t) most);
}

static void rows_are_whole_whatever_interrupts (void **state)
{
    static const char *const columns[] = { "time [s]", "reaction [N]" };
    const char *path = file_at ("interrupted.csv");
    char text[200] = "";
    pg_table *t;
    (void) state;
    check_ok (pg_table_create (&t, path, 2, columns));
    interrupts = 2;
    check_ok (pg_table_row (t, (double[]) { 1, 2 }));
    assert_int_equal (interrupts, 0);
    most = 3;                                          /* and three bytes at a time */
    check_ok (pg_table_row (t, (double[]) { 3.25, 4 }));
    most = 1 << 20;
    pg_table_close (&t);
    FILE *file = fopen (path, "r");
    assert_non_null (file);
    assert_true (fread (text, 1, sizeof text - 1, file) > 0);
    fclose (file);
    assert_string_equal (text, "time [s],reaction [N]\n1,2\n3.25,4\n");
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (rows_are_whole_whatever_interrupts) };
    return cmocka_run_group_tests_name ("io/output/interrupted", tests, NULL, remove_folder);
}
