/* SPDX-License-Identifier: GPL-3.0-or-later
 * The weight functions of a kinked crack (Bueckner 1970, Rice 1972): the derivative of the field of a crack
 * with respect to the length of its last piece, which determines the stress intensity factors at its end.
 *
 * The straight part is the negative axis 1 and has free faces. Each further piece is a line of dislocations
 * in its presence, of density B along it (method of Lo 1978). Stresses and displacements by the potentials of
 * Muskhelishvili,
 *
 *   sigma_11 + sigma_22 = 4 Re Phi,   sigma_22 - i sigma_12 = Phi (z) + Omega (z') + (z - z') conj Phi' (z),
 *   2 mu (u_1 + i u_2) = kappa phi (z) - omega (z') - (z - z') conj Phi (z),   z' = conj z, phi' = Phi, ...
 *
 * and Phi = E + O, Omega = O - E of one dislocation at s, with c = conj s and E even, O odd around the
 * origin, from the Hilbert problem of the free straight faces:
 *
 *   E = 1/2 [B (1/(z-s) - 1/(z-c)) - conj B (s-c)/(z-c)^2]
 *   O = 1/(2 sqrt z) [B (sqrt s/(z-s) + sqrt c/(z-c))
 *                     + conj B (s-c) (sqrt c/(z-c)^2 + 1/(2 sqrt c (z-c)))].
 *
 * The densities make the faces of the pieces free of traction, sigma_nn - i sigma_nt = 0, under the singular
 * field of the straight crack, Phi = Omega = (K_I - i K_II) / (2 sqrt (2 pi z)): singular integral equations,
 * which Gauss-Chebyshev quadrature turns into a dense linear system (Erdogan and Gupta 1972). At a corner the
 * density has another singular power, which polynomials do not represent; quadrature points are therefore
 * graded towards corners, s = ((1 + t) / 2)^GRADE along the first half of a piece, which makes the density
 * times the Jacobian smooth enough for the quadrature. */
#include "kinked_crack.h"
#include "perigal/linalg.h"
#include <math.h>
#include <string.h>

enum { NODES = 16, GRADE = 3, LOADS = 2 + KINKED_FIELDS };
static const double pi = 3.14159265358979323846;
static const double step = 0.01;                       /* relative change of the last piece's length */

/* One straight piece: start, vector to its end; last: 1: it ends at the tip. */
typedef struct { double complex from, way; int last; } piece;

/* Position along a piece (0 to 1) at t in (-1, 1), graded towards corners, and its derivative. */
static double graded (const piece *p, double t, double *slope)
{
    double v = 0.5 * (1 + t), a = pow (v, GRADE), b = pow (1 - v, GRADE);
    if (p->last) {
        *slope = 0.5 * GRADE * pow (v, GRADE - 1);
        return a;
    }
    *slope = 0.5 * GRADE * pow (v * (1 - v), GRADE - 1) / ((a + b) * (a + b));
    return a / (a + b);
}

/* 1 / z, without the overflow protection of complex division. */
static double complex inverse_of (double complex z)
{
    return conj (z) * (1 / (creal (z) * creal (z) + cimag (z) * cimag (z)));
}

/* ---- potentials ---------------------------------------------------------------------------------------- */
/* A quadrature or collocation point on a piece: z, sqrt z. */
typedef struct { double complex z, root; } place;

static place place_on (const piece *p, double t)
{
    double slope;
    double complex z = p->from + graded (p, t, &slope) * p->way;
    return (place){ z, csqrt (z) };
}

/* sigma_nn - i sigma_nt across a piece, turn = conj (way) / way, from Phi at z, Phi' there and Omega at conj
 * z. */
static double complex traction (double complex z, double complex turn, double complex Phi,
                                double complex slope, double complex Omega)
{
    double complex across = Phi + Omega + (z - conj (z)) * conj (slope), mean = Phi + conj (Phi);
    return mean + turn * (across - mean);
}

/* Traction across a piece by a dislocation at s with B = 1 (T[0]) and with B = i (T[1]). The two fractions at
 * conj z are conjugate to each other's at z. */
