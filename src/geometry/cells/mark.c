/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which points and facets lie on the surface of a shape, or belong to a set read with the mesh. (Sides of the
 * bounding box: sides.c; parts of shapes: parts.c.) Marks of points and facets go together: a facet marks the
 * points linked to it, so that a load on the facets and a support of the points refer to the same part of the
 * boundary. */
#include "cut.h"
#include "mark.h"
#include "sites.h"
#include <math.h>
#include <string.h>

const char *const pg_side_names[PG_SIDES] = {"left", "right", "bottom", "top", "back", "front"};

/* ---- points of facets ---------------------------------------------------------------------------------- */
/* If facet f of a cut cell lies on a face of the cell: keeps, of the n points of the cell, those on that
 * face, if there are any. Returns how many are left. */
static int on_the_face (const pg_marks *m, size_t f, int n, int *point)
{
    const cut_surface *s = m->cells->cut && m->cells->facet_surface[f] >= 0
                               ? &m->cells->cut->surface[m->cells->facet_surface[f]]
                               : NULL;
    int kept = 0, some[PG_ELEMENT_NODES];
    for (int k = 0; s && s->axis >= 0 && k < n; k++) {
        double off = m->cloud->x[(size_t) point[k] * (size_t) m->cells->dim + (size_t) s->axis]
                     - s->origin[s->axis];
        if (fabs (off) <= pg_cloud_same (m->cloud)) some[kept++] = point[k];
    }
    if (kept) memcpy (point, some, (size_t) kept * sizeof *point);
    return kept ? kept : n;
}

/* The points of facet f, at most 8: those at the corners of a whole face; for a piece of the surface those
 * points of its cell that are not surrounded by kept cells; where points stand at the centres of cells, that
 * of its cell. */
static int lattice_points (const pg_marks *m, const cells_sites *s, size_t f, int *point)
{
    const pg_cells *c = m->cells;
    size_t dim = (size_t) c->dim;
    int i[3], n = 0;
    cells_sites_cell (s, c->x + c->start[c->facet_cell[f]] * dim, i);
    if (s->centred) return cells_sites_points (s, i, 1, point);
    if (c->facet_kind[f] == PG_CUT) return on_the_face (m, f, cells_sites_points (s, i, 1, point), point);
    for (size_t k = c->facet_start[f]; k < c->facet_start[f + 1]; k++) {
        int p = cells_sites_at (s, c->facet_x + k * dim);
        if (p >= 0) point[n++] = p;
    }
    return n;
}

/* The points of facet f: on a lattice by its sites; on a grid over points from a file the nearest point;
 * facets of a mesh have a list of theirs. */
static int points_of (const pg_marks *m, const cells_sites *s, const pg_nearest *near, size_t f, int *point)
{
    const pg_cells *c = m->cells;
    int n = 0;
    if (s) return lattice_points (m, s, f, point);
    if (near) {
        point[0] = (int) pg_nearest_find (near, c->facet_centre + f * (size_t) c->dim, NULL, NULL);
        return point[0] >= 0;
    }
    for (size_t k = c->facet_start[f]; k < c->facet_start[f + 1]; k++)
        if (c->facet_point[k] >= 0) point[n++] = c->facet_point[k];
    return n;
}

/* Lists the points of all facets: counts, then writes. */
static pg_status link_facets (pg_marks *m)
{
    pg_status status = PG_OK;
    const pg_cells *c = m->cells;
    cells_sites sites = {0}, *s = c->facet_point || !m->lattice->dim ? NULL : &sites;
    pg_nearest *near = NULL;
    int point[PG_ELEMENT_NODES];
    if (s) PG_TRY (cells_sites_create (s, m->lattice, m->cloud));
    else if (!c->facet_point) PG_TRY (pg_nearest_create (&near, c->dim, m->cloud->n, m->cloud->x));
    PG_ALLOC (m->facet_first, c->nfacet + 1);
    for (size_t f = 0; f < c->nfacet; f++)
        m->facet_first[f + 1] = m->facet_first[f] + (size_t) points_of (m, s, near, f, point);
    PG_ALLOC (m->facet_point, m->facet_first[c->nfacet]);
    for (size_t f = 0; f < c->nfacet; f++) {
        int n = points_of (m, s, near, f, point);
        memcpy (m->facet_point + m->facet_first[f], point, (size_t) n * sizeof *point);
    }
done:
    cells_sites_clear (&sites);
    pg_nearest_free (&near);
    return status;
}

