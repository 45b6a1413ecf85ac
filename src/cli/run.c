/* SPDX-License-Identifier: GPL-3.0-or-later
 * perigal run: scene -> problem -> solver -> steps -> result folder. */
#include "cli.h"
#include <signal.h>
#include <string.h>

static volatile sig_atomic_t asked_to_stop;
static void on_signal (int number) { (void) number, asked_to_stop = 1; }

static void print_summary (const pg_result *result, const pg_report *r, double total)
{
    printf ("  %ld steps, %ld events, %ld break rounds, %ld bonds broken, %ld factorizations, %ld solves\n", r->steps, r->events, r->iterations, r->broken,
            r->factorizations, r->solves);
    printf ("  largest residual %.2e, largest utilisation of an accepted state %.6f, %zu degenerate points, %zu fragments\n", r->residual_max,
            r->utilisation_max, r->degenerate_points, r->fragments);
    printf ("  %.2f s: shape functions and assembly %.2f, analysis %.2f, factorization %.2f, solve %.2f, forces %.2f, bond sweep %.2f; peak memory %.0f MB\n",
            total, r->seconds[PG_SECONDS_SHAPE] + r->seconds[PG_SECONDS_ASSEMBLE] + r->seconds[PG_SECONDS_UPDATE],
            r->seconds[PG_SECONDS_ANALYSE], r->seconds[PG_SECONDS_FACTOR], r->seconds[PG_SECONDS_SOLVE],
            r->seconds[PG_SECONDS_FORCE], r->seconds[PG_SECONDS_BREAK], (double) pg_memory_process_peak () * 1e-6);
    for (size_t k = 0; k < r->nskipped; k++) printf ("  skipped: %s (%s)\n", r->skipped[k].what, r->skipped[k].why);
    for (size_t k = 0; k < r->nwarning; k++) printf ("  warning: %s\n", r->warning[k]);
    printf ("  results in %s: result.e history.csv events.csv report.json\n", pg_result_folder (result));
    for (size_t k = 0; k < pg_result_pictures (result); k++) printf ("  picture %s\n", pg_result_picture (result, k));
}

static pg_status advance (pg_solver *solver, pg_state *state, pg_result *result, int quiet)
{
    pg_status status = PG_OK;
    pg_step step;
    progress p;
    progress_start (&p, quiet);
    while (!pg_solver_done (solver, state)) {
        if (asked_to_stop) PG_FAIL (PG_E_INTERRUPTED, "interrupted at step %ld, load factor %.6g", state->step, state->factor);
        PG_TRY (pg_solver_step (solver, state, &step));
        PG_TRY (pg_result_step (result, state, &step));
        progress_show (&p, pg_solver_progress (solver, state), &step, pg_solver_report_now (solver));
    }
done:
    progress_end (&p);
    return status;
}

void openblas_set_num_threads (int threads);           /* of OpenBLAS; its header is not everywhere in the same place     */

/* Two BLAS threads gain 7 % of a factorization at 4 000 unknowns on an idle machine, and lose half the speed on a busy one. */
static void settle_blas (const pg_problem *p)
{
    size_t unknowns = p->cloud.n * (size_t) p->dim, enough = p->dim == 3 ? 10000 : 50000;
    openblas_set_num_threads (unknowns < enough ? 1 : p->threads);
}

int pg_cli_run (int argc, char **argv)
{
    pg_status status = PG_OK, outcome = PG_OK;
    command c;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_result *result = NULL;
    pg_solver_options options;
    char folder[512], failure[4096] = "";
    double start = pg_seconds (), built;
    int wrong = command_parse (&c, argc, argv);
    if (wrong >= 0) return wrong;
    signal (SIGINT, on_signal);
    signal (SIGTERM, on_signal);
    PG_TRY (command_scene (&c, &scene));
    PG_TRY (pg_problem_build (&problem, scene, c.threads));
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    if (!c.folder) snprintf (folder, sizeof folder, "out/%s", problem->name);
    PG_TRY (pg_result_check (scene, problem));
    if (!c.quiet) plan_print (problem, &options);
    settle_blas (problem);
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    PG_TRY (pg_result_open (&result, c.folder ? c.folder : folder, scene, problem, solver));
    built = pg_seconds ();
    outcome = advance (solver, state, result, c.quiet);
    if (outcome != PG_OK) snprintf (failure, sizeof failure, "%s", pg_last_error ());
    PG_TRY (pg_result_finish (result, state, outcome == PG_OK ? NULL : failure, built - start, pg_seconds () - start));
    if (!c.quiet) print_summary (result, pg_solver_report_now (solver), pg_seconds () - start);
    status = outcome;
done:
    if (status != PG_OK) command_complain (status, *failure ? failure : pg_last_error ());
    pg_result_free (&result);
    pg_state_free (&state);
    pg_solver_free (&solver);
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    return exit_code (status);
}
