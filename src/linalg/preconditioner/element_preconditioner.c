/* SPDX-License-Identifier: GPL-3.0-or-later
 * A preconditioner for stiffness matrices of smooth shape functions: that of finite elements on the same
 * nodes, with a change of unknowns.
 *
 * Coefficients d and displacements u = N d of the nodes differ: N holds the values of all shape functions at
 * the nodes. Patterns of d that alternate from node to node hardly move the nodes, and have hardly any
 * energy, so that neither smoothing by the diagonal nor finite elements alone find them. But the energy of d
 * is about that of the finite elements with the displacements N d, hence with their stiffness Q
 *
 *     K ~ N' Q N,    P^-1 = p (N) V (Q) p (N)',
 *
 * where V (Q) is a multilevel cycle, about Q^-1, and p a polynomial, about 1 / x on the spectrum of N (less
 * where x is small, see `inverse`). For
 * finite elements of low order as preconditioners of smooth ones: S. A. Orszag, J. Comput. Phys. 37 (1980)
 * 70; M. O. Deville and E. H. Mund, J. Comput. Phys. 60 (1985) 517. Since p is the same fixed polynomial on
 * both sides, P is symmetric, and it is positive definite whatever N is as long as p (N) is regular.
 *
 * p interpolates a given function at the Chebyshev nodes of [low, high] and is evaluated by the recurrence
 * T_k+1 = 2 s T_k - T_k-1 of s = (x - middle) / half. */
#include "perigal/linalg.h"
#include "linalg/alike.h"
#include "shared_springs.h"
#include "linalg/wide.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

/* Most terms of the polynomial; fewest rows of a run of alike rows: eight numbers have to fit in. */
enum { MOST_TERMS = 32, LEAST = 8 };

struct pg_element_preconditioner {
    pg_elements elements;
    /* Rows of N and of N' that are alike. */
    pg_row_runs alike, alike_transposed;
    /* N', by rows. */
    pg_node_matrix transposed;
    pg_multilevel *multilevel;
    const pg_subdomain *subdomain;                     /* nodes that this rank owns; NULL: one process */
    /* V where ranks share nodes that form no lattice: a preconditioner that they build of Q together, `by`.
     * */
    void   *shared;
    const pg_shared_preconditioner *by;
    pg_operator    Q;
    int     terms;
    double  middle, half, c[MOST_TERMS];
    /* Unknowns that V leaves at zero (ndof). */
    unsigned char *fixed;
    /* Factor of W'W, and vectors of its length; NULL: no stiff springs. */
    const pg_linear_type *direct;
    void   *factor;
    double *force, *along, *part;
    /* Residual less its part along W, the stiff springs (ndof). */
    double *rest;
    /* Vectors of the recurrence (unknowns of the nodes), and the vectors before and after V (unknowns of
     * Q). */
    double *t[2], *left, *right;
};

/* ---- the matrix N -------------------------------------------------------------------------------------- */
void pg_node_matrix_clear (pg_node_matrix *A)
{
    pg_free (A->start), pg_free (A->node), pg_free (A->value);
    memset (A, 0, sizeof *A);
}

/* B = A'; the rows of A are taken in ascending order, so that the nodes of each row of B ascend. */
static pg_status transpose (pg_node_matrix *B, const pg_node_matrix *A)
{
    pg_status status = PG_OK;
    size_t nnz = A->start[A->n];
    B->n = A->n;
    PG_ALLOC (B->start, A->n + 2);
    PG_ALLOC (B->node, nnz);
    PG_ALLOC (B->value, nnz);
    for (size_t e = 0; e < nnz; e++) B->start[A->node[e] + 2]++;
    for (size_t i = 0; i < A->n; i++) B->start[i + 2] += B->start[i + 1];
    for (size_t i = 0; i < A->n; i++)
        for (size_t e = A->start[i]; e < A->start[i + 1]; e++) {
            size_t at = B->start[A->node[e] + 1]++;
            B->node[at] = (int) i, B->value[at] = A->value[e];
        }
done:
    return status;
}

