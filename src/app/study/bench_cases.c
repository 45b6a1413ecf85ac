/* SPDX-License-Identifier: GPL-3.0-or-later
 * The cases of a benchmark: every combination of the words on the command line or, for lists that are not
 * given, of the entries of the catalogues. */
#include "bench.h"
#include <stdlib.h>
#include <string.h>

/* Writes the name of a scene: FOLDER for FOLDER/scene.yaml, FOLDER_X for FOLDER/scene_X.yaml, else the file
 * without .yaml. */
static void name_of (const char *path, char *name, size_t size)
{
    const char *file = strrchr (path, '/'), *folder = path;
    file = file ? file + 1 : path;
    int rest = (int) strlen (file),
        dot = rest > 5 && strcmp (file + rest - 5, ".yaml") == 0 ? rest - 5 : rest;
    if (file > path) for (const char *p = path; p + 1 < file; p++) if (*p == '/') folder = p + 1;
    if (file == path || strncmp (file, "scene", 5) != 0) snprintf (name, size, "%.*s", dot, file);
    else snprintf (name, size, "%.*s%.*s", (int) (file - 1 - folder), folder, dot - 5, file + 5);
}

/* Reads the properties of a scene, which is loaded with the overrides of the request, since these may change
 * its spacing or its body. */
pg_status pg_bench_look (pg_bench_base *b, const char *path, size_t nset, const char *const *set)
{
    pg_status status = PG_OK;
    pg_scene *scene = NULL;
    PG_TRY (pg_scene_load_with (&scene, path, nset, set));
    b->spacing = pg_scene_given (scene, "spacing") ? pg_scene_number (scene, "spacing") : 0;
    b->horizon = b->spacing > 0 ? pg_scene_length (scene, b->spacing, "method.horizon") / b->spacing : 0;
    b->has_horizon = pg_scene_given (scene, "method.horizon");
    b->mesh = pg_scene_given (scene, "mesh.file");
    b->quadratic = strcmp (pg_scene_text (scene, "method.basis"), "quadratic") == 0;
    name_of (path, b->name, sizeof b->name);
done:
    pg_scene_free (&scene);
    return status == PG_E_FILE ? PG_E_SCENE : status;
}

/* Fills a list that was not given from "a|b|c". */
static void fill (pg_word_list *w, const char *names)
{
    if (w->given) return;
    for (const char *s = names; *s && w->n < PG_LIST_WORDS; s += strcspn (s, "|"), s += *s == '|')
        snprintf (w->word[w->n++], PG_LIST_TEXT, "%.*s", (int) strcspn (s, "|"), s);
}

/* Appends " spacing" to numbers without a unit, as in `converge --horizon`. */
static void count_spacings (pg_word_list *w)
{
    for (size_t k = 0; k < w->n; k++) {
        char *end;
        size_t n = strlen (w->word[k]);
        strtod (w->word[k], &end);
        if (!*end && n + 9 < PG_LIST_TEXT) snprintf (w->word[k] + n, PG_LIST_TEXT - n, " spacing");
    }
}

/* Adds "key=value" to a case; nothing if there is no value. */
static void put (pg_bench_case *c, const char *key, const char *value)
{
    if (value) snprintf (c->set[c->nset++], sizeof *c->set, "%s=%s", key, value);
}

/* Returns the horizon for a basis that differs from that of the scene: 2 spacings for the linear one, 2.5 for
 * the quadratic one. NULL if the user gave a horizon, or the scene has one for this basis. */
static const char *horizon_for (const pg_bench_base *b, const pg_bench_request *q, const char *basis)
{
    for (size_t k = 0; k < q->nset; k++) if (strncmp (q->set[k], "method.horizon=", 15) == 0) return NULL;
    int quadratic = strcmp (basis, "quadratic") == 0;
    if (b->has_horizon && quadratic == b->quadratic) return NULL;
    return quadratic ? "2.5 spacing" : "2 spacing";
}

/* 1: the force has shape functions, so that approximation, integration and basis can be chosen. */
static int has_shape_functions (const char *force)
{
    const pg_force_type *type = pg_force_find (force);
    return !type || type->method.shape_functions;
}

