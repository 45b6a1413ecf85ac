/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal run: scene -> problem -> solver -> steps -> result folder. What happens where:
 *   scene/keys/load.c, scene/document.c             the file: a tree of checked values
 *   app/cli/preparation/prepare.c, command.c        problem and solver of the scene
 *   mechanics/catalogue.c, mechanics/model/problem.c  body, points, laws, loads; then bonds (bonds.c)
 *   solve/solver.c                                  the solver, its steps; patch_test.c before the first
 *   solve/static.c, solve/events/event_stepping.c   one step at rest: fixed, or to the next event
 *   solve/breaking/break_loop.c                     break, renew, solve again until nothing breaks
 *   solve/system/refinement.c, choice.c             one linear solve
 *   mechanics/galerkin/galerkin.c                   forces, matrix, what bonds show (or mechanics/bonds)
 *   app/results/result.c, history.c, json.c         the files of the result
 *
 * A run can end early in three ways: interrupted by a signal, stopped by a failure (no
 * equilibrium, no memory, a full disk), or killed. In the first two a checkpoint is written,
 * if anything had been done, the results so far are finished with the reason in report.json,
 * and where going on can help the command for it is printed; after the third the last
 * checkpoint and all complete steps are there.
 *
 * Where ranks share the run (perigal-mpi) each passes through here; rank 0 speaks. What one of them meets
 * between steps is told to all, so that they go on or end together. */
#include "app/cli/preparation/cli.h"
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Prints what the solver did: time steps, stages, or steps with solves, by its kind; for explicit runs also
 * the energy balance. */
static void print_counts (const pg_statistics *r, const pg_solver_options *o)
{
    if ((o->flags & PG_SOLVER_EXPLICIT))
        printf ("  %ld time steps in %ld rows of history.csv, %ld of them broke bonds, %ld bonds broken",
                r->iterations, r->steps, r->events, r->broken);
    else if ((o->flags & PG_SOLVER_STAGED))
        printf ("  %ld %s, %ld iterations, %ld of them broke bonds, %ld bonds broken, largest imbalance %.2e",
                PG_OWN (pg_stages_options, o)->hold ? r->steps : r->iterations, "stages", r->iterations,
                r->events, r->broken, r->residual_max);
    else
        printf ("  %ld steps, %ld events, %ld break rounds, %ld bonds broken, %ld factorizations, %ld "
                "solves\n  largest residual %.2e, largest utilisation "
                "of an accepted state %.6f",
                r->steps, r->events, r->iterations, r->broken, r->linear.factorizations, r->linear.solves,
                r->residual_max, r->utilisation_max);
    printf (", %zu degenerate points, %zu fragments\n", r->degenerate_points, r->fragments);
    if (r->linear.cg_iterations && !(o->flags & PG_SOLVER_EXPLICIT) && !(o->flags & PG_SOLVER_STAGED))
        printf ("  %zu iterations of conjugate gradients%s%s%s\n", r->linear.cg_iterations,
                *r->linear.preconditioner ? ", preconditioner " : "", r->linear.preconditioner,
                r->linear.preconditioners > 1 ? ", rebuilt as bonds broke" : "");
    if ((o->flags & PG_SOLVER_EXPLICIT))
        printf (
            "  energy: external work %.4g J = strain %.4g + kinetic %.4g + damping %.4g + breaking %.4g J\n",
            r->energy.external, r->energy.strain, r->energy.kinetic, r->energy.damping, r->energy.dissipated);
}

/* Prints how often cracks grew unstably, without more load, and how the run treated it (output of
 * solver.on_instability). */
static void print_instabilities (const pg_statistics *r, const pg_solver_options *o)
{
    if (o->on_instability == PG_UNSTABLE_HOLD)
        printf ("  growth went on by itself %ld times: %ld of %ld events at a held load\n", r->unstable.count,
                r->unstable.steps, r->events);
    if (o->on_instability == PG_UNSTABLE_DYNAMIC)
        printf ("  growth went on by itself %ld times, in motion: %ld time steps, %.4g s, %.4g J damped; "
                "reactions jump by at most %.1e where motion begins and ends\n",
                r->unstable.count, r->unstable.steps, r->unstable.time, r->energy.damping, r->unstable.jump);
}

