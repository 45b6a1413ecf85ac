/* SPDX-License-Identifier: GPL-3.0-or-later
 * Search for the element that holds a position: a binary tree of boxes over the elements, divided at the
 * median of the centres along the longest axis, so that the depth is log2 n however graded the mesh is. Of
 * several elements that hold a position (on a face between them) the one with the lowest number is taken, so
 * that the answer does not depend on the shape of the tree. */
#include "closest.h"
#include "locator.h"
#include "element.h"
#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>

/* Largest number of elements in a leaf; size of the stack of a search. */
enum { LEAF = 4, DEPTH = 64 };
/* A position this far outside the reference element (xi) still counts as inside: rounding must leave no gaps
 * between neighbours. */
static const double inside = 1e-9;
/* A box along the axes. */
typedef struct { double low[3], high[3]; } box;
/* A leaf has the n items from `first` on. An inner node has n = 0; its left child is the next node, its
 * right child has the number `right`. */
typedef struct { box box; int first, n, right; } tree_node;

/* The tree. */
struct pg_mesh_locator {
    /* The mesh; borrowed. */
    const pg_mesh *mesh;
    int        dim;
    /* Nodes of the tree in depth-first order; the root is the first. */
    tree_node *tree;
    size_t     ntree;
    /* Elements in the order of the leaves (mesh->n). */
    int       *item;
    /* Box of each item. */
    box       *box;
    /* Centres of the boxes, only while building (n x dim). */
    double    *centre;
    /* Size of the largest element, in the unit of the mesh. */
    double     largest;
};

/* Copies the nodes of element e (nodes x dim); returns its kind. */
static pg_element nodes_of (const pg_mesh_locator *f, size_t e, double x[3 * PG_ELEMENT_NODES])
{
    const pg_mesh *m = f->mesh;
    int dim = f->dim, k = 0;
    for (size_t j = m->start[e]; j < m->start[e + 1]; j++)
        for (int a = 0; a < dim; a++) x[k++] = m->x[3 * (size_t) m->node[j] + (size_t) a];
    return (pg_element) m->kind[e];
}

/* ---- boxes --------------------------------------------------------------------------------------------- */
/* Box of element e, and its size (longest edge of the box of its corners). Corners bound linear elements.
 * Other nodes move the map by their distance d from the linear map; the sum of |N| of these nodes is below
 * 3 in every element of the table (hex20: (1 - x^2) + (1 - y^2) + (1 - z^2)), so that 3 d to each side
 * bounds a curved element. */
static box box_of (const pg_mesh_locator *f, size_t e, double *size)
{
    static const pg_element linear[PG_ELEMENTS] = { PG_POINT1, PG_BAR2,  PG_BAR2,  PG_TRI3,   PG_TRI3,
                                                    PG_QUAD4,  PG_QUAD4, PG_QUAD4, PG_TET4,   PG_TET4,
                                                    PG_HEX8,   PG_HEX8,  PG_HEX8,  PG_WEDGE6, PG_WEDGE6,
                                                    PG_PYRAMID5 };
    double x[3 * PG_ELEMENT_NODES], xi[3], N[PG_ELEMENT_NODES], off[3] = { 0 };
    pg_element kind = nodes_of (f, e, x);
    int dim = f->dim, corners = pg_element_types[kind].corners;
    box b = { { 0 }, { 0 } };
    for (int a = 0; a < dim; a++) {
        b.low[a] = b.high[a] = x[a];
        for (int i = 1; i < corners; i++)
            b.low[a] = fmin (b.low[a], x[i * dim + a]), b.high[a] = fmax (b.high[a], x[i * dim + a]);
    }
    /* How far the other nodes lie off the linear map of the corners. */
    for (int k = corners; k < pg_element_types[kind].nodes; k++) {
        pg_element_node (kind, k, xi);
        pg_element_shape (linear[kind], xi, N, NULL);
        for (int a = 0; a < dim; a++) {
            double d = x[k * dim + a];
            for (int i = 0; i < corners; i++) d -= N[i] * x[i * dim + a];
            off[a] = fmax (off[a], fabs (d));
        }
    }
    *size = 0;
    for (int a = 0; a < dim; a++) *size = fmax (*size, b.high[a] - b.low[a]);
    for (int a = 0; a < dim; a++) {
        /* The bound of curved elements, the tolerance of `inside`, and rounding far from the origin. */
        double grow = 3 * off[a] + 10 * inside * *size
                      + 4 * DBL_EPSILON * fmax (fabs (b.low[a]), fabs (b.high[a]));
        b.low[a] -= grow, b.high[a] += grow;
    }
    return b;
}

