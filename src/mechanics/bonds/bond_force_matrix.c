/* SPDX-License-Identifier: GPL-3.0-or-later
 * K of the bonds for small displacements: K_ij = - kappa xi x xi, K_ii = sum_j kappa xi x xi over intact
 * bonds: products K x by the loop over bonds, a sparse matrix whose columns are recomputed when a bond of
 * their point breaks, diagonal and row sums, and the bound omega^2 <= 2 lambda_max (P_i) / rho_i,
 * P_i = sum_j kappa xi x xi / V_i (theory A4). */
#include "dilatation.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

typedef struct { double *y; int failed; } negation;
/* y = -y for unknowns first .. last - 1, or NaN if the forces could not be computed, so that an error is
 * noticed. */
static void negate (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const negation *w = context;
    double *y = w->y;
    if (w->failed) for (size_t i = first; i < last; i++) y[i] = NAN;
    else for (size_t i = first; i < last; i++) y[i] = -y[i];
}

/* y = K x = - forces at displacement x, plus springs; NaN if the loop with the linear stretch cannot be
 * made. */
void bond_force_apply (void *context, const double *x, double *y)
{
    bond_force *b = context;
    pg_bond_loop *loop;
    size_t ndof = b->n * (size_t) b->stride;
    int failed = bond_force_tangent_loop (b, &loop) != PG_OK
        || pg_bond_loop_force (loop, x, y, NULL) != PG_OK;
    negation w = { y, failed };
    pg_parallel (b->threads, ndof, negate, &w);
    boundary_hold (&b->boundary, x, y);
}

enum { MOST = 36 };                                    /* most numbers of a block (6 x 6) */

/* Adds the springs of point i, N/m, to the diagonal of its own block D. */
static void add_springs (const bond_force *b, size_t i, double *D)
{
    size_t m = (size_t) b->stride;
    for (size_t k = 0; b->boundary.hold && k < m; k++) D[k * m + k] += b->boundary.hold[i * m + k];
}

/* Diagonal block D of point i: sum of `own` over its intact bonds (all: over all bonds that no pre-crack
 * cuts), and springs. exact: without the pair force that replaces a dilatation beside micropolar bonds. */
static void own_block (const bond_force *b, size_t i, const point_bonds *s, int all, int exact, double *D)
{
    size_t bb = (size_t) (b->stride * b->stride);
    const unsigned char *counted = b->dilatation ? b->dilatation->counted : NULL;
    double own[MOST], other[MOST];
    memset (D, 0, bb * sizeof *D);
    for (size_t e = 0; e < s->m; e++) {
        if (all ? counted && !counted[s->first + e] : !bond_force_lives (b, s->first + e)) continue;
        if (exact) b->theory->alone (b, i, s, e, own, other);
        else b->theory->blocks (b, i, s, e, own, NULL);
        for (size_t k = 0; k < bb; k++) D[k] += own[k];
    }
    add_springs (b, i, D);
}

/* ---- rows of points that have all their bonds ---------------------------------------------------------- */
/* Writes the row of blocks of point i over its intact bonds (all: over all bonds), its own block last, to
 * `value`, and their nodes to `node` unless NULL. Returns the number of blocks. */
static size_t row_of_bonds (const bond_force *b, size_t i, const point_bonds *s, int all, int *node,
                           double *value)
{
    size_t bb = (size_t) (b->stride * b->stride), m = 0;
    double own[MOST] = { 0 }, part[MOST];
    for (size_t e = 0; e < s->m; e++) {
        if (!all && !bond_force_lives (b, s->first + e)) continue;
        b->theory->blocks (b, i, s, e, part, value + m * bb);
        for (size_t k = 0; k < bb; k++) own[k] += part[k];
        if (node) node[m] = s->node[e];
        m++;
    }
    if (!all) add_springs (b, i, own);
    memcpy (value + m * bb, own, bb * sizeof *own);
    if (node) node[m] = (int) i;
    return m + 1;
}

