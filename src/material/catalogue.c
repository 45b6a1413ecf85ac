/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of materials, and a material as the scene describes it. */
#include "entries.h"
#include <stdio.h>
#include <string.h>

static const pg_material_type *const table[] = {
#define PG_MATERIAL(name) &pg_material_##name,
#include "list.h"
#undef PG_MATERIAL
};

enum { MOST_ADDED = 8 };
static const pg_material_type *added[MOST_ADDED];
static size_t nadded;
static char names[64 * (MOST_ADDED + 4)] =
#define PG_MATERIAL(name) "|" #name
#include "list.h"
#undef PG_MATERIAL
    ;

const pg_material_type *pg_material_find (const char *name)
{
    for (size_t i = 0; name && i < sizeof table / sizeof *table; i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    for (size_t i = 0; name && i < nadded; i++)
        if (strcmp (added[i]->name, name) == 0) return added[i];
    return NULL;
}

const char *pg_material_names (void) { return names + 1; }

pg_status pg_material_add (const pg_material_type *type)
{
    pg_status status = PG_OK;
    size_t used = strlen (names), length = strlen (type->name);
    if (pg_material_find (type->name))
        PG_FAIL (PG_E_USAGE, "there is a material model %s already", type->name);
    if (nadded == MOST_ADDED || used + length + 2 > sizeof names)
        PG_FAIL (PG_E_USAGE, "%d material models can be added, no more", MOST_ADDED);
    names[used] = '|';
    memcpy (names + used + 1, type->name, length + 1);
    added[nadded++] = type;
done:
    return status;
}

int pg_voigt_size (int dim) { return dim * (dim + 1) / 2; }

int pg_voigt_at (int dim, int i, int j)
{
    static const int solid[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } },
                     plane[2][2] = { { 0, 2 }, { 2, 1 } };
    return dim == 3 ? solid[i][j] : dim == 2 ? plane[i][j] : 0;
}

/* Is `name` one of the words of `list`? */
static int listed (const char *list, const char *name)
{
    size_t length = strlen (name);
    for (const char *at = list; (at = strstr (at, name)); at += length)
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || at[length] == '\0')) return 1;
    return 0;
}

/* Every model brings keys of its own, and the scene knows them all: those of another model would do nothing,
 * without a word. */
static void check_keys (const pg_material *m, const pg_scene *scene)
{
    const char *key;
    for (size_t k = 0; (key = pg_scene_name (scene, k, "materials.%s", m->name)); k++) {
        char path[160];
        if (listed ("model density failure", key) || listed (m->type->keys, key)) continue;
        snprintf (path, sizeof path, "materials.%s.%s", m->name, key);
        pg_scene_fault (scene, path, "is no key of model: %s, which reads %s and density", m->type->name,
                        m->type->keys);
    }
}

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
    check_keys (out, scene);
    PG_TRY (out->type->read (out, scene));
done:
    return status;
}
