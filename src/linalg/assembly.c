/* SPDX-License-Identifier: GPL-3.0-or-later
 * Assembly of a symmetric matrix of dense node blocks, K_IJ = sum over sources and their points p of the
 * blocks K_ab (p) with a, b the local numbers of I, J in p.
 *
 * The pattern is found once: nodes I and J are coupled if some point has both in its list. Values are
 * gathered row by row: the row of node I collects from all points that have I (by the inverse lists), in the
 * same order every time. Hence no two threads write to the same place, the sums do not depend on the number
 * of threads, and a few rows can be redone after bonds broke with the same bits as in a new assembly. The
 * price is that the blocks of a point are computed row by row. */
#include "perigal/linalg.h"
#include "wide.h"
#include <stdint.h>
#include <string.h>

/* Inverse of the lists of nodes of all points: for each node the points whose list has it, and its local
 * number in each list. Numbers have 32 bits, as those of nodes: the arrays are as long as there are bonds. */
typedef struct { size_t *start; uint32_t *point, *local; } inverse;

struct pg_assembly {
    /* Numbers of nodes and of sources; the most nodes in the list of one point. */
    size_t     n, nsource, widest;
    /* Unknowns per node. */
    int        block;
    pg_assembly_source *source;
    /* Inverse list of each source. */
    inverse   *inverse;
    /* For each node I the coupled nodes J <= I, ascending. */
    pg_adjacency lower;
    /* The matrix, upper triangle: column I of blocks holds the rows J <= I. */
    pg_sparse  K;
};

/* Inverts the list of n nodes; points of each node in ascending order. */
static pg_status invert (inverse *out, const pg_adjacency *seen, size_t n)
{
    pg_status status = PG_OK;
    size_t nnz = seen->start[seen->n], *fill = NULL;
    if (seen->n > UINT32_MAX) PG_FAIL (PG_E_LIMIT, "%zu points are too many for a matrix", seen->n);
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (out->point, nnz);
    PG_ALLOC (out->local, nnz);
    PG_ALLOC (fill, n);
    for (size_t e = 0; e < nnz; e++) out->start[seen->node[e] + 1]++;
    for (size_t I = 0; I < n; I++) out->start[I + 1] += out->start[I], fill[I] = out->start[I];
    for (size_t p = 0; p < seen->n; p++)
        for (size_t e = seen->start[p]; e < seen->start[p + 1]; e++) {
            size_t k = fill[seen->node[e]]++;
            out->point[k] = (uint32_t) p, out->local[k] = (uint32_t) (e - seen->start[p]);
        }
done:
    pg_free (fill);
    return status;
}

/* Adds to the `count` neighbours of I those of n nodes that are not among them yet (mark[J] = I + 1: J is).
 * Returns their new number; list NULL: only counts. */
static size_t add_nodes (size_t I, size_t n, const int *node, size_t *mark, size_t count, int *list)
{
    for (size_t b = 0; b < n; b++) {
        int J = node[b];
        if (mark[J] == I + 1) continue;
        mark[J] = I + 1;
        if (list) list[count] = J;
        count++;
    }
    return count;
}

/* Counts (node NULL) or lists the nodes J <= I that share a point with I. As the nodes of a point ascend,
 * those up to its local number suffice. */
static size_t neighbours (const pg_assembly *K, size_t I, size_t *mark, int *node)
{
    size_t count = 0;
    for (size_t s = 0; s < K->nsource; s++) {
        const pg_adjacency *f = K->source[s].seen, *known = K->source[s].known ? &K->source[s].known->lower
                                                                               : NULL;
        if (known)
            count = add_nodes (I, known->start[I + 1] - known->start[I], known->node + known->start[I], mark,
                               count, node);
        for (size_t k = K->inverse[s].start[I]; !known && k < K->inverse[s].start[I + 1]; k++)
            count = add_nodes (I, K->inverse[s].local[k] + 1,
                               f->node + f->start[K->inverse[s].point[k]], mark, count, node);
    }
    /* A node that is in no list is coupled with itself, so that the matrix has a full diagonal. */
    if (mark[I] != I + 1) {
        if (node) node[count] = (int) I;
        count++;
    }
    return count;
}

/* Shell sort: the lists are sequences of sorted runs. */
static void sort_nodes (int *a, size_t n)
{
    static const size_t gaps[] = { 301, 132, 57, 23, 10, 4, 1 };
    for (size_t g = 0; g < sizeof gaps / sizeof *gaps; g++)
        for (size_t i = gaps[g]; i < n; i++) {
            int v = a[i];
            size_t j = i;
            for (; j >= gaps[g] && a[j - gaps[g]] > v; j -= gaps[g]) a[j] = a[j - gaps[g]];
            a[j] = v;
        }
}

