/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per force. */
PG_FORCE (galerkin)
PG_FORCE (bond)
PG_FORCE (fcbm)
PG_FORCE (lps)
PG_FORCE (gmpd)
