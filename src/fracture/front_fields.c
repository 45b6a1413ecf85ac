/* SPDX-License-Identifier: GPL-3.0-or-later
 * Exact fields of a straight front: those of the plane (williams.c) in plane strain, with the stress nu (s11
 * + s22) along the front, and mode III,
 *
 *   u_3 = (2 / mu) (r / 2 pi)^(1/2) sin (theta / 2),
 *   s_13, s_23 = (-sin, cos) (theta / 2) / (2 pi r)^(1/2). */
#include "front.h"
#include <math.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

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
