/* SPDX-License-Identifier: GPL-3.0-or-later
 * The header of result.e: Exodus II in classic netCDF with 64-bit offsets, or CDF-5 if a
 * variable exceeds 4 GiB. Every point is a node and also an element of type SPHERE, which
 * ParaView and VisIt can draw; vals_nod_var<k> (time_step x num_nodes) is one component of one
 * field.
 *
 * Faces of cracks (pieces) are a block of elements BAR2 (2D) or TRI3 (3D) behind those of the points; each
 * has nodes of its own. The element variable `exists` of that block is 1 from the time on at which the face
 * has come into being; points have no such variable (elem_var_tab).
 *
 * Beyond Exodus the file has what exodus_read.c needs to restore the points: attributes
 * `field` and `units` of each variable, the variable `point_volume`, and global attributes for
 * spacing, lattice step, thickness and box. */
#include "exodus.h"
#include "netcdf_write.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest name in the file. */
enum { NAME = 64 };
/* A header that is being written. */
typedef struct {
    const exodus_layout *l;
    netcdf_writer *file;
    int     dim;
    /* Numbers of points, of nodes (points and corners of crack faces), of blocks of points. */
    size_t  n, nodes, nblock;
    /* The different values of cloud->block, ascending (nblock). */
    int    *block;
    /* Scratch space (nodes). */
    double *work;
    /* Scratch space (nodes + 1, at least nblock + 1). */
    int    *node;
    /* 1: the file is a part, and numbers of its points in the whole do not fit into 32-bit integers. */
    int     large;
} writer;

/* Nemesis variables that say whether a part has internal nodes, internal elements, border nodes, external
 * nodes and border elements (1: yes). */
static const char *const node_status[] = { "int_n_stat", "int_e_stat", "bor_n_stat", "ext_n_stat",
                                           "bor_e_stat" };

/* Exodus readers group names with these suffixes into vectors and into symmetric tensors in Voigt order. */
void pg_exodus_suffix (int dim, int components, int k, char *text, size_t size)
{
    static const char *const axis[] = { "x", "y", "z" }, *const plane[] = { "xx", "yy", "xy" };
    static const char *const solid[] = { "xx", "yy", "zz", "xy", "yz", "zx" };
    if (components == 1) text[0] = 0;
    else if (components == dim) snprintf (text, size, "_%s", axis[k]);
    else if (dim == 2 && components == 3) snprintf (text, size, "_%s", plane[k]);
    else if (dim == 3 && components == 6) snprintf (text, size, "_%s", solid[k]);
    else snprintf (text, size, "_%d", k + 1);
}

/* Global attributes: those that Exodus demands (version of the interface, size of numbers,
 * longest name), then ours: title, version of the program, and what a picture needs to know
 * about the points. */
static void define_globals (writer *w)
{
    const pg_cloud *cloud = w->l->cloud;
    const float version = 8.03f;
    const int word = 8, large = 1, wide = 0, longest = NAME, points = (int) w->n;
    netcdf_define_numbers (w->file, -1, "api_version", PG_NC_FLOAT, 1, &version);
    netcdf_define_numbers (w->file, -1, "version", PG_NC_FLOAT, 1, &version);
    netcdf_define_numbers (w->file, -1, "floating_point_word_size", PG_NC_INT, 1, &word);
    netcdf_define_numbers (w->file, -1, "file_size", PG_NC_INT, 1, &large);
    netcdf_define_numbers (w->file, -1, "int64_status", PG_NC_INT, 1, &wide);
    netcdf_define_numbers (w->file, -1, "maximum_name_length", PG_NC_INT, 1, &longest);
    netcdf_define_text (w->file, -1, "title", w->l->title ? w->l->title : "");
    netcdf_define_text (w->file, -1, "perigal_version", PG_VERSION);
    netcdf_define_numbers (w->file, -1, "spacing", PG_NC_DOUBLE, 1, &cloud->h);
    netcdf_define_numbers (w->file, -1, "lattice_step", PG_NC_DOUBLE, 3, cloud->step);
    netcdf_define_numbers (w->file, -1, "thickness", PG_NC_DOUBLE, 1, &cloud->thickness);
    netcdf_define_numbers (w->file, -1, "box_low", PG_NC_DOUBLE, 3, cloud->low);
    netcdf_define_numbers (w->file, -1, "box_high", PG_NC_DOUBLE, 3, cloud->high);
    netcdf_define_numbers (w->file, -1, "points", PG_NC_INT, 1, &points);
}

