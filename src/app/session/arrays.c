/* SPDX-License-Identifier: GPL-3.0-or-later
 * Points and shape functions from plain arrays, checked as scenes are: other languages hand over whatever
 * their users typed. */
#include "perigal/session.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- points -------------------------------------------------------------------------------------------- */
/* Fails if a number, a coordinate, a volume or the thickness is none that a point cloud can have. */
static pg_status check_points (int dim, size_t n, const double *x, const double *volume, double spacing,
                               double thickness)
{
    pg_status status = PG_OK;
    if (dim < 1 || dim > 3) PG_FAIL (PG_E_USAGE, "points have 1, 2 or 3 coordinates, not %d", dim);
    if (n == 0) PG_FAIL (PG_E_USAGE, "there are no points");
    if (n > INT_MAX / 4) PG_FAIL (PG_E_USAGE, "%zu points are too many: at most %d", n, INT_MAX / 4);
    if (!isfinite (spacing) || spacing < 0 || (!volume && spacing == 0))
        PG_FAIL (PG_E_USAGE, "spacing is %g m: it must be above 0%s", spacing,
                 volume ? "" : " where no volumes are given");
    if (!(thickness > 0) || !isfinite (thickness))
        PG_FAIL (PG_E_USAGE, "thickness is %g: it must be above 0", thickness);
    for (size_t i = 0; i < n * (size_t) dim; i++)
        if (!isfinite (x[i]))
            PG_FAIL (PG_E_USAGE, "coordinate %zu of point %zu is %g", i % (size_t) dim + 1,
                     i / (size_t) dim + 1, x[i]);
    for (size_t i = 0; volume && i < n; i++)
        if (!(volume[i] > 0) || !isfinite (volume[i]))
            PG_FAIL (PG_E_USAGE, "the volume of point %zu is %g: it must be above 0", i + 1, volume[i]);
done:
    return status;
}

/* Positions in the order of their coordinates, for qsort. */
typedef struct { double x[3]; size_t point; } place;
static int by_place (const void *a, const void *b)
{
    const place *p = a, *q = b;
    for (int k = 0; k < 3; k++) if (p->x[k] != q->x[k]) return p->x[k] < q->x[k] ? -1 : 1;
    return p->point < q->point ? -1 : 1;
}

/* Fails if two points have the same position: a bond between them would have no length. */
static pg_status check_twins (const pg_cloud *c)
{
    pg_status status = PG_OK;
    place *p = NULL;
    size_t dim = (size_t) c->dim;
    PG_ALLOC (p, c->n);
    for (size_t i = 0; i < c->n; i++) {
        p[i].point = i;
        memcpy (p[i].x, c->x + i * dim, dim * sizeof *c->x);
    }
    pg_sort (p, c->n, sizeof *p, by_place);
    for (size_t i = 1; i < c->n; i++)
        if (!memcmp (p[i].x, p[i - 1].x, sizeof p[i].x))
            PG_FAIL (PG_E_USAGE, "points %zu and %zu are at the same place", p[i - 1].point + 1,
                     p[i].point + 1);
done:
    pg_free (p);
    return status;
}

/* Nominal spacing where none is given, m: from the mean volume, as for points of a file. */
static double spacing_of (const pg_cloud *c)
{
    double sum = 0;
    for (size_t i = 0; i < c->n; i++) sum += c->volume[i];
    return pow (sum / (double) c->n / c->thickness, 1.0 / c->dim);
}

static void find_box (pg_cloud *c)
{
    size_t dim = (size_t) c->dim;
    for (size_t k = 0; k < dim; k++) {
        c->low[k] = INFINITY, c->high[k] = -INFINITY;
        for (size_t i = 0; i < c->n; i++) {
            c->low[k] = fmin (c->low[k], c->x[i * dim + k]);
            c->high[k] = fmax (c->high[k], c->x[i * dim + k]);
        }
    }
}

pg_status pg_cloud_of_arrays (pg_cloud *out, int dim, size_t n, const double *x, const double *volume,
                              double spacing, double thickness)
{
    pg_status status = PG_OK;
    *out = (pg_cloud) { 0 };
    PG_TRY (check_points (dim, n, x, volume, spacing, thickness));
    pg_cloud c = { .dim = dim, .n = n, .thickness = dim == 3 ? 1 : thickness };
    *out = c;
    PG_ALLOC (out->x, n * (size_t) dim);
    PG_ALLOC (out->volume, n);
    PG_ALLOC (out->block, n);
    for (size_t i = 0; i < n * (size_t) dim; i++) out->x[i] = x[i] + 0.0;      /* -0 is the same place as 0 */
    for (size_t i = 0; i < n; i++)
        out->volume[i] = volume ? volume[i] : pow (spacing, dim) * out->thickness;
    PG_TRY (check_twins (out));
    out->h = spacing > 0 ? spacing : spacing_of (out);
    for (int k = 0; k < dim; k++) out->step[k] = out->h;
    find_box (out);
done:
    if (status != PG_OK) pg_cloud_clear (out);
    return status;
}

