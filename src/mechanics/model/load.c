/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads and supports: value (x, y, z, t) times a factor of t. */
#include "model.h"
#include <stdio.h>
#include <string.h>
#include <math.h>

/* Kinds of entries of `boundary`: key, unit of its values, kind of load. An entry gives one of these keys
 * (keys.c). */
static const struct { const char *key, *unit; pg_load_kind kind;
} kinds[] = {
    { "symmetry", "m", PG_DISPLACEMENT },     { "turn", "rad", PG_DISPLACEMENT },
    { "temperature", "K", PG_EIGENSTRAIN },   { "shrinkage", "1", PG_EIGENSTRAIN },
    { "pore_pressure", "Pa", PG_EIGENSTRAIN },
    { "gravity", "m/s2", PG_BODY_FORCE },     { "spring", "m", PG_SPRING },
    { "displacement", "m", PG_DISPLACEMENT }, { "velocity", "m/s", PG_VELOCITY },
    { "traction", "Pa", PG_TRACTION },        { "pressure", "Pa", PG_PRESSURE },
    { "force", "N", PG_POINT_FORCE },         { "body_force", "N/m3", PG_BODY_FORCE },
    { "rotation", "rad", PG_ROTATION },       { "moment", "N m", PG_MOMENT },
};

/* Reads the ramp as an expression in t, or one of the words linear (from 0 to 1 over the run) or constant. A
 * velocity's ramp is integrated to one for the displacement: t^2 / (2 duration), or t. duration: s
 * (quasi-static: 1). */
static pg_status read_ramp (pg_load *load, const pg_scene *scene, size_t i, int is_static, double duration)
{
    pg_status status = PG_OK;
    const char *ramp = pg_scene_text (scene, "boundary[%zu].ramp", i);
    char path[64], text[96];
    int velocity = load->kind == PG_VELOCITY;
    if (!ramp || !*ramp) ramp = velocity ? "constant" : "linear";
    snprintf (path, sizeof path, "boundary[%zu].ramp", i);
    if (strcmp (ramp, "linear") == 0) {
        if (velocity) snprintf (text, sizeof text, "t^2 * %.17g", 0.5 / duration);
        else snprintf (text, sizeof text, "t * %.17g", 1 / duration);
        load->proportional = is_static;
    } else if (strcmp (ramp, "constant") == 0) snprintf (text, sizeof text, velocity ? "t" : "1");
    else if (velocity) {
        pg_scene_fault (scene, path, "a velocity takes ramp constant or linear");
        goto done;
    } else {
        if (pg_expression_compile (&load->ramp, ramp, "1") != PG_OK)
            pg_scene_fault (scene, path, "linear, constant or an expression in t: %s", pg_last_error ());
        goto done;
    }
    PG_TRY (pg_expression_compile (&load->ramp, text, "1"));
done:
    return status;
}

/* Reads a table of pairs [t, factor] with ascending t; each wrong pair is reported. */
static pg_status read_table (pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    load->ntable = pg_scene_count (scene, "boundary[%zu].table", i);
    PG_ALLOC (load->table, 2 * load->ntable);
    for (size_t k = 0; k < load->ntable; k++) {
        char path[64];
        snprintf (path, sizeof path, "boundary[%zu].table[%zu]", i, k);
        if (pg_scene_count (scene, "%s", path) != 2
            || pg_scene_vector (scene, 2, load->table + 2 * k, "%s", path) != 2)
            pg_scene_fault (scene, path, "a pair [t, factor] is needed");
        else if (k && !(load->table[2 * k] > load->table[2 * k - 2]))
            pg_scene_fault (scene, path, "t must increase");
    }
    if (load->ntable == 0) pg_scene_fault (scene, "boundary", "a table needs at least one pair");
done:
    return status;
}

/* Reads the special kinds symmetry, turn, gravity, spring and eigenstrain; returns 0: the entry is of another
 * kind. */
