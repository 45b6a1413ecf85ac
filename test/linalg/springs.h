/* SPDX-License-Identifier: GPL-3.0-or-later
 * springs.h: points joined by springs: places, couplings, the operator, the matrix; some unknowns held,
 * springs over a cut left out. */
#ifndef PERIGAL_TEST_SPRINGS_H
#define PERIGAL_TEST_SPRINGS_H
#include "systems.h"

typedef struct {
    /* block 1: scalar springs; dim: along the line between the points; dim + 1: and turns */
    int     dim, block;
    size_t  n, ndof, widest;
    double *x, spacing, reach;
    size_t *start;  int *node;                         /* couplings, the point itself last */
    double *value;
    unsigned char *fixed;
    pg_operator op;
    size_t  products;
} springs;

static inline void springs_apply (void *context, const double *x, double *y)
{
    springs *s = context;
    size_t block = (size_t) s->block;
    s->products++;
    for (size_t i = 0; i < s->n; i++)
        for (size_t a = 0; a < block; a++) {
            y[i * block + a] = 0;
            for (size_t e = s->start[i]; e < s->start[i + 1]; e++)
                for (size_t c = 0; c < block; c++)
                    y[i * block + a] += s->value[(e * block + a) * block + c]
                                        * x[(size_t) s->node[e] * block + c];
        }
}

/* Of the same with the prescribed unknowns left out. */
static inline void springs_apply_free (void *context, const double *x, double *y)
{
    springs *s = context;
    springs_apply (s, x, y);
    for (size_t i = 0; i < s->ndof; i++) if (s->fixed[i]) y[i] = 0;
}

static inline void springs_diagonal (void *context, double *d)
{
    springs *s = context;
    size_t block = (size_t) s->block;
    for (size_t i = 0; i < s->n; i++)
        for (size_t a = 0; a < block; a++)
            d[i * block + a] = s->value[((s->start[i + 1] - 1) * block + a) * block + a];
}

static inline size_t springs_row (void *context, size_t i, int thread, int *node, double *value)
{
    springs *s = context;
    (void) thread;
    size_t first = s->start[i], m = s->start[i + 1] - first, bb = (size_t) (s->block * s->block);
    memcpy (node, s->node + first, m * sizeof *node);
    if (value) memcpy (value, s->value + first * bb, m * bb * sizeof *value);
    return m;
}

/* Point with all springs of a lattice and with no cut near: rows the same. */
static inline int springs_whole (void *context, size_t i)
{
    springs *s = context;
    return s->start[i + 1] - s->start[i] == s->widest;
}

typedef struct {
    int dim, block;
    size_t side[3];
    double shake;  /* share of the spacing by which points move at random */
    double reach;                                      /* in spacings */
    int (*cut) (const double *a, const double *b);     /* no spring between these; NULL: all */
    int (*held) (const double *x);                     /* 1: all unknowns are prescribed, 2: the first */
} springs_rule;

static inline void springs_free (springs *s)
{
    pg_free (s->x), pg_free (s->start), pg_free (s->node), pg_free (s->value), pg_free (s->fixed);
}

/* Pair block k (e x e + share of 1), in the unknowns beyond dim the share alone. */
static inline void spring_block (const springs *s, const double *xi, double r, double *B)
{
    for (int a = 0; a < s->block; a++)
        for (int c = 0; c < s->block; c++) {
            double along = a < s->dim && c < s->dim && s->block > 1 ? xi[a] * xi[c] / (r * r) : 0;
            B[a * s->block + c] = along / r + (a == c ? (s->block == 1 || a >= s->dim ? 1 : 1e-3) / r : 0);
        }
}

