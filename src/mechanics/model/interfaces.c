/* SPDX-License-Identifier: GPL-3.0-or-later
 * Interfaces between two materials that have a fracture energy, and a strength, of their own. Where an
 * interface runs follows from the points: it lies where the material of the nearest evaluation point
 * changes (blocks.c). */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Index of the material named as number `which` (0, 1) in `between` of entry k; -1: error reported. */
static int material_named (const pg_problem *p, const pg_scene *scene, size_t k, size_t which)
{
    const char *name = pg_scene_name (scene, which, "failure.interfaces[%zu].between", k);
    char path[96];
    for (size_t m = 0; name && m < p->nmaterial; m++)
        if (strcmp (p->material[m].name, name) == 0) return (int) m;
    snprintf (path, sizeof path, "failure.interfaces[%zu].between", k);
    pg_scene_fault (scene, path, "must name two materials of the scene");
    return -1;
}

/* Reads failure.interfaces, after the materials; errors become errors of the scene. */
pg_status pg_interfaces_read (pg_problem *p, const pg_scene *scene)
{
    pg_status status = PG_OK;
    char path[96];
    size_t n = 0;
    if (pg_scene_given (scene, "failure.interfaces")) n = pg_scene_count (scene, "failure.interfaces");
    if (n == 0) return PG_OK;
    if (!pg_criterion_of_tips (p->criterion)) {
        pg_scene_fault (scene, "failure.interfaces", "goes with criterion: %s, which judges tips of cracks",
                        pg_criterion_by_need (PG_NEEDS_FACETS));
        return PG_OK;
    }
    if (p->dim == 3) {
        pg_scene_fault (scene, "failure.interfaces", "is for cracks in the plane: fronts in space know no "
                                                     "energy of interfaces");
        return PG_OK;
    }
    PG_ALLOC (p->at.interface, n);
    p->at.ninterface = n;
    for (size_t k = 0; k < n; k++) {
        pg_interface *one = &p->at.interface[k];
        for (size_t side = 0; side < 2; side++) one->material[side] = material_named (p, scene, k, side);
        one->energy = pg_scene_number (scene, "failure.interfaces[%zu].fracture_energy", k);
        one->strength = pg_scene_given (scene, "failure.interfaces[%zu].tensile_strength", k)
                            ? pg_scene_number (scene, "failure.interfaces[%zu].tensile_strength", k) : NAN;
        snprintf (path, sizeof path, "failure.interfaces[%zu].between", k);
        if ((one->material[0] == one->material[1] && one->material[0] >= 0)
            || pg_scene_name (scene, 2, "%s", path))
            pg_scene_fault (scene, path, "must name two different materials");
    }
done:
    return status;
}

const pg_interface *pg_problem_interface (const pg_problem *p, int a, int b)
{
    for (size_t k = 0; k < p->at.ninterface; k++) {
        const int *m = p->at.interface[k].material;
        if ((m[0] == a && m[1] == b) || (m[0] == b && m[1] == a)) return &p->at.interface[k];
    }
    return NULL;
}
