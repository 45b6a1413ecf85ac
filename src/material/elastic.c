/* SPDX-License-Identifier: GPL-3.0-or-later
 * Isotropic linear elasticity: stress = D strain; plane strain: sigma_zz = nu (sigma_xx + sigma_yy). Theory
 * section 0. */
#include "entries.h"
#include <string.h>

enum { E_YOUNG, POISSON };

static int size_of (pg_mode mode)
{
    return mode == PG_SOLID ? 6 : mode == PG_LINE ? 1 : 3;
}

void pg_elastic_tangent (pg_mode mode, double E, double nu, double *D)
{
    int nv = size_of (mode), nn = nv == 6 ? 3 : nv == 3 ? 2 : 1;       /* components, normal ones */
    double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    if (mode == PG_PLANE_STRESS) lambda = E * nu / ((1 - nu) * (1 + nu));
    memset (D, 0, (size_t) (nv * nv) * sizeof *D);
    for (int a = 0; a < nn; a++)
        for (int b = 0; b < nn; b++) D[a*nv + b] = lambda + (a == b ? 2 * mu : 0);
    for (int a = nn; a < nv; a++) D[a*nv + a] = mu;
    if (mode == PG_LINE) D[0] = E;
}

void pg_state_moduli (pg_mode mode, double E, double nu, double *dilation, double *deviation)
{
    double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), d = mode == PG_SOLID ? 3 : 2;
    double bulk = mode == PG_PLANE_STRESS   ? E / (2 * (1 - nu))
                  : mode == PG_PLANE_STRAIN ? lambda + mu
                                            : lambda + 2 * mu / 3;
    *dilation = mode == PG_LINE ? 0 : d * bulk - (d + 2) * mu;
    *deviation = mode == PG_LINE ? E : d * (d + 2) * mu;
}

static pg_status read (pg_material *m, const pg_scene *scene)
{
    double E = pg_scene_number (scene, "materials.%s.youngs_modulus", m->name);
    double nu = pg_scene_number (scene, "materials.%s.poissons_ratio", m->name);
    m->parameter[E_YOUNG] = m->modulus = E;
    m->parameter[POISSON] = nu;
    pg_elastic_tangent (m->mode, E, nu, m->D);
    if (m->mode == PG_PLANE_STRAIN || m->mode == PG_SOLID) m->lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    if (m->mode == PG_PLANE_STRAIN)
        m->out_of_plane[0] = m->out_of_plane[1] = E * nu / ((1 + nu) * (1 - 2 * nu));
    return PG_OK;
}

static void stress (const pg_material *m, size_t n, const double *strain, double *stress_out, double *zz)
{
    int nv = size_of (m->mode);
    for (size_t i = 0; i < n; i++) {
        const double *e = strain + i * (size_t) nv;
        double *s = stress_out + i * (size_t) nv, normal = 0;
        for (int a = 0; a < nv; a++) {
            double sum = 0;
            for (int b = 0; b < nv; b++) sum += m->D[a*nv + b] * e[b];
            s[a] = sum;
        }
        for (int b = 0; b < nv; b++) normal += m->out_of_plane[b] * e[b];
        if (zz) zz[i] = normal;
    }
}

const pg_material_type pg_material_elastic = {
    .name = "elastic",
    .summary = "isotropic, linear: Young's modulus and Poisson's ratio",
    .keys = "youngs_modulus poissons_ratio",
    .isotropic = 1,
    .read = read,
    .stress = stress
};
