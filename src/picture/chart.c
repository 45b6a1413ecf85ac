/* SPDX-License-Identifier: GPL-3.0-or-later
 * Charts: curves as lines, markers or both over linear or logarithmic axes, with a grid, a legend, slope
 * triangles and marked points. The layout is found first, by measuring texts on a scratch surface; then
 * everything is drawn once. */
#include "chart.h"
#include <math.h>

enum { WIDTH = 1200, HEIGHT = 840 };

/* Extends the ranges x and y by the visible points of curves; *found becomes 1 at the first
 * one. */
static void widen (int *found, size_t ncurve, const pg_curve *curves, const chart *c, double x[2],
                   double y[2])
{
    for (size_t k = 0; k < ncurve; k++)
        for (size_t i = 0; i < curves[k].n; i++) {
            double a = curves[k].x[i], b = curves[k].y[i];
            if (!pg_chart_visible (c, a, b)) continue;
            if (!*found) x[0] = x[1] = a, y[0] = y[1] = b;
            x[0] = fmin (x[0], a), x[1] = fmax (x[1], a), y[0] = fmin (y[0], b), y[1] = fmax (y[1], b);
            *found = 1;
        }
}

/* Ranges of everything drawn, the pale curves too; a chart without a single point shows 1 to 10. */
static void ranges (size_t ncurve, const pg_curve *curves, const chart *c, const pg_chart_style *style,
                    double x[2], double y[2])
{
    int found = 0;
    widen (&found, ncurve, curves, c, x, y);
    widen (&found, style->npale, style->pale, c, x, y);
    if (!found) x[0] = y[0] = 1, x[1] = y[1] = 10;
}

/* Axes first (the height of the plot depends on the texts below it, its width on those beside it), then
 * the texts of marks, then the legend, which keeps clear of everything placed so far and may widen the
 * picture. */
static void lay_out (chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    double x[2], y[2];
    cairo_surface_t *scratch = cairo_image_surface_create (CAIRO_FORMAT_A8, 1, 1);  /* to measure texts on */
    cairo_t *cr = cairo_create (scratch);
    pg_axis_request wx = { style->xlabel ? style->xlabel : "", PG_BOTTOM, style->logx, 1, 0 };
    pg_axis_request wy = { style->ylabel ? style->ylabel : "", PG_LEFT, style->logy, 1, 0 };
    c->x.log = style->logx, c->y.log = style->logy;
    ranges (ncurve, curves, c, style, x, y);
    c->top = style->title && style->title[0] ? 70 : 30;
    c->height = HEIGHT - c->top - 110;
    pg_axis_fit (&c->y, cr, y[0], y[1], c->height, &wy);
    c->left = ceil (pg_axis_margin (&c->y, cr)) + 6;
    c->width = WIDTH - c->left - 50;
    pg_axis_fit (&c->x, cr, x[0], x[1], c->width, &wx);
    c->height = floor (HEIGHT - c->top - pg_axis_margin (&c->x, cr) - 4);
    c->total = WIDTH;
    pg_chart_marks_place (c, cr, ncurve, curves, style);
    if (pg_chart_legend_rows (ncurve, style) > 1) {
        pg_chart_legend_size (c, cr, ncurve, curves, style);
        if (pg_chart_legend_place (c, ncurve, curves, style))
            c->total = ceil (c->legend[0] + c->legend[2] + CHART_GAP);
    }
    cairo_destroy (cr);
    cairo_surface_destroy (scratch);
}

/* Pale lines at the ticks of both axes, paler ones at the unlabelled ticks. */
static void draw_grid (const chart *c, cairo_t *cr)
{
    for (int pass = 0; pass < 2; pass++) {
        const pg_axis *a = pass ? &c->y : &c->x;
        for (int k = -a->nminor; k < a->n; k++) {
            double t = pg_axis_at (a, k < 0 ? a->minor[-k - 1] : a->tick[k]), shade = k < 0 ? 0.94 : 0.86;
            cairo_set_source_rgb (cr, shade, shade, shade);
            cairo_set_line_width (cr, k < 0 ? 1 : 1.5);
            cairo_move_to (cr, c->left + (pass ? 0 : t * c->width),
                           c->top + (pass ? (1 - t) * c->height : 0));
            cairo_rel_line_to (cr, pass ? c->width : 0, pass ? 0 : c->height);
            cairo_stroke (cr);
        }
    }
}

