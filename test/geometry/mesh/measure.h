/* SPDX-License-Identifier: GPL-3.0-or-later
 * measure.h: volume and surface of meshes; a block of any kind of element, mapped to any shape. */
#ifndef TEST_MESH_MEASURE_H
#define TEST_MESH_MEASURE_H
#include "perigal/mesh.h"

/* Coordinates (dim of the mesh) of `n` nodes of element e: node[k], or all in order (NULL). */
static inline void element_places (const pg_mesh *m, size_t e, int n, const int *node, double *x)
{
    for (int k = 0; k < n; k++)
        for (int a = 0; a < m->dim; a++)
            x[k * m->dim + a] = m->x[3 * m->node[m->start[e] + (size_t) (node ? node[k] : k)] + a];
}

static inline double mesh_volume (const pg_mesh *m)
{
    double sum = 0, x[81], xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS];
    for (size_t e = 0; e < m->n; e++) {
        int n = pg_element_rule (m->kind[e], 4, xi, w);
        element_places (m, e, pg_element_types[m->kind[e]].nodes, NULL, x);
        for (int q = 0; q < n; q++)
            sum += w[q] * pg_element_map (m->kind[e], m->dim, x, xi + q * m->dim, NULL, NULL);
    }
    return sum;
}

/* Area of n sides, and (1 / dim) integral of x.n: the volume inside where they are closed. */
static inline double sides_area (const pg_mesh *m, size_t n, const int *element, const int *side,
                                 double *inside)
{
    double area = 0, x[27], xi[3 * PG_ELEMENT_POINTS], w[PG_ELEMENT_POINTS], place[3], normal[3];
    *inside = 0;
    for (size_t k = 0; k < n; k++) {
        int node[9];
        pg_element face = pg_element_face (m->kind[element[k]], side[k], node);
        element_places (m, (size_t) element[k], pg_element_types[face].nodes, node, x);
        int points = pg_element_rule (face, 4, xi, w);
        for (int q = 0; q < points; q++) {
            double dA = w[q] * pg_element_map (face, m->dim, x, xi + q * (m->dim - 1), place, normal);
            area += dA;
            for (int a = 0; a < m->dim; a++) *inside += dA * place[a] * normal[a] / m->dim;
        }
    }
    return area;
}

static inline double surface_area (const pg_mesh *m, double *inside)
{
    size_t n;
    int *element, *side;
    check_ok (pg_mesh_surface (m, &n, &element, &side));
    double area = sides_area (m, n, element, side, inside);
    pg_free (element), pg_free (side);
    return area;
}

/* Corners (of the cell's; 8: its middle) of the k-th element of `kind` in a cell; 0: there are no more. */
static inline const int *cell_part (pg_element kind, int k)
{
    static const int whole[8] = { 0, 1, 2, 3, 4, 5, 6, 7 }, tri[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } },
                     wedge[2][6] = { { 0, 1, 2, 4, 5, 6 }, { 0, 2, 3, 4, 6, 7 } };
    static const int tet[6][4] = { { 0, 1, 2, 6 }, { 0, 2, 3, 6 }, { 0, 3, 7, 6 },
                                   { 0, 7, 4, 6 }, { 0, 4, 5, 6 }, { 0, 5, 1, 6 } };
    static const int pyramid[6][5] = { { 0, 1, 2, 3, 8 }, { 4, 7, 6, 5, 8 }, { 0, 4, 5, 1, 8 },
                                       { 1, 5, 6, 2, 8 }, { 2, 6, 7, 3, 8 }, { 0, 3, 7, 4, 8 } };
    int corners = pg_element_types[kind].corners, dim = pg_element_types[kind].dim;
    if (corners == 5) return k < 6 ? pyramid[k] : NULL;
    if (corners == 3) return k < 2 ? tri[k] : NULL;
    if (corners == 6) return k < 2 ? wedge[k] : NULL;
    if (corners == 4 && dim == 3) return k < 6 ? tet[k] : NULL;
    return k < 1 ? whole : NULL;
}

/* The cube (square, line) [-1, 1]^d in n^d cells cut into elements, every node moved by `map`. */
static inline pg_mesh block_mesh (pg_element kind, int n, void (*map) (double *x))
{
    static const double corner[9][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },   { 0, 0, 1 },
                                         { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 }, { .5, .5, .5 } };
    static const pg_element linear[9] = { [2] = PG_BAR2, [3] = PG_TRI3, [5] = PG_PYRAMID5,
                                        [6] = PG_WEDGE6, [8] = PG_HEX8 };
    int dim = pg_element_types[kind].dim, corners = pg_element_types[kind].corners, width = 2 * n + 1,
        cells = 1, id = 1;
    pg_element parent = corners == 4 ? (dim == 2 ? PG_QUAD4 : PG_TET4) : linear[corners];
    pg_mesh_builder *m = NULL;
    pg_mesh mesh;
    check_ok (pg_mesh_builder_create (&m, "block"));
    for (int k = 0; k < (dim > 1 ? width : 1) * (dim > 2 ? width : 1) * width; k++) {
        double x[3] = { (double) (k % width) / n - 1, dim > 1 ? (double) (k / width % width) / n - 1 : 0,
                        dim > 2 ? (double) (k / width / width) / n - 1 : 0 };
        if (map) map (x);
        check_ok (pg_mesh_builder_node (m, k, x));
    }
    for (int a = 0; a < dim; a++) cells *= n;
    for (int c = 0; c < cells; c++)
        for (int part = 0; cell_part (kind, part); part++) {
            const int *list = cell_part (kind, part), low[3] = { c % n, c / n % n, c / n / n };
            long node[27];
            for (int k = 0; k < pg_element_types[kind].nodes; k++) {
                double xi[3] = { 0 }, N[8], at[3] = { 0 };
                pg_element_node (kind, k, xi);
                pg_element_shape (parent, xi, N, NULL);
                for (int i = 0; i < corners; i++)
                    for (int a = 0; a < dim; a++) at[a] += 2 * N[i] * (low[a] + corner[list[i]][a]);
                node[k] = lround (at[0]) + width * (lround (at[1]) + width * lround (at[2]));
            }
            check_ok (pg_mesh_builder_element (m, id++, kind, node, 0, 0));
        }
    check_ok (pg_mesh_builder_finish (m, &mesh));
    pg_mesh_builder_free (&m);
    return mesh;
}
#endif
