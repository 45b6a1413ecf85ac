/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: pieces of cracks. Files: pieces.c (paths in the plane, rows of all pieces), surface_pieces.c
 * (surfaces in space), broken_pieces.c (faces of bonds that broke one by one), gather_dots.c (points of a
 * surface gathered to pieces). */
#ifndef PG_CONTACT_PIECES_H
#define PG_CONTACT_PIECES_H
#include "perigal/contact.h"
#include "perigal/vector.h"

/* Into how many pieces of nearly the size `full` what is `size` large is divided, one at least; half a piece
 * more than a whole number, but for rounding, is no piece more. Both in local spacings, or squared ones. */
size_t pieces_of (const pg_cloud *cloud, double size, double full);

/* The pieces of surfaces; `out` is empty, first[0] has its room. */
pg_status surface_pieces_create (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);

/* A point of a surface: where, normal; m^2; the same in local spacings, squared in space; local spacing, m;
 * its cell of the raster; the piece that it is in. triangle: of a grown one, until it is taken for a piece,
 * else SIZE_MAX. In the plane third components are 0. */
typedef struct {
    double x[3], normal[3], area, size, h;
    size_t row, column, piece, triangle;
} dot;
/* The least piece, of that of a usual one. */
#define DOTS_LEAST 0.35
/* n dots in *count pieces or fewer, `full` being the size of a usual piece: each is asked for with about as
 * many as it has room for. */
pg_status gather_dots (dot *d, size_t n, double full, size_t *count);

/* Two tangents at right angles to the normal n: the part of `along` in its plane, and what is across. NULL:
 * along the axis that lies most in that plane. */
void piece_tangents (const double *n, const double *along, double *out);

#endif
