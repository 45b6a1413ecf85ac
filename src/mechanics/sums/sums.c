/* SPDX-License-Identifier: GPL-3.0-or-later
 * The sums of a rule on a cloud: sites and stencil of a lattice, calibration, volumes of families for surface
 * corrections. */
#include "mechanics/sums/terms/sums_private.h"
#include "perigal/criterion.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- on a lattice -------------------------------------------------------------------------------------- */
/* Makes s->share: volume of each point over that of a lattice cell, the weights of lattice loops, if some
 * differ from 1 (cut cells, files with volumes). NULL: all are 1. */
static pg_status find_shares (pg_sums *s, double cell)
{
    pg_status status = PG_OK;
    int equal = 1;
    for (size_t i = 0; i < s->cloud->n; i++) equal &= fabs (s->cloud->volume[i] - cell) <= 1e-12 * cell;
    if (equal) goto done;
    PG_ALLOC (s->share, s->cloud->n);
    for (size_t i = 0; i < s->cloud->n; i++) s->share[i] = s->cloud->volume[i] / cell;
done:
    return status;
}

/* Are points numbered as their sites are? Then neighbours ascend as the stencil does. */
static void check_order (pg_sums *s)
{
    s->ordered = 1;
    for (size_t i = 1; i < s->cloud->n; i++) s->ordered &= s->sites.site[i - 1] < s->sites.site[i];
}

/* Computes on a lattice: the stencil; the factor that makes the energy of uniform strain exact for an inner
 * point (calibration); the energy of a straight crack along the axes over that of theory at the same critical
 * stretch (toughness); the volume of a whole family, m^3. */
static pg_status from_lattice (pg_sums *s)
{
    pg_status status = PG_OK;
    const pg_sum_rule *rule = &s->rule;
    double c = 1, G = 0,
           G0 = pg_bond_fracture_energy (rule->mode, rule->kernel, rule->horizon, s->cloud->thickness, c, 1);
    int dim = s->sites.dim;
    PG_TRY (pg_stencil_build (&s->stencil, rule, dim, s->sites.step));
    double cell = s->stencil.cell * s->cloud->thickness;
    if (rule->calibrate) s->calibration = pg_stencil_calibration (&s->stencil, rule);
    for (int k = 0; k < dim; k++)
        G += pg_stencil_fracture_energy (&s->stencil, s->calibration * c, s->cloud->thickness, 1, k) / dim;
    s->toughness = G / G0;
    for (size_t b = 0; b < s->stencil.n; b++) s->full += s->stencil.beta[b] * cell;
    PG_TRY (find_shares (s, cell));
    check_order (s);
    if (rule->surface != PG_SURFACE_NONE) PG_TRY (pg_sums_family_volumes (s));
done:
    return status;
}

/* Energy (Pa) of a straight cut across `axis` of the lattice by state-based theory, for step and critical
 * stretch 1. I_l: the part of the weighted volume q of a point l - 1/2 layers from the cut that lies beyond
 * it. Points lose A d (I_l / q)^2 by their dilatation and B I_l / q by the rest, summed over all layers on
 * one side: G = h s0^2 sum_l [A d (I_l / q)^2 + B I_l / q]. */
static double cut_energy (const pg_stencil *t, double A, double B, int axis)
{
    double q = 0, sum = 0, inside = 1;
    for (size_t b = 0; b < t->n; b++) q += t->weight[b] * t->r[b];
    for (int layer = 1; inside > 0; layer++) {
        inside = 0;
        for (size_t b = 0; b < t->n; b++)
            if (t->offset[3 * b + (size_t) axis] >= layer) inside += t->weight[b] * t->r[b];
        sum += A * t->dim * (inside / q) * (inside / q) + B * inside / q;
    }
    return sum;
}

/* Energy of a crack along the lattice over that of theory at the same critical stretch; 1 where it is not
 * known. The energy of state-based bonds comes from dilatation and deviation, so that the ratio depends on
 * nu. */
double pg_sums_toughness (const pg_sums *sums, double E, double nu)
{
    const pg_sum_rule *rule = &sums->rule;
    double A, B, G = 0;
    int dim = sums->sites.dim;
    if (!rule->state || rule->beams || sums->stencil.n == 0) return sums->toughness;
    pg_criterion_setting s = { .mode = rule->mode,
                               .horizon = rule->horizon,
                               .modulus = E,
                               .poisson = nu,
                               .kernel = rule->kernel->name,
                               .state = 1 };
    pg_state_moduli (rule->mode, E, nu, &A, &B);
    for (int k = 0; k < dim; k++) G += sums->sites.step[k] * cut_energy (&sums->stencil, A, B, k) / dim;
    return G / pg_state_fracture_energy (&s, 1);
}

