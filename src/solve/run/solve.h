/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: the linear system of a force, the break loop, the solver object and its methods. */
#ifndef PG_SOLVE_PRIVATE_H
#define PG_SOLVE_PRIVATE_H
#include "perigal/solve.h"

/* ---- system.c: equilibrium of a force at given alive bits ---------------------------------------------- */
typedef struct pg_dynamics {                           /* what inertia and damping add (NULL: static) */
    double k, m;                                       /* matrix = k K + m M */
    double dt;  /* of the time step, s; INFINITY: its length is no time, the body creeps to an equilibrium */
    /* residual: of the equations to be solved; reference: at least its size */
    void (*add) (void *context, const double *d, double *residual, double *reference);
    /* residual -= M a + C v at d: what reactions contain of the motion */
    void (*resist) (void *context, const double *d, double *residual);
    /* x -= what equations that weigh the forces of two times leave of their balance at the later one, over
     * all unknowns. NULL: nothing. */
    void (*leave) (void *context, const double *d, double *x);
    /* x = d + c_K v with the velocity v that belongs to d: forces are linear, so that their residual at x has
     * the damping by stiffness in it, which `add` then leaves out. 0, and x is not filled: there is none. */
    int  (*join) (void *context, const double *d, double *x);
    double contact;  /* what stands in the equations of a force of contact over its mean in the step */
    int    whole;  /* 1: that residual is P - F_int - M a - C v, as reactions need it */
    void  *context;
} dynamics;

/* How the linear systems are solved; TRIAL: not known yet, a few iterations are tried first. */
enum {
    SYSTEM_UNDECIDED, SYSTEM_TRIAL, SYSTEM_FACTOR, SYSTEM_KEPT_FACTOR, SYSTEM_NO_FACTOR,
    SYSTEM_DIAGONAL                                    /* no factor, and no better preconditioner either */
};

/* Corrections x of the last steps and what they changed in the residual, y (first_guess.c): rings of
 * GUESS_PAIRS + 1 vectors of ndof, of which the last n before `next` are complete. fresh: K is that of all
 * y. */
enum { GUESS_PAIRS = 5 };
typedef struct { double *x, *y; int n, next, fresh; } pg_guess;

/* How much larger than that of the last iterate the residual of the earlier one is, about. */
enum { ROUGHER = 10 };
/* An iterate on the way to such a solution: its residual over the first one, its delta (nred), utilisation by
 * it of the bonds of list number `list` (0: of none yet). */
typedef struct { double residual, *delta, *u; size_t room; long list; } pg_rough_view;
enum { ROUGH_VIEWS = 8 };
/* Solutions that need to show only which bonds break (rough_round.c). */
typedef struct {
    double  goal;  /* of the solve at hand, over its first residual: the earlier iterate is kept; 0: not */
    int     found;                                     /* that iterate was met */
    double *earlier;                                   /* delta of it (nred) */
    double *before;  /* displacement that belongs to it (ndof) */
    double *earlier_u; size_t room_u;                  /* utilisation by it of the bonds near their limit */
    double  share;  /* goal of the next rough solve; 0: the first one; below 0: there are none */
    long    rounds, again;                             /* how many sufficed; how many did not */
    /* with finite elements: asked after each iteration whether it may be the last; NULL: nobody is */
    pg_status (*look) (void *looking, double residual, int *stop);
    void   *looking;
    pg_rough_view view[ROUGH_VIEWS]; long nview;       /* the last iterates kept; how many so far */
} pg_rough;

/* Factor or finite elements, in motion (factor_or_elements.c): seconds by stored rates. */
typedef struct {
    int    meanwhile;                                  /* 1: elements stand in for a factor */
    double regret;                                     /* s that the other way would have spared */
    double iterations;                                 /* of a solve by elements, a mean; 0: not known */
    double breaking, bonds;  /* s that breaking has cost in factors; bonds that broke meanwhile */
    double fresh;                                      /* bonds that broke since the last solve */
    double spent;                                      /* what the factor had cost by then */
    /* systems solved by conjugate gradients with finite elements as preconditioner, in place of a factor */
    long   solves;
} pg_ways;

