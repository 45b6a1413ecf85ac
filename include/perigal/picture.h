/* SPDX-License-Identifier: GPL-3.0-or-later
 * picture.h: pictures from plain arrays, as PNG or SVG by the ending of the file's name: fields on points,
 * fields on the elements of a mesh, charts. Knows points, meshes, cracks and the outline of a body; no
 * method, no solver, no scene. */
#ifndef PERIGAL_PICTURE_H
#define PERIGAL_PICTURE_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"

PG_API_BEGIN

/* ---- pictures (PNG or SVG by the file's ending) -------------------------------------------------------- */
/* The body behind the points, one of the three: its shapes, the cells of a lattice that are in (dim > 0;
 * before the shapes), plane elements (m). */
typedef struct { const pg_body *body; const pg_lattice *lattice; const pg_mesh *mesh; } pg_outline;
typedef struct {
    const char *title, *label;  /* label of the colour bar, with unit: "damage", "s_yy (MPa)" */
    double      low, high;                             /* colour range; low == high: from the data */
    int         diverging;                             /* 1: blue-white-red around 0, else sequential */
    double      magnify;                               /* points drawn at x + magnify u; 0: undeformed */
    const double *u;                                   /* n x dim displacement or NULL */
    const pg_cracks *cracks;                           /* drawn as lines, or NULL */
    /* 3D: 0: mid-plane of z; 1, 2, 3: the plane x, y, z = at; 4: the plane direction . x / |direction| = at
     * */
    int         section;
    double      at;                                    /* m */
    int         view;  /* 3D: a pg_view; other than PG_SECTION: the body from outside */
    double      direction[3];  /* section 4: normal; iso, crack: towards the eye, 0: usual */
    /* only points with select > above or equal are drawn, the body as an outline behind them; NULL: all (n)
     * */
    const double *select;
    double      above;
    int         clip;  /* colour range without a few stray values, see pg_picture_range */
    int         by_depth;  /* coloured by the coordinate along the eye's main axis instead */
    int         log;                                   /* colours by the decades of |value|, six at most */
    double      length;  /* meshes: m in a unit of the mesh; 0: not known, axes without unit */
    int         edges;  /* meshes: edges of elements: 0: if they are fewer than 5000; 1: drawn; -1: not */
    int         sets;  /* meshes: sets of sides (or nodes) in colours instead of the value */
    const pg_outline *outline;                         /* where the body is, or NULL: from the points alone */
    /* of the points, or NULL: not known. Displaced, whole points hold together however much they are
     * magnified; damaged ones may part (n) */
    const double *damage;
} pg_picture_style;
/* Sides as the sets of the same name: left x, bottom y, back z low; right, top, front high. The eye looks at
 * that side from outside, y up (top, bottom: x to the right). iso and crack: obliquely, y up, with light. */
enum {
    PG_SECTION,
    PG_VIEW_FRONT,
    PG_VIEW_BACK,
    PG_VIEW_LEFT,
    PG_VIEW_RIGHT,
    PG_VIEW_TOP,
    PG_VIEW_BOTTOM,
    PG_VIEW_ISO,
    PG_VIEW_CRACK,
    PG_VIEWS
};
#define PG_CRACK_DAMAGE 0.35  /* damage of points that view crack shows unless told otherwise */
extern const char pg_view_names[];                     /* "section|front|back|..." in that order */
/* Range of n finite values; excess > 0: without the outer 1 % at each end (of 50 to 99 values the outermost
 * one) if the rest spans less than 1 / excess of the whole (loose fragments fly far, single points carry the
 * stress of a corner or a tip). 1 in *found when there is a finite value, else 0 to 1. */
pg_status pg_picture_range (size_t n, const double *value, double excess, double *low, double *high,
                            int *found);
/* "z = 5 mm", "1, 0, 1 = 5 mm" (normal = distance from the origin along it): sets section, at, direction. */
pg_status pg_picture_section (pg_picture_style *style, const char *text);
pg_status pg_picture_direction (double direction[3], const char *text);       /* "1, 0.5, 2", not zero */
/* Appends text to a file name in out: letters, digits and ". - _" stay, what lies between becomes one _. */
void      pg_picture_name (char *out, size_t size, const char *text);
/* 2D field: each place of the body has the colour of the nearest point on its side of the pre-cracks, NaN
 * grey; points of no lattice without an outline: the gaps between them closed, as much body as their volumes
 * say; length unit chosen by size (mm, m, ...), axes with ticks, colour bar. 1D: a chart over x. 3D: the
 * section or the view that style names. Labels may raise and lower text: "c_{x} (m^{2})". */
