/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of materials, and a material as the scene describes it. */
#include "entries.h"
#include <string.h>

static const pg_material_type *const table[] = {
#define PG_MATERIAL(name) &pg_material_##name,
#include "list.h"
#undef PG_MATERIAL
};

static const char names[] =
#define PG_MATERIAL(name) "|" #name
#include "list.h"
#undef PG_MATERIAL
    ;

const pg_material_type *pg_material_find (const char *name)
{
    for (size_t i = 0; name && i < sizeof table / sizeof *table; i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    return NULL;
}

const char *pg_material_names (void) { return names + 1; }

int pg_voigt_size (int dim) { return dim * (dim + 1) / 2; }

pg_status pg_material_read (pg_material *out, const pg_scene *scene, const char *name, pg_mode mode)
{
    pg_status status = PG_OK;
    *out = (pg_material) { .mode = mode };
    size_t length = strlen (name);
    if (length >= sizeof out->name || !pg_scene_given (scene, "materials.%s", name)) {
        pg_scene_fault (scene, "materials", "there is no material '%s'", name);
        PG_TRY (pg_scene_verdict (scene));
    }
    memcpy (out->name, name, length + 1);
    out->type = pg_material_find (pg_scene_text (scene, "materials.%s.model", name));
    if (!out->type) PG_FAIL (PG_E_USAGE, "materials.%s.model names no material of this library", name);
    out->density = pg_scene_number (scene, "materials.%s.density", name);
    PG_TRY (out->type->read (out, scene));
done:
    return status;
}
