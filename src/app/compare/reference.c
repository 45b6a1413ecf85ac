/* SPDX-License-Identifier: GPL-3.0-or-later
 * Reads the section `reference` of a scene (closed forms, tables, a finite element result, a
 * condition) and makes the closed forms a sampler. */
#include "compare.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Names of the stress components in the scene. */
static const char *const voigt[6] = { "xx", "yy", "zz", "xy", "yz", "zx" };

/* 1 if a body of this dimension has the stress component k in its norms. */
static int has_stress (int dim, int k) { return dim == 3 || k == 0 || (dim == 2 && (k == 1 || k == 3)); }

/* Compiles an expression if the key is given; *out stays NULL otherwise. */
static pg_status read_expression (pg_expression **out, const pg_scene *scene, const char *path,
                                  const char *unit)
{
    pg_status status = PG_OK;
    const char *text = pg_scene_text (scene, "%s", path);
    if (!pg_scene_given (scene, "%s", path) || !text || !*text) return PG_OK;
    PG_TRY (pg_expression_compile (out, text, unit));
done:
    return status;
}

/* Reads the closed forms. Displacement components may be missing; stress must be complete,
 * because the energy norm couples the components. A component that the dimension does not have
 * is a fault. The condition must not depend on time, so that all steps are compared on the
 * same part of the body. */
static pg_status read_forms (pg_reference *r, const pg_scene *scene)
{
    pg_status status = PG_OK;
    char path[64];
    int stresses = 0, needed = 0;
    for (int k = 0; k < 3; k++) {
        snprintf (path, sizeof path, "reference.displacement.%c", "xyz"[k]);
        PG_TRY (read_expression (&r->u[k], scene, path, "m"));
        if (r->u[k] && k >= r->dim) pg_scene_fault (scene, path, "a %dD body has no such component", r->dim);
    }
    for (int k = 0; k < 6; k++) {
        snprintf (path, sizeof path, "reference.stress.%s", voigt[k]);
        PG_TRY (read_expression (&r->s[k], scene, path, "Pa"));
        needed += has_stress (r->dim, k), stresses += r->s[k] && has_stress (r->dim, k);
        if (r->s[k] && !has_stress (r->dim, k))
            pg_scene_fault (scene, path, "is not compared in %dD", r->dim);
    }
    if (stresses && stresses < needed)
        pg_scene_fault (scene, "reference.stress", "needs %s: the energy norm takes all of them",
                        r->dim == 1   ? "xx"
                        : r->dim == 2 ? "xx, yy, xy"
                                      : "xx, yy, zz, xy, yz, zx");
    PG_TRY (read_expression (&r->where, scene, "reference.where", "bool"));
    if (r->where && pg_expression_uses (r->where, 't'))
        pg_scene_fault (scene, "reference.where", "does not change with t");
done:
    return status;
}

/* Metres in a unit of length, "mm" or "0.5 m"; 1 if no text is given. Returns 0 for anything
 * else. */
static int length_unit (const char *text, double *unit)
{
    char one[96];
    *unit = 1;
    if (!text || !*text) return 1;
    snprintf (one, sizeof one, "1 %.80s", text);
    return (pg_unit_parse (unit, one, "m") == PG_OK || pg_unit_parse (unit, text, "m") == PG_OK) && *unit > 0;
}

/* Reads table i of the list with its unit, its factor, the coordinates that it lacks, and its
 * datum. A fault in the file becomes a fault of the scene at the key that names the file. */
static pg_status read_line (pg_reference *r, const pg_scene *scene, size_t i)
{
    pg_status status = PG_OK;
    char key[64], *path = NULL;
    double unit, along[3] = { 0 };
    snprintf (key, sizeof key, "reference.lines[%zu].unit", i);
    if (!length_unit (pg_scene_text (scene, "%s", key), &unit))
        pg_scene_fault (scene, key, "must be a unit of length, such as mm");
    for (int k = 0; k < 3; k++) {
        snprintf (key, sizeof key, "reference.lines[%zu].along.%c", i, "xyz"[k]);
        if (!pg_scene_given (scene, "%s", key)) continue;
        if (k >= r->dim) pg_scene_fault (scene, key, "a %dD body has no such coordinate", r->dim);
        along[k] = pg_scene_number (scene, "%s", key);
    }
    PG_TRY (pg_scene_verdict (scene));
    snprintf (key, sizeof key, "reference.lines[%zu].file", i);
    PG_TRY (pg_scene_beside (&path, scene, pg_scene_text (scene, "%s", key)));
    status = pg_line_read (&r->line[i], path, r->dim, unit,
                           pg_scene_number (scene, "reference.lines[%zu].factor", i), along);
    if (status == PG_E_FILE) {
        pg_scene_fault (scene, key, "%s", pg_last_error ());
        status = pg_scene_verdict (scene);
    }
    PG_TRY (status);
    r->line[i].relative = pg_scene_given (scene, "reference.lines[%zu].datum", i);
    if (r->line[i].relative)
        pg_scene_vector (scene, r->dim, r->line[i].datum, "reference.lines[%zu].datum", i);
done:
    pg_free (path);
    return status;
}

/* Gauss points per direction of the norms: two more than the run has, at most 5. A run without
 * method.gauss_points has one more than the order of its basis. */
int pg_norm_order (const pg_scene *scene, const pg_problem *problem)
{
    int own = pg_scene_given (scene, "method.gauss_points")
                  ? (int) pg_scene_integer (scene, "method.gauss_points")
                  : problem->form.approx.order + 1;
    return own + 2 > 5 ? 5 : own + 2;
}

/* Reads a finite element result, moved and scaled as the scene says. It excludes closed forms
 * of displacement, since there can be only one field to compare with. */
