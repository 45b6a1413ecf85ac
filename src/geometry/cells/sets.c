/* SPDX-License-Identifier: GPL-3.0-or-later
 * Named sets: the sides of the bounding box and `all`, the sets of the mesh, boundary layers, the sets of the
 * input file (scene), and the parts of shapes that the scene names elsewhere; each with its halves NAME.left,
 * NAME.top, ... A set of the scene begins with its boundary, or with everything, and its other conditions
 * remove points and facets. Errors of the user are collected: one wrong set does not hide the errors of the
 * next. */
#include "cut.h"
#include "mark.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* The sets under construction. faces: 1: the current marks come from boundary faces, so that the set has no
 * interior points. by_faces: 1: they come from a side set of a mesh. */
typedef struct {
    pg_sets *out; size_t capacity; pg_marks marks; const pg_scene *scene; int faces, by_faces;
} builder;

/* ---- from marks to sets -------------------------------------------------------------------------------- */
/* Indices, ascending, of the marked items among `all`; side >= 0: only those whose position x is beyond the
 * centre on that side. */
static pg_status gather (int **out, size_t *n, const pg_marks *m, const unsigned char *mark, size_t all,
                         const double *x, int side)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) m->cloud->dim, k = 0;
    *n = 0;
    for (size_t i = 0; i < all; i++) *n += mark[i] && (side < 0 || pg_marks_beyond (m, side, x + i * dim));
    PG_ALLOC (*out, *n);
    for (size_t i = 0; i < all; i++)
        if (mark[i] && (side < 0 || pg_marks_beyond (m, side, x + i * dim))) (*out)[k++] = (int) i;
done:
    return status;
}

/* The points of s that belong to none of its facets: they have to be constrained apart from the facets. */
static pg_status gather_inner (pg_set *s, const pg_marks *m)
{
    pg_status status = PG_OK;
    unsigned char *reached = NULL;
    if (s->nfacet == 0 || s->npoint == 0) return PG_OK;
    PG_ALLOC (reached, m->cloud->n);
    for (size_t k = 0; k < s->nfacet; k++)
        for (size_t q = m->facet_first[s->facet[k]]; q < m->facet_first[s->facet[k] + 1]; q++)
            reached[m->facet_point[q]] = 1;
    for (size_t k = 0; k < s->npoint; k++) s->ninner += !reached[s->point[k]];
    if (s->ninner == 0) goto done;
    PG_ALLOC (s->inner, s->ninner);
    size_t at = 0;
    for (size_t k = 0; k < s->npoint; k++) if (!reached[s->point[k]]) s->inner[at++] = s->point[k];
done:
    pg_free (reached);
    return status;
}

/* Appends the set `name`, or its half on one side, from the present marks. */
static pg_status add_one (builder *b, const char *name, int side)
{
    pg_status status = PG_OK;
    const pg_marks *m = &b->marks;
    PG_GROW (b->out->set, b->capacity, b->out->n + 1);
    pg_set *s = &b->out->set[b->out->n];
    memset (s, 0, sizeof *s);
    /* From here on the set is released with all others. */
    b->out->n++;
    snprintf (s->name, sizeof s->name, "%.56s%s%s", name, side < 0 ? "" : ".",
              side < 0 ? "" : pg_side_names[side]);
    PG_TRY (gather (&s->point, &s->npoint, m, m->point, m->cloud->n, m->cloud->x, side));
    PG_TRY (gather (&s->facet, &s->nfacet, m, m->facet, m->cells->nfacet, m->cells->facet_centre, side));
    s->by_faces = b->faces || b->by_faces;
    if (!b->faces) PG_TRY (gather_inner (s, m));
    double all[3] = { 0, (double) s->nfacet, 0 };
    for (size_t i = 0; i < s->npoint; i++) all[0] += pg_cloud_owns (m->cloud, (size_t) s->point[i]);
    for (size_t i = 0; i < s->ninner; i++) all[2] += pg_cloud_owns (m->cloud, (size_t) s->inner[i]);
    PG_TRY (pg_cloud_sum (m->cloud, 3, all));
    s->all_points = (size_t) all[0], s->all_facets = (size_t) all[1], s->all_inner = (size_t) all[2];
done:
    return status;
}

