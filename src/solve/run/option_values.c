/* SPDX-License-Identifier: GPL-3.0-or-later
 * What every reader of solver options needs: numbers of the scene, faults at their keys. */
#include "solve.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

static int given (const pg_scene *scene, const char *key) { return pg_scene_given (scene, "%s", key); }

/* Reports a fault: at its key while there is a scene; as an error to a program that has set the options by
 * itself. */
pg_status options_fault (const pg_solver_options *o, const char *key, const char *format, ...)
{
    char text[1000];
    va_list args;
    va_start (args, format);
    vsnprintf (text, sizeof text, format, args);
    va_end (args);
    if (!o->scene) return pg_error (PG_E_SCENE, PG_HERE, "%s: %s", key, text);
    pg_scene_fault (o->scene, key, "%s", text);
    return pg_scene_verdict (o->scene);
}

pg_status options_blame (pg_status status, const pg_solver_options *o, const char *key)
{
    return o->scene ? pg_scene_blame (o->scene, key, status) : status;
}

/* The number of a key of the scene; 0 where it is not given, even if it has a default. */
double options_number (const pg_scene *scene, const char *key)
{
    return given (scene, key) ? pg_scene_number (scene, "%s", key) : 0;
}

/* The whole number of a key of the scene; without the key 0, also where the key has a default. */
long options_integer (const pg_scene *scene, const char *key)
{
    return given (scene, key) ? pg_scene_integer (scene, "%s", key) : 0;
}

/* Do new cracks begin where a strength is reached? */
int options_begin_cracks (const pg_problem *problem)
{
    const double origin[3] = { 0, 0, 0 };
    for (size_t m = 0; m < problem->nmaterial; m++) {
        const pg_criterion *c = &problem->criterion[m];
        pg_fracture_limits limits = { .strength = INFINITY };
        if (!c->type || c->never || !pg_criterion_of_tips (c)) continue;
        c->type->fracture (c, origin, 0, &limits);
        if (isfinite (limits.strength) && limits.strength > 0) return 1;
        if (limits.cohesion > 0) return 1;
    }
    return 0;
}
