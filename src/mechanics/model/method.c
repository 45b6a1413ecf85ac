/* SPDX-License-Identifier: GPL-3.0-or-later
 * Use of the descriptors of force models (pg_method): choice by the scene, ignored keys, supported materials
 * and failure criteria. */
#include "model.h"
#include <stdio.h>
#include <string.h>

/* Finds the force model named by method.force; NULL: there is none of this name. */
const pg_method *pg_method_of (const pg_method *const *methods, const pg_scene *scene)
{
    const char *name = pg_scene_text (scene, "method.force");
    for (; name && *methods; methods++) if (strcmp ((*methods)->name, name) == 0) return *methods;
    return NULL;
}

/* Reads shape functions, or (forces without) only horizon and kernel of bonds between points. */
pg_status pg_method_approx (pg_approx *out, const pg_method *method, const pg_scene *scene, double spacing)
{
    if (method->shape_functions) return pg_approx_read (out, scene, spacing);
    return pg_approx_read_points (out, scene, spacing, method->kernel, method->horizon);
}

/* Compares with measured thresholds (pg_method.iterate_above). */
int pg_method_iterates (const pg_method *method, int preconditioned, int dim, double dofs)
{
    double most = method->iterate_above[preconditioned ? 0 : 1][dim];
    return most > 0 && dofs > most;
}

int pg_problem_rotations (const pg_problem *p) { return p->method ? p->method->rotations[p->dim] : 0; }
int pg_problem_unknowns (const pg_problem *p) { return p->dim + pg_problem_rotations (p); }

/* ---- forces with a property ---------------------------------------------------------------------------- */
/* Tests of force models for names_of; the second argument is used by some only. */
static int shows_all (const pg_method *m, int needs) { return !(needs & ~m->shows); }
static int has_rotations (const pg_method *m, int dim) { return m->rotations[dim] > 0; }
static int carries_any (const pg_method *m, int unused)
{
    (void) unused;
    return m->anisotropic;
}
static int has_shapes (const pg_method *m, int unused)
{
    (void) unused;
    return m->shape_functions;
}
static int is_of_points (const pg_method *m, int unused)
{
    (void) unused;
    return !m->shape_functions;
}

/* "a, b or c": the names of the forces that have a property; "": none. */
static const char *names_of (const pg_problem *p, int (*has) (const pg_method *, int), int what, char *out,
                             size_t size)
{
    size_t used = 0, left = 0, first = 1;
    for (const pg_method *const *m = p->methods; *m; m++) left += (size_t) (has (*m, what) != 0);
    out[0] = '\0';
    for (const pg_method *const *m = p->methods; *m && used < size; m++) {
        if (!has (*m, what)) continue;
        used += (size_t) snprintf (out + used, size - used, "%s%s", first ? "" : left == 1 ? " or " : ", ",
                                   (*m)->name);
        first = 0, left--;
    }
    return out;
}

/* Names, for messages, of forces without shape functions; below: of forces whose points have rotations. */
const char *pg_methods_of_points (const pg_problem *p, char *out, size_t size)
{
    return names_of (p, is_of_points, 0, out, size);
}

