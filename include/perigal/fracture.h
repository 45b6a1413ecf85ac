/* SPDX-License-Identifier: GPL-3.0-or-later
 * fracture.h: what a displacement field says of the tip of a crack in the plane: energy release rate J,
 * stress intensity factors K_I and K_II, the stress T along the crack, and where the crack goes next.
 *
 * All are integrals over a ring around the tip (Rice 1968; as integrals over an area Moran and Shih 1987,
 * interaction integrals Yau, Wang and Corten 1980; doc/method.md, "The tip of a crack"), so that what happens
 * within a spacing of the tip, where no discretisation is right, does not enter. The frame of a tip: axis 1
 * (e) ahead of the crack, axis 2 to its left; K_I > 0 opens the crack, K_II > 0 moves its left face ahead. */
#ifndef PERIGAL_FRACTURE_H
#define PERIGAL_FRACTURE_H
#include "perigal/force.h"

PG_API_BEGIN

enum {
    PG_TIP_TRIALS = 5,                                 /* directions of trial facets behind a kink */
    PG_TIP_NUMBERS = 22                                /* J to T, with which a pg_tip_field begins */
};

/* What a ring around a tip must not hold: the surface, another crack, points with a load or support other
 * than springs and body forces, another material, a body force that acts on one side only, closed faces. */
enum {
    PG_ROOM_FREE, PG_ROOM_SURFACE, PG_ROOM_CRACK, PG_ROOM_LOAD, PG_ROOM_MATERIAL, PG_ROOM_FORCE, PG_ROOM_FACES
};

/* The tip of a crack under the displacement sum_a l_a d_a of one or two fields (affine loads: the constant
 * part and the part that grows with the load factor). */
typedef struct {
    /* Energy release rate of the sum: sum_ab l_a l_b J[a][b], J/m^2. Stress intensity factors of modes I, II,
     * III (0 in the plane): sum_a l_a K[m][a], Pa m^(1/2). J is taken from the wide ring, for it is the
     * magnitude that counts there; K, which tells the direction, from the near one, before the tip has grown
     * from the wide one. */
    double J[2][2], K[3][2];
    /* K by the wide ring, J by the near one: the differences show how well they are known
     * (pg_tip_uncertainty). */
    double K_wide[3][2], J_near[2][2];
    double T[2];                                       /* stress along e beside the singular part, Pa */
    double x[3], e[3];  /* tip, m; unit vector ahead: the chord of the last 1.5 h */
    double h, r1, near, wide;                          /* local spacing; rings r1..near and r1..wide, m */
    /* In space: unit normal of the crack and unit tangent of the front, e x normal (e, normal and tangent are
     * right-handed; K_III > 0 moves the face on the normal's side along the tangent); length of front that
     * belongs to the vertex, m. */
    double normal[3], tangent[3], length;
    double room;                                       /* distance to what a ring must not hold, m */
    double modulus;                                    /* E' = E, in plane strain E / (1 - nu^2), Pa */
    /* E' J = K_I^2 + K_II^2 + antiplane K_III^2: 1 / (1 - nu); 0 in the plane */
    double antiplane;
    double kink[2];                                    /* m; kinked, below */
    /* Of facets of that length (m; 0: none) that do not exist yet, at those angles from e: K_I and K_II at
     * their end, sum_a l_a trial_K[i][m][a]. */
    double trial, trial_angle[PG_TIP_TRIALS], trial_K[PG_TIP_TRIALS][2][2];
    int    limit;                                      /* PG_ROOM_...: what ends the room */
    int    load;                                       /* number of the load that it is, else -1 */
    /* 1: at the end of a front on the surface of the body, from the next vertices: the surface has a
     * singularity of its own */
    int    extrapolated;
    /* 1: nothing is known (near = NAN) because materials of unlike stiffness meet there; in space only */
    int    interface;
    /* 1: its faces press on each other behind it: K_I is 0, J that of K_II, T is not known */
    int    closed;
    /* 1: the crack has turned within the rings. They are then around the turn, r1 .. wide and the outer half
     * near .. wide; K is by reciprocity with the weight functions of the polyline, J = (K_I^2 + K_II^2) / E',
     * T is not known, and e runs along the last piece. */
    int    kinked;
} pg_tip_field;

/* A piece of crack whose faces press on each other: middle, unit normal, length (m), and the stresses that it
 * carries, sigma_nn and sigma_nt in the frame of its normal, Pa, of each field. */
typedef struct { double x[2], normal[2], length, stress[2][2]; } pg_face_piece;
/* What the faces behind a tip do to each other, in equilibria with contact (perigal/contact.h). */
typedef struct {
    /* Mean stresses that they carry across and along the crack, sigma_nn and sigma_nt in the frame of the
     * tip, Pa, of each field. */
    double stress[2][2];
    int    closed;                                     /* 1: they press on each other behind the tip */
    double nearest;  /* distance from the tip to the next piece that is closed, m; INFINITY: none */
    const pg_face_piece *piece;  size_t npiece;        /* all that press; borrowed */
} pg_tip_faces;

