/* SPDX-License-Identifier: GPL-3.0-or-later
 * Lines on pictures: pre-cracks (as they are in 2D; in 3D where they meet the plane shown, or their
 * outline), the displaced faces of cracks, the box of the body, and the coordinate axes as the eye sees them.
 * They are projected by the eye of the sheet and drawn over the painted pixels. */
#include "picture_private.h"
#include <math.h>
#include <string.h>

/* Converts a point x of space (3, m) to pixels in a panel. */
static void project (const pg_sheet *p, size_t panel, const double *x, double *px, double *py)
{
    pg_sheet_to (p, panel, pg_along (p->eye.right, x, 3), pg_along (p->eye.up, x, 3), px, py);
}

/* ---- cracks -------------------------------------------------------------------------------------------- */
/* Adds the polyline of a 2D crack to the path. */
static void path_2d (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_crack *crack)
{
    double px, py;
    for (size_t k = 0; k < crack->nvertex; k++) {
        pg_sheet_to (p, panel, crack->vertex[2 * k], crack->vertex[2 * k + 1], &px, &py);
        if (k) cairo_line_to (cr, px, py);
        else cairo_move_to (cr, px, py);
    }
}

/* The part of the line a - b inside the box, as parameters from 0 to 1 (Liang-Barsky
 * clipping); 0 if none of it is inside. */
static int clip_line (const pg_grid *g, const double *a, const double *b, double *from, double *to)
{
    *from = 0, *to = 1;
    for (int c = 0; c < 3; c++) {
        double d = b[c] - a[c], slack = 1e-6 * g->step[c];
        for (int side = 0; side < 2; side++) {
            double room = side ? g->high[c] + slack - a[c] : a[c] - g->low[c] + slack, slope = side ? d : -d;
            if (slope > 0) *to = fmin (*to, room / slope);
            else if (slope < 0) *from = fmax (*from, room / slope);
            else if (room < 0) return 0;
        }
    }
    return *from < *to;
}

/* Adds the lines in which a crack polygon meets the plane normal . x = at, inside the box. The
 * edges of the polygon that cross the plane come in pairs. */
static void path_of_cut (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g,
                         const pg_crack *crack, const double *normal, double at)
{
    double end[2][3], from, to, x[3], px, py;
    int pen = 0;
    for (size_t k = 0; k < crack->nvertex; k++) {
        const double *a = crack->vertex + 3 * k, *b = crack->vertex + 3 * ((k + 1) % crack->nvertex);
        double s = pg_along (normal, a, 3) - at, e = pg_along (normal, b, 3) - at;
        if ((s < 0) == (e < 0)) continue;
        for (int c = 0; c < 3; c++) end[pen % 2][c] = a[c] + s / (s - e) * (b[c] - a[c]);
        if (pen++ % 2 == 0 || !clip_line (g, end[0], end[1], &from, &to)) continue;
        for (int side = 0; side < 2; side++) {
            for (int c = 0; c < 3; c++) x[c] = end[0][c] + (side ? to : from) * (end[1][c] - end[0][c]);
            project (p, panel, x, &px, &py);
            if (side) cairo_line_to (cr, px, py);
            else cairo_move_to (cr, px, py);
        }
    }
}

/* Adds the line from a to b in space to the path, inside the box. With a screen only what is visible is
 * added, tested at 201 points to within one and a half cells, since cubes around points are coarser than the
 * crack. */
static void path_of_line (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g,
                          const pg_screen *screen, const double *a, const double *b)
{
    enum { PARTS = 200 };
    double from, to, x[3], at[3], px, py, slack = 1.5 * fmax (fmax (g->step[0], g->step[1]), g->step[2]);
    int pen = 0;
    if (!clip_line (g, a, b, &from, &to)) return;
    for (int k = 0; k <= PARTS; k++) {
        for (int c = 0; c < 3; c++) x[c] = a[c] + (from + (to - from) * k / PARTS) * (b[c] - a[c]);
        if (screen) pg_screen_place (screen, &p->eye, x, at);
        if (screen && !pg_in_sight (screen, at, slack)) {
            pen = 0;
            continue;
        }
        project (p, panel, x, &px, &py);
        if (pen++) cairo_line_to (cr, px, py);
        else cairo_move_to (cr, px, py);
    }
}