/* The matrix k K + m M as it was last factored, and its factor. */
typedef struct {
    const pg_linear_type *linear;
    void     *factor;
    int       stale;                                   /* 1: K is another one by now */
    unsigned long revision;                            /* of K when it was last factored or found stale */
    /* What is factored, until it has been: K itself, its pattern with the values `copy`, or (owned) what
     * constraints leave of it; the diagonal of K, while that of A stands in its place; else NULL. */
    pg_sparse A; int owned;
    double   *copy, *own_diagonal;
    /* Springs as stiff as the mean diagonal, from unknowns to places, m, that hold parts which move freely
     * and are meant to bear nothing; borrowed. */
    struct { size_t n; const size_t *unknown; const double *target; } props;
    int       forgotten;  /* 1: K was given up for its factor */
    double   *diagonal0, mean_diagonal;                /* of the first K */
    double    shift;  /* of the diagonal of weak unknowns, of mean_diagonal */
    unsigned char *touched; int marked;                /* nodes that the pre-cracks touched (n); 1: found */
    int       unshifted, all_weak;                     /* all_weak: every unknown gets the shift (touched) */
    int       loose;  /* 1: K was found to leave parts free to move */
    int       indefinite;  /* K proved not positive definite: another linear solver took over */
    const unsigned char *alive;                        /* of the last refresh, borrowed */
    unsigned char *factored;  /* what lived when the factor or preconditioner was made */
    /* Cracks of the last refresh, and those of `factored`: cells that end at them follow from them besides
     * (consistent integration). NULL: cracks do not grow. */
    pg_crack_paths *paths, *factored_paths;
} system_factor;

/* A factor that serves on while bonds break. */
typedef struct {
    int       serves;  /* 1: asked for before the first solve: a factor is to serve many events */
    int       base;  /* 1: the factor is the base of an event solver, which it serves whatever has broken */
    long      by_columns;                              /* equilibria by an event solver, no new factor */
    struct inverse *following;  /* in motion: what has broken since the factor was made; or NULL */
} system_updates;

/* Conjugate gradients: their preconditioners and what they begin with. */
typedef struct {
    pg_multilevel *multilevel;                         /* multilevel preconditioner; NULL: none (yet) */
    /* preconditioner by finite elements; NULL: not used, or not made yet */
    pg_element_preconditioner *elements;
    void     *amg;  /* preconditioner of ranks that share the body; NULL: not used, or not made yet */
    /* preconditioner of ranks that share a small body; NULL: not used or made */
    struct shared_factor *whole_factor;
    unsigned char *bare;  /* ranks: unknowns without any stiffness left (ndof); NULL: not asked for */
    unsigned char *hanging;                            /* nodes that springs hold in iterations (n) */
    double   *whole;  /* ranks that share the body: x of K x with its ghosts (ndof); else NULL */
    double    made[2];                                 /* k and m of the preconditioner */
    pg_operator  inertia; pg_couplings stiffness;      /* of ranks in motion: its matrix, rows of K */
    pg_cg_room cg_room;                                /* of conjugate gradients, from solve to solve */
    int      *own_row;  /* unknown that each reduced one is (nred); with elements only */
    unsigned char *fixed;  /* unknowns that T leaves out (ndof); NULL: not asked for */
    int       precondition;  /* with `fixed`: the constraints allow a preconditioner of several levels */
    int       remake;  /* read back: the preconditioner is to be made from `factored` */
    double    fell;  /* last over first residual of the last solve by iterations */
    double    pace;  /* - log of the residual's fall in one iteration, preconditioner new; 0: not known */
    size_t    matrix_iterations;
    pg_guess  guess;
    pg_rough  rough;
} system_iterations;