static int read_special (pg_problem *p, pg_load *load, const pg_scene *scene, size_t i, const char *key,
                         pg_status *status)
{
    int symmetry = strcmp (key, "symmetry") == 0, turn = strcmp (key, "turn") == 0,
        gravity = strcmp (key, "gravity") == 0;
    if (symmetry) *status = pg_load_read_symmetry (p, load, scene, i);
    if (turn) *status = pg_load_read_turn (p, load, scene, i);
    if (gravity) *status = pg_load_read_gravity (p, load, scene, i);
    if (load->kind == PG_SPRING) *status = pg_load_read_spring (p, load, scene, i);
    if (load->kind == PG_EIGENSTRAIN) *status = pg_load_read_eigenstrain (p, load, scene, i);
    return symmetry || turn || gravity || load->kind == PG_SPRING || load->kind == PG_EIGENSTRAIN;
}

/* Reads the expressions of the components x, y, z (a pressure has one value); at least one is needed,
 * components beyond the dimension are errors. A value that depends on t is not proportional to the load
 * factor. */
static pg_status read_values (pg_load *load, const pg_scene *scene, size_t i, const char *key,
                              const char *unit)
{
    pg_status status = PG_OK;
    int found = 0, dim = (int) pg_scene_integer (scene, "dimension");
    char path[64];
    if (load->kind == PG_PRESSURE) {
        PG_TRY (pg_expression_compile (&load->value[0], pg_scene_text (scene, "boundary[%zu].pressure", i),
                                       unit));
        goto done;
    }
    for (int axis = 0; axis < 3; axis++) {
        const char *text = pg_scene_text (scene, "boundary[%zu].%s.%c", i, key, "xyz"[axis]);
        if (!text || !*text) continue;
        snprintf (path, sizeof path, "boundary[%zu].%s.%c", i, key, "xyz"[axis]);
        int k = pg_load_rotates (load) && dim < 3 ? axis - 2 : axis;
        if (k < 0 || k >= pg_load_components (load, dim)) {
            pg_scene_fault (scene, path, "a %dD body has no such component%s", dim,
                            pg_load_rotates (load) && dim == 2 ? ": it turns about z alone" : "");
            found++;
            continue;
        }
        PG_TRY (pg_expression_compile (&load->value[k], text, unit));
        if (load->value[k] && pg_expression_uses (load->value[k], 't')) {
            load->proportional = 0;
            if (load->kind == PG_VELOCITY)
                pg_scene_fault (scene, path, "a prescribed velocity may not depend on t (use displacement)");
        }
        found++;
    }
    snprintf (path, sizeof path, "boundary[%zu].%s", i, key);
    if (!found) pg_scene_fault (scene, path, "at least one component x, y, z is needed");
done:
    return status;
}

/* Returns 1: the load acts on boundary facets (traction, pressure, support by Nitsche's method), not on
 * points. */
static int acts_on_facets (const pg_load *load)
{
    return load->kind == PG_TRACTION || load->kind == PG_PRESSURE
           || (pg_load_prescribes (load) && load->essential == PG_ESSENTIAL_NITSCHE);
}

/* Checks that the set of a load contains facets or points to act on. Empty sets already reported at their
 * definition are skipped. */
static void check_place (const pg_problem *problem, const pg_load *load, const pg_scene *scene, size_t i)
{
    char path[64];
    snprintf (path, sizeof path, "boundary[%zu].set", i);
    const pg_set *set = load->set;
    int empty = pg_set_points (set) == 0 && pg_set_facets (set) == 0;
    /* reported at the definition of the set */
    if (empty && (pg_scene_given (scene, "sets.%s", set->name) || pg_sets_empty_side (&problem->sets, set)))
        return;
    int on_facets = acts_on_facets (load);
    if (on_facets && problem->cells.n == 0 && !pg_ranks_now ())
        pg_scene_fault (scene, path, "%s needs boundary facets, and a body of explicit points has none",
                        load->kind == PG_TRACTION   ? "a traction"
                        : load->kind == PG_PRESSURE ? "a pressure"
                                                    : "essential: nitsche");
    else if (on_facets && pg_set_facets (set) == 0)
        pg_scene_fault (scene, path, "the set %s holds no boundary facet", set->name);
    else if (!on_facets && pg_set_points (set) == 0)
        pg_scene_fault (scene, path, "the set %s holds no point", set->name);
}

