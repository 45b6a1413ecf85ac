/* SPDX-License-Identifier: GPL-3.0-or-later
 * Coarse functions of a level: multilinear functions ("hats") on a grid over the box of its nodes. Where
 * the couplings leave the nodes under a hat function in several connected parts (a crack runs through, a
 * slit, two bodies side by side), each part gets a function of its own: the hat function on it, zero on
 * the others. Together they reproduce every linear displacement of every connected part, so that rigid
 * motions and uniform strains of fragments are corrected on the coarse level. */
#include "multilevel.h"
#include <math.h>
#include <string.h>

/* Weights below this are left out. */
static const double negligible = 1e-5;

/* Makes a grid with cells of about `step` (m). Where nodes form a lattice, cells are whole lattice steps, so
 * that all hold nodes at the same relative positions and rows of coarse matrices can be shared. */
static void make_grid (level *l, double step)
{
    l->grid.ncell = l->grid.nvertex = 1;
    for (int k = 0; k < l->dim; k++) {
        double low = INFINITY, high = -INFINITY;
        for (size_t i = 0; i < l->n; i++) {
            double x = l->x[i * (size_t) l->dim + (size_t) k];
            low = fmin (low, x), high = fmax (high, x);
        }
        double count = fmax (1, round ((high - low) / step)), h = l->rows.lattice[k];
        l->grid.low[k] = low, l->grid.step[k] = high > low ? (high - low) / count : 1;
        /* On a lattice with step h: cells of whole lattice steps. */
        if (h > 0) {
            l->grid.share_of[k] = (int) fmax (1, round (step / h));
            l->grid.low[k] = l->grid.aligned ? low : low - h / 2, l->grid.step[k] = l->grid.share_of[k] * h;
            level_align (l, k);
            low = l->grid.aligned ? l->grid.low[k] : low;
            count = fmax (1, ceil (round ((high - low) / h + !l->grid.aligned) / l->grid.share_of[k]));
        }
        l->grid.cells[k] = (int) count;
        l->grid.ncell *= (size_t) l->grid.cells[k], l->grid.nvertex *= (size_t) l->grid.cells[k] + 1;
    }
}

size_t level_vertex (const level *l, size_t cell, int corner)
{
    size_t vertex = 0, stride = 1;
    for (int k = 0; k < l->dim; k++) {
        size_t a = cell % (size_t) l->grid.cells[k] + (size_t) (corner >> k & 1);
        cell /= (size_t) l->grid.cells[k];
        vertex += a * stride, stride *= (size_t) l->grid.cells[k] + 1;
    }
    return vertex;
}

void level_vertex_place (const level *l, size_t vertex, int *at)
{
    for (int k = 0; k < l->dim; k++)
        at[k] = (int) (vertex % ((size_t) l->grid.cells[k] + 1)), vertex /= (size_t) l->grid.cells[k] + 1;
}

/* Has node i an unknown that is not masked? */
static int takes_part (const level *l, size_t i) { return l->mask[i] != (1 << l->block) - 1; }

/* Finds the cell of each node, and the values at the node of the hat functions at the cell's corners. On a
 * lattice the position within the cell is rounded to the lattice, so that equal nodes have equal bits. */
static void place_nodes (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    level *l = context;
    for (size_t i = first; i < last; i++) {
        double t[3];
        size_t cell = 0, stride = 1;
        for (int k = 0; k < l->dim; k++) {
            double s = (l->x[i * (size_t) l->dim + (size_t) k] - l->grid.low[k]) / l->grid.step[k];
            if (l->grid.share_of[k])
                s = l->grid.aligned ? round (s * l->grid.share_of[k]) / l->grid.share_of[k]
                               : (floor (s * l->grid.share_of[k]) + 0.5) / l->grid.share_of[k];
            double whole = fmin (fmax (0, floor (s)), l->grid.cells[k] - 1);
            t[k] = fmin (fmax (0, s - whole), 1);
            cell += (size_t) whole * stride, stride *= (size_t) l->grid.cells[k];
        }
        l->coarse.cell[i] = (int) cell;
        for (int c = 0; c < l->corners; c++) {
            double w = 1;
            for (int k = 0; k < l->dim; k++) w *= c >> k & 1 ? t[k] : 1 - t[k];
            l->coarse.weight[i * (size_t) l->corners + (size_t) c] = w > negligible && takes_part (l, i)
                                                                         ? (float) w
                                                                         : 0;
        }
    }
}