static pg_status read_mesh (pg_reference *r, const pg_scene *scene, const pg_problem *problem)
{
    pg_status status = PG_OK;
    char *path = NULL;
    double unit, shift[3] = { 0 };
    pg_sampler plain = { 0 };
    int step = pg_scene_given (scene, "reference.mesh.step")
                   ? (int) pg_scene_integer (scene, "reference.mesh.step")
                   : -1;
    if (r->u[0] || r->u[1] || r->u[2])
        pg_scene_fault (scene, "reference.mesh", "and reference.displacement exclude each other");
    if (!length_unit (pg_scene_text (scene, "reference.mesh.unit"), &unit))
        pg_scene_fault (scene, "reference.mesh.unit", "must be a unit of length, such as mm");
    pg_scene_vector (scene, 3, shift, "reference.mesh.shift");
    PG_TRY (pg_scene_verdict (scene));
    PG_TRY (pg_scene_beside (&path, scene, pg_scene_text (scene, "reference.mesh.file")));
    status = pg_sampler_mesh (&plain, path, step, unit, problem);
    if (status == PG_E_FILE || status == PG_E_USAGE) {
        pg_scene_fault (scene, "reference.mesh.file", "%s", pg_last_error ());
        status = pg_scene_verdict (scene);
    }
    PG_TRY (status);
    PG_TRY (pg_sampler_moved (&r->mesh, &plain, shift, pg_scene_number (scene, "reference.mesh.factor")));
done:
    pg_sampler_clear (&plain);
    pg_free (path);
    return status;
}

/* Reads the section. All its faults are collected before the scene gives its verdict, so that the user sees
 * them at once. */
pg_status pg_reference_read (pg_reference **out, const pg_scene *scene, const pg_problem *problem)
{
    pg_status status = PG_OK;
    pg_reference *r = NULL;
    *out = NULL;
    if (!pg_scene_given (scene, "reference")) return PG_OK;
    PG_ALLOC (r, 1);
    r->dim = problem->dim, r->threads = problem->threads;
    r->order = pg_norm_order (scene, problem);
    PG_TRY (read_forms (r, scene));
    size_t n = pg_scene_count (scene, "reference.lines");
    PG_ALLOC (r->line, n);
    for (; r->nline < n; r->nline++) PG_TRY (read_line (r, scene, r->nline));
    if (pg_scene_given (scene, "reference.mesh")) PG_TRY (read_mesh (r, scene, problem));
    PG_TRY (pg_scene_verdict (scene));
    *out = r;
    r = NULL;
done:
    pg_reference_free (&r);
    return status;
}

/* Returns the tables in the order of the scene. */
const pg_line *pg_reference_lines (const pg_reference *r, size_t *n)
{
    *n = r->nline;
    return r->line;
}

/* Frees a reference, even if it was read in part only. */
void pg_reference_free (pg_reference **reference)
{
    pg_reference *r = *reference;
    if (!r) return;
    for (int k = 0; k < 3; k++) pg_expression_free (&r->u[k]);
    for (int k = 0; k < 6; k++) pg_expression_free (&r->s[k]);
    pg_expression_free (&r->where);
    pg_sampler_clear (&r->mesh);
    for (size_t i = 0; i < r->nline; i++) pg_line_clear (&r->line[i]);
    pg_free (r->line);
    pg_free (r);
    *reference = NULL;
}

/* ---- closed forms as a sampler ------------------------------------------------------------------------- */
/* forms: context of the sampler, closed forms at time t. sampling: one call of it. */
typedef struct { const pg_reference *r; double t; } forms;
typedef struct { const forms *f; const double *x; double *u, *stress; } sampling;

/* Evaluates the closed forms at the places first to last - 1; each thread writes its own
 * places. */
static void evaluate (void *context, size_t first, size_t last, int thread)
{
    const sampling *s = context;
    const pg_reference *r = s->f->r;
    (void) thread;
    for (size_t i = first; i < last; i++) {
        pg_place at = pg_place_of (r->dim, s->x + i * (size_t) r->dim, s->f->t);
        for (int k = 0; k < 3; k++)
            s->u[3 * i + (size_t) k] = k >= r->dim ? 0 : r->u[k] ? pg_expression_value (r->u[k], &at) : NAN;
        for (int k = 0; s->stress && k < 6; k++)
            s->stress[6 * i + (size_t) k] = r->s[k] ? pg_expression_value (r->s[k], &at) : NAN;
    }
}

/* Closed forms are evaluated with threads; every place is written by one of them. */
static pg_status sample_forms (void *context, size_t n, const double *x, double *u, double *stress)
{
    const forms *f = context;
    sampling s = { f, x, u, stress };
    pg_parallel (f->r->threads, n, evaluate, &s);
    return PG_OK;
}

/* Makes the sampler of the reference field. That of a finite element result stays with the reference:
 * clearing the copy frees nothing. */
pg_status pg_reference_sampler (pg_sampler *out, const pg_reference *r, double t)
{
    pg_status status = PG_OK;
    forms *f = NULL;
    memset (out, 0, sizeof *out);
    if (r->mesh.sample) {
        *out = r->mesh;
        out->free = NULL;                              /* the reference owns the mesh */
        return PG_OK;
    }
    PG_ALLOC (f, 1);
    *f = (forms) { r, t };
    *out = (pg_sampler) { f, r->dim, 0, 0, sample_forms, pg_free };
    for (int k = 0; k < 3; k++) out->displacement |= (r->u[k] != NULL) << k;
    for (int k = 0; k < 6; k++) out->stress |= (r->s[k] != NULL) << k;
done:
    return status;
}
