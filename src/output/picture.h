/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pictures share: a canvas (PNG or SVG), text with super- and subscripts, axes with ticks, colour maps, the rasteriser.
 * Lengths are pixels of the PNG (points of the SVG), y downwards. */
#ifndef PERIGAL_OUTPUT_PICTURE_H
#define PERIGAL_OUTPUT_PICTURE_H
#include "perigal/output.h"
#include <cairo.h>
#include <stdint.h>
#include <stdio.h>

enum { PG_FONT = 26, PG_FONT_TITLE = 30, PG_TICK = 9 };

/* ---- canvas.c -------------------------------------------------------------------------------------------------------- */
typedef struct {
    cairo_surface_t *surface;
    cairo_t *cr;                                       /* NULL until open                                                */
    FILE    *file;
    const char *path;
    int      svg, reason;                              /* reason: errno of the first failed write                        */
} pg_canvas;
pg_status pg_canvas_open  (pg_canvas *c, const char *path, double width, double height);      /* white                    */
pg_status pg_canvas_close (pg_canvas *c, pg_status status);    /* writes if status is PG_OK; a failure leaves no file     */
/* Draws (or measures: draw = 0) text whose ^{...} and _{...} are raised and lowered; returns its width. align: 0 starts at x,
 * 0.5 centred, 1 ends there; y is the middle of the capitals; turned: reads upwards. */
double pg_text (cairo_t *cr, const char *text, double size, double x, double y, double align, int turned, int draw);
/* A title around x, smaller where the picture (0 to width) leaves no room. */
void pg_title (cairo_t *cr, const char *title, double x, double y, double width);

/* ---- axes.c ---------------------------------------------------------------------------------------------------------- */
enum { PG_TICKS = 24, PG_MINOR = 128 };
typedef enum { PG_BOTTOM, PG_LEFT, PG_RIGHT } pg_side;
typedef struct {
    double  low, high;
    int     log, n, nminor;
    pg_side side;
    double  tick[PG_TICKS], minor[PG_MINOR];
    char    text[PG_TICKS][40], label[200];
} pg_axis;
typedef struct { const char *label; pg_side side; int log, grow, plain; } pg_axis_wish;   /* grow: ends on ticks; plain: no scale factor */
/* Ticks for [low, high] on `length` pixels, as many as their texts leave room for. */
void   pg_axis_fit  (pg_axis *a, cairo_t *cr, double low, double high, double length, const pg_axis_wish *wish);
double pg_axis_at   (const pg_axis *a, double value);                        /* 0 at low, 1 at high                        */
double pg_axis_room (const pg_axis *a, cairo_t *cr);                         /* pixels beside the frame                    */
/* Ticks, texts and label beside the frame x, y, w, h. */
void   pg_axis_draw (const pg_axis *a, cairo_t *cr, double x, double y, double w, double h);
/* Smallest and largest finite value, widened when they are equal; positive values only for log. 0: there was none. */
int    pg_range_of  (size_t n, const double *value, int log, double *low, double *high);
void   pg_range_widen (double *low, double *high);

/* ---- colour.c -------------------------------------------------------------------------------------------------------- */
typedef void (*pg_colour_map) (double t, double rgb[3]);                     /* t in [0, 1], clamped                       */
void pg_colour_sequential (double t, double rgb[3]);
void pg_colour_diverging  (double t, double rgb[3]);
void pg_colour_curve (size_t k, double rgb[3]);

/* ---- raster.c -------------------------------------------------------------------------------------------------------- */
typedef struct {
    size_t  n;
    double *place;                                     /* pixels from the left and the top (n x 2)                       */
    double *value;                                     /* (n)                                                            */
    double  size[2], reach;                            /* cell, pixels; gaps up to (reach - 1) / 2 cells close          */
} pg_spots;
/* owner (width x height): index of the spot that covers the pixel's centre, -1 for none. */
pg_status pg_raster (const pg_spots *spots, int width, int height, int *owner);
#endif
