/* SPDX-License-Identifier: GPL-3.0-or-later
 * The catalogue of integrations: the entries of list.h as a table and as a string of names. */
#include "perigal/integration.h"
#include <string.h>

/* Each pass over list.h gives the macro another meaning: declarations, table, names. */
#define PG_INTEGRATION(name) extern const pg_integration_type pg_integration_##name;
#include "list.h"
#undef PG_INTEGRATION

/* Pointers to all entries, in the order of list.h. */
static const pg_integration_type *const entries[] = {
#define PG_INTEGRATION(name) &pg_integration_##name,
#include "list.h"
#undef PG_INTEGRATION
};
enum { COUNT = sizeof entries / sizeof *entries };

const pg_integration_type *pg_integration_find (const char *name)
{
    for (size_t i = 0; i < COUNT; i++) if (strcmp (entries[i]->name, name) == 0) return entries[i];
    return NULL;
}

const pg_integration_type *pg_integration_at_nodes (void)
{
    for (size_t i = 0; i < COUNT; i++) if (entries[i]->at_nodes) return entries[i];
    return NULL;
}

/* The literal begins with a separator, which is skipped. */
const char *pg_integration_names (void)
{
    static const char names[] = ""
#define PG_INTEGRATION(name) "|" #name
#include "list.h"
#undef PG_INTEGRATION
    ;
    return names + 1;
}

/* Points of a file without a body or a surface have no cells. */
static int has_cells (const pg_scene *scene)
{
    const char *surface = pg_scene_text (scene, "surface");
    return !pg_scene_given (scene, "points") || pg_scene_count (scene, "body") > 0
           || (surface && strcmp (surface, "none") != 0);
}

const pg_integration_type *pg_integration_of (const pg_scene *scene, int needed)
{
    if (pg_scene_given (scene, "method.integration"))
        return pg_integration_find (pg_scene_text (scene, "method.integration"));
    for (size_t i = 0; i < COUNT && !has_cells (scene); i++) if (entries[i]->at_nodes) return entries[i];
    const char *basis = pg_scene_text (scene, "method.basis"),
               *how = pg_scene_text (scene, "method.approximation");
    const pg_approx_type *approx = how ? pg_approx_find (how) : NULL;
    int simple = !(basis && strcmp (basis, "quadratic") == 0) && !(approx && approx->interpolates);
    for (size_t i = 0; i < COUNT && needed && simple; i++) if (entries[i]->consistent) return entries[i];
    return entries[0];
}
