/* SPDX-License-Identifier: GPL-3.0-or-later
 * element.h: what the files of this folder need of elements beyond perigal/mesh.h. */
#ifndef MESH_ELEMENT_H
#define MESH_ELEMENT_H
#include "perigal/mesh.h"

/* Node k of the element turned outside out is node element_mirror (kind)[k] of the one inside out (an
 * involution). */
const signed char *element_mirror (pg_element kind);
void element_centre (pg_element kind, double *xi);
/* Corners of face f (numbers within the element), at most 4; returns how many. */
int  element_face_corners (pg_element kind, int f, int node[4]);
/* Nodes at the corners of face f of element e of a mesh, ascending, then -1. */
void mesh_face_key (const pg_mesh *mesh, size_t e, int f, int key[4]);
#endif
