/* SPDX-License-Identifier: GPL-3.0-or-later
 * Charts: curves as lines, markers or both over linear or logarithmic axes, with a grid, a legend, slope
 * triangles and marked points. The layout is found first, by measuring texts on a scratch surface: axes, then
 * the texts of marks, then the legend, as each of these avoids what the earlier ones occupy. Then everything
 * is drawn once.
 *
 * Eight colours come first; from the ninth curve on the colours repeat with dashes and hollow markers. The
 * seven markers and eight colours make 56 different pairs. */
#include "picture_private.h"
#include <math.h>

enum { WIDTH = 1200, HEIGHT = 840 };
/* Space between parts, length of the sample line in the legend (both pixels), largest number of
 * texts at marks. */
enum { CHART_GAP = 16, CHART_SAMPLE = 60, CHART_NOTES = 8 };
/* The layout of a chart in pixels from the upper left corner of the picture. */
typedef struct {
    /* What is drawn. */
    size_t  ncurve;
    const pg_curve *curves;
    const pg_chart_style *style;
    pg_axis x, y;
    /* The frame that the curves are drawn in. */
    double  left, top, width, height;
    /* Width of the whole picture, which grows if the legend stands beside the frame. */
    double  total;
    /* Left, top, width and height of the legend; width 0: there is none. */
    double  legend[4];
    /* Left, top, width and height of the texts of the first marks, pixels; width 0: there is no text. */
    double  note[CHART_NOTES][4];
} chart;

/* ---- pens ---------------------------------------------------------------------------------------------- */
/* 1 if a point can be drawn: its coordinates are finite, and positive on logarithmic axes. */
static int visible (const chart *c, double x, double y)
{
    return isfinite (x) && isfinite (y) && (!c->x.log || x > 0) && (!c->y.log || y > 0);
}

/* Converts a point (x, y) of the chart to pixels, which count downwards. */
static void place (const chart *c, double x, double y, double *px, double *py)
{
    *px = c->left + pg_axis_at (&c->x, x) * c->width;
    *py = c->top + (1 - pg_axis_at (&c->y, y)) * c->height;
}

/* Curves 9 to 16 have the colours of the first eight with dashes, and so on. */
static void set_pen (cairo_t *cr, size_t k)
{
    static const double dash[4][4] = { { 0 }, { 14, 7, 14, 7 }, { 3, 6, 3, 6 }, { 16, 6, 3, 6 } };
    double rgb[3];
    size_t kind = k / PG_CURVE_COLOURS % 4;
    pg_colour_curve (k, rgb);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_set_line_width (cr, 3);
    cairo_set_dash (cr, dash[kind], kind ? 4 : 0, 0);
}

/* Circle, square, triangle, diamond, triangle upside down, plus, cross in turn. */
static void draw_marker (cairo_t *cr, size_t k, double x, double y)
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
        pg_stroke (cr, 4, rgb[0], rgb[1], rgb[2]);
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
static void set_pale_pen (cairo_t *cr, size_t k)
{
    double rgb[3];
    pg_colour_curve (k, rgb);
    for (int c = 0; c < 3; c++) rgb[c] = 1 - 0.38 * (1 - rgb[c]);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_set_line_width (cr, 1);
    cairo_set_dash (cr, NULL, 0, 0);
}

/* ---- slopes -------------------------------------------------------------------------------------------- */
/* Value of a curve at x by linear interpolation of the logarithms; NAN where the curve does
 * not reach. */
static double height_at (const chart *c, const pg_curve *curve, double x)
{
    for (size_t i = 0; i + 1 < curve->n; i++) {
        const double *a = curve->x + i, *b = curve->y + i;
        if (!visible (c, a[0], b[0]) || !visible (c, a[1], b[1]) || a[0] == a[1]) continue;
        double t = log (x / a[0]) / log (a[1] / a[0]);
        if (t >= -1e-9 && t <= 1 + 1e-9) return b[0] * pow (b[1] / b[0], t);
    }
    return NAN;
}

/* Range of x of a slope triangle for which the caller gives none: the middle 28 % of the curve's range in
 * log x. */
