/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: contact of crack faces (perigal/contact.h). In equilibria of linear systems the stiffness and its
 * factor are those of the open cracks; forces of contact stand beside the loads and are found from the
 * condensed compliance of the pieces. Files: contact_solve.c (equilibria), contact_route.c (those along loads
 * with a constant part), contact_motion.c (time steps, relaxation), contact_impact.c (faces that meet in a
 * time step of Newmark's method), contact_results.c, contact_memory.c (of earlier states: slips, work of
 * friction; checkpoints). */
#ifndef PG_SOLVE_CONTACT_H
#define PG_SOLVE_CONTACT_H
#include "solve/run/body_parts.h"

/* Forces and slips of pieces in a state, kept by position: when a crack has grown, other pieces take them
 * over. */
typedef struct {
    size_t  n, room;
    double *value;                                     /* contact_layout.values numbers a piece */
    double  friction;                                  /* work of friction so far, J */
    double  at;                                        /* t of this state (loads with a constant part) */
} contact_memory;
/* Positions in contact_memory.value of a piece, which begins with its middle (dim): length, share of it that
 * is not new, normal (dim), 1 + number of the platen (0: a crack), shear force over area and slip when work
 * was last booked, slip of the last accepted step (numbers along the path in 2D, vectors in 3D); overlap of
 * the faces when they were divided into pieces in dynamics (contact_impact.c). */
typedef struct {
    size_t length, old, normal, platen, shear, slip, accepted, overlap, values, parts;
} contact_layout;
static inline contact_layout contact_layout_of (size_t dim)
{
    size_t m = dim == 3 ? 3 : 1, first = 2*dim + 3;
    return (contact_layout){ .length = dim, .old = dim + 1, .normal = dim + 2, .platen = 2*dim + 2,
                             .shear = first, .slip = first + m, .accepted = first + 2*m,
                             .overlap = first + 3*m, .values = first + 3*m + 1, .parts = m };
}

/* Free rigid motions of parts of the body that supports do not hold: K is singular along them
 * (contact_loose.c). */
typedef struct {
    size_t  n, cap_mode, cap_prop, cap_part, cap_motion, cap_amount, cap_target;
    double *mode;                                      /* displacement by each motion, about 1 (ndof x n) */
    size_t *prop;                                      /* unknown with a spring for each motion (n) */
    body_part *part;  size_t *motion;                  /* part of each motion, and its number there (n) */
    double *amount, *target;  /* amount of each motion; spring displacements by it, m (n) */
    double  noise;            /* rounding of forces along them, N, in the state last solved for */
    size_t  unresisted;       /* motions that nothing resisted in the state last solved for */
} contact_loose;

/* Rigid platens (contact_platens.c). */
typedef struct {
    size_t  n;
    pg_contact_pieces all;                             /* pieces of the surfaces opposite, platen by platen */
    double *distance, *row;  /* mean distances at the start, m; rows of pg_platen_row (6 dim each) */
    pg_sparse G;                                       /* G' of all these pieces */
    unsigned char *taken;                              /* 1: the piece is a pair (all.n) */
    size_t *at;                                        /* of each pair, behind those of cracks: its piece */
    double (*motion)[6], (*reaction)[6];  /* of the state last solved for: m, rad; on the body, N, N m */
    /* force and displacement of each piece when work was last booked; at the step's start (2 dim all.n) */
    double *booked, *start;
    pg_platen_values *shown;
    int     warned;                                    /* PLATENS_...: warnings that were given */
} contact_platens;
enum { PLATENS_SLIDE = 1, PLATENS_AWAY = 2, PLATENS_UNRESISTED = 4 };

/* Contact along loads that are a constant part and the share s = t - from of another (contact_route.c). */
typedef struct {
    double  from;
    double *open[2];                                   /* displacements with open cracks at s = 0, 1 (ndof) */
    double  reference;                                 /* larger reference force of these two states, N */
    double *gap, *rate;  /* gaps with open cracks: gap + s rate, m (dim n each) */
    /* touches 1: some piece closes; ready 1: the present linear stretch leads on from the present s */
    int     touches, ready;
    /* contact along a linear stretch of the path; force, gap and status point into system_contact */
    pg_contact_track track;
    double *force_from;                                /* forces of the present line at s = 0, N (dim n) */
    double *mark;  size_t nmark, cap_mark;             /* states to which the path may return */
} contact_route;

