/* SPDX-License-Identifier: GPL-3.0-or-later
 * Results of bonds: utilisation of each; at points damage (share of the family's partial volume that is
 * lost), strain (linear fit of the displacements over intact bonds), stress (virial of their forces, 1/2 sum
 * f x xi V_j); displacement and stress at any position; overlap of broken bonds; fragments. */
#include "dilatation.h"
#include <math.h>
#include <string.h>

enum { BATCH = 128 };

/* ---- limits -------------------------------------------------------------------------------------------- */
typedef struct {
    const bond_force *b;
    const pg_state *state;
    const double *d;
    double *utilisation, *factor;
    char *kind;
} judging;
typedef struct {
    size_t n, entry[BATCH];
    double xi[3 * BATCH], eta[3 * BATCH], reach[BATCH], shear[BATCH], bending[BATCH];
    int material[BATCH];
} batch;

/* Evaluates a criterion for the measures of bonds `entry`. If a bond has two criteria (of its two ends), the
 * larger utilisation and the smaller load factor are kept. */
static void take_worse (const judging *s, const pg_criterion *c, const pg_bond_measures *m,
                        const size_t *entry)
{
    double out[BATCH];
    char kind[BATCH];
    if (s->utilisation) c->type->utilisation (c, m, out, kind);
    for (size_t k = 0; s->utilisation && k < m->n; k++) {
        if (out[k] < s->utilisation[entry[k]]) continue;
        s->utilisation[entry[k]] = out[k];
        if (s->kind) s->kind[entry[k]] = kind[k];
    }
    if (s->factor) c->type->factor (c, m, out);
    for (size_t k = 0; s->factor && k < m->n; k++)
        if (!(out[k] > s->factor[entry[k]])) s->factor[entry[k]] = out[k];
}

/* Evaluates the limits of one material for the bonds of a batch that have it, copied together: criteria take
 * arrays, so that their loops are long. */
static void judge_by (const judging *s, const batch *all, int material)
{
    const pg_problem *p = s->b->problem;
    size_t dim = (size_t) p->dim, some[BATCH], n = 0;
    double xi[3 * BATCH], eta[3 * BATCH], reach[BATCH], shear[BATCH], bending[BATCH];
    for (size_t k = 0; k < all->n; k++) {
        if (all->material[k] != material) continue;
        memcpy (xi + n * dim, all->xi + k * dim, dim * sizeof *xi);
        memcpy (eta + n * dim, all->eta + k * dim, dim * sizeof *eta);
        shear[n] = all->shear[k], bending[n] = all->bending[k];
        reach[n] = all->reach[k], some[n++] = all->entry[k];
    }
    pg_bond_measures m = { .n = n, .dim = p->dim, .xi = xi, .eta = eta, .reach = p->cloud.size ? reach : NULL,
                           .shear = s->b->theory->strain ? shear : NULL,
                           .bending = s->b->theory->strain ? bending : NULL };
    if (n) take_worse (s, &p->at.limit[material], &m, some);
}

/* Evaluates a batch of bonds by the limits of all materials in it, and empties it. */
static void judge (const judging *s, batch *all)
{
    for (size_t k = 0; k < all->n; k++) {
        size_t before = 0;
        while (all->material[before] != all->material[k]) before++;
        if (before == k) judge_by (s, all, all->material[k]);      /* each material once */
    }
    all->n = 0;
}

/* Adds the measures of bond e of point i at displacement d to the batch; a full batch is evaluated. */
static void add (const judging *s, batch *all, size_t i, const point_bonds *bonds, size_t e, int material,
                 double ratio)
{
    size_t dim = (size_t) s->b->dim, m = (size_t) s->b->stride, j = (size_t) bonds->node[e], k = all->n++;
    memcpy (all->xi + k * dim, bonds->xi + e * dim, dim * sizeof *all->xi);
    for (size_t a = 0; a < dim; a++) all->eta[k * dim + a] = s->d[j * m + a] - s->d[i * m + a];
    all->shear[k] = all->bending[k] = 0;
    if (s->b->theory->strain)
        s->b->theory->strain (s->b, bonds->xi + e * dim, s->d + i * m, s->d + j * m, &all->shear[k],
                              &all->bending[k]);
    all->reach[k] = ratio;
    all->entry[k] = bonds->first + e, all->material[k] = material;
    if (all->n == BATCH) judge (s, all);
}

