/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: contact of crack faces (perigal/contact.h). In equilibria of linear systems the stiffness and its
 * factor are those of the open cracks; forces of contact stand beside the loads and are found from the
 * condensed compliance of the pieces. Files: contact_solve.c (equilibria), contact_route.c (those along loads
 * with a constant part), contact_motion.c (time steps, relaxation), contact_impact.c (faces that meet in a
 * time step of Newmark's method), contact_results.c, contact_memory.c (what was before: slips, work of
 * friction; checkpoints). */
#ifndef PG_SOLVE_CONTACT_H
#define PG_SOLVE_CONTACT_H
#include "solve/run/body_parts.h"

/* What pieces bore and how far they had slipped in a state: it outlives the pieces, which are others after a
 * crack has grown, and is then taken over place by place. */
typedef struct {
    size_t  n, room;
    double *value;                                     /* of each piece: contact_layout */
    double  friction;                                  /* work of friction so far, J */
    double  at;                                        /* loads with a constant part: their t */
} contact_memory;
/* Place of the middle (dim), length, share of it that is not new, normal (dim), 1 + number of the platen (0:
 * a crack), shear force over area and slip when work was last booked, slip of the last accepted step: numbers
 * along the path in the plane, vectors in space; how far the faces overlapped when they were divided into
 * pieces in motion (contact_impact.c). */
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

/* Rigid motions of parts of the body that supports do not hold: K is singular along them (contact_loose.c).
 * */
typedef struct {
    size_t  n, cap_mode, cap_prop, cap_part, cap_motion, cap_amount, cap_target;
    double *mode;                                      /* displacement of each, about 1 (ndof x n) */
    size_t *prop;                                      /* unknown on which a spring stands for each (n) */
    body_part *part;  size_t *motion;                  /* its part, and which of the motions of that (n) */
    double *amount, *target;  /* how far each has moved; where that puts the feet of the springs, m (n) */
    double  noise;            /* forces along them that are none, N, in the state last solved for */
    size_t  unresisted;       /* ways to move that nothing resisted in the state last solved for */
} contact_loose;

/* Rigid platens (contact_platens.c). */
typedef struct {
    size_t  n;
    pg_contact_pieces all;                             /* of the surface opposite them, platen by platen */
    double *distance, *row;  /* mean distances at the start, m; rows of pg_platen_row (6 dim each) */
    pg_sparse G;                                       /* columns of all pieces */
    unsigned char *taken;                              /* 1: the piece is a pair (all.n) */
    size_t *at;                                        /* piece of each pair behind those of cracks */
    double (*motion)[6], (*reaction)[6];  /* state last solved for: m, rad; forces on the body, N, N m */
    /* forces and ways of each piece when work was last booked; at the step's start (2 dim all.n) */
    double *booked, *start;
    pg_platen_values *shown;
    int     warned;                                    /* PLATENS_..., what has been told */
} contact_platens;
enum { PLATENS_SLIDE = 1, PLATENS_AWAY = 2, PLATENS_UNRESISTED = 4 };

/* Along loads that are a constant part and the share s = t - from times another (contact_route.c). */
typedef struct {
    double  from;
    double *open[2];                                   /* displacements with open cracks at s = 0, 1 (ndof) */
    double  reference;                                 /* the larger of the forces of these, N */
    double *gap, *rate;                                /* without contact: gap + s rate, m (dim n each) */
    int     touches, ready;  /* some piece closes; the stretch at hand leads on from where it stands */
    pg_contact_track track;                            /* force, gap and status are those of the contact */
    double *force_from;                                /* by the line at hand at s = 0, N (dim n) */
    double *mark;  size_t nmark, cap_mark;             /* places to which it may return */
} contact_route;

