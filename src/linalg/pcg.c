/* SPDX-License-Identifier: GPL-3.0-or-later
 * Preconditioned conjugate gradients (Hestenes and Stiefel 1952) on any operator, and as an entry of the
 * catalogue with the diagonal as preconditioner. In each iteration
 *
 *     z = P^-1 r,   beta = r.z / (r.z)_before,   p = z + beta p,   alpha = r.z / p.A p,   x += alpha p,
 *     r -= alpha A p.
 *
 * Where b is zero but for a few unknowns and A couples neighbours only, r and p are small elsewhere too:
 * within a few neighbours their entries fall below what the tolerance permits. If the caller asks for it
 * (pg_cg_watch.local), such entries of p are set to zero (local_direction), and alpha = r.p / p.A p is the
 * best step along what remains: r stays b - A x whatever is left out, and the iterations end by its norm.
 *
 * Every sum over the unknowns is taken in chunks of fixed length, each chunk in four partial sums, and the
 * chunks are added in their order: the result has the same bits for any number of threads and any width of
 * the vector registers. Where ranks share the operator, their sums are added (pg_ranks_sum). */
#include "perigal/linalg.h"
#include "perigal/ranks.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Unknowns in a chunk. */
enum { CHUNK = 4096 };

/* Vectors of an iteration (n each): residual r, preconditioned residual z, direction p, q = A p, inverse
 * diagonal d, solution x; sums of the chunks (nchunk); step length alpha and turn = beta of the new
 * direction; least: entries of r below it are left out of local directions (0: none is); a, b: arguments of a
 * dot product. */
typedef struct {
    size_t n, nchunk;
    int threads, shared;
    pg_status lost;                                    /* error of a sum over ranks, PG_OK: none so far */
    double *r, *z, *p, *q, *d, *x, *sum, alpha, turn, least;
    const double *a, *b;
} vectors;

/* Returns the unknown behind the last one of a chunk. */
static size_t chunk_end (const vectors *v, size_t chunk)
{
    return (chunk + 1) * CHUNK < v->n ? (chunk + 1) * CHUNK : v->n;
}

/* Runs `work` on all chunks and adds their sums. Below 16 chunks threads cost more than they save. */
static double total (vectors *v, pg_work work)
{
    double s = 0;
    pg_parallel_heavy (v->n > 16 * CHUNK ? v->threads : 1, v->nchunk, work, v);
    for (size_t k = 0; k < v->nchunk; k++) s += v->sum[k];
    if (v->shared && v->lost == PG_OK) v->lost = pg_ranks_sum (1, &s);
    return s;
}

/* Sums of a . b over chunks first .. last - 1. */
static void dot_chunks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const vectors *v = context;
    for (size_t c = first; c < last; c++) {
        double s[4] = { 0 };
        size_t i = c * CHUNK, end = chunk_end (v, c);
        for (; i + 4 <= end; i += 4)
            for (int k = 0; k < 4; k++) s[k] += v->a[i + (size_t) k] * v->b[i + (size_t) k];
        for (; i < end; i++) s[0] += v->a[i] * v->b[i];
        v->sum[c] = (s[0] + s[1]) + (s[2] + s[3]);
    }
}

/* a . b */
static double dot (vectors *v, const double *a, const double *b)
{
    v->a = a, v->b = b;
    return total (v, dot_chunks);
}

/* p = z + turn p */
static void turn_chunks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const vectors *v = context;
    for (size_t i = first * CHUNK; i < chunk_end (v, last - 1); i++) v->p[i] = v->z[i] + v->turn * v->p[i];
}

/* x += alpha p, r -= alpha q, and sums of r . r, in one pass over memory. */
static void step_chunks (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const vectors *v = context;
    const double *restrict p = v->p, *restrict q = v->q;
    double *restrict x = v->x, *restrict r = v->r, alpha = v->alpha;
    for (size_t c = first; c < last; c++) {
        double s[4] = { 0 };
        size_t i = c * CHUNK, end = chunk_end (v, c);
        for (; i + 4 <= end; i += 4)
            for (size_t k = i; k < i + 4; k++) {
                x[k] += alpha * p[k], r[k] -= alpha * q[k];
                s[k - i] += r[k] * r[k];
            }
        for (; i < end; i++) {
            x[i] += alpha * p[i], r[i] -= alpha * q[i];
            s[0] += r[i] * r[i];
        }
        v->sum[c] = (s[0] + s[1]) + (s[2] + s[3]);
    }
}

