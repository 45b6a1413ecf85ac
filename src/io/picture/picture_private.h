/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what the files of this folder share: a canvas (PNG or SVG), text with superscripts and
 * subscripts, axes with ticks, colour maps, the assignment of pixels to points, the viewing
 * direction, and the sheet with frames, axes and colour bar. Lengths on the picture are pixels
 * of the PNG (points of the SVG), counted to the right and downwards; lengths in the body are
 * m. "Frame" is the rectangle that a body or the curves are drawn in, "panel" one frame of
 * several. */
#ifndef PG_PICTURE_PRIVATE_H
#define PG_PICTURE_PRIVATE_H
#include "perigal/picture.h"
#include "cairo_calls.h"
#include <stdint.h>
#include <stdio.h>

/* Height of text, of titles, and length of a tick, in pixels. */
enum { PG_FONT = 26, PG_FONT_TITLE = 30, PG_TICK = 9 };

/* ---- canvas.c ------------------------------------------------------------------------------------------ */
/* A picture file that is being drawn. */
typedef struct {
    cairo_surface_t *surface;
    /* The context that everything is drawn with; NULL until the canvas is open. */
    cairo_t *cr;
    /* The open file; cairo writes into it through a callback, so that a full disk is noticed. */
    FILE    *file;
    const char *path;
    /* svg: 1 for SVG; reason: errno of the first write that failed, 0 if none did. */
    int      svg, reason;
} pg_canvas;
/* 1 if the path ends in `ending`, without regard to case. */
int pg_ends_with (const char *path, const char *ending);
/* Creates the file and a white canvas of that size in pixels. PG_E_USAGE: the name ends
 * neither in .png nor in .svg. */
pg_status pg_canvas_open  (pg_canvas *c, const char *path, double width, double height);
/* Writes the file if the given status is PG_OK; otherwise, or if writing fails, the file is
 * removed. Returns the given status, or the failure of writing. May be called for a canvas
 * that never opened. */
pg_status pg_canvas_close (pg_canvas *c, pg_status status);
/* Draws text, or with draw = 0 only measures it, and returns its width. ^{...} and _{...} are
 * raised and lowered. align 0 starts the text at x, 0.5 centres it there, 1 ends it there; y
 * is the middle of the capital letters. turned = 1 writes upwards. */
double pg_text (cairo_t *cr, const char *text, double size, double x, double y, double align, int turned,
                int draw);
/* Draws the path as a line of that width in pixels and colour. */
void pg_stroke (cairo_t *cr, double width, double red, double green, double blue);
/* Draws a title centred at x, moved and then made smaller where the picture (from 0 to width)
 * leaves no space. */
void pg_title (cairo_t *cr, const char *title, double x, double y, double width);

/* ---- axes.c -------------------------------------------------------------------------------------------- */
/* Largest number of ticks with text, and of the small ticks between them on logarithmic axes. */
enum { PG_TICKS = 24, PG_MINOR = 128 };
typedef enum { PG_BOTTOM, PG_LEFT, PG_RIGHT } pg_side;
/* An axis fitted to a range. */
typedef struct {
    /* Values at its two ends. */
    double  low, high;
    /* reverse (set after the fit): values fall to the right, or upwards. n and nminor count
     * the ticks. */
    int     log, reverse, n, nminor;
    pg_side side;
    /* Values of the ticks. */
    double  tick[PG_TICKS], minor[PG_MINOR];
    /* Text of each tick, and the label with its unit and possibly a power of ten. */
    char    text[PG_TICKS][40], label[200];
} pg_axis;
/* What an axis should be like: log: logarithmic; grow: its ends move outwards to ticks; plain:
 * the texts are the values themselves, without a power of ten or an SI prefix in the label. */
typedef struct { const char *label; pg_side side; int log, grow, plain; } pg_axis_request;
/* Chooses ticks for [low, high] on `length` pixels, as many as leave space for their texts. */
void pg_axis_fit (pg_axis *a, cairo_t *cr, double low, double high, double length,
                  const pg_axis_request *request);
/* Position of a value along the axis: 0 at its first end, 1 at its last one, beyond these
 * outside. */
