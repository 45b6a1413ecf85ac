/* SPDX-License-Identifier: GPL-3.0-or-later
 * Input files of Abaqus and CalculiX: nodes, elements, sets, surfaces, and files by *INCLUDE; all other
 * keywords are skipped, unless they would generate nodes or elements, which is a fault. Keywords and names
 * are compared without regard to case and surrounding blanks.
 *
 * A file consists of keyword lines, which begin with one asterisk, data lines behind them, and comments,
 * which begin with two. This file reads keyword lines and decides what the data lines behind them mean
 * (abaqus_mode); abaqus_data.c reads these. */
#include "abaqus.h"
#include <ctype.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* Largest number of *INCLUDE lines, a limit because files may include one another without end. */
enum { MOST_INCLUDES = 1000 };
typedef abaqus_reader reader;
/* The innermost open file. */
static const abaqus_file *now (const reader *r) { return &r->file[r->depth]; }

/* The message names the innermost open file and its present line. */
pg_status abaqus_wrong (const reader *r, const char *where, const char *format, ...)
{
    char why[400];
    va_list args;
    va_start (args, format);
    vsnprintf (why, sizeof why, format, args);
    va_end (args);
    return pg_error (PG_E_FILE, where, "%s, line %ld: %s", now (r)->bytes.path, now (r)->c.line, why);
}

/* Reads the next line of a file; 0: its end. */
static int next_line (abaqus_file *f) { return mesh_line (&f->c, &f->line, &f->end); }

/* Does the line hold a keyword or a comment? It then begins at the asterisk, behind blanks. */
static int has_asterisk (abaqus_file *f)
{
    const char *s = f->line;
    while (s < f->end && isspace ((unsigned char) *s)) s++;
    if (s == f->end || *s != '*') return 0;
    f->line = s;
    return 1;
}

static void file_close (abaqus_file *f)
{
    pg_free (f->owned), pg_free (f->path);
    *f = (abaqus_file) { 0 };
}

/* ---- keyword lines ------------------------------------------------------------------------------------- */
/* Names may be in quotes, within which blanks and commas belong to the name. */
void abaqus_trim (char *to, size_t size, const char *s, const char *end)
{
    while (s < end && isspace ((unsigned char) *s)) s++;
    while (end > s && isspace ((unsigned char) end[-1])) end--;
    if (end - s >= 2 && *s == '"' && end[-1] == '"') s++, end--;
    size_t n = (size_t) (end - s) < size ? (size_t) (end - s) : size - 1;
    memcpy (to, s, n);
    to[n] = 0;
}

/* Copies [s, end) in capitals without blanks. */
static void copy_key (char *to, size_t size, const char *s, const char *end)
{
    size_t n = 0;
    for (; s < end && n + 1 < size; s++)
        if (!isspace ((unsigned char) *s)) to[n++] = (char) toupper ((unsigned char) *s);
    to[n] = 0;
}

/* Comment lines begin with two asterisks. */
static int is_comment (const abaqus_file *f)
{
    return f->end - f->line >= 2 && f->line[0] == '*' && f->line[1] == '*';
}

/* Appends KEY or KEY=VALUE; more parameters than there is room for are ignored. */
static void add_parameter (reader *r, const char *s, const char *end)
{
    const char *equal = memchr (s, '=', (size_t) (end - s));
    if (r->nparameter == ABAQUS_PARAMETERS) return;
    abaqus_parameter *p = &r->parameter[r->nparameter];
    copy_key (p->key, sizeof p->key, s, equal ? equal : end);
    p->value[0] = 0;
    if (equal) abaqus_trim (p->value, sizeof p->value, equal + 1, end);
    if (p->key[0]) r->nparameter++;
}

/* Parses a keyword line *KEYWORD, KEY=VALUE, KEY ...; after a comma at its end it goes on in the next
 * line. */
