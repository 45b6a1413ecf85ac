/* SPDX-License-Identifier: GPL-3.0-or-later
 * Converts a YAML text to a tree of nodes with line and column, through the document interface of libyaml.
 * Depth of nesting and number of nodes are limited, since aliases and brackets could make a small file fill
 * the memory; errors of libyaml are translated into words that help the user. */
#include "node.h"
#include <string.h>
#include <yaml.h>

/* Largest number of nested levels. */
enum { DEEPEST = 30 };

/* State of the conversion. */
typedef struct {
    yaml_document_t *document;
    const char      *origin, *file;
    pg_faults       *faults;
    /* Nodes still allowed: aliases could repeat parts without end. */
    size_t           left;
    int              good;
} reader;

/* Sets origin, line and column of a node; 0 for an override. */
static void place (const reader *r, pg_node *node, const yaml_node_t *y)
{
    node->origin = r->origin;
    node->line = r->origin ? 0 : (int) y->start_mark.line + 1;
    node->column = r->origin ? 0 : (int) y->start_mark.column + 1;
}

/* Adds a fault and marks the text as wrong. */
static void complain (reader *r, const pg_node *node, const char *why)
{
    pg_faults_add (r->faults, r->file, node, NULL, 0, "%s", why);
    r->good = 0;
}

static pg_status convert (reader *r, pg_node *node, const yaml_node_t *y, int deep);

/* Converts a single value. */
static pg_status convert_scalar (reader *r, pg_node *node, const yaml_node_t *y)
{
    const char *text = (const char *) y->data.scalar.value;
    node->shape = PG_SCALAR;
    node->plain = y->data.scalar.style == YAML_PLAIN_SCALAR_STYLE;
    /* Texts are C strings from here on. */
    if (strlen (text) != y->data.scalar.length) complain (r, node, "a text with a zero character");
    node->text = pg_strdup (text);
    return node->text ? PG_OK : pg_error (PG_E_MEMORY, PG_HERE, "no memory for a value of the scene");
}

/* Converts a list. deep: levels of nesting so far. */
static pg_status convert_list (reader *r, pg_node *node, const yaml_node_t *y, int deep)
{
    pg_status status = PG_OK;
    node->shape = PG_SEQUENCE;
    for (yaml_node_item_t *i = y->data.sequence.items.start; i < y->data.sequence.items.top; i++) {
        pg_node *child;
        const yaml_node_t *item = yaml_document_get_node (r->document, *i);
        if (!item) continue;
        PG_TRY (pg_node_add (&child, node, NULL));
        place (r, child, item);
        PG_TRY (convert (r, child, item, deep + 1));
    }
done:
    return status;
}

/* Converts a map. Keys must be single words; others are reported and skipped. */
static pg_status convert_map (reader *r, pg_node *node, const yaml_node_t *y, int deep)
{
    pg_status status = PG_OK;
    node->shape = PG_MAPPING;
    for (yaml_node_pair_t *i = y->data.mapping.pairs.start; i < y->data.mapping.pairs.top; i++) {
        pg_node *child, here = { 0 };
        const yaml_node_t *key = yaml_document_get_node (r->document, i->key),
                          *value = yaml_document_get_node (r->document, i->value);
        if (!key || !value) continue;
        place (r, &here, key);
        if (key->type != YAML_SCALAR_NODE
            || strlen ((const char *) key->data.scalar.value) != key->data.scalar.length) {
            complain (r, &here, "a key must be a plain word");
            continue;
        }
        PG_TRY (pg_node_add (&child, node, (const char *) key->data.scalar.value));
        place (r, child, key);
        PG_TRY (convert (r, child, value, deep + 1));
    }
done:
    return status;
}

/* Converts a node of any type. Aliases may repeat parts: the number of nodes is limited, so that a small file
 * cannot fill the memory. */
static pg_status convert (reader *r, pg_node *node, const yaml_node_t *y, int deep)
{
    if (deep > DEEPEST || r->left == 0) {
        if (r->good)
            complain (r, node, deep > DEEPEST ? "nested too deeply" : "too many repeated parts (aliases)");
        return pg_node_word (node, "", r->origin);
    }
    r->left--;
    if (y->type == YAML_SEQUENCE_NODE) return convert_list (r, node, y, deep);
    if (y->type == YAML_MAPPING_NODE) return convert_map (r, node, y, deep);
    return convert_scalar (r, node, y);
}

/* Finds line and column of a byte, where libyaml gives only its offset. */
static void locate (pg_node *at, const char *text, size_t length, size_t offset)
{
    at->line = at->column = 1;
    for (size_t k = 0; k < offset && k < length; k++) {
        at->column = text[k] == '\n' ? 1 : at->column + 1;
        at->line += text[k] == '\n';
    }
}

/* Is there a tab before this column of the line? YAML does not allow tabs as indentation. */
static int has_tab (const char *text, size_t length, int line, int column)
{
    size_t k = 0;
    /* k becomes the offset of the line's beginning. */
    for (; line > 1 && k < length; k++) line -= text[k] == '\n';
    for (; column > 0 && k < length && text[k] != '\n'; k++, column--)
        if (text[k] == '\t') return 1;
    return 0;
}

