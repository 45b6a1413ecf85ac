/* SPDX-License-Identifier: GPL-3.0-or-later
 * solve.h: methods that advance a state, the break loop, what a step and a run report.
 * Catalogue: src/solve/<name>.c + one line in list.h. Cui 2022 section 3.2; theory F5, F6. */
#ifndef PERIGAL_SOLVE_H
#define PERIGAL_SOLVE_H
#include "perigal/contact.h"

PG_API_BEGIN

/* PASSING (stages): at any iteration once the stage's load has come to act, not only in balance. FACET: tips
 * are judged, not bonds, and all bonds that a facet crosses break at once. */
typedef enum { PG_BREAK_WORST, PG_BREAK_FRACTION, PG_BREAK_ALL, PG_BREAK_PASSING, PG_BREAK_FACET } pg_break;
/* Event stepping, bonds being over their limit after an event at an unchanged load: the load falls to where
 * they are at it; it stays and they break, the worst first; it stays and the body moves until it is at
 * rest. */
typedef enum { PG_UNSTABLE_FOLLOW, PG_UNSTABLE_HOLD, PG_UNSTABLE_DYNAMIC } pg_unstable;
/* Options common to all methods. What one method or family of methods knows alone is a struct of its own in
 * `own`: PG_OWN (pg_newmark_options, options)->alpha. */
enum { PG_SOLVER_OWN = 128 };
typedef struct {
    char     kind[32], linear[16];  /* an entry of src/solve; "auto" or an entry of src/linalg */
    char     preconditioner[16];  /* of linear: pcg; auto | jacobi | multilevel; "": auto */
    unsigned flags;                                    /* of the kind, PG_SOLVER_...: perigal/model.h */
    int      event;                                    /* steps go from break to break (PG_SOLVER_EVENTS) */
    pg_unstable on_instability;                        /* event stepping: growth at an unchanged load */
    pg_break break_mode;
    int      plain;                                    /* 1: no shortcuts; as problem->plain */
    double   break_fraction, tie;  /* bonds within this share of the worst break with it */
    double   facet;  /* break: facet: length of a facet, m; 0: the local spacing */
    int      branching;                                /* break: facet, in motion: tips may branch */
    double   tolerance;                                /* of the residual, relative to the reference force */
    /* steps: calls of pg_solver_step up to the end; 0: the solver finds it when it is made */
    long     steps, max_iterations, max_events;
    long     time_steps;                               /* of explicit dynamics; 0: by dt and end */
    long     rows;  /* most rows of history.csv, 0: by the number of time steps */
    double   dt, end;                                  /* s; dt 0: 0.9 of the stable time step */
    /* stop when a point of the set is damaged so far; NULL: never */
    const pg_set *stop_set; double stop_damage;
    pg_contact_setting contact;                        /* of crack faces (PG_SOLVER_CONTACT) */
    long     levels;  /* reports at k / levels of the load (or of the end time) */
    char     unused[256];  /* keys of the scene's solver that belong to others, "dt, end" */
    union { double align; unsigned char byte[PG_SOLVER_OWN]; } own;    /* of the method alone: PG_OWN */
    /* that they were read from: pg_solver_create places there what it finds wrong; NULL: none */
    const pg_scene *scene;
} pg_solver_options;
/* The options of that type in `own`: constant where the options are (a pointer to const gives a pointer to
 * const). A type that does not fit in `own` does not compile. The inner choice only gives each branch a
 * pointer of its own kind, as both must be valid C whichever is taken. */
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
typedef struct {                                       /* Newmark's method; 1, 1, 1, 1/s, s */
    int    consistent;                                 /* consistent mass, not lumped */
    double alpha, beta, gamma, rayleigh_mass, rayleigh_stiffness;
} PG_ALIAS pg_newmark_options;
typedef struct {                                       /* equilibria by linear systems */
    int    affine;                                     /* event stepping: loads have a constant part */
    long   steps;                                      /* fixed load steps, of each stage of loading */
    double stop_stiffness;  /* event stepping: stop when the secant stiffness fell below it */
    pg_newmark_options motion;                         /* with PG_UNSTABLE_DYNAMIC */
    /* s; 0: by the fastest wave. quiet: so long without a break, then what moves is damped away */
    double dt, quiet, longest;
} PG_ALIAS pg_static_options;
typedef struct { double rayleigh_mass; } PG_ALIAS pg_explicit_options;      /* explicit dynamics; 1/s */
typedef struct {                                       /* stages of the load, each relaxed */
    long   stages;
    int    hold;  /* 1: each until it is balanced, 0: one iteration a stage */
    double imbalance;                                  /* accepted residual over the reference force */
    double damping;                                    /* kg/(m^3 s); 0: by Rayleigh's quotient */
} PG_ALIAS pg_stages_options;
pg_status pg_solver_options_read (pg_solver_options *out, const pg_problem *problem, const pg_scene *scene);

