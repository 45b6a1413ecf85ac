/* SPDX-License-Identifier: GPL-3.0-or-later
 * Finite elements on a coarse grid, as the preconditioner of irregular points without cells where the nodes
 * are the evaluation points (linalg.h, pg_elements).
 *
 * K x of such points is cheap, some 30 bonds a node, and finite elements on all the nodes cost several times
 * as much. It is smooth displacements that make the iterations with a diagonal preconditioner grow with the
 * body: displacements that alternate from node to node have little energy on irregular points, but never
 * none. So
 *
 *     P^-1 = D^-1 + H V (Q) H',   Q = H' K H,
 *
 * with hat functions H on a grid of 2.5 horizons (one of 0.6 horizons needs as many iterations). The number
 * of iterations hardly grows with the body, and each costs little more than K x. Q is summed up point by
 * point, cell of the grid by cell: with q_f = sum_j H_f (x_j) dN_pj of the hat functions f that do not
 * vanish at the nodes of point p, and e_fr the strain of a displacement q_f along axis r, w e_fr . D e_gs.
 * Unknowns that elimination or stiff penalties determine are excluded; other supports are springs at their
 * points. */
#include "galerkin_elements.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Step of the grid in units of the horizon. */
static const double coarse = 2.5;

/* Working data of the summation. */
typedef struct {
    galerkin *g;
    pg_elements *out;
    unsigned char *fixed;                              /* 1: unknowns that are excluded (n x dim) */
    /* Hat functions that are summed up together: for each cell of the grid, then for each support. */
    pg_adjacency groups;
    size_t  most, cap_start, cap_node;
    /* The present group: its m functions, their matrix K (m dim x m dim); seen (functions): position in the
     * group + 1, 0: not in it. */
    int    *of, *seen;
    size_t  m, cap_of;
    double *K;
    /* The present evaluation point: positions of its functions in the group (count), strains e and weighted
     * stresses s of each along each axis; local (positions in the group): number of the function at this
     * point + 1, 0: none. */
    int    *at, *local;
    size_t  count;
    double *e, *s;
} sums;

/* 1: elements on a coarse grid are used. Not for points on a lattice or with wide supports, which keep
 * elements on all nodes, nor on several ranks, as each grid would cover a subdomain only. */
int galerkin_takes_hats (const galerkin *g)
{
    pg_solve_counts c = pg_solve_count (g->problem);
    return pg_solve_on_grid (&c) && !(g->options->silling > 0) && !g->problem->cloud.subdomain;
}

/* ---- the grid ------------------------------------------------------------------------------------------ */
/* Lists the nodes to which the bonds of node i are intact, and i. */
static size_t seen_by (void *context, size_t i, int thread, int *node, double *value)
{
    const galerkin *g = context;
    const pg_rows *r = &g->rows[PG_NODES];
    size_t m = 0;
    (void) thread, (void) value;
    for (size_t e = r->family.start[i]; e < r->family.start[i + 1]; e++)
        if (r->w[e + pg_rows_offset (r, i)] > 0 || (size_t) r->family.node[e] == i)
            node[m++] = r->family.node[e];
    return m;
}

static pg_status make_hats (galerkin *g, pg_elements *out)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_NODES];
    const pg_problem *p = g->problem;
    pg_hats_setting s = { .dim = g->dim, .threads = g->threads, .n = g->n, .x = p->cloud.x,
                          .step = coarse * p->form.approx.horizon,
                          .rows = { .context = g, .reach = p->form.approx.horizon, .row = seen_by } };
    for (size_t i = 0; i < g->n; i++)
        if (r->family.start[i + 1] - r->family.start[i] > s.rows.widest)
            s.rows.widest = r->family.start[i + 1] - r->family.start[i];
    PG_TRY (pg_hats_create (&out->hats, &s));
    out->spacing = s.step;
done:
    return status;
}

