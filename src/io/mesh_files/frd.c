/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results of CalculiX (.frd; format by the manual of its viewer cgx): blocks of nodes, elements and
 * results, each as text in short or long columns, or binary.
 *
 * The first characters of a line are a key: "    2C" nodes, "    3C" elements, "  100C" results, within
 * blocks " -1" an item, " -2" its continuation, " -3" the end, " -4" and " -5" names of a result and its
 * components, " 9999" the end of the file. Numbers stand in fixed columns, often without blanks between
 * them. */
#include "format.h"
#include <ctype.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

/* Formats 0 to 3 of a block; length of a name; most components of a result. */
enum { SHORT, LONG, FLOATS, DOUBLES, NAME = 9, MOST_COMPONENTS = 64 };

/* A block of results. */
typedef struct {
    char   name[NAME];
    /* Time of the step of the block. */
    double value;
    /* Number of the step; number of nodes. */
    long   number, nodes;
    /* Format of the values of the block, and number of components that are stored. */
    int    format, components;
    /* Position in the file at which the values begin. */
    mesh_cursor data;
} block;

/* State of the reader. */
typedef struct {
    /* Position in the file. */
    mesh_cursor    c;
    /* The present line. */
    const char    *first, *last;
    /* Receives the mesh; NULL: only results are wanted. */
    pg_mesh_builder *builder;
    /* Blocks of results found so far. */
    size_t  nblock, capacity;
    block  *block;
} reader;

/* ---- columns ------------------------------------------------------------------------------------------- */
/* The text in columns [at, at + width) of the line without surrounding blanks; 0: there is none. */
static int column (const reader *r, size_t at, size_t width, const char **s, const char **end)
{
    size_t n = (size_t) (r->last - r->first);
    /* Lines may end before their last columns. */
    if (at >= n) return 0;
    *s = r->first + at;
    *end = at + width < n ? *s + width : r->last;
    while (*s < *end && **s == ' ') ++*s;
    while (*end > *s && (*end)[-1] == ' ') --*end;
    return *s < *end;
}

/* Reads an integer or a real number from columns [at, at + width) of the line; 0: there is none. */
static int whole (const reader *r, size_t at, size_t width, long *value)
{
    const char *s, *end;
    return column (r, at, width, &s, &end) && mesh_whole (&s, end, value) && s == end;
}

static int real (const reader *r, size_t at, size_t width, double *value)
{
    const char *s, *end;
    return column (r, at, width, &s, &end) && mesh_real (&s, end, value) && s == end;
}

/* Copies the word in columns [at, at + width) of the line to text; "" where there is none. */
static void word (const reader *r, size_t at, size_t width, char *text, size_t size)
{
    const char *s = "", *end = s;
    if (!column (r, at, width, &s, &end)) end = s;
    size_t n = (size_t) (end - s) < size ? (size_t) (end - s) : size - 1;
    memcpy (text, s, n);
    text[n] = 0;
}

/* Reads the next line; 0: the end. */
static int next (reader *r) { return mesh_line (&r->c, &r->first, &r->last); }

/* Does the line begin with this key, such as " -1" or "    2C"? */
static int is_key (const reader *r, const char *key)
{
    size_t n = strlen (key);
    return (size_t) (r->last - r->first) >= n && memcmp (r->first, key, n) == 0;
}

/* Columns of a number of a node or element: 5 in short blocks, 10 in long ones. */
static size_t id_width (int format) { return format == SHORT ? 5 : 10; }

/* Returns the address of the next n bytes and moves behind them; NULL where the file is shorter. */
static const char *bytes (reader *r, size_t n)
{
    const char *at = r->c.at;
    if ((size_t) (r->c.end - at) < n) return NULL;
    r->c.at += n;
    return at;
}

/* Read binary numbers in the byte order of the machine: a 32-bit integer, a float or a double. */
static long int_at (const char *p)
{
    int32_t v;
    memcpy (&v, p, sizeof v);
    return v;
}

