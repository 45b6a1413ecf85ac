/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the linear system of a force, the break loop, the solver object and its methods. */
#ifndef PG_SOLVE_PRIVATE_H
#define PG_SOLVE_PRIVATE_H
#include "perigal/solve.h"

/* ---- system.c: equilibrium of a force at given alive bits --------------------------------------------------------------- */
typedef struct {                                       /* what inertia and damping add (NULL: static)                    */
    double k, m;                                       /* matrix = k K + m M                                             */
    void (*add) (void *context, const double *d, double *residual, double *reference);     /* reference: at least its size */
    void  *context;
} dynamics;

typedef struct {
    const pg_problem    *problem;
    const pg_force_type *force;
    void                *self;
    const pg_solver_options *options;
    pg_report           *report;
    int       components, stale, umfpack;
    unsigned long revision;                            /* of K when it was last factored or found stale                  */
    long      kept;                                    /* refreshes that left K as it was                                */
    size_t    ndof, nred;
    const pg_linear_type *linear;
    void     *factor;
    pg_sparse A;                                       /* the factored matrix: values owned; pattern of K or reduced     */
    double   *copy;                                    /* with elimination: values of k K + m M before the reduction     */
    double   *diagonal0, mean_diagonal;                /* of the first K                                                 */
    unsigned char *touched;                            /* nodes that the pre-cracks touched (n)                          */
    double   *mass;
    double   *residual, *reduced, *delta, *full, *best, *scratch;
    double    shift;
} pg_system;
pg_status system_create  (pg_system *s);               /* fields up to report set by the caller                           */
void      system_free    (pg_system *s);
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
void      system_multiply (const pg_system *s, const double *x, double *y);        /* y = K x, by operator or matrix       */
/* d becomes the equilibrium at t; *residual relative to the reference force. PG_E_EQUILIBRIUM when it stays above the tolerance. */
pg_status system_solve   (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);

/* ---- equilibrate.c -------------------------------------------------------------------------------------------------------- */
typedef struct {
    pg_system  system;
    double    *utilisation, *factor;                   /* per bond                                                       */
    char      *kind;
    pg_changes changes;                                /* died in the last round                                         */
    pg_broken *broken; size_t nbroken, cap_broken;     /* died in this step                                              */
    pg_ledger  ledger, before;                         /* now; at the last accounted state                               */
    double     work;                                   /* external work, J                                               */
    double    *damage;                                 /* with stop.set (6 n)                                            */
} breaker;
pg_status breaker_create (breaker *b);
void      breaker_free   (breaker *b);
/* Kills the bonds with measure[i] >= cut, logs them with the given utilisation scale. */
pg_status breaker_kill   (breaker *b, pg_state *state, const double *measure, double cut, double scale);
/* Solve, break, update, solve ... at time t until no bond is over its limit; d is left in equilibrium. */
pg_status equilibrate    (breaker *b, pg_state *state, double t, double *d, const dynamics *dyn, pg_step *step);
/* Live bonds over their limit (and its ties) in the last sweep, measured utilisation times scale; *top: the largest. */
long      breaker_over   (const breaker *b, const pg_state *state, double scale, double *top);
/* The ledger of (t, d), and with it the work done between the last accounted state and this one (loads scaled by `scale`). */
pg_status breaker_account (breaker *b, double t, const double *d, const dynamics *dyn, double scale);
/* The work alone, from the ledger at hand. */
pg_status breaker_book    (breaker *b, double scale);
/* Has the damage of a point of options.stop_set reached options.stop_damage? */
pg_status breaker_arrived (breaker *b, const pg_state *state, const double *d, int *arrived);

/* ---- methods ---------------------------------------------------------------------------------------------------------------- */
typedef struct {
    const char *name, *summary;
    pg_status (*start) (pg_solver *s, pg_state *state);           /* before the first step                               */
    pg_status (*step)  (pg_solver *s, pg_state *state, pg_step *step);
    int       (*done)  (const pg_solver *s, const pg_state *state);
    void      (*free)  (pg_solver *s);
} pg_solver_type;

struct pg_solver {
    const pg_solver_type *type;
    pg_solver_options options;
    const pg_problem *problem;
    breaker   breaker;
    pg_report report;
    int       started, finished, overlap_told, energy_told, skips_told;
    long      next_level;                              /* next level to report: next_level / levels                      */
    double   *unit;                                    /* event stepping: displacement at load factor 1                  */
    double    unit_residual;                           /* of `unit`                                                      */
    pg_status ended;  char why[1024];                  /* event stepping: why no step can follow, told by the next       */
    int       ledger_fresh;                            /* the ledger is that of `unit`                                   */
    double    secant0;                                 /* event stepping: first work per squared load factor             */
    pg_state *backup;                                  /* last accepted state, for refused steps                         */
    double   *reaction;
    double   *work1, *work2, *work3;                   /* newmark                                                        */
    double   *support;                                 /* newmark: motion z, z', z'' of prescribed nodes (3 x ndof)      */
    long      support_updates;                         /* report.updates when it was found: breaking changes z           */
};

/* ---- newmark_start.c --------------------------------------------------------------------------------------------------------- */
pg_status newmark_start    (pg_solver *s, pg_state *state);
pg_status newmark_supports (pg_solver *s, double t, int start);                  /* fills s->support for time t              */
void      newmark_follow   (pg_solver *s, double t, double *v, double *a);       /* V and A of prescribed nodes from support */
void      newmark_resist   (pg_solver *s, const double *v, const double *a, double *residual);     /* residual -= M a + C v  */
double    newmark_kinetic  (const pg_solver *s, const double *v);
#endif
