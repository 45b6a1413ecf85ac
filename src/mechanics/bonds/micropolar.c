/* SPDX-License-Identifier: GPL-3.0-or-later
 * Micropolar peridynamics (Chen et al. 2022, corrected in theory G): bonds are beams that bear elongation,
 * shear and bending, points have rotations. A dilatation may stand beside them (theory G3), so that
 * Poisson's ratio is free. */
#include "micropolar.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const micropolar_options *options_of (const pg_problem *p) { return p->options; }

/* ---- constants ----------------------------------------------------------------------------------------- */
/* Default of the bonds' own Poisson's ratio beside an energy of the dilatation, at most: there the two shear
 * moduli of a lattice with a horizon of 3 spacings differ least (0.3 %; 2 % at the largest ratio, where bonds
 * bear no shear, 6 % at 0). */
static double usual_poisson (pg_mode mode) { return mode == PG_PLANE_STRESS ? 0.25 : 0.2; }

/* With a dilatation the bonds have the Poisson's ratio of the options, and the dilatation bears the
 * difference to the material. */
void micropolar_split (const pg_problem *p, const pg_material *m, double *E, double *nu, double *dilation)
{
    const micropolar_options *o = options_of (p);
    *E = m->modulus, *nu = m->nu, *dilation = 0;
    if (!p->sums->rule.state) return;
    *nu = isnan (o->bond_poisson) ? fmin (*nu, usual_poisson (p->mode)) : o->bond_poisson;
    pg_beam_split (E, dilation, p->mode, m->modulus, m->nu, *nu);
}

/* Returns the critical s, gamma or kappa (which = 0, 1, 2) of a bond between two points of this horizon
 * ratio: the load factor that the criterion gives for a bond of unit stretch, shear or bending. */
static double limit_at (const pg_criterion *c, double ratio, int which)
{
    double one = 1, factor = 0, part[3] = { which == 0, which == 1, which == 2 };
    pg_bond_measures m = {
        .n = 1, .dim = 1, .xi = &one, .eta = &part[0], .reach = &ratio, .shear = &part[1], .bending = &part[2]
    };
    c->type->factor (c, &m, &factor);
    return factor;
}

/* Makes the limits of stretch, shear and bending of all points; criteria of energies have none. */
static pg_status make_limits (bond_force *b)
{
    micropolar *own = (micropolar *) b;
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    double **of[3] = { &b->limit, &own->shear_limit, &own->bending_limit };
    if (!pg_criterion_of_bonds (p->criterion) || (p->criterion->type->needs & PG_NEEDS_ENERGY)) return PG_OK;
    for (int k = 0; k < 3; k++) PG_ALLOC (*of[k], b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = pg_problem_limit (p, PG_NODES, i);
        for (int k = 0; k < 3; k++)
            (*of[k])[i] = c->never ? INFINITY : limit_at (c, pg_cloud_ratio (&p->cloud, i), k);
    }
    own->law.shear_limit = own->shear_limit, own->law.bending_limit = own->bending_limit,
    own->law.single = p->criterion->single;
done:
    return status;
}

/* Computes the constants of the beams of every point, and A of the dilatation beside them. */
static pg_status create (bond_force *b)
{
    pg_status status = PG_OK;
    micropolar *own = (micropolar *) b;
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    pg_beam_sums sums;
    if (rule->state) PG_TRY (dilatation_create (b));
    PG_TRY (pg_beam_measure (&sums, p->sums));
    PG_ALLOC (own->modulus, b->n);
    PG_ALLOC (own->shear, b->n);
    PG_ALLOC (own->bending, b->n);
    PG_ALLOC (b->idle, b->n);
    const pg_material *before = NULL;                  /* material of the previous point, mostly the same */
    double axial = 0, shear = 0, dilation = 0;
    for (size_t i = 0; i < b->n; i++) {
        const pg_material *law = pg_problem_law (p, PG_NODES, i);
        double E, nu;
        if (law != before) {
            micropolar_split (p, law, &E, &nu, &dilation);
            PG_TRY (pg_beam_moduli (&axial, &shear, p->mode, rule->kernel, rule->horizon, E, nu,
                                    p->cloud.thickness));
            before = law;
        }
        if (b->dilatation) b->dilatation->A[i] = dilation;
        own->modulus[i] = axial * p->sums->calibration, own->shear[i] = shear * sums.calibration;
        own->bending[i] = options_of (p)->bending * own->shear[i];
        b->idle[i] = own->shear[i] == 0;
    }
    b->length = p->cloud.h;
    own->law = (pg_beam_law) { .shear = own->shear, .bending = own->bending, .length = b->length };
    PG_TRY (make_limits (b));
    b->setting.modulus = own->modulus, b->setting.beams = &own->law;
done:
    return status;
}

/* Frees what `create` has made; bond_force_free frees the rest. */
static void destroy (bond_force *b)
{
    micropolar *own = (micropolar *) b;
    dilatation_free (b);
    pg_free (own->modulus), pg_free (own->shear), pg_free (own->bending), pg_free (own->shear_limit),
        pg_free (own->bending_limit);
}

/* Has point k the constants of point 0? Never with a dilatation, which reaches further than the point's
 * bonds. */
static int alike (const bond_force *b, size_t k)
{
    const micropolar *own = micropolar_of (b);
    return !b->dilatation && own->modulus[k] == own->modulus[0] && own->shear[k] == own->shear[0];
}

