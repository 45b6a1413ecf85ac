/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear peridynamic solid as an entry of the catalogue: what it reads, needs and refuses. */
#include "state_based.h"
#include <string.h>

/* Surface corrections are left out unless asked for, as weighted volumes allow for incomplete families. */
static void rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                  double spacing,
                  int lattice)
{
    static const char surface[] = "method.surface_correction";
    bond_force_rule (out, scene, mode, approx, spacing, lattice);
    bond_force_rule_with_dilatation (out, scene);
    if (strcmp (pg_scene_text (scene, surface), "auto") == 0) out->surface = PG_SURFACE_NONE;
}

/* 1: forces always couple neighbours of neighbours, as the dilatation of a neighbour depends on these. */
static int long_range (const pg_scene *scene)
{
    (void) scene;
    return 1;
}

/* Reports what this force does not allow: a matrix, one dimension, finite stretch, surface corrections. */
static void check (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    bond_force_refuse_matrix (p, scene, "");
    if (p->mode == PG_LINE)
        pg_scene_fault (scene, "method.force",
                        "%s has no meaning in one dimension, where it is the same as bond: use force: bond",
                        p->method->name);
    if (rule->finite)
        pg_scene_fault (scene, "method.stretch",
                        "force: %s is linear in the displacement: use stretch: linear, or force: bond",
                        p->method->name);
    if (rule->surface != PG_SURFACE_NONE)
        pg_scene_fault (
            scene, "method.surface_correction",
            "force: %s weighs families that are not whole by their own weighted volume: use none or auto",
            p->method->name);
}


/* The weighted volume of points beside a crack has only the bonds that they have left, so that they lose
 * hardly any stiffness. Measured as in bond_force_tip_offset: +0.5 % of K, 0.05 spacings, for Poisson's
 * ratios from 0.1 to 0.4 and horizons from 3 to 5 spacings. */
static double tip_offset (const pg_problem *p)
{
    (void) p;
    return 0.05;
}

static pg_status read (pg_problem *p, const pg_scene *scene) { return bond_force_read (p, scene, check); }

const pg_force_type pg_force_lps = {
    .method = { .name = "lps",
                .summary = "ordinary state-based peridynamics, any Poisson's ratio (Silling et al. 2007)",
                .keys = { &bond_force_keys, &state_based_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY | PG_NEEDS_FACETS,
                .tip_offset = tip_offset,
                .long_range = long_range,
                .rule = rule,
                .read = read,
                .limits = bond_force_limits,
                .ghosts = 2,
                BOND_FORCE_METHOD },
    .create = state_based_create,
    BOND_FORCE_COMMON
};
