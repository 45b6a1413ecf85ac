/* SPDX-License-Identifier: GPL-3.0-or-later
 * Progress of a run: how far it is, what is going on, the pace, and the time left where it can
 * be estimated. Everything goes to stderr, so that stdout can be used by programs. */
#include "app/cli/preparation/cli.h"
#include <math.h>
#include <string.h>
#include <sys/ioctl.h>
#include <unistd.h>

/* Longest line; width of a terminal, columns, below which it is taken for wrong; most details of a line,
 * which are left out one after the other until it fits. */
enum { LINE = 400, NARROW = 20, FULL = 3 };

/* Starts the display: both marks of the pace are at the start of the run. */
void progress_start (progress *p, int quiet, const pg_solver_options *o)
{
    double now = pg_seconds ();
    *p = (progress){ .start = now,
                     .last = now,
                     .tty = isatty (2),
                     .quiet = quiet,
                     .steps_in_time = (o->flags & PG_SOLVER_EXPLICIT) != 0,
                     .staged = (o->flags & PG_SOLVER_STAGED) != 0 };
    p->mark[0].at = p->mark[1].at = now;
}

/* Updates the marks: the pace is measured over the last third to two thirds of the time, so that an easy
 * start does not count for ever. */
static void keep_pace (progress *p, double now, double share, double events)
{
    if (!p->begun) {
        for (int k = 0; k < 2; k++) p->mark[k].share = share, p->mark[k].events = events;
        p->begun = 1;
    }
    if (now - p->mark[1].at < (now - p->start) / 3) return;
    p->mark[0] = p->mark[1];
    p->mark[1].at = now, p->mark[1].share = share, p->mark[1].events = events;
}

/* Writes seconds in words; more than 100 s as minutes, rounded up. */
static void put_time (char *out, size_t size, double seconds)
{
    if (seconds < 100) snprintf (out, size, seconds < 10 ? "%.1f s" : "%.0f s", seconds);
    else if (seconds < 6000) snprintf (out, size, "%.0f min", ceil (seconds / 60));
    else if (seconds < 360000) snprintf (out, size, "%.1f h", seconds / 3600);
    else snprintf (out, size, "%.0f days", seconds / 86400);
}

/* Appends a part of the line, after a comma. */
static void add (char *line, const char *text)
{
    size_t n = strlen (line);
    snprintf (line + n, LINE - n, "%s%s", n ? ", " : "", text);
}

/* Appends the step: time steps, events with their pace since the first mark, or load steps with the break
 * rounds of the current one (iterations, if it is relaxed). */
static void add_step (char *line, const progress *p, const pg_progress *at, const pg_step *step,
                      const pg_statistics *r, double now, int within)
{
    char text[96], rate[32] = "";
    double passed = now - p->mark[0].at,
           pace = passed > 0.5 ? ((double) r->events - p->mark[0].events) / passed : 0;
    if (pace > 0) snprintf (rate, sizeof rate, " (%.3g/s)", pace);
    if (p->steps_in_time)
        snprintf (text, sizeof text, "step %ld, %.4g s", r->iterations + (within ? step->iterations : 0),
                  step->time);
    else if (!at->event && within)
        snprintf (text, sizeof text, "step %ld, %s %ld", step->number, p->staged ? "iteration" : "round",
                  step->iterations);
    else if (!at->event) snprintf (text, sizeof text, "step %ld", step->number);
    else snprintf (text, sizeof text, "%ld event%s%s", r->events, r->events == 1 ? "" : "s", rate);
    add (line, text);
}

/* Appends the time passed, and the time left if equal shares of the run take equal times: it follows from the
 * pace since the first mark. How many break rounds will follow is unknown, so nothing is said during one;
 * with event stepping it is an upper bound. */
