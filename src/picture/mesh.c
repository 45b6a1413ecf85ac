/* SPDX-License-Identifier: GPL-3.0-or-later
 * Pictures of meshes: which faces of elements are seen, the frame they fill, their colours: a value at the
 * nodes, the blocks of elements or the sets of sides and nodes. How faces and edges are painted stands in
 * mesh_paint.c. */
#include "mesh_drawing.h"
#include <math.h>
#include <string.h>

/* ---- what is seen -------------------------------------------------------------------------------------- */
/* A plane mesh shows its elements (and the sides on its boundary), a solid one the faces on its surface. */
static pg_status choose_faces (mesh_drawing *d)
{
    pg_status status = PG_OK;
    const pg_mesh *m = d->mesh;
    if (m->dim == 3) return pg_mesh_surface (m, &d->nface, &d->element, &d->side);
    d->nface = m->n;
    PG_ALLOC (d->element, m->n);
    PG_ALLOC (d->side, m->n);
    for (size_t e = 0; e < m->n; e++) d->element[e] = (int) e, d->side[e] = -1;
    PG_TRY (pg_mesh_surface (m, &d->nrim, &d->rim_element, &d->rim_side));
done:
    return status;
}

/* Coordinates of the nodes, displaced by magnify u and scaled to m. PG_E_USAGE names the first
 * node without a finite place. */
static pg_status place_nodes (mesh_drawing *d)
{
    pg_status status = PG_OK;
    const pg_mesh *m = d->mesh;
    const pg_picture_style *style = d->style;
    size_t dim = (size_t) m->dim;
    d->sheet.bare = !(style->length > 0);
    d->scale = d->sheet.bare ? 1 : style->length;
    PG_ALLOC (d->x, 3 * m->nnode);
    for (size_t i = 0; i < m->nnode; i++)
        for (size_t k = 0; k < 3; k++) {
            double u = style->u && k < dim ? style->magnify * style->u[i * dim + k] : 0;
            d->x[3 * i + k] = d->scale * (m->x[3 * i + k] + u);
            if (!isfinite (d->x[3 * i + k]))
                PG_FAIL (PG_E_USAGE, "node %ld has no place", m->node_id ? m->node_id[i] : (long) i + 1);
        }
done:
    return status;
}

/* A solid is seen obliquely unless a view was asked for; sections of meshes are not drawn. */
static pg_status choose_eye (mesh_drawing *d)
{
    pg_status status = PG_OK;
    pg_picture_style style = *d->style;
    pg_cloud body = { .dim = d->mesh->dim };
    if (style.section) PG_FAIL (PG_E_USAGE, "sections of meshes are not drawn; choose a view");
    if (style.view == PG_SECTION || style.view == PG_VIEW_CRACK) style.view = PG_VIEW_ISO;
    PG_TRY (pg_eye_open (&d->sheet.eye, &body, &style));
done:
    return status;
}

/* Widens a range by a value; the first value is the range. */
static void include (double *low, double *high, double value, int first)
{
    *low = first ? value : fmin (*low, value), *high = first ? value : fmax (*high, value);
}

/* The box of the nodes in space, and the frame that holds them in the plane of the picture, with a narrow
 * margin. */
static void choose_frame (mesh_drawing *d)
{
    static const double unit[] = { 1e3, 1, 1e-3, 1e-6 };
    pg_sheet *p = &d->sheet;
    double size = 0, margin = p->eye.framed ? 0.025 : 0.015;
    for (size_t i = 0; i < d->mesh->nnode; i++) {
        const double *x = d->x + 3 * i;
        for (int a = 0; a < 3; a++) include (&d->grid.low[a], &d->grid.high[a], x[a], i == 0);
        include (&p->low[0], &p->high[0], pg_along (p->eye.right, x, 3), i == 0);
        include (&p->low[1], &p->high[1], pg_along (p->eye.up, x, 3), i == 0);
    }
    for (int a = 0; a < 2; a++) size = fmax (size, p->high[a] - p->low[a]);
    if (!(size > 0)) size = 1;
    for (int a = 0; a < 2; a++) p->low[a] -= margin * size, p->high[a] += margin * size;
    p->unit = p->bare ? 1 : 1e-9;
    for (int k = 3; k >= 0 && !p->bare; k--) if (size >= 0.999 * unit[k]) p->unit = unit[k];
}

