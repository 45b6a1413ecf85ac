/* SPDX-License-Identifier: GPL-3.0-or-later
 * The solver object: its steps, which may be refused, and the report of the run. */
#include "solve/growth/facet_growth.h"
#include "solve/run/body_parts.h"
#include "solve/contact/contact.h"
#include "solve/growth/trial_facet.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Creates a solver with the force of the problem; pg_solver_create_with: with a force of the caller. */
pg_status pg_solver_create (pg_solver **out, const pg_problem *problem, const pg_solver_options *options)
{
    const pg_force_type *force = pg_force_of (problem);
    if (!force) return pg_error (PG_E_USAGE, PG_HERE, "there is no force %s", problem->method->name);
    return pg_solver_create_with (out, problem, options, force);
}

/* Makes the linear system of the force, the state of the method and the copy of the last accepted state;
 * the method settles what the options leave open. */
pg_status pg_solver_create_with (pg_solver **out, const pg_problem *problem, const pg_solver_options *options,
                                 const pg_force_type *force)
{
    pg_status status = PG_OK;
    pg_solver *s = NULL;
    PG_ALLOC (s, 1);
    s->problem = problem, s->options = *options;
    s->type = pg_solver_find (options->kind);
    if (!s->type) PG_FAIL (PG_E_USAGE, "there is no solver %s", options->kind);
    const pg_method *method = &force->method;
    const char *why = method->refuses ? method->refuses (problem, s->type->flags) : NULL;
    if (why) PG_FAIL (PG_E_USAGE, "%s", why);
    s->options.flags = s->type->flags;
    PG_TRY (stages_create (s));
    problem = s->problem;
    pg_system *sys = &s->break_loop.system;
    sys->problem = problem, sys->force = force, sys->options = &s->options, sys->report = &s->report;
    pg_solver_doubts (&s->report, problem, &s->options);
    if (s->type->own_size) {
        char *own = NULL;
        PG_ALLOC (own, s->type->own_size);
        s->own = own;
    }
    PG_TRY (system_create (sys));
    PG_TRY (contact_create (sys));
    PG_TRY (facet_create (&s->break_loop, &facet_client));
    PG_ALLOC (s->reaction, PG_REACTIONS * problem->boundary.nload);
    PG_TRY (pg_state_create (&s->backup, problem, sys->components));
    if (s->type->prepare) PG_TRY (s->type->prepare (s));
    s->options.scene = NULL;                               /* pg_solver_begin sets it again */
    if (options->break_mode == PG_BREAK_ALL && problem->criterion->type)
        pg_statistics_warn (
            &s->report,
            "break: all breaks every bond over its limit at once: the peak load depends on the increment");
    *out = s;
    s = NULL;
done:
    status = options_blame (status, options, "solver");
    pg_solver_free (&s);
    return status;
}

/* Frees the solver, also one that was made in part only. What the method owns is freed first, as it may point
 * into the system of the break loop. */
void pg_solver_free (pg_solver **solver)
{
    pg_solver *s = *solver;
    if (!s) return;
    if (s->own && s->type->free) s->type->free (s);
    pg_free (s->own);
    break_loop_free (&s->break_loop);
    pg_free (s->reaction), pg_free (s->tip);
    pg_state_free (&s->backup);
    stages_free (s);
    pg_free (s);
    *solver = NULL;
}

/* Ends the run before its first step where a part of the body is free to move under loads that do not
 * balance, whatever the solver; not checked with contact or stages that remove parts, which may change
 * that. */
static pg_status check_parts (pg_solver *s, const pg_state *state)
{
    pg_system *sys = &s->break_loop.system;
    if (!(s->options.flags & PG_SOLVER_QUASI_STATIC) || sys->contact || state->step > 0
        || pg_problem_removes (s->problem))
        return PG_OK;
    pg_status status = body_parts_begin (sys, stage_end (s));
    if (status != PG_E_EQUILIBRIUM || !s->options.scene) return status;
    char text[1000];
    snprintf (text, sizeof text, "%s", pg_last_error ());
    return options_fault (&s->options, "boundary", "%s", text);
}

