/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads `cracks` of the input file: in 2D segments, polylines, and outlines (polygon, ellipse) of slots; in
 * 3D polygons, discs, ellipses; many of them from a file. An entry that certainly does not meet the body is
 * an error: most likely its coordinates are in other units. */
#include "crack.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- the list of cracks ---------------------------------------------------------------------------------
 */
pg_crack *crack_next (crack_list *list)
{
    pg_status status = PG_OK;
    pg_crack *c = NULL;
    PG_GROW (list->all->crack, list->capacity, list->all->n + 1);
    c = &list->all->crack[list->all->n++];
    memset (c, 0, sizeof *c);
    c->entry = list->entry, c->slot = list->width;
done:
    return status == PG_OK ? c : NULL;
}

/* Reports what is wrong with the crack of this entry (why, if not NULL). */
static pg_status settle (crack_list *list, pg_status status, const char *what, const char *why)
{
    if (status == PG_OK && why) pg_scene_fault (list->scene, list->at, "%s %s", what, why);
    return status;
}

/* ---- reading each kind of crack -------------------------------------------------------------------------
 */
/* Reads a segment from its ends, `from` and `to`. */
static pg_status read_segment (crack_list *list)
{
    double from[3] = { 0 }, to[3] = { 0 };
    const char *why;
    if (!pg_scene_given (list->scene, "%s.to", list->at)) {
        pg_scene_fault (list->scene, list->at, "from needs to: the other end of the crack");
        return PG_OK;
    }
    pg_scene_vector (list->scene, 2, from, "%s.from", list->at);
    pg_scene_vector (list->scene, 2, to, "%s.to", list->at);
    pg_crack *c = crack_next (list);
    if (!c) return PG_E_MEMORY;
    pg_status status = crack_segment (c, from, to, &why);
    return settle (list, status, "the crack", why);
}

/* Reads a list of vertices [x, y] or [x, y, z], m; *n of them. */
static pg_status read_vertices (double **out, size_t *n, const crack_list *list, const char *key)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) list->all->dim;
    *n = pg_scene_count (list->scene, "%s.%s", list->at, key);
    PG_ALLOC (*out, dim * *n);
    for (size_t i = 0; i < *n; i++)
        pg_scene_vector (list->scene, (int) dim, *out + dim * i, "%s.%s[%zu]", list->at, key, i);
done:
    return status;
}

/* Reads a polyline as a segment from each vertex to the next. */
static pg_status read_polyline (crack_list *list)
{
    pg_status status = PG_OK;
    double *vertex = NULL;
    size_t n;
    const char *why;
    PG_TRY (read_vertices (&vertex, &n, list, "polyline"));
    if (n < 2) pg_scene_fault (list->scene, list->at, "the polyline needs two vertices or more");
    for (size_t i = 1; i < n; i++) {
        pg_crack *c = crack_next (list);
        if (!c) PG_FAIL (PG_E_MEMORY, "no memory for a crack");
        PG_TRY (crack_segment (c, vertex + 2*i - 2, vertex + 2*i, &why));
        c->bend = i > 1;
        if (why) {
            pg_scene_fault (list->scene, list->at,
                            "the polyline has the same vertex twice in a row: %zu and %zu", i, i + 1);
            break;
        }
    }
done:
    pg_free (vertex);
    return status;
}

/* Reads a polygon: in 2D the outline of a slot, in 3D the crack itself. */
static pg_status read_polygon (crack_list *list)
{
    pg_status status = PG_OK;
    double *vertex = NULL;
    size_t n;
    const char *why;
    PG_TRY (read_vertices (&vertex, &n, list, "polygon"));
    pg_crack *c = crack_next (list);
    if (!c) PG_FAIL (PG_E_MEMORY, "no memory for a crack");
    PG_TRY (list->all->dim == 2 ? crack_outline (c, n, vertex, &why) : crack_polygon (c, n, vertex, &why));
    PG_TRY (settle (list, PG_OK, "the polygon", why));
done:
    pg_free (vertex);
    return status;
}

/* Reads a disc: its centre, normal and radius. */
static pg_status read_disc (crack_list *list)
{
    double centre[3] = { 0 }, normal[3] = { 0 };
    const char *why;
    pg_scene_vector (list->scene, 3, centre, "%s.disc.center", list->at);
    pg_scene_vector (list->scene, 3, normal, "%s.disc.normal", list->at);
    pg_crack *c = crack_next (list);
    pg_status status = c ? crack_disc (c, centre, normal,
                                       pg_scene_number (list->scene, "%s.disc.radius", list->at), &why)
                         : PG_E_MEMORY;
    return settle (list, status, "the", status == PG_OK ? why : NULL);
}

