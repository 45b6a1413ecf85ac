/* SPDX-License-Identifier: GPL-3.0-or-later
 * Coarse matrix A_c = P' A P of the functions of a level (a Galerkin product), from the rows of A, cell by
 * cell.
 *
 * All nodes of a cell add into one small dense matrix: its rows are the functions at the corners of the
 * cell, its columns the functions of the nodes they are coupled with; that is added into A_c. Cells are
 * taken in 2^dim groups by the parity of their position: cells of one group share no corner, so that no row
 * of A_c is written by two threads and the order of additions is always the same. On a lattice, cells with
 * equal rows have equal sums; these are computed once. */
#include "multilevel.h"
#include <math.h>
#include <string.h>

/* On coarse levels blocks of zeros, which the pattern has, are left out. */
size_t level_row (const level *l, size_t i, int thread, int *node, double *value)
{
    if (l->rows.row) return l->rows.row (l->rows.context, i, thread, node, value);
    size_t bb = (size_t) (l->block * l->block), m = 0;
    for (size_t e = l->start[i]; e < l->start[i + 1]; e++) {
        const double *v = l->value + e * bb;
        size_t k = 0;
        /* A block of zeros is in the pattern but couples nothing. */
        while (k < bb && v[k] == 0) k++;
        if (k == bb) continue;
        node[m] = l->node[e];
        if (value) memcpy (value + m * bb, v, bb * sizeof *value);
        m++;
    }
    return m;
}

/* ---- diagonal ------------------------------------------------------------------------------------------ */
/* Nodes and blocks of one row, for each thread. */
typedef struct { int **node; double **value; } workspace;

static void room_free (workspace *r, int threads)
{
    for (int t = 0; r->node && t < threads; t++) pg_free (r->node[t]);
    for (int t = 0; r->value && t < threads; t++) pg_free (r->value[t]);
    pg_free (r->node), pg_free (r->value);
}

static pg_status room_make (workspace *r, const level *l)
{
    pg_status status = PG_OK;
    PG_ALLOC (r->node, (size_t) l->threads);
    PG_ALLOC (r->value, (size_t) l->threads);
    for (int t = 0; t < l->threads; t++) {
        PG_ALLOC (r->node[t], l->rows.widest);
        PG_ALLOC (r->value[t], l->rows.widest * (size_t) (l->block * l->block));
    }
done:
    return status;
}

/* Copies the diagonal entries of a coarse matrix to `inverse`. */
static void diagonal_nodes (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const level *l = context;
    size_t block = (size_t) l->block;
    for (size_t i = first; i < last; i++)
        for (size_t e = l->start[i]; e < l->start[i + 1]; e++)
            for (size_t k = 0; k < block && (size_t) l->node[e] == i; k++)
                l->inverse[i * block + k] = l->value[(e * block + k) * block + k];
}

/* Unknowns without a positive diagonal entry, by which smoothing divides, are masked as prescribed ones
 * are. */
pg_status level_diagonal (level *l, const unsigned char *fixed)
{
    pg_status status = PG_OK;
    size_t block = (size_t) l->block;
    PG_ALLOC (l->mask, l->n);
    PG_ALLOC (l->inverse, l->ndof);
    if (l->A) l->A->diagonal (l->A->context, l->inverse);
    else pg_parallel (l->threads, l->n, diagonal_nodes, l);
    for (size_t i = 0; i < l->ndof; i++) {
        int masked = !(l->inverse[i] > 0) || (fixed && fixed[i]);
        l->mask[i / block] |= (unsigned char) (masked << i % block);
        l->inverse[i] = masked ? 0 : 1 / l->inverse[i];
    }
done:
    return status;
}

/* ---- pattern ------------------------------------------------------------------------------------------- */
/* Lists, ascending, the functions of all hat functions within `reach` cells of grid position `at`; out NULL:
 * only counts. Returns their number. */
