/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: writes bytes to the disk, all of them, or returns PG_E_FILE with the path and the reason. `file`
 * is a file descriptor; `path` only serves the message. */
#ifndef PERIGAL_OUTPUT_DISK_H
#define PERIGAL_OUTPUT_DISK_H
#include "perigal/output.h"

/* Writes `bytes` bytes at that offset, in as many system calls as it takes. After a failure
 * some of them may be there; the caller cuts the file. */
pg_status pg_disk_write (const char *path, int file, const void *data, size_t bytes, long offset);
/* *out becomes PATH.new, to be freed with pg_free: the name under which a file is written before it is
 * renamed to PATH. */
pg_status pg_disk_fresh (char **out, const char *path);
/* Shortens a file to that many bytes. */
pg_status pg_disk_cut   (const char *path, int file, long bytes);
/* Creates a file to be read and written. A regular file or a symbolic link in its place is
 * removed first, so that nothing is written through a link. */
pg_status pg_disk_create (const char *path, int *file);
#endif
