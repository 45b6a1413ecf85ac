/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nitsche's terms with a projected dilatation: the traction on a supported facet has the pressure of the patch behind it, its polynomials carried on
 * to the facet: - int v_k n_k lambda P (div u) and its transpose, so that the weak form stays consistent and K symmetric. */
#include "galerkin_dilatation.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- which patch goes on at a facet ----------------------------------------------------------------------------------- */
static double distance2 (int dim, const double *x, const double *y)
{
    double s = 0;
    for (int k = 0; k < dim; k++) s += (x[k] - y[k]) * (x[k] - y[k]);
    return s;
}

/* The nearest point of the cell behind a facet that belongs to a patch, else the nearest of all; with nodal integration always that. */
static pg_status find_homes (galerkin *g)
{
    pg_status status = PG_OK;
    const pg_rows *r = &g->rows[PG_FACETS], *b = &g->rows[g->bulk];
    const pg_problem *p = g->problem;
    size_t dim = (size_t) g->dim, *first = NULL;
    pg_nearest *grid = NULL;
    PG_ALLOC (g->dilatation->home, r->n);
    PG_ALLOC (first, p->cells.n + 1);
    for (size_t q = 0; q < b->n; q++) if (b->cell[q] >= 0) first[b->cell[q] + 1]++;
    for (size_t c = 0; c < p->cells.n; c++) first[c + 1] += first[c];
    PG_TRY (pg_nearest_create (&grid, g->dim, b->n, b->x));
    for (size_t f = 0; f < r->n; f++) {
        size_t cell = (size_t) p->cells.facet_cell[r->cell[f]];
        double best = INFINITY;
        long home = -1;
        for (size_t q = first[cell]; q < first[cell + 1]; q++) {
            double d = distance2 (g->dim, r->x + f * dim, b->x + q * dim);
            if (p->patches->of[q] >= 0 && d < best) best = d, home = (long) q;
        }
        if (home < 0) home = pg_nearest_find (grid, r->x + f * dim, NULL, NULL);
        g->dilatation->home[f] = p->patches->of[home] >= 0 ? home : -1;
    }
done:
    pg_nearest_free (&grid);
    pg_free (first);
    return status;
}

static int has_pins (const galerkin *g, size_t f) { return g->pin_start[f + 1] > g->pin_start[f]; }

static int ascending (const void *a, const void *b) { return *(const int *) a - *(const int *) b; }

/* Nodes of a facet point and of its patch, each once; facet points without pins have none. */
static pg_status unite (galerkin *g)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_family *own = &g->rows[PG_FACETS].family, *patch = &g->problem->patches->family;
    pg_family *out = &d->facet_family;
    size_t cap = 0, n = 0;
    PG_ALLOC (out->start, own->n + 1);
    out->n = own->n;
    for (size_t i = 0; i < g->n; i++) d->stamp[i] = -1;
    for (size_t f = 0; f < own->n; f++) {
        int pinned = has_pins (g, f) && d->home[f] >= 0;
        for (int side = 0; side < 2 && pinned; side++) {
            const pg_family *of = side ? patch : own;
            size_t at = side ? (size_t) g->problem->patches->of[d->home[f]] : f;
            PG_GROW (out->node, cap, n + of->start[at + 1] - of->start[at]);
            for (size_t e = of->start[at]; e < of->start[at + 1]; e++) {
                if (d->stamp[of->node[e]] == (int) f) continue;
                d->stamp[of->node[e]] = (int) f;
                out->node[n++] = of->node[e];
            }
        }
        if (pinned) qsort (out->node + out->start[f], n - out->start[f], sizeof (int), ascending);
        out->start[f + 1] = n;
    }
    PG_ALLOC (d->facet_N, n);
    PG_ALLOC (d->facet_g, n * (size_t) g->dim);
done:
    return status;
}

pg_status galerkin_dilatation_facets_create (galerkin *g)
{
    pg_status status = PG_OK;
    PG_TRY (find_homes (g));
    PG_TRY (unite (g));
done:
    return status;
}

void galerkin_dilatation_facets_free (galerkin *g)
{
    galerkin_dilatation *d = g->dilatation;
    pg_free (d->home), pg_free (d->facet_N), pg_free (d->facet_g);
    pg_family_clear (&d->facet_family);
}

