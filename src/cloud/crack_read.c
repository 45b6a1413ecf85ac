/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pre-cracks of the scene: segments in 2D, plane polygons and discs in 3D. A crack that certainly does not
 * meet the body is a fault: most likely its coordinates are in other units. */
#include "perigal/cloud.h"
#include "polygon.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Vertices of a drawn disc; depth of the subdivision. */
enum { DISC_CORNERS = 64, DEEPEST = 8 };

/* |a| */
static double length (int dim, const double *a)
{
    double s = 0;
    for (int k = 0; k < dim; k++) s += a[k] * a[k];
    return sqrt (s);
}

/* ---- does it meet the body? ---------------------------------------------------------------------------- */
/* Can the triangle a b c meet the body? 0 only if it certainly does not: a ball around a piece misses the
 * body, or around all parts of the piece, by subdivision into four. */
static int may_meet (const pg_body *body, const double *a, const double *b, const double *c, int depth)
{
    double m[3] = {0, 0, 0}, ab[3] = {0, 0, 0}, bc[3] = {0, 0, 0}, ca[3] = {0, 0, 0}, radius = 0;
    const double *corner[3] = {a, b, c};
    for (int k = 0; k < body->dim; k++) {
        m[k] = (a[k] + b[k] + c[k]) / 3;
        ab[k] = 0.5 * (a[k] + b[k]), bc[k] = 0.5 * (b[k] + c[k]), ca[k] = 0.5 * (c[k] + a[k]);
    }
    for (int i = 0; i < 3; i++) {
        double r[3];
        for (int k = 0; k < body->dim; k++) r[k] = corner[i][k] - m[k];
        radius = fmax (radius, length (body->dim, r));
    }
    /* The ball about the middle m holds the piece. */
    if (!pg_body_inside (body, m, radius * (1 + 1e-9))) return 0;
    if (depth == DEEPEST || pg_body_inside (body, m, 0)) return 1;
    return may_meet (body, a, ab, ca, depth + 1) || may_meet (body, b, bc, ab, depth + 1)
        || may_meet (body, c, ca, bc, depth + 1) || may_meet (body, ab, bc, ca, depth + 1);
}

/* The same for a crack; polygons as fans of triangles. */
static int crack_may_meet (const pg_body *body, const pg_crack *c)
{
    const double *v = c->vertex;
    if (c->kind == PG_CRACK_SEGMENT) return may_meet (body, v, v + 2, v + 2, 0);
    for (size_t i = 1; i + 1 < c->nvertex; i++)
        if (may_meet (body, v, v + 3*i, v + 3*(i + 1), 0)) return 1;
    return 0;
}

/* ---- kinds --------------------------------------------------------------------------------------------- */
/* from and to. */
static pg_status read_segment (pg_crack *c, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    PG_ALLOC (c->vertex, 4);
    c->nvertex = 2;
    if (!pg_scene_given (scene, "%s.to", at)) {
        pg_scene_fault (scene, at, "from needs to: the other end of the crack");
        goto done;
    }
    pg_scene_vector (scene, 2, c->vertex, "%s.from", at);
    pg_scene_vector (scene, 2, c->vertex + 2, "%s.to", at);
    double t[2] = {c->vertex[2] - c->vertex[0], c->vertex[3] - c->vertex[1]}, size = length (2, t);
    if (!(size > 0)) pg_scene_fault (scene, at, "the crack has no length");
    else c->normal[0] = -t[1] / size, c->normal[1] = t[0] / size;
done:
    return status;
}

/* Unit normal by the area vector of the polygon, which no unlucky choice of three vertices can spoil. */
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
    double size = length (3, c->normal);
    for (int k = 0; k < 3 && size > 0; k++) c->normal[k] /= size;
}

/* What is wrong with the polygon, or NULL; flat: room for its projection (nvertex x 2). */
static const char *polygon_fault (const pg_crack *c, double *flat)
{
    double size = 0, off = 0;
    int k = 0;
    for (size_t i = 0; i < c->nvertex; i++) {
        double r[3], d = 0;
        for (int m = 0; m < 3; m++)
            r[m] = c->vertex[3 * i + (size_t) m] - c->vertex[m], d += r[m] * c->normal[m];
        size = fmax (size, length (3, r));
        off = fmax (off, fabs (d));
    }
    if (!(length (3, c->normal) > 0)) return "has no area";
    /* Vertices are often rounded to five or six digits. */
    if (!(off <= 1e-5 * size)) return "is not plane";
    for (int m = 1; m < 3; m++) if (fabs (c->normal[m]) > fabs (c->normal[k])) k = m;
    for (size_t i = 0; i < c->nvertex; i++)
        for (size_t m = 0; m < 2; m++) flat[2*i + m] = c->vertex[3*i + ((size_t) k + 1 + m) % 3];
    return pg_polygon_fault (c->nvertex, flat);
}

