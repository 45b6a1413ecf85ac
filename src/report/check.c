/* SPDX-License-Identifier: GPL-3.0-or-later
 * What of output a body of this dimension can show: names of pictures (a scalar, a vector's size, or a part), names given once. */
#include "result.h"
#include <stdio.h>
#include <string.h>

/* "damage|displacement|displacement.x|...|stress.xx|..." */
static void picture_names (int dim, char *out, size_t size)
{
    static const char *const vector[] = { "displacement", "velocity" }, *const tensor[] = { "stress", "strain" };
    size_t at = (size_t) snprintf (out, size, "damage");
    for (int f = 0; f < 2; f++) {
        at += (size_t) snprintf (out + at, size - at, "|%s", vector[f]);
        for (int k = 0; k < dim; k++) at += (size_t) snprintf (out + at, size - at, "|%s.%c", vector[f], "xyz"[k]);
    }
    for (int f = 0; f < 2; f++) {
        if (dim == 1) at += (size_t) snprintf (out + at, size - at, "|%s", tensor[f]);
        for (int k = 0; k < pg_voigt_size (dim); k++) at += (size_t) snprintf (out + at, size - at, "|%s.%s", tensor[f], result_voigt (dim, k));
    }
}

static int among (const char *names, const char *name)
{
    char framed_names[600], framed[128];
    snprintf (framed_names, sizeof framed_names, "|%s|", names);
    snprintf (framed, sizeof framed, "|%.100s|", name);
    return !strchr (name, '|') && strstr (framed_names, framed) != NULL;
}

static void given_once (const pg_scene *scene, const char *key)
{
    const char *a, *b;
    char path[64];
    for (size_t i = 1; (a = pg_scene_name (scene, i, "%s", key)); i++)
        for (size_t k = 0; k < i && (b = pg_scene_name (scene, k, "%s", key)); k++) {
            if (strcmp (a, b) != 0) continue;
            snprintf (path, sizeof path, "%s[%zu]", key, i);
            pg_scene_fault (scene, path, "is given twice");
            break;
        }
}

static void fault_of_picture (const pg_scene *scene, size_t i, const char *name, const char *names)
{
    char path[64], listed[800];
    size_t n = 0;
    for (const char *c = names; *c; c++) {
        if (*c == '|') listed[n++] = ',', listed[n++] = ' ';
        else listed[n++] = *c;
    }
    listed[n] = 0;
    const char *near = pg_nearest_name (name, names);
    snprintf (path, sizeof path, "output.pictures[%zu]", i);
    if (near) pg_scene_fault (scene, path, "there is no such picture; did you mean %s? One of %s", near, listed);
    else pg_scene_fault (scene, path, "there is no such picture: one of %s", listed);
}

pg_status pg_result_check (const pg_scene *scene, const pg_problem *problem)
{
    char names[512];
    const char *name;
    size_t count = 0;
    picture_names (problem->dim, names, sizeof names);
    for (; (name = pg_scene_name (scene, count, "output.pictures")); count++)
        if (!among (names, name)) fault_of_picture (scene, count, name, names);
    if (count >= MOST_PICTURES) pg_scene_fault (scene, "output.pictures", "at most %d pictures", MOST_PICTURES - 1);
    given_once (scene, "output.pictures");
    given_once (scene, "output.fields");
    return pg_scene_verdict (scene);
}
