/* SPDX-License-Identifier: GPL-3.0-or-later
 * The body: shapes added and subtracted in the order of the input file. A position on a surface belongs to
 * the body. Later shapes win: what is subtracted may be filled again by a shape that is added after it.
 * crack_read.c reads the body with the slots of its cracks subtracted (pg_body_read). */
#include "crack.h"
#include "shape.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names the surface of shape i, by which sets refer to it: as the input file says, else hole, rim or side;
 * names of the sides of the bounding box are refused. */
static void name_boundary (pg_shape *s, const pg_scene *scene, size_t i)
{
    const char *name = !s->add ? "hole" : pg_shape_types[s->kind].round ? "rim" : "side";
    char at[64];
    snprintf (at, sizeof at, "body[%zu].name", i);
    if (pg_scene_given (scene, "%s", at)) name = pg_scene_text (scene, "%s", at);
    if (pg_layers_taken (name)) pg_scene_fault (scene, at, "'%s' already names a side of the body", name);
    if (strlen (name) >= sizeof s->boundary)
        pg_scene_fault (scene, at, "at most %zu letters", sizeof s->boundary - 1);
    snprintf (s->boundary, sizeof s->boundary, "%.31s", name);
}

/* Reads shape i of the input file. After an error it is a box, so that the other shapes can still be read. */
static pg_status read_shape (pg_shape *s, int dim, const pg_scene *scene, size_t i)
{
    char at[96];
    s->add = pg_scene_given (scene, "body[%zu].add", i);
    for (s->kind = 0; s->kind < PG_SHAPES; s->kind++) {
        snprintf (at, sizeof at, "body[%zu].%s.%s", i, s->add ? "add" : "subtract",
                  pg_shape_types[s->kind].name);
        if (pg_scene_given (scene, "%s", at)) break;
    }
    if (s->kind == PG_SHAPES) {
        s->kind = PG_BOX;
        snprintf (at, sizeof at, "body[%zu]", i);
        pg_scene_fault (scene, at, "has no shape");
        return PG_OK;
    }
    const pg_shape_type *type = &pg_shape_types[s->kind];
    name_boundary (s, scene, i);
    if (dim >= type->lowest && dim <= type->highest) return type->read (s, dim, scene, at);
    pg_scene_fault (scene, at, "a %s needs dimension %d, this scene has %d", type->name, type->lowest, dim);
    return PG_OK;
}

/* Bounding box of the added shapes, m. Subtracted ones can only make the body smaller, and are left out:
 * the box may then be wider than the body. */
static void bound (pg_body *body)
{
    for (int k = 0; k < body->dim; k++) body->low[k] = INFINITY, body->high[k] = -INFINITY;
    for (size_t i = 0; i < body->n; i++) {
        double low[3], high[3];
        if (!body->shape[i].add) continue;
        pg_shape_types[body->shape[i].kind].box (&body->shape[i], body->dim, low, high);
        for (int k = 0; k < body->dim; k++) {
            body->low[k]  = fmin (body->low[k], low[k]);
            body->high[k] = fmax (body->high[k], high[k]);
        }
    }
}

/* Makes the alpha shape of the input file's points the only shape of the body (key surface). */
static pg_status read_surface (pg_body *out, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_shape *s = out->shape;
    if (out->n || !pg_scene_given (scene, "points") || out->dim == 1)
        pg_scene_fault (scene, "surface", "alpha_shape is the surface of points of a file in two or three "
                        "dimensions that stand alone: %s",
                        out->n ? "this scene has a body" : "give points, or leave it out");
    PG_TRY (pg_scene_verdict (scene));
    while (strcmp (pg_shape_types[s->kind].name, "alpha_shape") != 0) s->kind++;
    snprintf (s->boundary, sizeof s->boundary, "side");
    PG_TRY (shape_alpha_read (s, out->dim, scene, NULL));
    s->add = 1, out->n = 1;
    bound (out);
done:
    return status;
}

/* Reads the shapes of the input file; leaves room for `more` behind them. A body so far from the origin that
 * its size is lost in rounding is refused: tolerances would be meaningless. Later checks build on earlier
 * ones, so that errors are reported in stages. */