static void middle_part (const chart *c, const pg_curve *curve, double *low, double *high)
{
    double from = INFINITY, to = 0;
    for (size_t i = 0; i < curve->n; i++)
        if (visible (c, curve->x[i], curve->y[i]))
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
        if (visible (c, curve->x[i], curve->y[i]) && curve->x[i] > low && curve->x[i] < high)
            least = fmin (least, curve->y[i] * pow (low / curve->x[i], slope->order));
    place (c, low, least, &px[0], &py[0]);
    place (c, high, least * pow (high / low, slope->order), &px[1], &py[1]);
    for (int e = 0; e < 2; e++) py[e] += 22;           /* below the curve and its markers */
    px[2] = px[slope->order >= 0], py[2] = fmax (py[0], py[1]);
    return 1;
}

/* Draws a slope triangle, with the order beside its vertical side and 1 below its horizontal one. */
static void draw_slope (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k,
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
    pg_stroke (cr, 1.5, 0.25, 0.25, 0.25);
    snprintf (text, sizeof text, "%.3g", fabs (slope->order));
    pg_text (cr, text, size, px[2] + (rising ? 8 : -8), 0.5 * (py[0] + py[1]), rising ? 0 : 1, 0, 1);
    pg_text (cr, "1", size, 0.5 * (px[0] + px[1]), py[2] + 0.8 * size, 0.5, 0, 1);
}

/* ---- legend -------------------------------------------------------------------------------------------- */
static const double row = 1.45 * PG_FONT;

/* Number of rows of the legend: one for each curve, and one for all the pale ones together. */
static size_t legend_rows (const chart *c)
{
    for (size_t k = 0; k < c->style->npale; k++) if (c->style->pale[k].n) return c->ncurve + 1;
    return c->ncurve;
}

/* Text of row k of the legend: the name of curve k, or in the last row that of the pale curves. */
static const char *name_of_row (const chart *c, size_t k)
{
    const char *name = k < c->ncurve ? c->curves[k].name : c->style->pale[0].name;
    return name ? name : "";
}

static void size_legend (chart *c, cairo_t *cr)
{
    double w = 0;
    size_t rows = legend_rows (c);
    for (size_t k = 0; k < rows; k++)
        w = fmax (w, pg_text (cr, name_of_row (c, k), PG_FONT, 0, 0, 0, 0, 0));
    c->legend[2] = ceil (w + CHART_SAMPLE + 3 * CHART_GAP),
    c->legend[3] = ceil (row * (double) rows + CHART_GAP);
}

/* Number of sampled points of a curve (16 between neighbouring data points) that lie in a box. */
static size_t crowd_of_curve (const chart *c, const pg_curve *curve, const double *box)
{
    double x = box[0], y = box[1], w = box[2], h = box[3];
    size_t count = 0;
    for (size_t i = 0; i < curve->n; i++) {
        const double *a = curve->x + i, *b = curve->y + i;
        double px, py, qx, qy;
        if (!visible (c, *a, *b)) continue;
        place (c, *a, *b, &px, &py);
        qx = px, qy = py;
        if (curve->points != PG_CURVE_MARKERS && i + 1 < curve->n && visible (c, a[1], b[1]))
            place (c, a[1], b[1], &qx, &qy);
        for (int s = 0; s < 16; s++) {
            double ex = px + (qx - px) * s / 16, ey = py + (qy - py) * s / 16;
            count += ex > x && ex < x + w && ey > y && ey < y + h;
        }
    }
    return count;
}

/* How much a text or the legend in this box would hide: slope triangles, texts of marks and sampled points of
 * curves, all counted alike. */
