/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal plot DIR... --curve X Y: two columns of the history.csv of one or several runs, or of other tables,
 * as a chart. For runs with event stepping the line is the envelope (pg_envelope), with the path of all
 * events pale behind it, where both columns grow with the load; the scene in the folder says whether they
 * do. */
#include "plot.h"
#include "perigal/study.h"
#include "perigal/compare.h"
#include "perigal/model.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Longest cell or label, longest path or list of names, and the largest number of curves in
 * one picture. */
enum { CELL = 256, LIST = 4096, MOST = 24 };

/* What the command line asks for. */
typedef struct {
    const char *directory[MOST], *x, *y, *out;
    /* Text of --labels, cut in place. */
    char   *labels;
    size_t  n;
    /* 1: a marker on every row; logarithmic x, y. */
    int     markers, log[2];
    /* Sign of x and of y. */
    enum { AS_IT_IS, NEGATED, ABSOLUTE } sign[2];
} request;

/* What the scene of a run says of two of its columns. */
typedef struct {
    /* 1: the run starts unloaded, so both columns are 0 there. */
    int at_rest;
    /* 1: static with event stepping, and both columns grow with the load: the path has an
     * envelope. */
    int events;
    /* 1: all loads grow in proportion. */
    int linear;
} run_kind;

/* The curve of one run. */
typedef struct {
    size_t  n;
    /* x, y and load factor of each row (n). */
    double *at[2], *factor;
    /* Labels "name (unit)" of x and y; name in the legend. */
    char    column[2][CELL], name[CELL];
    run_kind kind;
    /* Number of vertices of the line that is drawn (the rows, or their envelope), and coordinates of its
     * peak. */
    size_t  nline;
    double *line[2], peak[2];
    /* Step of the peak that the report of the run names for this y, among rows in which every crack tip was
     * checked; NAN: it names none. step: step of each row (n). */
    double  named, *step;
} run_curve;

/* The help of plot --curve. */
static const char usage[] =
    "usage: perigal plot DIR [DIR...] --curve X Y [--labels A,B,...] [--negate [x|y|xy]] [--abs [x|y|xy]] "
    "[--log x|y|xy] [--markers]\n"
    "                    [--out FILE.png|FILE.svg]\n"
    "Draws columns X and Y of every DIR/history.csv (of DIR itself if it is a .csv file) in one picture. "
    "--negate turns the sign of Y\n"
    "(--negate x: of X, --negate xy: of both), --abs drops it in the same way; step, time and load_factor "
    "stay as they are. Of event\n"
    "stepping the line is the envelope and the path of events thin behind it; peaks are ringed. The\n"
    "legend shows --labels, else the names of the folders. --markers: a marker on every row, and no "
    "envelope.\n";

/* 1 if the path is a table itself, not a folder with history.csv. */
static int is_table (const char *path)
{
    size_t n = strlen (path);
    return n > 4 && strcmp (path + n - 4, ".csv") == 0;
}

/* 1 if `column`, as "name (unit)" or "name [unit]", has that name; units may differ. */
static int is_column (const char *column, const char *wanted)
{
    size_t n = strcspn (column, "[(");
    while (n > 0 && column[n - 1] == ' ') n--;
    return n == strlen (wanted) && strncmp (column, wanted, n) == 0;
}

/* The label of a column for an axis, without a unit where that is 1. */
static void label_of (const char *name, char *label)
{
    snprintf (label, CELL, "%s", name);
    char *open = strrchr (label, '['), *close = strrchr (label, ']');
    if (open && close > open + 1 && strcmp (open, "[1]") != 0) *open = '(', *close = ')';
    else if (open) label[pg_csv_name (label)] = 0;
    /* the unit of stress intensity, "Pa m^(1/2)", with its exponent raised */
    char *power = strstr (label, "^("), *end = power ? strchr (power, ')') : NULL;
    if (end) power[1] = '{', *end = '}';
}