/* Defines an array of names. */
static void define_names (writer *w, const char *variable, int row_dim, int name_dim)
{
    netcdf_define_variable (w->file, variable, PG_NC_CHAR, 2, (int[2]) { row_dim, name_dim });
}

/* Defines the coordinates of the nodes, the names of the axes and the volumes of the points (m3). */
static void define_points (writer *w, int nodes, int name_dim)
{
    static const char *const variable[] = { "coordx", "coordy", "coordz" };
    int dim = netcdf_define_dimension (w->file, "num_dim", (size_t) w->dim);
    for (int a = 0; a < w->dim; a++)
        netcdf_define_variable (w->file, variable[a], PG_NC_DOUBLE, 1, &nodes);
    define_names (w, "coor_names", dim, name_dim);
    int var = netcdf_define_variable (w->file, "point_volume", PG_NC_DOUBLE, 1, &nodes);
    netcdf_define_text (w->file, var, "units", "m3");
}

/* 1 if point i belongs to the block k. */
static int belongs (const writer *w, size_t i, size_t k)
{
    return !w->l->cloud->block || w->l->cloud->block[i] == w->block[k];
}

/* Number of points in block k. */
static size_t count (const writer *w, size_t k)
{
    size_t m = 0;
    for (size_t i = 0; i < w->n; i++) m += (size_t) belongs (w, i, k);
    return m;
}

/* Defines block k of m elements with `each` nodes: connect<k + 1> (m x each) lists the nodes, counted from 1.
 * Readers of Exodus draw one glyph per sphere, which is why every point is an element, too. */
static void define_block (writer *w, size_t k, size_t m, size_t each, const char *type)
{
    char name[NAME];
    int dims[2];
    snprintf (name, sizeof name, "num_el_in_blk%zu", k + 1);
    dims[0] = netcdf_define_dimension (w->file, name, m);
    snprintf (name, sizeof name, "num_nod_per_el%zu", k + 1);
    dims[1] = netcdf_define_dimension (w->file, name, each);
    snprintf (name, sizeof name, "connect%zu", k + 1);
    netcdf_define_text (w->file, netcdf_define_variable (w->file, name, PG_NC_INT, 2, dims), "elem_type",
                        type);
}

/* Defines what the Nemesis interface (parallel Exodus) reads of a part: the number of parts, the sizes of the
 * whole, and the numbers of nodes and elements in the whole (equal for a point). No node is on two parts. */
static void define_share (writer *w, int nodes)
{
    const pg_field_share *s = w->l->share;
    const float version = 2.6f;
    int elements = netcdf_dimension_of (w->file, "num_elem"), file;
    netcdf_define_numbers (w->file, -1, "nemesis_file_version", PG_NC_FLOAT, 1, &version);
    netcdf_define_numbers (w->file, -1, "nemesis_api_version", PG_NC_FLOAT, 1, &version);
    netcdf_define_dimension (w->file, "num_processors", (size_t) s->size);
    file = netcdf_define_dimension (w->file, "num_procs_file", 1);
    netcdf_define_dimension (w->file, "num_nodes_global", (size_t) s->total);
    netcdf_define_dimension (w->file, "num_elems_global", (size_t) s->total);
    int blocks = netcdf_define_dimension (w->file, "num_el_blk_global", w->nblock),
        inner[2] = { netcdf_define_dimension (w->file, "num_int_node", w->n),
                     netcdf_define_dimension (w->file, "num_int_elem", w->n) };
    netcdf_define_variable (w->file, "nem_ftype", PG_NC_INT, 0, NULL);                     /* 0: a part */
    for (int k = 0; k < 5; k++) netcdf_define_variable (w->file, node_status[k], PG_NC_INT, 1, &file);
    netcdf_define_variable (w->file, "node_mapi", PG_NC_INT, 1, &inner[0]);
    netcdf_define_variable (w->file, "elem_mapi", PG_NC_INT, 1, &inner[1]);
    netcdf_define_variable (w->file, "el_blk_ids_global", PG_NC_INT, 1, &blocks);
    netcdf_define_variable (w->file, "el_blk_cnt_global", PG_NC_INT, 1, &blocks);
    if (!w->large) {
        netcdf_define_variable (w->file, "node_num_map", PG_NC_INT, 1, &nodes);
        netcdf_define_variable (w->file, "elem_num_map", PG_NC_INT, 1, &elements);
    } else netcdf_define_variable (w->file, "point_number", PG_NC_DOUBLE, 1, &nodes);
}

