/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points at the nodes of a mesh: lumped volumes, local spacings, random shifts.
 *
 * The sum of the volumes is the volume of the elements. The spacing of a point is the mean length of the
 * edges at its node, but at least 0.6 of the longest one: with a horizon of 1.7 spacings both ends of every
 * edge are neighbours, however graded the mesh is, so that neighbouring points are always coupled. Supports
 * may instead be ellipses that are stretched as the elements at a point are (doc/method.md, Anisotropic
 * supports). */
#include "place.h"
#include "geometry/cloud/body/mesh_body.h"
#include <math.h>
#include <string.h>

/* Largest ratio of the length of a support to its width. */
#define PG_STRETCH_MOST 16.0

/* The element of the same shape that has corners only. */
static pg_element straight (pg_element kind)
{
    const pg_element_type *t = &pg_element_types[kind];
    for (int k = 0; k < PG_ELEMENTS; k++) {
        const pg_element_type *s = &pg_element_types[k];
        if (s->order == 1 && s->dim == t->dim && s->corners == t->corners) return (pg_element) k;
    }
    return kind;
}

/* Do mid-edge nodes carry points? Looks for elements of second order whose last node is a point. */
int pg_mesh_body_halved (const pg_mesh_body *b)
{
    const pg_mesh *m = &b->mesh;
    for (size_t e = 0; e < m->n; e++)
        if (pg_element_types[m->kind[e]].order == 2 && b->point[m->node[m->start[e + 1] - 1]] >= 0) return 1;
    return 0;
}

/* ---- volumes ------------------------------------------------------------------------------------------- */
/* Share of the volume of element e for each node of `shape`, an element on the same reference element with
 * its own N. Row sums where all are clearly positive, else diagonal scaling: in the ratio of the integrals
 * of N^2, which are positive always (Hinton, Rock, Zienkiewicz 1976). */
static void share_of (const pg_mesh *m, size_t e, pg_element shape, double volume, double *share)
{
    double x[3 * PG_ELEMENT_NODES], xi[3 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS], N[PG_ELEMENT_NODES];
    double row[PG_ELEMENT_NODES] = { 0 }, square[PG_ELEMENT_NODES] = { 0 }, rows = 0, squares = 0,
           least = INFINITY;
    pg_element kind = (pg_element) m->kind[e];
    int n = pg_element_rule (kind, PG_MESH_BODY_ORDER, xi, weight), nodes = pg_element_types[shape].nodes;
    pg_mesh_body_nodes (m, e, x);
    for (int q = 0; q < n; q++) {
        double w = weight[q] * pg_element_map (kind, m->dim, x, xi + q * m->dim, NULL, NULL);
        pg_element_shape (shape, xi + q * m->dim, N, NULL);
        for (int i = 0; i < nodes; i++) row[i] += w * N[i], square[i] += w * N[i] * N[i];
    }
    for (int i = 0; i < nodes; i++) rows += row[i], squares += square[i], least = fmin (least, row[i]);
    /* Integrals of N are 0 at the corners of tri6 and negative at those of tet10, quad8, hex20 and
     * wedge15. */
    int scaled = least < 0.01 * volume / nodes;
    for (int i = 0; i < nodes; i++) share[i] = volume * (scaled ? square[i] / squares : row[i] / rows);
}

/* Volumes and blocks; a node between blocks belongs to the first of them. */
static void place_volumes (pg_cloud *c, const pg_mesh_body *b, int corners)
{
    const pg_mesh *m = &b->mesh;
    for (size_t i = 0; i < c->n; i++) c->block[i] = (int) m->nblock;
    for (size_t e = 0; e < m->n; e++) {
        double share[PG_ELEMENT_NODES];
        pg_element shape = corners ? straight ((pg_element) m->kind[e]) : (pg_element) m->kind[e];
        share_of (m, e, shape, b->volume[e] * c->thickness, share);
        for (int i = 0; i < pg_element_types[shape].nodes; i++) {
            size_t p = (size_t) b->point[m->node[m->start[e] + (size_t) i]];
            c->volume[p] += share[i];
            if (m->block[e] < c->block[p]) c->block[p] = m->block[e];
        }
    }
}