/* Finds a column of a table, and its label. PG_E_USAGE with all names if there is none. */
static pg_status find_column (const char *path, const pg_csv *csv, const char *wanted, long *column,
                              char *label)
{
    pg_status status = PG_OK;
    char all[LIST] = "";
    size_t used = 0;
    *column = pg_csv_column (csv, wanted);
    for (size_t k = 0; *column < 0 && k < csv->ncolumn; k++) {
        int name = (int) pg_csv_name (csv->name[k]);
        if (used + (size_t) name + 2 < sizeof all)
            used +=
                (size_t) snprintf (all + used, sizeof all - used, "%s%.*s", k ? "|" : "", name, csv->name[k]);
    }
    const char *near = *column < 0 ? pg_nearest_name (wanted, all) : NULL;
    if (*column < 0)
        PG_FAIL (PG_E_USAGE, "%s has no column '%s'%s%s%s; it has %s", path, wanted,
                 near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "", all);
    label_of (csv->name[*column], label);
done:
    return status;
}

/* ---- properties of a run, from its scene --------------------------------------------------------------- */
/* 1 if the name of the column is in "a|b|c". */
static int is_one_of (const char *column, const char *list)
{
    char name[CELL];
    snprintf (name, sizeof name, "%.*s", (int) pg_csv_name (column), column);
    return pg_plot_index (name, list) >= 0;
}

/* 1 for columns that need not be 0 without load: damage of pre-cracks and the length of their
 * tips, which are there before any load, and counts of the solver. */
static int starts_elsewhere (const pg_scene *scene, const char *column)
{
    for (size_t i = 0; i < pg_scene_count (scene, "output.tips"); i++)
        if (is_one_of (column, pg_scene_text (scene, "output.tips[%zu].name", i))) return 1;
    for (size_t i = 0; i < pg_scene_count (scene, "output.averages"); i++)
        if (is_one_of (column, pg_scene_text (scene, "output.averages[%zu].name", i))
            && strncmp (pg_scene_text (scene, "output.averages[%zu].field", i), "damage", 6) == 0)
            return 1;
    return is_one_of (column, "iterations|residual|event|level");
}

/* Reads the scene of a run, if there is one; otherwise nothing is known and the rows are drawn
 * as they are. Loads with a ramp or a table of their own are not proportional. */
static void read_kind (run_kind *out, const char *directory, const char *const *wanted)
{
    char path[LIST];
    pg_scene *scene = NULL;
    snprintf (path, sizeof path, "%s/scene.yaml", directory);
    if (is_table (directory) || access (path, R_OK) != 0 || pg_stored_scene (&scene, directory) != PG_OK)
        return;
    const char *kind = pg_scene_text (scene, "solver.kind");
    out->linear = 1;
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++)
        if (pg_scene_given (scene, "boundary[%zu].ramp", i)
            || pg_scene_given (scene, "boundary[%zu].table", i))
            out->linear = 0;
    out->at_rest = pg_solver_is (kind, PG_SOLVER_QUASI_STATIC) && out->linear;
    out->events = pg_solver_is (kind, PG_SOLVER_EVENTS);
    for (int k = 0; k < 2; k++) {
        if (starts_elsewhere (scene, wanted[k])) out->at_rest = out->events = 0;
        /* crack lengths and areas do not belong to the path of load and displacement */
        if (strncmp (wanted[k], "tip.", 4) == 0 || is_one_of (wanted[k], "crack.length|crack.area"))
            out->at_rest = out->events = 0;
        if (is_one_of (
                wanted[k],
                "step|energy_strain|energy_kinetic|energy_external|energy_dissipated|broken|utilisation"))
            out->events = 0;
    }
    pg_scene_free (&scene);
}

/* ---- one run ------------------------------------------------------------------------------------------- */
/* Returns the step of the peak in report.json if `wanted` is the column of forces that the report takes it
 * from (load and axis stand before the peak), else NAN. */
