/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nodal integration (Cui 2022, section 1.2): the evaluation points are the nodes and the weights their
 * volumes. Cheap, and needs no cells; but it underintegrates, so that correspondence models have
 * zero-energy modes, which stabilisation (silling.c) removes. */
#include "perigal/integration.h"

const pg_integration_type pg_integration_nodal = { "nodal", "one evaluation per node, weight = its volume", 1,
                                                   0, NULL };