/* z = P^-1 r, or the inverse diagonal times r. */
static pg_status precondition (const pg_preconditioner *P, const vectors *v)
{
    if (P) return P->solve (P->context, v->r, v->z);
    for (size_t i = 0; i < v->n; i++) v->z[i] = v->d[i] * v->r[i];
    return PG_OK;
}

/* r = b - A x; saves the product if the first guess is zero (on all ranks that share A). */
static void first_residual (const pg_operator *A, const double *b, vectors *v)
{
    size_t n = A->n, zero = 1;
    for (size_t i = 0; i < n && zero; i++) zero = v->x[i] == 0;
    double any = !zero;
    if (v->shared) v->lost = pg_ranks_most (1, &any);
    zero = any == 0;
    if (zero) memcpy (v->r, b, n * sizeof *b);
    else A->apply (A->context, v->x, v->q);
    for (size_t i = 0; i < n && !zero; i++) v->r[i] = b[i] - v->q[i];
}

/* Places the vectors in `room`, which callers keep from solve to solve: the system clears fresh memory, which
 * takes a noticeable share of short solves. d is 1 in rows without a positive diagonal. */
static pg_status make_vectors (vectors *v, pg_cg_room *room, const pg_operator *A, const pg_preconditioner *P,
                               double *x)
{
    pg_status status = PG_OK;
    size_t n = A->n;
    v->n = n, v->nchunk = (n + CHUNK - 1) / CHUNK, v->threads = P ? P->threads : 1, v->x = x;
    size_t need = (P ? 4 : 5) * n + v->nchunk;
    if (room->n < need) {
        pg_free (room->v), room->v = NULL, room->n = 0;
        PG_ALLOC (room->v, need);
        room->n = need;
    }
    v->r = room->v, v->z = v->r + n, v->p = v->z + n, v->q = v->p + n, v->sum = v->q + n;
    if (!P) v->d = v->sum + v->nchunk;
    memset (v->p, 0, n * sizeof *v->p);
    if (!P) A->diagonal (A->context, v->d);
    for (size_t i = 0; i < v->n && !P; i++) v->d[i] = v->d[i] > 0 ? 1 / v->d[i] : 1;
done:
    return status;
}

/* ---- local right-hand sides ---------------------------------------------------------------------------- */
/* Largest norm of the entries of r that are left out, over `goal`, the norm of r at which iterations end. */
static const double left_out = 0.5;

/* Sets `least`: halves it from a tenth of the goal on until the norm of the entries of r below it is at most
 * left_out * goal. */
static void find_least (vectors *v, double goal)
{
    double sum;
    v->least = 0.2 * goal;
    do {
        v->least *= 0.5, sum = 0;
        for (size_t i = 0; i < v->n; i++) if (fabs (v->r[i]) < v->least) sum += v->r[i] * v->r[i];
    } while (sum > left_out * goal * left_out * goal && v->least > 1e-6 * goal);
}

/* Sets entries of p below least * d to zero, and halves `least` if the norm of r at these is too large. If no
 * entry remains, p is z, and nothing is left out any more. */
static void local_direction (vectors *v, double goal)
{
    double behind = 0;
    size_t kept = 0;
    for (size_t i = 0; i < v->n; i++) {
        if (fabs (v->p[i]) < v->least * v->d[i]) v->p[i] = 0, behind += v->r[i] * v->r[i];
        else kept++;
    }
    if (behind > 2 * left_out * goal * left_out * goal) v->least *= 0.5;
    if (kept > 0) return;
    v->least = 0;
    memcpy (v->p, v->z, v->n * sizeof *v->p);
}

/* Reports an iteration to the caller's function `stepped`, if there is one. */
static pg_status tell (const pg_cg_watch *watch, double alpha, double residual, int *stop)
{
    return watch && watch->stepped ? watch->stepped (watch->context, alpha, residual, stop) : PG_OK;
}

