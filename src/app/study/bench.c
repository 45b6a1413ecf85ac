/* SPDX-License-Identifier: GPL-3.0-or-later
 * Benchmarks: scenes x methods x sizes, each run a process of its own, repeated, and measured
 * against the reference of the scene. A benchmark compares error and cost; cost is CPU
 * seconds, which depend less on what else the machine does than the time on the clock. */
#include "bench.h"
#include <math.h>
#include <string.h>

/* Makes the folder that all runs use, one after the other: only their numbers are kept. */
static pg_status make_folders (const pg_bench_request *q)
{
    char path[4096];
    snprintf (path, sizeof path, "%s/run", q->folder);
    return pg_folder_make (path);
}

/* Runs a case; its overrides come after those of the request, and the later value of a key counts. */
static pg_status run_once (pg_bench_case *c, const pg_bench_request *q, pg_trial *t)
{
    pg_status status = PG_OK;
    char folder[4096];
    pg_trial_request run = { .scene = q->scene[c->scene], .folder = folder, .threads = q->threads };
    snprintf (folder, sizeof folder, "%s/run", q->folder);
    if (q->nset + c->nset + 1 > PG_TRIAL_SETS)
        PG_FAIL (PG_E_USAGE, "%zu values are set, and a trial takes at most %d with the %zu of its method",
                 q->nset, PG_TRIAL_SETS, c->nset + 1);
    for (size_t k = 0; k < q->nset; k++) run.set[run.nset++] = q->set[k];
    for (size_t k = 0; k < c->nset; k++) run.set[run.nset++] = c->set[k];
    if (c->element[0] && !c->mesh[0]) PG_TRY (pg_bench_mesh_set (c, q));
    if (c->mesh[0]) run.set[run.nset++] = c->mesh;
    PG_TRY (pg_trial_run (t, &run));
done:
    return status;
}

/* Prints one error, or - if it is not known. */
static void tell_error (FILE *out, const char *name, double error)
{
    if (isnan (error)) fprintf (out, "  %s         -", name);
    else fprintf (out, "  %s %9.2e", name, error);
}

/* Prints one line for a case: its scene and method, and its unknowns, errors, CPU seconds and memory, or why
 * it did not run. */
static void tell (FILE *out, const pg_bench_case *c)
{
    const double *v = c->best.value;
    fprintf (out, "  %-22s %-34s", c->name, c->method);
    if (c->runs) {
        fprintf (out, " %8.0f dofs", v[PG_TRIAL_DOFS]);
        tell_error (out, "L2", isnan (v[PG_TRIAL_L2]) ? v[PG_TRIAL_LINES] : v[PG_TRIAL_L2]);
        tell_error (out, "energy", v[PG_TRIAL_ENERGY]);
        fprintf (out, "  %7.2f s CPU  %5.0f MB\n", v[PG_TRIAL_CPU], 1e-6 * v[PG_TRIAL_PEAK]);
    } else fprintf (out, " %s\n", c->trouble);
    fflush (out);
}

/* Notes why a case did not run, and marks the smaller sizes of an impossible combination as
 * skipped. */
static void note_trouble (pg_bench_cases *cases, size_t k, pg_status outcome)
{
    pg_bench_case *c = &cases->at[k];
    int impossible = outcome == PG_E_SCENE;
    snprintf (c->trouble, sizeof c->trouble, "%s: %s", impossible ? "skipped" : "failed", pg_last_error ());
    for (size_t i = k + 1; impossible && i < cases->n && cases->at[i].curve == c->curve; i++)
        snprintf (cases->at[i].trouble, sizeof c->trouble, "skipped: see the size before");
}

/* Keeps the CPU seconds of a run, and its other numbers if no repeat took less. */
static void count_run (pg_bench_case *c, const pg_trial *t)
{
    if (c->runs < PG_BENCH_REPEATS) c->cpu[c->runs] = t->value[PG_TRIAL_CPU];
    if (c->runs++ == 0 || t->value[PG_TRIAL_CPU] < c->best.value[PG_TRIAL_CPU]) c->best = *t;
}

/* Runs all cases. A combination that is not possible (PG_E_SCENE) is not possible at smaller sizes either, so
 * the rest of its curve is skipped; other failures end one case only. */
static pg_status run_all (pg_bench_cases *cases, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    for (int r = 0; r < q->repeat; r++)
        for (size_t k = 0; k < cases->n; k++) {
            pg_bench_case *c = &cases->at[k];
            pg_trial t;
            int troubled = c->trouble[0] != 0;
            pg_status outcome = troubled ? PG_OK : c->fem ? pg_bench_fem_run (c, q) : run_once (c, q, &t);
            if (outcome == PG_E_INTERRUPTED) PG_TRY (outcome);
            if (outcome != PG_OK) note_trouble (cases, k, outcome);
            else if (!troubled && !c->fem) count_run (c, &t);
            if (q->out && r == 0) tell (q->out, c);
        }
done:
    return status;
}

/* Prints the CPU seconds of every case over its repeats: a difference between two cases that is smaller than
 * the spread of one is not significant. */
static void tell_spread (FILE *out, const pg_bench_cases *cases, int repeat)
{
    fprintf (out, "  CPU seconds of %d runs: least, median, largest\n", repeat);
    for (size_t k = 0; k < cases->n; k++) {
        const pg_bench_case *c = &cases->at[k];
        double least, median, largest;
        pg_bench_spread (c, &least, &median, &largest);
        if (!c->runs) continue;
        fprintf (out, "  %-22s %-34s %8.0f dofs  %8.3g %8.3g %8.3g\n", c->name, c->method,
                 c->best.value[PG_TRIAL_DOFS], least, median, largest);
    }
}

/* Runs a benchmark. All cases are made before the first one runs, so that wrong names are noticed at once. */
pg_status pg_bench_run (const pg_bench_request *q)
{
    pg_status status = PG_OK;
    pg_bench_cases cases = { 0 };
    PG_TRY (make_folders (q));
    PG_TRY (pg_bench_cases_make (&cases, q));
    PG_TRY (run_all (&cases, q));
    if (q->out && q->repeat > 1) tell_spread (q->out, &cases, q->repeat);
    PG_TRY (pg_bench_report (&cases, q));
done:
    pg_free (cases.at);
    return status;
}
