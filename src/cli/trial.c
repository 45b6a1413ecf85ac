/* SPDX-License-Identifier: GPL-3.0-or-later
 * One run in a process of its own: started and read here (trial_run), and what that process does
 * (trial_main). */
#include "cli.h"
#include "spawn.h"
#include "trial.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#define X(id, name, unit) name,
const char *const trial_name[TRIAL_COUNT] = { TRIAL_LIST (X) };
#undef X
#define X(id, name, unit) unit,
const char *const trial_unit[TRIAL_COUNT] = { TRIAL_LIST (X) };
#undef X

/* ---- this side ----------------------------------------------------------------------------------------- */
void trial_read (trial *out, const char *text)
{
    for (size_t k = 0; k < TRIAL_COUNT; k++) {
        size_t n = strlen (trial_name[k]);
        out->value[k] = NAN;
        for (const char *s = text; s && *s; s = strchr (s, '\n'), s += s != NULL)
            if (strncmp (s, trial_name[k], n) == 0 && s[n] == ' ') out->value[k] = strtod (s + n, NULL);
    }
}

void trial_tell (const trial *t)
{
    for (size_t k = 0; k < TRIAL_COUNT; k++)
        if (!isnan (t->value[k])) printf ("%s %.17g\n", trial_name[k], t->value[k]);
}

pg_status trial_run (trial *out, const trial_request *q)
{
    pg_status status = PG_OK;
    spawned *child = NULL;
    char threads[16], log[4096], complaint[2048];
    char *argv[2 * TRIAL_SETS + 16] = { "perigal",          "bench",     "--row", (char *) q->scene, "-o",
                                        (char *) q->folder, "--threads", threads, "--quiet" };
    size_t n = 9;
    trial_read (out, "");
    PG_ALLOC (child, 1);
    snprintf (threads, sizeof threads, "%d", q->threads);
    snprintf (log, sizeof log, "%s.log", q->folder);
    for (size_t k = 0; k < q->nset && k < TRIAL_SETS; k++)
        argv[n++] = "--set", argv[n++] = (char *) q->set[k];
    PG_TRY (spawn_run (child, NULL, argv, NULL, log, q->threads));
    if (child->code != EXIT_DONE) {
        spawn_complaint (log, complaint, sizeof complaint);
        PG_FAIL (child->code == EXIT_SCENE         ? PG_E_SCENE
                 : child->code == EXIT_INTERRUPTED ? PG_E_INTERRUPTED
                                                   : PG_E_EQUILIBRIUM,
                 "%s",
                 complaint[0]         ? complaint
                 : child->code >= 128 ? "killed by a signal"
                                      : "the run failed without a message");
    }
    trial_read (out, child->text);
    remove (log);
done:
    pg_free (child);
    return status;
}

/* ---- the other side ------------------------------------------------------------------------------------ */
/* High water mark of this program alone; that of getrusage also counts what the process was before. */
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

static double cpu_now (void)
{
    struct rusage used;
    if (getrusage (RUSAGE_SELF, &used) != 0) return NAN;
    return (double) (used.ru_utime.tv_sec + used.ru_stime.tv_sec)
           + 1e-6 * (double) (used.ru_utime.tv_usec + used.ru_stime.tv_usec);
}

static void count (trial *t, const pg_problem *p, const pg_state *state, const pg_statistics *r)
{
    static const int phase[PG_SECONDS_COUNT] = { TRIAL_SHAPE, TRIAL_ANALYSE, TRIAL_FACTOR,   TRIAL_SOLVE,
                                                 TRIAL_FORCE, TRIAL_BREAK,   TRIAL_ASSEMBLE, TRIAL_UPDATE };
    for (int k = 0; k < PG_SECONDS_COUNT; k++) t->value[phase[k]] = r->seconds[k];
    t->value[TRIAL_SPACING] = p->cloud.h, t->value[TRIAL_HORIZON] = p->approx.horizon;
    t->value[TRIAL_POINTS] = (double) p->cloud.n, t->value[TRIAL_DOFS] = (double) state->ndof;
}

static pg_status solve_and_measure (const command *c, const pg_scene *scene, const pg_problem *problem,
                                    trial *t, double start)
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
    PG_TRY (pg_result_discard (c->folder));
    PG_TRY (pg_result_open (&result, c->folder, scene, problem, solver));
    t->value[TRIAL_BUILD] = pg_seconds () - start;
    while (!pg_solver_done (solver, state)) {
        PG_TRY (pg_solver_step (solver, state, &step));
        PG_TRY (pg_result_step (result, state, &step));
    }
    count (t, problem, state, pg_solver_report_now (solver));
    t->value[TRIAL_WALL] = pg_seconds () - start, t->value[TRIAL_CPU] = cpu_now (),
    t->value[TRIAL_PEAK] = peak_now ();
    PG_TRY (trial_errors (t, scene, problem, solver, state, !options.quasi_static));
done:
    pg_result_free (&result);
    pg_state_free (&state);
    pg_solver_free (&solver);
    return status;
}

int trial_main (int argc, char **argv)
{
    pg_status status = PG_OK;
    command c;
    pg_scene *scene = NULL;
    pg_problem *problem = NULL;
    pg_forecast forecast;
    trial t;
    double start = pg_seconds ();
    argv[0] = "run";
    int wrong = command_parse (&c, argc, argv);
    if (wrong >= 0) return wrong;
    trial_read (&t, "");
    if (!c.folder) PG_FAIL (PG_E_USAGE, "--row needs -o DIR");
    PG_TRY (command_scene (&c, &scene));
    if (c.memory > 0 || !afford_tiny (scene)) PG_TRY (afford_scene (&c, &forecast));
    PG_TRY (pg_problem_build (&problem, scene, c.threads));
    PG_TRY (pg_result_check (scene, problem));
    PG_TRY (solve_and_measure (&c, scene, problem, &t, start));
    trial_tell (&t);
done:
    if (status != PG_OK) command_complain (status, pg_last_error ());
    pg_problem_free (&problem);
    pg_scene_free (&scene);
    return exit_code (status);
}