static inline springs springs_of (const springs_rule *rule)
{
    springs s = { .dim = rule->dim, .block = rule->block, .n = 1, .spacing = 1, .reach = rule->reach };
    size_t dim = (size_t) rule->dim, bb = (size_t) (rule->block * rule->block), cap = 1;
    for (size_t k = 0; k < dim; k++)
        s.n *= rule->side[k], cap *= 2 * (size_t) ceil (rule->reach + 2 * rule->shake) + 1;
    s.ndof = s.n * (size_t) s.block;
    s.x = pg_calloc (s.n * dim, sizeof *s.x), s.start = pg_calloc (s.n + 1, sizeof *s.start),
    s.fixed = pg_calloc (s.ndof, 1);
    s.node = pg_calloc (s.n * cap, sizeof *s.node), s.value = pg_calloc (s.n * cap * bb, sizeof *s.value);
    assert_true (s.x && s.start && s.fixed && s.node && s.value);
    for (size_t i = 0, rest; i < s.n; i++) {
        rest = i;
        for (size_t k = 0; k < dim; k++)
            s.x[i * dim + k] = (double) (rest % rule->side[k])
                               + (rule->shake > 0 ? rule->shake * random_number () : 0),
                          rest /= rule->side[k];
        int held = rule->held ? rule->held (s.x + i * dim) : 0;
        for (size_t k = 0; k < (size_t) s.block; k++)
            s.fixed[i * (size_t) s.block + k] = held == 1 || (held == 2 && k == 0);
    }
    for (size_t i = 0; i < s.n; i++) {
        size_t at = s.start[i];
        double own[36] = { 0 };
        int low[3] = { 0 }, high[3] = { 0 }, far = (int) ceil (rule->reach + 2 * rule->shake);
        for (size_t k = 0, rest = i; k < dim; k++) {
            int here = (int) (rest % rule->side[k]), last = (int) rule->side[k] - 1;
            low[k] = here > far ? here - far : 0, high[k] = here + far < last ? here + far : last,
            rest /= rule->side[k];
        }
        for (int z = low[2]; z <= high[2]; z++)
            for (int y = low[1]; y <= high[1]; y++)
                for (int x = low[0]; x <= high[0]; x++) {
                    size_t j = ((size_t) z * (dim > 1 ? rule->side[1] : 1) + (size_t) y) * rule->side[0]
                               + (size_t) x;
                    double xi[3] = { 0 }, r = 0, *B = s.value + at * bb;
                    for (size_t k = 0; k < dim; k++)
                        xi[k] = s.x[j * dim + k] - s.x[i * dim + k], r += xi[k] * xi[k];
                    r = sqrt (r);
                    if (j == i || r > rule->reach || (rule->cut && rule->cut (s.x + i * dim, s.x + j * dim)))
                        continue;
                    spring_block (&s, xi, r, B);
                    for (size_t q = 0; q < bb; q++) own[q] += B[q], B[q] = -B[q];
                    s.node[at++] = (int) j;
                }
        memcpy (s.value + at * bb, own, bb * sizeof *own);
        s.node[at++] = (int) i;
        s.start[i + 1] = at;
        if (at - s.start[i] > s.widest) s.widest = at - s.start[i];
    }
    return s;
}

/* Operator and setting keep the address. */
static inline pg_multilevel_setting springs_setting (springs *s, int threads)
{
    s->op = (pg_operator) { s->ndof, s, springs_apply, springs_diagonal };
    return (pg_multilevel_setting){
        .dim = s->dim,
        .block = s->block,
        .threads = threads,
        .n = s->n,
        .x = s->x,
        .fixed = s->fixed,
        .A = &s->op,
        .rows = { .context = s, .widest = s->widest, .reach = s->reach, .row = springs_row }
    };
}

/* Upper triangle; prescribed unknowns: identity. */
static inline pg_sparse springs_matrix (const springs *s)
{
    pg_sparse A;
    size_t block = (size_t) s->block;
    long at = 0;
    check_ok (pg_sparse_create (&A, s->ndof, s->ndof, s->start[s->n] * block * block, 1));
    for (size_t i = 0; i < s->n; i++)
        for (size_t c = 0; c < block; c++) {
            for (size_t e = s->start[i]; e < s->start[i + 1]; e++) {
                size_t j = (size_t) s->node[e];
                for (size_t a = 0; a < block && j * block + a <= i * block + c; a++) {
                    int out = s->fixed[j * block + a] || s->fixed[i * block + c];
                    A.row[at] = (long) (j * block + a);
                    A.value[at++] = out ? j * block + a == i * block + c
                                        : s->value[(e * block + c) * block + a];
                }
            }
            A.start[i * block + c + 1] = at;
        }
    return A;
}
#endif
