/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal compare: what its command line asks for, and what came of it. */
#ifndef PERIGAL_CLI_COMPARE_H
#define PERIGAL_CLI_COMPARE_H
#include "perigal.h"

typedef struct {
    const char *folder, *reference, *field, *out;      /* reference NULL: the scene's own */
    int    step, other_step, threads, json, quiet;
    double unit, shift[3], scale;
    int    column;                                     /* of the picture: 0..8, PG_COMPARE_U, PG_COMPARE_S */
} compare_request;
typedef struct {
    pg_stored *own, *other;                            /* other: a result to compare with */
    pg_sampler fem;  /* borrowed view of a finite element reference; sample NULL: none */
    pg_sampler reference;                              /* no bits: tables only */
    pg_line    line;                                   /* of the command line */
    pg_reference *scene;                               /* the scene's own */
    pg_errors  errors;
    char       note[600];
} comparison;
/* compare_read.c: opens both sides and measures. */
pg_status compare_sides (comparison *c, const compare_request *q);
void      compare_clear (comparison *c);
/* compare_files.c: compare.csv, compare.json, the picture; their names on stdout unless quiet or json. */
pg_status compare_files (const comparison *c, const compare_request *q);
#endif
