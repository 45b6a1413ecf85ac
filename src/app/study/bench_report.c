/* SPDX-License-Identifier: GPL-3.0-or-later
 * The files of a benchmark: bench.csv with all numbers, pictures of error over CPU seconds and over unknowns;
 * and the CPU seconds at equal error, interpolated in logarithms between the sizes of a curve. */
#include "perigal/picture.h"
#include "bench.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Columns of text before the numbers, all columns, and the largest number of curves in a
 * picture. */
enum { FIRST = 8, COLUMNS = FIRST + PG_TRIAL_COUNT + 4, CURVES = 10 };

/* Error by which a case is ranked: over the body, or else on the lines of its reference. */
static double error_of (const pg_bench_case *c)
{
    double l2 = c->best.value[PG_TRIAL_L2];
    return isnan (l2) ? c->best.value[PG_TRIAL_LINES] : l2;
}

/* Least, median and largest CPU seconds of the repeats of a case; NAN if none came to an end. */
void pg_bench_spread (const pg_bench_case *c, double *least, double *median, double *largest)
{
    double sorted[PG_BENCH_REPEATS];
    size_t n = (size_t) (c->runs < PG_BENCH_REPEATS ? c->runs : PG_BENCH_REPEATS);
    *least = *median = *largest = NAN;
    if (n == 0) return;
    memcpy (sorted, c->cpu, n * sizeof *sorted);
    pg_sort (sorted, n, sizeof *sorted, pg_ascending_numbers);
    *least = sorted[0], *largest = sorted[n - 1];
    *median = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
}

/* Numbers of a row, after its words: those of the best run, median and largest CPU seconds, number of
 * runs. */
enum { MEDIAN = PG_TRIAL_COUNT, LARGEST, RUNS, NUMBERS };

/* Names of the columns of words, and the override "key=" of a case from which a column takes its value. */
static const char *const words[FIRST] = { "case",  "method",  "approximation", "integration",
                                          "basis", "perturb", "cells",         "fem" };
static const char *const word_key[FIRST] = { [2] = "method.approximation=", [3] = "method.integration=",
                                             [4] = "method.basis=" };

/* Finds the words of a row; a catalogue entry that a case overrides stands in its own column. */
static void fill_words (const pg_bench_case *c, const char *cell[FIRST])
{
    const char *fixed[FIRST] = { c->name, c->method,  "",       "",
                                 "",      c->perturb, c->cells, c->fem ? c->element : "" };
    for (int k = 0; k < FIRST; k++) {
        cell[k] = fixed[k];
        for (size_t s = 0; word_key[k] && s < c->nset; s++)
            if (strncmp (c->set[s], word_key[k], strlen (word_key[k])) == 0)
                cell[k] = c->set[s] + strlen (word_key[k]);
    }
}

/* Writes the numbers of a row as text; unknown ones stay empty. */
static void fill_numbers (const pg_bench_case *c, char number[NUMBERS][32])
{
    double value[NUMBERS], least;
    memcpy (value, c->best.value, sizeof c->best.value);
    pg_bench_spread (c, &least, &value[MEDIAN], &value[LARGEST]);
    value[RUNS] = c->runs;
    for (int k = 0; k < NUMBERS; k++) {
        number[k][0] = 0;                              /* empty: not known */
        if (!isnan (value[k])) snprintf (number[k], sizeof *number, "%.8g", value[k]);
    }
}

/* Writes bench.csv, one row per case; the words for the method come from its overrides. */
static pg_status write_table (const pg_bench_cases *cases, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    char title[COLUMNS][64], number[NUMBERS][32], path[4096];
    const char *column[COLUMNS], *cell[COLUMNS];
    pg_table *table = NULL;
    for (int k = 0; k < COLUMNS; k++) column[k] = title[k];
    for (int k = 0; k < FIRST; k++) snprintf (title[k], sizeof *title, "%s [name]", words[k]);
    for (int k = 0; k < PG_TRIAL_COUNT; k++)
        snprintf (title[FIRST + k], sizeof *title, "%s [%s]", pg_trial_name[k], pg_trial_unit[k]);
    snprintf (title[FIRST + MEDIAN], sizeof *title, "cpu_median [s]");
    snprintf (title[FIRST + LARGEST], sizeof *title, "cpu_largest [s]");
    snprintf (title[FIRST + RUNS], sizeof *title, "runs [1]");
    snprintf (title[FIRST + NUMBERS], sizeof *title, "outcome [name]");
    snprintf (path, sizeof path, "%s/bench.csv", q->folder);
    PG_TRY (pg_table_create (&table, path, COLUMNS, column));
    for (size_t i = 0; i < cases->n; i++) {
        const pg_bench_case *c = &cases->at[i];
        fill_words (c, cell);
        fill_numbers (c, number);
        for (int k = 0; k < NUMBERS; k++) cell[FIRST + k] = number[k];
        cell[FIRST + NUMBERS] = c->trouble[0] ? c->trouble : "done";
        PG_TRY (pg_table_line (table, cell));
    }
done:
    pg_table_close (&table);
    return status;
}

