/* SPDX-License-Identifier: GPL-3.0-or-later
 * Loads and essential conditions of the Galerkin form (theory E6): Nitsche on facet points,
 *   R_v += int v_k (sigma n)_k + int (sigma(v) n)_k (u_k - g_k) - beta int v_k (u_k - g_k),
 *   beta = nitsche E / h;
 * penalty on nodes, tractions and pressures on facets, point and body forces. */
#include "galerkin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Is value in the ascending list? By bisection, since it is called for every facet and every node. */
static int member (const int *list, size_t n, int value)
{
    size_t lo = 0, hi = n;
    while (lo < hi) {
        size_t mid = (lo + hi) / 2;
        if (list[mid] < value) lo = mid + 1;
        else hi = mid;
    }
    return lo < n && list[lo] == value;
}

/* Does the load leave component k free? Loads that prescribe nothing do, and components beyond the dimension
 * are free. */
static int free_by (const pg_problem *p, const pg_load *load, int k)
{
    return k >= p->dim || !pg_load_prescribes (load) || !load->value[k];
}

/* Lists the constraints by Nitsche's terms, ascending by point; a component that two loads prescribe belongs
 * to the first. */
static pg_status find_nitsche (galerkin *g)
{
    galerkin_supports *c = &g->supports;
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t cap = 0;
    PG_ALLOC (c->nitsche_start, r->n + 1);
    for (size_t q = 0; q < r->n; q++) {
        unsigned taken = 0;
        for (size_t l = 0; l < p->boundary.nload; l++) {
            const pg_load *load = &p->boundary.load[l];
            if (load->essential != PG_ESSENTIAL_NITSCHE
                || !member (load->set->facet, load->set->nfacet, r->cell[q]))
                continue;
            for (int k = 0; k < g->dim; k++) {
                if (free_by (p, load, k) || (taken >> k & 1)) continue;
                PG_GROW (c->nitsche, cap, c->nnitsche + 1);
                c->nitsche[c->nnitsche++] = (constraint) { q, (int) l, k };
                taken |= 1u << k;
            }
        }
        c->nitsche_start[q + 1] = c->nnitsche;
    }
done:
    return status;
}

/* Lists the constraints by penalty, node by node, and the nodes that the displacement of each of them depends
 * on: with shape functions that do not interpolate, u at a node is a sum over its neighbours. A component
 * that two loads prescribe belongs to the first. */
static pg_status find_penalties (galerkin *g)
{
    galerkin_supports *c = &g->supports;
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    const pg_family *f = &g->rows[PG_NODES].family;
    size_t cap = 0, cap_node = 0, cap_start = 0, cap_entry = 0, cap_first = 0, nnz = 0;
    for (size_t i = 0; i < g->n; i++) {
        unsigned taken = 0;
        int any = 0;                           /* 1: the node has springs, in addition to other constraints */
        for (size_t l = 0; l < p->boundary.nload; l++) {
            const pg_load *load = &p->boundary.load[l];
            int spring = load->kind == PG_SPRING;
            if ((load->essential != PG_ESSENTIAL_PENALTY && !spring)
                || !member (load->set->point, load->set->npoint, (int) i))
                continue;
            for (int k = 0; k < g->dim; k++) {
                if (spring ? !load->value[k] : free_by (p, load, k) || (taken >> k & 1)) continue;
                PG_GROW (c->penalty, cap, c->npenalty + 1);
                c->penalty[c->npenalty++] = (constraint) { c->npenalty_node, (int) l, k };
                if (spring) any = 1;
                else taken |= 1u << k;
            }
        }
        if (!taken && !any) continue;
        PG_GROW (c->penalty_node, cap_node, c->npenalty_node + 1);
        PG_GROW (c->penalty_family.start, cap_start, c->npenalty_node + 2);
        PG_GROW (c->penalty_start, cap_first, c->npenalty_node + 2);
        PG_GROW (c->penalty_family.node, cap_entry, nnz + f->start[i + 1] - f->start[i]);
        for (size_t e = f->start[i]; e < f->start[i + 1]; e++) c->penalty_family.node[nnz++] = f->node[e];
        c->penalty_node[c->npenalty_node++] = (int) i;
        c->penalty_family.start[c->npenalty_node] = nnz;
        c->penalty_start[c->npenalty_node] = c->npenalty;
        c->penalty_family.n = c->npenalty_node;
    }
done:
    return status;
}

