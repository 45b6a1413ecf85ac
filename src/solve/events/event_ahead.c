/* SPDX-License-Identifier: GPL-3.0-or-later
 * Looking ahead under proportional loads (event_ahead.h). The events found are those of a look at all bonds
 * after every event: within the group bonds are chosen as in event_stepping.c, and all others are checked
 * before anything is handed out. Load factors differ by the rounding of the equilibria, as these come from
 * dense algebra on what breaking has touched (event_solver.h). */
#include "event_stepping.h"
#include "event_ahead.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* The group lies around bonds of at least this share of the largest utilisation. */
static const double near_limit = 0.85;
/* Above this share of the tolerance the residual of the last equilibrium of a block is reduced by a solve. */
static const double settled = 1e-3;

void ahead_free (event_ahead **ahead)
{
    event_ahead *q = *ahead;
    if (!q) return;
    event_zone_clear (&q->zone);
    pg_free (q->utilisation), pg_free (q->factor), pg_free (q->kind);
    pg_free (q->d), pg_free (q->scaled), pg_free (q->some), pg_free (q->block);
    pg_free (q->broken), pg_free (q->undone.bond);
    pg_free (q);
    *ahead = NULL;
}

static pg_status create (event_ahead **out, size_t ndof)
{
    pg_status status = PG_OK;
    event_ahead *q = NULL;
    PG_ALLOC (q, 1);
    PG_ALLOC (q->d, ndof);
    PG_ALLOC (q->scaled, ndof);
    PG_ALLOC (q->some, ndof);
    q->cold = -1;
    *out = q;
    q = NULL;
done:
    ahead_free (&q);
    return status;
}

/* 1: looking ahead is possible: proportional loads, single bonds judged, equilibria followed; a force that
 * can judge groups, and a solver that finds displacements without a factorization. */
static int possible (const pg_solver *s)
{
    const event_stepping *e = events_of (s);
    const break_loop *b = &s->break_loop;
    const pg_force_type *f = b->system.force;
    return !s->problem->plain && e->engine && !e->base && !b->growth && break_loop_judges (b)
           && s->options.on_instability == PG_UNSTABLE_FOLLOW && f->spares.gather
           && event_solver_has_base (e->engine);
}

int ahead_waits (const event_ahead *q) { return q && q->at < q->nevent; }

void ahead_forget (event_ahead *q)
{
    if (q) q->cold = -1;
}

/* ---- bonds that die and live again --------------------------------------------------------------------- */
static pg_status refresh (pg_solver *s, const pg_state *state, const pg_changes *changes)
{
    pg_system *sys = &s->break_loop.system;
    long updates = s->report.linear.updates, kept = sys->choice.kept;
    pg_status status = system_refresh (sys, state, changes);
    /* a trial does not count as an update */
    s->report.linear.updates = updates, sys->choice.kept = kept;
    return status;
}

/* Takes back the events from k on: their bonds become intact again, and shape functions are as before. */
static pg_status revive (pg_solver *s, event_ahead *q, pg_state *state, size_t k)
{
    pg_status status = PG_OK;
    size_t first = k < q->nevent ? q->event[k].first : q->nbroken;
    q->undone.n = 0;
    for (size_t i = first; i < q->nbroken; i++) {
        PG_GROW (q->undone.bond, q->undone.cap, q->undone.n + 1);
        state->alive[q->broken[i].bond] = 1;
        q->undone.bond[q->undone.n++] = q->broken[i].bond;
    }
    if (q->undone.n == 0) return PG_OK;
    pg_sort (q->undone.bond, q->undone.n, sizeof *q->undone.bond, pg_ascending_sizes);
    PG_TRY (refresh (s, state, &q->undone));
done:
    return status;
}

/* ---- finding ------------------------------------------------------------------------------------------- */
static pg_status room_for_group (event_ahead *q)
{
    pg_status status = PG_OK;
    pg_free (q->utilisation), pg_free (q->factor), pg_free (q->kind);
    q->utilisation = q->factor = NULL, q->kind = NULL;
    PG_ALLOC (q->utilisation, q->zone.group.n);
    PG_ALLOC (q->factor, q->zone.group.n);
    PG_ALLOC (q->kind, q->zone.group.n);
done:
    return status;
}

