/* SPDX-License-Identifier: GPL-3.0-or-later
 * The header of result.e: Exodus II in classic netCDF with 64-bit offsets, or CDF-5 if a
 * variable exceeds 4 GiB. Every point is a node and also an element of type SPHERE, which
 * ParaView and VisIt can draw; vals_nod_var<k> (time_step x num_nodes) is one component of one
 * field.
 *
 * Lines (faces of cracks) are a block of elements BAR2 behind those of the points; each has two nodes of its
 * own. The element variable `exists` of that block is 1 from the time on at which the line has come into
 * being; points have no such variable (elem_var_tab).
 *
 * Beyond Exodus the file has what exodus_read.c needs to restore the points: attributes
 * `field` and `units` of each variable, the variable `point_volume`, and global attributes for
 * spacing, lattice step, thickness and box. */
#include "exodus.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Longest name in the file. */
enum { NAME = 64 };
/* A header that is being written. */
typedef struct {
    const exodus_layout *l;
    int     ncid, open, dim;
    /* Points; nodes: those and the ends of lines; blocks of points. */
    size_t  n, nodes, nblock;
    /* The different values of cloud->block, ascending (nblock). */
    int    *block;
    /* Scratch space (n). */
    double *work;
    /* Scratch space (n). */
    int    *node;
} writer;

/* The suffix of component k: "_x", "_xy", "_7". Exodus readers group names with these suffixes
 * into vectors and into symmetric tensors in Voigt order. */
static void part_suffix (int dim, int components, int k, char *text, size_t size)
{
    static const char *const axis[] = { "x", "y", "z" }, *const plane[] = { "xx", "yy", "xy" };
    static const char *const solid[] = { "xx", "yy", "zz", "xy", "yz", "zx" };
    if (components == 1) text[0] = 0;
    else if (components == dim) snprintf (text, size, "_%s", axis[k]);
    else if (dim == 2 && components == 3) snprintf (text, size, "_%s", plane[k]);
    else if (dim == 3 && components == 6) snprintf (text, size, "_%s", solid[k]);
    else snprintf (text, size, "_%d", k + 1);
}

/* Writes a text attribute; returns the code of netCDF. */
static int put_text (int ncid, int var, const char *name, const char *text)
{
    return nc_put_att_text (ncid, var, name, strlen (text), text);
}

/* Writes a global attribute of n doubles; returns the code of netCDF. */
static int put_numbers (int ncid, const char *name, size_t n, const double *value)
{
    return nc_put_att_double (ncid, NC_GLOBAL, name, NC_DOUBLE, n, value);
}

/* Global attributes: those that Exodus demands (version of the interface, size of numbers,
 * longest name), then ours: title, version of the program, and what a picture needs to know
 * about the points. */
static pg_status define_globals (writer *w)
{
    pg_status status = PG_OK;
    const char *path = w->l->path;
    const pg_cloud *cloud = w->l->cloud;
    float version = 8.03f;
    int word = 8, large = 1, wide = 0, longest = NAME;
    NC_TRY (path, nc_put_att_float (w->ncid, NC_GLOBAL, "api_version", NC_FLOAT, 1, &version));
    NC_TRY (path, nc_put_att_float (w->ncid, NC_GLOBAL, "version", NC_FLOAT, 1, &version));
    NC_TRY (path, nc_put_att_int (w->ncid, NC_GLOBAL, "floating_point_word_size", NC_INT, 1, &word));
    NC_TRY (path, nc_put_att_int (w->ncid, NC_GLOBAL, "file_size", NC_INT, 1, &large));
    NC_TRY (path, nc_put_att_int (w->ncid, NC_GLOBAL, "int64_status", NC_INT, 1, &wide));
    NC_TRY (path, nc_put_att_int (w->ncid, NC_GLOBAL, "maximum_name_length", NC_INT, 1, &longest));
    NC_TRY (path, put_text (w->ncid, NC_GLOBAL, "title", w->l->title ? w->l->title : ""));
    NC_TRY (path, put_text (w->ncid, NC_GLOBAL, "perigal_version", PG_VERSION));
    NC_TRY (path, put_numbers (w->ncid, "spacing", 1, &cloud->h));
    NC_TRY (path, put_numbers (w->ncid, "lattice_step", 3, cloud->step));
    NC_TRY (path, put_numbers (w->ncid, "thickness", 1, &cloud->thickness));
    NC_TRY (path, put_numbers (w->ncid, "box_low", 3, cloud->low));
    NC_TRY (path, put_numbers (w->ncid, "box_high", 3, cloud->high));
    int points = (int) w->n;
    NC_TRY (path, nc_put_att_int (w->ncid, NC_GLOBAL, "points", NC_INT, 1, &points));
done:
    return status;
}

