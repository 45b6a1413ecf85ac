/* SPDX-License-Identifier: GPL-3.0-or-later
 * output.averages: the mean of one component of a field over the points of a set, one column
 * of history.csv each. The mean is over points, not weighted by their volumes. Also the check
 * that all columns that the user names have different names. */
#include "results_private.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names of the columns that history.csv always has. */
static const char *const fixed_columns =
    "step|time|load_factor|energy_strain|energy_kinetic|energy_external|energy_dissipated|broken|"
    "iterations|residual|utilisation|event|level|instability|motion_time|energy_damping";

/* Writes "damage|displacement.x|...|stress.xx|...": every component that fields have in this dimension;
 * turns: number of rotations of a point. */
static void component_names (int dim, int turns, char *out, size_t size)
{
    static const char *const vector[] = { "displacement", "velocity" }, *const tensor[] = { "stress",
                                                                                            "strain" };
    size_t at = (size_t) snprintf (out, size, "damage");
    for (int f = 0; f < 2; f++)
        for (int k = 0; k < dim; k++)
            at += (size_t) snprintf (out + at, size - at, "|%s.%c", vector[f], "xyz"[k]);
    for (int f = 0; f < 2; f++)
        for (int k = 0; k < pg_voigt_size (dim); k++)
            at += (size_t) snprintf (out + at, size - at, "|%s.%s", tensor[f], pg_result_voigt (dim, k));
    if (turns) snprintf (out + at, size - at, turns == 3 ? "|rotation.x|rotation.y|rotation.z" : "|rotation");
}

/* Index of a name in "a|b|c"; -1 if it is not there. */
static int place_in (const char *names, const char *name)
{
    size_t n = strlen (name);
    for (int k = 0; ; k++) {
        size_t m = strcspn (names, "|");
        if (m == n && memcmp (names, name, n) == 0) return k;
        names += m;
        if (!*names++) return -1;
    }
}

/* ---- checks -------------------------------------------------------------------------------------------- */
/* Adds a fault to the scene, with all possible names and the nearest one, if the field is none of them:
 * "stress" alone is no column, "stress.yy" is. */
static void check_field (const pg_scene *scene, const char *path, const char *field, int dim, int turns)
{
    char names[400], listed[600];
    size_t n = 0;
    component_names (dim, turns, names, sizeof names);
    if (place_in (names, field) >= 0) return;
    for (const char *c = names; *c; c++) {
        listed[n++] = *c == '|' ? ',' : *c;
        if (*c == '|') listed[n++] = ' ';
    }
    listed[n] = '\0';
    const char *near = pg_nearest_name (field, names);
    if (near)
        pg_scene_fault (scene, path, "must be one component of a field in %dD: %s; did you mean %s?", dim,
                        listed, near);
    else pg_scene_fault (scene, path, "must be one component of a field in %dD: %s", dim, listed);
}

/* Checks the columns that the user names (gauges, averages, tips): they must differ from each other and from
 * those that are always there, and must not contain characters that separate cells or begin a unit. */
static void check_names (const pg_scene *scene)
{
    static const char *const list[] = { "output.gauges", "output.averages", "output.tips" };
    char path[64];
    for (size_t a = 0; a < 3; a++)
        for (size_t i = 0; i < pg_scene_count (scene, "%s", list[a]); i++) {
            const char *name = pg_scene_text (scene, "%s[%zu].name", list[a], i);
            snprintf (path, sizeof path, "%s[%zu].name", list[a], i);
            if (!*name || strlen (name) > 31 || strpbrk (name, "[]\",\n\r"))
                pg_scene_fault (scene, path,
                                "a column's name has 1 to 31 characters without [ ] \" and comma");
            if (place_in (fixed_columns, name) >= 0 || strncmp (name, "tip.", 4) == 0
                || strcmp (name, "crack.length") == 0 || strcmp (name, "crack.area") == 0)
                pg_scene_fault (scene, path, "history.csv has a column of this name anyway");
            for (size_t b = 0; b <= a; b++)
                for (size_t k = 0; k < (b < a ? pg_scene_count (scene, "%s", list[b]) : i); k++)
                    if (strcmp (pg_scene_text (scene, "%s[%zu].name", list[b], k), name) == 0)
                        pg_scene_fault (scene, path, "%s[%zu] has this name too", list[b], k);
        }
}