/* ---- patch test ---------------------------------------------------------------------------------------- */
/* Measures problem->patch, once: the bare body (pg_problem_bare) under the tractions of each independent
 * uniform stress, by conjugate gradients that begin at the best linear field and end when they gain nothing
 * more, or when they have cost what a run should not notice. Without facets the outermost points are held
 * instead. From PG_PATCH_WARNED on, and of rigid motions that strain from PG_RIGID_WARNED on,
 * pg_solver_doubts warns, over PG_PATCH_REFUSED pg_patch_refuse refuses. What the supports of the scene add
 * is not in it, a fifth to a half of the error: so that a warning comes before 5 % in a scene, the
 * threshold here is 4 %. A turn a hundred times the strains leaves an error of one per cent of them from
 * the other one on. */
#define PG_PATCH_WARNED 0.04
#define PG_RIGID_WARNED 1e-4
#define PG_PATCH_REFUSED 0.5
pg_status pg_patch_probe (pg_problem *problem);
/* PG_E_SCENE with what was measured that no run should go by: too large an error, unless
 * method.accept_inexact says yes, or more than a quarter of the points without a strain. */
pg_status pg_patch_refuse (const pg_problem *problem, const pg_scene *scene);
const char *pg_patch_state (const pg_problem *problem);                            /* "xx", "xy" ... */
/* How far off, and by what; what to do about it. */
void      pg_patch_words  (const pg_problem *problem, char *out, size_t size);
void      pg_patch_place  (const pg_problem *problem, const double *x, char *out, size_t size);
void      pg_patch_remedy (const pg_problem *problem, char *out, size_t size);

/* ---- strength where cracks begin
 * ------------------------------------------------------------------------ */
/* Of a material with growth by facets: the tensile strength of the scene and the one in use, which the
 * spacing limits to sqrt (E G0 / 8 h), Pa; the zone E G0 / f_t^2 in which it fails, m; the same of a
 * cohesion. NAN: not given. */
typedef struct { double asked, in_use, zone, cohesion, cohesion_in_use, shear_zone; } pg_strength;
/* 0: the material has neither. */
int       pg_strength_of (const pg_problem *problem, size_t material, pg_strength *out);

/* ---- what happened ------------------------------------------------------------------------------------- */
/* time: s; quasi-static: load factor; utilisation NAN: not known; round: of breaking within the step */
typedef struct { size_t bond; int set; char kind; double utilisation, place[3], time; long round; } pg_broken;

enum {
    PG_SECONDS_SHAPE,
    PG_SECONDS_ANALYSE,
    PG_SECONDS_FACTOR,
    PG_SECONDS_SOLVE,
    PG_SECONDS_FORCE,
    PG_SECONDS_BREAK,
    PG_SECONDS_ASSEMBLE,
    PG_SECONDS_UPDATE,  /* shapes and rows that breaks have touched */
    PG_SECONDS_COUNT
};
typedef struct { char what[96], why[160]; double seconds_saved; } pg_skip;
/* ---- parts of the report of a run ---------------------------------------------------------------------- */
/* J; external work, damping, what breaking dissipated, what cracks that grew should have taken (fracture
 * energy times new area) so far; strain and kinetic energy and that of short-range contact now; what friction
 * of crack faces has taken. */
