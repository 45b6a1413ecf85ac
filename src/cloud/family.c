/* SPDX-License-Identifier: GPL-3.0-or-later
 * Families { j : |x_j - c_i| <= reach } in O(n). The centres are sorted into the cells of a grid; the
 * points then visit the cells near them in ascending order, so that each family comes out sorted without
 * being sorted. Where every point has its own reach the centres are sorted into a tree instead: O(n log n),
 * however crowded some places are. Two passes: the first counts, the second writes. */
#include "perigal/cloud.h"
#include "tree.h"
#include <math.h>
#include <string.h>

/* A grid of cells over the centres. */
typedef struct {
    int     dim;
    size_t  count[3];
    /* cell = (x - low) * inverse along each axis (m, 1/m). */
    double  low[3], inverse[3];
    /* Centres of each cell (compressed rows). */
    size_t *start, *item;
} grid;

/* Cell index of coordinate x along axis k; outside: the nearest cell. */
static size_t cell_along (const grid *g, int k, double x)
{
    double c = (x - g->low[k]) * g->inverse[k];
    if (!(c > 0)) return 0;
    return c < (double) g->count[k] ? (size_t) c : g->count[k] - 1;
}

/* Number of the cell that holds x, x fastest. */
static size_t cell_of (const grid *g, const double *x)
{
    size_t c = 0;
    for (int k = g->dim; k-- > 0; ) c = c * g->count[k] + cell_along (g, k, x[k]);
    return c;
}

/* Cells as wide as the reach, but not many more than there are centres. */
static void fit_grid (grid *g, size_t n, const double *x, double reach)
{
    double high[3], cells = 1, most = pow ((double) n + 1, 1.0 / g->dim) + 1;
    for (int k = 0; k < g->dim; k++) {
        g->low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < n; i++) {
            double v = x[i * (size_t) g->dim + (size_t) k];
            g->low[k] = fmin (g->low[k], v), high[k] = fmax (high[k], v);
        }
        double c = reach > 0 ? (high[k] - g->low[k]) / reach : INFINITY;
        cells *= fmax (1, c);
    }
    for (int k = 0; k < g->dim; k++) {
        /* Where the reach is small against the distance of points, cells are wider: empty ones cost memory
         * and time. */
        double length = high[k] - g->low[k], c = reach > 0 ? floor (length / reach) : most;
        if (cells > 4 * (double) n + 64) c = fmin (c, most);
        if (!(c >= 1) || !(length > 0)) c = 1;
        g->count[k] = (size_t) c;
        g->inverse[k] = length > 0 ? c / length : 0;
    }
}

static void grid_clear (grid *g)
{
    pg_free (g->start);
    pg_free (g->item);
    memset (g, 0, sizeof *g);
}

/* Counting sort of the centres. */
static pg_status grid_build (grid *g, int dim, size_t n, const double *x, double reach)
{
    pg_status status = PG_OK;
    memset (g, 0, sizeof *g);
    g->dim = dim;
    fit_grid (g, n, x, reach);
    size_t ncell = 1;
    for (int k = 0; k < dim; k++) ncell *= g->count[k];
    PG_ALLOC (g->start, ncell + 2);
    PG_ALLOC (g->item, n);
    for (size_t i = 0; i < n; i++) g->start[cell_of (g, x + i * (size_t) dim) + 2]++;
    for (size_t c = 2; c < ncell + 2; c++) g->start[c] += g->start[c - 1];
    for (size_t i = 0; i < n; i++) g->item[g->start[cell_of (g, x + i * (size_t) dim) + 1]++] = i;
done:
    if (status != PG_OK) grid_clear (g);
    return status;
}

/* What a pass needs. */
typedef struct {
    const grid *g;
    /* In place of the grid where reaches differ. */
    const pg_tree *tree;
    int dim;
    const double *centre;
    /* Width of the search; largest distance of a member (radial: squared). */
    double reach, limit;
    int shape, closed;
    /* Per centre: number of members so far, or place of the next one. */
    size_t *next;
    /* Members; NULL in the counting pass. */
    int *node;
} search;

/* Is x within the limit of c? closed: the limit itself counts. */
static int belongs (const search *s, int dim, const double *c, const double *x)
{
    double d = 0;
    for (int k = 0; k < dim; k++) {
        double z = fabs (x[k] - c[k]);
        d = s->shape == PG_RADIAL ? d + z*z : fmax (d, z);
    }
    return s->closed ? d <= s->limit : d < s->limit;
}

/* The point whose turn it is. */
typedef struct { const search *s; const double *x; int j; } visitor;

/* Adds point j to the family of centre i, if it belongs there. */
static void tell (void *context, size_t i)
{
    const visitor *v = context;
    const search *s = v->s;
    if (!belongs (s, s->dim, s->centre + i * (size_t) s->dim, v->x)) return;
    if (s->node) s->node[s->next[i]] = v->j;
    s->next[i]++;
}

