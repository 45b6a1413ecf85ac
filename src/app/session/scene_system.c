/* SPDX-License-Identifier: GPL-3.0-or-later
 * The linear system of a scene as matrices and vectors that belong to the caller: copies of those of the
 * problem's force. The force is created anew for that, so that a run that uses the problem is not
 * disturbed. */
#include "perigal/session.h"
#include <math.h>
#include <string.h>

/* share of the mean diagonal below which an unknown has no stiffness */
static const double nothing = 1e-12;

/* Copies a matrix. */
static pg_status copy_matrix (pg_sparse *out, const pg_sparse *A)
{
    pg_status status = PG_OK;
    size_t nnz = (size_t) A->start[A->ncol];
    PG_TRY (pg_sparse_create (out, A->nrow, A->ncol, nnz, A->symmetric));
    memcpy (out->start, A->start, (A->ncol + 1) * sizeof *A->start);
    memcpy (out->row, A->row, nnz * sizeof *A->row);
    memcpy (out->value, A->value, nnz * sizeof *A->value);
done:
    return status;
}

/* ---- constraints --------------------------------------------------------------------------------------- */
/* Marks with 1 the unknowns that have no stiffness (diagonal of K about zero). */
static pg_status find_idle (unsigned char **out, const pg_sparse *K)
{
    pg_status status = PG_OK;
    double *d = NULL, mean = 0;
    pg_sparse borrowed = *K;
    pg_operator op = pg_sparse_operator (&borrowed);
    PG_ALLOC (d, K->ncol);
    PG_ALLOC (*out, K->ncol);
    op.diagonal (op.context, d);
    for (size_t j = 0; j < K->ncol; j++) mean += d[j] / (double) K->ncol;
    for (size_t j = 0; j < K->ncol; j++) (*out)[j] = !(d[j] > nothing * mean);
done:
    pg_free (d);
    return status;
}

/* 1: all unknowns in column j of the basis T are idle. */
static int moves_idle (const pg_sparse *T, size_t j, const unsigned char *idle)
{
    for (long p = T->start[j]; p < T->start[j + 1]; p++) if (!idle[T->row[p]]) return 0;
    return 1;
}

/* Copies T (NULL: the identity) without the columns of idle unknowns. */
static pg_status copy_basis (pg_equations *e, const pg_sparse *T, const unsigned char *idle)
{
    pg_status status = PG_OK;
    size_t ncol = T ? T->ncol : e->n, nnz = T ? (size_t) T->start[T->ncol] : e->n, kept = 0;
    long at = 0;
    PG_TRY (pg_sparse_create (&e->T, e->n, ncol, nnz, 0));
    for (size_t j = 0; j < ncol; j++) {
        if (T ? moves_idle (T, j, idle) : idle[j]) {
            e->idle++;
            continue;
        }
        for (long p = T ? T->start[j] : 0; p < (T ? T->start[j + 1] : 1); p++, at++)
            e->T.row[at] = T ? T->row[p] : (long) j, e->T.value[at] = T ? T->value[p] : 1;
        e->T.start[++kept] = at;
    }
    e->T.ncol = kept;
done:
    return status;
}

/* If every column of T selects one unknown, sets `selects` and lists these unknowns in `free`. */
static pg_status list_free (pg_equations *e)
{
    pg_status status = PG_OK;
    e->selects = 1;
    for (size_t j = 0; j < e->T.ncol && e->selects; j++)
        e->selects = e->T.start[j + 1] == e->T.start[j] + 1 && e->T.value[e->T.start[j]] == 1;
    PG_ALLOC (e->free, e->selects ? e->T.ncol : 0);
    for (size_t j = 0; e->selects && j < e->T.ncol; j++) e->free[j] = (size_t) e->T.row[e->T.start[j]];
done:
    return status;
}

/* ---- displacement of the points ------------------------------------------------------------------------ */
/* Makes N for unknowns that are the displacements themselves: it picks them and leaves out rotations. */
static pg_status take_displacements (pg_equations *e, size_t n)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) e->dim, stride = (size_t) e->unknowns;
    long at = 0;
    PG_TRY (pg_sparse_create (&e->N, n * dim, e->n, n * dim, 0));
    for (size_t j = 0; j < e->n; j++) {
        if (j % stride < dim) {
            e->N.row[at] = (long) (j / stride * dim + j % stride), e->N.value[at] = 1;
            at++;
        }
        e->N.start[j + 1] = at;
    }
done:
    return status;
}

/* Makes N from the shape functions at nodes, by columns: entry (point, node), equal for every component.
 * Columns of a node follow each other; points ascend, and so do the rows of every column. */
