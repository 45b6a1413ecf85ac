/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws meshes: which faces of elements are seen, the frame they fill, their colours: a value at the nodes,
 * the blocks of elements or the sets of sides and nodes. A face is cut into small triangles along its
 * own coordinates, so that curved edges look curved and values vary as the shape functions of the element do;
 * then come the edges that are in sight, and the sets. */
#include "picture_private.h"
#include <math.h>
#include <string.h>

/* Longest name in the legend, and the largest number of sets or blocks with a colour of their
 * own. */
enum { MESH_NAME = 80, MESH_SETS = 24 };
/* A picture of a mesh that is being drawn. Lengths are m, or units of the mesh if its unit is
 * not known. */
typedef struct {
    const pg_mesh *mesh;
    const pg_picture_style *style;
    /* Metres in one unit of the mesh, 1 if that is not known. */
    double  scale;
    /* Displaced and scaled coordinates of the nodes (nnode x 3). */
    double *x;
    /* Faces that are painted: in 2D all elements, in 3D the sides of elements on the surface. */
    size_t  nface;
    /* Element and side of each face (nface); side -1 means the element itself. Ascending by
     * element and side. */
    int    *element, *side;
    /* 2D: the sides of elements on the boundary of the body. */
    size_t  nrim;
    int    *rim_element, *rim_side;
    /* Number of the name in the legend that a face belongs to (nface), or NULL: colours show
     * values. */
    double *own;
    /* Values at the nodes (nnode), or NULL. */
    const double *value;
    /* The names of the legend. */
    char    name[MESH_SETS + 1][MESH_NAME];
    const char *legend[MESH_SETS + 1];
    /* Number of sets that have a colour; the body itself is not counted. */
    int     categories;
    pg_sheet sheet;
    /* Only low and high are used: the box of the mesh, whose size stands below a view. */
    pg_grid  grid;
} mesh_drawing;

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

/* Computes the coordinates of the nodes, displaced by magnify u and scaled to m. PG_E_USAGE names
 * the first node without a finite position. */
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

/* Finds the box of the nodes in space, and the frame that holds them in the plane of the picture, with a
 * narrow margin. */
static void choose_frame (mesh_drawing *d)
{
    pg_sheet *p = &d->sheet;
    for (size_t i = 0; i < d->mesh->nnode; i++) {
        const double *x = d->x + 3 * i;
        for (int a = 0; a < 3; a++) include (&d->grid.low[a], &d->grid.high[a], x[a], i == 0);
        include (&p->low[0], &p->high[0], pg_along (p->eye.right, x, 3), i == 0);
        include (&p->low[1], &p->high[1], pg_along (p->eye.up, x, 3), i == 0);
    }
    pg_sheet_frame (p);
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

/* Adds a row to the legend: the name of a block or set, or its number where it has no name. */
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
 * several sets has the colour of the last one. Sides of 2D meshes are drawn as
 * lines. */
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

/* Largest number of parts that an edge is divided into, and of sample points on a face. */
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

/* Evaluates the point with the local coordinates xi on a face: its pixel and depth (at), its
 * coordinates (x) and the value there, interpolated by the shape functions of the element. */
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
    pg_screen_place (s, &d->sheet.eye, x, at);
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

/* Fills the grid of a face: coordinates, pixels with depth, and values. A face that belongs to a
 * name in the legend (d->own) has one value. */
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

/* Paints one triangle of the grid; corner: the indices of its corners in the arrays of the grid. */
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

/* Paints the triangles between the points of the grid: two for each square, one at the long side
 * of a triangular face. */
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
static pg_status paint_faces (mesh_drawing *d, pg_screen *s)
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
        int seen = !solid || pg_in_sight (s, at, 0.004 * size);
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
        pg_stroke (cr, 7 * pixel, rgb[0], rgb[1], rgb[2]);
    }
    for (size_t t = 0; t < m->nnodes && k <= d->categories; t++) {
        if (strcmp (d->name[k], m->nodes[t].name) != 0) continue;
        d->sheet.colour ((double) k++ / PG_CATEGORIES, rgb);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        for (size_t i = 0; i < m->nodes[t].n; i++) {
            double at[3];
            pg_screen_place (s, &d->sheet.eye, d->x + 3 * (size_t) m->nodes[t].node[i], at);
            if (m->dim == 3 && !pg_in_sight (s, at, 0.004 * size)) continue;
            cairo_new_sub_path (cr);
            cairo_arc (cr, at[0], at[1], 5 * pixel, 0, 6.283185307179586);
            cairo_fill (cr);
        }
    }
}

/* All lines are clipped to the frame and drawn in pixels of the screen. */
static void draw_lines (const mesh_drawing *d, cairo_t *cr, const pg_screen *s)
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
    pg_stroke (cr, 2.2 * pixel, 0, 0, 0);
    if (d->style->sets) draw_sets (d, cr, s, pixel);
    cairo_restore (cr);
}

/* ---- the sheet ----------------------------------------------------------------------------------------- */
/* Draws the whole picture: colours, sheet, faces with a depth buffer, then lines on top. */
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
    else PG_TRY (pg_sheet_colours (p, d->style, 1, d->mesh->nnode, d->value, &low, &high));
    p->panels = 1, p->columns = 1;
    PG_TRY (pg_cairo_load ());
    pg_sheet_fit (p, d->style, low, high);
    if (!d->own) pg_sheet_arrows (p, d->mesh->nnode, d->value);
    PG_TRY (pg_canvas_open (&canvas, path, p->total[0], p->total[1]));
    int fine = canvas.svg || !p->eye.framed ? 2 : 1;
    s = (pg_screen){ .left = p->low[0],
                     .top = p->high[1],
                     .scale = fine * p->width / (p->high[0] - p->low[0]) };
    PG_TRY (pg_screen_open (&s, (int) p->width * fine, (int) p->height * fine));
    PG_TRY (paint_faces (d, &s));
    PG_TRY (pg_panel_paint (p, canvas.cr, 0, &s, s.value, fine));
    draw_lines (d, canvas.cr, &s);
    pg_panel_draw (p, canvas.cr, 0, NULL);
    pg_sheet_draw (p, canvas.cr, &body, &d->grid, d->style);
done:
    pg_screen_close (&s);
    return canvas.path ? pg_canvas_close (&canvas, status) : status;
}

/* The order of the steps: view, positions of the nodes, faces, frame, drawing. */
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
