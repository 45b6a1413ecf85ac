/* SPDX-License-Identifier: GPL-3.0-or-later
 * Generalised micropolar peridynamics (Chen et al. 2022, corrected in theory G): bonds are beams that bear
 * elongation, shear and bending, points have rotations. Everything else is that of bonds, whose code this is;
 * a dilatation beside them (theory G3) that of lps.c. */
#include "bond.h"
#include <math.h>

/* The s, gamma or kappa at which a bond of two points like this one breaks: the criterion's own answer for a
 * bond of unit stretch, shear or bending. */
static double limit_at (const pg_criterion *c, double ratio, int which)
{
    double one = 1, factor = 0, part[3] = { which == 0, which == 1, which == 2 };
    pg_bond_measures m = {
        .n = 1, .dim = 1, .xi = &one, .eta = &part[0], .reach = &ratio, .shear = &part[1], .bending = &part[2]
    };
    c->type->factor (c, &m, &factor);
    return factor;
}

static pg_status make_limits (bond *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    double **of[3] = { &b->limit, &b->shear_limit, &b->bending_limit };
    if (!p->criterion->type || (p->criterion->type->needs & PG_NEEDS_ENERGY)) return PG_OK;
    for (int k = 0; k < 3; k++) PG_ALLOC (*of[k], b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = &p->criterion[p->block[PG_NODES][i]];
        for (int k = 0; k < 3; k++)
            (*of[k])[i] = c->never ? INFINITY : limit_at (c, pg_cloud_ratio (&p->cloud, i), k);
    }
    b->beams.shear_limit = b->shear_limit, b->beams.bending_limit = b->bending_limit,
    b->beams.single = p->criterion->single;
done:
    return status;
}

pg_status gmpd_create (bond *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    pg_beam_sums sums;
    if (!rule->beams) return PG_OK;
    PG_TRY (pg_beam_measure (&sums, p->sums));
    PG_ALLOC (b->shear, b->n);
    PG_ALLOC (b->bending, b->n);
    PG_ALLOC (b->idle, b->n);
    for (size_t i = 0; i < b->n; i++) {
        double E, nu, dilation;
        pg_problem_beams (p, (size_t) p->block[PG_NODES][i], &E, &nu, &dilation);
        PG_TRY (pg_beam_moduli (&b->modulus[i], &b->shear[i], p->mode, rule->kernel, rule->horizon, E, nu,
                                p->cloud.thickness));
        b->modulus[i] *= p->sums->calibration, b->shear[i] *= sums.calibration;
        b->bending[i] = p->bending * b->shear[i];
        b->idle[i] = b->shear[i] == 0;
    }
    b->beams = (pg_beam_law) { .shear = b->shear, .bending = b->bending, .length = p->cloud.h };
    PG_TRY (make_limits (b));
done:
    return status;
}

/* By the law of the end that is nearer to its limit */
char gmpd_kind_of (void *self, const double *d, size_t entry)
{
    const bond *b = self;
    const pg_problem *p = b->problem;
    size_t i, j = (size_t) b->family->node[entry], dim = (size_t) b->dim, m = (size_t) b->stride;
    double xi[3], eta[3], shear, bending, most = -1;
    char kind = 't';
    int set;
    pg_problem_locate (p, entry, &set, &i);
    for (size_t k = 0; k < dim; k++)
        xi[k] = p->cloud.x[j * dim + k] - p->cloud.x[i * dim + k], eta[k] = d[j * m + k] - d[i * m + k];
    pg_beam_strain (b->dim, xi, b->beams.length, d + i * m, d + j * m, &shear, &bending);
    for (int end = 0; end < 2; end++) {
        size_t point = end ? j : i;
        const pg_criterion *c = &p->criterion[p->block[PG_NODES][point]];
        double ratio = pg_cloud_ratio (&p->cloud, point), u;
        char own;
        pg_bond_measures one = {
            .n = 1, .dim = b->dim, .xi = xi, .eta = eta, .reach = &ratio, .shear = &shear, .bending = &bending
        };
        if (c->never) continue;
        c->type->utilisation (c, &one, &u, &own);
        if (u > most) most = u, kind = own;
    }
    return kind;
}

void gmpd_free (bond *b)
{
    pg_free (b->shear), pg_free (b->bending), pg_free (b->idle), pg_free (b->shear_limit),
        pg_free (b->bending_limit);
}

const pg_force_type pg_force_gmpd = {
    .name = "gmpd",
    .summary = "micropolar peridynamics: bonds as beams, points that turn (Chen et al. 2022)",
    BOND_ENTRIES,
    .kind_of = gmpd_kind_of
};
