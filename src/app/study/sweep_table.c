/* SPDX-License-Identifier: GPL-3.0-or-later
 * sweep.csv: one row a run: its number, the values of the keys, the quantities, warnings, seconds, and then
 * words: values that are no numbers, how the run ended, its folder, the reason of a failure. */
#include "sweep.h"
#include <errno.h>
#include <math.h>
#include <string.h>

/* Numbers of report.json: name, unit, block, key. */
#define REPORTED(X) \
    X ("peak", "N", "peak", "force") X ("displacement", "m", "peak", "displacement") \
    X ("load_factor", "1", "peak", "load_factor") X ("energy_strain", "J", "energy", "strain") \
    X ("energy_kinetic", "J", "energy", "kinetic") X ("energy_external", "J", "energy", "external") \
    X ("energy_damping", "J", "energy", "damping") X ("energy_dissipated", "J", "energy", "dissipated") \
    X ("broken", "1", NULL, "broken") X ("events", "1", NULL, "events") X ("steps", "1", NULL, "steps") \
    X ("crack_length", "m", NULL, "crack_length") X ("fragments", "1", NULL, "fragments") \
    X ("points", "1", NULL, "points") X ("dofs", "1", NULL, "dofs") \
    X ("memory", "B", NULL, "peak_bytes") X ("seconds", "s", "seconds", "total")
static const struct { const char *name, *unit, *block, *key; } reported[] = {
#define X(name, unit, block, key) { name, unit, block, key },
    REPORTED (X)
#undef X
};
#define X(name, unit, block, key) name "|"
const char pg_sweep_report_names[] = REPORTED (X) "";
#undef X
enum { REPORTS = sizeof reported / sizeof *reported };

/* The default columns, to which gauges are added. */
static const char *const usual[] = { "peak", "displacement", "load_factor", "energy_strain", "energy_kinetic",
                                     "energy_external", "energy_dissipated", "broken", "events" };

/* ---- columns ---------------------------------------------------------------------------------------- */
/* Splits the name of a column of history.csv at its colon, "top.force_y:max"; without a colon the last value
 * counts. */
static pg_status column_of_history (sweep_column *c, const char *text)
{
    pg_status status = PG_OK;
    static const char *const how[] = { "last", "first", "min", "max", "peak" };
    const char *colon = strrchr (text, ':');
    size_t n = colon ? (size_t) (colon - text) : strlen (text);
    if (n == 0 || n >= sizeof c->column)
        PG_FAIL (PG_E_USAGE, "--quantity %.200s: a name of at most %zu letters is needed", text,
                 sizeof c->column - 1);
    snprintf (c->column, sizeof c->column, "%.*s", (int) n, text);
    for (c->which = 0; colon && c->which < 5 && strcmp (colon + 1, how[c->which]) != 0;) c->which++;
    if (c->which == 5)
        PG_FAIL (PG_E_USAGE, "--quantity %.200s: behind a colon one of last, first, min, max, peak is needed",
                 text);
done:
    return status;
}

static pg_status add_column (sweep *s, size_t *capacity, const char *text)
{
    pg_status status = PG_OK;
    PG_GROW (s->column, *capacity, s->ncolumn + 1);
    sweep_column *c = &s->column[s->ncolumn];
    *c = (sweep_column) { .which = 0 };
    snprintf (c->name, sizeof c->name, "%.127s", text);
    for (size_t k = 0; k < REPORTS; k++)
        if (strcmp (text, reported[k].name) == 0) {
            c->block = reported[k].block, c->key = reported[k].key;
            snprintf (c->unit, sizeof c->unit, "%s", reported[k].unit);
        }
    if (!c->key) PG_TRY (column_of_history (c, text));
    s->ncolumn++;
done:
    return status;
}

/* Adds the gauges of the scene: their last opening and that at the peak. If a key of the sweep changes them,
 * those of the first run count. A wrong scene is reported elsewhere. */
static pg_status add_gauges (sweep *s, size_t *capacity)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    if (pg_scene_load_with (&scene, s->q->scene, s->run[0].nset, s->run[0].set) != PG_OK) return PG_OK;
    for (size_t g = 0; g < pg_scene_count (scene, "output.gauges"); g++) {
        char text[128];
        const char *name = pg_scene_text (scene, "output.gauges[%zu].name", g);
        if (!name || strlen (name) > 100) continue;
        PG_TRY (add_column (s, capacity, name));
        snprintf (text, sizeof text, "%.100s:peak", name);
        PG_TRY (add_column (s, capacity, text));
        for (int k = 1; k <= 2; k++) snprintf (s->column[s->ncolumn - (size_t) k].unit, 8, "m");
    }
