/* SPDX-License-Identifier: GPL-3.0-or-later
 * Mohr-Coulomb with tension cut-off on the mean of both ends (Cui 2022 section 1.1, theory F2). Utilisations,
 * both of degree 1: tension sigma_1 / T; shear ((sigma_1 - sigma_3)/2 + (sigma_1 + sigma_3)/2 sin phi) / (c
 * cos phi). */
#include "entries.h"
#include <math.h>
#include <stdio.h>

enum { STRENGTH, COHESION, ANGLE };

static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    c->parameter[STRENGTH] = pg_criterion_limit (scene, setting, "tensile_strength");
    c->parameter[COHESION] = pg_criterion_limit (scene, setting, "cohesion");
    c->parameter[ANGLE] = pg_criterion_limit (scene, setting, "friction_angle");
    return PG_OK;
}

/* Sine of the friction angle phi, and c cos phi, the shear strength of the cohesion, Pa. */
static void friction (const pg_criterion *c, double *sine, double *bound)
{
    *sine = sin (c->parameter[ANGLE]), *bound = c->parameter[COHESION] * cos (c->parameter[ANGLE]);
}

/* The larger of two utilisations: tension over the tensile strength, and shear stress on the critical plane
 * over the strength by cohesion and friction. A negative one (compression in all directions) becomes 0. */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    double sine, bound;
    friction (c, &sine, &bound);
    for (size_t b = 0; b < m->n; b++) {
        double tension = m->s1[b] / c->parameter[STRENGTH];
        double shear = ((m->s1[b] - m->s3[b]) / 2 + (m->s1[b] + m->s3[b]) / 2 * sine) / bound;
        double most = tension >= shear ? tension : shear;
        u[b] = most > 0 ? most : 0;
        if (kind) kind[b] = tension >= shear ? 't' : 's';
    }
}

/* The load factor is 1 / utilisation, which is of degree 1 in the stress. */
static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    utilisation (c, m, f, NULL);
    for (size_t b = 0; b < m->n; b++) f[b] = f[b] > 0 ? 1 / f[b] : INFINITY;
}

static void scale (pg_criterion *c, const pg_limit_ratio *ratio)
{
    c->parameter[STRENGTH] *= ratio->of[PG_OF_TENSION];
    c->parameter[COHESION] *= ratio->of[PG_OF_COHESION];
}

/* Coefficients of s1 and s3 in the two utilisations, tension and shear, 1/Pa. */
static int planes (const pg_criterion *c, double form[2][2])
{
    double sine, bound;
    friction (c, &sine, &bound);
    form[0][0] = 1 / c->parameter[STRENGTH], form[0][1] = 0;
    form[1][0] = (1 + sine) / (2 * bound), form[1][1] = (sine - 1) / (2 * bound);
    return 2;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    double phi = c->parameter[ANGLE], strength = 2 * c->parameter[COHESION] * cos (phi) / (1 - sin (phi));
    snprintf (text, size, "Mohr-Coulomb: tensile strength %.6g Pa, cohesion %.6g Pa, friction angle %.6g deg"
              " (uniaxial compressive strength %.6g Pa)", c->parameter[STRENGTH], c->parameter[COHESION],
              phi * 57.295779513082320877, strength);
}

const pg_criterion_type pg_criterion_mohr_coulomb = {
    .name = "mohr_coulomb",
    .summary = "shear strength of Mohr-Coulomb with a tension cut-off",
    .needs = PG_NEEDS_STRESS,
    .limits = { &criterion_keys_tension, &criterion_keys_shear },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .planes = planes,
    .describe = describe
};