/* Largest extent of the body's bounding box along the normal of a facet of the set, m: upper bound of a
 * load's depth. */
static double deepest (const pg_problem *problem, const pg_set *set)
{
    const pg_cells *c = &problem->cells;
    const pg_cloud *cloud = &problem->cloud;
    size_t dim = (size_t) problem->dim;
    double most = 0, size[3] = { 0 };
    for (size_t k = 0; k < dim; k++) {
        double low = cloud->low[k], high = cloud->high[k];
        for (size_t f = 0; f < c->nfacet; f++)
            low = fmin (low, c->facet_centre[f * dim + k]), high = fmax (high, c->facet_centre[f * dim + k]);
        size[k] = high - low;
    }
    for (size_t f = 0; f < set->nfacet; f++) {
        double along = 0;
        for (size_t k = 0; k < dim; k++)
            along += fabs (c->normal[(size_t) set->facet[f] * dim + k]) * size[k];
        most = fmax (most, along);
    }
    return most;
}

/* Reads boundary[].depth: forces without shape functions may distribute a traction over a layer of points
 * instead of the outermost ones (Silling and Askari 2005); shape functions apply it on the surface itself. */
static void read_depth (const pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i)
{
    char path[64], names[160];
    snprintf (path, sizeof path, "boundary[%zu].depth", i);
    if (!pg_scene_given (scene, "%s", path)) return;
    load->depth = pg_scene_length (scene, problem->cloud.h, "%s", path);
    if (problem->cloud.subdomain && load->depth > problem->cloud.subdomain->width)
        pg_scene_fault (scene, path, "%d ranks: a load may act down to %.4g m so far, the width of the layer "
                        "that ranks have in common", pg_rank_count (), problem->cloud.subdomain->width);
    if (load->kind != PG_TRACTION && load->kind != PG_PRESSURE)
        pg_scene_fault (scene, path,
                        "is for a traction or a pressure: others act on the points of their set");
    else if (problem->method->shape_functions)
        pg_scene_fault (scene, path,
                        "the shape functions of force: %s carry a traction on the surface itself; a depth "
                        "is for force: %s",
                        problem->method->name, pg_methods_of_points (problem, names, sizeof names));
    else if (load->set->nfacet) {
        double most = deepest (problem, load->set);
        if (load->depth > most * (1 + 1e-9))
            pg_scene_fault (scene, path,
                            "reaches beyond the body, which is %.6g m deep below %s: at most that", most,
                            load->set->name);
    }
}

/* Sets the name of a load: the one given, or that of its set with blanks replaced ("polygon.edge 3"), as
 * blanks disturb readers of history.csv. */
static void name_load (pg_load *load, const pg_scene *scene, size_t i, const char *set)
{
    const char *name = pg_scene_text (scene, "boundary[%zu].name", i);
    int given = name && *name;
    snprintf (load->name, sizeof load->name, "%.63s", given ? name : set);
    for (char *c = load->name; *c && !given; c++) if (*c == ' ') *c = '_';
}

/* The set of `set: cracks`, without points and facets, as crack faces arise during the run. */
static const pg_set crack_faces = { .name = "cracks" };

/* Checks a pressure in cracks. It is applied as an equivalent load on surface and interior (by the divergence
 * theorem), which is valid for uniform pressure only. */
static void check_cracks (const pg_problem *problem, const pg_load *load, const pg_scene *scene, size_t i)
{
    char path[64];
    snprintf (path, sizeof path, "boundary[%zu].set", i);
    if (load->kind != PG_PRESSURE)
        pg_scene_fault (scene, path, "in cracks there can be a pressure, nothing else so far");
    else if (!problem->method->shape_functions)
        pg_scene_fault (
            scene, path,
            "force: %s has no shape functions that end at the faces of a crack, so that nothing can "
            "press on these",
            problem->method->name);
    else if (problem->cells.n == 0)
        pg_scene_fault (scene, path,
                        "a pressure in cracks needs the surface of the body, and a body of explicit "
                        "points has none");
    snprintf (path, sizeof path, "boundary[%zu].pressure", i);
    if (load->value[0] && pg_depends_on_place (load->value[0]))
        pg_scene_fault (scene, path,
                        "a pressure in cracks is the same at all places: an expression of t alone");
}