static void add_time (char *line, const progress *p, const pg_progress *at, double now, int breaking)
{
    char word[32], text[64];
    double passed = now - p->start, gained = at->share - p->mark[0].share, since = now - p->mark[0].at;
    put_time (word, sizeof word, passed);
    add (line, word);
    if (!at->even || breaking || !(gained > 0) || at->share >= 1 || passed < 1) return;
    put_time (word, sizeof word, since * (1 - at->share) / gained);
    snprintf (text, sizeof text, "%s%s left",
              at->event && p->mark[0].events + p->mark[1].events > 0 ? "at most " : "about ", word);
    add (line, text);
}

/* Appends a number in a printf format. */
static void add_number (char *line, const char *format, double value)
{
    char text[96];
    snprintf (text, sizeof text, format, value);
    add (line, text);
}

/* Appends how near the stop conditions of event stepping are, as far as they are known. */
static void add_ends (char *line, const pg_progress *at)
{
    if (at->event && isfinite (at->stiffness))
        add_number (line, "stiffness %.3g of the initial one", at->stiffness);
    if (isfinite (at->damage)) add_number (line, "damage in stop.set %.2g", at->damage);
}

/* Composes the line with `full` details, from 0 to FULL (all): share of the run, step, load factor, stiffness
 * and damage for stop conditions, broken bonds, residual, time. */
static void compose (char *line, int full, const progress *p, const pg_progress *at, const pg_step *step,
                     const pg_statistics *r, double now, int within)
{
    char text[96];
    int relaxes_or_solves = !p->steps_in_time;
    snprintf (line, LINE, at->event ? "%5.1f %% of %s" : "%5.1f %%", 100 * at->share, at->end);
    add_step (line, p, at, step, r, now, within);
    if (full > 0 && relaxes_or_solves && !within) add_number (line, "load factor %.4g", step->factor);
    if (full > 2) add_ends (line, at);
    snprintf (text, sizeof text, "%ld bonds broken", r->broken + (within ? (long) step->nbroken : 0));
    if (full > 1) add (line, text);
    if (full > 2 && relaxes_or_solves) add_number (line, "residual %.1e", r->residual_max);
    /* While bonds break nobody knows how many rounds will follow. */
    add_time (line, p, at, now, within && step->nbroken && relaxes_or_solves);
}

/* Columns of the terminal behind stderr; 80 if it does not say or is narrower than believable. */
static size_t width_of_terminal (void)
{
    struct winsize size;
    return ioctl (2, TIOCGWINSZ, &size) == 0 && size.ws_col >= NARROW ? size.ws_col : 80;
}

/* Writes the line with as many details as fit the terminal. "\r" goes back to its start, and ESC [ K clears
 * the rest of it. */
static void write_line (const progress *p, const pg_progress *at, const pg_step *step, const pg_statistics *r,
                        double now, int within)
{
    char line[LINE];
    size_t width = p->tty ? width_of_terminal () - 1 : LINE;
    int full = FULL;
    do compose (line, full, p, at, step, r, now, within);
    while (strlen (line) > width && full-- > 0);
    if (strlen (line) > width) line[width] = 0;
    fprintf (stderr, "%s%s%s", p->tty ? "\r" : "", line, p->tty ? "\033[K" : "\n");
    if (p->tty) fflush (stderr);
}

/* Shows the progress: at most five lines per second on a terminal; elsewhere one for each tenth of the run
 * and one every ten seconds or 2 % of the time, whichever is longer. */
void progress_show (progress *p, const pg_progress *at, const pg_step *step, const pg_statistics *report,
                    int within)
{
    double now = pg_seconds (), passed = now - p->start, pause = p->tty ? 0.2 : fmax (10, 0.02 * passed);
    int tenth = (int) (at->share * 10 * (1 + 1e-12));
    if (p->quiet) return;
    keep_pace (p, now, at->share, (double) report->events);
    if (now - p->last < pause && (p->tty || tenth <= p->tenth)) return;
    p->last = now, p->tenth = tenth > p->tenth ? tenth : p->tenth;
    write_line (p, at, step, report, now, within);
}

/* Removes the line from the terminal, so that the summary stands in its place. */
void progress_end (progress *p)
{
    if (p->tty && !p->quiet) fprintf (stderr, "\r\033[K");
}
