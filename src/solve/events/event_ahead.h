/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: looking ahead in event stepping. Where cracks grow from a tip, the next events happen near it. So
 * the next events of a run are found by looking at a *group* of bonds around the places that are near their
 * limit, with the displacements of the nodes that this group depends on alone; then all other bonds are
 * looked at for all of these events at once. If one of them would have broken, or tied, at event k, what was
 * found from k on is taken back, exactly, as shape functions depend on intact bonds alone; else the events
 * are handed to the caller one by one, each with its whole displacement, as if they had been found one by
 * one. Files: event_ahead.c (finding, checking, taking back), event_zone.c (the group). */
#ifndef PG_EVENT_AHEAD_H
#define PG_EVENT_AHEAD_H
#include "event_solver.h"

/* The group of bonds, and its inner part in which bonds may break: an event there changes the shape functions
 * of points in the group alone, so that the utilisation of other bonds follows from unchanged shape
 * functions. */
typedef struct {
    pg_bond_group  group;
    unsigned char *left_out;  /* 1: a bond of the group, left out elsewhere (nbond) */
    /* 1: bonds of this point may break (points of each set) */
    unsigned char *inner[PG_BOND_SETS];
    unsigned char *level;                              /* workspace: families away from the seeds (nodes) */
    int           *front;                              /* workspace (2 nodes) */
    int            known;                              /* 1: there is a group */
} event_zone;
/* Makes the group around bonds i with near[i] >= cut. *share: bonds of the group over all; above `most` no
 * group is made. */
pg_status event_zone_make  (event_zone *z, const pg_system *sys, const pg_state *state, const double *near,
                            double cut, double most, double *share);
/* Makes the group from the levels of the nodes, which a checkpoint keeps, after event_zone_room, which
 * allocates both. */
pg_status event_zone_fill  (event_zone *z, const pg_system *sys, double most, double *share);
pg_status event_zone_room  (event_zone *z, const pg_problem *p);
void      event_zone_clear (event_zone *z);
/* 1: bond k of the group may break. */
int       event_zone_inner (const event_zone *z, size_t k);

enum { AHEAD_MOST = 32 };                              /* most events of a block */
static const double ahead_most_of_body = 0.3;          /* most bonds of a group over all bonds */
/* An event that was found: load factor, largest utilisation there, and its bonds, n from `first` on in
 * `broken`. */
typedef struct { double factor, top; size_t first, n; } ahead_event;

typedef struct event_ahead {
    event_zone   zone;
    /* of the bonds of the group, at the present displacement */
    double      *utilisation, *factor;  char *kind;
    double      *d, *scaled, *some;                    /* ndof; known at the nodes of the group only */
    double      *block;                                /* displacements after each event, [unknown][event] */
    double       cold;  /* largest utilisation per load factor of all other bonds; < 0: not known */
    double       residual;                             /* residual of the last event that was found */
    /* events found, of which `at` were handed out; stride: events that the block was made for */
    ahead_event  event[AHEAD_MOST];  size_t nevent, at, stride;
    pg_broken   *broken;  size_t nbroken, cap_broken;  /* bonds of all events, one after the other */
    pg_changes   undone;
    long         wait;                                 /* plain events before the next look ahead */
    int          due;                                  /* 1: a new base of the solver would pay */
    long         found, taken_back;  /* events found ahead, and taken back, for the report */
} event_ahead;
#endif
