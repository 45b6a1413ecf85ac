/* SPDX-License-Identifier: GPL-3.0-or-later
 * Writes what a key means, from the tables: for one key on the terminal; for all keys see manual.c. A key may
 * be given by its full path, without the names that the user chooses (materials.{}.density or
 * materials.density), by its last word, or by the path of a map, for which the keys below are listed. */
#include "keys.h"
#include <string.h>

/* The names are in the order of pg_kind. */
const char *pg_key_kind (const pg_key *key)
{
    static const char *const kind[] = {
        "map",  "list",   "number",  "whole number", "on or off", "name",
        "text", "vector", "numbers", "names",        "file",      "expression",
    };
    return (unsigned) key->kind < sizeof kind / sizeof *kind ? kind[key->kind] : "?";
}

/* Removes {} and [] from a path: "materials.{}.youngs_modulus" and "materials.youngs_modulus" both become
 * "materials.youngs_modulus", as a user would type it. */
static void plain_path (char out[PG_PATTERN], const char *path)
{
    size_t n = 0;
    for (; *path && n + 1 < PG_PATTERN; path++) {
        if (*path == '{' || *path == '[') {
            path += strcspn (path, "}]");
            if (!*path) break;
        } else if (*path != '.' || (n > 0 && out[n - 1] != '.')) out[n++] = *path;
    }
    while (n > 0 && out[n - 1] == '.') n--;
    out[n] = '\0';
}

/* The separators | of the names become commas. */
void pg_help_meaning (FILE *to, const pg_schema *s, const pg_key *key)
{
    const char *entries = pg_schema_entries (s, key, NULL);
    if (entries) fputc ('(', to);
    for (const char *c = entries; c && *c; c++) {
        if (*c == '|') fprintf (to, ", ");
        else fputc (*c, to);
    }
    fprintf (to, "%s%s", entries ? ") " : "", key->doc ? key->doc : "");
}

/* 3: the path of the row is the key; 2: it ends with the key; 1: it lies below the key; 0: neither. */
static int match (const pg_key *row, const char *key)
{
    char path[PG_PATTERN];
    plain_path (path, row->path);
    size_t n = strlen (path), m = strlen (key);
    if (strcmp (path, key) == 0) return 3;
    if (n > m && path[n - m - 1] == '.' && strcmp (path + n - m, key) == 0) return 2;
    return n > m && path[m] == '.' && strncmp (path, key, m) == 0;
}

/* Prints names "a|b" separated by commas. */
static void print_names (FILE *to, const char *before, const char *names)
{
    fprintf (to, "%s", before);
    for (; *names; names++) {
        if (*names == '|') fprintf (to, ", ");
        else fputc (*names, to);
    }
    fprintf (to, "\n");
}

/* Prints the keys of the same group and map as `key`, of which one may or must be given. */
static void print_partners (FILE *to, const pg_schema *s, const pg_key *key)
{
    const char *last = strrchr (key->path, '.'), *rule = strrchr (key->group, ':'), *joint = "";
    size_t n = last ? (size_t) (last - key->path) : 0;
    fprintf (to, "  group    give %s of ",
             rule && strcmp (rule, ":one") == 0 ? "exactly one" : "at most one");
    for (size_t k = 0; k < s->n; k++) {
        const pg_key *row = s->row[k];
        const char *other = strrchr (row->path, '.');
        size_t m = other ? (size_t) (other - row->path) : 0;
        if (!row->group || strcmp (row->group, key->group) != 0 || n != m
            || strncmp (row->path, key->path, n) != 0)
            continue;
        fprintf (to, "%s%s", joint, other ? other + 1 : row->path);
        joint = ", ";
    }
    fprintf (to, "\n");
}

/* Prints all properties of one key. */
static void print_key (FILE *to, const pg_schema *s, const pg_key *key)
{
    const char *choices = pg_key_choices (key);
    char example[PG_LEVEL_NAMES], first[PG_LEVEL_NAMES];
    fprintf (to, "%s\n  ", key->path);
    pg_help_meaning (to, s, key);
    fprintf (to, "\n  kind     %s\n", pg_key_kind (key));
    if (key->kind == PG_NUMBER) {
        pg_schema_wanted (s, key->path, example, sizeof example);
        fprintf (to, "  value    %s\n", example);
    }
    if (key->unit) print_names (to, "  unit     ", key->unit);
    if (key->range) fprintf (to, "  range    %s\n", key->range);
    if (choices) print_names (to, "  choices  ", choices);
    const char *fallback = pg_key_default (key, first);
    if (fallback && *fallback) fprintf (to, "  default  %s\n", fallback);
    else fprintf (to, "  default  none%s\n", key->fallback || key->group ? "" : ", required");
    if (key->group) print_partners (to, s, key);
}

