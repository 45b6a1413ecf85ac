/* SPDX-License-Identifier: GPL-3.0-or-later
 * Progress with the time left. */
#include "cli.h"
#include <unistd.h>

void progress_start (progress *p, int quiet, int marching)
{
    *p = (progress) { pg_seconds (), 0, 0, isatty (2), quiet, marching };
}

static void write_line (const progress *p, double share, const pg_step *step, const pg_report *r, double passed)
{
    char left[32] = "", how[96];                       /* events come at no rate that could be foretold */
    if (share > 0.005 && share < 1 && passed > 1 && (r->events == 0 || p->marching)) snprintf (left, sizeof left, ", about %.0f s left", passed * (1 - share) / share);
    if (p->marching) snprintf (how, sizeof how, "step %ld, %.4g s", r->iterations, step->time);
    else snprintf (how, sizeof how, "step %ld, load factor %.4g, %ld events", step->number, step->factor, r->events);
    fprintf (stderr, "%s%5.1f %%  %s, %ld bonds broken", p->tty ? "\r" : "", 100 * share, how, r->broken);
    if (!p->marching) fprintf (stderr, ", residual %.1e", r->residual_max);
    fprintf (stderr, ", %.1f s%s%s", passed, left, p->tty ? "\033[K" : "\n");
    if (p->tty) fflush (stderr);
}

void progress_show (progress *p, double share, const pg_step *step, const pg_report *report)
{
    double now = pg_seconds ();
    if (p->quiet) return;
    if (p->tty ? now - p->last < 0.2 : now - p->last < 10 && (int) (share * 10) <= p->tenth) return;
    p->last = now, p->tenth = (int) (share * 10);
    write_line (p, share, step, report, now - p->start);
}

void progress_end (progress *p)
{
    if (p->tty && !p->quiet) fprintf (stderr, "\r\033[K");
}
