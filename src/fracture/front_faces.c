/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fronts whose faces touch behind them. As with tips in the plane (tip_measure.c) the uniform stress that the
 * faces carry is subtracted: sigma_22 = -p, sigma_12 and sigma_23 in the frame of the front, all others zero.
 * What is left has free faces, so that its K_II and K_III are those of the front, and K_I is zero. */
#include "front.h"
#include <math.h>

/* The vertices before and behind u. */
static void beside (const pg_front *f, double u, size_t *i, size_t *j)
{
    *i = (size_t) floor (u) % f->n;
    *j = f->closed ? (*i + 1) % f->n : *i + 1 < f->n ? *i + 1 : *i;
}

int front_faces_at (const pg_front *f, const pg_front_faces *faces, int field, double u, const double *frame,
                    double stress[3])
{
    size_t i, j;
    if (!faces) return 0;
    beside (f, u, &i, &j);
    const pg_front_faces *a = &faces[i], *b = &faces[j];
    double share = u - floor (u), along = 0, across = 0;
    if (!a->closed || !b->closed) return 0;
    for (int k = 0; k < 3; k++) {
        double shear = (1 - share) * a->shear[field][k] + share * b->shear[field][k];
        along += frame[k] * shear, across += frame[6 + k] * shear;
    }
    /* forces on the face that the normal shows to are those of the stress behind it, turned round */
    stress[0] = -((1 - share) * a->pressure[field] + share * b->pressure[field]);
    stress[1] = -along, stress[2] = -across;
    return 1;
}

void front_faces_part (front_sample *field, size_t k, const tip_material *m, const double stress[3])
{
    double nu = 0.25 * (3 - m->kappa), E = 2 * m->mu * (1 + nu), *H = field->H + 9*k, *S = field->S + 9*k;
    H[0] += nu * stress[0] / E, H[8] += nu * stress[0] / E, H[4] -= stress[0] / E;
    S[4] -= stress[0];
    for (int a = 0; a < 2; a++) {                      /* 1 2, then 2 3 */
        size_t one = a ? 5 : 1, other = a ? 7 : 3;
        H[one] -= stress[1 + a] / (2 * m->mu), H[other] -= stress[1 + a] / (2 * m->mu);
        S[one] -= stress[1 + a], S[other] -= stress[1 + a];
    }
}

double front_faces_clear (const pg_front *f, const pg_front_faces *faces, double u)
{
    size_t i, j;
    double nearest = INFINITY;
    beside (f, u, &i, &j);
    if (!faces[i].closed) nearest = fmin (nearest, faces[i].nearest);
    if (!faces[j].closed) nearest = fmin (nearest, faces[j].nearest);
    return nearest;
}

void front_faces_close (const pg_front *f, const pg_front_faces *faces, int nfield, pg_tip_field *vertex)
{
    for (size_t i = 0; i < f->n; i++) {
        pg_tip_field *v = &vertex[i];
        const double *II = v->K_wide[1], *III = v->K_wide[2];
        if (!faces[i].closed || isnan (v->near)) continue;
        v->closed = 1;
        for (int a = 0; a < nfield; a++) {
            v->K[0][a] = v->K_wide[0][a] = 0, v->T[a] = NAN;
            for (int b = 0; b < nfield; b++) {
                v->J[a][b] = (II[a] * II[b] + v->antiplane * III[a] * III[b]) / v->modulus;
                v->J_near[a][b] = NAN;                 /* one tube, nothing to compare it with */
            }
        }
    }
}
