/* SPDX-License-Identifier: GPL-3.0-or-later
 * contact.h: contact between bodies and between the faces of closed cracks: unilateral contact with Coulomb's
 * friction as a small dense complementarity problem, and the pieces of surface on which it is imposed.
 *
 * A *pair* belongs to a piece of surface: its mean gap g_n (positive: open) and its mean slip g_t, one number
 * in 2D and two in 3D, all linear in the displacement, g = g0 + G d. A force of the pair is conjugate to it:
 * G' f acts on the nodes, so that f_n >= 0 presses the two sides apart and f_t resists the slip. With K u = F
 * + G' f,
 *
 *     g = g0 + C f,    C = G K^-1 G'  (symmetric, positive definite, m/N),    g0: without contact,
 *     g_n >= 0,  f_n >= 0,  f_n g_n = 0,    |f_t| <= mu f_n + c where f_n > 0,  a slip opposes f_t:
 *
 * the stiffness stays as it is, and only pairs of numbers remain (Signorini 1933; Coulomb; condensed as in
 * Klarbring 1986). A pair has `dim` rows: its normal, then dim - 1 tangents, which are at right angles to
 * each other; |.| is the length of the two numbers in 3D (Coulomb's cone). */
#ifndef PERIGAL_CONTACT_H
#define PERIGAL_CONTACT_H
#include "perigal/fracture.h"

PG_API_BEGIN

/* ---- the problem of complementarity -------------------------------------------------------------------- */
/* Status of a pair: open; closed without slip; sliding towards positive or negative g_t (2D); sliding in any
 * direction (3D). */
typedef enum {
    PG_CONTACT_OPEN, PG_CONTACT_STICK, PG_CONTACT_FORWARD, PG_CONTACT_BACKWARD, PG_CONTACT_SLIDING
} pg_contact_status;

/* A contact problem (all arrays borrowed). Row dim k is the normal of pair k, dim k + 1 .. dim k + dim - 1
 * are its tangents. */
typedef struct {
    size_t n, dim;                                     /* number of pairs; rows of each: 2 (2D) or 3 (3D) */
    const double *C;                                   /* compliance, m/N (dim n x dim n, symmetric) */
    const double *gap;                                 /* g0: gaps and slips without contact, m (dim n) */
    const double *coefficient;                         /* of friction, mu >= 0 (n); NULL: none */
    const double *cohesion;                            /* c: cohesive part of the limit of |f_t|, N (n) */
    /* previous slip, m (n x (dim - 1)), which a sticking pair keeps; NULL: none */
    const double *slip;
} pg_contact_problem;

/* Solution of a contact problem, in arrays of the caller. */
typedef struct {
    double *force, *gap;                               /* f, N; g, m (dim n each) */
    unsigned char *status;                             /* pg_contact_status of each pair (n) */
    size_t open, stick, sliding;                       /* pairs of each kind */
    size_t sweeps, passes;                             /* relaxation sweeps; passes of the active set */
    double violation;                                  /* largest relative violation (pg_contact_violation) */
} pg_contact_solution;

/* Solves the contact problem: projected Gauss-Seidel over the pairs finds their statuses, a dense solve with
 * the conditions of these statuses makes the solution exact, until no status changes. Conditions are
 * homogeneous but for c: k times the gaps give k times the forces. PG_E_EQUILIBRIUM: the pairs do not settle
 * (friction so high that there may be no equilibrium); PG_E_USAGE, PG_E_MEMORY. */
pg_status pg_contact_solve (pg_contact_solution *out, const pg_contact_problem *problem);
/* How far forces and gaps are from solving the problem: the largest of all violations, those of forces turned
 * into lengths by the diagonal of C, over the largest |g0|. */
double pg_contact_violation (const pg_contact_problem *problem, const pg_contact_solution *s);

