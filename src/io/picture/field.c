/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws fields on points: which points are seen, the frame they fill, their colours; one state, or several
 * side by side with one colour bar. A 2D body, or a section of a 3D body, has everywhere the colour of the
 * point that the place belongs to; a 3D body from outside consists of cubes; 1D values become a chart.
 *
 * The steps, in the order of pg_picture_panels: the eye (view.c), the points in sight, the frame in
 * metres, the range of colours, the sheet with its axes (sheet.c), and for each panel a screen of pixels
 * that is filled (tiles.c, solid.c) and painted. */
#include "tiles.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* One picture that is being drawn. */
typedef struct {
    const pg_cloud *cloud;
    const pg_picture_style *style;
    /* Number of panels, and the state (values, displacement, ...) that each of them shows. */
    size_t  n;
    const pg_panel *panel;
    /* 3D: the lattice of the points. */
    pg_grid grid;
    pg_sheet sheet;
    /* 1 for the points that the section meets; without a section 1 for all (cloud->n). */
    unsigned char *seen;
    /* 1 for the points that the current panel selects (cloud->n). */
    unsigned char *keep;
    /* Coloured by depth: the coordinate of each point in the picture's length unit (cloud->n);
     * else NULL. */
    double *own;
    /* index[k]: index in the cloud of the k-th point that is drawn; layer: index of the layer of
     * the lattice that is shown. */
    int    *index, layer;
    /* Spacing around the points of a 2D cloud that is no lattice, m (cloud->n), or NULL. */
    double *spacing;
    /* Displaced faces of cracks in 2D, PG_FACE points each (nface x PG_FACE x 2), m. */
    double *face;  size_t nface, cap_face;
    char    label[32], title[440];
} drawing;

/* The displacement (m) to draw a panel with, or NULL where the body is shown undeformed. */
static const double *displaced (const drawing *d, size_t panel)
{
    return d->style->magnify != 0 ? d->panel[panel].u : NULL;
}

/* The cracks of a panel, or NULL. */
static const pg_cracks *cracks_of (const drawing *d, size_t panel)
{
    return d->panel[panel].cracks ? d->panel[panel].cracks : d->style->cracks;
}

/* The values that are coloured: those of the panel, or, where colours show the depth, the coordinate of each
 * point towards the eye. */
static const double *value_of (const drawing *d, size_t panel)
{
    return d->own ? d->own : d->panel[panel].value;
}

/* ---- points ----------------------------------------------------------------------------------------- */
/* A section shows the layer of points that it lies in, the lower of two when it lies half-way
 * between them; the tolerance 1e-6 of a step decides that, not rounding. PG_E_USAGE if the
 * plane misses the points. */
static pg_status choose_layer (drawing *d)
{
    pg_status status = PG_OK;
    const pg_eye *e = &d->sheet.eye;
    const pg_grid *g = &d->grid;
    double t = (e->at - g->origin[e->cut]) / g->step[e->cut];
    d->layer = (int) fmin (fmax (ceil (t - 0.5 - 1e-6), -2), g->count[e->cut]);
    if (d->layer == -1 && t > -0.5 - 1e-6) d->layer = 0;
    if (d->layer < 0 || d->layer >= g->count[e->cut])
        PG_FAIL (PG_E_USAGE, "the section %c = %g m meets no points: they lie between %g and %g m",
                 "xyz"[e->cut], e -> at, g -> low[e->cut], g -> high[e->cut]);
    for (size_t i = 0; i < d->cloud->n; i++)
        d->seen[i] = pg_grid_place (g, e->cut, d->cloud->x[3 * i + (size_t) e->cut]) == d->layer;
done:
    return status;
}

/* How far the cell of a point reaches along a unit direction, m: the support function of a
 * box. */
static double half_cell (const drawing *d, const double *direction)
{
    double s = 0;
    for (int a = 0; a < d->cloud->dim; a++) {
        double step = d->cloud->dim == 3      ? d->grid.step[a]
                      : d->cloud->step[a] > 0 ? d->cloud->step[a]
                                              : d->cloud->h;
        s += 0.5 * step * fabs (direction[a]);
    }
    return s;
}