/* Judges all bonds at the present displacement: makes the group around those near their limit, and finds the
 * largest utilisation per load factor outside of it. *found 0: there is no group. */
static pg_status make_zone (pg_solver *s, event_ahead *q, const pg_state *state)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    double best = INFINITY, share;
    PG_TRY (break_loop_ready (b));
    PG_TRY (b->system.force->judge (b->system.self, state, e->unit, &(pg_judging){ .factor = b->factor }));
    for (size_t i = 0; i < state->nbond; i++) if (b->factor[i] < best) best = b->factor[i];
    q->zone.known = 0;
    if (!isfinite (best)) goto done;
    for (size_t i = 0; i < state->nbond; i++) b->factor[i] = best / b->factor[i];
    PG_TRY (event_zone_make (&q->zone, &b->system, state, b->factor, near_limit, ahead_most_of_body, &share));
    if (!q->zone.known) goto done;
    q->cold = 0;
    for (size_t i = 0; i < state->nbond; i++)
        if (!q->zone.left_out[i] && b->factor[i] > q->cold) q->cold = b->factor[i];
    q->cold /= best;
    PG_TRY (room_for_group (q));
done:
    return status;
}

/* Sets the displacement at the nodes of the group: from the solver, or from a whole field. */
static pg_status take (const pg_solver *s, event_ahead *q, const double *whole)
{
    pg_status status = PG_OK;
    const pg_bond_group *g = &q->zone.group;
    size_t c = (size_t) s->break_loop.system.components;
    if (!whole) {
        PG_TRY (event_solver_watch (events_of (s)->engine, g->nnode, g->node));
        PG_TRY (event_solver_watched (events_of (s)->engine, 0, q->some));
    }
    for (size_t k = 0; k < g->nnode; k++)
        memcpy (q->d + (size_t) g->node[k] * c, whole ? whole + (size_t) g->node[k] * c : q->some + k * c,
                c * sizeof *q->d);
done:
    return status;
}

/* Finds the utilisations of the group at this factor from those of the unit displacement, or measures them
 * where they are not proportional, as event_stepping.c does. */
static pg_status look_over_group (pg_solver *s, event_ahead *q, const pg_state *state, double factor,
                                  double *top)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    const pg_bond_group *g = &q->zone.group;
    size_t worst = 0, c = (size_t) b->system.components;
    for (size_t i = 1; i < g->n; i++) if (q->utilisation[i] > q->utilisation[worst]) worst = i;
    *top = factor * q->utilisation[worst];
    if (*top <= 1 + s->options.tie && fabs (q->utilisation[worst] * q->factor[worst] - 1) <= 1e-9) {
        for (size_t i = 0; i < g->n; i++) q->utilisation[i] *= factor;
        goto done;
    }
    for (size_t k = 0; k < g->nnode; k++)
        for (size_t i = (size_t) g->node[k] * c; i < ((size_t) g->node[k] + 1) * c; i++)
            q->scaled[i] = factor * q->d[i];
    PG_TRY (
        b->system.force->judge (b->system.self, state, q->scaled,
                                &(pg_judging){ .group = g, .utilisation = q->utilisation, .kind = q->kind }));
    *top = 0;
    for (size_t i = 0; i < g->n; i++) *top = fmax (*top, q->utilisation[i]);
done:
    return status;
}

/* Appends the next event: the bonds within the tie of the worst one. *why 0: found; 1: it is at the next
 * level or beyond, or there is none; 2: it lies outside the inner part. */