static double real_at (const char *p, int format)
{
    float f;
    double d;
    memcpy (&f, p, sizeof f);
    if (format == DOUBLES) memcpy (&d, p, sizeof d);
    return format == DOUBLES ? d : (double) f;
}

/* Reads number of items and format from columns `at` and `format_at` of the line that begins a block. */
static pg_status block_head (const reader *r, const char *what, size_t at, size_t format_at, long *n,
                             int *format)
{
    pg_status status = PG_OK;
    long f = 0;
    if (!whole (r, at, 12, n) || *n < 0) MESH_FAIL (&r->c, "no number of %s", what);
    /* The format stands at the end of the line. */
    if (!whole (r, format_at, 2, &f) || f < SHORT || f > DOUBLES)
        MESH_FAIL (&r->c, "the format of the %s is none of 0 (short), 1 (long), 2, 3 (binary)", what);
    *format = (int) f;
done:
    return status;
}

/* ---- nodes --------------------------------------------------------------------------------------------- */
/* Reads n nodes in binary form: number and three coordinates each. */
static pg_status binary_nodes (reader *r, long n, int format)
{
    pg_status status = PG_OK;
    size_t size = format == DOUBLES ? 8 : 4;
    for (long k = 0; k < n; k++) {
        const char *p = bytes (r, 4 + 3 * size);
        if (!p) MESH_FAIL (&r->c, "the file ends within node %ld of %ld", k + 1, n);
        double x[3] = { real_at (p + 4, format), real_at (p + 4 + size, format),
                        real_at (p + 4 + 2 * size, format) };
        if (r->builder) PG_TRY (pg_mesh_builder_node (r->builder, int_at (p), x));
    }
done:
    return status;
}

/* Reads a block of nodes. */
static pg_status read_nodes (reader *r)
{
    pg_status status = PG_OK;
    long n, id, count = 0;
    int format;
    double x[3];
    PG_TRY (block_head (r, "nodes", 24, 73, &n, &format));
    if (format >= FLOATS) {
        status = binary_nodes (r, n, format);
        goto done;
    }
    size_t width = id_width (format);
    /* Without a builder the lines are only counted. */
    for (; next (r) && !is_key (r, " -3"); count++) {
        if (!r->builder) continue;
        if (!is_key (r, " -1") || !whole (r, 3, width, &id)) MESH_FAIL (&r->c, "is no line of a node");
        for (size_t a = 0; a < 3; a++)
            if (!real (r, 3 + width + 12 * a, 12, &x[a]))
                MESH_FAIL (&r->c, "node %ld: coordinate %zu is no number", id, a + 1);
        PG_TRY (pg_mesh_builder_node (r->builder, id, x));
    }
    if (count != n) MESH_FAIL (&r->c, "%ld nodes, but the block says %ld", count, n);
done:
    return status;
}

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Elements by their kind in cgx, 1 to 12; their nodes are in the order of Exodus. */
static const pg_element kinds[] = { PG_ELEMENTS, PG_HEX8, PG_WEDGE6, PG_TET4,  PG_HEX20, PG_WEDGE15, PG_TET10,
                                    PG_TRI3,     PG_TRI6, PG_QUAD4,  PG_QUAD8, PG_BAR2,  PG_BAR3 };


/* Converts the kind of an element, 1 to 12 as in cgx; other numbers are a fault. */
static pg_status check_kind (const reader *r, long id, long kind, pg_element *out)
{
    pg_status status = PG_OK;
    if (kind < 1 || kind > 12) MESH_FAIL (&r->c, "element %ld is of kind %ld; known are 1 to 12", id, kind);
    *out = kinds[kind];
done:
    return status;
}

