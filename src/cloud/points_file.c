/* SPDX-License-Identifier: GPL-3.0-or-later
 * points: FILE. One point a line, x [y [z]] volume [block] [spacing], by commas or blanks; '#' starts a comment; one header line may
 * lead (and must, for a spacing without a block). */
#include "points_file.h"
#include "place.h"
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { MOST_FIELDS = 8 };

typedef struct {
    const pg_scene *scene;
    const char *name;                                  /* as the user wrote it                                           */
    char   *text;
    size_t  line;                                      /* being read, from 1                                             */
    size_t  columns;                                   /* of all lines, 0: not known yet                                 */
    size_t  block, spacing;                            /* columns that hold these, 0: none does                          */
    size_t  capacity;
    size_t *line_of;                                   /* line of each point                                             */
} reader;

#define WRONG(r, ...) wrong_at ((r)->scene, (r)->name, (r)->line, __VA_ARGS__)
static pg_status __attribute__ ((format (printf, 4, 5)))
wrong_at (const pg_scene *scene, const char *name, size_t line, const char *format, ...)
{
    char why[300];
    va_list args;
    va_start (args, format);
    vsnprintf (why, sizeof why, format, args);
    va_end (args);
    if (line) pg_scene_fault (scene, "points", "%.200s:%zu: %s", name, line, why);
    else pg_scene_fault (scene, "points", "%.200s: %s", name, why);
    return pg_scene_verdict (scene);
}

pg_status pg_place_beside (char **out, const pg_scene *scene, const char *name)
{
    pg_status status = PG_OK;
    const char *file = pg_scene_file (scene), *slash = file ? strrchr (file, '/') : NULL;
    size_t folder = slash && name[0] != '/' ? (size_t) (slash - file) + 1 : 0, length = strlen (name) + 1;
    PG_ALLOC (*out, folder + length);
    if (folder) memcpy (*out, file, folder);
    memcpy (*out + folder, name, length);
done:
    return status;
}

