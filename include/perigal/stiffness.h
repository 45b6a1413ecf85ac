/* SPDX-License-Identifier: GPL-3.0-or-later
 * stiffness.h: the global matrix as dense node blocks, gathered row by row from sources (each a list of
 * points and the nodes they couple). A node row collects from all points that contain the node: no races, and
 * redoing some rows is the same routine. */
#ifndef PERIGAL_STIFFNESS_H
#define PERIGAL_STIFFNESS_H
#include "perigal/linalg.h"
#include "perigal/cloud.h"

PG_API_BEGIN

typedef struct {
    const pg_family *family;                           /* points -> nodes, nodes ascending */
    void *context;
    /* Blocks (block x block, row-major) K_ab of point p for local nodes b = 0..m-1, written to out (zero on
     * entry). */
    void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);
} pg_source;

typedef struct pg_stiffness pg_stiffness;
/* Pattern of all sources on n nodes with `block` dofs each; sources are copied, their families borrowed. */
pg_status pg_stiffness_create (pg_stiffness **out, size_t n, int block, size_t nsource,
                               const pg_source *sources);
/* The pattern alone, of the nodes: entry (J, I), J <= I, where a point of some family sees both (values
 * NULL). */
pg_status pg_stiffness_graph  (pg_sparse *out, size_t n, size_t nfamily, const pg_family *const *families);
/* The same of forces straight between points: a node, and the nodes that it sees itself (symmetric; its own
 * number not among them). */
pg_status pg_stiffness_graph_direct (pg_sparse *out, const pg_family *family);
void      pg_stiffness_free   (pg_stiffness **K);
/* Gathers node rows list[0..count) (NULL: all n). */
pg_status pg_stiffness_gather (pg_stiffness *K, size_t count, const int *list, int threads);
/* borrowed; upper triangle; explicit zeros keep the pattern */
pg_sparse *pg_stiffness_matrix (pg_stiffness *K);
PG_API_END
#endif
