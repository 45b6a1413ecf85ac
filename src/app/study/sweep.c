/* SPDX-License-Identifier: GPL-3.0-or-later
 * A sweep: one scene with all combinations of some of its values, or (--zip) with their first values
 * together, their second ones and so on. Every combination is checked before the first run begins: keys and
 * values by reading the scene, all of them at once, then everything else by `perigal check`. */
#include "sweep.h"
#include <ctype.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

/* ---- keys and runs ---------------------------------------------------------------------------------- */
/* Sets the labels: keys that end alike keep their whole path, since their short names would be equal. */
static void settle_labels (sweep *s)
{
    for (size_t i = 0; i < s->nkey; i++)
        for (size_t j = 0; j < s->nkey; j++) {
            const char *dot = strrchr (s->key[j].key, '.');
            const char *last = dot && dot[1] ? dot + 1 : s->key[j].key;
            const char *own = strrchr (s->key[i].key, '.');
            if (i != j && strcmp (own && own[1] ? own + 1 : s->key[i].key, last) == 0)
                memcpy (s->key[i].label, s->key[i].key, sizeof s->key[i].label);
        }
}

/* Reads the keys of the sweep; a key with one value is an override of all runs. */
static pg_status read_keys (sweep *s, pg_series_request *all)
{
    pg_status status = PG_OK;
    for (size_t k = 0; k < s->q->nset; k++) {
        sweep_key one;
        PG_TRY (pg_sweep_key_read (&one, s->q->set[k]));
        size_t values = one.n;
        if (values == 1) {
            pg_sweep_key_clear (&one);
            all->set[all->nset++] = s->q->set[k];
            continue;
        }
        for (size_t i = 0; i < s->nkey; i++)
            if (strcmp (s->key[i].key, one.key) == 0) {
                pg_sweep_key_clear (&one);
                PG_FAIL (PG_E_USAGE, "--set %s: this key is there twice; give all its values at once",
                         s->key[i].key);
            }
        if (s->nkey == PG_SERIES_SETS) {
            pg_sweep_key_clear (&one);
            PG_FAIL (PG_E_USAGE, "at most %d keys can have several values", PG_SERIES_SETS);
        }
        s->key[s->nkey++] = one;
    }
    if (s->nkey == 0)
        PG_FAIL (PG_E_USAGE,
                 "no key has several values: give --set KEY=VALUE,VALUE,... or --set KEY=FROM:TO");
    settle_labels (s);
done:
    return status;
}

/* Counts the runs; --zip needs lists of one length. */
static pg_status count_runs (sweep *s)
{
    pg_status status = PG_OK;
    double n = 1;
    for (size_t k = 0; k < s->nkey; k++) {
        n = s->q->zip ? (double) s->key[k].n : n * (double) s->key[k].n;
        if (s->q->zip && s->key[k].n != s->key[0].n)
            PG_FAIL (PG_E_USAGE, "--zip: %s has %zu values and %s has %zu: as many are needed", s->key[0].key,
                     s->key[0].n, s->key[k].key, s->key[k].n);
    }
    if (n > PG_SERIES_RUNS)
        PG_FAIL (PG_E_USAGE, "%.0f combinations are more than %d", n, PG_SERIES_RUNS);
    s->n = (size_t) n;
done:
    return status;
}

/* Appends a text to a name of a folder: letters, digits and . + - = _ stay; blanks are left out, each run of
 * other characters becomes a dash. Returns the length. */
static size_t append_name (char *out, size_t at, size_t size, const char *text)
{
    int dash = 0;
    for (; *text && at + 1 < size; text++) {
        unsigned char c = (unsigned char) *text;
        int kept = isalnum (c) || c >= 0x80 || strchr (".+-=_", c) != NULL;
        if (c == ' ') continue;
        if (!kept) {
            dash = at > 0 && out[at - 1] != '=' && out[at - 1] != '-';
            continue;
        }
        if (dash && at + 2 < size) out[at++] = '-';
        dash = 0, out[at++] = (char) c;
    }
    out[at] = 0;
    return at;
}

/* Names the runs: "spacing=2mm_fracture_energy=20", or "run_0007" where that is too long or equal for two
 * runs. */
