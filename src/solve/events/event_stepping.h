/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: event stepping, from one break to the next: proportional loads (event_stepping.c) and loads that
 * are a constant part and the load factor times another (event_stepping_affine.c). */
#ifndef PG_EVENT_STEPPING_H
#define PG_EVENT_STEPPING_H
#include "event_solver.h"
#include "instability.h"

typedef struct {                                       /* state of `static` with stepping: event */
    double   *unit;                                    /* displacement at load factor 1 (ndof) */
    double   *base;  /* affine loads: displacement at load factor 0 (ndof); else NULL */
    long      constant_events;  /* affine loads: events at an unchanged load factor */
    int       driven;  /* 1: the event of this step is one of these */
    int       arrested;                                /* 1: nothing grows any more after this event */
    int       bears;  /* 1: the state at the start of this step is in equilibrium with its load */
    double    unit_residual;                           /* residual of `unit` (and `base`) */
    event_solver *engine;  /* exact equilibria after breaks without a new factor; NULL: not used */
    double    engine_residual;                         /* residual of the base of `engine` */
    int       lost;  /* a step was refused: `unit` and `base` are first guesses only */
    pg_status ended;                                   /* no step can follow: the next one fails with this */
    char      why[1024];                               /* message of the failure `ended` */
    int       balance_fresh;                           /* 1: work_balance is that of `unit` */
    double    secant0;                                 /* first work per squared load factor, J */
    double    secant, top_factor;  /* work per squared load factor over secant0; largest load factor */
    instability unstable;                              /* instabilities (growth without increase of load) */
    struct event_ahead *ahead;                         /* events found ahead together; NULL: never */
} event_stepping;
static inline event_stepping *events_of (const pg_solver *s) { return s->own; }

pg_status event_start (pg_solver *s, const pg_state *state);
pg_status event_step  (pg_solver *s, pg_state *state, pg_step *step);
void      event_free  (pg_solver *s);
void      event_refused (pg_solver *s);
pg_status event_keep  (pg_solver *s, const pg_keeper *k);
pg_status event_moved (pg_solver *s, pg_state *state, const pg_moved *moved);
void      event_ends  (const pg_solver *s, const pg_state *state, pg_progress *out);

/* Finds the equilibria for the intact bonds: at load factor 1, for affine loads also at 0. */
pg_status event_solve  (pg_solver *s);
/* Work per squared load factor of the loads that grow with it: a stiffness under displacements, a compliance
 * under forces. Called after break_loop_account of the present equilibria. */
pg_status event_secant (pg_solver *s, double *out);

/* Looking ahead (event_ahead.c). ahead_look: finds the next events together, if it can, below this level.
 * ahead_waits 1: some are waiting. ahead_kill: breaks the bonds of the first. ahead_take: the equilibrium
 * after it becomes that of `unit`. */
pg_status ahead_look   (pg_solver *s, pg_state *state, double level);
int       ahead_waits  (const struct event_ahead *q);
/* load factor of the first one that waits */
double    ahead_factor (const struct event_ahead *q, double *top);
pg_status ahead_kill   (pg_solver *s, pg_state *state);
pg_status ahead_take   (pg_solver *s);
void      ahead_forget (struct event_ahead *q);        /* drops waiting events: bonds broke otherwise */
void      ahead_refused (struct event_ahead *q);  /* called if a step is refused: no event waits any more */
void      ahead_tell   (pg_solver *s);                 /* reports at the end of the run */
pg_status ahead_keep   (pg_solver *s, const pg_keeper *k);
void      ahead_free   (struct event_ahead **q);

/* Finds the work up to the state at this load factor, whose displacement is that of event_displacement, and
 * its stored energy. Proportional loads: the balance of load factor 1, made once for the intact bonds, times
 * the factor; energies are quadratic in it. rest 1: an equilibrium, for which the force need not be
 * evaluated. */
pg_status event_account (pg_solver *s, const pg_state *state, double factor, int rest);

/* Affine loads: finds the target load factor of this step. *breaks 1: something breaks there; *stops 1: the
 * stage ends, as the state after the last event meets a condition, or a gauge on the way. arrived 1: this
 * step has already come up to the present state. */
pg_status affine_aim   (pg_solver *s, pg_state *state, double level, int arrived, double *factor, int *breaks,
                        int *stops);
/* *stops 1: a state from which nothing grows at an unchanged load meets a condition of its stage. */
pg_status affine_meets (pg_solver *s, const pg_state *state, const double *reaction, int *stops);
/* *end: load factor at which the next crack increment (facet) grows, at most that of full load. */
pg_status affine_next_growth (pg_solver *s, pg_state *state, double *end);
/* Called when a new crack has formed, with contact: the state becomes the equilibrium at the load of the
 * event. */
pg_status affine_stay (pg_solver *s, pg_state *state);
/* With contact: accounts the path of a facet from before it to where the next one grows, at which
 * affine_next_growth has left the contact forces, and back through all changes of status to the state after
 * it. */
pg_status affine_account (pg_solver *s, pg_state *state, double end);

/* break: facet: measures the tips at the present equilibria. event_next_growth, proportional loads: the load
 * factor of the next growth (INFINITY: none). */
pg_status event_measure (pg_solver *s, const pg_state *state);
pg_status event_next_growth (pg_solver *s, const pg_state *state, double *next);
/* d = displacement at a load factor */
void      event_displacement (const pg_solver *s, double factor, double *d);
/* Sets unit and base, before equilibria are solved anew, from the state. */
void      event_equilibrium_lost (pg_solver *s, const pg_state *state);
/* Finds displacement, work balance and reactions of the static state at this factor again; may end the
 * run. */
pg_status event_rest   (pg_solver *s, pg_state *state, double factor);
/* Records the outcome of the equilibrium after an event; returns 1 where there is none, and the next step
 * reports why. */
int       event_ended  (pg_solver *s, const pg_state *state, double factor, pg_status now);
/* Ends the run when the crack has arrived at stop.set, or the body has come apart. */
pg_status event_stops  (pg_solver *s, const pg_state *state, double factor, double secant);
/* Called after event_stops: energies of a body that has come apart under forces and has no unique
 * equilibrium. Work and stored energy are those before the event; the stored energy counts as dissipated. cut
 * 1: the solve has found no equilibrium, and the body is cut in two. Returns 1 if it has come apart. */
int       event_apart  (pg_solver *s, int cut, double work, double strain, pg_step *step);
/* ends the run at solver.max_events */
void      event_limit  (pg_solver *s, const pg_state *state, double factor);
#endif
