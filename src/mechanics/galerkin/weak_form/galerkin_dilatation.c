/* SPDX-License-Identifier: GPL-3.0-or-later
 * The dilatation that carries the pressure near Poisson's ratio 1/2: stress = lambda P (div u) 1 + (D -
 * lambda 1 1') strain, P the projection, by the weights of the evaluation points, on polynomials of a patch
 * (integration.h): 1 and x, y (, z), or 1 alone where the patch is small. With psi_m orthonormal, sum_p w_p
 * psi_m (p) psi_n (p) = delta_mn, and g_m = sum_p w_p psi_m (p) grad N (p), the patch adds (lambda / 2)
 * sum_m (g_m . d)^2 to the energy: K stays symmetric, and its energy is at most that without projection.
 * Linear displacements have constant dilatation: nothing changes for them. Where bonds are broken a patch is
 * divided into the parts that intact bonds of neighbours still join, each with polynomials of its own. A
 * point shared by several patches contributes to each by its share of the weight, and the pressure there is
 * the mean of theirs. */
#include "galerkin_dilatation.h"
#include <math.h>
#include <string.h>

/* share of the full volume from which on a part is linear, else constant */
static const double enough = 0.7;
static const double nearby = 1.25;         /* length up to which bonds join the points of a patch, spacings */

typedef galerkin_part part;

/* psi_m at position x: L^-1 (1, (x - centre) / size), orthonormal over the points of the part. x may lie
 * outside of the patch, on a facet. */
void galerkin_dilatation_polynomials (const galerkin *g, const galerkin_part *a, const double *x, double *psi)
{
    psi[0] = 1;
    for (int k = 0; k < a->terms - 1; k++) psi[k + 1] = (x[k] - a->centre[k]) / a->size;
    (void) g;
    for (int i = 0; i < a->terms; i++) {               /* solves with the Cholesky factor L */
        for (int j = 0; j < i; j++) psi[i] -= a->L[i * a->terms + j] * psi[j];
        psi[i] /= a->L[i * a->terms + i];
    }
}

/* Share of entry i of the patches in the weight of its point, m^3; 0 where the point has no gradient and so
 * carries no stress. */
static double weight (const galerkin *g, size_t i)
{
    const pg_patches *q = g->problem->form.patches;
    size_t p = q->point[i];
    return g->rows[g->bulk].grade[p] >= PG_GRADE_SHEPARD ? 0 : q->share[i] * g->sums.weight[p];
}

/* Computes volume (m^3), centroid and half width (m) of the points of patch c that belong to part k: with
 * these lengths the polynomials are of the order of 1, and L is well conditioned whatever the size of the
 * body. */
static void measure_part (const galerkin *g, size_t c, int k, part *a, double *volume)
{
    const galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    size_t dim = (size_t) g->dim;
    *volume = 0, a->size = 0;
    memset (a->centre, 0, sizeof a->centre);
    for (size_t i = q->first[c]; i < q->first[c + 1]; i++) {
        size_t p = q->point[i];
        if (d->part_of[i] != k) continue;
        *volume += weight (g, i);
        for (size_t m = 0; m < dim; m++) a->centre[m] += weight (g, i) * g->sums.x[p * dim + m];
    }
    for (size_t m = 0; m < dim; m++) a->centre[m] /= *volume;
    for (size_t i = q->first[c]; i < q->first[c + 1]; i++) {
        size_t p = q->point[i];
        if (d->part_of[i] != k) continue;
        for (size_t m = 0; m < dim; m++)
            a->size = fmax (a->size, fabs (g->sums.x[p * dim + m] - a->centre[m]));
    }
    if (!(a->size > 0)) a->size = 1;                   /* one point: constant */
}

/* Chooses the polynomials of a part of a patch: linear ones where it has most of the patch's volume and its
 * points span all directions (the Cholesky factor L of their Gram matrix exists), else the constant
 * alone. */
