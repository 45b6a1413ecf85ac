/* SPDX-License-Identifier: GPL-3.0-or-later
 * Whether several processes divide the points of a body, or share its matrices. */
#include "perigal/plan.h"
#include <string.h>

/* 1: the body is so large that one process would solve it without a factor, by its forecast. */
static int is_large (const pg_scene *scene, const pg_method *const *methods)
{
    pg_forecast f = { 0 };
    pg_ranks_divide (0);                               /* every rank counts the whole body */
    return pg_forecast_scene (&f, scene, methods) == PG_OK && !f.linear;
}

int pg_subdomain_wanted (const pg_scene *scene, const pg_method *const *methods)
{
    const pg_method *method = pg_method_of (methods, scene);
    const char *division = pg_scene_text (scene, "solver.division");
    if (!pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_IMPLICIT)) return 1;
    if (strcmp (division, "auto") != 0) return strcmp (division, "subdomains") == 0;
    if (pg_rank_count () < 2 || !method) return 0;
    return pg_subdomain_can (method, scene) && is_large (scene, methods);
}