static size_t neighbours_of (const level *f, const int *at, const int *reach, int *out)
{
    size_t count = 0;
    int low[3] = { 0 }, high[3] = { 0 };
    for (int k = 0; k < f->dim; k++) {
        low[k] = at[k] > reach[k] ? at[k] - reach[k] : 0;
        high[k] = at[k] + reach[k] < f->grid.cells[k] ? at[k] + reach[k] : f->grid.cells[k];
    }
    size_t sy = (size_t) f->grid.cells[0] + 1, sz = sy * (f->dim > 1 ? (size_t) f->grid.cells[1] + 1 : 1);
    for (int z = low[2]; z <= high[2]; z++)
        for (int y = low[1]; y <= high[1]; y++) {
            size_t row = (size_t) z * sz + (size_t) y * sy;
            for (size_t p = f->coarse.first[row + (size_t) low[0]];
                 p < f->coarse.first[row + (size_t) high[0] + 1]; p++, count++)
                if (out) out[count] = (int) p;
        }
    return count;
}

/* Makes the pattern of A_c, and the positions of its nodes. Two hat functions are coupled if nodes under them
 * are: a hat function extends one step to either side, so that two hat functions are coupled if they are less
 * than two steps plus the reach of the fine couplings apart. */
static pg_status make_pattern (level *c, const level *f)
{
    pg_status status = PG_OK;
    int reach[3] = { 0 }, at[3] = { 0 };
    size_t bb = (size_t) (c->block * c->block);
    /* Reach of the coarse couplings in cells: less than two cells plus the fine reach. On a lattice the
     * outermost node under a hat function is known: one lattice step inside its end if aligned, else half a
     * one. */
    for (int k = 0; k < f->dim; k++) {
        double share = f->grid.share_of[k], inside = share > 0 ? (f->grid.aligned ? 1 : 0.5) / share : 0;
        reach[k] = share > 0 ? (int) floor (2 * (1 - inside) + f->reach[k] / f->grid.step[k] + 1e-6)
                             : (int) ceil (2 + f->reach[k] / f->grid.step[k] + 1e-6) - 1;
        c->reach[k] = reach[k] * f->grid.step[k];
    }
    /* All functions of one hat function have the same couplings. */
    PG_ALLOC (c->start, c->n + 1);
    for (size_t h = 0; h < f->grid.nvertex; h++) {
        if (f->coarse.first[h] == f->coarse.first[h + 1]) continue;
        level_vertex_place (f, h, at);
        size_t count = neighbours_of (f, at, reach, NULL);
        for (size_t p = f->coarse.first[h]; p < f->coarse.first[h + 1]; p++)
            c->start[p + 1] = c->start[p] + count;
        if (count > c->rows.widest) c->rows.widest = count;
    }
    PG_ALLOC (c->node, c->start[c->n]);
    PG_ALLOC (c->value, c->start[c->n] * bb);
    PG_ALLOC (c->places, c->n * (size_t) c->dim);
    c->grid.aligned = f->grid.aligned;
    for (int k = 0; f->grid.aligned && k < f->dim; k++)
        c->rows.lattice[k] = f->grid.share_of[k] ? f->grid.step[k] : 0;
    c->x = c->places;
    for (size_t h = 0; h < f->grid.nvertex; h++) {
        level_vertex_place (f, h, at);
        for (size_t p = f->coarse.first[h]; p < f->coarse.first[h + 1]; p++) {
            neighbours_of (f, at, reach, c->node + c->start[p]);
            for (int k = 0; k < c->dim; k++)
                c->places[p * (size_t) c->dim + (size_t) k] = f->grid.low[k] + at[k] * f->grid.step[k];
        }
    }
done:
    return status;
}

