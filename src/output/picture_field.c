/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields as pictures: a coloured cell per point in a frame of equal scales, colour bar, cracks. 1D: value over x; 3D: a section. */
#include "picture.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { WIDE = 1120, BROAD = 900, TALL = 1000, BAR = 30, BAR_GAP = 34, LEAST = 640 };

typedef struct {
    pg_spots spots;
    double  step[2], low[2], high[2];                  /* cell; frame, m                                                 */
    int     axis[2], cut;                              /* axes across and up; 3D: the axis cut, else -1                  */
    double  at, unit;                                  /* place of the cut, m; length unit, m                            */
    int     flat;                                      /* colour bar below                                               */
    double  left, top, width, height, total[2];        /* frame and picture, pixels                                      */
    pg_axis x, y, bar;
    pg_colour_map colour;
} plate;

/* The points drawn: all (2D), or those within half a step of the section (3D); places in m, moved by magnify u. */
static pg_status choose_points (plate *p, const pg_cloud *cloud, const double *value, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim;
    PG_ALLOC (p->spots.place, 2 * cloud->n);
    PG_ALLOC (p->spots.value, cloud->n);
    for (size_t i = 0; i < cloud->n; i++) {
        const double *x = cloud->x + i * dim;
        if (p->cut >= 0) {
            double half = 0.5 * (cloud->step[p->cut] > 0 ? cloud->step[p->cut] : cloud->h);
            if (fabs (x[p->cut] - p->at) > half * (1 + 1e-6)) continue;
        }
        size_t k = p->spots.n++;
        p->spots.value[k] = value[i];
        for (int a = 0; a < 2; a++)
            p->spots.place[2 * k + (size_t) a] = x[p->axis[a]] + (style->u ? style->magnify * style->u[i * dim + (size_t) p->axis[a]] : 0);
    }
    if (p->spots.n == 0) PG_FAIL (PG_E_USAGE, "the section %c = %g m meets no points", "xyz"[p->cut < 0 ? 0 : p->cut], p->at);
done:
    return status;
}

static void choose_axes (plate *p, const pg_cloud *cloud, const pg_picture_style *style)
{
    int section = style->section >= 1 && style->section <= 3 ? style->section - 1 : 2;
    p->cut = cloud->dim == 3 ? section : -1;
    p->axis[0] = p->cut == 0 ? 1 : 0;
    p->axis[1] = p->cut == 0 || p->cut == 1 ? 2 : 1;
    if (p->cut >= 0) p->at = style->section ? style->at : 0.5 * (cloud->low[2] + cloud->high[2]);
}

static void choose_frame (plate *p, const pg_cloud *cloud)
{
    static const double unit[] = { 1e3, 1, 1e-3, 1e-6 };
    double size = 0;
    for (int a = 0; a < 2; a++) {
        double *low = &p->low[a], *high = &p->high[a];
        int found = 0;
        for (size_t k = 0; k < p->spots.n; k++) {
            double x = p->spots.place[2 * k + (size_t) a];
            if (!isfinite (x)) continue;
            *low = found ? fmin (*low, x) : x, *high = found ? fmax (*high, x) : x;
            found = 1;
        }
        p->step[a] = cloud->step[p->axis[a]] > 0 ? cloud->step[p->axis[a]] : cloud->h;
        if (!(p->step[a] > 0)) p->step[a] = *high > *low ? (*high - *low) / sqrt ((double) p->spots.n) : 1;
        *low -= 0.5 * p->step[a], *high += 0.5 * p->step[a];
        size = fmax (size, *high - *low);
    }
    for (int a = 0; a < 2; a++) p->low[a] -= 0.025 * size, p->high[a] += 0.025 * size;
    p->unit = 1e-9;
    for (int k = 3; k >= 0; k--) if (size >= 0.999 * unit[k]) p->unit = unit[k];
}

