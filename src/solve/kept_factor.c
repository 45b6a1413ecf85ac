/* SPDX-License-Identifier: GPL-3.0-or-later
 * A factor of k K + m M that serves on while bonds break.
 *
 * It preconditions conjugate gradients on the matrix of now. In motion it is the base of an event solver
 * besides (event_solver.h, without load cases): what breaking has changed since the factor was made is
 * W (k D) W' on the t touched unknowns, so that with A the matrix of the factor and H = W' A^-1 W
 *
 *     (A + W k D W')^-1 r = z - A^-1 W (1 + k D H)^-1 k D W' z,    z = A^-1 r        (Woodbury's identity)
 *
 * preconditions exactly up to rounding, and one iteration does instead of one for about every number that
 * breaking has changed in the spectrum. Whatever it is, the iterations measure by K itself: what cannot be
 * followed (too many unknowns, other constraints) costs iterations and no digit. */
#include "event_solver.h"

/* Follows what breaks from here on, where the force can tell. The factor has just been made. */
pg_status system_follow (pg_system *s, const dynamics *dyn)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    if (!dyn || !s->problem->criterion->type) return PG_OK;
    if (!u->following) PG_TRY (event_solver_create (&u->following, s, 0, NULL));
    if (u->following) PG_TRY (event_solver_follow (u->following, dyn->k, dyn->m));
    ways_note_factor (s);
done:
    return status;
}

/* Takes in what the last refresh has changed. Where that makes another factor worth its cost, the next solve
 * makes one; so it does where a base that has served can follow no further. */
pg_status system_note_change (pg_system *s)
{
    system_updates *u = &s->updates;
    pg_status status = PG_OK;
    event_outcome outcome;
    if (!u->following || !event_solver_has_base (u->following)) return PG_OK;
    int served = event_solver_touched (u->following) > 0;
    PG_TRY (event_solver_note (u->following, &outcome));
    if (outcome == EVENT_DUE || (outcome == EVENT_LOST && served)) s->choice.extra_cost = 1e300;
done:
    return status;
}

/* z = the inverse of the factored matrix, or of the one of now, times r. */
pg_status system_apply_factor (pg_system *s, const double *r, double *z)
{
    if (s->updates.following && event_solver_has_base (s->updates.following))
        return event_solver_correct (s->updates.following, r, z);
    return s->direct.linear->solve (s->direct.factor, 1, r, z);
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
        PG_TRY (system_follow (s, dyn));
        c->extra_cost = 0;
    }
    c->spared += s->direct.stale;
    pg_status now = system_iterate (s, dyn, BY_FACTOR, tolerance, 200, &used);
    if (used > 2) c->extra_cost += (double) (used - 2) * (system_solve_cost (s) + system_apply_cost (s));
    if (now == PG_OK) return PG_OK;
    if (now != PG_E_EQUILIBRIUM && now != PG_E_NOT_SPD) PG_TRY (now);
    s->direct.stale = 1, c->extra_cost = 0;
    status = system_solve_by_factor (s, dyn);
done:
    return status;
}
