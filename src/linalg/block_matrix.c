/* SPDX-License-Identifier: GPL-3.0-or-later
 * Symmetric matrices of dense node blocks that are sums of small element matrices, kept by rows with both
 * triangles. They serve preconditioners only, so that values are kept as float (7 digits): half the memory,
 * and half the time of a product, which the memory bounds. Sums of a product are taken as double.
 *
 * The pattern of row i is the union of the nodes of all elements that contain node i, ascending. */
#include "perigal/linalg.h"
#include "alike.h"
#include "wide.h"
#include <string.h>

/* Most unknowns of a node; alike rows that are multiplied at a time; least rows of a run of alike rows. */
enum { MOST_BLOCK = 6, LANES = 8, LEAST = 3 };

void pg_block_clear (pg_block_matrix *A)
{
    pg_free (A->start), pg_free (A->node), pg_free (A->value);
    pg_free (A->alike.run), pg_free (A->model), pg_free (A->model_at);
    for (int k = 0; k < MOST_BLOCK; k++) pg_free (A->part[k]);
    memset (A, 0, sizeof *A);
}

/* ---- pattern ------------------------------------------------------------------------------------------- */
/* Elements of each node: element[of[i]] to element[of[i + 1] - 1] for node i; a list of nodes for each
 * thread. */
typedef struct {
    pg_block_matrix *A;
    const pg_adjacency *elements;
    size_t *of;
    int    *element;
    int   **list;
} pattern;

/* Sorts a short list and drops repeated numbers: by insertion, as most of it comes in ascending pieces.
 * Returns how many numbers are left. */
static size_t sort_unique (int *a, size_t n)
{
    size_t m = 0;
    for (size_t i = 0; i < n; i++) {
        int x = a[i];
        size_t j = m;
        while (j > 0 && a[j - 1] > x) j--;
        if (j > 0 && a[j - 1] == x) continue;
        memmove (a + j + 1, a + j, (m - j) * sizeof *a);
        a[j] = x, m++;
    }
    return m;
}

/* Lists the nodes of row i, ascending; returns their number. */
static size_t collect (const pattern *p, size_t i, int *out)
{
    const pg_adjacency *e = p->elements;
    size_t m = 0;
    for (size_t k = p->of[i]; k < p->of[i + 1]; k++) {
        size_t c = (size_t) p->element[k], count = e->start[c + 1] - e->start[c];
        memcpy (out + m, e->node + e->start[c], count * sizeof *out);
        m += count;
    }
    return sort_unique (out, m);
}

/* Counts the couplings of each node. */
static void count_rows (void *context, size_t first, size_t last, int thread)
{
    const pattern *p = context;
    for (size_t i = first; i < last; i++) p->A->start[i + 1] = collect (p, i, p->list[thread]);
}

/* Writes the couplings of each node, once A->start says where. */
static void fill_rows (void *context, size_t first, size_t last, int thread)
{
    const pattern *p = context;
    for (size_t i = first; i < last; i++) {
        size_t m = collect (p, i, p->list[thread]);
        memcpy (p->A->node + p->A->start[i], p->list[thread], m * sizeof (int));
    }
}

/* Finds the elements of each node, ascending; returns the most nodes that one row can have. */
static size_t invert (pattern *p, size_t n)
{
    const pg_adjacency *e = p->elements;
    size_t most = 0;
    for (size_t k = 0; k < e->start[e->n]; k++) p->of[e->node[k] + 1]++;
    for (size_t i = 0; i < n; i++) p->of[i + 1] += p->of[i];
    for (size_t c = e->n; c-- > 0;)
        for (size_t k = e->start[c]; k < e->start[c + 1]; k++) {
            size_t i = (size_t) e->node[k];
            p->element[--p->of[i + 1]] = (int) c;
        }
    /* of[i + 1] is now where the list of i begins */
    memmove (p->of, p->of + 1, n * sizeof *p->of);
    p->of[n] = e->start[e->n];
    for (size_t i = 0; i < n; i++) {
        size_t m = 0;
        for (size_t k = p->of[i]; k < p->of[i + 1]; k++)
            m += e->start[p->element[k] + 1] - e->start[p->element[k]];
        if (m > most) most = m;
    }
    return most;
}

