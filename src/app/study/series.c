/* SPDX-License-Identifier: GPL-3.0-or-later
 * Many runs of one scene that differ in some of its values: each in a folder and a process of its own, as
 * many at a time as are asked for. A finished run is not repeated, an interrupted one is continued, a failed
 * one begins anew. The processes are polled, since a signal that comes just before a wait for one of them
 * would not be noticed. */
#include "process.h"
#include "series.h"
#include "perigal/picture.h"
#include "perigal/study.h"
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

/* Largest lengths of paths. */
enum { PATH = 4096, FOLDER = PATH - 64 };

static int exists (const char *folder, const char *name)
{
    char path[PATH];
    snprintf (path, sizeof path, "%s/%s", folder, name);
    return access (path, F_OK) == 0;
}

/* ---- what a run left ----------------------------------------------------------------------------------- */
/* Reads a whole text file; NULL: it cannot be read. */
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

char *pg_report_load (const char *folder)
{
    char path[PATH];
    snprintf (path, sizeof path, "%s/report.json", folder);
    return read_text (path);
}

/* Finds a number in a report. This is no JSON reader: it relies on the form that our own writer gives, and on
 * the order of its keys. */
double pg_report_number (const char *text, const char *block, const char *key)
{
    char word[64], *end;
    const char *at = text, *last = NULL;
    if (at && block) {
        snprintf (word, sizeof word, "\"%s\": {", block);
        at = strstr (at, word);
        last = at ? strchr (at, '}') : NULL;
    }
    snprintf (word, sizeof word, "\"%s\": ", key);
    at = at ? strstr (at, word) : NULL;
    if (!at || (last && at > last)) return NAN;
    double value = strtod (at + strlen (word), &end);
    return end == at + strlen (word) ? NAN : value;
}

/* Reads from report.json: the peak of its curve, energies, bonds, seconds. */
static void read_report (pg_series_result *r, const char *folder)
{
    char *text = pg_report_load (folder);
    r->peak = pg_report_number (text, "peak", "force");
    r->displacement = pg_report_number (text, "peak", "displacement");
    r->dissipated = pg_report_number (text, "energy", "dissipated");
    r->broken = pg_report_number (text, NULL, "broken");
    r->seconds = pg_report_number (text, "seconds", "total");
    pg_free (text);
}

/* ---- one run ------------------------------------------------------------------------------------------- */
enum { WORDS = 2 * PG_TRIAL_SETS + 2 * PG_SERIES_SETS + 16, JOBS = 64 };

/* A run in progress, or its check. */
typedef struct { pg_child child; size_t k; char folder[FOLDER], log[PATH]; } slot;

/* Lists all overrides of a run, first those shared by all runs. Returns their number. */
static size_t all_sets (const char *set[], const pg_series_request *q, const pg_series_run *run)
{
    size_t n = 0;
    for (size_t k = 0; k < q->nset; k++) set[n++] = q->set[k];
    for (size_t k = 0; k < run->nset; k++) set[n++] = run->set[k];
    return n;
}

static pg_status name_folder (char folder[FOLDER], const pg_series_request *q, const pg_series_run *run)
{
    pg_status status = PG_OK;
    if (snprintf (folder, FOLDER, "%s/%s", q->folder, run->name) >= FOLDER)
        PG_FAIL (PG_E_LIMIT, "%.60s...: the name of the folder is too long", q->folder);
done:
    return status;
}

/* 1: the report in the folder says that the run came to its end. */
static int is_done (const char *folder)
{
    char *text = exists (folder, "checkpoint.nc") ? NULL : pg_report_load (folder);
    int done = text && strstr (text, "\"outcome\": \"done\"");
    pg_free (text);
    return done;
}

pg_status pg_series_look (int *out, const pg_series_request *q, const pg_series_run *run)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    const char *set[PG_TRIAL_SETS + PG_SERIES_SETS];
    char folder[FOLDER];
    size_t n = all_sets (set, q, run);
    PG_TRY (name_folder (folder, q, run));
    PG_TRY (pg_scene_load_with (&scene, q->scene, n, set));
    *out = pg_result_finished (folder, scene) ? 1 : is_done (folder) ? -1 : 0;