static size_t crowd (const chart *c, const double *box)
{
    double x = box[0], y = box[1], w = box[2], h = box[3];
    size_t count = 0;
    double tx[3], ty[3], room = 1.5 * PG_FONT;         /* for the numbers at a triangle */
    for (size_t k = 0; k < c->style->nslope; k++) {
        const pg_chart_slope *s = &c->style->slopes[k];
        if (s->curve >= c->ncurve || !slope_corners (c, &c->curves[s->curve], s, tx, ty)) continue;
        count += fmin (tx[0], tx[1]) - room < x + w && fmax (tx[0], tx[1]) + room > x
                 && fmin (ty[0], ty[1]) < y + h && ty[2] + room > y;
    }
    for (size_t k = 0; k < CHART_NOTES; k++) {
        const double *n = c->note[k];
        count += n[2] > 0 && n[0] < x + w && n[0] + n[2] > x && n[1] < y + h && n[1] + n[3] > y;
    }
    for (size_t k = 0; k < c->ncurve; k++) count += crowd_of_curve (c, &c->curves[k], box);
    for (size_t k = 0; k < c->style->npale; k++) count += crowd_of_curve (c, &c->style->pale[k], box);
    return count;
}

/* Tries eight spots; returns 1 where none is free and the legend goes beside the frame. */
static int place_legend (chart *c)
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
        size_t n = crowd (c, (double[]) { bx - 10, by - 10, w + 20, h + 20 });
        if (n < least) least = n, c->legend[0] = bx, c->legend[1] = by;
    }
    if (!c->style->beside && least == 0 && w < 0.6 * c->width && h < 0.6 * c->height) return 0;
    c->legend[0] = c->left + c->width + 2 * gap, c->legend[1] = c->top;
    return 1;
}

static void draw_legend (const chart *c, cairo_t *cr)
{
    double x = c->legend[0], y = c->legend[1], w = c->legend[2], h = c->legend[3];
    cairo_rectangle (cr, floor (x) + 0.5, floor (y) + 0.5, floor (w), floor (h));
    cairo_set_source_rgba (cr, 1, 1, 1, 0.9);
    cairo_fill_preserve (cr);
    pg_stroke (cr, 1.5, 0.6, 0.6, 0.6);
    for (size_t k = 0; k < legend_rows (c); k++) {
        double middle = y + 0.5 * CHART_GAP + ((double) k + 0.5) * row;
        (k < c->ncurve ? set_pen : set_pale_pen) (cr, k % c->ncurve);
        if (k >= c->ncurve || c->curves[k].points != PG_CURVE_MARKERS) {
            cairo_move_to (cr, x + CHART_GAP, middle);
            cairo_rel_line_to (cr, CHART_SAMPLE, 0);
            cairo_stroke (cr);
        }
        if (k < c->ncurve && c->curves[k].points)
            draw_marker (cr, k, x + CHART_GAP + 0.5 * CHART_SAMPLE, middle);
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, name_of_row (c, k), PG_FONT, x + CHART_SAMPLE + 2 * CHART_GAP, middle, 0, 0, 1);
    }
}

/* ---- marks --------------------------------------------------------------------------------------------- */
/* Radius of a ring, and distance of the text from its middle, pixels. */
enum { RING = 11, AWAY = 18 };

/* Computes the box of a text of w x h pixels at one of eight spots around a ring: right, left,
 * above, below, then the four corners. The box is moved into the frame. */
static void spot_of (const chart *c, double px, double py, double w, double h, int spot, double box[4])
{
    static const signed char side[8][2] = { { 1, 0 },  { -1, 0 },  { 0, -1 }, { 0, 1 },
                                            { 1, -1 }, { -1, -1 }, { 1, 1 },  { -1, 1 } };
    box[0] = px + side[spot][0] * AWAY - (side[spot][0] < 0 ? w : side[spot][0] ? 0 : 0.5 * w);
    box[1] = py + side[spot][1] * AWAY - (side[spot][1] < 0 ? h : side[spot][1] ? 0 : 0.5 * h);
    box[0] = fmin (fmax (box[0], c->left + 6), c->left + c->width - w - 6);
    box[1] = fmin (fmax (box[1], c->top + 6), c->top + c->height - h - 6);
    box[2] = w, box[3] = h;
}

/* Places the text of each mark at the one of eight spots where it hides least; hiding its own ring
 * counts as worst. Earlier texts are obstacles to later ones. */
