/* SPDX-License-Identifier: GPL-3.0-or-later
 * How systems are solved: by a factor of K or by conjugate gradients, chosen once by counted cost. All costs
 * are seconds by stored rates, from numbers of bonds, points and unknowns (model/solve_costs.c); never
 * measured, as a run must not depend on the clock. */
#include "contact.h"
#include "solve.h"
#include <math.h>
#include <string.h>

/* Seconds of one product K x: visits of bonds times a stored rate, by stencil, list or shape functions. */
double system_apply_cost (const pg_system *s)
{
    const pg_problem *p = s->problem;
    if (p->sums) return (p->sums->stencil.n ? 0.6e-9 : 3e-9) * (double) p->first_bond[PG_BOND_SETS];
    return pg_solve_apply_rate
           * (double) (p->first_bond[PG_BOND_SETS]
                       - (p->integration->at_nodes ? 0 : p->first_bond[PG_POINTS]));
}

double system_assembly_cost (const pg_system *s)
{
    pg_solve_counts c = pg_solve_count (s->problem);
    return pg_solve_assembly_cost (&c);
}

/* Assembly, analysis, factor. */
double system_direct_cost (const pg_system *s)
{
    pg_solve_counts c = pg_solve_count (s->problem);
    return pg_solve_direct_cost (&c);
}

/* ---- the choice ---------------------------------------------------------------------------------------- */
/* Would conjugate gradients with sums over bonds be cheaper than a factor? By measured rates
 * (pg_method_iterates); can: the multilevel preconditioner is at hand. */
static int by_bond_loops (const pg_system *s, int can)
{
    const pg_problem *p = s->problem;
    return p->sums && (can || p->sums->stencil.n)
           && pg_method_iterates (p->method, can, p->dim, (double) s->ndof);
}

/* Would conjugate gradients with finite elements be cheaper than a factor (pg_solve_by_elements)? Without
 * elements they are taken where no memory holds the factor. In the plane factors are cheap. */
static int by_elements (const pg_system *s, int can)
{
    if (s->problem->sums) return 0;
    pg_solve_counts c = pg_solve_count (s->problem);
    c.columns = contact_columns (s);
    return pg_solve_by_elements (&c, can && s->force->spares.elements, s->updates.serves, 0);
}

/* solver.linear says it, a force without a matrix leaves no choice, and in a small time step the mass
 * dominates: then a few iterations without any factor do, which is simply tried. */
pg_status system_choose (pg_system *s, const dynamics *dyn)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    int can, operates = s->force->operator_ && s->force->operator_ (s->self);
    int automatic = strcmp (s->options->linear, "auto") == 0 && operates;
    PG_TRY (system_can_precondition (s, dyn, &can));
    if (!can && strcmp (s->options->preconditioner, "multilevel") == 0)
        pg_statistics_warn (s->report, "preconditioner: multilevel needs a body at rest and a force that "
                                       "tells the rows of K, with supports on points: the diagonal instead "
                                       "where there is no factor");
    c->mode = SYSTEM_FACTOR;
    if (!system_has_matrix (s) || (!s->direct.linear->factors && operates))
        c->mode = dyn && can ? SYSTEM_TRIAL : SYSTEM_NO_FACTOR;
    else if (automatic && dyn) c->mode = SYSTEM_TRIAL;
    else if (automatic && (by_bond_loops (s, can) || by_elements (s, can))) {
        c->mode = SYSTEM_NO_FACTOR;
        pg_statistics_skip (s->report, NAN, "stiffness matrix, analysis and factorization",
                            s->problem->sums ? "so many points: conjugate gradients with sums over the bonds "
                                               "are cheaper by stored rates"
                                             : "so many points: conjugate gradients are cheaper by stored "
                                               "rates");
    }
done:
    return status;
}
