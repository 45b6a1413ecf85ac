/* SPDX-License-Identifier: GPL-3.0-or-later
 * Converts a mesh one element thick between two planes of constant z, as CalculiX makes of plane elements,
 * back to the plane mesh. Each element must have a face on either plane, and the nodes of the upper face must
 * lie above those of the lower one. */
#include "builder.h"
#include "element.h"
#include <math.h>
#include <string.h>

/* The mesh, and what is known of its nodes. */
typedef struct {
    const pg_mesh *mesh;
    /* The z coordinates of the two planes. */
    double  low, high;
    /* Level of each node: 0 on the lower plane, 1 half-way, 2 on the upper plane (nnode). */
    signed char *level;
    /* For each node on a plane the node opposite to it, its twin, -1: none (nnode). */
    int    *twin;
    pg_mesh_builder *builder;
} plate;

/* Finds the levels of all nodes, to 1e-3 of the thickness. */
static pg_status find_levels (plate *p)
{
    pg_status status = PG_OK;
    const pg_mesh *m = p->mesh;
    p->low = HUGE_VAL, p->high = -HUGE_VAL;
    for (size_t i = 0; i < m->nnode; i++)
        p->low = fmin (p->low, m->x[3 * i + 2]), p->high = fmax (p->high, m->x[3 * i + 2]);
    double near = 1e-3 * (p->high - p->low);
    for (size_t i = 0; i < m->nnode; i++) {
        double z = m->x[3 * i + 2];
        p->level[i] = z <= p->low + near ? 0 : z >= p->high - near ? 2 : 1;
        p->twin[i] = -1;
        /* Nodes of second order lie half-way; any other height means several layers of elements. */
        if (p->level[i] == 1 && fabs (z - (p->low + p->high) / 2) > near)
            PG_FAIL (PG_E_USAGE,
                     "node %ld lies at z = %g between %g and %g: the mesh is not one element thick",
                     m->node_id[i], z, p->low, p->high);
    }
done:
    return status;
}

/* Returns the face of element e all of whose corners are on a level, -1: none. */
static int face_on (const plate *p, size_t e, int level)
{
    const pg_mesh *m = p->mesh;
    pg_element kind = (pg_element) m->kind[e];
    for (int f = 0; f < pg_element_types[kind].faces; f++) {
        int corner[4], n = element_face_corners (kind, f, corner), on = 0;
        for (int k = 0; k < n; k++) on += p->level[m->node[m->start[e] + (size_t) corner[k]]] == level;
        if (on == n) return f;
    }
    return -1;
}

/* Finds the lower twin of each node of the upper face of element e, and writes their numbers in the order
 * of the upper face, which is counter-clockwise seen from above. Twins must agree between elements. */
static pg_status pair_nodes (plate *p, size_t e, long node[9], pg_element *kind)
{
    pg_status status = PG_OK;
    const pg_mesh *m = p->mesh;
    int upper[9], lower[9], above = face_on (p, e, 2), below = face_on (p, e, 0);
    if (above < 0 || below < 0)
        PG_FAIL (PG_E_USAGE,
                 "element %ld does not reach from z = %g to z = %g: the mesh is not one element thick",
                 m->element_id[e], p->low, p->high);
    *kind = pg_element_face ((pg_element) m->kind[e], above, upper);
    pg_element_face ((pg_element) m->kind[e], below, lower);
    int n = pg_element_types[*kind].nodes;
    /* The twin is the lower node nearest in x and y; least: its distance; size: that of the farthest one, a
     * length for the tolerance. */
    for (int k = 0; k < n; k++) {
        int top = m->node[m->start[e] + (size_t) upper[k]], best = -1;
        double least = HUGE_VAL, size = 0;
        for (int j = 0; j < n; j++) {
            int low = m->node[m->start[e] + (size_t) lower[j]];
            double d = hypot (m->x[3 * low] - m->x[3 * top], m->x[3 * low + 1] - m->x[3 * top + 1]);
            size = fmax (size, d);
            if (d < least) least = d, best = low;
        }
        /* The twin must lie right below, and neighbouring elements must agree about it. */
        if (least > 1e-3 * size || (p->twin[top] >= 0 && p->twin[top] != best)
            || (p->twin[best] >= 0 && p->twin[best] != top))
            PG_FAIL (PG_E_USAGE,
                     "element %ld: no node right below node %ld: the mesh is not a plane one made thick",
                     m->element_id[e], m->node_id[top]);
        p->twin[top] = best, p->twin[best] = top;
        node[k] = m->node_id[best];
    }
done:
    return status;
}

/* Number of block b, or b + 1 where the file gave none. */
static long group_of (const pg_mesh *m, size_t b)
{
    return m->blocks[b].id > 0 ? m->blocks[b].id : (long) b + 1;
}

