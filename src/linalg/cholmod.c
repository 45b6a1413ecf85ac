/* SPDX-License-Identifier: GPL-3.0-or-later
 * Supernodal Cholesky factorisation P K P' = L L' by CHOLMOD of SuiteSparse, 64-bit interface.
 *
 * Nodes are ordered, not unknowns: by AMD, or by METIS where that takes fewer operations. The ordering of
 * nodes is expanded to unknowns and given to CHOLMOD, and one analysis serves every later factorisation of
 * the same pattern.
 *
 * The forecast analyses the graph of the nodes alone: a column with c entries there stands for m columns of
 * the unknowns with m (c - 1) + m, ..., m (c - 1) + 1 entries; a column of e entries costs e^2 operations. */
#include "failed_row.h"
#include "supernodal.h"
#include <math.h>
#include <stdint.h>
#include <string.h>

/* State of the solver. */
typedef struct {
    cholmod_common common;
    cholmod_factor *L;
    /* Workspaces that CHOLMOD keeps between solves. */
    cholmod_dense *X, *Y, *E;
    const char *ordering;
    /* Predicted entries of L and operations of a factorisation. */
    double entries, flops;
    /* Smallest over largest pivot of the last factorisation. */
    double pivots;
    supernodal_solver few;
} chol;

/* CHOLMOD's handler of errors: prints nothing; callers check the status of CHOLMOD instead. */
static void quiet (int status, const char *file, int line, const char *message)
{
    (void) status, (void) file, (void) line, (void) message;
}

static void chol_free (void **self)
{
    chol *c = *self;
    if (!c) return;
    cholmod_l_free_factor (&c->L, &c->common);
    cholmod_l_free_dense (&c->X, &c->common);
    cholmod_l_free_dense (&c->Y, &c->common);
    cholmod_l_free_dense (&c->E, &c->common);
    cholmod_l_finish (&c->common);
    supernodal_clear (&c->few);
    pg_free (c);
    *self = NULL;
}

/* The matrix as CHOLMOD's structure, sharing the arrays; stype 1: upper triangle. */
static cholmod_sparse view (const pg_sparse *A)
{
    cholmod_sparse S = { 0 };
    S.nrow = A->nrow, S.ncol = A->ncol, S.nzmax = (size_t) A->start[A->ncol];
    S.p = A->start, S.i = A->row, S.x = A->value;
    S.stype = 1, S.itype = CHOLMOD_LONG, S.xtype = CHOLMOD_REAL, S.dtype = CHOLMOD_DOUBLE, S.sorted = 1,
    S.packed = 1;
    return S;
}

/* The pattern of the matrix as CHOLMOD's structure, sharing the arrays, without values. */
static cholmod_sparse pattern_of (const pg_sparse *A)
{
    cholmod_sparse S = view (A);
    S.xtype = CHOLMOD_PATTERN, S.x = NULL;
    return S;
}

/* Graph of the nodes, upper triangle, from the matrix of unknowns with `block` unknowns per node. */
static pg_status node_graph (pg_sparse *G, const pg_sparse *A, int block)
{
    pg_status status = PG_OK;
    size_t n = A->ncol / (size_t) block, nnz = 0;
    for (size_t I = 0; I < n; I++)
        nnz += (size_t) (A->start[I * (size_t) block + 1] - A->start[I * (size_t) block]);
    PG_TRY (pg_sparse_create (G, n, n, nnz, 1));
    nnz = 0;
    for (size_t I = 0; I < n; I++) {
        long last = -1;
        for (long p = A->start[I * (size_t) block]; p < A->start[I * (size_t) block + 1]; p++)
            if (A->row[p] / block != last) G->row[nnz++] = last = A->row[p] / block;
        G->start[I + 1] = (long) nnz;
    }
done:
    return status;
}

/* Operations of a factorisation of the graph in this order, counted without computing it. */
static double count_flops (chol *c, cholmod_sparse *graph, SuiteSparse_long *node)
{
    int before = c->common.supernodal;
    c->common.supernodal = CHOLMOD_SIMPLICIAL;
    cholmod_factor *L = cholmod_l_analyze_p (graph, node, NULL, 0, &c->common);
    double flops = L ? c->common.fl : INFINITY;
    cholmod_l_free_factor (&L, &c->common);
    c->common.supernodal = before;
    return flops;
}

/* Orders the nodes by METIS; 0: it failed. METIS raises SIGTERM for failures of its own and replaces the
 * handler of this signal meanwhile: signals from outside are held back until it is done. */
static int metis (chol *c, cholmod_sparse *graph, SuiteSparse_long *node)
{
    pg_signals before;
    pg_signals_hold (&before);
    int done = cholmod_l_metis (graph, NULL, 0, 1, node, &c->common);
    pg_signals_release (&before);
    return done;
}

