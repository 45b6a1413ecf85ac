/* SPDX-License-Identifier: GPL-3.0-or-later
 * Rigid platens and indenters (key `platens`): their surfaces and their loads. Each has up to two loads of
 * its own, which follow those of `boundary`, so that ramps, stages of loading and columns of results treat
 * platens like supports: one for its displacement, one for its force. */
#include "model.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Set of the loads of platens, without points and facets, as platens act by contact only. */
static const pg_set nothing = { .name = "platen" };

/* ---- surfaces ------------------------------------------------------------------------------------------ */
/* Removes the component of v along the axis of a 3D cylinder; other shapes: unchanged. */
static void across (const pg_platen *p, int dim, double *v)
{
    double along = 0;
    if (p->shape != PG_PLATEN_CYLINDER || dim < 3) return;
    for (int k = 0; k < dim; k++) along += v[k] * p->normal[k];
    for (int k = 0; k < dim; k++) v[k] -= along * p->normal[k];
}

double pg_platen_distance (const pg_platen *p, int dim, const double *x, double *normal)
{
    double v[3] = { 0 }, height = 0, size = 0, beside = 0, sign = p->concave ? -1 : 1;
    for (int k = 0; k < dim; k++) v[k] = x[k] - p->point[k];
    if (p->shape == PG_PLATEN_PLANE) {
        for (int k = 0; k < dim; k++) height += v[k] * p->normal[k];
        for (int k = 0; k < dim; k++) {
            normal[k] = p->normal[k];
            beside += (v[k] - height * normal[k]) * (v[k] - height * normal[k]);
        }
        return sqrt (beside) > 0.5 * p->width * (1 + 1e-9) ? INFINITY : height;
    }
    across (p, dim, v);
    for (int k = 0; k < dim; k++) size += v[k] * v[k];
    size = sqrt (size);
    for (int k = 0; k < dim; k++) normal[k] = size > 0 ? sign * v[k] / size : k == 0;
    return sign * (size - p->radius);
}

/* ---- reading ------------------------------------------------------------------------------------------- */
size_t pg_platens_loads (const pg_scene *scene)
{
    size_t n = 0;
    for (size_t i = 0; i < pg_scene_count (scene, "platens"); i++)
        n += (size_t) pg_scene_given (scene, "platens[%zu].displacement", i)
             + (size_t) pg_scene_given (scene, "platens[%zu].force", i);
    return n;
}

/* Reads a direction of any nonzero length into p->normal, as a unit vector. */
static void read_direction (pg_platen *p, const pg_scene *scene, size_t i, int dim, const char *key)
{
    char path[64];
    double size = 0;
    snprintf (path, sizeof path, "platens[%zu].%s", i, key);
    if (!pg_scene_given (scene, "%s", path)) {
        pg_scene_fault (scene, path, "shape: %s needs it", pg_scene_text (scene, "platens[%zu].shape", i));
        p->normal[0] = 1;
        return;
    }
    pg_scene_vector (scene, 3, p->normal, "%s", path);
    for (int k = 0; k < dim; k++) size += p->normal[k] * p->normal[k];
    if (!(size > 0)) pg_scene_fault (scene, path, "is a direction, which needs a length");
    for (int k = 0; k < dim && size > 0; k++) p->normal[k] /= sqrt (size);
}

/* Reports keys without meaning for this shape as errors. */
static void refuse_others (const pg_scene *scene, size_t i, const char *shape, const char *const *keys)
{
    for (; *keys; keys++) {
        char path[64];
        snprintf (path, sizeof path, "platens[%zu].%s", i, *keys);
        if (pg_scene_given (scene, "%s", path))
            pg_scene_fault (scene, path, "has no meaning with shape: %s: leave it out", shape);
    }
}

