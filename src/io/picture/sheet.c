/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sheet of a picture: one frame, or several of equal scale in rows; axes with the length unit; one
 * colour bar (or a legend) for all frames; title and note. Sizes are pixels of the PNG. */
#include "picture_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* All sizes are in pixels. WIDE, BROAD and TALL limit a single frame; SHARED is the width that
 * frames side by side share, LEAST_FRAME the least that one of them gets; the rest are the
 * parts around the frames. */
enum {
    WIDE = 1120,
    BROAD = 900,
    TALL = 1000,
    SHARED = 1440,
    LEAST_FRAME = 340,
    BAR = 30,
    BAR_GAP = 34,
    LEAST = 640,
    STRIP = 128,
    TITLE = 74,
    PANEL_TITLE = 48,
    GAP = 34,
    SIDE = 24,
    NOTE = 36
};

/* Adds a narrow margin; the unit is the largest of km, m, mm, µm, nm that is not larger than the body. */
void pg_sheet_frame (pg_sheet *p)
{
    static const double unit[] = { 1e3, 1, 1e-3, 1e-6 };
    double size = fmax (p->high[0] - p->low[0], p->high[1] - p->low[1]),
           margin = p->eye.framed ? 0.025 : 0.015;
    if (!(size > 0)) size = 1;
    for (int a = 0; a < 2; a++) p->low[a] -= margin * size, p->high[a] += margin * size;
    p->unit = p->bare ? 1 : 1e-9;
    for (int k = 3; k >= 0 && !p->bare; k--) if (size >= 0.999 * unit[k]) p->unit = unit[k];
}

/* Name of the length unit, "" for a mesh whose unit is not known. */
const char *pg_sheet_unit (const pg_sheet *p)
{
    return p->bare           ? ""
           : p->unit > 1     ? "km"
           : p->unit == 1    ? "m"
           : p->unit == 1e-3 ? "mm"
           : p->unit == 1e-6 ? "\xc2\xb5m"
                             : "nm";
}

/* Width or height for one of `parts` frames that share a side of the picture. */
static double most_of (double share, int parts)
{
    return fmax (LEAST_FRAME, share / parts);
}

/* Default number of columns for n frames; frames of wide bodies stand one above the other. */
static int usual_columns (int n, int wide)
{
    static const int columns[] = { 1, 1, 2, 2, 2, 3, 3, 3, 3, 3 };
    if (wide && n < 6) return 1;
    return n < 10 ? columns[n] : 4;
}

/* Chooses rows, columns and the size of one frame. The frame has the shape of the body unless that would be a
 * thin strip; then it is larger than the body, at an unchanged scale. */
static void size_frame (pg_sheet *p)
{
    double w = p->high[0] - p->low[0], h = p->high[1] - p->low[1];
    int n = (int) p->panels, wide = w > 2.2 * h;
    if (p->columns < 1) p->columns = usual_columns (n, wide);
    if (p->columns > n) p->columns = n;
    p->rows = (n + p->columns - 1) / p->columns;
    p->flat = n == 1 && wide && p->eye.framed && !p->nlegend;
    double broad = p->columns > 1 ? most_of (SHARED, p->columns) : wide ? WIDE : BROAD;
    double scale = fmin (broad / w, (p->rows > 1 ? most_of (SHARED, p->rows) : TALL) / h);
    p->width = ceil (fmax (w * scale, 0.15 * broad)), p->height = ceil (fmax (h * scale, 60));
    double extra[2] = { 0.5 * (p->width / scale - w), 0.5 * (p->height / scale - h) };
    for (int a = 0; a < 2; a++) p->low[a] -= extra[a], p->high[a] += extra[a];
}

/* Fits the axis across (a = 0) or upwards (a = 1). An oblique section has the axes s and t in
 * its plane; an axis along a coordinate that falls to the right or upwards is reversed. */
static void fit_axis (const pg_sheet *p, pg_axis *axis, cairo_t *cr, int a)
{
    char text[32];
    int k = p->eye.axis[a], reverse = k >= 0 && p->eye.sign[a] < 0;
    snprintf (text, sizeof text, p->bare ? "%c" : "%c (%s)", k < 0 ? (a ? 't' : 's') : "xyz"[k],
              pg_sheet_unit (p));
    double low = (reverse ? -p->high[a] : p->low[a]) / p->unit,
           high = (reverse ? -p->low[a] : p->high[a]) / p->unit;
    pg_axis_request request = { text, a ? PG_LEFT : PG_BOTTOM, 0, 0, 1 };
    pg_axis_fit (axis, cr, low, high, a ? p->height : p->width, &request);
    axis->reverse = reverse;
}

