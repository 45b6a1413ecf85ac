/* SPDX-License-Identifier: GPL-3.0-or-later
 * Draws 1D bodies as a chart. */
#include "picture_private.h"

/* Draws the value over the (displaced) coordinate, by which the points are sorted; one curve per panel. */
pg_status pg_draw_bars (const char *path, const pg_cloud *cloud, size_t npanel, const pg_panel *panel,
                        const pg_picture_style *style)
{
    pg_status status = PG_OK;
    double *pair = NULL, *x = NULL, *y = NULL;
    pg_curve *curve = NULL;
    size_t n = cloud->n;
    PG_ALLOC (pair, 2 * n);
    PG_ALLOC (x, n * npanel);
    PG_ALLOC (y, n * npanel);
    PG_ALLOC (curve, npanel);
    for (size_t k = 0; k < npanel; k++) {
        const double *u = panel[k].u;
        for (size_t i = 0; i < n; i++)
            pair[2 * i] = cloud->x[i] + (u ? style->magnify * u[i] : 0), pair[2 * i + 1] = panel[k].value[i];
        pg_sort (pair, n, 2 * sizeof (double), pg_ascending_numbers);
        for (size_t i = 0; i < n; i++) x[k * n + i] = pair[2*i], y[k * n + i] = pair[2*i + 1];
        curve[k] = (pg_curve) { panel[k].title, n, x + k * n, y + k * n, n <= 60 };
    }
    PG_TRY (pg_picture_chart (path, npanel, curve,
                              &(pg_chart_style){
                                  .title = style->title, .xlabel = "x (m)", .ylabel = style->label }));
done:
    pg_free (curve);
    pg_free (y);
    pg_free (x);
    pg_free (pair);
    return status;
}
