/* SPDX-License-Identifier: GPL-3.0-or-later
 * The data lines of an .inp file behind *NODE, *ELEMENT, *NSET, *ELSET, *SURFACE and *INSTANCE. Fields are
 * separated by commas; an element may extend over several lines; names in sets refer to sets that were
 * named before. */
#include "abaqus.h"
#include <ctype.h>
#include <string.h>
#include <strings.h>

typedef abaqus_reader reader;
/* The innermost open file. */
static const abaqus_file *now (const reader *r) { return &r->file[r->depth]; }

/* Returns the position behind blanks and, if one follows, a comma. */
static const char *skip_comma (const char *s, const char *end)
{
    while (s < end && (*s == ' ' || *s == '\t')) s++;
    return s < end && *s == ',' ? s + 1 : s;
}

/* Only blanks up to the end of the line? */
static int at_end (const char *s, const char *end)
{
    while (s < end && isspace ((unsigned char) *s)) s++;
    return s == end;
}

/* Only blanks up to the next comma or the end? */
static int empty (const char *s, const char *end)
{
    while (s < end && isspace ((unsigned char) *s)) s++;
    return s == end || *s == ',';
}

/* Reads a node: NUMBER, X, Y, Z; coordinates left out are zero. */
static pg_status node_line (reader *r)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    double x[3] = { 0 };
    long id;
    if (!mesh_whole (&s, end, &id))
        PG_TRY (
            ABAQUS_WRONG (r, "'%.*s' is no node: NUMBER, X, Y, Z", (int) (end - s > 40 ? 40 : end - s), s));
    for (int a = 0; a < 3 && !at_end (s, end); a++) {
        s = skip_comma (s, end);
        const char *before = s;
        /* A coordinate may be left out between two commas. */
        if (empty (s, end)) continue;
        if (!mesh_real (&s, end, &x[a]) || !empty (s, end))
            PG_TRY (ABAQUS_WRONG (r, "coordinate %d of node %ld is '%.*s'", a + 1, id,
                                  (int) (end - before > 20 ? 20 : end - before), before));
    }
    PG_TRY (pg_mesh_builder_node (r->data.builder, id, x));
    if (r->set >= 0) PG_TRY (abaqus_set_add (&r->data.nset.set[r->set], (abaqus_range) { id, id, 1, 0 }));
done:
    return status;
}

/* Gives the element whose nodes are complete to the builder; its group is the index of its set + 1. */
static pg_status add_element (reader *r)
{
    pg_status status = PG_OK;
    long node[PG_ELEMENT_NODES];
    abaqus *a = &r->data;
    for (int k = 0; k < r->type.nodes; k++) node[k] = r->node[r->order[k]];
    size_t n = pg_mesh_builder_given (a->builder).n;
    PG_GROW (a->shell, a->capacity, n + 1);
    a->shell[n] = (unsigned char) r->type.shell;
    PG_TRY (pg_mesh_builder_element (a->builder, r->element, r->type.kind, node, r->set + 1,
                                     r->depth ? 0 : r->element_line));
    if (r->set >= 0)
        PG_TRY (abaqus_set_add (&a->elset.set[r->set], (abaqus_range){ r->element, r->element, 1, 0 }));
    r->have = -1;
done:
    return status;
}

/* Reads a line of an element: its number, then its nodes, which may extend over several lines. */
static pg_status element_line (reader *r)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    long id;
    while (!at_end (s, end)) {
        if (!mesh_whole (&s, end, &id))
            PG_TRY (ABAQUS_WRONG (r, "'%.*s' is no number of a node or element",
                                  (int) (end - s > 20 ? 20 : end - s), s));
        s = skip_comma (s, end);
        /* The first number is that of the element. */
        if (r->have < 0) r->element = id, r->element_line = now (r)->c.line, r->have = 0;
        else r->node[r->have++] = id;
        if (r->have == r->type.nodes) {
            /* CalculiX ignores what stands behind the last node; zeros are what some programs pad with */
            if (!at_end (s, end))
                PG_TRY (pg_mesh_builder_pass (r->data.builder, "numbers behind the last node of an element "
                                              "(CalculiX ignores them)"));
            s = end;
            PG_TRY (add_element (r));
        }
    }
done:
    return status;
}

/* The next word between commas, without the name of the one instance and a dot before it. 0: no more
 * words. */
static int next_word (const reader *r, const char **s, const char *end, char word[ABAQUS_WORD])
{
    if (at_end (*s, end)) return 0;
    const char *stop = *s;
    for (int quoted = 0; stop < end && (quoted || *stop != ','); stop++) quoted ^= *stop == '"';
    abaqus_trim (word, ABAQUS_WORD, *s, stop);
    *s = stop < end ? stop + 1 : end;
    size_t n = strlen (r->instance);
    if (n && strncasecmp (word, r->instance, n) == 0 && word[n] == '.')
        memmove (word, word + n + 1, strlen (word + n + 1) + 1);
    return 1;
}

/* Is the whole word a whole number? */
static int is_number (const char *word, long *value)
{
    const char *end = word + strlen (word);
    return mesh_whole (&word, end, value) && word == end;
}

