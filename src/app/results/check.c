/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks the section `output` of a scene against what a body of its dimension can show: names
 * of pictures (a scalar, the size of a vector, or one component), views, and names that are
 * given twice. All faults are reported through the scene, with the line and what would be
 * right. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Writes the names of all pictures in this dimension as
 * "damage|displacement|displacement.x|...|stress.xx|...". Vectors can be shown by their size,
 * tensors by component only. */
static void picture_names (int dim, int turns, char *out, size_t size)
{
    static const char *const vector[] = { "displacement", "velocity" }, *const tensor[] = { "stress",
                                                                                            "strain" };
    size_t at = (size_t) snprintf (out, size, "damage");
    for (int f = 0; f < 2; f++) {
        at += (size_t) snprintf (out + at, size - at, "|%s", vector[f]);
        for (int k = 0; k < dim; k++)
            at += (size_t) snprintf (out + at, size - at, "|%s.%c", vector[f], "xyz"[k]);
    }
    for (int f = 0; f < 2; f++) {
        if (dim == 1) at += (size_t) snprintf (out + at, size - at, "|%s", tensor[f]);
        for (int k = 0; k < pg_voigt_size (dim); k++)
            at += (size_t) snprintf (out + at, size - at, "|%s.%s", tensor[f], pg_result_voigt (dim, k));
    }
    if (turns)
        at += (size_t) snprintf (out + at, size - at, "|rotation%s",
                                 turns == 3 ? "|rotation.x|rotation.y|rotation.z" : "");
    snprintf (out + at, size - at, "|error_estimate");
}

/* 1 if the name is in "a|b|c"; both are framed by | so that parts of names do not count. */
static int among (const char *names, const char *name)
{
    char framed_names[600], framed[128];
    snprintf (framed_names, sizeof framed_names, "|%s|", names);
    snprintf (framed, sizeof framed, "|%.100s|", name);
    return !strchr (name, '|') && strstr (framed_names, framed) != NULL;
}

/* Adds a fault for each name that a list holds twice. */
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

/* Adds a fault about an unknown picture, with the list of names and the nearest one. */
static void fault_of_picture (const pg_scene *scene, const char *path, const char *name, const char *names)
{
    char listed[800];
    size_t n = 0;
    for (const char *c = names; *c; c++) {
        if (*c == '|') listed[n++] = ',', listed[n++] = ' ';
        else listed[n++] = *c;
    }
    listed[n] = 0;
    const char *near = pg_nearest_name (name, names);
    if (near)
        pg_scene_fault (scene, path, "there is no such picture; did you mean %s? One of %s", near, listed);
    else pg_scene_fault (scene, path, "there is no such picture: one of %s", listed);
}

/* ---- views --------------------------------------------------------------------------------------------- */
/* Checks a section: it must be readable and must meet the body, to within half a spacing. */
static void check_section (const pg_scene *scene, const pg_problem *p, const char *path, const char *text)
{
    pg_picture_style style = { 0 };
    if (pg_picture_section (&style, text) != PG_OK) {
        pg_scene_fault (scene, path,
                        "expected AXIS = PLACE, such as z = 5 mm, or NORMAL = DISTANCE: 1, 0, 1 = 5 mm");
        return;
    }
    double normal[3] = { style.section == 1, style.section == 2, style.section == 3 }, size = 0, low = 0,
           high = 0;
    for (int k = 0; k < 3 && style.section == 4; k++) normal[k] = style.direction[k];
    for (int k = 0; k < 3; k++) size = hypot (size, normal[k]);
    for (int k = 0; k < 3; k++) {
        double a = normal[k] / size * p->cloud.low[k], b = normal[k] / size * p->cloud.high[k];
        low += fmin (a, b), high += fmax (a, b);
    }
    if (style.at < low - 0.5 * p->cloud.h || style.at > high + 0.5 * p->cloud.h)
        pg_scene_fault (scene, path, "misses the body, which lies between %.6g and %.6g m", low, high);
}

/* Checks the keys of a view that have a meaning in 3D only. */
static void check_3d (const pg_scene *scene, const pg_problem *p, size_t i)
{
    static const char *const solid[] = { "view", "section", "direction", "above" };
    char path[64];
    for (int k = 0; k < 4; k++) {
        snprintf (path, sizeof path, "output.views[%zu].%s", i, solid[k]);
        if (!pg_scene_given (scene, "%s", path)) continue;
        if (p->dim < 3) pg_scene_fault (scene, path, "is for dimension 3");
        else if (k == 1) check_section (scene, p, path, pg_scene_text (scene, "%s", path));
        else if (k == 2) {
            double d[3] = { 0 };
            pg_scene_vector (scene, 3, d, "%s", path);
            if (!(hypot (hypot (d[0], d[1]), d[2]) > 0)) pg_scene_fault (scene, path, "must not be zero");
        }
    }
}

/* 1: the name is a file name of plain letters. */
static int is_file_name (const char *name)
{
    static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";
    return *name && *name != '.' && strlen (name) <= 60 && strspn (name, plain) == strlen (name);
}

/* 1: another picture of this run has the name: one of output.pictures, of the views before, or one that every
 * run makes. */
static int is_taken (const pg_scene *scene, const pg_problem *p, size_t view, const char *name)
{
    static const char *const own[] = { "load_displacement", "error", "tip", "tip_speed" };
    const char *word;
    result_view other;
    for (size_t k = 0; (word = pg_scene_name (scene, k, "output.pictures")); k++)
        if (strcmp (word, name) == 0) return 1;
    for (size_t k = 0; k < view; k++)
        if (pg_result_view_read (&other, scene, k, p->dim) == PG_OK && strcmp (other.name, name) == 0)
            return 1;
    for (size_t k = 0; k < sizeof own / sizeof *own; k++) if (strcmp (own[k], name) == 0) return 1;
    return 0;
}

