/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of materials.<name>. */
#include "perigal/material.h"

static const pg_key keys[] = {
    { .path = "materials.{}.model", .kind = PG_NAME, .fallback = "elastic", .choices_of = pg_material_names,
      .doc = "The law that gives stress from strain." },
    { .path = "materials.{}.youngs_modulus", .kind = PG_NUMBER, .unit = "Pa", .range = "(0, inf)",
      .doc = "Young's modulus E." },
    { .path = "materials.{}.poissons_ratio", .kind = PG_NUMBER, .unit = "1", .range = "(-1, 0.5)",
      .doc = "Poisson's ratio nu." },
    { .path = "materials.{}.density", .kind = PG_NUMBER, .unit = "kg/m3", .range = "(0, inf)", .fallback = "",
      .doc = "Mass density; needed by dynamic solvers and body forces such as weight." },
};

const pg_key_table pg_keys_material = { "material", keys, sizeof keys / sizeof *keys };
