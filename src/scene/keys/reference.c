/* SPDX-License-Identifier: GPL-3.0-or-later
 * The keys of the section `reference` of a scene (input file): what the result is measured against. A row has
 * path, kind, unit, default and the text of the documentation; ranges are not needed here. How the keys
 * depend on each other (which exclude each other, which need each other) is checked where the section is read
 * (app/compare). */
#include "perigal/scene.h"

#define ROW(path, kind, unit, fallback, doc) { path, kind, unit, NULL, fallback, NULL, NULL, NULL, doc }
static const pg_key keys[] = {
    ROW ("reference", PG_MAP, NULL, "",
         "What the result is measured against; run and compare print the norms of the difference."),
    ROW ("reference.displacement", PG_MAP, NULL, "",
         "Displacement in closed form; only the components given are compared."),
    ROW ("reference.displacement.x", PG_EXPRESSION, "m", "",
         "Component along x, in x, y, z, r, angle and t (static: load factor)."),
    ROW ("reference.displacement.y", PG_EXPRESSION, "m", "", "Component along y."),
    ROW ("reference.displacement.z", PG_EXPRESSION, "m", "", "Component along z."),
    ROW ("reference.stress", PG_MAP, NULL, "",
         "Stress in closed form; all components of the dimension are needed (2D: xx, yy, xy)."),
    ROW ("reference.stress.xx", PG_EXPRESSION, "Pa", "", "Component xx."),
    ROW ("reference.stress.yy", PG_EXPRESSION, "Pa", "", "Component yy."),
    ROW ("reference.stress.zz", PG_EXPRESSION, "Pa", "", "Component zz (3D)."),
    ROW ("reference.stress.xy", PG_EXPRESSION, "Pa", "", "Component xy."),
    ROW ("reference.stress.yz", PG_EXPRESSION, "Pa", "", "Component yz (3D)."),
    ROW ("reference.stress.zx", PG_EXPRESSION, "Pa", "", "Component zx (3D)."),
    { "reference.lines", PG_LIST, NULL, "[0, 100]", "", NULL, NULL, NULL, "Tables of places with values." },
    ROW ("reference.lines[].file", PG_FILE, NULL, NULL,
         "CSV beside the scene; first row: x [mm], y [mm], u_x [mm], s_xx [MPa] ...: coordinates and any of "
         "u_x u_y u_z s_xx s_yy s_zz s_xy s_yz s_zx."),
    ROW ("reference.lines[].unit", PG_TEXT, NULL, "",
         "Length unit of coordinates and displacements whose column names none; m if not given."),
    ROW ("reference.lines[].factor", PG_NUMBER, "1", "1",
         "Multiplies the values: for a table of another load than the scene's."),
    ROW ("reference.lines[].along", PG_MAP, NULL, "",
         "Coordinates that the table lacks, such as {y: 0}; 0 if not given."),
    ROW ("reference.lines[].along.x", PG_NUMBER, "m", "", "x of all rows."),
    ROW ("reference.lines[].along.y", PG_NUMBER, "m", "", "y of all rows."),
    ROW ("reference.lines[].along.z", PG_NUMBER, "m", "", "z of all rows."),
    ROW ("reference.lines[].datum", PG_VECTOR, "m", "",
         "The table's displacements are relative to that of this place, which is taken off the result's."),
    ROW ("reference.mesh", PG_MAP, NULL, "",
         "A finite element result of the same body: displacements, and stresses from their gradients and the "
         "scene's materials."),
    ROW ("reference.mesh.file", PG_FILE, NULL, NULL,
         "CalculiX .frd, or Exodus with elements, beside the scene."),
    ROW ("reference.mesh.unit", PG_TEXT, NULL, "", "Length unit of the file; m if not given."),
    ROW ("reference.mesh.step", PG_INTEGER, NULL, "", "Step of the file, from 0; the last if not given."),
    ROW ("reference.mesh.shift", PG_VECTOR, "m", "", "Added to the places of the file."),
    ROW ("reference.mesh.factor", PG_NUMBER, "1", "1", "Multiplies the displacements."),
    ROW ("reference.where", PG_EXPRESSION, "bool", "",
         "Only where this condition in x, y, z, r, angle holds, such as away from a point load."),
};
const pg_key_table pg_keys_reference = { "compare", keys, sizeof keys / sizeof *keys };
