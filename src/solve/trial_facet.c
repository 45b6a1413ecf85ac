/* SPDX-License-Identifier: GPL-3.0-or-later
 * Trial facets: cracks that begin, and the last steps of tips that have no room for a ring. */
#include "facet_growth.h"

pg_status trial_facets (break_loop *b, const pg_state *state, const double *const *d, const double *t)
{
    (void) b, (void) state, (void) d, (void) t;
    return PG_OK;
}
