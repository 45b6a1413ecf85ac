/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact fields around the tip of a crack with free faces in an isotropic plane: the singular terms of modes I
 * and II (Williams 1957, On the stress distribution at the base of a stationary crack), and a force on the
 * tip along the crack (the wedge of Michell 1902 with the angle 2 pi); and around a straight front in space.
 * They are the auxiliary fields of the interaction integrals.
 *
 * Modes I and II: u = sqrt (r / 2 pi) / (2 mu) f (theta), so that u,r = u / 2r, and u,theta follows from f'.
 * With a = theta / 2:
 *
 *   I    f_1 = cos a (kappa - 1 + 2 sin^2 a)        II   f_1 =   sin a (kappa + 1 + 2 cos^2 a)
 *        f_2 = sin a (kappa + 1 - 2 cos^2 a)             f_2 = - cos a (kappa - 1 - 2 sin^2 a)
 *
 * The force F: the stress is sigma_rr = - F cos (theta) / (pi r) alone; with nu' = (3 - kappa) / (1 + kappa)
 * and c = F / (pi E'), by integration of the strains,
 *
 *   u_r = - c (cos theta ln r + (1 - nu') / 2 theta sin theta)
 *   u_t =   c (sin theta ln r + (1 + nu') / 2 sin theta - (1 - nu') / 2 theta cos theta)
 *
 * whose gradient in polar components is c / r times (- cos, - sin; sin, nu' cos).
 *
 * In 3D the fields of plane strain, with the stress nu (s11 + s22) along the front, and mode III,
 *
 *   u_3 = (2 / mu) (r / 2 pi)^(1/2) sin (theta / 2),
 *   s_13, s_23 = (-sin, cos) (theta / 2) / (2 pi r)^(1/2). */
#include "front.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

double pg_tip_kappa (pg_mode mode, double nu)
{
    return mode == PG_PLANE_STRAIN ? 3 - 4 * nu : (3 - nu) / (1 + nu);
}

/* Angular part f (2) of a mode and its derivative with respect to theta (2). */
static void angular (int mode, double kappa, double theta, double *f, double *df)
{
    double s = sin (theta / 2), c = cos (theta / 2);
    if (mode == PG_TIP_OPENING) {
        f[0] = c * (kappa - 1 + 2 * s * s), f[1] = s * (kappa + 1 - 2 * c * c);
        df[0] = 0.5 * (-s * (kappa - 1 + 2 * s * s) + 4 * c * c * s);
        df[1] = 0.5 * (c * (kappa + 1 - 2 * c * c) + 4 * s * s * c);
    } else {
        f[0] = s * (kappa + 1 + 2 * c * c), f[1] = -c * (kappa - 1 - 2 * s * s);
        df[0] = 0.5 * (c * (kappa + 1 + 2 * c * c) - 4 * s * s * c);
        df[1] = 0.5 * (s * (kappa - 1 - 2 * s * s) + 4 * c * c * s);
    }
}

/* Singular fields of modes I and II. */
static void singular (int mode, double mu, double kappa, double r, double theta, double *u, double *H,
                      double *stress)
{
    double f[2], df[2], size = sqrt (r / (2 * pi)) / (2 * mu), s = sin (theta / 2), c = cos (theta / 2),
                        peak = 1 / sqrt (2 * pi * r);
    angular (mode, kappa, theta, f, df);
    for (int k = 0; k < 2; k++) {
        double radial = size * f[k] / (2 * r), around = size * df[k] / r;
        if (u) u[k] = size * f[k];
        if (H) H[2*k] = radial * cos (theta) - around * sin (theta);
        if (H) H[2*k + 1] = radial * sin (theta) + around * cos (theta);
    }
    if (!stress) return;
    double s3 = sin (1.5 * theta), c3 = cos (1.5 * theta);
    if (mode == PG_TIP_OPENING) {
        stress[0] = peak * c * (1 - s * s3), stress[1] = peak * c * (1 + s * s3);
        stress[2] = peak * s * c * c3;
    } else {
        stress[0] = -peak * s * (2 + c * c3), stress[1] = peak * s * c * c3;
        stress[2] = peak * c * (1 - s * s3);
    }
}

/* Field of the force on the tip; polar components are rotated into the frame. */
static void force_on_tip (double mu, double kappa, double r, double theta, double *u, double *H,
                          double *stress)
{
    double modulus = 8 * mu / (kappa + 1), nu = (3 - kappa) / (1 + kappa), c = 1 / (pi * modulus);
    double C = cos (theta), S = sin (theta), radial = -C / (pi * r);
    double R[2][2] = { { C, -S }, { S, C } },          /* columns: e_r, e_theta */
        G[2][2] = { { -c * C / r, -c * S / r }, { c * S / r, c * nu * C / r } };
    double polar[2] = { -c * (C * log (r) + (1 - nu) / 2 * theta * S),
                        c * (S * log (r) + (1 + nu) / 2 * S - (1 - nu) / 2 * theta * C) };
    for (int i = 0; u && i < 2; i++) u[i] = R[i][0] * polar[0] + R[i][1] * polar[1];
    for (int i = 0; H && i < 2; i++)
        for (int k = 0; k < 2; k++) {
            H[2*i + k] = 0;
            for (int a = 0; a < 2; a++)
                for (int b = 0; b < 2; b++) H[2*i + k] += R[i][a] * G[a][b] * R[k][b];
        }
    if (stress) stress[0] = radial * C * C, stress[1] = radial * S * S, stress[2] = radial * S * C;
}

void pg_tip_near_field (int mode, double mu, double kappa, double r, double theta, double *u, double *H,
                        double *stress)
{
    if (mode == PG_TIP_FORCE) force_on_tip (mu, kappa, r, theta, u, H, stress);
    else singular (mode, mu, kappa, r, theta, u, H, stress);
}

static void antiplane (const tip_material *m, double r, double theta, double *u, double *A, double *S)
{
    double peak = 1 / sqrt (2 * pi * r), s = -peak * sin (theta / 2), c = peak * cos (theta / 2);
    if (u) u[2] = 2 / m->mu * sqrt (r / (2 * pi)) * sin (theta / 2);
    if (A) A[6] = s / m->mu, A[7] = c / m->mu;
    if (S) S[2] = S[6] = s, S[5] = S[7] = c;
}

void front_near_field (int field, const tip_material *m, double r, double theta, double *u, double *A,
                       double *S)
{
    static const int plane[FRONT_FIELDS] = { PG_TIP_OPENING, PG_TIP_SLIDING, -1, PG_TIP_FORCE };
    double v[2], H[4], s[3], nu = 0.25 * (3 - m->kappa);
    if (u) memset (u, 0, 3 * sizeof *u);
    if (A) memset (A, 0, 9 * sizeof *A);
    if (S) memset (S, 0, 9 * sizeof *S);
    if (field == FRONT_III) {
        antiplane (m, r, theta, u, A, S);
        return;
    }
    pg_tip_near_field (plane[field], m->mu, m->kappa, r, theta, v, H, s);
    if (u) u[0] = v[0], u[1] = v[1];
    if (A) A[0] = H[0], A[1] = H[1], A[3] = H[2], A[4] = H[3];
    if (S) S[0] = s[0], S[4] = s[1], S[1] = S[3] = s[2], S[8] = nu * (s[0] + s[1]);
}