/* The shape each facet belongs to: known for a piece of the exact surface, else the shape whose surface is
 * nearest to the centroid. */
static pg_status find_shapes (pg_marks *m)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) m->cells->dim;
    PG_ALLOC (m->facet_shape, m->cells->nfacet);
    for (size_t f = 0; f < m->cells->nfacet; f++) {
        int surface = m->cells->cut ? m->cells->facet_surface[f] : -1;
        m->facet_shape[f] = surface >= 0
                                ? pg_cut_shape (m->cells->cut, surface)
                                : (int) pg_body_nearest (m->body, m->cells->facet_centre + f * dim, NULL);
    }
done:
    return status;
}

/* ---- life cycle ---------------------------------------------------------------------------------------- */
/* The box is that of the body where there is a lattice, else that of the points read from a file. */
pg_status pg_marks_create (pg_marks *m, const pg_body *body, const pg_lattice *lattice, const pg_cloud *cloud,
                           const pg_cells *cells)
{
    pg_status status = PG_OK;
    memset (m, 0, sizeof *m);
    m->body = body, m->lattice = lattice, m->cloud = cloud, m->cells = cells;
    int shaped = lattice->dim > 0 || (cells->n > 0 && !cells->facet_point && body->n > 0);
    for (int k = 0; k < cloud->dim; k++) {
        m->low[k]  = shaped ? body->low[k] : cloud->low[k];
        m->high[k] = shaped ? body->high[k] : cloud->high[k];
        m->centre[k] = 0.5 * (m->low[k] + m->high[k]);
        m->size = fmax (m->size, m->high[k] - m->low[k]);
    }
    PG_ALLOC (m->point, cloud->n);
    PG_ALLOC (m->facet, cells->nfacet);
    if (cells->nfacet > 0) {
        PG_TRY (link_facets (m));
        PG_TRY (find_shapes (m));
    }
done:
    if (status != PG_OK) pg_marks_clear (m);
    return status;
}

void pg_marks_clear (pg_marks *m)
{
    pg_free (m->facet_point);
    pg_free (m->facet_first);
    pg_free (m->facet_shape);
    pg_free (m->point);
    pg_free (m->facet);
    memset (m, 0, sizeof *m);
}

void pg_marks_fill (pg_marks *m, int value)
{
    memset (m->point, value, m->cloud->n);
    memset (m->facet, value, m->cells->nfacet);
}

/* ---- boundary ------------------------------------------------------------------------------------------ */
/* Number of the side of that name, -1: none in this dimension. */
static int side_named (int dim, const char *name)
{
    for (int s = 0; s < 2 * dim; s++) if (!strcmp (name, pg_side_names[s])) return s;
    return -1;
}

void cells_mark_facet (pg_marks *m, size_t f)
{
    m->facet[f] = 1;
    for (size_t k = m->facet_first[f]; k < m->facet_first[f + 1]; k++) m->point[m->facet_point[k]] = 1;
}

/* A facet of the exact surface has a flag for it. A face of a staircase counts if its normal is nearer to the
 * axis than to the plane normal to it (cosine^2 > 1/2) and its centroid lies within 3/4 of a step of one of
 * the two ends. */
int cells_is_end (const pg_marks *m, size_t f)
{
    const pg_shape *s = &m->body->shape[m->facet_shape[f]];
    const double *x = m->cells->facet_centre + 3 * f, *n = m->cells->normal + 3 * f;
    double along = 0, turn = 0, length = 0, step = 0;
    if (m->cells->cut && m->cells->facet_surface[f] >= 0)
        return !strcmp (s->boundary, "rim") && pg_cut_is_end (m->cells->cut, m->cells->facet_surface[f]);
    if (s->kind != PG_CYLINDER || strcmp (s->boundary, "rim")) return 0;
    for (int k = 0; k < 3; k++) length += s->axis[k] * s->axis[k];
    length = sqrt (length);
    for (int k = 0; k < 3; k++) {
        along += s->axis[k] / length * (x[k] - s->centre[k]);
        turn += s->axis[k] / length * n[k];
        step += fabs (s->axis[k]) / length * m->cloud->step[k];
    }
    return turn * turn > 0.5 && fmin (fabs (along), fabs (along - s->length)) <= 0.75 * step;
}

