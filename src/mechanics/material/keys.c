/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of materials.<name> that every model reads; keys of one model are in its own file. */
#include "entries.h"

static const pg_key keys[] = {
    { .path = "materials", .kind = PG_MAP, .range = "[0, 1000]", .fallback = "",
      .doc = "Materials by names of your own. With one material it is that of the whole body; with several "
             "blocks say which is where." },
    { .path = "materials.{}.model", .kind = PG_NAME, .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_material_names,
      .doc = "The law that gives stress from strain." },
    { .path = "materials.{}.density", .kind = PG_NUMBER, .unit = "kg/m3", .range = "(0, inf)", .fallback = "",
      .doc = "Mass density; needed by dynamic solvers and body forces such as weight." },
    { .path = "materials.{}.expansion", .kind = PG_NUMBER, .unit = "1/K", .fallback = "",
      .doc = "Coefficient of linear thermal expansion, for boundary[].temperature." },
    { .path = "materials.{}.biot", .kind = PG_NUMBER, .unit = "1", .range = "[0, 1]", .fallback = "1",
      .doc = "Biot's coefficient, for boundary[].pore_pressure." },
};

const pg_key_table pg_keys_material = { "material", keys, sizeof keys / sizeof *keys };
