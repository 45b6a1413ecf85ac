/* SPDX-License-Identifier: GPL-3.0-or-later
 * Who may write into a result folder: one run at a time, also of processes that were killed and of other
 * hosts; nothing through links; not over what a run left for later, nor over the user's own scene. */
#include "folder.h"
#include <fcntl.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/wait.h>
#include <unistd.h>

#define SCENE \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [0.4, 0.3]}}}]\nspacing: 0.1\n" \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nboundary: [{set: bottom, " \
    "displacement: {x: 0, y: 0}}, {set: top, displacement: {y: 1 mm}}]\n" \
    "solver: {stepping: fixed, steps: 3}\noutput: {pictures: []}\n"

static char where[64];
static run r;

static int open_all (void **state)
{
    (void) state;
    make_folder (where);
    r = prepare (1, SCENE);
    return 0;
}

static int close_all (void **state)
{
    (void) state;
    clear (&r);
    remove_folder (where);
    return 0;
}

static void write_text (const char *name, const char *text)
{
    FILE *f = fopen (inside (where, name), "w");
    assert_non_null (f);
    assert_true (fputs (text, f) >= 0);
    assert_int_equal (fclose (f), 0);
}

static pg_status open_result (pg_result **result)
{
    return pg_result_open (result, where, r.scene, r.problem, r.solver);
}

static void one_run_at_a_time (void **state)
{
    (void) state;
    pg_result *one, *other = NULL;
    pg_resumed from;
    check_ok (open_result (&one));
    check_fails (open_result (&other), PG_E_USAGE);
    check_contains (pg_last_error (), "is in use by another run (process ");
    assert_null (other);
    write_text ("checkpoint.nc", "");
    check_fails (pg_result_resume (&other, where, r.scene, r.problem, r.solver, r.state, &from), PG_E_USAGE);
    check_contains (pg_last_error (), "is in use by another run");
    check_fails (pg_result_discard (where), PG_E_USAGE);
    remove (inside (where, "checkpoint.nc"));
    pg_result_free (&one);
    assert_int_equal (size_of (inside (where, "run.lock")), -1);
    check_ok (open_result (&other));
    pg_result_free (&other);
}

/* Another process holds it, until it is killed. */
static void the_lock_of_a_killed_run_is_none (void **state)
{
    (void) state;
    pg_result *result = NULL;
    int told[2], how;
    char byte, process[32];
    assert_int_equal (pipe (told), 0);
    pid_t child = fork ();
    if (child == 0) {
        if (open_result (&result) != PG_OK || write (told[1], "", 1) != 1) _exit (1);
        for (;;) pause ();
    }
    assert_int_equal (read (told[0], &byte, 1), 1);
    check_fails (open_result (&result), PG_E_USAGE);
    snprintf (process, sizeof process, "(process %ld on ", (long) child);
    check_contains (pg_last_error (), process);
    kill (child, SIGKILL);
    waitpid (child, &how, 0);
    close (told[0]), close (told[1]);
    assert_true (size_of (inside (where, "run.lock")) > 0);
    check_ok (open_result (&result));
    pg_result_free (&result);
}

static void a_lock_of_another_host_is_asked_about (void **state)
{
    (void) state;
    pg_result *result = NULL;
    write_text ("run.lock", "4711 node17.of.another.cluster\n");
    check_fails (open_result (&result), PG_E_USAGE);
    check_contains (pg_last_error (), "process 4711 on node17.of.another.cluster");
    check_contains (pg_last_error (), "run.lock");
    remove (inside (where, "run.lock"));
    write_text ("run.lock", "no owner");               /* cut off by a crash */
    check_ok (open_result (&result));
    pg_result_free (&result);
}

