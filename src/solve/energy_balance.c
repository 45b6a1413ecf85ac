/* SPDX-License-Identifier: GPL-3.0-or-later
 * The energy balance of a run: external work is summed by trapezoids over pairs of generalised forces and
 * displacements that the force tells of the boundary (pg_work_balance), between one accounted state and the
 * next. What it exceeds strain, kinetic and damping energy by is what breaking has taken (solver.c). */
#include "contact.h"
#include "facet_growth.h"
#include <string.h>

/* Do forces in motion balance? Of equations that weigh the forces of two times, reactions are asked for once
 * more, with what these leave at the end of the step. */
static pg_status balance_in_motion (pg_system *s, double t, const double *d, const pg_work_balance *w,
                                    const dynamics *dyn)
{
    pg_status status = PG_OK;
    pg_work_balance own = { 0 };
    if (!force_balance_due (s)) return PG_OK;
    memset (s->full, 0, s->ndof * sizeof *s->full);
    dyn->resist (dyn->context, d, s->full);
    if (dyn->leave) {
        dyn->leave (dyn->context, d, s->full);
        PG_TRY (s->force->work_balance (s->self, t, d, s->full, &own));
    }
    force_balance (s, d, dyn->leave ? &own : w, s->full);
done:
    pg_work_balance_clear (&own);
    return status;
}

/* Asks the force for the work balance of the state (t, d) and adds the work since the last one. With
 * motion the reactions contain inertia and damping, which `dyn` adds, or which are in the residual that the
 * solve has left behind. */
pg_status break_loop_account (break_loop *b, double t, const double *d, const dynamics *dyn, double scale)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    if (!s->force->work_balance) return PG_OK;
    double t0 = pg_seconds ();
    if (dyn && dyn->whole && s->known && !s->options->plain && s->force->work_balance_of) {
        PG_TRY (s->force->work_balance_of (s->self, t, d, s->residual, &b->work_balance));
        PG_TRY (balance_in_motion (s, t, d, &b->work_balance, dyn));
        PG_TRY (break_loop_book (b, scale));
        goto done;
    }
    if (dyn) {
        memset (s->full, 0, s->ndof * sizeof *s->full);
        dyn->resist (dyn->context, d, s->full);
    }
    /* at rest reactions contain the forces of contact on nodes that are held */
    const double *rest = s->excavated ? s->excavated : contact_forces (s);
    PG_TRY (s->force->work_balance (s->self, t, d, dyn ? s->full : rest, &b->work_balance));
    if (dyn) PG_TRY (balance_in_motion (s, t, d, &b->work_balance, dyn));
    else force_balance (s, d, &b->work_balance, rest);
    if (!dyn) platens_reactions (s, b->work_balance.reaction);
    if (!dyn) b->work_balance.strain += contact_energy (s);
    PG_TRY (break_loop_book (b, scale));
done:
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* Accounts for the work up to a state at rest, in balance, at the cost of the boundary if the force can. */
pg_status break_loop_account_rest (break_loop *b, double t, const double *d, double scale)
{
    pg_status status = PG_OK;
    pg_system *s = &b->system;
    /* with friction half the work of the loads is not what is stored */
    if (s->problem->plain || !s->force->equilibrium_balance || contact_forces (s) || s->excavated)
        return break_loop_account (b, t, d, NULL, scale);
    double t0 = pg_seconds ();
    PG_TRY (s->force->equilibrium_balance (s->self, t, d, &b->work_balance));
    force_balance (s, d, &b->work_balance, NULL);
    PG_TRY (break_loop_book (b, scale));
done:
    s->report->seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* Trapezoids: the work between two states is the mean force times the change of displacement, pair by
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
    b->work += platens_book (&b->system, scale);
    contact_book (&b->system, scale);
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
    b->strain0 = b->system.report->energy_strain, b->kinetic0 = b->system.report->energy_kinetic;
    if (b->growth) PG_TRY (facet_save (b));
    PG_TRY (contact_save (&b->system));
    b->saved = 1;
done:
    if (status != PG_OK) pg_work_balance_clear (&b->start);
    return status;
}

/* A first step that is refused leaves no state that work was accounted for. */
void break_loop_return (break_loop *b)
{
    size_t bytes = b->start.npair * sizeof *b->start.force;
    if (!b->saved) return;
    if (b->start.force) {
        memcpy (b->before.force, b->start.force, bytes);
        memcpy (b->before.displacement, b->start.displacement, bytes);
    } else pg_work_balance_clear (&b->before);
    if (b->growth) facet_return (b);
    contact_return (&b->system);
    b->system.report->energy_strain = b->strain0, b->system.report->energy_kinetic = b->kinetic0;
}
