/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks as a table, read and written: one crack a line, or one vertex a line; separated by commas or blanks;
 * # starts a comment. A header names the columns, in any order, with their units in brackets:
 *
 *     x1 [mm], y1 [mm], x2 [mm], y2 [mm], width [mm]        segments in 2D
 *     x, y, z, nx, ny, nz, radius, width                    discs in 3D
 *     polygon, x, y, z, width                               vertices; lines of one number make one polygon
 *     polyline, x, y, width                                 vertices of polylines in 2D, by number
 *
 * Without a header the first two orders are expected. Numbers are written with 17 digits in m, so that a
 * table that was written is read as the same bits. */
#include "crack.h"
#include "geometry/cloud/search/csv_line.h"
#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Largest number of columns of a table, and of characters of a line. */
enum { MOST = 16, LINE = 1024 };
/* Roles: the quantities that a column can hold. */
enum { X1, Y1, X2, Y2, X, Y, Z, NX, NY, NZ, RADIUS, POLYLINE, POLYGON, WIDTH, ROLES };
static const struct { const char *name, *unit; } role[ROLES] = {
    { "x1", "m" }, { "y1", "m" }, { "x2", "m" }, { "y2", "m" }, { "x", "m" },  { "y", "m" },
    { "z", "m" },  { "nx", "1" }, { "ny", "1" }, { "nz", "1" }, { "radius", "m" },
    { "polyline", "1" }, { "polygon", "1" }, { "width", "m" } };

/* Kinds of tables: the columns that each needs (bits), and in which dimensions. */
#define BIT(k) (1u << (k))
enum { SEGMENTS, DISCS, PLANE_LINES, PLANE_POLYGONS, POLYGONS, TABLES };
static const struct { unsigned needs; int dim; const char *columns; } tables[TABLES] = {
    { BIT (X1) | BIT (Y1) | BIT (X2) | BIT (Y2), 2, "x1, y1, x2, y2" },
    { BIT (X) | BIT (Y) | BIT (Z) | BIT (NX) | BIT (NY) | BIT (NZ) | BIT (RADIUS), 3,
      "x, y, z, nx, ny, nz, radius" },
    { BIT (POLYLINE) | BIT (X) | BIT (Y), 2, "polyline, x, y" },
    { BIT (POLYGON) | BIT (X) | BIT (Y), 2, "polygon, x, y" },
    { BIT (POLYGON) | BIT (X) | BIT (Y) | BIT (Z), 3, "polygon, x, y, z" },
};

/* State of the reader. */
typedef struct {
    crack_list *list;
    const char *name;
    size_t line;
    /* Role of each column, their number n (0: not known yet), and the kind of table; factor of each column to
     * SI units. */
    int    role[MOST], n, table;
    double scale[MOST];
    /* The vertices of the polygon or polyline so far: its number, its width, its first line. */
    double *vertex;  size_t nvertex, capacity, first;
    double  number, width;
} reader;

static pg_status __attribute__ ((format (printf, 2, 3))) wrong (reader *r, const char *format, ...)
{
    char why[300], path[96];
    va_list args;
    va_start (args, format);
    vsnprintf (why, sizeof why, format, args);
    va_end (args);
    snprintf (path, sizeof path, "%s.file", r->list->at);
    if (r->line) pg_scene_fault (r->list->scene, path, "%.200s:%zu: %s", r->name, r->line, why);
    else pg_scene_fault (r->list->scene, path, "%.200s: %s", r->name, why);
    return pg_scene_verdict (r->list->scene);
}

/* ---- header ---------------------------------------------------------------------------------------------
 */
/* Names the tables that are possible in this dimension, for messages. */
static const char *tables_of (int dim)
{
    return dim == 2 ? "x1, y1, x2, y2; or polyline, x, y; or polygon, x, y; and perhaps width"
                    : "x, y, z, nx, ny, nz, radius; or polygon, x, y, z; and perhaps width";
}