/* The forces of a state, and what they lack to balance. */
typedef struct {
    double   *residual, *reduced, *delta, *full, *best, *scratch;
    const double *excavated;  /* forces at rest that what was removed still exerts, N (ndof); NULL: none */
    const double *held;  /* forces that facets still carry while they open, N (ndof); NULL: none */
    const double *pressed;  /* forces of contact as they stand in the equations, N (ndof); NULL: none */
    /* of the last state measured, N: its forces; what it lacks to balance */
    double    reference, unbalanced;
    double    scale;  /* what its residual was divided by: the reference, or forces of rounding */
    double    borne;  /* the largest reference of an accepted state of fixed load steps, N */
    /* At rest: size of the loads and of what prescribed displacements alone exert at `loaded_at`, N, and how
     * much larger the reactions can be that balance them (lever); lever 0: not known yet. */
    double    loaded, loaded_at, lever;
    struct body_parts *floating;  /* that move freely under loads that balance; NULL: none */
    int       carried;  /* `residual` went with the last iterations to the state that they lead to */
    int       known;                                   /* `residual` is that of the state last solved for */
    int       at_hand;  /* `residual` is that of the same displacements after the last round of breaking */
    long      unmeasured;                              /* states accepted by carried residuals */
} system_balance;

/* By what systems are solved, and what it has cost. */
typedef struct {
    int       mode;                                    /* SYSTEM_... */
    long      spared;                                  /* solves by the factor of an earlier K */
    long      kept;                                    /* refreshes that left K as it was */
    /* s (with the multilevel preconditioner: iterations) that a new factor would have spared */
    double    extra_cost;
    double    columns;  /* right-hand sides that every new K is solved with beside the loads */
    int       begins;                                  /* the state to be solved for begins a step */
    pg_ways   ways;
} system_choice;

