/* SPDX-License-Identifier: GPL-3.0-or-later
 * Private to the forces whose unknowns are the values of the points: supports by elimination, loads applied
 * to points, the work balance. Unknown k of point i is i * stride + k; the first dim of them are its
 * displacement, further ones its rotations times a length, so that all unknowns are lengths (m) and the
 * forces conjugate to them are in N. */
#ifndef PG_POINT_BOUNDARY_H
#define PG_POINT_BOUNDARY_H
#include "perigal/force.h"
#include "perigal/integration.h"

/* A prescribed unknown; load -1: a rotation without stiffness, held at zero. */
typedef struct { size_t dof, point; int load, component; } boundary_support;
typedef struct {                             /* contribution of one quadrature point of a load to one point */
    size_t at;                                         /* index into the points of the load */
    double weight;                                     /* area, volume or 1 (m^2, m^3, 1) times the share */
    double x[3], normal[3];                            /* position, m; unit normal */
} boundary_share;
typedef struct {
    int     load, separates;                           /* separates: 1: a pattern times a factor of t */
    size_t  npoint, npart;
    int    *point;                                     /* points that the load acts on, ascending (npoint) */
    boundary_share *part;                                  /* NULL once the pattern is known */
    int     first, components;                         /* unknowns of a point that the load acts on */
    double *pattern;  /* forces, N (npoint x components): of factor 1 if `separates`, else at `time` */
    double  time;                                      /* time of `pattern`, s */
} boundary_load;
/* stiffness, N/m */
typedef struct { size_t dof, point; int load, component; double stiffness; } boundary_spring;
typedef struct {
    const pg_problem *problem;
    int        dim, stride;
    double     length;                                 /* m; unknowns of rotations are angle x length */
    size_t     n;
    /* Prescribed unknowns, ascending, each once: by the first entry of the scene that prescribes it. */
    boundary_support *support;  size_t nsupport;
    double    *goal;  /* prescribed values, m (nsupport): of factor 1 where the load separates */
    /* Of each load: 1: it is a support whose values are a pattern times a factor of t; that factor at the
     * last t. */
    unsigned char *separates;
    double    *factor;
    boundary_load *load;  size_t nload;
    boundary_spring *spring;  size_t nspring;
    double    *hold;  /* stiffness of the springs at every unknown, N/m; NULL: there are none (n x stride) */
    pg_nearest *near;                                  /* search for nearest points; NULL until needed */
    pg_sparse  T;                                      /* selects the free unknowns */
} point_boundary;

/* idle (n): 1: the rotations of the point have no stiffness and are held at 0; NULL: none. */
pg_status boundary_create (point_boundary *s, const pg_problem *problem, int stride, double length,
                        const unsigned char *idle);
void      boundary_free   (point_boundary *s);
/* Which points a load acts on and by which share (boundary_shares.c). */
pg_status boundary_shares  (boundary_load *out, point_boundary *s, int load);
void      boundary_add    (point_boundary *s, double t, double *P);              /* P += loads at t, N */
/* P += tractions of a uniform stress (as pg_force_type.surface) on the facets of load number `load`, N. */
pg_status boundary_surface (point_boundary *s, int load, const double *stress, double *P);
/* Reference for residuals at t, N: norm of the loads, or, if larger, of the internal forces, whose sum of
 * squares is `inside`, N^2. */
double    boundary_reference (point_boundary *s, double t, double inside);
/* Springs of `boundary` (boundary_springs.c): make them; residual += their forces at displacement d, N; y +=
 * K x of the springs; their energy at d, J; displacement of the far end of one, m. */
pg_status boundary_make_springs (point_boundary *s);
void      boundary_pull   (const point_boundary *s, double t, const double *d, double *residual);
void      boundary_hold   (const point_boundary *s, const double *x, double *y);
double    boundary_spring_energy (const point_boundary *s, double t, const double *d);
double    boundary_spring_goal   (const point_boundary *s, const boundary_spring *spring, double t);
/* The matrix T with d = T q + g; NULL: nothing is prescribed. */
const pg_sparse *boundary_basis (const point_boundary *s);
void      boundary_impose (const point_boundary *s, double t, double *d);
/* Fills the pairs and the reactions of `out`. residual: loads minus internal forces (and inertia) at every
 * unknown, N. out->strain is left as it is. */
pg_status boundary_work_balance (point_boundary *s, double t, const double *d, const double *residual,
                              pg_work_balance *out);

/* ---- shared by the boundary_*.c files -------------------------------------------------------------- */
pg_status boundary_make_supports (point_boundary *s, const unsigned char *idle);
pg_status boundary_make_load (point_boundary *s, boundary_load *l, int load);
/* Prescribed values of all supports at t, m (nsupport). */
void      boundary_goals (const point_boundary *s, double t, double *out);
/* Evaluates a load at t; returns the factor of l->pattern. */
double    boundary_bring_to (const point_boundary *s, boundary_load *l, double t);
/* First unknown of a point that a load acts on; and the factor from a value of the load to that unknown or to
 * the force on it. */
static inline int boundary_first (const point_boundary *s,
                                  const pg_load *load) { return pg_load_rotates (load) ? s->dim : 0; }
static inline double boundary_unit (const point_boundary *s, const pg_load *load)
{
    return load->kind == PG_ROTATION ? s->length : load->kind == PG_MOMENT ? 1 / s->length : 1;
}
#endif