/* Finds the kind of table that the columns make. */
static pg_status settle_table (reader *r)
{
    unsigned given = 0;
    for (int k = 0; k < r->n; k++) given |= BIT (r->role[k]);
    for (r->table = 0; r->table < TABLES; r->table++)
        if (tables[r->table].dim == r->list->all->dim && (given & ~BIT (WIDTH)) == tables[r->table].needs)
            break;
    if (r->table == TABLES)
        return wrong (r, "these columns make no cracks in %dD: give %s", r->list->all->dim,
                      tables_of (r->list->all->dim));
    if (given & BIT (WIDTH) && r->list->width > 0)
        return wrong (r, "has a column width, and the scene gives a width too: only one of them");
    return PG_OK;
}

/* Reads the header: the role of each column and its unit. */
static pg_status read_header (reader *r, int n, char **field)
{
    pg_status status = PG_OK;
    for (int k = 0; k < n; k++) {
        const char *unit;
        int what = 0;
        PG_TRY (pg_column_cut (field[k], &unit) == PG_OK ? PG_OK : wrong (r, "%s", pg_last_error ()));
        while (what < ROLES && strcasecmp (field[k], role[what].name) != 0) what++;
        if (what == ROLES)
            /* the content is not shown: an input file may name any file, also one that is no table of
             * cracks */
            PG_TRY (wrong (r, "column %d is none of them: the columns of cracks in %dD are %s", k + 1,
                           r->list->all->dim, tables_of (r->list->all->dim)));
        for (int j = 0; j < k; j++)
            if (r->role[j] == what)
                PG_TRY (wrong (r, "columns %d and %d are both called '%s'", j + 1, k + 1, role[what].name));
        r->role[k] = what;
        if (pg_column_scale (&r->scale[k], unit, role[what].unit) != PG_OK)
            PG_TRY (wrong (r, "column %d, '%.40s': %s", k + 1, field[k], pg_last_error ()));
    }
    r->n = n;
    PG_TRY (settle_table (r));
done:
    return status;
}

/* Without a header: segments or discs, with a width or without. */
static pg_status settle_columns (reader *r, int n)
{
    int dim = r->list->all->dim, first = dim == 2 ? X1 : X, last = dim == 2 ? Y2 : RADIUS,
        count = last - first + 1;
    if (n != count && n != count + 1)
        return wrong (r, "%d columns; without a header %d are expected, %s, or %d with a width", n, count,
                      tables[dim == 2 ? SEGMENTS : DISCS].columns, count + 1);
    for (int k = 0; k < n; k++) r->role[k] = k < count ? first + k : WIDTH, r->scale[k] = 1;
    r->n = n;
    return settle_table (r);
}

/* ---- rows of the table ----------------------------------------------------------------------------------
 */
/* Makes a crack of the vertices read so far. */
static pg_status end_vertices (reader *r)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) r->list->all->dim, n = r->nvertex;
    const char *why = NULL;
    double width = r->list->width;
    if (n == 0) return PG_OK;
    if (r->width >= 0) r->list->width = r->width;
    for (size_t i = r->table == PLANE_LINES ? 1 : 0; i < n; i = r->table == PLANE_LINES ? i + 1 : n) {
        pg_crack *c = crack_next (r->list);
        if (!c) PG_FAIL (PG_E_MEMORY, "no memory for a crack");
        if (r->table == PLANE_LINES) {
            PG_TRY (crack_segment (c, r->vertex + dim * (i - 1), r->vertex + dim * i, &why));
            c->bend = i > 1;
        } else
            PG_TRY (dim == 2 ? crack_outline (c, n, r->vertex, &why) : crack_polygon (c, n, r->vertex, &why));
        if (why) break;
    }
    if (r->table == PLANE_LINES && n < 2) why = "needs two vertices or more";
    if (why) {
        r->line = r->first;
        PG_TRY (wrong (r, "%s %g %s", r->table == PLANE_LINES ? "polyline" : "polygon", r->number, why));
    }
done:
    r->nvertex = 0, r->list->width = width;
    return status;
}

