/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bond-based peridynamics: forces straight between points, by the sweeps of direct sums (Silling 2000;
 * Silling and Askari 2005; theory A). */
#include "bond.h"
#include <math.h>
#include <string.h>

static size_t ndof (const bond *b) { return b->n * (size_t) b->stride; }

/* ---- one point ----------------------------------------------------------------------------------------- */
void point_bonds_at (const bond *b, size_t i, int thread, point_bonds *s)
{
    double *workspace = b->workspace + (size_t) thread * b->widest * (size_t) (b->dim + 2);
    s->first = b->family->start[i], s->m = b->family->start[i + 1] - s->first;
    s->node = b->family->node + s->first;
    s->xi = workspace, s->weight = workspace + b->widest * (size_t) b->dim, s->beta = s->weight + b->widest;
    pg_sums_bonds (b->problem->sums, b->family, i, s->xi, s->weight, s->beta);
}

/* N/m^3, of a bond whose constant is `both` */
static double kappa_of (const bond *b, size_t i, const point_bonds *s, size_t e, double both, double *r)
{
    size_t j = (size_t) s->node[e];
    const double *V = b->problem->cloud.volume, *xi = s->xi + e * (size_t) b->dim;
    double rr = 0;
    for (int k = 0; k < b->dim; k++) rr += xi[k] * xi[k];
    if (r) *r = sqrt (rr);
    return both * (b->stiff ? lps_weight (b, i, s, e) : s->weight[e]) * (V[i] * V[j]) / (rr * sqrt (rr));
}

double bond_kappa (const bond *b, size_t i, const point_bonds *s, size_t e, double *r)
{
    size_t j = (size_t) s->node[e];
    const double *c = b->modulus;
    return kappa_of (b, i, s, e,
                     b->stiff       ? b->stiff[i] + b->stiff[j]
                     : c[i] == c[j] ? c[i]
                                    : 2 * c[i] * c[j] / (c[i] + c[j]),
                     r);
}

void bond_pull (const bond *b, size_t i, const point_bonds *s, size_t e, double both, double *own,
                double *other)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    const double *xi = s->xi + e * dim;
    double kappa = kappa_of (b, i, s, e, both, NULL);
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++)
            own[a * m + c] += kappa * xi[a] * xi[c], other[a * m + c] -= kappa * xi[a] * xi[c];
}

void bond_beam (const bond *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    const double *xi = s->xi + e * (size_t) b->dim;
    pg_beam beam = pg_beam_between (&b->setting, i, (size_t) s->node[e], xi, s->weight[e]);
    pg_beam_blocks (b->dim, xi, &beam, b->beams.length, own, other);
}

void bond_blocks (const bond *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    size_t dim = (size_t) b->dim;
    const double *xi = s->xi + e * dim;
    double spare[36];
    if (b->shear) {
        bond_beam (b, i, s, e, own, other ? other : spare);
        if (b->stiff) bond_pull (b, i, s, e, b->stiff[i] + b->stiff[s->node[e]], own, other ? other : spare);
        return;
    }
    double kappa = bond_kappa (b, i, s, e, NULL);
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++) own[a * dim + c] = kappa * xi[a] * xi[c];
    for (size_t k = 0; other && k < dim * dim; k++) other[k] = -own[k];
}

/* ---- life ---------------------------------------------------------------------------------------------- */
void bond_free (void **self)
{
    bond *b = *self;
    if (!b) return;
    pg_bond_loop_free (&b->sweep), pg_bond_loop_free (&b->tangent);
    bond_energy_free (b), lps_free (b), lps_rows_free (b), gmpd_free (b);
    nodal_free (&b->nodal);
    pg_sparse_clear (&b->K);
    pg_nearest_free (&b->near);
    pg_free (b->modulus), pg_free (b->limit), pg_free (b->workspace), pg_free (b->work), pg_free (b->stale),
        pg_free (b->diagonal), pg_free (b->whole);
    pg_free (b);
    *self = NULL;
}

/* The stretch at which a bond of two points like this one breaks: the criterion's own answer for a bond of
 * unit stretch. */
static double limit_at (const pg_criterion *c, double ratio)
{
    double one = 1, factor = 0;
    pg_bond_measures m = { .n = 1, .dim = 1, .xi = &one, .eta = &one, .reach = &ratio };
    c->type->factor (c, &m, &factor);
    return factor;
}

