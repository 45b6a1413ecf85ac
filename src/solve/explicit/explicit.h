/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what explicit dynamics and dynamic relaxation have in common. Time step n ends at t_n = n dt;
 * velocities belong to the middle of a step. Prescribed unknowns follow their motion: their entries of v and
 * a are 0 inside a step and filled in where a state is reported. The external force on them, m a + f_int with
 * a = (g_n+1 - 2 g_n + g_n-1) / dt^2, does the work of the supports. */
#ifndef PG_EXPLICIT_H
#define PG_EXPLICIT_H
#include "solve/run/solve.h"

typedef struct {
    size_t  nprescribed, *prescribed;                  /* prescribed unknowns, ascending */
    double *lists, *before, *goal, *next;  /* their displacements at t_n-1, t_n, t_n+1, m (nprescribed) */
    double *push, *push0;  /* external force on them at t_n; at the start of the step, N (nprescribed) */
    double *left;  /* residual of them at t_n: loads less internal force, N (nprescribed) */
    double *P;  /* loads at t_n, N (ndof); NULL: none, or the force cannot give them */
    /* 1 / mass, 1/kg, where all are equal, so that the loops read no array (same bits); 0: they differ */
    double  only;
    double *inverse;                                   /* 1 / mass, 1/kg; 0: no mass (ndof) */
    double *sum;  size_t nblock;                       /* sums of every block of unknowns (nblock x SUMS) */
    double  most;                                      /* largest external work so far, J */
    int     by_work_balance;  /* 1: work comes from the force's work_balance, every time step */
    int     fresh;                                     /* 1: before .. next and P are those of t_n */
    /* Ranks: for each time step of the row, 1 where a bond broke here; 1: a value that is not finite was seen
     * here since the last row. */
    double *broke;  size_t nbroke;  double bad;
    long    between;                                   /* time steps, or iterations, between two rows */
    /* bound of the largest frequency, rad/s, and its origin; 2 / omega, s */
    double  omega, stable;  const char *from;
    double  damped, damped0;  /* energy taken by damping, J; the same at the start of the step */
    /* sum of m v_n v(n+1/2) where the last step was closed; the same at the start of the step */
    double  resist, resist0;
    struct relaxation *relaxation;                         /* relaxation.h; NULL: dynamics */
    struct explicit_contact *contact;                  /* short-range contact and platens; NULL: none */
} motion;
static inline motion *motion_of (const pg_solver *s) { return s->own; }
enum { LANES = 8 };                                   /* unknowns processed at once (a constant) */
/* Sums over unknowns. A, B: work of loads over the half step before t_n and after; C, D: m v_n v before and
 * after; K: m v v; BAD: NaN where a number is not finite; FAST: largest velocity (contact by search). */
enum { SUM_A, SUM_B, SUM_C, SUM_D, SUM_K, SUM_BAD, SUM_FAST, SUMS };

/* ---- explicit.c ---------------------------------------------------------------------------------------- */
pg_status explicit_create  (pg_solver *s);             /* finds supports and masses, allocates */
void      explicit_free    (pg_solver *s);
/* Sets v of prescribed unknowns to 0, so that the loops over all unknowns leave them out. */
void      explicit_release (pg_solver *s, pg_state *state);
/* Sets displacements of the supports at the times of three steps (before, goal, next: at t_n-1, t_n, t_n+1)
 * and the loads. */
pg_status explicit_follow  (pg_solver *s, double before, double now, double next);
/* Finds system.residual at (d, t); breaks bonds over their limit first unless `breaking` is 0. *reference may
 * be NULL. */
pg_status explicit_force   (pg_solver *s, pg_state *state, double t, int breaking, double *reference);
/* makes `broke` at least that long; new entries are 0 */
pg_status explicit_room    (motion *m, size_t steps);
/* sum = total of the sums of all blocks, in order */
void      explicit_total   (const pg_solver *s, double *sum);
/* PG_E_...: names an unknown that is not finite */
pg_status explicit_lost    (const pg_solver *s, const pg_state *state, double t);
/* Of a run of `total` steps: the next step after `now` at which a row of results ends. explicit_level 1: a
 * level is reached there. */
long      explicit_row     (const pg_solver *s, long total, long now);
int       explicit_level   (pg_solver *s, long total, long now);
pg_status explicit_end     (pg_solver *s, const pg_state *state, int last, const char *what, double t);
pg_status explicit_keep    (pg_solver *s, const pg_keeper *keeper);
pg_status explicit_moved   (pg_solver *s, pg_state *state, const pg_moved *moved, int within);

