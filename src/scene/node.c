/* SPDX-License-Identifier: GPL-3.0-or-later
 * The tree of a scene file: children by name, growth, release. Small maps are searched from their beginning,
 * large ones by a hash table, so that a scene of very many keys is read in a time that grows with their
 * number. */
#include "node.h"
#include <stdint.h>
#include <string.h>

/* FEW: maps of up to so many entries are searched one by one. MOST: most entries of a map. */
enum { FEW = 16, MOST = 1 << 30 };

/* FNV-1a, a hash of short texts. */
static size_t hash_of (const char *name, size_t length)
{
    uint64_t h = UINT64_C (0xCBF29CE484222325);
    for (size_t k = 0; k < length; k++) h = (h ^ (unsigned char) name[k]) * UINT64_C (0x100000001B3);
    return (size_t) (h ^ h >> 32);
}

static int is_called (const pg_node *node, const char *name, size_t length)
{
    return node->name && strncmp (node->name, name, length) == 0 && node->name[length] == '\0';
}

/* Returns the slot of a name in the hash table: that of the first child with this name, or an empty one. */
static size_t find_slot (const pg_node *parent, const char *name, size_t length)
{
    size_t s = hash_of (name, length) & (parent->slots - 1);
    while (parent->slot[s] && !is_called (&parent->child[parent->slot[s] - 1], name, length))
        s = (s + 1) & (parent->slots - 1);
    return s;
}

/* Enters child k into the hash table, unless an earlier one has its name. */
static void enter (pg_node *parent, size_t k)
{
    const char *name = parent->child[k].name;
    size_t s = name ? find_slot (parent, name, strlen (name)) : 0;
    if (name && !parent->slot[s]) parent->slot[s] = (unsigned) k + 1;
}

/* Enters the last child into the hash table of a large map, which is kept at most half full. */
static pg_status index_last (pg_node *parent)
{
    pg_status status = PG_OK;
    if (parent->n <= FEW) return PG_OK;
    if (2 * parent->n > parent->slots) {
        pg_free (parent->slot);
        parent->slots = 8 * FEW;
        while (parent->slots < 4 * parent->n) parent->slots *= 2;
        PG_ALLOC (parent->slot, parent->slots);
        for (size_t k = 0; k + 1 < parent->n; k++) enter (parent, k);
    }
    enter (parent, parent->n - 1);
done:
    if (status != PG_OK) parent->slots = 0;
    return status;
}

/* Appends a child. Children of a node are one array, which may move when it grows. */
pg_status pg_node_add (pg_node **child, pg_node *parent, const char *name)
{
    pg_status status = PG_OK;
    char *copy = NULL;
    if (parent->n >= MOST) PG_FAIL (PG_E_LIMIT, "a part of the scene has more than %d entries", MOST);
    if (name && !(copy = pg_strdup (name))) PG_FAIL (PG_E_MEMORY, "no memory for a key of the scene");
    PG_GROW (parent->child, parent->cap, parent->n + 1);
    *child = &parent->child[parent->n++];
    **child = (pg_node) { .name = copy };
    copy = NULL;
    if (name) PG_TRY (index_last (parent));
done:
    pg_free (copy);
    return status;
}

/* Makes the node a single value, as if it were written without quotes. */
pg_status pg_node_word (pg_node *node, const char *text, const char *origin)
{
    node->shape = PG_SCALAR;
    node->plain = 1;
    node->origin = origin;
    node->text = pg_strdup (text);
    return node->text ? PG_OK : pg_error (PG_E_MEMORY, PG_HERE, "no memory for a value of the scene");
}

pg_node *pg_node_child (const pg_node *parent, const char *name, size_t length)
{
    if (parent->shape != PG_MAPPING) return NULL;
    if (parent->slots) {
        size_t s = find_slot (parent, name, length);
        return parent->slot[s] ? &parent->child[parent->slot[s] - 1] : NULL;
    }
    for (size_t k = 0; k < parent->n; k++)
        if (is_called (&parent->child[k], name, length)) return &parent->child[k];
    return NULL;
}

/* A text in quotes is never null, even if it is empty. */
int pg_node_null (const pg_node *node)
{
    return node->shape == PG_SCALAR && node->plain
           && (!node->text || *node->text == '\0' || strcmp (node->text, "~") == 0);
}

/* Releases a node with all below it. */
void pg_node_clear (pg_node *node)
{
    for (size_t k = 0; k < node->n; k++) pg_node_clear (&node->child[k]);
    pg_free (node->child), pg_free (node->slot);
    pg_free (node->text);
    pg_free (node->name);
    *node = (pg_node) { 0 };
}