/* Lists the constraints on facets, then those on nodes. */
pg_status galerkin_boundary_create (galerkin *g)
{
    pg_status status = find_nitsche (g);
    return status == PG_OK ? find_penalties (g) : status;
}

/* Frees the constraints on facets and nodes, also where they were made in part only. */
void galerkin_boundary_free (galerkin *g)
{
    galerkin_supports *c = &g->supports;
    pg_free (c->nitsche), pg_free (c->nitsche_start), pg_free (c->penalty), pg_free (c->penalty_node),
        pg_free (c->penalty_start);
    pg_family_clear (&c->penalty_family);
}

/* Position of a node in penalty_node, which is ascending; -1: not there. */
long galerkin_penalty_of (const galerkin *g, size_t node)
{
    const galerkin_supports *c = &g->supports;
    size_t lo = 0, hi = c->npenalty_node;
    while (lo < hi) {
        size_t mid = (lo + hi) / 2;
        if ((size_t) c->penalty_node[mid] < node) lo = mid + 1;
        else hi = mid;
    }
    return lo < c->npenalty_node && (size_t) c->penalty_node[lo] == node ? (long) lo : -1;
}

/* Does the load act on all points of the body? */
static int is_everywhere (const galerkin *g, const pg_load *load)
{
    return load->kind == PG_BODY_FORCE && pg_set_points (load->set) == pg_cloud_total (&g->problem->cloud);
}

/* Does a load or a prescribed value act at a point of a set, so that nodal forces depend on the shape
 * functions there? */
static int loaded (const galerkin *g, int set, size_t point)
{
    const galerkin_supports *c = &g->supports;
    const pg_problem *p = g->problem;
    if (set == PG_FACETS && c->nnitsche && c->nitsche_start[point + 1] > c->nitsche_start[point]) return 1;
    if (set == PG_NODES && c->npenalty && galerkin_penalty_of (g, point) >= 0) return 1;
    for (size_t l = 0; l < p->boundary.nload; l++) {
        const pg_load *load = &p->boundary.load[l];
        int everywhere = is_everywhere (g, load);
        if (load->cracks || (everywhere && set == g->bulk)) return 1;
        if ((load->kind == PG_TRACTION || load->kind == PG_PRESSURE) && set == PG_FACETS
            && member (load->set->facet, load->set->nfacet, g->rows[PG_FACETS].cell[point]))
            return 1;
        if ((load->kind == PG_POINT_FORCE || (load->kind == PG_BODY_FORCE && !everywhere)) && set == PG_NODES
            && member (load->set->point, load->set->npoint, (int) point))
            return 1;
    }
    return 0;
}

int galerkin_boundary_loaded (const galerkin *g, int set, size_t count, const size_t *list)
{
    for (size_t k = 0; k < count; k++) if (loaded (g, set, list[k])) return 1;
    return 0;
}

/* Q (6 numbers): row k of the matrix of the normal n, with Q . sigma = (sigma n)_k for sigma in Voigt
 * order. */
static void traction_row (int dim, int k, const double *n, double *Q)
{
    memset (Q, 0, 6 * sizeof *Q);
    for (int c = 0; c < dim; c++) Q[pg_voigt_at (dim, k, c)] += n[c];
}

/* Nitsche's beta at facet point q, N/m^3: the factor times E over the spacing; instead of E a quarter of
 * lambda + 2 mu where that is larger (Poisson's ratio above 0.455): the traction of a strain is of that size,
 * and with E alone K is indefinite from 0.49 on. Where the dilatation is projected, D lacks lambda, whose
 * part of the traction is treated patch by patch (galerkin_dilatation_facet.c). */
static double beta (const galerkin *g, size_t q)
{
    double E = galerkin_material (g, PG_FACETS, q)->modulus;
    const double *D = galerkin_plain (g, PG_FACETS, q)->D;
    for (int k = 0; k < g->dim; k++) E = fmax (E, 0.25 * D[k * g->nv + k]);
    return g->options->nitsche * E / pg_problem_spacing (g->problem, PG_FACETS, q);
}

