/* SPDX-License-Identifier: GPL-3.0-or-later
 * front.h: the parts of the measurement of a front in space. Files: front_curve.c (the curve through the
 * vertices and its frame), front_fields.c (exact fields of a straight front), front_tube.c (how thick a tube
 * around the front may be, and the places in it), front_integrals.c (integrals over one cross section),
 * front_faces.c (faces that touch), front_springs.c (springs in the tube), front_measure.c (all of it, and
 * the sums for the vertices). */
#ifndef PG_FRACTURE_FRONT_H
#define PG_FRACTURE_FRONT_H
#include "tip.h"

/* A vertex counts in the stretch of front within HAT vertices of it. Cross sections lie twice between two
 * vertices. Tubes end at one of RADII radii (front_radius); weights begin to fall at one spacing. */
enum { FRONT_HAT = 3, FRONT_SECTIONS = 2, FRONT_RADII = 4, FRONT_RINGS = 16, FRONT_ANGLES = 32,
       FRONT_PLACES = FRONT_RINGS * FRONT_ANGLES };
static const double front_radius[FRONT_RADII] = { 1.5, 2.25, 3, 4 };       /* in spacings */
static const double front_core = 0.5;                  /* terms along the front end so near to it, spacings */

/* ---- front_curve.c ------------------------------------------------------------------------------------- */
/* The front at u, which is i at vertex i: place (m), frame e (ahead), n (normal of the crack), t = e x n,
 * rows of `frame`; speed: |dx/du|, m. turn: how the frame turns along the front, db/ds = turn x b, in the
 * frame, 1/m. */
typedef struct { double x[3], frame[9], speed, turn[3]; } front_place;
void   front_at  (const pg_front *f, double u, front_place *out);
/* How many vertices lie between u and vertex i; a loop the shorter way. */
double front_gap (const pg_front *f, double u, size_t i);

/* ---- front_fields.c ------------------------------------------------------------------------------------ */
/* Exact fields of a straight front in plane strain, of K_I, K_II, K_III = 1 Pa m^(1/2), and of a force of 1
 * N/m on the front along e, in the frame of the front. A[3 m + k] = du_m/dx_k; S: stress, 3 x 3; u: 3.
 * Outputs may be NULL. */
enum { FRONT_I, FRONT_II, FRONT_III, FRONT_FORCE, FRONT_FIELDS };
void front_near_field (int field, const tip_material *m, double r, double theta, double *u, double *A,
                       double *S);

/* ---- front_tube.c -------------------------------------------------------------------------------------- */
/* The places of a cross section: r in m, theta, area r dr dtheta (m^2), ring after ring. */
typedef struct { double r[FRONT_PLACES], theta[FRONT_PLACES], area[FRONT_PLACES]; } front_section;
void front_section_make (front_section *out, double h);
/* How far from the front, in the plane across it at `at`, there is nothing but one material and the faces of
 * the crack, at most `limit`, m; *load: number of the load that ends it there, else -1. offset: so far
 * behind the front nothing is cut, m. tail: whether the surface
 * ends the front so near that it does not count. */
double front_room (const pg_problem *p, const pg_state *state, const front_place *at, double h, double offset,
                   double limit, int tail, int *load);

/* Do materials of unlike stiffness meet within the distance (m) of x? */
int front_at_interface (const pg_problem *p, const double *x, double distance);

/* ---- front_integrals.c --------------------------------------------------------------------------------- */
/* Fields at the places of one cross section, in the frame of the front there. H, S as above; excess: trace of
 * the stress above that of the strain, a third, Pa (NULL: 0); load: b - rho a, N/m^3 (x 3, NULL); kinetic:
 * rho v_i v_i,1, N/m^3, moving: kinetic energy, J/m^3 (NULL). */
typedef struct { double *H, *S, *excess, *load, *kinetic, *moving; } front_sample;
/* Integrals over one cross section for each radius: what stands with the hat, and what stands with its
 * derivative along the front (1/m). J of two fields, I with the exact ones; strain: mean of the strain along
 * the front, by_K: what K = 1 of modes I and II makes of it. */
typedef struct {
    double J[FRONT_RADII][2][2], J_along[FRONT_RADII][2][2];
    double I[FRONT_RADII][FRONT_FIELDS][2], I_along[FRONT_RADII][FRONT_FIELDS][2];
    double strain[2], by_K[2];
} front_sums;
/* in: of each place, whether it counts; radii: how many of the radii there is room for. */
void front_integrals (front_sums *out, const front_section *section, const front_place *at,
                      const tip_material *m, double h, int radii, const unsigned char *in, int nfield,
                      const front_sample *field);
/* The part of J along the front within the core, from K_II K_III of two fields, and of I: times K_III, K_II;
 * m^2/N times m. */
double front_core_along (const tip_material *m, double h);

/* The weight at r, which falls from 1 at r1 to 0 at r2, and its slope, 1/m (NULL: not asked for). */
double front_weight (double r, double r1, double r2, double *slope);

/* ---- front_springs.c ----------------------------------------------------------------------------------- */
/* What the springs need of a measurement: the cross sections and their sums, to which they are added;
 * material at a place; part: takes the uniform strain of faces that bear something from the gradient of a
 * field, in the frame of a section. */
typedef struct {
    const pg_problem *p;
    const pg_force_type *force;
    void *self;
    const pg_state *state;
    int nfield;
    const mean_motion *d;
    const double *t;
    double h;
    size_t n;
    const front_place *place;
    const int *radii;
    front_sums *sums;
    const void *context;
    tip_material (*material) (const void *context, const double *x);
    void (*part) (const void *context, int field, size_t section, const tip_material *m, double *H);
} front_springs;
pg_status front_springs_add (const front_springs *s);

/* ---- front_measure.c ----------------------------------------------------------------------------------- */
/* A vector, a tensor in the frame (rows e, n, t). */
void front_turn_vector (const double *frame, const double *v, double *out);
void front_turn_tensor (const double *frame, const double *T, double *out);

/* ---- front_faces.c ------------------------------------------------------------------------------------- */
/* The uniform stress that faces carry at u in a field, linear between the vertices beside it, in that frame:
 * across the crack (2 2), along e (1 2) and along the front (2 3), Pa. 0: one of the vertices is open, or
 * faces is NULL. */
int    front_faces_at    (const pg_front *f, const pg_front_faces *faces, int field, double u,
                          const double *frame, double stress[3]);
/* That stress and its strain, without rotation, are taken from place k of a field. */
void   front_faces_part  (front_sample *field, size_t k, const tip_material *m, const double stress[3]);
/* How far a tube around open vertices at u may reach, m. */
double front_faces_clear (const pg_front *f, const pg_front_faces *faces, double u);
/* Closed vertices do not open, and what they set free is what sliding and tearing do. */
void   front_faces_close (const pg_front *f, const pg_front_faces *faces, int nfield, pg_tip_field *vertex);
#endif
