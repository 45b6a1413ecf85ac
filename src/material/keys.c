/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of materials.<name> that every model reads; those of one model stand in its file. */
#include "entries.h"

static const pg_key keys[] = {
    { .path = "materials.{}.model", .kind = PG_NAME, .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_material_names,
      .doc = "The law that gives stress from strain." },
    { .path = "materials.{}.density", .kind = PG_NUMBER, .unit = "kg/m3", .range = "(0, inf)", .fallback = "",
      .doc = "Mass density; needed by dynamic solvers and body forces such as weight." },
};

const pg_key_table pg_keys_material = { "material", keys, sizeof keys / sizeof *keys };
