/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pictures of meshes share: the faces seen and their colours (mesh.c), how they are painted
 * (mesh_paint.c). */
#ifndef PG_PICTURE_MESH_DRAWING_H
#define PG_PICTURE_MESH_DRAWING_H
#include "picture_private.h"

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
    pg_sheet sheet;
    pg_grid  grid;                                     /* low, high only */
} mesh_drawing;

pg_status  pg_mesh_drawing_paint (mesh_drawing *d, pg_screen *screen);       /* values and depth */
/* edges, outline, sets of 2D */
void       pg_mesh_drawing_lines (const mesh_drawing *d, cairo_t *cr, const pg_screen *screen);
#endif
