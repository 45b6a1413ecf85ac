/* SPDX-License-Identifier: GPL-3.0-or-later
 * The Galerkin force: R = P - sum_p w_p B_p' sigma_p on live bonds, K = sum_p w_p B_p' D B_p (Cui 2022 section 3; theory F).
 * After a break only the rows of touched points and of the nodes they see are redone. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

static size_t galerkin_fields (const void *self, size_t max, pg_field *out)
{
    const galerkin *g = self;
    if (max > 0) out[0] = (pg_field) { "displacement", "m", g->dim };
    return 1;
}

static void galerkin_free (void **self)
{
    galerkin *g = *self;
    if (!g) return;
    for (int s = 0; s < PG_BOND_SETS; s++) {
        pg_free (g->rows[s].N), pg_free (g->rows[s].dN), pg_free (g->rows[s].w), pg_free (g->rows[s].grade);
        pg_free (g->material[s]), pg_free (g->strain[s]), pg_free (g->stress[s]), pg_free (g->zz[s]), pg_free (g->u[s]);
        pg_free (g->s1[s]), pg_free (g->s3[s]), pg_free (g->seen[s]), pg_free (g->list[s]);
    }
    pg_stiffness_free (&g->K);
    galerkin_boundary_free (g);
    galerkin_basis_free (g);
    pg_free (g->work), pg_free (g->mark);
    pg_free (g);
    *self = NULL;
}

/* Values of one bond set; a point follows the block of its nearest node. */
static pg_status create_set (galerkin *g, int s)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    pg_rows *r = &g->rows[s];
    size_t dim = (size_t) g->dim, nnz;
    *r = p->rows[s];
    nnz = r->family.start[r->n];
    r->N = r->dN = r->w = NULL, r->grade = NULL;
    PG_ALLOC (r->N, nnz);
    PG_ALLOC (r->dN, nnz * dim);
    PG_ALLOC (r->w, nnz);
    PG_ALLOC (r->grade, r->n);
    PG_ALLOC (g->material[s], r->n);
    PG_ALLOC (g->strain[s], r->n * (size_t) g->nv);
    PG_ALLOC (g->stress[s], r->n * (size_t) g->nv);
    PG_ALLOC (g->zz[s], r->n);
    PG_ALLOC (g->u[s], r->n * dim);
    PG_ALLOC (g->s1[s], r->n);
    PG_ALLOC (g->s3[s], r->n);
    PG_ALLOC (g->seen[s], g->n * dim);
    PG_ALLOC (g->list[s], r->n);
    for (size_t q = 0; p->nmaterial > 1 && q < r->n; q++) {
        double best = INFINITY;
        for (size_t e = r->family.start[q]; e < r->family.start[q + 1]; e++) {
            size_t j = (size_t) r->family.node[e];
            double d2 = 0;
            for (size_t k = 0; k < dim; k++) d2 += (p->cloud.x[j * dim + k] - r->x[q * dim + k]) * (p->cloud.x[j * dim + k] - r->x[q * dim + k]);
            if (d2 < best) best = d2, g->material[s][q] = p->cloud.block[j];
        }
    }
done:
    return status;
}

static void apply (void *context, const double *x, double *y) { pg_sparse_multiply (pg_stiffness_matrix (context), x, y); }

static void diagonal (void *context, double *d)
{
    pg_operator op = pg_sparse_operator (pg_stiffness_matrix (context));
    op.diagonal (op.context, d);
}

static pg_status galerkin_create (void **self, const pg_problem *problem)
{
    pg_status status = PG_OK;
    galerkin *g = NULL;
    pg_source source[3];
    size_t nsource = 0;
    PG_ALLOC (g, 1);
    *self = g;
    g->problem = problem, g->dim = problem->dim, g->nv = pg_voigt_size (problem->dim), g->threads = problem->threads, g->n = problem->cloud.n;
    g->bulk = problem->integration->at_nodes ? PG_NODES : PG_POINTS;
    for (int s = 0; s < PG_BOND_SETS; s++) PG_TRY (create_set (g, s));
    PG_ALLOC (g->work, g->n * (size_t) g->dim);
    PG_ALLOC (g->mark, g->n);
    PG_TRY (galerkin_boundary_create (g));
    PG_TRY (galerkin_basis_create (g));
    source[nsource++] = (pg_source) { &g->rows[g->bulk].family, g, galerkin_bulk_blocks };
    if (g->npin) source[nsource++] = (pg_source) { &g->rows[PG_FACETS].family, g, galerkin_facet_blocks };
    if (g->npeg) source[nsource++] = (pg_source) { &g->peg_family, g, galerkin_peg_blocks };
    PG_TRY (pg_stiffness_create (&g->K, g->n, g->dim, nsource, source));
    g->op = (pg_operator) { g->n * (size_t) g->dim, g->K, apply, diagonal };
done:
    if (status != PG_OK) galerkin_free (self);
    return status;
}

/* ---- refresh ---------------------------------------------------------------------------------------------------------- */
/* Touched points of each set (ascending, once each) from the dead bonds. */
static void touched_points (const galerkin *g, const pg_changes *changes, size_t *count)
{
    for (int s = 0; s < PG_BOND_SETS; s++) count[s] = 0;
    for (size_t c = 0; c < changes->n; c++) {
        int s;
        size_t point;
        pg_problem_locate (g->problem, changes->bond[c], &s, &point);
        if (count[s] == 0 || g->list[s][count[s] - 1] != point) g->list[s][count[s]++] = point;    /* changes are ascending     */
    }
}

