/* SPDX-License-Identifier: GPL-3.0-or-later
 * grid.h: a unit box of elements of any kind as a Gmsh 2.2 file, inner nodes moved by a smooth field; blocks
 * "steel" (x < 1/2) and "foam", surfaces "clamp" (x = 0) and "tip" (x = 1), for tests of what reads and uses
 * meshes. */
#ifndef PERIGAL_TEST_GRID_H
#define PERIGAL_TEST_GRID_H
#include "check.h"
#include "perigal/mesh.h"

typedef struct {
    pg_element kind;
    int    n;                                          /* cubes per axis, even */
    double bend;                                       /* inner nodes are moved by this share of the box */
    double unit;                                       /* edge of the box in units of the file */
    int    single;                                     /* 1: one block "steel", else two */
} grid;

/* Corners of the pieces of a cube (square, line), in half steps of the cube; pyramids meet in its middle. */
static inline int grid_pieces (pg_element kind, int piece, int corner[8][3])
{
    static const int cube[8][3] = { {0,0,0}, {2,0,0}, {2,2,0}, {0,2,0}, {0,0,2}, {2,0,2}, {2,2,2}, {0,2,2} };
    static const int tri[2][3] = { { 0, 1, 2 }, { 0, 2, 3 } },
                     axes[6][3] = { { 0, 1, 2 }, { 1, 2, 0 }, { 2, 0, 1 },
                                    { 0, 2, 1 }, { 2, 1, 0 }, { 1, 0, 2 } };
    static const int base[6][4] = { { 0, 1, 2, 3 }, { 4, 7, 6, 5 }, { 0, 4, 5, 1 },
                                    { 1, 5, 6, 2 }, { 2, 6, 7, 3 }, { 0, 3, 7, 4 } };
    const pg_element_type *t = &pg_element_types[kind];
    if (t->corners == 5) {
        for (int k = 0; piece < 6 && k < 4; k++) memcpy (corner[k], cube[base[piece][k]], sizeof *corner);
        for (int a = 0; a < 3; a++) corner[4][a] = 1;
        return piece < 6;
    }
    int pieces = t->dim == 2 && t->corners == 3   ? 2
                 : t->corners == 6                ? 2
                 : t->dim == 3 && t->corners == 4 ? 6
                                                  : 1;
    if (piece >= pieces) return 0;
    memset (corner, 0, 8 * sizeof *corner);
    if (pieces == 1) memcpy (corner, cube, sizeof cube);
    else if (pieces == 2)
        for (int k = 0; k < t->corners; k++)
            memcpy (corner[k], cube[tri[piece][k % 3] + (k > 2 ? 4 : 0)], sizeof *corner);
    else for (int k = 1; k < 4; k++) {
        memcpy (corner[k], corner[k - 1], sizeof *corner);
        corner[k][axes[piece][k - 1]] = 2;
    }
    if (pieces == 6 && piece > 2) {                    /* odd permutations are left-handed */
        int swap[3];
        memcpy (swap, corner[1], sizeof swap), memcpy (corner[1], corner[2], sizeof swap),
            memcpy (corner[2], swap, sizeof swap);
    }
    return 1;
}

/* Node of the lattice of half steps, from 1. */
static inline long grid_node (const grid *g, const int *at)
{
    return 1 + at[0] + (2L * g->n + 1) * (at[1] + (2L * g->n + 1) * at[2]);
}

/* Nodes of a piece in Exodus order: corners, and middles as the multilinear map of the straight element
 * places them. */
static inline int grid_element (const grid *g, const int *cell, int piece, long *node, double *middle)
{
    const pg_element_type *t = &pg_element_types[g->kind];
    int corner[8][3];
    if (!grid_pieces (g->kind, piece, corner)) return 0;
    pg_element straight = PG_BAR2;
    for (int k = 0; k < PG_ELEMENTS; k++)
        if (pg_element_types[k].order == 1 && pg_element_types[k].dim == t->dim
            && pg_element_types[k].corners == t->corners)
            straight = (pg_element) k;
    *middle = 0;
    for (int i = 0; i < t->nodes; i++) {
        double xi[3], N[PG_ELEMENT_NODES];
        int at[3] = { 0 };
        pg_element_node (g->kind, i, xi);
        pg_element_shape (straight, xi, N, NULL);
        for (int k = 0; k < t->dim; k++) {
            double place = 0;
            for (int c = 0; c < t->corners; c++) place += N[c] * corner[c][k];
            at[k] = 2 * cell[k] + (int) lround (place);
        }
        node[i] = grid_node (g, at), *middle += at[0] / (2.0 * g->n * t->nodes);
    }
    return 1;
}

