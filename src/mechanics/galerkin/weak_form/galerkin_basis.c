/* SPDX-License-Identifier: GPL-3.0-or-later
 * Essential conditions by transformation (theory E6): at the prescribed nodes sum_J N_J(x_s) d_J = g, solved
 * for the slaves,
 *   d_s = C_s^-1 (g - C_m d_m), d = T d_m + ..., T = [ -C_s^-1 C_m ; I ] per component; K is reduced to T' K
 *       T. */
#include "galerkin.h"
#include <string.h>

/* Frees the elimination of prescribed nodes and T, which may both be empty. */
void galerkin_basis_free (galerkin *g)
{
    for (int k = 0; k < 3; k++) {
        elimination *e = &g->supports.side[k];
        pg_free (e->slave), pg_free (e->load), pg_free (e->master), pg_free (e->inverse), pg_free (e->X);
        memset (e, 0, sizeof *e);
    }
    pg_sparse_clear (&g->supports.T);
}

/* Finds the points whose displacement along axis k is prescribed by elimination (slaves), ascending, each
 * with the load that prescribes it. role (n): that load's number at these points, -1 at all others. Where
 * several loads prescribe a point the first one of the scene counts. */
static pg_status find_slaves (galerkin *g, int k, int *role)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    elimination *e = &g->supports.side[k];
    size_t cap = 0, cap_load = 0;
    e->component = k;
    for (size_t i = 0; i < g->n; i++) role[i] = -1;
    for (size_t l = p->boundary.nload; l-- > 0;) {              /* the first load wins */
        const pg_load *load = &p->boundary.load[l];
        if (!pg_load_prescribes (load) || !load->value[k] || load->essential != PG_ESSENTIAL_TRANSFORMATION)
            continue;
        for (size_t i = 0; i < load->set->npoint; i++) role[load->set->point[i]] = (int) l;
    }
    for (size_t i = 0; i < g->n; i++) {
        if (role[i] < 0) continue;
        PG_GROW (e->slave, cap, e->n + 1);
        PG_GROW (e->load, cap_load, e->n + 1);
        e->slave[e->n] = (int) i, e->load[e->n++] = role[i];
    }
done:
    return status;
}

/* Finds the masters: nodes in the families of slaves that are no slaves themselves; none where shape
 * functions interpolate (N is the identity, NOSB), as slaves take their values directly then. The inverse of
 * C_s is full, hence the limit on the number of slaves. role: of slaves their load, of others -1, set to -2
 * for masters. */
static pg_status find_masters (galerkin *g, int k, int *role)
{
    pg_status status = PG_OK;
    elimination *e = &g->supports.side[k];
    const pg_family *f = &g->rows[PG_NODES].family;
    size_t cap = 0;
    if (g->problem->form.approx.type->interpolates) goto done;
    if (e->n > PG_MOST_ELIMINATED)
        PG_FAIL (PG_E_LIMIT,
                 "essential: transformation of %zu points in one direction needs too much memory (at most "
                 "%d): use penalty",
                 e->n, PG_MOST_ELIMINATED);
    for (size_t s = 0; s < e->n; s++)
        for (size_t q = f->start[e->slave[s]]; q < f->start[e->slave[s] + 1]; q++)
            if (role[f->node[q]] == -1) role[f->node[q]] = -2;
    for (size_t i = 0; i < g->n; i++) {
        if (role[i] != -2) continue;
        PG_GROW (e->master, cap, e->nmaster + 1);
        e->master[e->nmaster++] = (int) i;
    }
    PG_ALLOC (e->inverse, e->n * e->n);
    PG_ALLOC (e->X, e->n * e->nmaster);
done:
    return status;
}

/* Makes the matrix T: a column for each free unknown, ascending, with 1 in its own row and, for masters, the
 * entries -X of all slaves of the same component. The pattern is fixed for the run; values change with the
 * bonds (fill_T). */
static pg_status make_T (galerkin *g)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) g->dim, ndof = g->n * dim, nnz = ndof, nslave = 0;
    char *slave = NULL;
    long *column = NULL;
    pg_sparse *T = &g->supports.T;
    PG_ALLOC (slave, ndof);
    PG_ALLOC (column, ndof);
    for (size_t k = 0; k < dim; k++) {
        const elimination *e = &g->supports.side[k];
        nnz += e->n * e->nmaster, nslave += e->n;
        for (size_t s = 0; s < e->n; s++) slave[(size_t) e->slave[s] * dim + k] = 1;
    }
    PG_TRY (pg_sparse_create (T, ndof, ndof - nslave, nnz - nslave, 0));
    long at = 0, col = 0;
    for (size_t i = 0; i < ndof; i++) {
        if (slave[i]) continue;
        const elimination *e = &g->supports.side[i % dim];
        int is_master = 0;
        for (size_t m = 0; m < e->nmaster && !is_master; m++) is_master = (size_t) e->master[m] == i / dim;
        size_t s = 0;
        for (; is_master && s < e->n && (size_t) e->slave[s] < i / dim; s++)
            T->row[at++] = (long) ((size_t) e->slave[s] * dim + i % dim);
        T->value[at] = 1;
        T->row[at++] = (long) i;
        for (; is_master && s < e->n; s++)
            T->row[at++] = (long) ((size_t) e->slave[s] * dim + i % dim);
        T->start[++col] = at;
    }
