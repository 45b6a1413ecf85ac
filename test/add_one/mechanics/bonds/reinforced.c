/* SPDX-License-Identifier: GPL-3.0-or-later
 * A force that the catalogue does not hold: the pair forces of `bond`, stiffer by a factor that the scene
 * gives, and for one material only. */
#include "pairwise.h"

static const pg_key keys[] = {
    { .path = "method.reinforcement", .kind = PG_NUMBER, .unit = "1", .range = "[1, inf)",
      .doc = "How much stiffer bonds are than those of the material alone." },
};
static const pg_key_table own_keys = { "force", keys, sizeof keys / sizeof *keys };

static pg_status read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    if (p->nmaterial > 1) pg_scene_fault (scene, "materials", "force: reinforced knows one material");
    PG_TRY (pairwise_read (p, scene));
    p->sums->calibration *= pg_scene_number (scene, "method.reinforcement");
done:
    return status;
}

const pg_force_type pg_force_reinforced = {
    .method = { .name = "reinforced",
                .summary = "bond, stiffer by a factor",
                .keys = { &bond_force_keys, &own_keys },
                .shows = PG_NEEDS_STRETCH,
                .rule = bond_force_rule,
                .read = read,
                .limits = bond_force_limits,
                BOND_FORCE_METHOD },
    .create = pairwise_create,
    BOND_FORCE_ENTRIES
};