done:
    if (status == PG_E_FILE) status = PG_E_SCENE;
    pg_scene_free (&scene);
    return status;
}

/* Writes the command line of a run, or of its check. */
static void write_words (const char *argv[WORDS], slot *s, const pg_series_request *q,
                         const pg_series_run *run, int check, char threads[16])
{
    size_t n = 0;
    snprintf (threads, 16, "%d", q->threads < 1 ? 1 : q->threads);
    argv[n++] = "perigal", argv[n++] = check ? "check" : "run", argv[n++] = q->scene;
    argv[n++] = "--threads", argv[n++] = threads, argv[n++] = "--quiet";
    if (q->memory) argv[n++] = "--memory", argv[n++] = q->memory;
    if (!check) argv[n++] = "-o", argv[n++] = s->folder;
    if (!check && exists (s->folder, "checkpoint.nc")) argv[n++] = "--resume";
    const char *set[PG_TRIAL_SETS + PG_SERIES_SETS];
    for (size_t k = 0, m = all_sets (set, q, run); k < m; k++) argv[n++] = "--set", argv[n++] = set[k];
    argv[n] = NULL;
}

/* Starts run k in a free slot. */
static pg_status start (slot *s, const pg_series_request *q, size_t k, int check)
{
    pg_status status = PG_OK;
    const char *argv[WORDS];
    char threads[16];
    s->k = k;
    PG_TRY (name_folder (s->folder, q, &q->run[k]));
    snprintf (s->log, sizeof s->log, "%s.%s", s->folder, check ? "check" : "log");
    write_words (argv, s, q, &q->run[k], check, threads);
    PG_TRY (pg_child_start (&s->child, argv, s->log, q->threads));
done:
    return status;
}

/* 1 for the exit codes of a run that was asked to stop. */
static int was_stopped (int code)
{
    return code == PG_EXIT_INTERRUPTED || code == 128 + SIGTERM || code == 128 + SIGHUP;
}

/* Takes the results of an ended run; if it failed, the first line of its stderr is the reason. */
static void finish (pg_series_result *out, slot *s)
{
    out->code = was_stopped (s->child.code) ? PG_EXIT_INTERRUPTED : s->child.code;
    if (out->code == PG_EXIT_INTERRUPTED) snprintf (out->trouble, sizeof out->trouble, "interrupted");
    else if (out->code != PG_EXIT_DONE) {
        pg_process_complaint (s->log, out->trouble, sizeof out->trouble);
        if (!out->trouble[0] && out->code == 128 + SIGKILL)
            snprintf (out->trouble, sizeof out->trouble, "killed from outside, most likely for memory");
        else if (!out->trouble[0])
            snprintf (out->trouble, sizeof out->trouble, "ended with code %d", out->code);
    }
    if (out->code == PG_EXIT_DONE || out->code == PG_EXIT_INTERRUPTED) remove (s->log);
    read_report (out, s->folder);
}

/* Prints a line for a run that has ended, its name in a column as wide as the longest name. */
static void tell (const pg_series_request *q, size_t k, const pg_series_result *r)
{
    char peak[64] = "no peak";
    FILE *out = q->out;
    const char *name = q->run[k].name;
    int wide = 20;
    for (size_t i = 0; i < q->n; i++) wide = (int) fmax (wide, (double) strlen (q->run[i].name));
    if (!isnan (r->peak)) pg_picture_quantity (r->peak, "N", peak, sizeof peak);
    if (r->code == PG_EXIT_INTERRUPTED) fprintf (out, "  %-*s  interrupted\n", wide, name);
    else if (r->code != PG_EXIT_DONE) fprintf (out, "  %-*s  failed: %s\n", wide, name, r->trouble);
    else fprintf (out, "  %-*s  %s%s\n", wide, name, peak, r->again ? " (was there, or went on)" : "");
    fflush (out);
}

/* ---- many runs ----------------------------------------------------------------------------------------- */
/* State of a series: the slots, number of slots in use, next run, number of signals that have been passed on,
 * and the first failure with its message. */
