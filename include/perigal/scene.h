/* SPDX-License-Identifier: GPL-3.0-or-later
 * scene.h: the input file of a run ("scene"). YAML becomes checked names, SI numbers and expressions, each
 * with its position in the file. Independent of methods: every folder provides a table of its keys
 * (`pg_keys_<folder>`), and src/scene/keys/list.h has one line per table. These tables drive parsing, checks,
 * `perigal help KEY` and doc/input.md alike.
 *
 * A scene goes through these steps: libyaml reads the text into a tree (src/scene/yaml.c); overrides `--set
 * KEY=VALUE` change it (override.c); every node is checked against the row of its key (check.c, value.c),
 * where numbers are converted to SI (unit.c, measure.c) and expressions compiled once to find their faults
 * (compile.c). After that values are asked for by their path (access.c), and a default stands in for what is
 * not written. All faults are collected and reported together, each with file, line, column, key and value
 * (fault.c). */
#ifndef PERIGAL_SCENE_H
#define PERIGAL_SCENE_H
#include "perigal/base.h"
#include <stdio.h>

PG_API_BEGIN

/* ---- keys ---------------------------------------------------------------------------------------------- */
/* Kinds of values. */
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

/* Value of pg_key.fallback: the default is the first of the choices, so that the first line of a catalogue is
 * its default entry. */
#define PG_FIRST_CHOICE "(the first choice)"

/* One key of a scene: a row of a key table. */
typedef struct {
    /* Path of the key: "materials.{}.youngs_modulus". */
    const char *path;
    /* Kind of its value. */
    pg_kind     kind;
    /* SI unit in the spelling of udunits ("Pa", "m", "kg/m3", "1"); "m|spacing": multiples of the point
     * spacing are allowed too, resolved by pg_scene_length; NULL where a unit makes no sense. */
    const char *unit;
    /* Allowed values: "[0, 0.5)", "(0, inf)"; NULL: any finite number. */
    const char *range;
    /* Default as the user would write it, or PG_FIRST_CHOICE; "": optional without a default; NULL:
     * required. */
    const char *fallback;
    /* For PG_NAME: "static|newmark". "sets.{}|left|right": also any name of that map of the scene (or a
     * part of it, NAME.top). NULL: choices_of gives them. */
    const char *choices;
    /* For PG_NAME: gives the allowed names of a catalogue, "a|b|c"; NULL: `choices` has them. */
    const char *(*choices_of) (void);
    /* Of the keys of one parent with the same "name:one" exactly one must be given; with "name:most" at
     * most one. */
    const char *group;
    /* One sentence of explanation. */
    const char *doc;
} pg_key;

/* The keys of a source folder. */
typedef struct { const char *folder; const pg_key *key; size_t n; } pg_key_table;

/* Keys of the entries of a catalogue. An entry (a material, a criterion, a solver ...) declares its own
 * keys in its own file; several entries may share a table. The scene knows all of them. A key without a
 * default is required only where an entry that owns it is chosen, and the manual names the entries with
 * each key. A folder with such entries has one line in src/scene/keys/list.h and a `const pg_key_catalogue
 * pg_entry_keys_<folder>`. pg_key_tables is a list of tables that ends with NULL. */
typedef const pg_key_table *const *pg_key_tables;

/* A catalogue whose entries have keys. */
typedef struct {
    /* The key that chooses an entry: "solver.kind". */
    const char *selector;
    /* Name of entry i; NULL past the end. */
    const char *(*name) (size_t i);
    /* Keys of entry i; NULL: none. */
    pg_key_tables (*keys) (size_t i);
    /* Further keys of entry i, which may also stand below the prefix `also`; NULL: none. */
    pg_key_tables (*keys_twice) (size_t i);
    /* Prefix of the second path of these keys, and its name in the manual: "materials.{}.", "for this
     * material". */
    const char *also, *also_doc;
    /* Flags of entry i, defined by the catalogue (pg_scene_entry_is); NULL: none. */
    unsigned (*flags) (size_t i);
} pg_key_catalogue;
/* Returns 1: `name` is one of `names` = "a|b|c". */
int pg_listed (const char *names, const char *name);

/* ---- life cycle ---------------------------------------------------------------------------------------- */
/* A scene: constant once read, but for its list of faults. */
typedef struct pg_scene pg_scene;

/* Reads and checks a file. PG_E_SCENE: pg_last_error has all faults, one per line, such as
 * `plate.yaml:14:5: materials.rock.poissons_ratio = 0.6: must lie in [0, 0.5)`. PG_E_FILE, PG_E_MEMORY. */
