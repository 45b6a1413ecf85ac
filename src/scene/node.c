/* SPDX-License-Identifier: GPL-3.0-or-later
 * The tree of a scene file: children by name, growth, release. */
#include "node.h"
#include <string.h>

/* Children of a node are one array, which may move when it grows. */
pg_status pg_node_add (pg_node **child, pg_node *parent, const char *name)
{
    pg_status status = PG_OK;
    char *copy = NULL;
    if (name && !(copy = pg_strdup (name))) PG_FAIL (PG_E_MEMORY, "no memory for a key of the scene");
    PG_GROW (parent->child, parent->cap, parent->n + 1);
    *child = &parent->child[parent->n++];
    **child = (pg_node) { .name = copy };
    copy = NULL;
done:
    pg_free (copy);
    return status;
}

/* As if it were written without quotes. */
pg_status pg_node_word (pg_node *node, const char *text, const char *origin)
{
    node->shape = PG_SCALAR;
    node->plain = 1;
    node->origin = origin;
    node->text = pg_strdup (text);
    return node->text ? PG_OK : pg_error (PG_E_MEMORY, PG_HERE, "no memory for a value of the scene");
}

/* A linear search: maps of scenes have few keys. */
pg_node *pg_node_child (const pg_node *parent, const char *name, size_t length)
{
    if (parent->shape != PG_MAPPING) return NULL;
    for (size_t k = 0; k < parent->n; k++) {
        const char *own = parent->child[k].name;
        if (own && strncmp (own, name, length) == 0 && own[length] == '\0') return &parent->child[k];
    }
    return NULL;
}

/* A text in quotes is never nothing. */
int pg_node_null (const pg_node *node)
{
    return node->shape == PG_SCALAR && node->plain
           && (!node->text || *node->text == '\0' || strcmp (node->text, "~") == 0);
}

/* Releases a node with all below it. */
void pg_node_clear (pg_node *node)
{
    for (size_t k = 0; k < node->n; k++) pg_node_clear (&node->child[k]);
    pg_free (node->child);
    pg_free (node->text);
    pg_free (node->name);
    *node = (pg_node) { 0 };
}
