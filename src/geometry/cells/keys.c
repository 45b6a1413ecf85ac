/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of cells and of named sets of points and boundary facets. */
#include "perigal/cells.h"

/* Each row is one key of the input file: path, kind, unit, default, choices and the text of `perigal
 * help`. */
static const pg_key keys[] = {
    { .path = "cells",
      .kind = PG_NAME,
      .fallback = "cut",
      .choices = "cut|staircase",
      .doc = "Cells of the lattice that the surface of the body crosses are cut along it (exact volume, "
             "true normals), or belong to the body entirely or not at all, by their centre." },
    { .path = "sets",
      .kind = PG_MAP,
      .range = "[0, 1000]",
      .fallback = "",
      .doc = "Named parts of the body. Always there: left, right, bottom, top, back, front (what of the "
             "surface lies in the planes of the bounding box: nothing of a disk; "
             "of a file of points: those within half their spacing) and all (every point); SHAPE.PART (see "
             "boundary); NAME.top, NAME.left, ... is the half of a set on that side of the centre." },
    { .path = "sets.{}",
      .kind = PG_MAP,
      .fallback = "",
      .doc = "One set, under a name of your choice: what meets all the conditions given." },
    { .path = "sets.{}.boundary",
      .kind = PG_NAMES,
      .fallback = "",
      .doc = "On the boundary: left, right, bottom, top, back, front, all (the whole boundary), "
             "the surface of a shape: rim, side (of a cylinder: its flat ends), hole, or its name, or a part "
             "of that, SHAPE.PART with its name or what it is: disk.rim, cylinder.rim, "
             "start, end, box.left ... front, polygon.edge 1 (from its first vertex to the second), "
             "prism.edge 1, back, front." },
    { .path = "sets.{}.angle",
      .kind = PG_LIST,
      .fallback = "",
      .doc = "Within one of these ranges of the angle in the xy plane about the centre of the body; "
             "with cells: cut the boundary is parted at their ends." },
    { .path = "sets.{}.angle[]",
      .kind = PG_NUMBERS,
      .unit = "rad",
      .fallback = "",
      .doc = "One range [from, to], counted counter-clockwise from the x axis." },
    { .path = "sets.{}.where",
      .kind = PG_EXPRESSION,
      .unit = "bool",
      .fallback = "",
      .doc = "Where this condition in x, y, z, r, angle holds." },
};
const pg_key_table pg_keys_cells = { "cells", keys, sizeof keys / sizeof *keys };
