/* SPDX-License-Identifier: GPL-3.0-or-later
 * Files of netCDF-4 by the netCDF library, which is loaded here and nowhere else (base/library.c): with HDF5
 * and what that needs it is forty libraries, and most runs meet no such file. What the library knows about
 * dimensions, variables and attributes of the root group is copied, so that names are looked up as in classic
 * files. */
#include "file.h"
#include <netcdf.h>
#include <netcdf_mem.h>
#include <stddef.h>
#include <string.h>

/* The library functions in use, as X (name); `call` holds a pointer to each, of the type in netcdf.h. */
#define CALLS(X) \
    X (nc_open_mem) X (nc_close) X (nc_strerror) X (nc_inq) X (nc_inq_dim) X (nc_inq_var) X (nc_inq_attname) \
    X (nc_inq_att) X (nc_get_vara_double) X (nc_get_vara_long) X (nc_get_vara_text) X (nc_get_att_text) \
    X (nc_get_att_double)
static struct {
#define X(name) __typeof__ (name) *name;
    CALLS (X)
#undef X
} call;

static pg_status load (void)
{
    static const pg_library_function function[] = {
#define X(name) { #name, offsetof (__typeof__ (call), name) },
        CALLS (X)
#undef X
    };
    static pg_library netcdf = { PG_NETCDF_FILE, "libnetcdf19", "files of netCDF-4",
                                 sizeof function / sizeof *function, function, &call, 0, 0 };
    return pg_library_load (&netcdf);
}

/* PG_FAIL with the library's error message if the library call `what` returns an error code. */
#define NC_TRY(f, what) \
    do { \
        int rc_ = (what); \
        if (rc_ != NC_NOERR) \
            PG_FAIL (rc_ == NC_ENOMEM ? PG_E_MEMORY : PG_E_FILE, "%.400s: %s", (f)->path, \
                     call.nc_strerror (rc_)); \
    } while (0)

/* Lists the n attributes of a variable (-1: of the file), without those of types that classic files lack. */
static pg_status list_attributes (pg_netcdf *f, int variable, int n)
{
    pg_status status = PG_OK;
    for (int k = 0; k < n; k++) {
        nc_type type;
        int of = variable < 0 ? NC_GLOBAL : variable;
        PG_GROW (f->att, f->att_room, f->natt + 1);
        nc_attribute *a = &f->att[f->natt];
        NC_TRY (f, call.nc_inq_attname (f->id, of, k, a->name));
        NC_TRY (f, call.nc_inq_att (f->id, of, a->name, &type, &a->n));
        a->variable = variable, a->type = type;
        if (nc_size_of (type)) f->natt++;
    }
done:
    return status;
}

/* Lists variable k; its index in f->var is its number in the library. */
static pg_status list_variable (pg_netcdf *f, int k)
{
    pg_status status = PG_OK;
    int ndim, natt, dim[NC_MAX_VAR_DIMS];
    nc_type type;
    nc_variable *v = &f->var[k];
    NC_TRY (f, call.nc_inq_var (f->id, k, v->about.name, &type, &ndim, dim, &natt));
    v->about.type = type, v->about.ndim = (size_t) ndim, v->about.n = 1;
    for (int d = 0; d < ndim; d++) {
        if (dim[d] < 0 || (size_t) dim[d] >= f->ndim)
            PG_FAIL (PG_E_FILE, "%.400s: '%s' has a dimension of another group", f->path, v->about.name);
        size_t length = f->dim[dim[d]].length;
        if (d == 0) v->about.first = length;
        v->about.last = length;
        if (length > 0 && v->about.n > ((size_t) 1 << 48) / length)
            PG_FAIL (PG_E_FILE, "%.400s: '%s' is too large", f->path, v->about.name);
        v->about.n *= length;
    }
    PG_TRY (list_attributes (f, k, natt));
done:
    return status;
}

pg_status nc_library_open (pg_netcdf *f)
{
    pg_status status = PG_OK;
    int ndim, nvar, natt, unlimited;
    PG_TRY (load ());
    /* the cast removes const: the library takes a non-const pointer but does not change the bytes */
    int rc = call.nc_open_mem (f->path, NC_NOWRITE, f->size, (void *) (uintptr_t) f->bytes, &f->id);
    if (rc != NC_NOERR) f->id = -1;
    NC_TRY (f, rc);
    NC_TRY (f, call.nc_inq (f->id, &ndim, &nvar, &natt, &unlimited));
    PG_ALLOC (f->dim, (size_t) ndim);
    PG_ALLOC (f->var, (size_t) nvar);
    for (int k = 0; k < ndim; k++) {
        f->ndim = (size_t) k + 1;
        NC_TRY (f, call.nc_inq_dim (f->id, k, f->dim[k].name, &f->dim[k].length));
    }
    PG_TRY (list_attributes (f, -1, natt));
    for (int k = 0; k < nvar; k++) {
        f->nvar = (size_t) k + 1;
        PG_TRY (list_variable (f, k));
    }
done:
    return status;
}

void nc_library_close (pg_netcdf *f) { call.nc_close (f->id); }

/* Converts values first .. first + n - 1 to the start index and count along each dimension that the library
 * takes. The range must be all values or lie in one row along the last dimension; returns 0 otherwise. */
static int range (const nc_variable *v, const pg_netcdf *f, int variable, size_t first, size_t n,
                  size_t *start, size_t *count)
{
    int dim[NC_MAX_VAR_DIMS], ndim = (int) v->about.ndim, part = n < v->about.n;
    if (call.nc_inq_var (f->id, variable, NULL, NULL, NULL, dim, NULL) != NC_NOERR) return 0;
    if (part && ndim > 0 && first % v->about.last + n > v->about.last) return 0;
    for (int d = ndim - 1; d >= 0; d--) {
        size_t length = f->dim[dim[d]].length;
        start[d] = part ? first % length : 0;
        count[d] = !part ? length : d == ndim - 1 ? n : 1;
        if (part) first /= length;
    }
    return 1;
}

/* Body of a function that reads n values of a variable from value `first` on, by a library function. */
#define READ(function) \
    pg_status status = PG_OK; \
    size_t start[NC_MAX_VAR_DIMS] = { 0 }, count[NC_MAX_VAR_DIMS] = { 0 }; \
    const nc_variable *v = &f->var[variable]; \
    if (n == 0) goto done; \
    if (!range (v, f, variable, first, n, start, count)) \
        PG_FAIL (PG_E_FILE, "%.400s: '%s' has rows of %zu values", f->path, v->about.name, v->about.last); \
    NC_TRY (f, call.function (f->id, variable, start, count, value)); \
done: \
    return status

pg_status nc_library_doubles (const pg_netcdf *f, int variable, size_t first, size_t n, double *value)
{
    READ (nc_get_vara_double);
}

pg_status nc_library_longs (const pg_netcdf *f, int variable, size_t first, size_t n, long *value)
{
    READ (nc_get_vara_long);
}

pg_status nc_library_chars (const pg_netcdf *f, int variable, size_t first, size_t n, char *value)
{
    READ (nc_get_vara_text);
}

/* Number of the variable as the library wants it in a call for an attribute. */
static int owner (const nc_attribute *a) { return a->variable < 0 ? NC_GLOBAL : a->variable; }

int nc_library_text (const pg_netcdf *f, const nc_attribute *a, char *text)
{
    return call.nc_get_att_text (f->id, owner (a), a->name, text) == NC_NOERR;
}

int nc_library_numbers (const pg_netcdf *f, const nc_attribute *a, double *value)
{
    return call.nc_get_att_double (f->id, owner (a), a->name, value) == NC_NOERR;
}
