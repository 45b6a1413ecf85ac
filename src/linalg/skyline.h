/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: what an envelope will hold and cost, from the graph of the nodes alone. */
#ifndef PG_LINALG_SKYLINE_H
#define PG_LINALG_SKYLINE_H
#include "perigal/linalg.h"
/* As pg_linear_forecast. */
pg_status skyline_forecast (const pg_sparse *nodes, int block, pg_linear_info *info);
extern const pg_linear_type pg_linear_skyline;
#endif