/* What is true of contact, 1 or 0. */
typedef struct {
    int       said_blind;                              /* points that see too little were told of */
    int       waits;                                   /* 1: cracks have grown, pieces are those before */
    int       active;                                  /* some force is not zero */
    int       began;  /* pieces have been looked for: cracks that had none are new */
    int       touched;                                 /* the last equilibrium asked for the compliance */
    int       history;                                 /* 1: slip has a memory from step to step */
    int       moves;                                   /* 1: the last state solved for is one in motion */
} contact_flags;
/* Displacements and gaps by unit forces between faces. */
typedef struct {
    unsigned long made;                                /* revision of K that Z and C belong to, + 1 */
    unsigned long again;  /* revision, + 1, whose Z and C a resumed run remakes */
    double   *Z, *C;                                   /* K^-1 G' (ndof x dim n); G Z (dim n x dim n), m/N */
} contact_compliance;
struct system_contact {
    pg_contact_setting setting;
    pg_contact_pieces  pieces;                         /* of cracks, then of platens */
    size_t    ncrack;                                  /* pieces of cracks */
    contact_platens platens;
    contact_loose   loose;
    contact_flags is;
    contact_compliance compliance;
    pg_sparse G;                                       /* G', ndof x dim n */
    double   *coefficient, *cohesion;                  /* mu, c A (N), of each piece (n) */
    double   *before;                                  /* slip before (n x (dim - 1)) */
    double   *force, *gap, *open;                      /* f; g; gaps without contact (dim n each) */
    double   *initial;                                 /* gaps without displacement, m (dim n) */
    /* of cracks, what the layer between closed faces gives way by, m/N (dim ncrack): 0 where faces are sharp;
     * how much stiffer than the bonds that crossed it the layer may be */
    double   *soft, stiffer;
    unsigned char *status;                             /* of each piece (n) */
    double   *nodal;                                   /* G' f, N (ndof) */
    /* what stands in the equations of a time step over the mean force of that step; 1 at rest */
    double    weight;
    double   *rebound;                                 /* in motion: mean of impulses in the step, N (n) */
    pg_contact_values *shown;  size_t nshown, cap_shown;         /* of the last step, for results */
    pg_face_piece *press;                              /* pieces that press, for the last tip examined (n) */
    contact_route route;
    contact_memory now, start;                         /* start: of the step, for one that is refused */
};

/* Are faces of cracks kept apart? Platens alone leave them as they are. */
static inline int contact_of_faces (const struct system_contact *c)
{
    return c && c->setting.kind != PG_CONTACT_NONE && c->setting.search == PG_CONTACT_FACES;
}

/* Do forces of contact stand in the equations? */
static inline void contact_set_active (pg_system *s, int active)
{
    s->contact->is.active = active, s->balance.pressed = active ? s->contact->nodal : NULL;
}

/* ---- contact_solve.c ----------------------------------------------------------------------------------- */
pg_status contact_create  (pg_system *s);  /* where the options ask for it: a client of the system */
/* After the force was refreshed: pieces and rows of the cracks of the state. changes: what it was refreshed
 * by; NULL: all. */
pg_status contact_refresh (pg_system *s, const pg_state *state, const pg_changes *changes);
/* Before the first step, pieces being at hand: what equilibria with contact need and do not have. */
pg_status contact_check   (const pg_system *s);
/* Gaps at the displacement d, without the compression of layers by the present contact forces. */
void contact_gaps (struct system_contact *c, const double *d);
/* What the report says of the pieces. */
void contact_count (pg_system *s);
/* The largest overlap of faces, m, into the report: by the points of pieces; without contact by bonds that
 * broke. No memory: nothing is told. */
void contact_note_overlap (pg_system *s, const pg_state *state);
/* What the layers between closed faces store, J: a part of the strain energy of the body. */
double contact_energy (const pg_system *s);
/* How much stiffer the layers between closed faces may be, now and later, than the bonds that they were. */
double contact_stiffer (const pg_system *s);
/* In motion, pairs that were apart at displacement d and bear pressure now: their normal forces on the nodes,
 * N (ndof), and the work that they have done on the gaps that there were, J. */
