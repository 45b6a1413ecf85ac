/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads result.e back: points with volumes and blocks (nodes of lines, which lie behind them, are left
 * out), and fields, whose components are grouped by the attribute `field` of vals_nod_var<k>. Files of other
 * programs do not have that attribute; there every variable is a field with one component.
 *
 * Headers are checked by pg_netcdf_check_header before netCDF sees them, because netCDF trusts
 * the counts in them and would allocate gigabytes for a few damaged bytes. Each function opens
 * and closes the file: they are called a few times per run of a program, and no state is left
 * between calls. */
#include "exodus.h"
#include "perigal/mesh_files.h"
#include <stdio.h>
#include <string.h>

enum { NAME = 32 };

/* One component of a field: name of the field, its unit, the netCDF variable. */
typedef struct { char base[NAME], unit[16]; int var; } part;
/* A file that is open for reading, with all its components. */
typedef struct {
    const char *path;
    int     ncid, open;
    size_t  n, nstep, npart;
    part   *part;
} reader;

/* Length of a dimension; 0 when there is none: files of other programs lack some, and callers decide
 * whether they can do without. */
static size_t length_of (int ncid, const char *name)
{
    int dim;
    size_t n = 0;
    if (nc_inq_dimid (ncid, name, &dim) != NC_NOERR || nc_inq_dimlen (ncid, dim, &n) != NC_NOERR) return 0;
    return n;
}

/* Number of points: of the nodes those before the ends of lines; all, where the file does not say. */
static size_t points_of (int ncid)
{
    size_t n = length_of (ncid, "num_nodes"), m;
    int points;
    if (nc_inq_attlen (ncid, NC_GLOBAL, "points", &m) == NC_NOERR && m == 1
        && nc_get_att_int (ncid, NC_GLOBAL, "points", &points) == NC_NOERR && points > 0
        && (size_t) points < n)
        return (size_t) points;
    return n;
}

/* Reads a text attribute; 0 if there is none or it does not fit. */
static int text_attribute (int ncid, int var, const char *name, char *text, size_t size)
{
    size_t n;
    if (nc_inq_attlen (ncid, var, name, &n) != NC_NOERR || n >= size
        || nc_get_att_text (ncid, var, name, text) != NC_NOERR)
        return 0;
    text[n] = 0;
    return 1;
}

/* Reads name and unit of component k from its attributes, or else the name from name_nod_var,
 * padded with blanks; row is scratch space of width + 1 bytes. */
static pg_status read_part (reader *r, size_t k, size_t width, char *row)
{
    pg_status status = PG_OK;
    part *p = &r->part[k];
    char name[64];
    int names;
    snprintf (name, sizeof name, "vals_nod_var%zu", k + 1);
    NC_TRY (r->path, nc_inq_varid (r->ncid, name, &p->var));
    if (!text_attribute (r->ncid, p->var, "units", p->unit, sizeof p->unit)) p->unit[0] = 0;
    if (text_attribute (r->ncid, p->var, "field", p->base, sizeof p->base)) goto done;
    NC_TRY (r->path, nc_inq_varid (r->ncid, "name_nod_var", &names));
    NC_TRY (r->path, nc_get_vara_text (r->ncid, names, (size_t[2]) { k, 0 }, (size_t[2]) { 1, width }, row));
    row[width] = 0;
    for (size_t m = strlen (row); m > 0 && row[m - 1] == ' '; m--) row[m - 1] = 0;
    snprintf (p->base, sizeof p->base, "%.31s", row);
done:
    return status;
}

/* May be called for a file that never opened. */
static void reader_close (reader *r)
{
    if (r->open) nc_close (r->ncid);
    pg_free (r->part);
    *r = (reader) { 0 };
}

/* Opens a file and lists its components; on failure it is closed again. PG_E_FILE: not a
 * netCDF file, damaged, or without nodes. Names have the length len_name, in files of older
 * writers len_string. */
static pg_status reader_open (reader *r, const char *path)
{
    pg_status status = PG_OK;
    char *row = NULL;
    *r = (reader) { .path = path };
    PG_TRY (pg_netcdf_check_header (path));
    NC_TRY (path, nc_open (path, NC_NOWRITE, &r->ncid));
    r->open = 1;
    r->n = points_of (r->ncid);
    r->nstep = length_of (r->ncid, "time_step");
    r->npart = length_of (r->ncid, "num_nod_var");
    if (r->n == 0) PG_FAIL (PG_E_FILE, "%s: no points: not a result file", path);
    size_t width = length_of (r->ncid, "len_name");
    if (width == 0) width = length_of (r->ncid, "len_string");
    PG_ALLOC (row, width + 1);
    PG_ALLOC (r->part, r->npart);
    for (size_t k = 0; k < r->npart; k++) PG_TRY (read_part (r, k, width, row));
done:
    pg_free (row);
    if (status != PG_OK) reader_close (r);
    return status;
}