/* Reads n elements in binary form: number, kind, group, material, nodes. */
static pg_status binary_elements (reader *r, long n)
{
    pg_status status = PG_OK;
    for (long k = 0; k < n; k++) {
        pg_element kind = PG_ELEMENTS;
        long node[PG_ELEMENT_NODES];
        const char *p = bytes (r, 16), *q;
        if (!p) MESH_FAIL (&r->c, "the file ends within element %ld of %ld", k + 1, n);
        PG_TRY (check_kind (r, int_at (p), int_at (p + 4), &kind));
        int nodes = pg_element_types[kind].nodes;
        /* The number of nodes follows from the kind. */
        if (!(q = bytes (r, 4 * (size_t) nodes)))
            MESH_FAIL (&r->c, "the file ends within element %ld of %ld", k + 1, n);
        for (int i = 0; i < nodes; i++) node[i] = int_at (q + 4 * i);
        if (r->builder)
            PG_TRY (pg_mesh_builder_element (r->builder, int_at (p), kind, node, int_at (p + 12), 0));
    }
done:
    return status;
}

/* Reads an element in text form, which takes several lines. */
static pg_status text_element (reader *r, int format)
{
    pg_status status = PG_OK;
    size_t width = id_width (format), per_line = format == SHORT ? 15 : 10;
    long id, type, material = 0, node[PG_ELEMENT_NODES], line = r->c.line;
    pg_element kind = PG_ELEMENTS;
    if (!is_key (r, " -1") || !whole (r, 3, width, &id) || !whole (r, 3 + width, 5, &type))
        MESH_FAIL (&r->c, "is no line of an element");
    whole (r, 13 + width, 5, &material);
    PG_TRY (check_kind (r, id, type, &kind));
    size_t nodes = (size_t) pg_element_types[kind].nodes;
    /* Nodes stand on lines " -2", 15 of short or 10 of long numbers each. */
    for (size_t k = 0; k < nodes; k++) {
        if (k % per_line == 0 && (!next (r) || !is_key (r, " -2")))
            MESH_FAIL (&r->c, "element %ld has %zu of %zu nodes", id, k, nodes);
        if (!whole (r, 3 + width * (k % per_line), width, &node[k]))
            MESH_FAIL (&r->c, "element %ld has %zu of %zu nodes", id, k, nodes);
    }
    PG_TRY (pg_mesh_builder_element (r->builder, id, kind, node, material, line));
done:
    return status;
}

/* Reads a block of elements. */
static pg_status read_elements (reader *r)
{
    pg_status status = PG_OK;
    long n, count = 0;
    int format;
    PG_TRY (block_head (r, "elements", 24, 73, &n, &format));
    if (format >= FLOATS) {
        status = binary_elements (r, n);
        goto done;
    }
    for (; next (r) && !is_key (r, " -3"); count++) if (r->builder) PG_TRY (text_element (r, format));
    if (r->builder && count != n) MESH_FAIL (&r->c, "%ld elements, but the block says %ld", count, n);
done:
    return status;
}

/* ---- results ------------------------------------------------------------------------------------------- */
/* Moves the reader behind the values of a block. */
static pg_status skip_values (reader *r, const block *b)
{
    pg_status status = PG_OK;
    size_t size = 4 + (b->format == DOUBLES ? 8 : 4) * (size_t) b->components;
    /* Text up to the line that ends the block; binary blocks by their size. */
    if (b->format < FLOATS) {
        while (next (r)) if (is_key (r, " -3")) goto done;
        MESH_FAIL (&r->c, "the file ends within %s", b->name);
    }
    if ((size_t) b->nodes > (size_t) (r->c.end - r->c.at) / size)
        MESH_FAIL (&r->c, "the file ends within the %ld nodes of %s", b->nodes, b->name);
    r->c.at += (size_t) b->nodes * size;
done:
    return status;
}

/* Stores name, step and position of a block of results, and skips its values; components that the viewer
 * computes have no values in the file. */