static double named_peak (const char *directory, const char *wanted)
{
    double step = NAN;
    char *text = is_table (directory) ? NULL : pg_report_load (directory);
    const char *curve = text ? strstr (text, "\"curve\": {") : NULL;
    const char *load = curve ? strstr (curve, "\"load\": \"") : NULL;
    const char *axis = load ? strstr (load, "\"component\": \"") : NULL;
    if (axis) {
        char name[CELL];
        load += strlen ("\"load\": \""), axis += strlen ("\"component\": \"");
        snprintf (name, sizeof name, "%.*s.force_%c", (int) strcspn (load, "\""), load, *axis);
        if (strcmp (name, wanted) == 0) step = pg_report_number (text, "peak", "step");
    }
    pg_free (text);
    return step;
}

/* Reads both columns of a run, and its load factors where the table has them (0 otherwise). A
 * table without rows belongs to a run that has just begun. */
static pg_status read_rows (run_curve *c, const char *directory, const char *const *wanted)
{
    pg_status status = PG_OK;
    char table[LIST];
    long column[2], factor, step;
    pg_csv csv = { 0 };
    snprintf (table, sizeof table, "%s%s", directory, is_table (directory) ? "" : "/history.csv");
    PG_TRY (pg_csv_read (&csv, table));
    for (int k = 0; k < 2; k++) PG_TRY (find_column (table, &csv, wanted[k], &column[k], c->column[k]));
    factor = pg_csv_column (&csv, "load_factor"), step = pg_csv_column (&csv, "step");
    c->n = csv.nrow;
    if (c->n == 0) PG_FAIL (PG_E_FILE, "%s has no rows yet", table);
    for (int k = 0; k < 2; k++) PG_ALLOC (c->at[k], c->n);
    PG_ALLOC (c->factor, c->n);
    PG_ALLOC (c->step, c->n);
    for (size_t i = 0; i < c->n; i++) {
        const double *row = csv.value + i * csv.ncolumn;
        for (int k = 0; k < 2; k++) c->at[k][i] = row[column[k]];
        c->factor[i] = factor < 0 ? 0 : row[factor];
        c->step[i] = step < 0 ? NAN : row[step];
    }
done:
    pg_csv_clear (&csv);
    return status;
}

/* Sets the peak: vertex `peak` of the line, or the row of the step that the report names, with largest
 * |y|. */
static void choose_peak (run_curve *c, size_t peak)
{
    size_t row = SIZE_MAX;
    for (size_t i = 0; i < c->n; i++)
        if (c->step[i] == c->named && (row == SIZE_MAX || fabs (c->at[1][i]) > fabs (c->at[1][row]))) row = i;
    for (int k = 0; k < 2; k++) c->peak[k] = row == SIZE_MAX ? c->line[k][peak] : c->at[k][row];
}

/* Makes the line that is drawn: the rows, preceded by the origin if the run starts unloaded; or, of a path of
 * events on which the load factor falls and rises, the envelope. Without such a fall the path is its own
 * envelope. c->peak: point of largest |y|, or among the rows of the step that the report names, if any. */
static pg_status choose_line (const request *q, run_curve *c)
{
    pg_status status = PG_OK;
    int falls = 0;
    size_t peak = 0;
    for (size_t i = 1; i < c->n; i++) falls |= c->factor[i] < c->factor[i - 1];
    c->kind.events &= falls && !q->markers;
    for (int k = 0; k < 2; k++) PG_ALLOC (c->line[k], 2 * c->n + 2);
    if (c->kind.events) {
        c->nline = pg_envelope (c->n, c->at[0], c->at[1], c->kind.linear, c->line[0], c->line[1], &peak);
        choose_peak (c, peak);
        goto done;
    }
    c->nline = (size_t) (c->kind.at_rest && !q->markers);
    for (size_t i = 0; i < c->n; i++)
        c->line[0][c->nline] = c->at[0][i], c->line[1][c->nline++] = c->at[1][i];
    for (size_t i = 0; i < c->nline; i++) if (fabs (c->line[1][i]) > fabs (c->line[1][peak])) peak = i;
    choose_peak (c, peak);
done:
    return status;
}

/* 1 for forces, moments and stresses. */
static int has_peak (const char *column)
{
    size_t n = strlen (column);
    for (const char *u = "(N)\0(N m)\0(Pa)\0"; *u; u += strlen (u) + 1)
        if (n > strlen (u) && strcmp (column + n - strlen (u), u) == 0) return 1;
    return 0;
}

