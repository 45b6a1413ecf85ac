/* SPDX-License-Identifier: GPL-3.0-or-later
 * Triangles between two lines of vertices, the old and the new edge of a surface. Triangles share vertices
 * exactly; a bond between two triangles passes within rounding of their common edge, which counts as a cut
 * (geometry/cloud/body/crack.c). */
#include "crack_surfaces.h"
#include <string.h>

/* Triangles of less height are omitted, spacings: less than the tolerance of a cut. */
#define NO_HEIGHT 1e-10

double triangle_area3 (const double *a, const double *b, const double *c)
{
    double u[3], v[3], n[3];
    for (int k = 0; k < 3; k++) u[k] = b[k] - a[k], v[k] = c[k] - a[k];
    pg_cross3 (u, v, n);
    return 0.5 * pg_size3 (n);
}

size_t surfaces_put_vertex (pg_crack_surfaces *w, const double *x)
{
    memcpy (w->vertex + 3 * w->nvertex, x, 3 * sizeof *x);
    return w->nvertex++;
}

void surfaces_put_triangle (pg_crack_surfaces *w, const size_t corner[3], const double *normal, double width,
                            long owner)
{
    size_t t = w->cracks.n - w->nfirst;
    double *store = w->store + 9*t;
    for (size_t a = 0; a < 3; a++) {
        w->corner[3*t + a] = corner[a];
        memcpy (store + 3*a, w->vertex + 3 * corner[a], 3 * sizeof *store);
    }
    w->owner[t] = owner;
    w->cracks.crack[w->cracks.n++] = (pg_crack) { .kind = PG_CRACK_POLYGON, .vertex = store, .nvertex = 3,
                                                  .normal = { normal[0], normal[1], normal[2] },
                                                  .sided = 1, .width = width };
}

/* Appends the triangle of three vertices with its normal on the side of `side`. */
static void put (pg_crack_surfaces *w, const pg_ground *p, size_t a, size_t b, size_t c, const double *side,
                 long owner)
{
    const double *x = w->vertex + 3*a, *y = w->vertex + 3*b, *z = w->vertex + 3*c;
    double u[3], v[3], n[3], h = pg_ground_spacing_at (p, x);
    if (a == b || b == c || a == c) return;
    for (int k = 0; k < 3; k++) u[k] = y[k] - x[k], v[k] = z[k] - x[k];
    pg_cross3 (u, v, n);
    double longest = fmax (fmax (pg_size3 (u), pg_size3 (v)), pg_distance3 (y, z));
    if (!(pg_size3 (n) > NO_HEIGHT * h * longest) || !pg_unit3 (n)) return;
    if (pg_dot3 (n, side) < 0) for (int k = 0; k < 3; k++) n[k] = -n[k];
    surfaces_put_triangle (w, (size_t[3]) { a, b, c }, n, PG_NO_LENGTH * h, owner);
}

/* Vertex i of a line, cyclic in a loop. */
static size_t at (const surface_line *l, size_t i) { return l->vertex[l->closed ? i % l->n : i]; }

/* Relative difference up to which lengths count as equal, so that in symmetric bodies rounding does not
 * decide. */
static const double same_length = 1e-6;

/* Returns 1: the middle of the first cross edge is at least as near to the middle of the body as that of the
 * other. Of edges of equal length this chooses symmetrically, independent of mirror images and the direction
 * of lines. */
static int nearer_middle (const pg_crack_surfaces *w, const pg_ground *p, const size_t *way,
                          const size_t *other)
{
    const double *a = w->vertex + 3 * way[0], *b = w->vertex + 3 * way[1];
    const double *c = w->vertex + 3 * other[0], *d = w->vertex + 3 * other[1];
    double near = 0, far = 0;                          /* squares of twice the distances, m^2 */
    for (int k = 0; k < 3; k++) {
        double middle = p->cloud->low[k] + p->cloud->high[k];
        double x = a[k] + b[k] - middle, y = c[k] + d[k] - middle;
        near += x * x, far += y * y;
    }
    return near <= far * (1 + same_length);
}

