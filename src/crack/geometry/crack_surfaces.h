/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the folder: surfaces of growing 3D cracks, and the advance of a front.
 *
 *   crack_surfaces.c        one step of a front on a copy of the surfaces; fronts after the step
 *   crack_surfaces_move.c   motion of its vertices, and the edge of the cutting part behind them
 *   crack_surfaces_tiles.c  triangles between two lines
 *   crack_surfaces_meet.c   vertices that meet the surface of the body, another crack or front
 *   crack_surfaces_line.c   redistribution of the vertices of a front, and their frames
 *   front_loops.c           first vertex of a closed loop
 *   crack_surfaces_start.c  new cracks
 *   crack_surfaces_memory.c memory, copies, checkpoints */
#ifndef PG_MODEL_CRACK_SURFACES_H
#define PG_MODEL_CRACK_SURFACES_H
#include "perigal/crack.h"
#include "perigal/vector.h"
#include <math.h>

/* ---- crack_surfaces_memory.c --------------------------------------------------------------------------- */
pg_status surfaces_reserve (pg_crack_surfaces *w, size_t cracks, size_t vertices);   /* total numbers */
pg_status surfaces_reserve_fronts (pg_crack_surfaces *w, size_t n);

/* ---- crack_surfaces_tiles.c ---------------------------------------------------------------------------- */
/* Append a vertex, or a triangle with its unit normal (memory must be reserved). */
size_t surfaces_put_vertex (pg_crack_surfaces *w, const double *x);
void   surfaces_put_triangle (pg_crack_surfaces *w, const size_t corner[3], const double *normal,
                              double width, long owner);
/* A line of vertices of the surfaces; closed: 1: a loop. normal: normal of the crack at each vertex, which
 * orients triangles (n x 3). */
typedef struct { size_t n; const size_t *vertex; const double *normal; int closed; } surface_line;
/* Adds triangles between two lines of the same direction, with the least total length of cross edges.
 * Degenerate triangles are omitted. */
pg_status surfaces_zip (pg_crack_surfaces *w, const pg_ground *p, const surface_line *from,
                        const surface_line *to, long owner);
double triangle_area3 (const double *a, const double *b, const double *c);

/* ---- crack_surfaces_meet.c ----------------------------------------------------------------------------- */
/* Finds the point of the surface nearest to x (m) in the plane of e (unit, roughly towards the surface) and u
 * (unit, normal to e): *foot, and the direction `along` of the surface in that plane. Returns 0: none within
 * `limit` (m). */
int space_foot (const pg_ground *p, const double *x, const double *e, const double *u, double limit,
                double *foot, double *along);
/* Distance, m, by which a vertex really moves that is to move to x + d e; place: its new position; *meets:
 * PG_MEETS_... there. */
double space_way (const pg_ground *p, const pg_crack_surfaces *w, size_t front, size_t vertex,
                  const double *e, double d, unsigned char *meets, double *place);
/* Distance, m, from x in direction e to the end of the body or to a crack, whichever is nearer, at most
 * `limit`; *meets: PG_MEETS_.... */
double space_end (const pg_ground *p, const pg_crack_surfaces *w, const double *x, const double *e,
                  double limit, unsigned char *meets);

/* ---- front_loops.c ------------------------------------------------------------------------------------- */
/* Candidate directions (unit, normal to `normal`) from the middle of a loop to its first vertex; returns
 * their number. *parts: the number of vertices must be a multiple of this. */
enum { LOOP_DIRECTIONS = 6 };
int    front_loop_directions (const double *normal, double direction[LOOP_DIRECTIONS][3], size_t *parts);
/* Number of vertices of a loop of this length (in spacings): a multiple of `parts`. */
size_t front_loop_parts (double length, size_t parts);
/* Finds the first vertex of a loop on a closed line of n points x (m): at the fraction *share of the segment
 * from point *from. Returns parts, of which the number of vertices must be a multiple. */
size_t front_loop_start (size_t n, const double *x, size_t *from, double *share);

/* ---- crack_surfaces_line.c ----------------------------------------------------------------------------- */
/* Unit tangent at vertex i of a front. */
void front_tangent (const pg_front *f, size_t i, double *tangent);
/* Makes ahead and normal orthogonal to the tangent and to each other. */
void front_frames (pg_front *f);
/* Redistributes vertices about a spacing apart, and with them *c, the positions up to which the crack cuts (n
 * x 3, m). */
pg_status front_resample (pg_front *f, const pg_ground *p, double **c);

/* In spacings: distance by which a crack cuts beyond another one that it meets; distance within which
 * vertices of a front that was met by another end; largest advance of the last vertices of a ligament. */
static const double surface_flap = 0.1, surface_met = 0.75, surface_run_out = 4;

/* One step of a front. */
typedef struct {
    pg_crack_surfaces *w;
    const pg_ground *p;
    size_t number;                                     /* index of the front in w */
    pg_front old, now;                                 /* the front before and after the step */
    double *c, *bend, *way;  /* new edge of the cutting part; bend, m; direction of motion (n x 3) */
    double *moved;                                     /* distance moved by each vertex, m */
    unsigned char *shut;                               /* 1: the vertex is closed in this step */
    size_t nshut;
    size_t *line, nline, line_capacity;                /* new edge of the surface, as vertices of w */
    double *side; size_t side_capacity;                /* crack normal at each vertex of the line */
} stride;

/* ---- crack_surfaces_move.c ----------------------------------------------------------------------------- */
/* Moves the vertices (d, theta NULL: none moves), closes those that meet something, and sets the edge of the
 * cutting part. */
pg_status stride_move (stride *s, const double *d, const double *theta);
/* Closes vertex i at its position; meets: PG_MEETS_.... */
void stride_shut (stride *s, size_t i, unsigned char meets);
int  stride_is_end (const stride *s, size_t i);
/* Local spacing at the new position of vertex i, m. */
double stride_spacing (const stride *s, size_t i);

/* ---- crack_surfaces.c ---------------------------------------------------------------------------------- */
/* Adds a position to the new line, reusing an existing vertex of the surface there. */
pg_status stride_to_line    (stride *s, const double *x, const double *normal);
/* Extends the line beyond the end of a front on the surface, in the direction from its neighbour. */
pg_status stride_beyond_end (stride *s, unsigned char meets, const double *end, const double *beside,
                             const double *normal);
/* Adds the positions c behind the vertices of a front to the line; they become its rim. shared: 1: its first
 * vertex is already the last of the line. starts, stops: 1: extended beyond that end. */
pg_status stride_lay        (stride *s, pg_front *f, const double *c, int shared, int starts, int stops);
/* Distance behind a front at x within which no bonds are cut, m. */
double front_offset_at (const pg_ground *p, const double *x);
long   surfaces_next_id (const pg_crack_surfaces *w);
/* Length of a front, m. */
double front_length (const pg_front *f);
#endif
