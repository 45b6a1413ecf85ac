/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what a scene's reference is made of. */
#ifndef PG_COMPARE_PRIVATE_H
#define PG_COMPARE_PRIVATE_H
#include "perigal/compare.h"

struct pg_reference {
    int     dim, threads, order;                       /* order: Gauss points per direction of the norms */
    pg_expression *u[3], *s[6], *where;                /* NULL: not given */
    pg_line *line;  size_t nline;
    pg_sampler mesh;                                   /* sample NULL: none */
};
/* The whole of a text file; to be freed with pg_free. */
pg_status pg_compare_load_text (const char *path, char **text);
/* Values of the last row of FOLDER/history.csv whose column `key` is at most stamp; what it lacks stays as it
 * is. */
pg_status pg_compare_history (const char *folder, const char *key, double stamp, double *load_factor,
                           double *time, double *broken);
/* Material of every place: that of the nearest evaluation point. Stays NULL of one material. */
pg_status pg_compare_materials (const pg_problem *problem, const pg_quadrature *q, int **which);
#endif
