/* SPDX-License-Identifier: GPL-3.0-or-later
 * A crack grows where the energy that a new piece of it sets free reaches what it takes (Griffith 1921):
 * G0 per area in opening, G_II in sliding, each its own for every material, G0 also an expression of
 * place and direction of growth. This criterion judges tips, not bonds: it holds the limits, and
 * solve/facet_growth.c compares them with J. With a strength cracks also begin where there is none
 * (Leguillon 2002: stress and energy together): tension and G0, or, with a cohesion,
 * the shear stress of Coulomb and G_II. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { ENERGY, SHEAR, STRENGTH, COHESION, ANGLE };     /* parameter[]; NAN: not given, or not one number */

typedef struct {                                       /* what does not fit into numbers */
    pg_expression *energy;                             /* J/m^2, of place and angle; NULL: a constant */
    double *path; size_t npath;                        /* imposed path of all cracks, m (npath x 2) */
} energy_release;

/* ---- reading ------------------------------------------------------------------------------------------- */
/* A limit that need not be given: NAN then. */
static double optional (const pg_scene *scene, const pg_criterion_setting *setting, const char *limit)
{
    char map[PG_LIMITS];
    return pg_criterion_holder (map, scene, setting, limit) ? pg_criterion_limit (scene, setting, limit)
                                                            : NAN;
}

/* A constant is kept as a number; an expression is compiled, and must be positive where it is tried. */
static pg_status read_energy (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    pg_status status = PG_OK;
    char map[PG_LIMITS], path[PG_LIMITS + 32];
    energy_release *own = c->own;
    if (!pg_criterion_holder (map, scene, setting, "fracture_energy")) return PG_OK;     /* a fault already */
    c->parameter[ENERGY] = pg_scene_number (scene, "%s.fracture_energy", map);
    if (!isnan (c->parameter[ENERGY])) return PG_OK;
    snprintf (path, sizeof path, "%s.fracture_energy", map);
    PG_TRY (pg_expression_compile (&own->energy, pg_scene_text (scene, "%s", path), "J/m2"));
    if (pg_expression_uses (own->energy, 't'))
        pg_scene_fault (scene, path, "may depend on x, y and angle (the direction of growth), not on t");
    /* in space no single angle says how the new surface lies */
    if (setting->mode == PG_SOLID && pg_expression_uses (own->energy, 'a'))
        pg_scene_fault (scene, path, "may depend on x, y and z; angle, the direction of growth, is for "
                                     "cracks in the plane");
done:
    return status;
}

/* Strength in shear: a cohesion, its angle, and the energy that sliding takes go together. */
static pg_status read_shear (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    static const char *const names[3] = { "cohesion", "friction_angle", "shear_fracture_energy" };
    char map[PG_LIMITS], path[PG_LIMITS + 32];
    c->parameter[COHESION] = optional (scene, setting, names[0]);
    c->parameter[ANGLE] = optional (scene, setting, names[1]);
    for (int k = 1; k < 3 && pg_criterion_holder (map, scene, setting, names[0]); k++) {
        snprintf (path, sizeof path, "%s.%s", map, names[0]);
        if (!pg_criterion_holder (map, scene, setting, names[k]))
            pg_scene_fault (scene, path, "cracks begin in shear by a cohesion with failure.%s: give it, or "
                            "leave the cohesion out", names[k]);
    }
    if (pg_criterion_holder (map, scene, setting, names[1])
        && !pg_criterion_holder (map, scene, setting, names[0])) {
        pg_criterion_holder (map, scene, setting, names[1]);
        snprintf (path, sizeof path, "%s.%s", map, names[1]);
        pg_scene_fault (scene, path, "has a meaning with failure.cohesion alone: give that, or leave it out");
    }
    return PG_OK;
}

/* The imposed path; every material has a copy, so that each can be freed by itself. */
static pg_status read_path (energy_release *own, const pg_scene *scene)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "failure.path");
    if (!pg_scene_given (scene, "failure.path")) return PG_OK;
    PG_ALLOC (own->path, 2 * n);
    own->npath = n;
    for (size_t i = 0; i < n; i++) pg_scene_vector (scene, 2, own->path + 2*i, "failure.path[%zu]", i);
    if (n < 2) pg_scene_fault (scene, "failure.path", "needs two places or more");
    for (size_t i = 1; i < n; i++)
        if (own->path[2*i] == own->path[2*i - 2] && own->path[2*i + 1] == own->path[2*i - 1])
            pg_scene_fault (scene, "failure.path", "places %zu and %zu are one", i, i + 1);