/* Why tips of this problem have no K and J by integrals: a sentence, static text; NULL: they have. */
const char *pg_tip_refuses (const pg_problem *p, const pg_force_type *force);

/* Where tip number `tip` of the state is and what room it has, without fields: x, e, h, room, limit, load,
 * r1, near, wide. */
pg_status pg_tip_find (pg_tip_field *out, const pg_problem *p, const pg_state *state, size_t tip);
/* What ends the room of a tip in words: "the support top", "the surface", ... */
void      pg_tip_limit_words (const pg_problem *p, const pg_tip_field *f, char *out, size_t size);

/* Measures tip number `tip` of the state. d: nfield fields of coefficients (ndof each). t: load factor, or
 * time (s), of each, for body forces; the second field has those of t[1] less those of t[0], as it has with
 * affine loads for t = 0, 1. Where state->d itself is the one field and is in motion, kinetic terms are
 * added. near = NAN: there is no room for a ring, nothing else but x, e, h and room is known.
 * faces: how they may touch (NULL: they do not). The uniform field that carries the same stress across them
 * is subtracted: what is left has free faces behind the tip, and its K_II is that of the tip; rings of an
 * open tip end before the next closed piece, whose tractions are in no integral of theirs; the ring around a
 * kink has the tractions of the pieces on the straight crack behind it. facet: length of trial facets at
 * whose end K is asked for, m (0: it is not). */
pg_status pg_tip_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                          const pg_state *state, size_t tip, int nfield, const double *const *d,
                          const double *t, const pg_tip_faces *faces, double facet);

/* What the faces behind a vertex of a front do to each other, in equilibria with contact. */
typedef struct {
    /* Means behind the vertex of the pressure on the face that the normal of the front shows to, and of the
     * shear stress on it as a vector, Pa, of each field. */
    double pressure[2], shear[2][3];
    int    closed;                                     /* 1: they press on each other behind the vertex */
    double nearest;  /* distance from the vertex to the next piece that is closed, m; INFINITY: none */
} pg_front_faces;
/* Measures a front in space, number `front` of those of the state (pg_fronts_of_state): out has a field for
 * each of its vertices, smoothed once along the front. d, t as above. near = NAN at a vertex without room for
 * a tube; near < 3 h: the tube there is thinner than it should be (room says by how much). faces: of each
 * vertex what they do (NULL: they do not touch). As with tips the uniform stress that they carry is
 * subtracted; a closed vertex has K_I = 0 and J of K_II and K_III, T is not known; tubes around an open one
 * end before the next closed piece. */
pg_status pg_front_measure (pg_tip_field *out, const pg_problem *p, const pg_force_type *force, void *self,
                            const pg_state *state, size_t front, int nfield, const double *const *d,
                            const double *t, const pg_front_faces *faces);

/* The sums for the factors l (nfield numbers): J (J/m^2), K (3, Pa m^(1/2)) and T (Pa); outputs may be
 * NULL. */
void pg_tip_combine (const pg_tip_field *f, int nfield, const double *l, double *J, double *K, double *T);
/* What to show of them: K_I, K_II, K_III in the ratio that K has, with the magnitude of J (E' J = K_I^2 +
 * K_II^2 + antiplane K_III^2), in space as far as the front opens: what slides or tears keeps the magnitude
 * that K has; whether K_I opens the crack or closes it does not matter. As they are where J is not
 * positive. */
void pg_tip_intensities (const pg_tip_field *f, int nfield, const double *l, double *K);
/* J of stress intensity factors K of the fields: (K_I K_I + K_II K_II + antiplane K_III K_III) / E'. */
void pg_tip_energy (const pg_tip_field *f, int nfield, double K[3][2], double J[2][2]);
/* How well J is known, relative: by the two rings; NAN: there is only one. */
double pg_tip_uncertainty (const pg_tip_field *f, int nfield, const double *l);

/* The facet of length l (m) to come. Angle from e (rad, positive to the left) of the largest hoop stress
 * (Erdogan and Sih 1963), its intensity factor there, and what advancing there releases: G_theta = J
 * K_theta^2 / (K_I^2 + K_II^2). T: stress along the crack. Compression beyond 0.2 K_I / sqrt (l), as wings of
 * closed cracks have it, turns the direction; NAN: it is not known. 0: no direction is in tension. */
int pg_kink (double J, double K_I, double K_II, double T, double l, double *angle, double *K_theta,
             double *G_theta);

/* The direction of the next facet behind a kink (angle from e, rad), so that K_II vanishes along it in the
 * mean of its two ends. start: a first guess. 0: not known (pg_tip_field.trial), or beyond the trials. */
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
