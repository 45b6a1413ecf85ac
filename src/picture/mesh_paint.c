/* SPDX-License-Identifier: GPL-3.0-or-later
 * Faces of elements on a screen. A face is cut into small triangles along its own coordinates, so that
 * curved edges look curved and values vary as the shape functions of the element do; then come the edges
 * that are in sight, and the sets of sides and nodes. */
#include "mesh_drawing.h"
#include <math.h>
#include <string.h>

/* Largest number of parts along an edge, and places on a face that these make. */
enum { FINEST = 8, SPOTS = (FINEST + 1) * (FINEST + 1) };

/* ---- faces --------------------------------------------------------------------------------------------- */
/* The nodes (in the mesh) and the kind of a painted face; side -1 is a plane element itself. */
static pg_element face_of (const mesh_drawing *d, int element, int side, int node[9])
{
    const pg_mesh *m = d->mesh;
    const int *all = m->node + m->start[element];
    pg_element kind = (pg_element) m->kind[element];
    int local[9];
    if (side < 0) {
        for (int a = 0; a < pg_element_types[kind].nodes; a++) node[a] = all[a];
        return kind;
    }
    pg_element face = pg_element_face (kind, side, local);
    for (int a = 0; a < pg_element_types[face].nodes; a++) node[a] = all[local[a]];
    return face;
}

/* 1 for elements with three corners. */
static int is_triangle (pg_element kind) { return pg_element_types[kind].corners == 3; }

/* Parts along an edge of a face: one for straight triangles, more for curved ones and for values that vary
 * within a face; fewer when there are many faces. */
static int parts_of (const mesh_drawing *d, pg_element kind)
{
    int most = d->nface > 20000 ? 2 : d->nface > 4000 ? 4 : FINEST;
    if (pg_element_types[kind].order == 2) return most;
    return is_triangle (kind) ? 1 : d->value ? (most + 1) / 2 : 1;
}

/* The place with the local coordinates xi on a face: its pixel and depth (at), its coordinates
 * (x) and the value there, interpolated by the shape functions of the element. */
static void spot_of (const mesh_drawing *d, const pg_screen *s, pg_element kind, const int *node,
                     const double *xi, double *at, double *x, double *value)
{
    double N[PG_ELEMENT_NODES];
    pg_element_shape (kind, xi, N, NULL);
    memset (x, 0, 3 * sizeof *x);
    *value = 0;
    for (int a = 0; a < pg_element_types[kind].nodes; a++) {
        for (int k = 0; k < 3; k++) x[k] += N[a] * d->x[3 * (size_t) node[a] + (size_t) k];
        if (d->value) *value += N[a] * d->value[node[a]];
    }
    at[0] = (pg_along (d->sheet.eye.right, x, 3) - s->left) * s->scale;
    at[1] = (s->top - pg_along (d->sheet.eye.up, x, 3)) * s->scale;
    at[2] = pg_along (d->sheet.eye.toward, x, 3);
}

/* Brightness of a triangle with corners x. In side views it falls smoothly with the angle,
 * whereas pg_light_on has only two steps there, which would show as stripes on round faces. */
static float light_of (const mesh_drawing *d, const double (*x)[3])
{
    double a[3], b[3], n[3];
    if (d->mesh->dim < 3) return 1;
    for (int k = 0; k < 3; k++) a[k] = x[1][k] - x[0][k], b[k] = x[2][k] - x[0][k];
    n[0] = a[1] * b[2] - a[2] * b[1], n[1] = a[2] * b[0] - a[0] * b[2], n[2] = a[0] * b[1] - a[1] * b[0];
    double size = sqrt (pg_along (n, n, 3)), toward = pg_along (d->sheet.eye.toward, n, 3);
    for (int k = 0; k < 3; k++) n[k] *= size > 0 ? (toward < 0 ? -1 : 1) / size : 0;
    return d->sheet.eye.framed ? (float) (0.7 + 0.3 * pg_along (d->sheet.eye.toward, n, 3))
                               : pg_light_on (&d->sheet.eye, n);
}

/* A face sampled on a grid of its own coordinates: m parts along an edge; a triangle fills half of the
 * grid. */
typedef struct { int triangle, m, stride; double at[SPOTS][3], x[SPOTS][3], value[SPOTS]; } face_grid;

/* Fills the grid of a face: places, pixels with depth, and values. A face with a category of
 * its own has one value. */
