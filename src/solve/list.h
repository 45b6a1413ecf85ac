/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per solver: its file, here or in a folder below, ends in `const pg_solver_type pg_solver_<name>`.
 * The entry of `static` is named static_, as static is a keyword of C. */
PG_SOLVER (static_)
PG_SOLVER (newmark)
PG_SOLVER (verlet)
PG_SOLVER (central)
PG_SOLVER (adr)
PG_SOLVER (relax)
