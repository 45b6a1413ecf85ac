/* SPDX-License-Identifier: GPL-3.0-or-later
 * Volumes of points from cut cells. */
#include "sites.h"
#include <string.h>

pg_status pg_cells_share (pg_cloud *cloud, const pg_cells *cells, const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    cells_sites sites = {0};
    pg_nearest *nearest = NULL;
    size_t dim = (size_t) cells->dim;
    if (!cells->cut) return PG_OK;                         /* the lattice's own volumes are exact                        */
    PG_TRY (cells_sites_create (&sites, lattice, cloud));
    PG_TRY (pg_nearest_create (&nearest, cloud->dim, cloud->n, cloud->x));
    memset (cloud->volume, 0, cloud->n * sizeof *cloud->volume);
    for (size_t c = 0; c < cells->n; c++) {
        const double *low = cells->x + cells->start[c] * dim, *high = low + (dim == 3 ? 6 : dim == 2 ? 2 : 1) * dim;
        int i[3], point[8];
        double middle[3];
        cells_sites_cell (&sites, low, i);
        int n = cells_sites_points (&sites, i, 0, point);
        for (size_t k = 0; k < dim; k++) middle[k] = 0.5 * (low[k] + high[k]);
        if (n == 0) point[n++] = (int) pg_nearest_find (nearest, middle, NULL, NULL);
        for (int k = 0; k < n; k++) cloud->volume[point[k]] += cells->volume[c] / n;
    }
done:
    cells_sites_clear (&sites);
    pg_nearest_free (&nearest);
    return status;
}