static void of_dislocation (const place *at, double complex turn, const place *s, double complex T[2])
{
    double complex z = at->z, rs = s->root, rc = conj (rs), c = conj (s->z), d = inverse_of (z - s->z),
                   f = inverse_of (z - c), dw = conj (f), fw = conj (d), half = 0.5 * inverse_of (at->root),
                   inverse = 0.5 * inverse_of (rc),
                   over = half * half * 2;             /* 1 / (2 z) */
    double complex even[2] = { 0.5 * (d - f), -0.5 * f * f },
                   even_slope[2] = { 0.5 * (f * f - d * d), f * f * f },
                   odd[2] = { half * (rs * d + rc * f), half * (rc * f * f + inverse * f) },
                   odd_slope[2] = { -over * odd[0] - half * (rs * d * d + rc * f * f),
                                    -over * odd[1] - half * (2 * rc * f * f * f + inverse * f * f) },
                   half_w = conj (half),
                   omega[2] = { half_w * (rs * dw + rc * fw) - 0.5 * (dw - fw),
                                half_w * (rc * fw * fw + inverse * fw) + 0.5 * fw * fw };
    for (int part = 0; part < 2; part++) {
        double complex b = part ? _Complex_I : 1, a = conj (b) * (s->z - c);
        T[part] = traction (z, turn, b * (even[0] + odd[0]) + a * (even[1] + odd[1]),
                            b * (even_slope[0] + odd_slope[0]) + a * (even_slope[1] + odd_slope[1]),
                            b * omega[0] + a * omega[1]);
    }
}

/* Traction across a piece by load `which`: 0, 1: singular field of the straight crack; else loads on the
 * pieces. */
static double complex of_load (const place *at, double complex turn, size_t which, const kinked_faces *load)
{
    double complex z = at->z;
    if (which < 2) {
        double complex K = which ? -_Complex_I : 1, Phi = K / (2 * sqrt (2 * pi) * at->root);
        return traction (z, turn, Phi, -Phi / (2 * z), K / (2 * sqrt (2 * pi) * conj (at->root)));
    }
    const kinked_faces *f = &load[which - 2];
    double s11 = f->S[0] - f->b[0] * creal (z), s22 = f->S[1] - f->b[1] * cimag (z);
    double complex mean = 0.5 * (s11 + s22);
    return mean + turn * (s22 - _Complex_I * f->S[2] - mean);
}

/* ---- the system ---------------------------------------------------------------------------------------- */
static double node_at (int k) { return cos ((2 * k - 1) * pi / (2 * NODES)); }          /* k = 1 .. NODES */

/* Coefficient of node k in the extrapolated density at the end t = 1 (for t = -1 of node NODES + 1 - k). */
static double end_share (int k)
{
    double half = (2 * k - 1) * pi / (4 * NODES);
    return sin ((2 * NODES - 1) * half) / sin (half) / NODES;
}

/* Equations of piece p: zero traction at NODES - 1 points, and zero density at its start. A: 2 N x 2 N by
 * columns; unknowns of node j: real and imaginary part. node: quadrature points of all pieces. */
static void fill_rows (const piece *all, const place *node, size_t n, size_t p, size_t nload,
                       const kinked_faces *load, double *A, double *b)
{
    size_t rows = 2 * NODES * n;
    double complex turn = conj (all[p].way) / all[p].way;
    for (int i = 1; i < NODES; i++) {
        place at = place_on (&all[p], cos (i * pi / NODES));
        size_t row = 2 * (p * NODES + (size_t) i - 1);
        for (size_t k = 0; k < n * NODES; k++) {
            double complex T[2];
            of_dislocation (&at, turn, &node[k], T);
            for (size_t part = 0; part < 2; part++) {
                double *entry = A + (2 * k + part) * rows + row;
                entry[0] = pi / NODES * creal (T[part]), entry[1] = pi / NODES * cimag (T[part]);
            }
        }
        for (size_t l = 0; l < 2 + nload; l++) {
            double complex T = of_load (&at, turn, l, load);
            b[l * rows + row] = -creal (T), b[l * rows + row + 1] = -cimag (T);
        }
    }
    size_t row = 2 * (p * NODES + NODES - 1);
    for (int k = 1; k <= NODES; k++)
        for (size_t part = 0; part < 2; part++)
            A[(2 * (p * NODES + (size_t) k - 1) + part) * rows + row + part] = end_share (NODES + 1 - k);
}

/* Adds the potentials outside of the polyline due to densities d, times `times`: coefficients of E and O in
 * powers of 1 / z. */