/* Marks the points that a picture shows: those of a layer, those whose cells an oblique plane cuts, or
 * all. */
static pg_status choose_points (drawing *d)
{
    pg_status status = PG_OK;
    const pg_eye *e = &d->sheet.eye;
    size_t found = 0;
    PG_ALLOC (d->seen, d->cloud->n);
    PG_ALLOC (d->keep, d->cloud->n);
    memset (d->seen, 1, d->cloud->n);
    if (e->kind == PG_LAYER) PG_TRY (choose_layer (d));
    for (size_t i = 0; e->kind == PG_SLICE && i < d->cloud->n; i++)
        d->seen[i] = fabs (pg_along (e->toward, d->cloud->x + 3 * i, 3) - e->at)
                     <= half_cell (d, e->toward) * (1 + 1e-6);
    for (size_t i = 0; i < d->cloud->n; i++) found += d->seen[i];
    if (found == 0) PG_FAIL (PG_E_USAGE, "the section meets no points");
done:
    return status;
}

/* ---- frame ------------------------------------------------------------------------------------------ */
/* The coordinate along a direction, displaced, of each point of a panel (out: cloud->n, m);
 * NAN for points that are not seen and for fragments that have flown so far that the frame
 * would show little else. */
static pg_status places (const drawing *d, size_t panel, const double *direction, double *out)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) d->cloud->dim;
    const double *u = displaced (d, panel);
    double low = 0, high = 0;
    int found;
    for (size_t i = 0; i < d->cloud->n; i++)
        out[i] = u ? d->style->magnify * pg_along (direction, u + i * dim, (int) dim) : 0;
    if (u) PG_TRY (pg_picture_range (d->cloud->n, out, 2, &low, &high, &found));
    double slack = 0.5 * (high - low);
    for (size_t i = 0; i < d->cloud->n; i++) {
        int near = out[i] >= low - slack && out[i] <= high + slack;
        out[i] = d->seen[i] && near ? out[i] + pg_along (direction, d->cloud->x + i * dim, (int) dim) : NAN;
    }
done:
    return status;
}

/* Limits the range of an undeformed body to its outline, not to half a cell beyond its outer points. */
static void end_at_body (const drawing *d, const double *direction, double *low, double *high)
{
    const pg_body *body = d->style->outline->body;
    for (size_t k = 0; k < d->n; k++) if (displaced (d, k)) return;
    for (int c = 0; c < d->cloud->dim; c++) {
        if (fabs (fabs (direction[c]) - 1) > 1e-12) continue;
        *low = fmax (*low, direction[c] > 0 ? body->low[c] : -body->high[c]),
        *high = fmin (*high, direction[c] > 0 ? body->high[c] : -body->low[c]);
    }
}

/* Range in metres of all cells drawn along one axis of the picture, over all panels. */
static pg_status extent (const drawing *d, const double *direction, double *low, double *high)
{
    pg_status status = PG_OK;
    double *place = NULL, from, to;
    int any = 0;
    PG_ALLOC (place, d->cloud->n);
    for (size_t k = 0; k < d->n; k++) {
        PG_TRY (places (d, k, direction, place));
        if (!pg_range_of (d->cloud->n, place, 0, &from, &to)) continue;
        *low = any ? fmin (*low, from) : from, *high = any ? fmax (*high, to) : to;
        any = 1;
    }
    double half = half_cell (d, direction);
    if (!(half > 0)) half = *high > *low ? 0.5 * (*high - *low) / sqrt ((double) d->cloud->n) : 0.5;
    *low -= half, *high += half;
    if (d->style->outline && d->style->outline->body && d->style->outline->body->n)
        end_at_body (d, direction, low, high);
done:
    pg_free (place);
    return status;
}

/* The range of a solid's box along a direction; the box may end at the outer points
 * themselves. */
static void extent_of_box (const drawing *d, const double *direction, double *low, double *high)
{
    for (int corner = 0; corner < 8; corner++) {
        double x[3];
        for (int a = 0; a < 3; a++) x[a] = corner >> a & 1 ? d->grid.high[a] : d->grid.low[a];
        double s = pg_along (direction, x, 3);
        *low = corner ? fmin (*low, s) : s, *high = corner ? fmax (*high, s) : s;
    }
}

