/* SPDX-License-Identifier: GPL-3.0-or-later
 * scene.h: what the user wrote. YAML -> checked names, SI numbers, expressions, each with its place in the
 * file. Knows no method: every folder brings a table of its keys (`pg_keys_<folder>`), src/scene/list.h has
 * one line per table; these tables drive parsing, checks, `perigal help KEY` and doc/input.md alike. */
#ifndef PERIGAL_SCENE_H
#define PERIGAL_SCENE_H
#include "perigal/base.h"
#include <stdio.h>

PG_API_BEGIN

/* ---- keys ---------------------------------------------------------------------------------------------- */
typedef enum {
    PG_MAP,  /* a mapping; entries below it as path.name; `path.{}` stands for a name the user chooses */
    PG_LIST,       /* a sequence; one element is path[] */
    PG_NUMBER,     /* number with unit, stored in SI */
    PG_INTEGER,
    PG_BOOL,       /* on/off, true/false, yes/no */
    PG_NAME,       /* one of `choices` */
    PG_TEXT,       /* any string */
    PG_VECTOR,     /* [a, b] or [a, b, c]: as many numbers as the scene has dimensions */
    PG_NUMBERS,    /* any number of numbers */
    PG_NAMES,      /* one name or a list of names (choices NULL: any) */
    PG_FILE,       /* name of a file, beside the scene unless it is absolute */
    PG_EXPRESSION  /* a number with unit, or an expression in x y z r angle t (text, compiled by its user) */
} pg_kind;

typedef struct {
    const char *path;       /* "materials.{}.youngs_modulus" */
    pg_kind     kind;
    /* SI unit in udunits spelling ("Pa", "m", "kg/m3", "1"); "m|spacing": also multiples of the point
     * spacing, resolved by pg_scene_length; NULL where it makes no sense */
    const char *unit;
    const char *range;      /* "[0, 0.5)", "(0, inf)", NULL: any finite number */
    /* default as the user would write it, "" optional without default, NULL required */
    const char *fallback;
    /* "static|newmark", for PG_NAME; "sets.{}|left|right": also any name of that map of the scene (or a part
     * of it, NAME.top); NULL: ask choices_of */
    const char *choices;
    const char *(*choices_of) (void);   /* the same from a catalogue */
    /* keys of one parent sharing "name:one" must appear exactly once; "name:most" at most once */
    const char *group;
    const char *doc;        /* one sentence */
} pg_key;

typedef struct { const char *folder; const pg_key *key; size_t n; } pg_key_table;

/* Keys of the entries of a catalogue. An entry (a material, a criterion, a solver ...) declares its own keys
 * in its own file; several entries may share a table. The scene knows all of them. It requires a key without
 * a default only where an entry that owns it is chosen, and the manual names the entries with each key. A
 * folder with such entries has one line in src/scene/list.h and a `const pg_key_catalogue
 * pg_entry_keys_<folder>`. */
typedef const pg_key_table *const *pg_key_tables;      /* a list of tables that ends with NULL */
typedef struct {
    const char *selector;                              /* the key that chooses an entry: "solver.kind" */
    const char *(*name) (size_t i);                    /* of the i-th entry; NULL past the end */
    pg_key_tables (*keys) (size_t i);                  /* its own keys; NULL: none */
    pg_key_tables (*keys_twice) (size_t i);            /* more of them, known below `also` too; NULL: none */
    const char *also, *also_doc;                       /* "materials.{}.", "for this material" */
} pg_key_catalogue;
/* The entries that own a key, "adr|relax"; NULL: the key is of no entry. *selector (or NULL): what
 * chooses. */
const char *pg_key_entries (const pg_key *key, const char **selector);
/* Is `name` one of "a|b|c"? */
int pg_listed (const char *names, const char *name);

/* ---- life cycle ---------------------------------------------------------------------------------------- */
typedef struct pg_scene pg_scene;

/* Reads and checks a file. On PG_E_SCENE pg_last_error holds all faults, a line each:
 * `plate.yaml:14:5: materials.rock.poissons_ratio = 0.6: must lie in [0, 0.5)`. */
pg_status pg_scene_load   (pg_scene **out, const char *path);
/* The same with overrides "key=value" (value is YAML), applied before the checks. */
pg_status pg_scene_load_with (pg_scene **out, const char *path, size_t nset, const char *const *set);
/* The same, so that one pass tells all faults: a scene that is wrong only beside its geometry (materials,
 * failure, blocks, boundary, initial, solver, output, reference) is given with PG_OK. pg_scene_partial is
 * then 1, its faults are passed by (pg_scene_pass), and of a problem only the geometry may be built:
 * pg_problem_prepare does that and returns all faults. */
pg_status pg_scene_load_some (pg_scene **out, const char *path, size_t nset, const char *const *set);
int       pg_scene_partial (const pg_scene *s);
/* from memory, `name` for messages */
pg_status pg_scene_parse  (pg_scene **out, const char *text, const char *name);
/* The same with overrides as in pg_scene_load_with. */
pg_status pg_scene_parse_with (pg_scene **out, const char *text, const char *name, size_t nset,
                               const char *const *set);
void      pg_scene_free   (pg_scene **scene);