double pg_axis_at   (const pg_axis *a, double value);
/* Pixels that ticks, texts and label take beside the frame. */
double pg_axis_margin (const pg_axis *a, cairo_t *cr);
/* Draws ticks, texts and label beside the frame with the upper left corner (x, y), width w and
 * height h. */
void   pg_axis_draw (const pg_axis *a, cairo_t *cr, double x, double y, double w, double h);
/* Smallest and largest of n values; not finite ones do not count, nor with log = 1 those not
 * above zero. Returns 0 if none counts: then the range is 0 to 1 (log: 1 to 10). */
int    pg_range_of  (size_t n, const double *value, int log, double *low, double *high);
/* Widens a range that is empty or as small as rounding (below 1e-10 of its values), to 10 % on
 * either side. */
void   pg_range_widen (double *low, double *high);
/* For colours by decades: keeps the upper end of positive values and at most six decades below
 * it. */
void   pg_range_decades (double *low, double *high);

/* ---- colour.c ------------------------------------------------------------------------------------------ */
/* A colour map takes t in [0, 1], limited to that, to red, green and blue in [0, 1]. */
typedef void (*pg_colour_map) (double t, double rgb[3]);
void pg_colour_sequential (double t, double rgb[3]);
void pg_colour_diverging  (double t, double rgb[3]);
enum { PG_CURVE_COLOURS = 8 };
/* The colour of curve k of a chart; eight colours, then again from the first. */
void pg_colour_curve (size_t k, double rgb[3]);

/* ---- grid.c: the points as cells of a lattice -------------------------------------------------- */
/* A 3D cloud as cells of the lattice that it came from. */
typedef struct {
    /* Cells along each axis; loose = 1: the points lie on no lattice (two share a cell), and
     * `at` is NULL. */
    int     count[3], loose;
    /* Position of the first point and edge lengths of a cell, m. */
    double  origin[3], step[3];
    /* The box of all cells, m. Where the outer points carry half a cell the box ends at the
     * points. */
    double  low[3], high[3];
    /* Index of the point in a cell, x fastest, -1 where there is none (count[0] x count[1] x
     * count[2]). */
    int    *at;
} pg_grid;
/* Finds the lattice of a 3D cloud; points on no lattice are no failure but give loose = 1. */
pg_status pg_grid_build (pg_grid *g, const pg_cloud *cloud);
void      pg_grid_clear (pg_grid *g);
/* The spacing around each point of a 2D cloud that lies on no lattice, m (n, freed by the
 * caller with pg_free); *spacing is NULL for a lattice, even one whose points have moved a
 * little. */
pg_status pg_loose_spacing (const pg_cloud *cloud, double **spacing);
/* Index along an axis of the cell that holds x: -1 below the lattice, count above it. */
int       pg_grid_place (const pg_grid *g, int axis, double x);
/* The point in a cell, or -1 where there is none or outside the lattice. */
int       pg_grid_point (const pg_grid *g, const int *cell);

/* ---- view.c: where the eye is ------------------------------------------------------------------ */
/* What is looked at: a 2D body; one layer of points normal to an axis; an oblique section; a
 * solid from outside. */
typedef enum { PG_FLAT, PG_LAYER, PG_SLICE, PG_SOLID } pg_eye_kind;
/* Parallel projection: a point x of space is drawn at (right . x, up . x), at the depth toward . x (m). */
typedef struct {
    pg_eye_kind kind;
    /* Unit vectors that make a right-handed system; toward points from the body to the eye. */
    double right[3], up[3], toward[3];
    /* Which coordinate runs across and up, with its sign; -1 where none does (oblique views). */
    int    axis[2], sign[2];
    /* cut: axis normal to a layer, else -1. framed: 1 if the picture has a frame with axes. */
    int    cut, framed;
    /* Sections: the plane toward . x = at, m. */
    double at;
} pg_eye;
/* Chooses the projection for a cloud of which only `dim`, `low` and `high` are used.
 * PG_E_USAGE: an oblique section without a direction. */
pg_status pg_eye_open (pg_eye *eye, const pg_cloud *cloud, const pg_picture_style *style);
/* The product direction . x of the first dim components. */
double    pg_along (const double *direction, const double *x, int dim);