/* Fills K->lower: counts, allocates, lists. */
static pg_status couple (pg_assembly *K)
{
    pg_status status = PG_OK;
    size_t *mark = NULL;
    PG_ALLOC (mark, K->n);
    PG_ALLOC (K->lower.start, K->n + 1);
    K->lower.n = K->n;
    for (size_t I = 0; I < K->n; I++)
        K->lower.start[I + 1] = K->lower.start[I] + neighbours (K, I, mark, NULL);
    PG_ALLOC (K->lower.node, K->lower.start[K->n]);
    memset (mark, 0, K->n * sizeof *mark);
    for (size_t I = 0; I < K->n; I++) {
        int *list = K->lower.node + K->lower.start[I];
        sort_nodes (list, neighbours (K, I, mark, list));
    }
done:
    pg_free (mark);
    return status;
}

/* Pattern of the matrix of unknowns; of the diagonal blocks the upper triangle only. */
static pg_status pattern (pg_assembly *K)
{
    pg_status status = PG_OK;
    size_t nnz = 0, m = (size_t) K->block;
    PG_TRY (couple (K));
    /* Blocks off the diagonal are full, those on it triangular. */
    nnz = (K->lower.start[K->n] - K->n) * m * m + K->n * m * (m + 1) / 2;
    PG_TRY (pg_sparse_create (&K->K, K->n * m, K->n * m, nnz, 1));
    long at = 0;
    for (size_t I = 0; I < K->n; I++)
        for (size_t beta = 0; beta < m; beta++) {
            K->K.start[I * m + beta] = at;
            for (size_t k = K->lower.start[I]; k < K->lower.start[I + 1]; k++)
                for (size_t alpha = 0; alpha < m; alpha++)
                    if ((size_t) K->lower.node[k] < I || alpha <= beta)
                        K->K.row[at++] = (long) ((size_t) K->lower.node[k] * m + alpha);
        }
    K->K.start[K->n * m] = at;
done:
    return status;
}

/* Copies the sources and inverts their lists; no pattern yet. */
static pg_status create (pg_assembly **out, size_t n, int block, size_t nsource,
                         const pg_assembly_source *sources)
{
    pg_status status = PG_OK;
    pg_assembly *K = NULL;
    PG_ALLOC (K, 1);
    K->n = n, K->block = block, K->nsource = nsource;
    PG_ALLOC (K->source, nsource);
    PG_ALLOC (K->inverse, nsource);
    for (size_t s = 0; s < nsource; s++) {
        const pg_adjacency *f = sources[s].seen;
        K->source[s] = sources[s];
        PG_TRY (invert (&K->inverse[s], f, n));
        for (size_t p = 0; p < f->n; p++)
            if (f->start[p + 1] - f->start[p] > K->widest) K->widest = f->start[p + 1] - f->start[p];
    }
    *out = K;
    K = NULL;
done:
    pg_assembly_free (&K);
    return status;
}

/* Finds the pattern alone; values come by pg_assembly_gather. */
pg_status pg_assembly_create (pg_assembly **out, size_t n, int block, size_t nsource,
                               const pg_assembly_source *sources)
{
    pg_status status = PG_OK;
    pg_assembly *K = NULL;
    PG_TRY (create (&K, n, block, nsource, sources));
    PG_TRY (pattern (K));
    *out = K;
    K = NULL;
done:
    pg_assembly_free (&K);
    return status;
}

/* The couplings `lower` are copied as the columns of the graph. */
pg_status pg_assembly_graph (pg_sparse *out, size_t n, size_t nlist, const pg_adjacency *const *lists)
{
    pg_status status = PG_OK;
    pg_assembly *K = NULL;
    pg_assembly_source *source = NULL;
    PG_ALLOC (source, nlist);
    for (size_t s = 0; s < nlist; s++) source[s].seen = lists[s];
    PG_TRY (create (&K, n, 1, nlist, source));
    PG_TRY (couple (K));
    *out = (pg_sparse) { .nrow = n, .ncol = n, .symmetric = 1 };
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (out->row, K->lower.start[n]);
    for (size_t I = 0; I <= n; I++) out->start[I] = (long) K->lower.start[I];
    for (size_t e = 0; e < K->lower.start[n]; e++) out->row[e] = K->lower.node[e];
done:
    if (status != PG_OK) pg_sparse_clear (out);
    pg_assembly_free (&K);
    pg_free (source);
    return status;
}

