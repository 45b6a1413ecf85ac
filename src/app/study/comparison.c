/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal compare: opens the result, finds out what kind of reference it is compared with
 * (that of its scene, another result folder, a table, a finite element result), opens that as
 * a sampler, and measures the difference. The kind follows from the name and the content: a
 * folder with scene.yaml and result.e is a result, .csv and .txt are tables, anything else is
 * tried as a mesh file. */
#include "perigal/study.h"
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>

/* 1 if the folder has an entry of that name. */
static int exists (const char *folder, const char *name)
{
    char path[4096];
    struct stat s;
    snprintf (path, sizeof path, "%.3000s/%s", folder, name);
    return stat (path, &s) == 0;
}

/* 1 if the text ends with `tail`, in capitals or not. */
static int ends (const char *text, const char *tail)
{
    size_t n = strlen (text), m = strlen (tail);
    return n > m && strcasecmp (text + n - m, tail) == 0;
}

/* 1 if the folder has the fields of a run: result.e, or parts of it by ranks, which are joined when they are
 * read. */
static int has_fields (const char *folder)
{
    int found = exists (folder, "result.e");
    DIR *list = found ? NULL : opendir (folder);
    for (struct dirent *entry; list && !found && (entry = readdir (list));)
        found = strncmp (entry->d_name, "result.e.", 9) == 0;
    if (list) closedir (list);
    return found;
}

/* 1 for a result folder, or for its result.e with scene.yaml beside it; folder (4096 bytes) gets the path of
 * the folder. */
static int is_result (const char *reference, char *folder)
{
    const char *slash = strrchr (reference, '/');
    snprintf (folder, 4096, "%.3000s", reference);
    if (exists (reference, "scene.yaml") && has_fields (reference)) return 1;
    snprintf (folder, 4096, "%.*s", slash ? (int) (slash - reference) : 1, slash ? reference : ".");
    return strcmp (slash ? slash + 1 : reference, "result.e") == 0 && exists (folder, "scene.yaml");
}

/* Compares with another result. Norms are taken over the cells of the result with the smaller spacing, where
 * differences of the other cannot hide between its points. PG_E_USAGE: the bodies do not overlap. */
static pg_status against_result (pg_comparison *c, const pg_comparison_request *q, const char *folder)
{
    pg_status status = PG_OK;
    pg_sampler plain = { 0 };
    PG_TRY (pg_stored_open (&c->other, folder, q->other_step, q->threads));
    const pg_stored *a = c->own, *b = c->other;
    if (a->problem->dim != b->problem->dim)
        PG_FAIL (PG_E_USAGE, "%s is of a %dD body, %s of a %dD one", q->folder, a->problem->dim, folder,
                 b->problem->dim);
    snprintf (c->note, sizeof c->note, "the reference, step %d, %s", b->step, b->how);
    plain = c->other->sampler;
    memset (&c->other->sampler, 0, sizeof plain);
    PG_TRY (pg_sampler_moved (&c->reference, &plain, q->shift, q->scale));
    const pg_stored *finer = b->problem->cloud.h < a->problem->cloud.h ? b : a;
    PG_TRY (pg_errors_against (&c->errors, finer->problem, pg_norm_order (finer->scene, finer->problem), NULL,
                               &a->sampler, &c->reference));
    if (!c->errors.norms.places)
        PG_FAIL (PG_E_USAGE,
                 "%s and %s have no place in common: the bodies lie apart (--shift moves the reference)",
                 q->folder, folder);
done:
    pg_sampler_clear (&plain);
    return status;
}

/* Compares a result with a table: unit and scale belong to its columns, the shift moves its positions.
 * PG_E_USAGE if none of them lies in the body: a wrong unit is the usual reason. */
static pg_status against_table (pg_comparison *c, const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    static const double origin[3] = { 0 };
    size_t known = 0;
    PG_TRY (pg_line_read (&c->line, q->reference, c->own->problem->dim, q->unit, q->scale, origin));
    for (size_t i = 0; i < c->line.n * (size_t) c->line.dim; i++)
        c->line.x[i] += q->shift[i % (size_t) c->line.dim];
    PG_ALLOC (c->errors.line, c->line.ncolumn);
    PG_TRY (pg_line_measure (c->errors.line, &c->line, &c->own->sampler));
    c->errors.nline = c->line.ncolumn;
    for (size_t k = 0; k < c->line.ncolumn; k++) known += c->errors.line[k].rows;
    if (!known)
        PG_FAIL (PG_E_USAGE, "%s: none of its %zu places lies in the body of %s (--unit, --shift)",
                 q->reference, c->line.n, q->folder);
done:
    return status;
}

