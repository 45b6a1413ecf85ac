/* SPDX-License-Identifier: GPL-3.0-or-later
 * Damped relaxation with graded load (Shen 2016 section 3, corrected in theory C): rho u'' + C u' = L +
 * lambda b, with the masses of the body; C given, or from Rayleigh's quotient at every iteration, critical
 * for the lowest frequency. */
#include "relaxation.h"

/* Takes the masses of the body, and the time step from them; damping is given per volume, or found by
 * Rayleigh's quotient. */
static pg_status prepare (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    size_t components = (size_t) sys->components;
    PG_TRY (relaxation_create (s));
    PG_TRY (explicit_stable (s));
    struct relaxation *x = motion_of (s)->relaxation;
    x->dt = s->options.dt;
    for (size_t i = 0; i < sys->ndof; i++) x->mass[i] = sys->mass[i];
    if (PG_OWN (pg_stages_options, &s->options)->damping > 0) {
        PG_ALLOC (x->rate, sys->ndof);
        for (size_t i = 0; i < sys->ndof; i++)
            x->rate[i] = PG_OWN (pg_stages_options, &s->options)->damping
                         * s->problem->cloud.volume[i / components] / sys->mass[i / components * components];
    }
    PG_TRY (relaxation_stages (s));
done:
    return status;
}

static void read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    relaxation_read (o, problem, scene);
    o->dt = options_number (scene, "solver.dt");
    PG_OWN (pg_stages_options, o)->damping = options_number (scene, "solver.damping");
}

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    ROW ("solver.damping", PG_NUMBER, "kg/m^3/s", "(0, inf)", "", NULL,
         "Artificial damping C; from the lowest frequency in every iteration (Rayleigh's quotient) if not "
         "given."),
};
static const pg_key_table table = { "solve", keys, sizeof keys / sizeof *keys };

const pg_solver_type pg_solver_relax = {
    .name = "relax",
    .summary = "quasi-static stages by damped relaxation",
    .flags = PG_SOLVER_QUASI_STATIC | PG_SOLVER_STAGED | PG_SOLVER_NEEDS_DENSITY | PG_SOLVER_CONTACT
             | PG_SOLVER_RANKS,
    .keys = { &table, &solver_keys_step, &solver_keys_stages, &solver_keys_breaking },
    .read = read,
    .prepare = prepare,
    RELAXATION_ENTRIES,
};