/* Flags of contact, 1 or 0. */
typedef struct {
    int       said_blind;  /* a warning of points with too few neighbours was given */
    int       waits;                                   /* cracks have grown since the pieces were made */
    int       active;                                  /* 1: some contact force is not zero */
    int       began;  /* pieces have been made before: cracks without pieces are new */
    int       touched;                                 /* the last equilibrium needed the compliance */
    int       history;                                 /* 1: slips are remembered from step to step */
    int       moves;                                   /* the last state solved for is a dynamic one */
} contact_flags;
/* Displacements and gaps due to unit forces between faces. */
typedef struct {
    unsigned long made;                                /* revision of K that Z and C belong to, + 1 */
    unsigned long again;  /* revision, + 1, whose Z and C a resumed run remakes */
    size_t    alone;  /* number of columns of Z solved one by one, before there was a factor */
    double   *Z, *C;                                   /* K^-1 G' (ndof x dim n); G Z (dim n x dim n), m/N */
} contact_compliance;
struct system_contact {
    pg_contact_setting setting;
    pg_contact_pieces  pieces;                         /* pieces of cracks, then of platens */
    size_t    ncrack;                                  /* pieces of cracks */
    contact_platens platens;
    contact_loose   loose;
    contact_flags is;
    contact_compliance compliance;
    pg_sparse G;                                       /* G': gaps are G d (ndof x dim n) */
    double   *coefficient, *cohesion;                  /* mu, c A (N), of each piece (n) */
    double   *before;  /* slip at the last accepted state, m (n x (dim - 1)) */
    double   *force, *gap, *open;                      /* f, N; g, m; gaps without contact, m (dim n each) */
    double   *initial;                                 /* gaps without displacement, m (dim n) */
    /* compliance of the layer between closed crack faces, m/N (dim ncrack), 0: sharp faces; stiffer: most
     * stiffness of the layer over that of the bonds that crossed it */
    double   *soft, stiffer;
    unsigned char *status;                             /* pg_contact_status of each piece (n) */
    double   *nodal;                                   /* contact forces on nodes, G' f, N (ndof) */
    /* force in the equations of a time step over the mean force of the step; 1 in statics */
    double    weight;
    double   *rebound;                                 /* dynamics: mean of impulses over the step, N (n) */
    pg_contact_values *shown;  size_t nshown, cap_shown;         /* pieces of the last step, for results */
    pg_face_piece *press;                              /* pressing pieces near the last tip examined (n) */
    contact_route route;
    contact_memory now, start;                         /* start: at the start of the step */
};

/* 1: crack faces are kept apart; with platens alone they are not. */
static inline int contact_of_faces (const struct system_contact *c)
{
    return c && c->setting.kind != PG_CONTACT_NONE && c->setting.search == PG_CONTACT_FACES;
}

/* Adds the contact forces to the equations (active 1), or leaves them out. */
static inline void contact_set_active (pg_system *s, int active)
{
    s->contact->is.active = active, s->balance.pressed = active ? s->contact->nodal : NULL;
}

/* ---- contact_solve.c ----------------------------------------------------------------------------------- */
pg_status contact_create  (pg_system *s);  /* only if asked for; becomes the system's client */
/* Finds pieces and rows of the cracks of the state, after the force was refreshed for these changes; NULL:
 * for all. */
pg_status contact_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
/* Called before the first step, pieces being at hand: refuses what equilibria with contact cannot do. */
pg_status contact_check   (const pg_system *s);
/* Gaps at the displacement d, without the compression of layers by the present contact forces. */
void contact_gaps (struct system_contact *c, const double *d);
/* Counts pieces and their status for the report. */
void contact_count (pg_system *s);
/* Puts the largest overlap of faces, m, into the report: at points of the pieces; without contact by broken
 * bonds. Without memory nothing is reported. */
void contact_note_overlap (pg_system *s, const pg_state *state);
/* Elastic energy of the layers between closed faces, J: a part of the strain energy of the body. */
double contact_energy (const pg_system *s);
/* Largest ratio, now and later, of the stiffness of layers between closed faces to that of the bonds they
 * replace. */
