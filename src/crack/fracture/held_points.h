/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: nodes constrained by intact bonds. */
#ifndef PG_HELD_POINTS_H
#define PG_HELD_POINTS_H
#include "perigal/model.h"

/* Returns 1: intact bonds constrain node i in every direction; else its displacement is undetermined, and it
 * is left out of measurements. Central forces need bonds in dim directions; other forces one bond; with Gauss
 * points a node is constrained unless an unsided crack passes through it. */
int point_is_held (const pg_problem *p, const pg_state *state, size_t i);
#endif
