/* SPDX-License-Identifier: GPL-3.0-or-later
 * report.json: what the run did, under fixed keys that doc/output.md explains. Numbers are in
 * SI units; what is not known is null or missing.
 *
 *   (no key)   sizes of the problem, steps, events, iterations, work of the linear solver, energies
 *   stages     of loading: how each ended, its energies and gauges
 *   curve      peak of the load-displacement curve and its stiffnesses        (curve.c)
 *   new_crack  what the broken bonds amount to                                (crack.c)
 *   crack_length, fracture   cracks that grew by facets                       (grown_cracks.c)
 *   patch      patch test of the discretization before the first step
 *   error_estimate, error   of the last stress, and against the reference of the scene
 *   seconds    where the time went
 *   tips       cracks that were followed
 *   skipped, warnings, notes   what the solver left out and why, and what the user should know
 *
 * It is written last: a folder with a report holds a run that came to its end, or that ended
 * early for the reason in `outcome`. */
#include "results_private.h"
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Writes where the time went, s: search for neighbours, the phases of the solver, writing, estimates, and the
 * total. */
static void seconds_block (pg_json *j, const pg_result *res, const pg_statistics *r, double search,
                           double total)
{
    const pg_estimate *e = pg_result_estimate (res);
    pg_json_open (j, "seconds", '{');
    pg_json_number (j, "search", search);
    pg_json_number (j, "shape", r->seconds[PG_SECONDS_SHAPE]);
    pg_json_number (j, "assemble", r->seconds[PG_SECONDS_ASSEMBLE]);
    pg_json_number (j, "analyse", r->seconds[PG_SECONDS_ANALYSE]);
    pg_json_number (j, "factor", r->seconds[PG_SECONDS_FACTOR]);
    pg_json_number (j, "update", r->seconds[PG_SECONDS_UPDATE]);
    pg_json_number (j, "solve", r->seconds[PG_SECONDS_SOLVE]);
    pg_json_number (j, "force", r->seconds[PG_SECONDS_FORCE]);
    pg_json_number (j, "break", r->seconds[PG_SECONDS_BREAK]);
    pg_json_number (j, "write", res->progress.seconds);
    if (res->problem->quality.patch.measured)
        pg_json_number (j, "patch", res->problem->quality.patch.seconds);
    if (e) pg_json_number (j, "estimate", e->seconds);
    if (res->measured) pg_json_number (j, "error", res->errors.seconds);
    if (pg_ranks_now ()) pg_json_number (j, "messages", pg_ranks_seconds ());
    pg_json_number (j, "total", total);
    pg_json_shut (j);
}

/* Writes how often growth was unstable in event stepping with solver.on_instability: hold or dynamic, and how
 * long. */
static void instability_block (pg_json *j, const pg_result *res, const pg_statistics *r)
{
    pg_unstable policy = pg_solver_settled (res->solver)->on_instability;
    if (policy == PG_UNSTABLE_FOLLOW) return;
    pg_json_open (j, "instabilities", '{');
    pg_json_count (j, "count", (size_t) r->unstable.count);
    pg_json_count (j, "steps", (size_t) r->unstable.steps);
    if (policy == PG_UNSTABLE_DYNAMIC) {
        pg_json_number (j, "motion_time", r->unstable.time);
        pg_json_number (j, "reaction_jump", r->unstable.jump);
    }
    pg_json_shut (j);
}

/* Writes contact of crack faces: pieces, and their status in the last state; work of the last solve; for the
 * whole run: the largest overlap of a mean gap, m, right-hand sides for compliances, dense solves, changes of
 * status during solves, and seconds of all this, per event or in all. points: for short-range contact only
 * the pairs near each other, and the pairs that touch. */
