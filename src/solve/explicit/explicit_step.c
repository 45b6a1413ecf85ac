/* SPDX-License-Identifier: GPL-3.0-or-later
 * Explicit time steps (theory B4, G4): leapfrog with velocities at half steps, written as velocity Verlet or
 * as central differences. The energies are those that the method conserves: kinetic m v(n-1/2) v(n+1/2) / 2,
 * work by trapezoids, damping dt c m v_n^2; they add up to rounding while nothing breaks, so that the rest is
 * what breaking dissipates. */
#include "solve/contact/contact.h"
#include "explicit.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <string.h>

/* unknowns of a block; time steps between two checks for numbers that are not finite */
enum { BLOCK = 2048, LOOK = 8 };

/* Sum of eight lanes, always in the same order: it rounds alike with every instruction set. */
double lane_sum (const pg_eight *lanes)
{
    const pg_eight s = *lanes;
    return ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
}

/* a . b over a range, in eight lanes. Versions for several processors are made of functions used in one file
 * only: GCC would export the names of others from the library. */
PG_WIDEST static double dot (const double *a, const double *b, size_t first, size_t last)
{
    pg_eight s = { 0 };
    size_t i = first;
    for (; i + 8 <= last; i += 8) s += *(const pg_eight *) (a + i) * *(const pg_eight *) (b + i);
    for (; i < last; i++) s[0] += a[i] * b[i];
    return lane_sum (&s);
}

double lane_dot (const double *a, const double *b, size_t first, size_t last)
{
    return dot (a, b, first, last);
}

/* Returns 0, or NaN when a number is not finite: 0 * x is 0 for every finite x and NaN otherwise, so that one
 * sum tells, without a branch. */
PG_WIDEST static double not_finite (const double *d, size_t first, size_t last)
{
    pg_eight s = { 0 };
    size_t i = first;
    for (; i + 8 <= last; i += 8) s += 0 * *(const pg_eight *) (d + i);
    for (; i < last; i++) s[0] += 0 * d[i];
    return lane_sum (&s);
}

double lane_not_finite (const double *d, size_t first, size_t last) { return not_finite (d, first, last); }

/* The largest absolute value of a range; NaN is skipped. */
static double lane_most (const double *a, size_t first, size_t last)
{
    double s[8] = { 0 };
    size_t i = first;
    for (; i + 8 <= last; i += 8)
        for (size_t k = 0; k < 8; k++) {
            double size = fabs (a[i + k]);
            s[k] = size > s[k] ? size : s[k];
        }
    for (; i < last; i++) s[0] = fmax (s[0], fabs (a[i]));
    for (size_t k = 1; k < 8; k++) s[0] = fmax (s[0], s[k]);
    return s[0];
}

/* ---- how many steps ------------------------------------------------------------------------------------ */
/* Finds the number of time steps from `end` and `dt`, or `end` from that number; dt is shortened so that the
 * last step ends at solver.end. steps: rows of history.csv, which are the steps of the caller. */
static pg_status count_steps (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_solver_options *o = &s->options;
    if (o->end > 0) {
        double steps = o->time_steps > 0 ? (double) o->time_steps : ceil (o->end / o->dt * (1 - 1e-12));
        if (steps > 1e9)
            PG_TRY (options_fault (o, "solver.end", "%g time steps of %.4g s are too many", steps, o->dt));
        o->time_steps = (long) steps;
        o->dt = o->end / steps;
    } else o->end = o->dt * (double) o->time_steps;
    if (o->time_steps < 1) PG_FAIL (PG_E_USAGE, "%s needs solver.end or solver.time_steps", o->kind);
    o->steps = 0;
    for (long n = 0; n < o->time_steps; n = explicit_row (s, o->time_steps, n)) o->steps++;
done:
    return status;
}

/* Sets the time step and the number of steps before the run begins, so that a plan can show them. */
pg_status explicit_prepare (pg_solver *s)
{
    pg_status status = PG_OK;
    PG_TRY (explicit_create (s));
    PG_TRY (explicit_contact_create (s));
    PG_TRY (explicit_stable (s));
    PG_TRY (count_steps (s));
done:
    return status;
}

/* Time after n steps, s; the last step ends exactly at solver.end. */
static double time_at (const pg_solver *s, long n)
{
    return n == s->options.time_steps ? s->options.end : (double) n * s->options.dt;
}

