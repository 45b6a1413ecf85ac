/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nodal integration: the points are the nodes, weight = volume of the node (Cui 2022 section 1.2). */
#include "perigal/integration.h"

const pg_integration_type pg_integration_nodal = { "nodal", "one evaluation per node, weight = its volume", 1,
                                                   0, NULL };
