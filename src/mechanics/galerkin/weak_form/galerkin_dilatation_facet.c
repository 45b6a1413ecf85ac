/* SPDX-License-Identifier: GPL-3.0-or-later
 * Nitsche's terms with a projected dilatation. The traction on a supported facet contains the pressure of
 * the patch behind it, whose polynomials are continued to the facet. With gap = u - prescribed and c_m = int
 * psi_m n . gap over the supported facets of a patch,
 * (lambda / 2) sum_m [ (g_m . d)^2 - 2 (g_m . d) c_m + (1 + factor) c_m^2 ] = (lambda / 2) sum_m [ (g_m . d
 * - c_m)^2 + factor c_m^2 ]: the energy of the patch, the work of its pressure on the gap, and the flux
 * through the gap, with Nitsche's factor. Only the few numbers c_m are weighted by lambda; the usual term on
 * every point of a facet can stay in units of E. In units of lambda it would hold these points so stiffly
 * that the support locks (a cantilever at 0.4999 was then 1.8 % too stiff, against 0.05 % so). */
#include "galerkin_dilatation.h"
#include "perigal/vector.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* ---- patches behind facets ----------------------------------------------------------------------------- */
/* Does evaluation point p belong to a patch? */
static int is_covered (const pg_patches *q, size_t p) { return q->start[p + 1] > q->start[p]; }

/* Finds the evaluation point whose patch is continued to each facet point: the nearest one of the cell behind
 * it that belongs to a patch, else the nearest of all; with nodal integration, whose points lie in no cell,
 * always the latter. -1: that one belongs to no patch. */
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
            double d = pg_distance2 (g->dim, r->x + f * dim, b->x + q * dim);
            if (is_covered (p->form.patches, q) && d < best) best = d, home = (long) q;
        }
        if (home < 0) home = pg_nearest_find (grid, r->x + f * dim, NULL, NULL);
        g->dilatation->home[f] = is_covered (p->form.patches, (size_t) home) ? home : -1;
    }
done:
    pg_nearest_free (&grid);
    pg_free (first);
    return status;
}

/* The entries of the patches behind a facet point; returns their number, 0: none, or it is not supported. */
static size_t behind (const galerkin *g, size_t f, const size_t **entry)
{
    const pg_patches *q = g->problem->form.patches;
    long home = g->dilatation->home[f];
    if (g->supports.nitsche_start[f + 1] == g->supports.nitsche_start[f] || home < 0) return 0;
    *entry = q->entry + q->start[home];
    return q->start[home + 1] - q->start[home];
}

/* Lists the supported facet points of every patch, in compressed rows. */
static pg_status sort_facets (galerkin *g)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_patches *q = g->problem->form.patches;
    const size_t *entry = NULL;
    size_t n = q->n, *next = NULL;
    PG_ALLOC (d->facet_start, n + 1);
    PG_ALLOC (next, n);
    for (size_t f = 0; f < g->rows[PG_FACETS].n; f++)
        for (size_t k = behind (g, f, &entry); k-- > 0;) d->facet_start[q->of[entry[k]] + 1]++;
    for (size_t c = 0; c < n; c++) d->facet_start[c + 1] += d->facet_start[c], next[c] = d->facet_start[c];
    PG_ALLOC (d->facet, d->facet_start[n]);
    PG_ALLOC (d->facet_entry, d->facet_start[n]);
    for (size_t f = 0; f < g->rows[PG_FACETS].n; f++)
        for (size_t k = behind (g, f, &entry); k-- > 0;) {
            size_t at = next[q->of[entry[k]]]++;
            d->facet[at] = f, d->facet_entry[at] = entry[k];
        }
done:
    pg_free (next);
    return status;
}