static pg_status choose (pg_solver *s, event_ahead *q, pg_state *state, double level, int *why)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    const pg_bond_group *g = &q->zone.group;
    const pg_solver_options *o = &s->options;
    double width = o->break_mode == PG_BREAK_FRACTION ? fmax (o->break_fraction, o->tie) : o->tie,
           best = INFINITY, top;
    ahead_event *v = &q->event[q->nevent];
    PG_TRY (
        b->system.force->judge (b->system.self, state, q->d,
           &(pg_judging){ .group = g, .utilisation = q->utilisation, .kind = q->kind, .factor = q->factor }));
    for (size_t i = 0; i < g->n; i++) if (q->factor[i] < best) best = q->factor[i];
    *why = 1;
    if (!(best < level) || !(best > 0)) goto done;
    *why = 2;
    for (size_t i = 0; i < g->n; i++)
        if (best / q->factor[i] >= 1 - width && !event_zone_inner (&q->zone, i)) goto done;
    *why = 0;
    PG_TRY (look_over_group (s, q, state, best, &top));
    *v = (ahead_event) { .factor = best, .top = top, .first = q->nbroken };
    b->changes.n = 0;
    for (size_t i = 0; i < g->n; i++) {
        if (!(best / q->factor[i] >= 1 - width)) continue;
        PG_GROW (q->broken, q->cap_broken, q->nbroken + 1);
        PG_GROW (b->changes.bond, b->changes.cap, b->changes.n + 1);
        q->broken[q->nbroken++] = (pg_broken) { .bond = g->bond[i], .kind = q->kind[i],
                                                .utilisation = q->utilisation[i] };
        b->changes.bond[b->changes.n++] = g->bond[i];
        state->alive[g->bond[i]] = 0;
        v->n++;
    }
    q->nevent++;
done:
    return status;
}

/* Finds event after event in the group, up to a full block. *retry 1: a new group may find the next one. */
static pg_status find (pg_solver *s, event_ahead *q, pg_state *state, double level, int *retry)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    break_loop *b = &s->break_loop;
    int why = 0;
    *retry = 0;
    PG_TRY (take (s, q, e->unit));
    while (q->nevent < AHEAD_MOST && state->events + (long) q->nevent < s->options.max_events) {
        inverse_outcome outcome;
        PG_TRY (choose (s, q, state, level, &why));
        if (why) break;
        PG_TRY (refresh (s, state, &b->changes));
        PG_TRY (event_solver_update (e->engine, &outcome));
        if (outcome == INVERSE_LOST) {
            PG_TRY (revive (s, q, state, q->nevent - 1));
            q->nbroken = q->event[--q->nevent].first;
            q->cold = -1;                              /* the next event is found without looking ahead */
            goto done;
        }
        q->due |= outcome == INVERSE_DUE;
        PG_TRY (take (s, q, NULL));
    }
    *retry = why == 2;
done:
    return status;
}

/* ---- checking ------------------------------------------------------------------------------------------ */
/* Checks all other bonds at all events found, *good of which stay: the first event at which one of these
 * bonds is within the tie of its limit is wrong, and so are all after it. */
static pg_status check (pg_solver *s, event_ahead *q, pg_state *state, size_t *good)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    pg_system *sys = &s->break_loop.system;
    const pg_solver_options *o = &s->options;
    double width = o->break_mode == PG_BREAK_FRACTION ? fmax (o->break_fraction, o->tie) : o->tie,
           top[AHEAD_MOST], cold = q->cold, relative;
    int list[AHEAD_MOST];
    for (size_t k = 0; k < q->nevent; k++) list[k] = (int) k;
    q->stride = q->nevent;
    if (!q->block) PG_ALLOC (q->block, sys->ndof * AHEAD_MOST);
    PG_TRY (event_solver_block (e->engine, 0, (int) q->nevent, list, q->block));
    PG_TRY (sys->force->judge (sys->self, state, q->block,
                &(pg_judging){ .count = q->stride, .left_out = q->zone.left_out, .of_unit = 1, .top = top }));
    for (*good = 0; *good < q->nevent && q->event[*good].factor * cold < 1 - width; ++*good)
        cold = top[*good];
    if (*good < q->nevent) {
        inverse_outcome outcome;
        q->taken_back++;
        PG_TRY (revive (s, q, state, *good));
        PG_TRY (event_solver_back (e->engine, (int) *good - 1, &outcome));
        q->due |= outcome == INVERSE_DUE || outcome == INVERSE_LOST;
        q->nbroken = q->event[*good].first, q->nevent = *good;
        cold = -1;
    }
    q->cold = cold;
    if (q->nevent == 0) goto done;
    pg_status now = event_solver_settle (e->engine, 0, settled * o->tolerance, q->scaled,
                                          &relative);
    if (now == PG_E_SINGULAR) relative = INFINITY;  /* a part has come loose: decided without looking ahead */
    else PG_TRY (now);
    for (size_t i = 0; i < sys->ndof; i++) q->block[i * q->stride + q->nevent - 1] = q->scaled[i];
    q->residual = relative;
    if (relative <= o->tolerance) goto done;
    PG_TRY (revive (s, q, state, 0));                  /* not accurate enough: drop all events found */
    event_solver_drop (e->engine);
    q->cold = -1, *good = q->nevent = q->nbroken = 0;
