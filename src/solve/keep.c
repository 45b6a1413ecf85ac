/* SPDX-License-Identifier: GPL-3.0-or-later
 * What later steps depend on, walked over once for writing and for reading back: the state (also that at the start of a step in its middle),
 * energies, counts, what a method carries from step to step. Caches are not kept: they are functions of the bonds, made again in the
 * same order. The factor of an earlier K is one of them: it is made again from the bonds that lived then. */
#include "solve.h"
#include <string.h>

static pg_status keep_state (pg_state *s, const char *name, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    long count[5] = { s->step, s->events, s->iterations, s->broken, s->history_rows };
    double number[3] = { s->time, s->factor, s->work };
    double *vector[3] = { s->d, s->v, s->a };
    static const char *const vectors[3] = { "d", "v", "a" };
#define PART(suffix) (strcpy (part, name), strcat (part, suffix))
    PG_TRY (k->counts (k->context, PART (".counts"), 5, count));
    PG_TRY (k->numbers (k->context, PART (".numbers"), 3, number));
    s->step = count[0], s->events = count[1], s->iterations = count[2], s->broken = count[3], s->history_rows = count[4];
    s->time = number[0], s->factor = number[1], s->work = number[2];
    for (int v = 0; v < 3; v++) {
        PART (".");
        PG_TRY (k->numbers (k->context, strcat (part, vectors[v]), s->ndof, vector[v]));
    }
    PG_TRY (k->bytes (k->context, PART (".alive"), s->nbond, s->alive));
#undef PART
done:
    return status;
}

/* Bonds that died in the step at hand. */
static pg_status keep_broken (breaker *b, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long n = (long) b->nbroken;
    PG_TRY (k->counts (k->context, "solver.broken_count", 1, &n));
    if (k->reading) {
        PG_GROW (b->broken, b->cap_broken, (size_t) n);
        b->nbroken = (size_t) n;
    }
    if (n > 0) PG_TRY (k->bytes (k->context, "solver.broken", (size_t) n * sizeof *b->broken, b->broken));
done:
    return status;
}

/* Forces and displacements of the last accounted states, between which work is summed. */
static pg_status keep_ledger (pg_ledger *l, const char *name, size_t nload, const pg_keeper *k)
{
    pg_status status = PG_OK;
    char part[64];
    long count[2] = { l->force != NULL ? (long) l->npair : -1, l->reaction != NULL };
    strcat (strcpy (part, name), ".counts");
    PG_TRY (k->counts (k->context, part, 2, count));
    if (count[0] < 0) goto done;
    if (k->reading) {
        pg_ledger_clear (l);
        l->npair = (size_t) count[0];
        PG_ALLOC (l->force, l->npair);
        PG_ALLOC (l->displacement, l->npair);
        if (count[1]) PG_ALLOC (l->reaction, 3 * nload);
    }
    strcat (strcpy (part, name), ".force");
    if (count[0] > 0) PG_TRY (k->numbers (k->context, part, (size_t) count[0], l->force));
    strcat (strcpy (part, name), ".displacement");
    if (count[0] > 0) PG_TRY (k->numbers (k->context, part, (size_t) count[0], l->displacement));
    strcat (strcpy (part, name), ".reaction");
    if (count[1] && nload) PG_TRY (k->numbers (k->context, part, 3 * nload, l->reaction));
    strcat (strcpy (part, name), ".strain");
    PG_TRY (k->numbers (k->context, part, 1, &l->strain));
done:
    return status;
}

static pg_status keep_system (pg_system *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    long count[8] = { s->mode, s->umfpack, s->kept, s->marked, s->factored != NULL, s->stale, s->unshifted, s->spared };
    double number[3] = { s->mean_diagonal, s->shift, s->rent };
    PG_TRY (k->counts (k->context, "system.counts", 8, count));
    PG_TRY (k->numbers (k->context, "system.numbers", 3, number));
    PG_TRY (k->numbers (k->context, "system.diagonal", s->ndof, s->diagonal0));
    PG_TRY (k->bytes (k->context, "system.touched", s->problem->cloud.n, s->touched));
    s->mode = (int) count[0], s->kept = count[2], s->marked = (int) count[3], s->unshifted = (int) count[6], s->spared = count[7];
    s->mean_diagonal = number[0], s->shift = number[1], s->rent = number[2];
    if (k->reading && count[1] && !s->umfpack) {
        if (s->factor) s->linear->free (&s->factor);
        s->linear = pg_linear_find ("umfpack");
        s->umfpack = 1;
    }
    long made = s->multilevel != NULL || s->remake;
    PG_TRY (k->counts (k->context, "system.multilevel", 1, &made));
    PG_TRY (k->numbers (k->context, "system.pace", 1, &s->pace));
    PG_TRY (k->numbers (k->context, "system.borne", 1, &s->borne));
    if (k->reading) s->remake = made != 0;
    size_t nbond = s->problem->first_bond[PG_BOND_SETS];
    if (k->reading && count[4] && !s->factored) PG_ALLOC (s->factored, nbond);
    if (count[4]) PG_TRY (k->bytes (k->context, "system.factored", nbond, s->factored));
    s->stale = (int) count[5];
done:
    return status;
}

