/* SPDX-License-Identifier: GPL-3.0-or-later
 * Damped relaxation with graded load (Shen 2016 section 3, corrected in theory C): rho u'' + C u' = L +
 * lambda b, with the masses of the body; C given, or from Rayleigh's quotient at every iteration, critical
 * for the lowest frequency. */
#include "relaxation.h"

static pg_status prepare (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    size_t components = (size_t) sys->components;
    PG_TRY (relaxation_create (s));
    PG_TRY (explicit_stable (s));
    struct relaxation *x = s->motion->relaxation;
    x->dt = s->options.dt;
    for (size_t i = 0; i < sys->ndof; i++) x->mass[i] = sys->mass[i];
    if (s->options.damping > 0) {
        PG_ALLOC (x->rate, sys->ndof);
        for (size_t i = 0; i < sys->ndof; i++)
            x->rate[i] = s->options.damping * s->problem->cloud.volume[i / components]
                         / sys->mass[i / components * components];
    }
    PG_TRY (relaxation_stages (s));
done:
    return status;
}

const pg_solver_type pg_solver_relax = { "relax",
                                         "quasi-static stages by damped relaxation",
                                         relaxation_start,
                                         relaxation_step,
                                         relaxation_done,
                                         relaxation_free,
                                         .way = RELAXES,
                                         .prepare = prepare,
                                         .refused = relaxation_refused,
                                         .keep = relaxation_keep,
                                         .progress = relaxation_progress };