double contact_stiffer (const pg_system *s);
/* Dynamics, pairs that were apart at displacement d and bear pressure now: nodal: their normal forces on the
 * nodes, N (ndof); work: done by these on the gaps that there were, J. */
pg_status contact_impacts (const pg_system *s, const double *d, double *nodal, double *work);
/* a += acceleration by contact forces, m/s^2, which the scheme leaves out (newmark.c). */
void      contact_accelerate (const pg_system *s, double *a);
/* Makes the pieces of the present cracks after a dynamic step in which cracks have grown
 * (contact_impact.c). */
pg_status contact_renew   (pg_system *s, const pg_state *state);
/* For results: impulses are `times` these forces (s over the time step). */
void      contact_rebound (const pg_system *s, double times);
/* Called at the start of a run: tips that are closed at full load cut bonds up to an offset of their own. */
pg_status contact_settle_tips (pg_system *s, pg_state *state);
/* Finds what the faces behind a tip do to each other, in the present field, or in the two of a stretch of
 * loads. */
void contact_at_tip (const pg_system *s, const pg_state *state, size_t tip, int nfield, pg_tip_faces *out);
/* Finds the mean stresses on the faces behind each vertex of a front, times scale, of nfield fields
 * (contact_fronts.c). */
void contact_at_front (const pg_system *s, const pg_front *front, int nfield, double scale,
                       pg_front_faces *out);

/* Stores the pieces of the present state for results, loads scaled. */
pg_status contact_show (pg_system *s, double scale);

/* ---- contact_compliance.c ------------------------------------------------------------------------------ */
/* How many columns Z has: right-hand sides that every new K is solved with. */
double    contact_columns  (const pg_system *s);
/* Called before an equilibrium: where the last one needed the compliance, whose columns are worth a factor of
 * the present K, the factor is made first, as the equilibrium of open cracks is then one solve. */
pg_status contact_factor   (pg_system *s);
/* Makes Z and C for the present K, unless they are there. PG_E_NOT_SPD: a column is not finite. */
pg_status contact_condense (pg_system *s, const dynamics *dyn);

/* ---- contact_motion.c ---------------------------------------------------------------------------------- */
/* Adds contact forces at d to the residual. follow 1: slips are updated and friction is booked (a time step);
 * 0: slips are those of the last accepted step. */
void contact_push (pg_system *s, const double *d, double *residual, int follow);
/* sum[i] += sum_j |K_ij| of the layers between faces, N/m. */
void contact_row_sums (const pg_system *s, double *sum);

/* Makes the pairs again after pieces of platens have become pairs. */
pg_status contact_more_pairs (pg_system *s);

/* ---- contact_platens.c: all do nothing without platens, or without contact (s->contact NULL) ----------- */
pg_status platens_create  (pg_system *s);
void      platens_free    (contact_platens *platens);
void      platens_take    (pg_system *s);              /* marks the pieces that are pairs from the start */
pg_status platens_refresh (pg_system *s, const pg_state *state);  /* rows of the state; then platens_join */
pg_status platens_join    (pg_system *s);              /* joins pieces and rows of cracks and taken pieces */
/* Puts platens where their prescribed displacements at t are, free motions at 0; finds initial gaps of their
 * pairs. */
void      platens_place   (pg_system *s, double t);
void      platens_gaps    (pg_system *s);              /* finds initial gaps for the present motions */
/* Marks pieces that are not pairs yet and overlap at displacement d; returns 1 if there are some. */
int       platens_look    (pg_system *s, const double *d);
/* Force along axis k that is applied to a platen at t, N. */
double    platens_press   (const pg_problem *p, size_t platen, int k, double t);
void      platens_react   (pg_system *s);              /* reactions from the forces of the pairs */
void      platens_tell    (pg_system *s);              /* warns of what is doubtful at the end of a run */
/* Work of platens from the state booked last to the present one, loads scaled, J. */
double    platens_book    (pg_system *s, double scale);
/* Fills in the reactions of loads on platens (PG_REACTIONS a load). */
void      platens_reactions (const pg_system *s, double *reaction);
double    platens_secant  (const pg_system *s);        /* sum of reactions times motions, J */
void      platens_show    (pg_system *s, double scale);
void      platens_doubt   (pg_system *s);              /* warns where the body slides along a curved one */
void      platens_save    (contact_platens *platens);
void      platens_return  (contact_platens *platens);
pg_status platens_keep    (pg_system *s, const pg_keeper *k);
/* platen_options.c: reports what does not go together with platens as faults of the scene. platens_touch 1:
 * all platens touch the body from the start on whole facets, so that equilibria scale with the load. */