typedef struct {
    double strain, kinetic, external, damping, dissipated, contact, friction, fracture;
} pg_energies;
/* What loads, reactions, inertia and damping miss of balance: the largest sum of forces over that of their
 * sizes, of moments over that times the body's diagonal; in how many states (0: not measured). */
typedef struct { double force, moment; long states; } pg_misbalance;
/* Contact of crack faces, and short-range contact. */
typedef struct {
    /* right-hand sides for the compliance of pieces, dense solves, changes of status on the way, all of the
     * run; seconds of them */
    long   columns, solves, changes;
    double seconds;
    /* in the state last solved for: pieces, and how they stand; passes and sweeps that this took */
    long   pieces, open, stick, sliding, passes, sweeps;
    double overlap;                                    /* largest overlap of a mean gap over the run, m */
    /* short-range contact in the last state: pairs without a bond that are near each other; that touch */
    long   pairs, touching;
    double overlap_max;                                /* over accepted steps, m */
} pg_contact_report;
/* What linear systems took: factors and updates of them, solves, multilevel preconditioners made, iterations
 * of conjugate gradients; entries of the factor and what it took; by which ordering, solver,
 * preconditioner. */
typedef struct {
    long   factorizations, updates, solves, preconditioners;
    size_t cg_iterations;
    double factor_entries, factor_flops;
    char   ordering[16], solver[16], preconditioner[128];
} pg_linear_report;
/* Event stepping where growth went on by itself: how often, steps of it (events at a held load, or time
 * steps), s in motion, and the largest jump of a reaction at the begin or end of a motion, over the largest
 * reaction. */
typedef struct { long count, steps; double time, jump; } pg_instabilities;
typedef struct {                                       /* of the run so far */
    long   steps, events, iterations, broken, bonds_over_limit;
    size_t degenerate_points, isolated_nodes, fragments, unended_cells;
    double degenerate_at[3];                           /* where the first of degenerate_points is, m */
    double utilisation_max, residual_max;              /* over accepted steps */
    pg_misbalance balance;
    pg_energies   energy;
    pg_contact_report contact;
    pg_linear_report  linear;
    pg_instabilities  unstable;
    double seconds[PG_SECONDS_COUNT];
    pg_skip skipped[16];  size_t nskipped;
    char   warning[48][400]; size_t nwarning;          /* where they are more the last one says so */
    /* what ended the run before its loads were reached, static text; NULL: see warnings */
    const char *ended_by;
} pg_statistics;
/* Adds a warning to the report unless the report has these words already. */
void pg_statistics_warn_once (pg_statistics *report, const char *format, ...)
    __attribute__ ((format (printf, 2, 3)));
/* What forces and moments may miss of balance: ten times what the solver leaves, 1e-10, or what a factor with
 * the penalty of a support leaves. */
double pg_balance_allowed (const pg_statistics *report, const pg_problem *problem);
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

/* What was at the end of a stage of loading. */
typedef struct {
    int    done, reason;                               /* 0: the run did not come to its end */
    /* "loads reached", "gauge", "drop of force", "events", "crack growth" or "end of the run" */
    const char *why;
    long   step, events;                               /* last step; events in it */
    double share;                                      /* of its way, 1: all of it */
    double strain, external, dissipated;               /* J, of the run so far */
    double growth;  /* of cracks by facets in it, m (in space m^2) */
    double *gauge;                                     /* openings of all gauges, m */
} pg_stage_record;

typedef struct {  /* of one step: a user level, a time step or an event */
    long   number, iterations;  /* break-and-solve rounds; time steps; iterations of relaxation */
    int    level;                                      /* 1: a level at which the user wants fields */
    int    event;                                      /* 1: bonds broke at this load (event stepping) */
    double stamp;  /* never falls: the time; the step number under event stepping */
    /* utilisation: largest of a live bond in the accepted state */
    double time, factor, residual, utilisation;
    size_t nbroken;  const pg_broken *broken;          /* borrowed until the next step */
    const double *reaction;  /* on the body, N, N m (PG_REACTIONS a load), borrowed */
    double dissipated;                                 /* J, in this step */
    /* event stepping: number of the instability that the step is part of, 0: none; s in motion so far */
    long   instability; double motion;
    long   stage;  /* of loading, from 1; 0: the run has none */
    /* with growth by facets: open tips, in space fronts, that nothing judged at this load */
    long   unjudged;
} pg_step;

