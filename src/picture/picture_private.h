/* SPDX-License-Identifier: GPL-3.0-or-later
 * What pictures share: a canvas (PNG or SVG), text with super- and subscripts, axes with ticks, colour maps,
 * the rasteriser. Lengths are pixels of the PNG (points of the SVG), y downwards. */
#ifndef PG_PICTURE_PRIVATE_H
#define PG_PICTURE_PRIVATE_H
#include "perigal/picture.h"
#include <cairo.h>
#include <stdint.h>
#include <stdio.h>

enum { PG_FONT = 26, PG_FONT_TITLE = 30, PG_TICK = 9 };

/* ---- canvas.c ------------------------------------------------------------------------------------------ */
typedef struct {
    cairo_surface_t *surface;
    cairo_t *cr;                                       /* NULL until open */
    FILE    *file;
    const char *path;
    int      svg, reason;                              /* reason: errno of the first failed write */
} pg_canvas;
pg_status pg_canvas_open  (pg_canvas *c, const char *path, double width, double height);      /* white */
/* writes if status is PG_OK; a failure leaves no file */
pg_status pg_canvas_close (pg_canvas *c, pg_status status);
/* Draws (or measures: draw = 0) text whose ^{...} and _{...} are raised and lowered; returns its width.
 * align: 0 starts at x, 0.5 centred, 1 ends there; y is the middle of the capitals; turned: reads upwards. */
double pg_text (cairo_t *cr, const char *text, double size, double x, double y, double align, int turned,
                int draw);
/* A title around x, smaller where the picture (0 to width) leaves no room. */
void pg_title (cairo_t *cr, const char *title, double x, double y, double width);

/* ---- axes.c -------------------------------------------------------------------------------------------- */
enum { PG_TICKS = 24, PG_MINOR = 128 };
typedef enum { PG_BOTTOM, PG_LEFT, PG_RIGHT } pg_side;
typedef struct {
    double  low, high;
    int     log, reverse, n, nminor;  /* reverse (set after the fit): falls to the right, or upwards */
    pg_side side;
    double  tick[PG_TICKS], minor[PG_MINOR];
    char    text[PG_TICKS][40], label[200];
} pg_axis;
/* grow: ends on ticks; plain: no scale factor */
typedef struct { const char *label; pg_side side; int log, grow, plain; } pg_axis_request;
/* Ticks for [low, high] on `length` pixels, as many as their texts leave room for. */
void pg_axis_fit (pg_axis *a, cairo_t *cr, double low, double high, double length,
                  const pg_axis_request *request);
double pg_axis_at   (const pg_axis *a, double value);                        /* 0 at low, 1 at high */
double pg_axis_margin (const pg_axis *a, cairo_t *cr);                         /* pixels beside the frame */
/* Ticks, texts and label beside the frame x, y, w, h. */
void   pg_axis_draw (const pg_axis *a, cairo_t *cr, double x, double y, double w, double h);
/* Smallest and largest finite value, widened when they are equal; positive values only for log. 0: there was
 * none. */
int    pg_range_of  (size_t n, const double *value, int log, double *low, double *high);
void   pg_range_widen (double *low, double *high);
void   pg_range_decades (double *low, double *high);  /* six at most, of positive values */

/* ---- colour.c ------------------------------------------------------------------------------------------ */
typedef void (*pg_colour_map) (double t, double rgb[3]);                     /* t in [0, 1], clamped */
void pg_colour_sequential (double t, double rgb[3]);
void pg_colour_diverging  (double t, double rgb[3]);
enum { PG_CURVE_COLOURS = 8 };
void pg_colour_curve (size_t k, double rgb[3]);

/* ---- raster.c ------------------------------------------------------------------------------------------ */
typedef struct {
    size_t  n;
    double *place;                                     /* pixels from the left and the top (n x 2) */
    double  size[2], reach;  /* cell, pixels; gaps up to (reach - 1) / 2 cells close */
    double *spacing;                                   /* of each spot, pixels: no lattice (n); NULL: cells */
} pg_spots;
/* owner (width x height): index of the spot that covers the pixel's centre, -1 for none. */
pg_status pg_raster (const pg_spots *spots, int width, int height, int *owner);

/* ---- grid.c: the points as cells of a lattice -------------------------------------------------- */
typedef struct {
    int     count[3], loose;  /* loose: no lattice (points share cells), at is NULL */
    double  origin[3], step[3];                        /* first point; edges of a cell, m */
    double  low[3], high[3];  /* box of the cubes, cut where the outer points are half a cell, m */
    int    *at;                                        /* point of a cell, x fastest, or -1 */
} pg_grid;
pg_status pg_grid_build (pg_grid *g, const pg_cloud *cloud);
void      pg_grid_clear (pg_grid *g);
/* 2D points that lie on no lattice (also when moved a little): spacing about each, m (n, pg_free); NULL for a
 * lattice. */
pg_status pg_loose_spacing (const pg_cloud *cloud, double **spacing);
int       pg_grid_place (const pg_grid *g, int axis, double x);  /* index along an axis, may be outside */
int       pg_grid_point (const pg_grid *g, const int *cell);  /* -1 outside and where there is none */

