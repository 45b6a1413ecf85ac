/* SPDX-License-Identifier: GPL-3.0-or-later
 * Evaluation of bonds: utilisation of each intact bond from stretch or mean principal stress of its two ends
 * (Cui 2022 section 1.1, theory F2: displacements and stresses are those of the shape functions, not the
 * coefficients), overlap of crack faces, census. */
#include "galerkin.h"
#include <math.h>
#include <string.h>

enum { BATCH = GALERKIN_BATCH };

void galerkin_principal (galerkin *g, int set, size_t p)
{
    galerkin_measured *m = &g->measured;
    double principal[3];
    pg_principal (g->dim, 1, m->stress[set] + p * (size_t) g->nv, m->zz[set] + p, principal);
    m->s1[set][p] = principal[0], m->s2[set][p] = principal[1], m->s3[set][p] = principal[2];
}

/* Judges some bonds by one criterion: utilisation, and the factor by which a proportional load may grow;
 * `to`: their positions in the arrays. Where two criteria judge one bond the larger utilisation and the
 * smaller factor count. */
static void judge_by (const galerkin_judging *s, const pg_criterion *c, const pg_bond_measures *m,
                      const size_t *to)
{
    double out[BATCH];
    char kind[BATCH];
    if (s->utilisation) c->type->utilisation (c, m, out, kind);
    for (size_t k = 0; s->utilisation && k < m->n; k++) {
        if (out[k] < s->utilisation[to[k]]) continue;
        s->utilisation[to[k]] = out[k];
        if (s->kind) s->kind[to[k]] = kind[k];
    }
    if (s->factor) c->type->factor (c, m, out);
    for (size_t k = 0; s->factor && k < m->n; k++)
        if (!(out[k] > s->factor[to[k]])) s->factor[to[k]] = out[k];
}

/* Judges by the criterion of a material those bonds of a batch that have an end in it. */
static void judge_material (const galerkin_judging *s, int material, pg_bond_measures m, const size_t *bond,
                            const size_t *point, const size_t *to)
{
    const galerkin *g = s->g;
    const int *node = g->rows[s->set].family.node, *own = g->problem->at.limit_of[s->set],
              *other = g->problem->at.limit_of[PG_NODES];
    double xi[BATCH * 3], eta[BATCH * 3], reach[BATCH], s1[BATCH], s2[BATCH], s3[BATCH];
    size_t some[BATCH], count = 0, dim = (size_t) g->dim;
    for (size_t k = 0; k < m.n; k++) {
        if (own[point[k]] != material && other[node[bond[k]]] != material)
            continue;
        if (m.xi)
            memcpy (xi + count * dim, m.xi + k * dim, dim * sizeof *xi),
                memcpy (eta + count * dim, m.eta + k * dim, dim * sizeof *eta);
        if (m.reach) reach[count] = m.reach[k];
        if (m.s1) s1[count] = m.s1[k], s2[count] = m.s2[k], s3[count] = m.s3[k];
        some[count++] = to[k];
    }
    m = (pg_bond_measures){ .n = count,
                            .dim = m.dim,
                            .xi = m.xi ? xi : NULL,
                            .eta = m.xi ? eta : NULL,
                            .reach = m.reach ? reach : NULL,
                            .s1 = m.s1 ? s1 : NULL,
                            .s2 = m.s1 ? s2 : NULL,
                            .s3 = m.s1 ? s3 : NULL };
    if (count) judge_by (s, &g->problem->at.limit[material], &m, some);
}

int galerkin_one_material (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point)
{
    const int *node = g->rows[set].family.node, *own = g->problem->at.limit_of[set],
              *other = g->problem->at.limit_of[PG_NODES];
    int first = own[point[0]], same = 1;
    for (size_t k = 0; k < count && same; k++)
        same = own[point[k]] == first && other[node[bond[k]]] == first;
    return same ? first : -1;
}

