/* SPDX-License-Identifier: GPL-3.0-or-later
 * points: FILE. One point per line, x [y [z]] volume [block] [spacing], separated by semicolons, commas or
 * blanks; # starts a comment. A header line may come first: it names the columns, in any order, with their
 * units in brackets (and must, for a spacing without a block).
 *
 * x [mm], y [mm], volume [mm3], block
 * 0.5, 0.5, 1, 0
 *
 * A column of numbers of the points (id) is ignored; the cloud lists its name.
 *
 * Two points at one position are a fault, because a bond between them would have no length. */
#include "geometry/cloud/search/csv_line.h"
#include "points_file.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Largest number of columns of a file. */
enum { MOST_FIELDS = 16 };
/* Roles: the quantities that a column can hold; X + k: coordinate k. */
enum { X, VOLUME = 3, BLOCK, SPACING, ROLES };
static const struct { const char *name, *unit; } role[ROLES] = {
    { "x", "m" }, { "y", "m" }, { "z", "m" }, { "volume", "m3" }, { "block", "1" }, { "spacing", "m" } };

/* State of the reader. */
typedef struct {
    const pg_scene *scene;
    /* Key under which errors are reported, and the file's name as the input file gives it. */
    const char *key, *name;
    /* 1: only positions are read: volumes may be missing, other columns are ignored, and points may occur
     * twice. */
    int     places;
    char   *text;
    /* Number of the current line, from 1. */
    size_t  line;
    /* Number of columns, the same in all lines; 0: not known yet. */
    size_t  columns;
    /* Number of the column that holds each role, from 1; 0: there is none. */
    size_t  column[ROLES];
    /* Factor from the unit of each role's column to SI units. */
    double  scale[ROLES];
    /* Names of the columns that are not used, as in pg_cloud: "id, label"; "": there are none. */
    char    passed[sizeof ((pg_cloud *) 0)->passed];
    /* 1: a header has named the columns. */
    int     headed;
    size_t  capacity;
    /* Line of each point, for messages. */
    size_t *line_of;
} reader;

#define WRONG(r, ...) wrong_at ((r)->scene, (r)->key, (r)->name, (r)->line, __VA_ARGS__)
static pg_status __attribute__ ((format (printf, 5, 6)))
wrong_at (const pg_scene *scene, const char *key, const char *name, size_t line, const char *format, ...)
{
    char why[300];
    va_list args;
    va_start (args, format);
    vsnprintf (why, sizeof why, format, args);
    va_end (args);
    if (line) pg_scene_fault (scene, key, "%.200s:%zu: %s", name, line, why);
    else pg_scene_fault (scene, key, "%.200s: %s", name, why);
    return pg_scene_verdict (scene);
}

/* ---- the file ------------------------------------------------------------------------------------------ */
/* Reads the whole file; bytes that are zero show that it is no text. */
static pg_status load (reader *r)
{
    pg_status status = PG_OK;
    char *path = NULL;
    FILE *file = NULL;
    size_t size = 0, capacity = 0, got = 0;
    PG_TRY (pg_scene_beside (&path, r->scene, r->name));
    file = fopen (path, "rb");
    if (!file) PG_TRY (WRONG (r, "%s", strerror (errno)));
    do {
        /* One byte more than is read, for the zero at the end. */
        PG_GROW (r->text, capacity, size + 65537);
        got = fread (r->text + size, 1, 65536, file);
        if (memchr (r->text + size, 0, got)) PG_TRY (WRONG (r, "is not a text file"));
        size += got;
    } while (got > 0);
    if (ferror (file)) PG_TRY (WRONG (r, "%s", strerror (errno)));
    r->text[size] = '\0';
done:
    if (file) fclose (file);
    pg_free (path);
    return status;
}

/* ---- fields of a line ---------------------------------------------------------------------------------- */
/* Reads a finite number; 0: the text is none, or something follows it. */
static int number (const char *text, double *value)
{
    char *end;
    *value = strtod (text, &end);
    return end != text && !*end && isfinite (*value);
}

/* ---- header -------------------------------------------------------------------------------------------- */
/* A header has several columns, none of which is a number. */
static int is_header (size_t n, char *const *field)
{
    char *end;
    for (size_t k = 0; k < n && k < MOST_FIELDS; k++) {
        (void) strtod (field[k], &end);
        if (!*field[k] || (end != field[k] && !*end)) return 0;
    }
    return n > 1;
}

