/* SPDX-License-Identifier: GPL-3.0-or-later
 * Tables of the finite elements: nodes on the reference element, faces, edges, shape functions. Nodes and
 * sides are in the order of Exodus II, which fixes all tables here.
 *
 * Shape functions are those of Lagrange (products of polynomials, or barycentric in simplices) and of the
 * serendipity family (quad8, hex20, wedge15); they are 1 at their own node, 0 at all others, and sum to 1.
 * Those of the pyramid are rational, so that they are linear on its triangles and bilinear on its base
 * (Bedrosian 1992): it stands between hexahedra and tetrahedra without a gap. */
#include "element.h"
#include <math.h>
#include <string.h>

/* The columns: name, dimension, numbers of nodes and corners, order, numbers of faces and edges. */
const pg_element_type pg_element_types[PG_ELEMENTS] = {
    [PG_POINT1]  = { "point1",  0,  1, 1, 1, 0,  0 },
    [PG_BAR2]    = { "bar2",    1,  2, 2, 1, 2,  1 },
    [PG_BAR3]    = { "bar3",    1,  3, 2, 2, 2,  1 },
    [PG_TRI3]    = { "tri3",    2,  3, 3, 1, 3,  3 },
    [PG_TRI6]    = { "tri6",    2,  6, 3, 2, 3,  3 },
    [PG_QUAD4]   = { "quad4",   2,  4, 4, 1, 4,  4 },
    [PG_QUAD8]   = { "quad8",   2,  8, 4, 2, 4,  4 },
    [PG_QUAD9]   = { "quad9",   2,  9, 4, 2, 4,  4 },
    [PG_TET4]    = { "tet4",    3,  4, 4, 1, 4,  6 },
    [PG_TET10]   = { "tet10",   3, 10, 4, 2, 4,  6 },
    [PG_HEX8]    = { "hex8",    3,  8, 8, 1, 6, 12 },
    [PG_HEX20]   = { "hex20",   3, 20, 8, 2, 6, 12 },
    [PG_HEX27]   = { "hex27",   3, 27, 8, 2, 6, 12 },
    [PG_WEDGE6]  = { "wedge6",  3,  6, 6, 1, 5,  9 },
    [PG_WEDGE15] = { "wedge15", 3, 15, 6, 2, 5,  9 },
    [PG_PYRAMID5] = { "pyramid5", 3, 5, 5, 1, 5, 8 },
};

/* Shapes of elements; tables are shared by all orders of a shape. */
typedef enum { POINT, BAR, TRI, QUAD, TET, HEX, WEDGE, PYRAMID, FAMILIES } family;
static const family family_of[PG_ELEMENTS] = {
    [PG_POINT1] = POINT, [PG_BAR2] = BAR,   [PG_BAR3] = BAR,   [PG_TRI3] = TRI,     [PG_TRI6] = TRI,
    [PG_QUAD4] = QUAD,   [PG_QUAD8] = QUAD, [PG_QUAD9] = QUAD, [PG_TET4] = TET,     [PG_TET10] = TET,
    [PG_HEX8] = HEX,     [PG_HEX20] = HEX,  [PG_HEX27] = HEX,  [PG_WEDGE6] = WEDGE, [PG_WEDGE15] = WEDGE,
    [PG_PYRAMID5] = PYRAMID
};

/* ---- faces and edges ----------------------------------------------------------------------------------- */
/* Nodes of each face, for the element of a shape with the most nodes: corners, middles, centre; smaller
 * elements take the first of them. */
static const signed char face_nodes[FAMILIES][6][9] = {
    [BAR] = { { 0 }, { 1 } },
    [TRI] = { { 0, 1, 3 }, { 1, 2, 4 }, { 2, 0, 5 } },
    [QUAD] = { { 0, 1, 4 }, { 1, 2, 5 }, { 2, 3, 6 }, { 3, 0, 7 } },
    [TET] = { { 0, 1, 3, 4, 8, 7 }, { 1, 2, 3, 5, 9, 8 }, { 0, 3, 2, 7, 9, 6 }, { 0, 2, 1, 6, 5, 4 } },
    [HEX] = { { 0, 1, 5, 4, 8, 13, 16, 12, 25 },
              { 1, 2, 6, 5, 9, 14, 17, 13, 24 },
              { 2, 3, 7, 6, 10, 15, 18, 14, 26 },
              { 0, 4, 7, 3, 12, 19, 15, 11, 23 },
              { 0, 3, 2, 1, 11, 10, 9, 8, 21 },
              { 4, 5, 6, 7, 16, 17, 18, 19, 22 } },
    [WEDGE] = { { 0, 1, 4, 3, 6, 10, 12, 9 },
                { 1, 2, 5, 4, 7, 11, 13, 10 },
                { 0, 3, 5, 2, 9, 14, 11, 8 },
                { 0, 2, 1, 8, 7, 6 },
                { 3, 4, 5, 12, 13, 14 } },
    [PYRAMID] = { { 0, 1, 4 }, { 1, 2, 4 }, { 2, 3, 4 }, { 0, 4, 3 }, { 0, 3, 2, 1 } },
};

