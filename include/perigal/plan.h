/* SPDX-License-Identifier: GPL-3.0-or-later
 * plan.h: predicts the memory and sizes of a run before anything large is allocated: points and bonds by
 * counting, the factor of the stiffness matrix by the law of nested dissection or by its analysis, bytes, and
 * whether several processes divide the body. */
#ifndef PERIGAL_PLAN_H
#define PERIGAL_PLAN_H
#include "perigal/solve.h"

PG_API_BEGIN

/* ---- sizes and memory ---------------------------------------------------------------------------------- */
enum {
    PG_BYTES_PROGRAM,
    PG_BYTES_POINTS,
    PG_BYTES_BONDS,
    PG_BYTES_SHAPES,
    PG_BYTES_BREAKING,
    PG_BYTES_MATRIX,
    PG_BYTES_FACTOR,
    PG_BYTES_VECTORS,
    PG_BYTES_RESULTS,
    PG_BYTES_COUNT
};
/* Properties of a run, 1 or 0. */
typedef struct {
    int    nodal, breaks, pictures;  /* nodal: nodal integration; breaks: with a failure criterion */
    int    matrixless;                                 /* the force has no matrix (state-based) */
    int    listed, explicit_;  /* listed: points form no lattice; explicit_: no linear systems */
    int    by_list;  /* without shape functions: sums by lists of neighbours, on a lattice or off it */
    int    counted, analysed;  /* 1: the counts, the factor are exact, 0: estimates */
    int    automatic, dynamic;                         /* automatic: solver.linear: auto; dynamic: newmark */
    /* events: a factor would serve many events; elements: a finite element preconditioner is available */
    int    events, elements;
    int    interpolates, behind, scattered;            /* as in pg_solve_counts */
    int    irregular;                                  /* points form no lattice, or are perturbed */
    int    pressed;                                    /* 1: contact of crack faces, 2: with friction */
    int    shared;  /* lattice points without breaking bonds share equal rows of shape functions */
} pg_run_traits;
/* Counts of a run. */
typedef struct {
    /* points; cells; Gauss points (nodal integration: 0); facet points */
    double points, cells, evaluation, facets;
    double bonds[PG_BOND_SETS], dofs;
    double mesh, reading;  /* bytes of a mesh kept by every rank; bytes needed while points are read */
    double columns;                                    /* as in pg_solve_counts */
    double slaves, eliminated;  /* essential: transformation: eliminated unknowns; entries of its matrices */
    double summed;  /* consistent integration: bonds of its points and faces; else 0 */
    double patched;  /* sum of the nodes of all patches of the dilatation, if the problem is built */
    double pairs;  /* pairs of nodes I <= J that share an evaluation point */
    double fields;                                     /* number of fields in result.e */
} pg_run_counts;
typedef struct {
    int    dim, rotations;                             /* dim; rotational unknowns per point */
    const pg_method *method;                           /* the force */
    pg_run_traits is;
    pg_run_counts count;
    /* solver that factorises K; NULL: conjugate gradients, no matrix */
    const struct pg_linear_type *linear;
    int    order;                                      /* order of the basis */
    double weight;  /* dynamics: beta (2 c_p dt)^2, m^2: weight of K relative to M at spacing 1 */
    char   ordering[16];                               /* ordering of an analysed factor */
    double spacing, step[3], horizon;                  /* m */
    /* nodes along each axis of the body; width of a separator in nodes (nested dissection) */
    double edge[3], width;
    double matrix_entries, factor_entries, factor_flops;  /* of the upper triangle of K; of the factor L */
    double bytes[PG_BYTES_COUNT], peak;
} pg_forecast;
/* Makes a forecast from the scene alone: points and bonds by counting on its lattice (a coarser one when it
 * has more than 4e6 cells), the factor by the law of nested dissection. PG_E_SCENE: the scene has faults,
 * which were added to it. */
pg_status pg_forecast_scene   (pg_forecast *out, const pg_scene *scene, const pg_method *const *methods);
/* Replaces estimated counts by those of the problem built from that scene. */
pg_status pg_forecast_problem (pg_forecast *f, const pg_problem *problem);
/* Replaces pairs and factor by those of an analysis (pg_assembly_graph, pg_linear_forecast). */
void pg_forecast_analysed (pg_forecast *f, double pairs, const char *ordering, double entries, double flops);
/* Forecast for the same body at another spacing (m), by scaling; for another linear solver or integration:
 * set linear, nodal and sum anew. */
pg_forecast pg_forecast_at    (const pg_forecast *f, double spacing);
void        pg_forecast_sum   (pg_forecast *f);        /* bytes and peak from the counts */
/* Forecast for a rank that stores this part of the `total` points (collects: it also joins the results);
 * in_step: for each of `ranks` ranks that all store the whole body and share the factor. */
pg_forecast pg_forecast_of_part (const pg_forecast *f, const pg_part_size *part, double total, int collects);
pg_forecast pg_forecast_in_step (const pg_forecast *f, int ranks);
/* Smallest spacing (m, rounded to 2 digits) whose peak fits into `available` bytes. */
double      pg_forecast_fitting (const pg_forecast *f, double available);
/* Name of the linear solver, or "cg"; pg_forecast_afford: PG_E_LIMIT, with remedies in the message, if the
 * peak exceeds `available` bytes. */
const char *pg_forecast_linear (const pg_forecast *f);
pg_status   pg_forecast_afford (const pg_forecast *f, double available);
const char *pg_forecast_item  (int item);              /* "bonds", ... */
/* Bytes of memory still available to this process: the least of free memory, control groups (v2, v1) and
 * RLIMIT_AS. root: "" (tests: a folder that holds proc and sys). */
double      pg_available_memory (const char *root);

/* ---- several processes --------------------------------------------------------------------------------- */
/* 1: the points of the body are to be divided among ranks (perigal/ranks.h); 0: every rank stores all, and
 * they share matrices. Depends on solver.kind and solver.division; auto: divided if a force between points
 * has, by a forecast, so many unknowns that one process would solve without a factor, and nothing in the
 * scene needs the whole body. Errors found by the forecast are added to the scene. Collective, before the
 * problem is built. */
int       pg_subdomain_wanted (const pg_scene *scene, const pg_method *const *methods);
PG_API_END
#endif
