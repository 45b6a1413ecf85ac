/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of the input file as a whole: title, dimension, and what 1D and 2D bodies need beyond their geometry:
 * thickness, cross section, plane stress or strain.
 * */
#include "perigal/scene.h"

/* Each row is one key of the input file: path, kind, unit, range, default, choices and the text of `perigal
 * help`. */
static const pg_key keys[] = {
    { .path = "title",
      .kind = PG_TEXT,
      .fallback = "",
      .doc = "Title of the scene; printed in reports." },
    { .path = "dimension", .kind = PG_NAME, .choices = "1|2|3", .doc = "Number of space dimensions." },
    { .path = "plane",
      .kind = PG_NAME,
      .choices = "stress|strain",
      .fallback = "stress",
      .doc = "Plane stress (a thin plate) or plane strain (a slice of a long body)." },
    { .path = "thickness",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = "(0, inf)",
      .fallback = "1 m",
      .doc = "Thickness of a two-dimensional body." },
    { .path = "cross_section",
      .kind = PG_NUMBER,
      .unit = "m2",
      .range = "(0, inf)",
      .fallback = "1 m2",
      .doc = "Area of the cross section of a one-dimensional bar." },
};
const pg_key_table pg_keys_scene = { "scene", keys, sizeof keys / sizeof *keys };
