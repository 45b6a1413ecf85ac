/* SPDX-License-Identifier: GPL-3.0-or-later
 * The stable time step of explicit methods: 2 / omega, omega the largest frequency of the body. The force may
 * know an upper bound of omega in closed form or from the row sums of K; else it is measured (spectrum.c),
 * from below within 1 %. If not given the step is 0.9 of the stable one, which leaves room for what
 * breaking may stiffen. Where facets cut shape functions it is 0.45: points between two branches keep few
 * neighbours, and what was measured to be stable there is 0.52 to 0.68 of the step of the body without
 * them; and with springs of short-range contact, where leapfrog's energy is out by what a pair moves in the
 * step in which it closes or opens: at 0.9 that is some 5 in a thousand of the energy of small bodies that
 * collide, at 0.45 less than 1. */
#include "solve/contact/contact.h"
#include "explicit.h"
#include <math.h>

/* The largest frequency of the body and of short-range contact together, from above: K and the stiffness of
 * contact are both positive, so that the largest eigenvalue of their sum is at most the sum of theirs. */
static double with_contact (const pg_solver *s, double omega)
{
    struct explicit_contact *c = motion_of (s)->contact;
    if (c) c->bare = omega;
    return sqrt (omega * omega + explicit_contact_rate (s));
}

/* Finds an upper bound of the largest frequency where the force has one; else the frequency itself, from
 * below within 1 %. */
static pg_status find_bound (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    pg_system *sys = &s->break_loop.system;
    int exact = !sys->force->motion.bound && !sys->force->motion.row_sums;
    if (!sys->force->motion.bound || sys->contact) PG_TRY (system_refresh (sys, s->backup, NULL));
    PG_TRY (pg_force_bound (sys->force, sys->self, &s->problem->cloud, sys->ndof, sys->mass,
                            sys->balance.full,
                            &m->omega, &m->from));
    if (exact) PG_TRY (pg_solver_fastest (s, s->backup, &m->omega));
    PG_TRY (pg_cloud_most (&s->problem->cloud, 1, &m->omega));
    /* closed faces may be stiffer than the bonds that the bound counts in their place */
    m->omega *= sqrt (contact_stiffer (sys));
    if (!isfinite (m->omega))
        PG_FAIL (PG_E_SCENE, "the largest frequency of the body is not finite: check stiffness and density");
    double whole = with_contact (s, m->omega);         /* each rank has only the contact of its own points */
    PG_TRY (pg_cloud_most (&s->problem->cloud, 1, &whole));
    m->stable = whole > 0 ? (exact ? 0.99 : 1) * 2 / whole : INFINITY;
done:
    return status;
}

/* Refuses a time step that is too large: above the bound the frequency itself, measured, decides. */
static pg_status check_dt (pg_solver *s)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    double omega;
    if (s->options.dt <= m->stable) goto done;
    if (pg_ranks_now ())
        PG_TRY (options_fault (&s->options, "solver.dt",
                              "%.6g s is too large: steps up to %.4g s are stable for certain, and ranks do "
                              "not measure how much longer they may be",
                              s->options.dt, m->stable));
    PG_TRY (pg_solver_fastest (s, s->backup, &omega));
    omega = with_contact (s, sys->contact ? fmax (omega, m->omega) : omega);
    double limit = omega > 0 ? 0.99 * 2 / omega : INFINITY;
    if (s->options.dt <= limit) goto done;
    const pg_scene *scene = s->options.scene;
    /* the step is solver.end divided by solver.time_steps */
    if (scene && !pg_scene_given (scene, "solver.dt"))
        PG_TRY (options_fault (&s->options, "solver.time_steps",
                              "steps of %.6g s are too large: explicit steps are stable up to %.4g s (2 / "
                              "largest frequency); take at least %.0f, "
                              "or leave solver.time_steps out",
                              s->options.dt, limit, ceil (s->options.end / limit)));
    PG_TRY (options_fault (&s->options, "solver.dt",
                          "%.6g s is too large: explicit steps are stable up to %.4g s (2 / largest "
                          "frequency); take at most that, or leave "
                          "solver.dt out",
                          s->options.dt, limit));
done:
    return status;
}

/* 1: contact acts by springs, of pairs or of platens. */
static int springs_close (const motion *m)
{
    return m->contact && (!m->contact->back || m->contact->platens);
}

/* ---- the stable time step ------------------------------------------------------------------------------ */
pg_status explicit_stable (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->break_loop.system;
    motion *m = motion_of (s);
    for (size_t i = 0; i < sys->ndof; i++) {
        if (!(sys->mass[i] > 0))
            PG_TRY (options_fault (&s->options, "solver.kind",
                                  "%s needs mass at every point: give the material a density",
                                  s->type->name));
        m->inverse[i] = 1 / sys->mass[i];
        m->only = i == 0 || m->inverse[i] == m->only ? m->inverse[i] : 0;
    }
    PG_TRY (find_bound (s));
    if (s->options.dt > 0) PG_TRY (check_dt (s));
    else if (isfinite (m->stable))
        s->options.dt = (springs_close (m)
                                 || (s->break_loop.growth && s->problem->method->shape_functions) ? 0.45
                                                                                                  : 0.9)
                        * m->stable;
    else
        PG_TRY (options_fault (&s->options, "solver.dt",
                              "nothing resists, so that any time step is stable: give solver.dt"));
done:
    return status;
}

double explicit_bound (const pg_solver *s, const char **from)
{
    const motion *m = motion_of (s);
    if (m->from) *from = m->from;
    return m->from ? m->stable : NAN;
}