static void find_polynomials (const galerkin *g, size_t c, int k, part *a)
{
    const galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    size_t dim = (size_t) g->dim;
    double volume, z[4];
    measure_part (g, c, k, a, &volume);
    a->terms = volume >= enough * q->full[c] ? g->dim + 1 : 1;
    for (;; a->terms = 1) {
        int n = a->terms;
        memset (a->L, 0, sizeof a->L);
        for (size_t i = q->first[c]; i < q->first[c + 1]; i++) {
            size_t p = q->point[i];
            if (d->part_of[i] != k) continue;
            z[0] = 1;
            for (size_t m = 0; m < dim; m++) z[m + 1] = (g->sums.x[p * dim + m] - a->centre[m]) / a->size;
            for (int r = 0; r < n; r++)
                for (int s = 0; s <= r; s++) a->L[r * n + s] += weight (g, i) / volume * z[r] * z[s];
        }
        if (pg_dense_cholesky (n, a->L, 1e-3) == 0 || n == 1) break;
    }
    for (int r = 0; r < a->terms * a->terms; r++) a->L[r] *= sqrt (volume);
}

/* Computes g_m = sum_p w_p psi_m (p) grad N (p) of a part, on the nodes of its patch (terms x nodes x dim),
 * so that g_m . d is the m-th coefficient of the projected dilatation, m^(3/2). */
static void sum_rows (const galerkin *g, size_t c, int k, part *a)
{
    const galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    const pg_rows *r = &g->sums;
    size_t dim = (size_t) g->dim, first = d->family.start[c], m = d->family.start[c + 1] - first;
    const int *node = d->family.node + first;
    double psi[4];
    memset (a->g, 0, (size_t) a->terms * m * dim * sizeof *a->g);
    for (size_t i = q->first[c]; i < q->first[c + 1]; i++) {
        size_t p = q->point[i], at = 0, offset = pg_rows_offset (r, p);
        if (d->part_of[i] != k) continue;
        galerkin_dilatation_polynomials (g, a, r->x + p * dim, psi);
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++, at++) {
            while (node[at] != r->family.node[e]) at++;
            for (int t = 0; t < a->terms; t++)
                for (size_t s = 0; s < dim; s++)
                    a->g[((size_t) t * m + at) * dim + s] += weight (g, i) * psi[t]
                                                         * r->dN[(e + offset) * dim + s];
        }
    }
}

/* ---- parts --------------------------------------------------------------------------------------------- */
/* Has patch c all its bonds, and a gradient at all points? Then it is one part. */
static int whole (const galerkin *g, const pg_state *state, size_t c)
{
    const pg_patches *q = g->problem->form.patches;
    const size_t *start = g->rows[g->bulk].family.start;
    const unsigned char *alive = state->alive + g->problem->bonds.first[g->bulk];
    for (size_t i = q->first[c]; i < q->first[c + 1]; i++) {
        size_t p = q->point[i];
        if (g->rows[g->bulk].grade[p] >= PG_GRADE_SHEPARD
            || memchr (alive + start[p], 0, start[p + 1] - start[p]))
            return 0;
    }
    return 1;
}

/* Length of bond e from point p, m. */
static double length_of (const galerkin *g, size_t p, size_t e)
{
    const pg_rows *r = &g->rows[g->bulk];
    size_t dim = (size_t) g->dim, j = (size_t) r->family.node[e];
    double s = 0;
    for (size_t k = 0; k < dim; k++) s += pow (g->problem->cloud.x[j * dim + k] - r->x[p * dim + k], 2);
    return sqrt (s);
}

/* The first point of the patch that has reached this node; set by the first call for the node. */
static int stamped (galerkin_dilatation *d, int node, int first)
{
    if (d->stamp[node] < 0) d->stamp[node] = first;
    return d->stamp[node];
}

/* Joins points of a patch that have intact bonds to a common node. Only bonds of about a spacing count (and
 * the shortest one of each point, or the node itself): long bonds pass around the end of a crack and would
 * join its two sides. parent: union of the points by their position in the patch. */
