/* SPDX-License-Identifier: GPL-3.0-or-later
 * front.h: the parts of the measurement of a front in space, or of a tip in the plane, which is a front of
 * one vertex with one cross section. Files: front_fields.c (materials, loads and fields at the places of
 * integrals), front_integrals.c (integrals over a cross section), front_springs.c (springs within it),
 * williams.c (exact fields); of tips tip_domain.c (rings and the room for them), tip_places.c (places of the
 * integrals), tip_measure.c (all of it), kinked_tip.c (tips with a turn behind them); of fronts front_curve.c
 * (the curve through the vertices and its frame), front_tube.c (how thick a tube around the front may be, and
 * the places in it), front_measure.c (all of it, and the sums for the vertices); kink.c (direction). */
#ifndef PG_FRACTURE_FRONT_H
#define PG_FRACTURE_FRONT_H
#include "mean_motion.h"
#include "perigal/fracture.h"

#define TIP_LEAST 1.5                                  /* spacings: a ring that ends nearer knows nothing */
/* Is a ring of this radius (m) one? A surface 1.5 spacings away, but for rounding, leaves room for it. */
static inline int tip_is_ring (const pg_problem *p, double radius, double h)
{
    return radius + pg_cloud_same (&p->cloud) >= TIP_LEAST * h;
}

enum { TIP_FIELDS = 2 };                               /* most displacement fields at a time */
/* A vertex counts in the stretch of front within HAT vertices of it. Cross sections lie twice between two
 * vertices. Tubes end at one of RADII radii (front_radius); weights begin to fall at one spacing. */
enum { FRONT_HAT = 3, FRONT_SECTIONS = 2, FRONT_RADII = 4 };
static const double front_radius[FRONT_RADII] = { 1.5, 2.25, 3, 4 };       /* in spacings */
static const double front_core = 0.5;                  /* terms along the front end so near to it, spacings */

/* The material at a tip or front. */
typedef struct {
    int    dim;                                        /* 3: in space, plane strain across the front */
    double mu, kappa, modulus;                         /* shear modulus, E', Pa; pg_tip_kappa */
    double density;                                    /* kg/m^3 */
    const pg_material *law;
    /* Pa: the dilatation that carries the pressure is a mean over patches (pg_patches), and lambda its
     * modulus; 0: the stress is that of the strain */
    double lambda;
} tip_material;

/* ---- williams.c ---------------------------------------------------------------------------------------- */
/* Exact fields of a straight front, of K_I, K_II, K_III = 1 Pa m^(1/2), and of a force of 1 N/m on the front
 * along e, in the frame of the front. A[3 m + k] = du_m/dx_k; S: stress, 3 x 3; u: 3. Outputs may be NULL. A
 * tip has no mode III. */
enum { FRONT_I, FRONT_II, FRONT_III, FRONT_FORCE, FRONT_FIELDS };
void front_near_field (int field, const tip_material *m, double r, double theta, double *u, double *A,
                       double *S);
static inline int front_has (const tip_material *m, int field) { return m->dim == 3 || field != FRONT_III; }

/* ---- a measurement ------------------------------------------------------------------------------------- */
/* A place of a front: place (m), frame e (ahead), n (normal of the crack), t = e x n, rows of `frame`; speed:
 * |dx/du| of the curve through the vertices, m. turn: how the frame turns along the front, db/ds = turn x b,
 * in the frame, 1/m. */
typedef struct { double x[3], frame[9], speed, turn[3]; } front_place;

/* Integrals over one cross section for each radius: what stands with the hat, and what stands with its
 * derivative along the front (1/m). J of two fields, I with the exact ones; strain: mean of the strain along
 * the front, by_K: what K = 1 of modes I and II makes of it. */
typedef struct {
    double J[FRONT_RADII][2][2], J_along[FRONT_RADII][2][2];
    double I[FRONT_RADII][FRONT_FIELDS][2], I_along[FRONT_RADII][FRONT_FIELDS][2];
    double strain[2], by_K[2];
} front_sums;

