/* SPDX-License-Identifier: GPL-3.0-or-later
 * The fast convolution-based method (Jafarzadeh et al. 2022; theory B): the forces of bonds, whose sums are
 * by FFT and whose points die by energy unless the scene says otherwise. */
#include "bond.h"

static void rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                  double spacing,
                  int lattice)
{
    point_force_rule (out, scene, mode, approx, spacing, lattice);
    if (!pg_scene_given (scene, "method.evaluation")) out->evaluation = PG_EVALUATE_FFT;
}

const pg_force_type pg_force_fcbm = {
    .method = { .name = "fcbm",
                .summary = "bond, summed by FFT; points die by energy (Jafarzadeh 2022)",
                .keys = { &point_force_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY,
                .criterion = "node_energy",
                .rule = rule,
                .read = bond_read,
                .limits = point_force_limits,
                POINT_FORCE_METHOD },
    BOND_ENTRIES
};
