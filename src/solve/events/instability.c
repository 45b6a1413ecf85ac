/* SPDX-License-Identifier: GPL-3.0-or-later
 * Instabilities: after an event of a static run, bonds or tips are over their limit at the
 * very load at which it happened. What follows is chosen by solver.on_instability:
 *   follow   the load falls until the next bond is at its limit: the path of equilibria, snap-back included
 *            (event_stepping.c, event_stepping_affine.c). No body under a controlled load does this.
 *   hold     the load stays, and the worst bonds break, one event after the other, until the body bears it:
 *            the limit of fixed load steps as they become small.
 *   dynamic  the load stays and the body moves, by Newmark's method from the displacements before the event,
 *            from rest, without the bonds that the event broke. Displacements are continuous there, and with
 *            them the reactions; what the broken bonds stored is gone.
 * The motion runs in equal time steps until no bond has broken for a while (quiet). Then it settles: mass
 * damping c = 10 / dt, beta = 1 and gamma = 3/2 (spectral radius 0 at infinite steps), dt doubled in every
 * step: inertia fades, and what is left creeps to the equilibrium u. These steps count as no time. The run is
 * static again once the energy above that equilibrium,
 *   1/2 V M V + 1/2 (d - u) K (d - u),
 * is below 1e-18 of the strain energy: forces are then continuous to about 1e-9. A bond that breaks while it
 * settles sets off the motion anew. Energy that goes without a bond having broken counts as damped, else what
 * Rayleigh's damping takes does: dt v C v at the mean velocity of the step, exact for beta = 1/4, gamma =
 * 1/2. */
#include "event_stepping.h"
#include "solve/growth/facet_growth.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PHASE_REST, PHASE_RUNNING, PHASE_SETTLING };
/* Most steps of settling; how often dt is doubled in them: by 2^16 at most, so that the mass still holds
 * nodes without bonds. */
enum { MOST_SETTLING = 45, MOST_DOUBLINGS = 16 };
static const double calm = 1e-18;                      /* share of the strain energy */
static const double at_limit = 1e-12;                  /* difference of a utilisation from 1 */

/* ---- start --------------------------------------------------------------------------------------------- */
/* Chooses the times that the scene leaves open by the fastest wave: a time step is half its time from a point
 * to the next, quiet its time through the body and back. */
static pg_status choose_times (const pg_solver *s, instability *u)
{
    pg_status status = PG_OK;
    const pg_problem *p = s->problem;
    const pg_static_options *own = PG_OWN (pg_static_options, &s->options);
    double fastest = 0, across = 0, low[3], high[3];
    for (size_t k = 0; k < p->nmaterial; k++)
        fastest = fmax (fastest, pg_material_waves (&p->material[k]).pressure);
    if (!(fastest > 0))
        PG_TRY (options_fault (&s->options, "solver.on_instability",
                               "dynamic needs the density of every material"));
    pg_problem_box (p, low, high);
    for (int k = 0; k < p->dim; k++) across += (high[k] - low[k]) * (high[k] - low[k]);
    u->dt = own->dt > 0 ? own->dt : 0.5 * p->cloud.h / fastest;
    u->quiet = own->quiet > 0 ? own->quiet : 2 * sqrt (across) / fastest;
    u->longest = own->longest > 0 ? own->longest : 50 * u->quiet;
done:
    return status;
}

/* Allocates the motion only where there may be one. */
pg_status instability_start (pg_solver *s, instability *u)
{
    pg_status status = PG_OK;
    if (s->options.on_instability != PG_UNSTABLE_DYNAMIC) goto done;
    u->scheme.system = &s->break_loop.system;
    u->scheme.setting = PG_OWN (pg_static_options, &s->options)->motion;
    u->scheme.held = 1;
    PG_TRY (choose_times (s, u));
    if (s->break_loop.growth) facet_doubt_step (&s->break_loop, u->dt);
    PG_TRY (newmark_open (&u->scheme));
    if (!u->before) PG_ALLOC (u->before, s->break_loop.system.ndof);
    if (!u->rest) PG_ALLOC (u->rest, s->break_loop.system.ndof);
    if (!u->reaction) PG_ALLOC (u->reaction, 3 * s->problem->boundary.nload);
done:
    return status;
}

