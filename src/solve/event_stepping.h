/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: event stepping, from one break to the next: proportional loads (event_stepping.c) and loads that
 * are a constant part and the load factor times another (event_stepping_affine.c). */
#ifndef PG_EVENT_STEPPING_H
#define PG_EVENT_STEPPING_H
#include "solve.h"

typedef struct {                                       /* state of `static` with stepping: event */
    double   *unit;                                    /* displacement at load factor 1 (ndof) */
    double   *base;                                    /* affine loads: at load factor 0 (ndof); else NULL */
    long      constant_events;  /* affine loads: events at a held load factor */
    double    unit_residual;                           /* of `unit` (and `base`) */
    pg_status ended;                                   /* no step can follow: the next one fails with this */
    char      why[1024];                               /* and says why */
    int       balance_fresh;                           /* the work balance at hand is that of `unit` */
    double    secant0;                                 /* first work per squared load factor, J */
    double    secant, top_factor;                      /* that of now over the first; largest load factor */
} event_stepping;
static inline event_stepping *events_of (const pg_solver *s) { return s->own; }

pg_status event_start (pg_solver *s, const pg_state *state);
pg_status event_step  (pg_solver *s, pg_state *state, pg_step *step);
void      event_free  (pg_solver *s);
pg_status event_keep  (pg_solver *s, const pg_keeper *k);
void      event_ends  (const pg_solver *s, const pg_state *state, pg_progress *out);

/* Both equilibria of affine loads; one event or level of them. */
pg_status affine_solve (pg_solver *s);
pg_status affine_step  (pg_solver *s, pg_state *state, pg_step *step);
/* What the equilibrium after an event came to: 1: there is none, and the next step says why. */
int       event_ended  (pg_solver *s, const pg_state *state, double factor, pg_status now);
/* Ends the run when the crack has arrived at stop.set, or the body has separated. */
pg_status event_stops  (pg_solver *s, const pg_state *state, double factor, double secant);
void      event_limit  (pg_solver *s, const pg_state *state, double factor);           /* solver.max_events */
#endif
