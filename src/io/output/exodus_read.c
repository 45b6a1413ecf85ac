/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads result.e back: points with volumes and blocks (nodes of crack faces, which follow the points, are
 * left out), and fields, whose components are grouped by the attribute `field` of vals_nod_var<k>. Files of
 * other programs do not have that attribute; there every variable is a field with one component.
 *
 * Each function opens and closes the file: they are called a few times per run of a program,
 * and no state is left between calls. */
#include "exodus.h"
#include "perigal/netcdf.h"
#include <stdio.h>
#include <string.h>

enum { NAME = 32 };

/* One component of a field: name of the field, its unit, the netCDF variable. */
typedef struct { char base[NAME], unit[16]; int var; } part;
/* A file that is open for reading, with all its components. */
typedef struct {
    const char *path;
    pg_netcdf  *file;
    size_t  n, nstep, npart;
    part   *part;
} reader;

/* Number of points: attribute `points` of the file, as the nodes of crack faces follow the points; all nodes
 * where the file has no such attribute. */
static size_t points_of (const pg_netcdf *file)
{
    size_t n = pg_netcdf_length (file, "num_nodes");
    double points;
    if (pg_netcdf_numbers (file, -1, "points", 1, &points) && points > 0 && points < (double) n)
        return (size_t) points;
    return n;
}

/* The variable of that name, which a file of results must have. */
static pg_status must_find (const reader *r, const char *name, int *variable)
{
    *variable = pg_netcdf_find (r->file, name);
    return *variable >= 0 ? PG_OK
                          : pg_error (PG_E_FILE, PG_HERE, "%s: no '%s': not a whole result", r->path, name);
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
    PG_TRY (must_find (r, name, &p->var));
    if (!pg_netcdf_text (r->file, p->var, "units", p->unit, sizeof p->unit)) p->unit[0] = 0;
    if (pg_netcdf_text (r->file, p->var, "field", p->base, sizeof p->base)) goto done;
    PG_TRY (must_find (r, "name_nod_var", &names));
    PG_TRY (pg_netcdf_chars (r->file, names, k * width, width, row));
    row[width] = 0;
    for (size_t m = strlen (row); m > 0 && row[m - 1] == ' '; m--) row[m - 1] = 0;
    snprintf (p->base, sizeof p->base, "%.31s", row);
done:
    return status;
}

/* May be called for a file that never opened. */
static void reader_close (reader *r)
{
    pg_netcdf_close (&r->file);
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
    PG_TRY (pg_netcdf_open (&r->file, path));
    r->n = points_of (r->file);
    r->nstep = pg_netcdf_length (r->file, "time_step");
    r->npart = pg_netcdf_length (r->file, "num_nod_var");
    if (r->n == 0) PG_FAIL (PG_E_FILE, "%s: no points: not a result file", path);
    size_t width = pg_netcdf_length (r->file, "len_name");
    if (width == 0) width = pg_netcdf_length (r->file, "len_string");
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
 * of the file, and the nearest one. The loop runs from the last component to the first, so that *first is the
 * first one in the end. */
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
    size_t m = (size_t) *components, at = step < 0 ? r.nstep - 1 : (size_t) step,
           nodes = pg_netcdf_length (r.file, "num_nodes");
    PG_ALLOC (all, r.n * m);
    PG_ALLOC (one, r.n);
    for (size_t k = first; k < r.npart; k++) {
        if (strcmp (r.part[k].base, field) != 0) continue;
        PG_TRY (pg_netcdf_doubles (r.file, r.part[k].var, at * nodes, r.n, one));
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
        PG_TRY (must_find (r, name[a], &var));
        PG_TRY (pg_netcdf_doubles (r->file, var, 0, r->n, work));
        cloud->low[a] = cloud->high[a] = work[0];
        for (size_t i = 0; i < r->n; i++) {
            cloud->x[i * dim + a] = work[i];
            if (work[i] < cloud->low[a]) cloud->low[a] = work[i];
            if (work[i] > cloud->high[a]) cloud->high[a] = work[i];
        }
    }
    pg_netcdf_numbers (r->file, -1, "box_low", 3, cloud->low);
    pg_netcdf_numbers (r->file, -1, "box_high", 3, cloud->high);
    pg_netcdf_numbers (r->file, -1, "lattice_step", 3, cloud->step);
    pg_netcdf_numbers (r->file, -1, "spacing", 1, &cloud->h);
    pg_netcdf_numbers (r->file, -1, "thickness", 1, &cloud->thickness);
    var = pg_netcdf_find (r->file, "point_volume");
    if (var >= 0) PG_TRY (pg_netcdf_doubles (r->file, var, 0, r->n, cloud->volume));
done:
    return status;
}

/* Reads which block each point belongs to. PG_E_FILE for blocks of other elements than points,
 * and for nodes that do not exist: such numbers would be used as indices. */
static pg_status read_blocks (const reader *r, pg_cloud *cloud)
{
    pg_status status = PG_OK;
    long *id = NULL, *node = NULL;
    int var;
    size_t m = pg_netcdf_length (r->file, "num_el_blk");
    int has_cracks = r->n < pg_netcdf_length (r->file, "num_nodes");
    char name[64], type[NAME];
    PG_ALLOC (id, m);
    PG_ALLOC (node, r->n);
    if (m == 0) goto done;
    PG_TRY (must_find (r, "eb_prop1", &var));
    PG_TRY (pg_netcdf_longs (r->file, var, 0, m, id));
    for (size_t k = 0; k < m; k++) {
        snprintf (name, sizeof name, "connect%zu", k + 1);
        var = pg_netcdf_find (r->file, name);
        if (has_cracks && var >= 0 && pg_netcdf_text (r->file, var, "elem_type", type, sizeof type)
            && (strcmp (type, "BAR2") == 0 || strcmp (type, "TRI3") == 0))
            continue;
        if (var < 0 && pg_netcdf_find (r->file, "el_blk_cnt_global") >= 0) continue; /* no point here */
        snprintf (name, sizeof name, "num_el_in_blk%zu", k + 1);
        size_t count = pg_netcdf_length (r->file, name);
        snprintf (name, sizeof name, "num_nod_per_el%zu", k + 1);
        if (count > r->n || pg_netcdf_length (r->file, name) != 1)
            PG_FAIL (PG_E_FILE, "%s: block %zu is not one of points", r->path, k + 1);
        snprintf (name, sizeof name, "connect%zu", k + 1);
        PG_TRY (must_find (r, name, &var));
        PG_TRY (pg_netcdf_longs (r->file, var, 0, count, node));
        for (size_t i = 0; i < count; i++) {
            if (node[i] < 1 || (size_t) node[i] > r->n)
                PG_FAIL (PG_E_FILE, "%s: block %zu names node %ld", r->path, k + 1, node[i]);
            cloud->block[node[i] - 1] = (int) id[k] - 1;
        }
    }
done:
    pg_free (node);
    pg_free (id);
    return status;
}

/* A file without a thickness (of another program) gets 1 m, the default of 2D models. After a
 * failure the cloud is empty and *time is NULL, so that callers need no clean-up. */
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
    cloud->dim = (int) pg_netcdf_length (r.file, "num_dim");
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
            PG_TRY (must_find (&r, "time_whole", &var));
            PG_TRY (pg_netcdf_doubles (r.file, var, 0, r.nstep, *time));
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