static const double *normal (const galerkin *g, size_t q)
{
    return g->problem->bonds.facet_normal + q * (size_t) g->dim;
}

/* QD: the Voigt vector D' Q, with (sigma (v) n)_k = QD . B v: the traction at facet point q by nodal
 * displacements v. */
static void traction_of_strain (const galerkin *g, size_t q, int k, double *QD)
{
    double Q[6];
    const double *D = galerkin_plain (g, PG_FACETS, q)->D;
    traction_row (g->dim, k, normal (g, q), Q);
    for (int v = 0; v < g->nv; v++) QD[v] = 0;
    for (int w = 0; w < g->nv; w++)
        for (int v = 0; v < g->nv && Q[w] != 0; v++) QD[v] += D[w * g->nv + v] * Q[w];
}

/* Adds Nitsche's terms of one constraint, between node a and m nodes b; wN: w N_a; wt: w times the traction
 * t_a of unit displacements of node a; QD as in traction_of_strain; press: beta w N_a. The block of the next
 * node begins `next` numbers further on, its next row `row` numbers. */
static inline __attribute__ ((always_inline)) void add_nitsche (size_t dim, size_t k, const double *QD,
                                                                double wN, const double *wt, double press,
                                                                size_t m, const double *N, const double *dN,
                                                                size_t next, size_t row, double *out)
{
    double tb[3];
    for (size_t b = 0; b < m; b++, dN += dim, out += next) {
        galerkin_B_transpose ((int) dim, dN, QD, tb);
        for (size_t c = 0; c < dim; c++) {
            out[k * row + c] -= wN * tb[c];
            out[c * row + k] -= wt[c] * N[b];
        }
        out[k * row + k] += press * N[b];
    }
}

/* Adds Nitsche's terms of one facet point, between its node a and its first m nodes (blocks m x dim x dim):
 * -N_a (sigma (N_b) n) - (sigma (N_a) n) N_b + beta N_a N_b for the prescribed components. The second term
 * makes K symmetric and costs no accuracy, as it vanishes at the solution. */
static void facet_terms (const galerkin *g, size_t p, size_t a, size_t m, size_t next, size_t row,
                         double *out)
{
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim, first = r->family.start[p];
    const double *N = r->N + first, *dN = r->dN + first * dim;
    double w = r->weight[p], press = w * beta (g, p) * N[a], QD[6], wt[3];
    for (size_t i = g->supports.nitsche_start[p]; i < g->supports.nitsche_start[p + 1]; i++) {
        size_t k = (size_t) g->supports.nitsche[i].component;
        traction_of_strain (g, p, (int) k, QD);
        galerkin_B_transpose (g->dim, dN + a * dim, QD, wt);
        for (size_t c = 0; c < dim; c++) wt[c] *= w;
        if (dim == 3) add_nitsche (3, k, QD, w * N[a], wt, press, m, N, dN, next, row, out);
        else if (dim == 2) add_nitsche (2, k, QD, w * N[a], wt, press, m, N, dN, next, row, out);
        else add_nitsche (dim, k, QD, w * N[a], wt, press, m, N, dN, next, row, out);
    }
}

void galerkin_facet_blocks (void *context, size_t p, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    facet_terms (g, p, a, m, (size_t) (g->dim * g->dim), (size_t) g->dim, out);
}

void galerkin_facet_rows (void *context, size_t p, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    facet_terms (g, p, a, m, (size_t) g->dim, m * (size_t) g->dim, out);
}

/* Stiffness of a constraint at a node, N/m. Of a spring: the node's share of it. Of a penalty: factor E / h^2
 * times the node's volume, so that a layer of points one spacing deep is held by springs of factor E / h per
 * area. */
static double penalty (const galerkin *g, const constraint *q)
{
    const pg_problem *p = g->problem;
    size_t node = (size_t) g->supports.penalty_node[q->point];
    double h = pg_problem_spacing (p, PG_NODES, node);
    const pg_load *load = &p->boundary.load[q->load];
    if (load->kind == PG_SPRING) {
        const int own = (int) node, *at = pg_search (&own, load->set->point, load->set->npoint, sizeof own,
                                                   pg_ascending_ints);
        return load->stiffness[q->component] * pg_load_share (load, (size_t) (at - load->set->point));
    }
    return p->boundary.load[q->load].penalty * galerkin_material (g, PG_NODES, node)->modulus / (h * h)
           * p->cloud.volume[node];
}