/* What was measured last at the tip of a crack in the plane, or at a vertex of a front in space, in the state
 * of the last step. NAN: not measured. */
typedef struct {
    long   id;                                         /* of the tip or front */
    size_t vertex;                                     /* 0.. along the front */
    double x[3];                                       /* m */
    double J, K[3], T;  /* J/m^2, Pa m^(1/2) of mode I, II, III, Pa; J and K at the load of the state */
    double uncertainty;                                /* of J, relative: by two domains */
    double utilisation;                                /* energy that growth releases over what it takes */
} pg_tip_values;
/* They from a measurement, for the factors l of its fields (pg_tip_combine); nothing is known of the
 * utilisation, nor of anything where f is NULL or has no room. */
pg_tip_values pg_tip_values_of (long id, size_t vertex, const double *x, const pg_tip_field *f, int nfield,
                                const double *l);

/* ---- solver -------------------------------------------------------------------------------------------- */
typedef struct pg_solver pg_solver;
struct pg_progress;
struct pg_moved;                                       /* below: pg_solver_move */
struct pg_dynamics;              /* what a matrix holds besides K: src/solve/run/solve.h */

/* An entry of the catalogue: src/solve/<name>.c. Entries that are NULL: nothing to do, but for `step`. */
typedef struct {
    const char *name, *summary;
    unsigned flags;                                    /* PG_SOLVER_...: perigal/model.h */
    /* Tables of its keys below `solver`, its own and those that several share; the last one NULL. */
    const pg_key_table *keys[8];
    /* Its part of the options from the scene; what is wrong becomes a fault. The common part is there
     * already. */
    void      (*read)    (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
    pg_status (*prepare) (pg_solver *s);  /* when the solver is made: fills in what options leave open */
    /* Before the first step, shape functions being made: what can be refused is, and nothing is solved. */
    pg_status (*begin)   (pg_solver *s, const pg_state *state);
    pg_status (*start)   (pg_solver *s, pg_state *state);              /* then: what it takes to solve */
    pg_status (*step)    (pg_solver *s, pg_state *state, pg_step *step);
    int       (*done)    (const pg_solver *s, const pg_state *state);
    void      (*refused) (pg_solver *s);  /* a step failed: the state goes back to the last accepted one */
    void      (*free)    (pg_solver *s);
    /* What it carries from step to step, written to or read from a checkpoint. */
    pg_status (*keep)    (pg_solver *s, const pg_keeper *keeper);
    /* Takes over what a run kept whose points were divided among processes otherwise (pg_solver_move); the
     * state is there already. within 1: that run ended in the middle of a step, whose start the state is.
     * NULL: this solver cannot. */
    pg_status (*move)    (pg_solver *s, pg_state *state, const struct pg_moved *moved, int within);
    double    (*progress) (const pg_solver *s, const pg_state *state); /* NULL: steps done of options.steps */
    /* Other ends that a run may come to: progress_offer. */
    void      (*ends)    (const pg_solver *s, const pg_state *state, struct pg_progress *out);
    /* The largest stable time step, s, and *from what; NAN: not known. */
    double    (*stable)  (const pg_solver *s, const char **from);
    size_t    own_size;  /* bytes of its own state, zero at first; `free` frees what is in it */
    /* How a plan calls its steps: ", event stepping". NULL: nothing to say. */
    const char *(*manner) (const pg_solver_options *o);
    const struct pg_dynamics *(*dynamics) (pg_solver *s);              /* NULL: the matrix is K alone */
} pg_solver_type;
const pg_solver_type *pg_solver_find (const char *name);               /* NULL: unknown */

pg_status pg_solver_create (pg_solver **out, const pg_problem *problem, const pg_solver_options *options);
/* Makes a solver as pg_solver_create does, with a force of the caller's (tests, experiments). */
pg_status pg_solver_create_with (pg_solver **out, const pg_problem *problem, const pg_solver_options *options,
                                 const pg_force_type *force);
void      pg_solver_free   (pg_solver **solver);
int       pg_solver_components (const pg_solver *solver);  /* dofs per node, for pg_state_create */
/* Everything that a run does before its first step and that can be refused: shape functions, faces of cracks
 * and platens, masses. With a scene, which must live for this call only, faults are placed in it
 * (PG_E_SCENE); NULL: messages name keys alone. The state is the one that the first step starts from; a
 * second call does nothing, and pg_solver_step makes up for a missing one. */
pg_status pg_solver_begin  (pg_solver *solver, const pg_state *state, const pg_scene *scene);
/* Advances by one step. On a numerical failure the state is that of the last accepted step. */
pg_status pg_solver_step   (pg_solver *solver, pg_state *state, pg_step *step);
/* The loads as the run has them: of stages that ended early so far as they came. */
const pg_load *pg_solver_loads (const pg_solver *solver);
/* The potential energy, J, that n stages of a cut would set free at fixed loads: stage k cuts the bonds
 * of the stages before it and those of cut[k], which live in the state, ascending, each once. d: one
 * displacement in equilibrium at load factor t, or two (affine loads); release (n x 3): of d[0], mixed,
 * of d[1], so that sum_a w_a d_a releases w_0^2 r[0] + 2 w_0 w_1 r[1] + w_1^2 r[2]. anew: 1: by solving
 * the cut body every time; 0: by columns of the inverse at hand where there is a factor. The state stays
 * as it is. */
pg_status pg_solver_release (pg_solver *solver, const pg_state *state, int nfield, const double *const *d,
                             const double *t, size_t n, const pg_changes *cut, int anew, double *release);
/* Cuts live bonds (ascending) between two steps: their alive bits become 0, and forces from now on are those
 * of the bonds that are left; the energy that they held counts as dissipated in the next step. Bonds cut
 * before the first step were never there. They are not counted as broken and no criterion has judged them.
 * PG_E_USAGE: cracks grow by facets; or, after the first step, event stepping and contact. */
pg_status pg_solver_cut    (pg_solver *solver, pg_state *state, const pg_changes *cut);
/* Called between the break rounds of a step, with the state and the step so far. A status other than PG_OK
 * ends pg_solver_step with it; the state is then one in the middle of the step, from which pg_solver_step
 * goes on when it is called again. */
typedef pg_status (*pg_watch) (void *context, const pg_state *state, const pg_step *so_far);
void      pg_solver_watch  (pg_solver *solver, pg_watch watch, void *context);
/* Writes or reads back all that later steps depend on, state included, also in the middle of a step. A solver
 * read back goes on bit by bit as the written one would have (same machine, threads and libraries).
 * PG_E_FILE: what is read back cannot be of this problem. */
pg_status pg_solver_keep   (pg_solver *solver, pg_state *state, const pg_keeper *keeper);
/* Reads back what was kept (pg_solver_keep) by ranks among which the points were divided in another way. */
typedef struct pg_moved {
    void            *context;                          /* passed to the functions */
    const pg_keeper *alike;                            /* reads what all of them knew alike */
    /* Sums of what each had of its own points: on rank 0, and where this process has all points; on other
     * ranks 0. */
    pg_status (*shares)   (void *context, const char *name, size_t n, double *value);
    /* Of each point that this process holds, what its owner had: `components` numbers a point. */
    pg_status (*points)   (void *context, const char *name, size_t components, double *value);
    /* Values of single unknowns of points held here, as their owners had them. They were kept as a `list` of
     * whole numbers, number of the point times `components` plus component, and as rows `name` of as many
     * numbers, of which `row` is asked for; all others of value stay as they are. */
    pg_status (*unknowns) (void *context, const char *list, const char *name, size_t row, size_t components,
                           double *value);
    /* Bonds that were dead when the last step was made get the alive bit 0; the others keep theirs. */
    pg_status (*bonds)    (void *context, unsigned char *alive);
} pg_moved;
/* Brings a solver that has not begun, and the state that it would start from, to where such a run was when
 * its last step was made: on from there, results differ from those of an undisturbed run by rounding alone.
 * All ranks call. PG_E_USAGE: this solver cannot, or the run was in the middle of what cannot be moved. */
pg_status pg_solver_move   (pg_solver *solver, pg_state *state, const pg_moved *moved);
/* The state when the last step was made: `state`, or in the middle of a step the one kept for its start. */
const pg_state *pg_solver_accepted (const pg_solver *solver, const pg_state *state);
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
typedef struct pg_progress {
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
/* Contact of a piece of crack, or of the surface opposite a platen, in the state of the last step: pressure
 * and shear stress (Pa) on the face that its normal shows to (plane: the left one), mean gap and slip (m).
 * Shear stress and slip are one number, along the path, in the plane, and vectors in space. */
typedef struct {
    size_t path, platen;                               /* 1 + number of the platen opposite; 0: a crack */
    double x[3], normal[3], area, length, arc, pressure, shear[3], gap, slip[3];
    pg_contact_status status;
} pg_contact_values;
/* What a rigid platen exerts on the body in the state of the last step (N; moments about its `point`, N m),
 * and how it has moved (m) and turned (rad); along and about x, y, z. */
typedef struct { double force[6], motion[6]; } pg_platen_values;
/* Platen by platen, as problem->platen; *n 0: there are none. Borrowed until the next step. */
const pg_platen_values *pg_solver_platens (const pg_solver *solver, size_t *n);
/* Piece by piece, path by path; *n: how many, 0 without contact. Borrowed until the next step. */
const pg_contact_values *pg_solver_contact (const pg_solver *solver, size_t *n);
/* What the faces behind a tip of the state do to each other, with contact; 0: the run has none. */
int pg_solver_tip_faces (const pg_solver *solver, const pg_state *state, size_t tip, pg_tip_faces *out);
/* What faces do to each other behind all vertices of a front in space (out: one of each); 0: no contact. */
int pg_solver_front_faces (const pg_solver *solver, const pg_state *state, size_t front, pg_front_faces *out);
/* What the solver has measured at the tip of that id; NULL: nothing. */
const pg_tip_values *pg_solver_tip (const pg_solver *solver, long id);
/* At all tips; in space at the vertices of the fronts in the last step, front by front; *n: how many.
 * Borrowed. */
const pg_tip_values *pg_solver_tips (const pg_solver *solver, size_t *n);
/* Of every stage of loading (*n of them); NULL: none. Borrowed. */
const pg_stage_record *pg_solver_stages (const pg_solver *solver, size_t *n);
/* with a fresh census and overlap */
const pg_statistics *pg_solver_report (pg_solver *solver, const pg_state *state);
/* Ranks that share a run: energies and counts of the report become those of all of them, once, when no step
 * follows; nothing alone. */
pg_status pg_solver_share_report (pg_solver *solver);
const pg_statistics *pg_solver_report_now (const pg_solver *solver);  /* counts and energies only */
/* Adds a warning to the report, of those who use the solver. */
void pg_solver_warn (pg_solver *solver, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
/* The force behind it, for fields and gauges. */
const pg_force_type *pg_solver_force (const pg_solver *solver, void **self);
const char *pg_solver_names (void);
/* The flags of a kind (NULL: of the first in the list, the default); 0: unknown. */
unsigned  pg_solver_flags (const char *kind);
/* 1: it has all of these flags. Where the scene is at hand, pg_scene_entry_is tells as much. */
int       pg_solver_is (const char *kind, unsigned flags);
/* b0..b7 of Newmark's method (theory F5) for dt, beta, gamma of the options. */
void pg_newmark_coefficients (const pg_solver_options *options, double *b);
PG_API_END
#endif
