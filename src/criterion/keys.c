/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of failure, and which of them a criterion needs or would ignore. */
#include "entries.h"
#include <stdio.h>
#include <string.h>

static const char choices[] =
#define PG_CRITERION(name) #name "|"
#include "list.h"
#undef PG_CRITERION
    "none";

static const char *names_or_none (void) { return choices; }

static const pg_key keys[] = {
    { .path = "failure.criterion", .kind = PG_NAME, .choices_of = names_or_none,
      .doc = "When a bond breaks; without `failure`, and with none, nothing breaks." },
    { .path = "failure.critical_stretch", .kind = PG_NUMBER, .unit = "1", .range = "(0, inf)", .fallback = "", .group = "limit:most",
      .doc = "stretch: relative elongation at which a bond breaks; either this or fracture_energy." },
    { .path = "failure.fracture_energy", .kind = PG_NUMBER, .unit = "J/m2", .range = "(0, inf)", .fallback = "", .group = "limit:most",
      .doc = "stretch: energy per new crack area, from which the critical stretch follows (with horizon, kernel and Young's modulus)." },
    { .path = "failure.stretch", .kind = PG_NAME, .fallback = "linear", .choices = "linear|finite",
      .doc = "stretch: measured along the undeformed bond (small displacements), or from the deformed length." },
    { .path = "failure.tensile_strength", .kind = PG_NUMBER, .unit = "Pa", .range = "(0, inf)", .fallback = "",
      .doc = "principal_stress, mohr_coulomb: largest principal stress that a bond bears." },
    { .path = "failure.cohesion", .kind = PG_NUMBER, .unit = "Pa", .range = "(0, inf)", .fallback = "",
      .doc = "mohr_coulomb: shear strength without normal stress." },
    { .path = "failure.friction_angle", .kind = PG_NUMBER, .unit = "rad", .range = "[0, 1.5707)", .fallback = "",
      .doc = "mohr_coulomb: angle of internal friction, below 90 deg." },
    { .path = "failure.exclude", .kind = PG_NAMES, .fallback = "", .choices = "sets.{}|left|right|bottom|top|back|front|all",
      .doc = "Sets of nodes whose bonds never break, such as grips." },
};

const pg_key_table pg_keys_criterion = { "criterion", keys, sizeof keys / sizeof *keys };

static int in (const char *list, const char *word)
{
    char framed[96];
    snprintf (framed, sizeof framed, "|%s|", word);
    return strstr (list, framed) != NULL;
}

void pg_criterion_demand (const pg_scene *scene, const char *name, const char *needs, const char *takes)
{
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) {
        const char *path = keys[i].path, *word = strchr (path, '.') + 1;
        if (strcmp (word, "criterion") == 0 || strcmp (word, "exclude") == 0) continue;
        int given = pg_scene_given (scene, "%s", path);
        if (!given && in (needs, word)) pg_scene_fault (scene, "failure.criterion", "%s needs %s", name, path);
        if (given && !in (needs, word) && !in (takes, word))
            pg_scene_fault (scene, path, "has no effect with the criterion %s", name);
    }
}
