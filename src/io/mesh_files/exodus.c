/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes and nodal results of Exodus II files (any kind of netCDF).
 *
 * Dimensions and variables used: num_dim, num_nodes, num_elem, num_el_blk; coordx, coordy, coordz (or
 * coord); num_el_in_blk1, num_nod_per_el1, connect1 with the attribute elem_type, eb_prop1, eb_names;
 * node_ns1, ns_prop1, ns_names; elem_ss1, side_ss1, ss_prop1, ss_names; node_num_map, elem_num_map;
 * time_whole, name_nod_var, vals_nod_var1.
 *
 * Nodes and elements are numbered 1, 2, ... by their order in the file while it is read; the numbers that
 * node_num_map and elem_num_map give them are assigned last. */
#include "format.h"
#include "perigal/netcdf.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

/* Length of a name, with its end. */
enum { NAME = 256 };

/* The open file. */
typedef struct {
    const char *path;
    pg_netcdf  *file;
    /* Numbers of nodes, elements and blocks; size of the file in bytes. */
    size_t nnode, n, nblock, bytes;
    /* Receives the mesh; NULL while fields are read. */
    pg_mesh_builder *builder;
    /* 1: this element is a shell, whose sides 1 and 2 are its top and bottom (n). */
    unsigned char *shell;
    /* 1: this element is of an unknown type and is skipped (n). */
    unsigned char *foreign;
} reader;

/* The variable of that name, which must have n values; *var = -1: there is none. A variable of another size
 * would overrun the arrays that receive it. */
static pg_status find (const reader *r, const char *name, size_t n, int *var)
{
    pg_status status = PG_OK;
    pg_netcdf_variable about;
    *var = pg_netcdf_find (r->file, name);
    if (*var < 0) goto done;
    pg_netcdf_about (r->file, *var, &about);
    if (about.n != n)
        PG_FAIL (PG_E_FILE, "%.400s: '%s' has %zu values, expected %zu", r->path, name, about.n, n);
done:
    return status;
}

/* The n whole numbers of a variable (newly allocated); *value NULL: there is none. */
static pg_status whole_numbers (const reader *r, const char *name, size_t n, long **value)
{
    pg_status status = PG_OK;
    int var;
    *value = NULL;
    PG_TRY (find (r, name, n, &var));
    if (var < 0) goto done;
    PG_ALLOC (*value, n);
    PG_TRY (pg_netcdf_longs (r->file, var, 0, n, *value));
done:
    if (status != PG_OK) pg_free (*value), *value = NULL;
    return status;
}

/* The n whole numbers (newly allocated) of a variable that every Exodus file needs; PG_E_FILE: none. */
static pg_status must (const reader *r, const char *name, size_t n, long **value)
{
    pg_status status = whole_numbers (r, name, n, value);
    if (status == PG_OK && !*value)
        status = pg_error (PG_E_FILE, PG_HERE, "%.400s: no '%s': not a whole Exodus file", r->path, name);
    return status;
}

/* Row k of a table of names without trailing blanks; "" where there is none. */
static void name_of (const reader *r, const char *table, size_t k, char name[NAME])
{
    pg_netcdf_variable about;
    int var = pg_netcdf_find (r->file, table);
    memset (name, 0, NAME);
    if (var < 0) return;
    pg_netcdf_about (r->file, var, &about);
    if (about.ndim != 2 || k >= about.first) return;
    /* Rows of the table have a fixed width and are padded by zeros or blanks. */
    size_t width = about.last < NAME - 1 ? about.last : NAME - 1;
    if (pg_netcdf_chars (r->file, var, k * about.last, width, name) != PG_OK) name[0] = 0;
    for (size_t m = strlen (name); m > 0 && name[m - 1] == ' '; m--) name[m - 1] = 0;
}

/* Bounds a count by what the file can hold before memory is asked for; even compressed, 4096 values need a
 * byte. */
static int too_many (const reader *r, size_t n) { return n > 4096 * r->bytes || n > 0x7fffffff; }

/* Opens the file from memory. */
static pg_status open_file (reader *r, const mesh_file *file)
{
    pg_status status = PG_OK;
    r->path = file->path, r->bytes = file->size;
    PG_TRY (pg_netcdf_parse (&r->file, file->path, file->text, file->size));
    r->nnode = pg_netcdf_length (r->file, "num_nodes");
    r->n = pg_netcdf_length (r->file, "num_elem");
    r->nblock = pg_netcdf_length (r->file, "num_el_blk");
    if (r->nnode == 0) PG_FAIL (PG_E_FILE, "%.400s: no nodes: not an Exodus file", r->path);
    if (too_many (r, r->nnode) || too_many (r, r->n) || r->nblock > r->bytes)
        PG_FAIL (PG_E_FILE, "%.400s: %zu nodes and %zu elements are more than it can hold", r->path, r->nnode,
                 r->n);
done:
    return status;
}

