/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: micropolar bonds (gmpd) as the scene asks for them: elongation, shear and bending of a bond, and
 * the share of a dilatation beside them. */
#ifndef PG_MICROPOLAR_H
#define PG_MICROPOLAR_H
#include "dilatation.h"

/* Options of the force in the scene (pg_problem.options). */
typedef struct {
    double bending;                                    /* B / C_t */
    /* Poisson's ratio that the bonds shall have; NAN: the default */
    double bond_poisson;
} micropolar_options;
/* Young's modulus (Pa) and Poisson's ratio of the bonds of a material without dilatation; dilation (Pa): A of
 * the dilatation beside them (pg_beam_split), 0 unless the scene has volumetric: on. */
void      micropolar_split  (const pg_problem *problem, const pg_material *material, double *E, double *nu,
                             double *dilation);

typedef struct {
    bond_force base;
    double *modulus;                                   /* C_N of each point, N/m^6 (n) */
    double *shear, *bending;                           /* C_t and B of each point, N/m^4 (n) */
    /* limits gamma0 (1) and kappa0 (rad); NULL: bonds do not break by shear and bending (n) */
    double *shear_limit, *bending_limit;
    pg_beam_law law;                                   /* constants and limits above, for the bond loop */
} micropolar;
static inline const micropolar *micropolar_of (const bond_force *b) { return (const micropolar *) b; }

pg_status micropolar_create (void **self, const pg_problem *problem);
char      micropolar_kind_of (const bond_force *b, const double *d, size_t entry);   /* bond_theory.kind_of */
#endif
