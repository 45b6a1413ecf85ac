/* SPDX-License-Identifier: GPL-3.0-or-later
 * plate.h: a small set of keys with every shape the tables know, so that these tests need no other folder. */
#ifndef PERIGAL_TEST_PLATE_H
#define PERIGAL_TEST_PLATE_H
#include "check.h"
#include "scene/document.h"

static const pg_key plate_keys[] = {
    { .path = "title", .kind = PG_TEXT, .fallback = "", .doc = "A title." },
    { .path = "dimension", .kind = PG_NAME, .choices = "1|2|3", .doc = "Number of space dimensions." },
    { .path = "spacing", .kind = PG_NUMBER, .unit = "m", .range = "(0, inf)", .doc = "Distance of points." },
    { .path = "cracks", .kind = PG_LIST, .fallback = "", .doc = "Cracks." },
    { .path = "cracks[].from", .kind = PG_VECTOR, .unit = "m", .doc = "First end." },
    { .path = "cracks[].width",
      .kind = PG_NUMBER,
      .unit = "m",
      .range = "[0, inf)",
      .fallback = "0.5 mm",
      .doc = "Width." },
    { .path = "materials", .kind = PG_MAP, .doc = "Materials by name." },
    { .path = "materials.{}.youngs_modulus",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .doc = "Young's modulus." },
    { .path = "materials.{}.poissons_ratio",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "[0, 0.5)",
      .fallback = "0.25",
      .doc = "Poisson's ratio." },
    { .path = "materials.{}.density", .kind = PG_NUMBER, .unit = "kg/m3", .fallback = "", .doc = "Density." },
    { .path = "failure.critical_stretch",
      .kind = PG_NUMBER,
      .unit = "1",
      .group = "strength:one",
      .fallback = "",
      .doc = "Stretch." },
    { .path = "failure.fracture_energy",
      .kind = PG_NUMBER,
      .unit = "J/m2",
      .group = "strength:one",
      .fallback = "",
      .doc = "Energy." },
    { .path = "failure.exclude", .kind = PG_NAMES, .fallback = "", .doc = "Sets that never fail." },
    { .path = "method.kernel",
      .kind = PG_NAME,
      .choices = "constant|quadratic|gaussian",
      .fallback = "quadratic",
      .doc = "Kernel." },
    { .path = "method.horizon",
      .kind = PG_NUMBER,
      .unit = "m|spacing",
      .range = "(0, inf)",
      .fallback = "2 spacing",
      .doc = "Horizon." },
    { .path = "method.check", .kind = PG_BOOL, .fallback = "off", .doc = "Checks." },
    { .path = "method.levels", .kind = PG_INTEGER, .range = "[1, 100]", .fallback = "10", .doc = "Levels." },
    { .path = "sets.{}.where",
      .kind = PG_EXPRESSION,
      .unit = "bool",
      .group = "place:most",
      .fallback = "",
      .doc = "Condition." },
    { .path = "sets.{}.side",
      .kind = PG_NAME,
      .choices = "left|right",
      .group = "place:most",
      .fallback = "",
      .doc = "Side." },
    { .path = "sets.{}.angle", .kind = PG_LIST, .fallback = "", .doc = "Ranges." },
    { .path = "sets.{}.angle[]", .kind = PG_NUMBERS, .unit = "rad", .doc = "From, to." },
    { .path = "load.pressure", .kind = PG_EXPRESSION, .unit = "Pa", .fallback = "0 Pa", .doc = "Pressure." },
    { .path = "load.direction",
      .kind = PG_VECTOR,
      .unit = "1",
      .fallback = "[0, 1, 0]",
      .doc = "Direction." },
    { .path = "load.friction_angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .range = "[0, pi/2)",
      .fallback = "40 deg",
      .doc = "Angle." },
    { .path = "output.fields",
      .kind = PG_NAMES,
      .choices = "displacement|damage|stress",
      .fallback = "[displacement, damage]",
      .doc = "Fields." },
};
static const pg_key_table plate_table = { "plate", plate_keys, sizeof plate_keys / sizeof *plate_keys };
static const pg_vocabulary plate_words = { .n = 1, .table = &plate_table };

#define PLATE_HEAD "dimension: 2\nspacing: 2 mm\nmaterials: {rock: {youngs_modulus: 10 GPa}}\n"

static inline pg_status plate_read_with (pg_scene **s, const char *text, size_t nset, const char *const *set)
{
    return pg_scene_read (s, text, strlen (text), "plate.yaml", nset, set, &plate_words, 0);
}

static inline pg_status plate_read (pg_scene **s, const char *text)
{
    return plate_read_with (s, text, 0, NULL);
}
#endif
