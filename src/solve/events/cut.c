/* SPDX-License-Identifier: GPL-3.0-or-later
 * Bonds that the caller cuts between two steps (pg_solver_cut): the force is refreshed for those that are
 * left, and what the solver derives from them is made again. */
#include "solve/contact/contact.h"
#include "event_stepping.h"
#include "solve/growth/facet_growth.h"

/* Why this solver cannot cut bonds now; NULL: it can. */
static const char *refusal (const pg_solver *s)
{
    const break_loop *b = &s->break_loop;
    if (pg_problem_grows (s->problem))
        return "cracks grow by facets here, and bonds are cut by cracks: start one in the scene (cracks)";
    if (!s->started) return NULL;
    if (b->round > 0) return "a step is under way: advance it to its end first";
    if (s->options.event)
        return "event stepping has begun, which knows the next event already: cut bonds before the first "
               "step, or use solver.stepping: fixed";
    if (s->options.contact.kind != PG_CONTACT_NONE)
        return "contact of faces has begun: cut bonds before the first step, or leave out contact";
    return NULL;
}

pg_status pg_solver_cut (pg_solver *s, pg_state *state, const pg_changes *cut)
{
    pg_status status = PG_OK;
    const char *why = refusal (s);
    if (why) PG_FAIL (PG_E_USAGE, "%s", why);
    for (size_t k = 0; k < cut->n; k++) state->alive[cut->bond[k]] = 0;
    /* before the first step: the initial state is to be examined again, as cut */
    if (!s->started) s->begun = 0;
    if (!s->started || cut->n == 0) goto done;
    PG_TRY (system_refresh (&s->break_loop.system, state, cut));
    s->follows = 0;                                    /* the copy of the state does not have these cuts */
done:
    return status;
}
