/* SPDX-License-Identifier: GPL-3.0-or-later
 * A library to be loaded before a program (LD_PRELOAD): it sends the program the signal SIGNAL when the
 * program calls the function CALL for the AT-th time. Calls: rename, remove (before it is done),
 * clock_gettime (somewhere in the run), signal (a library takes SIGTERM for itself: the signal comes just
 * then); twice and late: as rename, and once more a millisecond or 0.6 s after it.
 * COUNTED: a file that gets the number of such calls.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static long calls;

static void count (const char *name)
{
    const char *call = getenv ("CALL"), *at = getenv ("AT"), *number = getenv ("SIGNAL");
    long again = call && strcmp (call, "twice") == 0 ? 1000 : call && strcmp (call, "late") == 0 ? 600000 : 0;
    if (!call || strcmp (again ? "rename" : call, name) != 0) return;
    calls++;
    if (!at || atol (at) != calls) return;
    kill (getpid (), number ? atoi (number) : SIGTERM);
    if (again) usleep ((useconds_t) again), kill (getpid (), number ? atoi (number) : SIGTERM);
    usleep (5000);                                     /* another thread may take it */
}

__attribute__ ((destructor)) static void tell (void)
{
    const char *path = getenv ("COUNTED");
    FILE *file = path ? fopen (path, "w") : NULL;
    if (file) fprintf (file, "%ld\n", calls), fclose (file);
}

int rename (const char *from, const char *to)
{
    int (*real) (const char *, const char *) =
        (int (*) (const char *, const char *)) dlsym (RTLD_NEXT, "rename");
    count ("rename");
    return real (from, to);
}

int remove (const char *path)
{
    int (*real) (const char *) = (int (*) (const char *)) dlsym (RTLD_NEXT, "remove");
    count ("remove");
    return real (path);
}

int clock_gettime (clockid_t clock, struct timespec *out)
{
    int (*real) (clockid_t, struct timespec *) =
        (int (*) (clockid_t, struct timespec *)) dlsym (RTLD_NEXT, "clock_gettime");
    count ("clock_gettime");
    return real (clock, out);
}

/* METIS takes SIGTERM under the name of System V. */
sighandler_t __sysv_signal (int number, sighandler_t handler)
{
    sighandler_t (*real) (int, sighandler_t) =
        (sighandler_t (*) (int, sighandler_t)) dlsym (RTLD_NEXT, "__sysv_signal");
    sighandler_t before = real (number, handler);
    if (number == SIGTERM && handler != SIG_DFL && handler != SIG_IGN) count ("signal");
    return before;
}