/* Evaluates the intact bonds of points first .. last - 1. A bond between two materials is put into the batch
 * twice, for the limits of either end; in graded clouds limits of stretch depend on the spacing at each end.
 * The weaker end decides. */
static void judge_points (void *context, size_t first, size_t last, int thread)
{
    const judging *s = context;
    const bond_force *b = s->b;
    const unsigned char *exempt = b->problem->bonds.exempt[PG_NODES];
    const int *material = b->problem->at.limit_of[PG_NODES];
    point_bonds bonds;
    batch all = { .n = 0 };
    for (size_t i = first; i < last; i++) {
        point_bonds_at (b, i, thread, &bonds);
        for (size_t e = 0; e < bonds.m; e++) {
            size_t j = (size_t) bonds.node[e], entry = bonds.first + e;
            if (s->utilisation) s->utilisation[entry] = 0;
            if (s->factor) s->factor[entry] = INFINITY;
            if (!s->state->alive[entry] || exempt[i] || exempt[j]) continue;
            double near = pg_cloud_ratio (&b->problem->cloud, i),
                   far = pg_cloud_ratio (&b->problem->cloud, j);
            int alike = material[j] == material[i];
            /* the weaker end decides */
            add (s, &all, i, &bonds, e, material[i], alike ? fmax (near, far) : near);
            if (!alike) add (s, &all, i, &bonds, e, material[j], far);
        }
    }
    judge (s, &all);
}

/* Writes the mode by which each bond of a group breaks (pg_criterion_type.utilisation). */
static void tell_kinds (const bond_force *b, const double *d, const pg_bond_group *group, char *kind)
{
    char usual = b->problem->criterion->type->needs & PG_NEEDS_ENERGY ? 'e' : 't';
    for (size_t k = 0; kind && k < group->n; k++)
        kind[k] = b->theory->kind_of ? b->theory->kind_of (b, d, group->bond[k]) : usual;
}

/* ---- at points ----------------------------------------------------------------------------------------- */
typedef struct {
    const bond_force *b;
    const unsigned char *alive;
    const double *d;
    double *value;
    void (*at) (const bond_force *b, const unsigned char *alive, const double *d, size_t i,
                const point_bonds *s,
                double *out);
    size_t components;
} painting;

/* Computes a field at the points first .. last - 1. */
static void paint_points (void *context, size_t first, size_t last, int thread)
{
    const painting *p = context;
    point_bonds s;
    for (size_t i = first; i < last; i++) {
        point_bonds_at (p->b, i, thread, &s);
        p->at (p->b, p->alive, p->d, i, &s, p->value + i * p->components);
    }
}

/* Damage of point i: share of the partial volumes of its family whose bonds are broken. beta: workspace. */
static double damage_at (const bond_force *b, const unsigned char *alive, size_t i, double *beta)
{
    const pg_family *f = b->family;
    double all = 0, dead = 0;
    pg_sums_bonds (b->problem->sums, f, i, NULL, NULL, beta);
    for (size_t e = f->start[i]; e < f->start[i + 1]; e++) {
        double share = beta[e - f->start[i]] * b->problem->cloud.volume[f->node[e]];
        all += share;
        if (!alive[e]) dead += share;
    }
    return all > 0 ? dead / all : 0;
}

/* Damage of the points first .. last - 1. It is computed for every row of history.csv: most points have all
 * their bonds, so that the alive mask is checked for AT_ONCE points at a time first. */