static pg_status keep_solver (pg_solver *s, const pg_keeper *k)
{
    pg_status status = PG_OK;
    breaker *b = &s->breaker;
    size_t nload = s->problem->nload;
    long count[11] = { s->finished, s->overlap_told, s->energy_told, s->skips_told, s->next_level, (long) s->ended, s->ledger_fresh, b->round,
                       s->unit != NULL, s->force0 != NULL, s->spared_told };
    double number[5] = { s->unit_residual, s->secant0, b->work, b->work0, b->stored0 };
    PG_TRY (k->counts (k->context, "solver.counts", 11, count));
    PG_TRY (k->numbers (k->context, "solver.numbers", 5, number));
    s->finished = (int) count[0], s->overlap_told = (int) count[1], s->energy_told = (int) count[2], s->skips_told = (int) count[3];
    s->next_level = count[4], s->ended = (pg_status) count[5], s->ledger_fresh = (int) count[6], b->round = count[7], s->spared_told = (int) count[10];
    s->unit_residual = number[0], s->secant0 = number[1], b->work = number[2], b->work0 = number[3], b->stored0 = number[4];
    PG_TRY (k->bytes (k->context, "solver.why", sizeof s->why, s->why));
    PG_TRY (k->bytes (k->context, "solver.report", sizeof s->report, &s->report));
    if (nload) PG_TRY (k->numbers (k->context, "solver.reaction", 3 * nload, s->reaction));
    if (count[8] && s->unit) PG_TRY (k->numbers (k->context, "solver.unit", b->system.ndof, s->unit));
    if (count[9] && s->force0) PG_TRY (k->numbers (k->context, "solver.force0", b->system.ndof, s->force0));
    PG_TRY (keep_broken (b, k));
    PG_TRY (keep_ledger (&b->ledger, "ledger", nload, k));
    PG_TRY (keep_ledger (&b->before, "before", nload, k));
done:
    return status;
}

/* Caches again as they were: the kept factor from the bonds that lived when it was made, all else from those that live now. */
static pg_status rebuild (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->breaker.system;
    pg_report counts = s->report;
    int stale = sys->stale;
    unsigned char *alive = state->alive;
    double rent = sys->rent, pace = sys->pace;
    if (sys->remake && sys->factored) {
        state->alive = sys->factored;
        status = system_refresh (sys, state, NULL);
        if (status == PG_OK) status = system_make_multilevel (sys);
        state->alive = alive;
        PG_TRY (status);
        sys->rent = rent, sys->pace = pace, sys->remake = 0;
    } else if ((sys->mode == SYSTEM_KEPT_FACTOR || !stale) && sys->factored) {
        state->alive = sys->factored;
        status = system_refresh (sys, state, NULL);
        if (status == PG_OK) status = system_factorize (sys, s->type->dynamics ? s->type->dynamics (s) : NULL);
        state->alive = alive;
        PG_TRY (status);
    } else stale = 1;
    PG_TRY (system_refresh (sys, state, NULL));
    sys->stale = stale;
    memcpy (counts.seconds, s->report.seconds, sizeof counts.seconds);
    s->report = counts;
done:
    return status;
}

pg_status pg_solver_keep (pg_solver *s, pg_state *state, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (k->reading && !s->started) PG_TRY (s->type->start (s, state));
    s->started = 1;
    PG_TRY (keep_state (state, "state", k));
    PG_TRY (keep_state (s->backup, "backup", k));
    PG_TRY (keep_solver (s, k));
    PG_TRY (keep_system (&s->breaker.system, k));
    if (s->type->keep) PG_TRY (s->type->keep (s, k));
    if (k->reading) PG_TRY (rebuild (s, state));
done:
    return status;
}
