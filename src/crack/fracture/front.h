/* SPDX-License-Identifier: GPL-3.0-or-later
 * front.h: parts of the computation of J, K and T at a 3D front, or at a 2D tip, which is treated as a front
 * of one vertex with one cross section. Files: front_fields.c (materials, loads and fields at integration
 * points), front_integrals.c (integrals over a cross section), front_springs.c (springs within it),
 * williams.c (exact fields); for tips tip_domain.c (size of the integration rings), tip_places.c (integration
 * points), tip_measure.c (the whole computation), kinked_tip.c (tips behind a kink); for fronts front_curve.c
 * (the curve through the vertices and its frame), front_tube.c (radius of the tube around the front,
 * integration points), front_measure.c (the whole computation); kink_direction.c (direction of growth). */
#ifndef PG_FRACTURE_FRONT_H
#define PG_FRACTURE_FRONT_H
#include "mean_motion.h"
#include "perigal/fracture.h"

#define TIP_LEAST 1.5                                  /* spacings: least outer radius of a ring */
/* Returns 1: a ring of this outer radius (m) is large enough: TIP_LEAST spacings h, up to rounding. */
static inline int tip_is_ring (const pg_problem *p, double radius, double h)
{
    return radius + pg_cloud_same (&p->cloud) >= TIP_LEAST * h;
}

enum { TIP_FIELDS = 2 };                               /* maximum number of displacement fields at a time */
/* Values at a vertex are averages over FRONT_HAT vertices to both sides. There are FRONT_SECTIONS cross
 * sections per vertex. Tubes end at one of FRONT_RADII radii (front_radius); the weight q falls from one
 * spacing on. */
enum { FRONT_HAT = 3, FRONT_SECTIONS = 2, FRONT_RADII = 4 };
static const double front_radius[FRONT_RADII] = { 1.5, 2.25, 3, 4 };       /* in spacings */
static const double front_core = 0.5;  /* terms with hat' are omitted below this radius, spacings */

