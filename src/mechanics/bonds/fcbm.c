/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fast convolution-based method (Jafarzadeh et al. 2022; theory B): bond-based forces; unless the scene
 * says otherwise they are summed by FFT, and points lose all their bonds at a limit of energy. */
#include "pairwise.h"

/* The rule of bond-based forces, summed by transforms unless the scene says how. */
static void rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                  double spacing,
                  int lattice)
{
    bond_force_rule (out, scene, mode, approx, spacing, lattice);
    if (!pg_scene_given (scene, "method.evaluation")) out->evaluation = PG_EVALUATE_FFT;
}

const pg_force_type pg_force_fcbm = {
    .method = { .name = "fcbm",
                .summary = "bond, summed by FFT; points die by energy (Jafarzadeh 2022)",
                .keys = { &bond_force_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY | PG_NEEDS_FACETS,
                .tip_offset = bond_force_tip_offset,
                .judged_by = PG_NEEDS_ENERGY,
                .ghosts = 1,
                .rule = rule,
                .read = pairwise_read,
                .limits = bond_force_limits,
                BOND_FORCE_METHOD },
    .create = pairwise_create,
    BOND_FORCE_ENTRIES
};
