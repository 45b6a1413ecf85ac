/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gmsh .msh 4.1, text and binary: elements belong to entities (points, curves, surfaces, volumes of the
 * geometry), and entities belong to physical groups.
 *
 * Sections: $MeshFormat, $PhysicalNames, $Entities, in partitioned files also $PartitionedEntities, to whose
 * parts the elements then belong, $Nodes and $Elements in blocks, one for each entity;
 * all others are skipped. In binary files counts and numbers of nodes have 8 bytes, tags of entities 4. */
#include "gmsh.h"
#include <stdlib.h>
#include <string.h>

/* An entity; its groups are group[first] .. group[first + n - 1]. */
typedef struct { long dim, tag; size_t first, n; } entity;

/* State of the reader: entities (nentity), and the groups of all entities (ngroup). */
typedef struct {
    gmsh_reader g;
    /* 1 while the section $PartitionedEntities is read */
    int     parted;
    size_t  nentity, entity_cap, ngroup, group_cap;
    entity *entities;
    long   *group;
} reader;

/* Appends an entity without groups. */
static pg_status add_entity (reader *r, long dim, long tag)
{
    pg_status status = PG_OK;
    PG_GROW (r->entities, r->entity_cap, r->nentity + 1);
    r->entities[r->nentity++] = (entity) { dim, tag, r->ngroup, 0 };
done:
    return status;
}

/* Largest number of groups of one entity, since the builder gets each element once for each group. */
enum { MOST_GROUPS = 100 };
/* Adds a group to the last entity. A negative number says that the orientation is reversed: the group is its
 * absolute value. */
static pg_status add_group (reader *r, long group)
{
    pg_status status = PG_OK;
    entity *e = &r->entities[r->nentity - 1];
    if (e->n == MOST_GROUPS)
        GMSH_FAIL (&r->g, "entity %ld belongs to more than %d groups", e->tag, MOST_GROUPS);
    PG_GROW (r->group, r->group_cap, r->ngroup + 1);
    r->group[r->ngroup++] = labs (group);                  /* negative: reversed orientation */
    e->n++;
done:
    return status;
}

/* ---- entities ------------------------------------------------------------------------------------------ */
/* Reads, behind the tag of a part of an entity, its parent entity (dimension, tag) and the partitions that it
 * belongs to. *between 1: it is an interface between partitions, of lower dimension than its parent, and the
 * groups listed for it do not apply to it. */
static pg_status parts_of_text (gmsh_reader *g, const char **at, const char *last, long tag, int dim,
                                int *between)
{
    pg_status status = PG_OK;
    long parent = dim, unused, n;
    if (!mesh_whole (at, last, &parent) || !mesh_whole (at, last, &unused) || !mesh_whole (at, last, &n)
        || n < 0)
        GMSH_FAIL (g, "part %ld: the entity it belongs to, or the number of its partitions, is missing", tag);
    *between = parent != dim;
    for (long k = 0; k < n; k++)
        if (!mesh_whole (at, last, &unused)) GMSH_FAIL (g, "part %ld: partition %ld of %ld is missing", tag,
                                                        k + 1, n);
done:
    return status;
}

/* Reads parent and partitions of a part of an entity in a binary file; *between 1: it is an interface between
 * partitions. */
static pg_status parts_of_bytes (gmsh_reader *g, int dim, int *between)
{
    pg_status status = PG_OK;
    PG_TRY (gmsh_has_left (g, "a part of an entity", 1, 16));
    *between = gmsh_int (g) != dim;
    g->c.at += 4;
    long n = gmsh_long (g);
    PG_TRY (gmsh_has_left (g, "partitions of an entity", (size_t) n, 4));
    g->c.at += 4 * (size_t) n;
done:
    return status;
}

/* Reads an entity from a line: tag, bounding box (of points: position), groups; the entities that bound it,
 * which follow, are not read. */
static pg_status entity_of_text (reader *r, int dim)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    const char *at, *last;
    long tag, n, group;
    int between = 0;
    double unused;
    PG_TRY (gmsh_line (g, "the last entity", &at, &last));
    if (!mesh_whole (&at, last, &tag)) GMSH_FAIL (g, "an entity has no number");
    if (r->parted) PG_TRY (parts_of_text (g, &at, last, tag, dim, &between));
    /* Box of the entity, or position of a point: not needed. */
    for (int k = 0; k < (dim ? 6 : 3); k++)
        if (!mesh_real (&at, last, &unused))
            GMSH_FAIL (g, "entity %ld: number %d of its box is missing", tag, k + 1);
    if (!mesh_whole (&at, last, &n) || n < 0)
        GMSH_FAIL (g, "entity %ld: the number of its groups is missing or negative", tag);
    PG_TRY (add_entity (r, dim, tag));
    for (long k = 0; k < n; k++) {
        if (!mesh_whole (&at, last, &group))
            GMSH_FAIL (g, "entity %ld: group %ld of %ld is missing", tag, k + 1, n);
        if (!between) PG_TRY (add_group (r, group));
    }