/* ---- along a path of loads ----------------------------------------------------------------------------- */
/* Contact under loads that grow linearly with a parameter s: without contact the gaps are gap + s rate. While
 * no pair changes its status, forces and gaps are linear in s (such an interval is called a *stretch*); the
 * next change follows from a ratio test. Rate form: slip accumulates, so that pairs stick when its direction
 * reverses (history counts); total form: slips count from `slip` at every s, so that a path can be followed
 * in both directions. Borrowed. */
typedef struct {
    size_t n, dim;  /* number of pairs; rows of each (3: frictionless only) */
    const double *C, *gap, *rate;                      /* m/N (dim n x dim n); m, m per unit of s (dim n) */
    const double *coefficient, *cohesion;              /* as in pg_contact_problem (n); NULL: none */
    const double *slip;                                /* m (n (dim - 1)): total form; NULL: rate form */
} pg_contact_path;
/* Current position on a contact path, in arrays of the caller. */
typedef struct {
    double s;
    double *force, *gap;                               /* at s: N, m (dim n each) */
    double *force_rate, *gap_rate;  /* in the current stretch, per unit of s (dim n each) */
    unsigned char *status;                             /* pg_contact_status in the current stretch (n) */
    unsigned char *due;  /* 1: the pair changes status at the end of the stretch (n) */
    double end;                                        /* value of s at which the stretch ends */
    int    changes;                                    /* 1: pairs change status at `end`, 0: none do */
    int    leapt;                                      /* 1: force and gap have jumped at this s */
    /* numbers so far of status changes, dense solves, relaxation sweeps; leaps: jumps of force and gap */
    long   total, solves, sweeps, leaps;
} pg_contact_track;
/* Starts a track at s with the solution of pg_contact_solve, slips counting from `slip` (m, n; NULL: zero).
 * Errors as of pg_contact_solve. */
pg_status pg_contact_begin (pg_contact_track *track, const pg_contact_path *path, double s,
                                  const double *slip);
/* Finds the stretch (interval without status changes) from track->s towards `until`, upwards or downwards: it
 * ends where the first pair changes, at `until` at the latest. In total form the current statuses are kept.
 * Cohesion is lost at once where a pair opens: force and gap then jump at the same s. PG_E_EQUILIBRIUM: there
 * is no continuation. */
pg_status pg_contact_stretch (pg_contact_track *track, const pg_contact_path *path, double until);
/* Moves the track along its stretch to s. */
void      pg_contact_go (pg_contact_track *track, const pg_contact_path *path, double s);

/* ---- pieces of cracks ---------------------------------------------------------------------------------- */
/* Mean gaps over pieces of about two spacings are what a discretisation of that spacing can hold closed
 * without pressures that swing from piece to piece (the pairs then satisfy the condition of Ladyzhenskaya,
 * Babuska and Brezzi; one pair per spacing does not). Lengths in local spacings. */
#define PG_CONTACT_PIECE  2.0                          /* mean length of a piece */
/* path length above which end pieces are half as long where cracks meet */
#define PG_CONTACT_HALVED 1.0
#define PG_CONTACT_POINTS PG_CRACK_POINTS              /* points per spacing that sample the gap */
#define PG_CONTACT_POINTS_SPACE 4                      /* 3D: sampling points per spacing, each way */
#define PG_CONTACT_RADIUS 2.5                          /* support radius at these points (surfaces.jump) */
#define PG_CONTACT_TURN   0.5                          /* rad: pieces end where a crack turns by more */
typedef struct {
    /* middle, m; unit normal (2D: to the left of the path); dim - 1 unit directions of slip */
    double x[3], normal[3], tangent[2][3];
    double area;                                       /* area, thickness included, m^2 */
    double length;                                     /* m; 3D: side of a square of that area */
    size_t path;                                       /* pieces of one path follow each other */
    size_t platen;                                     /* 1 + number of the platen opposite; 0: a crack */
    double arc;                                        /* arc length of its middle along its path, m; 3D: 0 */
} pg_contact_piece;
/* The cracks of a state divided into pieces, as far as they cut bonds and lie in the body. */
typedef struct {
    size_t n, dim;  pg_contact_piece *piece;
    /* points that sample the gap: positions, m (x dim), unit normals (x dim), tangents (x dim - 1 x dim),
     * areas, m^2 */
    size_t npoint;  double *x, *normal, *tangent, *weight;
    size_t *first;                                     /* points of piece k: first[k] .. first[k + 1] - 1 */
    /* nknown: pieces of cracks of the state, which come first; then pieces of the nbroken bonds that broke
     * one by one: index of each bond in the family of all points, and its sampling point */
    size_t nknown, nbroken, *broken, *place;
} pg_contact_pieces;
pg_status pg_contact_pieces_create (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);
/* Appends pieces for crack faces formed by point-point bonds that broke one by one: position and normal
 * follow from the broken bonds that no crack of the state cuts. */
