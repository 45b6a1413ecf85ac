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
    { "points", "points of a file are not divided among ranks so far; lattices are" },
    { "mesh", "meshes are not divided among ranks so far; lattices are" },
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

int pg_subdomain_wanted (const pg_scene *scene)
{
    if (!pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_IMPLICIT)) return 1;
    return strcmp (pg_scene_text (scene, "solver.division"), "subdomains") == 0;
}

pg_status pg_subdomain_check (const pg_problem *p, const pg_scene *scene)
{
    const char *kind = pg_scene_text (scene, "solver.kind");
    for (size_t k = 0; k < sizeof alone / sizeof *alone; k++)
        if (pg_scene_given (scene, "%s", alone[k].key))
            pg_scene_fault (scene, alone[k].key, "%d ranks: %s", pg_rank_count (), alone[k].why);
    if (strcmp (pg_scene_text (scene, "contact.kind"), "none") != 0)
        pg_scene_fault (scene, "contact.kind", "%d ranks: contact is for one process only so far",
                        pg_rank_count ());
    if (p->method->ghost_cells) check_cells (scene, kind);
    if (!(p->method->ghosts > 0))
        pg_scene_fault (scene, "method.force", "%d ranks: %s is not divided among ranks so far",
                        pg_rank_count (), p->method->name);
    if (strcmp (pg_scene_text (scene, "solver.linear"), "auto") != 0)
        pg_scene_fault (scene, "solver.linear", "division: subdomains goes with conjugate gradients alone "
                        "(linear: auto)");
    if (!pg_solver_is (kind, PG_SOLVER_RANKS))
        pg_scene_fault (scene, "solver.kind", "%d ranks: %s is for one process only so far",
                        pg_rank_count (), kind);
    if (pg_scene_number (scene, "perturb.amount") > 0)
        pg_scene_fault (scene, "perturb.amount", "%d ranks: points that are no lattice are calibrated by one "
                        "process only so far", pg_rank_count ());
    check_loads (scene);
    return pg_scene_verdict (scene);
}
