/* SPDX-License-Identifier: GPL-3.0-or-later
 * The displacement gradient for forces without shape functions: moving least squares (Lancaster and
 * Salkauskas 1981) through the displacements of the points visible from a position.
 *
 * From x are visible: the nearest point i that no crack separates from it (all, if several are equally near),
 * and neighbours of i with an intact bond to i that no crack separates from x; so the fit crosses neither
 * geometric cracks nor cracks of broken bonds. In z = (x_j - x) / R, R three local spacings, the polynomial
 * sum_a c_a p_a (z) with p = 1, z_k, z_k z_l minimises sum_j w_j (u_j - p (z_j) c)^2 with w = (1 - |z|^2)^2;
 * the gradient at x is c_k / R. The quadratic basis is exact for quadratic fields; with too few points (a
 * corner between crack faces) the linear one is used; if these lie on a line there is no gradient. */
#include "gradient_fit.h"
#include "held_points.h"
#include <math.h>
#include <string.h>

/* Terms of the quadratic basis in 3D, and the radius of the fit in local spacings: 28 points of a 2D lattice,
 * about 14 beside a crack, for the six terms in 2D. */
enum { MOST_TERMS = 10, MOST_FIELDS = 2 };
static const double reach = 3;
/* Relative pivot of the normal equations, by degree, below which the points do not determine a term. */
static const double flat[3] = { 0, 1e-4, 1e-6 };
/* Limit of the sum of |weights| of displacements in a gradient, times the local spacing (noise
 * amplification): 7.6 at the worst position within 0.9 spacings of a half plane or half space of a lattice,
 * 22 of a quarter. Above it, such as beside two rows of points that are not quite straight, the linear basis
 * is used. */
static const double loud = 25;

struct gradient_fit {
    const pg_problem *problem;
    const pg_state *state;
    pg_nearest *near;
    unsigned char *held;  /* per node: 1: constrained by bonds, 2: not, 0: not yet tested */
};

pg_status gradient_fit_create (gradient_fit **out, const pg_problem *problem, const pg_state *state)
{
    pg_status status = PG_OK;
    gradient_fit *fit = NULL;
    *out = NULL;
    PG_ALLOC (fit, 1);
    fit->problem = problem, fit->state = state;
    PG_TRY (pg_nearest_create (&fit->near, problem->dim, problem->cloud.n, problem->cloud.x));
    PG_ALLOC (fit->held, problem->cloud.n);
    *out = fit, fit = NULL;
done:
    gradient_fit_free (&fit);
    return status;
}

void gradient_fit_free (gradient_fit **fit)
{
    if (!*fit) return;
    pg_nearest_free (&(*fit)->near);
    pg_free ((*fit)->held);
    pg_free (*fit), *fit = NULL;
}

/* The cracks that may hide points. */
typedef struct { const pg_problem *problem; const pg_cracks *cracks; } view;

/* 1: a crack lies between the place and the point (pg_refuse). */
static int hidden (void *context, const double *place, size_t point)
{
    const view *v = context;
    const pg_problem *p = v->problem;
    return pg_cracks_cut (v->cracks, place, p->cloud.x + point * (size_t) p->dim, pg_cloud_same (&p->cloud))
           != NULL;
}

/* The basis at z: 1, z_k, then z_k z_l with k <= l; returns the number of terms up to the degree. */
static int basis (int dim, int degree, const double *z, double *term)
{
    int n = 0;
    term[n++] = 1;
    for (int k = 0; k < dim; k++) term[n++] = z[k];
    for (int k = 0; degree > 1 && k < dim; k++) for (int l = k; l < dim; l++) term[n++] = z[k] * z[l];
    return n;
}

/* Sums of one fit: the moments (terms x terms), and right-hand sides for each field and component. If `row`
 * (coefficients of the gradient) is set, |weights| of the gradient are summed instead. */
typedef struct {
    int terms, degree;
    const double *row;                                 /* dim x terms */
    double weights[3];
    double radius, moment[MOST_TERMS * MOST_TERMS], side[MOST_FIELDS * 3 * MOST_TERMS];
} sums;

static int is_held (const gradient_fit *fit, size_t j)
{
    if (!fit->held[j]) fit->held[j] = point_is_held (fit->problem, fit->state, j) ? 1 : 2;
    return fit->held[j] == 1;
}

/* Adds point j to the sums, unless it lies beyond the radius or is not constrained by bonds. */
static void add_point (const gradient_fit *fit, sums *s, const double *x, size_t j, size_t n,
                       const double *const *d)
{
    const pg_problem *p = fit->problem;
    size_t dim = (size_t) p->dim, stride = (size_t) pg_problem_unknowns (p), m = (size_t) s->terms;
    double z[3] = { 0 }, term[MOST_TERMS], rr = 0;
    for (size_t k = 0; k < dim; k++) {
        z[k] = (p->cloud.x[j * dim + k] - x[k]) / s->radius;
        rr += z[k] * z[k];
    }
    if (rr >= 1 || !is_held (fit, j)) return;
    double w = (1 - rr) * (1 - rr);
    basis (p->dim, s->degree, z, term);
    for (size_t k = 0; s->row && k < dim; k++) {
        double sum = 0;
        for (size_t a = 0; a < m; a++) sum += s->row[k * m + a] * term[a];
        s->weights[k] += fabs (w * sum);
    }
    if (s->row) return;
    for (size_t a = 0; a < m; a++)
        for (size_t b = 0; b < m; b++) s->moment[a * m + b] += w * term[a] * term[b];
    for (size_t f = 0; f < n; f++)
        for (size_t c = 0; c < dim; c++)
            for (size_t a = 0; a < m; a++)
                s->side[(f * dim + c) * m + a] += w * term[a] * d[f][j * stride + c];
}