/* ---- curves -------------------------------------------------------------------------------------------- */
/* A curve of a picture: cost x and error y. */
typedef struct { size_t n, cap; double *x, *y; const char *name; int fem; } curve;

/* Makes a curve from the cases that came to an end with an error above zero, in their order; `over` is the
 * index of the trial's number that counts as cost. */
static pg_status curve_of (curve *out, const pg_bench_cases *cases, const char *group, size_t id, int over)
{
    pg_status status = PG_OK;
    size_t cap = 0;
    memset (out, 0, sizeof *out);
    for (size_t i = 0; i < cases->n; i++) {
        const pg_bench_case *c = &cases->at[i];
        if (strcmp (c->group, group) != 0 || c->curve != id || !c->runs || !(error_of (c) > 0)
            || !(c->best.value[over] > 0))
            continue;
        PG_GROW (out->x, out->cap, out->n + 1);
        PG_GROW (out->y, cap, out->n + 1);
        out->x[out->n] = c->best.value[over], out->y[out->n++] = error_of (c);
        out->name = c->method, out->fem = c->fem;
    }
done:
    return status;
}

/* Frees n curves. */
static void curves_free (curve **list, size_t n)
{
    for (size_t k = 0; *list && k < n; k++) pg_free ((*list)[k].x), pg_free ((*list)[k].y);
    pg_free (*list), *list = NULL;
}

/* Makes all curves of a group. */
static pg_status curves_of (curve **out, size_t *n, const pg_bench_cases *cases, const char *group, int over)
{
    pg_status status = PG_OK;
    *n = 0;
    PG_ALLOC (*out, cases->ncurve + 1);
    for (size_t id = 0; id < cases->ncurve; id++) {
        PG_TRY (curve_of (&(*out)[*n], cases, group, id, over));
        if ((*out)[*n].n) ++*n;
    }
done:
    return status;
}

/* Keeps the curves of CalculiX and those with the least product of error and cost, at most `most`; the others
 * are freed. */
static void thin_out (curve *list, size_t *n, size_t most)
{
    while (*n > most) {
        size_t worst = 0;
        double highest = 0;
        for (size_t k = 0; k < *n; k++) {
            double least = list[k].fem ? 0 : INFINITY;
            for (size_t i = 0; i < list[k].n; i++) least = fmin (least, list[k].x[i] * list[k].y[i]);
            if (least >= highest) highest = least, worst = k;
        }
        pg_free (list[worst].x), pg_free (list[worst].y);
        --*n;
        memmove (list + worst, list + worst + 1, (*n - worst) * sizeof *list);
    }
}

/* Draws one picture for a group, over CPU seconds or unknowns; alone = 1: its file name needs no group. The
 * title says if curves were left out. */
