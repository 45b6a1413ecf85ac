/* SPDX-License-Identifier: GPL-3.0-or-later
 * A run that goes on among other processes than those that its points were divided among: on another number
 * of ranks, alone, or on ranks after it was alone. Values of points come from whoever owned them, what all
 * knew alike from the first of them, and energies of each process's own points as their sum. A run that ended
 * in the middle of a step begins that step again. Caches are made anew; so is the work balance from which the
 * next work is summed, as its pairs of force and displacement belong to loads of one process. */
#include "solve/contact/contact.h"
#include <stdio.h>
#include <string.h>

/* Counts, times, displacements, velocities and bonds of the last step. */
static pg_status take_state (const pg_solver *s, pg_state *state, const pg_moved *m, const char *name)
{
    pg_status status = PG_OK;
    size_t components = (size_t) s->break_loop.system.components;
    double *vector[3] = { state->d, state->v, state->a };
    char part[32];
    PG_TRY (keep_state_numbers (state, name, m->alike));
    for (int v = 0; v < 3; v++) {
        snprintf (part, sizeof part, "%s.%c", name, "dva"[v]);
        PG_TRY (m->points (m->context, part, components, vector[v]));
    }
    PG_TRY (m->bonds (m->context, state->alive));
done:
    return status;
}

/* Reads the report so far and adds up what every process had of its own points. */
static pg_status take_report (pg_solver *s, pg_state *state, const pg_moved *m)
{
    pg_status status = PG_OK;
    pg_statistics *r = &s->report;
    double share[SHARES];
    PG_TRY (keep_report (r, m->alike));
    PG_TRY (m->shares (m->context, "solver.shares", SHARES, share));
    state->broken = (long) share[SHARE_BROKEN], r->broken = (long) share[SHARE_REPORTED];
    state->work = s->break_loop.work = share[SHARE_WORK];
    r->energy.strain = share[SHARE_STRAIN], r->energy.kinetic = share[SHARE_KINETIC];
    r->energy.external = share[SHARE_EXTERNAL], r->energy.damping = share[SHARE_DAMPING];
    r->energy.dissipated = share[SHARE_DISSIPATED], r->events = state->events;
done:
    return status;
}

/* Reads scales that come from the first matrix and from earlier states. The matrix itself is made anew;
 * points of all bonds that are broken by now may be loose. */
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

pg_status pg_solver_move (pg_solver *s, pg_state *state, const pg_moved *m)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    if (!s->type->move || s->break_loop.growth || sys->contact || pg_problem_removes (s->problem))
        PG_FAIL (PG_E_USAGE, "a run of solver.kind: %s%s goes on only among as many processes as it had",
                 s->options.kind, s->break_loop.growth ? " with cracks that grow by facets"
                                  : sys->contact       ? " with contact"
                                  : pg_problem_removes (s->problem) ? " with stages that remove"
                                                       : "");
    PG_TRY (solver_start (s, state));
    PG_TRY (keep_solver_counts (s, m->alike));
    /* the run had reached the middle of a step, which begins again */
    const int within = s->break_loop.round > 0;
    s->break_loop.round = 0, s->break_loop.nbroken = 0;
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
