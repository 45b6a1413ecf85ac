/* SPDX-License-Identifier: GPL-3.0-or-later
 * Node sets and side sets of a mesh: those of the file, those that elements of lower dimension name, and the
 * nodes of every side set. Sets of equal name are one, except a node set and a side set of the file that have
 * other nodes: these are renamed NAME_nodes and NAME_sides, as formats number both from 1. Members are
 * collected as integers (set, member) in one list; sorting it puts the sets in order and their members too,
 * and shows repetitions.
 *
 * An element of dimension dim - 1 that is a face of a solid element is a side in the set that its group
 * names; whether it is a face is found by its corners, so that first and second order may be mixed. */
#include "builder.h"
#include "element.h"
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A set before sets of equal name are united. place: its number in the order of appearance. sides: 1: it is a
 * side set as well. */
typedef struct { char name[64]; long id; size_t place; int sides; } named;
/* A group of elements that names a set. */
typedef struct { int dim; long group; size_t set; } source;
/* Members: set << 32 | node, or set << 34 | element << 3 | side. */
typedef struct { size_t n, cap; uint64_t *pair; } pairs;

/* The sets under construction. */
typedef struct {
    pg_mesh_builder *m;
    /* Number of sets before equal names are united, and capacity. */
    size_t  n, cap;
    named  *set;
    /* Number of each of these sets in the mesh (n). */
    size_t *final;
    /* Number of sets in the mesh. */
    size_t  nfinal;
    size_t  nsource, source_cap;
    source *source;
    pairs   nodes, sides;
} builder;

/* Largest number of sets, so that the number of a set fits into its bits of a pair. */
enum { MOST_SETS = 1 << 28 };

/* Appends a member; repetitions are removed after sorting. */
static pg_status add_pair (pairs *p, uint64_t pair)
{
    pg_status status = PG_OK;
    PG_GROW (p->pair, p->cap, p->n + 1);
    p->pair[p->n++] = pair;
done:
    return status;
}

/* Adds a node of the mesh to a set; -1 (a node that no solid element uses) adds nothing. */
static pg_status add_node (builder *b, size_t set, int node)
{
    return node < 0 ? PG_OK : add_pair (&b->nodes, (uint64_t) b->final[set] << 32 | (unsigned) node);
}

/* Adds a side of solid element e and the nodes of that face. */
static pg_status add_side (builder *b, size_t set, size_t e, int side)
{
    pg_status status = PG_OK;
    const pg_mesh *out = b->m->made.out;
    int node[9], n = pg_element_types[pg_element_face (out->kind[e], side, node)].nodes;
    PG_TRY (add_pair (&b->sides, (uint64_t) b->final[set] << 34 | (uint64_t) e << 3 | (unsigned) side));
    for (int k = 0; k < n; k++) PG_TRY (add_node (b, set, out->node[out->start[e] + (size_t) node[k]]));
done:
    return status;
}

/* ---- names of sets ------------------------------------------------------------------------------------- */
/* Appends a set. */
static pg_status add_name (builder *b, const char *name, long id, int sides)
{
    pg_status status = PG_OK;
    if (b->n >= MOST_SETS) PG_FAIL (PG_E_LIMIT, "%s: more than %d sets", b->m->path, MOST_SETS);
    PG_GROW (b->set, b->cap, b->n + 1);
    named *s = &b->set[b->n];
    memset (s, 0, sizeof *s);
    snprintf (s->name, sizeof s->name, "%s", name);
    s->id = id, s->place = b->n++, s->sides = sides;
done:
    return status;
}

/* Orders sources by descending dimension (repeated solid elements, then faces, lines, points), then by
 * group. */
static int by_source (const void *p, const void *q)
{
    const source *a = p, *b = q;
    if (a->dim != b->dim) return a->dim > b->dim ? -1 : 1;
    return (a->group > b->group) - (a->group < b->group);
}

/* Elements that only name a set: those of lower dimension, and repetitions of solid ones. */
static int names_a_set (const pg_mesh_builder *m, size_t e)
{
    return m->group[e] && m->made.solid[e] < 0;
}

