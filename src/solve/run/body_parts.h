/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: connected parts of the body, the rigid motions of each that nothing resists, and the work of the
 * loads along these (body_parts.c). A part with such a motion has no equilibrium unless its loads balance
 * along it, whatever the solver: so one check serves all solvers. */
#ifndef PG_BODY_PARTS_H
#define PG_BODY_PARTS_H
#include "solve.h"

/* A rigid motion: three translations, then three rotations times the size of the part; unknowns move by about
 * 1. */
typedef double rigid_motion[6];
typedef struct {
    size_t points;                                     /* number of its points on all ranks */
    /* mean position of its points, m; distance of the farthest from it, m (a single point: the spacing) */
    double middle[3], size;
    int    line;                                       /* 1: its points lie on a line (3D) */
    double axis[3];                                    /* unit vector along that line */
    size_t n;                                          /* number of motions that nothing resists */
    rigid_motion motion[6];
} body_part;
typedef struct body_parts {
    size_t n;
    body_part *part;  /* in the order of their lowest points, equal on all ranks */
    int *of;                                           /* part of each point that is held here */
} body_parts;
/* Finds the parts as of the last refresh. All ranks call. Without pg_force_type.join there are none. */
pg_status body_parts_find  (body_parts *out, const pg_system *s);
void      body_parts_clear (body_parts *parts);
/* u: displacement, m, of the point at x by a rigid motion of its part, then its rotations times the spacing
 * where points have rotational unknowns (6). */
void      body_part_shift (const pg_system *s, const body_part *part, const double *x, const double *motion,
                           double *u);
/* Texts for messages: "500 of its 1000 points, around (x, y) m"; "along (0, 1)", "about z through (x, y)
 * m". */
enum { BODY_PART_WORDS = 160 };
void      body_part_place (const pg_problem *p, const body_part *part, char *text, size_t size);
void      body_part_way   (const pg_problem *p, const body_part *part, const double *motion, char *text,
                           size_t size);

/* Called before the first step. PG_E_EQUILIBRIUM, with part, free directions and unbalanced loads: the loads
 * of a part at t, with present contact forces, do not balance along a free motion. Warns of parts that are
 * free to move under loads that balance, and keeps them (pg_system.floating). */
pg_status body_parts_begin (pg_system *s, double t);
/* Moves the parts of pg_system.floating back so that their mean displacement and rotation are zero: of all
 * equilibria that differ by rigid motions the one that does not depend on the solver. */
pg_status body_parts_centre (pg_system *s, double *d);
/* Repeats the check of body_parts_begin for an accepted static state whose points have moved by more than the
 * length of the body; beyond 1e6 lengths it is always refused. loads 0: those at t are not known (scaled). */
pg_status body_parts_check (pg_system *s, double t, const double *d, int loads);
/* Called where a solve at t has found no equilibrium: names a part that is free to move, or adds to the
 * message what else may be the reason. */
pg_status body_parts_explain (pg_system *s, double t, pg_status failed);
#endif