/* Pixels beside the colour bar: its axis, or the longest name of the legend. */
static double width_beside_bar (const pg_sheet *p, cairo_t *cr)
{
    double w = 0;
    for (size_t k = 0; k < p->nlegend; k++) w = fmax (w, pg_text (cr, p->legend[k], PG_FONT, 0, 0, 0, 0, 0));
    return p->nlegend ? ceil (w) + 24 : pg_axis_margin (&p->bar, cr);
}

/* Places frames, colour bar and note around each other and so finds the size of the picture. */
static void place_parts (pg_sheet *p, cairo_t *cr, const pg_picture_style *style)
{
    double bar = width_beside_bar (p, cr);
    double beside = p->eye.framed ? ceil (pg_axis_margin (&p->y, cr)) + 6 : SIDE;
    double below = p->eye.framed ? pg_axis_margin (&p->x, cr) : STRIP, above = p->titles ? PANEL_TITLE : 0;
    p->left = beside, p->top = (style->title && style->title[0] ? TITLE : SIDE) + above;
    p->pitch[0] = p->width + GAP, p->pitch[1] = p->height + GAP + above;
    double w = p->width + (p->columns - 1) * p->pitch[0], h = p->height + (p->rows - 1) * p->pitch[1];
    p->total[0] = p->left + w + (p->flat ? 46 : BAR_GAP + BAR + bar + 4);
    p->total[1] = ceil (p->top + h + below + (p->flat ? 14 + BAR + bar : 0) + 6);
    if (p->note[0]) p->total[1] += NOTE;
    if (p->total[0] < LEAST) p->left += floor (0.5 * (LEAST - p->total[0])), p->total[0] = LEAST;
    p->total[0] = ceil (p->total[0]);
    p->bar_at[0] = p->flat ? p->left : p->left + w + BAR_GAP, p->bar_at[2] = p->flat ? w : BAR;
    p->bar_at[1] = p->flat ? p->top + h + ceil (below) + 14 : p->top, p->bar_at[3] = p->flat ? BAR : h;
}

/* Sizes depend on texts and texts on sizes, so that texts are measured on a scratch surface. */
void pg_sheet_fit (pg_sheet *p, const pg_picture_style *style, double low, double high)
{
    cairo_surface_t *scratch = cairo_image_surface_create (CAIRO_FORMAT_A8, 1, 1);  /* to measure texts on */
    cairo_t *cr = cairo_create (scratch);
    size_frame (p);
    fit_axis (p, &p->x, cr, 0);
    fit_axis (p, &p->y, cr, 1);
    const char *label = style->label ? style->label : "";
    pg_axis_request request = { label, p->flat ? PG_BOTTOM : PG_RIGHT, style->log, 0, 0 };
    double h = p->height + (p->rows - 1) * (p->height + GAP + (p->titles ? PANEL_TITLE : 0));
    pg_axis_fit (&p->bar, cr, low, high, p->flat ? p->width : h, &request);
    if (p->nlegend) p->bar.low = 0, p->bar.high = PG_CATEGORIES, p->bar.log = 0;
    place_parts (p, cr, style);
    cairo_destroy (cr);
    cairo_surface_destroy (scratch);
}

/* Upper left corner of the frame of a panel, pixels. */
static void corner_of (const pg_sheet *p, size_t panel, double *x, double *y)
{
    *x = p->left + (double) (panel % (size_t) p->columns) * p->pitch[0];
    *y = p->top + (double) (panel / (size_t) p->columns) * p->pitch[1];
}

/* Converts metres in the plane of the picture to pixels. */
void pg_sheet_to (const pg_sheet *p, size_t panel, double a, double b, double *px, double *py)
{
    double x, y;
    corner_of (p, panel, &x, &y);
    *px = x + (a - p->low[0]) / (p->high[0] - p->low[0]) * p->width;
    *py = y + (p->high[1] - b) / (p->high[1] - p->low[1]) * p->height;
}

/* A black rectangle, moved to the middle of pixels so that its lines are sharp. */
static void draw_frame (cairo_t *cr, double x, double y, double w, double h)
{
    cairo_rectangle (cr, floor (x) + 0.5, floor (y) + 0.5, floor (w), floor (h));
    pg_stroke (cr, 2, 0, 0, 0);
}