/* Prints the summary of a run: work, peak and crack, estimated error, times, reference, what was skipped,
 * warnings, files. */
static void print_summary (const pg_result *result, const pg_statistics *r, const pg_solver_options *o,
                           const pg_problem *problem, const pg_statistics *early, double total)
{
    int nodal = problem->form.integration->at_nodes;
    print_counts (r, o);
    print_instabilities (r, o);
    char row[400];
    for (size_t k = 0; pg_result_words (result, k, row, sizeof row); k++) printf ("  %s\n", row);
    const pg_estimate *e = pg_result_estimate (result);
    if (e)
        printf ("  estimated error of the stress: %s%.2g %% in the energy norm, %zu of %zu points left out "
                "(%.2g s)\n",
                nodal ? "more than " : "", 100 * e->relative, e->left_out, e->points + e->left_out,
                e->seconds);
    printf ("  %.2f s: shape functions and assembly %.2f, analysis %.2f, factorization %.2f, solve %.2f, "
            "forces %.2f, bond failure %.2f; peak memory %.0f MB\n",
            total,
            r->seconds[PG_SECONDS_SHAPE] + r->seconds[PG_SECONDS_ASSEMBLE] + r->seconds[PG_SECONDS_UPDATE],
            r->seconds[PG_SECONDS_ANALYSE], r->seconds[PG_SECONDS_FACTOR], r->seconds[PG_SECONDS_SOLVE],
            r->seconds[PG_SECONDS_FORCE], r->seconds[PG_SECONDS_BREAK],
            (double) pg_memory_process_peak () * 1e-6);
    for (size_t k = 0;
         pg_result_errors (result) && pg_errors_row (pg_result_errors (result), k, row, sizeof row); k++)
        printf ("  %s%s\n", k ? "" : "against the reference: ", row);
    for (size_t k = 0; pg_result_tip (result, k, row, sizeof row); k++) printf ("  crack %s\n", row);
    for (size_t k = 0; k < r->nskipped; k++)
        printf ("  skipped: %s (%s)\n", r->skipped[k].what, r->skipped[k].why);
    for (size_t m = 0; m < problem->nmaterial; m++) {
        pg_strength s;
        if (!pg_problem_grows (problem) || !pg_strength_of (problem, m, &s) || !(s.asked > 0)) continue;
        printf ("  strength of %s: %.4g Pa asked for, %.4g Pa in use where cracks begin\n",
                problem->material[m].name, s.asked, s.in_use);
    }
    plan_warnings (r, early);
    if (pg_rank_count () > 1 && !pg_ranks_now () && !r->linear.factorizations)
        printf ("  warning: no matrix was factored: all %d ranks did the same work, one would do; "
                "solver.linear: petsc factors on all of them\n", pg_rank_count ());
    printf ("  results in %s: %s history.csv events.csv%s report.json\n", pg_result_folder (result),
            pg_result_fields (result), !pg_problem_grows (problem) ? "" : problem->dim == 3
                                       ? " cracks.csv fronts.csv" : " cracks.csv tips.csv");
    for (size_t k = 0; k < pg_result_pictures (result); k++)
        printf ("  picture %s\n", pg_result_picture (result, k));
}

/* What `look` and `advance` need during a run; within = 1: the run ended in the middle of a step. */
typedef struct {
    pg_result *result;
    pg_state *state;
    const pg_problem *problem;
    const pg_solver *solver;
    progress shown;
    /* statistics before the first step, with their warnings */
    pg_statistics early;
    int within;
    int alone;                                         /* 1: it failed where other ranks cannot know */
} watched;

/* Writes a checkpoint; if that fails the run continues with the older one, and a message says so. */
static void keep_now (const watched *w)
{
    if (pg_result_checkpoint (w->result, w->state) != PG_OK && pg_rank () == 0)
        fprintf (stderr, "perigal: no checkpoint: %s\n", pg_last_error ());
}

/* Shows the progress. */
static void show (watched *w, const pg_step *step)
{
    pg_progress at;
    pg_solver_progress (w->solver, w->state, &at);
    progress_show (&w->shown, &at, step, pg_solver_report_now (w->solver), w->within);
}