/* ---- groups of hat functions --------------------------------------------------------------------------- */
/* Adds the hat functions at node j to the group. */
static pg_status meet (sums *b, size_t j)
{
    pg_status status = PG_OK;
    const pg_hats *h = &b->out->hats;
    for (size_t c = j * (size_t) h->corners; c < (j + 1) * (size_t) h->corners; c++) {
        int f = h->function[c];
        if (f < 0 || b->seen[f]) continue;
        PG_GROW (b->of, b->cap_of, b->m + 1);
        b->of[b->m] = f, b->seen[f] = (int) ++b->m;
    }
done:
    return status;
}

static pg_status meet_all (sums *b, const pg_family *f, size_t p)
{
    pg_status status = PG_OK;
    for (size_t e = f->start[p]; e < f->start[p + 1]; e++) PG_TRY (meet (b, (size_t) f->node[e]));
done:
    return status;
}

static void leave (sums *b)
{
    for (size_t k = 0; k < b->m; k++) b->seen[b->of[k]] = 0;
    b->m = 0;
}

/* Closes the list of a group. */
static pg_status append (sums *b)
{
    pg_status status = PG_OK;
    pg_adjacency *l = &b->groups;
    PG_GROW (l->start, b->cap_start, l->n + 2);
    PG_GROW (l->node, b->cap_node, l->start[l->n] + b->m + 1);
    memcpy (l->node + l->start[l->n], b->of, b->m * sizeof (int));
    l->start[l->n + 1] = l->start[l->n] + b->m, l->n++;
    b->most = b->m > b->most ? b->m : b->most;
    leave (b);
done:
    return status;
}

/* The k-th support of a body: its point and set of rows, its component, and its stiffness, N/m (0: stiff
 * penalties, treated elsewhere). First Nitsche's terms at facets, then penalties. Returns 0 if there are no
 * more. */
typedef struct { const pg_rows *rows; size_t point, component; double stiffness; } support;
static int support_of (const galerkin *g, size_t k, support *s)
{
    const galerkin_supports *c = &g->supports;
    if (k < c->nnitsche) {
        const constraint *q = &c->nitsche[k];
        *s = (support) { &g->rows[PG_FACETS], q->point, (size_t) q->component,
                         galerkin_nitsche_stiffness (g, q) };
        return 1;
    }
    k -= c->nnitsche;
    if (k >= c->npenalty) return 0;
    const constraint *q = &c->penalty[k];
    *s = (support) { &g->rows[PG_NODES], (size_t) c->penalty_node[q->point], (size_t) q->component,
                     elements_stiff (g, q) ? 0 : galerkin_penalty_stiffness (g, q) };
    return 1;
}

/* Lists the hat functions at all nodes in the families of the points of each cell of the grid, and of each
 * support. */
static pg_status list_groups (sums *b)
{
    pg_status status = PG_OK;
    const pg_hats *h = &b->out->hats;
    support s;
    for (size_t cell = 0; cell < h->ncell; cell++) {
        for (size_t k = h->cell_first[cell]; k < h->cell_first[cell + 1]; k++)
            PG_TRY (meet_all (b, &b->g->sums.family, (size_t) h->cell_node[k]));
        PG_TRY (append (b));
    }
    for (size_t k = 0; support_of (b->g, k, &s); k++) {
        if (s.stiffness > 0) PG_TRY (meet_all (b, &s.rows->family, s.point));
        PG_TRY (append (b));
    }
done:
    return status;
}

/* Makes a group the present one, with its functions as listed. */
static void enter (sums *b, size_t group)
{
    b->m = b->groups.start[group + 1] - b->groups.start[group];
    memcpy (b->of, b->groups.node + b->groups.start[group], b->m * sizeof (int));
    for (size_t k = 0; k < b->m; k++) b->seen[b->of[k]] = (int) k + 1;
    memset (b->K, 0, b->m * b->m * (size_t) (b->g->dim * b->g->dim) * sizeof *b->K);
}

/* Adds the matrix of the present group to Q. */
static void hand_over (sums *b)
{
    size_t width = b->m * (size_t) b->g->dim;
    for (size_t i = 0; i < width; i++)
        for (size_t j = 0; j < i; j++) b->K[i * width + j] = b->K[j * width + i];
    pg_block_add (&b->out->Q, b->m, b->of, b->K);
    leave (b);
}

