/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of a body from a mesh share. */
#ifndef PERIGAL_CLOUD_MESH_BODY_H
#define PERIGAL_CLOUD_MESH_BODY_H
#include "perigal/cloud.h"

/* Order of the quadrature of volumes: sufficient for curved elements. */
enum { PG_MESH_BODY_ORDER = 4 };
/* Positions of the nodes of element e (nodes x dim), m. */
void pg_mesh_body_nodes (const pg_mesh *mesh, size_t e, double *x);
/* Reads the mesh as pg_mesh_body_read does, from the map at path `at` of the input file: "mesh",
 * "body[0].add.mesh". */
pg_status mesh_body_at (pg_mesh_body *out, const pg_scene *scene, const char *at);
#endif
