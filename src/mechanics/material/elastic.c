/* SPDX-License-Identifier: GPL-3.0-or-later
 * Isotropic linear elasticity: stress = D strain; plane strain: sigma_zz = nu (sigma_xx + sigma_yy). Theory
 * section 0. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Number of stress components in this mode. */
static int size_of (pg_mode mode)
{
    return mode == PG_SOLID ? 6 : mode == PG_LINE ? 1 : 3;
}

/* D (1, 3 or 6 rows and columns, Pa): stress lambda tr (eps) 1 + 2 mu eps, engineering shears. In plane
 * stress lambda is 2 lambda mu / (lambda + 2 mu) = E nu / (1 - nu^2); a bar has E alone. */
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

/* Constants of state-based bonds (theory B6) from the bulk modulus kappa of d dimensions and the shear
 * modulus mu: dilation d kappa - (d + 2) mu, deviation d (d + 2) mu, Pa. With these a uniform strain has the
 * energy of E and nu. */
void pg_state_moduli (pg_mode mode, double E, double nu, double *dilation, double *deviation)
{
    double mu = E / (2 * (1 + nu)), lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), d = mode == PG_SOLID ? 3 : 2;
    double bulk = mode == PG_PLANE_STRESS   ? E / (2 * (1 - nu))
                  : mode == PG_PLANE_STRAIN ? lambda + mu
                                            : lambda + 2 * mu / 3;
    *dilation = mode == PG_LINE ? 0 : d * bulk - (d + 2) * mu;
    *deviation = mode == PG_LINE ? E : d * (d + 2) * mu;
}

/* Sets all constants that follow from E (Pa) and nu. Forces that allow only one Poisson's ratio call this
 * too. */
void pg_elastic_set (pg_material *m, double E, double nu)
{
    m->E = m->modulus = E, m->nu = nu, m->mu = E / (2 * (1 + nu));
    pg_elastic_tangent (m->mode, E, nu, m->D);
    if (m->mode == PG_PLANE_STRAIN || m->mode == PG_SOLID) m->lambda = E * nu / ((1 + nu) * (1 - 2 * nu));
    if (m->mode == PG_PLANE_STRAIN)
        m->out_of_plane[0] = m->out_of_plane[1] = E * nu / ((1 + nu) * (1 - 2 * nu));
}

/* Reads E and nu, whose ranges (of the keys) make D positive definite. */
static pg_status read (pg_material *m, const pg_scene *scene)
{
    char path[96];
    double E = pg_scene_number (scene, "materials.%s.youngs_modulus", m->name);
    snprintf (path, sizeof path, "materials.%s.youngs_modulus", m->name);
    if (isnan (E)) E = m->E;                           /* an expression: takes the reference value */
    if (isnan (E)) pg_scene_fault (scene, path, "must be one number here, no expression of place");
    pg_elastic_set (m, E, pg_scene_number (scene, "materials.%s.poissons_ratio", m->name));
    return PG_OK;
}

static void describe (const pg_material *m, char *text, size_t size)
{
    snprintf (text, size, "E %.6g Pa, nu %.6g", m->E, m->nu);
}

static const pg_key keys[] = {
    { .path = "materials.{}.youngs_modulus", .kind = PG_EXPRESSION, .unit = "Pa", .range = "(0, inf)",
      .doc = "Young's modulus E; may be an expression of place, also with random_field. Every point has the "
             "value of its place; between two points of unlike stiffness a bond without shape functions has "
             "the harmonic mean." },
    { .path = "materials.{}.poissons_ratio", .kind = PG_NUMBER, .unit = "1", .range = "(-1, 0.5)",
      .doc = "Poisson's ratio nu." },
};
const pg_key_table pg_keys_elastic = { "material", keys, sizeof keys / sizeof *keys };

const pg_material_type pg_material_elastic = {
    .name = "elastic",
    .summary = "isotropic, linear: Young's modulus and Poisson's ratio",
    .can = PG_MATERIAL_ISOTROPIC,
    .keys = { &pg_keys_elastic },
    .read = read,
    .stress = pg_tangent_stress,
    .describe = describe,
};