/* Closes the file if it was opened. */
static void close_file (reader *r)
{
    pg_netcdf_close (&r->file);
    pg_free (r->shell), pg_free (r->foreign);
}

/* ---- mesh ---------------------------------------------------------------------------------------------- */
/* Coordinates: coordx, coordy, coordz, or in old files one table `coord`. */
static pg_status read_nodes (reader *r)
{
    pg_status status = PG_OK;
    double *x[3] = { NULL, NULL, NULL }, *together = NULL;
    char name[16];
    int var;
    size_t dim = pg_netcdf_length (r->file, "num_dim");
    if (dim < 1 || dim > 3) PG_FAIL (PG_E_FILE, "%.400s: %zu dimensions", r->path, dim);
    for (size_t a = 0; a < 3; a++) PG_ALLOC (x[a], r->nnode);
    /* Old files have one table of all coordinates. */
    PG_TRY (find (r, "coord", dim * r->nnode, &var));
    if (var >= 0) {
        PG_ALLOC (together, dim * r->nnode);
        PG_TRY (pg_netcdf_doubles (r->file, var, 0, dim * r->nnode, together));
        for (size_t a = 0; a < dim; a++) memcpy (x[a], together + a * r->nnode, r->nnode * sizeof (double));
    }
    /* Files of today: one variable for each coordinate. */
    for (size_t a = 0; var < 0 && a < dim; a++) {
        int one;
        snprintf (name, sizeof name, "coord%c", "xyz"[a]);
        PG_TRY (find (r, name, r->nnode, &one));
        if (one < 0) PG_FAIL (PG_E_FILE, "%.400s: no '%s'", r->path, name);
        PG_TRY (pg_netcdf_doubles (r->file, one, 0, r->nnode, x[a]));
    }
    /* Coordinates beyond num_dim stay zero. */
    for (size_t i = 0; i < r->nnode; i++)
        PG_TRY (pg_mesh_builder_node (r->builder, (long) i + 1, (double[3]){ x[0][i], x[1][i], x[2][i] }));
done:
    for (size_t a = 0; a < 3; a++) pg_free (x[a]);
    pg_free (together);
    return status;
}

/* The element that a type name (by its beginning) with that number of nodes means; PG_ELEMENTS: unknown. */
static pg_element kind_of (const char *type, size_t nodes, int *shell)
{
    static const struct { const char *begin; int shell; pg_element kind[4];
    } table[] = { { "SPH", 0, { PG_POINT1 } },
                  { "CIRC", 0, { PG_POINT1 } },
                  { "POINT", 0, { PG_POINT1 } },
                  { "NODE", 0, { PG_POINT1 } },
                  { "BAR", 0, { PG_BAR2, PG_BAR3 } },
                  { "BEAM", 0, { PG_BAR2, PG_BAR3 } },
                  { "TRUSS", 0, { PG_BAR2, PG_BAR3 } },
                  { "ROD", 0, { PG_BAR2, PG_BAR3 } },
                  { "EDGE", 0, { PG_BAR2, PG_BAR3 } },
                  { "LINE", 0, { PG_BAR2, PG_BAR3 } },
                  { "TRIS", 1, { PG_TRI3, PG_TRI6 } },
                  { "TRI", 0, { PG_TRI3, PG_TRI6 } },
                  { "QUA", 0, { PG_QUAD4, PG_QUAD8, PG_QUAD9 } },
                  { "SHE", 1, { PG_QUAD4, PG_QUAD8, PG_QUAD9, PG_TRI3 } },
                  { "TET", 0, { PG_TET4, PG_TET10 } },
                  { "HEX", 0, { PG_HEX8, PG_HEX20, PG_HEX27 } },
                  { "WED", 0, { PG_WEDGE6, PG_WEDGE15 } },
                  { "PYR", 0, { PG_PYRAMID5 } } };
    for (size_t k = 0; k < sizeof table / sizeof *table; k++) {
        /* Types are written as HEX, HEX8, hex27, SHELL4 and so on: the beginning and the number of nodes
         * decide. */
        if (strncasecmp (type, table[k].begin, strlen (table[k].begin)) != 0) continue;
        *shell = table[k].shell;
        /* Kinds that the table leaves out are 0, that is PG_POINT1: only the first entry may be a point. */
        for (int j = 0; j < 4; j++)
            if ((j == 0 || table[k].kind[j]) && (size_t) pg_element_types[table[k].kind[j]].nodes == nodes)
                return table[k].kind[j];
    }
    return PG_ELEMENTS;
}

