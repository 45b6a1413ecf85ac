/* SPDX-License-Identifier: GPL-3.0-or-later
 * Cholesky factorisation P K P' = L L' of small systems, by rows within an envelope (skyline; A. Jennings,
 * Comput. J. 9 (1966) 281; A. George and J. W. H. Liu, Computer Solution of Large Sparse Positive Definite
 * Systems, 1981, ch. 4). L has nothing left of the first entry of a row of K, and is full from there on.
 *
 * CHOLMOD takes fewer operations, but it and BLAS must be loaded first, which takes longer than the whole
 * factorisation of some hundred unknowns: pg_linear_analyse.
 *
 * The nodes are ordered by reverse Cuthill and McKee, so that coupled ones have near numbers. Rows are held
 * four at a time, a panel: the four begin together, at a multiple of four, and the products of two panels are
 * 4 x 4 dot products of what both have, in lanes of four numbers. Rows of a unit matrix fill the last
 * panel. */
#include "failed_row.h"
#include "skyline.h"
#include "wide.h"
#include <limits.h>
#include <math.h>
#include <string.h>

/* Rows of a panel. */
enum { ROWS = 4 };

/* State of the solver. */
typedef struct {
    /* Unknowns; panels of rows. */
    size_t n, npanel;
    /* Place of each unknown in the order (n). */
    int    *place;
    /* First column of each panel, and where its four rows begin, one behind the other, each up to the end of
     * the panel (npanel + 1). */
    int    *first;
    size_t *start;
    double *L;
    /* 1 / L_ii (npanel x ROWS), and a vector of that length. */
    double *inverse, *y;
    double  pivots;
} skyline;

static void skyline_clear (skyline *s)
{
    if (!s) return;
    pg_free (s->place), pg_free (s->first), pg_free (s->start);
    pg_free (s->L), pg_free (s->inverse), pg_free (s->y);
    pg_free (s);
}

static void skyline_free (void **self)
{
    skyline_clear (*self);
    *self = NULL;
}

/* ---- order --------------------------------------------------------------------------------------------- */
/* The graph of the nodes, both triangles, and the workspace of searches in it: the nodes in the order in
 * which a search has met them, and the distance of each from its start, -1: not met. */
typedef struct { size_t n, *start; int *node, *queue, *level; } graph;

static void graph_free (graph *g)
{
    pg_free (g->start), pg_free (g->node), pg_free (g->queue), pg_free (g->level);
}

static size_t degree (const graph *g, int i) { return g->start[i + 1] - g->start[i]; }

/* From the matrix of unknowns with `block` unknowns per node: its first column of each node has all nodes
 * that the others have. */
static pg_status graph_make (graph *g, const pg_sparse *A, size_t block)
{
    pg_status status = PG_OK;
    g->n = A->ncol / block;
    PG_ALLOC (g->start, g->n + 2);
    PG_ALLOC (g->queue, g->n);
    PG_ALLOC (g->level, g->n);
    for (int fill = 0; fill < 2; fill++) {
        for (size_t i = 0; i < g->n; i++) {
            long last = -1, p = A->start[i * block];
            for (; p < A->start[i * block + 1]; p++) {
                long j = A->row[p] / (long) block;
                if (j == last || (size_t) j == i) continue;
                last = j;
                if (!fill) g->start[i + 2]++, g->start[j + 2]++;
                else g->node[g->start[i + 1]++] = (int) j, g->node[g->start[j + 1]++] = (int) i;
            }
        }
        if (fill) break;
        for (size_t i = 0; i < g->n; i++) g->start[i + 2] += g->start[i + 1];
        PG_ALLOC (g->node, g->start[g->n + 1] + 1);
    }
done:
    return status;
}

/* Breadth first from a node, what a node leads to in the order of degrees: fills queue[from ..], returns its
 * end. Levels of what it meets are set. */
static size_t search (graph *g, int root, size_t from)
{
    size_t head = from, tail = from;
    g->queue[tail++] = root, g->level[root] = 0;
    for (; head < tail; head++) {
        int i = g->queue[head];
        size_t begin = tail;
        for (size_t e = g->start[i]; e < g->start[i + 1]; e++) {
            int j = g->node[e];
            if (g->level[j] >= 0) continue;
            size_t at = tail++;
            for (; at > begin && degree (g, g->queue[at - 1]) > degree (g, j); at--)
                g->queue[at] = g->queue[at - 1];
            g->queue[at] = j, g->level[j] = g->level[i] + 1;
        }
    }
    return tail;
}