/* Adds a line that holds a vertex; the first line of a new number ends the crack before it. */
static pg_status add_vertex (reader *r, const double *value)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) r->list->all->dim;
    double number = value[r->table == PLANE_LINES ? POLYLINE : POLYGON];
    if (r->nvertex && number == r->number && value[WIDTH] != r->width)
        PG_TRY (wrong (r, "the width of one crack changes, from %g to %g m", r->width, value[WIDTH]));
    if (r->nvertex && number != r->number) {
        size_t line = r->line;
        PG_TRY (end_vertices (r));
        r->line = line;
    }
    if (r->nvertex == 0) r->number = number, r->width = value[WIDTH], r->first = r->line;
    PG_GROW (r->vertex, r->capacity, dim * (r->nvertex + 1));
    memcpy (r->vertex + dim * r->nvertex++, value + X, dim * sizeof *value);
done:
    return status;
}

/* Adds a line that holds a whole crack. */
static pg_status add_crack (reader *r, const double *value)
{
    pg_status status = PG_OK;
    const char *why;
    double width = r->list->width;
    if (value[WIDTH] >= 0) r->list->width = value[WIDTH];
    pg_crack *c = crack_next (r->list);
    r->list->width = width;
    if (!c) PG_FAIL (PG_E_MEMORY, "no memory for a crack");
    PG_TRY (r->table == SEGMENTS ? crack_segment (c, value + X1, value + X2, &why)
                                 : crack_disc (c, value + X, value + NX, value[RADIUS], &why));
    if (why) PG_TRY (wrong (r, "the crack's %s", r->table == SEGMENTS ? "two ends are one place" : why));
done:
    return status;
}

/* Converts the values of a line to SI units, stored by their roles. */
static pg_status read_values (reader *r, char *const *field, double *value)
{
    char *end;
    for (int k = 0; k < r->n; k++) {
        double given = strtod (field[k], &end);
        if (end == field[k] || *end || !isfinite (given))
            return wrong (r, "'%.40s' in column %d (%s) is not a finite number", field[k], k + 1,
                          role[r->role[k]].name);
        value[r->role[k]] = pg_column_value (given, r->scale[k]);
        if (r->role[k] == WIDTH && given < 0)
            return wrong (r, "the width %g is negative; 0 is a sharp crack", given);
    }
    return PG_OK;
}

static pg_status read_line (reader *r, char *line)
{
    pg_status status = PG_OK;
    char *field[MOST], *end;
    double value[ROLES] = { [WIDTH] = -1 };
    line[strcspn (line, "#\r\n")] = '\0';
    if (!line[strspn (line, " \t")]) return PG_OK;
    int n = (int) csv_split (line, field, MOST);
    if (n > MOST) return wrong (r, "%d columns", n);
    (void) strtod (field[0], &end);
    if (!r->n && (end == field[0] || *end)) return read_header (r, n, field);
    if (!r->n) PG_TRY (settle_columns (r, n));
    if (n != r->n) return wrong (r, "%d columns, but there are %d", n, r->n);
    PG_TRY (read_values (r, field, value));
    PG_TRY (r->table == SEGMENTS || r->table == DISCS ? add_crack (r, value) : add_vertex (r, value));
done:
    return status;
}

pg_status crack_read_file (crack_list *list)
{
    pg_status status = PG_OK;
    reader r = { .list = list, .name = pg_scene_text (list->scene, "%s.file", list->at) };
    char *path = NULL, line[LINE];
    FILE *file = NULL;
    size_t before = list->all->n;
    PG_TRY (pg_scene_beside (&path, list->scene, r.name));
    file = fopen (path, "r");
    if (!file) PG_TRY (wrong (&r, "%s", strerror (errno)));
    while (fgets (line, sizeof line, file)) {
        r.line++;
        if (strlen (line) == sizeof line - 1 && !strchr (line, '\n'))
            PG_TRY (wrong (&r, "a line of more than %d letters: is it a table?", LINE - 2));
        PG_TRY (read_line (&r, line));
    }
    if (ferror (file)) PG_TRY (wrong (&r, "%s", strerror (errno)));
    PG_TRY (end_vertices (&r));
    r.line = 0;
    if (list->all->n == before) PG_TRY (wrong (&r, "holds no crack"));
done:
    if (file) fclose (file);
    pg_free (path), pg_free (r.vertex);
    return status;
}

/* ---- writing tables -------------------------------------------------------------------------------------
 */
