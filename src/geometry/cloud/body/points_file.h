/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: points with volumes from a CSV file. */
#ifndef PERIGAL_CLOUD_POINTS_FILE_H
#define PERIGAL_CLOUD_POINTS_FILE_H
#include "perigal/cloud.h"

/* Fills x, volume, block, size and n of a cloud whose dim is set. What is wrong with the file is a fault of
 * the scene under `points`, with file and line. */
pg_status pg_points_read  (pg_cloud *cloud, const pg_scene *scene);
/* Only the places (x, n), from the file that this key of the scene names. Volumes may be missing, other
 * columns are passed over, and points may be there twice. */
pg_status pg_points_places (pg_cloud *cloud, const pg_scene *scene, const char *key);
/* pg_points_read from memory, `text` of `size` bytes in place of the content of the file. */
pg_status pg_points_parse (pg_cloud *cloud, const pg_scene *scene, const char *text, size_t size);
#endif
