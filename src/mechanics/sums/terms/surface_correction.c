/* SPDX-License-Identifier: GPL-3.0-or-later
 * Surface correction (method.surface_correction; theory A3): near a surface the family of a point is cut off
 * and the body is softer there. Bonds are stiffened by g = 2 / (v_i + v_j) or 1 / sqrt (v_i v_j), v being the
 * volume of a point's family over that of a complete one. */
#include "sums_private.h"
#include <math.h>

double pg_sums_surface (const pg_sums *sums, size_t i, size_t j)
{
    const double *v = sums->family_volume;
    if (!v) return 1;
    return sums->rule.surface == PG_SURFACE_VOLUME ? 2 / (v[i] + v[j]) : 1 / sqrt (v[i] * v[j]);
}

/* Computes v of every point of a lattice by the bonds of its family, for bodies in which slots or gaps may
 * separate neighbours. */
static pg_status by_families (pg_sums *s, double whole)
{
    pg_status status = PG_OK;
    pg_family family = { 0 };
    double *beta = NULL, *volume = NULL;
    PG_TRY (pg_sums_family (&family, s, NULL));
    PG_ALLOC (volume, s->cloud->n);
    PG_ALLOC (beta, s->stencil.n);
    for (size_t i = 0; i < s->cloud->n; i++) {
        size_t first = family.start[i];
        pg_sums_bonds (s, &family, i, NULL, NULL, beta);
        for (size_t e = first; e < family.start[i + 1]; e++)
            volume[i] += beta[e - first] * (s->share ? s->share[family.node[e]] : 1) / whole;
    }
    s->family_volume = volume, volume = NULL;
done:
    pg_free (beta), pg_free (volume);
    pg_family_clear (&family);
    return status;
}

/* Computes v of every point of a lattice, from the partial volumes beta of the stencil. (For points without a
 * lattice from_cloud in sums.c does.) */
pg_status pg_sums_family_volumes (pg_sums *s)
{
    pg_status status = PG_OK;
    const pg_stencil *t = &s->stencil;
    double whole = 0;
    for (size_t b = 0; b < t->n; b++) whole += t->beta[b];
    if (s->cloud->between) return by_families (s, whole);
    PG_ALLOC (s->family_volume, s->cloud->n);
    for (size_t i = 0; i < s->cloud->n; i++) {
        double sum = 0;
        for (size_t b = 0; b < t->n; b++) {
            int j = pg_sums_neighbour (&s->sites, s->sites.site[i], t->offset + 3*b);
            if (j >= 0) sum += t->beta[b] * (s->share ? s->share[j] : 1);
        }
        s->family_volume[i] = sum / whole;
    }
done:
    return status;
}
