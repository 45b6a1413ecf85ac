/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per criterion: src/mechanics/criterion/<name>.c ends in `const pg_criterion_type
 * pg_criterion_<name>`. */
PG_CRITERION (stretch)
PG_CRITERION (principal_stress)
PG_CRITERION (mohr_coulomb)
PG_CRITERION (drucker_prager)
PG_CRITERION (node_energy)
PG_CRITERION (beam_limits)
PG_CRITERION (energy_release)