static void read_keyword (reader *r)
{
    abaqus_file *f = &r->file[r->depth];
    const char *s = f->line + 1, *end;
    r->nparameter = 0;
    for (int first = 1; ; first = 0) {
        int quoted = 0, open = 0;
        /* Parameters end at commas that are not in quotes. */
        for (end = s; end < f->end && (quoted || *end != ','); end++) quoted ^= *end == '"';
        if (first) copy_key (r->keyword, sizeof r->keyword, s, end);
        else add_parameter (r, s, end);
        if (end < f->end) {
            s = end + 1;
            for (const char *p = s; p < f->end; p++) if (!isspace ((unsigned char) *p)) open = 1;
            if (open) continue;
            /* Nothing behind the last comma: the next line continues, after comments. */
            do if (!next_line (f)) return; while (is_comment (f));
            s = f->line;
        }
        else return;
    }
}

/* Value of a parameter, "" where it has none, NULL: it is not given. */
static const char *value_of (const reader *r, const char *key)
{
    for (int k = 0; k < r->nparameter; k++)
        if (strcmp (r->parameter[k].key, key) == 0) return r->parameter[k].value;
    return NULL;
}

/* The name that parameter `key` (or `fallback`) gives; it must be there. */
static pg_status name_of (const reader *r, const char *key, const char *fallback, char name[ABAQUS_NAME])
{
    const char *value = value_of (r, key);
    if (!value && fallback) value = value_of (r, fallback);
    if (!value || !*value) return ABAQUS_WRONG (r, "*%s without %s=NAME", r->keyword, key);
    snprintf (name, ABAQUS_NAME, "%.63s", value);
    return PG_OK;
}

/* *NODE; only rectangular coordinates are read. */
static pg_status begin_nodes (reader *r)
{
    pg_status status = PG_OK;
    const char *set = value_of (r, "NSET"), *system = value_of (r, "SYSTEM");
    char name[ABAQUS_NAME];
    if (system && strcasecmp (system, "R") != 0)
        PG_TRY (ABAQUS_WRONG (r,
                              "nodes with SYSTEM=%.20s are not read: write them in rectangular coordinates",
                              system));
    r->set = -1;
    if (set && *set) {
        PG_TRY (name_of (r, "NSET", NULL, name));
        PG_TRY (abaqus_set_get (&r->data.nset, name, &r->set));
    }
    r->mode = ABAQUS_NODE_LINES;
done:
    return status;
}

/* Skips elements of an unknown type but reports them to the builder with their block: the file is refused
 * only if that block is used. */
static pg_status pass_elements (reader *r, const char *type, const char *near, const char *set)
{
    pg_status status = PG_OK;
    char words[400], name[ABAQUS_NAME] = "";
    int axisymmetric = strncasecmp (type, "CAX", 3) == 0 || strncasecmp (type, "SAX", 3) == 0;
    snprintf (words, sizeof words, "%.100s, line %ld: elements of type '%.30s' are not known%s%s%s; known "
              "are C3D4, 6, 8, 10, 15, 20, CPS and CPE 3, 4, 6, 8, S3, 4, 6, 8, M3D3, 4, 6, 8, T3D2, B31, "
              "with letters behind them as in C3D8R", now (r)->bytes.path, now (r)->c.line, type,
              axisymmetric ? " (axisymmetric: there are plane and solid bodies only)"
              : near[0]    ? " (did you mean '" : "", axisymmetric ? "" : near,
              near[0] && !axisymmetric ? "'?)" : "");
    if (set && *set) snprintf (name, sizeof name, "%.63s", set);
    PG_TRY (pg_mesh_builder_foreign (r->data.builder, type, name, words));
done:
    return status;
}