/* A plane across the front. */
typedef struct {
    front_place at;
    double u, length;  /* where on the front, i at vertex i; length of front that it stands for, m */
    size_t node;                                       /* whose material and body force it has */
    tip_material material;
    /* room, m, and for how many radii; number of the load that ends it, -1: none does */
    double room;
    int    radii, load;
    /* 1: the faces behind it touch, and carry a uniform stress across the crack (2 2), along e (1 2) and
     * along the front (2 3), Pa, of each field, which is subtracted */
    int    closed;
    double stress[TIP_FIELDS][3];
    front_sums sums;
} cross_section;

typedef struct {
    const pg_problem *p;
    const pg_force_type *force;
    void *self;
    const pg_state *state;
    int nfield;
    const double *const *d, *t;                        /* as in pg_tip_measure */
    mean_motion field[TIP_FIELDS];
    double pressure[TIP_FIELDS];                       /* in the cracks, of each field, Pa */
    int    moving;                                     /* 1: the one field is in motion */
    double h, r1, radius[FRONT_RADII];  /* spacing; weights fall from r1 to one of the radii, m */
    size_t n;  cross_section *section;
} measuring;

pg_status measuring_check (const measuring *m);        /* PG_E_USAGE: this cannot be measured */
/* The pressures, the fields less their mean motion within `reach` of n places x (m), and whether they move.
 * measuring_end frees these. */
pg_status measuring_begin (measuring *m, size_t n, const double *x, double reach);
void      measuring_end   (measuring *m);
tip_material material_at  (const pg_problem *p, size_t node);
/* Do body forces act on the node? */
int       has_body_force  (const pg_problem *p, size_t node);
/* Nothing is known of a vertex. */
void      measured_nothing (pg_tip_field *out);
/* A closed vertex does not open, and what it sets free is what sliding and tearing do. */
void      measured_closed  (pg_tip_field *out, int nfield);

/* One displacement field at places, in the frame of their cross section but for u. */
typedef struct {
    double *u;                                         /* displacement in scene coordinates, m (n x 3) */
    double *H;                                         /* H[3 m + k] = du_m/dx_k (n x 9) */
    double *S;                                         /* stress, Pa (n x 9) */
    /* mean of the normal stresses above those of the strain, Pa (n); NULL: 0 */
    double *excess;
    double *load;                                      /* b - rho a, N/m^3 (n x 3); NULL: none */
    double *kinetic, *moving;  /* rho v_i v_i,1, N/m^3, kinetic energy, J/m^3 (n); NULL: at rest */
} front_sample;

/* Places in cross sections, in polar coordinates about e, ring after ring. */
typedef struct {
    size_t n, capacity;
    double *r, *theta, *area;                          /* m, rad, r dr dtheta (m^2) (n each) */
    double *x;                                         /* in scene coordinates, m (n x dim) */
    size_t *of;                                        /* number of the cross section (n) */
    front_sample field[TIP_FIELDS];
    double *stress, *gradient;                         /* workspace (n x 6, n x 9) */
} front_places;
pg_status places_create (front_places *out, size_t capacity);
void      places_clear  (front_places *q);
/* All fields at the places, with body forces and inertia if asked, less the stresses of closed faces and the
 * pressure in cracks. */
pg_status places_fields (front_places *q, const measuring *m, int forced, int moving);
/* One field as it is; adds the body force to its load. */
pg_status places_sample (front_places *q, const measuring *m, int field);
pg_status places_force  (front_places *q, const measuring *m, int field);
/* The uniform stresses that are subtracted from place k of a field. */
void      places_part   (front_places *q, const measuring *m, int field, size_t k);

/* ---- front_integrals.c --------------------------------------------------------------------------------- */
/* The weight at r, which falls from 1 at r1 to 0 at r2, and its slope, 1/m (NULL: not asked for). */
double front_weight (double r, double r1, double r2, double *slope);
/* Sums of a cross section over places first .. last - 1. */
void   front_integrals (front_sums *out, const measuring *m, const cross_section *s, const front_places *q,
                        size_t first, size_t last);
