/* SPDX-License-Identifier: GPL-3.0-or-later
 * fracture.h: crack tip parameters from a displacement field: energy release rate J, stress intensity factors
 * K_I, K_II (and K_III of 3D fronts), the stress T along the crack, and the direction of growth.
 *
 * All are integrals over a ring around the tip (Rice 1968; as integrals over an area Moran and Shih 1987,
 * interaction integrals Yau, Wang and Corten 1980; doc/method.md, "The tip of a crack"), so that the field
 * within a spacing of the tip, where no discretisation is accurate, does not enter. The frame of a tip: axis
 * 1 (e) ahead of the crack, axis 2 to its left; K_I > 0 opens the crack, K_II > 0 moves its left face
 * ahead. */
#ifndef PERIGAL_FRACTURE_H
#define PERIGAL_FRACTURE_H
#include "perigal/force.h"

PG_API_BEGIN

enum {
    PG_TIP_TRIALS = 5,                                 /* directions of trial facets behind a kink */
    PG_TIP_NUMBERS = 22                                /* numbers from J to T, at the start of pg_tip_field */
};

/* What limits the size of the integration ring around a tip: the surface, another crack, points with a load
 * or support other than springs and body forces, another material, a body force that acts on one side only,
 * closed faces. */
enum {
    PG_ROOM_FREE, PG_ROOM_SURFACE, PG_ROOM_CRACK, PG_ROOM_LOAD, PG_ROOM_MATERIAL, PG_ROOM_FORCE, PG_ROOM_FACES
};

/* The tip of a crack under the displacement sum_a l_a d_a of one or two fields (affine loads: the constant
 * part and the part that grows with the load factor). */
typedef struct {
    /* Energy release rate of the sum: sum_ab l_a l_b J[a][b], J/m^2. Stress intensity factors of modes I, II,
     * III (0 in 2D): sum_a l_a K[m][a], Pa m^(1/2). J is taken from the wide ring, K, which determines the
     * direction, from the near one (before the tip has grown from the wide one). */
    double J[2][2], K[3][2];
    /* K by the wide ring, J by the near one: the differences show how well they are known
     * (pg_tip_uncertainty). */
    double K_wide[3][2], J_near[2][2];
    double T[2];                                       /* T stress (along e), Pa */
    double x[3], e[3];  /* tip, m; unit vector ahead: the chord of the last 1.5 h */
    double h, r1, near, wide;                          /* local spacing; rings r1..near and r1..wide, m */
    /* 3D: unit normal of the crack and unit tangent of the front, e x normal (e, normal and tangent are
     * right-handed; K_III > 0 moves the face on the normal's side along the tangent); length of front that
     * belongs to the vertex, m. */
    double normal[3], tangent[3], length;
    double room;                                       /* distance to what limits the ring, m */
    double modulus;                                    /* E' = E, in plane strain E / (1 - nu^2), Pa */
    /* factor in E' J = K_I^2 + K_II^2 + antiplane K_III^2: 1 / (1 - nu); 0 in 2D */
    double antiplane;
    double kink[2];                                    /* position of the turn, m (if kinked) */
    /* Trial facets, which do not exist yet: their length (m; 0: none), angles from e (rad), and K_I, K_II at
     * the end of each, sum_a l_a trial_K[i][m][a], Pa m^(1/2). */
    double trial, trial_angle[PG_TIP_TRIALS], trial_K[PG_TIP_TRIALS][2][2];
    int    limit;                                      /* PG_ROOM_...: what limits the ring */
    int    load;                                       /* number of the load that limits it, else -1 */
    /* 1: values at the end of a front on the surface of the body are extrapolated from the next vertices, as
     * the surface has a singularity of its own */
    int    extrapolated;
    /* 1: no values (near = NAN), as materials of different stiffness meet at the vertex; 3D only */
    int    interface;
    /* 1: the faces are in contact behind the tip: K_I is 0, J that of K_II, T is not known */
    int    closed;
    /* 1: the crack has a kink within the rings. They are then centred at the kink, r1 .. wide and the outer
     * half near .. wide; K is by reciprocity with the weight functions of the polyline, J = (K_I^2 + K_II^2)
     * / E', T is not known, and e runs along the last piece. */
    int    kinked;
} pg_tip_field;

/* A piece of crack whose faces are in contact: middle, unit normal, length (m), and the contact stresses,
 * sigma_nn and sigma_nt in the frame of its normal, Pa, of each field. */
typedef struct { double x[2], normal[2], length, stress[2][2]; } pg_face_piece;
/* Contact stresses on the faces behind a tip, in equilibria with contact (perigal/contact.h). */
typedef struct {
    /* Mean contact stresses across and along the crack, sigma_nn and sigma_nt in the frame of the tip, Pa, of
     * each field. */
    double stress[2][2];
    int    closed;                                     /* 1: the faces are in contact behind the tip */
    double nearest;  /* distance from the tip to the next piece that is closed, m; INFINITY: none */
    const pg_face_piece *piece;  size_t npiece;        /* all pieces in contact; borrowed */
} pg_tip_faces;

/* Reason why K and J of this problem cannot be computed by integrals (static text); NULL: they can. */
const char *pg_tip_refuses (const pg_problem *p, const pg_force_type *force);

/* Fills in the geometry of tip number `tip` of the state, without fields: x, e, h, room, limit, load, r1,
 * near, wide. */
