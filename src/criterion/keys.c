/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of failure and of materials.<name>.failure. */
#include "entries.h"

static const char choices[] =
#define PG_CRITERION(name) #name "|"
#include "list.h"
#undef PG_CRITERION
    "none";

static const char *names_or_none (void) { return choices; }

static const pg_key keys[] = {
    { .path = "failure.criterion",
      .kind = PG_NAME,
      .fallback = "",
      .choices_of = names_or_none,
      .doc = "When a bond breaks; without `failure`, and with none, nothing breaks. Without it: node_energy "
             "with force: fcbm, beam_limits with gmpd, and "
             "with the others stretch where `failure` has critical_stretch or fracture_energy; else it is "
             "needed." },
    { .path = "failure.critical_stretch",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "stretch: relative elongation at which a bond breaks; either this or fracture_energy." },
    { .path = "failure.fracture_energy",
      .kind = PG_NUMBER,
      .unit = "J/m2",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "stretch: energy per new crack area, from which the critical stretch follows (with horizon, "
             "kernel and Young's modulus); node_energy: with the "
             "horizon alone." },
    { .path = "failure.wc_factor",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "0.5",
      .doc = "node_energy: a point dies at the energy density wc_factor times fracture_energy / horizon." },
    { .path = "failure.stretch",
      .kind = PG_NAME,
      .fallback = "linear",
      .choices = "linear|finite",
      .doc =
          "stretch: measured along the undeformed bond (small displacements), or from the deformed length." },
    { .path = "failure.modes",
      .kind = PG_NAME,
      .fallback = "together",
      .choices = "together|single",
      .doc = "beam_limits: shares of stretch, shear and bending in the fracture energy add up, or each has "
             "its limit alone." },
    { .path = "failure.tensile_strength",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "principal_stress, mohr_coulomb: largest principal stress that a bond bears." },
    { .path = "failure.cohesion",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "mohr_coulomb: shear strength without normal stress." },
    { .path = "failure.friction_angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .range = "[0, 1.5707)",
      .fallback = "",
      .doc = "mohr_coulomb: angle of internal friction, below 90 deg." },
    { .path = "failure.exclude",
      .kind = PG_NAMES,
      .fallback = "",
      .choices = "sets.{}|left|right|bottom|top|back|front|all",
      .doc = "Sets of nodes whose bonds never break, such as grips; node_energy: nodes that never die (their "
             "bonds to others that do break)." },
    { .path = "materials.{}.failure",
      .kind = PG_MAP,
      .fallback = "",
      .doc = "Limits of this material in place of those of failure; one criterion serves all. The weaker end "
             "decides for a bond between two materials." },
    { .path = "materials.{}.failure.never",
      .kind = PG_BOOL,
      .fallback = "off",
      .doc = "Bonds that end in this material never break." },
    { .path = "materials.{}.failure.critical_stretch",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "As failure.critical_stretch, for this material." },
    { .path = "materials.{}.failure.fracture_energy",
      .kind = PG_NUMBER,
      .unit = "J/m2",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "As failure.fracture_energy, for this material, with its own Young's modulus." },
    { .path = "materials.{}.failure.wc_factor",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "0.5",
      .doc = "As failure.wc_factor, for this material." },
    { .path = "materials.{}.failure.tensile_strength",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "As failure.tensile_strength, for this material." },
    { .path = "materials.{}.failure.cohesion",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "As failure.cohesion, for this material." },
    { .path = "materials.{}.failure.friction_angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .range = "[0, 1.5707)",
      .fallback = "",
      .doc = "As failure.friction_angle, for this material." },
};

const pg_key_table pg_keys_criterion = { "criterion", keys, sizeof keys / sizeof *keys };