static void add_series (const place *node, size_t n, const double *d, double times, double complex *even,
                        double complex *odd)
{
    for (size_t k = 0; k < n * NODES; k++) {
        double complex s = node[k].z, c = conj (s), rs = node[k].root, rc = conj (rs), sk = 1, ck = 1,
                       before = 0, B = times * pi / NODES * (d[2*k] + _Complex_I * d[2*k + 1]),
                       a = conj (B) * (s - c),
                       inverse = 0.5 / rc;
        for (int m = 0; m < KINKED_TERMS; m++) {       /* sk = s^m, ck = c^m, before = c^(m-1) */
            even[m] += 0.5 * (B * (sk - ck) - a * m * before);
            odd[m] += 0.5 * (B * (rs * sk + rc * ck) + a * (m * rc * before + inverse * ck));
            before = ck, sk *= s, ck *= c;
        }
    }
}

/* Adds `times` mu / (kappa + 1) times the jump of u across the straight crack due to densities d: int O dz
 * from infinity along its left face, in closed form by the root of z. */
static void add_jump (const place *node, size_t n, const double *d, double times, double reach,
                      double complex *jump)
{
    for (int i = 0; i < KINKED_PLACES; i++) {
        double r = kinked_place_at (reach, i);
        double complex root = _Complex_I * sqrt (r), sum = 0;
        for (size_t k = 0; k < n * NODES; k++) {
            double complex s = node[k].root, c = conj (s),
                           B = pi / NODES * (d[2*k] + _Complex_I * d[2*k + 1]);
            sum += 0.5 * B * (clog ((root - s) / (root + s)) + clog ((root - c) / (root + c)))
                   + conj (B) * (node[k].z - conj (node[k].z)) * root / (2 * c * (r + c * c));
        }
        jump[i] += times * sum;
    }
}

/* Solves for all loads with the last piece `longer` times as long, and adds half of K at its end, and the
 * potentials for a central difference with respect to the length. */
static pg_status add_change (kinked_weights *out, piece *all, size_t n, double longer, size_t nload,
                             const kinked_faces *load)
{
    pg_status status = PG_OK;
    size_t rows = 2 * NODES * n;
    double *A = NULL, *b = NULL, slope;
    place *node = NULL;
    piece *last = &all[n - 1];
    double complex way = last->way;
    PG_ALLOC (A, rows * rows);
    PG_ALLOC (b, rows * (2 + nload));
    PG_ALLOC (node, n * NODES);
    last->way *= longer;
    for (size_t k = 0; k < n * NODES; k++)
        node[k] = place_on (&all[k / NODES], node_at ((int) (k % NODES) + 1));
    for (size_t p = 0; p < n; p++) fill_rows (all, node, n, p, nload, load, A, b);
    PG_TRY (pg_dense_lu (rows, A, 2 + nload, b));
    graded (last, 1, &slope);
    double length = cabs (last->way), change = (longer > 1 ? 1 : -1) / (2 * step * cabs (way));
    for (size_t l = 0; l < 2 + nload; l++) {
        double complex end = 0;
        const double *d = b + l * rows;
        for (int k = 1; k <= NODES; k++) {
            size_t at = 2 * ((n - 1) * NODES + (size_t) k - 1);
            end += end_share (k) * (d[at] + _Complex_I * d[at + 1]);
        }
        end *= pi * sqrt (2 * pi) * sqrt (2 / (length * slope)) * conj (last->way) / length;
        double *K = l < 2 ? out->k[l] : out->own[l - 2];
        K[0] += 0.5 * creal (end), K[1] -= 0.5 * cimag (end);
        if (l < 2) add_series (node, n, d, change, out->even[l], out->odd[l]);
        if (l < 2 && out->reach > 0) add_jump (node, n, d, change, out->reach, out->jump[l]);
    }
done:
    last->way = way;
    pg_free (A), pg_free (b), pg_free (node);
    return status;
}

