/* SPDX-License-Identifier: GPL-3.0-or-later
 * Displacement, its gradient and stress at arbitrary positions, by the method's own shape functions
 * evaluated there. A bond from a position to a node counts as intact if no crack cuts it and the nearest
 * evaluation point and the nearest node on the same side of the cracks (all of them where several are
 * equally near) still have an intact bond to that node. Where that leaves a poorer basis than the nearest
 * evaluation point q has, the first-order expansion u_q + grad u_q (x - x_q) and the stress of q are used.
 * This keeps the two faces of a crack apart. Bodies without cracks and broken bonds skip these tests, and on
 * a lattice most positions share the shape functions of another one (galerkin_sample_alike.c). */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include <stdatomic.h>
#include <stdint.h>
#include <string.h>

/* CHUNK: positions evaluated at a time, which bounds the memory. Looking for positions with equal
 * surroundings pays from MANY positions on, if there is at least one for every SHARE nodes. */
enum { CHUNK = 8192, MANY = 1024, SHARE = 8 };

typedef struct {
    galerkin *g;
    const pg_state *state;
    const double *d;
    /* intact: there is no crack and no broken bond. uniform: intact, one material, and every point has its
     * full basis, so that no position needs to know its nearest evaluation point. */
    int intact, uniform;
    pg_rows rows;                                      /* of the positions being sampled */
    unsigned char *alive;
    _Atomic unsigned char *held;                       /* per node: result of is_held; 0: not computed yet */
    size_t *at;                                        /* nearest evaluation point of each position */
    double time;                                       /* of the state, s; static: load factor */
    double *u, *stress, *gradient;                     /* n x 3; n x 6, n x 9 or NULL */
    const double *pressure;          /* pressure of the dilatation patches at the nodes, Pa (n); NULL: none */
} sampling;

/* Does a crack lie between the positions x and y? */
static int cut (const sampling *s, const double *x, const double *y)
{
    const pg_problem *p = s->g->problem;
    return pg_cracks_cut (pg_state_cracks (p, s->state), x, y, pg_cloud_same (&p->cloud)) != NULL;
}

static const double *node_at (const galerkin *g, int node)
{
    return g->problem->cloud.x + (size_t) node * (size_t) g->dim;
}

static int point_hidden (void *context, const double *place, size_t point)
{
    const sampling *s = context;
    return cut (s, place, s->g->rows[s->g->bulk].x + point * (size_t) s->g->dim);
}

static int node_hidden (void *context, const double *place, size_t node)
{
    const sampling *s = context;
    return cut (s, place, node_at (s->g, (int) node));
}

/* Is bond e of a point broken for another reason than that a pre-crack cuts it? */
static int broken (const sampling *s, int set, size_t point, size_t e)
{
    const galerkin *g = s->g;
    const pg_rows *r = &g->rows[set];
    if (s->state->alive[g->problem->bonds.first[set] + e] || r->family.node[e] == r->own[point]) return 0;
    return !cut (s, r->x + point * (size_t) g->dim, node_at (g, r->family.node[e]));
}

static int hurt (const sampling *s, int set, size_t point)
{
    const pg_family *f = &s->g->rows[set].family;
    for (size_t e = f->start[point]; e < f->start[point + 1]; e++) if (broken (s, set, point, e)) return 1;
    return 0;
}

enum { ALIVE, CUT, LOST, UNKNOWN };
/* State of the bond from a point to node j: ALIVE: intact; CUT: cut by a pre-crack; LOST: broken during the
 * run; UNKNOWN: j is not in the family of the point. */
static int view (const sampling *s, int set, size_t point, int j)
{
    const pg_family *f = &s->g->rows[set].family;
    size_t low = f->start[point], high = f->start[point + 1];
    while (low < high) {
        size_t middle = (low + high) / 2;
        if (f->node[middle] < j) low = middle + 1;
        else high = middle;
    }
    if (low == f->start[point + 1] || f->node[low] != j) return UNKNOWN;
    if (s->state->alive[s->g->problem->bonds.first[set] + low]) return ALIVE;
    return broken (s, set, point, low) ? LOST : CUT;
}

