/* SPDX-License-Identifier: GPL-3.0-or-later
 * How linear systems are solved: by a factor of K or by conjugate gradients, chosen once by counted cost
 * (system_matrix.c), by a trial in dynamics, and changed where another method would have paid; one solve by
 * that method. */
#include "solve/run/solve.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

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
 * elements they are used where memory cannot hold the factor. In 2D factors are cheap. */
static int by_elements (const pg_system *s, int can)
{
    if (s->problem->sums) return 0;
    pg_solve_counts c = pg_solve_count (s->problem);
    c.columns = s->choice.columns;
    return pg_solve_by_elements (&c, can && s->force->spares.elements, s->updates.serves, 0);
}

/* Chooses the method: solver.linear decides, or a force without a matrix leaves no choice. In a small time
 * step the mass dominates, and a few iterations without any factor may do, which is tried. */
static pg_status choose (pg_system *s, const dynamics *dyn)
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

/* ---- one solve ----------------------------------------------------------------------------------------- */
enum { FEW_ITERATIONS = 40 };

/* Reports that the factorization was skipped, and why. */
static void tell_small_step (pg_system *s, size_t used)
{
    char why[160];
    snprintf (why, sizeof why,
              "the time step is small, so that the mass dominates: %zu iterations of conjugate gradients did "
              "in the first step",
              used);
    pg_statistics_skip (s->report, NAN, "stiffness matrix, analysis and factorization", why);
}

/* Iterations by the diagonal where the better preconditioner failed: probably a loaded part has come loose.
 * Small bodies have as many as they could need, for so many seconds. */
enum { LAST_TRY = 2000 };
static const double LAST_SECONDS = 3;
/* no factor is made as a fallback if it takes longer, s */
static const double MOST_SECONDS = 600;

/* Iterations with finite elements have failed: from now on a factor, where it can be had at all (returns
 * 1). */
static int falls_back (pg_system *s)
{
    if (!s->force->spares.elements || !system_has_matrix (s) || strcmp (s->options->linear, "auto") != 0
        || system_direct_cost (s) > MOST_SECONDS)
        return 0;
    pg_statistics_warn (s->report, "the iterations with finite elements as preconditioner do not converge: a "
                                   "factor of K from step %ld on", s->report->steps);
    system_forget_preconditioner (s);
    s->choice.mode = SYSTEM_FACTOR, s->direct.stale = 1, s->report->linear.preconditioner[0] = 0;
    memset (s->balance.delta, 0, s->nred * sizeof *s->balance.delta);
    return 1;
}

/* Chooses after the trial. did 1: the diagonal sufficed and stays (until it has cost more, leave_diagonal).
 * Else large solids take finite elements, as in statics, and so does a force without a matrix. */
static pg_status after_trial (pg_system *s, const dynamics *dyn, int did)
{
    pg_status status = PG_OK;
    int can, factors = system_can_factor (s);
    PG_TRY (system_can_precondition (s, dyn, &can));
    pg_solve_counts c = pg_solve_count (s->problem);
    s->choice.mode = did ? (can ? SYSTEM_DIAGONAL : SYSTEM_NO_FACTOR)
                     : can && (!factors || pg_solve_by_elements (&c, 1, 0, 1)) ? SYSTEM_NO_FACTOR
                                                                                : SYSTEM_FACTOR;
done:
    return status;
}

/* Leaves the diagonal where ranks share the body, counted in iterations: for a multilevel preconditioner,
 * when the iterations beyond a few would have paid for it. */
enum { SHARED_SET_UP = 150 };
static pg_status leave_for_shared (pg_system *s, const dynamics *dyn, size_t used)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    if (used > FEW_ITERATIONS) c->extra_cost += (double) (used - FEW_ITERATIONS);
    if (!can || c->extra_cost <= SHARED_SET_UP) goto done;
    c->mode = SYSTEM_NO_FACTOR, s->direct.stale = 1, c->extra_cost = 0;
done:
    return status;
}

