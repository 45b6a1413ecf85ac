/* SPDX-License-Identifier: GPL-3.0-or-later
 * Volume and surface of a body of one shape: in closed form, or by quadrature over the elements of a mesh.
 * The plan of a run compares these with the sums over cells and facets. */
#include "shape.h"
#include "geometry/cloud/search/polygon.h"
#include <math.h>

/* Area (m^2) and length of the outline (m) of a polygon. */
static void of_polygon (const pg_shape *s, double *area, double *outline)
{
    *area = fabs (pg_polygon_area (s->nvertex, s->vertex)), *outline = 0;
    for (size_t i = 0, j = s->nvertex - 1; i < s->nvertex; j = i++)
        *outline += hypot (s->vertex[2*i] - s->vertex[2*j], s->vertex[2*i + 1] - s->vertex[2*j + 1]);
}

/* Returns 0 for a body of several shapes: overlapping or subtracted ones would need their intersections. */
int pg_body_measure (const pg_body *body, double *volume, double *surface)
{
    const pg_shape *s = body->shape;
    const double pi = acos (-1);
    double area, outline, height;
    if (body->n != 1) return 0;
    switch (s->kind) {
    case PG_DISK:     *volume = pi * s->radius * s->radius, *surface = 2 * pi * s->radius; return 1;
    case PG_SPHERE:
        *volume = 4 * pi * pow (s->radius, 3) / 3, *surface = 4 * pi * s->radius * s->radius;
        return 1;
    case PG_CYLINDER:
        *volume = pi * s->radius * s->radius * s->length,
        *surface = 2 * pi * s->radius * (s->radius + s->length);
        return 1;
    case PG_POLYGON:  of_polygon (s, volume, surface); return 1;
    case PG_MESH:     *volume = shape_mesh_volume (s, surface); return 1;
    case PG_ALPHA_SHAPE: return shape_alpha_volume (s, volume, surface);
    case PG_PRISM:
        of_polygon (s, &area, &outline);
        height = s->high[2] - s->low[2], *volume = area * height, *surface = 2 * area + outline * height;
        return 1;
    }
    /* Each pair of opposite sides has the area volume / length. */
    *volume = 1, *surface = 0;
    for (int k = 0; k < body->dim; k++) *volume *= s->high[k] - s->low[k];
    for (int k = 0; k < body->dim; k++) *surface += 2 * *volume / (s->high[k] - s->low[k]);
    return 1;
}