/* Asks all ranks: stop 1 if any of them shall stop, due 1 if a checkpoint is due on any, so that all do the
 * same. A single process asks itself. */
static pg_status ask_all (const watched *w, int *stop, int *due)
{
    pg_status status = PG_OK;
    double any[2] = { run_asked_to_stop () != 0, pg_result_due (w->result) };
    PG_TRY (pg_ranks_ask (2, any));
    *stop = any[0] > 0, *due = any[1] > 0;
done:
    return status;
}

/* Called between the break rounds of a step: writes a stage if one is due, shows progress, ends the run if a
 * signal asked for that, writes a checkpoint if one is due. w->within = 1 says to `advance` that this
 * function ended the step. */
static pg_status look (void *context, const pg_state *state, const pg_step *so_far)
{
    pg_status status = PG_OK;
    watched *w = context;
    int stop, due;
    w->within = 1;
    PG_TRY (ask_all (w, &stop, &due));
    PG_TRY (pg_result_stage (w->result, state, so_far));
    show (w, so_far);
    if (stop)
        PG_FAIL (PG_E_INTERRUPTED, "interrupted in step %ld after %ld break rounds", so_far->number,
                 so_far->iterations);
    if (due) keep_now (w);
    w->within = 0;                                     /* still 1 if this function has ended the step */
done:
    return status;
}

/* Makes all steps. A step that failed, but not in `look`, was rolled back, so that the state is that of its
 * start. */
static pg_status advance (pg_solver *solver, watched *w, int quiet)
{
    pg_status status = PG_OK;
    pg_state *state = w->state;
    pg_step step;
    int stop, due;
    w->solver = solver;
    progress_start (&w->shown, quiet, pg_solver_settled (solver));
    pg_solver_watch (solver, look, w);
    while (!pg_solver_done (solver, state)) {
        PG_TRY (ask_all (w, &stop, &due));
        if (stop)
            PG_FAIL (PG_E_INTERRUPTED, "interrupted after step %ld, load factor %.6g", state->step,
                     state->factor);
        status = pg_solver_step (solver, state, &step);
        if (status != PG_OK && !w->within) pg_result_refused (w->result);
        /* failures of conjugate gradients occur on all ranks alike */
        w->alone = status != PG_OK && status != PG_E_INTERRUPTED && status != PG_E_EQUILIBRIUM
                   && status != PG_E_NOT_SPD && !w->within;
        PG_TRY (status);
        PG_TRY (pg_ranks_agree (pg_result_step (w->result, state, &step)));
        PG_TRY (ask_all (w, &stop, &due));
        if (due) keep_now (w);
        show (w, &step);
    }
done:
    progress_end (&w->shown);
    return status;
}

/* Writes a checkpoint of a run that did not come to its end; 1 if there is a checkpoint now, even an older
 * one. A run that has done nothing needs none. */
static int keep_for_later (const watched *w)
{
    if (w->state->step == 0 && !w->within) return 0;   /* nothing has been done yet */
    return pg_result_checkpoint (w->result, w->state) == PG_OK || pg_result_kept (w->result);
}

/* Opens a new result, or resumes one; --force first discards what an unfinished run left. With another number
 * of threads the last digits may differ, and a message says so. */
static pg_status open_result (const command *c, const char *folder, const pg_scene *scene,
                              const pg_problem *problem, pg_solver *solver, watched *w)
{
    pg_status status = PG_OK;
    pg_resumed from;
    if (c->force) PG_TRY (pg_result_discard (folder));
    if (!c->resume) return pg_result_open (&w->result, folder, scene, problem, solver);
    PG_TRY (pg_result_resume (&w->result, folder, scene, problem, solver, w->state, &from));
    if (!w->result) {
        if (pg_rank () == 0)
            fprintf (stderr, "perigal: the run in %s ended before its first checkpoint: it begins anew\n",
                     folder);
        return pg_result_open (&w->result, folder, scene, problem, solver);
    }
    if (from.threads != problem->threads)
        fprintf (stderr,
                 "perigal: the checkpoint was written with %d threads, now there are %d: the last digits may "
                 "differ\n",
                 from.threads, problem->threads);
    if (from.ranks != pg_rank_count () && pg_rank () == 0)
        fprintf (stderr,
                 "perigal: the checkpoint was written by %d process%s, now there %s %d: the last digits may "
                 "differ\n",
                 from.ranks, from.ranks > 1 ? "es" : "", pg_rank_count () > 1 ? "are" : "is",
                 pg_rank_count ());
    if (!c->quiet)
        printf ("  continuing after step %ld%s, %.0f s after the start\n", from.step,
                from.rounds ? " in the middle of the next one" : "", from.seconds);
done:
    return status;
}