/* Prints the keys below a map, one per line. */
static void print_below (FILE *to, const pg_schema *s, const char *key)
{
    const char *title = "  below it:\n";
    for (size_t k = 0; k < s->n; k++) {
        if (match (s->row[k], key) != 1) continue;
        fprintf (to, "%s    %-44s ", title, s->row[k]->path);
        pg_help_meaning (to, s, s->row[k]);
        fprintf (to, "\n");
        title = "";
    }
}

/* Counts the rows that match the key in this way (see match). */
static size_t count (const pg_schema *s, const char *key, int how)
{
    size_t n = 0;
    for (size_t k = 0; k < s->n; k++) n += match (s->row[k], key) == how;
    return n;
}

/* Returns the key most similar to an unknown one: by its full path, else by its last word. */
static const char *nearest_key (const pg_schema *s, const char *key)
{
    char path[PG_PATTERN];
    const char *near = NULL;
    /* Full paths first, then last words. */
    for (int whole = 1; whole >= 0 && !near; whole--) {
        size_t used = 0;
        size_t size = s->n * PG_PATTERN + 1;
        char *all = pg_calloc (size, 1);
        if (!all) return NULL;
        for (size_t k = 0; k < s->n; k++) {
            plain_path (path, s->row[k]->path);
            const char *last = strrchr (path, '.');
            used += (size_t) snprintf (all + used, size - used, "%s%s", used ? "|" : "",
                                       whole || !last ? path : last + 1);
        }
        near = pg_nearest_name (key, all);
        pg_free (all);
    }
    return near;
}

/* Prints all rows that match the key in this way (see match), each after the text `before`. */
static void print_matches (FILE *to, const pg_schema *s, const char *key, int how, const char *before)
{
    for (size_t k = 0; k < s->n; k++) {
        if (match (s->row[k], key) != how) continue;
        fprintf (to, "%s", before);
        print_key (to, s, s->row[k]);
    }
}

/* Writes the help for the key with this full path, else for all keys that end with the word; an unknown one
 * is an error with a suggestion. */
pg_status pg_help_write (FILE *to, const char *key, const pg_schema *s)
{
    char plain[PG_PATTERN];
    plain_path (plain, key);
    size_t same = count (s, plain, 3), ends = count (s, plain, 2), below = count (s, plain, 1);
    if (*plain && (same || below)) {
        print_matches (to, s, plain, 3, "");
        if (!same) fprintf (to, "%s\n", plain);
        print_below (to, s, plain);
    } else if (*plain && ends) {
        if (ends > 1) fprintf (to, "%s occurs in %zu places:\n", plain, ends);
        print_matches (to, s, plain, 2, ends > 1 ? "\n" : "");
    } else {
        const char *near = nearest_key (s, plain);
        if (near) return pg_error (PG_E_USAGE, PG_HERE, "unknown key '%.100s'; did you mean %s?", key, near);
        return pg_error (PG_E_USAGE, PG_HERE, "unknown key '%.100s'", key);
    }
    return ferror (to) ? pg_error (PG_E_FILE, PG_HERE, "the help could not be written") : PG_OK;
}

/* ---- help for the keys of all folders ------------------------------------------------------------------ */
/* Writes help, manual or JSON schema; key: for help alone. */
static pg_status write_all (FILE *to, const char *key, pg_status (*write) (FILE *, const pg_schema *))
{
    pg_status status = PG_OK;
    const pg_vocabulary *words;
    pg_schema s = { 0 };
    PG_TRY (pg_keys_of_all (&words));
    PG_TRY (pg_schema_create (&s, words));
    PG_TRY (write ? write (to, &s) : pg_help_write (to, key, &s));
done:
    pg_schema_clear (&s);
    return status;
}

pg_status pg_scene_help (FILE *to, const char *key) { return write_all (to, key, NULL); }
pg_status pg_scene_manual (FILE *to) { return write_all (to, NULL, pg_manual_write); }
pg_status pg_scene_json_schema (FILE *to) { return write_all (to, NULL, pg_json_schema_write); }