static inline int gmsh_kind (pg_element kind)
{
    static const int number[PG_ELEMENTS] = {
        [PG_POINT1] = 15, [PG_BAR2] = 1,   [PG_BAR3] = 8,   [PG_TRI3] = 2,   [PG_TRI6] = 9,
        [PG_QUAD4] = 3,   [PG_QUAD8] = 16, [PG_QUAD9] = 10, [PG_TET4] = 4,   [PG_TET10] = 11,
        [PG_HEX8] = 5,    [PG_HEX20] = 17, [PG_HEX27] = 12, [PG_WEDGE6] = 6, [PG_WEDGE15] = 18,
        [PG_PYRAMID5] = 7
    };
    return number[kind];
}

/* Writes nodes in the order of Gmsh. */
static inline void grid_write (FILE *f, pg_element kind, const long *node)
{
    static const signed char tet10[] = { 0, 1, 2, 3, 4, 5, 6, 7, 9, 8 },
                             hex[] = { 0,  1,  2,  3,  4,  5,  6,  7,  8,  11, 13, 9,  10, 12,
                                       14, 15, 16, 18, 19, 17, 26, 20, 25, 22, 23, 21, 24 },
                             wedge15[] = { 0, 1, 2, 3, 4, 5, 6, 9, 7, 8, 10, 11, 12, 14, 13 };
    const signed char *p = kind == PG_TET10                       ? tet10
                           : kind == PG_HEX20 || kind == PG_HEX27 ? hex
                           : kind == PG_WEDGE15                   ? wedge15
                                                                  : NULL;
    long out[PG_ELEMENT_NODES];
    int n = pg_element_types[kind].nodes;
    for (int k = 0; k < n; k++) out[p ? p[k] : k] = node[k];
    for (int k = 0; k < n; k++) fprintf (f, " %ld", out[k]);
    fputc ('\n', f);
}

/* Elements and the faces at x = 0 and 1; f NULL: only counts. */
static inline long grid_elements (const grid *g, FILE *f)
{
    const pg_element_type *t = &pg_element_types[g->kind];
    long count = 0;
    int cell[3];
    for (cell[2] = 0; cell[2] < (t->dim > 2 ? g->n : 1); cell[2]++)
        for (cell[1] = 0; cell[1] < (t->dim > 1 ? g->n : 1); cell[1]++)
            for (cell[0] = 0; cell[0] < g->n; cell[0]++) {
                long node[PG_ELEMENT_NODES], face[9];
                double middle;
                for (int piece = 0; grid_element (g, cell, piece, node, &middle); piece++) {
                    count++;
                    if (f)
                        fprintf (f, "%ld %d 2 %d 1", count, gmsh_kind (g->kind),
                                 g->single || middle < 0.5 ? 1 : 2),
                            grid_write (f, g->kind, node);
                    for (int s = 0; s < t->faces; s++) {
                        int local[9], low = 1, high = 1;
                        pg_element kind = pg_element_face (g->kind, s, local);
                        for (int k = 0; k < pg_element_types[kind].nodes; k++) {
                            long column = (node[local[k]] - 1) % (2 * g->n + 1);
                            face[k] = node[local[k]], low &= column == 0, high &= column == 2 * g->n;
                        }
                        if (!low && !high) continue;
                        count++;
                        if (f)
                            fprintf (f, "%ld %d 2 %d 1", count, gmsh_kind (kind), low ? 3 : 4),
                                grid_write (f, kind, face);
                    }
                }
            }
    return count;
}

static inline void grid_file (const grid *g, const char *path)
{
    int dim = pg_element_types[g->kind].dim, m = 2 * g->n + 1, at[3];
    long nodes = 1;
    FILE *f = fopen (path, "w");
    assert_non_null (f);
    for (int k = 0; k < dim; k++) nodes *= m;
    fprintf (f, "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n%d\n%d 1 \"steel\"\n",
             g->single ? 3 : 4, dim);
    if (!g->single) fprintf (f, "%d 2 \"foam\"\n", dim);
    fprintf (f, "%d 3 \"clamp\"\n%d 4 \"tip\"\n$EndPhysicalNames\n$Nodes\n%ld\n", dim - 1, dim - 1, nodes);
    for (at[2] = 0; at[2] < (dim > 2 ? m : 1); at[2]++)
        for (at[1] = 0; at[1] < (dim > 1 ? m : 1); at[1]++)
            for (at[0] = 0; at[0] < m; at[0]++) {
                double x[3] = { 0 }, bump = g->bend;
                for (int k = 0; k < dim; k++)
                    x[k] = at[k] / (m - 1.0), bump *= 16 * x[k] * x[k] * (1 - x[k]) * (1 - x[k]);
                for (int k = 0; k < dim; k++) x[k] += bump * (k == 0 ? 1 : k == 1 ? -0.7 : 0.5);
                fprintf (f, "%ld %.17g %.17g %.17g\n", grid_node (g, at), g->unit * x[0], g->unit * x[1],
                         g->unit * x[2]);
            }
    fprintf (f, "$EndNodes\n$Elements\n%ld\n", grid_elements (g, NULL));
    grid_elements (g, f);
    fprintf (f, "$EndElements\n");
    fclose (f);
}
#endif