/* Prints on stderr, at the end, why the run ended, each reason once, and the command that continues it where
 * that is possible. */
static void tell_outcome (const command *c, pg_status outcome, const char *failure, pg_status written,
                          const char *fault, int kept)
{
    int ended_early = outcome == PG_E_INTERRUPTED || outcome == PG_E_FILE || outcome == PG_E_MEMORY;
    if (pg_rank () > 0) return;
    if (outcome != PG_OK) command_complain (outcome, failure);
    if (written != PG_OK && (outcome == PG_OK || strcmp (failure, fault) != 0))
        command_complain (written, fault);
    if (kept && (outcome == PG_OK || ended_early)) command_again (c);
    else if (outcome == PG_E_INTERRUPTED)
        fprintf (stderr, "perigal: nothing had been computed yet: the same command begins anew\n");
}

/* Makes all steps, finishes the results and prints the summary. A checkpoint of a failed run comes before the
 * results are finished, since a full disk may prevent that. search: seconds of building; start: when the run
 * began, s. */
static pg_status run_to_the_end (const command *c, pg_solver *solver, watched *w, double search, double start)
{
    char failure[4096] = "", fault[4096];
    pg_status outcome = advance (solver, w, c->quiet), status;
    int kept = 0, failed = outcome != PG_OK;
    if (failed) snprintf (failure, sizeof failure, "%s", pg_last_error ());
    if (w->alone && pg_rank_count () > 1) {            /* all other ranks wait for this one */
        fprintf (stderr, "perigal: rank %d: %s\n", pg_rank (), failure);
        if (pg_result_kept (w->result)) command_again (c);
        return outcome;
    }
    if (failed) kept = keep_for_later (w);
    status = pg_result_finish (w->result, w->state, failed ? failure : NULL, search, pg_seconds () - start);
    snprintf (fault, sizeof fault, "%s", pg_last_error ());
    if (status != PG_OK && !failed) kept = keep_for_later (w);
    if (status == PG_OK && !c->quiet)
        print_summary (w->result, pg_solver_report_now (solver), pg_solver_settled (solver), w->problem,
                       &w->early, pg_seconds () - start);
    if (c->quiet) plan_quiet_warnings (pg_solver_report_now (solver), &w->early);
    tell_outcome (c, outcome, failure, status, fault, kept);
    return failed ? outcome : status;
}

/* All parts of a run; freed in reverse order. */
typedef struct {
    command    c;
    preparation p;
    char       folder[4096];                           /* result folder */
    watched    w;
    int        finished;                               /* 1: --resume of a finished run */
} run;

/* Decides whether ranks share the body or only matrices; a scene of its own is used, as faults are found
 * again later. */
static pg_status divide (const command *c, const pg_scene *scene)
{
    pg_status status = PG_OK;
    pg_scene *copy = NULL;
    if (pg_rank_count () > 1) PG_TRY (command_scene (c, &copy));
    pg_ranks_divide (pg_subdomain_wanted (copy ? copy : scene, pg_force_methods ()));
done:
    pg_scene_free (&copy);
    return status;
}

/* Makes all checks that can refuse a run before its long work begins, the cheap ones first: folder, memory,
 * faults of the scene, patch test. The name of the folder follows from the scene unless it is given. */
