/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pictures of meshes share: the faces seen and their colours (picture_mesh.c), how they are painted
 * (picture_mesh_paint.c). */
#ifndef PERIGAL_OUTPUT_PICTURE_MESH_H
#define PERIGAL_OUTPUT_PICTURE_MESH_H
#include "picture.h"

enum { MESH_NAME = 80, MESH_SETS = 24 };
typedef struct {
    const pg_mesh *mesh;
    const pg_picture_style *style;
    double  scale;                                     /* m (bare: 1) in a unit of the mesh */
    double *x;                                         /* displaced places of the nodes, scaled (nnode x 3) */
    size_t  nface;  /* faces that are painted: elements (2D), surface (3D) */
    int    *element, *side;                            /* side -1: the element itself */
    size_t  nrim;                                      /* 2D: sides of elements on the boundary */
    int    *rim_element, *rim_side;
    double *own;                                       /* category of an element or a face, or NULL (nface) */
    const double *value;                               /* at the nodes, or NULL */
    char    name[MESH_SETS + 1][MESH_NAME];            /* legend */
    const char *legend[MESH_SETS + 1];
    int     categories;                                /* sets drawn, body not counted */
    pg_plate plate;
    pg_grid  grid;                                     /* low, high only */
} mesh_drawing;

/* The nodes (in the mesh) and the kind of a painted face. */
pg_element mesh_face (const mesh_drawing *d, int element, int side, int node[9]);
pg_status  mesh_paint (mesh_drawing *d, pg_screen *screen);                   /* values and depth */
/* edges, outline, sets of 2D */
void       mesh_lines (const mesh_drawing *d, cairo_t *cr, const pg_screen *screen);
#endif