/* Has one of the evaluation points nearest to node j, on its side of the cracks, an intact bond to it? If
 * not, nothing resists a displacement of the node, such as between two cracks, and its coefficient means
 * nothing. Threads that compute it twice get the same result. */
static int is_held (sampling *s, int j)
{
    enum { HELD = 1, LOOSE };
    const galerkin *g = s->g;
    size_t point[PG_NEAREST_MOST], n;
    int known = atomic_load_explicit (&s->held[j], memory_order_relaxed);
    if (known) return known == HELD;
    known = LOOSE;
    n = pg_nearest_all (g->places.near_point, node_at (g, j), PG_NO_LENGTH * g->problem->cloud.h,
                        point_hidden, s,
                        point);
    for (size_t k = 0; k < n; k++) if (view (s, g->bulk, point[k], j) == ALIVE) known = HELD;
    atomic_store_explicit (&s->held[j], (unsigned char) known, memory_order_relaxed);
    return known == HELD;
}

/* Points of a bond set that are equally near to a position. */
typedef struct { int set; size_t n, point[PG_NEAREST_MOST]; } nearest_points;

/* The nearest points that no pre-crack hides from x; the nearest ones where all are hidden. */
static void find_nearest (sampling *s, const double *x, int set, nearest_points *out)
{
    const galerkin *g = s->g;
    const pg_nearest *grid = set == g->bulk ? g->places.near_point : g->places.near_node;
    pg_refuse refuse = set == g->bulk ? point_hidden : node_hidden;
    double same = PG_NO_LENGTH * g->problem->cloud.h;
    if (!pg_state_cracks (g->problem, s->state)->n) refuse = NULL;
    out->set = set, out->n = pg_nearest_seen (grid, x, same, refuse, s, out->point);
}

/* State of the bonds from all points q to node j: ALIVE if one of them is intact, else LOST if one has
 * broken, else CUT or UNKNOWN. */
static int view_of_all (const sampling *s, const nearest_points *q, int j)
{
    int answer = UNKNOWN;
    for (size_t k = 0; k < q->n && answer != ALIVE; k++) {
        int now = view (s, q->set, q->point[k], j);
        if (now == ALIVE || now == LOST || answer == UNKNOWN) answer = now;
    }
    return answer;
}

/* Does a position interact with node j? Decided by the bonds of its nearest evaluation points q, then by
 * those of its nearest nodes i. A node at the rim of the support that is in none of these families counts,
 * unless both it and one of i (lost) have lost bonds. */
static int sees (sampling *s, const nearest_points *q, const nearest_points *i,
                 int lost /* 1: one of the nodes i has lost bonds */, int j)
{
    int answer = view_of_all (s, q, j);
    if (answer == ALIVE || answer == LOST) return answer == ALIVE;
    if (q->set == PG_NODES) return answer == CUT || !(lost && hurt (s, PG_NODES, (size_t) j));
    if (!is_held (s, j)) return 0;
    if (answer == UNKNOWN) answer = view_of_all (s, i, j);
    return answer == UNKNOWN ? !(lost && hurt (s, PG_NODES, (size_t) j)) : answer != LOST;
}

/* The one of the nearest evaluation points q with the fullest basis; the basis of a position is compared with
 * it. */
static size_t best_of (const sampling *s, const nearest_points *q)
{
    const unsigned char *grade = s->g->rows[q->set].grade;
    size_t best = q->point[0];
    for (size_t k = 1; k < q->n; k++) {
        size_t now = q->point[k];
        if (grade[now] < grade[best] || (grade[now] == grade[best] && now < best)) best = now;
    }
    return best;
}

static void find_bonds (void *context, size_t first, size_t last, int thread)
{
    sampling *s = context;
    const galerkin *g = s->g;
    const pg_family *f = &s->rows.family;
    (void) thread;
    for (size_t p = first; p < last; p++) {
        const double *x = s->rows.x + p * (size_t) g->dim;
        nearest_points q, i;
        int lost = 0;
        find_nearest (s, x, g->bulk, &q);
        if (g->bulk == PG_NODES) i = q;
        else find_nearest (s, x, PG_NODES, &i);
        s->at[p] = best_of (s, &q);
        for (size_t k = 0; k < i.n; k++) lost |= hurt (s, PG_NODES, i.point[k]);
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
            int j = f->node[e];
            s->alive[e] = j == s->rows.own[p]
                          || (!cut (s, x, node_at (g, j)) && sees (s, &q, &i, lost, j));
        }
    }
}