/* ---- one point ----------------------------------------------------------------------------------------- */
/* e += weight times the strain of a displacement along axis r with gradient q. */
static void add_strain_along (int dim, int r, double weight, const double *q, double *e)
{
    static const int shear[3][3] = { { 0, 3, 5 }, { 3, 0, 4 }, { 5, 4, 0 } };
    for (int k = 0; k < dim; k++) {
        int v = k == r ? r : dim == 2 ? 2 : shear[r][k];
        e[v] += weight * q[k];
    }
}

/* s = w D e */
static void stress_of (size_t nv, const double *D, double w, const double *e, double *s)
{
    for (size_t v = 0; v < nv; v++) {
        s[v] = 0;
        for (size_t u = 0; u < nv; u++) s[v] += w * D[v * nv + u] * e[u];
    }
}

/* Position of hat function f among those of the present point; a new one starts with `width` zeros in e. */
static size_t place_of (sums *b, int f, size_t width)
{
    int at = b->seen[f] - 1;
    if (b->local[at] == 0) {
        memset (b->e + b->count * width, 0, width * sizeof *b->e);
        b->at[b->count] = at, b->local[at] = (int) ++b->count;
    }
    return (size_t) b->local[at] - 1;
}

/* K += e . s of all pairs of functions of the point, on and above the diagonal. */
static void add_pairs (sums *b, size_t nv)
{
    size_t dim = (size_t) b->g->dim, width = b->m * dim;
    const int *at = b->at;
    for (size_t k = 0; k < b->count; k++)
        for (size_t l = 0; l < b->count; l++) {
            if (at[k] > at[l]) continue;
            for (size_t r = 0; r < dim; r++)
                for (size_t c = 0; c < dim; c++) {
                    const double *e = b->e + (k * dim + r) * nv, *s = b->s + (l * dim + c) * nv;
                    double sum = 0;
                    for (size_t v = 0; v < nv; v++) sum += e[v] * s[v];
                    b->K[((size_t) at[k] * dim + r) * width + (size_t) at[l] * dim + c] += sum;
                }
        }
    for (size_t k = 0; k < b->count; k++) b->local[at[k]] = 0;
    b->count = 0;
}

/* Adds evaluation point p: strains of its functions, their stresses and energies, to K and to the
 * diagonal. */
static void add_point (sums *b, size_t p)
{
    const galerkin *g = b->g;
    const pg_rows *r = &g->sums;
    const pg_hats *h = &b->out->hats;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv, corners = (size_t) h->corners;
    const double *D = galerkin_plain (g, g->bulk, p)->D;
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
        size_t j = (size_t) r->family.node[e];
        const double *q = r->dN + (e + pg_rows_offset (r, p)) * dim;
        for (size_t c = 0; c < dim; c++) {
            double strain[6] = { 0 }, stress[6];
            add_strain_along (g->dim, (int) c, 1, q, strain);
            stress_of (nv, D, r->weight[p], strain, stress);
            for (size_t v = 0; v < nv; v++) b->out->diagonal[j * dim + c] += strain[v] * stress[v];
        }
        for (size_t a = j * corners; a < (j + 1) * corners; a++) {
            if (h->function[a] < 0) continue;
            double *to = b->e + place_of (b, h->function[a], dim * nv) * dim * nv;
            for (size_t c = 0; c < dim; c++)
                if (!b->fixed[j * dim + c])
                    add_strain_along (g->dim, (int) c, (double) h->value[a], q, to + c * nv);
        }
    }
    for (size_t k = 0; k < b->count * dim; k++)
        stress_of (nv, D, r->weight[p], b->e + k * nv, b->s + k * nv);
    add_pairs (b, nv);
}

