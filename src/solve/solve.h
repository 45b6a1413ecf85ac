/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the linear system of a force, the break loop, the solver object and its methods. */
#ifndef PG_SOLVE_PRIVATE_H
#define PG_SOLVE_PRIVATE_H
#include "perigal/solve.h"

/* ---- system.c: equilibrium of a force at given alive bits ---------------------------------------------- */
typedef struct pg_dynamics {                           /* what inertia and damping add (NULL: static) */
    double k, m;                                       /* matrix = k K + m M */
    /* reference: at least its size */
    void (*add) (void *context, const double *d, double *residual, double *reference);
    void  *context;
} dynamics;

/* How the linear systems are solved; TRIAL: not known yet, a few iterations are tried first. */
enum { SYSTEM_UNDECIDED, SYSTEM_TRIAL, SYSTEM_FACTOR, SYSTEM_KEPT_FACTOR, SYSTEM_NO_FACTOR };

typedef struct {
    const pg_problem    *problem;
    const pg_force_type *force;
    void                *self;
    const pg_solver_options *options;
    pg_statistics           *report;
    /* all_weak: every unknown gets the shift (touched) */
    int       components, stale, umfpack, mode, unshifted, all_weak;
    unsigned long revision;                            /* of K when it was last factored or found stale */
    long      spared;                                  /* solves by the factor of an earlier K */
    long      kept;                                    /* refreshes that left K as it was */
    size_t    ndof, nred;
    const pg_linear_type *linear;
    void     *factor;
    pg_sparse A;  /* the factored matrix: values owned; pattern of K or reduced */
    double   *copy;  /* with elimination: values of k K + m M before the reduction */
    double   *diagonal0, mean_diagonal;                /* of the first K */
    unsigned char *touched; int marked;                /* nodes that the pre-cracks touched (n); 1: found */
    double   *mass;                                    /* lumped, per unknown, kg */
    const pg_sparse *M;                                /* consistent, or NULL */
    double   *residual, *reduced, *delta, *full, *best, *scratch;
    /* of the last state measured, N: its forces; what it lacks to balance */
    double    reference, unbalanced;
    double    borne;  /* the largest reference of an accepted state of fixed load steps, N */
    double    shift;
    /* s (with the multilevel preconditioner: iterations) that a new factor would have spared */
    double    rent;
    pg_multilevel *multilevel;                         /* NULL: not used, or not made yet */
    unsigned char *fixed;  /* unknowns that T leaves out (ndof); NULL: not asked for */
    int       remake;  /* read back: the preconditioner is to be made from `factored` */
    double    pace;  /* - log of the residual's fall in one iteration, preconditioner new; 0: not known */
    size_t    matrix_iterations;
    const unsigned char *alive;                        /* of the last refresh, borrowed */
    unsigned char *factored;  /* what lived when the factor or preconditioner was made */
} pg_system;
int       system_has_matrix (const pg_system *s);       /* the force offers K itself */
pg_status system_create  (pg_system *s);               /* fields up to report set by the caller */
void      system_free    (pg_system *s);
pg_status system_factorize (pg_system *s, const dynamics *dyn);  /* k K + m M of the last refresh */
void      system_remember_diagonal (pg_system *s, const pg_sparse *K);  /* once; K NULL: by the operator */
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
/* y = K x, by operator or matrix */
void      system_multiply (const pg_system *s, const double *x, double *y);
/* delta = (k K + m M)^-1 reduced by conjugate gradients, preconditioned by the factor at hand or by the
 * diagonal (iterate.c). */
pg_status system_iterate (pg_system *s, const dynamics *dyn, int by_factor, double tolerance, size_t limit,
                          size_t *used);
/* The same for K alone by conjugate gradients with the multilevel preconditioner, made when needed
 * (precondition.c). */
pg_status system_iterate_multilevel (pg_system *s, double tolerance);
pg_status system_make_multilevel (pg_system *s);  /* from the last refresh */
pg_status system_can_precondition (pg_system *s, const dynamics *dyn, int *can);
pg_status system_remember_alive (pg_system *s);        /* in `factored` */
/* d becomes the equilibrium at t; *residual relative to the reference force. PG_E_EQUILIBRIUM when it stays
 * above the tolerance. */
pg_status system_solve   (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);

/* mass.c: y += factor M x; d += factor diag M; value += factor M */
/* After the first refresh; consistent: by the force, not lumped. */
pg_status system_mass (pg_system *s, int consistent);
void system_add_mass (const pg_system *s, double factor, const double *x, double *y);
void system_add_mass_diagonal (const pg_system *s, double factor, double *d);
void system_add_mass_matrix (const pg_system *s, double factor, const pg_sparse *K, double *value);

/* ---- equilibrate.c ------------------------------------------------------------------------------------- */
typedef struct {
    pg_system  system;
    double    *utilisation, *factor;                   /* per bond */
    char      *kind;
    pg_changes changes;                                /* died in the last round */
    pg_broken *broken; size_t nbroken, cap_broken;     /* died in this step */
    long       round;  /* break rounds of the step at hand; > 0 between steps: it was stopped in its middle */
    long       began;                                  /* round at which this call began */
    /* the caller's look between rounds; 1: it ended the step */
    pg_watch   watch; void *watching; int stopped;
    double     work0, stored0;                         /* at the start of the step, J */
    pg_work_balance  work_balance, before;                         /* now; at the last accounted state */
    double     work;                                   /* external work, J */
    double    *damage;                                 /* with stop.set (6 n) */
    /* largest damage of stop.set: now, when it was first looked at */
    double     nearest, nearest0; int looked;
} break_loop;
pg_status break_loop_create (break_loop *b);
void      break_loop_free   (break_loop *b);
/* The arrays of a sweep of utilisation, when they are first needed. */
pg_status break_loop_ready  (break_loop *b);
/* Notes a bond that died at time (or load factor) t. */
pg_status break_loop_log    (break_loop *b, size_t bond, char kind, double utilisation, double t);
/* Kills the bonds with measure[i] >= cut, logs them with the given utilisation scale. */
pg_status break_loop_kill (break_loop *b, pg_state *state, const double *measure, double cut, double scale,
                           double t);