/* Widens the common frame of several pictures by the frame of this one. */
static void widen (pg_reach *reach, const pg_sheet *p)
{
    for (int a = 0; a < 2; a++) {
        reach->low[a] = reach->any ? fmin (reach->low[a], p->low[a]) : p->low[a];
        reach->high[a] = reach->any ? fmax (reach->high[a], p->high[a]) : p->high[a];
    }
    reach->any = 1;
}

/* Chooses the frame: that of several pictures, if it has been measured, else that of this one. */
static pg_status choose_frame (drawing *d, pg_reach *measured)
{
    pg_status status = PG_OK;
    const pg_reach *given = d->style->reach && d->style->reach->any ? d->style->reach : NULL;
    pg_sheet *p = &d->sheet;
    int deformed = 0;
    for (size_t k = 0; k < d->n; k++) deformed |= displaced (d, k) != NULL;
    for (int a = 0; a < 2; a++) {
        const double *direction = a ? p->eye.up : p->eye.right;
        if (given) p->low[a] = given->low[a], p->high[a] = given->high[a];
        else if (p->eye.kind == PG_SOLID && !deformed)
            extent_of_box (d, direction, &p->low[a], &p->high[a]);
        else PG_TRY (extent (d, direction, &p->low[a], &p->high[a]));
    }
    if (measured) widen (measured, p);
    pg_sheet_frame (p);
done:
    return status;
}

/* ---- colours ---------------------------------------------------------------------------------------- */
/* 1 if point i is selected for drawing (for instance by a damage of 0.35 and more). */
static int above (const drawing *d, size_t panel, size_t i)
{
    const double *select = d->panel[panel].select;
    return !select || select[i] >= d->style->above;
}

/* The axis that points most nearly towards the eye. Its coordinate colours a crack surface that is seen
 * alone, so that its shape shows. */
static int depth_axis (const pg_eye *e)
{
    int axis = fabs (e->toward[1]) > fabs (e->toward[0]) ? 1 : 0;
    return fabs (e->toward[2]) >= fabs (e->toward[axis]) ? 2 : axis;
}

static pg_status colour_by_depth (drawing *d)
{
    pg_status status = PG_OK;
    int axis = depth_axis (&d->sheet.eye);
    PG_ALLOC (d->own, d->cloud->n);
    for (size_t i = 0; i < d->cloud->n; i++) d->own[i] = d->cloud->x[3 * i + (size_t) axis] / d->sheet.unit;
    snprintf (d->label, sizeof d->label, "%c (%s)", "xyz"[axis], pg_sheet_unit (&d->sheet));
done:
    return status;
}

/* The values that all panels show (d->n x cloud->n), NAN for a point that is not shown. */
static pg_status shown_values (const drawing *d, double **out)
{
    pg_status status = PG_OK;
    size_t n = d->cloud->n;
    PG_ALLOC (*out, d->n * n);
    for (size_t k = 0; k < d->n; k++)
        for (size_t i = 0; i < n; i++)
            (*out)[k * n + i] = d->seen[i] && (d->own || above (d, k, i)) ? value_of (d, k)[i] : NAN;
done:
    return status;
}

/* Chooses the range of the colours. Colours by depth cover the depths of the points or of the crack surfaces,
 * whatever range the style asks for. */
static pg_status choose_colours (drawing *d, const pg_picture_style *style, const double *shown, double *low,
                                 double *high)
{
    pg_status status = PG_OK;
    pg_picture_style here = *style;
    if (d->own) here.low = here.high = 0, here.clip = here.diverging = 0;
    PG_TRY (pg_sheet_colours (&d->sheet, &here, d->n, d->cloud->n, shown, low, high));
    for (size_t k = 0; d->own && k < d->n; k++)
        if (pg_cracks_grown (cracks_of (d, k)))
            pg_cracks_depth (cracks_of (d, k), &d->grid, depth_axis (&d->sheet.eye), d->sheet.unit, low,
                             high);
done:
    return status;
}