/* The lines x = 0 and y = 0, where values of both signs are seen. */
static void draw_zero (const chart *c, cairo_t *cr)
{
    double x = pg_axis_at (&c->x, 0), y = pg_axis_at (&c->y, 0);
    cairo_set_source_rgb (cr, 0.45, 0.45, 0.45);
    cairo_set_line_width (cr, 1.5);
    if (!c->x.log && x > 0 && x < 1)
        cairo_move_to (cr, c->left + x * c->width, c->top), cairo_rel_line_to (cr, 0, c->height);
    if (!c->y.log && y > 0 && y < 1)
        cairo_move_to (cr, c->left, c->top + (1 - y) * c->height), cairo_rel_line_to (cr, c->width, 0);
    cairo_stroke (cr);
}

/* A polyline, interrupted at places that cannot be drawn. Points closer than a quarter of a
 * pixel to the last drawn one are left out, which keeps the file of a curve with 1e6 points
 * small. */
static void line (const chart *c, cairo_t *cr, const pg_curve *curve)
{
    double px, py, qx = 0, qy = 0;
    int pen = 0;
    for (size_t i = 0; i < curve->n; i++) {
        if (!pg_chart_visible (c, curve->x[i], curve->y[i])) {
            pen = 0;
            continue;
        }
        pg_chart_place (c, curve->x[i], curve->y[i], &px, &py);
        if (pen && i + 1 < curve->n && fabs (px - qx) < 0.25 && fabs (py - qy) < 0.25) continue;
        if (pen) cairo_line_to (cr, px, py);
        else cairo_move_to (cr, px, py);
        pen = 1, qx = px, qy = py;
    }
    cairo_stroke (cr);
}

/* The line of a curve, its markers, or both. */
static void draw_curve (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k)
{
    double px, py;
    pg_chart_pen (cr, k);
    if (curve->points != PG_CURVE_MARKERS) line (c, cr, curve);
    for (size_t i = 0; curve->points && i < curve->n; i++) {
        if (!pg_chart_visible (c, curve->x[i], curve->y[i])) continue;
        pg_chart_place (c, curve->x[i], curve->y[i], &px, &py);
        pg_chart_marker (cr, k, px, py);
    }
    cairo_set_dash (cr, NULL, 0, 0);
}

/* Grid, frame and axes, then what lies inside the frame, clipped to it, then texts. */
static void draw_chart (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style)
{
    draw_grid (c, cr);
    if (style->zero) draw_zero (c, cr);
    cairo_set_source_rgb (cr, 0, 0, 0);
    cairo_set_line_width (cr, 2);
    cairo_rectangle (cr, floor (c->left) + 0.5, floor (c->top) + 0.5, floor (c->width), floor (c->height));
    cairo_stroke (cr);
    pg_axis_draw (&c->x, cr, c->left, c->top, c->width, c->height);
    pg_axis_draw (&c->y, cr, c->left, c->top, c->width, c->height);
    cairo_set_line_join (cr, CAIRO_LINE_JOIN_ROUND);
    cairo_save (cr);
    /* markers on the frame stay whole */
    cairo_rectangle (cr, c->left - 12, c->top - 12, c->width + 24, c->height + 24);
    cairo_clip (cr);
    for (size_t k = 0; k < style->nslope; k++)
        if (style->slopes[k].curve < ncurve)
            pg_chart_slope_draw (c, cr, &curves[style->slopes[k].curve], style->slopes[k].curve,
                              &style->slopes[k]);
    for (size_t k = 0; k < style->npale; k++) pg_chart_pale_pen (cr, k), line (c, cr, &style->pale[k]);
    for (size_t k = 0; k < ncurve; k++) draw_curve (c, cr, &curves[k], k);
    cairo_restore (cr);
    pg_chart_marks_draw (c, cr, style);
    if (pg_chart_legend_rows (ncurve, style) > 1) pg_chart_legend_draw (c, cr, ncurve, curves, style);
    cairo_set_source_rgb (cr, 0, 0, 0);
    if (style->title) pg_title (cr, style->title, c->left + 0.5 * c->width, c->top - 34, c->total);
}

/* The layout comes before the file is created, since it decides how wide the picture is. */
pg_status pg_picture_chart (const char *path, size_t ncurve, const pg_curve *curves,
                            const pg_chart_style *style)
{
    pg_status status = PG_OK;
    pg_canvas canvas = { 0 };
    chart *c = NULL;
    PG_TRY (pg_cairo_load ());
    PG_ALLOC (c, 1);
    lay_out (c, ncurve, curves, style);
    PG_TRY (pg_canvas_open (&canvas, path, c->total, HEIGHT));
    draw_chart (c, canvas.cr, ncurve, curves, style);
done:
    status = pg_canvas_close (&canvas, status);
    pg_free (c);
    return status;
}