/* Enlarges a so that it holds b. */
static void unite (box *a, const box *b, int dim)
{
    for (int k = 0; k < dim; k++)
        a->low[k] = fmin (a->low[k], b->low[k]), a->high[k] = fmax (a->high[k], b->high[k]);
}

/* Does the box hold the position? */
static int holds (const box *b, const double *place, int dim)
{
    for (int a = 0; a < dim; a++) if (!(place[a] >= b->low[a] && place[a] <= b->high[a])) return 0;
    return 1;
}

/* Distance of the position from the box; 0 inside. */
static double distance (const box *b, const double *place, int dim)
{
    double square = 0;
    for (int a = 0; a < dim; a++) {
        double d = fmax (fmax (b->low[a] - place[a], place[a] - b->high[a]), 0);
        square += d * d;
    }
    return sqrt (square);
}

/* ---- tree ---------------------------------------------------------------------------------------------- */
/* Order of two elements along an axis; equal centres by number, so that the tree is unique. */
static int before (const pg_mesh_locator *f, int p, int q, int axis)
{
    double a = f->centre[(size_t) p * (size_t) f->dim + (size_t) axis],
           b = f->centre[(size_t) q * (size_t) f->dim + (size_t) axis];
    return a < b || (a == b && p < q);
}

/* Moves the k smallest of the n items from `first` on to the front (Hoare's selection). */
static void halve (pg_mesh_locator *f, int first, int n, int k, int axis)
{
    int *v = f->item + first, low = 0, high = n - 1;
    while (low < high) {
        /* Items before the pivot go to the left, those behind it to the right; only the part with index k is
         * continued. */
        int pivot = v[low + (high - low) / 2], i = low, j = high;
        while (i <= j) {
            while (before (f, v[i], pivot, axis)) i++;
            while (before (f, pivot, v[j], axis)) j--;
            if (i <= j) { int t = v[i]; v[i++] = v[j]; v[j--] = t; }
        }
        if (k <= j) high = j;
        else if (k >= i) low = i;
        else return;
    }
}

/* The axis along which the centres of these items extend farthest. */
static int longest_axis (const pg_mesh_locator *f, int first, int n)
{
    int best = 0;
    double length = -1;
    for (int a = 0; a < f->dim; a++) {
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (int k = 0; k < n; k++) {
            double c = f->centre[(size_t) f->item[first + k] * (size_t) f->dim + (size_t) a];
            low = fmin (low, c), high = fmax (high, c);
        }
        if (high - low > length) length = high - low, best = a;
    }
    return best;
}

/* Builds the subtree of n items, nodes in the order: a node, its left half, its right half. boxes: by
 * elements. Returns the number of its root. */
static int build (pg_mesh_locator *f, const box *boxes, int first, int n)
{
    int k = (int) f->ntree++;
    if (n > LEAF) {
        halve (f, first, n, n / 2, longest_axis (f, first, n));
        int left = build (f, boxes, first, n / 2), right = build (f, boxes, first + n / 2, n - n / 2);
        f->tree[k] = (tree_node) { .box = f->tree[left].box, .right = right };
        unite (&f->tree[k].box, &f->tree[right].box, f->dim);
        return k;
    }
    f->tree[k] = (tree_node) { .first = first, .n = n, .box = boxes[f->item[first]] };
    for (int i = 0; i < n; i++) {
        f->box[first + i] = boxes[f->item[first + i]];
        unite (&f->tree[k].box, &f->box[first + i], f->dim);
    }
    return k;
}