pg_status contact_impacts (const pg_system *s, const double *d, double *nodal, double *work);
/* The acceleration of the body is a, which knows nothing of contact (newmark.c), and that by its forces: the
 * latter is added, m/s^2. */
void      contact_accelerate (const pg_system *s, double *a);
/* After a step in motion in which cracks have grown: the pieces of now (contact_impact.c). */
pg_status contact_renew   (pg_system *s, const pg_state *state);
/* Impulses so many times these forces stand beside them, for results: s over the time step. */
void      contact_rebound (const pg_system *s, double times);
/* At the start of a run: tips that are closed at full load cut bonds up to an offset of their own. */
pg_status contact_settle_tips (pg_system *s, pg_state *state);
/* What the faces behind a tip do to each other, in the one field at hand, or in the two of a stretch. */
void contact_at_tip (const pg_system *s, const pg_state *state, size_t tip, int nfield, pg_tip_faces *out);
/* Stresses of the faces behind each vertex of a front, times scale, of nfield fields (contact_fronts.c). */
void contact_at_front (const pg_system *s, const pg_front *front, int nfield, double scale,
                       pg_front_faces *out);

/* The pieces of the state at hand for results, loads scaled. */
pg_status contact_show (pg_system *s, double scale);

/* ---- contact_compliance.c ------------------------------------------------------------------------------ */
/* How many columns Z has: right-hand sides that every new K is solved with. */
double    contact_columns  (const pg_system *s);
/* Before an equilibrium: where the last one needed the compliance, whose columns are worth a factor of the K
 * of now, the factor is made first, as the equilibrium of open cracks then is one solve. */
pg_status contact_factor   (pg_system *s);
/* Z and C for the K of now, unless they are. PG_E_NOT_SPD: a column is not finite. */
pg_status contact_condense (pg_system *s, const dynamics *dyn);

/* ---- contact_motion.c ---------------------------------------------------------------------------------- */
/* Adds forces of contact at d to the residual. follow: slips are kept and friction is booked (a time step);
 * else they are those of the last accepted step. */
void contact_push (pg_system *s, const double *d, double *residual, int follow);
/* Adds sum_j |K_ij| of the layers, N/m. */
void contact_row_sums (const pg_system *s, double *sum);

/* After pieces of platens have been taken: pairs anew. */
pg_status contact_more_pairs (pg_system *s);

/* ---- contact_platens.c: all do nothing without platens, or without contact (s->contact NULL) ----------- */
pg_status platens_create  (pg_system *s);
void      platens_free    (contact_platens *platens);
void      platens_take    (pg_system *s);              /* marks the pieces that are pairs from the start */
pg_status platens_refresh (pg_system *s, const pg_state *state);       /* rows of the state; then joins */
pg_status platens_join    (pg_system *s);              /* pieces and rows of cracks and of what is taken */
/* Platens where their displacements at t put them, free motions at 0; initial gaps of their pairs. */
void      platens_place   (pg_system *s, double t);
void      platens_gaps    (pg_system *s);              /* initial gaps for the motions at hand */
/* Marks pieces that are no pairs and overlap at d; 1: there are some. */
int       platens_look    (pg_system *s, const double *d);
/* Force along axis k on a platen at t, N. */
double    platens_press   (const pg_problem *p, size_t platen, int k, double t);
void      platens_react   (pg_system *s);              /* reactions from the forces of the pairs */
void      platens_tell    (pg_system *s);              /* what is doubtful about the state at the end */
/* Work from the state booked last to the one at hand, loads scaled, J. */
double    platens_book    (pg_system *s, double scale);
/* Fills in the reactions of their loads (PG_REACTIONS a load). */
void      platens_reactions (const pg_system *s, double *reaction);
double    platens_secant  (const pg_system *s);        /* sum of reactions times motions, J */
void      platens_show    (pg_system *s, double scale);
void      platens_doubt   (pg_system *s);              /* warns where the body slides along a curved one */
void      platens_save    (contact_platens *platens);
void      platens_return  (contact_platens *platens);
pg_status platens_keep    (pg_system *s, const pg_keeper *k);
/* platen_options.c: what does not go together with platens, as faults of the scene; 1: all of them touch the
 * body from the start on whole facets, so that equilibria scale with the load. */
