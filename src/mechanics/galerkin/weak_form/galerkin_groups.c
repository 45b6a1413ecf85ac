/* SPDX-License-Identifier: GPL-3.0-or-later
 * Groups of bonds, and the bonds outside of a group. A group is judged after every event (judge_group in
 * galerkin_bonds.c); all other bonds are judged for many displacement fields at once, to prove afterwards
 * that none of them would have broken in between. Displacement or stresses of a point are computed for all
 * these fields in one pass over its shape functions, so that these are read once instead of once an event;
 * where the criterion is a linear form of stretch or stress (pg_criterion_type.linear, .planes), a bond
 * costs a few products for each field. */
#include "galerkin.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CHUNK = 64 };                                   /* bonds of a point that are judged together */

/* ---- what a group depends on --------------------------------------------------------------------------- */
/* The rows of shape functions that belong to the points of a set. */
static const pg_rows *rows_of (const galerkin *g, int set)
{
    return set == g->bulk ? &g->sums : &g->rows[set];
}

/* Lists the marked ones of n, ascending. */
static pg_status list_marked (size_t n, const unsigned char *mark, size_t *count, size_t **out)
{
    pg_status status = PG_OK;
    size_t at = 0;
    *count = 0;
    for (size_t i = 0; i < n; i++) *count += mark[i];
    pg_free (*out), *out = NULL;
    PG_ALLOC (*out, *count);
    for (size_t i = 0; i < n; i++) if (mark[i]) (*out)[at++] = i;
done:
    return status;
}

/* Finds the points that own the bonds of a group, and marks both ends of each bond: the point in its set, the
 * node among the nodes. */
static pg_status find_owners (const galerkin *g, pg_bond_group *group, unsigned char *mark[PG_BOND_SETS])
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    size_t k = 0;
    pg_free (group->owner), group->owner = NULL;
    PG_ALLOC (group->owner, group->n);
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &g->rows[set].family;
        size_t point = 0;
        group->first[set] = k;
        for (; k < group->n && group->bond[k] < p->bonds.first[set + 1]; k++) {
            size_t e = group->bond[k] - p->bonds.first[set];
            if (f->start[point + 1] <= e) {            /* the next point, or one far off: by bisection */
                size_t low = point + 1, high = f->n;
                while (high - low > 1) {
                    size_t mid = (low + high) / 2;
                    if (f->start[mid] <= e) low = mid;
                    else high = mid;
                }
                point = low;
            }
            group->owner[k] = point;
            mark[set][point] = mark[PG_NODES][f->node[e]] = 1;
        }
    }
    group->first[PG_BOND_SETS] = k;
done:
    return status;
}

/* Lists the points and nodes that a group of bonds depends on. *can: 0 with a projected dilatation, whose
 * pressures depend on nodes outside of a point's family. */
pg_status galerkin_gather (void *self, pg_bond_group *group, int *can)
{
    pg_status status = PG_OK;
    const galerkin *g = self;
    unsigned char *mark[PG_BOND_SETS] = { NULL }, *seen = NULL;
    *can = !g->dilatation;
    if (!*can) return PG_OK;
    for (int set = 0; set < PG_BOND_SETS; set++) PG_ALLOC (mark[set], g->rows[set].n);
    PG_ALLOC (seen, g->n);
    PG_TRY (find_owners (g, group, mark));
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &rows_of (g, set)->family;
        PG_TRY (list_marked (g->rows[set].n, mark[set], &group->npoint[set], &group->point[set]));
        for (size_t k = 0; k < group->npoint[set]; k++)
            for (size_t e = f->start[group->point[set][k]]; e < f->start[group->point[set][k] + 1]; e++)
                seen[f->node[e]] = 1;
    }
    group->nnode = 0;
    for (size_t i = 0; i < g->n; i++) group->nnode += seen[i];
    pg_free (group->node), group->node = NULL;
    PG_ALLOC (group->node, group->nnode);
    for (size_t i = 0, k = 0; i < g->n; i++) if (seen[i]) group->node[k++] = (int) i;
