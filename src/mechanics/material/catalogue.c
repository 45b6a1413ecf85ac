/* SPDX-License-Identifier: GPL-3.0-or-later
 * The table of materials, and a material as the scene describes it. */
#include "entries.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Materials are the entries of list.h (table), and behind them those that the calling program has added.
 * `names` joins the names of all by bars, for choices of keys and messages, with a bar in front. */
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

/* Finds a material by its name; NULL: there is none. */
const pg_material_type *pg_material_find (const char *name)
{
    for (size_t i = 0; name && i < sizeof table / sizeof *table; i++)
        if (strcmp (table[i]->name, name) == 0) return table[i];
    for (size_t i = 0; name && i < nadded; i++)
        if (strcmp (added[i]->name, name) == 0) return added[i];
    return NULL;
}

const char *pg_material_names (void) { return names + 1; }

/* Adds a material of the calling program. To be called before any scene is read, as the keys of all materials
 * are collected when the first scene is read. */
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

/* Number of components of a symmetric tensor: 1, 3 or 6. */
int pg_voigt_size (int dim) { return dim * (dim + 1) / 2; }

/* Index of component ij in Voigt order: 3D: xx, yy, zz, xy, yz, zx; 2D: xx, yy, xy. */
int pg_voigt_at (int dim, int i, int j)
{
    static const int solid[3][3] = { { 0, 3, 5 }, { 3, 1, 4 }, { 5, 4, 2 } },
                     plane[2][2] = { { 0, 2 }, { 2, 1 } };
    return dim == 3 ? solid[i][j] : dim == 2 ? plane[i][j] : 0;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
/* Material i of table and added ones together; NULL past the last. */
static const pg_material_type *entry (size_t i)
{
    size_t own = sizeof table / sizeof *table;
    return i < own ? table[i] : i - own < nadded ? added[i - own] : NULL;
}

static const char *name_of (size_t i) { return entry (i) ? entry (i)->name : NULL; }
static pg_key_tables keys_of (size_t i) { return entry (i)->keys; }

const pg_key_catalogue pg_entry_keys_material = { .selector = "materials.{}.model",
                                                  .name = name_of,
                                                  .keys = keys_of };

/* "youngs_modulus, poissons_ratio": the keys that a model reads, without the path of the material. */
static void list_keys (const pg_material_type *type, char *text, size_t size)
{
    size_t used = 0;
    text[0] = '\0';
    for (pg_key_tables t = type->keys; *t; t++)
        for (size_t k = 0; k < (*t)->n && used < size; k++)
            used += (size_t) snprintf (text + used, size - used, "%s%s", used ? ", " : "",
                                       strrchr ((*t)->key[k].path, '.') + 1);
}

/* Reports keys of other models. The scene accepts the keys of all models, and those of another one would have
 * no effect. */
static void check_keys (const pg_material *m, const pg_scene *scene)
{
    char map[96], path[PG_STRAY_PATH], reads[400];
    snprintf (map, sizeof map, "materials.%s", m->name);
    list_keys (m->type, reads, sizeof reads);
    for (size_t k = 0; pg_scene_stray (scene, k, map, path); k++)
        pg_scene_fault (scene, path, "is no key of model: %s, which reads %s and density", m->type->name,
                        reads);
}

/* Reads material `name` of the scene: common keys here, the rest by the model; keys of other models are
 * faults. E and nu stay NAN if the model has none. */
pg_status pg_material_read (pg_material *out, const pg_scene *scene, const char *name, pg_mode mode)
{
    return pg_material_read_graded (out, scene, name, mode, NAN);
}

pg_status pg_material_read_graded (pg_material *out, const pg_scene *scene, const char *name, pg_mode mode,
                                   double reference)
{
    pg_status status = PG_OK;
    *out = (pg_material) { .mode = mode, .E = reference, .nu = NAN };
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