/* Does facet f carry this name, that of its shape's surface or of a side set of its shape's mesh? */
static int is_of_shape (const pg_marks *m, size_t f, const char *name)
{
    const pg_shape *s = &m->body->shape[m->facet_shape[f]];
    const cut_surface *at = m->cells->cut && m->cells->facet_surface[f] >= 0
                                ? &m->cells->cut->surface[m->cells->facet_surface[f]]
                                : NULL;
    if (at && at->facets && s->kind == PG_MESH) {
        const pg_facets *of = at->facets;
        return !strcmp (s->boundary, name)
               || pg_shape_face_on_side (s, of->element[at->region], of->side[at->region], name);
    }
    return !strcmp (s->boundary, name)
           || (s->kind == PG_MESH
               && pg_shape_on_side (s, m->cells->facet_centre + f * (size_t) m->cells->dim, name));
}

/* Marks the facets of all shapes whose surface has this name; "side" also means the flat ends of cylinders,
 * which the name "rim" excludes. 0: no shape has such a surface. */
static int mark_shape (pg_marks *m, const char *name)
{
    int known = 0, side = !strcmp (name, "side");
    for (size_t i = 0; i < m->body->n && m->cells->nfacet > 0; i++) {
        const pg_shape *s = &m->body->shape[i];
        for (size_t k = 0; s->kind == PG_MESH && pg_shape_side (s, k); k++)
            known |= !strcmp (pg_shape_side (s, k), name);
        known |= !strcmp (s->boundary, name)
                 || (side && s->kind == PG_CYLINDER && !strcmp (s->boundary, "rim"));
    }
    for (size_t f = 0; known && f < m->cells->nfacet; f++)
        if (cells_is_end (m, f) ? side : is_of_shape (m, f, name)) cells_mark_facet (m, f);
    return known;
}

/* Marks a set read with the mesh; 0: there is none of that name. */
static int mark_given (pg_marks *m, const char *name)
{
    for (size_t i = 0; i < m->cells->ngiven; i++) {
        const pg_set *s = &m->cells->given[i];
        if (strcmp (s->name, name)) continue;
        for (size_t k = 0; k < s->npoint; k++) m->point[s->point[k]] = 1;
        for (size_t k = 0; k < s->nfacet; k++) m->facet[s->facet[k]] = 1;
        return 1;
    }
    return 0;
}

/* Sets of the mesh come first and so hide predefined names. Without facets (points from a file) the sides
 * mark points. */
int pg_marks_boundary (pg_marks *m, const char *name)
{
    if (mark_given (m, name)) return 1;
    int side = side_named (m->cloud->dim, name), all = !strcmp (name, "all");
    if (side < 0 && !all) return mark_shape (m, name) || cells_mark_part (m, name);
    for (size_t f = 0; f < m->cells->nfacet; f++)
        if (all || cells_facet_on_side (m, f, side)) cells_mark_facet (m, f);
    /* Points from a file have no facets: the sides mark points. */
    for (size_t i = 0; m->cells->nfacet == 0 && i < m->cloud->n; i++)
        for (int s = 0; s < 2 * m->cloud->dim; s++)
            if ((all || s == side) && cells_point_on_side (m, i, s)) m->point[i] = 1;
    return 1;
}

/* ---- conditions on positions --------------------------------------------------------------------------- */
/* A point in the middle plane itself, to rounding, belongs to neither half. */
int pg_marks_beyond (const pg_marks *m, int side, const double *x)
{
    double d = x[side / 2] - m->centre[side / 2];
    return (side % 2 ? d : -d) > 1e-9 * m->size + pg_rounding (m->cloud->dim, m->low, m->high);
}

/* Facets are judged by their centroid. */
void pg_marks_keep (pg_marks *m, pg_mark_test test, const void *context)
{
    size_t dim = (size_t) m->cloud->dim;
    for (size_t i = 0; i < m->cloud->n; i++)
        if (m->point[i] && !test (m, m->cloud->x + i * dim, context)) m->point[i] = 0;
    for (size_t f = 0; f < m->cells->nfacet; f++)
        if (m->facet[f] && !test (m, m->cells->facet_centre + f * dim, context)) m->facet[f] = 0;
}