/* ---- one bond ------------------------------------------------------------------------------------------ */
/* Blocks of the beam alone, without a dilatation. */
static void beam (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    const double *xi = s->xi + e * (size_t) b->dim;
    double spare[36];
    pg_beam bond = pg_beam_between (&b->setting, i, (size_t) s->node[e], xi, s->weight[e]);
    pg_beam_blocks (b->dim, xi, &bond, b->length, own, other ? other : spare);
}

/* Blocks of the beam, and of a pair force that is at least as stiff as the dilatation. */
static void blocks (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    double spare[36];
    if (!other) other = spare;
    beam (b, i, s, e, own, other);
    if (!b->dilatation) return;
    const double *stiff = b->dilatation->stiff;
    dilatation_pull (b, i, s, e, stiff[i] + stiff[s->node[e]], own, other);
}

/* bond_theory.strain: shear gamma and bending kappa of one bond, for criteria. */
static void strain (const bond_force *b, const double *xi, const double *di, const double *dj, double *shear,
                    double *bending)
{
    pg_beam_strain (b->dim, xi, b->length, di, dj, shear, bending);
}

/* Adds the virial of one bond, Pa: T[a * dim + c] += 1/2 f_a xi_c / V_i with the force f on i. */
static void add_virial (const bond_force *b, size_t i, const point_bonds *s, size_t e, const double *d,
                             double *T)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride, j = (size_t) s->node[e];
    double own[36], other[36];
    beam (b, i, s, e, own, other);
    for (size_t a = 0; a < dim; a++) {
        double f = 0;
        for (size_t k = 0; k < m; k++) f -= own[a * m + k] * d[i * m + k] + other[a * m + k] * d[j * m + k];
        for (size_t c = 0; c < dim; c++)
            T[a * dim + c] += 0.5 / b->problem->cloud.volume[i] * f * s->xi[e * dim + c];
    }
}

/* Virial stress of point i: of the dilatation, then of the beams. */
static void virial (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                    const double *d, double *T)
{
    if (b->dilatation) dilatation_virial (b, i, s, alive, d, T);
    for (size_t e = 0; e < s->m; e++) if (!alive || alive[s->first + e]) add_virial (b, i, s, e, d, T);
}

/* Mode by which a bond breaks, by the limits of the end with the larger utilisation. */
char micropolar_kind_of (const bond_force *b, const double *d, size_t entry)
{
    const pg_problem *p = b->problem;
    size_t i, j = (size_t) b->family->node[entry], dim = (size_t) b->dim, m = (size_t) b->stride;
    double xi[3], eta[3], shear, bending, most = -1;
    char kind = 't';
    int set;
    pg_problem_locate (p, entry, &set, &i);
    for (size_t k = 0; k < dim; k++)
        xi[k] = p->cloud.x[j * dim + k] - p->cloud.x[i * dim + k], eta[k] = d[j * m + k] - d[i * m + k];
    pg_beam_strain (b->dim, xi, b->length, d + i * m, d + j * m, &shear, &bending);
    for (int end = 0; end < 2; end++) {
        size_t point = end ? j : i;
        const pg_criterion *c = pg_problem_limit (p, PG_NODES, point);
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

/* ---- texts --------------------------------------------------------------------------------------------- */
/* Writes the constants of the beams of material m. */
static void words (const bond_force *b, size_t m, char *text, size_t size)
{
    const pg_problem *p = b->problem;
    const pg_material *a = &p->material[m];
    double axial, shear, E, nu, dilation;
    pg_beam_sums sums;
    int used = 0;
    micropolar_split (p, a, &E, &nu, &dilation);
    if (p->nmaterial > 1) used = snprintf (text, size, "material %.60s: ", a->name);
    if (pg_beam_moduli (&axial, &shear, p->mode, p->sums->rule.kernel, p->sums->rule.horizon, E, nu,
                        p->cloud.thickness)
            != PG_OK
        || pg_beam_measure (&sums, p->sums) != PG_OK)
        return;
    used += snprintf (text + used, size - (size_t) used, "C_N %.6g N/m^6, C_t %.6g N/m^4, bending %.6g C_t",
                      axial, shear, options_of (p)->bending);
    if (p->sums->rule.calibrate && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used,
                          ", times %.6g and %.6g for these points (calibrated)", p->sums->calibration,
                          sums.calibration);
    if (shear == 0 && (size_t) used < size)
        used += snprintf (text + used, size - (size_t) used, "; nothing resists rotations: they are held");
    if (p->sums->rule.state && (size_t) used < size)
        snprintf (text + used, size - (size_t) used,
                  "; bonds make Poisson's ratio %.4g, dilatation bears %.6g Pa more (weighted volumes of %s)",
                  nu, dilation / p->dim,
                  p->sums->rule.follow ? "the bonds that live" : "the bonds of the start");
}

static const bond_theory theory = { .size = sizeof (micropolar),
                                     .create = create,
                                     .free = destroy,
                                     .blocks = blocks,
                                     .alone = beam,
                                     .alike = alike,
                                     .virial = virial,
                                     .strain = strain,
                                     .kind_of = micropolar_kind_of,
                                     .find_dying = dilatation_dying,
                                     .words = words };

/* pg_force_type.create */
pg_status micropolar_create (void **self, const pg_problem *problem)
{
    return bond_force_make (self, problem, &theory);
}
