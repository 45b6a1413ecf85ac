/* SPDX-License-Identifier: GPL-3.0-or-later
 * Measures the blocks K_0j of a lattice: the middle point of a box is displaced by one unit of one unknown c
 * at a time, and the force model gives the forces on all points (the response). That response is column c of
 * K_j0; the block K_0j is its transpose.
 *
 * The box grows until the response no longer reaches its surface. Then the blocks are checked: opposite ones
 * must be transposes of each other, and a rigid translation must cause no force, each to 1e-9. Where this
 * fails the middle of the box does not behave as the interior of a lattice. */
#include "symbol.h"
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Largest number of boxes that are tried. */
enum { TRIES = 6 };
/* Largest number of neighbour pairs, weighted by the memory that they take. */
static const double most_pairs = 2e8;  /* 1.4 GB */
/* Relative to the largest response: values up to 1e-12 do not enlarge the box, and those up to 1e-14 are
 * dropped as rounding (Fourier transforms leave such values far away, too). */
static const double little = 1e-12, nothing = 1e-14;

/* A box with its problem, state and force. */
typedef struct {
    pg_scene *scene;  pg_problem *problem;  pg_state *state;
    const pg_force_type *force;  void *self;
    /* The point at the origin. */
    size_t middle;
    int    m;
    /* Response to unit values of each unknown c of the middle point: ndof x m, column by column, N/m. */
    double *answer;
} box;

/* Frees a box, even if it was never built. */
static void clear (box *b)
{
    if (b->self) b->force->free (&b->self);
    pg_state_free (&b->state);
    pg_problem_free (&b->problem);
    pg_scene_free (&b->scene);
    pg_free (b->answer);
    memset (b, 0, sizeof *b);
}

/* The point nearest to the origin. */
static size_t middle_of (const pg_cloud *c)
{
    size_t best = 0, dim = (size_t) c->dim;
    double least = INFINITY;
    for (size_t i = 0; i < c->n; i++) {
        double r = 0;
        for (size_t k = 0; k < dim; k++) r += c->x[i * dim + k] * c->x[i * dim + k];
        if (r < least) least = r, best = i;
    }
    return best;
}

/* y = K x, by the operator of the force or, if it has none, by its assembled matrix. */
static pg_status multiply (box *b, const double *x, double *y)
{
    pg_status status = PG_OK;
    const pg_sparse *assembled;
    const pg_operator *K = b->force->operator_ ? b->force->operator_ (b->self) : NULL;
    if (K) {
        K->apply (K->context, x, y);
        return PG_OK;
    }
    PG_TRY (pg_force_assemble (b->force, b->self, &assembled));
    pg_sparse_multiply (assembled, x, y);
done:
    return status;
}

/* Builds the box and measures the response. The number of pairs is estimated before anything is allocated;
 * Gauss points take about ten times as much memory for each pair and point. */
static pg_status build (box *b, const pg_scene *scene, const pg_problem *p, const box_size *size)
{
    pg_status status = PG_OK;
    pg_field field[4];
    double points = 1, family = 1, *x = NULL;
    for (int k = 0; k < p->dim; k++)
        points *= 2 * size->half[k] + 1, family *= 1.7 * p->form.approx.horizon / size->step[k];
    double pairs = points * family
                   * (p->sums ? 1 : 10 * fmax (1, (double) p->bonds.rows[PG_POINTS].n / (double) p->cloud.n));
    if (pairs > most_pairs)
        PG_FAIL (PG_E_LIMIT,
                 "the waves of this lattice need a box of %.0f points with about %.0f neighbours each, as "
                 "its horizon is %.3g spacings: that is too "
                 "large; take a smaller horizon, or fewer Gauss points",
                 points, family, p->form.approx.horizon / size->h);
    PG_TRY (box_fits (size, p->dim));
    PG_TRY (box_scene (&b->scene, scene, p, size));
    PG_TRY (pg_problem_build (&b->problem, b->scene, p->threads));
    b->force = pg_force_of (b->problem);
    PG_TRY (b->force->create (&b->self, b->problem));
    size_t n = b->force->fields (b->self, sizeof field / sizeof *field, field);
    for (size_t f = 0; f < n; f++) b->m += field[f].components;
    PG_TRY (pg_state_create (&b->state, b->problem, b->m));
    PG_TRY (b->force->refresh (b->self, b->state, NULL));
    b->middle = middle_of (&b->problem->cloud);
    size_t ndof = b->problem->cloud.n * (size_t) b->m;
    PG_ALLOC (b->answer, ndof * (size_t) b->m);
    PG_ALLOC (x, ndof);
    for (size_t c = 0; c < (size_t) b->m; c++) {
        x[b->middle * (size_t) b->m + c] = 1;
        PG_TRY (multiply (b, x, b->answer + c * ndof));
        x[b->middle * (size_t) b->m + c] = 0;
    }
done:
    pg_free (x);
    return status;
}

