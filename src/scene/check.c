/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks the tree of a scene against the key tables: unknown, missing, repeated and wrongly shaped keys,
 * groups. Single values are checked by value.c. Faults are collected and do not stop the checks. */
#include "document.h"
#include "scene/quantity/unit.h"
#include "value.h"
#include <string.h>

/* Largest number of unknown keys of a map that are reported by name; the others are counted. */
enum { NAMED = 10 };

static pg_status check_node (pg_scene *s, pg_node *node, char pattern[PG_PATTERN], char path[PG_PATH_TEXT]);

#define FAULT(node, value, ...) pg_faults_add (s->faults, s->file, (node), path, (value), __VA_ARGS__)

/* ---- unknown and repeated keys ------------------------------------------------------------------------- */
/* The path of a key of that name anywhere else, such as "materials.NAME.density"; NULL: there is none. */
static const char *known_elsewhere (const pg_schema *schema, const char *name)
{
    for (size_t k = 0; k < schema->n; k++) {
        const char *path = schema->row[k]->path, *last = strrchr (path, '.');
        if (strcmp (last ? last + 1 : path, name) == 0) return path;
    }
    return NULL;
}

/* Rewrites a list "a|b" as "a, b". */
static void list_with_commas (char *out, size_t n, const char *names)
{
    size_t used = 0;
    for (; *names && used + 3 < n; names++) {
        if (*names != '|') out[used++] = *names;
        else out[used++] = ',', out[used++] = ' ';
    }
    out[used] = '\0';
}

/* Reports an unknown key: suggests the nearest name, or the path where the key belongs. */
static void unknown_key (pg_scene *s, const pg_node *node, const char *pattern, const char *path)
{
    char names[PG_LEVEL_NAMES], listed[500];
    pg_schema_names (&s->schema, pattern, names);
    const char *near = pg_nearest_name (node->name, names), *other = known_elsewhere (&s->schema, node->name);
    list_with_commas (listed, sizeof listed, names);
    /* Merge keys of YAML 1.1, which users of other programs try. */
    if (strcmp (node->name, "<<") == 0)
        FAULT (node, 0,
               "merge keys are not known: write the keys again (an alias may stand for a whole value)");
    else if (near) FAULT (node, 1, "unknown key; did you mean %s?", near);
    else if (other) FAULT (node, 1, "unknown key here; it belongs at %s", other);
    else FAULT (node, 1, "unknown key; known here: %s", listed);
}

/* May the user choose this name? */
static int good_name (const char *name)
{
    return *name && strlen (name) < 64 && !strpbrk (name, ".[]{}=");
}

/* An earlier child of the same name as child k; NULL: none. */
static const pg_node *earlier (const pg_node *node, size_t k)
{
    const pg_node *first = pg_node_child (node, node->child[k].name, strlen (node->child[k].name));
    return first != &node->child[k] ? first : NULL;
}

/* ---- missing keys and groups --------------------------------------------------------------------------- */
/* Has the map a key of that name? */
static int present (const pg_node *node, const char *name)
{
    return pg_node_child (node, name, strlen (name)) != NULL;
}

/* Is row k the first of its path? A path may have rows for several kinds of values. */
static int first_of_path (const pg_schema *schema, size_t k)
{
    for (size_t j = 0; j < k; j++)
        if (strcmp (schema->row[j]->path, schema->row[k]->path) == 0) return 0;
    return 1;
}

/* Appends a name to a path; returns the old length, so that the caller can cut the path again. */
static size_t write_path (char path[PG_PATH_TEXT], const char *joint, const char *name)
{
    size_t n = strlen (path);
    snprintf (path + n, PG_PATH_TEXT - n, "%s%s", n ? joint : "", name);
    return n;
}

/* Reports keys of this level that have no default and are missing, if they are in use. */
static void check_missing (pg_scene *s, const pg_node *node, const char *pattern, char path[PG_PATH_TEXT])
{
    for (size_t k = 0; k < s->schema.n; k++) {
        const pg_key *row = s->schema.row[k];
        const char *name = pg_schema_below (row, pattern);
        if (!name || row->fallback || row->group || present (node, name) || !first_of_path (&s->schema, k))
            continue;
        /* Keys of catalogue entries that are not chosen need not be there. */
        if (!pg_key_wanted (s, row, node, pattern)) continue;
        size_t n = write_path (path, ".", name);
        FAULT (node, 0, "is missing: %s", row->doc ? row->doc : "required");
        path[n] = '\0';
    }
}