done:
    return status;
}

/* ---- looking ahead ------------------------------------------------------------------------------------- */
/* Factors the present stiffness if that pays by the count of the solver; else begins a new block. */
static pg_status renew (pg_solver *s, event_ahead *q)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    if (q->due) PG_TRY (event_solver_base (e->engine, &e->unit, &e->engine_residual));
    else PG_TRY (event_solver_flush (e->engine));
    q->due = 0;
done:
    return status;
}

/* Seconds of the run that count in other entries than PG_SECONDS_BREAK. */
static double seconds_of_others (const pg_solver *s)
{
    double sum = 0;
    for (int k = 0; k < PG_SECONDS_COUNT; k++) if (k != PG_SECONDS_BREAK) sum += s->report.seconds[k];
    return sum;
}

/* Finds the next events, if it can; ahead_waits then tells whether there are any. */
pg_status ahead_look (pg_solver *s, pg_state *state, double level)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    double t0 = pg_seconds (), others = seconds_of_others (s);
    size_t good = 0;
    if (!possible (s)) return PG_OK;
    if (!e->ahead) PG_TRY (create (&e->ahead, state->ndof));
    event_ahead *q = e->ahead;
    if (q->wait > 0) {
        q->wait--;
        return PG_OK;
    }
    for (int retry = 1, tries = 0; retry && tries < 2; tries++) {
        q->nevent = q->at = q->nbroken = 0;
        if (q->cold < 0 || !q->zone.known || tries) PG_TRY (make_zone (s, q, state));
        if (!q->zone.known) {
            q->wait = AHEAD_MOST;
            goto done;
        }
        PG_TRY (renew (s, q));
        PG_TRY (find (s, q, state, level, &retry));
        if (q->nevent == 0) continue;
        size_t found = q->nevent;
        PG_TRY (check (s, q, state, &good));
        retry = good == 0 && found > 0;
        PG_TRY (revive (s, q, state, 0));
        if (good) break;
    }
    if (q->nevent == 0) q->cold = -1;
    q->found += (long) q->nevent;
done:
    s->report.seconds[PG_SECONDS_BREAK] += pg_seconds () - t0 - (seconds_of_others (s) - others);
    return status;
}

/* Breaks the bonds of the first waiting event in `state`, logs them and lists them for the force. */
pg_status ahead_kill (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    event_ahead *q = events_of (s)->ahead;
    break_loop *b = &s->break_loop;
    const ahead_event *v = &q->event[q->at];
    b->changes.n = 0;
    for (size_t i = v->first; i < v->first + v->n; i++) {
        const pg_broken *k = &q->broken[i];
        PG_GROW (b->changes.bond, b->changes.cap, b->changes.n + 1);
        PG_TRY (break_loop_log (b, k->bond, k->kind, k->utilisation, v->factor));
        state->alive[k->bond] = 0;
        b->changes.bond[b->changes.n++] = k->bond;
    }
    state->broken += (long) v->n;
done:
    return status;
}

/* Load factor of the first waiting event; *top: the largest utilisation there. */
double ahead_factor (const event_ahead *q, double *top)
{
    *top = q->event[q->at].top;
    return q->event[q->at].factor;
}

/* Makes unit the equilibrium after that event. When no event is left, changes that the force has recorded are
 * rounding only, as the solver has seen these events, and are cleared. */
pg_status ahead_take (pg_solver *s)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    event_ahead *q = e->ahead;
    pg_system *sys = &s->break_loop.system;
    pg_stiffness_change none;
    for (size_t i = 0; i < sys->ndof; i++) e->unit[i] = q->block[i * q->stride + q->at];
    e->unit_residual = q->residual;
    if (++q->at == q->nevent) PG_TRY (sys->force->spares.change (sys->self, &none));
done:
    return status;
}

/* Drops all events found, as a step is refused, maybe during a look ahead that was not checked yet. */
void ahead_refused (event_ahead *q)
{
    if (!q) return;
    q->nevent = q->at = q->nbroken = 0;
    q->zone.known = q->due = 0;
    q->cold = -1;
}

/* Reports what looking ahead has saved: one look at all bonds for each event that was found together with
 * others, at a stored rate of seconds a bond. */
