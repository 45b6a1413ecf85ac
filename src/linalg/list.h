/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per linear solver: src/linalg/<name>.c ends in `const pg_linear_type pg_linear_<name>`. */
PG_LINEAR (cholmod)
PG_LINEAR (skyline)
PG_LINEAR (umfpack)
PG_LINEAR (pcg)