static void paint_damage (void *context, size_t first, size_t last, int thread)
{
    enum { AT_ONCE = 128 };
    const painting *p = context;
    const size_t *start = p->b->family->start;
    double *beta = p->b->workspace + (size_t) thread * p->b->widest * (size_t) (p->b->dim + 2);
    for (size_t i = first, end; i < last; i = end) {
        end = i + AT_ONCE < last ? i + AT_ONCE : last;
        memset (p->value + i, 0, (end - i) * sizeof *p->value);
        if (start[end] == start[i] || !memchr (p->alive + start[i], 0, start[end] - start[i])) continue;
        for (size_t k = i; k < end; k++)
            if (start[k + 1] > start[k] && memchr (p->alive + start[k], 0, start[k + 1] - start[k]))
                p->value[k] = damage_at (p->b, p->alive, k, beta);
    }
}

/* Displacement gradient at point i, H[c * dim + k] = du_c/dx_k, from the intact bonds by least squares,
 * weighted by partial volumes: H sum w xi xi = sum w eta xi. 0 where these bonds do not span all directions
 * (smallest eigenvalue of sum w xi xi below 1e-3 h^2 sum w), as the gradient is not determined there. */
static void gradient_at (const bond_force *b, const unsigned char *alive, const double *d, size_t i,
                         const point_bonds *s, double *H)
{
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    double M[9] = { 0 }, B[9] = { 0 }, lambda[3], sum = 0, h = pg_problem_spacing (b->problem, PG_NODES, i);
    memset (H, 0, dim * dim * sizeof *H);
    for (size_t e = 0; e < s->m; e++) {
        size_t j = (size_t) s->node[e];
        const double *xi = s->xi + e * dim;
        if (alive && !alive[s->first + e]) continue;
        double w = s->beta[e] * b->problem->cloud.volume[j];
        sum += w;
        for (size_t a = 0; a < dim; a++)
            for (size_t c = 0; c < dim; c++)
                M[a * dim + c] += w * xi[a] * xi[c],
                    B[a * dim + c] += w * (d[j * m + a] - d[i * m + a]) * xi[c];
    }
    pg_dense_eigen (b->dim, M, lambda, NULL);
    if (!(lambda[dim - 1] > 1e-3 * h * h * sum) || pg_dense_cholesky (b->dim, M, 1e-12)) return;
    memcpy (H, B, dim * dim * sizeof *H);
    for (size_t a = 0; a < dim; a++) pg_dense_solve (b->dim, M, H + a * dim);
}

/* Strain at point i, Voigt order with engineering shears (xx yy zz xy yz zx), from the displacement gradient
 * that fits the intact bonds. */
static void strain_at (const bond_force *b, const unsigned char *alive, const double *d, size_t i,
                       const point_bonds *s, double *out)
{
    double H[9];
    gradient_at (b, alive, d, i, s, H);
    out[0] = H[0];
    if (b->dim == 2) out[1] = H[3], out[2] = H[1] + H[2];
    if (b->dim == 3)
        out[1] = H[4], out[2] = H[8], out[3] = H[1] + H[3], out[4] = H[5] + H[7], out[5] = H[2] + H[6];
}

/* Stress at point i, Voigt order, Pa: the symmetric part of the virial of the bonds' forces. The other part
 * is borne by couples (micropolar bonds). */
static void stress_at (const bond_force *b, const unsigned char *alive, const double *d, size_t i,
                       const point_bonds *s, double *out)
{
    double T[9] = { 0 };
    b->theory->virial (b, i, s, alive, d, T);
    out[0] = T[0];
    if (b->dim == 2) out[1] = T[3], out[2] = 0.5 * (T[1] + T[2]);
    if (b->dim == 3)
        out[1] = T[4], out[2] = T[8], out[3] = 0.5 * (T[1] + T[3]), out[4] = 0.5 * (T[5] + T[7]),
        out[5] = 0.5 * (T[2] + T[6]);
}