done:
    for (int set = 0; set < PG_BOND_SETS; set++) pg_free (mark[set]);
    pg_free (seen);
    return status;
}

/* ---- all bonds outside of the group -------------------------------------------------------------------- */
typedef struct {
    galerkin *g;
    const pg_state *state;
    const unsigned char *left_out;
    int       set, stress;  /* stress: the criterion judges stresses, not stretch */
    size_t    count, width;  /* number of displacement fields; numbers of a point for each */
    const double *d;
    /* node: displacement, or largest and smallest principal stress, of all nodes [node][number][field]; room:
     * scratch of each thread, with room for one more point; top: largest utilisation of each thread. */
    double   *node, *room, *top;
    size_t    room_size;
} others;

/* u [dim][count]: displacement of point p in all fields, m. */
PG_WIDE static void displacements (const others *o, size_t p, double *u)
{
    const pg_rows *r = rows_of (o->g, o->set);
    size_t dim = (size_t) o->g->dim, m = dim * o->count;
    memset (u, 0, m * sizeof *u);
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
        const double *d = o->d + (size_t) r->family.node[e] * m;
        double N = r->N[e + pg_rows_offset (r, p)];
        for (size_t k = 0; k < m; k++) u[k] += N * d[k];
    }
}

/* H [dim: component][dim: derivative][count]: displacement gradient of point p in all fields. */
PG_WIDE static void gradients (const others *o, size_t p, double *H)
{
    const pg_rows *r = rows_of (o->g, o->set);
    size_t dim = (size_t) o->g->dim, n = o->count;
    memset (H, 0, dim * dim * n * sizeof *H);
    for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
        const double *d = o->d + (size_t) r->family.node[e] * dim * n,
                     *q = r->dN + (e + pg_rows_offset (r, p)) * dim;
        for (size_t c = 0; c < dim; c++)
            for (size_t x = 0; x < dim; x++) {
                double *h = H + (c * dim + x) * n, s = q[x];
                const double *from = d + c * n;
                for (size_t k = 0; k < n; k++) h[k] += s * from[k];
            }
    }
}

/* e: engineering strain in Voigt order from gradient H in field k. */
static void strain_of (size_t dim, size_t n, size_t k, const double *H, double *e)
{
#define AT(c, x) H[((c) * dim + (x)) * n + k]
    for (size_t c = 0; c < dim; c++) e[c] = AT (c, c);
    if (dim == 2) e[2] = AT (0, 1) + AT (1, 0);
    if (dim == 3) e[3] = AT (0, 1) + AT (1, 0), e[4] = AT (1, 2) + AT (2, 1), e[5] = AT (2, 0) + AT (0, 2);
#undef AT
}

/* out [2][count]: largest and smallest principal stress of point p in all fields, Pa. */
static void principals (const others *o, size_t p, double *out, double *room)
{
    const galerkin *g = o->g;
    const pg_material *m = galerkin_plain (g, o->set, p);
    size_t n = o->count, dim = (size_t) g->dim, nv = (size_t) g->nv;
    double *H = room, *e = H + dim * dim * n, *s = e + nv * n, *zz = s + nv * n, *three = zz + n;
    gradients (o, p, H);
    for (size_t k = 0; k < n; k++) strain_of (dim, n, k, H, e + nv * k);
    m->type->stress (m, n, e, s, zz);
    pg_principal (g->dim, n, s, zz, three);
    for (size_t k = 0; k < n; k++) out[k] = three[3 * k], out[n + k] = three[3 * k + 2];
}

/* Principal stresses or displacements of point p in all displacement fields. */
static void show (const others *o, size_t p, double *out, double *room)
{
    if (o->stress) principals (o, p, out, room);
    else displacements (o, p, out);
}

static void show_nodes (void *context, size_t first, size_t last, int thread)
{
    const others *o = context;
    for (size_t p = first; p < last; p++)
        show (o, p, o->node + p * o->width * o->count, o->room + (size_t) thread * o->room_size);
}

