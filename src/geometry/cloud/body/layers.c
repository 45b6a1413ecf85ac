/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fictitious boundary layers: boxes of whole lattice cells outside the bounding box of the shapes. A
 * displacement prescribed in a layer as deep as the horizon constrains the points of the body as material
 * would (doc/method.md B3). The lattice of the body itself is not changed by its layers: steps follow from
 * the extent without them, and thicknesses are rounded to whole cells. */
#include "shape.h"
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names of the sides, 2 axis + (1 on the high side). */
static const char *const sides[] = {"left", "right", "bottom", "top", "back", "front"};

/* These names always mean sides of the bounding box. */
int pg_layers_taken (const char *name)
{
    for (size_t k = 0; k < sizeof sides / sizeof *sides; k++) if (!strcmp (name, sides[k])) return 1;
    return !strcmp (name, "all");
}

/* Reads and checks a name. A set of the input file with the same name is reported when the sets are built. */
static void read_name (pg_layer *layer, const pg_body *body, const pg_scene *scene, size_t i)
{
    const char *name = pg_scene_text (scene, "layers[%zu].name", i);
    char at[64];
    snprintf (at, sizeof at, "layers[%zu].name", i);
    if (strlen (name) >= sizeof layer->name)
        pg_scene_fault (scene, at, "at most %zu letters", sizeof layer->name - 1);
    else if (!*name || strpbrk (name, ".[]{}= "))
        pg_scene_fault (scene, at, "a name has at least one letter and no space . [ ] { } =");
    else if (pg_layers_taken (name))
        pg_scene_fault (scene, at, "'%s' already names a side of the body", name);
    /* Surfaces of shapes, and the boxes of earlier layers. */
    for (size_t k = 0; k < body->n; k++)
        if (!strcmp (name, body->shape[k].boundary)) {
            pg_scene_fault (scene, at, "'%s' already names the surface of a shape, or another layer", name);
            break;
        }
    snprintf (layer->name, sizeof layer->name, "%.31s", name);
}

/* Reads a side; each may have one layer. */
static int read_side (const pg_body *body, const pg_scene *scene, size_t i)
{
    const char *side = pg_scene_text (scene, "layers[%zu].side", i);
    char at[64];
    int number = 0;
    snprintf (at, sizeof at, "layers[%zu].side", i);
    while (number < 5 && strcmp (side, sides[number])) number++;
    if (number >= 2 * body->dim) pg_scene_fault (scene, at, "a %dD body has no such side", body->dim);
    for (size_t k = 0; k < i; k++)
        if (body->layer[k].side == number)
            pg_scene_fault (scene, at, "layer %s is on this side already", body->layer[k].name);
    return number;
}

/* Number of rows and their thickness *reach (m), in cells of the lattice over low..high, the box of the
 * body without layers. */
static void read_thickness (pg_layer *layer, const double *low, const double *high, const pg_scene *scene,
                            size_t i, double *reach)
{
    int k = layer->side / 2;
    /* The step that pg_lattice_fit will choose. */
    double length = high[k] - low[k],
           step = length / fmax (1, floor (length / pg_scene_number (scene, "spacing") + 0.5));
    double thickness = pg_scene_length (scene, step, "layers[%zu].thickness", i),
           rows = floor (thickness / step + 0.5);
    char at[64];
    snprintf (at, sizeof at, "layers[%zu].thickness", i);
    if (!(rows >= 1)) pg_scene_fault (scene, at, "less than half a cell (%.6g m): no row of points", step);
    else if (!(rows < INT_MAX / 4)) pg_scene_fault (scene, at, "%.3g rows of cells are too many", rows);
    else layer->rows = (int) rows;
    *reach = layer->rows * step;
}

/* Makes the box of a layer. */
static void lay (pg_shape *box, pg_layer *layer, int dim, const double *low, const double *high, double reach)
{
    int k = layer->side / 2, far = layer->side % 2;
    memcpy (box->low, low, (size_t) dim * sizeof *low);
    memcpy (box->high, high, (size_t) dim * sizeof *high);
    layer->face = far ? high[k] : low[k];
    if (far) box->low[k] = high[k], box->high[k] = high[k] + reach;
    else box->high[k] = low[k], box->low[k] = low[k] - reach;
    box->kind = PG_BOX, box->add = 1;
    memcpy (box->boundary, layer->name, sizeof box->boundary);
}

/* Returns the coordinate (m) at which the body ends between x, which is inside, and `to` along an axis, by
 * bisection to the last bit. */
static double edge_of (const pg_body *body, const double *x, int axis, double to)
{
    double at[3] = { x[0], x[1], x[2] }, inside = x[axis], outside = to;
    at[axis] = to;
    if (pg_body_inside (body, at, 0)) return to;
    for (int n = 0; n < 100; n++) {
        at[axis] = 0.5 * (inside + outside);
        if (at[axis] == inside || at[axis] == outside) break;
        if (pg_body_inside (body, at, 0)) inside = at[axis]; else outside = at[axis];
    }
    return inside;
}

/* Largest number of cells tested along an axis. */
enum { MOST_LOOKS = 4096 };