/* Fills the permutation of the nodes of G: AMD's, or METIS's where that saves operations. METIS costs about
 * as much as 6000 operations of a factorisation for each entry of the graph (0.3 us at 20 GFLOP/s) and rarely
 * saves more than a sixth of them below some ten thousand unknowns; in slender bodies, and with the wide rows
 * of meshfree shape functions, AMD often is the better one: then it is only asked when that sixth is more
 * than its own cost, and has to be better by count. It counts in 32 bits where it was built so; a graph too
 * large for that stays with AMD. `unknowns`: of all nodes together; many: some twenty factorisations or more
 * will follow. */
static pg_status order_nodes (chol *c, const pg_sparse *G, size_t unknowns, int many,
                              SuiteSparse_long *node)
{
    pg_status status = PG_OK;
    cholmod_sparse S = pattern_of (G);
    SuiteSparse_long *other = NULL;
    double block = (double) unknowns / (double) G->ncol;
    c->ordering = "amd";
    if (!cholmod_l_amd (&S, NULL, 0, node, &c->common))
        PG_FAIL (PG_E_MEMORY, "%s could not order %zu nodes", c->ordering, G->ncol);
    /* AMD's own estimate, of the graph: blocks of m unknowns take m^3 times as many operations */
    double flops = block * block * block * c->common.fl;
    if (flops / 6 * (many ? 20 : 1) < 6000 * (double) G->start[G->ncol]) goto done;
    PG_ALLOC (other, G->ncol);
    if (!metis (c, &S, other)) {
        if (c->common.status == CHOLMOD_TOO_LARGE) goto done;
        PG_FAIL (PG_E_MEMORY, "metis could not order %zu nodes", G->ncol);
    }
    if (count_flops (c, &S, other) >= count_flops (c, &S, node)) goto done;
    memcpy (node, other, G->ncol * sizeof *node);
    c->ordering = "metis";
done:
    pg_free (other);
    return status;
}

/* Permutation of the unknowns: that of the nodes, the unknowns of a node together. */
static pg_status order (chol *c, const pg_sparse *A, const pg_linear_options *o, SuiteSparse_long *perm)
{
    pg_status status = PG_OK;
    pg_sparse G = { 0 };
    SuiteSparse_long *node = NULL;
    int block = o->block > 0 && A->ncol % (size_t) o->block == 0 ? o->block : 1;
    PG_TRY (node_graph (&G, A, block));
    PG_ALLOC (node, G.ncol);
    PG_TRY (order_nodes (c, &G, A->ncol, o->many, node));
    for (size_t k = 0; k < G.ncol; k++)
        for (int a = 0; a < block; a++) perm[k * (size_t) block + (size_t) a] = node[k] * block + a;
done:
    pg_sparse_clear (&G);
    pg_free (node);
    return status;
}

/* Starts CHOLMOD with a given ordering only. */
static void start (chol *c, int supernodal)
{
    cholmod_l_start (&c->common);
    c->common.error_handler = quiet;
    c->common.print = 0;
    c->common.supernodal = supernodal;
    c->common.nmethods = 1;
    c->common.method[0].ordering = CHOLMOD_GIVEN;
    c->common.postorder = 1;
}

/* Ordering and symbolic factorisation. PG_E_MEMORY also where the problem is too large for the integers. */
static pg_status chol_analyse (void **self, const pg_sparse *A, const pg_linear_options *options)
{
    pg_status status = PG_OK;
    chol *c = NULL;
    SuiteSparse_long *perm = NULL;
    PG_TRY (pg_cholmod_load ());
    PG_ALLOC (c, 1);
    *self = c;
    start (c, CHOLMOD_SUPERNODAL);
    PG_ALLOC (perm, A->ncol);
    PG_TRY (order (c, A, options, perm));
    cholmod_sparse S = view (A);
    c->L = cholmod_l_analyze_p (&S, perm, NULL, 0, &c->common);
    if (!c->L) PG_FAIL (PG_E_MEMORY, "the symbolic analysis of %zu unknowns failed (%s)", A->ncol,
                        c->common.status == CHOLMOD_TOO_LARGE ? "too large" : "no memory");
    c->entries = c->common.lnz, c->flops = c->common.fl;
done:
    pg_free (perm);
    if (status != PG_OK) chol_free (self);
    return status;
}

/* Simplicial analysis, because only the column counts are wanted. */
pg_status pg_linear_forecast (const pg_sparse *graph, int block, int many, pg_linear_info *info)
{
    pg_status status = PG_OK;
    void *self = NULL;
    chol *c = NULL;
    SuiteSparse_long *perm = NULL;
    double m = block;
    PG_TRY (pg_cholmod_load ());
    PG_ALLOC (c, 1);
    self = c;
    start (c, CHOLMOD_SIMPLICIAL);
    PG_ALLOC (perm, graph->ncol);
    PG_TRY (order_nodes (c, graph, graph->ncol * (size_t) block, many, perm));
    cholmod_sparse S = pattern_of (graph);
    c->L = cholmod_l_analyze_p (&S, perm, NULL, 0, &c->common);
    if (!c->L) PG_FAIL (PG_E_MEMORY, "no memory for the symbolic analysis of %zu nodes", graph->ncol);
    const SuiteSparse_long *count = c->L->ColCount;
    *info = (pg_linear_info) { .ordering = c->ordering };
    /* Columns of the unknowns from columns of the nodes. */
    for (size_t k = 0; k < graph->ncol; k++)
        for (int a = 1; a <= block; a++) {
            double entries = m * ((double) count[k] - 1) + a;
            info->factor_entries += entries, info->flops += entries * entries;
        }
done:
    pg_free (perm);
    if (self) chol_free (&self);
    return status;
}

