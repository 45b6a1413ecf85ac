/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cracks that grow by facets (solver.break: facet): tips are judged by their energy release
 * rate, those that reach what the material takes move by one facet, and all bonds that the facet crosses
 * die at once. */
#ifndef PG_FACET_GROWTH_H
#define PG_FACET_GROWTH_H
#include "perigal/fracture.h"
#include "solve.h"

/* A facet that comes into being at some load and that no field around a tip can judge (trial_facet.c):
 * the first of a new crack, or the next of a tip without room for a ring. Its numbers are those of the
 * displacement sum_a l_a d_a of the fields at hand (facet_factors). */
typedef struct {
    long   tip;                                        /* the tip that it moves; -1: it begins a new crack */
    double from[3], to[3];                             /* m; `from` of a new crack alone */
    /* of a new crack: bit 0: a tip at `from`, bit 1: at `to` */
    int    open;
    int    close;                                      /* of a tip: it ends here, in the surface or a crack */
    double energy;                                     /* what it takes: energy per area times its area, J */
    /* what it sets free: sum_ab l_a l_b release[a][b], J */
    double release[2][2];
    double stress[2];  /* least stress across it over the strength: sum_a l_a stress[a]; NAN: no matter */
} facet_candidate;

typedef struct facet_growth {
    double  length;                                    /* of a facet, m; 0: the local spacing */
    pg_nearest *near;                                  /* nodes, for the material at a place */
    /* The last measurement, if `fresh`: fields (1: load factor times one; 2: a constant part and load factor
     * times another), what every tip shows, what trial facets offer. */
    int     fresh, nfield;
    double *ramp;                                      /* the second field (ndof) */
    double *before;                                    /* displacement before the event at hand (ndof) */
    /* of every tip of the state; near NAN: closed, no room */
    pg_tip_field *field; size_t ntip, cap_field;
    facet_candidate *trial; size_t ntrial, cap_trial;
    struct trials *trials;                             /* workspace of trial_facet.c */
    /* energy that all facets took; at the start of the step, J */
    double  needed, needed0;
    /* Of the event at hand: a tip met the surface or a crack; a new crack came into being; a tip goes on;
     * what all facets take, J. */
    int     closed, began, going;
    double  event_energy;
    /* In motion: the way that every tip has come towards its next facet, m. */
    int     moving;
    double *way; size_t nway, cap_way;
    unsigned said;                                     /* warnings that were given: FACET_SAID_... */
} facet_growth;
enum { FACET_SAID_CLOSED = 1, FACET_SAID_ROOM = 2, FACET_SAID_NOTHING = 4 };

/* Tips whose utilisation is within this share of the largest grow together: keeps symmetric scenes
 * symmetric. */
static const double facet_tie = 1e-3;

/* ---- facet_growth.c ------------------------------------------------------------------------------------ */
pg_status facet_create  (break_loop *b);               /* where the criterion judges tips, else nothing */
void      facet_free    (break_loop *b);
pg_status facet_keep    (break_loop *b, const pg_keeper *keeper);
/* Measures all open tips, and asks for trial facets. base NULL: the one field `unit`, with the loads of t;
 * else the fields base (loads of 0) and unit - base. */
pg_status facet_measure (break_loop *b, const pg_state *state, const double *base, const double *unit,
                         double t);
/* The largest of all facets at a load factor, by the last measurement: 1: one grows there. */
double    facet_utilisation (const break_loop *b, const pg_state *state, double factor);
/* Grows what is within the tie of the largest at that factor, at least one facet; b->changes are the bonds
 * that died, logged at t. The measurement is spent. */
pg_status facet_grow    (break_loop *b, pg_state *state, double factor, double t);
/* Tips that have grown and lost their room go straight out, at once: *grew. */
pg_status facet_run_out (break_loop *b, pg_state *state, double t, int *grew);
/* The tips at the load factor of a step, for results (1 after facet_round). */
pg_status facet_show    (pg_solver *s, const pg_state *state, double factor);
/* One round at a fixed load, the displacement d being in equilibrium (dyn: with inertia): *over: something
 * grew, and the caches of the force are fresh. */
pg_status facet_round   (break_loop *b, pg_state *state, double t, const double *d, const dynamics *dyn,
                         pg_step *step, int *over);

/* ---- facet_motion.c ------------------------------------------------------------------------------------ */
/* Tips run for dt (s; INFINITY: what is over its limit comes at once); *any: one has come as far as its next
 * facet. */
pg_status facet_run     (break_loop *b, const pg_state *state, double dt, int *any);
int       facet_has_come (const facet_growth *g, size_t tip);
void      facet_rest    (facet_growth *g);             /* the motion begins, or is over */

/* Coefficients l of the fields at a load factor; returns how many. */
static inline int facet_factors (const facet_growth *g, double factor, double l[2])
{
    l[0] = g->nfield == 2 ? 1 : factor, l[1] = factor;
    return g->nfield;
}

/* ---- facet_direction.c --------------------------------------------------------------------------------- */
/* Square root of the energy that tip i sets free over what the material takes, at a load factor, in the best
 * direction (rad from the x axis), or along the imposed path. 0: it does not grow. */
double facet_judge (const break_loop *b, const pg_state *state, size_t tip, double factor, double *angle);
/* Length of the next facet of a tip, m. */
double facet_length (const facet_growth *g, const pg_tip_field *field);
/* What a crack takes at x in a direction; 0: it cannot grow there (failure: never, exclude). */
int    facet_limits (const break_loop *b, const double *x, double angle, pg_fracture_limits *out);
/* Where a walk of `length` along failure.path from the place of it nearest to x ends, in the sense of e;
 * *ends: it is the end of the path; returns the distance of x from the path, m. */
double facet_on_path (const double *path, size_t n, const double *x, const double *e, double length,
                      double *to, int *ends);

/* ---- facet_place.c ------------------------------------------------------------------------------------- */
/* Where the facet of a tip in that direction ends: after its length, or straight on in the surface or another
 * crack that is near; fills tip, to, close and energy. */
void facet_place (const break_loop *b, const pg_state *state, size_t tip, double angle, facet_candidate *out);
/* The shortest way out for a tip without room for a ring; 0: there is none near. */
int  facet_way_out (const break_loop *b, const pg_state *state, size_t tip, facet_candidate *out);

/* ---- trial_facet.c ------------------------------------------------------------------------------------- */
/* Offers facets that no field around a tip can judge, for the displacement fields at hand (g->nfield of them,
 * ndof each). Called after the tips have been measured: g->field[i].near is NAN where tip i has no room. */
pg_status trial_facets (break_loop *b, const pg_state *state, const double *const *d, const double *t);
pg_status facet_offer  (facet_growth *g, const facet_candidate *c);                    /* facet_growth.c */
#endif