pg_status pg_scene_load   (pg_scene **out, const char *path);
/* Reads and checks a file with overrides "key=value" (value is YAML), applied before the checks. */
pg_status pg_scene_load_with (pg_scene **out, const char *path, size_t nset, const char *const *set);
/* Reads a file with overrides so that one pass reports all faults: a scene that is wrong only beside its
 * geometry (materials, failure, blocks, boundary, initial, solver, output, reference) is returned with PG_OK.
 * pg_scene_partial is 1 then, its faults do not stop later checks (pg_scene_pass), and of a problem only the
 * geometry may be built: pg_problem_prepare does that and returns all faults. */
pg_status pg_scene_load_some (pg_scene **out, const char *path, size_t nset, const char *const *set);
int       pg_scene_partial (const pg_scene *s);
/* Reads and checks a scene from a text in memory; `name` stands for the file in messages. */
pg_status pg_scene_parse  (pg_scene **out, const char *text, const char *name);
/* Reads and checks a scene from memory with overrides as in pg_scene_load_with; name: for messages. */
pg_status pg_scene_parse_with (pg_scene **out, const char *text, const char *name, size_t nset,
                               const char *const *set);
/* Reads a scene from memory against the keys by which another one was read. */
pg_status pg_scene_parse_like (pg_scene **out, const pg_scene *like, const char *text, const char *name);
void      pg_scene_free   (pg_scene **scene);

/* ---- use: paths are printf formats, e.g. pg_scene_number (s, "cracks[%zu].width", i) ------------------- */
/* Declares printf-like functions, so that the compiler checks the path (argument k) against the arguments
 * from m on. */
