/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run that goes on among other processes than those that its points were divided among: on another number
 * of ranks, alone, or on ranks after it was alone. Values of points come from whoever owned them, what all
 * knew alike from the first of them, and energies of each process's own points as their sum. A run that ended
 * in the middle of a step begins that step again. Caches are made anew; so is the work balance from which the
 * next work is summed, as its pairs of force and displacement belong to loads of one process. */
#include "contact.h"
#include <stdio.h>
#include <string.h>

/* Does a step begin again whose middle the run had reached? */
static pg_status take_counts (pg_solver *s, const pg_moved *m, int *within)
{
    pg_status status = PG_OK;
    long count[7];
    PG_TRY (m->alike->counts (m->alike->context, "solver.counts", 7, count));
    PG_KEEP_BOUND (m->alike, "the next level", count[3], 0, s->options.levels + 1);
    *within = count[4] > 0;
    s->finished = count[0] != 0, s->warned_overlap = count[1] != 0, s->warned_energy = count[2] != 0;
    s->next_level = count[3], s->spared = count[5], s->evaluations = count[6];
    s->break_loop.round = 0, s->break_loop.nbroken = 0;
done:
    return status;
}

/* Counts, times, displacements, velocities and bonds of the last step. */
static pg_status take_state (const pg_solver *s, pg_state *state, const pg_moved *m, const char *name)
{
    pg_status status = PG_OK;
    const pg_keeper *k = m->alike;
    size_t components = (size_t) s->break_loop.system.components;
    char part[32];
    long count[5];
    double number[3];
    snprintf (part, sizeof part, "%s.counts", name);
    PG_TRY (k->counts (k->context, part, 5, count));
    snprintf (part, sizeof part, "%s.numbers", name);
    PG_TRY (k->numbers (k->context, part, 3, number));
    for (int i = 0; i < 5; i++) PG_KEEP_BOUND (k, name, count[i], 0, 1L << 50);
    state->step = count[0], state->events = count[1], state->iterations = count[2];
    state->history_rows = count[4];
    state->time = number[0], state->factor = number[1];
    snprintf (part, sizeof part, "%s.d", name);
    PG_TRY (m->points (m->context, part, components, state->d));
    snprintf (part, sizeof part, "%s.v", name);
    PG_TRY (m->points (m->context, part, components, state->v));
    snprintf (part, sizeof part, "%s.a", name);
    PG_TRY (m->points (m->context, part, components, state->a));
    PG_TRY (m->bonds (m->context, state->alive));
done:
    return status;
}

/* The report so far, with what every process had of its own. */
static pg_status take_report (pg_solver *s, pg_state *state, const pg_moved *m)
{
    pg_status status = PG_OK;
    pg_statistics *r = &s->report;
    double share[SHARES];
    PG_TRY (keep_report (r, m->alike));
    PG_TRY (m->shares (m->context, "solver.shares", SHARES, share));
    state->broken = (long) share[SHARE_BROKEN], r->broken = (long) share[SHARE_REPORTED];
    state->work = s->break_loop.work = share[SHARE_WORK];
    r->energy_strain = share[SHARE_STRAIN], r->energy_kinetic = share[SHARE_KINETIC];
    r->energy_external = share[SHARE_EXTERNAL], r->energy_damping = share[SHARE_DAMPING];
    r->energy_dissipated = share[SHARE_DISSIPATED], r->events = state->events;
done:
    return status;
}

/* What is measured by the first matrix and by states before this one; the matrix itself is made anew, and
 * points of all bonds that are dead by now may be loose. */
static pg_status take_system (pg_system *sys, const pg_state *state, const pg_moved *m)
{
    system_factor *f = &sys->direct;
    pg_status status = PG_OK;
    double number[3];
    PG_TRY (m->alike->numbers (m->alike->context, "system.numbers", 3, number));
    PG_TRY (m->alike->numbers (m->alike->context, "system.borne", 1, &sys->balance.borne));
    if (f->diagonal0) {
        PG_TRY (m->points (m->context, "system.diagonal", (size_t) sys->components, f->diagonal0));
        f->mean_diagonal = number[0];
    }
    f->marked = 0;
    PG_TRY (system_refresh (sys, state, NULL));
    system_switch (sys, sys->choice.mode);
done:
    return status;
}

pg_status moved_balance (break_loop *b, double t, const double *d, double scale)
{
    double work = b->work;
    pg_work_balance_clear (&b->before);
    pg_status status = break_loop_account (b, t, d, NULL, 0, scale);
    b->work = work;
    return status;
}

pg_status pg_solver_move (pg_solver *s, pg_state *state, const pg_moved *m)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    int within = 0;
    if (!s->type->move || s->break_loop.growth || sys->contact || pg_problem_removes (s->problem))
        PG_FAIL (PG_E_USAGE, "a run of solver.kind: %s%s goes on only among as many processes as it had",
                 s->options.kind, s->break_loop.growth ? " with cracks that grow by facets"
                                  : sys->contact       ? " with contact"
                                  : pg_problem_removes (s->problem) ? " with stages that remove"
                                                       : "");
    PG_TRY (solver_start (s, state));
    PG_TRY (take_counts (s, m, &within));
    PG_TRY (take_state (s, state, m, within ? "backup" : "state"));
    PG_TRY (take_report (s, state, m));
    PG_TRY (stages_moved (s, m, within));
    PG_TRY (take_system (sys, state, m));
    PG_TRY (s->type->move (s, state, m, within));
    PG_TRY (pg_state_copy (s->backup, state));
    s->follows = 0;
done:
    return status;
}