/* Finds only the nearest evaluation point of each position; used where no bond is lost. */
static void find_points (void *context, size_t first, size_t last, int thread)
{
    sampling *s = context;
    (void) thread;
    for (size_t p = first; p < last; p++) {
        nearest_points q;
        find_nearest (s, s->rows.x + p * (size_t) s->g->dim, s->g->bulk, &q);
        s->at[p] = best_of (s, &q);
    }
}

/* Sets `intact` (all bonds of nodes and evaluation points are there, and no crack is) and `uniform` (one
 * material, and all points have their full basis). */
static void look_over (sampling *s)
{
    const galerkin *g = s->g;
    const pg_problem *p = g->problem;
    const pg_rows *bulk = &g->rows[g->bulk];
    s->intact = pg_state_cracks (p, s->state)->n == 0;
    for (int set = PG_NODES; set <= PG_POINTS && s->intact; set++) {
        size_t bonds = p->bonds.first[set + 1] - p->bonds.first[set];
        s->intact = !bonds || !memchr (s->state->alive + p->bonds.first[set], 0, bonds);
    }
    s->uniform = s->intact && p->at.nlaw == 1;
    for (size_t q = 0; q < bulk->n && s->uniform; q++) s->uniform = bulk->grade[q] == PG_GRADE_FULL;
}

/* u and its gradient H[c * dim + k] = du_c/dx_k from row `at` of r; inlined with dim known, so that loops
 * unroll. */
static inline __attribute__ ((always_inline)) void add_up (size_t dim, const pg_rows *r, size_t at,
                                                           const double *nodal, double *u, double *H)
{
    double v[3] = { 0 }, G[9] = { 0 };
    size_t offset = pg_rows_offset (r, at);
    for (size_t e = r->family.start[at]; e < r->family.start[at + 1]; e++) {
        const double *d = nodal + (size_t) r->family.node[e] * dim;
        for (size_t c = 0; c < dim; c++) {
            v[c] += r->N[e + offset] * d[c];
            for (size_t k = 0; k < dim; k++) G[c*dim + k] += r->dN[(e + offset) * dim + k] * d[c];
        }
    }
    memcpy (u, v, sizeof v), memcpy (H, G, sizeof G);
}

static void gradient (const sampling *s, const pg_rows *r, size_t at, double *u, double *H)
{
    if (s->g->dim == 3) add_up (3, r, at, s->d, u, H);
    else if (s->g->dim == 2) add_up (2, r, at, s->d, u, H);
    else add_up (1, r, at, s->d, u, H);
}

void pg_stress_of_gradient (const pg_material *m, int dim, const double *H, double *stress)
{
    double e[6] = { H[0] }, s[6], zz = 0;
    memset (stress, 0, 6 * sizeof *stress);
    if (dim == 2) e[1] = H[3], e[2] = H[1] + H[2];
    if (dim == 3) e[1] = H[4], e[2] = H[8], e[3] = H[1] + H[3], e[4] = H[5] + H[7], e[5] = H[2] + H[6];
    m->type->stress (m, 1, e, s, &zz);
    if (dim == 3) memcpy (stress, s, 6 * sizeof *stress);
    else stress[0] = s[0];
    if (dim == 2) stress[1] = s[1], stress[2] = zz, stress[3] = s[2];
}

/* The pressure of the dilatation patches (Pa) at row `at` of r, interpolated by the shape functions from the
 * nodes that have the material of `point`. */
static double pressure (const sampling *s, const pg_rows *r, size_t at, size_t point)
{
    const galerkin *g = s->g;
    double sum = 0, share = 0;
    if (!s->pressure) return 0;
    for (size_t e = r->family.start[at]; e < r->family.start[at + 1]; e++) {
        size_t j = (size_t) r->family.node[e];
        double N = r->N[e + pg_rows_offset (r, at)];
        if (g->material[PG_NODES][j] == g->material[g->bulk][point]) sum += N * s->pressure[j], share += N;
    }
    return share > 0.1 ? sum / share : 0;
}

