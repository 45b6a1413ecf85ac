/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sets of an .inp file: numbers, ranges and other sets by name, resolved once all nodes and elements are
 * known.
 *
 * Members of sets by number must exist, with the exception of ranges by GENERATE, which may have gaps.
 * Blocks are element sets that *ELEMENT names, or those of sections. */
#include "abaqus.h"
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* ---- the sets as written ------------------------------------------------------------------------------- */
/* A linear search: files have few sets. */
int abaqus_set_find (const abaqus_sets *sets, const char *name)
{
    for (size_t k = 0; k < sets->n; k++) if (strcasecmp (sets->set[k].name, name) == 0) return (int) k;
    return -1;
}

/* A set that does not exist yet is created empty. */
pg_status abaqus_set_get (abaqus_sets *sets, const char *name, int *set)
{
    pg_status status = PG_OK;
    *set = abaqus_set_find (sets, name);
    if (*set >= 0) goto done;
    PG_GROW (sets->set, sets->capacity, sets->n + 1);
    memset (&sets->set[sets->n], 0, sizeof *sets->set);
    snprintf (sets->set[sets->n].name, ABAQUS_NAME, "%s", name);
    *set = (int) sets->n++;
done:
    return status;
}

/* Consecutive numbers share one range, as sets often list a million of them. */
pg_status abaqus_set_add (abaqus_set *set, abaqus_range range)
{
    pg_status status = PG_OK;
    abaqus_range *last = set->n ? &set->range[set->n - 1] : NULL;
    /* Members that must exist (line > 0) and those that need not are not joined to one range. */
    if (last && last->step == 1 && range.step == 1 && range.first == range.last
        && range.first == last->last + 1 && !last->line == !range.line) {
        last->last = range.last;
        goto done;
    }
    PG_GROW (set->range, set->capacity, set->n + 1);
    set->range[set->n++] = range;
done:
    return status;
}

void abaqus_sets_free (abaqus_sets *sets)
{
    for (size_t k = 0; k < sets->n; k++) pg_free (sets->set[k].range);
    pg_free (sets->set);
    *sets = (abaqus_sets) { 0 };
}

/* ---- what is in a set ---------------------------------------------------------------------------------- */
/* The members of one set, collected as indices into the list of all nodes or all elements. */
typedef struct {
    /* "node" or "element", for messages. */
    const char *what;
    const abaqus_sets *sets;
    /* Finds the index of a number in the list id of all numbers. */
    pg_id_table table;
    const long *id;
    /* How many nodes or elements the file has, and the set. */
    size_t   all, n;
    /* Indices of the members of the set (n). */
    int     *place;
    /* in: 1 for nodes or elements in the set (all). seen: 1 for sets that have been visited (sets->n). */
    unsigned char *in, *seen;
    /* Sets to be visited. */
    int     *todo;
} gather;

/* All that resolving needs. */
typedef struct { abaqus *a; pg_mesh_given given; gather node, element; } resolver;

/* Releases what gather_start allocated. */
static void gather_clear (gather *g)
{
    pg_id_table_clear (&g->table);
    pg_free (g->place), pg_free (g->in), pg_free (g->seen), pg_free (g->todo);
}

/* Numbers that are given twice are left for the builder to report. */
static pg_status gather_start (gather *g, const char *what, const abaqus_sets *sets, size_t n, const long *id)
{
    pg_status status = PG_OK;
    size_t twice;
    g->what = what, g->sets = sets, g->all = n, g->id = id;
    /* Numbers that are given twice are reported by the builder. */
    PG_TRY (pg_id_table_build (&g->table, n, id, &twice));
    PG_ALLOC (g->place, n);
    PG_ALLOC (g->in, n);
    PG_ALLOC (g->seen, sets->n);
    PG_ALLOC (g->todo, sets->n);
done:
    return status;
}

/* Adds index `place` to the set, unless it is in it already; -1 adds nothing. */
static void put (gather *g, long place)
{
    if (place < 0 || g->in[place]) return;
    g->in[place] = 1;
    g->place[g->n++] = (int) place;
}

/* Empties the set. */
static void forget (gather *g)
{
    for (size_t k = 0; k < g->n; k++) g->in[g->place[k]] = 0;
    g->n = 0;
}

/* Returns the fault that a member of a set does not exist. The line is not named if files were included, as
 * it might belong to any of these. */
static pg_status fault (const resolver *r, long line, const char *what, long id, const char *set)
{
    char at[32] = "";
    if (line > 0 && !r->a->included) snprintf (at, sizeof at, ", line %ld", line);
    return pg_error (PG_E_FILE, PG_HERE, "%s%s: %s %ld of set '%s' is not there", r->a->path, at, what, id,
                     set);
}

/* 1 if id is the number of an element that was skipped. */
static int is_skipped (const resolver *r, const gather *g, long id)
{
    const abaqus_set *s = &r->a->skipped;
    for (size_t k = 0; g->sets == &r->a->elset && k < s->n; k++)
        if (id >= s->range[k].first && id <= s->range[k].last) return 1;
    return 0;
}