/* Blanks separate "x [mm] y [mm]" into four fields: a unit is joined to its name again. */
static size_t join_units (size_t n, char **field)
{
    size_t kept = 0;
    for (size_t k = 0; k < n && k < MOST_FIELDS; k++) {
        if (!kept || !strchr ("[(", *field[k])) field[kept++] = field[k];
        else for (char *s = field[kept - 1] + strlen (field[kept - 1]); s < field[k]; s++) *s = ' ';
    }
    return n > MOST_FIELDS ? n : kept;
}

/* Lists the names of the columns that a body of this dimension has: "x, y, volume, block, spacing". */
static const char *names_of (size_t dim, const char *between)
{
    static _Thread_local char text[64];
    size_t n = 0;
    for (size_t k = 0; k < ROLES; k++)
        if (k < dim || k >= VOLUME)
            n += (size_t) snprintf (text + n, sizeof text - n, "%s%s", n ? between : "", role[k].name);
    return text;
}

/* Does the column only number the points? */
static int is_number_column (const char *name)
{
    static const char *const usual[] = { "id",   "nr",    "no",      "number",  "index", "label",
                                         "node", "point", "node_id", "point_id" };
    for (size_t k = 0; k < sizeof usual / sizeof *usual; k++)
        if (strcasecmp (name, usual[k]) == 0) return 1;
    return 0;
}

/* Reads column k of the header: name and unit. */
static pg_status read_name (reader *r, size_t k, char *cell, size_t dim)
{
    const char *unit, *near;
    char given[64];
    size_t what = 0;
    snprintf (given, sizeof given, "%.60s", cell);
    int closed = pg_column_cut (cell, &unit) == PG_OK;
    while (what < ROLES && (strcasecmp (cell, role[what].name) != 0 || (what >= dim && what < VOLUME)))
        what++;
    if (what == ROLES && is_number_column (cell)) {
        size_t n = strlen (r->passed);
        snprintf (r->passed + n, sizeof r->passed - n, "%s%s", n ? ", " : "", cell);
        return PG_OK;
    }
    if (what == ROLES && r->places && strcasecmp (cell, "z") != 0) return PG_OK;
    if (what == ROLES) {
        if (r->places)
            return WRONG (r, "column %zu of the header is called 'z', and dimension is %zu", k + 1, dim);
        /* the content is not shown: an input file may name any file, also one that is no table of points */
        near = pg_nearest_name (cell, names_of (dim, "|"));
        return WRONG (r,
                      "column %zu of the header %s%.40s%s%s%s: the columns of a %zuD body are %s, in any "
                      "order, with their units: x [mm], volume [mm3]",
                      k + 1, near ? "is called '" : "is none of these", near ? cell : "",
                      near ? "' (did you mean " : "", near ? near : "", near ? "?)" : "", dim,
                      names_of (dim, ", "));
    }
    if (!closed || pg_column_scale (&r->scale[what], unit, role[what].unit) != PG_OK)
        return WRONG (r, "column %zu of the header, '%.60s': %s", k + 1, given, pg_last_error ());
    if (r->column[what])
        return WRONG (r, "columns %zu and %zu of the header are both called '%s'", r->column[what], k + 1,
                      role[what].name);
    r->column[what] = k + 1;
    return PG_OK;
}

/* Reads the header; columns for coordinates and a volume must be there. */
static pg_status read_header (reader *r, size_t n, char **field, size_t dim)
{
    pg_status status = PG_OK;
    n = join_units (n, field);
    if (n > MOST_FIELDS)
        PG_TRY (WRONG (r, "%zu columns in the header; those of a %zuD body are %s", n, dim,
                       names_of (dim, ", ")));
    for (size_t k = 0; k < n; k++) PG_TRY (read_name (r, k, field[k], dim));
    for (size_t k = 0; k <= VOLUME; k++)
        if ((k < dim || (k == VOLUME && !r->places)) && !r->column[k])
            PG_TRY (WRONG (r,
                           "the header has no column '%s': coordinates%s",
                           role[k].name,
                           r->places ? " are needed"
                                     : " and a volume are needed, a block and a spacing may be"));
    r->columns = n, r->headed = 1;
done:
    return status;
}

