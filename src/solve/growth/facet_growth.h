/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cracks that grow by facets (solver.break: facet): tips are judged by their energy release rate;
 * those that reach the fracture energy of the material move on by one facet (a straight piece of new crack),
 * and all bonds that the facet crosses break at once. */
#ifndef PG_FACET_GROWTH_H
#define PG_FACET_GROWTH_H
#include "perigal/fracture.h"
#include "solve/run/solve.h"

/* A facet that may form at some load and that no field around a tip can judge (trial_facet.c): the first of a
 * new crack, or the next of a tip without room for a ring around it. Its numbers are those of the
 * displacement sum_a l_a d_a of the fields at hand (facet_factors). */
typedef struct {
    long   tip;                                        /* the tip that it extends; -1: a new crack */
    /* of a new crack: bit 0: it has a tip at `from`, bit 1: at `to` */
    int    open;
    int    close;                                      /* of a tip: 1: it ends in the surface or a crack */
    int    slides;  /* 1: it takes the energy of sliding; of a new crack: its faces touch */
    double from[3], to[3];                             /* ends, m; of a tip's next facet only `to` */
    /* 3D, new crack: a disc about `from` with the unit normal `to`; one unit vector in its plane */
    double radius, across[3];
    double energy;  /* energy that it takes: energy per area times area, J */
    /* energy that it releases: sum_ab l_a l_b release[a][b], J */
    double release[2][2];
    /* least normal stress on it over the strength: sum_a l_a stress[a]; NAN: does not count */
    double stress[2];
} facet_candidate;

/* A facet that opens gradually in dynamics: forces that its cut bonds still carry, N, all of them when the
 * tip has moved by 0 since the cut, none when it has moved by `length`. */
typedef struct {
    long    tip;                                       /* the tip whose path length counts */
    /* 1: the bonds that it cut are near no other tip, so that the energy dissipated is this tip's */
    int     alone;
    double  way, length;  /* path of the tip since the cut; path over which it opens, m */
    double  energy;                                    /* energy that it takes in all, J */
    /* When last accounted for: path of the tip, m; forces times displacements, J; energy released by the cut
     * that is not counted yet, J. */
    double  way0, product, drop;
    size_t  n;  long *unknown;  double *force;         /* unknowns that the forces act on, ascending (n) */
} facet_hold;
/* A crack tip in dynamics. */
typedef struct {
    double speed;                                      /* speed of the tip, m/s */
    double g, mean, steady;  /* g = 1 - v / c_R; its means over a recent and over a longer time */
    double way, length;  /* path along the last facet; length of that, 0: it has none, m */
    double least;                                      /* lower bound of its speed along that facet, m/s */
    /* path from the start of its facet along which a new branch runs straight on and is not judged, m */
    double straight;
    double come;                                       /* path since the tip was last judged, m */
    /* Energy that its facets dissipated of late, and what the rings predicted, J; both 0: none yet. */
    double taken, shown;
} facet_run;
/* State to which a refused step returns. */
typedef struct {
    double needed, since;
    facet_run  *run; size_t nrun, cap_run;
    facet_hold *hold; size_t nhold, cap_hold;
} facet_start;

