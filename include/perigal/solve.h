/* SPDX-License-Identifier: GPL-3.0-or-later
 * solve.h: solvers that advance a state, the loop that breaks bonds, and reports of a step and a run.
 * Catalogue: src/solve/<name>.c + one line in list.h. Cui 2022 section 3.2; doc/method.md F5, F6. */
#ifndef PERIGAL_SOLVE_H
#define PERIGAL_SOLVE_H
#include "perigal/contact.h"

PG_API_BEGIN

/* Which bonds over their limit break at once. PASSING (load stages): at any iteration after the stage's load
 * acts, not only in equilibrium. FACET: the criterion is applied to tips, and all bonds that a new facet
 * crosses break. */
typedef enum { PG_BREAK_WORST, PG_BREAK_FRACTION, PG_BREAK_ALL, PG_BREAK_PASSING, PG_BREAK_FACET } pg_break;
/* Event stepping, if bonds exceed their limit after an event at constant load: FOLLOW: the load drops until
 * they are at their limit; HOLD: the load stays and they break, the worst first; DYNAMIC: the load stays and
 * the motion is integrated until the body is at rest. */
typedef enum { PG_UNSTABLE_FOLLOW, PG_UNSTABLE_HOLD, PG_UNSTABLE_DYNAMIC } pg_unstable;
/* Options common to all solvers. Options of one solver or family are a separate struct in `own`: PG_OWN
 * (pg_newmark_options, options)->alpha. */
enum { PG_SOLVER_OWN = 128 };
typedef struct {
    /* solver: an entry of src/solve; linear solver: "auto" or an entry of src/linalg */
    char     kind[32], linear[16];
    char     preconditioner[16];  /* for linear: pcg: auto | jacobi | multilevel; "": auto */
    unsigned flags;                                    /* PG_SOLVER_... of the kind: perigal/model.h */
    int      event;                                    /* 1: event stepping (PG_SOLVER_EVENTS) */
    pg_unstable on_instability;                        /* event stepping: breaking at constant load */
    pg_break break_mode;
    int      plain;                                    /* 1: no shortcuts; as problem->plain */
    double   break_fraction, tie;  /* tie: bonds within this relative distance of the worst break with it */
    double   facet;  /* break: facet: length of a facet, m; 0: the local spacing */
    int      branching;                                /* 1: break: facet, dynamics: tips may branch */
    double   tolerance;  /* tolerance of the residual over the reference force */
    /* steps: number of pg_solver_step calls to the end; 0: set when the solver is created */
    long     steps, max_iterations, max_events;
    long     time_steps;                               /* number of explicit time steps; 0: by dt and end */
    long     rows;  /* most rows of history.csv, 0: by the number of time steps */
    double   dt, end;                                  /* s; dt 0: 0.9 of the stable time step */
    /* the run ends when the damage of a point of the set reaches stop_damage; NULL: never */
    const pg_set *stop_set; double stop_damage;
    pg_contact_setting contact;                        /* contact of crack faces (PG_SOLVER_CONTACT) */
    long     levels;  /* reports at k / levels of the load (or of the end time) */
    char     unused[256];  /* ignored keys of the section solver, which belong to other solvers: "dt, end" */
    union { double align; unsigned char byte[PG_SOLVER_OWN]; } own;    /* options of one solver: PG_OWN */
    /* scene of the options, in which pg_solver_create reports errors; NULL: none */
    const pg_scene *scene;
} pg_solver_options;
/* PG_OWN: pointer to the options of that type in `own`, to const if `options` is. A type too large for `own`
 * does not compile. The inner _Generic only makes both branches valid C, whichever is selected. */
