/* SPDX-License-Identifier: GPL-3.0-or-later
 * Texts about bonds for the plan of a run: constants, how bonds are summed, the largest explicit time step;
 * which solvers these forces refuse. */
#include "bond_force.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Says how bonds are summed, and why so. */
static void say_sums (const bond_force *b, char *text, size_t size)
{
    static const char *const partial[] = { "none", "linear", "overlap" }, *const surface[] = { "none",
                                                                                               "product",
                                                                                               "volume" };
    const pg_sum_rule *rule = &b->problem->sums->rule;
    const char *why = pg_bond_loop_reason (b->loop);
    snprintf (
        text, size,
        "up to %zu a point, %s stretch; partial volumes: %s, surface correction: %s; summed by %s%s%s%s",
        b->widest, rule->finite ? "finite" : "linear", partial[rule->partial], surface[rule->surface],
        pg_bond_loop_name (b->loop), *why ? " (" : "", why, *why ? ")" : "");
}

/* Says how the energy of a crack compares with that of theory. */
static void say_toughness (const bond_force *b, char *text, size_t size)
{
    const pg_sums *s = b->problem->sums;
    if (b->node.critical)
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

/* Says the bound of the stable time step; returns 0 if there is none, as a material has no density. */
static int say_step (const bond_force *b, char *text, size_t size)
{
    double omega;
    for (size_t m = 0; m < b->problem->nmaterial; m++) if (!(b->problem->material[m].density > 0)) return 0;
    if (bond_force_omega (b, &omega) != PG_OK) return 0;
    snprintf (text, size, "explicit steps stable up to %.6g s at least (closed form)", 2 / omega);
    return 1;
}

/* Writes line `line`: one for each material, then sums, toughness, time step; returns 0 past the last. */
int bond_force_describe (const void *self, size_t line, char *text, size_t size)
{
    const bond_force *b = self;
    size_t n = b->problem->nmaterial;
    if (line < n) b->theory->words (b, line, text, size);
    else if (line == n) say_sums (b, text, size);
    else if (line == n + 1 && (b->limit || b->node.critical)) say_toughness (b, text, size);
    else return line == n + 1 + (b->limit || b->node.critical) && say_step (b, text, size);
    return 1;
}

/* Says what time folded stencils have saved, on blocks of points with all bonds intact. */
int bond_force_spared (const void *self, size_t k, char *what, char *why, double *seconds)
{
    const bond_force *b = self;
    pg_bond_loop_counts count;
    pg_bond_loop_counted (b->loop, &count);
    if (k > 0 || count.folded == 0 || count.blocks == 0) return 0;
    snprintf (what, 96, "bonds one by one, and looks at all of them, where all bonds of a block live");
    snprintf (why, 160, "mirror images are summed together, and a bound of what bonds have been stretched "
                        "tells when to look");
    *seconds = count.saved;
    return 1;
}

/* Returns why a solver cannot be used, NULL: it can. Implicit ones need forces linear in the displacement. */
const char *bond_force_refuses (const pg_problem *problem, unsigned solver)
{
    if ((solver & PG_SOLVER_IMPLICIT) && problem->sums && problem->sums->rule.finite)
        return "method.stretch: finite makes forces that are not linear in the displacement, and this solver "
               "needs "
               "linear ones: use stretch: linear";
    return NULL;
}