/* First-order expansion to x of u and its gradient at the nearest evaluation point q, averaged over all
 * points that are equally near, so that the result depends neither on numbering nor on rounding. Returns the
 * pressure of the dilatation patches there, Pa. */
static double go_on_from (sampling *s, const double *x, size_t q, double *u, double *H)
{
    double sum = 0;
    const galerkin *g = s->g;
    const pg_rows *bulk = &g->rows[g->bulk];
    size_t dim = (size_t) g->dim;
    double from[3], G[9];
    size_t all[PG_NEAREST_MOST], n;
    n = pg_nearest_all (g->places.near_point, x, PG_NO_LENGTH * g->problem->cloud.h,
                        s->intact ? NULL : point_hidden,
                        s, all);
    if (!n) n = 1, all[0] = q;
    memset (u, 0, 3 * sizeof *u), memset (H, 0, 9 * sizeof *H);
    for (size_t m = 0; m < n; m++) {
        gradient (s, bulk, all[m], from, G);
        sum += pressure (s, bulk, all[m], q) / (double) n;
        for (size_t c = 0; c < dim; c++) {
            u[c] += from[c] / (double) n;
            for (size_t k = 0; k < dim; k++) {
                double z = x[k] - bulk->x[all[m] * dim + k], part = G[c * dim + k] / (double) n;
                u[c] += part * z, H[c * dim + k] += part;
            }
        }
    }
    return sum;
}

static void evaluate (void *context, size_t first, size_t last, int thread)
{
    sampling *s = context;
    const galerkin *g = s->g;
    const pg_rows *bulk = &g->rows[g->bulk];
    size_t dim = (size_t) g->dim;
    (void) thread;
    for (size_t p = first; p < last; p++) {
        size_t q = s->uniform ? 0 : s->at[p];
        double *u = s->u + 3*p, H[9], more;
        if (s->uniform && s->rows.grade[p] > bulk->grade[q])
            q = (size_t) pg_nearest_find (g->places.near_point, s->rows.x + p * dim, NULL, NULL);
        int whole = s->rows.grade[p] <= bulk->grade[q];
        if (whole) gradient (s, &s->rows, p, u, H), more = pressure (s, &s->rows, p, q);
        else more = go_on_from (s, s->rows.x + p * dim, q, u, H);
        if (s->gradient) memcpy (s->gradient + 9*p, H, sizeof H);
        if (!s->stress) continue;
        pg_stress_of_gradient (galerkin_plain (g, g->bulk, q), g->dim, H, s->stress + 6*p);
        galerkin_eigen_relieve (g, s->time, s->rows.x + p * dim, q, s->stress + 6*p);
        for (int k = 0; k < 3; k++) s->stress[6*p + (size_t) k] += more;
    }
}

/* own (n): the node that each position coincides with, -1: none. Approximations that expand about a node do
 * so there. */
static void find_nodes (const galerkin *g, size_t n, const double *x, int *own)
{
    for (size_t p = 0; p < n; p++) {
        long j = pg_nearest_find (g->places.near_node, x + p * (size_t) g->dim, NULL, NULL);
        double away = 0;
        for (int k = 0; k < g->dim; k++) {
            double step = x[p * (size_t) g->dim + (size_t) k] - node_at (g, (int) j)[k];
            away += step * step;
        }
        own[p] = sqrt (away) <= pg_cloud_same (&g->problem->cloud) ? (int) j : -1;
    }
}

/* Shape functions at n positions, and, where bonds are lost or materials differ, the evaluation points
 * nearest to them. */