struct pg_system;
/* What acts on the body beside its loads and as it moves (contact.h). */
typedef struct {
    void      (*free)    (struct pg_system *s);
    /* After the force was refreshed by these changes; NULL: all. */
    pg_status (*refresh) (struct pg_system *s, const pg_state *state, const pg_changes *changes);
    /* As system_solve. */
    pg_status (*solve)   (struct pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
    /* At rest: its part of the energies and of the reactions of loads. Work that it has done since the state
     * that was booked last, loads scaled, J. */
    void      (*account) (const struct pg_system *s, pg_work_balance *balance);
    double    (*book)    (struct pg_system *s, double scale);
    /* At the start of a step; where it is refused. */
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
    double   *mass;                                    /* lumped, per unknown, kg */
    const pg_sparse *M;                                /* consistent, or NULL */
    system_balance    balance;
    system_factor     direct;
    system_updates    updates;
    system_iterations iterative;
    system_choice     choice;
    const system_client   *client;                     /* NULL: nothing acts on it */
    struct system_contact *contact;                    /* of crack faces and platens; NULL: none */
} pg_system;
/* shared_system.c: where ranks share the body; sums over ranks, which leave alone what one process has */
int       system_is_shared (const pg_system *s);
pg_status system_exchange  (const pg_system *s, double *d);
void      system_clear_ghosts (const pg_system *s, double *force);
double    system_sum       (const pg_system *s, double mine);
double    system_most      (const pg_system *s, double mine);
double    system_norm      (const pg_system *s, const double *force, size_t n);
double    system_norm_owned (const pg_system *s, const double *weight, const double *d);
void      system_multiply_shared (const pg_system *s, const pg_operator *op, const double *x, double *y);
pg_status system_make_shared  (pg_system *s, double k, double m);      /* of k K + m M */
int       system_by_ranks     (const pg_system *s);                    /* it is at hand */
pg_status system_find_bare    (pg_system *s, const dynamics *dyn);     /* after breaking */
void      system_clear_rest   (const pg_system *s, double *z);         /* ghosts, and what nothing holds */
pg_status system_apply_shared (pg_system *s, const double *r, double *z);
void      system_free_shared  (pg_system *s);
/* shared_factor.c: every rank makes a factor of k K + m M (s->made); *made 0: none, as of a large body */
pg_status system_make_shared_factor  (pg_system *s, int *made);
pg_status system_apply_shared_factor (const pg_system *s, const double *r, double *z);
void      system_free_shared_factor  (pg_system *s);
int       system_has_matrix (const pg_system *s);       /* the force offers K itself */
pg_status system_create  (pg_system *s);               /* fields up to report set by the caller */
void      system_free    (pg_system *s);
pg_status system_factorize (pg_system *s, const dynamics *dyn);  /* k K + m M of the last refresh */
/* Can K be factored? Are systems solved by factors? Is the factor at hand that of K as it is now? */
int       system_can_factor (const pg_system *s);
int       system_factors    (const pg_system *s);
int       system_has_factor (const pg_system *s);
/* Frees what was made to be factored, not the factor. */
void      system_release_matrix (pg_system *s);
/* What constraints leave of the unknowns, d = T q + g; NULL: all of them. reduced = T' full; full = T x; T x
 * in balance.full, or x itself. */
const pg_sparse *system_basis (const pg_system *s);
void      system_reduce  (const pg_system *s, const double *full, double *reduced);
void      system_expand  (const pg_system *s, const double *x, double *full);
const double *system_step (const pg_system *s, const double *x);
const pg_operator *system_operator (const pg_system *s);               /* of the force; NULL: it has none */
void      system_remember_diagonal (pg_system *s, const pg_sparse *K);  /* once; K NULL: by the operator */
pg_status system_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
/* Systems with another matrix than so far, solved in this way: SYSTEM_... */
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
/* delta = (k K + m M)^-1 reduced by conjugate gradients with a preconditioner, NULL: the diagonal
 * (iterate.c). */
pg_status system_iterate (pg_system *s, const dynamics *dyn, const pg_preconditioner *P, double tolerance,
                          size_t limit, size_t *used);
/* Solves (k K + m M) delta = reduced by conjugate gradients with a preconditioner of several levels, by the
 * rows of K (multilevel; K alone) or by finite elements, made when needed (preconditioner.c). */
pg_status system_iterate_preconditioned (pg_system *s, const dynamics *dyn, double tolerance);
/* Of k K + m M, from the last refresh. */
pg_status system_make_preconditioner (pg_system *s, double k, double m);
void      system_forget_preconditioner (pg_system *s);
int       system_has_preconditioner (const pg_system *s);
pg_status system_can_precondition (pg_system *s, const dynamics *dyn, int *can);
/* The spring of an unknown that breaking has made weak, of the mean diagonal of the first K. */
#define WEAK_SPRING 1e-11
pg_status system_remember_alive (pg_system *s);        /* in `factored`, cracks in `factored_paths` */
/* A copy of cracks that grow, in its own memory. */
pg_status system_copy_paths (const pg_system *s, pg_crack_paths **to, const pg_crack_paths *from);
void      system_mark_touched (const pg_system *s, const unsigned char *bonds, unsigned char *touched);
pg_status system_guess       (pg_system *s, const dynamics *dyn, double *d, int *used);
void      system_guess_undo  (pg_system *s, double *d);
void      system_guess_add   (pg_system *s, const double *step);
void      system_guess_learn (pg_system *s);
void      system_guess_free  (pg_system *s);
pg_status system_guess_keep  (pg_system *s, const pg_keeper *k);
/* break_residual.c: refreshes after a round of breaking at d; where it can the residual goes with it
 * (at_hand). Takes that residual, relative to what the last one measured was divided by. */
pg_status system_break (pg_system *s, const pg_state *state, const pg_changes *changes, const double *d,
                        const dynamics *dyn);
double    system_take_residual (pg_system *s);
pg_status system_keep_residual (pg_system *s, const pg_keeper *k);
/* Factors where K has changed, then solves. */
pg_status system_solve_by_factor (pg_system *s, const dynamics *dyn);
/* kept_factor.c: a factor that serves on while bonds break: solve with it; take in what the last refresh
 * changed. */
pg_status system_solve_by_kept_factor (pg_system *s, const dynamics *dyn, double tolerance);
pg_status system_note_change (pg_system *s);
/* factor_or_elements.c: in motion, which of both is the cheaper one: bonds have broken; a factor was made;
 * before a solve; after one. */
void      ways_note_broken (pg_system *s, size_t count);
void      ways_note_factor (pg_system *s);
pg_status ways_choose      (pg_system *s, const dynamics *dyn);
void      ways_count       (pg_system *s, size_t iterations);
/* One solve for `delta` from `reduced`, by the way that was chosen or is chosen now (choice.c). */
pg_status system_solve_once (pg_system *s, const dynamics *dyn, double tolerance);
/* d becomes the equilibrium at t (refinement.c); *residual relative to the reference force.
 * PG_E_EQUILIBRIUM when it stays above the tolerance. */
/* The out-of-balance force of (t, d), from the force itself, relative to what it is measured against. */
pg_status system_residual (pg_system *s, double t, const double *d, const dynamics *dyn, double *relative);
pg_status system_solve   (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
/* Does this outcome say that there is none? */
static inline int system_no_equilibrium (pg_status solved)
{
    return solved == PG_E_EQUILIBRIUM || solved == PG_E_NOT_SPD || solved == PG_E_SINGULAR;
}
/* d becomes the equilibrium at t under the contact forces at hand; *residual, errors as with system_solve. */
pg_status system_solve_linear (pg_system *s, double t, double *d, const dynamics *dyn, double *residual);
/* Solves for d at t down to a residual `share` times that of d only, nothing being judged; rough.before is an
 * earlier, ten times rougher iterate. With rough.look: to that share or what exact solutions need at least,
 * or less far where it stops them. *done 0: the way to solve is not fit for it, d has almost as small a
 * residual as is asked of exact solutions, or there was no earlier iterate. */
pg_status system_solve_roughly (pg_system *s, double t, double *d, const dynamics *dyn, double share,
                                int *done);
/* to = d + T x, x of nred unknowns */
void      system_go_on (pg_system *s, const double *d, const double *x, double *to);

/* mass.c: y += factor M x; d += factor diag M; value += factor M */
/* After the first refresh; consistent: by the force, not lumped. */
pg_status system_mass (pg_system *s, int consistent);
/* residual += forces that facets still hold in motion, N (facet_hold.c) */
void system_add_held (const pg_system *s, double *residual);
void system_add_mass (const pg_system *s, double factor, const double *x, double *y);
void system_add_mass_diagonal (const pg_system *s, double factor, double *d);
void system_add_mass_matrix (const pg_system *s, double factor, const pg_sparse *K, double *value);

/* ---- break_loop.c ------------------------------------------------------------------------------------- */
struct break_loop;
/* What grows in place of single bonds (facet_growth.h). */
typedef struct {
    void      (*free)    (struct break_loop *b);
    void      (*forward) (struct break_loop *b, double dt);            /* a time step begins */
    /* One round at the displacement d; *again: something grew, and there is another equilibrium to be found.
     * */
    pg_status (*round)   (struct break_loop *b, pg_state *state, double t, const double *d,
                          const dynamics *dyn, pg_step *step, int *again);
    /* The event at this load factor, in event stepping. */
    pg_status (*event)   (pg_solver *s, pg_state *state, double factor, pg_step *step);
    /* At the start of a step; where it is refused. */
    pg_status (*save)    (struct break_loop *b);
    void      (*restore) (struct break_loop *b);
} growth_client;
typedef struct break_loop {
    pg_system  system;
    double    *utilisation, *factor;                   /* per bond */
    char      *kind;
    pg_changes changes;                                /* died in the last round */
    pg_changes over;                                   /* at their limit or near it when last looked at */
    pg_broken *broken; size_t nbroken, cap_broken;     /* died in this step */
    long       round;  /* break rounds of the step at hand; > 0 between steps: it was stopped in its middle */
    long       began;                                  /* round at which this call began */
    /* the caller's look between rounds; 1: it ended the step */
    pg_watch   watch; void *watching; int stopped;
    double     work0, stored0;                         /* at the start of the step, J */
    pg_work_balance  work_balance, before;                         /* now; at the last accounted state */
    double     work;                                   /* external work, J */
    /* as they were at the start of the step, for one that is refused; saved 1: they are at hand */
    pg_work_balance  start; double strain0, kinetic0; int saved;
    double    *damage;                                 /* with stop.set (6 n) */
    /* break: facet: tips are judged instead of bonds; else NULL */
    struct facet_growth *growth; const growth_client *grower;
    /* largest damage of stop.set: now, when it was first looked at */
    double     nearest, nearest0; int looked;
} break_loop;
void      break_loop_free   (break_loop *b);
/* The arrays for the utilisation of all bonds, when they are first needed. */
pg_status break_loop_ready  (break_loop *b);
/* Notes a bond that died at time (or load factor) t. */
pg_status break_loop_log    (break_loop *b, size_t bond, char kind, double utilisation, double t);
/* 1: the point that has the bond is owned by this rank, or there are no ranks. */
int       break_loop_owns   (const break_loop *b, size_t bond);
/* The largest of a number of every bond (at least 0), and the smallest; of all ranks. */
double    break_loop_largest  (const break_loop *b, const double *value);
double    break_loop_smallest (const break_loop *b, const double *value);
/* 1: bonds are judged in this run: there is a criterion of bonds, and a force that knows how they stand. */
int       break_loop_judges (const break_loop *b);
/* Bonds with so large a utilisation break in this round. */
double    break_loop_cut    (const break_loop *b, double top);
/* rough_round.c: a round in the middle of a cascade by a rough solution. *done 1: `top` and `over` are what
 * they would be of the exact one, but for digits that decide nothing; 0: it has to be solved exactly. */
pg_status break_loop_rough  (break_loop *b, const pg_state *state, double t, double *d, const dynamics *dyn,
                             double *top, int *done);
/* Kills the bonds with measure[i] >= cut, those of a list, ascending, or of all (NULL); logs them with the
 * given utilisation scale. */
pg_status break_loop_kill (break_loop *b, pg_state *state, const pg_changes *among, const double *measure,
                           double cut, double scale, double t);
/* Solve, break, update, solve ... at time t until no bond is over its limit; d is left in equilibrium. */
pg_status equilibrate (break_loop *b, pg_state *state, double t, double *d, const dynamics *dyn,
                       pg_step *step);
/* Live bonds over their limit (and its ties) by the utilisation last measured, times scale; *top: the
 * largest. */
long      break_loop_over   (const break_loop *b, const pg_state *state, double scale, double *top);
/* The work balance of (t, d), and with it the work done between the last accounted state and this one (loads
 * scaled by `scale`). rest: 1: a static state in equilibrium. */
pg_status break_loop_account (break_loop *b, double t, const double *d, const dynamics *dyn, int rest,
                              double scale);
/* force_balance.c: do forces and moments of this state balance? Adds to the report; at the end warns. f:
 * what acts on nodes beside loads and supports, inertia among it (ndof; NULL: nothing). In motion at some
 * steps. */
void      force_balance      (pg_system *s, const double *d, const pg_work_balance *w, const double *f);
int       force_balance_due  (const pg_system *s);
void      force_balance_warn (pg_statistics *report, const pg_problem *problem);
/* The work alone, from the work balance at hand. */
pg_status break_loop_book    (break_loop *b, double scale);
/* What work is summed from, and the energies of the report, kept at the start of a step; put back where it is
 * refused. */
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

/* "adr, relax": the names of all entries that fit. */
void solver_names_that (int (*fits) (const pg_solver_type *type, const void *context), const void *context,
                        char *text, size_t size);

/* ---- options.c: parts of `read` of several solvers ----------------------------------------------------- */
double options_number  (const pg_scene *scene, const char *key);       /* 0 where it is not given */
long   options_integer (const pg_scene *scene, const char *key);
int    options_begin_cracks (const pg_problem *problem);   /* new cracks begin where a strength is reached */
/* solver.dt, end and time_steps. The caller says whether the step may be left to the solver: then one of the
 * last two is enough; else two of the three are needed. */
void   options_read_times (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
/* PG_E_SCENE: what is found wrong with a key while the solver is made or begins, placed in the scene if
 * options.scene knows it. */
pg_status options_fault (const pg_solver_options *o, const char *key, const char *format, ...)
    __attribute__ ((format (printf, 3, 4)));
/* PG_E_USAGE of a folder without keys becomes PG_E_SCENE at `key`, by its last message; else `status`. */
pg_status options_blame (pg_status status, const pg_solver_options *o, const char *key);

/* ---- stage_path.c: stages of loading (problem->stage) -------------------------------------------------- */
/* Why a stage ends. */
enum { STAGE_GOES_ON, STAGE_LOADS, STAGE_GAUGE, STAGE_FORCE, STAGE_EVENTS, STAGE_GROWTH, STAGE_RUN };
typedef struct {
    long   number;                                     /* of the stage at hand, from 1; 0: the run has none */
    int    over;                                       /* STAGE_...: it ends with this step */
    long   first_step, first_event;                    /* of the state when it began */
    double first_growth;                               /* stage_growth at its start, m (3D: m^2) */
    double peak;                                       /* until.load: largest force in this stage, N */
    double side;  /* until.gauge: 1: it comes from below, -1: from above, 0: not known yet */
} stage_place;
typedef struct {
    /* forces of what this stage removes, N (ndof; NULL: nothing): at its start, and now */
    double     *excavated, *excavated_now;
    stage_place now, before;                           /* before: at the start of the step at hand */
    long        level_before;                          /* s->next_level there */
    pg_problem *staged;                                /* with loads of the solver's own */
    double     *share;  /* per stage: of its way, at which it ended; 1 while it has not */
    double     *opening;                               /* of all records (stages x gauges) */
    signed char *here;                                 /* per end of a gauge: measured here; -1: not known */
    pg_stage_record *record;                           /* per stage */
} stage_path;

struct pg_solver {
    const pg_solver_type *type;
    pg_solver_options options;
    const pg_problem *problem;
    break_loop   break_loop;
    pg_statistics report;
    int shared;                                        /* the report is that of all ranks */
    int begun, started, finished, warned_overlap, warned_energy, warned_facets,
           warned_balance, warned_blind, warned_alone;
    long      next_level;                              /* next level to report: next_level / levels */
    double    turned, turned_at;                       /* largest turn of a family, rad; since when */
    pg_state *backup;                                  /* last accepted state, for refused steps */
    long      evaluations, spared;                     /* of forces by explicit steps; for rows: not made */
    /* 1: alive bits of backup and state differ in the bonds of the last step's list alone */
    int       follows;
    double   *reaction;
    pg_tip_values *tip; size_t ntip, cap_tip;  /* measured at tips, or at vertices in the last step */
    stage_path stage;
    const pg_platen_values *moving;                    /* of platens in explicit steps; NULL: none */
    void     *own;  /* what the method alone knows (type->own_size bytes), or NULL */
};

/* What every way to a first step has in common: pg_solver_begin, then what the method starts with. */
pg_status solver_start  (pg_solver *s, pg_state *state);
/* Before the system is made: the problem becomes the solver's own where it has stages. */
pg_status stages_create (pg_solver *s);
void      stages_free   (pg_solver *s);
pg_status stages_keep   (pg_solver *s, const pg_keeper *k);
pg_status stages_moved  (pg_solver *s, const pg_moved *m, int within);  /* without what stages remove */
/* t at the start and end of the stage at hand (no stages: 0 and 1); at the next level. */
double    stage_start   (const pg_solver *s);
double    stage_end     (const pg_solver *s);
double    stage_level   (const pg_solver *s);
long      stage_steps   (const pg_solver *s, long number);             /* fixed load steps of a stage */
int       stage_moves   (const pg_solver *s);          /* does any load change in it? */
/* Length (space: area) that cracks have grown since the start of the run, m (m^2). */
double    stage_growth  (const pg_state *state);
/* At the start of a step: where the last one ended its stage, the next begins. 1: it did, and the state is at
 * its start, with the same loads and displacements. */
int       stage_next    (pg_solver *s, pg_state *state);
/* After that: takes out what the stage removes, with the displacement at its start. */
pg_status stage_remove  (pg_solver *s, pg_state *state);
/* The forces of it at t. */
void      stage_bear    (pg_solver *s, double t);
/* Event stepping, d = base + (t - start) (unit - base) between t = now and *factor: if until.gauge is met
 * there, the stage is over and *factor is where. */
pg_status stage_cross   (pg_solver *s, const pg_state *state, const double *base, const double *unit,
                         double now, double *factor, int *crosses);
/* Does a state that bears its loads meet a condition of until? Then the stage is over. Event stepping leaves
 * until.gauge to stage_cross. */
pg_status stage_meets   (pg_solver *s, const pg_state *state, const double *reaction, int *meets);
/* A step is accepted: what was at the end of a stage; the end of the last one is that of the run. */
pg_status stage_close_step (pg_solver *s, const pg_state *state, pg_step *step);
void      stage_save    (pg_solver *s);                /* before a step; where it is refused */
void      stage_return  (pg_solver *s);

/* ---- tip_values.c -------------------------------------------------------------------------------------- */
/* Notes what was measured at a tip or vertex, in the place of what was known of it. */
pg_status solver_note_tip  (pg_solver *s, const pg_tip_values *values);
pg_status solver_keep_tips (pg_solver *s, const pg_keeper *k);

/* ---- warnings.c ---------------------------------------------------------------------------------------- */

/* turns.c: after a step; warns of families that have turned. */
void solver_note_turns (pg_solver *s, const pg_state *state, const pg_step *step);

/* loaded_rows.c: warns of tractions that tear off the points they act on; the force is refreshed. */
pg_status doubt_loaded_rows (pg_solver *s);

/* ---- progress.c ---------------------------------------------------------------------------------------- */
/* One of the ends that a run may come to, and how far it has come towards it: the nearest counts. */
void progress_offer (pg_progress *p, double share, const char *end, int even);

/* ---- checkpoint.c -------------------------------------------------------------------------------------- */
/* A text in an array of fixed size, ended whatever was read. */
/* Counts, time, load factor and work; where the solver is among levels and rounds. */
pg_status keep_state_numbers (pg_state *s, const char *name, const pg_keeper *k);
pg_status keep_solver_counts (pg_solver *s, const pg_keeper *k);
pg_status keep_report (pg_statistics *r, const pg_keeper *k);
/* What each of several ranks has of its own points, of the last step made: shares of the sums of all. */
enum { SHARE_BROKEN, SHARE_WORK, SHARE_REPORTED, SHARE_STRAIN, SHARE_KINETIC, SHARE_EXTERNAL, SHARE_DAMPING,
       SHARE_DISSIPATED, SHARES };

/* ---- moved.c ------------------------------------------------------------------------------------------- */
/* The work balance of (t, d) at rest becomes that of the last accounted state, no work being added. Loads
 * scaled by `scale`. */
pg_status moved_balance (break_loop *b, double t, const double *d, double scale);
#endif