/* ---- half kicks of all unknowns ------------------------------------------------------------------------ */
/* look 1: check whether all displacements are finite */
typedef struct { half_kicks w; kick_range range; size_t ndof; double *sum; int look, fast; } kicking;

/* Works on blocks of unknowns in one thread: work of loads before and after, half kicks, check for numbers
 * that are not finite, in one pass over memory. */
static void work_on_blocks (void *context, size_t first, size_t last, int thread)
{
    const kicking *c = context;
    const half_kicks *w = &c->w;
    (void) thread;
    for (size_t b = first; b < last; b++) {
        size_t i = b * BLOCK, end = i + BLOCK < c->ndof ? i + BLOCK : c->ndof;
        double *sum = c->sum + b * SUMS;
        if (w->closing && w->P) sum[SUM_A] = lane_dot (w->P, w->v, i, end);
        c->range (w, i, end, sum);
        if (w->opening && w->P) sum[SUM_B] = lane_dot (w->P, w->v, i, end);
        sum[SUM_BAD] = w->opening && c->look ? lane_not_finite (w->d, i, end) : 0;
        if (w->opening && c->fast) sum[SUM_FAST] = lane_most (w->v, i, end);
    }
}

/* Work of loads and supports over one half of a step, J: loads times velocity (at half steps, `loads` being
 * the sum) and external forces on prescribed unknowns times their motion. */
static double push_work (const pg_solver *s, double loads, const double *from, const double *to)
{
    const motion *m = motion_of (s);
    double sum = s->options.dt * loads;
    for (size_t k = 0; k < m->nprescribed; k++) sum += m->push[k] * (to[k] - from[k]);
    return 0.5 * sum;
}

/* Largest change of an unknown in the step that was begun, m. */
static double furthest (const pg_solver *s)
{
    const motion *m = motion_of (s);
    double most = 0;
    for (size_t b = 0; b < m->nblock; b++) most = fmax (most, m->sum[b * SUMS + SUM_FAST]);
    most *= s->options.dt;
    for (size_t k = 0; k < m->nprescribed; k++) most = fmax (most, fabs (m->next[k] - m->goal[k]));
    /* rounding of the sum is far smaller than the margin of the neighbour search */
    return most * (1 + 1e-9);
}

/* Does the half kicks of all unknowns, closing, opening or both, and sums what they mean for energies: work
 * of loads and supports, energy taken by damping, kinetic energy. */
static pg_status move (pg_solver *s, pg_state *state, kick_range range, int closing, int opening, int look)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    double t0 = pg_seconds (), total[SUMS], c = PG_OWN (pg_explicit_options, &s->options)->rayleigh_mass,
           dt = s->options.dt;
    kicking all = { { state->d, state->v, state->a, sys->balance.residual, m->inverse, sys->mass, m->P,
                     m->only, dt,
                       c, closing, opening },
                     range,
                     sys->ndof,
                     m->sum,
                     look,
                     m->contact != NULL };
    if (opening && !closing) explicit_release (s, state);
    pg_parallel (s->problem->threads, m->nblock, work_on_blocks, &all);
    explicit_total (s, total);
    if (closing) {
        if (!m->by_work_balance) s->break_loop.work += push_work (s, total[SUM_A], m->before, m->goal);
        m->resist = total[SUM_D];
        m->damped += 0.5 * dt * c * total[SUM_C];
        s->report.energy.kinetic = 0.5 * total[SUM_K];
        for (size_t k = 0; k < m->nprescribed; k++)
            s->report.energy.kinetic += 0.5 * sys->mass[m->prescribed[k]] * (m->goal[k] - m->before[k])
                                        * (m->next[k] - m->goal[k]) / (dt * dt);
    }
    if (opening) {
        if (!m->by_work_balance) s->break_loop.work += push_work (s, total[SUM_B], m->goal, m->next);
        m->damped += 0.5 * dt * c * m->resist;
        for (size_t k = 0; k < m->nprescribed; k++) state->d[m->prescribed[k]] = m->next[k];
        total[SUM_BAD] += lane_not_finite (m->next, 0, m->nprescribed);
        if (m->contact) m->contact->way = furthest (s);
        if (system_is_shared (sys)) {                  /* all ranks end together, at the end of the row */
            m->bad += total[SUM_BAD] != 0;
            PG_TRY (system_exchange (sys, state->d));
        } else if (total[SUM_BAD] != 0) PG_FAIL (PG_E_EQUILIBRIUM, "not finite");
    }