/* Adds one set for each group of the elements that only name a set. */
static pg_status add_sources (builder *b)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    size_t n = 0;
    for (size_t e = 0; e < m->n; e++) {
        source s = { pg_element_types[m->kind[e]].dim, m->group[e], 0 };
        if (!names_a_set (m, e) || (b->nsource && by_source (&s, &b->source[b->nsource - 1]) == 0)) continue;
        PG_GROW (b->source, b->source_cap, b->nsource + 1);
        b->source[b->nsource++] = s;
    }
    if (b->nsource) pg_sort (b->source, b->nsource, sizeof *b->source, by_source);
    for (size_t k = 0; k < b->nsource; k++)
        if (n == 0 || by_source (&b->source[k], &b->source[n - 1]) != 0) b->source[n++] = b->source[k];
    b->nsource = n;
    for (size_t k = 0; k < n; k++) {
        char name[64];
        builder_name (m, b->source[k].dim, b->source[k].group, name);
        b->source[k].set = b->n;
        PG_TRY (add_name (b, name, b->source[k].group, 0));
    }
done:
    return status;
}

/* Orders sets by name, equal names by their appearance. */
static int by_name (const void *p, const void *q)
{
    const named *a = p, *b = q;
    int c = strcmp (a->name, b->name);
    return c ? c : (a->place > b->place) - (a->place < b->place);
}

static int by_place (const void *p, const void *q)
{
    const named *a = p, *b = q;
    return (a->place > b->place) - (a->place < b->place);
}

/* Unites sets of equal name under the number of the first of them. As final[k] <= k, the sets can be moved in
 * place. */
static pg_status unite (builder *b)
{
    pg_status status = PG_OK;
    size_t *first = NULL;
    PG_ALLOC (first, b->n);
    PG_ALLOC (b->final, b->n);
    if (b->n) pg_sort (b->set, b->n, sizeof *b->set, by_name);
    for (size_t k = 0; k < b->n; k++)
        /* After sorting by name, equal ones are neighbours, the first to appear in front. */
        first[b->set[k].place] = k > 0 && !strcmp (b->set[k].name, b->set[k - 1].name)
                                     ? first[b->set[k - 1].place]
                                     : b->set[k].place;
    if (b->n) pg_sort (b->set, b->n, sizeof *b->set, by_place);
    for (size_t k = 0; k < b->n; k++) {
        /* Numbers in the order of appearance. */
        b->final[k] = first[k] == k ? b->nfinal++ : b->final[first[k]];
        /* As final[k] <= k, no entry is overwritten before it has been used. */
        b->set[b->final[k]].sides |= b->set[k].sides;
        if (first[k] == k) b->set[b->final[k]] = b->set[k];
    }
done:
    pg_free (first);
    return status;
}

/* The number of side `side` after the element was mirrored: the face with the mirrored corners. */
static int mirrored_side (pg_element kind, int side)
{
    const signed char *mirror = element_mirror (kind);
    int was[4], now[4], n = element_face_corners (kind, side, was);
    for (int f = 0; f < pg_element_types[kind].faces; f++) {
        int found = 0, corners = element_face_corners (kind, f, now);
        for (int i = 0; i < n; i++) for (int j = 0; j < corners; j++) found += mirror[was[i]] == now[j];
        if (found == n && corners == n) return f;
    }
    return side;
}

static int by_int (const void *p, const void *q)
{
    int a = *(const int *) p, b = *(const int *) q;
    return (a > b) - (a < b);
}

/* Sorts n numbers, drops repetitions and -1; returns how many are left. */
static size_t sort_ints (int *list, size_t n)
{
    size_t left = 0;
    pg_sort (list, n, sizeof *list, by_int);
    for (size_t k = 0; k < n; k++)
        if (list[k] >= 0 && (left == 0 || list[k] != list[left - 1])) list[left++] = list[k];
    return left;
}

/* Do node set s and side set t of the file have the same nodes? */
static pg_status same_nodes (const builder *b, const pg_id_table *elements, size_t s, size_t t, int *same)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    const pg_mesh *out = m->made.out;
    const mesh_list *nodes = &m->sets[s], *sides = &m->side_sets[t];
    size_t n = 0, nside = 0;
    int *own = NULL, *other = NULL;
    PG_ALLOC (own, nodes->end - nodes->first);
    PG_ALLOC (other, 9 * (sides->end - sides->first));
    for (size_t k = nodes->first; k < nodes->end; k++) {
        long at = pg_id_table_find (&m->made.nodes, m->set_node[k]);
        own[n++] = at < 0 ? -1 : m->made.kept[at];
    }
    for (size_t k = sides->first; k < sides->end; k++) {
        long e = pg_id_table_find (elements, m->side_element[k]);
        int corner[9], side = m->side[k];
        if (e < 0 || side < 0 || side >= pg_element_types[out->kind[e]].faces) continue;
        if (m->made.turned[e]) side = mirrored_side (out->kind[e], side);
        int count = pg_element_types[pg_element_face (out->kind[e], side, corner)].nodes;
        for (int i = 0; i < count; i++) other[nside++] = out->node[out->start[e] + (size_t) corner[i]];
    }
    n = sort_ints (own, n), nside = sort_ints (other, nside);
    *same = n == nside && (n == 0 || memcmp (own, other, n * sizeof *own) == 0);