/* The list of a node holds the nodes that it is coupled with: nothing has to be inverted. */
pg_status pg_assembly_graph_pairwise (pg_sparse *out, const pg_adjacency *f)
{
    pg_status status = PG_OK;
    size_t count = f->n;
    for (size_t i = 0; i < f->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) count += (size_t) f->node[e] < i;
    *out = (pg_sparse) { .nrow = f->n, .ncol = f->n, .symmetric = 1 };
    PG_ALLOC (out->start, f->n + 1);
    PG_ALLOC (out->row, count);
    count = 0;
    for (size_t i = 0; i < f->n; i++) {
        for (size_t e = f->start[i]; e < f->start[i + 1] && (size_t) f->node[e] < i; e++)
            out->row[count++] = f->node[e];
        out->row[count++] = (long) i;
        out->start[i + 1] = (long) count;
    }
done:
    if (status != PG_OK) pg_sparse_clear (out);
    return status;
}

void pg_assembly_settle (pg_assembly *K)
{
    for (size_t s = 0; K->inverse && s < K->nsource; s++) {
        inverse *v = &K->inverse[s];
        pg_free (v->start), pg_free (v->point), pg_free (v->local);
    }
    pg_free (K->inverse), pg_free (K->source), pg_free (K->K.row);
    K->inverse = NULL, K->source = NULL, K->nsource = 0, K->K.row = NULL;
}

void pg_assembly_free (pg_assembly **K)
{
    if (!*K) return;
    pg_assembly_settle (*K);
    pg_free ((*K)->lower.start), pg_free ((*K)->lower.node);
    pg_sparse_clear (&(*K)->K);
    pg_free (*K);
    *K = NULL;
}

pg_sparse *pg_assembly_matrix (pg_assembly *K) { return &K->K; }

/* ---- gather -------------------------------------------------------------------------------------------- */
/* Workspaces of a thread: position of each node in the present row (n), blocks of one point, and the summed
 * block row of a source that gives block rows. */
typedef struct { size_t *slot; double *blocks, *sum; } workspace;
/* Workspaces of all threads, one after the other: n, nblocks, nsum numbers each. list: rows (NULL: all). */
typedef struct {
    pg_assembly *K;
    const int *list;
    size_t *slot, nblocks, nsum;
    double *blocks, *sum;
} gathering;

/* Adds block (I, J), row-major m x m, transposed into the columns of node I; `slot` is the place of J among
 * the block rows of these columns. */
static void add_block (pg_assembly *K, size_t I, size_t J, size_t slot, const double *block)
{
    size_t m = (size_t) K->block;
    for (size_t beta = 0; beta < m; beta++) {
        double *column = K->K.value + K->K.start[I * m + beta] + slot * m;
        size_t top = J == I ? beta + 1 : m;
        for (size_t alpha = 0; alpha < top; alpha++) column[alpha] += block[beta * m + alpha];
    }
}

/* to (n) += from (n), four at a time. */
static inline __attribute__ ((always_inline)) void add_numbers (size_t n, const double *from, double *to)
{
    size_t k = 0;
    for (; k + 4 <= n; k += 4) *(four *) (to + k) += *(const four *) (from + k);
    for (; k < n; k++) to[k] += from[k];
}

/* Adds the block row of a point for its first m nodes (`part`) to rows of `wide` numbers (`sum`): nodes with
 * consecutive slots are added in one go. */
PG_WIDE static void add_rows (size_t block, size_t m, const int *node, const size_t *slot,
                              const double *part, size_t wide, double *sum)
{
    for (size_t b = 0, end; b < m; b = end) {
        size_t to = slot[node[b]];
        for (end = b + 1; end < m && slot[node[end]] == to + (end - b);) end++;
        for (size_t beta = 0; beta < block; beta++)
            add_numbers ((end - b) * block, part + (beta * m + b) * block, sum + beta * wide + to * block);
    }
}

/* Adds to the columns of node I the contribution of a source that gives block rows; of the last block, which
 * couples I with itself, only the upper triangle. */
static void gather_sums (pg_assembly *K, size_t source, size_t I, const workspace *w)
{
    const pg_assembly_source *s = &K->source[source];
    const inverse *v = &K->inverse[source];
    size_t m = (size_t) K->block, count = K->lower.start[I + 1] - K->lower.start[I], wide = count * m;
    if (v->start[I] == v->start[I + 1]) return;
    memset (w->sum, 0, m * wide * sizeof *w->sum);
    for (size_t k = v->start[I]; k < v->start[I + 1]; k++) {
        size_t p = v->point[k], a = v->local[k];
        memset (w->blocks, 0, (a + 1) * m * m * sizeof *w->blocks);
        s->rows (s->context, p, a, a + 1, w->blocks);
        add_rows (m, a + 1, s->seen->node + s->seen->start[p], w->slot, w->blocks, wide, w->sum);
    }
    if (s->finish) s->finish (s->context, count, w->sum);
    for (size_t beta = 0; beta < m; beta++) {
        double *column = K->K.value + K->K.start[I * m + beta];
        for (size_t k = 0; k < wide - m + beta + 1; k++) column[k] += w->sum[beta * wide + k];
    }
}

