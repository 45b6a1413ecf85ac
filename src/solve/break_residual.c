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
#include "solve.h"
#include <string.h>

/* Is the residual that of d, and of forces that are changed by the rows of these points alone? */
static int may_carry (const pg_system *s, const dynamics *dyn)
{
    return dyn && dyn->whole && s->known && s->mode == SYSTEM_DIAGONAL && s->force->spares.share_of
           && !s->options->plain && !system_is_shared (s) && !s->contact && !s->excavated && !s->held;
}

pg_status system_break (pg_system *s, const pg_state *state, const pg_changes *changes, const double *d,
                        const dynamics *dyn)
{
    pg_status status = PG_OK;
    double *before = s->scratch, *now = s->best;
    int can = may_carry (s, dyn), joined = can && dyn->join && dyn->join (dyn->context, d, s->full);
    const double *x = joined ? s->full : d;
    s->at_hand = 0;
    if (can) PG_TRY (s->force->spares.share_of (s->self, x, changes, before, &can));
    PG_TRY (system_refresh (s, state, changes));
    if (!can) goto done;
    PG_TRY (s->force->spares.share_of (s->self, x, changes, now, &can));
    for (size_t i = 0; i < s->ndof; i++) s->residual[i] += before[i] - now[i];
    s->at_hand = 1;
done:
    s->known = 0;
    return status;
}

/* The residual at hand as system_residual would leave it. */
double system_take_residual (pg_system *s)
{
    const pg_sparse *T = s->force->basis ? s->force->basis (s->self) : NULL;
    if (T) pg_sparse_multiply_transposed (T, s->residual, s->reduced);
    else memcpy (s->reduced, s->residual, s->ndof * sizeof *s->reduced);
    s->unbalanced = system_norm (s, s->reduced, s->nred);
    s->unmeasured++;
    return s->scale > 0 ? s->unbalanced / s->scale : 0;
}

/* What forces are compared with, and between two rounds the residual, for a run that goes on later. */
pg_status system_keep_residual (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long at_hand = s->at_hand;
    double number[2] = { s->reference, s->scale };
    PG_TRY (k->counts (k->context, "system.at_hand", 1, &at_hand));
    PG_KEEP_BOUND (k, "a residual at hand", at_hand, 0, 1);
    s->at_hand = at_hand != 0;
    PG_TRY (k->numbers (k->context, "system.references", 2, number));
    s->reference = number[0], s->scale = number[1];
    if (at_hand) PG_TRY (k->numbers (k->context, "system.residual", s->ndof, s->residual));
done:
    return status;
}