/* One combination of words; NULL: as in the scene. */
typedef struct { const char *force, *approximation, *integration, *basis, *cells, *perturb, *horizon; } mix;

/* Appends a word to a name, with a blank before it unless the name is empty; "" and NULL append nothing. */
static void append (char *name, size_t size, const char *word)
{
    size_t n = strlen (name);
    if (word && *word && n < size) snprintf (name + n, size - n, "%s%s", n ? " " : "", word);
}

/* Names the method, such as "rkpm gauss quadratic perturbed 0.2", to distinguish the curves of a picture. The
 * force is named if there are several, or if it has no shape functions. */
static void name_method (pg_bench_case *c, const pg_bench_request *q, const pg_bench_base *b, const mix *m)
{
    int perturbed = m->perturb && strcmp (m->perturb, "0") != 0;
    if (q->force.n > 1 || !m->basis) append (c->method, sizeof c->method, m->force);
    append (c->method, sizeof c->method, m->approximation);
    append (c->method, sizeof c->method, m->integration);
    append (c->method, sizeof c->method, m->basis);
    append (c->method, sizeof c->method, m->horizon);
    append (c->method, sizeof c->method, perturbed ? "perturbed" : "");
    append (c->method, sizeof c->method, perturbed ? m->perturb : "");
    append (c->method, sizeof c->method, m->cells);
    append (c->method, sizeof c->method, b->mesh ? "mesh" : "");
}

/* Fills in a case, except its size: names, and the overrides that turn the scene into this combination. */
static void fill_case (pg_bench_case *c, const pg_bench_request *q, const pg_bench_base *b, const mix *m)
{
    const pg_bench_body *body = pg_bench_body_find (b->name);
    pg_trial_read (&c->best, "");
    snprintf (c->name, sizeof c->name, "%s", b->name);
    snprintf (c->group, sizeof c->group, "%s", body ? body->group : b->name);
    snprintf (c->perturb, sizeof c->perturb, "%s", m->perturb ? m->perturb : "");
    snprintf (c->cells, sizeof c->cells, "%s", m->cells ? m->cells : "");
    name_method (c, q, b, m);
    put (c, "method.force", m->force), put (c, "method.approximation", m->approximation);
    put (c, "method.integration", m->integration), put (c, "method.basis", m->basis);
    put (c, "cells", m->cells), put (c, "perturb.amount", m->perturb);
    put (c, "method.horizon", m->horizon || !m->basis ? m->horizon : horizon_for (b, q, m->basis));
}

/* Number of sizes of a curve: those asked for; else 3, for twice, once and half the scene's spacing; 1 if the
 * scene has none. */
static size_t count_sizes (const pg_bench_request *q, const pg_bench_base *b, int meshed)
{
    if (meshed) return q->mesh.n;
    if (b->mesh) return 1;
    if (q->spacing.n) return q->spacing.n;
    return b->spacing > 0 ? 3 : 1;
}

/* Adds the sizes of one combination as a curve: those named, else twice, once and half the
 * spacing of the scene; for scenes on meshes the sizes of the meshes. */
static pg_status add_curve (pg_bench_cases *out, const pg_bench_request *q, size_t s, const pg_bench_base *b,
                            const mix *m)
{
    pg_status status = PG_OK;
    static const double factor[3] = { 2, 1, 0.5 };
    const pg_bench_body *body = pg_bench_body_find (b->name);
    int meshed = b->mesh && body && body->own && !pg_bench_mesh_missing (q->scene[s], b->name);
    size_t sizes = count_sizes (q, b, meshed);
    for (size_t k = 0; k < sizes; k++) {
        PG_GROW (out->at, out->cap, out->n + 1);
        pg_bench_case *c = &out->at[out->n++];
        memset (c, 0, sizeof *c);
        c->scene = s, c->curve = out->ncurve;
        fill_case (c, q, b, m);
        if (meshed) {
            snprintf (c->element, sizeof c->element, "%s", body->dim == 3 ? "C3D8I" : "CPS8");
            c->size = strtol (q->mesh.word[k], NULL, 10);
        }
        if (b->mesh) continue;
        char number[32];
        snprintf (number, sizeof number, "%.15g", b->spacing * factor[k < 3 ? k : 2]);
        if (q->spacing.n) put (c, "spacing", q->spacing.word[k]);
        else if (b->spacing > 0) put (c, "spacing", number);
    }
    out->ncurve++;
done:
    return status;
}