/* ---- points -------------------------------------------------------------------------------------------- */
/* Appends a point, with its values by role. All arrays grow together. */
static pg_status add_point (reader *r, pg_cloud *c, const double *value)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim, n = c->n + 1;
    if (n > INT_MAX / 4) PG_FAIL (PG_E_LIMIT, "%s has more than %d points", r->name, INT_MAX / 4);
    if (n > r->capacity) {
        /* Capacities of zero make PG_GROW allocate all arrays for the same number of points. */
        size_t cx = 0, cv = 0, cb = 0, cs = 0, cl = 0;
        if (r->column[SPACING]) PG_GROW (c->size, cs, n);
        PG_GROW (c->x, cx, n * dim);
        PG_GROW (c->volume, cv, n);
        PG_GROW (c->block, cb, n);
        PG_GROW (r->line_of, cl, n);
        r->capacity = 2 * n;
    }
    memcpy (c->x + c->n * dim, value, dim * sizeof *value);
    c->volume[c->n] = value[VOLUME];
    c->block[c->n] = (int) value[BLOCK];
    if (r->column[SPACING]) c->size[c->n] = value[SPACING];
    r->line_of[c->n] = r->line;
    c->n = n;
done:
    return status;
}

/* Sets the roles of columns without a header: their order is fixed; block and spacing may be absent. */
static pg_status settle_columns (reader *r, size_t n, size_t dim)
{
    if (r->places && n < dim)
        return WRONG (r, "%zu column%s; in %zuD a line has %zu coordinates", n, n == 1 ? "" : "s", dim, dim);
    if (!r->places && (n < dim + 1 || n > dim + 3))
        return WRONG (
            r,
            "%zu columns; in %zuD a line has %zu (coordinates, volume), %zu (and block) or %zu (and spacing)",
            n, dim, dim + 1, dim + 2, dim + 3);
    for (size_t k = 0; k < dim; k++) r->column[X + k] = k + 1;
    r->column[VOLUME] = dim + 1, r->column[BLOCK] = n > dim + 1 ? dim + 2 : 0,
    r->column[SPACING] = n > dim + 2 ? dim + 3 : 0;
    for (size_t k = 0; k < ROLES; k++) r->scale[k] = 1;
    r->columns = n;
    return PG_OK;
}

/* Reports a value that is not allowed, and which role its column has. */
static pg_status refuse_value (reader *r, size_t what, double value, const char *must, size_t dim)
{
    return WRONG (r, "the %s %g must be %s: it stands in column %zu%s%s%s", role[what].name, value, must,
                  r->column[what], r->headed ? "" : "; without a header the columns are ",
                  r->headed ? "" : names_of (dim, ", "),
                  r->headed
                      ? ""
                      : " (a header such as x [mm], y [mm], volume [mm3] may give another order, and units)");
}

/* Reads the value that a line has for one role, in SI units. */
static pg_status read_value (reader *r, size_t what, const char *text, size_t dim, double *value)
{
    pg_status status = PG_OK;
    double given;
    if (!number (text, &given))
        PG_TRY (WRONG (r, "'%.40s' in column %zu (%s) is not a finite number", text, r->column[what],
                       role[what].name));
    *value = pg_column_value (given, r->scale[what]);
    if ((what == VOLUME || what == SPACING) && !(*value > 0))
        PG_TRY (refuse_value (r, what, given, "positive", dim));
    if (what == BLOCK && !(given >= 0 && given <= INT_MAX && given == floor (given)))
        PG_TRY (refuse_value (r, what, given, "a whole number from 0", dim));
done:
    return status;
}

/* Reads one line of the file: blank or a comment, a header before the first point, or a point. */
static pg_status read_line (reader *r, pg_cloud *c, char *line)
{
    pg_status status = PG_OK;
    char *field[MOST_FIELDS];
    double value[ROLES] = { [SPACING] = 1 };
    size_t dim = (size_t) c->dim;
    line[strcspn (line, "#\r")] = '\0';
    if (!line[strspn (line, " \t")]) return PG_OK;
    size_t n = csv_split (line, field, MOST_FIELDS);
    /* Only the first line that is no comment can be a header. */
    if (c->n == 0 && r->columns == 0 && is_header (n, field)) return read_header (r, n, field, dim);
    if (r->columns && n != r->columns)
        return WRONG (r, "%zu columns, %s %zu", n,
                      r->headed && c->n == 0 ? "the header has" : "the lines before have", r->columns);
    if (!r->columns) PG_TRY (settle_columns (r, n, dim));
    for (size_t what = 0; what < (r->places ? dim : ROLES); what++) {
        size_t k = r->column[what];
        if (k) PG_TRY (read_value (r, what, field[k - 1], dim, &value[what]));
    }
    PG_TRY (add_point (r, c, value));
done:
    return status;
}