/* How far the cell of a point reaches along axis a of the picture, m. Where the spacing is not
 * known it follows from the number of points. */
static double half_of_points (const drawing *d, int a)
{
    double half = half_cell (d, a ? d->sheet.eye.up : d->sheet.eye.right);
    return half > 0 ? half : 0.5 * (d->sheet.high[a] - d->sheet.low[a]) / sqrt ((double) d->cloud->n);
}

/* ---- painting --------------------------------------------------------------------------------------- */
/* The arrays that tiles.c gets: coordinates, displacements times magnification and local spacings (all m) of
 * the visible points in the plane of the picture, and their damage. */
typedef struct { double *place, *shift, *damage, *size; } plane_points;

/* Frees the arrays of the points in the plane. */
static void free_plane_points (plane_points *p)
{
    pg_free (p->place), pg_free (p->shift), pg_free (p->damage), pg_free (p->size);
}

/* Coordinates of a vector in the plane of the picture, times a factor. */
static void into_plane (const pg_eye *e, const double *x, int dim, double factor, double out[2])
{
    out[0] = factor * pg_along (e->right, x, dim), out[1] = factor * pg_along (e->up, x, dim);
}

/* Projects the visible points into the plane of the picture; d->index stores their indices in the cloud.
 * Points near an oblique plane get their displaced positions, as their cells do not form a lattice in that
 * plane. */
static pg_status collect_points (drawing *d, size_t panel, pg_tiles *t, plane_points *p)
{
    pg_status status = PG_OK;
    const pg_eye *e = &d->sheet.eye;
    const pg_cloud *c = d->cloud;
    const double *u = displaced (d, panel), *damage = d->panel[panel].damage,
                 *size = c->size ? c->size : d->spacing;
    size_t dim = (size_t) c->dim, n = c->n;
    int has_area = dim == 2 && c->volume && c->thickness > 0;
    PG_ALLOC (p->place, 2 * n);
    t->moved = u && e->kind == PG_SLICE;
    if (u && !t->moved) PG_ALLOC (p->shift, 2 * n);
    if (damage) PG_ALLOC (p->damage, n);
    if (size) PG_ALLOC (p->size, n);
    for (size_t i = 0; i < n; i++) {
        const double *x = c->x + i * dim;
        if (!d->seen[i] || !isfinite (x[0]) || !isfinite (x[1])) continue;
        size_t k = t->n++;
        double move[2] = { 0 };
        into_plane (e, x, (int) dim, 1, p->place + 2 * k);
        if (u) into_plane (e, u + i * dim, (int) dim, d->style->magnify, move);
        for (size_t a = 0; a < 2; a++)
            if (p->shift) p->shift[2*k + a] = move[a];
            else p->place[2*k + a] += move[a];
        if (damage) p->damage[k] = damage[i];
        if (size) p->size[k] = size[i];
        if (has_area) t->area += c->volume[i] / c->thickness;
        d->index[k] = (int) i;
    }
done:
    return status;
}

/* Fills the screen of a 2D body or a section with the part of the plane that belongs to each point. */
static pg_status paint_tiles (drawing *d, size_t panel, pg_screen *s)
{
    pg_status status = PG_OK;
    const pg_eye *e = &d->sheet.eye;
    plane_points p = { 0 };
    int oblique = e->kind == PG_SLICE;
    pg_tiles t = { .dim = d->cloud->dim,
                   .loose = !oblique && (d->spacing || d->cloud->size || d->grid.loose),
                   .eye = e,
                   .outline = oblique ? NULL : d->style->outline,
                   .cracks = oblique ? NULL : cracks_of (d, panel) };
    PG_TRY (collect_points (d, panel, &t, &p));
    for (int a = 0; a < 2; a++) t.step[a] = 2 * half_of_points (d, a);
    if (e->kind == PG_LAYER)
        t.at = e->toward[e->cut] * (d->grid.origin[e->cut] + d->layer * d->grid.step[e->cut]);
    t.place = p.place, t.shift = p.shift, t.damage = p.damage, t.size = p.size;
    PG_TRY (pg_tiles_open (&t));
    PG_TRY (pg_tiles_draw (&t, s));
    PG_TRY (pg_tiles_faces (&t, &d->face, &d->nface, &d->cap_face));
    for (size_t k = 0; k < (size_t) s->width * (size_t) s->height; k++) {
        if (s->owner[k] < 0) continue;
        s->owner[k] = d->index[s->owner[k]];
        if (!d->keep[s->owner[k]]) s->owner[k] = PG_GHOST;
    }
done:
    pg_tiles_close (&t);
    free_plane_points (&p);
    return status;
}

