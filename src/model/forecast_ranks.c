/* SPDX-License-Identifier: GPL-3.0-or-later
 * Memory of each of several ranks (perigal/ranks.h), from the forecast of one process. */
#include "forecast.h"
#include <math.h>

/* Measured on notched plates of 2 000 to 160 000 points and blocks of 6 000 to 75 000 on 1 to 4 ranks
 * (test/ranks/test_check.sh compares): MPI and PETSc loaded and started; what factors by MUMPS adds. */
static const double started = 41e6, factoring = 10e6;
/* Step of the first coarse grid over that of the lattice, with what its functions have beside the body: a
 * block of 331 056 points has 22 016. */
static const double coarser = 2.5;
/* Bytes of the rows of a preconditioner of PETSc over those of its finest matrix, in the plane and in space,
 * where coarse levels couple more; of MUMPS over its factor: with transposes and work space. */
static const double of_levels[4] = { 0, 1.45, 1.45, 2.8 }, of_factor = 1.23;

static void add (pg_forecast *f, int item, double bytes) { f->bytes[item] += bytes, f->peak += bytes; }

pg_forecast pg_forecast_of_part (const pg_forecast *f, const pg_part_size *part, double total, int collects)
{
    pg_forecast g = *f;
    double d = f->dim, m = f->dim + f->rotations, more = (part->owned + part->ghosts) / f->points;
    /* couplings of a point in the rows that PETSc gets: of shape functions those of elements, three along
     * each axis, on a lattice of the first coarse grid alone (multilevel_ranks.c) */
    double coupled = f->method->shape_functions ? pow (f->irregular ? 3 : 3 / coarser, d)
                     : f->points > 0            ? 2 * f->pairs / f->points - 1 : 0;
    g.points *= more, g.cells *= more, g.evaluation *= more, g.facets *= more, g.pairs *= more;
    g.summed *= more, g.patched *= more, g.slaves *= more, g.columns *= more;
    for (int s = 0; s < PG_BOND_SETS; s++) g.bonds[s] *= more;
    g.pictures = 0;                                    /* none are drawn of a body that nobody holds */
    g.scattered = 0;                                   /* elements on all nodes */
    g.automatic = 0, g.linear = NULL;
    pg_forecast_sum (&g);
    add (&g, PG_BYTES_PROGRAM, started);
    add (&g, PG_BYTES_POINTS, f->mesh);
    if (!f->explicit_)
        add (&g, PG_BYTES_MATRIX, of_levels[f->dim] * 12 * m * m * coupled * part->owned);
    /* one rank puts the fields of all together at the end: places, volumes, numbers, and what is shown of
     * each field, of which half have a component along each axis */
    if (collects) add (&g, PG_BYTES_RESULTS, total * (16 * d + 36 + 4 * (d + 1) * (f->fields + 1)));
    return g;
}

pg_forecast pg_forecast_in_step (const pg_forecast *f, int ranks)
{
    pg_forecast g = *f;
    add (&g, PG_BYTES_PROGRAM, started);
    if (!f->linear) return g;
    add (&g, PG_BYTES_PROGRAM, factoring);
    add (&g, PG_BYTES_MATRIX, g.bytes[PG_BYTES_MATRIX]);
    add (&g, PG_BYTES_FACTOR, (of_factor / ranks - 1) * g.bytes[PG_BYTES_FACTOR]);
    return g;
}