static void contact_block (pg_json *j, const pg_statistics *r, int points)
{
    pg_json_open (j, "contact", '{');
    if (points) {
        pg_json_count (j, "pairs", (size_t) r->contact.pairs);
        pg_json_count (j, "touching", (size_t) r->contact.touching);
        pg_json_shut (j);
        return;
    }
    pg_json_count (j, "pieces", (size_t) r->contact.pieces);
    pg_json_count (j, "open", (size_t) r->contact.open);
    pg_json_count (j, "stick", (size_t) r->contact.stick);
    pg_json_count (j, "sliding", (size_t) r->contact.sliding);
    pg_json_count (j, "passes", (size_t) r->contact.passes);
    pg_json_count (j, "sweeps", (size_t) r->contact.sweeps);
    pg_json_count (j, "columns", (size_t) r->contact.columns);
    pg_json_count (j, "solves", (size_t) r->contact.solves);
    pg_json_count (j, "changes", (size_t) r->contact.changes);
    pg_json_number (j, "seconds", r->contact.seconds);
    pg_json_number (j, "seconds_per_event", r->contact.seconds / (double) (r->events > 0 ? r->events : 1));
    pg_json_number (j, "overlap_of_means", r->contact.overlap);
    pg_json_shut (j);
}

/* Counts evaluation points (not nodes) of a bond set that this rank owns, and the bonds of all points that it
 * owns. */
static void count_owned (const pg_problem *p, int set, double *points, double *bonds)
{
    const size_t *first = p->bonds.rows[set].family.start;
    for (size_t i = 0; i < p->bonds.rows[set].n; i++) {
        if (!pg_problem_owns (p, set, i)) continue;
        *points += set == PG_POINTS, *bonds += (double) (first[i + 1] - first[i]);
    }
}

/* Writes sizes of the problem, steps and events, the work of the solver and of the linear solver, and the
 * energies of the last state (J). */
static void run_block (pg_json *j, const pg_result *res, const pg_statistics *r, const pg_state *state)
{
    const pg_problem *p = res->problem;
    const pg_contact_setting *setting = &pg_solver_settled (res->solver)->contact;
    int contact = setting->kind != PG_CONTACT_NONE || p->boundary.nplaten,
        explicit_ = (pg_solver_settled (res->solver)->flags & PG_SOLVER_EXPLICIT) != 0,
        points = contact && (setting->search == PG_CONTACT_SHORT_RANGE || (explicit_ && p->boundary.nplaten));
    double total[4] = { (double) p->cloud.n, (double) p->bonds.first[PG_BOND_SETS], (double) state->ndof },
           evaluated = p->bonds.rows[PG_POINTS].n ? (double) p->bonds.rows[PG_POINTS].n : total[0];
    const pg_subdomain *s = p->cloud.subdomain;
    /* each point and its bonds count on the rank that owns it */
    if (s) {
        total[0] = (double) s->nowned, total[1] = 0, total[2] *= (double) s->nowned / (double) s->n;
        for (int set = 0; set < PG_BOND_SETS; set++) count_owned (p, set, &total[3], &total[1]);
        if (pg_ranks_sum (4, total) != PG_OK) total[0] = total[1] = total[2] = total[3] = 0;
        evaluated = p->form.integration && !p->form.integration->at_nodes ? total[3] : total[0];
    }
    pg_json_count (j, "points", (size_t) total[0]);
    pg_json_number (j, "finest_spacing", pg_cloud_finest (&p->cloud));
    pg_json_count (j, "bonds", (size_t) total[1]);
    pg_json_count (j, "dofs", (size_t) (total[2] + 0.5));
    pg_json_count (j, "evaluation_points", (size_t) evaluated);
    pg_json_count (j, "eroded_points", p->crack.eroded);
    pg_json_count (j, "steps", (size_t) r->steps);
    pg_json_count (j, "events", (size_t) r->events);
    pg_json_count (j, "iterations", (size_t) r->iterations);
    pg_json_count (j, "broken", (size_t) r->broken);
    pg_json_count (j, "bonds_over_limit", (size_t) r->bonds_over_limit);
    pg_json_number (j, "utilisation_max", r->utilisation_max);
    pg_json_number (j, "residual_max", r->residual_max);
    pg_json_count (j, "factorizations", (size_t) r->linear.factorizations);
    pg_json_count (j, "updates", (size_t) r->linear.updates);
    pg_json_count (j, "solves", (size_t) r->linear.solves);
    pg_json_count (j, "cg_iterations", r->linear.cg_iterations);
    pg_json_count (j, "degenerate_points", r->degenerate_points);
    if (r->degenerate_points) {
        pg_json_open (j, "degenerate_at", '[');
        for (int k = 0; k < 3; k++) pg_json_number (j, NULL, r->degenerate_at[k]);
        pg_json_shut (j);
    }
    pg_json_count (j, "unended_cells", r->unended_cells);
    pg_json_count (j, "isolated_nodes", r->isolated_nodes);
    pg_json_count (j, "fragments", r->fragments);
    pg_json_number (j, "overlap_max", r->contact.overlap_max);
    pg_json_text (j, "linear_solver", r->linear.solver);
    pg_json_text (j, "ordering", r->linear.ordering);
    pg_json_text (j, "preconditioner", r->linear.preconditioner);
    pg_json_count (j, "preconditioners", (size_t) r->linear.preconditioners);
    pg_json_number (j, "factor_entries", r->linear.factor_entries);
    pg_json_open (j, "energy", '{');
    pg_json_number (j, "strain", r->energy.strain);
    pg_json_number (j, "kinetic", r->energy.kinetic);
    pg_json_number (j, "external", r->energy.external);
    pg_json_number (j, "damping", r->energy.damping);
    pg_json_number (j, "dissipated", r->energy.dissipated);
    if (contact) pg_json_number (j, "friction", r->energy.friction);
    if (points) pg_json_number (j, "contact", r->energy.contact);
    pg_json_shut (j);
    if (contact) contact_block (j, r, points);
}

