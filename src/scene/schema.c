/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds the row of a key table for a path in the scene (input file). A pattern is a path in which {} stands
 * for a name chosen by the user and [] for an element of a list: "materials.{}.density",
 * "body[].add.disk.radius". All searches are linear in the number of rows, some hundreds. */
#include "schema.h"
#include "scene/quantity/unit.h"
#include <string.h>

pg_status pg_schema_create (pg_schema *s, const pg_vocabulary *from)
{
    pg_status status = PG_OK;
    size_t n = 0;
    s->from = from;
    for (size_t t = 0; t < from->n; t++) n += from->table[t].n;
    PG_ALLOC (s->row, n);
    for (size_t t = 0; t < from->n; t++)
        for (size_t k = 0; k < from->table[t].n; k++) s->row[s->n++] = &from->table[t].key[k];
done:
    return status;
}

/* Finds the table of a row by the address of the row: each is in one table. */
const char *pg_schema_entries (const pg_schema *s, const pg_key *row, const char **selector)
{
    for (size_t t = 0; s->from->owner && t < s->from->n; t++) {
        const pg_key_owner *owner = &s->from->owner[t];
        for (size_t k = 0; owner->catalogue && k < s->from->table[t].n; k++) {
            if (row != &s->from->table[t].key[k]) continue;
            if (selector) *selector = owner->catalogue->selector;
            return owner->names;
        }
    }
    return NULL;
}

void pg_schema_clear (pg_schema *s)
{
    pg_free (s->row);
    *s = (pg_schema) { 0 };
}

/* Returns what follows the pattern in the path if the path begins with it; else NULL. Inline, as most paths
 * differ in their first letters. */
static inline const char *rest_of (const char *path, const char *pattern)
{
    const char *begin = path;
    for (; *pattern; pattern++, path++) if (*path != *pattern) return NULL;
    return *path == '\0' || *path == '.' || *path == '[' || path == begin ? path : NULL;
}

/* Are two paths equal? */
static inline int same_path (const char *a, const char *b)
{
    while (*a && *a == *b) a++, b++;
    return *a == *b;
}

/* Does any row begin with the pattern? */
static int leads_somewhere (const pg_schema *s, const char *pattern)
{
    for (size_t k = 0; k < s->n; k++)
        if (rest_of (s->row[k]->path, pattern)) return 1;
    return 0;
}

/* Appends a part to the pattern, if some row begins with the result. */
static int extend (const pg_schema *s, char *pattern, const char *joint, const char *name, size_t length)
{
    size_t n = strlen (pattern);
    if (n + length + 2 >= PG_PATTERN) return 0;
    snprintf (pattern + n, PG_PATTERN - n, "%s%.*s", joint, (int) length, name);
    if (leads_somewhere (s, pattern)) return 1;
    pattern[n] = '\0';
    return 0;
}

/* Appends a name as it is if there is such a key, else as {}, a name that the user chooses. */
int pg_schema_enter (const pg_schema *s, char pattern[PG_PATTERN], const char *name, size_t length)
{
    const char *joint = *pattern ? "." : "";
    /* Letters that have a meaning in patterns cannot be part of a name. */
    if (length == 0 || memchr (name, '.', length) || memchr (name, '[', length) || memchr (name, '{', length))
        return 0;
    if (extend (s, pattern, joint, name, length)) return 1;
    return extend (s, pattern, joint, "{}", 2) ? 2 : 0;
}

int pg_schema_item (const pg_schema *s, char pattern[PG_PATTERN]) { return extend (s, pattern, "", "[]", 2); }

/* Does a key of this kind take a node of this shape? */
static int takes (pg_kind kind, pg_node_shape shape)
{
    switch (kind) {
    case PG_MAP:     return shape == PG_MAPPING;
    case PG_LIST:    return shape == PG_SEQUENCE;
    case PG_VECTOR:
    case PG_NUMBERS:
    case PG_NAMES:   return shape != PG_MAPPING;
    default:         return shape == PG_SCALAR;
    }
}

/* Returns, of several rows with one path, such as for a list or a single value, the one that takes this
 * shape. */
