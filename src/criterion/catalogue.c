/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of criteria, and the criterion that the scene asks for. */
#include "entries.h"
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

const char *pg_criterion_names (void) { return names + 1; }

pg_status pg_criterion_read (pg_criterion *out, const pg_scene *scene, const pg_criterion_setting *setting)
{
    pg_status status = PG_OK;
    *out = (pg_criterion) { 0 };
    const char *name = pg_scene_given (scene, "failure") ? pg_scene_text (scene, "failure.criterion") : NULL;
    if (!name || strcmp (name, "none") == 0) goto done;
    const pg_criterion_type *type = pg_criterion_find (name);
    if (!type) PG_FAIL (PG_E_USAGE, "failure.criterion = %s: this library has no such criterion", name);
    out->type = type;
    PG_TRY (type->read (out, scene, setting));
done:
    return status;
}