const char *pg_methods_with_rotations (const pg_problem *p, char *out, size_t size)
{
    return names_of (p, has_rotations, p->dim, out, size);
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
/* Notes keys that are ignored: those of other forces, and `essential` with forces without shape functions.
 * They are no errors, as a scene may be run with several forces. */
void pg_method_note_ignored (pg_problem *p, const pg_scene *scene)
{
    char path[PG_STRAY_PATH], text[200] = "";
    const char *key;
    size_t used = 0;
    for (size_t k = 0; (key = pg_scene_stray (scene, k, "method", path)); k++)
        if (used + 40 < sizeof text)
            used += (size_t) snprintf (text + used, sizeof text - used, "%s%s", used ? ", " : "", key);
    if (used) pg_problem_note (p, "ignored with force: %s: %s of method", p->method->name, text);
    for (size_t i = 0; !p->method->support && i < pg_scene_count (scene, "boundary"); i++) {
        const char *how = pg_scene_text (scene, "boundary[%zu].essential", i);
        if (!pg_scene_given (scene, "boundary[%zu].essential", i) || !how) continue;
        if (strcmp (how, "auto") != 0 && strcmp (how, "transformation") != 0)
            pg_problem_note (p,
                             "ignored with force: %s: boundary[%zu].essential (the displacements of points "
                             "are prescribed as they are)",
                             p->method->name, i);
    }
}

/* ---- materials and criteria ---------------------------------------------------------------------------- */
/* Reports materials that the force does not support as errors. */
pg_status pg_method_check_materials (const pg_problem *p, const pg_scene *scene)
{
    char path[120], names[160];
    for (size_t m = 0; m < p->nmaterial && !p->method->anisotropic; m++) {
        if (p->material[m].type->can & PG_MATERIAL_ISOTROPIC) continue;
        snprintf (path, sizeof path, "materials.%.63s.model", p->material[m].name);
        pg_scene_fault (scene, path,
                        "force: %s makes its bonds from Young's modulus and Poisson's ratio and cannot carry "
                        "a material that depends on the direction: use force: %s, or an isotropic model",
                        p->method->name, names_of (p, carries_any, 0, names, sizeof names));
    }
    return pg_scene_verdict (scene);
}

/* The measures among PG_NEEDS_..., in words: "stretch and energy". */
static const char *measures_of (int needs, char *out, size_t size)
{
    static const struct { int need; const char *word; } words[] = {
        { PG_NEEDS_STRETCH, "stretch" },
        { PG_NEEDS_BEAMS, "shear and bending" },
        { PG_NEEDS_STRESS, "stress" },
        { PG_NEEDS_ENERGY, "energy" },
        { PG_NEEDS_FACETS, "displacement gradient" },
    };
    size_t used = 0;
    out[0] = '\0';
    for (size_t k = 0; k < sizeof words / sizeof *words && used < size; k++)
        if (needs & words[k].need)
            used += (size_t) snprintf (out + used, size - used, "%s%s",
                                       !used                          ? ""
                                       : strchr (words[k].word, ' ') ? ", "
                                                                      : " and ",
                                       words[k].word);
    return out;
}

/* The k-th criterion of the catalogue; NULL past the last. */
static const pg_criterion_type *criterion_at (size_t k)
{
    const char *at = pg_criterion_names ();
    char name[64];
    for (; *at && k > 0; k--) {
        at += strcspn (at, "|");
        at += *at == '|';
    }
    snprintf (name, sizeof name, "%.*s", (int) strcspn (at, "|"), at);
    return *name ? pg_criterion_find (name) : NULL;
}

/* "a, b": the criteria for which a force provides the measures. */
static const char *criteria_of (const pg_method *m, char *out, size_t size)
{
    const pg_criterion_type *type;
    size_t used = 0;
    out[0] = '\0';
    for (size_t k = 0; (type = criterion_at (k)) && used < size; k++)
        if (shows_all (m, type->needs))
            used += (size_t) snprintf (out + used, size - used, "%s%s", used ? ", " : "", type->name);
    return out;
}

/* Reports a criterion whose measures the force does not provide as an error that names usable criteria and
 * usable forces. */
void pg_method_check_criterion (const pg_problem *p, const pg_scene *scene)
{
    const pg_criterion_type *type = p->criterion->type;
    char lacks[80], shows[80], criteria[160], forces[160];
    if (pg_criterion_of_tips (p->criterion) && (p->dim == 1 || (p->dim == 3 && !p->method->shape_functions)))
        pg_scene_fault (scene, "failure.criterion",
                        "%s grows cracks in the plane, and in space with force: %s; dimension is %d: use "
                        "another one",
                        type->name, names_of (p, has_shapes, 0, forces, sizeof forces), p->dim);
    if (!type || shows_all (p->method, type->needs)) return;
    names_of (p, shows_all, type->needs, forces, sizeof forces);
    pg_scene_fault (scene, "failure.criterion",
                    "%s needs the %s of bonds, and those of force: %s show only %s: use %s%s%s", type->name,
                    measures_of (type->needs & ~p->method->shows, lacks, sizeof lacks), p->method->name,
                    measures_of (p->method->shows & ~PG_NEEDS_FACETS, shows, sizeof shows),
                    criteria_of (p->method, criteria, sizeof criteria), *forces ? ", or force: " : "",
                        forces);
}
