/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reading of forces between points from the scene: keys, how bonds are summed (theory A1 to A3), checks. */
#include "bond_force_scene.h"
#include <math.h>
#include <string.h>

/* ---- keys ---------------------------------------------------------------------------------------------- */
static const char *const no_choice = NULL;
static const pg_key keys[] = {
    { "method.evaluation", PG_NAME, NULL, NULL, "auto", "auto|stencil|list|fft", NULL, NULL,
      "by the stencil of a lattice, by lists of neighbours, or by fast Fourier transforms (a lattice, "
      "linear stretch); the answer is the same, auto "
      "takes what is faster for so many points and bonds." },
    { "method.partial_volume", PG_NAME, NULL, NULL, "auto", "auto|none|linear|overlap", NULL, NULL,
      "share of a neighbour's volume that counts: none: all or nothing; linear: falls over one spacing "
      "at the horizon; overlap: of its cell and the "
      "ball; auto: overlap on a lattice (none for a kernel that is zero at the horizon, except in 3D), else "
      "linear." },
    { "method.calibrate", PG_BOOL, NULL, NULL, "on", no_choice, NULL, NULL,
      "the force constant is scaled so that the energy of hydrostatic strain is exact on this lattice, "
      "and a critical stretch that comes from "
      "fracture_energy so that a straight crack along the lattice consumes it." },
    { "method.surface_correction", PG_NAME, NULL, NULL, "auto", "auto|none|product|volume", NULL, NULL,
      "stiffens bonds of points near the surface, whose families are cut off; auto: none below a horizon "
      "of 4 spacings (where it increases the error), else product." },
    { "method.stretch", PG_NAME, NULL, NULL, "linear", "linear|finite", NULL, NULL,
      "force from the stretch along the undeformed bond (small displacements), or from the deformed "
      "length along the deformed bond (verlet, central, "
      "adr, relax only)." },
};
const pg_key_table bond_force_keys = { "force", keys, sizeof keys / sizeof *keys };

static const pg_key dilatation_keys[] = {
    { "method.weighted_volume", PG_NAME, NULL, NULL, "intact", "intact|live", NULL, NULL,
      "the weighted volume q of a point, which its dilatation and forces are divided by: intact: of the "
      "bonds that no pre-crack cuts, for the whole run; live (the default where cracks grow by facets): "
      "of the unbroken bonds, so that the rest of a "
      "family behaves as if it had always been alone (stiffer near new cracks; small time steps)." },
};
const pg_key_table state_based_keys = { "force", dilatation_keys,
                                        sizeof dilatation_keys / sizeof *dilatation_keys };

static int is (const pg_scene *scene, const char *key, const char *word)
{
    const char *text = pg_scene_text (scene, "%s", key);
    return text && strcmp (text, word) == 0;
}

/* ---- rule ---------------------------------------------------------------------------------------------- */
/* Returns about how many sums of forces the run will need, for the choice of transforms. */
static double evaluations_of (const pg_scene *scene)
{
    if (pg_scene_has (scene, "solver.time_steps"))
        return (double) pg_scene_integer (scene, "solver.time_steps");
    if (pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_STATIC)) return 200;
    return 1000;
}

/* Values "auto" are chosen by points and kernel: overlaps of cells need a lattice, and surface corrections
 * increase the error below a horizon of four spacings. */
void bond_force_rule (pg_sum_rule *rule, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                       double spacing, int lattice)
{
    static const char partial[] = "method.partial_volume", surface[] = "method.surface_correction",
                      evaluation[] = "method.evaluation";
    *rule = (pg_sum_rule) { .mode = mode, .kernel = approx->kernel, .horizon = approx->horizon };
    /* with a kernel that vanishes at the horizon whole cells are more isotropic (theory A2: quadratic, m =
     * 3) */
    int fading = !approx->kernel->closed && mode != PG_SOLID;
    rule->partial = is (scene, partial, "none")      ? PG_PARTIAL_NONE
                    : is (scene, partial, "linear")  ? PG_PARTIAL_LINEAR
                    : is (scene, partial, "overlap") ? PG_PARTIAL_OVERLAP
                    : !lattice                       ? PG_PARTIAL_LINEAR
                    : fading                         ? PG_PARTIAL_NONE
                                                     : PG_PARTIAL_OVERLAP;
    rule->surface = is (scene, surface, "product")  ? PG_SURFACE_PRODUCT
                    : is (scene, surface, "volume") ? PG_SURFACE_VOLUME
                    : is (scene, surface, "none") || approx->horizon < 4 * spacing * (1 - 1e-9)
                        ? PG_SURFACE_NONE
                        : PG_SURFACE_PRODUCT;
    rule->calibrate = pg_scene_bool (scene, "method.calibrate");
    rule->finite = is (scene, "method.stretch", "finite");
    rule->evaluation = is (scene, evaluation, "stencil") ? PG_EVALUATE_STENCIL
                       : is (scene, evaluation, "list")  ? PG_EVALUATE_LIST
                       : is (scene, evaluation, "fft")   ? PG_EVALUATE_FFT
                                                         : PG_EVALUATE_AUTO;
    rule->evaluations = evaluations_of (scene);
}

