/* SPDX-License-Identifier: GPL-3.0-or-later
 * K of the Galerkin form, in two ways: as a product K x straight from the shape functions (nothing to
 * assemble, nothing to update after a break), and as a sparse matrix, which is assembled when it is first
 * needed and of which only those rows are reassembled that breaking bonds changed. */
#include "galerkin.h"
#include <string.h>

/* y = K x: bulk, then supports. */
void galerkin_apply (void *context, const double *x, double *y)
{
    galerkin *g = context;
    memset (y, 0, g->n * (size_t) g->dim * sizeof *y);
    galerkin_bulk_apply (g, x, y);
    if (g->supports.nnitsche || g->supports.npenalty) galerkin_boundary_apply (g, x, y);
}

/* d += diagonal of w B_a' D B_a of the bulk, N/m, where D couples no shear with anything else: normal and
 * shear moduli times squared derivatives, which is a fraction of the work of the blocks. */
static void bulk_diagonal (galerkin *g, double *d)
{
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    for (size_t p = 0; p < r->n; p++) {
        const double *D = galerkin_plain (g, g->bulk, p)->D;
        double w = r->weight[p], normal[3], shear[3][3] = { { 0 } };
        size_t offset = pg_rows_offset (r, p);
        for (size_t a = 0; a < dim; a++) normal[a] = w * D[a * nv + a];
        if (dim == 2) shear[0][1] = shear[1][0] = w * D[8];
        if (dim == 3)
            shear[0][1] = shear[1][0] = w * D[21], shear[1][2] = shear[2][1] = w * D[28],
            shear[2][0] = shear[0][2] = w * D[35];
        for (size_t k = r->family.start[p]; k < r->family.start[p + 1]; k++) {
            const double *q = r->dN + (k + offset) * dim;
            double *to = d + (size_t) r->family.node[k] * dim;
            for (size_t a = 0; a < dim; a++) {
                to[a] += normal[a] * q[a] * q[a];
                for (size_t b = 0; b < dim; b++) if (b != a) to[a] += shear[a][b] * q[b] * q[b];
            }
        }
    }
}

typedef void (*blocks) (void *context, size_t p, size_t a, size_t m, double *out);

/* d += diagonal of the blocks K_aa of every point of a family; `make` computes the blocks of node a with the
 * nodes up to itself, of which the last is used. wide: scratch for a row of blocks. */
static void add_diagonal_blocks (galerkin *g, const pg_family *f, blocks make, double *wide, double *d)
{
    size_t dim = (size_t) g->dim;
    for (size_t p = 0; p < f->n; p++)
        for (size_t a = 0; a < f->start[p + 1] - f->start[p]; a++) {
            memset (wide, 0, (a + 1) * dim * dim * sizeof *wide);
            make (g, p, a, a + 1, wide);
            for (size_t k = 0; k < dim; k++)
                d[(size_t) f->node[f->start[p] + a] * dim + k] += wide[(a * dim + k) * dim + k];
        }
}

/* The largest number of nodes of a point of a family. */
static size_t widest (const pg_family *f)
{
    size_t most = 0;
    for (size_t p = 0; p < f->n; p++)
        if (f->start[p + 1] - f->start[p] > most) most = f->start[p + 1] - f->start[p];
    return most;
}

/* Allocates room for one row of blocks of any source and marks of stale rows, and makes the operator by which
 * iterations use K. Needs the boundary. */
pg_status galerkin_operator_create (galerkin *g)
{
    galerkin_stiffness *k = &g->stiffness;
    pg_status status = PG_OK;
    size_t most = widest (&g->rows[PG_FACETS].family), bulk = widest (&g->sums.family),
        penalty = widest (&g->supports.penalty_family);
    most = most > bulk ? most : bulk, most = most > penalty ? most : penalty;
    PG_ALLOC (k->wide, most * (size_t) (g->dim * g->dim));
    PG_ALLOC (k->stale, g->n);
    PG_ALLOC (k->diagonal, g->n * (size_t) g->dim);
    k->all_stale = 1;
    k->op = (pg_operator) { g->n * (size_t) g->dim, g, galerkin_apply, galerkin_diagonal };
done:
    return status;
}

