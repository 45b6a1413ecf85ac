/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bond-based peridynamics: pair forces along bonds, each from the stretch of its own bond (Silling 2000;
 * Silling and Askari 2005; theory A). */
#include "pairwise.h"
#include <math.h>
#include <stdio.h>

/* ---- one bond ------------------------------------------------------------------------------------------ */
/* Points with different constants c have their harmonic mean, as two springs in series. */
double pairwise_kappa (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *r)
{
    size_t j = (size_t) s->node[e];
    const double *V = b->problem->cloud.volume, *xi = s->xi + e * (size_t) b->dim,
        *c = pairwise_of (b)->modulus;
    double rr = 0, both = c[i] == c[j] ? c[i] : 2 * c[i] * c[j] / (c[i] + c[j]);
    for (int k = 0; k < b->dim; k++) rr += xi[k] * xi[k];
    if (r) *r = sqrt (rr);
    return both * s->weight[e] * (V[i] * V[j]) / (rr * sqrt (rr));
}

/* Blocks of one bond, N/m: own = kappa xi x xi, other = -own. */
static void blocks (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    size_t dim = (size_t) b->dim;
    const double *xi = s->xi + e * dim;
    double kappa = pairwise_kappa (b, i, s, e, NULL);
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++) own[a * dim + c] = kappa * xi[a] * xi[c];
    for (size_t k = 0; other && k < dim * dim; k++) other[k] = -own[k];
}

/* Returns the shared kappa of all bonds of a point that has all bonds of the stencil; else NULL. Also NULL
 * with finite stretch, which needs the lengths that pairwise_kappa computes. */
static const double *known_kappas (const bond_force *b, const point_bonds *s)
{
    const pg_sums *sums = b->problem->sums;
    return s->m == sums->stencil.n && !sums->rule.finite ? pairwise_of (b)->kappa : NULL;
}

/* Force on i of one bond, N. */
static inline void pull_of (const bond_force *b, size_t i, const point_bonds *s, size_t e, const double *d,
                            double *f)
{
    size_t dim = (size_t) b->dim, j = (size_t) s->node[e];
    const double *xi = s->xi + e * dim;
    const double *known = known_kappas (b, s);
    double r, kappa = known ? known[e] : pairwise_kappa (b, i, s, e, &r), along = 0, length = 0;
    for (size_t a = 0; a < dim; a++) {
        double eta = d[j * dim + a] - d[i * dim + a];
        f[a] = xi[a] + eta, along += xi[a] * eta, length += f[a] * f[a];
    }
    if (!b->problem->sums->rule.finite) {
        for (size_t a = 0; a < dim; a++) f[a] = kappa * along * xi[a];
        return;
    }
    length = sqrt (length);
    for (size_t a = 0; a < dim; a++) f[a] *= length > 0 ? kappa * r * r * (length - r) / length : 0;
}

/* Virial stress of point i, Pa: T[a * dim + c] += 1/2 f_a xi_c / V_i over its intact bonds, f the force on
 * i. */
static void virial (const bond_force *b, size_t i, const point_bonds *s, const unsigned char *alive,
                    const double *d, double *T)
{
    size_t dim = (size_t) b->dim;
    double f[3], half = 0.5 / b->problem->cloud.volume[i];
    for (size_t e = 0; e < s->m; e++) {
        if (alive && !alive[s->first + e]) continue;
        pull_of (b, i, s, e, d, f);
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++) T[a * dim + c] += half * f[a] * s->xi[e * dim + c];
    }
}

/* ---- energy of a point --------------------------------------------------------------------------------- */
/* Sums half the energy of each intact bond over V_i: linear 1/4 kappa (xi . eta)^2, finite 1/4 kappa r^2 (|xi
 * + eta| - r)^2. */
double pairwise_energy_at (const bond_force *b, size_t i, int thread, const double *d)
{
    size_t dim = (size_t) b->dim;
    int finite = b->problem->sums->rule.finite;
    double sum = 0, r;
    point_bonds s;
    point_bonds_at (b, i, thread, &s);
    const double *known = known_kappas (b, &s);
    for (size_t e = 0; e < s.m; e++) {
        if (!bond_force_lives (b, s.first + e)) continue;
        const double *xi = s.xi + e * dim, *far = d + (size_t) s.node[e] * dim;
        double kappa = known ? known[e] : pairwise_kappa (b, i, &s, e, &r), along = 0, square = 0;
        for (size_t a = 0; a < dim; a++) {
            double eta = far[a] - d[i * dim + a];
            along += xi[a] * eta, square += eta * eta;
        }
        double grown = 2 * along + square,
               longer = finite ? r * grown / (sqrt (fmax (0, r * r + grown)) + r) : along;
        sum += kappa * (longer * longer);
    }
    return sum / (4 * b->problem->cloud.volume[i]);
}

