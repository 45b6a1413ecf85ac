/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per approximation: src/discretization/approx/<name>.c ends in `const pg_approx_type
 * pg_approx_<name>`. */
PG_APPROX (rkpm)
PG_APPROX (pddo)
PG_APPROX (nosb)