/* Stiffness of constraints as springs, N/m: beta times the weight of the facet point; the penalty of the
 * node. */
double galerkin_nitsche_stiffness (const galerkin *g, const constraint *q)
{
    return beta (g, q->point) * g->rows[PG_FACETS].weight[q->point];
}

double galerkin_penalty_stiffness (const galerkin *g, const constraint *q) { return penalty (g, q); }

/* Adds the penalty of one node, between two nodes that its displacement depends on: penalty N_a N_b. */
void galerkin_penalty_blocks (void *context, size_t p, size_t a, size_t m, double *out)
{
    galerkin *g = context;
    const pg_rows *r = &g->rows[PG_NODES];
    size_t dim = (size_t) g->dim, node = (size_t) g->supports.penalty_node[p],
           first = r->family.start[node] + pg_rows_offset (r, node);
    for (size_t i = g->supports.penalty_start[p]; i < g->supports.penalty_start[p + 1]; i++) {
        size_t k = (size_t) g->supports.penalty[i].component;
        for (size_t b = 0; b < m; b++)
            out[b * dim * dim + k * dim + k] += penalty (g,
                                                         &g->supports.penalty[i]) 
                              * r->N[first + a] * r->N[first + b];
    }
}

/* ---- what each term adds ------------------------------------------------------------------------------- */
/* visit (context, set, point, load, component, force, displacement): `force`, N, acts on the body at that
 * point of that set along axis `component`; displacement, m, is conjugate to it. */
typedef void (*visitor) (void *context, int set, size_t point, int load, int k, double force,
                         double displacement);

/* Traction of one constraint, Pa: that of the stress at the facet point minus beta times the gap (m) between
 * displacement and prescribed value. */
static double nitsche_traction (const galerkin *g, const constraint *q, double gap)
{
    double Q[6], t = 0;
    const double *s = g->measured.stress[PG_FACETS] + q->point * (size_t) g->nv;
    traction_row (g->dim, q->component, normal (g, q->point), Q);
    for (int v = 0; v < g->nv; v++) t += Q[v] * s[v];
    return t - beta (g, q->point) * gap;
}

/* Calls `visit` with the force on every prescribed component, N, and the displacement that is prescribed
 * there, m: together they are the work of the supports. */
static void visit_supports (galerkin *g, double t, visitor visit, void *context)
{
    galerkin_supports *c = &g->supports;
    size_t dim = (size_t) g->dim;
    galerkin_dilatation_gaps (g, t);
    for (size_t i = 0; i < c->nnitsche; i++) {
        const constraint *q = &c->nitsche[i];
        double u = g->measured.u[PG_FACETS][q->point * dim + (size_t) q->component];
        double goal = galerkin_prescribed (g, q, PG_FACETS, t);
        visit (context, PG_FACETS, q->point, q->load, q->component,
               g->rows[PG_FACETS].weight[q->point]
                   * (nitsche_traction (g, q, u - goal) + galerkin_dilatation_traction (g, q)),
               goal);
    }
    for (size_t i = 0; i < c->npenalty; i++) {
        const constraint *q = &c->penalty[i];
        size_t node = (size_t) c->penalty_node[q->point];
        double u = g->measured.u[PG_NODES][node * dim + (size_t) q->component];
        double goal = galerkin_prescribed (g, q, PG_NODES, t);
        visit (context, PG_NODES, node, q->load, q->component, -penalty (g, q) * (u - goal), goal);
    }
}

/* Calls `visit` for a traction or pressure at every facet point of its set: weight times value; a
 * pressure pushes against the outward normal. */
static void visit_facet_load (const galerkin *g, double t, int l, visitor visit, void *context)
{
    const pg_load *load = &g->problem->boundary.load[l];
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim;
    for (size_t q = 0; q < r->n; q++) {
        if (!member (load->set->facet, load->set->nfacet, r->cell[q])) continue;
        for (size_t k = 0; k < dim; k++) {
            int pressure = load->kind == PG_PRESSURE;
            double f = pg_load_value (load, pressure ? 0 : (int) k, g->dim, r->x + q * dim, t);
            visit (context, PG_FACETS, q, l, (int) k, r->weight[q] * (pressure ? -f * normal (g, q)[k] : f),
                   g->measured.u[PG_FACETS][q * dim + k]);
        }
    }
}