/* Adds the plane elements, the blocks, and nodes half-way between twins. */
static pg_status add_elements (plate *p)
{
    pg_status status = PG_OK;
    const pg_mesh *m = p->mesh;
    for (size_t e = 0; e < m->n; e++) {
        long node[9];
        pg_element kind = PG_QUAD4;
        PG_TRY (pair_nodes (p, e, node, &kind));
        PG_TRY (pg_mesh_builder_element (p->builder, m->element_id[e], kind, node,
                                         group_of (m, (size_t) m->block[e]), 0));
    }
    for (size_t b = 0; b < m->nblock; b++)
        PG_TRY (pg_mesh_builder_group (p->builder, 2, group_of (m, b), m->blocks[b].name));
    for (size_t i = 0; i < m->nnode; i++) {
        if (p->level[i] != 0 || p->twin[i] < 0) continue;
        const double *a = m->x + 3 * i, *b = m->x + 3 * (size_t) p->twin[i];
        PG_TRY (pg_mesh_builder_node (p->builder, m->node_id[i],
                                      (double[3]){ (a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 0 }));
    }
done:
    return status;
}

/* Returns the side of the plane element to which the upright side `side` of solid element e belongs; -1:
 * `side` is one of the faces on the planes. */
static int standing (const plate *p, size_t e, int side)
{
    const pg_mesh *m = p->mesh;
    pg_element kind = (pg_element) m->kind[e];
    int corner[4], n = element_face_corners (kind, side, corner), upper[9], above = face_on (p, e, 2);
    pg_element face = pg_element_face (kind, above, upper);
    int corners = pg_element_types[face].corners;
    /* Side k of the plane element lies between corners k and k + 1 of the upper face. */
    for (int k = 0; k < corners; k++) {
        int found = 0;
        for (int j = 0; j < n; j++) found += corner[j] == upper[k] || corner[j] == upper[(k + 1) % corners];
        if (found == 2 && side != above) return k;
    }
    return -1;
}

/* Adds node sets by their lower twins, side sets by their upright sides. */
static pg_status add_sets (plate *p)
{
    pg_status status = PG_OK;
    const pg_mesh *m = p->mesh;
    for (size_t s = 0; s < m->nnodes; s++) {
        const pg_mesh_nodes *set = &m->nodes[s];
        PG_TRY (pg_mesh_builder_nodeset (p->builder, set->name, set->id));
        for (size_t k = 0; k < set->n; k++) {
            /* Nodes half-way between the planes do not occur in the plane mesh. */
            int i = set->node[k];
            if (p->level[i] == 2) i = p->twin[i];
            if (i >= 0 && p->level[i] == 0) PG_TRY (pg_mesh_builder_nodeset_add (p->builder, m->node_id[i]));
        }
    }
    for (size_t s = 0; s < m->nsides; s++) {
        const pg_mesh_sides *set = &m->sides[s];
        int begun = 0, side;
        for (size_t k = 0; k < set->n; k++) {
            if ((side = standing (p, (size_t) set->element[k], set->side[k])) < 0) continue;
            if (!begun) PG_TRY (pg_mesh_builder_sideset (p->builder, set->name, set->id));
            PG_TRY (pg_mesh_builder_sideset_add (p->builder, m->element_id[set->element[k]], side));
            begun = 1;
        }
    }
done:
    return status;
}

/* Replaces a field by the means of twins at the nodes of the plane mesh; at: the lower twin of each. work:
 * room for nodes x components. */
static void take_means (const plate *p, const pg_mesh *flat, const int *at, pg_mesh_field *f, double *work)
{
    size_t n = (size_t) f->components, keep = n == 3 ? 2 : n;
    for (size_t i = 0; i < flat->nnode; i++)
        for (size_t c = 0; c < keep; c++)
            work[i * keep + c] = (f->value[(size_t) at[i] * n + c]
                                  + f->value[(size_t) p->twin[at[i]] * n + c])
                                 / 2;
    memcpy (f->value, work, flat->nnode * keep * sizeof *work);
    f->components = (int) keep;
}

/* Converts all fields; nodes of the plane mesh are found in the solid mesh by their numbers. */
static pg_status flatten_fields (const plate *p, const pg_mesh *flat, size_t nfield, pg_mesh_field *fields)
{
    pg_status status = PG_OK;
    pg_id_table t = { 0 };
    int *at = NULL;
    double *work = NULL;
    size_t twice, most = 1;
    for (size_t k = 0; k < nfield; k++)
        if ((size_t) fields[k].components > most) most = (size_t) fields[k].components;
    PG_ALLOC (at, flat->nnode);
    PG_ALLOC (work, flat->nnode * most);
    PG_TRY (pg_id_table_build (&t, p->mesh->nnode, p->mesh->node_id, &twice));
    for (size_t i = 0; i < flat->nnode; i++) at[i] = (int) pg_id_table_find (&t, flat->node_id[i]);
    for (size_t k = 0; k < nfield; k++) take_means (p, flat, at, &fields[k], work);
done:
    pg_id_table_clear (&t);
    pg_free (at), pg_free (work);
    return status;
}

/* The plane mesh is built like one from a file, which also orients its elements. Only after everything has
 * succeeded does it replace the given one. */
pg_status pg_mesh_flatten (pg_mesh *mesh, size_t nfield, pg_mesh_field *fields)
{
    pg_status status = PG_OK;
    plate p = { .mesh = mesh };
    pg_mesh flat = { 0 };
    if (mesh->dim != 3) PG_FAIL (PG_E_USAGE, "a mesh of dimension %d cannot be made flat", mesh->dim);
    PG_ALLOC (p.level, mesh->nnode);
    PG_ALLOC (p.twin, mesh->nnode);
    PG_TRY (find_levels (&p));
    PG_TRY (pg_mesh_builder_create (&p.builder, "the plane mesh"));
    PG_TRY (add_elements (&p));
    PG_TRY (add_sets (&p));
    PG_TRY (pg_mesh_builder_finish (p.builder, &flat));
    PG_TRY (flatten_fields (&p, &flat, nfield, fields));
    pg_mesh_clear (mesh);
    *mesh = flat;
    memset (&flat, 0, sizeof flat);
done:
    pg_mesh_clear (&flat);
    pg_mesh_builder_free (&p.builder);
    pg_free (p.level), pg_free (p.twin);
    return status;
}
