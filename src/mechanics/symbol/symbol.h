/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the symbol folder: the box of (2 half + 1)^dim lattice points around one at the origin, on
 * which the force is measured (box.c). */
#ifndef PG_SYMBOL_PRIVATE_H
#define PG_SYMBOL_PRIVATE_H
#include "perigal/symbol.h"

/* ---- box.c: (2 half + 1)^dim points of the lattice about one at the origin ----------------------------- */
/* The size of a box: steps of the lattice (m), the dim-th root of their product (m), the spacing that the
 * box's scene asks for (m), points on each side of the middle along each axis, and the axis whose step
 * differs from the others. */
typedef struct { double step[3], h, wanted; int half[3], odd; } box_size;
/* Fills all but `half` from the scene's lattice. PG_E_USAGE where there is no lattice. */
pg_status box_steps (box_size *out, const pg_scene *scene, const pg_problem *problem);
/* Makes the scene of the box. */
pg_status box_scene (pg_scene **out, const pg_scene *scene, const pg_problem *problem, const box_size *size);
/* PG_E_USAGE if no single spacing gives the right number of cells along every axis. */
pg_status box_fits  (const box_size *size, int dim);
#endif