static void choose_colours (plate *p, const pg_picture_style *style, double *low, double *high)
{
    p->colour = style->diverging ? pg_colour_diverging : pg_colour_sequential;
    *low = style->low, *high = style->high;
    if (*low < *high) return;
    pg_range_of (p->spots.n, p->spots.value, 0, low, high);
    if (!style->diverging) return;
    double top = fmax (fabs (*low), fabs (*high));
    if (!(top > 0)) top = 1;
    *low = -top, *high = top;
}

static void lay_out (plate *p, cairo_t *cr, const pg_picture_style *style, double low, double high)
{
    const char *unit = p->unit > 1 ? "km" : p->unit == 1 ? "m" : p->unit == 1e-3 ? "mm" : p->unit == 1e-6 ? "\xc2\xb5m" : "nm";
    char text[2][16];
    double w = p->high[0] - p->low[0], h = p->high[1] - p->low[1];
    p->flat = w > 2.2 * h;
    double scale = fmin ((p->flat ? WIDE : BROAD) / w, TALL / h);
    p->width = ceil (fmax (w * scale, 0.15 * BROAD)), p->height = ceil (fmax (h * scale, 60));
    for (int a = 0; a < 2; a++) {                      /* a frame wider than the body keeps the scale */
        double extra = 0.5 * ((a ? p->height : p->width) / scale - (a ? h : w));
        p->low[a] -= extra, p->high[a] += extra;
        snprintf (text[a], sizeof text[a], "%c (%s)", "xyz"[p->axis[a]], unit);
    }
    pg_axis_wish wx = { text[0], PG_BOTTOM, 0, 0, 1 }, wy = { text[1], PG_LEFT, 0, 0, 1 };
    pg_axis_wish wb = { style->label ? style->label : "", p->flat ? PG_BOTTOM : PG_RIGHT, 0, 0, 0 };
    pg_axis_fit (&p->x, cr, p->low[0] / p->unit, p->high[0] / p->unit, p->width, &wx);
    pg_axis_fit (&p->y, cr, p->low[1] / p->unit, p->high[1] / p->unit, p->height, &wy);
    pg_axis_fit (&p->bar, cr, low, high, p->flat ? p->width : p->height, &wb);
    p->left = ceil (pg_axis_room (&p->y, cr)) + 6;
    p->top = style->title && style->title[0] ? 74 : 24;
    double below = pg_axis_room (&p->x, cr), bar = pg_axis_room (&p->bar, cr);
    p->total[0] = p->left + p->width + (p->flat ? 46 : BAR_GAP + BAR + bar + 4);
    p->total[1] = ceil (p->top + p->height + below + (p->flat ? 14 + BAR + bar : 0) + 6);
    if (p->total[0] < LEAST) p->left += floor (0.5 * (LEAST - p->total[0])), p->total[0] = LEAST;
    p->total[0] = ceil (p->total[0]);
}