pg_status pg_picture_field (const char *path, const pg_cloud *cloud, const double *value /* n */,
                            const pg_picture_style *style);

typedef struct { const char *title; const double *value, *u, *select, *damage; } pg_panel;
/* Several states in one picture with one colour bar, row by row; columns 0: as many as suit. style's value,
 * u, select, damage unused. */
pg_status pg_picture_panels (const char *path, const pg_cloud *cloud, size_t n, const pg_panel *panel,
                             int columns, const pg_picture_style *style);

/* A mesh: values at its nodes (nnode, in the unit of the label; NULL: elements coloured by block), u in units
 * of the mesh (nnode x dim of the mesh), cracks and select unused. 2D: its elements, curved edges as they
 * are; 3D: the surface from a view (PG_SECTION: iso). PG_E_USAGE: 1D meshes and sections. */
pg_status pg_picture_mesh (const char *path, const pg_mesh *mesh, const double *value,
                           const pg_picture_style *style);
/* A field at the points of a body that is a mesh, in m (style's u: of the points): on its elements as
 * pg_picture_mesh; nodes that are no points take the value between the corners. As points (pg_picture_field)
 * where elements would not do: body NULL or no mesh, pre-cracks, sections, selections, view crack. Elements
 * hide a crack: with broken bonds give NULL. */
pg_status pg_picture_body (const char *path, const pg_mesh_body *body, const pg_cloud *cloud,
                           const double *value /* n */, const pg_picture_style *style);
int       pg_picture_on_elements (const pg_mesh_body *body, const pg_picture_style *style);

/* A time for titles: 1.337e-5 s -> "13.37 µs" in UTF-8. */
void      pg_picture_time (double t, char *out, size_t size);
/* A value in SI with a prefix for its unit, which begins with N, m, Pa or J: -1.5034e7, "N" -> "-15.03 MN";
 * m2, m3 and the like stay as they are. */
void      pg_picture_quantity (double value, const char *unit, char *out, size_t size);

enum { PG_CURVE_LINE, PG_CURVE_MARKERS, PG_CURVE_BOTH };
typedef struct { const char *name; size_t n; const double *x, *y; int points; /* PG_CURVE_... */ } pg_curve;
/* A triangle of slope `order` (y ~ x^order) between x low and high, beside that curve, with the order written
 * at it. low == high: the middle part of the curve. Drawn where both axes are logarithmic and the curve
 * passes both ends. */
typedef struct { double order; size_t curve; double low, high; } pg_chart_slope;
/* a ring in the colour of that curve; text beside it, or NULL */
typedef struct { size_t curve; double x, y; const char *text; } pg_chart_mark;
typedef struct {
    const char *title, *xlabel, *ylabel;
    int logx, logy;
    int beside;  /* legend beside the frame; else there only if it would hide data */
    size_t nslope;  const pg_chart_slope *slopes;
    /* thin and pale behind the curve of the same number; n = 0: none; the legend has the name of the first */
    size_t npale;   const pg_curve *pale;
    size_t nmark;   const pg_chart_mark *marks;
    int zero;  /* lines through x = 0 and y = 0 where they lie inside the frame */
} pg_chart_style;
/* Curves differ in colour and marker, from the ninth on also in dashes and hollow markers. */
pg_status pg_picture_chart (const char *path, size_t ncurve, const pg_curve *curves,
                            const pg_chart_style *style);
/* What a test shows that raises |x| steadily, of a path of n states of a body that breaks event by event,
 * where x and y fall and rise. A state counts when its |x| (of the sign that the largest one has) exceeds
 * that of all before it: up to there the body held. linear: the states between two events lie on a line
 * through the origin, as under loads that all grow in proportion; then the curve starts there, falls at the
 * same x to the line of the next state that counts, or of the last one at the end. Else it joins the states
 * that count. ex, ey hold 2 n + 2 values; returns how many were filled. *peak: which of them has the largest
 * |y|. */
size_t pg_envelope (size_t n, const double *x, const double *y, int linear, double *ex, double *ey,
                    size_t *peak);
PG_API_END
#endif
