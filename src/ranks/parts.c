/* SPDX-License-Identifier: GPL-3.0-or-later
 * Connected parts of a body that is divided among ranks. Each rank has joined its own points (union-find);
 * what is connected across ranks is found by exchanging the least point number of each part until none
 * changes. */
#include "perigal/ranks.h"
#include <string.h>

/* Gives all points of each part, as far as this rank knows it, the least label among them. */
static void level_out (size_t n, int *parent, double *label)
{
    for (size_t i = 0; i < n; i++) {
        int root = pg_disjoint_root (parent, (int) i);
        if (label[i] < label[root]) label[root] = label[i];
    }
    for (size_t i = 0; i < n; i++) label[i] = label[pg_disjoint_root (parent, (int) i)];
}

/* Counts the labels of owned points that differ from `before`, and copies all labels there. */
static double changed (const pg_subdomain *s, size_t components, const double *label, double *before)
{
    double n = 0;
    for (size_t i = 0; i < s->n * components; i++) {
        n += s->owned[i / components] && label[i] != before[i];
        before[i] = label[i];
    }
    return n;
}

pg_status pg_subdomain_label (const pg_subdomain *s, size_t n, size_t components, int *parent, double *label)
{
    pg_status status = PG_OK;
    double *before = NULL, more = 1;
    size_t all = n * components;
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < components; k++)
            label[i * components + k] = (double) components * (s ? (double) s->number[i] : (double) i)
                                        + (double) k;
    level_out (all, parent, label);
    if (!s) return PG_OK;
    PG_ALLOC (before, all);
    memcpy (before, label, all * sizeof *label);
    while (more > 0) {
        PG_TRY (pg_subdomain_exchange (s, components, label));
        level_out (all, parent, label);
        more = changed (s, components, label, before);
        PG_TRY (pg_ranks_most (1, &more));
    }
done:
    pg_free (before);
    return status;
}

pg_status pg_subdomain_count (const pg_subdomain *s, size_t n, int *parent, double *out)
{
    pg_status status = PG_OK;
    double *label = NULL;
    int *size = NULL;
    out[0] = out[1] = 0;
    PG_ALLOC (label, n);
    PG_ALLOC (size, n);
    for (size_t i = 0; i < n; i++) size[pg_disjoint_root (parent, (int) i)]++;
    PG_TRY (pg_subdomain_label (s, n, 1, parent, label));
    for (size_t i = 0; i < n; i++) {
        if (!pg_owns (s, i) || label[i] != (s ? (double) s->number[i] : (double) i)) continue;
        out[size[pg_disjoint_root (parent, (int) i)] > 1]++;
    }
    PG_TRY (pg_ranks_sum (2, out));
done:
    pg_free (label), pg_free (size);
    return status;
}