/* Writes stages of loading: how each ended, energies and openings of gauges then; a stage that the run has
 * not finished has its name alone. What a stage did itself is the difference to the one before. */
static void stages_block (pg_json *j, const pg_result *res)
{
    size_t n;
    const pg_problem *p = res->problem;
    const pg_stage_record *r = pg_solver_stages (res->solver, &n);
    if (!n) return;
    pg_json_open (j, "stages", '[');
    for (size_t k = 0; k < n; k++, r++) {
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "name", p->boundary.stage[k].name);
        if (r->done) {
            pg_json_text (j, "ended_by", r->why);
            pg_json_number (j, "share", r->share);
            pg_json_count (j, "last_step", (size_t) r->step);
            pg_json_count (j, "events", (size_t) r->events);
            if (pg_problem_grows (p)) pg_json_number (j, "crack_growth", r->growth);
            pg_json_open (j, "energy", '{');
            pg_json_number (j, "strain", r->strain);
            pg_json_number (j, "external", r->external);
            pg_json_number (j, "dissipated", r->dissipated);
            pg_json_shut (j);
            if (p->boundary.ngauge) pg_json_open (j, "gauges", '{');
            for (size_t g = 0; g < p->boundary.ngauge; g++)
                pg_json_number (j, p->boundary.gauge[g].name, r->gauge[g]);
            if (p->boundary.ngauge) pg_json_shut (j);
        }
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* Writes the files that the scene names, with their hashes. */
static void files_block (pg_json *j, const pg_result *res)
{
    char whole[PATH_MAX];
    pg_json_open (j, "files", '[');
    for (size_t k = 0; k < res->nnamed; k++) {
        const pg_named_file *f = &res->named[k];
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "key", f->key);
        pg_json_text (j, "path", realpath (f->path, whole) ? whole : f->path);
        pg_json_text (j, "sha256", f->hash);
        pg_json_shut (j);
    }
    pg_json_shut (j);
}

/* Writes the error estimate. With integration at the nodes stress recovery sees only the roughness of the
 * stress, so the estimate is called a lower bound. */
static void estimate_block (pg_json *j, const pg_result *res)
{
    const pg_estimate *e = pg_result_estimate (res);
    if (!e) return;
    pg_json_open (j, "error_estimate", '{');
    pg_json_number (j, "relative", e->relative);
    pg_json_number (j, "error", e->error);
    pg_json_number (j, "norm", e->norm);
    pg_json_text (j, "kind", res->problem->form.integration->at_nodes ? "lower bound" : "estimate");
    pg_json_count (j, "points", e->points);
    pg_json_count (j, "left_out", e->left_out);
    pg_json_shut (j);
}