/* ---- sums by cells ------------------------------------------------------------------------------------- */
/* Workspace of one thread for the sums of a cell. */
typedef struct {
    /* Column of a function in the sums, -1: none (functions). */
    int    *where;
    /* Row of a function, -1: none (functions). */
    int    *row_of;
    /* Functions of the rows and of the columns. */
    int    *row, *column;
    size_t  nrow, ncolumn, cap_row, cap_column, cap_sum, cap_spread;
    /* The sums (columns x rows x block x block). */
    double *sum;
    /* A P of one node (columns x block x block). */
    double *spread;
    pg_status status;
} summer;

/* Sums of one cell that serve for all cells like it. */
typedef struct {
    /* 1 for each cell that has these sums; NULL: none has (ncell). */
    unsigned char *like;
    size_t nrow, ncolumn;
    /* Hat functions of rows and columns, as grid offsets from the cell's first corner (nrow x 3, ncolumn x
     * 3). */
    int   *row, *column;
    double *sum;
} pattern;

/* Data of one product P' A P, which all threads share: coarse level c, fine level f, workspaces of the
 * threads, cells of the present group. */
typedef struct {
    level *c;
    const level *f;
    workspace workspace;
    summer *summer;
    const size_t *cell;
    pattern pattern;
} galerkin;

/* out += w a, bb entries. */
static inline void add_scaled (size_t bb, double w, const double *restrict a, double *restrict out)
{
    for (size_t k = 0; k < bb; k++) out[k] += w * a[k];
}

/* spread += A P for one row of A with m couplings: each block times the functions at its node, whose columns
 * have been made. */
static inline void spread_row (const summer *s, const level *f, size_t bb, size_t m, const int *node,
                               const double *value)
{
    size_t corners = (size_t) f->corners;
    for (size_t e = 0; e < m; e++) {
        const int *function = f->coarse.function + (size_t) node[e] * corners;
        const float *weight = f->coarse.weight + (size_t) node[e] * corners;
        for (size_t c = 0; c < corners; c++)
            if (function[c] >= 0)
                add_scaled (bb, weight[c], value + e * bb, s->spread + (size_t) s->where[function[c]] * bb);
    }
}

/* sum += P' (A P) for node i: the functions at node i times spread. */
static inline void gather_node (const summer *s, const level *f, size_t bb, size_t i)
{
    size_t corners = (size_t) f->corners;
    for (size_t c = 0; c < corners; c++) {
        int p = f->coarse.function[i * corners + c];
        if (p < 0) continue;
        double w = f->coarse.weight[i * corners + c], *to = s->sum + (size_t) s->row_of[p] * bb;
        for (size_t q = 0; q < s->ncolumn; q++) add_scaled (bb, w, s->spread + q * bb, to + q * s->nrow * bb);
    }
}

/* Zeroes rows and columns of masked unknowns in a block. */
static void blank_masked (const level *f, int rows, int columns, double *B)
{
    for (int a = 0; a < f->block; a++)
        for (int c = 0; c < f->block; c++) if ((rows >> a & 1) || (columns >> c & 1)) B[a * f->block + c] = 0;
}

/* Lists the rows of a cell: the functions at those of its m nodes that this rank owns. */
static pg_status find_rows (summer *s, const level *f, const int *node, size_t m)
{
    pg_status status = PG_OK;
    s->nrow = s->ncolumn = 0;
    for (size_t e = 0; e < m; e++)
        for (int c = 0; c < f->corners && pg_owns (f->part, (size_t) node[e]); c++) {
            int p = f->coarse.function[(size_t) node[e] * (size_t) f->corners + (size_t) c];
            if (p < 0 || s->row_of[p] >= 0) continue;
            PG_GROW (s->row, s->cap_row, s->nrow + 1);
            s->row_of[p] = (int) s->nrow, s->row[s->nrow++] = p;
        }
done:
    return status;
}