size_t galerkin_limits_of (const galerkin *g, int set, size_t count, const size_t *bond, const size_t *point,
                           int *limit)
{
    const int *node = g->rows[set].family.node;
    size_t n = 0;
    for (size_t k = 0; k < 2 * count; k++) {
        int one = k < count ? g->problem->at.limit_of[set][point[k]]
                            : g->problem->at.limit_of[PG_NODES][node[bond[k - count]]];
        size_t seen = 0;
        while (seen < n && limit[seen] != one) seen++;
        if (seen == n) limit[n++] = one;
    }
    return n;
}

/* Mean of the relative supports of both ends, so that it is the same from either end. */
double galerkin_reach (const galerkin *g, int set, size_t point, size_t entry)
{
    const pg_cloud *c = &g->problem->cloud;
    int node = g->rows[set].family.node[entry];
    return 0.5 * (pg_problem_spacing (g->problem, set, point) + c->size[node]) / c->h;
}

/* Judges `count` intact bonds: bond vector xi and relative displacement eta (m), principal stresses as the
 * mean of both ends (Pa), and in graded clouds the local spacing over h, by which limits of stretch scale.
 * Most batches are of one material and need no second copy. */
void galerkin_judge (const galerkin_judging *s, size_t count, const size_t *bond, const size_t *point,
                     const size_t *to)
{
    const galerkin *g = s->g;
    const pg_rows *r = &g->rows[s->set];
    size_t dim = (size_t) g->dim;
    double xi[BATCH * 3], eta[BATCH * 3], reach[BATCH], s1[BATCH], s2[BATCH], s3[BATCH];
    int graded = g->problem->cloud.size != NULL;
    int needs = g->problem->criterion->type->needs, stretch = needs & PG_NEEDS_STRETCH,
        stress = needs & PG_NEEDS_STRESS;
    int material = galerkin_one_material (g, s->set, count, bond, point);
    for (size_t k = 0; stretch && k < count; k++) {
        size_t j = (size_t) r->family.node[bond[k]], p = point[k];
        for (size_t a = 0; a < dim; a++) {
            xi[k * dim + a] = g->problem->cloud.x[j * dim + a] - r->x[p * dim + a];
            eta[k * dim + a] = g->measured.u[PG_NODES][j * dim + a] - g->measured.u[s->set][p * dim + a];
        }
    }
    if (stretch && g->eigen.strain[s->set]) galerkin_eigen_bonds (g, s->set, count, bond, point, xi, eta);
    for (size_t k = 0; graded && k < count; k++) reach[k] = galerkin_reach (g, s->set, point[k], bond[k]);
    for (size_t k = 0; stress && k < count; k++) {
        size_t j = (size_t) r->family.node[bond[k]], p = point[k];
        s1[k] = 0.5 * (g->measured.s1[s->set][p] + g->measured.s1[PG_NODES][j]);
        s2[k] = 0.5 * (g->measured.s2[s->set][p] + g->measured.s2[PG_NODES][j]);
        s3[k] = 0.5 * (g->measured.s3[s->set][p] + g->measured.s3[PG_NODES][j]);
    }
    pg_bond_measures m = { .n = count,
                           .dim = g->dim,
                           .xi = stretch ? xi : NULL,
                           .eta = stretch ? eta : NULL,
                           .reach = graded ? reach : NULL,
                           .s1 = stress ? s1 : NULL,
                           .s2 = stress ? s2 : NULL,
                           .s3 = stress ? s3 : NULL };
    if (material >= 0) {
        judge_by (s, &g->problem->at.limit[material], &m, to);
        return;
    }
    int limit[2 * BATCH];
    size_t limits = galerkin_limits_of (g, s->set, count, bond, point, limit);
    for (size_t k = 0; k < limits; k++) judge_material (s, limit[k], m, bond, point, to);
}

/* Judges the intact bonds of a range of points in batches; bonds that never break have utilisation 0 and an
 * infinite factor. */
