/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: interfaces between materials, for trial facets. */
#ifndef PG_INTERFACE_FACET_H
#define PG_INTERFACE_FACET_H
#include "trial_facet.h"

/* A point where a circle or a line passes from one material to another. */
typedef struct { double x[3]; int material[2]; } crossing;
/* Finds points where the circle of that radius (m) about x crosses an interface inside the body; returns how
 * many, at most `most`. */
size_t interface_around (trials *w, const double *x, double radius, size_t most, crossing *out);
/* Finds the first interface from x along a unit direction: *distance, m, at most `limit`; returns 1 if there
 * is one. */
int    interface_ahead  (trials *w, const double *x, const double *direction, double limit, double *distance,
                         crossing *out);
/* Prepares the evaluation points, which tell the material at a point, if there are several materials; to be
 * called first. *several 0: there is one material only. */
pg_status interface_ready (trials *w, int *several);
#endif
