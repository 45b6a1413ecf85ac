/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bytes to the disk: all of them or PG_E_FILE with path and reason. */
#ifndef PERIGAL_OUTPUT_DISK_H
#define PERIGAL_OUTPUT_DISK_H
#include "perigal/output.h"

pg_status pg_disk_write (const char *path, int file, const void *data, size_t bytes, long offset);
pg_status pg_disk_cut   (const char *path, int file, long bytes);
/* A file made anew, to write: a file or a symbolic link in its place is removed, so that nothing is written
 * through a link. */
pg_status pg_disk_create (const char *path, int *file);
pg_status pg_disk_sync  (const char *path);               /* of a file or folder, opened by its name */
#endif
