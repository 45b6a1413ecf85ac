/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: pair forces along bonds (bond-based peridynamics). Force on i from j: V_i V_j c k beta g s e, s
 * = e . eta / r; linear in the displacement: kappa (xi . eta) xi, kappa = V_i V_j c k beta g / r^3 (N/m^3),
 * the same bits from either end. */
#ifndef PG_PAIRWISE_H
#define PG_PAIRWISE_H
#include "bond_force.h"

typedef struct pairwise_tiles pairwise_tiles;          /* pairwise_tiles.c */
typedef struct {
    bond_force base;
    double *modulus;                                   /* c of each point, N/m^6 (n) */
    /* kappa (N/m^3) of the bonds of a point with all bonds of the stencil; NULL: not the same bits at all
     * points */
    double *kappa;
    pairwise_tiles *tiles;                             /* NULL until a dynamic run looks for dying points */
} pairwise;
static inline const pairwise *pairwise_of (const bond_force *b) { return (const pairwise *) b; }

pg_status pairwise_create (void **self, const pg_problem *problem);
/* Returns kappa of bond e, N/m^3; writes its length r, m (or NULL). */
double    pairwise_kappa  (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *r);
/* Returns the energy density of point i by its intact bonds, J/m^3. */
double    pairwise_energy_at (const bond_force *b, size_t i, int thread, const double *d);
/* bond_theory.find_dying */
pg_status pairwise_tiles_look    (bond_force *b, const double *d, size_t *dying);
void      pairwise_tiles_forget  (bond_force *b);
void      pairwise_tiles_free    (pairwise_tiles **tiles);
/* pg_method.read: makes the sums, and sets the Poisson's ratio of materials to the only one of these
 * forces. */
pg_status pairwise_read   (pg_problem *problem, const pg_scene *scene);
#endif