/* A link in the place of a file, or of the lock, leads nowhere. */
static void nothing_is_written_through_links (void **state)
{
    (void) state;
    static const char *const name[] = { "history.csv",       "events.csv",           "result.e",
                                        "report.json",       "report.json.tmp",      "scene.yaml",
                                        "checkpoint.nc.new", "load_displacement.png" };
    char target[256];
    pg_result *result;
    snprintf (target, sizeof target, "%s", inside (where, "precious"));
    write_text ("precious", "a day's work\n");
    for (size_t k = 0; k < sizeof name / sizeof *name; k++) {
        remove (inside (where, name[k]));
        if (k == 5) write_text (name[k], "# copied by perigal run from x\n");          /* a run's own */
        else assert_int_equal (symlink (target, inside (where, name[k])), 0);
    }
    check_ok (open_result (&result));
    advance (&r);
    check_ok (pg_result_step (result, r.state, &r.step));
    check_ok (pg_result_checkpoint (result, r.state));
    check_ok (pg_result_finish (result, r.state, NULL, 0, 1));
    pg_result_free (&result);
    char *text = slurp (target);
    assert_string_equal (text, "a day's work\n");
    pg_free (text);
    assert_int_equal (symlink (target, inside (where, "run.lock")), 0);
    check_fails (open_result (&result), PG_E_FILE);
    remove (inside (where, "run.lock"));
}

static void rows_of_another_scene_are_kept (void **state)
{
    (void) state;
    pg_result *result = NULL;
    run other = prepare (1, "title: another\n" SCENE), same = prepare (1, SCENE);
    check_ok (open_result (&result));
    advance (&same);
    check_ok (pg_result_step (result, same.state, &same.step));
    pg_result_free (&result);                          /* killed: rows, neither a report nor a checkpoint */
    check_fails (pg_result_open (&result, where, other.scene, other.problem, other.solver), PG_E_USAGE);
    check_contains (pg_last_error (), "1 rows of history.csv of another run");
    check_ok (open_result (&result));                  /* the same again loses nothing */
    check_ok (pg_result_step (result, same.state, &same.step));
    pg_result_free (&result);
    check_ok (pg_result_discard (where));
    check_ok (pg_result_open (&result, where, other.scene, other.problem, other.solver));
    check_ok (pg_result_step (result, other.state, &same.step));
    check_ok (pg_result_finish (result, other.state, NULL, 0, 1));
    pg_result_free (&result);
    check_ok (open_result (&result));                  /* over a finished run, as ever */
    pg_result_free (&result);
    clear (&other), clear (&same);
}

static void the_users_scene_stays (void **state)
{
    (void) state;
    static const char *const set[] = { "title=changed" };
    pg_result *result = NULL;
    char *text, path[128], mine[64];
    make_folder (mine);
    snprintf (path, sizeof path, "%s/scene.yaml", mine);
    FILE *f = fopen (path, "w");
    assert_true (f && fputs (SCENE, f) >= 0 && fclose (f) == 0);
    for (size_t n = 0; n < 2; n++) {                   /* in its own folder: without a note of --set */
        run own = loaded (path, n, set);
        if (n) check_fails (pg_result_open (&result, mine, own.scene, own.problem, own.solver), PG_E_USAGE);
        else check_ok (pg_result_open (&result, mine, own.scene, own.problem, own.solver));
        if (n) check_contains (pg_last_error (), "is the scene itself");
        pg_result_free (&result);
        clear (&own);
        text = slurp (path);
        assert_string_equal (text, SCENE);
        pg_free (text);
    }
    check_fails (pg_result_open (&result, mine, r.scene, r.problem, r.solver), PG_E_USAGE);
    check_contains (pg_last_error (), "scene.yaml was not written by a run");
    text = slurp (path);
    assert_string_equal (text, SCENE);
    pg_free (text);
    remove_folder (mine);
}

static void a_file_is_no_folder (void **state)
{
    (void) state;
    pg_result *result = NULL;
    write_text ("file", "");
    check_fails (pg_result_may_open (inside (where, "file"), r.scene), PG_E_USAGE);
    check_contains (pg_last_error (), "is a file: results need a folder");
    check_ok (pg_result_may_open (inside (where, "not there"), r.scene));
    assert_null (result);
}

int main (void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test (one_run_at_a_time),
        cmocka_unit_test (the_lock_of_a_killed_run_is_none),
        cmocka_unit_test (a_lock_of_another_host_is_asked_about),
        cmocka_unit_test (nothing_is_written_through_links),
        cmocka_unit_test (rows_of_another_scene_are_kept),
        cmocka_unit_test (the_users_scene_stays),
        cmocka_unit_test (a_file_is_no_folder),
    };
    return cmocka_run_group_tests_name ("app/results/folder", tests, open_all, close_all);
}
