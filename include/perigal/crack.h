/* SPDX-License-Identifier: GPL-3.0-or-later
 * crack.h: the geometry of cracks: where they are, how they grow from their tips and fronts, what lies around
 * these. It knows the body and its points (a pg_ground), but no bonds, no forces and no problem. */
#ifndef PERIGAL_CRACK_H
#define PERIGAL_CRACK_H
#include "perigal/cells.h"

PG_API_BEGIN

/* ---- the body around cracks ---------------------------------------------------------------------------- */
/* Where a body is, and how fine its points are there: what the geometry of cracks asks for. Borrowed. */
typedef struct {
    int dim;
    const pg_cloud *cloud;  const pg_body *body;
    const pg_between *between;                         /* what parts the points; NULL: nothing does */
    const struct pg_body_search *search;               /* NULL: there is none (body_search.c) */
    /* Distance behind a tip from which its crack cuts, where the spacing is cloud->h, m; of a tip whose faces
     * touch. */
    double tip_offset, closed_tip_offset;
} pg_ground;

/* Finds the body and its nearest points: of a mesh by its elements, of graded points or points of a file by
 * the nearest of them. Borrows the mesh and the points. body: the shapes, n 0 where there are none. */
pg_status pg_body_search_create (struct pg_body_search **out, const pg_cloud *cloud, const pg_body *body,
                                 const pg_mesh_body *part);
void      pg_body_search_free   (struct pg_body_search **search);
/* Distance from x in direction e (unit) to the first place without body, at most `limit`, m. */
double    pg_ground_way_out (const pg_ground *ground, const double *x, const double *e, double limit);
/* Is there body at x? Points of a file have no surface: a place is in the body if a point is near. Local
 * spacing there, that of the nearest point, m. */
int       pg_ground_has_body   (const pg_ground *ground, const double *x);
double    pg_ground_spacing_at (const pg_ground *ground, const double *x);
/* How far a crack that ends at x, going in direction e, cuts beyond: on the surface as far as points may lie
 * outside of it, but not into body that follows; elsewhere and along the surface not at all. */
double    pg_ground_beyond (const pg_ground *ground, const double *x, const double *e);
/* What of the area (m^2) of the triangle o u v in space lies inside the body. */
double    pg_ground_area_inside (const pg_ground *ground, const double *o, const double *u, const double *v,
                                 double area);

/* ---- in the plane: paths and their tips ---------------------------------------------------------------- */
/* An end of a crack in the plane, from which it may grow. */
typedef struct {
    long   id;                                         /* 1, 2, ... as they came into being; stays with it */
    size_t segment; int end;  /* cracks.crack[segment] ends there: 0: with its first vertex, 1: the second */
    int    open;  /* 0: met a boundary or another crack, or was stopped: grows no more */
    double x[3];                                       /* m */
    double offset;                                     /* bonds are cut only so far behind x, m */
    double grown;                                      /* length since the start, m */
} pg_tip;

/* Of a new crack, beside bits 0 and 1 that say which of its ends are tips: its faces touch and slide. */
enum { PG_START_SLIDES = 4 };
enum { PG_MEETS_NOTHING, PG_MEETS_SURFACE, PG_MEETS_CRACK };
/* A front of a crack in space: vertices about a spacing apart, in the order in which the tangent runs, which
 * is ahead x normal: ahead, normal and tangent are right-handed. The ends of a front that is no loop lie on
 * the surface of the body, or on another crack. */
typedef struct {
    long   id;                                         /* 1, 2, ... as they came into being; stays with it */
    long   of;  /* id of the one that it has parted from; its own where it has not */
    int    closed, open;                               /* a loop; 0: grows no more */
    size_t n, capacity;
    /* vertices (m), unit normal of the crack, unit vector ahead (n x 3 each) */
    double *x, *normal, *ahead;
    double *offset, *grown;  /* bonds are cut only so far behind x (m); length grown (m) (n each) */
    unsigned char *meets;                              /* per vertex: PG_MEETS_... */
    /* Where the triangles that have grown end: their vertices (pg_crack_surfaces.vertex), in the order of the
     * front; at the ends of the front it may go on beyond the surface. None: nothing has grown yet. */
    size_t *rim, nrim, rim_capacity;
} pg_front;