/* 1 if component k is the first one of its field. */
static int is_first (const reader *r, size_t k)
{
    for (size_t j = 0; j < k; j++) if (strcmp (r->part[j].base, r->part[k].base) == 0) return 0;
    return 1;
}

/* The names of the fields as "a|b|c", as many as fit. */
static void list_fields (const reader *r, char *text, size_t size)
{
    size_t used = 0;
    text[0] = 0;
    for (size_t k = 0; k < r->npart; k++)
        if (is_first (r, k) && used + NAME + 1 < size)
            used += (size_t) snprintf (text + used, size - used, "%s%s", used ? "|" : "", r->part[k].base);
}

/* Index of the first component of a field and the number of its components; PG_E_USAGE names the fields
 * that there are, and the nearest one. Counted from the last to the first, so that the first is what is
 * left. */
static pg_status find_field (const reader *r, const char *field, size_t *first, int *components)
{
    pg_status status = PG_OK;
    char all[2048];
    *components = 0;
    for (size_t k = r->npart; k-- > 0; )
        if (strcmp (r->part[k].base, field) == 0) *first = k, ++*components;
    if (*components > 0) goto done;
    list_fields (r, all, sizeof all);
    const char *near = pg_nearest_name (field, all);
    PG_FAIL (PG_E_USAGE, "%s has no field '%s'%s%s%s; it has %s", r->path, field,
             near ? " (did you mean '" : "", near ? near : "", near ? "'?)" : "", all[0] ? all : "none");
done:
    return status;
}

/* The file has one variable per component; the caller gets the components of a point side by
 * side. */
pg_status pg_exodus_read (const char *path, const char *field, int step, size_t *n, int *components,
                          double **value)
{
    pg_status status = PG_OK;
    reader r;
    double *all = NULL, *one = NULL;
    size_t first = 0, c = 0;
    *value = NULL;
    *n = 0;
    PG_TRY (reader_open (&r, path));
    PG_TRY (find_field (&r, field, &first, components));
    if (r.nstep == 0) PG_FAIL (PG_E_USAGE, "%s holds no step yet", path);
    if (step < -1 || (step >= 0 && (size_t) step >= r.nstep))
        PG_FAIL (PG_E_USAGE, "%s has no step %d; its steps are 0 to %zu", path, step, r.nstep - 1);
    size_t m = (size_t) *components, start[2] = { step < 0 ? r.nstep - 1 : (size_t) step, 0 },
           count[2] = { 1, r.n };
    PG_ALLOC (all, r.n * m);
    PG_ALLOC (one, r.n);
    for (size_t k = first; k < r.npart; k++) {
        if (strcmp (r.part[k].base, field) != 0) continue;
        NC_TRY (path, nc_get_vara_double (r.ncid, r.part[k].var, start, count, one));
        for (size_t i = 0; i < r.n; i++) all[i * m + c] = one[i];
        c++;
    }
    *n = r.n;
    *value = all;
    all = NULL;
done:
    pg_free (one);
    pg_free (all);
    reader_close (&r);
    return status;
}

/* Each field is listed once, at its first component. */
pg_status pg_exodus_fields (const char *path, char (**names)[32], size_t *n)
{
    pg_status status = PG_OK;
    reader r;
    *names = NULL;
    *n = 0;
    PG_TRY (reader_open (&r, path));
    PG_ALLOC (*names, r.npart);
    for (size_t k = 0; k < r.npart; k++)
        if (is_first (&r, k)) memcpy ((*names)[(*n)++], r.part[k].base, NAME);
done:
    reader_close (&r);
    return status;
}

/* All components of a field have the unit of the first. */
pg_status pg_exodus_unit (const char *path, const char *field, char unit[16])
{
    pg_status status = PG_OK;
    reader r;
    size_t first = 0;
    int components;
    unit[0] = 0;
    PG_TRY (reader_open (&r, path));
    PG_TRY (find_field (&r, field, &first, &components));
    memcpy (unit, r.part[first].unit, sizeof r.part[first].unit);
done:
    reader_close (&r);
    return status;
}

/* Reads a global attribute of m numbers; leaves the value as it is if there is none or it has
 * another length. */
static void numbers (int ncid, const char *name, size_t m, double *value)
{
    size_t n;
    if (nc_inq_attlen (ncid, NC_GLOBAL, name, &n) == NC_NOERR && n == m)
        nc_get_att_double (ncid, NC_GLOBAL, name, value);
}

/* Reads coordinates, the box, steps, spacing, thickness and volumes, all in m and m^3. Without a box in
 * the file it is that of the points. Whatever else a file of another program lacks stays as the caller
 * set it: 0, and a thickness of 1. */
