/* SPDX-License-Identifier: GPL-3.0-or-later
 * checkpoint.nc: what a walk writes comes back bit by bit; at any instant there is the old file or the whole
 * new one; what is missing, of another length or cut off is refused by name. */
#include "check.h"
#include "sample.h"
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>

typedef struct {
    double number[5];
    long   count[3];
    char   text[7];
    size_t n;                                          /* of the numbers */
    const char *name;                                  /* of the counts */
    pg_status answer;
} thing;

static pg_status walk (void *context, const pg_keeper *k)
{
    pg_status status = PG_OK;
    thing *t = context;
    PG_TRY (k->numbers (k->context, "a.number", t->n, t->number));
    PG_TRY (k->counts (k->context, t->name, 3, t->count));
    PG_TRY (k->bytes (k->context, "nothing", 0, t->text));
    PG_TRY (k->bytes (k->context, "a.text", sizeof t->text, t->text));
    status = t->answer;
done:
    return status;
}

static thing sample_thing (void)
{
    return (thing){ { 1.0 / 3, -0.0, NAN, INFINITY, 5e-324 },
                    { -1, 0, 0x7ffffffffffffff1 },
                    "a\0b\xff",
                    5,
                    "a.count",
                    PG_OK };
}

static void all_comes_back (void **state)
{
    (void) state;
    thing a = sample_thing (), b = { .n = 5, .name = "a.count" };
    const char *path = file_at ("all.nc");
    check_ok (pg_checkpoint_write (path, walk, &a));
    assert_int_equal (access (file_at ("all.nc.new"), F_OK), -1);
    check_ok (pg_checkpoint_read (path, walk, &b));
    assert_memory_equal (a.number, b.number, sizeof a.number);
    assert_memory_equal (a.count, b.count, sizeof a.count);
    assert_memory_equal (a.text, b.text, sizeof a.text);
}

static void what_does_not_fit_is_named (void **state)
{
    (void) state;
    thing a = sample_thing (), b = a;
    const char *path = file_at ("misfit.nc");
    check_ok (pg_checkpoint_write (path, walk, &a));
    b.n = 4;
    check_fails (pg_checkpoint_read (path, walk, &b), PG_E_FILE);
    check_contains (pg_last_error (), "misfit.nc: 'a.number' has 5 values, not 4");
    b.n = 5, b.name = "another";
    check_fails (pg_checkpoint_read (path, walk, &b), PG_E_FILE);
    check_contains (pg_last_error (), "misfit.nc lacks 'another'");
    b.name = "a.text";
    check_fails (pg_checkpoint_read (path, walk, &b), PG_E_FILE);
    check_fails (pg_checkpoint_read (file_at ("absent.nc"), walk, &b), PG_E_FILE);
    check_contains (pg_last_error (), "absent.nc: No such file");
}

static void a_name_used_twice_is_a_misuse (void **state)
{
    (void) state;
    thing a = sample_thing ();
    a.name = "a.number";
    check_fails (pg_checkpoint_write (file_at ("twice.nc"), walk, &a), PG_E_USAGE);
    check_contains (pg_last_error (), "a.number");
    assert_int_equal (access (file_at ("twice.nc"), F_OK), -1);
}

static void a_walk_that_fails_leaves_the_old_file (void **state)
{
    (void) state;
    thing a = sample_thing (), b = { .n = 5, .name = "a.count" };
    const char *path = file_at ("old.nc");
    check_ok (pg_checkpoint_write (path, walk, &a));
    a.count[0] = 7, a.answer = pg_error (PG_E_MEMORY, PG_HERE, "a test");
    check_fails (pg_checkpoint_write (path, walk, &a), PG_E_MEMORY);
    assert_int_equal (access (file_at ("old.nc.new"), F_OK), -1);
    check_ok (pg_checkpoint_read (path, walk, &b));
    assert_int_equal (b.count[0], -1);
}

static long bytes_of (const char *path)
{
    FILE *file = fopen (path, "r");
    assert_non_null (file);
    fseek (file, 0, SEEK_END);
    long bytes = ftell (file);
    fclose (file);
    return bytes;
}

