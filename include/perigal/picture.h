/* SPDX-License-Identifier: GPL-3.0-or-later
 * picture.h: draws plain arrays as PNG or SVG files; the ending of the file name chooses
 * which. There are three kinds of picture: a field at the points of a cloud, a field on the
 * elements of a mesh, and a chart of curves. This folder knows points, meshes, pre-cracks and
 * the outline of a body. It knows nothing of methods, solvers or scenes, so any program may
 * call it with arrays of its own.
 *
 * All functions that write a file return PG_E_USAGE for a request that cannot be drawn,
 * PG_E_FILE when the file cannot be written and PG_E_MEMORY when memory runs out; after a
 * failure no file is left behind. */
#ifndef PERIGAL_PICTURE_H
#define PERIGAL_PICTURE_H
#include "perigal/cloud.h"
#include "perigal/mesh.h"

PG_API_BEGIN

/* ---- pictures (PNG or SVG by the file's ending) ----------------------------------------------------- */
/* Outline of the body, which the points alone do not define exactly at its edges. Exactly one of the three is
 * used, in this order: a mesh of plane elements (coordinates in m), the cells of a lattice that belong to the
 * body (if lattice->dim > 0), the shapes of the body. */
typedef struct { const pg_body *body; const pg_lattice *lattice; const pg_mesh *mesh; } pg_outline;
/* Common frame of several pictures of one cloud: range across and upwards, m; any = 1: at least one picture
 * has been measured. */
typedef struct { int any; double low[2], high[2]; } pg_reach;
/* How a picture looks. A structure of zeros is a valid choice: no title, colours over the
 * range of the values, an undeformed body, in 3D the section through the middle of z. */
typedef struct {
    /* The label of the colour bar ends with its unit in brackets, as in "s_yy (MPa)". */
    const char *title, *label;
    /* Range of the colours in the unit of the values; low == high takes it from the values. */
    double      low, high;
    /* 1: blue, white and red, with white at zero; 0: a scale that grows lighter with the
     * value. */
    int         diverging;
    /* Points are drawn at x + magnify u; 0 draws the undeformed body. */
    double      magnify;
    /* Displacement (n x dim, m), or NULL. */
    const double *u;
    /* Cracks, drawn as lines, or NULL. */
    const pg_cracks *cracks;
    /* Plane of a section of a 3D body: 0 is the middle of z; 1, 2 and 3 are x, y, z = at; 4 is
     * the oblique plane direction . x / |direction| = at. */
    int         section;
    /* Distance of that plane from the origin along its normal, m. */
    double      at;
    /* A value of the enum below; any other than PG_SECTION shows a 3D body from outside. */
    int         view;
    /* Section 4: the normal of the plane. Views iso and crack: the direction from the body
     * towards the eye, or zero for the usual oblique one. */
    double      direction[3];
    /* Only points with select[i] >= above are drawn, in front of the rest of the body, which
     * is almost white with its outline in grey (n values); NULL draws all points. */
    const double *select;
    double      above;
    /* 1: the range of the colours leaves out a few stray values, see pg_picture_range. */
    int         clip;
    /* 1: the colour is not the value but the coordinate axis that the eye looks along most
     * nearly. */
    int         by_depth;
    /* 1: colours by the decades of |value|, six at most. */
    int         log;
    /* Meshes only: metres in one unit of the mesh's coordinates; 0 if that is not known, and
     * then the axes have no unit. */
    double      length;
    /* Meshes only: 1 draws the edges of elements, -1 does not, 0 draws them if fewer than 5000
     * faces are seen. */
    int         edges;
    /* Meshes only: 1 colours the named sets of sides or nodes and ignores the values. */
    int         sets;
    /* Outline of the body; NULL: estimated from the points alone. */
    const pg_outline *outline;
    /* Damage of the points (n), or NULL if it is not known. In a deformed picture two
     * neighbours of which one has a damage below 0.1 stay together however much the
     * displacement is magnified; others may separate. */
    const double *damage;
    /* Points in 2D and 3D only, for pictures of one size: the frame, as pg_picture_reach has measured it
     * (any = 0: that of the picture), and no line about values that the colours leave out. NULL: none of
     * this. */
    const pg_reach *reach;
} pg_picture_style;
/* Views are named like the sides of a body: left is the side of small x, bottom of small y,
 * back of small z; right, top and front are the opposite ones. The eye looks at that side from
 * outside with y upwards (top and bottom: with x to the right). The views iso and crack look
 * obliquely, with y upwards and with light and shade. */
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
/* The view crack shows the points whose damage is at least this, unless the caller chooses
 * another limit. */