/* Checks a file name: it consists of a few safe characters, and no two pictures have the same one, those of
 * curves and cracks included: the later one would overwrite the earlier one. */
static void check_name (const pg_scene *scene, const pg_problem *p, size_t i)
{
    char path[64];
    int given = pg_scene_given (scene, "output.views[%zu].name", i);
    result_view mine;
    snprintf (path, sizeof path, given ? "output.views[%zu].name" : "output.views[%zu]", i);
    if (given && !is_file_name (pg_scene_text (scene, "output.views[%zu].name", i)))
        pg_scene_fault (scene, path, "must be a file name of at most 60 letters, digits, '-', '_' and '.'");
    else if (pg_result_view_read (&mine, scene, i, p->dim) == PG_OK && is_taken (scene, p, i, mine.name))
        pg_scene_fault (scene, path, "another picture is called %s.png; give another name", mine.name);
}

/* Checks entry i of output.views: its field, keys for 3D only, its range, its file name. */
static void check_view (const pg_scene *scene, const pg_problem *p, size_t i, const char *names)
{
    char path[64];
    double range[2] = { 0 };
    snprintf (path, sizeof path, "output.views[%zu].field", i);
    const char *field = pg_scene_given (scene, "%s", path) ? pg_scene_text (scene, "%s", path) : "damage";
    if (!among (names, field)) fault_of_picture (scene, path, field, names);
    check_3d (scene, p, i);
    snprintf (path, sizeof path, "output.views[%zu].range", i);
    if (pg_scene_given (scene, "%s", path)
        && (pg_scene_count (scene, "%s", path) != 2 || pg_scene_vector (scene, 2, range, "%s", path) != 2
            || !(range[0] < range[1])))
        pg_scene_fault (scene, path, "must be two ascending numbers, [low, high]");
    check_name (scene, p, i);
}

/* Adds a fault if error_estimate is asked for without shape functions, whose stress it smooths. */
static void check_estimate (const pg_scene *scene, const pg_problem *problem)
{
    static const char *const keys[] = { "output.fields", "output.pictures" };
    const char *name;
    char path[64];
    for (int k = 0; k < 2 && !problem->method->shape_functions; k++)
        for (size_t i = 0; (name = pg_scene_name (scene, i, "%s", keys[k])); i++) {
            if (strcmp (name, "error_estimate") != 0) continue;
            snprintf (path, sizeof path, "%s[%zu]", keys[k], i);
            pg_scene_fault (scene, path,
                            "force: %s has no shape functions whose stress could be smoothed: leave it out, "
                            "or use force: galerkin",
                            problem->method->name);
        }
}

/* Checks the names of output.pictures and returns how many there are, which counts towards the
 * largest number of pictures. */
static size_t check_pictures (const pg_scene *scene, const char *names)
{
    size_t count = 0;
    const char *name;
    char path[64];
    for (; (name = pg_scene_name (scene, count, "output.pictures")); count++)
        if (!among (names, name)) {
            snprintf (path, sizeof path, "output.pictures[%zu]", count);
            fault_of_picture (scene, path, name, names);
        }
    return count;
}

/* Checks the names of pictures in a scene with faults, from which no problem can be built. */
void pg_result_check_names (const pg_scene *scene)
{
    char names[512];
    const pg_force_type *force = pg_force_find (pg_scene_text (scene, "method.force"));
    int dim = (int) pg_scene_integer (scene, "dimension"),
        turns = force && dim > 0 && dim < 4 ? force->method.rotations[dim] : 0;
    /* A scene without a valid dimension, or without that list, has other faults, which are
     * reported elsewhere. */
    if (dim < 1 || dim > 3 || !pg_scene_given (scene, "output.pictures[0]")) return;
    picture_names (dim, turns, names, sizeof names);
    check_pictures (scene, names);
}

/* Checks the whole section; missing memory is the only failure that is not a fault of the scene. The
 * reference is read and dropped: its faults are to come before the run begins, not after hours at its end. */
pg_status pg_result_check (const pg_scene *scene, const pg_problem *problem)
{
    char names[512], path[64];
    const char *name;
    pg_reference *reference = NULL;
    picture_names (problem->dim, pg_problem_rotations (problem), names, sizeof names);
    size_t count = check_pictures (scene, names);
    for (size_t k = 0; (name = pg_scene_name (scene, k, "output.fields")); k++)
        if (strcmp (name, "rotation") == 0 && !pg_problem_rotations (problem)) {
            snprintf (path, sizeof path, "output.fields[%zu]", k);
            pg_scene_fault (scene, path, "points of force: %s have no rotations",
                            problem->method->name);
        }
    for (size_t i = 0; i < pg_scene_count (scene, "output.views"); i++, count++)
        check_view (scene, problem, i, names);
    if (count >= MOST_PICTURES)
        pg_scene_fault (scene, "output.pictures", "at most %d pictures", MOST_PICTURES - 1);
    check_estimate (scene, problem);
    pg_result_fields_check (scene);
    pg_result_averages_check (scene, problem);
    pg_result_paths_check (scene, problem);
    if (pg_result_tips_check (scene, problem) != PG_OK) return PG_E_MEMORY;
    if (pg_reference_read (&reference, scene, problem) == PG_E_MEMORY) return PG_E_MEMORY;
    pg_reference_free (&reference);
    given_once (scene, "output.pictures");
    given_once (scene, "output.fields");
    return pg_scene_verdict (scene);
}