/* top[k] = max (top[k], a . (u_j - u_p)) */
PG_WIDE static void stretch_of_all (size_t dim, size_t n, const double *a, const double *uj, const double *up,
                                 double *top)
{
    for (size_t k = 0; k < n; k++) {
        double s = a[0] * (uj[k] - up[k]);
        if (dim > 1) s += a[1] * (uj[n + k] - up[n + k]);
        if (dim > 2) s += a[2] * (uj[2 * n + k] - up[2 * n + k]);
        top[k] = s > top[k] ? s : top[k];
    }
}

/* top[k] = max (top[k], form applied to the mean principal stresses of both ends) */
PG_WIDE static void stress_of_all (size_t n, const double *form, const double *sj, const double *sp,
                                   double *top)
{
    double a = 0.5 * form[0], b = 0.5 * form[1];
    for (size_t k = 0; k < n; k++) {
        double s = a * (sj[k] + sp[k]) + b * (sj[n + k] + sp[n + k]);
        top[k] = s > top[k] ? s : top[k];
    }
}

/* Judges n bonds of point p by one criterion. */
static void judge_by_law (const others *o, const pg_criterion *c, size_t p, size_t n, const size_t *entry,
                          const double *own, double *top)
{
    const galerkin *g = o->g;
    const pg_rows *r = &g->rows[o->set];
    size_t dim = (size_t) g->dim;
    double xi[CHUNK * 3], reach[CHUNK], a[CHUNK * 3], form[2][2];
    int graded = g->problem->cloud.size != NULL, forms;
    if (o->stress) {
        forms = c->type->planes (c, form);
        for (size_t i = 0; i < n; i++)
            for (int f = 0; f < forms; f++)
                stress_of_all (o->count, form[f],
                               o->node + (size_t) r->family.node[entry[i]] * o->width * o->count, own, top);
        return;
    }
    for (size_t i = 0; i < n; i++) {
        size_t j = (size_t) r->family.node[entry[i]];
        for (size_t k = 0; k < dim; k++)
            xi[i * dim + k] = g->problem->cloud.x[j * dim + k] - r->x[p * dim + k];
        if (graded) reach[i] = galerkin_reach (g, o->set, p, entry[i]);
    }
    pg_bond_measures m = { .n = n, .dim = g->dim, .xi = xi, .reach = graded ? reach : NULL };
    c->type->linear (c, &m, a);
    for (size_t i = 0; i < n; i++)
        stretch_of_all (dim, o->count, a + i * dim,
                        o->node + (size_t) r->family.node[entry[i]] * o->width * o->count, own, top);
}

/* Judges n bonds of point p by the criteria of both their ends. */
static void judge_some (const others *o, size_t p, size_t n, const size_t *entry, const double *own,
                        double *top)
{
    const galerkin *g = o->g;
    size_t point[CHUNK], some[CHUNK];
    for (size_t i = 0; i < n; i++) point[i] = p;
    int material = galerkin_one_material (g, o->set, n, entry, point);
    if (material >= 0) {
        judge_by_law (o, &g->problem->at.limit[material], p, n, entry, own, top);
        return;
    }
    int limit[2 * CHUNK];
    size_t limits = galerkin_limits_of (g, o->set, n, entry, point, limit);
    for (size_t k = 0; k < limits; k++) {
        int m = limit[k];
        size_t count = 0;
        for (size_t i = 0; i < n; i++)
            if (g->problem->at.limit_of[o->set][p] == m
                || g->problem->at.limit_of[PG_NODES][g->rows[o->set].family.node[entry[i]]] == m)
                some[count++] = entry[i];
        if (count) judge_by_law (o, &g->problem->at.limit[m], p, count, some, own, top);
    }
}