static void name_runs (sweep *s)
{
    for (size_t i = 0; i < s->n; i++) {
        pg_series_run *r = &s->run[i];
        char name[1024];
        size_t at = 0;
        for (size_t k = 0; k < s->nkey; k++) {
            if (k) at = append_name (name, at, sizeof name, "_");
            at = append_name (name, at, sizeof name, s->key[k].label);
            at = append_name (name, at, sizeof name, "=");
            at = append_name (name, at, sizeof name, s->key[k].word[s->index[i * s->nkey + k]]);
        }
        int twice = at >= sizeof r->name;
        for (size_t j = 0; j < i; j++) twice |= strcmp (s->run[j].name, name) == 0;
        if (twice) snprintf (r->name, sizeof r->name, "run_%04zu", i + 1);
        else snprintf (r->name, sizeof r->name, "%.95s", name);
    }
}

/* Makes the runs, that is all combinations; the value of the last key changes fastest. */
static pg_status make_runs (sweep *s)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->run, s->n);
    PG_ALLOC (s->index, s->n * s->nkey);
    PG_ALLOC (s->result, s->n);
    PG_ALLOC (s->warnings, s->n);
    for (size_t i = 0; i < s->n; i++) {
        size_t rest = i;
        s->warnings[i] = NAN;
        s->result[i].code = -1;
        s->run[i].nset = s->nkey;
        for (size_t k = s->nkey; k-- > 0;) {
            size_t at = s->q->zip ? i : rest % s->key[k].n;
            rest /= s->key[k].n;
            s->index[i * s->nkey + k] = at, s->run[i].set[k] = s->key[k].setting[at];
        }
    }
    name_runs (s);
done:
    return status;
}

/* ---- before the first run --------------------------------------------------------------------------- */
/* Appends the lines of a message that are not there yet, as far as there is room. */
static void gather (char *all, size_t size, const char *message)
{
    char line[1024];
    for (const char *s = message; *s; s += strcspn (s, "\n"), s += *s == '\n') {
        snprintf (line, sizeof line, "%.*s\n", (int) fmin (1000, (double) strcspn (s, "\n")), s);
        if (!strstr (all, line) && strlen (all) + strlen (line) < size) strcat (all, line);
    }
}

/* Fails for wrong keys and values, of all combinations at once, and for folders that hold another run. */
static pg_status look_at_all (const sweep *s, const pg_series_request *all)
{
    pg_status status = PG_OK, found;
    enum { ROOM = 6000 };
    char *faults = NULL;
    size_t wrong = 0;
    int held;
    PG_ALLOC (faults, ROOM);
    for (size_t k = 0; k < s->n; k++) {
        found = pg_series_look (&held, all, &s->run[k]);
        if (found == PG_E_SCENE) gather (faults, ROOM, pg_last_error ());
        else PG_TRY (found);
        wrong += found == PG_E_SCENE;
        if (found == PG_OK && held < 0)
            PG_FAIL (PG_E_USAGE, "%s/%s holds a finished run of another scene or of other values: remove it, "
                                 "or name another folder with -o", all->folder, s->run[k].name);
    }
    if (wrong)
        PG_FAIL (PG_E_SCENE, "%s%s: %zu of %zu combinations are wrong; no run was started", faults,
                 s->q->scene, wrong, s->n);
done:
    pg_free (faults);
    return status;
}

/* Fails if the folder has a sweep already and --resume was not given. */
static pg_status look_at_folder (const sweep *s)
{
    pg_status status = PG_OK;
    char path[4096];
    if (snprintf (path, sizeof path, "%s/sweep.csv", s->q->folder) >= (int) sizeof path)
        PG_FAIL (PG_E_LIMIT, "%.60s...: the name of the folder is too long", s->q->folder);
    if (!s->q->resume && access (path, F_OK) == 0)
        PG_FAIL (PG_E_USAGE, "%s holds a sweep: --resume goes on with it and keeps what is finished; or name "
                             "another folder with -o", s->q->folder);
done:
    return status;
}

/* ---- the sweep -------------------------------------------------------------------------------------- */
/* Takes the results of a run that has ended; they go into the table at once, so that they are there whatever
 * happens later. */