/* A node at one end of the part of the graph that `root` is in: one of least degree as far from the last as
 * can be, as long as that takes it farther (George and Liu 1979, ACM Trans. Math. Softw. 5, 284). */
static int far_end (graph *g, int root, size_t from)
{
    for (int depth = -1; ; ) {
        size_t end = search (g, root, from);
        int now = g->level[g->queue[end - 1]], best = g->queue[end - 1];
        for (size_t k = end; k-- > from && g->level[g->queue[k]] == now;)
            if (degree (g, g->queue[k]) < degree (g, best)) best = g->queue[k];
        for (size_t k = from; k < end; k++) g->level[g->queue[k]] = -1;
        if (now <= depth) return root;
        depth = now, root = best;
    }
}

/* Reverse Cuthill and McKee: place (nodes x block) of each unknown. */
static pg_status order (const pg_sparse *A, size_t block, int *place)
{
    pg_status status = PG_OK;
    graph g = { 0 };
    size_t met = 0;
    PG_TRY (graph_make (&g, A, block));
    memset (g.level, -1, g.n * sizeof *g.level);
    for (size_t i = 0; i < g.n; i++)
        if (g.level[i] < 0) met = search (&g, far_end (&g, (int) i, met), met);
    for (size_t k = 0; k < g.n; k++)
        for (size_t a = 0; a < block; a++)
            place[(size_t) g.queue[k] * block + a] = (int) ((g.n - 1 - k) * block + a);
done:
    graph_free (&g);
    return status;
}

/* ---- envelope ------------------------------------------------------------------------------------------ */
/* Length of the rows of panel P. */
static size_t width (const skyline *s, size_t P) { return (P + 1) * ROWS - (size_t) s->first[P]; }

/* First column of each panel: that of its row that begins first, rounded down to a multiple of four. Row and
 * column of an entry of A stand for m unknowns each. */
static pg_status find_envelope (skyline *s, const pg_sparse *A, size_t m)
{
    pg_status status = PG_OK;
    PG_ALLOC (s->first, s->npanel);
    PG_ALLOC (s->start, s->npanel + 1);
    for (size_t P = 0; P < s->npanel; P++) s->first[P] = (int) (P * ROWS);
    for (size_t c = 0; c < A->ncol; c++)
        for (long p = A->start[c]; p < A->start[c + 1]; p++) {
            size_t i = (size_t) s->place[c], j = (size_t) s->place[A->row[p]];
            size_t low = i < j ? i : j, high = i < j ? j : i;
            int first = (int) (low * m / ROWS * ROWS);
            for (size_t P = high * m / ROWS; P <= (high * m + m - 1) / ROWS; P++)
                if (first < s->first[P]) s->first[P] = first;
        }
    for (size_t P = 0; P < s->npanel; P++) s->start[P + 1] = s->start[P] + ROWS * width (s, P);
done:
    return status;
}

/* Order and envelope of a matrix whose entries are ordered in blocks and stand for m unknowns. */
static pg_status analyse (skyline **out, const pg_sparse *A, size_t block, size_t m)
{
    pg_status status = PG_OK;
    skyline *s = NULL;
    if (A->ncol > (INT_MAX - ROWS) / m)
        PG_FAIL (PG_E_MEMORY, "%zu unknowns are too many for an envelope", A->ncol * m);
    PG_ALLOC (s, 1);
    s->n = A->ncol * m, s->npanel = (s->n + ROWS - 1) / ROWS;
    PG_ALLOC (s->place, A->ncol + 1);
    PG_TRY (order (A, block, s->place));
    PG_TRY (find_envelope (s, A, m));
    *out = s, s = NULL;
done:
    skyline_clear (s);
    return status;
}

static pg_status skyline_analyse (void **self, const pg_sparse *A, const pg_linear_options *o)
{
    skyline *s = NULL;
    int blocks = o->block > 0 && A->ncol % (size_t) o->block == 0;
    pg_status status = analyse (&s, A, blocks ? (size_t) o->block : 1, 1);
    *self = s;
    return status;
}