/* Appends the set and all its halves. */
static pg_status add_set (builder *b, const char *name)
{
    pg_status status = PG_OK;
    for (int side = -1; side < 2 * b->marks.cloud->dim; side++) PG_TRY (add_one (b, name, side));
done:
    return status;
}

/* Adds the sets of the sides, `all`, and those sets of the mesh whose names are not taken yet. */
static pg_status add_predefined (builder *b)
{
    pg_status status = PG_OK;
    b->faces = 1;
    for (int side = 0; side < 2 * b->marks.cloud->dim; side++) {
        pg_marks_fill (&b->marks, 0);
        pg_marks_boundary (&b->marks, pg_side_names[side]);
        PG_TRY (add_set (b, pg_side_names[side]));
    }
    b->faces = 0;
    pg_marks_fill (&b->marks, 1);
    PG_TRY (add_set (b, "all"));
    for (size_t i = 0; i < b->marks.cells->ngiven; i++) {
        const char *name = b->marks.cells->given[i].name;
        /* A set of the mesh called left, top ... has taken the place of the predefined one. */
        if (pg_sets_find (b->out, name)) continue;
        pg_marks_fill (&b->marks, 0);
        pg_marks_boundary (&b->marks, name);
        b->by_faces = b->marks.cells->given[i].by_faces;
        PG_TRY (add_set (b, name));
    }
    b->by_faces = 0;
done:
    return status;
}

/* Adds one set for each boundary layer: the points in it and the facets of its cells. Points at lattice
 * vertices belong to the layer only beyond half a step from the face where the body ends and the layer
 * begins: that face belongs to the body, also where points are perturbed. */
static pg_status add_layers (builder *b)
{
    pg_status status = PG_OK;
    const pg_cells *c = b->marks.cells;
    const pg_body *body = b->marks.body;
    const char *kind = pg_scene_text (b->scene, "lattice");
    size_t dim = (size_t) c->dim;
    for (size_t i = 0; i < body->nlayer; i++) {
        double step = b->marks.cloud->step[body->layer[i].side / 2],
               margin = kind && !strcmp (kind, "cells") ? 0 : 0.5 * step;
        pg_marks_fill (&b->marks, 0);
        for (size_t p = 0; p < b->marks.cloud->n; p++)
            b->marks.point[p] = pg_body_layer (body, b->marks.cloud->x + p * dim, margin) == (long) i;
        for (size_t f = 0; f < c->nfacet; f++) {
            double middle[3] = {0};
            size_t first = c->start[c->facet_cell[f]], last = c->start[c->facet_cell[f] + 1];
            for (size_t k = first; k < last; k++)
                for (size_t a = 0; a < dim; a++) middle[a] += c->x[k * dim + a] / (double) (last - first);
            b->marks.facet[f] = pg_body_layer (body, middle, 0) == (long) i;
        }
        PG_TRY (add_set (b, body->layer[i].name));
    }
done:
    return status;
}

/* ---- conditions of a set ------------------------------------------------------------------------------- */
/* Angle in [0, 2 pi), counter-clockwise from the x axis. */
static double angle_of (double y, double x)
{
    double a = atan2 (y, x);
    return a < 0 ? a + 2 * acos (-1) : a;
}

/* Condition `where`: the expression (context) is true at x. */
static int holds (const pg_marks *m, const double *x, const void *context)
{
    pg_place at = {0};
    at.x = x[0];
    at.y = m->cloud->dim > 1 ? x[1] : 0;
    at.z = m->cloud->dim > 2 ? x[2] : 0;
    at.r = sqrt (at.x*at.x + at.y*at.y + at.z*at.z);
    at.angle = angle_of (at.y, at.x);
    return pg_expression_value (context, &at) != 0;
}

/* Ranges of angles: n pairs {from, span}, rad. */
typedef struct { size_t n; double *range; } ranges;

/* Condition `angle`: the direction from the centre of the body to x lies in one of the ranges, ends
 * included to 1e-9 rad. A position at the centre itself has no direction and does not meet it. */
