/* SPDX-License-Identifier: GPL-3.0-or-later
 * Conjugate gradients with diagonal preconditioning, on any operator; also as a solver of matrices. */
#include "perigal/linalg.h"
#include <math.h>
#include <string.h>

static double dot (size_t n, const double *a, const double *b)
{
    double s = 0;
    for (size_t i = 0; i < n; i++) s += a[i] * b[i];
    return s;
}

pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance, size_t limit, size_t *iterations)
{
    pg_status status = PG_OK;
    double *r = NULL, *z = NULL, *p = NULL, *q = NULL, *d = NULL;
    size_t n = A->n, k = 0;
    PG_ALLOC (r, n);
    PG_ALLOC (z, n);
    PG_ALLOC (p, n);
    PG_ALLOC (q, n);
    PG_ALLOC (d, n);
    A->diagonal (A->context, d);
    A->apply (A->context, x, q);
    for (size_t i = 0; i < n; i++) {
        r[i] = b[i] - q[i];
        d[i] = d[i] > 0 ? 1 / d[i] : 1;
        p[i] = z[i] = d[i] * r[i];
    }
    double goal = tolerance * sqrt (dot (n, b, b)), rz = dot (n, r, z), rr = sqrt (dot (n, r, r));
    for (k = 0; rr > goal && k < limit; k++) {
        A->apply (A->context, p, q);
        double pq = dot (n, p, q);
        if (!(pq > 0)) PG_FAIL (PG_E_NOT_SPD, "conjugate gradients met a direction of energy %g after %zu iterations", pq, k);
        double alpha = rz / pq;
        for (size_t i = 0; i < n; i++) x[i] += alpha * p[i], r[i] -= alpha * q[i], z[i] = d[i] * r[i];
        double next = dot (n, r, z);
        for (size_t i = 0; i < n; i++) p[i] = z[i] + next / rz * p[i];
        rz = next, rr = sqrt (dot (n, r, r));
    }
    if (!(rr <= goal)) PG_FAIL (PG_E_EQUILIBRIUM, "conjugate gradients stopped after %zu iterations at residual %g of %g", k, rr, goal);
done:
    if (iterations) *iterations = k;
    pg_free (r), pg_free (z), pg_free (p), pg_free (q), pg_free (d);
    return status;
}

typedef struct { const pg_sparse *A; double tolerance; size_t iterations; } pcg;

static void pcg_free (void **self) { pg_free (*self), *self = NULL; }

static pg_status pcg_analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    pg_status status = PG_OK;
    pcg *s = NULL;
    PG_ALLOC (s, 1);
    s->A = A, s->tolerance = options->tolerance > 0 ? options->tolerance : 1e-10;
    *self = s;
done:
    return status;
}

static pg_status pcg_factor (void *self, const pg_sparse *A)
{
    ((pcg *) self)->A = A;
    return PG_OK;
}

static pg_status pcg_solve (void *self, size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    pcg *s = self;
    pg_sparse A = *s->A;
    pg_operator op = pg_sparse_operator (&A);
    for (size_t k = 0; k < nrhs; k++) {
        size_t used;
        memset (x + k * A.ncol, 0, A.ncol * sizeof *x);
        PG_TRY (pg_conjugate_gradients (&op, b + k * A.ncol, x + k * A.ncol, s->tolerance, 20 * A.ncol + 1000, &used));
        s->iterations += used;
    }
done:
    return status;
}

static void pcg_info (const void *self, pg_linear_info *info)
{
    *info = (pg_linear_info) { "none", 0, 0, ((const pcg *) self)->iterations };
}

const pg_linear_type pg_linear_pcg = {
    "pcg", "conjugate gradients with diagonal preconditioning", 1,
    pcg_analyse, pcg_factor, pcg_solve, pcg_info, pcg_free
};