/* Copies `count` unknowns of every point from the `first` on, times a scale. Rows of history.csv ask for the
 * displacements each time. */
static void take_parts (const bond_force *b, const double *d, int first, int count, double scale,
                        double *value)
{
    if (count == b->stride && scale == 1) {
        memcpy (value, d, b->n * (size_t) count * sizeof *value);
        return;
    }
    for (size_t i = 0; i < b->n; i++)
        for (size_t k = 0; k < (size_t) count; k++)
            value[i * (size_t) count + k] = scale * d[i * (size_t) b->stride + (size_t) first + k];
}

/* Writes the field `name` if it is a part of the unknowns or of the velocity; returns 0 if it is not. */
static int take_unknowns (const bond_force *b, const pg_state *state, const double *d, const char *name,
                          int *components, const char **unit, double *value)
{
    int velocity = strcmp (name, "velocity") == 0, rotations = b->stride - b->dim;
    if (velocity || strcmp (name, "displacement") == 0 || strcmp (name, "coefficient") == 0) {
        *components = b->dim, *unit = velocity ? "m/s" : "m";
        take_parts (b, velocity ? state->v : d, 0, b->dim, 1, value);
        return 1;
    }
    if (!rotations || strcmp (name, "rotation") != 0) return 0;
    *components = rotations, *unit = "rad";
    take_parts (b, d, b->dim, rotations, 1 / b->length, value);
    return 1;
}

pg_status bond_force_field (void *self, const pg_state *state, const double *d, const char *name,
                            int *components, const char **unit, double *value)
{
    bond_force *b = self;
    painting p = { b, state->alive, d, value, NULL, 1 };
    *components = 0, *unit = "";
    if (take_unknowns (b, state, d, name, components, unit, value)) return PG_OK;
    if (strcmp (name, "nodal_force") == 0) {
        *components = b->dim, *unit = "N";
        pg_status status = pg_bond_loop_force (b->loop, d, b->work, NULL);
        if (status == PG_OK) take_parts (b, b->work, 0, b->dim, -1, value);
        return status;
    }
    if (strcmp (name, "damage") == 0) {
        *components = 1;
        pg_parallel (b->threads, b->n, paint_damage, &p);
        return PG_OK;
    }
    if (strcmp (name, "strain") == 0) *components = pg_voigt_size (b->dim), p.at = strain_at;
    else if (strcmp (name, "stress") == 0)
        *components = pg_voigt_size (b->dim), *unit = "Pa", p.at = stress_at;
    else return PG_OK;
    p.components = (size_t) *components;
    if (p.at == stress_at && dilatation_weigh (b) != PG_OK) return PG_E_MEMORY;
    pg_parallel (b->threads, b->n, paint_points, &p);
    return PG_OK;
}

/* ---- at any position ----------------------------------------------------------------------------------- */
/* Makes the search among points, when it is first needed. */
static pg_status make_near (bond_force *b)
{
    return b->near ? PG_OK : pg_nearest_create (&b->near, b->dim, b->n, b->problem->cloud.x);
}

/* Data of `hidden`: the cracks behind which points are hidden from a position. */
typedef struct { const pg_problem *problem; const pg_cracks *cracks; } view;

/* Is a crack between the position and the point (pg_refuse)? Displacements jump across it. */
static int hidden (void *context, const double *place, size_t point)
{
    const view *v = context;
    const pg_problem *p = v->problem;
    return pg_cracks_cut (v->cracks, place, p->cloud.x + point * (size_t) p->dim,
                          pg_cloud_same (&p->cloud)) != NULL;
}

/* Lists the nearest points to x on the same side of all cracks (equally near ones all); if cracks hide all
 * points, the nearest of all. Returns how many. */