/* ---- the polynomial ------------------------------------------------------------------------------------ */
/* Coefficients of the Chebyshev polynomials from the values at their nodes (a discrete cosine transform). */
static void interpolate (pg_element_preconditioner *P, double low, double high,
                         double (*f) (double x, double parameter), double parameter)
{
    int m = P->terms;
    P->middle = (high + low) / 2, P->half = (high - low) / 2;
    for (int k = 0; k < m; k++) {
        double sum = 0;
        for (int j = 0; j < m; j++)
            sum += f (P->middle + P->half * cos ((j + 0.5) * pi / m), parameter)
                   * cos (k * (j + 0.5) * pi / m);
        P->c[k] = (k ? 2.0 : 1.0) / m * sum;
    }
}

/* One step of the recurrence: last = T_k-1 r becomes T_k+1 r, now = T_k r, sum += c last. scale: 1 / half in
 * the first step, where there is no T_-1 (keep 0), else 2 / half (keep 1). */
typedef struct {
    const pg_node_matrix *A;
    const pg_row_runs *runs;
    size_t block;
    double middle, scale, keep, c;
    const double *now;
    double *last, *sum;
} step;

/* s (3) = row i of A times x, in two sums that need not wait for each other. */
static inline __attribute__ ((always_inline)) void row_times (const pg_node_matrix *A, size_t i,
                                                              const double *x, double *s)
{
    four even = { 0 }, odd = { 0 };
    size_t e = A->start[i], end = A->start[i + 1];
    for (; e + 2 < end; e += 2) {
        even += (double) A->value[e] * *(const four *) (x + 3 * (size_t) A->node[e]);
        odd += (double) A->value[e + 1] * *(const four *) (x + 3 * (size_t) A->node[e + 1]);
    }
    for (size_t k = 0; k < 3; k++) s[k] = even[k] + odd[k];
    for (; e < end; e++)                               /* four numbers might reach beyond the end of x */
        for (size_t k = 0; k < 3; k++) s[k] += (double) A->value[e] * x[3 * (size_t) A->node[e] + k];
}

/* The recurrence at number i, where A times `now` is s. */
static inline __attribute__ ((always_inline)) void recur_at (const step *w, size_t i, double s)
{
    double next = w->scale * (s - w->middle * w->now[i]) - w->keep * w->last[i];
    w->last[i] = next;
    w->sum[i] += w->c * next;
}

/* One step of the recurrence at the rows first .. last - 1, one by one. */
PG_WIDE static void recur_rows (const step *w, size_t first, size_t last)
{
    const pg_node_matrix *A = w->A;
    size_t block = w->block;
    for (size_t i = first; i < last; i++) {
        double s[6] = { 0 };
        if (block == 3) row_times (A, i, w->now, s);
        else
            for (size_t e = A->start[i]; e < A->start[i + 1]; e++)
                for (size_t k = 0; k < block; k++)
                    s[k] += (double) A->value[e] * w->now[(size_t) A->node[e] * block + k];
        for (size_t k = 0; k < block; k++) recur_at (w, i * block + k, s[k]);
    }
}

/* The recurrence at eight numbers from number i on, where A times `now` is s. */
static inline __attribute__ ((always_inline)) void recur_eight (const step *w, size_t i,
                                                                const eight *s)
{
    eight *last = (eight *) (w->last + i), *sum = (eight *) (w->sum + i),
          next = w->scale * (*s - w->middle * *(const eight *) (w->now + i)) - w->keep * *last;
    *last = next;
    *sum += w->c * next;
}

/* One step of the recurrence at `count` rows like row `model`, from row `first` on: 32 numbers at a time,
 * so that sums need not wait for one another. The last eight may overlap numbers that are done: these are
 * left. */
