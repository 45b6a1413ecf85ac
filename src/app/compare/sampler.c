/* SPDX-License-Identifier: GPL-3.0-or-later
 * Samplers of our own results: the solution of a force by its shape functions, and
 * displacements that are known at points only, by moving least squares (RKPM with a linear
 * basis and the cubic spline kernel, radius of two spacings). The fit reproduces linear fields
 * exactly, so it adds an error of second order only, and its gradient gives the strain. */
#include "compare.h"
#include <math.h>
#include <string.h>

/* Points sampled at a time. */
enum { CHUNK = 2048 };                                 /* bounds the memory */

/* Frees a sampler; `free` is NULL for copies that do not own their context. */
void pg_sampler_clear (pg_sampler *sampler)
{
    if (sampler->free) sampler->free (sampler->context);
    memset (sampler, 0, sizeof *sampler);
}

/* The stress components that a result of this dimension has: xx; xx yy zz xy (plane strain and
 * stress); all. */
static int stress_bits (int dim) { return dim == 1 ? 1 : dim == 2 ? 1 | 2 | 4 | 8 : 63; }

/* ---- solution ------------------------------------------------------------------------------------------ */
/* Context of a sampler: a state, and its force, which has shape functions. */
typedef struct { const pg_force_type *force; void *self; const pg_state *state; } solution;

static pg_status sample_solution (void *context, size_t n, const double *x, double *u, double *stress)
{
    const solution *s = context;
    return s->force->sample (s->self, s->state, s->state->d, n, x, u, stress, NULL);
}

/* Makes a sampler for a force without shape functions: the fit through the displacements at the points.
 * Rotations and coefficients are not used. */
static pg_status least_squares (pg_sampler *out, const pg_problem *problem, const pg_force_type *force,
                                void *self, const pg_state *state)
{
    pg_status status = PG_OK;
    double *u = NULL;
    const char *unit;
    int components = 0;
    PG_ALLOC (u, 6 * problem->cloud.n);
    if (force->field) PG_TRY (force->field (self, state, state->d, "displacement", &components, &unit, u));
    if (components != problem->dim)
        PG_FAIL (PG_E_USAGE, "the force %s has no displacement field: nothing to compare",
                 force->method.name);
    PG_TRY (pg_sampler_points (out, problem, u, NULL));
done:
    pg_free (u);
    return status;
}

/* Makes a sampler of a solution. It copies neither state nor force, which must outlive it. */
pg_status pg_sampler_solution (pg_sampler *out, const pg_problem *problem, const pg_force_type *force,
                               void *self, const pg_state *state)
{
    pg_status status = PG_OK;
    solution *s = NULL;
    memset (out, 0, sizeof *out);
    if (!force->sample) return least_squares (out, problem, force, self, state);
    PG_ALLOC (s, 1);
    *s = (solution) { force, self, state };
    *out = (pg_sampler){
        s, problem->dim, (1 << problem->dim) - 1, stress_bits (problem->dim), sample_solution, pg_free
    };
done:
    return status;
}

/* ---- points -------------------------------------------------------------------------------------------- */
/* Displacements at points, and the approximation between them. */
typedef struct {
    const pg_problem *problem;
    /* Displacements, m (n x dim). */
    double *u;
    /* 1 for points that have lost bonds during the run (n), or NULL. */
    unsigned char *torn;
    pg_approx approx;
    /* Search for the nearest evaluation point, whose material counts; bond set of these points. */
    pg_nearest *material;
    int bulk;
} points;

/* 1 if a pre-crack lies between position x and a point, which then does not take part in the fit. */
static int cut (const pg_problem *p, const double *x, int node)
{
    return pg_cracks_cut (pg_state_cracks (p, NULL), x, p->cloud.x + (size_t) node * (size_t) p->dim,
                          pg_cloud_same (&p->cloud)) != NULL;
}

/* If a point with broken bonds (torn) is in the neighbourhood of place `at`, gives it the displacement of the
 * nearest point and no stress, and returns 1: a fit across an open crack would smear the jump, and its
 * gradient would be a false strain. */
static int at_tear (const points *s, const pg_rows *r, size_t at, double *u, double *stress)
{
    size_t dim = (size_t) s->problem->dim, nearest = 0;
    double best = INFINITY;
    int torn = 0;
    for (size_t e = r->family.start[at]; e < r->family.start[at + 1]; e++) {
        double d = 0, *x = s->problem->cloud.x + (size_t) r->family.node[e] * dim;
        for (size_t k = 0; k < dim; k++) d += (x[k] - r->x[at * dim + k]) * (x[k] - r->x[at * dim + k]);
        if (d < best) best = d, nearest = (size_t) r->family.node[e];
        torn |= s->torn[r->family.node[e]];
    }
    if (!torn) return 0;
    for (size_t c = 0; c < 3; c++) u[c] = c < dim ? s->u[nearest * dim + c] : 0;
    for (int k = 0; stress && k < 6; k++) stress[k] = NAN;
    return 1;
}