static int in_ranges (const pg_marks *m, const double *x, const void *context)
{
    const ranges *r = context;
    double dx = x[0] - m->centre[0], dy = x[1] - m->centre[1], turn = 2 * acos (-1),
           same = 1e-9 * m->size + pg_rounding (m->cloud->dim, m->low, m->high), away = hypot (dx, dy),
           tolerance = 1e-9 + same / away;
    if (!(away > same)) return 0;
    for (size_t i = 0; i < r->n; i++) {
        /* Angle past the beginning of the range, in [0, 2 pi). */
        double past = fmod (angle_of (dy, dx) - r->range[2*i], turn);
        if (past < 0) past += turn;
        if (past <= r->range[2*i + 1] + tolerance || past >= turn - tolerance) return 1;
    }
    return 0;
}

/* Appends the ray at this angle unless there is one already, to the tolerance of in_ranges: ranges that
 * adjoin share an end. */
static pg_status add_ray (pg_ray **out, size_t *n, size_t *capacity, const pg_body *body, double angle)
{
    pg_status status = PG_OK;
    double x = cos (angle), y = sin (angle);
    for (size_t k = 0; k < *n; k++)
        if (hypot ((*out)[k].direction[0] - x, (*out)[k].direction[1] - y) <= 1e-9) return PG_OK;
    PG_GROW (*out, *capacity, *n + 1);
    pg_ray *ray = *out + (*n)++;
    for (int a = 0; a < 2; a++) ray->centre[a] = 0.5 * (body->low[a] + body->high[a]);
    ray->direction[0] = x, ray->direction[1] = y;
done:
    return status;
}

/* Ranges that are no pairs are skipped here; keep_angles reports them. */
pg_status pg_sets_rays (pg_ray **out, size_t *n, const pg_scene *scene, const pg_body *body)
{
    pg_status status = PG_OK;
    const char *name;
    size_t capacity = 0;
    *out = NULL, *n = 0;
    for (size_t i = 0; body->dim > 1 && (name = pg_scene_name (scene, i, "sets")); i++)
        for (size_t k = 0; k < pg_scene_count (scene, "sets.%s.angle", name); k++) {
            double v[2] = {0, 0};
            /* not a pair: keep_angles reports it */
            if (pg_scene_count (scene, "sets.%s.angle[%zu]", name, k) != 2) continue;
            pg_scene_vector (scene, 2, v, "sets.%s.angle[%zu]", name, k);
            for (int e = 0; e < 2; e++) PG_TRY (add_ray (out, n, &capacity, body, v[e]));
        }
done:
    return status;
}

/* Reports a fault where a marked facet lies in a cell that more rays come near than can divide it: it would
 * be inside and outside of a range at once. This needs a surface within a cell's size of the centre, where
 * all rays begin. */
static void check_rays (const builder *b, const char *at)
{
    const pg_cells *c = b->marks.cells;
    for (size_t f = 0; f < c->nfacet; f++) {
        const double *x = c->facet_centre + f * (size_t) c->dim;
        size_t n = b->marks.facet[f] ? cut_half_planes_near (c, f) : 0;
        if (n <= CUT_HALF_PLANES) continue;
        pg_scene_fault (b->scene, at,
                        "%zu ends of ranges meet in one cell, at the surface near (%.4g, %.4g) m: at most "
                        "%d can; take a smaller spacing, or fewer ranges", n, x[0], x[1], CUT_HALF_PLANES);
        return;
    }
}

/* Reads the ranges of a set and applies them. [350 deg, 10 deg] passes through 0; a span of a full turn or
 * more is the whole circle. */
static pg_status keep_angles (builder *b, const char *name)
{
    pg_status status = PG_OK;
    ranges r = {pg_scene_count (b->scene, "sets.%s.angle", name), NULL};
    double turn = 2 * acos (-1);
    char at[128];
    snprintf (at, sizeof at, "sets.%s.angle", name);
    PG_ALLOC (r.range, 2 * r.n);
    if (r.n == 0) pg_scene_fault (b->scene, at, "has no range");
    if (b->marks.cloud->dim == 1) pg_scene_fault (b->scene, at, "needs dimension 2 or 3");
    for (size_t i = 0; i < r.n; i++) {
        double v[2] = {0, 0};
        if (pg_scene_count (b->scene, "%s[%zu]", at, i) != 2) {
            pg_scene_fault (b->scene, at, "range %zu must be a pair [from, to]", i + 1);
            continue;
        }
        pg_scene_vector (b->scene, 2, v, "%s[%zu]", at, i);
        double span = v[1] - v[0];
        /* A range that ends before it begins passes through 0: [350 deg, 10 deg]. */
        if (fabs (span) < turn) span = span < 0 ? span + turn : span;
        else span = turn;
        r.range[2*i] = v[0], r.range[2*i + 1] = span;
    }
    check_rays (b, at);
    if (b->marks.cloud->dim > 1) pg_marks_keep (&b->marks, in_ranges, &r);
done:
    pg_free (r.range);
    return status;
}