/* Judges the bonds of a range of points; points without a bond to be judged are not measured. */
static void judge_points (void *context, size_t first, size_t last, int thread)
{
    const others *o = context;
    const galerkin *g = o->g;
    const pg_family *f = &g->rows[o->set].family;
    size_t base = g->problem->bonds.first[o->set], entry[CHUNK], size = o->width * o->count;
    const unsigned char *alive = o->state->alive + base, *judged = g->bounds.judged[o->set],
                        *left_out = o->left_out + base;
    double *room = o->room + (size_t) thread * o->room_size, *place = room + o->room_size - size,
           *top = o->top + (size_t) thread * o->count;
    for (size_t p = first; p < last; p++) {
        const double *own = o->set == PG_NODES ? o->node + p * size : NULL;
        size_t n = 0;
        for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
            if (!alive[e] || !judged[e] || left_out[e]) continue;
            if (!own) show (o, p, place, room), own = place;
            entry[n++] = e;
            if (n == CHUNK) judge_some (o, p, n, entry, own, top), n = 0;
        }
        if (n) judge_some (o, p, n, entry, own, top);
    }
}

/* Judges by criteria that are not linear: field by field, all bonds each time. */
static pg_status judge_one_by_one (galerkin *g, const pg_state *state, const unsigned char *left_out,
                                   int of_unit, size_t count, const double *d, double *top)
{
    pg_status status = PG_OK;
    size_t ndof = g->n * (size_t) g->dim;
    double *one = NULL, *show = NULL;
    PG_ALLOC (one, ndof);
    PG_ALLOC (show, state->nbond);
    for (size_t k = 0; k < count; k++) {
        for (size_t i = 0; i < ndof; i++) one[i] = d[i * count + k];
        PG_TRY (galerkin_utilisation (g, state, one, of_unit ? NULL : show, NULL, of_unit ? show : NULL));
        for (size_t b = 0; b < state->nbond; b++) {
            double u = of_unit ? 1 / show[b] : show[b];
            if (!left_out[b] && u > top[k]) top[k] = u;
        }
    }
done:
    pg_free (one), pg_free (show);
    return status;
}

/* Is the criterion of every material a linear form of stress or stretch? */
static int is_linear (const pg_problem *p, int stress)
{
    for (size_t m = 0; m < p->at.nlimit; m++) {
        const pg_criterion *c = &p->at.limit[m];
        const pg_bond_measures none = { .dim = p->dim };
        double form[2][2];
        if (stress ? !c->type->planes || !c->type->planes (c, form)
                   : !c->type->linear || !c->type->linear (c, &none, NULL))
            return 0;
    }
    return 1;
}

/* Judges all bonds that are not left out: nodes are measured first, as every bond ends at one; then the
 * points of each set in turn. */
pg_status galerkin_judge_others (galerkin *g, const pg_state *state, const unsigned char *left_out,
                                 int of_unit, size_t count, const double *d, double *top)
{
    pg_status status = PG_OK;
    size_t dim = (size_t) g->dim, threads = (size_t) (g->threads > 1 ? g->threads : 1);
    int stress = (g->problem->criterion->type->needs & PG_NEEDS_STRESS) != 0;
    others o = { g, state, left_out, 0, stress, count, stress ? 2 : dim, d, NULL, NULL, NULL, 0 };
    PG_TRY (galerkin_find_judged (g));
    memset (top, 0, count * sizeof *top);
    if (!is_linear (g->problem, stress))
        return judge_one_by_one (g, state, left_out, of_unit, count, d, top);
    o.room_size = (dim * dim + 2 * (size_t) g->nv + 1 + 3 + o.width) * count;
    PG_ALLOC (o.node, g->n * o.width * count);
    PG_ALLOC (o.room, threads * o.room_size);
    PG_ALLOC (o.top, threads * count);
    o.set = PG_NODES;
    pg_parallel (g->threads, g->n, show_nodes, &o);
    for (o.set = 0; o.set < PG_BOND_SETS; o.set++)
        pg_parallel (g->threads, g->rows[o.set].n, judge_points, &o);
    for (size_t t = 0; t < threads; t++)
        for (size_t k = 0; k < count; k++) top[k] = fmax (top[k], o.top[t * count + k]);
done:
    pg_free (o.node), pg_free (o.room), pg_free (o.top);
    return status;
}