const pg_key *pg_schema_row (const pg_schema *s, const char *pattern, pg_node_shape shape)
{
    for (size_t k = 0; k < s->n; k++)
        if (same_path (s->row[k]->path, pattern) && takes (s->row[k]->kind, shape)) return s->row[k];
    return NULL;
}

const pg_key *pg_schema_any (const pg_schema *s, const char *pattern)
{
    size_t k = pg_schema_next (s, pattern, 0);
    return k < s->n ? s->row[k] : NULL;
}

size_t pg_schema_next (const pg_schema *s, const char *pattern, size_t from)
{
    while (from < s->n && !same_path (s->row[from]->path, pattern)) from++;
    return from;
}

int pg_schema_opens (const pg_schema *s, const char *pattern, char next)
{
    for (size_t k = 0; k < s->n; k++) {
        const char *rest = rest_of (s->row[k]->path, pattern);
        if (rest && (*rest == next || (*pattern == '\0' && next == '.'))) return 1;
    }
    return 0;
}

const char *pg_schema_below (const pg_key *row, const char *pattern)
{
    const char *rest = rest_of (row->path, pattern);
    if (!rest || (*pattern && *rest != '.')) return NULL;
    rest += *pattern != '\0';
    return *rest == '{' || strpbrk (rest, ".[") ? NULL : rest;
}

/* Is the name (n bytes) one of "a|b|c"? */
static int listed (const char *names, const char *name, size_t n)
{
    for (const char *s = names; *s; s += *s == '|') {
        size_t m = strcspn (s, "|");
        if (m == n && memcmp (s, name, n) == 0) return 1;
        s += m;
    }
    return 0;
}

/* Names that do not fit are left out: they only serve messages. */
void pg_schema_names (const pg_schema *s, const char *pattern, char names[PG_LEVEL_NAMES])
{
    size_t used = 0;
    names[0] = '\0';
    for (size_t k = 0; k < s->n; k++) {
        const char *rest = rest_of (s->row[k]->path, pattern);
        if (!rest || (*pattern && *rest != '.')) continue;
        rest += *pattern != '\0';
        /* Length of the first word after the pattern. */
        size_t n = strcspn (rest, ".[");
        if (n == 0 || rest[0] == '{' || listed (names, rest, n) || used + n + 2 > PG_LEVEL_NAMES) continue;
        used += (size_t) snprintf (names + used, PG_LEVEL_NAMES - used, "%s%.*s", used ? "|" : "", (int) n,
                                   rest);
    }
}

const char *pg_key_default (const pg_key *key, char name[PG_LEVEL_NAMES])
{
    const char *choices = pg_key_choices (key);
    if (!key->fallback || strcmp (key->fallback, PG_FIRST_CHOICE) != 0 || !choices) return key->fallback;
    snprintf (name, PG_LEVEL_NAMES, "%.*s", (int) strcspn (choices, "|"), choices);
    return name;
}

/* The choices come from the key table or from a catalogue. */
const char *pg_key_choices (const pg_key *key) { return key->choices_of ? key->choices_of () : key->choices; }

/* What a value of each kind is called in messages; messages about numbers and names are more detailed. */
static const char *const kind_text[] = {
    [PG_MAP] = "a map (key: value)", [PG_LIST] = "a list", [PG_INTEGER] = "a whole number",
    [PG_BOOL] = "on or off", [PG_TEXT] = "a text", [PG_FILE] = "the name of a file",
    [PG_VECTOR] = "a vector such as [0, 0]", [PG_NUMBERS] = "a list of numbers",
    [PG_NAMES] = "a name or a list of names", [PG_EXPRESSION] = "a number or an expression",
};

void pg_schema_wanted (const pg_schema *s, const char *pattern, char *out, size_t n)
{
    const pg_key *key = pg_schema_any (s, pattern);
    const char *choices = key ? pg_key_choices (key) : NULL;
    if (!key)
        snprintf (out, n, "%s", pg_schema_opens (s, pattern, '[') ? kind_text[PG_LIST] : kind_text[PG_MAP]);
    else if (key->kind == PG_NUMBER) pg_quantity_describe (out, n, key->unit);
    else if (key->kind == PG_NAME) snprintf (out, n, "one of %s", choices ? choices : "the names known here");
    else snprintf (out, n, "%s", kind_text[key->kind]);
}