static pg_status read_block (reader *r)
{
    pg_status status = PG_OK;
    block b = { 0 };
    long n, given, made;
    PG_TRY (block_head (r, "values", 24, 73, &b.nodes, &b.format));
    if (!real (r, 12, 12, &b.value)) MESH_FAIL (&r->c, "results without a time");
    whole (r, 58, 5, &b.number);
    /* The line behind the head has the name and the number of components. */
    if (!next (r) || !is_key (r, " -4") || !whole (r, 13, 5, &n) || n < 1 || n > MOST_COMPONENTS)
        MESH_FAIL (&r->c, "a block of results begins with its name and 1 to %d components", MOST_COMPONENTS);
    word (r, 5, 8, b.name, sizeof b.name);
    /* Each component has a line, with a 1 if it is not stored but computed by the viewer. */
    for (given = 0; given < n; given++) {
        if (!next (r) || !is_key (r, " -5"))
            MESH_FAIL (&r->c, "%s has %ld of %ld components", b.name, given, n);
        b.components += !whole (r, 33, 5, &made) || made == 0;
    }
    b.data = r->c;
    PG_TRY (skip_values (r, &b));
    if (r->builder) PG_TRY (pg_mesh_builder_pass (r->builder, "results %s", b.name));
    PG_GROW (r->block, r->capacity, r->nblock + 1);
    r->block[r->nblock++] = b;
done:
    return status;
}

/* Names of materials, as in "    1UMAT    1STEEL", are names of groups. */
static pg_status read_material (reader *r)
{
    pg_status status = PG_OK;
    long n;
    char name[64];
    if (!r->builder || !whole (r, 9, 5, &n)) goto done;
    word (r, 14, 63, name, sizeof name);
    /* The material is the group of elements of any dimension. */
    for (int dim = 1; dim <= 3; dim++) PG_TRY (pg_mesh_builder_group (r->builder, dim, n, name));
done:
    return status;
}

/* Walks through the whole file. */
static pg_status read_all (reader *r)
{
    pg_status status = PG_OK;
    while (next (r)) {
        if (is_key (r, " 9999")) break;
        if (is_key (r, "    1UMAT")) PG_TRY (read_material (r));
        else if (is_key (r, "    2C")) PG_TRY (read_nodes (r));
        else if (is_key (r, "    3C")) PG_TRY (read_elements (r));
        else if (is_key (r, "  100C")) PG_TRY (read_block (r));
    }
done:
    return status;
}

/* 1 if the first line is a header ("1C"), a user's line ("1U") or the head of a block of nodes ("2C"). */
static int knows_frd (const mesh_file *file)
{
    return file->size > 6
           && (!memcmp (file->text, "    1C", 6) || !memcmp (file->text, "    2C", 6)
               || !memcmp (file->text, "    1U", 6));
}

/* Results are skipped while the mesh is read. */
static pg_status read_frd (pg_mesh_builder *m, const mesh_file *file)
{
    reader r = { .c = mesh_begin (file), .builder = m };
    pg_status status = read_all (&r);
    pg_free (r.block);
    return status;
}

/* ---- fields -------------------------------------------------------------------------------------------- */
/* Do two blocks belong to one step? */
static int same_step (const block *a, const block *b)
{
    return a->value == b->value && a->number == b->number;
}

/* Reads number and values of the next node of a block; *more = 0: there is none. */
static pg_status next_values (reader *r, const block *b, long *id, double *value, int *more)
{
    pg_status status = PG_OK;
    size_t size = b->format == DOUBLES ? 8 : 4, width = id_width (b->format), n = (size_t) b->components;
    if (b->format >= FLOATS) {
        const char *p = bytes (r, 4 + size * n);
        if (!p) MESH_FAIL (&r->c, "the file ends within %s", b->name);
        *id = int_at (p);
        for (size_t k = 0; k < n; k++) value[k] = real_at (p + 4 + size * k, b->format);
        goto done;
    }
    *more = next (r) && !is_key (r, " -3");
    if (!*more) goto done;
    if (!is_key (r, " -1") || !whole (r, 3, width, id))
        MESH_FAIL (&r->c, "is no line of %s at a node", b->name);
    for (size_t k = 0; k < n; k++) {
        /* Six values per line. */
        if (k > 0 && k % 6 == 0 && (!next (r) || !is_key (r, " -2")))
            MESH_FAIL (&r->c, "%s at node %ld: %zu of %zu values", b->name, *id, k, n);
        if (!real (r, 3 + width + 12 * (k % 6), 12, &value[k]))
            MESH_FAIL (&r->c, "%s at node %ld: value %zu is no number", b->name, *id, k + 1);
    }
done:
    return status;
}

