/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to initiation.c: new cracks whose faces touch and slide (shear_initiation.c). */
#ifndef PG_SHEAR_INITIATION_H
#define PG_SHEAR_INITIATION_H
#include "hot_spot.h"

/* A new crack that may slide. face[4] in these functions: normal stress on its plane (constant part, slope
 * over the load factor), shear stress along the crack on the side of the normal (constant, slope), Pa. */
typedef struct {
    int    sense;                                      /* sign of the shear stress; 0: it opens in tension */
    double friction, cohesion;                         /* of its faces: coefficient; cohesion, Pa */
    const pg_material *material;
} shear_start;

/* Finds the sliding crack of a hot spot, on one (side 0) or the other of the two planes on which the strength
 * is reached: its angle, rad. */
void      shear_lay   (const search *g, const hot_spot *spot, int side, double *angle, shear_start *out);
/* Stress that drives a crack at one point, constant part (k = 0) or slope over the load factor (1), Pa: the
 * normal stress, or the shear stress less the friction on its faces. */
double    shear_drive (const shear_start *c, const double face[4], int k);
/* Finds the fields of the search less the uniform stress that the faces of such a crack would bear: sliding
 * releases the rest. `out` is stored in the trials until the next call. */
pg_status shear_free_fields (const search *g, const shear_start *c, double angle, const double face[4],
                             trial_fields *out);
#endif