/* Fills the screen with the cells of an undeformed lattice that an oblique plane cuts. */
static void paint_slice (drawing *d, pg_screen *s)
{
    pg_slice_draw (&d->grid, &d->sheet.eye, s);
    for (size_t p = 0; p < (size_t) s->width * (size_t) s->height; p++)
        if (s->owner[p] >= 0 && !d->keep[s->owner[p]]) s->owner[p] = PG_GHOST;
}

/* Fills the screen of a panel: with cubes seen from outside, with the cells that an oblique plane cuts, or
 * with the parts of a plane that belong to points. */
static pg_status fill_screen (drawing *d, size_t panel, pg_screen *s)
{
    const pg_eye *e = &d->sheet.eye;
    const double *u = displaced (d, panel);
    pg_solid solid = { d->cloud, &d->grid, e, u, d->style->magnify, d->keep, d->panel[panel].damage };
    if (e->kind == PG_SOLID && d->style->view == PG_VIEW_CRACK && pg_cracks_grown (cracks_of (d, panel))) {
        pg_status status = pg_cracks_draw (&solid, s, cracks_of (d, panel),
                                           d->own ? NULL : value_of (d, panel), depth_axis (e),
                                           d->sheet.unit);
        return status == PG_OK ? pg_ghost_draw (&solid, s) : status;
    }
    if (e->kind == PG_SOLID) {
        pg_solid_draw (&solid, s);
        return d->panel[panel].select ? pg_ghost_draw (&solid, s) : PG_OK;
    }
    if (e->kind != PG_SLICE || d->grid.loose || u) return paint_tiles (d, panel, s);
    paint_slice (d, s);
    return PG_OK;
}

/* Draws one panel: pixels, the box of the body if only selected points are drawn, cracks, frame, title. */
static pg_status paint_panel (drawing *d, cairo_t *cr, size_t panel, int fine)
{
    pg_status status = PG_OK;
    const pg_sheet *p = &d->sheet;
    const pg_eye *e = &p->eye;
    const double *u = displaced (d, panel), *select = d->panel[panel].select;
    pg_screen s = { .left = p->low[0],
                    .top = p->high[1],
                    .scale = fine * p->width / (p->high[0] - p->low[0]) };
    PG_TRY (pg_screen_open (&s, (int) p->width * fine, (int) p->height * fine));
    for (size_t i = 0; i < d->cloud->n; i++) d->keep[i] = (unsigned char) above (d, panel, i);
    PG_TRY (fill_screen (d, panel, &s));
    int box = e->kind == PG_SOLID && !e->framed && select;
    if (box) pg_wire_box (p, cr, panel, &d->grid, 1);
    PG_TRY (pg_panel_paint (p, cr, panel, &s, value_of (d, panel), fine));
    if (box) pg_wire_box (p, cr, panel, &d->grid, 0);
    if (u && d->cloud->dim == 2) pg_wire_faces (p, cr, panel, d->nface, PG_FACE, d->face);
    else if (cracks_of (d, panel) && !u)
        pg_wire_cracks (p, cr, panel, &d->grid, cracks_of (d, panel), select ? NULL : &s);
    pg_panel_draw (p, cr, panel, d->panel[panel].title);
done:
    pg_screen_close (&s);
    return status;
}

