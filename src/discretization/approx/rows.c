/* SPDX-License-Identifier: GPL-3.0-or-later
 * Evaluation points with their families, and the memory for their shape functions. Families are searched
 * once; breaking bonds changes the flags of intact bonds, not the families. */
#include "perigal/approx.h"
#include <math.h>
#include <string.h>

pg_status pg_rows_search (pg_family_search **out, const pg_approx *a, const pg_cloud *cloud)
{
    return pg_family_search_create (out, cloud, a->horizon, a->shape, a->kernel->closed);
}

/* Families include the nodes at exactly the horizon if the kernel is not zero there (`closed`). */
pg_status pg_rows_place (pg_rows *out, const pg_family_search *search, const pg_cloud *cloud, size_t n,
                         const double *x, const double *weight, const int *own, const int *cell,
                         const double *eye, int threads)
{
    pg_status status = PG_OK;
    int dim = cloud->dim;
    *out = (pg_rows) { .dim = dim, .n = n };
    PG_ALLOC (out->x, n * (size_t) dim);
    PG_ALLOC (out->weight, n);
    PG_ALLOC (out->own, n);
    PG_ALLOC (out->cell, n);
    if (n) memcpy (out->x, x, n * (size_t) dim * sizeof *x);
    for (size_t i = 0; i < n; i++) {
        out->weight[i] = weight ? weight[i] : 0;
        out->own[i] = own ? own[i] : -1;
        out->cell[i] = cell ? cell[i] : -1;
    }
    if (eye) {
        PG_ALLOC (out->eye, n * (size_t) dim);
        memcpy (out->eye, eye, n * (size_t) dim * sizeof *eye);
    }
    PG_TRY (pg_family_find (&out->family, search, n, out->x, threads));
    PG_TRY (pg_between_sift (cloud->between, &out->family, out->x, eye, own, threads, &out->parted));
done:
    if (status != PG_OK) pg_rows_clear (out);
    return status;
}

pg_status pg_rows_eyes (double **eye, const pg_cloud *cloud, size_t n, const double *x, const double *normal)
{
    static const double inward = 1e-5;                 /* distance into the body, spacings */
    pg_status status = PG_OK;
    size_t dim = (size_t) cloud->dim;
    *eye = NULL;
    if (!cloud->between) return PG_OK;
    double step = inward * pg_cloud_finest (cloud);
    PG_ALLOC (*eye, n * dim);
    for (size_t q = 0; q < n; q++) {
        double size = 0;
        for (size_t k = 0; k < dim; k++) size += normal[q * dim + k] * normal[q * dim + k];
        for (size_t k = 0; k < dim; k++)
            (*eye)[q * dim + k] = x[q * dim + k] - (size > 0 ? step / sqrt (size) * normal[q * dim + k] : 0);
    }
done:
    return status;
}

/* Allocates the values. Every point has the grade PG_GRADE_DEAD until it is evaluated. */
pg_status pg_rows_values (pg_rows *rows)
{
    pg_status status = PG_OK;
    size_t bonds = rows->family.start[rows->n];
    PG_ALLOC (rows->N, bonds);
    PG_ALLOC (rows->dN, bonds * (size_t) rows->dim);
    PG_ALLOC (rows->w, bonds);
    PG_ALLOC (rows->grade, rows->n);
    if (rows->n) memset (rows->grade, PG_GRADE_DEAD, rows->n);  /* until evaluated */
done:
    return status;
}

pg_status pg_rows_create (pg_rows *out, const pg_approx *a, const pg_cloud *cloud, size_t n, const double *x,
                          const double *weight, const int *own, const int *cell)
{
    pg_status status = PG_OK;
    pg_family_search *search = NULL;
    *out = (pg_rows) { 0 };
    PG_TRY (pg_rows_search (&search, a, cloud));
    PG_TRY (pg_rows_place (out, search, cloud, n, x, weight, own, cell, NULL, 1));
    PG_TRY (pg_rows_values (out));
done:
    pg_family_search_free (&search);
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
    pg_free (rows->at);
    pg_free (rows->wide), pg_free (rows->eye);
    pg_free (rows->grade);
    *rows = (pg_rows) { 0 };
}

size_t pg_rows_count (const pg_rows *rows, int grade)
{
    size_t count = 0;
    for (size_t i = 0; i < rows->n; i++) count += rows->grade[i] == grade;
    return count;
}