/* Lists the nodes of each cell, ascending. */
static pg_status sort_by_cell (level *l)
{
    pg_status status = PG_OK;
    PG_ALLOC (l->coarse.cell_start, l->grid.ncell + 2);
    PG_ALLOC (l->coarse.cell_node, l->n);
    for (size_t i = 0; i < l->n; i++) l->coarse.cell_start[l->coarse.cell[i] + 2]++;
    for (size_t c = 0; c < l->grid.ncell; c++) l->coarse.cell_start[c + 2] += l->coarse.cell_start[c + 1];
    for (size_t i = 0; i < l->n; i++)
        l->coarse.cell_node[l->coarse.cell_start[l->coarse.cell[i] + 1]++] = (int) i;
done:
    return status;
}

/* ---- parts of a hat function -------------------------------------------------------------------------- */
/* Workspace of one thread: nodes under the hat function, queue of the search, couplings of a node; seen:
 * number + 1 of the last hat function whose search reached each node (with ranks: of the last search, of
 * `mark`); met: number + 1 of the last hat function under which each neighbouring rank has ghosts not yet
 * reached. */
typedef struct { int *under, *queue, *node; size_t *seen, *met, mark; } walker;
/* What all threads share: the level, their workspaces, the number of parts of each hat function. */
typedef struct { level *l; walker *walker; size_t *parts; pg_status failed; } search;

/* Corner of node i's cell at which the hat function stands; -1: the node is not under the hat function. */
static int corner_of (const level *l, size_t i, const int *vertex)
{
    size_t cell = (size_t) l->coarse.cell[i];
    int corner = 0;
    for (int k = 0; k < l->dim; k++) {
        int a = vertex[k] - (int) (cell % (size_t) l->grid.cells[k]);
        if (a < 0 || a > 1) return -1;
        corner |= a << k, cell /= (size_t) l->grid.cells[k];
    }
    return l->coarse.weight[i * (size_t) l->corners + (size_t) corner] > 0 ? corner : -1;
}

/* Lists the nodes under a hat function at grid position `vertex`, cell by cell; returns how many. */
static size_t gather (const level *l, const int *vertex, int *under)
{
    size_t count = 0;
    /* The cell whose corner c is this hat function. */
    for (int c = 0; c < l->corners; c++) {
        size_t cell = 0, stride = 1;
        int inside = 1;
        for (int k = 0; k < l->dim; k++) {
            int a = vertex[k] - (c >> k & 1);
            inside = inside && a >= 0 && a < l->grid.cells[k];
            cell += inside ? (size_t) a * stride : 0, stride *= (size_t) l->grid.cells[k];
        }
        if (!inside) continue;
        for (size_t p = l->coarse.cell_start[cell]; p < l->coarse.cell_start[cell + 1]; p++) {
            size_t i = (size_t) l->coarse.cell_node[p];
            if (l->coarse.weight[i * (size_t) l->corners + (size_t) c] > 0) under[count++] = (int) i;
        }
    }
    return count;
}

/* Numbers the connected parts of the nodes under hat function h by breadth-first search along the couplings:
 * function[node, corner] = part. Ends early once all nodes have been reached. Returns the number of parts.
 * Each entry of `function` belongs to one hat function, so that no two threads write to the same entry. */
