/* SPDX-License-Identifier: GPL-3.0-or-later
 * Charts: curves as lines or markers over linear or logarithmic axes, with grid and legend. */
#include "picture.h"
#include <math.h>
#include <string.h>

enum { WIDTH = 1200, HEIGHT = 840, GAP = 16, SAMPLE = 46 };

typedef struct {
    pg_axis x, y;
    double  left, top, width, height;                  /* frame                                                          */
} chart;

static int visible (const chart *c, double x, double y)
{
    return isfinite (x) && isfinite (y) && (!c->x.log || x > 0) && (!c->y.log || y > 0);
}

static void place (const chart *c, double x, double y, double *px, double *py)
{
    *px = c->left + pg_axis_at (&c->x, x) * c->width;
    *py = c->top + (1 - pg_axis_at (&c->y, y)) * c->height;
}

/* Ranges of the points drawn: both coordinates must be finite, and positive on a log axis. */
static void ranges (size_t ncurve, const pg_curve *curves, const chart *c, double x[2], double y[2])
{
    int found = 0;
    for (size_t k = 0; k < ncurve; k++)
        for (size_t i = 0; i < curves[k].n; i++) {
            double a = curves[k].x[i], b = curves[k].y[i];
            if (!visible (c, a, b)) continue;
            if (!found) x[0] = x[1] = a, y[0] = y[1] = b;
            x[0] = fmin (x[0], a), x[1] = fmax (x[1], a), y[0] = fmin (y[0], b), y[1] = fmax (y[1], b);
            found = 1;
        }
    if (!found) x[0] = y[0] = 1, x[1] = y[1] = 10;
}

static void lay_out (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    double x[2], y[2];
    pg_axis_wish wx = { style->xlabel ? style->xlabel : "", PG_BOTTOM, style->logx, 1, 0 };
    pg_axis_wish wy = { style->ylabel ? style->ylabel : "", PG_LEFT, style->logy, 1, 0 };
    c->x.log = style->logx, c->y.log = style->logy;
    ranges (ncurve, curves, c, x, y);
    c->top = style->title && style->title[0] ? 70 : 30;
    c->height = HEIGHT - c->top - 110;
    pg_axis_fit (&c->y, cr, y[0], y[1], c->height, &wy);
    c->left = ceil (pg_axis_room (&c->y, cr)) + 6;
    c->width = WIDTH - c->left - 50;
    pg_axis_fit (&c->x, cr, x[0], x[1], c->width, &wx);
    c->height = floor (HEIGHT - c->top - pg_axis_room (&c->x, cr) - 4);
}

static void draw_grid (const chart *c, cairo_t *cr)
{
    for (int pass = 0; pass < 2; pass++) {
        const pg_axis *a = pass ? &c->y : &c->x;
        for (int k = -a->nminor; k < a->n; k++) {
            double t = pg_axis_at (a, k < 0 ? a->minor[-k - 1] : a->tick[k]), shade = k < 0 ? 0.94 : 0.86;
            cairo_set_source_rgb (cr, shade, shade, shade);
            cairo_set_line_width (cr, k < 0 ? 1 : 1.5);
            cairo_move_to (cr, c->left + (pass ? 0 : t * c->width), c->top + (pass ? (1 - t) * c->height : 0));
            cairo_rel_line_to (cr, pass ? c->width : 0, pass ? 0 : c->height);
            cairo_stroke (cr);
        }
    }
}

/* Circle, square, triangle, diamond in turn. */
static void marker (cairo_t *cr, size_t kind, double x, double y)
{
    static const double corner[3][4][2] = { { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } },
        { { 0, -1.3 }, { 1.2, 0.9 }, { -1.2, 0.9 }, { 0, -1.3 } }, { { 0, -1.4 }, { 1.2, 0 }, { 0, 1.4 }, { -1.2, 0 } } };
    double r = 7;
    cairo_new_sub_path (cr);
    if (kind % 4 == 0) cairo_arc (cr, x, y, r, 0, 6.283185307179586);
    else for (int k = 0; k < 4; k++) cairo_line_to (cr, x + r * corner[kind % 4 - 1][k][0], y + r * corner[kind % 4 - 1][k][1]);
    cairo_close_path (cr);
}

/* A polyline, broken at what cannot be drawn; points closer than a quarter of a pixel to the last one are left out. */
static void line (const chart *c, cairo_t *cr, const pg_curve *curve)
{
    double px, py, qx = 0, qy = 0;
    int pen = 0;
    for (size_t i = 0; i < curve->n; i++) {
        if (!visible (c, curve->x[i], curve->y[i])) {
            pen = 0;
            continue;
        }
        place (c, curve->x[i], curve->y[i], &px, &py);
        if (pen && i + 1 < curve->n && fabs (px - qx) < 0.25 && fabs (py - qy) < 0.25) continue;
        if (pen) cairo_line_to (cr, px, py);
        else cairo_move_to (cr, px, py);
        pen = 1, qx = px, qy = py;
    }
    cairo_stroke (cr);
}