/* A list of vertices. */
static pg_status read_polygon (pg_crack *c, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    double *flat = NULL;
    size_t n = pg_scene_count (scene, "%s.polygon", at);
    c->kind = PG_CRACK_POLYGON;
    PG_ALLOC (c->vertex, 3 * n);
    PG_ALLOC (flat, 2 * n);
    c->nvertex = n;
    for (size_t i = 0; i < n; i++) pg_scene_vector (scene, 3, c->vertex + 3*i, "%s.polygon[%zu]", at, i);
    find_normal (c);
    const char *why = n < 3 ? "needs three vertices or more" : polygon_fault (c, flat);
    if (why) pg_scene_fault (scene, at, "the polygon %s", why);
done:
    pg_free (flat);
    return status;
}

/* Centre, normal, radius; e and f are unit vectors in its plane. */
static pg_status read_disc (pg_crack *c, const pg_scene *scene, const char *at)
{
    pg_status status = PG_OK;
    double e[3], f[3];
    int least = 0;
    c->kind = PG_CRACK_DISC;
    PG_ALLOC (c->vertex, 3 * DISC_CORNERS);
    c->nvertex = DISC_CORNERS;
    pg_scene_vector (scene, 3, c->centre, "%s.disc.center", at);
    pg_scene_vector (scene, 3, c->normal, "%s.disc.normal", at);
    c->radius = pg_scene_number (scene, "%s.disc.radius", at);
    double *n = c->normal, size = length (3, n);
    if (!(size > 0)) {
        pg_scene_fault (scene, at, "the normal has no length");
        goto done;
    }
    /* e: the axis least along the normal, without its part along the normal; f = n x e. */
    for (int k = 0; k < 3; k++) n[k] /= size;
    for (int k = 1; k < 3; k++) if (fabs (n[k]) < fabs (n[least])) least = k;
    for (int k = 0; k < 3; k++) e[k] = (k == least) - n[least] * n[k];
    size = length (3, e);
    for (int k = 0; k < 3; k++) e[k] /= size;
    for (int k = 0; k < 3; k++) f[k] = n[(k + 1) % 3] * e[(k + 2) % 3] - n[(k + 2) % 3] * e[(k + 1) % 3];
    for (size_t i = 0; i < DISC_CORNERS; i++) {
        double angle = 2 * acos (-1) * (double) i / DISC_CORNERS;
        for (size_t k = 0; k < 3; k++)
            c->vertex[3 * i + k] = c->centre[k] + c->radius * (cos (angle) * e[k] + sin (angle) * f[k]);
    }
done:
    return status;
}

/* Reads crack i; in 2D segments, in 3D polygons and discs. */
static pg_status read_crack (pg_crack *c, int dim, const pg_scene *scene, size_t i)
{
    char at[64];
    snprintf (at, sizeof at, "cracks[%zu]", i);
    int segment = pg_scene_given (scene, "%s.from", at);
    c->kind = PG_CRACK_SEGMENT;
    if (dim == 1) pg_scene_fault (scene, at, "a crack needs dimension 2 or 3");
    /* The kind of crack must fit the dimension. */
    else if (segment != (dim == 2))
        pg_scene_fault (scene, at, dim == 2 ? "in 2D give from and to" : "in 3D give a polygon or a disc");
    else if (!segment && pg_scene_given (scene, "%s.to", at))
        pg_scene_fault (scene, at, "to belongs to from, in 2D");
    else if (segment) return read_segment (c, scene, at);
    else if (pg_scene_given (scene, "%s.disc", at)) return read_disc (c, scene, at);
    else return read_polygon (c, scene, at);
    return PG_OK;
}

/* The fault says where the body is. */
static void fault_outside (const pg_scene *scene, const char *at, const pg_body *body, int dim)
{
    char text[128];
    int n = 0;
    for (int k = 0; k < dim; k++)
        n += snprintf (text + n, sizeof text - (size_t) n, "%s%c %.5g to %.5g m", k ? ", " : "", "xyz"[k],
                       body -> low[k], body -> high[k]);
    pg_scene_fault (scene, at, "lies outside the body, which fills %s", text);
}

/* The body is read only to see whether cracks meet it. */
pg_status pg_cracks_read (pg_cracks *out, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_body body = {0};
    size_t n = pg_scene_count (scene, "cracks");
    memset (out, 0, sizeof *out);
    out->dim = (int) pg_scene_integer (scene, "dimension");
    PG_ALLOC (out->crack, n);
    out->n = n;
    for (size_t i = 0; i < n; i++) PG_TRY (read_crack (&out->crack[i], out->dim, scene, i));
    PG_TRY (pg_scene_verdict (scene));
    if (n > 0) PG_TRY (pg_body_read (&body, scene));
    for (size_t i = 0; i < n && body.n > 0; i++) {
        char at[64];
        snprintf (at, sizeof at, "cracks[%zu]", i);
        if (!crack_may_meet (&body, &out->crack[i])) fault_outside (scene, at, &body, out->dim);
    }
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (pg_cracks_index (out));
done:
    pg_body_clear (&body);
    if (status != PG_OK) pg_cracks_clear (out);
    return status;
}