/* Checks names, fields and sets; an empty set has no mean. */
void pg_result_averages_check (const pg_scene *scene, const pg_problem *problem)
{
    char path[64];
    check_names (scene);
    for (size_t i = 0; i < pg_scene_count (scene, "output.averages"); i++) {
        snprintf (path, sizeof path, "output.averages[%zu].field", i);
        check_field (scene, path, pg_scene_text (scene, "%s", path), problem->dim,
                     pg_problem_rotations (problem));
        snprintf (path, sizeof path, "output.averages[%zu].set", i);
        const pg_set *set = pg_sets_named (&problem->sets, scene, path, pg_scene_text (scene, "%s", path));
        if (set && pg_set_points (set) == 0)
            pg_scene_fault (scene, path, "the set %s holds no point", set->name);
    }
}

/* ---- columns and rows ---------------------------------------------------------------------------------- */
/* Reads output.averages: "stress.xx" is split into field and component; units follow from the field. */
pg_status pg_result_averages_read (pg_result *r, const pg_scene *scene)
{
    pg_status status = PG_OK;
    r->naverage = pg_scene_count (scene, "output.averages");
    PG_ALLOC (r->average, r->naverage);
    for (size_t i = 0; i < r->naverage; i++) {
        result_average *a = &r->average[i];
        const char *field = pg_scene_text (scene, "output.averages[%zu].field", i),
                   *dot = strchr (field, '.');
        int dim = r->problem->dim;
        snprintf (a->name, sizeof a->name, "%s", pg_scene_text (scene, "output.averages[%zu].name", i));
        snprintf (a->field, sizeof a->field, "%.*s", (int) (dot ? dot - field : 31), field);
        a->set = pg_sets_find (&r->problem->sets, pg_scene_text (scene, "output.averages[%zu].set", i));
        a->unit = strcmp (a->field, "stress") == 0         ? "Pa"
                  : a->field[0] == 'v'                     ? "m/s"
                  : strcmp (a->field, "displacement") == 0 ? "m"
                  : strcmp (a->field, "rotation") == 0     ? "rad"
                                                           : "1";
        if (dot && !dot[2]) a->component = dot[1] - 'x';
        for (int k = 0; dot && dot[2] && k < pg_voigt_size (dim); k++)
            if (strcmp (dot + 1, pg_result_voigt (dim, k)) == 0) a->component = k;
    }
done:
    return status;
}

/* Writes the header of column i, "NAME [UNIT]". */
void pg_result_average_column (const pg_result *r, size_t i, char *out, size_t size)
{
    snprintf (out, size, "%s [%s]", r->average[i].name, r->average[i].unit);
}

/* Mean of the component over the points of the set; with several ranks the share of this one. */
static double mean_of (const result_average *a, const pg_problem *p, const double *value, int components)
{
    double sum = 0;
    for (size_t i = 0; i < a->set->npoint; i++)
        if (pg_cloud_owns (&p->cloud, (size_t) a->set->point[i]))
            sum += value[(size_t) a->set->point[i] * (size_t) components + (size_t) a->component];
    return sum / (double) pg_set_points (a->set);
}

/* Computes the averages of a row; each field is evaluated once, for all averages of it. Forces without fields
 * give NAN. */
pg_status pg_result_averages_row (pg_result *r, const pg_state *state, double *row, double *work)
{
    pg_status status = PG_OK;
    void *self;
    const pg_force_type *force = pg_solver_force (r->solver, &self);
    for (size_t i = 0; i < r->naverage; i++) {
        const char *unit;
        int components = 0;
        size_t first = 0;
        while (strcmp (r->average[first].field, r->average[i].field) != 0) first++;
        row[i] = first < i ? row[i] : NAN;
        if (first < i || !force->field) continue;
        PG_TRY (force->field (self, state, state->d, r->average[i].field, &components, &unit, work));
        for (size_t k = i; k < r->naverage && components > 0; k++)
            if (strcmp (r->average[k].field, r->average[i].field) == 0)
                row[k] = mean_of (&r->average[k], r->problem, work, components);
    }
done:
    return status;
}