/* Of a row with w entries the last one is the pivot; the others take two operations for each before them. */
static void skyline_info (const void *self, pg_linear_info *info)
{
    const skyline *s = self;
    *info = (pg_linear_info) { .ordering = "rcm", .pivots = s->pivots };
    for (size_t i = 0; i < s->n; i++) {
        double w = (double) (i + 1 - (size_t) s->first[i / ROWS]);
        info->factor_entries += w, info->flops += w * w;
    }
}

pg_status skyline_forecast (const pg_sparse *nodes, int block, pg_linear_info *info)
{
    skyline *s = NULL;
    pg_status status = analyse (&s, nodes, 1, (size_t) block);
    if (status != PG_OK) return status;
    skyline_info (s, info);
    skyline_clear (s);
    return PG_OK;
}

/* ---- factor -------------------------------------------------------------------------------------------- */
static inline double sum_of (const four *a) { return ((*a)[0] + (*a)[1]) + ((*a)[2] + (*a)[3]); }

/* D (4 x 4) = the dot products of four rows a with four rows b, n numbers each (a multiple of four); their
 * rows are la and lb apart. */
PG_WIDE static void products (const double *a, size_t la, const double *b, size_t lb, size_t n, double *D)
{
    for (size_t r = 0; r < ROWS; r += 2)
        for (size_t c = 0; c < ROWS; c += 2) {
            const double *a0 = a + r * la, *a1 = a0 + la, *b0 = b + c * lb, *b1 = b0 + lb;
            four s00 = { 0 }, s01 = { 0 }, s10 = { 0 }, s11 = { 0 };
            for (size_t k = 0; k < n; k += 4) {
                four x0 = *(const four *) (a0 + k), x1 = *(const four *) (a1 + k),
                     y0 = *(const four *) (b0 + k), y1 = *(const four *) (b1 + k);
                s00 += x0 * y0, s01 += x0 * y1, s10 += x1 * y0, s11 += x1 * y1;
            }
            D[r * ROWS + c] = sum_of (&s00), D[r * ROWS + c + 1] = sum_of (&s01);
            D[(r + 1) * ROWS + c] = sum_of (&s10), D[(r + 1) * ROWS + c + 1] = sum_of (&s11);
        }
}

/* The entries of A at their places in the envelope; ones on the diagonal of the rows that fill the last
 * panel. */
static void scatter (skyline *s, const pg_sparse *A)
{
    memset (s->L, 0, s->start[s->npanel] * sizeof *s->L);
    for (size_t c = 0; c < s->n; c++)
        for (long p = A->start[c]; p < A->start[c + 1]; p++) {
            size_t i = (size_t) s->place[c], j = (size_t) s->place[A->row[p]];
            if (i < j) {
                size_t swap = i;
                i = j, j = swap;
            }
            size_t P = i / ROWS;
            s->L[s->start[P] + i % ROWS * width (s, P) + j - (size_t) s->first[P]] += A->value[p];
        }
    for (size_t i = s->n; i < s->npanel * ROWS; i++) {
        size_t P = i / ROWS;
        s->L[s->start[P] + i % ROWS * width (s, P) + i - (size_t) s->first[P]] = 1;
    }
}

/* The entries of panel P in the columns of panel Q before it. */
static void eliminate (skyline *s, size_t P, size_t Q)
{
    size_t lp = width (s, P), lq = width (s, Q), fp = (size_t) s->first[P], fq = (size_t) s->first[Q],
           from = fp > fq ? fp : fq, at = Q * ROWS;
    double D[ROWS * ROWS], *to = s->L + s->start[P] + at - fp;
    const double *own = s->L + s->start[Q] + at - fq;
    products (s->L + s->start[P] + from - fp, lp, s->L + s->start[Q] + from - fq, lq, at - from, D);
    for (size_t r = 0; r < ROWS; r++)
        for (size_t c = 0; c < ROWS; c++) {
            double x = to[r * lp + c] - D[r * ROWS + c];
            for (size_t m = 0; m < c; m++) x -= to[r * lp + m] * own[c * lq + m];
            to[r * lp + c] = x * s->inverse[at + c];
        }
}