pg_status pg_block_create (pg_block_matrix *A, size_t n, int block, const pg_adjacency *elements, int threads)
{
    pg_status status = PG_OK;
    pattern p = { .A = A, .elements = elements };
    if (threads < 1) threads = 1;
    memset (A, 0, sizeof *A);
    A->n = n, A->block = block, A->threads = threads;
    PG_ALLOC (A->start, n + 1);
    PG_ALLOC (p.of, n + 2);
    PG_ALLOC (p.element, elements->start[elements->n]);
    PG_ALLOC (p.list, (size_t) threads);
    size_t most = invert (&p, n);
    for (int t = 0; t < threads; t++) PG_ALLOC (p.list[t], most);
    pg_parallel (threads, n, count_rows, &p);
    for (size_t i = 0; i < n; i++) {
        if (A->start[i + 1] > A->widest) A->widest = A->start[i + 1];
        A->start[i + 1] += A->start[i];
    }
    PG_ALLOC (A->node, A->start[n]);
    PG_ALLOC (A->value, A->start[n] * (size_t) (block * block));
    pg_parallel (threads, n, fill_rows, &p);
done:
    for (int t = 0; p.list && t < threads; t++) pg_free (p.list[t]);
    pg_free (p.list), pg_free (p.of), pg_free (p.element);
    if (status != PG_OK) pg_block_clear (A);
    return status;
}

/* ---- values -------------------------------------------------------------------------------------------- */
/* Returns the index of the coupling of row i with node j, which is in the pattern. */
static size_t place (const pg_block_matrix *A, size_t i, int j)
{
    size_t low = A->start[i], high = A->start[i + 1];
    while (high - low > 1) {
        size_t middle = (low + high) / 2;
        if (A->node[middle] <= j) low = middle;
        else high = middle;
    }
    return low;
}

/* A block and its mirror image get the same sums: K has equal bits there, and elements come in one order. */
void pg_block_add (pg_block_matrix *A, size_t m, const int *node, const double *K)
{
    size_t block = (size_t) A->block, width = m * block;
    for (size_t a = 0; a < m; a++)
        for (size_t b = 0; b < m; b++) {
            float *to = A->value + place (A, (size_t) node[a], node[b]) * block * block;
            for (size_t r = 0; r < block; r++)
                for (size_t c = 0; c < block; c++)
                    to[r * block + c] += (float) K[(a * block + r) * width + b * block + c];
        }
}

/* A node that no element contains has no row, and nothing can be added to it. */
void pg_block_add_diagonal (pg_block_matrix *A, size_t unknown, double value)
{
    size_t block = (size_t) A->block, i = unknown / block, k = unknown % block;
    if (A->start[i] == A->start[i + 1]) return;
    A->value[place (A, i, (int) i) * block * block + k * block + k] += (float) value;
}

/* ---- products ------------------------------------------------------------------------------------------ */
typedef struct { const pg_block_matrix *A; const double *x; double *y; } product;

/* y += v x with one 3 x 3 block v, row-major. */
static void add_block (const float *v, const double *x, double *y)
{
    for (int a = 0; a < 3; a++, v += 3)
        y[a] += (double) v[0] * x[0] + (double) v[1] * x[1] + (double) v[2] * x[2];
}

