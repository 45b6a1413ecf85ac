/* SPDX-License-Identifier: GPL-3.0-or-later
 * crack.h: the geometry of cracks: their positions, their growth from tips (2D) and fronts (3D), and
 * distances to what surrounds these. It knows the body and its points (a pg_ground), but no bonds, no forces
 * and no problem. */
#ifndef PERIGAL_CRACK_H
#define PERIGAL_CRACK_H
#include "perigal/cells.h"

PG_API_BEGIN

/* ---- the body around cracks ---------------------------------------------------------------------------- */
/* The body, its points and their local spacing, for queries by the geometry of cracks. Borrowed. */
typedef struct {
    int dim;
    const pg_cloud *cloud;  const pg_body *body;
    const pg_between *between;                         /* gaps between points; NULL: there are none */
    const struct pg_body_search *search;               /* search structure (body_search.c), or NULL */
    /* Distance behind an open tip up to which its crack cuts no bonds, at the spacing cloud->h, m; that of a
     * tip whose faces are in contact. */
    double tip_offset, closed_tip_offset;
} pg_ground;

/* Creates the search structure for the body and its nearest points: by the elements of a mesh, or by the
 * nearest of graded points or points of a file. Borrows the mesh and the points. body: the shapes (n = 0:
 * none). */
pg_status pg_body_search_create (struct pg_body_search **out, const pg_cloud *cloud, const pg_body *body,
                                 const pg_mesh_body *part);
void      pg_body_search_free   (struct pg_body_search **search);
/* Distance from x (m) in direction e (unit) to where the body ends, at most `limit`, m. */
double    pg_ground_way_out (const pg_ground *ground, const double *x, const double *e, double limit);
/* Returns 1: x (m) is in the body (for points of a file, which have no surface: near a point); local spacing
 * at x, m: that of the nearest point. */
int       pg_ground_has_body   (const pg_ground *ground, const double *x);
double    pg_ground_spacing_at (const pg_ground *ground, const double *x);
/* Distance (m) beyond its end x by which a crack in direction e (unit) cuts: on the surface so far that it
 * reaches all points, which may lie outside the surface, but no other part of the body; elsewhere, and along
 * the surface, 0. */
double    pg_ground_beyond (const pg_ground *ground, const double *x, const double *e);
/* Part of `area` (m^2) of the 3D triangle o u v (m) that lies inside the body, m^2. */
double    pg_ground_area_inside (const pg_ground *ground, const double *o, const double *u, const double *v,
                                 double area);

/* ---- 2D: paths of cracks and their tips ---------------------------------------------------------------- */
/* A tip: an end of a 2D crack, from which it may grow. */
typedef struct {
    long   id;                                         /* 1, 2, ... in order of creation; never changes */
    /* the tip is an end of cracks.crack[segment]: 0: its first vertex, 1: the second */
    size_t segment; int end;
    int    open;  /* 0: met a boundary or another crack, or was stopped: grows no more */
    double x[3];                                       /* position of the tip, m */
    double offset;                                     /* no bonds are cut within this distance behind x, m */
    double grown;                                      /* length grown since the start, m */
} pg_tip;

/* Flag of a new crack (pg_paths_start, open), beside bits 0 and 1 that say which of its ends are tips: its
 * faces are in contact and slide. */
enum { PG_START_SLIDES = 4 };
enum { PG_MEETS_NOTHING, PG_MEETS_SURFACE, PG_MEETS_CRACK };
/* A front: the growing edge of a 3D crack, as vertices about a spacing apart, in the direction of its tangent
 * = ahead x normal (ahead, normal and tangent are right-handed). The ends of a front that is no closed loop
 * lie on the surface of the body, or on another crack. */
typedef struct {
    long   id;                                         /* 1, 2, ... in order of creation; never changes */
    long   of;  /* id of the front from which it split off; else its own id */
    int    closed, open;  /* closed: 1: a closed loop; open: 0: it grows no more */
    size_t n, capacity;
    /* vertices (m), unit normal of the crack, unit vector ahead (n x 3 each) */
    double *x, *normal, *ahead;
    double *offset, *grown;  /* distance behind x without cut bonds, m; length grown, m (n each) */
    unsigned char *meets;                              /* per vertex: PG_MEETS_... */
    /* Edge of the triangles grown so far: indices of vertices (pg_crack_surfaces.vertex) in the order of the
     * front; at the ends of the front it may continue beyond the surface of the body. nrim 0: nothing has
     * grown yet. */
    size_t *rim, nrim, rim_capacity;
} pg_front;