static size_t points_about (bond_force *b, const pg_state *state, const double *x, size_t *point)
{
    view v = { b->problem, pg_state_cracks (b->problem, state) };
    double same = PG_NO_LENGTH * b->problem->cloud.h;
    return pg_nearest_seen (b->near, x, same, v.cracks->n ? hidden : NULL, &v, point);
}

/* Adds a share of the displacement at x, m, by a first-order expansion about point i, and of the displacement
 * gradient of point i (H: 9 numbers, dim x dim used). */
static void expand (bond_force *b, const pg_state *state, const double *d, const double *x, size_t i,
                    double share, point_bonds *s, double *u, double *H)
{
    size_t dim = (size_t) b->dim;
    double own[9] = { 0 };
    point_bonds_at (b, i, 0, s);
    gradient_at (b, state->alive, d, i, s, own);
    for (size_t a = 0; a < dim; a++) {
        u[a] += share * d[i * (size_t) b->stride + a];
        for (size_t c = 0; c < dim; c++) {
            double H_ac = share * own[a * dim + c];
            H[a * dim + c] += H_ac, u[a] += H_ac * (x[c] - b->problem->cloud.x[i * dim + c]);
        }
    }
}

/* Adds a share of the stress at point i, Pa (out: 6). 2D: the stress across the plane follows from the
 * mode. */
static void add_stress (bond_force *b, const pg_state *state, const double *d, size_t i, double share,
                        point_bonds *s, double *out)
{
    double v[6], full[6] = { 0 };
    stress_at (b, state->alive, d, i, s, v);
    if (b->dim == 3) memcpy (full, v, sizeof v);
    else full[0] = v[0];
    if (b->dim == 2) full[1] = v[1], full[3] = v[2];
    if (b->problem->mode == PG_PLANE_STRAIN)
        full[2] = b->problem->material[b->problem->block[PG_NODES][i]].nu * (v[0] + v[1]);
    for (int k = 0; k < 6; k++) out[k] += share * full[k];
}

pg_status bond_force_sample (void *self, const pg_state *state, const double *d, size_t n, const double *x,
                             double *u, double *stress, double *gradient)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    point_bonds s;
    PG_TRY (make_near (b));
    memset (u, 0, 3 * n * sizeof *u);
    if (stress) memset (stress, 0, 6 * n * sizeof *stress);
    for (size_t k = 0; k < n; k++) {
        const double *place = x + k * (size_t) b->dim;
        double H[9] = { 0 };
        size_t point[PG_NEAREST_MOST], about = points_about (b, state, place, point);
        for (size_t m = 0; m < about; m++) {
            expand (b, state, d, place, point[m], 1 / (double) about, &s, u + 3 * k, H);
            if (stress) add_stress (b, state, d, point[m], 1 / (double) about, &s, stress + 6 * k);
        }
        if (gradient) memcpy (gradient + 9 * k, H, sizeof H);
    }
done:
    return status;
}

/* ---- broken bonds -------------------------------------------------------------------------------------- */
typedef struct { bond_force *b; const pg_state *state; const double *d; double *worst; } closing;

/* Overlap of the points first .. last - 1, m: by how much the ends of a short broken bond have approached
 * each other beyond the shortening of the material around, the largest of each point. Points with all their
 * bonds are skipped. */