static void join (galerkin *g, const pg_state *state, size_t c, int *parent)
{
    galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    const pg_rows *r = &g->rows[g->bulk];
    const unsigned char *alive = state->alive + g->problem->bonds.first[g->bulk];
    size_t n = q->first[c + 1] - q->first[c];
    for (size_t e = q->family.start[c]; e < q->family.start[c + 1]; e++) d->stamp[q->family.node[e]] = -1;
    pg_disjoint_start (parent, n);
    for (size_t i = 0; i < n; i++) {
        size_t p = q->point[q->first[c] + i];
        double reach = nearby * pg_problem_spacing (g->problem, g->bulk, p), shortest = INFINITY;
        if (r->grade[p] >= PG_GRADE_SHEPARD) continue;
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
            if (alive[e] || r->family.node[e] == r->own[p]) shortest = fmin (shortest, length_of (g, p, e));
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            if (!alive[e] && r->family.node[e] != r->own[p]) continue;
            if (length_of (g, p, e) > fmax (reach, shortest * (1 + 1e-6))) continue;
            pg_disjoint_join (parent, stamped (d, r->family.node[e], (int) i), (int) i);
        }
    }
}

/* Divides patch c into parts, numbered in the order of their first points (d->part_of; -1: the point carries
 * no stress). */
static pg_status divide (galerkin *g, const pg_state *state, size_t c, int *count)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    size_t n = q->first[c + 1] - q->first[c];
    int *parent = NULL, *name = NULL;
    *count = 1;
    for (size_t i = 0; i < n; i++) d->part_of[q->first[c] + i] = 0;
    if (whole (g, state, c)) return PG_OK;
    PG_ALLOC (parent, n);
    PG_ALLOC (name, n);
    join (g, state, c, parent);
    *count = 0;
    for (size_t i = 0; i < n; i++) name[i] = -1;
    for (size_t i = 0; i < n; i++) {
        int r = pg_disjoint_root (parent, (int) i), *its = &d->part_of[q->first[c] + i];
        *its = -1;
        if (g->rows[g->bulk].grade[q->point[q->first[c] + i]] >= PG_GRADE_SHEPARD) continue;
        if (name[r] < 0) name[r] = (*count)++;
        *its = name[r];
    }
done:
    pg_free (parent), pg_free (name);
    return status;
}

/* Computes parts, polynomials and rows of one patch from its intact bonds. The rows of all parts lie in one
 * block; a patch behind supported facets has rows s for these as well. */
static pg_status rebuild (galerkin *g, const pg_state *state, size_t c)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_family *f = &d->family;
    galerkin_patch *patch = &d->patch[c];
    size_t one = (size_t) (g->dim + 1) * (f->start[c + 1] - f->start[c]) * (size_t) g->dim,
           pinned = d->facet_start[c + 1] > d->facet_start[c];
    size_t workspace = pinned ? 2 * one : one;
    int count;
    PG_TRY (divide (g, state, c, &count));
    if ((size_t) count > patch->workspace) {
        PG_GROW (patch->part, patch->workspace, (size_t) count);
        PG_GROW (patch->g, patch->room_g, patch->workspace * workspace);
    }
    patch->n = (size_t) count;
    for (int k = 0; k < count; k++) {
        patch->part[k].g = patch->g + (size_t) k * workspace;
        find_polynomials (g, c, k, &patch->part[k]);
        sum_rows (g, c, k, &patch->part[k]);
        patch->part[k].s = pinned ? patch->part[k].g + one : NULL;
        galerkin_dilatation_facet_rows (g, c, k, &patch->part[k]);
    }
done:
    return status;
}

/* ---- creation and update ------------------------------------------------------------------------------- */
/* Allocates memory and makes the materials without lambda (plain), which give the stress except the pressure
 * of the patches. Rows follow with the first update. */