static size_t find_parts (level *l, size_t h, walker *w, int thread)
{
    int vertex[3];
    level_vertex_place (l, h, vertex);
    size_t count = gather (l, vertex, w->under), reached = 0, parts = 0;
    for (size_t s = 0; s < count && reached < count; s++) {
        /* The next node that has not been reached begins a new part. */
        size_t seed = (size_t) w->under[s], head = 0, tail = 0;
        if (w->seen[seed] == h + 1) continue;
        w->seen[seed] = h + 1, w->queue[tail++] = (int) seed;
        /* Breadth-first search among the nodes under the hat function. */
        while (head < tail && reached + tail < count) {
            size_t i = (size_t) w->queue[head++], m = level_row (l, i, thread, w->node, NULL);
            for (size_t e = 0; e < m; e++) {
                size_t j = (size_t) w->node[e];
                if (w->seen[j] == h + 1 || corner_of (l, j, vertex) < 0) continue;
                w->seen[j] = h + 1, w->queue[tail++] = (int) j;
            }
        }
        for (size_t e = 0; e < tail; e++) {
            size_t i = (size_t) w->queue[e];
            l->coarse.function[i * (size_t) l->corners + (size_t) corner_of (l, i, vertex)] = (int) parts;
        }
        reached += tail, parts++;
    }
    return parts;
}

/* With ranks: notes in `met` the neighbouring ranks that own ghosts under hat function h; returns how many.
 * */
static size_t note_neighbours (const level *l, size_t h, walker *w, size_t count)
{
    size_t n = 0;
    for (size_t s = 0; s < count; s++) {
        int from = l->ranks->from[w->under[s]];
        if (from >= 0 && w->met[from] != h + 1) w->met[from] = h + 1, n++;
    }
    return n;
}

/* With ranks: joins the nodes under hat function h that couplings of owned nodes connect; other ranks do so
 * for theirs (level_agree_parts). Once all owned nodes are connected, one ghost of each neighbour suffices:
 * if the neighbour's nodes are not connected, it goes through all of its own couplings. */
static void join_parts (level *l, size_t h, walker *w, int thread)
{
    const unsigned char *owned = l->part->owned;
    size_t corners = (size_t) l->corners, own = 0, before = w->mark;
    int vertex[3], *joined = l->ranks->joined;
    level_vertex_place (l, h, vertex);
    size_t count = gather (l, vertex, w->under), neighbours = note_neighbours (l, h, w, count);
    for (size_t s = 0; s < count; s++) own += owned[w->under[s]];
    for (size_t s = 0, reached = 0; s < count && reached < own; s++) {
        size_t seed = (size_t) w->under[s], head = 0, tail = 0;
        if (!owned[seed] || w->seen[seed] > before) continue;
        int entry = (int) (seed * corners) + corner_of (l, seed, vertex);
        w->seen[seed] = ++w->mark, w->queue[tail++] = (int) seed;
        while (head < tail && (tail < own || neighbours > 0)) {
            size_t i = (size_t) w->queue[head++], m = level_row (l, i, thread, w->node, NULL);
            for (size_t e = 0; e < m; e++) {
                size_t j = (size_t) w->node[e];
                int corner;
                if (w->seen[j] == w->mark || (corner = corner_of (l, j, vertex)) < 0) continue;
                w->seen[j] = w->mark;
                pg_disjoint_join (joined, (int) (j * corners) + corner, entry);
                if (owned[j]) w->queue[tail++] = (int) j;
                else if (w->met[l->ranks->from[j]] == h + 1) w->met[l->ranks->from[j]] = 0, neighbours--;
            }
        }
        reached += tail;
    }
}

/* Finds the parts of the hat functions first .. last - 1. */
static void search_vertices (void *context, size_t first, size_t last, int thread)
{
    search *s = context;
    for (size_t h = first; h < last; h++)
        if (s->l->part) join_parts (s->l, h, &s->walker[thread], thread);
        else s->parts[h] = find_parts (s->l, h, &s->walker[thread], thread);
}

/* Returns an upper bound of the number of nodes under one hat function. */
static size_t most_under (const level *l)
{
    size_t most = 0;
    for (size_t c = 0; c < l->grid.ncell; c++)
        if (l->coarse.cell_start[c + 1] - l->coarse.cell_start[c] > most)
            most = l->coarse.cell_start[c + 1] - l->coarse.cell_start[c];
    return most * (size_t) l->corners;
}

