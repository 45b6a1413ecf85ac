/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the linear system of a force, the break loop, the solver object and its methods. */
#ifndef PG_SOLVE_PRIVATE_H
#define PG_SOLVE_PRIVATE_H
#include "perigal/solve.h"

/* ---- system.c: equilibrium of a force at given alive bits ---------------------------------------------- */
typedef struct pg_dynamics {  /* what inertia and damping add to the equations; pointer NULL: static */
    double k, m;                                       /* matrix = k K + m M */
    /* length of the time step, s; INFINITY: no physical time, steps only lead to an equilibrium */
    double dt;
    /* Adds inertia and damping at d to the residual of the equations; raises *reference to their size, N. */
    void (*add) (void *context, const double *d, double *residual, double *reference);
    /* residual -= M a + C v at d: what reactions contain of the motion */
    void (*resist) (void *context, const double *d, double *residual);
    /* x -= what the equations leave unbalanced at the end of the step, over all unknowns, where they weigh
     * forces of two times (alpha method). NULL: nothing. */
    void (*leave) (void *context, const double *d, double *x);
    /* x = d + c_K v, v being the velocity that belongs to d: as forces are linear, the residual at x includes
     * the damping by stiffness, which `add` then leaves out. Returns 0, x unfilled, where there is no such
     * damping. */
    int  (*join) (void *context, const double *d, double *x);
    double contact;  /* contact force in the equations over its mean in the step, 1 / (2 beta) */
    int    whole;  /* 1: the residual of the equations is P - F_int - M a - C v, as reactions need it */
    void  *context;
} dynamics;

/* How the linear systems are solved; TRIAL: not known yet, a few iterations are tried first. */
enum {
    SYSTEM_UNDECIDED, SYSTEM_TRIAL, SYSTEM_FACTOR, SYSTEM_KEPT_FACTOR, SYSTEM_NO_FACTOR,
    SYSTEM_DIAGONAL                                    /* no factor, and no better preconditioner either */
};

/* Corrections x of the last steps and the changes y of the residual that they made (first_guess.c): rings
 * of GUESS_PAIRS + 1 vectors of ndof; the n before `next` are complete. fresh 1: all y belong to the
 * present K. */
enum { GUESS_PAIRS = 5 };
typedef struct { double *x, *y; int n, next, fresh; } pg_guess;

/* An earlier iterate serves for comparison if its residual is about this many times that of the last one. */
enum { ROUGHER = 10 };
/* A kept iterate of an inexact solve: its residual over the first one, its correction delta (nred), the
 * utilisation u of the bonds of candidate list number `list` by it (0: none yet). */
typedef struct { double residual, *delta, *u; size_t room; long list; } pg_rough_view;
enum { ROUGH_VIEWS = 8 };
/* Inexact solutions, which need to show only which bonds break (rough_round.c). */
typedef struct {
    /* residual over the first one at which the solve at hand ends, an earlier iterate being kept; 0: none
     * is */
    double  goal;
    int     found;                                     /* 1: the solve has met the earlier iterate */
    double *earlier;                                   /* delta of the earlier iterate (nred) */
    double *before;  /* displacement of the earlier iterate (ndof) */
    double *earlier_u; size_t room_u;  /* utilisation by the earlier iterate of bonds near the limit */
    double  share;  /* goal of the next inexact solve; 0: not set yet; below 0: no inexact solves */
    long    rounds, again;                             /* inexact solutions that sufficed; that did not */
    /* preconditioner by finite elements: called after each iteration, *stop = 1 ends the solve; NULL: not
     * called */
    pg_status (*look) (void *looking, double residual, int *stop);
    void   *looking;
    pg_rough_view view[ROUGH_VIEWS]; long nview;       /* the last iterates kept; how many so far */
} pg_rough;

/* Choice between a factor and finite elements in dynamics (factor_or_elements.c); seconds are estimated by
 * stored rates. */
typedef struct {
    int    meanwhile;  /* 1: finite elements precondition in place of a factor */
    double regret;                                     /* s that the other method would have saved so far */
    double iterations;  /* mean iterations of a solve with elements; 0: not known */
    double breaking, bonds;  /* s spent on correcting factors for broken bonds; number of these bonds */
    double fresh;                                      /* bonds that broke since the last solve */
    double spent;                                      /* cost of the corrections when last looked at, s */
    /* number of solves with finite elements as preconditioner, in place of a factor */
    long   solves;
} pg_ways;

