/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the forces whose unknowns are the values of the points: supports by elimination, loads given to
 * points, the work balance. Unknown k of point i is i * stride + k; the first dim of them are its
 * displacement, further ones its rotations times a length, so that all unknowns are lengths and what works on
 * them are forces. */
#ifndef PG_NODAL_H
#define PG_NODAL_H
#include "perigal/force.h"
#include "perigal/integration.h"

/* load -1: held at zero for want of stiffness */
typedef struct { size_t dof, point; int load, component; } nodal_support;
typedef struct {                                       /* what one place of a load gives to one point */
    size_t at;                                         /* index into the points of the load */
    double weight;                                     /* m^2, m^3 or 1 times the share of the point */
    double x[3], normal[3];                            /* m; 1 */
} nodal_part;
typedef struct {
    int     load, separates;                           /* separates: pattern is that of factor 1, for good */
    size_t  npoint, npart;
    int    *point;                                     /* ascending, each once (npoint) */
    nodal_part *part;                                  /* NULL once the pattern is known */
    int     first, components;                         /* unknowns of a point it works on */
    double *pattern;  /* N, of factor 1; else of `time` (npoint x components) */
    double  time;                                      /* s */
} nodal_load;
typedef struct {
    const pg_problem *problem;
    int        dim, stride;
    double     length;                                 /* of rotations, m */
    size_t     n;
    /* ascending by unknown, each once: the first entry that prescribes it */
    nodal_support *support;  size_t nsupport;
    double    *goal;  /* m, of factor 1 where its load separates (nsupport) */
    nodal_load *load;  size_t nload;
    pg_sparse  T;                                      /* selects the free unknowns */
} nodal;

/* idle: points whose rotations nothing resists, which are held; NULL: none (n). */
pg_status nodal_create (nodal *s, const pg_problem *problem, int stride, double length,
                        const unsigned char *idle);
void      nodal_free   (nodal *s);
/* Which points a load acts on and by which share (nodal_parts.c). */
pg_status nodal_parts  (nodal_load *out, const nodal *s, int load);
void      nodal_add    (nodal *s, double t, double *P);              /* P += loads at t, N */
/* P += tractions of a uniform stress (as pg_force_type.surface) on the facets of load number `load`, N. */
pg_status nodal_surface (const nodal *s, int load, const double *stress, double *P);
double    nodal_size   (nodal *s, double t);                         /* norm of the loads at t, N */
const pg_sparse *nodal_basis (const nodal *s);                       /* NULL: nothing is prescribed */
void      nodal_impose (const nodal *s, double t, double *d);
/* Pairs and reactions; residual: loads less resistance (and inertia) at every unknown. Strain energy is left
 * alone. */
pg_status nodal_work_balance (nodal *s, double t, const double *d, const double *residual,
                              pg_work_balance *out);
#endif