/* Force on unknown r of point j for a unit of unknown c of the middle point. */
static double answer_at (const box *b, size_t j, int r, int c)
{
    return b->answer[((size_t) c * b->problem->cloud.n + j) * (size_t) b->m + (size_t) r];
}

/* Offset of point j from the middle in steps. */
static void offset_of (const box *b, const box_size *size, size_t j, int *offset)
{
    size_t dim = (size_t) b->problem->dim;
    for (size_t k = 0; k < 3; k++)
        offset[k] = k < dim ? (int) lround (b->problem->cloud.x[j * dim + k] / size->step[k]) : 0;
}

/* 1 if the response ends at least two points inside the surface of the box. With a surface correction the
 * weights of bonds depend on whether the families of their ends are complete, so one horizon more is needed.
 * Otherwise sets size->half to what is needed. */
static int large_enough (const box *b, box_size *size)
{
    int reach[3] = { 0 }, offset[3], enough = 1, dim = b->problem->dim, m = b->m,
        weighed = b->problem->sums && b->problem->sums->rule.surface != PG_SURFACE_NONE;
    double largest = 0;
    for (size_t k = 0; k < b->problem->cloud.n * (size_t) (m * m); k++)
        largest = fmax (largest, fabs (b->answer[k]));
    for (size_t j = 0; j < b->problem->cloud.n; j++) {
        double most = 0;
        for (int e = 0; e < m * m; e++) most = fmax (most, fabs (answer_at (b, j, e / m, e % m)));
        if (most <= little * largest) continue;
        offset_of (b, size, j, offset);
        for (int k = 0; k < dim; k++) if (abs (offset[k]) > reach[k]) reach[k] = abs (offset[k]);
    }
    for (int k = 0; k < dim; k++) {
        int need = reach[k] + 2
                   + (weighed ? (int) ceil (b->problem->form.approx.horizon / size->step[k]) : 0);
        if (need > size->half[k]) size->half[k] = need, enough = 0;
    }
    return enough;
}

/* ---- results of the measurement ------------------------------------------------------------------------ */
/* Stores the blocks that exceed rounding, and for shape functions the row of the mass matrix of the middle
 * point, divided by its mass: int N_0 N_j dV / V. */
static pg_status collect (pg_symbol *s, const box *b, const box_size *size)
{
    pg_status status = PG_OK;
    size_t m = (size_t) s->unknowns, n = b->problem->cloud.n;
    const pg_sparse *mass = NULL;
    double *x = NULL, largest = 0;
    for (size_t k = 0; k < n * m * m; k++) largest = fmax (largest, fabs (b->answer[k]));
    PG_TRY (b->force->mass (b->self, NULL, &mass));
    if (mass) {
        PG_ALLOC (s->spread, n);
        PG_ALLOC (x, 2 * n);
        x[b->middle] = 1 / (s->material.density * s->volume);
        pg_sparse_multiply (mass, x, x + n);
    }
    PG_ALLOC (s->offset, 3 * n);
    PG_ALLOC (s->block, n * m * m);
    for (size_t j = 0; j < n; j++) {
        double *K = s->block + s->n * m * m, most = 0;
        for (size_t e = 0; e < m * m; e++) {           /* K_0j is K_j0 transposed */
            K[e] = answer_at (b, j, (int) (e % m), (int) (e / m));
            most = fmax (most, fabs (K[e]));
        }
        if (most <= nothing * largest) {
            memset (K, 0, m * m * sizeof *K);
            continue;
        }
        offset_of (b, size, j, s->offset + 3 * s->n);
        if (mass) s->spread[s->n] = x[n + j];
        s->n++;
    }
done:
    pg_free (x);
    return status;
}

/* Checks symmetry and rigid translation (head of the file), and finds the unknowns without stiffness. In the
 * list of all positions of the box the opposite of position p is all - 1 - p. */
