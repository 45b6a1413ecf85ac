/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields at the nodes, from the nodal shape functions. */
#include "mechanics/galerkin/weak_form/galerkin.h"
#include <string.h>

/* Counts the bonds that end at each node (node-node and point-node) on the first call. Bonds of zero length
 * do not count. */
static pg_status count_ends (galerkin *g)
{
    pg_status status = PG_OK;
    if (g->ends) return PG_OK;
    PG_ALLOC (g->ends, g->n);
    for (int set = PG_NODES; set <= PG_POINTS; set++) {
        const pg_family *f = &g->rows[set].family;
        for (size_t p = 0; p < f->n; p++)
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++)
                g->ends[f->node[e]] += !pg_problem_no_bond (g->problem, set, p, e);
    }
done:
    return status;
}

/* Share of broken bonds among all that end at a node. A memchr over its flags skips points without broken
 * bonds. */
static pg_status damage (galerkin *g, const pg_state *state, double *value)
{
    pg_status status = PG_OK;
    PG_TRY (count_ends (g));
    memset (value, 0, g->n * sizeof *value);
    for (int set = PG_NODES; set <= PG_POINTS; set++) {
        const pg_family *f = &g->rows[set].family;
        const unsigned char *alive = state->alive + g->problem->bonds.first[set];
        for (size_t p = 0; p < f->n; p++) {
            size_t first = f->start[p], last = f->start[p + 1];
            const unsigned char *dead = memchr (alive + first, 0, last - first);
            for (size_t e = dead ? (size_t) (dead - alive) : last; e < last; e++)
                if (!alive[e] && !pg_problem_no_bond (g->problem, set, p, e)) value[f->node[e]]++;
        }
    }
    for (size_t i = 0; i < g->n; i++) value[i] = g->ends[i] > 0 ? value[i] / g->ends[i] : 0;
done:
    return status;
}

/* u = sum N_j d_j at the nodes. */
static void displacement (const galerkin *g, const double *d, double *u)
{
    const pg_rows *r = &g->rows[PG_NODES];
    size_t dim = (size_t) g->dim;
    memset (u, 0, g->n * dim * sizeof *u);
    for (size_t p = 0; p < g->n; p++)
        for (size_t e = r->family.start[p]; e < r->family.start[p + 1]; e++)
            for (size_t c = 0; c < dim; c++)
                u[p * dim + c] += r->N[e + pg_rows_offset (r, p)] * d[(size_t) r->family.node[e] * dim + c];
}

void galerkin_at_nodes (void *self, const double *x, double *u) { displacement (self, x, u); }

void galerkin_from_nodes (void *self, const double *F, double *f)
{
    const galerkin *g = self;
    const pg_rows *r = &g->rows[PG_NODES];
    size_t dim = (size_t) g->dim;
    for (size_t p = 0; p < g->n; p++) {
        int any = 0;
        for (size_t c = 0; c < dim; c++) any |= F[p * dim + c] != 0;
        for (size_t e = r->family.start[p]; any && e < r->family.start[p + 1]; e++)
            for (size_t c = 0; c < dim; c++)
                f[(size_t) r->family.node[e] * dim + c] += r->N[e + pg_rows_offset (r, p)] * F[p * dim + c];
    }
}

/* A field of results by name; value: n x components. Displacement and velocity are interpolated by the shape
 * functions; their coefficients are the field "coefficient". *components = 0: the name is unknown here. */
pg_status galerkin_field (void *self, const pg_state *state, const double *d, const char *name,
                          int *components, const char **unit, double *value)
{
    pg_status status = PG_OK;
    galerkin *g = self;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    *components = 0, *unit = "";
    if (strcmp (name, "damage") == 0) {
        *components = 1;
        return damage (g, state, value);
    }
    if (strcmp (name, "coefficient") == 0) {
        *components = g->dim, *unit = "m";
        memcpy (value, d, g->n * dim * sizeof *value);
        return PG_OK;
    }
    /* called before the first step: nothing has been evaluated yet */
    if (!g->rows[PG_NODES].N) PG_TRY (galerkin_refresh (self, state, NULL));
    if (strcmp (name, "error_estimate") == 0) {
        pg_estimate sums;
        *components = 1, *unit = "Pa";
        return galerkin_estimate (g, d, &sums, value);
    }
    if (strcmp (name, "nodal_force") == 0) {
        *components = g->dim, *unit = "N";
        galerkin_eigen_at (g, state->time);
        galerkin_measure (g, g->bulk, d);
        memset (value, 0, g->n * dim * sizeof *value);
        galerkin_bulk_force (g, d, value);
    } else if (strcmp (name, "displacement") == 0 || strcmp (name, "velocity") == 0) {
        *components = g->dim, *unit = *name == 'd' ? "m" : "m/s";
        displacement (g, *name == 'd' ? d : state->v, value);
    } else if (strcmp (name, "strain") == 0 || strcmp (name, "stress") == 0) {
        *components = g->nv, *unit = strcmp (name, "stress") == 0 ? "Pa" : "";
        galerkin_eigen_at (g, state->time);
        galerkin_measure (g, PG_NODES, d);
        memcpy (value, **unit ? g->measured.stress[PG_NODES] : g->measured.strain[PG_NODES],
                g->n * nv * sizeof *value);
    }
done:
    return status;
}
