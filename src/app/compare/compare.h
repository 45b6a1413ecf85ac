/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to app/compare: contents of the section `reference` of a scene, and functions that several files
 * use. */
#ifndef PG_COMPARE_PRIVATE_H
#define PG_COMPARE_PRIVATE_H
#include "perigal/compare.h"

/* A reference that has been read. */
struct pg_reference {
    /* Dimension of the body; threads for closed forms; Gauss points per direction of the
     * norms. */
    int     dim, threads, order;
    /* Closed forms of the components, and the condition; NULL where not given. */
    pg_expression *u[3], *s[6], *where;
    pg_line *line;  size_t nline;
    /* A finite element result; mesh.sample is NULL if there is none. */
    pg_sampler mesh;
};
/* Reads a whole text file, ended by a zero byte; to be freed with pg_free. PG_E_FILE: cannot
 * be read, or contains zero bytes. */
pg_status pg_compare_load_text (const char *path, char **text);
/* Finds the last row of FOLDER/history.csv whose column `key` is at most `stamp`, and reads
 * load factor, time (s) and number of broken bonds from it. Values that the table lacks stay
 * as they are. */
pg_status pg_compare_history (const char *folder, const char *key, double stamp, double *load_factor,
                           double *time, double *broken);
/* The material index of every quadrature point, that of the nearest evaluation point of the
 * problem (*which: q->n, to be freed with pg_free); stays NULL if there is one material only. */
pg_status pg_compare_materials (const pg_problem *problem, const pg_quadrature *q, int **which);
/* Samplers of displacements at points use this approximation and kernel (a least-squares fit of a linear
 * field), whatever the scene itself uses. */
extern const pg_approx_type pg_approx_rkpm;
extern const pg_kernel pg_kernel_cubic_spline;
#endif
