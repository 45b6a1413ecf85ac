/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the forces whose unknowns are the values of the points: supports by elimination, loads given to
 * points, the work balance. Unknown k of point i is i * stride + k; the first dim of them are its
 * displacement, further ones its rotations times a length, so that all unknowns are lengths and what works on
 * them are forces. */
#ifndef PG_POINT_BOUNDARY_H
#define PG_POINT_BOUNDARY_H
#include "perigal/force.h"
#include "perigal/integration.h"

/* load -1: held at zero for want of stiffness */
typedef struct { size_t dof, point; int load, component; } boundary_support;
typedef struct {                                       /* what one place of a load gives to one point */
    size_t at;                                         /* index into the points of the load */
    double weight;                                     /* m^2, m^3 or 1 times the share of the point */
    double x[3], normal[3];                            /* m; 1 */
} boundary_share;
typedef struct {
    int     load, separates;                           /* separates: pattern is that of factor 1, for good */
    size_t  npoint, npart;
    int    *point;                                     /* ascending, each once (npoint) */
    boundary_share *part;                                  /* NULL once the pattern is known */
    int     first, components;                         /* unknowns of a point it works on */
    double *pattern;  /* N, of factor 1; else of `time` (npoint x components) */
    double  time;                                      /* s */
} boundary_load;
typedef struct { size_t dof, point; int load, component; double stiffness; } boundary_spring;     /* N/m */
typedef struct {
    const pg_problem *problem;
    int        dim, stride;
    double     length;                                 /* of rotations, m */
    size_t     n;
    /* ascending by unknown, each once: the first entry that prescribes it */
    boundary_support *support;  size_t nsupport;
    double    *goal;  /* m, of factor 1 where its load separates (nsupport) */
    /* Of each load: 1: a support that is a pattern times a factor of t; that factor at the last t */
    unsigned char *separates;
    double    *factor;
    boundary_load *load;  size_t nload;
    boundary_spring *spring;  size_t nspring;
    double    *hold;  /* stiffness of the springs at every unknown, N/m; NULL: there are none (n x stride) */
    pg_nearest *near;                                  /* points; NULL until facets ask for them */
    pg_sparse  T;                                      /* selects the free unknowns */
} point_boundary;

/* idle: points whose rotations nothing resists, which are held; NULL: none (n). */
pg_status boundary_create (point_boundary *s, const pg_problem *problem, int stride, double length,
                        const unsigned char *idle);
void      boundary_free   (point_boundary *s);
/* Which points a load acts on and by which share (boundary_shares.c). */
pg_status boundary_shares  (boundary_load *out, point_boundary *s, int load);
void      boundary_add    (point_boundary *s, double t, double *P);              /* P += loads at t, N */
/* P += tractions of a uniform stress (as pg_force_type.surface) on the facets of load number `load`, N. */
pg_status boundary_surface (point_boundary *s, int load, const double *stress, double *P);
/* norm of the loads at t, N */
double    boundary_reference (point_boundary *s, double t, double inside);
/* Springs of `boundary` (boundary_springs.c). residual += their forces at displacement d, N; y += K x; what
 * they store at d, J. */
pg_status boundary_make_springs (point_boundary *s);
void      boundary_pull   (const point_boundary *s, double t, const double *d, double *residual);
void      boundary_hold   (const point_boundary *s, const double *x, double *y);
double    boundary_spring_energy (const point_boundary *s, double t, const double *d);
double    boundary_spring_goal   (const point_boundary *s, const boundary_spring *spring, double t);
/* NULL: nothing is prescribed */
const pg_sparse *boundary_basis (const point_boundary *s);
void      boundary_impose (const point_boundary *s, double t, double *d);
/* Pairs and reactions; residual: loads less resistance (and inertia) at every unknown. Strain energy is left
 * alone. */
pg_status boundary_work_balance (point_boundary *s, double t, const double *d, const double *residual,
                              pg_work_balance *out);

/* ---- between these files
 * --------------------------------------------------------------------------------- */
pg_status boundary_make_supports (point_boundary *s, const unsigned char *idle);
pg_status boundary_make_load (point_boundary *s, boundary_load *l, int load);
/* what the supports prescribe at t, m (nsupport) */
void      boundary_goals (const point_boundary *s, double t, double *out);
/* factor of its pattern at t */
double    boundary_bring_to (const point_boundary *s, boundary_load *l, double t);
/* First of the unknowns of a point that a load is about, and a unit of its values in theirs */
static inline int boundary_first (const point_boundary *s,
                                  const pg_load *load) { return pg_load_rotates (load) ? s->dim : 0; }
static inline double boundary_unit (const point_boundary *s, const pg_load *load)
{
    return load->kind == PG_ROTATION ? s->length : load->kind == PG_MOMENT ? 1 / s->length : 1;
}
#endif