static inline void *pg_own_bytes (pg_solver_options *o, size_t fits) { return (void) fits, o->own.byte; }
static inline const void *pg_own_const (const pg_solver_options *o, size_t fits)
{
    return (void) fits, o->own.byte;
}
#define PG_OWN(type, options) _Generic ((options), \
    pg_solver_options *: (type *) pg_own_bytes (_Generic ((options), pg_solver_options *: (options), \
        default: (pg_solver_options *) 0), sizeof (char[sizeof (type) <= PG_SOLVER_OWN ? 1 : -1])), \
    const pg_solver_options *: (const type *) pg_own_const ((options), \
        sizeof (char[sizeof (type) <= PG_SOLVER_OWN ? 1 : -1])))
#define PG_ALIAS __attribute__ ((may_alias))
typedef struct {  /* Newmark's method; alpha, beta, gamma: 1; damping: 1/s, s */
    int    consistent;                                 /* 1: consistent mass, 0: lumped */
    double alpha, beta, gamma, rayleigh_mass, rayleigh_stiffness;
} PG_ALIAS pg_newmark_options;
typedef struct {                                       /* static: equilibria by linear systems */
    int    affine;                                     /* 1: event stepping, loads with a constant part */
    long   steps;                                      /* number of fixed load steps per stage of loading */
    /* event stepping: stop when the secant stiffness, relative to the first, falls below it */
    double stop_stiffness;
    pg_newmark_options motion;                         /* for PG_UNSTABLE_DYNAMIC */
    /* dt: s; 0: from the fastest wave. quiet: time without a break, s, after which the motion is damped out;
     * longest: s */
    double dt, quiet, longest;
} PG_ALIAS pg_static_options;
typedef struct { double rayleigh_mass; } PG_ALIAS pg_explicit_options;      /* explicit dynamics; 1/s */
typedef struct {                                       /* load stages, each relaxed */
    long   stages;
    int    hold;  /* 1: each until equilibrium, 0: one iteration per stage */
    double imbalance;                                  /* accepted residual over the reference force */
    double damping;                                    /* kg/(m^3 s); 0: by Rayleigh's quotient */
} PG_ALIAS pg_stages_options;
pg_status pg_solver_options_read (pg_solver_options *out, const pg_problem *problem, const pg_scene *scene);

/* ---- patch test ---------------------------------------------------------------------------------------- */
/* Runs the patch test once (problem->patch): the bare body (pg_problem_bare) under the tractions of each
 * independent uniform stress, by conjugate gradients that start from the best linear field and end when they
 * stagnate, or at a small fraction of the cost of a run. Without facets the outermost points are fixed
 * instead. For errors from PG_PATCH_WARNED on, and strains of rigid motions from PG_RIGID_WARNED on
 * (rotations 100 times the strains then cause errors of 1 %), pg_solver_doubts warns; above PG_PATCH_REFUSED
 * pg_patch_refuse fails. Supports of the scene, which add a fifth to a half of the error, are not included:
 * the threshold of 4 % warns before 5 % in a scene. */
#define PG_PATCH_WARNED 0.04
#define PG_RIGID_WARNED 1e-4
#define PG_PATCH_REFUSED 0.5
pg_status pg_patch_probe (pg_problem *problem);
/* PG_E_SCENE if the patch test shows that results would be useless: too large an error, unless
 * method.accept_inexact is on, or more than a quarter of the points without a strain. */
pg_status pg_patch_refuse (const pg_problem *problem, const pg_scene *scene);
const char *pg_patch_state (const pg_problem *problem);  /* worst state of stress: "xx", "xy" ... */
/* Describe the error of the patch test, a position in the body, and remedies, in words. */
void      pg_patch_words  (const pg_problem *problem, char *out, size_t size);
void      pg_patch_place  (const pg_problem *problem, const double *x, char *out, size_t size);
void      pg_patch_remedy (const pg_problem *problem, char *out, size_t size);

/* ---- strength where cracks begin
 * ------------------------------------------------------------------------ */
/* Strengths of a material with crack growth by facets: the tensile strength of the scene and the one in use,
 * which the spacing h limits to sqrt (E G0 / 8 h), Pa; length E G0 / f_t^2 of the fracture process zone, m;
 * likewise for the cohesion. NAN: not given. */