/* ---- spacings ------------------------------------------------------------------------------------------ */
/* Lengths of the edges at a point, m. */
typedef struct { double sum, longest; size_t n; } edges;

/* Notes an edge at one of its ends. */
static void add_edge (edges *at, double length)
{
    at->sum += length, at->n++;
    at->longest = fmax (at->longest, length);
}

/* Lengths between neighbouring points: each edge counts at its corners, and all edges of an element at its
 * nodes that are no corners. */
static void collect (edges *at, const pg_mesh_body *b, int corners)
{
    const pg_mesh *m = &b->mesh;
    for (size_t e = 0; e < m->n; e++) {
        const pg_element_type *t = &pg_element_types[m->kind[e]];
        const int *node = m->node + m->start[e];
        for (int k = 0; k < t->edges; k++) {
            int end[2];
            double length = 0;
            pg_element_edge ((pg_element) m->kind[e], k, end);
            for (int a = 0; a < m->dim; a++)
                length += pow (m->x[3 * (size_t) node[end[0]] + (size_t) a]
                                   - m->x[3 * (size_t) node[end[1]] + (size_t) a],
                               2);
            /* Half an edge, where points lie in the middle of edges. */
            length = sqrt (length) * (t->order == 2 && !corners ? 0.5 : 1);
            for (int i = 0; i < 2; i++) add_edge (&at[b->point[node[end[i]]]], length);
            for (int i = t->corners; i < t->nodes && !corners; i++) add_edge (&at[b->point[node[i]]], length);
        }
    }
}

/* Least spacing as a share of the longest edge at a point: a horizon of 1.7 spacings then exceeds that
 * edge. */
static const double edge_reach = 0.6;

/* Local spacings and their mean; local = 0: only the mean is kept. */
static pg_status place_sizes (pg_cloud *c, const pg_mesh_body *b, int corners, int local)
{
    pg_status status = PG_OK;
    edges *at = NULL;
    double sum = 0;
    PG_ALLOC (at, c->n);
    PG_ALLOC (c->size, c->n);
    collect (at, b, corners);
    for (size_t i = 0; i < c->n; i++) {
        c->size[i] = fmax (at[i].sum / (double) at[i].n, edge_reach * at[i].longest);
        sum += c->size[i];
    }
    c->h = sum / (double) c->n;
    for (int k = 0; k < c->dim; k++) c->step[k] = c->h;
done:
    pg_free (at);
    if (!local) pg_free (c->size), c->size = NULL;
    return status;
}

/* ---- anisotropic supports ------------------------------------------------------------------------------ */
/* The vector of edge k of element e, m (dim); half of it where points lie in the middle of edges. end: its
 * two nodes in the element. */
static void edge_of (const pg_mesh *m, size_t e, int k, int corners, int *end, double *edge)
{
    const int *node = m->node + m->start[e];
    double part = pg_element_types[m->kind[e]].order == 2 && !corners ? 0.5 : 1;
    pg_element_edge ((pg_element) m->kind[e], k, end);
    for (int a = 0; a < m->dim; a++)
        edge[a] = part * (m->x[3 * (size_t) node[end[1]] + (size_t) a]
                          - m->x[3 * (size_t) node[end[0]] + (size_t) a]);
}

/* The second moment of the edges d of an element, G = dim / edges * sum d d': l^2 times the unit matrix for
 * squares, cubes, regular triangles and tetrahedra of edge l, and a^2, b^2 along the axes of a rectangle. */