pg_status galerkin_dilatation_create (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_problem *p = g->problem;
    galerkin_dilatation *d = NULL;
    if (!p->form.patches) return PG_OK;
    size_t nv = (size_t) g->nv;
    PG_ALLOC (d, 1);
    g->dilatation = d;
    PG_ALLOC (d->plain, p->nmaterial);
    PG_ALLOC (d->patch, p->form.patches->n);
    PG_ALLOC (d->part_of, p->form.patches->first[p->form.patches->n]);
    PG_ALLOC (d->stamp, g->n);
    PG_ALLOC (d->mark, p->form.patches->n);
    PG_ALLOC (d->amount, g->n);
    PG_ALLOC (d->share, g->n);
    for (size_t m = 0; m < p->nmaterial; m++) {
        pg_material *a = &d->plain[m];
        *a = p->material[m];
        for (size_t k = 0; k < (size_t) g->dim; k++) {
            a->out_of_plane[k] -= g->dim == 2 ? p->form.patches->lambda[m] : 0;
            for (size_t l = 0; l < (size_t) g->dim; l++) a->D[k * nv + l] -= p->form.patches->lambda[m];
        }
    }
    PG_TRY (galerkin_dilatation_facets_create (g));
done:
    return status;
}

/* Frees the projected dilatation; NULL (a body without patches): nothing to do. */
void galerkin_dilatation_free (galerkin *g)
{
    galerkin_dilatation *d = g->dilatation;
    if (!d) return;
    for (size_t c = 0; d->patch && c < g->problem->form.patches->n; c++)
        pg_free (d->patch[c].part), pg_free (d->patch[c].g);
    galerkin_dilatation_facets_free (g);
    pg_free (d->plain), pg_free (d->patch), pg_free (d->part_of), pg_free (d->stamp), pg_free (d->mark),
        pg_free (d->amount), pg_free (d->share);
    pg_free (d);
    g->dilatation = NULL;
}

/* The material that gives the stress at a point before the pressure of its patch is added. */
const pg_material *galerkin_plain (const galerkin *g, int set, size_t p)
{
    int block = g->material[set][p];
    int carried = g->dilatation && g->problem->form.patches->lambda[block] > 0;
    return carried ? &g->dilatation->plain[block] : galerkin_material (g, set, p);
}

/* Marks the patches of evaluation point p. */
static void mark_patches (galerkin_dilatation *d, const pg_patches *q, size_t p)
{
    for (size_t k = q->start[p]; k < q->start[p + 1]; k++) d->mark[q->of[q->entry[k]]] = 1;
}

/* Rebuilds the patches of points that lost a bond, or that touched facet points belong to; the rows of K of
 * their nodes become stale. */
pg_status galerkin_dilatation_update (galerkin *g, const pg_state *state, int all, const size_t *count)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    memset (d->mark, all, q->n);
    for (size_t k = 0; !all && k < count[g->bulk]; k++) mark_patches (d, q, g->list[g->bulk][k]);
    for (size_t k = 0; !all && k < count[PG_FACETS]; k++) {
        long home = d->home[g->list[PG_FACETS][k]];
        if (home >= 0) mark_patches (d, q, (size_t) home);
    }
    for (size_t c = 0; c < q->n; c++) {
        if (!d->mark[c]) continue;
        int supported = d->facet_start[c + 1] > d->facet_start[c];
        if (!all) PG_TRY (galerkin_change_patch (g, c, supported, -1));
        PG_TRY (rebuild (g, state, c));
        if (!all) PG_TRY (galerkin_change_patch (g, c, supported, 1));
        for (size_t e = d->family.start[c]; !all && e < d->family.start[c + 1]; e++)
            g->stiffness.stale[d->family.node[e]] = 1;
    }
done:
    return status;
}

/* ---- contributions of the patches to K ----------------------------------------------------------------- */
const pg_family *galerkin_dilatation_family (const galerkin *g) { return &g->dilatation->family; }

/* Lame's first parameter of a patch's material, Pa: a patch lies in one material. */
static double lambda_of (const galerkin *g, size_t c)
{
    const pg_patches *q = g->problem->form.patches;
    return q->lambda[g->material[g->bulk][q->point[q->first[c]]]];
}

/* Component `at` of g_m - s_m. */
static double entry (const part *a, size_t at) { return a->s ? a->g[at] - a->s[at] : a->g[at]; }

/* Adds to `out` (m x dim x dim) the blocks of node a of patch c with the first m of its nodes: lambda
 * sum_m (g - s)(g - s)' and, at supported facets, Nitsche's factor times lambda s s'. */