/* ---- a frame of the picture's plane on pixels ---------------------------------------------------------- */
/* A rectangle of the picture's plane as pixels, with the point or the value that each pixel shows. */
typedef struct {
    int     width, height;
    /* Coordinates of the upper left corner in the picture's plane, m; pixels per m. */
    double  left, top, scale;
    /* Index of the point that a pixel shows, or PG_EMPTY, PG_GHOST or PG_EDGE (width x height). */
    int    *owner;
    /* Brightness, 1 being full, and depth towards the eye, m (width x height). */
    float  *shade, *depth;
    /* Values of the pixels where triangles carry values, or NULL (width x height). */
    double *value;
} pg_screen;
/* Values of pg_screen.owner for pixels that show no point: nothing at all; the body behind the
 * selected points; the outline of that body. */
enum { PG_EMPTY = -1, PG_GHOST = -2, PG_EDGE = -3 };
/* Allocates an empty frame of that size in pixels; left, top and scale are the caller's. */
pg_status pg_screen_open (pg_screen *s, int width, int height);
void      pg_screen_close (pg_screen *s);
/* Projects a point x of space (3, m) to `at`: pixels across and down (not rounded), and depth (m). */
void      pg_screen_place (const pg_screen *s, const pg_eye *eye, const double *x, double at[3]);
/* 1 if a point projected to `at` (pg_screen_place) is not hidden by what the screen shows there, to within
 * slack (m). */
int       pg_in_sight (const pg_screen *s, const double *at, double slack);
/* Draws a triangle with a depth buffer: each corner v has pixels across, pixels down and the
 * depth. Fills the pixels whose centre lies inside or on an edge unless something nearer to
 * the eye is there. value: at the corners, interpolated linearly, or NULL. */
void      pg_triangle (pg_screen *s, const double v[3][3], int owner, float shade, const double *value);
/* Brightness (0 to 1) of a face with that outward unit normal. */
float     pg_light_on (const pg_eye *eye, const double *normal);
/* 1 if the body ends at this pixel or steps back by more than `jump` (m) beside it. */
int       pg_on_outline (const pg_screen *s, int i, int j, double jump);

/* ---- solid.c: cubes around points, hidden faces hidden ----------------------------------------- */
/* A solid of cubes around points. */
typedef struct {
    const pg_cloud *cloud;
    const pg_grid *grid;
    const pg_eye *eye;
    /* Displacement (n x 3, m), or NULL: undeformed. */
    const double *u;
    double magnify;
    /* 1 for the points that are drawn (n); NULL: all of them. */
    const unsigned char *keep;
    /* Damage (n): neighbours of which one is nearly intact (below 0.1) stay together; NULL: unknown. */
    const double *damage;
} pg_solid;
void      pg_solid_draw (const pg_solid *solid, pg_screen *screen);
/* Draws the whole body behind the selected points as PG_GHOST with an outline PG_EDGE. */
pg_status pg_ghost_draw (const pg_solid *solid, pg_screen *screen);
/* 1 if there are 3D cracks that have grown, which consist of triangles. */
int       pg_cracks_grown (const pg_cracks *cracks);
/* Range of the coordinate `axis` of grown 3D cracks inside the box of the body, divided by `unit` (m). */
void      pg_cracks_depth (const pg_cracks *cracks, const pg_grid *grid, int axis, double unit, double *low,
                           double *high);
/* Draws the surfaces of grown 3D cracks inside the box of the body, coloured by the values of the points
 * nearest to them or (value NULL) by the coordinate `axis` divided by `unit` (m). The values are stored per
 * pixel (screen->value). */
pg_status pg_cracks_draw  (const pg_solid *solid, pg_screen *screen, const pg_cracks *cracks,
                           const double *value, int axis, double unit);
/* Fills the screen with the points whose cells the plane of an oblique section meets. */
void      pg_slice_draw (const pg_grid *grid, const pg_eye *eye, pg_screen *screen);