static pg_status read_places (const reader *r, pg_cloud *cloud, double *work)
{
    pg_status status = PG_OK;
    static const char *const name[] = { "coordx", "coordy", "coordz" };
    int var;
    size_t dim = (size_t) cloud->dim;
    for (size_t a = 0; a < dim; a++) {
        NC_TRY (r->path, nc_inq_varid (r->ncid, name[a], &var));
        NC_TRY (r->path, nc_get_vara_double (r->ncid, var, (size_t[1]) { 0 }, &r->n, work));
        cloud->low[a] = cloud->high[a] = work[0];
        for (size_t i = 0; i < r->n; i++) {
            cloud->x[i * dim + a] = work[i];
            if (work[i] < cloud->low[a]) cloud->low[a] = work[i];
            if (work[i] > cloud->high[a]) cloud->high[a] = work[i];
        }
    }
    numbers (r->ncid, "box_low", 3, cloud->low);
    numbers (r->ncid, "box_high", 3, cloud->high);
    numbers (r->ncid, "lattice_step", 3, cloud->step);
    numbers (r->ncid, "spacing", 1, &cloud->h);
    numbers (r->ncid, "thickness", 1, &cloud->thickness);
    if (nc_inq_varid (r->ncid, "point_volume", &var) == NC_NOERR)
        NC_TRY (r->path, nc_get_vara_double (r->ncid, var, (size_t[1]) { 0 }, &r->n, cloud->volume));
done:
    return status;
}

/* Reads which block each point belongs to. PG_E_FILE for blocks of other elements than points,
 * and for nodes that do not exist: such numbers would be used as indices. */
static pg_status read_blocks (const reader *r, pg_cloud *cloud)
{
    pg_status status = PG_OK;
    int *id = NULL, *node = NULL, var;
    size_t m = length_of (r->ncid, "num_el_blk");
    int has_lines = r->n < length_of (r->ncid, "num_nodes");
    char name[64], type[NAME];
    PG_ALLOC (id, m);
    PG_ALLOC (node, r->n);
    if (m == 0) goto done;
    NC_TRY (r->path, nc_inq_varid (r->ncid, "eb_prop1", &var));
    NC_TRY (r->path, nc_get_var_int (r->ncid, var, id));
    for (size_t k = 0; k < m; k++) {
        snprintf (name, sizeof name, "connect%zu", k + 1);
        if (has_lines && nc_inq_varid (r->ncid, name, &var) == NC_NOERR
            && text_attribute (r->ncid, var, "elem_type", type, sizeof type) && strcmp (type, "BAR2") == 0)
            continue;
        snprintf (name, sizeof name, "num_el_in_blk%zu", k + 1);
        size_t count = length_of (r->ncid, name);
        snprintf (name, sizeof name, "num_nod_per_el%zu", k + 1);
        if (count > r->n || length_of (r->ncid, name) != 1)
            PG_FAIL (PG_E_FILE, "%s: block %zu is not one of points", r->path, k + 1);
        snprintf (name, sizeof name, "connect%zu", k + 1);
        NC_TRY (r->path, nc_inq_varid (r->ncid, name, &var));
        NC_TRY (r->path, nc_get_var_int (r->ncid, var, node));
        for (size_t i = 0; i < count; i++) {
            if (node[i] < 1 || (size_t) node[i] > r->n)
                PG_FAIL (PG_E_FILE, "%s: block %zu names node %d", r->path, k + 1, node[i]);
            cloud->block[node[i] - 1] = id[k] - 1;
        }
    }
done:
    pg_free (node);
    pg_free (id);
    return status;
}

/* The thickness of files of other programs is 1 m, that of plane models that do not say
 * otherwise. After a failure the cloud is empty and *time is NULL, so that callers need no
 * clean-up. */
pg_status pg_exodus_points (const char *path, pg_cloud *cloud, size_t *nstep, double **time)
{
    pg_status status = PG_OK;
    reader r;
    double *work = NULL;
    *cloud = (pg_cloud) { .thickness = 1 };
    if (time) *time = NULL;
    if (nstep) *nstep = 0;
    PG_TRY (reader_open (&r, path));
    cloud->n = r.n;
    cloud->dim = (int) length_of (r.ncid, "num_dim");
    if (cloud->dim < 1 || cloud->dim > 3) PG_FAIL (PG_E_FILE, "%s: %d dimensions", path, cloud->dim);
    PG_ALLOC (cloud->x, r.n * (size_t) cloud->dim);
    PG_ALLOC (cloud->volume, r.n);
    PG_ALLOC (cloud->block, r.n);
    PG_ALLOC (work, r.n);
    PG_TRY (read_places (&r, cloud, work));
    PG_TRY (read_blocks (&r, cloud));
    if (time) {
        int var;
        PG_ALLOC (*time, r.nstep);
        if (r.nstep > 0) {
            NC_TRY (path, nc_inq_varid (r.ncid, "time_whole", &var));
            NC_TRY (path, nc_get_var_double (r.ncid, var, *time));
        }
    }
    if (nstep) *nstep = r.nstep;
done:
    pg_free (work);
    reader_close (&r);
    if (status != PG_OK) {
        pg_free (cloud->x);
        pg_free (cloud->volume);
        pg_free (cloud->block);
        *cloud = (pg_cloud) { 0 };
        if (time) pg_free (*time), *time = NULL;
    }
    return status;
}