void instability_free (instability *u)
{
    newmark_close (&u->scheme);
    pg_free (u->before), pg_free (u->rest), pg_free (u->reaction);
}

int instability_moves (const instability *u) { return u->phase != PHASE_REST; }

/* ---- the matrix ---------------------------------------------------------------------------------------- */
/* Sets the scheme of the present phase, a function of the phase alone, so that a run read back has the
 * same. */
static void set_scheme (const pg_solver *s, instability *u)
{
    newmark *n = &u->scheme;
    n->setting = PG_OWN (pg_static_options, &s->options)->motion;
    n->dt = u->dt, n->creeps = u->phase == PHASE_SETTLING;
    if (u->phase != PHASE_SETTLING) return;
    n->dt = ldexp (u->dt, u->settling < MOST_DOUBLINGS ? (int) u->settling : MOST_DOUBLINGS);
    n->setting.alpha = 0, n->setting.beta = 1, n->setting.gamma = 1.5;
    n->setting.rayleigh_mass = fmax (n->setting.rayleigh_mass, 10 / n->dt);
}

/* Enters a phase, which has another matrix. How systems were solved in statics and in running motion is
 * remembered. Settling goes from one to the other, and is solved as statics is. */
static void enter (pg_solver *s, instability *u, int phase)
{
    pg_system *sys = &s->break_loop.system;
    if (u->phase == PHASE_REST) u->mode[0] = sys->choice.mode;
    if (u->phase == PHASE_RUNNING) u->mode[1] = sys->choice.mode;
    u->phase = phase;
    set_scheme (s, u);
    int mode = u->mode[phase == PHASE_RUNNING];
    if (phase == PHASE_SETTLING && mode < SYSTEM_NO_FACTOR) mode = SYSTEM_FACTOR;
    system_switch (sys, mode);
}

const dynamics *instability_dynamics (instability *u)
{
    return instability_moves (u) ? newmark_matrix (&u->scheme) : NULL;
}

/* ---- holding ------------------------------------------------------------------------------------------- */
int instability_holds (pg_solver *s, instability *u, int over)
{
    if (s->options.on_instability == PG_UNSTABLE_FOLLOW) return 0;
    if (over && !u->held) s->report.unstable.count = ++u->count;
    s->report.unstable.steps += over;
    return u->held = over;
}

/* ---- into motion --------------------------------------------------------------------------------------- */
void instability_before (const pg_solver *s, instability *u, const pg_state *state)
{
    if (s->options.on_instability == PG_UNSTABLE_DYNAMIC)
        memcpy (u->before, state->d, state->ndof * sizeof *u->before);
}

/* Updates the largest change of a reaction at a switch of phases, over the largest reaction. */
static void compare_reactions (pg_solver *s, const double *before, const double *after)
{
    double size = 0, change = 0;
    for (size_t k = 0; before && after && k < 3 * s->problem->boundary.nload; k++) {
        double from = system_sum (&s->break_loop.system, before[k]),
               to = system_sum (&s->break_loop.system, after[k]);
        size = fmax (size, fmax (fabs (from), fabs (to)));
        change = fmax (change, fabs (to - from));
    }
    if (size > 0) s->report.unstable.jump = fmax (s->report.unstable.jump, change / size);
}

/* Begins a motion from the displacements before the event, with zero velocity, without the bonds that it
 * broke. */
static pg_status begin (pg_solver *s, instability *u, pg_state *state, double factor)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    memcpy (state->d, u->before, state->ndof * sizeof *state->d);
    memset (state->v, 0, state->ndof * sizeof *state->v);
    state->factor = state->time = factor;
    enter (s, u, PHASE_RUNNING);
    u->time = u->last_break = 0, u->settling = 0;
    if (!u->held) u->count++;
    u->held = 0;
    s->report.unstable.count = u->count;
    if (b->growth) PG_TRY (facet_set_off (b, state, factor, state->d));
    PG_TRY (newmark_launch (&u->scheme, state, factor));
    PG_TRY (newmark_account (&u->scheme, b, state, factor));
    if (u->scheme.force0) PG_TRY (newmark_remember (&u->scheme, factor, state));
    compare_reactions (s, s->reaction, b->work_balance.reaction);
    event_equilibrium_lost (s, state);
    events_of (s)->ended = PG_OK;