static void shape_of (const pg_mesh *m, size_t e, int corners, double *G)
{
    int dim = m->dim, count = pg_element_types[m->kind[e]].edges, end[2];
    double d[3];
    for (int k = 0; k < dim * dim; k++) G[k] = 0;
    for (int k = 0; k < count; k++) {
        edge_of (m, e, k, corners, end, d);
        for (int a = 0; a < dim; a++)
            for (int l = 0; l < dim; l++) G[a * dim + l] += (double) dim / count * d[a] * d[l];
    }
}

/* The mean of the second moments of the elements at each point (n x dim x dim), m^2. */
static pg_status mean_shapes (const pg_cloud *c, const pg_mesh_body *b, int corners, double *G)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &b->mesh;
    size_t square = (size_t) (m->dim * m->dim);
    double *count = NULL, own[9];
    PG_ALLOC (count, c->n);
    for (size_t e = 0; e < m->n; e++) {
        const pg_element_type *t = &pg_element_types[m->kind[e]];
        shape_of (m, e, corners, own);
        for (int i = 0; i < (corners ? t->corners : t->nodes); i++) {
            size_t p = (size_t) b->point[m->node[m->start[e] + (size_t) i]];
            count[p]++;
            for (size_t k = 0; k < square; k++) G[p * square + k] += own[k];
        }
    }
    for (size_t i = 0; i < c->n; i++)
        for (size_t k = 0; k < square; k++) G[i * square + k] /= count[i];
done:
    pg_free (count);
    return status;
}

/* The metric A = l^2 G^-1 of a support with the largest eigenvalue l^2 of G, and the spacing l (m); G of an
 * element that is flat to rounding counts as PG_STRETCH_MOST times as long as wide. */
static void measure_of (int dim, const double *G, double *A, double *length)
{
    double lambda[3], V[9];
    pg_dense_eigen (dim, G, lambda, V);
    *length = sqrt (lambda[0]);
    for (int a = 0; a < dim; a++)
        for (int l = 0; l < dim; l++) A[a * dim + l] = 0;
    for (int k = 0; k < dim; k++) {
        double thin = fmax (lambda[k], lambda[0] / (PG_STRETCH_MOST * PG_STRETCH_MOST));
        for (int a = 0; a < dim; a++)
            for (int l = 0; l < dim; l++)
                A[a * dim + l] += lambda[0] / thin * V[a * dim + k] * V[l * dim + k];
    }
}

/* Spacings and metrics of supports that are stretched as the elements at a point are: their second moment
 * gives the axes, and the spacing grows until every edge at the point is at most 1 / edge_reach spacings long
 * in its metric, so that with a horizon of 1.7 both of its ends are neighbours. */
static pg_status place_measures (pg_cloud *c, const pg_mesh_body *b, int corners)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &b->mesh;
    size_t square = (size_t) (m->dim * m->dim);
    double *G = NULL, *longest = NULL, sum = 0, edge[3];
    int end[2];
    PG_ALLOC (G, c->n * square);
    PG_ALLOC (longest, c->n);
    PG_ALLOC (c->metric, c->n * square);
    PG_TRY (mean_shapes (c, b, corners, G));
    for (size_t i = 0; i < c->n; i++)
        measure_of (m->dim, G + i * square, c->metric + i * square, &c->size[i]);
    for (size_t e = 0; e < m->n; e++) {
        const pg_element_type *t = &pg_element_types[m->kind[e]];
        for (int k = 0; k < t->edges; k++) {
            edge_of (m, e, k, corners, end, edge);
            for (int i = 0; i < (corners ? t->corners : t->nodes); i++) {
                if (i < t->corners && i != end[0] && i != end[1]) continue;
                size_t p = (size_t) b->point[m->node[m->start[e] + (size_t) i]];
                longest[p] = fmax (longest[p], sqrt (pg_cloud_length2 (c, p, edge)));
            }
        }
    }
    for (size_t i = 0; i < c->n; i++) {
        c->size[i] = fmax (c->size[i], edge_reach * longest[i]);
        sum += c->size[i];
    }
    c->h = sum / (double) c->n;
    for (int k = 0; k < c->dim; k++) c->step[k] = c->h;
