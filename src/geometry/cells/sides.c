/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which facets lie in the planes of the bounding box: left right bottom top back front. Pieces of the exact
 * surface are judged by their surface, facets of a mesh by their nodes. Faces of a staircase (`cells:
 * staircase`, or a mesh laid over a lattice) stand for the surface within half a step, where the body
 * really ends in that plane. */
#include "cut.h"
#include "mark.h"
#include <math.h>

/* Coordinate of the plane of a side, m. */
static double plane_of (const pg_marks *m, int side)
{
    return side % 2 ? m->high[side / 2] : m->low[side / 2];
}

/* Distance (m) within which a surface lies in a plane of the bounding box. */
static double slack (const pg_marks *m)
{
    return 1e-9 * m->size + 2 * pg_rounding (m->cloud->dim, m->low, m->high);
}

/* Is the surface flat, and does its box lie in the plane of the side? */
static int surface_lies_in (const pg_marks *m, const cut_surface *s, int side)
{
    /* Files of meshes round coordinates to six or seven digits. */
    double face = plane_of (m, side), tolerance = s->facets ? 1e-6 * m->size : slack (m);
    return s->flat && fabs (s->low[side / 2] - face) <= tolerance
           && fabs (s->high[side / 2] - face) <= tolerance;
}

/* Do all nodes of facet f lie within a millionth of the body's size of the plane? Mesh files round
 * coordinates to six or seven digits. */
static int nodes_lie_in (const pg_marks *m, size_t f, int side)
{
    const pg_cells *c = m->cells;
    for (size_t k = c->facet_start[f]; k < c->facet_start[f + 1]; k++)
        if (fabs (c->facet_x[k * (size_t) c->dim + (size_t) side / 2] - plane_of (m, side)) > 1e-6 * m->size)
            return 0;
    return 1;
}

/* Does the body really end in the plane over this face of a lattice cell, or does it only touch the plane
 * there? It must reach the plane at the centre of the face and at one of the points a quarter step aside:
 * where a round body touches the plane it is missing on all sides, at the end of a flat side only on some. */
static int body_reaches (const pg_marks *m, size_t f, int side)
{
    size_t dim = (size_t) m->cells->dim;
    int axis = side / 2, aside = dim > 1 ? 1 << (dim - 1) : 0, reached = aside == 0;
    double face = plane_of (m, side), depth = pg_body_meshes (m->body) ? 1e-6 * m->size : slack (m);
    /* The last position tested is the centre of the face. */
    for (int q = 0; q <= aside; q++) {
        double x[3] = {0};
        int bit = 0;
        for (int k = 0; k < (int) dim; k++) {
            x[k] = m->cells->facet_centre[f * dim + (size_t) k];
            if (k == axis) x[k] = face + (side % 2 ? -depth : depth);
            else if (q < aside) x[k] += (q >> bit++ & 1 ? 0.25 : -0.25) * m->cloud->step[k];
        }
        int in = pg_body_inside (m->body, x, 0);
        if (q == aside) return in && reached;
        reached |= in;
    }
    return 0;
}

/* The normal must point outward through the side, within 60 degrees of its direction (cosine > 1/2). */
int cells_facet_on_side (const pg_marks *m, size_t f, int side)
{
    const pg_cells *c = m->cells;
    size_t at = f * (size_t) c->dim + (size_t) side / 2;
    double outward = side % 2 ? c->normal[at] : -c->normal[at];
    if (!(outward > 0.5)) return 0;
    if (c->facet_point) return nodes_lie_in (m, f, side);
    const cut_surface *s = c->cut && c->facet_surface[f] >= 0 ? &c->cut->surface[c->facet_surface[f]] : NULL;
    if (s && !(s->shape >= 0 && c->cut->body.shape[s->shape].kind == PG_STAIRS))
        return surface_lies_in (m, s, side);
    double off = fabs (c->facet_centre[at] - plane_of (m, side));
    return off <= 0.5 * m->cloud->step[side / 2] * (1 + 1e-9) && body_reaches (m, f, side);
}

/* The tolerance is half a spacing: points from a file need not lie in the plane itself. */
int cells_point_on_side (const pg_marks *m, size_t i, int side)
{
    double x = m->cloud->x[i * (size_t) m->cloud->dim + (size_t) side / 2];
    return fabs (x - plane_of (m, side))
           <= 0.5 * pg_cloud_ratio (m->cloud, i) * m->cloud->step[side / 2] * (1 + 1e-9);
}
