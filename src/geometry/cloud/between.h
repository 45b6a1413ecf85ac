/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the gaps of a body along a straight line segment, by shapes (between_shapes.c) and by the faces of
 * meshes (between_faces.c). A gap is a part of the segment outside the body. */
#ifndef PERIGAL_CLOUD_BETWEEN_H
#define PERIGAL_CLOUD_BETWEEN_H
#include "perigal/cloud.h"

/* The line segment ("way") from x along d (m): the points x + t d for t from 0 to 1. */
typedef struct {
    int    dim;
    double x[3], d[3];
    /* Length of the segment; distance within which a point counts as on a surface, m. */
    double length, near;
} between_way;

/* A gap: the segment is outside from t[0] to t[1], which may be equal (two faces that touch), with the unit
 * normals of the surface there, out of the body; t is -INFINITY or INFINITY where the segment never was, or
 * never comes back, inside. Gaps ascend; full: 1: there were more than room for. */
enum { BETWEEN_GAPS = 24 };
typedef struct { double t[2], normal[2][3]; } between_gap;
typedef struct { int n, full; between_gap gap[BETWEEN_GAPS]; } between_gaps;

/* Appends a gap. */
void between_gaps_add (between_gaps *g, const between_gap *gap);
/* Intersection and union of two lists of gaps. An intersection narrower than `slack` (share of the segment)
 * is no gap, unless the gap of a or b that it comes from was as narrow itself. */
void between_gaps_both (between_gaps *out, const between_gaps *a, const between_gaps *b, double slack);
void between_gaps_any  (between_gaps *out, const between_gaps *a, const between_gaps *b);
/* Complement of a list of gaps: inside and outside exchanged, normals reversed. */
void between_gaps_turn (between_gaps *out, const between_gaps *a);

/* Gaps of one shape that is no mesh: where the segment is outside of the shape, also of a subtracted one. A
 * point on its surface belongs to a shape that is added, and not to one that is subtracted. */
void between_shape (between_gaps *out, const pg_shape *shape, const between_way *way);
/* 1: the shape is convex, so that a segment between any two points in it stays in it. */
int  between_convex (const pg_shape *shape);

/* Faces of meshes: segments or triangles in a tree of boxes. */
typedef struct between_faces between_faces;
/* Tree of the faces of a mesh through which a segment can leave the body and come back. alone 1: without the
 * faces whose planes have all nodes of the surface behind them; 0: all faces, as other shapes may lie there.
 * *out NULL: there are none. */
pg_status between_faces_create (between_faces **out, const pg_mesh *mesh, int alone);
void      between_faces_free   (between_faces **faces);
/* Gaps of the segment; a segment that meets no face has none. */
void      between_faces_gaps   (between_gaps *out, const between_faces *faces, const between_way *way);
/* Can a segment within this box meet a face? Does the point x lie within `near` of a face (m)? */
int       between_faces_near   (const between_faces *faces, const double *low, const double *high);
int       between_faces_touch  (const between_faces *faces, const double *x, double near);
#endif