done:
    pg_scene_free (&scene);
    return status;
}

pg_status pg_sweep_columns (sweep *s)
{
    pg_status status = PG_OK;
    size_t capacity = 0;
    for (size_t k = 0; k < s->q->nquantity; k++) {
        PG_TRY (add_column (s, &capacity, s->q->quantity[k]));
        for (size_t j = 0; j < k; j++)
            if (strcmp (s->column[j].name, s->column[k].name) == 0)
                PG_FAIL (PG_E_USAGE, "--quantity %s: it is there twice", s->column[k].name);
    }
    for (size_t k = 0; !s->q->nquantity && k < sizeof usual / sizeof *usual; k++)
        PG_TRY (add_column (s, &capacity, usual[k]));
    if (!s->q->nquantity) PG_TRY (add_gauges (s, &capacity));
    PG_ALLOC (s->value, s->n * s->ncolumn);
    for (size_t k = 0; k < s->n * s->ncolumn; k++) s->value[k] = NAN;
done:
    return status;
}

/* ---- numbers of a run ------------------------------------------------------------------------------- */
/* Finds the value of a column that `which` asks for; peak: number of the step of the peak. */
static double value_of (const pg_csv *csv, size_t column, int which, double peak)
{
    double found = NAN;
    long step = pg_csv_column (csv, "step");
    for (size_t r = 0; r < csv->nrow; r++) {
        double v = csv->value[r * csv->ncolumn + column];
        if (which == SWEEP_AT_PEAK) {
            if (step >= 0 && csv->value[r * csv->ncolumn + (size_t) step] == peak) found = v;
            continue;
        }
        if (isnan (v) || (which == SWEEP_FIRST && !isnan (found))) continue;
        if (which == SWEEP_LEAST) found = isnan (found) ? v : fmin (found, v);
        else if (which == SWEEP_LARGEST) found = isnan (found) ? v : fmax (found, v);
        else found = v;
    }
    return found;
}

/* Copies the unit of a heading, "N" of "top.force_y [N]". */
static void unit_of (const char *head, char *out, size_t size)
{
    const char *open = strrchr (head, '[');
    size_t n = open ? strcspn (open + 1, "]") : 0;
    if (open) snprintf (out, size, "%.*s", (int) n, open + 1);
}