/* The keys of a group at one level: how many are given, all names, the last one given. */
typedef struct { size_t given; char names[400], last[64]; } membership;

/* Rows of one path count once, even if it may have several shapes. */
static membership count_members (const pg_scene *s, const pg_node *node, const char *pattern,
                                 const char *group)
{
    membership m = { 0 };
    size_t used = 0;
    for (size_t k = 0; k < s->schema.n; k++) {
        const pg_key *row = s->schema.row[k];
        const char *name = pg_schema_below (row, pattern);
        if (!name || !row->group || strcmp (row->group, group) != 0 || !first_of_path (&s->schema, k))
            continue;
        if (used < sizeof m.names)
            used += (size_t) snprintf (m.names + used, sizeof m.names - used, "%s%s", used ? ", " : "", name);
        if (!present (node, name)) continue;
        m.given++;
        snprintf (m.last, sizeof m.last, "%s", name);
    }
    return m;
}

/* Is row k the first of its group at this level? */
static int first_of_group (const pg_schema *schema, size_t k, const char *pattern)
{
    const char *group = schema->row[k]->group;
    for (size_t j = 0; j < k; j++)
        if (schema->row[j]->group && pg_schema_below (schema->row[j], pattern)
            && strcmp (schema->row[j]->group, group) == 0)
            return 0;
    return 1;
}

/* Checks that at most one, or exactly one, of the keys of a group is given. */
static void check_groups (pg_scene *s, const pg_node *node, const char *pattern, char path[PG_PATH_TEXT])
{
    for (size_t k = 0; k < s->schema.n; k++) {
        const char *group = s->schema.row[k]->group;
        if (!group || !pg_schema_below (s->schema.row[k], pattern)
            || !first_of_group (&s->schema, k, pattern))
            continue;
        /* The part of the group behind the colon says how many must be given. */
        const char *rule = strrchr (group, ':');
        int one = rule && strcmp (rule, ":one") == 0;
        membership m = count_members (s, node, pattern, group);
        if (m.given > 1) {
            size_t n = write_path (path, ".", m.last);
            FAULT (pg_node_child (node, m.last, strlen (m.last)), 1, "give %s of %s",
                   one ? "exactly one" : "at most one", m.names);
            path[n] = '\0';
        } else if (m.given == 0 && one) FAULT (node, 0, "give exactly one of %s", m.names);
    }
}

/* ---- shapes -------------------------------------------------------------------------------------------- */
/* Checks all children of a map; pattern and path are restored afterwards. */
static pg_status check_map (pg_scene *s, pg_node *node, char pattern[PG_PATTERN], char path[PG_PATH_TEXT])
{
    pg_status status = PG_OK;
    size_t unknown = 0, first = 0;
    for (size_t k = 0; k < node->n; k++) {
        pg_node *child = &node->child[k];
        const pg_node *twin = earlier (node, k);
        size_t end = strlen (pattern), n = write_path (path, ".", child->name);
        int found = pg_schema_enter (&s->schema, pattern, child->name, strlen (child->name));
        /* The key is there twice, its name cannot be used, it is unknown, or its value is checked. */
        if (twin) FAULT (child, 1, "is given twice, first in line %d", twin->line);
        else if (!good_name (child->name))
            FAULT (child, 0, "a name has 1 to 63 characters without . = [ ] { }");
        else if (!found) {
            if (++unknown <= NAMED) unknown_key (s, child, pattern, path);
            else if (unknown == NAMED + 1) first = k;
        } else PG_TRY (check_node (s, child, pattern, path));
        pattern[end] = '\0';
        path[n] = '\0';
    }
    if (unknown > NAMED)
        FAULT (&node->child[first], 0, "%zu more of the %zu keys here are unknown", unknown - NAMED, node->n);
    check_missing (s, node, pattern, path);
    check_groups (s, node, pattern, path);
done:
    return status;
}

/* Checks all elements of a list. */
static pg_status check_list (pg_scene *s, pg_node *node, char pattern[PG_PATTERN], char path[PG_PATH_TEXT])
{
    pg_status status = PG_OK;
    size_t end = strlen (pattern);
    if (!pg_schema_item (&s->schema, pattern)) return PG_OK;
    for (size_t k = 0; k < node->n; k++) {
        char index[32];
        snprintf (index, sizeof index, "[%zu]", k);
        size_t n = write_path (path, "", index);
        PG_TRY (check_node (s, &node->child[k], pattern, path));
        path[n] = '\0';
    }
done:
    pattern[end] = '\0';
    return status;
}

