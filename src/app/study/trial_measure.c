/* SPDX-License-Identifier: GPL-3.0-or-later
 * The work in the process of a trial: build, solve, write the results, count seconds and bytes, measure the
 * error. */
#include "trial.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

/* The largest resident memory of this program alone, bytes (VmHWM). That of getrusage would
 * also count what the process was before it became this program. */
static double peak_now (void)
{
    char line[256];
    double kilobytes = NAN;
    FILE *f = fopen ("/proc/self/status", "r");
    if (!f) return (double) pg_memory_process_peak ();
    while (fgets (line, sizeof line, f))
        if (strncmp (line, "VmHWM:", 6) == 0) kilobytes = strtod (line + 6, NULL);
    fclose (f);
    return isnan (kilobytes) ? (double) pg_memory_process_peak () : 1024 * kilobytes;
}

/* CPU seconds of all threads so far, those in the system included. */
static double cpu_now (void)
{
    struct rusage used;
    if (getrusage (RUSAGE_SELF, &used) != 0) return NAN;
    return (double) (used.ru_utime.tv_sec + used.ru_stime.tv_sec)
           + 1e-6 * (double) (used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

/* Counts sizes, and seconds of the solver by phase. */
static void count (pg_trial *t, const pg_problem *p, const pg_state *state, const pg_statistics *r)
{
    static const int phase[PG_SECONDS_COUNT] = {
        PG_TRIAL_SHAPE, PG_TRIAL_ANALYSE, PG_TRIAL_FACTOR,   PG_TRIAL_SOLVE,
        PG_TRIAL_FORCE, PG_TRIAL_BREAK,   PG_TRIAL_ASSEMBLE, PG_TRIAL_UPDATE
    };
    for (int k = 0; k < PG_SECONDS_COUNT; k++) t->value[phase[k]] = r->seconds[k];
    t->value[PG_TRIAL_SPACING] = p->cloud.h, t->value[PG_TRIAL_HORIZON] = p->form.approx.horizon;
    t->value[PG_TRIAL_POINTS] = (double) p->cloud.n, t->value[PG_TRIAL_DOFS] = (double) state->ndof;
}

/* Solves by the loop of `perigal run`, without progress and interruption, and measures errors. Seconds and
 * memory are taken before the error is measured. Pictures and report are not written: they would count as
 * cost. */
static pg_status solve_and_measure (pg_trial *t, const char *folder, const pg_scene *scene,
                                    const pg_problem *problem, double start)
{
    pg_status status = PG_OK;
    pg_solver *solver = NULL;
    pg_state *state = NULL;
    pg_result *result = NULL;
    pg_solver_options options;
    pg_step step;
    PG_TRY (pg_solver_options_read (&options, problem, scene));
    PG_TRY (pg_solver_create (&solver, problem, &options));
    PG_TRY (pg_state_create (&state, problem, pg_solver_components (solver)));
    PG_TRY (pg_result_discard (folder));
    PG_TRY (pg_result_open (&result, folder, scene, problem, solver));
    t->value[PG_TRIAL_BUILD] = pg_seconds () - start;
    while (!pg_solver_done (solver, state)) {
        PG_TRY (pg_solver_step (solver, state, &step));
        PG_TRY (pg_result_step (result, state, &step));
    }
    count (t, problem, state, pg_solver_report_now (solver));
    t->value[PG_TRIAL_WALL] = pg_seconds () - start, t->value[PG_TRIAL_CPU] = cpu_now (),
    t->value[PG_TRIAL_PEAK] = peak_now ();
    PG_TRY (pg_trial_errors (t, scene, problem, solver, state, !(options.flags & PG_SOLVER_QUASI_STATIC)));
done:
    pg_result_free (&result);
    pg_state_free (&state);
    pg_solver_free (&solver);
    return status;
}

/* Measures a trial. The problem is built with its threads; its time counts from the start of the process. */
pg_status pg_trial_measure (pg_trial *t, const pg_scene *scene, const char *folder, int threads, double start)
{
    pg_status status = PG_OK;
    pg_problem *problem = NULL;
    pg_trial_read (t, "");
    PG_TRY (pg_problem_build (&problem, scene, threads));
    PG_TRY (pg_result_check (scene, problem));
    PG_TRY (solve_and_measure (t, folder, scene, problem, start));
done:
    pg_problem_free (&problem);
    return status;
}