/* The matrix k K + m M as it was last factored, and its factor. */
typedef struct {
    const pg_linear_type *linear;
    void     *factor;
    int       stale;                                   /* 1: K has changed since it was factored */
    unsigned long revision;  /* version of K, as the force counts it, at the last refresh */
    /* Matrix to be factored, until the factor is made: K itself, its pattern with the values `copy`, or
     * (owned 1) K reduced by constraints. own_diagonal: that of K while that of A stands in its place, else
     * NULL. */
    pg_sparse A; int owned;
    double   *copy, *own_diagonal;
    /* Springs as stiff as the mean diagonal that tie unknowns of freely moving parts to target displacements,
     * m; they are meant to carry no force; borrowed. */
    struct { size_t n; const size_t *unknown; const double *target; } props;
    int       forgotten;  /* 1: K was freed once it was factored */
    double   *diagonal0, mean_diagonal;                /* diagonal of the first K, N/m (ndof); its mean */
    double    shift;  /* spring on the diagonal of weak unknowns, over mean_diagonal */
    unsigned char *touched; int marked;  /* 1: pre-cracks touched this node (n); marked 1: found */
    int       unshifted, all_weak;                     /* all_weak: every unknown gets the shift (touched) */
    int       loose;  /* 1: K was found to leave parts free to move */
    int       indefinite;  /* K proved not positive definite: another linear solver took over */
    const unsigned char *alive;                        /* alive bits of the last refresh, borrowed */
    unsigned char *factored;  /* alive bits when the factor or preconditioner was made */
    /* Cracks of the last refresh, and when `factored` was taken: cells cut by cracks depend on them as well
     * (consistent integration). NULL: cracks do not grow. */
    pg_crack_paths *paths, *factored_paths;
} system_factor;

/* How long a factor serves while bonds break. */
typedef struct {
    int       serves;  /* 1: set before the first solve: one factor is to serve many events */
    /* 1: the factor is the base of an event solver, which uses it whatever has broken since */
    int       base;
    long      by_columns;  /* equilibria found by an event solver without a new factor */
    /* dynamics: inverse that follows breaking since the factor was made; or NULL */
    struct inverse *following;
} system_updates;

/* Conjugate gradients: preconditioners, workspaces, first guesses. */
typedef struct {
    pg_multilevel *multilevel;                         /* multilevel preconditioner; NULL: none (yet) */
    /* preconditioner by finite elements; NULL: not used, or not made yet */
    pg_element_preconditioner *elements;
    void     *amg;  /* preconditioner of ranks that share the body; NULL: not used, or not made yet */
    /* preconditioner of ranks that share a small body; NULL: not used or made */
    struct shared_factor *whole_factor;
    unsigned char *bare;  /* ranks: unknowns without any stiffness left (ndof); NULL: not asked for */
    unsigned char *hanging;                            /* nodes that springs hold in iterations (n) */
    double   *whole;  /* x of a product K x, ghosts included (ndof), where ranks share the body; else NULL */
    double    made[2];                                 /* k and m for which the preconditioner was made */
    pg_operator  inertia; pg_couplings stiffness;      /* ranks, dynamics: k K + m M; rows of K */
    pg_cg_room cg_room;  /* workspace of conjugate gradients, kept between solves */
    int      *own_row;  /* with elements only: the full unknown of each reduced one (nred) */
    unsigned char *fixed;  /* 1: constraints eliminate this unknown (ndof); NULL: not found yet */
    int       precondition;  /* found with `fixed`: 1: the constraints allow a multilevel preconditioner */
    int       remake;  /* 1: read from a checkpoint: the preconditioner is to be made from `factored` */
    double    fell;  /* last over first residual of the last solve by iterations */
    /* - log of the residual's reduction by one iteration with a new preconditioner; 0: not known */
    double    pace;
    size_t    matrix_iterations;
    pg_guess  guess;
    pg_rough  rough;
} system_iterations;