/* Returns the title and the position of the section, for a 3D body without a section in its style. */
static const char *name_layer (drawing *d)
{
    const char *given = d->style->title ? d->style->title : "";
    char axis = "xyz"[d->sheet.eye.cut];
    double at = d->grid.origin[d->sheet.eye.cut] + d->layer * d->grid.step[d->sheet.eye.cut];
    snprintf (d->title, sizeof d->title, "%.380s%ssection %c = %.4g %s", given, *given ? ", " : "", axis,
              at / d->sheet.unit + 0.0, pg_sheet_unit (&d->sheet));
    return d->title;
}

/* Lays out and draws the whole picture. SVG files and pictures without a frame are painted
 * twice as fine. */
static pg_status draw_sheet (drawing *d, const char *path)
{
    pg_status status = PG_OK;
    pg_canvas canvas = { 0 };
    pg_picture_style style = *d->style;
    double low, high, *shown = NULL;
    if (style.by_depth && d->sheet.eye.kind == PG_SOLID) PG_TRY (colour_by_depth (d));
    if (d->own) style.label = d->label;
    PG_TRY (shown_values (d, &shown));
    PG_TRY (choose_colours (d, &style, shown, &low, &high));
    if (d->sheet.eye.kind == PG_LAYER && !style.section) style.title = name_layer (d);
    PG_TRY (pg_cairo_load ());
    pg_sheet_fit (&d->sheet, &style, low, high);
    if (!d->own) pg_sheet_arrows (&d->sheet, d->n * d->cloud->n, shown);
    PG_ALLOC (d->index, d->cloud->n);
    PG_TRY (pg_canvas_open (&canvas, path, d->sheet.total[0], d->sheet.total[1]));
    for (size_t k = 0; k < d->n; k++)
        PG_TRY (paint_panel (d, canvas.cr, k, canvas.svg || !d->sheet.eye.framed ? 2 : 1));
    pg_sheet_draw (&d->sheet, canvas.cr, d->cloud, &d->grid, &style);
done:
    pg_free (shown);
    return canvas.path ? pg_canvas_close (&canvas, status) : status;
}

/* ---- pictures --------------------------------------------------------------------------------------- */
/* Draws the panels, or only measures their frame. A 2D cloud needs no lattice: its spacing or that of each
 * point is enough. */
static pg_status draw_or_measure (const char *path, pg_reach *measured, const pg_cloud *cloud, size_t n,
                                  const pg_panel *panel, int columns, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    drawing *d = NULL;
    PG_ALLOC (d, 1);
    d->cloud = cloud, d->style = style, d->n = n, d->panel = panel;
    d->sheet.panels = n, d->sheet.columns = columns;
    for (size_t k = 0; k < n; k++) d->sheet.titles |= panel[k].title && panel[k].title[0];
    PG_TRY (pg_eye_open (&d->sheet.eye, cloud, style));
    if (cloud->dim == 3) PG_TRY (pg_grid_build (&d->grid, cloud));
    else PG_TRY (pg_loose_spacing (cloud, &d->spacing));
    PG_TRY (choose_points (d));
    PG_TRY (choose_frame (d, measured));
    if (!measured) PG_TRY (draw_sheet (d, path));
done:
    if (d) {
        pg_grid_clear (&d->grid);
        pg_free (d->seen), pg_free (d->keep), pg_free (d->own), pg_free (d->index);
        pg_free (d->spacing), pg_free (d->face);
    }
    pg_free (d);
    return status;
}

pg_status pg_picture_panels (const char *path, const pg_cloud *cloud, size_t n, const pg_panel *panel,
                             int columns, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    if (cloud->n == 0 || n == 0) PG_FAIL (PG_E_USAGE, "%s: no points to draw", path);
    if (cloud->dim == 1) return pg_draw_bars (path, cloud, n, panel, style);
    status = draw_or_measure (path, NULL, cloud, n, panel, columns, style);
done:
    return status;
}

pg_status pg_picture_reach (pg_reach *reach, const pg_cloud *cloud, const pg_panel *panel,
                            const pg_picture_style *style)
{
    pg_status status = PG_OK;
    if (cloud->n == 0 || cloud->dim == 1)
        PG_FAIL (PG_E_USAGE, "only points in the plane or in space have a frame");
    status = draw_or_measure (NULL, reach, cloud, 1, panel, 1, style);
done:
    return status;
}
