/* SPDX-License-Identifier: GPL-3.0-or-later
 * Drucker-Prager with tension cut-off on the mean of both ends (Drucker, Prager 1952), its cone through the
 * compressive edges of Mohr-Coulomb: (sqrt J2 + a I1) / k, a = 2 sin phi / q, k = 6 c cos phi / q,
 * q = sqrt 3 (3 - sin phi). Without friction: von Mises at the equivalent stress 2 c. */
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

/* The larger of tension over tensile strength and the invariants over the cone; both are of degree 1 in the
 * stress, and convex. */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    double sine = sin (c->parameter[ANGLE]), over = sqrt (3) * (3 - sine), a = 2 * sine / over,
           k = 6 * c->parameter[COHESION] * cos (c->parameter[ANGLE]) / over;
    for (size_t b = 0; b < m->n; b++) {
        double s1 = m->s1[b], s2 = m->s2[b], s3 = m->s3[b],
               J2 = ((s1 - s2) * (s1 - s2) + (s2 - s3) * (s2 - s3) + (s3 - s1) * (s3 - s1)) / 6,
               tension = s1 / c->parameter[STRENGTH], shear = (sqrt (J2) + a * (s1 + s2 + s3)) / k,
               most = tension >= shear ? tension : shear;
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

static void describe (const pg_criterion *c, char *text, size_t size)
{
    double phi = c->parameter[ANGLE], strength = 2 * c->parameter[COHESION] * cos (phi) / (1 - sin (phi));
    snprintf (text, size,
              "Drucker-Prager: tensile strength %.6g Pa, cohesion %.6g Pa, friction angle %.6g deg (uniaxial "
              "compressive strength %.6g Pa)",
              c->parameter[STRENGTH], c->parameter[COHESION], phi * 57.295779513082320877, strength);
}

const pg_criterion_type pg_criterion_drucker_prager = {
    .name = "drucker_prager",
    .summary = "cone of Drucker-Prager (von Mises without friction) with a tension cut-off",
    .needs = PG_NEEDS_STRESS,
    .limits = { &criterion_keys_tension, &criterion_keys_shear },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .describe = describe
};
