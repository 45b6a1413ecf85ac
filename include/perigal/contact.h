/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.h: bodies that touch, and the faces of closed cracks: unilateral contact with Coulomb's friction as
 * a small dense problem of complementarity, and the pieces of cracks that it is asked for.
 *
 * A *pair* belongs to a piece of surface: its mean gap g_n (positive: open) and its mean slip g_t, a number
 * in the plane and two in space, all linear in the displacement, g = g0 + G d. A force of the pair is
 * conjugate to it: G' f acts on the nodes, so that f_n >= 0 presses the two sides apart and f_t resists the
 * slip. With K u = F + G' f,
 *
 *     g = g0 + C f,    C = G K^-1 G'  (symmetric, positive definite, m/N),    g0: without contact,
 *     g_n >= 0,  f_n >= 0,  f_n g_n = 0,    |f_t| <= mu f_n + c where f_n > 0,  a slip opposes f_t:
 *
 * the stiffness stays as it is, and only pairs of numbers remain (Signorini 1933; Coulomb; condensed as in
 * Klarbring 1986). A pair has `dim` rows: its normal, then dim - 1 tangents, which are at right angles to
 * each other; |.| is the length of the two numbers in space (Coulomb's cone). */
#ifndef PERIGAL_CONTACT_H
#define PERIGAL_CONTACT_H
#include "perigal/fracture.h"

PG_API_BEGIN

/* ---- the problem of complementarity -------------------------------------------------------------------- */
/* How a pair stands: apart; together without slip; sliding towards positive or negative g_t (plane); sliding
 * in a direction of its own (space). */
typedef enum {
    PG_CONTACT_OPEN, PG_CONTACT_STICK, PG_CONTACT_FORWARD, PG_CONTACT_BACKWARD, PG_CONTACT_SLIDING
} pg_contact_status;

/* All borrowed. Row dim k is the normal of pair k, dim k + 1 .. dim k + dim - 1 are its tangents. */
typedef struct {
    size_t n, dim;                                     /* pairs; rows of each: 2 (plane) or 3 (space) */
    const double *C;                                   /* compliance, m/N (dim n x dim n, symmetric) */
    const double *gap;                                 /* g0: gaps and slips without contact, m (dim n) */
    const double *coefficient;                         /* of friction, mu >= 0 (n); NULL: none */
    const double *cohesion;                            /* c: force that a closed pair bears besides, N (n) */
    /* slip that there was before, m (n x (dim - 1)): a pair that sticks keeps it; NULL: none */
    const double *slip;
} pg_contact_problem;

/* What solves it; arrays of the caller's. */
typedef struct {
    double *force, *gap;                               /* f, N; g, m (dim n each) */
    unsigned char *status;                             /* pg_contact_status of each pair (n) */
    size_t open, stick, sliding;                       /* pairs of each kind */
    size_t sweeps, passes;                             /* of relaxation; of the active set */
    double violation;                                  /* of the worst condition (pg_contact_violation) */
} pg_contact_solution;

/* Solves it: relaxation of one pair after the other (projected Gauss-Seidel) finds how the pairs stand, a
 * dense solve with the conditions that belong to that makes it exact, until nothing changes. Conditions are
 * homogeneous but for c: k times the gaps give k times the forces. PG_E_EQUILIBRIUM: the pairs do not settle
 * (friction so high that there may be no equilibrium); PG_E_USAGE, PG_E_MEMORY. */
pg_status pg_contact_solve (pg_contact_solution *out, const pg_contact_problem *problem);
/* How far forces and gaps are from solving the problem: the largest of all violations, those of forces turned
 * into lengths by the diagonal of C, over the largest |g0|. */
double pg_contact_violation (const pg_contact_problem *problem, const pg_contact_solution *s);

/* ---- along a path of loads ----------------------------------------------------------------------------- */
/* Loads that are a constant part and s times another: without contact the gaps are gap + s rate. While no
 * pair changes its status forces and gaps are straight lines of s, too (a *stretch*), and the next change
 * follows from a ratio test. Rate form: a slip goes on from where it is, so that pairs stick when it turns
 * round, and what happened before counts; total form: slips count from `slip` at every s, which a path may
 * be followed to and fro with. Borrowed. */
typedef struct {
    size_t n, dim;                                     /* pairs; rows of each; 3: without friction alone */
    const double *C, *gap, *rate;                      /* m/N (dim n x dim n); m, m per s (dim n each) */
    const double *coefficient, *cohesion;              /* as in a problem (n); NULL: none */
    const double *slip;                                /* m (n (dim - 1)): total form; NULL: rate form */
} pg_contact_path;
/* Where a track along it stands, in arrays of the caller's. */
typedef struct {
    double s;
    double *force, *gap;                               /* there: N, m (dim n each) */
    double *force_rate, *gap_rate;                     /* of the stretch, per unit of s (dim n each) */
    unsigned char *status;                             /* pg_contact_status in the stretch (n) */
    unsigned char *due;                                /* 1: it changes at the end of the stretch (n) */
    double end;                                        /* of the stretch */
    int    changes;                                    /* 1: pairs change there, 0: none do */
    int    leapt;                                      /* 1: force and gap were others before */
    /* pairs that have changed; dense solves and sweeps; leaps: no way went on without one */
    long   total, solves, sweeps, leaps;
} pg_contact_track;
/* Begins at s with the solution of pg_contact_solve there, slips counting from `slip` (m, n; NULL: zero).
 * Errors as there. */
pg_status pg_contact_begin (pg_contact_track *track, const pg_contact_path *path, double s,
                                  const double *slip);
/* The stretch from where the track stands towards `until`, in either sense, which ends where the first pair
 * changes, at the latest there. In total form the statuses are those at hand. Cohesion is lost at once where
 * a pair opens: force and gap leap then, at the same s. PG_E_EQUILIBRIUM: no way leads on. */
pg_status pg_contact_stretch (pg_contact_track *track, const pg_contact_path *path, double until);
/* Along the stretch to s. */
void      pg_contact_go (pg_contact_track *track, const pg_contact_path *path, double s);

/* ---- pieces of cracks ---------------------------------------------------------------------------------- */
/* Mean gaps over pieces of about two spacings are what a discretisation of that spacing can hold closed
 * without pressures that swing from piece to piece (the pairs then satisfy the condition of Ladyzhenskaya,
 * Babuska and Brezzi; one pair per spacing does not). All lengths in local spacings. */
#define PG_CONTACT_PIECE  2.0                          /* length of a piece */
/* paths longer than that are halved where cracks meet */
#define PG_CONTACT_HALVED 1.0
#define PG_CONTACT_POINTS PG_CRACK_POINTS              /* points per spacing that sample the gap */
#define PG_CONTACT_POINTS_SPACE 4                      /* 3D: sampling points per spacing, each way */
#define PG_CONTACT_RADIUS 2.5                          /* how far they see (pg_force_type.jump) */
#define PG_CONTACT_TURN   0.5                          /* rad: no piece goes around such a turn */
typedef struct {
    /* middle, m; unit normal (plane: to the left of the path); directions of slips, dim - 1 of them */
    double x[3], normal[3], tangent[2][3];
    double area;                                       /* of its faces, thickness included, m^2 */
    double length;                                     /* m; space: side of a square of that area */
    size_t path;                                       /* pieces of one path follow each other */
    size_t platen;                                     /* 1 + number of the platen opposite; 0: a crack */
    double arc;                                        /* of its middle along its path, m; space: 0 */
} pg_contact_piece;
/* The cracks of a state in pieces, as far as they cut bonds and lie in the body. */
typedef struct {
    size_t n, dim;  pg_contact_piece *piece;
    /* points that sample the gap: places (x dim), unit normals (x dim), tangents (x dim - 1 x dim), m^2 */
    size_t npoint;  double *x, *normal, *tangent, *weight;
    size_t *first;                                     /* points of piece k: first[k] .. first[k + 1] - 1 */
    /* pieces of the state's cracks, which come first; then those of bonds that broke one by one, a point
     * each: these bonds (places in the family of all points), and the point that each belongs to */
    size_t nknown, nbroken, *broken, *place;
} pg_contact_pieces;
pg_status pg_contact_pieces_create (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);
/* Appends the faces that bonds between points have left which broke one by one: where they are, and which way
 * they face, is told by the dead bonds that no crack of the state cuts. */
pg_status pg_contact_add_broken    (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);
void      pg_contact_pieces_clear  (pg_contact_pieces *pieces);
/* Some points of pieces: how many, their share of all by weight, and the first of them, m. */
typedef struct { size_t n; double share, x[3]; } pg_contact_blind;
/* Their rows as columns of G' (unknowns x dim n): column dim k makes the mean gap of piece k, those after
 * it its mean slips, positive where the face that the normal shows to goes ahead along the tangent (plane:
 * the left face along the path); f acts on the nodes as G' f. *blind: points that see too little on one
 * side even by wider supports (pg_rows_widen), and do not count. PG_E_USAGE: a piece has no other points;
 * where single bonds break its columns are empty then. */
pg_status pg_contact_rows (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *problem,
                           const pg_force_type *force, void *self, const pg_state *state,
                           pg_contact_blind *blind);

/* The largest overlap of the faces at the points that sample the gaps, m, of the displacement d (unknowns);
 * 0: they overlap nowhere. */
pg_status pg_contact_overlap (double *overlap, const pg_contact_pieces *pieces, const pg_force_type *force,
                              void *self, const pg_state *state, const double *d);

/* Mean gaps and slips of the pieces as G' (unknowns x dim n), from displacements or jumps at their points. */
pg_status pg_contact_rows_of (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *problem,
                              const pg_jump_rows *jump);

/* ---- platens ------------------------------------------------------------------------------------------- */
/* The surface of the body that faces a platen (problem->platen) in pieces of about two spacings, their
 * normals from the platen towards the body; *gap: mean distance of each at the start, m, which the caller
 * frees. Slips are those of the body over the platen. */
pg_status pg_platen_pieces_create (pg_contact_pieces *out, double **gap, const pg_problem *problem,
                                   size_t platen);
/* Least distance of the surface of these pieces from the platen at the start, m; h: spacing there. */
double pg_platen_touches (const pg_contact_pieces *pieces, const pg_platen *platen, double h);
/* What the gap and the slips of piece k gain by each of six motions of its platen: translations along x, y, z
 * (per m), rotations about axes through `about` (m, per rad). row: dim x 6. */
void pg_platen_row (const pg_contact_pieces *pieces, size_t k, const double *about, double *row);
/* G' of the gaps and slips of pieces by the bonds that crossed the cracks (pg_force_type.faces); soft, m/N
 * (dim n): compliance of the layer between faces; *stiffer: how much stiffer than those bonds it may be. */
pg_status pg_contact_layer (pg_sparse *out, double *soft, double *stiffer, const pg_contact_pieces *pieces,
                            const pg_force_type *force, void *self, const pg_state *state);

/* ---- what a scene asks for ----------------------------------------------------------------------------- */
typedef enum { PG_CONTACT_NONE, PG_CONTACT_NORMAL, PG_CONTACT_FRICTION } pg_contact_kind;
/* What is looked at: faces of cracks whose normals are known; or all points that no live bond joins, which
 * short-range forces keep apart. */
typedef enum { PG_CONTACT_FACES, PG_CONTACT_SHORT_RANGE } pg_contact_search;
typedef struct {
    pg_contact_kind kind;
    double coefficient, cohesion;                      /* mu; c, Pa */
    pg_contact_search search;
    double distance, stiffness;                        /* of short-range forces: in spacings; a factor */
    int    impulses;                                   /* 1: points are held apart by impulses, not springs */
} pg_contact_setting;
/* Reads the section `contact`. */
pg_contact_setting pg_contact_read (const pg_scene *scene);

/* ---- short-range forces -------------------------------------------------------------------------------- */
/* Points that no live bond joins repel each other when they come nearer than a contact distance, so that
 * bodies, fragments and the faces of cracks do not pass through each other (Silling and Askari 2005; Madenci
 * and Oterkus 2014, section 10.2). Of a pair that is r apart now, and was |X| apart at the start, F_n = k (l
 * - r), l = min (distance (s_i + s_j) / 2, |X|), s: local spacing, k = stiffness M min (V_i / s_i^2, V_j /
 * s_j^2), M = 2 M_i M_j / (M_i + M_j), along the line between them (a pair whose bond broke while it was
 * nearer than l: l is what it was apart then, until it has been l apart): no force at the start, and the
 * stiffness of a column of the material as wide and as long as a spacing (M = density c_p^2). Friction: a
 * spring of stiffness k mu_s / M (mu_s: shear modulus) across that line, made longer by the relative motion
 * of the two, which bears at most coefficient F_n; what it cannot follow is slip. Forces on the two are equal
 * and opposite to the last bit. The faces of a lattice are not smooth: points that slide over others feel
 * their spacing. */
typedef struct pg_short_range pg_short_range;
typedef struct {
    size_t listed, touching;                           /* pairs near each other; pairs that bear a force */
    long   searches, evaluations, free;  /* so far; of these evaluations, those without any pair */
    double energy;                                     /* stored by the forces at hand, J */
    double friction;                                   /* work of friction so far, J */
    double overlap, overlap_max;                       /* largest l - r: now; so far, m */
    double rate;  /* largest sum of 2 k / m over the contacts of a point so far, 1/s^2 */
    /* impulses: sweeps over pairs so far; time steps in which these did not settle */
    long   sweeps, unsettled;
} pg_short_range_report;
/* Unknowns of a point: `stride`, of which the first dim are its displacement. The setting is copied. */
pg_status pg_short_range_create (pg_short_range **out, const pg_problem *problem,
                                 const pg_contact_setting *setting, size_t stride);
void      pg_short_range_free   (pg_short_range **contact);
/* Bound of 2 / m times the sum of k over the contacts of a point, 1/s^2, as many as the faces of bodies have:
 * explicit steps are stable up to 2 / sqrt (omega^2 + this), omega being the largest frequency without. */
double    pg_short_range_rate   (const pg_short_range *contact);
/* Adds the forces on all points to f, N (n x stride), at the displacement of the state; v, m/s: the velocity
 * at which it was reached in the last dt (s; 0: it is the first); way: no point has moved further in that
 * step, m (INFINITY: not known). broken: bonds that died since the last call, if the
 * caller knows all of them, else NULL and `changed` 1. Pairs are found by search, and by another one when
 * points have moved so far that one may be missing. The same bits for any number of threads. */
pg_status pg_short_range_add    (pg_short_range *contact, const pg_state *state, const pg_changes *broken,
                                 int changed, const double *v, double dt, double way, double *f);
/* Contact of points by impulses (setting.impulses): adds to f, N, the forces with which no pair ends the next
 * time step nearer than its contact distance (or than it is, where a bond broke under pressure). Contact
 * takes no energy: pairs part as fast as they met (Moreau 1988, impact without loss), in the ways of
 * leapfrog's two steps; friction holds them across their line with at most coefficient F_n. Momentum and its
 * moment are kept to rounding. now->energy: what pairs took of the motion and give back in the next step. */
typedef struct {
    /* ways of the unknowns in the last step, and in the next one without contact, m (n x stride) */
    const double *back, *ahead;
    const double *inverse;                             /* 1 / mass, 1/kg; 0: prescribed (n x stride) */
    double gain;                                       /* way ahead of a mass of 1 by a force of 1, s^2 */
    int    start;                                      /* 1: no step has led here: nothing is booked */
} pg_point_ways;
pg_status pg_short_range_hold   (pg_short_range *contact, const pg_state *state, const pg_changes *broken,
                                 int changed, const pg_point_ways *ways, double way, double *f);
/* The forces of the last call alone, N (n x stride). */
const double *pg_short_range_forces (const pg_short_range *contact);
const pg_short_range_report *pg_short_range_now (const pg_short_range *contact);
/* The slips at hand, kept at the start of a step, and put back where it is refused; checkpoints. */
pg_status pg_short_range_save   (pg_short_range *contact);
pg_status pg_short_range_return (pg_short_range *contact);
pg_status pg_short_range_keep   (pg_short_range *contact, const pg_keeper *keeper);
/* The pairs nearer than their contact distance at the last evaluation, i < j, ascending (caller frees). */
typedef struct { int i, j; } pg_contact_pair;
pg_status pg_short_range_pairs  (const pg_short_range *contact, const pg_state *state, size_t *n,
                                 pg_contact_pair **pair);

/* ---- platens in explicit steps ------------------------------------------------------------------------- */
/* Rigid platens (problem->platen) press the points that come nearer to their surface than half the contact
 * distance, and nearer than at the start: F_n = k (l - distance), k as above but of the point alone, with
 * friction by a spring across as above. A platen with a mass moves by its forces along all axes on which it
 * has no displacement; momentum of body and platen is kept to rounding. */
typedef struct pg_moving_platens pg_moving_platens;
/* Force on the body, N; how far it has moved, m; its velocity in the half step to come, m/s. */
typedef struct { double force[3], displacement[3], velocity[3]; } pg_moving_platen;
typedef struct {
    size_t touching;                                   /* points */
    long   looks;                                      /* searches for points that may touch */
    double energy, friction, kinetic;                  /* stored; work of friction so far; of platens, J */
    double work;  /* so far: of forces on platens, and of platens that are moved, J */
    double overlap_max, rate;                          /* as pg_short_range_report */
    pg_moving_platen *platen;                          /* as problem->platen */
} pg_moving_report;
/* PG_E_SCENE: a platen is inside the body at the start. */
pg_status pg_moving_platens_create (pg_moving_platens **out, const pg_problem *problem,
                                    const pg_contact_setting *setting, size_t stride);
void      pg_moving_platens_free   (pg_moving_platens **platens);
double    pg_moving_platens_rate   (const pg_moving_platens *platens);         /* as pg_short_range_rate */
/* Moves them from t - dt to t (dt 0: t is the first instant) and adds their forces on the points at d to f; v
 * and way as in pg_short_range_add; step: the length of the step to come, s. */
pg_status pg_moving_platens_add    (pg_moving_platens *platens, const double *d, const double *v, double t,
                                    double dt, double step, double way, double *f);
const double *pg_moving_platens_forces (const pg_moving_platens *platens);
const pg_moving_report *pg_moving_platens_now (const pg_moving_platens *platens);
void      pg_moving_platens_save   (pg_moving_platens *platens);
void      pg_moving_platens_return (pg_moving_platens *platens);
pg_status pg_moving_platens_keep   (pg_moving_platens *platens, const pg_keeper *keeper);
PG_API_END
#endif
