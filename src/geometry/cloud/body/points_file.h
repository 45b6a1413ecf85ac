/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: points with volumes from a CSV file. */
#ifndef PERIGAL_CLOUD_POINTS_FILE_H
#define PERIGAL_CLOUD_POINTS_FILE_H
#include "perigal/cloud.h"

/* Fills x, volume, block, size and n of a cloud whose dim is set. Errors in the file are reported under the
 * key `points`, with file and line. */
pg_status pg_points_read  (pg_cloud *cloud, const pg_scene *scene);
/* Reads only the positions (x, n), from the file that this key of the input file names. Volumes may be
 * missing, other columns are ignored, and points may occur twice. */
pg_status pg_points_places (pg_cloud *cloud, const pg_scene *scene, const char *key);
/* Does what pg_points_read does with `text` of `size` bytes in memory in place of the content of the file. */
pg_status pg_points_parse (pg_cloud *cloud, const pg_scene *scene, const char *text, size_t size);
#endif