/* The frame as an image: colours by a table of 1024, NaN grey, empty pixels clear. */
static pg_status paint_points (plate *p, cairo_t *cr, int fine)
{
    pg_status status = PG_OK;
    int width = (int) p->width * fine, height = (int) p->height * fine, *owner = NULL;
    uint32_t table[1024];
    double rgb[3], scale = width / (p->high[0] - p->low[0]);
    cairo_surface_t *image = NULL;
    for (int k = 0; k < 1024; k++) {
        p->colour (k / 1023.0, rgb);
        table[k] = 0xff000000u;
        for (int c = 0; c < 3; c++) table[k] |= (uint32_t) lround (255 * rgb[c]) << (16 - 8 * c);
    }
    for (size_t k = 0; k < p->spots.n; k++) {
        double *x = p->spots.place + 2 * k;
        x[0] = (x[0] - p->low[0]) * scale, x[1] = (p->high[1] - x[1]) * scale;
    }
    for (int a = 0; a < 2; a++) p->spots.size[a] = p->step[a] * scale;
    PG_ALLOC (owner, (size_t) width * (size_t) height);
    PG_TRY (pg_raster (&p->spots, width, height, owner));
    image = cairo_image_surface_create (CAIRO_FORMAT_ARGB32, width, height);
    if (cairo_surface_status (image) != CAIRO_STATUS_SUCCESS) PG_FAIL (PG_E_MEMORY, "no memory for %d x %d pixels", width, height);
    unsigned char *bytes = cairo_image_surface_get_data (image);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            int k = owner[(size_t) j * (size_t) width + (size_t) i];
            double t = k < 0 ? 0 : pg_axis_at (&p->bar, p->spots.value[k]);
            uint32_t pixel = k < 0 ? 0 : !isfinite (t) ? 0xff9e9e9eu : table[(int) lround (1023 * fmin (fmax (t, 0), 1))];
            memcpy (bytes + (size_t) j * (size_t) cairo_image_surface_get_stride (image) + 4 * (size_t) i, &pixel, 4);
        }
    cairo_surface_mark_dirty (image);
    cairo_save (cr);
    cairo_translate (cr, p->left, p->top);
    cairo_scale (cr, 1.0 / fine, 1.0 / fine);
    cairo_set_source_surface (cr, image, 0, 0);
    cairo_pattern_set_filter (cairo_get_source (cr), CAIRO_FILTER_NEAREST);
    cairo_paint (cr);
    cairo_restore (cr);
done:
    if (image) cairo_surface_destroy (image);
    pg_free (owner);
    return status;
}

static void to_frame (const plate *p, double x, double y, double *px, double *py)
{
    *px = p->left + (x - p->low[0]) / (p->high[0] - p->low[0]) * p->width;
    *py = p->top + (p->high[1] - y) / (p->high[1] - p->low[1]) * p->height;
}

/* Adds the line that one crack shows in the picture to the path: 2D as it is, 3D where its polygon meets the section. */
static void crack_path (const plate *p, cairo_t *cr, const pg_crack *crack)
{
    double px, py;
    int pen = 0;
    if (p->cut < 0) {
        for (size_t k = 0; k < crack->nvertex; k++) {
            to_frame (p, crack->vertex[2 * k], crack->vertex[2 * k + 1], &px, &py);
            if (k) cairo_line_to (cr, px, py);
            else cairo_move_to (cr, px, py);
        }
        return;
    }
    for (size_t k = 0; k < crack->nvertex; k++) {
        const double *a = crack->vertex + 3 * k, *b = crack->vertex + 3 * ((k + 1) % crack->nvertex);
        double s = a[p->cut] - p->at, e = b[p->cut] - p->at;
        if ((s < 0) == (e < 0)) continue;
        double t = s / (s - e), u = a[p->axis[0]] + t * (b[p->axis[0]] - a[p->axis[0]]), v = a[p->axis[1]] + t * (b[p->axis[1]] - a[p->axis[1]]);
        to_frame (p, u, v, &px, &py);
        if (pen++ % 2) cairo_line_to (cr, px, py);
        else cairo_move_to (cr, px, py);
    }
}

/* Black on a thin white rim, so that cracks show on dark colours. */
static void draw_cracks (const plate *p, cairo_t *cr, const pg_cracks *cracks)
{
    cairo_save (cr);
    cairo_rectangle (cr, p->left, p->top, p->width, p->height);
    cairo_clip (cr);
    cairo_set_line_cap (cr, CAIRO_LINE_CAP_ROUND);
    for (int pass = 0; pass < 2; pass++) {
        for (size_t k = 0; k < cracks->n; k++) crack_path (p, cr, &cracks->crack[k]);
        cairo_set_source_rgb (cr, !pass, !pass, !pass);
        cairo_set_line_width (cr, pass ? 2.5 : 5);
        cairo_stroke (cr);
    }
    cairo_restore (cr);
}