static void sample_face (const mesh_drawing *d, const pg_screen *s, size_t f, face_grid *g)
{
    int node[9];
    pg_element kind = face_of (d, d->element[f], d->side[f], node);
    g->triangle = is_triangle (kind), g->m = parts_of (d, kind), g->stride = g->m + 1;
    for (int j = 0; j <= g->m; j++)
        for (int i = 0; i <= (g->triangle ? g->m - j : g->m); i++) {
            double xi[2] = { (double) i / g->m, (double) j / g->m };
            int k = j * g->stride + i;
            if (!g->triangle) xi[0] = 2 * xi[0] - 1, xi[1] = 2 * xi[1] - 1;
            spot_of (d, s, kind, node, xi, g->at[k], g->x[k], &g->value[k]);
            if (d->own) g->value[k] = d->own[f];
        }
}

/* One triangle of the grid, with its corners at these spots. */
static void paint_triangle (const mesh_drawing *d, pg_screen *s, const face_grid *g, const int corner[3])
{
    double v[3][3], y[3][3], w[3];
    for (int k = 0; k < 3; k++) {
        memcpy (v[k], g->at[corner[k]], sizeof v[k]), memcpy (y[k], g->x[corner[k]], sizeof y[k]);
        w[k] = g->value[corner[k]];
    }
    if (isfinite (v[0][0] + v[0][1] + v[1][0] + v[1][1] + v[2][0] + v[2][1]))
        pg_triangle (s, (const double (*)[3]) v, 0, light_of (d, (const double (*)[3]) y), w);
}

/* Paints the triangles between the places of the grid: two for each square, one at the long
 * side of a triangle. */
static void paint_face (const mesh_drawing *d, pg_screen *s, size_t f)
{
    face_grid g;
    sample_face (d, s, f, &g);
    for (int row = 0; row < g.m; row++)
        for (int i = 0; i < (g.triangle ? g.m - row : g.m); i++) {
            int a = row * g.stride + i, upper = !(g.triangle && i == g.m - row - 1);
            paint_triangle (d, s, &g, (const int[]) { a, a + 1, a + g.stride });
            if (upper) paint_triangle (d, s, &g, (const int[]) { a + 1, a + 1 + g.stride, a + g.stride });
        }
}

/* Each pixel becomes its own owner, since every pixel has its own value. In 3D pixels on the
 * outline turn grey. */
pg_status pg_mesh_drawing_paint (mesh_drawing *d, pg_screen *s)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->value, (size_t) s->width * (size_t) s->height);
    for (size_t f = 0; f < d->nface; f++) paint_face (d, s, f);
    for (int p = 0; p < s->width * s->height; p++) if (s->owner[p] >= 0) s->owner[p] = p;
    if (d->mesh->dim < 3) goto done;
    double size = fmax (d->sheet.high[0] - d->sheet.low[0], d->sheet.high[1] - d->sheet.low[1]);
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++) {
            int *owner = &s->owner[j * s->width + i];
            if (*owner >= 0 && pg_on_outline (s, i, j, 0.03 * size)) *owner = PG_EDGE;
        }
done:
    return status;
}

/* ---- lines --------------------------------------------------------------------------------------------- */
/* 1 if a place (pixels and depth) is nearer than one of the nine pixels around it, but for
 * `slack`: the edges of a face must not vanish behind the face itself by rounding. */
static int in_sight (const pg_screen *s, const double *at, double slack)
{
    for (int k = 0; k < 9; k++) {
        double i = floor (at[0]) + k % 3 - 1, j = floor (at[1]) + k / 3 - 1;
        if (!(i >= 0 && i < s->width && j >= 0 && j < s->height)) return 1;
        if (s->depth[(size_t) j * (size_t) s->width + (size_t) i] <= at[2] + slack) return 1;
    }
    return 0;
}

/* Adds side e of a face to the current path, from corner to corner, as far as it is in sight. */
static void path_of_side (const mesh_drawing *d, cairo_t *cr, const pg_screen *s, pg_element kind,
                          const int *node, int e)
{
    static const double tri[3][2] = { { 0, 0 }, { 1, 0 }, { 0, 1 } },
                        quad[4][2] = { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } };
    int corners = pg_element_types[kind].corners, solid = d->mesh->dim == 3,
        m = pg_element_types[kind].order == 2 ? FINEST : 1, pen = 0;
    const double *from = corners == 3 ? tri[e] : quad[e],
                 *to = corners == 3 ? tri[(e + 1) % 3] : quad[(e + 1) % 4];
    double size = fmax (d->sheet.high[0] - d->sheet.low[0], d->sheet.high[1] - d->sheet.low[1]);
    if (solid) m = d->nface > 2000 ? 4 : 16;
    for (int k = 0; k <= m; k++) {
        double t = (double) k / m,
               xi[2] = { from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]) }, at[3], x[3],
               value;
        spot_of (d, s, kind, node, xi, at, x, &value);
        int seen = !solid || in_sight (s, at, 0.004 * size);
        if (seen && pen) cairo_line_to (cr, at[0], at[1]);
        else if (seen) cairo_move_to (cr, at[0], at[1]);
        pen = seen;
    }
}

