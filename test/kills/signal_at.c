/* SPDX-License-Identifier: GPL-3.0-or-later
 * A library to be loaded before a program (LD_PRELOAD): it sends the program the signal SIGNAL when the
 * program calls the function CALL for the AT-th time. Calls: rename, remove (before it is done),
 * clock_gettime (somewhere in the run), signal (a library takes SIGTERM for itself: the signal comes just
 * then); file: what changes files (rename, remove, unlink, open, fopen, pwrite, fsync, ftruncate); twice and
 * late: as rename, and once more a millisecond or 0.6 s after it.
 * COUNTED: a file that gets the number of such calls. CLOCK: so many seconds pass from one call of
 * clock_gettime to the next, and no others: what depends on the time is at the same call in every run.
 * RANK: of the ranks of a run by mpirun, this one alone is sent the signal.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static long calls, looks;

static int other_rank (void)
{
    const char *rank = getenv ("RANK"), *own = getenv ("OMPI_COMM_WORLD_RANK");
    return rank && own && strcmp (rank, own) != 0;
}

static void count (const char *name, int file)
{
    const char *call = getenv ("CALL"), *at = getenv ("AT"), *number = getenv ("SIGNAL");
    long again = call && strcmp (call, "twice") == 0 ? 1000 : call && strcmp (call, "late") == 0 ? 600000 : 0;
    if (!call || other_rank ()) return;
    if (strcmp (again ? "rename" : call, name) != 0 && !(file && strcmp (call, "file") == 0)) return;
    calls++;
    if (!at || atol (at) != calls) return;
    kill (getpid (), number ? atoi (number) : SIGTERM);
    if (again) usleep ((useconds_t) again), kill (getpid (), number ? atoi (number) : SIGTERM);
    usleep (5000);                                     /* another thread may take it */
}

__attribute__ ((destructor)) static void tell (void)
{
    const char *path = getenv ("COUNTED");
    FILE *(*real) (const char *, const char *) =
        (FILE *(*) (const char *, const char *)) dlsym (RTLD_NEXT, "fopen");
    FILE *file = path && !other_rank () ? real (path, "w") : NULL;
    if (file) fprintf (file, "%ld\n", calls), fclose (file);
}

#define REPLACED(type, name, parameters, ...) \
    type name parameters \
    { \
        type (*real) parameters = (type (*) parameters) dlsym (RTLD_NEXT, #name); \
        count (#name, 1); \
        return real (__VA_ARGS__); \
    }
REPLACED (int, rename, (const char *from, const char *to), from, to)
REPLACED (int, remove, (const char *path), path)
REPLACED (int, unlink, (const char *path), path)
REPLACED (int, fsync, (int file), file)
REPLACED (int, ftruncate, (int file, off_t size), file, size)
REPLACED (ssize_t, pwrite, (int file, const void *from, size_t n, off_t at), file, from, n, at)
REPLACED (FILE *, fopen, (const char *path, const char *mode), path, mode)

int open (const char *path, int flags, ...)
{
    int (*real) (const char *, int, ...) = (int (*) (const char *, int, ...)) dlsym (RTLD_NEXT, "open");
    va_list more;
    va_start (more, flags);
    mode_t mode = flags & (O_CREAT | O_TMPFILE) ? va_arg (more, mode_t) : 0;
    va_end (more);
    if (flags & (O_WRONLY | O_RDWR)) count ("open", 1);
    return real (path, flags, mode);
}

int clock_gettime (clockid_t clock, struct timespec *out)
{
    int (*real) (clockid_t, struct timespec *) =
        (int (*) (clockid_t, struct timespec *)) dlsym (RTLD_NEXT, "clock_gettime");
    const char *step = getenv ("CLOCK");
    count ("clock_gettime", 0);
    if (!step || clock != CLOCK_MONOTONIC) return real (clock, out);
    double now = 1 + atof (step) * (double) ++looks;
    out->tv_sec = (time_t) now, out->tv_nsec = (long) (1e9 * (now - (double) out->tv_sec));
    return 0;
}

/* METIS takes SIGTERM under the name of System V. */
sighandler_t __sysv_signal (int number, sighandler_t handler)
{
    sighandler_t (*real) (int, sighandler_t) =
        (sighandler_t (*) (int, sighandler_t)) dlsym (RTLD_NEXT, "__sysv_signal");
    sighandler_t before = real (number, handler);
    if (number == SIGTERM && handler != SIG_DFL && handler != SIG_IGN) count ("signal", 0);
    return before;
}