/* Finds the parts of all hat functions and numbers the functions, hat function by hat function. */
static pg_status split_hats (level *l)
{
    pg_status status = PG_OK;
    search s = { .l = l };
    size_t most = most_under (l);
    PG_ALLOC (s.walker, (size_t) l->threads);
    for (int t = 0; t < l->threads; t++) {
        PG_ALLOC (s.walker[t].under, most);
        PG_ALLOC (s.walker[t].queue, most);
        PG_ALLOC (s.walker[t].node, l->rows.widest);
        PG_ALLOC (s.walker[t].seen, l->n);
        PG_ALLOC (s.walker[t].met, l->part ? l->part->halo.n : 0);
    }
    PG_ALLOC (l->coarse.first, l->grid.nvertex + 1);
    s.parts = l->coarse.first + 1;
    if (l->part) {
        PG_ALLOC (l->ranks->joined, l->n * (size_t) l->corners);
        pg_disjoint_start (l->ranks->joined, l->n * (size_t) l->corners);
    }
    pg_parallel (l->threads, l->grid.nvertex, search_vertices, &s);
    PG_TRY (level_agree_parts (l, s.parts));
    for (size_t h = 0; h < l->grid.nvertex; h++) l->coarse.first[h + 1] += l->coarse.first[h];
    l->grid.nfunction = l->coarse.first[l->grid.nvertex];
done:
    for (int t = 0; s.walker && t < l->threads; t++)
        pg_free (s.walker[t].under), pg_free (s.walker[t].queue), pg_free (s.walker[t].node),
            pg_free (s.walker[t].seen), pg_free (s.walker[t].met);
    pg_free (s.walker);
    return status;
}

/* Turns parts into numbers of functions, and lists the nodes of every function. */
static pg_status number_functions (level *l)
{
    pg_status status = PG_OK;
    size_t corners = (size_t) l->corners;
    PG_ALLOC (l->coarse.at, l->grid.nfunction + 2);
    for (size_t i = 0; i < l->n; i++)
        for (size_t c = 0; c < corners; c++) {
            int *f = &l->coarse.function[i * corners + c];
            if (!(l->coarse.weight[i * corners + c] > 0)) *f = -1;
            else
                *f += (int) l->coarse.first[level_vertex (l, (size_t) l->coarse.cell[i], (int) c)],
                    l->coarse.at[*f + 2]++;
        }
    for (size_t f = 0; f < l->grid.nfunction; f++) l->coarse.at[f + 2] += l->coarse.at[f + 1];
    PG_ALLOC (l->coarse.member, l->coarse.at[l->grid.nfunction + 1]);
    PG_ALLOC (l->coarse.share, l->coarse.at[l->grid.nfunction + 1]);
    for (size_t i = 0; i < l->n; i++)
        for (size_t c = 0; c < corners; c++) {
            int f = l->coarse.function[i * corners + c];
            if (f < 0) continue;
            l->coarse.member[l->coarse.at[f + 1]] = (int) i;
            l->coarse.share[l->coarse.at[f + 1]++] = l->coarse.weight[i * corners + c];
        }
done:
    return status;
}

/* Makes the grid, places the nodes on it, splits hat functions into parts and numbers these. */
pg_status level_space (level *l, double step)
{
    pg_status status = PG_OK;
    l->corners = 1 << l->dim;
    make_grid (l, step);
    PG_ALLOC (l->coarse.cell, l->n);
    PG_ALLOC (l->coarse.weight, l->n * (size_t) l->corners);
    PG_ALLOC (l->coarse.function, l->n * (size_t) l->corners);
    pg_parallel (l->threads, l->n, place_nodes, l);
    PG_TRY (sort_by_cell (l));
    PG_TRY (split_hats (l));
    PG_TRY (number_functions (l));
done:
    return status;
}