static pg_status verify (pg_symbol *s, const box_size *size)
{
    pg_status status = PG_OK;
    size_t m = (size_t) s->unknowns, mm = m * m, wide[3] = { 1, 1, 1 }, all, *at = NULL;
    double largest = 0, difference = 0, sum[PG_UNKNOWNS * PG_UNKNOWNS] = { 0 }, drift = 0;
    for (int k = 0; k < s->dim; k++) wide[k] = (size_t) (2 * size->half[k] + 1);
    all = wide[0] * wide[1] * wide[2];
    PG_ALLOC (at, all);
    for (size_t j = 0, place; j < s->n; j++) {
        place = 0;
        for (int k = 2; k >= 0; k--)
            place = place * wide[k]
                    + (size_t) (s->offset[3 * j + (size_t) k] + (k < s->dim ? size->half[k] : 0));
        at[place] = j + 1;
    }
    for (size_t p = 0; p < all; p++)                   /* the opposite of position p is all - 1 - p */
        for (size_t e = 0; at[p] && e < mm; e++) {
            double K = s->block[(at[p] - 1) * mm + e],
                   other = at[all - 1 - p] ? s->block[(at[all - 1 - p] - 1) * mm + e % m * m + e / m] : 0;
            largest = fmax (largest, fabs (K)), difference = fmax (difference, fabs (K - other)), sum[e] += K;
        }
    for (size_t e = 0; e < mm; e++) if (e % m < (size_t) s->dim) drift = fmax (drift, fabs (sum[e]));
    s->size = largest, s->lopsided = largest > 0 ? difference / largest : 0;
    if (!(largest > 0)) PG_FAIL (PG_E_USAGE, "nothing resists the points of this lattice");
    if (!(s->lopsided < 1e-9) || !(drift < 1e-9 * largest))
        PG_FAIL (PG_E_USAGE,
                 "the points in the middle of a box answer each other unlike those of a lattice (by %.1e; to "
                 "a translation by %.1e)",
                 s->lopsided, drift / largest);
    for (size_t r = 0; r < m; r++) {
        double most = 0;
        for (size_t j = 0; j < s->n; j++)
            for (size_t c = 0; c < m; c++) most = fmax (most, fabs (s->block[j * mm + r * m + c]));
        s->held[r] = most <= nothing * largest;
    }
done:
    pg_free (at);
    return status;
}

/* Computes the lumped masses of the middle point, and the bound of the largest frequency that explicit
 * solvers use. */
static pg_status weigh (pg_symbol *s, box *b)
{
    pg_status status = PG_OK;
    size_t m = (size_t) s->unknowns, ndof = b->problem->cloud.n * m;
    double *mass = NULL, *workspace = NULL;
    PG_ALLOC (mass, ndof);
    PG_ALLOC (workspace, ndof);
    PG_TRY (b->force->mass (b->self, mass, NULL));
    for (size_t c = 0; c < m; c++) s->mass[c] = mass[b->middle * m + c];
    PG_TRY (pg_force_bound (b->force, b->self, &b->problem->cloud, ndof, mass, workspace, &s->bound,
                            &s->from));
done:
    pg_free (mass), pg_free (workspace);
    return status;
}

/* Measures the symbol of a lattice. The first box extends two horizons and two points on each side, since
 * shape functions couple points at twice the horizon. */
pg_status pg_symbol_create (pg_symbol **out, const pg_scene *scene, const pg_problem *p)
{
    pg_status status = PG_OK;
    pg_symbol *s = NULL;
    box b = { 0 };
    box_size size = { .odd = 0 };
    int whole = 0;
    *out = NULL;
    PG_TRY (box_steps (&size, scene, p));
    for (int k = 0; k < p->dim; k++)
        size.half[k] = 2 * (int) ceil (p->form.approx.horizon / size.step[k] - 1e-6) + 2;
    for (int t = 0; t < TRIES && !whole; t++) {
        clear (&b);
        PG_TRY (build (&b, scene, p, &size));
        whole = large_enough (&b, &size);
    }
    if (!whole) PG_FAIL (PG_E_USAGE, "a point of this lattice is coupled to all others, however far");
    PG_ALLOC (s, 1);
    s->dim = p->dim, s->unknowns = b.m, s->threads = p->threads, s->points = b.problem->cloud.n,
    s->h = size.h;
    memcpy (s->step, size.step, sizeof s->step);
    s->material = b.problem->material[0];
    memcpy (s->material.name, p->material[0].name, sizeof s->material.name);
    s->dense = p->material[0].density > 0;
    s->volume = b.problem->cloud.volume[b.middle];
    PG_TRY (collect (s, &b, &size));
    PG_TRY (verify (s, &size));
    PG_TRY (weigh (s, &b));
    *out = s, s = NULL;
done:
    clear (&b);
    pg_symbol_free (&s);
    return status;
}

void pg_symbol_free (pg_symbol **symbol)
{
    if (!*symbol) return;
    pg_free ((*symbol)->offset), pg_free ((*symbol)->block), pg_free ((*symbol)->spread);
    pg_free (*symbol);
    *symbol = NULL;
}
