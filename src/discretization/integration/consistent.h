/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to consistent integration: closing.c (fluxes of faces), hosts.c (small cells, and the cells that
 * integrate them). */
#ifndef PERIGAL_INTEGRATION_CONSISTENT_H
#define PERIGAL_INTEGRATION_CONSISTENT_H
#include "perigal/integration.h"

/* Changes fluxes of boundary facets so that the quadrature of each cell obeys the divergence theorem for 1
 * and x: c->faces, c->amended, c->uneven. */
pg_status consistent_close (pg_consistency *c, const pg_rows *points);
/* Finds c->hosts, c->guests, c->needs and c->opens. */
pg_status consistent_hosts (pg_consistency *c);
#endif
