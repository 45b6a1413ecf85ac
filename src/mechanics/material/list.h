/* SPDX-License-Identifier: GPL-3.0-or-later
 * One line per material: src/mechanics/material/<name>.c ends in `const pg_material_type
 * pg_material_<name>`. */
PG_MATERIAL (elastic)
PG_MATERIAL (orthotropic)