/* *ELEMENT; elements without extent (springs, masses) are passed over with their data lines. */
static pg_status begin_elements (reader *r)
{
    pg_status status = PG_OK;
    const char *type = value_of (r, "TYPE"), *set = value_of (r, "ELSET");
    char near[32], name[ABAQUS_NAME], capitals[32];
    if (!type || !*type) PG_TRY (ABAQUS_WRONG (r, "*ELEMENT without TYPE="));
    copy_key (capitals, sizeof capitals, type, type + strlen (type));
    int found = abaqus_find_type (capitals, &r->type, near);
    r->mode = found == 1 ? ABAQUS_ELEMENT_LINES : ABAQUS_SKIPPED_ELEMENTS;
    r->have = -1;
    r->set = -1, r->goes_on = 0;
    if (!found) PG_TRY (pass_elements (r, type, near, set));
    if (found == 2) PG_TRY (pg_mesh_builder_pass (r->data.builder, "elements %.30s", type));
    /* the set of skipped elements must exist, as other sets and sections may name it */
    if (found != 1 && set && *set) PG_TRY (abaqus_set_get (&r->data.elset, set, &r->set));
    if (found != 1) goto done;
    if (strncmp (capitals, "CPE", 3) == 0) pg_mesh_builder_plane_strain (r->data.builder, capitals);
    abaqus_node_order (r->type.kind, r->order);
    if (set && *set) {
        PG_TRY (name_of (r, "ELSET", NULL, name));
        PG_TRY (abaqus_set_get (&r->data.elset, name, &r->set));
        r->data.elset.set[r->set].named = 1;
    }
done:
    return status;
}

/* *NSET or *ELSET. */
static pg_status begin_set (reader *r, int nodes)
{
    pg_status status = PG_OK;
    char name[ABAQUS_NAME];
    const char *of = value_of (r, "ELSET");
    PG_TRY (name_of (r, nodes ? "NSET" : "ELSET", NULL, name));
    PG_TRY (abaqus_set_get (nodes ? &r->data.nset : &r->data.elset, name, &r->set));
    r->mode = nodes ? ABAQUS_NODE_SET : ABAQUS_ELEMENT_SET;
    r->generate = value_of (r, "GENERATE") != NULL;
    /* *NSET, ELSET=NAME: the nodes of an element set. */
    if (nodes && of) {
        int other = abaqus_set_find (&r->data.elset, of);
        if (other < 0) PG_TRY (ABAQUS_WRONG (r, "there is no element set '%.63s' before this line", of));
        PG_TRY (
            abaqus_set_add (&r->data.nset.set[r->set], (abaqus_range){ other, other, ABAQUS_NODES_OF, 0 }));
    }
done:
    return status;
}

/* *SURFACE of elements or nodes; combinations of surfaces are skipped. */
static pg_status begin_surface (reader *r)
{
    pg_status status = PG_OK;
    const char *type = value_of (r, "TYPE");
    char name[ABAQUS_NAME];
    r->mode = ABAQUS_SKIP;
    if (value_of (r, "COMBINE")
        || (type && strcasecmp (type, "ELEMENT") != 0 && strcasecmp (type, "NODE") != 0))
        goto done;
    PG_TRY (name_of (r, "NAME", NULL, name));
    /* A surface of nodes is a node set. */
    if (type && strcasecmp (type, "NODE") == 0) {
        PG_TRY (abaqus_set_get (&r->data.nset, name, &r->set));
        r->mode = ABAQUS_NODE_SURFACE;
        goto done;
    }
    abaqus *a = &r->data;
    PG_GROW (a->surface, a->surface_capacity, a->nsurface + 1);
    memset (&a->surface[a->nsurface], 0, sizeof *a->surface);
    snprintf (a->surface[a->nsurface].name, ABAQUS_NAME, "%s", name);
    r->surface = (int) a->nsurface++;
    r->mode = ABAQUS_SURFACE;
done:
    return status;
}

/* *SOLID SECTION and the like: their element set becomes a block for elements that have no other set. */
static pg_status begin_section (reader *r)
{
    pg_status status = PG_OK;
    const char *of = value_of (r, "ELSET");
    int set = of ? abaqus_set_find (&r->data.elset, of) : -1;
    r->mode = ABAQUS_SKIP;
    if (set < 0) goto done;
    PG_GROW (r->data.section, r->data.section_capacity, r->data.nsection + 1);
    r->data.section[r->data.nsection++] = set;
done:
    return status;
}

