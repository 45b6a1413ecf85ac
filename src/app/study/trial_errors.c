/* SPDX-License-Identifier: GPL-3.0-or-later
 * Errors of a trial against the reference of its scene. */
#include "trial.h"
#include <math.h>

/* The error of all tables together: root of the summed squares over that of the reference; NAN
 * without a reference above zero. Displacements only, since these have one unit. */
static double of_lines (const pg_errors *e)
{
    double difference = 0, reference = 0;
    for (size_t k = 0; k < e->nline; k++) {
        const pg_line_norms *line = &e->line[k];
        if (line->column > 2) continue;
        difference += line->l2.difference * line->l2.difference,
            reference += line->l2.reference * line->l2.reference;
    }
    return reference > 0 ? sqrt (difference / reference) : NAN;
}

/* Copies the errors into a trial; those that were not measured stay NAN. */
void pg_trial_take (pg_trial *t, const pg_errors *e)
{
    if (e->norms.displacement)
        t->value[PG_TRIAL_L2] = e->norms.l2.relative, t->value[PG_TRIAL_MAXIMUM] = e->norms.maximum.relative;
    if (e->norms.stress) t->value[PG_TRIAL_ENERGY] = e->norms.energy.relative;
    if (e->nline) t->value[PG_TRIAL_LINES] = of_lines (e);
}

/* Measures the errors of a state; dynamic = 1: expressions of the reference take the time, else the load
 * factor. */
pg_status pg_trial_errors (pg_trial *t, const pg_scene *scene, const pg_problem *problem, pg_solver *solver,
                        const pg_state *state, int dynamic)
{
    pg_status status = PG_OK;
    pg_reference *reference = NULL;
    pg_sampler value = { 0 };
    pg_errors errors = { 0 };
    void *self;
    const pg_force_type *force = pg_solver_force (solver, &self);
    PG_TRY (pg_reference_read (&reference, scene, problem));
    PG_TRY (pg_scene_verdict (scene));
    if (!reference) goto done;
    PG_TRY (pg_sampler_solution (&value, problem, force, self, state));
    PG_TRY (pg_errors_measure (&errors, reference, problem, &value, dynamic ? state->time : state->factor));
    pg_trial_take (t, &errors);
done:
    pg_errors_clear (&errors);
    pg_sampler_clear (&value);
    pg_reference_free (&reference);
    return status;
}