static size_t family_size (const bond_force *b,
                           size_t i) { return b->family->start[i + 1] - b->family->start[i]; }

/* On a lattice with equal volumes, one modulus and no surface correction the row of K of a point with all its
 * bonds is the same everywhere: it is computed once (b->whole). Without memory for it every row is computed
 * by itself. */
static void find_whole (bond_force *b)
{
    const pg_sums *sums = b->problem->sums;
    size_t i = 0, n = sums->stencil.n, bb = (size_t) (b->stride * b->stride);
    if (b->searched) return;
    b->searched = 1;
    if (!b->theory->alike || !n || !sums->ordered || sums->share || sums->family_volume) return;
    for (size_t k = 0; k < b->n; k++) if (!b->theory->alike (b, k)) return;
    while (i < b->n && family_size (b, i) != n) i++;
    if (i == b->n) return;
    point_bonds s;
    point_bonds_at (b, i, 0, &s);
    b->whole = pg_calloc ((n + 1) * bb, sizeof *b->whole);
    if (b->whole) row_of_bonds (b, i, &s, 1, NULL, b->whole);
}

/* Does point i have a full family and no spring, so that the shared row is its row as long as no bond
 * breaks? */
static int was_whole (const bond_force *b, size_t i)
{
    for (size_t k = 0; b->boundary.hold && k < (size_t) b->stride; k++)
        if (b->boundary.hold[i * (size_t) b->stride + k] > 0) return 0;
    return b->whole && family_size (b, i) == b->problem->sums->stencil.n;
}

/* Is the shared row that of point i now: full family, no spring, no broken bond? */
static int is_whole (const bond_force *b, size_t i)
{
    return was_whole (b, i) && !(b->alive && memchr (b->alive + b->family->start[i], 0, family_size (b, i)));
}

/* pg_couplings.alike: 1 where point i has the row of K that all whole points share. */
static int has_shared_row (void *context, size_t i) { return is_whole (context, i); }

typedef struct { const bond_force *b; double *out; const double *mass; } job;

/* Exact diagonal block of K with dilatations: the share of the dilatations of the point and of its
 * neighbours, and the micropolar bonds beside them. (Exact other blocks would need neighbours of
 * neighbours.) */
static void exact_block (const bond_force *b, size_t i, const point_bonds *s, double *D)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    double state[9];
    dilatation_own (b, i, s, state);
    memset (D, 0, m * m * sizeof *D);
    if (b->theory->alone) own_block (b, i, s, 0, 1, D);
    else add_springs (b, i, D);
    for (size_t a = 0; a < dim; a++)
        for (size_t c = 0; c < dim; c++) D[a * m + c] += state[a * dim + c];
}

/* Diagonal of K at points first .. last - 1: from the shared row, else summed. */
static void diagonal_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    size_t dim = (size_t) w->b->stride;
    point_bonds s;
    double D[MOST];
    for (size_t i = first; i < last; i++) {
        const double *own = D;
        if (is_whole (w->b, i)) own = w->b->whole + family_size (w->b, i) * dim * dim;
        else {
            point_bonds_at (w->b, i, thread, &s);
            if (!w->b->dilatation) own_block (w->b, i, &s, 0, 0, D);
            else exact_block (w->b, i, &s, D);
        }
        for (size_t k = 0; k < dim; k++) w->out[i * dim + k] = own[k * dim + k];
    }
}

/* Copies the diagonal of K, N/m, which is kept until bonds change. */
void bond_force_diagonal (void *context, double *d)
{
    bond_force *b = context;
    size_t ndof = b->n * (size_t) b->stride;
    if (b->diagonal_of != b->revision) {
        job w = { b, b->diagonal, NULL };
        find_whole (b);
        dilatation_weigh (b);
        pg_parallel (b->threads, b->n, diagonal_points, &w);
        b->diagonal_of = b->revision;
    }
    memcpy (d, b->diagonal, ndof * sizeof *d);
}