/* Warns where no crack can grow: facets grow from cracks, or where a strength is reached. */
static void doubt_growth (pg_solver *s, const pg_state *state)
{
    facet_growth *g = s->break_loop.growth;
    size_t nfront = 0;
    if (!g || state->step > 0 || trial_has_strength (s->problem)) return;
    pg_fronts_of_state (s->problem, state, &nfront);
    if (nfront > 0 || (state->paths && state->paths->ntip > 0)) return;
    pg_statistics_warn (&s->report, "no crack can grow: there is no crack, and no strength at which new ones "
                                    "begin: give `cracks` or failure.tensile_strength");
    g->said |= FACET_SAID_NOTHING;
}

/* Counts points with too few neighbours, isolated points and parts of the body, by the present bonds. */
static pg_status count_points (pg_solver *s)
{
    pg_system *sys = &s->break_loop.system;
    pg_statistics *r = &s->report;
    if (!sys->force->census) return PG_OK;
    pg_census left = { .at = { r->degenerate_at[0], r->degenerate_at[1], r->degenerate_at[2] } };
    pg_status status = sys->force->census (sys->self, &left);
    r->degenerate_points = left.degenerate, r->isolated_nodes = left.isolated, r->fragments = left.fragments;
    r->unended_cells = left.unended;
    memcpy (r->degenerate_at, left.at, sizeof left.at);
    return status;
}

/* Warns once of points beside cracks with too few neighbours for a strain, if there are more than in the body
 * without cracks, of which its patch test warns. */
static void tell_blind (pg_solver *s)
{
    char at[100];
    const pg_statistics *r = &s->report;
    if (s->warned_blind || r->degenerate_points <= s->problem->quality.patch.degenerate) return;
    s->warned_blind = 1;
    pg_patch_place (s->problem, r->degenerate_at, at, sizeof at);
    pg_statistics_warn (&s->report,
                        "%zu evaluation point%s beside cracks, such as that at %s, see%s too little for a "
                        "strain and carr%s no stress: a smaller spacing there helps",
                        r->degenerate_points, r->degenerate_points == 1 ? "" : "s", at,
                        r->degenerate_points == 1 ? "s" : "", r->degenerate_points == 1 ? "ies" : "y");
}

/* Warns once of points between cracks that are no evaluation point's neighbours: their displacement is not
 * determined. */
static void tell_alone (pg_solver *s)
{
    size_t n = s->report.isolated_nodes,
           known = s->problem->quality.patch.isolated + s->problem->crack.eroded;
    if (s->warned_alone || n <= known) return;
    n -= known;
    s->warned_alone = 1;
    pg_statistics_warn (&s->report,
                        "%zu point%s lie%s between cracks where no evaluation point sees %s: "
                        "%s displacement is not to be trusted; a smaller spacing there, or a lattice offset "
                        "that puts no point there, helps",
                        n, n == 1 ? "" : "s", n == 1 ? "s" : "", n == 1 ? "it" : "them",
                        n == 1 ? "its" : "their");
}

pg_status pg_solver_begin (pg_solver *s, const pg_state *state, const pg_scene *scene)
{
    pg_status status = PG_OK;
    if (s->begun) return PG_OK;
    s->options.scene = scene;
    PG_TRY (system_refresh (&s->break_loop.system, state, NULL));
    PG_TRY (contact_check (&s->break_loop.system));
    if (s->type->begin) PG_TRY (s->type->begin (s, state));
    PG_TRY (doubt_loaded_rows (s));
    doubt_growth (s, state);
    PG_TRY (check_parts (s, state));
    if (state->step == 0) {
        PG_TRY (count_points (s));
        tell_blind (s), tell_alone (s);
    }
    s->begun = 1;
done:
    status = options_blame (status, &s->options, "solver");
    s->options.scene = NULL;                               /* the scene may be gone from here on */
    return status;
}

pg_status solver_start (pg_solver *s, pg_state *state)
{
    pg_status status = PG_OK;
    if (s->started) return PG_OK;
    PG_TRY (pg_solver_begin (s, state, NULL));
    s->next_level = 1;
    if (s->type->start) PG_TRY (s->type->start (s, state));
    s->started = 1;
done:
    return status;
}

