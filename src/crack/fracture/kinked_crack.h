/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: stress intensity factors at the end of a kinked crack, from the field outside the kinked part, by
 * reciprocity with the weight functions of the kinked crack (kinked_weights.c, kinked_tip.c).
 *
 * Frame: origin at the kink, axis 1 along the straight crack, which ends there; lengths in a unit chosen by
 * the caller, so that K has the unit Pa unit^(1/2). A plane vector (x_1, x_2) is x_1 + i x_2. */
#ifndef PG_KINKED_CRACK_H
#define PG_KINKED_CRACK_H
#include "perigal/base.h"
#include <complex.h>
#undef I                                               /* used as a name of integrals elsewhere */

enum { KINKED_TERMS = 120, KINKED_FIELDS = 2, KINKED_PLACES = 64 };

/* Load on the faces of the pieces after the kink: the negative tractions of the stress (11, 22, 12) S - (b_1
 * x_1, b_2 x_2, 0). */
typedef struct { double S[3], b[2]; } kinked_faces;

/* The weight functions of a semi-infinite straight crack that continues as a polyline. */
typedef struct {
    /* Singular field of the straight crack of K_I = 1 (0) or K_II = 1 (1): K_I and K_II at the end of the
     * polyline, and the derivative of its field with respect to the length of the last piece, as potentials
     * sum even_k z^(-k-1) + odd_k z^(-k-3/2). */
    double         k[2][2];
    double complex even[2][KINKED_TERMS], odd[2][KINKED_TERMS];
    double         own[KINKED_FIELDS][2];              /* K_I, K_II due to the loads on the pieces */
    /* Displacement jump (left face less right one) of that derivative, times mu / (kappa + 1), at the
     * distances kinked_place_at behind the kink. */
    double         reach;
    double complex jump[2][KINKED_PLACES];
} kinked_weights;

/* Computes the weight functions. vertex (n): vertices of the polyline after the kink, the last is the tip.
 * load: nload <= KINKED_FIELDS. reach: length of the loaded straight faces behind the kink; 0: unloaded.
 * PG_E_SINGULAR: the polyline intersects itself. */
pg_status kinked_weights_of (kinked_weights *out, size_t n, const double complex *vertex, size_t nload,
                             const kinked_faces *load, double reach);
static inline double kinked_place_at (double reach, int i) { return reach * (i + 0.5) / KINKED_PLACES; }

/* Betti's integrals over a ring between the field and each term of the potentials; the integral with a weight
 * function is Re sum (even_k even_k + odd_k odd_k) of both. */
typedef struct {
    double complex even[KINKED_TERMS], odd[KINKED_TERMS];
    double complex face[KINKED_PLACES];                /* terms of tractions on the straight faces */
} kinked_moments;

/* One integration point of the ring: z; times its area: t = sigma . grad q - q b, and M = u_i q,j (11, 22,
 * mean of 12 and 21). extent: largest |vertex| of the polyline. */
typedef struct { double complex z, t; double M[3]; } kinked_place;
void kinked_moments_add (kinked_moments *m, const kinked_place *at, double mu, double kappa, double extent);

/* Adds stresses sigma_12, sigma_22 on the straight faces over a length reach / KINKED_PLACES around place i,
 * where the weight is q. */
void kinked_moments_face (kinked_moments *m, int i, const double stress[2], double q, double mu, double kappa,
                          double reach);

/* Computes K_I and K_II (Pa unit^(1/2)) from the moments of a field, plus those of load number `load` on the
 * pieces. modulus: E', Pa. Returns 0: the weight functions are not independent. */
int  kinked_intensities (const kinked_weights *w, const kinked_moments *m, double modulus, size_t load,
                         double K[2]);
#endif
