/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a run tells about itself: warnings, and work it skipped. */
#include "perigal/solve.h"
#include <stdarg.h>
#include <stdio.h>

/* Warnings beyond the room for them are dropped: the first are the ones that matter. */
void pg_statistics_warn (pg_statistics *report, const char *format, ...)
{
    if (report->nwarning >= sizeof report->warning / sizeof *report->warning) return;
    va_list args;
    va_start (args, format);
    vsnprintf (report->warning[report->nwarning++], sizeof *report->warning, format, args);
    va_end (args);
}

void pg_statistics_skip (pg_statistics *report, double seconds, const char *what, const char *why)
{
    if (report->nskipped >= sizeof report->skipped / sizeof *report->skipped) return;
    pg_skip *s = &report->skipped[report->nskipped++];
    snprintf (s->what, sizeof s->what, "%s", what);
    snprintf (s->why, sizeof s->why, "%s", why);
    s->seconds_saved = seconds;
}
