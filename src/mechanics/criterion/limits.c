/* SPDX-License-Identifier: GPL-3.0-or-later
 * The limits of a criterion: those of materials.NAME.failure come before those of failure; checks which are
 * missing, and which would be ignored. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { WORD = 32, NEED = 3 * WORD };

/* Splits a need, "a" or "a or b", into its one or two words; returns how many. */
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

/* A material's own limits come before those of `failure`; of "a or b" the material has its own if it gives
 * either. */
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
    char map[PG_LIMITS], path[PG_LIMITS + WORD];
    int given = pg_criterion_holder (map, scene, setting, limit);
    double value = pg_scene_number (scene, "%s.%s", map, limit);
    if (!given) return isnan (value) ? 0 : value;      /* its default, if the key has one */
    snprintf (path, sizeof path, "%s.%s", map, limit);
    if (!isnan (value)) return value;
    int of = pg_limit_of_place (limit);
    if (setting->reference && of >= 0) value = setting->reference[of];
    if (isnan (value))
        pg_scene_fault (scene, path,
                        "must be one number here: an expression of place and direction goes with criterion: "
                        "%s", pg_criterion_by_need (PG_NEEDS_FACETS));
    return value;
}

int pg_limit_of_place (const char *key)
{
    static const char *const name[PG_OF_COUNT] = { [PG_OF_STIFFNESS] = "youngs_modulus",
                                                   [PG_OF_ENERGY] = "fracture_energy",
                                                   [PG_OF_STRETCH] = "critical_stretch",
                                                   [PG_OF_TENSION] = "tensile_strength",
                                                   [PG_OF_COHESION] = "cohesion" };
    for (int k = 0; k < PG_OF_COUNT; k++) if (strcmp (name[k], key) == 0) return k;
    return -1;
}

int pg_criterion_never (const pg_scene *scene, const pg_criterion_setting *setting)
{
    return setting->material && pg_scene_bool (scene, "materials.%s.failure.never", setting->material);
}

/* ---- calibration --------------------------------------------------------------------------------------- */
double pg_criterion_calibration (pg_criterion *c, const pg_scene *scene, const pg_criterion_setting *setting)
{
    static const char key[] = "failure.calibration";
    c->growth = (pg_growth) { 0, 0, 0 };
    if (strcmp (pg_scene_text (scene, key), "measured") != 0) return 1;
    if (!(setting->growth.mean > 0)) {
        if (pg_scene_given (scene, key))
            pg_scene_fault (scene, key,
                            "how much a growing crack consumes was not measured for these bonds, but for "
                            "those between points of plane lattices with the constant kernel and a horizon "
                            "of 3 to 5 spacings: use theory");
        return 1;
    }
    c->growth = setting->growth;
    return setting->growth.mean;
}

void pg_criterion_by_theory (const pg_scene *scene)
{
    static const char key[] = "failure.calibration";
    if (pg_scene_given (scene, key) && strcmp (pg_scene_text (scene, key), "measured") == 0)
        pg_scene_fault (scene, key, "is for limits of bonds; this criterion has none: leave it out");
}

void pg_criterion_say_growth (const pg_criterion *c, char *text, size_t size)
{
    const pg_growth *g = &c->growth;
    *text = '\0';
    if (g->mean > 0)
        snprintf (text, size,
                  "; limits by measured growth, which consumes %.3g times a straight cut: this energy on the "
                  "mean over directions, %+.0f to %+.0f %% on single lattices",
                  g->mean, 100 * (g->least / g->mean - 1), 100 * (g->most / g->mean - 1));
}

/* ---- keys of a criterion ------------------------------------------------------------------------------- */
static const char *last_word (const pg_key *key) { return strrchr (key->path, '.') + 1; }

/* Returns the key of the k-th limit of a criterion, counted over all its tables; NULL past the end. */
static const pg_key *limit_of (const pg_criterion_type *type, size_t k)
{
    for (pg_key_tables t = type->limits; *t; k -= (*t)->n, t++) if (k < (*t)->n) return &(*t)->key[k];
    return NULL;
}