PG_WIDEST static void recur_alike (const step *w, size_t model, size_t first, size_t count)
{
    const pg_node_matrix *A = w->A;
    size_t done = (first - model) * w->block, end = done + count * w->block, to = model * w->block;
    for (; done + 32 <= end; done += 32) {
        eight s0 = { 0 }, s1 = { 0 }, s2 = { 0 }, s3 = { 0 };
        for (size_t e = A->start[model]; e < A->start[model + 1]; e++) {
            const eight *x = (const eight *) (w->now + (size_t) A->node[e] * w->block + done);
            double v = (double) A->value[e];
            s0 += v * x[0], s1 += v * x[1], s2 += v * x[2], s3 += v * x[3];
        }
        recur_eight (w, to + done, &s0), recur_eight (w, to + done + 8, &s1);
        recur_eight (w, to + done + 16, &s2), recur_eight (w, to + done + 24, &s3);
    }
    while (done < end) {
        size_t at = end - done < 8 ? end - 8 : done;
        eight s = { 0 };
        for (size_t e = A->start[model]; e < A->start[model + 1]; e++)
            s += (double) A->value[e] * *(const eight *) (w->now + (size_t) A->node[e] * w->block + at);
        for (; done < at + 8; done++) recur_at (w, to + done, s[done - at]);
    }
}

/* One step of the recurrence at `count` rows like row `model`, too few for recur_alike, as other threads have
 * the rest of the run: number by number, in the same order. */
static void recur_few (const step *w, size_t model, size_t first, size_t count)
{
    const pg_node_matrix *A = w->A;
    size_t shift = (first - model) * w->block;
    for (size_t k = 0; k < count * w->block; k++) {
        double s = 0;
        for (size_t e = A->start[model]; e < A->start[model + 1]; e++)
            s += (double) A->value[e] * w->now[(size_t) A->node[e] * w->block + shift + k];
        recur_at (w, first * w->block + k, s);
    }
}

/* One step of the recurrence at the rows first .. last - 1: runs of alike rows, as far as they lie in this
 * range, and the rows between them. The result of a row does not depend on the range. */
static void recur (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const step *w = context;
    for (size_t k = rows_alike_at (w->runs, first); k < w->runs->n && w->runs->run[k].first < last; k++) {
        const pg_row_run *r = &w->runs->run[k];
        size_t from = r->first > first ? r->first : first,
               end = r->first + r->count < last ? r->first + r->count : last;
        recur_rows (w, first, from);
        if (end - from >= LEAST) recur_alike (w, r->first, from, end - from);
        else recur_few (w, r->first, from, end - from);
        first = end;
    }
    recur_rows (w, first, last);
}

/* y = p (A) r, where ranks share the body at owned nodes only: each product needs the ghosts' values anew. */
static pg_status polynomial (const pg_element_preconditioner *P, const pg_node_matrix *A,
                             const pg_row_runs *alike, const double *r, double *y)
{
    pg_status status = PG_OK;
    const pg_block_matrix *Q = &P->elements.Q;
    size_t ndof = Q->n * (size_t) Q->block;
    double *now = P->t[0], *last = P->t[1];
    for (size_t i = 0; i < ndof; i++) now[i] = r[i], last[i] = 0, y[i] = P->c[0] * r[i];
    for (int k = 1; k < P->terms; k++) {
        PG_TRY (pg_subdomain_exchange (P->subdomain, (size_t) Q->block, now));
        step w = { A, alike, (size_t) Q->block, P->middle, (k > 1 ? 2 : 1) / P->half, k > 1, P->c[k],
                   now, last, y };
        pg_parallel (Q->threads, Q->n, recur, &w);
        double *swap = now;
        now = last, last = swap;
    }
done:
    return status;
}

/* ---- the preconditioner -------------------------------------------------------------------------------- */
void pg_elements_clear (pg_elements *e)
{
    pg_block_clear (&e->Q);
    pg_hats_clear (&e->hats);
    pg_free (e->diagonal);
    e->diagonal = NULL;
    pg_node_matrix_clear (&e->N);
    pg_sparse_clear (&e->W);
    pg_free (e->held), pg_free (e->holds);
    e->held = NULL, e->holds = NULL;
}

void pg_element_preconditioner_free (pg_element_preconditioner **preconditioner)
{
    pg_element_preconditioner *P = *preconditioner;
    if (!P) return;
    pg_elements_clear (&P->elements);
    pg_node_matrix_clear (&P->transposed);
    pg_multilevel_free (&P->multilevel);
    if (P->shared) P->by->free (&P->shared);
    pg_free (P->alike.run), pg_free (P->alike_transposed.run);
    if (P->factor) P->direct->free (&P->factor);
    pg_free (P->t[0]), pg_free (P->t[1]), pg_free (P->left), pg_free (P->right);
    pg_free (P->fixed), pg_free (P->force), pg_free (P->along), pg_free (P->part), pg_free (P->rest);
    pg_free (P);
    *preconditioner = NULL;
}

