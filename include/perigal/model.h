/* SPDX-License-Identifier: GPL-3.0-or-later
 * model.h: the problem (constant once built) and the state (all that evolves). */
#ifndef PERIGAL_MODEL_H
#define PERIGAL_MODEL_H
#include "perigal/scene.h"
#include "perigal/criterion.h"
#include "perigal/cells.h"
#include "perigal/approx.h"
#include "perigal/integration.h"

/* ---- loads and supports ------------------------------------------------------------------------------------------------ */
typedef enum { PG_DISPLACEMENT, PG_VELOCITY, PG_TRACTION, PG_PRESSURE, PG_POINT_FORCE, PG_BODY_FORCE } pg_load_kind;
typedef enum { PG_ESSENTIAL_NITSCHE, PG_ESSENTIAL_TRANSFORMATION, PG_ESSENTIAL_PENALTY } pg_essential;
typedef struct {
    char           name[64];
    pg_load_kind   kind;
    const pg_set  *set;
    pg_expression *value[3];                           /* per component, NULL: free; m, m/s, Pa, N, N/m^3                */
    pg_expression *ramp;                               /* factor of t; NULL: from the table                              */
    double        *table; size_t ntable;               /* ntable x 2: t (s), factor                                      */
    int            proportional;                       /* factor is t itself                                             */
    pg_essential   essential;                          /* how PG_DISPLACEMENT and PG_VELOCITY are imposed                */
} pg_load;
/* Component k of the load at place x and time t (s; static: load factor). */
double pg_load_value (const pg_load *load, int k, int dim, const double *x, double t);
int    pg_load_prescribes (const pg_load *load);       /* displacement or velocity                                       */

/* ---- problem ----------------------------------------------------------------------------------------------------------- */
/* Bond sets, each a list of points and the nodes they see (style: one array of alive bits per set, all in state). */
enum { PG_NODES, PG_POINTS, PG_FACETS, PG_BOND_SETS };
typedef struct { char name[32]; double from[3], to[3]; } pg_gauge;      /* opening along from -> to, m                     */
typedef struct {
    char     title[256], name[64];                     /* name: of the scene's folder or file                            */
    int      dim, threads;
    pg_mode  mode;
    pg_body  body;  pg_lattice lattice;  pg_cloud cloud;  pg_cells cells;  pg_sets sets;  pg_cracks cracks;
    pg_material  *material;  size_t nmaterial;         /* material[cloud.block[i]]                                       */
    pg_criterion  criterion;                           /* type NULL: nothing breaks                                      */
    pg_approx     approx;
    const pg_integration_type *integration;
    char     force[32];
    double   silling;                                  /* Gs; 0: no stabilisation                                        */
    double   nitsche, penalty;                         /* factors of E / h                                               */
    pg_load *load;   size_t nload;
    pg_gauge *gauge; size_t ngauge;
    pg_rows  rows[PG_BOND_SETS];                       /* geometry only: N, dN, w, grade are NULL                        */
    size_t   first_bond[PG_BOND_SETS + 1];             /* bond b of set k is alive[first_bond[k] + b]                    */
    unsigned char *exempt[PG_BOND_SETS];               /* per point: its bonds never break (failure: exclude)            */
    size_t   eroded;                                   /* points that lie on a pre-crack                                 */
} pg_problem;
pg_status pg_problem_build (pg_problem **out, const pg_scene *scene, int threads);
void      pg_problem_free  (pg_problem **problem);
/* The bond set and the point of that set that own a bond (an index into state->alive). */
void      pg_problem_locate (const pg_problem *problem, size_t bond, int *set, size_t *point);
int       pg_problem_proportional (const pg_problem *problem);   /* every load is a constant pattern times t               */

/* ---- state: one block, copyable, comparable, savable ---------------------------------------------------------------------- */
typedef struct {
    size_t  ndof, nbond, bytes;
    double  time;                                      /* s; static: load factor of the last report                      */
    double  factor;                                    /* load factor (static)                                           */
    long    step, events, iterations, broken, history_rows;
    double  work;                                      /* external work so far, J                                        */
    double *d, *v, *a;                                 /* coefficients, velocity, acceleration (ndof): m, m/s, m/s^2      */
    unsigned char *alive;                              /* 1: the bond lives  (nbond)                                     */
} pg_state;
pg_status pg_state_create (pg_state **out, const pg_problem *problem, int components /* dofs per node */);
pg_status pg_state_copy   (pg_state *to, const pg_state *from);
void      pg_state_free   (pg_state **state);
#endif
