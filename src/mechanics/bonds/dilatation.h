/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private: forces that follow from the dilatations of both ends of a bond, of state-based theory (Silling
 * et al. 2007; theory B6) and beside micropolar bonds (theory G3): q = sum w r^2 V, theta = (d / q) sum w
 * xi.eta V, t = (A theta / q) w r + (B / q) w e.eta, f = (t_i + t_j) e, w = k beta / r. As their K couples
 * neighbours of neighbours, it is not assembled: there are products K x, its diagonal, and rows for
 * preconditioners. */
#ifndef PG_DILATATION_H
#define PG_DILATATION_H
#include "bond_force.h"

typedef struct dilatation_rows dilatation_rows;        /* dilatation_rows.c */
typedef struct dilatation {
    /* constants A and B of each point, Pa; beside micropolar bonds B is 0 (n) */
    double *A, *B;
    double *q;  unsigned long weighed;                 /* weighted volumes, m^4 (n), made at that revision */
    /* C / q, C = B + d max (A, 0): pair forces along bonds with the constant C_i / q_i + C_j / q_j are at
     * least as stiff as these forces (n) */
    double *stiff;
    unsigned char *counted;                            /* 1: no pre-crack cuts the bond; NULL: none is cut */
    dilatation_rows *rows;                             /* rows for the last preconditioner; NULL: none yet */
} dilatation;
/* Sets b->dilatation, A and B still 0, and fills its part of b->setting. */
pg_status dilatation_create (bond_force *b);
void      dilatation_free   (bond_force *b);          /* b->dilatation may be NULL */
/* Computes q and stiff from the intact bonds; does nothing without a dilatation. */
pg_status dilatation_weigh  (bond_force *b);
/* bond_theory.find_dying */
pg_status dilatation_dying  (bond_force *b, const double *d, size_t *count);
/* Returns k beta of bond e: dilatations have no surface correction. */
double    dilatation_weight (const bond_force *b, size_t i, const point_bonds *s, size_t e);
/* Adds to own and other (blocks) a pair force along the bond with the constant `both`, N/m^6. */
void      dilatation_pull   (const bond_force *b, size_t i, const point_bonds *s, size_t e, double both,
                             double *own, double *other);
/* Adds the diagonal block of point i in K to D, N/m. */
void      dilatation_own    (const bond_force *b, size_t i, const point_bonds *s, double *D);
/* Upper bound of omega^2 times density for point i, which holds whatever bonds break. */
double    dilatation_bound  (const bond_force *b, size_t i, const point_bonds *s);
/* Virial stress of point i: T += sum t x xi V, Pa. */
void      dilatation_virial (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                             const double *d, double *T);
/* Fills in `row`, `alike` and `lattice` of out: rows of K for preconditioners. */
pg_status dilatation_couplings (bond_force *b, pg_couplings *out);
void      dilatation_rows_free (bond_force *b);
#endif
