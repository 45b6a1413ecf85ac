/* SPDX-License-Identifier: GPL-3.0-or-later
 * Warnings of a run or of its plan. They are printed with -q too, on stderr: who asks for quiet wants no
 * progress, but has to know that an answer may be wrong. */
#include "cli.h"
#include <stdio.h>
#include <string.h>

/* 1: this warning is in `before`, whose warnings were printed already. */
static int was_before (const pg_statistics *before, const char *warning)
{
    for (size_t k = 0; before && k < before->nwarning; k++)
        if (strcmp (before->warning[k], warning) == 0) return 1;
    return 0;
}

void plan_warnings (const pg_statistics *report, const pg_statistics *before)
{
    for (size_t k = 0; k < report->nwarning; k++)
        if (!was_before (before, report->warning[k])) printf ("  warning: %s\n", report->warning[k]);
}

void plan_quiet_warnings (const pg_statistics *report, const pg_statistics *before)
{
    for (size_t k = 0; pg_rank () == 0 && k < report->nwarning; k++)
        if (!was_before (before, report->warning[k]))
            fprintf (stderr, "perigal: warning: %s\n", report->warning[k]);
}
