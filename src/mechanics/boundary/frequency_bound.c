/* SPDX-License-Identifier: GPL-3.0-or-later
 * An upper bound of the largest eigenfrequency: in closed form where a force has one, else by Gershgorin. */
#include "perigal/force.h"
#include <math.h>

/* omega: the bound, rad/s; NAN: the force has none. Explicit time steps are stable up to 2 / omega. */
pg_status pg_force_bound (const pg_force_type *force, void *self, const pg_cloud *cloud, size_t ndof,
                          const double *mass, double *workspace, double *omega, const char **from)
{
    pg_status status = PG_OK;
    double top = 0;
    *omega = NAN, *from = "largest frequency";
    if (force->motion.bound) {
        *from = "bound of the largest frequency";
        PG_TRY (force->motion.bound (self, omega));
    } else if (force->motion.row_sums) {
        *from = "bound by row sums";
        PG_TRY (force->motion.row_sums (self, workspace));
        for (size_t i = 0; i < ndof; i++)
            if (pg_cloud_owns (cloud, i / (ndof / cloud->n))) top = fmax (top, workspace[i] / mass[i]);
        *omega = sqrt (top);
    }
done:
    return status;
}
