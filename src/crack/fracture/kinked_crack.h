/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: stress intensity factors at the end of a crack that has turned, from the field outside of all that
 * has turned, by reciprocity with the weight functions of the crack as it is (kinked_weights.c,
 * kinked_tip.c).
 *
 * Frame: origin at the kink, axis 1 along the straight crack, which ends there; lengths in a unit of the
 * caller's, so that K has the unit Pa unit^(1/2). A plane vector (x_1, x_2) is x_1 + i x_2. */
#ifndef PG_KINKED_CRACK_H
#define PG_KINKED_CRACK_H
#include "perigal/base.h"
#include <complex.h>
#undef I                                               /* a name of integrals elsewhere */

enum { KINKED_TERMS = 120, KINKED_FIELDS = 2, KINKED_PLACES = 64 };

/* What acts on the faces of the new pieces, all of it in one field: the stress (11, 22, 12) that must not be
 * there, S - (b_1 x_1, b_2 x_2, 0). */
typedef struct { double S[3], b[2]; } kinked_faces;

/* The weight functions of a semi-infinite straight crack that goes on as a polyline. */
typedef struct {
    /* Singular field of the straight crack of K_I = 1 (0) or K_II = 1 (1): K_I and K_II at the end of the
     * polyline, and by how much its field grows with the length of the last piece: potentials
     * sum even_k z^(-k-1) + odd_k z^(-k-3/2). */
    double         k[2][2];
    double complex even[2][KINKED_TERMS], odd[2][KINKED_TERMS];
    double         own[KINKED_FIELDS][2];              /* K_I, K_II of what acts on the new pieces */
    /* The jump of the displacement of that change, left face less right one, times mu / (kappa + 1), at the
     * distances kinked_place_at behind the kink. */
    double         reach;
    double complex jump[2][KINKED_PLACES];
} kinked_weights;

/* vertex: those of the polyline after the kink (n), the last of them the tip. load: nload <= KINKED_FIELDS.
 * reach: of the straight faces that bear something, from the kink; 0: none does. PG_E_SINGULAR: the polyline
 * runs into itself. */
pg_status kinked_weights_of (kinked_weights *out, size_t n, const double complex *vertex, size_t nload,
                             const kinked_faces *load, double reach);
static inline double kinked_place_at (double reach, int i) { return reach * (i + 0.5) / KINKED_PLACES; }

/* Betti's integral over a ring with the field of each term of the potentials: with the potentials of a weight
 * function it is Re sum (even_k even_k + odd_k odd_k). */
typedef struct {
    double complex even[KINKED_TERMS], odd[KINKED_TERMS];
    double complex face[KINKED_PLACES];                /* of the tractions of the straight faces */
} kinked_moments;

/* One place of the ring: z; traction t = sigma . grad q - q b; and, of u_i q,j, the parts 11, 22, and the
 * mean of 12 and 21; times its area. extent: of the polyline, the largest |vertex|. */
typedef struct { double complex z, t; double M[3]; } kinked_place;
void kinked_moments_add (kinked_moments *m, const kinked_place *at, double mu, double kappa, double extent);

/* The straight faces carry sigma_12, sigma_22 over a length of the reach / KINKED_PLACES around place i, in a
 * ring whose weight there is q. */
void kinked_moments_face (kinked_moments *m, int i, const double stress[2], double q, double mu, double kappa,
                          double reach);

/* K_I and K_II (Pa unit^(1/2)) of the field that has the moments, plus what the pieces bear as
 * load number `load`. modulus: E'. 0: the weight functions do not tell them apart. */
int  kinked_intensities (const kinked_weights *w, const kinked_moments *m, double modulus, size_t load,
                         double K[2]);
#endif
