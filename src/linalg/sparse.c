/* SPDX-License-Identifier: GPL-3.0-or-later
 * Sparse matrices by compressed columns: products y = A x and y = A' x, and the congruence B = T' A T that
 * eliminates constrained unknowns: with u = T q + u0, the unknowns q have the stiffness T' A T. */
#include "perigal/linalg.h"
#include <string.h>

pg_status pg_sparse_create (pg_sparse *out, size_t nrow, size_t ncol, size_t nnz, int symmetric)
{
    pg_status status = PG_OK;
    memset (out, 0, sizeof *out);
    out->nrow = nrow, out->ncol = ncol, out->symmetric = symmetric;
    PG_ALLOC (out->start, ncol + 1);
    PG_ALLOC (out->row, nnz);
    PG_ALLOC (out->value, nnz);
done:
    if (status != PG_OK) pg_sparse_clear (out);
    return status;
}

void pg_sparse_clear (pg_sparse *A)
{
    pg_free (A->start), pg_free (A->row), pg_free (A->value);
    memset (A, 0, sizeof *A);
}

/* In a symmetric matrix each stored entry above the diagonal acts twice; the part of the row of j that
 * comes from column j is summed apart, which keeps the order of additions fixed. */
void pg_sparse_multiply (const pg_sparse *A, const double *x, double *y)
{
    memset (y, 0, A->nrow * sizeof *y);
    for (size_t j = 0; j < A->ncol; j++) {
        double own = 0;
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            size_t i = (size_t) A->row[p];
            y[i] += A->value[p] * x[j];
            if (A->symmetric && i != j) own += A->value[p] * x[i];
        }
        if (A->symmetric) y[j] += own;
    }
}

/* A column of A is a row of A': products of columns need no storage of the transpose. */
void pg_sparse_multiply_transposed (const pg_sparse *A, const double *x, double *y)
{
    if (A->symmetric) {
        pg_sparse_multiply (A, x, y);
        return;
    }
    for (size_t j = 0; j < A->ncol; j++) {
        double sum = 0;
        for (long p = A->start[j]; p < A->start[j + 1]; p++) sum += A->value[p] * x[A->row[p]];
        y[j] = sum;
    }
}

static void apply (void *context, const double *x, double *y) { pg_sparse_multiply (context, x, y); }

/* Entries of the diagonal; zero where none is stored. */
static void diagonal (void *context, double *d)
{
    const pg_sparse *A = context;
    for (size_t j = 0; j < A->ncol; j++) {
        d[j] = 0;
        for (long p = A->start[j]; p < A->start[j + 1]; p++) if ((size_t) A->row[p] == j) d[j] += A->value[p];
    }
}

/* The context is the matrix itself. */
pg_operator pg_sparse_operator (pg_sparse *A) { return (pg_operator) { A->ncol, A, apply, diagonal }; }

/* ---- congruence --------------------------------------------------------------------------------------- */
/* Column k of B = T' A T: c = A T(:,k) is accumulated in a dense vector, then T' c for the columns of T
 * that share a row with it. R is T by rows: */
typedef struct { long *start, *row; double *value; } rows_view;

/* Makes R, T stored by rows: entries of row i are start[i] .. start[i + 1] - 1, columns ascending. */
static pg_status by_rows (rows_view *R, const pg_sparse *T)
{
    pg_status status = PG_OK;
    size_t nnz = (size_t) T->start[T->ncol];
    long *fill = NULL;
    PG_ALLOC (R->start, T->nrow + 1);
    PG_ALLOC (R->row, nnz);
    PG_ALLOC (R->value, nnz);
    PG_ALLOC (fill, T->nrow);
    for (size_t p = 0; p < nnz; p++) R->start[T->row[p] + 1]++;
    for (size_t i = 0; i < T->nrow; i++) R->start[i + 1] += R->start[i], fill[i] = R->start[i];
    for (size_t j = 0; j < T->ncol; j++)
        for (long p = T->start[j]; p < T->start[j + 1]; p++) {
            long q = fill[T->row[p]]++;
            R->row[q] = (long) j, R->value[q] = T->value[p];
        }
done:
    pg_free (fill);
    return status;
}

