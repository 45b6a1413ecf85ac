/* SPDX-License-Identifier: GPL-3.0-or-later
 * Override "random_field.seed=N": replaces the seeds of all random fields in the expressions of a scene by
 * one value of the command line. Fields with equal seeds keep equal seeds: the first different seed of the
 * scene, in the order of the file, becomes N, the next one N + 1000000, and so on. */
#include "document.h"
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SEEDS = 64, APART = 1000000, WORD = 64 };
static const char function[] = "random_field";

/* The different seeds found so far, as texts; first: the new value of the first seed; found: 1: there is a
 * random field. */
typedef struct { size_t n; char text[SEEDS][WORD]; long first; int found; } seeds;

/* Returns the end of an argument, the comma or bracket that closes it; NULL: it has none. */
static const char *end_of (const char *s)
{
    int depth = 0;
    for (; *s; s++) {
        if (depth == 0 && (*s == ',' || *s == ')')) return s;
        depth += (*s == '(') - (*s == ')');
    }
    return NULL;
}

/* Returns the new seed for the one that is written from `from` to before `to`. */
static long seed_for (seeds *all, const char *from, const char *to)
{
    char word[WORD] = "";
    size_t length = 0, k = 0;
    for (; from < to && length + 1 < WORD; from++)
        if (!isspace ((unsigned char) *from)) word[length++] = *from;
    word[length] = '\0';
    while (k < all->n && strcmp (all->text[k], word) != 0) k++;
    if (k == all->n && all->n < SEEDS) memcpy (all->text[all->n++], word, sizeof word);
    all->found = 1;
    return all->first + APART * (long) k;
}

/* Finds the text *from .. *to of the seed of the next random field in a text; 0: there is none. */
static int next_seed (const char *text, const char **from, const char **to)
{
    for (const char *s = text; (s = strstr (s, function)); s += strlen (function)) {
        const char *open = s + strlen (function), *comma;
        int part = s > text && (isalnum ((unsigned char) s[-1]) || s[-1] == '_');
        while (isspace ((unsigned char) *open)) open++;
        if (part || *open != '(' || !(comma = end_of (open + 1)) || *comma != ',') continue;
        *from = comma + 1, *to = end_of (comma + 1);
        if (*to && **to == ')') return 1;
    }
    return 0;
}

/* Replaces the seeds of all random fields in one text. */
static pg_status rewrite (pg_node *node, seeds *all)
{
    pg_status status = PG_OK;
    char *text = NULL;
    const char *rest = node->text, *from, *to;
    size_t n = 0, capacity = 0;
    while (next_seed (rest, &from, &to)) {
        char number[32];
        size_t before = (size_t) (from - rest);
        int digits = snprintf (number, sizeof number, " %ld", seed_for (all, from, to));
        PG_GROW (text, capacity, n + before + (size_t) digits + 1);
        memcpy (text + n, rest, before), n += before;
        memcpy (text + n, number, (size_t) digits + 1), n += (size_t) digits;
        rest = to;
    }
    if (!n) goto done;
    PG_GROW (text, capacity, n + strlen (rest) + 1);
    memcpy (text + n, rest, strlen (rest) + 1);
    pg_free (node->text);
    node->text = text, text = NULL;
done:
    pg_free (text);
    return status;
}

static pg_status walk (pg_node *node, seeds *all)
{
    pg_status status = PG_OK;
    if (node->shape == PG_SCALAR && node->text) PG_TRY (rewrite (node, all));
    for (size_t k = 0; k < node->n; k++) PG_TRY (walk (&node->child[k], all));
done:
    return status;
}

int pg_scene_is_reseed (const char *set)
{
    size_t n = strlen (function);
    return strncmp (set, function, n) == 0 && strncmp (set + n, ".seed=", 6) == 0;
}

pg_status pg_scene_reseed (pg_scene *s, const char *set, const char *origin)
{
    pg_status status = PG_OK;
    pg_node here = { .origin = origin };
    const char *value = strchr (set, '=') + 1;
    char *end;
    seeds all = { .first = strtol (value, &end, 10) };
    if (end == value || *end)
        pg_faults_add (s->faults, s->file, &here, NULL, 0, "must be a whole number");
    else {
        PG_TRY (walk (&s->root, &all));
        if (!all.found)
            pg_faults_add (s->faults, s->file, &here, NULL, 0,
                           "there is no random_field in the expressions of this scene");
    }
done:
    return status;
}
