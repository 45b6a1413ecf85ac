/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per integration. */
PG_INTEGRATION (nodal)
PG_INTEGRATION (gauss)
PG_INTEGRATION (consistent)