/* Appends a column of zeros for function p. */
static pg_status new_column (summer *s, size_t bb, int p)
{
    pg_status status = PG_OK;
    PG_GROW (s->column, s->cap_column, s->ncolumn + 1);
    PG_GROW (s->sum, s->cap_sum, (s->ncolumn + 1) * s->nrow * bb);
    PG_GROW (s->spread, s->cap_spread, (s->ncolumn + 1) * bb);
    memset (s->sum + s->ncolumn * s->nrow * bb, 0, s->nrow * bb * sizeof *s->sum);
    memset (s->spread + s->ncolumn * bb, 0, bb * sizeof *s->spread);
    s->where[p] = (int) s->ncolumn, s->column[s->ncolumn++] = p;
done:
    return status;
}

/* Adds node i of the cell, with the m couplings of its row of A, to the sums. */
static pg_status add_node (summer *s, const level *f, size_t i, size_t m, const int *node, double *value)
{
    pg_status status = PG_OK;
    size_t bb = (size_t) (f->block * f->block), corners = (size_t) f->corners;
    for (size_t e = 0; e < m; e++) {
        size_t j = (size_t) node[e];
        /* Masked unknowns take no part. */
        if (f->mask[i] | f->mask[j]) blank_masked (f, f->mask[i], f->mask[j], value + e * bb);
        for (size_t c = 0; c < corners; c++) {
            int p = f->coarse.function[j * corners + c];
            if (p >= 0 && s->where[p] < 0) PG_TRY (new_column (s, bb, p));
        }
    }
    if (s->ncolumn) memset (s->spread, 0, s->ncolumn * bb * sizeof *s->spread);
    /* Blocks of 2 x 2 and 3 x 3 have loops of constant length. */
    if (bb == 4) spread_row (s, f, 4, m, node, value), gather_node (s, f, 4, i);
    else if (bb == 9) spread_row (s, f, 9, m, node, value), gather_node (s, f, 9, i);
    else spread_row (s, f, bb, m, node, value), gather_node (s, f, bb, i);
done:
    return status;
}

/* Returns the index of p in an ascending list; -1: it is not there. */
static long find (const int *list, size_t n, int p)
{
    size_t low = 0, high = n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (list[middle] < p) low = middle + 1;
        else high = middle;
    }
    return low < n && list[low] == p ? (long) low : -1;
}

/* Adds the sums of a cell into A_c. A nonzero sum outside the pattern means that the caller's reach was
 * wrong. */
static pg_status hand_over (const summer *s, const double *sums, level *c)
{
    pg_status status = PG_OK;
    size_t bb = (size_t) (c->block * c->block);
    for (size_t r = 0; r < s->nrow; r++) {
        size_t first = c->start[s->row[r]], m = c->start[s->row[r] + 1] - first;
        for (size_t q = 0; q < s->ncolumn; q++) {
            /* A column outside the pattern may only hold zeros. */
            long at = find (c->node + first, m, s->column[q]);
            const double *sum = sums + (q * s->nrow + r) * bb;
            if (at >= 0) add_scaled (bb, 1, sum, c->value + (first + (size_t) at) * bb);
            else for (size_t k = 0; k < bb; k++)
                    if (sum[k] != 0)
                        PG_FAIL (PG_E_USAGE, "nodes are coupled that are further apart than their rows said");
        }
    }
done:
    return status;
}

/* ---- cells that are alike ------------------------------------------------------------------------------ */
/* Position of a cell on the grid. */
static void cell_place (const level *f, size_t cell, int *at)
{
    for (int k = 0; k < f->dim; k++)
        at[k] = (int) (cell % (size_t) f->grid.cells[k]), cell /= (size_t) f->grid.cells[k];
}

/* Plain cell: no node has a masked unknown (ghosts that are never updated are masked), and no hat function at
 * its corners is split. */
static int is_plain (const level *f, size_t cell)
{
    for (size_t p = f->coarse.cell_start[cell]; p < f->coarse.cell_start[cell + 1]; p++)
        if (f->mask[f->coarse.cell_node[p]]) return 0;
    for (int c = 0; c < f->corners; c++) {
        size_t vertex = level_vertex (f, cell, c);
        if (f->coarse.first[vertex + 1] - f->coarse.first[vertex] > 1) return 0;
    }
    return 1;
}

