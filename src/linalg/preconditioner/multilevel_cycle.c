/* SPDX-License-Identifier: GPL-3.0-or-later
 * The symmetric V-cycle: smoothing, residual, restriction, correction by the next level, smoothing.
 *
 * The smoother is a Chebyshev polynomial of the fourth kind in D^-1 A, before and after the coarse
 * correction (Lottes 2023, Optimal polynomial smoothers for multigrid V-cycles, Numer. Linear Algebra Appl.
 * 30). It needs only an upper bound rho of the spectrum of D^-1 A, no lower one. Steps k = 1, 2, ... with
 * residual r:
 *
 *     d_k = (2k - 3) / (2k + 1) d_k-1 + (8k - 4) / ((2k + 1) rho) D^-1 r,    z += d_k,    r -= A d_k.
 *
 * The bound comes from the Lanczos matrix of a few steps of conjugate gradients. */
#include "multilevel.h"
#include "linalg/wide.h"
#include <math.h>
#include <string.h>

/* Steps of conjugate gradients for the Lanczos matrix. */
enum { LANCZOS = 10 };
/* Factor on the largest Ritz value after LANCZOS steps, which approaches the eigenvalue from below. */
static const double margin = 1.05;

/* ---- products and transfers ---------------------------------------------------------------------------- */
/* Arguments of a parallel loop: level, input x, output out, coefficients c1, c2 of the smoother. */
typedef struct { const level *l; const double *x, *y; double *out; double c1, c2; } smoothing;

/* y = A x for the rows first .. last - 1 of a matrix of 3 x 3 blocks. */
PG_WIDE static void multiply_solid (const level *l, const double *x, double *y, size_t first, size_t last)
{
    for (size_t i = first; i < last; i++) {
        four s0 = { 0 }, s1 = { 0 }, s2 = { 0 };
        const double *v = l->value + l->start[i] * 9;
        size_t e = l->start[i], end = l->start[i + 1];
        for (; e + 1 < end; e++, v += 9) {
            four d = *(const four *) (x + 3 * (size_t) l->node[e]);
            s0 += *(const four *) v * d, s1 += *(const four *) (v + 3) * d, s2 += *(const four *) (v + 6) * d;
        }
        double *to = y + 3 * i;
        to[0] = three_lanes (&s0), to[1] = three_lanes (&s1), to[2] = three_lanes (&s2);
        const double *d = x + (e < end ? 3 * (size_t) l->node[e] : 0);
        for (int a = 0; a < 3 && e < end; a++, v += 3) to[a] += v[0] * d[0] + v[1] * d[1] + v[2] * d[2];
    }
}

/* out = A x for the rows first .. last - 1, with unrolled products for 2 unknowns per node. */
static void multiply_rows (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    const level *l = w->l;
    size_t block = (size_t) l->block, bb = block * block;
    if (block == 3) {
        multiply_solid (l, w->x, w->out, first, last);
        return;
    }
    for (size_t i = first; i < last; i++) {
        double y[MOST_BLOCK] = { 0 };
        for (size_t e = l->start[i]; e < l->start[i + 1]; e++) {
            const double *v = l->value + e * bb, *x = w->x + (size_t) l->node[e] * block;
            if (block == 2) y[0] += v[0] * x[0] + v[1] * x[1], y[1] += v[2] * x[0] + v[3] * x[1];
            else
                for (size_t a = 0; a < block; a++)
                    for (size_t c = 0; c < block; c++) y[a] += v[a * block + c] * x[c];
        }
        memcpy (w->out + i * block, y, block * sizeof *y);
    }
}

/* The finest level has an operator, coarse ones have matrices. */
void level_multiply (const level *l, const double *x, double *y)
{
    if (l->A) {
        l->A->apply (l->A->context, x, y);
        return;
    }
    smoothing w = { .l = l, .x = x, .out = y };
    pg_parallel (l->threads, l->n, multiply_rows, &w);
}