/* Name that Perigal gives a field: displacement, stress, strain, else that in the file. */
static const char *field_name (const char *name)
{
    /* DISP, STRESS and TOSTRAIN are CalculiX's names of displacements, stresses and total strains. */
    return strcmp (name, "DISP") == 0       ? "displacement"
           : strcmp (name, "STRESS") == 0   ? "stress"
           : strcmp (name, "TOSTRAIN") == 0 ? "strain"
                                            : name;
}

/* Reads one field. Nodes that the mesh does not use are skipped; a node of the mesh without a value is a
 * fault. have: scratch space, one byte per node of the mesh. */
static pg_status read_field (mesh_fields *out, const pg_mesh *mesh, const pg_id_table *nodes, reader *r,
                             const block *b, unsigned char *have)
{
    pg_status status = PG_OK;
    pg_mesh_field *field;
    double value[MOST_COMPONENTS];
    size_t n = (size_t) b->components, found = 0;
    int more = 1;
    PG_TRY (mesh_fields_add (out, mesh->nnode, field_name (b->name), b->components, &field));
    memset (have, 0, mesh->nnode);
    r->c = b->data;
    /* Text ends with a line " -3", binary blocks after their number of nodes. */
    for (long k = 0; b->format < FLOATS || k < b->nodes; k++) {
        long id = 0;
        PG_TRY (next_values (r, b, &id, value, &more));
        if (!more) break;
        long at = pg_id_table_find (nodes, id);
        if (at < 0) continue;
        for (size_t c = 0; c < n; c++)
            if (!isfinite (value[c])) MESH_FAIL (&r->c, "%s at node %ld is not finite", b->name, id);
        memcpy (field->value + (size_t) at * n, value, n * sizeof *value);
        found += !have[at];
        have[at] = 1;
    }
    if (found < mesh->nnode)
        MESH_FAIL (&r->c, "%s is given at %zu of %zu nodes", b->name, found, mesh->nnode);
done:
    return status;
}

/* Blocks of results that follow one another with the same time and number are one step. Blocks without
 * components of their own hold only derived values. */
static pg_status fields_frd (mesh_fields *out, const pg_mesh *mesh, const mesh_file *file, int step)
{
    pg_status status = PG_OK;
    reader r = { .c = mesh_begin (file) };
    pg_id_table nodes = { 0 };
    unsigned char *have = NULL;
    size_t steps = 0, chosen, twice, k = 0;
    PG_TRY (read_all (&r));
    /* Numbers of steps count the changes of time or number from block to block. */
    for (size_t b = 0; b < r.nblock; b++) steps += b == 0 || !same_step (&r.block[b], &r.block[b - 1]);
    PG_TRY (mesh_fields_step (file->path, steps, step, &chosen));
    PG_TRY (pg_id_table_build (&nodes, mesh->nnode, mesh->node_id, &twice));
    PG_ALLOC (have, mesh->nnode);
    for (size_t b = 0; b < r.nblock; b++) {
        k += b > 0 && !same_step (&r.block[b], &r.block[b - 1]);
        if (k != chosen || r.block[b].components == 0) continue;
        out->time = r.block[b].value;
        PG_TRY (read_field (out, mesh, &nodes, &r, &r.block[b], have));
    }
done:
    pg_id_table_clear (&nodes);
    pg_free (have), pg_free (r.block);
    return status;
}

const mesh_format mesh_format_frd = { "CalculiX .frd", knows_frd, read_frd, fields_frd };
