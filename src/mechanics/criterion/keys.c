/* SPDX-License-Identifier: GPL-3.0-or-later
 * Keys of `failure` that every criterion reads, and limits that several criteria share. Keys of one criterion
 * are in its own file. A limit may be given in materials.<name>.failure as well. */
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
      .doc =
          "When a bond breaks; without `failure`, and with none, nothing breaks. Without it: the criterion "
          "that is usual with the force; else, with a fracture_energy in a static run with shape functions "
          "in the plane (in space: with solver.break: facet), energy_release; else stretch where `failure` "
          "has critical_stretch or fracture_energy; else it is needed." },
    { .path = "failure.exclude",
      .kind = PG_NAMES,
      .fallback = "",
      .choices = "sets.{}|left|right|bottom|top|back|front|all",
      .doc = "Sets of nodes whose bonds never break, such as grips; with a criterion of points these never "
             "fail (but their bonds to points that do break)." },
    { .path = "failure.interfaces",
      .kind = PG_LIST,
      .fallback = "",
      .doc = "Interfaces between two materials along which cracks take another energy than in either of "
             "them: a "
             "tip that meets one goes on along it or across it, whichever the lesser load drives." },
    { .path = "failure.interfaces[].between",
      .kind = PG_NAMES,
      .choices = "materials.{}",
      .doc = "The two materials." },
    { .path = "failure.interfaces[].fracture_energy",
      .kind = PG_NUMBER,
      .unit = "J/m2",
      .range = "(0, inf)",
      .doc = "Energy per new crack area along the interface." },
    { .path = "failure.interfaces[].tensile_strength",
      .kind = PG_NUMBER,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Tension across the interface that it bears; without it cracks do not begin there." },
    { .path = "materials.{}.failure",
      .kind = PG_MAP,
      .fallback = "",
      .doc =
          "Limits of this material in place of those of failure; one criterion serves all. The weaker end "
          "decides for a bond between two materials." },
    { .path = "materials.{}.failure.never",
      .kind = PG_BOOL,
      .fallback = "off",
      .doc = "Bonds that end in this material never break." },
};

const pg_key_table pg_keys_criterion = { "criterion", keys, sizeof keys / sizeof *keys };

static const pg_key energy[] = {
    { .path = "failure.fracture_energy",
      .kind = PG_EXPRESSION,
      .unit = "J/m2",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "Energy per new crack area, from which the limits follow: those of bonds with horizon, kernel "
             "and the "
             "material's Young's modulus, that of points with the horizon alone. May be an expression of "
             "place; where tips are judged also of `angle`, the direction of growth from the x axis." },
};
const pg_key_table criterion_keys_energy = { "criterion", energy, sizeof energy / sizeof *energy };

static const pg_key calibration[] = {
    { .path = "failure.calibration",
      .kind = PG_NAME,
      .fallback = "measured",
      .choices = "measured|theory",
      .doc = "Limits from fracture_energy: measured: so that a crack which grows bond by bond consumes that "
             "energy, mean over directions of growth (plane lattices, constant kernel, horizons of 3 to 5 "
             "spacings; else as theory); theory: as a straight cut through bonds that are all at their limit "
             "would, which is the formula of the literature; a growing crack consumes more." },
};
const pg_key_table criterion_keys_calibration = { "criterion", calibration, 1 };

static const pg_key tension[] = {
    { .path = "failure.tensile_strength",
      .kind = PG_EXPRESSION,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Largest principal stress that a bond bears; where tips are judged, tension at which new cracks "
             "begin. May be an expression of place." },
};
const pg_key_table criterion_keys_tension = { "criterion", tension, sizeof tension / sizeof *tension };

static const pg_key shear[] = {
    { .path = "failure.cohesion",
      .kind = PG_EXPRESSION,
      .unit = "Pa",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Shear strength without normal stress; may be an expression of place. Where tips are judged "
             "(with friction_angle, "
             "shear_fracture_energy and contact.kind): new cracks begin in shear under compression where "
             "this and shear_fracture_energy are reached." },
    { .path = "failure.friction_angle",
      .kind = PG_NUMBER,
      .unit = "rad",
      .range = "[0, 1.5707)",
      .fallback = "",
      .doc = "Angle of internal friction, below 90 deg; what faces bear that have formed is "
             "contact.coefficient." },
};
const pg_key_table criterion_keys_shear = { "criterion", shear, sizeof shear / sizeof *shear };
