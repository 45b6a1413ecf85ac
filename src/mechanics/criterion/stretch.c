/* SPDX-License-Identifier: GPL-3.0-or-later
 * A bond breaks when its stretch reaches the critical stretch s0; shortening never breaks it. A fracture
 * energy gives s0 ~ horizon^(-1/2): where spacings differ, every bond has the limit of its own support.
 * linear: s = xi . eta / |xi|^2; finite: s = (|xi + eta| - |xi|) / |xi|. theory F6. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { LIMIT, FINITE, ENERGY, FROM_ENERGY, GRADED, EXACT };

#define EITHER "critical_stretch or fracture_energy"

/* Reads critical stretch or fracture energy and computes the other. Forces that know only one measure of
 * stretch (linear or finite) determine which one is used. */
static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    char map[PG_LIMITS], path[PG_LIMITS + 32];
    if (!pg_criterion_holder (map, scene, setting, EITHER)) return PG_OK;
    int energy = pg_scene_given (scene, "%s.fracture_energy", map);
    const char *measure = pg_scene_text (scene, "failure.stretch");
    if (setting->stretch && pg_scene_given (scene, "failure.stretch")
        && strcmp (measure, setting->stretch) != 0)
        pg_scene_fault (scene, "failure.stretch", "must be that of the forces: method.stretch is %s",
                        setting->stretch);
    c->parameter[FINITE] = strcmp (setting->stretch ? setting->stretch : measure, "finite") == 0;
    c->parameter[FROM_ENERGY] = energy;
    c->parameter[GRADED] = setting->graded;
    c->parameter[EXACT] = setting->stretch != NULL;
    c->parameter[LIMIT] = energy ? 0 : pg_criterion_limit (scene, setting, "critical_stretch");
    c->parameter[ENERGY] = energy ? pg_criterion_limit (scene, setting, "fracture_energy") : 0;
    pg_criterion_setting grown = *setting;
    grown.toughness = (setting->toughness > 0 ? setting->toughness : 1)
                      * pg_criterion_calibration (c, scene, setting);
    if (energy) c->parameter[LIMIT] = pg_stretch_from_energy (&grown, c->parameter[ENERGY]);
    else c->parameter[ENERGY] = pg_energy_from_stretch (&grown, c->parameter[LIMIT]);
    int passed = isnan (c->parameter[ENERGY]) && energy;     /* an expression without a reference value */
    if (!passed && (!(c->parameter[LIMIT] > 0) || !isfinite (c->parameter[LIMIT]))) {
        snprintf (path, sizeof path, "%s.fracture_energy", map);
        if (isnan (setting->modulus))
            pg_scene_fault (scene, path,
                            "gives no critical stretch: that takes one Young's modulus, and the stiffness "
                            "of this material depends on the direction: give critical_stretch");
        else pg_scene_fault (scene, path, "gives no critical stretch with this horizon and Young's modulus");
    }
    return PG_OK;
}

/* A fracture energy gives s0 ~ sqrt (G0 / E); a critical stretch that is given means G0 ~ E s0^2. */
static void scale (pg_criterion *c, const pg_limit_ratio *ratio)
{
    const double *of = ratio->of;
    int energy = c->parameter[FROM_ENERGY] > 0;
    c->parameter[LIMIT] *= energy ? sqrt (of[PG_OF_ENERGY] / of[PG_OF_STIFFNESS]) : of[PG_OF_STRETCH];
    c->parameter[ENERGY] *= energy ? of[PG_OF_ENERGY]
                                   : of[PG_OF_STIFFNESS] * of[PG_OF_STRETCH] * of[PG_OF_STRETCH];
}

/* rr = xi . xi, re = xi . eta, ee = eta . eta of one bond, m^2. */
static void products (int dim, const double *xi, const double *eta, double *rr, double *re, double *ee)
{
    *rr = *re = *ee = 0;
    for (int k = 0; k < dim; k++) {
        *rr += xi[k] * xi[k];
        *re += xi[k] * eta[k];
        *ee += eta[k] * eta[k];
    }
}

/* Returns the critical stretch of bond b: one from a fracture energy depends on the bond's own support. */
static double limit_of (const pg_criterion *c, const pg_bond_measures *m, size_t b)
{
    double limit = c->parameter[LIMIT];
    return m->reach && c->parameter[FROM_ENERGY] > 0 ? limit / sqrt (m->reach[b]) : limit;
}