/* Calls `visit` for a total force, shared equally by the points of its set, or a force per volume. A body
 * force on all points is integrated at the evaluation points like everything else; on a set of some
 * points each takes its own volume. */
static void visit_point_load (const galerkin *g, double t, int l, visitor visit, void *context)
{
    const pg_load *load = &g->problem->boundary.load[l];
    size_t dim = (size_t) g->dim;
    int everywhere = is_everywhere (g, load),
        set = everywhere ? g->bulk : PG_NODES;
    const pg_rows *r = &g->rows[set];
    size_t count = everywhere ? r->n : load->set->npoint;
    for (size_t i = 0; i < count; i++) {
        size_t q = everywhere ? i : (size_t) load->set->point[i];
        double share = load->kind == PG_BODY_FORCE
                           ? r->weight[q] * pg_load_density (g->problem, load, set, q)
                           : pg_load_share (load, i);
        const double *x = pg_load_site (load, r->x + q * dim);
        for (size_t k = 0; k < dim; k++)
            visit (context, set, q, l, (int) k, share * pg_load_value (load, (int) k, g->dim, x, t),
                   g->measured.u[set][q * dim + k]);
    }
}

/* Calls `visit` for all loads, according to their kinds. */
static void visit_loads (const galerkin *g, double t, visitor visit, void *context)
{
    for (size_t l = 0; l < g->problem->boundary.nload; l++) {
        pg_load_kind kind = g->problem->boundary.load[l].kind;
        if (kind == PG_TRACTION || kind == PG_PRESSURE) visit_facet_load (g, t, (int) l, visit, context);
        if (kind == PG_POINT_FORCE || kind == PG_BODY_FORCE) visit_point_load (g, t, (int) l, visit, context);
    }
}

/* Pressure of load l in cracks, uniform, Pa. */
static double pressure_at (const galerkin *g, size_t l, double t)
{
    static const double anywhere[3] = { 0 };
    return pg_load_value (&g->problem->boundary.load[l], 0, g->dim, anywhere, t);
}

typedef struct { galerkin *g; double *f; } spreading;

/* Distributes a force at a point to the nodes that its displacement depends on, by their shape functions. */
static void spread (void *context, int set, size_t point, int load, int k, double force, double displacement)
{
    const spreading *s = context;
    const pg_rows *r = &s->g->rows[set];
    (void) load, (void) displacement;
    for (size_t e = r->family.start[point]; e < r->family.start[point + 1]; e++)
        s->f[(size_t) r->family.node[e] * (size_t) s->g->dim + (size_t) k]
            += r->N[e + pg_rows_offset (r, point)] * force;
}

/* y += K x of the constraints first .. last - 1, all at one facet point: displacement u and gradient H of x
 * there give the forces N_j F and B_j' S of each node, F_k = w (beta u_k - (sigma n)_k) and S = - w sum_k u_k
 * D' Q_k over the prescribed components. Two passes over the bonds, however many components there are; dim is
 * a compile-time constant. */