#define PG_CRACK_DAMAGE 0.35
/* The names of the views in the order of the enum, separated by |. */
extern const char pg_view_names[];
/* Finds the range of the finite ones among n values. With excess > 0 the outer 1 % at each end
 * (of 50 to 99 values the outermost one) are left out if the rest spans less than 1 / excess
 * of the whole range: loose fragments fly far, and single points carry the stress of a corner
 * or of a crack tip, and either would leave one colour for all else. *found is 1 if there is
 * any finite value, else 0 with the range 0 to 1. Fails on missing memory only. */
pg_status pg_picture_range (size_t n, const double *value, double excess, double *low, double *high,
                            int *found);
/* Reads a section from text: "z = 5 mm", or a normal and the distance from the origin along
 * it, "1, 0, 1 = 5 mm"; a number without a unit is in m. Sets view, section, at and direction
 * of the style; PG_E_USAGE for other text. */
pg_status pg_picture_section (pg_picture_style *style, const char *text);
/* Reads a direction "1, 0.5, 2"; PG_E_USAGE if it is zero or is not three numbers. */
pg_status pg_picture_direction (double direction[3], const char *text);
/* Appends text to the file name in out (of `size` bytes): letters, digits and ". - _" stay,
 * each run of other characters becomes one underscore, and none is left at the end. */
void      pg_picture_name (char *out, size_t size, const char *text);
/* Draws a field at the n points of a cloud. In 2D each place of the body has the colour of the
 * nearest point on its own side of the pre-cracks, and NaN is grey. Of irregular points
 * without an outline the gaps between them are closed so that the drawn area is that of the
 * points' volumes. The length unit follows the size of the body, axes have ticks, and a colour
 * bar stands beside the picture. A 1D body becomes a chart of the value over x. A 3D body is
 * shown by the section or the view that the style names. Labels may raise and lower text:
 * "c_{x} (m^{2})". */
pg_status pg_picture_field (const char *path, const pg_cloud *cloud, const double *value /* n */,
                            const pg_picture_style *style);

/* One state of several in a common picture: its title, the values (n), and, each or NULL, displacement (n
 * x dim, m), the values that select points (n), the damage (n), and the cracks of this state (NULL: those
 * of the style). */
typedef struct {
    const char *title;
    const double *value, *u, *select, *damage;
    const pg_cracks *cracks;
} pg_panel;
/* Draws n states of one cloud in one picture with one colour bar, row by row in the given
 * number of columns; 0 chooses the number of columns by the shape of the body. The style's own
 * u, select and damage are not used. */
pg_status pg_picture_panels (const char *path, const pg_cloud *cloud, size_t n, const pg_panel *panel,
                             int columns, const pg_picture_style *style);

/* Widens *reach by the frame that a picture of this state would have. Nothing is drawn. */
pg_status pg_picture_reach  (pg_reach *reach, const pg_cloud *cloud, const pg_panel *panel,
                             const pg_picture_style *style);

/* A movie: pictures of one size, one after the other, as an animated PNG that begins again at its end (PNG
 * third edition, W3C 2025), which browsers show; other programs show its first picture. */
typedef struct pg_movie pg_movie;
/* Creates a movie of `frames` pictures, shown at `rate` per second (0.01 to 1000); path ends in .png or
 * .apng. PG_E_USAGE; PG_E_FILE. */
pg_status pg_movie_create (pg_movie **out, const char *path, size_t frames, double rate);
/* Appends a picture, a PNG file written by this folder. PG_E_USAGE: it has not the size of the first one;
 * PG_E_FILE: it cannot be read, or the movie not written. */
pg_status pg_movie_add    (pg_movie *movie, const char *picture);
/* Ends and frees it; unless all of its pictures have come and `so_far` is PG_OK the file is removed.
 * Returns so_far, or what went wrong at the end. */
pg_status pg_movie_close  (pg_movie **movie, pg_status so_far);

/* Draws a mesh: values at its nodes (nnode, in the unit of the label), or with value == NULL
 * every block of elements in a colour of its own. The style's u is in units of the mesh (nnode
 * x dim of the mesh); cracks and select are not used. In 2D all elements are drawn, curved
 * edges as curves; in 3D the surface from a view, where PG_SECTION and PG_VIEW_CRACK mean iso.
 * PG_E_USAGE: no elements, meshes of bars, and sections. */
pg_status pg_picture_mesh (const char *path, const pg_mesh *mesh, const double *value,
                           const pg_picture_style *style);