/* The two corners of each edge. */
static const signed char edge_nodes[FAMILIES][12][2] = {
    [BAR] = { { 0, 1 } },
    [TRI] = { { 0, 1 }, { 1, 2 }, { 2, 0 } },
    [QUAD] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 } },
    [TET] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 3 }, { 2, 3 } },
    [HEX] = { { 0, 1 },
              { 1, 2 },
              { 2, 3 },
              { 3, 0 },
              { 0, 4 },
              { 1, 5 },
              { 2, 6 },
              { 3, 7 },
              { 4, 5 },
              { 5, 6 },
              { 6, 7 },
              { 7, 4 } },
    [WEDGE] = { { 0, 1 }, { 1, 2 }, { 2, 0 }, { 0, 3 }, { 1, 4 }, { 2, 5 }, { 3, 4 }, { 4, 5 }, { 5, 3 } },
    [PYRAMID] = { { 0, 1 }, { 1, 2 }, { 2, 3 }, { 3, 0 }, { 0, 4 }, { 1, 4 }, { 2, 4 }, { 3, 4 } },
};

/* Kind of face f. */
static pg_element face_kind (pg_element kind, int f)
{
    switch (kind) {
    case PG_TRI3: case PG_QUAD4: return PG_BAR2;
    case PG_TRI6: case PG_QUAD8: case PG_QUAD9: return PG_BAR3;
    case PG_TET4: return PG_TRI3;
    case PG_TET10: return PG_TRI6;
    case PG_HEX8: return PG_QUAD4;
    case PG_HEX20: return PG_QUAD8;
    case PG_HEX27: return PG_QUAD9;
    case PG_WEDGE6: return f < 3 ? PG_QUAD4 : PG_TRI3;
    case PG_WEDGE15: return f < 3 ? PG_QUAD8 : PG_TRI6;
    case PG_PYRAMID5: return f < 4 ? PG_TRI3 : PG_QUAD4;
    default: return PG_POINT1;
    }
}

/* The nodes of face f are listed in the order of the face's own element. */
pg_element pg_element_face (pg_element kind, int f, int node[9])
{
    pg_element face = face_kind (kind, f);
    const signed char *list = face_nodes[family_of[kind]][f];
    for (int k = 0; k < pg_element_types[face].nodes; k++) node[k] = list[k];
    return face;
}

int element_face_corners (pg_element kind, int f, int node[4])
{
    int n = pg_element_types[face_kind (kind, f)].corners;
    for (int k = 0; k < n; k++) node[k] = face_nodes[family_of[kind]][f][k];
    return n;
}

void pg_element_edge (pg_element kind, int e, int node[2])
{
    node[0] = edge_nodes[family_of[kind]][e][0];
    node[1] = edge_nodes[family_of[kind]][e][1];
}

/* Bars turn round; triangles, quadrilaterals, tetrahedra and pyramids exchange two corners; hexahedra and
 * wedges exchange bottom and top. */
const signed char *element_mirror (pg_element kind)
{
    static const signed char turn[FAMILIES][PG_ELEMENT_NODES] = {
        [BAR] = { 1, 0, 2 },
        [TRI] = { 0, 2, 1, 5, 4, 3 },
        [QUAD] = { 0, 3, 2, 1, 7, 6, 5, 4, 8 },
        [TET] = { 0, 2, 1, 3, 6, 5, 4, 7, 9, 8 },
        [HEX] = { 4,  5,  6, 7, 0,  1,  2,  3,  16, 17, 18, 19, 12, 13,
                  14, 15, 8, 9, 10, 11, 20, 22, 21, 23, 24, 25, 26 },
        [WEDGE] = { 3, 4, 5, 0, 1, 2, 12, 13, 14, 9, 10, 11, 6, 7, 8 },
        [PYRAMID] = { 0, 3, 2, 1, 4 }
    };
    return turn[family_of[kind]];
}

/* ---- the reference element ----------------------------------------------------------------------------- */
/* Reference coordinates of the nodes of hexahedra, quadrilaterals and bars. */
static const signed char brick[27][3] = {
    { -1, -1, -1 }, { 1, -1, -1 }, { 1, 1, -1 }, { -1, 1, -1 }, { -1, -1, 1 }, { 1, -1, 1 },  { 1, 1, 1 },
    { -1, 1, 1 },   { 0, -1, -1 }, { 1, 0, -1 }, { 0, 1, -1 },  { -1, 0, -1 }, { -1, -1, 0 }, { 1, -1, 0 },
    { 1, 1, 0 },    { -1, 1, 0 },  { 0, -1, 1 }, { 1, 0, 1 },   { 0, 1, 1 },   { -1, 0, 1 },  { 0, 0, 0 },
    { 0, 0, -1 },   { 0, 0, 1 },   { -1, 0, 0 }, { 1, 0, 0 },   { 0, -1, 0 },  { 0, 1, 0 }
};
static const signed char square[9][3] = { { -1, -1 }, { 1, -1 }, { 1, 1 },  { -1, 1 }, { 0, -1 },
                                          { 1, 0 },   { 0, 1 },  { -1, 0 }, { 0, 0 } };