/* About 1 / x, bounded by 1 / parameter, and less for patterns that the shape functions damp (x < 1): their
 * energy by K is up to 3 to 5 times that by N' Q N, as plane waves on the lattice show; 1 + 2 (1 - x)^2 is
 * about the mean of this ratio. */
static double inverse (double x, double parameter)
{
    return 1 / sqrt (x * x * (1 + 2 * (1 - x) * (1 - x)) + parameter * parameter);
}

/* Unknowns that are prescribed or held by stiff springs take no part in V. */
static pg_status find_fixed (pg_element_preconditioner *P, const unsigned char *fixed, size_t ndof)
{
    pg_status status = PG_OK;
    PG_ALLOC (P->fixed, ndof);
    if (fixed) memcpy (P->fixed, fixed, ndof);
    for (size_t c = 0; c < P->elements.W.ncol; c++) P->fixed[P->elements.holds[c]] = 1;
done:
    return status;
}

/* Factors W'W, the congruence of the unit matrix, by Cholesky. Each rank has the springs of all ranks from
 * here on. */
static pg_status factor_springs (pg_element_preconditioner *P, size_t ndof, int threads)
{
    pg_status status = PG_OK;
    pg_sparse unit = { 0 }, G = { 0 }, whole = { 0 };
    pg_linear_options o = { 1, 3, threads, 0, 1 };
    if (P->subdomain) PG_TRY (springs_share (&P->elements, P->subdomain, &whole));
    const pg_sparse *W = P->subdomain ? &whole : &P->elements.W;
    size_t n = W->ncol, nrow = W->nrow;
    if (n == 0) goto done;
    P->direct = pg_linear_first (1, 1);
    PG_TRY (pg_sparse_create (&unit, nrow, nrow, nrow, 1));
    for (size_t i = 0; i < nrow; i++)
        unit.row[i] = (long) i, unit.value[i] = 1, unit.start[i + 1] = (long) i + 1;
    PG_TRY (pg_sparse_congruence (&G, &unit, W));
    PG_TRY (P->direct->analyse (&P->factor, &G, &o));
    PG_TRY (P->direct->factor (P->factor, &G));
    PG_ALLOC (P->force, n);
    PG_ALLOC (P->along, n);
    PG_ALLOC (P->part, n);
    PG_ALLOC (P->rest, ndof);
done:
    pg_sparse_clear (&unit), pg_sparse_clear (&G), pg_sparse_clear (&whole);
    return status;
}

/* Fragments without supports make Q singular: this share of its diagonal is added, as on coarse grids. */
static const double lift = 1e-10;

/* Makes V where ranks share nodes that form no lattice, so that they have no coarse functions in common: by a
 * preconditioner that is given from outside. Q is emptied, as it is not needed any more. */
static pg_status make_shared (pg_element_preconditioner *P, const pg_element_setting *s)
{
    pg_status status = PG_OK;
    pg_block_matrix *Q = &P->elements.Q;
    double *diagonal = NULL;
    P->by = pg_shared_preconditioner_now ();
    if (!P->by) PG_FAIL (PG_E_USAGE, "ranks share no preconditioner");
    PG_ALLOC (diagonal, Q->n * (size_t) Q->block);
    P->Q.diagonal (P->Q.context, diagonal);
    pg_shared_rows rows = { .dim = s->dim, .block = Q->block, .x = s->x, .fixed = P->fixed,
                            .subdomain = s->subdomain, .rows = pg_block_couplings (Q, P->elements.reach),
                            .k = 1, .m = lift, .mass = diagonal };
    PG_TRY (P->by->create (&P->shared, &rows));
    pg_block_matrix empty = { .block = Q->block, .threads = Q->threads, .n = Q->n };
    pg_block_clear (Q);
    *Q = empty;
done:
    pg_free (diagonal);
    return status;
}