/* Defines the blocks with their numbers and names. A part may lack points of a block, which then has no
 * elements there. */
static void define_blocks (writer *w, int name_dim)
{
    int dim = netcdf_define_dimension (w->file, "num_el_blk", w->nblock + (w->l->npiece > 0));
    for (size_t k = 0; k < w->nblock; k++) {
        size_t m = count (w, k);
        if (m || !w->l->share) define_block (w, k, m, 1, "SPHERE");
    }
    if (w->l->npiece)
        define_block (w, w->nblock, w->l->npiece, (size_t) w->dim, w->dim == 3 ? "TRI3" : "BAR2");
    netcdf_define_variable (w->file, "eb_status", PG_NC_INT, 1, &dim);
    netcdf_define_text (w->file, netcdf_define_variable (w->file, "eb_prop1", PG_NC_INT, 1, &dim), "name",
                        "ID");
    define_names (w, "eb_names", dim, name_dim);
}

/* Defines the variables of a step, with the field they belong to and their unit as attributes.
 * Their order in a record is the order of their definition, on which exodus.c relies. */
static void define_fields (writer *w, int steps, int nodes, int name_dim)
{
    char name[NAME];
    size_t k = 0;
    int dim = netcdf_define_dimension (w->file, "num_nod_var", w->l->nvar);
    define_names (w, "name_nod_var", dim, name_dim);
    netcdf_define_variable (w->file, "time_whole", PG_NC_DOUBLE, 1, &steps);
    for (size_t v = 0; v < w->l->nfield; v++)
        for (int c = 0; c < w->l->field[v].components; c++, k++) {
            snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
            int var = netcdf_define_variable (w->file, name, PG_NC_DOUBLE, 2, (int[2]) { steps, nodes });
            netcdf_define_text (w->file, var, "field", w->l->field[v].name);
            netcdf_define_text (w->file, var, "units", w->l->field[v].unit);
        }
}

/* Defines the element variable `exists` of the block of crack faces; other blocks do not have it. */
static void define_existence (writer *w, int steps, int name_dim)
{
    char name[NAME];
    int dim = netcdf_define_dimension (w->file, "num_elem_var", 1);
    define_names (w, "name_elem_var", dim, name_dim);
    netcdf_define_variable (w->file, "elem_var_tab", PG_NC_INT, 2,
                            (int[2]) { netcdf_dimension_of (w->file, "num_el_blk"), dim });
    snprintf (name, sizeof name, "num_el_in_blk%zu", w->nblock + 1);
    int pieces = netcdf_dimension_of (w->file, name);
    snprintf (name, sizeof name, "vals_elem_var1eb%zu", w->nblock + 1);
    netcdf_define_variable (w->file, name, PG_NC_DOUBLE, 2, (int[2]) { steps, pieces });
}

/* All dimensions and variables. The lengths 33, 81 and 4 are those of the Exodus standard. */
static pg_status define_all (writer *w)
{
    define_globals (w);
    netcdf_define_dimension (w->file, "len_string", 33);
    netcdf_define_dimension (w->file, "len_line", 81);
    netcdf_define_dimension (w->file, "four", 4);
    int name_dim = netcdf_define_dimension (w->file, "len_name", NAME + 1);
    int steps = netcdf_define_dimension (w->file, "time_step", 0);
    int nodes = netcdf_define_dimension (w->file, "num_nodes", w->nodes);
    netcdf_define_dimension (w->file, "num_elem", w->n + w->l->npiece);
    define_points (w, nodes, name_dim);
    define_blocks (w, name_dim);
    define_fields (w, steps, nodes, name_dim);
    if (w->l->npiece) define_existence (w, steps, name_dim);
    if (w->l->share) define_share (w, nodes);
    return netcdf_end_header (w->file);
}

/* ---- values that stay ---------------------------------------------------------------------------------- */
/* Writes all n values of a variable. */
static pg_status put (writer *w, const char *variable, size_t n, const void *value)
{
    return netcdf_put (w->file, netcdf_variable_of (w->file, variable), 0, n, value);
}

/* Writes one row of an array of names, padded with zeros. */
static pg_status put_name (writer *w, const char *variable, size_t row, const char *name)
{
    char padded[NAME + 1] = "";
    snprintf (padded, sizeof padded, "%s", name);
    return netcdf_put (w->file, netcdf_variable_of (w->file, variable), row * sizeof padded, sizeof padded,
                       padded);
}

