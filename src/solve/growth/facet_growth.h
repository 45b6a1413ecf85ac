/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: cracks that grow by facets (solver.break: facet): tips are judged by their energy release
 * rate, those that reach what the material takes move by one facet, and all bonds that the facet crosses
 * die at once. */
#ifndef PG_FACET_GROWTH_H
#define PG_FACET_GROWTH_H
#include "perigal/fracture.h"
#include "solve/run/solve.h"

/* A facet that comes into being at some load and that no field around a tip can judge (trial_facet.c):
 * the first of a new crack, or the next of a tip without room for a ring. Its numbers are those of the
 * displacement sum_a l_a d_a of the fields at hand (facet_factors). */
typedef struct {
    long   tip;                                        /* the tip that it moves; -1: it begins a new crack */
    /* of a new crack: bit 0: a tip at `from`, bit 1: at `to` */
    int    open;
    int    close;                                      /* of a tip: it ends here, in the surface or a crack */
    int    slides;  /* 1: it takes the energy of sliding; a new crack: its faces touch */
    double from[3], to[3];                             /* m; `from` of a new crack alone */
    /* in space, of a new crack: a disc about `from` with the unit normal `to`, one unit vector in its plane
     * */
    double radius, across[3];
    double energy;                                     /* what it takes: energy per area times its area, J */
    /* what it sets free: sum_ab l_a l_b release[a][b], J */
    double release[2][2];
    double stress[2];  /* least stress across it over the strength: sum_a l_a stress[a]; NAN: no matter */
} facet_candidate;

/* A facet that opens while the body moves: forces that its bonds still carry, N, all of them at way 0 and
 * none at the end of its length. */
typedef struct {
    long    tip;                                       /* whose way counts */
    /* 1: bonds that it cut are those of no other tip, so that what it dissipates is its tip's. */
    int     alone;
    double  way, length;  /* way of the tip since it was cut; over which it opens, m */
    double  energy;                                    /* what it takes in all, J */
    /* When it was last accounted for: way of the tip, m; force times displacement, J; energy set free by its
     * cut that was not counted yet, J. */
    double  way0, product, drop;
    size_t  n;  long *unknown;  double *force;         /* where they act, ascending (n) */
} facet_hold;
/* A tip in motion. */
typedef struct {
    double speed;                                      /* m/s */
    double g, mean, steady;  /* 1 - v / c_R; its means over the last time, and over a longer one */
    double way, length;                                /* along its last facet; of that, 0: it has none, m */
    double least;                                      /* its speed along that is no less, m/s */
    /* So far a branch goes straight on and is not looked at, from the start of its facet, m. */
    double straight;
    double come;                                       /* its way since it was last looked at, m */
    /* What its facets dissipated of late, and what the rings said that they would, J; both 0: none yet. */
    double taken, shown;
} facet_run;
/* What a step that is refused goes back to. */
typedef struct {
    double needed, since;
    facet_run  *run; size_t nrun, cap_run;
    facet_hold *hold; size_t nhold, cap_hold;
} facet_start;

