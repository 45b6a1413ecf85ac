/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the files of result.e and checkpoint.nc share: one error form for netCDF calls, the header. */
#ifndef PERIGAL_OUTPUT_EXODUS_H
#define PERIGAL_OUTPUT_EXODUS_H
#include "perigal/output.h"
#include <netcdf.h>

/* netCDF gives negative codes of its own and positive ones of the system; nc_strerror knows both. */
#define NC_TRY(path, call) \
    do { \
        int rc_ = (call); \
        if (rc_ != NC_NOERR) \
            PG_FAIL (rc_ == NC_ENOMEM ? PG_E_MEMORY : PG_E_FILE, "%s: %s", (path), nc_strerror (rc_)); \
    } while (0)

enum { EXODUS_COMPONENTS = 64 };
/* ---- exodus_layout.c: a whole result.e without steps -------------------------------------------------- */
/* Its records: time_whole, then the nvar components of the fields. */
typedef struct {
    const char     *path;
    const pg_cloud *cloud;
    const char     *title;
    size_t          nfield, nvar;
    const pg_field_view *field;
    const double   *volume;                            /* n */
} exodus_layout;
pg_status pg_exodus_layout_write (const exodus_layout *layout);
#endif
