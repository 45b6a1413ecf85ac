/* SPDX-License-Identifier: GPL-3.0-or-later
 * A scene as JSON, for programs that read, change and write scenes: what the user wrote, with the
 * overrides, and without defaults. YAML reads JSON, so that the text is a scene again. */
#include "document.h"
#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The JSON text under construction. */
typedef struct { char *text; size_t n, cap; } json_text;

static pg_status put (json_text *t, const char *word, size_t length)
{
    pg_status status = PG_OK;
    if (t->n + length + 1 > t->cap) PG_GROW (t->text, t->cap, t->n + length + 1);
    memcpy (t->text + t->n, word, length);
    t->n += length;
    t->text[t->n] = '\0';
done:
    return status;
}

/* Appends a word in quotes; control characters by their code, as JSON demands. */
static pg_status put_quoted (json_text *t, const char *word)
{
    pg_status status = PG_OK;
    char code[8];
    PG_TRY (put (t, "\"", 1));
    for (; *word; word++) {
        unsigned char c = (unsigned char) *word;
        if (c == '"' || c == '\\') PG_TRY (put (t, "\\", 1));
        if (c >= 0x20) PG_TRY (put (t, word, 1));
        else {
            snprintf (code, sizeof code, "\\u%04x", c);
            PG_TRY (put (t, code, 6));
        }
    }
    PG_TRY (put (t, "\"", 1));
done:
    return status;
}

/* Is the text true or false, which JSON writes without quotes? */
static int is_truth (const char *s) { return strcmp (s, "true") == 0 || strcmp (s, "false") == 0; }

/* Is the text a number as JSON writes them? -1.5e-3 is; 1., .5, +1, 0x10, 1e400, inf and 2 mm are not. */
static int is_number (const char *s)
{
    const char *from = s;
    s += *s == '-';
    if (!isdigit ((unsigned char) *s) || (*s == '0' && isdigit ((unsigned char) s[1]))) return 0;
    while (isdigit ((unsigned char) *s)) s++;
    if (*s == '.') {
        if (!isdigit ((unsigned char) *++s)) return 0;
        while (isdigit ((unsigned char) *s)) s++;
    }
    if (*s == 'e' || *s == 'E') {
        s++;
        s += *s == '+' || *s == '-';
        if (!isdigit ((unsigned char) *s)) return 0;
        while (isdigit ((unsigned char) *s)) s++;
    }
    return *s == '\0' && isfinite (strtod (from, NULL));
}

static pg_status put_node (json_text *t, const pg_node *node)
{
    pg_status status = PG_OK;
    if (node->shape == PG_SCALAR) {
        const char *text = node->text ? node->text : "";
        if (pg_node_null (node)) PG_TRY (put (t, "null", 4));
        else if (node->plain && (is_number (text) || is_truth (text))) PG_TRY (put (t, text, strlen (text)));
        else PG_TRY (put_quoted (t, text));
        goto done;
    }
    PG_TRY (put (t, node->shape == PG_MAPPING ? "{" : "[", 1));
    for (size_t k = 0; k < node->n; k++) {
        if (k) PG_TRY (put (t, ", ", 2));
        if (node->shape == PG_MAPPING) {
            PG_TRY (put_quoted (t, node->child[k].name));
            PG_TRY (put (t, ": ", 2));
        }
        PG_TRY (put_node (t, &node->child[k]));
    }
    PG_TRY (put (t, node->shape == PG_MAPPING ? "}" : "]", 1));
done:
    return status;
}

pg_status pg_scene_echo (char **json, const pg_scene *s)
{
    pg_status status = PG_OK;
    json_text t = { 0 };
    PG_TRY (put_node (&t, &s->root));
    *json = t.text;
    t.text = NULL;
done:
    pg_free (t.text);
    return status;
}