#define PG_PATH(k, m) __attribute__ ((format (printf, k, m)))
/* 1: all of these flags (pg_key_catalogue.flags) are true of the entry that the key `selector` chooses. */
int         pg_scene_entry_is (const pg_scene *s, const char *selector, unsigned flags);
/* Returns 1: the scene gives a value at the path. */
int         pg_scene_given   (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* Line of the value in the file; 0: the file does not give it. */
int         pg_scene_line    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* Returns 1: the value is given, or has a default. */
int         pg_scene_has     (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* Number of elements of a list or of names in a map; 1 for a single value, 0: absent. */
size_t      pg_scene_count   (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* The i-th name in a map or of a list of names; NULL past the end. */
const char *pg_scene_name    (const pg_scene *s, size_t i, const char *path, ...) PG_PATH (3, 4);
/* The value in SI units; 0: absent. */
double      pg_scene_number  (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* A number of unit "m|spacing" in metres, `spacing` (m) being the point spacing. */
double      pg_scene_length  (const pg_scene *s, double spacing, const char *path, ...) PG_PATH (3, 4);
long        pg_scene_integer (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
int         pg_scene_bool    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* The value as text; NULL: absent. */
const char *pg_scene_text    (const pg_scene *s, const char *path, ...) PG_PATH (2, 3);
/* Writes up to `max` numbers in SI units; returns how many. */
int         pg_scene_vector  (const pg_scene *s, int max, double *out, const char *path, ...) PG_PATH (4, 5);
/* Records a fault that a higher folder found at this key; faults are collected, and the scene is otherwise
 * const. */
void        pg_scene_fault   (const pg_scene *s, const char *path, const char *format, ...) PG_PATH (3, 4);
/* PG_OK, or PG_E_SCENE with all faults so far in pg_last_error. */
pg_status   pg_scene_verdict (const pg_scene *s);
/* Lets later checks continue in spite of the errors so far: pg_scene_verdict fails only if there are more,
 * and then reports all. */
void        pg_scene_pass    (const pg_scene *s);
/* As pg_scene_verdict, but fails also for faults that were passed. */
pg_status   pg_scene_conclude (const pg_scene *s);
/* PG_E_USAGE from a folder that knows no keys, its message being the last one, becomes a fault of the scene
 * at this key; any other status is returned as it is. */
pg_status   pg_scene_blame   (const pg_scene *s, const char *key, pg_status status);
/* Path of the scene's file as given; pg_scene_source: the text that was read, without overrides. */
const char *pg_scene_file    (const pg_scene *s);
const char *pg_scene_source  (const pg_scene *s);
/* The tree that the user wrote, overrides applied, as JSON: maps, lists, numbers without a unit as
 * numbers, true and false, all other values as text ("2 mm", "on"). Without defaults. The caller frees
 * *json (pg_free). PG_E_MEMORY. */
pg_status   pg_scene_echo    (char **json, const pg_scene *s);
/* The k-th override "key=value"; NULL past the end. */
const char *pg_scene_setting (const pg_scene *s, size_t k);
/* SHA-256 of text and overrides, 64 hexadecimal digits. */
const char *pg_scene_hash    (const pg_scene *s);
enum { PG_STRAY_PATH = 256 };
/* The k-th key below a map of the scene ("solver", "materials.glass") that is given although it belongs to
 * other entries of a catalogue than the one chosen there. Writes its path and returns the name below the
 * map; NULL: there are no more. */
const char *pg_scene_stray (const pg_scene *s, size_t k, const char *map, char path[PG_STRAY_PATH]);

/* ---- files --------------------------------------------------------------------------------------------- */
/* Path of a file that the scene names: beside the scene unless it is absolute; the caller frees it by
 * pg_free. */
pg_status pg_scene_beside (char **out, const pg_scene *s, const char *name);
/* A file named by a key of kind PG_FILE, with the SHA-256 of its present content (64 hexadecimal digits).
 * pg_scene_files lists them in the order of the scene. PG_E_FILE: one cannot be read. */
typedef struct { char key[128], hash[65]; char *path; } pg_named_file;
pg_status pg_scene_files      (const pg_scene *s, size_t *n, pg_named_file **out);
void      pg_scene_files_free (size_t n, pg_named_file **file);

/* ---- units --------------------------------------------------------------------------------------------- */
/* Reads a number with a unit: "10 GPa" with unit "Pa" gives 1e10; a number without unit is in SI.
 * PG_E_SCENE: the message says what is wrong. */
pg_status pg_unit_parse (double *out, const char *text, const char *unit);

/* ---- columns of tables --------------------------------------------------------------------------------- */
/* Splits the header of a column, "u_x [mm]" or "u_x (mm)", in place into its name and *unit ("" where there
 * is none; borrowed from `header`). PG_E_SCENE: the bracket does not close, or something follows it; the name
 * is separated all the same. */
pg_status pg_column_cut (char *header, const char **unit);
/* Conversion factor of a column's unit ("": 1) to SI units of `kind`: "m", "m3", "Pa", "1" for a plain
 * number. PG_E_SCENE: unknown, or of another kind. */
pg_status pg_column_scale (double *scale, const char *unit, const char *kind);
/* Converts a value of a column to SI units by value * scale: 3 at a scale of 1e-3 is exactly 0.003. */
double    pg_column_value (double value, double scale);

/* ---- expressions --------------------------------------------------------------------------------------- */
/* A compiled expression. Variables: x y z r (m), angle (rad, atan2 (y, x) in [0, 2 pi)), t (s; in a static
 * scene the load factor 0 to 1). Numbers may carry units; + - * / ^, comparisons, and or not, functions
 * (see src/scene/quantity/expression.c), pi. Comparing or adding different units is an error. */
typedef struct pg_expression pg_expression;
/* Values of the variables. */
typedef struct { double x, y, z, r, angle, t; } pg_place;
/* unit: that of the result, "Pa" ..., or "bool" for a condition. PG_E_SCENE: the message names the column. */
pg_status pg_expression_compile (pg_expression **out, const char *text, const char *unit);
/* The value in SI units; 0 or 1 for a condition. Thread-safe. */
double    pg_expression_value   (const pg_expression *e, const pg_place *at);
/* Returns 1: the variable ('t', 'x', ...) occurs in the expression. */
int       pg_expression_uses    (const pg_expression *e, char variable);
void      pg_expression_free    (pg_expression **e);

/* ---- inquiry ------------------------------------------------------------------------------------------- */
/* Key k of a scene, in the order of the folders that own them; NULL: there are no more. */
const pg_key *pg_scene_key (size_t k);
/* Key k of those by which this scene was read; NULL: there are no more. */
const pg_key *pg_scene_known_key (const pg_scene *s, size_t k);
/* Writes the documentation of a key, given by its full path or last word; PG_E_USAGE: unknown, names the
 * nearest. */
pg_status pg_scene_help     (FILE *to, const char *key);
/* Writes doc/input.md. */
pg_status pg_scene_manual   (FILE *to);
/* Writes the keys as a JSON schema (draft 7), for editors. */
pg_status pg_scene_json_schema (FILE *to);
PG_API_END
#endif
