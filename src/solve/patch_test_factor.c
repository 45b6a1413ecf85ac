/* SPDX-License-Identifier: GPL-3.0-or-later
 * The equilibria of the patch test by a factor of K. In 2D, and for small bodies in 3D, K has a
 * cheap factor, and the run that follows will make such a factor as well, so that memory suffices (it takes K
 * as it is, where the body has one material and nothing breaks); conjugate gradients need some
 * 60 + 1.6 n^(1/2) products with K for all states of stress and the measure of softness together (107, 123
 * and 134 with 576, 1248 and 2176 points around a hole). On a large lattice they are fewer and cheaper: an
 * edge crack of 40 000 points takes 0.2 s by iterations and 0.85 s by a factor; on a small one most points
 * are like few others (297 points: 44 million instructions by iterations, 22 by a factor).
 *
 * The bare body is free to move. As many springs as it has rigid motions hold it. Forces in balance leave
 * these springs without force, so that K x = b holds as it stands, and x is the solution that is zero at the
 * springs. */
#include "patch_test_factor.h"
#include <math.h>
#include <string.h>

struct patch_factor { const pg_linear_type *linear; void *self; pg_sparse K; };

/* Estimated seconds, never measured: of a product with K, for each bond; of assembling K and ordering its
 * unknowns, for each bond; of an operation of a factorization. */
static const double product_cost = 2.5e-9, assembly_cost = 1.5e-7, operation_cost = 1 / 20e9;
/* Below this share of the largest one pivots belong to parts that nothing holds. */
static const double least_pivot = 1e-13;
/* Most points of a small lattice. */
enum { MOST_ON_LATTICE = 2000 };

/* Seconds that iterations would take. */
static double cost_of_iterations (const pg_problem *p, size_t products)
{
    double states = pg_voigt_size (p->dim) + 1, expected = 60 + 1.6 * sqrt ((double) p->cloud.n);
    return fmin (expected, states * (double) products) * product_cost * (double) p->bonds.first[PG_BOND_SETS];
}

static int has_matrix (const pg_problem *p, const pg_force_type *force, void *self)
{
    if (p->dim < 2 || pg_problem_unknowns (p) != p->dim || !p->equilibria || p->plain) return 0;
    if (p->cloud.regular && p->cloud.n > MOST_ON_LATTICE) return 0;    /* products cost little */
    pg_solve_counts c = pg_solve_count (p);            /* of the run: in 3D it may solve without a factor */
    if (p->dim > 2 && (!p->method->shape_functions || pg_solve_by_elements (&c, 1, 0, 0))) return 0;
    return !(force->basis && force->basis (self)) && pg_force_matrix (force, self);
}

/* out = displacements of unknown `at` in the rigid motions of the body: translations, then rotations about
 * the middle over the size of the body (at most 6; returns how many). */
static size_t rigid_motions (const pg_cloud *c, const double *middle, double size, size_t at, double *out)
{
    size_t dim = (size_t) c->dim, k = at % dim, n = dim;
    const double *x = c->x + (at - k);
    memset (out, 0, 6 * sizeof *out);
    out[k] = 1;
    for (size_t a = 0; a < dim; a++)
        for (size_t b = a + 1; b < dim; b++, n++) {
            if (k == a) out[n] = -(x[b] - middle[b]) / size;
            if (k == b) out[n] = (x[a] - middle[a]) / size;
        }
    return n;
}

/* Adds springs on as many unknowns as there are rigid motions, each as stiff as K is there: the next one
 * where the motions left free by those before move the body most (QR decomposition with pivots). The last
 * entry of a column of K is its diagonal. */
static pg_status hold (pg_sparse *K, const pg_cloud *c)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) c->dim, n = dim * c->n, m = 0;
    double *R = NULL, middle[3] = { 0 }, size = 0;
    PG_ALLOC (R, 6 * n);
    for (size_t k = 0; k < dim; k++) {
        middle[k] = (c->low[k] + c->high[k]) / 2;
        size = fmax (size, c->high[k] - c->low[k]);
    }
    for (size_t i = 0; i < n; i++) m = rigid_motions (c, middle, size > 0 ? size : 1, i, R + 6 * i);
    for (size_t s = 0; s < m; s++) {
        double most = 0, row[6];
        size_t best = 0;
        for (size_t i = 0; i < n; i++) {
            double square = 0;
            for (size_t k = 0; k < m; k++) square += R[6 * i + k] * R[6 * i + k];
            if (square > most) most = square, best = i;
        }
        if (!(most > 1e-12)) break;                    /* all motions held, or points in a line */
        K->value[K->start[best + 1] - 1] *= 2;
        memcpy (row, R + 6 * best, sizeof row);
        for (size_t i = 0; i < n; i++) {
            double along = 0;
            for (size_t k = 0; k < m; k++) along += R[6 * i + k] * row[k];
            for (size_t k = 0; k < m; k++) R[6 * i + k] -= along / most * row[k];
        }
    }
done:
    pg_free (R);
    return status;
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
                               void *self, size_t products, int reused)
{
    pg_status status = PG_OK;
    patch_factor *f = NULL;
    pg_linear_info info;
    double iterations = cost_of_iterations (bare, products),
           assembly = reused ? 0 : assembly_cost * (double) bare->bonds.first[PG_BOND_SETS];
    size_t n = (size_t) bare->dim * bare->cloud.n, entries;
    pg_linear_options o = { bare->dim, bare->dim, bare->threads, 1e-12, 0 };
    const pg_sparse *K;
    *out = NULL;
    if (!has_matrix (bare, force, self) || assembly > iterations) return PG_OK;
    PG_ALLOC (f, 1);
    f->linear = pg_linear_first (1, 1);
    PG_TRY (pg_force_assemble (force, self, &K));
    f->K = *K, f->K.value = NULL;
    entries = (size_t) f->K.start[n];
    PG_ALLOC (f->K.value, entries);
    memcpy (f->K.value, K->value, entries * sizeof *f->K.value);
    PG_TRY (hold (&f->K, &bare->cloud));
    PG_TRY (f->linear->analyse (&f->self, &f->K, &o));
    f->linear->info (f->self, &info);
    if (assembly + operation_cost * info.flops > iterations) goto done;
    status = f->linear->factor (f->self, &f->K);
    f->linear->info (f->self, &info);
    if (status == PG_OK && info.pivots > least_pivot) *out = f, f = NULL;
    if (status == PG_E_NOT_SPD) status = PG_OK;        /* parts move freely: iterations can handle that */
done:
    patch_factor_free (&f);
    return status;
}

pg_status patch_factor_solve (patch_factor *f, const double *b, double *x)
{
    return f->linear->solve (f->self, 1, b, x);
}