done:
    return status;
}

/* Reads an entity from a binary file: tag, bounding box, groups; entities that bound it are skipped. */
static pg_status entity_of_bytes (reader *r, int dim)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    size_t box = dim ? 48 : 24;
    int between = 0;
    PG_TRY (gmsh_has_left (g, "an entity", 1, 4 + box + 8));
    long tag = gmsh_int (g);
    if (r->parted) PG_TRY (parts_of_bytes (g, dim, &between));
    PG_TRY (gmsh_has_left (g, "an entity", 1, box + 8));
    g->c.at += box;
    long n = gmsh_long (g);
    PG_TRY (gmsh_has_left (g, "groups of an entity", (size_t) n, 4));
    PG_TRY (add_entity (r, dim, tag));
    for (long k = 0; k < n; k++) {
        long group = gmsh_int (g);
        if (!between) PG_TRY (add_group (r, group));
    }
    if (dim == 0) goto done;
    PG_TRY (gmsh_has_left (g, "the bounds of an entity", 1, 8));
    /* Entities that bound this one: not needed. */
    n = gmsh_long (g);
    PG_TRY (gmsh_has_left (g, "the bounds of an entity", (size_t) n, 4));
    g->c.at += 4 * (size_t) n;
done:
    return status;
}

/* Orders entities by dimension, then by tag. */
static int by_entity (const void *p, const void *q)
{
    const entity *a = p, *b = q;
    if (a->dim != b->dim) return a->dim < b->dim ? -1 : 1;
    return (a->tag > b->tag) - (a->tag < b->tag);
}

/* Skips the number of partitions and the ghost entities (tag, partition), which are not needed. */
static pg_status skip_ghosts (gmsh_reader *g)
{
    pg_status status = PG_OK;
    long parts, ghosts;
    if (g->binary) {
        PG_TRY (gmsh_has_left (g, "the number of partitions", 2, 8));
        (void) gmsh_long (g);
        ghosts = gmsh_long (g);
        PG_TRY (gmsh_has_left (g, "ghost entities", (size_t) ghosts, 8));
        g->c.at += 8 * (size_t) ghosts;
        goto done;
    }
    PG_TRY (gmsh_wholes (g, "the number of partitions", 1, &parts));
    PG_TRY (gmsh_wholes (g, "the number of ghost entities", 1, &ghosts));
    for (long k = 0; k < ghosts; k++)
        PG_TRY (gmsh_wholes (g, "a ghost entity", 2, (long[2]) { 0 }));
done:
    return status;
}

/* Reads section $Entities or, if parted, $PartitionedEntities, and sorts the entities for the search. */
static pg_status read_entities (reader *r, int parted)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    long count[4];
    r->parted = parted;
    if (parted) PG_TRY (skip_ghosts (g));
    if (g->binary) {
        PG_TRY (gmsh_has_left (g, "the numbers of entities", 4, 8));
        for (int k = 0; k < 4; k++) count[k] = gmsh_long (g);
    } else PG_TRY (gmsh_wholes (g, "the numbers of entities", 4, count));
    /* dim: 0 points, 1 curves, 2 surfaces, 3 volumes. */
    for (int dim = 0; dim < 4; dim++)
        for (long k = 0; k < count[dim]; k++)
            PG_TRY (g->binary ? entity_of_bytes (r, dim) : entity_of_text (r, dim));
    if (r->nentity) pg_sort (r->entities, r->nentity, sizeof *r->entities, by_entity);
    PG_TRY (gmsh_end (g, parted ? "PartitionedEntities" : "Entities"));
done:
    return status;
}

/* ---- blocks -------------------------------------------------------------------------------------------- */
/* Reads the four numbers before the blocks of a section: number of blocks, number of nodes or elements
 * (members), their lowest and highest number. */
static pg_status section_head (gmsh_reader *g, const char *what, long *blocks, long *members)
{
    pg_status status = PG_OK;
    long head[4];
    if (g->binary) {
        PG_TRY (gmsh_has_left (g, what, 4, 8));
        for (int k = 0; k < 4; k++) head[k] = gmsh_long (g);
    } else PG_TRY (gmsh_wholes (g, what, 4, head));
    /* Each block subtracts its members from *members; lowest and highest number are not needed. */
    if (head[0] < 0 || head[1] < 0) GMSH_FAIL (g, "%s: %ld blocks with %ld members", what, head[0], head[1]);
    *blocks = head[0], *members = head[1];
done:
    return status;
}