void galerkin_dilatation_blocks (void *context, size_t c, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    const pg_family *f = &g->dilatation->family;
    const galerkin_patch *patch = &g->dilatation->patch[c];
    size_t dim = (size_t) g->dim, n = f->start[c + 1] - f->start[c];
    double lambda = lambda_of (g, c);
    for (size_t k = 0; k < patch->n; k++)
        for (size_t t = 0; t < (size_t) patch->part[k].terms; t++)
            for (size_t r = 0; r < dim; r++) {
                const part *q = &patch->part[k];
                double share = lambda * entry (q, (t * n + a) * dim + r),
                       flux = q->s ? lambda * g->options->nitsche * q->s[(t * n + a) * dim + r] : 0;
                for (size_t b = 0; b < m && share != 0; b++)
                    for (size_t s = 0; s < dim; s++)
                        out[(b * dim + r) * dim + s] += share * entry (q, (t * n + b) * dim + s);
                for (size_t b = 0; b < m && flux != 0; b++)
                    for (size_t s = 0; s < dim; s++)
                        out[(b * dim + r) * dim + s] += flux * q->s[(t * n + b) * dim + s];
            }
}

/* Computes g_m . x, or (whole) (g_m - s_m) . x, of every part of patches first .. last - 1. */
typedef struct { galerkin *g; const double *x; int whole; } measuring;

static void measure_patches (void *context, size_t first, size_t last, int thread)
{
    const measuring *m = context;
    const pg_family *f = &m->g->dilatation->family;
    size_t dim = (size_t) m->g->dim;
    (void) thread;
    for (size_t c = first; c < last; c++) {
        const int *node = f->node + f->start[c];
        size_t n = f->start[c + 1] - f->start[c];
        for (size_t k = 0; k < m->g->dilatation->patch[c].n; k++) {
            part *a = &m->g->dilatation->patch[c].part[k];
            size_t at = 0;
            for (int t = 0; t < a->terms; t++) {
                double sum = 0, flux = 0;
                for (size_t e = 0; e < n; e++)
                    for (size_t s = 0; s < dim; s++, at++) {
                        double x = m->x[(size_t) node[e] * dim + s];
                        sum += a->g[at] * x;
                        if (m->whole && a->s) flux += a->s[at] * x;
                    }
                a->amount[t] = sum - flux, a->flux[t] = flux;
            }
        }
    }
}

/* Measures all patches in parallel; each patch is the work of one thread. */
static void measure_all (galerkin *g, const double *x, int whole)
{
    measuring m = { g, x, whole };
    pg_parallel (g->threads, g->problem->form.patches->n, measure_patches, &m);
}

/* y += K x of the patches, N; summed in the order of patches, so that results do not depend on threads. */
void galerkin_dilatation_apply (galerkin *g, const double *x, double *y)
{
    const pg_family *f = &g->dilatation->family;
    size_t dim = (size_t) g->dim;
    measure_all (g, x, 1);
    for (size_t c = 0; c < f->n; c++) {
        double lambda = lambda_of (g, c);
        for (size_t k = 0; k < g->dilatation->patch[c].n; k++) {
            const part *a = &g->dilatation->patch[c].part[k];
            size_t at = 0;
            for (int t = 0; t < a->terms; t++)
                for (size_t e = f->start[c]; e < f->start[c + 1]; e++)
                    for (size_t s = 0; s < dim; s++, at++)
                        y[(size_t) f->node[e] * dim + s] +=
                            lambda
                            * (a->amount[t] * entry (a, at)
                               + (a->s ? g->options->nitsche * a->flux[t] * a->s[at] : 0));
        }
    }
}

/* d += diagonal of K of the patches, N/m. */
void galerkin_dilatation_diagonal (galerkin *g, double *d)
{
    const pg_family *f = &g->dilatation->family;
    size_t dim = (size_t) g->dim;
    for (size_t c = 0; c < f->n; c++) {
        double lambda = lambda_of (g, c);
        for (size_t k = 0; k < g->dilatation->patch[c].n; k++) {
            const part *a = &g->dilatation->patch[c].part[k];
            size_t at = 0;
            for (int t = 0; t < a->terms; t++)
                for (size_t e = f->start[c]; e < f->start[c + 1]; e++)
                    for (size_t s = 0; s < dim; s++, at++)
                        d[(size_t) f->node[e] * dim + s] +=
                            lambda
                            * (entry (a, at) * entry (a, at)
                               + (a->s ? g->options->nitsche * a->s[at] * a->s[at] : 0));
        }
    }
}