/* Reports a key of an ellipse that belongs to the other dimension. */
static void refuse_key (const crack_list *list, const char *key, const char *instead)
{
    char path[96];
    snprintf (path, sizeof path, "%s.ellipse.%s", list->at, key);
    if (pg_scene_given (list->scene, "%s", path))
        pg_scene_fault (list->scene, path, "is for %dD; here %s", 5 - list->all->dim, instead);
}

static pg_status read_ellipse (crack_list *list)
{
    double centre[3] = { 0 }, normal[3] = { 0 }, along[3] = { 0 }, size[2];
    const char *why = NULL, *at = list->at;
    const pg_scene *scene = list->scene;
    pg_status status;
    pg_scene_vector (scene, 3, centre, "%s.ellipse.center", at);
    size[0] = pg_scene_number (scene, "%s.ellipse.length", at);
    size[1] = pg_scene_number (scene, "%s.ellipse.breadth", at);
    if (size[1] > size[0]) {
        pg_scene_fault (scene, at, "the ellipse is broader than long: %g m and %g m", size[1], size[0]);
        return PG_OK;
    }
    pg_crack *c = crack_next (list);
    if (!c) return PG_E_MEMORY;
    if (list->all->dim == 2) {
        refuse_key (list, "normal", "angle says how the ellipse lies");
        refuse_key (list, "along", "angle says how the ellipse lies");
        status = crack_slot_ellipse (c, centre, size[0], size[1],
                                     pg_scene_number (scene, "%s.ellipse.angle", at), &why);
        return settle (list, status, "the ellipse", why);
    }
    refuse_key (list, "angle", "normal and along say how the ellipse lies");
    if (!pg_scene_given (scene, "%s.ellipse.normal", at) || !pg_scene_given (scene, "%s.ellipse.along", at)) {
        pg_scene_fault (scene, at, "in 3D an ellipse needs normal and along, the direction of its length");
        return PG_OK;
    }
    pg_scene_vector (scene, 3, normal, "%s.ellipse.normal", at);
    pg_scene_vector (scene, 3, along, "%s.ellipse.along", at);
    status = crack_ellipse (c, centre, normal, along, size[0], size[1], &why);
    return settle (list, status, "the ellipse: its", why);
}

/* ---- an entry of the list -------------------------------------------------------------------------------
 */
/* The keys that give a crack: in which dimensions, whether it can have a width there (bit 2, bit 3). */
static const struct { const char *key; int lowest, highest, wide; pg_status (*read) (crack_list *);
} kinds[] = {
    { "from", 2, 2, 1 << 2, read_segment },         { "polyline", 2, 2, 1 << 2, read_polyline },
    { "polygon", 2, 3, 1 << 3, read_polygon },      { "disc", 3, 3, 1 << 3, read_disc },
    { "ellipse", 2, 3, 1 << 3, read_ellipse },      { "file", 2, 3, 1 << 2 | 1 << 3, crack_read_file },
    { "random", 2, 3, 1 << 2 | 1 << 3, crack_read_random },
};
enum { KINDS = sizeof kinds / sizeof *kinds };

/* Reads the width of an entry, m; 0: none. outline 1: the crack is an outline, which takes no width. */
static double read_width (const crack_list *list, int outline)
{
    char path[96];
    snprintf (path, sizeof path, "%s.width", list->at);
    if (!pg_scene_given (list->scene, "%s", path)) return 0;
    double spacing = pg_scene_given (list->scene, "spacing") ? pg_scene_number (list->scene, "spacing") : NAN,
           width = pg_scene_length (list->scene, spacing, "%s", path);
    if (outline) pg_scene_fault (list->scene, path, "an outline is the whole slot: leave width out");
    else if (isnan (width))
        pg_scene_fault (list->scene, path, "there is no spacing: give a length in m, mm ...");
    return isnan (width) ? 0 : width;
}

/* Reads the current entry, cracks[list->entry]. */
static pg_status read_entry (crack_list *list)
{
    int dim = list->all->dim, k = 0;
    while (k < KINDS && !pg_scene_given (list->scene, "%s.%s", list->at, kinds[k].key)) k++;
    if (dim == 1) pg_scene_fault (list->scene, list->at, "a crack needs dimension 2 or 3");
    /* The kind of crack must fit the dimension. */
    else if (k == KINDS || dim < kinds[k].lowest || dim > kinds[k].highest)
        pg_scene_fault (list->scene, list->at,
                        dim == 2
                            ? "in 2D give from and to, a polyline, or the outline of a slot: a polygon or "
                              "an ellipse; a file, or random"
                            : "in 3D give a polygon or a disc, an ellipse, a file, or random");
    else if (k > 0 && pg_scene_given (list->scene, "%s.to", list->at))
        pg_scene_fault (list->scene, list->at, "to belongs to from, in 2D");
    else {
        list->width = read_width (list, !(kinds[k].wide >> dim & 1));
        return kinds[k].read (list);
    }
    return PG_OK;
}

