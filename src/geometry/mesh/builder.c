/* SPDX-License-Identifier: GPL-3.0-or-later
 * A mesh under construction: readers hand over nodes, elements and sets in the numbers of their file, in
 * any order; pg_mesh_builder_finish makes a mesh of them (builder_solid.c, builder_set.c). */
#include "builder.h"
#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Array `start` has one entry more than there are elements: the nodes of element e are start[e] .. start[e +
 * 1] - 1 of list. */
pg_status pg_mesh_builder_create (pg_mesh_builder **out, const char *path)
{
    pg_status status = PG_OK;
    pg_mesh_builder *m = NULL;
    PG_ALLOC (m, 1);
    PG_GROW (m->start, m->cap.start, 1);
    m->path = pg_strdup (path);
    if (!m->path) PG_FAIL (PG_E_MEMORY, "no memory for the name of a file");
done:
    if (status != PG_OK) pg_mesh_builder_free (&m);
    *out = m;
    return status;
}

void pg_mesh_builder_free (pg_mesh_builder **builder)
{
    pg_mesh_builder *m = *builder;
    if (!m) return;
    pg_free (m->path), pg_free (m->node_id), pg_free (m->x);
    pg_free (m->element_id), pg_free (m->group), pg_free (m->line), pg_free (m->kind), pg_free (m->start),
        pg_free (m->list);
    pg_free (m->groups), pg_free (m->sets), pg_free (m->side_sets), pg_free (m->set_node),
        pg_free (m->side_element), pg_free (m->side);
    pg_free (m->passed), pg_free (m->foreign);
    pg_free (m->made.index), pg_free (m->made.solid), pg_free (m->made.turned), pg_free (m->made.kept);
    pg_id_table_clear (&m->made.nodes);
    pg_free (m);
    *builder = NULL;
}

/* Coordinates beyond 1e100 are refused: their cubes, which volumes need, would overflow. */
pg_status pg_mesh_builder_node (pg_mesh_builder *m, long id, const double *x)
{
    /* The cube of 1e100 is still a number. */
    enum { EXPONENT = 100 };
    pg_status status = PG_OK;
    for (int a = 0; a < 3; a++)
        if (!(fabs (x[a]) <= pow (10, EXPONENT)))
            PG_FAIL (PG_E_FILE, "%s: node %ld: coordinate %d is %g; it must be a number below 1e%d", m->path,
                     id, a + 1, x[a], EXPONENT);
    if (m->nnode >= INT_MAX) PG_FAIL (PG_E_LIMIT, "%s: more than %d nodes", m->path, INT_MAX);
    PG_GROW (m->node_id, m->cap.node, m->nnode + 1);
    PG_GROW (m->x, m->cap.x, 3 * (m->nnode + 1));
    m->node_id[m->nnode] = id;
    memcpy (m->x + 3 * m->nnode, x, 3 * sizeof *x);
    m->nnode++;
done:
    return status;
}

/* Whether the nodes exist is checked only at the end, since files may give elements first. */
pg_status pg_mesh_builder_element (pg_mesh_builder *m, long id, pg_element kind, const long *node, long group,
                                   long line)
{
    pg_status status = PG_OK;
    if ((unsigned) kind >= PG_ELEMENTS)
        PG_FAIL (PG_E_USAGE, "%s: element %ld: there is no kind %d", m->path, id, (int) kind);
    if (m->n >= INT_MAX) PG_FAIL (PG_E_LIMIT, "%s: more than %d elements", m->path, INT_MAX);
    size_t nodes = (size_t) pg_element_types[kind].nodes, first = m->start[m->n];
    PG_GROW (m->element_id, m->cap.element, m->n + 1);
    PG_GROW (m->group, m->cap.group, m->n + 1);
    PG_GROW (m->line, m->cap.line, m->n + 1);
    PG_GROW (m->kind, m->cap.kind, m->n + 1);
    PG_GROW (m->start, m->cap.start, m->n + 2);
    PG_GROW (m->list, m->cap.list, first + nodes);
    m->element_id[m->n] = id, m->group[m->n] = group, m->line[m->n] = line,
    m->kind[m->n] = (unsigned char) kind;
    memcpy (m->list + first, node, nodes * sizeof *node);
    /* The element counts only now, after all memory has been found. */
    m->start[++m->n] = m->nlist = first + nodes;
done:
    return status;
}

/* Copies a name. Control characters become _, as names appear in messages of one line; what is too long is
 * cut between characters of UTF-8. */
static void copy_text (char *to, size_t size, const char *name)
{
    size_t n = strlen (name);
    if (n > size - 1) for (n = size - 1; n > 0 && ((unsigned char) name[n] & 0xC0) == 0x80; ) n--;
    for (size_t k = 0; k < n; k++) to[k] = (unsigned char) name[k] < ' ' || name[k] == 127 ? '_' : name[k];
    to[n] = '\0';
}

