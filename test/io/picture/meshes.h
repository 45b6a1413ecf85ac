/* SPDX-License-Identifier: GPL-3.0-or-later
 * Meshes for the tests of pictures, made from grids of elements that a map puts in place. */
#ifndef PERIGAL_TEST_OUTPUT_MESHES_H
#define PERIGAL_TEST_OUTPUT_MESHES_H
#include "perigal/mesh.h"

typedef void (*mesh_map) (const double *t, double *x);          /* of [0, 1]^3 */

/* Round plate of radius 50 with a hole of radius 15, t = (radius, angle) */
static inline void to_ring (const double *t, double *x)
{
    double r = 15 + 35 * t[0], a = 6.283185307179586 * t[1];
    x[0] = r * cos (a), x[1] = r * sin (a), x[2] = 0;
}

/* Pipe of radii 20 and 30, length 80 along x */
static inline void to_pipe (const double *t, double *x)
{
    double r = 20 + 10 * t[0], a = 6.283185307179586 * t[1];
    x[0] = 80 * t[2], x[1] = r * cos (a), x[2] = r * sin (a);
}

static inline void to_box (const double *t, double *x)
{
    x[0] = 80 * t[0], x[1] = 60 * t[1], x[2] = 40 * t[2];
}

typedef struct {
    mesh_map map;
    int count[3], dim, round;                          /* cells; round: the second direction closes */
    pg_element kind;                                   /* tri6, quad4, hex8 or hex20 */
    int (*keep) (const int *cell);                     /* NULL: all cells */
} mesh_plan;

/* Nodes on a grid of half cells. */
static inline long node_of (const mesh_plan *p, int i, int j, int k)
{
    if (p->round) j %= 2 * p->count[1];
    return 1 + i + (2 * p->count[0] + 1) * (j + (2 * p->count[1] + 1) * (long) k);
}

static inline void add_cell (pg_mesh_builder *m, const mesh_plan *p, const int *c, long group, long *id)
{
    static const int hex[20][3] = { { 0, 0, 0 }, { 2, 0, 0 }, { 2, 2, 0 }, { 0, 2, 0 }, { 0, 0, 2 },
                                    { 2, 0, 2 }, { 2, 2, 2 }, { 0, 2, 2 }, { 1, 0, 0 }, { 2, 1, 0 },
                                    { 1, 2, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 2, 0, 1 }, { 2, 2, 1 },
                                    { 0, 2, 1 }, { 1, 0, 2 }, { 2, 1, 2 }, { 1, 2, 2 }, { 0, 1, 2 } };
    static const int tri[2][6][2] = { { { 0, 0 }, { 2, 0 }, { 2, 2 }, { 1, 0 }, { 2, 1 }, { 1, 1 } },
                                      { { 0, 0 }, { 2, 2 }, { 0, 2 }, { 1, 1 }, { 1, 2 }, { 0, 1 } } };
    long node[20];
    int n = pg_element_types[p->kind].nodes;
    for (int half = 0; half < (p->kind == PG_TRI6 ? 2 : 1); half++) {
        for (int a = 0; a < n; a++)
            node[a] = p->kind == PG_TRI6
                          ? node_of (p, 2 * c[0] + tri[half][a][0], 2 * c[1] + tri[half][a][1], 0)
                          : node_of (p, 2 * c[0] + hex[a][0], 2 * c[1] + hex[a][1], 2 * c[2] + hex[a][2]);
        check_ok (pg_mesh_builder_element (m, ++*id, p->kind, node, group, 0));
    }
}

/* Cells with i below half of count[0] are group 1 "inner", the others 2 "outer"; side set "first": the sides
 * t[0] = 0; node set "start". */
static inline void make_mesh (pg_mesh *out, const mesh_plan *p)
{
    pg_mesh_builder *m = NULL;
    long id = 0;
    check_ok (pg_mesh_builder_create (&m, "made.msh"));
    for (int k = 0; k <= (p->dim == 3 ? 2 * p->count[2] : 0); k++)
        for (int j = 0; j <= 2 * p->count[1]; j++)
            for (int i = 0; i <= 2 * p->count[0]; i++) {
                double t[3] = { 0.5 * i / p->count[0], 0.5 * j / p->count[1],
                                p->dim == 3 ? 0.5 * k / p->count[2] : 0 },
                       x[3];
                p->map (t, x);
                if (!p->round || j < 2 * p->count[1])
                    check_ok (pg_mesh_builder_node (m, node_of (p, i, j, k), x));
            }
    check_ok (pg_mesh_builder_group (m, p->dim, 1, "inner"));
    check_ok (pg_mesh_builder_group (m, p->dim, 2, "outer"));
    for (int k = 0; k < (p->dim == 3 ? p->count[2] : 1); k++)
        for (int j = 0; j < p->count[1]; j++)
            for (int i = 0; i < p->count[0]; i++)
                if (!p->keep || p->keep ((int[]){ i, j, k }))
                    add_cell (m, p, (int[]){ i, j, k }, 2 * i < p->count[0] ? 1 : 2, &id);
    check_ok (pg_mesh_builder_sideset (m, "first", 7));
    for (long e = 0, c = 0; e < id; c++, e += p->kind == PG_TRI6 ? 2 : 1)
        if (!p->keep && c % p->count[0] == 0)
            check_ok (pg_mesh_builder_sideset_add (m, e + (p->kind == PG_TRI6 ? 2 : 1),
                                                   p->kind == PG_TRI6 ? 2 : 3));
    check_ok (pg_mesh_builder_nodeset (m, "start", 9));
    check_ok (pg_mesh_builder_nodeset_add (m, 1));
    check_ok (pg_mesh_builder_finish (m, out));
    pg_mesh_builder_free (&m);
}

static inline double *over_nodes (const pg_mesh *m, double (*f) (const double *x))
{
    double *v = pg_calloc (m->nnode, sizeof *v);
    for (size_t i = 0; i < m->nnode; i++) v[i] = f (m->x + 3 * i);
    return v;
}
#endif
