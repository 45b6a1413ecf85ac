/* SPDX-License-Identifier: GPL-3.0-or-later
 * Values by path: what the user wrote, or the default of the key. Values were checked when the scene was
 * read, so that these functions cannot fail: what is absent is 0 or NULL. */
#include "document.h"
#include "scene/quantity/unit.h"
#include "value.h"
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

/* The result of looking up a path. */
typedef struct {
    /* The node, written or default; NULL: absent. */
    const pg_node *node;
    /* The last node on the path that the user wrote: where a fault is reported. */
    const pg_node *nearest;
    /* 1: the user wrote the node; 0: it is a default or absent. */
    int            given;
} found;

/* The default of the key with this pattern, NULL: it has none. */
static const pg_node *default_of (const pg_scene *s, const char *pattern)
{
    size_t k = pg_schema_next (&s->schema, pattern, 0);
    while (k < s->schema.n && !s->fallback[k].origin) k = pg_schema_next (&s->schema, pattern, k + 1);
    return k < s->schema.n ? &s->fallback[k] : NULL;
}

/* Element i of a list; a single value is a list of one. */
static const pg_node *item (const pg_node *list, size_t i)
{
    if (!list || list->shape == PG_MAPPING) return NULL;
    if (list->shape == PG_SCALAR) return i == 0 ? list : NULL;
    return i < list->n ? &list->child[i] : NULL;
}

/* Looks up a path such as "a.b[3].c". A default never replaces an element of a list or a name that the user
 * chooses. The pattern grows with the path, "materials.{}.density" for "materials.glass.density", and finds
 * the default. */
static found locate (const pg_scene *s, const char *path)
{
    char pattern[PG_PATTERN] = "";
    found f = { &s->root, &s->root, 1 };
    while (*path) {
        int may_default = 1;
        const pg_node *child;
        if (*path == '[') {
            /* An element of a list. */
            child = item (f.node, (size_t) strtoul (path + 1, NULL, 10));
            path += strcspn (path, "]");
            path += *path == ']';
            pg_schema_item (&s->schema, pattern);
            may_default = 0;
        } else {
            /* A key of a map, or a name that the user chose. */
            path += *path == '.';
            size_t n = strcspn (path, ".[");
            child = f.node && n ? pg_node_child (f.node, path, n) : NULL;
            int entered = pg_schema_enter (&s->schema, pattern, path, n);
            if (!entered) return (found) { NULL, f.nearest, 0 };
            may_default = entered == 1;
            path += n;
        }
        /* Below a node that the user did not write nothing is written either. */
        if (child && f.given) f.nearest = child;
        if (!child) f.given = 0;
        f.node = child;
        if (!child && !may_default) return f;
        if (!child) f.node = default_of (s, pattern);
    }
    return f;
}

/* Formats the path and locates it. */
#define LOCATE(f, s, path) \
    found f; \
    do { \
        char text_[PG_PATH_TEXT]; \
        va_list args_; \
        va_start (args_, path); \
        vsnprintf (text_, sizeof text_, path, args_); \
        va_end (args_); \
        f = locate (s, text_); \
    } while (0)

/* Has the user given the key? A default does not count. */
int pg_scene_given (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    return f.node && f.given;
}

int pg_scene_line (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    return f.node && f.given && !f.node->origin ? f.node->line : 0;
}

int pg_scene_has (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    return f.node != NULL;
}

/* A list that is one value, as in `names: top`, has one element. */
size_t pg_scene_count (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    if (!f.node) return 0;
    return f.node->shape == PG_SCALAR ? 1 : f.node->n;
}

const char *pg_scene_name (const pg_scene *s, size_t i, const char *path, ...)
{
    LOCATE (f, s, path);
    if (!f.node) return NULL;
    if (f.node->shape == PG_MAPPING) return i < f.node->n ? f.node->child[i].name : NULL;
    const pg_node *node = item (f.node, i);
    return node && node->shape == PG_SCALAR ? node->text : NULL;
}

/* The value in SI units; a multiple of the point spacing is multiplied by `spacing` (m). A node without a
 * numeric kind (dimension: 2) is read as a plain number. */
static double number_of (const pg_node *node, double spacing)
{
    double value = 0;
    if (!node || node->shape != PG_SCALAR) return 0;
    if (!node->key || node->key->kind == PG_NAME || node->key->kind == PG_TEXT || node->key->kind == PG_FILE
        || node->key->kind == PG_NAMES) {
        if (!node->text || !pg_number_read (node->text, &value)) value = 0;
        return value;
    }
    return node->spacing ? node->value * spacing : node->value;
}

/* NAN for a multiple of the spacing: these need pg_scene_length. */
double pg_scene_number (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    /* NAN makes a multiple of the spacing unusable here: it needs pg_scene_length. */
    return number_of (f.node, NAN);
}

double pg_scene_length (const pg_scene *s, double spacing, const char *path, ...)
{
    LOCATE (f, s, path);
    return number_of (f.node, spacing);
}

/* Returns 0 beyond 2^53, up to which a double holds every whole number. */
long pg_scene_integer (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    double value = number_of (f.node, NAN);
    return fabs (value) <= 9007199254740992.0 ? (long) value : 0;
}

int pg_scene_bool (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    return f.node && f.node->shape == PG_SCALAR && f.node->value != 0;
}

const char *pg_scene_text (const pg_scene *s, const char *path, ...)
{
    LOCATE (f, s, path);
    return f.node && f.node->shape == PG_SCALAR ? f.node->text : NULL;
}

int pg_scene_vector (const pg_scene *s, int max, double *out, const char *path, ...)
{
    LOCATE (f, s, path);
    int n = 0;
    for (; n < max; n++) {
        const pg_node *node = item (f.node, (size_t) n);
        if (!node) break;
        out[n] = number_of (node, NAN);
    }
    return n;
}

/* The value is shown only if the key itself is written; else the fault is reported at the nearest written key
 * above it. */
void pg_scene_fault (const pg_scene *s, const char *path, const char *format, ...)
{
    va_list args;
    found f = locate (s, path);
    int written = f.node && f.given;
    va_start (args, format);
    pg_faults_add_v (s->faults, s->file, f.nearest, path, written, format, args);
    va_end (args);
}