pg_status pg_conjugate_gradients_watched (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                          double *x, double tolerance, size_t limit, size_t *iterations,
                                          const pg_cg_watch *watch)
{
    pg_status status = PG_OK;
    vectors v = { 0 };
    pg_cg_room own = { 0 };
    size_t k = 0;
    v.shared = watch && watch->shared;
    PG_TRY (make_vectors (&v, watch && watch->room ? watch->room : &own, A, P, x));
    first_residual (A, b, &v);
    double size = sqrt (dot (&v, b, b)), goal = tolerance * size, rz = 0, rr = sqrt (dot (&v, v.r, v.r));
    int stop = 0;
    /* A residual whose square nearly underflows, such as rounding leaves of a load that has returned to zero,
     * counts as zero: dot products with it would vanish. */
    if (rr * rr < DBL_MIN / DBL_EPSILON) goal = fmax (goal, rr);
    if (watch && watch->local && !P && !v.shared && rr > goal) find_least (&v, goal);
    for (k = 0; rr > goal && k < limit && !stop; k++) {
        PG_TRY (precondition (P, &v));
        double next = dot (&v, v.r, v.z);
        v.turn = k ? next / rz : 0;
        pg_parallel_heavy (v.threads, v.nchunk, turn_chunks, &v);
        rz = next;
        if (v.least > 0) local_direction (&v, goal), next = dot (&v, v.r, v.p);
        A->apply (A->context, v.p, v.q);
        double pq = dot (&v, v.p, v.q);
        PG_TRY (v.lost);
        if (isnan (pq))
            PG_FAIL (PG_E_NOT_SPD, "conjugate gradients found no solution: after %zu iterations the numbers "
                                   "are not finite any more", k);
        if (pq <= 0)
            PG_FAIL (PG_E_NOT_SPD, "conjugate gradients met a direction of energy %g after %zu iterations",
                     pq, k);
        v.alpha = next / pq;
        rr = sqrt (total (&v, step_chunks));
        PG_TRY (tell (watch, v.alpha, rr / size, &stop));
    }
    if (!(rr <= goal) && !stop)
        PG_FAIL (PG_E_EQUILIBRIUM, "conjugate gradients stopped after %zu iterations at residual %g of %g", k,
                 rr, goal);
done:
    if (iterations) *iterations = k;
    pg_free (own.v);
    return status;
}

/* Iterates without reports to the caller. */
pg_status pg_conjugate_gradients_with (const pg_operator *A, const pg_preconditioner *P, const double *b,
                                       double *x, double tolerance, size_t limit, size_t *iterations)
{
    return pg_conjugate_gradients_watched (A, P, b, x, tolerance, limit, iterations, NULL);
}

/* Runs on one thread, as the number of threads comes with a preconditioner of the caller's. */
pg_status pg_conjugate_gradients (const pg_operator *A, const double *b, double *x, double tolerance,
                                  size_t limit, size_t *iterations)
{
    return pg_conjugate_gradients_with (A, NULL, b, x, tolerance, limit, iterations);
}

/* State of the catalogue entry. */
typedef struct { const pg_sparse *A; double tolerance; size_t iterations; } pcg;

static void pcg_free (void **self) { pg_free (*self), *self = NULL; }

/* Nothing to analyse; the tolerance is 1e-10 unless given. */
static pg_status pcg_analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    pg_status status = PG_OK;
    pcg *s = NULL;
    PG_ALLOC (s, 1);
    s->A = A, s->tolerance = options->tolerance > 0 ? options->tolerance : 1e-10;
    *self = s;
done:
    return status;
}

/* There is no factor: the matrix is kept for the products. */
static pg_status pcg_factor (void *self, const pg_sparse *A)
{
    ((pcg *) self)->A = A;
    return PG_OK;
}

/* Starts from zero for each right-hand side and takes at most 20 n + 1000 iterations. */
static pg_status pcg_solve (void *self, size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    pcg *s = self;
    pg_sparse A = *s->A;
    pg_operator op = pg_sparse_operator (&A);
    for (size_t k = 0; k < nrhs; k++) {
        size_t used;
        memset (x + k * A.ncol, 0, A.ncol * sizeof *x);
        PG_TRY (pg_conjugate_gradients (&op, b + k * A.ncol, x + k * A.ncol, s->tolerance, 20 * A.ncol + 1000,
                                        &used));
        s->iterations += used;
    }
done:
    return status;
}

static void pcg_info (const void *self, pg_linear_info *info)
{
    *info = (pg_linear_info) { .ordering = "none", .iterations = ((const pcg *) self)->iterations };
}

const pg_linear_type pg_linear_pcg = {
    "pcg", "conjugate gradients with diagonal preconditioning", 1, 0,
    pcg_analyse, pcg_factor, pcg_solve, NULL, NULL, pcg_info, pcg_free, NULL
};