static inline void apply_point (int dim, galerkin *g, size_t first, size_t last, const double *x, double *y)
{
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t p = g->supports.nitsche[first].point, d = (size_t) dim, begin = r->family.start[p],
           end = r->family.start[p + 1];
    double u[3] = { 0 }, H[9] = { 0 }, F[3] = { 0 }, S[6] = { 0 }, e[6] = { 0 }, QD[6], w = r->weight[p];
    for (size_t b = begin; b < end; b++) {
        const double *at = x + (size_t) r->family.node[b] * d, *q = r->dN + b * d;
        for (size_t c = 0; c < d; c++) {
            u[c] += r->N[b] * at[c];
            for (size_t a = 0; a < d; a++) H[c * d + a] += at[c] * q[a];
        }
    }
    for (int c = 0; c < dim; c++)
        for (int a = 0; a < dim; a++) e[pg_voigt_at (dim, c, a)] += H[c * dim + a];
    for (size_t i = first; i < last; i++) {
        int k = g->supports.nitsche[i].component;
        double t = 0;
        traction_of_strain (g, p, k, QD);
        for (int v = 0; v < g->nv; v++) t += QD[v] * e[v], S[v] -= w * u[k] * QD[v];
        F[k] = w * (beta (g, p) * u[k] - t);
    }
    for (int c = 0; c < dim; c++)
        for (int a = 0; a < dim; a++) H[c * dim + a] = S[pg_voigt_at (dim, c, a)];
    for (size_t b = begin; b < end; b++) {
        double *to = y + (size_t) r->family.node[b] * d;
        const double *q = r->dN + b * d;
        for (size_t c = 0; c < d; c++) {
            double f = r->N[b] * F[c];
            for (size_t a = 0; a < d; a++) f += H[c * d + a] * q[a];
            to[c] += f;
        }
    }
}

/* y += K x of the supports. Prescribed values do not enter: K is the derivative of the forces. */
void galerkin_boundary_apply (galerkin *g, const double *x, double *y)
{
    galerkin_supports *c = &g->supports;
    size_t dim = (size_t) g->dim;
    for (size_t i = 0, end = 0; i < c->nnitsche; i = end) {
        while (end < c->nnitsche && c->nitsche[end].point == c->nitsche[i].point) end++;
        if (dim == 3) apply_point (3, g, i, end, x, y);
        else if (dim == 2) apply_point (2, g, i, end, x, y);
        else apply_point (1, g, i, end, x, y);
    }
    for (size_t i = 0; i < c->npenalty; i++) {
        const constraint *q = &c->penalty[i];
        size_t node = (size_t) c->penalty_node[q->point];
        const pg_rows *n = &g->rows[PG_NODES];
        const double *N = n->N + pg_rows_offset (n, node);
        double u = 0;
        for (size_t e = n->family.start[node]; e < n->family.start[node + 1]; e++)
            u += N[e] * x[(size_t) n->family.node[e] * dim + (size_t) q->component];
        for (size_t e = n->family.start[node]; e < n->family.start[node + 1]; e++)
            y[(size_t) n->family.node[e] * dim + (size_t) q->component] += penalty (g, q) * N[e] * u;
    }
}

/* Adds int (sigma (v) n)_k (u_k - g_k) to f: the symmetric counterpart of the traction, which is no force on
 * the body and so no part of reactions. */
static void add_adjoint (galerkin *g, double t, double *f)
{
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim;
    for (size_t i = 0; i < g->supports.nnitsche; i++) {
        const constraint *q = &g->supports.nitsche[i];
        double QD[6], part[3], goal = galerkin_prescribed (g, q, PG_FACETS, t);
        double gap = r->weight[q->point] * (g->measured.u[PG_FACETS][q->point * dim + (size_t) q->component]
                                            - goal);
        traction_of_strain (g, q->point, q->component, QD);
        for (size_t e = r->family.start[q->point]; e < r->family.start[q->point + 1]; e++) {
            galerkin_B_transpose (g->dim, r->dN + e * dim, QD, part);
            for (size_t c = 0; c < dim; c++) f[(size_t) r->family.node[e] * dim + c] += gap * part[c];
        }
    }
    galerkin_dilatation_adjoint (g, f);
}

void galerkin_loads (galerkin *g, double t, double *P)
{
    spreading s = { g, P };
    memset (P, 0, g->n * (size_t) g->dim * sizeof *P);
    visit_loads (g, t, spread, &s);
    for (size_t l = 0; l < g->problem->boundary.nload; l++)
        if (g->problem->boundary.load[l].cracks) galerkin_crack_pressure (g, pressure_at (g, l, t), P);
}

/* Adds loads and supports to the residual, N; *external and *reaction: their sums of squares, N^2, for the
 * reference of the residual. */