/* A binary tree with leaves of at least two items has fewer nodes than there are items. */
pg_status pg_mesh_locator_create (pg_mesh_locator **out, const pg_mesh *mesh)
{
    pg_status status = PG_OK;
    pg_mesh_locator *f = NULL;
    box *boxes = NULL;
    *out = NULL;
    if (mesh->dim < 1 || mesh->dim > 3 || mesh->n == 0 || mesh->n > INT_MAX)
        PG_FAIL (PG_E_USAGE, "no elements to search in a mesh of %zu elements and dimension %d", mesh->n,
                 mesh->dim);
    PG_ALLOC (f, 1);
    f->mesh = mesh, f->dim = mesh->dim;
    size_t dim = (size_t) mesh->dim;
    PG_ALLOC (boxes, mesh->n);
    PG_ALLOC (f->item, mesh->n);
    PG_ALLOC (f->box, mesh->n);
    PG_ALLOC (f->centre, mesh->n * dim);
    /* As leaves hold at least two items, unless there is only one leaf, mesh->n nodes suffice. */
    PG_ALLOC (f->tree, mesh->n);
    for (size_t e = 0; e < mesh->n; e++) {
        /* Centres decide about the division, boxes about the search. */
        double size;
        boxes[e] = box_of (f, e, &size);
        f->item[e] = (int) e;
        f->largest = fmax (f->largest, size);
        for (size_t a = 0; a < dim; a++) f->centre[e * dim + a] = boxes[e].low[a] / 2 + boxes[e].high[a] / 2;
    }
    build (f, boxes, 0, (int) mesh->n);
    pg_free (f->centre), f->centre = NULL;
    *out = f;
    f = NULL;
done:
    pg_free (boxes);
    pg_mesh_locator_free (&f);
    return status;
}

void pg_mesh_locator_free (pg_mesh_locator **locator)
{
    pg_mesh_locator *f = *locator;
    if (!f) return;
    pg_free (f->tree), pg_free (f->item), pg_free (f->box), pg_free (f->centre);
    pg_free (f);
    *locator = NULL;
}

/* Finds the reference coordinates of p in a triangle or tetrahedron with straight edges, in closed form; 0:
 * it is flat. */
static int invert_simplex (int dim, const double *x, const double *p, double *xi)
{
    double e[3][3], r[3];
    for (int a = 0; a < dim; a++) {
        r[a] = p[a] - x[a];
        for (int k = 0; k < dim; k++) e[k][a] = x[(k + 1) * dim + a] - x[a];
    }
    if (dim == 2) {
        double det = e[0][0] * e[1][1] - e[0][1] * e[1][0];
        xi[0] = (r[0] * e[1][1] - r[1] * e[1][0]) / det, xi[1] = (e[0][0] * r[1] - e[0][1] * r[0]) / det;
        return det != 0;
    }
    /* n[k] is the cross product of the two edges other than k. */
    double n[3][3], det = 0;
    for (int k = 0; k < 3; k++)
        for (int a = 0; a < 3; a++) {
            const double *u = e[(k + 1) % 3], *v = e[(k + 2) % 3];
            n[k][a] = u[(a + 1) % 3] * v[(a + 2) % 3] - u[(a + 2) % 3] * v[(a + 1) % 3];
        }
    for (int a = 0; a < 3; a++) det += e[0][a] * n[0][a];
    for (int k = 0; k < 3; k++) xi[k] = (r[0] * n[k][0] + r[1] * n[k][1] + r[2] * n[k][2]) / det;
    return det != 0;
}

/* Finds the reference coordinates of a position in any element; 0: it has none. */
static int invert (pg_element kind, int dim, const double *x, const double *place, double *xi)
{
    return kind == PG_TRI3 || kind == PG_TET4 ? invert_simplex (dim, x, place, xi)
                                              : pg_element_invert (kind, x, place, xi);
}

/* ---- queries ------------------------------------------------------------------------------------------- */
/* Returns the element with the lowest number that holds the position, -1: none. */
static long find_inside (const pg_mesh_locator *f, const double *place, double *xi)
{
    int todo[DEPTH], n = 0, dim = f->dim;
    long best = LONG_MAX;
    todo[n++] = 0;
    while (n > 0) {
        const tree_node *t = &f->tree[todo[--n]];
        if (!holds (&t->box, place, dim)) continue;
        if (t->n == 0) {
            todo[n++] = t->right;
            todo[n++] = (int) (t - f->tree) + 1;
        }
        for (int k = t->first; k < t->first + t->n; k++) {
            double x[3 * PG_ELEMENT_NODES], at[3];
            /* Only an element with a lower number can replace the best. */
            if (f->item[k] >= best || !holds (&f->box[k], place, dim)) continue;
            pg_element kind = nodes_of (f, (size_t) f->item[k], x);
            if (!invert (kind, dim, x, place, at) || pg_element_outside (kind, at) > inside) continue;
            best = f->item[k];
            memcpy (xi, at, (size_t) dim * sizeof *xi);
        }
    }
    return best == LONG_MAX ? -1 : best;
}