typedef struct { double asked, in_use, zone, cohesion, cohesion_in_use, shear_zone; } pg_strength;
/* Finds the strengths of a material; returns 0: it has neither tensile strength nor cohesion. */
int       pg_strength_of (const pg_problem *problem, size_t material, pg_strength *out);

/* ---- reports ------------------------------------------------------------------------------------------- */
/* time: s; a broken bond: middle `place`, m; time, s (quasi-static: load factor); utilisation NAN: not known;
 * round of breaking in the step */
typedef struct { size_t bond; int set; char kind; double utilisation, place[3], time; long round; } pg_broken;

enum {
    PG_SECONDS_SHAPE,
    PG_SECONDS_ANALYSE,
    PG_SECONDS_FACTOR,
    PG_SECONDS_SOLVE,
    PG_SECONDS_FORCE,
    PG_SECONDS_BREAK,
    PG_SECONDS_ASSEMBLE,
    PG_SECONDS_UPDATE,  /* shape functions and matrix rows affected by breaks */
    PG_SECONDS_COUNT
};
typedef struct { char what[96], why[160]; double seconds_saved; } pg_skip;
/* ---- parts of the report of a run ---------------------------------------------------------------------- */
/* Energies, J. Now: strain, kinetic, contact (short-range). So far: external work, damping, dissipated by
 * breaking, friction of crack faces, fracture (fracture energy times new crack area, for comparison). */
typedef struct {
    double strain, kinetic, external, damping, dissipated, contact, friction, fracture;
} pg_energies;
/* Error of the global balance of loads, reactions, inertia and damping: largest |sum of forces| over the sum
 * of their magnitudes; of moments over that sum times the body's diagonal; number of states measured. */
typedef struct { double force, moment; long states; } pg_misbalance;
/* Contact of crack faces, and short-range contact. */
typedef struct {
    /* totals of the run: right-hand sides for the compliance, dense solves, changes of status; their
     * seconds */
    long   columns, solves, changes;
    double seconds;
    /* last state: number of pieces, open, sticking, sliding; passes and sweeps of its solution */
    long   pieces, open, stick, sliding, passes, sweeps;
    double overlap;                                    /* largest mean overlap of a piece during the run, m */
    /* short-range contact, last state: candidate pairs without a bond; pairs in contact */
    long   pairs, touching;
    double overlap_max;                                /* largest overlap in accepted steps, m */
} pg_contact_report;
/* Statistics of linear systems: numbers of factorisations, updates of factors, solves, multilevel
 * preconditioners made, iterations of conjugate gradients; entries of the factor and its operations; names of
 * ordering, solver, preconditioner. */
typedef struct {
    long   factorizations, updates, solves, preconditioners;
    size_t cg_iterations;
    double factor_entries, factor_flops;
    char   ordering[16], solver[16], preconditioner[128];
} pg_linear_report;
/* Unstable growth in event stepping: how often, number of its steps (events at constant load, or time steps),
 * duration of motions, s, and the largest jump of a reaction at the beginning or end of a motion, over the
 * largest reaction. */
typedef struct { long count, steps; double time, jump; } pg_instabilities;
typedef struct {                                       /* statistics of the run so far */
    long   steps, events, iterations, broken, bonds_over_limit;
    size_t degenerate_points, isolated_nodes, fragments, unended_cells;
    double degenerate_at[3];                           /* position of the first degenerate point, m */
    double utilisation_max, residual_max;              /* maxima over accepted steps */
    pg_misbalance balance;
    pg_energies   energy;
    pg_contact_report contact;
    pg_linear_report  linear;
    pg_instabilities  unstable;
    double seconds[PG_SECONDS_COUNT];
    pg_skip skipped[16];  size_t nskipped;
    char   warning[48][400]; size_t nwarning;          /* if there are more, the last one says so */
    /* reason why the run ended before its loads were reached, static text; NULL: see warnings */
    const char *ended_by;
} pg_statistics;
/* Adds a warning to the report unless the report contains the same text. */
void pg_statistics_warn_once (pg_statistics *report, const char *format, ...)
    __attribute__ ((format (printf, 2, 3)));