/* Reads and applies `where`. An expression that depends on the time is a fault. */
static pg_status keep_where (builder *b, const char *name)
{
    pg_status status = PG_OK;
    pg_expression *e = NULL;
    char at[128];
    snprintf (at, sizeof at, "sets.%s.where", name);
    PG_TRY (pg_expression_compile (&e, pg_scene_text (b->scene, "%s", at), "bool"));
    if (pg_expression_uses (e, 't')) pg_scene_fault (b->scene, at, "a set does not change with t");
    else pg_marks_keep (&b->marks, holds, e);
done:
    pg_expression_free (&e);
    return status;
}

/* Remembers the planes of the bounding box and the names of all parts, for messages about empty sides. */
static void describe_empty (pg_sets *out, const builder *b)
{
    const pg_marks *m = &b->marks;
    cells_parts_list (m->body, out->parts, sizeof out->parts);
    for (int side = 0; side < 2 * m->cloud->dim; side++)
        out->plane[side] = side % 2 ? m->high[side / 2] : m->low[side / 2];
}

/* Number of the predefined side of that name, -1: none in this dimension. */
static int side_of (const pg_sets *sets, const char *name)
{
    for (int side = 0; side < PG_SIDES; side++)
        if (!strcmp (name, pg_side_names[side])) return sets->plane[side] == sets->plane[side] ? side : -1;
    return -1;
}

int pg_sets_empty_side (const pg_sets *sets, const pg_set *set)
{
    return pg_set_points (set) == 0 && pg_set_facets (set) == 0 && side_of (sets, set->name) >= 0;
}

/* Reports that a set names a side on which the body has no face: says where its plane is and what could be
 * meant. */
static void fault_empty_side (const pg_sets *sets, const pg_scene *scene, const char *path, const char *name)
{
    int side = side_of (sets, name);
    pg_scene_fault (scene, path,
                    "%s is the part of the surface in the plane %c = %.6g m of the bounding box, where the "
                    "body has no face: a round or slanted body "
                    "touches it only. Name the part that is meant, by sets: {NAME: {boundary: all, angle: "
                    "[[80 deg, 100 deg]]}} or {NAME: {boundary: SHAPE.PART}}%s%s%s",
                    name, "xyz"[side / 2], sets -> plane[side], *sets -> parts ? " (here: " : "", sets->parts,
                    *sets->parts ? ")" : "");
}

/* Appends the names of the surfaces of shapes, each once, and of the sides of meshes; as many as fit. Returns
 * the new length. */
static size_t list_surfaces (const pg_body *body, char *names, size_t used, size_t size)
{
    for (size_t i = 0; i < body->n && used + 34 < 400; i++) {
        const pg_shape *shape = &body->shape[i];
        const char *side;
        size_t k = 0;
        while (shape->kind == PG_MESH && (side = pg_shape_side (shape, k)) && used + 100 < 400)
            used += (size_t) snprintf (names + used, size - used, "|%s", side), k++;
        k = 0;
        while (k < i && strcmp (body->shape[k].boundary, shape->boundary)) k++;
        if (k == i) used += (size_t) snprintf (names + used, size - used, "|%s", shape->boundary);
    }
    return used;
}