/* The largest stable time step, s, and in `from` what it was derived from; NAN where the method has no
 * such limit. */
double pg_solver_stable (const pg_solver *s, const char **from)
{
    const char *unknown = "";
    if (!from) from = &unknown;
    *from = "";
    return s->type->stable ? s->type->stable (s, from) : NAN;
}

/* Unknowns of a point: dim displacements, and rotations where the force has them. */
int pg_solver_components (const pg_solver *s) { return s->break_loop.system.components; }

const pg_force_type *pg_solver_force (const pg_solver *s, void **self)
{
    if (self) *self = s->break_loop.system.self;
    return s->break_loop.system.force;
}

/* Copies the accepted state before a step, which a refused step returns to. Alive bits are most of a
 * state, and few of them change: where the last step was accepted, only those of the bonds that it broke
 * are copied. */
static pg_status save_state (pg_solver *s, const pg_state *state)
{
    const break_loop *b = &s->break_loop;
    if (!s->follows) return pg_state_copy (s->backup, state);
    for (size_t k = 0; k < b->nbroken; k++)
        s->backup->alive[b->broken[k].bond] = state->alive[b->broken[k].bond];
    return pg_state_copy_fields (s->backup, state);
}

/* Reports shortcuts of explicit steps and of the force, by the present counts: after every step, so that a
 * checkpoint has them, even those that later steps do not use any more. */
static void report_sums (pg_solver *s)
{
    const pg_system *sys = &s->break_loop.system;
    pg_skip one;
    if (s->spared && s->evaluations) {
        snprintf (one.what, sizeof one.what, "forces and energies of %ld rows", s->spared);
        pg_statistics_skip (&s->report,
                            (double) s->spared * s->report.seconds[PG_SECONDS_FORCE]
                                / (double) s->evaluations,
                            one.what,
                            "the step before a row leaves the forces, from which work and energy follow");
    }
    int (*spared) (const void *, size_t, char *, char *, double *) = sys->force->spares.spared;
    for (size_t k = 0; spared && spared (sys->self, k, one.what, one.why, &one.seconds_saved); k++)
        pg_statistics_skip (&s->report, one.seconds_saved, one.what, one.why);
}

/* 1: the overlap to report is that of pairs of points or platens, not of crack faces. */
static int short_range (const pg_solver *s)
{
    const pg_contact_setting *c = &s->options.contact;
    return (c->kind != PG_CONTACT_NONE && c->search == PG_CONTACT_SHORT_RANGE) || s->moving;
}

const pg_load *pg_solver_loads (const pg_solver *s) { return s->problem->boundary.load; }

/* Refuses a static state in which nothing holds a part of the body. */
static pg_status check_rest (pg_solver *s, const pg_state *state)
{
    pg_system *sys = &s->break_loop.system;
    if (!(s->options.flags & PG_SOLVER_QUASI_STATIC) || s->finished) return PG_OK;
    return body_parts_check (sys, state->factor, state->d, !sys->contact);
}

/* Refuses a state whose energies are not finite on some rank; explicit steps watch the energy by
 * themselves. */
static pg_status check_numbers (pg_solver *s)
{
    pg_status status = PG_OK;
    const pg_statistics *r = &s->report;
    if (s->options.flags & PG_SOLVER_EXPLICIT) return PG_OK;
    double wrong = !isfinite (r->energy.strain + r->energy.kinetic + s->break_loop.work);
    PG_TRY (pg_cloud_most (&s->problem->cloud, 1, &wrong));
    if (wrong > 0)
        PG_FAIL (PG_E_EQUILIBRIUM,
                 "energies of the state are no finite numbers (strain %g J, motion %g J, work of the loads "
                 "%g J): next to nothing resists a part of the body, or loads are too large for it; try "
                 "another solver.linear, and tell us",
                 r->energy.strain, r->energy.kinetic, s->break_loop.work);
done:
    return status;
}