pg_status pg_contact_add_broken    (pg_contact_pieces *out, const pg_problem *problem, const pg_state *state);
void      pg_contact_pieces_clear  (pg_contact_pieces *pieces);
/* Sampling points without values: how many, their fraction of the total area, position of the first, m. */
typedef struct { size_t n; double share, x[3]; } pg_contact_blind;
/* Computes G' (unknowns x dim n) of the pieces: column dim k gives the mean gap of piece k, the following
 * ones its mean slips, positive where the face on the side of the normal moves along the tangent (2D: the
 * left face along the path); forces f act on the nodes as G' f. *blind: sampling points with too few
 * neighbours on one side, even with wider supports (pg_rows_widen), which are left out. PG_E_USAGE: a piece
 * has no other points (its columns are empty instead where single bonds break). */
pg_status pg_contact_rows (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *problem,
                           const pg_force_type *force, void *self, const pg_state *state,
                           pg_contact_blind *blind);

/* Largest overlap of crack faces at the points that sample the gaps, m, under the displacement d (unknowns);
 * 0: they overlap nowhere. */
pg_status pg_contact_overlap (double *overlap, const pg_contact_pieces *pieces, const pg_force_type *force,
                              void *self, const pg_state *state, const double *d);

/* Computes G' (unknowns x dim n) of mean gaps and slips of pieces from displacements or jumps at their
 * points. */
pg_status pg_contact_rows_of (pg_sparse *out, const pg_contact_pieces *pieces, const pg_problem *problem,
                              const pg_jump_rows *jump);

/* ---- platens ------------------------------------------------------------------------------------------- */
/* Divides the surface of the body that faces a rigid platen (problem->platen) into pieces of about two
 * spacings, their normals from the platen towards the body; *gap: mean initial distance of each, m (n; the
 * caller frees it). Slips are those of the body relative to the platen. */
pg_status pg_platen_pieces_create (pg_contact_pieces *out, double **gap, const pg_problem *problem,
                                   size_t platen);
/* Least initial distance between the surface of these pieces and the platen, m; h: local spacing, m. */
double pg_platen_touches (const pg_contact_pieces *pieces, const pg_platen *platen, double h);
/* Derivatives of the gap and the slips of piece k with respect to six rigid motions of its platen:
 * translations along x, y, z (per m), rotations about axes through `about` (m, per rad). row: dim x 6. */
void pg_platen_row (const pg_contact_pieces *pieces, size_t k, const double *about, double *row);
/* Computes G' of the gaps and slips of pieces from the bonds that crossed the cracks (surfaces.faces of the
 * force); soft, m/N (dim n): compliance of the layer between the faces; *stiffer: largest allowed ratio of
 * its stiffness to that of those bonds. */
pg_status pg_contact_layer (pg_sparse *out, double *soft, double *stiffer, const pg_contact_pieces *pieces,
                            const pg_force_type *force, void *self, const pg_state *state);

/* ---- what a scene asks for ----------------------------------------------------------------------------- */
typedef enum { PG_CONTACT_NONE, PG_CONTACT_NORMAL, PG_CONTACT_FRICTION } pg_contact_kind;
/* Where contact is searched for: on faces of cracks with known normals; or between all points that no intact
 * bond joins, which short-range forces keep apart. */