done:
    return status;
}

/* *top = largest utilisation of bonds, or of facets, in the equilibrium after the event. */
static pg_status look_at_rest (pg_solver *s, instability *u, pg_state *state, double factor, double *top)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    *top = 0;
    if (b->growth) {
        PG_TRY (event_measure (s, state));
        *top = facet_utilisation (b, state, factor - stage_start (s));
        goto done;
    }
    event_displacement (s, factor, u->rest);
    PG_TRY (b->system.force->judge (b->system.self, state, u->rest,
                                    &(pg_judging){ .utilisation = b->utilisation, .kind = b->kind }));
    *top = break_loop_largest (b, b->utilisation);
done:
    return status;
}

/* Begins a motion where there is no equilibrium after the event, or one with bonds over their limit. */
pg_status instability_after (pg_solver *s, instability *u, pg_state *state, double factor, pg_status solved,
                             int *moves)
{
    pg_status status = PG_OK;
    double top;
    *moves = 0;
    if (s->options.on_instability != PG_UNSTABLE_DYNAMIC) goto done;
    if (solved == PG_OK) {
        PG_TRY (look_at_rest (s, u, state, factor, &top));
        if (!(top > 1 + at_limit)) goto done;
    } else if (!system_no_equilibrium (solved)) PG_TRY (solved);
    *moves = 1;
    PG_TRY (begin (s, u, state, factor));
done:
    return status;
}

/* ---- in motion ----------------------------------------------------------------------------------------- */
/* Energy that Rayleigh damping dissipates in a step, J: dt v C v at the mean velocity. */
static double damped (newmark *n, const pg_state *from, const pg_state *state)
{
    double sum = 0, *mean = n->work1, *force = n->work3;
    if (n->setting.rayleigh_mass == 0 && n->setting.rayleigh_stiffness == 0) return 0;
    for (size_t i = 0; i < state->ndof; i++) mean[i] = 0.5 * (from->v[i] + state->v[i]), force[i] = 0;
    newmark_damp (n, mean, force);
    system_clear_ghosts (n->system, force);
    for (size_t i = 0; i < state->ndof; i++) sum -= n->dt * mean[i] * force[i];
    return sum;
}

/* Finds the energies after a time step and assigns the missing energy to damping or to breaking. */
static void balance_energy (pg_solver *s, instability *u, const pg_state *state, int broke, pg_step *step)
{
    break_loop *b = &s->break_loop;
    pg_statistics *r = &s->report;
    r->energy.kinetic = newmark_kinetic (&u->scheme, state->v);
    r->energy.strain = b->work_balance.strain;
    double lost = b->work - b->work0 - (r->energy.strain + r->energy.kinetic - b->stored0);
    int opening = b->growth && b->growth->motion.start.nhold > 0;
    double taken = broke || opening ? damped (&u->scheme, s->backup, state) : lost;
    /* steps of settling stop the body within one step: dt v C v is far above the energy available, and facets
     * never feed energy into the body */
    if (b->growth && u->phase == PHASE_SETTLING) taken = fmin (taken, lost);
    r->energy.damping += taken;
    step->dissipated = lost - taken;
    if (!b->growth) return;
    u->dissipated += step->dissipated, u->needed += b->growth->needed - b->growth->needed0;
}

/* Warns once, with the numbers of the last motion, where facets dissipated less than their area takes: the
 * rest is in waves as short as the spacing. */
static void compare_energies (pg_solver *s, const instability *u)
{
    static const char words[] = "in motion facets dissipate";
    pg_statistics *r = &s->report;
    size_t k = 0;
    char text[sizeof *r->warning];
    if (!(u->needed > 0) || u->dissipated > 0.8 * u->needed) return;
    snprintf (text, sizeof text,
              "%s %.3g J of the %.3g J that their area takes, and the rest goes into the motion: speeds and "
              "where cracks stop are not to be trusted; take a smaller spacing",
              words, u->dissipated, u->needed);
    while (k < r->nwarning && strncmp (r->warning[k], words, strlen (words)) != 0) k++;
    if (k < r->nwarning) memcpy (r->warning[k], text, sizeof text);
    else pg_statistics_warn (r, "%s", text);
}

