/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ordinary state-based peridynamics, the linear peridynamic solid (Silling et al. 2007; theory B6), in 2D and
 * 3D and for any Poisson's ratio. Forces of points as those of bonds, whose code this is, but for the
 * constants, the diagonal of K, the bound of frequencies and the stress:
 *   q = sum w r^2 V, theta = (d / q) sum w xi.eta V, t = (A theta / q) w r + (B / q) w e.eta, f = (t_i + t_j)
 *     e, w = k beta / r. */
#include "bond.h"
#include <math.h>
#include <string.h>

/* ---- constants ----------------------------------------------------------------------------------------- */
/* Bonds of a new state, which the pre-cracks have cut. */
static pg_status count_bonds (bond *b)
{
    pg_status status = PG_OK;
    pg_state *fresh = NULL;
    size_t all = b->family->start[b->n];
    if (b->problem->cracks.n == 0) return PG_OK;
    PG_TRY (pg_state_create (&fresh, b->problem, b->dim));
    PG_ALLOC (b->counted, all);
    memcpy (b->counted, fresh->alive + b->problem->first_bond[PG_NODES], all);
done:
    pg_state_free (&fresh);
    return status;
}

pg_status lps_create (bond *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    if (!p->sums->rule.state) return PG_OK;
    PG_ALLOC (b->dilation, b->n);
    PG_ALLOC (b->deviation, b->n);
    PG_ALLOC (b->q, b->n);
    PG_ALLOC (b->stiff, b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_material *m = &p->material[p->block[PG_NODES][i]];
        double E, nu;
        if (p->sums->rule.beams)
            gmpd_split (p, (size_t) p->block[PG_NODES][i], &E, &nu, &b->dilation[i]);
        else pg_state_moduli (p->mode, m->modulus, m->nu, &b->dilation[i], &b->deviation[i]);
    }
    PG_TRY (count_bonds (b));
done:
    return status;
}

void lps_free (bond *b)
{
    pg_free (b->dilation), pg_free (b->deviation), pg_free (b->q), pg_free (b->stiff), pg_free (b->counted);
}

pg_status lps_weigh (bond *b)
{
    pg_status status = PG_OK;
    if (!b->dilation || (b->weighed && (b->weighed == b->revision || !b->problem->sums->rule.follow)))
        return PG_OK;
    PG_TRY (pg_bond_loop_dilatation (b->sweep, NULL, NULL, b->q));
    for (size_t i = 0; i < b->n; i++)
        b->stiff[i] = b->q[i] > 0 ? (b->deviation[i] + b->dim * fmax (b->dilation[i], 0)) / b->q[i] : 0;
    b->weighed = b->revision;
done:
    return status;
}

pg_status lps_look (bond *b, const double *d, size_t *dying)
{
    pg_status status = PG_OK;
    PG_TRY (pg_bond_loop_energies (b->sweep, d, b->density));
    *dying = 0;
    for (size_t i = 0; i < b->n; i++) *dying += b->dying[i] = b->density[i] >= b->critical[i];
done:
    return status;
}

/* ---- one point ----------------------------------------------------------------------------------------- */
double lps_weight (const bond *b, size_t i, const point_bonds *s, size_t e)
{
    const pg_sums *sums = b->problem->sums;
    const double *v = sums->family_volume;
    size_t j = (size_t) s->node[e];
    if (!v) return s->weight[e];
    return s->weight[e]
           * (sums->rule.surface == PG_SURFACE_VOLUME ? 0.5 * (v[i] + v[j]) : sqrt (v[i] * v[j]));
}

static double weight_of (const bond *b, size_t i, const point_bonds *s, size_t e, double *rr)
{
    size_t dim = (size_t) b->dim;
    *rr = 0;
    for (size_t k = 0; k < dim; k++) *rr += s->xi[e * dim + k] * s->xi[e * dim + k];
    return lps_weight (b, i, s, e) / sqrt (*rr);
}

static double over (double a, double q) { return q > 0 ? a / q : 0; }

/* Second derivatives of the energy by u_i: of its own dilatation, of those of its neighbours, of the
 * stretches. */