/* What faces add to J of a tip (tip_faces_create). */
void   tip_face_integrals (front_sums *out, const measuring *m, const front_places *faces);
/* What a force adds at place k of a cross section; A: gradients of the exact fields there. */
void   front_force_integrals (front_sums *out, const measuring *m, const cross_section *s,
                              const front_places *q, size_t k, double A[FRONT_FIELDS][9]);
/* The part of J along the front within the core, from K_II K_III of two fields, and of I: times K_III, K_II;
 * m^2/N times m. */
double front_core_along (const tip_material *m, double h);

/* ---- front_springs.c ----------------------------------------------------------------------------------- */
/* Adds what springs on points do to the sums of the cross sections. */
pg_status springs_add    (const measuring *m);
/* Springs on points as a body force at places of one cross section, added to the load of a field: each node's
 * springs over its volume. For rings that do not reach all the way in. */
pg_status springs_spread (front_places *q, const measuring *m, int field);

/* ---- tips ---------------------------------------------------------------------------------------------- */
/* Frame, spacing, room and radii of a tip (out: x, e, h, room, r1, near, wide), and the node nearest to
 * it. */
pg_status tip_domain (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip,
                      size_t *node);
/* Distance from a place of the tip's path, next to `node`, to what a ring must not hold, m: at most
 * `limit`. */
double    tip_room_about (const pg_problem *p, const pg_state *state, size_t tip, const double *x,
                          size_t node, double limit);
size_t    tip_node_at (const pg_problem *p, const double *x);          /* the nearest one */
/* Does the same elastic material fill two nodes, of whatever name and toughness, and without an interface
 * of its own between them (failure.interfaces)? */
int       tip_same_material (const pg_problem *p, size_t i, size_t k);
/* The cross section of a tip at x with the unit vector e ahead. */
cross_section tip_section (const pg_problem *p, const double *x, const double *e, size_t node);
/* The rings of a tip (out: x, e, h, r1, near, wide). core: 1: places within r1 too, where terms without
 * derivatives of the weight are to be summed. */
pg_status tip_rings_create (front_places *out, const pg_problem *p, const pg_tip_field *tip, int core);
/* Places on the faces of the pieces within the wide ring that do not run along e; area: outward normal along
 * e times length, m. None: n = 0. */
pg_status tip_faces_create (front_places *out, const pg_problem *p, const pg_tip_field *tip,
                            const pg_cracks *cracks);
/* K, J and the K at the end of trial facets of a tip that has a turn behind it, by reciprocity; x, h and
 * room of `out` are known. facet: length of the trial facets, m; 0: none. *done 0: the crack is straight
 * where rings lie, or there is no room around its turns. */
pg_status kinked_tip_measure (pg_tip_field *out, const measuring *m, size_t tip, double facet,
                              const pg_tip_faces *touch, int *done);

/* ---- front_curve.c ------------------------------------------------------------------------------------- */
void   front_at  (const pg_front *f, double u, front_place *out);
/* How many vertices lie between u and vertex i; a loop the shorter way. */
double front_gap (const pg_front *f, double u, size_t i);
/* A vector, a tensor in the frame (rows e, n, t). */
void   front_turn_vector (const double *frame, const double *v, double *out);
void   front_turn_tensor (const double *frame, const double *T, double *out);

/* ---- front_tube.c -------------------------------------------------------------------------------------- */
/* The places of a cross section, without those in the scene. */
pg_status front_places_make (front_places *out, double h);
/* How far from the front, in the plane across it at `at`, there is nothing but one material and the faces of
 * the crack, at most `limit`, m; *load: number of the load that ends it there, else -1. offset: so far
 * behind the front nothing is cut, m. tail: whether the surface ends the front so near that it does not
 * count. */
double front_room (const pg_problem *p, const pg_state *state, const front_place *at, double h, double offset,
                   double limit, int tail, int *load);
/* Do materials of unlike stiffness meet within the distance (m) of x? */
int front_at_interface (const pg_problem *p, const double *x, double distance);
#endif