/* ---- pressures ----------------------------------------------------------------------------------------- */
/* lambda P (div u) at position x by the parts of bulk point p, Pa. */
static double pressure_at (const galerkin *g, size_t p, const double *x)
{
    const galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    double psi[4], sum = 0;
    for (size_t k = q->start[p]; k < q->start[p + 1]; k++) {
        size_t i = q->entry[k], c = q->of[i];
        if (d->part_of[i] < 0) continue;
        const part *a = &d->patch[c].part[d->part_of[i]];
        galerkin_dilatation_polynomials (g, a, x, psi);
        for (int t = 0; t < a->terms; t++) sum += lambda_of (g, c) * q->share[i] * psi[t] * a->amount[t];
    }
    return sum;
}

/* Adds a pressure to all normal stresses of a point; in 2D also to the one across the plane. */
static void add_pressure (galerkin *g, int set, size_t p, double value)
{
    for (int k = 0; k < g->dim; k++) g->measured.stress[set][p * (size_t) g->nv + (size_t) k] += value;
    if (g->dim == 2) g->measured.zz[set][p] += value;
}

/* Pressure at nodes that are no evaluation points: the mean of the patch pressures of the points with intact
 * bonds to the node, extrapolated to it and weighted by their influence; only points of the node's own
 * material count. */
static void node_pressures (galerkin *g, double *value, double *share)
{
    const pg_rows *r = &g->rows[g->bulk];
    const pg_patches *q = g->problem->form.patches;
    size_t dim = (size_t) g->dim;
    memset (value, 0, g->n * sizeof *value);
    memset (share, 0, g->n * sizeof *share);
    for (size_t p = 0; p < r->n; p++) {
        if (q->start[p] == q->start[p + 1] || g->dilatation->part_of[q->entry[q->start[p]]] < 0) continue;
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++) {
            size_t j = (size_t) r->family.node[e];
            double w = r->w[e + pg_rows_offset (r, p)] / g->problem->cloud.volume[j] * r->weight[p];
            if (!(w > 0) || g->material[PG_NODES][j] != g->material[g->bulk][p]) continue;
            value[j] += w * pressure_at (g, p, g->problem->cloud.x + j * dim), share[j] += w;
        }
    }
    for (size_t j = 0; j < g->n; j++) value[j] = share[j] > 0 ? value[j] / share[j] : 0;
}

/* Writes the pressure at every node to d->amount, Pa: that of its patch where nodes are evaluation points,
 * else the mean over points around it. */
static void at_nodes (galerkin *g)
{
    galerkin_dilatation *d = g->dilatation;
    if (g->bulk != PG_NODES) node_pressures (g, d->amount, d->share);
    else for (size_t p = 0; p < g->n; p++) d->amount[p] = pressure_at (g, p, g->sums.x + p * (size_t) g->dim);
}

/* Adds the pressures of the patches to the stresses of a set, which were computed with the materials without
 * lambda. */
void galerkin_dilatation_measure (galerkin *g, int set, const double *d)
{
    galerkin_dilatation *q = g->dilatation;
    size_t dim = (size_t) g->dim;
    measure_all (g, d, 0);
    if (set == PG_NODES) {
        at_nodes (g);
        for (size_t p = 0; p < g->n; p++) add_pressure (g, set, p, q->amount[p]);
    } else for (size_t p = 0; p < g->rows[set].n; p++) {
        long home = set == PG_FACETS ? q->home[p] : (long) p;
        if (home >= 0) add_pressure (g, set, p, pressure_at (g, (size_t) home, g->rows[set].x + p * dim));
    }
}

/* Pressures of all nodes at displacement d, Pa; borrowed until the next call. */
const double *galerkin_dilatation_of_nodes (galerkin *g, const double *d)
{
    measure_all (g, d, 0);
    at_nodes (g);
    return g->dilatation->amount;
}
