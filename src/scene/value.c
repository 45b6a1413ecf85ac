/* SPDX-License-Identifier: GPL-3.0-or-later
 * Checks one value against its row: number, unit, range, choice, length of a vector.
 *
 * A valid value is stored in the node: numbers in SI (node->value), or as a multiple of the point spacing
 * (node->spacing); truth values as 0 and 1; texts, names and expressions as they are. Names that refer to
 * other parts of the scene (input file), such as sets, are checked as far as the text alone allows; the rest
 * is found when these parts exist. */
#include "value.h"
#include "scene/quantity/expression.h"
#include "scene/quantity/unit.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

const char pg_default_origin[] = "default";

#define FAULT(node, ...) pg_faults_add (s->faults, s->file, (node), path, 1, __VA_ARGS__)

/* Turns the last error message into a fault; lack of memory or of the database of units remains a failure. */
static pg_status as_fault (pg_scene *s, const pg_node *node, const char *path, pg_status status)
{
    char why[600];
    if (status != PG_E_SCENE) return status;
    snprintf (why, sizeof why, "%s", pg_last_error ());
    FAULT (node, "%s", why);
    return PG_OK;
}

/* Checks the range of a number. An angle without unit gets a hint, since degrees are the usual mistake. */
static void check_range (pg_scene *s, const pg_node *node, const pg_key *row, const char *path)
{
    int wrong, holds = pg_range_holds (row->range, node->value, &wrong);
    const char *unit = row->unit && !node->spacing && strcmp (row->unit, "1") != 0 ? row->unit : "";
    if (wrong) FAULT (node, "the range '%s' of its key table is wrong", row->range);
    /* 1: a number without a unit, where an angle is wanted. */
    int bare = strcmp (unit, "rad") == 0 && node->text
               && node->text[strspn (node->text, "+-.0123456789eE ")] == '\0';
    if (!holds)
        FAULT (node, "must lie in %s%s%.*s%s", row->range, *unit ? " " : "", (int) strcspn (unit, "|"), unit,
               bare ? "; a number without unit is in rad, degrees are written 40 deg" : "");
}

/* Checks a number with unit. */
static pg_status check_number (pg_scene *s, pg_node *node, const pg_key *row, const char *path)
{
    pg_status status = pg_quantity_read (&node->value, &node->spacing, node->text, row->unit);
    if (status != PG_OK) return as_fault (s, node, path, status);
    check_range (s, node, row, path);
    return PG_OK;
}

/* Checks a whole number, up to 2^53. */
static void check_integer (pg_scene *s, pg_node *node, const pg_key *row, const char *path)
{
    const char *end = pg_number_read (node->text, &node->value);
    int whole = end && !*end && fabs (node->value) <= 9007199254740992.0
                && node->value == floor (node->value);
    if (!whole) FAULT (node, "must be a whole number");
    else check_range (s, node, row, path);
}

/* Checks a truth value: on, yes, true; off, no, false. */
static void check_bool (pg_scene *s, pg_node *node, const char *path)
{
    static const char *const word[] = { "off", "on", "no", "yes", "false", "true" };
    for (size_t k = 0; k < sizeof word / sizeof *word; k++)
        if (strcasecmp (node->text, word[k]) == 0) {
            node->value = (double) (k % 2);
            return;
        }
    FAULT (node, "must be on or off");
}

/* Is the text one of "a|b|c"? */
static int is_choice (const char *text, const char *choices)
{
    for (size_t n = strlen (text); ; choices++) {
        size_t m = strcspn (choices, "|");
        if (m == n && memcmp (text, choices, n) == 0) return 1;
        choices += m;
        if (*choices == '\0') return 0;
    }
}

/* Appends the names of layers, which are sets too. */
static void add_layers (const pg_scene *s, char *names, size_t at, size_t size)
{
    const pg_node *list = pg_node_child (&s->root, "layers", 6);
    for (size_t k = 0; list && k < list->n && at < size - 70; k++) {
        const pg_node *name = pg_node_child (&list->child[k], "name", 4);
        if (name && name->text) at += (size_t) snprintf (names + at, size - at, "|%.60s", name->text);
    }
}