done:
    pg_free (G), pg_free (longest);
    return status;
}

/* ---- building the cloud -------------------------------------------------------------------------------- */
/* Moves the points inside the body by random parts of their spacing; the elements stay. */
static pg_status perturb (pg_cloud *c, const pg_mesh_body *b, double amount, uint64_t seed)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &b->mesh;
    unsigned char *outside = NULL;
    int *element = NULL, *side = NULL;
    size_t n = 0, dim = (size_t) c->dim;
    if (!(amount > 0)) return PG_OK;
    PG_ALLOC (outside, c->n);
    PG_TRY (pg_mesh_surface (m, &n, &element, &side));
    /* Points on the surface stay, so that the boundary keeps its shape. */
    for (size_t f = 0; f < n; f++) {
        int node[9],
            count = pg_element_types[pg_element_face ((pg_element) m->kind[element[f]], side[f], node)].nodes;
        for (int k = 0; k < count; k++) {
            int p = b->point[m->node[m->start[element[f]] + (size_t) node[k]]];
            if (p >= 0) outside[p] = 1;
        }
    }
    for (size_t i = 0; i < c->n; i++)
        for (size_t k = 0; k < dim && !outside[i]; k++)
            c->x[i * dim + k] += amount * pg_cloud_ratio (c, i) * c->h * pg_place_shift (seed, i, (int) k);
done:
    pg_free (outside), pg_free (element), pg_free (side);
    return status;
}

/* Which nodes are points, numbered in their order. */
static pg_status number_points (pg_mesh_body *b, int corners, size_t *count)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &b->mesh;
    int n = 0;
    PG_ALLOC (b->point, m->nnode);
    for (size_t e = 0; e < m->n; e++) {
        int nodes = corners ? pg_element_types[m->kind[e]].corners : pg_element_types[m->kind[e]].nodes;
        for (int i = 0; i < nodes; i++) b->point[m->node[m->start[e] + (size_t) i]] = 1;
    }
    for (size_t i = 0; i < m->nnode; i++) b->point[i] = b->point[i] ? n++ : -1;
    *count = (size_t) n;
done:
    return status;
}

/* Volumes use the elements before points are perturbed: the cells stay where they are. */
pg_status pg_mesh_body_cloud (pg_cloud *out, pg_mesh_body *body, const pg_scene *scene)
{
    pg_status status = PG_OK;
    const pg_mesh *m = &body->mesh;
    size_t dim = (size_t) m->dim;
    int corners = !strcmp (pg_scene_text (scene, "mesh.points"), "corners"),
        anisotropic = !strcmp (pg_scene_text (scene, "mesh.support"), "anisotropic"),
        local = anisotropic || !strcmp (pg_scene_text (scene, "mesh.support"), "local");
    memset (out, 0, sizeof *out);
    out->dim = m->dim;
    out->thickness = m->dim == 3 ? 1 : pg_scene_number (scene, m->dim == 2 ? "thickness" : "cross_section");
    PG_TRY (number_points (body, corners, &out->n));
    PG_ALLOC (out->x, out->n * dim);
    PG_ALLOC (out->volume, out->n);
    PG_ALLOC (out->block, out->n);
    /* Meshes store three coordinates, clouds as many as there are dimensions. */
    for (size_t i = 0; i < m->nnode; i++)
        if (body->point[i] >= 0)
            memcpy (out->x + (size_t) body->point[i] * dim, m->x + 3 * i, dim * sizeof *out->x);
    place_volumes (out, body, corners);
    PG_TRY (place_sizes (out, body, corners, local));
    if (anisotropic) PG_TRY (place_measures (out, body, corners));
    PG_TRY (perturb (out, body, pg_scene_number (scene, "perturb.amount"),
                     (uint64_t) pg_scene_integer (scene, "perturb.seed")));
    pg_place_bounds (out);
done:
    if (status != PG_OK) pg_cloud_clear (out);
    return status;
}