static pg_status make_constants (bond *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    PG_TRY (lps_create (b));
    if (!b->dilation || rule->beams) PG_ALLOC (b->modulus, b->n);
    PG_TRY (gmpd_create (b));
    for (size_t i = 0; b->modulus && !b->shear && i < b->n; i++) {
        size_t block = (size_t) p->block[PG_NODES][i];
        double E = p->material[block].modulus;
        if (i > 0 && block == (size_t) p->block[PG_NODES][i - 1]) b->modulus[i] = b->modulus[i - 1];
        else
            b->modulus[i] = p->sums->calibration
                            * pg_bond_modulus (p->mode, rule->kernel, rule->horizon, E, p->cloud.thickness);
    }
    PG_TRY (bond_energy_create (b));
    if (!p->criterion->type || b->critical || b->limit) goto done;
    PG_ALLOC (b->limit, b->n);
    for (size_t i = 0; i < b->n; i++) {
        const pg_criterion *c = &p->criterion[p->block[PG_NODES][i]];
        b->limit[i] = c->never ? INFINITY : limit_at (c, pg_cloud_ratio (&p->cloud, i));
    }
done:
    return status;
}

static pg_status make_sweep (bond *b, pg_bond_loop **out, const pg_sums *sums, const double *limit)
{
    pg_bond_loop_setting s = { .sums = sums,
                               .family = b->family,
                               .modulus = b->modulus,
                               .dilation = b->dilation,
                               .deviation = b->deviation,
                               .counted = b->counted,
                               .limit = limit,
                               .exempt = b->problem->exempt[PG_NODES],
                               .beams = b->shear ? &b->beams : NULL,
                               .threads = b->threads };
    b->setting = s;
    return pg_bond_loop_create (out, &s);
}

pg_status bond_create (void **self, const pg_problem *problem)
{
    pg_status status = PG_OK;
    bond *b = NULL;
    *self = NULL;
    if (!problem->sums) PG_FAIL (PG_E_USAGE, "forces between points need a problem built for them");
    PG_ALLOC (b, 1);
    *self = b;
    b->problem = problem, b->dim = problem->dim, b->threads = problem->threads, b->n = problem->cloud.n;
    b->stride = pg_problem_unknowns (problem);
    b->family = &problem->rows[PG_NODES].family;
    b->all_stale = 1, b->revision = 1;
    b->op = (pg_operator) { ndof (b), b, bond_apply, bond_diagonal };
    for (size_t i = 0; i < b->n; i++) {
        size_t m = b->family->start[i + 1] - b->family->start[i];
        b->widest = m > b->widest ? m : b->widest;
    }
    PG_ALLOC (b->workspace, (size_t) b->threads * b->widest * (size_t) (b->dim + 2));
    PG_ALLOC (b->work, ndof (b));
    PG_ALLOC (b->stale, b->n);
    PG_TRY (make_constants (b));
    PG_TRY (make_sweep (b, &b->sweep, problem->sums, b->limit));
    PG_TRY (lps_weigh (b));
    PG_TRY (nodal_create (&b->nodal, problem, b->stride, b->beams.length, b->idle));
done:
    if (status != PG_OK) bond_free (self);
    return status;
}

pg_status bond_tangent_sweep (bond *b, pg_bond_loop **out)
{
    pg_status status = PG_OK;
    *out = b->sweep;
    if (!b->problem->sums->rule.finite) return PG_OK;
    if (!b->tangent) {
        b->small = *b->problem->sums;
        b->small.rule.finite = 0;
        PG_TRY (make_sweep (b, &b->tangent, &b->small, NULL));
        if (b->alive) pg_bond_loop_update (b->tangent, b->alive, NULL);
    }
    *out = b->tangent;
done:
    return status;
}

size_t bond_fields (const void *self, size_t max, pg_field *out)
{
    const bond *b = self;
    if (max > 0) out[0] = (pg_field) { "displacement", "m", b->dim };
    if (max > 1 && b->shear) out[1] = (pg_field) { "rotation", "m", b->stride - b->dim };
    return b->shear ? 2 : 1;
}

/* ---- breaking ------------------------------------------------------------------------------------------ */
static void mark_stale (bond *b, const pg_changes *changes)
{
    for (size_t c = 0; c < changes->n; c++) {
        int set;
        size_t point;
        pg_problem_locate (b->problem, changes->bond[c], &set, &point);
        b->stale[point] = b->stale[b->family->node[changes->bond[c]]] = 1;
    }
    b->revision += changes->n > 0;
}

pg_status bond_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    bond *b = self;
    b->alive = state->alive;
    pg_bond_loop_update (b->sweep, state->alive, changes);
    if (b->tangent) pg_bond_loop_update (b->tangent, state->alive, changes);
    if (changes) mark_stale (b, changes);
    else b->all_stale = 1, b->revision++, bond_tiles_forget (b);
    return PG_OK;
}

