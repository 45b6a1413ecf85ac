/* SPDX-License-Identifier: GPL-3.0-or-later
 * tip.h: the parts of the measurement of a tip. Files: tip_domain.c (frame, rings and the room for them),
 * tip_grid.c (places of the integrals, and the fields there), tip_integrals.c (the integrals), tip_faces.c
 * (faces that turn inside the rings), tip_measure.c (all of it for one tip), williams.c (exact fields),
 * kinked_tip.c (tips with a turn behind them), tip_springs.c (springs on points within the rings), kink.c
 * (direction). */
#ifndef PG_FRACTURE_TIP_H
#define PG_FRACTURE_TIP_H
#include "mean_motion.h"
#include "perigal/fracture.h"

#define TIP_LEAST 1.5                                  /* spacings: a ring that ends nearer knows nothing */
/* Is a ring of this radius (m) one? A surface 1.5 spacings away, but for rounding, leaves room for it. */
static inline int tip_is_ring (const pg_problem *p, double radius, double h)
{
    return radius + pg_cloud_same (&p->cloud) >= TIP_LEAST * h;
}

enum { TIP_FIELDS = 2 };                               /* most displacement fields at a time */

/* The material at a tip. */
typedef struct {
    double mu, kappa, modulus;                         /* shear modulus, E', Pa; pg_tip_kappa */
    double density;                                    /* kg/m^3 */
    const pg_material *law;
    /* Pa: the dilatation that carries the pressure is a mean over patches (pg_patches), and lambda its
     * modulus; 0: the stress is that of the strain */
    double lambda;
} tip_material;

/* One displacement field at the places of a grid, in the frame of the tip. */
typedef struct {
    double *u;                                         /* displacement, m (n x 2) */
    /* H[2 c + k] = du_c/dx_k (n x 4), less the mean rotation around the tip */
    double *H;
    double *stress;                                    /* 11, 22, 12, Pa (n x 3) */
    double *excess;                                    /* stress above that of the strain, Pa (n); NULL: 0 */
    double *load;                                      /* b - rho a, N/m^3 (n x 2); NULL: none */
    /* in motion, else NULL: rho v_i v_i,1, N/m^3, and kinetic energy, J/m^3 (n) */
    double *kinetic, *moving;
} tip_sample;

/* Places around a tip in polar coordinates about e, ring after ring: r in (0, wide). */
typedef struct {
    size_t n, nfield;
    double *r, *theta, *area;                          /* m, rad, r dr dtheta (m^2) (n each) */
    double *x;                                         /* these places in scene coordinates, m (n x 2) */
    tip_sample field[TIP_FIELDS];
} tip_grid;

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

/* core: 1: places within r1 too, where terms without derivatives of the weight are to be summed. */
pg_status tip_grid_create (tip_grid *out, const pg_problem *p, const pg_tip_field *tip, int core);
void      tip_grid_clear  (tip_grid *grid);
/* Places on the faces of the pieces within the wide ring that do not run along e; area: outward normal along
 * e times length, m. None: n = 0. */
pg_status tip_faces_create (tip_grid *out, const pg_problem *p, const pg_tip_field *tip,
                            const pg_cracks *cracks);
/* One field from the force into grid->field[at]. */
pg_status tip_grid_sample (tip_grid *grid, int at, const pg_tip_field *tip, const tip_material *material,
                           const pg_problem *p, const pg_force_type *force, void *self,
                           const pg_state *state, const mean_motion *d);
/* Adds the body force b of field `at`, that of factor t[at], less that of t[0] for the second, to its load.
 * node: at the tip. */
pg_status tip_add_body_force (tip_grid *grid, int at, const pg_tip_field *tip, const pg_problem *p,
                              size_t node, const double *t);
int       tip_has_body_force (const pg_problem *p, size_t node);
/* Pressure in the cracks in field `at`: of t[at], less that of t[0] for the second, Pa. */
double    tip_pressure (const pg_problem *p, int at, const double *t);
/* The points within the wide ring on which springs act, as places of a grid: area: one over the thickness,
 * 1/m; size: radius of a disc as large as what belongs to the point, m. None: n = 0. */
typedef struct { tip_grid grid; double *size; } tip_springs;
pg_status tip_springs_create (tip_springs *out, const pg_tip_field *tip, const pg_problem *p);
/* Fields at those points, and what the springs do to the body there, N, as grid.field[at].load; t as in
 * pg_tip_measure. */
pg_status tip_springs_sample (tip_springs *s, int at, const pg_tip_field *tip, const tip_material *material,
                              const pg_problem *p, const pg_force_type *force, void *self,
                              const pg_state *state, const mean_motion *d, const double *t);
void      tip_springs_clear  (tip_springs *s);
/* Springs on points, as a body force at the places of a grid, added to its load: each node's springs over its
 * volume. For rings that do not reach all the way in. */
pg_status tip_springs_spread (tip_grid *grid, int at, const pg_tip_field *tip, const pg_problem *p,
                              const double *t);
/* The mean of the gradient of an exact field over a disc of radius `size` around the place r, theta: 4 terms
 * in the frame of the tip, finite at the tip as well. */
void      tip_mean_gradient  (int mode, const tip_material *m, double r, double theta, double size,
                              double *A);
/* A vector in the frame of the tip. */
void      tip_turn (const double *e, const double *v, double *out);

/* Weight of the rings, 1 within r1 and 0 beyond r2, and its slope, 1/m. */
double    tip_weight (double r, double r1, double r2, double *slope);

/* K, J and the K at the end of trial facets of a tip that has a turn behind it, by reciprocity; x, h and
 * room of `out` are known. facet: length of the trial facets, m; 0: none. *done 0: the crack is straight
 * where rings lie, or there is no room around its turns. */
pg_status kinked_tip_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                              const pg_state *state, size_t tip, int nfield, const mean_motion *d,
                              const double *t, double facet, const tip_material *material,
                              const pg_tip_faces *touch, int *done);

/* J of two fields, J/m^2, and for each the interaction integrals with the exact fields of
 * pg_tip_near_field, of which K_I, K_II and T follow. */
typedef struct { double J[2][2], I[PG_TIP_FIELDS][2]; } tip_sums;
/* Over the ring r1 .. r2. */
void tip_integrals (tip_sums *out, const tip_grid *grid, const tip_material *material, double r1, double r2);
/* What the springs add to both. */
void tip_spring_integrals (tip_sums *out, const tip_springs *s, const tip_material *material, double r1,
                           double r2);
/* What the faces of tip_faces_create add to J. */
void tip_face_integrals (tip_sums *out, const tip_grid *faces, const tip_material *material, double r1,
                         double r2);
#endif
