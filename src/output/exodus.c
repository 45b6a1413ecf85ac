/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes result.e: the Exodus II layout in netCDF-4. Every point is a node and a SPHERE element; vals_nod_var<k> (time_step x
 * num_nodes) is one component of one field. Beyond Exodus, read back by exodus_read.c: attributes `field` and `units` of each
 * variable, `point_volume`, and global attributes with spacing, lattice step, thickness and bounding box. */
#include "exodus.h"
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 262144, MAX_COMPONENTS = 64, NAME = 64 };

struct pg_exodus {
    int     ncid, open, dim, time;                     /* time: id of time_whole                                        */
    size_t  n, step, nfield, nvar;                     /* nfield: of the caller; one more when `extra`                  */
    int     extra;                                     /* volume is not a field of the caller: written as one more      */
    char   *path;
    pg_field_view *field;                              /* nfield + 1; values only of the extra one                      */
    int    *var;                                       /* id of each component of each field (nvar)                     */
    double *volume, *buffer;                           /* n                                                             */
};

/* "_x", "_xy", "_7": what Exodus readers group into vectors and tensors (Voigt order). */
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

static int put_text (int ncid, int var, const char *name, const char *text)
{
    return nc_put_att_text (ncid, var, name, strlen (text), text);
}

static int put_numbers (int ncid, const char *name, size_t n, const double *value)
{
    return nc_put_att_double (ncid, NC_GLOBAL, name, NC_DOUBLE, n, value);
}

static pg_status define_globals (pg_exodus *f, const pg_cloud *cloud, const char *title)
{
    pg_status status = PG_OK;
    float version = 8.03f;
    int word = 8, large = 1, wide = 0, longest = NAME;
    NC_TRY (f->path, nc_put_att_float (f->ncid, NC_GLOBAL, "api_version", NC_FLOAT, 1, &version));
    NC_TRY (f->path, nc_put_att_float (f->ncid, NC_GLOBAL, "version", NC_FLOAT, 1, &version));
    NC_TRY (f->path, nc_put_att_int (f->ncid, NC_GLOBAL, "floating_point_word_size", NC_INT, 1, &word));
    NC_TRY (f->path, nc_put_att_int (f->ncid, NC_GLOBAL, "file_size", NC_INT, 1, &large));
    NC_TRY (f->path, nc_put_att_int (f->ncid, NC_GLOBAL, "int64_status", NC_INT, 1, &wide));
    NC_TRY (f->path, nc_put_att_int (f->ncid, NC_GLOBAL, "maximum_name_length", NC_INT, 1, &longest));
    NC_TRY (f->path, put_text (f->ncid, NC_GLOBAL, "title", title ? title : ""));
    NC_TRY (f->path, put_text (f->ncid, NC_GLOBAL, "perigal_version", PG_VERSION));
    NC_TRY (f->path, put_numbers (f->ncid, "spacing", 1, &cloud->h));
    NC_TRY (f->path, put_numbers (f->ncid, "lattice_step", 3, cloud->step));
    NC_TRY (f->path, put_numbers (f->ncid, "thickness", 1, &cloud->thickness));
    NC_TRY (f->path, put_numbers (f->ncid, "box_low", 3, cloud->low));
    NC_TRY (f->path, put_numbers (f->ncid, "box_high", 3, cloud->high));
done:
    return status;
}

/* Names as rows of a char array, padded with zeros. */
static pg_status put_names (pg_exodus *f, const char *variable, int row_dim, int name_dim, size_t n, const char *names /* n x NAME+1 */)
{
    pg_status status = PG_OK;
    int var, dims[2] = { row_dim, name_dim };
    NC_TRY (f->path, nc_def_var (f->ncid, variable, NC_CHAR, 2, dims, &var));
    NC_TRY (f->path, nc_put_vara_text (f->ncid, var, (size_t[2]) { 0, 0 }, (size_t[2]) { n, NAME + 1 }, names));
done:
    return status;
}