/* Reports an unknown `boundary`: lists all names, and suggests the nearest. */
static void unknown_boundary (const builder *b, const char *at, const char *name)
{
    char names[800] = "";
    size_t used = 0;
    /* Sides of the box, surfaces of shapes and side sets of their meshes, sets of the mesh. */
    for (int s = 0; s < 2 * b->marks.cloud->dim; s++)
        used += (size_t) snprintf (names + used, sizeof names - used, "%s|", pg_side_names[s]);
    used += (size_t) snprintf (names + used, sizeof names - used, "all");
    if (b->marks.cells->nfacet > 0) used = list_surfaces (b->marks.body, names, used, sizeof names);
    for (size_t i = 0; i < b->marks.cells->ngiven && used + 60 < 400; i++)
        used += (size_t) snprintf (names + used, sizeof names - used, "|%s", b->marks.cells->given[i].name);
    if (*b->out->parts && used + 2 < sizeof names)
        snprintf (names + used, sizeof names - used, "; parts of shapes: %s", b->out->parts);
    char list[400];
    snprintf (list, sizeof list, "%.*s", (int) used, names);
    const char *near = pg_nearest_name (name, list);
    if (near)
        pg_scene_fault (b->scene, at, "no boundary is called '%.40s'; did you mean %s? (%s)", name, near,
                        names);
    else pg_scene_fault (b->scene, at, "no boundary is called '%.40s'; there are %s", name, names);
}

/* Marks all boundaries that the set names; reports each unknown name or empty side. Returns 0 if there was
 * one. */
static int mark_boundaries (builder *b, const char *name)
{
    const char *part;
    char at[128];
    int known = 1;
    snprintf (at, sizeof at, "sets.%s.boundary", name);
    pg_marks_fill (&b->marks, 0);
    for (size_t i = 0; (part = pg_scene_name (b->scene, i, "%s", at)); i++) {
        const pg_set *side = side_of (b->out, part) >= 0 ? pg_sets_find (b->out, part) : NULL;
        if (side && pg_sets_empty_side (b->out, side)) fault_empty_side (b->out, b->scene, at, part);
        else if (pg_marks_boundary (&b->marks, part)) continue;
        else unknown_boundary (b, at, part);
        known = 0;
    }
    return known;
}

/* ---- sets of the input file ---------------------------------------------------------------------------- */
/* Is any of n marks set? */
static int marked (const unsigned char *mark, size_t n) { return n > 0 && memchr (mark, 1, n) != NULL; }

/* Returns the message for a set of the input file whose name is taken already. */
static const char *why_taken (const builder *b)
{
    if (b->marks.cells->ngiven) return "this set is always there or comes with the mesh, choose another name";
    if (b->marks.body->nlayer) return "this set is always there or is a layer, choose another name";
    return "this set is always there, choose another name";
}

/* Reports the fault `why` and adds an empty set of that name, so that references to it can still be
 * checked. */
static pg_status refuse_set (builder *b, const char *name, const char *at, const char *why)
{
    int side = b->marks.cells->ngiven ? -1 : side_of (b->out, name);
    if (side >= 0)
        pg_scene_fault (b->scene, at,
                        "%s is always there, the part of the surface in the plane %c = %.6g m, and would "
                        "have two meanings: choose another name",
                        name, "xyz"[side / 2], b->out->plane[side]);
    else pg_scene_fault (b->scene, at, "%s", why);
    pg_marks_fill (&b->marks, 0);
    return pg_sets_find (b->out, name) || strlen (name) > 56 ? PG_OK : add_set (b, name);
}

/* Adds a set of the input file (scene). After a fault in it, it is added empty, so that the rest of the scene
 * that names it brings no fault of its own. */
static pg_status add_named (builder *b, const char *name)
{
    pg_status status = PG_OK;
    const pg_scene *s = b->scene;
    char at[96];
    int boundary = pg_scene_given (s, "sets.%s.boundary", name),
        angle = pg_scene_given (s, "sets.%s.angle", name);
    int where = pg_scene_given (s, "sets.%s.where", name), known = 1;
    /* Faults of the name or of an empty description; more than one reason is not reported. */
    const char *why = !boundary && !angle && !where ? "give boundary, angle or where" : NULL;
    snprintf (at, sizeof at, "sets.%.80s", name);
    if (strlen (name) > 56) why = "at most 56 letters in the name of a set";
    else if (!why && pg_sets_find (b->out, name)) why = why_taken (b);
    if (why) return refuse_set (b, name, at, why);
    pg_marks_fill (&b->marks, 1);
    b->faces = boundary;
    if (boundary) known = mark_boundaries (b, name);
    if (angle) PG_TRY (keep_angles (b, name));
    if (where) PG_TRY (keep_where (b, name));
    double any = marked (b->marks.point, b->marks.cloud->n)
                 || marked (b->marks.facet, b->marks.cells->nfacet);
    PG_TRY (pg_cloud_most (b->marks.cloud, 1, &any));
    if (known && !(any > 0))
        pg_scene_fault (s, at, "the set is empty: no point and no boundary facet meets its conditions");
    PG_TRY (add_set (b, name));
done:
    return status;
}