/* Tolerance of pg_misbalance: ten times the solver's residual, 1e-10, or the rounding of a factor with
 * penalty supports. */
double pg_balance_allowed (const pg_statistics *report, const pg_problem *problem);
void pg_statistics_warn (pg_statistics *report, const char *format, ...)
    __attribute__ ((format (printf, 2, 3)));
/* Adds the warnings before the first step: input that is legal but probably unintended, such as a body
 * without supports, and settings that were changed when the problem was built. pg_solver_create does so for
 * the report of its solver. */
void pg_solver_doubts (pg_statistics *report, const pg_problem *problem, const pg_solver_options *options);
/* Writes note k on the scene, such as keys ignored by its solver or force; returns 0 past the last. */
int pg_solver_note (const pg_problem *problem, const pg_solver_options *options, size_t k, char *out,
                    size_t size);
void pg_statistics_skip (pg_statistics *report, double seconds, const char *what, const char *why);

/* Record of a stage of loading at its end. */
typedef struct {
    int    done, reason;  /* done: 0: the run did not reach the stage's end; reason: code of `why` */
    /* "loads reached", "gauge", "drop of force", "events", "crack growth" or "end of the run" */
    const char *why;
    long   step, events;                               /* last step; number of events in the stage */
    double share;                                      /* fraction of the stage reached, 1: all */
    double strain, external, dissipated;               /* J, of the run so far */
    double growth;  /* crack growth by facets in the stage, m (3D: m^2) */
    double *gauge;                                     /* openings of all gauges, m */
} pg_stage_record;

typedef struct {  /* report of one step: a load level, a time step or an event */
    long   number, iterations;  /* break-and-solve rounds; time steps; iterations of relaxation */
    int    level;                                      /* 1: a level at which fields are to be written */
    int    event;                                      /* 1: bonds broke at this load (event stepping) */
    double stamp;  /* nondecreasing: the time, or the step number in event stepping */
    /* utilisation: maximum over intact bonds in the accepted state */
    double time, factor, residual, utilisation;
    size_t nbroken;  const pg_broken *broken;          /* borrowed until the next step */
    const double *reaction;  /* on the body, N, N m (PG_REACTIONS a load), borrowed */
    double dissipated;                                 /* J, in this step */
    /* event stepping: number of the instability to which the step belongs, 0: none; duration of motion so
     * far, s */
    long   instability; double motion;
    long   stage;  /* stage of loading, from 1; 0: the run has no stages */
    /* growth by facets: number of open tips (3D: fronts) that could not be evaluated at this load */
    long   unjudged;
} pg_step;

/* Values at a crack tip (2D) or at a vertex of a front (3D) in the state of the last step. NAN: not
 * measured. */
typedef struct {
    long   id;                                         /* id of the tip or front */
    size_t vertex;                                     /* index along the front, from 0 */
    double x[3];                                       /* m */
    double J, K[3], T;  /* J/m^2; Pa m^(1/2), modes I, II, III; T stress, Pa; at the load of the state */
    double uncertainty;                                /* relative uncertainty of J, from two domains */
    double utilisation;  /* energy released by growth over the energy required */
} pg_tip_values;
/* Values of a measurement f combined with factors l of its fields (pg_tip_combine); utilisation is NAN, and
 * all values are where f is NULL or has no integration ring. */
pg_tip_values pg_tip_values_of (long id, size_t vertex, const double *x, const pg_tip_field *f, int nfield,
                                const double *l);

/* ---- solver -------------------------------------------------------------------------------------------- */
typedef struct pg_solver pg_solver;
struct pg_progress;
struct pg_moved;                                       /* below: pg_solver_move */
struct pg_dynamics;              /* terms of a system matrix besides K: src/solve/run/solve.h */

