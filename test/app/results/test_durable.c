/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a power cut may cost: a checkpoint reaches the disk after all that it counts on, before it takes the
 * place of the old one, and its folder after that. fsync and rename of this program stand before those of the
 * C library and write down what they are asked for. */
#include "folder.h"
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <unistd.h>

enum { MOST = 32 };
static char done[MOST][80];
static size_t ndone;
static int refused = -1;                               /* the call that fails; -1: none */

static void note (const char *what, const char *path)
{
    const char *slash = strrchr (path, '/');
    if (ndone < MOST) snprintf (done[ndone++], sizeof *done, "%s %.60s", what, slash ? slash + 1 : path);
}

int fsync (int file);
int fsync (int file)
{
    char link[64], path[PATH_MAX];
    snprintf (link, sizeof link, "/proc/self/fd/%d", file);
    ssize_t n = readlink (link, path, sizeof path - 1);
    path[n > 0 ? n : 0] = 0;
    note ("sync", path);
    if (refused == (int) ndone - 1) {
        errno = EIO;
        return -1;
    }
    return 0;
}

int rename (const char *from, const char *to)
{
    note ("move", from);
    return renameat (AT_FDCWD, from, AT_FDCWD, to);
}

#define SCENE \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.4, 0.3]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nboundary: [{set: bottom, " \
    "displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n" \
    "solver: {stepping: fixed, steps: 3}\noutput: {pictures: []}\n"

static size_t place_of (const char *what)
{
    for (size_t k = 0; k < ndone; k++) if (strcmp (done[k], what) == 0) return k;
    print_error ("no '%s'\n", what);
    fail ();
    return 0;
}

static void a_checkpoint_is_on_the_disk (void **state)
{
    (void) state;
    static const char *const before[] = { "sync history.csv", "sync events.csv", "sync result.e",
                                          "sync checkpoint.nc.new" };
    char where[64], own[80];
    pg_result *result;
    make_folder (where);
    snprintf (own, sizeof own, "sync %s", strrchr (where, '/') + 1);
    run r = prepare (1, SCENE);
    check_ok (pg_result_open (&result, where, r.scene, r.problem, r.solver));
    advance (&r);
    check_ok (pg_result_step (result, r.state, &r.step));
    ndone = 0;
    check_ok (pg_result_checkpoint (result, r.state));
    size_t moved = place_of ("move checkpoint.nc.new");
    for (size_t k = 0; k < 4; k++) assert_true (place_of (before[k]) < moved);
    assert_true (place_of (before[3]) > place_of (before[2]) && place_of (own) > moved);
    assert_int_equal (ndone, 6);
    /* a disk that refuses any of them has no checkpoint of this moment */
    for (int k = 0; k < 6; k++) {
        if (k == (int) moved) continue;
        ndone = 0, refused = k;
        check_fails (pg_result_checkpoint (result, r.state), PG_E_FILE);
        check_contains (pg_last_error (), "Input/output error");
    }
    refused = -1;
    pg_result_free (&result);
    clear (&r);
    remove_folder (where);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (a_checkpoint_is_on_the_disk) };
    return cmocka_run_group_tests_name ("app/results/durable", tests, NULL, NULL);
}