/* Adds the members of a range. A range with more numbers than the file has is not walked number by number. */
static pg_status put_range (const resolver *r, gather *g, const abaqus_range *range, const char *set)
{
    size_t count = range->last < range->first
                       ? 0
                       : ((size_t) range->last - (size_t) range->first) / (size_t) range->step + 1;
    /* The range has more numbers than the file: at least one is missing, and the first such is reported. */
    if (count > g->all && range->line) {
        for (long id = range->first; id <= range->last; id++)
            if (pg_id_table_find (&g->table, id) < 0 && !is_skipped (r, g, id))
                return fault (r, range->line, g->what, id, set);
    }
    /* Ranges by GENERATE may have gaps: the list of all numbers is walked instead of the range. */
    if (count > g->all) {
        for (size_t k = 0; k < g->all; k++)
            if (g->id[k] >= range->first && g->id[k] <= range->last
                && ((size_t) g->id[k] - (size_t) range->first) % (size_t) range->step == 0)
                put (g, (long) k);
        return PG_OK;
    }
    long id = range->first;
    for (size_t k = 0; k < count; k++, id += k < count ? range->step : 0) {
        long place = pg_id_table_find (&g->table, id);
        if (place < 0 && range->line && !is_skipped (r, g, id))
            return fault (r, range->line, g->what, id, set);
        put (g, place);
    }
    return PG_OK;
}

/* Collects the members of a set; defined below, as element sets may stand within node sets. */
static pg_status collect (resolver *r, gather *g, int set);
/* Adds the nodes of element e. */
static void put_nodes (resolver *r, int e)
{
    const pg_mesh_given *m = &r->given;
    for (size_t j = m->start[e]; j < m->start[e + 1]; j++)
        put (&r->node, pg_id_table_find (&r->node.table, m->node[j]));
}

/* Adds the nodes of an element set. */
static pg_status put_nodes_of (resolver *r, int element_set)
{
    pg_status status = collect (r, &r->element, element_set);
    for (size_t k = 0; status == PG_OK && k < r->element.n; k++) put_nodes (r, r->element.place[k]);
    return status;
}

/* Collects a set. Sets named by sets are visited once each, so that sets which name one another come to an
 * end. */
static pg_status collect (resolver *r, gather *g, int set)
{
    pg_status status = PG_OK;
    size_t todo = 0, done_with = 0;
    forget (g);
    g->todo[todo++] = set;
    g->seen[set] = 1;
    /* Breadth first: sets named on the way are appended. */
    while (done_with < todo) {
        const abaqus_set *s = &g->sets->set[g->todo[done_with++]];
        for (size_t k = 0; status == PG_OK && k < s->n; k++) {
            const abaqus_range *range = &s->range[k];
            if (range->step == ABAQUS_NODES_OF) status = put_nodes_of (r, (int) range->first);
            else if (range->step != ABAQUS_SET) status = put_range (r, g, range, s->name);
            else if (!g->seen[range->first]) g->seen[range->first] = 1, g->todo[todo++] = (int) range->first;
        }
    }
    for (size_t k = 0; k < todo; k++) g->seen[g->todo[k]] = 0;
    return status;
}

/* ---- into the builder ---------------------------------------------------------------------------------- */
/* Elements without a set of their own belong to the set of the first section that names them. */
static pg_status resolve_blocks (resolver *r)
{
    pg_status status = PG_OK;
    abaqus *a = r->a;
    for (size_t k = 0; k < a->nsection; k++) {
        int used = 0;
        PG_TRY (collect (r, &r->element, a->section[k]));
        for (size_t i = 0; i < r->element.n; i++) {
            size_t e = (size_t) r->element.place[i];
            if (r->given.group[e] != 0) continue;
            pg_mesh_builder_regroup (a->builder, e, a->section[k] + 1);
            used = 1;
        }
        if (used) a->elset.set[a->section[k]].named = 1;
    }
    /* Names of blocks, for elements of any dimension. */
    for (size_t k = 0; k < a->elset.n; k++)
        for (int dim = 0; dim <= 3 && a->elset.set[k].named; dim++)
            PG_TRY (pg_mesh_builder_group (a->builder, dim, (long) k + 1, a->elset.set[k].name));
done:
    return status;
}

/* The collected nodes become a node set, unless there are none. */
static pg_status emit_nodes (resolver *r, const char *name, long id)
{
    pg_status status = PG_OK;
    if (r->node.n == 0) goto done;
    PG_TRY (pg_mesh_builder_nodeset (r->a->builder, name, id));
    for (size_t i = 0; i < r->node.n; i++)
        PG_TRY (pg_mesh_builder_nodeset_add (r->a->builder, r->node.id[r->node.place[i]]));
done:
    return status;
}

/* Gives the builder the node sets, and the nodes of element sets that are neither blocks nor have the name of
 * a node set. */
