/* SPDX-License-Identifier: GPL-3.0-or-later
 * Ordinary state-based peridynamics, the linear peridynamic solid (Silling et al. 2007; theory B6), in 2D
 * and 3D and for any Poisson's ratio. */
#include "state_based.h"
#include <stdio.h>
#include <string.h>

/* Sets the moduli A (dilatation) and B (deviation), Pa, of every point from its material. */
static pg_status create (bond_force *b)
{
    pg_status status = PG_OK;
    const pg_problem *p = b->problem;
    PG_TRY (dilatation_create (b));
    for (size_t i = 0; i < b->n; i++) {
        const pg_material *m = pg_problem_law (p, PG_NODES, i);
        pg_state_moduli (p->mode, m->modulus, m->nu, &b->dilatation->A[i], &b->dilatation->B[i]);
    }
done:
    return status;
}

/* Blocks of a pair force that is at least as stiff: the true blocks would couple neighbours of neighbours. */
static void blocks (const bond_force *b, size_t i, const point_bonds *s, size_t e, double *own, double *other)
{
    const double *stiff = b->dilatation->stiff;
    size_t size = (size_t) (b->dim * b->dim) * sizeof *own;
    double spare[9];
    memset (own, 0, size), memset (other ? other : spare, 0, size);
    dilatation_pull (b, i, s, e, stiff[i] + stiff[s->node[e]], own, other ? other : spare);
}

/* Writes the moduli of material m. */
static void words (const bond_force *b, size_t m, char *text, size_t size)
{
    const pg_problem *p = b->problem;
    const pg_sum_rule *rule = &p->sums->rule;
    const pg_material *a = &p->material[m];
    double E = a->modulus, nu = a->nu, A, B, d = p->dim;
    pg_state_moduli (p->mode, E, nu, &A, &B);
    snprintf (text, size,
              "%s%s%slinear peridynamic solid, bulk modulus %.6g Pa%s, shear modulus %.6g Pa; weighted "
              "volumes of %s",
              p->nmaterial > 1 ? "material " : "", p->nmaterial > 1 ? a->name : "",
              p->nmaterial > 1 ? ": " : "", (A + B / d) / d, p->dim == 2 ? " (of the plane)" : "",
              B / (d * (d + 2)), rule->follow ? "the bonds that live" : "the bonds of the start");
}

static const bond_theory theory = { .size = sizeof (state_based),
                                     .create = create,
                                     .free = dilatation_free,
                                     .blocks = blocks,
                                     .virial = dilatation_virial,
                                     .find_dying = dilatation_dying,
                                     .words = words };

/* pg_force_type.create */
pg_status state_based_create (void **self, const pg_problem *problem)
{
    return bond_force_make (self, problem, &theory);
}
