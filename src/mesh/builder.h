/* SPDX-License-Identifier: GPL-3.0-or-later
 * builder.h: a mesh under construction: what the readers gave, in the numbers of the file. */
#ifndef MESH_BUILDER_H
#define MESH_BUILDER_H
#include "perigal/mesh.h"

typedef struct { int dim; long group; char name[64]; } mesh_group;
/* a set of the file: entries [first, end) */
typedef struct { char name[64]; long id; size_t first, end; } mesh_list;

struct pg_mesh_builder {
    char      *path;
    size_t     nnode, node_cap;
    long      *node_id;
    double    *x;                                      /* nnode x 3 */
    size_t     x_cap;
    size_t     n, element_cap, start_cap;              /* elements of all dimensions */
    long      *element_id, *group, *line;
    size_t     group_cap, line_cap, kind_cap;
    unsigned char *kind;
    size_t    *start;                                  /* into `node` (n + 1) */
    size_t     nlist, list_cap;
    long      *list;                                   /* ids of nodes */
    size_t     ngroup, groups_cap;
    mesh_group *groups;
    size_t     nset, set_cap, nside_set, side_set_cap;
    mesh_list *sets, *side_sets;
    size_t     nset_node, set_node_cap, nside, side_cap, side_element_cap;
    long      *set_node, *side_element;
    int       *side;
    /* while finishing */
    int        dim;                                    /* largest of all elements */
    pg_id_table   nodes;
    int       *index;  /* node of each entry of list, by its place in node_id */
    int       *solid;  /* number of element e among the solid ones; -1: it is none; -2: a twin */
    unsigned char *turned;  /* 1: nodes of this solid element were mirrored (out->n) */
    int       *kept;  /* number of node k in the mesh; -1: no solid element uses it */
    pg_mesh   *out;
};

/* Steps of pg_mesh_builder_finish, in this order. */
pg_status builder_resolve (pg_mesh_builder *m);            /* ids to places; dimension; twins */
pg_status builder_solids  (pg_mesh_builder *m);  /* solid elements, nodes in use, blocks, orientation */
pg_status builder_sets    (pg_mesh_builder *m);            /* node sets, side sets */
/* "path, line 7: element 12" of element e. */
void      builder_where   (const pg_mesh_builder *m, size_t e, char *text, size_t size);
/* Name of group (dim, group): the one given, else its number. */
void      builder_name    (const pg_mesh_builder *m, int dim, long group, char name[64]);
#endif