static void mark_family (galerkin *g, int set, size_t p)
{
    const pg_family *f = &g->rows[set].family;
    for (size_t e = f->start[p]; e < f->start[p + 1]; e++) g->mark[f->node[e]] = 1;
}

static pg_status gather_touched (galerkin *g, const size_t *count)
{
    pg_status status = PG_OK;
    int *node = NULL;
    size_t nnode = 0;
    memset (g->mark, 0, g->n);
    for (size_t k = 0; k < count[g->bulk]; k++) mark_family (g, g->bulk, g->list[g->bulk][k]);
    for (size_t k = 0; g->npin && k < count[PG_FACETS]; k++) mark_family (g, PG_FACETS, g->list[PG_FACETS][k]);
    for (size_t k = 0; g->npeg && k < count[PG_NODES]; k++) mark_family (g, PG_NODES, g->list[PG_NODES][k]);
    PG_ALLOC (node, g->n);
    for (size_t i = 0; i < g->n; i++) if (g->mark[i]) node[nnode++] = (int) i;
    if (nnode) PG_TRY (pg_stiffness_gather (g->K, nnode, node, g->threads));
    g->revision += nnode > 0;
done:
    pg_free (node);
    return status;
}

static pg_status galerkin_refresh (void *self, const pg_state *state, const pg_changes *changes)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    const pg_problem *p = g->problem;
    size_t count[PG_BOND_SETS];
    if (changes) touched_points (g, changes, count);
    for (int s = 0; s < PG_BOND_SETS; s++) {
        size_t n = changes ? count[s] : g->rows[s].n;
        int known = changes && g->fresh[s];
        g->fresh[s] = 0;
        if (n) PG_TRY (p->approx.type->evaluate (&p->approx, &p->cloud, &g->rows[s], state->alive + p->first_bond[s], n,
                                                 changes ? g->list[s] : NULL, g->threads));
        g->fresh[s] = known;
        if (known) galerkin_measure_list (g, s, n, g->list[s]);
    }
    if (!changes) {
        PG_TRY (pg_stiffness_gather (g->K, g->n, NULL, g->threads));
        g->revision++;
    } else PG_TRY (gather_touched (g, count));
    if (g->has_T && (!changes || count[PG_NODES])) {
        PG_TRY (galerkin_basis_update (g));
        g->revision++;
    }
done:
    return status;
}

/* ---- balance ---------------------------------------------------------------------------------------------------------- */
static pg_status galerkin_balance (void *self, double t, const double *d, double *residual, double *reference)
{
    galerkin *g = self;
    size_t ndof = g->n * (size_t) g->dim;
    double inside = 0, external = 0, reaction = 0;
    memset (residual, 0, ndof * sizeof *residual);
    for (int s = 0; s < PG_BOND_SETS; s++) if (s == g->bulk || s == PG_FACETS || g->npeg || g->problem->nload) galerkin_measure (g, s, d);
    galerkin_bulk_force (g, d, residual);
    for (size_t i = 0; i < ndof; i++) inside += residual[i] * residual[i], residual[i] = -residual[i];
    galerkin_boundary_force (g, t, d, residual, &external, &reaction);
    *reference = sqrt (fmax (inside, fmax (external, reaction)));
    return PG_OK;
}

static pg_status galerkin_mass (void *self, double *mass)
{
    galerkin *g = self;
    for (size_t i = 0; i < g->n; i++)
        for (int k = 0; k < g->dim; k++)
            mass[i * (size_t) g->dim + (size_t) k] = galerkin_material (g, PG_NODES, i)->density * g->problem->cloud.volume[i];
    return PG_OK;
}

static unsigned long galerkin_revision (const void *self) { return ((const galerkin *) self)->revision; }
static const pg_operator *galerkin_operator (void *self) { return &((galerkin *) self)->op; }
static const pg_sparse *galerkin_matrix (void *self) { return pg_stiffness_matrix (((galerkin *) self)->K); }

static pg_status galerkin_ledger (void *self, double t, const double *d, const double *inertia, pg_ledger *out)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    double *residual = NULL, reference;
    size_t slaves = g->side[0].n + g->side[1].n + g->side[2].n;
    if (!out->force) {
        out->npair = galerkin_boundary_pairs (g) + slaves;
        PG_ALLOC (out->force, out->npair);
        PG_ALLOC (out->displacement, out->npair);
        PG_ALLOC (out->reaction, 3 * g->problem->nload);
    }
    memset (out->reaction, 0, 3 * g->problem->nload * sizeof *out->reaction);
    for (int s = 0; s < PG_BOND_SETS; s++) galerkin_measure (g, s, d);
    if (slaves) {
        PG_ALLOC (residual, g->n * (size_t) g->dim);
        PG_TRY (galerkin_balance (g, t, d, residual, &reference));
        for (size_t i = 0; inertia && i < g->n * (size_t) g->dim; i++) residual[i] += inertia[i];
    }
    galerkin_basis_ledger (g, t, residual, out, galerkin_boundary_ledger (g, t, d, out));
    out->strain = galerkin_bulk_energy (g, d) + galerkin_boundary_energy (g, t);
done:
    pg_free (residual);
    return status;
}

const pg_force_type pg_force_galerkin = {
    "galerkin", "global stiffness from NOSB, PDDO or RKPM bonds (Cui 2022)",
    galerkin_create, galerkin_free, galerkin_fields, galerkin_refresh, galerkin_balance, galerkin_mass, galerkin_operator, galerkin_matrix,
    galerkin_basis, galerkin_impose, galerkin_utilisation, galerkin_ledger, galerkin_field, galerkin_probe, galerkin_overlap, galerkin_census,
    galerkin_revision
};
