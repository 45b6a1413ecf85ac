/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the parts of a chart share: frame, places, how a curve looks. */
#ifndef PERIGAL_OUTPUT_CHART_H
#define PERIGAL_OUTPUT_CHART_H
#include "picture.h"

enum { CHART_GAP = 16, CHART_SAMPLE = 60, CHART_NOTES = 8 };
typedef struct {
    pg_axis x, y;
    double  left, top, width, height;                  /* frame */
    double  total;                                     /* width of the picture */
    double  legend[4];                                 /* left, top, width, height; width 0: none */
    double  note[CHART_NOTES][4];                      /* of the texts of the first marks, likewise */
} chart;
int  chart_visible (const chart *c, double x, double y);
void chart_place   (const chart *c, double x, double y, double *px, double *py);
/* Colour, width and dashes of curve k. */
void chart_pen     (cairo_t *cr, size_t k);
/* Marker of curve k around a place, filled or hollow. */
void chart_marker  (cairo_t *cr, size_t k, double x, double y);

/* ---- picture_legend.c ---------------------------------------------------------------------------------- */
/* Where the legend goes: the corner or middle of an edge where it hides nothing, else beside the frame: 1. */
size_t chart_legend_rows (size_t ncurve, const pg_chart_style *style);
void chart_legend_size (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
int  chart_legend_place (chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style);
void chart_legend_draw (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
/* How much lies in a box: triangles, texts of marks, points, and places between neighbours on lines. */
size_t chart_crowd (const chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style,
                    const double *box);
/* A triangle of the slope under curve k. */
void chart_slope_draw (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k,
                       const pg_chart_slope *slope);

/* ---- picture_marks.c ----------------------------------------------------------------------------------- */
/* Where the texts of the marks go: beside their rings, inside the frame, where they hide least. */
void chart_marks_place (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
void chart_marks_draw   (const chart *c, cairo_t *cr, const pg_chart_style *style);
void chart_pale_pen     (cairo_t *cr, size_t k);       /* as chart_pen, thin and pale */
#endif