/* ---- view.c: where the eye is ------------------------------------------------------------------ */
/* 2D; axis section; oblique section; outside */
typedef enum { PG_FLAT, PG_LAYER, PG_SLICE, PG_SOLID } pg_eye_kind;
typedef struct {
    pg_eye_kind kind;
    double right[3], up[3], toward[3];                 /* unit vectors; toward the eye */
    int    axis[2], sign[2];                           /* coordinate across and up, -1: none */
    int    cut, framed;                                /* layer: its axis, else -1; framed: with axes */
    double at;                                         /* section: toward . x = at, m */
} pg_eye;
pg_status pg_eye_open (pg_eye *eye, const pg_cloud *cloud, const pg_picture_style *style);
double    pg_along (const double *direction, const double *x, int dim);      /* direction . x */

/* ---- a frame of the picture's plane on pixels ---------------------------------------------------------- */
typedef struct {
    int     width, height;
    double  left, top, scale;                          /* m at the upper left corner; pixels per m */
    int    *owner;                                     /* point, or one of the following (width x height) */
    float  *shade, *depth;                             /* brightness, 1 full; depth towards the eye, m */
    double *value;                                     /* of pixels, where triangles carry values, or NULL */
} pg_screen;
/* nothing; the body behind a choice of points; its outline */
enum { PG_EMPTY = -1, PG_GHOST = -2, PG_EDGE = -3 };
pg_status pg_screen_open (pg_screen *s, int width, int height);
void      pg_screen_close (pg_screen *s);
/* v: pixels across and down, depth; value: at the corners, or NULL. Fills pixels whose centre lies inside or
 * on an edge, nearest in front. */
void      pg_triangle (pg_screen *s, const double v[3][3], int owner, float shade, const double *value);
float     pg_light_on (const pg_eye *eye, const double *normal);             /* brightness of a face */
/* Does the body end at this pixel, or step back by more than `jump`? */
int       pg_on_outline (const pg_screen *s, int i, int j, double jump);

/* ---- solid.c: cubes around points, hidden faces hidden ----------------------------------------- */
typedef struct {
    const pg_cloud *cloud;
    const pg_grid *grid;
    const pg_eye *eye;
    const double *u;                                   /* NULL: undeformed */
    double magnify;
    const unsigned char *keep;                         /* points drawn, NULL: all */
    const double *damage;  /* of the points: whole ones hold together; NULL: not known */
} pg_solid;
void      pg_solid_draw (const pg_solid *solid, pg_screen *screen);
pg_status pg_ghost_draw (const pg_solid *solid, pg_screen *screen);  /* the whole body under what is drawn */
void      pg_slice_draw (const pg_grid *grid, const pg_eye *eye, pg_screen *screen);

/* ---- sheet.c: frames, axes, colour bar --------------------------------------------------------- */
typedef struct {
    pg_eye  eye;
    double  low[2], high[2];                           /* frame, m */
    double  unit;                                      /* length unit, m */
    int     flat, columns, rows, titles;               /* flat: colour bar below */
    size_t  panels;
    /* first frame, distance of frames, picture: pixels */
    double  left, top, width, height, pitch[2], total[2];
    double  bar_at[4];                                 /* left, top, width, height */
    pg_axis x, y, bar;
    int     beyond[2];  /* values below, above the colour bar: it ends in arrows */
    pg_colour_map colour;
    char    note[200];                                 /* below the picture; "": none */
    int     bare;                                      /* lengths have no unit */
    size_t  nlegend;  /* names with their colours instead of the colour bar; value k is name k */
    const char *const *legend;
} pg_sheet;
enum { PG_CATEGORIES = 1023 };

const char *pg_sheet_unit (const pg_sheet *p);
/* Before the fit: what the colours from low to high leave out of n values (NAN: not shown), if anything, as
 * the note. */
void pg_sheet_leave_out (pg_sheet *p, const char *label, size_t n, const double *value, double low,
                         double high);
/* low, high: of the colours */
void pg_sheet_fit  (pg_sheet *p, const pg_picture_style *style, double low, double high);
void pg_sheet_to   (const pg_sheet *p, size_t panel, double a, double b, double *px, double *py);
void pg_sheet_draw (const pg_sheet *p, cairo_t *cr, const pg_cloud *cloud, const pg_grid *grid,
                    const pg_picture_style *style);
void pg_panel_draw (const pg_sheet *p, cairo_t *cr, size_t panel, const char *title);
pg_status pg_panel_paint (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_screen *screen,
                          const double *value, int fine);

/* ---- wire.c: lines in the body's space --------------------------------------------------------- */
void pg_wire_box    (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *grid, int hidden);
void pg_wire_cracks (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *grid,
                     const pg_cracks *cracks, const pg_screen *screen /* NULL: see-through */);
/* Displaced faces of cracks: n lines of m places (m, NAN: none) each. */
void pg_wire_faces  (const pg_sheet *p, cairo_t *cr, size_t panel, size_t n, size_t m, const double *place);
void pg_wire_triad  (const pg_sheet *p, cairo_t *cr, double x, double y, double length);
#endif