static pg_status read_shapes (pg_body *out, const pg_scene *scene, size_t more)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "body"), added = 0;
    memset (out, 0, sizeof *out);
    out->dim = (int) pg_scene_integer (scene, "dimension");
    if (n == 0 && !pg_scene_given (scene, "points") && !pg_scene_given (scene, "mesh"))
        pg_scene_fault (scene, "body",
                        "is missing: give body (a list of shapes), points (a file) or mesh (a file)");
    if (n > 0 && pg_scene_given (scene, "mesh"))
        pg_scene_fault (scene, "body",
                        "stands beside mesh, which has a surface of its own: give one of the two");
    PG_ALLOC (out->shape, n + 1 + more + pg_scene_count (scene, "layers"));
    out->n = n;
    if (strcmp (pg_scene_text (scene, "surface"), "none") != 0) return read_surface (out, scene);
    /* All shapes are read, also after one with errors. */
    for (size_t i = 0; i < n; i++) {
        PG_TRY (read_shape (&out->shape[i], out->dim, scene, i));
        added += out->shape[i].add != 0;
    }
    if (n > 0 && added == 0) pg_scene_fault (scene, "body", "nothing is added, only subtracted");
    PG_TRY (pg_scene_verdict (scene));
    if (n > 0) bound (out);
    /* 1e-9 of the distance leaves seven digits for the body itself. */
    for (int k = 0; k < out->dim && n > 0; k++) {
        double width = out->high[k] - out->low[k], far = fmax (fabs (out->low[k]), fabs (out->high[k]));
        if (!(width > 1e-9 * far)) {
            pg_scene_fault (scene, "body",
                            "lies %.3g m away from the origin along %c and is %.3g m wide: its size is lost "
                            "in rounding; move it nearer",
                            far, "xyz"[k], width);
            break;
        }
    }
    PG_TRY (pg_scene_verdict (scene));
done:
    return status;
}

/* Reads the shapes of the body, subtracts the slots of cracks, and adds the layers. */
pg_status pg_body_read_cut (pg_body *out, const pg_scene *scene, size_t slots, pg_shape *slot)
{
    pg_status status = PG_OK;
    PG_TRY (read_shapes (out, scene, slots));
    for (size_t i = 0; i < slots; i++) {
        pg_shape *s = &out->shape[out->n++];
        *s = slot[i], slot[i] = (pg_shape) { 0 };
        pg_shape_types[s->kind].box (s, out->dim, s->box, s->box + 3);
    }
    PG_TRY (pg_layers_read (out, scene));
    PG_TRY (pg_scene_verdict (scene));
done:
    if (status != PG_OK) pg_body_clear (out);
    return status;
}

pg_status pg_body_read_uncut (pg_body *out, const pg_scene *scene)
{
    return pg_body_read_cut (out, scene, 0, NULL);
}

/* Frees what a body holds and zeroes it, also where it was read in part only. */
void pg_body_clear (pg_body *body)
{
    for (size_t i = 0; body->shape && i < body->n; i++)
        pg_free (body->shape[i].vertex), shape_mesh_clear (&body->shape[i]);
    pg_free (body->shape), pg_free (body->layer);
    memset (body, 0, sizeof *body);
}

/* Does x certainly lie outside a slot, judged by the slot's box? Of the many slots of a network most are far
 * away. */
static int misses_slot (const pg_shape *s, int dim, const double *x)
{
    for (int k = 0; k < dim; k++) if (x[k] < s->box[k] || x[k] > s->box[3 + k]) return 1;
    return 0;
}

double pg_rounding (int dim, const double *low, const double *high)
{
    double far = 0;
    for (int k = 0; k < dim; k++) far = fmax (far, fmax (fabs (low[k]), fabs (high[k])));
    return 4 * DBL_EPSILON * far;
}

/* Returns 1 for positions in the body or within `tolerance` (m) of its surface, on either side of it: a
 * subtracted shape must hold a position by more than that. Shapes that cannot change the result so far are
 * skipped. Shapes need to compute distances only up to the tolerance. */
int pg_body_inside (const pg_body *body, const double *x, double tolerance)
{
    int in = 0;
    for (size_t i = 0; i < body->n; i++) {
        const pg_shape *s = &body->shape[i];
        /* An added shape cannot take away, a subtracted one cannot add. */
        if (in == s->add || (s->slot && tolerance >= 0 && misses_slot (s, body->dim, x))) continue;
        double d = pg_shape_types[s->kind].distance (s, body->dim, x, tolerance);
        in = s->add ? d <= tolerance : !(d < -tolerance);
    }
    return in;
}

const char *pg_shape_kind (const pg_shape *shape) { return pg_shape_types[shape->kind].name; }

/* Returns the shape whose surface is nearest to x, and its unsigned distance, m. The least distance so far is
 * passed as the reach to the next shape, which may stop early beyond it. */
size_t pg_body_nearest (const pg_body *body, const double *x, double *distance)
{
    size_t nearest = 0;
    double least = INFINITY;
    for (size_t i = 0; i < body->n; i++) {
        double d = fabs (pg_shape_types[body->shape[i].kind].distance (&body->shape[i], body->dim, x, least));
        if (d < least) least = d, nearest = i;
    }
    if (distance) *distance = least;
    return nearest;
}