/* Advances the state by a step of the method. A failed step restores the last accepted state, with a message
 * that names the step and the load. */
pg_status pg_solver_step (pg_solver *s, pg_state *state, pg_step *step)
{
    pg_status status = PG_OK;
    memset (step, 0, sizeof *step);
    PG_TRY (solver_start (s, state));
    break_loop *b = &s->break_loop;
    b->began = b->round, b->stopped = 0;
    if (b->round == 0) {                               /* else the step goes on where it was stopped */
        b->saved = 0;
        PG_TRY (save_state (s, state));
        stage_save (s);
        PG_TRY (break_loop_save (b));
        s->follows = (s->options.flags & (PG_SOLVER_EXPLICIT | PG_SOLVER_STAGED)) && !s->options.plain;
        b->work0 = b->work, b->stored0 = s->report.energy.strain + s->report.energy.kinetic;
    }
    step->number = state->step + 1;
    PG_TRY (s->type->step (s, state, step));
    PG_TRY (check_rest (s, state));
    PG_TRY (check_numbers (s));
    state->step++;
    state->iterations += step->iterations;
    state->work = s->break_loop.work;
    /* Event steps have no time of their own (load factors fall as well as rise): they are counted
     * instead. */
    step->stamp = s->options.event ? (double) step->number : step->time;
    step->reaction = s->reaction;
    pg_statistics *r = &s->report;
    r->steps++, r->iterations += step->iterations, r->broken += (long) step->nbroken;
    r->residual_max = fmax (r->residual_max, step->residual);
    r->utilisation_max = fmax (r->utilisation_max, step->utilisation);
    report_sums (s);
    if (step->level && !pg_problem_removes (s->problem) && !short_range (s))
        contact_note_overlap (&s->break_loop.system, state);
    r->energy.external = s->break_loop.work;
    /* First law: work of loads = strain + motion + damping + what breaking has taken, the rest. */
    r->energy.dissipated = r->energy.external - r->energy.strain - r->energy.kinetic - r->energy.damping
                           - r->energy.friction - r->energy.contact;
    solver_note_turns (s, state, step);
    facet_doubt_energy (s, state, step->time);
    PG_TRY (stage_close_step (s, state, step));
done:
    if (status != PG_OK && s->started && !s->break_loop.stopped) {
        char text[2048];
        int quasi = (s->options.flags & PG_SOLVER_QUASI_STATIC);
        snprintf (text, sizeof text, "%s", pg_last_error ());
        /* fields asked for now are those of the accepted state */
        system_refresh (&s->break_loop.system, s->backup, NULL);
        /* it does not know bonds that are intact again */
        system_forget_preconditioner (&s->break_loop.system);
        s->break_loop.work = s->backup->work, s->break_loop.round = 0;
        break_loop_return (&s->break_loop);
        stage_return (s);
        if (s->type->refused) s->type->refused (s);
        s->follows = 0;
        if (status != PG_E_MEMORY)
            pg_error (status, PG_HERE, "step %ld after %s %.6g%s is refused: %s", s->backup->step + 1,
                      quasi ? "load factor" : "t =", quasi ? s->backup->factor : s->backup->time,
                      quasi ? "" : " s", text);
        pg_state_copy (state, s->backup);
    }
    return status;
}

/* The watch is called within long steps, so that a caller may write a checkpoint or stop. */
void pg_solver_watch (pg_solver *s, pg_watch watch, void *context)
{
    s->break_loop.watch = watch, s->break_loop.watching = context;
}

/* 1: the run has ended by a condition (stop set, events, failure), or the method has made all its steps. */
int pg_solver_done (const pg_solver *s, const pg_state *state)
{
    return s->finished || (s->type->done && s->type->done (s, state));
}

/* Largest displacement, m, with which the overlap of crack faces is compared. */
static double largest_displacement (const pg_solver *s, const pg_state *state)
{
    double top = 0;
    for (size_t i = 0; i < s->break_loop.system.ndof; i++) top = fmax (top, fabs (state->d[i]));
    /* where ranks fail to communicate: nothing is compared with it */
    return pg_cloud_most (&s->problem->cloud, 1, &top) == PG_OK ? top : INFINITY;
}

