/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: a mesh under construction. Until pg_mesh_builder_finish nodes and elements are known by the
 * numbers that the file gives them. */
#ifndef MESH_BUILDER_H
#define MESH_BUILDER_H
#include "perigal/mesh.h"

/* Name of a group of elements of one dimension. */
typedef struct { int dim; long group; char name[64]; } mesh_group;
/* A set of the file: its entries first .. end - 1 in the list of all entries. */
typedef struct { char name[64]; long id; size_t first, end; } mesh_list;

/* Capacities of the arrays that grow (PG_GROW), by their names. */
typedef struct {
    size_t node, x, element, start, group, line, kind, list, groups, set, side_set, set_node, side,
        side_element, passed, foreign;
} mesh_capacities;
/* Intermediate results of pg_mesh_builder_finish. */
typedef struct {
    /* Largest dimension of all elements. */
    int        dim;
    /* Finds nodes by number. */
    pg_id_table   nodes;
    /* The node of each entry of `list`, as an index into node_id (nlist). */
    int       *index;
    /* Number of each element among the solid ones; -1: it is of lower dimension; -2: it repeats another one
     * (n). */
    int       *solid;
    /* 1: this solid element was given inside out and has been mirrored (out->n). */
    unsigned char *turned;
    /* Number of each node in the mesh; -1: no solid element uses it (nnode). */
    int       *kept;
    /* The mesh that is being filled. */
    pg_mesh   *out;
} mesh_finish;
struct pg_mesh_builder {
    /* File, for messages. */
    char      *path;
    mesh_capacities cap;
    size_t     nnode;
    /* Numbers of the nodes (nnode). */
    long      *node_id;
    /* Positions of the nodes, in the unit of the file (nnode x 3). */
    double    *x;
    /* Number of elements of all dimensions. */
    size_t     n;
    /* Number, group and line of the file of each element (n). */
    long      *element_id, *group, *line;
    unsigned char *kind;
    /* First entry of each element in `list` (n + 1). */
    size_t    *start;
    size_t     nlist;
    /* Numbers of the nodes of all elements (nlist). */
    long      *list;
    size_t     ngroup;
    /* Names of groups (ngroup). */
    mesh_group *groups;
    size_t     nset, nside_set;
    /* Node sets (nset) and side sets (nside_set) of the file. */
    mesh_list *sets, *side_sets;
    size_t     nset_node, nside;
    /* Entries of all node sets (nset_node); elements and sides of all side sets (nside). */
    long      *set_node, *side_element;
    int       *side;
    size_t     npassed, nforeign;
    /* First element type that is meant for plane strain, "": none; parts of the file that are ignored;
     * elements of unknown types. */
    char       plane_strain[32];
    pg_mesh_passed  *passed;
    pg_mesh_foreign *foreign;
    mesh_finish made;
};

/* Steps of pg_mesh_builder_finish, in this order: numbers become indices, the dimension and repeated elements
 * are found; solid elements, nodes in use, orientation and blocks; node sets and side sets. */
pg_status builder_resolve (pg_mesh_builder *m);
pg_status builder_solids  (pg_mesh_builder *m);
pg_status builder_sets    (pg_mesh_builder *m);
/* "path, line 7: element 12" for element e, or without the line where it is unknown. */
void      builder_where   (const pg_mesh_builder *m, size_t e, char *text, size_t size);
/* Name of a group: the one given, else its number. */
void      builder_name    (const pg_mesh_builder *m, int dim, long group, char name[64]);
#endif