/* Is the k-th limit in one of the tables whose limits may be left out (pg_criterion_type.needed)? */
static int may_lack (const pg_criterion_type *type, size_t k)
{
    size_t n = 0;
    for (int t = 0; t < type->needed && type->limits[t]; t++) n += type->limits[t]->n;
    return type->needed && k >= n;
}

/* Writes what must be given because of the k-th limit: "a", or "a or b" for the first of a group; "":
 * nothing. Returns 0 past the last limit. */
static int need_of (const pg_criterion_type *type, size_t k, char need[NEED])
{
    const pg_key *key = limit_of (type, k), *other;
    need[0] = '\0';
    if (!key) return 0;
    if (!key->fallback || *key->fallback || may_lack (type, k)) return 1;
    for (size_t j = 0; key->group && j < k; j++)
        if ((other = limit_of (type, j))->group && strcmp (other->group, key->group) == 0) return 1;
    size_t used = (size_t) snprintf (need, NEED, "%s", last_word (key));
    for (size_t j = k + 1; key->group && (other = limit_of (type, j)) && used < NEED; j++)
        if (other->group && strcmp (other->group, key->group) == 0)
            used += (size_t) snprintf (need + used, NEED - used, " or %s", last_word (other));
    return 1;
}

/* Is a table in a list of tables? */
static int holds (pg_key_tables list, const pg_key_table *table)
{
    while (*list && *list != table) list++;
    return *list != NULL;
}

/* Is `table` one of this criterion? */
static int owns (const pg_criterion_type *type, const pg_key_table *table)
{
    return holds (type->limits, table) || holds (type->options, table);
}

/* ---- checks -------------------------------------------------------------------------------------------- */
/* Reports keys of a table that the scene gives in a map without effect. */
static void tell_given (const pg_scene *scene, const pg_criterion_type *type, const pg_key_table *table,
                        const char *map, int never)
{
    for (size_t k = 0; k < table->n; k++) {
        char path[PG_LIMITS + WORD];
        snprintf (path, sizeof path, "%s.%s", map, last_word (&table->key[k]));
        if (!pg_scene_given (scene, "%s", path)) continue;
        if (never) pg_scene_fault (scene, path, "has no effect: bonds of this material never break");
        else if (!owns (type, table))
            pg_scene_fault (scene, path, "has no effect with the criterion %s", type->name);
    }
}

/* Does a criterion before this entry have the table? Shared tables are checked with the first one only. */
static int owned_before (size_t entry, const pg_key_table *table)
{
    for (size_t e = 0; e < entry; e++) if (owns (pg_criterion_entry (e), table)) return 1;
    return 0;
}

/* Reports the keys of all criteria that are given in a map without effect. */
static void superfluous (const pg_scene *scene, const pg_criterion_type *type, const char *map, int never)
{
    const pg_criterion_type *any;
    for (size_t e = 0; (any = pg_criterion_entry (e)); e++) {
        pg_key_tables lists[2] = { any->limits, any->options };
        for (int l = 0; l < 2; l++)
            for (pg_key_tables t = lists[l]; *t; t++)
                if (!owned_before (e, *t)) tell_given (scene, type, *t, map, never);
    }
}

/* Writes a need for messages: "failure.a", or "either failure.a or failure.b". */
static void spell (char *text, size_t size, const char *need)
{
    char word[2][WORD];
    if (words_of (need, word) > 1) snprintf (text, size, "either failure.%s or failure.%s", word[0], word[1]);
    else snprintf (text, size, "failure.%s", word[0]);
}

/* Reports a limit that is needed and missing: one fault if all materials lack it, else one for each that
 * does. */
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

/* Reports first limits that are given without effect, then those that are missing. */
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
    char need[NEED];
    for (size_t k = 0; type && need_of (type, k, need); k++)
        if (*need) missing (scene, type, need, n, setting);
}
