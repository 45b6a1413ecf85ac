/* SPDX-License-Identifier: GPL-3.0-or-later
 * All bonds of a point break for good when its stored energy density W reaches W_c = wc_factor G0 / horizon
 * (Jafarzadeh et al. 2022; theory B2). Utilisation sqrt (W / W_c): of degree 1 in the displacement, as those
 * of the other criteria. Where spacings differ, W_c is that of the point's own
 * horizon. */
#include "entries.h"
#include <math.h>
#include <stdio.h>

enum { LIMIT, ENERGY, FACTOR };

/* Reads the limit of the energy density, wc_factor G0 / horizon, J/m^3. */
static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    char map[PG_LIMITS];
    pg_criterion_by_theory (scene);
    c->parameter[ENERGY] = pg_criterion_limit (scene, setting, "fracture_energy");
    if (!(c->parameter[ENERGY] > 0)) return PG_OK;     /* it is missing, which has been reported */
    pg_criterion_holder (map, scene, setting, "wc_factor");
    c->parameter[FACTOR] = pg_scene_number (scene, "%s.wc_factor", map);
    c->parameter[LIMIT] = c->parameter[FACTOR] * c->parameter[ENERGY] / setting->horizon;
    if (!(c->parameter[LIMIT] > 0) || !isfinite (c->parameter[LIMIT]))
        pg_scene_fault (
            scene, "failure.criterion",
            "node_energy: fracture_energy %g J/m2, wc_factor %g and horizon %g m give no limit of energy",
            c->parameter[ENERGY], c->parameter[FACTOR], setting->horizon);
    return PG_OK;
}

/* sqrt (W / W_c) is of degree 1 in the displacement, as energy is of degree 2. */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    for (size_t i = 0; i < m->n; i++) {
        u[i] = m->energy[i] > 0 ? sqrt (m->energy[i] * (m->reach ? m->reach[i] : 1) / c->parameter[LIMIT])
                                : 0;
        if (kind) kind[i] = 'e';
    }
}

static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    utilisation (c, m, f, NULL);
    for (size_t i = 0; i < m->n; i++) f[i] = f[i] > 0 ? 1 / f[i] : INFINITY;
}

static void scale (pg_criterion *c, const pg_limit_ratio *ratio)
{
    c->parameter[ENERGY] *= ratio->of[PG_OF_ENERGY], c->parameter[LIMIT] *= ratio->of[PG_OF_ENERGY];
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    snprintf (text, size,
              "node energy >= %.6g J/m3 (%g G0 / horizon, fracture energy G0 = %.6g J/m2 given): the point "
              "dies with all its bonds",
              c->parameter[LIMIT], c->parameter[FACTOR], c->parameter[ENERGY]);
}

static const pg_key limit_keys[] = {
    { .path = "failure.wc_factor",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "0.5",
      .doc = "A point fails at the energy density wc_factor times fracture_energy / horizon." },
};
static const pg_key_table limits = { "criterion", limit_keys, 1 };

const pg_criterion_type pg_criterion_node_energy = {
    .name = "node_energy",
    .summary =
        "stored energy of a point reaches a share of fracture energy over horizon: all its bonds break",
    .needs = PG_NEEDS_ENERGY,
    .limits = { &criterion_keys_energy, &limits },
    .options = { &criterion_keys_calibration },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .describe = describe
};
