/* SPDX-License-Identifier: GPL-3.0-or-later
 * The integrals around a tip, and over one cross section of the tube around a front. With a weight q that
 * falls from 1 at r1 to 0 at r2, and the divergence theorem, the line integral of Rice becomes one over the
 * ring (Moran and Shih 1987),
 *
 *   J = int (sigma_ij u_i,1 - (W + W_k) delta_1j) q,j dA - int (b - rho a)_i u_i,1 q dA
 *       - int rho v_i v_i,1 q dA,
 *
 * W_k = 1/2 rho v.v; bilinear in two displacements a and b whose sum is the field:
 *
 *   J_ab = int (1/2 (sigma^a_ij u^b_i,1 + sigma^b_ij u^a_i,1) - W_ab delta_1j) q,j dA - ...,  W_ab = 1/2
 *   sigma^a : eps^b.
 *
 * With an exact field a of unit strength the mixed part of J (u + a) is the interaction integral
 *
 *   I = int (sigma_ij a_i,1 + s_ij u_i,1 - sigma_ij e_ij delta_1j) q,j dA - int (b - rho a)_i a_i,1 q dA,
 *
 * s and e its stress and strain: K = E'/2 I for the singular fields (K_III = mu I), T = E' I for the force on
 * the tip.
 *
 * Where a mean dilatation carries the pressure p (Poisson's ratio near 1/2), sigma = D eps + (p - lambda tr
 * eps) 1, and the energy that this stress belongs to is W = 1/2 eps D eps - lambda / 2 (tr eps)^2 + p^2 / (2
 * lambda): with x = p - lambda tr eps, 1/2 eps D eps + x tr eps + x^2 / (2 lambda).
 *
 * In space places are x = P (s) + y_1 e (s) + y_2 n (s), y = r (cos theta, sin theta), and the frame turns
 * along the front, db/ds = w x b. Then
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

/* q = 1 - z^2 (3 - 2 z). */
double front_weight (double r, double r1, double r2, double *slope)
{
    double z = (r - r1) / (r2 - r1);
    if (slope) *slope = z > 0 && z < 1 ? -6 * z * (1 - z) / (r2 - r1) : 0;
    return z <= 0 ? 1 : z >= 1 ? 0 : 1 - z * z * (3 - 2 * z);
}

/* sigma_ij H_ik, summed over i. */
static double flux (const double *S, const double *H, int k, int j)
{
    return S[j] * H[k] + S[3 + j] * H[3 + k] + S[6 + j] * H[6 + k];
}

