/* SPDX-License-Identifier: GPL-3.0-or-later
 * What a plan says about bonds: constants, how they are summed, the largest explicit time step; which solvers
 * they do not go with. */
#include "bond.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static void say_beams (const bond *b, size_t m, char *text, size_t size)
{
    const pg_problem *p = b->problem;
    const pg_material *a = &p->material[m];
    double axial, shear, E, nu, dilation;
    pg_beam_sums sums;
    int used = 0;
    gmpd_split (p, m, &E, &nu, &dilation);
    if (p->nmaterial > 1) used = snprintf (text, size, "material %.60s: ", a->name);
    if (pg_beam_moduli (&axial, &shear, p->mode, p->sums->rule.kernel, p->sums->rule.horizon, E, nu,
                        p->cloud.thickness)
            != PG_OK
        || pg_beam_measure (&sums, p->sums) != PG_OK)
        return;
    used += snprintf (text + used, size - (size_t) used, "C_N %.6g N/m^6, C_t %.6g N/m^4, bending %.6g C_t",
                      axial, shear, ((const gmpd_options *) p->options)->bending);
    if (p->sums->rule.calibrate && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used,
                          ", times %.6g and %.6g for these points (calibrated)", p->sums->calibration,
                          sums.calibration);
    if (shear == 0 && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used, "; nothing resists rotations: they are held");
    if (p->sums->rule.state && (size_t) used < size)
        snprintf (text + used, size - (size_t) used,
                  "; bonds make Poisson's ratio %.4g, dilatation bears %.6g Pa more (weighted volumes of %s)",
                  nu, dilation / p->dim,
                  p->sums->rule.follow ? "the bonds that live" : "the bonds of the start");
}

static void say_constant (const bond *b, size_t m, char *text, size_t size)
{
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    if (rule->state && !b->shear) {
        const pg_material *a = &p->material[m];
        double E = a->modulus, nu = a->nu, A, B, d = p->dim;
        pg_state_moduli (p->mode, E, nu, &A, &B);
        snprintf (text, size,
                  "%s%s%slinear peridynamic solid, bulk modulus %.6g Pa%s, shear modulus %.6g Pa; weighted "
                  "volumes of %s",
                  p->nmaterial > 1 ? "material " : "", p->nmaterial > 1 ? a->name : "",
                  p->nmaterial > 1 ? ": " : "", (A + B / d) / d, p->dim == 2 ? " (of the plane)" : "",
                  B / (d * (d + 2)), rule->follow ? "the bonds that live" : "the bonds of the start");
        return;
    }
    if (b->shear) {
        say_beams (b, m, text, size);
        return;
    }
    double c = pg_bond_modulus (p->mode, rule->kernel, rule->horizon, p->material[m].modulus,
                                p->cloud.thickness);
    int used = snprintf (text, size, "%s%s%sconstant %.6g N/m^6, Poisson's ratio %.4g",
                         p->nmaterial > 1 ? "material " : "", p->nmaterial > 1 ? p->material[m].name : "",
                         p->nmaterial > 1 ? ": " : "", c, pg_bond_poisson (p->mode));
    if (rule->calibrate && used > 0 && (size_t) used < size)
        snprintf (text + used, size - (size_t) used,
                  ", times %.6g for these points (calibrated: energy of hydrostatic strain)",
                  p->sums->calibration);
}

static void say_sums (const bond *b, char *text, size_t size)
{
    static const char *const partial[] = { "none", "linear", "overlap" }, *const surface[] = { "none",
                                                                                               "product",
                                                                                               "volume" };
    const pg_sum_rule *rule = &b->problem->sums->rule;
    const char *why = pg_bond_loop_reason (b->sweep);
    snprintf (
        text, size,
        "up to %zu a point, %s stretch; partial volumes: %s, surface correction: %s; summed by %s%s%s%s",
        b->widest, rule->finite ? "finite" : "linear", partial[rule->partial], surface[rule->surface],
        pg_bond_loop_name (b->sweep), *why ? " (" : "", why, *why ? ")" : "");
}

static void say_toughness (const bond *b, char *text, size_t size)
{
    const pg_sums *s = b->problem->sums;
    if (b->critical)
        snprintf (text, size,
                  "energy of points is looked at in every step; a crack kills points over a width of about "
                  "the horizon, which costs more than G0 at "
                  "wc_factor 1 (see doc/method.md)");
    else if (s->stencil.n)
        snprintf (text, size,
                  "a straight crack along the lattice consumes %.5g of theory's energy at the same stretch%s",
                  pg_sums_toughness (s, b->problem->material->modulus, b->problem->material->nu),
                  s->rule.calibrate ? ": allowed for where one follows from the other" : "");
    else
        snprintf (text, size,
                  "critical stretch and fracture energy are those of theory: points without a lattice are "
                  "not calibrated for them");
}

static int say_step (const bond *b, char *text, size_t size)
{
    double omega;
    for (size_t m = 0; m < b->problem->nmaterial; m++) if (!(b->problem->material[m].density > 0)) return 0;
    if (bond_bound ((void *) b, &omega) != PG_OK) return 0;
    snprintf (text, size, "explicit steps stable up to %.6g s at least (closed form)", 2 / omega);
    return 1;
}

int bond_describe (const void *self, size_t line, char *text, size_t size)
{
    const bond *b = self;
    size_t n = b->problem->nmaterial;
    if (line < n) say_constant (b, line, text, size);
    else if (line == n) say_sums (b, text, size);
    else if (line == n + 1 && (b->limit || b->critical)) say_toughness (b, text, size);
    else return line == n + 1 + (b->limit || b->critical) && say_step (b, text, size);
    return 1;
}

const char *bond_refuses (const pg_problem *problem, unsigned solver)
{
    if ((solver & PG_SOLVER_IMPLICIT) && problem->sums && problem->sums->rule.finite)
        return "method.stretch: finite makes forces that are not linear in the displacement, and this solver "
               "needs "
               "linear ones: use stretch: linear";
    return NULL;
}
