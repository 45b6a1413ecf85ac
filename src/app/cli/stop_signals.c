/* SPDX-License-Identifier: GPL-3.0-or-later
 * Signals that ask a run to stop. A thread waits for them, and all other threads block them: so they are
 * noted at any moment of the run, no system call is interrupted, and libraries that install handlers of their
 * own (METIS during an ordering, PETSc from its start on) do not get them. Commands of many runs count
 * signals instead (stops.c). */
#include "app/cli/preparation/cli.h"
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <time.h>
#include <unistd.h>

/* Number of the first signal, 0: none yet; 1: there is a result folder, which must be left in order; the
 * signals that are waited for. One set per process. */
static atomic_int first, opened;
static sigset_t waited;

int  run_asked_to_stop (void) { return atomic_load (&first); }
void run_opens (void) { atomic_store (&opened, 1); }

/* Ends the process while the scene is read and the run prepared: nothing is lost then, and that may take
 * long. */
static void end_before_results (void)
{
    static const char words[] = "perigal: interrupted before its first step: the same command begins anew\n";
    ssize_t unused = write (STDERR_FILENO, words, sizeof words - 1);
    (void) unused;
    _exit (PG_EXIT_INTERRUPTED);
}

/* 1: less than half a second has passed since `since`. One request may come as several signals: timeout sends
 * its own to the process and to its group, a terminal to all processes in it, and mpirun or a command of many
 * runs passes it on. */
int command_same_request (const struct timespec *since)
{
    const double together = 0.5;                       /* s, between the signals of one request */
    struct timespec now;
    clock_gettime (CLOCK_MONOTONIC, &now);
    return (double) (now.tv_sec - since->tv_sec) + 1e-9 * (double) (now.tv_nsec - since->tv_nsec) < together;
}

/* Notes the first signal; a second request by a signal of one kind ends the process at once, as without this
 * thread. */
static void *wait_for_signals (void *none)
{
    int number;
    /* when each signal first came, by its number (below 64) */
    struct timespec since[64];
    sigset_t seen;
    pg_signals before;
    pg_signals_hold (&before);
    sigemptyset (&seen);
    while (sigwait (&waited, &number) == 0) {
        if (!atomic_load (&opened)) end_before_results ();
        if (!sigismember (&seen, number)) {
            sigaddset (&seen, number);
            clock_gettime (CLOCK_MONOTONIC, &since[number]);
            atomic_store (&first, number);
            continue;
        }
        if (command_same_request (&since[number])) continue;
        signal (number, SIG_DFL);
        pthread_sigmask (SIG_UNBLOCK, &seen, NULL);
        raise (number);
    }
    return none;
}

/* Starts to wait for SIGINT, SIGTERM, SIGHUP and SIGUSR1 (which mpirun passes on to its ranks and batch
 * systems send before their time limit). Signals that the caller ignores (nohup) stay ignored, except SIGINT:
 * a shell ignores it for commands in the background. If no thread can be created, signals end the run at
 * once. A file beyond the size limit is an error of writing, not a signal. */
void run_listen (void)
{
    static const int asking[] = { SIGINT, SIGTERM, SIGHUP, SIGUSR1 };
    struct sigaction before;
    pthread_t thread;
    sigemptyset (&waited);
    for (size_t k = 0; k < sizeof asking / sizeof *asking; k++) {
        if (sigaction (asking[k], NULL, &before) != 0) continue;
        if (before.sa_handler == SIG_IGN && asking[k] != SIGINT) continue;
        signal (asking[k], SIG_DFL);
        sigaddset (&waited, asking[k]);
    }
    signal (SIGXFSZ, SIG_IGN);
    pthread_sigmask (SIG_BLOCK, &waited, NULL);
    if (pthread_create (&thread, NULL, wait_for_signals, NULL) == 0) pthread_detach (thread);
    else pthread_sigmask (SIG_UNBLOCK, &waited, NULL);
}