/* Fails since a finished run has no column of that name; the message lists the columns that there are. */
static pg_status unknown_column (const sweep_column *c, const pg_csv *csv, const char *folder,
                                 const char *run)
{
    pg_status status = PG_OK;
    char names[4000] = "";
    snprintf (names, sizeof names, "%s", pg_sweep_report_names);
    for (size_t k = 0; k < csv->ncolumn; k++) {
        size_t n = strlen (names);
        snprintf (names + n, sizeof names - n, "%.*s|", (int) pg_csv_name (csv->name[k]), csv->name[k]);
    }
    const char *near = pg_nearest_name (c->column, names);
    PG_FAIL (PG_E_USAGE,
             "--quantity %s: %s/%s/history.csv has no such column%s%s%s; what is finished is kept: correct "
             "it and go on with --resume",
             c->name, folder, run,
             near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
done:
    return status;
}

/* Number of warnings in a report; NAN without a list. */
static double count_warnings (const char *report)
{
    const char *at = report ? strstr (report, "\"warnings\": [") : NULL;
    double n = 0;
    if (!at) return NAN;
    for (at = strchr (at, '['); *++at && *at != ']';)
        if (*at == '"') {
            for (n++, at++; *at && *at != '"'; at++) at += *at == '\\' && at[1];
            if (!*at) break;
        }
    return n;
}

/* Reads the results of run k; missing ones, as of a run that was interrupted before its first step, stay
 * empty. */
pg_status pg_sweep_take (sweep *s, size_t k)
{
    pg_status status = PG_OK;
    pg_csv csv = { 0 };
    char folder[4096], path[4200];
    double *value = s->value + k * s->ncolumn;
    snprintf (folder, sizeof folder, "%s/%s", s->q->folder, s->run[k].name);
    snprintf (path, sizeof path, "%s/history.csv", folder);
    char *report = pg_report_load (folder);
    double peak = pg_report_number (report, "peak", "step");
    int there = pg_csv_read (&csv, path) == PG_OK && csv.nrow > 0, done = s->result[k].code == PG_EXIT_DONE;
    s->warnings[k] = count_warnings (report);
    for (size_t c = 0; c < s->ncolumn; c++) {
        sweep_column *column = &s->column[c];
        long at = there && !column->key ? pg_csv_column (&csv, column->column) : -1;
        if (column->key) value[c] = pg_report_number (report, column->block, column->key);
        else if (at >= 0) {
            value[c] = value_of (&csv, (size_t) at, column->which, peak);
            unit_of (csv.name[at], column->unit, sizeof column->unit);
        } else if (there && done && !s->seen)
            PG_TRY (unknown_column (column, &csv, s->q->folder, s->run[k].name));
    }
    s->seen |= there && done;
done:
    pg_csv_clear (&csv);
    pg_free (report);
    return status;
}

/* ---- the table -------------------------------------------------------------------------------------- */
/* Writes a text as a cell, in quotes if it holds a comma, a quote or a line's end. */
static void put_text (FILE *f, const char *text)
{
    if (!text[strcspn (text, ",\"\r\n")]) {
        fprintf (f, ",%s", text);
        return;
    }
    fputs (",\"", f);
    for (; *text; text++) fprintf (f, *text == '"' ? "\"\"" : "%c", *text == '\n' ? ' ' : *text);
    fputc ('"', f);
}

/* Writes a number as a cell, empty if it is not known. */
static void put_number (FILE *f, double x)
{
    if (isfinite (x)) fprintf (f, ",%.17g", x);
    else fputc (',', f);
}

/* 1: seconds are among the columns that were asked for; if not they follow these. */
static int names_seconds (const sweep *s)
{
    int named = 0;
    for (size_t c = 0; c < s->ncolumn; c++) named |= strcmp (s->column[c].name, "seconds") == 0;
    return named;
}

static void put_head (FILE *f, const sweep *s)
{
    char head[SWEEP_HEAD + 300];
    fputs ("number [1]", f);
    for (size_t k = 0; k < s->nkey; k++) {
        const sweep_key *key = &s->key[k];
        if (!key->numeric) continue;
        snprintf (head, sizeof head, "%s%s%s%s", key->label, *key->unit ? " [" : "", key->unit,
                  *key->unit ? "]" : "");
        put_text (f, head);
    }
    for (size_t c = 0; c < s->ncolumn; c++) {
        const char *unit = s->column[c].unit;
        snprintf (head, sizeof head, "%s%s%s%s", s->column[c].name, *unit ? " [" : "", unit,
                  *unit ? "]" : "");
        put_text (f, head);
    }
    fputs (names_seconds (s) ? ",warnings [1]" : ",warnings [1],seconds [s]", f);
    for (size_t k = 0; k < s->nkey; k++)
        if (!s->key[k].numeric) {
            snprintf (head, sizeof head, "%s [name]", s->key[k].label);
            put_text (f, head);
        }
    fputs (",status [name],folder [name],trouble [name]\n", f);
}

static const char *word_of (int code)
{
    return code < 0 ? "waiting" : code == PG_EXIT_DONE ? "done" : code == PG_EXIT_INTERRUPTED ? "interrupted"
                                                                                          : "failed";
}

static void put_row (FILE *f, const sweep *s, size_t i)
{
    const pg_series_result *r = &s->result[i];
    const size_t *at = s->index + i * s->nkey;
    fprintf (f, "%zu", i + 1);
    for (size_t k = 0; k < s->nkey; k++) if (s->key[k].numeric) put_number (f, s->key[k].number[at[k]]);
    for (size_t c = 0; c < s->ncolumn; c++) put_number (f, s->value[i * s->ncolumn + c]);
    put_number (f, s->warnings[i]);
    if (!names_seconds (s)) put_number (f, r->code < 0 ? NAN : r->seconds);
    for (size_t k = 0; k < s->nkey; k++) if (!s->key[k].numeric) put_text (f, s->key[k].word[at[k]]);
    put_text (f, word_of (r->code)), put_text (f, s->run[i].name), put_text (f, r->trouble);
    fputc ('\n', f);
}

/* Writes sweep.csv under another name and renames it, so that the table is complete at any instant. */
pg_status pg_sweep_write (const sweep *s)
{
    pg_status status = PG_OK;
    char path[4096], beside[4200];
    FILE *f = NULL;
    snprintf (path, sizeof path, "%s/sweep.csv", s->q->folder);
    snprintf (beside, sizeof beside, "%s.new", path);
    f = fopen (beside, "w");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", beside, strerror (errno));
    put_head (f, s);
    for (size_t i = 0; i < s->n; i++) put_row (f, s, i);
    int bad = ferror (f);
    bad |= fclose (f) != 0;
    f = NULL;
    if (bad || rename (beside, path) != 0)
        PG_FAIL (PG_E_FILE, "%s cannot be written: %s", path, strerror (errno));
done:
    if (f) fclose (f);
    return status;
}