static void copy_name (char to[64], const char *name) { copy_text (to, 64, name); }

/* Stores a name of a group; there may be several, of which builder_name chooses one. */
pg_status pg_mesh_builder_group (pg_mesh_builder *m, int dim, long group, const char *name)
{
    pg_status status = PG_OK;
    if (!*name) return PG_OK;
    PG_GROW (m->groups, m->cap.groups, m->ngroup + 1);
    mesh_group *g = &m->groups[m->ngroup++];
    g->dim = dim, g->group = group;
    copy_name (g->name, name);
done:
    return status;
}

/* Begins a set whose first entry is number `first`. */
static void name_list (mesh_list *l, const char *name, long id, size_t first)
{
    memset (l, 0, sizeof *l);
    l->id = id, l->first = l->end = first;
    if (name && *name) copy_name (l->name, name);
    else snprintf (l->name, sizeof l->name, "%ld", id);
}

/* The set begins where the entries of the last one end. */
pg_status pg_mesh_builder_nodeset (pg_mesh_builder *m, const char *name, long id)
{
    pg_status status = PG_OK;
    PG_GROW (m->sets, m->cap.set, m->nset + 1);
    name_list (&m->sets[m->nset++], name, id, m->nset_node);
done:
    return status;
}

/* Adds a node by its number in the file; the same one may come twice. */
pg_status pg_mesh_builder_nodeset_add (pg_mesh_builder *m, long node)
{
    pg_status status = PG_OK;
    if (m->nset == 0) PG_FAIL (PG_E_USAGE, "%s: a node is added to a set before there is one", m->path);
    PG_GROW (m->set_node, m->cap.set_node, m->nset_node + 1);
    m->set_node[m->nset_node++] = node;
    m->sets[m->nset - 1].end = m->nset_node;
done:
    return status;
}

pg_status pg_mesh_builder_sideset (pg_mesh_builder *m, const char *name, long id)
{
    pg_status status = PG_OK;
    PG_GROW (m->side_sets, m->cap.side_set, m->nside_set + 1);
    name_list (&m->side_sets[m->nside_set++], name, id, m->nside);
done:
    return status;
}

pg_status pg_mesh_builder_sideset_add (pg_mesh_builder *m, long element, int side)
{
    pg_status status = PG_OK;
    if (m->nside_set == 0) PG_FAIL (PG_E_USAGE, "%s: a side is added to a set before there is one", m->path);
    PG_GROW (m->side_element, m->cap.side_element, m->nside + 1);
    PG_GROW (m->side, m->cap.side, m->nside + 1);
    m->side_element[m->nside] = element, m->side[m->nside] = side;
    m->side_sets[m->nside_set - 1].end = ++m->nside;
done:
    return status;
}

pg_status pg_mesh_builder_pass (pg_mesh_builder *m, const char *format, ...)
{
    pg_status status = PG_OK;
    char words[300], clean[sizeof m->passed->what];
    size_t k = 0;
    va_list args;
    va_start (args, format);
    vsnprintf (words, sizeof words, format, args);
    va_end (args);
    copy_text (clean, sizeof clean, words);
    while (k < m->npassed && strcmp (m->passed[k].what, clean) != 0) k++;
    if (k == m->npassed) {
        PG_GROW (m->passed, m->cap.passed, m->npassed + 1);
        memset (&m->passed[m->npassed], 0, sizeof *m->passed);
        snprintf (m->passed[m->npassed++].what, sizeof m->passed->what, "%s", clean);
    }
    m->passed[k].n++;
done:
    return status;
}

/* Stores the first element type for plane strain; later ones are ignored. */
void pg_mesh_builder_plane_strain (pg_mesh_builder *m, const char *type)
{
    if (!*m->plane_strain) copy_text (m->plane_strain, sizeof m->plane_strain, type);
}

pg_status pg_mesh_builder_foreign (pg_mesh_builder *m, const char *type, const char *block,
                                   const char *words)
{
    pg_status status = PG_OK;
    size_t before = m->npassed;
    PG_TRY (pg_mesh_builder_pass (m, "elements %.30s%s%.40s", type, *block ? " of " : "", block));
    if (m->npassed == before) goto done;
    PG_GROW (m->foreign, m->cap.foreign, m->nforeign + 1);
    pg_mesh_foreign *f = &m->foreign[m->nforeign++];
    memset (f, 0, sizeof *f);
    copy_name (f->block, block);
    copy_text (f->words, sizeof f->words, words);
done:
    return status;
}

