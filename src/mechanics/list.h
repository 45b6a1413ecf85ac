/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per force: bonds/<name>.c or galerkin/<name>.c ends in `const pg_force_type pg_force_<name>`. */
PG_FORCE (galerkin)
PG_FORCE (bond)
PG_FORCE (fcbm)
PG_FORCE (lps)
PG_FORCE (gmpd)