/* Shrinks the box of a layer to the part of the face below which, half a cell deep, the body lies: from the
 * first cell to the last along every axis, and there to the body's own edge. body: without layers. 0: there
 * is no such part. */
static int shrink (pg_shape *box, const pg_layer *layer, const pg_body *body, const double *low,
                   const double *high, double spacing)
{
    int normal = layer->side / 2, found = 0, i[3] = { 0 }, count[3] = { 1, 1, 1 };
    double step[3] = { 0 }, first[3], last[3];
    for (int k = 0; k < body->dim; k++) {
        first[k] = high[k], last[k] = low[k];
        /* Positions tested along an axis: as many as cells of the lattice, but at most MOST_LOOKS. */
        double cells = fmax (1, floor ((high[k] - low[k]) / spacing + 0.5));
        if (k != normal) count[k] = (int) (cells = fmin (cells, MOST_LOOKS));
        step[k] = (high[k] - low[k]) / cells;
    }
    for (i[2] = 0; i[2] < count[2]; i[2]++)
        for (i[1] = 0; i[1] < count[1]; i[1]++)
            for (i[0] = 0; i[0] < count[0]; i[0]++) {
                double x[3] = { 0 };
                for (int k = 0; k < body->dim; k++) x[k] = low[k] + (i[k] + 0.5) * step[k];
                /* Half a cell below the face. */
                x[normal] = layer->face + (layer->side % 2 ? -0.5 : 0.5) * step[normal];
                if (!pg_body_inside (body, x, 0)) continue;
                found = 1;
                for (int k = 0; k < body->dim; k++) {
                    if (k == normal) continue;
                    /* The body may end between this cell and the next: its edge is found by bisection. */
                    if (x[k] - step[k] < first[k])
                        first[k] = fmin (first[k], edge_of (body, x, k, fmax (low[k], x[k] - step[k])));
                    if (x[k] + step[k] > last[k])
                        last[k] = fmax (last[k], edge_of (body, x, k, fmin (high[k], x[k] + step[k])));
                }
            }
    for (int k = 0; k < body->dim; k++) if (k != normal) box->low[k] = first[k], box->high[k] = last[k];
    return found;
}

/* Reports layers for bodies without a lattice: layers consist of lattice cells. */
static void refuse (const pg_scene *scene)
{
    const char *origin = pg_scene_given (scene, "mesh")     ? "a mesh"
                         : pg_scene_given (scene, "points") ? "a file of points"
                                                            : NULL;
    if (origin)
        pg_scene_fault (scene, "layers",
                        "are cells of a lattice, and %s has none: give the layer's own points in the file, "
                        "and a set for them",
                        origin);
    if (pg_scene_given (scene, "lattice_offset"))
        pg_scene_fault (
            scene, "layers",
            "are whole cells outside the body, which lattice_offset would cut: leave one of the two out");
}

/* Reads the layers; each is appended to the shapes, and the bounding box grows by it. */
pg_status pg_layers_read (pg_body *body, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "layers");
    double low[3], high[3];
    char at[64];
    if (n == 0) return PG_OK;
    refuse (scene);
    PG_TRY (pg_scene_verdict (scene));
    /* Missing shapes or a missing spacing are reported by other checks. */
    if (body->n == 0 || !(pg_scene_number (scene, "spacing") > 0)) return PG_OK;
    memcpy (low, body->low, sizeof low), memcpy (high, body->high, sizeof high);
    PG_ALLOC (body->layer, n);
    /* The body without layers, to test what lies in it. */
    const pg_body bare = *body;
    for (size_t i = 0; i < n; i++) {
        pg_layer *layer = &body->layer[i];
        double reach;
        /* Faults do not stop the loop, but a wrong side leaves no box to make. */
        read_name (layer, body, scene, i);
        layer->side = read_side (body, scene, i);
        body->nlayer = i + 1;
        if (layer->side >= 2 * body->dim) continue;
        read_thickness (layer, low, high, scene, i, &reach);
        lay (&body->shape[body->n], layer, body->dim, low, high, reach);
        int whole = strcmp (pg_scene_text (scene, "layers[%zu].over", i), "body") != 0;
        if (!whole
            && !shrink (&body->shape[body->n], layer, &bare, low, high, pg_scene_number (scene, "spacing"))) {
            snprintf (at, sizeof at, "layers[%zu].over", i);
            pg_scene_fault (
                scene, at,
                "half a cell below this side there is no body: it meets the side in a corner only");
        }
        /* The box of the body now includes the layer. */
        if (layer->side % 2) body->high[layer->side / 2] = body->shape[body->n].high[layer->side / 2];
        else body->low[layer->side / 2] = body->shape[body->n].low[layer->side / 2];
        body->n++;
    }
done:
    return status;
}

/* Only the coordinate normal to the layer is compared: beyond a face of the body there is nothing but its
 * layer. */
long pg_body_layer (const pg_body *body, const double *x, double margin)
{
    for (size_t i = 0; i < body->nlayer; i++) {
        const pg_layer *l = &body->layer[i];
        double beyond = x[l->side / 2] - l->face;
        if ((l->side % 2 ? beyond : -beyond) > margin) return (long) i;
    }
    return -1;
}