typedef enum { PG_CONTACT_FACES, PG_CONTACT_SHORT_RANGE } pg_contact_search;
typedef struct {
    pg_contact_kind kind;
    double coefficient, cohesion;                      /* mu; c, Pa */
    pg_contact_search search;
    double distance, stiffness;  /* short-range forces: range in spacings; stiffness factor */
    int    impulses;                                   /* 1: points are held apart by impulses, not springs */
} pg_contact_setting;
/* Reads the section `contact`. */
pg_contact_setting pg_contact_read (const pg_scene *scene);

/* ---- short-range forces -------------------------------------------------------------------------------- */
/* Points that no intact bond joins repel each other when they come nearer than a contact distance, so that
 * bodies, fragments and the faces of cracks do not pass through each other (Silling and Askari 2005; Madenci
 * and Oterkus 2014, section 10.2). For a pair with current distance r and initial distance |X|, F_n = k (l
 * - r), l = min (distance (s_i + s_j) / 2, |X|), s: local spacing, k = stiffness M min (V_i / s_i^2, V_j /
 * s_j^2), M = 2 M_i M_j / (M_i + M_j), along the line between them (if its bond broke at a distance below l,
 * that distance replaces l until the pair has been l apart): no force at the start, and the stiffness of a
 * column of the material as wide and as long as a spacing (M = density c_p^2). Friction: a spring of
 * stiffness k mu_s / M (mu_s: shear modulus) across that line, stretched by the relative motion of the two
 * points and bearing at most coefficient F_n; the excess is slip. Forces on the two are equal and opposite to
 * the last bit. The faces of a lattice are not smooth: points that slide over others feel their spacing. */
typedef struct pg_short_range pg_short_range;
typedef struct {
    size_t listed, touching;  /* numbers of candidate pairs; of pairs that bear a force */
    long   searches, evaluations, free;  /* counts so far; free: evaluations without any pair */
    double energy;                                     /* potential energy of the current forces, J */
    double friction;                                   /* work of friction so far, J */
    double overlap, overlap_max;                       /* largest l - r: now; so far, m */
    double rate;  /* largest sum of 2 k / m over the contacts of a point so far, 1/s^2 */
    /* impulses: sweeps over pairs so far; time steps in which these did not settle */
    long   sweeps, unsettled;
} pg_short_range_report;
/* Creates short-range contact. stride: unknowns per point, the first dim of which are its displacement. The
 * setting is copied. */
pg_status pg_short_range_create (pg_short_range **out, const pg_problem *problem,
                                 const pg_contact_setting *setting, size_t stride);
void      pg_short_range_free   (pg_short_range **contact);
/* Upper bound, 1/s^2, of 2 / m times the sum of k over the contacts of a point on a face: explicit steps are
 * stable up to 2 / sqrt (omega^2 + bound), omega the largest frequency without contact, rad/s. */
double    pg_short_range_rate   (const pg_short_range *contact);
/* Adds the forces on all points to f, N (n x stride), at the displacement of the state; v, m/s (n x stride):
 * the velocity in the last step of length dt (s; 0: there was none); way: upper bound of the distance that
 * any point moved in that step, m (INFINITY: not known). broken: bonds broken since the last call, if the
 * caller knows all of them, else NULL and `changed` 1. The search for pairs is repeated when points have
 * moved so far that a pair may be missing. Results do not depend on the number of threads. */
pg_status pg_short_range_add    (pg_short_range *contact, const pg_state *state, const pg_changes *broken,
                                 int changed, const double *v, double dt, double way, double *f);
/* Contact of points by impulses (setting.impulses): adds to f, N (n x stride), the forces with which no pair
 * ends the next time step nearer than its contact distance (or than its present distance, if its bond broke
 * under pressure). Contact is elastic: pairs separate as fast as they met (Moreau 1988, impact without loss),
 * measured by the displacements of the last and the next leapfrog step; friction holds them across their line
 * with at most coefficient F_n. Momentum and its moment are kept to rounding. now->energy: kinetic energy
 * that pairs have taken and give back in the next step, J. */