/* A position x, and its nearest visible points, whose neighbours are used. */
typedef struct {
    const gradient_fit *fit;
    view v;
    const double *x;
    size_t n, from[PG_NEAREST_MOST];
} site;

/* Sums over all points visible from x. */
static void add_all (site *at, sums *s, size_t n, const double *const *d)
{
    const gradient_fit *fit = at->fit;
    const pg_problem *p = fit->problem;
    const pg_family *family = &p->bonds.rows[PG_NODES].family;
    const unsigned char *alive = fit->state->alive + p->bonds.first[PG_NODES];
    for (size_t k = 0; k < at->n; k++) {
        size_t i = at->from[k];
        add_point (fit, s, at->x, i, n, d);
        for (size_t e = family->start[i]; e < family->start[i + 1]; e++) {
            size_t j = (size_t) family->node[e];
            if (j == i || !alive[e] || (at->v.cracks->n && hidden (&at->v, at->x, j))) continue;
            add_point (fit, s, at->x, j, n, d);
        }
    }
}

/* Returns 1: the gradient of the (factored) fit amplifies noise too much (see loud). */
static int is_loud (site *at, sums *s)
{
    size_t dim = (size_t) at->fit->problem->dim, m = (size_t) s->terms;
    double row[3 * MOST_TERMS] = { 0 }, most = 0;
    for (size_t k = 0; k < dim; k++) {
        row[k * m + 1 + k] = 1;
        pg_dense_solve (s->terms, s->moment, row + k * m);
    }
    s->row = row, memset (s->weights, 0, sizeof s->weights);
    add_all (at, s, 0, NULL);
    s->row = NULL;
    for (size_t k = 0; k < dim; k++) most = fmax (most, s->weights[k]);
    return most > loud * reach;
}

/* Computes factored moments and right-hand sides for a degree; returns 0: the points do not determine its
 * terms. */
static int fit_degree (site *at, sums *s, int degree, size_t n, const double *const *d)
{
    double none[3] = { 0 }, term[MOST_TERMS], radius = s->radius;
    *s = (sums) { .degree = degree, .terms = basis (at->fit->problem->dim, degree, none, term),
                  .radius = radius };
    add_all (at, s, n, d);
    if (pg_dense_cholesky (s->terms, s->moment, flat[degree])) return 0;
    return degree == 1 || !is_loud (at, s);
}

/* Displacement, stress and gradient at n positions; without shape functions by the fit, stress from the
 * gradient and the material of the nearest point. */
pg_status gradient_sample (const pg_problem *p, const pg_force_type *force, void *self,
                           const pg_state *state, const double *d, size_t n, const double *x, double *u,
                           double *stress, double *gradient)
{
    pg_status status = PG_OK;
    gradient_fit *fit = NULL;
    if (force->method.shape_functions) return force->sample (self, state, d, n, x, u, stress, gradient);
    PG_TRY (gradient_fit_create (&fit, p, state));
    for (size_t k = 0; k < n; k++) {
        const double *place = x + k * (size_t) p->dim;
        double spare[9], *H = gradient ? gradient + 9 * k : spare;
        gradient_fit_at (fit, place, 1, &d, u + 3 * k, H);
        if (!stress) continue;
        size_t node = (size_t) pg_nearest_find (fit->near, place, NULL, NULL);
        pg_stress_of_gradient (pg_problem_law (p, PG_NODES, node), p->dim, H, stress + 6 * k);
    }
done:
    gradient_fit_free (&fit);
    return status;
}

/* Extracts displacement (3, m, or NULL) and gradient of field f from the fit; NAN if its degree is 0. */
static void take_field (sums *s, size_t f, size_t dim, double *u, double *gradient)
{
    double none = s->degree ? 0 : NAN;
    for (size_t c = 0; u && c < 3; c++) u[c] = none;
    for (size_t k = 0; !s->degree && k < 9; k++) gradient[k] = NAN;
    for (size_t c = 0; s->degree && c < dim; c++) {
        double *coefficient = s->side + (f * dim + c) * (size_t) s->terms;
        pg_dense_solve (s->terms, s->moment, coefficient);
        if (u) u[c] = coefficient[0];
        for (size_t k = 0; k < dim; k++) gradient[c * dim + k] = coefficient[1 + k] / s->radius;
    }
}

/* Tries the quadratic fit, then the linear one; returns the degree. */
int gradient_fit_at (const gradient_fit *fit, const double *x, size_t n, const double *const *d, double *u,
                     double *gradient)
{
    const pg_problem *p = fit->problem;
    site at = { .fit = fit, .v = { p, pg_state_cracks (p, fit->state) }, .x = x };
    double same = PG_NO_LENGTH * p->cloud.h;
    sums s = { .radius = 0 };
    int degree = 2;
    at.n = pg_nearest_seen (fit->near, x, same, at.v.cracks->n ? hidden : NULL, &at.v, at.from);
    for (size_t k = 0; k < at.n; k++)
        s.radius = fmax (s.radius, reach * pg_problem_spacing (p, PG_NODES, at.from[k]));
    while (degree > 0 && !fit_degree (&at, &s, degree, n, d)) degree--;
    s.degree = degree;
    for (size_t f = 0; f < n; f++)
        take_field (&s, f, (size_t) p->dim, u ? u + 3 * f : NULL, gradient + 9 * f);
    return degree;
}