/* out = P' x: each coarse function sums over its nodes, in their order. */
static void restrict_functions (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    const level *l = w->l;
    size_t block = (size_t) l->block;
    for (size_t f = first; f < last; f++) {
        double b[MOST_BLOCK] = { 0 };
        for (size_t p = l->coarse.at[f]; p < l->coarse.at[f + 1]; p++) {
            size_t i = (size_t) l->coarse.member[p];
            double share = l->coarse.share[p];
            for (size_t k = 0; k < block; k++)
                b[k] += share * (l->mask[i] >> k & 1 ? 0 : w->x[i * block + k]);
        }
        memcpy (w->out + f * block, b, block * sizeof *b);
    }
}

/* d = P x, out += d; zero at masked unknowns. */
static void correct_nodes (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    const level *l = w->l;
    size_t block = (size_t) l->block, corners = (size_t) l->corners;
    for (size_t i = first; i < last; i++) {
        double e[MOST_BLOCK] = { 0 };
        for (size_t c = 0; c < corners; c++) {
            int f = l->coarse.function[i * corners + c];
            double weight = l->coarse.weight[i * corners + c];
            if (f < 0) continue;
            for (size_t k = 0; k < block; k++) e[k] += weight * w->x[(size_t) f * block + k];
        }
        for (size_t k = 0; k < block; k++) {
            double v = l->mask[i] >> k & 1 ? 0 : e[k];
            l->d[i * block + k] = v, w->out[i * block + k] += v;
        }
    }
}

/* ---- smoothing ----------------------------------------------------------------------------------------- */
/* r = b, z = d = c2 D^-1 r: the first step from z = 0. */
static void first_step (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    const level *l = w->l;
    for (size_t i = first; i < last; i++) {
        l->r[i] = w->x[i];
        w->out[i] = l->d[i] = w->c2 * l->inverse[i] * w->x[i];
    }
}

/* r -= A d, then d = c1 d + c2 D^-1 r, z += d: one step of the Chebyshev recurrence. */
static void next_step (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    const level *l = w->l;
    double *restrict r = l->r, *restrict d = l->d, *restrict z = w->out;
    const double *restrict q = l->q, *restrict inverse = l->inverse;
    double c1 = w->c1, c2 = w->c2;
    for (size_t i = first; i < last; i++) {
        double rest = r[i] - q[i], move = c1 * d[i] + c2 * inverse[i] * rest;
        r[i] = rest, d[i] = move, z[i] += move;
    }
}

/* r -= q */
static void take_off (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const smoothing *w = context;
    for (size_t i = first; i < last; i++) w->l->r[i] -= w->l->q[i];
}

/* q = A d */
static pg_status multiply_change (const level *l)
{
    pg_status status = PG_OK;
    PG_TRY (level_exchange (l, l->d));
    level_multiply (l, l->d, l->q);
done:
    return status;
}

/* Smooths z by `degree` steps. b given: from z = 0. b NULL: a second smoothing, of a z whose last change d
 * has not been taken from the residual yet; its first step does that. */
static pg_status smooth (const level *l, int degree, const double *b, double *z)
{
    pg_status status = PG_OK;
    smoothing w = { .l = l, .x = b, .out = z };
    for (int k = 1; k <= degree; k++) {
        w.c1 = k > 1 ? (2 * k - 3) / (2.0 * k + 1) : 0;
        w.c2 = (8 * k - 4) / (2.0 * k + 1) / l->top;
        if (k > 1 || !b) PG_TRY (multiply_change (l));
        pg_parallel (l->threads, l->ndof, k > 1 || !b ? next_step : first_step, &w);
    }
done:
    return status;
}

/* The two smoothings are the same polynomial, hence the cycle is symmetric. */
pg_status multilevel_cycle (pg_multilevel *m, int k, const double *b, double *z)
{
    pg_status status = PG_OK;
    level *l = &m->at[k];
    /* One thread only: BLAS adds in another order on two, and the bits must not depend on their number. */
    if (k + 1 == m->count && m->factor) {
        int threads = pg_linear_threads (1);
        status = m->direct->solve (m->factor, 1, b, z);
        pg_linear_threads (threads);
        return status;
    }
    PG_TRY (smooth (l, m->degree, b, z));
    if (k + 1 == m->count && !m->shared) return PG_OK;
    level *c = l->part ? &m->meet : &m->at[k + 1];
    smoothing down = { .l = l, .x = l->r, .out = c->b }, up = { .l = l, .x = c->z, .out = z };
    /* Residual of the smoothed z: the effect of the last change d of z is still to be subtracted. */
    PG_TRY (multiply_change (l));
    pg_parallel (l->threads, l->ndof, take_off, &down);
    pg_subdomain_clear_ghosts (l->part, (size_t) l->block, l->r);
    pg_parallel (l->threads, c->n, restrict_functions, &down);
    PG_TRY (l->part ? multilevel_solve_together (m) : multilevel_cycle (m, k + 1, c->b, c->z));
    pg_parallel (l->threads, l->n, correct_nodes, &up);
    PG_TRY (smooth (l, m->degree, NULL, z));
done:
    return status;
}