/* ---- colours ------------------------------------------------------------------------------------------- */
/* Colour of a name in the legend of sets: 0 is the body in light grey, then the colours of
 * curves, and from the ninth on paler ones. */
static void colour_of_set (double t, double rgb[3])
{
    long k = lround (t * PG_CATEGORIES);
    if (k > 0) pg_colour_curve ((size_t) k - 1, rgb);
    for (int c = 0; c < 3; c++) {
        if (k == 0) rgb[c] = 0.90;
        else if (k > PG_CURVE_COLOURS) rgb[c] = 0.45 + 0.55 * rgb[c];
    }
}

/* Colour of a block of elements: colours of curves made paler, so that edges and sets stay
 * visible on them. */
static void colour_of_block (double t, double rgb[3])
{
    long k = lround (t * PG_CATEGORIES);
    pg_colour_curve ((size_t) k, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = 1 - (k < PG_CURVE_COLOURS ? 0.42 : 0.72) * (1 - rgb[c]);
}

/* Another row of the legend: the name of a block or set, or its number where it has no name. */
static void add_name (mesh_drawing *d, const char *name, const char *kind, int id)
{
    size_t k = d->sheet.nlegend++;
    if (name[0]) snprintf (d->name[k], MESH_NAME, "%s", name);
    else snprintf (d->name[k], MESH_NAME, "%s %d", kind, id);
    d->legend[k] = d->name[k];
    d->sheet.legend = d->legend;
}

/* Each element has the colour of its block; blocks beyond the legend share the last one. */
static pg_status colour_blocks (mesh_drawing *d)
{
    pg_status status = PG_OK;
    const pg_mesh *m = d->mesh;
    PG_ALLOC (d->own, d->nface);
    for (size_t f = 0; f < d->nface; f++)
        d->own[f] = m->block && m->block[d->element[f]] < MESH_SETS ? m->block[d->element[f]] : MESH_SETS;
    for (size_t b = 0; b < m->nblock && b <= MESH_SETS; b++)
        add_name (d, b < MESH_SETS ? m->blocks[b].name : "more blocks", "block", m->blocks[b].id);
    if (!d->sheet.nlegend) add_name (d, "elements", "block", 0);
    d->sheet.colour = colour_of_block;
done:
    return status;
}

/* Index of a painted face by bisection, -1 if it is not painted; the list ascends by element
 * and side. */
static long face_at (const mesh_drawing *d, int element, int side)
{
    size_t low = 0, high = d->nface;
    while (low < high) {
        size_t k = (low + high) / 2;
        if (d->element[k] < element || (d->element[k] == element && d->side[k] < side)) low = k + 1;
        else high = k;
    }
    return low < d->nface && d->element[low] == element && d->side[low] == side ? (long) low : -1;
}

/* Is there a set of sides of this name? A set of nodes of the same name is the same set twice. */
static int has_sides (const pg_mesh *m, const char *name)
{
    for (size_t t = 0; t < m->nsides; t++) if (strcmp (m->sides[t].name, name) == 0) return 1;
    return 0;
}

/* Names and colours of the sets of sides, then of the sets of nodes without sides. A side in
 * several sets has the colour of the last one. Sides of 2D meshes are drawn as lines by
 * mesh_paint.c. */
static pg_status colour_sets (mesh_drawing *d)
{
    pg_status status = PG_OK;
    const pg_mesh *m = d->mesh;
    PG_ALLOC (d->own, d->nface);
    add_name (d, "body", "", 0);
    for (size_t t = 0; t < m->nsides && d->categories < MESH_SETS; t++) {
        add_name (d, m->sides[t].name, "sides", m->sides[t].id);
        d->categories++;
        for (size_t i = 0; m->dim == 3 && i < m->sides[t].n; i++) {
            long f = face_at (d, m->sides[t].element[i], m->sides[t].side[i]);
            if (f >= 0) d->own[f] = d->categories;
        }
    }
    for (size_t t = 0; t < m->nnodes && d->categories < MESH_SETS; t++)
        if (!has_sides (m, m->nodes[t].name))
            add_name (d, m->nodes[t].name, "nodes", m->nodes[t].id), d->categories++;
    d->sheet.colour = colour_of_set;
done:
    return status;
}

/* The range that was asked for, or else that of the values at the nodes. */
static pg_status colour_values (mesh_drawing *d, double *low, double *high)
{
    pg_status status = PG_OK;
    const pg_picture_style *style = d->style;
    size_t n = d->mesh->nnode;
    double *shown = NULL;
    int found;
    PG_ALLOC (shown, n);
    for (size_t i = 0; i < n; i++)
        shown[i] = style->log ? (d->value[i] != 0 ? fabs (d->value[i]) : NAN) : d->value[i];
    d->sheet.colour = style->diverging && !style->log ? pg_colour_diverging : pg_colour_sequential;
    *low = style->low, *high = style->high;
    if (*low < *high) goto done;
    PG_TRY (pg_picture_range (n, shown, style->clip ? 2 : 0, low, high, &found));
    if (style->log) pg_range_decades (low, high);
    else if (style->diverging) {
        double top = fmax (fabs (*low), fabs (*high));
        *high = top > 0 ? top : 1, *low = -*high;
    }
done:
    pg_free (shown);
    return status;
}

/* Finds whether values lie beyond the ends of the colour bar, which then ends in arrows. */
static void choose_arrows (mesh_drawing *d)
{
    const pg_axis *bar = &d->sheet.bar;
    double slack = 1e-9 * (bar->log ? bar->low : bar->high - bar->low);
    for (size_t i = 0; !d->own && i < d->mesh->nnode; i++) {
        double v = bar->log ? fabs (d->value[i]) : d->value[i];
        if (!isfinite (v) || (bar->log && v == 0)) continue;
        d->sheet.beyond[0] |= v < bar->low - slack, d->sheet.beyond[1] |= v > bar->high + slack;
    }
}

/* ---- the sheet ----------------------------------------------------------------------------------------- */
/* Colours, sheet, faces with a depth buffer, then lines on top. */
static pg_status draw_sheet (mesh_drawing *d, const char *path)
{
    pg_status status = PG_OK;
    pg_canvas canvas = { 0 };
    pg_screen s = { 0 };
    pg_sheet *p = &d->sheet;
    pg_cloud body = { .dim = d->mesh->dim };
    double low = 0, high = 1;
    if (d->style->sets) PG_TRY (colour_sets (d));
    else if (!d->value) PG_TRY (colour_blocks (d));
    else {
        PG_TRY (colour_values (d, &low, &high));
        if (!d->style->log) pg_sheet_leave_out (p, d->style->label, d->mesh->nnode, d->value, low, high);
    }
    p->panels = 1, p->columns = 1;
    PG_TRY (pg_cairo_load ());
    pg_sheet_fit (p, d->style, low, high);
    choose_arrows (d);
    PG_TRY (pg_canvas_open (&canvas, path, p->total[0], p->total[1]));
    int fine = canvas.svg || !p->eye.framed ? 2 : 1;
    s = (pg_screen){ .left = p->low[0],
                     .top = p->high[1],
                     .scale = fine * p->width / (p->high[0] - p->low[0]) };
    PG_TRY (pg_screen_open (&s, (int) p->width * fine, (int) p->height * fine));
    PG_TRY (pg_mesh_drawing_paint (d, &s));
    PG_TRY (pg_panel_paint (p, canvas.cr, 0, &s, s.value, fine));
    pg_mesh_drawing_lines (d, canvas.cr, &s);
    pg_panel_draw (p, canvas.cr, 0, NULL);
    pg_sheet_draw (p, canvas.cr, &body, &d->grid, d->style);
done:
    pg_screen_close (&s);
    return canvas.path ? pg_canvas_close (&canvas, status) : status;
}

/* The order: view, places of the nodes, faces, frame, drawing. */
pg_status pg_picture_mesh (const char *path, const pg_mesh *mesh, const double *value,
                           const pg_picture_style *style)
{
    pg_status status = PG_OK;
    mesh_drawing *d = NULL;
    if (mesh->n == 0) PG_FAIL (PG_E_USAGE, "%s: no elements to draw", path);
    if (mesh->dim < 2) PG_FAIL (PG_E_USAGE, "%s: meshes of bars are not drawn", path);
    PG_ALLOC (d, 1);
    d->mesh = mesh, d->style = style, d->value = style->sets ? NULL : value;
    PG_TRY (choose_eye (d));
    PG_TRY (place_nodes (d));
    PG_TRY (choose_faces (d));
    choose_frame (d);
    PG_TRY (draw_sheet (d, path));
done:
    if (d) {
        pg_free (d->x), pg_free (d->element), pg_free (d->side), pg_free (d->rim_element),
            pg_free (d->rim_side), pg_free (d->own);
    }
    pg_free (d);
    return status;
}
