/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where a place of a chart lies on its sheet, and how a curve is drawn: its colour, its
 * dashes, its marker. Eight colours come first; from the ninth curve on the colours repeat
 * with dashes and hollow markers. The seven markers and eight colours make 56 different pairs. */
#include "chart.h"
#include <math.h>

enum { DASHES = 4 };

/* A logarithmic axis has no place for zero and negative values. */
int pg_chart_visible (const chart *c, double x, double y)
{
    return isfinite (x) && isfinite (y) && (!c->x.log || x > 0) && (!c->y.log || y > 0);
}

/* Pixels count downwards, values upwards. */
void pg_chart_place (const chart *c, double x, double y, double *px, double *py)
{
    *px = c->left + pg_axis_at (&c->x, x) * c->width;
    *py = c->top + (1 - pg_axis_at (&c->y, y)) * c->height;
}

/* Curves 9 to 16 have the colours of the first eight with dashes, and so on. */
void pg_chart_pen (cairo_t *cr, size_t k)
{
    static const double dash[DASHES][4] = { { 0 }, { 14, 7, 14, 7 }, { 3, 6, 3, 6 }, { 16, 6, 3, 6 } };
    double rgb[3];
    size_t kind = k / PG_CURVE_COLOURS % DASHES;
    pg_colour_curve (k, rgb);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_set_line_width (cr, 3);
    cairo_set_dash (cr, dash[kind], kind ? 4 : 0, 0);
}

/* Circle, square, triangle, diamond, triangle upside down, plus, cross in turn. */
void pg_chart_marker (cairo_t *cr, size_t k, double x, double y)
{
    static const double corner[4][4][2] = { { { -1, -1 }, { 1, -1 }, { 1, 1 }, { -1, 1 } },
                                            { { 0, -1.3 }, { 1.2, 0.9 }, { -1.2, 0.9 }, { 0, -1.3 } },
                                            { { 0, -1.4 }, { 1.2, 0 }, { 0, 1.4 }, { -1.2, 0 } },
                                            { { 0, 1.3 }, { 1.2, -0.9 }, { -1.2, -0.9 }, { 0, 1.3 } } };
    double r = 7, rgb[3], s = 1.3 * r;
    size_t kind = k % 7;
    pg_colour_curve (k, rgb);
    cairo_set_dash (cr, NULL, 0, 0);
    cairo_set_line_width (cr, 3);
    cairo_new_sub_path (cr);
    if (kind == 0) cairo_arc (cr, x, y, r, 0, 6.283185307179586);
    else if (kind < 5)
        for (int e = 0; e < 4; e++)
            cairo_line_to (cr, x + r * corner[kind - 1][e][0], y + r * corner[kind - 1][e][1]);
    else {
        double a = kind == 5 ? 0 : 0.75 * s, b = kind == 5 ? s : 0.75 * s;
        cairo_move_to (cr, x - b, y - a), cairo_line_to (cr, x + b, y + a);
        cairo_move_to (cr, x - a, y + b), cairo_line_to (cr, x + a, y - b);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        cairo_set_line_width (cr, 4);
        cairo_stroke (cr);
        return;
    }
    cairo_close_path (cr);
    if (k >= PG_CURVE_COLOURS) cairo_set_source_rgb (cr, 1, 1, 1);
    else cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_fill_preserve (cr);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    if (k >= PG_CURVE_COLOURS) cairo_stroke (cr);
    cairo_new_path (cr);
}

/* Sets a pen of the colour of curve k mixed with white, which stays visible behind the full one. */
void pg_chart_pale_pen (cairo_t *cr, size_t k)
{
    double rgb[3];
    pg_colour_curve (k, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = 1 - 0.38 * (1 - rgb[c]);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_set_line_width (cr, 1);
    cairo_set_dash (cr, NULL, 0, 0);
}