/* ---- duplicates ---------------------------------------------------------------------------------------- */
/* A rounded position and its line. */
typedef struct { double x[3]; size_t line; } place;

/* Order of rounded positions, then of lines, so that of two equal points the later one is reported. */
static int by_place (const void *p, const void *q)
{
    const place *a = p, *b = q;
    for (int k = 0; k < 3; k++)
        if (a->x[k] != b->x[k]) return a->x[k] < b->x[k] ? -1 : 1;
    return (a->line > b->line) - (a->line < b->line);
}

/* Reports two points at one position. Positions are rounded to 1e-9 of the mean distance and sorted. */
static pg_status find_twins (reader *r, const pg_cloud *c)
{
    pg_status status = PG_OK;
    place *p = NULL;
    size_t dim = (size_t) c->dim;
    double size = 0;
    for (size_t i = dim; i < c->n * dim; i++) size = fmax (size, fabs (c->x[i] - c->x[i % dim]));
    /* About 1e-9 of the mean distance between points. */
    double grain = 1e-9 * size / (1 + pow ((double) c->n, 1.0 / c->dim));
    PG_ALLOC (p, c->n);
    for (size_t i = 0; i < c->n; i++) {
        p[i].line = r->line_of[i];
        for (size_t k = 0; k < dim; k++)
            p[i].x[k] = grain > 0 ? rint ((c->x[i * dim + k] - c->x[k]) / grain) : 0;
    }
    pg_sort (p, c->n, sizeof *p, by_place);
    for (size_t i = 1; i < c->n; i++) {
        const double *x = p[i].x, *y = p[i - 1].x;
        if (x[0] != y[0] || x[1] != y[1] || x[2] != y[2]) continue;
        r->line = p[i].line;
        PG_TRY (WRONG (r, "the same point as in line %zu", p[i - 1].line));
    }
done:
    pg_free (p);
    return status;
}

/* Reads all lines, after a byte order mark if there is one. */
static pg_status read_text (reader *r, pg_cloud *cloud)
{
    pg_status status = PG_OK;
    char *line = r->text;
    /* Some programs begin a file with the byte order mark of UTF-8. */
    if (!strncmp (line, "\xEF\xBB\xBF", 3)) line += 3;
    while (*line) {
        size_t length = strcspn (line, "\n");
        char *next = line + length + (line[length] == '\n');
        line[length] = '\0';
        r->line++;
        PG_TRY (read_line (r, cloud, line));
        line = next;
    }
    r->line = 0;
    if (cloud->n == 0) PG_TRY (WRONG (r, "has no points"));
    if (!r->places) PG_TRY (find_twins (r, cloud));
    memcpy (cloud->passed, r->passed, sizeof cloud->passed);
done:
    return status;
}

/* Reads the file as a whole: with millions of points some hundred MB of memory are needed for a moment. */
static pg_status read_file (pg_cloud *cloud, const pg_scene *scene, const char *key, int places)
{
    pg_status status = PG_OK;
    reader r = {.scene = scene, .key = key, .name = pg_scene_text (scene, "%s", key), .places = places};
    PG_TRY (load (&r));
    PG_TRY (read_text (&r, cloud));
done:
    pg_free (r.text);
    pg_free (r.line_of);
    return status;
}

pg_status pg_points_read (pg_cloud *cloud, const pg_scene *scene)
{
    return read_file (cloud, scene, "points", 0);
}

pg_status pg_points_places (pg_cloud *cloud, const pg_scene *scene, const char *key)
{
    return read_file (cloud, scene, key, 1);
}

pg_status pg_points_parse (pg_cloud *cloud, const pg_scene *scene, const char *text, size_t size)
{
    pg_status status = PG_OK;
    reader r = {.scene = scene, .key = "points", .name = pg_scene_text (scene, "points")};
    if (memchr (text, 0, size)) PG_TRY (WRONG (&r, "is not a text file"));
    PG_ALLOC (r.text, size + 1);
    memcpy (r.text, text, size);
    PG_TRY (read_text (&r, cloud));
done:
    pg_free (r.text);
    pg_free (r.line_of);
    return status;
}
