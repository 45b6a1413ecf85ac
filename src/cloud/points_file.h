/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: points with volumes from a CSV file. */
#ifndef PERIGAL_CLOUD_POINTS_FILE_H
#define PERIGAL_CLOUD_POINTS_FILE_H
#include "perigal/cloud.h"

/* Fills x, volume, block, size and n of a cloud whose dim is set. What is wrong with the file is a fault of
 * the scene under `points`, with file and line. */
pg_status pg_points_read  (pg_cloud *cloud, const pg_scene *scene);
/* The same from memory, `text` of `size` bytes in place of the content of the file. */
pg_status pg_points_parse (pg_cloud *cloud, const pg_scene *scene, const char *text, size_t size);
#endif