static pg_status write_points (pg_exodus *f, const pg_cloud *cloud, int nodes, int name_dim)
{
    pg_status status = PG_OK;
    static const char *const variable[] = { "coordx", "coordy", "coordz" };
    char names[3][NAME + 1] = { "x", "y", "z" };
    int dim, var;
    NC_TRY (f->path, nc_def_dim (f->ncid, "num_dim", (size_t) f->dim, &dim));
    for (int a = 0; a < f->dim; a++) {
        NC_TRY (f->path, nc_def_var (f->ncid, variable[a], NC_DOUBLE, 1, &nodes, &var));
        for (size_t i = 0; i < f->n; i++) f->buffer[i] = cloud->x[i * (size_t) f->dim + (size_t) a];
        NC_TRY (f->path, nc_put_var_double (f->ncid, var, f->buffer));
    }
    PG_TRY (put_names (f, "coor_names", dim, name_dim, (size_t) f->dim, names[0]));
    NC_TRY (f->path, nc_def_var (f->ncid, "point_volume", NC_DOUBLE, 1, &nodes, &var));
    NC_TRY (f->path, put_text (f->ncid, var, "units", "m3"));
    NC_TRY (f->path, nc_put_var_double (f->ncid, var, f->volume));
done:
    return status;
}

static int ascending (const void *a, const void *b)
{
    int p = *(const int *) a, q = *(const int *) b;
    return (p > q) - (p < q);
}

/* One block of spheres: connect<k> (elements x 1) lists the nodes, counted from 1. */
static pg_status write_block (pg_exodus *f, const pg_cloud *cloud, int k, int value, int *node)
{
    pg_status status = PG_OK;
    char name[NAME];
    size_t m = 0;
    int dims[2], var;
    for (size_t i = 0; i < f->n; i++) if (!cloud->block || cloud->block[i] == value) node[m++] = (int) i + 1;
    snprintf (name, sizeof name, "num_el_in_blk%d", k + 1);
    NC_TRY (f->path, nc_def_dim (f->ncid, name, m, &dims[0]));
    snprintf (name, sizeof name, "num_nod_per_el%d", k + 1);
    NC_TRY (f->path, nc_def_dim (f->ncid, name, 1, &dims[1]));
    snprintf (name, sizeof name, "connect%d", k + 1);
    NC_TRY (f->path, nc_def_var (f->ncid, name, NC_INT, 2, dims, &var));
    NC_TRY (f->path, put_text (f->ncid, var, "elem_type", "SPHERE"));
    NC_TRY (f->path, nc_put_var_int (f->ncid, var, node));
done:
    return status;
}

/* Blocks are numbered from 1 in Exodus: eb_prop1 = cloud->block + 1. */
static pg_status write_blocks (pg_exodus *f, const pg_cloud *cloud, int name_dim)
{
    pg_status status = PG_OK;
    int *work = NULL, *value = NULL, dim, var;
    char *names = NULL;
    size_t m = 1;
    PG_ALLOC (work, f->n);
    PG_ALLOC (value, f->n);
    if (cloud->block) {
        memcpy (value, cloud->block, f->n * sizeof *value);
        qsort (value, f->n, sizeof *value, ascending);
        for (size_t i = 1; i < f->n; i++) if (value[i] != value[m - 1]) value[m++] = value[i];
    }
    NC_TRY (f->path, nc_def_dim (f->ncid, "num_el_blk", m, &dim));
    for (size_t k = 0; k < m; k++) PG_TRY (write_block (f, cloud, (int) k, value[k], work));
    PG_ALLOC (names, m * (NAME + 1));
    for (size_t k = 0; k < m; k++) {
        snprintf (names + k * (NAME + 1), NAME + 1, "block_%d", value[k]);
        value[k]++;
        work[k] = 1;
    }
    NC_TRY (f->path, nc_def_var (f->ncid, "eb_status", NC_INT, 1, &dim, &var));
    NC_TRY (f->path, nc_put_var_int (f->ncid, var, work));
    NC_TRY (f->path, nc_def_var (f->ncid, "eb_prop1", NC_INT, 1, &dim, &var));
    NC_TRY (f->path, put_text (f->ncid, var, "name", "ID"));
    NC_TRY (f->path, nc_put_var_int (f->ncid, var, value));
    PG_TRY (put_names (f, "eb_names", dim, name_dim, m, names));
done:
    pg_free (names);
    pg_free (value);
    pg_free (work);
    return status;
}