static const signed char rod[3][3] = { { -1 }, { 1 }, { 0 } };

/* Reference coordinates of a node of a hexahedron, quadrilateral or bar; of a pyramid those in its base. */
static const signed char *signs (pg_element kind, int node)
{
    family f = family_of[kind];
    if (f == PYRAMID) return square[node];
    return f == HEX ? brick[node] : f == QUAD ? square[node] : rod[node];
}

/* Nodes of simplices and wedges beyond the corners lie in the middle of an edge. */
void pg_element_node (pg_element kind, int node, double *xi)
{
    static const double corner[6][3] = { { 0, 0, -1 }, { 1, 0, -1 }, { 0, 1, -1 },
                                         { 0, 0, 1 },  { 1, 0, 1 },  { 0, 1, 1 } };
    static const double tet[4][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    family f = family_of[kind];
    const double (*x)[3] = f == WEDGE ? corner : tet;
    int dim = pg_element_types[kind].dim, corners = pg_element_types[kind].corners, end[2] = { node, node };
    if (f == PYRAMID) {
        for (int a = 0; a < 2; a++) xi[a] = node < 4 ? square[node][a] : 0;
        xi[2] = node == 4;
        return;
    }
    if (f != TRI && f != TET && f != WEDGE) {
        for (int a = 0; a < dim; a++) xi[a] = signs (kind, node)[a];
        return;
    }
    if (node >= corners) pg_element_edge (kind, node - corners, end);
    for (int a = 0; a < dim; a++) xi[a] = (x[end[0]][a] + x[end[1]][a]) / 2;
}

/* ---- shape functions ----------------------------------------------------------------------------------- */
/* A factor of a product of Lagrange polynomials in one coordinate t, and its slope: linear with nodes -1
 * and 1, or quadratic with nodes -1, 0 and 1; s: the node. */
static double factor (int order, int s, double t, double *slope)
{
    if (order == 1) {
        *slope = s / 2.0;
        return (1 + s * t) / 2;
    }
    *slope = s ? t + s / 2.0 : -2 * t;
    return s ? t * (t + s) / 2 : (1 - t) * (1 + t);
}

/* Bars, quadrilaterals and hexahedra with all nodes of a product: products of Lagrange polynomials. */
static void shape_product (pg_element kind, const double *xi, double *N, double *dN)
{
    const pg_element_type *type = &pg_element_types[kind];
    for (int i = 0; i < type->nodes; i++) {
        double value[3], slope[3], all = 1;
        for (int a = 0; a < type->dim; a++) {
            value[a] = factor (type->order, signs (kind, i)[a], xi[a], &slope[a]);
            all *= value[a];
        }
        N[i] = all;
        for (int a = 0; dN && a < type->dim; a++) {
            double D = slope[a];
            for (int b = 0; b < type->dim; b++) if (b != a) D *= value[b];
            dN[i * type->dim + a] = D;
        }
    }
}

/* Quadrilaterals and hexahedra without nodes inside faces: corners prod (1 + s t) (sum s t - dim + 1) /
 * 2^dim, middles of edges (1 - t^2) prod (1 + s t) / 2^(dim - 1). */
static void shape_serendipity (pg_element kind, const double *xi, double *N, double *dN)
{
    const pg_element_type *type = &pg_element_types[kind];
    int dim = type->dim;
    for (int i = 0; i < type->nodes; i++) {
        const signed char *s = signs (kind, i);
        int middle = i >= type->corners;
        double value[3], slope[3], sum = 1 - dim, all = 1;
        for (int a = 0; a < dim; a++) {
            value[a] = s[a] ? (1 + s[a] * xi[a]) / 2 : (1 - xi[a]) * (1 + xi[a]);
            slope[a] = s[a] ? s[a] / 2.0 : -2 * xi[a];
            all *= value[a], sum += s[a] * xi[a];
        }
        N[i] = middle ? all : all * sum;
        for (int a = 0; dN && a < dim; a++) {
            double D = slope[a];
            for (int b = 0; b < dim; b++) if (b != a) D *= value[b];
            dN[i * dim + a] = middle ? D : D * sum + all * s[a];
        }
    }
}

/* Triangles and tetrahedra in barycentric coordinates L: corners L, or L (2 L - 1); middles 4 L_a L_b. */
static void shape_simplex (pg_element kind, const double *xi, double *N, double *dN)
{
    const pg_element_type *type = &pg_element_types[kind];
    int dim = type->dim, quadratic = type->order == 2;
    double L[4] = { 1 };
    for (int a = 0; a < dim; a++) L[0] -= xi[a], L[a + 1] = xi[a];
    for (int i = 0; i < type->nodes; i++) {
        int end[2] = { i, i };
        if (i >= type->corners) pg_element_edge (kind, i - type->corners, end);
        int p = end[0], q = end[1];
        N[i] = p != q ? 4 * L[p] * L[q] : quadratic ? L[p] * (2 * L[p] - 1) : L[p];
        for (int a = 0; dN && a < dim; a++) {
            double Dp = p ? a == p - 1 : -1, Dq = q ? a == q - 1 : -1;
            dN[i * dim + a] = p != q ? 4 * (Dp * L[q] + L[p] * Dq) : quadratic ? Dp * (4 * L[p] - 1) : Dp;
        }
    }
}

/* Wedges: a triangle (corners p, q) times a line; s: end of the line, 0: half-way. Corners of wedge15: L (1 +
 * s t) (2 L - 2 + s t) / 2. */
static void shape_wedge (pg_element kind, const double *xi, double *N, double *dN)
{
    const pg_element_type *type = &pg_element_types[kind];
    static const double slope[3][2] = { { -1, -1 }, { 1, 0 }, { 0, 1 } };
    double L[3] = { 1 - xi[0] - xi[1], xi[0], xi[1] }, t = xi[2];
    for (int i = 0; i < type->nodes; i++) {
        int end[2] = { i, i };
        if (i >= 6) pg_element_edge (kind, i - 6, end);
        /* Corners 0 to 2 below, 3 to 5 above; an edge between both is upright. */
        int p = end[0] % 3, q = end[1] % 3, s = end[0] / 3 != end[1] / 3 ? 0 : end[0] < 3 ? -1 : 1;
        /* f: N; df: its derivatives with respect to L_p, L_q and t */
        double side = (1 + s * t) / 2, bubble = (1 - t) * (1 + t), f, df[3] = { 0 };
        if (type->order == 1) f = L[p] * side, df[0] = side, df[2] = L[p] * s / 2;
        else if (s == 0) f = L[p] * bubble, df[0] = bubble, df[2] = -2 * t * L[p];
        else if (p != q)
            f = 4 * L[p] * L[q] * side, df[0] = 4 * L[q] * side, df[1] = 4 * L[p] * side,
            df[2] = 2 * s * L[p] * L[q];
        else {
            double g = 2 * L[p] - 2 + s * t;
            f = L[p] * side * g;
            df[0] = side * (g + 2 * L[p]), df[2] = s * L[p] * (g / 2 + side);
        }
        N[i] = f;
        for (int a = 0; dN && a < 2; a++) dN[3 * i + a] = df[0] * slope[p][a] + df[1] * slope[q][a];
        if (dN) dN[3 * i + 2] = df[2];
    }
}

/* Pyramid: N of base corners is (1 - z + s x + t y + s t x y / (1 - z)) / 4, s and t the signs of the corner;
 * N of the apex is z. The quotient has no limit at the apex: 0, its mean over the directions there, is
 * taken. */
static void shape_pyramid (pg_element kind, const double *xi, double *N, double *dN)
{
    double x = xi[0], y = xi[1], z = xi[2], up = 1 - z, over = fabs (up) > 1e-12 ? 1 / up : 0;
    for (int i = 0; i < 4; i++) {
        double s = signs (kind, i)[0], t = signs (kind, i)[1];
        N[i] = (up + s * x + t * y + s * t * x * y * over) / 4;
        if (!dN) continue;
        dN[3 * i] = (s + s * t * y * over) / 4;
        dN[3 * i + 1] = (t + s * t * x * over) / 4;
        dN[3 * i + 2] = (-1 + s * t * x * y * over * over) / 4;
    }
    N[4] = z;
    if (dN) dN[12] = dN[13] = 0, dN[14] = 1;
}

/* Shape functions at xi; elements that are points have N = 1 and leave dN alone. */
void pg_element_shape (pg_element kind, const double *xi, double *N, double *dN)
{
    switch (family_of[kind]) {
    case POINT: N[0] = 1; break;
    case TRI: case TET: shape_simplex (kind, xi, N, dN); break;
    case WEDGE: shape_wedge (kind, xi, N, dN); break;
    case PYRAMID: shape_pyramid (kind, xi, N, dN); break;
    default:
        if (kind == PG_QUAD8 || kind == PG_HEX20) shape_serendipity (kind, xi, N, dN);
        else shape_product (kind, xi, N, dN);
    }
}