/* Draws the arrow at an end of the colour bar beyond which there are values, in the colour of that end. */
static void draw_arrow (const pg_sheet *p, cairo_t *cr, int high)
{
    double x = p->bar_at[0], y = p->bar_at[1], w = p->bar_at[2], h = p->bar_at[3], rgb[3], size = 0.6 * BAR;
    p->colour (high, rgb);
    if (p->flat) {
        double end = high ? x + w : x;
        cairo_move_to (cr, end, y);
        cairo_line_to (cr, end + (high ? size : -size), y + 0.5 * h);
        cairo_line_to (cr, end, y + h);
    } else {
        double end = high ? y : y + h;
        cairo_move_to (cr, x, end);
        cairo_line_to (cr, x + 0.5 * w, end + (high ? -size : size));
        cairo_line_to (cr, x + w, end);
    }
    cairo_close_path (cr);
    cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
    cairo_fill_preserve (cr);
    pg_stroke (cr, 2, 0, 0, 0);
}

/* Draws the colour bar as a gradient of 65 stops, with an arrow at an end beyond which there are values. */
static void draw_bar (const pg_sheet *p, cairo_t *cr)
{
    double x = p->bar_at[0], y = p->bar_at[1], w = p->bar_at[2], h = p->bar_at[3], rgb[3];
    cairo_pattern_t *shade = cairo_pattern_create_linear (x, y + (p->flat ? 0 : h), x + (p->flat ? w : 0), y);
    for (int k = 0; k <= 64; k++) {
        p->colour (k / 64.0, rgb);
        cairo_pattern_add_color_stop_rgb (shade, k / 64.0, rgb[0], rgb[1], rgb[2]);
    }
    cairo_rectangle (cr, x, y, w, h);
    cairo_set_source (cr, shade);
    cairo_fill (cr);
    cairo_pattern_destroy (shade);
    draw_frame (cr, x, y, w, h);
    for (int side = 0; side < 2; side++) if (p->beyond[side]) draw_arrow (p, cr, side);
    pg_axis_draw (&p->bar, cr, x, y, w, h);
}

/* Draws the names of blocks or sets of a mesh with their colours, in place of a colour bar. */
static void draw_legend (const pg_sheet *p, cairo_t *cr)
{
    double x = p->bar_at[0], y = p->bar_at[1], rgb[3];
    for (size_t k = 0; k < p->nlegend; k++, y += 1.6 * PG_FONT) {
        p->colour ((double) k / PG_CATEGORIES, rgb);
        cairo_rectangle (cr, x + 0.5, floor (y) + 0.5, BAR, 0.9 * PG_FONT);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        cairo_fill_preserve (cr);
        pg_stroke (cr, 1.5, 0.25, 0.25, 0.25);
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, p->legend[k], PG_FONT, x + BAR + 12, y + 0.45 * PG_FONT, 0, 0, 1);
    }
}

/* Draws, below a view without axes, the directions of the axes and the size of the body's box. */
static void draw_strip (const pg_sheet *p, cairo_t *cr, const pg_grid *g)
{
    char text[160];
    double room = p->total[0] - 2 * SIDE - 130, size = PG_FONT,
           y = p->total[1] - 0.5 * STRIP - 4 - (p->note[0] ? NOTE : 0);
    snprintf (text, sizeof text, "%.4g \xc3\x97 %.4g \xc3\x97 %.4g %s%s(x \xc3\x97 y \xc3\x97 z)",
              (g->high[0] - g->low[0]) / p->unit, (g->high[1] - g->low[1]) / p->unit,
              (g->high[2] - g->low[2]) / p->unit, pg_sheet_unit (p), p->bare ? "" : " ");
    double w = pg_text (cr, text, size, 0, 0, 0, 0, 0);
    if (w > room) size *= room / w;
    pg_wire_triad (p, cr, SIDE + 52, y + 10, 42);
    cairo_set_source_rgb (cr, 0, 0, 0);
    pg_text (cr, text, size, SIDE + 130, y, 0, 0, 1);
}

/* Draws the line of text at the lower edge, made smaller if it is too long. */
static void draw_note (const pg_sheet *p, cairo_t *cr)
{
    double size = 0.8 * PG_FONT, room = p->total[0] - 2 * SIDE,
           w = pg_text (cr, p->note, size, 0, 0, 0, 0, 0);
    if (w > room) size *= room / w;
    cairo_set_source_rgb (cr, 0.25, 0.25, 0.25);
    pg_text (cr, p->note, size, 0.5 * p->total[0], p->total[1] - 0.5 * NOTE - 4, 0.5, 0, 1);
}

