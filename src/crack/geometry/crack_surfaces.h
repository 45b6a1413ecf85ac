/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the folder: surfaces of cracks that grow in space, and how a front advances.
 *
 *   crack_surfaces.c        one step of a front on a copy of the surfaces; what of it is a front after it
 *   crack_surfaces_move.c   where its vertices go, and where the crack cuts behind them
 *   crack_surfaces_tiles.c  triangles between two lines
 *   crack_surfaces_meet.c   where a vertex meets the surface of the body, another crack, another front
 *   crack_surfaces_line.c   vertices of a front distributed anew, and their frames
 *   front_loops.c           where those of a loop begin
 *   crack_surfaces_start.c  new cracks
 *   crack_surfaces_memory.c memory, copies, checkpoints */
#ifndef PG_MODEL_CRACK_SURFACES_H
#define PG_MODEL_CRACK_SURFACES_H
#include "perigal/crack.h"
#include "perigal/vector.h"
#include <math.h>

/* ---- crack_surfaces_memory.c --------------------------------------------------------------------------- */
pg_status surfaces_reserve (pg_crack_surfaces *w, size_t cracks, size_t vertices);   /* in all */
pg_status surfaces_reserve_fronts (pg_crack_surfaces *w, size_t n);

/* ---- crack_surfaces_tiles.c ---------------------------------------------------------------------------- */
/* Appends a vertex, or a triangle of a unit normal; there is room for it. */
size_t surfaces_put_vertex (pg_crack_surfaces *w, const double *x);
void   surfaces_put_triangle (pg_crack_surfaces *w, const size_t corner[3], const double *normal,
                              double width, long owner);
/* A line of vertices of the surfaces; closed: from the last on to the first. normal: of the crack there, the
 * side that triangles show to (n x 3). */
typedef struct { size_t n; const size_t *vertex; const double *normal; int closed; } surface_line;
/* Triangles between two lines of the same direction, whose edges across are the shortest in all. Those of
 * next to no height are left out. */
pg_status surfaces_zip (pg_crack_surfaces *w, const pg_ground *p, const surface_line *from,
                        const surface_line *to, long owner);
double triangle_area3 (const double *a, const double *b, const double *c);

/* ---- crack_surfaces_meet.c ----------------------------------------------------------------------------- */
/* The place of the surface nearest to x within the plane of e (unit, about towards the surface) and u (unit,
 * across e), and the direction of the surface in that plane. 0: there is none up to `limit`. */
int space_foot (const pg_ground *p, const double *x, const double *e, const double *u, double limit,
                double *foot, double *along);
/* Where a vertex that would go to x + d e ends: the way to go, m; *meets: what it meets there. */
double space_way (const pg_ground *p, const pg_crack_surfaces *w, size_t front, size_t vertex,
                  const double *e, double d, unsigned char *meets, double *place);
/* Distance from x in direction e to the first place without body or to a crack, whichever comes first, at
 * most `limit`; *meets: which. */
double space_end (const pg_ground *p, const pg_crack_surfaces *w, const double *x, const double *e,
                  double limit, unsigned char *meets);

/* ---- front_loops.c ------------------------------------------------------------------------------------- */
/* Directions in the plane across a unit normal, of one of which the first vertex of a loop lies ahead of its
 * middle; returns how many. *parts: the number of its vertices is a multiple of this. */
enum { LOOP_DIRECTIONS = 6 };
int    front_loop_directions (const double *normal, double direction[LOOP_DIRECTIONS][3], size_t *parts);
/* How many vertices a loop of this length, in spacings, has. */
size_t front_loop_parts (double length, size_t parts);
/* First vertex of a loop on a closed line of n places x: at the share of the piece that begins at *from.
 * Returns parts: the number of vertices is a multiple of it. */
size_t front_loop_start (size_t n, const double *x, size_t *from, double *share);

/* ---- crack_surfaces_line.c ----------------------------------------------------------------------------- */
/* Unit tangent at vertex i of a front. */
void front_tangent (const pg_front *f, size_t i, double *tangent);
/* Makes ahead and normal orthogonal to the tangent and to each other. */
void front_frames (pg_front *f);
/* Vertices about a spacing apart; c: the places where the crack cuts to (n x 3), moved with them. */
pg_status front_resample (pg_front *f, const pg_ground *p, double **c);

/* How far a crack cuts beyond another one that it meets; fronts within `met` of the place where another one
 * met them end there; what is left between closed vertices goes on at most `run_out`: spacings. */
static const double surface_flap = 0.1, surface_met = 0.75, surface_run_out = 4;

/* What one front does in a step. */
typedef struct {
    pg_crack_surfaces *w;
    const pg_ground *p;
    size_t number;                                     /* of the front in w */
    pg_front old, now;                                 /* before (a view), and moved */
    double *c, *bend, *way;  /* where the crack cuts to, and where it bends (n x 3); direction of motion */
    double *moved;                                     /* distance that each vertex went, m */
    unsigned char *shut;                               /* vertices that are closed by this step */
    size_t nshut;
    size_t *line, nline, line_capacity;                /* the new line, as vertices of w */
    double *side; size_t side_capacity;                /* crack normal at each vertex of line */
} stride;

/* ---- crack_surfaces_move.c ----------------------------------------------------------------------------- */
/* Moves the vertices (d, theta NULL: none moves) and closes those that meet something; says where the crack
 * cuts to behind them. */
pg_status stride_move (stride *s, const double *d, const double *theta);
/* Closes a vertex where it is. */
void stride_shut (stride *s, size_t i, unsigned char meets);
int  stride_is_end (const stride *s, size_t i);
/* Spacing where a vertex has come to, m. */
double stride_spacing (const stride *s, size_t i);

/* ---- crack_surfaces.c ---------------------------------------------------------------------------------- */
/* Adds a place to the new line; one where the surface has a vertex already is that vertex. */
pg_status stride_to_line    (stride *s, const double *x, const double *normal);
/* The line goes on beyond the end of a front on the surface, in the direction from its neighbour. */
pg_status stride_beyond_end (stride *s, unsigned char meets, const double *end, const double *beside,
                             const double *normal);
/* Adds the vertices of a front, whose crack cuts to c, to the line; its rim is that stretch of the line.
 * shared: its first vertex is the last of the line already. starts, stops: with what lies beyond its ends. */
pg_status stride_lay        (stride *s, pg_front *f, const double *c, int shared, int starts, int stops);
/* How far behind its place a front cuts nothing, m. */
double front_offset_at (const pg_ground *p, const double *x);
long   surfaces_next_id (const pg_crack_surfaces *w);
/* Length of a front, m. */
double front_length (const pg_front *f);
#endif