/* Adds the sums of the absolute entries of each row of an m x m block. */
static void add_sizes (size_t m, const double *block, double *sum)
{
    for (size_t a = 0; a < m; a++)
        for (size_t c = 0; c < m; c++) sum[a] += fabs (block[a * m + c]);
}

/* Sums of absolute entries over the rows of points first .. last - 1, N/m: by Gershgorin no eigenvalue of K
 * is larger than the largest of these sums. */
static void row_sum_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    size_t m = (size_t) w->b->stride;
    point_bonds s;
    double D[MOST], own[MOST], other[MOST];
    for (size_t i = first; i < last; i++) {
        point_bonds_at (w->b, i, thread, &s);
        own_block (w->b, i, &s, 0, 0, D);
        memset (w->out + i * m, 0, m * sizeof *w->out);
        add_sizes (m, D, w->out + i * m);
        for (size_t e = 0; e < s.m; e++) {
            if (!bond_force_lives (w->b, s.first + e)) continue;
            w->b->theory->blocks (w->b, i, &s, e, own, other);
            add_sizes (m, other, w->out + i * m);
        }
    }
}

/* With dilatations the sums are those of pair forces that are at least as stiff, so that the bound holds. */
pg_status bond_force_row_sums (void *self, double *sum)
{
    bond_force *b = self;
    job w = { b, sum, NULL };
    if (dilatation_weigh (b) != PG_OK) return PG_E_MEMORY;
    pg_parallel (b->threads, b->n, row_sum_points, &w);
    return PG_OK;
}

/* pg_couplings.row: blocks of point i over its intact bonds, its own block last; value NULL: only nodes. */
static size_t couplings_of (void *context, size_t i, int thread, int *node, double *value)
{
    const bond_force *b = context;
    size_t bb = (size_t) (b->stride * b->stride), m = 0;
    if (!value) {
        for (size_t e = b->family->start[i]; e < b->family->start[i + 1]; e++)
            if (bond_force_lives (b, e)) node[m++] = b->family->node[e];
        node[m++] = (int) i;
        return m;
    }
    if (is_whole (b, i)) {
        m = family_size (b, i);
        memcpy (node, b->family->node + b->family->start[i], m * sizeof *node);
        memcpy (value, b->whole, (m + 1) * bb * sizeof *value);
        node[m] = (int) i;
        return m + 1;
    }
    point_bonds s;
    point_bonds_at (b, i, thread, &s);
    return row_of_bonds (b, i, &s, 0, node, value);
}

/* Largest component of the bond vectors of each of the points first .. last - 1, m. */
static void farthest_points (void *context, size_t first, size_t last, int thread)
{
    (void) thread;
    const job *w = context;
    size_t dim = (size_t) w->b->dim;
    const pg_family *f = w->b->family;
    const double *x = w->b->problem->cloud.x;
    for (size_t i = first; i < last; i++) {
        w->out[i] = 0;
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++)
            for (size_t k = 0; k < dim; k++) {
                double far = fabs (x[(size_t) f->node[e] * dim + k] - x[i * dim + k]);
                if (far > w->out[i]) w->out[i] = far;
            }
    }
}

/* Gives rows of K to preconditioners; with dilatations approximate ones that reach no further than bonds. */
pg_status bond_force_couplings (void *self, pg_couplings *out)
{
    bond_force *b = self;
    const pg_stencil *t = &b->problem->sums->stencil;
    double far = 0;
    pg_status status = PG_OK;
    *out = (pg_couplings) { .context = b, .widest = b->widest + 1, .row = couplings_of };
    find_whole (b);
    if (b->dilatation) PG_TRY (dilatation_couplings (b, out));
    if (b->whole) out->alike = has_shared_row;
    for (int k = 0; b->whole && k < b->dim; k++) out->lattice[k] = b->problem->sums->sites.step[k];
    if (t->n) for (size_t e = 0; e < t->n * (size_t) t->dim; e++) far = fmax (far, fabs (t->xi[e]));
    else {
        job w = { b, b->work, NULL };
        pg_parallel (b->threads, b->n, farthest_points, &w);
        for (size_t i = 0; i < b->n; i++) far = fmax (far, b->work[i]);
    }
    out->reach = far * (1 + 1e-9);
done:
    return status;
}