/* Dynamics, the diagonal having sufficed in the first step. Breaking may change that: nodes with few
 * neighbours are light, rows of few bonds stiff. When the iterations beyond a few have cost as much as a
 * factor (rent or buy, counted), another method is taken for good. */
static pg_status leave_diagonal (pg_system *s, const dynamics *dyn, size_t used)
{
    pg_status status = PG_OK;
    if (dyn && system_is_shared (s)) return leave_for_shared (s, dyn, used);
    if (!dyn || strcmp (s->options->linear, "auto") != 0 || !system_can_factor (s) || s->problem->sums
        || s->options->plain)
        return PG_OK;
    if (used > FEW_ITERATIONS)
        s->choice.extra_cost += (double) (used - FEW_ITERATIONS) * system_apply_cost (s);
    if (s->choice.extra_cost <= system_direct_cost (s)) return PG_OK;
    PG_TRY (after_trial (s, dyn, 0));
    s->direct.stale = 1, s->choice.extra_cost = 0;
done:
    return status;
}

/* Conjugate gradients with the diagonal. */
static pg_status iterate_by_diagonal (pg_system *s, const dynamics *dyn, double tolerance, size_t limit,
                                      size_t *used)
{
    pg_status status = system_iterate (s, dyn, NULL, tolerance, limit, used);
    strcpy (s->report->linear.solver, "cg");
    if (!system_has_preconditioner (s)) strcpy (s->report->linear.preconditioner, "jacobi");
    return status;
}

/* Conjugate gradients with a preconditioner of several levels where it can be made, else with the diagonal.
 * Where the better one fails, the diagonal has a last, limited try: mostly a loaded part has come loose,
 * and nothing converges. */
static pg_status solve_without_factor (pg_system *s, const dynamics *dyn, double tolerance)
{
    pg_status status = PG_OK;
    size_t used = 0, limit = 20 * s->ndof + 1000;
    int can;
    PG_TRY (system_can_precondition (s, dyn, &can));
    can = can && s->choice.mode != SYSTEM_DIAGONAL;
    if (can) {
        pg_status now = system_iterate_preconditioned (s, dyn, tolerance);
        if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) return now;
        if (falls_back (s)) return PG_OK;
        limit = (size_t) fmin ((double) limit, fmax (LAST_TRY, LAST_SECONDS / system_apply_cost (s)));
    }
    PG_TRY (iterate_by_diagonal (s, dyn, tolerance, limit, &used));
    if (!can) PG_TRY (leave_diagonal (s, dyn, used));
done:
    return status;
}

/* Solves one linear system by the method that was chosen; a trial decides between iterations and a factor. */
pg_status system_solve_once (pg_system *s, const dynamics *dyn, double tolerance)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    size_t used = 0, before = s->report->linear.cg_iterations;
    if (c->mode == SYSTEM_UNDECIDED) PG_TRY (choose (s, dyn));
    PG_TRY (ways_choose (s, dyn));
    if (c->mode == SYSTEM_TRIAL) {
        pg_status now = iterate_by_diagonal (s, dyn, tolerance, FEW_ITERATIONS, &used);
        if (now != PG_OK && now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) PG_TRY (now);
        PG_TRY (after_trial (s, dyn, now == PG_OK));
        if (now == PG_OK) {
            tell_small_step (s, used);
            goto done;
        }
        memset (s->balance.delta, 0, s->nred * sizeof *s->balance.delta);
    }
    if (c->mode == SYSTEM_NO_FACTOR || c->mode == SYSTEM_DIAGONAL)
        PG_TRY (solve_without_factor (s, dyn, tolerance));
    if (c->mode == SYSTEM_KEPT_FACTOR) PG_TRY (system_solve_by_kept_factor (s, dyn, tolerance));
    else if (c->mode == SYSTEM_FACTOR) PG_TRY (system_solve_by_factor (s, dyn));
    if (dyn) ways_count (s, s->report->linear.cg_iterations - before);
done:
    s->report->linear.solves += status == PG_OK;
    return status;
}