/* Does the scene have a criterion of crack tips? Weighted volumes then follow intact bonds by default, so
 * that cracks that have grown act as pre-cracks do. */
static int grows_by_facets (const pg_scene *scene)
{
    const pg_criterion_type *c = pg_scene_given (scene, "failure")
                                     ? pg_criterion_find (pg_scene_text (scene, "failure.criterion")) : NULL;
    return c && (c->needs & PG_NEEDS_FACETS);
}

/* Weighted volumes count the bonds of the start, or (rule->follow) those that are intact. */
void bond_force_rule_with_dilatation (pg_sum_rule *rule, const pg_scene *scene)
{
    static const char key[] = "method.weighted_volume";
    rule->state = 1;
    rule->follow = is (scene, key, "live") || (!pg_scene_given (scene, key) && grows_by_facets (scene));
}

void bond_force_refuse_matrix (const pg_problem *p, const pg_scene *scene, const char *of)
{
    const pg_linear_type *linear = pg_linear_find (pg_scene_text (scene, "solver.linear"));
    if (linear && linear->factors)
        pg_scene_fault (scene, "solver.linear",
                        "force: %s%s reaches its neighbours' neighbours and has no matrix, only its product: "
                        "use pcg or auto",
                        p->method->name, of);
}

/* ---- sums ---------------------------------------------------------------------------------------------- */
/* Do the points lie on the sites of a lattice, which stencils and transforms need? */
static pg_status on_lattice (const pg_problem *p, int *yes)
{
    pg_sites sites = { 0 };
    pg_status status = pg_sites_build (&sites, &p->cloud, p->lattice.dim ? &p->lattice : NULL);
    *yes = status == PG_OK && sites.count[0] > 0;
    pg_sites_clear (&sites);
    return status;
}

/* Reports all faults of the scene together before the sums (p->sums) are made. */
pg_status bond_force_read (pg_problem *p, const pg_scene *scene, bond_force_check check)
{
    pg_status status = PG_OK;
    pg_sum_rule rule;
    int lattice;
    char why[256];
    p->form.integration = pg_integration_at_nodes ();
    PG_TRY (on_lattice (p, &lattice));
    p->method->rule (&rule, scene, p->mode, &p->form.approx, p->cloud.h, lattice);
    check (p, scene, &rule);
    if (!lattice && rule.partial == PG_PARTIAL_OVERLAP)
        pg_scene_fault (
            scene, "method.partial_volume",
            "overlap needs the cells of a lattice, and these points lie on none: use linear or none");
    /* stencils and transforms have one weight for all bonds of an offset */
    int alike = rule.evaluation == PG_EVALUATE_STENCIL || rule.evaluation == PG_EVALUATE_FFT;
    if (!lattice && alike)
        pg_scene_fault (scene, "method.evaluation",
                        "%s a lattice, and these points lie on none: use list or auto",
                        rule.evaluation == PG_EVALUATE_FFT ? "transforms need" : "a stencil needs");
    if (rule.finite && rule.evaluation == PG_EVALUATE_FFT)
        pg_scene_fault (scene, "method.evaluation",
                        "with stretch: finite forces are not linear in the displacement, and fft sums linear "
                        "ones: use stencil, list or auto");
    if (rule.surface == PG_SURFACE_VOLUME && alike)
        pg_scene_fault (
            scene, "method.evaluation",
            "with surface_correction: volume every bond has a weight of its own: use list or auto");
    PG_TRY (pg_scene_verdict (scene));
    rule.threads = p->threads;
    status = pg_sums_create (&p->sums, &rule, &p->cloud, p->lattice.dim ? &p->lattice : NULL);
    if (status == PG_E_USAGE) {  /* points or horizon do not fit: a fault of the scene, not of the caller */
        snprintf (why, sizeof why, "%s", pg_last_error ());
        pg_scene_fault (scene, "method.force", "%s: %s", p->method->name, why);
        PG_TRY (pg_scene_verdict (scene));
    }
done:
    return status;
}