/* *INCLUDE: opens a file named relative to the one that includes it. */
static pg_status begin_include (reader *r, const char *name)
{
    pg_status status = PG_OK;
    char *path = NULL;
    const char *slash = strrchr (now (r)->bytes.path, '/');
    if (!name || !*name) PG_TRY (ABAQUS_WRONG (r, "*%s without INPUT=FILE", r->keyword));
    if (r->depth + 1 == ABAQUS_DEEPEST || r->data.included == MOST_INCLUDES)
        PG_TRY (ABAQUS_WRONG (r, "files include one another more than %d deep or %d times", ABAQUS_DEEPEST,
                              MOST_INCLUDES));
    /* Relative to the file that names it. */
    size_t folder = slash && *name != '/' ? (size_t) (slash - now (r)->bytes.path) + 1 : 0;
    PG_ALLOC (path, folder + strlen (name) + 1);
    memcpy (path, now (r)->bytes.path, folder);
    memcpy (path + folder, name, strlen (name));
    abaqus_file *f = &r->file[r->depth + 1];
    status = mesh_load (&f->bytes, &f->owned, path);
    /* The fault names both files. */
    if (status == PG_E_FILE) {
        char why[300];
        snprintf (why, sizeof why, "%.299s", pg_last_error ());
        PG_TRY (ABAQUS_WRONG (r, "the file it includes: %s", why));
    }
    if (status != PG_OK) goto done;
    f->path = path, path = NULL;
    f->c = mesh_begin (&f->bytes);
    r->depth++, r->data.included++;
done:
    pg_free (path);
    return status;
}

/* *INSTANCE: only one. */
static pg_status begin_instance (reader *r)
{
    pg_status status = PG_OK;
    const char *name = value_of (r, "NAME");
    r->mode = ABAQUS_INSTANCE;
    if (++r->instances > 1)
        PG_TRY (ABAQUS_WRONG (r, "a second *INSTANCE: an assembly of several bodies is not read; merge them "
                                 "into one part (no bodies in contact)"));
    if (name) snprintf (r->instance, sizeof r->instance, "%s", name);
done:
    return status;
}

/* Keywords that make nodes or elements from others: skipping them would give another mesh. */
static int generates (const char *keyword)
{
    /* Generation and copying of nodes and elements, other coordinate systems, meshes from other files. */
    static const char *const word[] = { "NGEN",  "NFILL",  "NCOPY",  "NMAP",
                                        "ELGEN", "ELCOPY", "SYSTEM", "IMPORT" };
    for (size_t k = 0; k < sizeof word / sizeof *word; k++) if (strcmp (keyword, word[k]) == 0) return 1;
    return 0;
}

/* Called at every keyword and at the end of the file: a fault if the element being read lacks nodes. */
static pg_status finish_element (const reader *r)
{
    if (r->have < 0) return PG_OK;
    return pg_error (PG_E_FILE, PG_HERE, "%s, line %ld: element %ld has %d of %d nodes", now (r)->bytes.path,
                     r->element_line, r->element, r->have, r->type.nodes);
}

/* Functions for the table `keywords`. */
static pg_status begin_nset (reader *r)    { return begin_set (r, 1); }
static pg_status begin_elset (reader *r)   { return begin_set (r, 0); }
static pg_status begin_included (reader *r) { return begin_include (r, value_of (r, "INPUT")); }

/* Only files of one part are read. */
static pg_status begin_part (reader *r)
{
    if (++r->parts <= 1) return PG_OK;
    return ABAQUS_WRONG (r, "a second *PART: only files of one part are read; merge the parts into one");
}

/* The keywords that say something about the mesh (blanks left out); all others are passed over. */
static const struct { const char *keyword; pg_status (*begin) (reader *r); } keywords[] = {
    { "NODE", begin_nodes }, { "ELEMENT", begin_elements }, { "NSET", begin_nset }, { "ELSET", begin_elset },
    { "SURFACE", begin_surface }, { "INCLUDE", begin_included }, { "INSTANCE", begin_instance },
    { "SOLIDSECTION", begin_section }, { "SHELLSECTION", begin_section },
    { "MEMBRANESECTION", begin_section }, { "PART", begin_part },
};