void ahead_tell (pg_solver *s)
{
    const event_ahead *q = events_of (s)->ahead;
    static const double rate = 15e-9;                  /* s, to measure and judge a bond */
    char what[96], why[160];
    if (!q || q->found == 0) return;
    snprintf (what, sizeof what, "a look at all bonds after %ld of %ld events", q->found, s->report.events);
    snprintf (why, sizeof why,
              "found near the tips, up to %d at a time; all others checked together afterwards%s",
              AHEAD_MOST, q->taken_back ? ", some blocks cut short by that" : "");
    pg_statistics_skip (&s->report, (double) q->found * rate * (double) s->problem->bonds.first[PG_BOND_SETS],
                        what, why);
}

/* ---- checkpoints --------------------------------------------------------------------------------------- */
/* Keeps the waiting events, with the positions of their bonds in the list. Unused entries are zero. */
static pg_status keep_events (event_ahead *q, const pg_problem *p, const pg_keeper *k)
{
    pg_status status = PG_OK;
    ahead_event event[AHEAD_MOST] = { { 0 } }, *v = event;
    if (!k->reading) memcpy (event, q->event, q->nevent * sizeof *event);
    PG_TRY (pg_keep_fields (k, "event_ahead", "events", "factors", AHEAD_MOST, PG_ROWS (
        PG_EACH_IN (v, first, 0, q->nbroken, "the bonds of an event"), PG_EACH (v, n), PG_EACH (v, factor),
        PG_EACH (v, top))));
    for (size_t i = 0; i < q->nevent; i++)
        PG_KEEP_BOUND (k, "the bonds of an event", v[i].n, 1, q->nbroken - v[i].first);
    memcpy (q->event, event, q->nevent * sizeof *event);
    if (k->reading) PG_GROW (q->broken, q->cap_broken, q->nbroken + 1);
    PG_TRY (pg_broken_keep (p, "event_ahead.broken", q->nbroken, q->broken, k));
done:
    return status;
}

/* Keeps the queue, as the next looks ahead depend on how far this one came: a run that is read back finds
 * its events in the same blocks, to the same bits. */
pg_status ahead_keep (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    event_stepping *e = events_of (s);
    event_ahead none = { .nevent = 0 }, *q;
    const pg_system *sys = &s->break_loop.system;
    double share;
    int ahead = e->ahead != NULL;
    if (k->reading && !ahead) PG_TRY (create (&e->ahead, sys->ndof));
    q = e->ahead ? e->ahead : &none;
    int known = q->zone.known;
    PG_TRY (pg_keep_fields (k, "event_ahead", "counts", "numbers", 1, PG_ROWS (
        PG_KEPT (ahead), PG_KEPT_IN (q->nevent, 0, AHEAD_MOST, "the number of events found"),
        PG_KEPT_IN (q->at, 0, AHEAD_MOST, "the next event"),
        PG_KEPT_IN (q->stride, 0, AHEAD_MOST, "the width of a block"),
        PG_KEPT_IN (q->nbroken, 0, s->problem->bonds.first[PG_BOND_SETS], "the bonds found"),
        PG_KEPT (q->wait), PG_KEPT (q->due), PG_KEPT (known), PG_KEPT (q->found), PG_KEPT (q->taken_back),
        PG_KEPT (q->cold), PG_KEPT (q->residual))));
    if (!ahead) {
        if (k->reading) ahead_free (&e->ahead);
        return PG_OK;
    }
    PG_KEEP_BOUND (k, "the next event", q->at, 0, q->nevent);
    PG_TRY (keep_events (q, s->problem, k));
    if (q->at < q->nevent) {
        if (!q->block) PG_ALLOC (q->block, sys->ndof * AHEAD_MOST);
        PG_TRY (k->numbers (k->context, "event_ahead.block", sys->ndof * q->stride, q->block));
    }
    if (!known) return PG_OK;
    PG_TRY (event_zone_room (&q->zone, s->problem));
    PG_TRY (k->bytes (k->context, "event_ahead.levels", s->problem->cloud.n, q->zone.level));
    if (!k->reading) goto done;
    PG_TRY (event_zone_fill (&q->zone, sys, ahead_most_of_body, &share));
    PG_TRY (room_for_group (q));
done:
    return status;
}