static void place_marks (chart *c, cairo_t *cr)
{
    for (size_t k = 0; k < c->style->nmark && k < CHART_NOTES; k++) {
        const pg_chart_mark *m = &c->style->marks[k];
        double px, py, box[4], best[4] = { 0 };
        size_t least = (size_t) -1;
        if (!m->text || !visible (c, m->x, m->y)) continue;
        place (c, m->x, m->y, &px, &py);
        double w = ceil (pg_text (cr, m->text, PG_FONT, 0, 0, 0, 0, 0)) + 8, h = 1.3 * PG_FONT;
        for (int spot = 0; spot < 8; spot++) {
            spot_of (c, px, py, w, h, spot, box);
            int over = box[0] < px + RING && box[0] + w > px - RING && box[1] < py + RING
                       && box[1] + h > py - RING;
            size_t n = crowd (c, box) + (over ? 1000000 : 0);
            if (n >= least) continue;
            least = n;
            for (int i = 0; i < 4; i++) best[i] = box[i];
        }
        for (int i = 0; i < 4; i++) c->note[k][i] = best[i];
    }
}

static void draw_marks (const chart *c, cairo_t *cr)
{
    double px, py, rgb[3];
    cairo_set_dash (cr, NULL, 0, 0);
    for (size_t k = 0; k < c->style->nmark; k++) {
        const pg_chart_mark *m = &c->style->marks[k];
        if (!visible (c, m->x, m->y)) continue;
        place (c, m->x, m->y, &px, &py);
        pg_colour_curve (m->curve, rgb);
        cairo_new_sub_path (cr);
        cairo_arc (cr, px, py, RING, 0, 6.283185307179586);
        cairo_set_source_rgb (cr, 1, 1, 1);
        cairo_set_line_width (cr, 5);
        cairo_stroke_preserve (cr);
        pg_stroke (cr, 3, rgb[0], rgb[1], rgb[2]);
        if (!m->text || k >= CHART_NOTES) continue;
        const double *box = c->note[k];
        cairo_rectangle (cr, box[0], box[1], box[2], box[3]);
        cairo_set_source_rgba (cr, 1, 1, 1, 0.8);
        cairo_fill (cr);
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, m->text, PG_FONT, box[0] + 4, box[1] + 0.5 * box[3], 0, 0, 1);
    }
}

/* ---- the chart ----------------------------------------------------------------------------------------- */
/* Extends the ranges x and y by the visible points of curves; *found becomes 1 at the first
 * one. */
static void widen (int *found, size_t ncurve, const pg_curve *curves, const chart *c, double x[2],
                   double y[2])
{
    for (size_t k = 0; k < ncurve; k++)
        for (size_t i = 0; i < curves[k].n; i++) {
            double a = curves[k].x[i], b = curves[k].y[i];
            if (!visible (c, a, b)) continue;
            if (!*found) x[0] = x[1] = a, y[0] = y[1] = b;
            x[0] = fmin (x[0], a), x[1] = fmax (x[1], a), y[0] = fmin (y[0], b), y[1] = fmax (y[1], b);
            *found = 1;
        }
}

/* Ranges of everything drawn, the pale curves too; a chart without a single point shows 1 to 10. */
static void ranges (const chart *c, double x[2], double y[2])
{
    int found = 0;
    widen (&found, c->ncurve, c->curves, c, x, y);
    widen (&found, c->style->npale, c->style->pale, c, x, y);
    if (!found) x[0] = y[0] = 1, x[1] = y[1] = 10;
}

/* Axes first (the height of the plot depends on the texts below it, its width on those beside it), then
 * the texts of marks, then the legend, which keeps clear of everything placed so far and may widen the
 * picture. */