/* Reports work that was skipped so often. The time saved is estimated by the seconds of PG_SECONDS_FACTOR,
 * which `made` such pieces of work took. */
static void report_spared (pg_solver *s, long times, const char *what, size_t made, const char *why)
{
    char text[96];
    if (!times || !made) return;
    snprintf (text, sizeof text, what, times);
    pg_statistics_skip (&s->report,
                        (double) times * s->report.seconds[PG_SECONDS_FACTOR] / (double) made, text, why);
}

/* Reports work that was skipped, by the present counts: factors and preconditioners that were kept, and
 * residuals that the iterations carried along (each saves a loop over all bonds, and another for damping, by
 * a stored rate). */
static void report_skips (pg_solver *s)
{
    const pg_system *sys = &s->break_loop.system;
    const pg_statistics *r = &s->report;
    size_t factors = (size_t) r->linear.factorizations, preconditioners = (size_t) r->linear.preconditioners;
    report_spared (s, sys->choice.kept, "factorization after %ld break rounds", factors,
                   "only bonds broke that do not enter K (node-node bonds under Gauss integration)");
    report_spared (s, sys->updates.by_columns, "factorization after %ld events", factors,
                   "the factor of an earlier K and a dense system of the touched unknowns gave the same "
                   "answer (their time is not taken off)");
    report_spared (s, sys->choice.spared, "preconditioner in %ld solves after a break", preconditioners,
                   "that of an earlier K serves until the iterations it costs would have paid for another "
                   "(their time is not taken off)");
    report_spared (s, preconditioners ? 0 : sys->choice.spared, "factorization in %ld solves after a break",
                   factors,
                   "the factor of an earlier K preconditions conjugate gradients until a new one would pay "
                   "(their time is not taken off)");
    if (sys->choice.ways.solves) {
        char what[96];
        snprintf (what, sizeof what, "factors for %ld solves", sys->choice.ways.solves);
        pg_statistics_skip (&s->report, NAN, what,
                            "while much broke, conjugate gradients with finite elements were cheaper by "
                            "stored rates");
    }
    if (sys->iterative.rough.rounds) {
        char what[96];
        snprintf (what, sizeof what, "exact equilibria in %ld rounds of breaking",
                  sys->iterative.rough.rounds);
        pg_statistics_skip (&s->report, NAN, what,
                            "nothing of them is kept but which bonds break, and rougher ones left no doubt "
                            "of it");
    }
    if (sys->direct.forgotten)
        pg_statistics_skip (&s->report, NAN, "memory for K beside its factor",
                            "nothing breaks: one factor serves the whole run");
    if (!sys->balance.unmeasured) return;
    pg_statistics_skip (&s->report,
                        8e-9 * (double) sys->balance.unmeasured
                            * (double) s->problem->bonds.first[PG_BOND_SETS],
                        "measures of the residual",
                        "in motion iterations and breaking change it by known sums; every sixteenth was "
                        "measured");
}

/* Warns at the end where growing cracks have not dissipated what their area takes. With a few facets only a
 * wrong factor is noticed, as what broke was smaller than one of them. How facets under a large stress along
 * the crack, and closed tips, change the strain energy of a discretised body: bench/stress_along_crack.py. */
static void warn_of_facets (pg_solver *s)
{
    const pg_statistics *r = &s->report;
    double share = r->energy.fracture > 0 ? r->energy.dissipated / r->energy.fracture : 1;
    int moves = (s->options.flags & PG_SOLVER_NEEDS_DENSITY) != 0;
    int few = r->events + r->iterations < 10;
    double most = few ? 3 : 1.15, least = few ? 1.0 / 3 : 0.85;
    int pressed = s->break_loop.system.contact && s->break_loop.system.contact->ncrack;
    if (s->warned_facets || !s->finished || (few && moves) || (share < most && share > least)) return;
    pg_statistics_warn (
        &s->report, "the cracks that grew have dissipated %.3g times what their area takes: %s", share,
        pressed && share < 1
            ? "where faces press, energies (not loads) miss at each tip what the stress holds in a square of "
              "one spacing, and how loads bend within a facet; take a smaller spacing"
        : few ? "what was left ahead of them is smaller than a few spacings; take a smaller spacing"
        : moves ? "tips that start, stop or branch do so within a few facets, in which they take more or "
                "less than their share; take a smaller spacing"
        : share > 1 ? "they ran ahead of equilibrium at loads that were held, and what is too much "
                    "would be motion (stepping: event follows equilibrium where it can)"
                  : "turns, or other cracks, lie too close together for the spacing");
    s->warned_facets = 1;
}

