/* SPDX-License-Identifier: GPL-3.0-or-later
 * Fields at the nodes, from the nodal shape functions. */
#include "galerkin.h"
#include <string.h>

/* Share of dead bonds among all that end at a node, node-node and point-node; a bond of no length is
 * none. */
static void damage (const galerkin *g, const pg_state *state, double *value)
{
    double *all = g->work;
    memset (value, 0, g->n * sizeof *value);
    memset (all, 0, g->n * sizeof *all);
    for (int set = PG_NODES; set <= PG_POINTS; set++) {
        const pg_family *f = &g->rows[set].family;
        const unsigned char *alive = state->alive + g->problem->first_bond[set];
        for (size_t p = 0; p < f->n; p++)
            for (size_t e = f->start[p]; e < f->start[p + 1]; e++) {
                int j = f->node[e];
                if (pg_problem_no_bond (g->problem, set, p, e)) continue;
                all[j]++, value[j] += !alive[e];
            }
    }
    for (size_t i = 0; i < g->n; i++) value[i] = all[i] > 0 ? value[i] / all[i] : 0;
}

/* A field of results by name, value: n x components. Displacement and velocity are those that the shape
 * functions make, not their coefficients, which a field of its own shows; *components = 0: unknown here. */
pg_status galerkin_field (void *self, const pg_state *state, const double *d, const char *name,
                          int *components, const char **unit, double *value)
{
    galerkin *g = self;
    size_t dim = (size_t) g->dim, nv = (size_t) g->nv;
    *components = 0, *unit = "";
    if (strcmp (name, "damage") == 0) {
        *components = 1;
        damage (g, state, value);
        return PG_OK;
    }
    if (strcmp (name, "error_estimate") == 0) {
        pg_estimate sums;
        *components = 1, *unit = "Pa";
        return galerkin_estimate (g, d, &sums, value);
    }
    if (strcmp (name, "coefficient") == 0) {
        *components = g->dim, *unit = "m";
        memcpy (value, d, g->n * dim * sizeof *value);
        return PG_OK;
    }
    if (strcmp (name, "displacement") == 0 || strcmp (name, "velocity") == 0) {
        *components = g->dim, *unit = *name == 'd' ? "m" : "m/s";
        galerkin_measure (g, PG_NODES, *name == 'd' ? d : state->v);
        memcpy (value, g->u[PG_NODES], g->n * dim * sizeof *value);
    } else if (strcmp (name, "strain") == 0 || strcmp (name, "stress") == 0) {
        *components = g->nv, *unit = strcmp (name, "stress") == 0 ? "Pa" : "";
        galerkin_measure (g, PG_NODES, d);
        memcpy (value, **unit ? g->stress[PG_NODES] : g->strain[PG_NODES], g->n * nv * sizeof *value);
    }
    return PG_OK;
}
