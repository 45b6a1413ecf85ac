/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: nodes that live bonds hold. */
#ifndef PG_HELD_POINTS_H
#define PG_HELD_POINTS_H
#include "perigal/model.h"

/* Do live bonds hold node i in every direction? Where they do not its displacement is not determined, and
 * measures leave it out. With forces along bonds it takes bonds in as many directions as there are
 * dimensions; else one bond, or the shape functions of points that are no nodes, unless a crack passes
 * through the node. */
int point_is_held (const pg_problem *p, const pg_state *state, size_t i);
#endif