/* What the event at hand did. */
typedef struct {
    /* A tip met the surface or a crack; a new crack came into being; a tip goes on; a
     * trial facet of a tip is among it; what all facets take, J. */
    int     closed, began, going, tried;
    double  energy;
    /* The first tip that grew and goes on, -1: none; how far, m. */
    long    tip;
    double  length;
} facet_event_marks;
/* Facets of a body in motion. */
typedef struct {
    /* How every tip runs, the facets that open, the sum of what they hold, N (ndof), and the
     * forces before a cut, N (ndof). */
    int     moving;
    long    unjudged;  /* tips that the last measure could not judge */
    facet_run  *run; size_t nrun, cap_run;
    facet_hold *hold; size_t nhold, cap_hold;
    double *held, *force_before;
    double  since, top;  /* time since the tips were last looked at, s; largest sqrt (G (v) / G0) then */
    facet_start start;
} facet_motion_state;
typedef struct facet_growth {
    double  length;                                    /* of a facet, m; 0: the local spacing */
    pg_nearest *near;                                  /* nodes, for the material at a place */
    /* The last measurement, if `fresh`: fields (1: load factor times one; 2: a constant part and load factor
     * times another), what every tip shows, what trial facets offer. */
    int     fresh, nfield;
    double *ramp;                                      /* the second field (ndof) */
    double *before;                                    /* displacement before the event at hand (ndof) */
    /* of every tip of the state, or of the vertices of its open fronts, front by front; near NAN: closed, no
     * room */
    pg_tip_field *field; size_t ntip, cap_field;
    facet_candidate *trial; size_t ntrial, cap_trial;
    struct trials *trials;                             /* workspace of trial_facet.c */
    struct front_growth *fronts;                       /* in space, front_growth.c; else NULL */
    /* energy that all facets took; at the start of the step, J */
    double  needed, needed0;
    facet_event_marks event;                           /* of the event at hand */
    facet_motion_state motion;
    unsigned said;                                     /* warnings that were given: FACET_SAID_... */
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
/* Where the criterion judges tips: a client of the loop. */
pg_status facet_create  (break_loop *b, const growth_client *client);
void      facet_free    (break_loop *b);
pg_status facet_round   (break_loop *b, pg_state *state, double t, const double *d, const dynamics *dyn,
                         pg_step *step, int *again);
pg_status facet_keep    (break_loop *b, const pg_keeper *keeper);
pg_status facet_keep_measured (break_loop *b, const pg_state *state, const pg_keeper *keeper);
/* Measures all open tips, and asks for trial facets. base NULL: the one field `unit`, with the loads of t;
 * else the fields base (loads of t - 1) and unit - base, and load factors are counted from there. */
pg_status facet_measure (break_loop *b, const pg_state *state, const double *base, const double *unit,
                         double t);
/* Room for the fields of all tips or vertices, of which nothing is known. */
pg_status facet_lay_out (break_loop *b, const pg_state *state);
/* Where faces may touch: a large stress along the crack falsifies the energy of a field that is not exact,
 * and the magnitude of what is open comes from K. */
void      facet_settle_energy (pg_tip_field *f, int nfield);
/* The largest of all facets at a load factor, by the last measurement: 1: one grows there. */
double    facet_utilisation (const break_loop *b, const pg_state *state, double factor);
/* Grows what is within the tie of the largest at that factor, at least one facet; b->changes are the bonds
 * that died, logged at t. The measurement is spent. */
pg_status facet_grow    (break_loop *b, pg_state *state, double factor, double t);
/* Grows one given facet. */
pg_status facet_grow_one (break_loop *b, pg_state *state, const facet_candidate *c, double t);
/* Tips that have grown and lost their room go straight out, at once: *grew. */
pg_status facet_run_out (break_loop *b, pg_state *state, double t, int *grew);
/* The tips at the load factor of a step, for results (1 after a round at a fixed load). */
pg_status facet_show    (pg_solver *s, const pg_state *state, double factor);

/* ---- facet_events.c: what the break loop and event stepping have of it --------------------------------- */
extern const growth_client facet_client;

/* ---- facet_ends.c -------------------------------------------------------------------------------------- */
/* How many open tips nothing judges at a load factor, by the last measurement; where none is open and none
 * can begin: 1. */
long      facet_unjudged (const break_loop *b, const pg_state *state, double factor);
/* Warns once of every tip that has grown and that nothing judges any more. */
void      facet_tell_lost (break_loop *b, const pg_state *state);
/* After an event, at that load: there is such a tip and nothing else grows up to full load: the run ends. */
int       facet_measure_ends (pg_solver *s, const pg_state *state, double factor);
void      facet_note_end    (pg_statistics *report);   /* says so */

/* ---- facet_energy.c ------------------------------------------------------------------------------------ */
/* After a step that ended at t: have facets in motion taken .9 to 1.1 of the fracture energy? Said once. */
void      facet_doubt_energy (pg_solver *s, const pg_state *state, double t);
/* The energy (J) that a facet has set free as it was cut: of the size of what it takes? Said once. */
void      facet_doubt_cut (break_loop *b, const facet_candidate *c, double t, double freed);

/* ---- facet_motion.c ------------------------------------------------------------------------------------ */
/* Warns where a time step is too long for facets. */
void      facet_doubt_step (break_loop *b, double dt);
/* A time step begins: tips run on for dt (s; INFINITY: to the end of their facets), which open so far. */
void      facet_forward (break_loop *b, double dt);
/* It has ended: is it time to look at the tips? dt (s) is added to the time since the last look. */
int       facet_due     (break_loop *b, double dt);
/* The look, at the displacement d: new speeds, and facets for tips that have none to run along. *top: the
 * largest sqrt (G (v) / G0). *any: something was cut; no force has changed by that, but what is stored
 * has. */
pg_status facet_move    (break_loop *b, pg_state *state, double t, const double *d, double *top, int *any);
void      facet_rest    (break_loop *b);               /* the motion is over: nothing is held any more */
/* A motion begins with the facet of a static event at load t, before which d was the equilibrium
 * (facet_hold_before was called for it): the facet opens as all that follow. */
pg_status facet_set_off (break_loop *b, const pg_state *state, double t, const double *d);
/* At the start of a step; where it is refused. */
pg_status facet_save    (break_loop *b);
void      facet_return  (break_loop *b);
pg_status facet_motion_keep (break_loop *b, const pg_keeper *keeper);

/* Energy that tip i takes over what the rings show; 1: it does not run, or nothing is known yet. */
double    facet_trust     (const facet_growth *g, size_t i);
double    facet_zone      (const break_loop *b);  /* way of a tip in which a facet opens, in facets */
pg_status facet_make_room (facet_growth *g, size_t ntip);              /* runs of so many tips */

/* ---- facet_branch.c ------------------------------------------------------------------------------------ */
/* Does tip i, at the end of its facet, have the energy for two? */
int       facet_branches (const break_loop *b, const pg_state *state, size_t i);
/* It ends, and two tips begin (facet_hold_before was called). *done 0: the material takes none there. */
pg_status facet_fork    (break_loop *b, pg_state *state, size_t i, double t, const double *d, int *done);

/* ---- facet_contact.c ----------------------------------------------------------------------------------- */
/* Places along a facet that is cut, m, its normals, and the force on the left face there that contact goes on
 * bearing, N (all 2 n). None without contact. */
typedef struct { size_t n; double *x, *normal, *force; } facet_faces;
void      facet_faces_clear  (facet_faces *faces);
/* From the stress at d, before the cut. */
pg_status facet_faces_before (const break_loop *b, const pg_state *state, const double *d, const double *from,
                              const double *to, facet_faces *out);
/* Forces that contact goes on bearing, on the nodes, N (ndof), after the cut, caches of the force fresh. */
pg_status facet_faces_bear   (const break_loop *b, const pg_state *state, const facet_faces *faces,
                              double *nodal);

/* ---- facet_hold.c -------------------------------------------------------------------------------------- */
/* The forces before a cut; and after it, the caches of the force being fresh: what has changed is held, for
 * the tip, with the length and the energy of `what`, but for the forces on the nodes that contact goes on
 * bearing, N (ndof; NULL: none). The forces after it are those before the next one. */
pg_status facet_hold_before (break_loop *b, double t, const double *d);
pg_status facet_hold_begin  (break_loop *b, double t, const double *d, const facet_hold *what,
                             const double *borne);
/* Copies holds; what `to` had is freed. */
pg_status facet_hold_copy   (facet_hold **to, size_t *n, size_t *capacity, const facet_hold *from,
                             size_t count);
void      facet_hold_drop   (break_loop *b, int all);  /* drops holds of facets fully open; all: every one */
/* What the facets of a tip have dissipated since they were last accounted for, at the displacement d, J, and
 * what the ones that show G0 should have. */
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
/* Square root of the energy that tip i sets free over what the material takes, at a load factor, in the best
 * direction (rad from the x axis), or along the imposed path; 0: it does not grow. slides: 1: the facet
 * slides, and takes the energy of sliding. Outputs may be NULL. */
double facet_judge (const break_loop *b, const pg_state *state, size_t tip, double factor, double *angle,
                    int *slides);
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
 * crack that is near; fills tip, to, close, slides and energy. */
void facet_place (const break_loop *b, const pg_state *state, size_t tip, double angle, int slides,
                  facet_candidate *out);
/* The shortest way out for a tip without room for a ring; 0: there is none near. */
int  facet_way_out (const break_loop *b, const pg_state *state, size_t tip, facet_candidate *out);

/* ---- trial_facet.c ------------------------------------------------------------------------------------- */
/* Offers facets that no field around a tip can judge, for the displacement fields at hand (g->nfield of them,
 * ndof each). Called after the tips have been measured: g->field[i].near is NAN where tip i has no room. */
pg_status trial_facets (break_loop *b, const pg_state *state, const double *const *d, const double *t);
/* Where does the displacement d at t reach the strength, away from tips and cracks? x: 3, m. */
pg_status trial_hot_place (break_loop *b, const pg_state *state, const double *d, double t, double *x,
                           int *any);
pg_status facet_offer  (facet_growth *g, const facet_candidate *c);                    /* facet_growth.c */
/* Square root of energy set free over energy taken, at most stress over strength of a new crack. */
double    facet_trial_utilisation (const facet_growth *g, const facet_candidate *c, double factor);
#endif