void lps_own (const bond *b, size_t i, const point_bonds *s, double *D)
{
    size_t dim = (size_t) b->dim;
    const double *V = b->problem->cloud.volume, *q = b->q;
    double g[3] = { 0 }, rr;
    memset (D, 0, dim * dim * sizeof *D);
    for (size_t e = 0; e < s->m; e++) {
        if (!bond_lives (b, s->first + e)) continue;
        size_t j = (size_t) s->node[e];
        const double *xi = s->xi + e * dim;
        double w = weight_of (b, i, s, e, &rr),
               other = over (b->dilation[j] * b->dim, q[j] * q[j]) * V[j] * (w * V[i]) * (w * V[i]);
        double both = V[i] * V[j] * w * (over (b->deviation[i], q[i]) + over (b->deviation[j], q[j])) / rr
                      + other;
        for (size_t a = 0; a < dim; a++) {
            g[a] += w * V[j] * xi[a];
            for (size_t c = 0; c < dim; c++) D[a * dim + c] += both * xi[a] * xi[c];
        }
    }
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++)
            D[a * dim + c] += V[i] * over (b->dilation[i] * b->dim, q[i] * q[i]) * g[a] * g[c];
}

/* A q that follows shrinks as bonds die, yet never below what one live bond makes it: w r^2 V. */
double lps_bound (const bond *b, size_t i, const point_bonds *s)
{
    const double *V = b->problem->cloud.volume;
    double nearest = INFINITY, sum = 0, rr, far = b->dim;
    for (size_t e = 0; e < s->m; e++) {
        size_t j = (size_t) s->node[e];
        weight_of (b, i, s, e, &rr);
        nearest = fmin (nearest, rr);
        sum += (b->deviation[j] + far * fmax (b->dilation[j], 0)) * V[j] / (V[i] * rr);
    }
    return 2 * (sum + (b->deviation[i] + far * fmax (b->dilation[i], 0)) / nearest);
}

/* Stress of Silling and Lehoucq (2008) for uniform strain: its trace is d kappa theta whatever the family. */
void lps_virial (const bond *b, size_t i, const point_bonds *s, const unsigned char *alive, const double *d,
                 double *T)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    const double *V = b->problem->cloud.volume;
    double sum = 0, rr, beta = over (b->deviation[i], b->q[i]), spread[9] = { 0 };
    for (size_t e = 0; e < s->m; e++) {
        if (alive && !alive[s->first + e]) continue;
        size_t j = (size_t) s->node[e];
        const double *xi = s->xi + e * dim;
        double w = weight_of (b, i, s, e, &rr) * V[j], along = 0;
        for (size_t a = 0; a < dim; a++) along += xi[a] * (d[j * m + a] - d[i * m + a]);
        sum += w * along;
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++)
                spread[a * dim + c] += w * xi[a] * xi[c],
                    T[a * dim + c] += beta * w * along / rr * xi[a] * xi[c];
    }
    double alpha = over (b->dilation[i] * b->dim, b->q[i] * b->q[i]) * sum;
    for (size_t k = 0; k < dim * dim; k++) T[k] += alpha * spread[k];
}

/* ---- what it is before it exists ----------------------------------------------------------------------- */
static void rule (pg_sum_rule *out, const pg_scene *scene, pg_mode mode, const pg_approx *approx,
                  double spacing,
                  int lattice)
{
    static const char surface[] = "method.surface_correction";
    point_force_rule (out, scene, mode, approx, spacing, lattice);
    point_force_rule_with_dilatation (out, scene);
    if (strcmp (pg_scene_text (scene, surface), "auto") == 0) out->surface = PG_SURFACE_NONE;
}

static int long_range (const pg_scene *scene)
{
    (void) scene;
    return 1;
}

/* Any Poisson's ratio; families that are not whole count by their own q. */
static void check (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    point_force_refuse_matrix (p, scene, "");
    if (p->mode == PG_LINE)
        pg_scene_fault (scene, "method.force",
                        "%s has no meaning in one dimension, where it is the same as bond: use force: bond",
                        p->method->name);
    if (rule->finite)
        pg_scene_fault (scene, "method.stretch",
                        "force: %s is linear in the displacement: use stretch: linear, or force: bond",
                        p->method->name);
    if (rule->surface != PG_SURFACE_NONE)
        pg_scene_fault (
            scene, "method.surface_correction",
            "force: %s weighs families that are not whole by their own weighted volume: use none or auto",
            p->method->name);
}


static pg_status read (pg_problem *p, const pg_scene *scene) { return point_force_read (p, scene, check); }

const pg_force_type pg_force_lps = {
    .method = { .name = "lps",
                .summary = "ordinary state-based peridynamics, any Poisson's ratio (Silling et al. 2007)",
                .keys = { &point_force_keys, &state_based_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY,
                .long_range = long_range,
                .rule = rule,
                .read = read,
                .limits = point_force_limits,
                POINT_FORCE_METHOD },
    BOND_COMMON
};