/* The diagonal block of panel P; returns the row whose pivot is not positive, -1: all are. */
static long take_pivots (skyline *s, size_t P, double *low, double *high)
{
    size_t lp = width (s, P), before = lp - ROWS;
    double D[ROWS * ROWS], *row = s->L + s->start[P], *to = row + before;
    products (row, lp, row, lp, before, D);
    for (size_t r = 0; r < ROWS; r++)
        for (size_t c = 0; c <= r; c++) {
            double x = to[r * lp + c] - D[r * ROWS + c];
            for (size_t m = 0; m < c; m++) x -= to[r * lp + m] * to[c * lp + m];
            size_t i = P * ROWS + r;
            if (c < r) to[r * lp + c] = x * s->inverse[P * ROWS + c];
            else if (!(x > 0) || !isfinite (x)) return (long) i;
            else {
                to[r * lp + c] = sqrt (x), s->inverse[i] = 1 / to[r * lp + c];
                if (i < s->n) *low = fmin (*low, x), *high = fmax (*high, x);
            }
        }
    return -1;
}

/* A pivot that is not positive is reported with its unknown in the numbering of A. */
static pg_status skyline_factor (void *self, const pg_sparse *A)
{
    pg_status status = PG_OK;
    skyline *s = self;
    double low = INFINITY, high = 0;
    if (!s->L) PG_ALLOC (s->L, s->start[s->npanel] + 1);
    if (!s->inverse) PG_ALLOC (s->inverse, s->npanel * ROWS + 1);
    if (!s->y) PG_ALLOC (s->y, s->npanel * ROWS + 1);
    scatter (s, A);
    for (size_t P = 0; P < s->npanel; P++) {
        for (size_t Q = (size_t) s->first[P] / ROWS; Q < P; Q++) eliminate (s, P, Q);
        long bad = take_pivots (s, P, &low, &high), unknown = 0;
        if (bad < 0) continue;
        while ((size_t) unknown + 1 < s->n && s->place[unknown] != bad) unknown++;
        linear_failed_at (unknown);
        PG_FAIL (PG_E_NOT_SPD, "the stiffness matrix is not positive definite at unknown %ld of %zu",
                 unknown, s->n);
    }
    s->pivots = high > 0 ? low / high : 0;
done:
    return status;
}

/* ---- solve --------------------------------------------------------------------------------------------- */
/* L y = y, then L' y = y, row by row. */
PG_WIDE static void substitute (const skyline *s, double *y)
{
    for (size_t i = 0; i < s->npanel * ROWS; i++) {
        size_t P = i / ROWS, first = (size_t) s->first[P], k = first;
        const double *row = s->L + s->start[P] + i % ROWS * width (s, P) - first;
        four sum = { 0 };
        for (; k + 4 <= i; k += 4) sum += *(const four *) (row + k) * *(const four *) (y + k);
        double rest = sum_of (&sum);
        for (; k < i; k++) rest += row[k] * y[k];
        y[i] = (y[i] - rest) * s->inverse[i];
    }
    for (size_t i = s->npanel * ROWS; i-- > 0;) {
        size_t P = i / ROWS, first = (size_t) s->first[P], k = first;
        const double *row = s->L + s->start[P] + i % ROWS * width (s, P) - first;
        double x = y[i] *= s->inverse[i];
        for (; k + 4 <= i; k += 4) *(four *) (y + k) -= x * *(const four *) (row + k);
        for (; k < i; k++) y[k] -= x * row[k];
    }
}

static pg_status skyline_solve (void *self, size_t nrhs, const double *b, double *x)
{
    skyline *s = self;
    for (size_t r = 0; r < nrhs; r++) {
        memset (s->y, 0, s->npanel * ROWS * sizeof *s->y);
        for (size_t i = 0; i < s->n; i++) s->y[s->place[i]] = b[r * s->n + i];
        substitute (s, s->y);
        for (size_t i = 0; i < s->n; i++) x[r * s->n + i] = s->y[s->place[i]];
    }
    return PG_OK;
}

const pg_linear_type pg_linear_skyline = {
    "skyline", "Cholesky factorization within an envelope, for small systems; needs no library", 1, 1,
    skyline_analyse, skyline_factor, skyline_solve, NULL, NULL,
    skyline_info, skyline_free, NULL
};