/* ---- constants ----------------------------------------------------------------------------------------- */
/* Computes kappa once for all points with all bonds, if points are numbered as the sites of a lattice and
 * have the same modulus and volume to the bit, and if there is such a point. */
static pg_status find_kappa (bond_force *b)
{
    pg_status status = PG_OK;
    pairwise *own = (pairwise *) b;
    const pg_problem *p = b->problem;
    const pg_sums *sums = p->sums;
    size_t i = 0, n = sums->stencil.n;
    if (p->plain || !n || !sums->ordered || sums->family_volume) return PG_OK;
    for (size_t k = 1; k < b->n; k++)
        if (own->modulus[k] != own->modulus[0] || p->cloud.volume[k] != p->cloud.volume[0]) return PG_OK;
    while (i < b->n && b->family->start[i + 1] - b->family->start[i] != n) i++;
    if (i == b->n) return PG_OK;
    point_bonds s;
    point_bonds_at (b, i, 0, &s);
    PG_ALLOC (own->kappa, n);
    for (size_t e = 0; e < n; e++) own->kappa[e] = pairwise_kappa (b, i, &s, e, NULL);
done:
    return status;
}

/* Computes the constants c of all points; a point mostly has the material of the previous one. */
static pg_status create (bond_force *b)
{
    pg_status status = PG_OK;
    pairwise *own = (pairwise *) b;
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    PG_ALLOC (own->modulus, b->n);
    for (size_t i = 0; i < b->n; i++) {
        int law = p->at.law_of[PG_NODES][i];
        double E = p->at.law[law].modulus;
        if (i > 0 && law == p->at.law_of[PG_NODES][i - 1]) own->modulus[i] = own->modulus[i - 1];
        else
            own->modulus[i] = p->sums->calibration
                              * pg_bond_modulus (p->mode, rule->kernel, rule->horizon, E, p->cloud.thickness);
    }
    b->setting.modulus = own->modulus;
    PG_TRY (find_kappa (b));
done:
    return status;
}

/* Frees what `create` has made, and the tiles of the search for dying points. */
static void destroy (bond_force *b)
{
    pairwise *own = (pairwise *) b;
    pg_free (own->modulus), pg_free (own->kappa);
    pairwise_tiles_free (&own->tiles);
}

/* Has point k the modulus of point 0? */
static int alike (const bond_force *b, size_t k)
{
    return pairwise_of (b)->modulus[k] == pairwise_of (b)->modulus[0];
}

/* Writes the constant c of material m, and its calibration. */
static void words (const bond_force *b, size_t m, char *text, size_t size)
{
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    double c = pg_bond_modulus (p->mode, rule->kernel, rule->horizon, p->material[m].modulus,
                                p->cloud.thickness);
    int used = snprintf (text, size, "%s%s%sconstant %.6g N/m^6, Poisson's ratio %.4g",
                         p->nmaterial > 1 ? "material " : "", p->nmaterial > 1 ? p->material[m].name : "",
                         p->nmaterial > 1 ? ": " : "", c, pg_bond_poisson (p->mode));
    if (rule->calibrate && used > 0 && (size_t) used < size)
        snprintf (text + used, size - (size_t) used,
                  ", times %.6g for these points (calibrated: energy of hydrostatic strain)",
                  p->sums->calibration);
}

static const bond_theory theory = { .size = sizeof (pairwise),
                                     .create = create,
                                     .free = destroy,
                                     .blocks = blocks,
                                     .alike = alike,
                                     .virial = virial,
                                     .find_dying = pairwise_tiles_look,
                                     .forget = pairwise_tiles_forget,
                                     .words = words };

/* pg_force_type.create */
pg_status pairwise_create (void **self, const pg_problem *problem)
{
    return bond_force_make (self, problem, &theory);
}

/* ---- what is read from the scene ----------------------------------------------------------------------- */
/* Sets Poisson's ratio of all materials to the one that bonds have, with Young's modulus kept: tangent, wave
 * speeds and stresses from gradients are then those of the bonds. */
static void take_poisson (pg_problem *p, const pg_scene *scene, const pg_sum_rule *rule)
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

/* pg_method.read */
pg_status pairwise_read (pg_problem *p, const pg_scene *scene)
{
    return bond_force_read (p, scene, take_poisson);
}
