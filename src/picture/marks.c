/* SPDX-License-Identifier: GPL-3.0-or-later
 * Marked places of charts: rings around places of curves, with texts that stay inside the
 * frame and off the curves as far as possible. Also the pen of the pale curves behind the
 * others. */
#include "chart.h"
#include <math.h>

/* Radius of a ring, and distance of the text from its middle, pixels. */
enum { RING = 11, AWAY = 18 };

/* The box of a text of size w x h at one of eight places around a ring: right, left, above,
 * below, then the four corners. It is moved into the frame. */
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

/* For each text the place of the eight with the least in it; covering the ring itself counts
 * as worst. Earlier texts are obstacles to later ones. */
void pg_chart_marks_place (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style)
{
    for (size_t k = 0; k < style->nmark && k < CHART_NOTES; k++) {
        const pg_chart_mark *m = &style->marks[k];
        double px, py, box[4], best[4] = { 0 };
        size_t least = (size_t) -1;
        if (!m->text || !pg_chart_visible (c, m->x, m->y)) continue;
        pg_chart_place (c, m->x, m->y, &px, &py);
        double w = ceil (pg_text (cr, m->text, PG_FONT, 0, 0, 0, 0, 0)) + 8, h = 1.3 * PG_FONT;
        for (int spot = 0; spot < 8; spot++) {
            spot_of (c, px, py, w, h, spot, box);
            int over = box[0] < px + RING && box[0] + w > px - RING && box[1] < py + RING
                       && box[1] + h > py - RING;
            size_t n = pg_chart_crowd (c, ncurve, curves, style, box) + (over ? 1000000 : 0);
            if (n >= least) continue;
            least = n;
            for (int i = 0; i < 4; i++) best[i] = box[i];
        }
        for (int i = 0; i < 4; i++) c->note[k][i] = best[i];
    }
}

void pg_chart_marks_draw (const chart *c, cairo_t *cr, const pg_chart_style *style)
{
    double px, py, rgb[3];
    cairo_set_dash (cr, NULL, 0, 0);
    for (size_t k = 0; k < style->nmark; k++) {
        const pg_chart_mark *m = &style->marks[k];
        if (!pg_chart_visible (c, m->x, m->y)) continue;
        pg_chart_place (c, m->x, m->y, &px, &py);
        pg_colour_curve (m->curve, rgb);
        cairo_new_sub_path (cr);
        cairo_arc (cr, px, py, RING, 0, 6.283185307179586);
        cairo_set_source_rgb (cr, 1, 1, 1);
        cairo_set_line_width (cr, 5);
        cairo_stroke_preserve (cr);
        cairo_set_source_rgb (cr, rgb[0], rgb[1], rgb[2]);
        cairo_set_line_width (cr, 3);
        cairo_stroke (cr);
        if (!m->text || k >= CHART_NOTES) continue;
        const double *box = c->note[k];
        cairo_rectangle (cr, box[0], box[1], box[2], box[3]);
        cairo_set_source_rgba (cr, 1, 1, 1, 0.8);
        cairo_fill (cr);
        cairo_set_source_rgb (cr, 0, 0, 0);
        pg_text (cr, m->text, PG_FONT, box[0] + 4, box[1] + 0.5 * box[3], 0, 0, 1);
    }
}