done:
    pg_free (slave), pg_free (column);
    return status;
}

/* Writes -X = -C_s^-1 C_m into T. In the column of a master its own entry, 1, stands among those of the
 * slaves, ordered by row. */
static void fill_T (galerkin *g)
{
    size_t dim = (size_t) g->dim;
    pg_sparse *T = &g->supports.T;
    for (size_t c = 0; c < T->ncol; c++) {
        if (T->start[c + 1] - T->start[c] == 1) continue;
        size_t k = (size_t) T->row[T->start[c]] % dim, m = 0, s = 0;
        const elimination *e = &g->supports.side[k];
        long own = -1;
        /* finds the unit entry, in the master's own row */
        for (long q = T->start[c]; own < 0; q++) if (T->value[q] == 1) {
            size_t node = (size_t) T->row[q] / dim;
            for (m = 0; m < e->nmaster && (size_t) e->master[m] != node; m++) continue;
            if (m < e->nmaster) own = q;
        }
        for (long q = T->start[c]; q < T->start[c + 1]; q++)
            if (q != own) T->value[q] = -e->X[s++ * e->nmaster + m];
    }
}

/* Finds slaves and masters of each component; has_T: there is something to eliminate. */
pg_status galerkin_basis_create (galerkin *g)
{
    pg_status status = PG_OK;
    int *role = NULL;
    size_t slaves = 0;
    PG_ALLOC (role, g->n);
    for (int k = 0; k < g->dim; k++) {
        PG_TRY (find_slaves (g, k, role));
        PG_TRY (find_masters (g, k, role));
        slaves += g->supports.side[k].n;
    }
    g->supports.has_T = slaves > 0;
    if (g->supports.has_T) PG_TRY (make_T (g));
done:
    pg_free (role);
    return status;
}

/* C: the transpose of C_s, the shape functions of slaves at slaves, in compressed columns: column j is row j
 * of C_s. index (n): position of a slave among the slaves, -1 of all others. */
static pg_status slave_matrix (const galerkin *g, const elimination *e, const int *index, pg_sparse *C)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_NODES];
    size_t nnz = 0;
    for (size_t s = 0; s < e->n; s++) nnz += r->family.start[e->slave[s] + 1] - r->family.start[e->slave[s]];
    PG_TRY (pg_sparse_create (C, e->n, e->n, nnz, 0));
    nnz = 0;
    for (size_t s = 0; s < e->n; s++) {                /* column s holds row s of C_s: this is C_s' */
        size_t offset = pg_rows_offset (r, (size_t) e->slave[s]);
        for (size_t q = r->family.start[e->slave[s]]; q < r->family.start[e->slave[s] + 1]; q++) {
            if (index[r->family.node[q]] < 0) continue;
            C->row[nnz] = index[r->family.node[q]];
            C->value[nnz++] = r->N[q + offset];
        }
        C->start[s + 1] = (long) nnz;
    }
done:
    return status;
}

/* Computes the inverse of C_s (row by row, by a sparse factor) and X = C_s^-1 C_m of one component for the
 * bonds that are intact now. C_s is neither symmetric nor definite: the solver is the first that takes
 * general matrices. */
static pg_status update_side (galerkin *g, elimination *e, int *index)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_NODES];
    const pg_linear_type *lu = pg_linear_first (0, 1);
    pg_sparse C = { 0 };
    void *solver = NULL;
    double *unit = NULL;
    if (e->n == 0 || !e->inverse) goto done;
    for (size_t i = 0; i < g->n; i++) index[i] = -1;
    for (size_t s = 0; s < e->n; s++) index[e->slave[s]] = (int) s;
    PG_TRY (slave_matrix (g, e, index, &C));
    PG_TRY (lu->analyse (&solver, &C, &(pg_linear_options) { 1, g->dim, g->threads, 0, 0 }));
    PG_TRY (lu->factor (solver, &C));
    PG_ALLOC (unit, e->n);
    for (size_t s = 0; s < e->n; s++) {                /* column s of C_s'^-1 is row s of C_s^-1 */
        unit[s] = 1;
        PG_TRY (lu->solve (solver, 1, unit, e->inverse + s * e->n));
        unit[s] = 0;
    }
    for (size_t m = 0; m < e->nmaster; m++) index[e->master[m]] = (int) (e->n + m);
    memset (e->X, 0, e->n * e->nmaster * sizeof *e->X);
    for (size_t j = 0; j < e->n; j++)
        for (size_t q = r->family.start[e->slave[j]]; q < r->family.start[e->slave[j] + 1]; q++) {
            int at = index[r->family.node[q]] - (int) e->n;
            double N = r->N[q + pg_rows_offset (r, (size_t) e->slave[j])];
            if (at < 0 || N == 0) continue;
            for (size_t s = 0; s < e->n; s++)
                e->X[s * e->nmaster + (size_t) at] += e->inverse[s * e->n + j] * N;
        }