static pg_status resolve_sets (resolver *r)
{
    pg_status status = PG_OK;
    abaqus *a = r->a;
    for (size_t k = 0; k < a->nset.n; k++) {
        PG_TRY (collect (r, &r->node, (int) k));
        PG_TRY (emit_nodes (r, a->nset.set[k].name, (long) k + 1));
    }
    for (size_t k = 0; k < a->elset.n; k++) {
        /* A block becomes no node set, nor does an element set with the name of a node set of the file. */
        if (a->elset.set[k].named || abaqus_set_find (&a->nset, a->elset.set[k].name) >= 0) continue;
        forget (&r->node);
        PG_TRY (put_nodes_of (r, (int) k));
        PG_TRY (emit_nodes (r, a->elset.set[k].name, (long) (a->nset.n + k) + 1));
    }
done:
    return status;
}

/* Highest dimension of all elements. */
static int top_dimension (const pg_mesh_given *m)
{
    int dim = 0;
    for (size_t e = 0; e < m->n; e++)
        if (pg_element_types[m->kind[e]].dim > dim) dim = pg_element_types[m->kind[e]].dim;
    return dim;
}

/* Collects the elements that one line of a surface names. */
static pg_status collect_face (resolver *r, const abaqus_surface *surface, const abaqus_face *face)
{
    if (face->set >= 0) return collect (r, &r->element, face->set);
    long place = pg_id_table_find (&r->element.table, face->element);
    forget (&r->element);
    if (place < 0 && is_skipped (r, &r->element, face->element)) return PG_OK;
    if (place < 0) return fault (r, face->line, "element", face->element, surface->name);
    put (&r->element, place);
    return PG_OK;
}

/* Side that a line of a surface means for one element; -2: the face of a shell, also of one that is the
 * skin of a solid body; -1: none that is known. */
static int side_of (const resolver *r, const abaqus_face *face, int place, int dim)
{
    const pg_mesh_given *m = &r->given;
    pg_element kind = (pg_element) m->kind[place];
    int side = abaqus_side (kind, r->a->shell[place], face->face);
    return side != -2 && pg_element_types[kind].dim < dim ? -1 : side;
}

/* *whole becomes 0 if a face of the surface is unknown: the whole surface is then skipped rather than made
 * incomplete, and a scene that names it finds no such set. */
static pg_status whole_surface (resolver *r, const abaqus_surface *surface, int dim, int *whole)
{
    pg_status status = PG_OK;
    const pg_mesh_given *m = &r->given;
    *whole = 1;
    for (size_t k = 0; k < surface->n && *whole; k++) {
        PG_TRY (collect_face (r, surface, &surface->face[k]));
        for (size_t i = 0; i < r->element.n && *whole; i++) {
            int e = r->element.place[i];
            *whole = side_of (r, &surface->face[k], e, dim) != -1;
            if (!*whole)
                PG_TRY (pg_mesh_builder_pass (r->a->builder, "surface %.30s (element %ld, %s, has no face "
                                              "%.10s)", surface->name, m->element_id[e],
                                              pg_element_types[m->kind[e]].name, surface->face[k].face));
        }
    }
done:
    return status;
}

/* Sides become a side set. Faces of shells are no sides of plane elements: their nodes become a node set,
 * unless the surface has sides as well. */
static pg_status resolve_surface (resolver *r, const abaqus_surface *surface, long id, int dim)
{
    pg_status status = PG_OK;
    int side, begun = 0, whole;
    PG_TRY (whole_surface (r, surface, dim, &whole));
    if (!whole) goto done;
    forget (&r->node);
    for (size_t k = 0; k < surface->n; k++) {
        PG_TRY (collect_face (r, surface, &surface->face[k]));
        for (size_t i = 0; i < r->element.n; i++) {
            int e = r->element.place[i];
            side = side_of (r, &surface->face[k], e, dim);
            /* The face of a shell: its nodes join the node set of the surface. */
            if (side == -2) {
                put_nodes (r, e);
                continue;
            }
            if (!begun) PG_TRY (pg_mesh_builder_sideset (r->a->builder, surface->name, id));
            PG_TRY (pg_mesh_builder_sideset_add (r->a->builder, r->element.id[e], side));
            begun = 1;
        }
    }
    if (!begun && abaqus_set_find (&r->a->nset, surface->name) < 0)
        PG_TRY (emit_nodes (r, surface->name, id));
done:
    return status;
}

/* Blocks first: whether an element set is a block decides what becomes of it as a set. */
pg_status abaqus_resolve (abaqus *a)
{
    pg_status status = PG_OK;
    resolver r = { .a = a, .given = pg_mesh_builder_given (a->builder) };
    int dim = top_dimension (&r.given);
    PG_TRY (gather_start (&r.node, "node", &a->nset, r.given.nnode, r.given.node_id));
    PG_TRY (gather_start (&r.element, "element", &a->elset, r.given.n, r.given.element_id));
    PG_TRY (resolve_blocks (&r));
    PG_TRY (resolve_sets (&r));
    for (size_t s = 0; s < a->nsurface; s++)
        PG_TRY (resolve_surface (&r, &a->surface[s], (long) (a->nset.n + a->elset.n + s) + 1, dim));
done:
    gather_clear (&r.node), gather_clear (&r.element);
    return status;
}
