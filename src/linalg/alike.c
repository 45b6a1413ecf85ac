/* SPDX-License-Identifier: GPL-3.0-or-later
 * Which rows of a matrix are alike: found by comparing them, number by number, so that bodies with holes,
 * cracks and supports need no rule of their own. */
#include "alike.h"
#include <math.h>

/* Largest difference between alike rows, as a share of the largest number of the row. */
static const float rounding = 1e-6f;

/* Rows of a matrix: first coupling of each row, node of each coupling, `width` values of each coupling. */
typedef struct { const size_t *start; const int *node; const float *value; size_t width; } rows;

/* Is row i like row `first`, with all nodes shifted by i - first? most: largest number of row `first`. */
static int is_alike (const rows *A, size_t first, size_t i, float most)
{
    size_t a = A->start[first], b = A->start[i], m = A->start[first + 1] - a;
    int shift = (int) (i - first);
    if (A->start[i + 1] - b != m || m == 0) return 0;
    for (size_t k = 0; k < m; k++) if (A->node[b + k] != A->node[a + k] + shift) return 0;
    const float *s = A->value + a * A->width, *t = A->value + b * A->width;
    for (size_t k = 0; k < m * A->width; k++) if (fabsf (t[k] - s[k]) > rounding * most) return 0;
    return 1;
}

static float largest (const rows *A, size_t i)
{
    float most = 0;
    for (size_t k = A->start[i] * A->width; k < A->start[i + 1] * A->width; k++)
        most = fmaxf (most, fabsf (A->value[k]));
    return most;
}

/* Takes the longest run that begins at a row; if that is too short, the row is in no run. */
pg_status rows_alike (pg_row_runs *out, size_t least, size_t n, const size_t *start, const int *node,
                      const float *value, size_t width)
{
    pg_status status = PG_OK;
    rows A = { start, node, value, width };
    out->n = 0;
    for (size_t i = 0, end; i < n; i = end) {
        float most = largest (&A, i);
        for (end = i + 1; end < n && is_alike (&A, i, end, most);) end++;
        if (end - i < least) {
            end = i + 1;
            continue;
        }
        PG_GROW (out->run, out->cap, out->n + 1);
        out->run[out->n++] = (pg_row_run) { i, end - i };
    }
done:
    return status;
}

size_t rows_alike_at (const pg_row_runs *runs, size_t row)
{
    size_t low = 0, high = runs->n;
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (runs->run[middle].first + runs->run[middle].count <= row) low = middle + 1;
        else high = middle;
    }
    return low;
}