/* Writes coordinates, names of the axes and volumes. */
static pg_status put_points (writer *w)
{
    pg_status status = PG_OK;
    static const char *const variable[] = { "coordx", "coordy", "coordz" }, *const axis[] = { "x", "y", "z" };
    for (size_t a = 0; a < (size_t) w->dim; a++) {
        for (size_t i = 0; i < w->n; i++) w->work[i] = w->l->cloud->x[i * (size_t) w->dim + a];
        for (size_t i = w->n; i < w->nodes; i++)
            w->work[i] = w->l->piece[(i - w->n) / (size_t) w->dim].x[(i - w->n) % (size_t) w->dim][a];
        PG_TRY (put (w, variable[a], w->nodes, w->work));
        PG_TRY (put_name (w, "coor_names", a, axis[a]));
    }
    memcpy (w->work, w->l->volume, w->n * sizeof *w->work);
    for (size_t i = w->n; i < w->nodes; i++) w->work[i] = 0;
    PG_TRY (put (w, "point_volume", w->nodes, w->work));
done:
    return status;
}

/* Writes the block of crack faces, and the table by which only this block has the variable `exists`. */
static pg_status put_pieces (writer *w)
{
    pg_status status = PG_OK;
    char name[NAME];
    for (size_t i = 0; i < (size_t) w->dim * w->l->npiece; i++) w->node[i] = (int) (w->n + i) + 1;
    snprintf (name, sizeof name, "connect%zu", w->nblock + 1);
    PG_TRY (put (w, name, (size_t) w->dim * w->l->npiece, w->node));
    PG_TRY (put_name (w, "eb_names", w->nblock, EXODUS_CRACKS));
    PG_TRY (put_name (w, "name_elem_var", 0, "exists"));
    for (size_t k = 0; k <= w->nblock; k++) w->node[k] = k == w->nblock;
    PG_TRY (put (w, "elem_var_tab", w->nblock + 1, w->node));
done:
    return status;
}

/* Writes the blocks: nodes of each, name "block_<number>", status 1 and number. Exodus counts
 * them from 1: eb_prop1 = cloud->block + 1. */
static pg_status put_blocks (writer *w)
{
    pg_status status = PG_OK;
    char name[NAME];
    for (size_t k = 0; k < w->nblock; k++) {
        size_t m = 0;
        for (size_t i = 0; i < w->n; i++) if (belongs (w, i, k)) w->node[m++] = (int) i + 1;
        snprintf (name, sizeof name, "connect%zu", k + 1);
        if (m || !w->l->share) PG_TRY (put (w, name, m, w->node));
        snprintf (name, sizeof name, "block_%d", w->block[k]);
        PG_TRY (put_name (w, "eb_names", k, name));
    }
    size_t blocks = w->nblock + (w->l->npiece > 0);
    if (w->l->npiece) PG_TRY (put_pieces (w));
    for (size_t k = 0; k < blocks; k++) w->node[k] = k >= w->nblock || !w->l->share || count (w, k) > 0;
    PG_TRY (put (w, "eb_status", blocks, w->node));
    for (size_t k = 0; k < w->nblock; k++) w->node[k] = w->block[k] + 1;
    if (w->l->npiece) w->node[w->nblock] = w->block[w->nblock - 1] + 2;
    PG_TRY (put (w, "eb_prop1", blocks, w->node));
done:
    return status;
}

/* Writes the numbers in the whole, from 1, of the nodes and, block by block, of the elements. */
static pg_status put_maps (writer *w)
{
    pg_status status = PG_OK;
    const pg_field_share *s = w->l->share;
    size_t at = 0;
    for (size_t i = 0; i < w->n; i++) w->node[i] = w->large ? 0 : (int) s->number[i] + 1;
    if (!w->large) PG_TRY (put (w, "node_num_map", w->n, w->node));
    for (size_t k = 0; k < w->nblock; k++)
        for (size_t i = 0; i < w->n; i++)
            if (belongs (w, i, k)) w->node[at++] = w->large ? 0 : (int) s->number[i] + 1;
    if (!w->large) PG_TRY (put (w, "elem_num_map", w->n, w->node));
    for (size_t i = 0; w->large && i < w->n; i++) w->work[i] = (double) s->number[i] + 1;
    if (w->large) PG_TRY (put (w, "point_number", w->n, w->work));
done:
    return status;
}