/* Draws a field at the points of a body that was read from a mesh, coordinates in m (the
 * style's u belongs to the points): on the elements, as pg_picture_mesh does, where nodes that
 * are no points take the value between the corners. Where elements cannot show the picture
 * (pg_picture_on_elements), the points are drawn as pg_picture_field does. Elements hide a
 * crack, so callers whose bonds have broken pass body == NULL. */
pg_status pg_picture_body (const char *path, const pg_mesh_body *body, const pg_cloud *cloud,
                           const double *value /* n */, const pg_picture_style *style);
/* 1 if pg_picture_body would draw elements: there is a mesh of dimension 2 or 3, and the style
 * asks for no pre-cracks, section, selection, colour by depth or view crack. */
int       pg_picture_on_elements (const pg_mesh_body *body, const pg_picture_style *style);

/* Writes a time in s for titles with four digits and a suitable unit: 1.337e-5 becomes "13.37
 * µs" in UTF-8. */
void      pg_picture_time (double t, char *out, size_t size);
/* Writes an SI value with a prefix before its unit, which begins with N, m, Pa or J: -1.5034e7
 * and "N" become "-15.03 MN". Powers of length (m2, m3) keep their unit, for a prefix would be
 * raised as well. */
void      pg_picture_quantity (double value, const char *unit, char *out, size_t size);

/* Draws the cracks of a scene alone, over a body of shapes (pg_body_read: without its slots): in 2D the
 * body coloured by the distance to the nearest crack, in 3D the places that cracks pass, seen from
 * outside. The cracks must have an index (pg_cracks_index). PG_E_USAGE: no shapes, or a bar. */
pg_status pg_picture_network (const char *path, const pg_body *body, const pg_cracks *cracks,
                              const char *title);

enum { PG_CURVE_LINE, PG_CURVE_MARKERS, PG_CURVE_BOTH };
/* A curve of a chart: n places (x, y), its name in the legend, and whether it is drawn as a
 * line, as markers or both. Places that are not finite, or not positive on a logarithmic axis,
 * interrupt the line. */
typedef struct { const char *name; size_t n; const double *x, *y; int points; /* PG_CURVE_... */ } pg_curve;
/* A triangle that shows the slope y ~ x^order below curve number `curve` between x = low and
 * high, with the order written at it; low == high takes the middle part of the curve. It is
 * drawn only where both axes are logarithmic and the curve covers both ends. */
typedef struct { double order; size_t curve; double low, high; } pg_chart_slope;
/* A ring around the place (x, y) in the colour of that curve, with a text beside it, or NULL. */
typedef struct { size_t curve; double x, y; const char *text; } pg_chart_mark;
/* How a chart looks; zeros are a valid choice. */
typedef struct {
    const char *title, *xlabel, *ylabel;
    /* 1: this axis is logarithmic. */
    int logx, logy;
    /* 1: the legend stands to the right of the frame; 0: only if there is no place inside that
     * hides nothing. */
    int beside;
    /* Slope triangles. */
    size_t nslope;  const pg_chart_slope *slopes;
    /* Thin, pale curves that are drawn behind the curve of the same number (n = 0: none), for
     * example a raw path behind its envelope. The legend shows the name of the first one for
     * all of them. */
    size_t npale;   const pg_curve *pale;
    /* Rings with texts; only the first eight texts are written. */
    size_t nmark;   const pg_chart_mark *marks;
    /* 1: draws lines through x = 0 and y = 0 where these lie inside the frame. */
    int zero;
} pg_chart_style;
/* Draws curves over common axes. Curves differ in colour and in marker; from the ninth on also
 * in dashes and by hollow markers. Nothing visible gives an empty chart from 1 to 10. */
pg_status pg_picture_chart (const char *path, size_t ncurve, const pg_curve *curves,
                            const pg_chart_style *style);
/* Computes the envelope of an equilibrium path, the curve measured in a test that raises |x| steadily
 * (displacement control), given a path of n states (x, y) of a body that breaks event by event, in which both
 * may fall and rise (snap-back). A state belongs to the envelope if its
 * |x|, of the sign of the largest |x|, exceeds that of all states before it.
 *
 * linear = 1 says that between two events the states lie on a line through the origin, as they do if all
 * loads grow in proportion: then the envelope starts at the origin, and at each event y falls at constant x
 * to the line of the next state that counts, or at the end to that of the last state. linear = 0 joins the
 * states that count.
 *
 * ex, ey must hold 2 n + 2 values each; the return value says how many were written. *peak is the index of
 * the largest |y| among them. */
size_t pg_envelope (size_t n, const double *x, const double *y, int linear, double *ex, double *ey,
                    size_t *peak);
PG_API_END
#endif