static pg_status define_variable (pg_exodus *f, const pg_field_view *view, const int dims[2], size_t k)
{
    pg_status status = PG_OK;
    char name[NAME];
    snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
    NC_TRY (f->path, nc_def_var (f->ncid, name, NC_DOUBLE, 2, dims, &f->var[k]));
    NC_TRY (f->path, nc_def_var_chunking (f->ncid, f->var[k], NC_CHUNKED, (size_t[2]) { 1, f->n < CHUNK ? f->n : CHUNK }));
    NC_TRY (f->path, nc_def_var_deflate (f->ncid, f->var[k], 1, 1, 1));
    NC_TRY (f->path, put_text (f->ncid, f->var[k], "field", view->name));
    NC_TRY (f->path, put_text (f->ncid, f->var[k], "units", view->unit));
done:
    return status;
}

static pg_status define_fields (pg_exodus *f, int steps, int nodes, int name_dim)
{
    pg_status status = PG_OK;
    char *names = NULL, part[16];
    size_t k = 0;
    int dim;
    PG_ALLOC (names, f->nvar * (NAME + 1));
    NC_TRY (f->path, nc_def_dim (f->ncid, "num_nod_var", f->nvar, &dim));
    for (size_t v = 0; v < f->nfield + (size_t) f->extra; v++)
        for (int c = 0; c < f->field[v].components; c++, k++) {
            part_suffix (f->dim, f->field[v].components, c, part, sizeof part);
            snprintf (names + k * (NAME + 1), NAME + 1, "%s%s", f->field[v].name, part);
            PG_TRY (define_variable (f, &f->field[v], (int[2]) { steps, nodes }, k));
        }
    PG_TRY (put_names (f, "name_nod_var", dim, name_dim, f->nvar, names));
done:
    pg_free (names);
    return status;
}

static pg_status write_header (pg_exodus *f, const pg_cloud *cloud, const char *title)
{
    pg_status status = PG_OK;
    int steps, nodes, name_dim, unused;
    PG_TRY (define_globals (f, cloud, title));
    NC_TRY (f->path, nc_def_dim (f->ncid, "len_string", 33, &unused));
    NC_TRY (f->path, nc_def_dim (f->ncid, "len_line", 81, &unused));
    NC_TRY (f->path, nc_def_dim (f->ncid, "four", 4, &unused));
    NC_TRY (f->path, nc_def_dim (f->ncid, "len_name", NAME + 1, &name_dim));
    NC_TRY (f->path, nc_def_dim (f->ncid, "time_step", NC_UNLIMITED, &steps));
    NC_TRY (f->path, nc_def_dim (f->ncid, "num_nodes", f->n, &nodes));
    NC_TRY (f->path, nc_def_dim (f->ncid, "num_elem", f->n, &unused));
    NC_TRY (f->path, nc_def_var (f->ncid, "time_whole", NC_DOUBLE, 1, &steps, &f->time));
    PG_TRY (write_points (f, cloud, nodes, name_dim));
    PG_TRY (write_blocks (f, cloud, name_dim));
    PG_TRY (define_fields (f, steps, nodes, name_dim));
    NC_TRY (f->path, nc_sync (f->ncid));
done:
    return status;
}

/* netCDF hides the system's reason behind "HDF error": ask the system first. */
static pg_status open_file (pg_exodus *f)
{
    pg_status status = PG_OK;
    errno = 0;
    FILE *probe = fopen (f->path, "wb");
    if (!probe) PG_FAIL (PG_E_FILE, "%s: %s", f->path, strerror (errno));
    fclose (probe);
    /* HDF5 would lock the file against the readers who watch a run; the user's own setting goes first */
    setenv ("HDF5_USE_FILE_LOCKING", "FALSE", 0);
    NC_TRY (f->path, nc_create (f->path, NC_NETCDF4 | NC_CLOBBER, &f->ncid));
    f->open = 1;
    int before;
    NC_TRY (f->path, nc_set_fill (f->ncid, NC_NOFILL, &before));
done:
    return status;
}