/* Number and kind of the elements of block k; PG_ELEMENTS: the block is empty, or its type is not known. */
static pg_status block_kind (const reader *r, size_t k, long group, size_t *count, pg_element *kind,
                             int *shell)
{
    pg_status status = PG_OK;
    char name[64], type[NAME] = "", block[NAME], words[400];
    snprintf (name, sizeof name, "num_el_in_blk%zu", k + 1);
    *count = pg_netcdf_length (r->file, name);
    snprintf (name, sizeof name, "num_nod_per_el%zu", k + 1);
    size_t nodes = pg_netcdf_length (r->file, name);
    *kind = PG_ELEMENTS;
    /* An empty block has no connectivity. */
    if (*count == 0) goto done;
    snprintf (name, sizeof name, "connect%zu", k + 1);
    /* The type is an attribute of the connectivity. */
    int var = pg_netcdf_find (r->file, name);
    if (var < 0) PG_FAIL (PG_E_FILE, "%.400s: no '%s': not a whole Exodus file", r->path, name);
    (void) pg_netcdf_text (r->file, var, "elem_type", type, sizeof type);
    *kind = kind_of (type, nodes, shell);
    if (*kind == PG_ELEMENTS) {
        snprintf (words, sizeof words, "%.100s: block %ld has elements '%.30s' of %zu nodes; known are BAR, "
                  "TRI, QUAD, SHELL, TET, WEDGE and HEX of first and second order, PYRAMID of "
                  "first", r->path, group, type,
                  nodes);
        name_of (r, "eb_names", k, block);
        if (!block[0]) snprintf (block, sizeof block, "%ld", group);
        PG_TRY (pg_mesh_builder_foreign (r->builder, type, block, words));
    }
done:
    return status;
}

/* Reads the numbers of the blocks (eb_prop1); they become 1, 2, ... if the file gives none, or one twice. */
static pg_status block_numbers (reader *r, long **id)
{
    pg_status status = PG_OK;
    int useful = 1;
    PG_TRY (whole_numbers (r, "eb_prop1", r->nblock, id));
    for (size_t k = 0; *id && k < r->nblock; k++) {
        useful &= (*id)[k] > 0 && (*id)[k] <= 0x7fffffff;
        for (size_t j = 0; j < k && useful; j++) useful = (*id)[j] != (*id)[k];
    }
    if (!*id) PG_ALLOC (*id, r->nblock);
    else if (useful) goto done;
    for (size_t k = 0; k < r->nblock; k++) (*id)[k] = (long) k + 1;
done:
    return status;
}

/* Reads the elements of block k, whose number is `group`; *first: number of elements before it, updated. */
static pg_status read_block (reader *r, size_t k, long group, size_t *first)
{
    pg_status status = PG_OK;
    size_t count;
    pg_element kind;
    int shell = 0;
    long *connect = NULL;
    char name[NAME];
    PG_TRY (block_kind (r, k, group, &count, &kind, &shell));
    /* Counts of blocks may not exceed that of the file: other arrays have that size. */
    if (count > r->n - *first)
        PG_FAIL (PG_E_FILE, "%.400s: its blocks have more than the %zu elements of the file", r->path, r->n);
    if (kind == PG_ELEMENTS) {
        memset (r->foreign + *first, 1, count);
        *first += count;
        goto done;
    }
    size_t nodes = (size_t) pg_element_types[kind].nodes;
    snprintf (name, sizeof name, "connect%zu", k + 1);
    PG_TRY (must (r, name, count * nodes, &connect));
    for (size_t e = 0; e < count; e++) {
        PG_TRY (pg_mesh_builder_element (r->builder, (long) (*first + e) + 1, kind, connect + e * nodes,
                                         group, 0));
        r->shell[*first + e] = (unsigned char) shell;
    }
    *first += count;
    name_of (r, "eb_names", k, name);
    if (name[0]) PG_TRY (pg_mesh_builder_group (r->builder, pg_element_types[kind].dim, group, name));
done:
    pg_free (connect);
    return status;
}