/* Appends the nodes of family `at` of f that are not yet stamped with c. */
static pg_status add_nodes (galerkin_dilatation *d, const pg_family *f, size_t at, int c, size_t *cap,
                            size_t *n)
{
    pg_status status = PG_OK;
    PG_GROW (d->family.node, *cap, *n + f->start[at + 1] - f->start[at]);
    for (size_t e = f->start[at]; e < f->start[at + 1]; e++) {
        if (d->stamp[f->node[e]] == c) continue;
        d->stamp[f->node[e]] = c;
        d->family.node[(*n)++] = f->node[e];
    }
done:
    return status;
}

/* Makes the lists of nodes of each patch and of its supported facet points, ascending: rows g and s share one
 * list. */
static pg_status unite (galerkin *g)
{
    pg_status status = PG_OK;
    galerkin_dilatation *d = g->dilatation;
    const pg_patches *p = g->problem->form.patches;
    size_t cap = 0, n = 0;
    PG_ALLOC (d->family.start, p->n + 1);
    d->family.n = p->n;
    for (size_t i = 0; i < g->n; i++) d->stamp[i] = -1;
    for (size_t c = 0; c < p->n; c++) {
        PG_TRY (add_nodes (d, &p->family, c, (int) c, &cap, &n));
        for (size_t i = d->facet_start[c]; i < d->facet_start[c + 1]; i++)
            PG_TRY (add_nodes (d, &g->rows[PG_FACETS].family, d->facet[i], (int) c, &cap, &n));
        pg_sort (d->family.node + d->family.start[c], n - d->family.start[c], sizeof (int),
                 pg_ascending_ints);
        d->family.start[c + 1] = n;
    }
done:
    return status;
}

/* Prepares the facets; called when the patches and the points of supports are known. */
pg_status galerkin_dilatation_facets_create (galerkin *g)
{
    pg_status status = PG_OK;
    PG_TRY (find_homes (g));
    PG_TRY (sort_facets (g));
    PG_TRY (unite (g));
done:
    return status;
}

void galerkin_dilatation_facets_free (galerkin *g)
{
    galerkin_dilatation *d = g->dilatation;
    pg_free (d->home), pg_free (d->facet_start), pg_free (d->facet), pg_free (d->facet_entry);
    pg_family_clear (&d->family);
}

/* ---- rows ---------------------------------------------------------------------------------------------- */
/* Component k of the outward normal at a facet point. */
static double normal (const galerkin *g, size_t f, int k)
{
    return g->problem->bonds.facet_normal[f * (size_t) g->dim + (size_t) k];
}

/* Computes s_m = int psi_m n_k N over the supported facet points of part k of patch c, on the nodes of the
 * patch, for the prescribed components only, so that s_m . d - (prescribed part) is c_m. */
void galerkin_dilatation_facet_rows (const galerkin *g, size_t c, int k, galerkin_part *a)
{
    const galerkin_dilatation *d = g->dilatation;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim, first = d->family.start[c], m = d->family.start[c + 1] - first;
    const int *node = d->family.node + first;
    double psi[4];
    if (!a->s) return;
    memset (a->s, 0, (size_t) a->terms * m * dim * sizeof *a->s);
    for (size_t i = d->facet_start[c]; i < d->facet_start[c + 1]; i++) {
        size_t f = d->facet[i], at = 0;
        double weight = r->weight[f] * g->problem->form.patches->share[d->facet_entry[i]];
        if (d->part_of[d->facet_entry[i]] != k) continue;
        galerkin_dilatation_polynomials (g, a, r->x + f * dim, psi);
        for (size_t e = r->family.start[f]; e < r->family.start[f + 1]; e++, at++) {
            while (node[at] != r->family.node[e]) at++;
            for (size_t q = g->supports.nitsche_start[f]; q < g->supports.nitsche_start[f + 1]; q++)
                for (int t = 0; t < a->terms; t++)
                    a->s[((size_t) t * m + at) * dim + (size_t) g->supports.nitsche[q].component] +=
                        weight * psi[t] * normal (g, f, g->supports.nitsche[q].component) * r->N[e];
        }
    }
}