static pg_status check_request (const char *path, const pg_cloud *cloud, size_t nfield, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    if (cloud->n == 0 || cloud->n >= 0x7fffffff) PG_FAIL (PG_E_USAGE, "%s: %zu points", path, cloud->n);
    if (cloud->dim < 1 || cloud->dim > 3) PG_FAIL (PG_E_USAGE, "%s: dimension %d", path, cloud->dim);
    for (size_t v = 0; v < nfield; v++) {
        if (fields[v].components < 1 || fields[v].components > MAX_COMPONENTS || !fields[v].name[0])
            PG_FAIL (PG_E_USAGE, "%s: field '%.31s' has %d components", path, fields[v].name, fields[v].components);
        for (size_t w = 0; w < v; w++)
            if (strcmp (fields[v].name, fields[w].name) == 0) PG_FAIL (PG_E_USAGE, "%s: two fields '%.31s'", path, fields[v].name);
    }
done:
    return status;
}

static pg_status copy_request (pg_exodus *f, const pg_cloud *cloud, size_t nfield, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    PG_ALLOC (f->field, nfield + 1);
    PG_ALLOC (f->volume, f->n);
    PG_ALLOC (f->buffer, f->n);
    if (cloud->volume) memcpy (f->volume, cloud->volume, f->n * sizeof (double));
    f->nfield = nfield;
    f->extra = 1;
    for (size_t v = 0; v < nfield; v++) {
        f->field[v] = fields[v];
        f->field[v].value = NULL;
        f->nvar += (size_t) fields[v].components;
        if (strcmp (fields[v].name, "volume") == 0) f->extra = 0;
    }
    f->field[nfield] = (pg_field_view) { "volume", "m3", 1, f->volume };
    f->nvar += (size_t) f->extra;
    PG_ALLOC (f->var, f->nvar);
done:
    return status;
}

pg_status pg_exodus_create (pg_exodus **out, const char *path, const pg_cloud *cloud, const char *title,
                            size_t nfield, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    pg_exodus *f = NULL;
    *out = NULL;
    PG_TRY (check_request (path, cloud, nfield, fields));
    PG_ALLOC (f, 1);
    f->path = pg_strdup (path);
    if (!f->path) PG_FAIL (PG_E_MEMORY, "no memory for a path");
    f->dim = cloud->dim;
    f->n = cloud->n;
    PG_TRY (copy_request (f, cloud, nfield, fields));
    PG_TRY (open_file (f));
    PG_TRY (write_header (f, cloud, title));
    *out = f;
done:
    if (status != PG_OK) {
        int started = f && f->open;
        pg_exodus_close (&f);
        if (started) remove (path);
    }
    return status;
}

static pg_status write_view (pg_exodus *f, const pg_field_view *view, const int *var)
{
    pg_status status = PG_OK;
    size_t start[2] = { f->step, 0 }, count[2] = { 1, f->n }, m = (size_t) view->components;
    for (size_t c = 0; c < m; c++) {
        for (size_t i = 0; i < f->n; i++) f->buffer[i] = view->value[i * m + c];
        NC_TRY (f->path, nc_put_vara_double (f->ncid, var[c], start, count, f->buffer));
    }
done:
    return status;
}

pg_status pg_exodus_write (pg_exodus *f, double time, const pg_field_view *fields)
{
    pg_status status = PG_OK;
    const int *var = f->var;
    for (size_t v = 0; v < f->nfield; v++)
        if (strcmp (fields[v].name, f->field[v].name) != 0 || fields[v].components != f->field[v].components || !fields[v].value)
            PG_FAIL (PG_E_USAGE, "%s: field %zu is '%s' with %d values a point, expected '%s' with %d", f->path, v + 1,
                     fields[v].name, fields[v].value ? fields[v].components : 0, f->field[v].name, f->field[v].components);
    for (size_t v = 0; v < f->nfield; var += f->field[v].components, v++) PG_TRY (write_view (f, &fields[v], var));
    if (f->extra) PG_TRY (write_view (f, &f->field[f->nfield], var));
    NC_TRY (f->path, nc_put_var1_double (f->ncid, f->time, &f->step, &time));
    NC_TRY (f->path, nc_sync (f->ncid));
    f->step++;
done:
    return status;
}

void pg_exodus_close (pg_exodus **file)
{
    if (!file || !*file) return;
    pg_exodus *f = *file;
    if (f->open) nc_close (f->ncid);
    pg_free (f->buffer);
    pg_free (f->volume);
    pg_free (f->var);
    pg_free (f->field);
    pg_free (f->path);
    pg_free (f);
    *file = NULL;
}
