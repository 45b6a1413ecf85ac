/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the symbol folder. */
#ifndef PG_SYMBOL_PRIVATE_H
#define PG_SYMBOL_PRIVATE_H
#include "perigal/symbol.h"

/* ---- box.c: (2 half + 1)^dim points of the lattice about one at the origin ----------------------------- */
/* wanted: its spacing; odd: the axis with a step of its own */
typedef struct { double step[3], h, wanted; int half[3], odd; } box_size;
/* half is left alone */
pg_status box_steps (box_size *out, const pg_scene *scene, const pg_problem *problem);
pg_status box_scene (pg_scene **out, const pg_scene *scene, const pg_problem *problem, const box_size *size);
pg_status box_fits  (const box_size *size, int dim);
#endif
