/* SPDX-License-Identifier: GPL-3.0-or-later
 * A crack grows where the energy that a new piece of it releases reaches the energy that it takes (Griffith
 * 1921): G0 per area in opening, G_II in sliding, each given per material or as an expression of position
 * (energies also of the direction of growth). This criterion judges tips, not bonds: it holds the limits, and
 * solve/growth/facet_growth.c compares them with J. With a strength new cracks also begin in sound material
 * (Leguillon 2002: stress and energy together): by tension and G0, or, with a cohesion, by the shear stress
 * of Coulomb and G_II. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Entries of pg_criterion.parameter (J/m^2, J/m^2, Pa, Pa, rad); NAN: not given, or an expression. */
enum { ENERGY, SHEAR, STRENGTH, COHESION, ANGLE };

typedef struct {                                       /* data that are not numbers (pg_criterion.own) */
    pg_expression *of[ANGLE];                          /* limits as functions of x, angle; NULL: a number */
    double *path; size_t npath;                        /* imposed path of all cracks, m (npath x 2) */
} energy_release;

/* ---- reading ------------------------------------------------------------------------------------------- */
static const char *const names[] = { "fracture_energy", "shear_fracture_energy", "tensile_strength",
                                     "cohesion", "friction_angle" };

/* Reads one limit: a number, an expression of position that is compiled, or NAN: not given. */
static pg_status read_limit (pg_criterion *c, int which, const pg_scene *scene,
                             const pg_criterion_setting *setting)
{
    pg_status status = PG_OK;
    char map[PG_LIMITS], path[PG_LIMITS + 32];
    energy_release *own = c->own;
    c->parameter[which] = NAN;
    if (!pg_criterion_holder (map, scene, setting, names[which])) return PG_OK;
    snprintf (path, sizeof path, "%s.%s", map, names[which]);
    c->parameter[which] = pg_scene_number (scene, "%s", path);
    if (!isnan (c->parameter[which]) || which == ANGLE) return PG_OK;
    PG_TRY (pg_expression_compile (&own->of[which], pg_scene_text (scene, "%s", path),
                                   which < STRENGTH ? "J/m2" : "Pa"));
    if (pg_expression_uses (own->of[which], 't'))
        pg_scene_fault (scene, path, "may depend on x, y and angle (the direction of growth), not on t");
    /* In 3D no single angle gives the orientation of the new surface. */
    if (setting->mode == PG_SOLID && pg_expression_uses (own->of[which], 'a'))
        pg_scene_fault (scene, path, "may depend on x, y and z; angle, the direction of growth, is for "
                                     "cracks in the plane");
done:
    return status;
}

/* Checks the limits for shear: cohesion, friction angle and fracture energy of sliding need each other. */
static void check_shear (const pg_scene *scene, const pg_criterion_setting *setting)
{
    static const int with[2] = { ANGLE, SHEAR };
    char map[PG_LIMITS], path[PG_LIMITS + 32];
    for (int k = 0; k < 2 && pg_criterion_holder (map, scene, setting, names[COHESION]); k++) {
        snprintf (path, sizeof path, "%s.%s", map, names[COHESION]);
        if (!pg_criterion_holder (map, scene, setting, names[with[k]]))
            pg_scene_fault (scene, path, "cracks begin in shear by a cohesion with failure.%s: give it, or "
                            "leave the cohesion out", names[with[k]]);
    }
    if (pg_criterion_holder (map, scene, setting, names[ANGLE])
        && !pg_criterion_holder (map, scene, setting, names[COHESION])) {
        pg_criterion_holder (map, scene, setting, names[ANGLE]);
        snprintf (path, sizeof path, "%s.%s", map, names[ANGLE]);
        pg_scene_fault (scene, path, "has a meaning with failure.cohesion alone: give that, or leave it out");
    }
}

/* Reads the imposed path; every material has a copy, so that each can be freed by itself. */
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
    for (int k = ENERGY; k <= ANGLE; k++) PG_TRY (read_limit (c, k, scene, setting));
    check_shear (scene, setting);
    PG_TRY (read_path (own, scene));
done:
    return status;
}

static void clear (pg_criterion *c)
{
    energy_release *own = c->own;
    if (!own) return;
    for (int k = 0; k < ANGLE; k++) pg_expression_free (&own->of[k]);
    pg_free (own->path), pg_free (own);
    c->own = NULL;
}

/* ---- limits -------------------------------------------------------------------------------------------- */
/* Limits at x for growth at `angle`, which expressions get reduced to [0, 2 pi). */
static void fracture (const pg_criterion *c, const double *x, double angle, pg_fracture_limits *out)
{
    static const double turn = 6.28318530717958647692;
    const energy_release *own = c->own;
    pg_place at = { x[0], x[1], x[2], hypot (x[0], x[1]), angle - turn * floor (angle / turn), 0 };
    double value[ANGLE];
    for (int k = 0; k < ANGLE; k++)
        value[k] = own->of[k] ? pg_expression_value (own->of[k], &at) : c->parameter[k];
    out->energy = value[ENERGY], out->shear = value[SHEAR], out->strength = value[STRENGTH];
    out->cohesion = value[COHESION], out->slope = tan (c->parameter[ANGLE]);
}

static int uneven (const pg_criterion *c)
{
    const energy_release *own = c->own;
    return own && (own->of[ENERGY] || own->of[SHEAR]);
}

static const double *path (const pg_criterion *c, size_t *n)
{
    const energy_release *own = c->own;
    *n = own ? own->npath : 0;
    return *n ? own->path : NULL;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    static const char *const what[ANGLE] = { "energy release >= ", ", sliding ", ", new cracks at ",
                                             ", new cracks in shear at cohesion " },
                      *const behind[ANGLE] = { "", "", " and that energy", "" };
    const energy_release *own = c->own;
    size_t used = 0;
    for (int k = ENERGY; k < ANGLE && used < size; k++) {
        const char *unit = k < STRENGTH ? "J/m^2" : "Pa";
        if (own->of[k])
            used += (size_t) snprintf (text + used, size - used, "%s%s%s%s", what[k],
                                       k == ENERGY ? "G0 of place and direction" : "a value of place (",
                                       k == ENERGY ? "" : unit, k == ENERGY ? "" : ")");
        else if (k == ENERGY || !isnan (c->parameter[k]))
            used += (size_t) snprintf (text + used, size - used, "%s%.6g %s%s", what[k], c->parameter[k],
                                       unit, behind[k]);
    }
    if (used < size && !isnan (c->parameter[ANGLE]))
        used += (size_t) snprintf (text + used, size - used, ", friction angle %.6g deg",
                                   c->parameter[ANGLE] * 57.295779513082320877);
    if (used < size && own->npath) snprintf (text + used, size - used, ", along failure.path");
}

/* ---- the entry ----------------------------------------------------------------------------------------- */
static const pg_key limit_keys[] = {
    { .path = "failure.shear_fracture_energy",
      .kind = PG_EXPRESSION,
      .unit = "J/m2",
      .range = "(0, inf)",
      .fallback = "",
      .doc = "Energy per new crack area that slides instead of opening; without it no crack grows by "
             "sliding. May be an expression of place and `angle`." },
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