/* The cracks that exist in a state: those of the scene first, then the facets that grew, straight pieces
 * which follow each other. All pieces of a path run in the same direction, so that its left side is one
 * face. Where a crack of the scene grows, the part of it that cut no bonds yet becomes a piece of its own,
 * sided like the facets: points on it keep their bonds to one side. */
typedef struct pg_crack_paths {
    pg_cracks cracks;  size_t capacity, nfirst;        /* nfirst: how many are the scene's */
    size_t *parent;  /* per piece: the one that it continues (they share a vertex); SIZE_MAX: none */
    size_t *path;  /* per piece: number of its path; pieces of a path hang together by their vertices */
    long   *owner;  /* per piece: id of the tip that made it; 0: cracks of the scene, and new cracks */
    double *store;  /* vertices and retreats of the pieces (6 each), to which their pointers lead */
    pg_tip *tip;  size_t ntip, tip_capacity;
    double  length;                                    /* grown since the start, m */
    double  nothing;                                   /* places no further apart are one, m */
} pg_crack_paths;
/* Copying to paths that once held as many pieces cannot fail. */
pg_status pg_crack_paths_copy   (pg_crack_paths *to, const pg_crack_paths *from);
void      pg_crack_paths_free   (pg_crack_paths **paths);

/* Paths of cracks and their tips; places no further apart than `nothing` (m) are one. In a checkpoint under
 * `name`, at most so many pieces. */
pg_status pg_paths_of   (pg_crack_paths **out, const pg_cracks *cracks, const pg_tip *tip, size_t ntip,
                      double nothing);
pg_status pg_paths_keep (pg_crack_paths *paths, long most, const char *name, const pg_keeper *keeper);

/* Do two places lie at one? Room for n pieces of cracks in all. */
int       pg_crack_paths_same (const pg_crack_paths *paths, const double *a, const double *b);
pg_status pg_crack_paths_reserve (pg_crack_paths *paths, size_t n);
/* What pg_crack_grow and pg_crack_start do to the paths, which have room for it; changed: marks pieces that
 * cut other bonds than before. PG_E_USAGE: nothing is changed. */
pg_status pg_paths_grow  (pg_crack_paths *paths, const pg_ground *ground, size_t tip, const double *to,
                       int close, unsigned char *changed);
pg_status pg_paths_start (pg_crack_paths *paths, const pg_ground *ground, const double *from,
                          const double *to, int open, unsigned char *changed);
int       pg_paths_draw_back (pg_crack_paths *paths, size_t tip, double offset);  /* 0: nothing is changed */
/* The place `back` (m) behind a tip along its path, at most the path's other end, and the unit vector from
 * there to the tip (2 each). */
void      pg_tip_chord    (const pg_crack_paths *paths, size_t tip, double back, double *from,
                           double *direction);
/* Distance along the path behind a tip to the first turn by more than `angle` (rad), m; INFINITY: none. */
double    pg_tip_straight (const pg_crack_paths *paths, size_t tip, double angle);
/* The vertices of the path of a tip, from the tip to its other end, without those at which it runs straight
 * on (*x: *n x 2, m; the caller frees). */
pg_status pg_tip_vertices (const pg_crack_paths *paths, size_t tip, size_t *n, double **x);
/* Length of the path behind a tip up to its other end, or `limit` if that is less, m. */
double    pg_tip_behind   (const pg_crack_paths *paths, size_t tip, double limit);
/* How far from a tip in a direction (unit vector) the body ends, or a crack lies across, m; *what says
 * which. At most `limit`. Gaps in a mesh of less than an eighth of the spacing may be missed. */