/* PG_E_FILE if all elements are points: results of Perigal and of other meshfree codes are no meshes. */
static pg_status check_points (const reader *r)
{
    pg_status status = PG_OK;
    const pg_mesh_given given = pg_mesh_builder_given (r->builder);
    /* One element with an extent is enough. */
    for (size_t e = 0; e < given.n; e++) if (given.kind[e] != PG_POINT1) goto done;
    for (size_t e = 0; e < r->n; e++) if (r->foreign[e]) goto done;
    PG_FAIL (PG_E_FILE, "%.400s: points without elements (SPHERE): a result of points is no mesh", r->path);
done:
    return status;
}

/* Reads the node sets with their names and numbers. */
static pg_status read_node_sets (reader *r)
{
    pg_status status = PG_OK;
    long *id = NULL, *node = NULL;
    size_t n = pg_netcdf_length (r->file, "num_node_sets");
    char name[NAME];
    if (n == 0 || n > r->bytes) goto done;
    PG_TRY (whole_numbers (r, "ns_prop1", n, &id));
    for (size_t k = 0; k < n; k++) {
        snprintf (name, sizeof name, "num_nod_ns%zu", k + 1);
        size_t m = pg_netcdf_length (r->file, name);
        name_of (r, "ns_names", k, name);
        PG_TRY (pg_mesh_builder_nodeset (r->builder, name, id ? id[k] : (long) k + 1));
        /* An empty set has a name and a number, but no variable. */
        if (m == 0) continue;
        snprintf (name, sizeof name, "node_ns%zu", k + 1);
        PG_TRY (must (r, name, m, &node));
        for (size_t i = 0; i < m; i++) PG_TRY (pg_mesh_builder_nodeset_add (r->builder, node[i]));
        pg_free (node), node = NULL;
    }
done:
    pg_free (id), pg_free (node);
    return status;
}

/* Adds a side (numbered from 1) of an element to the present side set. Sides 1 and 2 of a shell, its top and
 * bottom, are left out, as they are no edges of the 2D element. */
static pg_status add_side (const reader *r, long element, long side)
{
    pg_status status = PG_OK;
    if (element < 1 || (size_t) element > r->n)
        PG_FAIL (PG_E_FILE, "%.400s: a side set has element %ld of %zu", r->path, element, r->n);
    if (side < 1 || side > 6)
        PG_FAIL (PG_E_FILE, "%.400s: a side set has side %ld of element %ld", r->path, side, element);
    if (r->foreign[element - 1]) goto done;
    /* Edges of shells are sides 3 and on. */
    int first = r->shell[element - 1] ? 3 : 1;
    if (side < first) goto done;
    PG_TRY (pg_mesh_builder_sideset_add (r->builder, element, (int) side - first));
done:
    return status;
}

/* Reads the side sets with their names and numbers. */
static pg_status read_side_sets (reader *r)
{
    pg_status status = PG_OK;
    long *id = NULL, *element = NULL, *side = NULL;
    size_t n = pg_netcdf_length (r->file, "num_side_sets");
    char name[NAME];
    if (n == 0 || n > r->bytes) goto done;
    PG_TRY (whole_numbers (r, "ss_prop1", n, &id));
    for (size_t k = 0; k < n; k++) {
        snprintf (name, sizeof name, "num_side_ss%zu", k + 1);
        size_t m = pg_netcdf_length (r->file, name);
        name_of (r, "ss_names", k, name);
        PG_TRY (pg_mesh_builder_sideset (r->builder, name, id ? id[k] : (long) k + 1));
        if (m == 0) continue;
        snprintf (name, sizeof name, "elem_ss%zu", k + 1);
        PG_TRY (must (r, name, m, &element));
        snprintf (name, sizeof name, "side_ss%zu", k + 1);
        PG_TRY (must (r, name, m, &side));
        for (size_t i = 0; i < m; i++) PG_TRY (add_side (r, element[i], side[i]));
        pg_free (element), pg_free (side), element = side = NULL;
    }
done:
    pg_free (id), pg_free (element), pg_free (side);
    return status;
}

/* Assigns the numbers that the file gives its nodes and elements. */
static pg_status renumber (const reader *r)
{
    pg_status status = PG_OK;
    long *node = NULL, *element = NULL;
    PG_TRY (whole_numbers (r, "node_num_map", r->nnode, &node));
    PG_TRY (whole_numbers (r, "elem_num_map", r->n, &element));
    pg_mesh_builder_renumber (r->builder, r->nnode, node, element);
done:
    pg_free (node), pg_free (element);
    return status;
}

