/* SPDX-License-Identifier: GPL-3.0-or-later
 * A factor of k K + m M that is kept while bonds break.
 *
 * It preconditions conjugate gradients on the present matrix. In dynamics it is also the base of an inverse
 * (inverse.h), which includes what breaking has changed of K since the factor was made: an exact
 * preconditioner up to rounding, so that one iteration suffices instead of one for about every eigenvalue
 * that breaking has changed. In any case the iterations measure by K itself: what cannot be followed (too
 * many unknowns, other constraints) costs iterations and no digit. */
#include "inverse.h"
#include <string.h>

/* Makes the factor that has just been made the base of an inverse that follows breaking (dynamics). */
static pg_status follow (pg_system *s, const dynamics *dyn)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    if (!dyn || !s->problem->criterion->type) return PG_OK;
    if (!u->following) PG_TRY (inverse_create (&u->following, s, INVERSE_HALVES));
    if (u->following) PG_TRY (inverse_renew (u->following, dyn->k, dyn->m, 0));
    ways_note_factor (s);
done:
    return status;
}

/* Updates the inverse by what the last refresh has changed. The next solve makes a new factor where that has
 * become worth its cost, or where a base that was in use cannot be updated any more. */
pg_status system_note_change (pg_system *s)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    inverse_outcome outcome;
    if (!u->following || !inverse_has_base (u->following)) return PG_OK;
    int served = u->following->touched.t > 0;
    PG_TRY (inverse_take (u->following, &outcome));
    if (outcome == INVERSE_LOST ? served : outcome == INVERSE_TAKEN && inverse_is_due (u->following))
        s->choice.extra_cost = 1e300;
done:
    return status;
}

/* Preconditioner: z = inverse of the factored matrix, or of the present one if it is followed, times r. */
static pg_status apply_factor (void *context, const double *r, double *z)
{
    pg_system *s = context;
    if (s->updates.following && inverse_has_base (s->updates.following))
        return inverse_solve (s->updates.following, r, z);
    return s->direct.linear->solve (s->direct.factor, 1, r, z);
}

/* A factor that costs more than this many of its solves is worth keeping when K has changed a little. */
static const double worth_keeping = 15;

/* Factors the matrix where K has changed, then makes two triangular solves. A factor that is expensive
 * compared with its solves is kept as a preconditioner from then on, as a few broken bonds change K
 * little. */
pg_status system_solve_by_factor (pg_system *s, const dynamics *dyn)
{
    system_factor *f = &s->direct;
    pg_status status = PG_OK;
    if (f->stale) PG_TRY (system_factorize (s, dyn));
    double t0 = pg_seconds ();
    pg_linear_info info;
    PG_TRY (f->linear->solve (f->factor, 1, s->balance.reduced, s->balance.delta));
    f->linear->info (f->factor, &info);
    s->report->linear.cg_iterations += info.iterations - s->iterative.matrix_iterations;
    s->iterative.matrix_iterations = info.iterations;
    s->report->seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    int keep = system_operator (s) && strcmp (s->options->linear, "auto") == 0 && !f->indefinite
               && f->unshifted;
    if (keep && !f->props.n
        && system_factor_cost (s) > worth_keeping * system_solve_cost (s)) {
        s->choice.mode = SYSTEM_KEPT_FACTOR;
        PG_TRY (follow (s, dyn));
    }
done:
    return status;
}

/* The factor of an earlier K preconditions conjugate gradients. It is renewed when the iterations beyond
 * two that it has cost would have paid for a new one (the rule of rent or buy, at most twice the best
 * possible cost); where iterations fail, at once. */
pg_status system_solve_by_kept_factor (pg_system *s, const dynamics *dyn, double tolerance)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    size_t used = 0;
    if (s->direct.stale && c->extra_cost > system_factor_cost (s)) {
        PG_TRY (system_factorize (s, dyn));
        PG_TRY (follow (s, dyn));
        c->extra_cost = 0;
    }
    c->spared += s->direct.stale;
    pg_preconditioner P = { s, apply_factor, s->problem->threads };
    pg_status now = system_iterate (s, dyn, &P, tolerance, 200, &used);
    if (used > 2) c->extra_cost += (double) (used - 2) * (system_solve_cost (s) + system_apply_cost (s));
    if (now == PG_OK) return PG_OK;
    if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) PG_TRY (now);
    s->direct.stale = 1, c->extra_cost = 0;
    status = system_solve_by_factor (s, dyn);
done:
    return status;
}