done:
    pg_free (own), pg_free (other);
    return status;
}

/* Renames a node set and a side set of one name whose nodes differ. */
static pg_status tell_apart (builder *b, const pg_id_table *elements)
{
    pg_status status = PG_OK;
    pg_mesh_builder *m = b->m;
    for (size_t s = 0; s < m->nset; s++)
        for (size_t t = 0; t < m->nside_set; t++) {
            int same = 1;
            named *nodes = &b->set[s], *sides = &b->set[m->nset + t];
            if (strcmp (m->sets[s].name, m->side_sets[t].name) != 0) continue;
            PG_TRY (same_nodes (b, elements, s, t, &same));
            if (same) continue;
            PG_TRY (pg_mesh_builder_pass (m, "node set and side set both '%.20s': called %.20s_nodes, "
                                             "%.20s_sides", m->sets[s].name, m->sets[s].name,
                                          m->sets[s].name));
            snprintf (nodes->name, sizeof nodes->name, "%.57s_nodes", m->sets[s].name);
            snprintf (sides->name, sizeof sides->name, "%.57s_sides", m->sets[s].name);
        }
done:
    return status;
}

/* Collects the names of node sets, side sets and groups, in this order. */
static pg_status collect_names (builder *b, const pg_id_table *elements)
{
    pg_status status = PG_OK;
    pg_mesh_builder *m = b->m;
    for (size_t k = 0; k < m->nset; k++) PG_TRY (add_name (b, m->sets[k].name, m->sets[k].id, 0));
    for (size_t k = 0; k < m->nside_set; k++)
        PG_TRY (add_name (b, m->side_sets[k].name, m->side_sets[k].id, 1));
    PG_TRY (tell_apart (b, elements));
    PG_TRY (add_sources (b));
    PG_TRY (unite (b));
done:
    return status;
}

/* ---- sets of the file ---------------------------------------------------------------------------------- */
/* Adds the members of the node sets of the file. A number that no node of the file has is an error. */
static pg_status add_node_sets (builder *b)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    for (size_t s = 0; s < m->nset; s++)
        for (size_t k = m->sets[s].first; k < m->sets[s].end; k++) {
            long at = pg_id_table_find (&m->made.nodes, m->set_node[k]);
            if (at < 0)
                PG_FAIL (PG_E_FILE, "%s: node set '%s': node %ld is not in the file", m->path,
                         m->sets[s].name, m->set_node[k]);
            PG_TRY (add_node (b, s, m->made.kept[at]));
        }
done:
    return status;
}

/* Adds the members of the side sets of the file. */
static pg_status add_side_sets (builder *b, const pg_id_table *elements)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    for (size_t s = 0; s < m->nside_set; s++)
        for (size_t k = m->side_sets[s].first; k < m->side_sets[s].end; k++) {
            const char *name = m->side_sets[s].name;
            long e = pg_id_table_find (elements, m->side_element[k]);
            if (e < 0)
                PG_FAIL (PG_E_FILE, "%s: side set '%s': element %ld is none of the solid elements", m->path,
                         name, m->side_element[k]);
            pg_element kind = m->made.out->kind[e];
            if (m->side[k] < 0 || m->side[k] >= pg_element_types[kind].faces)
                PG_FAIL (PG_E_FILE,
                         "%s: side set '%s': element %ld (%s) has no side %d; its sides are 1 to %d", m->path,
                         name, m->side_element[k], pg_element_types[kind].name, m->side[k] + 1,
                         pg_element_types[kind].faces);
            PG_TRY (add_side (b, m->nset + s, (size_t) e,
                              m->made.turned[e] ? mirrored_side (kind, m->side[k]) : m->side[k]));
        }