static void judge_points (void *context, size_t first, size_t last, int thread)
{
    const galerkin_judging *s = context;
    const galerkin *g = s->g;
    const pg_rows *r = &g->rows[s->set];
    const unsigned char *alive = s->state->alive + g->problem->bonds.first[s->set],
                        *judged = g->bounds.judged[s->set];
    size_t base = g->problem->bonds.first[s->set], bond[BATCH], point[BATCH], to[BATCH],
           count = 0;
    (void) thread;
    for (size_t p = first; p < last; p++)
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            if (s->utilisation) s->utilisation[base + e] = 0;
            if (s->factor) s->factor[base + e] = INFINITY;
            if (!alive[e] || !judged[e]) continue;
            bond[count] = e, to[count] = base + e, point[count++] = p;
            if (count == BATCH) galerkin_judge (s, count, bond, point, to), count = 0;
        }
    if (count) galerkin_judge (s, count, bond, point, to);
}

/* Marks, on the first call, the bonds that a criterion applies to: bonds of zero length and those of exempt
 * ends never break. */
pg_status galerkin_find_judged (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_problem *q = g->problem;
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_family *f = &g->rows[set].family;
        if (g->bounds.judged[set]) continue;
        PG_ALLOC (g->bounds.judged[set], f->start[f->n]);
        for (size_t p = 0; p < f->n; p++)
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++)
                g->bounds.judged[set][e] = !q->bonds.exempt[set][p] && !q->bonds.exempt[PG_NODES][f->node[e]]
                                    && !pg_problem_no_bond (q, set, p, e);
    }
done:
    return status;
}

/* Largest and smallest principal stress at a range of points of a set, Pa. */
typedef struct { galerkin *g; int set; } principals;

static void principal_points (void *context, size_t first, size_t last, int thread)
{
    const principals *c = context;
    (void) thread;
    for (size_t p = first; p < last; p++) galerkin_principal (c->g, c->set, p);
}

/* Utilisation of every bond of every set. Stresses at all sets first, as a bond joins a point of its set with
 * a node. */
pg_status galerkin_utilisation (galerkin *g, const pg_state *state, const double *d, double *utilisation,
                                char *kind, double *factor)
{
    pg_status status = PG_OK;
    PG_TRY (galerkin_find_judged (g));
    for (int set = 0; set < PG_BOND_SETS; set++) {
        const pg_rows *r = &g->rows[set];
        if (r->n == 0) continue;
        galerkin_measure (g, set, d);
        principals c = { g, set };
        if (g->problem->criterion->type->needs & PG_NEEDS_STRESS)
            pg_parallel (g->threads, r->n, principal_points, &c);
    }
    for (int set = 0; set < PG_BOND_SETS; set++) {
        galerkin_judging s = { g, state, set, utilisation, factor, kind };
        pg_parallel (g->threads, g->rows[set].n, judge_points, &s);
    }
done:
    return status;
}

/* Judges the bonds of a group: stresses and displacements are measured at their ends only. */
static pg_status judge_group (galerkin *g, const pg_state *state, const pg_bond_group *group, const double *d,
                              double *utilisation, char *kind, double *factor)
{
    pg_status status = PG_OK;
    size_t bond[BATCH], point[BATCH], to[BATCH];
    PG_TRY (galerkin_find_judged (g));
    for (int set = 0; set < PG_BOND_SETS; set++) {
        galerkin_measure_some (g, set, d, group->npoint[set], group->point[set], group->nnode, group->node);
        for (size_t k = 0; (g->problem->criterion->type->needs & PG_NEEDS_STRESS) && k < group->npoint[set];
             k++)
            galerkin_principal (g, set, group->point[set][k]);
    }
    for (int set = 0; set < PG_BOND_SETS; set++) {
        galerkin_judging s = { g, state, set, utilisation, factor, kind };
        size_t base = g->problem->bonds.first[set], count = 0;
        for (size_t k = group->first[set]; k < group->first[set + 1]; k++) {
            size_t e = group->bond[k] - base;
            if (utilisation) utilisation[k] = 0;
            if (factor) factor[k] = INFINITY;
            if (!state->alive[base + e] || !g->bounds.judged[set][e]) continue;
            bond[count] = e, to[count] = k, point[count++] = group->owner[k];
            if (count == BATCH) galerkin_judge (&s, count, bond, point, to), count = 0;
        }
        if (count) galerkin_judge (&s, count, bond, point, to);
    }
done:
    return status;
}