/* First vertices of two lines: for loops those with the shortest distance. */
static void beginning (const pg_crack_surfaces *w, const pg_ground *p, const surface_line *from,
                       const surface_line *to, size_t *first, size_t *start)
{
    double least = INFINITY;
    *first = *start = 0;
    for (size_t i = 0; from->closed && to->closed && i < from->n; i++)
        for (size_t j = 0; j < to->n; j++) {
            double d = pg_distance3 (w->vertex + 3 * from->vertex[i], w->vertex + 3 * to->vertex[j]);
            if (d > least * (1 + same_length)
                || (d >= least * (1 - same_length)
                    && nearer_middle (w, p, (size_t[]){ from->vertex[*first], to->vertex[*start] },
                                      (size_t[]){ from->vertex[i], to->vertex[j] })))
                continue;
            least = fmin (least, d), *first = i, *start = j;
        }
}

/* Finds the steps along the lines (1: along the first one) with the least sum of cross edges by dynamic
 * programming: c_ij = d_ij + min (c_i-1,j, c_i,j-1), d_ij the length of the edge from i to j. A greedy choice
 * would depend on the direction of the lines. */
static pg_status shortest_ways (const pg_crack_surfaces *w, const pg_ground *p, const surface_line *from,
                                const surface_line *to, size_t first, size_t start, size_t last, size_t end,
                                unsigned char *step)
{
    pg_status status = PG_OK;
    unsigned char *along = NULL;  /* 1: the least sum reaches i, j along the first line */
    double *sum = NULL;
    size_t wide = end + 1;
    PG_ALLOC (along, (last + 1) * wide);
    PG_ALLOC (sum, wide);                              /* row i up to j; beyond j the previous row */
    for (size_t i = 0; i <= last; i++)
        for (size_t j = 0; j <= end; j++) {
            size_t a = at (from, first + i), b = at (to, start + j);
            double d = pg_distance3 (w->vertex + 3 * a, w->vertex + 3 * b);
            int shorter = i > 0 && (j == 0 || sum[j] <= sum[j - 1] * (1 + same_length));
            if (shorter && j > 0 && sum[j - 1] <= sum[j] * (1 + same_length))
                shorter = nearer_middle (w, p, (size_t[]){ at (from, first + i - 1), b },
                                         (size_t[]){ a, at (to, start + j - 1) });
            along[i * wide + j] = (unsigned char) shorter;
            sum[j] = d + (along[i * wide + j] ? sum[j] : j > 0 ? sum[j - 1] : 0);
        }
    for (size_t i = last, j = end, k = last + end; k-- > 0;) {
        step[k] = along[i * wide + j];
        if (step[k]) i--;
        else j--;
    }
done:
    pg_free (along), pg_free (sum);
    return status;
}

pg_status surfaces_zip (pg_crack_surfaces *w, const pg_ground *p, const surface_line *from,
                        const surface_line *to, long owner)
{
    pg_status status = PG_OK;
    unsigned char *step = NULL;
    if (from->n == 0 || to->n == 0) return PG_OK;
    /* numbers of steps along each line */
    size_t last = from->n - !from->closed, end = to->n - !to->closed, first, start;
    beginning (w, p, from, to, &first, &start);
    PG_ALLOC (step, last + end + 1);
    PG_TRY (shortest_ways (w, p, from, to, first, start, last, end, step));
    PG_TRY (surfaces_reserve (w, w->cracks.n + last + end, w->nvertex));
    for (size_t i = 0, j = 0; i + j < last + end;) {
        const double *side = to->normal + 3 * ((start + j) % to->n);
        int along = step[i + j];
        size_t a = at (from, first + i), b = at (to, start + j);
        put (w, p, a, along ? at (from, first + i + 1) : at (to, start + j + 1), b, side, owner);
        if (along) i++;
        else j++;
    }
done:
    pg_free (step);
    return status;
}
