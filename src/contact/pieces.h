/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: division of cracks into pieces for contact. Files: pieces.c (2D paths, rows of all pieces),
 * surface_pieces.c (3D surfaces), broken_pieces.c (faces of bonds that broke one by one), gather_dots.c
 * (clustering of surface points into pieces). */
#ifndef PG_CONTACT_PIECES_H
#define PG_CONTACT_PIECES_H
#include "perigal/contact.h"
#include "perigal/vector.h"

/* Number of pieces of about the size `full` into which `size` is divided, rounded (half down), at least 1.
 * Both in local spacings, or in their squares. */
size_t pieces_of (const pg_cloud *cloud, double size, double full);

/* Makes the pieces of 3D cracks; `out` must be empty, with first[0] allocated. */
pg_status surface_pieces_create (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);

/* A sampling point of a surface: position, m, unit normal; area, m^2; size: its area in local spacings (2D:
 * length; 3D: squared); h: local spacing, m; cell of the raster; piece. triangle: index of its grown triangle
 * until it is assigned to a piece, else SIZE_MAX. 2D: third components are 0. */
typedef struct {
    double x[3], normal[3], area, size, h;
    size_t row, column, piece, triangle;
} dot;
/* Least size of a piece over that of a usual one. */
#define DOTS_LEAST 0.35
/* Clusters n dots into at most *count pieces (updated); full: size of a usual piece. */
pg_status gather_dots (dot *d, size_t n, double full, size_t *count);

/* Computes two unit tangents out[0..2], out[3..5] normal to n: the projection of `along`, and n x that. along
 * NULL: the coordinate axis nearest to the plane. */
void piece_tangents (const double *n, const double *along, double *out);

#endif