/* ---- values ----------------------------------------------------------------------------------------------------------- */
/* Values of an ascending list of nodes, put at their places in a wider one, times a factor. */
static void spread (size_t n, const int *node, size_t stride, double factor, const double *value, const int *wide_node, double *wide)
{
    for (size_t i = 0, at = 0; i < n; i++, at++) {
        while (wide_node[at] != node[i]) at++;
        for (size_t k = 0; k < stride; k++) wide[at * stride + k] += factor * value[i * stride + k];
    }
}

static void fill (galerkin *g, size_t f)
{
    galerkin_dilatation *d = g->dilatation;
    const pg_family *own = &g->rows[PG_FACETS].family, *patch = &g->problem->patches->family;
    size_t first = d->facet_family.start[f], n = d->facet_family.start[f + 1] - first, dim = (size_t) g->dim;
    size_t c = (size_t) g->problem->patches->of[d->home[f]], m = patch->start[c + 1] - patch->start[c];
    const int *node = d->facet_family.node + first;
    const galerkin_part *a;
    double psi[4];
    memset (d->facet_N + first, 0, n * sizeof (double));
    memset (d->facet_g + first * dim, 0, n * dim * sizeof (double));
    spread (own->start[f + 1] - own->start[f], own->node + own->start[f], 1, 1, g->rows[PG_FACETS].N + own->start[f], node, d->facet_N + first);
    galerkin_dilatation_polynomials (g, (size_t) d->home[f], g->rows[PG_FACETS].x + f * dim, &a, psi);
    for (int t = 0; a && t < a->terms; t++)
        spread (m, patch->node + patch->start[c], dim, psi[t], a->g + (size_t) t * m * dim, node, d->facet_g + first * dim);
}

void galerkin_dilatation_facets_update (galerkin *g, int all)
{
    galerkin_dilatation *d = g->dilatation;
    const pg_family *f = &d->facet_family;
    for (size_t q = 0; q < f->n; q++) {
        if (f->start[q + 1] == f->start[q]) continue;
        fill (g, q);                                   /* its own N may have changed too                                 */
        if (all || !d->mark[g->problem->patches->of[d->home[q]]]) continue;
        for (size_t e = f->start[q]; e < f->start[q + 1]; e++) g->stale[f->node[e]] = 1;
    }
}

const pg_family *galerkin_dilatation_facet_family (const galerkin *g) { return &g->dilatation->facet_family; }

/* lambda n_k of facet point q, Pa */
static double factor (const galerkin *g, size_t q, int k)
{
    const pg_patches *p = g->problem->patches;
    long home = g->dilatation->home[q];
    return home < 0 ? 0 : p->lambda[g->material[g->bulk][home]] * g->problem->facet_normal[q * (size_t) g->dim + (size_t) k];
}

void galerkin_dilatation_facet_blocks (void *context, size_t q, size_t a, size_t m, double *out)
{
    const galerkin *g = context;
    const galerkin_dilatation *d = g->dilatation;
    size_t dim = (size_t) g->dim, first = d->facet_family.start[q];
    const double *N = d->facet_N + first, *G = d->facet_g + first * dim;
    for (size_t i = g->pin_start[q]; i < g->pin_start[q + 1]; i++) {
        size_t k = (size_t) g->pin[i].component;
        double w = g->rows[PG_FACETS].weight[q] * factor (g, q, g->pin[i].component);
        for (size_t b = 0; b < m; b++)
            for (size_t c = 0; c < dim; c++) {
                out[(b * dim + k) * dim + c] -= w * N[a] * G[b * dim + c];
                out[(b * dim + c) * dim + k] -= w * G[a * dim + c] * N[b];
            }
    }
}

double galerkin_dilatation_traction (const galerkin *g, size_t q, int k, const double *x)
{
    const galerkin_dilatation *d = g->dilatation;
    size_t dim = (size_t) g->dim;
    double sum = 0;
    if (!d) return 0;
    for (size_t e = d->facet_family.start[q]; e < d->facet_family.start[q + 1]; e++)
        for (size_t c = 0; c < dim; c++) sum += d->facet_g[e * dim + c] * x[(size_t) d->facet_family.node[e] * dim + c];
    return factor (g, q, k) * sum;
}

void galerkin_dilatation_spread (const galerkin *g, size_t q, int k, double share, double *f)
{
    const galerkin_dilatation *d = g->dilatation;
    size_t dim = (size_t) g->dim;
    if (!d) return;
    share *= factor (g, q, k);
    for (size_t e = d->facet_family.start[q]; e < d->facet_family.start[q + 1]; e++)
        for (size_t c = 0; c < dim; c++) f[(size_t) d->facet_family.node[e] * dim + c] += share * d->facet_g[e * dim + c];
}
