/* SPDX-License-Identifier: GPL-3.0-or-later
 * Entries of catalogues (pg_key_catalogue) that a scene chooses: the keys that belong to them, and what is
 * true of them. */
#include "document.h"
#include <string.h>

/* Is `name` in the list "a|b|c"? Whole names only: "stat" is not in "static|newmark". */
int pg_listed (const char *names, const char *name)
{
    size_t length = strlen (name);
    for (const char *at = names; *at; at += *at == '|') {
        size_t n = strcspn (at, "|");
        if (n == length && memcmp (at, name, n) == 0) return 1;
        at += n;
    }
    return 0;
}

/* Replaces {} in a pattern by the names of `map`: "materials.{}.density" with the map "materials.glass"
 * becomes "materials.glass.density". 0: the pattern does not begin like the map. */
static int concrete (char out[PG_PATTERN], const char *pattern, const char *map)
{
    const char *at = map;
    while (*at) {
        size_t n = strcspn (at, "."), m = strcspn (pattern, ".");
        int any = m == 2 && memcmp (pattern, "{}", 2) == 0;
        if (!any && (n != m || memcmp (at, pattern, n) != 0)) return 0;
        at += n, pattern += m;
        if (*pattern != '.' || (*at && *at != '.')) return 0;
        if (*at) at++, pattern++;
    }
    /* Names {} in the rest of the pattern cannot be replaced. */
    if (strpbrk (pattern, "{[")) return 0;
    return snprintf (out, PG_PATTERN, "%s%s", map, pattern) < PG_PATTERN;
}

/* Finds the k-th key below `map` that the user gave though it belongs to a catalogue entry that is not
 * chosen; in the order of the schema. */
const char *pg_scene_stray (const pg_scene *s, size_t k, const char *map, char path[PG_STRAY_PATH])
{
    char own[PG_PATTERN], chosen[PG_PATTERN];
    for (size_t row = 0; row < s->schema.n; row++) {
        const char *selector, *entries = pg_schema_entries (&s->schema, s->schema.row[row], &selector);
        if (!entries || !concrete (own, s->schema.row[row]->path, map) || !concrete (chosen, selector, map))
            continue;
        const char *name = pg_scene_text (s, "%s", chosen);
        if (!name || pg_listed (entries, name) || !pg_scene_given (s, "%s", own) || k-- > 0) continue;
        snprintf (path, PG_STRAY_PATH, "%s", own);
        return path + strlen (map) + 1;
    }
    return NULL;
}

/* Returns the entry that is chosen by the selector of a key, as written or by default, if the selector is a
 * key of the map `node` at this pattern; NULL: it is not. */
static const char *chosen_entry (const pg_scene *s, const pg_node *node, const char *pattern,
                                 const char *selector, char first[PG_LEVEL_NAMES])
{
    size_t n = strlen (pattern);
    if (strncmp (selector, pattern, n) != 0 || selector[n] != '.' || strchr (selector + n + 1, '.'))
        return NULL;
    const pg_node *child = pg_node_child (node, selector + n + 1, strlen (selector + n + 1));
    if (child) return child->shape == PG_SCALAR ? child->text : NULL;
    const pg_key *row = pg_schema_row (&s->schema, selector, PG_SCALAR);
    return row ? pg_key_default (row, first) : NULL;
}

/* Keys that belong to no catalogue entry are always in use. */
int pg_key_wanted (const pg_scene *s, const pg_key *key, const pg_node *node, const char *pattern)
{
    const char *selector, *entries = pg_schema_entries (&s->schema, key, &selector);
    if (!entries) return 1;
    char first[PG_LEVEL_NAMES];
    const char *chosen = chosen_entry (s, node, pattern, selector, first);
    return chosen && pg_listed (entries, chosen);
}

int pg_scene_entry_is (const pg_scene *s, const char *selector, unsigned flags)
{
    const char *chosen = pg_scene_text (s, "%s", selector), *name;
    for (size_t c = 0; c < s->schema.from->ncatalogue; c++) {
        const pg_key_catalogue *from = s->schema.from->catalogue[c];
        if (!from->flags || strcmp (from->selector, selector) != 0) continue;
        for (size_t i = 0; (name = from->name (i)); i++)
            if (!chosen || strcmp (name, chosen) == 0) return (from->flags (i) & flags) == flags;
    }
    return 0;
}
