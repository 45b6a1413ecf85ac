/* SPDX-License-Identifier: GPL-3.0-or-later
 * Samplers: the solution of a force by its own shape functions, and displacements at points by least squares. */
#include "perigal/compare.h"
#include <math.h>
#include <string.h>

enum { CHUNK = 2048 };                                 /* places at a time: bounds the memory                            */

void pg_sampler_clear (pg_sampler *sampler)
{
    if (sampler->free) sampler->free (sampler->context);
    memset (sampler, 0, sizeof *sampler);
}

static int stress_bits (int dim) { return dim == 1 ? 1 : dim == 2 ? 1 | 2 | 4 | 8 : 63; }

/* ---- solution --------------------------------------------------------------------------------------------------------- */
typedef struct { const pg_force_type *force; void *self; const pg_state *state; } solution;

static pg_status sample_solution (void *context, size_t n, const double *x, double *u, double *stress)
{
    const solution *s = context;
    return s->force->sample (s->self, s->state, s->state->d, n, x, u, stress);
}

static pg_status least_squares (pg_sampler *out, const pg_problem *problem, const pg_force_type *force, void *self, const pg_state *state)
{
    pg_status status = PG_OK;
    double *u = NULL;
    const char *unit;
    int components = 0;
    PG_ALLOC (u, 6 * problem->cloud.n);
    if (force->field) PG_TRY (force->field (self, state, state->d, "displacement", &components, &unit, u));
    if (components != problem->dim) PG_FAIL (PG_E_USAGE, "the force %s has no displacement field: nothing to compare", force->name);
    PG_TRY (pg_sampler_points (out, problem, u));
done:
    pg_free (u);
    return status;
}

pg_status pg_sampler_solution (pg_sampler *out, const pg_problem *problem, const pg_force_type *force, void *self, const pg_state *state)
{
    pg_status status = PG_OK;
    solution *s = NULL;
    memset (out, 0, sizeof *out);
    if (!force->sample) return least_squares (out, problem, force, self, state);
    PG_ALLOC (s, 1);
    *s = (solution) { force, self, state };
    *out = (pg_sampler) { s, problem->dim, (1 << problem->dim) - 1, stress_bits (problem->dim), sample_solution, pg_free };
done:
    return status;
}

/* ---- points ----------------------------------------------------------------------------------------------------------- */
typedef struct { const pg_problem *problem; double *u; pg_approx approx; pg_nearest *material; int bulk; } points;

static int cut (const pg_problem *p, const double *x, int node)
{
    for (size_t c = 0; c < p->cracks.n; c++)
        if (pg_crack_cuts (&p->cracks.crack[c], p->dim, x, p->cloud.x + (size_t) node * (size_t) p->dim, 1e-9 * p->cloud.h)) return 1;
    return 0;
}

static void fit_one (const points *s, const pg_rows *r, size_t at, double *u, double *stress)
{
    const pg_problem *p = s->problem;
    size_t dim = (size_t) p->dim;
    double H[9] = { 0 };
    memset (u, 0, 3 * sizeof *u);
    for (size_t e = r->family.start[at]; e < r->family.start[at + 1]; e++)
        for (size_t c = 0; c < dim; c++) {
            double v = s->u[(size_t) r->family.node[e] * dim + c];
            u[c] += r->N[e] * v;
            for (size_t k = 0; k < dim; k++) H[c*dim + k] += r->dN[e*dim + k] * v;
        }
    if (r->grade[at] == PG_GRADE_DEAD) for (size_t c = 0; c < dim; c++) u[c] = NAN;
    if (!stress) return;
    size_t q = (size_t) pg_nearest_find (s->material, r->x + at * dim, NULL, NULL);
    pg_stress_of_gradient (&p->material[p->block[s->bulk][q]], p->dim, H, stress);
    if (r->grade[at] > PG_GRADE_LOWERED) for (int k = 0; k < 6; k++) stress[k] = NAN;
}

static pg_status sample_points (void *context, size_t n, const double *x, double *u, double *stress)
{
    pg_status status = PG_OK;
    const points *s = context;
    const pg_problem *p = s->problem;
    size_t dim = (size_t) p->dim;
    pg_rows r = { 0 };
    unsigned char *alive = NULL;
    for (size_t first = 0; first < n; first += CHUNK) {
        size_t m = n - first < CHUNK ? n - first : CHUNK;
        PG_TRY (pg_rows_create (&r, &s->approx, &p->cloud, m, x + first * dim, NULL, NULL, NULL));
        PG_ALLOC (alive, r.family.start[m]);
        for (size_t i = 0; i < m; i++)
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++) alive[e] = !cut (p, r.x + i * dim, r.family.node[e]);
        PG_TRY (s->approx.type->evaluate (&s->approx, &p->cloud, &r, alive, m, NULL, p->threads));
        for (size_t i = 0; i < m; i++) fit_one (s, &r, i, u + 3 * (first + i), stress ? stress + 6 * (first + i) : NULL);
        pg_free (alive), alive = NULL;
        pg_rows_clear (&r);
    }
done:
    pg_free (alive);
    pg_rows_clear (&r);
    return status;
}

static void free_points (void *context)
{
    points *s = context;
    if (!s) return;
    pg_nearest_free (&s->material);
    pg_free (s->u);
    pg_free (s);
}

pg_status pg_sampler_points (pg_sampler *out, const pg_problem *problem, const double *u)
{
    pg_status status = PG_OK;
    points *s = NULL;
    size_t ndof = problem->cloud.n * (size_t) problem->dim;
    memset (out, 0, sizeof *out);
    PG_ALLOC (s, 1);
    s->problem = problem, s->bulk = problem->integration->at_nodes ? PG_NODES : PG_POINTS;
    s->approx = (pg_approx) { .type = pg_approx_find ("rkpm"), .kernel = pg_kernel_find ("cubic_spline"), .order = 1, .shape = PG_RADIAL,
                              .horizon = 2 * problem->cloud.h };
    PG_ALLOC (s->u, ndof);
    memcpy (s->u, u, ndof * sizeof *u);
    PG_TRY (pg_nearest_create (&s->material, problem->dim, problem->rows[s->bulk].n, problem->rows[s->bulk].x));
    *out = (pg_sampler) { s, problem->dim, (1 << problem->dim) - 1, stress_bits (problem->dim), sample_points, free_points };
    s = NULL;
done:
    free_points (s);
    return status;
}