/* The same for all centres of a row of cells. */
static void visit_row (const search *s, const double *x, int j, size_t first, size_t last)
{
    const grid *g = s->g;
    for (size_t e = g->start[first]; e < g->start[last + 1]; e++) {
        size_t i = g->item[e];
        if (!belongs (s, g->dim, s->centre + i * (size_t) g->dim, x)) continue;
        if (s->node) s->node[s->next[i]] = j;
        s->next[i]++;
    }
}

/* Adds point j to all families it belongs to; the cells of a row along x are contiguous. */
static void visit_point (const search *s, const double *x, int j)
{
    const grid *g = s->g;
    size_t a[3] = {0, 0, 0}, b[3] = {0, 0, 0}, row[3] = {1, 1, 1};
    for (int k = 0; k < g->dim; k++) {
        a[k] = cell_along (g, k, x[k] - s->reach);
        b[k] = cell_along (g, k, x[k] + s->reach);
        row[k] = g->count[k];
    }
    for (size_t r = a[2]; r <= b[2]; r++)
        for (size_t q = a[1]; q <= b[1]; q++) {
            size_t base = (r * row[1] + q) * row[0];
            visit_row (s, x, j, base + a[0], base + b[0]);
        }
}

/* All points in ascending order; the reach of a point is proportional to its spacing. */
static void visit_points (const search *all, const pg_cloud *cloud, double reach)
{
    search s = *all;
    for (size_t j = 0; j < cloud->n; j++) {
        const double *x = cloud->x + j * (size_t) cloud->dim;
        if (cloud->size) {
            double far = reach * pg_cloud_ratio (cloud, j);
            s.reach = all->reach * pg_cloud_ratio (cloud, j);
            s.limit = s.shape == PG_RADIAL ? far * far : far;
            pg_tree_near (s.tree, x, s.reach, tell, &(visitor) { &s, x, (int) j });
        } else visit_point (&s, x, (int) j);
    }
}

/* Positions and spacings must be finite numbers. */
static pg_status check_input (const pg_cloud *cloud, size_t n, const double *centre, double reach)
{
    pg_status status = PG_OK;
    if (!(reach >= 0) || !isfinite (reach))
        PG_FAIL (PG_E_USAGE, "reach %g m of a family must be finite and not negative", reach);
    for (size_t i = 0; i < n * (size_t) cloud->dim; i++)
        if (!isfinite (centre[i]))
            PG_FAIL (PG_E_USAGE, "centre %zu of a family is not a finite position", i / (size_t) cloud->dim);
    for (size_t i = 0; i < cloud->n * (size_t) cloud->dim; i++)
        if (!isfinite (cloud->x[i]))
            PG_FAIL (PG_E_USAGE, "point %zu has no finite position", i / (size_t) cloud->dim);
    for (size_t i = 0; cloud->size && i < cloud->n; i++)
        if (!(cloud->size[i] > 0) || !isfinite (cloud->size[i]))
            PG_FAIL (PG_E_USAGE, "point %zu has the spacing %g m", i, cloud->size[i]);
done:
    return status;
}

/* A relative margin of 1e-9 decides about distances of exactly `reach`, which rounding would leave to
 * chance; the search is a little wider. */
pg_status pg_family_build (pg_family *out, const pg_cloud *cloud, size_t n, const double *centre,
                           double reach, int shape, int closed)
{
    pg_status status = PG_OK;
    grid g = {0};
    pg_tree tree = {0};
    double far = reach * (closed ? 1 + 1e-9 : 1 - 1e-9);
    search s = { &g,    &tree,  cloud->dim, centre, reach * (1 + 1e-8), shape == PG_RADIAL ? far * far : far,
                 shape, closed, NULL,       NULL };
    memset (out, 0, sizeof *out);
    PG_TRY (check_input (cloud, n, centre, reach));
    if (cloud->size) PG_TRY (pg_tree_build (&tree, cloud->dim, n, centre));
    else PG_TRY (grid_build (&g, cloud->dim, n, centre, s.reach));
    PG_ALLOC (out->start, n + 1);
    PG_ALLOC (s.next, n);
    out->n = n;
    /* First pass: numbers of members. */
    visit_points (&s, cloud, far);
    for (size_t i = 0; i < n; i++) {
        out->start[i + 1] = out->start[i] + s.next[i];
        s.next[i] = out->start[i];
    }
    PG_ALLOC (out->node, out->start[n]);
    /* Second pass: members. */
    s.node = out->node;
    visit_points (&s, cloud, far);
done:
    pg_free (s.next);
    grid_clear (&g);
    pg_tree_clear (&tree);
    if (status != PG_OK) pg_family_clear (out);
    return status;
}

void pg_family_clear (pg_family *family)
{
    pg_free (family->start);
    pg_free (family->node);
    memset (family, 0, sizeof *family);
}