/* Defines an array of names. */
static pg_status define_names (writer *w, const char *variable, int row_dim, int name_dim)
{
    pg_status status = PG_OK;
    int var, dims[2] = { row_dim, name_dim };
    NC_TRY (w->l->path, nc_def_var (w->ncid, variable, NC_CHAR, 2, dims, &var));
done:
    return status;
}

/* Coordinates, names of the axes, volumes. */
static pg_status define_points (writer *w, int nodes, int name_dim)
{
    pg_status status = PG_OK;
    static const char *const variable[] = { "coordx", "coordy", "coordz" };
    int dim, var;
    NC_TRY (w->l->path, nc_def_dim (w->ncid, "num_dim", (size_t) w->dim, &dim));
    for (int a = 0; a < w->dim; a++)
        NC_TRY (w->l->path, nc_def_var (w->ncid, variable[a], NC_DOUBLE, 1, &nodes, &var));
    PG_TRY (define_names (w, "coor_names", dim, name_dim));
    NC_TRY (w->l->path, nc_def_var (w->ncid, "point_volume", NC_DOUBLE, 1, &nodes, &var));
    NC_TRY (w->l->path, put_text (w->ncid, var, "units", "m3"));
done:
    return status;
}

/* 1 if point i belongs to the block k. */
static int belongs (const writer *w, size_t i, size_t k)
{
    return !w->l->cloud->block || w->l->cloud->block[i] == w->block[k];
}

/* One block of elements with `each` nodes: connect<k> (elements x each) lists them, counted from 1. Readers
 * of Exodus draw one glyph per sphere, which is why every point is an element, too. */
static pg_status define_block (writer *w, size_t k, size_t m, size_t each, const char *type)
{
    pg_status status = PG_OK;
    char name[NAME];
    int dims[2], var;
    snprintf (name, sizeof name, "num_el_in_blk%zu", k + 1);
    NC_TRY (w->l->path, nc_def_dim (w->ncid, name, m, &dims[0]));
    snprintf (name, sizeof name, "num_nod_per_el%zu", k + 1);
    NC_TRY (w->l->path, nc_def_dim (w->ncid, name, each, &dims[1]));
    snprintf (name, sizeof name, "connect%zu", k + 1);
    NC_TRY (w->l->path, nc_def_var (w->ncid, name, NC_INT, 2, dims, &var));
    NC_TRY (w->l->path, put_text (w->ncid, var, "elem_type", type));
done:
    return status;
}

/* The blocks with their numbers and names. */
static pg_status define_blocks (writer *w, int name_dim)
{
    pg_status status = PG_OK;
    int dim, var;
    NC_TRY (w->l->path, nc_def_dim (w->ncid, "num_el_blk", w->nblock + (w->l->nline > 0), &dim));
    for (size_t k = 0; k < w->nblock; k++) {
        size_t m = 0;
        for (size_t i = 0; i < w->n; i++) m += (size_t) belongs (w, i, k);
        PG_TRY (define_block (w, k, m, 1, "SPHERE"));
    }
    if (w->l->nline) PG_TRY (define_block (w, w->nblock, w->l->nline, 2, "BAR2"));
    NC_TRY (w->l->path, nc_def_var (w->ncid, "eb_status", NC_INT, 1, &dim, &var));
    NC_TRY (w->l->path, nc_def_var (w->ncid, "eb_prop1", NC_INT, 1, &dim, &var));
    NC_TRY (w->l->path, put_text (w->ncid, var, "name", "ID"));
    PG_TRY (define_names (w, "eb_names", dim, name_dim));
done:
    return status;
}

/* The variables of a step, with the field they belong to and their unit as attributes. Their
 * order in a record is the order of their definition, on which exodus.c relies. */
static pg_status define_fields (writer *w, int steps, int nodes, int name_dim)
{
    pg_status status = PG_OK;
    char name[NAME];
    size_t k = 0;
    int dim, var, dims[2] = { steps, nodes };
    NC_TRY (w->l->path, nc_def_dim (w->ncid, "num_nod_var", w->l->nvar, &dim));
    PG_TRY (define_names (w, "name_nod_var", dim, name_dim));
    NC_TRY (w->l->path, nc_def_var (w->ncid, "time_whole", NC_DOUBLE, 1, &steps, &var));
    for (size_t v = 0; v < w->l->nfield; v++)
        for (int c = 0; c < w->l->field[v].components; c++, k++) {
            snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
            NC_TRY (w->l->path, nc_def_var (w->ncid, name, NC_DOUBLE, 2, dims, &var));
            NC_TRY (w->l->path, put_text (w->ncid, var, "field", w->l->field[v].name));
            NC_TRY (w->l->path, put_text (w->ncid, var, "units", w->l->field[v].unit));
        }
done:
    return status;
}

