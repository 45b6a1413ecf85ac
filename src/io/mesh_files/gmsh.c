/* SPDX-License-Identifier: GPL-3.0-or-later
 * What versions 2.2 and 4.1 of Gmsh's format share (Gmsh reference manual, chapter File formats). */
#include "gmsh.h"
#include <string.h>

/* Binary files have no lines. */
const char *gmsh_at (const gmsh_reader *g, char text[40])
{
    if (g->binary) snprintf (text, 40, "byte %zu", (size_t) (g->c.at - g->c.file->text));
    else snprintf (text, 40, "line %ld", g->c.line);
    return text;
}

/* Is the line [first, last), without trailing blanks, this word? */
static int is (const char *first, const char *last, const char *word)
{
    size_t n = strlen (word);
    while (last > first && (last[-1] == ' ' || last[-1] == '\t')) last--;
    return (size_t) (last - first) == n && !memcmp (first, word, n);
}

/* ---- header -------------------------------------------------------------------------------------------- */
/* Finds $MeshFormat within the first lines; comments in a section of their own may stand before it. */
static int find_header (mesh_cursor *c)
{
    const char *first, *last;
    for (int k = 0; k < 100 && mesh_line (c, &first, &last); k++)
        if (is (first, last, "$MeshFormat")) return 1;
        else if (k == 0 && first < last && *first != '$') return 0;
    return 0;
}

/* Is it a Gmsh file with a header? Files of version 1, which are not supported, may have none. */
int gmsh_knows (const mesh_file *file, double *version)
{
    mesh_cursor c = mesh_begin (file);
    const char *first, *last;
    return find_header (&c) && mesh_line (&c, &first, &last) && mesh_real (&first, last, version);
}

/* In binary files a whole number 1 tells the byte order. */
pg_status gmsh_open (gmsh_reader *g, pg_mesh_builder *m, const mesh_file *file)
{
    pg_status status = PG_OK;
    const char *at, *last;
    long binary, size;
    memset (g, 0, sizeof *g);
    g->c = mesh_begin (file), g->m = m;
    find_header (&g->c);
    PG_TRY (gmsh_line (g, "the version", &at, &last));
    if (!mesh_real (&at, last, &g->version) || !mesh_whole (&at, last, &binary)
        || !mesh_whole (&at, last, &size))
        GMSH_FAIL (g, "$MeshFormat needs version, file type and data size");
    /* Size of a floating-point number in bytes. */
    if (size != 8) GMSH_FAIL (g, "the size of numbers is %ld bytes; only 8 is known", size);
    g->binary = binary != 0;
    if (g->binary) {
        PG_TRY (gmsh_has_left (g, "the test of the byte order", 1, 4));
        int one = gmsh_int (g);
        g->swap = one == 1 << 24;
        if (one != 1 && !g->swap) GMSH_FAIL (g, "the number that tells the byte order is %d, not 1", one);
    }
    PG_TRY (gmsh_end (g, "MeshFormat"));
done:
    return status;
}

/* ---- sections ------------------------------------------------------------------------------------------ */
/* Lines outside of sections are passed over. Names are cut at 63 bytes. */
int gmsh_section (gmsh_reader *g, char name[64])
{
    const char *first, *last;
    while (mesh_line (&g->c, &first, &last)) {
        if (first == last || *first != '$') continue;
        while (last > first && (last[-1] == ' ' || last[-1] == '\t')) last--;
        snprintf (name, 64, "%.*s", last - first - 1 < 63 ? (int) (last - first - 1) : 63, first + 1);
        return 1;
    }
    return 0;
}

/* The end of the section is searched for byte by byte in binary files, line by line in text files. */
pg_status gmsh_skip (gmsh_reader *g, const char *name)
{
    pg_status status = PG_OK;
    char end[72];
    const char *first, *last;
    size_t n = (size_t) snprintf (end, sizeof end, "$End%s", name);
    if (g->binary) {
        /* Bytes that happen to look like the end would need the whole word $EndNAME. */
        for (const char *p = g->c.at; (p = memchr (p, '$', (size_t) (g->c.end - p))); p++)
            if ((size_t) (g->c.end - p) >= n && !memcmp (p, end, n)) {
                g->c.at = p + n;
                return PG_OK;
            }
    } else {
        while (mesh_line (&g->c, &first, &last)) if (is (first, last, end)) return PG_OK;
    }
    GMSH_FAIL (g, "the file ends before %s", end);
done:
    return status;
}

