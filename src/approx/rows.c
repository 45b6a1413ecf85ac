/* SPDX-License-Identifier: GPL-3.0-or-later
 * Evaluation points with their families, and the memory for their shape functions. Families
 * are searched once; breaking bonds changes the live list, not the families. */
#include "perigal/approx.h"
#include <string.h>

/* All places count as dead until they are evaluated. Families include the nodes at exactly the
 * horizon if the kernel is not zero there (`closed`). */
pg_status pg_rows_create (pg_rows *out, const pg_approx *a, const pg_cloud *cloud, size_t n, const double *x,
                          const double *weight, const int *own, const int *cell)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim;
    *out = (pg_rows) { .dim = cloud->dim, .n = n };
    PG_ALLOC (out->x, n * dim);
    PG_ALLOC (out->weight, n);
    PG_ALLOC (out->own, n);
    PG_ALLOC (out->cell, n);
    PG_ALLOC (out->grade, n);
    if (n) memcpy (out->x, x, n * dim * sizeof *x);
    for (size_t i = 0; i < n; i++) {
        out->weight[i] = weight ? weight[i] : 0;
        out->own[i] = own ? own[i] : -1;
        out->cell[i] = cell ? cell[i] : -1;
        out->grade[i] = PG_GRADE_DEAD;                 /* until evaluated */
    }
    PG_TRY (pg_family_build (&out->family, cloud, n, out->x, a->horizon, a->shape, a->kernel->closed));
    size_t bonds = out->family.start[n];
    PG_ALLOC (out->N, bonds);
    PG_ALLOC (out->dN, bonds * dim);
    PG_ALLOC (out->w, bonds);
done:
    if (status != PG_OK) pg_rows_clear (out);
    return status;
}

void pg_rows_clear (pg_rows *rows)
{
    pg_family_clear (&rows->family);
    pg_free (rows->x);
    pg_free (rows->weight);
    pg_free (rows->own);
    pg_free (rows->cell);
    pg_free (rows->N);
    pg_free (rows->dN);
    pg_free (rows->w);
    pg_free (rows->grade);
    *rows = (pg_rows) { 0 };
}

size_t pg_rows_count (const pg_rows *rows, int grade)
{
    size_t count = 0;
    for (size_t i = 0; i < rows->n; i++) count += rows->grade[i] == grade;
    return count;
}