/* Displacement and stress at place `at` from its shape functions, H being the gradient of
 * displacement. Stress needs at least a complete linear basis (grade FULL or LOWERED): where
 * the neighbours do not allow that, it is unknown. */
static void fit_one (const points *s, const pg_rows *r, size_t at, double *u, double *stress)
{
    const pg_problem *p = s->problem;
    size_t dim = (size_t) p->dim;
    double H[9] = { 0 };
    if (s->torn && at_tear (s, r, at, u, stress)) return;
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
    pg_stress_of_gradient (pg_problem_law (p, s->bulk, q), p->dim, H, stress);
    if (r->grade[at] > PG_GRADE_LOWERED) for (int k = 0; k < 6; k++) stress[k] = NAN;
}

/* Builds families and shape functions of the places, chunk by chunk. Whether a pre-crack
 * separates a place from a neighbour is decided by the straight line between them. */
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
            for (size_t e = r.family.start[i]; e < r.family.start[i + 1]; e++)
                alive[e] = !cut (p, r.x + i * dim, r.family.node[e]);
        PG_TRY (s->approx.type->evaluate (&s->approx, &p->cloud, &r, alive, m, NULL, p->threads));
        for (size_t i = 0; i < m; i++)
            fit_one (s, &r, i, u + 3 * (first + i), stress ? stress + 6 * (first + i) : NULL);
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
    pg_free (s->u), pg_free (s->torn);
    pg_free (s);
}

/* Makes a sampler of displacements at points, which are copied, so that the caller may change the state. */
pg_status pg_sampler_points (pg_sampler *out, const pg_problem *problem, const double *u,
                             const unsigned char *torn)
{
    pg_status status = PG_OK;
    points *s = NULL;
    size_t ndof = problem->cloud.n * (size_t) problem->dim;
    memset (out, 0, sizeof *out);
    PG_ALLOC (s, 1);
    s->problem = problem, s->bulk = problem->form.integration->at_nodes ? PG_NODES : PG_POINTS;
    s->approx = (pg_approx){ .type = &pg_approx_rkpm,
                             .kernel = &pg_kernel_cubic_spline,
                             .order = 1,
                             .shape = PG_RADIAL,
                             .horizon = 2 * problem->cloud.h };
    PG_ALLOC (s->u, ndof);
    memcpy (s->u, u, ndof * sizeof *u);
    if (torn) {
        PG_ALLOC (s->torn, problem->cloud.n);
        memcpy (s->torn, torn, problem->cloud.n);
    }
    PG_TRY (pg_nearest_create (&s->material, problem->dim, problem->bonds.rows[s->bulk].n,
                               problem->bonds.rows[s->bulk].x));
    *out = (pg_sampler){
        s, problem->dim, (1 << problem->dim) - 1, stress_bits (problem->dim), sample_points, free_points
    };
    s = NULL;
done:
    free_points (s);
    return status;
}

/* ---- shifted and scaled fields ------------------------------------------------------------------------- */
/* Context of a sampler: a field that is shifted (m) and scaled. */
typedef struct { pg_sampler field; double shift[3], factor; } moved;

/* u_moved (x) = factor u (x - shift), and stress likewise. */
static pg_status sample_moved (void *context, size_t n, const double *x, double *u, double *stress)
{
    pg_status status = PG_OK;
    const moved *m = context;
    size_t dim = (size_t) m->field.dim;
    double *at = NULL;
    PG_ALLOC (at, n * dim);
    for (size_t i = 0; i < n * dim; i++) at[i] = x[i] - m->shift[i % dim];
    PG_TRY (m->field.sample (m->field.context, n, at, u, stress));
    for (size_t i = 0; i < 3 * n; i++) u[i] *= m->factor;
    for (size_t i = 0; stress && i < 6 * n; i++) stress[i] *= m->factor;
done:
    pg_free (at);
    return status;
}

static void free_moved (void *context)
{
    moved *m = context;
    pg_sampler_clear (&m->field);
    pg_free (m);
}

/* Makes a sampler of a shifted and scaled field; the given sampler becomes part of it and is freed with
 * it. */
pg_status pg_sampler_moved (pg_sampler *out, pg_sampler *sampler, const double *shift, double factor)
{
    pg_status status = PG_OK;
    moved *m = NULL;
    PG_ALLOC (m, 1);
    *m = (moved) { *sampler, { shift[0], shift[1], shift[2] }, factor };
    memset (sampler, 0, sizeof *sampler);
    *out = (pg_sampler) { m, m->field.dim, m->field.displacement, m->field.stress, sample_moved, free_moved };
done:
    return status;
}