/* Writes a value with the unit of its column, such as "-15.03 MN"; units that take no prefix are written
 * behind the number. */
static void quantity_of (const char *column, double value, char *out, size_t size)
{
    const char *open = strrchr (column, '(');
    char unit[32] = "";
    if (open) snprintf (unit, sizeof unit, "%.*s", (int) strcspn (open + 1, ")"), open + 1);
    if (*unit && strchr ("NmPJ", *unit)) pg_picture_quantity (value, unit, out, size);
    else snprintf (out, size, "%.4g%s%s", value, *unit ? " " : "", unit);
}

/* Writes the last part of a path, without slashes at its end; it names a run in the legend. */
static void name_of_folder (const char *path, char *out, size_t size)
{
    size_t end = strlen (path);
    while (end > 1 && path[end - 1] == '/') end--;
    size_t start = end;
    while (start > 0 && path[start - 1] != '/') start--;
    snprintf (out, size, "%.*s", (int) (end - start), path + start);
}

/* Sets the names in the legend: the labels, one per folder, or the folders (with the whole path where two
 * have one name). PG_E_USAGE if the number of labels is not that of the folders. */
static pg_status name_curves (const request *q, run_curve *c)
{
    pg_status status = PG_OK;
    char *label = q->labels;
    size_t given = label ? 1 : q->n;
    for (const char *s = label; s && *s; s++) given += *s == ',';
    if (given != q->n) PG_FAIL (PG_E_USAGE, "--labels has %zu names for %zu folders", given, q->n);
    for (size_t i = 0; i < q->n; i++) {
        name_of_folder (q->directory[i], c[i].name, sizeof c[i].name);
        if (!label) continue;
        size_t n = strcspn (label, ",");
        snprintf (c[i].name, sizeof c[i].name, "%.*s", (int) n, label);
        label += n + 1;
    }
    for (size_t i = 0; i < q->n && !q->labels; i++)
        for (size_t k = 0; k < q->n; k++)
            if (k != i && strcmp (c[k].name, c[i].name) == 0)
                snprintf (c[i].name, sizeof c[i].name, "%s", q->directory[i]);
done:
    return status;
}

/* Applies --negate and --abs, and says so in the labels (a minus sign, bars); step, time and
 * load factor keep their sign. 0 - x instead of -x, which would show -0. */
static void change_signs (const request *q, run_curve *c)
{
    for (int k = 0; k < 2; k++) {
        if (is_column (c->column[k], "step") || strncmp (c->column[k], "time (", 6) == 0
            || is_column (c->column[k], "load_factor"))
            continue;
        if (q->sign[k] == AS_IT_IS) continue;
        for (size_t i = 0; i < c->n; i++)
            c->at[k][i] = q->sign[k] == NEGATED ? 0 - c->at[k][i] : fabs (c->at[k][i]);
        char plain[CELL];
        memcpy (plain, c->column[k], sizeof plain);
        size_t n = strcspn (plain, "("), end = n;
        while (end > 0 && plain[end - 1] == ' ') end--;
        const char *gap = plain[n] ? " " : "";
        const char *bar = q->sign[k] == ABSOLUTE ? "|" : "";
        snprintf (c->column[k], sizeof c->column[k], "%s%.*s%s%s%.60s",
                  q->sign[k] == NEGATED ? "\xE2\x88\x92" : bar, (int) (end < 180 ? end : 180), plain, bar,
                  gap, plain + n);
    }
}

/* ---- the picture --------------------------------------------------------------------------------------- */
/* Names the picture: DIR/Y-X.png in the first folder, with characters other than letters, digits, - and _
 * replaced by _; for a table the current folder. */
static void name_picture (const request *q, char *path, size_t size)
{
    char name[128];
    snprintf (name, sizeof name, "%.60s-%.60s", q->y, q->x);
    for (char *s = name; *s; s++)
        if (!strchr ("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_", *s)) *s = '_';
    if (q->out) snprintf (path, size, "%s", q->out);
    else if (is_table (q->directory[0])) snprintf (path, size, "%s.png", name);
    else snprintf (path, size, "%s/%s.png", q->directory[0], name);
}

