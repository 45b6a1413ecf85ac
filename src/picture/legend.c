/* SPDX-License-Identifier: GPL-3.0-or-later
 * Legends of charts, and the triangles that show the slope of a curve on logarithmic axes. A legend goes
 * where it hides nothing: eight places inside the frame are tried, and when all of them are crowded the
 * picture grows to hold it beside the frame. */
#include "chart.h"
#include <math.h>

/* ---- slopes -------------------------------------------------------------------------------------------- */
/* Value of a curve at x by linear interpolation of the logarithms; NAN where the curve does
 * not reach. */
static double height_at (const chart *c, const pg_curve *curve, double x)
{
    for (size_t i = 0; i + 1 < curve->n; i++) {
        const double *a = curve->x + i, *b = curve->y + i;
        if (!pg_chart_visible (c, a[0], b[0]) || !pg_chart_visible (c, a[1], b[1]) || a[0] == a[1]) continue;
        double t = log (x / a[0]) / log (a[1] / a[0]);
        if (t >= -1e-9 && t <= 1 + 1e-9) return b[0] * pow (b[1] / b[0], t);
    }
    return NAN;
}

/* Where a slope triangle goes unless the caller says: around the middle of the curve, over 28 % of its
 * decades. */
static void middle_part (const chart *c, const pg_curve *curve, double *low, double *high)
{
    double from = INFINITY, to = 0;
    for (size_t i = 0; i < curve->n; i++)
        if (pg_chart_visible (c, curve->x[i], curve->y[i]))
            from = fmin (from, curve->x[i]), to = fmax (to, curve->x[i]);
    *low = from * pow (to / from, 0.36), *high = from * pow (to / from, 0.64);
}

/* Corners of a slope triangle in pixels: the two ends of the hypotenuse, then the right angle.
 * The triangle is moved down until it lies below the curve at its ends and at all points
 * between them. Returns 0 if there is nothing to draw: linear axes, or a curve that does not
 * cover the range. */
static int slope_corners (const chart *c, const pg_curve *curve, const pg_chart_slope *slope, double px[3],
                          double py[3])
{
    double low = slope->low, high = slope->high;
    if (!c->x.log || !c->y.log) return 0;
    if (!(low < high)) middle_part (c, curve, &low, &high);
    double a = height_at (c, curve, low), b = height_at (c, curve, high),
           least = fmin (a, b * pow (low / high, slope->order));
    if (!(low > 0 && low < high) || !isfinite (a + b + least)) return 0;
    for (size_t i = 0; i < curve->n; i++)
        if (pg_chart_visible (c, curve->x[i], curve->y[i]) && curve->x[i] > low && curve->x[i] < high)
            least = fmin (least, curve->y[i] * pow (low / curve->x[i], slope->order));
    pg_chart_place (c, low, least, &px[0], &py[0]);
    pg_chart_place (c, high, least * pow (high / low, slope->order), &px[1], &py[1]);
    for (int e = 0; e < 2; e++) py[e] += 22;           /* below the curve and its markers */
    px[2] = px[slope->order >= 0], py[2] = fmax (py[0], py[1]);
    return 1;
}

/* The triangle, with the order beside its upright side and 1 below the level one. */
void pg_chart_slope_draw (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k,
                       const pg_chart_slope *slope)
{
    double rgb[3], px[3], py[3], size = 0.85 * PG_FONT;
    char text[32];
    int rising = slope->order >= 0;
    if (!slope_corners (c, curve, slope, px, py)) return;
    pg_colour_curve (k, rgb);
    for (int e = 0; e < 3; e++) cairo_line_to (cr, px[e], py[e]);
    cairo_close_path (cr);
    cairo_set_source_rgba (cr, rgb[0], rgb[1], rgb[2], 0.12);
    cairo_fill_preserve (cr);
    cairo_set_source_rgb (cr, 0.25, 0.25, 0.25);
    cairo_set_line_width (cr, 1.5);
    cairo_stroke (cr);
    snprintf (text, sizeof text, "%.3g", fabs (slope->order));
    pg_text (cr, text, size, px[2] + (rising ? 8 : -8), 0.5 * (py[0] + py[1]), rising ? 0 : 1, 0, 1);
    pg_text (cr, "1", size, 0.5 * (px[0] + px[1]), py[2] + 0.8 * size, 0.5, 0, 1);
}

/* ---- legend -------------------------------------------------------------------------------------------- */
static const double row = 1.45 * PG_FONT;

/* One row for each curve, and one for all the pale ones together. */
size_t pg_chart_legend_rows (size_t ncurve, const pg_chart_style *style)
{
    for (size_t k = 0; k < style->npale; k++) if (style->pale[k].n) return ncurve + 1;
    return ncurve;
}

/* Row k: the name of curve k, or at the end that of the pale curves. */
static const char *name_of_row (size_t k, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    const char *name = k < ncurve ? curves[k].name : style->pale[0].name;
    return name ? name : "";
}

void pg_chart_legend_size (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style)
{
    double w = 0;
    size_t rows = pg_chart_legend_rows (ncurve, style);
    for (size_t k = 0; k < rows; k++)
        w = fmax (w, pg_text (cr, name_of_row (k, ncurve, curves, style), PG_FONT, 0, 0, 0, 0, 0));
    c->legend[2] = ceil (w + CHART_SAMPLE + 3 * CHART_GAP),
    c->legend[3] = ceil (row * (double) rows + CHART_GAP);
}