static void a_full_disk_leaves_the_old_file (void **state)
{
    (void) state;
    thing a = sample_thing (), b = { .n = 5, .name = "a.count" };
    struct rlimit old, tight;
    char path[160], fresh[160];                        /* file_at has four buffers */
    strcpy (path, file_at ("full.nc")), strcpy (fresh, file_at ("full.nc.new"));
    signal (SIGXFSZ, SIG_IGN);
    getrlimit (RLIMIT_FSIZE, &old);
    check_ok (pg_checkpoint_write (path, walk, &a));
    a.count[0] = 7;
    for (rlim_t room = 0; (long) room < bytes_of (path); room += 61) {
        tight = (struct rlimit) { room, old.rlim_max };
        setrlimit (RLIMIT_FSIZE, &tight);
        pg_status status = pg_checkpoint_write (path, walk, &a);
        setrlimit (RLIMIT_FSIZE, &old);
        assert_int_equal (status, PG_E_FILE);
        check_contains (pg_last_error (), "File too large");
        assert_int_equal (access (fresh, F_OK), -1);
        check_ok (pg_checkpoint_read (path, walk, &b));
        assert_int_equal (b.count[0], -1);
    }
}

static void a_file_cut_off_is_refused (void **state)
{
    (void) state;
    thing a = sample_thing (), b = { .n = 5, .name = "a.count" };
    const char *path = file_at ("cut.nc");
    check_ok (pg_checkpoint_write (path, walk, &a));
    long bytes = bytes_of (path);
    for (long keep = bytes - 1; keep > 0; keep -= 1 + bytes / 37) {
        assert_int_equal (truncate (path, keep), 0);
        check_fails (pg_checkpoint_read (path, walk, &b), PG_E_FILE);
        check_contains (pg_last_error (), path);
    }
}

/* Any bit of any value, name or length: the sum tells, or the head of the file does. */
static void a_changed_byte_is_refused (void **state)
{
    (void) state;
    thing a = sample_thing (), b = { .n = 5, .name = "a.count" };
    const char *path = file_at ("changed.nc");
    size_t padding = 0;
    check_ok (pg_checkpoint_write (path, walk, &a));
    long bytes = bytes_of (path);
    for (long at = 0; at < bytes; at += 3) {
        FILE *file = fopen (path, "r+b");
        assert_non_null (file);
        assert_int_equal (fseek (file, at, SEEK_SET), 0);
        int was = fgetc (file);
        assert_true (fseek (file, at, SEEK_SET) == 0 && fputc (was ^ (1 << at % 8), file) >= 0);
        assert_int_equal (fclose (file), 0);
        b = (thing) { .n = 5, .name = "a.count" };
        pg_status status = pg_checkpoint_read (path, walk, &b);
        if (status == PG_OK) {  /* only what fills up to whole words, and nothing comes back wrong */
            padding++;
            assert_memory_equal (a.number, b.number, sizeof a.number);
            assert_memory_equal (a.count, b.count, sizeof a.count);
            assert_memory_equal (a.text, b.text, sizeof a.text);
        } else assert_true (status == PG_E_FILE || status == PG_E_MEMORY);
        file = fopen (path, "r+b");
        assert_true (file && fseek (file, at, SEEK_SET) == 0 && fputc (was, file) >= 0 && fclose (file) == 0);
    }
    assert_true (padding < (size_t) bytes / 12);
    check_ok (pg_checkpoint_read (path, walk, &b));
}

/* ---- several arrays of one length ---------------------------------------------------------------------- */
enum { LONG = 40000 };                                 /* more than are summed at once */
typedef struct { double first[LONG], other[LONG]; } arrays;

static pg_status walk_arrays (void *context, const pg_keeper *k)
{
    pg_status status = PG_OK;
    arrays *a = context;
    PG_TRY (k->numbers (k->context, "the first", LONG, a->first));
    PG_TRY (k->numbers (k->context, "the other", LONG, a->other));
done:
    return status;
}