/* Reports a syntax error that libyaml found, in words that a user understands. */
static void syntax_fault (reader *r, const yaml_parser_t *parser, const char *text, size_t length)
{
    pg_node at = { .origin = r->origin,
                   .line = (int) parser->problem_mark.line + 1,
                   .column = (int) parser->problem_mark.column + 1 };
    r->good = 0;
    /* Bytes that are no UTF-8: libyaml gives only an offset. */
    if (parser->error == YAML_READER_ERROR) {
        locate (&at, text, length, parser->problem_offset);
        pg_faults_add (r->faults, r->file, &at, NULL, 0, "not a text in UTF-8: %s",
                       parser->problem ? parser->problem : "cannot be read");
        return;
    }
    /* The usual case: "spacing:2 mm" without a blank. */
    if (parser->context && strstr (parser->context, "simple key")) {
        at.line = (int) parser->context_mark.line + 1, at.column = (int) parser->context_mark.column + 1;
        pg_faults_add (r->faults, r->file, &at, NULL, 0,
                       "not valid YAML: a key is followed by a colon and a space, as in spacing: 2 mm");
        return;
    }
    int alias = parser->problem && strstr (parser->problem, "undefined alias") != NULL;
    int tab = parser->error == YAML_SCANNER_ERROR && has_tab (text, length, at.line, at.column);
    pg_faults_add (r->faults, r->file, &at, NULL, 0, "not valid YAML: %s%s%s%s",
                   parser->problem ? parser->problem : "cannot be read", parser->context ? " " : "",
                   parser->context ? parser->context : "",
                   tab     ? " (indent with spaces, not tabs)"
                   : alias ? " (a text that begins with * needs quotes)"
                           : "");
}

/* Reads one document; root NULL: reports a further document as a fault. */
static pg_status load_one (reader *r, yaml_parser_t *parser, pg_node *root, const char *text, size_t length)
{
    pg_status status = PG_OK;
    yaml_document_t document;
    if (!yaml_parser_load (parser, &document)) {
        if (parser->error == YAML_MEMORY_ERROR)
            return pg_error (PG_E_MEMORY, PG_HERE, "no memory to read the scene");
        syntax_fault (r, parser, text, length);
        return PG_OK;
    }
    const yaml_node_t *top = yaml_document_get_root_node (&document);
    r->document = &document;
    if (top && root) {
        r->left = 1000 + 8 * (size_t) (document.nodes.top - document.nodes.start);
        place (r, root, top);
        status = convert (r, root, top, 0);
    } else if (top) {
        pg_node here = { 0 };
        place (r, &here, top);
        complain (r, &here, "a second document: a scene is one document");
    }
    yaml_document_delete (&document);
    return status;
}

/* Checks the depth of nesting by the events of libyaml before the tree is built: building it takes time
 * quadratic in the depth. Other faults are found when the tree is built. */
static pg_status check_depth (reader *r, const char *text, size_t length)
{
    yaml_parser_t parser;
    yaml_event_t event;
    int deep = 0, end = 0;
    if (!yaml_parser_initialize (&parser))
        return pg_error (PG_E_MEMORY, PG_HERE, "no memory to read the scene");
    yaml_parser_set_input_string (&parser, (const unsigned char *) text, length);
    while (!end && yaml_parser_parse (&parser, &event)) {
        deep += event.type == YAML_SEQUENCE_START_EVENT || event.type == YAML_MAPPING_START_EVENT;
        deep -= event.type == YAML_SEQUENCE_END_EVENT || event.type == YAML_MAPPING_END_EVENT;
        if (deep > DEEPEST + 1) {
            pg_node at = { .origin = r->origin,
                           .line = (int) event.start_mark.line + 1,
                           .column = (int) event.start_mark.column + 1 };
            complain (r, &at, "nested too deeply");
        }
        end = event.type == YAML_STREAM_END_EVENT || !r->good;
        yaml_event_delete (&event);
    }
    yaml_parser_delete (&parser);
    return PG_OK;
}

/* Depth is checked before the tree is built; a second document is a fault. */
pg_status pg_node_read (pg_node *root, const char *text, size_t length, const char *origin, const char *file,
                        pg_faults *faults, int *good)
{
    reader r = { .origin = origin, .file = file, .faults = faults, .good = 1 };
    yaml_parser_t parser;
    pg_status status = check_depth (&r, text, length);
    *good = r.good;
    if (status != PG_OK || !r.good) return status;
    if (!yaml_parser_initialize (&parser))
        return pg_error (PG_E_MEMORY, PG_HERE, "no memory to read the scene");
    yaml_parser_set_input_string (&parser, (const unsigned char *) text, length);
    status = load_one (&r, &parser, root, text, length);
    if (status == PG_OK && r.good) status = load_one (&r, &parser, NULL, text, length);
    yaml_parser_delete (&parser);
    *good = r.good;
    return status;
}