/* The energy, J/m^2 at critical stretch 1, that a straight cut takes from the dilatation beside beams. */
double pg_beam_cut_dilatation (const pg_sums *sums, double dilation)
{
    const pg_sum_rule *rule = &sums->rule;
    double G = 0;
    if (!rule->calibrate || sums->stencil.n == 0)
        return rule->horizon * pg_state_cut_share (rule->mode, rule->kernel->name, dilation, 0);
    for (int k = 0; k < sums->sites.dim; k++)
        G += sums->sites.step[k] * cut_energy (&sums->stencil, dilation, 0, k) / sums->sites.dim;
    return G;
}

/* ---- without a lattice --------------------------------------------------------------------------------- */

/* Computes calibration and full family volume without a lattice: medians over the points with whole
 * families. */
static pg_status from_cloud (pg_sums *s)
{
    pg_status status = PG_OK;
    const pg_cloud *cloud = s->cloud;
    pg_family family = {0};
    double *volume = NULL, *moment = NULL, middle;
    size_t n = cloud->n;
    if (s->rule.partial == PG_PARTIAL_OVERLAP)
        PG_FAIL (PG_E_USAGE, "partial volume `overlap` needs points on a lattice: choose `linear` or `none`");
    PG_TRY (pg_sums_family (&family, s, NULL));
    if (family.start[n] == 0) PG_FAIL (PG_E_USAGE, "a horizon of %g m reaches no neighbour", s->rule.horizon);
    PG_ALLOC (volume, n);
    PG_ALLOC (moment, n);
    for (size_t i = 0; i < n; i++)
        for (size_t e = family.start[i]; e < family.start[i + 1]; e++) {
            size_t j = (size_t) family.node[e];
            sums_bond b = pg_sums_bond_between (&s->rule, cloud, i, j);
            volume[i] += b.beta * cloud->volume[j] / pow (pg_cloud_ratio (cloud, i), cloud->dim);
            moment[i] += b.weight * b.r * cloud->volume[j] / cloud->thickness;
        }
    PG_TRY (pg_sums_median (&s->full, cloud, volume, volume));
    PG_TRY (pg_sums_median (&middle, cloud, volume, moment));
    if (s->rule.calibrate) s->calibration = pg_sums_whole (&s->rule, cloud->dim) / middle;
    if (s->rule.surface != PG_SURFACE_NONE) {
        for (size_t i = 0; i < n; i++) volume[i] /= s->full;
        PG_TRY (pg_subdomain_exchange (cloud->subdomain, 1, volume));  /* ghosts lack neighbours */
        s->family_volume = volume;
        volume = NULL;
    }
done:
    pg_free (moment);
    pg_free (volume);
    pg_family_clear (&family);
    return status;
}

/* Makes the sums of a rule on a cloud, which is borrowed. lattice: with which steps the points were made, or
 * NULL. */
pg_status pg_sums_create (pg_sums **out, const pg_sum_rule *rule, const pg_cloud *cloud,
                          const pg_lattice *lattice)
{
    pg_status status = PG_OK;
    pg_sums *s = NULL;
    *out = NULL;
    PG_TRY (pg_sums_check_rule (rule, cloud->dim));
    if (cloud->n == 0) PG_FAIL (PG_E_USAGE, "bonds need points, and there are none");
    PG_ALLOC (s, 1);
    s->rule = *rule;
    s->cloud = cloud;
    s->calibration = s->toughness = 1;
    PG_TRY (pg_sites_build (&s->sites, cloud, lattice));
    if (s->sites.count[0]) PG_TRY (from_lattice (s));
    else PG_TRY (from_cloud (s));
    *out = s;
done:
    if (status != PG_OK) pg_sums_free (&s);
    return status;
}

/* Frees *sums, which may be NULL or made in part. */
void pg_sums_free (pg_sums **sums)
{
    pg_sums *s = *sums;
    if (!s) return;
    pg_sites_clear (&s->sites);
    pg_stencil_clear (&s->stencil);
    pg_free (s->share);
    pg_free (s->family_volume);
    pg_free (s);
    *sums = NULL;
}
