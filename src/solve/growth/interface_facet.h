/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: interfaces between materials, for facets that are tried. */
#ifndef PG_INTERFACE_FACET_H
#define PG_INTERFACE_FACET_H
#include "trial_facet.h"

/* A place where a circle or a line passes from one material to another. */
typedef struct { double x[3]; int material[2]; } crossing;
/* Places where the circle of that radius (m) about x crosses an interface inside the body; returns how
 * many, at most `most`. */
size_t interface_around (trials *w, const double *x, double radius, size_t most, crossing *out);
/* The first interface from x along a unit direction: its distance, m, at most `limit`; 1: there is one. */
int    interface_ahead  (trials *w, const double *x, const double *direction, double limit, double *distance,
                         crossing *out);
/* Evaluation points, which tell the material at a place, if there are several materials; needed before the
 * others. *several: 0: there is but one material. */
pg_status interface_ready (trials *w, int *several);
#endif