/* Reports nodal, element and global variables as skipped: they are no part of a mesh. */
static pg_status pass_results (const reader *r)
{
    pg_status status = PG_OK;
    static const struct { const char *count, *names, *what; } table[] = {
        { "num_nod_var", "name_nod_var", "node" }, { "num_elem_var", "name_elem_var", "element" },
        { "num_glo_var", "name_glo_var", "global" } };
    for (size_t t = 0; t < sizeof table / sizeof *table; t++) {
        size_t n = pg_netcdf_length (r->file, table[t].count);
        char name[NAME];
        for (size_t k = 0; k < n && k < 20; k++) {
            name_of (r, table[t].names, k, name);
            PG_TRY (pg_mesh_builder_pass (r->builder, "%s variable %.40s", table[t].what, name));
        }
    }
done:
    return status;
}

/* Blocks must hold exactly as many elements as the file says. */
static pg_status read_exodus (pg_mesh_builder *m, const mesh_file *file)
{
    pg_status status = PG_OK;
    reader r = { .builder = m };
    size_t first = 0;
    long *id = NULL;
    PG_TRY (open_file (&r, file));
    if (r.n == 0) PG_FAIL (PG_E_FILE, "%.400s: no elements", r.path);
    PG_ALLOC (r.shell, r.n);
    PG_ALLOC (r.foreign, r.n);
    PG_TRY (read_nodes (&r));
    PG_TRY (block_numbers (&r, &id));
    for (size_t k = 0; k < r.nblock; k++) PG_TRY (read_block (&r, k, id[k], &first));
    if (first < r.n)
        PG_FAIL (PG_E_FILE, "%.400s: its blocks have %zu of the %zu elements of the file", r.path, first,
                 r.n);
    /* Sets refer to nodes and elements by their order in the file, which `renumber` replaces in the end. */
    PG_TRY (check_points (&r));
    PG_TRY (read_node_sets (&r));
    PG_TRY (read_side_sets (&r));
    PG_TRY (renumber (&r));
    PG_TRY (pass_results (&r));
done:
    pg_free (id);
    close_file (&r);
    return status;
}

/* 1 if the file begins like classic netCDF (versions 1, 2, 5) or HDF5. */
static int knows_exodus (const mesh_file *file)
{
    return file->size > 8
           && (!memcmp (file->text, "CDF\1", 4) || !memcmp (file->text, "CDF\2", 4)
               || !memcmp (file->text, "CDF\5", 4) || !memcmp (file->text, "\x89HDF\r\n\x1a\n", 8));
}

/* ---- fields -------------------------------------------------------------------------------------------- */
/* A nodal variable. base: its name without suffix; part: component that the suffix names, -1: no suffix. */
typedef struct { char base[NAME]; int part, var; } variable;

/* Splits "stress_xy" into "stress" and 3; components of vectors are 10 and on. */
static void split_name (const char *name, variable *v)
{
    /* xz is another name of zx. */
    static const char *const suffix[] = { "xx", "yy", "zz", "xy", "yz", "zx", "xz", "x", "y", "z" };
    /* Parts from 10 on belong to vectors. */
    static const int part[] = { 0, 1, 2, 3, 4, 5, 5, 10, 11, 12 };
    const char *bar = strrchr (name, '_');
    snprintf (v->base, sizeof v->base, "%s", name);
    v->part = -1;
    for (size_t k = 0; bar && bar > name && k < sizeof suffix / sizeof *suffix; k++)
        if (strcasecmp (bar + 1, suffix[k]) == 0) v->part = part[k], v->base[bar - name] = 0;
}

/* 1 if two variables are components of one field. */
static int together (const variable *a, const variable *b)
{
    return a->part >= 0 && b->part >= 0 && a->part / 10 == b->part / 10 && strcmp (a->base, b->base) == 0;
}

/* Components that a field has in a mesh; those that the file leaves out stay 0. */
static int components_of (const variable *v) { return v->part < 0 ? 1 : v->part >= 10 ? 3 : 6; }

/* Reads the values of one variable in one step into its component of the field; at: index in the file of each
 * node of the mesh; work: room for all nodes of the file. */
