/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per linear solver. */
PG_LINEAR (cholmod)
PG_LINEAR (umfpack)
PG_LINEAR (pcg)