/* Makes V, a multilevel cycle for Q. With elements on a coarse grid no unknown of Q is fixed: solve_coarse
 * leaves out the fixed unknowns of the nodes. */
static pg_status make_cycle (pg_element_preconditioner *P, const pg_element_setting *s)
{
    pg_status status = PG_OK;
    pg_elements *e = &P->elements;
    pg_block_matrix *Q = &e->Q;
    pg_multilevel_setting m = { .dim = s->dim,
                                .block = Q->block,
                                .threads = Q->threads,
                                .n = Q->n,
                                .x = e->hats.count ? e->hats.place : s->x,
                                .fixed = e->hats.count ? NULL : P->fixed,
                                .A = &P->Q,
                                .rows = pg_block_couplings (Q, e->reach),
                                .step = 2.5 * e->spacing / e->reach, .aligned = 1,
                                .subdomain = s->subdomain };
    memcpy (m.rows.lattice, e->lattice, sizeof m.rows.lattice);
    P->Q = pg_block_operator (Q);
    if (s->subdomain && !(e->lattice[0] > 0)) return make_shared (P, s);
    PG_TRY (pg_block_settle (Q));
    PG_TRY (pg_multilevel_create (&P->multilevel, &m));
done:
    return status;
}

static pg_status find_runs (pg_row_runs *out, const pg_node_matrix *A)
{
    return rows_alike (out, LEAST, A->n, A->start, A->node, A->value, 1);
}

/* Makes the polynomial, N', the runs of alike rows of N and N', and the vectors of the recurrence. */
static pg_status make_polynomial (pg_element_preconditioner *P, size_t ndof)
{
    pg_status status = PG_OK;
    P->terms = P->elements.terms < MOST_TERMS ? P->elements.terms : MOST_TERMS;
    interpolate (P, P->elements.low, P->elements.high, inverse, P->elements.floor);
    PG_TRY (transpose (&P->transposed, &P->elements.N));
    PG_TRY (find_runs (&P->alike, &P->elements.N));
    PG_TRY (find_runs (&P->alike_transposed, &P->transposed));
    PG_ALLOC (P->t[0], ndof);
    PG_ALLOC (P->t[1], ndof);
    PG_ALLOC (P->left, ndof);
    PG_ALLOC (P->right, ndof);
done:
    return status;
}

/* Takes over the elements, also where it fails. */
pg_status pg_element_preconditioner_create (pg_element_preconditioner **out, pg_elements *elements,
                                            const pg_element_setting *s)
{
    pg_status status = PG_OK;
    pg_element_preconditioner *P = NULL;
    *out = NULL;
    PG_ALLOC (P, 1);
    P->elements = *elements;
    memset (elements, 0, sizeof *elements);
    pg_block_matrix *Q = &P->elements.Q;
    const pg_hats *hats = &P->elements.hats;
    size_t ndof = (hats->count ? hats->n : Q->n) * (size_t) Q->block;
    P->subdomain = s->subdomain;
    PG_TRY (find_fixed (P, s->fixed, ndof));
    PG_TRY (factor_springs (P, ndof, Q->threads));
    PG_TRY (make_cycle (P, s));
    if (hats->count) {
        PG_ALLOC (P->left, Q->n * (size_t) Q->block);
        PG_ALLOC (P->right, Q->n * (size_t) Q->block);
        PG_ALLOC (P->t[0], ndof);
    } else if (P->elements.N.start) PG_TRY (make_polynomial (P, ndof));
    *out = P, P = NULL;
done:
    pg_elements_clear (elements);
    pg_element_preconditioner_free (&P);
    return status;
}

/* z = V r */
static pg_status cycle (pg_element_preconditioner *P, const double *r, double *z)
{
    if (P->shared) return P->by->solve (P->shared, r, z);
    pg_preconditioner V = pg_multilevel_preconditioner (P->multilevel);
    return V.solve (V.context, r, z);
}

