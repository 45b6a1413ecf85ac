/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of this folder need of elements beyond perigal/mesh.h. */
#ifndef MESH_ELEMENT_H
#define MESH_ELEMENT_H
#include "perigal/mesh.h"

/* Node k of the mirrored element is node element_mirror (kind)[k] of the original one; applied twice it is
 * the identity. */
const signed char *element_mirror (pg_element kind);
/* Writes the mean xi of the corners of the reference element. */
void element_centre (pg_element kind, double *xi);
/* Corners of face f, as numbers within the element, at most 4; returns how many. */
int  element_face_corners (pg_element kind, int f, int node[4]);
/* Nodes at the corners of face f of element e, ascending, then -1: equal for equal faces. */
void mesh_face_key (const pg_mesh *mesh, size_t e, int f, int key[4]);
#endif