/* y = A x for the rows first .. last - 1 of a matrix of 3 x 3 blocks. */
PG_WIDE static void multiply_solid (const pg_block_matrix *A, const double *x, double *y, size_t first,
                                 size_t last)
{
    for (size_t i = first; i < last; i++) {
        four s0 = { 0 }, s1 = { 0 }, s2 = { 0 };
        const float *v = A->value + A->start[i] * 9;
        size_t e = A->start[i], end = A->start[i + 1];
        for (; e + 1 < end; e++, v += 9) {
            four d = *(const four *) (x + 3 * (size_t) A->node[e]);
            s0 += __builtin_convertvector (*(const four_floats *) v, four) * d;
            s1 += __builtin_convertvector (*(const four_floats *) (v + 3), four) * d;
            s2 += __builtin_convertvector (*(const four_floats *) (v + 6), four) * d;
        }
        double *to = y + 3 * i;
        to[0] = three_lanes (&s0), to[1] = three_lanes (&s1), to[2] = three_lanes (&s2);
        if (e < end) add_block (v, x + 3 * (size_t) A->node[e], to);
    }
}

/* y = A x for the rows first .. last - 1, one by one; 2 x 2 blocks are written out. */
static void multiply_rows (const product *w, size_t first, size_t last)
{
    const pg_block_matrix *A = w->A;
    size_t block = (size_t) A->block, bb = block * block;
    if (block == 3) {
        multiply_solid (A, w->x, w->y, first, last);
        return;
    }
    for (size_t i = first; i < last; i++) {
        double y[MOST_BLOCK] = { 0 };
        const float *v = A->value + A->start[i] * bb;
        for (size_t e = A->start[i]; e < A->start[i + 1]; e++, v += bb) {
            const double *x = w->x + (size_t) A->node[e] * block;
            if (block == 2)
                y[0] += (double) v[0] * x[0] + (double) v[1] * x[1],
                    y[1] += (double) v[2] * x[0] + (double) v[3] * x[1];
            else
                for (size_t a = 0; a < block; a++)
                    for (size_t c = 0; c < block; c++) y[a] += (double) v[a * block + c] * x[c];
        }
        memcpy (w->y + i * block, y, block * sizeof *y);
    }
}

#define INLINE static inline __attribute__ ((always_inline))
/* y = A x for rows `from` to before `end` of run k, eight at a time: each lane is a row, and the results of
 * lanes beyond the last row are dropped. `block` is a constant for the compiler. */
INLINE void multiply_lanes (size_t block, const product *w, size_t k, size_t from, size_t end)
{
    const pg_block_matrix *A = w->A;
    size_t model = A->alike.run[k].first;
    double *const *x = A->part;
    for (size_t at = from; at < end; at += LANES) {
        const double *v = A->model + A->model_at[k];
        eight s0 = { 0 }, s1 = { 0 }, s2 = { 0 };
        for (size_t e = A->start[model]; e < A->start[model + 1]; e++, v += block * block) {
            size_t j = (size_t) A->node[e] + at;
            eight d0 = *(const eight *) (x[0] + j), d1 = *(const eight *) (x[1] + j);
            if (block == 2) {
                s0 += v[0] * d0 + v[1] * d1, s1 += v[2] * d0 + v[3] * d1;
                continue;
            }
            eight d2 = *(const eight *) (x[2] + j);
            s0 += v[0] * d0 + v[1] * d1 + v[2] * d2;
            s1 += v[3] * d0 + v[4] * d1 + v[5] * d2;
            s2 += v[6] * d0 + v[7] * d1 + v[8] * d2;
        }
        double *y = w->y + (model + at) * block;
        for (size_t lane = 0; lane < LANES && at + lane < end; lane++, y += block) {
            y[0] = s0[lane], y[1] = s1[lane];
            if (block == 3) y[2] = s2[lane];
        }
    }
}

PG_WIDEST static void multiply_alike (const product *w, size_t k, size_t from, size_t end)
{
    if (w->A->block == 3) multiply_lanes (3, w, k, from, end);
    else multiply_lanes (2, w, k, from, end);
}

/* y = A x for the rows first .. last - 1: runs of alike rows, as far as they lie in this range, and the rows
 * between runs. The result of a row does not depend on the range. */