/* Flags of a cell: it is plain; it has a node at each lattice site, and all its nodes have equal rows. */
enum { PLAIN = 1, ALIKE = 2 };

/* Sets the flags PLAIN and ALIKE of the cells first .. last - 1 in pattern.like. */
static void classify (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    galerkin *g = context;
    const level *f = g->f;
    size_t full = 1;
    for (int k = 0; k < f->dim; k++) full *= (size_t) f->grid.share_of[k];
    for (size_t cell = first; cell < last; cell++) {
        const int *node = f->coarse.cell_node + f->coarse.cell_start[cell];
        size_t m = f->coarse.cell_start[cell + 1] - f->coarse.cell_start[cell], alike = 0;
        if (!is_plain (f, cell)) continue;
        while (m == full && alike < m && pg_owns (f->part, (size_t) node[alike])
               && f->rows.alike (f->rows.context, (size_t) node[alike])) alike++;
        g->pattern.like[cell] = (unsigned char) (alike == full ? PLAIN | ALIKE : PLAIN);
    }
}

/* Are all cells that couplings of this cell's nodes reach plain, and none of them beyond the grid? */
static int stands_free (const level *f, const unsigned char *like, size_t cell)
{
    int at[3] = { 0 }, far[3] = { 0 };
    cell_place (f, cell, at);
    for (int k = 0; k < f->dim; k++) {
        far[k] = (int) ceil (f->reach[k] / f->grid.step[k]);
        if (at[k] < far[k] || at[k] + far[k] >= f->grid.cells[k]) return 0;
    }
    size_t sy = (size_t) f->grid.cells[0], sz = sy * (f->dim > 1 ? (size_t) f->grid.cells[1] : 1);
    /* All cells that couplings of this cell can reach. */
    for (int z = at[2] - far[2]; z <= at[2] + far[2]; z++)
        for (int y = at[1] - far[1]; y <= at[1] + far[1]; y++)
            for (int x = at[0] - far[0]; x <= at[0] + far[0]; x++)
                if (!(like[(size_t) z * sz + (size_t) y * sy + (size_t) x] & PLAIN)) return 0;
    return 1;
}

/* Grid offset of the hat function of a coarse function from the first corner of a cell. */
static void offset_of (const level *f, const int *cell, int function, int *out)
{
    size_t low = 0, high = f->grid.nvertex;
    /* The last hat function whose functions start at or before this one. */
    while (high - low > 1) {
        /* first[] ascends with the vertices. */
        size_t middle = (low + high) / 2;
        if (f->coarse.first[middle] <= (size_t) function) low = middle;
        else high = middle;
    }
    level_vertex_place (f, low, out);
    for (int k = 0; k < f->dim; k++) out[k] -= cell[k];
}

/* Returns the function at a grid offset from a cell whose hat functions are not split. */
static int function_at (const level *f, const int *cell, const int *offset)
{
    size_t vertex = 0, stride = 1;
    for (int k = 0; k < f->dim; k++)
        vertex += (size_t) (cell[k] + offset[k]) * stride, stride *= (size_t) f->grid.cells[k] + 1;
    return (int) f->coarse.first[vertex];
}

static pg_status sum_nodes (galerkin *g, size_t cell, int thread);
static void forget_cell (summer *s);

