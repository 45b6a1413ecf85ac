/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run reports about itself: warnings, and work it skipped. */
#include "solve.h"
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* Adds a warning; where there is no room for more, the last one is replaced by a note that says so. */
static void warn (pg_statistics *report, const char *format, va_list args)
{
    size_t room = sizeof report->warning / sizeof *report->warning;
    if (report->nwarning < room)
        vsnprintf (report->warning[report->nwarning++], sizeof *report->warning, format, args);
    else
        snprintf (report->warning[room - 1], sizeof *report->warning,
                  "more warnings than the %zu before this one, which are not kept: see to those first",
                  room - 1);
}

void pg_statistics_warn (pg_statistics *report, const char *format, ...)
{
    va_list args;
    va_start (args, format);
    warn (report, format, args);
    va_end (args);
}

void pg_solver_warn (pg_solver *s, const char *format, ...)
{
    va_list args;
    va_start (args, format);
    warn (&s->report, format, args);
    va_end (args);
}

void pg_statistics_warn_once (pg_statistics *report, const char *format, ...)
{
    char text[sizeof *report->warning];
    va_list args;
    va_start (args, format);
    vsnprintf (text, sizeof text, format, args);
    va_end (args);
    for (size_t k = 0; k < report->nwarning; k++) if (strcmp (report->warning[k], text) == 0) return;
    pg_statistics_warn (report, "%s", text);
}

/* Records work that was skipped and why; the same reason again replaces its record, as counts grow. */
void pg_statistics_skip (pg_statistics *report, double seconds, const char *what, const char *why)
{
    size_t k = 0;
    while (k < report->nskipped && strcmp (report->skipped[k].why, why) != 0) k++;
    if (k >= sizeof report->skipped / sizeof *report->skipped) return;
    pg_skip *s = &report->skipped[k];
    report->nskipped += k == report->nskipped;
    snprintf (s->what, sizeof s->what, "%s", what);
    snprintf (s->why, sizeof s->why, "%s", why);
    s->seconds_saved = seconds;
}