/* If another line follows, the message quotes it. */
pg_status gmsh_end (gmsh_reader *g, const char *name)
{
    pg_status status = PG_OK;
    char end[72];
    const char *first, *last;
    snprintf (end, sizeof end, "$End%s", name);
    PG_TRY (gmsh_line (g, end, &first, &last));
    if (!is (first, last, end))
        GMSH_FAIL (g, "expected %s, found '%.*s'", end,
                   last - first < 40 && !g->binary ? (int) (last - first) : 40,
                   g->binary ? "other bytes" : first);
done:
    return status;
}

/* Blanks at the beginning are skipped as well. */
pg_status gmsh_line (gmsh_reader *g, const char *what, const char **at, const char **last)
{
    pg_status status = PG_OK;
    do {
        if (!mesh_line (&g->c, at, last)) GMSH_FAIL (g, "the file ends before %s", what);
        while (*at < *last && (**at == ' ' || **at == '\t')) ++*at;
    } while (*at == *last);
done:
    return status;
}

/* The rest of the line, behind the n numbers, is ignored. */
pg_status gmsh_wholes (gmsh_reader *g, const char *what, int n, long *value)
{
    pg_status status = PG_OK;
    const char *at, *last;
    PG_TRY (gmsh_line (g, what, &at, &last));
    for (int k = 0; k < n; k++)
        if (!mesh_whole (&at, last, &value[k]))
            GMSH_FAIL (g, "%s: number %d of %d is missing or not whole", what, k + 1, n);
done:
    return status;
}

pg_status gmsh_place (gmsh_reader *g, const char **at, const char *last, double x[3])
{
    pg_status status = PG_OK;
    for (int a = 0; a < 3; a++)
        if (!mesh_real (at, last, &x[a]))
            GMSH_FAIL (g, "coordinate %d of a node is missing or no finite number", a + 1);
done:
    return status;
}

/* Each line of the section has dimension, number and "name" of a group. */
pg_status gmsh_names (gmsh_reader *g)
{
    pg_status status = PG_OK;
    long n, dim, group;
    char name[256];
    PG_TRY (gmsh_wholes (g, "the number of names", 1, &n));
    for (long k = 0; k < n; k++) {
        const char *at, *last, *stop;
        PG_TRY (gmsh_line (g, "a name of a group", &at, &last));
        if (!mesh_whole (&at, last, &dim) || !mesh_whole (&at, last, &group) || dim < 0 || dim > 3)
            GMSH_FAIL (g, "name %ld of %ld needs dimension (0 to 3), number and \"name\"", k + 1, n);
        /* The name stands between the first and the last quotation mark of the line. */
        while (at < last && *at != '"') at++;
        for (stop = last; stop > at && stop[-1] != '"'; stop--) continue;
        if (stop - at < 2) GMSH_FAIL (g, "name %ld of %ld is not in quotes", k + 1, n);
        size_t length = (size_t) (stop - at - 2) < sizeof name - 1 ? (size_t) (stop - at - 2)
                                                                   : sizeof name - 1;
        memcpy (name, at + 1, length), name[length] = '\0';
        PG_TRY (pg_mesh_builder_group (g->m, (int) dim, group, name));
    }
    PG_TRY (gmsh_end (g, "PhysicalNames"));
done:
    return status;
}

/* ---- elements ------------------------------------------------------------------------------------------ */
/* Position in Gmsh's list of nodes of node k in the order of Exodus: middle nodes of edges and faces differ
 * in tetrahedra, hexahedra and wedges. */
static const signed char same_order[PG_ELEMENT_NODES] = { 0, 1, 2, 3, 4, 5, 6, 7, 8 };
static const signed char tet_order[10] = { 0, 1, 2, 3, 4, 5, 6, 7, 9, 8 };
static const signed char hex_order[27] = { 0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  10, 12,
                                           14, 15, 16, 18, 19, 17, 26, 20, 25, 22, 23, 21, 24 };
static const signed char wedge_order[15] = { 0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13 };

/* Element types by their numbers in Gmsh's manual; unknown ones, such as pyramids of second order, get known
 * = 0 and are skipped. */