static void draw_frame (cairo_t *cr, double x, double y, double w, double h)
{
    cairo_set_source_rgb (cr, 0, 0, 0);
    cairo_set_line_width (cr, 2);
    cairo_rectangle (cr, floor (x) + 0.5, floor (y) + 0.5, floor (w), floor (h));
    cairo_stroke (cr);
}

static void draw_bar (const plate *p, cairo_t *cr)
{
    double x = p->flat ? p->left : p->left + p->width + BAR_GAP, w = p->flat ? p->width : BAR, rgb[3];
    double y = p->flat ? p->top + p->height + ceil (pg_axis_room (&p->x, cr)) + 14 : p->top, h = p->flat ? BAR : p->height;
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
    pg_axis_draw (&p->bar, cr, x, y, w, h);
}

static pg_status draw_plate (plate *p, const char *path, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    pg_canvas canvas = { 0 };
    double low, high;
    choose_colours (p, style, &low, &high);
    cairo_surface_t *scratch = cairo_image_surface_create (CAIRO_FORMAT_A8, 1, 1);     /* to measure texts on */
    cairo_t *measure = cairo_create (scratch);
    lay_out (p, measure, style, low, high);
    cairo_destroy (measure);
    cairo_surface_destroy (scratch);
    PG_TRY (pg_canvas_open (&canvas, path, p->total[0], p->total[1]));
    PG_TRY (paint_points (p, canvas.cr, canvas.svg ? 2 : 1));
    if (style->cracks) draw_cracks (p, canvas.cr, style->cracks);
    draw_frame (canvas.cr, p->left, p->top, p->width, p->height);
    pg_axis_draw (&p->x, canvas.cr, p->left, p->top, p->width, p->height);
    pg_axis_draw (&p->y, canvas.cr, p->left, p->top, p->width, p->height);
    draw_bar (p, canvas.cr);
    if (style->title) pg_title (canvas.cr, style->title, p->left + 0.5 * p->width, p->top - 36, p->total[0]);
done:
    return pg_canvas_close (&canvas, status);
}

static int by_place (const void *a, const void *b)
{
    double p = *(const double *) a, q = *(const double *) b;
    return (p > q) - (p < q);
}

static pg_status draw_bar_1d (const char *path, const pg_cloud *cloud, const double *value, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    double *pair = NULL, *x = NULL, *y = NULL;
    size_t n = cloud->n;
    PG_ALLOC (pair, 2 * n);
    PG_ALLOC (x, n);
    PG_ALLOC (y, n);
    for (size_t i = 0; i < n; i++) pair[2*i] = cloud->x[i] + (style->u ? style->magnify * style->u[i] : 0), pair[2*i + 1] = value[i];
    qsort (pair, n, 2 * sizeof (double), by_place);
    for (size_t i = 0; i < n; i++) x[i] = pair[2*i], y[i] = pair[2*i + 1];
    pg_curve curve = { .n = n, .x = x, .y = y, .points = n <= 60 };
    PG_TRY (pg_picture_chart (path, 1, &curve, &(pg_chart_style) { .title = style->title, .xlabel = "x (m)", .ylabel = style->label }));
done:
    pg_free (y);
    pg_free (x);
    pg_free (pair);
    return status;
}

pg_status pg_picture_field (const char *path, const pg_cloud *cloud, const double *value, const pg_picture_style *style)
{
    pg_status status = PG_OK;
    plate *p = NULL;
    if (cloud->n == 0) PG_FAIL (PG_E_USAGE, "%s: no points to draw", path);
    if (cloud->dim == 1) return draw_bar_1d (path, cloud, value, style);
    PG_ALLOC (p, 1);
    choose_axes (p, cloud, style);
    PG_TRY (choose_points (p, cloud, value, style));
    choose_frame (p, cloud);
    p->spots.reach = style->u && style->magnify != 0 ? 1.3 : 1.9;   /* opened cracks stay open */
    PG_TRY (draw_plate (p, path, style));
done:
    if (p) pg_free (p->spots.place), pg_free (p->spots.value);
    pg_free (p);
    return status;
}