/* Adds a side on the boundary of a plane mesh to the current path. */
static void path_of_rim (const mesh_drawing *d, cairo_t *cr, const pg_screen *s, int element, int side)
{
    int node[9];
    pg_element kind = face_of (d, element, -1, node);
    path_of_side (d, cr, s, kind, node, side);
}

/* Edges of elements: drawn when asked for, or when there are fewer than 5000 faces. */
static void draw_edges (const mesh_drawing *d, cairo_t *cr, const pg_screen *s, double pixel)
{
    int edges = d->style->edges, node[9];
    if (edges < 0 || (edges == 0 && d->nface >= 5000)) return;
    for (size_t f = 0; f < d->nface; f++) {
        pg_element kind = face_of (d, d->element[f], d->side[f], node);
        for (int e = 0; e < pg_element_types[kind].corners; e++) path_of_side (d, cr, s, kind, node, e);
    }
    cairo_set_source_rgba (cr, 0.1, 0.1, 0.1, 0.75);
    cairo_set_line_width (cr, (d->nface < 1000 ? 1.2 : 0.7) * pixel);
    cairo_stroke (cr);
}

/* Draws sets of sides in 2D as broad lines on the boundary, and sets of nodes as dots. */
static void draw_sets (const mesh_drawing *d, cairo_t *cr, const pg_screen *s, double pixel)
{
    const pg_mesh *m = d->mesh;
    double rgb[3], size = fmax (d->sheet.high[0] - d->sheet.low[0], d->sheet.high[1] - d->sheet.low[1]);
    int k = 1;
    for (size_t t = 0; t < m->nsides && k <= d->categories; t++, k++) {
        if (m->dim == 3) continue;
        for (size_t i = 0; i < m->sides[t].n; i++)
            path_of_rim (d, cr, s, m->sides[t].element[i], m->sides[t].side[i]);
        d->sheet.colour ((double) k / PG_CATEGORIES, rgb);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        cairo_set_line_width (cr, 7 * pixel);
        cairo_stroke (cr);
    }
    for (size_t t = 0; t < m->nnodes && k <= d->categories; t++) {
        if (strcmp (d->name[k], m->nodes[t].name) != 0) continue;
        d->sheet.colour ((double) k++ / PG_CATEGORIES, rgb);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        for (size_t i = 0; i < m->nodes[t].n; i++) {
            const double *x = d->x + 3 * (size_t) m->nodes[t].node[i];
            double at[3] = { (pg_along (d->sheet.eye.right, x, 3) - s->left) * s->scale,
                             (s->top - pg_along (d->sheet.eye.up, x, 3)) * s->scale,
                             pg_along (d->sheet.eye.toward, x, 3) };
            if (m->dim == 3 && !in_sight (s, at, 0.004 * size)) continue;
            cairo_new_sub_path (cr);
            cairo_arc (cr, at[0], at[1], 5 * pixel, 0, 6.283185307179586);
            cairo_fill (cr);
        }
    }
}

/* All lines are clipped to the frame and drawn in pixels of the screen. */
void pg_mesh_drawing_lines (const mesh_drawing *d, cairo_t *cr, const pg_screen *s)
{
    const pg_sheet *p = &d->sheet;
    double pixel = s->width / p->width;
    cairo_save (cr);
    cairo_rectangle (cr, p->left, p->top, p->width, p->height);
    cairo_clip (cr);
    cairo_translate (cr, p->left, p->top);
    cairo_scale (cr, 1 / pixel, 1 / pixel);
    cairo_set_line_cap (cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join (cr, CAIRO_LINE_JOIN_ROUND);
    draw_edges (d, cr, s, pixel);
    for (size_t i = 0; i < d->nrim; i++) path_of_rim (d, cr, s, d->rim_element[i], d->rim_side[i]);
    cairo_set_source_rgb (cr, 0, 0, 0);
    cairo_set_line_width (cr, 2.2 * pixel);
    cairo_stroke (cr);
    if (d->style->sets) draw_sets (d, cr, s, pixel);
    cairo_restore (cr);
}