/* F = A with both triangles stored. An entry off the diagonal counts in two columns: lengths first, then
 * starts from their sums, then the entries; rows within a column are in no order. */
static pg_status both_triangles (pg_sparse *F, const pg_sparse *A)
{
    pg_status status = PG_OK;
    long *fill = NULL;
    PG_TRY (pg_sparse_create (F, A->nrow, A->ncol, 2 * (size_t) A->start[A->ncol], 0));
    PG_ALLOC (fill, A->ncol);
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            F->start[j + 1]++;
            if ((size_t) A->row[p] != j) F->start[A->row[p] + 1]++;
        }
    for (size_t j = 0; j < A->ncol; j++) F->start[j + 1] += F->start[j], fill[j] = F->start[j];
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            size_t i = (size_t) A->row[p];
            F->row[fill[j]] = (long) i, F->value[fill[j]++] = A->value[p];
            if (i != j) F->row[fill[i]] = (long) j, F->value[fill[i]++] = A->value[p];
        }
done:
    pg_free (fill);
    return status;
}

/* Workspace of one column: dense vectors c = A T(:,k) and b = T' c, the indices that are in use in them
 * (hit_c, hit_b; nc, nb of them), and flags for these (on_c, on_b). */
typedef struct {
    const pg_sparse *A, *T;
    const rows_view *R;
    double *c, *b;
    long *hit_c, *hit_b, nc, nb;
    char *on_c, *on_b;
} work;

/* Computes column k, rows up to k, into w->b at the rows w->hit_b. */
static void one_column (work *w, size_t k)
{
    w->nc = w->nb = 0;
    /* c = A T(:,k): only entries that T(:,k) reaches are touched. */
    for (long p = w->T->start[k]; p < w->T->start[k + 1]; p++) {
        long j = w->T->row[p];
        for (long q = w->A->start[j]; q < w->A->start[j + 1]; q++) {
            long i = w->A->row[q];
            if (!w->on_c[i]) w->on_c[i] = 1, w->hit_c[w->nc++] = i, w->c[i] = 0;
            w->c[i] += w->A->value[q] * w->T->value[p];
        }
    }
    /* b = T' c: rows of T ascend in their columns, and columns beyond k belong to the lower triangle. */
    for (long h = 0; h < w->nc; h++) {
        long i = w->hit_c[h];
        w->on_c[i] = 0;
        for (long q = w->R->start[i]; q < w->R->start[i + 1]; q++) {
            long m = w->R->row[q];
            if ((size_t) m > k) break;
            if (!w->on_b[m]) w->on_b[m] = 1, w->hit_b[w->nb++] = m, w->b[m] = 0;
            w->b[m] += w->R->value[q] * w->c[i];
        }
    }
    for (long h = 0; h < w->nb; h++) w->on_b[w->hit_b[h]] = 0;
}

/* Heap sort of n indices: never quadratic, no memory. */
static void sort_ascending (long *a, long n)
{
    for (long m = n / 2 - 1, top = n; top > 1;) {
        long root, value;
        if (m >= 0) root = m--, value = a[root];
        else root = 0, value = a[--top], a[top] = a[0];
        for (long child; (child = 2 * root + 1) < top; root = child) {
            if (child + 1 < top && a[child + 1] > a[child]) child++;
            if (a[child] <= value) break;
            a[root] = a[child];
        }
        a[root] = value;
    }
}

/* Does T select unknowns in their order: one entry 1 in each column, rows ascending? */
static int selects (const pg_sparse *T)
{
    int yes = (size_t) T->start[T->ncol] == T->ncol;
    for (size_t k = 0; k < T->ncol && yes; k++)
        yes = T->start[k] == (long) k && T->value[k] == 1 && (k == 0 || T->row[k] > T->row[k - 1]);
    return yes;
}

/* Do the rows of each column ascend? */
static int ascends (const pg_sparse *A)
{
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j] + 1; p < A->start[j + 1]; p++) if (A->row[p] <= A->row[p - 1]) return 0;
    return 1;
}

