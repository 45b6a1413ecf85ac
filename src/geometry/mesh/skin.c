/* SPDX-License-Identifier: GPL-3.0-or-later
 * The surface of a mesh as a mesh of faces in a search tree: distance to it, its box, its size. Distances
 * have no sign: whether a position is inside is decided by the elements (locator.c). */
#include "locator.h"
#include <math.h>
#include <string.h>

/* The faces as a mesh whose elements have one dimension less than its space; positions are borrowed. */
struct pg_mesh_skin {
    /* dim is that of the space, the elements have one dimension less; x is borrowed. */
    pg_mesh faces;
    pg_mesh_locator *locator;
    /* Element and side of each face. */
    int *element, *side;
};

/* Copies kinds and nodes of the faces. */
static void fill (pg_mesh *f, const pg_mesh *m, const int *element, const int *side)
{
    int node[9];
    for (size_t k = 0; k < f->n; k++) {
        size_t e = (size_t) element[k];
        pg_element kind = pg_element_face ((pg_element) m->kind[e], side[k], node);
        size_t nodes = (size_t) pg_element_types[kind].nodes;
        f->kind[k] = (unsigned char) kind, f->start[k + 1] = f->start[k] + nodes;
        for (size_t i = 0; i < nodes; i++) f->node[f->start[k] + i] = m->node[m->start[e] + (size_t) node[i]];
    }
}

/* The locator works on elements of any dimension, hence on faces too. */
pg_status pg_skin_create (pg_mesh_skin **out, const pg_mesh *mesh)
{
    pg_status status = PG_OK;
    pg_mesh_skin *s = NULL;
    *out = NULL;
    PG_ALLOC (s, 1);
    pg_mesh *f = &s->faces;
    f->dim = mesh->dim, f->x = mesh->x, f->nnode = mesh->nnode;
    PG_TRY (pg_mesh_surface (mesh, &f->n, &s->element, &s->side));
    PG_ALLOC (f->kind, f->n);
    PG_ALLOC (f->start, f->n + 1);
    PG_ALLOC (f->node, 9 * f->n);
    fill (f, mesh, s->element, s->side);
    PG_TRY (pg_mesh_locator_create (&s->locator, f));
    *out = s;
    s = NULL;
done:
    pg_skin_free (&s);
    return status;
}

void pg_skin_free (pg_mesh_skin **skin)
{
    pg_mesh_skin *s = *skin;
    if (!s) return;
    pg_mesh_locator_free (&s->locator);
    pg_free (s->faces.kind), pg_free (s->faces.start), pg_free (s->faces.node), pg_free (s->element),
        pg_free (s->side);
    pg_free (s);
    *skin = NULL;
}

/* A position with a coordinate that is not finite has the distance HUGE_VAL. */
double pg_skin_distance (const pg_mesh_skin *skin, const double *place, double reach, long *face)
{
    double d = HUGE_VAL;
    long k = -1;
    int real = 1;
    for (int a = 0; a < skin->faces.dim; a++) real &= isfinite (place[a]) != 0;
    if (real) k = locator_nearest (skin->locator, place, reach, &d);
    if (face) *face = k;
    return d;
}

void pg_skin_face (const pg_mesh_skin *skin, size_t face, int *element, int *side)
{
    *element = skin->element[face], *side = skin->side[face];
}

/* Copies the nodes of face k (nodes x dim); returns its kind. */
static pg_element nodes_of (const pg_mesh *f, size_t k, double *x)
{
    size_t dim = (size_t) f->dim, first = f->start[k];
    for (size_t i = first; i < f->start[k + 1]; i++)
        for (size_t a = 0; a < dim; a++) x[(i - first) * dim + a] = f->x[3 * (size_t) f->node[i] + a];
    return (pg_element) f->kind[k];
}

/* Enlarges low and high by a curved face, sampled on a grid of 32 steps: its height misses that of a
 * parabola by (1/32)^2 at most. */
static void widen (const double *x, pg_element kind, int dim, double *low, double *high)
{
    enum { STEPS = 32 };
    int d = pg_element_types[kind].dim, simplex = pg_element_types[kind].corners == 3;
    for (int i = 0; i <= STEPS; i++)
        /* Triangles only below the diagonal. */
        for (int j = 0; j <= (d > 1 ? simplex ? STEPS - i : STEPS : 0); j++) {
            double xi[2] = { (double) i / STEPS, (double) j / STEPS }, place[3];
            if (!simplex) xi[0] = 2 * xi[0] - 1, xi[1] = 2 * xi[1] - 1;
            pg_element_map (kind, dim, x, xi, place, NULL);
            for (int a = 0; a < dim; a++)
                low[a] = fmin (low[a], place[a]), high[a] = fmax (high[a], place[a]);
        }
}

/* Bounding box of the surface. Plane faces end at their nodes, to the last bit; curved ones may extend beyond
 * them. */
void pg_skin_box (const pg_mesh_skin *skin, double *low, double *high)
{
    const pg_mesh *f = &skin->faces;
    double x[27], lowest[3], highest[3], size = 0;
    for (int a = 0; a < f->dim; a++) low[a] = lowest[a] = HUGE_VAL, high[a] = highest[a] = -HUGE_VAL;
    for (size_t k = 0; k < f->n; k++) {
        pg_element kind = nodes_of (f, k, x);
        int nodes = pg_element_types[kind].nodes;
        for (int i = 0; i < nodes * f->dim; i++)
            low[i % f->dim] = fmin (low[i % f->dim], x[i]), high[i % f->dim] = fmax (high[i % f->dim], x[i]);
        if (nodes > pg_element_types[kind].corners) widen (x, kind, f->dim, lowest, highest);
    }
    for (int a = 0; a < f->dim; a++) size = fmax (size, high[a] - low[a]);
    for (int a = 0; a < f->dim; a++) {
        /* A curved face widens the box only where it extends beyond the nodes by more than rounding. */
        if (lowest[a] < low[a] - 1e-9 * size) low[a] = lowest[a];
        if (highest[a] > high[a] + 1e-9 * size) high[a] = highest[a];
    }
}

/* Area (2D: length) of the surface by quadrature of the highest order over all faces. */
double pg_skin_size (const pg_mesh_skin *skin)
{
    const pg_mesh *f = &skin->faces;
    double x[27], xi[2 * PG_ELEMENT_POINTS], weight[PG_ELEMENT_POINTS], size = 0;
    for (size_t k = 0; k < f->n; k++) {
        pg_element kind = nodes_of (f, k, x);
        int n = pg_element_rule (kind, 5, xi, weight);
        for (int q = 0; q < n; q++)
            size += weight[q]
                    * pg_element_map (kind, f->dim, x, xi + q * pg_element_types[kind].dim, NULL, NULL);
    }
    return size;
}
