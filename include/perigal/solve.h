/* SPDX-License-Identifier: GPL-3.0-or-later
 * solve.h: methods that advance a state, the break loop, what a step and a run report.
 * Catalogue: src/solve/<name>.c + one line in list.h. Cui 2022 section 3.2; theory F5, F6. */
#ifndef PERIGAL_SOLVE_H
#define PERIGAL_SOLVE_H
#include "perigal/force.h"

PG_API_BEGIN

/* PASSING (adr, relax): at any iteration once the stage's load has come to act, not only in balance. */
typedef enum { PG_BREAK_WORST, PG_BREAK_FRACTION, PG_BREAK_ALL, PG_BREAK_PASSING } pg_break;
typedef struct {
    char     kind[16], linear[16];  /* an entry of src/solve; auto | cholmod | umfpack | pcg */
    char     preconditioner[16];  /* of linear: pcg; auto | jacobi | multilevel; "": auto */
    int      quasi_static;                             /* static, adr, relax: t of loads is the load factor */
    int      marching;                                 /* verlet, central: explicit time steps */
    int      staged;                                   /* adr, relax: stages of the load, each relaxed */
    int      event;                                    /* static: event stepping */
    int      affine;                                   /* event: loads have a constant part */
    int      consistent;                               /* newmark: consistent mass, not lumped */
    pg_break break_mode;
    double   break_fraction, tie;  /* bonds within this share of the worst break with it */
    double   tolerance;                                /* of the residual, relative to the reference force */
    /* steps: calls of pg_solver_step up to the end; marching: 0 until the solver is made */
    long     steps, max_iterations, max_events;
    /* marching: 0: by dt and end; most rows of history.csv, 0: by the number of time steps */
    long     time_steps, rows;
    long     stages;                                   /* staged */
    int      hold;  /* staged: 1: each stage until balanced, 0: one iteration a stage */
    /* staged: accepted residual over reference; relax: kg/(m^3 s), 0: by Rayleigh's quotient */
    double   imbalance, damping;
    /* s (marching, relax: 0: from the largest frequency), s, 1, 1, 1, 1/s, s */
    double   dt, end, alpha, beta, gamma, rayleigh_mass, rayleigh_stiffness;
    double   stop_stiffness;  /* event stepping: stop when the secant stiffness fell below it */
    /* stop when a point of the set is damaged so far; NULL: never */
    const pg_set *stop_set; double stop_damage;
    long     levels;  /* reports at k / levels of the load (or of the end time) */
    char     unused[256];  /* keys of the scene's solver that this kind does not heed, "dt, end"; "": none */
    /* that they were read from: pg_solver_create places there what it finds wrong; NULL: none */
    const pg_scene *scene;
} pg_solver_options;
pg_status pg_solver_options_read (pg_solver_options *out, const pg_problem *problem, const pg_scene *scene);

/* ---- patch test ---------------------------------------------------------------------------------------- */
/* Measures problem->patch, once: the bare body (pg_problem_bare) under the tractions of each independent
 * uniform stress, by conjugate gradients that begin at the best linear field and end when they gain nothing
 * more, or when they have cost what a run should not notice. Without facets the outermost points are held
 * instead. From PG_PATCH_TOLD on pg_solver_doubts warns, over PG_PATCH_REFUSED pg_patch_refuse refuses. What
 * the supports of the scene add is not in it: a share of a fifth to a half, so that 5 % of a scene are told
 * of from 4 % here. */
#define PG_PATCH_TOLD 0.04
#define PG_PATCH_REFUSED 0.5
pg_status pg_patch_probe (pg_problem *problem);
/* PG_E_SCENE with what was measured that no run should go by: too large an error, unless
 * method.accept_inexact says yes, or more than a quarter of the points without a strain. */
pg_status pg_patch_refuse (const pg_problem *problem, const pg_scene *scene);
const char *pg_patch_state (const pg_problem *problem);                            /* "xx", "xy" ... */
/* How far off, and by what; what to do about it. */
void      pg_patch_words  (const pg_problem *problem, char *out, size_t size);
void      pg_patch_remedy (const pg_problem *problem, char *out, size_t size);

/* ---- what happened ------------------------------------------------------------------------------------- */
/* time: s; quasi-static: load factor; utilisation NAN: not known */
typedef struct { size_t bond; int set; char kind; double utilisation, place[3], time; } pg_broken;

enum {
    PG_SECONDS_SHAPE,
    PG_SECONDS_ANALYSE,
    PG_SECONDS_FACTOR,
    PG_SECONDS_SOLVE,
    PG_SECONDS_FORCE,
    PG_SECONDS_BREAK,
    /* update: shapes and rows that breaks have touched */
    PG_SECONDS_ASSEMBLE,
    PG_SECONDS_UPDATE,
    PG_SECONDS_COUNT
};
typedef struct { char what[96], why[160]; double seconds_saved; } pg_skip;
typedef struct {                                       /* of the run so far */
    long   steps, events, iterations, broken, bonds_over_limit, factorizations, updates, solves;
    long   preconditioners;                            /* made (multilevel) */
    size_t cg_iterations, degenerate_points, isolated_nodes, fragments;
    double utilisation_max, residual_max, overlap_max; /* over accepted steps; m */
    /* J; dissipated: by breaking, the rest */
    double energy_strain, energy_kinetic, energy_external, energy_damping, energy_dissipated;
    double seconds[PG_SECONDS_COUNT];
    double factor_entries, factor_flops;
    char   ordering[16], solver[16], preconditioner[128];
    pg_skip skipped[16];  size_t nskipped;
    char   warning[16][256]; size_t nwarning;
} pg_statistics;
void pg_statistics_warn (pg_statistics *report, const char *format, ...)
    __attribute__ ((format (printf, 2, 3)));
