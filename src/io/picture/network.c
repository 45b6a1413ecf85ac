/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws the cracks of a scene alone, before anything is computed: in 2D the body coloured by the distance to
 * the nearest crack, without its slots; in 3D the cells that cracks pass through, seen from outside, coloured
 * by their depth. The body is drawn on a lattice of its own, whatever the scene's spacing. */
#include "perigal/picture.h"
#include <math.h>
#include <string.h>

/* Numbers of cells along the longest side of the body, in 2D and 3D. */
enum { PLANE_CELLS = 320, SPACE_CELLS = 110 };

/* Makes a cloud with a point at the centre of each cell of the lattice that lies in the body. */
static pg_status points_of (pg_cloud *c, const pg_lattice *l)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) l->dim, n = 0, cells = 1, p = 0;
    for (int k = 0; k < 3; k++) cells *= (size_t) l->count[k], c->step[k] = l->step[k];
    for (size_t i = 0; i < cells; i++) n += l->in[i];
    c->dim = l->dim, c->n = n, c->thickness = 1, c->regular = 1;
    PG_ALLOC (c->x, n * dim);
    PG_ALLOC (c->volume, n);
    c->h = 1;
    for (size_t k = 0; k < dim; k++) c->h *= l->step[k], c->low[k] = INFINITY, c->high[k] = -INFINITY;
    for (size_t i = 0; i < cells; i++) {
        size_t rest = i;
        if (!l->in[i]) continue;
        for (size_t k = 0; k < dim; rest /= (size_t) l->count[k++]) {
            double x = pg_lattice_at (l, (int) k, (double) (rest % (size_t) l->count[k]) + 0.5);
            c->x[p * dim + k] = x;
            c->low[k] = fmin (c->low[k], x), c->high[k] = fmax (c->high[k], x);
        }
        c->volume[p++] = c->h;
    }
    c->h = pow (c->h, 1.0 / (double) dim);
done:
    return status;
}

/* Distance (m) of x from a 2D crack, a segment or the edges of a polygon, or from the surface of a slot. */
static double distance_of (const pg_crack *c, const double *x)
{
    double least = INFINITY, d;
    size_t edges = c->kind == PG_CRACK_SEGMENT ? 1 : c->nvertex;
    for (size_t i = 0; i < edges; i++) {
        pg_segment_nearest (c->vertex + 2*i, c->vertex + 2 * ((i + 1) % c->nvertex), x, NULL, &d);
        least = fmin (least, d);
    }
    return fmax (0, least - 0.5 * c->slot);
}

/* The largest length unit (in m; *name: "km", "m", "mm" ...) that is not above half of `size` (m). */
static double unit_of (double size, const char **name)
{
    static const struct { double unit; const char *name; } units[] = {
        { 1e3, "km" }, { 1, "m" }, { 1e-3, "mm" }, { 1e-6, "µm" }, { 1e-9, "nm" } };
    size_t k = 0;
    while (k + 1 < sizeof units / sizeof *units && size < 2 * units[k].unit) k++;
    *name = units[k].name;
    return units[k].unit;
}

static pg_status draw_plane (const char *path, const pg_body *body, const pg_cracks *all,
                             const pg_cloud *cloud, double *value, pg_picture_style *style, double size)
{
    char label[64];
    const char *name;
    double unit = unit_of (0.2 * size, &name);
    pg_outline outline = { body, NULL, NULL };
    snprintf (label, sizeof label, "distance to the nearest crack (%s)", name);
    for (size_t i = 0; i < cloud->n; i++) {
        value[i] = INFINITY;
        for (size_t k = 0; k < all->n; k++)
            value[i] = fmin (value[i], distance_of (&all->crack[k], cloud->x + 2 * i));
        value[i] = isfinite (value[i]) ? value[i] / unit : NAN;
    }
    style->label = label, style->outline = &outline;
    return pg_picture_field (path, cloud, value, style);
}

/* Draws the cells whose centre lies within 0.6 steps of a crack, or of a slot's face. */
static pg_status draw_space (const char *path, const pg_cracks *all, const pg_cloud *cloud, double *value,
                             pg_picture_style *style)
{
    double reach = 0.6 * fmax (fmax (cloud->step[0], cloud->step[1]), cloud->step[2]), widest = 0;
    for (size_t k = 0; k < all->n; k++) widest = fmax (widest, all->crack[k].slot);
    for (size_t i = 0; i < cloud->n; i++)
        value[i] = pg_cracks_touch (all, cloud->x + 3*i, reach + 0.5 * widest) != NULL;
    style->view = PG_VIEW_CRACK, style->select = value, style->above = 0.5, style->by_depth = 1;
    return pg_picture_field (path, cloud, value, style);
}

pg_status pg_picture_network (const char *path, const pg_body *body, const pg_cracks *cracks,
                              const char *title)
{
    pg_status status = PG_OK;
    pg_lattice lattice = { 0 };
    pg_cloud cloud = { 0 };
    pg_cracks sharp = *cracks;
    double *value = NULL, size = 0;
    pg_picture_style style = { .title = title };
    if (body->n == 0) PG_FAIL (PG_E_USAGE, "the picture of a network needs a body of shapes");
    if (body->dim == 1) PG_FAIL (PG_E_USAGE, "a bar has no cracks to draw");
    for (int k = 0; k < body->dim; k++) size = fmax (size, body->high[k] - body->low[k]);
    PG_TRY (pg_lattice_fit (&lattice, body, size / (body->dim == 2 ? PLANE_CELLS : SPACE_CELLS), NULL));
    PG_TRY (points_of (&cloud, &lattice));
    PG_ALLOC (value, cloud.n);
    /* slots are gaps in the body: lines are drawn for sharp cracks only */
    sharp.n = 0, sharp.crack = NULL;
    PG_ALLOC (sharp.crack, cracks->n);
    for (size_t k = 0; k < cracks->n; k++)
        if (!pg_crack_is_slot (&cracks->crack[k])) sharp.crack[sharp.n++] = cracks->crack[k];
    style.cracks = sharp.n ? &sharp : NULL;
    PG_TRY (body->dim == 2 ? draw_plane (path, body, cracks, &cloud, value, &style, size)
                           : draw_space (path, cracks, &cloud, value, &style));
done:
    pg_free (value), pg_free (cloud.x), pg_free (cloud.volume);
    if (sharp.crack != cracks->crack) pg_free (sharp.crack);
    pg_lattice_clear (&lattice);
    return status;
}
