/* SPDX-License-Identifier: GPL-3.0-or-later
 * Kinds of cracks from their numbers: segments and outlines in 2D; polygons, discs and ellipses in 3D. Errors
 * are returned as text, to which the caller can add key or line. */
#include "crack.h"
#include "geometry/cloud/search/polygon.h"
#include "perigal/vector.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Scales n to unit length; one that has it to rounding is kept, so that values are written and read back bit
 * by bit. 0: it has no length. */
static int scale_to_unit (double *n)
{
    double size = pg_size (3, n);
    if (!(size > 0) || !isfinite (size)) return 0;
    if (fabs (size - 1) > 4 * DBL_EPSILON) for (int k = 0; k < 3; k++) n[k] /= size;
    return 1;
}

void crack_plane (const double *n, double *e, double *f)
{
    int least = 0;
    /* e: the axis least along the normal, without its part along the normal; f = n x e. */
    for (int k = 1; k < 3; k++) if (fabs (n[k]) < fabs (n[least])) least = k;
    for (int k = 0; k < 3; k++) e[k] = (k == least) - n[least] * n[k];
    double size = pg_size (3, e);
    for (int k = 0; k < 3; k++) e[k] /= size;
    for (int k = 0; k < 3; k++) f[k] = n[(k + 1) % 3] * e[(k + 2) % 3] - n[(k + 2) % 3] * e[(k + 1) % 3];
}

pg_status crack_segment (pg_crack *c, const double *from, const double *to, const char **why)
{
    pg_status status = PG_OK;
    double t[2] = { to[0] - from[0], to[1] - from[1] }, size = pg_size (2, t);
    *why = NULL;
    PG_ALLOC (c->vertex, 4);
    c->kind = PG_CRACK_SEGMENT, c->nvertex = 2;
    memcpy (c->vertex, from, 2 * sizeof *from);
    memcpy (c->vertex + 2, to, 2 * sizeof *to);
    if (!(size > 0)) *why = "has no length";
    else c->normal[0] = -t[1] / size, c->normal[1] = t[0] / size;
done:
    return status;
}

/* Finds the unit normal by the area vector of the polygon, which does not depend on a choice of three
 * vertices. */
static void find_normal (pg_crack *c)
{
    const double *o = c->vertex;
    for (size_t i = 1; i + 1 < c->nvertex; i++) {
        const double *a = o + 3*i, *b = a + 3;
        for (int k = 0; k < 3; k++) {
            int p = (k + 1) % 3, q = (k + 2) % 3;
            c->normal[k] += (a[p] - o[p]) * (b[q] - o[q]) - (a[q] - o[q]) * (b[p] - o[p]);
        }
    }
    double size = pg_size (3, c->normal);
    for (int k = 0; k < 3 && size > 0; k++) c->normal[k] /= size;
}

/* Returns what is wrong with the polygon, or NULL; flat: workspace for its projection (nvertex x 2). */
static const char *polygon_fault (const pg_crack *c, double *flat)
{
    double size = 0, off = 0;
    int k = 0;
    for (size_t i = 0; i < c->nvertex; i++) {
        double r[3], d = 0;
        for (int m = 0; m < 3; m++)
            r[m] = c->vertex[3 * i + (size_t) m] - c->vertex[m], d += r[m] * c->normal[m];
        size = fmax (size, pg_size (3, r));
        off = fmax (off, fabs (d));
    }
    if (!(pg_size (3, c->normal) > 0)) return "has no area";
    /* Vertices are often rounded to five or six digits. */
    if (!(off <= 1e-5 * size)) return "is not plane";
    for (int m = 1; m < 3; m++) if (fabs (c->normal[m]) > fabs (c->normal[k])) k = m;
    for (size_t i = 0; i < c->nvertex; i++)
        for (size_t m = 0; m < 2; m++) flat[2*i + m] = c->vertex[3*i + ((size_t) k + 1 + m) % 3];
    return pg_polygon_fault (c->nvertex, flat);
}

pg_status crack_polygon (pg_crack *c, size_t n, const double *vertex, const char **why)
{
    pg_status status = PG_OK;
    double *flat = NULL;
    PG_ALLOC (c->vertex, 3 * n);
    PG_ALLOC (flat, 2 * n);
    c->kind = PG_CRACK_POLYGON, c->nvertex = n;
    if (n) memcpy (c->vertex, vertex, 3 * n * sizeof *vertex);
    if (n >= 3) find_normal (c);
    *why = n < 3 ? "needs three vertices or more" : polygon_fault (c, flat);
done:
    pg_free (flat);
    return status;
}