/* finite: |xi + eta| / |xi| - 1, written without the difference of two nearly equal roots. */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    double rr, re, ee;
    int finite = c->parameter[FINITE] > 0;
    for (size_t b = 0; b < m->n; b++) {
        size_t at = b * (size_t) m->dim;
        products (m->dim, m->xi + at, m->eta + at, &rr, &re, &ee);
        double s = re / rr, grow = 2 * s + ee / rr;                    /* (stretched length / length)^2 - 1 */
        if (finite) s = grow > -1 ? grow / (1 + sqrt (1 + grow)) : -1;
        u[b] = s > 0 ? s / limit_of (c, m, b) : 0;
        if (kind) kind[b] = 't';
    }
}

/* Root of |xi + factor eta| = (1 + limit) |xi|: A f^2 + 2 B f + C = 0 with C < 0, without cancellation. */
static double finite_root (double A, double B, double C)
{
    if (!(A > 0)) return INFINITY;
    double root = sqrt (B * B - A * C);
    return B >= 0 ? -C / (B + root) : (root - B) / A;
}

/* Load factor at the limit. linear: limit / stretch; finite: the root of a quadratic equation. */
static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    double rr, re, ee;
    int finite = c->parameter[FINITE] > 0;
    for (size_t b = 0; b < m->n; b++) {
        size_t at = b * (size_t) m->dim;
        double limit = limit_of (c, m, b);
        products (m->dim, m->xi + at, m->eta + at, &rr, &re, &ee);
        if (finite) f[b] = finite_root (ee, re, -rr * limit * (2 + limit));
        else f[b] = re > 0 ? limit * rr / re : INFINITY;
    }
}

/* Writes a = xi / (xi . xi limit), 1/m: the utilisation is a . eta (linear measure only, else returns 0). */
static int linear (const pg_criterion *c, const pg_bond_measures *m, double *a)
{
    if (c->parameter[FINITE] > 0) return 0;
    for (size_t b = 0; b < m->n; b++) {
        const double *xi = m->xi + b * (size_t) m->dim;
        double rr = 0, limit = limit_of (c, m, b);
        for (int k = 0; k < m->dim; k++) rr += xi[k] * xi[k];
        for (int k = 0; k < m->dim; k++) a[b * (size_t) m->dim + (size_t) k] = xi[k] / (rr * limit);
    }
    return 1;
}

/* Elongation e at utilisation u > 0: linear: 2 s; finite: (1 + s)^2 - 1, with s = u s0. */
static double elongation (const pg_criterion *c, double u, double *square)
{
    double s = u * c->parameter[LIMIT];
    *square = c->parameter[FINITE] > 0;
    return *square > 0 ? s * (2 + s) : 2 * s;
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    int energy = c->parameter[FROM_ENERGY] > 0;
    char growth[200];
    if (isnan (c->parameter[ENERGY])) {
        snprintf (text, size,
                  "%s stretch >= %.6g (given), fracture energy not known: it depends on the direction",
                  c->parameter[FINITE] > 0 ? "finite" : "linear", c->parameter[LIMIT]);
        return;
    }
    pg_criterion_say_growth (c, growth, sizeof growth);
    snprintf (text, size, "%s stretch >= %.6g (%s%s), fracture energy %.6g J/m2 (%s)%s",
              c->parameter[FINITE] > 0 ? "finite" : "linear", c->parameter[LIMIT],
              energy ? "derived" : "given",
              c->parameter[GRADED] > 0 && energy
                  ? " at the mean spacing h; elsewhere times sqrt (h / local spacing)"
                  : "",
              c->parameter[ENERGY],
              energy                    ? "given"
              : c->parameter[EXACT] > 0 ? "derived"
                                        : "derived: estimate of bond-based theory",
              growth);
}

static const pg_key limit_keys[] = {
    { .path = "failure.critical_stretch",
      .kind = PG_EXPRESSION,
      .unit = "1",
      .range = "(0, inf)",
      .fallback = "",
      .group = "limit:most",
      .doc = "Relative elongation at which a bond breaks; this or fracture_energy. May be an expression of "
             "place." },
};
static const pg_key option_keys[] = {
    { .path = "failure.stretch",
      .kind = PG_NAME,
      .fallback = "linear",
      .choices = "linear|finite",
      .doc = "Measured along the undeformed bond (small displacements), or from the deformed length." },
};
static const pg_key_table limits = { "criterion", limit_keys, 1 }, options = { "criterion", option_keys, 1 };

const pg_criterion_type pg_criterion_stretch = {
    .name = "stretch",
    .summary = "elongation of the bond reaches the critical stretch",
    .needs = PG_NEEDS_STRETCH,
    .limits = { &limits, &criterion_keys_energy },
    .options = { &options, &criterion_keys_calibration },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .linear = linear,
    .elongation = elongation,
    .describe = describe
};
