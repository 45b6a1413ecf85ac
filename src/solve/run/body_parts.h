/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the parts of the body that hang together, the rigid motions of each that nothing resists, and what
 * loads do along these (body_parts.c). A part with such a motion has no equilibrium unless its loads balance
 * each other along it, whatever solver is asked: so one judge serves all of them. */
#ifndef PG_BODY_PARTS_H
#define PG_BODY_PARTS_H
#include "solve.h"

/* A rigid motion: three translations, then three rotations times the size of the part; unknowns move by about
 * 1. */
typedef double rigid_motion[6];
typedef struct {
    size_t points;                                     /* of all ranks */
    double middle[3], size;  /* mean place of its points; of the farthest from it the distance, m; of a
                              * point alone the spacing */
    int    line;                                       /* its points stand in a line */
    double axis[3];                                    /* along it, unit */
    size_t n;                                          /* motions that supports and springs leave free */
    rigid_motion motion[6];
} body_part;
typedef struct body_parts {
    size_t n;
    body_part *part;                                   /* parts by their lowest points, alike on all ranks */
    int *of;                                           /* part of each point that is held here */
} body_parts;
/* At the last refresh. All ranks call. Of a force that does not tell what it joins there are none. */
pg_status body_parts_find  (body_parts *out, const pg_system *s);
void      body_parts_clear (body_parts *parts);
/* Displacement, m, of all unknowns of the point at x by a rigid motion of its part, with rotations of its own
 * (times the spacing, as micropolar forces have them). u: 6 */
void      body_part_shift (const pg_system *s, const body_part *part, const double *x, const double *motion,
                           double *u);
/* "500 of its 1000 points, around (x, y) m"; "along (0, 1)", "about z through (x, y) m". */
enum { BODY_PART_WORDS = 160 };
void      body_part_place (const pg_problem *p, const body_part *part, char *text, size_t size);
void      body_part_way   (const pg_problem *p, const body_part *part, const double *motion, char *text,
                           size_t size);

/* Before the first step: PG_E_EQUILIBRIUM with the part, its free directions and what its loads leave
 * unbalanced along them, if there is one whose loads at t, forces of contact at hand included, do not balance
 * each other; parts that are free to move under loads that balance are told of, and remembered
 * (pg_system.floating). */
pg_status body_parts_begin (pg_system *s, double t);
/* Parts that are remembered go back to where their mean displacement and rotation are none: of all equilibria
 * that differ by their motions the one that does not depend on what has solved for it. */
pg_status body_parts_centre (pg_system *s, double *d);
/* Of an accepted state at rest: the same where points have moved further than the body is long; 1e6 times as
 * far is refused whatever the reason. loads 0: those at t are not known, as when they are scaled. */
pg_status body_parts_check (pg_system *s, double t, const double *d, int loads);
/* A solve at t has failed for want of an equilibrium: names such a part, or adds to the message at hand what
 * else may be the reason. */
pg_status body_parts_explain (pg_system *s, double t, pg_status failed);
#endif