static pg_status put_share (writer *w)
{
    pg_status status = PG_OK;
    const pg_field_share *s = w->l->share;
    int zero = 0;
    PG_TRY (put_maps (w));
    PG_TRY (put (w, "nem_ftype", 1, &zero));
    for (int k = 0; k < 5; k++) PG_TRY (put (w, node_status[k], 1, &(int) { k < 2 }));
    for (size_t i = 0; i < w->n; i++) w->node[i] = (int) i + 1;
    PG_TRY (put (w, "node_mapi", w->n, w->node));
    PG_TRY (put (w, "elem_mapi", w->n, w->node));
    for (size_t k = 0; k < w->nblock; k++) w->node[k] = w->block[k] + 1;
    PG_TRY (put (w, "el_blk_ids_global", w->nblock, w->node));
    for (size_t k = 0; k < w->nblock; k++) w->node[k] = (int) s->in_block[w->block[k]];
    PG_TRY (put (w, "el_blk_cnt_global", w->nblock, w->node));
done:
    return status;
}

/* Writes the names of all components of all fields. */
static pg_status put_field_names (writer *w)
{
    pg_status status = PG_OK;
    char part[16], name[NAME];
    size_t k = 0;
    for (size_t v = 0; v < w->l->nfield; v++)
        for (int c = 0; c < w->l->field[v].components; c++, k++) {
            pg_exodus_suffix (w->dim, w->l->field[v].components, c, part, sizeof part);
            snprintf (name, sizeof name, "%s%s", w->l->field[v].name, part);
            PG_TRY (put_name (w, "name_nod_var", k, name));
        }
done:
    return status;
}

/* ---- the file ------------------------------------------------------------------------------------------ */
/* Lists in w->block the blocks of the whole that have points; they are the same for every part. */
static pg_status find_blocks_of_whole (writer *w)
{
    pg_status status = PG_OK;
    const pg_field_share *s = w->l->share;
    size_t room = w->n + 1;
    PG_GROW (w->node, room, s->nblock + 1);
    room = w->n;
    PG_GROW (w->block, room, s->nblock + 1);
    w->nblock = 0;
    for (size_t k = 0; k < s->nblock; k++) if (s->in_block[k] > 0) w->block[w->nblock++] = (int) k;
    for (size_t i = 0; i < w->n; i++) w->large |= s->number[i] >= 0x7fffffff;
done:
    return status;
}

/* Finds the different block numbers of the points, ascending; one block if the cloud has none. */
static pg_status find_blocks (writer *w)
{
    pg_status status = PG_OK;
    PG_ALLOC (w->block, w->n);
    PG_ALLOC (w->node, w->nodes + 1);
    PG_ALLOC (w->work, w->nodes);
    w->nblock = 1;
    if (w->l->share) return find_blocks_of_whole (w);
    if (!w->l->cloud->block) goto done;
    memcpy (w->block, w->l->cloud->block, w->n * sizeof *w->block);
    pg_sort (w->block, w->n, sizeof *w->block, pg_ascending_ints);
    for (size_t i = 1; i < w->n; i++)
        if (w->block[i] != w->block[w->nblock - 1]) w->block[w->nblock++] = w->block[i];
done:
    return status;
}

/* Version 5 is used where needed: with version 2 a variable may have at most 2^32 - 4 bytes per step. */
pg_status pg_exodus_layout_write (const exodus_layout *layout)
{
    pg_status status = PG_OK;
    writer w = { .l = layout, .dim = layout->cloud->dim, .n = layout->cloud->n,
                 .nodes = layout->cloud->n + (size_t) layout->cloud->dim * layout->npiece };
    PG_TRY (find_blocks (&w));
    PG_TRY (netcdf_create (&w.file, layout->path, 
                           w.nodes > 0xfffffffcu / 8 || (layout->share && layout->share->total >= 0x7fffffff)
                               ? 5 : 2));
    PG_TRY (define_all (&w));
    PG_TRY (put_points (&w));
    PG_TRY (put_blocks (&w));
    PG_TRY (put_field_names (&w));
    if (layout->share) PG_TRY (put_share (&w));
    PG_TRY (netcdf_finish (&w.file));
done:
    netcdf_abandon (&w.file);
    pg_free (w.block), pg_free (w.node), pg_free (w.work);
    return status;
}
