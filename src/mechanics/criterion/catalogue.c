/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of criteria, and the criterion that the scene asks for. */
#include "entries.h"
#include <stdio.h>
#include <string.h>

static const pg_criterion_type *const table[] = {
#define PG_CRITERION(name) &pg_criterion_##name,
#include "list.h"
#undef PG_CRITERION
};

static const char names[] =
#define PG_CRITERION(name) "|" #name
#include "list.h"
#undef PG_CRITERION
    ;

const pg_criterion_type *pg_criterion_find (const char *name)
{
    for (size_t i = 0; name && i < sizeof table / sizeof *table; i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    return NULL;
}

const char *pg_criterion_by_need (int needs)
{
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (table[i]->needs == needs) return table[i]->name;
    return NULL;
}

const pg_criterion_type *pg_criterion_entry (size_t i)
{
    return i < sizeof table / sizeof *table ? table[i] : NULL;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
static const char *name_of (size_t i) { return pg_criterion_entry (i) ? table[i]->name : NULL; }
static pg_key_tables options_of (size_t i) { return table[i]->options; }
static pg_key_tables limits_of (size_t i) { return table[i]->limits; }

const pg_key_catalogue pg_entry_keys_criterion = {
    .selector = "failure.criterion",
    .name = name_of,
    .keys = options_of,
    .keys_twice = limits_of,
    .also = "materials.{}.",
    .also_doc = "for this material",
};

const char *pg_criterion_names (void) { return names + 1; }

/* All materials have one type of criterion, each its own limits. Faults of all limits are collected before
 * the first is read. */
pg_status pg_criterion_read (pg_criterion *out, size_t n, const pg_scene *scene,
                             const pg_criterion_setting *setting)
{
    pg_status status = PG_OK;
    int given = pg_scene_given (scene, "failure"),
        silent = given && !pg_scene_given (scene, "failure.criterion");
    const char *name = silent ? setting->usual : given ? pg_scene_text (scene, "failure.criterion") : NULL;
    const pg_criterion_type *type = !name || strcmp (name, "none") == 0 ? NULL : pg_criterion_find (name);
    memset (out, 0, n * sizeof *out);
    if (name && !type && strcmp (name, "none"))
        PG_FAIL (PG_E_USAGE, "failure.criterion = %s: this library has no such criterion", name);
    if (silent && !name) pg_scene_fault (scene, "failure.criterion", "is missing: when a bond breaks");
    pg_criterion_check (scene, type, n, setting);
    for (size_t i = 0; type && i < n; i++) {
        out[i].type = type;
        out[i].never = pg_criterion_never (scene, &setting[i]);
        if (!out[i].never) PG_TRY (type->read (&out[i], scene, &setting[i]));
    }
    PG_TRY (pg_scene_verdict (scene));
done:
    return status;
}

int pg_criterion_of_tips (const pg_criterion *c)
{
    return c && c->type && (c->type->needs & PG_NEEDS_FACETS);
}
int pg_criterion_of_bonds (const pg_criterion *c)
{
    return c && c->type && !(c->type->needs & PG_NEEDS_FACETS);
}

void pg_criterion_clear (pg_criterion *c, size_t n)
{
    for (size_t i = 0; c && i < n; i++) if (c[i].type && c[i].type->clear) c[i].type->clear (&c[i]);
}

void pg_criterion_describe (const pg_criterion *c, char *text, size_t size)
{
    if (!c->type) snprintf (text, size, "none: nothing breaks");
    else if (c->never) snprintf (text, size, "never breaks");
    else c->type->describe (c, text, size);
}