/* Energy above the equilibrium u->rest, J; of a rank its share. */
static double excess (const pg_solver *s, instability *u, const pg_state *state)
{
    const pg_system *sys = &s->break_loop.system;
    double sum = 0, *z = u->scheme.work1, *Kz = u->scheme.work3;
    for (size_t i = 0; i < state->ndof; i++) z[i] = state->d[i] - u->rest[i];
    system_multiply (sys, z, Kz);
    for (size_t i = 0; i < state->ndof; i++) sum += 0.5 * z[i] * Kz[i];
    return sum + newmark_kinetic (&u->scheme, state->v);
}

/* Finds the equilibrium to settle to with the present bonds. If there is none the motion goes on, and ends
 * the run when it has lasted as long as it may. */
static pg_status try_to_settle (pg_solver *s, instability *u, pg_state *state)
{
    pg_status status = PG_OK;
    double factor = state->factor;
    int late = u->time >= u->longest;
    enter (s, u, PHASE_REST);
    pg_status solved = event_solve (s);
    if (solved == PG_OK) {
        event_displacement (s, factor, u->rest);
        u->settling = 0;
        enter (s, u, PHASE_SETTLING);
        goto done;
    }
    if (!system_no_equilibrium (solved)) PG_TRY (solved);
    event_equilibrium_lost (s, state);
    enter (s, u, PHASE_RUNNING);
    u->last_break = u->time;
    if (late) {
        pg_statistics_warn (&s->report,
                            "after event %ld, at load factor %.6g, the body moves for %.3g s without an "
                            "equilibrium to come to: it has come apart, and the run ends",
                            state->events, factor, u->time);
        s->finished = 1;
    }
done:
    return status;
}

/* Makes the run static again: the equilibrium replaces the state, from which it differs by less than rounding
 * of forces; the difference in energy counts as damped. */
static pg_status come_to_rest (pg_solver *s, instability *u, pg_state *state)
{
    pg_status status = PG_OK;
    pg_statistics *r = &s->report;
    double before = r->energy.strain + r->energy.kinetic, work = s->break_loop.work;
    memcpy (u->reaction, s->reaction, 3 * s->problem->boundary.nload * sizeof *u->reaction);
    memset (state->v, 0, state->ndof * sizeof *state->v);
    memset (state->a, 0, state->ndof * sizeof *state->a);
    compare_energies (s, u);
    enter (s, u, PHASE_REST);
    if (s->break_loop.growth) facet_rest (&s->break_loop);
    PG_TRY (event_rest (s, state, state->factor));
    r->energy.kinetic = 0;
    r->energy.damping += s->break_loop.work - work + before - r->energy.strain;
    compare_reactions (s, u->reaction, s->reaction);
done:
    return status;
}

/* Chooses the phase of the next step: the same, another one, or statics. */
static pg_status next_phase (pg_solver *s, instability *u, pg_state *state, int broke)
{
    pg_status status = PG_OK;
    if (u->phase == PHASE_RUNNING) {
        if (u->time - u->last_break >= u->quiet || u->time >= u->longest)
            PG_TRY (try_to_settle (s, u, state));
        goto done;
    }
    if (broke) {
        enter (s, u, PHASE_RUNNING);
        if (u->scheme.force0) PG_TRY (newmark_remember (&u->scheme, state->factor, state));
        goto done;
    }
    double stored = system_sum (&s->break_loop.system, s->report.energy.strain),
           above = system_sum (&s->break_loop.system, excess (s, u, state));
    if (u->settling + 1 >= MOST_SETTLING || above <= calm * stored) {
        PG_TRY (come_to_rest (s, u, state));
        goto done;
    }
    u->settling++;
    enter (s, u, PHASE_SETTLING);
done:
    return status;
}