static void closing_points (void *context, size_t first, size_t last, int thread)
{
    const closing *w = context;
    const bond_force *b = w->b;
    size_t dim = (size_t) b->dim, m = (size_t) b->stride;
    point_bonds s;
    double H[9];
    for (size_t i = first; i < last; i++) {
        double limit = 1.5 * pg_problem_spacing (b->problem, PG_NODES, i);
        w->worst[i] = 0;
        if (!memchr (w->state->alive + b->family->start[i], 0, b->family->start[i + 1] - b->family->start[i]))
            continue;
        point_bonds_at (b, i, thread, &s);
        gradient_at (b, w->state->alive, w->d, i, &s, H);
        for (size_t e = 0; e < s.m; e++) {
            const double *xi = s.xi + e * dim;
            double rr = 0, approach = 0, elastic = 0;
            if (w->state->alive[s.first + e]) continue;
            for (size_t a = 0; a < dim; a++) {
                rr += xi[a] * xi[a];
                approach -= xi[a] * (w->d[(size_t) s.node[e] * m + a] - w->d[i * m + a]);
                for (size_t c = 0; c < dim; c++) elastic -= xi[a] * H[a * dim + c] * xi[c];
            }
            if (rr <= limit * limit)
                w->worst[i] = fmax (w->worst[i], (approach - fmax (elastic, 0)) / sqrt (rr));
        }
    }
}

/* Returns the largest overlap, m, over the points that this rank owns. */
static double largest_overlap (bond_force *b, const pg_state *state, const double *d)
{
    closing w = { b, state, d, b->work };
    double worst = 0;
    pg_parallel (b->threads, b->n, closing_points, &w);
    for (size_t i = 0; i < b->n; i++)
        if (pg_cloud_owns (&b->problem->cloud, i)) worst = fmax (worst, b->work[i]);
    return worst;
}

/* Evaluates the criterion for every bond; criteria of energies are evaluated for points. */
pg_status bond_force_judge (void *self, const pg_state *state, const double *d, const pg_judging *w)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    judging s = { b, state, d, w->utilisation, w->factor, w->kind };
    if (w->overlap) {
        *w->overlap = largest_overlap (b, state, d);
        return PG_OK;
    }
    if (!b->problem->criterion->type)
        PG_FAIL (PG_E_USAGE, "there is no failure criterion, and so no utilisation");
    if (w->group) tell_kinds (b, d, w->group, w->kind);
    else if (b->problem->criterion->type->needs & PG_NEEDS_ENERGY)
        PG_TRY (bond_force_energy_utilisation (b, state, d, w->utilisation, w->kind, w->factor));
    else pg_parallel (b->threads, b->n, judge_points, &s);
    if (w->over) PG_TRY (pg_worst_bonds (b->problem, state, w->utilisation, w->from, w->top, w->over));
done:
    return status;
}

/* Joins point i with the points j < i to which intact bonds connect it. Most of these have its root
 * already. */
static void join_before (const bond_force *b, size_t i, int *parent)
{
    const pg_cloud *cloud = &b->problem->cloud;
    const pg_family *f = b->family;
    int root = (int) i;
    for (size_t e = f->start[i]; e < f->start[i + 1] && (size_t) f->node[e] < i; e++) {
        int j = f->node[e];
        if (parent[j] == root || !bond_force_lives (b, e)) continue;
        if (pg_cloud_owns (cloud, i) || pg_cloud_owns (cloud, (size_t) j))
            root = pg_disjoint_join (parent, root, j);
    }
}

/* Joins the ends of all intact bonds (union-find). */
void bond_force_join (void *self, int *parent)
{
    bond_force *b = self;
    pg_disjoint_start (parent, b->n);
    for (size_t i = 0; i < b->n; i++) join_before (b, i, parent);
}

/* Counts the parts of the body that intact bonds hold together: single points, and parts of several points
 * but for the body itself. */
pg_status bond_force_census (void *self, pg_census *out)
{
    pg_status status = PG_OK;
    bond_force *b = self;
    int *parent = NULL;
    double parts[2];
    out->degenerate = out->unended = 0;
    PG_ALLOC (parent, b->n);
    bond_force_join (b, parent);
    PG_TRY (pg_subdomain_count (b->problem->cloud.subdomain, b->n, parent, parts));
    out->isolated = (size_t) parts[0], out->fragments = (size_t) parts[1];
    if (out->fragments) --out->fragments;              /* the body itself is not a fragment */
done:
    pg_free (parent);
    return status;
}