double    pg_tip_ahead (const pg_ground *ground, const pg_crack_paths *paths, size_t tip,
                        const double *direction, double limit, int *what);
/* Distance from a tip to the nearest place of the surface, of another path, or of another open tip, m; at
 * most `limit`. place (2) and what may be NULL. */
double    pg_tip_nearest (const pg_ground *ground, const pg_crack_paths *paths, size_t tip, double limit,
                          double *place, int *what);
/* Distance from x (2, m) on a tip's path to surface, other path, branch or open tip, m, at most `limit`. */
double    pg_path_room (const pg_ground *ground, const pg_crack_paths *paths, size_t tip, const double *x,
                        double limit);
/* Is a piece passed on the way from the tip along its path to the other end? */
int       pg_tip_passes (const pg_crack_paths *paths, size_t tip, size_t piece);

/* ---- in space: surfaces and their fronts --------------------------------------------------------------- */
/* The cracks that exist in a state: those of the scene first, then the triangles that grew, which share their
 * vertices with each other (no bond passes between them). Triangles are sided: their normal is that of the
 * front that made them, and points on them keep their bonds to the side that it shows to. They reach as far
 * as the crack cuts, a little behind the fronts. */
typedef struct pg_crack_surfaces {
    pg_cracks cracks;  size_t capacity, nfirst;        /* nfirst: how many are the scene's */
    double *vertex;  size_t nvertex, vertex_capacity;  /* of the triangles, nvertex x 3, m */
    size_t *corner;                                    /* per triangle 3 vertices */
    long   *owner;                                     /* per triangle: id of the front that made it */
    double *store;                                     /* per triangle the places of its corners, 9 each */
    pg_front *front;  size_t nfront, front_capacity;   /* fronts: those of the scene's cracks first */
    double  area;                                      /* grown since the start, inside the body, m^2 */
    double  nothing;                                   /* places no further apart are one, m */
} pg_crack_surfaces;
pg_status pg_crack_surfaces_copy   (pg_crack_surfaces *to, const pg_crack_surfaces *from);
void      pg_crack_surfaces_free   (pg_crack_surfaces **surfaces);
/* Surfaces that grow from cracks and their fronts; places no further apart than `nothing` (m) are one.
 * In a checkpoint under `name`, at most so many parts of a kind. */
pg_status pg_surfaces_of   (pg_crack_surfaces **out, const pg_cracks *cracks, const pg_front *front,
                         size_t nfront, double nothing);
pg_status pg_surfaces_keep (pg_crack_surfaces *w, long most, const char *name, const pg_keeper *k);
/* What pg_front_advance does to surfaces; d, theta NULL: the front ends where it is. What pg_surface_start
 * does. PG_E_USAGE. */
pg_status pg_surfaces_advance (pg_crack_surfaces *w, const pg_ground *p, size_t front, const double *d,
                            const double *theta);
pg_status pg_surfaces_start   (pg_crack_surfaces *w, const pg_ground *p, size_t n, const double *x,
                            const double *normal);
/* The fronts of the pre-cracks in space (*out, *n), before these retreat. retreat: of each crack,
 * of each of its edges (of a disc: one), m; NULL: none retreats. */
pg_status pg_fronts_find (const pg_ground *ground, const pg_cracks *cracks, double *const *retreat,
                          pg_front **out, size_t *n);
/* Room for n vertices in the arrays of a front; a copy of one in another's arrays; its arrays. */
pg_status pg_front_reserve (pg_front *front, size_t n);
pg_status pg_front_copy    (pg_front *to, const pg_front *from);
void      pg_front_clear   (pg_front *front);

/* A unit vector in the plane across a unit normal, which follows from that plane and the axes of the lattice:
 * seen in a mirror or turned by a right angle it is that of before, or at 60 or 90 degrees to it. */
void      pg_plane_axis (const double *normal, double *along);
PG_API_END
#endif