static pg_status prepare (run *r)
{
    pg_status status = PG_OK;
    command *c = &r->c;
    preparation *p = &r->p;
    int fresh = !c->resume && !c->force;
    PG_TRY (command_scene (c, &p->scene));
    PG_TRY (divide (c, p->scene));
    if (c->folder && fresh && pg_rank () == 0) PG_TRY (pg_result_may_open (c->folder, p->scene));
    PG_TRY (prepare_problem (p, c, 0));
    char own[2048];
    snprintf (own, sizeof own, "out/%s", p->problem->name);
    pg_result_rank_folder (r->folder, sizeof r->folder, c->folder ? c->folder : own);
    if (!c->folder && fresh) PG_TRY (pg_result_may_open (r->folder, p->scene));
    double finished = c->resume && pg_rank () == 0 && pg_result_finished (r->folder, p->scene);
    PG_TRY (pg_ranks_ask (1, &finished));
    r->finished = finished > 0;
    if (r->finished && pg_rank () == 0) PG_TRY (pg_result_complete (r->folder));
done:
    return status;
}

/* Creates the solver and its first state, and opens the result folder, which is changed last. */
static pg_status open_run (run *r)
{
    pg_status status = PG_OK;
    preparation *p = &r->p;
    pg_statistics doubts = { 0 };
    if (!r->c.quiet) plan_print (p->problem, &p->options, &doubts);
    PG_TRY (prepare_solver (p));
    if (!r->c.quiet) plan_settled (p->solver);
    PG_TRY (prepare_start (p));
    r->w.early = *pg_solver_report_now (p->solver);
    if (!r->c.quiet) plan_warnings (&r->w.early, &doubts);
    else plan_quiet_warnings (&r->w.early, NULL);
    fflush (stdout);                                   /* progress goes to the other stream */
    r->w.state = p->state, r->w.problem = p->problem;
    run_opens ();
    PG_TRY (open_result (&r->c, r->folder, p->scene, p->problem, p->solver, &r->w));
done:
    return status;
}

/* Removes the folders of the other ranks after a successful run: they hold copies of the rows. Fields are in
 * the result folder. */
static void drop_rank_folder (const run *r, pg_status status)
{
    double failed = status != PG_OK;
    char path[5000];
    if (pg_rank_count () == 1 || pg_ranks_ask (1, &failed) != PG_OK || failed > 0) return;
    if (pg_rank () > 0) pg_folder_remove (r->folder);
    failed = 0;
    if (pg_ranks_ask (1, &failed) != PG_OK || pg_rank () > 0) return;
    snprintf (path, sizeof path, "%s/ranks", r->folder);
    rmdir (path);
}

/* Runs the command. Exit codes: 0 done, or finished already; 130 interrupted, with a checkpoint; others as in
 * cli.h. */
int pg_cli_run (int argc, char **argv)
{
    int together;
    return pg_cli_run_ranks (argc, argv, &together);
}

/* Runs the command on one of several ranks, with one thread each unless --threads is given. */
int pg_cli_run_ranks (int argc, char **argv, int *together)
{
    pg_status status = PG_OK;
    run r = { .finished = 0 };
    double start = pg_seconds ();
    int wrong = command_parse (&r.c, argc, argv), complained = 0;
    *together = 1;
    if (wrong >= 0) return wrong;
    if (pg_rank_count () > 1 && !r.c.given) r.c.threads = 1;
    r.c.quiet |= pg_rank () > 0;
    if (r.c.seeds) return command_seeds (&r.c);
    run_listen ();
    PG_TRY (pg_ranks_agree (prepare (&r)));
    if (r.finished) {
        if (!r.c.quiet) printf ("%s: this run is finished\n", r.folder);
        goto done;
    }
    PG_TRY (pg_ranks_agree (open_run (&r)));
    complained = 1;                                    /* run_to_the_end prints every failure */
    status = run_to_the_end (&r.c, r.p.solver, &r.w, pg_seconds () - start, start);
    if (!r.w.alone) pg_result_free (&r.w.result), drop_rank_folder (&r, status);
done:
    if (status != PG_OK && !complained && pg_rank () == 0) command_complain (status, pg_last_error ());
    *together = !r.w.alone;
    pg_result_free (&r.w.result);
    prepare_free (&r.p);
    return pg_exit_code (status);
}