static void read_shape (pg_platen *p, const pg_scene *scene, size_t i, int dim)
{
    const char *shape = pg_scene_text (scene, "platens[%zu].shape", i);
    char path[64];
    p->shape = strcmp (shape, "sphere") == 0     ? PG_PLATEN_SPHERE
               : strcmp (shape, "cylinder") == 0 ? PG_PLATEN_CYLINDER
                                                 : PG_PLATEN_PLANE;
    p->width = INFINITY;
    p->concave = pg_scene_bool (scene, "platens[%zu].concave", i);
    pg_scene_vector (scene, 3, p->point, "platens[%zu].point", i);
    if (p->shape == PG_PLATEN_PLANE) {
        refuse_others (scene, i, shape, (const char *const[]) { "radius", "concave", "axis", NULL });
        read_direction (p, scene, i, dim, "normal");
        if (pg_scene_given (scene, "platens[%zu].width", i))
            p->width = pg_scene_number (scene, "platens[%zu].width", i);
        return;
    }
    refuse_others (scene, i, shape, (const char *const[]) { "normal", "width", NULL });
    if (p->shape == PG_PLATEN_SPHERE || dim < 3)
        refuse_others (scene, i, dim < 3 ? "cylinder in the plane" : shape,
                       (const char *const[]) { "axis", NULL });
    else read_direction (p, scene, i, dim, "axis");
    if (p->shape == PG_PLATEN_SPHERE && dim < 3) {
        snprintf (path, sizeof path, "platens[%zu].shape", i);
        pg_scene_fault (scene, path, "a %dD body has no spheres: use cylinder", dim);
    }
    snprintf (path, sizeof path, "platens[%zu].radius", i);
    if (!pg_scene_given (scene, "%s", path)) pg_scene_fault (scene, path, "shape: %s needs it", shape);
    p->radius = pg_scene_number (scene, "%s", path);
}

/* Reads the time factor of a load: linear (from 0 to 1 over the run; duration in s, quasi-static 1),
 * constant, or an expression; with stages of loading a table. */
static pg_status read_ramp (pg_load *load, const pg_scene *scene, const char *path, int is_static,
                            double duration)
{
    pg_status status = PG_OK;
    size_t nstage = pg_scene_count (scene, "stages");
    char over[48];
    const char *ramp = pg_scene_text (scene, "%s", path), *text = ramp;
    int constant = ramp && strcmp (ramp, "constant") == 0,
        linear = !ramp || !*ramp || strcmp (ramp, "linear") == 0;
    if (nstage && !constant) {
        if (pg_scene_given (scene, "%s", path))
            pg_scene_fault (scene, path,
                            "the stages say how loads grow: leave it out, or give constant for what acts in "
                            "full in all of them");
        load->ntable = nstage + 1;
        PG_ALLOC (load->table, 2 * load->ntable);
        return PG_OK;
    }
    snprintf (over, sizeof over, "t * %.17g", 1 / duration);
    if (linear) text = over, load->proportional = is_static;
    if (constant) text = "1";
    if (pg_expression_compile (&load->ramp, text, "1") == PG_OK) goto done;
    pg_scene_fault (scene, path, "linear, constant or an expression in t: %s", pg_last_error ());
    PG_TRY (pg_expression_compile (&load->ramp, "1", "1"));
done:
    return status;
}

/* Reads component k of a load of a platen: an expression of t alone, along an axis without another load. */
static pg_status read_component (pg_problem *problem, pg_platen *p, pg_load *load, const pg_scene *scene,
                                 const char *path, int k, const char *text)
{
    pg_status status = PG_OK;
    int force = load->kind == PG_PLATEN_FORCE;
    if (k >= problem->dim) {
        pg_scene_fault (scene, path, "a %dD body has no such component", problem->dim);
        return PG_OK;
    }
    PG_TRY (pg_expression_compile (&load->value[k], text, force ? "N" : "m"));
    int places = 0;
    for (const char *c = "xyzra"; *c; c++) places |= pg_expression_uses (load->value[k], *c);
    if (places)
        pg_scene_fault (scene, path, "a rigid platen has one for all places: an expression of t alone");
    if (pg_expression_uses (load->value[k], 't')) load->proportional = 0;
    if (force && p->motion >= 0 && problem->boundary.load[p->motion].value[k])
        pg_scene_fault (scene, path, "along %c it is moved by a displacement: leave one of them out",
                        "xyz"[k]);
    if (force) p->free[k] = 1;
done:
    return status;
}

