/* SPDX-License-Identifier: GPL-3.0-or-later
 * Gmsh .msh 2.0 to 2.2, text and binary: every element names its physical group.
 *
 * Sections: $MeshFormat, $PhysicalNames, $Nodes (number x y z), $Elements (number type tags nodes); all
 * others are skipped. In binary files numbers of nodes and elements have 4 bytes, coordinates 8. */
#include "gmsh.h"
#include <string.h>

/* ---- text ---------------------------------------------------------------------------------------------- */
/* Reads n nodes, one per line: number x y z. */
static pg_status nodes_of_text (gmsh_reader *g, long n)
{
    pg_status status = PG_OK;
    for (long k = 0; k < n; k++) {
        const char *at, *last;
        long id;
        double x[3];
        PG_TRY (gmsh_line (g, "the last node", &at, &last));
        if (!mesh_whole (&at, last, &id)) GMSH_FAIL (g, "node %ld of %ld has no number", k + 1, n);
        PG_TRY (gmsh_place (g, &at, last, x));
        PG_TRY (pg_mesh_builder_node (g->m, id, x));
    }
done:
    return status;
}

/* Reads an element from a line: number, type, number of tags, tags, nodes; the first tag is the group. */
static pg_status element_of_text (gmsh_reader *g, const char *at, const char *last)
{
    pg_status status = PG_OK;
    long id, type, tags, group = 0, tag, node[PG_ELEMENT_NODES];
    gmsh_type t;
    if (!mesh_whole (&at, last, &id) || !mesh_whole (&at, last, &type) || !mesh_whole (&at, last, &tags))
        GMSH_FAIL (g, "an element needs number, type and number of tags");
    if (tags < 0) GMSH_FAIL (g, "element %ld has %ld tags", id, tags);
    /* Further tags (entity, partitions) are not needed. */
    for (long k = 0; k < tags; k++) {
        if (!mesh_whole (&at, last, &tag))
            GMSH_FAIL (g, "element %ld: tag %ld of %ld is missing", id, k + 1, tags);
        if (k == 0) group = tag;
    }
    PG_TRY (gmsh_kind (g, type, id, 0, labs (group), &t));
    if (!t.known) goto done;
    int nodes = pg_element_types[t.kind].nodes;
    for (int k = 0; k < nodes; k++)
        if (!mesh_whole (&at, last, &node[k]))
            GMSH_FAIL (g, "element %ld (%s): node %d of %d is missing", id, pg_element_types[t.kind].name,
                       k + 1, nodes);
    PG_TRY (gmsh_element (g, &t, id, node, group, g->c.line));
done:
    return status;
}

/* Reads n elements, one per line. */
static pg_status elements_of_text (gmsh_reader *g, long n)
{
    pg_status status = PG_OK;
    for (long k = 0; k < n; k++) {
        const char *at, *last;
        PG_TRY (gmsh_line (g, "the last element", &at, &last));
        PG_TRY (element_of_text (g, at, last));
    }
done:
    return status;
}

/* ---- binary -------------------------------------------------------------------------------------------- */
/* Reads n nodes in binary form: number and coordinates, behind which parametric nodes have their parameters
 * on a curve or surface; these are skipped. */
static pg_status nodes_of_bytes (gmsh_reader *g, long n, int parametric)
{
    pg_status status = PG_OK;
    /* All nodes must fit before any is read; parameters make some longer. */
    PG_TRY (gmsh_has_left (g, "nodes", (size_t) n, parametric ? 36 : 28));
    for (long k = 0; k < n; k++) {
        double x[3];
        PG_TRY (gmsh_has_left (g, "a node", 1, parametric ? 36 : 28));
        int id = gmsh_int (g);
        for (int a = 0; a < 3; a++) x[a] = gmsh_double (g);
        PG_TRY (pg_mesh_builder_node (g->m, id, x));
        if (!parametric) continue;
        int dim = gmsh_int (g), more = dim == 1 || dim == 2 ? dim : 0;
        gmsh_int (g);
        PG_TRY (gmsh_has_left (g, "parameters of a node", (size_t) more, 8));
        g->c.at += 8 * more;
    }
done:
    return status;
}

