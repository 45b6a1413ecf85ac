/* SPDX-License-Identifier: GPL-3.0-or-later
 * Where cracks cross the borders of background cells: integrals over their faces are sums over the pieces in
 * between, in contact (contact/pieces.c) as in cells that end at cracks (force/galerkin_ended_plan.c), so
 * that both see the same displacement. */
#include "model.h"
#include <math.h>
#include <stdlib.h>

pg_status pg_crack_breaks (const pg_problem *p, const double *a, const double *b, size_t *n, double **share)
{
    pg_status status = PG_OK;
    double *all = NULL, nothing = pg_cloud_same (&p->cloud), length = hypot (b[0] - a[0], b[1] - a[1]), in[2];
    size_t cap = 0, count = 2, kept = 0;
    PG_GROW (all, cap, 2);
    all[0] = 0, all[1] = 1;
    for (size_t c = 0; p->consistency && p->dim == 2 && c < p->cells.n; c++) {
        if (!pg_cell_clip (&p->cells, c, a, b, nothing, in)) continue;
        PG_GROW (all, cap, count + 2);
        all[count++] = in[0], all[count++] = in[1];
    }
    pg_sort (all, count, sizeof *all, pg_ascending_numbers);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || (all[i] - all[kept - 1]) * length > 8 * nothing) all[kept++] = all[i];
    all[kept - 1] = 1;
    *n = kept, *share = all, all = NULL;
done:
    pg_free (all);
    return status;
}