/* Residual of a state, and the forces that it is made of and compared with. */
typedef struct {
    double   *residual, *reduced, *delta, *full, *best, *scratch;
    const double *excavated;  /* statics: forces that removed parts still exert, N (ndof); NULL: none */
    const double *held;  /* forces that opening facets still carry, N (ndof); NULL: none */
    const double *pressed;  /* contact forces as they enter the equations, N (ndof); NULL: none */
    /* of the state measured last, N: reference force; norm of the out-of-balance force */
    double    reference, unbalanced;
    /* N, what the residual of that state was divided by: the reference, or forces of rounding */
    double    scale;
    double    borne;  /* the largest reference of an accepted state of fixed load steps, N */
    /* Statics: size of the loads and of what prescribed displacements alone exert at t = loaded_at, N; lever:
     * how much larger the reactions that balance them can be; 0: not known yet. */
    double    loaded, loaded_at, lever;
    struct body_parts *floating;  /* parts that move freely under loads that balance; NULL: none */
    int       carried;  /* 1: the last iterations have updated `residual` to the state that they lead to */
    int       known;  /* 1: `residual` is that of the state last solved for */
    int       at_hand;  /* 1: `residual` is that of the same displacements after the last round of breaking */
    long      unmeasured;  /* states accepted by updated, not measured, residuals */
} system_balance;

/* How linear systems are solved, and what that has cost. */
typedef struct {
    int       mode;                                    /* method of solving, SYSTEM_... */
    long      spared;                                  /* solves by the factor of an earlier K */
    long      kept;                                    /* number of refreshes that left K as it was */
    /* s (with the multilevel preconditioner: iterations) that a new factor would have spared */
    double    extra_cost;
    double    columns;  /* right-hand sides that every new K is solved with beside the loads */
    int       begins;                                  /* 1: the next solve is the first of a step */
    pg_ways   ways;
} system_choice;