typedef struct {
    /* increments of the unknowns in the last step, and in the next one without contact, m (n x stride) */
    const double *back, *ahead;
    const double *inverse;                             /* 1 / mass, 1/kg; 0: prescribed (n x stride) */
    double gain;                                       /* increment in the next step per force / mass, s^2 */
    int    start;                                      /* 1: first step: no energy or work is recorded */
} pg_point_ways;
pg_status pg_short_range_hold   (pg_short_range *contact, const pg_state *state, const pg_changes *broken,
                                 int changed, const pg_point_ways *ways, double way, double *f);
/* Contact forces on the points in the last evaluation, N (n x stride). */
const double *pg_short_range_forces (const pg_short_range *contact);
const pg_short_range_report *pg_short_range_now (const pg_short_range *contact);
/* pg_short_range_save stores the current slips at the start of a step, pg_short_range_return restores them
 * where the step is rejected; pg_short_range_keep writes or reads checkpoints. */
pg_status pg_short_range_save   (pg_short_range *contact);
pg_status pg_short_range_return (pg_short_range *contact);
pg_status pg_short_range_keep   (pg_short_range *contact, const pg_keeper *keeper);
/* The pairs nearer than their contact distance at the last evaluation, i < j, ascending (caller frees). */
typedef struct { int i, j; } pg_contact_pair;
pg_status pg_short_range_pairs  (const pg_short_range *contact, const pg_state *state, size_t *n,
                                 pg_contact_pair **pair);

/* ---- platens in explicit time integration -------------------------------------------------------------- */
/* Rigid platens (problem->platen) press on points that come nearer to their surface than half the contact
 * distance, and nearer than at the start: F_n = k (l - distance), k and friction as in short-range forces,
 * but with the properties of the point alone. A platen with a mass moves by its forces along all axes on
 * which it has no displacement; momentum of body and platen is kept to rounding. */
typedef struct pg_moving_platens pg_moving_platens;
/* A moving platen: its force on the body, N; its displacement, m; its velocity in the next half step, m/s. */
typedef struct { double force[3], displacement[3], velocity[3]; } pg_moving_platen;
typedef struct {
    size_t touching;                                   /* number of points in contact */
    long   looks;                                      /* number of searches for points that may touch */
    /* potential energy; work of friction so far; kinetic energy of platens, J */
    double energy, friction, kinetic;
    double work;  /* work so far of external forces on platens and of prescribed motions of platens, J */
    double overlap_max, rate;                          /* as in pg_short_range_report */
    pg_moving_platen *platen;                          /* one for each of problem->platen */
} pg_moving_report;
/* PG_E_SCENE: a platen is inside the body at the start. */
pg_status pg_moving_platens_create (pg_moving_platens **out, const pg_problem *problem,
                                    const pg_contact_setting *setting, size_t stride);
void      pg_moving_platens_free   (pg_moving_platens **platens);
double    pg_moving_platens_rate   (const pg_moving_platens *platens);         /* as pg_short_range_rate */
/* Moves the platens from time t - dt to t (s; dt 0: t is the start) and adds their forces on the points at
 * displacement d (m) to f (N); v and way as in pg_short_range_add; step: length of the next time step, s. */
pg_status pg_moving_platens_add    (pg_moving_platens *platens, const double *d, const double *v, double t,
                                    double dt, double step, double way, double *f);
const double *pg_moving_platens_forces (const pg_moving_platens *platens);
const pg_moving_report *pg_moving_platens_now (const pg_moving_platens *platens);
void      pg_moving_platens_save   (pg_moving_platens *platens);
void      pg_moving_platens_return (pg_moving_platens *platens);
pg_status pg_moving_platens_keep   (pg_moving_platens *platens, const pg_keeper *keeper);
PG_API_END
#endif