/* Writes the note below the picture if some values lie outside the range of the colours (low, high): what
 * share of the points the colours cover, and the range of all values. */
static void leave_out (pg_sheet *p, const char *label, size_t n, const double *value, double low, double high)
{
    double least = INFINITY, most = -INFINITY, slack = 1e-9 * (high - low), all = 0, in = 0;
    char unit[32] = "", end[2][48];
    const char *open = label ? strrchr (label, '(') : NULL;
    for (size_t i = 0; i < n; i++) {
        if (!isfinite (value[i])) continue;
        least = fmin (least, value[i]), most = fmax (most, value[i]);
        all++, in += value[i] >= low - slack && value[i] <= high + slack;
    }
    p->note[0] = 0;
    if (!(in < all)) return;
    if (open) snprintf (unit, sizeof unit, "%.*s", (int) strcspn (open + 1, ")"), open + 1);
    for (int k = 0; k < 2; k++) {
        if (*unit && strchr ("NmPJ", *unit))
            pg_picture_quantity (k ? most : least, unit, end[k], sizeof end[k]);
        else snprintf (end[k], sizeof end[k], "%.4g%s%s", k ? most : least, *unit ? " " : "", unit);
    }
    snprintf (p->note, sizeof p->note, "colours end at %.3g %% of the points; values from %s to %s",
              floor (1000 * in / all) / 10, end[0], end[1]);
}

/* Finds the ends of the colour range for all panels: those of the style, else those of the values shown;
 * symmetric about zero for a diverging map. */
static pg_status range_of (const pg_picture_style *style, size_t panels, size_t n, const double *value,
                           double *low, double *high)
{
    pg_status status = PG_OK;
    double *shown = NULL, from, to;
    int any = 0, found;
    *low = style->low, *high = style->high;
    if (*low < *high) return PG_OK;
    PG_ALLOC (shown, n);
    *low = 0, *high = 1;
    for (size_t k = 0; k < panels; k++) {
        for (size_t i = 0; i < n; i++) {
            double v = value[k * n + i];
            shown[i] = !style->log ? v : v != 0 ? fabs (v) : NAN;
        }
        PG_TRY (pg_picture_range (n, shown, style->clip ? 2 : 0, &from, &to, &found));
        if (found) *low = any ? fmin (*low, from) : from, *high = any ? fmax (*high, to) : to;
        any |= found;
    }
    if (style->log) pg_range_decades (low, high);
    else if (style->diverging) {
        double top = fmax (fabs (*low), fabs (*high));
        *high = top > 0 ? top : 1, *low = -*high;
    }
done:
    pg_free (shown);
    return status;
}

pg_status pg_sheet_colours (pg_sheet *p, const pg_picture_style *style, size_t panels, size_t n,
                            const double *value, double *low, double *high)
{
    p->colour = style->diverging && !style->log ? pg_colour_diverging : pg_colour_sequential;
    pg_status status = range_of (style, panels, n, value, low, high);
    if (status == PG_OK && !style->log && !style->reach)
        leave_out (p, style->label, panels * n, value, *low, *high);
    return status;
}

void pg_sheet_arrows (pg_sheet *p, size_t n, const double *value)
{
    const pg_axis *bar = &p->bar;
    double slack = 1e-9 * (bar->log ? bar->low : bar->high - bar->low);
    for (size_t i = 0; i < n; i++) {
        double v = bar->log ? fabs (value[i]) : value[i];
        if (!isfinite (v) || (bar->log && v == 0)) continue;
        p->beyond[0] |= v < bar->low - slack, p->beyond[1] |= v > bar->high + slack;
    }
}

/* Draws all that belongs to the sheet and not to one frame. */
void pg_sheet_draw (const pg_sheet *p, cairo_t *cr, const pg_cloud *cloud, const pg_grid *grid,
                    const pg_picture_style *style)
{
    double w = p->width + (p->columns - 1) * p->pitch[0];
    if (p->nlegend) draw_legend (p, cr);
    else draw_bar (p, cr);
    if (!p->eye.framed && cloud->dim == 3) draw_strip (p, cr, grid);
    if (p->note[0]) draw_note (p, cr);
    cairo_set_source_rgb (cr, 0, 0, 0);
    if (style->title)
        pg_title (cr, style->title, p->left + 0.5 * w, p->top - (p->titles ? PANEL_TITLE : 0) - 36,
                  p->total[0]);
}

