/* SPDX-License-Identifier: GPL-3.0-or-later
 * Volumes of points from cut cells: the volume of each cell is shared equally among its points, as in an
 * uncut lattice, so that the sum over the points is the volume of the body. */
#include "sites.h"
#include <math.h>
#include <string.h>

/* Largest number of points at equal distance from one position that are found. */
enum { MOST = 16 };
/* The points found so far. */
typedef struct { int point[MOST]; size_t n; } found;

/* Refuses the points that were found already (a callback of type pg_refuse). */
static int is_found (void *context, const double *place, size_t point)
{
    const found *f = context;
    (void) place;
    for (size_t k = 0; k < f->n; k++) if (f->point[k] == (int) point) return 1;
    return 0;
}

/* Finds all points as near to `place` as the nearest, to a millionth of the spacing: if ties were decided by
 * number, mirrored bodies would not have mirrored volumes. */
static void find_nearest (found *f, const pg_cloud *cloud, const pg_nearest *nearest, const double *place)
{
    double first = 0;
    f->n = 0;
    while (f->n < MOST) {
        long j = pg_nearest_find (nearest, place, is_found, f);
        double away = 0;
        if (j < 0) return;
        for (int k = 0; k < cloud->dim; k++)
            away = hypot (away, cloud->x[(size_t) j * (size_t) cloud->dim + (size_t) k] - place[k]);
        if (f->n == 0) first = away;
        if (away > first + 1e-6 * cloud->h) return;
        f->point[f->n++] = (int) j;
    }
}

/* A cell none of whose vertices (or whose centre) is a point is a sliver beyond the kept boxes of the
 * lattice: its volume goes to the nearest points. */
pg_status pg_cells_share (pg_cloud *cloud, const pg_cells *cells, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    cells_sites sites = {0};
    pg_nearest *nearest = NULL;
    size_t dim = (size_t) cells->dim;
    /* Where nothing is cut the volumes from the lattice are exact. */
    if (!cells->cut) return PG_OK;
    PG_TRY (cells_sites_create (&sites, lattice, cloud));
    PG_TRY (pg_nearest_create (&nearest, cloud->dim, cloud->n, cloud->x));
    memset (cloud->volume, 0, cloud->n * sizeof *cloud->volume);
    for (size_t c = 0; c < cells->n; c++) {
        const double *low = cells->x + cells->start[c] * dim, *high = low
                                                                      + (dim == 3   ? 6
                                                                         : dim == 2 ? 2
                                                                                    : 1)
                                                                            * dim;
        int i[3];
        double middle[3];
        found of;
        cells_sites_cell (&sites, low, i);
        of.n = (size_t) cells_sites_points (&sites, i, 0, of.point);
        for (size_t k = 0; k < dim; k++) middle[k] = 0.5 * (low[k] + high[k]);
        if (of.n == 0) find_nearest (&of, cloud, nearest, middle);
        for (size_t k = 0; k < of.n; k++) cloud->volume[of.point[k]] += cells->volume[c] / (double) of.n;
    }
done:
    cells_sites_clear (&sites);
    pg_nearest_free (&nearest);
    return status;
}