done:
    s->report.seconds[PG_SECONDS_SOLVE] += pg_seconds () - t0;
    return status;
}

/* Sets velocity and acceleration of prescribed unknowns by differences of three times, for fields and
 * checkpoints: at the half step where the method keeps velocities there (staggered), else central at t_n. */
static void show_prescribed (const pg_solver *s, pg_state *state, int staggered)
{
    const motion *m = motion_of (s);
    double dt = s->options.dt;
    for (size_t k = 0; k < m->nprescribed; k++) {
        size_t i = m->prescribed[k];
        state->v[i] = staggered ? (m->next[k] - m->goal[k]) / dt : (m->next[k] - m->before[k]) / (2 * dt);
        state->a[i] = ((m->next[k] - m->goal[k]) - (m->goal[k] - m->before[k])) / (dt * dt);
    }
}

/* Finds the external force on prescribed unknowns, N: what their mass and acceleration need beside the
 * internal force and the loads; their residual becomes 0. */
static void take_reactions (pg_solver *s)
{
    motion *m = motion_of (s);
    const pg_system *sys = &s->break_loop.system;
    double dt = s->options.dt;
    for (size_t k = 0; k < m->nprescribed; k++) {
        size_t i = m->prescribed[k];
        m->left[k] = sys->balance.residual[i];
        m->push[k] = sys->mass[i] * (((m->next[k] - m->goal[k]) - (m->goal[k] - m->before[k])) / (dt * dt))
                     - sys->balance.residual[i] + (m->P ? m->P[i] : 0);
        sys->balance.residual[i] = 0;
    }
}

/* Looks at moving crack tips where that is due, with velocities and accelerations at t_n (inside a step
 * those of the state are half a step behind). Bonds that are cut are held, so that the present forces stay
 * valid. */
static pg_status run_tips (pg_solver *s, pg_state *state, double t)
{
    pg_status status = PG_OK;
    const motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    double dt = s->options.dt, c = PG_OWN (pg_explicit_options, &s->options)->rayleigh_mass;
    int any;
    if (!facet_due (b, dt)) return PG_OK;
    memcpy (sys->balance.full, state->v, sys->ndof * sizeof *sys->balance.full);
    for (size_t i = 0; i < sys->ndof; i++) {
        state->a[i] = sys->balance.residual[i] * m->inverse[i] - c * state->v[i];
        state->v[i] += 0.5 * dt * state->a[i];
    }
    PG_TRY (facet_move (b, state, t, state->d, &b->growth->motion.top, &any));
    if (any) state->events++, s->report.events++;
done:
    memcpy (state->v, sys->balance.full, sys->ndof * sizeof *sys->balance.full);
    return status;
}

/* Finds the forces at t_n, which d has reached; supports move on to t_n+1. */
static pg_status arrive (pg_solver *s, pg_state *state, long n)
{
    pg_status status = PG_OK;
    double t = time_at (s, n);
    break_loop *b = &s->break_loop;
    if (b->growth && n > 0) facet_forward (b, s->options.dt);
    PG_TRY (explicit_force (s, state, t, 1, NULL));
    if (n > 0) PG_TRY (explicit_follow (s, time_at (s, n - 1), t, (double) (n + 1) * s->options.dt));
    system_add_held (&b->system, b->system.balance.residual);
    PG_TRY (explicit_contact_add (s, state, t, n == 0));
    if (b->growth && n > 0) PG_TRY (run_tips (s, state, t));
    take_reactions (s);
done:
    return status;
}

/* ---- work_balance -------------------------------------------------------------------------------------- */
/* Force of inertia and damping on unknown i, N, for reactions: -m (a + c v), with the velocity brought from
 * the half step to t_n; prescribed unknowns are not damped. */
static double inertia_of (const pg_solver *s, const pg_state *state, int staggered, int prescribed, size_t i)
{
    double c = PG_OWN (pg_explicit_options, &s->options)->rayleigh_mass,
           half = staggered ? 0.5 * s->options.dt : 0, v = state->v[i] - half * state->a[i];
    return -s->break_loop.system.mass[i] * (state->a[i] + (prescribed ? 0 : c * v));
}

/* Finds the work balance of the force at the state. Its last evaluation was at this state, so that the
 * residual is reused, with reactions put back meanwhile; a force that cannot use it, and a plain run,
 * evaluate the force again. */