/* Elongation of the bond xi from p to j along a unit vector n by the mean strain of both ends, m: n . eps
 * xi. */
static double elastic_along (const galerkin *g, size_t p, size_t j, const double *xi, const double *n)
{
    static const int shear[3][2] = { { 0, 1 }, { 1, 2 }, { 2, 0 } };
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    const double *ei = g->measured.strain[PG_NODES] + p * nv, *ej = g->measured.strain[PG_NODES] + j * nv;
    double sum = 0;
    for (size_t a = 0; a < dim; a++) sum += 0.5 * (ei[a] + ej[a]) * xi[a] * n[a];
    for (size_t k = dim; k < nv; k++) {                /* engineering shears count half in xy, half in yx */
        int a = shear[k - dim][0], b = shear[k - dim][1];
        sum += 0.25 * (ei[k] + ej[k]) * (xi[a] * n[b] + xi[b] * n[a]);
    }
    return sum;
}

/* By how much the ends of a bond xi from p to j have approached along n, a unit vector from p's side to that
 * of j, beyond the elastic shortening of the material on both sides, m. */
static double overlap_along (const galerkin *g, size_t p, size_t j, const double *xi, const double *n)
{
    size_t dim = (size_t) g->dim;
    const double *u = g->measured.u[PG_NODES];
    double approach = 0;
    for (size_t a = 0; a < dim; a++) approach -= n[a] * (u[j * dim + a] - u[p * dim + a]);
    return approach - fmax (-elastic_along (g, p, j, xi, n), 0);
}

/* The overlap of crack faces by one broken bond, m. Where a known crack cuts the bond, the normal of that
 * crack counts, not the bond's direction: sliding faces bring the ends of oblique bonds nearer without
 * overlap; such bonds are left out. Of single broken bonds only their own direction is known. */
static double overlap_by_bond (const galerkin *g, const pg_state *state, size_t p, size_t j, const double *xi)
{
    size_t dim = (size_t) g->dim;
    const double *x = g->rows[PG_NODES].x;
    double n[3] = { 0 }, along = 0, size = 0;
    const pg_crack *c = pg_cracks_cut (pg_state_cracks (g->problem, state), x + p * dim, x + j * dim,
                                       pg_cloud_same (&g->problem->cloud));
    if (!c && pg_problem_grows (g->problem)) return 0;
    for (size_t a = 0; a < dim; a++) size += xi[a] * xi[a], along += c ? xi[a] * c->normal[a] : 0;
    size = sqrt (size);
    if (c && fabs (along) < 0.8 * size) return 0;
    for (size_t a = 0; a < dim; a++) n[a] = !c ? xi[a] / size : along < 0 ? -c->normal[a] : c->normal[a];
    return overlap_along (g, p, j, xi, n);
}

/* The largest overlap of the ends of a broken bond: their approach beyond the elastic shortening of the
 * material on both sides, m. Without contact crack faces may pass through each other, and this shows whether
 * they do. Only node-node bonds up to 1.5 spacings are examined, between ends that still carry stress. */
