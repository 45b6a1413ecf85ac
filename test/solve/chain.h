/* SPDX-License-Identifier: GPL-3.0-or-later
 * chain.h: masses in a row, springs between them, the first one prescribed or held by a spring, a load on the
 * last one: a force of our own for explicit and relaxed methods, of which everything is known in closed
 * form. */
#ifndef PERIGAL_TEST_CHAIN_H
#define PERIGAL_TEST_CHAIN_H
#include "check.h"
#include "perigal/solve.h"

enum { MOST = 400 };
typedef struct {
    size_t n;                                          /* masses */
    double k, ground, m;  /* springs, that to the ground at the first mass, mass */
    double (*push) (double t);                         /* load on the last mass; NULL: none */
    double (*lead) (double t);                         /* motion of the first mass; NULL: free */
    int tied;                                          /* basis that is no selection */
    pg_sparse T, K;
    long Tstart[MOST + 1], Trow[2 * MOST], Kstart[MOST + 1], Krow[2 * MOST];
    double Tvalue[2 * MOST], Kvalue[2 * MOST];
    pg_operator op;
} chain;
static chain the;

/* internal force on mass i, to be subtracted */
static double chain_pull (const chain *c, size_t i, const double *d)
{
    double f = i == 0 ? c->ground * d[0] : c->k * (d[i] - d[i - 1]);
    return i + 1 < c->n ? f - c->k * (d[i + 1] - d[i]) : f;
}
static void chain_apply (void *context, const double *x, double *y)
{
    for (size_t i = 0; i < the.n; i++) y[i] = chain_pull (context, i, x);
}
static void chain_diagonal (void *context, double *d)
{
    const chain *c = context;
    for (size_t i = 0; i < c->n; i++) d[i] = (i == 0 ? c->ground : c->k) + (i + 1 < c->n ? c->k : 0);
}
static pg_status chain_create (void **self, const pg_problem *problem)
{
    size_t n = the.n;
    (void) problem;
    the.op = (pg_operator) { n, &the, chain_apply, chain_diagonal };
    the.T = (pg_sparse){
        .nrow = n, .ncol = n - 1, .start = the.Tstart, .row = the.Trow, .value = the.Tvalue
    };
    the.K = (pg_sparse) { .nrow = n, .ncol = n, .start = the.Kstart, .row = the.Krow, .value = the.Kvalue };
    long at = 0;
    for (size_t j = 0; j + 1 < n; j++) {
        the.Tstart[j] = at;
        if (the.tied && j == 0) the.Trow[at] = 0, the.Tvalue[at++] = 0.5;
        the.Trow[at] = (long) j + 1, the.Tvalue[at++] = 1;
    }
    the.Tstart[n - 1] = at, at = 0;
    for (size_t j = 0; j < n; j++) {
        the.Kstart[j] = at;
        if (j > 0) the.Krow[at] = (long) j - 1, the.Kvalue[at++] = -the.k;
        the.Krow[at] = (long) j, the.Kvalue[at++] = (j == 0 ? the.ground : the.k) + (j + 1 < n ? the.k : 0);
    }
    the.Kstart[n] = at;
    *self = &the;
    return PG_OK;
}
static void chain_free (void **self) { *self = NULL; }
static size_t chain_fields (const void *self, size_t max, pg_field *out)
{
    (void) self;
    if (max) out[0] = (pg_field) { "displacement", "m", 1 };
    return 1;
}
static pg_status chain_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    const chain *c = self;
    double P = c->push ? c->push (t) : 0, size = P * P;
    for (size_t i = 0; i < c->n; i++) {
        residual[i] = -chain_pull (c, i, d);
        size = fmax (size, residual[i] * residual[i]);
    }
    residual[c->n - 1] += P;
    if (reference) *reference = sqrt (size);
    return PG_OK;
}
static pg_status chain_mass (void *self, double *mass, const pg_sparse **consistent)
{
    if (consistent) *consistent = NULL;
    for (size_t i = 0; mass && i < the.n; i++) mass[i] = ((const chain *) self)->m;
    return PG_OK;
}
static const pg_operator *chain_operator (void *self) { return &((chain *) self)->op; }
static pg_status chain_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    (void) want;
    *K = &((chain *) self)->K;
    return PG_OK;
}
static const pg_sparse *chain_basis (void *self) { return the.lead ? &((chain *) self)->T : NULL; }
static pg_status chain_impose (void *self, double t, double *d)
{
    if (the.lead) d[0] = ((chain *) self)->lead (t);
    return PG_OK;
}
static pg_status chain_work (void *self, double t, const double *d, const pg_known *known,
                             pg_work_balance *out)
{
    pg_status status = PG_OK;
    const chain *c = self;
    double r[MOST];
    if (!out->force) {
        out->npair = 2;
        PG_ALLOC (out->force, 2);
        PG_ALLOC (out->displacement, 2);
        PG_ALLOC (out->reaction, 3);
    }
    chain_balance (self, t, d, r, NULL);
    out->force[0] = c->lead ? -(r[0] + (known && known->inertia ? known->inertia[0] : 0)) : 0,
    out->displacement[0] = c->lead ? d[0] : 0;
    out->reaction[0] = out->force[0];
    out->force[1] = c->push ? c->push (t) : 0, out->displacement[1] = d[c->n - 1];
    out->strain = 0.5 * c->ground * d[0] * d[0];
    for (size_t i = 1; i < c->n; i++) out->strain += 0.5 * c->k * (d[i] - d[i - 1]) * (d[i] - d[i - 1]);
done:
    return status;
}
static pg_status chain_external (void *self, double t, double *P)
{
    const chain *c = self;
    memset (P, 0, c->n * sizeof *P);
    if (c->push) P[c->n - 1] = c->push (t);
    return PG_OK;
}
static pg_status chain_row_sums (void *self, double *sum)
{
    const chain *c = self;
    for (size_t i = 0; i < c->n; i++)
        sum[i] = (i == 0 ? c->ground : 2 * c->k) + (i + 1 < c->n ? 2 * c->k : 0);
    return PG_OK;
}
static const pg_force_type chain_type = { .method = { .name = "chain" },
                                          .create = chain_create,
                                          .free = chain_free,
                                          .fields = chain_fields,
                                          .balance = chain_balance,
                                          .mass = chain_mass,
                                          .operator_ = chain_operator,
                                          .matrix = chain_matrix,
                                          .basis = chain_basis,
                                          .impose = chain_impose,
                                          .work = chain_work,
                                          .loads = chain_external,
                                          .motion.row_sums = chain_row_sums };

