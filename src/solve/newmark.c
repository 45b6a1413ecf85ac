/* SPDX-License-Identifier: GPL-3.0-or-later
 * Newmark's method with the break loop inside each step (Cui 2022 eqs (21)-(26), corrected in theory F5): with
 * b0 = 1/(beta dt^2), b1 = 1/(beta dt), b2 = 1/(2 beta), b3 = gamma/(beta dt), b4 = gamma/beta, b5 = dt (gamma/(2 beta) - 1),
 *   A = b0 dU - b1 V - (b2 - 1) A_t,   V = b3 dU + (1 - b4) V_t - b5 A_t,
 *   Khat = (1 + b3 c_K) K + (b0 + b3 c_M) M,   R = P - F_int - M A - C V,   C = c_M M + c_K K. */
#include "solve.h"
#include <math.h>
#include <string.h>

typedef struct { double b[8]; } coefficients;

static coefficients coefficients_of (const pg_solver_options *o)
{
    double dt = o->dt, be = o->beta, ga = o->gamma;
    return (coefficients) { { 1 / (be * dt * dt), 1 / (be * dt), 1 / (2 * be), ga / (be * dt), ga / be, dt * (ga / (2 * be) - 1), dt * (1 - ga), ga * dt } };
}

void pg_newmark_coefficients (const pg_solver_options *o, double *b)
{
    coefficients c = coefficients_of (o);
    memcpy (b, c.b, sizeof c.b);
}

typedef struct { pg_solver *s; const pg_state *from; coefficients c; } motion;

static void rates (const motion *m, const double *d, size_t i, double *v, double *a)
{
    const pg_state *f = m->from;
    const double *b = m->c.b;
    double du = d[i] - f->d[i];
    *a = b[0] * du - b[1] * f->v[i] - (b[2] - 1) * f->a[i];
    *v = b[3] * du + (1 - b[4]) * f->v[i] - b[5] * f->a[i];
}

/* residual -= M A + C V */
static void add_inertia (void *context, const double *d, double *residual)
{
    const motion *m = context;
    pg_system *sys = &m->s->breaker.system;
    double *velocity = m->s->work1, *Kv = m->s->work2, cm = m->s->options.rayleigh_mass, ck = m->s->options.rayleigh_stiffness, a;
    for (size_t i = 0; i < sys->ndof; i++) {
        rates (m, d, i, &velocity[i], &a);
        residual[i] -= sys->mass[i] * (a + cm * velocity[i]);
    }
    if (ck == 0) return;
    const pg_operator *K = sys->force->operator_ (sys->self);
    K->apply (K->context, velocity, Kv);
    for (size_t i = 0; i < sys->ndof; i++) residual[i] -= ck * Kv[i];
}

/* M a = R at rest: the start in equilibrium of forces. */
static pg_status newmark_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    pg_system *sys = &s->breaker.system;
    double reference;
    PG_TRY (system_refresh (sys, state, NULL));
    s->next_level = 1;
    if (state->step > 0) goto done;
    for (size_t i = 0; i < sys->ndof; i++)
        if (!(sys->mass[i] > 0)) PG_FAIL (PG_E_USAGE, "newmark needs mass at every point: give the material a density");
    PG_TRY (sys->force->balance (sys->self, state->time, state->d, sys->residual, &reference));
    for (size_t i = 0; i < sys->ndof; i++) state->a[i] = sys->residual[i] / sys->mass[i];
done:
    return status;
}

static pg_status newmark_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    breaker *b = &s->breaker;
    pg_system *sys = &b->system;
    motion m = { s, s->backup, coefficients_of (&s->options) };
    dynamics dyn = { 1 + m.c.b[3] * s->options.rayleigh_stiffness, m.c.b[0] + m.c.b[3] * s->options.rayleigh_mass, add_inertia, &m };
    double t = state->step + 1 >= s->options.steps ? s->options.end : (double) (state->step + 1) * s->options.dt;
    double work = b->work, stored = s->report.energy_strain + s->report.energy_kinetic;
    PG_TRY (equilibrate (b, state, t, state->d, &dyn, step));
    s->report.energy_kinetic = 0;
    for (size_t i = 0; i < sys->ndof; i++) {
        double v, a;
        rates (&m, state->d, i, &v, &a);
        state->v[i] = v, state->a[i] = a;
        s->report.energy_kinetic += 0.5 * sys->mass[i] * v * v;
    }
    s->report.energy_strain = b->ledger.strain;
    step->dissipated = b->work - work - (s->report.energy_strain + s->report.energy_kinetic - stored);
    if (b->ledger.reaction) memcpy (s->reaction, b->ledger.reaction, 3 * s->problem->nload * sizeof *s->reaction);
    state->time = step->time = t;
    state->factor = step->factor = t / s->options.end;
    while ((double) s->next_level / (double) s->options.levels <= step->factor * (1 + 1e-12)) s->next_level++, step->level = 1;
    int arrived;
    PG_TRY (breaker_arrived (b, state, state->d, &arrived));
    if (arrived) pg_report_warn (&s->report, "the crack has arrived at %s: the run ends at t = %.6g s", s->options.stop_set->name, t);
    if (arrived || state->step + 1 >= s->options.steps) s->finished = 1;
done:
    return status;
}

const pg_solver_type pg_solver_newmark = { "newmark", "implicit dynamics, Newmark's method", newmark_start, newmark_step, NULL, NULL };