static pg_status take_values (pg_equations *e, const pg_rows *rows)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) e->dim, bonds = rows->family.start[rows->n];
    const int *node = rows->family.node;
    long *next = NULL;                                 /* next free entry of each column */
    PG_TRY (pg_sparse_create (&e->N, rows->n * dim, e->n, bonds * dim, 0));
    PG_ALLOC (next, e->n);
    for (size_t b = 0; b < bonds; b++)
        for (size_t c = 0; c < dim; c++) e->N.start[(size_t) node[b] * dim + c + 1]++;
    for (size_t j = 0; j < e->n; j++) e->N.start[j + 1] += next[j] = e->N.start[j];
    for (size_t p = 0; p < rows->n; p++)
        for (size_t b = rows->family.start[p]; b < rows->family.start[p + 1]; b++)
            for (size_t c = 0; c < dim; c++) {
                long to = next[(size_t) node[b] * dim + c]++;
                e->N.row[to] = (long) (p * dim + c), e->N.value[to] = rows->N[b + pg_rows_offset (rows, p)];
            }
done:
    pg_free (next);
    return status;
}

/* Makes N from shape functions evaluated as the force does: with the intact bonds only. */
static pg_status evaluate_nodes (pg_equations *e, const pg_problem *p, const pg_state *state)
{
    pg_status status = PG_OK;
    pg_rows rows = p->bonds.rows[PG_NODES];                  /* positions and families are borrowed */
    rows.N = rows.dN = rows.w = NULL, rows.at = NULL, rows.grade = NULL;
    PG_TRY (pg_rows_values (&rows));
    PG_TRY (p->form.approx.type->evaluate (&p->form.approx, &p->cloud, &rows,
                                           state->alive + p->bonds.first[PG_NODES], rows.n, NULL,
                                           p->threads));
    PG_TRY (take_values (e, &rows));
done:
    pg_free (rows.N), pg_free (rows.dN), pg_free (rows.w), pg_free (rows.at), pg_free (rows.grade);
    return status;
}

/* ---- the whole system ---------------------------------------------------------------------------------- */
/* Takes the load vector f and the prescribed values g at load factor or time t. */
static pg_status take_vectors (pg_equations *e, const pg_force_type *force, void *self, double t)
{
    pg_status status = PG_OK;
    double reference, *zero = NULL;
    PG_ALLOC (e->f, e->n);
    PG_ALLOC (e->g, e->n);
    PG_ALLOC (zero, e->n);
    PG_TRY (force->balance (self, t, zero, e->f, &reference));
    if (force->impose && force->basis && force->basis (self)) PG_TRY (force->impose (self, t, e->g));
done:
    pg_free (zero);
    return status;
}

/* Number of unknowns of a point, rotations included. */
static int count_unknowns (const pg_force_type *force, const void *self)
{
    pg_field field[8];
    size_t n = force->fields (self, 8, field);
    int sum = 0;
    for (size_t k = 0; k < n && k < 8; k++) sum += field[k].components;
    return sum;
}

static pg_status fill (pg_equations *e, const pg_problem *p, const pg_state *state,
                       const pg_force_type *force, void *self, double t)
{
    pg_status status = PG_OK;
    unsigned char *idle = NULL;
    const pg_sparse *K;
    if (force->refresh) PG_TRY (force->refresh (self, state, NULL));
    PG_TRY (pg_force_assemble (force, self, &K));
    PG_TRY (copy_matrix (&e->K, K));
    PG_TRY (find_idle (&idle, &e->K));
    PG_TRY (copy_basis (e, force->basis ? force->basis (self) : NULL, idle));
    PG_TRY (list_free (e));
    PG_TRY (take_vectors (e, force, self, t));
    if (force->surfaces.at_nodes) PG_TRY (evaluate_nodes (e, p, state));
    else PG_TRY (take_displacements (e, p->cloud.n));
done:
    pg_free (idle);
    return status;
}

pg_status pg_equations_create (pg_equations *out, const pg_problem *problem, const pg_state *state, double t)
{
    pg_status status = PG_OK;
    const pg_force_type *force = pg_force_of (problem);
    void *self = NULL;
    pg_state *start = NULL;
    *out = (pg_equations) { .dim = problem->dim };
    if (!isfinite (t)) PG_FAIL (PG_E_USAGE, "the load factor or time is %g", t);
    if (problem->boundary.nplaten)
        PG_FAIL (PG_E_USAGE, "a body between platens has no linear system: contact decides what bears");
    PG_TRY (force->create (&self, problem));
    if (!pg_force_matrix (force, self))
        PG_FAIL (PG_E_USAGE,
                 "%s reaches the neighbours of neighbours and has no matrix: take a force without "
                 "dilatation, or run the scene", force->method.name);
    out->unknowns = count_unknowns (force, self);
    out->n = problem->cloud.n * (size_t) out->unknowns;
    if (!state) PG_TRY (pg_state_create (&start, problem, out->unknowns));
    PG_TRY (fill (out, problem, state ? state : start, force, self, t));
done:
    if (self) force->free (&self);
    pg_state_free (&start);
    if (status != PG_OK) pg_equations_clear (out);
    return status;
}

void pg_equations_clear (pg_equations *e)
{
    pg_sparse_clear (&e->K), pg_sparse_clear (&e->T), pg_sparse_clear (&e->N);
    pg_free (e->f), pg_free (e->g), pg_free (e->free);
    *e = (pg_equations) { 0 };
}