typedef struct {
    const pg_series_request *q;
    pg_series_result *out;
    slot  *slot;
    size_t slots, busy, next;
    int    passed;
    pg_status status;
    char   failure[8192];
} series;

/* Ends the series after a failure; the first one is reported, and the other runs are asked to stop. */
static void give_up (series *s, pg_status status)
{
    if (s->status != PG_OK) return;
    s->status = status;
    snprintf (s->failure, sizeof s->failure, "%s", pg_last_error ());
    for (size_t i = 0; i < s->slots; i++) pg_child_signal (&s->slot[i].child, SIGINT);
}

/* 1: no more runs shall begin. Signals that came since the last call are passed on, each once. */
static int is_stopping (series *s)
{
    int asked = s->q->stop ? *s->q->stop : 0;
    for (; s->passed < asked; s->passed++)
        for (size_t i = 0; i < s->slots; i++) pg_child_signal (&s->slot[i].child, SIGINT);
    return asked || s->status != PG_OK;
}

/* Concludes run k: prints its line, and calls the caller's function `ended`. */
static pg_status conclude (series *s, size_t k)
{
    pg_status status = PG_OK;
    const pg_series_request *q = s->q;
    pg_series_result *r = &s->out[k];
    if (q->out) tell (q, k, r);
    if (q->ended) PG_TRY (q->ended (q->context, k));
done:
    return status;
}

/* Takes the results of run k if it is finished already; a finished run of another scene is reported and left
 * alone. */
static pg_status take_finished (series *s, size_t k, int *taken)
{
    pg_status status = PG_OK;
    const pg_series_run *run = &s->q->run[k];
    pg_series_result *r = &s->out[k];
    char folder[FOLDER];
    int found = 0;
    *taken = 1;
    PG_TRY (name_folder (folder, s->q, run));
    r->again = exists (folder, "report.json") || exists (folder, "checkpoint.nc");
    PG_TRY (pg_series_look (&found, s->q, run));
    *taken = found != 0;
    if (!found) goto done;
    r->code = found > 0 ? PG_EXIT_DONE : PG_EXIT_USAGE;
    if (found > 0) read_report (r, folder);
    else
        snprintf (r->trouble, sizeof r->trouble,
                  "%.200s holds a finished run of another scene or of other values: remove it, or choose "
                  "another folder (-o)", folder);
    PG_TRY (conclude (s, k));
done:
    return status;
}

/* Starts runs in free slots; finished runs, which need no process, are taken at once. */
static pg_status start_more (series *s)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < s->slots && s->next < s->q->n; ) {
        int taken = 0;
        if (is_stopping (s)) break;
        if (s->slot[i].child.id) {
            i++;
            continue;
        }
        PG_TRY (take_finished (s, s->next, &taken));
        if (!taken) {
            PG_TRY (start (&s->slot[i], s->q, s->next, 0));
            s->busy++;
        }
        s->next++;
    }
done:
    return status;
}

/* Takes the runs that have ended; returns their number. */
static size_t collect (series *s)
{
    size_t n = 0;
    for (size_t i = 0; i < s->slots; i++) {
        slot *at = &s->slot[i];
        if (!at->child.id || !pg_child_ended (&at->child)) continue;
        n++, s->busy--;
        finish (&s->out[at->k], at);
        pg_status status = conclude (s, at->k);
        if (status != PG_OK) give_up (s, status);
    }
    return n;
}

/* Waits for less than a twentieth of a second, at first much less, since small runs are over soon. */
static void rest (unsigned *turn)
{
    struct timespec t = { 0, *turn < 20 ? 2000000L : 40000000L };
    ++*turn;
    nanosleep (&t, NULL);
}

static size_t slots_of (const pg_series_request *q)
{
    size_t jobs = (size_t) (q->jobs < 1 ? 1 : q->jobs > JOBS ? JOBS : q->jobs);
    return jobs > q->n ? (q->n ? q->n : 1) : jobs;
}

