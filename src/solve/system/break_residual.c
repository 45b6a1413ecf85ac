/* SPDX-License-Identifier: GPL-3.0-or-later
 * The residual through a round of breaking. In small steps of a motion, whose systems the diagonal
 * preconditions, the iterations leave the residual of the state that they lead to. What breaks then changes
 * the rows of a few evaluation points only, so that the residual of the same displacements after the break is
 * the old one, less what these points add to it after the break, and with what they added before:
 *
 *     r+ = r + f (points, rows of before) - f (points, rows of now),    f = K (d + c_K v) of these points.
 *
 * The next rough round begins without a sweep over the body (rough_round.c). Exact rounds measure the
 * residual, so that rounding does not pile up beyond a step. What it is divided by stays that of the state
 * measured last. */
#include "solve/run/solve.h"
#include <string.h>

/* Can the residual be updated: is it that of d, and do only the rows of these points change it? */
static int may_carry (const pg_system *s, const dynamics *dyn)
{
    return dyn && dyn->whole && s->balance.known && s->choice.mode == SYSTEM_DIAGONAL
           && s->force->spares.share_of
           && !s->options->plain && !system_is_shared (s) && !s->contact && !s->balance.excavated
               && !s->balance.held;
}

pg_status system_break (pg_system *s, const pg_state *state, const pg_changes *changes, const double *d,
                        const dynamics *dyn)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    double *before = b->scratch, *now = b->best;
    int can = may_carry (s, dyn), joined = can && dyn->join && dyn->join (dyn->context, d, b->full);
    const double *x = joined ? b->full : d;
    b->at_hand = 0;
    if (can) PG_TRY (s->force->spares.share_of (s->self, x, changes, before, &can));
    PG_TRY (system_refresh (s, state, changes));
    if (!can) goto done;
    PG_TRY (s->force->spares.share_of (s->self, x, changes, now, &can));
    for (size_t i = 0; i < s->ndof; i++) b->residual[i] += before[i] - now[i];
    b->at_hand = 1;
done:
    b->known = 0;
    return status;
}

/* Returns the updated residual, relative, and reduces it as system_residual does. */
double system_take_residual (pg_system *s)
{
    system_balance *b = &s->balance;
    system_reduce (s, b->residual, b->reduced);
    b->unbalanced = system_norm (s, b->reduced, s->nred);
    b->unmeasured++;
    return b->scale > 0 ? b->unbalanced / b->scale : 0;
}

/* Checkpoint: the reference forces and, between two rounds of breaking, the residual. */
pg_status system_keep_residual (pg_system *s, const pg_keeper *k)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    PG_TRY (pg_keep_fields (k, "system", "at_hand", "references", 1, PG_ROWS (
        PG_KEPT_IN (b->at_hand, 0, 1, "a residual at hand"), PG_KEPT (b->reference), PG_KEPT (b->scale))));
    if (b->at_hand) PG_TRY (k->numbers (k->context, "system.residual", s->ndof, b->residual));
done:
    return status;
}
