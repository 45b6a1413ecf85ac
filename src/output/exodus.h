/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the files behind result.e and checkpoint.nc share: the error messages of netCDF calls,
 * and the layout of result.e that the header and the records of a step have in common. */
#ifndef PERIGAL_OUTPUT_EXODUS_H
#define PERIGAL_OUTPUT_EXODUS_H
#include "perigal/output.h"
#include <netcdf.h>

/* Fails with the message of netCDF for a call that does not return NC_NOERR. Its codes are
 * negative for faults of its own and positive for those of the system; nc_strerror knows both. */
#define NC_TRY(path, call) \
    do { \
        int rc_ = (call); \
        if (rc_ != NC_NOERR) \
            PG_FAIL (rc_ == NC_ENOMEM ? PG_E_MEMORY : PG_E_FILE, "%s: %s", (path), nc_strerror (rc_)); \
    } while (0)

/* Name of the block of lines. */
#define EXODUS_CRACKS "cracks"
/* Largest number of components of a field. */
enum { EXODUS_COMPONENTS = 64 };
/* ---- exodus_layout.c: a whole result.e without steps -------------------------------------------------- */
/* What exodus_layout.c needs for a result.e without steps. The records have time_whole first
 * and then the nvar components of the fields, in this order. */
typedef struct {
    const char     *path;
    const pg_cloud *cloud;
    const char     *title;
    size_t          nfield, nvar;
    const pg_field_view *field;
    /* Volumes of the points (n), m3. */
    const double   *volume;
    /* Lines, two nodes each behind those of the points, as a block of their own; 0: none. The records then
     * end with one number for each line, 1 if it exists. */
    size_t          nline;
    const pg_exodus_line *line;
} exodus_layout;
/* Writes the file to its path, including all that does not change during a run. */
pg_status pg_exodus_layout_write (const exodus_layout *layout);
#endif
