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

typedef struct { double *r, *z, *p, *q, *d; } vectors;

static pg_status precondition (const pg_preconditioner *P, size_t n, const vectors *v)
{
    if (P) return P->solve (P->context, v->r, v->z);
    for (size_t i = 0; i < n; i++) v->z[i] = v->d[i] * v->r[i];
    return PG_OK;
}

static void first_residual (const pg_operator *A, const double *b, const double *x, const vectors *v)
{
    size_t n = A->n, zero = 1;
    for (size_t i = 0; i < n && zero; i++) zero = x[i] == 0;
    if (zero) memcpy (v->r, b, n * sizeof *b);
    else A->apply (A->context, x, v->q);
    for (size_t i = 0; i < n && !zero; i++) v->r[i] = b[i] - v->q[i];
}

pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b, double *x, double tolerance, size_t limit,
                                       size_t *iterations)
{
    pg_status status = PG_OK;
    vectors v = { 0 };
    size_t n = A->n, k = 0;
    PG_ALLOC (v.r, n);
    PG_ALLOC (v.z, n);
    PG_ALLOC (v.p, n);
    PG_ALLOC (v.q, n);
    PG_ALLOC (v.d, P ? 0 : n);
    if (!P) A->diagonal (A->context, v.d);
    for (size_t i = 0; i < n && !P; i++) v.d[i] = v.d[i] > 0 ? 1 / v.d[i] : 1;
    first_residual (A, b, x, &v);
    double goal = tolerance * sqrt (dot (n, b, b)), rz = 0, rr = sqrt (dot (n, v.r, v.r));
    for (k = 0; rr > goal && k < limit; k++) {
        PG_TRY (precondition (P, n, &v));
        double next = dot (n, v.r, v.z), turn = k ? next / rz : 0;
        for (size_t i = 0; i < n; i++) v.p[i] = v.z[i] + turn * v.p[i];
        rz = next;
        A->apply (A->context, v.p, v.q);
        double pq = dot (n, v.p, v.q);
        if (!(pq > 0)) PG_FAIL (PG_E_NOT_SPD, "conjugate gradients met a direction of energy %g after %zu iterations", pq, k);
        double alpha = rz / pq;
        for (size_t i = 0; i < n; i++) x[i] += alpha * v.p[i], v.r[i] -= alpha * v.q[i];
        rr = sqrt (dot (n, v.r, v.r));
    }
    if (!(rr <= goal)) PG_FAIL (PG_E_EQUILIBRIUM, "conjugate gradients stopped after %zu iterations at residual %g of %g", k, rr, goal);
done:
    if (iterations) *iterations = k;
    pg_free (v.r), pg_free (v.z), pg_free (v.p), pg_free (v.q), pg_free (v.d);
    return status;
}

pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance, size_t limit, size_t *iterations)
{
    return pg_conjugate_gradients_with (A, NULL, b, x, tolerance, limit, iterations);
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