/* Reads a block of elements of one type and one number of tags in binary form: number, tags, nodes of each.
 * *left: elements of the file that are still to be read. */
static pg_status block_of_bytes (gmsh_reader *g, long *left)
{
    pg_status status = PG_OK;
    gmsh_type t;
    PG_TRY (gmsh_has_left (g, "a block of elements", 3, 4));
    int type = gmsh_int (g), n = gmsh_int (g), tags = gmsh_int (g);
    if (n < 1 || n > *left || tags < 0)
        GMSH_FAIL (g, "a block of %d elements with %d tags each where %ld elements are left", n, tags, *left);
    PG_TRY (gmsh_has_left (g, "tags", (size_t) tags, 4));
    PG_TRY (gmsh_has_left (g, "an element", 1, 4));
    /* Number and group of the first element, for the message about an unknown type. */
    gmsh_reader peek = *g;
    long first = gmsh_int (&peek), own = 0;
    if (tags > 0) {
        PG_TRY (gmsh_has_left (g, "an element", 2, 4));
        own = gmsh_int (&peek);
    }
    PG_TRY (gmsh_kind (g, type, first, 0, labs (own), &t));
    int nodes = t.known ? pg_element_types[t.kind].nodes : t.nodes;
    PG_TRY (gmsh_has_left (g, "elements", (size_t) n, 4 * (1 + (size_t) tags + (size_t) nodes)));
    for (int k = 0; k < n; k++) {
        long node[PG_ELEMENT_NODES], id = gmsh_int (g), group = 0;
        for (int i = 0; i < tags; i++) {
            int tag = gmsh_int (g);
            if (i == 0) group = tag;
        }
        for (int i = 0; i < nodes; i++) node[i] = gmsh_int (g);
        if (t.known) PG_TRY (gmsh_element (g, &t, id, node, group, 0));
    }
    *left -= n;
done:
    return status;
}

/* ---- sections ------------------------------------------------------------------------------------------ */
/* Section $Nodes or $ParametricNodes. */
static pg_status read_nodes (gmsh_reader *g, const char *name)
{
    pg_status status = PG_OK;
    long n;
    PG_TRY (gmsh_wholes (g, "the number of nodes", 1, &n));
    if (n < 0) GMSH_FAIL (g, "%ld nodes", n);
    PG_TRY (g->binary ? nodes_of_bytes (g, n, !strcmp (name, "ParametricNodes")) : nodes_of_text (g, n));
    PG_TRY (gmsh_end (g, name));
done:
    return status;
}

/* Section $Elements. */
static pg_status read_elements (gmsh_reader *g)
{
    pg_status status = PG_OK;
    long n;
    PG_TRY (gmsh_wholes (g, "the number of elements", 1, &n));
    if (n < 0) GMSH_FAIL (g, "%ld elements", n);
    /* Text has one element per line; binary files have blocks until all elements are read. */
    if (!g->binary) PG_TRY (elements_of_text (g, n));
    else while (n > 0) PG_TRY (block_of_bytes (g, &n));
    PG_TRY (gmsh_end (g, "Elements"));
done:
    return status;
}

/* The order of sections does not matter. */
static pg_status read (pg_mesh_builder *m, const mesh_file *file)
{
    pg_status status = PG_OK;
    gmsh_reader g;
    char name[64];
    PG_TRY (gmsh_open (&g, m, file));
    while (gmsh_section (&g, name))
        if (!strcmp (name, "Nodes") || !strcmp (name, "ParametricNodes")) PG_TRY (read_nodes (&g, name));
        else if (!strcmp (name, "Elements")) PG_TRY (read_elements (&g));
        else if (!strcmp (name, "PhysicalNames")) PG_TRY (gmsh_names (&g));
        else {
            PG_TRY (pg_mesh_builder_pass (m, "section $%.40s", name));
            PG_TRY (gmsh_skip (&g, name));
        }
done:
    return status;
}

/* Versions 2.0 to 2.2 differ in nothing that is read here. */
static int knows (const mesh_file *file)
{
    double version;
    return gmsh_knows (file, &version) && version >= 2 && version < 3;
}

const mesh_format mesh_format_gmsh2 = { "Gmsh .msh 2.2", knows, read, NULL };