static pg_status measure_work (pg_solver *s, const pg_state *state, double t, int staggered)
{
    pg_status status = PG_OK;
    const motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    pg_system *sys = &b->system;
    /* forces of contact of crack faces; these and contact by search exclude each other */
    const double *contact = sys->balance.pressed;
    int searched = explicit_contact_active (s),
        spare = !s->options.plain && !b->growth && !contact && !searched;
    for (size_t i = 0; !spare && i < sys->ndof; i++) sys->balance.full[i] =
        inertia_of (s, state, staggered, 0, i);
    for (size_t k = 0; k < m->nprescribed; k++) {
        size_t i = m->prescribed[k];
        sys->balance.full[i] = inertia_of (s, state, staggered, 1, i);
        if (spare) sys->balance.residual[i] = m->left[k];
    }
    for (size_t i = 0; contact && i < sys->ndof; i++) sys->balance.full[i] += contact[i];
    if (searched) explicit_contact_forces (s, sys->balance.full);
    system_add_held (sys, sys->balance.full);
    s->spared += spare;
    pg_known known = { .inertia = sys->balance.full, .residual = spare ? sys->balance.residual : NULL };
    status = sys->force->work (sys->self, t, state->d, &known, &b->work_balance);
    for (size_t k = 0; spare && k < m->nprescribed; k++) sys->balance.residual[m->prescribed[k]] = 0;
    b->work_balance.strain += contact_energy (sys);
    return status;
}

/* Checks the balance of all forces, with inertia and contact on nodes. */
static void measure_balance (pg_solver *s, const pg_state *state, int staggered)
{
    const motion *m = motion_of (s);
    pg_system *sys = &s->break_loop.system;
    const double *contact = sys->balance.pressed;
    if (!force_balance_due (sys)) return;
    for (size_t i = 0; i < sys->ndof; i++) sys->balance.full[i] = inertia_of (s, state, staggered, 0, i);
    for (size_t k = 0; k < m->nprescribed; k++)
        sys->balance.full[m->prescribed[k]] = inertia_of (s, state, staggered, 1, m->prescribed[k]);
    for (size_t i = 0; contact && i < sys->ndof; i++) sys->balance.full[i] += contact[i];
    if (explicit_contact_active (s)) explicit_contact_forces (s, sys->balance.full);
    system_add_held (sys, sys->balance.full);
    force_balance (sys, state->d, &s->break_loop.work_balance, sys->balance.full);
}

/* Finds the work balance, inertia being part of the reactions; book 1: adds the work since the last
 * account. */
static pg_status account (pg_solver *s, pg_state *state, double t, int staggered, int book)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double t0 = pg_seconds ();
    if (!b->system.force->work) return PG_OK;
    PG_TRY (measure_work (s, state, t, staggered));
    if (book) PG_TRY (break_loop_book (b, 1));
    s->report.energy.strain = b->work_balance.strain;
done:
    s->report.seconds[PG_SECONDS_FORCE] += pg_seconds () - t0;
    return status;
}

/* ---- a run --------------------------------------------------------------------------------------------- */
/* Begins a run: d and v as given but for the supports; prescribed unknowns whose velocity changes get a
 * force. Energy at the start counts as work done. */
static pg_status begin (pg_solver *s, pg_state *state, int staggered)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    pg_system *sys = &s->break_loop.system;
    double dt = s->options.dt, c = PG_OWN (pg_explicit_options, &s->options)->rayleigh_mass, kinetic = 0;
    system_clear_ghosts (sys, state->v);
    PG_TRY (explicit_follow (s, 0, 0, dt));
    for (size_t k = 0; k < m->nprescribed; k++) {
        size_t i = m->prescribed[k];
        state->d[i] = m->goal[k];
        m->before[k] = m->goal[k] - dt * state->v[i];
        state->v[i] = 0;
    }
    PG_TRY (system_exchange (sys, state->d));
    PG_TRY (arrive (s, state, 0));
    m->resist = 0;
    for (size_t i = 0; i < sys->ndof; i++) {
        double v = state->v[i], a = state->a[i] = sys->balance.residual[i] * m->inverse[i] - c * v;
        if (staggered) state->v[i] = v + 0.5 * dt * a;
        m->resist += sys->mass[i] * v * (v + 0.5 * dt * a);
        kinetic += 0.5 * sys->mass[i] * (v - 0.5 * dt * a) * (v + 0.5 * dt * a);
    }
    for (size_t k = 0; k < m->nprescribed; k++)
        kinetic += 0.5 * sys->mass[m->prescribed[k]] * (m->goal[k] - m->before[k]) * (m->next[k] - m->goal[k])
                   / (dt * dt);
    show_prescribed (s, state, staggered);
    kinetic += explicit_contact_kinetic (s);
    s->report.energy.kinetic = kinetic;
    PG_TRY (account (s, state, 0, staggered, 1));
    s->break_loop.work = s->report.energy.strain + kinetic;