/* Returns the kind of table that holds this crack. */
static int table_of (const pg_crack *c, int dim)
{
    if (c->kind == PG_CRACK_SEGMENT) return c->bend ? PLANE_LINES : SEGMENTS;
    if (c->kind == PG_CRACK_DISC) return DISCS;
    return dim == 2 ? PLANE_POLYGONS : POLYGONS;
}

/* Is crack i written to table t? A segment that a bend follows belongs to a polyline. */
static int belongs (const pg_cracks *all, size_t i, int t)
{
    int next = i + 1 < all->n && all->crack[i + 1].bend && all->crack[i + 1].entry == all->crack[i].entry;
    return (next ? PLANE_LINES : table_of (&all->crack[i], all->dim)) == t;
}

static void write_vertex (FILE *f, size_t number, int dim, const double *x, double width, int wide)
{
    fprintf (f, "%zu", number);
    for (int k = 0; k < dim; k++) fprintf (f, ", %.17g", x[k]);
    if (wide) fprintf (f, ", %.17g", width);
    fputc ('\n', f);
}

static void write_crack (FILE *f, const pg_crack *c, int dim, int t, int wide, size_t *number)
{
    const double *v = c->vertex;
    if (t == SEGMENTS) fprintf (f, "%.17g, %.17g, %.17g, %.17g", v[0], v[1], v[2], v[3]);
    if (t == DISCS)
        fprintf (f, "%.17g, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g", c->centre[0], c->centre[1],
                 c->centre[2], c->normal[0], c->normal[1], c->normal[2], c->radius);
    if (t == SEGMENTS || t == DISCS) {
        if (wide) fprintf (f, ", %.17g", c->slot);
        fputc ('\n', f);
        return;
    }
    if (t != PLANE_LINES || !c->bend) ++*number;
    for (size_t i = t == PLANE_LINES && c->bend ? 1 : 0; i < c->nvertex; i++)
        write_vertex (f, *number, dim, v + (size_t) dim * i, c->slot, wide);
}

/* Names the file of a second or third table: cracks_polygon.csv beside cracks.csv. */
static void name_file (char *out, size_t size, const char *path, int t)
{
    const char *dot = strrchr (path, '.'), *slash = strrchr (path, '/'), *word = t == PLANE_LINES ? "polyline"
                                                                                                : "polygon";
    size_t stem = dot && (!slash || dot > slash) ? (size_t) (dot - path) : strlen (path);
    snprintf (out, size, "%.*s_%s%s", (int) stem, path, word, path + stem);
}

/* Number of cracks that table t holds; *wide: one of them has a width. */
static size_t count (const pg_cracks *all, int t, int *wide)
{
    size_t n = 0;
    *wide = 0;
    for (size_t i = 0; i < all->n; i++)
        if (belongs (all, i, t)) n++, *wide |= all->crack[i].slot > 0;
    return n;
}

static pg_status write_table (const pg_cracks *all, int t, int wide, const char *name)
{
    pg_status status = PG_OK;
    size_t number = 0;
    FILE *f = fopen (name, "w");
    if (!f) PG_FAIL (PG_E_FILE, "%s: %s", name, strerror (errno));
    fprintf (f, "%s%s\n", tables[t].columns, wide ? ", width" : "");
    for (size_t i = 0; i < all->n; i++)
        if (belongs (all, i, t)) write_crack (f, &all->crack[i], all->dim, t, wide, &number);
    int bad = ferror (f);
    if (fclose (f) != 0 || bad) PG_FAIL (PG_E_FILE, "%s: could not be written", name);
done:
    return status;
}

pg_status pg_cracks_write (const pg_cracks *all, const char *path, void (*said) (void *, const char *),
                           void *context)
{
    pg_status status = PG_OK;
    char name[4096];
    for (int t = 0, files = 0, wide; t < TABLES; t++) {
        if (count (all, t, &wide) == 0) continue;
        if (files++ == 0) snprintf (name, sizeof name, "%s", path);
        else name_file (name, sizeof name, path, t);
        PG_TRY (write_table (all, t, wide, name));
        if (said) said (context, name);
    }
done:
    return status;
}