/* Adds the columns of node I of another assembly, `known`, whose couplings are among those of K. */
static void add_known (pg_assembly *K, const pg_assembly *known, size_t I, const size_t *slot)
{
    size_t m = (size_t) K->block, from = known->lower.start[I], count = known->lower.start[I + 1] - from;
    for (size_t beta = 0; beta < m; beta++) {
        const double *value = known->K.value + known->K.start[I * m + beta];
        double *column = K->K.value + K->K.start[I * m + beta];
        for (size_t k = 0; k < count; k++) {
            size_t J = (size_t) known->lower.node[from + k], top = J == I ? beta + 1 : m;
            for (size_t alpha = 0; alpha < top; alpha++)
                column[slot[J] * m + alpha] += value[k * m + alpha];
        }
    }
}

/* Adds the blocks of all points of a source to the columns of node I. */
static void gather_blocks (pg_assembly *K, size_t source, size_t I, const workspace *w)
{
    const pg_assembly_source *s = &K->source[source];
    const inverse *v = &K->inverse[source];
    size_t mm = (size_t) (K->block * K->block);
    for (size_t k = v->start[I]; k < v->start[I + 1]; k++) {
        size_t p = v->point[k], a = v->local[k];
        const int *node = s->seen->node + s->seen->start[p];
        memset (w->blocks, 0, (a + 1) * mm * sizeof *w->blocks);
        s->blocks (s->context, p, a, a + 1, w->blocks);
        for (size_t b = 0; b <= a; b++)
            add_block (K, I, (size_t) node[b], w->slot[node[b]], w->blocks + b * mm);
    }
}

/* Computes the columns of node I anew: sources, and points within a source, in their order. */
static void gather_row (pg_assembly *K, size_t I, const workspace *w)
{
    size_t m = (size_t) K->block;
    memset (K->K.value + K->K.start[I * m], 0,
            (size_t) (K->K.start[(I + 1) * m] - K->K.start[I * m]) * sizeof (double));
    for (size_t k = K->lower.start[I]; k < K->lower.start[I + 1]; k++)
        w->slot[K->lower.node[k]] = k - K->lower.start[I];
    for (size_t s = 0; s < K->nsource; s++) {
        if (K->source[s].known) add_known (K, K->source[s].known, I, w->slot);
        else if (K->source[s].rows) gather_sums (K, s, I, w);
        else gather_blocks (K, s, I, w);
    }
}

/* The rows first .. last - 1 of the list. */
static void gather (void *context, size_t first, size_t last, int thread)
{
    const gathering *g = context;
    size_t t = (size_t) thread;
    workspace w = { g->slot + t * g->K->n, g->blocks + t * g->nblocks, g->sum + t * g->nsum };
    for (size_t k = first; k < last; k++) gather_row (g->K, g->list ? (size_t) g->list[k] : k, &w);
}

/* Returns how many numbers the longest block row of K has; 0 if no source gives block rows. */
static size_t longest_sum (const pg_assembly *K)
{
    size_t most = 0;
    int summed = 0;
    for (size_t s = 0; s < K->nsource; s++) summed |= K->source[s].rows != NULL;
    for (size_t I = 0; I < K->n && summed; I++) {
        size_t count = K->lower.start[I + 1] - K->lower.start[I];
        most = count > most ? count : most;
    }
    return most * (size_t) (K->block * K->block);
}

/* Each thread needs a map from nodes to places in a row, and room for the blocks of one point. */
pg_status pg_assembly_gather (pg_assembly *K, size_t count, const int *list, int threads)
{
    pg_status status = PG_OK;
    gathering g = { .K = K, .list = list, .nsum = longest_sum (K),
                    .nblocks = (K->widest + 1) * (size_t) (K->block * K->block) };
    if (threads < 1 || count < 64) threads = 1;
    PG_ALLOC (g.slot, (size_t) threads * K->n);
    PG_ALLOC (g.blocks, (size_t) threads * g.nblocks);
    PG_ALLOC (g.sum, (size_t) threads * g.nsum + 1);
    pg_parallel (threads, count, gather, &g);
    for (size_t s = 0; !list && s < K->nsource; s++) K->source[s].known = NULL;
done:
    pg_free (g.slot), pg_free (g.blocks), pg_free (g.sum);
    return status;
}