/* The word of a list in combination k; lists count like the digits of a number, `of` being the
 * weight of this one. */
static const char *word_of (const pg_word_list *w, size_t k, size_t of)
{
    return w->n ? w->word[k / of % w->n] : NULL;
}

/* 1 if the runs of CalculiX on the meshes of this scene are in the list already: scenes of one body may
 * share them. */
static int has_fem (const pg_bench_cases *cases, const char *name)
{
    const pg_bench_body *body = pg_bench_body_find (name);
    for (size_t i = 0; body && i < cases->n; i++) {
        const pg_bench_body *of = cases->at[i].fem ? pg_bench_body_find (cases->at[i].name) : NULL;
        if (of && strcmp (of->mesh, body->mesh) == 0) return 1;
    }
    return 0;
}

/* Fills lists that were not given with the whole catalogue. */
static void fill_lists (pg_bench_request *q)
{
    fill (&q->force, (*pg_force_methods ())->name);
    fill (&q->approximation, pg_approx_names ());
    fill (&q->integration, pg_integration_names ());
    fill (&q->basis, "linear|quadratic");
    if (!q->mesh.n) q->mesh = q->size;
    else if (!q->size.n) q->size = q->mesh;
    if (!q->mesh.n) fill (&q->mesh, "8|16|32");
    count_spacings (&q->horizon);
}

/* Adds every combination of the lists for one scene, as digits of a number with the last list running
 * fastest. A force without shape functions comes once, not for every approximation, integration and basis. */
static pg_status add_combinations (pg_bench_cases *out, const pg_bench_request *q, size_t s,
                                   const pg_bench_base *b)
{
    pg_status status = PG_OK;
    enum { FORCE, APPROXIMATION, INTEGRATION, BASIS, CELLS, PERTURB, HORIZON, LISTS };
    const pg_word_list *list[LISTS] = { &q->force, &q->approximation, &q->integration, &q->basis,
                                        &q->cells, &q->perturb,       &q->horizon };
    size_t of[LISTS], all = 1;
    for (int k = LISTS - 1; k >= 0; k--) of[k] = all, all *= list[k]->n ? list[k]->n : 1;
    for (size_t k = 0; k < all; k++) {
        const char *word[LISTS];
        for (int l = 0; l < LISTS; l++) word[l] = word_of (list[l], k, of[l]);
        mix m = { word[FORCE], word[APPROXIMATION], word[INTEGRATION], word[BASIS],
                  word[CELLS], word[PERTURB],       word[HORIZON] };
        if (!has_shape_functions (m.force)) {
            size_t first = 1;
            for (int l = APPROXIMATION; l <= BASIS; l++) first &= k / of[l] % list[l]->n == 0;
            if (!first) continue;
            m.approximation = m.integration = m.basis = NULL;
        }
        PG_TRY (add_curve (out, q, s, b, &m));
    }
done:
    return status;
}

/* Makes the cases scene by scene: the product of all lists, then CalculiX if that is asked for. A force
 * without shape functions gets one combination of approximation, integration and basis, as it uses none of
 * them. */
pg_status pg_bench_cases_make (pg_bench_cases *out, const pg_bench_request *asked)
{
    pg_status status = PG_OK;
    pg_bench_request *q = NULL;
    pg_bench_base b;
    PG_ALLOC (q, 1);
    *q = *asked;
    fill_lists (q);
    for (size_t s = 0; s < q->nscene; s++) {
        PG_TRY (pg_bench_look (&b, q->scene[s], q->nset, q->set));
        PG_TRY (add_combinations (out, q, s, &b));
        if (q->fem && !has_fem (out, b.name)) PG_TRY (pg_bench_fem_add (out, q, s, b.name));
    }
done:
    pg_free (q);
    return status;
}
