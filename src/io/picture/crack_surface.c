/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws the surfaces of grown 3D cracks, which consist of triangles, for the view of the crack alone: from
 * any side, with their own shape instead of the cubes of damaged points. The pre-cracks of the scene, which
 * are plane polygons, are drawn too. What lies outside the box of the body is cut away, as triangles extend a
 * little beyond its surface. */
#include "picture_private.h"
#include <math.h>
#include <string.h>

/* Most corners of a triangle that the six faces of a box have cut. */
enum { CORNERS = 9 };

int pg_cracks_grown (const pg_cracks *cracks)
{
    for (size_t k = 0; cracks && cracks->dim == 3 && k < cracks->n; k++)
        if (cracks->crack[k].sided) return 1;
    return 0;
}

/* Cuts a convex polygon of n corners (n x 3) off behind the plane x_axis = at, where `side` 1 keeps what is
 * below it and -1 what is above; returns how many corners are left (Sutherland and Hodgman 1974). */
static size_t cut_off (double x[CORNERS][3], size_t n, int axis, double at, int side)
{
    double out[CORNERS][3];
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        const double *a = x[i], *b = x[(i + 1) % n];
        double d = side * (at - a[axis]), e = side * (at - b[axis]);
        if (d >= 0 && m < CORNERS) memcpy (out[m++], a, sizeof out[0]);
        if ((d >= 0) == (e >= 0) || m == CORNERS) continue;
        for (int k = 0; k < 3; k++) out[m][k] = a[k] + d / (d - e) * (b[k] - a[k]);
        m++;
    }
    memcpy (x, out, m * sizeof out[0]);
    return m;
}

void pg_cracks_depth (const pg_cracks *cracks, const pg_grid *g, int axis, double unit, double *low,
                      double *high)
{
    double least = INFINITY, most = -INFINITY;
    for (size_t k = 0; k < cracks->n; k++)
        for (size_t i = 0; i < cracks->crack[k].nvertex; i++) {
            double x = cracks->crack[k].vertex[3*i + (size_t) axis];
            least = fmin (least, fmax (x, g->low[axis])), most = fmax (most, fmin (x, g->high[axis]));
        }
    /* the range is at least a tenth of the body's extent, also for a plane surface normal to the axis */
    double room = fmax (0, 0.1 * (g->high[axis] - g->low[axis]) - (most - least));
    *low = (least - 0.5 * room) / unit, *high = (most + 0.5 * room) / unit;
}

/* State while crack surfaces are drawn: the body, the screen, and how surfaces get their values. */
typedef struct {
    const pg_solid *solid;
    pg_screen *screen;
    pg_nearest *near;                                  /* search for points; NULL: colours by depth */
    const double *value;                               /* value that colours each point */
    int axis;                                          /* axis along which depth is measured */
    double unit;                                       /* length unit of depths in the picture, m */
} painter;

/* Draws a triangle inside the box, with the brightness of its side towards the eye. */
static void paint (const painter *p, const double *a, const double *b, const double *c)
{
    const pg_eye *e = p->solid->eye;
    const double *corner[3] = { a, b, c };
    double v[3][3], value[3], u[3], w[3], normal[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], w[k] = c[k] - a[k];
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        normal[k] = u[m] * w[n] - u[n] * w[m];
    }
    double size = sqrt (pg_along (normal, normal, 3));
    if (!(size > 0)) return;
    size *= pg_along (e->toward, normal, 3) < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++) normal[k] /= size;
    for (int k = 0; k < 3; k++) {
        const double *x = corner[k];
        pg_screen_place (p->screen, e, x, v[k]);
        long point = p->near ? pg_nearest_find (p->near, x, NULL, NULL) : -1;
        value[k] = p->near ? (point < 0 ? NAN : p->value[point]) : x[p->axis] / p->unit;
    }
    pg_triangle (p->screen, v, 0, pg_light_on (e, normal), value);
}

static void paint_inside (const painter *p, const double *a, const double *b, const double *c)
{
    const pg_grid *g = p->solid->grid;
    double x[CORNERS][3];
    size_t n = 3;
    memcpy (x[0], a, sizeof x[0]), memcpy (x[1], b, sizeof x[0]), memcpy (x[2], c, sizeof x[0]);
    for (int axis = 0; axis < 3 && n; axis++) {
        n = cut_off (x, n, axis, g->high[axis], 1);
        if (n) n = cut_off (x, n, axis, g->low[axis], -1);
    }
    for (size_t i = 1; i + 1 < n; i++) paint (p, x[0], x[i], x[i + 1]);
}

pg_status pg_cracks_draw (const pg_solid *solid, pg_screen *screen, const pg_cracks *cracks,
                          const double *value, int axis, double unit)
{
    pg_status status = PG_OK;
    painter p = { .solid = solid, .screen = screen, .value = value, .axis = axis, .unit = unit };
    PG_ALLOC (screen->value, (size_t) screen->width * (size_t) screen->height);
    if (value) PG_TRY (pg_nearest_create (&p.near, 3, solid->cloud->n, solid->cloud->x));
    for (size_t k = 0; k < cracks->n; k++) {
        const pg_crack *c = &cracks->crack[k];
        double middle[3] = { 0 };
        for (size_t i = 0; i < 3 * c->nvertex; i++) middle[i % 3] += c->vertex[i] / (double) c->nvertex;
        if (c->nvertex == 3) paint_inside (&p, c->vertex, c->vertex + 3, c->vertex + 6);
        else
            for (size_t i = 0; i < c->nvertex; i++)
                paint_inside (&p, middle, c->vertex + 3*i, c->vertex + 3 * ((i + 1) % c->nvertex));
    }
done:
    pg_nearest_free (&p.near);
    return status;
}