static void lay_out (chart *c)
{
    double x[2], y[2];
    cairo_surface_t *scratch = cairo_image_surface_create (CAIRO_FORMAT_A8, 1, 1);  /* to measure texts on */
    cairo_t *cr = cairo_create (scratch);
    pg_axis_request wx = { c->style->xlabel ? c->style->xlabel : "", PG_BOTTOM, c->style->logx, 1, 0 };
    pg_axis_request wy = { c->style->ylabel ? c->style->ylabel : "", PG_LEFT, c->style->logy, 1, 0 };
    c->x.log = c->style->logx, c->y.log = c->style->logy;
    ranges (c, x, y);
    c->top = c->style->title && c->style->title[0] ? 70 : 30;
    c->height = HEIGHT - c->top - 110;
    pg_axis_fit (&c->y, cr, y[0], y[1], c->height, &wy);
    c->left = ceil (pg_axis_margin (&c->y, cr)) + 6;
    c->width = WIDTH - c->left - 50;
    pg_axis_fit (&c->x, cr, x[0], x[1], c->width, &wx);
    c->height = floor (HEIGHT - c->top - pg_axis_margin (&c->x, cr) - 4);
    c->total = WIDTH;
    place_marks (c, cr);
    if (legend_rows (c) > 1) {
        size_legend (c, cr);
        if (place_legend (c))
            c->total = ceil (c->legend[0] + c->legend[2] + CHART_GAP);
    }
    cairo_destroy (cr);
    cairo_surface_destroy (scratch);
}

/* Draws pale lines at the ticks of both axes, paler ones at the unlabelled ticks. */
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

/* Draws the lines x = 0 and y = 0 if they lie inside the frame. */
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

/* Draws a polyline, interrupted at points that cannot be drawn. Points closer than a quarter of a
 * pixel to the last drawn one are left out, which keeps the file of a curve with 1e6 points
 * small. */
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

/* Draws the line of a curve, its markers, or both. */
static void draw_curve (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k)
{
    double px, py;
    set_pen (cr, k);
    if (curve->points != PG_CURVE_MARKERS) line (c, cr, curve);
    for (size_t i = 0; curve->points && i < curve->n; i++) {
        if (!visible (c, curve->x[i], curve->y[i])) continue;
        place (c, curve->x[i], curve->y[i], &px, &py);
        draw_marker (cr, k, px, py);
    }
    cairo_set_dash (cr, NULL, 0, 0);
}

/* Draws grid, frame and axes, then what lies inside the frame, clipped to it, then texts. */
static void draw_chart (const chart *c, cairo_t *cr)
{
    draw_grid (c, cr);
    if (c->style->zero) draw_zero (c, cr);
    cairo_rectangle (cr, floor (c->left) + 0.5, floor (c->top) + 0.5, floor (c->width), floor (c->height));
    pg_stroke (cr, 2, 0, 0, 0);
    pg_axis_draw (&c->x, cr, c->left, c->top, c->width, c->height);
    pg_axis_draw (&c->y, cr, c->left, c->top, c->width, c->height);
    cairo_set_line_join (cr, CAIRO_LINE_JOIN_ROUND);
    cairo_save (cr);
    /* markers on the frame stay whole */
    cairo_rectangle (cr, c->left - 12, c->top - 12, c->width + 24, c->height + 24);
    cairo_clip (cr);
    for (size_t k = 0; k < c->style->nslope; k++)
        if (c->style->slopes[k].curve < c->ncurve)
            draw_slope (c, cr, &c->curves[c->style->slopes[k].curve], c->style->slopes[k].curve,
                        &c->style->slopes[k]);
    for (size_t k = 0; k < c->style->npale; k++) set_pale_pen (cr, k), line (c, cr, &c->style->pale[k]);
    for (size_t k = 0; k < c->ncurve; k++) draw_curve (c, cr, &c->curves[k], k);
    cairo_restore (cr);
    draw_marks (c, cr);
    if (legend_rows (c) > 1) draw_legend (c, cr);
    cairo_set_source_rgb (cr, 0, 0, 0);
    if (c->style->title) pg_title (cr, c->style->title, c->left + 0.5 * c->width, c->top - 34, c->total);
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
    c->ncurve = ncurve, c->curves = curves, c->style = style;
    lay_out (c);
    PG_TRY (pg_canvas_open (&canvas, path, c->total, HEIGHT));
    draw_chart (c, canvas.cr);
done:
    status = pg_canvas_close (&canvas, status);
    pg_free (c);
    return status;
}