/* Solve, break, update, solve ... at time t until no bond is over its limit; d is left in equilibrium. */
pg_status equilibrate (break_loop *b, pg_state *state, double t, double *d, const dynamics *dyn,
                       pg_step *step);
/* Live bonds over their limit (and its ties) in the last sweep, measured utilisation times scale; *top: the
 * largest. */
long      break_loop_over   (const break_loop *b, const pg_state *state, double scale, double *top);
/* The work_balance of (t, d), and with it the work done between the last accounted state and this one (loads
 * scaled by `scale`). */
pg_status break_loop_account (break_loop *b, double t, const double *d, const dynamics *dyn, double scale);
/* The work alone, from the work balance at hand. */
pg_status break_loop_book    (break_loop *b, double scale);
/* Has the damage of a point of options.stop_set reached options.stop_damage? */
pg_status break_loop_arrived (break_loop *b, const pg_state *state, const double *d, int *arrived);

/* ---- methods ------------------------------------------------------------------------------------------- */
/* A row of a table of keys without a catalogue of its own. */
#define PG_SOLVER_KEY(path, kind, unit, range, fallback, choices, doc) \
    { path, kind, unit, range, fallback, choices, NULL, NULL, doc }

/* Keys that several solvers share (keys.c): how bonds break between solves; the linear systems; the time
 * step; the time axis and Rayleigh's damping; stages of the load. */
extern const pg_key_table solver_keys_breaking, solver_keys_linear, solver_keys_step, solver_keys_time,
    solver_keys_stages;

/* "adr, relax": the names of all entries that fit. */
void solver_names_that (int (*fits) (const pg_solver_type *type, const void *context), const void *context,
                        char *text, size_t size);

/* ---- options.c: parts of `read` of several solvers ----------------------------------------------------- */
/* A number or a whole number of the scene, 0 where it is not given. */
double options_number  (const pg_scene *scene, const char *key);
long   options_integer (const pg_scene *scene, const char *key);
/* solver.dt, end and time_steps. The caller says whether the step may be left to the solver: then one of the
 * last two is enough; else two of the three are needed. */
void   options_read_times (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
/* PG_E_SCENE: what is found wrong with a key while the solver is made, placed in the scene if options.scene
 * knows it. */
pg_status solver_fault (const pg_solver *s, const char *key, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
typedef struct motion motion;                          /* explicit.h */

struct pg_solver {
    const pg_solver_type *type;
    pg_solver_options options;
    const pg_problem *problem;
    break_loop   break_loop;
    pg_statistics report;
    int       started, finished, overlap_told, energy_told, skips_told, spared_told;
    long      next_level;                              /* next level to report: next_level / levels */
    double   *unit;                                    /* event stepping: displacement at load factor 1 */
    double   *base;                                    /* affine loads: at load factor 0 */
    long      held;                                    /* affine loads: events at a held load factor */
    double    unit_residual;                           /* of `unit` */
    pg_status ended;  char why[1024];  /* event stepping: why no step can follow, told by the next */
    int       work_balance_fresh;                            /* the work balance is that of `unit` */
    double    secant0;  /* event stepping: first work per squared load factor */
    /* event stepping: work per squared load factor over the first; largest load factor */
    double    secant, top_factor;
    pg_state *backup;                                  /* last accepted state, for refused steps */
    double   *reaction;
    double   *work1, *work2, *work3, *work4;           /* newmark (work4: 3 x ndof) */
    double   *force0;  /* newmark with alpha: loads less resistance at the last step's end, N */
    dynamics  dyn;                                     /* newmark: coefficients of its matrix */
    double   *support;  /* newmark: motion z, z', z'' of prescribed nodes (3 x ndof) */
    motion   *motion;                                  /* explicit and relaxed methods */
    long      support_updates;  /* report.updates when it was found: breaking changes z */
};

/* ---- static.c, affine.c: events ------------------------------------------------------------------------ */
pg_status affine_solve (pg_solver *s);                 /* both equilibria */
pg_status affine_step  (pg_solver *s, pg_state *state, pg_step *step);
/* What the equilibrium after an event came to: 1: there is none, and the next step says why. */
int       event_ended  (pg_solver *s, const pg_state *state, double factor, pg_status now);
/* crack arrived, body apart */
pg_status event_stops  (pg_solver *s, const pg_state *state, double factor, double secant);
void      event_limit  (pg_solver *s, const pg_state *state, double factor);  /* max_events */

/* ---- newmark_start.c ----------------------------------------------------------------------------------- */
pg_status newmark_start    (pg_solver *s, pg_state *state);
pg_status newmark_supports (pg_solver *s, double t, int start);  /* fills s->support for time t */
/* V and A of prescribed nodes from support */
void      newmark_follow   (pg_solver *s, double t, double *v, double *a);
/* residual -= M a + C v */
void      newmark_resist   (pg_solver *s, const double *v, const double *a, double *residual);
void      newmark_damp     (pg_solver *s, const double *v, double *residual);
pg_status newmark_remember (pg_solver *s, double t, const pg_state *state);      /* fills s->force0 */
double    newmark_kinetic  (pg_solver *s, const double *v);
#endif