pg_status kinked_weights_of (kinked_weights *out, size_t n, const double complex *vertex, size_t nload,
                             const kinked_faces *load, double reach)
{
    pg_status status = PG_OK;
    piece *all = NULL;
    memset (out, 0, sizeof *out);
    out->reach = reach;
    PG_ALLOC (all, n);
    for (size_t p = 0; p < n; p++) {
        double complex from = p ? vertex[p - 1] : 0;
        all[p] = (piece) { from, vertex[p] - from, p + 1 == n };
    }
    PG_TRY (add_change (out, all, n, 1 + step, nload, load));
    PG_TRY (add_change (out, all, n, 1 - step, nload, load));
    if (!isfinite (out->k[0][0] + out->k[0][1] + out->k[1][0] + out->k[1][1]))
        PG_FAIL (PG_E_SINGULAR, "a crack of %zu pieces behind a kink runs into itself", n);
done:
    pg_free (all);
    return status;
}

/* ---- reciprocity --------------------------------------------------------------------------------------- */
/* Number of terms of the series needed at distance r from the kink. */
static int terms_at (double r, double extent)
{
    static const double least = -18;                   /* ln of the relative truncation error */
    double n = extent < r ? least / log (extent / r) : KINKED_TERMS;
    return n < KINKED_TERMS ? (int) n + 1 : KINKED_TERMS;
}

/* The integrand t . h - s_ij u_i q,j of a weight function with the displacement h and the stress s, as
 * Re (a_0 phi + a_1 omega (z') + a_2 Phi + a_3 Omega (z') + a_4 Phi'). */
void kinked_moments_add (kinked_moments *out, const kinked_place *at, double mu, double kappa, double extent)
{
    double complex z = at->z, w = conj (z), t = at->t / (2 * mu),
                   m = at->M[1] - at->M[0] + 2 * _Complex_I * at->M[2];
    double complex a[5] = { kappa * conj (t), -conj (t), t * (z - w) - 4 * at->M[0] - m, -m,
                            conj (m) * (z - w) };
    int n = terms_at (cabs (z), extent);
    double complex zi = inverse_of (z), wi = conj (zi), ze = 1, zo = 1 / csqrt (z);
    for (int k = 0; k < n; k++) {
        /* ze = z^(-k), zo = z^(-k-1/2); even[0] has no field outside: its logarithm drops out */
        double even = k + 1, odd = k + 1.5;
        double complex we = conj (ze), wo = conj (zo);
        if (k)
            out->even[k] += (a[0] * ze - a[1] * we) * (1 / (1 - even)) + a[2] * ze * zi - a[3] * we * wi
                            - even * a[4] * ze * zi * zi;
        out->odd[k] += (a[0] * zo + a[1] * wo) * (1 / (1 - odd)) + a[2] * zo * zi + a[3] * wo * wi
                       - odd * a[4] * zo * zi * zi;
        ze *= zi, zo *= zi;
    }
}

/* Contribution of both faces: the traction of the left one, -(sigma_12, sigma_22), with the jump of the
 * weight function. */
void kinked_moments_face (kinked_moments *m, int i, const double stress[2], double q, double mu, double kappa,
                          double reach)
{
    double complex t = -(stress[0] + _Complex_I * stress[1]) * q * reach / KINKED_PLACES;
    m->face[i] += (kappa + 1) / mu * conj (t);
}

/* By Rice (1972) the derivative of load l's field with respect to the length is 2 / E' (k_I h_I + k_II h_II)
 * of the weight functions h, whose integrals are K_I and K_II. */
int kinked_intensities (const kinked_weights *w, const kinked_moments *m, double modulus, size_t load,
                        double K[2])
{
    double integral[2], det = w->k[0][0] * w->k[1][1] - w->k[0][1] * w->k[1][0], size = 0;
    for (int l = 0; l < 2; l++) {
        double complex sum = 0;
        for (int k = 0; k < KINKED_TERMS; k++)
            sum += w->even[l][k] * m->even[k] + w->odd[l][k] * m->odd[k];
        for (int i = 0; i < KINKED_PLACES; i++) sum -= w->jump[l][i] * m->face[i];
        integral[l] = -0.5 * modulus * creal (sum);
        size = fmax (size, fmax (fabs (w->k[l][0]), fabs (w->k[l][1])));
    }
    K[0] = w->own[load][0] + (integral[0] * w->k[1][1] - integral[1] * w->k[0][1]) / det;
    K[1] = w->own[load][1] + (w->k[0][0] * integral[1] - w->k[1][0] * integral[0]) / det;
    return fabs (det) > 1e-3 * size * size && isfinite (K[0]) && isfinite (K[1]);
}