done:
    return status;
}

/* ---- sets by elements of lower dimension --------------------------------------------------------------- */
/* The set that element e of lower dimension names. */
static size_t set_of (const builder *b, size_t e)
{
    source key = { pg_element_types[b->m->kind[e]].dim, b->m->group[e], 0 };
    return ((source *) pg_search (&key, b->source, b->nsource, sizeof key, by_source))->set;
}

/* Adds the nodes of elements that only name a set to that set. */
static pg_status add_lower_nodes (builder *b)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    for (size_t e = 0; e < m->n; e++) {
        if (!names_a_set (m, e)) continue;
        size_t set = set_of (b, e);
        for (size_t k = m->start[e]; k < m->start[e + 1]; k++)
            PG_TRY (add_node (b, set, m->made.kept[m->made.index[k]]));
    }
done:
    return status;
}

/* An element of dimension dim - 1 by its corners (ascending, then -1), its set, and whether its face was
 * found. */
typedef struct { int key[4]; size_t set; int found; } lower;

/* Orders elements by their corners. */
static int by_corners (const void *p, const void *q)
{
    const lower *a = p, *b = q;
    for (int k = 0; k < 4; k++) if (a->key[k] != b->key[k]) return a->key[k] < b->key[k] ? -1 : 1;
    return 0;
}

/* Orders elements by their corners, those with the same corners by their sets. */
static int by_corners_and_set (const void *p, const void *q)
{
    const lower *a = p, *b = q;
    int c = by_corners (p, q);
    return c ? c : (a->set > b->set) - (a->set < b->set);
}

/* Lists the elements that may be faces of solid ones, sorted by corners; marks their corners. */
static pg_status list_lower (const builder *b, size_t *n, lower **list, unsigned char *mark)
{
    pg_status status = PG_OK;
    const pg_mesh_builder *m = b->m;
    size_t cap = 0;
    for (size_t e = 0; e < m->n; e++) {
        const pg_element_type *type = &pg_element_types[m->kind[e]];
        lower l = { { -1, -1, -1, -1 }, 0, 0 };
        int usable = 1;
        /* Only elements of one dimension less can be faces. */
        if (!names_a_set (m, e) || type->dim != m->made.dim - 1) continue;
        for (int k = 0; k < type->corners; k++) {
            /* Insertion sort of the corners; one that no solid element uses makes it no face. */
            int v = m->made.kept[m->made.index[m->start[e] + (size_t) k]], at = k;
            for (; at > 0 && l.key[at - 1] > v; at--) l.key[at] = l.key[at - 1];
            l.key[at] = v, usable &= v >= 0;
        }
        if (!usable) continue;
        l.set = set_of (b, e);
        PG_GROW (*list, cap, *n + 1);
        (*list)[(*n)++] = l;
        for (int k = 0; k < type->corners; k++) mark[l.key[k]] = 1;
    }
    if (*n) pg_sort (*list, *n, sizeof **list, by_corners_and_set);
done:
    return status;
}

/* Are all corners of this face marked? A quick test before the search in the list. */
static int all_marked (const unsigned char *mark, const int key[4])
{
    for (int k = 0; k < 4 && key[k] >= 0; k++) if (!mark[key[k]]) return 0;
    return 1;
}

/* Adds the elements that are faces of solid ones as sides; a face between two solid elements becomes a side
 * of the first. */
static pg_status add_lower_sides (builder *b)
{
    pg_status status = PG_OK;
    const pg_mesh *out = b->m->made.out;
    lower *list = NULL;
    unsigned char *mark = NULL;
    size_t n = 0;
    PG_ALLOC (mark, out->nnode);
    PG_TRY (list_lower (b, &n, &list, mark));
    for (size_t e = 0; n > 0 && e < out->n; e++)
        for (int f = 0; f < pg_element_types[out->kind[e]].faces; f++) {
            lower key = { { -1, -1, -1, -1 }, 0, 0 };
            mesh_face_key (out, e, f, key.key);
            if (!all_marked (mark, key.key)) continue;
            lower *l = pg_search (&key, list, n, sizeof key, by_corners);
            while (l && l > list && by_corners (l - 1, &key) == 0) l--;
            for (; l && l < list + n && by_corners (l, &key) == 0; l++) {
                if (!l->found) PG_TRY (add_side (b, l->set, e, f));
                l->found = 1;
            }
        }
done:
    pg_free (list), pg_free (mark);
    return status;
}