/* Adds the warnings that a run has before its first step: what is legal, yet hardly meant, such as a body
 * that nothing holds, and what the problem was built with otherwise than asked. pg_solver_create does so for
 * the report of its solver. */
void pg_solver_doubts (pg_statistics *report, const pg_problem *problem, const pg_solver_options *options);
/* The k-th note on the scene, such as keys without meaning for its solver or force; 0: there are no more. */
int pg_solver_note (const pg_problem *problem, const pg_solver_options *options, size_t k, char *out,
                    size_t size);
void pg_statistics_skip (pg_statistics *report, double seconds, const char *what, const char *why);

typedef struct {  /* of one step: a user level, a time step or an event */
    long   number, iterations;  /* break-and-solve rounds; time steps; iterations of relaxation */
    int    level;                                      /* 1: a level at which the user wants fields */
    int    event;                                      /* 1: bonds broke at this load (event stepping) */
    double stamp;  /* never falls: the time; the step number under event stepping */
    /* utilisation: largest of a live bond in the accepted state */
    double time, factor, residual, utilisation;
    size_t nbroken;  const pg_broken *broken;          /* borrowed until the next step */
    const double *reaction;  /* force on the body per load, N (nload x 3), borrowed */
    double dissipated;                                 /* J, in this step */
} pg_step;

/* ---- solver -------------------------------------------------------------------------------------------- */
typedef struct pg_solver pg_solver;
pg_status pg_solver_create (pg_solver **out, const pg_problem *problem, const pg_solver_options *options);
/* The same with a force of the caller's (tests, experiments). */
pg_status pg_solver_create_with (pg_solver **out, const pg_problem *problem, const pg_solver_options *options,
                                 const pg_force_type *force);
void      pg_solver_free   (pg_solver **solver);
int       pg_solver_components (const pg_solver *solver);  /* dofs per node, for pg_state_create */
/* Advances by one step. On a numerical failure the state is that of the last accepted step. */
pg_status pg_solver_step   (pg_solver *solver, pg_state *state, pg_step *step);
/* Called between the break rounds of a step, with the state and the step so far. A status other than PG_OK
 * ends pg_solver_step with it; the state is then one in the middle of the step, from which pg_solver_step
 * goes on when it is called again. */
typedef pg_status (*pg_watch) (void *context, const pg_state *state, const pg_step *so_far);
void      pg_solver_watch  (pg_solver *solver, pg_watch watch, void *context);
/* Writes or reads back all that later steps depend on, state included, also in the middle of a step. A solver
 * read back goes on bit by bit as the written one would have (same machine, threads and libraries).
 * PG_E_FILE: what is read back cannot be of this problem. */
pg_status pg_solver_keep   (pg_solver *solver, pg_state *state, const pg_keeper *keeper);
/* Broken bonds in such a walk; what no bond of the problem can be is PG_E_FILE. */
pg_status pg_broken_keep (const pg_problem *problem, const char *name, size_t n, pg_broken *broken,
                          const pg_keeper *keeper);
/* The options as the solver goes by them: what was left to it (dt, end, steps, stages) is filled in. */
const pg_solver_options *pg_solver_settled (const pg_solver *solver);
/* Marching and relax: the largest stable time step by the force's bound, s, and what it comes from; else
 * NAN. */
double    pg_solver_stable (const pg_solver *solver, const char **from);
/* Largest eigenfrequency sqrt (K x / M x), rad/s, from below within about 1 %: explicit steps are stable up
 * to 2 / omega. */
pg_status pg_solver_fastest (pg_solver *solver, const pg_state *state, double *omega);
int       pg_solver_done   (const pg_solver *solver, const pg_state *state);
/* How far a run has come. Event stepping cannot know which of its ends comes first: the nearest one
 * counts. */
typedef struct {
    double      share;                                 /* 0..1, of `end` */
    /* "the load", "the time", "the time steps", "the stages", "max_events", "stop.damage" */
    const char *end;
    int         even;  /* 1: steps are about alike, so that the time left follows from the pace so far */
    int         event;                                 /* 1: event stepping */
    /* event stepping: secant stiffness (or compliance) over the first; NAN: not known */
    double      stiffness;
    double      damage;  /* largest damage in solver.stop.set; NAN: none, or not looked at yet */
} pg_progress;
void      pg_solver_progress (const pg_solver *solver, const pg_state *state, pg_progress *out);
/* with a fresh census and overlap */
const pg_statistics *pg_solver_report (pg_solver *solver, const pg_state *state);
const pg_statistics *pg_solver_report_now (const pg_solver *solver);  /* counts and energies only */
/* The force behind it, for fields and gauges. */
const pg_force_type *pg_solver_force (const pg_solver *solver, void **self);
const char *pg_solver_names (void);
const char *pg_solver_summary (const char *name);                                  /* NULL: unknown */
/* b0..b7 of Newmark's method (theory F5) for dt, beta, gamma of the options. */
void pg_newmark_coefficients (const pg_solver_options *options, double *b);
PG_API_END
#endif