/* Checks the outcome of a factorization of n unknowns. A pivot that is not positive is reported with its
 * unknown in the numbering of the matrix. */
static pg_status judge (chol *c, size_t n)
{
    pg_status status = PG_OK;
    /* minor: the first column that could not be factored, in the permuted numbering. */
    if (c->common.status == CHOLMOD_NOT_POSDEF || (c->common.status >= 0 && c->L->minor < n)) {
        SuiteSparse_long *perm = c->L->Perm;
        long failed_row = (long) (c->L->minor < n ? perm[c->L->minor] : 0);
        linear_failed_at (failed_row);
        PG_FAIL (PG_E_NOT_SPD, "the stiffness matrix is not positive definite at unknown %ld of %zu",
                 failed_row, n);
    }
    if (c->common.status < 0)
        PG_FAIL (PG_E_MEMORY, "the factorization needs %.3g MB and failed (CHOLMOD status %d)",
                 c->entries * 8e-6, c->common.status);
    c->pivots = cholmod_l_rcond (c->L, &c->common);
done:
    return status;
}

static pg_status chol_factor (void *self, const pg_sparse *A)
{
    chol *c = self;
    cholmod_sparse S = view (A);
    cholmod_l_factorize (&S, c->L, &c->common);
    return judge (c, A->ncol);
}

/* Takes the two steps of cholmod_l_factorize one by one, so that A can be freed between them: a copy of A in
 * the order of the factor, lower triangle, then the factor of this copy. */
static pg_status chol_factor_taking (void *self, const pg_sparse *A, void (*taken) (void *), void *context)
{
    pg_status status = PG_OK;
    chol *c = self;
    size_t n = A->ncol;
    cholmod_sparse S = view (A), *own = NULL;
    double none[2] = { 0, 0 };                         /* CHOLMOD adds none[0] to the diagonal */
    if (!c->L->is_super) return chol_factor (self, A);
    own = cholmod_l_ptranspose (&S, 2, c->L->Perm, NULL, 0, &c->common);
    if (!own) PG_FAIL (PG_E_MEMORY, "no memory for a matrix of %zu entries", S.nzmax);
    taken (context);
    cholmod_l_super_numeric (own, NULL, none, c->L, &c->common);
    cholmod_l_free_sparse (&own, &c->common);
    status = judge (c, n);
done:
    return status;
}

/* Solves for all right-hand sides at once. */
static pg_status chol_solve (void *self, size_t nrhs, const double *b, double *x)
{
    pg_status status = PG_OK;
    chol *c = self;
    size_t n = c->L->n;
    cholmod_dense B = { 0 };
    /* CHOLMOD only reads B, but its struct has one kind of pointer for what it reads and what it writes. */
    B.nrow = n, B.ncol = nrhs, B.nzmax = n * nrhs, B.d = n, B.x = (void *) (uintptr_t) b;
    B.xtype = CHOLMOD_REAL, B.dtype = CHOLMOD_DOUBLE;
    if (!cholmod_l_solve2 (CHOLMOD_A, c->L, &B, NULL, &c->X, NULL, &c->Y, &c->E, &c->common))
        PG_FAIL (PG_E_MEMORY, "no memory for a solve with %zu right-hand sides", nrhs);
    memcpy (x, c->X->x, n * nrhs * sizeof *x);
done:
    return status;
}

static pg_status chol_solve_few (void *self, size_t nrhs, const double *b, double *x)
{
    chol *c = self;
    return c->L->is_super && c->L->xtype == CHOLMOD_REAL ? supernodal_solve_few (c->L, &c->few, nrhs, b, x)
                                                         : chol_solve (self, nrhs, b, x);
}

static pg_status chol_half_few (void *self, size_t nrhs, const double *b, double *const *y, size_t *count,
                                const size_t **first)
{
    pg_status status = PG_OK;
    chol *c = self;
    if (!c->L->is_super || c->L->xtype != CHOLMOD_REAL)
        PG_FAIL (PG_E_USAGE, "half solves need a supernodal factor");
    PG_TRY (supernodal_half_few (c->L, &c->few, nrhs, b, y, count, first));
done:
    return status;
}

static void chol_info (const void *self, pg_linear_info *info)
{
    const chol *c = self;
    *info = (pg_linear_info) { c->ordering, c->entries, c->flops, 0, c->pivots, c->few.half_flops };
}

const pg_linear_type pg_linear_cholmod = {
    "cholmod", "supernodal Cholesky factorization (SuiteSparse CHOLMOD)", 1, 1,
    chol_analyse, chol_factor, chol_solve, chol_solve_few, chol_half_few,
    chol_info, chol_free, chol_factor_taking
};