/* Reports properties that vary over the body, of those that stencils and transforms need to be constant:
 * stiffness of pair and micropolar forces, limits of bonds. (Limits of points and tips, and constants of
 * state-based forces, are read point by point and may vary.) */
static void refuse_fields (const pg_problem *p, const pg_scene *scene)
{
    const pg_criterion *c = p->criterion;
    int at_points = !pg_criterion_of_bonds (c) || (c->type->needs & PG_NEEDS_ENERGY),
        state = p->sums->rule.state && !p->sums->rule.beams;
    pg_evaluation how = p->sums->rule.evaluation;
    if (how != PG_EVALUATE_STENCIL && how != PG_EVALUATE_FFT) return;
    for (size_t m = 0; p->at.vary && m < p->nmaterial; m++)
        for (int k = 0; k < PG_OF_COUNT; k++) {
            int stiff = k == PG_OF_STIFFNESS;
            if (!p->at.vary[m].of[k] || (stiff ? state && at_points : at_points)) continue;
            pg_scene_fault (scene, "method.evaluation",
                            "%s of material %.40s is an expression of place, and bonds must all be alike for "
                            "this: use list or auto%s",
                            pg_variation_name (k, NULL), p->material[m].name,
                            pg_scene_given (scene, "method.evaluation") ? "" : ", which force: bond does");
            return;
        }
}

/* Reports materials that differ if the scene asks for a stencil or transforms, which have one constant for
 * all bonds of an offset. */
void bond_force_check_laws (const pg_problem *p, const pg_scene *scene)
{
    pg_evaluation asked = p->sums->rule.evaluation;
    refuse_fields (p, scene);
    for (size_t m = 1; m < p->nmaterial && asked != PG_EVALUATE_AUTO && asked != PG_EVALUATE_LIST; m++) {
        const pg_criterion *a = &p->criterion[0], *b = &p->criterion[m];
        /* criteria of points or tips: the loops over bonds have no limits */
        int at_points = a->type && (a->type->needs & (PG_NEEDS_ENERGY | PG_NEEDS_FACETS));
        /* state-based loops have the constants of each point */
        int alike = (p->sums->rule.state && !p->sums->rule.beams)
                    || (p->material[m].modulus == p->material[0].modulus
                        && (!p->sums->rule.beams || p->material[m].nu == p->material[0].nu));
        int same = alike
                   && (at_points
                       || (a->never == b->never
                           && memcmp (a->parameter, b->parameter, sizeof a->parameter) == 0));
        if (same) continue;
        pg_scene_fault (scene, "method.evaluation",
                        "materials %.40s and %.40s differ in stiffness or limit, and bonds must all be alike "
                        "for this: use list or auto",
                        p->material[0].name, p->material[m].name);
        return;
    }
}

/* ---- criteria and texts -------------------------------------------------------------------------------- */
/* Fills in what the criterion needs to know of the force; toughness: with it a critical stretch from a
 * fracture energy consumes that energy on these points. */
pg_status bond_force_limits (const pg_problem *p, size_t material, pg_criterion_setting *setting)
{
    const pg_sum_rule *rule = &p->sums->rule;
    const pg_material *m = &p->material[material];
    setting->graded = 0;
    setting->toughness = rule->calibrate ? pg_sums_toughness (p->sums, m->modulus, m->nu) : 0;
    setting->growth = pg_sums_growth (p->sums);
    setting->stretch = rule->finite ? "finite" : "linear";
    setting->state = rule->state && !rule->beams;
    return PG_OK;
}

/* Points beside a crack have lost the bonds across it, and stiffness with them: the crack acts as a longer
 * one, by this offset (spacings). Measured on an edge crack of half the width in tension, sqrt (E J) against
 * K in closed form, on nine lattices: at 20 spacings +4.1 % at a horizon of 3 spacings, +4.5 % at 4, +5.5 %
 * at 5; half of that at 40 spacings. */
double bond_force_tip_offset (const pg_problem *p)
{
    double m = p->form.approx.horizon / p->cloud.h;
    return m < 4 ? 0.40 + 0.02 * (fmax (m, 3) - 3) : 0.42 + 0.08 * (fmin (m, 5) - 4);
}

/* Writes a line about the force for the plan of a run. */
void bond_force_words (const pg_problem *p, char *text, size_t size)
{
    snprintf (text, size, "force %s, %s kernel", p->method->name, p->form.approx.kernel->name);
}
