/* SPDX-License-Identifier: GPL-3.0-or-later
 * Processes with their own seconds and memory, by fork, exec and wait4, whose resource usage
 * is that of the child alone. */
#define _DEFAULT_SOURCE                                /* declares wait4 */
#include "process.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <stdint.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

/* Sets the numbers of threads for the libraries of the child, CalculiX included. OMP_THREAD_LIMIT stays 1:
 * OpenMP threads of CHOLMOD slow it down beside a threaded BLAS. */
static void settle_environment (int threads)
{
    static const char *const counts[] = { "OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS",
                                          "CCX_NPROC_EQUATION_SOLVER", "CCX_NPROC_RESULTS",
                                          "CCX_NPROC_STIFFNESS" };
    char text[16];
    snprintf (text, sizeof text, "%d", threads < 1 ? 1 : threads);
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) setenv (counts[k], text, 1);
    setenv ("OMP_THREAD_LIMIT", "1", 1);
    setenv ("OMP_WAIT_POLICY", "passive", 1);
}

/* Replaces the new process by the program; never returns. stdin is empty, stdout goes to the parent, stderr
 * to the log. Exit code 127: it could not be started. */
static void become (const char *program, const char *const argv[], const char *folder,
                    const char *log, int to, int threads)
{
    int errors = open (log ? log : "/dev/null", O_WRONLY | O_CREAT | O_TRUNC, 0666),
        nothing = open ("/dev/null", O_RDONLY);
    settle_environment (threads);
    if (dup2 (nothing, 0) < 0 || dup2 (to, 1) < 0 || dup2 (errors, 2) < 0 || (folder && chdir (folder) != 0))
        _exit (127);
    /* POSIX: exec changes no argument, though its declaration cannot say so */
    char *const *arguments = (char *const *) (uintptr_t) argv;
    if (program) execvp (program, arguments);
    else execv ("/proc/self/exe", arguments);
    _exit (127);
}

/* Reads from a pipe until the other end closes; what exceeds the text is read and dropped, so that the child
 * never waits. Returns the bytes kept. */
static size_t drain (int from, char *text, size_t size)
{
    char rest[4096];
    size_t n = 0;
    for (;;) {
        int full = n + 1 >= size;
        ssize_t got = read (from, full ? rest : text + n, full ? sizeof rest : size - 1 - n);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) break;
        if (!full) n += (size_t) got;
    }
    text[n] = 0;
    return n;
}

/* A time of the system in seconds. */
static double seconds_of (const struct timeval *t) { return (double) t->tv_sec + 1e-6 * (double) t->tv_usec; }

/* Turns a status of wait4 into an exit code. */
static int code_of (int how) { return WIFEXITED (how) ? WEXITSTATUS (how) : 128 + WTERMSIG (how); }

/* Runs a program to its end. Its output is read to the end before its exit is waited for: a full pipe would
 * block both. All streams are flushed before the fork: otherwise their buffers would be written twice. */
pg_status pg_process_run (pg_process *out, const char *program, const char *const argv[], const char *folder,
                     const char *log, int threads)
{
    pg_status status = PG_OK;
    int ends[2] = { -1, -1 }, how = 0;
    struct rusage used;
    double start = pg_seconds ();
    memset (out, 0, sizeof *out);
    if (pipe (ends) != 0) PG_FAIL (PG_E_FILE, "%s: no pipe: %s", argv[0], strerror (errno));
    fflush (NULL);
    pid_t child = fork ();
    if (child < 0) PG_FAIL (PG_E_MEMORY, "%s: no process: %s", argv[0], strerror (errno));
    if (child == 0) {
        close (ends[0]);
        become (program, argv, folder, log, ends[1], threads);
    }
    close (ends[1]), ends[1] = -1;
    drain (ends[0], out->text, sizeof out->text);
    while (wait4 (child, &how, 0, &used) < 0 && errno == EINTR) continue;
    out->wall = pg_seconds () - start;
    out->cpu = seconds_of (&used.ru_utime) + seconds_of (&used.ru_stime);
    out->peak = (size_t) used.ru_maxrss * 1024;
    out->code = code_of (how);
    if (out->code == 127) PG_FAIL (PG_E_FILE, "%s cannot be started", argv[0]);
    if (out->code == 128 + SIGINT) PG_FAIL (PG_E_INTERRUPTED, "%s was interrupted", argv[0]);
done:
    if (ends[0] >= 0) close (ends[0]);
    if (ends[1] >= 0) close (ends[1]);
    return status;
}

/* Starts a child. If the parent has died between fork and prctl the child ends, since it would never get the
 * signal. */
pg_status pg_child_start (pg_child *out, const char *const argv[], const char *log, int threads)
{
    pg_status status = PG_OK;
    pid_t parent = getpid ();
    *out = (pg_child) { .start = pg_seconds () };
    fflush (NULL);
    pid_t child = fork ();
    if (child < 0) PG_FAIL (PG_E_MEMORY, "%s: no process: %s", argv[0], strerror (errno));
    if (child == 0) {
        setpgid (0, 0);
        if (prctl (PR_SET_PDEATHSIG, SIGTERM) != 0 || getppid () != parent) _exit (127);
        become (NULL, argv, NULL, log, open ("/dev/null", O_WRONLY), threads);
    }
    out->id = child;
done:
    return status;
}

int pg_child_ended (pg_child *c)
{
    struct rusage used;
    int how = 0;
    pid_t got = c->id > 0 ? wait4 ((pid_t) c->id, &how, WNOHANG, &used) : 0;
    if (got <= 0 && !(got < 0 && errno == ECHILD)) return 0;
    c->wall = pg_seconds () - c->start;
    c->code = 127;                                     /* another part of the program has waited for it */
    if (got > 0) {
        c->cpu = seconds_of (&used.ru_utime) + seconds_of (&used.ru_stime);
        c->peak = (size_t) used.ru_maxrss * 1024;
        c->code = code_of (how);
    }
    c->id = 0;
    return 1;
}

void pg_child_signal (const pg_child *child, int number)
{
    if (child->id > 0) kill ((pid_t) child->id, number);
}

/* 1 if a program is in one of the folders of PATH. */
int pg_process_finds (const char *program)
{
    const char *s = getenv ("PATH");
    char path[4096];
    while (s && *s) {
        size_t n = strcspn (s, ":");
        snprintf (path, sizeof path, "%.*s/%s", (int) n, s, program);
        if (access (path, X_OK) == 0) return 1;
        s += n + (s[n] == ':');
    }
    return 0;
}

/* Takes the first line that is no warning: compilers, scripts and our own program all print the reason first,
 * ours after its warnings. */
void pg_process_complaint (const char *log, char *text, size_t size)
{
    static const char warning[] = "perigal: warning: ";
    FILE *f = fopen (log, "r");
    text[0] = 0;
    if (!f) return;
    while (fgets (text, (int) size, f)) {
        int whole = strchr (text, '\n') != NULL;
        text[strcspn (text, "\r\n")] = 0;
        if (text[0] && strncmp (text, warning, strlen (warning)) != 0) break;
        for (int c = 0; !whole && c != '\n' && c != EOF;) c = fgetc (f);
        text[0] = 0;
    }
    fclose (f);
}