static pg_status read_values (const reader *r, const variable *v, size_t step, const pg_mesh *mesh,
                              const int *at, double *work, pg_mesh_field *field)
{
    pg_status status = PG_OK;
    size_t c = v->part < 0 ? 0 : (size_t) v->part % 10, m = (size_t) field->components;
    PG_TRY (pg_netcdf_doubles (r->file, v->var, step * r->nnode, r->nnode, work));
    for (size_t i = 0; i < mesh->nnode; i++) {
        double value = work[at[i]];
        /* A field must be finite wherever the mesh has a node. */
        if (!isfinite (value))
            PG_FAIL (PG_E_FILE, "%.400s: %s at node %ld is not finite", r->path, v->base, mesh->node_id[i]);
        field->value[i * m + c] = value;
    }
done:
    return status;
}

/* Lists all n nodal variables: name without suffix, component, netCDF variable. */
static pg_status list_variables (const reader *r, size_t steps, size_t n, variable *v)
{
    pg_status status = PG_OK;
    char name[NAME];
    for (size_t k = 0; k < n; k++) {
        snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
        PG_TRY (find (r, name, steps * r->nnode, &v[k].var));
        if (v[k].var < 0) PG_FAIL (PG_E_FILE, "%.400s: no '%s'", r->path, name);
        name_of (r, "name_nod_var", k, name);
        /* A variable without a name is known by its number. */
        if (!name[0]) snprintf (name, sizeof name, "variable %zu", k + 1);
        split_name (name, &v[k]);
    }
done:
    return status;
}

/* Sets at[i] to the index in the file of node i of the mesh. */
static pg_status find_nodes (const reader *r, const pg_mesh *mesh, int *at)
{
    pg_status status = PG_OK;
    long *number = NULL;
    pg_id_table t = { 0 };
    size_t twice;
    PG_TRY (whole_numbers (r, "node_num_map", r->nnode, &number));
    if (number) PG_TRY (pg_id_table_build (&t, r->nnode, number, &twice));
    for (size_t i = 0; i < mesh->nnode; i++) {
        long place = number ? pg_id_table_find (&t, mesh->node_id[i]) : mesh->node_id[i] - 1;
        if (place < 0 || (size_t) place >= r->nnode)
            PG_FAIL (PG_E_FILE, "%.400s: node %ld is not there", r->path, mesh->node_id[i]);
        at[i] = (int) place;
    }
done:
    pg_id_table_clear (&t);
    pg_free (number);
    return status;
}

/* Each field is read with the first of its components. */
static pg_status read_fields (mesh_fields *out, const reader *r, const pg_mesh *mesh, size_t n,
                              const variable *v, size_t step)
{
    pg_status status = PG_OK;
    double *work = NULL;
    int *at = NULL;
    PG_ALLOC (work, r->nnode);
    PG_ALLOC (at, mesh->nnode);
    PG_TRY (find_nodes (r, mesh, at));
    for (size_t k = 0; k < n; k++) {
        pg_mesh_field *field;
        size_t j = 0;
        /* Is there an earlier component of the same field? */
        while (j < k && !together (&v[j], &v[k])) j++;
        /* This component was read with the first of its field. */
        if (j < k) continue;
        PG_TRY (mesh_fields_add (out, mesh->nnode, v[k].base, components_of (&v[k]), &field));
        for (j = k; j < n; j++)
            if (j == k || together (&v[j], &v[k]))
                PG_TRY (read_values (r, &v[j], step, mesh, at, work, field));
    }
done:
    pg_free (work), pg_free (at);
    return status;
}

/* Variables whose names differ in their suffix only (u_x, u_y) become one field. */
static pg_status fields_exodus (mesh_fields *out, const pg_mesh *mesh, const mesh_file *file, int step)
{
    pg_status status = PG_OK;
    reader r = { 0 };
    variable *v = NULL;
    int time;
    size_t chosen;
    PG_TRY (open_file (&r, file));
    size_t steps = pg_netcdf_length (r.file, "time_step"), n = pg_netcdf_length (r.file, "num_nod_var");
    if (n > r.bytes) PG_FAIL (PG_E_FILE, "%.400s: %zu variables are more than it can hold", r.path, n);
    /* A file without nodal variables counts as one without steps. */
    PG_TRY (mesh_fields_step (r.path, n ? steps : 0, step, &chosen));
    PG_ALLOC (v, n);
    PG_TRY (list_variables (&r, steps, n, v));
    time = pg_netcdf_find (r.file, "time_whole");
    if (time >= 0) PG_TRY (pg_netcdf_doubles (r.file, time, chosen, 1, &out->time));
    PG_TRY (read_fields (out, &r, mesh, n, v, chosen));
done:
    close_file (&r);
    pg_free (v);
    return status;
}

const mesh_format mesh_format_exodus = { "Exodus II", knows_exodus, read_exodus, fields_exodus };
