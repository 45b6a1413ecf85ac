/* SPDX-License-Identifier: GPL-3.0-or-later
 * Chooses the finite elements of the preconditioner and their nodes: whole cells where their points have
 * intact bonds to all corners, boxes between points at the centres of the cells, else elements around
 * evaluation points. */
#include "galerkin_elements.h"
#include <math.h>
#include <string.h>

/* Radius within which nodes form an element around an evaluation point (near_by) or a supported facet point
 * (near_facet), in spacings; it grows in steps of `wider` until there are enough nodes. */
static const double near_by = 1.45, near_facet = 1.2, wider = 0.3;

/* Kinds of boxes by dimension, and the order of their corners. */
static const pg_element box_kind[4] = { PG_POINT1, PG_BAR2, PG_QUAD4, PG_HEX8 };
static const unsigned char box_corner[8][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 },
                                                { 0, 0, 1 }, { 1, 0, 1 }, { 1, 1, 1 }, { 0, 1, 1 } };

/* ---- nodes of an element ------------------------------------------------------------------------------- */
/* Entry of node j in the family of point p; SIZE_MAX: it is not there. */
static size_t entry_of (const pg_rows *r, size_t p, int j)
{
    size_t low = r->family.start[p], high = r->family.start[p + 1];
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (r->family.node[middle] < j) low = middle + 1;
        else high = middle;
    }
    return low < r->family.start[p + 1] && r->family.node[low] == j ? low : SIZE_MAX;
}

/* Is entry e of point p a broken bond? Bonds without influence at or beyond the edge of the node's support
 * are not broken. */
int elements_broken (const galerkin *g, const pg_rows *r, size_t p, size_t e)
{
    int j = r->family.node[e];
    const pg_cloud *c = &g->problem->cloud;
    double support = 0.999 * g->problem->form.approx.horizon * pg_cloud_ratio (c, (size_t) j),
           bond[3] = { 0 };
    for (int k = 0; k < g->dim; k++) bond[k] = place (g, j)[k] - r->x[p * (size_t) g->dim + (size_t) k];
    return !(r->w[e + pg_rows_offset (r, p)] > 0) && r->own[p] != j
           && pg_cloud_length2 (c, (size_t) j, bond) < support * support;
}

/* The node nearest to x in the family of point p; *d2: its squared distance, m^2. */
int elements_nearest (const galerkin *g, const pg_rows *r, size_t p, const double *x, double *d2)
{
    int best = -1;
    *d2 = INFINITY;
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
        double d = pg_distance2 (g->dim, x, place (g, r->family.node[e]));
        if (d < *d2) *d2 = d, best = r->family.node[e];
    }
    return best;
}

/* The one of the evaluation points first .. last - 1 that is nearest to x. */
static size_t nearest_point (const galerkin *g, const pg_rows *r, size_t first, size_t last, const double *x)
{
    size_t best = first;
    double least = INFINITY;
    for (size_t p = first; p < last; p++) {
        double d = pg_distance2 (g->dim, x, r->x + p * (size_t) g->dim);
        if (d < least) least = d, best = p;
    }
    return best;
}

/* Finds the nodes at the positions of the first m nodes of a cell; 0: some position has no node of its own
 * within 0.6 spacings. The points first .. last - 1 are those of the cell. */
static int find_nodes (const galerkin *g, size_t cell, size_t m, size_t first, size_t last, int *node)
{
    const pg_rows *r = &g->rows[g->bulk];
    const pg_cells *c = &g->problem->cells;
    for (size_t k = 0; k < m; k++) {
        const double *x = c->x + (c->start[cell] + k) * (size_t) g->dim;
        double d2;
        size_t p = nearest_point (g, r, first, last, x);
        node[k] = elements_nearest (g, r, p, x, &d2);
        double h = 0.6 * pg_problem_spacing (g->problem, g->bulk, p);
        if (node[k] < 0 || d2 > h * h) return 0;
        for (size_t i = 0; i < k; i++) if (node[i] == node[k]) return 0;
    }
    return 1;
}

/* Has one of the points first .. last - 1 lost its bond to one of the m nodes? */
static int separated (const galerkin *g, size_t m, const int *node, size_t first, size_t last)
{
    const pg_rows *r = &g->rows[g->bulk];
    for (size_t p = first; p < last; p++) {
        if (r->grade[p] >= PG_GRADE_SHEPARD) return 1;
        for (size_t k = 0; k < m; k++) {
            size_t e = entry_of (r, p, node[k]);
            if (e != SIZE_MAX && elements_broken (g, r, p, e)) return 1;
        }
    }
    return 0;
}