void pg_mesh_builder_group_name (const pg_mesh_builder *m, int dim, long group, char name[64])
{
    snprintf (name, 64, "%ld", group);
    if (group == 0) name[0] = 0;
    for (size_t k = 0; k < m->ngroup; k++)
        if (m->groups[k].group == group && (dim == 0 || m->groups[k].dim == dim)) {
            memcpy (name, m->groups[k].name, 64);
            return;
        }
}

/* A view of the arrays, without copies. */
pg_mesh_given pg_mesh_builder_given (const pg_mesh_builder *m)
{
    return (pg_mesh_given) { .nnode = m->nnode, .node_id = m->node_id, .n = m->n, .element_id = m->element_id,
                             .group = m->group, .kind = m->kind, .start = m->start, .node = m->list,
                             .nforeign = m->nforeign };
}

/* Element e, by its order in the file, goes to another block. */
void pg_mesh_builder_regroup (pg_mesh_builder *m, size_t e, long group) { m->group[e] = group; }

/* Are all numbers of the list within 1 .. most? */
static int counted (const long *list, size_t n, size_t most)
{
    for (size_t i = 0; i < n; i++) if (list[i] < 1 || (size_t) list[i] > most) return 0;
    return 1;
}

/* Replaces each number k by by[k - 1]. */
static void replace (long *list, size_t n, const long *by)
{
    for (size_t i = 0; i < n; i++) list[i] = by[list[i] - 1];
}

/* All lists are checked first, so that nothing is half renumbered. */
void pg_mesh_builder_renumber (pg_mesh_builder *m, size_t nnode, const long *node, const long *element)
{
    if (node && (!counted (m->list, m->nlist, nnode) || !counted (m->set_node, m->nset_node, nnode))) return;
    if (node) {
        memcpy (m->node_id, node, m->nnode * sizeof *node);
        replace (m->list, m->nlist, node);
        replace (m->set_node, m->nset_node, node);
    }
    if (element) {
        /* by their order in the file: some elements have been left out */
        replace (m->element_id, m->n, element);
        replace (m->side_element, m->nside, element);
    }
}

/* File, line and number of an element for messages; lines are known of formats that have lines. */
void builder_where (const pg_mesh_builder *m, size_t e, char *text, size_t size)
{
    if (m->line[e] > 0)
        snprintf (text, size, "%.400s, line %ld: element %ld", m->path, m->line[e], m->element_id[e]);
    else snprintf (text, size, "%.400s: element %ld", m->path, m->element_id[e]);
}

/* Order of groups: by dimension, then number. */
static int by_group (const void *p, const void *q)
{
    const mesh_group *a = p, *b = q;
    if (a->dim != b->dim) return a->dim < b->dim ? -1 : 1;
    return (a->group > b->group) - (a->group < b->group);
}

/* Order of groups: dimension, number, name, so that of several names the first in the alphabet is taken. */
static int by_group_and_name (const void *p, const void *q)
{
    int c = by_group (p, q);
    return c ? c : strcmp (((const mesh_group *) p)->name, ((const mesh_group *) q)->name);
}

/* Finds the name of a group among the sorted groups; of several names the first is taken. */
void builder_name (const pg_mesh_builder *m, int dim, long group, char name[64])
{
    snprintf (name, 64, "%ld", group);
    mesh_group key = { .dim = dim, .group = group },
               *g = group && m->ngroup ? pg_search (&key, m->groups, m->ngroup, sizeof key, by_group) : NULL;
    /* bsearch may find any of several equal ones. */
    while (g && g > m->groups && by_group (g - 1, &key) == 0) g--;
    if (g) memcpy (name, g->name, 64);
}

/* On failure the mesh is cleared; the builder can only be freed afterwards. */
pg_status pg_mesh_builder_finish (pg_mesh_builder *m, pg_mesh *out)
{
    pg_status status = PG_OK;
    int solid = 0;
    memset (out, 0, sizeof *out);
    m->made.out = out;
    for (size_t e = 0; e < m->n && !solid; e++) solid = pg_element_types[m->kind[e]].dim > 0;
    if (!solid && m->nforeign) PG_FAIL (PG_E_FILE, "%s", m->foreign[0].words);
    if (m->ngroup) pg_sort (m->groups, m->ngroup, sizeof *m->groups, by_group_and_name);
    PG_TRY (builder_resolve (m));
    PG_TRY (builder_solids (m));
    PG_TRY (builder_sets (m));
    out->passed = m->passed, out->npassed = m->npassed, m->passed = NULL;
    memcpy (out->plane_strain, m->plane_strain, sizeof out->plane_strain);
    out->foreign = m->foreign, out->nforeign = m->nforeign, m->foreign = NULL;
done:
    if (status != PG_OK) pg_mesh_clear (out);
    return status;
}
