/* SPDX-License-Identifier: GPL-3.0-or-later
 * The box in which a lattice is measured: a scene with the first material, the lattice steps and the method
 * of the given scene, but no loads, no supports and no criterion. As a scene the box passes through the same
 * reader and the same set-up as every other body.
 *
 * The steps of a lattice follow from the sizes of the body and may differ a little between the axes. In the
 * box the spacing sets the steps along all axes but one; along the axis that differs most the box is one
 * cell between two layers, whose thickness sets the step. */
#include "symbol.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

/* ---- text ---------------------------------------------------------------------------------------------- */
/* A text that grows. */
typedef struct { char *text; size_t used, cap; } writing;

static pg_status put (writing *w, const char *format, ...) __attribute__ ((format (printf, 2, 3)));
/* Appends formatted text, at most 1023 bytes at a time. */
static pg_status put (writing *w, const char *format, ...)
{
    pg_status status = PG_OK;
    char line[1024];
    va_list args;
    va_start (args, format);
    int n = vsnprintf (line, sizeof line, format, args);
    va_end (args);
    if (n < 0 || (size_t) n >= sizeof line) PG_FAIL (PG_E_USAGE, "a value of the scene is too long");
    PG_GROW (w->text, w->cap, w->used + (size_t) n + 1);
    memcpy (w->text + w->used, line, (size_t) n + 1);
    w->used += (size_t) n;
done:
    return status;
}

/* Writes "name: value" with the value of a key in the given scene. Numbers have 17 digits, so that the box
 * gets the same bits; maps and lists are not copied. */
static pg_status put_key (writing *w, const pg_scene *scene, const pg_key *key, const char *path,
                          const char *name)
{
    switch (key->kind) {
    case PG_NUMBER:  return put (w, "%s: %.17g\n", name, pg_scene_number (scene, "%s", path));
    case PG_INTEGER: return put (w, "%s: %ld\n", name, pg_scene_integer (scene, "%s", path));
    case PG_BOOL:    return put (w, "%s: %s\n", name, pg_scene_bool (scene, "%s", path) ? "on" : "off");
    case PG_NAME:    return put (w, "%s: %s\n", name, pg_scene_text (scene, "%s", path));
    case PG_EXPRESSION:
        if (isnan (pg_scene_number (scene, "%s", path))) return PG_OK;
        return put (w, "%s: %.17g\n", name, pg_scene_number (scene, "%s", path));
    default:         return PG_OK;
    }
}

/* Writes all keys right below `root` that the scene gives below `at`. Lengths that may be in
 * spacings are left to the caller, since the spacing of the box may differ in its last digits. */
static pg_status put_keys (writing *w, const pg_scene *scene, const char *root, const char *at)
{
    pg_status status = PG_OK;
    size_t length = strlen (root);
    const pg_key *key;
    char path[256], name[80];
    for (size_t k = 0; (key = pg_scene_known_key (scene, k)); k++) {
        const char *last = key->path + length;
        if (strncmp (key->path, root, length) != 0 || strpbrk (last, ".[{")
            || (key->unit && strchr (key->unit, '|')))
            continue;
        snprintf (path, sizeof path, "%s%s", at, last);
        if (!pg_scene_given (scene, "%s", path)) continue;
        snprintf (name, sizeof name, "  %s%s", strncmp (at, "materials", 9) == 0 ? "  " : "", last);
        PG_TRY (put_key (w, scene, key, path, name));
    }
done:
    return status;
}

/* Writes the keys `body` and `layers`, with as many points on both sides of the middle one, whether points
 * are at the nodes (vertices) or at the centres of the lattice cells. */
static pg_status put_body (writing *w, const box_size *size, int dim, int vertices)
{
    static const char *const side[] = { "left", "right", "bottom", "top", "back", "front" };
    pg_status status = PG_OK;
    int odd = size->odd;
    double more = vertices ? 0 : 0.5;
    for (int high = 0; high < 2; high++) {
        PG_TRY (put (w, high ? ", high: [" : "body: [{add: {box: {low: ["));
        for (int k = 0; k < dim; k++) {
            double end = k == odd ? more + (vertices && high) : size->half[k] + more;
            PG_TRY (put (w, "%s%.17g", k ? ", " : "", (high ? end : -end) * size->step[k]));
        }
        PG_TRY (put (w, high ? "]}}}]\nlayers:\n" : "]"));
    }
    for (int high = 0; high < 2; high++)
        PG_TRY (put (w, "  - {name: l%d, side: %s, thickness: %.17g}\n", high, side[2 * odd + high],
                     (size->half[odd] - (vertices && high)) * size->step[odd]));
done:
    return status;
}

/* Writes the scene of the box as text and parses it like a user's file. Density 1 where the scene has none:
 * the stiffness does not depend on it. */