/* The kind of element with the same corners and straight edges. */
static pg_element straight (pg_element kind)
{
    for (int k = 0; k < PG_ELEMENTS; k++)
        if (pg_element_types[k].dim == pg_element_types[kind].dim && pg_element_types[k].order == 1
            && pg_element_types[k].nodes == pg_element_types[kind].corners)
            return (pg_element) k;
    return kind;
}

/* The cell as an element: its kind, and its nodes in the order of that kind; NO_CELL: it cannot be one. A
 * cell that the surface cuts has the corners of the whole box. */
static int whole_cell (const galerkin *g, size_t cell, size_t first, size_t last, int *node)
{
    int kind = g->problem->cells.kind[cell];
    if (first == last) return NO_CELL;
    if (kind == PG_CUT) kind = (int) box_kind[g->dim];
    if (!find_nodes (g, cell, (size_t) pg_element_types[kind].nodes, first, last, node)) {
        kind = (int) straight ((pg_element) kind);
        if (!find_nodes (g, cell, (size_t) pg_element_types[kind].nodes, first, last, node)) return NO_CELL;
    }
    return separated (g, (size_t) pg_element_types[kind].nodes, node, first, last) ? NO_CELL : kind;
}

/* Nodes within so many spacings of point p to which its bonds are intact, including p itself where it is a
 * node. Returns their number. */
static size_t near_nodes (const galerkin *g, int set, size_t p, double within, int *node)
{
    const pg_rows *r = &g->rows[set];
    size_t enough = (size_t) g->dim + 2, m = 0, seen = 0, offset = pg_rows_offset (r, p);
    double h = pg_problem_spacing (g->problem, set, p), reach = within * h;
    const double *x = r->x + p * (size_t) g->dim;
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
        seen += r->w[e + offset] > 0 || r->family.node[e] == r->own[p];
    for (;; reach += wider * h) {
        m = 0;
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1] && m < MOST_NODES; e++)
            if ((r->w[e + offset] > 0 || r->family.node[e] == r->own[p])
                && pg_distance2 (g->dim, x, place (g, r->family.node[e])) <= reach * reach)
                node[m++] = r->family.node[e];
        if (m >= enough || m >= seen || m == MOST_NODES) break;
    }
    return m;
}

/* ---- the list ------------------------------------------------------------------------------------------ */
static pg_status append (element_list *b, size_t of, int kind, double weight, size_t m, const int *node)
{
    pg_status status = PG_OK;
    pg_adjacency *l = &b->list;
    if (m == 0) return PG_OK;
    if (!l->start) {
        PG_GROW (l->start, b->cap_start, 1);
        l->start[0] = 0;
    }
    PG_GROW (l->start, b->cap_start, l->n + 2);
    PG_GROW (l->node, b->cap_node, l->start[l->n] + m);
    PG_GROW (b->of, b->cap_of, l->n + 1);
    PG_GROW (b->cell, b->cap_cell, l->n + 1);
    PG_GROW (b->weight, b->cap_weight, l->n + 1);
    memcpy (l->node + l->start[l->n], node, m * sizeof *node);
    b->of[l->n] = of, b->cell[l->n] = kind, b->weight[l->n] = weight;
    l->start[l->n + 1] = l->start[l->n] + m;
    l->n++;
    /* reach: the largest squared distance of two nodes of an element */
    for (size_t k = 1; k < m; k++)
        for (size_t i = 0; i < k; i++)
            b->reach = fmax (b->reach,
                             pg_distance2 (b->g->dim, place (b->g, node[i]), place (b->g, node[k])));
done:
    return status;
}

static pg_status append_point (element_list *b, size_t p, double weight)
{
    int node[MOST_NODES];
    return append (b, p, NO_CELL, weight, near_nodes (b->g, b->set, p, near_by, node), node);
}

/* Share of a cell's volume that lies in the body, if the surface cuts it; else 1. */
static double share_of (const galerkin *g, size_t cell)
{
    const pg_cells *c = &g->problem->cells;
    double whole = c->thickness;
    if (c->kind[cell] != PG_CUT) return 1;
    for (int k = 0; k < g->dim; k++) whole *= g->problem->lattice.step[k];
    return fmin (1, c->volume[cell] / whole);
}

/* Appends a tetrahedron with mid-edge nodes as eight small ones: four at the corners, four about the shortest
 * line that joins the middles of opposite edges. */
