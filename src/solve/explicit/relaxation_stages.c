/* SPDX-License-Identifier: GPL-3.0-or-later
 * Stages of the load: how many there are, their keys and options. A stage that is held is relaxed until it
 * balances; with hold: off each takes one iteration. */
#include "relaxation.h"
#include "perigal/ranks.h"
#include <math.h>
#include <string.h>

/* 1: bonds can break: there is a criterion of bonds, and the force can evaluate it. */
int relaxation_breaks (const pg_solver *s)
{
    const pg_force_type *force = s->break_loop.system.force;
    return (force->motion.balance_and_break || force->judge) && pg_criterion_of_bonds (s->problem->criterion);
}

/* The smallest stretch that breaks a bond, by the criterion itself; INFINITY where the criterion is
 * another one. */
static double smallest_stretch (const pg_problem *p)
{
    double xi[3] = { p->cloud.h, 0, 0 }, eta[3] = { p->cloud.h, 0, 0 }, utilisation, s0 = INFINITY;
    pg_bond_measures m = { .n = 1, .dim = p->dim, .xi = xi, .eta = eta };
    for (size_t k = 0; k < p->nmaterial; k++) {
        const pg_criterion *c = &p->criterion[k];
        if (!c->type || c->never || c->type->needs != PG_NEEDS_STRETCH) continue;
        c->type->utilisation (c, &m, &utilisation, NULL);
        if (utilisation > 0) s0 = fmin (s0, 1 / utilisation);
    }
    return s0;
}

/* Raises the number of stages so that the sudden load of a stage does not by itself stretch bonds to their
 * limit: d_lambda |b| < 2 rho s0 h / dt^2 (Shen 2016 eqs (21), (22)), b the load per volume. */
static pg_status limit_stages (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_stages_options *own = PG_OWN (pg_stages_options, &s->options);
    motion *m = motion_of (s);
    const struct relaxation *x = m->relaxation;
    double most = 0;
    if (!m->P || !relaxation_breaks (s)) goto done;
    double s0 = smallest_stretch (s->problem);
    if (!isfinite (s0)) goto done;
    PG_TRY (s->break_loop.system.force->loads (s->break_loop.system.self, 1, m->P));
    for (size_t i = 0; i < s->break_loop.system.ndof; i++)
        if (x->mass[i] > 0) most = fmax (most, fabs (m->P[i]) / x->mass[i]);
    PG_TRY (pg_cloud_most (&s->problem->cloud, 1, &most));
    double needed = ceil (most * x->dt * x->dt / (2 * s0 * s->problem->cloud.h) * (1 - 1e-12));
    if (needed > 1e9)
        PG_TRY (options_fault (&s->options, "solver.stages",
                              "the load would need %g stages so that its mere arrival breaks no bond: it is "
                              "too large for these limits",
                              needed));
    if (needed > (double) own->stages) {
        pg_statistics_warn (&s->report,
                            "the load comes in %.0f stages instead of %ld, so that its mere arrival breaks "
                            "no bond (Shen 2016 eq (22))",
                            needed, own->stages);
        own->stages = (long) needed;
    }
done:
    return status;
}

/* ---- stages -------------------------------------------------------------------------------------------- */
pg_status relaxation_stages (pg_solver *s)
{
    pg_status status = PG_OK;
    const pg_stages_options *own = stages_of (s);
    pg_solver_options *o = &s->options;
    if (own->stages < 1) PG_FAIL (PG_E_USAGE, "%s needs a number of stages", o->kind);
    if (!(own->imbalance > 0)) PG_FAIL (PG_E_USAGE, "%s needs an imbalance to end at", o->kind);
    PG_TRY (limit_stages (s));
    o->steps = own->hold ? own->stages : 0;
    for (long n = 0; !own->hold && n < own->stages;
         n = explicit_row (s, own->stages, n))
        o->steps++;
done:
    return status;
}

/* ---- options ------------------------------------------------------------------------------------------- */
void relaxation_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    pg_stages_options *own = PG_OWN (pg_stages_options, o);
    (void) problem;
    own->stages = pg_scene_integer (scene, "solver.stages");
    own->hold = pg_scene_bool (scene, "solver.hold");
    own->imbalance = pg_scene_number (scene, "solver.imbalance");
    if (!pg_scene_given (scene, "solver.break")) o->break_mode = PG_BREAK_PASSING;
    if (!own->hold && o->break_mode != PG_BREAK_PASSING)
        pg_scene_fault (scene, "solver.break",
                        "%s goes by balanced states, which there are none with hold: off",
                        pg_scene_text (scene, "solver.break"));
}

const char *relaxation_manner (const pg_solver_options *o)
{
    return PG_OWN (pg_stages_options, o)->hold ? ", each stage iterated to equilibrium"
                                               : ", one iteration per stage";
}