/* Reads members of a set: numbers, or names of sets that exist already. */
static pg_status set_line (reader *r, abaqus_sets *sets, const char *what)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    char word[ABAQUS_WORD];
    long id;
    while (next_word (r, &s, end, word)) {
        if (!word[0]) continue;
        /* The line is kept, so that a missing number can be reported where it stands. */
        if (is_number (word, &id)) {
            PG_TRY (abaqus_set_add (&sets->set[r->set], (abaqus_range) { id, id, 1, now (r)->c.line }));
            continue;
        }
        word[ABAQUS_NAME - 1] = 0;
        /* A word that is no number names a set, which must exist but may still grow. */
        int other = abaqus_set_find (sets, word);
        if (other < 0) PG_TRY (ABAQUS_WRONG (r, "there is no %s set '%.63s' before this line", what, word));
        PG_TRY (abaqus_set_add (&sets->set[r->set], (abaqus_range) { other, other, ABAQUS_SET, 0 }));
        /* In a surface of nodes an area may follow, which is not needed. */
        if (r->mode == ABAQUS_NODE_SURFACE) break;
    }
done:
    return status;
}

/* Reads a line of a set by GENERATE: FIRST, LAST, STEP. */
static pg_status generate_line (reader *r, abaqus_set *set)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    long v[3] = { 0, 0, 1 };
    int n = 0;
    for (; n < 3 && mesh_whole (&s, end, &v[n]); n++) s = skip_comma (s, end);
    if (n < 2 || !at_end (s, end) || v[1] < v[0] || v[2] < 1)
        PG_TRY (
            ABAQUS_WRONG (r,
                          "a set by GENERATE has lines FIRST, LAST, STEP with FIRST <= LAST and STEP >= 1"));
    PG_TRY (abaqus_set_add (set, (abaqus_range) { v[0], v[1], v[2], 0 }));
done:
    return status;
}

/* Reads a line of *SURFACE: an element or an element set, and a face such as S1. */
static pg_status surface_line (reader *r)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    char word[ABAQUS_WORD], face[ABAQUS_WORD] = "";
    abaqus_surface *surface = &r->data.surface[r->surface];
    abaqus_face f = { .line = now (r)->c.line, .set = -1 };
    /* In Abaqus an empty first field means all free faces of the model, which nobody has counted when this
     * line is read; a scene has a name for them. */
    if (!next_word (r, &s, end, word) || !word[0])
        PG_TRY (ABAQUS_WRONG (r, "surface '%s' names no element: a line without one means all free faces, "
                                 "which scenes call `all`; write an element or element set before the face",
                              surface->name));
    next_word (r, &s, end, face);
    if (!face[0])
        PG_TRY (ABAQUS_WRONG (r, "surface '%s' names no face of '%.40s': write S1 ... S6 behind it",
                              surface->name, word));
    if (strlen (face) >= sizeof f.face) PG_TRY (ABAQUS_WRONG (r, "'%.40s' is no face: S1 ... S6", face));
    memcpy (f.face, face, strlen (face));
    if (!is_number (word, &f.element)) {
        word[ABAQUS_NAME - 1] = 0;
        f.set = abaqus_set_find (&r->data.elset, word);
        if (f.set < 0) PG_TRY (ABAQUS_WRONG (r, "there is no element set '%.63s' before this line", word));
    }
    PG_GROW (surface->face, surface->capacity, surface->n + 1);
    surface->face[surface->n++] = f;
done:
    return status;
}

/* Reads the translation and rotation of an instance, which must be zero. */
static pg_status instance_line (reader *r)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    double v;
    while (mesh_real (&s, end, &v)) {
        if (v != 0)
            PG_TRY (ABAQUS_WRONG (
                r, "the instance is moved or turned: only parts that stay where they are written are read"));
        s = skip_comma (s, end);
    }
done:
    return status;
}

/* Reads a line of an element that is skipped, and stores its number, as sets may name it. */
static pg_status skipped_line (reader *r)
{
    pg_status status = PG_OK;
    const char *s = now (r)->line, *end = now (r)->end;
    long id;
    while (end > s && isspace ((unsigned char) end[-1])) end--;
    if (!r->goes_on && mesh_whole (&s, end, &id))
        PG_TRY (abaqus_set_add (&r->data.skipped, (abaqus_range) { id, id, 1, 0 }));
    r->goes_on = end > s && end[-1] == ',';
done:
    return status;
}

/* The mode, set by the present keyword, decides how the line is read; empty lines are skipped. */
pg_status abaqus_data (reader *r)
{
    abaqus *a = &r->data;
    if (at_end (now (r)->line, now (r)->end)) return PG_OK;
    switch (r->mode) {
    case ABAQUS_NODE_LINES:        return node_line (r);
    case ABAQUS_ELEMENT_LINES:     return element_line (r);
    case ABAQUS_SKIPPED_ELEMENTS:  return skipped_line (r);
    case ABAQUS_NODE_SET:
        return r->generate ? generate_line (r, &a->nset.set[r->set]) : set_line (r, &a->nset, "node");
    case ABAQUS_ELEMENT_SET:
        return r->generate ? generate_line (r, &a->elset.set[r->set]) : set_line (r, &a->elset, "element");
    case ABAQUS_NODE_SURFACE: return set_line (r, &a->nset, "node");
    case ABAQUS_SURFACE:      return surface_line (r);
    case ABAQUS_INSTANCE:     return instance_line (r);
    default:           return PG_OK;
    }
}