static pg_status append_halved (element_list *b, size_t cell, const int *node)
{
    static const unsigned char corner[4][4] = { { 0, 4, 6, 7 }, { 4, 1, 5, 8 }, { 6, 5, 2, 9 },
                                                { 7, 8, 9, 3 } },
                               line[3][2] = { { 4, 9 }, { 5, 7 }, { 6, 8 } },
                               about[3][4] = { { 5, 8, 7, 6 }, { 4, 8, 9, 6 }, { 4, 5, 9, 7 } };
    pg_status status = PG_OK;
    double least = INFINITY;
    int best = 0, small[4];
    for (int k = 0; k < 3; k++) {
        double d2 = pg_distance2 (3, place (b->g, node[line[k][0]]), place (b->g, node[line[k][1]]));
        if (d2 < (1 - 1e-9) * least) least = d2, best = k;
    }
    for (int k = 0; k < 4; k++) {
        for (int a = 0; a < 4; a++) small[a] = node[corner[k][a]];
        PG_TRY (append (b, cell, PG_TET4, 1, 4, small));
        small[0] = node[line[best][0]], small[1] = node[line[best][1]];
        small[2] = node[about[best][k]], small[3] = node[about[best][(k + 1) % 4]];
        PG_TRY (append (b, cell, PG_TET4, 1, 4, small));
    }
done:
    return status;
}

/* Appends cells with Gauss points, each as a whole or as one element per point. The points of a cell are
 * consecutive. */
static pg_status list_cells (element_list *b)
{
    pg_status status = PG_OK;
    const galerkin *g = b->g;
    const pg_rows *r = &g->rows[g->bulk];
    for (size_t first = 0, last; first < r->n; first = last) {
        int node[MOST_NODES], cell = r->cell[first];
        for (last = first; last < r->n && r->cell[last] == cell; last++) continue;
        int kind = whole_cell (g, (size_t) cell, first, last, node);
        if (kind == PG_TET10) PG_TRY (append_halved (b, (size_t) cell, node));
        else if (kind != NO_CELL)
            PG_TRY (append (b, (size_t) cell, kind, share_of (g, (size_t) cell),
                            (size_t) pg_element_types[kind].nodes, node));
        else
            for (size_t p = first; p < last; p++) PG_TRY (append_point (b, p, r->weight[p]));
    }
done:
    return status;
}

/* ---- nodal integration --------------------------------------------------------------------------------- */
/* The node at x_i + shift if the bond from node i to it is intact; -1: there is none. */
static int seen_at (const galerkin *g, size_t i, const double *shift)
{
    const pg_rows *r = &g->rows[PG_NODES];
    double x[3], d2, h = 0.6 * g->problem->cloud.h;
    for (int c = 0; c < g->dim; c++) x[c] = place (g, (int) i)[c] + shift[c];
    int node = elements_nearest (g, r, i, x, &d2);
    if (node < 0 || d2 > h * h || elements_broken (g, r, i, entry_of (r, i, node))) return -1;
    return node;
}

/* The box that is the element around node i of a lattice with nodal integration. The gradient at node i is a
 * difference between its neighbours on both sides, so that nodes at odd and even positions along an axis
 * hardly interact: each of the 2^dim parity classes of nodes may move by itself with almost no energy. The
 * box reflects this: it is two steps wide, from the neighbours on one side to those on the other, so that its
 * corners are all of one class; along an axis on which a neighbour is missing, where the gradient is
 * one-sided and couples classes, it begins at node i. size: its volume over that of a cell. Returns the
 * number of its nodes; 0: a bond from node i to a corner is missing. */
static size_t box_around (const galerkin *g, size_t i, int *node, double *size)
{
    const double *step = g->problem->cloud.step;
    size_t m = (size_t) 1 << g->dim;
    double end[3][2], shift[3];
    *size = 1;
    for (int c = 0; c < g->dim; c++) {
        for (int s = 0; s < 2; s++) {
            memset (shift, 0, sizeof shift), shift[c] = s ? step[c] : -step[c];
            end[c][s] = seen_at (g, i, shift) >= 0 ? shift[c] : 0;
        }
        *size *= (end[c][1] - end[c][0]) / step[c];
    }
    for (size_t k = 0; k < m && *size > 0; k++) {
        for (int c = 0; c < g->dim; c++) shift[c] = end[c][box_corner[k][c]];
        node[k] = seen_at (g, i, shift);
        if (node[k] < 0) return 0;
    }
    return *size > 0 ? m : 0;
}

/* Appends an element for every node: on a lattice without stabilisation the box around it, else an element
 * around the point. */
static pg_status list_nodes (element_list *b)
{
    pg_status status = PG_OK;
    const galerkin *g = b->g;
    const pg_problem *p = g->problem;
    int boxes = p->cloud.regular && !(g->options->silling > 0), node[8];
    double whole = p->cloud.thickness, size;
    for (int k = 0; k < g->dim; k++) whole *= p->cloud.step[k];
    for (size_t i = 0; i < g->n; i++) {
        size_t m = boxes ? box_around (g, i, node, &size) : 0;
        if (m) PG_TRY (append (b, i, (int) box_kind[g->dim], p->cloud.volume[i] / (whole * size), m, node));
        else PG_TRY (append_point (b, i, p->cloud.volume[i]));
        b->classes |= m > 0;
    }
done:
    return status;
}