/* Adds the edges of a crack polygon inside the box (not of a triangle among many of a surface that has
 * grown), and the lines where its plane meets the faces of the box, where the crack is visible on the
 * surface. */
static void path_of_rim (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g,
                         const pg_screen *screen, const pg_crack *crack)
{
    for (size_t k = 0; k < crack->nvertex && !crack->sided; k++)
        path_of_line (p, cr, panel, g, screen, crack->vertex + 3 * k,
                      crack->vertex + 3 * ((k + 1) % crack->nvertex));
    for (int f = 0; f < 6; f++) {
        int axis = f / 2, pen = 0;
        double at = f % 2 ? g->high[axis] : g->low[axis], end[2][3];
        for (size_t k = 0; k < crack->nvertex; k++) {
            const double *a = crack->vertex + 3 * k, *b = crack->vertex + 3 * ((k + 1) % crack->nvertex);
            double s = a[axis] - at, e = b[axis] - at;
            if ((s < 0) == (e < 0)) continue;
            for (int c = 0; c < 3; c++) end[pen % 2][c] = c == axis ? at : a[c] + s / (s - e) * (b[c] - a[c]);
            if (pen++ % 2) path_of_line (p, cr, panel, g, screen, end[0], end[1]);
        }
    }
}

/* Adds what a view shows of one crack: the crack itself (2D), its cut with the section or with the
 * face of the box towards the eye, or its outline in space. */
static void path_of_crack (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g,
                           const pg_screen *screen, const pg_crack *crack)
{
    const pg_eye *e = &p->eye;
    if (e->kind == PG_FLAT) path_2d (p, cr, panel, crack);
    else if (e->kind != PG_SOLID)
        path_of_cut (p, cr, panel, g, crack, e->toward, e->cut < 0 || e->toward[e->cut] > 0 ? e->at : -e->at);
    else if (!e->framed) path_of_rim (p, cr, panel, g, screen, crack);
    else {                                             /* cut with the face towards the eye */
        double far = pg_along (e->toward, g->high, 3), near = pg_along (e->toward, g->low, 3),
               size = fmax (fmax (g->step[0], g->step[1]), g->step[2]);
        path_of_cut (p, cr, panel, g, crack, e->toward, fmax (far, near) - 1e-6 * size);
    }
}

/* Lines from here on end at the frame of the panel; cairo_restore ends that. */
static void clip_to_frame (const pg_sheet *p, cairo_t *cr, size_t panel)
{
    double x, y;
    pg_sheet_to (p, panel, p->low[0], p->high[1], &x, &y);
    cairo_save (cr);
    cairo_rectangle (cr, x, y, p->width, p->height);
    cairo_clip (cr);
    cairo_set_line_join (cr, CAIRO_LINE_JOIN_ROUND);
}

/* Black lines on broader white ones, so that cracks are seen on dark and on bright colours. */
void pg_wire_cracks (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g, const pg_cracks *cracks,
                     const pg_screen *screen)
{
    clip_to_frame (p, cr, panel);
    cairo_set_line_cap (cr, CAIRO_LINE_CAP_ROUND);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < cracks->n; k++) path_of_crack (p, cr, panel, g, screen, &cracks->crack[k]);
        pg_stroke (cr, pass ? 2.5 : 5, !pass, !pass, !pass);
    }
    cairo_restore (cr);
}

