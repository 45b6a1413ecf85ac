/* SPDX-License-Identifier: GPL-3.0-or-later
 * The keys of the section `method` that choose the neighbours of a point, for every force, and
 * the shape functions, for forces that have some. Each row is read by the parser, by the
 * checks, by `perigal help` and by the documentation; nothing else names these keys except
 * catalogue.c. */
#include "perigal/approx.h"

static const pg_key keys[] = {
    { .path = "method.kernel",
      .kind = PG_NAME,
      .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_kernel_names,
      .doc = "Influence function of the distance divided by the horizon; of a force without shape "
             "functions that of its bonds, and constant unless given." },
    { .path = "method.horizon",
      .kind = PG_NUMBER,
      .unit = "m|spacing",
      .range = "(0, inf)",
      .fallback = "2.0 spacing",
      .doc = "Radius of influence of a point (radial), or half the edge of its box (tensor); of a force "
             "without shape functions 3.015 spacing unless given." },
    { .path = "method.tip_offset",
      .kind = PG_NUMBER,
      .unit = "m|spacing",
      .range = "[0, inf)",
      .fallback = "",
      .doc = "Of the bonds that meet a pre-crack only those are cut that cross it at least so far behind its "
             "tips (3D: fronts), which makes the crack as long as it is drawn; "
             "default by horizon and basis (galerkin: 0.25 spacing at a horizon of 2, 0 for the other "
             "forces). Ends at the surface or on another crack are no tips." },
};
const pg_key_table pg_keys_approx = { "approx", keys, sizeof keys / sizeof *keys };

static const pg_key shape_keys[] = {
    { .path = "method.approximation",
      .kind = PG_NAME,
      .fallback = PG_FIRST_CHOICE,
      .choices_of = pg_approx_names,
      .doc = "How a field and its derivatives follow from nodal values." },
    { .path = "method.basis",
      .kind = PG_NAME,
      .fallback = "linear",
      .choices = "linear|quadratic",
      .doc = "Polynomials that are reproduced exactly; quadratic needs a horizon of 2.5 to 3 spacings." },
    { .path = "method.support",
      .kind = PG_NAME,
      .fallback = "radial",
      .choices = "radial|tensor",
      .doc = "Influence of the distance, or product of the influences of its components (needs a smooth "
             "kernel)." },
    { .path = "method.weights",
      .kind = PG_NAME,
      .fallback = "auto",
      .choices = "unit|volume|auto",
      .doc = "Neighbours count equally or by their volumes; auto: unit for rkpm, volume for pddo and nosb." },
    { .path = "method.degenerate",
      .kind = PG_NAME,
      .fallback = "shepard",
      .choices = "shepard|projected",
      .doc = "Where broken bonds leave a point only neighbours on a line or a plane: shepard carries no "
             "stress there, projected keeps "
             "the derivatives along it (linear basis only; a rigid rotation then strains such a point)." },
};
const pg_key_table pg_keys_shape_functions = { "approx", shape_keys, sizeof shape_keys / sizeof *shape_keys };