static pg_status draw (const pg_bench_cases *cases, const pg_bench_request *q, const char *name, int alone,
                       int over)
{
    pg_status status = PG_OK;
    curve *list = NULL;
    pg_curve *lines = NULL;
    size_t n = 0, all;
    char path[4096], suffix[80] = "", title[128];
    pg_chart_style style = {
        .title = title, .xlabel = over == PG_TRIAL_CPU ? "CPU seconds" : "unknowns", .logx = 1, .logy = 1
    };
    style.ylabel = "relative L^{2} error of the displacement";
    for (size_t i = 0; i < cases->n; i++)
        if (strcmp (cases->at[i].group, name) == 0 && cases->at[i].runs
            && isnan (cases->at[i].best.value[PG_TRIAL_L2]))
            style.ylabel = "relative error of the displacement on the lines";
    if (!alone) snprintf (suffix, sizeof suffix, "_%s", name);
    PG_TRY (curves_of (&list, &n, cases, name, over));
    if (!n) goto done;
    all = n;
    thin_out (list, &n, CURVES);
    snprintf (title, sizeof title, "%s", name);
    if (n < all) snprintf (title, sizeof title, "%s, the best %zu of %zu curves", name, n, all);
    PG_ALLOC (lines, n);
    for (size_t k = 0; k < n; k++)
        lines[k] = (pg_curve){
            .name = list[k].name, .n = list[k].n, .x = list[k].x, .y = list[k].y, .points = PG_CURVE_BOTH
        };
    snprintf (path, sizeof path, "%s/%s%s.png", q->folder, over == PG_TRIAL_CPU ? "time_error" : "dofs_error",
              suffix);
    PG_TRY (pg_picture_chart (path, n, lines, &style));
    if (q->out) fprintf (q->out, "  picture %s\n", path);
done:
    pg_free (lines);
    curves_free (&list, n);
    return status;
}

/* Least CPU seconds with which a curve reaches the error: at a size whose error is small enough, or
 * interpolated between two sizes; *name: name of the curve. INFINITY if none does. */
static double cheapest (const curve *list, size_t n, int fem, double error, const char **name)
{
    double least = INFINITY;
    for (size_t k = 0; k < n; k++) {
        if (list[k].fem != fem) continue;
        double s = pg_loglog_at (list[k].n, list[k].y, list[k].x, error);
        for (size_t i = 0; i < list[k].n; i++)
            if (list[k].y[i] <= error && !(s <= list[k].x[i])) s = list[k].x[i];
        if (s < least) least = s, *name = list[k].name;
    }
    return least;
}

/* Prints the CPU seconds of both programs at three levels of error, and their ratio. */
static pg_status print_ratios (const pg_bench_cases *cases, const pg_bench_request *q, const char *name)
{
    pg_status status = PG_OK;
    static const double level[] = { 1e-3, 1e-4, 1e-5 };
    curve *list = NULL;
    size_t n = 0;
    PG_TRY (curves_of (&list, &n, cases, name, PG_TRIAL_CPU));
    fprintf (q->out, "%s: least CPU seconds that reach an error (between sizes log-log)\n", name);
    for (size_t k = 0; k < sizeof level / sizeof *level; k++) {
        const char *ours = "", *theirs = "";
        double a = cheapest (list, n, 0, level[k], &ours), b = cheapest (list, n, 1, level[k], &theirs);
        fprintf (q->out, "  L2 %.0e: ", level[k]);
        if (isfinite (a)) fprintf (q->out, "perigal %.3g s (%s)", a, ours);
        else fprintf (q->out, "perigal: not reached");
        if (isfinite (b)) fprintf (q->out, ", ccx %.3g s (%s)", b, theirs);
        if (isfinite (a) && isfinite (b)) fprintf (q->out, ", perigal / ccx = %.3g", a / b);
        fputc ('\n', q->out);
    }
done:
    curves_free (&list, n);
    return status;
}

/* Returns the group of a scene if the scene is the first of the group, else NULL. */
static const char *group_of (const pg_bench_cases *cases, size_t scene)
{
    const char *name = NULL;
    for (size_t i = 0; i < cases->n && !name; i++) if (cases->at[i].scene == scene) name = cases->at[i].group;
    for (size_t i = 0; i < cases->n && name; i++)
        if (cases->at[i].scene < scene && strcmp (cases->at[i].group, name) == 0) name = NULL;
    return name;
}

/* Writes table and pictures; if there are several groups their names are part of the file names. */
pg_status pg_bench_report (const pg_bench_cases *cases, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    PG_TRY (write_table (cases, q));
    if (q->out) fprintf (q->out, "  table %s/bench.csv\n", q->folder);
    int groups = 0;
    for (size_t s = 0; s < q->nscene; s++) groups += group_of (cases, s) != NULL;
    for (size_t s = 0; s < q->nscene; s++) {
        const char *name = group_of (cases, s);
        if (!name) continue;
        PG_TRY (draw (cases, q, name, groups == 1, PG_TRIAL_CPU));
        PG_TRY (draw (cases, q, name, groups == 1, PG_TRIAL_DOFS));
        if (q->out) PG_TRY (print_ratios (cases, q, name));
    }
done:
    return status;
}
