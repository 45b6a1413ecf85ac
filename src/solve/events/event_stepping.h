/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: event stepping, from one break to the next: proportional loads (event_stepping.c) and loads that
 * are a constant part and the load factor times another (event_stepping_affine.c). */
#ifndef PG_EVENT_STEPPING_H
#define PG_EVENT_STEPPING_H
#include "event_solver.h"
#include "instability.h"

typedef struct {                                       /* state of `static` with stepping: event */
    double   *unit;                                    /* displacement at load factor 1 (ndof) */
    double   *base;                                    /* affine loads: at load factor 0 (ndof); else NULL */
    long      constant_events;  /* affine loads: events at a held load factor */
    int       driven;  /* 1: the event of this step is one of them */
    int       arrested;                                /* 1: after the event at hand nothing grows any more */
    int       bears;  /* 1: the state at the start of this step bears its load */
    double    unit_residual;                           /* of `unit` (and `base`) */
    event_solver *engine;  /* exact equilibria after breaks without a new factor; NULL: not used */
    double    engine_residual;                         /* of the base of the engine */
    int       lost;  /* a step was refused: `unit` and `base` are first guesses only */
    pg_status ended;                                   /* no step can follow: the next one fails with this */
    char      why[1024];                               /* message of that failure */
    int       balance_fresh;                           /* the work balance at hand is that of `unit` */
    double    secant0;                                 /* first work per squared load factor, J */
    double    secant, top_factor;  /* work per squared load factor over secant0; largest load factor */
    instability unstable;                              /* where growth goes on by itself */
    struct event_ahead *ahead;                         /* events that were found together; NULL: never */
} event_stepping;
static inline event_stepping *events_of (const pg_solver *s) { return s->own; }

pg_status event_start (pg_solver *s, const pg_state *state);
pg_status event_step  (pg_solver *s, pg_state *state, pg_step *step);
void      event_free  (pg_solver *s);
void      event_refused (pg_solver *s);
pg_status event_keep  (pg_solver *s, const pg_keeper *k);
pg_status event_moved (pg_solver *s, pg_state *state, const pg_moved *moved);
void      event_ends  (const pg_solver *s, const pg_state *state, pg_progress *out);

/* The equilibria for the bonds that live now: at load factor 1, of affine loads also at 0. */
pg_status event_solve  (pg_solver *s);
/* Work per squared load factor, of what grows with it: a stiffness under displacements, a compliance under
 * forces. After break_loop_account of the equilibria at hand. */
pg_status event_secant (pg_solver *s, double *out);

/* Looking ahead (event_ahead.c): finds the next events together, if it can, below this level; 1: some are
 * waiting; the bonds of the first of them die; the equilibrium after it becomes that of `unit`. */
pg_status ahead_look   (pg_solver *s, pg_state *state, double level);
int       ahead_waits  (const struct event_ahead *q);
double    ahead_factor (const struct event_ahead *q, double *top);  /* load factor of the first that waits */
pg_status ahead_kill   (pg_solver *s, pg_state *state);
pg_status ahead_take   (pg_solver *s);
void      ahead_forget (struct event_ahead *q);        /* bonds broke otherwise */
void      ahead_refused (struct event_ahead *q);       /* a step: nothing waits any more */
void      ahead_tell   (pg_solver *s);                 /* for the report, once at the end */
pg_status ahead_keep   (pg_solver *s, const pg_keeper *k);
void      ahead_free   (struct event_ahead **q);

/* Work up to the state at this load factor, whose displacement is that of event_displacement, and its stored
 * energy. Proportional loads: the balance of load factor 1, made once for the bonds that live (rest: by what
 * spares an equilibrium its evaluation), times the factor; energies are quadratic in it. */
pg_status event_account (pg_solver *s, const pg_state *state, double factor, int rest);

/* Affine loads: where this step goes, *breaks: to break something there; *stops: to end the stage, since a
 * condition is met by what the last event has left behind, or by a gauge on the way. arrived: this step has
 * come up to where the state is. */
pg_status affine_aim   (pg_solver *s, pg_state *state, double level, int arrived, double *factor, int *breaks,
                        int *stops);
/* *stops: a state from which nothing goes on at a held load meets a condition of its stage. */
pg_status affine_meets (pg_solver *s, const pg_state *state, const double *reaction, int *stops);
/* *end: load factor at which the next crack increment (facet) grows, at most that of full load. */
pg_status affine_next_growth (pg_solver *s, pg_state *state, double *end);
/* A new crack is there with contact: the state is the equilibrium at the load of the event. */
pg_status affine_stay (pg_solver *s, pg_state *state);
/* With contact: accounts the way of a facet from before it to where the next one grows, at which
 * affine_next_growth has left the forces of contact, and back through all changes of status to the state
 * after it. */
pg_status affine_account (pg_solver *s, pg_state *state, double end);

/* break: facet: the measurement of tips is that of the equilibria at hand; proportional loads: the load
 * factor of the next growth (INFINITY: none). */
pg_status event_measure (pg_solver *s, const pg_state *state);
pg_status event_next_growth (pg_solver *s, const pg_state *state, double *next);
void      event_displacement (const pg_solver *s, double factor, double *d);         /* at a load factor */
/* What stands for the equilibria before they are solved anew: what the state is. */
void      event_equilibrium_lost (pg_solver *s, const pg_state *state);
/* At rest at this factor, once more: displacement, work balance, reactions; may end the run. */
pg_status event_rest   (pg_solver *s, pg_state *state, double factor);
/* What the equilibrium after an event came to: 1: there is none, and the next step says why. */
int       event_ended  (pg_solver *s, const pg_state *state, double factor, pg_status now);
/* Ends the run when the crack has arrived at stop.set, or the body has separated. */
pg_status event_stops  (pg_solver *s, const pg_state *state, double factor, double secant);
/* After event_stops: energies of a body that has come apart under forces, whose equilibria lie anywhere. Work
 * and stored energy are those of before the event; what was stored is taken as consumed. cut: the solve has
 * found no equilibrium, and the body is cut in two. 1: it has come apart. */
int       event_apart  (pg_solver *s, int cut, double work, double strain, pg_step *step);
void      event_limit  (pg_solver *s, const pg_state *state, double factor);           /* solver.max_events */
#endif
