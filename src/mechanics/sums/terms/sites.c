/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finds out whether the points of a cloud are sites of one lattice. If no lattice is given (points of a file,
 * nodes of a mesh) its steps are the smallest gaps between coordinates. */
#include "sums_private.h"
#include <limits.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double off_site = 1e-6;                   /* largest distance from a site, in steps */
static const double sparse   = 8;  /* with more sites per point points do not count as a lattice */

/* Computes the bounding box of all points, m. */
static void bounds (const pg_cloud *cloud, double *low, double *high)
{
    for (int k = 0; k < cloud->dim; k++) {
        low[k] = INFINITY, high[k] = -INFINITY;
        for (size_t i = 0; i < cloud->n; i++) {
            double x = cloud->x[i * (size_t) cloud->dim + (size_t) k];
            low[k] = fmin (low[k], x), high[k] = fmax (high[k], x);
        }
    }
}

/* Do all points have the spacing h of the cloud? Graded points are no lattice, whatever their positions. */
static int alike (const pg_cloud *cloud)
{
    for (size_t i = 0; cloud->size && i < cloud->n; i++)
        if (!(fabs (cloud->size[i] - cloud->h) <= off_site * cloud->h)) return 0;
    return 1;
}

/* Lists coordinate k of all points of the body, ascending, m; where ranks share the body on rank 0, elsewhere
 * none. */
static pg_status coordinates (const pg_cloud *cloud, int k, size_t *n, double **x)
{
    pg_status status = PG_OK;
    double *mine = NULL;
    void *all = NULL;
    size_t m = 0, bytes;
    PG_ALLOC (mine, cloud->n);
    for (size_t i = 0; i < cloud->n; i++)
        if (pg_cloud_owns (cloud, i)) mine[m++] = cloud->x[i * (size_t) cloud->dim + (size_t) k];
    PG_TRY (pg_ranks_collect (m * sizeof *mine, mine, &bytes, &all));
    *x = all, *n = bytes / sizeof **x;
    if (*n) pg_sort (*x, *n, sizeof **x, pg_ascending_numbers);
done:
    pg_free (mine);
    return status;
}

/* Finds the steps of a lattice from the points: the smallest gap between two coordinates along each axis that
 * is not rounding (1e-3 h). found = 0: an axis has no gap, or the box has more than 8 sites per point:
 * irregular points that happen to have small gaps. */
static pg_status find_steps (const pg_cloud *cloud, double *step, int *found)
{
    pg_status status = PG_OK;
    double *x = NULL, all = 1, is_one = 0, points = 0;
    size_t n = 0;
    *found = 0;
    for (int k = 0; k < cloud->dim; k++) {
        double gap = INFINITY;
        pg_free (x), x = NULL;
        PG_TRY (coordinates (cloud, k, &n, &x));
        step[k] = 0;
        if (n == 0) continue;
        double length = x[n - 1] - x[0];
        for (size_t i = 1; i < n; i++)
            if (x[i] - x[i - 1] > 1e-3 * cloud->h) gap = fmin (gap, x[i] - x[i - 1]);
        points = (double) n;
        if (!isfinite (gap) || !isfinite (length)) all = INFINITY;
        else step[k] = length / floor (length / gap + 0.5);  /* the length has smaller relative errors */
        all *= length / step[k] + 1;
    }
    is_one = n > 0 && all < sparse * points + 64;
    PG_TRY (pg_ranks_sum ((size_t) cloud->dim, step));
    PG_TRY (pg_ranks_sum (1, &is_one));
    *found = is_one > 0;
done:
    pg_free (x);
    return status;
}

/* Sets the numbers of sites of the box of all points, and its lowest corner (m); returns the number of sites,
 * 0: too many, or no valid steps. Axes beyond the dimension have one site. */
static size_t count_sites (pg_sites *s, const pg_cloud *cloud, const double *step, double *low)
{
    double high[3], all = 1;
    bounds (cloud, low, high);
    for (int k = 0; k < 3; k++) s->count[k] = 1, s->step[k] = k < cloud->dim ? step[k] : 1;
    for (int k = 0; k < cloud->dim; k++) {
        double n = floor ((high[k] - low[k]) / step[k] + 0.5) + 1;
        if (!(step[k] > 0) || !isfinite (step[k]) || !(n >= 1) || !((all *= n) < INT_MAX)) return 0;
        s->count[k] = (int) n;
    }
    return (size_t) all;
}

/* Returns the number of the site of a point, x fastest; -1: it is off all sites by more than a millionth of a
 * step. */
static int site_of (const pg_sites *s, const double *x, const double *low)
{
    int site = 0;
    for (int k = s->dim; k-- > 0; ) {
        double at = (x[k] - low[k]) / s->step[k], n = floor (at + 0.5);
        if (!(fabs (at - n) <= off_site) || n < 0 || n >= s->count[k]) return -1;
        site = site * s->count[k] + (int) n;
    }
    return site;
}

/* Sets the site of each point and the point of each site; returns 0 if a point is on no site, or two are on
 * one. */
static int put_on_sites (pg_sites *out, const pg_cloud *cloud, size_t all, const double *low)
{
    for (size_t s = 0; s < all; s++) out->point[s] = -1;
    for (size_t i = 0; i < cloud->n; i++) {
        int site = out->site[i] = site_of (out, cloud->x + i * (size_t) cloud->dim, low);
        if (site < 0 || out->point[site] >= 0) return 0;
        out->point[site] = (int) i;
    }
    return 1;
}

/* Sets *yes on all ranks that share the points if it is set on any. */
static pg_status any_rank (const pg_cloud *cloud, int *yes)
{
    pg_status status = PG_OK;
    double any = *yes;
    PG_TRY (pg_cloud_most (cloud, 1, &any));
    *yes = any > 0;
done:
    return status;
}

/* Finds the site of every point and the point of every site, -1 for none. If any point is on no site, or two
 * are on one, the whole cloud counts as irregular: *out is empty then, which is no error. */
pg_status pg_sites_build (pg_sites *out, const pg_cloud *cloud, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    double low[3], step[3];
    size_t all = 0;
    int fits = 0, found = 1, other, given = lattice && lattice->dim > 0;
    memset (out, 0, sizeof *out);
    out->dim = cloud->dim;
    if ((given && lattice->dim != cloud->dim) || cloud->n == 0 || cloud->n > INT_MAX) goto done;
    other = !alike (cloud);
    PG_TRY (any_rank (cloud, &other));
    if (other) goto done;
    if (given) memcpy (step, lattice->step, sizeof step);
    else PG_TRY (find_steps (cloud, step, &found));
    if (!found) goto done;
    all = count_sites (out, cloud, step, low);
    other = all < cloud->n;
    if (!other) PG_ALLOC (out->site, cloud->n);
    if (!other) PG_ALLOC (out->point, all);
    if (!other) other = !put_on_sites (out, cloud, all, low);
    PG_TRY (any_rank (cloud, &other));                 /* points of all ranks must be sites of the lattice */
    fits = !other;
done:
    if (!fits || status != PG_OK) pg_sites_clear (out);
    return status;
}

/* Frees the arrays; *sites may be all zeros. */
void pg_sites_clear (pg_sites *sites)
{
    pg_free (sites->site);
    pg_free (sites->point);
    memset (sites, 0, sizeof *sites);
}