/* Largest eigenvalue of M^-1/2 P M^-1/2 of a point times its mass, N/m. The last result is kept, as
 * consecutive points mostly have the same block, to the bit. */
typedef struct { double block[MOST], mass[6], top; } last_block;
static double top_of (const bond_force *b, const double *mass, const double *block, last_block *last)
{
    size_t m = (size_t) b->stride;
    double P[MOST], lambda[6];
    if (memcmp (last->block, block, m * m * sizeof *block) == 0
        && memcmp (last->mass, mass, m * sizeof *mass) == 0) return last->top;
    memcpy (last->block, block, m * m * sizeof *block), memcpy (last->mass, mass, m * sizeof *mass);
    memcpy (P, block, m * m * sizeof *P);
    for (size_t k = 0; b->stride > b->dim && k < m * m; k++)
        P[k] *= mass[0] / sqrt (mass[k / m] * mass[k % m]);
    pg_dense_eigen ((int) m, P, lambda, NULL);
    return last->top = lambda[0];
}

/* Bounds of omega^2 at points first .. last - 1, 1/s^2. For each bond d.K d <= 2 (d_i.own d_i + d_j.own d_j),
 * as its energy is not negative: twice the largest eigenvalue of M^-1/2 D M^-1/2 of each point alone. */
static void bound_points (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    const pg_problem *p = w->b->problem;
    size_t m = (size_t) w->b->stride;
    point_bonds s = { 0 };
    double sum[MOST];
    last_block before = { .mass = { NAN } };
    for (size_t i = first; i < last; i++) {
        const double *mass = w->mass + i * m, *P = sum;
        int shared = !p->plain && was_whole (w->b, i);
        if (!shared) point_bonds_at (w->b, i, thread, &s);
        int grows = w->b->dilatation && p->sums->rule.follow && (w->b->limit || w->b->node.critical);
        double state = grows ? dilatation_bound (w->b, i, &s) * p->cloud.volume[i] / mass[0] : 0;
        double hold = 0;                               /* springs that no diagonal block includes, 1/s^2 */
        for (size_t k = 0; grows && !w->b->theory->alone && w->b->boundary.hold && k < m; k++)
            hold = fmax (hold, w->b->boundary.hold[i * m + k] / mass[0]);
        state += 2 * hold;
        w->out[i] = state;
        if (grows && !w->b->theory->alone) continue;
        if (shared) P = w->b->whole + p->sums->stencil.n * m * m;
        else own_block (w->b, i, &s, 1, grows, sum);
        w->out[i] = state + 2 * top_of (w->b, mass, P, &before) / mass[0];
    }
}

/* Upper bound of the largest angular frequency, 1/s, from the intact body: breaking bonds does not raise it,
 * except where weighted volumes follow the intact bonds, which dilatation_bound allows for. Each rank takes
 * its own points only, as ghosts may lack bonds. */
pg_status bond_force_omega (const bond_force *b, double *omega)
{
    pg_status status = PG_OK;
    double top = 0, *mass = NULL;
    for (size_t m = 0; m < b->problem->nmaterial; m++)
        if (!(b->problem->material[m].density > 0))
            return pg_error (PG_E_USAGE, PG_HERE, "material %s has no density: there is no frequency",
                             b->problem->material[m].name);
    PG_ALLOC (mass, b->n * (size_t) b->stride);
    bond_force_masses (b, mass);
    pg_parallel (b->threads, b->n, bound_points, &(job) { b, b->work, mass });
    for (size_t i = 0; i < b->n; i++)
        if (pg_cloud_owns (&b->problem->cloud, i)) top = fmax (top, b->work[i]);
    *omega = sqrt (top);
done:
    pg_free (mass);
    return status;
}