/* sigma : eps, in-plane terms first. */
static double work (const double *S, const double *H)
{
    return S[0] * H[0] + S[4] * H[4] + S[1] * (H[1] + H[3])
           + (S[8] * H[8] + S[2] * (H[2] + H[6]) + S[5] * (H[5] + H[7]));
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

/* Bilinear energy density W_ab of two fields at point k, J/m^3. */
static double energy (const front_sample *a, const front_sample *b, const tip_material *m, size_t k)
{
    const double *G = a->H + 9*k, *H = b->H + 9*k;
    double W = 0.25 * (work (a->S + 9*k, H) + work (b->S + 9*k, G));
    if (!a->excess || !b->excess || !(m->lambda > 0)) return W;
    double x = a->excess[k], y = b->excess[k], g = G[0] + G[4] + G[8], h = H[0] + H[4] + H[8];
    return W + 0.25 * (x * h + y * g) + 0.5 * x * y / m->lambda;
}

/* ---- terms of the integrands at one point -------------------------------------------------------------- */
/* Terms of the integrand of two fields. share: 1/2 for J (mean of both orders), 1 for I; flux: P_11 and P_12
 * without W; W; core: factor of Q hat; along: factor of Q hat'; load: loads times u,1; kinetic terms. */
typedef struct { double share, flux[2][2], W, core, along, load[2], kinetic, moving; } terms;

/* Integrand without the term in hat', for the weight Q with gradient g. */
static double at_weight (const terms *t, double Q, const double g[2])
{
    double sum = t->share * (t->flux[0][0] * g[0] + t->flux[0][1] * g[1]
                             + (t->flux[1][0] * g[0] + t->flux[1][1] * g[1])) - t->W * g[0];
    for (int a = 0; a < 2; a++) sum -= t->share * Q * t->load[a];
    return sum - (Q * t->kinetic + t->moving * g[0]) + Q * t->core;
}

static double work_along (const front_sample *f, size_t k, const double *H)
{
    const double *load = f->load ? f->load + 3*k : NULL;
    return load ? load[0] * H[0] + load[1] * H[3] + load[2] * H[6] : 0;
}

/* P_kj of J for two fields at a point, without W. */
static double flux_of_two (const front_sample *a, const front_sample *b, size_t place, int k, int j)
{
    return 0.5 * (flux (a->S + 9*place, b->H + 9*place, k, j) + flux (b->S + 9*place, a->H + 9*place, k, j));
}

static terms terms_of_J (const front_sample *a, const front_sample *b, const tip_material *m, size_t k,
                         const double *w, double L)
{
    double W = energy (a, b, m, k), moving = a->moving && a == b ? a->moving[k] : 0;
    terms out = { .share = 0.5, .W = W, .moving = moving,
                  .core = w[2] * flux_of_two (a, b, k, 1, 2)
                          - w[1] * (flux_of_two (a, b, k, 2, 2) - W - moving),
                  .along = flux_of_two (a, b, k, 0, 2),
                  .load = { L * work_along (a, k, b->H + 9*k), L * work_along (b, k, a->H + 9*k) },
                  .kinetic = a->kinetic && a == b ? L * a->kinetic[k] : 0 };
    for (int j = 0; j < 2; j++)
        out.flux[0][j] = flux (a->S + 9*k, b->H + 9*k, 0, j),
        out.flux[1][j] = flux (b->S + 9*k, a->H + 9*k, 0, j);
    return out;
}

/* An exact field at a point: gradient A, stress S, and L times their derivatives along t. */
typedef struct { double A[9], S[9], A_t[9], S_t[9]; } exact;

static void exact_at (int field, const tip_material *m, const double *w, double r, double theta, exact *out)
{
    static const double step = 1e-4;                   /* rad */
    front_near_field (field, m, r, theta, NULL, out->A, out->S);
    turned (w, out->A, out->A_t), turned (w, out->S, out->S_t);
    if (w[2] == 0) return;
    double A[2][9], S[2][9];
    front_near_field (field, m, r, theta - step, NULL, A[0], S[0]);
    front_near_field (field, m, r, theta + step, NULL, A[1], S[1]);
    for (int i = 0; i < 9; i++) {
        out->A_t[i] -= w[2] * (A[1][i] - A[0][i]) / (2 * step);
        out->S_t[i] -= w[2] * (S[1][i] - S[0][i]) / (2 * step);
    }
}

static terms terms_of_I (const front_sample *f, const exact *x, size_t k, const double *w, double L)
{
    const double *S = f->S + 9*k, *H = f->H + 9*k;
    double W = work (S, x->A);
    terms out = { .share = 1, .W = W,
                  .core = w[2] * (flux (S, x->A, 1, 2) + flux (x->S, H, 1, 2))
                          - w[1] * (flux (S, x->A, 2, 2) + flux (x->S, H, 2, 2) - W)
                          + flux (S, x->A_t, 0, 2) + flux (x->S_t, H, 0, 2),
                  .along = flux (S, x->A, 0, 2) + flux (x->S, H, 0, 2),
                  .load = { L * work_along (f, k, x->A) } };
    for (int j = 0; j < 2; j++)
        out.flux[0][j] = flux (S, x->A, 0, j), out.flux[1][j] = flux (x->S, H, 0, j);
    return out;
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Weight Q of each radius at a point, and its gradient times L; core: 1: the point is within front_core of
 * the front. */
typedef struct { double area, Q[FRONT_RADII], g[FRONT_RADII][2]; int radii, core; } weights;

static weights weights_at (const measuring *m, const cross_section *s, const front_places *q, size_t k,
                           double L)
{
    weights out = { .area = q->area[k], .radii = s->radii, .core = q->r[k] < front_core * m->h };
    double c = cos (q->theta[k]), sine = sin (q->theta[k]), slope;
    for (int i = 0; i < s->radii; i++) {
        out.Q[i] = front_weight (q->r[k], m->r1, m->radius[i], &slope);
        out.g[i][0] = slope * c * L, out.g[i][1] = slope * sine * L;
    }
    return out;
}

/* Adds a point to the sums of all radii, which are `each` numbers apart. */
static void add (const weights *w, const terms *t, size_t each, double *sum, double *along)
{
    for (int i = 0; i < w->radii; i++, sum += each, along += each) {
        if (w->Q[i] <= 0) continue;
        *sum += w->area * at_weight (t, w->Q[i], w->g[i]);
        if (!w->core) *along += w->area * w->Q[i] * t->along;
    }
}
static void add_J (front_sums *out, const weights *w, const terms *t, int a, int b)
{
    add (w, t, 4, &out->J[0][a][b], &out->J_along[0][a][b]);
}
static void add_I (front_sums *out, const weights *w, const terms *t, int x, int a)
{
    add (w, t, 2 * FRONT_FIELDS, &out->I[0][x][a], &out->I_along[0][x][a]);
}

/* Completes J of two fields by symmetry. */
static void mirror (front_sums *out)
{
    for (int i = 0; i < FRONT_RADII; i++)
        out->J[i][0][1] = out->J[i][1][0], out->J_along[i][0][1] = out->J_along[i][1][0];
}

/* Adds a point to the mean strain along the front (points between one spacing and the smallest radius). */
static void add_strain (front_sums *out, const measuring *m, const cross_section *s, const front_places *q,
                        size_t k, double L)
{
    const double *w = s->at.turn;
    double u[3], share = q->area[k];
    for (int a = 0; a < m->nfield; a++) out->strain[a] += share * q->field[a].H[9*k + 8];
    for (int i = 0; i < 2; i++) {
        front_near_field (i, &s->material, q->r[k], q->theta[k], u, NULL, NULL);
        out->by_K[i] += share * (w[0] * u[1] - w[1] * u[0]) / fmax (L, 0.2);
    }
}

void front_integrals (front_sums *out, const measuring *m, const cross_section *s, const front_places *q,
                      size_t first, size_t last)
{
    const tip_material *material = &s->material;
    double ring = 0;                                   /* area of the points used for the mean strain */
    memset (out, 0, sizeof *out);
    for (size_t k = first; k < last && s->radii; k++) {
        double r = q->r[k], theta = q->theta[k];
        double L = 1 - s->at.turn[1] * r * cos (theta) + s->at.turn[0] * r * sin (theta);
        weights w = weights_at (m, s, q, k, L);
        if (w.Q[s->radii - 1] <= 0) continue;
        for (int a = 0; a < m->nfield; a++)
            for (int b = 0; b <= a; b++) {
                terms t = terms_of_J (&q->field[a], &q->field[b], material, k, s->at.turn, L);
                add_J (out, &w, &t, a, b);
            }
        for (int x = 0; x < FRONT_FIELDS; x++) {
            exact e;
            if (!front_has (material, x)) continue;
            exact_at (x, material, s->at.turn, r, theta, &e);
            for (int a = 0; a < m->nfield; a++) {
                terms t = terms_of_I (&q->field[a], &e, k, s->at.turn, L);
                add_I (out, &w, &t, x, a);
            }
        }
        if (material->dim < 3 || r < m->h || r > m->radius[0]) continue;
        ring += q->area[k];
        add_strain (out, m, s, q, k, L);
    }
    mirror (out);
    for (int i = 0; i < 2 && ring > 0; i++) out->strain[i] /= ring, out->by_K[i] /= ring;
}

/* A point force contributes its term times the weight, without integration. */
void front_force_integrals (front_sums *out, const measuring *m, const cross_section *s,
                            const front_places *q, size_t k, double A[FRONT_FIELDS][9])
{
    weights w = weights_at (m, s, q, k, 0);
    for (int a = 0; a < m->nfield; a++) {
        const front_sample *f = &q->field[a];
        for (int b = 0; b <= a; b++) {
            const front_sample *g = &q->field[b];
            const terms t = { .share = 0.5,
                              .load = { work_along (f, k, g->H + 9*k), work_along (g, k, f->H + 9*k) } };
            add_J (out, &w, &t, a, b);
        }
        for (int x = 0; x < FRONT_FIELDS; x++) {
            const terms t = { .share = 1, .load = { work_along (f, k, A[x]) } };
            add_I (out, &w, &t, x, a);
        }
    }
    mirror (out);
}

void tip_face_integrals (front_sums *out, const measuring *m, const front_places *faces)
{
    const cross_section *s = m->section;
    for (size_t k = 0; k < faces->n; k++)
        for (int i = 0; i < s->radii; i++) {
            double q = front_weight (faces->r[k], m->r1, m->radius[i], NULL);
            for (int a = 0; a < m->nfield; a++)
                for (int b = 0; b <= a; b++)
                    out->J[i][a][b] += faces->area[k] * q
                                       * energy (&faces->field[a], &faces->field[b], &s->material, k);
        }
    mirror (out);
}

/* r (S_i3 A_i1) of modes II and III combined does not depend on r; it is integrated over equal angles, which
 * is exact for trigonometric polynomials. */
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
