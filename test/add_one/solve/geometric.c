/* SPDX-License-Identifier: GPL-3.0-or-later
 * A quasi-static solver: equilibria at load factors whose distance to the full load shrinks by a ratio of the
 * solver's own at every step, 1 - ratio^k, each with the break loop. */
#include "solve/run/solve.h"
#include <math.h>
#include <string.h>

typedef struct { double ratio; } PG_ALIAS options;

static void read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    (void) problem;
    PG_OWN (options, o)->ratio = pg_scene_number (scene, "solver.ratio");
    o->steps = o->levels;
}

static pg_status start (pg_solver *s, pg_state *state)
{
    return system_refresh (&s->break_loop.system, state, NULL);
}

static pg_status step (pg_solver *s, pg_state *state, pg_step *out)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    int last = state->step + 1 >= s->options.steps;
    double t = last ? 1 : 1 - pow (PG_OWN (options, &s->options)->ratio, (double) (state->step + 1));
    PG_TRY (equilibrate (b, state, t, state->d, NULL, out));
    state->factor = state->time = out->factor = out->time = t;
    s->report.energy.strain = b->work_balance.strain;
    out->dissipated = b->work - b->work0 - (b->work_balance.strain - b->stored0);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction, 3 * s->problem->boundary.nload * sizeof *s->reaction);
    out->level = 1, s->finished = last;
done:
    return status;
}

static const pg_key keys[] = {
    { .path = "solver.ratio",
      .kind = PG_NUMBER,
      .unit = "1",
      .range = "(0, 1)",
      .fallback = "0.5",
      .doc = "Share of the load that is left, over that of the step before." },
};
static const pg_key_table table = { "solve", keys, 1 };

const pg_solver_type pg_solver_geometric = {
    .name = "geometric",
    .summary = "quasi-static equilibria at load factors 1 - ratio^k",
    .flags = PG_SOLVER_STATIC,
    .keys = { &table, &solver_keys_breaking, &solver_keys_linear },
    .read = read,
    .start = start,
    .step = step,
};
