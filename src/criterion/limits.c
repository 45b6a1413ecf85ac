/* SPDX-License-Identifier: GPL-3.0-or-later
 * The limits of a criterion: those of materials.NAME.failure before those of failure; which are missing,
 * which would be ignored. */
#include "entries.h"
#include <stdio.h>
#include <string.h>

static const char *const limits[] = { "critical_stretch", "fracture_energy", "wc_factor",
                                      "stretch",          "modes",           "tensile_strength",
                                      "cohesion",         "friction_angle" };
enum { NLIMIT = sizeof limits / sizeof *limits, WORD = 32 };

/* The words of a need, "a" or "a or b". */
static int words_of (const char *need, char word[2][WORD])
{
    return sscanf (need, "%31s or %31s", word[0], word[1]);
}

static int given_in (const pg_scene *scene, const char *map, const char *need)
{
    char word[2][WORD];
    int n = words_of (need, word), found = 0;
    for (int k = 0; k < n; k++) found |= pg_scene_given (scene, "%s.%s", map, word[k]);
    return found;
}

static void own_map (char *map, const char *material)
{
    snprintf (map, PG_LIMITS, "materials.%.63s.failure", material);
}

int pg_criterion_holder (char map[PG_LIMITS], const pg_scene *scene, const pg_criterion_setting *setting,
                         const char *need)
{
    if (setting->material) {
        own_map (map, setting->material);
        if (given_in (scene, map, need)) return 1;
    }
    snprintf (map, PG_LIMITS, "failure");
    return given_in (scene, map, need);
}

double pg_criterion_limit (const pg_scene *scene, const pg_criterion_setting *setting, const char *limit)
{
    char map[PG_LIMITS];
    return pg_criterion_holder (map, scene, setting, limit) ? pg_scene_number (scene, "%s.%s", map, limit)
                                                            : 0;
}

int pg_criterion_never (const pg_scene *scene, const pg_criterion_setting *setting)
{
    return setting->material && pg_scene_bool (scene, "materials.%s.failure.never", setting->material);
}

static int takes (const pg_criterion_type *type, const char *limit)
{
    char word[2][WORD];
    if (type->option && strcmp (type->option, limit) == 0) return 1;
    for (size_t k = 0; k < PG_MOST_LIMITS && type->limit[k]; k++)
        for (int i = words_of (type->limit[k], word); i-- > 0;) if (strcmp (word[i], limit) == 0) return 1;
    return 0;
}

/* Limits given in a map that nothing asks for. */
static void superfluous (const pg_scene *scene, const pg_criterion_type *type, const char *map, int never)
{
    for (size_t k = 0; k < NLIMIT; k++) {
        char path[PG_LIMITS + WORD];
        snprintf (path, sizeof path, "%s.%s", map, limits[k]);
        if (!pg_scene_given (scene, "%s", path)) continue;
        if (never) pg_scene_fault (scene, path, "has no effect: bonds of this material never break");
        else if (!takes (type, limits[k]))
            pg_scene_fault (scene, path, "has no effect with the criterion %s", type->name);
    }
}

/* "failure.a", "either failure.a or failure.b" */
static void spell (char *text, size_t size, const char *need)
{
    char word[2][WORD];
    if (words_of (need, word) > 1) snprintf (text, size, "either failure.%s or failure.%s", word[0], word[1]);
    else snprintf (text, size, "failure.%s", word[0]);
}

/* A limit that all lack is one fault, else each material that lacks it is one. */
static void missing (const pg_scene *scene, const pg_criterion_type *type, const char *need, size_t n,
                     const pg_criterion_setting *setting)
{
    char map[PG_LIMITS], path[PG_LIMITS], text[3 * WORD];
    size_t lacking = 0, judged = 0;
    for (size_t i = 0; i < n; i++) {
        if (pg_criterion_never (scene, &setting[i])) continue;
        judged++;
        lacking += !pg_criterion_holder (map, scene, &setting[i], need);
    }
    spell (text, sizeof text, need);
    if (lacking && lacking == judged)
        pg_scene_fault (scene, "failure.criterion", "%s needs %s", type->name, text);
    for (size_t i = 0; lacking < judged && i < n; i++) {
        if (pg_criterion_never (scene, &setting[i]) || pg_criterion_holder (map, scene, &setting[i], need))
            continue;
        snprintf (path, sizeof path, "materials.%.63s", setting[i].material);
        pg_scene_fault (scene, path, "%s needs %s, or the same in %s.failure", type->name, text, path);
    }
}

void pg_criterion_check (const pg_scene *scene, const pg_criterion_type *type, size_t n,
                         const pg_criterion_setting *setting)
{
    char map[PG_LIMITS];
    if (type) superfluous (scene, type, "failure", 0);
    for (size_t i = 0; i < n; i++) {
        if (!setting[i].material) continue;
        own_map (map, setting[i].material);
        if (type) superfluous (scene, type, map, pg_criterion_never (scene, &setting[i]));
        else if (pg_scene_given (scene, "%s", map) && !pg_scene_given (scene, "failure"))
            pg_scene_fault (scene, map, "has no effect without failure.criterion, which all materials share");
    }
    for (size_t k = 0; type && k < PG_MOST_LIMITS && type->limit[k]; k++)
        missing (scene, type, type->limit[k], n, setting);
}