/* Elements whose map cannot be inverted at this position are ignored. */
double pg_mesh_locator_depth (const pg_mesh_locator *f, const double *place, double enough)
{
    int todo[DEPTH], n = 0, dim = f->dim;
    double depth = -HUGE_VAL;
    todo[n++] = 0;
    while (n > 0 && depth < enough) {
        const tree_node *t = &f->tree[todo[--n]];
        if (!holds (&t->box, place, dim)) continue;
        if (t->n == 0) {
            todo[n++] = t->right;
            todo[n++] = (int) (t - f->tree) + 1;
        }
        for (int k = t->first; k < t->first + t->n && depth < enough; k++) {
            double x[3 * PG_ELEMENT_NODES], at[3];
            if (!holds (&f->box[k], place, dim)) continue;
            pg_element kind = nodes_of (f, (size_t) f->item[k], x);
            if (invert (kind, dim, x, place, at)) depth = fmax (depth, -pg_element_outside (kind, at));
        }
    }
    return depth;
}

/* The nearest element so far, at distance d; away: d in units of the element's size. far: 1: elements farther
 * away than their own size count too. */
typedef struct { long element; double d, away, xi[3]; int far; } nearest;

/* Compares item k with the nearest so far. Distances that agree to nine digits are equal, and the element
 * with the lower number wins. */
static void consider (const pg_mesh_locator *f, const double *place, int k, nearest *best)
{
    double x[3 * PG_ELEMENT_NODES], xi[3], size;
    size_t e = (size_t) f->item[k];
    pg_element kind = nodes_of (f, e, x);
    double d = closest_in_element (kind, f->dim, x, place, xi);
    box_of (f, e, &size);
    /* The element is farther away than its own size, or than the best so far. */
    if ((d > size && !best->far) || d > best->d * (1 + 1e-9)) return;
    if (best->element >= 0 && d >= best->d * (1 - 1e-9) && (long) e > best->element) return;
    best->element = (long) e, best->d = d, best->away = d / size;
    memcpy (best->xi, xi, (size_t) f->dim * sizeof *xi);
}

/* Searches the tree, nearer child first; boxes farther away than the nearest element are skipped. */
static void find_nearest (const pg_mesh_locator *f, const double *place, nearest *best)
{
    int todo[DEPTH], n = 0;
    todo[n++] = 0;
    while (n > 0) {
        const tree_node *t = &f->tree[todo[--n]];
        if (!(distance (&t->box, place, f->dim) <= best->d * (1 + 1e-9))) continue;
        if (t->n == 0) {
            int left = (int) (t - f->tree) + 1, right = t->right;
            /* The nearer child is pushed last, so that it is visited first. */
            int near_left = distance (&f->tree[left].box, place, f->dim)
                            <= distance (&f->tree[right].box, place, f->dim);
            todo[n++] = near_left ? right : left;
            todo[n++] = near_left ? left : right;
        }
        for (int k = t->first; k < t->first + t->n; k++)
            if (distance (&f->box[k], place, f->dim) <= best->d * (1 + 1e-9)) consider (f, place, k, best);
    }
}

long locator_nearest (const pg_mesh_locator *f, const double *place, double reach, double *d)
{
    nearest best = { .element = -1, .d = reach, .far = 1 };
    find_nearest (f, place, &best);
    *d = best.element < 0 ? HUGE_VAL : best.d;
    return best.element;
}

/* Tests the elements whose boxes hold the position; the nearest is searched for only where none holds it. */
long pg_mesh_locator_find (const pg_mesh_locator *f, const double *place, double *xi, double *away)
{
    for (int a = 0; a < f->dim; a++) if (!isfinite (place[a])) return -1;
    long e = find_inside (f, place, xi);
    if (e >= 0 || !away) {
        if (away) *away = 0;
        return e;
    }
    nearest best = { .element = -1, .d = f->largest };
    find_nearest (f, place, &best);
    if (best.element >= 0) memcpy (xi, best.xi, (size_t) f->dim * sizeof *xi), *away = best.away;
    return best.element;
}