/* Compares with the reference of the scene, at the time of the step; PG_E_USAGE if the scene has none. */
static pg_status against_scene (pg_comparison *c, const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    PG_TRY (pg_reference_read (&c->scene, c->own->scene, c->own->problem));
    if (!c->scene)
        PG_FAIL (PG_E_USAGE, "the scene of %s has no reference: name one, perigal compare %s REFERENCE",
                 q->folder, q->folder);
    PG_TRY (pg_errors_measure (&c->errors, c->scene, c->own->problem, &c->own->sampler, c->own->t));
    PG_TRY (pg_reference_sampler (&c->reference, c->scene, c->own->t));
done:
    return status;
}

/* Compares with a finite element result, over the cells of our own result. The view c->fem stays valid as
 * long as c->reference, which owns the mesh. Points outside the elements are counted and reported. */
static pg_status against_mesh (pg_comparison *c, const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    size_t outside = 0;
    double away = 0;
    const pg_stored *a = c->own;
    pg_sampler plain = { 0 };
    PG_TRY (pg_sampler_mesh (&plain, q->reference, q->other_step, q->unit, a->problem));
    c->fem = plain;
    /* c->reference owns it; this view only gives the mesh */
    c->fem.free = NULL;
    const pg_mesh *mesh = pg_sampler_mesh_of (&plain, NULL, NULL);
    size_t elements = mesh->n, nodes = mesh->nnode;
    PG_TRY (pg_sampler_moved (&c->reference, &plain, q->shift, q->scale));
    PG_TRY (pg_errors_against (&c->errors, a->problem, pg_norm_order (a->scene, a->problem), NULL,
                               &a->sampler, &c->reference));
    if (!c->errors.norms.places)
        PG_FAIL (
            PG_E_USAGE,
            "%s and %s have no place in common: the bodies lie apart (--unit, --shift move the reference)",
            q->folder, q->reference);
    pg_sampler_mesh_of (&c->fem, &outside, &away);
    int n = snprintf (c->note, sizeof c->note, "the reference: %zu elements, %zu nodes", elements, nodes);
    if (outside)
        snprintf (c->note + n, sizeof c->note - (size_t) n,
                  "; %zu places outside its elements, up to %.2g element sizes, took the nearest one",
                  outside, away);
done:
    pg_sampler_clear (&plain);
    return status;
}

/* Opens result and reference, and measures. The result comes first, because the dimension of its body decides
 * how the reference is read. */
pg_status pg_comparison_open (pg_comparison *c, const pg_comparison_request *q)
{
    pg_status status = PG_OK;
    char folder[4096];
    PG_TRY (pg_writer_readable (q->folder));
    if (q->reference) PG_TRY (pg_writer_readable (q->reference));
    if (!has_fields (q->folder) || !exists (q->folder, "scene.yaml"))
        PG_FAIL (PG_E_USAGE, "%s is no result folder: it needs scene.yaml and result.e of a run", q->folder);
    PG_TRY (pg_stored_open (&c->own, q->folder, q->step, q->threads));
    if (!q->reference) PG_TRY (against_scene (c, q));
    else if (is_result (q->reference, folder)) PG_TRY (against_result (c, q, folder));
    else if (ends (q->reference, ".csv") || ends (q->reference, ".txt")) PG_TRY (against_table (c, q));
    else PG_TRY (against_mesh (c, q));
done:
    return status;
}

/* Frees a comparison; samplers before the problems that they borrow. */
void pg_comparison_clear (pg_comparison *c)
{
    pg_errors_clear (&c->errors);
    pg_sampler_clear (&c->reference);
    pg_line_clear (&c->line);
    pg_reference_free (&c->scene);
    pg_stored_free (&c->other);
    pg_stored_free (&c->own);
}