/* Makes a time step at the present load; one in which bonds broke counts as an event. */
pg_status instability_step (pg_solver *s, instability *u, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    break_loop *b = &s->break_loop;
    double factor = state->factor;
    int arrived;
    PG_TRY (newmark_advance (&u->scheme, b, s->backup, state, factor, step));
    int broke = system_most (&b->system, (double) step->nbroken) > 0;  /* 1: bonds broke on some rank */
    balance_energy (s, u, state, broke, step);
    if (b->growth) PG_TRY (facet_show (s, state, 1));
    if (b->work_balance.reaction)
        memcpy (s->reaction, b->work_balance.reaction,
                PG_REACTIONS * s->problem->boundary.nload * sizeof *s->reaction);
    if (u->phase == PHASE_RUNNING) u->time += u->scheme.dt, s->report.unstable.time += u->scheme.dt;
    s->report.unstable.steps++;
    step->factor = step->time = factor;
    step->instability = u->count, step->motion = u->time;
    if (broke) {
        u->last_break = u->time;
        step->event = 1;
        state->events++, s->report.events++;
    }
    PG_TRY (break_loop_arrived (b, state, state->d, &arrived));
    if (arrived) {
        pg_statistics_warn (&s->report,
                            "the crack has arrived at %s in motion: the run ends at event %ld, load factor "
                            "%.6g",
                            s->options.stop_set->name, state->events, factor);
        s->finished = 1;
    }
    PG_TRY (next_phase (s, u, state, broke));
    event_limit (s, state, factor);
done:
    return status;
}

/* ---- checkpoint ---------------------------------------------------------------------------------------- */
static pg_status keep_numbers (pg_solver *s, instability *u, const pg_keeper *k)
{
    pg_statistics *r = &s->report;
    int last = s->options.on_instability == PG_UNSTABLE_DYNAMIC ? PHASE_SETTLING : PHASE_REST;
    return pg_keep_fields (
        k, "instability", "counts", "numbers", 1,
        PG_ROWS (PG_KEPT_IN (u->phase, PHASE_REST, last, "the phase of a motion"), PG_KEPT (u->held),
                 PG_KEPT (u->count), PG_KEPT_IN (u->settling, 0, MOST_SETTLING, "a step of settling"),
                 PG_KEPT_IN (u->mode, SYSTEM_UNDECIDED, SYSTEM_DIAGONAL, "the way to solve"),
                 PG_KEPT (r->unstable.count), PG_KEPT (r->unstable.steps), PG_KEPT (u->time),
                 PG_KEPT (u->last_break), PG_KEPT (r->unstable.time), PG_KEPT (r->unstable.jump),
                 PG_KEPT (u->needed), PG_KEPT (u->dissipated)));
}

pg_status instability_keep (pg_solver *s, instability *u, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (s->options.on_instability == PG_UNSTABLE_FOLLOW) return PG_OK;
    int dynamic = s->options.on_instability == PG_UNSTABLE_DYNAMIC;
    PG_TRY (keep_numbers (s, u, k));
    if (dynamic) PG_TRY (k->numbers (k->context, "instability.rest", s->break_loop.system.ndof, u->rest));
    if (u->scheme.force0)
        PG_TRY (k->numbers (k->context, "instability.force0", s->break_loop.system.ndof, u->scheme.force0));
    if (dynamic) set_scheme (s, u);
done:
    return status;
}

/* Reads what another division into ranks kept; refused while the body is in motion, as its phases and how
 * each was solved belong to one division. */
pg_status instability_moved (pg_solver *s, instability *u, const pg_keeper *k)
{
    pg_status status = PG_OK;
    if (s->options.on_instability == PG_UNSTABLE_FOLLOW) return PG_OK;
    PG_TRY (keep_numbers (s, u, k));
    if (u->phase != PHASE_REST)
        PG_FAIL (PG_E_USAGE, "an event has set the body in motion, which goes on only among as many "
                 "processes as before, until it has come to rest");
    memset (u->mode, 0, sizeof u->mode);
    u->settling = 0, u->needed = u->dissipated = 0;
done:
    return status;
}

/* ---- keys ---------------------------------------------------------------------------------------------- */
static int is (const char *text, const char *word) { return text && strcmp (text, word) == 0; }

