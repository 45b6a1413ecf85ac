/* SPDX-License-Identifier: GPL-3.0-or-later
 * Signals that ask a command of many runs to stop: they are counted, and passed on to the runs as often. The
 * first one lets them write checkpoints, the second one ends them at once; this process continues, to report
 * what there is. Signals within half a second count as one. A single run uses stop_signals.c instead. */
#include "app/cli/preparation/cli.h"
#include <signal.h>
#include <string.h>
#include <time.h>

static volatile sig_atomic_t asked;
static struct timespec since;                          /* time of the first signal */

static void on_signal (int number)
{
    (void) number;
    if (asked == 0) clock_gettime (CLOCK_MONOTONIC, &since);
    else if (command_same_request (&since)) return;
    asked = asked + 1;
}

/* Counts SIGINT, SIGTERM and SIGHUP from now on. Signals that the caller ignores (nohup) stay ignored, except
 * SIGINT. */
const volatile sig_atomic_t *command_stops (void)
{
    static const int asking[] = { SIGINT, SIGTERM, SIGHUP };
    struct sigaction act, before;
    memset (&act, 0, sizeof act);
    act.sa_handler = on_signal, act.sa_flags = SA_RESTART;
    for (size_t k = 0; k < sizeof asking / sizeof *asking; k++)
        if (sigaction (asking[k], NULL, &before) == 0
            && (before.sa_handler != SIG_IGN || asking[k] == SIGINT))
            sigaction (asking[k], &act, NULL);
    return &asked;
}