done:
    if (solver) lu->free (&solver);
    pg_sparse_clear (&C);
    pg_free (unit);
    return status;
}

/* Updates all components, then T. A singular C_s means that the shape functions cannot take the prescribed
 * values: the message names other methods. */
pg_status galerkin_basis_update (galerkin *g)
{
    pg_status status = PG_OK;
    int *index = NULL;
    if (!g->supports.has_T) return PG_OK;
    PG_ALLOC (index, g->n);
    for (int k = 0; k < g->dim; k++) {
        status = update_side (g, &g->supports.side[k], index);
        if (status == PG_E_MEMORY) goto done;
        if (status != PG_OK)
            PG_FAIL (PG_E_SINGULAR,
                     "essential: transformation of component %c failed (%s): use nitsche or penalty",
                     "xyz"[k], pg_last_error ());
    }
    fill_T (g);
done:
    pg_free (index);
    return status;
}

/* 1: T changes with the shape functions of one of the listed nodes (ascending); never where these
 * interpolate. */
int galerkin_basis_touched (const galerkin *g, size_t count, const size_t *list)
{
    for (int k = 0; k < g->dim; k++) {
        const elimination *e = &g->supports.side[k];
        size_t s = 0;
        for (size_t i = 0; i < count && e->inverse; i++) {  /* both lists are ascending */
            while (s < e->n && (size_t) e->slave[s] < list[i]) s++;
            if (s < e->n && (size_t) e->slave[s] == list[i]) return 1;
        }
    }
    return 0;
}

/* NULL: every unknown is free. */
const pg_sparse *galerkin_basis (void *self)
{
    galerkin *g = self;
    return g->supports.has_T ? &g->supports.T : NULL;
}

/* What the load prescribes at slave s, m, at time t (s; quasi-static: the load factor). */
static double goal_of (const galerkin *g, const elimination *e, size_t s, double t)
{
    double at[3];
    return pg_load_value (&g->problem->boundary.load[e->load[s]], e->component, g->dim,
                          galerkin_place (g, PG_NODES, (size_t) e->slave[s], at), t);
}

/* d_s = C_s^-1 (g - C_m d_m): sets the slaves' coefficients so that the displacement there is the
 * prescribed one, whatever the masters are. */
pg_status galerkin_impose (void *self, double t, double *d)
{
    galerkin *g = self;
    size_t dim = (size_t) g->dim;
    for (size_t k = 0; k < dim; k++) {
        const elimination *e = &g->supports.side[k];
        for (size_t s = 0; s < e->n; s++) g->work[s] = goal_of (g, e, s, t);
        for (size_t s = 0; s < e->n; s++) {
            double value = 0;
            if (!e->inverse) value = g->work[s];
            else for (size_t j = 0; j < e->n; j++) value += e->inverse[s * e->n + j] * g->work[j];
            for (size_t m = 0; m < e->nmaster; m++)
                value -= e->X[s * e->nmaster + m] * d[(size_t) e->master[m] * dim + k];
            d[(size_t) e->slave[s] * dim + k] = value;
        }
    }
    return PG_OK;
}

/* Support forces, N: the residual on the slaves is -C' lambda, so that lambda = -C_s^-T r_s; with the
 * prescribed displacements these are the pairs whose products are the work of the supports. `at`: where
 * the pairs of this part begin; returns where they end. */
size_t galerkin_basis_work_balance (galerkin *g, double t, const double *residual, pg_work_balance *out,
                                    size_t at)
{
    size_t dim = (size_t) g->dim;
    for (size_t k = 0; k < dim; k++) {
        const elimination *e = &g->supports.side[k];
        for (size_t s = 0; s < e->n; s++, at++) {
            double force = 0, place[3];
            if (!e->inverse) force = -residual[(size_t) e->slave[s] * dim + k];
            else
                for (size_t j = 0; j < e->n; j++)
                    force -= e->inverse[j * e->n + s] * residual[(size_t) e->slave[j] * dim + k];
            if (!pg_problem_owns (g->problem, PG_NODES, (size_t) e->slave[s])) force = 0;
            out->force[at] = force, out->displacement[at] = goal_of (g, e, s, t);
            out->reaction[e->load[s] * 3 + (int) k] += force;
            pg_load_add_moment (&g->problem->boundary.load[e->load[s]], g->dim,
                                galerkin_place (g, PG_NODES, (size_t) e->slave[s], place), (int) k, force,
                                out->reaction + 3 * (g->problem->boundary.nload + (size_t) e->load[s]));
        }
    }
    return at;
}
