/* SPDX-License-Identifier: GPL-3.0-or-later
 * lattice.h: a plate or block of points on a lattice and its bonds, for benches: created with room for
 * displacements and forces, then given bonds. */
#ifndef PERIGAL_BENCH_LATTICE_H
#define PERIGAL_BENCH_LATTICE_H
#include "perigal/sums.h"
#include <math.h>
#include <string.h>
#include <time.h>

typedef struct {
    int       m;                                       /* unknowns of a point */
    pg_cloud  cloud;                                   /* the first point at the origin */
    pg_sums  *sums;
    pg_family family;
    double   *u, *f, *plain;  /* displacements, forces, forces to compare with (n x m) */
    unsigned char *alive;                              /* (bonds) */
} lattice_body;

/* Of one thread its own time, which other programs on the machine do not lengthen; of several that of the
 * clock */
static inline double lattice_seconds (int threads)
{
    struct timespec t;
    clock_gettime (threads == 1 ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &t);
    return (double) t.tv_sec + 1e-9 * (double) t.tv_nsec;
}

static inline pg_status lattice_create (lattice_body *b, int dim_, const int *count, double h, int m)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) dim_, nx = (size_t) count[0], ny = (size_t) count[1],
           n = nx * ny * (size_t) (dim == 3 ? count[2] : 1);
    pg_cloud *c = &b->cloud;
    *b = (lattice_body) { .m = m, .cloud = { .dim = dim_, .n = n, .h = h, .thickness = 1 } };
    PG_ALLOC (c->x, n * dim);
    PG_ALLOC (c->volume, n);
    PG_ALLOC (b->u, n * (size_t) m);
    PG_ALLOC (b->f, n * (size_t) m);
    PG_ALLOC (b->plain, n * (size_t) m);
    for (size_t i = 0; i < n; i++) {
        size_t at[3] = { i % nx, i / nx % ny, i / nx / ny };
        c->volume[i] = pow (h, dim_);
        for (size_t d = 0; d < dim; d++) c->x[i*dim + d] = h * (double) at[d], c->high[d] = h * count[d];
    }
done:
    return status;
}

/* Bonds by a rule, all alive; of points that are no lattice any more: `scattered`. */
static inline pg_status lattice_bond (lattice_body *b, const pg_sum_rule *rule, int scattered)
{
    pg_status status = PG_OK;
    double h = b->cloud.h;
    pg_lattice lattice = { .dim = b->cloud.dim, .step = { h, h, h } };
    PG_TRY (pg_sums_create (&b->sums, rule, &b->cloud, scattered ? NULL : &lattice));
    PG_TRY (pg_sums_family (&b->family, b->sums, NULL));
    PG_ALLOC (b->alive, b->family.start[b->cloud.n]);
    memset (b->alive, 1, b->family.start[b->cloud.n]);
done:
    return status;
}

static inline void lattice_clear (lattice_body *b)
{
    void *all[] = { b->cloud.x, b->cloud.volume, b->u, b->f, b->plain, b->alive };
    for (size_t k = 0; k < sizeof all / sizeof *all; k++) pg_free (all[k]);
    pg_family_clear (&b->family);
    if (b->sums) pg_sums_free (&b->sums);
    memset (b, 0, sizeof *b);
}

/* Largest difference over the largest value of `right` */
static inline double lattice_apart (const lattice_body *b, const double *a, const double *right)
{
    double most = 0, off = 0;
    for (size_t k = 0; k < b->cloud.n * (size_t) b->m; k++)
        most = fmax (most, fabs (right[k])), off = fmax (off, fabs (a[k] - right[k]));
    return off / most;
}
#endif
