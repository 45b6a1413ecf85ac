/* SPDX-License-Identifier: GPL-3.0-or-later
 * Named parts of the surfaces of shapes, SHAPE.PART: disk.rim, box.right, polygon.edge 3, bore.rim. SHAPE is
 * the name that the input file gives the shape, or its kind; PART is rim (disk, sphere, cylinder), start or
 * end (cylinder: flat, at its center and at the far end of its axis), left right bottom top back front (box),
 * edge 1, edge 2 ... (polygon, prism: from that vertex to the next), back or front (prism: the ends of z). */
#include "cut.h"
#include "mark.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Shapes whose curved surface is called rim. */
static int is_round (const pg_shape *s)
{
    return s->kind == PG_DISK || s->kind == PG_SPHERE || s->kind == PG_CYLINDER;
}

/* ---- names of parts ------------------------------------------------------------------------------------ */
/* Number of the side called `part` among first .. 2 dim - 1, -1: none. */
static int side_named (const char *part, int first, int dim)
{
    for (int k = first; k < 2 * dim; k++) if (!strcmp (part, pg_side_names[k])) return k;
    return -1;
}

/* The number from 0 of an edge called "edge 3" or "edge_3" (both 2), of n; -1: no such edge. */
static int edge_named (const char *part, size_t n)
{
    char *end;
    if (strncmp (part, "edge", 4) || !(part[4] == ' ' || part[4] == '_')) return -1;
    long k = strtol (part + 5, &end, 10);
    return end > part + 5 && !*end && k >= 1 && k <= (long) n ? (int) k - 1 : -1;
}

/* The ends of a prism are numbered behind its n edges: n at low z, n + 1 at high z. */
int cells_part_named (const pg_shape *s, int dim, const char *part)
{
    int side;
    switch (s->kind) {
    case PG_BOX:      return side_named (part, 0, dim);
    case PG_POLYGON:  return edge_named (part, s->nvertex);
    case PG_PRISM:    side = side_named (part, 4, 3);
                      return side >= 0 ? (int) s->nvertex + side - 4 : edge_named (part, s->nvertex);
    case PG_CYLINDER: if (!strcmp (part, "start")) return 1;
                      if (!strcmp (part, "end")) return 2;
                      return strcmp (part, "rim") ? -1 : 0;
    default:          return is_round (s) && !strcmp (part, "rim") ? 0 : -1;
    }
}

/* The names of the parts of one shape, for messages; NULL: it has none. */
static const char *parts_of (const pg_shape *s, int dim)
{
    return s->kind == PG_BOX        ? dim == 1   ? "{left, right}"
                                      : dim == 2 ? "{left, right, bottom, top}"
                                                 : "{left, right, bottom, top, back, front}"
           : s->kind == PG_POLYGON  ? "edge 1 ..."
           : s->kind == PG_PRISM    ? "{edge 1 ..., back, front}"
           : s->kind == PG_CYLINDER ? "{rim, start, end}"
           : is_round (s)           ? "rim"
                                    : NULL;
}

/* Is shape i called `name` (of that length): by its own name, or by its kind ("disk")? Shapes made by
 * boundary layers only by their own. */
static int is_called (const pg_body *body, size_t i, const char *name, size_t length)
{
    const pg_shape *s = &body->shape[i];
    const char *kind = pg_shape_kind (s);
    if (s->slot) return 0;                             /* sides of slots have no names of their own */
    if (strlen (s->boundary) == length && !strncmp (s->boundary, name, length)) return 1;
    return i + body->nlayer < body->n && strlen (kind) == length && !strncmp (kind, name, length);
}

/* Shapes named rim or side by default are listed by their kind, as are holes from a mesh; equal ones once. */
void cells_parts_list (const pg_body *body, char *out, size_t size)
{
    size_t used = 0;
    *out = '\0';
    for (size_t i = 0; i + body->nlayer < body->n && used + 80 < size; i++) {
        const pg_shape *s = &body->shape[i];
        const char *generic[] = { "rim", "side", "hole" }, *name = s->boundary,
                   *parts = parts_of (s, body->dim);
        int listed = s->slot;
        for (int k = 0; k < 3; k++)
            if (!strcmp (name, generic[k]) && !(k == 2 && !pg_shape_meshed (s))) name = pg_shape_kind (s);
        for (size_t j = 0; j < i; j++)
            listed |= body->shape[j].kind == s->kind && !strcmp (body->shape[j].boundary, s->boundary);
        if (parts && !listed)
            used += (size_t) snprintf (out + used, size - used, "%s%s.%s", used ? ", " : "", name, parts);
    }
}