static double largest_overlap (galerkin *g, const pg_state *state, const double *d)
{
    const pg_rows *r = &g->rows[PG_NODES];
    size_t dim = (size_t) g->dim;
    double worst = 0;
    /* a bond between ends of unlike support may exist in one family only */
    int both = g->problem->cloud.size != NULL;
    galerkin_measure (g, PG_NODES, d);
    for (size_t p = 0; p < r->n; p++) {
        if (!pg_cloud_owns (&g->problem->cloud, p)) continue;
        double limit = 1.5 * pg_problem_spacing (g->problem, PG_NODES, p);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            size_t j = (size_t) r->family.node[e];
            int counted = j < p && !both && pg_cloud_owns (&g->problem->cloud, j);
            if (state->alive[e] || j == p || counted) continue;
            if (r->grade[p] >= PG_GRADE_SHEPARD || r->grade[j] >= PG_GRADE_SHEPARD) continue;
            double xi[3], rr = 0;
            for (size_t a = 0; a < dim; a++)
                xi[a] = r->x[j * dim + a] - r->x[p * dim + a], rr += xi[a] * xi[a];
            if (rr > limit * limit) continue;
            worst = fmax (worst, overlap_by_bond (g, state, p, j, xi));
        }
    }
    return worst;
}

/* Joins the nodes that have bonds to the same evaluation point; on a rank only by points with bonds to its
 * own nodes. */
void galerkin_join (void *self, int *parent)
{
    const galerkin *g = self;
    const pg_rows *r = &g->rows[g->bulk];
    pg_disjoint_start (parent, g->n);
    for (size_t p = 0; p < r->n; p++) {
        int first = -1, own = 0;
        size_t offset = pg_rows_offset (r, p);
        if (r->grade[p] >= PG_GRADE_SHEPARD) continue;
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1] && !own; e++)
            own = pg_cloud_owns (&g->problem->cloud, (size_t) r->family.node[e]);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1] && own; e++) {
            if (r->w[e + offset] == 0 && r->family.node[e] != r->own[p]) continue;
            if (first < 0) first = r->family.node[e];
            else pg_disjoint_join (parent, r->family.node[e], first);
        }
    }
}

/* Counts evaluation points without a gradient, which carry no stress. at: position of the first one, m, on
 * this rank or on the lowest rank that has one. */
static pg_status count_flat (const galerkin *g, size_t *count, double *at)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[g->bulk];
    size_t dim = (size_t) g->dim, n = 0;
    double flat = 0, first[3] = { 0 }, *all = NULL;
    for (size_t p = r->n; p-- > 0;) {
        if (r->grade[p] < PG_GRADE_SHEPARD || !pg_problem_owns (g->problem, g->bulk, p)) continue;
        flat++;
        memcpy (first, r->x + p * dim, dim * sizeof *first);
    }
    PG_TRY (pg_ranks_share (flat > 0 ? 3 : 0, first, &n, &all));
    if (n) memcpy (at, all, sizeof first);
    PG_TRY (pg_cloud_sum (&g->problem->cloud, 1, &flat));
    *count = (size_t) flat;
done:
    pg_free (all);
    return status;
}

/* Counts evaluation points without a gradient; nodes that share no evaluation point with another node; and
 * fragments: parts of the body that evaluation points no longer join, except the largest. */
pg_status galerkin_census (void *self, pg_census *out)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    int *parent = NULL;
    double parts[2];
    PG_ALLOC (parent, g->n);
    PG_TRY (count_flat (g, &out->degenerate, out->at));
    galerkin_join (g, parent);
    PG_TRY (pg_subdomain_count (g->problem->cloud.subdomain, g->n, parent, parts));
    out->isolated = (size_t) parts[0], out->fragments = (size_t) parts[1];
    out->unended = galerkin_unended (g);
    if (out->fragments) --out->fragments;              /* the largest part is the body itself, no fragment */
done:
    pg_free (parent);
    return status;
}

pg_status galerkin_judge_bonds (void *self, const pg_state *state, const double *d, const pg_judging *w)
{
    galerkin *g = self;
    if (w->overlap) {
        *w->overlap = largest_overlap (g, state, d);
        return PG_OK;
    }
    if (w->count) return galerkin_judge_others (g, state, w->left_out, w->of_unit, w->count, d, w->top);
    if (w->group) return judge_group (g, state, w->group, d, w->utilisation, w->kind, w->factor);
    if (w->over) return galerkin_worst (g, state, d, w->from, w->utilisation, w->kind, w->top, w->over);
    return galerkin_utilisation (g, state, d, w->utilisation, w->kind, w->factor);
}