done:
    return status;
}

static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    pg_status status = PG_OK;
    energy_release *own = NULL;
    PG_ALLOC (own, 1);
    c->own = own;
    pg_criterion_by_theory (scene);
    PG_TRY (read_energy (c, scene, setting));
    c->parameter[SHEAR] = optional (scene, setting, "shear_fracture_energy");
    c->parameter[STRENGTH] = optional (scene, setting, "tensile_strength");
    PG_TRY (read_shear (c, scene, setting));
    PG_TRY (read_path (own, scene));
done:
    return status;
}

static void clear (pg_criterion *c)
{
    energy_release *own = c->own;
    if (!own) return;
    pg_expression_free (&own->energy);
    pg_free (own->path), pg_free (own);
    c->own = NULL;
}

/* ---- limits -------------------------------------------------------------------------------------------- */
/* The angle in expressions is that of growth, in [0, 2 pi). */
static void fracture (const pg_criterion *c, const double *x, double angle, pg_fracture_limits *out)
{
    static const double turn = 6.28318530717958647692;
    const energy_release *own = c->own;
    pg_place at = { x[0], x[1], x[2], hypot (x[0], x[1]), angle - turn * floor (angle / turn), 0 };
    out->energy = own->energy ? pg_expression_value (own->energy, &at) : c->parameter[ENERGY];
    out->shear = c->parameter[SHEAR], out->strength = c->parameter[STRENGTH];
    out->cohesion = c->parameter[COHESION], out->slope = tan (c->parameter[ANGLE]);
}

static int uneven (const pg_criterion *c)
{
    const energy_release *own = c->own;
    return own && own->energy != NULL;
}

static const double *path (const pg_criterion *c, size_t *n)
{
    const energy_release *own = c->own;
    *n = own ? own->npath : 0;
    return *n ? own->path : NULL;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    const energy_release *own = c->own;
    size_t used = own->energy
                      ? (size_t) snprintf (text, size, "energy release >= G0 of place and direction")
                      : (size_t) snprintf (text, size, "energy release >= %.6g J/m^2", c->parameter[ENERGY]);
    if (used < size && !isnan (c->parameter[SHEAR]))
        used += (size_t) snprintf (text + used, size - used, ", sliding %.6g J/m^2", c->parameter[SHEAR]);
    if (used < size && !isnan (c->parameter[STRENGTH]))
        used += (size_t) snprintf (text + used, size - used, ", new cracks at %.6g Pa and that energy",
                                   c->parameter[STRENGTH]);
    if (used < size && !isnan (c->parameter[COHESION]))
        used += (size_t) snprintf (text + used, size - used,
                                   ", new cracks in shear at cohesion %.6g Pa, friction angle %.6g deg",
                                   c->parameter[COHESION], c->parameter[ANGLE] * 57.295779513082320877);
    if (used < size && own->npath) snprintf (text + used, size - used, ", along failure.path");
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
static const pg_key limit_keys[] = {
    { .path = "failure.shear_fracture_energy",
      .kind = PG_NUMBER,
      .unit = "J/m2",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Energy per new crack area that slides instead of opening; without it no crack grows by "
             "sliding." },
};
static const pg_key option_keys[] = {
    { .path = "failure.path",
      .kind = PG_LIST,
      .fallback = "",
      .doc = "Places, joined by straight lines, that every crack is held to (a double cantilever beam with "
             "side grooves): only how far it grows is computed. The tips must lie on it." },
    { .path = "failure.path[]",
      .kind = PG_VECTOR,
      .unit = "m",
      .fallback = "",
      .doc = "One place." },
};
static const pg_key_table limits = { "criterion", limit_keys, 1 }, options = { "criterion", option_keys, 2 };

const pg_criterion_type pg_criterion_energy_release = {
    .name = "energy_release",
    .summary = "energy that a piece of crack sets free reaches the fracture energy; cracks grow by facets",
    .needs = PG_NEEDS_FACETS,
    .needed = 1,
    .limits = { &criterion_keys_energy, &criterion_keys_tension, &limits, &criterion_keys_shear },
    .options = { &options, &criterion_keys_calibration },
    .read = read,
    .fracture = fracture,
    .uneven = uneven,
    .path = path,
    .clear = clear,
    .describe = describe
};