/* Marks the peak of every curve with a ring; the value stands beside it, or in the legend if there are
 * several curves. note: text for a single curve, which must stay valid as long as the marks. */
static void mark_peaks (const request *q, run_curve *c, pg_chart_mark *mark, char *note, size_t size)
{
    char value[CELL / 4], place[CELL / 4];
    for (size_t i = 0; i < q->n; i++) {
        double x = c[i].peak[0], y = c[i].peak[1];
        size_t used = strlen (c[i].name);
        mark[i] = (pg_chart_mark) { i, x, y, q->n == 1 ? note : NULL };
        quantity_of (c[i].column[1], y, value, sizeof value);
        quantity_of (c[i].column[0], x, place, sizeof place);
        if (q->n == 1) snprintf (note, size, "peak %s at %s", value, place);
        else snprintf (c[i].name + used, sizeof c[i].name - used, ": peak %s", value);
    }
}

/* Reads all runs; they must agree in the units of both columns, since one pair of axes serves all. */
static pg_status read_all (const request *q, run_curve *c)
{
    pg_status status = PG_OK;
    const char *const wanted[] = { q->x, q->y };
    PG_TRY (name_curves (q, c));
    for (size_t i = 0; i < q->n; i++) {
        PG_TRY (read_rows (&c[i], q->directory[i], wanted));
        for (int k = 0; k < 2; k++)
            if (strcmp (c[i].column[k], c[0].column[k]) != 0)
                PG_FAIL (PG_E_USAGE, "%s has %s and %s has %s: one picture needs one unit", q->directory[0],
                         c[0].column[k], q->directory[i], c[i].column[k]);
        read_kind (&c[i].kind, q->directory[i], wanted);
        c[i].named = named_peak (q->directory[i], q->y);
    }
done:
    return status;
}

/* Reads the runs, chooses the lines and draws them. Signs are changed before the envelope is computed, which
 * depends on them. Runs of one or two rows get markers, since a line would not be seen. */
static pg_status draw (const request *q, const char *path)
{
    pg_status status = PG_OK;
    run_curve *c = NULL;
    pg_curve curve[MOST], pale[MOST] = { { 0 } };
    pg_chart_mark mark[MOST];
    size_t paths = 0;
    char note[CELL];
    PG_ALLOC (c, q->n);
    PG_TRY (read_all (q, c));
    for (size_t i = 0; i < q->n; i++) {
        change_signs (q, &c[i]);
        PG_TRY (choose_line (q, &c[i]));
        curve[i] = (pg_curve){ .name = c[i].name,
                               .n = c[i].nline,
                               .x = c[i].line[0],
                               .y = c[i].line[1],
                               .points = c[i].n < 3   ? PG_CURVE_MARKERS
                                         : q->markers ? PG_CURVE_BOTH
                                                      : PG_CURVE_LINE };
        if (!c[i].kind.events) continue;
        pale[i] = (pg_curve) { .n = c[i].n, .x = c[i].at[0], .y = c[i].at[1] };
        pale[0].name = "path of events", paths = q->n;
    }
    int peaks = has_peak (c[0].column[1]);
    if (peaks) mark_peaks (q, c, mark, note, sizeof note);
    pg_chart_style style = { .xlabel = c[0].column[0],
                             .ylabel = c[0].column[1],
                             .logx = q->log[0],
                             .logy = q->log[1],
                             .zero = 1,
                             .npale = paths,
                             .pale = pale,
                             .nmark = peaks ? q->n : 0,
                             .marks = mark };
    PG_TRY (pg_picture_chart (path, q->n, curve, &style));
done:
    for (size_t i = 0; c && i < q->n; i++)
        pg_free (c[i].at[0]), pg_free (c[i].at[1]), pg_free (c[i].factor), pg_free (c[i].line[0]),
            pg_free (c[i].line[1]), pg_free (c[i].step);
    pg_free (c);
    return status;
}