/* ---- the file ------------------------------------------------------------------------------------------------------- */
static pg_status load (reader *r)
{
    pg_status status = PG_OK;
    char *path = NULL;
    FILE *file = NULL;
    size_t size = 0, capacity = 0, got = 0;
    PG_TRY (pg_place_beside (&path, r->scene, r->name));
    file = fopen (path, "rb");
    if (!file) PG_TRY (WRONG (r, "%s", strerror (errno)));
    do {
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

/* ---- a line --------------------------------------------------------------------------------------------------------- */
/* Cuts a line into fields in place; with a comma anywhere only commas separate. Counts also those that do not fit. */
static size_t split (char *line, char *field[MOST_FIELDS])
{
    int comma = strchr (line, ',') != NULL;
    size_t n = 0;
    for (char *s = line; ; ) {
        s += strspn (s, " \t");
        if (!*s && !comma) return n;
        char *end = s + strcspn (s, comma ? "," : " \t"), *tail = end;
        int last = !*end;
        while (tail > s && (tail[-1] == ' ' || tail[-1] == '\t')) tail--;
        *tail = '\0';
        if (n < MOST_FIELDS) field[n] = s;
        n++;
        if (last) return n;
        s = end + 1;
    }
}

static int number (const char *text, double *value)
{
    char *end;
    *value = strtod (text, &end);
    return end != text && !*end && isfinite (*value);
}

static int names (const char *field, const char *name) /* a unit may follow                                              */
{
    size_t length = strlen (name);
    return !strncasecmp (field, name, length) && strchr (" [(", field[length]);
}

/* A header names the columns in their order. */
static int is_header (reader *r, size_t n, char *const *field, size_t dim)
{
    static const char *const word[] = {"x", "y", "z"};
    if (n < dim + 1 || n > dim + 3) return 0;
    for (size_t k = 0; k < dim; k++) if (!names (field[k], word[k])) return 0;
    if (!names (field[dim], "volume")) return 0;
    size_t block = n > dim + 1 && names (field[dim + 1], "block") ? dim + 1 : 0;
    size_t spacing = n > dim + 1 && names (field[n - 1], "spacing") ? n - 1 : 0;
    if (n != dim + 1 + (block > 0) + (spacing > 0)) return 0;
    r->columns = n, r->block = block, r->spacing = spacing;
    return 1;
}

static pg_status add_point (reader *r, pg_cloud *c, const double *value)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim, n = c->n + 1;
    if (n > INT_MAX / 4) PG_FAIL (PG_E_LIMIT, "%s has more than %d points", r->name, INT_MAX / 4);
    if (n > r->capacity) {
        size_t cx = 0, cv = 0, cb = 0, cs = 0, cl = 0;     /* 0: grow now, all alike */
        if (r->spacing) PG_GROW (c->size, cs, n);
        PG_GROW (c->x, cx, n * dim);
        PG_GROW (c->volume, cv, n);
        PG_GROW (c->block, cb, n);
        PG_GROW (r->line_of, cl, n);
        r->capacity = 2 * n;
    }
    memcpy (c->x + c->n * dim, value, dim * sizeof *value);
    c->volume[c->n] = value[dim];
    c->block[c->n] = r->block ? (int) value[r->block] : 0;
    if (r->spacing) c->size[c->n] = value[r->spacing];
    r->line_of[c->n] = r->line;
    c->n = n;
done:
    return status;
}

static pg_status read_line (reader *r, pg_cloud *c, char *line)
{
    char *field[MOST_FIELDS];
    double value[MOST_FIELDS];
    size_t dim = (size_t) c->dim;
    line[strcspn (line, "#\r")] = '\0';
    if (!line[strspn (line, " \t")]) return PG_OK;
    size_t n = split (line, field);
    if (c->n == 0 && r->columns == 0 && is_header (r, n, field, dim)) return PG_OK;
    if (n < dim + 1 || n > dim + 3)
        return WRONG (r, "%zu columns; in %zuD a line has %zu (coordinates, volume), %zu (and block) or %zu (and spacing)", n, dim, dim + 1, dim + 2, dim + 3);
    if (r->columns && n != r->columns) return WRONG (r, "%zu columns, the lines before have %zu", n, r->columns);
    if (!r->columns) r->block = n > dim + 1 ? dim + 1 : 0, r->spacing = n > dim + 2 ? dim + 2 : 0;
    r->columns = n;
    for (size_t k = 0; k < n; k++)
        if (!number (field[k], &value[k])) return WRONG (r, "'%.40s' in column %zu is not a finite number", field[k], k + 1);
    if (!(value[dim] > 0)) return WRONG (r, "the volume %g must be positive", value[dim]);
    double block = r->block ? value[r->block] : 0, spacing = r->spacing ? value[r->spacing] : 1;
    if (!(block >= 0 && block <= INT_MAX && block == floor (block))) return WRONG (r, "the block %g must be a whole number from 0", block);
    if (!(spacing > 0)) return WRONG (r, "the spacing %g must be positive", spacing);
    return add_point (r, c, value);
}

/* ---- duplicates ----------------------------------------------------------------------------------------------------- */
typedef struct { double x[3]; size_t line; } place;

static int by_place (const void *p, const void *q)
{
    const place *a = p, *b = q;
    for (int k = 0; k < 3; k++)
        if (a->x[k] != b->x[k]) return a->x[k] < b->x[k] ? -1 : 1;
    return (a->line > b->line) - (a->line < b->line);
}

/* Points closer than about 1e-9 of their mean distance share a rounded place. */
static pg_status find_twins (reader *r, const pg_cloud *c)
{
    pg_status status = PG_OK;
    place *p = NULL;
    size_t dim = (size_t) c->dim;
    double size = 0;
    for (size_t i = dim; i < c->n * dim; i++) size = fmax (size, fabs (c->x[i] - c->x[i % dim]));
    double grain = 1e-9 * size / (1 + pow ((double) c->n, 1.0 / c->dim));
    PG_ALLOC (p, c->n);
    for (size_t i = 0; i < c->n; i++) {
        p[i].line = r->line_of[i];
        for (size_t k = 0; k < dim; k++) p[i].x[k] = grain > 0 ? rint ((c->x[i*dim + k] - c->x[k]) / grain) : 0;
    }
    qsort (p, c->n, sizeof *p, by_place);
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

static pg_status read_text (reader *r, pg_cloud *cloud)
{
    pg_status status = PG_OK;
    char *line = r->text;
    if (!strncmp (line, "\xEF\xBB\xBF", 3)) line += 3;     /* byte order mark */
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
    PG_TRY (find_twins (r, cloud));
done:
    return status;
}

pg_status pg_points_read (pg_cloud *cloud, const pg_scene *scene)
{
    pg_status status = PG_OK;
    reader r = {.scene = scene, .name = pg_scene_text (scene, "points")};
    PG_TRY (load (&r));
    PG_TRY (read_text (&r, cloud));
done:
    pg_free (r.text);
    pg_free (r.line_of);
    return status;
}

pg_status pg_points_parse (pg_cloud *cloud, const pg_scene *scene, const char *text, size_t size)
{
    pg_status status = PG_OK;
    reader r = {.scene = scene, .name = pg_scene_text (scene, "points")};
    if (memchr (text, 0, size)) PG_TRY (WRONG (&r, "is not a text file"));
    PG_ALLOC (r.text, size + 1);
    memcpy (r.text, text, size);
    PG_TRY (read_text (&r, cloud));
done:
    pg_free (r.text);
    pg_free (r.line_of);
    return status;
}