/* Adds the spring of a support, which holds a component of the displacement at a point. */
static void add_spring (sums *b, const support *s)
{
    const pg_rows *r = s->rows;
    const pg_hats *h = &b->out->hats;
    size_t dim = (size_t) b->g->dim, corners = (size_t) h->corners;
    for (size_t e = r->family.start[s->point]; e < r->family.start[s->point + 1]; e++) {
        size_t i = (size_t) r->family.node[e] * dim + s->component;
        double N = r->N[e + pg_rows_offset (r, s->point)];
        b->out->diagonal[i] += s->stiffness * N * N;
        for (size_t a = i / dim * corners; a < (i / dim + 1) * corners && !b->fixed[i]; a++)
            if (h->function[a] >= 0)
                b->e[place_of (b, h->function[a], dim) * dim + s->component] += (double) h->value[a] * N;
    }
    for (size_t k = 0; k < b->count * dim; k++) b->s[k] = s->stiffness * b->e[k];
    add_pairs (b, 1);
}

/* ---- summation over all points ------------------------------------------------------------------------- */
/* Marks the unknowns that are determined elsewhere: slaves of elimination, and those of stiff penalties. */
static pg_status find_fixed (sums *b)
{
    pg_status status = PG_OK;
    const galerkin *g = b->g;
    size_t dim = (size_t) g->dim;
    PG_ALLOC (b->fixed, g->n * dim);
    for (size_t k = 0; k < dim && g->supports.has_T; k++)
        for (size_t s = 0; s
             < g->supports.side[k].n; s++) b->fixed[(size_t) g->supports.side[k].slave[s] * dim + k] = 1;
    for (size_t c = 0; c < b->out->W.ncol; c++) b->fixed[b->out->holds[c]] = 1;
done:
    return status;
}

/* Allocates room for the largest group, and for all functions of a point. */
static pg_status make_room (sums *b)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) b->g->dim, nv = (size_t) b->g->nv;
    PG_GROW (b->of, b->cap_of, b->most);
    PG_ALLOC (b->at, b->most);
    PG_ALLOC (b->local, b->most);
    PG_ALLOC (b->K, b->most * dim * b->most * dim);
    PG_ALLOC (b->e, b->most * dim * nv);
    PG_ALLOC (b->s, b->most * dim * nv);
done:
    return status;
}

/* The largest distance of two functions of a group, m. */
static double farthest (const sums *b)
{
    const pg_adjacency *l = &b->groups;
    size_t dim = (size_t) b->g->dim;
    double most = 0;
    for (size_t group = 0; group < l->n; group++)
        for (size_t k = l->start[group]; k < l->start[group + 1]; k++)
            for (size_t i = l->start[group]; i < k; i++)
                most = fmax (most, pg_distance2 (b->g->dim, b->out->hats.place + (size_t) l->node[k] * dim,
                                              b->out->hats.place + (size_t) l->node[i] * dim));
    return sqrt (most);
}

/* Sums Q and the diagonal. */
static void sum_up (sums *b)
{
    const pg_hats *h = &b->out->hats;
    support s;
    for (size_t cell = 0; cell < h->ncell; cell++) {
        enter (b, cell);
        for (size_t k = h->cell_first[cell]; k < h->cell_first[cell + 1]; k++)
            add_point (b, (size_t) h->cell_node[k]);
        hand_over (b);
    }
    for (size_t k = 0; support_of (b->g, k, &s); k++) {
        enter (b, h->ncell + k);
        if (s.stiffness > 0) add_spring (b, &s);
        hand_over (b);
    }
}

/* Makes the elements for the bonds that were intact at the last refresh; out->W is known already. */
pg_status galerkin_hats (galerkin *g, pg_elements *out)
{
    pg_status status = PG_OK;
    sums b = { .g = g, .out = out };
    PG_TRY (make_hats (g, out));
    PG_TRY (find_fixed (&b));
    PG_ALLOC (out->diagonal, g->n * (size_t) g->dim);
    PG_ALLOC (b.seen, out->hats.count);
    PG_TRY (list_groups (&b));
    PG_TRY (make_room (&b));
    PG_TRY (pg_block_create (&out->Q, out->hats.count, g->dim, &b.groups, g->threads));
    sum_up (&b);
    out->reach = farthest (&b) * (1 + 1e-9);
done:
    pg_free (b.fixed), pg_free (b.groups.start), pg_free (b.groups.node), pg_free (b.of), pg_free (b.seen);
    pg_free (b.K), pg_free (b.at), pg_free (b.local), pg_free (b.e), pg_free (b.s);
    return status;
}