/* z = D^-1 r + H V (Q) H' r; z = 0 at unknowns that are fixed. */
static pg_status solve_coarse (pg_element_preconditioner *P, const double *r, double *z)
{
    pg_status status = PG_OK;
    const pg_elements *e = &P->elements;
    size_t ndof = e->hats.n * (size_t) e->Q.block;
    for (size_t i = 0; i < ndof; i++) P->t[0][i] = P->fixed[i] ? 0 : r[i];
    pg_hats_restrict (&e->hats, e->Q.block, P->t[0], P->left);
    PG_TRY (cycle (P, P->left, P->right));
    for (size_t i = 0; i < ndof; i++) z[i] = e->diagonal[i] > 0 ? P->t[0][i] / e->diagonal[i] : P->t[0][i];
    pg_hats_add (&e->hats, e->Q.block, P->right, z);
    for (size_t i = 0; i < ndof; i++) if (P->fixed[i]) z[i] = 0;
done:
    return status;
}

/* z = p (N) V (Q) p (N') r; without N z = V (Q) r; with elements on a coarse grid: solve_coarse. */
static pg_status solve_elements (pg_element_preconditioner *P, const double *r, double *z)
{
    pg_status status = PG_OK;
    if (P->elements.hats.count) return solve_coarse (P, r, z);
    if (!P->elements.N.start) return cycle (P, r, z);
    PG_TRY (polynomial (P, &P->transposed, &P->alike_transposed, r, P->left));
    PG_TRY (cycle (P, P->left, P->right));
    PG_TRY (polynomial (P, &P->elements.N, &P->alike, P->right, z));
done:
    return status;
}

/* c = (W'W)^-1 W' x */
static pg_status take_along (pg_element_preconditioner *P, const double *x, double *c)
{
    pg_status status = PG_OK;
    pg_sparse_multiply_transposed (&P->elements.W, x, P->part);
    if (P->subdomain) PG_TRY (pg_ranks_sum (P->elements.W.ncol, P->part));
    PG_TRY (P->direct->solve (P->factor, 1, P->part, c));
done:
    return status;
}

/* to = x - W c */
static void take_off (pg_element_preconditioner *P, const double *x, const double *c, double *to)
{
    const pg_sparse *W = &P->elements.W;
    if (to != x) memcpy (to, x, W->nrow * sizeof *to);
    for (size_t j = 0; j < W->ncol; j++)
        for (long q = W->start[j]; q < W->start[j + 1]; q++) to[W->row[q]] -= W->value[q] * c[j];
}

/* z = P^-1 r. With stiff springs (columns of W) the part of r along W is divided by their stiffnesses, and
 * the rest goes to the elements. */
static pg_status solve (void *context, const double *r, double *z)
{
    pg_status status = PG_OK;
    pg_element_preconditioner *P = context;
    if (!P->factor) {
        PG_TRY (solve_elements (P, r, z));
        goto done;
    }
    PG_TRY (take_along (P, r, P->force));
    take_off (P, r, P->force, P->rest);
    PG_TRY (solve_elements (P, P->rest, z));
    PG_TRY (take_along (P, z, P->along));
    take_off (P, z, P->along, z);
    for (size_t c = 0; c < P->elements.W.ncol; c++) P->force[c] /= P->elements.held[c];
    PG_TRY (P->direct->solve (P->factor, 1, P->force, P->along));
    for (size_t c = 0; c < P->elements.W.ncol; c++) P->along[c] = -P->along[c];
    take_off (P, z, P->along, z);
done:
    pg_subdomain_clear_ghosts (P->subdomain, (size_t) P->elements.Q.block, z);
    return status;
}

pg_preconditioner pg_element_preconditioner_of (pg_element_preconditioner *P)
{
    return (pg_preconditioner) { P, solve, P->elements.Q.threads };
}

int pg_element_preconditioner_on_grid (const pg_element_preconditioner *P)
{
    return P->elements.hats.count > 0;
}

void pg_element_preconditioner_describe (const pg_element_preconditioner *P, char *text, size_t size)
{
    size_t at = (size_t) snprintf (text, size, "finite elements, ");
    if (at >= size) return;
    if (P->shared) P->by->describe (P->shared, text + at, size - at);
    else pg_multilevel_describe_shared (P->multilevel, text + at, size - at);
}

const pg_multilevel *pg_element_preconditioner_levels (const pg_element_preconditioner *P)
{
    return P->multilevel;
}