/* NAN begins a new line, and so does each face. */
void pg_wire_faces (const pg_sheet *p, cairo_t *cr, size_t panel, size_t n, size_t m, const double *place)
{
    double x, y;
    clip_to_frame (p, cr, panel);
    for (size_t i = 0; i < n * m; i++) {
        const double *a = place + 2 * i;
        if (!isfinite (a[0]) || !isfinite (a[1])) continue;
        pg_sheet_to (p, panel, a[0], a[1], &x, &y);
        if (i % m > 0 && isfinite (a[-2])) cairo_line_to (cr, x, y);
        else cairo_move_to (cr, x, y);
    }
    pg_stroke (cr, 2, 0, 0, 0);
    cairo_restore (cr);
}

/* ---- box and triad ------------------------------------------------------------------------------------- */
/* Corner k of the box has bit a set if it is the upper one along axis a; an edge joins corners
 * that differ in one bit. */
void pg_wire_box (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *g, int hidden)
{
    int farthest = 0;
    for (int a = 0; a < 3; a++) farthest |= (p->eye.toward[a] < 0) << a;
    for (int k = 0; k < 24; k++) {
        int axis = k / 8, from = k % 8, to = from | 1 << axis;
        if (from == to || (from == farthest || to == farthest) != hidden) continue;
        double end[2][3], px, py;
        for (int a = 0; a < 3; a++)
            end[0][a] = from >> a & 1 ? g->high[a] : g->low[a],
            end[1][a] = to >> a & 1 ? g->high[a] : g->low[a];
        project (p, panel, end[0], &px, &py);
        cairo_move_to (cr, px, py);
        project (p, panel, end[1], &px, &py);
        cairo_line_to (cr, px, py);
    }
    cairo_save (cr);
    cairo_set_line_cap (cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_source_rgb (cr, 0.42, 0.42, 0.42);
    cairo_set_line_width (cr, hidden ? 1.3 : 1.6);
    if (hidden) cairo_set_dash (cr, (double[]) { 6, 6 }, 2, 0);
    cairo_stroke (cr);
    cairo_restore (cr);
}

/* Arrows along x, y, z with their names; those towards the eye last. An axis that points straight at the eye,
 * or away from it, is a dot. */
void pg_wire_triad (const pg_sheet *p, cairo_t *cr, double x, double y, double length)
{
    static const double colour[3][3] = { { 0.75, 0.15, 0.12 }, { 0.10, 0.50, 0.20 }, { 0.10, 0.30, 0.70 } };
    int order[3] = { 0, 1, 2 };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 2; j++)
            if (p->eye.toward[order[j]] > p->eye.toward[order[j + 1]]) {
                int swap = order[j];
                order[j] = order[j + 1], order[j + 1] = swap;
            }
    cairo_set_line_width (cr, 3);
    for (int k = 0; k < 3; k++) {
        int a = order[k];
        double dx = length * p->eye.right[a], dy = -length * p->eye.up[a], size = hypot (dx, dy), arm = 11;
        cairo_set_source_rgb (cr, colour[a][0], colour[a][1], colour[a][2]);
        if (size < 0.15 * length) {                    /* straight at the eye, or away from it */
            cairo_arc (cr, x, y, 5, 0, 6.283185307179586);
            cairo_fill (cr);
            pg_text (cr, (const char[2]) { "xyz"[a], 0 }, 0.85 * PG_FONT, x - 16, y + 14, 0.5, 0, 1);
            continue;
        }
        cairo_move_to (cr, x, y);
        cairo_line_to (cr, x + dx, y + dy);
        cairo_stroke (cr);
        double ux = dx / size, uy = dy / size;
        cairo_move_to (cr, x + dx + 3 * ux, y + dy + 3 * uy);
        cairo_line_to (cr, x + dx - arm * ux - 0.4 * arm * uy, y + dy - arm * uy + 0.4 * arm * ux);
        cairo_line_to (cr, x + dx - arm * ux + 0.4 * arm * uy, y + dy - arm * uy - 0.4 * arm * ux);
        cairo_fill (cr);
        pg_text (cr, (const char[2]){ "xyz"[a], 0 }, 0.85 * PG_FONT, x + dx + 17 * ux, y + dy + 17 * uy, 0.5,
                 0, 1);
    }
}