/* Reads one load of platen i, `displacement` or `force`, which does not depend on position. */
static pg_status read_load (pg_problem *problem, size_t i, const pg_scene *scene, size_t at,
                            pg_load_kind kind, int is_static, double duration)
{
    pg_status status = PG_OK;
    pg_load *load = &problem->boundary.load[at];
    pg_platen *p = &problem->boundary.platen[i];
    char path[96];
    int found = 0, force = kind == PG_PLATEN_FORCE, second = force && p->motion >= 0;
    const char *key = force ? "force" : "displacement";
    load->kind = kind, load->set = &nothing, load->platen = (int) i + 1;
    load->essential = PG_ESSENTIAL_NITSCHE;            /* so that it constrains no points */
    snprintf (load->name, sizeof load->name, second ? "%.57s.force" : "%.63s", p->name);
    int own = second || (force && pg_scene_given (scene, "platens[%zu].force_ramp", i));
    snprintf (path, sizeof path, "platens[%zu].%s", i, own ? "force_ramp" : "ramp");
    PG_TRY (read_ramp (load, scene, path, is_static, duration));
    for (int k = 0; k < 3; k++) {
        const char *text = pg_scene_text (scene, "platens[%zu].%s.%c", i, key, "xyz"[k]);
        if (!text || !*text) continue;
        snprintf (path, sizeof path, "platens[%zu].%s.%c", i, key, "xyz"[k]);
        found = 1;
        PG_TRY (read_component (problem, p, load, scene, path, k, text));
    }
    snprintf (path, sizeof path, "platens[%zu].%s", i, key);
    if (!found) pg_scene_fault (scene, path, "at least one component x, y, z is needed");
    *(force ? &p->force : &p->motion) = (int) at;
done:
    return status;
}

pg_status pg_platens_read (pg_problem *problem, const pg_scene *scene, size_t at, int is_static,
                           double duration)
{
    pg_status status = PG_OK;
    size_t n = pg_scene_count (scene, "platens");
    PG_ALLOC (problem->boundary.platen, n);
    problem->boundary.nplaten = n;
    if (n && problem->dim < 2) pg_scene_fault (scene, "platens", "a bar has supports and loads alone");
    for (size_t i = 0; i < n; i++) {
        pg_platen *p = &problem->boundary.platen[i];
        p->motion = p->force = -1;
        snprintf (p->name, sizeof p->name, "%.63s", pg_scene_text (scene, "platens[%zu].name", i));
        for (size_t k = 0; k < i; k++) {
            char path[64];
            if (strcmp (problem->boundary.platen[k].name, p->name) != 0) continue;
            snprintf (path, sizeof path, "platens[%zu].name", i);
            pg_scene_fault (scene, path, "platens[%zu] has this name too", k);
            break;
        }
        read_shape (p, scene, i, problem->dim);
        p->friction = pg_scene_number (scene, "platens[%zu].friction", i);
        p->mass = pg_scene_number (scene, "platens[%zu].mass", i);
        pg_scene_vector (scene, 3, p->velocity, "platens[%zu].velocity", i);
        p->tilts = strcmp (pg_scene_text (scene, "platens[%zu].tilt", i), "free") == 0;
        if (pg_scene_given (scene, "platens[%zu].displacement", i))
            PG_TRY (read_load (problem, i, scene, at++, PG_PLATEN_MOTION, is_static, duration));
        if (pg_scene_given (scene, "platens[%zu].force", i))
            PG_TRY (read_load (problem, i, scene, at++, PG_PLATEN_FORCE, is_static, duration));
    }
done:
    return status;
}
