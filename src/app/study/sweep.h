/* SPDX-License-Identifier: GPL-3.0-or-later
 * The parts of a sweep: keys with their values, the runs, the columns of the table. */
#ifndef PG_STUDY_SWEEP_H
#define PG_STUDY_SWEEP_H
#include "series.h"

enum { SWEEP_WORD = 512, SWEEP_HEAD = 192 };
/* A key of the scene that takes several values. */
typedef struct {
    /* The key, "materials.rock.youngs_modulus"; its label, "youngs_modulus", unless another key of the sweep
     * ends alike. */
    char   key[256], label[256];
    size_t n;
    /* The values as written, "2 mm", and "key=value" for the command line (n each). */
    char  (*word)[SWEEP_WORD], (*setting)[SWEEP_WORD + 256];
    /* 1: all values are numbers with one unit; the numbers as written (n); the unit, "" if there is none, or
     * it is 1. */
    int     numeric;
    double *number;
    char    unit[64];
    /* 1: seeds, which are drawn as a scatter. */
    int     seeds;
} sweep_key;

enum { SWEEP_LAST, SWEEP_FIRST, SWEEP_LEAST, SWEEP_LARGEST, SWEEP_AT_PEAK };
/* A column of numbers: from report.json (block and key), or from history.csv (column, and which of its
 * values). */
typedef struct {
    char        name[128], unit[32];
    const char *block, *key;
    char        column[128];
    int         which;
} sweep_column;

/* A sweep: its keys, its runs (n) with the index of each key's value (n x nkey), their results, and the
 * columns (ncolumn) with their values (n x ncolumn; NAN: not known). */
typedef struct {
    const pg_sweep_request *q;
    size_t            nkey;     sweep_key key[PG_SERIES_SETS];
    size_t            n;        pg_series_run *run;
    size_t           *index;
    pg_series_result *result;
    size_t            ncolumn;  sweep_column *column;
    double           *value;
    /* 1: a run has shown that the columns exist. */
    int               seen;
    /* Warnings in the reports (n); NAN: not known. */
    double           *warnings;
} sweep;

/* Cuts "key=a,b,c" into a key with its values (sweep_keys.c). PG_E_USAGE: it cannot be read so. */
pg_status pg_sweep_key_read  (sweep_key *out, const char *set);
void      pg_sweep_key_clear (sweep_key *key);
/* Chooses the columns that are asked for, or the default ones (sweep_table.c). PG_E_USAGE: there is no such
 * column. */
pg_status pg_sweep_columns   (sweep *s);
/* Reads the results of run k. PG_E_USAGE: the first result that exists lacks a column. */
pg_status pg_sweep_take      (sweep *s, size_t k);
/* Writes the whole sweep.csv again. */
pg_status pg_sweep_write     (const sweep *s);
/* Draws the column c, if there is something to draw: *drawn = 1 (sweep_picture.c). */
pg_status pg_sweep_draw      (int *drawn, const sweep *s, size_t c, const char *path);
#endif