/* ---- sheet.c: frames, axes, colour bar --------------------------------------------------------- */
/* The layout of a picture: frames of equal scale in rows and columns, axes, colour bar, title. */
typedef struct {
    pg_eye  eye;
    /* What a frame shows of the picture's plane, m. */
    double  low[2], high[2];
    /* Length unit of the axes, m. */
    double  unit;
    /* flat: the colour bar lies below a wide frame; titles: the panels have titles. */
    int     flat, columns, rows, titles;
    size_t  panels;
    /* Corner and size of the first frame, distance from frame to frame, size of the picture:
     * pixels. */
    double  left, top, width, height, pitch[2], total[2];
    /* The colour bar: left, top, width, height, pixels. */
    double  bar_at[4];
    pg_axis x, y, bar;
    /* 1 if there are values below, above the ends of the colour bar: it ends in an arrow
     * there. */
    int     beyond[2];
    pg_colour_map colour;
    /* A line of text below the picture; "": none. */
    char    note[200];
    /* 1: coordinates have no unit. */
    int     bare;
    /* Number of names that replace the colour bar (sets and blocks of a mesh); the value k
     * belongs to name k. */
    size_t  nlegend;
    const char *const *legend;
} pg_sheet;
/* With a legend the colour of name k is that at k / PG_CATEGORIES of the colour map: the same
 * 1/1023 that the colours of pixels are rounded to, so that categories never mix. */
enum { PG_CATEGORIES = 1023 };

/* The name of the length unit, "" if there is none. */
const char *pg_sheet_unit (const pg_sheet *p);
/* Adds a margin to low and high, which are those of the body, and chooses the unit. */
void pg_sheet_frame (pg_sheet *p);
/* Chooses the colour map and its ends over `panels` states of n values (NAN: not shown); called before
 * pg_sheet_fit. If values lie outside the ends, the note says what share is inside and how far all reach. */
pg_status pg_sheet_colours (pg_sheet *p, const pg_picture_style *style, size_t panels, size_t n,
                            const double *value, double *low, double *high);
/* Finds whether some of n values lie beyond the ends of the colour bar, which then ends in arrows; called
 * after pg_sheet_fit. */
void pg_sheet_arrows (pg_sheet *p, size_t n, const double *value);
/* Fixes the layout; low and high are the ends of the colour bar. */
void pg_sheet_fit  (pg_sheet *p, const pg_picture_style *style, double low, double high);
/* Converts the point (a, b) of the picture's plane (m) to pixels in a panel. */
void pg_sheet_to   (const pg_sheet *p, size_t panel, double a, double b, double *px, double *py);
/* Draws what belongs to the picture as a whole: colour bar or legend, note, title, and below a
 * solid the directions of the axes and its size. */
void pg_sheet_draw (const pg_sheet *p, cairo_t *cr, const pg_cloud *cloud, const pg_grid *grid,
                    const pg_picture_style *style);
/* Draws the frame and the title of a panel; axes stand along the left and the lower edge of
 * the sheet only. */
void pg_panel_draw (const pg_sheet *p, cairo_t *cr, size_t panel, const char *title);
/* Puts the pixels of a screen into a panel, coloured by value[owner]; `fine` pixels of the
 * screen make one of the picture. */
pg_status pg_panel_paint (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_screen *screen,
                          const double *value, int fine);

/* ---- wire.c: lines in the body's space --------------------------------------------------------- */
/* Draws the edges of the body's box: hidden = 1 those that meet the corner farthest from the
 * eye, 0 the others. */
void pg_wire_box    (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *grid, int hidden);
/* Draws the pre-cracks of an undeformed body; with a screen only what is not hidden behind it. */
void pg_wire_cracks (const pg_sheet *p, cairo_t *cr, size_t panel, const pg_grid *grid,
                     const pg_cracks *cracks, const pg_screen *screen /* NULL: see-through */);
/* Draws displaced faces of cracks: n lines of m points each (n x m x 2, m); NAN interrupts a
 * line. */
void pg_wire_faces  (const pg_sheet *p, cairo_t *cr, size_t panel, size_t n, size_t m, const double *place);
/* Draws arrows along x, y and z with their names around the pixel (x, y). */
void pg_wire_triad  (const pg_sheet *p, cairo_t *cr, double x, double y, double length);

/* Draws a 1D body as a chart: the value over the (displaced) coordinate, a curve per panel (bars.c). */
pg_status pg_draw_bars (const char *path, const pg_cloud *cloud, size_t npanel, const pg_panel *panel,
                        const pg_picture_style *style);
#endif