static pg_status make_rows (sampling *s, size_t n, const double *x, int *own)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->g->problem;
    size_t bonds, dim = (size_t) s->g->dim;
    pg_approx a = p->form.approx;
    a.refined = 0;                                 /* positions with equal surroundings share their row */
    int about_nodes = p->form.approx.type->interpolates || !s->intact;
    if (about_nodes) find_nodes (s->g, n, x, own);
    PG_TRY (pg_rows_place (&s->rows, s->g->places.search, &p->cloud, n, x, NULL, about_nodes ? own : NULL,
                           NULL,
                           NULL, s->g->threads));
    bonds = s->rows.family.start[n];
    PG_ALLOC (s->rows.N, bonds);                       /* w is left NULL: not needed here */
    PG_ALLOC (s->rows.dN, bonds * dim);
    PG_ALLOC (s->rows.grade, n);
    if (!s->intact) PG_ALLOC (s->alive, bonds);
    if (!s->intact) PG_ALLOC (s->held, s->g->n);
    if (!s->intact) pg_parallel (s->g->threads, n, find_bonds, s);
    else if (!s->uniform) pg_parallel (s->g->threads, n, find_points, s);
    PG_TRY (a.type->evaluate (&a, &p->cloud, &s->rows, s->alive, n, NULL, s->g->threads));
done:
    pg_free (s->alive), pg_free (s->held), s->alive = NULL, s->held = NULL;
    return status;
}

/* Samples the positions of a chunk that need shape functions of their own. leaves[i] >= 0: the key under
 * which those of position i are kept for others with equal surroundings (leaves NULL: none are kept). */
static pg_status sample_each (sampling *s, size_t n, const double *x, int *own, const int *leaves)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) s->g->dim;
    PG_TRY (make_rows (s, n, x, own));
    pg_parallel (s->g->threads, n, evaluate, s);
    for (size_t i = 0; leaves && i < n; i++)
        if (leaves[i] >= 0) galerkin_alike_keep (s->g->places.alike, leaves[i], &s->rows, i, x + i * dim);
done:
    pg_rows_clear (&s->rows);
    return status;
}

/* Positions near cracks that may be sampled again: uses kept shape functions if there are any, else computes
 * and keeps new ones. */
static pg_status sample_again (sampling *s, size_t n, const double *x, int *own)
{
    pg_status status = PG_OK;
    const pg_rows *rows;
    size_t *at;
    PG_TRY (galerkin_again_find (s->g, s->state, n, x, &rows, &at));
    if (rows) {
        sampling again = *s;
        again.rows = *rows, again.at = at;
        pg_parallel (s->g->threads, n, evaluate, &again);
        return PG_OK;
    }
    PG_TRY (make_rows (s, n, x, own));
    pg_parallel (s->g->threads, n, evaluate, s);
    PG_TRY (galerkin_again_keep (s->g, s->state, n, x, &s->rows, &s->at));
done:
    pg_rows_clear (&s->rows);
    return status;
}

/* ---- positions with equal surroundings ----------------------------------------------------------------- */
/* Sampling by kept shape functions: which (n): key of each position, value: scratch of each thread. */
typedef struct { const sampling *s; const double *x; const int *which; double *value; } by_rows;

static void evaluate_alike (void *context, size_t first, size_t last, int thread)
{
    const by_rows *b = context;
    const sampling *s = b->s;
    const galerkin *g = s->g;
    size_t held = SIZE_MAX;
    double *value = b->value + (size_t) thread * galerkin_alike_scratch (g->places.alike), H[9];
    for (size_t p = first; p < last; p++) {
        if (b->which[p] < 0) continue;
        galerkin_alike_values (g->places.alike, b->which[p], b->x + p * (size_t) g->dim, s->d, value, &held,
                               s->u + 3*p, H);
        if (s->gradient) memcpy (s->gradient + 9*p, H, sizeof H);
        if (!s->stress) continue;
        pg_stress_of_gradient (galerkin_plain (g, g->bulk, 0), g->dim, H, s->stress + 6*p);
        galerkin_eigen_relieve (g, s->time, b->x + p * (size_t) g->dim, 0, s->stress + 6*p);
    }
}

/* Samples the listed positions with shape functions of their own and writes the results into the chunk's
 * arrays. */