/* The 2D cracks of a state: those of the scene first, then the facets (straight pieces) by which they grew.
 * All pieces of a path run in the same direction, so that its left side is one face. Where a crack of the
 * scene grows, the part of it that cut no bonds yet becomes a piece of its own, which is sided like the
 * facets: points on it keep their bonds to one side. */
typedef struct pg_crack_paths {
    pg_cracks cracks;  size_t capacity, nfirst;        /* nfirst: cracks of the scene */
    size_t *parent;  /* per piece: the piece that it continues (they share a vertex); SIZE_MAX: none */
    size_t *path;  /* per piece: number of its path; pieces of a path share vertices */
    long   *owner;  /* per piece: id of the tip that made it; 0: cracks of the scene, and new cracks */
    double *store;  /* memory of the vertices (4) and retreats (2) of each piece, m */
    pg_tip *tip;  size_t ntip, tip_capacity;
    double  length;                                    /* length grown since the start, m */
    double  nothing;                                   /* positions no further apart are equal, m */
} pg_crack_paths;
/* Copying to paths that once held as many pieces cannot fail. */
pg_status pg_crack_paths_copy   (pg_crack_paths *to, const pg_crack_paths *from);
void      pg_crack_paths_free   (pg_crack_paths **paths);

/* pg_paths_of makes paths of cracks and their tips; positions no further apart than `nothing` (m) count as
 * equal. pg_paths_keep writes or reads them in checkpoints under `name`, with at most `most` pieces. */
pg_status pg_paths_of   (pg_crack_paths **out, const pg_cracks *cracks, const pg_tip *tip, size_t ntip,
                      double nothing);
pg_status pg_paths_keep (pg_crack_paths *paths, long most, const char *name, const pg_keeper *keeper);

/* Returns 1: positions a and b are no further apart than paths->nothing; reserves memory for n pieces in
 * all. */
int       pg_crack_paths_same (const pg_crack_paths *paths, const double *a, const double *b);
pg_status pg_crack_paths_reserve (pg_crack_paths *paths, size_t n);
/* Parts of pg_crack_grow and pg_crack_start that change the paths (memory must be reserved); changed: marks
 * pieces that cut other bonds than before. PG_E_USAGE: nothing is changed. */
pg_status pg_paths_grow  (pg_crack_paths *paths, const pg_ground *ground, size_t tip, const double *to,
                       int close, unsigned char *changed);
pg_status pg_paths_start (pg_crack_paths *paths, const pg_ground *ground, const double *from,
                          const double *to, int open, unsigned char *changed);
/* sets tip.offset (m); 0: no change */
int       pg_paths_draw_back (pg_crack_paths *paths, size_t tip, double offset);
/* Finds the position `back` (m) behind a tip along its path, at most the path's other end, and the unit
 * vector from there to the tip (2 each). */
void      pg_tip_chord    (const pg_crack_paths *paths, size_t tip, double back, double *from,
                           double *direction);
/* Distance along the path behind a tip to the first turn by more than `angle` (rad), m; INFINITY: none. */
double    pg_tip_straight (const pg_crack_paths *paths, size_t tip, double angle);
/* The vertices of the path of a tip, from the tip to its other end, without those at which it runs straight
 * on (*x: *n x 2, m; the caller frees). */
pg_status pg_tip_vertices (const pg_crack_paths *paths, size_t tip, size_t *n, double **x);
/* Length of the path from a tip to its other end, at most `limit`, m. */
double    pg_tip_behind   (const pg_crack_paths *paths, size_t tip, double limit);
/* Distance from a tip in a direction (unit vector) to the end of the body or to a crack in the way, at most
 * `limit`, m; *what: PG_MEETS_.... Gaps in a mesh of less than an eighth of the spacing may be missed. */
