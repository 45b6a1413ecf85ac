/* SPDX-License-Identifier: GPL-3.0-or-later
 * Signals and threads. A signal to a process is handled by any of its threads that does not hold it back. The
 * threads that this library starts, and those that libraries start while they are loaded, hold all of them
 * back: whoever waits for signals does so in a thread of his own choice, and no library finds its handler in
 * a thread that it does not know. */
#include "perigal/base.h"
#include <pthread.h>
#include <signal.h>
#include <string.h>

_Static_assert (sizeof (sigset_t) <= sizeof (pg_signals), "a set of signals of this system is larger");

void pg_signals_hold (pg_signals *before)
{
    /* a fault ends its thread at once, and is reported as what it is */
    static const int faults[] = { SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS, SIGTRAP };
    sigset_t all, old;
    sigfillset (&all);
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) sigdelset (&all, faults[k]);
    pthread_sigmask (SIG_BLOCK, &all, &old);
    memcpy (before->set, &old, sizeof old);
}

void pg_signals_release (const pg_signals *before)
{
    sigset_t old;
    memcpy (&old, before->set, sizeof old);
    pthread_sigmask (SIG_SETMASK, &old, NULL);
}