/* Outcome of the present growth event. */
typedef struct {
    /* closed: a tip met the surface or a crack; began: a new crack formed; going: a tip goes on; tried: a
     * trial facet of a tip is one of its facets; energy: what all its facets take, J. */
    int     closed, began, going, tried;
    double  energy;
    /* First tip that grew and goes on, -1: none; length that it grew, m. */
    long    tip;
    double  length;
} facet_event_marks;
/* Facets in dynamics. */
typedef struct {
    /* run: motion of every tip; hold: facets that open; held: sum of the forces that they hold, N (ndof);
     * force_before: forces before a cut, N (ndof). */
    int     moving;
    long    unjudged;  /* tips that could not be judged at the last measurement */
    facet_run  *run; size_t nrun, cap_run;
    facet_hold *hold; size_t nhold, cap_hold;
    double *held, *force_before;
    double  since, top;  /* time since tips were last judged, s; largest sqrt (G (v) / G0) then */
    facet_start start;
} facet_motion_state;
typedef struct facet_growth {
    double  length;                                    /* length of a facet, m; 0: the local spacing */
    pg_nearest *near;                                  /* nodes by position, for the material at a point */
    /* Last measurement, valid if `fresh`: nfield 1: load factor times one field; 2: a constant field and load
     * factor times another. */
    int     fresh, nfield;
    double *ramp;                                      /* the second displacement field (ndof) */
    double *before;                                    /* displacement before the event at hand (ndof) */
    /* of every tip of the state, or of the vertices of its open fronts, front by front; near NAN: not judged,
     * as it is closed or has no room for a ring */
    pg_tip_field *field; size_t ntip, cap_field;
    facet_candidate *trial; size_t ntrial, cap_trial;
    struct trials *trials;                             /* workspace of trial_facet.c */
    struct front_growth *fronts;                       /* 3D: front_growth.c; else NULL */
    /* energy that all facets took so far; at the start of the step, J */
    double  needed, needed0;
    facet_event_marks event;                           /* outcome of the present event */
    facet_motion_state motion;
    unsigned said;                                     /* warnings given so far: FACET_SAID_... */
} facet_growth;
enum {
    FACET_SAID_CLOSED = 1, FACET_SAID_ROOM = 2, FACET_SAID_NOTHING = 4, FACET_SAID_INTERFACE = 8,
    FACET_SAID_BEGINS = 16, FACET_SAID_UNKNOWN = 32, FACET_SAID_KINKED = 64, FACET_SAID_ENERGY = 128,
    FACET_SAID_CUT = 256, FACET_SAID_BESIDE = 512, FACET_SAID_ALL = 1023
};

/* Tips whose utilisation is within this share of the largest grow together: keeps symmetric scenes
 * symmetric. */
static const double facet_tie = 1e-3;

/* ---- facet_growth.c ------------------------------------------------------------------------------------ */
/* Allocates growth by facets where the criterion judges tips, as a client of the break loop. */
pg_status facet_create  (break_loop *b, const growth_client *client);
void      facet_free    (break_loop *b);
pg_status facet_round   (break_loop *b, pg_state *state, double t, const double *d, const dynamics *dyn,
                         pg_step *step, int *again);
pg_status facet_keep    (break_loop *b, const pg_keeper *keeper);
pg_status facet_keep_measured (break_loop *b, const pg_state *state, const pg_keeper *keeper);
/* Measures all open tips and asks for trial facets. base NULL: one field `unit`, with the loads of t; else
 * the fields base (loads of t - 1) and unit - base, and load factors count from t - 1. */
pg_status facet_measure (break_loop *b, const pg_state *state, const double *base, const double *unit,
                         double t);
/* Allocates the fields of all tips or vertices, with nothing known. */
pg_status facet_lay_out (break_loop *b, const pg_state *state);
/* Where faces may touch: corrects the energy of a field by its K, as a large stress along the crack falsifies
 * the energy of a field that is not exact. */
void      facet_settle_energy (pg_tip_field *f, int nfield);
/* Largest utilisation of all facets at a load factor, by the last measurement; from 1 on a facet grows. */
double    facet_utilisation (const break_loop *b, const pg_state *state, double factor);
/* Grows the facets within the tie of the largest utilisation at that factor, at least one; b->changes: the
 * bonds that broke, logged at t. The measurement is not valid afterwards. */
pg_status facet_grow    (break_loop *b, pg_state *state, double factor, double t);
/* Grows one given facet. */
pg_status facet_grow_one (break_loop *b, pg_state *state, const facet_candidate *c, double t);
/* Extends tips that have grown and have no room left for a ring straight to the surface; *grew 1: there were
 * some. */
pg_status facet_run_out (break_loop *b, pg_state *state, double t, int *grew);
/* Stores tip values at the load factor of a step for results (1 after a round at a fixed load). */
pg_status facet_show    (pg_solver *s, const pg_state *state, double factor);

/* ---- facet_events.c: what the break loop and event stepping have of it --------------------------------- */
extern const growth_client facet_client;