/* ---- gaps ---------------------------------------------------------------------------------------------- */
/* The part of a patch that entry i belongs to; NULL: none. */
static galerkin_part *part_of (const galerkin *g, size_t i)
{
    const galerkin_dilatation *d = g->dilatation;
    return d->part_of[i] < 0 ? NULL : &d->patch[g->problem->form.patches->of[i]].part[d->part_of[i]];
}

/* Lame's first parameter of the patch behind facet point f, Pa. */
static double lambda_behind (const galerkin *g, size_t f)
{
    return g->problem->form.patches->lambda[g->material[g->bulk][g->dilatation->home[f]]];
}

/* Computes c_m of all parts at time t from the displacements measured at facet points: sum w psi_m n_k (u_k -
 * prescribed). */
void galerkin_dilatation_gaps (galerkin *g, double t)
{
    galerkin_dilatation *d = g->dilatation;
    const pg_rows *r = &g->rows[PG_FACETS];
    size_t dim = (size_t) g->dim;
    const size_t *entry = NULL;
    double psi[4];
    for (size_t c = 0; d && c < g->problem->form.patches->n; c++)
        for (size_t k = 0; k < d->patch[c].n; k++)
            memset (d->patch[c].part[k].gap, 0, sizeof d->patch[c].part[k].gap);
    for (size_t i = 0; d && i < g->supports.nnitsche; i++) {
        const constraint *q = &g->supports.nitsche[i];
        double gap = g->measured.u[PG_FACETS][q->point * dim + (size_t) q->component]
                     - galerkin_prescribed (g, q, PG_FACETS, t);
        for (size_t k = behind (g, q->point, &entry); k-- > 0;) {
            galerkin_part *a = part_of (g, entry[k]);
            if (!a) continue;
            galerkin_dilatation_polynomials (g, a, r->x + q->point * dim, psi);
            for (int m = 0; m < a->terms; m++)
                a->gap[m] += r->weight[q->point] * g->problem->form.patches->share[entry[k]] * psi[m]
                             * normal (g, q->point, q->component) * gap;
        }
    }
}

/* Contribution of the patch to the traction of one constraint, Pa: -(1 + factor) lambda n_k sum_m psi_m
 * c_m. */
double galerkin_dilatation_traction (const galerkin *g, const constraint *q)
{
    const size_t *entry = NULL;
    double psi[4], sum = 0;
    size_t n = g->dilatation ? behind (g, q->point, &entry) : 0;
    for (size_t k = 0; k < n; k++) {
        const galerkin_part *a = part_of (g, entry[k]);
        if (!a) continue;
        galerkin_dilatation_polynomials (g, a, g->rows[PG_FACETS].x + q->point * (size_t) g->dim, psi);
        for (int m = 0; m < a->terms; m++)
            sum += g->problem->form.patches->share[entry[k]] * psi[m] * a->gap[m];
    }
    if (n == 0) return 0;
    return -(1 + g->options->nitsche) * lambda_behind (g, q->point) * normal (g, q->point, q->component)
           * sum;
}

/* f += lambda sum_m c_m g_m, N: the work of the pressure's variation on the gap, which makes the terms
 * symmetric. */
void galerkin_dilatation_adjoint (const galerkin *g, double *f)
{
    const galerkin_dilatation *d = g->dilatation;
    size_t dim = (size_t) g->dim;
    for (size_t c = 0; d && c < g->problem->form.patches->n; c++) {
        if (d->facet_start[c + 1] == d->facet_start[c]) continue;
        double lambda = lambda_behind (g, d->facet[d->facet_start[c]]);
        for (size_t k = 0; k < d->patch[c].n; k++) {
            const galerkin_part *a = &d->patch[c].part[k];
            const double *row = a->g;
            for (int t = 0; t < a->terms; t++)
                for (size_t e = d->family.start[c]; e < d->family.start[c + 1]; e++, row += dim)
                    for (size_t s = 0; s < dim; s++)
                        f[(size_t) d->family.node[e] * dim + s] += lambda * a->gap[t] * row[s];
        }
    }
}
