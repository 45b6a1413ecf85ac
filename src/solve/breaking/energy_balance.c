/* SPDX-License-Identifier: GPL-3.0-or-later
 * The energy balance of a run: external work is summed by trapezoids over pairs of generalised forces and
 * displacements that the force tells of the boundary (pg_work_balance), between one accounted state and the
 * next. What it exceeds strain, kinetic and damping energy by is what breaking has taken (solver.c). */
#include "solve/run/solve.h"
#include <string.h>

/* Checks the balance of forces in dynamics. Where the equations weigh the forces of two times, reactions are
 * found once more, with what these leave unbalanced at the end of the step. */
static pg_status balance_in_motion (pg_system *s, double t, const double *d, const pg_work_balance *w,
                                    const dynamics *dyn)
{
    system_balance *b = &s->balance;
    pg_status status = PG_OK;
    pg_work_balance own = { 0 };
    if (!force_balance_due (s)) return PG_OK;
    memset (b->full, 0, s->ndof * sizeof *b->full);
    dyn->resist (dyn->context, d, b->full);
    if (dyn->leave) {
        dyn->leave (dyn->context, d, b->full);
        PG_TRY (s->force->work (s->self, t, d, &(pg_known){ .inertia = b->full }, &own));
    }
    force_balance (s, d, dyn->leave ? &own : w, b->full);
done:
    pg_work_balance_clear (&own);
    return status;
}

/* Asks the force for the work balance of the state (t, d) and adds the work since the last one. In
 * dynamics reactions contain inertia and damping, which `dyn` adds, or which are in the residual that the
 * solve has left behind. In statics they contain contact forces on nodes that are held; `rest` says that
 * the state is one of equilibrium, which spares the force its evaluation: not with friction, where half the
 * work of the loads is not what is stored. */
pg_status break_loop_account (break_loop *b, double t, const double *d, const dynamics *dyn, int rest,
                              double scale)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    if (!s->force->work) return PG_OK;
    double t0 = pg_seconds ();
    const double *contact = s->balance.excavated ? s->balance.excavated : s->balance.pressed;
    pg_known known = { 0 };
    if (dyn && dyn->whole && s->balance.known && !s->options->plain) known.residual = s->balance.residual,
        known.whole = 1;
    else if (dyn) {
        memset (s->balance.full, 0, s->ndof * sizeof *s->balance.full);
        dyn->resist (dyn->context, d, s->balance.full);
        known.inertia = s->balance.full;
    }
    else known.inertia = contact, known.rest = rest && !contact && !s->problem->plain;
    PG_TRY (s->force->work (s->self, t, d, &known, &b->work_balance));
    if (dyn) PG_TRY (balance_in_motion (s, t, d, &b->work_balance, dyn));
    else {
        force_balance (s, d, &b->work_balance, contact);
        if (s->client) s->client->account (s, &b->work_balance);
    }
    PG_TRY (break_loop_book (b, scale));
done:
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* Adds work by trapezoids: between two states it is the mean force times the change of displacement, pair by
 * pair. The balance at hand becomes the last one. */
pg_status break_loop_book (break_loop *b, double scale)
{
    pg_status status = PG_OK;
    if (!b->before.force) {                            /* the first state is reached from rest */
        PG_ALLOC (b->before.force, b->work_balance.npair);
        PG_ALLOC (b->before.displacement, b->work_balance.npair);
        b->before.npair = b->work_balance.npair;
    }
    for (size_t k = 0; k < b->work_balance.npair; k++) {
        double f = scale * b->work_balance.force[k], u = scale * b->work_balance.displacement[k];
        b->work += 0.5 * (b->before.force[k] + f) * (u - b->before.displacement[k]);
        b->before.force[k] = f, b->before.displacement[k] = u;
    }
    if (b->system.client) b->work += b->system.client->book (&b->system, scale);
done:
    return status;
}

pg_status break_loop_save (break_loop *b)
{
    pg_status status = PG_OK;
    size_t bytes = b->before.npair * sizeof *b->before.force;
    b->saved = 0;
    if (b->before.force && !b->start.force) {
        PG_ALLOC (b->start.displacement, b->before.npair);
        PG_ALLOC (b->start.force, b->before.npair);
        b->start.npair = b->before.npair;
    }
    if (b->before.force) {
        memcpy (b->start.force, b->before.force, bytes);
        memcpy (b->start.displacement, b->before.displacement, bytes);
    }
    b->strain0 = b->system.report->energy.strain, b->kinetic0 = b->system.report->energy.kinetic;
    if (b->grower) PG_TRY (b->grower->save (b));
    if (b->system.client) PG_TRY (b->system.client->save (&b->system));
    b->saved = 1;
done:
    if (status != PG_OK) pg_work_balance_clear (&b->start);
    return status;
}

/* Restores what break_loop_save has saved. If the first step is refused no state has been accounted for
 * yet. */
void break_loop_return (break_loop *b)
{
    size_t bytes = b->start.npair * sizeof *b->start.force;
    if (!b->saved) return;
    if (b->start.force) {
        memcpy (b->before.force, b->start.force, bytes);
        memcpy (b->before.displacement, b->start.displacement, bytes);
    } else pg_work_balance_clear (&b->before);
    if (b->grower) b->grower->restore (b);
    if (b->system.client) b->system.client->restore (&b->system);
    b->system.report->energy.strain = b->strain0, b->system.report->energy.kinetic = b->kinetic0;
}

pg_status moved_balance (break_loop *b, double t, const double *d, double scale)
{
    double work = b->work;
    pg_work_balance_clear (&b->before);
    pg_status status = break_loop_account (b, t, d, NULL, 0, scale);
    b->work = work;
    return status;
}