/* ---- use: paths are printf formats, e.g. pg_scene_number (s, "cracks[%zu].width", i) ------------------- */
#define PG_PATH(k, m) __attribute__ ((format (printf, k, m)))
/* the user wrote it */
int         pg_scene_given   (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* where the file says it; 0: it does not */
int         pg_scene_line    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* written or has a default */
int         pg_scene_has     (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* elements of a list, names of a map, 1 for a scalar, 0 absent */
size_t      pg_scene_count   (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* i-th name in a map or PG_NAMES; NULL past the end */
const char *pg_scene_name    (const pg_scene *s, size_t i, const char *path, ...) PG_PATH (3, 4);
/* SI; 0 when absent */
double      pg_scene_number  (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* A number of unit "m|spacing": metres, with `spacing` (m) for one spacing. */
double      pg_scene_length  (const pg_scene *s, double spacing, const char *path, ...) PG_PATH (3, 4);
long        pg_scene_integer (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
int         pg_scene_bool    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* NULL when absent */
const char *pg_scene_text    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* count */
int         pg_scene_vector  (const pg_scene *s, int max, double *out, const char *path, ...) PG_PATH (4, 5);
/* A fault found by a higher folder, placed at the key; collected, not returned. */
void        pg_scene_fault   (const pg_scene *s, const char *path, const char *format, ...) PG_PATH (3, 4);
/* PG_OK, or PG_E_SCENE with all faults so far in pg_last_error. */
pg_status   pg_scene_verdict (const pg_scene *s);
/* The faults so far do not keep later checks from being made: pg_scene_verdict fails only when there are
 * more, with all of them. */
void        pg_scene_pass    (const pg_scene *s);
/* As pg_scene_verdict, of those that were passed by too. */
pg_status   pg_scene_conclude (const pg_scene *s);
const char *pg_scene_file    (const pg_scene *s);            /* path as given */
const char *pg_scene_source  (const pg_scene *s);            /* the text read, overrides not applied */
/* k-th override "key=value"; NULL past the end */
const char *pg_scene_setting (const pg_scene *s, size_t k);
const char *pg_scene_hash    (const pg_scene *s);  /* SHA-256 of text and overrides, 64 hex digits */
/* The k-th key below a map of the scene ("solver", "materials.glass") that is given, though it is of other
 * entries than the one chosen there: its path, from which the name below the map is returned; NULL: there are
 * no more. */
enum { PG_STRAY_PATH = 256 };
const char *pg_scene_stray (const pg_scene *s, size_t k, const char *map, char path[PG_STRAY_PATH]);

/* ---- files --------------------------------------------------------------------------------------------- */
/* Path of a file that the scene names: beside the scene unless it is absolute; pg_free. */
pg_status pg_scene_beside (char **out, const pg_scene *s, const char *name);
/* The files that are named by keys of kind PG_FILE, in the order of the scene, with the SHA-256 of what is in
 * them now (64 hex digits). PG_E_FILE: one cannot be read. */
typedef struct { char key[128], hash[65]; char *path; } pg_named_file;
pg_status pg_scene_files      (const pg_scene *s, size_t *n, pg_named_file **out);
void      pg_scene_files_free (size_t n, pg_named_file **file);

/* ---- units --------------------------------------------------------------------------------------------- */
/* "10 GPa" with unit "Pa" -> 1e10. A bare number is SI. On failure *why (static text or last error) says what
 * is wrong. */
pg_status pg_unit_parse (double *out, const char *text, const char *unit);

/* ---- columns of tables --------------------------------------------------------------------------------- */
/* Cuts the header of a column, "u_x [mm]" or "u_x (mm)", in place into its name and *unit, "" where it names
 * none (borrowed from `header`). PG_E_SCENE: the bracket does not close, or something follows it; the name is
 * cut all the same. */
pg_status pg_column_cut (char *header, const char **unit);
/* The size of that unit ("": 1) in units of `kind`: "m", "m3", "Pa", "1" for a plain number. PG_E_SCENE:
 * unknown, or of another kind. */
pg_status pg_column_scale (double *scale, const char *unit, const char *kind);
/* A value of such a column in SI: 3 at a scale of 1e-3 is exactly 0.003. */
double    pg_column_value (double value, double scale);

/* ---- expressions --------------------------------------------------------------------------------------- */
/* Variables x y z r (m), angle (rad, atan2 (y, x) in [0, 2 pi)), t (s; load factor 0..1 when static); numbers
 * may carry units; + - * / ^, comparisons, and or not, functions sin cos tan sqrt abs min max exp log step
 * hypot atan2, pi. Comparing or adding different units is an error. */
typedef struct pg_expression pg_expression;
typedef struct { double x, y, z, r, angle, t; } pg_place;
/* unit: "Pa" ..., or "bool" for a condition. Errors name the column. */
pg_status pg_expression_compile (pg_expression **out, const char *text, const char *unit);
double    pg_expression_value   (const pg_expression *e, const pg_place *at);
int       pg_expression_uses    (const pg_expression *e, char variable);   /* 't', 'x', ... */
void      pg_expression_free    (pg_expression **e);

/* ---- inquiry ------------------------------------------------------------------------------------------- */
const pg_key_table *pg_scene_tables (size_t *n);
/* full path or last word; PG_E_USAGE names the nearest key */
pg_status pg_scene_help     (FILE *to, const char *key);
pg_status pg_scene_manual   (FILE *to);                      /* doc/input.md */
/* of "a|b|c"; NULL when nothing is near */
const char *pg_nearest_name (const char *word, const char *choices);
PG_API_END
#endif