/* Is `text` with the first word `base` a part of a shape (disk.rim)? Such parts are sets as well; `base` is
 * the kind of a shape or its name. Whether the part exists is found when the sets are built. */
static int is_part_of_shape (const pg_scene *s, const char *base, const char *text)
{
    const pg_node *list = pg_node_child (&s->root, "body", 4);
    if (!text[strlen (base)]) return 0;
    for (size_t k = 0; list && k < list->n; k++) {
        const pg_node *name = pg_node_child (&list->child[k], "name", 4),
                      *shape = pg_node_child (&list->child[k], "add", 3);
        if (!shape) shape = pg_node_child (&list->child[k], "subtract", 8);
        if (name && name->text && !strcmp (name->text, base)) return 1;
        /* The key below add: or subtract: is the kind of the shape. */
        for (size_t c = 0; shape && c < shape->n; c++)
            if (shape->child[c].name && !strcmp (shape->child[c].name, base)) return 1;
    }
    return !strcmp (base, "rim") || !strcmp (base, "side") || !strcmp (base, "hole");
}

/* Appends "|name" for each child of a map. Returns the new length. */
static size_t add_children (const pg_node *map, char *names, size_t at, size_t size)
{
    for (size_t k = 0; map && k < map->n && at < size - 70; k++)
        if (map->child[k].name) at += (size_t) snprintf (names + at, size - at, "|%s", map->child[k].name);
    return at;
}

/* Checks a name against choices "sets.{}|left|...": it must be a name of that map of the scene, one of the
 * other choices, or a part of either (name.top). */
static void check_reference (pg_scene *s, const pg_node *node, const char *choices, const char *path)
{
    char names[4096], base[64], map[64];
    size_t m = strcspn (choices, "."), at;
    snprintf (map, sizeof map, "%.*s", (int) m, choices);
    snprintf (base, sizeof base, "%.*s", (int) strcspn (node->text, "."), node->text);
    /* Names that are always there, then those of the scene. */
    at = (size_t) snprintf (names, sizeof names, "%s", choices[m + 3] ? choices + m + 4 : "");
    at = add_children (pg_node_child (&s->root, map, m), names, at, sizeof names);
    int sets = strcmp (map, "sets") == 0;
    if (sets) add_layers (s, names, at, sizeof names);
    /* The list of names is cut where it is very long: names of the scene are looked up. */
    const pg_node *own = pg_node_child (&s->root, map, m);
    if (is_choice (base, names) || (own && pg_node_child (own, base, strlen (base)))) return;
    /* parts of shapes and the sets of a mesh are looked up once they are there */
    if (sets && (is_part_of_shape (s, base, node->text) || pg_node_child (&s->root, "mesh", 4))) return;
    const char *near = pg_nearest_name (node->text, names);
    FAULT (node, "there is no %.*s of this name%s%s%s", (int) (m ? m - 1 : 0), map,
           near ? " (did you mean " : "", near ? near : "", near ? "?)" : "");
}

/* Checks a name against fixed choices, or as a reference. */
static void check_choice (pg_scene *s, const pg_node *node, const pg_key *row, const char *path)
{
    const char *choices = pg_key_choices (row);
    char listed[700];
    size_t n = 0;
    if (!choices || is_choice (node->text, choices)) return;
    if (strstr (choices, ".{}")) {
        check_reference (s, node, choices, path);
        return;
    }
    /* rewrites the list "a|b" as "a, b" */
    for (const char *c = choices; *c && n + 3 < sizeof listed; c++) {
        listed[n++] = *c == '|' ? ',' : *c;
        if (*c == '|') listed[n++] = ' ';
    }
    listed[n] = '\0';
    const char *near = pg_nearest_name (node->text, choices);
    if (near) FAULT (node, "must be one of %s; did you mean %s?", listed, near);
    else FAULT (node, "must be one of %s", listed);
}

/* Is the text a number and one word? Its error is then reported as that of a number, not of an expression. */
static int is_quantity (const char *text)
{
    char *end;
    (void) strtod (text, &end);
    if (end == text) return 0;
    while (*end == ' ') end++;
    while ((*end >= 'a' && *end <= 'z') || (*end >= 'A' && *end <= 'Z')) end++;
    return *end == '\0';
}