pg_status gmsh_kind (gmsh_reader *g, long type, long element, int dim, long group, gmsh_type *out)
{
    pg_status status = PG_OK;
    static const gmsh_type types[] = {
        [1] = { 1, PG_BAR2, same_order, 0 },     [2] = { 1, PG_TRI3, same_order, 0 },
        [3] = { 1, PG_QUAD4, same_order, 0 },    [4] = { 1, PG_TET4, same_order, 0 },
        [5] = { 1, PG_HEX8, same_order, 0 },     [6] = { 1, PG_WEDGE6, same_order, 0 },
        [7] = { 1, PG_PYRAMID5, same_order, 0 },
        [8] = { 1, PG_BAR3, same_order, 0 },     [9] = { 1, PG_TRI6, same_order, 0 },
        [10] = { 1, PG_QUAD9, same_order, 0 },   [11] = { 1, PG_TET10, tet_order, 0 },
        [12] = { 1, PG_HEX27, hex_order, 0 },    [15] = { 1, PG_POINT1, same_order, 0 },
        [16] = { 1, PG_QUAD8, same_order, 0 },   [17] = { 1, PG_HEX20, hex_order, 0 },
        [18] = { 1, PG_WEDGE15, wedge_order, 0 }
    };
    static const struct { const char *words; int nodes; } other[] = { [13] = { "a wedge of 18 nodes", 18 },
                                                                     [14] = { "a pyramid of 14 nodes", 14 },
                                                                     [19] = { "a pyramid of 13 nodes", 13 } };
    char block[64], at[40], words[400];
    size_t k = (size_t) type;
    if (type > 0 && k < sizeof types / sizeof *types && types[k].known) {
        *out = types[k];
        return PG_OK;
    }
    int named = type > 0 && k < sizeof other / sizeof *other && other[k].words;
    const char *what = named ? other[k].words : "of a kind of its own";
    snprintf (words, sizeof words, "%.100s, %s: element %ld is %s (type %ld of Gmsh), which is not known; "
              "use triangles, quadrilaterals, tetrahedra, hexahedra or wedges of order 1 or 2, pyramids of "
              "order 1",
              g->c.file->path, gmsh_at (g, at), element, what, type);
    *out = (gmsh_type) { .known = 0, .nodes = named ? other[k].nodes : 0 };
    if (g->binary && !out->nodes)                      /* an element of unknown length cannot be skipped */
        PG_FAIL (PG_E_FILE, "%s", words);
    pg_mesh_builder_group_name (g->m, dim, group, block);
    PG_TRY (pg_mesh_builder_foreign (g->m, named ? strchr (what, ' ') + 1 : "of another kind", block, words));
done:
    return status;
}

/* A negative group number only says that the orientation is reversed: the group is its absolute value. */
pg_status gmsh_element (gmsh_reader *g, const gmsh_type *type, long id, const long *node, long group,
                        long line)
{
    long sorted[PG_ELEMENT_NODES];
    for (int k = 0; k < pg_element_types[type->kind].nodes; k++) sorted[k] = node[type->order[k]];
    return pg_mesh_builder_element (g->m, id, type->kind, sorted, group < 0 ? -group : group, line);
}

/* ---- binary numbers ------------------------------------------------------------------------------------ */
/* The test divides, because a product of counts from a file could overflow. */
pg_status gmsh_has_left (gmsh_reader *g, const char *what, size_t n, size_t size)
{
    pg_status status = PG_OK;
    size_t left = (size_t) (g->c.end - g->c.at);
    if (n > left / size)
        GMSH_FAIL (g, "%s: %zu records of %zu bytes do not fit into the %zu bytes that are left", what, n,
                   size, left);
done:
    return status;
}

/* Copies a number of `size` bytes, in the machine's order. */
static void take (gmsh_reader *g, void *value, size_t size)
{
    unsigned char *to = value;
    for (size_t k = 0; k < size; k++) to[g->swap ? size - 1 - k : k] = (unsigned char) g->c.at[k];
    g->c.at += size;
}

int gmsh_int (gmsh_reader *g)
{
    int v;
    take (g, &v, sizeof v);
    return v;
}

_Static_assert (sizeof (long) == 8, "numbers of 8 bytes in files");
long gmsh_long (gmsh_reader *g)
{
    long v;
    take (g, &v, sizeof v);
    return v;
}

double gmsh_double (gmsh_reader *g)
{
    double v;
    take (g, &v, sizeof v);
    return v;
}
