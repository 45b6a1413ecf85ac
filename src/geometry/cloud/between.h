/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the gaps of a body along a straight way, by shapes (between_shapes.c) and by the faces of meshes
 * (between_faces.c). */
#ifndef PERIGAL_CLOUD_BETWEEN_H
#define PERIGAL_CLOUD_BETWEEN_H
#include "perigal/cloud.h"

/* The way from x along d (m), at x + t d for t from 0 to 1. */
typedef struct {
    int    dim;
    double x[3], d[3];
    /* Its length; places so near to a surface lie on it, m. */
    double length, near;
} between_way;

/* Where the way is outside: from t[0] to t[1], which may be equal (two faces that touch), and the unit
 * normals of the surface there, out of the body; t is -INFINITY or INFINITY where the way never was, or
 * never comes back, inside. Ascending; full: 1: there were more than room for. */
enum { BETWEEN_GAPS = 24 };
typedef struct { double t[2], normal[2][3]; } between_gap;
typedef struct { int n, full; between_gap gap[BETWEEN_GAPS]; } between_gaps;

/* Appends a gap. */
void between_gaps_add (between_gaps *g, const between_gap *gap);
/* What both have in common; what lies in any of the two. Gaps narrower than `slack` (share of the way) that
 * come of the intersection are none; those that were as narrow in one of the two before stay where the other
 * is open. */
void between_gaps_both (between_gaps *out, const between_gaps *a, const between_gaps *b, double slack);
void between_gaps_any  (between_gaps *out, const between_gaps *a, const between_gaps *b);
/* The gaps between gaps: what is inside of the one is outside of the other, normals turned. */
void between_gaps_turn (between_gaps *out, const between_gaps *a);

/* Gaps of one shape that is no mesh; of one that is subtracted those of its outside. A place on the surface
 * belongs to what is added, and not to what is subtracted. */
void between_shape (between_gaps *out, const pg_shape *shape, const between_way *way);
/* 1: any two places in it see each other. */
int  between_convex (const pg_shape *shape);

/* Faces of meshes: segments or triangles in a tree of boxes. */
typedef struct between_faces between_faces;
/* Tree of the faces of a mesh through which a way can leave the body and come back: those of the surface,
 * unless all nodes of the surface lie behind the plane of the face (alone: 1; 0: all faces, as other shapes
 * may lie there). *out NULL: there are none. */
pg_status between_faces_create (between_faces **out, const pg_mesh *mesh, int alone);
void      between_faces_free   (between_faces **faces);
/* Gaps of the way; a way that meets no face has none. */
void      between_faces_gaps   (between_gaps *out, const between_faces *faces, const between_way *way);
/* Can a way within this box meet a face? Does the place lie on one? */
int       between_faces_near   (const between_faces *faces, const double *low, const double *high);
int       between_faces_touch  (const between_faces *faces, const double *x, double near);
#endif