/* The variable of lines, which only their block has. */
static pg_status define_existence (writer *w, int steps, int name_dim)
{
    pg_status status = PG_OK;
    char name[NAME];
    int dim, blocks, lines, var;
    NC_TRY (w->l->path, nc_def_dim (w->ncid, "num_elem_var", 1, &dim));
    PG_TRY (define_names (w, "name_elem_var", dim, name_dim));
    NC_TRY (w->l->path, nc_inq_dimid (w->ncid, "num_el_blk", &blocks));
    NC_TRY (w->l->path, nc_def_var (w->ncid, "elem_var_tab", NC_INT, 2, (int[2]) { blocks, dim }, &var));
    snprintf (name, sizeof name, "num_el_in_blk%zu", w->nblock + 1);
    NC_TRY (w->l->path, nc_inq_dimid (w->ncid, name, &lines));
    snprintf (name, sizeof name, "vals_elem_var1eb%zu", w->nblock + 1);
    NC_TRY (w->l->path, nc_def_var (w->ncid, name, NC_DOUBLE, 2, (int[2]) { steps, lines }, &var));
done:
    return status;
}

/* All dimensions and variables. The lengths 33, 81 and 4 are those of the Exodus standard. */
static pg_status define_all (writer *w)
{
    pg_status status = PG_OK;
    const char *path = w->l->path;
    int steps, nodes, name_dim, unused;
    PG_TRY (define_globals (w));
    NC_TRY (path, nc_def_dim (w->ncid, "len_string", 33, &unused));
    NC_TRY (path, nc_def_dim (w->ncid, "len_line", 81, &unused));
    NC_TRY (path, nc_def_dim (w->ncid, "four", 4, &unused));
    NC_TRY (path, nc_def_dim (w->ncid, "len_name", NAME + 1, &name_dim));
    NC_TRY (path, nc_def_dim (w->ncid, "time_step", NC_UNLIMITED, &steps));
    NC_TRY (path, nc_def_dim (w->ncid, "num_nodes", w->nodes, &nodes));
    NC_TRY (path, nc_def_dim (w->ncid, "num_elem", w->n + w->l->nline, &unused));
    PG_TRY (define_points (w, nodes, name_dim));
    PG_TRY (define_blocks (w, name_dim));
    PG_TRY (define_fields (w, steps, nodes, name_dim));
    if (w->l->nline) PG_TRY (define_existence (w, steps, name_dim));
    NC_TRY (path, nc_enddef (w->ncid));
done:
    return status;
}

/* ---- values that stay ---------------------------------------------------------------------------------- */
/* Writes a whole variable of doubles. */
static pg_status put_doubles (writer *w, const char *variable, const double *value)
{
    pg_status status = PG_OK;
    int var;
    NC_TRY (w->l->path, nc_inq_varid (w->ncid, variable, &var));
    NC_TRY (w->l->path, nc_put_var_double (w->ncid, var, value));
done:
    return status;
}

/* Writes a whole variable of ints. */
static pg_status put_ints (writer *w, const char *variable, const int *value)
{
    pg_status status = PG_OK;
    int var;
    NC_TRY (w->l->path, nc_inq_varid (w->ncid, variable, &var));
    NC_TRY (w->l->path, nc_put_var_int (w->ncid, var, value));
done:
    return status;
}

/* Writes one row of an array of names, padded with zeros. */
static pg_status put_name (writer *w, const char *variable, size_t row, const char *name)
{
    pg_status status = PG_OK;
    char padded[NAME + 1] = "";
    int var;
    snprintf (padded, sizeof padded, "%s", name);
    NC_TRY (w->l->path, nc_inq_varid (w->ncid, variable, &var));
    NC_TRY (w->l->path,
            nc_put_vara_text (w->ncid, var, (size_t[2]){ row, 0 }, (size_t[2]){ 1, NAME + 1 }, padded));
done:
    return status;
}

/* Writes coordinates, names of the axes and volumes. */
static pg_status put_points (writer *w)
{
    pg_status status = PG_OK;
    static const char *const variable[] = { "coordx", "coordy", "coordz" }, *const axis[] = { "x", "y", "z" };
    for (size_t a = 0; a < (size_t) w->dim; a++) {
        for (size_t i = 0; i < w->n; i++) w->work[i] = w->l->cloud->x[i * (size_t) w->dim + a];
        for (size_t i = w->n; i < w->nodes; i++)
            w->work[i] = w->l->line[(i - w->n) / 2].x[(i - w->n) % 2][a];
        PG_TRY (put_doubles (w, variable[a], w->work));
        PG_TRY (put_name (w, "coor_names", a, axis[a]));
    }
    memcpy (w->work, w->l->volume, w->n * sizeof *w->work);
    for (size_t i = w->n; i < w->nodes; i++) w->work[i] = 0;
    PG_TRY (put_doubles (w, "point_volume", w->work));
done:
    return status;
}