double    pg_tip_ahead (const pg_ground *ground, const pg_crack_paths *paths, size_t tip,
                        const double *direction, double limit, int *what);
/* Distance from a tip to the surface, another path, or another open tip, whichever is nearest, at most
 * `limit`, m; place: the nearest position (2, m); what: PG_MEETS_...; both may be NULL. */
double    pg_tip_nearest (const pg_ground *ground, const pg_crack_paths *paths, size_t tip, double limit,
                          double *place, int *what);
/* Distance from x (2, m) on a tip's path to surface, other path, branch or open tip, m, at most `limit`. */
double    pg_path_room (const pg_ground *ground, const pg_crack_paths *paths, size_t tip, const double *x,
                        double limit);
/* Returns 1: the piece lies on the path of the tip, between the tip and the path's other end. */
int       pg_tip_passes (const pg_crack_paths *paths, size_t tip, size_t piece);

/* ---- 3D: surfaces of cracks and their fronts ----------------------------------------------------------- */
/* The 3D cracks of a state: those of the scene first, then the triangles by which they grew, which share
 * vertices (no bond passes between them). Triangles are sided: they take the normal of the front that made
 * them, and points on them keep their bonds to the side to which it points. They cover the part of the crack
 * that cuts bonds, and end a little behind the fronts. */
typedef struct pg_crack_surfaces {
    pg_cracks cracks;  size_t capacity, nfirst;        /* nfirst: cracks of the scene */
    double *vertex;  size_t nvertex, vertex_capacity;  /* vertices of triangles (nvertex x 3), m */
    size_t *corner;                                    /* vertex indices of each triangle (3 each) */
    long   *owner;                                     /* id of the front that made each triangle */
    double *store;                                     /* positions of the corners of each triangle (9), m */
    pg_front *front;  size_t nfront, front_capacity;   /* fronts; those of cracks of the scene first */
    double  area;                                      /* area grown since the start, inside the body, m^2 */
    double  nothing;                                   /* positions no further apart are equal, m */
} pg_crack_surfaces;
pg_status pg_crack_surfaces_copy   (pg_crack_surfaces *to, const pg_crack_surfaces *from);
void      pg_crack_surfaces_free   (pg_crack_surfaces **surfaces);
/* pg_surfaces_of makes surfaces of cracks and their fronts; positions no further apart than `nothing` (m)
 * count as equal. pg_surfaces_keep writes or reads them in checkpoints under `name`, with at most `most`
 * items of a kind. */
pg_status pg_surfaces_of   (pg_crack_surfaces **out, const pg_cracks *cracks, const pg_front *front,
                         size_t nfront, double nothing);
pg_status pg_surfaces_keep (pg_crack_surfaces *w, long most, const char *name, const pg_keeper *k);
/* Parts of pg_front_advance (d, theta NULL: the front stops growing) and of pg_surface_start that change the
 * surfaces. PG_E_USAGE. */
pg_status pg_surfaces_advance (pg_crack_surfaces *w, const pg_ground *p, size_t front, const double *d,
                            const double *theta);
pg_status pg_surfaces_start   (pg_crack_surfaces *w, const pg_ground *p, size_t n, const double *x,
                            const double *normal);
/* Finds the fronts of 3D pre-cracks (*out, *n), before retreat is applied. retreat: of each crack, for each
 * of its edges (one for a disc), the distance behind the front without cut bonds, m; NULL: 0 for all. */
pg_status pg_fronts_find (const pg_ground *ground, const pg_cracks *cracks, double *const *retreat,
                          pg_front **out, size_t *n);
/* Reserves memory for n vertices of a front; copies a front; frees its arrays. */
pg_status pg_front_reserve (pg_front *front, size_t n);
pg_status pg_front_copy    (pg_front *to, const pg_front *from);
void      pg_front_clear   (pg_front *front);

/* Computes a unit vector along in the plane with this unit normal, from the plane and the axes of the lattice
 * alone: after a reflection or a rotation by 90 degrees of the plane it is transformed alike, or at 60 or 90
 * degrees to that. */
void      pg_plane_axis (const double *normal, double *along);
PG_API_END
#endif