/* ---- points at the centres of the cells ---------------------------------------------------------------- */
/* The nodes at the corners of the box that extends one step from node i in all positive directions, i first;
 * 0: some are missing. */
static size_t box_of (const galerkin *g, size_t i, int *node)
{
    size_t m = (size_t) 1 << g->dim;
    double x[3], d2, h = 0.6 * g->problem->cloud.h;
    for (size_t k = 0; k < m; k++) {
        for (int c = 0; c < g->dim; c++)
            x[c] = place (g, (int) i)[c] + box_corner[k][c] * g->problem->cloud.step[c];
        node[k] = elements_nearest (g, &g->rows[PG_NODES], i, x, &d2);
        if (node[k] < 0 || d2 > h * h) return 0;
        for (size_t l = 0; l < k; l++) if (node[l] == node[k]) return 0;
    }
    return m;
}

/* Does a crack separate two nodes of a box? */
static int parted (const galerkin *g, size_t m, const int *node)
{
    const pg_rows *r = &g->rows[PG_NODES];
    for (size_t k = 0; k < m; k++)
        for (size_t l = 0; l < m; l++) {
            size_t e = entry_of (r, (size_t) node[k], node[l]);
            if (e != SIZE_MAX && elements_broken (g, r, (size_t) node[k], e)) return 1;
        }
    return 0;
}

/* Appends boxes between points that are the centres of the cells. The volume of each point is shared among
 * its boxes, so that those at the surface include the half cells outside of them. Shares of boxes cut by a
 * crack, and points without any box, become elements around the points. */
static pg_status list_boxes (element_list *b)
{
    pg_status status = PG_OK;
    const galerkin *g = b->g;
    const pg_problem *p = g->problem;
    double *part = NULL, *own = NULL, whole = p->cloud.thickness;
    int *count = NULL, node[8];
    PG_ALLOC (part, g->n);
    PG_ALLOC (own, g->n);
    PG_ALLOC (count, g->n);
    b->set = PG_NODES;
    for (int k = 0; k < g->dim; k++) whole *= p->cloud.step[k];
    for (size_t i = 0; i < g->n; i++)
        for (size_t k = 0, m = box_of (g, i, node); k < m; k++) count[node[k]]++;
    for (size_t i = 0; i < g->n; i++)
        part[i] = count[i] ? p->cloud.volume[i] / count[i] : 0, own[i] = count[i] ? 0 : p->cloud.volume[i];
    for (size_t i = 0; i < g->n; i++) {
        size_t m = box_of (g, i, node);
        double share = 0;
        int apart = m && parted (g, m, node);
        for (size_t k = 0; k < m; k++) share += part[node[k]] / whole;
        for (size_t k = 0; k < m && apart; k++) own[node[k]] += part[node[k]];
        if (m && !apart) PG_TRY (append (b, i, (int) box_kind[g->dim], share, m, node));
    }
    for (size_t i = 0; i < g->n; i++) if (own[i] > 0) PG_TRY (append_point (b, i, own[i]));
done:
    pg_free (part), pg_free (own), pg_free (count);
    return status;
}

/* 1: there are as many points as cells of the lattice in the body, so that they lie at cell centres. */
static int at_centres (const pg_problem *p)
{
    size_t kept = 0, n = (size_t) p->lattice.count[0] * (size_t) p->lattice.count[1]
                         * (size_t) p->lattice.count[2];
    if (!p->lattice.dim || !p->lattice.in) return 0;
    for (size_t i = 0; i < n; i++) kept += p->lattice.in[i] != 0;
    return kept == p->cloud.n;
}

/* Appends springs between nearby nodes for facet points under Nitsche's terms. */
static pg_status list_supports (element_list *b)
{
    pg_status status = PG_OK;
    const galerkin *g = b->g;
    int node[MOST_NODES];
    for (size_t p = 0; g->supports.nnitsche && p < g->rows[PG_FACETS].n; p++)
        if (g->supports.nitsche_start[p + 1] > g->supports.nitsche_start[p])
            PG_TRY (append (b, p, SPRINGS, 1, near_nodes (g, PG_FACETS, p, near_facet, node), node));
done:
    return status;
}

/* Lists the elements, according to where the evaluation points lie. */
pg_status elements_find (element_list *b)
{
    pg_status status = PG_OK;
    if (b->g->problem->form.integration->at_nodes) PG_TRY (list_nodes (b));
    else if (at_centres (b->g->problem)) PG_TRY (list_boxes (b));
    else PG_TRY (list_cells (b));
    PG_TRY (list_supports (b));
done:
    return status;
}