/* Are all materials isotropic? Then shears couple with nothing in D, and bulk_diagonal is complete. */
static int all_isotropic (const pg_problem *p)
{
    for (size_t m = 0; m < p->nmaterial; m++)
        if (!(p->material[m].type->can & PG_MATERIAL_ISOTROPIC)) return 0;
    return 1;
}

/* Diagonal of K, N/m; the stored one until K has a new revision. */
void galerkin_diagonal (void *context, double *d)
{
    galerkin *g = context;
    size_t ndof = g->n * (size_t) g->dim;
    if (g->stiffness.diagonal_of != g->stiffness.revision || g->stiffness.revision == 0) {
        memset (g->stiffness.diagonal, 0, ndof * sizeof *g->stiffness.diagonal);
        if (g->dilatation) galerkin_dilatation_diagonal (g, g->stiffness.diagonal);
        if (!(g->options->silling > 0) && all_isotropic (g->problem))
            bulk_diagonal (g, g->stiffness.diagonal);
        else add_diagonal_blocks (g, &g->sums.family, galerkin_bulk_blocks, g->stiffness.wide,
                                  g->stiffness.diagonal);
        if (g->supports.nnitsche)
            add_diagonal_blocks (g, &g->rows[PG_FACETS].family, galerkin_facet_blocks, g->stiffness.wide,
                                 g->stiffness.diagonal);
        if (g->supports.npenalty) add_diagonal_blocks (g, &g->supports.penalty_family,
                                                       galerkin_penalty_blocks, g->stiffness.wide,
                                              g->stiffness.diagonal);
        g->stiffness.diagonal_of = g->stiffness.revision;
    }
    memcpy (d, g->stiffness.diagonal, ndof * sizeof *d);
}

/* ---- the matrix ---------------------------------------------------------------------------------------- */
/* Marks the rows of K of all nodes in the family of a touched point as stale: its shape functions have
 * changed. */
static void mark_family (galerkin *g, int set, size_t p)
{
    const pg_family *f = set == g->bulk ? &g->sums.family : &g->rows[set].family;
    for (size_t e = f->start[p]; e < f->start[p + 1]; e++) g->stiffness.stale[f->node[e]] = 1;
}

/* Marks the rows of K that the touched points (g->list, `count` in each set) contribute to. Facets and nodes
 * matter only where something is prescribed there. A new revision shows preconditioners and factors that K
 * has changed. */
void galerkin_mark_stale (galerkin *g, const size_t *count)
{
    galerkin_supports *c = &g->supports;
    size_t marked = count[g->bulk] + (c->nnitsche ? count[PG_FACETS] : 0) + (c->npenalty ? count[PG_NODES]
            : 0);
    for (size_t k = 0; k < count[g->bulk]; k++) mark_family (g, g->bulk, g->list[g->bulk][k]);
    for (size_t k = 0; c->nnitsche && k < count[PG_FACETS]; k++)
        mark_family (g, PG_FACETS, g->list[PG_FACETS][k]);
    for (size_t k = 0; c->npenalty && k < count[PG_NODES]; k++) mark_family (g, PG_NODES,
            g->list[PG_NODES][k]);
    g->stiffness.revision += marked > 0;
}

/* Creates the matrix with its sources of blocks: bulk (cell by cell with consistent integration, whose
 * derivatives couple all points of a cell), facets, nodes under a penalty, patches of the dilatation. known:
 * the bulk's part of K, if available. */
