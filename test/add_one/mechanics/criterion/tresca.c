/* SPDX-License-Identifier: GPL-3.0-or-later
 * A criterion with a limit of its own: a bond breaks when the largest shear stress, (sigma_1 - sigma_3) / 2
 * of the mean of its two ends, reaches the shear strength (Tresca 1864). */
#include "entries.h"
#include <math.h>
#include <stdio.h>

enum { STRENGTH };

static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    c->parameter[STRENGTH] = pg_criterion_limit (scene, setting, "shear_strength");
    return PG_OK;
}

static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    for (size_t b = 0; b < m->n; b++) {
        u[b] = 0.5 * (m->s1[b] - m->s3[b]) / c->parameter[STRENGTH];
        if (kind) kind[b] = 's';
    }
}

static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    utilisation (c, m, f, NULL);
    for (size_t b = 0; b < m->n; b++) f[b] = f[b] > 0 ? 1 / f[b] : INFINITY;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    snprintf (text, size, "largest shear stress >= %.6g Pa", c->parameter[STRENGTH]);
}

static const pg_key limit_keys[] = {
    { .path = "failure.shear_strength",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Largest shear stress that a bond bears." },
};
static const pg_key_table limits = { "criterion", limit_keys, 1 };

const pg_criterion_type pg_criterion_tresca = {
    .name = "tresca",
    .summary = "largest shear stress reaches the shear strength",
    .needs = PG_NEEDS_STRESS,
    .limits = { &limits },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .describe = describe,
};