/* B = T' A T where T selects unknowns: the entries of A in rows and columns that are kept. kept: new number
 * of each row plus 1; 0: it is dropped. */
static pg_status select_entries (pg_sparse *B, const pg_sparse *A, const pg_sparse *T)
{
    pg_status status = PG_OK;
    long *kept = NULL;
    size_t nnz = 0;
    PG_ALLOC (kept, A->nrow);
    for (size_t k = 0; k < T->ncol; k++) kept[T->row[k]] = (long) k + 1;
    for (size_t k = 0; k < T->ncol; k++)
        for (long p = A->start[T->row[k]]; p < A->start[T->row[k] + 1]; p++) nnz += kept[A->row[p]] > 0;
    PG_TRY (pg_sparse_create (B, T->ncol, T->ncol, nnz, 1));
    nnz = 0;
    for (size_t k = 0; k < T->ncol; k++) {
        for (long p = A->start[T->row[k]]; p < A->start[T->row[k] + 1]; p++)
            if (kept[A->row[p]]) B->row[nnz] = kept[A->row[p]] - 1, B->value[nnz++] = A->value[p];
        B->start[k + 1] = (long) nnz;
    }
done:
    pg_free (kept);
    return status;
}

/* Shrinks the arrays of B to nnz entries. */
static pg_status fit (pg_sparse *B, size_t nnz)
{
    pg_status status = PG_OK;
    long *row = pg_resize (B->row, nnz, sizeof *row);
    double *value;
    if (row) B->row = row;
    value = row ? pg_resize (B->value, nnz, sizeof *value) : NULL;
    if (value) B->value = value;
    else PG_FAIL (PG_E_MEMORY, "no memory for %zu entries", nnz);
done:
    return status;
}

/* Dense vectors with lists of used indices make the cost proportional to the products, not to the size. */
pg_status pg_sparse_congruence (pg_sparse *B, const pg_sparse *A, const pg_sparse *T)
{
    pg_status status = PG_OK;
    rows_view R = { 0 };
    pg_sparse F = { 0 };
    work w = { &F, T, &R, NULL, NULL, NULL, NULL, 0, 0, NULL, NULL };
    size_t cap = 0, nnz = 0, cap_value = 0;
    memset (B, 0, sizeof *B);
    if (selects (T) && ascends (A)) return select_entries (B, A, T);
    B->nrow = B->ncol = T->ncol, B->symmetric = 1;
    PG_TRY (by_rows (&R, T));
    PG_TRY (both_triangles (&F, A));
    PG_ALLOC (B->start, T->ncol + 1);
    PG_ALLOC (w.c, T->nrow);
    PG_ALLOC (w.b, T->ncol);
    PG_ALLOC (w.hit_c, T->nrow);
    PG_ALLOC (w.hit_b, T->ncol);
    PG_ALLOC (w.on_c, T->nrow);
    PG_ALLOC (w.on_b, T->ncol);
    /* Rows of a column come out in the order in which they were met; they are sorted, as solvers expect. */
    for (size_t k = 0; k < T->ncol; k++) {
        one_column (&w, k);
        sort_ascending (w.hit_b, w.nb);
        PG_GROW (B->row, cap, nnz + (size_t) w.nb);
        PG_GROW (B->value, cap_value, nnz + (size_t) w.nb);
        for (long h = 0; h < w.nb; h++, nnz++) B->row[nnz] = w.hit_b[h], B->value[nnz] = w.b[w.hit_b[h]];
        B->start[k + 1] = (long) nnz;
    }
    PG_TRY (fit (B, nnz));
done:
    pg_free (R.start), pg_free (R.row), pg_free (R.value);
    pg_sparse_clear (&F);
    pg_free (w.c), pg_free (w.b), pg_free (w.hit_c), pg_free (w.hit_b), pg_free (w.on_c), pg_free (w.on_b);
    if (status != PG_OK) pg_sparse_clear (B);
    return status;
}
