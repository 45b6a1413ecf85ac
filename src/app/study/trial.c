/* SPDX-License-Identifier: GPL-3.0-or-later
 * One run in a process of its own: the part of the process that starts it. The numbers come back as lines of
 * text on stdout, the message of a failure as the first line of the log. */
#include "perigal/study.h"
#include "process.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define X(id, name, unit) name,
const char *const pg_trial_name[PG_TRIAL_COUNT] = { PG_TRIAL_LIST (X) };
#undef X
#define X(id, name, unit) unit,
const char *const pg_trial_unit[PG_TRIAL_COUNT] = { PG_TRIAL_LIST (X) };
#undef X

/* Reads the numbers of a trial from lines "name value"; unknown names are ignored, so that versions may
 * differ. */
void pg_trial_read (pg_trial *out, const char *text)
{
    for (size_t k = 0; k < PG_TRIAL_COUNT; k++) {
        size_t n = strlen (pg_trial_name[k]);
        out->value[k] = NAN;
        for (const char *s = text; s && *s; s = strchr (s, '\n'), s += s != NULL)
            if (strncmp (s, pg_trial_name[k], n) == 0 && s[n] == ' ') out->value[k] = strtod (s + n, NULL);
    }
}

/* Writes the numbers of a trial with 17 digits, which give the same doubles when they are read. */
void pg_trial_write (const pg_trial *t, FILE *to)
{
    for (size_t k = 0; k < PG_TRIAL_COUNT; k++)
        if (!isnan (t->value[k])) fprintf (to, "%s %.17g\n", pg_trial_name[k], t->value[k]);
}

/* Runs a trial. The exit code of the child decides the status: a wrong scene, an interruption, any other
 * failure. The log stays if the run failed. */
pg_status pg_trial_run (pg_trial *out, const pg_trial_request *q)
{
    pg_status status = PG_OK;
    pg_process *child = NULL;
    char threads[16], log[4096], complaint[2048];
    const char *argv[2 * PG_TRIAL_SETS + 16] = { "perigal",          "bench",     "--row", q->scene, "-o",
                                        q->folder, "--threads", threads, "--quiet" };
    size_t n = 9;
    pg_trial_read (out, "");
    PG_ALLOC (child, 1);
    snprintf (threads, sizeof threads, "%d", q->threads);
    snprintf (log, sizeof log, "%s.log", q->folder);
    for (size_t k = 0; k < q->nset && k < PG_TRIAL_SETS; k++)
        argv[n++] = "--set", argv[n++] = q->set[k];
    PG_TRY (pg_process_run (child, NULL, argv, NULL, log, q->threads));
    if (child->code != PG_EXIT_DONE) {
        pg_process_complaint (log, complaint, sizeof complaint);
        PG_FAIL (child->code == PG_EXIT_SCENE         ? PG_E_SCENE
                 : child->code == PG_EXIT_INTERRUPTED ? PG_E_INTERRUPTED
                                                   : PG_E_EQUILIBRIUM,
                 "%s",
                 complaint[0]         ? complaint
                 : child->code >= 128 ? "killed by a signal"
                                      : "the run failed without a message");
    }
    pg_trial_read (out, child->text);
    remove (log);
done:
    pg_free (child);
    return status;
}
