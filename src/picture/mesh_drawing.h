/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the two files that draw meshes share: which faces are seen and in which colours
 * (mesh.c), and how these are put on pixels (mesh_paint.c). */
#ifndef PG_PICTURE_MESH_DRAWING_H
#define PG_PICTURE_MESH_DRAWING_H
#include "picture_private.h"

/* Longest name in the legend, and the largest number of sets or blocks with a colour of their
 * own. */
enum { MESH_NAME = 80, MESH_SETS = 24 };
/* A picture of a mesh that is being drawn. Lengths are m, or units of the mesh if its unit is
 * not known. */
typedef struct {
    const pg_mesh *mesh;
    const pg_picture_style *style;
    /* Metres in one unit of the mesh, 1 if that is not known. */
    double  scale;
    /* Displaced and scaled coordinates of the nodes (nnode x 3). */
    double *x;
    /* Faces that are painted: in 2D all elements, in 3D the sides of elements on the surface. */
    size_t  nface;
    /* Element and side of each face (nface); side -1 means the element itself. Ascending by
     * element and side. */
    int    *element, *side;
    /* 2D: the sides of elements on the boundary of the body. */
    size_t  nrim;
    int    *rim_element, *rim_side;
    /* Number of the name in the legend that a face belongs to (nface), or NULL: colours show
     * values. */
    double *own;
    /* Values at the nodes (nnode), or NULL. */
    const double *value;
    /* The names of the legend. */
    char    name[MESH_SETS + 1][MESH_NAME];
    const char *legend[MESH_SETS + 1];
    /* Number of sets that have a colour; the body itself is not counted. */
    int     categories;
    pg_sheet sheet;
    /* Only low and high are used: the box of the mesh, whose size stands below a view. */
    pg_grid  grid;
} mesh_drawing;

/* Paints all faces with a depth buffer: sets owner, value, depth and shade of the pixels. */
pg_status  pg_mesh_drawing_paint (mesh_drawing *d, pg_screen *screen);
/* Draws edges of elements, the boundary of a plane body, and sets, where they are in sight. */
void       pg_mesh_drawing_lines (const mesh_drawing *d, cairo_t *cr, const pg_screen *screen);
#endif