/* Warns once where results are doubtful: breaking that fed in energy, where it should take some (rounding and
 * iterations leave less open than 1e-6 of the work of loads); crack faces that overlap by more than a
 * thousandth of the largest displacement. Told once. */
static void warn_at_end (pg_solver *s, const pg_state *state)
{
    if (!s->warned_energy && s->report.broken > 0
        && s->report.energy.dissipated < -1e-6 * s->report.energy.external) {
        pg_statistics_warn (&s->report,
                            "breaking has fed %.3g J into the body instead of dissipating energy (external "
                            "work %.3g J): %s",
                            -s->report.energy.dissipated, s->report.energy.external,
                            s->break_loop.growth
                                ? "facets in motion that touch, or are cut near other cracks, give more back "
                                  "than they take"
                                : "single bonds are not an objective measure of fracture");
        s->warned_energy = 1;
    }
    warn_of_facets (s);
    if (s->finished && !s->warned_balance) {
        force_balance_warn (&s->report, s->problem);
        s->warned_balance = 1;
    }
    if (s->finished) platens_tell (&s->break_loop.system);
    if (!s->warned_overlap && !short_range (s)
        && s->report.contact.overlap_max > 1e-3 * largest_displacement (s, state)) {
        pg_statistics_warn (&s->report, "crack faces overlap by up to %.3g m (%s)",
                            s->report.contact.overlap_max,
                            s->options.contact.kind == PG_CONTACT_NONE
                                ? "contact is not modelled: contact.kind"
                                : "contact holds the means over pieces of two spacings apart");
        s->warned_overlap = 1;
    }
}

/* Statistics at any time, with numbers that are found from the state: isolated points, parts, overlap of
 * crack faces. */
const pg_statistics *pg_solver_report (pg_solver *s, const pg_state *state)
{
    pg_system *sys = &s->break_loop.system;
    if (count_points (s) != PG_OK)
        pg_statistics_warn (&s->report,
                            "points that see too little, points alone and parts of the body could not be "
                            "counted: %.120s",
                            pg_last_error ());
    if (s->break_loop.growth) tell_blind (s), tell_alone (s);
    if (!pg_problem_removes (s->problem) && !short_range (s)) contact_note_overlap (sys, state);
    s->report.contact.overlap_max = system_most (sys, s->report.contact.overlap_max);
    report_skips (s);
    report_sums (s);
    warn_at_end (s, state);
    return &s->report;
}

const pg_solver_options *pg_solver_settled (const pg_solver *s) { return &s->options; }

const pg_statistics *pg_solver_report_now (const pg_solver *s) { return &s->report; }

/* Sums over the ranks, once, at the end of a run. */
pg_status pg_solver_share_report (pg_solver *s)
{
    pg_status status = PG_OK;
    pg_statistics *r = &s->report;
    double sum[] = { r->energy.strain, r->energy.kinetic, r->energy.external, r->energy.damping,
                     r->energy.dissipated, (double) r->broken };
    if (!system_is_shared (&s->break_loop.system) || s->shared) return PG_OK;
    PG_TRY (pg_cloud_sum (&s->problem->cloud, sizeof sum / sizeof *sum, sum));
    r->energy.strain = sum[0], r->energy.kinetic = sum[1], r->energy.external = sum[2];
    r->energy.damping = sum[3], r->energy.dissipated = sum[4], r->broken = (long) sum[5];
    s->shared = 1;
done:
    return status;
}