pg_status box_scene (pg_scene **out, const pg_scene *scene, const pg_problem *p, const box_size *size)
{
    pg_status status = PG_OK;
    writing w = { 0 };
    int vertices = strcmp (pg_scene_text (scene, "lattice"), "nodes") == 0;
    char material[160];
    PG_TRY (put (&w, "dimension: %d\n", p->dim));
    if (p->dim == 2)
        PG_TRY (put (&w, "plane: %s\nthickness: %.17g\n", p->mode == PG_PLANE_STRAIN ? "strain" : "stress",
                     pg_scene_number (scene, "thickness")));
    if (p->dim == 1) PG_TRY (put (&w, "cross_section: %.17g\n", pg_scene_number (scene, "cross_section")));
    PG_TRY (put_body (&w, size, p->dim, vertices));
    PG_TRY (put (&w, "spacing: %.17g\nlattice: %s\ncells: staircase\nmethod:\n", size->wanted,
                 vertices ? "nodes" : "cells"));
    PG_TRY (put_keys (&w, scene, "method.", "method."));
    PG_TRY (put (&w, "  horizon: %.17g\n", p->form.approx.horizon));
    snprintf (material, sizeof material, "materials.%.63s.", p->material[0].name);
    PG_TRY (put (&w, "materials:\n  m:\n"));
    PG_TRY (put_keys (&w, scene, "materials.{}.", material));
    if (pg_problem_graded (p) && !isnan (p->at.vary[0].reference[PG_OF_STIFFNESS]))
        PG_TRY (put (&w, "    youngs_modulus: %.17g\n", p->at.vary[0].reference[PG_OF_STIFFNESS]));
    if (!(p->material[0].density > 0)) PG_TRY (put (&w, "    density: 1\n"));
    PG_TRY (put (&w, "failure: {criterion: none}\n"));
    PG_TRY (pg_scene_parse_like (out, scene, w.text, "the lattice of the scene"));
done:
    pg_free (w.text);
    return status;
}

/* ---- size ---------------------------------------------------------------------------------------------- */
/* A typical step, m: the mean of one or two, the median of three. */
static double middle_step (const double *step, int dim)
{
    double low = step[0], high = step[0], sum = 0;
    for (int k = 0; k < dim; k++) low = fmin (low, step[k]), high = fmax (high, step[k]), sum += step[k];
    return dim < 3 ? sum / dim : sum - low - high;
}

/* Computes the steps of the box: `odd` is the axis whose step differs most from the typical one; `wanted` is
 * the mean of the others. */
pg_status box_steps (box_size *out, const pg_scene *scene, const pg_problem *p)
{
    pg_status status = PG_OK;
    double product = 1;
    if (p->part.mesh.n)
        PG_FAIL (PG_E_USAGE, "the points of a mesh lie on no lattice, so that there are no plane waves to be "
                             "told: give a body and a spacing");
    if (!p->lattice.dim)
        PG_FAIL (PG_E_USAGE, "the points of a file lie where the file says, so that there are no plane waves "
                             "to be told: give a body and a spacing");
    if (pg_scene_number (scene, "perturb.amount") > 0)
        PG_FAIL (PG_E_USAGE, "the points are moved away from their lattice at random (perturb), so that "
                             "there are no plane waves to be told: that of the lattice "
                             "itself is seen with --set perturb.amount=0");
    if (!(p->material[0].type->can & PG_MATERIAL_ISOTROPIC))
        PG_FAIL (
            PG_E_USAGE,
            "the plane waves of a lattice are compared with those of an isotropic material, and material "
            "%s is %s: use model: elastic",
            p->material[0].name, p->material[0].type->name);
    for (int k = 0; k < p->dim; k++) out->step[k] = p->lattice.step[k], product *= out->step[k];
    out->h = pow (product, 1.0 / p->dim);
    for (int k = 1; k < p->dim; k++)                   /* finds the axis that differs most */
        if (fabs (out->step[k] - middle_step (out->step, p->dim))
            > fabs (out->step[out->odd] - middle_step (out->step, p->dim)))
            out->odd = k;
    out->wanted = p->dim == 1 ? out->step[0] : 0;
    for (int k = 0; k < p->dim; k++) if (k != out->odd) out->wanted += out->step[k] / (p->dim - 1);
done:
    return status;
}

/* Fails unless rounding L / spacing to a number of cells, as the reader of scenes does, gives the right
 * number along each axis, with some margin (0.49 of a cell). */
pg_status box_fits (const box_size *size, int dim)
{
    pg_status status = PG_OK;
    for (int k = 0; k < dim; k++) {
        double cells = k == size->odd ? 1 : 2 * size->half[k] + 1;
        if (!(fabs (cells * (size->step[k] / size->wanted - 1)) < 0.49))
            PG_FAIL (PG_E_USAGE,
                     "the steps of the lattice along x, y, z differ too much for its waves to be told (%.6g, "
                     "%.6g, %.6g m): take a spacing that divides "
                     "the sizes of the body",
                     size->step[0], dim > 1 ? size->step[1] : 0, dim > 2 ? size->step[2] : 0);
    }
done:
    return status;
}