/* residual = f + P (t); f already there */
static void finish (bond *b, double t, double *residual, double *reference)
{
    double inside = 0;
    for (size_t i = 0; reference && i < ndof (b); i++) inside += residual[i] * residual[i];
    if (reference) *reference = fmax (sqrt (inside), nodal_size (&b->nodal, t));
    nodal_add (&b->nodal, t, residual);
}

pg_status bond_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    pg_status status = PG_OK;
    bond *b = self;
    PG_TRY (pg_bond_loop_force (b->sweep, d, residual, NULL));
    finish (b, t, residual, reference);
done:
    return status;
}

pg_status bond_march (void *self, double t, const double *d, double *residual, double *reference,
                      pg_changes *broken)
{
    pg_status status = PG_OK;
    bond *b = self;
    size_t before = broken->n;
    if (b->critical) PG_TRY (bond_energy_kill (b, d, broken));
    PG_TRY (pg_bond_loop_force (b->sweep, d, residual, b->limit ? broken : NULL));
    if (broken->n > before) {
        pg_changes fresh = { broken->n - before, 0, broken->bond + before };
        if (b->tangent) pg_bond_loop_update (b->tangent, b->alive, &fresh);
        mark_stale (b, &fresh);
    }
    finish (b, t, residual, reference);
done:
    return status;
}

pg_status bond_external (void *self, double t, double *P)
{
    bond *b = self;
    memset (P, 0, ndof (b) * sizeof *P);
    nodal_add (&b->nodal, t, P);
    return PG_OK;
}

pg_status bond_surface (void *self, const double *stress, double *P)
{
    const bond *b = self;
    return b->problem->nload ? nodal_surface (&b->nodal, 0, stress, P) : PG_OK;
}

/* ---- the rest ------------------------------------------------------------------------------------------ */
pg_status bond_mass (void *self, double *mass)
{
    const bond *b = self;
    const pg_problem *p = b->problem;
    for (size_t i = 0; i < b->n; i++) {
        double own = p->material[p->block[PG_NODES][i]].density * p->cloud.volume[i], across = 0;
        if (b->shear) across = pg_problem_spacing (p, PG_NODES, i) / b->beams.length;
        for (size_t k = 0; k < (size_t) b->stride; k++)  /* a cube of the spacing's size turns: theory G4 */
            mass[i * (size_t) b->stride + k] = k < (size_t) b->dim ? own : own * across * across / 6;
    }
    return PG_OK;
}

pg_status bond_work_balance (void *self, double t, const double *d, const double *inertia,
                             pg_work_balance *out)
{
    pg_status status = PG_OK;
    bond *b = self;
    PG_TRY (bond_balance (b, t, d, b->work, NULL));
    for (size_t i = 0; inertia && i < ndof (b); i++) b->work[i] += inertia[i];
    PG_TRY (nodal_work_balance (&b->nodal, t, d, b->work, out));
    out->strain = pg_bond_loop_energy (b->sweep, d);
done:
    return status;
}

unsigned long bond_revision (const void *self) { return ((const bond *) self)->revision; }
const pg_operator *bond_operator (void *self) { return &((bond *) self)->op; }
const pg_sparse *bond_basis (void *self) { return nodal_basis (&((bond *) self)->nodal); }

pg_status bond_impose (void *self, double t, double *d)
{
    nodal_impose (&((bond *) self)->nodal, t, d);
    return PG_OK;
}

/* ---- what it is before it exists ----------------------------------------------------------------------- */
/* E is kept; the tangent, wave speeds and the stress of a gradient are those of the material that the bonds
 * make. */
void bond_take_poisson (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
{
    double nu = pg_bond_poisson (p->mode);
    (void) scene, (void) rule;
    for (size_t m = 0; m < p->nmaterial && p->mode != PG_LINE; m++) {
        pg_material *a = &p->material[m];
        double E = a->modulus, asked = a->nu;
        if (fabs (asked - nu) > 0.005)
            pg_problem_note (p,
                             "warning: material %.40s: Poisson's ratio is %.4g, not %.4g: bonds alone leave "
                             "no choice (Young's modulus is kept)",
                             a->name, nu, asked);
        pg_elastic_set (a, E, nu);
    }
}

pg_status bond_read (pg_problem *p, const pg_scene *scene)
{
    return point_force_read (p, scene, bond_take_poisson);
}

const pg_force_type pg_force_bond = {
    .method = { .name = "bond",
                .summary = "bond-based peridynamics: pair forces between points, Poisson's ratio 1/3 in "
                           "plane stress, 1/4 in plane strain and 3D (Silling 2000)",
                .keys = { &point_force_keys },
                .shows = PG_NEEDS_STRETCH | PG_NEEDS_ENERGY,
                .rule = point_force_rule,
                .read = bond_read,
                .limits = point_force_limits,
                POINT_FORCE_METHOD },
    BOND_ENTRIES
};