/* Reads a line *KEYWORD, PARAMETER=VALUE... and sets what the data lines mean until the next keyword. */
static pg_status begin (reader *r)
{
    enum { KEYWORDS = sizeof keywords / sizeof *keywords };
    pg_status status = finish_element (r);
    size_t k = 0;
    if (status != PG_OK) return status;
    read_keyword (r);
    r->mode = ABAQUS_SKIP;
    while (k < KEYWORDS && strcmp (r->keyword, keywords[k].keyword) != 0) k++;
    if (k < KEYWORDS) status = keywords[k].begin (r);
    else if (!generates (r->keyword)) status = pg_mesh_builder_pass (r->data.builder, "*%s", r->keyword);
    else
        status = ABAQUS_WRONG (r, "*%s is not read: write out all nodes and elements (most programs do so on "
                                  "export)", r->keyword);
    /* the data lines may stand in a file of their own */
    if (status == PG_OK && r->mode != ABAQUS_SKIP && strcmp (r->keyword, "INCLUDE") != 0
        && value_of (r, "INPUT"))
        status = begin_included (r);
    return status;
}

/* ---- the file ------------------------------------------------------------------------------------------ */
/* Reads the lines of all files, those of included files where *INCLUDE names them. */
static pg_status read_all (reader *r)
{
    pg_status status = PG_OK;
    for (;;) {
        abaqus_file *f = &r->file[r->depth];
        if (!next_line (f)) {
            if (r->depth == 0) break;
            file_close (f);
            r->depth--;
        }
        else if (has_asterisk (f)) {
            if (!is_comment (f)) PG_TRY (begin (r));
        }
        else if (r->mode != ABAQUS_SKIP) PG_TRY (abaqus_data (r));
    }
    PG_TRY (finish_element (r));
    const pg_mesh_given given = pg_mesh_builder_given (r->data.builder);
    if (given.n == 0 && given.nforeign == 0)
        PG_FAIL (PG_E_FILE, "%s: no *ELEMENT: there is no mesh in this file", r->file[0].bytes.path);
done:
    return status;
}

/* Closes all files that are open. */
static void reader_free (reader *r)
{
    abaqus *a = &r->data;
    for (int k = 1; k < ABAQUS_DEEPEST; k++) file_close (&r->file[k]);
    for (size_t k = 0; k < a->nsurface; k++) pg_free (a->surface[k].face);
    abaqus_sets_free (&a->nset), abaqus_sets_free (&a->elset), pg_free (a->skipped.range);
    pg_free (a->surface), pg_free (a->section), pg_free (a->shell);
    pg_free (r);
}

/* Names and numbers are resolved only after the last line. */
static pg_status read_abaqus (pg_mesh_builder *m, const mesh_file *file)
{
    pg_status status = PG_OK;
    reader *r = NULL;
    PG_ALLOC (r, 1);
    r->file[0].bytes = *file;
    r->file[0].c = mesh_begin (file);
    r->data.path = file->path;
    r->data.builder = m;
    r->have = -1;
    PG_TRY (read_all (r));
    PG_TRY (abaqus_resolve (&r->data));
done:
    if (r) reader_free (r);
    return status;
}

/* 1 if the first line that is not empty, a comment or a lone asterisk begins with * and a letter. */
static int knows_abaqus (const mesh_file *file)
{
    mesh_cursor c = mesh_begin (file);
    const char *s, *end;
    while (mesh_line (&c, &s, &end)) {
        while (s < end && isspace ((unsigned char) *s)) s++;
        while (s < end && isspace ((unsigned char) end[-1])) end--;
        if (s == end || (*s == '*' && (end - s == 1 || s[1] == '*'))) continue;
        return *s == '*' && end - s > 3 && isalpha ((unsigned char) s[1 + (s[1] == ' ')]);
    }
    return 0;
}

const mesh_format mesh_format_abaqus = { "Abaqus or CalculiX .inp", knows_abaqus, read_abaqus, NULL };
