/* SPDX-License-Identifier: GPL-3.0-or-later
 * Overrides "a.b[0].c=value": put a value, read as YAML, into the tree; missing maps and lists on the path
 * are created. Index n of a list with n elements appends one. Overrides are applied before the checks and
 * enter the hash by which results name their scene (input file). */
#include "document.h"
#include <string.h>

/* DEEPEST: most parts of a path. WORD: room for a word, in bytes. */
enum { DEEPEST = 30, WORD = 128 };

/* Gives an empty node the shape that the path needs. 0: it has another one already. */
static int become (pg_node *node, pg_node_shape shape)
{
    if (pg_node_null (node)) {
        pg_free (node->text);
        node->text = NULL;
        node->shape = shape;
    }
    return node->shape == shape;
}

/* Appends an empty child. */
static pg_status add (pg_node **child, pg_node *parent, const char *name, const char *origin)
{
    pg_status status = pg_node_add (child, parent, name);
    if (status == PG_OK) (*child)->plain = 1, (*child)->origin = origin;
    return status;
}

/* Reads "name" or "[3]" at *path. 0: it is neither; index is -1 for a name. */
static int next_part (const char **path, const char *end, char word[WORD], long *index)
{
    const char *s = *path;
    size_t n = 0;
    if (*s == '[') {
        *index = 0;
        /* At most nine digits: the index fits an int. */
        for (n = 1; s + n < end && s[n] >= '0' && s[n] <= '9' && n < 9; n++)
            *index = *index * 10 + (s[n] - '0');
        if (n == 1 || s + n >= end || s[n] != ']') return 0;
        *path = s + n + 1;
        return 1;
    }
    *index = -1;
    while (s + n < end && s[n] != '.' && s[n] != '[') n++;
    if (n == 0 || n >= WORD) return 0;
    memcpy (word, s, n);
    word[n] = '\0';
    *path = s + n;
    return 1;
}

/* Is the path well formed? Checked first, so that a wrong path leaves no trace in the tree. */
static int well_formed (const char *path, const char *end)
{
    char word[WORD];
    long index;
    for (int deep = 0; path < end; deep++) {
        if (deep > 0 && *path == '.') path++;
        else if (deep > 0 && *path != '[') return 0;
        if (deep >= DEEPEST || path >= end || !next_part (&path, end, word, &index)) return 0;
    }
    return 1;
}

/* Finds the node at a well-formed path, created if need be; *why says what is wrong. */
static pg_status reach (pg_scene *s, pg_node **node, const char *path, const char *end, const char *origin,
                        const char **why)
{
    pg_status status = PG_OK;
    char word[WORD];
    *node = &s->root;
    while (path < end) {
        long index;
        pg_node *child = NULL;
        path += *path == '.';
        if (!next_part (&path, end, word, &index)) break;
        int is_name = index < 0;
        if (!become (*node, is_name ? PG_MAPPING : PG_SEQUENCE))
            *why = is_name ? "leads through something that is not a map"
                           : "leads through something that is not a list";
        else if (index > (long) (*node)->n) *why = "leads past the end of a list";
        else if (index >= 0 && index < (long) (*node)->n) child = &(*node)->child[index];
        else if (index < 0) child = pg_node_child (*node, word, strlen (word));
        if (*why) break;
        if (!child) PG_TRY (add (&child, *node, index < 0 ? word : NULL, origin));
        *node = child;
    }
done:
    return status;
}

/* The new value keeps the name of the node it replaces; its origin is the override, so that faults are
 * reported there. */
pg_status pg_scene_override (pg_scene *s, const char *set, const char *origin)
{
    pg_status status = PG_OK;
    pg_node value = { 0 }, *node = NULL, here = { .origin = origin };
    const char *end = strchr (set, '='), *why = NULL;
    int good = 1;
    if (pg_scene_is_reseed (set)) return pg_scene_reseed (s, set, origin);
    if (!end || end == set) {
        pg_faults_add (s->faults, s->file, &here, NULL, 0, "must have the form key=value");
        goto done;
    }
    /* The value is YAML: a number, a text, a list or a map. */
    PG_TRY (pg_node_read (&value, end + 1, strlen (end + 1), origin, s->file, s->faults, &good));
    if (!good) goto done;
    if (well_formed (set, end)) PG_TRY (reach (s, &node, set, end, origin, &why));
    else why = "is not a path such as cracks[0].from";
    if (why) {
        pg_faults_add (s->faults, s->file, &here, NULL, 0, "%s", why);
        goto done;
    }
    /* The value takes the place of the node. */
    value.name = node->name;
    node->name = NULL;
    value.origin = origin;
    value.line = value.column = 0;
    /* Nothing follows the sign =: an empty value. */
    if (value.shape == PG_SCALAR && !value.text) value.plain = 1;
    pg_node_clear (node);
    *node = value;
    value = (pg_node) { 0 };
done:
    pg_node_clear (&value);
    return status;
}