pg_status pg_tip_find (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip);
/* Describes in words what limits the rings around a tip: "the support top", "the surface", ... */
void      pg_tip_limit_words (const pg_problem *p, const pg_tip_field *f, char *out, size_t size);

/* Measures tip number `tip` of the state. d: nfield fields of coefficients (ndof each). t: load factor, or
 * time (s), of each, for body forces; the second field has those of t[1] less those of t[0], as it has with
 * affine loads for t = 0, 1. Where state->d itself is the one field and has a velocity, kinetic terms are
 * added. near = NAN: there is no room for a ring, nothing else but x, e, h and room is known. faces: contact
 * of the crack faces (NULL: none). The uniform field with the same stress across them is subtracted: the rest
 * has free faces behind the tip, and the K_II of the tip; rings of an open tip end before the next closed
 * piece, as their integrals contain no tractions; those of a kink contain the tractions on the straight crack
 * behind it. facet: length of trial facets at whose end K is computed, m (0: it is not). */
pg_status pg_tip_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                          const pg_state *state, size_t tip, int nfield, const double *const *d,
                          const double *t, const pg_tip_faces *faces, double facet);

/* Contact stresses on the faces behind a vertex of a front, in equilibria with contact. */
typedef struct {
    /* Means behind the vertex of the pressure on the face on the side of the front's normal, and of the shear
     * stress on it as a vector, Pa, of each field. */
    double pressure[2], shear[2][3];
    int    closed;                                     /* 1: the faces are in contact behind the vertex */
    double nearest;  /* distance from the vertex to the next piece that is closed, m; INFINITY: none */
} pg_front_faces;
/* Measures a 3D front, number `front` of those of the state (pg_fronts_of_state): out has a field for each of
 * its vertices, smoothed once along the front. d, t as in pg_tip_measure. near = NAN at a vertex without room
 * for a tube; near < 3 h: the tube there is thinner than it should be (see room). faces: contact stresses at
 * each vertex (NULL: no contact). As for tips the uniform stress of contact is subtracted; a closed vertex
 * has K_I = 0 and J of K_II and K_III, T is not known; tubes around an open one end before the next closed
 * piece. */
pg_status pg_front_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                            const pg_state *state, size_t front, int nfield, const double *const *d,
                            const double *t, const pg_front_faces *faces);

/* Combines the fields with factors l (nfield numbers): J (J/m^2), K (3, Pa m^(1/2)) and T (Pa); outputs may
 * be NULL. */
void pg_tip_combine (const pg_tip_field *f, int nfield, const double *l, double *J, double *K, double *T);
/* Stress intensity factors for output (K: 3, Pa m^(1/2)): K scaled so that E' J = K_I^2 + K_II^2 + antiplane
 * K_III^2 holds; in 3D scaled only in proportion to mode I (of either sign), so that mode II and III keep
 * their magnitude; not scaled where J is not positive. */
void pg_tip_intensities (const pg_tip_field *f, int nfield, const double *l, double *K);
/* J of stress intensity factors K of the fields: (K_I K_I + K_II K_II + antiplane K_III K_III) / E'. */
void pg_tip_energy (const pg_tip_field *f, int nfield, double K[3][2], double J[2][2]);
/* Relative uncertainty of J: difference between the two rings; NAN: there is only one. */
double pg_tip_uncertainty (const pg_tip_field *f, int nfield, const double *l);

/* Predicts the next facet, of length l (m): angle from e (rad, positive to the left) of the largest hoop
 * stress (Erdogan and Sih 1963), its intensity factor there, and what advancing there releases: G_theta = J
 * K_theta^2 / (K_I^2 + K_II^2). T: stress along the crack. Compression beyond 0.2 K_I / sqrt (l), as in wing
 * cracks of closed cracks, changes the direction; NAN: T is not known. Returns 0: no direction is in
 * tension. */
int pg_kink (double J, double K_I, double K_II, double T, double l, double *angle, double *K_theta,
             double *G_theta);

/* Finds the direction of the next facet behind a kink (angle from e, rad) for which the mean of K_II at its
 * two ends vanishes. start: a first guess. Returns 0: there are no trial facets (pg_tip_field.trial), or the
 * angle is outside their range. */
int pg_kink_ahead (const pg_tip_field *f, int nfield, const double *l, double start, double *angle);

/* The field around a tip, in its frame: displacement u (2, m) and its gradient H[2 c + k] = du_c/dx_k, stress
 * (11, 22, 12, Pa), at radius r (m) and angle theta (-pi .. pi) from e. mode 0, 1: the singular field of K_I,
 * K_II = 1 Pa m^(1/2) (Williams 1957); 2: of a force of 1 N per thickness (m) on the tip along e, whose
 * interaction integral gives T. mu: shear modulus, Pa; kappa: 3 - 4 nu in plane strain, (3 - nu) / (1 + nu)
 * in plane stress. Outputs may be NULL. */
enum { PG_TIP_OPENING, PG_TIP_SLIDING, PG_TIP_FORCE, PG_TIP_FIELDS };
void pg_tip_near_field (int mode, double mu, double kappa, double r, double theta, double *u, double *H,
                        double *stress);
/* kappa of a mode (PG_PLANE_STRESS, PG_PLANE_STRAIN), and E' = 8 mu / (kappa + 1), Pa. */
double pg_tip_kappa (pg_mode mode, double nu);
PG_API_END
#endif
