/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks, before anything large is built, that a scene can be divided among ranks (perigal/ranks.h); what is
 * not supported is reported as an error with its reason. */
#include "model.h"
#include <stdio.h>
#include <string.h>

/* Keys not supported in parallel runs, and why. */
static const struct {
    const char *key, *why;
} alone[] = {
    { "platens", "platens press the body of one process only so far" },
    { "reference", "results are compared with a reference by one process only: perigal compare" },
};

/* Obstacles to a division: n: their number; quiet: 1: only counted, 0: reported as errors of the scene. */
typedef struct { const pg_scene *scene; int quiet, n; } against;

static void refuse (against *a, const char *key, const char *why)
{
    a->n++;
    if (!a->quiet) pg_scene_fault (a->scene, key, "%d ranks: %s", pg_rank_count (), why);
}

static int is (const pg_scene *scene, const char *key, const char *word)
{
    return strcmp (pg_scene_text (scene, "%s", key), word) == 0;
}

/* Checks for forces with shape functions, which are evaluated in cells. */
static void check_cells (against *a)
{
    char path[64];
    if (!pg_scene_entry_is (a->scene, "solver.kind", PG_SOLVER_IMPLICIT))
        refuse (a, "solver.kind", "galerkin in explicit steps is for one process only so far: use newmark");
    if (pg_scene_bool (a->scene, "solver.plain"))
        refuse (a, "solver.plain", "goes with one process only for force: galerkin");
    for (size_t i = 0; i < pg_scene_count (a->scene, "boundary"); i++) {
        snprintf (path, sizeof path, "boundary[%zu].set", i);
        if (pg_scene_given (a->scene, "%s", path) && is (a->scene, path, "cracks"))
            refuse (a, path, "a pressure in cracks is for one process only so far");
    }
}

/* Checks for equilibria and implicit time integration. */
static void check_implicit (against *a)
{
    const pg_criterion_type *type = pg_criterion_find (pg_scene_text (a->scene, "failure.criterion"));
    if (!is (a->scene, "solver.linear", "auto"))
        refuse (a, "solver.linear",
                "division: subdomains goes with conjugate gradients alone (linear: auto)");
    if (type && (type->needs & PG_NEEDS_FACETS))
        refuse (a, "failure.criterion", "facets grow in the whole body only: use division: matrices");
    if (is (a->scene, "solver.mass", "consistent") || is (a->scene, "solver.motion.mass", "consistent"))
        refuse (a, is (a->scene, "solver.mass", "consistent") ? "solver.mass" : "solver.motion.mass",
                "with division: subdomains masses are lumped so far: use lumped, or division: matrices");
}

static void check_all (against *a, const pg_method *method)
{
    const pg_scene *scene = a->scene;
    const char *kind = pg_scene_text (scene, "solver.kind");
    char text[160];
    for (size_t k = 0; k < sizeof alone / sizeof *alone; k++)
        if (pg_scene_given (scene, "%s", alone[k].key)) refuse (a, alone[k].key, alone[k].why);
    if (!is (scene, "contact.kind", "none"))
        refuse (a, "contact.kind", "contact is for one process only so far");
    if (pg_scene_bool (scene, "output.stress_intensity"))
        refuse (a, "output.stress_intensity",
                "J and K are taken from fields around each tip, of which a rank that divides the body holds "
                "a part: use one process, or, for equilibria, division: matrices");
    snprintf (text, sizeof text, "%s is not divided among ranks so far", method->name);
    if (method->ghost_cells) check_cells (a);
    if (!(method->ghosts > 0)) refuse (a, "method.force", text);
    if (pg_scene_entry_is (a->scene, "solver.kind", PG_SOLVER_IMPLICIT)) check_implicit (a);
    snprintf (text, sizeof text, "%s is for one process only so far", kind);
    if (!pg_scene_entry_is (a->scene, "solver.kind", PG_SOLVER_RANKS)) refuse (a, "solver.kind", text);
}

