/* SPDX-License-Identifier: GPL-3.0-or-later
 * Choice between a factor and finite elements, in dynamics with breaking bonds.
 *
 * While little breaks a factor of k K + m M is cheapest: one solve with it, corrected for what has
 * broken since (kept_factor.c). In a cascade, round after round of breaking, the correction costs more than
 * the solve: columns of the newly touched unknowns, a dense system that grows, and after some rounds another
 * factor. Conjugate gradients with finite elements as preconditioner (preconditioner.c) know no such cost: a
 * solve is some 45 products K x, whatever has broken.
 *
 * Which of both is the cheaper one is counted after every solve, by stored rates, of what was done, and of
 * what the other one would have done: iterations times their cost, or solves and the cost of a broken bond as
 * seen so far. The differences are summed up, never below zero: the regret. The method is changed when the
 * regret has reached the cost of the change (rent or buy: at most twice the cost of the best choice
 * afterwards): a set-up of the elements and a share of the factor that the return will cost, or that
 * factor. It depends on counts alone. */
#include "inverse.h"
#include <math.h>
#include <string.h>

/* Seconds of an iteration with finite elements, for each bond and each node: 3D bodies, shape functions
 * of which many are alike, one thread. Measured like the other rates of this file in data/cui_plate. */
static const double bond_rate = 1.3e-9, node_rate = 7e-7;
/* Assumed iterations of a solve before the first one; cost of a set-up, in iterations. */
enum { FIRST_GUESS = 45, SET_UP = 20 };
/* Share of a new factor's cost that a change to elements must be worth, as it will probably be needed again;
 * iterations of a solve by a factor that is corrected. */
static const double way_back = 0.25, corrected = 1.2;

/* *can 1: both a factor and finite elements can be used. Not in 2D, where factors are cheap. */
static pg_status both_ways (pg_system *s, const dynamics *dyn, int *can)
{
    pg_status status = PG_OK;
    *can = 0;
    if (!dyn || system_is_shared (s) || s->problem->dim < 3 || !s->force->spares.elements || s->options->plain
        || s->direct.indefinite
        || strcmp (s->options->linear, "auto") != 0)
        return PG_OK;
    PG_TRY (system_can_precondition (s, dyn, can));
done:
    return status;
}

/* Seconds of one solve with finite elements. */
static double elements_cost (const pg_system *s, double iterations)
{
    pg_solve_counts c = pg_solve_count (s->problem);
    return iterations * (bond_rate * c.bonds + node_rate * c.points);
}

static double factor_again (const pg_system *s) { return system_assembly_cost (s) + system_factor_cost (s); }

/* Seconds of one solve by a factor; about twice as many where it is corrected for broken bonds. */
static double factor_solve (const pg_system *s, int broken)
{
    return (broken ? 2 * corrected : 1) * system_solve_cost (s) + system_apply_cost (s);
}

/* Seconds that broken bonds have cost in corrections of the factor since the last call; with a share of the
 * next factor, as there is room for so many touched unknowns only. */
static double breaking_cost (pg_system *s)
{
    system_updates *u = &s->updates;
    pg_ways *w = &s->choice.ways;
    int counts = u->following && inverse_has_base (u->following);
    double now = counts ? inverse_spent (u->following, factor_again (s)) : 0;
    double cost = now > w->spent ? now - w->spent : 0;
    w->spent = now;
    w->breaking += cost, w->bonds += w->fresh;
    return cost;
}

void ways_note_broken (pg_system *s, size_t count) { s->choice.ways.fresh += (double) count; }

/* Called when a factor was made: halves the sums from which the cost of a broken bond is estimated, so that
 * recent ones count most. */
void ways_note_factor (pg_system *s)
{
    s->choice.ways.spent = 0, s->choice.ways.breaking /= 2, s->choice.ways.bonds /= 2;
}

/* Changes to finite elements. The factor is kept for the return; its columns, some 16 KB for each unknown,
 * are not. */
static void to_elements (pg_system *s)
{
    system_choice *c = &s->choice;
    if (s->updates.following) inverse_forget (s->updates.following);
    inverse_free (&s->updates.following);
    c->mode = SYSTEM_NO_FACTOR, s->direct.stale = 1, c->extra_cost = 0;
    c->ways.meanwhile = 1, c->ways.regret = 0;
}

static void to_factor (pg_system *s)
{
    system_choice *c = &s->choice;
    system_forget_preconditioner (s);
    c->mode = SYSTEM_KEPT_FACTOR, s->direct.stale = 1, s->iterative.remake = 0;
    c->extra_cost = 1e300;  /* a factor of the present matrix before the next solve */
    c->ways.meanwhile = 0, c->ways.regret = 0;
}

/* Called before a solve: changes the method where the regret has become large enough. A factor that is about
 * to be made anew is not worth keeping. */
pg_status ways_choose (pg_system *s, const dynamics *dyn)
{
    system_choice *c = &s->choice;
    pg_status status = PG_OK;
    const pg_ways *w = &c->ways;
    int can;
    if (c->mode == SYSTEM_NO_FACTOR && w->meanwhile && w->regret > factor_again (s)) to_factor (s);
    if (c->mode != SYSTEM_KEPT_FACTOR || w->regret == 0) return PG_OK;
    PG_TRY (both_ways (s, dyn, &can));
    int due = s->direct.stale && c->extra_cost > system_factor_cost (s);
    if (can && w->regret > elements_cost (s, SET_UP) + (due ? 0 : way_back * factor_again (s)))
        to_elements (s);
done:
    return status;
}

/* Updates the regret after a solve that took so many iterations. */
void ways_count (pg_system *s, size_t iterations)
{
    pg_ways *w = &s->choice.ways;
    double used = (double) iterations, balance = 0;
    if (s->choice.mode == SYSTEM_KEPT_FACTOR && s->problem->dim > 2 && s->force->spares.elements) {
        int broken = s->updates.following && s->updates.following->touched.t > 0;
        balance = breaking_cost (s)
                  + used * ((broken ? 2 : 1) * system_solve_cost (s) + system_apply_cost (s))
                  - elements_cost (s, w->iterations > 0 ? w->iterations : FIRST_GUESS);
    } else if (s->choice.mode == SYSTEM_NO_FACTOR && w->meanwhile) {
        double bond = w->bonds > 0 ? w->breaking / w->bonds : 0;
        w->iterations = w->iterations > 0 ? 0.9 * w->iterations + 0.1 * used : used;
        balance = elements_cost (s, used) - factor_solve (s, w->fresh > 0) - bond * w->fresh;
        w->solves++;
    }
    w->regret = fmax (0, w->regret + balance);
    w->fresh = 0;
}