done:
    return status;
}

/* Calls the caller's function in the middle of a step, between rows; it may end the step there. */
static pg_status look (pg_solver *s, pg_state *state, pg_step *step, long n)
{
    break_loop *b = &s->break_loop;
    step->nbroken = b->nbroken, step->broken = b->broken;
    step->time = time_at (s, n), step->iterations = b->round;
    b->stopped = 1;
    pg_status status = b->watch (b->watching, state, step);
    if (status == PG_OK) b->stopped = 0;
    return status;
}

/* Refuses a run whose energy grows without work: broken bonds may stiffen a body (non-ordinary theories with
 * few neighbours), so that the time step is no longer stable. */
static pg_status check_growth (pg_solver *s, const pg_state *state, double t)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    /* In an unstable step leapfrog's kinetic energy becomes negative, so that the sum stays as it was; so it
     * does in a stable step just below the limit, before anything has broken. */
    double sum[4] = { s->report.energy.kinetic, s->report.energy.strain, s->break_loop.work,
                      (double) state->broken };
    PG_TRY (pg_cloud_sum (&s->problem->cloud, 4, sum));
    double stored = sum[1] + (sum[3] > 0 ? fmax (0, sum[0]) : sum[0]);
    m->most = fmax (m->most, fabs (sum[2]));
    if ((s->problem->boundary.nload == 0 || s->break_loop.system.force->work) && stored > 10 * m->most)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "the energy of the body has grown to %.3g J at t = %.6g s, while %.3g J of work were done: "
                 "breaking has made "
                 "parts of the body stiffer, which feeds energy into it or makes the time step unstable; try "
                 "a smaller solver.dt, solver.kind: newmark, or "
                 "method.force: bond, whose bonds only ever soften it",
                 stored, t, m->most);
done:
    return status;
}

/* Ranks: counts the steps of the row in which a bond broke on any of them; a state that is not finite on one
 * ends the run on all. The energies of the report stay those of this rank; those of a row are summed when it
 * is written (app/results/history.c). */
static pg_status share_row (pg_solver *s, pg_state *state, long n)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    size_t steps = (size_t) (n - state->iterations) + 1;
    double any[2] = { m->bad, 0 };
    if (!system_is_shared (&s->break_loop.system)) return PG_OK;
    PG_TRY (explicit_room (m, steps));
    PG_TRY (pg_cloud_most (&s->problem->cloud, steps, m->broke));
    PG_TRY (pg_cloud_most (&s->problem->cloud, 2, any));
    for (size_t k = 0; k < steps; k++) state->events += m->broke[k] > 0, s->report.events += m->broke[k] > 0;
    memset (m->broke, 0, m->nbroke * sizeof *m->broke);
    m->bad = 0;
    if (any[0] > 0) {
        double local = lane_not_finite (state->d, 0, state->ndof);
        if (local != 0) PG_TRY (explicit_lost (s, state, time_at (s, n)));
        PG_FAIL (PG_E_EQUILIBRIUM, "a displacement on another rank is no longer finite at t = %.6g s",
                 time_at (s, n));
    }
done:
    return status;
}

/* Finds what a row reports: energies and what breaking has dissipated (work less stored, kinetic and damped
 * energy, over the step), reactions, whether a level or an end is reached. */
