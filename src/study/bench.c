/* SPDX-License-Identifier: GPL-3.0-or-later
 * Benchmarks: scenes x methods x sizes, each run a process of its own, repeated, measured against the scene's
 * reference. */
#include "bench.h"
#include <math.h>
#include <string.h>

static pg_status make_folders (const pg_bench_request *q)
{
    char path[4096];
    snprintf (path, sizeof path, "%s/run", q->folder);
    return pg_folder_make (path);
}

static pg_status run_once (pg_bench_case *c, const pg_bench_request *q, pg_trial *t)
{
    pg_status status = PG_OK;
    char folder[4096];
    pg_trial_request run = { .scene = q->scene[c->scene], .folder = folder, .threads = q->threads };
    snprintf (folder, sizeof folder, "%s/run", q->folder);
    for (size_t k = 0; k < q->nset; k++) run.set[run.nset++] = q->set[k];
    for (size_t k = 0; k < c->nset; k++) run.set[run.nset++] = c->set[k];
    if (c->element[0] && !c->mesh[0]) PG_TRY (pg_bench_mesh_set (c, q));
    if (c->mesh[0]) run.set[run.nset++] = c->mesh;
    PG_TRY (pg_trial_run (t, &run));
done:
    return status;
}

static void tell_error (FILE *out, const char *name, double error)
{
    if (isnan (error)) fprintf (out, "  %s         -", name);
    else fprintf (out, "  %s %9.2e", name, error);
}

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

/* A curve of which one size cannot be is left out at once; sizes that fail later only end with a note. */
static pg_status run_all (pg_bench_cases *cases, const pg_bench_request *q)
{
    pg_status status = PG_OK;
    for (int r = 0; r < q->repeat; r++)
        for (size_t k = 0; k < cases->n; k++) {
            pg_bench_case *c = &cases->at[k];
            pg_trial t;
            if (c->trouble[0]) {
                if (q->out && r == 0) tell (q->out, c);
                continue;
            }
            pg_status outcome = c->fem ? pg_bench_fem_run (c, q) : run_once (c, q, &t);
            if (outcome == PG_E_INTERRUPTED) PG_TRY (outcome);
            if (outcome != PG_OK) {
                snprintf (c->trouble, sizeof c->trouble, "%s: %s",
                          outcome == PG_E_SCENE ? "skipped" : "failed", pg_last_error ());
                for (size_t i = k + 1;
                     outcome == PG_E_SCENE && i < cases->n && cases->at[i].curve == c->curve; i++)
                    snprintf (cases->at[i].trouble, sizeof c->trouble, "skipped: see the size before");
            } else if (!c->fem) {
                int better = c->runs++ == 0 || t.value[PG_TRIAL_CPU] < c->best.value[PG_TRIAL_CPU];
                if (better) c->best = t;
            }
            if (q->out && r == 0) tell (q->out, c);
        }
done:
    return status;
}

pg_status pg_bench_run (const pg_bench_request *q)
{
    pg_status status = PG_OK;
    pg_bench_cases cases = { 0 };
    PG_TRY (make_folders (q));
    PG_TRY (pg_bench_cases_make (&cases, q));
    PG_TRY (run_all (&cases, q));
    PG_TRY (pg_bench_report (&cases, q));
done:
    pg_free (cases.at);
    return status;
}
