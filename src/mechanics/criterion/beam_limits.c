/* SPDX-License-Identifier: GPL-3.0-or-later
 * A bond that bears shear breaks by the energy that a straight cut through such bonds would take: with s0,
 * gamma0, kappa0 the stretch, shear and bending that alone would consume G0 (Chen 2022 eq (14), corrected in
 * theory G5),
 *   together: (max (s, 0) / s0)^2 + (gamma / gamma0)^2 + (kappa / kappa0)^2 >= 1; single (the rule of Chen
 *       2022): any one of the three at its limit.
 * Shortening never breaks a bond. Where spacings differ, all limits are proportional to horizon^(-1/2). */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { STRETCH, SHEAR, BENDING, ENERGY };

/* Computes the three limits from the fracture energy and from the energy of a straight cut at unit stretch,
 * shear and bending; INFINITY where a cut stores no such energy. */
static pg_status read (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    double G0 = c->parameter[ENERGY] = pg_criterion_limit (scene, setting, "fracture_energy");
    c->single = strcmp (pg_scene_text (scene, "failure.modes"), "single") == 0;
    double growth = pg_criterion_calibration (c, scene, setting);
    for (int k = 0; k < 3; k++)
        c->parameter[k] = setting->beam[k] > 0 ? sqrt (G0 / (growth * setting->beam[k])) : INFINITY;
    return PG_OK;
}

/* Stretch of bond b, measured along the undeformed bond. */
static double stretch_of (const pg_bond_measures *m, size_t b)
{
    double rr = 0, re = 0;
    for (size_t k = b * (size_t) m->dim; k < (b + 1) * (size_t) m->dim; k++)
        rr += m->xi[k] * m->xi[k], re += m->xi[k] * m->eta[k];
    return re / rr;
}

/* `reach` is the support of the bond over the nominal horizon: limits from an energy are proportional to
 * reach^(-1/2). */
static void utilisation (const pg_criterion *c, const pg_bond_measures *m, double *u, char *kind)
{
    for (size_t b = 0; b < m->n; b++) {
        double s = fmax (stretch_of (m, b), 0) / c->parameter[STRETCH], g = m->shear[b] / c->parameter[SHEAR],
               k = m->bending[b] / c->parameter[BENDING];
        double most = fmax (s, fmax (g, k));
        u[b] = (c->single ? most : sqrt (s * s + g * g + k * k)) * (m->reach ? sqrt (m->reach[b]) : 1);
        if (kind) kind[b] = most == s ? 't' : most == g ? 's' : 'b';
    }
}

/* All three shares are of degree 1 in the displacement, so that the factor is the inverse of the
 * utilisation. */
static void factor (const pg_criterion *c, const pg_bond_measures *m, double *f)
{
    utilisation (c, m, f, NULL);
    for (size_t b = 0; b < m->n; b++) f[b] = f[b] > 0 ? 1 / f[b] : INFINITY;
}

/* All stiffnesses of a bond are proportional to Young's modulus, as Poisson's ratio is the same. */
static void scale (pg_criterion *c, const pg_limit_ratio *ratio)
{
    c->parameter[ENERGY] *= ratio->of[PG_OF_ENERGY];
    for (int k = 0; k < 3; k++)
        c->parameter[k] *= sqrt (ratio->of[PG_OF_ENERGY] / ratio->of[PG_OF_STIFFNESS]);
}

static void describe (const pg_criterion *c, char *text, size_t size)
{
    char growth[200];
    pg_criterion_say_growth (c, growth, sizeof growth);
    snprintf (
        text, size,
        "bonds as beams: stretch %.6g, shear %.6g, bending %.6g rad, %s; fracture energy %.6g J/m2 (given)%s",
        c->parameter[STRETCH], c->parameter[SHEAR], c->parameter[BENDING],
        c->single ? "any one of them" : "together by energy", c->parameter[ENERGY],
        growth);
}

static const pg_key option_keys[] = {
    { .path = "failure.modes",
      .kind = PG_NAME,
      .fallback = "together",
      .choices = "together|single",
      .doc = "Shares of stretch, shear and bending in the fracture energy add up, or each has its limit "
             "alone." },
};
static const pg_key_table options = { "criterion", option_keys, 1 };

const pg_criterion_type pg_criterion_beam_limits = {
    .name = "beam_limits",
    .summary = "stretch, shear and bending of a bond (gmpd), each by fracture energy, together or singly",
    .needs = PG_NEEDS_BEAMS,
    .limits = { &criterion_keys_energy },
    .options = { &options, &criterion_keys_calibration },
    .read = read,
    .utilisation = utilisation,
    .factor = factor,
    .scale = scale,
    .describe = describe
};