static pg_status create_matrix (galerkin *g, const pg_assembly *known)
{
    pg_assembly_source source[4];
    size_t n = 0;
    const pg_adjacency *cells = g->whole ? &g->problem->form.consistency->cell_family : NULL;
    source[n] = (pg_assembly_source) { .seen = cells ? cells : &g->sums.family, .context = g,
                                       .known = known };
    if (galerkin_has_rows (g))
        source[n].rows = cells ? galerkin_cell_rows : galerkin_point_rows,
        source[n].finish = galerkin_finish_rows;
    else source[n].blocks = cells ? galerkin_cell_blocks : galerkin_bulk_blocks;
    n++;
    if (g->supports.nnitsche) {
        source[n] = (pg_assembly_source) { .seen = &g->rows[PG_FACETS].family, .context = g };
        if (g->problem->plain) source[n++].blocks = galerkin_facet_blocks;
        else source[n++].rows = galerkin_facet_rows;
    }
    if (g->dilatation) source[n++] = (pg_assembly_source) { .seen = galerkin_dilatation_family (g),
                                                            .context = g,
                                                            .blocks = galerkin_dilatation_blocks };
    if (g->supports.npenalty) source[n++] =
        (pg_assembly_source) { .seen = &g->supports.penalty_family, .context = g,
                                                          .blocks = galerkin_penalty_blocks };
    g->stiffness.all_stale = 1;
    return pg_assembly_create (&g->stiffness.K, g->n, g->dim, n, source);
}

/* Assembles K: at first all rows, then only the stale ones, which broken bonds have changed. */
static pg_status assemble (galerkin *g)
{
    galerkin_stiffness *k = &g->stiffness;
    pg_status status = PG_OK;
    pg_assembly *known = k->K ? NULL : galerkin_take_stiffness (g);
    int *node = NULL;
    size_t nnode = 0;
    if (!k->K) PG_TRY (create_matrix (g, known));
    k->took |= known != NULL;
    if (k->all_stale) PG_TRY (pg_assembly_gather (k->K, g->n, NULL, g->threads));
    else {
        PG_ALLOC (node, g->n);
        for (size_t i = 0; i < g->n; i++) if (k->stale[i]) node[nnode++] = (int) i;
        if (nnode) PG_TRY (pg_assembly_gather (k->K, nnode, node, g->threads));
    }
    k->all_stale = 0;
    memset (k->stale, 0, g->n);
done:
    if (status != PG_OK && known) pg_assembly_free (&k->K);            /* K still refers to `known` */
    pg_free (node);
    pg_assembly_free (&known);
    return status;
}

pg_status galerkin_matrix (void *self, pg_matrix_want want, const pg_sparse **K)
{
    static const pg_sparse none = { 0 };
    pg_status status = PG_OK;
    galerkin *g = self;
    if (want == PG_MATRIX_ASSEMBLED) PG_TRY (assemble (g));
    if (want == PG_MATRIX_FREED) pg_assembly_free (&g->stiffness.K);           /* including its index lists */
    *K = g->stiffness.K ? pg_assembly_matrix (g->stiffness.K) : &none;
done:
    return status;
}

/* ---- consistent mass ----------------------------------------------------------------------------------- */
/* out (m) = contribution of point p to M_ab = int rho N_a N_b, kg */
static void mass_blocks (void *context, size_t p, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    const pg_rows *r = &g->sums;
    const double *N = r->N + r->family.start[p] + pg_rows_offset (r, p);
    double share = galerkin_material (g, g->bulk, p)->density * r->weight[p] * N[a];
    for (size_t b = 0; b < m; b++) out[b] = share * N[b];
}

/* Consistent mass matrix, kg, made once with the bonds intact at that time: breaking bonds does not change
 * it. */
pg_status galerkin_consistent_mass (galerkin *g, const pg_sparse **M)
{
    galerkin_stiffness *k = &g->stiffness;
    pg_status status = PG_OK;
    if (!k->M) {
        pg_assembly_source source = { .seen = &g->sums.family, .context = g, .blocks = mass_blocks };
        PG_TRY (pg_assembly_create (&k->M, g->n, 1, 1, &source));
        PG_TRY (pg_assembly_gather (k->M, g->n, NULL, g->threads));
    }
    *M = pg_assembly_matrix (k->M);
done:
    return status;
}
