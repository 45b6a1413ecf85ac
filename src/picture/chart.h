/* SPDX-License-Identifier: GPL-3.0-or-later
 * What the parts of a chart share: frame, places, how a curve looks. */
#ifndef PG_PICTURE_CHART_H
#define PG_PICTURE_CHART_H
#include "picture_private.h"

enum { CHART_GAP = 16, CHART_SAMPLE = 60, CHART_NOTES = 8 };
typedef struct {
    pg_axis x, y;
    double  left, top, width, height;                  /* frame */
    double  total;                                     /* width of the picture */
    double  legend[4];                                 /* left, top, width, height; width 0: none */
    double  note[CHART_NOTES][4];                      /* of the texts of the first marks, likewise */
} chart;
int  pg_chart_visible (const chart *c, double x, double y);
void pg_chart_place   (const chart *c, double x, double y, double *px, double *py);
/* Colour, width and dashes of curve k. */
void pg_chart_pen     (cairo_t *cr, size_t k);
/* Marker of curve k around a place, filled or hollow. */
void pg_chart_marker  (cairo_t *cr, size_t k, double x, double y);

/* ---- legend.c ---------------------------------------------------------------------------------- */
/* Where the legend goes: the corner or middle of an edge where it hides nothing, else beside the frame: 1. */
size_t pg_chart_legend_rows (size_t ncurve, const pg_chart_style *style);
void pg_chart_legend_size (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
int  pg_chart_legend_place (chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style);
void pg_chart_legend_draw (const chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
/* How much lies in a box: triangles, texts of marks, points, and places between neighbours on lines. */
size_t pg_chart_crowd (const chart *c, size_t ncurve, const pg_curve *curves, const pg_chart_style *style,
                    const double *box);
/* A triangle of the slope under curve k. */
void pg_chart_slope_draw (const chart *c, cairo_t *cr, const pg_curve *curve, size_t k,
                       const pg_chart_slope *slope);

/* ---- marks.c ----------------------------------------------------------------------------------- */
/* Where the texts of the marks go: beside their rings, inside the frame, where they hide least. */
void pg_chart_marks_place (chart *c, cairo_t *cr, size_t ncurve, const pg_curve *curves,
                        const pg_chart_style *style);
void pg_chart_marks_draw   (const chart *c, cairo_t *cr, const pg_chart_style *style);
void pg_chart_pale_pen     (cairo_t *cr, size_t k);       /* as pg_chart_pen, thin and pale */
#endif