pg_status crack_disc (pg_crack *c, const double *centre, const double *normal, double radius,
                      const char **why)
{
    pg_status status = PG_OK;
    double e[3], f[3];
    *why = NULL;
    PG_ALLOC (c->vertex, 3 * CRACK_CORNERS);
    c->kind = PG_CRACK_DISC, c->nvertex = CRACK_CORNERS, c->radius = radius;
    memcpy (c->centre, centre, sizeof c->centre);
    memcpy (c->normal, normal, sizeof c->normal);
    if (!scale_to_unit (c->normal)) {
        *why = "normal has no length";
        goto done;
    }
    if (!(radius > 0)) {
        *why = "radius must be positive";
        goto done;
    }
    crack_plane (c->normal, e, f);
    for (size_t i = 0; i < CRACK_CORNERS; i++) {
        double angle = 2 * acos (-1) * (double) i / CRACK_CORNERS;
        for (size_t k = 0; k < 3; k++)
            c->vertex[3 * i + k] = c->centre[k] + c->radius * (cos (angle) * e[k] + sin (angle) * f[k]);
    }
done:
    return status;
}

/* ---- ellipses -------------------------------------------------------------------------------------------
 */
/* Vertex i of the polygon that replaces a circle of radius 1: with its area, n / 2 sin (2 pi / n) R^2 = pi.
 * */
static void on_circle (size_t i, double *u, double *v)
{
    const double pi = acos (-1), n = CRACK_CORNERS, R = sqrt (pi / (0.5 * n * sin (2 * pi / n)));
    double angle = 2 * pi * (double) i / n;
    *u = R * cos (angle), *v = R * sin (angle);
}

pg_status crack_ellipse (pg_crack *c, const double *centre, const double *normal, const double *along,
                         double len, double breadth, const char **why)
{
    double n[3] = { normal[0], normal[1], normal[2] }, e[3], f[3], part = 0,
           vertex[3 * CRACK_CORNERS] = { 0 };
    *why = NULL;
    if (!scale_to_unit (n)) *why = "normal has no length";
    for (int k = 0; k < 3 && !*why; k++) part += n[k] * along[k];
    for (int k = 0; k < 3; k++) e[k] = along[k] - part * n[k];
    /* a direction along the normal to 1e-6 has no direction in the plane */
    if (!*why && !(pg_size (3, e) > 1e-6 * pg_size (3, along))) *why = "long axis lies along its normal";
    if (*why || !scale_to_unit (e)) return PG_OK;
    for (int k = 0; k < 3; k++) f[k] = n[(k + 1) % 3] * e[(k + 2) % 3] - n[(k + 2) % 3] * e[(k + 1) % 3];
    for (size_t i = 0; i < CRACK_CORNERS; i++) {
        double u, v;
        on_circle (i, &u, &v);
        for (size_t k = 0; k < 3; k++)
            vertex[3*i + k] = centre[k] + 0.5 * len * u * e[k] + 0.5 * breadth * v * f[k];
    }
    return crack_polygon (c, CRACK_CORNERS, vertex, why);
}

pg_status crack_outline (pg_crack *c, size_t n, const double *vertex, const char **why)
{
    pg_status status = PG_OK;
    PG_ALLOC (c->vertex, 2 * n);
    c->kind = PG_CRACK_OUTLINE, c->nvertex = n;
    if (n) memcpy (c->vertex, vertex, 2 * n * sizeof *vertex);
    *why = pg_polygon_fault (n, c->vertex);
done:
    return status;
}

pg_status crack_slot_ellipse (pg_crack *c, const double *centre, double len, double breadth, double angle,
                              const char **why)
{
    double vertex[2 * CRACK_CORNERS], s = sin (angle), t = cos (angle);
    for (size_t i = 0; i < CRACK_CORNERS; i++) {
        double u, v;
        on_circle (i, &u, &v);
        u *= 0.5 * len, v *= 0.5 * breadth;
        vertex[2*i] = centre[0] + u * t - v * s, vertex[2*i + 1] = centre[1] + u * s + v * t;
    }
    return crack_outline (c, CRACK_CORNERS, vertex, why);
}

int pg_crack_is_slot (const pg_crack *crack) { return crack->slot > 0 || crack->kind == PG_CRACK_OUTLINE; }