void      platens_check   (const pg_solver_options *o, const pg_problem *problem, const pg_scene *scene);
int       platens_touch   (const pg_problem *problem);

/* ---- contact_loose.c ----------------------------------------------------------------------------------- */
pg_status loose_refresh (contact_loose *l, const pg_system *s);
void      loose_free    (contact_loose *l);
double    loose_pull    (const pg_system *s, const double *d);         /* the largest of them, N */
void      loose_move    (contact_loose *l, size_t ndof, size_t mode, double by, double *d);

/* ---- contact_free.c ------------------------------------------------------------------------------------ */
size_t    contact_motions (const pg_system *s);        /* how many amounts are unknowns */
/* As pg_contact_solve, with free motions: `open` are gaps without forces, those of the motions at hand in
 * them (it is scratch). Motions, initial gaps and d of loose parts follow. */
pg_status contact_press_free (pg_system *s, double t, pg_contact_solution *out, double *open, double *d);

/* ---- contact_route.c ----------------------------------------------------------------------------------- */
void contact_route_clear (struct system_contact *c);
void contact_route_free  (struct system_contact *c);
/* Equilibria with open cracks at t = from and from + 1 (guesses: base, unit), and that with contact at
 * c->now.at, slips counting from the last accepted ones. */
pg_status contact_route_begin (pg_system *s, double from, double *base, double *unit, double *residual);
/* base and unit become the line of the stretch that leads on from where it stands, towards s = 1; *fresh 0:
 * they were it. */
pg_status contact_route_ahead (pg_system *s, double *base, double *unit, double *residual, int *fresh);
/* base and unit become the line of the stretch from here back towards s = 0, in total form: slips count from
 * the last accepted ones all the way. contact_route_behind takes up the path behind a change of status. */
pg_status contact_route_back   (pg_system *s, double *base, double *unit, double *residual);
pg_status contact_route_behind (pg_system *s);
/* t at which the stretch ends, without contact never; 1: at its beginning forces and gaps have leapt. */
double contact_route_end     (const pg_system *s);
int    contact_route_leapt   (const pg_system *s);
pg_status contact_route_go   (pg_system *s, double t);         /* to t in the stretch */
long      contact_route_due  (const pg_system *s);             /* pieces that change where it stands */
/* Marks the place where it stands; goes back to mark k, with the displacement there (NULL: no matter). */
pg_status contact_route_mark   (pg_system *s);
size_t    contact_route_marks  (const pg_system *s);
void      contact_route_return (pg_system *s, size_t k, double *d);
void      contact_route_forget (pg_system *s);         /* all marks */
pg_status contact_route_keep   (pg_system *s, const pg_keeper *k);

/* ---- contact_memory.c ---------------------------------------------------------------------------------- */
/* Numbers along the tangents of piece k, times scale, as a vector (space: 3) or a number (plane: 1). */
void      contact_vector   (const pg_contact_pieces *pieces, size_t k, const double *along, double scale,
                            double *out);
/* Values of the memory at the pieces at hand. */
pg_status contact_remember (struct system_contact *c);
/* Slips of the last accepted step and overlaps to begin with, as the memory has them. */
void      contact_recall   (struct system_contact *c);
/* Work of friction from the state booked last to the one at hand, loads scaled. */
void      contact_book    (pg_system *s, double scale);
void      contact_accept  (pg_system *s);              /* a step has ended: its slips are kept */
pg_status contact_save    (pg_system *s);
void      contact_return  (pg_system *s);
pg_status contact_keep    (pg_system *s, const pg_keeper *k);
#endif