/* Writes the patch test of the discretization, made before the first step; nothing if it was not measured. */
static void patch_block (pg_json *j, const pg_problem *p)
{
    if (!p->quality.patch.measured) return;
    pg_json_number (j, "patch_error", p->quality.patch.error);
    pg_json_open (j, "patch", '{');
    pg_json_text (j, "stress", pg_patch_state (p));
    pg_json_number (j, "compliance", p->quality.patch.compliance);
    pg_json_number (j, "rigid", p->quality.patch.rigid);
    pg_json_text (j, "loaded", p->quality.patch.held ? "outermost points held" : "whole surface");
    pg_json_text (j, "kind", p->quality.patch.settled ? "measured" : "lower bound");
    pg_json_count (j, "iterations", p->quality.patch.iterations);
    pg_json_shut (j);
}

/* Writes the imbalance of forces and moments, relative to the loads; nothing if it was not measured. */
static void balance_block (pg_json *j, const pg_problem *p, const pg_statistics *r)
{
    if (r->balance.states == 0) return;
    pg_json_open (j, "balance", '{');
    pg_json_number (j, "forces", r->balance.force);
    if (p->method->shape_functions) pg_json_number (j, "moments", r->balance.moment);
    pg_json_number (j, "allowed", pg_balance_allowed (r, p));
    pg_json_count (j, "states", (size_t) r->balance.states);
    pg_json_shut (j);
}

/* Writes the new crack, if any bond has broken. */
static void crack_block (pg_json *j, const pg_result *res)
{
    if (!res->crack.found) return;
    pg_json_open (j, "new_crack", '{');
    pg_json_text (j, "kind", res->tips.grows ? "facets" : "estimate");
    pg_json_number (j, "area", res->crack.area);
    if (res->problem->dim == 2) pg_json_number (j, "length", res->crack.length);
    /* relaxation: dissipated energy would contain fictitious damping */
    int damped = (pg_solver_settled (res->solver)->flags & PG_SOLVER_STAGED) != 0;
    pg_json_number (j, "dissipated_per_area", damped ? NAN : res->crack.dissipated);
    pg_json_shut (j);
}

/* Peak memory of this process, bytes; with several ranks the largest. */
static size_t peak_of_ranks (void)
{
    double peak = (double) pg_memory_process_peak ();
    return pg_ranks_ask (1, &peak) == PG_OK ? (size_t) peak : 0;
}

/* Writes the criterion in words; with several materials one text for each. */
static void criteria (pg_json *j, const pg_problem *p)
{
    char text[512] = "";
    if (!p->criterion->type) return;
    if (p->nmaterial > 1) pg_json_open (j, "criteria", '{');
    for (size_t i = 0; i < p->nmaterial; i++) {
        pg_criterion_describe (&p->criterion[i], text, sizeof text);
        pg_json_text (j, p->nmaterial > 1 ? p->material[i].name : "criterion", text);
    }
    if (p->nmaterial > 1) pg_json_shut (j);
}

/* Writes the strength that the scene asks for and the one in use where cracks begin. */
static void strengths (pg_json *j, const pg_problem *p)
{
    pg_strength s;
    int any = 0;
    for (size_t m = 0; p->criterion->type && m < p->nmaterial; m++) {
        if (!pg_strength_of (p, m, &s)) continue;
        if (!any++) pg_json_open (j, "strength", '{');
        pg_json_open (j, p->material[m].name, '{');
        if (s.asked > 0) {
            pg_json_number (j, "asked", s.asked);
            pg_json_number (j, "in_use", s.in_use);
            pg_json_number (j, "spacing_needed", s.zone / 8);
        }
        if (s.cohesion > 0) {
            pg_json_number (j, "cohesion_asked", s.cohesion);
            pg_json_number (j, "cohesion_in_use", s.cohesion_in_use);
        }
        pg_json_shut (j);
    }
    if (any) pg_json_shut (j);
}