static void multiply_range (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const product *w = context;
    const pg_row_runs *runs = &w->A->alike;
    for (size_t k = rows_alike_at (runs, first); k < runs->n && runs->run[k].first < last; k++) {
        const pg_row_run *r = &runs->run[k];
        size_t from = r->first > first ? r->first : first,
               end = r->first + r->count < last ? r->first + r->count : last;
        multiply_rows (w, first, from);
        multiply_alike (w, k, from - r->first, end - r->first);
        first = end;
    }
    multiply_rows (w, first, last);
}

/* Splits x into one vector for each unknown of a node. */
static void take_apart (void *context, size_t first, size_t last, int thread)
{
    const product *w = context;
    size_t block = (size_t) w->A->block;
    (void) thread;
    for (size_t c = 0; c < block; c++) {
        double *to = w->A->part[c];
        for (size_t i = first; i < last; i++) to[i] = w->x[i * block + c];
    }
}

static void multiply (void *context, const double *x, double *y)
{
    product w = { context, x, y };
    if (w.A->alike.n) pg_parallel (w.A->threads, w.A->n, take_apart, &w);
    pg_parallel (w.A->threads, w.A->n, multiply_range, &w);
}

/* Finds runs of alike rows and copies their numbers as double; only for two and three unknowns per node. */
pg_status pg_block_settle (pg_block_matrix *A)
{
    pg_status status = PG_OK;
    size_t bb = (size_t) (A->block * A->block), room = 0;
    if (A->block < 2 || A->block > 3) return PG_OK;
    PG_TRY (rows_alike (&A->alike, LEAST, A->n, A->start, A->node, A->value, bb));
    PG_ALLOC (A->model_at, A->alike.n + 1);
    for (size_t k = 0; k < A->alike.n; k++) {
        const size_t *start = A->start + A->alike.run[k].first;
        A->model_at[k + 1] = room += (start[1] - start[0]) * bb;
    }
    PG_ALLOC (A->model, room);
    for (size_t k = 0; k < A->alike.n; k++) {
        const float *from = A->value + A->start[A->alike.run[k].first] * bb;
        for (size_t q = A->model_at[k]; q < A->model_at[k + 1]; q++) A->model[q] = *from++;
    }
    for (int c = 0; c < A->block; c++) PG_ALLOC (A->part[c], A->n + LANES);
done:
    if (status != PG_OK) A->alike.n = 0;
    return status;
}

static void diagonal (void *context, double *d)
{
    const pg_block_matrix *A = context;
    size_t block = (size_t) A->block;
    for (size_t i = 0; i < A->n; i++) {
        size_t e = A->start[i] < A->start[i + 1] ? place (A, i, (int) i) : 0;
        for (size_t k = 0; k < block; k++)
            d[i * block + k] = A->start[i] < A->start[i + 1] ? A->value[e * block * block + k * (block + 1)]
                                                             : 0;
    }
}

pg_operator pg_block_operator (pg_block_matrix *A)
{
    return (pg_operator) { A->n * (size_t) A->block, A, multiply, diagonal };
}

/* Lists row i, for pg_couplings. Zero blocks couple nothing and are left out, so that parts of the body that
 * are not connected are recognised. */
static size_t row_of (void *context, size_t i, int thread, int *node, double *value)
{
    (void) thread;
    const pg_block_matrix *A = context;
    size_t bb = (size_t) (A->block * A->block), m = 0;
    for (size_t e = A->start[i]; e < A->start[i + 1]; e++) {
        const float *v = A->value + e * bb;
        size_t k = 0;
        while (k < bb && v[k] == 0) k++;
        if (k == bb) continue;
        node[m] = A->node[e];
        for (k = 0; value && k < bb; k++) value[m * bb + k] = v[k];
        m++;
    }
    return m;
}

pg_couplings pg_block_couplings (pg_block_matrix *A, double reach)
{
    return (pg_couplings) { .context = A, .widest = A->widest, .reach = reach, .row = row_of };
}
