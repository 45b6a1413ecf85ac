/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of approximations, expanded from list.h, and the approximation that a scene asks
 * for. Forces that act between pairs of points need no shape functions: for them the values at
 * the points are the unknowns, and kernel and horizon are those that the force asks for unless
 * the scene gives others. */
#include "entries.h"
#include <string.h>

static const pg_approx_type *const table[] = {
#define PG_APPROX(name) &pg_approx_##name,
#include "list.h"
#undef PG_APPROX
};

static const char names[] =
#define PG_APPROX(name) "|" #name
#include "list.h"
#undef PG_APPROX
    ;

/* Linear search, as the table has a few entries only. */
const pg_approx_type *pg_approx_find (const char *name)
{
    for (size_t i = 0; name && i < sizeof table / sizeof *table; i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    return NULL;
}

const pg_approx_type *pg_approx_first (void) { return table[0]; }

const char *pg_approx_names (void) { return names + 1; }

/* Does the key of the scene have that value? */
static int is (const pg_scene *scene, const char *key, const char *value)
{
    const char *text = pg_scene_text (scene, "%s", key);
    return text && strcmp (text, value) == 0;
}

/* A horizon below one spacing would leave every point without a neighbour; this is said before
 * anything is built. */
static pg_status check_horizon (const pg_approx *a, const pg_scene *scene, double spacing)
{
    if (a->horizon >= spacing * (1 - 1e-9)) return PG_OK;
    pg_scene_fault (scene, "method.horizon",
                    "is %.4g spacings: a point would see no neighbour (use 1.5 or more)",
                        a->horizon / spacing);
    return pg_scene_verdict (scene);
}

/* Reads method.* for shape functions. method.weights `auto` keeps what the approximation prefers. */
pg_status pg_approx_read (pg_approx *out, const pg_scene *scene, double spacing)
{
    pg_status status = PG_OK;
    *out = (pg_approx) { 0 };
    const pg_approx_type *type = pg_approx_find (pg_scene_text (scene, "method.approximation"));
    const pg_kernel *kernel = pg_kernel_find (pg_scene_text (scene, "method.kernel"));
    if (!type || !kernel)
        PG_FAIL (PG_E_USAGE, "method.approximation or method.kernel: unknown");
    pg_approx a = { .type = type, .kernel = kernel, .use_volume = type->use_volume };
    a.order = is (scene, "method.basis", "quadratic") ? 2 : 1;
    a.shape = is (scene, "method.support", "tensor") ? PG_TENSOR : PG_RADIAL;
    if (is (scene, "method.weights", "unit")) a.use_volume = 0;
    if (is (scene, "method.weights", "volume")) a.use_volume = 1;
    a.projected = is (scene, "method.degenerate", "projected");
    a.horizon = pg_scene_length (scene, spacing, "method.horizon");
    PG_TRY (check_horizon (&a, scene, spacing));
    *out = a;
done:
    return status;
}

/* The approximation of forces without shape functions: the first of the table whose N is 1 at its own node;
 * it only serves to sample fields between points. */
pg_status pg_approx_read_points (pg_approx *out, const pg_scene *scene, double spacing, const char *kernel,
                                 double horizon)
{
    pg_status status = PG_OK;
    pg_approx a = { .use_volume = 1, .order = 1, .shape = PG_RADIAL };
    *out = (pg_approx) { 0 };
    for (size_t i = 0; i < sizeof table / sizeof *table && !a.type; i++)
        if (table[i]->interpolates) a.type = table[i];
    a.kernel = pg_kernel_find (pg_scene_given (scene, "method.kernel")
                               ? pg_scene_text (scene, "method.kernel")
                                                                       : kernel);
    if (!a.kernel) PG_FAIL (PG_E_USAGE, "method.kernel: unknown");
    a.horizon = pg_scene_given (scene, "method.horizon") ? pg_scene_length (scene, spacing, "method.horizon")
                                                         : horizon * spacing;
    PG_TRY (check_horizon (&a, scene, spacing));
    *out = a;
done:
    return status;
}