/* Reports an entry outside the body, and where the body is. */
static void fault_outside (const crack_list *list, size_t entry)
{
    char text[128], at[64];
    int n = 0;
    for (int k = 0; k < list->body->dim; k++)
        n += snprintf (text + n, sizeof text - (size_t) n, "%s%c %.5g to %.5g m", k ? ", " : "", "xyz"[k],
                       list->body->low[k], list->body->high[k]);
    snprintf (at, sizeof at, "cracks[%zu]", entry);
    pg_scene_fault (list->scene, at, "lies outside the body, which fills %s", text);
}

/* Reports entries no piece of which meets the body. */
static void find_outside (const crack_list *list)
{
    const pg_cracks *all = list->all;
    for (size_t i = 0, last; i < all->n; i = last) {
        int meets = 0;
        for (last = i; last < all->n && all->crack[last].entry == all->crack[i].entry; last++)
            meets = meets || crack_may_meet (list->body, &all->crack[last]);
        if (!meets) fault_outside (list, all->crack[i].entry);
    }
}

/* Reports slots in a body that is not given by shapes: they can be cut out of shapes only. */
static void refuse_slots (const crack_list *list)
{
    const pg_cracks *all = list->all;
    if (list->body->n > 0) return;
    for (size_t i = 0; i < all->n; i++) {
        char at[64];
        if (!pg_crack_is_slot (&all->crack[i])) continue;
        snprintf (at, sizeof at, "cracks[%zu]", all->crack[i].entry);
        pg_scene_fault (
            list->scene, at,
            "material is removed from a body of shapes only: leave the slot out of the mesh or of "
            "the points, or give a sharp crack");
        return;
    }
}

/* Reads all cracks, and the body only to see whether they meet it. */
pg_status crack_read_all (pg_cracks *out, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_body body = {0};
    size_t n = pg_scene_count (scene, "cracks");
    crack_list list = { .scene = scene, .body = &body, .all = out };
    memset (out, 0, sizeof *out);
    out->dim = (int) pg_scene_integer (scene, "dimension");
    if (n > 0) PG_TRY (pg_body_read_uncut (&body, scene));
    for (list.entry = 0; list.entry < n; list.entry++) {
        snprintf (list.at, sizeof list.at, "cracks[%zu]", list.entry);
        PG_TRY (read_entry (&list));
    }
    PG_TRY (pg_scene_verdict (scene));
    if (body.n > 0) find_outside (&list);
    refuse_slots (&list);
    PG_TRY (pg_scene_verdict (scene));
done:
    pg_body_clear (&body);
    if (status != PG_OK) pg_cracks_clear (out);
    return status;
}

/* Reads all cracks and keeps the sharp ones (slots 0) or the slots (1). */
static pg_status read_some (pg_cracks *out, const pg_scene *scene, int slots)
{
    pg_status status = PG_OK;
    size_t kept = 0;
    PG_TRY (crack_read_all (out, scene));
    for (size_t i = 0; i < out->n; i++) {
        if (pg_crack_is_slot (&out->crack[i]) == slots) out->crack[kept++] = out->crack[i];
        else pg_free (out->crack[i].vertex);
    }
    out->n = kept;
    PG_TRY (pg_cracks_index (out));
done:
    if (status != PG_OK) pg_cracks_clear (out);
    return status;
}

pg_status pg_network_read (pg_cracks *out, const pg_scene *scene) { return crack_read_all (out, scene); }

pg_status pg_cracks_read (pg_cracks *out, const pg_scene *scene) { return read_some (out, scene, 0); }

pg_status pg_slots_read (pg_cracks *out, const pg_scene *scene)
{
    memset (out, 0, sizeof *out);
    out->dim = (int) pg_scene_integer (scene, "dimension");
    return crack_slots_given (scene) ? read_some (out, scene, 1) : PG_OK;
}

/* Reads the body and subtracts the slots among its cracks. */
pg_status pg_body_read (pg_body *out, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_cracks cracks = { 0 };
    pg_shape *slot = NULL;
    size_t n = 0;
    memset (out, 0, sizeof *out);
    if (crack_slots_given (scene)) PG_TRY (crack_read_all (&cracks, scene));
    n = crack_slot_count (&cracks);
    if (n) PG_ALLOC (slot, n);
    if (n) PG_TRY (crack_slot_shapes (slot, &cracks));
    PG_TRY (pg_body_read_cut (out, scene, n, slot));
done:
    for (size_t i = 0; slot && i < n; i++) pg_free (slot[i].vertex);
    pg_free (slot);
    pg_cracks_clear (&cracks);
    return status;
}