/* ---- writing sorted sets into the mesh ----------------------------------------------------------------- */
static int by_pair (const void *p, const void *q)
{
    uint64_t a = *(const uint64_t *) p, b = *(const uint64_t *) q;
    return (a > b) - (a < b);
}

/* Sorts the members and drops repetitions. */
static void sort_pairs (pairs *p)
{
    size_t n = 0;
    if (p->n) pg_sort (p->pair, p->n, sizeof *p->pair, by_pair);
    for (size_t k = 0; k < p->n; k++) if (n == 0 || p->pair[k] != p->pair[n - 1]) p->pair[n++] = p->pair[k];
    p->n = n;
}

/* End of the run of pairs that belong to `set`. */
static size_t run_end (const pairs *p, size_t first, size_t set, int shift)
{
    while (first < p->n && p->pair[first] >> shift == set) first++;
    return first;
}

/* Writes the node sets; every set has one, also one that is empty. */
static pg_status put_nodes (builder *b)
{
    pg_status status = PG_OK;
    pg_mesh *out = b->m->made.out;
    PG_ALLOC (out->nodes, b->nfinal);
    for (size_t s = 0, at = 0; s < b->nfinal; s++) {
        /* Sorted pairs: members of one set follow one another, ascending. */
        size_t end = run_end (&b->nodes, at, s, 32);
        pg_mesh_nodes *set = &out->nodes[out->nnodes++];
        snprintf (set->name, sizeof set->name, "%s", b->set[s].name);
        set->id = (int) b->set[s].id, set->n = end - at;
        PG_ALLOC (set->node, set->n);
        for (size_t k = 0; k < set->n; k++) set->node[k] = (int) (b->nodes.pair[at + k] & 0xFFFFFFFF);
        at = end;
    }
done:
    return status;
}

/* Writes the side sets. Sets without sides become no side set, unless the file gave them as one. */
static pg_status put_sides (builder *b)
{
    pg_status status = PG_OK;
    pg_mesh *out = b->m->made.out;
    PG_ALLOC (out->sides, b->nfinal);
    for (size_t s = 0, at = 0; s < b->nfinal; s++) {
        size_t end = run_end (&b->sides, at, s, 34);
        if (end == at && !b->set[s].sides) continue;
        pg_mesh_sides *set = &out->sides[out->nsides++];
        snprintf (set->name, sizeof set->name, "%s", b->set[s].name);
        set->id = (int) b->set[s].id, set->n = end - at;
        PG_ALLOC (set->element, set->n);
        PG_ALLOC (set->side, set->n);
        for (size_t k = 0; k < set->n; k++) {
            set->element[k] = (int) (b->sides.pair[at + k] >> 3 & 0x7FFFFFFF);
            set->side[k] = (int) (b->sides.pair[at + k] & 7);
        }
        at = end;
    }
done:
    return status;
}

/* Reports two elements with the same number. */
static pg_status check_ids (const pg_mesh_builder *m, pg_id_table *elements)
{
    pg_status status = PG_OK;
    size_t twice;
    PG_TRY (pg_id_table_build (elements, m->made.out->n, m->made.out->element_id, &twice));
    if (twice < m->made.out->n)
        PG_FAIL (PG_E_FILE, "%s: element %ld is there twice", m->path, m->made.out->element_id[twice]);
done:
    return status;
}

/* Members are collected from all sources before anything is written into the mesh. */
pg_status builder_sets (pg_mesh_builder *m)
{
    pg_status status = PG_OK;
    builder b = { .m = m };
    pg_id_table elements = { 0 };
    PG_TRY (check_ids (m, &elements));
    PG_TRY (collect_names (&b, &elements));
    PG_TRY (add_node_sets (&b));
    PG_TRY (add_side_sets (&b, &elements));
    PG_TRY (add_lower_nodes (&b));
    PG_TRY (add_lower_sides (&b));
    sort_pairs (&b.nodes), sort_pairs (&b.sides);
    PG_TRY (put_nodes (&b));
    PG_TRY (put_sides (&b));
done:
    pg_id_table_clear (&elements);
    pg_free (b.set), pg_free (b.final), pg_free (b.source), pg_free (b.nodes.pair), pg_free (b.sides.pair);
    return status;
}