/* Compiles the expression only to find its faults; a constant one is checked as a number. */
static pg_status check_expression (pg_scene *s, pg_node *node, const pg_key *row, const char *path)
{
    pg_expression *e = NULL;
    pg_status status = pg_expression_compile (&e, node->text, row->unit);
    node->value = NAN;
    /* the message for a number replaces that for an expression */
    if (status == PG_E_SCENE && is_quantity (node->text))
        (void) pg_unit_parse (&node->value, node->text, row->unit);
    node->value = NAN;
    if (status != PG_OK) return as_fault (s, node, path, status);
    /* The value is known: a number, or a formula without variables. */
    if (pg_expression_constant (e, &node->value)) {
        if (!isfinite (node->value)) FAULT (node, "has no finite value");
        else if (pg_quantity_sane (node->value) != PG_OK) FAULT (node, "%s", pg_last_error ());
        else check_range (s, node, row, path);
    }
    pg_expression_free (&e);
    return PG_OK;
}

/* Checks a single value of any kind. */
static pg_status check_scalar (pg_scene *s, pg_node *node, const pg_key *row, const char *path)
{
    node->key = row;
    if (pg_node_null (node)) {
        char wanted[PG_LEVEL_NAMES];
        pg_schema_wanted (&s->schema, row->path, wanted, sizeof wanted);
        FAULT (node, "has no value: must be %s", wanted);
        return PG_OK;
    }
    switch (row->kind) {
    case PG_NUMBER:
    case PG_VECTOR:
    case PG_NUMBERS:    return check_number (s, node, row, path);
    case PG_EXPRESSION: return check_expression (s, node, row, path);
    case PG_INTEGER:    check_integer (s, node, row, path); break;
    case PG_BOOL:       check_bool (s, node, path); break;
    case PG_NAME:
    case PG_NAMES:      check_choice (s, node, row, path); break;
    default:            break;
    }
    return PG_OK;
}

/* Is the value a list in quotes, such as "0, 5 mm"? Then it is reported. */
static int is_quoted_list (pg_scene *s, const pg_node *node, const char *path)
{
    if (node->shape != PG_SCALAR || !strchr (node->text, ',')) return 0;
    FAULT (node, "is one text: write a list such as [0, 5 mm], without quotes");
    return 1;
}

/* Checks that a vector has as many numbers as the scene has dimensions; a default may be longer. */
static void check_length (pg_scene *s, const pg_node *node, const char *path)
{
    size_t n = node->shape == PG_SCALAR ? 1 : node->n, dim = (size_t) s->dimension;
    /* A default may have more numbers than the scene has dimensions. */
    if (node->origin == pg_default_origin) return;
    if (dim && n != dim) FAULT (node, "needs %zu number%s in %zuD, has %zu", dim, dim > 1 ? "s" : "", dim, n);
    else if (n < 1 || n > 3) FAULT (node, "needs 1 to 3 numbers, has %zu", n);
}

/* Checks a value; a list is checked element by element against the same row. */
pg_status pg_value_check (pg_scene *s, pg_node *node, const pg_key *row, const char *path)
{
    pg_status status = PG_OK;
    node->key = row;
    if ((row->kind == PG_VECTOR || row->kind == PG_NUMBERS) && is_quoted_list (s, node, path)) return PG_OK;
    if (row->kind == PG_VECTOR) check_length (s, node, path);
    if (node->shape == PG_SCALAR) return check_scalar (s, node, row, path);
    for (size_t k = 0; k < node->n; k++) {
        char part[PG_PATH_TEXT];
        snprintf (part, sizeof part, "%.480s[%zu]", path, k);
        if (node->child[k].shape == PG_SCALAR) PG_TRY (check_scalar (s, &node->child[k], row, part));
        else
            pg_faults_add (s->faults, s->file, &node->child[k], part, 0, "must be %s",
                           row->kind == PG_NAMES ? "a name" : "a number");
    }
done:
    return status;
}