/* ---- facets -------------------------------------------------------------------------------------------- */
/* The edge of the polygon nearest to x (m) among those whose outward normal has a positive component along
 * the facet's normal n; -1: there is none. */
static int nearest_edge (const pg_shape *s, const double *x, const double *n)
{
    int best = -1;
    double least = INFINITY, area = 0;
    for (size_t i = 0, j = s->nvertex - 1; i < s->nvertex; j = i++)
        area += s->vertex[2 * j] * s->vertex[2 * i + 1] - s->vertex[2 * i] * s->vertex[2 * j + 1];
    /* The outward normal of a subtracted shape points into the shape. */
    double out = (area > 0) == (s->add != 0) ? 1 : -1;
    for (size_t j = 0; j < s->nvertex; j++) {
        const double *a = s->vertex + 2 * j, *b = s->vertex + 2 * ((j + 1) % s->nvertex);
        double t[2] = {b[0] - a[0], b[1] - a[1]}, size = t[0] * t[0] + t[1] * t[1];
        if (!(out * (t[1] * n[0] - t[0] * n[1]) > 0)) continue;
        double along = fmin (1, fmax (0, ((x[0] - a[0]) * t[0] + (x[1] - a[1]) * t[1]) / size));
        double d = hypot (x[0] - a[0] - along * t[0], x[1] - a[1] - along * t[1]);
        if (d < least) least = d, best = (int) j;
    }
    return best;
}

/* The part of shape s that face f of a lattice cell stands for, where the surface is a staircase: by the
 * direction of its normal, for edges by distance; -1: none. The normal of a subtracted shape is turned
 * round. */
static int part_of_stair (const pg_marks *m, const pg_shape *s, size_t f)
{
    const double *x = m->cells->facet_centre + f * (size_t) m->cells->dim,
                 *n = m->cells->normal + f * (size_t) m->cells->dim;
    int axis = 0, dim = m->cells->dim;
    for (int k = 1; k < dim; k++) if (fabs (n[k]) > fabs (n[axis])) axis = k;
    int side = 2 * axis + ((n[axis] > 0) == (s->add != 0));
    if (s->kind == PG_BOX) return side;
    if (s->kind == PG_PRISM && axis == 2) return (int) s->nvertex + side - 4;
    if (s->kind == PG_POLYGON || s->kind == PG_PRISM) return nearest_edge (s, x, n);
    if (s->kind != PG_CYLINDER || !cells_is_end (m, f)) return is_round (s) ? 0 : -1;
    double along = 0;
    for (int k = 0; k < 3; k++) along += s->axis[k] * (x[k] - s->centre[k]);
    return along < 0.5 * s->length ? 1 : 2;
}

/* Splits SHAPE.PART at the first dot: returns the length of SHAPE and lets *part begin behind it; 0: there
 * is no dot. */
static size_t split (const char *name, const char **part)
{
    const char *dot = strchr (name, '.');
    *part = dot ? dot + 1 : NULL;
    return dot ? (size_t) (dot - name) : 0;
}

/* Marks the part of every shape that is called SHAPE. Facets of a mesh belong to no shape: it has no
 * parts. */
int cells_mark_part (pg_marks *m, const char *name)
{
    const char *part;
    size_t length = split (name, &part);
    const pg_cells *c = m->cells;
    int known = 0;
    for (size_t i = 0; length && c->nfacet > 0 && !c->facet_point && i < m->body->n; i++) {
        int number = is_called (m->body, i, name, length)
                         ? cells_part_named (&m->body->shape[i], c->dim, part)
                         : -1;
        if (number < 0) continue;
        known = 1;
        for (size_t f = 0; f < c->nfacet; f++) {
            if (m->facet_shape[f] != (int) i) continue;
            const cut_surface *s = c->cut && c->facet_surface[f] >= 0 ? &c->cut->surface[c->facet_surface[f]]
                                                                      : NULL;
            if (number == (s ? s->part : part_of_stair (m, &m->body->shape[i], f))) cells_mark_facet (m, f);
        }
    }
    return known;
}