/* Adds the set for a name SHAPE.PART, or SHAPE.PART.HALF, that is used directly (`set: disk.rim`); nothing
 * where the name is no such form or is there already. */
static pg_status add_part (builder *b, const char *name)
{
    pg_status status = PG_OK;
    char base[64];
    if (!name || !strchr (name, '.') || strlen (name) > 56 || pg_sets_find (b->out, name)) return PG_OK;
    snprintf (base, sizeof base, "%s", name);
    char *last = strrchr (base, '.');
    pg_marks_fill (&b->marks, 0);
    int known = cells_mark_part (&b->marks, base);
    if (!known && last != strchr (base, '.')) {
        *last = '\0';
        known = !pg_sets_find (b->out, base) && cells_mark_part (&b->marks, base);
    }
    b->faces = 1;
    if (known) PG_TRY (add_set (b, base));
done:
    return status;
}

/* Adds the parts of shapes that the input file names directly, at any key that takes the name of a set. */
static pg_status add_parts (builder *b)
{
    pg_status status = PG_OK;
    const pg_scene *s = b->scene;
    for (size_t i = 0; i < pg_scene_count (s, "boundary"); i++)
        PG_TRY (add_part (b, pg_scene_text (s, "boundary[%zu].set", i)));
    for (size_t i = 0; i < pg_scene_count (s, "output.averages"); i++)
        PG_TRY (add_part (b, pg_scene_text (s, "output.averages[%zu].set", i)));
    const char *name;
    for (size_t i = 0; (name = pg_scene_name (s, i, "failure.exclude")); i++) PG_TRY (add_part (b, name));
    PG_TRY (add_part (b, pg_scene_text (s, "solver.stop.set")));
done:
    return status;
}

pg_status pg_sets_build (pg_sets *out, const pg_scene *scene, const pg_body *body, const pg_lattice *lattice,
                         const pg_cloud *cloud, const pg_cells *cells)
{
    pg_status status = PG_OK;
    builder b = {.out = out, .scene = scene};
    const char *name;
    memset (out, 0, sizeof *out);
    for (int side = 0; side < PG_SIDES; side++) out->plane[side] = NAN;
    PG_TRY (pg_marks_create (&b.marks, body, lattice, cloud, cells));
    describe_empty (out, &b);
    PG_TRY (add_predefined (&b));
    PG_TRY (add_layers (&b));
    for (size_t i = 0; (name = pg_scene_name (scene, i, "sets")); i++) PG_TRY (add_named (&b, name));
    PG_TRY (add_parts (&b));
    PG_TRY (pg_scene_verdict (scene));
done:
    pg_marks_clear (&b.marks);
    if (status != PG_OK && status != PG_E_SCENE) pg_sets_clear (out);
    return status;
}

const pg_set *pg_sets_find (const pg_sets *sets, const char *name)
{
    for (size_t i = 0; i < sets->n; i++) if (!strcmp (sets->set[i].name, name)) return &sets->set[i];
    return NULL;
}

const pg_set *pg_sets_named (const pg_sets *sets, const pg_scene *scene, const char *path, const char *name)
{
    const pg_set *set = pg_sets_find (sets, name);
    char names[4096] = "";
    size_t at = 0;
    if (set && pg_sets_empty_side (sets, set)) fault_empty_side (sets, scene, path, name);
    if (set) return set;
    for (size_t s = 0; s < sets->n && at < sizeof names - 70; s++)
        at += (size_t) snprintf (names + at, sizeof names - at, "%s%s", at ? "|" : "", sets->set[s].name);
    const char *near = pg_nearest_name (name, names);
    pg_scene_fault (scene, path, "there is no set of this name%s%s%s", near ? " (did you mean " : "",
                    near ? near : "", near ? "?)" : "");
    return NULL;
}

void pg_sets_clear (pg_sets *sets)
{
    for (size_t i = 0; sets->set && i < sets->n; i++) {
        pg_free (sets->set[i].point);
        pg_free (sets->set[i].facet);
        pg_free (sets->set[i].inner);
    }
    pg_free (sets->set);
    memset (sets, 0, sizeof *sets);
}