/* Exchanges two texts of one length wherever they are in a file; how often. */
static int exchange (const char *path, const char *one, const char *other)
{
    size_t n = strlen (one), bytes = (size_t) bytes_of (path);
    int times = 0;
    char *whole = pg_calloc (bytes, 1);
    FILE *file = fopen (path, "r+b");
    assert_true (file && fread (whole, 1, bytes, file) == bytes);
    for (size_t k = 0; k + n <= bytes; k++) {
        int is = memcmp (whole + k, one, n) == 0, was = memcmp (whole + k, other, n) == 0;
        if (is || was) memcpy (whole + k, is ? other : one, n), times++;
    }
    assert_true (fseek (file, 0, SEEK_SET) == 0 && fwrite (whole, 1, bytes, file) == bytes
                 && fclose (file) == 0);
    pg_free (whole);
    return times;
}

static void long_arrays_count_whole_and_by_their_names (void **state)
{
    (void) state;
    arrays *a = pg_calloc (1, sizeof *a), *b = pg_calloc (1, sizeof *b);
    const char *path = file_at ("long.nc");
    for (int k = 0; k < LONG; k++) a->first[k] = 1.0 / (k + 1), a->other[k] = -k;
    check_ok (pg_checkpoint_write (path, walk_arrays, a));
    check_ok (pg_checkpoint_read (path, walk_arrays, b));
    assert_memory_equal (a, b, sizeof *a);
    assert_int_equal (exchange (path, "the first", "the other"), 2);
    check_fails (pg_checkpoint_read (path, walk_arrays, b), PG_E_FILE);
    check_contains (pg_last_error (), "long.nc is damaged or cut off");
    assert_int_equal (exchange (path, "the first", "the other"), 2);
    check_ok (pg_checkpoint_read (path, walk_arrays, b));
    assert_int_equal (exchange (path, "checksum", "checkmum"), 1);
    check_fails (pg_checkpoint_read (path, walk_arrays, b), PG_E_FILE);
    check_contains (pg_last_error (), "it has no checksum");
    pg_free (a), pg_free (b);
}

/* A child writes one checkpoint after the other until it is killed. */
static void no_instant_to_be_killed_at_is_bad (void **state)
{
    (void) state;
    thing b = { .n = 5, .name = "a.count" };
    const char *path = file_at ("any_instant.nc");
    int told[2];
    long last = -1;
    for (int round = 0; round < 25; round++) {
        long least = round % 5;
        assert_int_equal (pipe (told), 0);
        pid_t child = fork ();
        if (child == 0) {
            thing a = sample_thing ();
            for (a.count[0] = a.count[1] = last + 1;; a.count[0]++, a.count[1]++)
                if (pg_checkpoint_write (path, walk, &a) != PG_OK
                    || (a.count[0] < last + 6 && write (told[1], "", 1) != 1))
                    _exit (1);
        }
        kill_after (child, told, least, 131000 * round);
        if (last + least < 0 && access (path, F_OK) != 0) continue;
        check_ok (pg_checkpoint_read (path, walk, &b));
        assert_int_equal (b.count[0], b.count[1]);
        assert_true (b.count[0] >= last + least);
        last = b.count[0];
    }
    assert_true (last > 0);
}

static void any_allocation_may_fail (void **state)
{
    (void) state;
    thing a = sample_thing ();
    size_t used = pg_memory_used (), k = 1;
    pg_status status = PG_E_MEMORY;
    for (; status != PG_OK && k < 20; k++) {
        pg_memory_fail_at (k);
        status = pg_checkpoint_write (file_at ("sweep.nc"), walk, &a);
        pg_memory_fail_at (0);
        assert_true (status == PG_OK || status == PG_E_MEMORY);
        assert_int_equal (pg_memory_used (), used);
    }
    assert_true (status == PG_OK && k > 1);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (all_comes_back),
        cmocka_unit_test (what_does_not_fit_is_named),
        cmocka_unit_test (a_name_used_twice_is_a_misuse),
        cmocka_unit_test (a_walk_that_fails_leaves_the_old_file),
        cmocka_unit_test (a_full_disk_leaves_the_old_file),
        cmocka_unit_test (a_file_cut_off_is_refused),
        cmocka_unit_test (a_changed_byte_is_refused),
        cmocka_unit_test (long_arrays_count_whole_and_by_their_names),
        cmocka_unit_test (no_instant_to_be_killed_at_is_bad),
        cmocka_unit_test (any_allocation_may_fail),
    };
    return cmocka_run_group_tests_name ("io/output/checkpoint", tests, NULL, remove_folder);
}
