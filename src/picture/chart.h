/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the files that draw a chart share: its layout in pixels, the transformation from values
 * to pixels, and how curve k looks. The order of work is fixed: axes first (chart.c), then the
 * texts of marks (marks.c), then the legend (legend.c), because each of these avoids what the
 * earlier ones occupy. */
#ifndef PG_PICTURE_CHART_H
#define PG_PICTURE_CHART_H
#include "picture_private.h"

/* Space between parts, length of the sample line in the legend (both pixels), largest number
 * of texts. */
enum { CHART_GAP = 16, CHART_SAMPLE = 60, CHART_NOTES = 8 };
/* The layout of a chart in pixels from the upper left corner of the picture. */
typedef struct {
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
/* 1 if the place can be drawn: both values are finite, and positive where the axis is
 * logarithmic. */
int  pg_chart_visible (const chart *c, double x, double y);
/* The pixel of a value pair, which must be visible in the sense above. */
void pg_chart_place   (const chart *c, double x, double y, double *px, double *py);
/* Sets colour, width and dashes for curve k: eight colours, then the same colours with other
 * dashes. */
void pg_chart_pen     (cairo_t *cr, size_t k);
/* Draws the marker of curve k around a pixel, filled for the first eight curves, hollow for
 * later ones. */
void pg_chart_marker  (cairo_t *cr, size_t k, double x, double y);

/* ---- legend.c ---------------------------------------------------------------------------------- */
/* Rows of the legend: one per curve, and one more if there are pale curves. */
size_t pg_chart_legend_rows (size_t ncurve, const pg_chart_style *style);
/* Measures the legend: fills its width and height. */
void pg_chart_legend_size (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
/* Chooses the place of the legend: a corner or the middle of an edge where it hides nothing
 * and returns 0, or else beside the frame and returns 1. */
int  pg_chart_legend_place (chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style);
void pg_chart_legend_draw (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
/* How much of the chart lies in a box (left, top, width, height): slope triangles, texts of
 * marks, points, and places between neighbours on lines, each counted once. Places for texts
 * are chosen by it. */
size_t pg_chart_crowd (const chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style,
                    const double *box);
/* Draws the triangle of a slope in the colour of its curve k; nothing where it does not fit
 * the curve. */
void pg_chart_slope_draw (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k,
                       const pg_chart_slope *slope);

/* ---- marks.c ----------------------------------------------------------------------------------- */
/* Chooses the places of the texts of the marks: beside their rings and inside the frame, where
 * they hide least. Fills note. */
void pg_chart_marks_place (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
/* Draws rings and texts at the places chosen before. */
void pg_chart_marks_draw   (const chart *c, cairo_t *cr, const pg_chart_style *style);
/* As pg_chart_pen, but thin, pale and without dashes. */
void pg_chart_pale_pen     (cairo_t *cr, size_t k);
#endif