/* Returns 1: without a set the load acts on the whole body. */
static int acts_everywhere (const pg_load *load)
{
    return load->kind == PG_BODY_FORCE || load->kind == PG_EIGENSTRAIN;
}

/* Index in `kinds` of the first key that entry i of `boundary` gives; the last kind if none. */
static size_t kind_of (const pg_scene *scene, size_t i)
{
    size_t k = 0;
    while (k + 1 < sizeof kinds / sizeof *kinds
           && !pg_scene_given (scene, "boundary[%zu].%s", i, kinds[k].key))
        k++;
    return k;
}

/* Reads where entry i acts: a set, a position (at) or crack faces; sets its name. load->set stays NULL after
 * a reported error. */
static pg_status read_where (pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char path[64];
    const char *set = pg_scene_text (scene, "boundary[%zu].set", i);
    int at = pg_scene_given (scene, "boundary[%zu].at", i);
    if (!set || !*set) set = !at && acts_everywhere (load) ? "all" : "at";
    name_load (load, scene, i, set);
    snprintf (path, sizeof path, "boundary[%zu].set", i);
    if (!at && strcmp (set, "at") == 0 && !pg_scene_given (scene, "%s", path)) {
        pg_scene_fault (scene, path, "missing: where it acts, a set; a force or a spring also at: [x, y, "
                                     "z]; a body force and gravity without it act everywhere");
        return PG_OK;
    }
    load->cracks = strcmp (set, crack_faces.name) == 0 && !pg_scene_given (scene, "sets.%s", set);
    if (at) PG_TRY (pg_load_read_place (problem, load, scene, i));
    else load->set = load->cracks ? &crack_faces : pg_sets_named (&problem->sets, scene, path, set);
done:
    return status;
}

/* Reads the time dependence of entry i: stages, table or ramp. */
static pg_status read_course (pg_load *load, const pg_scene *scene, size_t i, int is_static, double duration)
{
    size_t nstage = pg_scene_count (scene, "stages");
    const char *ramp = pg_scene_text (scene, "boundary[%zu].ramp", i);
    if (nstage && !(ramp && strcmp (ramp, "constant") == 0))
        return pg_load_follows_stages (load, scene, i, nstage);
    if (pg_scene_given (scene, "boundary[%zu].table", i)) return read_table (load, scene, i);
    return read_ramp (load, scene, i, is_static, duration);
}

/* Reads entry i of `boundary`. duration: end of the run, s (quasi-static: 1), for ramps over it. */
static pg_status read_load (pg_problem *problem, pg_load *load, const pg_scene *scene, size_t i,
                            int is_static, double duration)
{
    pg_status status = PG_OK;
    char path[64], names[160];
    size_t k = kind_of (scene, i);
    load->kind = kinds[k].kind;
    snprintf (path, sizeof path, "boundary[%zu].%s", i, kinds[k].key);
    if (pg_load_rotates (load) && !pg_problem_rotations (problem))
        pg_scene_fault (scene, path, "points of force: %s have no rotations, only those of force: %s",
                        problem->method->name, pg_methods_with_rotations (problem, names, sizeof names));
    PG_TRY (read_where (problem, load, scene, i));
    if (!load->set) goto done;
    PG_TRY (pg_load_spread_force (problem, load));
    snprintf (path, sizeof path, "boundary[%zu].set", i);
    if (is_static && load->kind == PG_VELOCITY)
        pg_scene_fault (scene, path, "a static run has no velocity: prescribe a displacement");
    load->essential = PG_ESSENTIAL_TRANSFORMATION;
    if (problem->method->support) problem->method->support (problem, load, scene, i);
    if (!load->cracks && !pg_scene_given (scene, "boundary[%zu].at", i))
        check_place (problem, load, scene, i);
    PG_TRY (pg_load_centre (problem, load, scene, i));
    read_depth (problem, load, scene, i);
    PG_TRY (read_course (load, scene, i, is_static, duration));
    if (!read_special (problem, load, scene, i, kinds[k].key, &status))
        PG_TRY (read_values (load, scene, i, kinds[k].key, kinds[k].unit));
    PG_TRY (status);
    if (load->cracks) check_cracks (problem, load, scene, i);
    snprintf (path, sizeof path, "boundary[%zu].spring_end", i);
    if (load->kind != PG_SPRING && pg_scene_given (scene, "%s", path))
        pg_scene_fault (scene, path,
                        "is for the ends of springs, and this entry has none: spring: {x: 1 kN/mm}");
done:
    return status;
}