/* ---- command line -------------------------------------------------------------------------------------- */
/* 1 for "x", "y" or "xy". */
static int is_axes (const char *text)
{
    return text && (strcmp (text, "x") == 0 || strcmp (text, "y") == 0 || strcmp (text, "xy") == 0);
}

/* Applies --negate or --abs to the axes that follow, y if none do. Both on one axis are refused. */
static pg_status read_sign (request *q, const char *name, const char *axes)
{
    pg_status status = PG_OK;
    int sign = strcmp (name, "--negate") == 0 ? NEGATED : ABSOLUTE;
    for (int k = 0; k < 2; k++) {
        if (!strchr (axes, "xy"[k])) continue;
        if (q->sign[k] != AS_IT_IS && (int) q->sign[k] != sign)
            PG_FAIL (PG_E_USAGE, "--negate and --abs exclude each other on the same axis, %c", "xy"[k]);
        if (sign == NEGATED) q->sign[k] = NEGATED;
        else q->sign[k] = ABSOLUTE;
    }
done:
    return status;
}

static pg_status unknown_option (const char *name, const char *names)
{
    const char *near = pg_nearest_name (name, names);
    return pg_error (PG_E_USAGE, PG_HERE, "unknown option %s beside --curve%s%s", name,
                     near ? "; did you mean " : "", near ? near : "");
}

/* Reads one option; *used counts it with its values. */
static pg_status read_option (request *q, const char *name, char **value, int left, int *used)
{
    static const char names[] = "--curve|--labels|--out|--log|--negate|--abs|--markers";
    enum { CURVE, LABELS, OUT, LOG, NEGATE, ABS, MARKERS };
    static const int values[] = { 2, 1, 1, 1, 0, 0, 0 };
    pg_status status = PG_OK;
    int k = pg_plot_index (name, names), axes = left > 0 && is_axes (value[0]);
    if (k < 0) return unknown_option (name, names);
    *used = 1 + values[k];
    if (left < values[k])
        PG_FAIL (PG_E_USAGE, "%s needs %s", name, k == CURVE ? "two column names" : "a value");
    if (k == CURVE) q->x = value[0], q->y = value[1];
    else if (k == LABELS) q->labels = value[0];
    else if (k == OUT) q->out = value[0];
    else if (k == MARKERS) q->markers = 1;
    else if (k == LOG) {
        if (!axes) PG_FAIL (PG_E_USAGE, "--log %s: expected x, y or xy", value[0]);
        for (int a = 0; a < 2; a++) q->log[a] = strchr (value[0], "xy"[a]) != NULL;
    } else {
        *used += axes;
        PG_TRY (read_sign (q, name, axes ? value[0] : "y"));
    }
done:
    return status;
}

/* Reads the command line; words that are no options are folders or tables. */
static pg_status read_arguments (request *q, int argc, char **argv)
{
    pg_status status = PG_OK;
    for (int k = 1, used; k < argc; k += used) {
        used = 1;
        if (argv[k][0] == '-' && argv[k][1])
            PG_TRY (read_option (q, argv[k], argv + k + 1, argc - k - 1, &used));
        else if (q->n == MOST) PG_FAIL (PG_E_USAGE, "at most %d folders in one picture", MOST);
        else q->directory[q->n++] = argv[k];
    }
    if (q->n == 0) PG_FAIL (PG_E_USAGE, "no result folder given");
done:
    return status;
}

/* Prints the path of the picture, as all plot commands do, so that scripts can use it. */
int pg_cli_plot_curve (int argc, char **argv)
{
    pg_status status = PG_OK;
    request q = { .n = 0 };
    char path[LIST];
    for (int k = 1; k < argc; k++)
        if (strcmp (argv[k], "--help") == 0 || strcmp (argv[k], "-h") == 0) {
            fputs (usage, stdout);
            return 0;
        }
    PG_TRY (read_arguments (&q, argc, argv));
    name_picture (&q, path, sizeof path);
    PG_TRY (draw (&q, path));
    puts (path);
done:
    if (status == PG_OK) return 0;
    fprintf (stderr, "perigal plot: %s\n", pg_last_error ());
    return status == PG_E_USAGE ? PG_EXIT_USAGE : PG_EXIT_FAILED;
}
