/* SPDX-License-Identifier: GPL-3.0-or-later
 * What several ranks can share so far (perigal/ranks.h), before anything large is made: the rest is refused
 * with its reason, never run in part. */
#include "model.h"
#include <stdio.h>
#include <string.h>

/* Keys that only one process can follow so far, and why. */
static const struct {
    const char *key, *why;
} alone[] = {
    { "mesh", "meshes are not divided among ranks so far; lattices and points of a file are" },
    { "platens", "platens press the body of one process only so far" },
    { "stages", "stages of loading are for one process only so far" },
    { "reference", "results are compared with a reference by one process only: perigal compare" },
};

/* Loads that act at a place, rather than on a set, choose the points around it by looking at all. */
static void check_loads (const pg_scene *scene)
{
    char path[64];
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        snprintf (path, sizeof path, "boundary[%zu].at", i);
        if (pg_scene_given (scene, "%s", path))
            pg_scene_fault (scene, path, "a load at a place is for one process only so far: name a set");
        snprintf (path, sizeof path, "boundary[%zu].symmetry", i);
        if (pg_scene_given (scene, "%s", path))
            pg_scene_fault (scene, path, "planes of symmetry are for one process only so far: prescribe "
                            "the displacement across it");
    }
}

/* Of forces with shape functions, which are evaluated in cells. */
static void check_cells (const pg_scene *scene, const char *kind)
{
    char path[64];
    if (!pg_solver_is (kind, PG_SOLVER_STATIC))
        pg_scene_fault (scene, "solver.kind", "%d ranks: galerkin in motion is for one process only so far, "
                        "or for division: matrices", pg_rank_count ());
    if (pg_scene_bool (scene, "solver.plain"))
        pg_scene_fault (scene, "solver.plain", "goes with one process only for force: galerkin");
    for (size_t i = 0; i < pg_scene_count (scene, "boundary"); i++) {
        snprintf (path, sizeof path, "boundary[%zu].set", i);
        if (pg_scene_given (scene, "%s", path) && strcmp (pg_scene_text (scene, "%s", path), "cracks") == 0)
            pg_scene_fault (scene, path, "%d ranks: a pressure in cracks is for one process only so far",
                            pg_rank_count ());
    }
}

/* Points that are no lattice are divided without their cells and surface. */
static void check_points (const pg_method *method, const pg_scene *scene)
{
    if (method->ghost_cells && pg_scene_given (scene, "points"))
        pg_scene_fault (scene, "points", "%d ranks: points of a file are divided for forces between points "
                        "only so far", pg_rank_count ());
    if (method->ghost_cells && pg_scene_number (scene, "perturb.amount") > 0)
        pg_scene_fault (scene, "perturb.amount", "%d ranks: perturbed points are divided for forces between "
                        "points only so far", pg_rank_count ());
    const char *surface = pg_scene_text (scene, "surface");
    if (pg_scene_given (scene, "points")
        && (pg_scene_count (scene, "body") || (surface && strcmp (surface, "none") != 0)))
        pg_scene_fault (scene, "points", "%d ranks: points whose surface is known (body, surface) are for "
                        "one process only so far: leave it out, and name sets by where", pg_rank_count ());
}

int pg_subdomain_wanted (const pg_scene *scene)
{
    if (!pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_IMPLICIT)) return 1;
    return strcmp (pg_scene_text (scene, "solver.division"), "subdomains") == 0;
}

pg_status pg_subdomain_check (const pg_method *method, const pg_scene *scene)
{
    const char *kind = pg_scene_text (scene, "solver.kind");
    for (size_t k = 0; k < sizeof alone / sizeof *alone; k++)
        if (pg_scene_given (scene, "%s", alone[k].key))
            pg_scene_fault (scene, alone[k].key, "%d ranks: %s", pg_rank_count (), alone[k].why);
    if (strcmp (pg_scene_text (scene, "contact.kind"), "none") != 0)
        pg_scene_fault (scene, "contact.kind", "%d ranks: contact is for one process only so far",
                        pg_rank_count ());
    if (method->ghost_cells) check_cells (scene, kind);
    if (!(method->ghosts > 0))
        pg_scene_fault (scene, "method.force", "%d ranks: %s is not divided among ranks so far",
                        pg_rank_count (), method->name);
    if (strcmp (pg_scene_text (scene, "solver.linear"), "auto") != 0)
        pg_scene_fault (scene, "solver.linear", "division: subdomains goes with conjugate gradients alone "
                        "(linear: auto)");
    if (!pg_solver_is (kind, PG_SOLVER_RANKS))
        pg_scene_fault (scene, "solver.kind", "%d ranks: %s is for one process only so far",
                        pg_rank_count (), kind);
    check_points (method, scene);
    check_loads (scene);
    return pg_scene_verdict (scene);
}

/* How many horizons of ghosts: what the force needs; one more where bonds break by something else than what
 * their two ends show, as points that die by their energy look at all their bonds; one more where bonds weigh
 * by how full the families of both ends are. */
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

pg_status pg_subdomain_width (double *width, const pg_method *method, const pg_body *body,
                              const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_approx approx = { 0 };
    double h, beyond;
    PG_TRY (pg_cloud_spacing (&h, body, scene));
    PG_TRY (pg_method_approx (&approx, method, scene, h));
    /* off a lattice volumes fall over a spacing about the horizon, and points are not on their sites */
    double amount = pg_scene_number (scene, "perturb.amount");
    if (amount > 0 || pg_scene_given (scene, "points"))
        approx.horizon += (0.5 + (amount > 0 ? 2 * amount : 0)) * h;
    *width = method->ghost_cells ? method->ghosts * approx.horizon
                                       + method->ghost_cells (scene, &beyond) * h
                                 : ghost_layers (method, scene, body->dim, &approx, h) * approx.horizon;
done:
    return status;
}