static pg_status close_step (pg_solver *s, pg_state *state, pg_step *step, long n, int staggered)
{
    pg_status status = PG_OK;
    motion *m = motion_of (s);
    break_loop *b = &s->break_loop;
    const pg_statistics *r = &s->report;
    double t = time_at (s, n);
    int breaks = (b->system.force->motion.balance_and_break || b->system.force->judge)
                 && s->problem->criterion->type;
    PG_TRY (share_row (s, state, n));
    if (!m->by_work_balance) PG_TRY (account (s, state, t, staggered, 0));
    measure_balance (s, state, staggered);
    s->report.energy.damping = m->damped;
    explicit_contact_show (s);
    PG_TRY (check_growth (s, state, t));
    step->dissipated = b->work - b->work0 - (r->energy.strain + r->energy.kinetic - b->stored0)
                       - (m->damped - m->damped0) - explicit_contact_took (s);
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction,
                PG_REACTIONS * s->problem->boundary.nload * sizeof *s->reaction);
    state->time = step->time = t;
    state->factor = step->factor = t / s->options.end;
    step->level = explicit_level (s, s->options.time_steps, n);
    step->nbroken = b->nbroken, step->broken = b->broken;
    step->utilisation = b->growth ? b->growth->motion.top : breaks ? NAN : 0;
    if (b->growth) PG_TRY (facet_show (s, state, 1));
    if (b->system.contact) contact_count (&b->system);
    PG_TRY (contact_show (&b->system, 1));
    PG_TRY (explicit_end (s, state, n == s->options.time_steps, "t =", t));
done:
    return status;
}

/* Advances by a row of history.csv: many time steps. Half kicks are joined into one pass over memory wherever
 * the state in between is not used. */
pg_status explicit_step (pg_solver *s, pg_state *state, pg_step *step, kick_range range, int staggered)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    motion *m = motion_of (s);
    long n = state->iterations + b->round, last = explicit_row (s, s->options.time_steps, state->iterations);
    int closed = 1;
    if (b->round == 0) {
        b->nbroken = 0;
        m->damped0 = m->damped, m->resist0 = m->resist;
        PG_TRY (explicit_contact_save (s));
        if (n == 0) PG_TRY (begin (s, state, staggered));
        if (m->nprescribed) memcpy (m->push0, m->push, m->nprescribed * sizeof *m->push);
    }
    if (!m->fresh)
        PG_TRY (explicit_follow (s, time_at (s, n - 1), time_at (s, n), (double) (n + 1) * s->options.dt));
    while (n < last) {
        /* A number that is not finite stays so: checking is enough now and then, and before the state is
         * used. */
        int looks = s->options.plain || (n + 1) % LOOK == 0 || n + 1 == last || (n + 1) % m->between == 0;
        pg_status now = move (s, state, range, !closed, 1, looks);
        if (now != PG_OK) PG_TRY (explicit_lost (s, state, time_at (s, n + 1)));
        b->round = ++n - state->iterations;
        PG_TRY (arrive (s, state, n));
        int due = b->watch && n % m->between == 0 && n < last;
        closed = n == last || due || m->by_work_balance;
        if (!closed) continue;
        PG_TRY (move (s, state, range, 1, 0, 0));
        show_prescribed (s, state, staggered);
        if (m->by_work_balance) PG_TRY (account (s, state, time_at (s, n), staggered, 1));
        if (due) PG_TRY (look (s, state, step, n));
    }
    step->iterations = b->round;
    PG_TRY (close_step (s, state, step, n, staggered));
    b->round = 0;
done:
    return status;
}

/* Takes back a refused row, and what was summed in it. */
void explicit_refused (pg_solver *s)
{
    motion *m = motion_of (s);
    m->damped = m->damped0, m->resist = m->resist0;
    explicit_contact_return (s);
    if (m->nprescribed) memcpy (m->push, m->push0, m->nprescribed * sizeof *m->push);
    if (m->nbroke) memset (m->broke, 0, m->nbroke * sizeof *m->broke);
    m->fresh = 0;
}

/* 1: all time steps are done, those of an interrupted row included. */
int explicit_done (const pg_solver *s, const pg_state *state)
{
    return state->iterations + s->break_loop.round >= s->options.time_steps;
}

double explicit_progress (const pg_solver *s, const pg_state *state)
{
    return (double) (state->iterations + s->break_loop.round) / (double) s->options.time_steps;
}

/* ---- options ------------------------------------------------------------------------------------------- */
/* Reads the keys of solver that explicit methods have in common; what they cannot do is a fault. */
void explicit_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    PG_OWN (pg_explicit_options, o)->rayleigh_mass = pg_scene_number (scene, "solver.rayleigh.mass");
    if (strcmp (pg_scene_text (scene, "solver.mass"), "consistent") == 0)
        pg_scene_fault (scene, "solver.mass", "%s needs the lumped mass", o->kind);
    if (pg_scene_number (scene, "solver.rayleigh.stiffness") > 0)
        pg_scene_fault (
            scene, "solver.rayleigh.stiffness",
            "%s is damped by the mass alone: damping by the stiffness would shrink the stable time step",
            o->kind);
    options_read_times (o, problem, scene);
}