/* Writes the properties that vary with position, for each material. */
static void variations (pg_json *j, const pg_problem *p)
{
    char text[300];
    const char *unit;
    if (!pg_variation_words (p, 0, text, sizeof text)) return;
    pg_json_open (j, "varies", '[');
    for (size_t m = 0; m < p->nmaterial; m++)
        for (int k = 0; k < PG_OF_COUNT; k++) {
            const pg_variation *v = &p->at.vary[m];
            if (!v->of[k] || !(v->most[k] > 0)) continue;
            pg_json_open (j, NULL, '{');
            pg_json_text (j, "material", p->material[m].name);
            pg_json_text (j, "key", pg_variation_name (k, &unit));
            pg_json_text (j, "unit", unit);
            pg_json_number (j, "mean", v->mean[k]);
            pg_json_number (j, "least", v->least[k]);
            pg_json_number (j, "largest", v->most[k]);
            pg_json_shut (j);
        }
    pg_json_shut (j);
}

/* Writes report.json; the file appears whole or not at all (pg_json_close). */
pg_status pg_result_json (pg_result *res, const pg_state *state, const char *failure, double search,
                       double total)
{
    pg_status status = PG_OK;
    pg_json *j = NULL;
    char path[4096], note[400];
    const pg_statistics *r = pg_solver_report (res->solver, state);
    snprintf (path, sizeof path, "%s/report.json", res->folder);
    pg_status made = pg_json_create (&j, path);        /* all ranks go on, as they exchange messages below */
    pg_json_open (j, NULL, '{');
    pg_json_text (j, "version", PG_VERSION);
    pg_json_text (j, "scene", res->scene);
    pg_json_text (j, "scene_sha256", res->hash);
    files_block (j, res);
    pg_json_text (j, "outcome", failure ? failure : "done");
    if (!failure && r->ended_by) pg_json_text (j, "ended_by", r->ended_by);
    if (pg_rank_count () > 1) {
        pg_json_count (j, "ranks", (size_t) pg_rank_count ());
        pg_json_text (j, "division", pg_ranks_now () ? "subdomains" : "matrices");
    }
    run_block (j, res, r, state);
    instability_block (j, res, r);
    stages_block (j, res);
    pg_result_curve_json (j, res);
    pg_crack_statistics_json (j, "cracks_at_start", &res->network);
    crack_block (j, res);
    pg_result_paths_json (j, res, state);
    patch_block (j, res->problem);
    balance_block (j, res->problem, r);
    estimate_block (j, res);
    seconds_block (j, res, r, search, total);
    if (res->measured) {
        pg_json_open (j, "error", '{');
        pg_errors_json (j, &res->errors);
        pg_json_shut (j);
    }
    pg_result_tips_json (j, res);
    pg_json_count (j, "peak_bytes", peak_of_ranks ());
    if (pg_rank_count () > 1) pg_result_parts_json (j, res);
    pg_json_count (j, "threads", (size_t) res->problem->threads);
    criteria (j, res->problem);
    strengths (j, res->problem);
    variations (j, res->problem);
    pg_json_open (j, "skipped", '[');
    for (size_t k = 0; k < r->nskipped; k++) {
        pg_json_open (j, NULL, '{');
        pg_json_text (j, "what", r->skipped[k].what);
        pg_json_text (j, "why", r->skipped[k].why);
        pg_json_number (j, "seconds_saved", r->skipped[k].seconds_saved);
        pg_json_shut (j);
    }
    pg_json_shut (j);
    pg_json_open (j, "warnings", '[');
    for (size_t k = 0; k < r->nwarning; k++) pg_json_text (j, NULL, r->warning[k]);
    pg_json_shut (j);
    pg_json_open (j, "notes", '[');
    for (size_t k = 0; pg_solver_note (res->problem, pg_solver_settled (res->solver), k, note, sizeof note);
         k++)
        pg_json_text (j, NULL, note);
    pg_json_shut (j);
    pg_json_shut (j);
    PG_TRY (made);
    PG_TRY (pg_json_close (&j));
done:
    if (j) pg_json_close (&j);
    return status;
}

const pg_estimate *pg_result_estimate (const pg_result *r)
{
    return r->error.estimated ? &r->error.estimate : NULL;
}
