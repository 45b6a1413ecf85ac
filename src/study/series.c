/* SPDX-License-Identifier: GPL-3.0-or-later
 * Many runs of one scene that differ in some of its values: each in a folder and a process of its own, one
 * after the other. A run that is there already is not repeated, one that was interrupted goes on. */
#include "process.h"
#include "perigal/picture.h"
#include "perigal/study.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Length of paths. */
enum { PATH = 4096, FOLDER = PATH - 64 };

static int exists (const char *folder, const char *name)
{
    char path[PATH];
    snprintf (path, sizeof path, "%s/%s", folder, name);
    return access (path, F_OK) == 0;
}

/* ---- what a run left --------------------------------------------------------------------------------------
 */
/* The number behind "key": in a text that begins with report.json or a part of it; NAN: it is not there. */
static double number_of (const char *text, const char *key)
{
    char word[64], *end;
    const char *at;
    snprintf (word, sizeof word, "\"%s\": ", key);
    at = text ? strstr (text, word) : NULL;
    if (!at) return NAN;
    double value = strtod (at + strlen (word), &end);
    return end == at + strlen (word) ? NAN : value;
}

/* The whole of a text file; NULL: it cannot be read. */
static char *read_text (const char *path)
{
    pg_status status = PG_OK;
    char *text = NULL;
    size_t size = 0, capacity = 0, got = 0;
    FILE *f = fopen (path, "r");
    if (!f) return NULL;
    do {
        PG_GROW (text, capacity, size + 65537);
        got = fread (text + size, 1, 65536, f);
        size += got;
    } while (got > 0);
    text[size] = '\0';
done:
    fclose (f);
    if (status != PG_OK) pg_free (text), text = NULL;
    return text;
}

/* From report.json: the peak of the curve that it names, energies, bonds, seconds. */
static void read_report (pg_series_result *r, const char *folder)
{
    char path[PATH];
    snprintf (path, sizeof path, "%s/report.json", folder);
    char *text = read_text (path);
    const char *curve = text ? strstr (text, "\"curve\": {") : NULL,
               *peak = curve ? strstr (curve, "\"peak\": {") : NULL;
    r->peak = number_of (peak, "force"), r->displacement = number_of (peak, "displacement");
    r->dissipated = number_of (text, "dissipated");
    r->broken = number_of (text, "broken"), r->seconds = number_of (text, "total");
    pg_free (text);
}

/* ---- runs -------------------------------------------------------------------------------------------------
 */
/* One run in a new process; the first line of what it says on stderr is why it failed. */
static pg_status run_one (pg_series_result *out, const pg_series_request *q, const pg_series_run *run)
{
    pg_status status = PG_OK;
    pg_process *child = NULL;
    char threads[16], folder[FOLDER], log[PATH];
    const char *argv[2 * PG_TRIAL_SETS + 2 * PG_SERIES_SETS + 16];
    size_t n = 0;
    PG_ALLOC (child, 1);
    if (snprintf (folder, sizeof folder, "%s/%s", q->folder, run->name) >= FOLDER)
        PG_FAIL (PG_E_LIMIT, "%.60s...: the name of the folder is too long", q->folder);
    snprintf (log, sizeof log, "%s.log", folder);
    snprintf (threads, sizeof threads, "%d", q->threads < 1 ? 1 : q->threads);
    const char *const first[] = { "perigal", "run", q->scene, "-o", folder, "--threads", threads, "--quiet" };
    for (size_t k = 0; k < sizeof first / sizeof *first; k++) argv[n++] = first[k];
    out->again = exists (folder, "report.json") || exists (folder, "checkpoint.nc");
    if (out->again) argv[n++] = "--resume";
    for (size_t k = 0; k < q->nset; k++) argv[n++] = "--set", argv[n++] = q->set[k];
    for (size_t k = 0; k < run->nset; k++) argv[n++] = "--set", argv[n++] = run->set[k];
    argv[n] = NULL;
    PG_TRY (pg_process_run (child, NULL, argv, NULL, log, q->threads));
    out->code = child->code;
    if (child->code == PG_EXIT_INTERRUPTED) PG_FAIL (PG_E_INTERRUPTED, "%s was interrupted", run->name);
    if (child->code != PG_EXIT_DONE) {
        pg_process_complaint (log, out->trouble, sizeof out->trouble);
        if (!out->trouble[0]) snprintf (out->trouble, sizeof out->trouble, "ended with code %d", child->code);
        if (out->again && !exists (folder, "checkpoint.nc"))
            snprintf (
                out->trouble, sizeof out->trouble,
                "%.200s holds a run that cannot go on here, of another scene or of other values, or one "
                "that failed: remove it, or choose another folder (-o)",
                folder);
    } else remove (log);
    read_report (out, folder);
done:
    pg_free (child);
    return status;
}

/* A line for each run as it ends. */
static void tell (FILE *out, const pg_series_run *run, const pg_series_result *r)
{
    char peak[64] = "no peak";
    if (!isnan (r->peak)) pg_picture_quantity (r->peak, "N", peak, sizeof peak);
    if (r->code != PG_EXIT_DONE) fprintf (out, "  %-20s  failed: %s\n", run->name, r->trouble);
    else fprintf (out, "  %-20s  %s%s\n", run->name, peak, r->again ? " (was there, or went on)" : "");
    fflush (out);
}

/* A scene that is wrong is wrong for all; other failures end one run only. */
pg_status pg_series_run_all (pg_series_result *out, const pg_series_request *q)
{
    pg_status status = PG_OK;
    PG_TRY (pg_folder_make (q->folder));
    for (size_t k = 0; k < q->n; k++) {
        out[k] = (pg_series_result) { .peak = NAN, .displacement = NAN };
        PG_TRY (run_one (&out[k], q, &q->run[k]));
        if (q->out) tell (q->out, &q->run[k], &out[k]);
        if (out[k].code == PG_EXIT_SCENE || out[k].code == PG_EXIT_USAGE)
            PG_FAIL (PG_E_SCENE, "%s", out[k].trouble);
    }
done:
    return status;
}
