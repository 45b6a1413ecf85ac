/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the writer and the reader of result.e share: one error form for netCDF calls. */
#ifndef PERIGAL_OUTPUT_EXODUS_H
#define PERIGAL_OUTPUT_EXODUS_H
#include "perigal/output.h"
#include <netcdf.h>

/* netCDF gives negative codes of its own and positive ones of the system; nc_strerror knows both. */
#define NC_TRY(path, call) do { int rc_ = (call); if (rc_ != NC_NOERR) PG_FAIL (rc_ == NC_ENOMEM ? PG_E_MEMORY : PG_E_FILE, \
    "%s: %s", (path), nc_strerror (rc_)); } while (0)
#endif
