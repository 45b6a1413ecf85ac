/* SPDX-License-Identifier: GPL-3.0-or-later
 * Common to all linear elastic materials: stress = D strain, and the rotation of a stiffness from the axes of
 * a material to those of the scene. */
#include "perigal/material.h"

void pg_tangent_stress (const pg_material *m, size_t n, const double *strain, double *stress, double *zz)
{
    int nv = m->mode == PG_SOLID ? 6 : m->mode == PG_LINE ? 1 : 3;
    for (size_t i = 0; i < n; i++) {
        const double *e = strain + i * (size_t) nv;
        double *s = stress + i * (size_t) nv, normal = 0;
        for (int a = 0; a < nv; a++) {
            double sum = 0;
            for (int b = 0; b < nv; b++) sum += m->D[a * nv + b] * e[b];
            s[a] = sum;
        }
        for (int b = 0; b < nv; b++) normal += m->out_of_plane[b] * e[b];
        if (zz) zz[i] = normal;
    }
}

/* Makes T, which gives strains in the axes of the material as T times strains in the axes of the scene
 * (Voigt, engineering shears): with e' = R e R' component by component,
 *   e'_ij = sum_kl R_ik R_jl e_kl,  gamma_ij = 2 e_ij. */
static void strain_rotation (const double R[9], double T[36])
{
    static const int pair[6][2] = { { 0, 0 }, { 1, 1 }, { 2, 2 }, { 0, 1 }, { 1, 2 }, { 2, 0 } };
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            int i = pair[a][0], j = pair[a][1], k = pair[b][0], l = pair[b][1];
            double here = k == l ? R[3 * i + k] * R[3 * j + k]
                                 : 0.5 * (R[3 * i + k] * R[3 * j + l] + R[3 * i + l] * R[3 * j + k]);
            T[6 * a + b] = i == j ? here : 2 * here;
        }
}

/* D = T' C T, as the energy of a strain is the same in the axes of the material and of the scene. */
void pg_rotate_stiffness (const double R[9], const double C[36], double D[36])
{
    double T[36], CT[36];
    strain_rotation (R, T);
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            CT[6 * a + b] = 0;
            for (int k = 0; k < 6; k++) CT[6 * a + b] += C[6 * a + k] * T[6 * k + b];
        }
    for (int a = 0; a < 6; a++)
        for (int b = 0; b < 6; b++) {
            D[6 * a + b] = 0;
            for (int k = 0; k < 6; k++) D[6 * a + b] += T[6 * k + a] * CT[6 * k + b];
        }
}
