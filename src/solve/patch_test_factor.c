/* SPDX-License-Identifier: GPL-3.0-or-later
 * The equilibria of the patch test by a factor of K. In the plane K has a cheap factor, and the run that
 * follows will make such a factor as well, so that memory suffices; conjugate gradients need some
 * 60 + 1.6 n^(1/2) products with K for all states of stress and the measure of softness together (107, 123
 * and 134 with 576, 1248 and 2176 points around a hole). On a large lattice they are fewer and cheaper: an
 * edge crack of 40 000 points takes 0.2 s by iterations and 0.85 s by a factor; on a small one most points
 * are like few others (297 points: 44 million instructions by iterations, 22 by a factor).
 *
 * The bare body is free to move. Two springs hold one point and one spring keeps a point far from it from
 * turning about it, each as stiff as K is there. Forces in balance leave these springs without force, so that
 * K x = b holds as it stands, and x is the solution that is zero at the springs. */
#include "patch_test_factor.h"
#include <math.h>
#include <string.h>

struct patch_factor { const pg_linear_type *linear; void *self; pg_sparse K; };

/* Seconds by stored rates, never measured: a product with K, of each bond; assembling K and ordering its
 * unknowns, of each bond; operations of a factorization. */
static const double product_cost = 2.5e-9, assembly_cost = 1.5e-7, operation_cost = 1 / 20e9;
/* Pivots of parts that nothing holds are of the size of rounding. */
static const double least_pivot = 1e-13;
/* Points of a lattice that is small. */
enum { MOST_ON_LATTICE = 2000 };

/* What iterations would cost, s. */
static double cost_of_iterations (const pg_problem *p, size_t products)
{
    double states = pg_voigt_size (p->dim) + 1, expected = 60 + 1.6 * sqrt ((double) p->cloud.n);
    return fmin (expected, states * (double) products) * product_cost * (double) p->first_bond[PG_BOND_SETS];
}

static int has_matrix (const pg_problem *p, const pg_force_type *force, void *self)
{
    if (p->dim != 2 || pg_problem_unknowns (p) != 2 || !p->equilibria || p->plain) return 0;
    if (p->cloud.regular && p->cloud.n > MOST_ON_LATTICE) return 0;    /* products cost little */
    if (!force->matrix || !force->assemble || (force->basis && force->basis (self))) return 0;
    return !force->matrix_free || !force->matrix_free (self);
}

/* The point farthest from point `from`. */
static size_t farthest (const pg_cloud *c, size_t from)
{
    double most = -1;
    size_t best = from;
    for (size_t i = 0; i < c->n; i++) {
        double dx = c->x[2 * i] - c->x[2 * from], dy = c->x[2 * i + 1] - c->x[2 * from + 1];
        if (dx * dx + dy * dy > most) most = dx * dx + dy * dy, best = i;
    }
    return best;
}

/* Springs on both unknowns of a point, and across the line to the point farthest from it at that. The last
 * entry of a column is its diagonal. */
static void hold (pg_sparse *K, const pg_cloud *c)
{
    size_t one = farthest (c, 0), other = farthest (c, one);
    double along_x = fabs (c->x[2 * other] - c->x[2 * one]),
           along_y = fabs (c->x[2 * other + 1] - c->x[2 * one + 1]);
    size_t held[3] = { 2 * one, 2 * one + 1, 2 * other + (along_x >= along_y) };
    for (int k = 0; k < 3; k++) K->value[K->start[held[k] + 1] - 1] *= 2;
}

void patch_factor_free (patch_factor **factor)
{
    patch_factor *f = *factor;
    if (!f) return;
    if (f->self) f->linear->free (&f->self);
    pg_free (f->K.value);
    pg_free (f);
    *factor = NULL;
}

pg_status patch_factor_create (patch_factor **out, const pg_problem *bare, const pg_force_type *force,
                               void *self, size_t products)
{
    pg_status status = PG_OK;
    patch_factor *f = NULL;
    pg_linear_info info;
    double iterations = cost_of_iterations (bare, products),
           assembly = assembly_cost * (double) bare->first_bond[PG_BOND_SETS];
    pg_linear_options o = { 2, bare->dim, bare->threads, 1e-12, 0 };
    *out = NULL;
    if (!has_matrix (bare, force, self) || assembly > iterations) return PG_OK;
    PG_ALLOC (f, 1);
    f->linear = pg_linear_first (1, 1);
    PG_TRY (force->assemble (self));
    f->K = *force->matrix (self), f->K.value = NULL;
    size_t n = 2 * bare->cloud.n, entries = (size_t) f->K.start[n];
    PG_ALLOC (f->K.value, entries);
    memcpy (f->K.value, force->matrix (self)->value, entries * sizeof *f->K.value);
    hold (&f->K, &bare->cloud);
    PG_TRY (pg_linear_analyse (&f->linear, &f->self, &f->K, &o));
    f->linear->info (f->self, &info);
    if (assembly + operation_cost * info.flops > iterations) goto done;
    status = f->linear->factor (f->self, &f->K);
    f->linear->info (f->self, &info);
    if (status == PG_OK && info.pivots > least_pivot) *out = f, f = NULL;
    if (status == PG_E_NOT_SPD) status = PG_OK;        /* parts move freely: iterations can do with that */
done:
    patch_factor_free (&f);
    return status;
}

pg_status patch_factor_solve (patch_factor *f, const double *b, double *x)
{
    return f->linear->solve (f->self, 1, b, x);
}
