/* SPDX-License-Identifier: GPL-3.0-or-later
 * The pictures that a scene asks for: the names of output.pictures, then the entries of output.views, each
 * with a file name of its own. */
#include "results_private.h"
#include <stdio.h>
#include <string.h>

/* Index of a word in "a|b|c"; -1 if it is not there. */
static int place_of (const char *word, const char *names)
{
    int k = 0;
    for (const char *s = names; *s; s += strcspn (s, "|"), s += *s == '|', k++)
        if (strlen (word) == strcspn (s, "|") && strncmp (s, word, strlen (word)) == 0) return k;
    return -1;
}

/* Text of a key of entry i; NULL if it is not given, which differs from an empty text. */
static const char *text_of (const pg_scene *scene, size_t i, const char *key)
{
    return pg_scene_has (scene, "output.views[%zu].%s", i, key)
               ? pg_scene_text (scene, "output.views[%zu].%s", i, key)
               : NULL;
}

/* Reads the range of the colours and the limit of the selection, in SI units of the field. Damage has the
 * range 0 to 1 unless another is given; the view crack shows points above PG_CRACK_DAMAGE, coloured by depth
 * if the field is damage itself. */
static void read_limits (result_view *v, const pg_scene *scene, size_t i)
{
    double range[2] = { 0 };
    if (pg_scene_vector (scene, 2, range, "output.views[%zu].range", i) == 2)
        v->style.low = range[0], v->style.high = range[1];
    else if (strcmp (v->field, "damage") == 0) v->style.high = 1;
    v->limited = pg_scene_given (scene, "output.views[%zu].above", i);
    v->style.above = v->limited ? pg_scene_number (scene, "output.views[%zu].above", i) : PG_CRACK_DAMAGE;
    v->by_damage = !v->limited && v->style.view == PG_VIEW_CRACK;
    v->style.by_depth = v->style.view == PG_VIEW_CRACK && strcmp (v->field, "damage") == 0;
}

/* Writes the view of a 3D body for titles and names: "section z = 5 mm", "back", "iso"; "" in 1D and 2D. */
static void write_look (result_view *v, const char *view, const char *section, int dim)
{
    v->look[0] = 0;
    if (dim < 3) return;
    if (section) snprintf (v->look, sizeof v->look, "section %s", section);
    else snprintf (v->look, sizeof v->look, "%.40s", view ? view : "iso");
}

/* Writes the file name of a view: its own, or field and view, "damage_back". */
static void write_name (result_view *v, const char *name, const char *section)
{
    pg_picture_name (v->name, sizeof v->name, name ? name : v->field);
    if (name || !v->look[0]) return;
    size_t n = strlen (v->name);
    if (n + 2 < sizeof v->name) v->name[n] = '_', v->name[n + 1] = 0;
    pg_picture_name (v->name, sizeof v->name, section ? section : v->look);
}

/* Reads entry i of output.views: field, view or section, range, magnification, file name
 * (FIELD_VIEW unless given). Direction and section should have been checked before; otherwise
 * their faults are the returned status. */
pg_status pg_result_view_read (result_view *v, const pg_scene *scene, size_t i, int dim)
{
    pg_status status = PG_OK;
    const char *field = text_of (scene, i, "field"), *view = text_of (scene, i, "view"),
               *section = text_of (scene, i, "section");
    *v = (result_view) { .style.magnify = pg_scene_number (scene, "output.magnify") };
    if (pg_scene_given (scene, "output.views[%zu].magnify", i))
        v->style.magnify = pg_scene_number (scene, "output.views[%zu].magnify", i);
    snprintf (v->field, sizeof v->field, "%s", field ? field : "damage");
    if (dim == 3) v->style.view = view ? place_of (view, pg_view_names) : section ? PG_SECTION : PG_VIEW_ISO;
    if (v->style.view >= PG_VIEW_ISO)
        pg_scene_vector (scene, 3, v->style.direction, "output.views[%zu].direction", i);
    read_limits (v, scene, i);
    if (section && dim == 3) PG_TRY (pg_picture_section (&v->style, section));
    write_look (v, view, section, dim);
    write_name (v, text_of (scene, i, "name"), section);
done:
    return status;
}

/* Reads names of output.pictures first, then output.views. Pictures beyond the largest number have been
 * reported by pg_result_check. */
pg_status pg_result_views_read (pg_result *r, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const char *name;
    r->pictures.stages = pg_scene_bool (scene, "output.stages");
    r->pictures.stairs = strcmp (pg_scene_text (scene, "cells"), "staircase") == 0;
    r->dynamic = !pg_solver_is (pg_scene_text (scene, "solver.kind"), PG_SOLVER_QUASI_STATIC);
    for (size_t k = 0;
         (name = pg_scene_name (scene, k, "output.pictures"))
             && r->pictures.npicture < MOST_PICTURES - 1; k++) {
        result_view *v = &r->pictures.picture[r->pictures.npicture++];
        *v = (result_view) { .style = { .magnify = r->pictures.magnify,
            .high = strcmp (name, "damage") == 0 } };
        snprintf (v->name, sizeof v->name, "%s", name);
        snprintf (v->field, sizeof v->field, "%s", name);
    }
    for (size_t k = 0; k < pg_scene_count (scene, "output.views")
         && r->pictures.npicture < MOST_PICTURES - 1; k++)
        PG_TRY (pg_result_view_read (&r->pictures.picture[r->pictures.npicture++], scene, k,
                                     r->problem->dim));
done:
    return status;
}
