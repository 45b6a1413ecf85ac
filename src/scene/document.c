/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene from a text: read, apply overrides, check, report all faults.
 *
 * The order matters: without a tree nothing else can be checked; overrides come before the checks, so that
 * a value from the command line is checked like one from the file; all other faults are collected and
 * reported together. */
#include "document.h"
#include "sha256.h"
#include <string.h>

/* SHA-256 of the text and of the overrides, each separated by a zero byte. */
static void hash (pg_scene *s, size_t length, size_t nset, const char *const *set)
{
    pg_sha256 sum;
    pg_sha256_start (&sum);
    pg_sha256_add (&sum, s->source, length);
    for (size_t k = 0; k < nset; k++) {
        pg_sha256_add (&sum, "", 1);
        pg_sha256_add (&sum, set[k], strlen (set[k]));
    }
    pg_sha256_end (&sum, s->hash);
}

/* Copies text, name and overrides, and allocates the list of faults. */
static pg_status keep_texts (pg_scene *s, const char *text, size_t length, const char *name, size_t nset,
                             const char *const *set)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->source, length + 1);
    if (length) memcpy (s->source, text, length);
    s->file = pg_strdup (name);
    if (!s->file) PG_FAIL (PG_E_MEMORY, "no memory for the name of the scene");
    PG_ALLOC (s->faults, 1);
    PG_ALLOC (s->set, nset);
    /* Counted one by one, so that a failure releases those that exist. */
    for (s->nset = 0; s->nset < nset; s->nset++) {
        size_t n = strlen (set[s->nset]) + sizeof "--set ";
        PG_ALLOC (s->set[s->nset], n);
        snprintf (s->set[s->nset], n, "--set %s", set[s->nset]);
    }
    hash (s, length, nset, set);
done:
    return status;
}

/* Reads the YAML text; a scene must be a map. */
static pg_status read_tree (pg_scene *s, const char *text, size_t length)
{
    int good;
    pg_status status = pg_node_read (&s->root, text, length, NULL, s->file, s->faults, &good);
    if (status != PG_OK || !good) return status;
    s->root.line = s->root.column = 1;
    if ((s->root.shape == PG_SCALAR && !s->root.text) || pg_node_null (&s->root))
        pg_faults_add (s->faults, s->file, NULL, NULL, 0, "the scene is empty");
    else if (s->root.shape != PG_MAPPING)
        pg_faults_add (s->faults, s->file, NULL, NULL, 0, "a scene is a map (key: value)");
    return PG_OK;
}

/* Do all faults concern keys that body, points, cracks and sets do not read? */
static int geometry_is_sound (const pg_scene *s)
{
    static const char *const elsewhere[] = { "title",   "materials", "failure", "blocks",   "boundary",
                                             "stages",  "initial",   "solver",  "output",
                                             "reference" };
    for (size_t i = 0; i < s->faults->n; i++) {
        size_t k = 0, n = sizeof elsewhere / sizeof *elsewhere;
        while (k < n && strcmp (s->faults->fault[i].top, elsewhere[k]) != 0) k++;
        if (k == n) return 0;
    }
    return s->dimension > 0 && !s->faults->more;
}

/* Reads the text, applies overrides, checks; then reports all faults. */
pg_status pg_scene_read (pg_scene **out, const char *text, size_t length, const char *name, size_t nset,
                         const char *const *set, const pg_vocabulary *words, int some)
{
    pg_status status = PG_OK;
    pg_scene *s;
    *out = NULL;
    PG_ALLOC (s, 1);
    PG_TRY (keep_texts (s, text, length, name, nset, set));
    PG_TRY (pg_schema_create (&s->schema, words));
    PG_TRY (read_tree (s, text, length));
    /* Without a tree there is nothing more to check. */
    PG_TRY (pg_faults_verdict (s->faults));
    for (size_t k = 0; k < nset; k++) PG_TRY (pg_scene_override (s, set[k], s->set[k]));
    PG_TRY (pg_scene_check (s));
    if (some && s->faults->n && geometry_is_sound (s)) s->partial = 1, pg_scene_pass (s);
    PG_TRY (pg_scene_verdict (s));
    *out = s;
    s = NULL;
done:
    pg_scene_free (&s);
    return status;
}

pg_status pg_scene_parse_like (pg_scene **out, const pg_scene *like, const char *text, const char *name)
{
    return pg_scene_read (out, text, strlen (text), name, 0, NULL, like->schema.from, 0);
}

/* NULL, or a pointer to NULL, is allowed. */
void pg_scene_free (pg_scene **scene)
{
    if (!scene || !*scene) return;
    pg_scene *s = *scene;
    for (size_t k = 0; s->fallback && k < s->schema.n; k++) pg_node_clear (&s->fallback[k]);
    pg_free (s->fallback);
    pg_node_clear (&s->root);
    pg_schema_clear (&s->schema);
    for (size_t k = 0; k < s->nset; k++) pg_free (s->set[k]);
    pg_free (s->set);
    if (s->faults) pg_faults_clear (s->faults);
    pg_free (s->faults);
    pg_free (s->source);
    pg_free (s->file);
    pg_free (s);
    *scene = NULL;
}

const char *pg_scene_file   (const pg_scene *s) { return s->file; }
const char *pg_scene_source (const pg_scene *s) { return s->source; }
const char *pg_scene_setting (const pg_scene *s, size_t k)
{
    return k < s->nset ? s->set[k] + sizeof "--set" : NULL;
}

const pg_key *pg_scene_known_key (const pg_scene *s, size_t k)
{
    return k < s->schema.n ? s->schema.row[k] : NULL;
}

const char *pg_scene_hash   (const pg_scene *s) { return s->hash; }

/* Faults before pg_scene_pass do not count, unless memory was short for one. */
pg_status pg_scene_verdict (const pg_scene *s)
{
    return s->faults->n > s->faults->passed || s->faults->lost ? pg_faults_verdict (s->faults) : PG_OK;
}

pg_status pg_scene_blame (const pg_scene *s, const char *key, pg_status status)
{
    char text[1024];
    if (status != PG_E_USAGE) return status;
    snprintf (text, sizeof text, "%s", pg_last_error ());
    pg_scene_fault (s, key, "%s", text);
    return pg_scene_verdict (s);
}

pg_status pg_scene_conclude (const pg_scene *s) { return pg_faults_verdict (s->faults); }
void pg_scene_pass (const pg_scene *s) { s->faults->passed = s->faults->n; }
int pg_scene_partial (const pg_scene *s) { return s->partial; }