/* Reads the head of a block: dimension and tag of the entity, a third number (nodes: 1 if parametric;
 * elements: type), number of members, which is subtracted from *left. */
static pg_status block_head (gmsh_reader *g, const char *what, long head[4], long *left)
{
    pg_status status = PG_OK;
    if (g->binary) {
        PG_TRY (gmsh_has_left (g, what, 1, 20));
        for (int k = 0; k < 3; k++) head[k] = gmsh_int (g);
        head[3] = gmsh_long (g);
    } else PG_TRY (gmsh_wholes (g, what, 4, head));
    if (head[3] < 0 || head[3] > *left)
        GMSH_FAIL (g, "%s: %ld members where %ld are left", what, head[3], *left);
    if (head[0] < 0 || head[0] > 3) GMSH_FAIL (g, "%s: an entity of dimension %ld", what, head[0]);
    *left -= head[3];
done:
    return status;
}

/* ---- nodes --------------------------------------------------------------------------------------------- */
/* Reads n nodes: the file lists all numbers (read by a second reader, `number`), then all positions. */
static pg_status nodes_of_text (gmsh_reader *g, long n)
{
    pg_status status = PG_OK;
    gmsh_reader number = *g;
    const char *at, *last;
    /* Go past the numbers of all nodes, one a line. */
    for (long k = 0; k < n; k++) PG_TRY (gmsh_line (g, "the last number of a node", &at, &last));
    for (long k = 0; k < n; k++) {
        long id;
        double x[3];
        PG_TRY (gmsh_wholes (&number, "the number of a node", 1, &id));
        PG_TRY (gmsh_line (g, "the last node", &at, &last));
        PG_TRY (gmsh_place (g, &at, last, x));
        PG_TRY (pg_mesh_builder_node (g->m, id, x));
    }
done:
    return status;
}

/* Reads n nodes from a binary file: all numbers, then all positions; the `parameters` numbers behind each
 * position are skipped. */
static pg_status nodes_of_bytes (gmsh_reader *g, long n, size_t parameters)
{
    pg_status status = PG_OK;
    gmsh_reader number = *g;
    /* All numbers and positions must fit, before any is read. */
    PG_TRY (gmsh_has_left (g, "nodes", (size_t) n, 8 + 8 * (3 + parameters)));
    g->c.at += 8 * (size_t) n;
    for (long k = 0; k < n; k++) {
        double x[3];
        long id = gmsh_long (&number);
        for (int a = 0; a < 3; a++) x[a] = gmsh_double (g);
        g->c.at += 8 * parameters;
        PG_TRY (pg_mesh_builder_node (g->m, id, x));
    }
done:
    return status;
}

/* Section $Nodes. */
static pg_status read_nodes (gmsh_reader *g)
{
    pg_status status = PG_OK;
    long blocks, left, head[4];
    PG_TRY (section_head (g, "the number of nodes", &blocks, &left));
    for (long k = 0; k < blocks; k++) {
        PG_TRY (block_head (g, "a block of nodes", head, &left));
        /* Parametric nodes have as many parameters as their entity has dimensions. */
        PG_TRY (g->binary ? nodes_of_bytes (g, head[3], head[2] ? (size_t) head[0] : 0)
                          : nodes_of_text (g, head[3]));
    }
    if (left > 0) GMSH_FAIL (g, "%ld nodes are missing", left);
    PG_TRY (gmsh_end (g, "Nodes"));
done:
    return status;
}

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Gives the builder an element once for each group of its entity; repeated elements are recognised. */
static pg_status add_element (reader *r, const entity *e, const gmsh_type *t, long id, const long *node,
                              long line)
{
    pg_status status = PG_OK;
    if (!e || e->n == 0) PG_TRY (gmsh_element (&r->g, t, id, node, 0, line));
    for (size_t k = 0; e && k < e->n; k++)
        PG_TRY (gmsh_element (&r->g, t, id, node, r->group[e->first + k], line));
done:
    return status;
}

/* Reads an element from a line: number, nodes. */
static pg_status element_of_text (reader *r, const entity *e, const gmsh_type *t)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    const char *at, *last;
    long id, node[PG_ELEMENT_NODES];
    int nodes = pg_element_types[t->kind].nodes;
    PG_TRY (gmsh_line (g, "the last element", &at, &last));
    if (!mesh_whole (&at, last, &id)) GMSH_FAIL (g, "an element has no number");
    for (int k = 0; k < nodes; k++)
        if (!mesh_whole (&at, last, &node[k]))
            GMSH_FAIL (g, "element %ld (%s): node %d of %d is missing", id, pg_element_types[t->kind].name,
                       k + 1, nodes);
    PG_TRY (add_element (r, e, t, id, node, g->c.line));
