/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bond-based peridynamics as an entry of the catalogue. */
#include "pairwise.h"

const pg_force_type pg_force_bond = {
    .method = { .name = "bond",
                .summary = "bond-based peridynamics: pair forces between points, Poisson's ratio 1/3 in "
                           "plane stress, 1/4 in plane strain and 3D (Silling 2000)",
                .keys = { &bond_force_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY | PG_NEEDS_FACETS,
                .tip_offset = bond_force_tip_offset,
                .rule = bond_force_rule,
                .read = pairwise_read,
                .limits = bond_force_limits,
                .ghosts = 1,
                BOND_FORCE_METHOD },
    .create = pairwise_create,
    BOND_FORCE_ENTRIES
};
