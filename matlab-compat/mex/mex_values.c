/* SPDX-License-Identifier: GPL-3.0-or-later
 * Arguments and results: MATLAB keeps matrices by columns, the library vectors of points side by side. */
#include "perigal_mex.h"
#include <math.h>
#include <string.h>

/* ---- arguments ----------------------------------------------------------------------------------------- */
int take_count (const call *c, int least, int most)
{
    if (c->nin >= least && c->nin <= most) return 0;
    return fault ("perigal:argument", "%s: %d arguments, not from %d to %d", c->command, c->nin, least, most);
}

static int is_real (const mxArray *a) { return mxIsDouble (a) && !mxIsComplex (a) && !mxIsSparse (a); }

int take_number (const call *c, int k, const char *what, double *out)
{
    const mxArray *a = c->in[k];
    if (!is_real (a) || mxGetNumberOfElements (a) != 1)
        return fault ("perigal:argument", "%s must be one real number (double)", what);
    *out = mxGetScalar (a);
    return 0;
}

int take_integer (const call *c, int k, const char *what, double low, double high, int *out)
{
    double value;
    const mxArray *a = c->in[k];
    if (mxIsLogical (a) && mxGetNumberOfElements (a) == 1) value = mxGetScalar (a);
    else if (take_number (c, k, what, &value)) return 1;
    if (!(value >= low) || !(value <= high) || value != floor (value))
        return fault ("perigal:argument", "%s is %g: it must be a whole number from %g to %g", what, value, low,
                      high);
    *out = (int) value;
    return 0;
}

int take_text (const call *c, int k, const char *what, const char **out)
{
    const mxArray *a = c->in[k];
    *out = NULL;
    if (mxIsEmpty (a)) return 0;
    if (!mxIsChar (a) || mxGetM (a) != 1) return fault ("perigal:argument", "%s must be text", what);
    char *text = mxArrayToString (a);
    if (!text) return fault ("perigal:failed", "%s: no memory for the text", what);
    size_t length = strlen (text);
    char *mine = hold (length + 1, NULL);
    if (mine) memcpy (mine, text, length + 1);
    mxFree (text);
    *out = mine;
    return mine == NULL;
}

int take_word (const call *c, int k, const char *what, const char *words, int *out)
{
    const char *word, *at = words;
    if (take_text (c, k, what, &word)) return 1;
    *out = 0;
    if (!word) return 0;
    for (;; (*out)++) {
        size_t length = strcspn (at, "|");
        if (strlen (word) == length && !strncmp (word, at, length)) return 0;
        if (!at[length]) break;
        at += length + 1;
    }
    return fault ("perigal:argument", "%s is '%s': it must be one of %s", what, word, words);
}

int take_matrix (const call *c, int k, const char *what, size_t columns, int empty, size_t *rows, size_t *found,
                 double **out)
{
    const mxArray *a = c->in[k];
    *out = NULL, *rows = 0;
    if (mxIsEmpty (a) && empty) return 0;
    if (!is_real (a) || mxGetNumberOfDimensions (a) != 2 || mxIsEmpty (a))
        return fault ("perigal:argument", "%s must be a real matrix (double, not sparse)", what);
    size_t m = mxGetM (a), n = mxGetN (a);
    if (columns == 1 && m == 1) m = n, n = 1;          /* a row will do as a column */
    if (columns && n != columns)
        return fault ("perigal:argument", "%s has %zu columns, not %zu", what, n, columns);
    const double *from = mxGetPr (a);
    double *to = hold (m * n * sizeof *to, NULL);
    if (!to) return 1;
    for (size_t j = 0; j < n; j++) for (size_t i = 0; i < m; i++) to[i * n + j] = from[j * m + i];
    *rows = m, *out = to;
    if (found) *found = n;
    return 0;
}

int take_flags (const call *c, int k, const char *what, size_t n, unsigned char **out)
{
    const mxArray *a = c->in[k];
    if ((!mxIsLogical (a) && !is_real (a)) || mxIsSparse (a))
        return fault ("perigal:argument", "%s must be logical", what);
    if (mxGetNumberOfElements (a) != n)
        return fault ("perigal:argument", "%s has %zu entries, not %zu", what,
                      (size_t) mxGetNumberOfElements (a), n);
    unsigned char *to = hold (n + 1, NULL);
    if (!to) return 1;
    const mxLogical *flag = mxIsLogical (a) ? mxGetLogicals (a) : NULL;
    const double *number = flag ? NULL : mxGetPr (a);
    for (size_t i = 0; i < n; i++) {
        if (number && number[i] != 0 && number[i] != 1)
            return fault ("perigal:argument", "%s must hold true and false, and has %g", what, number[i]);
        to[i] = flag ? flag[i] != 0 : number[i] != 0;
    }
    *out = to;
    return 0;
}

/* ---- results ------------------------------------------------------------------------------------------- */
mxArray *full_of (size_t rows, size_t columns, const double *value)
{
    mxArray *a = mxCreateDoubleMatrix ((mwSize) rows, (mwSize) columns, mxREAL);
    double *to = mxGetPr (a);
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++) to[j * rows + i] = value[i * columns + j];
    return a;
}

mxArray *number_of (double value) { return mxCreateDoubleScalar (value); }

/* One pass over the entries of A, both triangles where it is symmetric: counted by columns (row NULL), or put
 * where the next entry of their column goes. Column j has its stored entries first, above the diagonal, then row
 * j of the upper triangle, columns ascending. MATLAB's matrices hold no zeros. */
static void pass (const pg_sparse *A, mwIndex *next, mwIndex *row, double *value)
{
    for (size_t j = 0; j < A->ncol; j++)
        for (long p = A->start[j]; p < A->start[j + 1]; p++) {
            size_t i = (size_t) A->row[p];
            if (A->value[p] == 0) continue;
            for (int turn = 0; turn < (A->symmetric && i != j ? 2 : 1); turn++) {
                mwIndex to = next[turn ? i : j]++;
                if (row) row[to] = (mwIndex) (turn ? j : i), value[to] = A->value[p];
            }
        }
}

mxArray *sparse_of (const pg_sparse *A)
{
    mwIndex *next = mxCalloc (A->ncol + 1, sizeof *next), nnz = 0;
    pass (A, next, NULL, NULL);
    for (size_t j = 0; j < A->ncol; j++) nnz += next[j];
    mxArray *a = mxCreateSparse ((mwSize) A->nrow, (mwSize) A->ncol, (mwSize) (nnz ? nnz : 1), mxREAL);
    mwIndex *start = mxGetJc (a);
    start[0] = 0;
    for (size_t j = 0; j < A->ncol; j++) start[j + 1] = start[j] + next[j];
    memcpy (next, start, A->ncol * sizeof *next);
    pass (A, next, mxGetIr (a), mxGetPr (a));
    mxFree (next);
    return a;
}

/* The first result can always be had, others only where they were asked for. */
void give (const call *c, int k, mxArray *value)
{
    if (k < (c->nout > 1 ? c->nout : 1)) c->out[k] = value;
    else mxDestroyArray (value);
}

void put (mxArray *s, const char *name, mxArray *value)
{
    mxAddField (s, name);
    mxSetField (s, 0, name, value);
}
