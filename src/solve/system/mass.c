/* SPDX-License-Identifier: GPL-3.0-or-later
 * The mass, lumped (a number for each unknown) or consistent (a number for each pair of nodes, the same for
 * every component). */
#include "solve/run/solve.h"
#include <string.h>

/* Asks the force for its consistent mass once; lumped masses are there from the start. */
pg_status system_mass (pg_system *s, int consistent)
{
    pg_status status = PG_OK;
    if (!consistent || s->M) return PG_OK;
    if (s->force->mass) PG_TRY (s->force->mass (s->self, NULL, &s->M));
    if (!s->M)
        PG_FAIL (PG_E_USAGE, "the force %s has no consistent mass: use solver.mass: lumped",
                 s->force->method.name);
done:
    return status;
}

/* y += factor M x. Lumped: a product for each unknown. Consistent: the upper triangle of a symmetric matrix
 * of nodes, used for both triangles and for every component. */
void system_add_mass (const pg_system *s, double factor, const double *x, double *y)
{
    size_t m = (size_t) s->components;
    if (factor == 0) return;
    for (size_t i = 0; !s->M && i < s->ndof; i++) y[i] += factor * s->mass[i] * x[i];
    for (size_t J = 0; s->M && J < s->M->ncol; J++)
        for (long q = s->M->start[J]; q < s->M->start[J + 1]; q++) {
            size_t I = (size_t) s->M->row[q];
            double v = factor * s->M->value[q];
            for (size_t c = 0; c < m; c++) y[I * m + c] += v * x[J * m + c];
            for (size_t c = 0; c < m && I != J; c++) y[J * m + c] += v * x[I * m + c];
        }
}

/* d += factor diag M; the last entry of a column of an upper triangle is its diagonal. */
void system_add_mass_diagonal (const pg_system *s, double factor, double *d)
{
    size_t m = (size_t) s->components;
    for (size_t i = 0; !s->M && i < s->ndof; i++) d[i] += factor * s->mass[i];
    for (size_t J = 0; s->M && J < s->M->ncol; J++)
        for (size_t c = 0; c < m; c++) d[J * m + c] += factor * s->M->value[s->M->start[J + 1] - 1];
}

/* value (of a matrix with the pattern of K) += factor M; every pair of nodes of M is one of K. */
void system_add_mass_matrix (const pg_system *s, double factor, const pg_sparse *K, double *value)
{
    size_t m = (size_t) s->components;
    for (size_t j = 0; j < s->ndof; j++) {
        if (!s->M) {
            value[K->start[j + 1] - 1] += factor * s->mass[j];
            continue;
        }
        long at = s->M->start[j / m], end = s->M->start[j / m + 1];
        for (long q = K->start[j]; q < K->start[j + 1] && at < end; q++) {
            if ((size_t) K->row[q] % m != j % m) continue;
            long node = K->row[q] / (long) m;
            while (at < end && s->M->row[at] < node) at++;
            if (at < end && s->M->row[at] == node) value[q] += factor * s->M->value[at];
        }
    }
}

void system_add_held (const pg_system *s, double *residual)
{
    for (size_t i = 0; s->balance.held && i < s->ndof; i++) residual[i] += s->balance.held[i];
}