/* How many of the places sampled on a curve (16 between neighbouring points) lie in a box. */
static size_t crowd_of_curve (const chart *c, const pg_curve *curve, const double *box)
{
    double x = box[0], y = box[1], w = box[2], h = box[3];
    size_t count = 0;
    for (size_t i = 0; i < curve->n; i++) {
        const double *a = curve->x + i, *b = curve->y + i;
        double px, py, qx, qy;
        if (!pg_chart_visible (c, *a, *b)) continue;
        pg_chart_place (c, *a, *b, &px, &py);
        qx = px, qy = py;
        if (curve->points != PG_CURVE_MARKERS && i + 1 < curve->n && pg_chart_visible (c, a[1], b[1]))
            pg_chart_place (c, a[1], b[1], &qx, &qy);
        for (int s = 0; s < 16; s++) {
            double ex = px + (qx - px) * s / 16, ey = py + (qy - py) * s / 16;
            count += ex > x && ex < x + w && ey > y && ey < y + h;
        }
    }
    return count;
}

/* How much a text or the legend in this box would hide: slope triangles, texts of marks and places on
 * curves, all counted alike. */
size_t pg_chart_crowd (const chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style,
                    const double *box)
{
    double x = box[0], y = box[1], w = box[2], h = box[3];
    size_t count = 0;
    double tx[3], ty[3], room = 1.5 * PG_FONT;         /* of the numbers at a triangle */
    for (size_t k = 0; k < style->nslope; k++) {
        const pg_chart_slope *s = &style->slopes[k];
        if (s->curve >= ncurve || !slope_corners (c, &curves[s->curve], s, tx, ty)) continue;
        count += fmin (tx[0], tx[1]) - room < x + w && fmax (tx[0], tx[1]) + room > x
                 && fmin (ty[0], ty[1]) < y + h && ty[2] + room > y;
    }
    for (size_t k = 0; k < CHART_NOTES; k++) {
        const double *n = c->note[k];
        count += n[2] > 0 && n[0] < x + w && n[0] + n[2] > x && n[1] < y + h && n[1] + n[3] > y;
    }
    for (size_t k = 0; k < ncurve; k++) count += crowd_of_curve (c, &curves[k], box);
    for (size_t k = 0; k < style->npale; k++) count += crowd_of_curve (c, &style->pale[k], box);
    return count;
}

/* Tries eight spots; returns 1 where none is free and the legend goes beside the frame. */
int pg_chart_legend_place (chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style)
{
    double w = c->legend[2], h = c->legend[3], gap = CHART_GAP;
    size_t least = (size_t) -1;
    /* right and left at the top, at the bottom, in the middle; middle of top, of bottom */
    for (int spot = 0; spot < 8; spot++) {
        double bx = spot > 5   ? c->left + 0.5 * (c->width - w)
                    : spot % 2 ? c->left + gap
                               : c->left + c->width - w - gap;
        double by = spot > 5   ? (spot == 6 ? c->top + gap : c->top + c->height - h - gap)
                    : spot < 2 ? c->top + gap
                    : spot < 4 ? c->top + c->height - h - gap
                               : c->top + 0.5 * (c->height - h);
        size_t n = pg_chart_crowd (c, ncurve, curves, style, (double[]) { bx - 10, by - 10, w + 20, h + 20 });
        if (n < least) least = n, c->legend[0] = bx, c->legend[1] = by;
    }
    if (!style->beside && least == 0 && w < 0.6 * c->width && h < 0.6 * c->height) return 0;
    c->legend[0] = c->left + c->width + 2 * gap, c->legend[1] = c->top;
    return 1;
}

void pg_chart_legend_draw (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style)
{
    double x = c->legend[0], y = c->legend[1], w = c->legend[2], h = c->legend[3];
    cairo_rectangle (cr, floor (x) + 0.5, floor (y) + 0.5, floor (w), floor (h));
    cairo_set_source_rgba (cr, 1, 1, 1, 0.9);
    cairo_fill_preserve (cr);
    cairo_set_source_rgb (cr, 0.6, 0.6, 0.6);
    cairo_set_line_width (cr, 1.5);
    cairo_stroke (cr);
    for (size_t k = 0; k < pg_chart_legend_rows (ncurve, style); k++) {
        double middle = y + 0.5 * CHART_GAP + ((double) k + 0.5) * row;
        (k < ncurve ? pg_chart_pen : pg_chart_pale_pen) (cr, k % ncurve);
        if (k >= ncurve || curves[k].points != PG_CURVE_MARKERS) {
            cairo_move_to (cr, x + CHART_GAP, middle);
            cairo_rel_line_to (cr, CHART_SAMPLE, 0);
            cairo_stroke (cr);
        }
        if (k < ncurve && curves[k].points)
            pg_chart_marker (cr, k, x + CHART_GAP + 0.5 * CHART_SAMPLE, middle);
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, name_of_row (k, ncurve, curves, style), PG_FONT, x + CHART_SAMPLE + 2 * CHART_GAP,
                 middle, 0, 0, 1);
    }
}