/* Makes names of loads unique (columns of history.csv): equal given names are an error, a name taken from the
 * set gets the number of its entry appended. */
static void name_apart (pg_problem *problem, const pg_scene *scene)
{
    char path[64];
    for (size_t i = 1; i < problem->boundary.nload; i++)
        for (size_t k = 0; k < i; k++) {
            if (strcmp (problem->boundary.load[i].name, problem->boundary.load[k].name) != 0) continue;
            snprintf (path, sizeof path, "boundary[%zu].name", i);
            if (problem->boundary.load[i].platen)
                pg_scene_fault (scene, "platens", "boundary or another platen has the name %s too",
                                problem->boundary.load[i].name);
            else if (pg_scene_given (scene, "%s", path))
                pg_scene_fault (scene, path, "boundary[%zu] has this name too", k);
            else {
                char longer[64];
                snprintf (longer, sizeof longer, "%.40s_%zu", problem->boundary.load[k].name, i + 1);
                memcpy (problem->boundary.load[i].name, longer, sizeof longer);
            }
        }
}

/* Reads all loads, supports, platens and stages, then checks supports against each other. */
pg_status pg_loads_read (pg_problem *problem, const pg_scene *scene)
{
    pg_status status = PG_OK;
    int is_static = pg_scene_entry_is (scene, "solver.kind", PG_SOLVER_QUASI_STATIC);
    double duration = is_static ? 1 : pg_scene_number (scene, "solver.end");
    if (!is_static && !(duration > 0) && pg_scene_has (scene, "solver.time_steps"))
        duration = (double) pg_scene_integer (scene, "solver.time_steps")
                   * pg_scene_number (scene, "solver.dt");
    if (!(duration > 0)) duration = 1;
    size_t own = pg_scene_count (scene, "boundary");
    problem->boundary.nload = own + pg_platens_loads (scene);
    PG_ALLOC (problem->boundary.load, problem->boundary.nload);
    for (size_t i = 0; i < own; i++)
        PG_TRY (read_load (problem, &problem->boundary.load[i], scene, i, is_static, duration));
    PG_TRY (pg_platens_read (problem, scene, own, is_static, duration));
    name_apart (problem, scene);
    PG_TRY (pg_stages_read (problem, scene));
    if (problem->boundary.nstage) duration = (double) problem->boundary.nstage;
    pg_supports_check (problem, scene, duration);
    pg_loads_check_finite (problem, scene, duration);
    pg_supports_check_eliminated (problem, scene);
done:
    return status;
}

void pg_loads_clear (pg_problem *problem)
{
    for (size_t i = 0; problem->boundary.load && i < problem->boundary.nload; i++) {
        for (int k = 0; k < 3; k++) pg_expression_free (&problem->boundary.load[i].value[k]);
        for (int k = 0; k < 3; k++) pg_expression_free (&problem->boundary.load[i].angle[k]);
        pg_expression_free (&problem->boundary.load[i].ramp);
        pg_free (problem->boundary.load[i].table), pg_free (problem->boundary.load[i].share);
        pg_free (problem->boundary.load[i].per_material);
        if (problem->boundary.load[i].own) pg_free (problem->boundary.load[i].own->point);
        pg_free (problem->boundary.load[i].own);
    }
    pg_free (problem->boundary.load), pg_free (problem->boundary.platen);
}
