/* SPDX-License-Identifier: GPL-3.0-or-later
 * netcdf_header.h: a look at the header of a classic netCDF file before the library netCDF reads it. */
#ifndef MESH_NETCDF_HEADER_H
#define MESH_NETCDF_HEADER_H
#include "mesh_private.h"
/* Walks the header (CDF-1, 2, 5; others are OK): all counts fit into the file, types and dimensions exist.
 * netCDF trusts the counts: a few bytes of a broken file make it take gigabytes. PG_E_FILE names the byte
 * where it is wrong. */
pg_status netcdf_check_header (const mesh_bytes *file);
#endif
