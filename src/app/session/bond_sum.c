/* SPDX-License-Identifier: GPL-3.0-or-later
 * Forces of bonds between the points of an array: sums, families, alive mask and the bond loop in one
 * object. */
#include "session_private.h"
#include <math.h>
#include <string.h>

struct pg_bond_sum {
    pg_cloud  cloud;
    pg_sums  *sums;
    pg_family family;
    double   *modulus;                                 /* calibrated micromodulus of each point, N/m^6 */
    unsigned char *alive;                              /* per entry of the family: 1 intact, 0 broken */
    pg_bond_loop  *loop;
};

/* Copies the points, whose arrays belong to the caller. */
static pg_status copy_points (pg_bond_sum *s, const pg_cloud *cloud)
{
    pg_status status = PG_OK;
    PG_TRY (pg_cloud_of_arrays (&s->cloud, cloud->dim, cloud->n, cloud->x, cloud->volume, cloud->h,
                                cloud->thickness));
done:
    return status;
}

pg_status pg_bond_sum_create (pg_bond_sum **out, const pg_cloud *cloud, const pg_sum_rule *rule, double c)
{
    pg_status status = PG_OK;
    pg_bond_sum *s = NULL;
    *out = NULL;
    if (!(c > 0) || !isfinite (c)) PG_FAIL (PG_E_USAGE, "the micromodulus is %g: it must be above 0", c);
    if (rule->state || rule->beams)
        PG_FAIL (PG_E_USAGE, "forces on arrays are those of bonds alone, not state-based, not micropolar");
    PG_ALLOC (s, 1);
    PG_TRY (copy_points (s, cloud));
    PG_TRY (pg_sums_create (&s->sums, rule, &s->cloud, NULL));
    PG_TRY (pg_sums_family (&s->family, s->sums, NULL));
    PG_ALLOC (s->modulus, s->cloud.n);
    for (size_t i = 0; i < s->cloud.n; i++) s->modulus[i] = s->sums->calibration * c;
    PG_ALLOC (s->alive, s->family.start[s->family.n]);
    memset (s->alive, 1, s->family.start[s->family.n]);
    const pg_bond_loop_setting setting = { .sums = s->sums, .family = &s->family, .modulus = s->modulus,
                                           .threads = rule->threads > 0 ? rule->threads : 1 };
    PG_TRY (pg_bond_loop_create (&s->loop, &setting));
    pg_bond_loop_update (s->loop, s->alive, NULL);
    *out = s;
    s = NULL;
done:
    pg_bond_sum_free (&s);
    return status;
}

/* Frees a sum over bonds, also one that was made in part only; NULL is allowed. */
void pg_bond_sum_free (pg_bond_sum **sum)
{
    pg_bond_sum *s = *sum;
    if (!s) return;
    pg_bond_loop_free (&s->loop);
    pg_family_clear (&s->family);
    pg_sums_free (&s->sums);
    pg_cloud_clear (&s->cloud);
    pg_free (s->modulus), pg_free (s->alive);
    pg_free (s);
    *sum = NULL;
}

pg_status pg_bond_sum_force (pg_bond_sum *s, const double *u, double *f, double *W)
{
    pg_status status = PG_OK;
    for (size_t i = 0; i < s->cloud.n * (size_t) s->cloud.dim; i++)
        if (!isfinite (u[i]))
            PG_FAIL (PG_E_USAGE, "the displacement of point %zu is %g", i / (size_t) s->cloud.dim + 1, u[i]);
    PG_TRY (pg_bond_loop_force (s->loop, u, f, NULL));
    if (W) PG_TRY (pg_bond_loop_energies (s->loop, u, W));
done:
    return status;
}

const pg_family *pg_bond_sum_family (const pg_bond_sum *s, const unsigned char **alive)
{
    if (alive) *alive = s->alive;
    return &s->family;
}

void pg_bond_sum_bonds (const pg_bond_sum *s, double *xi, double *weight, double *beta, double *modulus)
{
    size_t dim = (size_t) s->cloud.dim;
    for (size_t i = 0; (xi || weight || beta) && i < s->cloud.n; i++) {
        size_t e = s->family.start[i];
        pg_sums_bonds (s->sums, &s->family, i, xi ? xi + e * dim : NULL, weight ? weight + e : NULL,
                       beta ? beta + e : NULL);
    }
    if (modulus) *modulus = s->modulus[0];
}

int pg_bond_sum_dim (const pg_bond_sum *s) { return s->cloud.dim; }

const char *pg_bond_sum_name (const pg_bond_sum *s) { return pg_bond_loop_name (s->loop); }

/* Index of i in the family of j, by bisection: neighbours ascend, and families are symmetric. */
size_t session_mirror (const pg_family *f, int i, int j)
{
    size_t low = f->start[j], high = f->start[j + 1];
    while (low + 1 < high) {
        size_t middle = (low + high) / 2;
        if (f->node[middle] <= i) low = middle;
        else high = middle;
    }
    return low;
}

pg_status pg_bond_sum_mask (pg_bond_sum *s, const unsigned char *alive)
{
    const pg_family *f = &s->family;
    for (size_t i = 0; i < f->n; i++)
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            s->alive[e] = alive[e] && alive[session_mirror (f, (int) i, f->node[e])];
    pg_bond_loop_update (s->loop, s->alive, NULL);
    return PG_OK;
}