#define ROW PG_SOLVER_KEY
static const pg_key keys[] = {
    ROW ("solver.on_instability", PG_NAME, NULL, NULL, "follow", "follow|hold|dynamic",
         "Event stepping, where bonds are over their limit after an event at an unchanged load: the load "
         "falls to where they are at it (follow: the path of equilibria, snap-back included), it stays and "
         "the worst break one after the other (hold), or it stays and the body moves, by Newmark's method, "
         "until it has come to rest (dynamic)."),
    ROW ("solver.motion.dt", PG_NUMBER, "s", "(0, inf)", "", NULL,
         "on_instability: dynamic: time step; if not given half of what the fastest wave takes from a point "
         "to the next."),
    ROW ("solver.motion.quiet", PG_NUMBER, "s", "(0, inf)", "", NULL,
         "on_instability: dynamic: after so long without a break what still moves is damped away; if not "
         "given what the fastest wave takes through the body and back."),
    ROW ("solver.motion.longest", PG_NUMBER, "s", "(0, inf)", "", NULL,
         "on_instability: dynamic: a motion that lasts longer is damped away although bonds still break, "
         "and without an equilibrium to come to it ends the run; if not given 50 times quiet."),
    ROW ("solver.motion.alpha", PG_NUMBER, "1", "[-0.3333333333333334, 0]", "-0.05", NULL,
         "on_instability: dynamic: numerical damping of Hilber, Hughes and Taylor, as solver.alpha of "
         "newmark."),
    ROW ("solver.motion.mass", PG_NAME, NULL, NULL, "lumped", "lumped|consistent",
         "on_instability: dynamic: the mass of a node's cell at the node, or int rho N_I N_J dV."),
    ROW ("solver.motion.rayleigh.mass", PG_NUMBER, "1/s", "[0, inf)", "0", NULL,
         "on_instability: dynamic: damping C = mass M + stiffness K."),
    ROW ("solver.motion.rayleigh.stiffness", PG_NUMBER, "s", "[0, inf)", "0", NULL,
         "on_instability: dynamic: damping C = mass M + stiffness K."),
};
enum { KEYS = sizeof keys / sizeof *keys };
const pg_key_table instability_keys = { "solve", keys, KEYS };

/* Checks what a motion needs: density, and a force that moves by linear systems. */
static void check_motion (const pg_problem *problem, const pg_scene *scene)
{
    const pg_force_type *force = pg_force_of (problem);
    for (size_t i = 0; i < problem->nmaterial; i++)
        if (!(problem->material[i].density > 0))
            pg_scene_fault (scene, "solver.on_instability",
                            "dynamic needs the density of material %s: give materials.%s.density, or take "
                            "hold",
                            problem->material[i].name, problem->material[i].name);
    const char *why = force && force->method.refuses
                          ? force->method.refuses (problem, PG_SOLVER_IMPLICIT | PG_SOLVER_NEEDS_DENSITY)
                          : NULL;
    if (why) pg_scene_fault (scene, "solver.on_instability", "dynamic: %s", why);
}

void instability_read (pg_solver_options *o, const pg_problem *problem, const pg_scene *scene)
{
    pg_static_options *own = PG_OWN (pg_static_options, o);
    const char *policy = pg_scene_text (scene, "solver.on_instability");
    o->on_instability = is (policy, "hold")      ? PG_UNSTABLE_HOLD
                        : is (policy, "dynamic") ? PG_UNSTABLE_DYNAMIC
                                                 : PG_UNSTABLE_FOLLOW;
    int dynamic = o->on_instability == PG_UNSTABLE_DYNAMIC;
    if (o->on_instability != PG_UNSTABLE_FOLLOW && !o->event)
        pg_scene_fault (scene, "solver.on_instability",
                        "goes with stepping: event; fixed load steps hold the load in any case");
    for (size_t k = 1; k < KEYS; k++)
        if (!dynamic && pg_scene_given (scene, "%s", keys[k].path))
            pg_scene_fault (scene, keys[k].path, "goes with on_instability: dynamic");
    if (!dynamic) return;
    if (pg_problem_removes (problem))
        pg_scene_fault (scene, "solver.on_instability",
                        "what stages remove goes slowly, through states at rest: use follow or hold");
    if (problem->dim == 3 && pg_criterion_of_tips (problem->criterion))
        pg_scene_fault (scene, "solver.on_instability",
                        "fronts in space grow in equilibrium only: use follow "
                        "or hold");
    newmark_read_setting (&own->motion, problem, scene, "solver.motion");
    own->dt = options_number (scene, "solver.motion.dt");
    own->quiet = options_number (scene, "solver.motion.quiet");
    own->longest = options_number (scene, "solver.motion.longest");
    check_motion (problem, scene);
}