/* ---- bound --------------------------------------------------------------------------------------------- */
/* a . b over the unknowns of all ranks that are not masked. */
static double dot (const level *l, const double *a, const double *b)
{
    double s = 0;
    for (size_t i = 0; i < l->ndof; i++)
        s += l->inverse[i] > 0 && pg_owns (l->part, i / (size_t) l->block) ? a[i] * b[i] : 0;
    return level_sum (l, s);
}

/* Number of eigenvalues above x of a symmetric tridiagonal matrix (Sturm sequence). */
static int above (int n, const double *diagonal, const double *off, double x)
{
    int count = 0;
    double q = 1;
    for (int i = 0; i < n; i++) {
        q = diagonal[i] - x - (i ? off[i - 1] * off[i - 1] / q : 0);
        if (q == 0) q = 1e-300;
        count += q > 0;
    }
    return count;
}

/* Largest eigenvalue of a symmetric tridiagonal matrix by bisection, from Gershgorin's bound. */
static double largest (int n, const double *diagonal, const double *off)
{
    double low = 0, high = 0;
    for (int i = 0; i < n; i++)
        high = fmax (high,
                     fabs (diagonal[i]) + (i ? fabs (off[i - 1]) : 0) + (i + 1 < n ? fabs (off[i]) : 0));
    for (int k = 0; k < 50; k++) {
        double middle = 0.5 * (low + high);
        if (above (n, diagonal, off, middle) > 0) low = middle;
        else high = middle;
    }
    return high;
}

/* Conjugate gradients on A x = b with a fixed pseudo-random b: their coefficients are the entries of the
 * Lanczos matrix of D^-1/2 A D^-1/2, whose eigenvalues are those of D^-1 A. The result does not depend on the
 * number of threads. */
pg_status level_bound (level *l)
{
    pg_status status = PG_OK;
    double diagonal[LANCZOS] = { 0 }, off[LANCZOS] = { 0 }, rz = 0, alpha = 1, *z = NULL;
    unsigned long seed = 12345;
    int n = 0;
    l->top = 1;
    PG_ALLOC (z, l->ndof);
    for (size_t i = 0; i < l->ndof; i++) {
        /* A linear congruential generator (Knuth's MMIX); scaled so that D^-1/2 b is uniform. */
        seed = seed * 6364136223846793005ul + 1442695040888963407ul;
        l->r[i] = l->inverse[i] > 0 ? ((double) (seed >> 33) / 2147483648.0 - 0.5) / sqrt (l->inverse[i]) : 0;
        z[i] = l->inverse[i] * l->r[i], l->d[i] = 0;
    }
    for (int k = 0; k < LANCZOS; k++) {
        double next = dot (l, l->r, z), turn = k ? next / rz : 0, before = alpha;
        if (!(next > 0)) break;
        for (size_t i = 0; i < l->ndof; i++) l->d[i] = z[i] + turn * l->d[i];
        PG_TRY (multiply_change (l));
        double dq = dot (l, l->d, l->q);
        if (!(dq > 0)) break;
        rz = next, alpha = next / dq;
        /* Entries of the Lanczos matrix from the coefficients alpha and beta of conjugate gradients (Saad
         * 2003, 6.7.3). */
        diagonal[k] = 1 / alpha + (k ? turn / before : 0);
        if (k) off[k - 1] = sqrt (turn) / before;
        n = k + 1;
        for (size_t i = 0; i < l->ndof; i++) {
            l->r[i] -= l->inverse[i] > 0 ? alpha * l->q[i] : 0;
            z[i] = l->inverse[i] * l->r[i];
        }
    }
    if (n > 0) l->top = margin * largest (n, diagonal, off);
done:
    pg_free (z);
    return status;
}