/* ---- facet_ends.c -------------------------------------------------------------------------------------- */
/* Number of open tips that cannot be judged at a load factor, by the last measurement; 1 where none is open
 * and none can begin. */
long      facet_unjudged (const break_loop *b, const pg_state *state, double factor);
/* Warns once of every tip that has grown and that cannot be judged any more. */
void      facet_tell_lost (break_loop *b, const pg_state *state);
/* 1: the run ends after an event at this load: some tip cannot be judged, and nothing else grows up to full
 * load. */
int       facet_measure_ends (pg_solver *s, const pg_state *state, double factor);
void      facet_note_end    (pg_statistics *report);   /* warns of that end of the run */

/* ---- facet_energy.c ------------------------------------------------------------------------------------ */
/* After a step that ended at t: warns once where facets in dynamics have not taken .9 to 1.1 of the fracture
 * energy. */
void      facet_doubt_energy (pg_solver *s, const pg_state *state, double t);
/* Warns once if the energy freed by the cut of a facet, J, differs much from the energy that the facet
 * takes. */
void      facet_doubt_cut (break_loop *b, const facet_candidate *c, double t, double freed);

/* ---- facet_motion.c ------------------------------------------------------------------------------------ */
/* Warns where a time step is too long for facets. */
void      facet_doubt_step (break_loop *b, double dt);
/* Begins a time step: tips move on for dt (s; INFINITY: to the end of their facets), and these open
 * accordingly. */
void      facet_forward (break_loop *b, double dt);
/* Ends a time step: adds dt (s) to the time since tips were last judged; returns 1 when they are to be
 * judged. */
int       facet_due     (break_loop *b, double dt);
/* Judges the tips at the displacement d: new speeds, and facets for tips at the end of theirs. *top: the
 * largest sqrt (G (v) / G0). *any 1: something was cut, which changes the stored energy but no force. */
pg_status facet_move    (break_loop *b, pg_state *state, double t, const double *d, double *top, int *any);
void      facet_rest    (break_loop *b);               /* ends the motion: no forces are held any more */
/* Begins a motion with the facet of a static event at load t, before which d was the equilibrium
 * (facet_hold_before was called for it): the facet opens like all that follow. */
pg_status facet_set_off (break_loop *b, const pg_state *state, double t, const double *d);
/* facet_save: at the start of a step; facet_return: where it is refused. */
pg_status facet_save    (break_loop *b);
void      facet_return  (break_loop *b);
pg_status facet_motion_keep (break_loop *b, const pg_keeper *keeper);

/* Energy that tip i takes over what its rings predict; 1: it does not move, or nothing is known yet. */
double    facet_trust     (const facet_growth *g, size_t i);
double    facet_zone      (const break_loop *b);  /* path of a tip in which a facet opens, in facets */
pg_status facet_make_room (facet_growth *g, size_t ntip);              /* allocates data of so many tips */

/* ---- facet_branch.c ------------------------------------------------------------------------------------ */
/* 1: tip i, at the end of its facet, has the energy for two branches. */
int       facet_branches (const break_loop *b, const pg_state *state, size_t i);
/* Ends the tip and begins two (facet_hold_before was called). *done 0: the material allows no crack there. */
pg_status facet_fork    (break_loop *b, pg_state *state, size_t i, double t, const double *d, int *done);

/* ---- facet_contact.c ----------------------------------------------------------------------------------- */
/* Points along a facet that is cut, m, their normals, and the force on the left face there that contact goes
 * on transmitting, N (all 2 n). n = 0 without contact. */
typedef struct { size_t n; double *x, *normal, *force; } facet_faces;
void      facet_faces_clear  (facet_faces *faces);
/* Fills facet_faces from the stress at displacement d, before the cut. */
pg_status facet_faces_before (const break_loop *b, const pg_state *state, const double *d, const double *from,
                              const double *to, facet_faces *out);
/* nodal = forces that contact goes on transmitting, on the nodes, N (ndof); after the cut, caches of the
 * force being fresh. */