static void draw_curve (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k)
{
    double rgb[3], px, py;
    pg_colour_curve (k, rgb);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_set_line_width (cr, 3);
    if (!curve->points) {
        line (c, cr, curve);
        return;
    }
    for (size_t i = 0; i < curve->n; i++) {
        if (!visible (c, curve->x[i], curve->y[i])) continue;
        place (c, curve->x[i], curve->y[i], &px, &py);
        marker (cr, k, px, py);
        cairo_fill (cr);
    }
}

/* How much of the curves lies in a box: points, and places between neighbours on lines. */
static size_t crowd (const chart *c, size_t ncurve, const pg_curve *curves, double x, double y, double w, double h)
{
    size_t count = 0;
    for (size_t k = 0; k < ncurve; k++)
        for (size_t i = 0; i < curves[k].n; i++) {
            const double *a = curves[k].x + i, *b = curves[k].y + i;
            double px, py, qx, qy;
            if (!visible (c, *a, *b)) continue;
            place (c, *a, *b, &px, &py);
            qx = px, qy = py;
            if (!curves[k].points && i + 1 < curves[k].n && visible (c, a[1], b[1])) place (c, a[1], b[1], &qx, &qy);
            for (int s = 0; s < 16; s++) {
                double ex = px + (qx - px) * s / 16, ey = py + (qy - py) * s / 16;
                count += ex > x && ex < x + w && ey > y && ey < y + h;
            }
        }
    return count;
}

static void draw_legend (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves)
{
    double row = 1.45 * PG_FONT, w = 0, h = row * (double) ncurve + GAP, x = 0, y = 0;
    size_t least = (size_t) -1;
    for (size_t k = 0; k < ncurve; k++) w = fmax (w, pg_text (cr, curves[k].name ? curves[k].name : "", PG_FONT, 0, 0, 0, 0, 0));
    w += SAMPLE + 3 * GAP;
    for (int corner = 0; corner < 4; corner++) {       /* top right, top left, bottom right, bottom left */
        double bx = corner % 2 ? c->left + GAP : c->left + c->width - w - GAP;
        double by = corner / 2 ? c->top + c->height - h - GAP : c->top + GAP;
        size_t n = crowd (c, ncurve, curves, bx - 4, by - 4, w + 8, h + 8);
        if (n < least) least = n, x = bx, y = by;
    }
    cairo_rectangle (cr, floor (x) + 0.5, floor (y) + 0.5, floor (w), floor (h));
    cairo_set_source_rgba (cr, 1, 1, 1, 0.9);
    cairo_fill_preserve (cr);
    cairo_set_source_rgb (cr, 0.6, 0.6, 0.6);
    cairo_set_line_width (cr, 1.5);
    cairo_stroke (cr);
    for (size_t k = 0; k < ncurve; k++) {
        double rgb[3], middle = y + 0.5 * GAP + ((double) k + 0.5) * row;
        pg_colour_curve (k, rgb);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        cairo_set_line_width (cr, 3);
        if (curves[k].points) {
            marker (cr, k, x + GAP + 0.5 * SAMPLE, middle);
            cairo_fill (cr);
        } else {
            cairo_move_to (cr, x + GAP, middle);
            cairo_rel_line_to (cr, SAMPLE, 0);
            cairo_stroke (cr);
        }
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, curves[k].name ? curves[k].name : "", PG_FONT, x + SAMPLE + 2 * GAP, middle, 0, 0, 1);
    }
}

static void draw_chart (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    draw_grid (c, cr);
    cairo_set_line_join (cr, CAIRO_LINE_JOIN_ROUND);
    cairo_save (cr);
    cairo_rectangle (cr, c->left - 8, c->top - 8, c->width + 16, c->height + 16);     /* markers on the frame stay whole */
    cairo_clip (cr);
    for (size_t k = 0; k < ncurve; k++) draw_curve (c, cr, &curves[k], k);
    cairo_restore (cr);
    cairo_set_source_rgb (cr, 0, 0, 0);
    cairo_set_line_width (cr, 2);
    cairo_rectangle (cr, floor (c->left) + 0.5, floor (c->top) + 0.5, floor (c->width), floor (c->height));
    cairo_stroke (cr);
    pg_axis_draw (&c->x, cr, c->left, c->top, c->width, c->height);
    pg_axis_draw (&c->y, cr, c->left, c->top, c->width, c->height);
    if (ncurve > 1) draw_legend (c, cr, ncurve, curves);
    if (style->title) pg_title (cr, style->title, c->left + 0.5 * c->width, c->top - 34, WIDTH);
}

pg_status pg_picture_chart (const char *path, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    pg_status status = PG_OK;
    pg_canvas canvas = { 0 };
    chart *c = NULL;
    PG_ALLOC (c, 1);
    PG_TRY (pg_canvas_open (&canvas, path, WIDTH, HEIGHT));
    lay_out (c, canvas.cr, ncurve, curves, style);
    draw_chart (c, canvas.cr, ncurve, curves, style);
done:
    status = pg_canvas_close (&canvas, status);
    pg_free (c);
    return status;
}