done:
    return status;
}

/* Reads n elements of one type from a binary file: number and nodes of 8 bytes each. */
static pg_status elements_of_bytes (reader *r, const entity *e, const gmsh_type *t, long n)
{
    pg_status status = PG_OK;
    int nodes = pg_element_types[t->kind].nodes;
    PG_TRY (gmsh_has_left (&r->g, "elements", (size_t) n, 8 * (1 + (size_t) nodes)));
    for (long k = 0; k < n; k++) {
        long id = gmsh_long (&r->g), node[PG_ELEMENT_NODES];
        for (int i = 0; i < nodes; i++) node[i] = gmsh_long (&r->g);
        PG_TRY (add_element (r, e, t, id, node, 0));
    }
done:
    return status;
}

/* Number of the first element of a block, for messages. */
static long first_number (const gmsh_reader *g)
{
    gmsh_reader ahead = *g;
    long id = 0;
    if (!g->binary) return gmsh_wholes (&ahead, "an element", 1, &id) == PG_OK ? id : 0;
    return g->c.end - g->c.at >= 8 ? gmsh_long (&ahead) : 0;
}

/* Reads a block of elements of one entity and one type. */
static pg_status read_block (reader *r, long *left)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    gmsh_type t;
    long head[4];
    PG_TRY (block_head (g, "a block of elements", head, left));
    /* An entity that is not listed belongs to no group. */
    entity key = { .dim = head[0], .tag = head[1] };
    const entity *e = r->nentity ? pg_search (&key, r->entities, r->nentity, sizeof key, by_entity) : NULL;
    if (head[3] == 0) return PG_OK;
    PG_TRY (gmsh_kind (g, head[2], first_number (g), (int) head[0], e && e->n ? r->group[e->first] : 0, &t));
    if (!t.known) {
        const char *at, *last;
        if (g->binary) PG_TRY (gmsh_has_left (g, "elements", (size_t) head[3], 8 * (1 + (size_t) t.nodes)));
        if (g->binary) g->c.at += (size_t) head[3] * 8 * (1 + (size_t) t.nodes);
        else for (long k = 0; k < head[3]; k++) PG_TRY (gmsh_line (g, "the last element", &at, &last));
        goto done;
    }
    if (g->binary) PG_TRY (elements_of_bytes (r, e, &t, head[3]));
    else for (long k = 0; k < head[3]; k++) PG_TRY (element_of_text (r, e, &t));
done:
    return status;
}

/* Section $Elements. */
static pg_status read_elements (reader *r)
{
    pg_status status = PG_OK;
    gmsh_reader *g = &r->g;
    long blocks, left;
    PG_TRY (section_head (g, "the number of elements", &blocks, &left));
    for (long k = 0; k < blocks; k++) PG_TRY (read_block (r, &left));
    if (left > 0) GMSH_FAIL (g, "%ld elements are missing", left);
    PG_TRY (gmsh_end (g, "Elements"));
done:
    return status;
}

/* ---- file ---------------------------------------------------------------------------------------------- */
/* Versions 4.0 and 5 have other layouts. */
static pg_status read (pg_mesh_builder *m, const mesh_file *file)
{
    pg_status status = PG_OK;
    reader r = { .nentity = 0 };
    char name[64];
    PG_TRY (gmsh_open (&r.g, m, file));
    if (!(r.g.version >= 4.1 && r.g.version < 5))
        GMSH_FAIL (&r.g,
                   "version %g of Gmsh's format is not known; save as 4.1 or 2.2 (gmsh FILE -save -format "
                   "msh4 -o NEW.msh)",
                   r.g.version);
    while (gmsh_section (&r.g, name))
        if (!strcmp (name, "Entities")) PG_TRY (read_entities (&r, 0));
        else if (!strcmp (name, "PartitionedEntities")) PG_TRY (read_entities (&r, 1));
        else if (!strcmp (name, "Nodes")) PG_TRY (read_nodes (&r.g));
        else if (!strcmp (name, "Elements")) PG_TRY (read_elements (&r));
        else if (!strcmp (name, "PhysicalNames")) PG_TRY (gmsh_names (&r.g));
        else {
            PG_TRY (pg_mesh_builder_pass (m, "section $%.40s", name));
            PG_TRY (gmsh_skip (&r.g, name));
        }
done:
    pg_free (r.entities), pg_free (r.group);
    return status;
}

/* Any version of Gmsh's format other than 2: `read` refuses the unknown ones by a message that helps. */
static int knows (const mesh_file *file)
{
    double version;
    return gmsh_knows (file, &version) && !(version >= 2 && version < 3);
}

const mesh_format mesh_format_gmsh4 = { "Gmsh .msh 4.1", knows, read, NULL };