/* ---- shape functions ----------------------------------------------------------------------------------- */
/* Index of a word in a list such as "a|b|c"; -1: it is not in it; 0 for NULL, which stands for the first
 * word. */
static int number_of (const char *word, const char *words)
{
    const char *at = words;
    for (int k = 0; word; k++) {
        size_t length = strcspn (at, "|");
        if (strlen (word) == length && !strncmp (word, at, length)) return k;
        if (!at[length]) return -1;
        at += length + 1;
    }
    return 0;
}

static pg_status read_word (int *out, const char *what, const char *word, const char *words)
{
    *out = number_of (word, words);
    if (*out >= 0) return PG_OK;
    return pg_error (PG_E_USAGE, PG_HERE, "%s is '%s': it must be one of %s", what, word, words);
}

/* Turns a choice in words, as in `method` of a scene, into an approximation. */
static pg_status choose (pg_approx *a, const pg_shape_choice *c, const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    enum { AUTO, UNIT };
    int tensor, weights, projected;
    *a = (pg_approx) { .order = c->order, .horizon = c->horizon };
    a->type = c->approximation ? pg_approx_find (c->approximation) : pg_approx_first ();
    a->kernel = c->kernel ? pg_kernel_find (c->kernel) : pg_kernel_entry (0);
    if (!a->type)
        PG_FAIL (PG_E_USAGE, "there is no approximation '%s': %s", c->approximation, pg_approx_names ());
    if (!a->kernel) PG_FAIL (PG_E_USAGE, "there is no kernel '%s': %s", c->kernel, pg_kernel_names ());
    PG_TRY (read_word (&tensor, "support", c->support, "radial|tensor"));
    PG_TRY (read_word (&weights, "weights", c->weights, "auto|unit|volume"));
    PG_TRY (read_word (&projected, "degenerate", c->degenerate, "shepard|projected"));
    if (c->order != 1 && c->order != 2) PG_FAIL (PG_E_USAGE, "order is %d: it must be 1 or 2", c->order);
    if (!(c->horizon >= cloud->h * (1 - 1e-9)) || !isfinite (c->horizon))
        PG_FAIL (PG_E_USAGE, "the horizon is %g m, %.4g spacings: a point would see no neighbour", c->horizon,
                 c->horizon / cloud->h);
    if (projected && c->order == 2)
        PG_FAIL (PG_E_USAGE, "degenerate: projected goes with the linear basis (order 1)");
    a->shape = tensor ? PG_TENSOR : PG_RADIAL;
    a->use_volume = weights == AUTO ? a->type->use_volume : weights != UNIT;
    a->projected = projected;
done:
    return status;
}

/* Makes the array of own nodes for evaluation at the points themselves: own[i] = i. */
static pg_status own_nodes (int **own, size_t n)
{
    pg_status status = PG_OK;
    PG_ALLOC (*own, n);
    for (size_t i = 0; i < n; i++) (*own)[i] = (int) i;
done:
    return status;
}

pg_status pg_shape_functions (pg_rows *out, const pg_shape_choice *choice, const pg_cloud *cloud,
                              size_t nplace, const double *places, const unsigned char *alive, int threads)
{
    pg_status status = PG_OK;
    pg_approx a;
    int *own = NULL;
    *out = (pg_rows) { 0 };
    PG_TRY (choose (&a, choice, cloud));
    for (size_t i = 0; places && i < nplace * (size_t) cloud->dim; i++)
        if (!isfinite (places[i]))
            PG_FAIL (PG_E_USAGE, "place %zu is not finite", i / (size_t) cloud->dim + 1);
    if (!places) PG_TRY (own_nodes (&own, nplace = cloud->n));
    PG_TRY (pg_rows_create (out, &a, cloud, nplace, places ? places : cloud->x, NULL, own, NULL));
    PG_TRY (a.type->evaluate (&a, cloud, out, alive, nplace, NULL, threads));
done:
    pg_free (own);
    if (status != PG_OK) pg_rows_clear (out);
    return status;
}