/* ---- a problem around it ------------------------------------------------------------------------------- */
typedef struct {
    double x[MOST], volume[MOST]; int block[MOST];
    pg_load load; pg_set set; pg_material material; pg_criterion none;
    pg_problem problem; pg_solver *solver; pg_state *state;
} linked;

static inline pg_status try_link (linked *l, const pg_solver_options *o, const pg_force_type *type)
{
    pg_status status = PG_OK;
    memset (l, 0, sizeof *l);
    for (size_t i = 0; i < the.n; i++) l->x[i] = (double) i, l->volume[i] = 1;
    l->load.set = &l->set;
    l->load.kind = the.lead ? PG_DISPLACEMENT : PG_POINT_FORCE;
    l->load.essential = PG_ESSENTIAL_TRANSFORMATION;
    if (the.push) l->load.kind = PG_POINT_FORCE;
    l->problem = (pg_problem){
        .dim = 1,
        .threads = 1,
        .cloud = { .dim = 1, .n = the.n, .x = l->x, .volume = l->volume, .block = l->block, .h = 1 },
        .criterion = &l->none,
        .material = &l->material,
        .nmaterial = 1,
        .boundary.load = &l->load,
        .boundary.nload = the.push || the.lead
    };
    PG_TRY (pg_solver_create_with (&l->solver, &l->problem, o, type));
    PG_TRY (pg_state_create (&l->state, &l->problem, 1));
done:
    return status;
}

static inline void link_up (linked *l, const pg_solver_options *o, const pg_force_type *type)
{
    check_ok (try_link (l, o, type));
}

static inline void unlink_all (linked *l)
{
    pg_state_free (&l->state);
    pg_solver_free (&l->solver);
}

/* Making the solver and one step with each allocation failing in turn: told as that, and nothing is left
 * behind. */
static inline void each_allocation_may_fail (const pg_solver_options *o)
{
    linked l;
    pg_step step;
    for (size_t k = 1;; k++) {
        size_t used = pg_memory_used ();
        pg_memory_fail_at (k);
        pg_status status = try_link (&l, o, &chain_type);
        if (status == PG_OK) status = pg_solver_step (l.solver, l.state, &step);
        pg_memory_fail_at (0);
        unlink_all (&l);
        assert_int_equal (pg_memory_used (), used);
        if (status == PG_OK) break;
        assert_int_equal (status, PG_E_MEMORY);
        assert_true (k < 200);
    }
}

static inline void run_all (linked *l)
{
    pg_step step;
    while (!pg_solver_done (l->solver, l->state)) check_ok (pg_solver_step (l->solver, l->state, &step));
}
#endif