pg_status bond_force_bound (void *self, double *omega)
{
    bond_force *b = self;
    if (!b->problem->plain) find_whole (b);
    return bond_force_omega (b, omega);
}

/* ---- the matrix ---------------------------------------------------------------------------------------- */
/* Counts the bonds of point i to points j < i, which are in its columns of the upper triangle. */
static size_t lower (const bond_force *b, size_t i)
{
    size_t at = b->family->start[i], first = at;
    while (at < b->family->start[i + 1] && (size_t) b->family->node[at] < i) at++;
    return at - first;
}

/* Makes the pattern of the upper triangle, column by column: every bond once, broken ones too, so that the
 * pattern stays the same. */
static pg_status create_matrix (bond_force *b)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->stride, nnz = 0;
    for (size_t i = 0; i < b->n; i++) nnz += lower (b, i) * dim * dim + dim * (dim + 1) / 2;
    PG_TRY (pg_sparse_create (&b->K, b->n * dim, b->n * dim, nnz, 1));
    long at = 0;
    for (size_t i = 0; i < b->n; i++) {
        size_t below = lower (b, i);
        const int *node = b->family->node + b->family->start[i];
        for (size_t c = 0; c < dim; c++) {
            for (size_t e = 0; e < below; e++)
                for (size_t a = 0; a < dim; a++) b->K.row[at++] = (long) ((size_t) node[e] * dim + a);
            for (size_t a = 0; a <= c; a++) b->K.row[at++] = (long) (i * dim + a);
            b->K.start[i * dim + c + 1] = at;
        }
    }
    b->stale.all = 1;
done:
    if (status != PG_OK) pg_sparse_clear (&b->K);
    return status;
}

/* Computes the columns that are out of date of points first .. last - 1; broken bonds become zeros, as the
 * pattern stays. */
static void make_columns (void *context, size_t first, size_t last, int thread)
{
    const job *w = context;
    const bond_force *b = w->b;
    size_t m = (size_t) b->stride;
    point_bonds s;
    double D[MOST], own[MOST], other[MOST];
    for (size_t i = first; i < last; i++) {
        if (!b->stale.all && !b->stale.column[i]) continue;
        point_bonds_at (b, i, thread, &s);
        own_block (b, i, &s, 0, 0, D);
        size_t below = lower (b, i);
        /* `other` is the block in row i, column j; its transpose goes to column i, row j < i. */
        for (size_t e = 0; e < below; e++) {
            memset (other, 0, sizeof other);
            if (bond_force_lives (b, s.first + e)) b->theory->blocks (b, i, &s, e, own, other);
            for (size_t c = 0; c < m; c++)
                for (size_t a = 0; a < m; a++)
                    b->K.value[b->K.start[i * m + c] + (long) (e * m + a)] = other[c * m + a];
        }
        for (size_t c = 0; c < m; c++)
            for (size_t a = 0; a <= c; a++)
                b->K.value[b->K.start[i * m + c] + (long) (below * m + a)] = D[a * m + c];
    }
}

/* Assembles K; only columns of points that lost a bond are computed again. */
static pg_status assemble (bond_force *b)
{
    pg_status status = PG_OK;
    if (!b->K.row) PG_TRY (create_matrix (b));
    job w = { b, NULL, NULL };
    pg_parallel (b->threads, b->n, make_columns, &w);
    b->stale.all = 0;
    memset (b->stale.column, 0, b->n);
done:
    return status;
}

/* pg_force_type.matrix: with dilatations, which couple neighbours of neighbours, there is none (*K NULL). */
pg_status bond_force_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    *K = NULL;
    if (b->dilatation) return PG_OK;
    if (want == PG_MATRIX_ASSEMBLED) PG_TRY (assemble (b));
    if (want == PG_MATRIX_FREED) pg_sparse_clear (&b->K);
    *K = &b->K;
done:
    return status;
}
