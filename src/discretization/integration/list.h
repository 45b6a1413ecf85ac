/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per entry of the catalogue; included several times with different meanings of the macro. */
PG_INTEGRATION (gauss)
PG_INTEGRATION (nodal)
PG_INTEGRATION (consistent)
