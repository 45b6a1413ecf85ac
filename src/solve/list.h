/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per solver: its file, here or in a folder below, ends in `const pg_solver_type pg_solver_<name>`.
 * `static` is a word of C: its entry is named static_. */
PG_SOLVER (static_)
PG_SOLVER (newmark)
PG_SOLVER (verlet)
PG_SOLVER (central)
PG_SOLVER (adr)
PG_SOLVER (relax)