/* Draws frame and title of a panel; axes stand along the left and the lower edge of the sheet only. */
void pg_panel_draw (const pg_sheet *p, cairo_t *cr, size_t panel, const char *title)
{
    double x, y, size = PG_FONT;
    corner_of (p, panel, &x, &y);
    if (p->eye.framed) draw_frame (cr, x, y, p->width, p->height);
    if (p->eye.framed && panel + (size_t) p->columns >= p->panels)
        pg_axis_draw (&p->x, cr, x, y, p->width, p->height);
    if (p->eye.framed && panel % (size_t) p->columns == 0)
        pg_axis_draw (&p->y, cr, x, y, p->width, p->height);
    if (!p->titles || !title) return;
    double w = pg_text (cr, title, size, 0, 0, 0, 0, 0);
    if (w > p->pitch[0]) size *= p->pitch[0] / w;
    cairo_set_source_rgb (cr, 0, 0, 0);
    pg_text (cr, title, size, x + 0.5 * p->width, y - 0.5 * PANEL_TITLE, 0.5, 0, 1);
}

/* The colour of a pixel as ARGB: that of its point's value times the brightness, grey for NAN,
 * the body behind selected points almost white, its outline grey, transparent where nothing
 * is. */
static uint32_t pixel_of (const pg_sheet *p, const pg_screen *s, size_t at, const double *value)
{
    int k = s->owner[at];
    double rgb[3] = { 0.62, 0.62, 0.62 }, shade = s->shade[at];
    if (k == PG_EMPTY) return 0;
    if (k == PG_GHOST) for (int c = 0; c < 3; c++) rgb[c] = 0.96, shade = 0.55 + 0.45 * s->shade[at];
    else if (k == PG_EDGE) for (int c = 0; c < 3; c++) rgb[c] = 0.50, shade = 1;
    else {
        double v = s->value ? s->value[at] : value[k];
        double t = pg_axis_at (&p->bar, p->bar.log ? fmax (fabs (v), p->bar.low) : v);
        if (isfinite (v) && isfinite (t))
            p->colour (lround (1023 * fmin (fmax (t, 0), 1)) / 1023.0, rgb);
    }
    uint32_t pixel = 0xff000000u;
    for (int c = 0; c < 3; c++) pixel |= (uint32_t) lround (255 * shade * rgb[c]) << (16 - 8 * c);
    return pixel;
}

/* Colours all pixels, in rows of `stride` bytes. A pixel that shows the same point at the same brightness as
 * the pixel before it gets the same colour, unless pixels have values of their own. */
static void paint_pixels (const pg_sheet *p, const pg_screen *s, const double *value, unsigned char *bytes,
                          size_t stride)
{
    uint32_t pixel = 0;
    size_t before = 0;
    for (int j = 0; j < s->height; j++)
        for (int i = 0; i < s->width; i++) {
            size_t at = (size_t) j * (size_t) s->width + (size_t) i;
            int same = at > 0 && !s->value && s->owner[at] == s->owner[before]
                       && memcmp (&s->shade[at], &s->shade[before], sizeof *s->shade) == 0;
            if (!same) pixel = pixel_of (p, s, at, value);
            memcpy (bytes + (size_t) j * stride + 4 * (size_t) i, &pixel, 4);
            before = at;
        }
}

pg_status pg_panel_paint (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_screen *s,
                          const double *value, int fine)
{
    pg_status status = PG_OK;
    double x, y;
    corner_of (p, panel, &x, &y);
    cairo_surface_t *image = cairo_image_surface_create (CAIRO_FORMAT_ARGB32, s->width, s->height);
    if (cairo_surface_status (image) != CAIRO_STATUS_SUCCESS)
        PG_FAIL (PG_E_MEMORY, "no memory for %d x %d pixels", s->width, s->height);
    paint_pixels (p, s, value, cairo_image_surface_get_data (image),
                  (size_t) cairo_image_surface_get_stride (image));
    cairo_surface_mark_dirty (image);
    cairo_save (cr);
    cairo_translate (cr, x, y);
    cairo_scale (cr, 1.0 / fine, 1.0 / fine);
    cairo_set_source_surface (cr, image, 0, 0);
    cairo_pattern_set_filter (cairo_get_source (cr),
                              p->eye.framed ? CAIRO_FILTER_NEAREST : CAIRO_FILTER_GOOD);
    cairo_paint (cr);
    cairo_restore (cr);
done:
    cairo_surface_destroy (image);
    return status;
}