/* Computes the sums of a cell and keeps them for all cells like it. */
static pg_status make_pattern_of (galerkin *g, size_t cell)
{
    pg_status status = PG_OK;
    pattern *p = &g->pattern;
    summer *s = &g->summer[0];
    int at[3] = { 0 };
    PG_TRY (sum_nodes (g, cell, 0));
    size_t count = s->nrow * s->ncolumn * (size_t) (g->f->block * g->f->block);
    p->nrow = s->nrow, p->ncolumn = s->ncolumn;
    PG_ALLOC (p->row, 3 * s->nrow);
    PG_ALLOC (p->column, 3 * s->ncolumn);
    PG_ALLOC (p->sum, count);
    memcpy (p->sum, s->sum, count * sizeof *p->sum);
    cell_place (g->f, cell, at);
    for (size_t r = 0; r < p->nrow; r++) offset_of (g->f, at, s->row[r], p->row + 3*r);
    for (size_t q = 0; q < p->ncolumn; q++) offset_of (g->f, at, s->column[q], p->column + 3*q);
done:
    forget_cell (s);
    return status;
}

/* Finds the cells with equal sums, and computes these once; there are none where nodes form no lattice. */
static pg_status find_alike (galerkin *g)
{
    pg_status status = PG_OK;
    const level *f = g->f;
    unsigned char *like = NULL;
    size_t model = f->grid.ncell;
    for (int k = 0; k < f->dim; k++) if (!f->grid.share_of[k]) return PG_OK;
    if (!f->rows.alike) return PG_OK;
    PG_ALLOC (g->pattern.like, f->grid.ncell);
    PG_ALLOC (like, f->grid.ncell);
    pg_parallel (f->threads, f->grid.ncell, classify, g);
    for (size_t cell = 0; cell < f->grid.ncell; cell++) {
        like[cell] = (g->pattern.like[cell] & ALIKE) && stands_free (f, g->pattern.like, cell);
        if (like[cell] && model == f->grid.ncell) model = cell;
    }
    memcpy (g->pattern.like, like, f->grid.ncell);
    if (model < f->grid.ncell) PG_TRY (make_pattern_of (g, model));
done:
    pg_free (like);
    return status;
}

/* Lists the functions of rows and columns of a cell that is like the one whose sums are kept. */
static pg_status take_pattern (galerkin *g, size_t cell, summer *s)
{
    pg_status status = PG_OK;
    const pattern *p = &g->pattern;
    int at[3] = { 0 };
    cell_place (g->f, cell, at);
    s->nrow = s->ncolumn = 0;
    PG_GROW (s->row, s->cap_row, p->nrow);
    PG_GROW (s->column, s->cap_column, p->ncolumn);
    for (; s->nrow < p->nrow; s->nrow++) s->row[s->nrow] = function_at (g->f, at, p->row + 3 * s->nrow);
    for (; s->ncolumn < p->ncolumn; s->ncolumn++)
        s->column[s->ncolumn] = function_at (g->f, at, p->column + 3 * s->ncolumn);
done:
    return status;
}

/* ---- all cells ----------------------------------------------------------------------------------------- */
/* Computes the sums of a cell over its nodes, in ascending order. */
static pg_status sum_nodes (galerkin *g, size_t cell, int thread)
{
    pg_status status = PG_OK;
    const level *f = g->f;
    summer *s = &g->summer[thread];
    const int *node = f->coarse.cell_node + f->coarse.cell_start[cell];
    size_t m = f->coarse.cell_start[cell + 1] - f->coarse.cell_start[cell];
    PG_TRY (find_rows (s, f, node, m));
    for (size_t e = 0; e < m && s->nrow; e++) {
        if (!pg_owns (f->part, (size_t) node[e])) continue;
        size_t i = (size_t) node[e],
               count = level_row (f, i, thread, g->workspace.node[thread], g->workspace.value[thread]);
        PG_TRY (add_node (s, f, i, count, g->workspace.node[thread], g->workspace.value[thread]));
    }
done:
    return status;
}

/* Clears the marks that a cell left in the workspace. */
static void forget_cell (summer *s)
{
    for (size_t r = 0; r < s->nrow; r++) s->row_of[s->row[r]] = -1;
    for (size_t q = 0; q < s->ncolumn; q++) s->where[s->column[q]] = -1;
}