struct pg_system;
/* Contact, as a client of the linear system: forces that depend on the displacement (contact.h). */
typedef struct {
    void      (*free)    (struct pg_system *s);
    /* Called after the force was refreshed for these changes; NULL: for all bonds. */
    pg_status (*refresh) (struct pg_system *s, const pg_state *state, const pg_changes *changes);
    /* Takes the place of system_solve, with its arguments. */
    pg_status (*solve)   (struct pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
    /* Statics. account: adds the part of contact to the energies and to the reactions of loads. book: returns
     * the work of contact since the state that was booked last, loads scaled, J. */
    void      (*account) (const struct pg_system *s, pg_work_balance *balance);
    double    (*book)    (struct pg_system *s, double scale);
    /* save: called at the start of a step; restore: called where the step is refused. */
    pg_status (*save)    (struct pg_system *s);
    void      (*restore) (struct pg_system *s);
} system_client;

typedef struct pg_system {
    const pg_problem    *problem;
    const pg_force_type *force;
    void                *self;
    const pg_solver_options *options;
    pg_statistics           *report;
    int       components;
    size_t    ndof, nred;
    double   *mass;                                    /* lumped mass per unknown, kg (ndof) */
    const pg_sparse *M;                                /* consistent mass matrix, or NULL */
    system_balance    balance;
    system_factor     direct;
    system_updates    updates;
    system_iterations iterative;
    system_choice     choice;
    const system_client   *client;                     /* methods of contact; NULL: no contact */
    struct system_contact *contact;                    /* contact of crack faces, platens; NULL: none */
} pg_system;
/* shared_system.c: for ranks that share the body. Sums and maxima over ranks return their argument where one
 * process has the whole body. */
int       system_is_shared (const pg_system *s);
pg_status system_exchange  (const pg_system *s, double *d);
void      system_clear_ghosts (const pg_system *s, double *force);
double    system_sum       (const pg_system *s, double mine);
double    system_most      (const pg_system *s, double mine);
double    system_norm      (const pg_system *s, const double *force, size_t n);
double    system_norm_owned (const pg_system *s, const double *weight, const double *d);
void      system_multiply_shared (const pg_system *s, const pg_operator *op, const double *x, double *y);
pg_status system_make_shared  (pg_system *s, double k, double m);      /* preconditioner of k K + m M */
int       system_by_ranks     (const pg_system *s);  /* 1: the preconditioner is one of ranks */
pg_status system_find_bare    (pg_system *s, const dynamics *dyn);     /* finds unknowns without stiffness */
void      system_clear_rest   (const pg_system *s, double *z);         /* z = 0 at ghosts and bare unknowns */
pg_status system_apply_shared (pg_system *s, const double *r, double *z);
void      system_free_shared  (pg_system *s);
/* shared_factor.c: every rank factors the whole k K + m M (iterative.made); *made 0: not for a large body */
pg_status system_make_shared_factor  (pg_system *s, int *made);
pg_status system_apply_shared_factor (const pg_system *s, const double *r, double *z);
void      system_free_shared_factor  (pg_system *s);
int       system_has_matrix (const pg_system *s);       /* 1: the force offers K itself */
pg_status system_create  (pg_system *s);               /* the caller has set the fields up to `report` */
void      system_free    (pg_system *s);
pg_status system_factorize (pg_system *s, const dynamics *dyn);  /* factors k K + m M of the last refresh */
/* Can K be factored? Are systems solved by factors? Is the factor at hand that of K as it is now? */
int       system_can_factor (const pg_system *s);
int       system_factors    (const pg_system *s);
int       system_has_factor (const pg_system *s);
/* Frees the matrix that was made to be factored, not its factor. */
void      system_release_matrix (pg_system *s);
/* T of the constraints d = T q + g; NULL: there are none. system_reduce: reduced = T' full. system_expand:
 * full = T x. system_step: T x in balance.full, or x itself without constraints. */
const pg_sparse *system_basis (const pg_system *s);
void      system_reduce  (const pg_system *s, const double *full, double *reduced);
void      system_expand  (const pg_system *s, const double *x, double *full);
const double *system_step (const pg_system *s, const double *x);
const pg_operator *system_operator (const pg_system *s);  /* K x by the force; NULL: not offered */
/* fills diagonal0, once; K NULL: by the operator */
void      system_remember_diagonal (pg_system *s, const pg_sparse *K);
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
/* From now on systems have another matrix and are solved by `mode`, SYSTEM_... */
void      system_switch  (pg_system *s, int mode);
/* Seconds by stored rates: K from the shape functions; a factorization; two triangular solves of one
 * right-hand side; one product K x; assembly and factor before there is any. */
double    system_assembly_cost (const pg_system *s);
double    system_factor_cost (const pg_system *s);
double    system_solve_cost  (const pg_system *s);
double    system_apply_cost  (const pg_system *s);
double    system_direct_cost (const pg_system *s);
/* y = K x, by operator or matrix */
void      system_multiply (const pg_system *s, const double *x, double *y);
/* Solves (k K + m M) delta = reduced by conjugate gradients with the preconditioner P, NULL: the diagonal
 * (iterate.c). */
pg_status system_iterate (pg_system *s, const dynamics *dyn, const pg_preconditioner *P, double tolerance,
                          size_t limit, size_t *used);
/* Solves (k K + m M) delta = reduced by conjugate gradients with a preconditioner of several levels, by the
 * rows of K (multilevel; K alone) or by finite elements, made when needed (preconditioner.c). */
pg_status system_iterate_preconditioned (pg_system *s, const dynamics *dyn, double tolerance);
/* Makes the preconditioner of k K + m M, from the last refresh. */
pg_status system_make_preconditioner (pg_system *s, double k, double m);
void      system_forget_preconditioner (pg_system *s);
int       system_has_preconditioner (const pg_system *s);
pg_status system_can_precondition (pg_system *s, const dynamics *dyn, int *can);
/* Stiffness of a spring on an unknown that breaking has made weak, over the mean diagonal of the first K. */
#define WEAK_SPRING 1e-11
pg_status system_remember_alive (pg_system *s);        /* copies them to `factored`, `factored_paths` */
/* Copies cracks that grow; the copy has its own memory. */
pg_status system_copy_paths (const pg_system *s, pg_crack_paths **to, const pg_crack_paths *from);
void      system_mark_touched (const pg_system *s, const unsigned char *bonds, unsigned char *touched);
pg_status system_guess       (pg_system *s, const dynamics *dyn, double *d, int *used);
void      system_guess_undo  (pg_system *s, double *d);
void      system_guess_add   (pg_system *s, const double *step);
void      system_guess_learn (pg_system *s);
void      system_guess_free  (pg_system *s);
pg_status system_guess_keep  (pg_system *s, const pg_keeper *k);
/* break_residual.c: refreshes after a round of breaking at d and, where it can, updates the residual
 * (at_hand). system_take_residual: that residual, relative to what the last measured one was divided by. */
pg_status system_break (pg_system *s, const pg_state *state, const pg_changes *changes, const double *d,
                        const dynamics *dyn);
double    system_take_residual (pg_system *s);
pg_status system_keep_residual (pg_system *s, const pg_keeper *k);
/* Factors the matrix where K has changed, then solves with the factor. */
pg_status system_solve_by_factor (pg_system *s, const dynamics *dyn);
/* kept_factor.c: solves with a factor that is kept while bonds break. system_note_change: updates it by what
 * the last refresh changed. */
pg_status system_solve_by_kept_factor (pg_system *s, const dynamics *dyn, double tolerance);
pg_status system_note_change (pg_system *s);
/* factor_or_elements.c, dynamics: records that bonds have broken; that a factor was made. ways_choose: takes
 * the cheaper method before a solve. ways_count: counts the cost after one. */
void      ways_note_broken (pg_system *s, size_t count);
void      ways_note_factor (pg_system *s);
pg_status ways_choose      (pg_system *s, const dynamics *dyn);
void      ways_count       (pg_system *s, size_t iterations);
/* Solves once for `delta` from `reduced`, by the method that was chosen or is chosen now (choice.c). */
pg_status system_solve_once (pg_system *s, const dynamics *dyn, double tolerance);
/* refinement.c: system_solve makes d the equilibrium at t; *residual relative to the reference force;
 * PG_E_EQUILIBRIUM where it stays above the tolerance. */
/* Measures the out-of-balance force at (t, d) by the force itself, relative to the reference force. */
pg_status system_residual (pg_system *s, double t, const double *d, const dynamics *dyn, double *relative);
pg_status system_solve   (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
/* 1: this outcome of a solve says that there is no equilibrium. */
static inline int system_no_equilibrium (pg_status solved)
{
    return solved == PG_E_EQUILIBRIUM || solved == PG_E_NOT_SPD || solved == PG_E_SINGULAR;
}
/* d becomes the equilibrium at t under the contact forces at hand; *residual, errors as with system_solve. */
pg_status system_solve_linear (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
/* Solves for d at t until the residual has fallen to `share` of that of d; the result is not judged.
 * rough.before: an earlier iterate of ten times that residual. With rough.look: until look stops it, or down
 * to what exact solutions need at least. *done 0: nothing usable: the method of solving cannot be ended
 * early, d is almost accurate enough, or no earlier iterate was met. */
pg_status system_solve_roughly (pg_system *s, double t, double *d, const dynamics *dyn, double share,
                                int *done);
/* to = d + T x, x of nred unknowns */
void      system_go_on (pg_system *s, const double *d, const double *x, double *to);

/* mass.c: system_add_mass: y += factor M x; _diagonal: d += factor diag M; _matrix: value += factor M. */
/* Finds the masses, after the first refresh; consistent 1: a matrix from the force, not lumped. */
pg_status system_mass (pg_system *s, int consistent);
/* residual += forces that opening facets still carry in dynamics, N (facet_hold.c) */
void system_add_held (const pg_system *s, double *residual);
void system_add_mass (const pg_system *s, double factor, const double *x, double *y);
void system_add_mass_diagonal (const pg_system *s, double factor, double *d);
void system_add_mass_matrix (const pg_system *s, double factor, const pg_sparse *K, double *value);

/* ---- break_loop.c ------------------------------------------------------------------------------------- */
struct break_loop;
/* Growth of cracks by facets, which takes the place of breaking single bonds: its methods
 * (facet_growth.h). */
typedef struct {
    void      (*free)    (struct break_loop *b);
    void      (*forward) (struct break_loop *b, double dt);            /* called as a time step begins */
    /* One round of growth at the displacement d; *again 1: something grew, and a new equilibrium is to be
     * found. */
    pg_status (*round)   (struct break_loop *b, pg_state *state, double t, const double *d,
                          const dynamics *dyn, pg_step *step, int *again);
    /* Event stepping: makes the event at this load factor. */
    pg_status (*event)   (pg_solver *s, pg_state *state, double factor, pg_step *step);
    /* save: called at the start of a step; restore: called where the step is refused. */
    pg_status (*save)    (struct break_loop *b);
    void      (*restore) (struct break_loop *b);
} growth_client;
typedef struct break_loop {
    pg_system  system;
    double    *utilisation, *factor;  /* of each bond: utilisation; load factor at its limit */
    char      *kind;
    pg_changes changes;                                /* bonds that broke in the last round */
    pg_changes over;                                   /* bonds at or near their limit when last judged */
    pg_broken *broken; size_t nbroken, cap_broken;     /* bonds that broke in this step */
    /* break rounds of the step at hand; > 0 between calls: the step was stopped in its middle */
    long       round;
    long       began;                                  /* round at which this call began */
    /* function of the caller that is called between rounds; stopped 1: it ended the step */
    pg_watch   watch; void *watching; int stopped;
    double     work0, stored0;                         /* work, energy at the start of the step, J */
    pg_work_balance  work_balance, before;  /* of the present state; of the one accounted last */
    double     work;                                   /* external work so far, J */
    /* values at the start of the step (energies: J), restored if it is refused; saved 1: they are at hand */
    pg_work_balance  start; double strain0, kinetic0; int saved;
    double    *damage;                                 /* damage of points, for stop.set (6 n) */
    /* solver.break: facet: crack tips are judged instead of bonds; else NULL */
    struct facet_growth *growth; const growth_client *grower;
    /* largest damage in stop.set: now; when it was first looked at (looked 1) */
    double     nearest, nearest0; int looked;
} break_loop;
void      break_loop_free   (break_loop *b);
/* Allocates the arrays for the utilisation of all bonds, when they are first needed. */
pg_status break_loop_ready  (break_loop *b);
/* Records a bond that broke at time (or load factor) t. */
pg_status break_loop_log    (break_loop *b, size_t bond, char kind, double utilisation, double t);
/* 1: the point that has the bond is owned by this rank, or there are no ranks. */
int       break_loop_owns   (const break_loop *b, size_t bond);
/* The largest of value[bond] over the bonds of all ranks (at least 0); the smallest. */
double    break_loop_largest  (const break_loop *b, const double *value);
double    break_loop_smallest (const break_loop *b, const double *value);
/* 1: this run judges bonds: there is a criterion of bonds, and the force can evaluate it. */
int       break_loop_judges (const break_loop *b);
/* Utilisation from which on bonds break in this round; top: the largest one. */
double    break_loop_cut    (const break_loop *b, double top);
/* rough_round.c: a round in the middle of a cascade by an inexact solution. *done 1: `top` and `over` are
 * those of the exact one, but for digits that decide nothing; 0: the round has to be solved exactly. */
pg_status break_loop_rough  (break_loop *b, const pg_state *state, double t, double *d, const dynamics *dyn,
                             double *top, int *done);
/* Breaks intact bonds with measure[i] >= cut, of an ascending list or of all (NULL), and records them with
 * their utilisation times scale. */
pg_status break_loop_kill (break_loop *b, pg_state *state, const pg_changes *among, const double *measure,
                           double cut, double scale, double t);
/* Solve, break, update, solve ... at time t until no bond is over its limit; d is left in equilibrium. */
pg_status equilibrate (break_loop *b, pg_state *state, double t, double *d, const dynamics *dyn,
                       pg_step *step);
/* Number of intact bonds over their limit by more than the tie, by the utilisation last measured times scale;
 * *top: the largest. */
long      break_loop_over   (const break_loop *b, const pg_state *state, double scale, double *top);
/* Finds the work balance of (t, d) and adds the work since the last accounted state (loads scaled by
 * `scale`). rest 1: a static state in equilibrium. */
pg_status break_loop_account (break_loop *b, double t, const double *d, const dynamics *dyn, int rest,
                              double scale);
/* force_balance.c: compares the sums of forces and moments of this state with zero and notes the error in the
 * report; _warn warns of it at the end. f: forces on nodes besides loads and supports, such as inertia, N
 * (ndof; NULL: none). _due 1: this step is measured (dynamics: some are). */
void      force_balance      (pg_system *s, const double *d, const pg_work_balance *w, const double *f);
int       force_balance_due  (const pg_system *s);
void      force_balance_warn (pg_statistics *report, const pg_problem *problem);
/* Adds the work since the last accounted state, by the work balance at hand. */
pg_status break_loop_book    (break_loop *b, double scale);
/* Saves, at the start of a step, what work is summed from and the energies of the report; break_loop_return
 * restores them where the step is refused. */
pg_status break_loop_save    (break_loop *b);
void      break_loop_return  (break_loop *b);
/* Has the damage of a point of options.stop_set reached options.stop_damage? */
pg_status break_loop_arrived (break_loop *b, const pg_state *state, const double *d, int *arrived);

/* ---- methods ------------------------------------------------------------------------------------------- */
/* A row of a table of keys without a catalogue of its own. */
#define PG_SOLVER_KEY(path, kind, unit, range, fallback, choices, doc) \
    { path, kind, unit, range, fallback, choices, NULL, NULL, doc }

/* Keys that several solvers share (keys.c): how bonds break between solves; facets; the linear systems;
 * the time step; the time axis and Rayleigh's damping; stages of the load. */
extern const pg_key_table solver_keys_breaking, solver_keys_facets, solver_keys_linear, solver_keys_step,
    solver_keys_time, solver_keys_stages;

/* Writes the names of all solvers for which fits returns 1: "adr, relax". */
void solver_names_that (int (*fits) (const pg_solver_type *type, const void *context), const void *context,
                        char *text, size_t size);

/* ---- options.c: parts of `read` of several solvers ----------------------------------------------------- */
double options_number  (const pg_scene *scene, const char *key);  /* number of a key; 0: it is not given */
long   options_integer (const pg_scene *scene, const char *key);
int    options_begin_cracks (const pg_problem *problem);   /* new cracks begin where a strength is reached */
/* Reads solver.dt, end and time_steps. Explicit methods can choose the step: then one of the last two is
 * enough; else two of the three are needed. */
void   options_read_times (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
/* PG_E_SCENE: reports a fault at a key, found while the solver is made or begins; placed in the scene if
 * options.scene is set. */
pg_status options_fault (const pg_solver_options *o, const char *key, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* PG_E_USAGE of a folder without keys becomes PG_E_SCENE at `key`, by its last message; else `status`. */
pg_status options_blame (pg_status status, const pg_solver_options *o, const char *key);

/* ---- stage_path.c: stages of loading (problem->stage) -------------------------------------------------- */
/* Why a stage ends. */
enum { STAGE_GOES_ON, STAGE_LOADS, STAGE_GAUGE, STAGE_FORCE, STAGE_EVENTS, STAGE_GROWTH, STAGE_RUN };
typedef struct {
    long   number;                                     /* number of the present stage, from 1; 0: no stages */
    int    over;                                       /* STAGE_...: why the stage ends with this step */
    long   first_step, first_event;                    /* step and event at which the stage began */
    double first_growth;                               /* stage_growth at its start, m (3D: m^2) */
    double peak;                                       /* until.load: largest force in this stage, N */
    /* until.gauge: the opening approaches its limit from below (1), above (-1); 0: not known yet */
    double side;
} stage_place;
typedef struct {
    /* forces that the parts removed by this stage exerted, N (ndof; NULL: none): at its start, and now */
    double     *excavated, *excavated_now;
    stage_place now, before;                           /* before: at the start of the step at hand */
    long        level_before;                          /* next_level at the start of that step */
    pg_problem *staged;                                /* copy of the problem with loads of its own */
    double     *share;  /* of each stage: share of its loads at which it ended; 1 until it has */
    double     *opening;  /* gauge openings of all records, m (stages x gauges) */
    signed char *here;  /* of each gauge end: 1: this rank measures it; -1: not known */
    pg_stage_record *record;                           /* record of each stage */
} stage_path;

struct pg_solver {
    const pg_solver_type *type;
    pg_solver_options options;
    const pg_problem *problem;
    break_loop   break_loop;
    pg_statistics report;
    int shared;                                        /* 1: the report holds sums over all ranks */
    int begun, started, finished, warned_overlap, warned_energy, warned_facets,
           warned_balance, warned_blind, warned_alone;
    long      next_level;                              /* next level to report: next_level / levels */
    double    turned, turned_at;  /* largest rotation of a family, rad; when it became large */
    pg_state *backup;                                  /* last accepted state, for refused steps */
    long      evaluations, spared;  /* forces evaluated by explicit steps; not needed for rows */
    /* 1: alive bits of backup and state differ in the bonds of the last step's list alone */
    int       follows;
    double   *reaction;
    pg_tip_values *tip; size_t ntip, cap_tip;  /* values measured last at tips or front vertices */
    stage_path stage;
    const pg_platen_values *moving;  /* forces, motions of platens in explicit steps; or NULL */
    void     *own;  /* data of the method (type->own_size bytes), or NULL */
};

/* Prepares the first step: pg_solver_begin, then the start of the method. */
pg_status solver_start  (pg_solver *s, pg_state *state);
/* Called before the system is made: where there are stages the solver gets its own copy of the problem. */
pg_status stages_create (pg_solver *s);
void      stages_free   (pg_solver *s);
pg_status stages_keep   (pg_solver *s, const pg_keeper *k);
/* only if no stage removes parts */
pg_status stages_moved  (pg_solver *s, const pg_moved *m, int within);
/* t at the start and at the end of the present stage (without stages 0 and 1); t of the next level. */
double    stage_start   (const pg_solver *s);
double    stage_end     (const pg_solver *s);
double    stage_level   (const pg_solver *s);
long      stage_steps   (const pg_solver *s, long number);             /* fixed load steps of a stage */
int       stage_moves   (const pg_solver *s);          /* 1: some load changes in the present stage */
/* Length (3D: area) by which cracks have grown since the start of the run, m (m^2). */
double    stage_growth  (const pg_state *state);
/* Called at the start of a step: begins the next stage where the last step ended one, and returns 1 then;
 * loads and displacements stay as they are. */
int       stage_next    (pg_solver *s, pg_state *state);
/* Called after stage_next: cuts out the parts that the stage removes, at the displacement at its start. */
pg_status stage_remove  (pg_solver *s, pg_state *state);
/* Sets the forces of the removed parts at t: they fall to zero along the stage. */
void      stage_bear    (pg_solver *s, double t);
/* Event stepping, d = base + (t - start) (unit - base) for t from now to *factor: *crosses 1: the opening of
 * until.gauge is met there, the stage ends, and *factor is the t at which. */
pg_status stage_cross   (pg_solver *s, const pg_state *state, const double *base, const double *unit,
                         double now, double *factor, int *crosses);
/* *meets 1: this state, in equilibrium with its loads, meets a condition of until, and the stage ends. Event
 * stepping leaves until.gauge to stage_cross. */
pg_status stage_meets   (pg_solver *s, const pg_state *state, const double *reaction, int *meets);
/* Called when a step is accepted: records the end of a stage; the end of the last stage ends the run. */
pg_status stage_close_step (pg_solver *s, const pg_state *state, pg_step *step);
void      stage_save    (pg_solver *s);                /* saves the stage before a step */
void      stage_return  (pg_solver *s);

/* ---- tip_values.c -------------------------------------------------------------------------------------- */
/* Stores what was measured at a tip or vertex, in place of earlier values. */
pg_status solver_note_tip  (pg_solver *s, const pg_tip_values *values);
pg_status solver_keep_tips (pg_solver *s, const pg_keeper *k);

/* ---- warnings.c ---------------------------------------------------------------------------------------- */

/* turns.c: called after a step; warns of families whose rotation is large. */
void solver_note_turns (pg_solver *s, const pg_state *state, const pg_step *step);

/* loaded_rows.c: warns of tractions that tear off the points they act on; the force is refreshed. */
pg_status doubt_loaded_rows (pg_solver *s);

/* ---- progress.c ---------------------------------------------------------------------------------------- */
/* Offers one possible end of a run and how far the run has come towards it (share, 0..1): the nearest
 * counts. */
void progress_offer (pg_progress *p, double share, const char *end, int even);

/* ---- checkpoint.c -------------------------------------------------------------------------------------- */
/* Write or read back: counts, time, load factor and work of a state; the solver's levels and rounds; the
 * report. */
pg_status keep_state_numbers (pg_state *s, const char *name, const pg_keeper *k);
pg_status keep_solver_counts (pg_solver *s, const pg_keeper *k);
pg_status keep_report (pg_statistics *r, const pg_keeper *k);
/* Sums over the own points of one rank after its last step, which add up to those of all ranks. */
enum { SHARE_BROKEN, SHARE_WORK, SHARE_REPORTED, SHARE_STRAIN, SHARE_KINETIC, SHARE_EXTERNAL, SHARE_DAMPING,
       SHARE_DISSIPATED, SHARES };

/* ---- moved.c ------------------------------------------------------------------------------------------- */
/* Makes the work balance of the static state (t, d) that of the last accounted state, adding no work. Loads
 * scaled by `scale`. */
pg_status moved_balance (break_loop *b, double t, const double *d, double scale);
#endif