/* ---- explicit_contact.c: short range, and platens ------------------------------------------------------ */
struct explicit_contact {
    pg_short_range *pairs;                             /* pairs of points; NULL: platens alone */
    /* Where unknowns are not displacements (pg_force_type.at_nodes): displacements and velocities of the
     * points, forces of pairs on the points, and these as forces on the unknowns (ndof each); else NULL. */
    double *moved, *speed, *pressed, *taken;
    /* For impulses: increments of the unknowns in the last step and in the next one, m; 1 / mass, 0:
     * prescribed (ndof each); else NULL. */
    double *back, *ahead, *inverse;
    pg_moving_platens *platens;  pg_platen_values *shown;              /* NULL: none */
    int     active;                                    /* 1: some contact force at hand is not zero */
    double  way;  /* largest change of an unknown in the last time step, m */
    long    broken;  /* bonds broken at the last evaluation; -1: not known */
    double  bare;                                      /* largest frequency without contact, rad/s */
    double  energy0, friction0;  /* contact and friction energy at the start of the step, J */
    int     warned;
};
pg_status explicit_contact_create (pg_solver *s);      /* does nothing unless the options ask for it */
void      explicit_contact_free   (pg_solver *s);
/* Largest square of a frequency that contact may add, 1/s^2. */
double    explicit_contact_rate   (const pg_solver *s);
/* Adds contact forces to the residual of all other forces, supports being at the next time; first 1: no step
 * has led to this state. */
pg_status explicit_contact_add    (pg_solver *s, pg_state *state, double t, int first);
double    explicit_contact_kinetic (const pg_solver *s);               /* kinetic energy of platens, J */
int       explicit_contact_active (const pg_solver *s);                /* 1: some contact force is not zero */
void      explicit_contact_forces (const pg_solver *s, double *out);   /* out += contact forces, N (ndof) */
void      explicit_contact_show   (pg_solver *s);
pg_status explicit_contact_save   (pg_solver *s);
void      explicit_contact_return (pg_solver *s);
double    explicit_contact_took   (const pg_solver *s);
pg_status explicit_contact_keep   (pg_solver *s, const pg_keeper *k);

/* ---- stable_time_step.c -------------------------------------------------------------------------------- */
/* Sets omega, stable and from by a bound of the largest frequency; then options.dt: 0.9 of the stable step if
 * not given; a step that is too large is refused. */
pg_status explicit_stable  (pg_solver *s);
double    explicit_bound   (const pg_solver *s, const char **from);    /* the stable time step, s */

/* ---- explicit_step.c ----------------------------------------------------------------------------------- */
/* One pass over unknowns first..last - 1 of a block. Leapfrog in two half kicks: the closing one takes the
 * velocity from t_n-1/2 to t_n, where forces are at hand, and sets v and a as the method reports them; the
 * opening one takes it to t_n+1/2 and the displacement to t_n+1. Both at once give the same bits as one after
 * the other. Of `sum` the pass fills C, D (closing) and K (closing alone). */
typedef struct {
    double *d, *v, *a;
    double *f, *inverse, *mass, *P;                    /* read only; P may be NULL */
    double only;                                       /* 1 / mass if equal everywhere; else 0 */
    double dt, damping;                                /* time step, s; damping, 1/s */
    int    closing, opening;
} half_kicks;
typedef void (*kick_range) (const half_kicks *w, size_t first, size_t last, double *sum);
void      explicit_read    (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
pg_status explicit_prepare (pg_solver *s);
pg_status explicit_step    (pg_solver *s, pg_state *state, pg_step *step, kick_range range, int staggered);
int       explicit_done    (const pg_solver *s, const pg_state *state);
void      explicit_refused (pg_solver *s);
double    explicit_progress (const pg_solver *s, const pg_state *state);
/* Entries of pg_solver_type that all explicit methods share; name, summary and step (explicit_step with its
 * own half kicks) are added by each. */
#define EXPLICIT_ENTRIES \
    .flags = PG_SOLVER_EXPLICIT | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_FACETS | PG_SOLVER_CONTACT \
             | PG_SOLVER_RANKS, \
    .keys = { &solver_keys_facets, &solver_keys_step, &solver_keys_time }, \
    .read = explicit_read, .prepare = explicit_prepare, .done = explicit_done, \
    .refused = explicit_refused, .free = explicit_free, .keep = explicit_keep, .move = explicit_moved, \
    .own_size = sizeof (motion), .stable = explicit_bound, .progress = explicit_progress
/* Applies ONE (T, i, lane) to the unknowns of a range that begins at a multiple of LANES: eight at a time as
 * type T, in all lanes of the sums; the rest one by one, each in its lane. OF: unknowns i.. of a vector, as
 * type T. */
#define OF(T, x, i) (*(T *) (void *) ((x) + (i)))
#define EACH_OF(first, last, ONE) \
    do { \
        size_t at_ = (first); \
        for (; at_ + LANES <= (last); at_ += LANES) ONE (pg_eight, at_, ); \
        for (; at_ < (last); at_++) ONE (double, at_, [at_ % LANES]); \
    } while (0)
double    lane_sum     (const pg_eight *s);
double    lane_dot     (const double *a, const double *b, size_t first, size_t last);
/* returns 0, or NaN when a number is not finite */
double    lane_not_finite     (const double *d, size_t first, size_t last);
#endif