/* An entry of the catalogue: src/solve/<name>.c. Functions may be NULL (nothing to do), except `step`. */
typedef struct {
    const char *name, *summary;
    unsigned flags;                                    /* PG_SOLVER_...: perigal/model.h */
    /* Tables of its keys below `solver`, its own and shared ones; the last is NULL. */
    const pg_key_table *keys[8];
    /* Reads its own options from the scene, after the common ones; errors are reported as errors of the
     * scene. */
    void      (*read)    (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
    pg_status (*prepare) (pg_solver *s);  /* at creation: fills in options left open */
    /* Before the first step, with shape functions evaluated: checks everything that may be refused; solves
     * nothing. */
    pg_status (*begin)   (pg_solver *s, const pg_state *state);
    pg_status (*start)   (pg_solver *s, pg_state *state);  /* after `begin`: prepares the first solve */
    pg_status (*step)    (pg_solver *s, pg_state *state, pg_step *step);
    int       (*done)    (const pg_solver *s, const pg_state *state);
    void      (*refused) (pg_solver *s);  /* a step failed: the state goes back to the last accepted one */
    void      (*free)    (pg_solver *s);
    /* Writes or reads checkpoints of its own data that persist between steps. */
    pg_status (*keep)    (pg_solver *s, const pg_keeper *keeper);
    /* Restores the data of a run whose points were divided among processes differently (pg_solver_move),
     * after the state. within 1: that run ended in the middle of a step, and the state is that of its start.
     * NULL: not supported. */
    pg_status (*move)    (pg_solver *s, pg_state *state, const struct pg_moved *moved, int within);
    double    (*progress) (const pg_solver *s, const pg_state *state); /* NULL: steps done of options.steps */
    /* Reports further possible ends of the run: progress_offer. */
    void      (*ends)    (const pg_solver *s, const pg_state *state, struct pg_progress *out);
    /* The largest stable time step, s, and *from: its source; NAN: not known. */
    double    (*stable)  (const pg_solver *s, const char **from);
    size_t    own_size;  /* bytes of its own data, initially zero; `free` frees its contents */
    /* Description of its steps in a plan: ", event stepping". NULL: none. */
    const char *(*manner) (const pg_solver_options *o);
    const struct pg_dynamics *(*dynamics) (pg_solver *s);              /* NULL: the matrix is K alone */
} pg_solver_type;
const pg_solver_type *pg_solver_find (const char *name);               /* NULL: unknown */

pg_status pg_solver_create (pg_solver **out, const pg_problem *problem, const pg_solver_options *options);
/* Creates a solver as pg_solver_create, with a force type of the caller (tests, experiments). */
pg_status pg_solver_create_with (pg_solver **out, const pg_problem *problem, const pg_solver_options *options,
                                 const pg_force_type *force);
void      pg_solver_free   (pg_solver **solver);
int       pg_solver_components (const pg_solver *solver);  /* dofs per node, for pg_state_create */
/* Does all preparation before the first step that may fail for the given input: shape functions, faces of
 * cracks and platens, masses. scene: receives errors (PG_E_SCENE), needed during this call only; NULL:
 * messages name keys only. state: start of the first step. A second call does nothing; pg_solver_step calls
 * it if necessary. */
pg_status pg_solver_begin  (pg_solver *solver, const pg_state *state, const pg_scene *scene);
/* Advances by one step. On a numerical failure the state is that of the last accepted step. */
pg_status pg_solver_step   (pg_solver *solver, pg_state *state, pg_step *step);
/* The loads of the run, adjusted for stages that ended early. */
const pg_load *pg_solver_loads (const pg_solver *solver);
/* Computes the potential energy, J, that n successive cuts would release at fixed loads: stage k cuts the
 * bonds of the stages before it and those of cut[k], which live in the state, ascending, each once. d: one
 * displacement in equilibrium at load factor t, or two (affine loads); release (n x 3): of d[0], mixed, of
 * d[1], J, so that sum_a w_a d_a releases w_0^2 r[0] + 2 w_0 w_1 r[1] + w_1^2 r[2]. anew: 1: by solving the
 * cut body every time; 0: by columns of the present inverse if there is a factor. The state is not
 * changed. */
pg_status pg_solver_release (pg_solver *solver, const pg_state *state, int nfield, const double *const *d,
                             const double *t, size_t n, const pg_changes *cut, int anew, double *release);
/* Cuts intact bonds (ascending) between two steps: their alive bits become 0, and later forces are those of
 * the remaining bonds; their energy counts as dissipated in the next step (not before the first step). They
 * are not counted as broken by a criterion. PG_E_USAGE: cracks grow by facets; or, after the first step,
 * event stepping and contact. */
pg_status pg_solver_cut    (pg_solver *solver, pg_state *state, const pg_changes *cut);
/* Callback between the rounds of breaking in a step. A status other than PG_OK is returned by pg_solver_step;
 * the state is then in the middle of the step, which the next call of pg_solver_step continues. */
typedef pg_status (*pg_watch) (void *context, const pg_state *state, const pg_step *so_far);
void      pg_solver_watch  (pg_solver *solver, pg_watch watch, void *context);
/* Writes or reads all data on which later steps depend, state included, also in the middle of a step. A
 * restored solver continues bit by bit (same machine, threads and libraries). PG_E_FILE: what is read back
 * cannot be of this problem. */
pg_status pg_solver_keep   (pg_solver *solver, pg_state *state, const pg_keeper *keeper);
/* Reader of data written by pg_solver_keep on ranks among which the points were divided differently. */
typedef struct pg_moved {
    void            *context;                          /* passed to the functions */
    const pg_keeper *alike;                            /* reads data that were equal on all ranks */
    /* Reads partial sums over the ranks' own points, added up: on rank 0 (or in a serial run); on other ranks
     * 0. */
    pg_status (*shares)   (void *context, const char *name, size_t n, double *value);
    /* Reads values of all points stored by this process: `components` numbers per point. */
    pg_status (*points)   (void *context, const char *name, size_t components, double *value);
    /* Reads values of selected unknowns of points stored here: `list` has their numbers (global point *
     * components + component), `name` rows of as many numbers, of which row `row` is read; other entries of
     * value are unchanged. */
    pg_status (*unknowns) (void *context, const char *list, const char *name, size_t row, size_t components,
                           double *value);
    /* Sets the alive bits of bonds that were broken after the last complete step to 0; others are
     * unchanged. */
    pg_status (*bonds)    (void *context, unsigned char *alive);
} pg_moved;
/* Restores a new solver and its state to the last complete step of a run with another division into ranks;
 * later results differ from those of an uninterrupted run by rounding only. All ranks call. PG_E_USAGE: not
 * supported by this solver, or in the present phase of the run. */
pg_status pg_solver_move   (pg_solver *solver, pg_state *state, const pg_moved *moved);
/* The state after the last complete step: `state`, or in the middle of a step the stored state of its
 * start. */
const pg_state *pg_solver_accepted (const pg_solver *solver, const pg_state *state);
/* Writes or reads a list of broken bonds in a checkpoint; PG_E_FILE: entries that are no bonds of the
 * problem. */
pg_status pg_broken_keep (const pg_problem *problem, const char *name, size_t n, pg_broken *broken,
                          const pg_keeper *keeper);
/* The options in use, in which dt, end, steps and stages left open are filled in. */
const pg_solver_options *pg_solver_settled (const pg_solver *solver);
/* Explicit solvers: the largest stable time step by the force's bound, s, and *from: its source; else NAN. */
double    pg_solver_stable (const pg_solver *solver, const char **from);
/* Largest eigenfrequency sqrt (K x / M x), rad/s, from below within about 1 %: explicit steps are stable up
 * to 2 / omega. */
pg_status pg_solver_fastest (pg_solver *solver, const pg_state *state, double *omega);
int       pg_solver_done   (const pg_solver *solver, const pg_state *state);
/* Progress of a run, relative to the nearest of its possible ends (event stepping cannot know which comes
 * first). */
typedef struct pg_progress {
    double      share;                                 /* fraction of `end` reached, 0 to 1 */
    /* "the load", "the time", "the time steps", "the stages", "max_events", "stop.damage" */
    const char *end;
    int         even;  /* 1: steps take about equal time, so that the time left can be extrapolated */
    int         event;                                 /* 1: event stepping */
    /* event stepping: secant stiffness (or compliance) over that of the first event; NAN: not known */
    double      stiffness;
    double      damage;  /* largest damage in solver.stop.set; NAN: no such set, or not evaluated */
} pg_progress;
void      pg_solver_progress (const pg_solver *solver, const pg_state *state, pg_progress *out);
/* Contact of a piece of crack, or of the surface opposite a platen, in the state of the last step: pressure
 * and shear stress (Pa) on the face on the side of its normal (2D: the left one), mean gap and slip (m).
 * Shear stress and slip are one number, along the path, in 2D, and vectors in 3D. */
typedef struct {
    size_t path, platen;                               /* 1 + number of the platen opposite; 0: a crack */
    double x[3], normal[3], area, length, arc, pressure, shear[3], gap, slip[3];
    pg_contact_status status;
} pg_contact_values;
/* Force of a rigid platen on the body in the state of the last step (N; moments about its `point`, N m), and
 * its translation (m) and rotation (rad); along and about x, y, z. */
typedef struct { double force[6], motion[6]; } pg_platen_values;
/* Values of all platens, in the order of problem->platen; *n: their number. Borrowed until the next step. */
const pg_platen_values *pg_solver_platens (const pg_solver *solver, size_t *n);
/* Contact values of all pieces, path by path; *n: their number, 0 without contact. Borrowed until the next
 * step. */
const pg_contact_values *pg_solver_contact (const pg_solver *solver, size_t *n);
/* Finds the contact stresses on the faces behind a tip of the state; returns 0: the run has no contact. */
int pg_solver_tip_faces (const pg_solver *solver, const pg_state *state, size_t tip, pg_tip_faces *out);
/* Finds the contact stresses on the faces behind all vertices of a 3D front (out: one per vertex); returns 0:
 * no contact. */
int pg_solver_front_faces (const pg_solver *solver, const pg_state *state, size_t front, pg_front_faces *out);
/* Values measured at the tip with that id; NULL: none. */
const pg_tip_values *pg_solver_tip (const pg_solver *solver, long id);
/* Values at all tips (3D: at all vertices of the fronts in the last step, front by front); *n: their number.
 * Borrowed. */
const pg_tip_values *pg_solver_tips (const pg_solver *solver, size_t *n);
/* Records of all stages of loading (*n); NULL: no stages. Borrowed. */
const pg_stage_record *pg_solver_stages (const pg_solver *solver, size_t *n);
/* The statistics, with fragments and overlap computed anew for the state. */
const pg_statistics *pg_solver_report (pg_solver *solver, const pg_state *state);
/* Parallel runs: sums energies and counts of the report over all ranks; to be called once, after the last
 * step. Serial runs: does nothing. */
pg_status pg_solver_share_report (pg_solver *solver);
const pg_statistics *pg_solver_report_now (const pg_solver *solver);  /* without new evaluation */
/* Adds a warning of the calling program to the report. */
void pg_solver_warn (pg_solver *solver, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
/* The force type of the solver, and its object *self, for fields and gauges. */
const pg_force_type *pg_solver_force (const pg_solver *solver, void **self);
const char *pg_solver_names (void);
/* Flags PG_SOLVER_... of a solver kind (NULL: of the default, the first in the list); 0: unknown. */
unsigned  pg_solver_flags (const char *kind);
/* Returns 1: the solver kind has all of these flags (with a scene: pg_scene_entry_is). */
int       pg_solver_is (const char *kind, unsigned flags);
/* Coefficients b0 .. b7 of Newmark's method (doc/method.md F5) for dt, beta, gamma of the options. */
void pg_newmark_coefficients (const pg_solver_options *options, double *b);
PG_API_END
#endif