/* Writes the block of lines, and that it alone has the variable. */
static pg_status put_lines (writer *w)
{
    pg_status status = PG_OK;
    char name[NAME];
    for (size_t i = 0; i < 2 * w->l->nline; i++) w->node[i] = (int) (w->n + i) + 1;
    snprintf (name, sizeof name, "connect%zu", w->nblock + 1);
    PG_TRY (put_ints (w, name, w->node));
    PG_TRY (put_name (w, "eb_names", w->nblock, EXODUS_CRACKS));
    PG_TRY (put_name (w, "name_elem_var", 0, "exists"));
    for (size_t k = 0; k <= w->nblock; k++) w->node[k] = k == w->nblock;
    PG_TRY (put_ints (w, "elem_var_tab", w->node));
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
        PG_TRY (put_ints (w, name, w->node));
        snprintf (name, sizeof name, "block_%d", w->block[k]);
        PG_TRY (put_name (w, "eb_names", k, name));
    }
    size_t blocks = w->nblock + (w->l->nline > 0);
    if (w->l->nline) PG_TRY (put_lines (w));
    for (size_t k = 0; k < blocks; k++) w->node[k] = 1;
    PG_TRY (put_ints (w, "eb_status", w->node));
    for (size_t k = 0; k < w->nblock; k++) w->node[k] = w->block[k] + 1;
    if (w->l->nline) w->node[w->nblock] = w->block[w->nblock - 1] + 2;
    PG_TRY (put_ints (w, "eb_prop1", w->node));
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
            part_suffix (w->dim, w->l->field[v].components, c, part, sizeof part);
            snprintf (name, sizeof name, "%s%s", w->l->field[v].name, part);
            PG_TRY (put_name (w, "name_nod_var", k, name));
        }
done:
    return status;
}

/* ---- the file ------------------------------------------------------------------------------------------ */
/* Order of ints for qsort. */
static int ascending (const void *a, const void *b)
{
    int p = *(const int *) a, q = *(const int *) b;
    return (p > q) - (p < q);
}

/* Finds the different block numbers of the points, ascending; one block if the cloud has none. */
static pg_status find_blocks (writer *w)
{
    pg_status status = PG_OK;
    PG_ALLOC (w->block, w->n);
    PG_ALLOC (w->node, w->nodes + 1);
    PG_ALLOC (w->work, w->nodes);
    w->nblock = 1;
    if (!w->l->cloud->block) goto done;
    memcpy (w->block, w->l->cloud->block, w->n * sizeof *w->block);
    qsort (w->block, w->n, sizeof *w->block, ascending);
    for (size_t i = 1; i < w->n; i++)
        if (w->block[i] != w->block[w->nblock - 1]) w->block[w->nblock++] = w->block[i];
done:
    return status;
}

/* Creates the file. A variable may have 2^32 - 4 bytes per step with 64-bit offsets, and any
 * number in CDF-5. The file is created by our own function first, which removes links and says
 * why a file cannot be written; netCDF does not always pass on that reason. */
static pg_status open_file (writer *w)
{
    pg_status status = PG_OK;
    int before;
    FILE *probe;                                       /* netCDF does not always tell the system's reason */
    PG_TRY (pg_file_create (&probe, w->l->path));
    fclose (probe);
    NC_TRY (w->l->path,
            nc_create (w->l->path,
                       NC_CLOBBER | (w->nodes > 0xfffffffcu / 8 ? NC_64BIT_DATA : NC_64BIT_OFFSET),
                       &w->ncid));
    w->open = 1;
    NC_TRY (w->l->path, nc_set_fill (w->ncid, NC_NOFILL, &before));
done:
    return status;
}

/* Without fill values (NC_NOFILL) netCDF writes each byte once; every variable is therefore
 * written whole. */
pg_status pg_exodus_layout_write (const exodus_layout *layout)
{
    pg_status status = PG_OK;
    writer w = { .l = layout, .dim = layout->cloud->dim, .n = layout->cloud->n,
                 .nodes = layout->cloud->n + 2 * layout->nline };
    PG_TRY (find_blocks (&w));
    PG_TRY (open_file (&w));
    PG_TRY (define_all (&w));
    PG_TRY (put_points (&w));
    PG_TRY (put_blocks (&w));
    PG_TRY (put_field_names (&w));
    w.open = 0;
    NC_TRY (layout->path, nc_close (w.ncid));
done:
    if (w.open) nc_close (w.ncid);
    pg_free (w.block), pg_free (w.node), pg_free (w.work);
    return status;
}