/* The material at a tip or front. */
typedef struct {
    int    dim;                                        /* 2: tip; 3: front, plane strain across it */
    double mu, kappa, modulus;                         /* shear modulus, E', Pa; pg_tip_kappa */
    double density;                                    /* kg/m^3 */
    const pg_material *law;
    /* Lame constant, Pa, if the dilatation is projected onto patches (pg_patches); else 0: stress from the
     * local strain */
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
/* A point of a front: position x (m); rows of `frame`: e (ahead), n (normal of the crack), t = e x n; speed:
 * |dx/du| of the curve through the vertices, m; turn: rotation of the frame along the front, db/ds = turn x
 * b, in the frame, 1/m. */
typedef struct { double x[3], frame[9], speed, turn[3]; } front_place;

/* Integrals over one cross section for each radius: factors of the hat function, and (..._along) of its
 * derivative along the front (1/m). J of two fields, interaction integral I with each exact field; strain:
 * mean strain along the front; by_K: its part due to K = 1 of modes I and II. */
typedef struct {
    double J[FRONT_RADII][2][2], J_along[FRONT_RADII][2][2];
    double I[FRONT_RADII][FRONT_FIELDS][2], I_along[FRONT_RADII][FRONT_FIELDS][2];
    double strain[2], by_K[2];
} front_sums;

/* A cross section: plane normal to the front. */
typedef struct {
    front_place at;
    double u, length;  /* parameter along the front (i at vertex i); length of front that it represents, m */
    size_t node;                                       /* node that gives its material and body force */
    tip_material material;
    /* largest possible radius, m, and number of radii of front_radius within; load that limits it, or -1 */
    double room;
    int    radii, load;
    /* closed: 1: the faces behind it are in contact; stress: uniform contact stress sigma_22, sigma_12,
     * sigma_23, Pa, of each field, which is subtracted */
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
    double pressure[TIP_FIELDS];                       /* pressure in the cracks, of each field, Pa */
    int    moving;                                     /* 1: the single field has velocity or acceleration */
    double h, r1, radius[FRONT_RADII];  /* spacing, m; weights fall from r1 to one of the radii, m */
    size_t n;  cross_section *section;
} measuring;

pg_status measuring_check (const measuring *m);        /* PG_E_USAGE: not computable */
/* Computes pressures, the fields without their mean rigid motion within `reach` (m) of n points x (m), and
 * `moving`. measuring_end frees them. */
pg_status measuring_begin (measuring *m, size_t n, const double *x, double reach);
void      measuring_end   (measuring *m);
tip_material material_at  (const pg_problem *p, size_t node);
/* Returns 1: body forces act on the node. */
int       has_body_force  (const pg_problem *p, size_t node);
/* Sets all results of a vertex or tip to NAN. */
void      measured_nothing (pg_tip_field *out);
/* Sets K_I = 0 and J from K_II and K_III, for a closed vertex or tip. */
void      measured_closed  (pg_tip_field *out, int nfield);

/* One displacement field at n integration points, in the frame of their cross section (except u). */
typedef struct {
    double *u;                                         /* displacement in scene coordinates, m (n x 3) */
    double *H;                                         /* H[3 m + k] = du_m/dx_k (n x 9) */
    double *S;                                         /* stress, Pa (n x 9) */
    /* mean normal stress less that of the strain, Pa (n); NULL: 0 */
    double *excess;
    double *load;  /* body force less inertia, b - rho a, N/m^3 (n x 3), or NULL */
    double *kinetic, *moving;  /* rho v_i v_i,1, N/m^3; kinetic energy, J/m^3 (n); NULL: static */
} front_sample;

/* Integration points in cross sections, in polar coordinates (theta from e), ring after ring. */
typedef struct {
    size_t n, capacity;
    double *r, *theta, *area;                          /* m, rad, r dr dtheta (m^2) (n each) */
    double *x;                                         /* positions in scene coordinates, m (n x dim) */
    size_t *of;                                        /* cross section of each point (n) */
    front_sample field[TIP_FIELDS];
    double *stress, *gradient;                         /* workspace (n x 6, n x 9) */
} front_places;
pg_status places_create (front_places *out, size_t capacity);
void      places_clear  (front_places *q);
/* Evaluates all fields at the points, with body forces (forced) and inertia (moving), less the stresses of
 * closed faces and the pressure in cracks. */
pg_status places_fields (front_places *q, const measuring *m, int forced, int moving);
/* places_sample evaluates one field without corrections; places_force adds the body force to its load. */
pg_status places_sample (front_places *q, const measuring *m, int field);
pg_status places_force  (front_places *q, const measuring *m, int field);
/* Subtracts the uniform stresses of closed faces and of the pressure in cracks from a field at point k. */
void      places_part   (front_places *q, const measuring *m, int field, size_t k);

/* ---- front_integrals.c --------------------------------------------------------------------------------- */
/* The weight q at r (m), which falls from 1 at r1 to 0 at r2, and its slope, 1/m (NULL: not wanted). */
double front_weight (double r, double r1, double r2, double *slope);
/* Computes the integrals of a cross section over points first .. last - 1. */
void   front_integrals (front_sums *out, const measuring *m, const cross_section *s, const front_places *q,
                        size_t first, size_t last);
/* Adds the contribution of crack faces not parallel to e to J of a tip (tip_faces_create). */
void   tip_face_integrals (front_sums *out, const measuring *m, const front_places *faces);
/* Adds the contribution of a point force at point k of a cross section; A: gradients of the exact fields
 * there. */
void   front_force_integrals (front_sums *out, const measuring *m, const cross_section *s,
                              const front_places *q, size_t k, double A[FRONT_FIELDS][9]);
/* Factor (m^3/N) of K_II K_III in the part of J along the front within the core (and of K_III, K_II in I). */
double front_core_along (const tip_material *m, double h);

/* ---- front_springs.c ----------------------------------------------------------------------------------- */
/* Adds the contribution of springs at points to the integrals of the cross sections. */
pg_status springs_add    (const measuring *m);
/* Adds springs at points, as a body force (spring force of a node over its volume), to the load of a field at
 * the points of one cross section. For rings that exclude the tip. */
pg_status springs_spread (front_places *q, const measuring *m, int field);

/* ---- tips ---------------------------------------------------------------------------------------------- */
/* Finds frame, spacing, room and radii of a tip (out: x, e, h, room, r1, near, wide), and the node nearest to
 * it. */
pg_status tip_domain (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip,
                      size_t *node);
/* Distance from x (m) on the tip's path, near `node`, to what limits an integration ring, m, at most
 * `limit`. */
double    tip_room_about (const pg_problem *p, const pg_state *state, size_t tip, const double *x,
                          size_t node, double limit);
size_t    tip_node_at (const pg_problem *p, const double *x);          /* node nearest to x */
/* Returns 1: two nodes have the same elastic constants (names and toughness may differ), without an interface
 * between their materials (failure.interfaces). */
int       tip_same_material (const pg_problem *p, size_t i, size_t k);
/* Makes the cross section of a tip at x (m) with the unit vector e ahead. */
cross_section tip_section (const pg_problem *p, const double *x, const double *e, size_t node);
/* Makes the integration points in the rings of a tip (uses its x, e, h, r1, near, wide). core: 1: also within
 * r1, for terms without derivatives of the weight. */
pg_status tip_rings_create (front_places *out, const pg_problem *p, const pg_tip_field *tip, int core);
/* Makes the integration points on crack faces within the wide ring that are not parallel to e; area: outward
 * normal . e times length, m. n = 0: there are none. */
pg_status tip_faces_create (front_places *out, const pg_problem *p, const pg_tip_field *tip,
                            const pg_cracks *cracks);
/* Computes K, J, and K at the end of trial facets, of a tip behind a kink, by reciprocity; x, h and room of
 * `out` must be set. facet: length of the trial facets, m; 0: none. *done 0: the crack is straight within the
 * rings, or there is no room for a ring around a kink. */
pg_status kinked_tip_measure (pg_tip_field *out, const measuring *m, size_t tip, double facet,
                              const pg_tip_faces *touch, int *done);

/* ---- front_curve.c ------------------------------------------------------------------------------------- */
void   front_at  (const pg_front *f, double u, front_place *out);
/* Distance |u - i| along the front in vertices; in a loop along the shorter part. */
double front_gap (const pg_front *f, double u, size_t i);
/* Components of a vector, of a tensor in the frame (rows e, n, t). */
void   front_turn_vector (const double *frame, const double *v, double *out);
void   front_turn_tensor (const double *frame, const double *T, double *out);

/* ---- front_tube.c -------------------------------------------------------------------------------------- */
/* Makes the integration points of a cross section (r, theta, area; not x). */
pg_status front_places_make (front_places *out, double h);
/* Largest radius, m, at most `limit`, in the plane across the front at `at`, within which there are only one
 * material and the faces of the crack; *load: number of the load that limits it, else -1. offset: distance
 * behind the front without cut bonds, m. tail: 1: the end of the front on the surface is so near that the
 * surface is ignored. */
double front_room (const pg_problem *p, const pg_state *state, const front_place *at, double h, double offset,
                   double limit, int tail, int *load);
/* Returns 1: materials of different stiffness meet within the distance (m) of x. */
int front_at_interface (const pg_problem *p, const double *x, double distance);
#endif
