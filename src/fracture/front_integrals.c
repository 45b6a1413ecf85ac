/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integrals over one cross section of the tube around a front. Places are x = P (s) + y_1 e (s) + y_2 n
 * (s), y = r (cos theta, sin theta), and the frame turns along the front, db/ds = w x b. Then
 *
 *   dx/ds = L t + w_3 (y_1 n - y_2 e),   L = 1 - w_2 y_1 + w_1 y_2,   dV = L r dr dtheta ds,
 *
 * and of a tensor whose components in the frame do not change with s the derivative along t is
 *
 *   d/dt T = (w x T - w_3 dT/dtheta) / L       (w x: on every index).
 *
 * With q = e Q (r) hat (s), Q falling from 1 at r1 to 0 at r2, and P_kj = sigma_ij u_i,k - W delta_kj, the
 * energy release rate times the length of the hat is (Shih, Moran and Nakamura 1986)
 *
 *   int P_kj q_k,j dV = int [ P_1j Q,j L + Q (w_3 P_23 - w_2 P_33) ] hat + P_13 Q hat' r dr dtheta ds.
 *
 * The exact fields of a straight front, (A = grad a, S), with their components in the turning frame, are
 * neither in equilibrium nor compatible on a curved front; with P_kj = sigma_ij A_ik + S_ij u_i,k - sigma:A
 * delta_kj the interaction integral has the further terms (Gosz and Moran 2002)
 *
 *   int [ sigma_ij (A_ik,j - eps_ij,k) + S_ij,j u_i,k ] q_k dV
 *     = int [ sigma_i3 (L dA/dt)_i1 + u_i,1 (L dS/dt)_i3 ] Q hat r dr dtheta ds,
 *
 * for what remains in the plane across vanishes as it does for a straight front. Next to the front the terms
 * with hat' are left out: they are noise there, but for their sum over the singular fields
 * (front_core_along), which is added along the front. */
#include "front.h"
#include <math.h>
#include <string.h>

/* sigma_ij H_ik for k, j. */
static double flux (const double *S, const double *H, int k, int j)
{
    return S[j] * H[k] + S[3 + j] * H[3 + k] + S[6 + j] * H[6 + k];
}

static double work (const double *S, const double *H)
{
    double sum = 0;
    for (int i = 0; i < 9; i++) sum += S[i] * H[i];
    return sum;
}

/* Vector product of w with both indices of a tensor: W T - T W, W the matrix of w x. */
static void turned (const double *w, const double *T, double *out)
{
    double W[9] = { 0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0 };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            double sum = 0;
            for (int k = 0; k < 3; k++) sum += W[3*i + k] * T[3*k + j] - T[3*i + k] * W[3*k + j];
            out[3*i + j] = sum;
        }
}

/* W of two fields at a place. */
static double energy (const front_sample *a, const front_sample *b, const tip_material *m, size_t k)
{
    const double *G = a->H + 9*k, *H = b->H + 9*k;
    double W = 0.25 * (work (a->S + 9*k, H) + work (b->S + 9*k, G));
    if (!a->excess || !b->excess) return W;
    double x = a->excess[k], y = b->excess[k], g = G[0] + G[4] + G[8], h = H[0] + H[4] + H[8];
    return W + 0.25 * (x * h + y * g) + 0.5 * x * y / m->lambda;
}

/* The terms of one place: with the gradient of Q along r, with Q and the hat, and with Q and hat'. */
typedef struct { double slope, core, along; } terms;

/* P_kj of J for two fields, without W. */
static double flux_of_two (const front_sample *a, const front_sample *b, size_t place, int k, int j)
{
    return 0.5 * (flux (a->S + 9*place, b->H + 9*place, k, j) + flux (b->S + 9*place, a->H + 9*place, k, j));
}

static terms terms_of_J (const front_sample *a, const front_sample *b, const tip_material *m, size_t k,
                         const front_place *at, double theta, double L)
{
    double W = energy (a, b, m, k), c = cos (theta), s = sin (theta);
    const double *w = at->turn;
    if (a->moving && a == b) W += a->moving[k];
    terms out = { .slope = (c * (flux_of_two (a, b, k, 0, 0) - W) + s * flux_of_two (a, b, k, 0, 1)) * L,
                  .core = w[2] * flux_of_two (a, b, k, 1, 2) - w[1] * (flux_of_two (a, b, k, 2, 2) - W),
                  .along = flux_of_two (a, b, k, 0, 2) };
    for (size_t i = 0; i < 3; i++) {
        if (a->load) out.core -= 0.5 * L * a->load[3*k + i] * b->H[9*k + 3*i];
        if (b->load) out.core -= 0.5 * L * b->load[3*k + i] * a->H[9*k + 3*i];
    }
    if (a->kinetic && a == b) out.core -= L * a->kinetic[k];
    return out;
}

/* An exact field at a place: A, S, and L times their derivatives along t. */
typedef struct { double A[9], S[9], A_t[9], S_t[9]; } exact;

static void exact_at (int field, const tip_material *m, const front_place *at, double r, double theta,
                      exact *out)
{
    static const double step = 1e-4;                   /* rad */
    front_near_field (field, m, r, theta, NULL, out->A, out->S);
    turned (at->turn, out->A, out->A_t), turned (at->turn, out->S, out->S_t);
    if (at->turn[2] == 0) return;
    double A[2][9], S[2][9];
    front_near_field (field, m, r, theta - step, NULL, A[0], S[0]);
    front_near_field (field, m, r, theta + step, NULL, A[1], S[1]);
    for (int i = 0; i < 9; i++) {
        out->A_t[i] -= at->turn[2] * (A[1][i] - A[0][i]) / (2 * step);
        out->S_t[i] -= at->turn[2] * (S[1][i] - S[0][i]) / (2 * step);
    }
}