pg_status facet_faces_bear   (const break_loop *b, const pg_state *state, const facet_faces *faces,
                              double *nodal);

/* ---- facet_hold.c -------------------------------------------------------------------------------------- */
/* facet_hold_before: stores the forces before a cut. facet_hold_begin, after it, caches of the force being
 * fresh: what has changed is held for the tip, with the length and energy of `what`, except the forces that
 * contact goes on transmitting (borne, N, ndof; NULL: none). The forces after it serve as those before the
 * next cut. */
pg_status facet_hold_before (break_loop *b, double t, const double *d);
pg_status facet_hold_begin  (break_loop *b, double t, const double *d, const facet_hold *what,
                             const double *borne);
/* Copies holds; what `to` had is freed. */
pg_status facet_hold_copy   (facet_hold **to, size_t *n, size_t *capacity, const facet_hold *from,
                             size_t count);
/* drops facets that are fully open; all 1: every one */
void      facet_hold_drop   (break_loop *b, int all);
/* taken: energy, J, that the facets of a tip have dissipated since last accounted for, at displacement d;
 * needed: what it should be by G0. */
void      facet_hold_account (break_loop *b, size_t tip, const double *d, double *taken, double *needed);
void      facet_hold_sum    (break_loop *b);
void      facet_hold_free   (facet_growth *g);
pg_status facet_hold_keep   (break_loop *b, const pg_keeper *keeper);

/* Coefficients l of the fields at a load factor; returns how many. */
static inline int facet_factors (const facet_growth *g, double factor, double l[2])
{
    l[0] = g->nfield == 2 ? 1 : factor, l[1] = factor;
    return g->nfield;
}

/* ---- facet_direction.c --------------------------------------------------------------------------------- */
/* Square root of the energy that tip i releases over what the material takes, at a load factor, in the best
 * direction (angle, rad from x), or along the imposed path; 0: it does not grow. slides 1: the facet slides,
 * and takes the energy of sliding. Outputs may be NULL. */
double facet_judge (const break_loop *b, const pg_state *state, size_t tip, double factor, double *angle,
                    int *slides);
/* Length of the next facet of a tip, m. */
double facet_length (const facet_growth *g, const pg_tip_field *field);
/* Fracture limits of a crack at x in a direction; 0: it cannot grow there (failure: never, exclude). */
int    facet_limits (const break_loop *b, const double *x, double angle, pg_fracture_limits *out);
/* Follows failure.path for `length` from its point nearest to x, in the sense of e: to is the end; *ends 1:
 * it is the end of the path; returns the distance of x from the path, m. */
double facet_on_path (const double *path, size_t n, const double *x, const double *e, double length,
                      double *to, int *ends);

/* ---- facet_place.c ------------------------------------------------------------------------------------- */
/* Finds the end of a tip's next facet in that direction: after its length, or straight on in the surface or
 * another crack that is near; fills tip, to, close, slides and energy. */
void facet_place (const break_loop *b, const pg_state *state, size_t tip, double angle, int slides,
                  facet_candidate *out);
/* Shortest facet to the surface or a crack for a tip without room for a ring; 0: none is near. */
int  facet_way_out (const break_loop *b, const pg_state *state, size_t tip, facet_candidate *out);

/* ---- trial_facet.c ------------------------------------------------------------------------------------- */
/* Offers facets that no field around a tip can judge, for the present displacement fields (g->nfield of them,
 * ndof each). Called after the tips have been measured: g->field[i].near is NAN where tip i has no room. */
pg_status trial_facets (break_loop *b, const pg_state *state, const double *const *d, const double *t);
/* x: a point where the displacement d at t reaches the strength, away from tips and cracks, m (3); *any 1:
 * there is one. */
pg_status trial_hot_place (break_loop *b, const pg_state *state, const double *d, double t, double *x,
                           int *any);
pg_status facet_offer  (facet_growth *g, const facet_candidate *c);  /* adds c to g->trial */
/* Square root of the energy released over that taken, of a new crack at most its stress over strength. */
double    facet_trial_utilisation (const facet_growth *g, const facet_candidate *c, double factor);
#endif