static pg_status sample_rest (const sampling *chunk, size_t n, const size_t *rest, const int *leaves,
                              const double *x, int *own)
{
    pg_status status = PG_OK;
    sampling s = *chunk;
    size_t dim = (size_t) s.g->dim;
    double *at = NULL;
    if (n == 0) return PG_OK;
    PG_ALLOC (at, n * (dim + 18));
    s.u = at + n * dim, s.stress = chunk->stress ? s.u + 3 * n : NULL;
    s.gradient = chunk->gradient ? s.u + 9 * n : NULL;
    for (size_t i = 0; i < n; i++) memcpy (at + i * dim, x + rest[i] * dim, dim * sizeof *x);
    PG_TRY (sample_each (&s, n, at, own, leaves));
    for (size_t i = 0; i < n; i++) {
        memcpy (chunk->u + 3 * rest[i], s.u + 3 * i, 3 * sizeof *at);
        if (s.stress) memcpy (chunk->stress + 6 * rest[i], s.stress + 6 * i, 6 * sizeof *at);
        if (s.gradient) memcpy (chunk->gradient + 9 * rest[i], s.gradient + 9 * i, 9 * sizeof *at);
    }
done:
    pg_free (at);
    return status;
}

/* Samples positions of a lattice: first, one by one, those that share no kept row, then those whose kept row
 * turns out to be unusable for others; all remaining ones, whose surroundings are equal, by the kept rows. */
static pg_status sample_alike (sampling *s, size_t n, const double *x, int *own)
{
    pg_status status = PG_OK;
    galerkin *g = s->g;
    by_rows b = { s, x, NULL, NULL };
    size_t *rest = NULL, nrest, threads = g->threads < 1 ? 1 : (size_t) g->threads;
    int *which = NULL;
    PG_ALLOC (which, 2 * n);
    PG_ALLOC (rest, n);
    PG_ALLOC (b.value, threads * galerkin_alike_scratch (g->places.alike));
    PG_TRY (galerkin_alike_sort (g->places.alike, g->problem->cloud.volume, n, x, which, rest, which + n,
                                 &nrest));
    PG_TRY (sample_rest (s, nrest, rest, which + n, x, own));
    nrest = 0;
    for (size_t p = 0; p < n; p++)
        if (which[p] >= 0 && !galerkin_alike_good (g->places.alike, which[p])) rest[nrest++] = p,
            which[p] = -1;
    PG_TRY (sample_rest (s, nrest, rest, NULL, x, own));
    b.which = which;
    pg_parallel (g->threads, n, evaluate_alike, &b);
done:
    pg_free (which), pg_free (rest), pg_free (b.value);
    return status;
}

pg_status galerkin_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                           double *u, double *stress, double *gradient)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    const pg_rows *bulk = &g->rows[g->bulk];
    sampling s = { .g = g, .state = state, .d = d, .time = state->time };
    int *own = NULL;
    look_over (&s);
    if (!g->places.search)
        PG_TRY (pg_rows_search (&g->places.search, &g->problem->form.approx, &g->problem->cloud));
    if (!g->places.near_point) PG_TRY (pg_nearest_create (&g->places.near_point, g->dim, bulk->n, bulk->x));
    if (!g->places.near_node)
        PG_TRY (pg_nearest_create (&g->places.near_node, g->dim, g->n, g->problem->cloud.x));
    PG_ALLOC (s.at, n < CHUNK ? n : CHUNK);
    PG_ALLOC (own, n < CHUNK ? n : CHUNK);
    if (g->dilatation && stress) s.pressure = galerkin_dilatation_of_nodes (g, d);
    int alike = s.uniform && !s.pressure && n >= MANY && SHARE * n >= g->n;
    if (alike && !g->places.alike) PG_TRY (galerkin_alike_create (&g->places.alike, g->problem));
    if (!s.intact && n <= CHUNK && galerkin_again_serves (g, n)) {
        s.u = u, s.stress = stress, s.gradient = gradient;
        PG_TRY (sample_again (&s, n, x, own));
        goto done;
    }
    if (alike && g->places.alike) galerkin_alike_begin (g->places.alike, g->n * (size_t) g->dim, d);
    for (size_t first = 0; first < n; first += CHUNK) {
        s.u = u + 3 * first, s.stress = stress ? stress + 6 * first : NULL;
        s.gradient = gradient ? gradient + 9 * first : NULL;
        size_t some = n - first < CHUNK ? n - first : CHUNK;
        const double *at = x + first * (size_t) g->dim;
        if (alike && g->places.alike) PG_TRY (sample_alike (&s, some, at, own));
        else PG_TRY (sample_each (&s, some, at, own, NULL));
    }
done:
    pg_free (s.at), pg_free (own);
    return status;
}
