/* SPDX-License-Identifier: GPL-3.0-or-later
 * A bond breaks when sigma_1, the mean of its two ends, reaches the tensile strength T (Cui 2022 section
 * 1.1). */
#include "entries.h"
#include <math.h>
#include <stdio.h>

enum { STRENGTH };

static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    c->parameter[STRENGTH] = pg_criterion_limit (scene, setting, "tensile_strength");
    return PG_OK;
}

/* Compression never breaks a bond here. */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    for (size_t b = 0; b < m->n; b++) {
        u[b] = m->s1[b] > 0 ? m->s1[b] / c->parameter[STRENGTH] : 0;
        if (kind) kind[b] = 't';
    }
}

/* The stress is linear in the load factor. */
static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    for (size_t b = 0; b < m->n; b++) f[b] = m->s1[b] > 0 ? c->parameter[STRENGTH] / m->s1[b] : INFINITY;
}

static void scale (pg_criterion *c, const pg_limit_ratio *ratio)
{
    c->parameter[STRENGTH] *= ratio->of[PG_OF_TENSION];
}

static int planes (const pg_criterion *c, double form[2][2])
{
    form[0][0] = 1 / c->parameter[STRENGTH], form[0][1] = 0;
    return 1;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    snprintf (text, size, "principal stress >= %.6g Pa (mean of both ends)", c->parameter[STRENGTH]);
}

const pg_criterion_type pg_criterion_principal_stress = {
    .name = "principal_stress",
    .summary = "largest principal stress reaches the tensile strength",
    .needs = PG_NEEDS_STRESS,
    .limits = { &criterion_keys_tension },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .planes = planes,
    .describe = describe
};
