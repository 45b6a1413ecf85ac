/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run that is killed while it finishes can be resumed, or is finished: at every call by which it changes
 * what its folder holds. These calls stand here before those of the C library, are counted, and the process
 * ends in the one that the test has chosen, before anything is done. */
#define _GNU_SOURCE
#include "again.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { NEVER = -1 };
static int left = NEVER;                               /* calls until the process ends */

static void call (void)
{
    if (left == 0) kill (getpid (), SIGKILL);
    if (left > 0) left--;
}

int rename (const char *from, const char *to)
{
    call ();
    return renameat (AT_FDCWD, from, AT_FDCWD, to);
}

int remove (const char *path)
{
    call ();
    return unlinkat (AT_FDCWD, path, 0);
}

int fsync (int file);
int fsync (int file)
{
    (void) file;
    call ();
    return 0;
}

/* The bytes of a file are written in many calls; of those every 32nd counts. */
ssize_t pwrite (int file, const void *data, size_t bytes, off_t at);
ssize_t pwrite (int file, const void *data, size_t bytes, off_t at)
{
    static int n;
    if (n++ % 32 == 0) call ();
    return syscall (SYS_pwrite64, file, data, bytes, at);
}

static void copy_folder (const char *from, const char *to)
{
    char command[200];
    snprintf (command, sizeof command, "rm -rf %s && cp -r %s %s", to, from, to);
    assert_int_equal (system (command), 0);
}

static int there (const char *where, const char *name) { return size_of (inside (where, name)) >= 0; }

static void same_file (const char *a, const char *b, const char *name)
{
    if (!there (a, name)) return;
    char *x = slurp (inside (a, name)), *y = slurp (inside (b, name));
    long n = size_of (inside (a, name));
    assert_int_equal (n, size_of (inside (b, name)));
    assert_memory_equal (x, y, (size_t) n);
    pg_free (x), pg_free (y);
}

/* All steps from the checkpoint on; the end is counted. */
static void finish_in (const char *text, const char *where, int calls)
{
    run r;
    visit v;
    pg_resumed from;
    check_ok (resume (text, where, &r, &v, &from));
    while (!pg_solver_done (r.solver, r.state)) {
        check_ok (pg_solver_step (r.solver, r.state, &r.step));
        check_ok (pg_result_step (v.result, r.state, &r.step));
    }
    left = calls;
    check_ok (pg_result_finish (v.result, r.state, NULL, 0, 0));
    left = NEVER;
    pg_result_free (&v.result);
    clear (&r);
}

/* As `run` begins, until the first look. */
static void begin_in (const char *text, const char *where, int calls)
{
    (void) calls;
    assert_int_equal (stop_at (text, where, 1), 1);
}

/* As `run --resume` goes on. */
static void go_on_in (const char *text, const char *where, int calls)
{
    run r = prepare (1, text);
    int finished = pg_result_finished (where, r.scene);
    clear (&r);
    if (finished) check_ok (pg_result_complete (where));
    else finish_in (text, where, calls);
}

/* In a process of its own, each from the same start: threads of libraries do not pass on to a child. 1: it
 * was killed. */
typedef void (*work_in) (const char *text, const char *where, int calls);
static int apart (work_in work, const char *text, const char *where, int calls)
{
    int how;
    fflush (NULL);
    pid_t child = fork ();
    assert_true (child >= 0);
    if (child == 0) {
        work (text, where, calls);
        _exit (0);
    }
    assert_int_equal (waitpid (child, &how, 0), child);
    assert_true (WIFSIGNALED (how) ? WTERMSIG (how) == SIGKILL : WEXITSTATUS (how) == 0);
    return WIFSIGNALED (how);
}

static void at_any_moment (const char *text, int lines)
{
    static const char *const files[] = { "history.csv", "events.csv", "cracks.csv", "tips.csv", "fronts.csv",
                                         "contact.csv" };
    char whole[64], half[64], where[64];
    int calls = 0, finished = 0;
    make_folder (whole), make_folder (half), make_folder (where);
    assert_int_equal (apart (begin_in, text, half, NEVER), 0);
    copy_folder (half, whole);
    assert_int_equal (apart (finish_in, text, whole, NEVER), 0);
    for (;; calls++) {
        copy_folder (half, where);
        if (!apart (finish_in, text, where, calls)) break;
        finished += !there (where, "checkpoint.nc");
        assert_int_equal (apart (go_on_in, text, where, NEVER), 0);
        for (size_t k = 0; k < sizeof files / sizeof *files; k++) same_file (whole, where, files[k]);
        same_fields (whole, where);
        char *report = slurp (inside (where, "report.json"));
        check_contains (report, "\"outcome\": \"done\"");
        pg_free (report);
        assert_false (there (where, "checkpoint.nc") || there (where, "checkpoint.nc.new"));
    }
    assert_true (calls > 8);
    /* between the last two steps too, where there are faces of cracks to be added */
    if (lines) assert_true (finished > 0);
    remove_folder (whole), remove_folder (half), remove_folder (where);
}

/* Two events each, one of them behind the checkpoint. */
#define ROCK \
    "materials: {rock: {youngs_modulus: 1 GPa, poissons_ratio: 0.2}}\nfailure: {fracture_energy: 4 J/m2}\n"
#define SHORT "solver: {stepping: event, max_events: 2}\noutput: {pictures: []}\n"

static void breaking_bonds (void **state)
{
    (void) state;
    at_any_moment (BODY PULL "solver: {stepping: fixed, steps: 3}\noutput: {pictures: []}\n", 0);
}

#define CRACKED \
    "dimension: 2\nthickness: 0.1\nbody: [{add: {box: {low: [0, 0], high: [1, 0.9]}}}]\n" \
    "spacing: 0.1\ncracks: [{from: [-0.1, 0.46], to: [0.43, 0.43]}]\n" ROCK PULL
static void cracks_in_the_plane (void **state)
{
    (void) state;
    at_any_moment (CRACKED SHORT, 1);
}

static void files_of_vtk (void **state)
{
    (void) state;
    at_any_moment (CRACKED "solver: {stepping: event, max_events: 2}\n"
                           "output: {pictures: [], format: vtk, at: {events: 1}}\n", 1);
}

static void fronts_in_space (void **state)
{
    (void) state;
    at_any_moment ("dimension: 3\nbody: [{add: {box: {low: [0, 0, 0], high: [6, 3, 4]}}}]\nspacing: 1\n"
                   "cracks: [{polygon: [[-1, -1, 2.1], [3, -1, 2.1], [3, 6, 1.9], [-1, 6, 1.9]]}]\n" ROCK
                   "boundary: [{set: back, displacement: {x: 0, y: 0, z: 0}}, {set: front, displacement: "
                   "{x: 2 mm, z: 10 mm}}]\n" SHORT, 1);
}

int main (void)
{
    const struct CMUnitTest tests[] = { cmocka_unit_test (breaking_bonds),
                                        cmocka_unit_test (cracks_in_the_plane),
                                        cmocka_unit_test (files_of_vtk),
                                        cmocka_unit_test (fronts_in_space) };
    return cmocka_run_group_tests_name ("app/results/killed", tests, NULL, NULL);
}