/* Returns 1: for shape functions without a lattice the built problem may turn out not to be divisible
 * (projected dilatation, supports by elimination); division: auto then avoids subdomains. */
static int may_be_refused (const pg_scene *scene, const pg_method *method)
{
    const char *mode = pg_scene_text (scene, "method.dilatation"), *name, *surface, *how;
    char path[64];
    int points = pg_scene_given (scene, "points"), yes = 0;
    if (!method->ghost_cells || !(points || pg_scene_given (scene, "mesh"))) return 0;
    for (size_t i = 0; (name = pg_scene_name (scene, i, "materials")); i++)
        yes |= strcmp (mode, "projected") == 0
               || (strcmp (mode, "auto") == 0
                   && pg_scene_number (scene, "materials.%s.poissons_ratio", name) > 0.449);
    surface = pg_scene_text (scene, "surface");
    if (!points || pg_scene_count (scene, "body") || strcmp (surface, "none") != 0) return yes;
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        snprintf (path, sizeof path, "boundary[%zu].essential", i);
        how = pg_scene_text (scene, "%s", pg_scene_given (scene, "%s", path) ? path : "method.essential");
        yes |= strcmp (how, "penalty") != 0;
    }
    return yes;
}

int pg_subdomain_can (const pg_method *method, const pg_scene *scene)
{
    against a = { .scene = scene, .quiet = 1 };
    check_all (&a, method);
    return a.n == 0 && !may_be_refused (scene, method);
}

pg_status pg_subdomain_check (const pg_method *method, const pg_scene *scene)
{
    against a = { .scene = scene };
    check_all (&a, method);
    return pg_scene_verdict (scene);
}

/* Number of horizons of ghosts: those of the force; one more if breaking depends on more than the two ends of
 * a bond (such as the energy of a point, a sum over all its bonds); one more with a surface correction, which
 * depends on the families of both ends. */
static double ghost_layers (const pg_method *method, const pg_scene *scene, int dim, const pg_approx *approx,
                            double h)
{
    const int of_ends = PG_NEEDS_STRETCH | PG_NEEDS_BEAMS;
    const char *plane = pg_scene_text (scene, "plane");
    int judged = 0, strained = plane && strcmp (plane, "strain") == 0;
    pg_mode mode = dim == 1 ? PG_LINE : dim == 3 ? PG_SOLID : strained ? PG_PLANE_STRAIN : PG_PLANE_STRESS;
    pg_sum_rule rule = { .surface = PG_SURFACE_NONE };
    if (pg_scene_given (scene, "failure")) {
        const pg_criterion_type *c = NULL;
        if (pg_scene_given (scene, "failure.criterion"))
            c = pg_criterion_find (pg_scene_text (scene, "failure.criterion"));
        judged = !c || (c->needs & ~of_ends);
    }
    if (method->rule) method->rule (&rule, scene, mode, approx, h, 1);
    return method->ghosts + judged + (rule.surface != PG_SURFACE_NONE);
}

pg_status pg_subdomain_width (double *width, const pg_method *method, const pg_scene *scene, int dim,
                              double h)
{
    pg_status status = PG_OK;
    pg_approx approx = { 0 };
    double beyond;
    PG_TRY (pg_method_approx (&approx, method, scene, h));
    /* without a lattice partial volumes extend half a spacing beyond the horizon, and perturbed points are
     * off their sites */
    double amount = pg_scene_number (scene, "perturb.amount");
    if (method->ghost_cells) {
        *width = method->ghosts * approx.horizon + (method->ghost_cells (scene, &beyond) + 2 * amount) * h;
        goto done;
    }
    if (amount > 0 || pg_scene_given (scene, "points") || pg_scene_given (scene, "mesh"))
        approx.horizon += (0.5 + (amount > 0 ? 2 * amount : 0)) * h;
    *width = ghost_layers (method, scene, dim, &approx, h) * approx.horizon;
done:
    return status;
}
