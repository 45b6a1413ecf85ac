/* SPDX-License-Identifier: GPL-3.0-or-later
 * Small systems, which are factored in less time than it takes to load BLAS, CHOLMOD and what these need
 * themselves (most of it is OpenBLAS, whose tables of functions are filled with 14 000 looked-up names). */
#include "skyline.h"

/* Seconds by stored rates, never measured: loading; operations within an envelope, and those of CHOLMOD,
 * which are fewer by about this factor. */
static const double loading = 3.5e-3, envelope_rate = 1e10, library_rate = 8e9, fewer = 3;
/* More unknowns are not looked at. */
enum { MOST = 20000 };

static int may_be_small (const pg_linear_type *type, size_t n, int many)
{
    return type == pg_linear_first (1, 1) && !many && n <= MOST;
}

/* Do so many operations within an envelope pay? */
static int pays (const pg_linear_info *info)
{
    return info->flops / envelope_rate <= loading + info->flops / fewer / library_rate;
}

pg_status pg_linear_analyse (const pg_linear_type **type, void **self, const pg_sparse *A,
                             const pg_linear_options *o)
{
    pg_status status = PG_OK;
    pg_linear_info info;
    if (may_be_small (*type, A->ncol, o->many)) {
        PG_TRY (pg_linear_skyline.analyse (self, A, o));
        pg_linear_skyline.info (*self, &info);
        if (pays (&info)) {
            *type = &pg_linear_skyline;
            return PG_OK;
        }
        pg_linear_skyline.free (self);
    }
    status = (*type)->analyse (self, A, o);
done:
    return status;
}

pg_status pg_linear_forecast_fitting (const pg_linear_type **type, const pg_sparse *graph, int block,
                                      int many, pg_linear_info *info)
{
    pg_status status = PG_OK;
    if (may_be_small (*type, graph->ncol * (size_t) block, many)) {
        PG_TRY (skyline_forecast (graph, block, info));
        if (pays (info)) {
            *type = &pg_linear_skyline;
            return PG_OK;
        }
    }
    status = pg_linear_forecast (graph, block, many, info);
done:
    return status;
}
