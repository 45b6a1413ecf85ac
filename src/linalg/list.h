/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per linear solver; included several times with different meanings of the macro. */
PG_LINEAR (cholmod)
PG_LINEAR (skyline)
PG_LINEAR (umfpack)
PG_LINEAR (pcg)
