/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: micropolar bonds (gmpd) as the scene asks for them: elongation, shear and bending of a bond, and
 * the share of a dilatation beside them. */
#ifndef PG_MICROPOLAR_H
#define PG_MICROPOLAR_H
#include "perigal/model.h"

/* What is read from the scene (pg_problem.options). */
typedef struct {
    double bending;                                    /* B / C_t */
    /* Poisson's ratio asked of the bonds; NAN: the usual one */
    double bond_poisson;
} gmpd_options;
/* Young's modulus (Pa) and Poisson's ratio of what the bonds of a material make alone; dilation (Pa): A of
 * the dilatation beside them (pg_beam_split), 0 without volumetric: on. */
void      gmpd_split  (const pg_problem *problem, size_t material, double *E, double *nu, double *dilation);
#endif
