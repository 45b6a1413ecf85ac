/* SPDX-License-Identifier: GPL-3.0-or-later
 * The keys of a scene (input file) as a JSON schema (draft 7), by which editors complete keys, show what they
 * mean and mark errors. It is made of the same rows that check a scene. What only the program can check
 * (units, ranges of values with units, names of sets) is described in words. */
#include "keys.h"
#include <string.h>

/* Writes a text as a JSON string. */
static void put_text (FILE *to, const char *text)
{
    fputc ('"', to);
    for (; *text; text++) {
        if (*text == '"' || *text == '\\') fputc ('\\', to);
        if ((unsigned char) *text >= 0x20) fputc (*text, to);
    }
    fputc ('"', to);
}

/* Writes choices "a|b" as an enumeration, of texts or (1|2|3) of numbers; as any text where not all choices
 * are known here (names of sets). */
static void put_choices (FILE *to, const char *names)
{
    if (!names || !*names || strstr (names, "{}")) {
        fprintf (to, "\"type\": \"string\"");
        return;
    }
    const char *quote = strspn (names, "0123456789|") == strlen (names) ? "" : "\"";
    fprintf (to, "\"enum\": [");
    for (const char *at = names; *at;) {
        size_t n = strcspn (at, "|");
        fprintf (to, "%s%s%.*s%s", at == names ? "" : ", ", quote, (int) n, at, quote);
        at += n + (at[n] == '|');
    }
    fputc (']', to);
}

/* Writes which types of JSON the value of a row may have. A number may always be a text: it then carries a
 * unit, or is a formula. */
static void put_type (FILE *to, const pg_key *key)
{
    static const char value[] = "\"type\": [\"number\", \"string\"]";
    switch (key->kind) {
    case PG_MAP: fprintf (to, "\"type\": \"object\""); break;
    case PG_LIST: fprintf (to, "\"type\": \"array\""); break;
    case PG_INTEGER: fprintf (to, "\"type\": \"integer\""); break;
    case PG_BOOL: fprintf (to, "\"enum\": [true, false, \"on\", \"off\", \"yes\", \"no\"]"); break;
    case PG_NUMBER:
    case PG_EXPRESSION: fputs (value, to); break;
    case PG_VECTOR:
    case PG_NUMBERS:
        fprintf (to, "\"type\": [\"array\", \"number\", \"string\"], \"items\": {%s}", value);
        break;
    case PG_NAMES:
        fprintf (to, "\"type\": [\"string\", \"array\"], \"items\": {\"type\": \"string\"}");
        break;
    case PG_NAME: put_choices (to, pg_key_choices (key)); break;
    default: fprintf (to, "\"type\": [\"string\", \"number\"]");
    }
}

static void put_meaning (FILE *to, const pg_key *key)
{
    char first[PG_LEVEL_NAMES];
    const char *fallback = pg_key_default (key, first);
    fprintf (to, ", \"description\": ");
    put_text (to, key->doc);
    if (key->unit) {
        fprintf (to, ", \"unit\": ");
        put_text (to, key->unit);
    }
    if (key->range) {
        fprintf (to, ", \"range\": ");
        put_text (to, key->range);
    }
    if (fallback && *fallback) {
        fprintf (to, ", \"default\": ");
        put_text (to, fallback);
    }
}

static void put_node (FILE *to, const pg_schema *s, const char *pattern, int depth);

/* Writes the keys below a map: those with fixed names, and the one for names that the user chooses. */
static void put_entries (FILE *to, const pg_schema *s, const char *pattern, int depth)
{
    char names[PG_LEVEL_NAMES], below[PG_PATTERN];
    const char *comma = "";
    pg_schema_names (s, pattern, names);
    fprintf (to, "\"properties\": {");
    for (const char *at = names; *at;) {
        size_t n = strcspn (at, "|");
        fprintf (to, "%s\n%*s\"%.*s\": ", comma, 2 * depth, "", (int) n, at);
        comma = ",";
        snprintf (below, sizeof below, "%s%s%.*s", pattern, *pattern ? "." : "", (int) n, at);
        put_node (to, s, below, depth + 1);
        at += n + (at[n] == '|');
    }
    fprintf (to, "}, \"additionalProperties\": ");
    snprintf (below, sizeof below, "%s.{}", pattern);
    if (*pattern && (pg_schema_any (s, below) || pg_schema_opens (s, below, '.')))
        put_node (to, s, below, depth + 1);
    else fprintf (to, "false");
}

/* Of the rows of this path, the first of each kind: returns number `wanted` of these, NULL: there are no
 * more. */
static const pg_key *row_of (const pg_schema *s, const char *pattern, int wanted)
{
    unsigned seen = 0;
    for (size_t k = 0; k < s->n; k++) {
        const pg_key *key = s->row[k];
        if (strcmp (key->path, pattern) != 0 || (seen & 1u << key->kind)) continue;
        seen |= 1u << key->kind;
        if (wanted-- == 0) return key;
    }
    return NULL;
}

/* Writes the schema of a pattern: all rows of that path, which may take values of several shapes, and the
 * keys below. */
static void put_node (FILE *to, const pg_schema *s, const char *pattern, int depth)
{
    char below[PG_PATTERN];
    int map = pg_schema_opens (s, pattern, '.'), list = pg_schema_opens (s, pattern, '[');
    int several = row_of (s, pattern, 1) != NULL;
    const pg_key *key;
    fputs (several ? "{\"anyOf\": [" : "{", to);
    for (int k = 0; (key = row_of (s, pattern, k)); k++) {
        if (several) fputs (k ? ", {" : "{", to);
        put_type (to, key);
        put_meaning (to, key);
        if (several) fputc ('}', to);
    }
    if (several) fputc (']', to);
    else if (!row_of (s, pattern, 0)) fprintf (to, "\"type\": \"%s\"", list && !map ? "array" : "object");
    if (map) {
        fprintf (to, ", ");
        put_entries (to, s, pattern, depth);
    }
    if (list) {
        snprintf (below, sizeof below, "%s[]", pattern);
        fprintf (to, ", \"items\": ");
        put_node (to, s, below, depth + 1);
    }
    fputc ('}', to);
}

pg_status pg_json_schema_write (FILE *to, const pg_schema *s)
{
    fprintf (to, "{\"$schema\": \"http://json-schema.org/draft-07/schema#\",\n"
                 " \"title\": \"Perigal scene\",\n \"type\": \"object\", ");
    put_entries (to, s, "", 1);
    fprintf (to, "}\n");
    return ferror (to) ? pg_error (PG_E_FILE, PG_HERE, "the JSON schema could not be written") : PG_OK;
}
