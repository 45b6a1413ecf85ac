/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cracks with a width as shapes that are subtracted from the body: a segment becomes a rectangle, a bend of a
 * polyline a disk, an outline itself; in 3D a disc becomes a cylinder, a polygon a plate. Ends are square: a
 * slot is as long as its crack (Zhou 2025, section 5.1). */
#include "crack.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Makes a rectangle about a segment, as wide as the slot. */
static pg_status rectangle (pg_shape *s, const pg_crack *c)
{
    pg_status status = PG_OK;
    const double *a = c->vertex, *b = a + 2,
                 w[2] = { 0.5 * c->slot * c->normal[0], 0.5 * c->slot * c->normal[1] };
    PG_ALLOC (s->vertex, 8);
    s->kind = PG_POLYGON, s->nvertex = 4;
    for (int k = 0; k < 2; k++) {
        s->vertex[k] = a[k] - w[k], s->vertex[2 + k] = b[k] - w[k];
        s->vertex[4 + k] = b[k] + w[k], s->vertex[6 + k] = a[k] + w[k];
    }
done:
    return status;
}

static pg_status outline (pg_shape *s, const pg_crack *c)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->vertex, 2 * c->nvertex);
    s->kind = PG_POLYGON, s->nvertex = c->nvertex;
    memcpy (s->vertex, c->vertex, 2 * c->nvertex * sizeof *s->vertex);
done:
    return status;
}

/* Makes a plate of a 3D polygon: origin, two directions, vertices in its own plane; half the width on each
 * side. */
static pg_status plate (pg_shape *s, const pg_crack *c)
{
    pg_status status = PG_OK;
    double f[3];
    PG_ALLOC (s->vertex, 2 * c->nvertex);
    s->kind = PG_PLATE, s->nvertex = c->nvertex, s->length = c->slot;
    memcpy (s->axis, c->normal, sizeof s->axis);
    memcpy (s->centre, c->vertex, sizeof s->centre);
    crack_plane (s->axis, s->along, f);
    for (size_t i = 0; i < c->nvertex; i++)
        for (int k = 0; k < 3; k++) {
            double r = c->vertex[3*i + (size_t) k] - s->centre[k];
            s->vertex[2*i] += r * s->along[k], s->vertex[2*i + 1] += r * f[k];
        }
done:
    return status;
}

static pg_status shape_of (pg_shape *s, const pg_crack *c)
{
    if (c->kind == PG_CRACK_OUTLINE) return outline (s, c);
    if (c->kind == PG_CRACK_SEGMENT) return rectangle (s, c);
    if (c->kind == PG_CRACK_POLYGON) return plate (s, c);
    s->kind = PG_CYLINDER, s->radius = c->radius, s->length = c->slot;
    for (int k = 0; k < 3; k++)
        s->axis[k] = c->normal[k], s->centre[k] = c->centre[k] - 0.5 * c->slot * c->normal[k];
    return PG_OK;
}

size_t crack_slot_count (const pg_cracks *all)
{
    size_t n = 0;
    for (size_t i = 0; i < all->n; i++)
        if (pg_crack_is_slot (&all->crack[i])) n += 1 + (size_t) all->crack[i].bend;
    return n;
}

pg_status crack_slot_shapes (pg_shape *shape, const pg_cracks *all)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < all->n; i++) {
        const pg_crack *c = &all->crack[i];
        if (!pg_crack_is_slot (c)) continue;
        shape->slot = 1;
        snprintf (shape->boundary, sizeof shape->boundary, "slot");
        PG_TRY (shape_of (shape++, c));
        if (!c->bend) continue;
        *shape = (pg_shape) { .kind = PG_DISK, .slot = 1, .radius = 0.5 * c->slot };
        snprintf (shape->boundary, sizeof shape->boundary, "slot");
        memcpy (shape++->centre, c->vertex, 2 * sizeof *c->vertex);
    }
done:
    return status;
}

int crack_slots_given (const pg_scene *scene)
{
    int plane = pg_scene_integer (scene, "dimension") == 2;
    for (size_t i = 0, n = pg_scene_count (scene, "cracks"); i < n; i++)
        if (pg_scene_given (scene, "cracks[%zu].width", i) || pg_scene_given (scene, "cracks[%zu].file", i)
            || (plane && (pg_scene_given (scene, "cracks[%zu].polygon", i)
                          || pg_scene_given (scene, "cracks[%zu].ellipse", i))))
            return 1;
    return 0;
}