void      platens_check   (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
int       platens_touch   (const pg_problem *problem);

/* ---- contact_loose.c ----------------------------------------------------------------------------------- */
pg_status loose_refresh (contact_loose *l, const pg_system *s);
void      loose_free    (contact_loose *l);
double    loose_pull    (const pg_system *s, const double *d);         /* largest spring force, N */
void      loose_move    (contact_loose *l, size_t ndof, size_t mode, double by, double *d);

/* ---- contact_free.c ------------------------------------------------------------------------------------ */
size_t    contact_motions (const pg_system *s);        /* number of free motions */
/* Solves as pg_contact_solve does, with free motions. open: gaps without forces, with the present motions
 * (workspace). Updates motions, initial gaps, and d of loose parts. */
pg_status contact_press_free (pg_system *s, double t, pg_contact_solution *out, double *open, double *d);

/* ---- contact_route.c ----------------------------------------------------------------------------------- */
void contact_route_clear (struct system_contact *c);
void contact_route_free  (struct system_contact *c);
/* Finds equilibria with open cracks at t = from and from + 1 (guesses: base, unit), and the one with contact
 * at t = now.at; slips count from the last accepted ones. */
pg_status contact_route_begin (pg_system *s, double from, double *base, double *unit, double *residual);
/* base and unit become the displacements at s = 0 and 1 of the line of the stretch that leads on from the
 * present s, towards s = 1; *fresh 0: they were that line before. */
pg_status contact_route_ahead (pg_system *s, double *base, double *unit, double *residual, int *fresh);
/* base and unit become those of the line of the stretch from here back towards s = 0, in total form: slips
 * count from the last accepted ones all along. contact_route_behind continues the path behind a change of
 * status. */
pg_status contact_route_back   (pg_system *s, double *base, double *unit, double *residual);
pg_status contact_route_behind (pg_system *s);
/* t at which the stretch ends (without contact: INFINITY). contact_route_leapt 1: forces and gaps jumped at
 * its beginning. */
double contact_route_end     (const pg_system *s);
int    contact_route_leapt   (const pg_system *s);
pg_status contact_route_go   (pg_system *s, double t);         /* goes to t within the stretch */
long      contact_route_due  (const pg_system *s);             /* number of pieces that change status here */
/* Marks the present state of the path; contact_route_return goes back to mark k and fills in its displacement
 * d (may be NULL). */
pg_status contact_route_mark   (pg_system *s);
size_t    contact_route_marks  (const pg_system *s);
void      contact_route_return (pg_system *s, size_t k, double *d);
void      contact_route_forget (pg_system *s);         /* forgets all marks */
pg_status contact_route_keep   (pg_system *s, const pg_keeper *k);

/* ---- contact_memory.c ---------------------------------------------------------------------------------- */
/* out = numbers along the tangents of piece k, times scale, as a vector (3D: 3) or a number (2D: 1). */
void      contact_vector   (const pg_contact_pieces *pieces, size_t k, const double *along, double scale,
                            double *out);
/* Takes the values of the memory over to the present pieces. */
pg_status contact_remember (struct system_contact *c);
/* Sets slips of the last accepted step and initial overlaps from the memory. */
void      contact_recall   (struct system_contact *c);
/* Adds the work of friction from the state booked last to the present one, loads scaled. */
void      contact_book    (pg_system *s, double scale);
void      contact_accept  (pg_system *s);              /* ends a step: keeps its slips */
pg_status contact_save    (pg_system *s);
void      contact_return  (pg_system *s);
pg_status contact_keep    (pg_system *s, const pg_keeper *k);
#endif
