/* SPDX-License-Identifier: GPL-3.0-or-later
 * plan.h: what a run will need, told before anything large is allocated: points and bonds by counting, the
 * factor of the stiffness matrix by the law of nested dissection or by its analysis, bytes, and whether
 * several processes divide the body. */
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
/* What is true of a run, 1 or 0. */
typedef struct {
    int    nodal, breaks, pictures;  /* the points of evaluation are the nodes; with a criterion */
    int    matrixless;                                 /* the force has no matrix (state-based) */
    int    listed, explicit_;  /* its points are no lattice; no linear systems at all */
    int    by_list;  /* without shape functions: sums by lists of neighbours, on a lattice or off it */
    int    counted, analysed;  /* the counts, the factor are exact, not estimates */
    int    automatic, dynamic;                         /* solver.linear: auto; newmark */
    /* events: a factor would serve many; elements: finite elements may precondition */
    int    events, elements;
    int    interpolates, behind, scattered;            /* as in pg_solve_counts */
    int    irregular;                                  /* points are on no lattice, or moved off it */
    int    pressed;                                    /* contact of crack faces, 2: with friction */
    int    shared;  /* points of a lattice, none of whose bonds breaks, share rows that are alike */
} pg_run_traits;
/* How much of everything there is. */
typedef struct {
    double points, cells, evaluation, facets;  /* Gauss points, 0 if nodal; points of facets */
    double bonds[PG_BOND_SETS], dofs;
    double mesh, reading;  /* bytes that every rank keeps of a mesh, and needs while it reads its points */
    double columns;                                    /* as in pg_solve_counts */
    double slaves, eliminated;  /* essential: transformation: unknowns, entries of its matrices */
    double summed;  /* consistent integration: what its points and faces see; else 0 */
    double patched;  /* nodes of all patches of the dilatation, once the problem is built */
    double pairs;                                      /* nodes I <= J that share a point of evaluation */
    double fields;                                     /* of result.e */
} pg_run_counts;
typedef struct {
    int    dim, rotations;                             /* rotations of a point */
    const pg_method *method;                           /* the force */
    pg_run_traits is;
    pg_run_counts count;
    /* what will factor K; NULL: conjugate gradients, no matrix */
    const struct pg_linear_type *linear;
    int    order;                                      /* of the basis */
    double weight;  /* dynamic: beta (2 c_p dt)^2, m^2: K against M at spacing 1 */
    char   ordering[16];                               /* of an analysed factor */
    double spacing, step[3], horizon;                  /* m */
    double edge[3], width;  /* nodes along the body, of a separator (nested dissection) */
    double matrix_entries, factor_entries, factor_flops;  /* upper triangle; of L */
    double bytes[PG_BYTES_COUNT], peak;
} pg_forecast;
/* From the scene alone: points and bonds by counting on its lattice (a coarser one when it has more than 4e6
 * cells), the factor by the law of nested dissection. PG_E_SCENE: the scene has faults, which were added to
 * it. */
pg_status pg_forecast_scene   (pg_forecast *out, const pg_scene *scene, const pg_method *const *methods);
/* Replaces counts by those of the problem built from that scene. */
pg_status pg_forecast_problem (pg_forecast *f, const pg_problem *problem);
/* Replaces pairs and factor by those of an analysis (pg_assembly_graph, pg_linear_forecast). */
void pg_forecast_analysed (pg_forecast *f, double pairs, const char *ordering, double entries, double flops);
/* Forecast for the same body at another spacing (m), by scaling; for another linear solver or integration:
 * set linear, nodal and sum anew. */
pg_forecast pg_forecast_at    (const pg_forecast *f, double spacing);
void        pg_forecast_sum   (pg_forecast *f);        /* bytes and peak from the counts */
/* What a rank needs that holds this part of the `total` points; collects: it also puts the result together.
 * And one of so many ranks that all hold the whole body and share the factor. */
pg_forecast pg_forecast_of_part (const pg_forecast *f, const pg_part_size *part, double total, int collects);
pg_forecast pg_forecast_in_step (const pg_forecast *f, int ranks);
/* smallest spacing (m, 2 digits) that fits */
double      pg_forecast_fitting (const pg_forecast *f, double available);
/* PG_E_LIMIT with needs, means and ways out when the peak exceeds `available` bytes. */
const char *pg_forecast_linear (const pg_forecast *f); /* its name, or "cg" */
pg_status   pg_forecast_afford (const pg_forecast *f, double available);
const char *pg_forecast_item  (int item);              /* "bonds", ... */
/* Bytes that this process may still take: least of free memory, control groups (v2, v1) and RLIMIT_AS. root:
 * "" (tests: a folder that holds proc and sys). */
double      pg_available_memory (const char *root);

/* ---- several processes --------------------------------------------------------------------------------- */
/* 1: ranks are to divide the points of the body (perigal/ranks.h); 0: each holds all, and they share
 * matrices. By solver.kind and solver.division; auto: of forces between points as many unknowns, by a
 * forecast, as one process solves for without a factor, and nothing in the scene needs the whole body.
 * Faults that the forecast meets are added to the scene. Collective, before the problem is built. */
int       pg_subdomain_wanted (const pg_scene *scene, const pg_method *const *methods);
PG_API_END
#endif
