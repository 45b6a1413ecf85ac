/* SPDX-License-Identifier: GPL-3.0-or-later
 * CSV files of a comparison: position, value, reference and difference of each component; and the differences
 * at the points as one array for pictures. */
#include "perigal/compare.h"
#include <math.h>
#include <stdio.h>

/* Positions with values of both sides: u and v displacements, m (n x 3), s and t stresses, Pa (n x 6);
 * columns that are written. */
typedef struct { size_t n, ncolumn; int dim, column[9]; const double *x; double *u, *s, *v, *t; } pairs;

/* The value of a column at place i: 0 to 2 displacement x y z, m; 3 to 8 stress xx yy zz xy yz zx, Pa. */
static double part (const double *u, const double *s, size_t i, int column)
{
    return column < 3 ? u[3*i + (size_t) column] : s[6*i + (size_t) column - 3];
}

/* Creates the table with its header: coordinates, then for each column value, reference and
 * difference, all with units. */
static pg_status create (pg_table **out, const char *path, const pairs *p)
{
    char name[30][48];
    const char *column[30];
    size_t n = 0;
    for (int k = 0; k < p->dim; k++) snprintf (name[n++], sizeof *name, "%c [m]", "xyz"[k]);
    for (size_t c = 0; c < p->ncolumn; c++) {
        static const char *const what[3] = { "", "reference_", "difference_" };
        for (int k = 0; k < 3; k++)
            snprintf (name[n++], sizeof *name, "%s%s [%s]", what[k], pg_column_name (p->column[c]),
                      pg_column_unit (p->column[c]));
    }
    for (size_t k = 0; k < n; k++) column[k] = name[k];
    return pg_table_create (out, path, n, column);
}

/* Samples both sides at all places and lists the columns that both know. PG_E_USAGE: bodies of
 * different dimensions. p->u is to be freed by the caller, also after a failure; the other
 * arrays are parts of it. */
static pg_status sample_both (pairs *p, const pg_sampler *value, const pg_sampler *reference)
{
    pg_status status = PG_OK;
    PG_ALLOC (p->u, 18 * p->n);
    p->v = p->u + 3 * p->n, p->s = p->v + 3 * p->n, p->t = p->s + 6 * p->n;
    if (value->dim != reference->dim)
        PG_FAIL (PG_E_USAGE, "a %dD result is compared with a %dD one", value->dim, reference->dim);
    PG_TRY (value->sample (value->context, p->n, p->x, p->u, p->s));
    PG_TRY (reference->sample (reference->context, p->n, p->x, p->v, p->t));
    for (int c = 0; c < 9; c++) {
        int known = c < 3 ? value->displacement & reference->displacement : value->stress & reference->stress;
        if (known >> (c < 3 ? c : c - 3) & 1) p->column[p->ncolumn++] = c;
    }
done:
    return status;
}

/* Writes one row per point of the cloud. */
pg_status pg_compare_points (const char *path, const pg_cloud *cloud, const pg_sampler *value,
                             const pg_sampler *reference)
{
    pg_status status = PG_OK;
    pg_table *table = NULL;
    pairs p = { .n = cloud->n, .dim = cloud->dim, .x = cloud->x };
    double row[30];
    PG_TRY (sample_both (&p, value, reference));
    PG_TRY (create (&table, path, &p));
    for (size_t i = 0; i < p.n; i++) {
        size_t n = 0;
        for (int k = 0; k < p.dim; k++) row[n++] = p.x[i * (size_t) p.dim + (size_t) k];
        for (size_t c = 0; c < p.ncolumn; c++, n += 3) {
            row[n] = part (p.u, p.s, i, p.column[c]), row[n + 1] = part (p.v, p.t, i, p.column[c]);
            row[n + 2] = row[n] - row[n + 1];
        }
        PG_TRY (pg_table_row (table, row));
    }
done:
    pg_table_close (&table);
    pg_free (p.u);
    return status;
}

/* Writes one row per row of the table; the reference columns are its own values in SI. A value that one side
 * lacks is an empty cell. */
pg_status pg_compare_line (const char *path, const pg_line *line, const pg_sampler *value)
{
    pg_status status = PG_OK;
    pg_table *table = NULL;
    pairs p = { .n = line->n, .ncolumn = line->ncolumn, .dim = line->dim, .x = line->x };
    double row[30];
    for (size_t c = 0; c < line->ncolumn; c++) p.column[c] = line->column[c];
    PG_ALLOC (p.u, 9 * p.n);
    p.s = p.u + 3 * p.n;
    PG_TRY (pg_line_sample (line, value, p.u, p.s));
    PG_TRY (create (&table, path, &p));
    for (size_t i = 0; i < p.n; i++) {
        size_t n = 0;
        for (int k = 0; k < p.dim; k++) row[n++] = p.x[i * (size_t) p.dim + (size_t) k];
        for (size_t c = 0; c < p.ncolumn; c++, n += 3) {
            row[n] = part (p.u, p.s, i, p.column[c]), row[n + 1] = line->value[i * line->ncolumn + c];
            row[n + 2] = row[n] - row[n + 1];
        }
        PG_TRY (pg_table_row (table, row));
    }
done:
    pg_table_close (&table);
    pg_free (p.u);
    return status;
}

/* One number for each point: the difference of a column, or with PG_COMPARE_U and PG_COMPARE_S the norm
 * of all that both know. Columns that one side does not know give NAN. In the norm of the stress each
 * shear counts twice, since it stands for two components of the tensor. */
pg_status pg_compare_field (double *out, const pg_cloud *cloud, int column, const pg_sampler *value,
                            const pg_sampler *reference)
{
    pg_status status = PG_OK;
    pairs p = { .n = cloud->n, .dim = cloud->dim, .x = cloud->x };
    PG_TRY (sample_both (&p, value, reference));
    for (size_t i = 0; i < p.n; i++) {
        double sum = 0;
        out[i] = NAN;
        for (size_t c = 0; c < p.ncolumn; c++) {
            double d = part (p.u, p.s, i, p.column[c]) - part (p.v, p.t, i, p.column[c]);
            if (p.column[c] == column) out[i] = d;
            if ((column == PG_COMPARE_U && p.column[c] < 3) || (column == PG_COMPARE_S && p.column[c] >= 3))
                sum += (p.column[c] > 5 ? 2 : 1) * d * d;
        }
        if (column >= PG_COMPARE_U) out[i] = sqrt (sum);
    }
done:
    pg_free (p.u);
    return status;
}