/* Gives a key without a value a shape: an empty list where only a list fits, an empty map where only a map
 * fits. */
static void shape_of_nothing (const pg_schema *schema, pg_node *node, const char *pattern)
{
    if (!pg_node_null (node) || pg_schema_row (schema, pattern, PG_SCALAR)) return;
    /* Where the key can be a list, it is an empty list, else an empty map. */
    pg_node_shape shape = pg_schema_opens (schema, pattern, '[')
                                  || pg_schema_row (schema, pattern, PG_SEQUENCE)
                              ? PG_SEQUENCE
                              : PG_MAPPING;
    pg_free (node->text);
    node->text = NULL;
    node->shape = shape;
}

/* Has a list or a map of names more entries than its row, or else any list, may have? Each entry costs time
 * in every check, so that a scene of too many would have no answer. */
static int overfull (pg_scene *s, const pg_node *node, const pg_key *row, const char *path)
{
    static const char any[] = "[0, 10000]", numbers[] = "[0, 100000]";
    int wrong, counts = row->kind == PG_LIST || row->kind == PG_MAP || row->kind == PG_NAMES;
    const char *range = counts && row->range ? row->range : row->kind == PG_NUMBERS ? numbers : any;
    if (node->shape == PG_SCALAR || pg_range_holds (range, (double) node->n, &wrong)) return 0;
    FAULT (node, 0, "has %zu entries; their number must lie in %s", node->n, range);
    return 1;
}

/* Checks a node of any shape: finds its row, then checks its children or its value. */
static pg_status check_node (pg_scene *s, pg_node *node, char pattern[PG_PATTERN], char path[PG_PATH_TEXT])
{
    static const char *const shape[] = { "a single value", "a list", "a map" };
    char wanted[PG_LEVEL_NAMES];
    shape_of_nothing (&s->schema, node, pattern);
    const pg_key *row = pg_schema_row (&s->schema, pattern, node->shape);
    int is_map = row || pg_schema_opens (&s->schema, pattern, '.');
    int is_list = row ? row->kind == PG_LIST : pg_schema_opens (&s->schema, pattern, '[');
    node->key = row;
    if (row && overfull (s, node, row, path)) return PG_OK;
    if (node->shape == PG_MAPPING && is_map) return check_map (s, node, pattern, path);
    if (node->shape == PG_SEQUENCE && is_list) return check_list (s, node, pattern, path);
    /* Values, and lists of numbers or names. */
    if (row) return pg_value_check (s, node, row, path);
    pg_schema_wanted (&s->schema, pattern, wanted, sizeof wanted);
    FAULT (node, 1, "must be %s, not %s", wanted, shape[node->shape]);
    return PG_OK;
}

/* ---- the whole tree ------------------------------------------------------------------------------------ */
/* Reads and checks the defaults as if the user had written them. */
static pg_status check_defaults (pg_scene *s)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->fallback, s->schema.n);
    for (size_t k = 0; k < s->schema.n; k++) {
        const pg_key *row = s->schema.row[k];
        char first[PG_LEVEL_NAMES];
        const char *text = pg_key_default (row, first);
        char pattern[PG_PATTERN], path[PG_PATH_TEXT];
        int good = 1;
        if (!text || !*text) continue;
        pg_node *node = &s->fallback[k];
        /* Lists and maps are written as YAML, other defaults are plain words. */
        if (*text == '[' || *text == '{')
            PG_TRY (pg_node_read (node, text, strlen (text), pg_default_origin, s->file, s->faults, &good));
        else PG_TRY (pg_node_word (node, text, pg_default_origin));
        snprintf (pattern, sizeof pattern, "%s", row->path);
        snprintf (path, sizeof path, "%s", row->path);
        if (good) PG_TRY (check_node (s, node, pattern, path));
    }
done:
    return status;
}

/* Checks the whole tree. The dimension comes first, because the length of vectors depends on it. */
pg_status pg_scene_check (pg_scene *s)
{
    pg_status status = PG_OK;
    char pattern[PG_PATTERN] = "", path[PG_PATH_TEXT] = "";
    /* The dimension is read here without a check, which follows with all other keys. */
    const pg_node *d = pg_node_child (&s->root, "dimension", strlen ("dimension"));
    if (d && d->shape == PG_SCALAR && d->text && strlen (d->text) == 1 && strchr ("123", *d->text))
        s->dimension = *d->text - '0';
    PG_TRY (check_map (s, &s->root, pattern, path));
    PG_TRY (check_defaults (s));
done:
    return status;
}