void galerkin_boundary_force (galerkin *g, double t, const double *d, double *residual, double *external,
                              double *reaction)
{
    size_t ndof = g->n * (size_t) g->dim;
    spreading s = { g, g->work };
    (void) d;
    galerkin_loads (g, t, g->work);
    *external = galerkin_squared (g, g->work);
    for (size_t i = 0; i < ndof; i++) residual[i] += g->work[i];
    memset (g->work, 0, ndof * sizeof *g->work);
    visit_supports (g, t, spread, &s);
    *reaction = galerkin_squared (g, g->work);
    add_adjoint (g, t, g->work);
    for (size_t i = 0; i < ndof; i++) residual[i] += g->work[i];
}

/* Energy of the boundary terms, J: -int (u - g) (sigma n) + (beta / 2) int (u - g)^2, and that of penalty
 * springs. With it the work of the supports equals the stored energy exactly as long as nothing breaks. */
double galerkin_boundary_energy (galerkin *g, double t)
{
    galerkin_supports *c = &g->supports;
    size_t dim = (size_t) g->dim;
    double sum = 0;
    galerkin_dilatation_gaps (g, t);
    for (size_t i = 0; i < c->nnitsche; i++) {
        const constraint *q = &c->nitsche[i];
        if (!pg_problem_owns (g->problem, PG_FACETS, q->point)) continue;
        double goal = galerkin_prescribed (g, q, PG_FACETS, t);
        double gap = g->measured.u[PG_FACETS][q->point * dim + (size_t) q->component] - goal;
        sum -= g->rows[PG_FACETS].weight[q->point] * gap * 0.5
               * (nitsche_traction (g, q, gap) + nitsche_traction (g, q,
                                                                   0) + galerkin_dilatation_traction (g, q));
    }
    for (size_t i = 0; i < c->npenalty; i++) {
        const constraint *q = &c->penalty[i];
        size_t node = (size_t) c->penalty_node[q->point];
        if (!pg_problem_owns (g->problem, PG_NODES, node)) continue;
        double goal = galerkin_prescribed (g, q, PG_NODES, t);
        double gap = g->measured.u[PG_NODES][node * dim + (size_t) q->component] - goal;
        sum += 0.5 * penalty (g, q) * gap * gap;
    }
    return sum;
}

/* ---- work_balance -------------------------------------------------------------------------------------- */
/* A visitor (`visit`) that counts its calls. */
static void count_pair (void *context, int set, size_t point, int load, int k, double force,
                        double displacement)
{
    (void) set, (void) point, (void) load, (void) k, (void) force, (void) displacement;
    ++*(size_t *) context;
}

/* Number of pairs of force and displacement of supports and loads, found by counting visits. */
size_t galerkin_boundary_pairs (galerkin *g)
{
    size_t n = 0;
    visit_supports (g, 0, count_pair, &n);
    visit_loads (g, 0, count_pair, &n);
    for (size_t l = 0; l < g->problem->boundary.nload; l++) n += g->problem->boundary.load[l].cracks != 0;
    return n;
}

typedef struct { const galerkin *g; pg_work_balance *out; size_t at; } writing;

/* A visitor that writes force and displacement, and sums up reactions and their moments by load and
 * component. Forces at points that other ranks own are 0 here. */
static void write_pair (void *context, int set, size_t point, int load, int k, double force,
                        double displacement)
{
    writing *w = context;
    const pg_problem *p = w->g->problem;
    double at[3];
    if (!pg_problem_owns (p, set, point)) force = 0;
    pg_load_add_moment (&p->boundary.load[load], p->dim, galerkin_place (w->g, set, point, at), k, force,
                        w->out->reaction + 3 * (p->boundary.nload + (size_t) load));
    w->out->force[w->at] = force, w->out->displacement[w->at++] = displacement;
    w->out->reaction[load * 3 + k] += force;
}

/* Writes the pairs of supports, loads and crack pressures, and the reactions; returns the number of pairs. */
size_t galerkin_boundary_work_balance (galerkin *g, double t, const double *d, pg_work_balance *out)
{
    writing w = { g, out, 0 };
    visit_supports (g, t, write_pair, &w);
    visit_loads (g, t, write_pair, &w);
    for (size_t l = 0; l < g->problem->boundary.nload; l++) {
        if (!g->problem->boundary.load[l].cracks) continue;
        out->force[w.at] = pressure_at (g, l, t);      /* conjugate to the volume of the cracks */
        out->displacement[w.at++] = galerkin_crack_volume (g, d);
    }
    return w.at;
}