pg_status pg_series_run_all (pg_series_result *out, const pg_series_request *q)
{
    pg_status status = PG_OK;
    series s = { .q = q, .out = out, .slots = slots_of (q) };
    unsigned turn = 0;
    int interrupted = 0;
    PG_TRY (pg_folder_make (q->folder));
    PG_ALLOC (s.slot, s.slots);
    for (size_t k = 0; k < q->n; k++)
        out[k] = (pg_series_result) { .code = -1, .peak = NAN, .displacement = NAN, .dissipated = NAN,
                                      .broken = NAN, .seconds = NAN };
    do {
        pg_status begun = start_more (&s);
        if (begun != PG_OK) give_up (&s, begun);
        if (collect (&s) > 0) turn = 0;
        else if (s.busy) rest (&turn);
    } while (s.busy || (s.next < q->n && !is_stopping (&s)));
    if (s.status != PG_OK) PG_FAIL (s.status, "%s", s.failure);
    for (size_t k = 0; k < q->n; k++) interrupted += out[k].code == PG_EXIT_INTERRUPTED || out[k].code < 0;
    if (interrupted)
        PG_FAIL (PG_E_INTERRUPTED, "interrupted: %d of %zu runs are not finished", interrupted, q->n);
done:
    pg_free (s.slot);
    return status;
}

/* ---- checks -------------------------------------------------------------------------------------------- */
/* Fails with the whole message of the check of run k, if it failed. Its file is removed. */
static pg_status verdict (const slot *s, const pg_series_request *q)
{
    pg_status status = PG_OK;
    char *text = read_text (s->log);
    int code = s->child.code;
    remove (s->log);
    if (was_stopped (code)) PG_FAIL (PG_E_INTERRUPTED, "interrupted before the first run");
    if (code != PG_EXIT_DONE) {
        char *end = text ? text + strlen (text) : NULL;
        while (end && end > text && end[-1] == '\n') *--end = 0;
        PG_FAIL (code == PG_EXIT_SCENE || code == PG_EXIT_USAGE ? PG_E_SCENE : PG_E_LIMIT,
                 "%s\n%s: this combination does not pass `perigal check`; no run was started",
                 text && *text ? text : "the check ended without a word", q->run[s->k].name);
    }
done:
    pg_free (text);
    return status;
}

/* Starts the check of the next run, unless the run is finished or can be continued: then a file left by the
 * killed check of an earlier command is removed. */
static pg_status check_next (series *s, slot *at)
{
    pg_status status = PG_OK;
    const pg_series_run *run = &s->q->run[s->next];
    char folder[FOLDER], left[FOLDER + 8];
    int held = 0;
    PG_TRY (name_folder (folder, s->q, run));
    PG_TRY (pg_series_look (&held, s->q, run));
    snprintf (left, sizeof left, "%s.check", folder);
    if (held || exists (folder, "checkpoint.nc")) remove (left);
    else {
        PG_TRY (start (at, s->q, s->next, 1));
        s->busy++;
    }
done:
    s->next++;
    return status;
}

/* Takes checks that have ended and starts more in free slots; returns how many of both. */
static size_t check_more (series *s)
{
    size_t n = 0;
    for (size_t i = 0; i < s->slots; i++) {
        slot *at = &s->slot[i];
        pg_status found = PG_OK;
        if (at->child.id && pg_child_ended (&at->child)) n++, s->busy--, found = verdict (at, s->q);
        if (found != PG_OK) give_up (s, found);
        if (at->child.id || s->next >= s->q->n || is_stopping (s)) continue;
        n++, found = check_next (s, at);
        if (found != PG_OK) give_up (s, found);
    }
    return n;
}

pg_status pg_series_check (const pg_series_request *q)
{
    pg_status status = PG_OK;
    series s = { .q = q, .slots = slots_of (q) };
    unsigned turn = 0;
    PG_TRY (pg_folder_make (q->folder));
    PG_ALLOC (s.slot, s.slots);
    while (s.busy || (s.next < q->n && !is_stopping (&s))) {
        if (check_more (&s)) turn = 0;
        else rest (&turn);
    }
    if (s.status != PG_OK) PG_FAIL (s.status, "%s", s.failure);
    if (q->stop && *q->stop) PG_FAIL (PG_E_INTERRUPTED, "interrupted before the first run");
done:
    pg_free (s.slot);
    return status;
}