/* Adds the sums of one cell, its own or those kept for cells like it, to A_c. */
static pg_status sum_cell (galerkin *g, size_t cell, int thread)
{
    pg_status status = PG_OK;
    summer *s = &g->summer[thread];
    int like = g->pattern.like && g->pattern.like[cell];
    if (like) PG_TRY (take_pattern (g, cell, s));
    else PG_TRY (sum_nodes (g, cell, thread));
    PG_TRY (hand_over (s, like ? g->pattern.sum : s->sum, g->c));
done:
    forget_cell (s);
    return status;
}

static void sum_cells (void *context, size_t first, size_t last, int thread)
{
    galerkin *g = context;
    for (size_t k = first; k < last; k++) {
        pg_status now = sum_cell (g, g->cell[k], thread);
        if (now != PG_OK) g->summer[thread].status = now;
    }
}

/* Lists the cells with nodes whose position along axis k is odd or even as bit k of `parity` says. */
static size_t cells_of_parity (const level *f, int parity, size_t *out)
{
    size_t count = 0;
    for (size_t cell = 0; cell < f->grid.ncell; cell++) {
        size_t rest = cell;
        int same = f->coarse.cell_start[cell] < f->coarse.cell_start[cell + 1];
        for (int k = 0; k < f->dim; k++)
            same = same && (int) (rest % (size_t) f->grid.cells[k] % 2) == (parity >> k & 1),
            rest /= (size_t) f->grid.cells[k];
        if (same) out[count++] = cell;
    }
    return count;
}

/* Adds the sums of all cells, one group of equal parity after the other. */
static pg_status sum_all (galerkin *g)
{
    pg_status status = PG_OK;
    size_t *cell = NULL;
    PG_ALLOC (cell, g->f->grid.ncell);
    g->cell = cell;
    for (int parity = 0; parity < g->f->corners; parity++) {
        pg_parallel_heavy (g->f->threads, cells_of_parity (g->f, parity, cell), sum_cells, g);
        for (int t = 0; t < g->f->threads; t++)
            if (g->summer[t].status != PG_OK)
                PG_FAIL (g->summer[t].status,
                         "the coarse matrix of %zu functions could not be made: no memory, or couplings "
                         "beyond their reach",
                         g->c->n);
    }
done:
    pg_free (cell);
    return status;
}

/* Workspaces exist once per thread and are marked as empty by -1. */
pg_status level_coarsen (level *c, const level *f)
{
    pg_status status = PG_OK;
    galerkin g = { .c = c, .f = f };
    c->dim = f->dim, c->block = f->block, c->threads = f->threads, c->n = f->grid.nfunction,
    c->ndof = c->n * (size_t) c->block;
    PG_TRY (make_pattern (c, f));
    PG_TRY (room_make (&g.workspace, f));
    PG_ALLOC (g.summer, (size_t) f->threads);
    for (int t = 0; t < f->threads; t++) {
        PG_ALLOC (g.summer[t].where, c->n);
        PG_ALLOC (g.summer[t].row_of, c->n);
        memset (g.summer[t].where, -1, c->n * sizeof (int));
        memset (g.summer[t].row_of, -1, c->n * sizeof (int));
    }
    PG_TRY (find_alike (&g));
    PG_TRY (sum_all (&g));
    PG_TRY (level_diagonal (c, NULL));
done:
    for (int t = 0; g.summer && t < f->threads; t++) {
        summer *s = &g.summer[t];
        pg_free (s->where), pg_free (s->row_of), pg_free (s->row), pg_free (s->column), pg_free (s->sum),
            pg_free (s->spread);
    }
    pg_free (g.summer);
    pg_free (g.pattern.like), pg_free (g.pattern.row), pg_free (g.pattern.column), pg_free (g.pattern.sum);
    room_free (&g.workspace, f->threads);
    return status;
}