static terms terms_of_I (const front_sample *f, const exact *x, size_t k, const front_place *at, double theta,
                         double L)
{
    const double *S = f->S + 9*k, *H = f->H + 9*k, *w = at->turn;
    double W = work (S, x->A), c = cos (theta), s = sin (theta);
    terms out = { .slope = L * (c * (flux (S, x->A, 0, 0) + flux (x->S, H, 0, 0) - W)
                                + s * (flux (S, x->A, 0, 1) + flux (x->S, H, 0, 1))),
                  .core = w[2] * (flux (S, x->A, 1, 2) + flux (x->S, H, 1, 2))
                          - w[1] * (flux (S, x->A, 2, 2) + flux (x->S, H, 2, 2) - W)
                          + flux (S, x->A_t, 0, 2) + flux (x->S_t, H, 0, 2),
                  .along = flux (S, x->A, 0, 2) + flux (x->S, H, 0, 2) };
    for (size_t i = 0; f->load && i < 3; i++) out.core -= L * f->load[3*k + i] * x->A[3*i];
    return out;
}

double front_weight (double r, double r1, double r2, double *slope)
{
    double z = (r - r1) / (r2 - r1);
    if (slope) *slope = z > 0 && z < 1 ? -6 * z * (1 - z) / (r2 - r1) : 0;
    return z <= 0 ? 1 : z >= 1 ? 0 : 1 - z * z * (3 - 2 * z);
}

/* The mean of the strain along the front over places between one spacing and the smallest radius. */
static void add_strain (front_sums *out, const front_section *section, const front_place *at,
                        const tip_material *m, size_t k, double share, int nfield, const front_sample *field)
{
    double u[3], y[2] = { section->r[k] * cos (section->theta[k]), section->r[k] * sin (section->theta[k]) },
                 L = 1 - at->turn[1] * y[0] + at->turn[0] * y[1];
    for (int a = 0; a < nfield; a++) out->strain[a] += share * field[a].H[9*k + 8];
    for (int i = 0; i < 2; i++) {
        front_near_field (i, m, section->r[k], section->theta[k], u, NULL, NULL);
        out->by_K[i] += share * (at->turn[0] * u[1] - at->turn[1] * u[0]) / fmax (L, 0.2);
    }
}

void front_integrals (front_sums *out, const front_section *section, const front_place *at,
                      const tip_material *m, double h, int radii, const unsigned char *in, int nfield,
                      const front_sample *field)
{
    double ring = 0;                                   /* area of the places that the strain is taken from */
    memset (out, 0, sizeof *out);
    for (size_t k = 0; k < FRONT_PLACES; k++) {
        double r = section->r[k], theta = section->theta[k], slope[FRONT_RADII], Q[FRONT_RADII];
        if (!in[k] || radii == 0 || r >= front_radius[radii - 1] * h) continue;
        double L = 1 - at->turn[1] * r * cos (theta) + at->turn[0] * r * sin (theta);
        int core = r < front_core * h;
        for (int i = 0; i < radii; i++) Q[i] = front_weight (r, h, front_radius[i] * h, &slope[i]);
        for (int a = 0; a < nfield; a++)
            for (int b = 0; b <= a; b++) {
                terms t = terms_of_J (&field[a], &field[b], m, k, at, theta, L);
                for (int i = 0; i < radii; i++) {
                    out->J[i][a][b] += section->area[k] * (slope[i] * t.slope + Q[i] * t.core);
                    if (!core) out->J_along[i][a][b] += section->area[k] * Q[i] * t.along;
                }
            }
        for (int x = 0; x < FRONT_FIELDS; x++) {
            exact e;
            exact_at (x, m, at, r, theta, &e);
            for (int a = 0; a < nfield; a++) {
                terms t = terms_of_I (&field[a], &e, k, at, theta, L);
                for (int i = 0; i < radii; i++) {
                    out->I[i][x][a] += section->area[k] * (slope[i] * t.slope + Q[i] * t.core);
                    if (!core) out->I_along[i][x][a] += section->area[k] * Q[i] * t.along;
                }
            }
        }
        if (r < h || r > front_radius[0] * h) continue;
        ring += section->area[k];
        add_strain (out, section, at, m, k, section->area[k], nfield, field);
    }
    for (int i = 0; i < radii; i++)
        out->J[i][0][1] = out->J[i][1][0], out->J_along[i][0][1] = out->J_along[i][1][0];
    for (int i = 0; i < 2 && ring > 0; i++) out->strain[i] /= ring, out->by_K[i] /= ring;
}

/* r (S_i3 A_i1) of modes II and III with each other does not depend on r: equal angles around, which sum
 * trigonometric polynomials exactly. */
double front_core_along (const tip_material *m, double h)
{
    enum { ANGLES = 64 };
    static const double pi = 3.14159265358979323846;
    double sum = 0, A[2][9], S[2][9];
    for (int i = 0; i < ANGLES; i++) {
        double theta = -pi + 2 * pi * (i + 0.5) / ANGLES;
        front_near_field (FRONT_II, m, 1, theta, NULL, A[0], S[0]);
        front_near_field (FRONT_III, m, 1, theta, NULL, A[1], S[1]);
        sum += flux (S[0], A[1], 0, 2) + flux (S[1], A[0], 0, 2);
    }
    return sum * 2 * pi / ANGLES * front_core * h;
}
