/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of each of several ranks (perigal/ranks.h), from the forecast of one process. */
#include "forecast.h"
#include <math.h>

/* Bytes per rank that MPI takes once started, PETSc once loaded, and factors by MUMPS in addition; measured
 * on notched plates of 2 000 to 160 000 points and blocks of 6 000 to 75 000 on 1 to 4 ranks
 * (test/ranks/test_check.sh compares). */
static const double started = 12e6, loaded = 29e6, factoring = 10e6;
/* Ratios of bytes. of_levels: a preconditioner of PETSc to its finest matrix, by dimension (in 3D coarse
 * levels are coupled more); of_gathered: a coarse matrix that is gathered, with the levels below, to its
 * rows; of_factor: MUMPS, with transposes and work space, to its factor. */
static const double of_levels[4] = { 0, 1.45, 1.45, 2.8 }, of_gathered = 2.5, of_factor = 1.23;

static void add (pg_forecast *f, int item, double bytes) { f->bytes[item] += bytes, f->peak += bytes; }

/* Bytes of the preconditioner's levels below the finest grid (linalg/preconditioner/multilevel_ranks.c), and
 * of PETSc if it holds them, for `total` points on so many ranks. With shape functions the first coarse grid
 * has 2.5 times the step of the lattice and some functions beside the body (a block of 331 056 points has 22
 * 016), each coupled to those next to it; with bonds it has 4/3 of the horizon, estimated from `couplings`
 * per point, and functions are coupled to two on each side. */
static double coarse_bytes (const pg_forecast *f, double couplings, double total, double ranks)
{
    double d = f->dim, m = f->dim + f->rotations, shapes = f->method->shape_functions;
    double functions = total / (shapes ? pow (2.5, d) : fmax (1, 0.57 * couplings)),
           entries = m * m * functions * pow (shapes ? 3 : 5, d);
    int whole = m * functions <= 1000 || functions * ranks <= 0.3 * total;
    return whole ? of_gathered * 8 * entries : loaded + of_levels[f->dim] * 12 * entries / ranks;
}

/* Adds the bytes of solvers without a factor: points that are not on a lattice have rows of K in PETSc. In
 * dynamics the forecast of one process has no preconditioner for bonds; ranks do. */
static void add_levels (pg_forecast *g, const pg_forecast *f, double owned, double total)
{
    double d = f->dim, m = f->dim + f->rotations,
           couplings = f->count.points > 0 ? 2 * f->count.pairs / f->count.points - 1 : 0;
    int off = f->is.listed || f->is.irregular;
    /* nodes that share an element with a node */
    if (off && f->method->shape_functions) couplings = pow (3, d);
    if (off) add (g, PG_BYTES_MATRIX, loaded + of_levels[f->dim] * 12 * m * m * couplings * owned);
    else add (g, PG_BYTES_MATRIX, coarse_bytes (f, couplings, total, fmax (1, total / owned)));
    if (!off && f->is.dynamic && !f->method->shape_functions)
        add (g, PG_BYTES_VECTORS, g->count.points * (32 * m + 16 * pow (2, d) + 16));
}

pg_forecast pg_forecast_of_part (const pg_forecast *f, const pg_part_size *part, double total, int collects)
{
    pg_forecast g = *f;
    double d = f->dim, more = (part->owned + part->ghosts) / f->count.points;
    g.count.points *= more, g.count.cells *= more, g.count.evaluation *= more, g.count.facets *= more,
        g.count.pairs *= more;
    g.count.summed *= more, g.count.patched *= more, g.count.slaves *= more, g.count.columns *= more;
    for (int s = 0; s < PG_BOND_SETS; s++) g.count.bonds[s] *= more;
    /* no rank holds the whole body that they would show */
    g.is.pictures = 0;
    g.is.scattered = 0;                                   /* ranks: elements on all nodes, no coarse grid */
    g.is.automatic = 0, g.linear = NULL;
    pg_forecast_sum (&g);
    add (&g, PG_BYTES_PROGRAM, started);
    add (&g, PG_BYTES_POINTS, f->count.mesh);
    if (!f->is.explicit_) add_levels (&g, f, part->owned, total);
    /* one rank gathers the fields of all at the end: positions, volumes, numbers, and the values shown of
     * each field, of which half have a component along each axis */
    if (collects) add (&g, PG_BYTES_RESULTS, total * (16 * d + 36 + 4 * (d + 1) * (f->count.fields + 1)));
    /* at the start every rank holds all points of a points file for a moment */
    add (&g, PG_BYTES_POINTS, fmax (0, g.bytes[PG_BYTES_PROGRAM] + f->count.reading - g.peak));
    return g;
}

pg_forecast pg_forecast_in_step (const pg_forecast *f, int ranks)
{
    pg_forecast g = *f;
    add (&g, PG_BYTES_PROGRAM, started);
    if (!f->linear) return g;
    add (&g, PG_BYTES_PROGRAM, loaded + factoring);
    add (&g, PG_BYTES_MATRIX, g.bytes[PG_BYTES_MATRIX]);
    add (&g, PG_BYTES_FACTOR, (of_factor / ranks - 1) * g.bytes[PG_BYTES_FACTOR]);
    return g;
}