static pg_status take (void *context, size_t k)
{
    pg_status status = PG_OK;
    sweep *s = context;
    PG_TRY (pg_sweep_take (s, k));
    PG_TRY (pg_sweep_write (s));
done:
    return status;
}

/* Draws sweep.png of the first column, and sweep_NAME.png of others that were asked for. */
static pg_status draw_all (const sweep *s, char *names, size_t size)
{
    pg_status status = PG_OK;
    size_t n = s->q->nquantity > 1 ? s->q->nquantity : 1;
    for (size_t c = 0; c < n && c < s->ncolumn; c++) {
        char path[4096], name[160] = "";
        int drawn = 0;
        append_name (name, 0, sizeof name, s->column[c].name);
        snprintf (path, sizeof path, "%s/sweep%s%s.png", s->q->folder, c ? "_" : "", c ? name : "");
        PG_TRY (pg_sweep_draw (&drawn, s, c, path));
        size_t at = strlen (names);
        if (drawn && at < size) snprintf (names + at, size - at, ", picture %s", path);
    }
done:
    return status;
}

/* Prints the outcome of the sweep, in a line or two, and the files. */
static void tell (const sweep *s, const char *pictures)
{
    size_t done = 0, failed = 0, warned = 0;
    for (size_t k = 0; k < s->n; k++) {
        done += s->result[k].code == PG_EXIT_DONE;
        failed += s->result[k].code > 0 && s->result[k].code != PG_EXIT_INTERRUPTED;
        warned += s->warnings[k] > 0;
    }
    fprintf (s->q->out, "  %zu of %zu runs are done", done, s->n);
    if (failed) fprintf (s->q->out, ", %zu failed", failed);
    if (warned) fprintf (s->q->out, "; %zu have warnings (report.json in their folders)", warned);
    fprintf (s->q->out, "\n  table %s/sweep.csv%s\n", s->q->folder, pictures);
}

static void clear (sweep *s)
{
    for (size_t k = 0; k < s->nkey; k++) pg_sweep_key_clear (&s->key[k]);
    pg_free (s->run), pg_free (s->index), pg_free (s->result), pg_free (s->column), pg_free (s->value);
    pg_free (s->warnings);
    pg_free (s);
}

/* Runs a sweep. Finished runs are reported and drawn even if the rest was interrupted. */
pg_status pg_sweep_run (const pg_sweep_request *q)
{
    pg_status status = PG_OK, outcome = PG_OK;
    sweep *s = NULL;
    pg_series_request *all = NULL;
    char failure[8192] = "", pictures[4 * 4096] = "";
    size_t failed = 0;
    PG_ALLOC (s, 1);
    PG_ALLOC (all, 1);
    s->q = q;
    *all = (pg_series_request) { .scene = q->scene, .folder = q->folder, .threads = q->threads,
                                 .jobs = q->jobs, .memory = q->memory, .stop = q->stop, .ended = take,
                                 .context = s, .out = q->out };
    PG_TRY (look_at_folder (s));
    PG_TRY (read_keys (s, all));
    PG_TRY (count_runs (s));
    PG_TRY (make_runs (s));
    all->n = s->n, all->run = s->run;
    PG_TRY (pg_sweep_columns (s));
    PG_TRY (look_at_all (s, all));
    PG_TRY (pg_series_check (all));
    if (q->out)
        fprintf (q->out, "%s: %zu runs in %s, all combinations are valid\n", q->scene, s->n, q->folder);
    PG_TRY (pg_sweep_write (s));
    outcome = pg_series_run_all (s->result, all);
    if (outcome != PG_OK) snprintf (failure, sizeof failure, "%s", pg_last_error ());
    PG_TRY (pg_sweep_write (s));
    PG_TRY (draw_all (s, pictures, sizeof pictures));
    if (q->out) tell (s, pictures);
    for (size_t k = 0; k < s->n; k++) failed += s->result[k].code > 0;
    if (outcome != PG_OK) PG_FAIL (outcome, "%s", failure);
    if (failed)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "%zu of %zu runs failed: see the column trouble of %s/sweep.csv, and %s/*.log", failed, s->n,
                 q->folder, q->folder);
done:
    if (s) clear (s);
    pg_free (all);
    return status;
}
